//! The JSON report: a contract with other programs. Fields are never renamed or removed.

use base::LiteMap;

use base::{Bound, Check, Report, Severity, Warning};
use plant::{AxisKind, OrganKind, Plant};
use reading::{Kind, Reading};
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
    /// The program that the export is for, and what was set for it.
    #[serde(rename = "for", default, skip_serializing_if = "Option::is_none")]
    pub engine: Option<EngineReport>,
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
            engine: None,
            items: Vec::new(),
            ok: 0,
            failed: 0,
            warnings: Vec::new(),
        }
    }
}

/// The program that an export is for.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EngineReport {
    /// Its word.
    pub name: String,
    /// The options that were set for it, as they would stand on the command line.
    pub set: Vec<String>,
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
    pub fidelity: FidelityReport,
    /// Fingerprint of the plant: independent of platform and threads.
    pub digest: String,
    /// Of a drawing: what it may show, at most three: what it was read as first, then the others, the best first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub readings: Vec<ReadingReport>,
    /// What was not as the user might expect.
    pub warnings: Vec<String>,
    /// What was checked of it: whether a person would accept it. Those that failed are among the warnings.
    #[serde(default)]
    pub checks: Vec<CheckReport>,
    /// The warnings with their codes, for shells that say them in another language.
    #[serde(skip)]
    pub told: Vec<Warning>,
    /// Of a plant with axes: what a botanist would measure on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<serde_json::Value>")]
    pub plant: Option<plant::Measures>,
    /// Of `leaf`: veins, blade and how well they fit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaf: Option<LeafReport>,
    /// Of `grow`: what growth did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub growth: Option<GrowthReport>,
    /// Of a plant that was written as a robot: how it is built, and what was assumed of its tissues.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(skip)]
    pub robot: Option<RobotReport>,
    /// Of a plant that was edited by hand: what became of each edit, in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edits: Vec<crate::EditReport>,
    /// Of `shape --list`: the branches that were asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<serde_json::Value>")]
    pub branches: Vec<crate::BranchRow>,
}

impl ItemReport {
    /// With these warnings.
    pub(crate) fn warning(self, told: Vec<Warning>) -> Self {
        let told = base::gathered(told);
        Self { warnings: told.iter().map(ToString::to_string).collect(), told, ..self }
    }

    /// With more checks and their warnings.
    pub fn add_checks(&mut self, report: Report) {
        self.warnings.extend(report.warnings.iter().map(ToString::to_string));
        self.told.extend(report.warnings);
        self.checks.extend(report.checks.iter().map(CheckReport::from));
    }

    /// The first check that makes this no result: one that failed as an error, or if `is_strict` any that failed.
    pub fn refusal(&self, is_strict: bool) -> Option<&CheckReport> {
        self.checks.iter().find(|c| !c.ok && (is_strict || c.severity == SeverityWord::Error))
    }
}

/// A measured value of a plant against what is plausible (`docs/limits.md` has the table).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheckReport {
    /// A word that stays, such as `size-large`.
    pub name: String,
    /// What was measured.
    pub value: f64,
    /// What is plausible.
    pub bound: f64,
    /// On which side of the bound.
    pub side: SideWord,
    /// Whether the value is plausible.
    pub ok: bool,
    /// What it means if not.
    pub severity: SeverityWord,
    /// What was measured, with its bound, as a sentence.
    pub message: String,
    /// What to do if it is not plausible.
    pub advice: String,
}

/// Which side of a bound is plausible.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SideWord {
    /// The bound or more.
    AtLeast,
    /// The bound or less.
    AtMost,
}

/// What a check that fails means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SeverityWord {
    /// The result may be wrong.
    Warning,
    /// Nobody would accept the result.
    Error,
}

impl From<&Check> for CheckReport {
    fn from(check: &Check) -> Self {
        Self {
            name: check.name.to_owned(),
            value: check.value,
            bound: check.bound.number(),
            side: match check.bound {
                Bound::AtLeast(_) => SideWord::AtLeast,
                Bound::AtMost(_) => SideWord::AtMost,
            },
            ok: check.holds(),
            severity: match check.severity {
                Severity::Warning => SeverityWord::Warning,
                Severity::Error => SeverityWord::Error,
            },
            message: check.said(),
            advice: check.advice.to_owned(),
        }
    }
}

/// One interpretation of a whole drawing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReadingReport {
    /// The kind of plant; of several plants of different kinds that of the largest.
    pub kind: Kind,
    /// How many plants it would show.
    pub plants: u64,
    /// How likely it is right, 0 to 1; of several plants their mean.
    pub score: f64,
}

impl ReadingReport {
    /// Most readings that are told.
    const MOST: usize = 3;

    /// What a drawing was read as, and what else it may be.
    pub fn of(reading: &Reading) -> Vec<Self> {
        let plants = reading.plants.len() as u64;
        if let [one] = &reading.plants[..] {
            return one.readings.iter().map(|r| Self { kind: r.kind, plants, score: r.score }).collect();
        }
        let count = reading.plants.len().max(1) as f64;
        let mut sums: LiteMap<Kind, f64> = LiteMap::new();
        for r in reading.plants.iter().flat_map(|p| &p.readings) {
            *sums.entry(r.kind).or_default() += r.score / count;
        }
        let largest = reading.plants.iter().reduce(|a, b| if b.height > a.height { b } else { a });
        let Some(kind) = largest.map(|p| p.kind) else { return Vec::new() };
        let own = |k: Kind| if k == Kind::Flower { Kind::Flowers } else { k };
        let mean = reading.plants.iter().filter_map(|p| p.readings.first()).map(|r| r.score).sum::<f64>();
        let mut found = vec![Self { kind: own(kind), plants, score: mean / count }];
        let mut others: Vec<(Kind, f64)> = sums.into_iter().filter(|(k, _)| !k.is_like(kind)).collect();
        base::sort_by(&mut others, |a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        found.extend(others.into_iter().map(|(k, score)| Self { kind: own(k), plants, score }));
        found.truncate(Self::MOST);
        found
    }
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
    /// Measuring how true the plant is to its drawing.
    #[serde(default)]
    pub fidelity: f64,
    /// Skinning.
    pub mesh: f64,
    /// Measures and digest of the plant.
    #[serde(default)]
    pub measure: f64,
    /// Drawing the picture.
    #[serde(default)]
    pub picture: f64,
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
            fidelity: of("fidelity"),
            mesh: of("mesh"),
            measure: of("measure"),
            picture: of("picture"),
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

/// The model's front view against the drawing, measured both ways; distances are shares of the drawing's diagonal. Null:
/// nothing of that sort to compare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FidelityReport {
    /// Mean distance from the drawn lines to the model's lines and outlines.
    pub reprojection_mean: Option<f64>,
    /// 95 % of the drawn lines are nearer than this.
    pub reprojection_p95: Option<f64>,
    /// Mean distance from the model's axes and outlines to the ink: what the model shows and nobody drew.
    #[serde(default)]
    pub excess_mean: Option<f64>,
    /// 95 % of the model's axes and outlines are nearer than this.
    #[serde(default)]
    pub excess_p95: Option<f64>,
    /// The area that filled contours (crowns, clusters) share with what grew in them, over the area of either, 0 to 1.
    #[serde(default)]
    pub overlap: Option<f64>,
    /// The share of the drawing's ink that was measured, by length, 0 to 1: strokes that were left out were not.
    #[serde(default)]
    pub compared: Option<f64>,
}

impl From<sketch::Fidelity> for FidelityReport {
    fn from(f: sketch::Fidelity) -> Self {
        Self {
            reprojection_mean: f.reprojection_mean,
            reprojection_p95: f.reprojection_p95,
            excess_mean: f.excess_mean,
            excess_p95: f.excess_p95,
            overlap: f.overlap,
            compared: Some(f.compared),
        }
    }
}

/// The part of a report about a leaf.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LeafReport {
    /// `interpolate`, `approximate`, `bezier` or `nurbs`.
    pub surface: String,
    /// Rows of marks.
    pub rows: u64,
    /// Length of the midrib, millimetres.
    pub length_mm: f64,
    /// Area of the blade's mesh, square millimetres.
    pub area_mm2: f64,
    /// The veins' mesh; faces are quads (and triangles of caps).
    pub veins: FaceCounts,
    /// The blade's mesh; faces are quads.
    pub blade: FaceCounts,
    /// Distances of what was measured from the blade.
    pub fit_error: LeafFit,
    /// The farthest that a vein's centre line is from the blade, millimetres.
    pub vein_gap_mm: Option<f64>,
    /// Rings whose ball is inside its neighbours; none for plain rings.
    pub swallowed_rings: Option<u64>,
    /// Rings at which a vein is thicker than it bends.
    pub crossing_rings: Option<u64>,
    /// Of a scan: what was found in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scan: Option<ScanReport>,
}

/// What was found in a scan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScanReport {
    /// Points read, without those that are no numbers.
    pub points: u64,
    /// Points left out because their neighbours are far.
    pub outliers: u64,
    /// Share of the blade that has a point within 2 mm; the rest are holes that were bridged.
    pub covered: f64,
    /// Length of the stalk, millimetres; none if there is no stalk.
    pub stalk_mm: Option<f64>,
    /// Length of the outline, millimetres.
    pub outline_mm: f64,
    /// Greatest width across the midrib, millimetres.
    pub width_mm: f64,
}

/// Vertices and faces of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FaceCounts {
    /// Vertices.
    pub vertices: u64,
    /// Faces.
    pub faces: u64,
}

/// How far measured points are from the blade, millimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LeafFit {
    /// Root of the mean square.
    pub rms_mm: f64,
    /// 95 of 100 points are nearer.
    pub p95_mm: f64,
    /// The farthest.
    pub max_mm: f64,
    /// Share of the points that the blade explains (within 2 mm): all of them for marks that it passes through.
    pub explained: f64,
}

impl LeafFit {
    /// From distances in metres; a point is explained up to 2 mm.
    pub fn of(distances: &[f64]) -> Self {
        let mut sorted: Vec<f64> = distances.iter().map(|d| d * 1e3).collect();
        base::sort_numbers(&mut sorted);
        let n = sorted.len();
        let Some(&max) = sorted.last() else { return Self::default() };
        let square: f64 = sorted.iter().map(|d| d * d).sum();
        let explained = sorted.partition_point(|&d| d <= 2.0) as f64 / n as f64;
        // The smallest distance that at least 95 % do not exceed.
        let p95 = sorted[(95 * n).div_ceil(100).max(1) - 1];
        Self { rms_mm: (square / n as f64).sqrt(), p95_mm: p95, max_mm: max, explained }
    }
}

/// The part of a report about growth.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GrowthReport {
    /// `competition`, `colonization`, `self-organizing`, `guided` or `lsystem`.
    pub method: String,
    /// Attraction points or markers of all cycles.
    pub attractors: u64,
    /// Of these, consumed.
    pub consumed: u64,
    /// Of these, never reached.
    pub unreachable: u64,
    /// Rounds, years or rewriting steps.
    pub iterations: u64,
    /// Life cycles.
    pub cycles: u64,
    /// Joints of the skeleton.
    pub nodes: u64,
    /// Places for leaves.
    pub leaves_placed: u64,
    /// Leaves on the tree.
    pub leaves_kept: u64,
    /// Vertices of the meshes, wood and leaves alike, that lie more than a millimetre inside an obstacle; none where
    /// there is no obstacle, or nothing was measured.
    pub inside_obstacle: Option<u64>,
    /// How deep the deepest vertex lies inside an obstacle, metres; 0 where none does; none as above.
    #[serde(default)]
    pub inside_obstacle_depth_m: Option<f64>,
}

/// The part of a report about a robot: how it is built, and what was assumed of its tissues.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotReport {
    /// Rigid bodies, with fruits that can break off.
    pub bodies: u64,
    /// Hinges: two a joint.
    pub hinges: u64,
    /// Fruits that can break off.
    pub breakable_fruits: u64,
    /// Kilograms of all bodies.
    pub mass_kg: f64,
    /// The lowest frequency at which it swings, hertz; 0 of a plant without joints.
    pub lowest_hz: f64,
    /// The longest time step that simulates it well, seconds.
    pub time_step_s: f64,
    /// Whose wood it was taken for: `hardwood`, `softwood` or `green`. None of it is measured.
    pub wood: String,
    /// Young's modulus of that wood, pascals.
    pub modulus_pa: f64,
    /// The density of that wood, kilograms per cubic metre.
    pub density_kg_m3: f64,
    /// The stress at which that wood breaks, pascals.
    pub strength_pa: f64,
}
