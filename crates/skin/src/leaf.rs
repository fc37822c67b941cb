//! Meshes blades that are surfaces: tubes of the veins, grid of the blade, at any resolution.

use geom::{BallBSpline, BallTubeSpec, KdTree, subdivided};
use glam::DVec3;
use mesh::TriMesh;
use plant::{Chart, Netted, Sheet, SplineBlade, VeinShade, Venation};

use crate::LeafMeshSpec;
use crate::sleeve::{narrow, narrow2, wide};

/// The triangles of one shape, in its own frame.
///
/// For a leaf of N rows of marks with the default [`LeafMeshSpec`] the veins have `10 (36 N + 1)` vertices and `350 N`
/// quads, the blade `(5 N + 1) * 31` vertices and `150 N` quads (Wang et al. 2011, Table 1). A quad has two triangles,
/// but one at the tip, where a row of the blade is one point. A blade with a margin of its own consists of triangles,
/// which are then counted instead of quads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShapeMesh {
    /// Its surface; for a leaf the blade.
    pub surface: TriMesh,
    /// The veins of a measured leaf; empty for other shapes.
    pub veins: TriMesh,
    /// Quads (and triangles of caps) of the veins.
    pub vein_faces: usize,
    /// Quads of the blade of a measured leaf.
    pub blade_faces: usize,
    /// Rings whose ball lies inside its neighbours; only with [`geom::RingRule::Envelope`].
    pub swallowed: usize,
    /// Rings at which a vein is thicker than it bends, so that its surface intersects itself.
    pub crossing: usize,
}

impl From<TriMesh> for ShapeMesh {
    fn from(surface: TriMesh) -> Self {
        Self { surface, ..Self::default() }
    }
}

/// Meshes a measured leaf. Cost: linear in its triangles.
pub(crate) fn spline_mesh(blade: &SplineBlade, spec: &LeafMeshSpec) -> ShapeMesh {
    let steps = spec.subdivisions.clamp(1, 64);
    let mut out = ShapeMesh::default();
    out.add_veins(&blade.veins, steps, spec);
    if let Some(net) = blade.netted(steps) {
        out.add_net(&net, blade, steps);
        return out;
    }
    let (us, vs) = blade.grid_at(steps);
    let columns = us.len();
    let points = blade.surface.grid(&us, &vs);
    let flat = (blade.chart == Chart::Unrolled).then(|| plant::FlatLeaf::from_grid(&points, columns, steps));
    let mesh = &mut out.surface;
    for (k, p) in points.iter().enumerate() {
        let (u, v) = (us[k % columns], vs[k / columns]);
        // Where the surface is pinched (base and tip) its neighbourhood gives the direction.
        let inner = v + 1e-3 * (0.5 - v);
        let below = || k.checked_sub(columns).map_or(DVec3::Z, |b| wide(mesh.normals[b]));
        let normal = p.normal.or_else(|| blade.surface.point_at(u, inner).normal).unwrap_or_else(below);
        mesh.push(p.position);
        mesh.normals.push(narrow(normal));
        mesh.uvs.push(flat.as_ref().map_or_else(|| narrow2(u, 1.0 - v), |flat| flat.uv(k)));
        if let Chart::Parameters(shade) = &blade.chart {
            mesh.colors.push(shaded(shade, &blade.veins, p.position, v));
        }
    }
    let size = points.iter().map(|p| p.position.distance(points[0].position)).fold(0.0, f64::max);
    let one = |x: usize, y: usize| points[x].position.distance(points[y].position) < 1e-9 * size;
    for i in 1..vs.len() {
        for j in 1..columns {
            let (a, b) = ((i - 1) * columns + j - 1, (i - 1) * columns + j);
            let [a, b, c, d] = [a, b, b + columns, a + columns];
            let mut put = |t: [usize; 3]| mesh.triangles.push(t.map(crate::sleeve::index));
            // Where a row is one point (tip, joint base) a cell has one triangle.
            if !one(a, b) {
                put([a, b, c]);
            }
            if !one(c, d) {
                put([a, c, d]);
            }
            out.blade_faces += 1;
        }
    }
    out
}

/// Returns the colour of the blade at a place: paler towards the nearest chief vein.
fn shaded(shade: &VeinShade, veins: &Venation, at: DVec3, v: f64) -> [f32; 3] {
    let near = |vein: &plant::Vein| {
        let ball = vein.curve.ball(v);
        (ball.centre.distance(at) - ball.radius).max(0.0)
    };
    let distance = veins.veins.iter().map(near).fold(f64::INFINITY, f64::min);
    #[expect(clippy::cast_possible_truncation, reason = "a colour of the mesh")]
    let share = base::ops::smoothstep(0.0, shade.reach_m, distance) as f32;
    [0, 1, 2].map(|k| shade.vein[k] + (shade.blade[k] - shade.vein[k]) * (0.3 + 0.7 * share))
}

/// Meshes a grid of points; with less `detail` rows and columns are left out.
pub(crate) fn sheet_mesh(sheet: &Sheet, spec: &LeafMeshSpec, detail: f64) -> ShapeMesh {
    let mut out = ShapeMesh::default();
    if sheet.points.len() != sheet.across.len() * sheet.along.len() {
        return out;
    }
    out.add_veins(&sheet.veins, 1, spec);
    let columns = sheet.across.len();
    let (across, along) = (kept(columns, detail), kept(sheet.along.len(), detail));
    let mut thin = Sheet {
        points: Vec::with_capacity(across.len() * along.len()),
        across: across.iter().map(|&j| sheet.across[j]).collect(),
        along: along.iter().map(|&i| sheet.along[i]).collect(),
        colors: Vec::new(),
        veins: Venation::default(),
        form: None,
    };
    for k in along.iter().flat_map(|i| across.iter().map(move |j| i * columns + j)) {
        thin.points.push(sheet.points[k]);
        thin.colors.extend(sheet.colors.get(k));
    }
    let mesh = &mut out.surface;
    for (k, &p) in thin.points.iter().enumerate() {
        mesh.push(p);
        mesh.uvs.push(narrow2(thin.across[k % across.len()], 1.0 - thin.along[k / across.len()]));
    }
    out.blade_faces = across.len().saturating_sub(1) * along.len().saturating_sub(1);
    mesh.triangles.extend(thin.triangles().map(|t| t.map(crate::sleeve::index)));
    mesh.colors = thin.colors;
    if sheet.form.is_some() {
        // Painted like the nearest place of the blade.
        let tree = KdTree::new(&thin.points);
        let uv = |p: &[f32; 3]| tree.nearest(wide(*p), f64::INFINITY).map_or([0.5; 2], |k| mesh.uvs[k]);
        out.veins.uvs = out.veins.positions.iter().map(uv).collect();
    }
    // Cells without area are kept: a bud has the triangles of the bloom.
    mesh.compute_normals();
    out
}

/// Returns evenly spaced ones of `n` rows, so that triangles are in proportion to `detail`; all from 1 on. The first
/// and the last stay.
fn kept(n: usize, detail: f64) -> Vec<usize> {
    let Some(last) = n.checked_sub(1) else { return Vec::new() };
    #[expect(clippy::cast_precision_loss, reason = "rows of a blade")]
    let spans = base::ops::whole((last as f64 * detail.clamp(0.0, 1.0).sqrt()).round()) as usize;
    let spans = spans.clamp(1, last.max(1));
    (0..=spans.min(last)).map(|k| (k * last + spans / 2) / spans).collect()
}

impl ShapeMesh {
    /// Adds a blade within a margin of its own.
    fn add_net(&mut self, net: &Netted, blade: &SplineBlade, steps: usize) {
        let flat = blade.flat(steps);
        let mesh = &mut self.surface;
        for ((&p, &normal), &place) in net.points.iter().zip(&net.normals).zip(&net.flat) {
            mesh.push(p);
            mesh.normals.push(narrow(normal));
            mesh.uvs.push(flat.uv_of(place));
        }
        mesh.triangles.extend(net.triangles.iter().map(|t| t.map(crate::sleeve::index)));
        self.blade_faces = net.triangles.len();
    }

    fn add_veins(&mut self, veins: &Venation, steps: usize, spec: &LeafMeshSpec) {
        let tube = spec.tube();
        for vein in &veins.veins {
            self.add_tube(&vein.curve, &subdivided(&vein.marks, steps), &tube);
        }
        for vein in &veins.fine {
            self.add_tube(&vein.curve, &vein.marks, &tube);
        }
        for vein in veins.margins.iter().filter(|_| spec.margin) {
            self.add_tube(&vein.curve, &subdivided(&vein.marks, steps), &tube);
        }
    }

    fn add_tube(&mut self, curve: &BallBSpline, at: &[f64], spec: &BallTubeSpec) {
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
