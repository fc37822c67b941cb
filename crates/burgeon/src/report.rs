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
    /// The input.
    pub input: InputReport,
    /// The program that the export is for, and its settings.
    #[serde(rename = "for", default, skip_serializing_if = "Option::is_none")]
    pub engine: Option<EngineReport>,
    /// One entry for each plant.
    pub items: Vec<ItemReport>,
    /// Number of plants made.
    pub ok: u64,
    /// Number of inputs that failed.
    pub failed: u64,
    /// Faults of failed inputs, and warnings about the whole run.
    pub warnings: Vec<String>,
}

impl RunReport {
    /// Makes an empty report of a command.
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
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct EngineReport {
    /// Its word.
    pub name: String,
    /// Settings that were made for it; in a report of the command as options.
    pub set: Vec<String>,
}

/// The input of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InputReport {
    /// The file, or several joined by `, `.
    pub path: String,
    /// Drawings in it.
    pub drawings: u64,
    /// Strokes in all drawings.
    pub strokes: u64,
    /// Offset subtracted from the coordinates of clouds far from their origin, in the file's axes, metres: null if
    /// none.
    #[serde(default)]
    pub offset_m: Option<[f64; 3]>,
    /// The coordinate system of a cloud, as its file names it: null if it names none.
    #[serde(default)]
    pub coordinate_system: Option<String>,
}

/// One plant.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ItemReport {
    /// Name of the drawing.
    pub name: String,
    /// The file written; empty if none.
    pub output: String,
    /// Every stroke and its result.
    pub strokes: Vec<StrokeReport>,
    /// Numbers of things.
    pub counts: Counts,
    /// Times of the stages.
    pub timings_ms: TimingsMs,
    /// Distance between the model's front view and the drawing.
    pub fidelity: FidelityReport,
    /// Fingerprint of the plant: independent of platform and threads.
    pub digest: String,
    /// For a drawing: at most three interpretations, the chosen one first, then the others, the best first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub readings: Vec<ReadingReport>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// Checks of whether a person would accept it. The failed ones are among the warnings.
    #[serde(default)]
    pub checks: Vec<CheckReport>,
    /// The warnings with their codes, for shells that translate them.
    #[serde(skip)]
    pub told: Vec<Warning>,
    /// For a plant with axes: the measures that a botanist would take of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<serde_json::Value>")]
    pub plant: Option<plant::Measures>,
    /// For `leaf`: veins, blade and how well they fit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaf: Option<LeafReport>,
    /// For `grow`: figures of the growth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub growth: Option<GrowthReport>,
    /// For a plant that was written as a robot: its structure, and the assumed properties of its tissues.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(skip)]
    pub robot: Option<RobotReport>,
    /// For a plant that was edited by hand: the outcome of each edit, in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edits: Vec<crate::EditReport>,
    /// For `shape --list`: the branches that were asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<serde_json::Value>")]
    pub branches: Vec<crate::BranchRow>,
}

impl ItemReport {
    /// Returns the entry with these warnings.
    pub(crate) fn warning(self, told: Vec<Warning>) -> Self {
        let told = base::gathered(told);
        Self { warnings: told.iter().map(ToString::to_string).collect(), told, ..self }
    }

    /// Adds checks and their warnings.
    pub fn add_checks(&mut self, report: Report) {
        self.warnings.extend(report.warnings.iter().map(ToString::to_string));
        self.told.extend(report.warnings);
        self.checks.extend(report.checks.iter().map(CheckReport::from));
    }

    /// Returns the first check that rules the result out: one that failed as an error, or if `is_strict` any that
    /// failed.
    pub fn refusal(&self, is_strict: bool) -> Option<&CheckReport> {
        self.checks.iter().find(|c| !c.ok && (is_strict || c.severity == SeverityWord::Error))
    }
}

/// A measured value of a plant and its plausible bound (`docs/limits.md` has the table).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheckReport {
    /// A stable word, such as `size-large`.
    pub name: String,
    /// The measured value.
    pub value: f64,
    /// The plausible bound.
    pub bound: f64,
    /// The plausible side of the bound.
    pub side: SideWord,
    /// Whether the value is plausible.
    pub ok: bool,
    /// Meaning of an implausible value.
    pub severity: SeverityWord,
    /// The measured value, with its bound, as a sentence.
    pub message: String,
    /// Advice for an implausible value.
    pub advice: String,
}

/// The plausible side of a bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SideWord {
    /// The bound or more.
    AtLeast,
    /// The bound or less.
    AtMost,
}

/// Meaning of a failed check.
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
    /// The kind of plant; for several plants of different kinds that of the largest.
    pub kind: Kind,
    /// Number of plants in it.
    pub plants: u64,
    /// Probability that it is right, 0 to 1; for several plants their mean.
    pub score: f64,
}

impl ReadingReport {
    /// Most readings that are reported.
    const MOST: usize = 3;

    /// Returns the chosen reading of a drawing, and the others.
    pub fn from_reading(reading: &Reading) -> Vec<Self> {
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
    /// Its class.
    pub class: String,
    /// The organ made of it.
    pub organ: String,
    /// Confidence in that class, 0 to 1: the classifier's share of it, also where a rule chose it; 1 where the user
    /// did.
    pub confidence: f64,
    /// Source of the class: `user`, `classifier` or `rule:NAME` (`docs/strokes.md` lists the rules).
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
}

/// Counts of a plant and its meshes; none where nothing was counted, such as the leaves of a model that was read.
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
    pub fn from_plant(plant: &Plant) -> Self {
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
    /// Measuring the fidelity of the plant to its drawing.
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
    /// From the command's start to its last file but the report: reading, computing, pictures and writing. In a batch:
    /// from reading the drawing to its last file.
    pub total: f64,
}

impl TimingsMs {
    /// Collects the stages of a report; stages of other names are left out of the fields but not of the total.
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

    /// Adds the times that the shell measured.
    pub fn add_io(&mut self, read_ms: f64, write_ms: f64) {
        self.read += read_ms;
        self.write += write_ms;
        self.total += read_ms + write_ms;
    }
}

/// Comparison of the model's front view with the drawing, measured both ways; distances are shares of the drawing's
/// diagonal. Null: nothing of that sort to compare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FidelityReport {
    /// Mean distance from the drawn lines to the model's lines and outlines.
    pub reprojection_mean: Option<f64>,
    /// Distance within which 95 % of the drawn lines lie.
    pub reprojection_p95: Option<f64>,
    /// Mean distance from the model's axes and outlines to the ink: parts that the model shows and nobody drew.
    #[serde(default)]
    pub excess_mean: Option<f64>,
    /// Distance within which 95 % of the model's axes and outlines lie.
    #[serde(default)]
    pub excess_p95: Option<f64>,
    /// The area that filled contours (crowns, clusters) share with their filling, over the area of their union, 0 to 1.
    #[serde(default)]
    pub overlap: Option<f64>,
    /// The measured share of the drawing's ink, by length, 0 to 1: strokes that were left out were not measured.
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
    /// Distances of the measured points from the blade.
    pub fit_error: LeafFit,
    /// Largest distance of a vein's centre line from the blade, millimetres.
    pub vein_gap_mm: Option<f64>,
    /// Rings whose ball is inside its neighbours; none for plain rings.
    pub swallowed_rings: Option<u64>,
    /// Rings at which the vein's radius exceeds its radius of curvature.
    pub crossing_rings: Option<u64>,
    /// For a scan: its findings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scan: Option<ScanReport>,
}

/// Findings of a scan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScanReport {
    /// Points read, without those that are not numbers.
    pub points: u64,
    /// Points left out because their neighbours are far.
    pub outliers: u64,
    /// Share of the blade that has a point within 2 mm; the rest are bridged holes.
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

/// Distances of measured points from the blade, millimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LeafFit {
    /// Root of the mean square.
    pub rms_mm: f64,
    /// Distance within which 95 of 100 points lie.
    pub p95_mm: f64,
    /// Largest distance.
    pub max_mm: f64,
    /// Share of the points that the blade explains (within 2 mm): all of them for marks that it passes through.
    pub explained: f64,
}

impl LeafFit {
    /// Computes the fit from distances in metres; a point is explained up to 2 mm.
    pub fn from_distances(distances: &[f64]) -> Self {
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
    /// Number of these consumed.
    pub consumed: u64,
    /// Number of these never reached.
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
    /// Vertices of the meshes, wood and leaves alike, that lie more than a millimetre inside an obstacle; none without
    /// an obstacle, or without a measurement.
    pub inside_obstacle: Option<u64>,
    /// Depth of the deepest vertex inside an obstacle, metres; 0 if there is none inside; none as above.
    #[serde(default)]
    pub inside_obstacle_depth_m: Option<f64>,
}

/// The part of a report about a robot: its structure, and the assumed properties of its tissues.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotReport {
    /// Rigid bodies, including fruits that can break off.
    pub bodies: u64,
    /// Hinges: two for each joint.
    pub hinges: u64,
    /// Fruits that can break off.
    pub breakable_fruits: u64,
    /// Mass of all bodies, kilograms.
    pub mass_kg: f64,
    /// The lowest frequency at which it swings, hertz; 0 for a plant without joints.
    pub lowest_hz: f64,
    /// The longest time step for a sound simulation, seconds.
    pub time_step_s: f64,
    /// Assumed wood: `hardwood`, `softwood` or `green`. None of it is measured.
    pub wood: String,
    /// Young's modulus of that wood, pascals.
    pub modulus_pa: f64,
    /// The density of that wood, kilograms per cubic metre.
    pub density_kg_m3: f64,
    /// The stress at which that wood breaks, pascals.
    pub strength_pa: f64,
}
