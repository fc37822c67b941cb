//! The contour of a crown, and the neck where it passes into its trunk.

use geom::{bounds, convex_hull, signed_area, simple_outline, simplify};
use glam::DVec2;

/// A hull of at most this area is a line, not a crown.
const NO_AREA: f64 = 2e-4;
/// An outline that fills less of its hull is a scribble, whose hull is the crown.
const FULL: f64 = 0.4;
/// The trunk goes on up to where the outline is this factor of its median width wide.
const TRUNK_WIDTH: f64 = 1.5;
/// Limits of a neck in a known tree: a trunk is narrower than the first share of its crown, and the outline widens by
/// more than the second factor within six of the levels.
const NECK_OF_A_TREE: (f64, f64) = (0.6, 1.25);
/// The same limits where the outline is not known to be a tree.
const NECK: (f64, f64) = (0.4, 1.7);
/// A trunk is higher than this share of its width.
const TRUNK_TALL: f64 = 0.8;
/// A trunk is higher than this share of the whole height.
const TRUNK_SHARE: f64 = 0.12;
/// A crown is higher than this share of the whole height.
const CROWN_SHARE: f64 = 0.2;

/// The waist of a known tree lies in these of the [`LEVELS`].
const WAIST: core::ops::Range<usize> = 3..42;
/// The trunk of a known tree goes on up to where it is this factor of its waist wide.
const ABOVE_WAIST: f64 = 1.3;
/// The crown of a known tree fills more than this share of its hull, or it is bare branches.
const FULL_CROWN: f64 = 0.65;
/// Levels of the height at which the width is looked at.
const LEVELS: usize = 60;

/// Returns the outline of a crown, however loopy: the largest simple polygon, or the hull of a scribble.
pub(crate) fn crown_outline(points: &[DVec2]) -> Option<Vec<DVec2>> {
    let hull = convex_hull(points);
    let hull_area = signed_area(&hull);
    // A line, not a crown.
    if hull_area <= NO_AREA {
        return None;
    }
    match simple_outline(&simplify(points, 0.001)) {
        Some(outline) if signed_area(&outline) > FULL * hull_area => Some(outline),
        _ => Some(hull),
    }
}

/// Splits an outline with a narrow lower part and a wide upper part at the neck: trunk and crown. `known`: it is a
/// tree, so that the neck may be less clear.
pub(crate) fn neck(outline: &[DVec2], known: bool) -> Option<(Vec<DVec2>, Vec<DVec2>)> {
    let y = trunk_top(outline, known)?;
    let cut = |keep_above: bool| {
        let inside = |p: DVec2| (p.y >= y) == keep_above;
        let mut part = Vec::new();
        for (i, &a) in outline.iter().enumerate() {
            let b = outline[(i + 1) % outline.len()];
            if inside(a) {
                part.push(a);
            }
            if inside(a) != inside(b) {
                part.push(a.lerp(b, (y - a.y) / (b.y - a.y)));
            }
        }
        simple_outline(&part)
    };
    let full =
        |crown: &Vec<DVec2>| !known || signed_area(crown) > FULL_CROWN * signed_area(&convex_hull(crown));
    cut(false).zip(cut(true).filter(full))
}

/// Returns the height at which an outline that is narrow below becomes wide; `known` as in [`neck`].
pub(crate) fn trunk_top(outline: &[DVec2], known: bool) -> Option<f64> {
    let (lo, hi) = bounds(outline)?;
    let height = hi.y - lo.y;
    #[expect(clippy::cast_precision_loss, reason = "60 levels")]
    let y_of = |k: usize| lo.y + height * (k as f64 + 0.5) / LEVELS as f64;
    let width: Vec<f64> = (0..LEVELS).map(|k| width_at(outline, y_of(k))).collect();
    let fits = |&(top, narrow): &(usize, f64)| {
        let (trunk_height, crown_height) = (y_of(top) - lo.y, hi.y - y_of(top));
        trunk_height > TRUNK_TALL * narrow
            && trunk_height > TRUNK_SHARE * height
            && crown_height > CROWN_SHARE * height
    };
    let clear = clear_neck(&width, if known { NECK_OF_A_TREE } else { NECK }).filter(fits);
    // A foot that flares looks like a neck, too low for one.
    clear.or_else(|| waist(&width).filter(|w| known && fits(w))).map(|(top, _)| y_of(top))
}

/// Returns the level at which an outline becomes clearly wider than its lower part, for good, and how wide that part
/// is.
fn clear_neck(width: &[f64], (thin, wider): (f64, f64)) -> Option<(usize, f64)> {
    let widest = width.iter().copied().fold(0.0, f64::max);
    let first_wide = width.iter().position(|w| *w > 0.5 * widest)?;
    let mut below: Vec<f64> = width[..first_wide].to_vec();
    base::sort_numbers(&mut below);
    let median = below.get(below.len() / 2).copied()?;
    let top = (0..=first_wide).rev().find(|&k| width[k] < TRUNK_WIDTH * median).map_or(first_wide, |k| k + 1);
    let jump = width[(top + 3).min(LEVELS - 1)] > wider * width[top.saturating_sub(3)];
    (median < thin * widest && jump).then_some((top, median))
}

/// Finds the neck of a trunk that is wide, or whose foot is, like [`clear_neck`]: above its narrowest level.
fn waist(width: &[f64]) -> Option<(usize, f64)> {
    let at = WAIST.min_by(|&a, &b| width[a].total_cmp(&width[b]))?;
    let widest = width[at..].iter().copied().fold(0.0, f64::max);
    let top = (at..LEVELS).find(|&k| width[k] > ABOVE_WAIST * width[at])?;
    (width[at] < NECK_OF_A_TREE.0 * widest).then_some((top, width[at]))
}

pub(crate) fn width_at(outline: &[DVec2], y: f64) -> f64 {
    runs_at(outline, y).into_iter().map(|(from, to)| to - from).sum()
}

/// Returns the intervals of a level within an outline, from left to right.
pub(crate) fn runs_at(outline: &[DVec2], y: f64) -> Vec<(f64, f64)> {
    let mut xs: Vec<f64> = outline
        .iter()
        .enumerate()
        .filter_map(|(i, &a)| {
            let b = outline[(i + 1) % outline.len()];
            ((a.y > y) != (b.y > y)).then(|| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
        })
        .collect();
    base::sort_numbers(&mut xs);
    xs.chunks_exact(2).map(|w| (w[0], w[1])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_in_one_stroke_is_cut_at_its_neck() {
        let p = |x: f64, y: f64| DVec2::new(x, y);
        let tree = [
            p(0.45, 0.0),
            p(0.55, 0.0),
            p(0.55, 0.4),
            p(0.9, 0.45),
            p(0.9, 0.9),
            p(0.1, 0.9),
            p(0.1, 0.45),
            p(0.45, 0.4),
        ];
        let (trunk, crown) = neck(&tree, false).expect("has a neck");
        assert!((signed_area(&trunk) - 0.04).abs() < 0.005, "{}", signed_area(&trunk));
        assert!(crown.iter().all(|q| q.y > 0.35), "{crown:?}");
        assert!(
            neck(&[p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)], true).is_none(),
            "a box has no neck"
        );
    }
}
