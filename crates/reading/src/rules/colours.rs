//! The rule about colours, which the classifier does not see.

use ink::StrokeClass;

use super::{Findings, unsure};
use crate::draft::Draft;
use crate::near::openness;
use crate::palette;
use crate::structure::is_lens;
use crate::thresholds::STRAIGHT;

/// Turns green lines that were taken for the side of a trunk or a part of a pot into axes; other green parts of pots,
/// and green outlines that are pointed at both ends, into blades.
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
        let is_blade = draft.class[k] == StrokeClass::Pot || is_lens(&stroke.points);
        if is_line || is_blade {
            found.set(k, if is_line { StrokeClass::Axis } else { StrokeClass::Blade });
        }
    }
    found
}
