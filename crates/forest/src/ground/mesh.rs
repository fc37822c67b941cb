//! Triangles as the ground of a stand.

use base::{Counted, Run};
use glam::{DVec2, DVec3};

use super::GroundError;

/// Triangles by the cells of a grid over them.
///
/// If several lie above one another, trees stand on the highest.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundMesh {
    corners: Vec<[DVec3; 3]>,
    low: DVec2,
    side: f64,
    columns: usize,
    rows: usize,
    /// Start of the triangles of each cell in `order`, and the end of the last.
    starts: Vec<u32>,
    order: Vec<u32>,
}

/// Most cells that a triangle may cross on average: a mesh of slivers crosses many.
const MOST_CROSSINGS: usize = 64;

impl GroundMesh {
    /// Builds a ground from vertices and the triangles between them.
    ///
    /// Vertical triangles, and those with vertices that are not finite, are left out. Cost: linear.
    ///
    /// # Errors
    /// [`GroundError`]: no usable triangle, a missing vertex, or more than the budget allows.
    pub fn new(vertices: &[DVec3], triangles: &[[u32; 3]], run: &Run<'_>) -> Result<Self, GroundError> {
        run.budget.check(Counted::Obstacles, triangles.len() as u64, "simplify the ground")?;
        let mut corners: Vec<[DVec3; 3]> = Vec::with_capacity(triangles.len());
        for triangle in triangles {
            let mut three = [DVec3::ZERO; 3];
            for (corner, &k) in three.iter_mut().zip(triangle) {
                let missing = GroundError::Numbers("triangles name vertices that are not there");
                *corner = *vertices.get(k as usize).ok_or(missing)?;
            }
            let area = flat(three[1] - three[0]).perp_dot(flat(three[2] - three[0]));
            if three.iter().all(|c| c.is_finite() && c.abs().max_element() < 1e9) && area.abs() > 0.0 {
                corners.push(three);
            }
        }
        let all = || corners.iter().flatten().map(|c| flat(*c));
        let low = all().fold(DVec2::INFINITY, DVec2::min);
        let high = all().fold(DVec2::NEG_INFINITY, DVec2::max);
        if corners.is_empty() {
            return Err(GroundError::TooSmall(
                "mesh of the ground",
                "one triangle that does not stand upright",
            ));
        }
        let size = (high - low).max(DVec2::splat(1e-6));
        let side = (size.x * size.y / corners.len() as f64).sqrt().max(size.max_element() / 4096.0);
        let count = |length: f64| base::ops::whole((length / side).ceil()).max(1) as usize;
        let (columns, rows) = (count(size.x), count(size.y));
        let mut mesh = Self {
            corners,
            low,
            side,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            order: Vec::new(),
        };
        let cells: usize = (0..mesh.corners.len()).map(|k| mesh.cells(k).count()).sum();
        if cells > MOST_CROSSINGS * mesh.corners.len().max(1024) {
            return Err(GroundError::Numbers("triangles are slivers across the whole: give even ones"));
        }
        for k in 0..mesh.corners.len() {
            let crossed: Vec<usize> = mesh.cells(k).collect();
            crossed.into_iter().for_each(|c| mesh.starts[c + 1] += 1);
        }
        for c in 1..mesh.starts.len() {
            mesh.starts[c] += mesh.starts[c - 1];
        }
        mesh.order = vec![0; cells];
        let mut next = mesh.starts.clone();
        for k in 0..mesh.corners.len() {
            let crossed: Vec<usize> = mesh.cells(k).collect();
            for c in crossed {
                mesh.order[next[c] as usize] = u32::try_from(k).unwrap_or(u32::MAX);
                next[c] += 1;
            }
        }
        Ok(mesh)
    }

    fn cell(&self, p: DVec2) -> (usize, usize) {
        let at = (p - self.low) / self.side;
        let index = |v: f64, count: usize| (base::ops::whole(v) as usize).min(count - 1);
        (index(at.x, self.columns), index(at.y, self.rows))
    }

    /// Returns the cells of the box around a triangle.
    fn cells(&self, triangle: usize) -> impl Iterator<Item = usize> + use<> {
        let points = self.corners[triangle].map(flat);
        let (x0, y0) = self.cell(points[0].min(points[1]).min(points[2]));
        let (x1, y1) = self.cell(points[0].max(points[1]).max(points[2]));
        let columns = self.columns;
        (y0..=y1).flat_map(move |y| (x0..=x1).map(move |x| y * columns + x))
    }

    /// Returns height and normal on the highest triangle at a place.
    pub(super) fn sample(&self, x: f64, z: f64) -> Option<(f64, DVec3)> {
        let p = DVec2::new(x, z);
        let size = DVec2::new(self.columns as f64, self.rows as f64) * self.side;
        let within = p.cmpge(self.low).all() && p.cmple(self.low + size).all();
        let (column, row) = if within { self.cell(p) } else { return None };
        let cell = row * self.columns + column;
        let range = self.starts[cell] as usize..self.starts[cell + 1] as usize;
        let mut best: Option<(f64, DVec3)> = None;
        for &k in &self.order[range] {
            let [a, b, c] = self.corners[k as usize];
            let (u, v, w) = (flat(b - a), flat(c - a), p - flat(a));
            let area = u.perp_dot(v);
            let (s, t) = (w.perp_dot(v) / area, u.perp_dot(w) / area);
            // A place on an edge belongs to both sides, in spite of rounding.
            if s < -1e-9 || t < -1e-9 || s + t > 1.0 + 1e-9 {
                continue;
            }
            let height = a.y + s * (b.y - a.y) + t * (c.y - a.y);
            if best.is_none_or(|(highest, _)| height > highest) {
                let normal = (b - a).cross(c - a).normalize();
                best = Some((height, if normal.y < 0.0 { -normal } else { normal }));
            }
        }
        best
    }
}

fn flat(p: DVec3) -> DVec2 {
    DVec2::new(p.x, p.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ground;

    #[test]
    fn trees_stand_on_the_highest_triangle() {
        let ridge = [
            (0.0, 0.0, 0.0),
            (4.0, 2.0, 0.0),
            (0.0, 0.0, 4.0),
            (4.0, 2.0, 4.0),
            (0.0, 9.0, 0.0),
            (1.0, 9.0, 0.0),
            (0.0, 9.0, 1.0),
        ];
        let vertices = ridge.map(|(x, y, z)| DVec3::new(x, y, z));
        let triangles = [[0, 1, 2], [1, 3, 2], [4, 5, 6], [0, 0, 1]];
        let ground = Ground::Mesh(GroundMesh::new(&vertices, &triangles, &Run::plain()).unwrap());
        assert_eq!(ground.height_m(3.0, 2.0), Some(1.5));
        assert_eq!(ground.height_m(0.25, 0.25), Some(9.0));
        assert!((ground.height_m(2.0, 2.0).unwrap() - 1.0).abs() < 1e-9, "on the edge between two");
        let normal = ground.normal(3.0, 2.0).unwrap();
        assert!(normal.distance(DVec3::new(-0.5, 1.0, 0.0).normalize()) < 1e-12);
        assert_eq!((ground.height_m(4.1, 2.0), ground.height_m(f64::NAN, 0.0)), (None, None));
        assert!(GroundMesh::new(&vertices, &[[0, 1, 9]], &Run::plain()).is_err());
        assert!(GroundMesh::new(&vertices, &[[0, 0, 1]], &Run::plain()).is_err());
    }
}
