//! Finds the nearest of many lines.
//!
//! `lines -> distance of any point to them`

use geom::KdTree2;
use glam::DVec2;

/// Longest piece that lines are cut into, ink units: few points are needed for each query.
const PIECE: f64 = 0.01;
/// Most points that lines are cut into, about.
const MOST: f64 = 400_000.0;
/// Most points that one query examines after the nearest one: lines side by side have about ten near any place.
const MOST_LOOKS: u32 = 64;

/// An index of lines for the distance of points. Cost: n log n in points; log n and at most [`MOST_LOOKS`] points for
/// a query, however many lines lie on one another.
#[derive(Debug)]
pub(super) struct Lines {
    points: Vec<DVec2>,
    /// Whether a piece runs from this point to the next.
    joined: Vec<bool>,
    /// Length of the longest piece.
    piece: f64,
    tree: KdTree2,
}

impl Lines {
    /// Builds the index of lines of any length; points that are not finite are left out.
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
        // If lines are short, so are their pieces, and fewer of them are near enough.
        let pieces = points.windows(2).zip(&joined).filter(|(_, joined)| **joined);
        let longest = pieces.map(|(w, _)| w[0].distance(w[1])).fold(0.0, f64::max);
        let tree = KdTree2::new(&points);
        // A little more than the longest: a length is exact to its last bit but one.
        Self { points, joined, piece: piece.min(1.001 * longest), tree }
    }

    /// Returns the distance of a point to the nearest line; `None` if there is no line.
    ///
    /// Exact if no more than [`MOST_LOOKS`] points of lines may matter. If there are more, the result may be too
    /// large, but is at most the distance to the pieces at the nearest point: at most half a piece more than the true
    /// one, and much less where so many points lie as near as that.
    pub(super) fn distance(&self, p: DVec2) -> Option<f64> {
        Some(self.search(p)?.distance)
    }

    fn search(&self, p: DVec2) -> Option<Found> {
        let nearest = self.tree.nearest(p, f64::INFINITY)?;
        // The nearest place of a line is at most half a piece from one of its points.
        let half = 0.5 * self.piece;
        let mut found = Found { distance: self.distance_near_point(nearest, p), looks: 0 };
        self.tree.look(p, found.distance + half, |i| {
            found.distance = found.distance.min(self.distance_near_point(i, p));
            found.looks += 1;
            (found.looks < MOST_LOOKS).then_some(found.distance + half)
        });
        Some(found)
    }

    /// Returns the distance of `p` to one of the points and the pieces that begin and end there.
    fn distance_near_point(&self, i: usize, p: DVec2) -> f64 {
        let pieces = [i.checked_sub(1), Some(i)].into_iter().flatten().filter(|&k| self.joined[k]);
        let to = |k: usize| geom::distance_to_segment(self.points[k], self.points[k + 1], p);
        pieces.map(to).fold(self.points[i].distance(p), f64::min)
    }
}

/// The result of one query.
#[derive(Clone, Copy, Debug)]
struct Found {
    distance: f64,
    /// Number of points examined.
    looks: u32,
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
        for _ in 0..500 {
            let p = point() * 1.4 - 0.2;
            let all =
                lines.iter().filter_map(|l| geom::distance_to_polyline(l, p)).fold(f64::INFINITY, f64::min);
            let got = index.distance(p).expect("there are lines");
            assert!((got - all).abs() < 1e-12, "{got} {all}");
        }
        assert_eq!(Lines::new([].into_iter()).distance(DVec2::ZERO), None);
    }

    /// Waves that lie on one another except for a jitter: `count` waves of 41 points.
    fn pile(count: u32, jitter: f64) -> Vec<Vec<DVec2>> {
        let mut s = Seed::new(5).stream(Draw::TwigPlace);
        let wave = |i: u32| DVec2::new(0.3 + 0.02 * base::ops::sin(0.3 * f64::from(i)), 0.02 * f64::from(i));
        let mut one = || {
            let off = DVec2::new(s.range(-jitter, jitter), s.range(-jitter, jitter));
            (0..=40).map(|i| wave(i) + off).collect()
        };
        (0..count).map(|_| one()).collect()
    }

    /// Straight lines across a square: `count` lines of 20 points.
    fn crossing(count: u32) -> Vec<Vec<DVec2>> {
        let mut s = Seed::new(6).stream(Draw::TwigPlace);
        let mut point = || DVec2::new(s.range(0.0, 0.7), s.range(0.0, 0.7));
        let mut one = || {
            let (a, b) = (point(), point());
            (0..20).map(|i| a.lerp(b, f64::from(i) / 19.0)).collect()
        };
        (0..count).map(|_| one()).collect()
    }

    /// Queries at, between and near the points of some lines.
    fn asked(lines: &[Vec<DVec2>]) -> impl Iterator<Item = DVec2> {
        let few = lines.iter().step_by(lines.len().div_ceil(20)).flat_map(|line| line.windows(2));
        few.flat_map(|w| [w[0], w[0].lerp(w[1], 0.4), w[1] + DVec2::new(0.003, -0.002)])
    }

    #[test]
    fn where_many_lie_on_one_another_the_distance_is_right_to_a_thousandth() {
        for lines in [pile(700, 0.0), pile(700, 0.004), pile(2000, 0.001), crossing(2000)] {
            let index = Lines::new(lines.iter().map(Vec::as_slice));
            let (mut sum, mut count) = (0.0, 0.0);
            for p in asked(&lines) {
                let all = lines
                    .iter()
                    .filter_map(|l| geom::distance_to_polyline(l, p))
                    .fold(f64::INFINITY, f64::min);
                let got = index.distance(p).expect("there are lines");
                assert!(got > all - 1e-12 && got < all + 1e-3, "{got} {all}");
                (sum, count) = (sum + got - all, count + 1.0);
            }
            assert!(sum / count < 1e-4, "{}", sum / count);
        }
    }

    #[test]
    fn a_question_looks_at_no_more_points_however_many_lie_on_one_another() {
        type Family = fn(u32) -> Vec<Vec<DVec2>>;
        let families: [Family; 3] = [|n| pile(n, 0.0), |n| pile(n, 0.004), crossing];
        for make in families {
            let looks = |count: u32| {
                let lines = make(count);
                let index = Lines::new(lines.iter().map(Vec::as_slice));
                let found = asked(&lines).filter_map(|p| index.search(p));
                let (sum, most, all) =
                    found.fold((0, 0, 0), |(sum, most, all), f| (sum + f.looks, most.max(f.looks), all + 1));
                assert!(most <= MOST_LOOKS, "{most}");
                f64::from(sum) / f64::from(all)
            };
            // Eight times the lines: looking at all near points would be eight times the looks or more.
            let (few, many) = (looks(1000), looks(8000));
            assert!(many <= few.max(32.0) * 2.0, "{few} {many}");
        }
    }
}
