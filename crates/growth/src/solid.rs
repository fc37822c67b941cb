//! A triangle mesh as a volume: inside test, nearest point, blocked views.
//!
//! `vertices + triangles -> bounding-volume tree -> answers`

use base::ops::{self, PI};
use glam::DVec3;

use crate::error::{SolidFault, usable};

/// Triangles per leaf of the tree.
const LEAF: usize = 4;
/// Capacity of the stack of a walk: two nodes per level, and median splits of fewer than 2^32 triangles have under 32
/// levels.
const STACK: usize = 80;

/// A mesh as a volume for queries; holes and inverted faces are tolerated (see `inside`).
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    triangles: Vec<[DVec3; 3]>,
    nodes: Vec<Node>,
    /// Axis along which a ray meets fewest boxes, for a surface without holes whose faces all point outwards, or all
    /// inwards.
    ray: Option<usize>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    lo: DVec3,
    hi: DVec3,
    start: u32,
    end: u32,
    /// The second child; the first follows its parent. 0 for a leaf.
    right: u32,
    /// Sum of area vectors and its point of action: the far field of the node.
    dipole: DVec3,
    centre: DVec3,
    radius: f64,
}

impl Solid {
    pub(crate) fn new(vertices: &[DVec3], indices: &[[u32; 3]]) -> Result<Self, SolidFault> {
        if let Some(vertex) = vertices.iter().position(|&v| !usable(v)) {
            return Err(SolidFault::Vertex { vertex });
        }
        let mut triangles = Vec::with_capacity(indices.len());
        for (triangle, corners) in indices.iter().enumerate() {
            let mut t = [DVec3::ZERO; 3];
            for (to, &vertex) in t.iter_mut().zip(corners) {
                *to = *vertices.get(vertex as usize).ok_or(SolidFault::Index {
                    triangle,
                    vertex,
                    vertices: vertices.len(),
                })?;
            }
            triangles.push(t);
        }
        // Before triangles without area are removed: they may connect others.
        let whole = sealed(&triangles);
        triangles.retain(|t| area(t).length_squared() > 0.0);
        if triangles.is_empty() || triangles.len() > u32::MAX as usize {
            return Err(SolidFault::Empty);
        }
        let ray = whole.then(|| emptiest_axis(&triangles));
        let mut solid = Self { nodes: Vec::with_capacity(2 * triangles.len() / LEAF + 1), triangles, ray };
        solid.split(0, solid.triangles.len());
        Ok(solid)
    }

    /// Adds the node of triangles `start..end` and all below it; halving bounds the depth.
    fn split(&mut self, start: usize, end: usize) {
        let me = self.nodes.len();
        self.nodes.push(summary(&self.triangles[start..end], start, end));
        if end - start <= LEAF {
            return;
        }
        let extent = self.nodes[me].hi - self.nodes[me].lo;
        let axis = if extent.x >= extent.y && extent.x >= extent.z {
            0
        } else if extent.y >= extent.z {
            1
        } else {
            2
        };
        let middle = (end - start) / 2;
        let key = |t: &[DVec3; 3]| t[0][axis] + t[1][axis] + t[2][axis];
        self.triangles[start..end].select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
        self.split(start, start + middle);
        self.nodes[me].right = row(self.nodes.len());
        self.split(start + middle, end);
    }

    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        (self.nodes[0].lo, self.nodes[0].hi)
    }

    /// Whether a point lies inside, by the generalised winding number (Jacobson et al. 2013; the tree as in Barill et
    /// al. 2018): its absolute value above one half. So inverted meshes count as correct ones, and small holes do not
    /// matter.
    pub(crate) fn inside(&self, p: DVec3) -> bool {
        let (lo, hi) = self.bounds();
        if p.cmplt(lo).any() || p.cmpgt(hi).any() {
            return false;
        }
        match self.ray {
            Some(axis) => self.crossings(p, axis) != 0,
            None => self.winding(p).abs() > 0.5,
        }
    }

    /// Returns the winding number of a sealed surface by the crossings of a ray along an axis: exits minus entries.
    ///
    /// Exact except on the surface itself: an edge gives both of its triangles the same decision about a ray. Where
    /// [`winding`] has to examine every sliver of a tall tower, a horizontal ray meets two.
    ///
    /// [`winding`]: Self::winding
    fn crossings(&self, p: DVec3, axis: usize) -> i32 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut sum = 0;
        self.walk(|node, triangles| {
            let (lo, hi) = (node.lo, node.hi);
            if hi[axis] < p[axis] || p[u] < lo[u] || p[u] > hi[u] || p[v] < lo[v] || p[v] > hi[v] {
                return false;
            }
            if node.right == 0 {
                for t in triangles {
                    let around = turns(t, p, u, v);
                    let normal = area(t);
                    if around != 0 && normal.dot(t[0] - p) * normal[axis] > 0.0 {
                        sum += around;
                    }
                }
            }
            true
        });
        sum
    }

    fn winding(&self, p: DVec3) -> f64 {
        let mut sum = 0.0;
        self.walk(|node, triangles| {
            let to = node.centre - p;
            let distance2 = to.length_squared();
            // 3 radii: the dipole is then off by less than a hundredth of its value.
            if distance2 > 9.0 * node.radius * node.radius {
                sum += node.dipole.dot(to) / (distance2 * distance2.sqrt());
                return false;
            }
            if node.right == 0 {
                sum += triangles.iter().map(|t| solid_angle(t, p)).sum::<f64>();
            }
            true
        });
        sum / (4.0 * PI)
    }

    /// Returns the nearest point of the surface and the (unit) normal of its triangle.
    pub(crate) fn nearest(&self, p: DVec3) -> (DVec3, DVec3) {
        // There is a triangle: `new` guarantees it.
        self.nearest_within(p, f64::INFINITY).unwrap_or((p, DVec3::Y))
    }

    /// As [`nearest`](Self::nearest), if it is at most `reach` away; much faster where nothing is.
    ///
    /// The nearer child first, so that the other one is seldom visited; of triangles at equal distance the first.
    pub(crate) fn nearest_within(&self, p: DVec3, reach: f64) -> Option<(DVec3, DVec3)> {
        let gap2 = |at: usize| {
            let Node { lo, hi, .. } = self.nodes[at];
            (lo - p).max(p - hi).max(DVec3::ZERO).length_squared()
        };
        let mut best = (reach * reach, DVec3::ZERO, usize::MAX);
        let mut stack = [(0_u32, 0.0_f64); STACK];
        stack[0].1 = gap2(0);
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let (at, gap) = stack[waiting];
            // With a margin for rounding: an earlier triangle at the same distance counts.
            if gap > best.0 * (1.0 + 1e-9) {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.right == 0 {
                for i in node.start as usize..node.end as usize {
                    let q = closest_on_triangle(&self.triangles[i], p);
                    let d2 = q.distance_squared(p);
                    if d2 < best.0 || (d2 == best.0 && i < best.2) {
                        best = (d2, q, i);
                    }
                }
            } else if waiting + 2 <= STACK {
                let (left, right) = (at + 1, node.right);
                let (a, b) = ((left, gap2(left as usize)), (right, gap2(right as usize)));
                (stack[waiting], stack[waiting + 1]) = if a.1 <= b.1 { (b, a) } else { (a, b) };
                waiting += 2;
            }
        }
        let t = self.triangles.get(best.2)?;
        Some((best.1, area(t).normalize_or(DVec3::Y)))
    }

    /// Whether the segment from `a` to `b` meets the surface.
    pub(crate) fn blocks(&self, a: DVec3, b: DVec3) -> bool {
        let d = b - a;
        let mut hit = false;
        self.walk(|node, triangles| {
            if hit || !segment_meets_box(a, d, node.lo, node.hi) {
                return false;
            }
            if node.right == 0 {
                hit = triangles.iter().any(|t| segment_meets_triangle(a, d, t));
            }
            true
        });
        hit
    }

    /// Visits nodes; the children of a node only if `visit` returns true.
    fn walk(&self, mut visit: impl FnMut(&Node, &[[DVec3; 3]]) -> bool) {
        let mut stack = [0_u32; STACK];
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let at = stack[waiting];
            let node = &self.nodes[at as usize];
            let inner = visit(node, &self.triangles[node.start as usize..node.end as usize]);
            if inner && node.right != 0 && waiting + 2 <= STACK {
                stack[waiting] = node.right;
                stack[waiting + 1] = at + 1;
                waiting += 2;
            }
        }
    }
}

/// Whether each edge is traversed equally often in both directions: no hole, and no inverted face.
fn sealed(triangles: &[[DVec3; 3]]) -> bool {
    // Adding 0 turns -0 into 0, which is the same coordinate.
    let place = |p: DVec3| p.to_array().map(|c| (c + 0.0).to_bits());
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for t in triangles {
        for i in 0..3 {
            let (a, b) = (place(t[i]), place(t[(i + 1) % 3]));
            if a != b {
                edges.push(if a < b { (a, b, 1) } else { (b, a, -1) });
            }
        }
    }
    base::sort_by(&mut edges, Ord::cmp);
    edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).all(|same| same.iter().map(|e| e.2).sum::<i32>() == 0)
}

/// Returns the mean number of boxes of triangles at a place of the surface: their larger sides over the surface. Two or
/// three for even triangles; the time to find the nearest of them grows with it. Bad corners count nothing.
pub(crate) fn slivers(vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let (mut boxes, mut surface) = (0.0, 0.0);
    for corners in triangles {
        let at = |k: usize| vertices.get(corners[k] as usize).copied().filter(|v| usable(*v));
        let (Some(a), Some(b), Some(c)) = (at(0), at(1), at(2)) else { continue };
        let size = a.max(b).max(c) - a.min(b).min(c);
        boxes += (size.x * size.y).max(size.y * size.z).max(size.z * size.x);
        surface += area(&[a, b, c]).length();
    }
    if surface > 0.0 { boxes / surface } else { 0.0 }
}

/// Returns the axis along which triangles hide least of one another, by their boxes.
fn emptiest_axis(triangles: &[[DVec3; 3]]) -> usize {
    let mut hidden = DVec3::ZERO;
    for t in triangles {
        let size = t[0].max(t[1]).max(t[2]) - t[0].min(t[1]).min(t[2]);
        hidden += DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y);
    }
    (0..3).min_by(|&a, &b| hidden[a].total_cmp(&hidden[b])).unwrap_or(0)
}

/// Returns the winding number of a triangle around a point, both seen along an axis: -1, 0 or 1.
fn turns(t: &[DVec3; 3], p: DVec3, u: usize, v: usize) -> i32 {
    let mut sum = 0;
    for i in 0..3 {
        let (a, b) = (t[i], t[(i + 1) % 3]);
        let up = a[v] <= p[v] && p[v] < b[v];
        let down = b[v] <= p[v] && p[v] < a[v];
        if up || down {
            // From the lower end, for either triangle: both get the same number.
            let (low, high) = if up { (a, b) } else { (b, a) };
            let left = (high[u] - low[u]) * (p[v] - low[v]) - (p[u] - low[u]) * (high[v] - low[v]);
            if left > 0.0 {
                sum += if up { 1 } else { -1 };
            }
        }
    }
    sum
}

#[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 triangles, checked in `new`")]
const fn row(i: usize) -> u32 {
    i as u32
}

fn summary(triangles: &[[DVec3; 3]], start: usize, end: usize) -> Node {
    let (mut lo, mut hi) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (mut dipole, mut centre, mut whole) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for t in triangles {
        let a = area(t);
        let size = a.length();
        dipole += a;
        centre += (t[0] + t[1] + t[2]) * (size / 3.0);
        whole += size;
        for &v in t {
            lo = lo.min(v);
            hi = hi.max(v);
        }
    }
    centre /= whole;
    let radius = triangles.iter().flatten().map(|v| v.distance(centre)).fold(0.0, f64::max);
    Node { lo, hi, start: row(start), end: row(end), right: 0, dipole, centre, radius }
}

/// Returns the normal of a triangle with its area as length.
fn area(t: &[DVec3; 3]) -> DVec3 {
    (t[1] - t[0]).cross(t[2] - t[0]) * 0.5
}

/// Returns the signed solid angle of a triangle (Van Oosterom and Strackee 1983).
fn solid_angle(t: &[DVec3; 3], p: DVec3) -> f64 {
    let (a, b, c) = (t[0] - p, t[1] - p, t[2] - p);
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let over = a.dot(b.cross(c));
    let under = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * ops::atan2(over, under)
}

/// Returns the nearest point by the regions of the triangle: a corner, an edge or the face.
fn closest_on_triangle(t: &[DVec3; 3], p: DVec3) -> DVec3 {
    let on_edge = |a: DVec3, b: DVec3| {
        let d = b - a;
        a + d * ((p - a).dot(d) / d.length_squared().max(1e-300)).clamp(0.0, 1.0)
    };
    let n = area(t);
    let over_face = (0..3).all(|i| {
        let (a, b) = (t[i], t[(i + 1) % 3]);
        (b - a).cross(p - a).dot(n) >= 0.0
    });
    if over_face {
        return p - n * ((p - t[0]).dot(n) / n.length_squared());
    }
    let candidates = [on_edge(t[0], t[1]), on_edge(t[1], t[2]), on_edge(t[2], t[0])];
    let mut best = candidates[0];
    for q in &candidates[1..] {
        if q.distance_squared(p) < best.distance_squared(p) {
            best = *q;
        }
    }
    best
}

/// Tests a segment against a box by slabs.
pub(crate) fn segment_meets_box(a: DVec3, d: DVec3, lo: DVec3, hi: DVec3) -> bool {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for i in 0..3 {
        if d[i].abs() < 1e-300 {
            if a[i] < lo[i] || a[i] > hi[i] {
                return false;
            }
        } else {
            let (s, t) = ((lo[i] - a[i]) / d[i], (hi[i] - a[i]) / d[i]);
            enter = enter.max(s.min(t));
            leave = leave.min(s.max(t));
        }
    }
    enter <= leave
}

/// Tests a segment against both sides of a triangle (Moeller and Trumbore 1997).
fn segment_meets_triangle(a: DVec3, d: DVec3, t: &[DVec3; 3]) -> bool {
    let (e1, e2) = (t[1] - t[0], t[2] - t[0]);
    let h = d.cross(e2);
    let det = e1.dot(h);
    if det.abs() < 1e-300 {
        return false;
    }
    let s = a - t[0];
    let u = s.dot(h) / det;
    let q = s.cross(e1);
    let v = d.dot(q) / det;
    let along = e2.dot(q) / det;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&along)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Makes a box from 0 to 1, with outward faces.
    pub(crate) fn cube() -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let v = (0..8)
            .map(|i| DVec3::new(f64::from(i & 1), f64::from((i >> 1) & 1), f64::from((i >> 2) & 1)))
            .collect();
        let t = vec![
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        (v, t)
    }

    /// Makes a sphere of radius 1 by rings and sectors.
    pub(crate) fn sphere(rings: u32, sectors: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let mut v = vec![];
        for i in 0..=rings {
            let (s, c) = ops::sin_cos(PI * f64::from(i) / f64::from(rings));
            for j in 0..sectors {
                let (sj, cj) = ops::sin_cos(ops::TAU * f64::from(j) / f64::from(sectors));
                v.push(DVec3::new(s * cj, c, s * sj));
            }
        }
        let mut t = vec![];
        for i in 0..rings {
            for j in 0..sectors {
                let at = |i, j| i * sectors + j % sectors;
                t.push([at(i, j), at(i, j + 1), at(i + 1, j)]);
                t.push([at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
            }
        }
        (v, t)
    }

    /// Makes a cylinder of radius 1 and height 4 of slivers, as tall as it is, with fans at both ends.
    fn tower(sides: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let mut v = vec![DVec3::ZERO, DVec3::Y * 4.0];
        let mut t = vec![];
        for j in 0..sides {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(j) / f64::from(sides));
            v.extend([DVec3::new(c, 0.0, s), DVec3::new(c, 4.0, s)]);
            let (a, b) = (2 + 2 * j, 2 + 2 * ((j + 1) % sides));
            t.extend([[a, a + 1, b], [b, a + 1, b + 1], [0, a, b], [1, b + 1, a + 1]]);
        }
        (v, t)
    }

    #[test]
    fn a_ray_tells_what_the_winding_number_tells() {
        let (mut two, mut faces) = cube();
        // A cube in a cube: twice around.
        faces.extend(cube().1.iter().map(|t| t.map(|i| i + 8)));
        two.extend(cube().0.iter().map(|v| *v * 0.5 + 0.25));
        // The ring at the lower end is a point except for rounding, which is a hole.
        let (mut ball, sectors) = sphere(12, 16);
        ball.iter_mut().filter(|p| p.y < -1.0 + 1e-12).for_each(|p| *p = DVec3::NEG_Y);
        let mut s = base::Seed::new(5).stream(base::Draw::Test);
        for (v, t) in [cube(), (ball, sectors), tower(300), (two, faces)] {
            let inverted: Vec<_> = t.iter().map(|&[a, b, c]| [a, c, b]).collect();
            for t in [t, inverted] {
                let solid = Solid::new(&v, &t).expect("sound");
                assert!(solid.ray.is_some(), "it is sealed");
                for k in 0..600 {
                    let mut p = DVec3::new(s.uniform(), s.uniform(), s.uniform()) * 4.4 - 1.2;
                    if k % 3 == 0 {
                        // Many at one height, and on no face.
                        p = (p * 4.0).round() / 4.0 + DVec3::new(0.03, 0.01, 0.02);
                    }
                    for axis in 0..3 {
                        let got = solid.crossings(p, axis) != 0;
                        assert_eq!(got, solid.winding(p).abs() > 0.5, "{p} along {axis}");
                    }
                }
            }
        }
        assert!(slivers(&cube().0, &cube().1) <= 2.0 && slivers(&sphere(60, 60).0, &sphere(60, 60).1) < 4.0);
        assert!(slivers(&tower(40_000).0, &tower(40_000).1) > 500.0);
        let (v, t) = tower(300);
        assert!(Solid::new(&v, &t).expect("sound").ray != Some(1), "level, where slivers stand");
        assert!(Solid::new(&v, &t[1..]).expect("sound").ray.is_none(), "a hole is no sealed surface");
    }

    #[test]
    fn inside_of_cube_sphere_inverted_and_open() {
        let (v, t) = cube();
        let inverted: Vec<_> = t.iter().map(|&[a, b, c]| [a, c, b]).collect();
        // Without one of its twelve triangles.
        for faces in [&t[..], &inverted, &t[1..]] {
            let solid = Solid::new(&v, faces).expect("sound");
            assert!(solid.inside(DVec3::splat(0.5)), "{} faces", faces.len());
            assert!(!solid.inside(DVec3::new(0.5, 0.5, 1.2)));
            assert!(!solid.inside(DVec3::splat(-0.1)));
        }
        let (v, t) = sphere(24, 32);
        let solid = Solid::new(&v, &t).expect("sound");
        let mut s = base::Seed::new(3).stream(base::Draw::Test);
        for _ in 0..2000 {
            let p = DVec3::new(s.range(-1.2, 1.2), s.range(-1.2, 1.2), s.range(-1.2, 1.2));
            let r = p.length();
            // Between the ball inscribed in the mesh and the ball around it nothing is guaranteed.
            if !(0.98..=1.0).contains(&r) {
                assert_eq!(solid.inside(p), r < 0.99, "{p}");
                let (q, _) = solid.nearest(p);
                assert!((q.distance(p) - (r - 1.0).abs()).abs() < 0.02, "{p} {q}");
            }
        }
    }

    #[test]
    fn views_are_blocked_by_surfaces_only() {
        let (v, t) = cube();
        let solid = Solid::new(&v, &t).expect("sound");
        let at = DVec3::new;
        assert!(solid.blocks(at(-1.0, 0.4, 0.3), at(2.0, 0.5, 0.6)));
        assert!(solid.blocks(at(0.5, 0.4, 0.3), at(0.5, 3.0, 0.3)), "from within");
        assert!(!solid.blocks(at(-1.0, 0.4, 0.3), at(-0.1, 0.4, 0.3)), "ends before");
        assert!(!solid.blocks(at(-1.0, 2.0, 0.3), at(2.0, 2.0, 0.6)), "passes by");
        assert!(!solid.blocks(at(0.2, 0.4, 0.3), at(0.8, 0.6, 0.6)), "stays within");
    }

    #[test]
    fn broken_meshes_are_named() {
        let (mut v, t) = cube();
        assert_eq!(Solid::new(&v, &[]).err(), Some(SolidFault::Empty));
        assert_eq!(Solid::new(&v, &[[0, 0, 1]]).err(), Some(SolidFault::Empty));
        let missing = SolidFault::Index { triangle: 0, vertex: 99, vertices: 8 };
        assert_eq!(Solid::new(&v, &[[0, 99, 1]]).err(), Some(missing));
        v[3] = DVec3::NAN;
        assert_eq!(Solid::new(&v, &t).err(), Some(SolidFault::Vertex { vertex: 3 }));
    }

    #[test]
    fn the_nearest_is_the_first_of_the_nearest_of_all_and_only_within_reach() {
        let mut s = base::Seed::new(8).stream(base::Draw::Test);
        for (vertices, indices) in [cube(), sphere(9, 14)] {
            let solid = Solid::new(&vertices, &indices).expect("sound");
            for round in 0..400 {
                // Occasionally in the centre, where many triangles are equally near.
                let wide = if round % 5 == 0 { 0.0 } else { 2.0 };
                let p = DVec3::new(s.range(-wide, wide), s.range(-wide, wide), s.range(-wide, wide));
                let all = solid.triangles.iter().map(|t| (closest_on_triangle(t, p), area(t).normalize()));
                let first =
                    all.reduce(|a, b| if b.0.distance_squared(p) < a.0.distance_squared(p) { b } else { a });
                let (q, normal) = first.expect("there are triangles");
                assert_eq!(solid.nearest(p), (q, normal), "{p}");
                let d = q.distance(p);
                assert_eq!(solid.nearest_within(p, 1.001 * d + 1e-9), Some((q, normal)));
                let short = solid.nearest_within(p, 0.999 * d);
                assert!(short.is_none() || d <= 0.0, "{p}");
            }
        }
    }
}
