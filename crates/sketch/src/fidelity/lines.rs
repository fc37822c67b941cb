//! The nearest of many lines.
//!
//! `lines -> distance of any point to them`

use geom::KdTree2;
use glam::DVec2;

/// Longest piece that lines are cut into, ink units: a few points answer for each question.
const PIECE: f64 = 0.01;
/// Most points that lines are cut into, about.
const MOST: f64 = 400_000.0;

/// Lines that tell how far a point is from them. Cost: n log n in points, log n for a question.
#[derive(Debug)]
pub(super) struct Lines {
    points: Vec<DVec2>,
    /// Whether a piece runs from this point to the next.
    joined: Vec<bool>,
    /// No piece is longer.
    piece: f64,
    tree: KdTree2,
}

impl Lines {
    /// Lines of any length; points that are not finite are left out.
    pub(super) fn new<'a>(lines: impl Iterator<Item = &'a [DVec2]> + Clone) -> Self {
        let total: f64 = lines.clone().map(geom::polyline_length).filter(|l| l.is_finite()).sum();
        let piece = PIECE.max(total / MOST);
        let (mut points, mut joined) = (Vec::new(), Vec::new());
        for line in lines {
            let first = points.len();
            for &p in line.iter().filter(|p| p.is_finite()) {
                if points.len() > first {
                    let last: DVec2 = points[points.len() - 1];
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "bounded by MOST"
                    )]
                    let pieces = (last.distance(p) / piece).ceil().clamp(1.0, MOST) as u32;
                    let between = |k: u32| last.lerp(p, f64::from(k) / f64::from(pieces));
                    points.extend((1..pieces).map(between));
                }
                points.push(p);
            }
            joined.resize(points.len(), true);
            if let Some(end) = joined.last_mut() {
                *end = false;
            }
        }
        // Where lines are short, so are their pieces, and fewer of them are near enough.
        let pieces = points.windows(2).zip(&joined).filter(|(_, joined)| **joined);
        let longest = pieces.map(|(w, _)| w[0].distance(w[1])).fold(0.0, f64::max);
        let tree = KdTree2::new(&points);
        // A little more than the longest: a length is right to its last bit but one.
        Self { points, joined, piece: piece.min(1.001 * longest), tree }
    }

    /// The distance of a point to the nearest line; `None` where there is no line. `near`: scratch.
    pub(super) fn distance(&self, p: DVec2, near: &mut Vec<usize>) -> Option<f64> {
        let nearest = self.tree.nearest(p, f64::INFINITY)?;
        let mut best = self.points[nearest].distance(p);
        // The nearest place of a line is at most half a piece from one of its points.
        self.tree.within(p, best + 0.5 * self.piece, near);
        for &i in &*near {
            for from in [i.checked_sub(1), Some(i)].into_iter().flatten().filter(|&k| self.joined[k]) {
                best = best.min(geom::distance_to_segment(self.points[from], self.points[from + 1], p));
            }
        }
        Some(best)
    }
}

#[cfg(test)]
mod tests {
    use base::{Draw, Seed};

    use super::*;

    #[test]
    fn the_same_distance_as_by_looking_at_all() {
        let mut s = Seed::new(3).stream(Draw::TwigPlace);
        let mut point = || DVec2::new(s.range(0.0, 1.0), s.range(0.0, 1.0));
        let mut lines: Vec<Vec<DVec2>> = (0..12).map(|i| (0..=i).map(|_| point()).collect()).collect();
        lines.push(vec![DVec2::NAN]);
        lines.push(vec![]);
        let index = Lines::new(lines.iter().map(Vec::as_slice));
        let mut near = Vec::new();
        for _ in 0..500 {
            let p = point() * 1.4 - 0.2;
            let all =
                lines.iter().filter_map(|l| geom::distance_to_polyline(l, p)).fold(f64::INFINITY, f64::min);
            let got = index.distance(p, &mut near).expect("there are lines");
            assert!((got - all).abs() < 1e-12, "{got} {all}");
        }
        assert_eq!(Lines::new([].into_iter()).distance(DVec2::ZERO, &mut near), None);
    }
}
