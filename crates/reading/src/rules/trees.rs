//! Rules about trees: trunks, crowns, and the strokes in a crown.

use geom::{bounds, signed_area, simple_outline};
use glam::DVec2;
use ink::StrokeClass;

use super::{
    CLOSED, Findings, REACH, SIDES_APART, any, ends, openness, outside, share_inside, standing, unsure,
    upright,
};
use crate::contour::crown_outline;
use crate::draft::Draft;
use crate::rings::rings;
use crate::thresholds::{STOPPED_SHORT, WELL_SHORT};

/// Least length of the shorter of a trunk's sides, as a share of the longer one.
const ALIKE: f64 = 0.55;
/// A trunk is narrower than this share of its crown.
const NARROW: f64 = 0.7;
/// A crown covers at least this area.
const CROWN_AREA: f64 = 0.02;
/// A fruit in a crown lies there with this share of its points.
pub(crate) const IN_CROWN: f64 = 0.9;
/// Least ratio of the shorter to the longer side of a ring's box.
const ROUND: f64 = 0.6;
/// A stroke whose ends are farther apart than this share of its length is a line, however shaky.
const LINE: f64 = 0.6;
/// The same limit for a stalk: a slice of a fruit is an arc.
const STRAIGHT_LINE: f64 = 0.85;
/// Least share of its box that a ring fills: a circle fills 0.79, a slanting lens less than 0.55 (*geometry*).
const FILLS: f64 = 0.62;
/// Least area of a leaf over the square of its outline's length: less is a line.
const OPEN: f64 = 0.015;
/// A fruit covers less than this share of its crown.
pub(crate) const SMALL: f64 = 0.03;
/// Sides of a trunk are nearer to one another than this factor of the shorter one's length.
const BESIDE: f64 = 1.3;
/// Sides of a trunk are farther apart above than below by at most this factor.
const SPREAD: f64 = 1.6;
/// Both feet of a trunk stand within this distance of the lowest point.
const FEET: f64 = 0.15;
/// A trunk that bears fronds is slimmer than this share of its length, and at least [`FAN`] ends meet at its top.
const SLIM: f64 = 0.3;
/// Greatest width of a bare trunk's top relative to its foot.
const NARROWS: f64 = 1.15;
/// Fewest limbs of a bare trunk.
const LIMBS: usize = 3;
/// Limbs begin above this share of the trunk's height.
const LIMB_HIGH: f64 = 0.25;
/// Fewest ends of fronds that meet at a trunk's top.
const FAN: usize = 4;
/// The tops of a trunk's sides lie below this share of their crown's height.
const INTO: f64 = 0.6;
/// A lone crown has no other outline of more than this share of its area.
const LONE: f64 = 0.25;
/// A stalk drawn as two lines is narrower than this share of its leaf; a trunk is wider.
const TRUNK_WIDE: f64 = 0.1;
/// Lines form an outline if their ends meet within this share of its diagonal.
const MEETS: f64 = 0.25;
/// Step between points of a ring that are looked at: rings of fruits are short, and lie all in or all out.
const FRUIT_STRIDE: usize = 4;
/// The line of the ground rises by less than this share of its width.
const FLAT: f64 = 0.3;
/// The line of the ground lies in this lowest share of the height of the crown above it.
const CROWN_FOOT: f64 = 0.2;

/// Finds the sides of a trunk: two single lines side by side that carry a crown, or a fan of fronds.
pub(super) fn trunk_lines(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    // A trunk that was drawn as a closed outline needs no sides.
    if draft
        .strokes_of_class(StrokeClass::TrunkOutline)
        .iter()
        .any(|&k| openness(&draft.ink.strokes[k]) < 0.5)
    {
        return found;
    }
    let mut lines = standing(draft, StrokeClass::TrunkOutline);
    if lines.len() < 2 {
        lines.extend(standing(draft, StrokeClass::Axis));
    }
    let crowns: Vec<&[DVec2]> = [StrokeClass::Crown, StrokeClass::Scribble]
        .into_iter()
        .flat_map(|c| draft.strokes_of_class(c))
        .map(|k| draft.ink.strokes[k].hull())
        .filter(|h| h.len() > 2)
        .collect();
    let all_ends: Vec<(usize, DVec2)> = (0..draft.class.len())
        .flat_map(|k| {
            let p = &draft.ink.strokes[k].points;
            [(k, p[0]), (k, p[p.len() - 1])]
        })
        .collect();
    let low = all_ends.iter().map(|e| e.1.y).fold(f64::INFINITY, f64::min);
    let mut sides = None;
    for (i, &(a, a_top, a_foot)) in lines.iter().enumerate() {
        for &(b, b_top, b_foot) in &lines[i + 1..] {
            let (long, short) = (draft.ink.strokes[a].length, draft.ink.strokes[b].length);
            let gaps = (a_top.distance(b_top), a_foot.distance(b_foot));
            let alike = short.min(long) > ALIKE * short.max(long);
            let beside = gaps.0.max(gaps.1) < BESIDE * short.min(long)
                && gaps.1 > SIDES_APART
                && gaps.0 < SPREAD * gaps.1
                && (a_foot.x < b_foot.x) == (a_top.x < b_top.x);
            let deep = a_foot.y.max(b_foot.y) < low + FEET;
            if !(alike && beside && deep && unsure(draft, a) && unsure(draft, b)) {
                continue;
            }
            let crowned = crowns.iter().any(|c| {
                bounds(c).is_some_and(|(lo, hi)| {
                    outside(c, a_top) < 2.0 * REACH
                        && outside(c, b_top) < 2.0 * REACH
                        && a_foot.y.max(b_foot.y) < lo.y
                        && gaps.0 < NARROW * (hi.x - lo.x)
                })
            });
            // Fronds begin at the trunk's top and the trunk is longer than they are wide apart.
            let hub = a_top.midpoint(b_top);
            let fan = all_ends
                .iter()
                .filter(|(k, p)| *k != a && *k != b && p.distance(hub) < 0.5 * gaps.0 + WELL_SHORT)
                .count();
            let slim = gaps.0.max(gaps.1) < SLIM * short.min(long);
            let bare =
                slim && crowns.is_empty() && gaps.0 < NARROWS * gaps.1 && limbs(draft, (a, b), hub) >= LIMBS;
            let open = gaps.0 > SIDES_APART;
            if bare || (open && (crowned || (fan >= FAN && slim && crowns.is_empty()))) {
                sides = Some((a, b));
            }
        }
    }
    if let Some((a, b)) = sides {
        found.set(a, StrokeClass::TrunkOutline);
        found.set(b, StrokeClass::TrunkOutline);
    }
    found.trunk = sides.is_some();
    found
}

/// Counts lines that begin on the sides of a trunk, or at its top, and lead away; nothing else may stand as tall, or
/// bear leaves.
fn limbs(draft: &Draft<'_>, (a, b): (usize, usize), hub: DVec2) -> usize {
    use StrokeClass::{Blade, Corolla, Disc};
    if any(draft, &[Blade, Corolla, Disc]) {
        return 0;
    }
    let strokes = &draft.ink.strokes;
    let sides = [&strokes[a].points, &strokes[b].points];
    let (_, foot) = ends(sides[0]);
    let tall = hub.y - foot.y;
    let wide = sides.map(|s| ends(s).1).map(|f| f.x);
    let wide = (wide[0] - wide[1]).abs();
    let off = |p: DVec2| {
        let near = sides.into_iter().filter_map(|s| geom::distance_to_polyline(s, p));
        near.chain([p.distance(hub)]).fold(f64::INFINITY, f64::min)
    };
    (0..draft.class.len())
        .filter(|&k| k != a && k != b && openness(&strokes[k]) > LINE)
        .filter(|&k| {
            let p = &strokes[k].points;
            let (from, to) = (p[0], p[p.len() - 1]);
            let (from, to) = if off(from) < off(to) { (from, to) } else { (to, from) };
            from.y > foot.y + LIMB_HIGH * tall && off(from) < 0.5 * wide + STOPPED_SHORT && off(to) > wide
        })
        .count()
}

/// Takes the largest closed outline of the drawing for a crown if the tops of a drawn trunk reach it from below.
pub(super) fn crown_on_trunk(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Crown, Pot, TrunkOutline, Vein};
    let mut found = Findings::default();
    if any(draft, &[Crown, Pot, Vein]) {
        return found;
    }
    let closed = closed_outlines(draft);
    let largest = closed.iter().max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let Some((area, parts, outline)) = largest.filter(|c| c.1.iter().all(|&k| unsure(draft, k))) else {
        return found;
    };
    let others = closed.iter().filter(|c| c.1 != *parts).map(|c| c.0).fold(0.0, f64::max);
    let Some((lo, hi)) = bounds(outline) else { return found };
    let mut sides: Vec<(usize, DVec2, DVec2)> =
        standing(draft, TrunkOutline).into_iter().filter(|s| !parts.contains(&s.0)).collect();
    // Sides may have been taken for branches: they begin below the crown, reach it, and are about equally long.
    let outlined = sides.len();
    if outlined < 2 {
        let branches = standing(draft, Axis).into_iter().filter(|s| unsure(draft, s.0) && s.2.y < lo.y);
        sides.extend(branches);
        let length = |s: &(usize, DVec2, DVec2)| draft.ink.strokes[s.0].length;
        let longest = sides.iter().map(length).fold(0.0, f64::max);
        if sides.len() != 2 || sides.iter().map(length).any(|l| l < ALIKE * longest) {
            return found;
        }
    }
    let carry = sides.len() >= 2
        && sides.iter().all(|(_, top, foot)| {
            outside(outline, *top) < REACH && foot.y < lo.y && top.y < lo.y + INTO * (hi.y - lo.y)
        });
    let over = sides.iter().all(|s| s.1.x > lo.x && s.1.x < hi.x);
    let wide = sides.iter().map(|s| s.1.x).fold(f64::NEG_INFINITY, f64::max)
        - sides.iter().map(|s| s.1.x).fold(f64::INFINITY, f64::min);
    let lone = others < LONE * area && *area > CROWN_AREA;
    // A leaf on a stalk that was drawn as two lines is no tree: trunks are thicker.
    let trunk = outlined > 0 || wide > TRUNK_WIDE * (hi.x - lo.x);
    if carry && lone && over && trunk && wide < NARROW * (hi.x - lo.x) {
        parts.iter().for_each(|&k| found.set(k, Crown));
        sides[outlined..].iter().for_each(|s| found.set(s.0, TrunkOutline));
    }
    found
}

/// Returns outlines that may be a crown: area, strokes, polygon. Each is closed, or made of lines that do not stand
/// and whose ends meet.
fn closed_outlines(draft: &Draft<'_>) -> Vec<(f64, Vec<usize>, Vec<DVec2>)> {
    use StrokeClass::{Blade, Disc, Fruit, Other, TrunkOutline};
    let strokes = &draft.ink.strokes;
    let (shut, open): (Vec<usize>, Vec<usize>) = (0..draft.class.len())
        .filter(|&k| [Blade, Disc, Fruit, Other, TrunkOutline].contains(&draft.class[k]))
        .partition(|&k| openness(&strokes[k]) < CLOSED);
    let mut found: Vec<(f64, Vec<usize>, Vec<DVec2>)> = shut
        .into_iter()
        .filter_map(|k| strokes[k].outline().map(|o| (signed_area(o), vec![k], o.to_vec())))
        .collect();
    let open: Vec<usize> = open.into_iter().filter(|&k| !upright(draft, k) && unsure(draft, k)).collect();
    let lines: Vec<&[DVec2]> = open.iter().map(|&k| strokes[k].points.as_slice()).collect();
    for ring in rings(&lines) {
        let Some((lo, hi)) = bounds(&ring.points).filter(|_| ring.parts.len() > 1) else { continue };
        let meets = |&g: &usize| {
            let (a, b) = ring.gap(g);
            a.distance(b) < MEETS * lo.distance(hi)
        };
        if let Some(outline) = simple_outline(&ring.points).filter(|_| ring.gaps.iter().all(meets)) {
            found.push((signed_area(&outline), ring.parts.iter().map(|&p| open[p]).collect(), outline));
        }
    }
    found
}

/// Finds small outlines inside a crown: a ring is a fruit, and one longer than wide is a leaf.
pub(super) fn fruit_in_crown(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Blade, Crown, Disc, Fruit};
    let mut found = Findings::default();
    let outline = |k: usize| crown_outline(&draft.ink.strokes[k].points);
    let crowns: Vec<Vec<DVec2>> = draft.strokes_of_class(Crown).into_iter().filter_map(outline).collect();
    for k in 0..draft.class.len() {
        if !unsure(draft, k) || ![Axis, Blade, Disc].contains(&draft.class[k]) {
            continue;
        }
        let s = &draft.ink.strokes[k];
        let around = crowns.iter().find(|c| share_inside(&s.points, FRUIT_STRIDE, c) >= IN_CROWN);
        let (Some(crown), hull) = (around, s.hull()) else { continue };
        let Some((lo, hi)) = bounds(&s.points).filter(|_| hull.len() > 2) else { continue };
        let round = (hi.x - lo.x).min(hi.y - lo.y) > ROUND * (hi.x - lo.x).max(hi.y - lo.y);
        let full = signed_area(hull) > FILLS * (hi.x - lo.x) * (hi.y - lo.y);
        if openness(s) > CLOSED || signed_area(hull) > SMALL * signed_area(crown) {
            continue;
        }
        if round && full {
            found.set(k, Fruit);
        } else if signed_area(hull) > OPEN * s.length * s.length {
            found.set(k, Blade);
        }
    }
    found
}

/// Finds lines that were taken for fruits but enclose nothing: along the foot of a crown they are the ground,
/// elsewhere stalks.
pub(super) fn line_is_no_fruit(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Crown, Fruit, Ground};
    let mut found = Findings::default();
    let crowns: Vec<(DVec2, DVec2)> = draft
        .strokes_of_class(Crown)
        .into_iter()
        .filter_map(|k| bounds(&draft.ink.strokes[k].points))
        .collect();
    for k in draft.strokes_of_class(Fruit) {
        let s = &draft.ink.strokes[k];
        let Some((lo, hi)) = bounds(&s.points).filter(|_| unsure(draft, k) && openness(s) > LINE) else {
            continue;
        };
        let flat = hi.y - lo.y < FLAT * (hi.x - lo.x);
        let foot = crowns
            .iter()
            .any(|(l, h)| lo.midpoint(hi).y < l.y + CROWN_FOOT * (h.y - l.y) && hi.x > l.x && lo.x < h.x);
        if flat && foot {
            found.set(k, Ground);
        } else if openness(s) > STRAIGHT_LINE {
            found.set(k, Axis);
        }
    }
    found
}
