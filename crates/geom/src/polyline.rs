//! Open lines: measures, resampling, smoothing and queries.
//!
//! Points that are not usable (see the crate's first page) are left out and their neighbours joined, unless a function
//! says otherwise. Empty and one-point lines are valid everywhere.

use crate::vector::{Vector, distinct, to_index};
use base::ops;
use glam::{DVec2, DVec3};

// A line of more pieces than this means a mistake in `step`; the memory stays under 24 MB.
const MAX_PIECES: usize = 1_000_000;

fn usable_pairs<V: Vector>(points: &[V]) -> impl Iterator<Item = (usize, V, V)> {
    let mut before: Option<(usize, V)> = None;
    points.iter().enumerate().filter(|(_, p)| p.usable()).filter_map(move |(i, &p)| {
        let pair = before.map(|(j, q)| (j, q, p));
        before = Some((i, p));
        pair
    })
}

fn length_of<V: Vector>(points: &[V]) -> f64 {
    usable_pairs(points).map(|(_, a, b)| a.distance(b)).sum()
}

/// Returns the length of a line: the sum of its segments' lengths, 0 for fewer than two usable points.
pub fn polyline_length(points: &[DVec2]) -> f64 {
    length_of(points)
}

/// Returns the length of a closed line: that of a polygon's margin.
///
/// ```
/// use glam::DVec2;
/// assert_eq!(geom::perimeter(&[DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y]), 4.0);
/// ```
pub fn perimeter(polygon: &[DVec2]) -> f64 {
    let last = polygon.last().zip(polygon.first()).map_or(0.0, |(a, b)| a.distance(*b));
    polyline_length(polygon) + last
}

/// Returns the length of a line in space: the sum of its segments' lengths, 0 for fewer than two usable points.
pub fn polyline_length3(points: &[DVec3]) -> f64 {
    length_of(points)
}

fn resample_any<V: Vector>(points: &[V], step: f64) -> Vec<V> {
    let line = distinct(points);
    let total = length_of(&line);
    let sound = step > 0.0 && total > 0.0;
    let (Some(&last), true) = (line.last(), sound) else {
        return line;
    };
    // 1e-9: a length of exactly n steps must not become n + 1 pieces through rounding.
    let pieces = to_index((total / step - 1e-9).ceil(), MAX_PIECES).max(1);
    let mut out = Vec::with_capacity(pieces + 1);
    let mut done = 0.0; // arc length at the start of the segment in hand
    let mut k = 0;
    for pair in line.windows(2) {
        let length = pair[0].distance(pair[1]);
        while k < pieces {
            let at = total * (k as f64 / pieces as f64);
            if at > done + length {
                break;
            }
            out.push(pair[0] + (pair[1] - pair[0]) * ((at - done) / length).clamp(0.0, 1.0));
            k += 1;
        }
        done += length;
    }
    out.push(last);
    out
}

/// Returns points at equal distances along a line, at most `step` apart; the first and last point are kept.
///
/// Drops unusable and repeated points. A `step` that is not positive only does that. At most a million pieces are made,
/// whatever the step. Distances are measured along the line, so corners are cut.
///
/// ```
/// use glam::DVec2;
/// let line = geom::resample(&[DVec2::ZERO, DVec2::new(1.0, 0.0)], 0.3);
/// assert_eq!(line.len(), 5); // four pieces of 0.25
/// ```
pub fn resample(points: &[DVec2], step: f64) -> Vec<DVec2> {
    resample_any(points, step)
}

/// As [`resample`], in space.
pub fn resample3(points: &[DVec3], step: f64) -> Vec<DVec3> {
    resample_any(points, step)
}

/// Returns the weighted mean of Eq 1 over the points whose indices `near` yields.
fn gaussian_mean(points: &[DVec2], i: usize, c: f64, near: impl Iterator<Item = usize>) -> DVec2 {
    let here = points[i];
    let (mut sum, mut weights) = (DVec2::ZERO, 0.0);
    for p in near.map(|j| points[j]).filter(|p| p.usable()) {
        let offset = p - here;
        let weight = ops::exp(-offset.length_squared() / c);
        sum += offset * weight;
        weights += weight;
    }
    if weights > 0.0 { here + sum / weights } else { here }
}

/// Smooths an open line: each point becomes the mean of its neighbours, weighted by exp(-d^2/c).
///
/// `half_window` points on either side take part, fewer near the ends; `c` is in squared units of the line. The ends
/// stay in place, and the number of points stays the same; unusable points are passed through and do not contribute. If
/// `c` is not positive the line is returned unchanged. Cost: points x window.
///
/// He and Cheng (2021), Eq 1.
pub fn smooth_gaussian(points: &[DVec2], half_window: usize, c: f64) -> Vec<DVec2> {
    let mut out = points.to_vec();
    let sound = c > 0.0;
    if points.len() < 3 || !sound {
        return out;
    }
    let last = points.len() - 1;
    for (i, smoothed) in out.iter_mut().enumerate().take(last).skip(1) {
        if points[i].usable() {
            // Truncated equally on both sides near the ends: a one-sided mean would pull them inwards.
            let half = half_window.min(i).min(last - i);
            *smoothed = gaussian_mean(points, i, c, i - half..=i + half);
        }
    }
    out
}

/// As [`smooth_gaussian`], for a closed line (first point not repeated): the window runs over the seam.
pub fn smooth_gaussian_closed(points: &[DVec2], half_window: usize, c: f64) -> Vec<DVec2> {
    let mut out = points.to_vec();
    let n = points.len();
    let sound = c > 0.0;
    if n < 3 || !sound {
        return out;
    }
    let half = half_window.min((n - 1) / 2);
    for (i, smoothed) in out.iter_mut().enumerate() {
        if points[i].usable() {
            *smoothed = gaussian_mean(points, i, c, (0..=2 * half).map(|k| (i + n + k - half) % n));
        }
    }
    out
}

/// Leaves out points while the line stays within `tolerance` of every point left out.
///
/// Keeps the ends; drops unusable and repeated points. A tolerance that is not positive drops no others. Cost: usually
/// n log n, n^2 at worst.
///
/// Douglas and Peucker 1973.
pub fn simplify(points: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let line = distinct(points);
    let sound = tolerance > 0.0;
    if line.len() < 3 || !sound {
        return line;
    }
    let mut keep = vec![false; line.len()];
    keep[0] = true;
    keep[line.len() - 1] = true;
    let mut open = vec![(0, line.len() - 1)];
    while let Some((a, b)) = open.pop() {
        let mut far = (tolerance, None);
        for (i, &p) in line.iter().enumerate().take(b).skip(a + 1) {
            let (t, _) = nearest_on_segment(line[a], line[b], p);
            let d = (line[a] + (line[b] - line[a]) * t).distance(p);
            if d > far.0 {
                far = (d, Some(i));
            }
        }
        if let Some(i) = far.1 {
            keep[i] = true;
            open.push((a, i));
            open.push((i, b));
        }
    }
    line.into_iter().zip(keep).filter_map(|(p, k)| k.then_some(p)).collect()
}

/// Returns the point of a segment nearest to `p`, as a parameter in \[0, 1\] and as a position.
pub(crate) fn nearest_on_segment(a: DVec2, b: DVec2, p: DVec2) -> (f64, DVec2) {
    let along = b - a;
    let squared = along.length_squared();
    let t = if squared > 0.0 { ((p - a).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    (t, if t >= 1.0 { b } else { a + along * t })
}

/// Returns the distance of a point from the segment between `a` and `b`; the numbers are not checked.
///
/// ```
/// use glam::DVec2;
/// assert_eq!(geom::distance_to_segment(DVec2::ZERO, DVec2::X, DVec2::new(3.0, 0.0)), 2.0);
/// ```
pub fn distance_to_segment(a: DVec2, b: DVec2, p: DVec2) -> f64 {
    nearest_on_segment(a, b, p).1.distance(p)
}

/// The point of a line nearest to a given point.
///
/// ```
/// use glam::DVec2;
/// let line = [DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(2.0, 2.0)];
/// let c = geom::closest_on_polyline(&line, DVec2::new(3.0, 1.0)).unwrap();
/// assert_eq!((c.index, c.t, c.distance, c.at), (1, 0.5, 1.0, 3.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The segment, by the index of its first point.
    pub index: usize,
    /// Position on the segment, 0 at its first point, 1 at its second.
    pub t: f64,
    /// The point itself.
    pub point: DVec2,
    /// Its distance from the given point.
    pub distance: f64,
    /// Arc length from the start of the line.
    pub at: f64,
}

/// Returns the point of a line nearest to `p`; of equally near ones the first.
///
/// `None` if the line has no usable point or `p` is not usable. A single point counts as a segment without
/// length. Cost: linear.
pub fn closest_on_polyline(points: &[DVec2], p: DVec2) -> Option<Closest> {
    let (index, t, point) = nearest_of(points, p)?;
    let at = length_of(points.get(..=index).unwrap_or_default());
    let on = usable_pairs(points.get(index..).unwrap_or_default()).next();
    let at = at + on.map_or(0.0, |(_, a, b)| t * Vector::distance(a, b));
    Some(Closest { index, t, point, distance: Vector::distance(point, p), at })
}

/// Returns only the distance of [`closest_on_polyline`], at half its cost.
///
/// ```
/// use glam::DVec2;
/// let line = [DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(2.0, 2.0)];
/// assert_eq!(geom::distance_to_polyline(&line, DVec2::new(3.0, 1.0)), Some(1.0));
/// ```
pub fn distance_to_polyline(points: &[DVec2], p: DVec2) -> Option<f64> {
    nearest_of(points, p).map(|(_, _, point)| Vector::distance(point, p))
}

/// Returns the nearest segment, the parameter on it and the point nearest to `p`.
fn nearest_of(points: &[DVec2], p: DVec2) -> Option<(usize, f64, DVec2)> {
    if !p.usable() {
        return None;
    }
    let (index, &only) = points.iter().enumerate().find(|(_, q)| q.usable())?;
    let (mut index, mut t, mut point) = (index, 0.0, only);
    // Squares, without roots so far: this loop dominates many measurements.
    let mut nearest = only.distance_squared(p);
    for (k, a, b) in usable_pairs(points) {
        // The box around a segment is tested first: it takes no division.
        let outside = (a.min(b) - p).max(p - a.max(b)).max(DVec2::ZERO);
        if outside.length_squared() >= nearest {
            continue;
        }
        let (s, q) = nearest_on_segment(a, b, p);
        let squared = q.distance_squared(p);
        if squared < nearest {
            (index, t, point, nearest) = (k, s, q, squared);
        }
    }
    Some((index, t, point))
}

/// Returns the segment at an arc length, with the share of it that lies before.
fn segment_at<V: Vector>(points: &[V], at: f64) -> Option<(V, V, f64)> {
    let at = if at.is_nan() { 0.0 } else { at };
    let mut done = 0.0;
    let mut last = None;
    for (_, a, b) in usable_pairs(points) {
        let length = a.distance(b);
        if length > 0.0 {
            if at < done + length {
                return Some((a, b, ((at - done) / length).max(0.0)));
            }
            last = Some((a, b, 1.0));
            done += length;
        }
    }
    last
}

fn point_at_any<V: Vector>(points: &[V], at: f64) -> Option<V> {
    match segment_at(points, at) {
        Some((_, b, t)) if t >= 1.0 => Some(b),
        Some((a, b, t)) => Some(a + (b - a) * t),
        None => points.iter().copied().find(|p| p.usable()),
    }
}

/// Returns the point at arc length `at` (clamped to the line; NaN counts as 0); `None` without a usable point.
pub fn point_at(points: &[DVec2], at: f64) -> Option<DVec2> {
    point_at_any(points, at)
}

/// As [`point_at`], in space.
pub fn point_at3(points: &[DVec3], at: f64) -> Option<DVec3> {
    point_at_any(points, at)
}

/// Returns the unit direction of the segment at arc length `at` (clamped; NaN counts as 0).
///
/// At a corner it is the direction of the segment that begins there. `None` for a line without length.
pub fn tangent_at(points: &[DVec2], at: f64) -> Option<DVec2> {
    segment_at(points, at).and_then(|(a, b, _)| (b - a).direction())
}

/// As [`tangent_at`], in space.
pub fn tangent_at3(points: &[DVec3], at: f64) -> Option<DVec3> {
    segment_at(points, at).and_then(|(a, b, _)| (b - a).direction())
}

/// Returns the signed turning angle at each inner point, radians in (-pi, pi], positive to the left.
///
/// There are `points.len() - 2` values (none for fewer than 3 points). The angle is 0 next to a segment without length
/// and if one of the three points is not usable.
pub fn turning_angles(points: &[DVec2]) -> Vec<f64> {
    points
        .windows(3)
        .map(|w| {
            if !w.iter().all(|p| p.usable()) {
                return 0.0;
            }
            match ((w[1] - w[0]).direction(), (w[2] - w[1]).direction()) {
                (Some(a), Some(b)) => ops::atan2(a.perp_dot(b), Vector::dot(a, b)),
                _ => 0.0,
            }
        })
        .collect()
}

/// Returns the distance of a point from a line in space, and the share of the line's length at the nearest point, 0 to
/// 1; infinity and 0 for fewer than two points. Cost: linear.
///
/// ```
/// use glam::DVec3;
/// assert_eq!(geom::nearest_on_polyline3(&[DVec3::ZERO, DVec3::X, DVec3::X * 4.0], DVec3::new(1.0, 2.0, 0.0)), (2.0, 0.25));
/// ```
pub fn nearest_on_polyline3(line: &[DVec3], p: DVec3) -> (f64, f64) {
    let (mut best, mut at, mut sum) = (f64::INFINITY, 0.0, 0.0);
    for w in line.windows(2) {
        let d = w[1] - w[0];
        let length = d.length();
        let t = if length > 0.0 { ((p - w[0]).dot(d) / (length * length)).clamp(0.0, 1.0) } else { 0.0 };
        let distance = p.distance(w[0] + d * t);
        if distance < best {
            (best, at) = (distance, sum + t * length);
        }
        sum += length;
    }
    (best, if sum > 0.0 { at / sum } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner() -> Vec<DVec2> {
        vec![DVec2::ZERO, DVec2::new(3.0, 0.0), DVec2::new(3.0, 4.0)]
    }

    #[test]
    fn length_joins_over_unusable_points() {
        let line = [DVec2::ZERO, DVec2::NAN, DVec2::new(3.0, 4.0), DVec2::new(1e300, 0.0)];
        assert_eq!(polyline_length(&line), 5.0);
        assert_eq!(polyline_length(&[]), 0.0);
        assert_eq!(polyline_length3(&[DVec3::ZERO, DVec3::new(2.0, 3.0, 6.0)]), 7.0);
    }

    #[test]
    fn resample_steps_are_equal_along_the_line() {
        let out = resample(&corner(), 1.0);
        assert_eq!(out.len(), 8);
        assert_eq!((out[0], out[3], out[7]), (DVec2::ZERO, DVec2::new(3.0, 0.0), DVec2::new(3.0, 4.0)));
        assert!((out[5] - DVec2::new(3.0, 2.0)).length() < 1e-12);
    }

    #[test]
    fn resample_of_a_repeated_point_is_that_point() {
        assert_eq!(resample(&[DVec2::ONE; 4], 0.1), vec![DVec2::ONE]);
        assert_eq!(resample(&[DVec2::NAN; 4], 0.1), vec![]);
    }

    #[test]
    fn smoothing_keeps_ends_and_straight_lines() {
        let line: Vec<_> = (0..20).map(|i| DVec2::new(f64::from(i) * 0.1, 0.0)).collect();
        let out = smooth_gaussian(&line, 4, 0.05);
        for (a, b) in line.iter().zip(&out) {
            assert!((*a - *b).length() < 1e-12, "an evenly sampled straight line is a fixed point");
        }
        let mut bumped = line.clone();
        bumped[10].y = 0.1;
        let out = smooth_gaussian(&bumped, 4, 0.05);
        assert!(out[10].y < 0.05 && out[0] == line[0] && out[19] == line[19], "the bump is halved at least");
    }

    #[test]
    fn closed_smoothing_shrinks_a_circle_evenly() {
        let n = 64;
        let circle: Vec<_> =
            (0..n).map(|i| base::turn::direction(ops::TAU * f64::from(i) / f64::from(n))).collect();
        let radii: Vec<f64> = smooth_gaussian_closed(&circle, 5, 0.1).iter().map(|p| p.length()).collect();
        assert!(radii.iter().all(|r| (r - radii[0]).abs() < 1e-12 && *r < 1.0 && *r > 0.9), "{radii:?}");
    }

    #[test]
    fn simplify_keeps_corners_only() {
        let dense = resample(&corner(), 0.1);
        assert_eq!(simplify(&dense, 0.01), corner());
        assert_eq!(simplify(&dense, 0.0).len(), dense.len());
    }

    #[test]
    fn point_and_tangent_are_clamped() {
        let line = corner();
        assert_eq!(point_at(&line, -1.0), Some(DVec2::ZERO));
        assert_eq!(point_at(&line, 99.0), Some(DVec2::new(3.0, 4.0)));
        assert_eq!(point_at(&line, 5.0), Some(DVec2::new(3.0, 2.0)));
        assert_eq!(tangent_at(&line, 3.0), Some(DVec2::Y));
        assert_eq!(tangent_at(&line, f64::INFINITY), Some(DVec2::Y));
        assert_eq!(tangent_at(&[DVec2::ONE; 3], 0.0), None);
        assert_eq!(point_at(&[DVec2::ONE; 3], 7.0), Some(DVec2::ONE));
        assert_eq!(point_at3(&[], 0.0), None);
        assert_eq!(tangent_at3(&[DVec3::ZERO, DVec3::Z], f64::NAN), Some(DVec3::Z));
    }

    #[test]
    fn turning_of_a_left_corner_is_a_quarter() {
        assert_eq!(turning_angles(&corner()), vec![ops::FRAC_PI_2]);
        assert_eq!(turning_angles(&[DVec2::ZERO, DVec2::ZERO, DVec2::X]), vec![0.0]);
    }

    #[test]
    fn closest_counts_indices_of_the_input() {
        let line = [DVec2::ZERO, DVec2::NAN, DVec2::new(2.0, 0.0), DVec2::new(4.0, 0.0)];
        let c = closest_on_polyline(&line, DVec2::new(3.0, 1.0)).unwrap();
        assert_eq!((c.index, c.t, c.at), (2, 0.5, 3.0));
        assert_eq!(closest_on_polyline(&line, DVec2::NAN), None);
        assert_eq!(closest_on_polyline(&[DVec2::X], DVec2::ZERO).map(|c| c.distance), Some(1.0));
    }
}
