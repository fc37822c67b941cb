//! What colours say against the classifier, which sees none.

use ink::StrokeClass;

use super::{Findings, unsure};
use crate::draft::Draft;
use crate::near::openness;
use crate::palette;
use crate::thresholds::STRAIGHT;

/// Green lines that were taken for the side of a trunk or a part of a pot are what the classifier thinks next likely: a line
/// is an axis, and what encloses something a blade if nothing else is likelier.
pub(super) fn green_is_no_bark(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    if !palette::is_painted(draft.ink) {
        return found;
    }
    for (k, stroke) in draft.ink.strokes.iter().enumerate() {
        let is_bark = matches!(draft.class[k], StrokeClass::TrunkOutline | StrokeClass::Pot);
        if !is_bark || !palette::is_green_stroke(stroke) || !unsure(draft, k) {
            continue;
        }
        let is_line = openness(stroke) > STRAIGHT;
        // A green outline that branches is a stem by its silhouette.
        if is_line || draft.class[k] == StrokeClass::Pot {
            found.set(k, if is_line { StrokeClass::Axis } else { StrokeClass::Blade });
        }
    }
    found
}
