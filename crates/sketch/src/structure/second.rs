//! Second thoughts: classes that make no sense beside the other strokes, where the user did not set them.
//!
//! A stroke on its own cannot tell a leaf from a cactus or grass from a row of trunks; what lies inside it and
//! what is missing around it can.

use geom::{contains, convex_hull, pca2, signed_area, simple_outline};
use glam::DVec2;

use super::blade::split_stalks;
use super::corolla::{dips, winding};
use super::near::bounds;
use super::outlines::neck;
use super::{Draft, StrokeMode};
use crate::{InkStroke, StrokeClass};

/// Corrects what the whole drawing contradicts.
pub(super) fn thoughts(draft: &mut Draft<'_>) {
    lone_leaf(draft);
    tree_in_one_stroke(draft);
    zigzags(draft);
    grass(draft);
}

fn any(draft: &Draft<'_>, classes: &[StrokeClass]) -> bool {
    draft.class.iter().any(|c| classes.contains(c))
}

/// How far apart a stroke's ends are, as a share of its length.
fn openness(s: &InkStroke) -> f64 {
    s.points[0].distance(s.points[s.points.len() - 1]) / s.length.max(1e-12)
}

/// May be thought over: not set by the user.
fn unsure(draft: &Draft<'_>, k: usize) -> bool {
    draft.confidence[k] < 1.0 && draft.ink.strokes[k].mode == StrokeMode::Parts
}

/// The largest outline of a drawing without crown, petals or pot, with a line along its middle, is a leaf with
/// its midrib rather than a body.
fn lone_leaf(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Fruit, Other, TrunkOutline, Vein};
    if any(draft, &[Crown, Corolla, Blade, Disc]) {
        return;
    }
    let area =
        |k: usize| bounds(&draft.ink.strokes[k].points).map_or(0.0, |(lo, hi)| (hi.x - lo.x) * (hi.y - lo.y));
    let largest = (0..draft.class.len()).max_by(|&a, &b| area(a).total_cmp(&area(b)).then(b.cmp(&a)));
    let Some(k) = largest.filter(|&k| {
        unsure(draft, k)
            && [TrunkOutline, Fruit, Other].contains(&draft.class[k])
            && openness(&draft.ink.strokes[k]) < 0.35
    }) else {
        return;
    };
    let (points, _) = split_stalks(&draft.ink.strokes[k].points, 0.35);
    let (Some(outline), Some(pca)) = (simple_outline(&points), pca2(&points)) else { return };
    // Arms of a cactus leave hollows in its hull.
    if signed_area(&outline) < 0.75 * signed_area(&convex_hull(&points)) {
        return;
    }
    let size = pca.extent[0].max(pca.extent[1]);
    let inside = |s: &InkStroke| {
        let stride = s.points.len().div_ceil(40);
        let (n, hits) = s
            .points
            .iter()
            .step_by(stride)
            .fold((0_u32, 0_u32), |(n, h), &p| (n + 1, h + u32::from(contains(&outline, p))));
        f64::from(hits) / f64::from(n.max(1))
    };
    let lines: Vec<usize> = (0..draft.class.len())
        .take(400)
        .filter(|&j| j != k && [Axis, Vein, TrunkOutline].contains(&draft.class[j]) && unsure(draft, j))
        .collect();
    let along = |s: &InkStroke| {
        let run: DVec2 = s.points[s.points.len() - 1] - s.points[0];
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
        let head = unsure(draft, k)
            .then(|| simple_outline(&draft.ink.strokes[k].points))
            .flatten()
            .and_then(|o| neck(&o))
            .map(|n| n.1);
        if head.is_some_and(|h| signed_area(&h) > 0.78 * signed_area(&convex_hull(&h))) {
            draft.class[k] = Crown;
        }
    }
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
    let stands = (0..draft.class.len()).any(|k| draft.class[k] == TrunkOutline && !rows.contains(&k));
    if !stands {
        rows.into_iter().for_each(|k| draft.class[k] = StrokeClass::Corolla);
    }
}

/// Several single lines and nothing that a trunk could carry: stalks of grass, not sides of trunks.
fn grass(draft: &mut Draft<'_>) {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Fruit, Scribble, TrunkOutline};
    if any(draft, &[Crown, Corolla, Blade, Disc, Scribble]) {
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
