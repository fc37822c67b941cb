//! Rules about leaves: margins, midribs, and leaves on their stalks.

use geom::{contains, convex_hull, pca2, polyline_length, signed_area, simple_outline};
use glam::DVec2;
use ink::{InkStroke, StrokeClass};

use super::{Findings, MOUTH, STALK, any, openness, outside, share_inside, standing, unsure};
use crate::blade::{first_round, nearest_on_ring, split_stalks};
use crate::draft::Draft;
use crate::near::bounds;
use crate::rings::rings;

/// A leaf fills this share of its hull; arms of a cactus leave hollows.
const FULL: f64 = 0.7;
/// As [`FULL`], of an outline that was drawn as a body, a fruit or something else.
const FULL_BODY: f64 = 0.75;
/// A leaf that is the drawing is at least this long, corner to corner.
const LARGE: f64 = 0.5;
/// A vein lies in its leaf with this share of its length.
const INSIDE: f64 = 0.6;
/// A stem ends this near to its leaf.
const TOUCH: f64 = 0.025;
/// Lines that are looked at as veins of one leaf.
const MOST_VEINS: usize = 400;

/// The largest outline of a drawing without crown, petals or pot, with a line along its middle, is a leaf with
/// its midrib rather than a body.
pub(super) fn lone_leaf(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Fruit, Other, TrunkOutline, Vein};
    let mut found = Findings::default();
    if any(draft, &[Crown, Blade, Disc]) || draft.of_class(Corolla).len() > 1 {
        return found;
    }
    let area =
        |k: usize| bounds(&draft.ink.strokes[k].points).map_or(0.0, |(lo, hi)| (hi.x - lo.x) * (hi.y - lo.y));
    let largest = (0..draft.class.len()).max_by(|&a, &b| area(a).total_cmp(&area(b)).then(b.cmp(&a)));
    let Some(k) = largest.filter(|&k| {
        unsure(draft, k)
            && [TrunkOutline, Fruit, Other, Corolla].contains(&draft.class[k])
            && openness(&draft.ink.strokes[k]) < MOUTH
    }) else {
        return found;
    };
    let (points, _) = split_stalks(&draft.ink.strokes[k].points, STALK);
    let (Some(outline), Some(pca)) = (simple_outline(&points), pca2(&points)) else { return found };
    // Arms of a cactus leave hollows in its hull; those of a lobed leaf have a midrib from end to end.
    let lobed = draft.class[k] == Corolla;
    if lobed && any(draft, &[TrunkOutline, StrokeClass::Pot, StrokeClass::Ground]) {
        return found;
    }
    if !lobed && signed_area(&outline) < FULL_BODY * signed_area(&convex_hull(&points)) {
        return found;
    }
    let size = pca.extent[0].max(pca.extent[1]);
    let inside = |s: &InkStroke| {
        let stride = s.points.len().div_ceil(40);
        share_inside(&s.points, stride, &outline)
    };
    let lines: Vec<usize> = (0..draft.class.len())
        .take(MOST_VEINS)
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
    if lines.iter().any(|&j| along(&draft.ink.strokes[j]) && inside(&draft.ink.strokes[j]) > INSIDE) {
        found.set(k, Blade);
        for j in lines {
            if inside(&draft.ink.strokes[j]) > INSIDE {
                found.set(j, Vein);
            }
        }
    }
    found
}

/// Margin and midrib in one go, the pen comes back to where it began and goes on, and side veins across: a leaf, not
/// a body with thorns.
pub(super) fn leaf_with_its_midrib(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Pot, TrunkOutline, Vein};
    let mut found = Findings::default();
    if any(draft, &[Crown, Corolla, Blade, Disc, Pot]) {
        return found;
    }
    let lines: Vec<usize> = (0..draft.class.len())
        .filter(|&k| [Axis, Vein].contains(&draft.class[k]) && unsure(draft, k))
        .collect();
    for k in draft.of_class(TrunkOutline) {
        let all = &draft.ink.strokes[k].points;
        let margin = first_round(all);
        let (Some(outline), Some((lo, hi))) = (simple_outline(margin), bounds(margin)) else { continue };
        let full = signed_area(&outline) > FULL * signed_area(&convex_hull(margin));
        let inside = |&v: &usize| {
            let p = &draft.ink.strokes[v].points;
            contains(&outline, p[p.len() / 2])
        };
        let veins: Vec<usize> = lines.iter().copied().filter(inside).collect();
        let whole = margin.len() < all.len() && full && lo.distance(hi) > LARGE;
        if unsure(draft, k) && whole && veins.len() >= 2 {
            found.set(k, Blade);
            veins.into_iter().for_each(|v| found.set(v, Vein));
            break;
        }
    }
    found
}

/// One or two lines that close round drawn veins are a leaf, not the sides of a trunk.
pub(super) fn halves_of_a_leaf(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Blade, Corolla, Crown, Disc, Pot, TrunkOutline, Vein};
    let mut found = Findings::default();
    if any(draft, &[Crown, Corolla, Blade, Disc, Pot]) || !any(draft, &[Vein]) {
        return found;
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
            openness(&draft.ink.strokes[side]) > MOUTH
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
            a.distance(b) < 0.2 * size || nearest_on_ring(&hull, a.midpoint(b)).1 > 0.1 * size
        });
        let full = signed_area(&outline) > FULL * signed_area(&hull) && size > LARGE;
        let inner = veins.iter().any(|&v| {
            let p = &draft.ink.strokes[v].points;
            !ring.parts.iter().any(|&r| parts[r] == v) && contains(&outline, p[p.len() / 2])
        });
        if shut && full && inner {
            ring.parts.iter().for_each(|&r| found.set(parts[r], Blade));
        }
    }
    found
}

/// A stem that ends in a loop, in a pot, is a leaf on its stalk.
pub(super) fn loops_in_pots(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Blade, Corolla, Pot, TrunkOutline};
    let mut found = Findings::default();
    if !draft.class.contains(&Pot) || draft.class.iter().any(|c| [Blade, Corolla].contains(c)) {
        return found;
    }
    for k in draft.of_class(TrunkOutline) {
        let s = &draft.ink.strokes[k];
        let (_, stalks) = split_stalks(&s.points, STALK);
        let long = |l: &Vec<DVec2>| polyline_length(l) > 0.2 * s.length;
        if unsure(draft, k) && stalks.len() == 1 && stalks.iter().all(long) {
            found.set(k, Blade);
        }
    }
    found
}

/// Sides of a trunk come closer upwards or run side by side. Lines that spread from one place, each to a leaf of
/// its own, are stems.
pub(super) fn stems(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    let blades: Vec<Vec<DVec2>> = draft
        .of_class(StrokeClass::Blade)
        .into_iter()
        .filter_map(|k| simple_outline(&draft.ink.strokes[k].points))
        .collect();
    let sides = standing(draft, StrokeClass::TrunkOutline);
    if blades.len() < 2 || sides.len() < 2 {
        return found;
    }
    let leads: Vec<(usize, usize, DVec2, DVec2)> = sides
        .iter()
        .filter_map(|&(k, top, foot)| {
            let reached = (0..blades.len()).map(|b| (outside(&blades[b], top), b));
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
