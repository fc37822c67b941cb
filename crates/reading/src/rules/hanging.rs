//! Rules about rings: fruits that hang from twigs, and outlines that are no twigs.

use geom::{bounds, closest_on_polyline, signed_area};
use glam::DVec2;
use ink::StrokeClass;

use super::{CLOSED, Findings, free, openness};
use crate::draft::Draft;
use crate::thresholds::{STOPPED_SHORT, STRAIGHT};
use crate::{Kind, READ_AS};

/// Fewest fruits on twigs.
const FEWEST: usize = 2;
/// Least ratio of the shorter to the longer side of a ring's box.
const ROUND: f64 = 0.75;
/// Least share of its box that a ring fills: a circle fills 0.79, a lens less than 0.6 (*geometry*).
const FILLS: f64 = 0.68;
/// A fruit hangs from a line that touches it above this share of its height.
const UPPER: f64 = 0.7;
/// A fruit is smaller than this share of the drawing.
const SMALL: f64 = 0.22;
/// The largest fruit is at most this factor of the smallest one wide.
const ALIKE: f64 = 2.2;
/// Rings of a palm are nuts if they are smaller than this share of the drawing.
const NUT: f64 = 0.12;
/// A twig is longer than this factor of a ring's width.
const TWIG: f64 = 2.0;
/// An outline of less than this size is a leaf of a bare tree; a larger one may be a limb.
const LEAF: f64 = 0.2;
/// Least area of a leaf over the square of its outline's length (0.08 for a circle, *geometry*).
const OPEN: f64 = 0.012;

struct Ring {
    stroke: usize,
    lo: DVec2,
    hi: DVec2,
}

/// Turns round rings that hang from twigs into fruits, and other strokes that were taken for fruits into lines or
/// blades.
pub(super) fn fruits_on_twigs(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Blade, Crown, Fruit};
    let mut found = Findings::default();
    if draft.class.contains(&Crown) || draft.kind.is_some_and(|k| k.is_like(Kind::Flower)) {
        return found;
    }
    if draft.kind == Some(Kind::Palm) {
        let rings = (0..draft.class.len()).filter(|&k| free(draft, k)).filter_map(|k| ring(draft, k));
        rings.filter(|r| r.hi.x - r.lo.x < NUT).for_each(|r| found.settle(r.stroke, Fruit));
        return found;
    }
    let lines: Vec<usize> =
        (0..draft.class.len()).filter(|&k| openness(&draft.ink.strokes[k]) > STRAIGHT).collect();
    let rings: Vec<Ring> = (0..draft.class.len())
        .filter(|&k| free(draft, k))
        .filter_map(|k| ring(draft, k))
        .filter(|r| lines.iter().any(|&l| hangs(r, &draft.ink.strokes[l].points)))
        .collect();
    let wide = |r: &Ring| r.hi.x - r.lo.x;
    let (least, most) =
        rings.iter().map(wide).fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(w), b.max(w)));
    let twig = lines.iter().any(|&l| draft.ink.strokes[l].length > TWIG * most);
    if rings.len() < FEWEST || most > ALIKE * least || most > SMALL || !twig {
        return found;
    }
    rings.iter().for_each(|r| found.settle(r.stroke, Fruit));
    for k in (0..draft.class.len()).filter(|&k| draft.class[k] == Fruit && free(draft, k)) {
        if lines.contains(&k) {
            found.settle(k, Axis);
        } else if !rings.iter().any(|r| r.stroke == k) && ring(draft, k).is_none() {
            found.settle(k, Blade);
        }
    }
    found
}

fn ring(draft: &Draft<'_>, k: usize) -> Option<Ring> {
    let s = &draft.ink.strokes[k];
    let (lo, hi) = bounds(&s.points).filter(|_| openness(s) < CLOSED)?;
    let (wide, tall) = (hi.x - lo.x, hi.y - lo.y);
    let area = signed_area(s.outline()?);
    (wide.min(tall) > ROUND * wide.max(tall) && area > FILLS * wide * tall).then_some(Ring {
        stroke: k,
        lo,
        hi,
    })
}

/// Whether one end of a line meets a ring at its top, or the line passes there.
fn hangs(ring: &Ring, line: &[DVec2]) -> bool {
    let top = DVec2::new(0.5 * (ring.lo.x + ring.hi.x), ring.hi.y);
    let near = STOPPED_SHORT.min(0.5 * (ring.hi.x - ring.lo.x));
    let Some(c) = closest_on_polyline(line, top) else { return false };
    c.distance < near && c.point.y > ring.lo.y + UPPER * (ring.hi.y - ring.lo.y)
}

/// Turns small outlines of a drawing that is taken for a bare tree into leaves.
pub(super) fn outlines_are_no_twigs(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    if !draft.is_tree() {
        return found;
    }
    for k in draft.strokes_of_class(StrokeClass::Axis) {
        let s = &draft.ink.strokes[k];
        if !free(draft, k) || draft.rule[k] != Some(READ_AS) || openness(s) > CLOSED {
            continue;
        }
        let small = bounds(&s.points).is_some_and(|(lo, hi)| lo.distance(hi) < LEAF);
        let hull = s.hull();
        let area = s.outline().map_or(0.0, signed_area);
        if small && hull.len() > 2 && area > OPEN * s.length * s.length && area > 0.5 * signed_area(hull) {
            found.settle(k, StrokeClass::Blade);
        }
    }
    found
}
