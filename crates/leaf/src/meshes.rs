//! Leaf -> triangles: tubes of the veins, grid of the blade, at any resolution.

use geom::{BallBSpline, EndCap, RingRule, TubeSpec};
use glam::DVec3;
use mesh::TriMesh;

use crate::blade::{Leaf, Vein, samples};
use crate::flat::FlatLeaf;

/// How finely a leaf is meshed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshSpec {
    /// Parts of each span between marks, 1 to 64. Default 5, as in the paper's Table 1.
    pub subdivisions: usize,
    /// Points of each ring of a vein, 3 to 64. Default 10, as in the paper's Table 1.
    pub sides: usize,
    /// Plain rings (paper) or the exact envelope of the balls.
    pub rings: RingRule,
    /// Round ends of the veins; the paper's are open.
    pub caps: bool,
    /// A vein along the margin too; the paper draws it and does not count it.
    pub margin: bool,
}

impl Default for MeshSpec {
    fn default() -> Self {
        Self { subdivisions: 5, sides: 10, rings: RingRule::Plain, caps: false, margin: false }
    }
}

impl MeshSpec {
    /// About how many triangles a leaf with so many rows of marks has, from the numbers of Table 1.
    pub fn triangles(&self, rows: usize) -> u64 {
        let [rows, steps, sides] =
            [rows, self.subdivisions.clamp(1, 64), self.sides.clamp(3, 64)].map(|n| n as u64);
        // Of 7 spans of veins (9 with the margin) and 6 columns of the blade a row, two a quad.
        let spans = if self.margin { 9 } else { 7 };
        2 * rows * (spans * steps * sides + 6 * steps * steps)
    }
}

/// The triangles of a leaf.
///
/// With the default [`MeshSpec`] and N rows of marks: the veins have `10 (36 N + 1)` vertices and `350 N` quads,
/// the blade `(5 N + 1) * 31` vertices and `150 N` quads (paper 004, Table 1). Triangles are two a quad, but
/// one at the tip, where a row of the blade is one point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafMesh {
    /// All veins.
    pub veins: TriMesh,
    /// The blade, with texture coordinates of the [`FlatLeaf`].
    pub blade: TriMesh,
    /// Quads (and triangles of caps) of the veins.
    pub vein_faces: usize,
    /// Quads of the blade.
    pub blade_faces: usize,
    /// Rings whose ball lies inside its neighbours; only with [`RingRule::Envelope`].
    pub swallowed: usize,
    /// Rings at which a vein is thicker than it bends, so that its surface cuts itself.
    pub crossing: usize,
}

impl Leaf {
    /// The triangles of the leaf. Cost: linear in their number.
    pub fn mesh(&self, spec: &MeshSpec) -> LeafMesh {
        let steps = spec.subdivisions.clamp(1, 64);
        let mut out = LeafMesh::default();
        let mut veins = vec![&self.midrib];
        veins.extend(&self.sides);
        if spec.margin {
            veins.extend(&self.margins);
        }
        for vein in veins {
            out.add_vein(vein, steps, spec);
        }
        self.blade_mesh(steps, &mut out);
        out
    }

    /// The parameters u of the columns of a grid with `steps` parts a span.
    pub(crate) fn grid_u(&self, steps: usize) -> Vec<f64> {
        samples(self.blade.columns_at(), steps)
    }

    /// The parameters v of the rows of a grid with `steps` parts a span.
    pub(crate) fn grid_v(&self, steps: usize) -> Vec<f64> {
        samples(self.blade.rows_at(), steps)
    }

    fn blade_mesh(&self, steps: usize, out: &mut LeafMesh) {
        let (us, vs) = (self.grid_u(steps), self.grid_v(steps));
        let wide = us.len();
        let points = self.blade.grid(&us, &vs);
        let flat = FlatLeaf::of_grid(&points, wide, steps);
        let mesh = &mut out.blade;
        let mut normals = vec![DVec3::Z; points.len()];
        for (k, p) in points.iter().enumerate() {
            // Where the surface is pinched (the tip) the row below knows the direction.
            normals[k] = p.normal.unwrap_or_else(|| {
                let (j, i) = (k % wide, k / wide);
                let v = vs[i] - 1e-3 * (vs[vs.len() - 1] - vs[0]);
                let below = i.checked_sub(1).map_or(DVec3::Z, |i| normals[i * wide + j]);
                self.blade.at(us[j], v).normal.unwrap_or(below)
            });
            mesh.push(p.position);
            mesh.normals.push(narrow(normals[k]));
            mesh.uvs.push(flat.uv(k));
        }
        let index = |i: usize| u32::try_from(i).unwrap_or(u32::MAX);
        // 1e-9 of the leaf: the tip's row is one point but for rounding.
        let near = 1e-9 * flat.extent().1.length();
        for i in 1..vs.len() {
            for j in 1..wide {
                let (a, b) = ((i - 1) * wide + j - 1, (i - 1) * wide + j);
                let [a, b, c, d] = [a, b, b + wide, a + wide];
                let one = |x: usize, y: usize| points[x].position.distance(points[y].position) < near;
                let mut put = |t: [usize; 3]| mesh.triangles.push(t.map(index));
                // At the tip both upper corners are one point in space.
                if !one(a, b) {
                    put([a, b, c]);
                }
                if !one(c, d) {
                    put([a, c, d]);
                }
                out.blade_faces += 1;
            }
        }
    }
}

impl LeafMesh {
    fn add_vein(&mut self, vein: &Vein, steps: usize, spec: &MeshSpec) {
        let cap = if spec.caps { EndCap::Round(3) } else { EndCap::Open };
        let sides = spec.sides.clamp(3, 64);
        let tube = TubeSpec { rings: spec.rings, sides, cap, first_normal: None };
        self.add_tube(&vein.curve, &samples(&vein.marks, steps), &tube);
    }

    pub(crate) fn add_tube(&mut self, curve: &BallBSpline, at: &[f64], spec: &TubeSpec) {
        let tube = curve.tube(at, spec);
        let mut mesh = TriMesh::default();
        for (&p, &n) in tube.positions.iter().zip(&tube.normals) {
            mesh.push(p);
            mesh.normals.push(narrow(n));
        }
        mesh.triangles.extend(tube.quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]));
        mesh.triangles.extend(&tube.triangles);
        self.veins.append(&mesh);
        self.vein_faces += tube.faces();
        self.swallowed += tube.swallowed;
        self.crossing += tube.crossing;
    }
}

#[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in the mesh, by design")]
pub(crate) fn narrow(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

#[cfg(test)]
mod tests {
    use base::Report;

    use super::*;
    use crate::LeafSpec;
    use crate::blade::SurfaceKind;
    use crate::marks::tests::sample;

    #[test]
    fn counts_are_those_of_the_papers_table_1() {
        for (n, veins, blade) in [
            (10, (3610, 3500), (1581, 1500)),
            (17, (6130, 5950), (2666, 2550)),
            (14, (5050, 4900), (2201, 2100)),
        ] {
            for surface in SurfaceKind::ALL {
                let marks = sample(n).complete(&mut Report::default()).unwrap();
                let leaf = Leaf::new(&marks, &LeafSpec { surface, ..LeafSpec::default() }).unwrap();
                let mesh = leaf.mesh(&MeshSpec::default());
                assert_eq!((mesh.veins.positions.len(), mesh.vein_faces), veins, "{n} {surface:?}");
                assert_eq!((mesh.blade.positions.len(), mesh.blade_faces), blade, "{n} {surface:?}");
                let foreseen = MeshSpec::default().triangles(n);
                assert_eq!(foreseen, 2 * (veins.1 + blade.1) as u64);
                assert_eq!(mesh.blade.triangles.len(), 2 * blade.1 - 30, "one triangle a quad at the tip");
                assert_eq!(mesh.veins.validate().chain(mesh.blade.validate()).next(), None);
            }
        }
    }

    #[test]
    fn resolution_and_extras_change_counts_as_expected() {
        let marks = sample(4).complete(&mut Report::default()).unwrap();
        let leaf = Leaf::new(&marks, &LeafSpec::default()).unwrap();
        let spec = MeshSpec { subdivisions: 2, sides: 6, caps: true, margin: true, ..MeshSpec::default() };
        let mesh = leaf.mesh(&spec);
        let veins = 1 + 4 + 2;
        let rings = 3 * (2 * 4 + 1) + 4 * (2 * 6 + 1);
        assert_eq!(mesh.veins.positions.len(), 6 * rings + veins * 2 * (2 * 6 + 1));
        assert_eq!(mesh.blade.positions.len(), 9 * 13);
        let upper = mesh.blade.normals.iter().filter(|n| n[2] > 0.0).count();
        assert_eq!(upper, 9 * 13, "all normals point to the upper side");
    }
}
