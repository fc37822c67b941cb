//! Triangulates rings: sides, closed ends, texture coordinates.

use base::ops;
use glam::DVec3;
use mesh::TriMesh;

use crate::rings::Ring;

/// Returns a vertex count as the index of the next vertex.
pub(crate) fn index(n: usize) -> u32 {
    // Four billion vertices do not fit in memory: saturating keeps the arithmetic whole, validate() names it.
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// Cosines and sines of the corners of a regular polygon; the last repeats the first.
#[derive(Debug)]
pub(crate) struct Circle(pub Vec<(f64, f64)>);

impl Circle {
    pub(crate) fn new(sides: u32) -> Self {
        let n = sides.clamp(3, 64);
        let corner = |i: u32| {
            let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(i % n) / f64::from(n));
            (cos, sin)
        };
        Self((0..=n).map(corner).collect())
    }

    pub(crate) fn sides(&self) -> usize {
        self.0.len() - 1
    }
}

/// Ribs along a tube, with furrows between that are cut into its circle. The first column lies in a furrow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Ribs {
    pub count: u32,
    /// Depth of a furrow relative to the radius.
    pub depth: f64,
}

impl Ribs {
    /// Returns the number of sides of a regular polygon whose faces lie as deep as the furrows; `None` without ribs.
    pub(crate) fn faces(self) -> Option<u32> {
        let turn = ops::acos_clamped(1.0 - self.depth).max(1e-3);
        (self.count > 0).then(|| ops::whole((ops::PI / turn).floor()).max(3))
    }

    /// Returns, by the angle around the tube, the radius relative to that of the circle, and the lean of the normal
    /// around it.
    fn radius_and_lean(self, angle: f64, share: f64) -> (f64, f64) {
        let depth = self.depth * share;
        let (sin, cos) = ops::sin_cos(angle * f64::from(self.count));
        let radius = 1.0 - 0.5 * depth * (1.0 + cos);
        (radius, -0.5 * depth * f64::from(self.count) * sin / radius)
    }
}

/// Writes rows of vertices one after another and joins each to the one before.
pub(crate) struct Sleeve<'a> {
    pub mesh: &'a mut TriMesh,
    circle: &'a Circle,
    ribs: Ribs,
    repeats: f64,
    /// Texture coordinate along the tube, at the last row.
    v: f64,
    /// First vertex and centre of the last row.
    last: Option<(u32, DVec3)>,
}

pub(crate) fn wide(p: [f32; 3]) -> DVec3 {
    DVec3::from(p.map(f64::from))
}

#[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in the mesh, by design")]
pub(crate) fn narrow(p: DVec3) -> [f32; 3] {
    [p.x as f32, p.y as f32, p.z as f32]
}

#[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in the mesh, by design")]
pub(crate) fn narrow2(u: f64, v: f64) -> [f32; 2] {
    [u as f32, v as f32]
}

impl<'a> Sleeve<'a> {
    pub(crate) fn new(mesh: &'a mut TriMesh, circle: &'a Circle, repeats: u32) -> Self {
        let ribs = Ribs::default();
        Self { mesh, circle, ribs, repeats: f64::from(repeats.max(1)), v: 0.0, last: None }
    }

    /// Adds ribs, four to each repetition of the texture.
    pub(crate) fn ribbed(self, ribs: Ribs) -> Self {
        let repeats = if ribs.count > 0 { 0.25 * f64::from(ribs.count) } else { self.repeats };
        Self { ribs, repeats, ..self }
    }

    /// Returns, by the column of a ring, the radius relative to that of the ring, and the normal, given the ray, the
    /// normal of the plain tube and the share of the depth of the furrows.
    fn corner(&self, ring: &Ring, column: usize, (ray, normal): (DVec3, DVec3), share: f64) -> (f64, DVec3) {
        if self.ribs.count == 0 {
            return (1.0, normal);
        }
        #[expect(clippy::cast_precision_loss, reason = "at most 64")]
        let angle = ops::TAU * column as f64 / self.sides();
        let (radius, lean) = self.ribs.radius_and_lean(angle, share);
        (radius, normal + ring.tangent.cross(ray) * lean)
    }

    fn vertex(&mut self, p: DVec3, normal: DVec3, u: f64, v: f64) -> u32 {
        let i = self.mesh.push(p);
        self.mesh.normals.push(narrow(normal.try_normalize().unwrap_or(DVec3::Y)));
        self.mesh.uvs.push(narrow2(u, v));
        i
    }

    /// Adds the last vertex of a row: its first again, at the opposite edge of the texture.
    fn seam(&mut self, first: u32, u: f64, v: f64) {
        let (p, n) = (self.mesh.positions[first as usize], self.mesh.normals[first as usize]);
        self.mesh.positions.push(p);
        self.mesh.normals.push(n);
        self.mesh.uvs.push(narrow2(u, v));
    }

    /// Advances the texture by a step along a tube of this radius.
    fn advance(&mut self, centre: DVec3, radius: f64) {
        if let Some((_, before)) = self.last {
            self.v += centre.distance(before) * self.repeats / (ops::TAU * radius.max(1e-12));
        }
    }

    /// Adds a row from its corners (`sides + 1`, the last equal to the first) and their normals.
    pub(crate) fn row(&mut self, centre: DVec3, radius: f64, corners: &[DVec3], normals: &[DVec3]) {
        self.advance(centre, radius);
        let first = self.next();
        let v = self.v;
        let du = self.repeats / self.sides();
        let mut u = 0.0;
        for (p, n) in corners.iter().zip(normals) {
            self.vertex(*p, *n, u, v);
            u += du;
        }
        self.join(first, centre);
    }

    fn sides(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "at most 64")]
        let n = self.circle.sides() as f64;
        n
    }

    fn next(&self) -> u32 {
        index(self.mesh.positions.len())
    }

    /// Adds one row per ring.
    pub(crate) fn rings(&mut self, rings: &[Ring]) {
        let circle = self.circle;
        let du = self.repeats / self.sides();
        // Towards a thin tip the texture would be squeezed without bound: it follows down to a quarter of the first
        // radius.
        let floor = rings.first().map_or(0.0, |r| 0.25 * r.radius);
        // A tube on a bearer is round there: its first ring is the top of its fillet.
        let round = if self.last.is_some() { 0 } else { usize::MAX };
        for (row, ring) in rings.iter().enumerate() {
            self.advance(ring.centre, ring.radius.max(floor));
            let first = self.next();
            let (v, mut u) = (self.v, 0.0);
            let share = if row == round { 0.0 } else { 1.0 };
            for (column, corner) in circle.0[..circle.sides()].iter().enumerate() {
                let ray = ring.ray(*corner);
                let (wide, normal) = self.corner(ring, column, (ray, ring.normal(ray)), share);
                self.vertex(ring.centre + ray * (ring.radius * wide), normal, u, v);
                u += du;
            }
            self.seam(first, u, v);
            self.join(first, ring.centre);
        }
    }

    fn join(&mut self, first: u32, centre: DVec3) {
        if let Some((a, _)) = self.last {
            for j in 0..index(self.circle.sides()) {
                self.mesh.triangles.push([a + j, a + j + 1, first + j]);
                self.mesh.triangles.push([a + j + 1, first + j + 1, first + j]);
            }
        }
        self.last = Some((first, centre));
    }

    /// Adds a flat disc that closes the tube behind its first ring; its rim has normals of its own.
    pub(crate) fn flat_base(&mut self, ring: &Ring) {
        let circle = self.circle;
        let normal = -ring.tangent;
        let apex = self.vertex(ring.centre, normal, 0.5, 0.5);
        for (column, &(cos, sin)) in circle.0[..circle.sides()].iter().enumerate() {
            let ray = ring.ray((cos, sin));
            let wide = self.corner(ring, column, (ray, normal), 1.0).0;
            let p = ring.centre + ray * (ring.radius * wide);
            self.vertex(p, normal, 0.5 + 0.5 * cos, 0.5 + 0.5 * sin);
        }
        let n = index(circle.sides());
        for j in 0..n {
            self.mesh.triangles.push([apex, apex + 1 + (j + 1) % n, apex + 1 + j]);
        }
    }

    /// Adds a cone that closes the tube behind the last row, its point at `apex`: for ends that are hidden inside
    /// another tube.
    pub(crate) fn hidden_base(&mut self, apex: DVec3, normal: DVec3) {
        let Some((first, _)) = self.last else { return };
        let tip = self.vertex(apex, normal, 0.5 * self.repeats, self.v);
        for j in 0..index(self.circle.sides()) {
            self.mesh.triangles.push([tip, first + j + 1, first + j]);
        }
    }

    /// Adds a row beyond the last ring: its width and its distance relative to the radius, with normals that lean from
    /// the ray towards the tangent by an angle; each corner has an additional offset of its own.
    pub(crate) fn beyond(&mut self, end: &Ring, (width, rise, lean): (f64, f64, f64), further: &[f64]) {
        let circle = self.circle;
        let du = self.repeats / self.sides();
        let centre = end.centre + end.tangent * (rise * end.radius);
        self.advance(centre, end.radius);
        let first = self.next();
        let (v, mut u) = (self.v, 0.0);
        let (sin, cos) = ops::sin_cos(lean);
        for (column, (corner, further)) in circle.0.iter().zip(further).enumerate() {
            let ray = end.ray(*corner);
            let wide = self.corner(end, column, (ray, ray), 1.0).0;
            let p = centre + (ray * (wide * width) + end.tangent * *further) * end.radius;
            self.vertex(p, ray * cos + end.tangent * sin, u, v);
            u += du;
        }
        self.seam(first, u, v);
        self.join(first, centre);
    }

    /// Closes the tube behind the last row, at `apex`.
    pub(crate) fn close(&mut self, apex: DVec3, normal: DVec3) {
        let Some((first, _)) = self.last else { return };
        let du = self.repeats / self.sides();
        // One apex vertex per side: a single one would smear the texture around the point.
        for j in 0..index(self.circle.sides()) {
            let tip = self.vertex(apex, normal, du * (f64::from(j) + 0.5), self.v);
            self.mesh.triangles.push([first + j, first + j + 1, tip]);
        }
    }

    /// Closes the tube with `rows` shrinking rows and an apex, nine tenths of a ball.
    pub(crate) fn round_tip(&mut self, end: &Ring, rows: u32) {
        let circle = self.circle;
        let du = self.repeats / self.sides();
        for k in 1..=rows {
            let (sin, cos) = ops::sin_cos(ops::FRAC_PI_2 * f64::from(k) / f64::from(rows + 1));
            let centre = end.centre + end.tangent * (0.9 * end.radius * sin);
            self.advance(centre, end.radius);
            let first = self.next();
            let (v, mut u) = (self.v, 0.0);
            for (column, corner) in circle.0[..circle.sides()].iter().enumerate() {
                let ray = end.ray(*corner);
                let (wide, normal) = self.corner(end, column, (ray, ray), 1.0);
                let out = ray * (end.radius * wide * cos);
                self.vertex(centre + out, normal * cos + end.tangent * sin, u, v);
                u += du;
            }
            self.seam(first, u, v);
            self.join(first, centre);
        }
        let apex = end.centre + end.tangent * (0.9 * end.radius);
        self.advance(apex, end.radius);
        self.close(apex, end.tangent);
    }
}

/// Removes triangles two of whose corners coincide once rounded to the mesh's precision.
pub(crate) fn drop_flat(mesh: &mut TriMesh) {
    let p = &mesh.positions;
    mesh.triangles.retain(|&[a, b, c]| {
        let (a, b, c) = (p[a as usize], p[b as usize], p[c as usize]);
        a != b && b != c && c != a
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ribs_are_cut_into_the_circle_and_their_normals_stand_on_them() {
        let ribs = Ribs { count: 12, depth: 0.2 };
        let r = |angle: f64| ribs.radius_and_lean(angle, 1.0).0;
        assert!((r(0.0) - 0.8).abs() < 1e-12 && (r(ops::PI / 12.0) - 1.0).abs() < 1e-12);
        assert_eq!(
            (ribs.radius_and_lean(0.3, 0.0).0, ribs.faces(), Ribs::default().faces()),
            (1.0, Some(4), None)
        );
        for k in 0..40 {
            let angle = 0.05 * f64::from(k);
            let at = |a: f64| {
                let (sin, cos) = ops::sin_cos(a);
                DVec3::new(cos, sin, 0.0)
            };
            let along = at(angle + 1e-6) * r(angle + 1e-6) - at(angle - 1e-6) * r(angle - 1e-6);
            let normal = at(angle) + DVec3::Z.cross(at(angle)) * ribs.radius_and_lean(angle, 1.0).1;
            assert!(along.normalize().dot(normal.normalize()).abs() < 1e-6, "{angle}");
        }
    }
}
