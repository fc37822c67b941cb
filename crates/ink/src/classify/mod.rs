//! Classification of strokes (He and Cheng 2021, section 4.1): `Ink -> Vec<Classified>`.
//!
//! | step | module |
//! |---|---|
//! | a stroke on its own | `features` |
//! | a stroke among the others | `context`, `region` |
//! | the support vector machine | `svm`, `packed`, `model` |
//! | the table it is trained from, and how good it is | `training` |

use std::sync::{Arc, OnceLock};

mod context;
mod features;
mod model;
mod packed;
mod region;
mod svm;
#[cfg(any(test, feature = "training"))]
mod training;

pub use context::{KeptMeasures, features};
pub use features::StrokeFeatures;
pub use model::{Classified, Source};
pub use svm::SvmError;
#[cfg(any(test, feature = "training"))]
pub use training::{
    FEW_CLEAR, HeldOut, StrokeFigures, StrokeModelTexts, StrokeRow, StrokeSource, cross_validate_strokes,
    held_out_strokes, read_stroke_table, train_strokes, write_stroke_table,
};

use base::{Run, map_indexed};

use crate::{Ink, StrokeClass};
use model::StrokeModels;

/// Name of the one rule that is applied here because it needs no other stroke: crowns and trunks are recognised by
/// their surroundings, so a line by itself, the first that anybody draws, is a stem. No rule of reading changes it.
pub const LONE_LINE: &str = "lone-line";
/// Least end gap over length of a stroke that is nearly straight: a half circle has 0.64.
const LONE_GAP: f64 = 0.7;

/// Name of a second rule applied here: a line on which several plants stand is their ground.
pub const COMMON_GROUND: &str = "common-ground";

/// Name of a third rule applied here: a line that follows another all the way has the class of that line.
pub const DRAWN_AGAIN: &str = "drawn-again";

/// Returns the models in the repository.
fn trained() -> Option<&'static StrokeModels> {
    static MODELS: OnceLock<Option<StrokeModels>> = OnceLock::new();
    MODELS
        .get_or_init(|| {
            let scale = include_str!("../../data/strokes.scale");
            StrokeModels::unpack(scale, include_bytes!("../../data/strokes.packed")).ok()
        })
        .as_ref()
}

/// Classifies each stroke.
///
/// One answer per stroke of `ink.strokes`, in its order, the same on every platform. Not guaranteed: that it is
/// right (see `docs/strokes.md`); the user can override any class. About 0.1 ms a stroke in a
/// sketch of 30; linear in strokes beyond 48. A cancelled run ends soon, with classes that mean nothing.
///
/// ```
/// use glam::DVec2;
/// let stem = vec![DVec2::ZERO, DVec2::new(3.0, 300.0)];
/// let ink = ink::clean(&ink::Drawing::from_polylines("stem", &[stem]), &mut base::Report::default());
/// let classes = ink::classify(&ink, &base::Run::plain());
/// assert_eq!(classes.len(), ink.strokes.len());
/// assert!((0.0..=1.0).contains(&classes[0].confidence));
/// ```
pub fn classify(ink: &Ink, run: &Run<'_>) -> Vec<Classified> {
    classify_again(ink, &[], &mut KeptMeasures::default(), run)
}

/// Classifies a growing drawing as [`classify`] does: strokes whose class is known keep it, and strokes that are
/// unchanged are not measured again.
///
/// `known[i]` belongs to `ink.strokes[i]`; strokes beyond its end are unknown. A new stroke may change the class of
/// others, but a known class is not judged again. `kept`: from the previous call, or empty; it changes no result.
pub fn classify_again(
    ink: &Ink,
    known: &[Option<Classified>],
    kept: &mut KeptMeasures,
    run: &Run<'_>,
) -> Vec<Classified> {
    judge(trained(), ink, known, kept, run)
}

fn judge(
    models: Option<&StrokeModels>,
    ink: &Ink,
    known: &[Option<Classified>],
    kept: &mut KeptMeasures,
    run: &Run<'_>,
) -> Vec<Classified> {
    if ink.subjects.is_parted() {
        return judge_each(models, ink, known, kept, run);
    }
    let unknown = |i: usize| known.get(i).is_none_or(Option::is_none);
    let rows = context::features_again(ink, unknown, kept, run);
    let before = core::mem::take(&mut kept.judged);
    let decide = |i: usize| {
        // Equal features mean an unchanged stroke.
        if let Some((_, class)) = before.get(i).filter(|(row, _)| *row == rows[i]) {
            return *class;
        }
        // A test reads the models, so they are always present.
        let models = models.filter(|_| run.cancel.check().is_ok());
        models.map(|m| m.decide(&rows[i])).unwrap_or_default()
    };
    if let ([row], None | Some(None)) = (rows.as_slice(), known.first())
        && row.gap > LONE_GAP
    {
        let source = Source::Rule(LONE_LINE);
        return vec![Classified { class: StrokeClass::Axis, confidence: 1.0, source, ..decide(0) }];
    }
    let is_known = |i: usize| known.get(i).copied().flatten();
    let classes = map_indexed(run.executor, rows.len(), |i| is_known(i).unwrap_or_else(|| decide(i)));
    if run.cancel.check().is_ok() {
        // A class that was known is no evidence for the current features.
        let judged = |(i, class): (usize, &Classified)| match is_known(i) {
            Some(_) => before.get(i).copied().unwrap_or_default(),
            None => (rows[i], *class),
        };
        kept.judged = Arc::new(classes.iter().enumerate().map(judged).collect());
    }
    classes
}

/// Classifies the strokes of every plant by itself: its neighbours are no evidence for them.
fn judge_each(
    models: Option<&StrokeModels>,
    ink: &Ink,
    known: &[Option<Classified>],
    kept: &mut KeptMeasures,
    run: &Run<'_>,
) -> Vec<Classified> {
    if run.cancel.check().is_err() {
        return vec![Classified::default(); ink.strokes.len()];
    }
    let ground = Classified {
        class: StrokeClass::Ground,
        confidence: 0.5,
        source: Source::Rule(COMMON_GROUND),
        shares: StrokeClass::ALL.map(|c| if c == StrokeClass::Ground { 0.5 } else { 0.0 }),
        shown: None,
    };
    let mut found: Vec<Classified> =
        (0..ink.strokes.len()).map(|i| known.get(i).copied().flatten().unwrap_or(ground)).collect();
    for rows in &ink.subjects.plants {
        let part = ink.part(rows);
        let own: Vec<Option<Classified>> = rows.iter().map(|&i| known.get(i).copied().flatten()).collect();
        let judged = judge(models, &part, &own, kept.measures_of_plant(rows), run);
        for (&row, class) in rows.iter().zip(judged) {
            if let Some(slot) = found.get_mut(row) {
                *slot = class;
            }
        }
    }
    for &(row, first) in &ink.subjects.again {
        if let (None, Some(&class)) = (known.get(row).copied().flatten(), found.get(first)) {
            found[row] = Classified { source: Source::Rule(DRAWN_AGAIN), shown: None, ..class };
        }
    }
    found
}

#[cfg(test)]
mod tests;
