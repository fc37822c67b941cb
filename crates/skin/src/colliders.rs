//! Shapes for collisions: the thickest wood of a plant as convex pieces.

use glam::DVec3;
use mesh::TriMesh;
use plant::{AxisKind, Plant};

use crate::sleeve::narrow;

/// Most pieces of a plant: engines test each against what comes near.
const MOST_PIECES: usize = 64;
/// Share of the volume of the largest piece below which a piece is left out.
const SMALLEST: f64 = 5e-4;
/// Deviation of an axis from a piece, as a share of its radius there, above which the piece is divided.
const STRAIGHT: f64 = 0.75;
/// Least radius of a piece at its thin end, as a share of that at its thick one: a point would have no area.
const LEAST_TAPER: f64 = 0.05;
/// Radius of a hexagon that has the area of a circle of radius 1.
const HEXAGON: f64 = 1.099_636;
/// Corners of a hexagon of radius 1.
const CORNERS: [[f64; 2]; 6] = [
    [1.0, 0.0],
    [0.5, 0.866_025_403_784_438_6],
    [-0.5, 0.866_025_403_784_438_6],
    [-1.0, 0.0],
    [-0.5, -0.866_025_403_784_438_6],
    [0.5, -0.866_025_403_784_438_6],
];

/// A straight piece of wood.
struct Piece {
    ends: [DVec3; 2],
    radii: [f64; 2],
}

impl Piece {
    fn volume(&self) -> f64 {
        let [a, b] = self.radii;
        base::ops::PI / 3.0 * self.ends[0].distance(self.ends[1]) * (a * a + a * b + b * b)
    }

    /// Returns a frustum of six sides, closed, convex and facing outwards.
    fn mesh(&self) -> TriMesh {
        let along = (self.ends[1] - self.ends[0]).normalize();
        let (right, ahead) = along.any_orthonormal_pair();
        let ring = |end: usize| {
            let radius = HEXAGON * self.radii[end];
            CORNERS.map(|[x, y]| narrow(self.ends[end] + (right * x + ahead * y) * radius))
        };
        let mut mesh = TriMesh { positions: [ring(0), ring(1)].concat(), ..TriMesh::default() };
        for k in 0..6_u32 {
            let next = (k + 1) % 6;
            mesh.triangles.extend([[k, next, 6 + next], [k, 6 + next, 6 + k]]);
        }
        for k in 1..5_u32 {
            mesh.triangles.extend([[0, k + 1, k], [6, 6 + k, 7 + k]]);
        }
        mesh.compute_normals();
        mesh
    }
}

/// Returns shapes for collisions with a plant's wood, at most 64: each a closed convex frustum of six sides along a
/// straight run of a stem or branch, in the plant's coordinates.
///
/// Guaranteed: the largest runs, in the order of the plant's axes; the same bits on every platform. Roots, stalks of
/// leaves and leaves have none; empty for a plant without stems or thickness. Cost: linear in nodes but for long axes
/// that wind.
///
/// ```
/// use glam::DVec3;
/// let mut p = plant::Plant::default();
/// p.add_axis(plant::AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
/// p.nodes.radius_m = vec![0.02, 0.01];
/// let shapes = skin::colliders(&p);
/// assert_eq!((shapes.len(), shapes[0].triangles.len()), (1, 20));
/// ```
pub fn colliders(plant: &Plant) -> Vec<TriMesh> {
    let mut pieces: Vec<Piece> = Vec::new();
    for axis in &plant.axes {
        if matches!(axis.kind, AxisKind::Root | AxisKind::Petiole) {
            continue;
        }
        let rows: Vec<usize> = axis.node_ids().map(|node| node.index()).collect();
        let points: Vec<DVec3> = rows.iter().map(|&row| plant.nodes.position[row]).collect();
        let radii: Vec<f64> =
            rows.iter().map(|&row| plant.nodes.radius_m.get(row).copied().unwrap_or(0.0)).collect();
        if points.len() >= 2 {
            divide(&points, &radii, &mut pieces);
        }
    }
    pieces.retain(|piece| piece.volume() > 0.0 && piece.volume().is_finite());
    let mut pieces: Vec<(usize, Piece)> = pieces.into_iter().enumerate().collect();
    base::sort_by(&mut pieces, |a, b| b.1.volume().total_cmp(&a.1.volume()).then(a.0.cmp(&b.0)));
    let largest = pieces.first().map_or(0.0, |(_, piece)| piece.volume());
    pieces.retain(|(_, piece)| piece.volume() >= SMALLEST * largest);
    pieces.truncate(MOST_PIECES);
    base::sort_by(&mut pieces, |a, b| a.0.cmp(&b.0));
    pieces.iter().map(|(_, piece)| piece.mesh()).collect()
}

/// Joins shapes for collisions into one mesh.
pub fn joined_colliders(shapes: &[TriMesh]) -> TriMesh {
    let mut all = TriMesh::default();
    shapes.iter().for_each(|shape| all.append(shape));
    all
}

/// Divides an axis into straight pieces where it deviates most (Douglas and Peucker 1973).
fn divide(points: &[DVec3], radii: &[f64], pieces: &mut Vec<Piece>) {
    let mut open = vec![(0_usize, points.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let way = points[to] - points[from];
        let along = |p: DVec3| (p - points[from]).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
        let off = |k: usize| points[k].distance(points[from] + way * along(points[k]).clamp(0.0, 1.0));
        let far = (from + 1..to).max_by(|&a, &b| off(a).total_cmp(&off(b)).then(b.cmp(&a)));
        match far.filter(|&far| off(far) > STRAIGHT * radii[far]) {
            // The nearer half is taken first.
            Some(far) => open.extend([(far, to), (from, far)]),
            None => {
                let least = LEAST_TAPER * radii[from].max(radii[to]);
                let radii = [radii[from].max(least), radii[to].max(least)];
                pieces.push(Piece { ends: [points[from], points[to]], radii });
            }
        }
    }
}
