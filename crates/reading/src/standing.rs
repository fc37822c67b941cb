//! Second thoughts about what stands on what: crowns on trunks, plants in pots, leaves on stems.
//!
//! A closed line above two upright ones is a crown however smooth it was drawn; two upright lines below a crown
//! are its trunk however thin.

use geom::{contains, convex_hull, polyline_length, self_crossings, signed_area, simple_outline};
use glam::DVec2;
use ink::StrokeClass;

use crate::blade::{nearest_on_ring, split_stalks};
use crate::draft::Draft;
use crate::near::bounds;
use crate::outlines::width_at;
use crate::rings::rings;
use crate::second::{openness, share_inside, unsure};

/// More strokes than this are not thought over: nobody draws one plant with so many, and rules compare pairs.
const MOST_STROKES: usize = 400;
/// A trunk's top is at most this far from its crown.
const REACH: f64 = 0.07;

/// Applies all rules, those that others build on first.
pub(crate) fn thoughts(draft: &mut Draft<'_>) {
    if draft.class.len() > MOST_STROKES {
        return;
    }
    stems(draft);
    draft.trunk = trunk_lines(draft);
    crown_with_a_side(draft);
    crown_on_trunk(draft);
    scribbled_crown(draft);
    outline_goes_on(draft);
    in_crowns(draft);
    pots(draft);
    loops_in_pots(draft);
}

/// Highest point first, lowest point last.
fn ends(points: &[DVec2]) -> (DVec2, DVec2) {
    let (a, b) = (points[0], points[points.len() - 1]);
    if a.y > b.y { (a, b) } else { (b, a) }
}

/// Distance to an outline, 0 inside.
fn outside(outline: &[DVec2], p: DVec2) -> f64 {
    if contains(outline, p) { 0.0 } else { nearest_on_ring(outline, p).1 }
}

/// A line that stands: rather straight, and higher than wide.
fn upright(draft: &Draft<'_>, k: usize) -> bool {
    let s = &draft.ink.strokes[k];
    let (top, foot) = ends(&s.points);
    openness(s) > 0.7 && top.y - foot.y > 0.8 * (top.x - foot.x).abs()
}

/// Upper and lower ends of the upright lines of a class.
fn standing(draft: &Draft<'_>, class: StrokeClass) -> Vec<(usize, DVec2, DVec2)> {
    draft
        .of_class(class)
        .into_iter()
        .filter(|&k| upright(draft, k))
        .map(|k| {
            let (top, foot) = ends(&draft.ink.strokes[k].points);
            (k, top, foot)
        })
        .collect()
}

/// Sides of a trunk come closer upwards or run side by side. Lines that spread from one place, each to a leaf of
/// its own, are stems.
fn stems(draft: &mut Draft<'_>) {
    let blades: Vec<Vec<DVec2>> = draft
        .of_class(StrokeClass::Blade)
        .into_iter()
        .filter_map(|k| simple_outline(&draft.ink.strokes[k].points))
        .collect();
    let sides = standing(draft, StrokeClass::TrunkOutline);
    if blades.len() < 2 || sides.len() < 2 {
        return;
    }
    let leads: Vec<(usize, usize, DVec2, DVec2)> = sides
        .iter()
        .filter_map(|&(k, top, foot)| {
            let reached = (0..blades.len()).map(|b| (outside(&blades[b], top), b));
            let (near, b) = reached.min_by(|a, b| a.0.total_cmp(&b.0))?;
            (near < 0.025).then_some((k, b, top, foot))
        })
        .collect();
    let spread = |a: &(usize, usize, DVec2, DVec2), b: &(usize, usize, DVec2, DVec2)| {
        a.1 != b.1 && a.2.distance(b.2) > 2.0 * a.3.distance(b.3)
    };
    let found: Vec<usize> =
        leads.iter().filter(|a| leads.iter().any(|b| a.0 != b.0 && spread(a, b))).map(|l| l.0).collect();
    for k in found {
        if unsure(draft, k) {
            draft.class[k] = StrokeClass::Axis;
        }
    }
}

/// Two single lines side by side that carry a crown, or a fan of fronds, are the sides of a trunk.
fn trunk_lines(draft: &mut Draft<'_>) -> bool {
    // A trunk that was drawn as a closed outline needs no sides.
    if draft.of_class(StrokeClass::TrunkOutline).iter().any(|&k| openness(&draft.ink.strokes[k]) < 0.5) {
        return false;
    }
    let mut lines = standing(draft, StrokeClass::TrunkOutline);
    if lines.len() < 2 {
        lines.extend(standing(draft, StrokeClass::Axis));
    }
    let crowns: Vec<Vec<DVec2>> = [StrokeClass::Crown, StrokeClass::Scribble]
        .into_iter()
        .flat_map(|c| draft.of_class(c))
        .map(|k| convex_hull(&draft.ink.strokes[k].points))
        .filter(|h| h.len() > 2)
        .collect();
    let all_ends: Vec<(usize, DVec2)> = (0..draft.class.len())
        .flat_map(|k| {
            let p = &draft.ink.strokes[k].points;
            [(k, p[0]), (k, p[p.len() - 1])]
        })
        .collect();
    let low = all_ends.iter().map(|e| e.1.y).fold(f64::INFINITY, f64::min);
    let mut found = None;
    for (i, &(a, a_top, a_foot)) in lines.iter().enumerate() {
        for &(b, b_top, b_foot) in &lines[i + 1..] {
            let (long, short) = (draft.ink.strokes[a].length, draft.ink.strokes[b].length);
            let gaps = (a_top.distance(b_top), a_foot.distance(b_foot));
            let alike = short.min(long) > 0.55 * short.max(long);
            let beside = gaps.0.max(gaps.1) < 1.3 * short.min(long)
                && gaps.0 > 0.015
                && gaps.0 < 1.6 * gaps.1
                && (a_foot.x < b_foot.x) == (a_top.x < b_top.x);
            let deep = a_foot.y.max(b_foot.y) < low + 0.15;
            if !(alike && beside && deep && unsure(draft, a) && unsure(draft, b)) {
                continue;
            }
            let crowned = crowns.iter().any(|c| {
                bounds(c).is_some_and(|(lo, hi)| {
                    outside(c, a_top) < 2.0 * REACH
                        && outside(c, b_top) < 2.0 * REACH
                        && a_foot.y.max(b_foot.y) < lo.y
                        && gaps.0 < 0.7 * (hi.x - lo.x)
                })
            });
            // Fronds begin at the trunk's top and the trunk is longer than they are wide apart.
            let hub = a_top.midpoint(b_top);
            let fan = all_ends
                .iter()
                .filter(|(k, p)| *k != a && *k != b && p.distance(hub) < 0.5 * gaps.0 + 0.06)
                .count();
            let slim = gaps.0.max(gaps.1) < 0.3 * short.min(long);
            if crowned || (fan >= 4 && slim && crowns.is_empty()) {
                found = Some((a, b));
            }
        }
    }
    if let Some((a, b)) = found {
        draft.class[a] = StrokeClass::TrunkOutline;
        draft.class[b] = StrokeClass::TrunkOutline;
    }
    found.is_some()
}

/// A line that runs round a crown and then down one side of the trunk, beside a line for its other side.
fn crown_with_a_side(draft: &mut Draft<'_>) {
    use StrokeClass::{Blade, Corolla, Crown, Pot, TrunkOutline, Vein};
    if draft.class.iter().any(|c| [Blade, Corolla, Crown, Pot, Vein].contains(c)) {
        return;
    }
    let sides = standing(draft, TrunkOutline);
    let found = draft.of_class(TrunkOutline).into_iter().find(|&k| {
        let (round, ends) = split_stalks(&draft.ink.strokes[k].points, 0.75);
        let (Some(outline), [end]) = (simple_outline(&round), &ends[..]) else { return false };
        let Some((lo, hi)) = bounds(&outline) else { return false };
        let (free, at) = (end[0], end[end.len() - 1]);
        let down = at.y - free.y > 0.06 && free.distance(at) > 0.75 * polyline_length(end);
        let beside = sides.iter().any(|(j, top, foot)| {
            *j != k
                && outside(&outline, *top) < REACH
                && foot.y < lo.y
                && top.distance(at) < 0.7 * (hi.x - lo.x)
                && top.distance(at) > 0.02
        });
        unsure(draft, k)
            && down
            && beside
            && free.y < lo.y + 0.02
            && signed_area(&outline) > 0.8 * signed_area(&convex_hull(&round))
    });
    if let Some(k) = found {
        draft.class[k] = Crown;
    }
}

/// A stem that ends in a loop, in a pot, is a leaf on its stalk.
fn loops_in_pots(draft: &mut Draft<'_>) {
    use StrokeClass::{Blade, Corolla, Pot, TrunkOutline};
    if !draft.class.contains(&Pot) || draft.class.iter().any(|c| [Blade, Corolla].contains(c)) {
        return;
    }
    for k in draft.of_class(TrunkOutline) {
        let s = &draft.ink.strokes[k];
        let (_, stalks) = split_stalks(&s.points, 0.35);
        let long = |l: &Vec<DVec2>| polyline_length(l) > 0.2 * s.length;
        if unsure(draft, k) && stalks.len() == 1 && stalks.iter().all(long) {
            draft.class[k] = Blade;
        }
    }
}

/// The largest closed outline of the drawing is a crown where the tops of a drawn trunk reach it from below.
fn crown_on_trunk(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Crown, Pot, TrunkOutline, Vein};
    if draft.class.iter().any(|c| [Crown, Pot, Vein].contains(c)) {
        return;
    }
    let closed = closed_outlines(draft);
    let largest = closed.iter().max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let Some((area, parts, outline)) = largest.filter(|c| c.1.iter().all(|&k| unsure(draft, k))) else {
        return;
    };
    let others = closed.iter().filter(|c| c.1 != *parts).map(|c| c.0).fold(0.0, f64::max);
    let Some((lo, hi)) = bounds(outline) else { return };
    let mut sides: Vec<(usize, DVec2, DVec2)> =
        standing(draft, TrunkOutline).into_iter().filter(|s| !parts.contains(&s.0)).collect();
    // Sides may have been taken for branches: they begin below the crown, reach it, and are about as long as one another.
    let outlined = sides.len();
    if outlined < 2 {
        let branches = standing(draft, Axis).into_iter().filter(|s| unsure(draft, s.0) && s.2.y < lo.y);
        sides.extend(branches);
        let length = |s: &(usize, DVec2, DVec2)| draft.ink.strokes[s.0].length;
        let longest = sides.iter().map(length).fold(0.0, f64::max);
        if sides.len() != 2 || sides.iter().map(length).any(|l| l < 0.55 * longest) {
            return;
        }
    }
    let carry = sides.len() >= 2
        && sides.iter().all(|(_, top, foot)| {
            outside(outline, *top) < REACH && foot.y < lo.y && top.y < lo.y + 0.6 * (hi.y - lo.y)
        });
    let over = sides.iter().all(|s| s.1.x > lo.x && s.1.x < hi.x);
    let wide = sides.iter().map(|s| s.1.x).fold(f64::NEG_INFINITY, f64::max)
        - sides.iter().map(|s| s.1.x).fold(f64::INFINITY, f64::min);
    let lone = others < 0.25 * area && *area > 0.02;
    // A leaf on a stalk that was drawn as two lines is no tree: trunks are thicker.
    let trunk = outlined > 0 || wide > 0.1 * (hi.x - lo.x);
    if carry && lone && over && trunk && wide < 0.7 * (hi.x - lo.x) {
        parts.iter().for_each(|&k| draft.class[k] = Crown);
        sides[outlined..].iter().for_each(|s| draft.class[s.0] = TrunkOutline);
    }
}

/// Outlines that may be a crown: area, strokes, polygon. Each closed by itself, or made of lines that do not stand and
/// whose ends meet.
fn closed_outlines(draft: &Draft<'_>) -> Vec<(f64, Vec<usize>, Vec<DVec2>)> {
    use StrokeClass::{Blade, Disc, Fruit, Other, TrunkOutline};
    let strokes = &draft.ink.strokes;
    let (shut, open): (Vec<usize>, Vec<usize>) = (0..draft.class.len())
        .filter(|&k| [Blade, Disc, Fruit, Other, TrunkOutline].contains(&draft.class[k]))
        .partition(|&k| openness(&strokes[k]) < 0.2);
    let mut found: Vec<(f64, Vec<usize>, Vec<DVec2>)> = shut
        .into_iter()
        .filter_map(|k| simple_outline(&strokes[k].points).map(|o| (signed_area(&o), vec![k], o)))
        .collect();
    let open: Vec<usize> = open.into_iter().filter(|&k| !upright(draft, k) && unsure(draft, k)).collect();
    let lines: Vec<&[DVec2]> = open.iter().map(|&k| strokes[k].points.as_slice()).collect();
    for ring in rings(&lines) {
        let Some((lo, hi)) = bounds(&ring.points).filter(|_| ring.parts.len() > 1) else { continue };
        let meets = |&g: &usize| {
            let (a, b) = ring.gap(g);
            a.distance(b) < 0.25 * lo.distance(hi)
        };
        if let Some(outline) = simple_outline(&ring.points).filter(|_| ring.gaps.iter().all(meets)) {
            found.push((signed_area(&outline), ring.parts.iter().map(|&p| open[p]).collect(), outline));
        }
    }
    found
}

/// A short line that begins where the only outline of a body ends goes on with it.
fn outline_goes_on(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Crown, TrunkOutline};
    let ink = draft.ink;
    let [body] = draft.of_class(TrunkOutline)[..] else { return };
    let body = &ink.strokes[body];
    if draft.class.contains(&Crown) || openness(body) < 0.2 || draft.class.len() > 60 {
        return;
    }
    let ends = [body.points[0], body.points[body.points.len() - 1]];
    let found = draft.of_class(Axis).into_iter().find(|&k| {
        let s = &ink.strokes[k].points;
        let (a, b) = (s[0], s[s.len() - 1]);
        let begins = |p: DVec2| ends.iter().any(|e| e.distance(p) < 0.02);
        let leaves = |p: DVec2| body.points.iter().all(|q| q.distance(p) > 0.05);
        unsure(draft, k) && ((begins(a) && leaves(b)) || (begins(b) && leaves(a)))
    });
    if let Some(k) = found {
        draft.class[k] = TrunkOutline;
    }
}

/// A large scribble at the top of a trunk is its crown.
fn scribbled_crown(draft: &mut Draft<'_>) {
    use StrokeClass::{Blade, Corolla, Crown, Scribble, TrunkOutline};
    let sides = standing(draft, TrunkOutline);
    let crown = draft
        .of_class(Crown)
        .iter()
        .map(|&k| signed_area(&convex_hull(&draft.ink.strokes[k].points)))
        .sum::<f64>();
    for k in draft.of_class(Scribble) {
        let hull = convex_hull(&draft.ink.strokes[k].points);
        if signed_area(&hull) < 2.0 * crown {
            continue;
        }
        let Some((lo, hi)) = bounds(&hull).filter(|_| hull.len() > 2 && unsure(draft, k)) else { continue };
        // A leaf or petals elsewhere: no tree. Over the scribble they are pieces of it.
        let elsewhere = [Blade, Corolla].into_iter().flat_map(|c| draft.of_class(c)).any(|j| {
            bounds(&draft.ink.strokes[j].points).is_some_and(|(l, h)| outside(&hull, l.midpoint(h)) > REACH)
        });
        if elsewhere {
            continue;
        }
        let feet = sides.iter().filter(|s| s.2.y < lo.y && outside(&hull, s.1) < 2.0 * REACH);
        let reach =
            feet.clone().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, r), s| (l.min(s.1.x), r.max(s.1.x)));
        if feet.count() >= 1 && hi.x - lo.x > 1.2 * (reach.1 - reach.0) && signed_area(&hull) > 0.02 {
            draft.class[k] = Crown;
        }
    }
}

/// Inside a crown small rings are fruits, and lines that cross themselves again and again are shading.
fn in_crowns(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Fruit, Scribble};
    let crowns: Vec<Vec<DVec2>> = draft
        .of_class(Crown)
        .into_iter()
        .filter_map(|k| crate::outlines::crown_outline(&draft.ink.strokes[k].points))
        .collect();
    for k in 0..draft.class.len() {
        if !unsure(draft, k) || ![Axis, Blade, Corolla, Disc].contains(&draft.class[k]) {
            continue;
        }
        let s = &draft.ink.strokes[k];
        let Some(crown) = crowns.iter().find(|c| share_inside(&s.points, 4, c) >= 0.9) else { continue };
        let hull = convex_hull(&s.points);
        let Some((lo, hi)) = bounds(&s.points).filter(|_| hull.len() > 2) else { continue };
        let area = signed_area(&hull);
        let round = (hi.x - lo.x).min(hi.y - lo.y) > 0.6 * (hi.x - lo.x).max(hi.y - lo.y);
        if openness(s) < 0.2 && round && area < 0.03 * signed_area(crown) && draft.class[k] != Corolla {
            draft.class[k] = Fruit;
        } else if draft.class[k] == Corolla && self_crossings(&s.points) > 3 {
            draft.class[k] = Scribble;
        }
    }
}

/// A box at the bottom with a flat top on which the plant stands is its pot.
fn pots(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Corolla, Crown, Fruit, Ground, Pot, Scribble, TrunkOutline};
    if draft.class.iter().any(|c| [Pot, Crown].contains(c)) {
        return;
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
        if !unsure(draft, k) || lo.y > low + 0.01 || wide < 0.05 || !(0.25 * wide..2.0 * wide).contains(&tall)
        {
            continue;
        }
        let points = &draft.ink.strokes[k].points;
        // What stands in it: lines whose foot is at its upper edge and that rise out of it.
        let feet: Vec<(usize, f64)> = (0..draft.class.len())
            .filter(|&j| j != k && [Axis, TrunkOutline].contains(&draft.class[j]))
            .filter(|&j| {
                let (l, h) = boxes[j];
                l.y > hi.y - 0.4 * tall && l.y < hi.y + 0.06 && h.y > hi.y + 0.5 * tall
            })
            .filter_map(|j| {
                let foot: Vec<DVec2> = draft.ink.strokes[j]
                    .points
                    .iter()
                    .copied()
                    .filter(|p| p.y < boxes[j].0.y + 0.05 * (boxes[j].1.y - boxes[j].0.y))
                    .collect();
                bounds(&foot).filter(|(l, h)| l.x > lo.x && h.x < hi.x).map(|(l, h)| (j, h.x - l.x))
            })
            .collect();
        let nothing_beside = (0..boxes.len())
            .all(|j| j == k || boxes[j].0.y > lo.y + 0.5 * tall || contained(boxes[j], (lo, hi)));
        let is_pot = match draft.class[k] {
            TrunkOutline | Fruit => simple_outline(points).is_some_and(|o| {
                let at = |t: f64| width_at(&o, lo.y + t * tall);
                let flat = at(0.93) > 0.8 * wide && at(0.93) >= 0.95 * at(0.1);
                flat && signed_area(&o) > 0.6 * wide * tall && feet.iter().any(|f| f.1 < 0.9 * wide)
            }),
            Corolla | Scribble => feet.len() >= 3,
            _ => false,
        };
        if is_pot && nothing_beside && !feet.is_empty() && polyline_length(points) > 0.0 {
            draft.class[k] = Pot;
            return;
        }
    }
}

fn contained(inner: (DVec2, DVec2), outer: (DVec2, DVec2)) -> bool {
    inner.0.cmpge(outer.0 - DVec2::splat(0.01)).all() && inner.1.cmple(outer.1 + DVec2::splat(0.01)).all()
}
