//! Facts of the file of a cloud, and warnings about odd numbers.

use base::{Report, Unit};
use glam::DVec3;
use serde::Serialize;

use super::las_system::is_same_unit;
use super::sink::{Said, Sink};
use crate::ExportSpec;

/// Facts of the file of a scan: its numbers as they stand there, in its own unit and axes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CloudFacts {
    /// The kind of file, more closely; may be empty.
    pub detail: String,
    /// Points that are read.
    pub points: u64,
    /// Points that are not finite numbers, or absurdly far away.
    pub not_finite: u64,
    /// Points of the classes of noise.
    pub noise: u64,
    /// Points that the file has deleted (LAS: withheld).
    pub deleted: u64,
    /// Points far from all others.
    pub strays: u64,
    /// Lowest corner of the box around the points that are read.
    pub min: [f64; 3],
    /// Highest corner.
    pub max: [f64; 3],
    /// Names of the columns, as the file has them or as they are read.
    pub columns: Vec<String>,
    /// Whether there are colours.
    pub has_colors: bool,
    /// Points of each class that is a number.
    pub classes: Vec<ClassCount>,
    /// The coordinate system, as the file names it.
    pub coordinate_system: Option<String>,
    /// The unit of that system.
    pub unit: Option<String>,
    /// The unit that the extent is of, if it is a tree or a plant: a guess.
    pub unit_guess: &'static str,
    /// The step in which coordinates are written, millimetres, where the file says it or single precision shows it; in the unit that
    /// is asked for.
    pub step_mm: Option<f64>,
}

/// Points of a class.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ClassCount {
    /// Its number.
    pub class: u8,
    /// Its name: the file's, or that of the specification of LAS.
    pub name: String,
    /// Its points.
    pub points: u64,
    /// What becomes of it: `ground`, `wood`, `leaf`, `left out`, or nothing.
    pub used_as: &'static str,
}

/// Names of the classes of LAS 1.4.
const NAMES: [&str; 19] = [
    "never classified",
    "unclassified",
    "ground",
    "low vegetation",
    "medium vegetation",
    "high vegetation",
    "building",
    "low noise",
    "model key-point",
    "water",
    "rail",
    "road",
    "overlap",
    "wire guard",
    "wire conductor",
    "transmission tower",
    "wire connector",
    "bridge deck",
    "high noise",
];

/// A step of single precision from which on it is told, millimetres: scanners are off by two.
const COARSE_MM: f64 = 1.0;
/// No plant is higher, metres; and what is smaller as metres is one that a scanner of plants sees.
const HIGHEST_M: f64 = 130.0;

impl CloudFacts {
    pub(super) fn collect(sink: &Sink, strays: u64, spec: &ExportSpec, report: &mut Report) -> Self {
        let bounds = sink.cloud.bounds();
        let single = single_step(&sink.cloud.points).map(|step| step * spec.unit.metres() * 1000.0);
        let facts = Self {
            detail: sink.detail.clone(),
            points: sink.cloud.points.len() as u64,
            not_finite: sink.dropped,
            noise: sink.noise,
            deleted: sink.deleted,
            strays,
            min: bounds.min.to_array(),
            max: bounds.max.to_array(),
            columns: sink.columns.clone(),
            has_colors: !sink.cloud.colors.is_empty(),
            classes: sink
                .numbers
                .iter()
                .map(|(&class, &points)| ClassCount::new(class, points, sink))
                .collect(),
            coordinate_system: sink.system.clone(),
            unit: sink.unit.as_ref().map(|u| u.0.clone()),
            unit_guess: guess(bounds.size()),
            step_mm: sink.step.map(|step| step * spec.unit.metres() * 1000.0).or(single),
        };
        facts.tell(spec, sink.unit.as_ref().map(|u| u.1), single, report);
        facts
    }

    fn tell(&self, spec: &ExportSpec, metres: Option<f64>, single: Option<f64>, report: &mut Report) {
        let mut left_out = |code, count: u64, what: &str| {
            if count > 0 {
                report.warn(code, format!("left out: {count} points {what}"));
            }
        };
        left_out("points-not-finite", self.not_finite, "that are not finite numbers or absurdly far away");
        left_out("points-noise", self.noise, "that are noise by their class");
        left_out("points-deleted", self.deleted, "that the file has deleted (withheld)");
        left_out("points-stray", self.strays, "that lie more than ten times as far out as all others");
        if let Some(step) = single.filter(|step| *step >= COARSE_MM) {
            base::warn!(
                report,
                "scan-single-precision",
                { step_mm = step },
                "the coordinates are in single precision, which is too coarse so far from the origin: they stand {step_mm:.1} mm apart. \
                 Export the scan again with its own origin or in double precision"
            );
        }
        let unit = spec.unit.metres();
        if let Some(metres) = metres.filter(|metres| !is_same_unit(*metres, unit)) {
            let is = self.unit.as_deref().unwrap_or_default();
            let word = Unit::ALL.into_iter().find(|u| is_same_unit(u.metres(), metres));
            let advice = word.map_or_else(String::new, |word| format!("; give {} as its unit", word.word()));
            report.warn(
                "scan-unit",
                format!(
                    "its coordinate system counts in another unit ({}) than is taken for it here ({}){advice}",
                    base::quoted(is),
                    spec.unit.plural()
                ),
            );
        }
    }
}

impl ClassCount {
    fn new(class: u8, points: u64, sink: &Sink) -> Self {
        let own = sink.names.get(&class);
        let name =
            own.map(String::as_str).or(NAMES.get(usize::from(class)).copied()).unwrap_or("of its maker");
        let used_as = match own.and_then(|name| Said::from_word(name)).unwrap_or(Said::from_number(class)) {
            Said::Noise => "left out",
            Said::Class(mesh::PointClass::Unknown) => "",
            Said::Class(class) => class.word(),
        };
        Self { class, name: base::quoted(name), points, used_as }
    }
}

/// How far neighbouring numbers of single precision are apart at the farthest coordinate, if all are of single precision.
fn single_step(points: &[DVec3]) -> Option<f64> {
    #[expect(clippy::cast_possible_truncation, reason = "what is lost is what is asked")]
    let is_single = |x: f64| f64::from(x as f32).to_bits() == x.to_bits();
    if !points.iter().all(|p| p.to_array().into_iter().all(is_single)) {
        return None;
    }
    let farthest = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    #[expect(clippy::cast_possible_truncation, reason = "it is of single precision")]
    let farthest = farthest as f32;
    Some(f64::from(f32::from_bits(farthest.to_bits() + 1)) - f64::from(farthest))
}

/// The unit of a plant or a plot of such an extent.
fn guess(size: DVec3) -> &'static str {
    // Whichever axis points up, a cloud is at least as high as its least side.
    if size.min_element() > HIGHEST_M || size.max_element() > 1000.0 * HIGHEST_M { "mm" } else { "m" }
}
