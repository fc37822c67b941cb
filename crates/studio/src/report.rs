//! The JSON report: a contract with other programs. Fields are never renamed or removed.

use base::Report;
use plant::{AxisKind, OrganKind, Plant};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The value of [`RunReport::schema`].
pub const REPORT_SCHEMA: &str = "burgeon.report/1";

/// One run of one command.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// Always [`REPORT_SCHEMA`].
    pub schema: String,
    /// The command, such as `sketch`.
    pub command: String,
    /// The program's version.
    pub version: String,
    /// The seed of the run.
    pub seed: u64,
    /// What was read.
    pub input: InputReport,
    /// One entry for each plant that was made.
    pub items: Vec<ItemReport>,
    /// Number of plants made.
    pub ok: u64,
    /// Number of inputs that failed.
    pub failed: u64,
    /// What was wrong with failed inputs, and what concerns the whole run.
    pub warnings: Vec<String>,
}

impl RunReport {
    /// An empty report of a command.
    pub fn new(command: &str, seed: u64) -> Self {
        Self {
            schema: REPORT_SCHEMA.into(),
            command: command.into(),
            version: crate::VERSION.into(),
            seed,
            input: InputReport::default(),
            items: Vec::new(),
            ok: 0,
            failed: 0,
            warnings: Vec::new(),
        }
    }
}

/// What was read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InputReport {
    /// The file, or several joined by `, `.
    pub path: String,
    /// Drawings in it.
    pub drawings: u64,
    /// Strokes in all drawings.
    pub strokes: u64,
    /// What was taken off the coordinates of clouds far from their origin, in the file's axes, metres: null if nothing.
    #[serde(default)]
    pub offset_m: Option<[f64; 3]>,
}

/// One plant.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ItemReport {
    /// Name of the drawing.
    pub name: String,
    /// The file that was written; empty if none.
    pub output: String,
    /// Every stroke and what became of it.
    pub strokes: Vec<StrokeReport>,
    /// Numbers of things.
    pub counts: Counts,
    /// Times of the stages.
    pub timings_ms: TimingsMs,
    /// How near the model's front view is to the drawing.
    pub fidelity: Fidelity,
    /// Fingerprint of the plant: independent of platform and threads.
    pub digest: String,
    /// What was not as the user might expect.
    pub warnings: Vec<String>,
    /// Of a plant with axes: what a botanist would measure on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<serde_json::Value>")]
    pub plant: Option<plant::Measures>,
    /// Of `leaf`: veins, blade and how well they fit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaf: Option<crate::LeafReport>,
    /// Of `grow`: what growth did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub growth: Option<crate::GrowthReport>,
    /// Of a plant that was edited by hand: what became of each edit, in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edits: Vec<crate::EditReport>,
    /// Of `shape --list`: the branches that were asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<serde_json::Value>")]
    pub branches: Vec<crate::BranchRow>,
}

/// One stroke.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StrokeReport {
    /// Its index in the drawing, from 0.
    pub index: u32,
    /// What it is.
    pub class: String,
    /// What became of it.
    pub organ: String,
    /// How sure that class is, 0 to 1: the classifier's share of it, also where a rule chose it; 1 where the user did.
    pub confidence: f64,
    /// What decided the class: `user`, `classifier` or `rule:NAME` (`docs/strokes.md` lists the rules).
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
}

/// Numbers of things in a plant and its meshes; none of what was not counted, such as the leaves of a model that was read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Counts {
    /// Flowers.
    pub flowers: Option<u64>,
    /// Petals.
    pub petals: Option<u64>,
    /// Leaves.
    pub leaves: Option<u64>,
    /// Trunks, branches, twigs and stems (not petioles, not roots).
    pub branches: Option<u64>,
    /// Nodes of all axes.
    pub nodes: Option<u64>,
    /// Axes of every kind.
    pub axes: Option<u64>,
    /// Mesh vertices.
    pub vertices: u64,
    /// Mesh triangles.
    pub triangles: u64,
}

impl Counts {
    /// Counts a plant; mesh numbers stay 0.
    pub fn of_plant(plant: &Plant) -> Self {
        let organs = |kind| Some(plant.organs.iter().filter(|o| o.kind == kind).count() as u64);
        let is_branch = |kind| matches!(kind, AxisKind::Branch | AxisKind::Twig | AxisKind::Stem);
        Self {
            flowers: Some(plant.flowers.len() as u64),
            petals: organs(OrganKind::Petal),
            leaves: organs(OrganKind::Leaf),
            branches: Some(plant.axes.iter().filter(|a| is_branch(a.kind)).count() as u64),
            nodes: Some(plant.nodes.position.len() as u64),
            axes: Some(plant.axes.len() as u64),
            vertices: 0,
            triangles: 0,
        }
    }
}

/// Milliseconds of each stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TimingsMs {
    /// Reading the file.
    pub read: f64,
    /// Resampling and smoothing.
    pub preprocess: f64,
    /// Stroke classes.
    pub classify: f64,
    /// Hierarchy, flowers, attachment.
    pub structure: f64,
    /// Filling, depth, radii.
    pub depth: f64,
    /// Skinning.
    pub mesh: f64,
    /// Writing the model.
    pub write: f64,
    /// From the command's start to its last file but the report: reading, computing, pictures and writing. Of a batch:
    /// from the drawing's reading to its last file.
    pub total: f64,
}

impl TimingsMs {
    /// The stages of a report; stages of other names are left out of the fields but not of the total.
    pub fn from_report(report: &Report) -> Self {
        let of = |name| report.stages.iter().find(|s| s.name == name).map_or(0.0, |s| s.ms);
        Self {
            read: of("read"),
            preprocess: of("preprocess"),
            classify: of("classify"),
            structure: of("structure"),
            depth: of("depth"),
            mesh: of("mesh"),
            write: of("write"),
            total: report.stages.iter().map(|s| s.ms).sum(),
        }
    }

    /// Adds what the shell measured itself.
    pub fn add_io(&mut self, read_ms: f64, write_ms: f64) {
        self.read += read_ms;
        self.write += write_ms;
        self.total += read_ms + write_ms;
    }
}

/// Reprojection error of axes, petals and `drawn` leaves against the drawing, as shares of its diagonal; none where no stroke
/// was compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Fidelity {
    /// Mean distance.
    pub reprojection_mean: Option<f64>,
    /// 95th percentile.
    pub reprojection_p95: Option<f64>,
}
