//! Hollows: the bark of a stem is opened behind a rim, and a cavity in the wood is joined to the rim's inner edge.
//!
//! `rim on a stem -> Opening -> a hole in the bark of the stem, a mesh of dead wood`
//!
//! Around a hole that rots into a stem the living wood swells to a roll, and behind it the cavity is wider than its
//! mouth, mostly upwards and downwards along the grain (Shigo, A New Tree Biology, 1986).

use std::collections::BTreeMap;

use base::{Draw, Seed, ops};
use glam::{DVec2, DVec3};
use mesh::TriMesh;

use crate::rings::Ring;
use crate::sleeve::{Circle, Sleeve, narrow, wide};
use crate::spine::Station;

/// Least thickness of a hollow's rim as a share of its stem; thinner ones are knots. Growth makes knots of up to 0.26
/// and hollows from 0.28 on.
const HOLLOW: f64 = 0.27;
/// Least and greatest depth of a cavity in the wood, in radii of the stem.
const DEEP: [f64; 2] = [0.5, 0.78];
/// Distance of two hollows along a stem, in radii of the stem, below which both have the least depth, so that they do
/// not meet.
const CROWDED: f64 = 3.0;
/// Detail, that of the first coarser level, below which a stem is not opened.
const COARSE: f64 = 0.4;

/// Radius of the mouth, in radii of the rim.
pub(crate) const MOUTH: f64 = 0.7;
/// Rows of a cavity from its mouth on: shares of the distance to the bark and from there to its end; half its width
/// across the stem and along it, in radii of the rim.
const ROWS: [(f64, f64, f64, f64); 6] = [
    (0.0, 0.0, MOUTH, MOUTH),
    (0.55, 0.0, 0.6, 0.64),
    (1.0, 0.1, 0.62, 0.8),
    (1.0, 0.35, 0.72, 1.1),
    (1.0, 0.7, 0.62, 1.1),
    (1.0, 0.93, 0.35, 0.65),
];
/// First row of [`ROWS`] that is uneven, and its narrowing in places: rot is irregular.
const UNEVEN: (usize, f64) = (2, 0.3);
/// Largest share of the wood's width at a depth that a cavity takes.
const WALL: f64 = 0.85;
/// Lean of the normals of the mouth, equal to that of the roll of bark there.
const LEAN: f64 = 2.4;
/// Exponential darkening for each radius of depth. By eye; interreflection is not computed.
const GLOOM: f64 = 0.8;

/// Longest edge near a hollow, in radii of the rim.
const FINE: f64 = 0.35;
/// Distance from the rim's centre within which edges are cut, in its radii.
const NEAR: f64 = 1.3;
/// Distance from the rim's centre within which the bark is removed, in its radii: the mouth is narrower, and the foot
/// of the rim lies at 1.8.
const CUT: f64 = 1.05;
/// Depth behind the bark to which this applies, in radii of the stem: not on the far side.
const BEHIND: f64 = 0.6;
/// Most halvings of an edge: for a stretch of 300 radii.
const ROUNDS: usize = 10;

/// A hollow in a stem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Opening {
    /// Position of its centre on the bark.
    bark: DVec3,
    /// Directions out of the stem, along the stem and across both.
    out: DVec3,
    up: DVec3,
    side: DVec3,
    /// Radius of the rim, metres.
    radius: f64,
    /// Radius of the stem, metres.
    stem: f64,
    /// Depth of the cavity behind the bark, metres.
    deep: f64,
    key: u64,
}

impl Opening {
    /// Makes the hollow of a rim with a key, given the stations of the rim and of the stem; `None` if the rim is too
    /// thin, relative to the stem as it grew, for rot behind it, and at coarse detail.
    pub(crate) fn new(rim: &Station, stem: &Station, (key, share): (u64, f64), detail: f64) -> Option<Self> {
        let out = rim.tangent;
        let up = (stem.tangent - out * stem.tangent.dot(out)).try_normalize()?;
        let deep = ops::lerp(DEEP[0], DEEP[1], Seed::new(key).stream(Draw::Habit).uniform()) * stem.radius;
        let side = up.cross(out);
        let (radius, stem) = (rim.radius, stem.radius);
        (detail >= COARSE && share >= HOLLOW).then_some(Self {
            bark: rim.centre,
            out,
            up,
            side,
            radius,
            stem,
            deep,
            key,
        })
    }

    /// Reduces it to the least depth if another one of the same stem is near.
    pub(crate) fn crowded_by(self, other: &Self) -> Self {
        let near = self.bark.distance(other.bark) < CROWDED * self.stem.max(other.stem);
        Self { deep: if near { DEEP[0] * self.stem } else { self.deep }, ..self }
    }

    /// Makes the cavity behind the last ring of its rim, darker with depth: dead wood that faces the mouth.
    pub(crate) fn cavity(&self, last: &Ring, circle: &Circle) -> TriMesh {
        let mut mesh = TriMesh::default();
        let mut out = Sleeve::new(&mut mesh, circle, 1);
        let beyond = (last.centre - self.bark).dot(self.out).max(0.0);
        let back = |(above, below): (f64, f64)| above * beyond + below * self.deep;
        let mut draw = Seed::new(self.key).stream(Draw::Texture);
        for (k, &(above, below, across, along)) in ROWS.iter().enumerate() {
            let centre = last.centre - self.out * back((above, below));
            let depth = below * self.deep;
            // Wood remains on both sides of it: the stem is round.
            let chord = WALL * (depth * (2.0 * self.stem - depth)).max(0.0).sqrt();
            let most = if k >= UNEVEN.0 { chord / self.radius } else { across };
            let size = DVec2::new(across.min(most), along) * self.radius;
            let rough: Vec<f64> = (0..circle.sides()).map(|_| UNEVEN.1 * draw.uniform()).collect();
            let (mut corners, mut normals) = (Vec::new(), Vec::new());
            for (j, &corner) in circle.0.iter().enumerate() {
                let ray = last.ray(corner);
                let narrower = if k >= UNEVEN.0 { 1.0 - rough[j % circle.sides()] } else { 1.0 };
                let local = self.side * (ray.dot(self.side) * size.x) + self.up * (ray.dot(self.up) * size.y);
                corners.push(if k == 0 { ray * (MOUTH * last.radius) } else { local * narrower } + centre);
                normals.push(-ray);
            }
            out.row(centre, self.radius, &corners, &normals);
        }
        let end = last.centre - self.out * back((1.0, 1.0));
        out.close(end, self.out);
        self.shade(&mut mesh, last, circle);
        mesh
    }

    /// Sets the normals of a cavity, and its light by depth.
    fn shade(&self, mesh: &mut TriMesh, last: &Ring, circle: &Circle) {
        mesh.compute_normals();
        let width = circle.sides() + 1;
        for row in mesh.normals[..width * ROWS.len()].chunks_exact_mut(width) {
            // The last corner of each row equals its first.
            let both = narrow((wide(row[0]) + wide(row[width - 1])).normalize_or(self.out));
            (row[0], row[width - 1]) = (both, both);
        }
        let (sin, cos) = ops::sin_cos(LEAN);
        for (normal, &corner) in mesh.normals.iter_mut().zip(&circle.0) {
            *normal = narrow(last.ray(corner) * cos + last.tangent * sin);
        }
        for normal in &mut mesh.normals[width * ROWS.len()..] {
            *normal = narrow(self.out);
        }
        let light = |p: &[f32; 3]| {
            let depth = (last.centre - wide(*p)).dot(self.out).max(0.0);
            #[expect(clippy::cast_possible_truncation, reason = "a colour")]
            let light = ops::exp(-GLOOM * depth / self.radius) as f32;
            [light; 3]
        };
        mesh.colors = mesh.positions.iter().map(light).collect();
    }

    /// Removes the bark behind the rim. All columns of the mesh are kept; the rest keeps its order.
    pub(crate) fn cut(&self, mesh: &mut TriMesh) {
        for _ in 0..ROUNDS {
            let mut middles = BTreeMap::new();
            let whole = core::mem::take(&mut mesh.triangles);
            let mut pieces = Vec::with_capacity(whole.len());
            for t in whole {
                let [a, b, c] = t;
                let halves = [[a, b], [b, c], [c, a]].map(|edge| self.middle(mesh, edge, &mut middles));
                split(t, halves, &mut pieces);
            }
            mesh.triangles = pieces;
            if middles.is_empty() {
                break;
            }
        }
        let positions = &mesh.positions;
        mesh.triangles.retain(|t| {
            let middle = t.iter().map(|&i| wide(positions[i as usize])).sum::<DVec3>() / 3.0;
            let (flat, height) = self.local(middle);
            flat.length() >= CUT * self.radius || height < -BEHIND * self.stem
        });
        drop_unused(mesh);
    }

    /// Returns the position across and along the stem relative to the centre of the rim, and the distance out of the
    /// bark.
    fn local(&self, p: DVec3) -> (DVec2, f64) {
        let d = p - self.bark;
        (DVec2::new(d.dot(self.side), d.dot(self.up)), d.dot(self.out))
    }

    /// Returns the vertex in the middle of an edge that is too long. The decision follows from the positions of its
    /// ends alone, so that pieces meet along the seam of a tube, too.
    ///
    /// If a triangle contains the centre of the rim, its nearest edge is within half of its length: it is always found.
    fn middle(
        &self,
        mesh: &mut TriMesh,
        [a, b]: [u32; 2],
        middles: &mut BTreeMap<[u32; 2], u32>,
    ) -> Option<u32> {
        let [p, q] = [a, b].map(|i| self.local(wide(mesh.positions[i as usize])));
        let length = mesh.position(a).distance(mesh.position(b));
        let far = geom::distance_to_segment(p.0, q.0, DVec2::ZERO) > NEAR * self.radius + 0.5 * length;
        if length <= FINE * self.radius || far || p.1.max(q.1) < -BEHIND * self.stem {
            return None;
        }
        Some(*middles.entry([a.min(b), a.max(b)]).or_insert_with(|| halved(mesh, a as usize, b as usize)))
    }
}

/// Adds the vertex half-way between two.
fn halved(mesh: &mut TriMesh, a: usize, b: usize) -> u32 {
    fn mean<const N: usize>(column: &mut Vec<[f32; N]>, a: usize, b: usize) {
        if let (Some(p), Some(q)) = (column.get(a).copied(), column.get(b)) {
            let q = *q;
            column.push(core::array::from_fn(|k| 0.5 * (p[k] + q[k])));
        }
    }
    let new = crate::sleeve::index(mesh.positions.len());
    mean(&mut mesh.positions, a, b);
    mean(&mut mesh.normals, a, b);
    if let Some(normal) = mesh.normals.last_mut() {
        *normal = narrow(wide(*normal).normalize_or(DVec3::Y));
    }
    mean(&mut mesh.uvs, a, b);
    mean(&mut mesh.colors, a, b);
    mean(&mut mesh.wind, a, b);
    mean(&mut mesh.pivots, a, b);
    new
}

/// Splits a triangle at the middles of some of its sides, from its first corner on.
fn split([a, b, c]: [u32; 3], halves: [Option<u32>; 3], pieces: &mut Vec<[u32; 3]>) {
    match halves {
        [None, None, None] => pieces.push([a, b, c]),
        [Some(m), None, None] => pieces.extend([[a, m, c], [m, b, c]]),
        [Some(m), Some(n), None] => pieces.extend([[m, b, n], [a, m, n], [a, n, c]]),
        [Some(m), Some(n), Some(o)] => pieces.extend([[a, m, o], [m, b, n], [o, n, c], [m, n, o]]),
        // The other cases are these, rotated.
        [m, n, o] => split([b, c, a], [n, o, m], pieces),
    }
}

/// Removes the vertices that no triangle uses.
fn drop_unused(mesh: &mut TriMesh) {
    let mut used = vec![false; mesh.positions.len()];
    for i in mesh.triangles.iter().flatten() {
        used[*i as usize] = true;
    }
    let mut number = Vec::with_capacity(used.len());
    let mut next = 0_u32;
    for &kept in &used {
        number.push(next);
        next += u32::from(kept);
    }
    fn keep<T>(column: &mut Vec<T>, used: &[bool]) {
        let mut row = used.iter();
        column.retain(|_| row.next().copied().unwrap_or(true));
    }
    keep(&mut mesh.positions, &used);
    keep(&mut mesh.normals, &used);
    keep(&mut mesh.uvs, &used);
    keep(&mut mesh.colors, &used);
    keep(&mut mesh.wind, &used);
    keep(&mut mesh.pivots, &used);
    for i in mesh.triangles.iter_mut().flatten() {
        *i = number[*i as usize];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SkinSpec;
    use plant::{AxisKind, Plant};

    const STEM: f64 = 0.3;
    /// Height of rims: the same for all, as the rings of the stem depend on its axes.
    const OUT: f64 = 0.035;
    /// Radius of a stub that ends round.
    const THIN: f64 = 0.02;

    /// Makes a stem with rims of these radii, heights and angles, as growth does.
    fn stem(rims: &[(f64, f64, f64)]) -> Plant {
        let mut plant = Plant::default();
        let line: Vec<DVec3> = (0..=40).map(|k| DVec3::Y * (0.1 * f64::from(k))).collect();
        plant.add_axis(AxisKind::Branch, None, 7, &line, None);
        plant.nodes.radius_m.fill(STEM);
        for (key, &(radius, height, angle)) in (8..).zip(rims) {
            let (sin, cos) = ops::sin_cos(angle);
            let (out, foot) = (DVec3::new(cos, 0.0, sin), DVec3::Y * height);
            let bearer = plant.axis(plant::AxisId::new(0)).node_ids().nth(ops::whole(10.0 * height) as usize);
            let beyond = (0..=6).map(|k| foot + out * (STEM + OUT * f64::from(k) / 6.0));
            let points: Vec<DVec3> = core::iter::once(foot).chain(beyond).collect();
            let id = plant.add_axis(AxisKind::Stub, bearer, key, &points, None);
            for (k, node) in plant.axis(id).node_ids().collect::<Vec<_>>().into_iter().enumerate() {
                plant.nodes.radius_m[node.index()] = if k < 2 { radius } else { 0.9 * radius };
            }
        }
        plant
    }

    fn skinned(plant: &Plant, detail: f64) -> mesh::Model {
        let spec = SkinSpec { detail, textures: false, ..SkinSpec::default() };
        let model = crate::skin(plant, &spec, &base::Run::plain()).expect("a budget");
        assert_eq!(model.validate().count(), 0);
        model
    }

    /// Returns the distance at which a ray meets a model.
    fn first_hit(model: &mesh::Model, from: DVec3, way: DVec3) -> f64 {
        let hits = model.parts.iter().flat_map(|part| {
            part.mesh.triangles.iter().filter_map(|t| {
                let [a, b, c] = t.map(|i| part.mesh.position(i));
                let (u, v) = (b - a, c - a);
                let across = way.cross(v);
                let det = u.dot(across);
                let s = (from - a).dot(across) / det;
                let around = (from - a).cross(u);
                let t = way.dot(around) / det;
                (s >= 0.0 && t >= 0.0 && s + t <= 1.0).then(|| v.dot(around) / det).filter(|d| *d > 0.0)
            })
        });
        hits.fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn one_looks_deep_into_a_hollow_and_nowhere_through_its_tree() {
        for (radius, angle) in [(0.3 * STEM, 0.0), (0.36 * STEM, 1.1), (0.44 * STEM, 3.9)] {
            let model = skinned(&stem(&[(radius, 2.0, angle)]), 1.0);
            let (sin, cos) = ops::sin_cos(angle);
            let (out, side) = (DVec3::new(cos, 0.0, sin), DVec3::new(-sin, 0.0, cos));
            for (x, y) in [(0.0, 0.0), (0.3, 0.0), (-0.3, 0.0), (0.0, 0.4), (0.0, -0.4)] {
                let from = out * (3.0 * STEM) + DVec3::Y * (2.0 + y * radius) + side * (x * radius);
                let deep = first_hit(&model, from, -out);
                let bark = first_hit(&model, from + DVec3::Y * (4.0 * radius), -out);
                assert!(deep > bark + 0.4 * STEM && deep < bark + 0.9 * STEM, "{x} {y}: {deep} {bark}");
            }
            // From everywhere around it something is met soon: bark, the rim or the wood within.
            for k in 0..400 {
                let (x, y) = (0.13 * f64::from(k % 20) - 1.25, 0.13 * f64::from(k / 20) - 1.25);
                for slant in [DVec3::ZERO, side * 0.4, DVec3::Y * 0.6, side * -0.5 + DVec3::Y * -0.4] {
                    let at = out * STEM + DVec3::Y * (2.0 + y * radius) + side * (x * radius);
                    let way = (slant - out).normalize();
                    let met = first_hit(&model, at - way * STEM, way);
                    assert!(met < 2.2 * STEM, "{x} {y} {slant}: {met}");
                }
            }
        }
    }

    #[test]
    fn the_hole_in_the_bark_is_behind_the_rim_and_all_else_is_closed() {
        let radius = 0.4 * STEM;
        for angle in [0.0, 0.7, 2.9, 5.5] {
            let model = skinned(&stem(&[(radius, 2.0, angle)]), 1.0);
            let (sin, cos) = ops::sin_cos(angle);
            let middle = DVec3::new(cos, 0.0, sin) * STEM + DVec3::Y * 2.0;
            let place = |p: DVec3| narrow(p).map(|x| (x + 0.0).to_bits());
            let mut sides = BTreeMap::new();
            let mesh = &model.parts[0].mesh;
            // The stem comes first: the part of the bark outside it is the rim.
            for t in mesh.triangles.iter().map(|t| t.map(|i| mesh.position(i))) {
                for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    *sides.entry([place(a).min(place(b)), place(a).max(place(b))]).or_insert(0) +=
                        if place(a) < place(b) { 1 } else { -1 };
                }
            }
            let open: Vec<_> = sides.iter().filter(|(_, n)| **n != 0).map(|(side, _)| side).collect();
            assert!(open.len() > 20, "{}", open.len());
            for p in open.into_iter().flatten().map(|p| wide(p.map(f32::from_bits))) {
                assert!(p.distance(middle) < 2.2 * radius, "{p} {middle}");
            }
            // Parts far from it are unchanged.
            let whole = &skinned(&stem(&[(THIN, 2.0, angle)]), 1.0).parts[0].mesh;
            let far = |p: &&[f32; 3]| wide(**p).distance(middle) > 0.8;
            let kept: Vec<_> = mesh.positions.iter().filter(far).collect();
            assert!(kept == whole.positions.iter().filter(far).collect::<Vec<_>>(), "{angle}");
        }
    }

    #[test]
    fn knots_open_nothing_and_coarse_trees_are_not_opened() {
        let stem =
            |radius: f64, detail: f64| skinned(&stem(&[(radius, 2.0, 1.0)]), detail).parts.remove(0).mesh;
        for (rim, detail) in [(0.24 * STEM, 1.0), (0.4 * STEM, 0.25)] {
            let (plain, rim) = (stem(THIN, detail), stem(rim, detail));
            // The stub comes after its stem, whose last triangles are those of its tip.
            let same = plain.triangles.iter().zip(&rim.triangles).take_while(|(a, b)| a == b);
            let same: Vec<u32> = same.flat_map(|(t, _)| *t).collect();
            assert!(same.iter().any(|&i| plain.position(i).y > 4.0), "{detail}: {}", same.len());
            assert!(same.iter().all(|&i| rim.positions[i as usize] == plain.positions[i as usize]));
        }
    }

    #[test]
    fn a_hollow_in_the_flare_of_the_foot_is_one_too() {
        // The foot is drawn wider than it grew, so that the rim is narrow compared with it.
        let model = skinned(&stem(&[(0.28 * STEM, 0.3, 0.0)]), 1.0);
        let deep = first_hit(&model, DVec3::new(2.0, 0.3, 0.0), -DVec3::X);
        assert!(deep > 2.0 - 0.6 * STEM, "{deep}");
    }

    #[test]
    fn hollows_across_a_stem_do_not_meet() {
        let radius = 0.4 * STEM;
        let alone = skinned(&stem(&[(radius, 2.0, 0.0)]), 1.0);
        let both = skinned(&stem(&[(radius, 2.0, 0.0), (radius, 2.0, ops::PI)]), 1.0);
        let deep = |model| first_hit(model, DVec3::new(2.0, 2.0, 0.0), -DVec3::X);
        assert!(deep(&alone) > deep(&both), "{} {}", deep(&alone), deep(&both));
        assert!(deep(&both) <= 2.0 + 1e-6, "not beyond the middle: {}", deep(&both));
    }

    #[test]
    fn triangles_are_split_into_the_same_area() {
        let at = [DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(0.0, 4.0)];
        let point = |i: u32| match i {
            0..3 => at[i as usize],
            _ => 0.5 * (at[i as usize - 3] + at[(i as usize - 2) % 3]),
        };
        for which in 0..8_u32 {
            let halves = [0, 1, 2].map(|k| (which >> k & 1 == 1).then_some(3 + k));
            let mut pieces = Vec::new();
            split([0, 1, 2], halves, &mut pieces);
            let area = |t: &[u32; 3]| {
                let [a, b, c] = t.map(point);
                0.5 * (b - a).perp_dot(c - a)
            };
            assert_eq!(pieces.len(), 1 + which.count_ones() as usize);
            assert!(pieces.iter().all(|t| area(t) > 0.0), "{which}");
            assert_eq!(pieces.iter().map(area).sum::<f64>(), 8.0);
        }
    }
}
