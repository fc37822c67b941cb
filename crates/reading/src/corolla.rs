//! Several petals, fronds or grass blades in one stroke: cut at the cusps (product A12).

use geom::{bounds, closest_on_polyline, distance_to_polyline, polyline_length};
use glam::DVec2;

use crate::blade::Sheetlet;

/// A dip between two petals is one when it is at least this share of the stroke's reach deep.
const DIP: f64 = 0.13;
/// Most petals that one stroke is cut into.
const MOST: usize = 400;
/// Ends of a blade of grass that differ in height by more than this share of it: one is an open end of the stroke.
const OPEN_END: f64 = 0.3;
/// A corolla whose ends are nearer than this share of its diagonal is closed.
const SHUT: f64 = 0.12;
/// The rim of a cup dips no nearer to its foot than this share of its reach.
const CUP_DEPTH: f64 = 0.35;
/// The points of a cup lie farther from its foot than this share of its reach.
const CUP_TIP: f64 = 0.75;
/// The cosine of the angle to the cup's axis beyond which only its foot lies: 70 degrees.
const CUP_ASIDE: f64 = 0.34;
/// A piece shorter than this share of the reach is a remnant at an open end.
const REMNANT: f64 = 0.3;
/// Ends nearer to the root than this share of the reach are at it.
const AT_ROOT: f64 = 0.02;

/// The thing round which the petals of a corolla stand.
#[derive(Clone, Debug)]
pub(crate) enum Core {
    /// A point with a free radius around it: the centre of a flower (with its disc), the top of a trunk.
    Point(DVec2, f64),
    /// A stem along which they stand.
    Line(Vec<DVec2>),
    /// The ground: a row of grass.
    Ground(f64),
}

impl Core {
    fn distance(&self, p: DVec2) -> f64 {
        match self {
            Self::Point(c, _) => p.distance(*c),
            Self::Line(line) => distance_to_polyline(line, p).unwrap_or(0.0),
            Self::Ground(y) => p.y - y,
        }
    }

    /// Returns the root of a petal whose drawn arc runs from `a` to `b`.
    fn root(&self, a: DVec2, b: DVec2, top: DVec2) -> DVec2 {
        let middle = a.midpoint(b);
        match self {
            Self::Point(c, free) => {
                let out = (middle.midpoint(top) - *c).normalize_or_zero();
                *c + out * free.min(middle.distance(*c).max(0.2 * top.distance(*c)))
            }
            Self::Line(line) => closest_on_polyline(line, middle).map_or(middle, |c| c.point),
            // A blade at the open end of the stroke is rooted at its lower end.
            Self::Ground(y) if (a.y - b.y).abs() > OPEN_END * (top.y - y) => {
                if a.y < b.y {
                    a
                } else {
                    b
                }
            }
            Self::Ground(_) => middle,
        }
    }
}

/// Returns the angle by which a stroke turns round `centre`, radians, without sign.
pub(crate) fn winding(points: &[DVec2], centre: DVec2) -> f64 {
    points
        .windows(2)
        .map(|w| {
            let (a, b) = (w[0] - centre, w[1] - centre);
            base::ops::atan2(a.perp_dot(b), a.dot(b))
        })
        .sum::<f64>()
        .abs()
}

/// Counts how often a stroke comes back to within `near` of `p`; a closed stroke that begins there does so once.
pub(crate) fn visits(points: &[DVec2], p: DVec2, near: f64) -> usize {
    let mut inside = false;
    let mut count = 0;
    for q in points {
        let d = q.distance(p);
        if d < near && !inside {
            inside = true;
            count += 1;
        } else if d > 2.0 * near {
            inside = false;
        }
    }
    let there = |q: Option<&DVec2>| q.is_some_and(|q| q.distance(p) < 2.0 * near);
    if count > 1 && there(points.first()) && there(points.last()) { count - 1 } else { count }
}

/// Turns a closed line so that it begins at its point nearest to a core, and comes back to it.
pub(crate) fn turned_to_nearest(points: &[DVec2], distance: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let nearest = |&a: &usize, &b: &usize| distance(points[a]).total_cmp(&distance(points[b]));
    let start = (0..points.len()).min_by(nearest).unwrap_or(0);
    points[start..].iter().chain(points.get(..=start).unwrap_or_default()).copied().collect()
}

/// Cuts a stroke where it comes nearest to the core between two petals.
///
/// Every piece becomes one blade with a root at the core. A stroke without a dip is one blade.
pub(crate) fn split(points: &[DVec2], core: &Core, stroke: usize) -> Vec<Sheetlet> {
    let Some((lo, hi)) = bounds(points) else { return Vec::new() };
    let closed =
        points.first().zip(points.last()).is_some_and(|(a, b)| a.distance(*b) < SHUT * lo.distance(hi));
    // A closed stroke is turned so that it begins at its deepest dip, and comes back to it.
    let line = if closed { turned_to_nearest(points, |p| core.distance(p)) } else { points.to_vec() };
    let distance: Vec<f64> = line.iter().map(|&p| core.distance(p)).collect();
    let reach = distance.iter().copied().fold(0.0, f64::max);
    let cuts = dips(&distance, DIP * reach);
    let mut pieces = Vec::new();
    for w in cuts.windows(2).take(MOST) {
        let arc = &line[w[0]..=w[1]];
        let Some(&top) = arc.iter().max_by(|a, b| core.distance(**a).total_cmp(&core.distance(**b))) else {
            continue;
        };
        let (a, b) = (arc[0], arc[arc.len() - 1]);
        // A remnant at an open end of the stroke is no petal.
        if arc.len() < 3 || polyline_length(arc) < REMNANT * reach {
            continue;
        }
        let root = core.root(a, b, top);
        let mut ring = arc.to_vec();
        if root.distance(a) > AT_ROOT * reach && root.distance(b) > AT_ROOT * reach {
            ring.push(root);
        }
        if let Some(mut blade) = Sheetlet::new(&ring, stroke) {
            blade.root = Some(blade.nearest(root).0);
            blade.gap = root;
            blade.leaf = !matches!(core, Core::Point(..));
            pieces.push(blade);
        }
    }
    pieces
}

/// Whether a stroke goes round petals seen in profile: from `foot` up one side, over two points or more with a dip
/// between them, and down the other. Its points are about equally far from the foot, unlike those of a ring.
pub(crate) fn is_cup(points: &[DVec2], foot: DVec2) -> bool {
    let first = points.first().zip(points.last()).zip(bounds(points));
    if !first.is_some_and(|((a, b), (lo, hi))| a.distance(*b) < SHUT * lo.distance(hi)) {
        return false;
    }
    let line = turned_to_nearest(points, |p| p.distance(foot));
    let distance: Vec<f64> = line.iter().map(|p| p.distance(foot)).collect();
    let reach = distance.iter().copied().fold(0.0, f64::max);
    let cuts = dips(&distance, DIP * reach);
    let between = cuts.get(1..cuts.len().saturating_sub(1)).unwrap_or_default();
    let tip = |w: &[usize]| distance[w[0]..=w[1]].iter().copied().fold(0.0, f64::max);
    let ahead = points.iter().map(|p| *p - foot).sum::<DVec2>().normalize_or_zero();
    let aside = |v: DVec2| v.length() > CUP_DEPTH * reach && v.normalize_or_zero().dot(ahead) < CUP_ASIDE;
    !between.is_empty()
        && !points.iter().any(|p| aside(*p - foot))
        && between.iter().all(|&k| distance[k] > CUP_DEPTH * reach)
        && cuts.windows(2).all(|w| tip(w) > CUP_TIP * reach)
}

/// Returns both ends and every low place with at least `depth` of rise on both sides before the next one.
pub(crate) fn dips(values: &[f64], depth: f64) -> Vec<usize> {
    let n = values.len();
    if n < 2 {
        return Vec::new();
    }
    let mut cuts = vec![0];
    let (mut low, mut high) = (0, 0);
    let mut rising = true;
    for i in 1..n {
        if rising {
            if values[i] > values[high] {
                high = i;
            }
            if values[high] - values[i] >= depth {
                rising = false;
                low = i;
            }
        } else {
            if values[i] < values[low] {
                low = i;
            }
            if values[i] - values[low] >= depth {
                cuts.push(low);
                rising = true;
                high = i;
            }
        }
    }
    // The way down after the last top ends at its lowest place; a small rise after it belongs to no petal.
    let end = if rising { n - 1 } else { low };
    if cuts.last() != Some(&end) {
        cuts.push(end);
    }
    cuts
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::ops;

    #[test]
    fn a_scalloped_corolla_round_a_disc_falls_into_its_petals() {
        let points: Vec<DVec2> = (0..=300)
            .map(|i| ops::TAU * f64::from(i) / 300.0)
            .map(|t| DVec2::new(ops::cos(t), ops::sin(t)) * (0.3 + 0.12 * ops::cos(6.0 * t).abs()))
            .collect();
        let petals = split(&points, &Core::Point(DVec2::ZERO, 0.1), 0);
        assert_eq!(petals.len(), 12);
        for p in &petals {
            let root = p.root.expect("decided");
            assert!((root.length() - 0.1).abs() < 0.02, "{root}");
        }
    }

    #[test]
    fn loops_through_the_centre_are_petals() {
        let points: Vec<DVec2> = (0..=300)
            .map(|i| ops::PI * f64::from(i) / 300.0 + 0.1)
            .map(|t| DVec2::new(ops::cos(t), ops::sin(t)) * (0.4 * ops::cos(5.0 * t)))
            .collect();
        let petals = split(&points, &Core::Point(DVec2::ZERO, 0.0), 0);
        assert_eq!(petals.len(), 5);
        assert!(petals.iter().all(|p| p.root.is_some_and(|r| r.length() < 0.05)), "rooted in the centre");
    }

    #[test]
    fn a_zigzag_on_the_ground_is_a_row_of_blades() {
        let points: Vec<DVec2> = (0..7)
            .flat_map(|i| {
                let x = f64::from(i) * 0.1;
                (0..10).map(move |k| {
                    let t = f64::from(k) / 10.0;
                    DVec2::new(x + 0.1 * t, 0.3 * (1.0 - (2.0 * t - 1.0).abs()))
                })
            })
            .chain([DVec2::new(0.7, 0.0)])
            .collect();
        let blades = split(&points, &Core::Ground(0.0), 0);
        assert_eq!(blades.len(), 7);
        assert!(blades.iter().all(|b| b.root.is_some_and(|r| r.y < 0.01)), "rooted on the ground");
    }

    #[test]
    fn dips_are_deep_on_both_sides() {
        assert_eq!(dips(&[0.0, 1.0, 0.9, 1.0, 0.0, 1.0, 0.0], 0.5), [0, 4, 6]);
        assert_eq!(dips(&[1.0, 0.0, 1.0], 0.5), [0, 1, 2]);
        assert_eq!(dips(&[], 0.5), [0_usize; 0]);
    }
}
