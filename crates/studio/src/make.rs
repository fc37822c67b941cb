//! From a drawing to everything that is made of it.

use std::collections::BTreeMap;

use base::{Cancelled, Report, Run, Seed};
use mesh::Model;
use plant::Plant;
use sketch::{Drawing, Reading, SketchSpec, StrokeClass};
use skin::SkinSpec;

use crate::report::{Counts, Fidelity, ItemReport, StrokeReport, TimingsMs};

/// Classes that the user set, by stroke index in the drawing.
pub type ClassOverrides = BTreeMap<u32, StrokeClass>;

/// What is asked of a sketch: saved with the document.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SketchOptions {
    /// How the drawing is understood and given depth.
    pub spec: SketchSpec,
    /// How the plant is meshed.
    pub skin: SkinSpec,
    /// Classes that the user set.
    pub classes: ClassOverrides,
}

/// Everything made from one drawing.
#[derive(Clone, Debug)]
pub struct Made {
    /// What was meant, still flat.
    pub reading: Reading,
    /// The plant.
    pub plant: Plant,
    /// Its meshes and materials.
    pub model: Model,
    /// The report's entry; `output` and the times of reading and writing are the shell's to fill.
    pub item: ItemReport,
}

/// Why nothing was made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MakeError {
    /// The drawing has no stroke that could be used.
    #[error(
        "drawing \"{name}\" has no usable stroke ({strokes} in the file): draw at least one line of two points"
    )]
    NoStrokes {
        /// Name of the drawing.
        name: String,
        /// Strokes that the file holds.
        strokes: usize,
    },
    /// A class was set for a stroke that is not there.
    #[error(
        "a class is set for stroke {index}, but drawing \"{name}\" has {strokes} strokes (numbered from 0)"
    )]
    NoSuchStroke {
        /// Name of the drawing.
        name: String,
        /// The index given.
        index: u32,
        /// Strokes that the drawing holds.
        strokes: usize,
    },
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Makes a plant and its meshes from a drawing (paper 000).
///
/// The same drawing, options and seed give the same bits on every platform and for any executor.
/// Cost: linear in ink and organs, some milliseconds for a drawing of 30 strokes.
///
/// # Errors
/// [`MakeError`]: nothing usable in the drawing, an override of a missing stroke, or a cancelled run.
pub fn make_from_sketch(
    drawing: &Drawing,
    options: &SketchOptions,
    seed: Seed,
    run: &Run<'_>,
) -> Result<Made, MakeError> {
    let mut report = Report::default();
    let strokes = drawing.strokes.len();
    if let Some((&index, _)) = options.classes.range(u32::try_from(strokes).unwrap_or(u32::MAX)..).next() {
        return Err(MakeError::NoSuchStroke { name: drawing.name.clone(), index, strokes });
    }
    let ink = report.stage("preprocess", run.clock, |r| sketch::clean(drawing, r));
    if ink.strokes.is_empty() {
        return Err(MakeError::NoStrokes { name: drawing.name.clone(), strokes });
    }
    let mut classes = report.stage("classify", run.clock, |_| sketch::classify(&ink, run));
    for (stroke, class) in ink.strokes.iter().zip(&mut classes) {
        if let Some(&wanted) = options.classes.get(&stroke.index) {
            *class = sketch::Classified { class: wanted, confidence: 1.0 };
        }
    }
    let reading = report.stage("structure", run.clock, |r| sketch::read(&ink, &classes, r));
    run.cancel.check()?;
    let built = sketch::build(&reading, &options.spec, seed, run, &mut report)?; // books `depth` itself
    let fidelity = sketch::fidelity(&built, &reading, &ink, run);
    let mut plant = built.plant;
    plant.name.clone_from(&drawing.name);
    let mut model = report.stage("mesh", run.clock, |_| skin::skin(&plant, &options.skin, run))?;
    model.name.clone_from(&drawing.name);

    let mut counts = Counts::of_plant(&plant);
    counts.vertices = model.vertex_count() as u64;
    counts.triangles = model.triangle_count() as u64;
    let item = ItemReport {
        name: drawing.name.clone(),
        output: String::new(),
        strokes: reading.strokes.iter().map(stroke_report).collect(),
        counts,
        timings_ms: TimingsMs::from_report(&report),
        fidelity: fidelity.map_or_else(Fidelity::default, |f| Fidelity {
            reprojection_mean: f.reprojection_mean,
            reprojection_p95: f.reprojection_p95,
        }),
        digest: plant.digest_hex(),
        warnings: report.warnings.iter().map(ToString::to_string).collect(),
        ..ItemReport::default()
    };
    Ok(Made { reading, plant, model, item })
}

fn stroke_report(s: &sketch::StrokeReading) -> StrokeReport {
    StrokeReport {
        index: s.index,
        class: s.class.word().into(),
        organ: s.organ.word().into(),
        confidence: s.confidence,
    }
}
