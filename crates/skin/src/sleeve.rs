//! Rings -> triangles: sides, closed ends, texture coordinates.

use base::ops;
use glam::DVec3;
use mesh::TriMesh;

use crate::rings::Ring;

/// A vertex count as the index of the next vertex.
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

/// Writes rows of vertices one after another and joins each to the one before.
pub(crate) struct Sleeve<'a> {
    pub mesh: &'a mut TriMesh,
    circle: &'a Circle,
    repeats: f64,
    /// Texture coordinate along, at the last row.
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
        Self { mesh, circle, repeats: f64::from(repeats.max(1)), v: 0.0, last: None }
    }

    fn vertex(&mut self, p: DVec3, normal: DVec3, u: f64, v: f64) -> u32 {
        let i = self.mesh.push(p);
        self.mesh.normals.push(narrow(normal.try_normalize().unwrap_or(DVec3::Y)));
        self.mesh.uvs.push(narrow2(u, v));
        i
    }

    /// The last vertex of a row: its first again, at the other edge of the texture.
    fn seam(&mut self, first: u32, u: f64, v: f64) {
        let (p, n) = (self.mesh.positions[first as usize], self.mesh.normals[first as usize]);
        self.mesh.positions.push(p);
        self.mesh.normals.push(n);
        self.mesh.uvs.push(narrow2(u, v));
    }

    /// Moves the texture on by a step along a tube of this radius.
    fn advance(&mut self, centre: DVec3, radius: f64) {
        if let Some((_, before)) = self.last {
            self.v += centre.distance(before) * self.repeats / (ops::TAU * radius.max(1e-12));
        }
    }

    /// A row from its corners (`sides + 1`, the last equal to the first) and their normals.
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

    /// One row per ring.
    pub(crate) fn rings(&mut self, rings: &[Ring]) {
        let circle = self.circle;
        let du = self.repeats / self.sides();
        // Towards a thin tip the texture would be squeezed without bound: a quarter of the first radius
        // is as far as it follows.
        let floor = rings.first().map_or(0.0, |r| 0.25 * r.radius);
        for ring in rings {
            self.advance(ring.centre, ring.radius.max(floor));
            let first = self.next();
            let (v, mut u) = (self.v, 0.0);
            for corner in &circle.0[..circle.sides()] {
                let ray = ring.ray(*corner);
                self.vertex(ring.centre + ray * ring.radius, ring.normal(ray), u, v);
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

    /// A flat disc that closes the tube behind its first ring; its rim has normals of its own.
    pub(crate) fn flat_base(&mut self, ring: &Ring) {
        let circle = self.circle;
        let normal = -ring.tangent;
        let apex = self.vertex(ring.centre, normal, 0.5, 0.5);
        for &(cos, sin) in &circle.0[..circle.sides()] {
            let p = ring.centre + ring.ray((cos, sin)) * ring.radius;
            self.vertex(p, normal, 0.5 + 0.5 * cos, 0.5 + 0.5 * sin);
        }
        let n = index(circle.sides());
        for j in 0..n {
            self.mesh.triangles.push([apex, apex + 1 + (j + 1) % n, apex + 1 + j]);
        }
    }

    /// A cone that closes the tube behind the last row written, its point at `apex`: for ends that are hidden
    /// inside another tube.
    pub(crate) fn hidden_base(&mut self, apex: DVec3, normal: DVec3) {
        let Some((first, _)) = self.last else { return };
        let tip = self.vertex(apex, normal, 0.5 * self.repeats, self.v);
        for j in 0..index(self.circle.sides()) {
            self.mesh.triangles.push([tip, first + j + 1, first + j]);
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
            for corner in &circle.0[..circle.sides()] {
                let ray = end.ray(*corner);
                self.vertex(centre + ray * (end.radius * cos), ray * cos + end.tangent * sin, u, v);
                u += du;
            }
            self.seam(first, u, v);
            self.join(first, centre);
        }
        let apex = end.centre + end.tangent * (0.9 * end.radius);
        self.advance(apex, end.radius);
        let Some((first, _)) = self.last else { return };
        // One apex vertex per side: a single one would smear the texture around the point.
        for j in 0..index(self.circle.sides()) {
            let tip = self.vertex(apex, end.tangent, du * (f64::from(j) + 0.5), self.v);
            self.mesh.triangles.push([first + j, first + j + 1, tip]);
        }
    }
}

/// Drops triangles two of whose corners coincide once rounded to the mesh's precision.
pub(crate) fn drop_flat(mesh: &mut TriMesh) {
    let p = &mesh.positions;
    mesh.triangles.retain(|&[a, b, c]| {
        let (a, b, c) = (p[a as usize], p[b as usize], p[c as usize]);
        a != b && b != c && c != a
    });
}
