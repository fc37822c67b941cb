//! Second thoughts: classes that make no sense beside the other strokes, where the user did not set them.
//!
//! A stroke on its own cannot tell a leaf from a cactus or grass from a row of trunks; what lies inside it and
//! what is missing around it can.

use geom::{contains, convex_hull, crossing_points, pca2, signed_area, simple_outline};
use glam::DVec2;
use ink::{InkStroke, StrokeClass, StrokeMode};

use crate::blade::{first_round, split_stalks};
use crate::corolla::{dips, winding};
use crate::draft::Draft;
use crate::near::bounds;
use crate::outlines::neck;
use crate::rings::rings;
use crate::standing;

/// A tangle is known by its first so many crossings.
const MOST_CROSSINGS: usize = 500;

/// Corrects what the whole drawing contradicts.
pub(crate) fn thoughts(draft: &mut Draft<'_>) {
    lone_leaf(draft);
    leaf_with_its_midrib(draft);
    halves_of_a_leaf(draft);
    tree_in_one_stroke(draft);
    palm_in_one_stroke(draft);
    standing::thoughts(draft);
    tangles(draft);
    zigzags(draft);
    tufts(draft);
    grass(draft);
}

fn any(draft: &Draft<'_>, classes: &[StrokeClass]) -> bool {
    draft.class.iter().any(|c| classes.contains(c))
}

/// How far apart a stroke's ends are, as a share of its length.
pub(crate) fn openness(s: &InkStroke) -> f64 {
    s.points[0].distance(s.points[s.points.len() - 1]) / s.length.max(1e-12)
}

/// The share of every `stride`th point that lies in a closed outline, 0 to 1; 0 of no points.
pub(crate) fn share_inside(points: &[DVec2], stride: usize, outline: &[DVec2]) -> f64 {
    let (mut looked, mut hits) = (0_u32, 0_u32);
    for &p in points.iter().step_by(stride) {
        looked += 1;
        hits += u32::from(contains(outline, p));
    }
    f64::from(hits) / f64::from(looked.max(1))
}

/// May be thought over: not set by the user.
pub(crate) fn unsure(draft: &Draft<'_>, k: usize) -> bool {
    draft.confidence[k] < 1.0 && draft.ink.strokes[k].mode == StrokeMode::Parts
}

/// The largest outline of a drawing without crown, petals or pot, with a line along its middle, is a leaf with
/// its midrib rather than a body.
fn lone_leaf(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Fruit, Other, TrunkOutline, Vein};
    if any(draft, &[Crown, Blade, Disc]) || draft.of_class(Corolla).len() > 1 {
        return;
    }
    let area =
        |k: usize| bounds(&draft.ink.strokes[k].points).map_or(0.0, |(lo, hi)| (hi.x - lo.x) * (hi.y - lo.y));
    let largest = (0..draft.class.len()).max_by(|&a, &b| area(a).total_cmp(&area(b)).then(b.cmp(&a)));
    let Some(k) = largest.filter(|&k| {
        unsure(draft, k)
            && [TrunkOutline, Fruit, Other, Corolla].contains(&draft.class[k])
            && openness(&draft.ink.strokes[k]) < 0.35
    }) else {
        return;
    };
    let (points, _) = split_stalks(&draft.ink.strokes[k].points, 0.35);
    let (Some(outline), Some(pca)) = (simple_outline(&points), pca2(&points)) else { return };
    // Arms of a cactus leave hollows in its hull; those of a lobed leaf have a midrib from end to end.
    let lobed = draft.class[k] == Corolla;
    if lobed && any(draft, &[TrunkOutline, StrokeClass::Pot, StrokeClass::Ground]) {
        return;
    }
    if !lobed && signed_area(&outline) < 0.75 * signed_area(&convex_hull(&points)) {
        return;
    }
    let size = pca.extent[0].max(pca.extent[1]);
    let inside = |s: &InkStroke| {
        let stride = s.points.len().div_ceil(40);
        share_inside(&s.points, stride, &outline)
    };
    let lines: Vec<usize> = (0..draft.class.len())
        .take(400)
        .filter(|&j| j != k && [Axis, Vein, TrunkOutline].contains(&draft.class[j]) && unsure(draft, j))
        .collect();
    let along = |s: &InkStroke| {
        let run: DVec2 = s.points[s.points.len() - 1] - s.points[0];
        if lobed {
            return run.length() > 0.6 * size.min(pca.extent[1].max(pca.extent[0]))
                && run.length() > 0.8 * s.length;
        }
        run.dot(pca.major).abs() > 0.35 * size
            && run.length() > 0.8 * s.length
            && run.dot(pca.major).abs() > 0.85 * run.length()
    };
    if lines.iter().any(|&j| along(&draft.ink.strokes[j]) && inside(&draft.ink.strokes[j]) > 0.6) {
        draft.class[k] = Blade;
        for j in lines {
            if inside(&draft.ink.strokes[j]) > 0.6 {
                draft.class[j] = Vein;
            }
        }
    }
}

/// One or two lines that close round drawn veins are a leaf, not the sides of a trunk.
fn halves_of_a_leaf(draft: &mut Draft<'_>) {
    use StrokeClass::{Blade, Corolla, Crown, Disc, Pot, TrunkOutline, Vein};
    if any(draft, &[Crown, Corolla, Blade, Disc, Pot]) || !any(draft, &[Vein]) || draft.class.len() > 60 {
        return;
    }
    let sides: Vec<usize> = draft.of_class(TrunkOutline).into_iter().filter(|&k| unsure(draft, k)).collect();
    let veins = draft.of_class(Vein);
    // The other half may have been taken for a vein: its ends are those of the first.
    let mut parts = sides.clone();
    if let [side] = sides[..] {
        let s = &draft.ink.strokes[side].points;
        let (a, b) = (s[0], s[s.len() - 1]);
        let near = 0.15 * a.distance(b);
        let from_side = |v: usize| {
            let p = &draft.ink.strokes[v].points;
            p[p.len() / 2].distance(s[s.len() / 2])
        };
        let twins = veins.iter().copied().filter(|&v| {
            let p = &draft.ink.strokes[v].points;
            let (c, d) = (p[0], p[p.len() - 1]);
            openness(&draft.ink.strokes[side]) > 0.35
                && ((a.distance(c) < near && b.distance(d) < near)
                    || (a.distance(d) < near && b.distance(c) < near))
        });
        parts.extend(twins.max_by(|&v, &w| from_side(v).total_cmp(&from_side(w))));
    }
    let points: Vec<&[DVec2]> = parts.iter().map(|&k| draft.ink.strokes[k].points.as_slice()).collect();
    for ring in rings(&points) {
        let hull = convex_hull(&ring.points);
        let (Some(outline), Some((lo, hi))) = (simple_outline(&ring.points), bounds(&ring.points)) else {
            continue;
        };
        let size = lo.distance(hi);
        let shut = ring.gaps.iter().all(|&g| {
            let (a, b) = ring.gap(g);
            // The open foot of a cactus is a side of its hull; a midrib drawn in one go with the margin is not.
            a.distance(b) < 0.2 * size || crate::blade::nearest_on_ring(&hull, a.midpoint(b)).1 > 0.1 * size
        });
        let full = signed_area(&outline) > 0.7 * signed_area(&hull) && size > 0.5;
        let inner = veins.iter().any(|&v| {
            let p = &draft.ink.strokes[v].points;
            !ring.parts.iter().any(|&r| parts[r] == v) && contains(&outline, p[p.len() / 2])
        });
        if shut && full && inner {
            ring.parts.iter().for_each(|&r| draft.class[parts[r]] = Blade);
        }
    }
}

/// Margin and midrib in one go, the pen comes back to where it began and goes on, and side veins across: a leaf, not
/// a body with thorns.
fn leaf_with_its_midrib(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Pot, TrunkOutline, Vein};
    if any(draft, &[Crown, Corolla, Blade, Disc, Pot]) || draft.class.len() > 60 {
        return;
    }
    let lines: Vec<usize> = (0..draft.class.len())
        .filter(|&k| [Axis, Vein].contains(&draft.class[k]) && unsure(draft, k))
        .collect();
    for k in draft.of_class(TrunkOutline) {
        let all = &draft.ink.strokes[k].points;
        let margin = first_round(all);
        let (Some(outline), Some((lo, hi))) = (simple_outline(margin), bounds(margin)) else { continue };
        let full = signed_area(&outline) > 0.7 * signed_area(&convex_hull(margin));
        let inside = |&v: &usize| {
            let p = &draft.ink.strokes[v].points;
            contains(&outline, p[p.len() / 2])
        };
        let veins: Vec<usize> = lines.iter().copied().filter(inside).collect();
        let whole = margin.len() < all.len() && full && lo.distance(hi) > 0.5;
        if unsure(draft, k) && whole && veins.len() >= 2 {
            draft.class[k] = Blade;
            veins.into_iter().for_each(|v| draft.class[v] = Vein);
            return;
        }
    }
}

/// An outline with many deep hollows round its upper part is a palm in one stroke; a cactus has two arms.
fn palm_in_one_stroke(draft: &mut Draft<'_>) {
    use StrokeClass::{Corolla, TrunkOutline};
    if draft.class.len() > 3 {
        return;
    }
    for k in draft.of_class(TrunkOutline) {
        let points = &draft.ink.strokes[k].points;
        let (hull, Some((lo, hi))) = (convex_hull(points), bounds(points)) else { continue };
        let upper: Vec<DVec2> = points.iter().copied().filter(|p| p.y > lo.y + 0.4 * (hi.y - lo.y)).collect();
        if !unsure(draft, k) || hull.len() < 3 || upper.is_empty() {
            continue;
        }
        let middle = geom::centroid(&upper);
        let away: Vec<f64> = points.iter().map(|p| p.distance(middle)).collect();
        let reach = away.iter().copied().fold(0.0, f64::max);
        let hollow = simple_outline(points).is_none_or(|o| signed_area(&o) < 0.6 * signed_area(&hull));
        if hollow && dips(&away, 0.13 * reach).len() >= 7 {
            draft.class[k] = Corolla;
        }
    }
}

/// An outline with a narrow foot and a full head is a tree in one stroke; a cactus has hollows between its arms.
fn tree_in_one_stroke(draft: &mut Draft<'_>) {
    use StrokeClass::{Blade, Corolla, Crown, TrunkOutline};
    if any(draft, &[Crown, Corolla, Blade]) || draft.class.len() > 40 {
        return;
    }
    let length = |k: usize| draft.ink.strokes[k].length;
    let bodies: Vec<usize> = (0..draft.class.len()).filter(|&k| draft.class[k] == TrunkOutline).collect();
    let total: f64 = bodies.iter().map(|&k| length(k)).sum();
    // One of several pieces of a body is no tree.
    let main: Vec<usize> = bodies.into_iter().filter(|&k| length(k) > 0.7 * total).collect();
    for k in main {
        let points = &draft.ink.strokes[k].points;
        let Some(outline) = unsure(draft, k).then(|| simple_outline(points)).flatten() else { continue };
        let head = neck(&outline).map(|n| n.1);
        if head.is_some_and(|h| signed_area(&h) > 0.78 * signed_area(&convex_hull(&h)))
            || closes_above_its_trunk(points, &outline)
        {
            draft.class[k] = Crown;
        }
    }
}

/// The pen met its own line where crown and trunk meet: the outline is the crown, and the rest hangs below it.
fn closes_above_its_trunk(points: &[DVec2], outline: &[DVec2]) -> bool {
    let (Some((lo, hi)), Some(all)) = (bounds(outline), bounds(points)) else { return false };
    let below: Vec<DVec2> = points.iter().copied().filter(|p| p.y < lo.y - 0.01).collect();
    let hangs = bounds(&below).is_some_and(|(l, h)| {
        h.x - l.x < 0.4 * (hi.x - lo.x) && lo.y - l.y > 0.2 * (all.1.y - all.0.y) && h.x - l.x > 0.02
    });
    hangs && signed_area(outline) > 0.6 * signed_area(&convex_hull(outline))
}

/// A stroke that goes up and down and on to the side is a row of grass blades, where no trunk needs a crown.
fn zigzags(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Crown, Other, Scribble, TrunkOutline};
    if draft.class.len() > 40 {
        return;
    }
    let zigzag = |k: usize| {
        let s = &draft.ink.strokes[k];
        let Some((lo, hi)) = bounds(&s.points) else { return false };
        let heights: Vec<f64> = s.points.iter().map(|p| p.y - lo.y).collect();
        let on = (s.points[s.points.len() - 1].x - s.points[0].x).abs() > 0.6 * (hi.x - lo.x);
        let cuts = dips(&heights, 0.3 * (hi.y - lo.y)).len();
        on && cuts >= 5 && winding(&s.points, lo.midpoint(hi)) < 4.5
    };
    let rows: Vec<usize> = (0..draft.class.len())
        .filter(|&k| {
            unsure(draft, k) && [Axis, Crown, Other, Scribble, TrunkOutline].contains(&draft.class[k])
        })
        .filter(|&k| zigzag(k))
        .collect();
    // A line that lies beside the row goes on with it; an outline that stands is a plant of another kind.
    let (lying, standing): (Vec<usize>, Vec<usize>) =
        draft.of_class(TrunkOutline).into_iter().filter(|k| !rows.contains(k)).partition(|&k| {
            let s = &draft.ink.strokes[k];
            let wide = bounds(&s.points).is_some_and(|(lo, hi)| hi.y - lo.y < 0.5 * (hi.x - lo.x));
            wide && openness(s) > 0.5 && unsure(draft, k)
        });
    if standing.is_empty() && !rows.is_empty() {
        rows.into_iter().for_each(|k| draft.class[k] = StrokeClass::Corolla);
        lying.into_iter().for_each(|k| draft.class[k] = StrokeClass::Ground);
    }
}

/// Blades of grass drawn in one go, down to the root and up again: a crown or fruit has no sharp point below from which
/// two bare lines rise.
fn tufts(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Fruit, Other, Pot, TrunkOutline};
    if draft.trunk || any(draft, &[Blade, Corolla, Disc, Pot]) || draft.class.len() > 60 {
        return;
    }
    for k in 0..draft.class.len() {
        if !unsure(draft, k) || ![Crown, Fruit, Other, TrunkOutline].contains(&draft.class[k]) {
            continue;
        }
        if let Some(legs) = two_legs(&draft.ink.strokes[k].points) {
            draft.class[k] = Axis;
            draft.legs.insert(k, legs.into());
        }
    }
}

/// Both sides of a line with one sharp turn at its lowest point, each almost straight, apart above.
fn two_legs(points: &[DVec2]) -> Option<[Vec<DVec2>; 2]> {
    let (lo, hi) = bounds(points)?;
    let low = (0..points.len()).min_by(|&a, &b| points[a].y.total_cmp(&points[b].y))?;
    let (left, right) = (&points[..=low], &points[low..]);
    let bare = |leg: &[DVec2]| {
        let run = leg[0].distance(leg[leg.len() - 1]);
        run > 0.85 * geom::polyline_length(leg) && run > 0.25 * lo.distance(hi)
    };
    let (a, b) = (points[0] - points[low], points[points.len() - 1] - points[low]);
    // Sharp at the turn itself, too: a trough is no root.
    let far = |p: &&DVec2| p.distance(points[low]) > 0.06 * lo.distance(hi);
    let turn = left.iter().rev().find(far).zip(right.iter().find(far));
    let turn = turn.map(|(u, v)| (*u - points[low], *v - points[low]));
    let sharp = turn.is_some_and(|(u, v)| u.dot(v) > -0.4 * u.length() * v.length());
    let apart = (a - b).length() > 0.15 * a.length().min(b.length());
    (bare(left) && bare(right) && sharp && apart).then(|| [left.to_vec(), right.to_vec()])
}

/// A line that crosses itself again and again all over the place is a scribble, not petals: those cross in the middle.
fn tangles(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Disc, Pot};
    if any(draft, &[Axis, Disc, Pot]) {
        return;
    }
    for k in draft.of_class(StrokeClass::Corolla) {
        let points = &draft.ink.strokes[k].points;
        let Some((lo, hi)) = bounds(points).filter(|_| unsure(draft, k)) else { continue };
        let middle = lo.midpoint(hi);
        let crossings = crossing_points(points, MOST_CROSSINGS);
        let wide = crossings.iter().filter(|p| p.distance(middle) > 0.12 * lo.distance(hi)).count();
        if crossings.len() > 8 && 2 * wide > crossings.len() {
            draft.class[k] = StrokeClass::Scribble;
        }
    }
}

/// Several single lines and nothing that a trunk could carry: stalks of grass, not sides of trunks.
fn grass(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Fruit, Scribble, TrunkOutline};
    if draft.trunk || any(draft, &[Crown, Corolla, Blade, Disc, Scribble]) {
        return;
    }
    let line = |k: usize| {
        [Axis, TrunkOutline, Fruit].contains(&draft.class[k]) && openness(&draft.ink.strokes[k]) > 0.7
    };
    let lines: Vec<usize> = (0..draft.class.len()).filter(|&k| line(k)).collect();
    let outlines = (0..draft.class.len())
        .any(|k| draft.class[k] == TrunkOutline && openness(&draft.ink.strokes[k]) <= 0.7);
    if lines.len() >= 4 && !outlines {
        for k in lines {
            if unsure(draft, k) {
                draft.class[k] = Axis;
            }
        }
    }
}
