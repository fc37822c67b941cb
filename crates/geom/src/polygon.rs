//! Measures of closed lines: area, inside test, hull, cross-sections.
//!
//! A polygon is a list of corners whose first is not repeated (repeating it does no harm), counter-clockwise unless
//! stated otherwise. Corners that are not usable are left out.

use crate::polyline::{point_at, polyline_length, tangent_at};
use crate::vector::{Vector, distinct_closed};
use core::cmp::Ordering;
use glam::DVec2;

/// Returns the usable edges of a polygon.
fn edges(polygon: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    let usable = || polygon.iter().copied().filter(|p| p.usable());
    let skip = usable().count().min(1);
    usable().zip(usable().skip(skip).chain(usable().take(1)))
}

/// Returns the area of a polygon, positive if it is counter-clockwise; parts that are circled twice count twice.
pub fn signed_area(polygon: &[DVec2]) -> f64 {
    let Some(origin) = polygon.iter().copied().find(|p| p.usable()) else { return 0.0 };
    // Relative to a corner: far from the origin the area would be lost in the products.
    edges(polygon).map(|(a, b)| 0.5 * (a - origin).perp_dot(b - origin)).sum()
}

/// Returns the centroid of a polygon; the mean of its corners if it has no area; otherwise the origin.
pub fn centroid(polygon: &[DVec2]) -> DVec2 {
    let Some(origin) = polygon.iter().copied().find(|p| p.usable()) else { return DVec2::ZERO };
    let (mut area, mut size, mut moment) = (0.0, 0.0, DVec2::ZERO);
    let (mut mean, mut n) = (DVec2::ZERO, 0.0);
    for (a, b) in edges(polygon).map(|(a, b)| (a - origin, b - origin)) {
        let double = a.perp_dot(b);
        area += 0.5 * double;
        size += double.abs();
        moment += (a + b) * (double / 6.0);
        mean += a;
        n += 1.0;
    }
    // 1e-12: the remainder of cancelled products is not an area.
    if area.abs() > 1e-12 * size && (moment / area).usable() {
        origin + moment / area
    } else {
        origin + mean / n
    }
}

/// Whether a point lies inside a polygon, by the even-odd rule; on the edge either answer is possible.
///
/// False if `p` is not usable. Cost: linear.
pub fn contains(polygon: &[DVec2], p: DVec2) -> bool {
    let Some(mut a) = polygon.iter().copied().rfind(|p| p.usable()) else { return false };
    let mut inside = false;
    for b in polygon.iter().copied().filter(|p| p.usable()) {
        inside ^= crosses_ray(a, b, p);
        a = b;
    }
    inside && p.usable()
}

/// As [`contains`], for points of one height.
///
/// Cost: linear in the corners, and for each point in the edges that cross this height.
///
/// ```
/// use glam::dvec2;
/// let triangle = [dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(0.0, 4.0)];
/// let inside: Vec<bool> = geom::contains_along(&triangle, 1.0, [-1.0, 1.0, 2.0, 3.5]).collect();
/// assert_eq!(inside, [false, true, true, false]);
/// ```
pub fn contains_along<X: IntoIterator<Item = f64>>(
    polygon: &[DVec2],
    y: f64,
    xs: X,
) -> impl Iterator<Item = bool> + use<X> {
    let crossing: Vec<(DVec2, DVec2)> = edges(polygon).filter(|(a, b)| (a.y > y) != (b.y > y)).collect();
    xs.into_iter().map(move |x| {
        let p = DVec2::new(x, y);
        p.usable() && crossing.iter().filter(|&&(a, b)| crosses_ray(a, b, p)).count() % 2 == 1
    })
}

/// As [`contains`], for many points in any order: the edges are sorted by height.
///
/// ```
/// use glam::dvec2;
/// let triangle = [dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(0.0, 4.0)];
/// let inside = geom::Inside::new(&triangle);
/// assert!(inside.has(dvec2(1.0, 2.0)) && !inside.has(dvec2(3.0, 2.0)) && !inside.has(dvec2(1.0, 9.0)));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Inside {
    low: f64,
    step: f64,
    rows: Vec<Vec<(DVec2, DVec2)>>,
}

impl Inside {
    /// Prepares a polygon. Cost: linear in its corners and in the rows that its edges cross, half as many rows as
    /// corners.
    pub fn new(polygon: &[DVec2]) -> Self {
        let (low, high) = edges(polygon)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), (a, _)| (l.min(a.y), h.max(a.y)));
        let count = (polygon.len() / 2).clamp(1, 512);
        if low.is_nan() || high <= low {
            return Self { low: 0.0, step: 1.0, rows: Vec::new() };
        }
        let mut of = Self { low, step: (high - low) / count as f64, rows: vec![Vec::new(); count] };
        for (a, b) in edges(polygon) {
            for row in of.row(a.y.min(b.y))..=of.row(a.y.max(b.y)) {
                of.rows[row].push((a, b));
            }
        }
        of
    }

    fn row(&self, y: f64) -> usize {
        let at = ((y - self.low) / self.step).floor();
        (base::ops::whole(at) as usize).min(self.rows.len().saturating_sub(1))
    }

    /// Whether a point lies inside, as in [`contains`].
    pub fn has(&self, p: DVec2) -> bool {
        if !p.usable() {
            return false;
        }
        let Some(row) = self.rows.get(self.row(p.y)) else { return false };
        row.iter().filter(|&&(a, b)| crosses_ray(a, b, p)).count() % 2 == 1
    }
}

/// Whether the ray from `p` to the right crosses the edge; half open in y, so a corner counts once.
pub(crate) fn crosses_ray(a: DVec2, b: DVec2, p: DVec2) -> bool {
    if (a.y > p.y) == (b.y > p.y) {
        return false;
    }
    // p is left of the crossing: the sign of the turn, seen upwards.
    let turn = (b - a).perp_dot(p - a);
    if b.y > a.y { turn > 0.0 } else { turn < 0.0 }
}

/// Returns the lower left and upper right corner of the box around points; `None` for no points. Linear.
///
/// ```
/// use glam::DVec2;
/// let corners = geom::bounds(&[DVec2::new(2.0, 0.0), DVec2::new(0.0, 1.0)]);
/// assert_eq!(corners, Some((DVec2::ZERO, DVec2::new(2.0, 1.0))));
/// ```
pub fn bounds(points: &[DVec2]) -> Option<(DVec2, DVec2)> {
    let first = *points.first()?;
    Some(points.iter().fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p))))
}

/// Returns the indices of the hull's corners, counter-clockwise from the leftmost lowest; coincident points once.
fn hull_indices(points: &[DVec2]) -> Vec<usize> {
    #[expect(clippy::cast_possible_truncation, reason = "no more points than u32 counts")]
    let usable: Vec<u32> = (0..points.len() as u32).filter(|&i| points[i as usize].usable()).collect();
    let at = |k: u32| points[usable[k as usize] as usize];
    let order = base::sorted_order(usable.len(), &mut |a, b| {
        let (p, q) = (at(a), at(b));
        // Usable points are finite: the comparison is never undecided.
        let by_number = |p: f64, q: f64| p.partial_cmp(&q).unwrap_or(Ordering::Equal);
        by_number(p.x, q.x).then_with(|| by_number(p.y, q.y)).then(a.cmp(&b))
    });
    let mut order: Vec<usize> = order.into_iter().map(|k| usable[k as usize] as usize).collect();
    order.dedup_by(|b, a| points[*a] == points[*b]);
    if order.len() < 3 {
        return order;
    }
    let mut hull: Vec<usize> = Vec::with_capacity(order.len() + 1);
    let mut half = |indices: &mut dyn Iterator<Item = usize>| {
        let base = hull.len();
        for i in indices {
            while hull.len() > base + 1 {
                let (a, b) = (points[hull[hull.len() - 2]], points[hull[hull.len() - 1]]);
                if (b - a).perp_dot(points[i] - b) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(i);
        }
        hull.pop(); // the next half begins with it
    };
    half(&mut order.iter().copied());
    half(&mut order.iter().rev().copied());
    hull
}

/// Returns the convex hull, counter-clockwise, without corners on straight edges. Cost: n log n.
///
/// One point if all coincide, two for a straight line, none without a usable point.
///
/// Andrew 1979, monotone chain.
pub fn convex_hull(points: &[DVec2]) -> Vec<DVec2> {
    hull_indices(points).into_iter().map(|i| points[i]).collect()
}

/// Returns the two points that are farthest apart, by index, the lower index first; `None` for no usable point.
///
/// If all coincide, it is a pair of one index twice. Cost: n log n and the square of the hull's corners.
pub fn farthest_pair(points: &[DVec2]) -> Option<(usize, usize)> {
    let mut hull = hull_indices(points);
    hull.sort_unstable();
    let first = *hull.first()?;
    let mut best = (0.0, (first, first));
    for (k, &i) in hull.iter().enumerate() {
        for &j in &hull[k + 1..] {
            let d = points[i].distance_squared(points[j]);
            if d > best.0 {
                best = (d, (i, j));
            }
        }
    }
    Some(best.1)
}

/// Returns the piece of a straight line inside a polygon that contains, or is nearest to, the line's own point.
fn cross_section(polygon: &[DVec2], at: DVec2, across: DVec2) -> Option<(f64, f64)> {
    let along = across.perp();
    let mut hits: Vec<f64> = Vec::new();
    for (a, b) in edges(polygon) {
        let (sa, sb) = ((a - at).dot(along), (b - at).dot(along));
        if (sa > 0.0) != (sb > 0.0) {
            let t = sa / (sa - sb);
            hits.push((a + (b - a) * t - at).dot(across));
        }
    }
    base::sort_numbers(&mut hits);
    let outside = |&(lo, hi): &(f64, f64)| lo.max(-hi).max(0.0);
    hits.chunks_exact(2).map(|w| (w[0], w[1])).min_by(|p, q| outside(p).total_cmp(&outside(q)))
}

/// Returns cross-sections of an elongated polygon from one end to the other: centres and half widths.
///
/// `samples` (at least 2, at most 10 000) sections stand at equal distances on the path from `from` to `to`, both
/// included; the path is first the straight line and then, once, the line of the centres found, so that a bent leaf is
/// cut across its own direction. If a section misses the polygon the half width is 0. Empty if the polygon has fewer
/// than 3 usable corners or an end is not usable. Cost: samples x corners.
pub fn medial_axis_width(polygon: &[DVec2], from: DVec2, to: DVec2, samples: usize) -> Vec<(DVec2, f64)> {
    let polygon = distinct_closed(polygon);
    if polygon.len() < 3 || !from.usable() || !to.usable() {
        return vec![];
    }
    let samples = samples.clamp(2, 10_000);
    let straight = sections(&polygon, &[from, to], samples);
    let mut way: Vec<DVec2> = vec![from];
    way.extend(straight[1..samples - 1].iter().map(|s| s.0));
    way.push(to);
    // Centres jump at the start of a lobe; a mean of five smooths the directions.
    let calm: Vec<DVec2> = (0..way.len())
        .map(|i| {
            let half = 2.min(i).min(way.len() - 1 - i);
            way[i - half..=i + half].iter().sum::<DVec2>() / (2 * half + 1) as f64
        })
        .collect();
    sections(&polygon, &calm, samples)
}

fn sections(polygon: &[DVec2], way: &[DVec2], samples: usize) -> Vec<(DVec2, f64)> {
    let total = polyline_length(way);
    (0..samples)
        .map(|k| {
            let at = total * (k as f64 / (samples - 1) as f64);
            let here = point_at(way, at).unwrap_or(DVec2::ZERO);
            let found = tangent_at(way, at).and_then(|t| {
                let across = t.perp();
                cross_section(polygon, here, across)
                    .map(|(lo, hi)| (here + across * (0.5 * (lo + hi)), 0.5 * (hi - lo)))
            });
            found.unwrap_or((here, 0.0))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::ops;

    fn square() -> Vec<DVec2> {
        vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y]
    }

    #[test]
    fn square_measures() {
        assert_eq!(signed_area(&square()), 1.0);
        assert_eq!(centroid(&square()), DVec2::splat(0.5));
        assert!(contains(&square(), DVec2::splat(0.3)) && !contains(&square(), DVec2::new(1.5, 0.5)));
        let mut repeated = square();
        repeated.insert(2, DVec2::NAN);
        repeated.push(DVec2::ZERO);
        assert_eq!((signed_area(&repeated), centroid(&repeated)), (1.0, DVec2::splat(0.5)));
        repeated.reverse();
        assert_eq!(signed_area(&repeated), -1.0);
    }

    #[test]
    fn far_from_the_origin_nothing_is_lost() {
        let far: Vec<_> = square().iter().map(|p| *p + DVec2::splat(1e9)).collect();
        assert_eq!((signed_area(&far), centroid(&far)), (1.0, DVec2::splat(1e9 + 0.5)));
    }

    #[test]
    fn a_ray_through_corners_counts_once() {
        let diamond = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y];
        assert!(contains(&diamond, DVec2::ZERO) && !contains(&diamond, DVec2::new(-2.0, 0.0)));
        assert!(!contains(&diamond, DVec2::new(-2.0, 1.0)) && !contains(&diamond, DVec2::NAN));
    }

    #[test]
    fn a_row_of_points_lies_where_each_of_them_does() {
        // A star that crosses itself, with a corner that cannot be used and corners on the row.
        let mut star: Vec<DVec2> = (0..7)
            .map(|k| {
                let (s, c) = ops::sin_cos(f64::from(3 * k) * ops::TAU / 7.0);
                DVec2::new(c, s)
            })
            .collect();
        star.insert(3, DVec2::NAN);
        let mut both = [0, 0];
        for y in (-12..=12).map(|k| 0.1 * f64::from(k)).chain([star[1].y, f64::NAN]) {
            let xs = (-12..=12).map(|k| 0.1 * f64::from(k)).chain([star[1].x, f64::INFINITY]);
            for (x, inside) in xs.clone().zip(contains_along(&star, y, xs)) {
                assert_eq!(inside, contains(&star, DVec2::new(x, y)), "{x} {y}");
                both[usize::from(inside)] += 1;
            }
        }
        assert!(both[0] > 100 && both[1] > 100, "{both:?}");
        assert!(contains_along(&[], 0.0, [0.0]).eq([false]));
    }

    #[test]
    fn without_area_the_mean() {
        assert_eq!(centroid(&[DVec2::ZERO, DVec2::X * 2.0]), DVec2::X);
        assert_eq!((centroid(&[]), signed_area(&[])), (DVec2::ZERO, 0.0));
        assert_eq!((centroid(&[DVec2::ONE]), signed_area(&[DVec2::ONE])), (DVec2::ONE, 0.0));
    }

    #[test]
    fn hull_drops_inner_and_straight_points() {
        let mut points = square();
        points.extend([DVec2::splat(0.5), DVec2::new(0.5, 0.0), DVec2::X, DVec2::NAN]);
        assert_eq!(convex_hull(&points), square());
        assert_eq!(convex_hull(&[DVec2::X; 3]), vec![DVec2::X]);
        assert_eq!(convex_hull(&[DVec2::ZERO, DVec2::ONE, DVec2::splat(0.5)]), vec![DVec2::ZERO, DVec2::ONE]);
    }

    #[test]
    fn farthest_pair_is_a_diagonal() {
        assert_eq!(farthest_pair(&square()), Some((0, 2)));
        assert_eq!(farthest_pair(&[DVec2::NAN, DVec2::X, DVec2::X]), Some((1, 1)));
        assert_eq!(farthest_pair(&[]), None);
    }

    #[test]
    fn sections_of_an_ellipse_follow_it() {
        let n = 400;
        let ellipse: Vec<DVec2> = (0..n)
            .map(|i| ops::TAU * f64::from(i) / f64::from(n))
            .map(|a| DVec2::new(ops::cos(a), 3.0 * ops::sin(a)))
            .collect();
        for (c, half) in medial_axis_width(&ellipse, DVec2::new(0.0, -3.0), DVec2::new(0.0, 3.0), 21) {
            let expected = (1.0 - c.y * c.y / 9.0).max(0.0).sqrt();
            assert!(c.x.abs() < 1e-9 && (half - expected).abs() < 1e-3, "{c} {half} {expected}");
        }
    }

    #[test]
    fn sections_of_a_bent_strip_keep_its_width() {
        // A quarter ring of radii 4 and 5: half width 0.5 everywhere, centres at radius 4.5.
        let arc = |r: f64, back: bool| {
            (0..=60).map(move |i| {
                let i = if back { 60 - i } else { i };
                base::turn::direction(f64::from(i) * ops::FRAC_PI_2 / 60.0) * r
            })
        };
        let ring: Vec<DVec2> = arc(5.0, false).chain(arc(4.0, true)).collect();
        let found = medial_axis_width(&ring, DVec2::new(4.5, 0.0), DVec2::new(0.0, 4.5), 40);
        for (c, half) in &found[4..36] {
            assert!((c.length() - 4.5).abs() < 0.03 && (half - 0.5).abs() < 0.03, "{c} {half}");
        }
        assert!(medial_axis_width(&ring, DVec2::NAN, DVec2::X, 5).is_empty());
    }
}
