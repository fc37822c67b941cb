//! Triangulates a blade with its margin and veins.
//!
//! The margin is resampled, points along the veins and a hexagonal lattice fill it, and a constrained Delaunay
//! triangulation joins them. All of this happens in coordinates from 1 to 2, so that sizes from 1e-90 to 1e90 are
//! treated alike and no number is too small for exact predicates.

use crate::outline::{crossings_up_to, simple_outline};
use crate::polygon::{contains, signed_area};
use crate::polyline::{closest_on_polyline, nearest_on_segment, polyline_length, resample};
use crate::vector::{Vector, distinct, distinct_closed, to_index};
use base::ops;
use glam::DVec2;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

// Most points: 20 000 are some 40 000 triangles, more than any picture of one leaf shows.
const MAX_POINTS: f64 = 20_000.0;
// Turn of the margin above which a corner is kept: leaf tips, teeth, the notch of a heart.
const SHARP: f64 = 35.0 * ops::PI / 180.0;
// Least distance of kept corners, as a share of an edge, so that a shaky line does not cause tiny triangles.
const CORNER_GAP: f64 = 0.3;
// Least distance of inner points from margin and veins, as a share of an edge: it avoids needle triangles.
const CLEAR: f64 = 0.55;
// Distance, as a share of an edge, below which the points of different veins are merged.
const JOIN: f64 = 0.4;

/// A triangulated blade.
///
/// ```
/// use glam::DVec2;
/// let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
/// let midrib = [DVec2::new(0.5, 0.0), DVec2::new(0.5, 1.0)];
/// let t = geom::triangulate_blade(&square, &[&midrib], 0.2).unwrap();
/// assert!(t.triangles.len() > 35 && t.boundary.len() >= 20);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Triangulation {
    /// The points: first those of the margin, then those of the veins, then the others inside.
    pub points: Vec<DVec2>,
    /// Corner indices into `points`, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// The margin, counter-clockwise, as indices into `points`; the first point is not repeated.
    pub boundary: Vec<u32>,
}

/// Reason why a blade could not be triangulated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TriangulateError {
    /// The edge length is not a positive finite number.
    #[error("the edge length must be positive and finite, not {edge}")]
    BadEdge {
        /// The length given.
        edge: f64,
    },
    /// The outline encloses no area.
    #[error("the outline of {corners} points encloses no area")]
    NoArea {
        /// Usable corners of the outline.
        corners: usize,
    },
    /// The triangulation contradicts its constraints: a fault of this program.
    #[error("internal fault: the margin of {points} points could not be kept in the triangulation")]
    Internal {
        /// Points of the resampled margin.
        points: usize,
    },
}

/// Triangulates a blade with edges about `edge` long that follow the margin and the veins.
///
/// The margin is resampled to steps of about `edge`; corners of more than 35 degrees are kept, and the ends of veins on
/// it are added. Veins become edges as far as they lie inside and cross no earlier vein. An outline that crosses itself
/// is replaced by its [`simple_outline`]; unusable points are dropped. Guaranteed: the triangles are counter-clockwise,
/// do not overlap, and cover the resampled margin exactly; every point is a corner of a triangle; at most about 20 000
/// points (beyond that, `edge` is enlarged). Not guaranteed: the area of the original outline, whose curves are
/// shortened by chords of length `edge`. The same input gives the same bits. Cost: n log n.
///
/// # Errors
/// [`TriangulateError::BadEdge`] and [`TriangulateError::NoArea`] for such input.
pub fn triangulate_blade(
    outline: &[DVec2],
    veins: &[&[DVec2]],
    edge: f64,
) -> Result<Triangulation, TriangulateError> {
    let sound = edge > 0.0 && edge.is_finite();
    if !sound {
        return Err(TriangulateError::BadEdge { edge });
    }
    let outline = distinct_closed(outline);
    let no_area = TriangulateError::NoArea { corners: outline.len() };
    let (mut lo, mut hi) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for &p in &outline {
        (lo, hi) = (lo.min(p), hi.max(p));
    }
    let size = (hi - lo).max_element();
    let has_size = size > 0.0 && (1.0 / size).is_finite();
    if outline.len() < 3 || !has_size {
        return Err(no_area);
    }
    let to_unit = |p: &DVec2| (*p - lo) / size + DVec2::ONE;
    let mut margin: Vec<DVec2> = distinct_closed(&outline.iter().map(to_unit).collect::<Vec<_>>());
    let veins: Vec<Vec<DVec2>> = veins
        .iter()
        .flat_map(|vein| {
            let vein: Vec<DVec2> = vein.iter().filter(|p| p.usable()).map(to_unit).collect();
            inside_box(&vein)
        })
        .collect();
    if crossings_up_to(&margin, 1) > 0 {
        margin = simple_outline(&margin).ok_or(no_area)?;
    }
    let area = signed_area(&margin);
    if area < 0.0 {
        margin.reverse();
    }
    // 1e-9 of the squared size: a line that only goes to and fro.
    if margin.len() < 3 || area.abs() < 1e-9 {
        return Err(no_area);
    }
    let edge = affordable(&margin, &veins, edge / size);
    let mut done = triangulate_unit(&margin, &veins, edge)?;
    for p in &mut done.points {
        *p = lo + (*p - DVec2::ONE) * size;
    }
    Ok(done)
}

/// Returns the runs of a vein inside the box from 1 to 2 (the blade fills its middle part).
fn inside_box(vein: &[DVec2]) -> Vec<Vec<DVec2>> {
    let mut runs: Vec<Vec<DVec2>> = vec![];
    for pair in vein.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        // Liang and Barsky 1984.
        let along = b - a;
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (start, step) in [(a.x, along.x), (a.y, along.y)] {
            if step == 0.0 {
                if !(1.0..=2.0).contains(&start) {
                    to = -1.0;
                }
            } else {
                let (s, t) = ((1.0 - start) / step, (2.0 - start) / step);
                from = from.max(s.min(t));
                to = to.min(s.max(t));
            }
        }
        if from > to {
            continue;
        }
        let (start, end) =
            (if from > 0.0 { a + along * from } else { a }, if to < 1.0 { a + along * to } else { b });
        match runs.last_mut() {
            Some(run) if run.last() == Some(&start) => run.push(end),
            _ => runs.push(vec![start, end]),
        }
    }
    runs.retain(|run| polyline_length(run) > 0.0);
    runs
}

/// Returns the edge length, enlarged until the resulting number of points is within the limit. The lattice fills a box
/// of 1 x 1.
fn affordable(margin: &[DVec2], veins: &[Vec<DVec2>], edge: f64) -> f64 {
    let lines = 2.0 * (polyline_length(margin) + veins.iter().map(|v| polyline_length(v)).sum::<f64>());
    // 1.5e-3: half a million lattice points in the box. From there the loop ends soon; from an edge so small that it is
    // 0 here it never would.
    let mut edge = edge.max(1.5e-3);
    while signed_area(margin) / (0.75 * edge * edge) + lines / edge > MAX_POINTS {
        edge *= 1.2;
    }
    edge
}

fn triangulate_unit(
    margin: &[DVec2],
    veins: &[Vec<DVec2>],
    edge: f64,
) -> Result<Triangulation, TriangulateError> {
    let mut boundary = resampled_margin(margin, veins, edge);
    let mut step = edge;
    // Chords over a narrow lobe can cross: finer ones follow it better, and its own points always do.
    while boundary.len() < 3 || crossings_up_to(&boundary, 1) > 0 || signed_area(&boundary) <= 0.0 {
        step *= 0.5;
        boundary = if step < 0.1 * edge { margin.to_vec() } else { resampled_margin(margin, veins, step) };
        if step < 0.1 * edge {
            break;
        }
    }
    let count = boundary.len();
    let mut points = boundary;
    let vein_edges = add_veins(&mut points, count, veins, edge);
    let lattice = lattice_points(&points, count, &vein_edges, edge);
    points.extend(lattice);
    join(points, count, &vein_edges)
}

/// Resamples the margin in steps of about `edge`, with its corners and the ends of veins kept.
fn resampled_margin(margin: &[DVec2], veins: &[Vec<DVec2>], edge: f64) -> Vec<DVec2> {
    let n = margin.len();
    let mut at = Vec::with_capacity(n + 1); // arc length of each corner
    at.push(0.0);
    for i in 0..n {
        at.push(at[i] + Vector::distance(margin[i], margin[(i + 1) % n]));
    }
    let total = at[n];
    let mut stops = corner_stops(margin, &at, edge);
    let mut closed = margin.to_vec();
    closed.push(margin[0]);
    for end in veins.iter().flat_map(|v| [v.first(), v.last()]).flatten() {
        if let Some(c) = closest_on_polyline(&closed, *end).filter(|c| c.distance < 0.5 * edge) {
            stops.push(Stop { at: if c.at >= total { 0.0 } else { c.at }, rank: 10.0 });
        }
    }
    let stops = spaced(stops, total, CORNER_GAP * edge);
    let gaps = stops.len().max(1);
    // Fewer than four points do not represent a blade, but three corners are a triangle.
    let fewest = [4, 4, 2][gaps.min(2)] * usize::from(gaps < 3);
    let mut out = vec![];
    for k in 0..gaps {
        let from = stops.get(k).map_or(0.0, |s| s.at);
        let to = if k + 1 < gaps { stops[k + 1].at } else { stops.first().map_or(0.0, |s| s.at) + total };
        let pieces = to_index(((to - from) / edge).round(), 100_000).max(fewest).max(1);
        for j in 0..pieces {
            let here = from + (to - from) * (j as f64 / pieces as f64);
            out.push(place(&closed, &at, if here >= total { here - total } else { here }));
        }
    }
    distinct_closed(&out)
}

/// Returns the point of a closed line at an arc length, by the arc lengths of its corners.
fn place(closed: &[DVec2], at: &[f64], here: f64) -> DVec2 {
    let k = at.partition_point(|&a| a <= here).clamp(1, closed.len() - 1);
    let length = at[k] - at[k - 1];
    let t = if length > 0.0 { ((here - at[k - 1]) / length).clamp(0.0, 1.0) } else { 0.0 };
    if t >= 1.0 { closed[k] } else { closed[k - 1] + (closed[k] - closed[k - 1]) * t }
}

/// A point of the margin that must be kept, by arc length.
#[derive(Clone, Copy)]
struct Stop {
    at: f64,
    /// Rank: of two that are too close the higher one stays.
    rank: f64,
}

/// Finds the sharp corners of the margin: turns of single corners, and of dense lines within half an edge.
fn corner_stops(margin: &[DVec2], at: &[f64], edge: f64) -> Vec<Stop> {
    let n = margin.len();
    let total = at[n];
    let reach = (0.5 * edge).min(0.2 * total);
    let sharp = 1.0 - ops::cos(SHARP);
    // Arc length of a corner continued over the seam, round after round.
    let along = |k: usize| at[k % n] + (k / n) as f64 * total;
    let mut stops = vec![];
    // In the second round there are corners before and after. The window extends to the farthest corners within reach,
    // at least the next ones: for a sparse polygon it is its own two sides.
    let (mut behind, mut ahead) = (0, 0);
    for i in n..2 * n {
        let here = along(i);
        while behind + 1 < i && here - along(behind) > reach {
            behind += 1;
        }
        ahead = ahead.max(i + 1);
        while along(ahead + 1) - here <= reach {
            ahead += 1;
        }
        let corner = |back: usize, next: usize| {
            let p = margin[i % n];
            bend(p - margin[back % n], margin[next % n] - p)
        };
        let (own, wide) = (corner(i - 1, i + 1), corner(behind, ahead));
        if own > sharp || wide > sharp {
            // The turn over the window distinguishes a tip from a tremor; a corner's own turn decides between equals.
            stops.push(Stop { at: at[i - n], rank: wide + 0.1 * own });
        }
    }
    stops
}

/// Returns one minus the cosine of the angle between two directions: grows with the turn, from 0 to 2.
fn bend(a: DVec2, b: DVec2) -> f64 {
    let lengths = (a.length_squared() * b.length_squared()).sqrt();
    if lengths > 0.0 { 1.0 - a.dot(b) / lengths } else { 0.0 }
}

/// Returns stops in order, at least `gap` apart (over the seam too), the higher ranks kept.
fn spaced(mut stops: Vec<Stop>, total: f64, gap: f64) -> Vec<Stop> {
    base::sort_by(&mut stops, |a, b| a.at.total_cmp(&b.at).then(b.rank.total_cmp(&a.rank)));
    let mut kept: Vec<Stop> = Vec::with_capacity(stops.len());
    for stop in stops {
        match kept.last_mut() {
            Some(last) if stop.at - last.at < gap => {
                if stop.rank > last.rank {
                    *last = stop;
                }
            }
            _ => kept.push(stop),
        }
    }
    while let [first, .., last] = kept[..] {
        if first.at + total - last.at >= gap {
            break;
        }
        if first.rank >= last.rank {
            kept.pop();
        } else {
            kept.remove(0);
        }
    }
    kept
}

/// Appends the veins' points inside the margin (the first `count` points) and returns their edges.
fn add_veins(points: &mut Vec<DVec2>, count: usize, veins: &[Vec<DVec2>], edge: f64) -> Vec<[usize; 2]> {
    let margin = points[..count].to_vec();
    let mut closed = margin.clone();
    closed.push(margin[0]);
    let mut edges = vec![];
    for vein in veins {
        let line = distinct(&resample(vein, edge));
        let last = line.len().saturating_sub(1);
        let mut before: Option<usize> = None;
        for (k, &p) in line.iter().enumerate() {
            let here = vein_point(points, &margin, &closed, p, k == 0 || k == last, edge);
            if let (Some(a), Some(b)) = (before, here)
                && a != b
                && !(a < count && b < count)
            {
                edges.push([a, b]);
            }
            before = here;
        }
    }
    base::sort_by(&mut edges, Ord::cmp);
    edges.dedup();
    edges
}

/// Returns the index of a vein's point: of the margin (ends only), of a vein close by, or new; `None` outside.
fn vein_point(
    points: &mut Vec<DVec2>,
    margin: &[DVec2],
    closed: &[DVec2],
    p: DVec2,
    is_end: bool,
    edge: f64,
) -> Option<usize> {
    let nearest = |candidates: &[DVec2]| {
        (0..candidates.len())
            .map(|i| (candidates[i].distance_squared(p), i))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
    };
    let near = |limit: f64| move |&(d, _): &(f64, usize)| d < limit * limit * edge * edge;
    if is_end && let Some((_, i)) = nearest(margin).filter(near(0.5)) {
        return Some(i);
    }
    let clear = JOIN * JOIN * edge * edge;
    let too_close = |pair: &[DVec2]| nearest_on_segment(pair[0], pair[1], p).1.distance_squared(p) < clear;
    if closed.windows(2).any(too_close) || !contains(margin, p) {
        return None;
    }
    let first = margin.len();
    if let Some((_, i)) = nearest(&points[first..]).filter(near(JOIN)) {
        return Some(first + i);
    }
    points.push(p);
    Some(points.len() - 1)
}

/// Returns the points of a hexagonal lattice inside the margin and clear of it and of the veins.
///
/// The crossings of each row with the margin give its inside, and each line removes the lattice points close to it, so
/// the cost is linear.
fn lattice_points(points: &[DVec2], count: usize, vein_edges: &[[usize; 2]], edge: f64) -> Vec<DVec2> {
    let row_step = edge * 0.75_f64.sqrt();
    let (mut lo, mut hi) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for &p in &points[..count] {
        (lo, hi) = (lo.min(p), hi.max(p));
    }
    // Columns stand symmetrically about the middle, so that a symmetrical leaf gets a symmetrical lattice.
    let half_columns = ((hi.x - lo.x) * 0.5 / edge).ceil() + 1.0;
    let left = (lo.x + hi.x) * 0.5 - half_columns * edge;
    let columns = to_index(2.0 * half_columns + 1.0, 100_000);
    let rows = to_index(((hi.y - lo.y) / row_step).floor(), 100_000) + 1;
    let bottom = lo.y + 0.5 * ((hi.y - lo.y) - row_step * (rows - 1) as f64);
    let shift = |row: usize| if row % 2 == 1 { 0.5 * edge } else { 0.0 };
    let at = |row: usize, column: usize| {
        DVec2::new(left + shift(row) + column as f64 * edge, bottom + row as f64 * row_step)
    };
    let mut crossings: Vec<Vec<f64>> = vec![vec![]; rows];
    let mut struck = vec![false; rows * columns];
    let clear = CLEAR * edge;
    let margin_edges = (0..count).map(|i| [i, (i + 1) % count]);
    for (k, [a, b]) in margin_edges.chain(vein_edges.iter().copied()).enumerate() {
        let (a, b) = (points[a], points[b]);
        let row_of = |y: f64| to_index((y - bottom) / row_step, rows);
        let (low, high) = (a.min(b), a.max(b));
        for row in row_of(low.y - clear)..(row_of(high.y + clear) + 1).min(rows) {
            let y = at(row, 0).y;
            if k < count && (a.y > y) != (b.y > y) {
                crossings[row].push(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
            }
            let column_of = |x: f64| to_index((x - left - shift(row)) / edge, columns);
            for column in column_of(low.x - clear)..(column_of(high.x + clear) + 1).min(columns) {
                let p = at(row, column);
                let (_, q) = nearest_on_segment(a, b, p);
                struck[row * columns + column] |= p.distance_squared(q) < clear * clear;
            }
        }
    }
    let mut out = vec![];
    for (row, xs) in crossings.iter_mut().enumerate() {
        base::sort_numbers(xs);
        for column in (0..columns).filter(|c| !struck[row * columns + c]) {
            let p = at(row, column);
            if xs.partition_point(|&x| x < p.x) % 2 == 1 {
                // Slightly off the lattice: six points on one circle would need exact arithmetic everywhere.
                let k = out.len() as f64;
                let off = DVec2::new(0.754_877_666 * k, 0.569_840_290 * k).fract() - 0.5;
                out.push(p + off * (1e-3 * edge));
            }
        }
    }
    out
}

/// Joins the points; the first `count` are the margin in order.
fn join(
    points: Vec<DVec2>,
    count: usize,
    vein_edges: &[[usize; 2]],
) -> Result<Triangulation, TriangulateError> {
    let fault = TriangulateError::Internal { points: count };
    let vertices: Vec<Point2<f64>> = points.iter().map(|p| Point2::new(p.x, p.y)).collect();
    // Without the margin first: loading is a third faster, and most of the margin's edges result without constraints.
    let mut net =
        ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(vertices, vec![], |_| {})
            .map_err(|_unusable_coordinate| fault)?;
    if net.num_vertices() != points.len() {
        return Err(fault);
    }
    let handle = spade::handles::FixedVertexHandle::from_index;
    for i in 0..count {
        if net.try_add_constraint(handle(i), handle((i + 1) % count)).is_empty() {
            return Err(fault);
        }
    }
    for &[a, b] in vein_edges {
        // A vein that crosses an earlier one (or the margin) is left out there, not split.
        net.try_add_constraint(handle(a), handle(b));
    }
    let index = |i: usize| u32::try_from(i).unwrap_or(u32::MAX); // at most about 20 000 points
    let triangles = net
        .inner_faces()
        .map(|face| face.vertices().map(|v| v.fix().index()))
        .filter(|&corners| is_inside(corners, count))
        .map(|corners| corners.map(index))
        .collect();
    Ok(Triangulation { points, triangles, boundary: (0..index(count)).collect() })
}

/// Whether a counter-clockwise triangle of the constrained triangulation lies inside the margin.
///
/// A triangle with an inner point does, since no edge crosses the margin. One with all corners on the margin meets them
/// in the margin's own order if it lies inside, and in the opposite order in a bay outside.
fn is_inside([a, b, c]: [usize; 3], count: usize) -> bool {
    let has_inner = a >= count || b >= count || c >= count;
    // For three numbers in cyclic order two of the steps go up; in the opposite order one does.
    has_inner || [a < b, b < c, c < a].into_iter().filter(|&up| up).count() == 2
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn p(x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y)
    }

    /// Returns a lens-shaped leaf with its root at the origin and its tip at (0, 1).
    fn leaf(n: u32, wave: f64) -> Vec<DVec2> {
        let side = |t: f64, s: f64| {
            p(s * (0.3 * ops::sin(ops::PI * t) + wave * ops::sin(40.0 * t) * t * (1.0 - t)), t)
        };
        let t = |i: u32| f64::from(i) / f64::from(n);
        (0..n).map(|i| side(t(i), 1.0)).chain((1..=n).rev().map(|i| side(t(i), -1.0))).collect()
    }

    /// Checks the invariants of a triangulation.
    fn check(t: &Triangulation) {
        let at = |i: u32| t.points[i as usize];
        let mut sides = vec![];
        let (mut sum, mut used) = (0.0, vec![false; t.points.len()]);
        for &[a, b, c] in &t.triangles {
            let area = signed_area(&[at(a), at(b), at(c)]);
            assert!(area > 0.0, "counter-clockwise");
            sum += area;
            sides.extend([[a, b], [b, c], [c, a]]);
            [a, b, c].iter().for_each(|&i| used[i as usize] = true);
        }
        let margin: Vec<DVec2> = t.boundary.iter().map(|&i| at(i)).collect();
        let area = signed_area(&margin);
        assert!((sum - area).abs() < 1e-9 * area, "{sum} {area}");
        assert!(used.iter().all(|&u| u), "every point is a corner");
        assert_eq!(self_crossings_of(&margin), 0);
        sides.sort_unstable();
        let all = sides.len();
        sides.dedup();
        assert_eq!(sides.len(), all, "no side twice in one direction");
        // A side without its reverse belongs to the margin, and vice versa.
        let single = sides.iter().filter(|&&[a, b]| sides.binary_search(&[b, a]).is_err()).count();
        assert_eq!(single, t.boundary.len());
        for (k, &a) in t.boundary.iter().enumerate() {
            let b = t.boundary[(k + 1) % t.boundary.len()];
            assert!(sides.binary_search(&[a, b]).is_ok(), "margin edge {a} {b}");
        }
    }

    fn self_crossings_of(margin: &[DVec2]) -> usize {
        crossings_up_to(margin, usize::MAX)
    }

    fn has_point(t: &Triangulation, q: DVec2) -> bool {
        t.points.iter().any(|&r| (r - q).length() < 1e-12)
    }

    #[test]
    fn a_square_is_filled() {
        let square = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
        let t = triangulate_blade(&square, &[], 0.1).unwrap();
        check(&t);
        assert_eq!(t.boundary.len(), 40);
        // Equilateral triangles of edge 0.1 would be 231.
        assert!((180..300).contains(&t.triangles.len()), "{}", t.triangles.len());
        assert!(square.iter().all(|&q| has_point(&t, q)), "corners are kept");
    }

    #[test]
    fn root_tip_and_midrib_are_edges() {
        let midrib = [p(0.0, 0.0), p(0.0, 1.0)];
        let t = triangulate_blade(&leaf(150, 0.0), &[&midrib], 0.05).unwrap();
        check(&t);
        assert!(has_point(&t, p(0.0, 0.0)) && has_point(&t, p(0.0, 1.0)), "root and tip");
        let on_rib = |i: u32| t.points[i as usize].x.abs() < 1e-12;
        let rib_sides: f64 = t
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .filter(|&[a, b]| on_rib(a) && on_rib(b))
            .map(|[a, b]| (t.points[a as usize] - t.points[b as usize]).length())
            .sum();
        assert!((rib_sides - 2.0).abs() < 1e-9, "the whole rib, from both sides: {rib_sides}");
    }

    #[test]
    fn teeth_are_kept() {
        // Ten teeth on the right side of a strip.
        let mut saw = vec![p(0.0, 1.0), p(0.0, 0.0)];
        for k in 0..10 {
            saw.push(p(0.3, 0.1 * f64::from(k)));
            saw.push(p(0.36, 0.1 * f64::from(k) + 0.08));
        }
        let t = triangulate_blade(&saw, &[], 0.08).unwrap();
        check(&t);
        assert!(saw.iter().all(|&q| has_point(&t, q)), "{:?}", t.boundary.len());
    }

    #[test]
    fn bays_stay_empty() {
        // A ring with a gap: most of its hull is outside.
        let arc = |r: f64, back: bool| {
            (0..=100)
                .map(move |i| 0.3 + 5.6 * f64::from(if back { 100 - i } else { i }) / 100.0)
                .map(move |a| base::turn::direction(a) * r)
        };
        let ring: Vec<DVec2> = arc(1.0, false).chain(arc(0.7, true)).collect();
        let along: Vec<DVec2> = arc(0.85, false).collect();
        let across = [p(-2.0, 0.1), p(2.0, 0.1)];
        let t = triangulate_blade(&ring, &[&along, &across], 0.07).unwrap();
        check(&t);
    }

    #[test]
    fn side_veins_join_the_midrib() {
        let midrib = [p(0.0, 0.0), p(0.0, 1.0)];
        let side = [p(0.0, 0.4), p(0.4, 0.7)];
        let bare = triangulate_blade(&leaf(150, 0.0), &[&midrib], 0.05).unwrap();
        let veined = triangulate_blade(&leaf(150, 0.0), &[&midrib, &side, &side], 0.05).unwrap();
        check(&veined);
        let on_side = |t: &Triangulation| {
            t.points.iter().filter(|q| q.x > 0.01 && (q.y - 0.4 - 0.75 * q.x).abs() < 1e-9).count()
        };
        assert!(on_side(&veined) >= 4 && on_side(&bare) < on_side(&veined), "{}", on_side(&veined));
    }

    #[test]
    fn a_crossed_outline_becomes_simple() {
        let mut drawn = leaf(100, 0.0);
        drawn.push(p(0.05, 0.05));
        drawn.push(p(0.2, -0.02));
        let t = triangulate_blade(&drawn, &[], 0.05).unwrap();
        check(&t);
    }

    #[test]
    fn sizes_do_not_matter() {
        let vanishing = triangulate_blade(&[p(0.0, 0.0), p(1e90, 0.0), p(0.0, 1e90)], &[], 5e-324);
        assert!(vanishing.is_ok(), "an edge of no size beside the blade is enlarged");
        for scale in [1e-90, 1e-9, 1.0, 1e80] {
            let big: Vec<DVec2> = leaf(80, 0.02).iter().map(|&q| q * scale).collect();
            let t = triangulate_blade(&big, &[&[p(0.0, 0.0), p(0.0, scale)]], 0.06 * scale).unwrap();
            assert!(t.triangles.len() > 100, "{scale} {}", t.triangles.len());
        }
    }

    #[test]
    fn few_triangles_where_the_edge_is_long() {
        let t = triangulate_blade(&leaf(100, 0.0), &[&[p(0.0, 0.0), p(0.0, 1.0)]], 10.0).unwrap();
        check(&t);
        assert!(t.triangles.len() <= 4 && has_point(&t, p(0.0, 1.0)), "{t:?}");
    }

    #[test]
    fn a_tiny_edge_is_enlarged() {
        let t = triangulate_blade(&leaf(100, 0.0), &[], 1e-9).unwrap();
        check(&t);
        assert!(t.points.len() > 5_000 && t.points.len() < 21_000, "{}", t.points.len());
    }

    #[test]
    fn bad_input_is_an_error() {
        let square = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
        for edge in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(triangulate_blade(&square, &[], edge), Err(TriangulateError::BadEdge { .. })));
        }
        for none in [&square[..2], &[], &[p(0.0, 0.0), p(1.0, 1.0), p(2.0, 2.0)], &[DVec2::NAN; 5]] {
            assert!(matches!(triangulate_blade(none, &[], 0.1), Err(TriangulateError::NoArea { .. })));
        }
    }

    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![
            8 => (-4..4_i32).prop_map(|i| f64::from(i) * 0.5),
            8 => -2.0..2.0,
            2 => (-4..4_i32, -1.0..1.0).prop_map(|(i, e)| f64::from(i) * 0.5 + e * 1e-9),
            1 => prop::sample::select(vec![f64::NAN, f64::INFINITY, 1e300, 1e90, 1e-300]),
        ]
    }

    fn line(most: usize) -> impl Strategy<Value = Vec<DVec2>> {
        prop::collection::vec((coordinate(), coordinate()).prop_map(|(x, y)| p(x, y)), 0..most)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]
        #[test]
        fn any_scribble_gives_a_sound_triangulation_or_no_area(
            outline in line(30), first in line(6), second in line(6), edge in 0.05..3.0,
        ) {
            match triangulate_blade(&outline, &[&first, &second], edge) {
                Ok(t) => check(&t),
                Err(e) => prop_assert!(matches!(e, TriangulateError::NoArea { .. }), "{e}"),
            }
        }

        #[test]
        fn star_shaped_leaves_with_veins(
            radii in prop::collection::vec(0.2..1.0, 5..60), edge in 0.03..0.5, turn in 0.0..6.0,
        ) {
            let n = radii.len() as f64;
            let outline: Vec<DVec2> = radii
                .iter()
                .enumerate()
                .map(|(k, r)| base::turn::direction(ops::TAU * k as f64 / n) * *r)
                .collect();
            let vein = [base::turn::direction(turn) * 2.0, base::turn::direction(turn + 2.5) * 2.0];
            check(&triangulate_blade(&outline, &[&vein, &[DVec2::ZERO, vein[0]]], edge).unwrap());
        }
    }
}
