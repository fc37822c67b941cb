//! Outlines of point sets that follow their bays, and triangulations within an outline.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

use crate::polygon::signed_area;
use crate::vector::Vector as _;

/// The triangles between points, from which outlines of any radius are made.
///
/// ```
/// use glam::dvec2;
/// // Seven by seven points, without three columns of four: a bay.
/// let places = (0..49).map(|k| (k % 7, k / 7)).filter(|&(x, y)| y < 3 || x < 2 || x > 4);
/// let points: Vec<_> = places.map(|(x, y)| dvec2(f64::from(x), f64::from(y))).collect();
/// let shape = geom::AlphaShape::new(&points);
/// let area = |radius| {
///     let line = shape.outline(radius).expect("one piece").points;
///     geom::signed_area(&line.iter().map(|&k| points[k]).collect::<Vec<_>>())
/// };
/// // The corners of the bay are filled by half a square each.
/// assert_eq!((area(0.8), area(100.0)), (36.0 - 16.0 + 1.0, 36.0));
/// assert!(shape.outline(0.1).is_none());
/// ```
#[derive(Clone, Debug, Default)]
pub struct AlphaShape {
    points: Vec<DVec2>,
    /// Triangles, counter-clockwise, with the radius of the circle through their corners.
    triangles: Vec<([usize; 3], f64)>,
}

/// An outline of [`AlphaShape`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AlphaOutline {
    /// The points on it, counter-clockwise.
    pub points: Vec<usize>,
    /// The share of the area within it that no triangle covers.
    pub holes: f64,
}

impl AlphaShape {
    /// Builds the shape, ignoring unusable points. Cost: n log n.
    pub fn new(points: &[DVec2]) -> Self {
        let Some((net, index)) = net(points) else { return Self::default() };
        let circle = |[a, b, c]: [usize; 3]| {
            let (p, q, r) = (points[a], points[b], points[c]);
            let double = (q - p).perp_dot(r - p);
            p.distance(q) * q.distance(r) * r.distance(p) / (2.0 * double).max(f64::MIN_POSITIVE)
        };
        let of = |t: [usize; 3]| (t, circle(t));
        let triangles = net.inner_faces().map(|f| of(f.vertices().map(|v| index[v.fix().index()])));
        Self { points: points.to_vec(), triangles: triangles.collect() }
    }

    /// Returns the outline of the largest piece of the area covered by triangles whose circumcircles have at most
    /// `radius` (Edelsbrunner, Kirkpatrick and Seidel 1983). It does not touch itself: parts attached at one point only
    /// are left out. `None` if nothing is covered.
    pub fn outline(&self, radius: f64) -> Option<AlphaOutline> {
        let kept = || self.triangles.iter().filter(|t| t.1 <= radius).map(|t| t.0);
        let sides: BTreeSet<[usize; 2]> = kept().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        let mut leaving: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for &[a, b] in sides.iter().filter(|&&[a, b]| !sides.contains(&[b, a])) {
            leaving.entry(a).or_default().push(b);
        }
        let mut best: (f64, Vec<usize>) = (0.0, Vec::new());
        while let Some((&start, _)) = leaving.iter().next() {
            let mut line = vec![start];
            let mut at = start;
            while let Some(ends) = leaving.get_mut(&at) {
                // Where pieces touch, the sharpest turn to the left stays on the piece.
                let along = line.len().checked_sub(2).map(|k| self.points[at] - self.points[line[k]]);
                let turn = |&to: &usize| {
                    let next = self.points[to] - self.points[at];
                    along.map_or(0.0, |along| base::ops::atan2(along.perp_dot(next), along.dot(next)))
                };
                let left = (0..ends.len()).max_by(|&a, &b| turn(&ends[a]).total_cmp(&turn(&ends[b])))?;
                let next = ends.remove(left);
                if ends.is_empty() {
                    leaving.remove(&at);
                }
                at = next;
                if let Some(seen) = line.iter().position(|&k| k == at) {
                    // A closed loop ends here; the part before it continues.
                    let round = line.split_off(seen);
                    let corners: Vec<DVec2> = round.iter().map(|&k| self.points[k]).collect();
                    let area = signed_area(&corners);
                    if area > best.0 {
                        best = (area, round);
                    }
                }
                line.push(at);
            }
        }
        let (area, points) = best;
        let corners: Vec<DVec2> = points.iter().map(|&k| self.points[k]).collect();
        (points.len() >= 3).then(|| {
            let inside = |[a, b, c]: &[usize; 3]| {
                let middle = (self.points[*a] + self.points[*b] + self.points[*c]) / 3.0;
                crate::polygon::contains(&corners, middle)
            };
            let size = |t: [usize; 3]| signed_area(&t.map(|k| self.points[k]));
            let covered: f64 = kept().filter(inside).map(size).sum();
            AlphaOutline { points, holes: (1.0 - covered / area).max(0.0) }
        })
    }
}

/// Triangulates `inner` points within an outline, counter-clockwise; corner indices count the outline first.
///
/// `lines` are pairs of inner points that are joined if nothing is in the way. Points outside are not corners of any
/// triangle. Guaranteed: the triangles cover the outline exactly. `None` for an outline that crosses itself or has no
/// area.
///
/// ```
/// use glam::DVec2;
/// let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
/// let triangles = geom::triangulate_within(&square, &[DVec2::splat(0.5), DVec2::splat(2.0)], &[]);
/// assert_eq!(triangles.expect("a square").len(), 4);
/// ```
pub fn triangulate_within(
    outline: &[DVec2],
    inner: &[DVec2],
    lines: &[[usize; 2]],
) -> Option<Vec<[usize; 3]>> {
    let n = outline.len();
    if n < 3 || crate::outline::self_crossings(outline) > 0 {
        return None;
    }
    let points: Vec<DVec2> = outline.iter().chain(inner).copied().collect();
    let (mut net, index) = net(&points)?;
    let mut place = vec![None; points.len()];
    for (k, &i) in index.iter().enumerate() {
        place[i] = Some(spade::handles::FixedVertexHandle::from_index(k));
    }
    let mut sides = BTreeSet::new();
    for i in 0..n {
        let (a, b) = (place[i]?, place[(i + 1) % n]?);
        let made = net.try_add_constraint(a, b);
        if made.is_empty() {
            return None;
        }
        // A point on a side splits it.
        for side in made.into_iter().map(|e| net.directed_edge(e)) {
            sides.insert([side.from(), side.to()].map(|v| index[v.fix().index()]));
        }
    }
    for &[a, b] in lines {
        if let (Some(Some(a)), Some(Some(b))) = (place.get(n + a), place.get(n + b))
            && a != b
        {
            net.try_add_constraint(*a, *b);
        }
    }
    let faces: Vec<[usize; 3]> =
        net.inner_faces().map(|f| f.vertices().map(|v| index[v.fix().index()])).collect();
    let around = |t: [usize; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let mut beside: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for (k, &t) in faces.iter().enumerate() {
        beside.extend(around(t).map(|side| (side, k)));
    }
    // Inside lies to the left of a counter-clockwise outline; from there on everything up to its sides.
    let inwards = signed_area(outline) > 0.0;
    let of = |[a, b]: [usize; 2]| if inwards { [a, b] } else { [b, a] };
    let mut taken = vec![false; faces.len()];
    let mut open: Vec<usize> = sides.iter().filter_map(|&side| beside.get(&of(side)).copied()).collect();
    while let Some(k) = open.pop() {
        if core::mem::replace(&mut taken[k], true) {
            continue;
        }
        for [a, b] in around(faces[k]) {
            if !sides.contains(&[a, b]) && !sides.contains(&[b, a]) {
                open.extend(beside.get(&[b, a]));
            }
        }
    }
    let inside = faces.into_iter().zip(taken).filter(|(_, taken)| *taken).map(|(t, _)| t);
    Some(inside.collect())
}

/// Returns the triangulation of usable points without repetitions, and the index of the point at each of its corners.
fn net(points: &[DVec2]) -> Option<(ConstrainedDelaunayTriangulation<Point2<f64>>, Vec<usize>)> {
    let usable = || points.iter().copied().filter(|p| p.usable());
    let lo = usable().fold(DVec2::INFINITY, DVec2::min);
    let size = (usable().fold(DVec2::NEG_INFINITY, DVec2::max) - lo).max_element();
    if !(size > 0.0 && (1.0 / size).is_finite()) {
        return None;
    }
    let mut index = Vec::with_capacity(points.len());
    let mut corners = Vec::with_capacity(points.len());
    let mut seen = BTreeSet::new();
    for (k, p) in points.iter().enumerate().filter(|(_, p)| p.usable()) {
        // From 1 to 2: there no number is too small for exact predicates.
        let p = (*p - lo) / size + DVec2::ONE;
        if seen.insert([p.x.to_bits(), p.y.to_bits()]) {
            index.push(k);
            corners.push(Point2::new(p.x, p.y));
        }
    }
    let net = ConstrainedDelaunayTriangulation::try_bulk_load_cdt(corners, vec![], |_| {}).ok()?;
    (net.num_vertices() == index.len()).then_some((net, index))
}
