//! The rule about stems that spread, each to a leaf of its own.

use glam::DVec2;
use ink::StrokeClass;

use super::{Findings, outside, standing, unsure};
use crate::draft::Draft;

/// A stem ends this near to its leaf.
const TOUCH: f64 = 0.025;

/// Finds stems: lines that spread from one place, each to a leaf of its own. The sides of a trunk come closer upwards
/// or run side by side.
pub(super) fn stems(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    let blades: Vec<&[DVec2]> = draft
        .strokes_of_class(StrokeClass::Blade)
        .into_iter()
        .filter_map(|k| draft.ink.strokes[k].outline())
        .collect();
    let sides = standing(draft, StrokeClass::TrunkOutline);
    if blades.len() < 2 || sides.len() < 2 {
        return found;
    }
    let leads: Vec<(usize, usize, DVec2, DVec2)> = sides
        .iter()
        .filter_map(|&(k, top, foot)| {
            let reached = (0..blades.len()).map(|b| (outside(blades[b], top), b));
            let (near, b) = reached.min_by(|a, b| a.0.total_cmp(&b.0))?;
            (near < TOUCH).then_some((k, b, top, foot))
        })
        .collect();
    let spread = |a: &(usize, usize, DVec2, DVec2), b: &(usize, usize, DVec2, DVec2)| {
        a.1 != b.1 && a.2.distance(b.2) > 2.0 * a.3.distance(b.3)
    };
    let spreading: Vec<usize> =
        leads.iter().filter(|a| leads.iter().any(|b| a.0 != b.0 && spread(a, b))).map(|l| l.0).collect();
    for k in spreading {
        if unsure(draft, k) {
            found.set(k, StrokeClass::Axis);
        }
    }
    found
}
