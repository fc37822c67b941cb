//! A pot that was drawn in several strokes: a level rim, and its sides and bottom below.
//!
//! `outlines of strokes -> rows of the pot's strokes`

use geom::bounds;
use glam::DVec2;
use ink::Ink;

/// Limits of strokes at the foot of a drawing that form a pot. Lengths are in ink units (the drawing's diagonal is 1).
struct VesselLimits {
    /// The width of the rim is at least this factor of its height,
    level: f64,
    /// and at least this.
    rim: f64,
    /// Strokes of the pot lie within the rim, except for this share of its width.
    slack: f64,
    /// On both sides a line goes down from the rim, from within this share of its width from its end,
    side: f64,
    /// over at least this share of the pot's height below the rim.
    down: f64,
    /// A side that is a line of its own has its ends farther apart than this share of its length: fruits that hang are
    /// rings.
    open: f64,
    /// Leaves that hang over the rim reach down next to the pot by at most this share of its height.
    hang: f64,
    /// Most strokes of a pot: more hang from a twig.
    most_strokes: usize,
    /// Height of the pot relative to its width.
    high: core::ops::Range<f64>,
}

const LIMITS: VesselLimits = VesselLimits {
    level: 4.0,
    rim: 0.08,
    slack: 0.06,
    side: 0.2,
    down: 0.6,
    open: 0.5,
    hang: 0.45,
    most_strokes: 14,
    high: 0.12..1.6,
};

/// Returns the strokes of a pot at the foot of a drawing, its rim first; none unless something stands above it and
/// nothing reaches far below its rim next to it. Cost: strokes times rims.
pub(crate) fn vessel(ink: &Ink) -> Vec<usize> {
    let boxes: Vec<(DVec2, DVec2)> =
        ink.strokes.iter().map(|s| bounds(&s.points).unwrap_or_default()).collect();
    let rims = (0..boxes.len()).filter(|&k| {
        let size = boxes[k].1 - boxes[k].0;
        size.x >= LIMITS.rim && size.x >= LIMITS.level * size.y
    });
    let is_open = |k: usize| {
        let s = &ink.strokes[k];
        s.points[0].distance(s.points[s.points.len() - 1]) > LIMITS.open * s.length
    };
    let open: Vec<bool> = (0..boxes.len()).map(is_open).collect();
    rims.filter_map(|rim| below(&boxes, &open, rim)).max_by_key(Vec::len).unwrap_or_default()
}

/// Returns the strokes below a rim, if they form a pot with it.
fn below(boxes: &[(DVec2, DVec2)], open: &[bool], rim: usize) -> Option<Vec<usize>> {
    let (low, high) = boxes[rim];
    let wide = high.x - low.x;
    let slack = LIMITS.slack * wide;
    // A stroke that begins above the rim grows in the pot; one that ends below it and is no part of it stands next to
    // it.
    let is_part = |&k: &usize| {
        k != rim
            && boxes[k].1.y < high.y + 0.5 * slack
            && boxes[k].0.x > low.x - slack
            && boxes[k].1.x < high.x + slack
    };
    let parts: Vec<usize> = (0..boxes.len()).filter(is_part).collect();
    let foot = parts.iter().map(|&k| boxes[k].0.y).fold(low.y, f64::min);
    let tall = low.y - foot;
    let is_beside =
        |k: usize| k != rim && !parts.contains(&k) && boxes[k].0.y < low.y - slack.max(LIMITS.hang * tall);
    let grows = (0..boxes.len()).any(|k| k != rim && !parts.contains(&k));
    if parts.is_empty() || parts.len() >= LIMITS.most_strokes || !grows || (0..boxes.len()).any(is_beside) {
        return None;
    }
    if !LIMITS.high.contains(&(tall / wide)) {
        return None;
    }
    let reach = LIMITS.side * wide;
    let is_steep = |k: &usize| open[*k] && boxes[*k].1.y - boxes[*k].0.y > boxes[*k].1.x - boxes[*k].0.x;
    let on_left = |k: &usize| is_steep(k) && boxes[*k].0.x < low.x + reach;
    let on_right = |k: &usize| is_steep(k) && boxes[*k].1.x > high.x - reach;
    let is_whole = |k: &usize| boxes[*k].0.x < low.x + reach && boxes[*k].1.x > high.x - reach;
    // A side may be interrupted where a broader rim meets the wall.
    let goes_down = |is_side: &dyn Fn(&usize) -> bool| {
        let mut side: Vec<(f64, f64)> =
            parts.iter().filter(|k| is_side(k)).map(|&k| (boxes[k].1.y, boxes[k].0.y)).collect();
        base::sort_by(&mut side, |a, b| b.0.total_cmp(&a.0));
        let (mut at, mut covered) = (low.y, 0.0);
        for (top, bottom) in side {
            covered += (top.min(at) - bottom).max(0.0);
            at = at.min(bottom);
        }
        covered > LIMITS.down * tall
    };
    let left = goes_down(&|k| on_left(k) || is_whole(k));
    let right = goes_down(&|k| on_right(k) || is_whole(k));
    (left && right).then(|| core::iter::once(rim).chain(parts).collect())
}

#[cfg(test)]
mod tests {
    use base::Report;
    use ink::{Drawing, clean};

    use super::*;

    fn pot_of(lines: &[Vec<DVec2>]) -> Vec<usize> {
        vessel(&clean(&Drawing::from_polylines("pot", lines), &mut Report::default()))
    }

    fn line(points: &[[f64; 2]]) -> Vec<DVec2> {
        points.iter().map(|&p| DVec2::from(p)).collect()
    }

    #[test]
    fn a_rim_two_sides_and_a_bottom_are_a_pot_and_a_stem_in_it_is_none() {
        let rim = line(&[[0.0, 20.0], [30.0, 20.0], [30.0, 23.0], [0.0, 23.0], [0.0, 20.0]]);
        let left = line(&[[2.0, 20.0], [5.0, 1.0]]);
        let right = line(&[[28.0, 20.0], [25.0, 1.0]]);
        let bottom = line(&[[5.0, 1.0], [25.0, 1.0]]);
        let stem = line(&[[15.0, 23.0], [16.0, 70.0]]);
        let leaf = line(&[[16.0, 60.0], [30.0, 66.0], [16.0, 70.0], [16.0, 60.0]]);
        let mut lines = vec![rim, left, right, bottom, stem, leaf];
        assert_eq!(pot_of(&lines), [0, 1, 2, 3]);
        // A broader rim above the wall, and a leaf that hangs over it.
        let mut rimmed = lines.clone();
        rimmed[0] = line(&[[-2.0, 24.0], [32.0, 24.0]]);
        rimmed.push(line(&[[-2.0, 24.0], [-2.0, 20.0]]));
        rimmed.push(line(&[[32.0, 24.0], [32.0, 20.0]]));
        rimmed.push(line(&[[16.0, 40.0], [36.0, 38.0], [40.0, 14.0], [34.0, 30.0], [16.0, 38.0]]));
        assert_eq!(pot_of(&rimmed), [0, 1, 2, 3, 6, 7]);
        // A root that reaches past it, and a pot without sides.
        lines.push(line(&[[40.0, 23.0], [44.0, 0.0]]));
        assert!(pot_of(&lines).is_empty());
        lines.truncate(1);
        lines.push(line(&[[15.0, 23.0], [16.0, 70.0]]));
        assert!(pot_of(&lines).is_empty());
    }
}
