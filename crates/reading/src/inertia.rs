//! Strokes keep the class that was shown to a person while the drawing grows, unless the whole clearly contradicts it.

use ink::{Classified, Ink, Source};

use crate::{Kind, Reading, Scored};

/// The source of a class that a stroke keeps because it was shown so, although the classifier now gives another one.
pub const AS_SHOWN: &str = "as-shown";

/// Least share of a kind, other than the one shown, that replaces it.
const SURE: f64 = 0.5;
/// Such a kind also explains the drawing better than the shown one by this factor, and by as much more as the shown
/// one was better without the last stroke. So one stroke outweighs all before it only if it is stronger evidence than
/// they were, and two that agree are believed.
const BETTER: f64 = 2.0;
/// Within one kind, the classifier's shares of the new classes are larger than those of the shown classes by at least
/// this, averaged over the length of the changed strokes. `cargo xtask read-in-turn`: with 0.1 labelled drawings end
/// as correct as when they are read afresh, with more they do not.
const MARGIN: f64 = 0.1;

/// Returns the classes with which a plant is read as it was shown; `None` if it is read so anyway.
pub(crate) fn as_shown(ink: &Ink, classes: &[Classified], free: &Reading) -> Option<Vec<Classified>> {
    let mut kept = classes.to_vec();
    let mut differs = false;
    for ((stroke, class), said) in ink.strokes.iter().zip(&mut kept).zip(classes) {
        let Some(shown) = said.shown.filter(|_| said.source != Source::User) else { continue };
        *class = Classified { class: shown, confidence: 1.0, source: Source::Rule(AS_SHOWN), ..*said };
        differs |= class_of(free, stroke.index).is_some_and(|c| c.class != shown);
    }
    differs.then_some(kept)
}

/// Whether a reading gives every stroke the class that it was shown with.
pub(crate) fn agrees(ink: &Ink, classes: &[Classified], reading: &Reading) -> bool {
    ink.strokes.iter().zip(classes).all(|(stroke, said)| {
        let now = class_of(reading, stroke.index).map(|c| c.class);
        said.shown.is_none_or(|shown| now == Some(shown))
    })
}

fn class_of(reading: &Reading, index: u32) -> Option<&crate::StrokeReading> {
    let at = reading.strokes.binary_search_by_key(&index, |s| s.index).ok()?;
    reading.strokes.get(at)
}

/// Whether a reading clearly contradicts the one that was shown. `before`: how well each kind explains the drawing
/// without its last stroke.
pub(crate) fn is_clear(
    ink: &Ink,
    classes: &[Classified],
    (free, kind): (&Reading, Kind),
    shown: Kind,
    scores: &[Scored],
    before: impl FnOnce() -> Vec<Scored>,
) -> bool {
    let score = |scores: &[Scored], kind: Kind| -> f64 {
        scores.iter().filter(|s| s.kind.is_like(kind)).map(|s| s.score).sum()
    };
    if !kind.is_like(shown) {
        let (new, old) = (score(scores, kind), score(scores, shown));
        let clear = new > SURE && new > BETTER * old;
        if !clear || ink.strokes.len() == 1 {
            return clear;
        }
        let before = before();
        return new * score(&before, kind) > BETTER * old * score(&before, shown);
    }
    let (mut sum, mut length) = (0.0, 0.0);
    for (stroke, said) in ink.strokes.iter().zip(classes) {
        let (Some(was), Some(now)) = (said.shown, class_of(free, stroke.index)) else { continue };
        if now.class != was && said.source != Source::User {
            sum += stroke.length * (said.shares[now.class.place()] - said.shares[was.place()]);
            length += stroke.length;
        }
    }
    sum > MARGIN * length
}

/// Sets how sure the classifier is of strokes that keep the class that was shown.
pub(crate) fn tell(reading: &mut Reading, ink: &Ink, classes: &[Classified]) {
    for s in reading.strokes.iter_mut().filter(|s| s.source == Source::Rule(AS_SHOWN)) {
        let Ok(row) = ink.strokes.binary_search_by_key(&s.index, |s| s.index) else { continue };
        let Some(said) = classes.get(row) else { continue };
        if s.class == said.class {
            (s.source, s.confidence) = (said.source, said.confidence);
        } else {
            s.confidence = said.shares[s.class.place()];
        }
    }
}
