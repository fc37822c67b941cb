//! Rules about pots and the ground over roots.

use geom::{bounds, polyline_length, signed_area};
use glam::DVec2;
use ink::{InkStroke, StrokeClass};

use super::{Findings, any, ends, free, openness, unsure, upright};
use crate::contour::width_at;
use crate::draft::Draft;
use crate::thresholds::{SAME_PLACE, WELL_SHORT};

/// A pot is at least this wide.
const NARROWEST: f64 = 0.05;
/// Height of a pot relative to its width.
const TALL: core::ops::Range<f64> = 0.25..2.0;
/// Least width of a pot's rim relative to the pot's width; a plant growing from it is narrower than [`FOOT`].
const RIM: f64 = 0.8;
/// Greatest width of the foot of a plant in a pot, as a share of the pot's width.
const FOOT: f64 = 0.9;
/// Straightness of the ground: the distance between its ends is more than this share of its length.
const LEVEL: f64 = 0.95;
/// The ground is wider than this share of the plant on it.
const WIDE: f64 = 0.6;
/// A line that begins at the ground begins this near to it.
const NEAR: f64 = 0.025;
/// A plant in a pot begins at its rim, or inside it by less than this share of its height.
const INSIDE: f64 = 0.4;
/// Lowest share of a plant's height that is its foot.
const LOWEST: f64 = 0.05;
/// Share of a pot's height at which its rim is measured.
const UPPER: f64 = 0.93;
/// Share of a pot's height at which its bottom is measured.
const LOWER: f64 = 0.1;
/// Least width of the rim relative to the bottom.
const WIDENS: f64 = 0.95;
/// A pot fills this share of its box.
const FULL: f64 = 0.6;
/// The ground rises by less than this share of its width, and the plant on it by more than [`RISES`] times [`NEAR`].
const FLAT: f64 = 0.08;
/// Greatest width of a taproot below relative to above; a pot is wider.
const POINTED: f64 = 0.4;
/// Factor of [`NEAR`] by which a plant rises above the ground.
const RISES: f64 = 4.0;
/// The ends of an arc are farther apart than this share of its length.
const OPEN_ARC: f64 = 0.7;
/// A hill is lower than this share of its width.
const HILLY: f64 = 0.5;
/// Both ends of a hill lie in this lowest share of its height.
const ENDS_LOW: f64 = 0.25;

/// Finds pots: a box at the bottom with a flat top on which the plant stands.
pub(super) fn pots(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Corolla, Crown, Fruit, Ground, Pot, Scribble, TrunkOutline};
    let mut found = Findings::default();
    if any(draft, &[Pot, Crown]) {
        return found;
    }
    let boxes: Vec<(DVec2, DVec2)> =
        draft.ink.strokes.iter().map(|s| bounds(&s.points).unwrap_or_default()).collect();
    let low = (0..boxes.len())
        .filter(|&k| draft.class[k] != Ground)
        .map(|k| boxes[k].0.y)
        .fold(f64::INFINITY, f64::min);
    for k in 0..draft.class.len() {
        let (lo, hi) = boxes[k];
        let (wide, tall) = (hi.x - lo.x, hi.y - lo.y);
        if !unsure(draft, k)
            || lo.y > low + SAME_PLACE
            || wide < NARROWEST
            || !(TALL.start * wide..TALL.end * wide).contains(&tall)
        {
            continue;
        }
        let points = &draft.ink.strokes[k].points;
        // Lines in the pot: their foot is at its upper edge and they rise out of it.
        let feet: Vec<(usize, f64)> = (0..draft.class.len())
            .filter(|&j| j != k && [Axis, TrunkOutline].contains(&draft.class[j]))
            .filter(|&j| {
                let (l, h) = boxes[j];
                l.y > hi.y - INSIDE * tall && l.y < hi.y + WELL_SHORT && h.y > hi.y + 0.5 * tall
            })
            .filter_map(|j| {
                let foot: Vec<DVec2> = draft.ink.strokes[j]
                    .points
                    .iter()
                    .copied()
                    .filter(|p| p.y < boxes[j].0.y + LOWEST * (boxes[j].1.y - boxes[j].0.y))
                    .collect();
                bounds(&foot).filter(|(l, h)| l.x > lo.x && h.x < hi.x).map(|(l, h)| (j, h.x - l.x))
            })
            .collect();
        let nothing_beside = (0..boxes.len())
            .all(|j| j == k || boxes[j].0.y > lo.y + 0.5 * tall || contained(boxes[j], (lo, hi)));
        let is_pot = match draft.class[k] {
            TrunkOutline | Fruit => draft.ink.strokes[k].outline().is_some_and(|o| {
                let at = |t: f64| width_at(o, lo.y + t * tall);
                let flat = at(UPPER) > RIM * wide && at(UPPER) >= WIDENS * at(LOWER);
                flat && signed_area(o) > FULL * wide * tall && feet.iter().any(|f| f.1 < FOOT * wide)
            }),
            Corolla | Scribble => feet.len() >= 3,
            _ => false,
        };
        if is_pot && nothing_beside && !feet.is_empty() && polyline_length(points) > 0.0 {
            found.set(k, Pot);
            break;
        }
    }
    found
}

fn contained(inner: (DVec2, DVec2), outer: (DVec2, DVec2)) -> bool {
    inner.0.cmpge(outer.0 - DVec2::splat(SAME_PLACE)).all()
        && inner.1.cmple(outer.1 + DVec2::splat(SAME_PLACE)).all()
}

/// Finds the ground over roots: a long level line on which the plant stands, with nothing but lines below it, which
/// are roots.
pub(super) fn ground_over_roots(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    let strokes = &draft.ink.strokes;
    let boxes: Vec<(DVec2, DVec2)> = strokes.iter().filter_map(|s| bounds(&s.points)).collect();
    if boxes.len() != strokes.len() || draft.class.contains(&StrokeClass::Ground) {
        return found;
    }
    let level = |k: usize| {
        let (lo, hi) = boxes[k];
        openness(&strokes[k]) > LEVEL && hi.y - lo.y < FLAT * (hi.x - lo.x)
    };
    for (k, &(lo, hi)) in boxes.iter().enumerate() {
        let others = || boxes.iter().enumerate().filter(|(j, _)| *j != k);
        let reach = others().map(|(_, b)| *b).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let wide = reach.is_some_and(|(l, h)| hi.x - lo.x > WIDE * (h.x - l.x));
        if !unsure(draft, k) || !level(k) || !wide {
            continue;
        }
        let y = lo.y.midpoint(hi.y);
        let below: Vec<usize> =
            others().filter(|(_, b)| b.1.y < y + NEAR && b.0.y < y - NEAR).map(|(j, _)| j).collect();
        // An outline with a bottom is a pot.
        let line = |j: usize| openness(&strokes[j]) > 0.5 && !level(j);
        let lines = below.iter().all(|&j| unsure(draft, j) && (line(j) || tapers(&strokes[j], y)));
        let taproot = below.iter().any(|&j| !line(j)) && others().any(|(_, b)| b.1.y > y + RISES * NEAR);
        let stands = others().any(|(j, b)| {
            b.1.y > y + RISES * NEAR && b.0.y < y + NEAR && upright(draft, j) && b.0.x > lo.x && b.1.x < hi.x
        });
        // Roots hang from the ground or from one another: separate lines are something else.
        let hangs = below.iter().any(|&j| boxes[j].1.y > y - NEAR);
        if lines && (stands || taproot) && hangs {
            found.settle(k, StrokeClass::Ground);
            below.into_iter().filter(|&j| line(j)).for_each(|j| found.settle(j, StrokeClass::Axis));
            break;
        }
    }
    found
}

/// Finds a hill: a wide arc over which everything else stands.
pub(super) fn hill(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    let strokes = &draft.ink.strokes;
    if draft.class.contains(&StrokeClass::Ground) {
        return found;
    }
    for (k, stroke) in strokes.iter().enumerate().filter(|(k, _)| free(draft, *k)) {
        let Some((lo, hi)) = bounds(&stroke.points) else { continue };
        let (a, b) = ends(&stroke.points);
        let tall = hi.y - lo.y;
        // Its ends are its lowest places, and it is wide.
        let arc = openness(stroke) > OPEN_ARC
            && tall > FLAT * (hi.x - lo.x)
            && tall < HILLY * (hi.x - lo.x)
            && a.y.max(b.y) < lo.y + ENDS_LOW * tall;
        if !arc {
            continue;
        }
        let others = || strokes.iter().enumerate().filter(move |(j, _)| *j != k).map(|(_, s)| &s.points);
        let reach = others().filter_map(|p| bounds(p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let Some((low, high)) = reach else { continue };
        let top = |x: f64| {
            let over = stroke.points.windows(2).filter(|w| (w[0].x > x) != (w[1].x > x));
            over.map(|w| w[0].y.max(w[1].y)).fold(f64::NEG_INFINITY, f64::max)
        };
        let above = others().flatten().all(|p| p.y > top(p.x) - NEAR);
        let stands = others().flatten().any(|p| p.y < top(p.x) + NEAR);
        let wide = lo.x < low.x + NEAR && hi.x > high.x - NEAR && high.y > hi.y + tall;
        if above && stands && wide {
            found.settle(k, StrokeClass::Ground);
            break;
        }
    }
    found
}

/// Whether an outline is a taproot: it hangs from a level, open there or closed, and runs to a point below.
fn tapers(stroke: &InkStroke, level: f64) -> bool {
    let Some((outline, (lo, hi))) = stroke.outline().zip(bounds(&stroke.points)) else { return false };
    let at = |share: f64| width_at(outline, lo.y + share * (hi.y - lo.y));
    (hi.y - level).abs() < NEAR
        && hi.y - lo.y > hi.x - lo.x
        && at(2.0 * LOWER) < POINTED * at(1.0 - 2.0 * LOWER)
}
