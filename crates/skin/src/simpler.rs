//! A closed surface of fewer triangles.
//!
//! `triangles, largest deviation -> edges that vanish, pass by pass -> the same surface within that deviation`

use base::{Cancelled, Run};
use glam::DVec3;
use mesh::TriMesh;

/// Limits of the collapse of edges.
struct Limits {
    /// Passes in which the deviation allowed grows to the whole: what is flat goes first.
    ramp: u32,
    /// Most passes.
    passes: u32,
    /// Share of its corners that a pass has to remove for another one to follow.
    worth: f64,
    /// Least cosine by which a triangle may turn when an edge beside it vanishes.
    turn: f64,
    /// Least height of a new triangle relative to its longest edge, unless it was flatter before.
    height: f64,
}

const LIMITS: Limits = Limits { ramp: 4, passes: 40, worth: 0.02, turn: 0.5, height: 0.02 };

/// Squared distances to planes, weighted by areas: the upper half of a symmetric matrix, and the sum of the weights.
#[derive(Clone, Copy, Default)]
struct Quadric {
    m: [f64; 10],
    weight: f64,
}

impl Quadric {
    fn from_triangle([a, b, c]: [DVec3; 3]) -> Self {
        let normal = (b - a).cross(c - a);
        let Some(n) = normal.try_normalize() else { return Self::default() };
        let ([x, y, z], d, weight) = (n.to_array(), -n.dot(a), 0.5 * normal.length());
        let m = [x * x, x * y, x * z, x * d, y * y, y * z, y * d, z * z, z * d, d * d];
        Self { m: m.map(|v| weight * v), weight }
    }

    fn plus(mut self, other: &Self) -> Self {
        self.m.iter_mut().zip(other.m).for_each(|(a, b)| *a += b);
        self.weight += other.weight;
        self
    }

    /// Returns the mean of the squared distances of a point.
    fn error(&self, p: DVec3) -> f64 {
        let [xx, xy, xz, xd, yy, yz, yd, zz, zd, dd] = self.m;
        let squares = xx * p.x * p.x + yy * p.y * p.y + zz * p.z * p.z + dd;
        let mixed = xy * p.x * p.y + xz * p.x * p.z + yz * p.y * p.z + xd * p.x + yd * p.y + zd * p.z;
        if self.weight > 0.0 { ((squares + 2.0 * mixed) / self.weight).max(0.0) } else { 0.0 }
    }
}

/// A surface while its edges vanish.
struct Surface {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    quadrics: Vec<Quadric>,
    /// Triangles around each corner, one corner after another, and the first of each.
    around: Vec<u32>,
    first: Vec<u32>,
    /// Corners with a neighbour that changed in this pass.
    changed: Vec<bool>,
}

/// Removes edges of a closed, two-manifold surface (Garland and Heckbert 1997, with the corners of an edge and its middle as
/// places).
///
/// Guaranteed: the surface stays closed, two-manifold and of the same genus; each corner that was moved lies, by the root of the
/// mean square over their area, at most `deviation_m` from the planes of the triangles that it replaces; corners that `is_fixed`
/// accepts stay; the same bits for equal input. Cost: a few passes over all triangles.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn simplify(
    mesh: &mut TriMesh,
    deviation_m: f64,
    is_fixed: impl Fn([f32; 3]) -> bool,
    run: &Run<'_>,
) -> Result<(), Cancelled> {
    let (positions, triangles) = (std::mem::take(&mut mesh.positions), std::mem::take(&mut mesh.triangles));
    let fixed: Vec<bool> = positions.iter().map(|p| is_fixed(*p)).collect();
    let count = positions.len();
    let mut surface = Surface {
        positions,
        triangles,
        quadrics: vec![Quadric::default(); count],
        around: Vec::new(),
        first: Vec::new(),
        changed: Vec::new(),
    };
    surface.measure();
    let mut corners = count;
    for pass in 1..=LIMITS.passes {
        run.cancel.check()?;
        let allowed = deviation_m * (f64::from(pass) / f64::from(LIMITS.ramp)).min(1.0);
        let gone = surface.pass(allowed * allowed, &fixed);
        if pass >= LIMITS.ramp && (gone as f64) < LIMITS.worth * corners as f64 {
            break;
        }
        corners -= gone;
    }
    *mesh = surface.compact();
    Ok(())
}

impl Surface {
    fn point(&self, corner: u32) -> DVec3 {
        DVec3::from_array(self.positions[corner as usize].map(f64::from))
    }

    /// Sets the quadrics of all corners.
    fn measure(&mut self) {
        for row in 0..self.triangles.len() {
            let t = self.triangles[row];
            let own = Quadric::from_triangle(t.map(|c| self.point(c)));
            for corner in t {
                let sum = &mut self.quadrics[corner as usize];
                *sum = sum.plus(&own);
            }
        }
    }

    /// Finds the triangles around each corner.
    fn index(&mut self) {
        let count = self.positions.len();
        self.first.clear();
        self.first.resize(count + 1, 0);
        for &corner in self.triangles.as_flattened() {
            self.first[corner as usize + 1] += 1;
        }
        for k in 0..count {
            self.first[k + 1] += self.first[k];
        }
        self.around.clear();
        self.around.resize(3 * self.triangles.len(), 0);
        let mut next = self.first.clone();
        for (row, t) in (0..).zip(&self.triangles) {
            for &corner in t {
                let slot = &mut next[corner as usize];
                self.around[*slot as usize] = row;
                *slot += 1;
            }
        }
        self.changed.clear();
        self.changed.resize(count, false);
    }

    /// Returns the triangles around a corner that has not changed.
    fn fan(&self, corner: u32) -> &[u32] {
        let corner = corner as usize;
        &self.around[self.first[corner] as usize..self.first[corner + 1] as usize]
    }

    /// Returns the neighbours of a corner that has not changed: in a closed surface, as many as triangles.
    fn ring(&self, corner: u32) -> Vec<u32> {
        let after = |row: &u32| {
            let t = self.triangles[*row as usize];
            let at = t.iter().position(|c| *c == corner).unwrap_or(0);
            t[(at + 1) % 3]
        };
        self.fan(corner).iter().map(after).collect()
    }

    /// Lets edges vanish that are not beside one another; returns how many did.
    fn pass(&mut self, allowed: f64, fixed: &[bool]) -> usize {
        self.index();
        let mut gone = 0;
        for row in 0..self.triangles.len() {
            let t = self.triangles[row];
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                let free = |c: u32| !self.changed[c as usize] && !fixed[c as usize];
                // Each edge is met twice, once in each direction.
                if a < b && free(a) && free(b) && self.collapse(a, b, allowed) {
                    gone += 1;
                    break;
                }
            }
        }
        self.triangles.retain(|t| t[0] != t[1]);
        gone
    }

    /// Joins two neighbours if the surface allows it.
    fn collapse(&mut self, a: u32, b: u32, allowed: f64) -> bool {
        let sum = self.quadrics[a as usize].plus(&self.quadrics[b as usize]);
        let Some(place) = self.place(a, b, &sum, allowed) else { return false };
        let (near, far) = (self.ring(a), self.ring(b));
        let shared: Vec<u32> = near.iter().copied().filter(|c| far.contains(c)).collect();
        // The surface stays two-manifold if nothing but the two triangles beside the edge joins its ends (Dey et al. 1999), and
        // a corner keeps three triangles.
        let [c, d] = shared[..] else { return false };
        let keeps = |c: u32| !self.changed[c as usize] && self.fan(c).len() > 3;
        if !keeps(c) || !keeps(d) || near.len() + far.len() < 7 {
            return false;
        }
        let to = DVec3::from_array(place.map(f64::from));
        if !self.keeps_shape(a, b, to) || !self.keeps_shape(b, a, to) {
            return false;
        }
        let range = self.first[b as usize] as usize..self.first[b as usize + 1] as usize;
        for &row in &self.around[range] {
            let t = &mut self.triangles[row as usize];
            // A triangle with both ends vanishes: it is marked by two equal corners.
            *t = if t.contains(&a) { [0; 3] } else { t.map(|c| if c == b { a } else { c }) };
        }
        (self.positions[a as usize], self.quadrics[a as usize]) = (place, sum);
        for corner in near.into_iter().chain(far) {
            self.changed[corner as usize] = true;
        }
        true
    }

    /// Returns the place of the corner that replaces two: the best of theirs and their middle, if it deviates little enough.
    fn place(&self, a: u32, b: u32, sum: &Quadric, allowed: f64) -> Option<[f32; 3]> {
        let (p, q) = (self.point(a), self.point(b));
        let mut best: Option<(f64, [f32; 3])> = None;
        for place in [0.5 * (p + q), p, q] {
            #[expect(clippy::cast_possible_truncation, reason = "meshes are f32 by design")]
            let rounded = place.to_array().map(|x| x as f32);
            let error = sum.error(DVec3::from_array(rounded.map(f64::from)));
            if error <= allowed && best.is_none_or(|(least, _)| error < least) {
                best = Some((error, rounded));
            }
        }
        best.map(|(_, place)| place)
    }

    /// Whether the triangles around a corner, without those that it shares with `other`, keep their side and some height when it
    /// moves.
    fn keeps_shape(&self, corner: u32, other: u32, to: DVec3) -> bool {
        self.fan(corner).iter().map(|row| self.triangles[*row as usize]).all(|t| {
            if t.contains(&other) {
                return true;
            }
            let before = t.map(|c| self.point(c));
            let after = t.map(|c| if c == corner { to } else { self.point(c) });
            let [(old, old_height), (new, height)] = [before, after].map(normal_and_height);
            let turned = old.dot(new) >= LIMITS.turn * old.length() * new.length();
            turned && height > 0.0 && height >= LIMITS.height.min(old_height)
        })
    }

    /// Returns the mesh without unused corners.
    fn compact(self) -> TriMesh {
        let mut new = vec![u32::MAX; self.positions.len()];
        let mut positions = Vec::new();
        let mut triangles = self.triangles;
        for corner in triangles.as_flattened_mut() {
            let slot = &mut new[*corner as usize];
            if *slot == u32::MAX {
                *slot = u32::try_from(positions.len()).unwrap_or(u32::MAX);
                positions.push(self.positions[*corner as usize]);
            }
            *corner = *slot;
        }
        TriMesh { positions, triangles, ..TriMesh::default() }
    }
}

/// Returns the normal of a triangle, twice its area long, and its height relative to its longest edge.
fn normal_and_height([a, b, c]: [DVec3; 3]) -> (DVec3, f64) {
    let normal = (b - a).cross(c - a);
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    (normal, if longest > 0.0 { normal.length() / longest } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Makes a sphere of radius 1 about the origin, closed, of `2 * n * (n - 1)` triangles for each half.
    fn sphere(n: u32) -> TriMesh {
        let mut mesh = TriMesh { positions: vec![[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]], ..TriMesh::default() };
        let corner = |ring: u32, k: u32| 2 + (ring - 1) * 2 * n + k % (2 * n);
        for ring in 1..n {
            let (sin, cos) = base::ops::sin_cos(base::ops::PI * f64::from(ring) / f64::from(n));
            for k in 0..2 * n {
                let (s, c) = base::ops::sin_cos(base::ops::PI * f64::from(k) / f64::from(n));
                mesh.positions.push(DVec3::new(sin * c, cos, sin * s).as_vec3().to_array());
            }
        }
        for k in 0..2 * n {
            mesh.triangles.push([0, corner(1, k + 1), corner(1, k)]);
            mesh.triangles.push([1, corner(n - 1, k), corner(n - 1, k + 1)]);
            for ring in 1..n - 1 {
                let [a, b] = [corner(ring, k), corner(ring, k + 1)];
                let [c, d] = [corner(ring + 1, k), corner(ring + 1, k + 1)];
                mesh.triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
        mesh
    }

    /// Fails unless each edge has two triangles in opposite directions; returns Euler's number.
    fn closed(mesh: &TriMesh) -> i64 {
        let mut edges: BTreeMap<[u32; 2], i32> = BTreeMap::new();
        for t in &mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                *edges.entry([a.min(b), a.max(b)]).or_insert(0) += if a < b { 1 } else { 1000 };
            }
        }
        assert!(edges.values().all(|n| *n == 1001), "closed and two-manifold");
        mesh.positions.len() as i64 - edges.len() as i64 + mesh.triangles.len() as i64
    }

    fn volume(mesh: &TriMesh) -> f64 {
        let point = |i: u32| DVec3::from(mesh.positions[i as usize].map(f64::from));
        mesh.triangles.iter().map(|t| point(t[0]).dot(point(t[1]).cross(point(t[2]))) / 6.0).sum()
    }

    #[test]
    fn a_sphere_keeps_its_form_with_a_tenth_of_its_triangles() {
        let whole = sphere(96);
        let (before, full) = (whole.triangles.len(), volume(&whole));
        assert_eq!(closed(&whole), 2);
        let mut mesh = whole.clone();
        simplify(&mut mesh, 0.01, |_| false, &Run::plain()).expect("simpler");
        assert_eq!(closed(&mesh), 2);
        let now = mesh.triangles.len();
        assert!(10 * now < before && now > 100, "{now} of {before}");
        let radii = mesh.positions.iter().map(|p| DVec3::from(p.map(f64::from)).length());
        assert!(
            radii.clone().all(|r| (r - 1.0).abs() < 0.03),
            "{:?}",
            radii.map(|r| (r - 1.0).abs()).fold(0.0, f64::max)
        );
        assert!((volume(&mesh) / full - 1.0).abs() < 0.03, "{} of {full}", volume(&mesh));
        let mut again = whole;
        simplify(&mut again, 0.01, |_| false, &Run::plain()).expect("simpler");
        assert_eq!(again, mesh);
    }

    #[test]
    fn fixed_corners_stay_and_no_deviation_changes_nothing() {
        let whole = sphere(24);
        let mut mesh = whole.clone();
        simplify(&mut mesh, 0.05, |p| p[1] < 0.0, &Run::plain()).expect("simpler");
        assert_eq!(closed(&mesh), 2);
        let below = |mesh: &TriMesh| mesh.positions.iter().filter(|p| p[1] < 0.0).count();
        let above = |mesh: &TriMesh| mesh.positions.iter().filter(|p| p[1] > 0.1).count();
        assert_eq!(below(&mesh), below(&whole));
        assert!(2 * above(&mesh) < above(&whole), "{} of {}", above(&mesh), above(&whole));
        let mut same = whole.clone();
        simplify(&mut same, 0.0, |_| false, &Run::plain()).expect("simpler");
        assert_eq!(same.triangles.len(), whole.triangles.len());
    }

    #[test]
    fn the_least_body_stays() {
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mut mesh = TriMesh { positions, triangles, ..TriMesh::default() };
        simplify(&mut mesh, 10.0, |_| false, &Run::plain()).expect("a body");
        assert_eq!((mesh.triangles.len(), closed(&mesh)), (4, 2));
    }
}
