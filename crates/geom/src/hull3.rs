//! The convex hull of points in space.

use base::LiteMap;

use crate::vector::Vector;
use glam::DVec3;

/// The smallest convex body around points, as a closed surface of triangles.
///
/// ```
/// use glam::DVec3;
/// let corners: Vec<DVec3> =
///     (0..8_u8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect();
/// let hull = geom::convex_hull3(&corners).ok_or("flat")?;
/// assert!((hull.volume() - 1.0).abs() < 1e-12 && (hull.area() - 6.0).abs() < 1e-12);
/// let inside = |p: DVec3| hull.planes().iter().all(|(normal, distance)| normal.dot(p) <= *distance);
/// assert!(inside(DVec3::splat(0.5)) && !inside(DVec3::new(0.5, 0.5, 1.1)));
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Hull3 {
    /// The corners, in the order in which they were given.
    pub points: Vec<DVec3>,
    /// Triangles as indices into `points`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Hull3 {
    fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        self.triangles.iter().map(|t| t.map(|i| self.points[i as usize]))
    }

    /// Returns the volume inside, cubic metres for points in metres.
    pub fn volume(&self) -> f64 {
        // Relative to a corner, so that a hull far from the origin loses no digits.
        let o = self.points.first().copied().unwrap_or_default();
        self.corners().map(|[a, b, c]| (a - o).dot((b - o).cross(c - o))).sum::<f64>() / 6.0
    }

    /// Returns the planes of its faces as unit normals that point outwards and distances from the origin along them: a
    /// point is inside if `normal.dot(point) <= distance` for all. Faces without area are left out.
    pub fn planes(&self) -> Vec<(DVec3, f64)> {
        self.corners().map(plane).filter(|(normal, _)| *normal != DVec3::ZERO).collect()
    }

    /// Returns the area of the surface.
    pub fn area(&self) -> f64 {
        self.corners().map(|[a, b, c]| (b - a).cross(c - a).length()).sum::<f64>() / 2.0
    }
}

/// Returns the convex hull of `points`; `None` if they lie in one plane (within 1e-9 of their extent) or are fewer than
/// 4.
///
/// Unusable points are left out. Guaranteed: a closed surface; no point lies outside it by more than about 1e-9 of the
/// extent; the same bits everywhere. Not guaranteed: that corners nearer than that to the surface are kept. Cost:
/// usually n log n, n times the corners at worst. Barber, Dobkin and Huhdanpaa 1996 (quickhull).
pub fn convex_hull3(points: &[DVec3]) -> Option<Hull3> {
    let points: Vec<DVec3> = points.iter().copied().filter(|p| p.usable()).collect();
    let first = simplex(&points)?;
    let mut hull = Quickhull::new(&points, first);
    while let Some(face) = hull.waiting.pop() {
        if hull.faces[face].alive {
            hull.grow(face);
        }
    }
    Some(hull.finish())
}

/// Returns the unit normal of a triangle, zero without area, and its distance from the origin along it.
fn plane([a, b, c]: [DVec3; 3]) -> (DVec3, f64) {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    // From the centroid, not a corner: long thin faces are tilted less by rounding.
    (normal, normal.dot((a + b + c) / 3.0))
}

const NONE: usize = usize::MAX;

#[derive(Clone, Debug)]
struct Face {
    corner: [usize; 3],
    /// The neighbouring face across the edge from corner i to corner i + 1.
    across: [usize; 3],
    normal: DVec3,
    offset: f64,
    /// Points beyond this face, the farthest last.
    outside: Vec<usize>,
    farthest: f64,
    alive: bool,
}

struct Quickhull<'a> {
    points: &'a [DVec3],
    faces: Vec<Face>,
    waiting: Vec<usize>,
    eps: f64,
    visible: Vec<usize>,
    seen: Vec<u32>,
    round: u32,
}

/// Returns four points that span a body, and the size of the cloud.
fn simplex(points: &[DVec3]) -> Option<([usize; 4], f64)> {
    let first = *points.first()?;
    let (mut lo, mut hi) = (first, first);
    for &p in points {
        (lo, hi) = (lo.min(p), hi.max(p));
    }
    let size = (hi - lo).max_element();
    let eps = 1e-9 * size;
    let best = |score: &dyn Fn(DVec3) -> f64| {
        let all = points.iter().enumerate().map(|(i, &p)| (i, score(p)));
        all.fold((0, f64::NEG_INFINITY), |best, now| if now.1 > best.1 { now } else { best })
    };
    let axis = if hi.x - lo.x >= size {
        DVec3::X
    } else if hi.y - lo.y >= size {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let a = best(&|p| -p.dot(axis)).0;
    let (b, far) = best(&|p| p.distance(points[a]));
    if far <= eps {
        return None;
    }
    let along = (points[b] - points[a]) / far;
    let (c, far) = best(&|p| (p - points[a]).reject_from_normalized(along).length());
    if far <= eps {
        return None;
    }
    let normal = along.cross(points[c] - points[a]).normalize_or_zero();
    let (d, far) = best(&|p| (p - points[a]).dot(normal).abs());
    if far <= eps {
        return None;
    }
    let above = (points[d] - points[a]).dot(normal) > 0.0;
    Some((if above { [a, c, b, d] } else { [a, b, c, d] }, size))
}

impl<'a> Quickhull<'a> {
    /// Starts with a tetrahedron: the fourth of `corners` lies below the first three, seen counter-clockwise.
    fn new(points: &'a [DVec3], (corners, size): ([usize; 4], f64)) -> Self {
        let [a, b, c, d] = corners;
        let mut hull = Self {
            points,
            faces: Vec::new(),
            waiting: Vec::new(),
            eps: 1e-9 * size,
            visible: Vec::new(),
            seen: Vec::new(),
            round: 0,
        };
        hull.add([a, b, c], [1, 2, 3]);
        hull.add([b, a, d], [0, 3, 2]);
        hull.add([c, b, d], [0, 1, 3]);
        hull.add([a, c, d], [0, 2, 1]);
        hull.assign((0..points.len()).filter(|i| !corners.contains(i)), 0);
        hull
    }

    fn add(&mut self, corner: [usize; 3], across: [usize; 3]) {
        let (normal, offset) = plane(corner.map(|i| self.points[i]));
        let (outside, farthest, alive) = (Vec::new(), 0.0, true);
        self.faces.push(Face { corner, across, normal, offset, outside, farthest, alive });
        self.seen.push(0);
    }

    fn above(&self, face: usize, p: DVec3) -> f64 {
        self.faces[face].normal.dot(p) - self.faces[face].offset
    }

    /// Gives each point to the first face, from `from` on, that it lies beyond.
    fn assign(&mut self, points: impl Iterator<Item = usize>, from: usize) {
        for i in points {
            let p = self.points[i];
            let Some((face, above)) =
                (from..self.faces.len()).map(|f| (f, self.above(f, p))).find(|(_, above)| *above > self.eps)
            else {
                continue;
            };
            let face = &mut self.faces[face];
            face.outside.push(i);
            if above > face.farthest {
                face.farthest = above;
            } else {
                let last = face.outside.len() - 1;
                if last > 0 {
                    face.outside.swap(last - 1, last);
                }
            }
        }
        self.waiting.extend((from..self.faces.len()).filter(|&f| !self.faces[f].outside.is_empty()));
    }

    /// Adds the farthest point beyond a face.
    fn grow(&mut self, face: usize) {
        let Some(apex) = self.faces[face].outside.pop() else { return };
        let p = self.points[apex];
        let Some(horizon) = self.horizon(face, p) else {
            // By rounding the edges form no loop: the point is within rounding of the surface and left out.
            self.faces[face].farthest = 0.0;
            if !self.faces[face].outside.is_empty() {
                self.waiting.push(face);
            }
            return;
        };
        let first = self.faces.len();
        let n = horizon.len();
        for (k, &(a, b, beyond)) in horizon.iter().enumerate() {
            self.add([a, b, apex], [beyond, first + (k + 1) % n, first + (k + n - 1) % n]);
            let other = &mut self.faces[beyond];
            if let Some(side) = (0..3).find(|&s| other.corner[s] == b && other.corner[(s + 1) % 3] == a) {
                other.across[side] = first + k;
            }
        }
        let mut orphans = Vec::new();
        for &v in &self.visible {
            self.faces[v].alive = false;
            orphans.append(&mut self.faces[v].outside);
        }
        self.assign(orphans.into_iter(), first);
    }

    /// Returns the loop of edges between faces visible from `p` and others: `(from, to, face beyond)`,
    /// counter-clockwise.
    fn horizon(&mut self, from: usize, p: DVec3) -> Option<Vec<(usize, usize, usize)>> {
        self.round += 1;
        self.visible.clear();
        self.visible.push(from);
        self.seen[from] = self.round;
        let mut edges: LiteMap<usize, (usize, usize)> = LiteMap::new();
        let mut simple = true;
        let mut next = 0;
        while let Some(&face) = self.visible.get(next) {
            next += 1;
            for side in 0..3 {
                let beyond = self.faces[face].across[side];
                if self.seen[beyond] == self.round {
                    continue;
                }
                if self.above(beyond, p) > self.eps {
                    self.seen[beyond] = self.round;
                    self.visible.push(beyond);
                } else {
                    let [a, b] = [self.faces[face].corner[side], self.faces[face].corner[(side + 1) % 3]];
                    simple &= edges.insert(a, (b, beyond)).is_none();
                }
            }
        }
        let start = *edges.keys().next()?;
        let (mut at, mut ring) = (start, Vec::with_capacity(edges.len()));
        while let Some((to, beyond)) = edges.remove(&at) {
            ring.push((at, to, beyond));
            at = to;
        }
        (simple && at == start && edges.is_empty() && ring.len() >= 3).then_some(ring)
    }

    fn finish(self) -> Hull3 {
        let alive: Vec<[usize; 3]> = self.faces.iter().filter(|f| f.alive).map(|f| f.corner).collect();
        let mut row = vec![NONE; self.points.len()];
        alive.iter().flatten().for_each(|&i| row[i] = 0);
        let mut points = Vec::new();
        for (i, r) in row.iter_mut().enumerate().filter(|(_, r)| **r == 0) {
            *r = points.len();
            points.push(self.points[i]);
        }
        #[expect(clippy::cast_possible_truncation, reason = "a hull has far fewer corners than 2^32")]
        let triangles = alive.iter().map(|t| t.map(|i| row[i] as u32)).collect();
        Hull3 { points, triangles }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::{Draw, Seed, ops};
    use proptest::prelude::*;

    fn sound(hull: &Hull3, points: &[DVec3], size: f64) {
        let mut edges: Vec<(u32, u32)> =
            hull.triangles.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]).collect();
        edges.sort_unstable();
        assert!(edges.windows(2).all(|w| w[0] != w[1]), "an edge is used twice");
        assert!(edges.iter().all(|&(a, b)| edges.binary_search(&(b, a)).is_ok()), "the surface is open");
        // Euler: corners - edges + faces = 2.
        assert_eq!(hull.points.len() + hull.triangles.len(), edges.len() / 2 + 2);
        for [a, b, c] in hull.corners() {
            let n = (b - a).cross(c - a).normalize_or_zero();
            for p in points.iter().filter(|p| p.usable()) {
                assert!((*p - a).dot(n) < 1e-7 * size, "{p} lies outside");
            }
        }
    }

    #[test]
    fn ball_and_cone_have_their_volumes() {
        let mut stream = Seed::new(3).stream(Draw::Attractors);
        let ball: Vec<DVec3> = (0..20_000)
            .map(|_| DVec3::new(stream.normal(), stream.normal(), stream.normal()).normalize_or(DVec3::X))
            .collect();
        let hull = convex_hull3(&ball).expect("solid");
        sound(&hull, &ball[..200], 2.0);
        assert!((hull.volume() / (4.0 / 3.0 * ops::PI) - 1.0).abs() < 2e-3, "{}", hull.volume());
        assert!((hull.area() / (4.0 * ops::PI) - 1.0).abs() < 2e-3, "{}", hull.area());
        // A cone on a regular 360-gon, r = 2, h = 3, far from the origin: V = n/2 sin(2 pi/n) r^2 h / 3.
        let far = DVec3::new(1e4, -2e4, 3e4);
        let mut cone = vec![far + DVec3::Y * 3.0, far];
        cone.extend((0..360).map(|i| {
            let (s, c) = ops::sin_cos(f64::from(i) * ops::TAU / 360.0);
            far + DVec3::new(2.0 * c, 0.0, 2.0 * s)
        }));
        let expected = 180.0 * ops::sin(ops::TAU / 360.0) * 4.0;
        assert!((convex_hull3(&cone).expect("solid").volume() / expected - 1.0).abs() < 1e-7);
    }

    #[test]
    fn flat_few_and_bad_points_have_no_hull() {
        let flat: Vec<DVec3> = (0..50).map(|i| DVec3::new(f64::from(i % 7), 1.0, f64::from(i))).collect();
        assert_eq!(convex_hull3(&flat), None);
        assert_eq!(convex_hull3(&[]), None);
        assert_eq!(convex_hull3(&[DVec3::ONE; 100]), None);
        assert_eq!(convex_hull3(&[DVec3::X, DVec3::Y, DVec3::Z]), None);
        let mut some = vec![DVec3::NAN, DVec3::INFINITY, DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let hull = convex_hull3(&some).expect("solid");
        assert!((hull.volume() - 1.0 / 6.0).abs() < 1e-12);
        some.extend(vec![DVec3::splat(0.1); 1000]);
        assert_eq!(convex_hull3(&some), Some(hull));
    }

    proptest! {
        // Points on a coarse lattice: many coplanar, collinear or repeated.
        #[test]
        fn hulls_are_closed_and_hold_every_point(
            raw in prop::collection::vec((0..6_i32, 0..6_i32, 0..6_i32, 0..3_i32), 4..200),
        ) {
            let wiggle = |i: i32| f64::from(i) * 1e-10;
            let points: Vec<DVec3> = raw
                .iter()
                .map(|&(x, y, z, w)| DVec3::new(f64::from(x) + wiggle(w), f64::from(y), f64::from(z) - wiggle(w)))
                .collect();
            if let Some(hull) = convex_hull3(&points) {
                sound(&hull, &points, 6.0);
            }
        }
    }
}
