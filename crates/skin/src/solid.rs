//! A plant as one closed body, for printers.
//!
//! `plant, meshes -> distance to wood and blades on a grid -> surface of that distance -> the body on the foot`

use base::{Cancelled, Run};
use glam::DVec3;
use mesh::{MaterialKind, Model, TriMesh};
use plant::{AxisKind, Plant};

use crate::simpler::simplify;

/// Settings of a body for printing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidSpec {
    /// Its height above the foot, metres, 0.01 to 2. Default 0.15.
    pub height_m: f64,
    /// Least thickness of any part, metres, 0.0002 to 0.02: thinner twigs and leaves are thickened. Default 0.0015.
    pub wall_m: f64,
}

impl Default for SolidSpec {
    fn default() -> Self {
        Self { height_m: 0.15, wall_m: 0.0015 }
    }
}

/// A body for printing.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Its surface, metres, standing on y = 0.
    pub mesh: TriMesh,
    /// Number of unconnected bodies that were left out.
    pub loose: usize,
    /// Ratio of the size of the plant to that of the body.
    pub scale: f64,
}

/// Reason why there is no body.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SolidError {
    /// The plant has nothing above the ground.
    #[error("the plant has nothing above the ground that could be printed")]
    Nothing,
    /// The wall is too thin for a body of this size.
    #[error("a wall of {} mm is too thin for this print: make it at least {} mm, or the print smaller", *wall_m * 1e3, *least_m * 1e3)]
    TooFine {
        /// The requested wall, metres.
        wall_m: f64,
        /// The thinnest possible wall, metres.
        least_m: f64,
    },
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Most nodes of the grid: a quarter of a gigabyte.
const MOST_NODES: f64 = 6.4e7;
/// Nodes of the grid across the thinnest wall: a wall of two cells is detected at any position.
const CELLS_A_WALL: f64 = 2.0;
/// Least radius of the foot, a disc, relative to the height of the print.
const FOOT_OF_HEIGHT: f64 = 0.12;
/// Least radius of the foot relative to that of the stem.
const FOOT_OF_STEM: f64 = 2.0;
/// Thickness of the foot in walls.
const FOOT_WALLS: f64 = 2.0;
/// Deviation of the printed surface, by the root of its mean square, relative to the thinnest wall: of a usual wall of
/// 1.5 mm 0.075 mm, less than the layers of 0.1 to 0.3 mm that printers lay.
const DEVIATION_OF_WALL: f64 = 0.05;
/// Cells around the body that are certainly outside.
const MARGIN: f64 = 3.0;

/// Distances to a body at the nodes of a grid, negative inside.
struct Grid {
    origin: DVec3,
    cell: f64,
    size: [usize; 3],
    distance: Vec<f32>,
}

impl Grid {
    fn node(&self, [i, j, k]: [usize; 3]) -> DVec3 {
        self.origin + DVec3::new(i as f64, j as f64, k as f64) * self.cell
    }

    fn row(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.size[1] + j) * self.size[0] + i
    }

    /// Adds a part that lies within a box, by its distance.
    fn add(&mut self, low: DVec3, high: DVec3, distance: impl Fn(DVec3) -> f64) {
        let reach = DVec3::splat(2.0 * self.cell);
        let index = |p: DVec3| ((p - self.origin) / self.cell).to_array();
        let (low, high) = (index(low - reach), index(high + reach));
        let range = |c: usize| {
            let most = self.size[c] as f64 - 1.0;
            let [from, to] = [low[c].floor(), high[c].ceil()].map(|x| base::ops::whole(x.clamp(0.0, most)));
            from as usize..=to as usize
        };
        let (rows, columns, layers) = (range(0), range(1), range(2));
        for k in layers {
            for j in columns.clone() {
                for i in rows.clone() {
                    #[expect(clippy::cast_possible_truncation, reason = "a grid of single precision")]
                    let d = distance(self.node([i, j, k])) as f32;
                    let row = self.row([i, j, k]);
                    self.distance[row] = self.distance[row].min(d);
                }
            }
        }
    }
}

/// Makes a plant into one body: wood unchanged, thin parts thickened, on a round foot that is flat below.
///
/// `model`: the plant's meshes, from which the blades are taken; wood is that of the plant. Parts below the ground are
/// left out. Guaranteed: the surface is closed and two-manifold, of one body without cavities, with no more triangles than
/// printers can show; the same bits for equal input. Not guaranteed: that it prints without supports. Cost: in proportion
/// to the area of the plant over the square of the wall.
///
/// # Errors
/// [`SolidError`].
pub fn solid(plant: &Plant, model: &Model, spec: &SolidSpec, run: &Run<'_>) -> Result<Solid, SolidError> {
    let bounds = model.bounds();
    if bounds.is_empty() || !(bounds.max.y > 0.0 && bounds.max.is_finite() && bounds.min.is_finite()) {
        return Err(SolidError::Nothing);
    }
    let wall = spec.wall_m.clamp(2e-4, 0.02);
    let scale = spec.height_m.clamp(0.01, 2.0) / bounds.max.y;
    let mut grid = grid_of(bounds.min * scale, bounds.max * scale, wall)?;
    let stem = add_wood(&mut grid, plant, (scale, wall), run)?;
    add_blades(&mut grid, model, (scale, wall), run)?;
    let foot = (stem * FOOT_OF_STEM).max(FOOT_OF_HEIGHT * bounds.max.y * scale);
    add_foot(&mut grid, base_of(plant) * scale, foot, FOOT_WALLS * wall);
    cut(&mut grid);
    let mut surface = surface_of(&grid, run)?;
    drop(grid);
    let loose = keep_one(&mut surface);
    if surface.triangles.is_empty() {
        return Err(SolidError::Nothing);
    }
    // The cut lies half a cell below the ground.
    let low = surface.positions.iter().map(|p| p[1]).fold(f32::INFINITY, f32::min);
    surface.positions.iter_mut().for_each(|p| p[1] -= low);
    // The foot stays flat.
    simplify(&mut surface, DEVIATION_OF_WALL * wall, |p| p[1] == 0.0, run)?;
    surface.compute_normals();
    Ok(Solid { mesh: surface, loose, scale: 1.0 / scale })
}

/// Makes the grid around a box from the ground up, all outside.
fn grid_of(low: DVec3, high: DVec3, wall: f64) -> Result<Grid, SolidError> {
    let low = DVec3::new(low.x, 0.0, low.z);
    let nodes = |wall: f64| {
        let cell = wall / CELLS_A_WALL;
        // Room for the foot, which may be wider than the plant.
        let around = DVec3::new(FOOT_OF_HEIGHT * high.y, 0.0, FOOT_OF_HEIGHT * high.y);
        let margin = DVec3::splat(MARGIN * cell + wall) + around;
        (cell, low - margin, (high - low + 2.0 * margin) / cell)
    };
    let count = |wall: f64| nodes(wall).2.to_array().iter().map(|n| n.ceil() + 1.0).product::<f64>();
    if count(wall) > MOST_NODES {
        let mut least_m = wall;
        while count(least_m) > MOST_NODES && least_m < 10.0 {
            least_m *= 1.1;
        }
        return Err(SolidError::TooFine { wall_m: wall, least_m: (least_m * 1e4).ceil() / 1e4 });
    }
    let (cell, origin, size) = nodes(wall);
    // A layer of nodes lies on the ground.
    let below = (MARGIN + CELLS_A_WALL).ceil();
    let origin = DVec3::new(origin.x, -below * cell, origin.z);
    let size = size.to_array().map(|n| base::ops::whole(n.ceil() + 1.0) as usize);
    #[expect(clippy::cast_possible_truncation, reason = "a grid of single precision")]
    let far = (4.0 * cell) as f32;
    Ok(Grid { origin, cell, size, distance: vec![far; size.iter().product()] })
}

/// Returns the position of the plant: the mean of the feet of its stems.
fn base_of(plant: &Plant) -> DVec3 {
    let feet = plant.axes.iter().filter(|a| a.bearer.is_none() && a.kind != AxisKind::Root);
    let feet: Vec<DVec3> =
        feet.filter_map(|a| plant.nodes.position.get(a.nodes.start as usize).copied()).collect();
    if feet.is_empty() { DVec3::ZERO } else { feet.iter().sum::<DVec3>() / feet.len() as f64 }
}

/// Adds all axes; returns the reach of the stems on the ground about [`base_of`].
fn add_wood(
    grid: &mut Grid,
    plant: &Plant,
    (scale, wall): (f64, f64),
    run: &Run<'_>,
) -> Result<f64, SolidError> {
    let (foot, mut reach) = (base_of(plant), 0.0_f64);
    let radius = |node: usize| (plant.nodes.radius_m[node] * scale).max(0.5 * wall);
    for axis in &plant.axes {
        run.cancel.check()?;
        let nodes = axis.nodes.start as usize..axis.nodes.end as usize;
        if let Some(first) =
            nodes.clone().next().filter(|_| axis.bearer.is_none() && axis.kind != AxisKind::Root)
        {
            let away = (plant.nodes.position[first] - foot) * scale;
            reach = reach.max(away.x.abs().max(away.z.abs()) + radius(first));
        }
        let mut before = axis.bearer.map(|b| b.index());
        for node in nodes {
            let from = before.unwrap_or(node);
            // A twig is as thick at its foot as at the start of its own course.
            let near =
                if plant.nodes.axis[from] == plant.nodes.axis[node] { radius(from) } else { radius(node) };
            let ends = [plant.nodes.position[from] * scale, plant.nodes.position[node] * scale];
            add_rod(grid, ends, [near, radius(node)]);
            before = Some(node);
        }
    }
    Ok(reach)
}

/// Adds a rod with round ends.
fn add_rod(grid: &mut Grid, [a, b]: [DVec3; 2], [from, to]: [f64; 2]) {
    if !(a.is_finite() && b.is_finite() && from.is_finite() && to.is_finite()) {
        return;
    }
    let thick = DVec3::splat(from.max(to));
    let (along, squared) = (b - a, (b - a).length_squared());
    grid.add(a.min(b) - thick, a.max(b) + thick, |p| {
        let t = if squared > 0.0 { ((p - a).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
        p.distance(a + along * t) - base::ops::lerp(from, to, t)
    });
}

/// Adds everything that is not wood, one wall thick.
fn add_blades(
    grid: &mut Grid,
    model: &Model,
    (scale, wall): (f64, f64),
    run: &Run<'_>,
) -> Result<(), SolidError> {
    let wood = [MaterialKind::Bark, MaterialKind::YoungBark, MaterialKind::Stem, MaterialKind::Root];
    for part in model.parts.iter().filter(|p| !wood.contains(&model.material(p).kind)) {
        run.cancel.check()?;
        let point = |i: u32| {
            let [x, y, z] = part.mesh.positions[i as usize].map(f64::from);
            DVec3::new(x, y, z) * scale
        };
        for &corners in &part.mesh.triangles {
            let t = corners.map(point);
            let thick = DVec3::splat(0.5 * wall);
            let (low, high) = (t[0].min(t[1]).min(t[2]) - thick, t[0].max(t[1]).max(t[2]) + thick);
            grid.add(low, high, |p| nearest(p, t).distance(p) - 0.5 * wall);
        }
    }
    Ok(())
}

/// Returns the point of a triangle nearest to another (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
fn nearest(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    if sum > 0.0 { a + ab * (vb / sum) + ac * (vc / sum) } else { a }
}

/// Adds a round plate on the ground.
fn add_foot(grid: &mut Grid, at: DVec3, radius: f64, height: f64) {
    let (low, high) =
        (DVec3::new(at.x - radius, 0.0, at.z - radius), DVec3::new(at.x + radius, height, at.z + radius));
    grid.add(low - DVec3::new(0.0, height, 0.0), high, |p| {
        let aside = DVec3::new(p.x - at.x, 0.0, p.z - at.z).length() - radius;
        aside.max(p.y - height)
    });
}

/// Removes everything below the ground, along a plane half a cell below the nodes on it.
fn cut(grid: &mut Grid) {
    #[expect(clippy::cast_possible_truncation, reason = "a grid of single precision")]
    let cell = grid.cell as f32;
    for k in 0..grid.size[2] {
        for j in 0..grid.size[1] {
            #[expect(clippy::cast_possible_truncation, reason = "a grid of single precision")]
            let below = (-0.5 * grid.cell - grid.node([0, j, k]).y) as f32;
            for i in 0..grid.size[0] {
                let row = grid.row([i, j, k]);
                let is_border = [i, j, k].iter().zip(&grid.size).any(|(n, size)| *n == 0 || n + 1 == *size);
                // Outside at the border, so that the body is closed there, too.
                let least = if is_border { below.max(0.5 * cell) } else { below };
                let d = grid.distance[row].max(least);
                // A node on the surface would make triangles without area.
                grid.distance[row] = if d == 0.0 { f32::MIN_POSITIVE } else { d };
            }
        }
    }
}

/// Corners of a cube in the order of the bits x, y, z; six tetrahedra along its diagonal, which fit those of the next
/// cube.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// Returns the surface where the distance is 0, by marching tetrahedra (Doi and Koide 1991): closed and two-manifold,
/// since the distance is linear within each of them and outside at the border.
fn surface_of(grid: &Grid, run: &Run<'_>) -> Result<TriMesh, SolidError> {
    // A corner of a triangle lies between two nodes, the lower row first.
    let mut corners: Vec<[[u32; 2]; 3]> = Vec::new();
    let [nx, ny, nz] = grid.size;
    for k in 0..nz - 1 {
        run.cancel.check()?;
        for j in 0..ny - 1 {
            for i in 0..nx - 1 {
                let rows: [usize; 8] =
                    core::array::from_fn(|c| grid.row([i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)]));
                let inside = rows.map(|r| grid.distance[r] < 0.0);
                if inside.iter().all(|&x| x) || !inside.iter().any(|&x| x) {
                    continue;
                }
                for t in TETRAHEDRA {
                    tetrahedron(t.map(|c| rows[c]), t.map(|c| inside[c]), &mut corners);
                }
            }
        }
    }
    let mut edges: Vec<[u32; 2]> = corners.iter().flatten().copied().collect();
    edges.sort_unstable();
    edges.dedup();
    let mut mesh = TriMesh::default();
    let place = |row: u32| {
        let row = row as usize;
        let p = grid.node([row % nx, row / nx % ny, row / (nx * ny)]);
        (p, f64::from(grid.distance[row]))
    };
    for &[a, b] in &edges {
        let ((p, from), (q, to)) = (place(a), place(b));
        // Away from the ends, so that no two corners coincide.
        let t = (from / (from - to)).clamp(0.02, 0.98);
        #[expect(clippy::cast_possible_truncation, reason = "meshes are f32 by design")]
        mesh.positions.push(p.lerp(q, t).to_array().map(|x| x as f32));
    }
    let row = |edge: &[u32; 2]| edges.binary_search(edge).ok().and_then(|row| u32::try_from(row).ok());
    mesh.triangles = corners.iter().filter_map(|t| Some([row(&t[0])?, row(&t[1])?, row(&t[2])?])).collect();
    Ok(mesh)
}

/// Even permutations of four corners, which keep the orientation of a tetrahedron: each corner first.
const ALONE: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]];
/// The same with each pair first.
const PAIRS: [[usize; 4]; 6] =
    [[0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2], [1, 2, 0, 3], [1, 3, 2, 0], [2, 3, 0, 1]];

/// Adds the triangles of a tetrahedron, facing outwards.
fn tetrahedron(rows: [usize; 4], inside: [bool; 4], out: &mut Vec<[[u32; 2]; 3]>) {
    let edge = |a: usize, b: usize| {
        let ends = [rows[a].min(rows[b]), rows[a].max(rows[b])];
        ends.map(|r| u32::try_from(r).unwrap_or(u32::MAX))
    };
    let mut add = |[a, b, c, d]: [usize; 4], one: bool| {
        let t = [edge(a, b), edge(a, c), edge(a, d)];
        out.push(if one { t } else { [t[0], t[2], t[1]] });
    };
    match inside.iter().filter(|&&x| x).count() {
        1 => ALONE.iter().filter(|p| inside[p[0]]).for_each(|&p| add(p, true)),
        3 => ALONE.iter().filter(|p| !inside[p[0]]).for_each(|&p| add(p, false)),
        2 => {
            for &[a, b, c, d] in PAIRS.iter().filter(|p| inside[p[0]] && inside[p[1]]) {
                let quad = [edge(a, c), edge(a, d), edge(b, d), edge(b, c)];
                out.push([quad[0], quad[1], quad[2]]);
                out.push([quad[0], quad[2], quad[3]]);
            }
        }
        _ => {}
    }
}

/// Keeps the body with the most triangles; returns the number of others, including cavities.
fn keep_one(mesh: &mut TriMesh) -> usize {
    let mut parent: Vec<u32> = (0..).take(mesh.positions.len()).collect();
    fn root(parent: &mut [u32], mut x: u32) -> u32 {
        while parent[x as usize] != x {
            parent[x as usize] = parent[parent[x as usize] as usize];
            x = parent[x as usize];
        }
        x
    }
    for t in &mesh.triangles {
        for k in 1..3 {
            let (a, b) = (root(&mut parent, t[0]), root(&mut parent, t[k]));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let mut count = vec![0_usize; parent.len()];
    let of: Vec<u32> = mesh.triangles.iter().map(|t| root(&mut parent, t[0])).collect();
    of.iter().for_each(|&r| count[r as usize] += 1);
    let bodies = count.iter().filter(|&&n| n > 0).count();
    let Some(most) = count.iter().copied().max().and_then(|n| count.iter().position(|&m| m == n)) else {
        return 0;
    };
    let mut new = vec![u32::MAX; mesh.positions.len()];
    let mut positions = Vec::new();
    let kept = mesh.triangles.iter().zip(&of).filter(|(_, r)| **r as usize == most);
    let triangles = kept
        .map(|(t, _)| {
            t.map(|i| {
                let slot = &mut new[i as usize];
                if *slot == u32::MAX {
                    *slot = u32::try_from(positions.len()).unwrap_or(u32::MAX);
                    positions.push(mesh.positions[i as usize]);
                }
                *slot
            })
        })
        .collect();
    (mesh.triangles, mesh.positions) = (triangles, positions);
    bodies.saturating_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh::{Material, MaterialId, Part};
    use plant::NodeId;
    use std::collections::BTreeMap;

    /// Makes a trunk with two branches, and a leaf on one of them, with one more that is unconnected.
    fn shrub() -> (Plant, Model) {
        let mut plant = Plant { name: "shrub".to_owned(), ..Plant::default() };
        let trunk = [DVec3::ZERO, DVec3::Y, 2.0 * DVec3::Y];
        plant.add_axis(AxisKind::Branch, None, 0, &trunk, None);
        for (key, aside) in [(1, DVec3::X), (2, -DVec3::X)] {
            let points = [DVec3::Y, DVec3::Y + 0.5 * aside, 1.5 * DVec3::Y + aside];
            plant.add_axis(AxisKind::Branch, Some(NodeId::new(1)), key, &points, None);
        }
        plant.nodes.radius_m.fill(0.03);
        let leaf = |at: DVec3| {
            let point = |p: DVec3| (at + p).as_vec3().to_array();
            TriMesh {
                positions: vec![point(DVec3::ZERO), point(0.3 * DVec3::Z), point(0.2 * DVec3::X)],
                triangles: vec![[0, 1, 2]],
                ..TriMesh::default()
            }
        };
        let mut mesh = leaf(DVec3::new(1.0, 1.5, 0.0));
        mesh.append(&leaf(DVec3::new(0.0, 1.5, 0.9)));
        let material = Material::plain("leaf", MaterialKind::Leaf, [0.1, 0.4, 0.1]);
        let part = Part { name: "leaves".to_owned(), material: MaterialId::new(0), mesh };
        let wood = TriMesh {
            positions: vec![[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.01, 2.0, 0.0]],
            triangles: vec![[0, 1, 2]],
            ..TriMesh::default()
        };
        let bark = Material::plain("bark", MaterialKind::Bark, [0.3, 0.2, 0.1]);
        let trunk = Part { name: "bark".to_owned(), material: MaterialId::new(1), mesh: wood };
        let model = Model { parts: vec![part, trunk], materials: vec![material, bark], ..Model::default() };
        (plant, model)
    }

    #[test]
    fn a_print_is_closed_two_manifold_of_one_body_and_stands_flat() {
        let (plant, model) = shrub();
        let spec = SolidSpec { height_m: 0.1, wall_m: 0.002 };
        let made = solid(&plant, &model, &spec, &Run::plain()).expect("a body");
        assert_eq!(made.loose, 1, "the leaf that hangs in the air");
        assert!((made.scale - 20.0).abs() < 1e-6, "{}", made.scale);
        let mut edges: BTreeMap<[u32; 2], i32> = BTreeMap::new();
        for t in &made.mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                // Each edge is traversed once in each direction.
                *edges.entry([a.min(b), a.max(b)]).or_insert(0) += if a < b { 1 } else { 1000 };
            }
        }
        let odd: Vec<_> = edges.iter().filter(|(_, n)| **n != 1001).take(4).collect();
        assert!(odd.is_empty(), "closed, two-manifold, turned alike: {odd:?} of {}", edges.len());
        // Euler: a body without holes through it; the leaf and the branches make none.
        let euler = made.mesh.positions.len() as i64 - edges.len() as i64 + made.mesh.triangles.len() as i64;
        assert_eq!(euler, 2);
        let points = || made.mesh.positions.iter();
        let low = points().map(|p| p[1]).fold(f32::MAX, f32::min);
        let high = points().map(|p| p[1]).fold(f32::MIN, f32::max);
        assert!(low.abs() < 1e-6 && (high - 0.1).abs() < 0.003, "{low} {high}");
        let flat = points().filter(|p| p[1] < 1e-6).count();
        assert!(flat > 200, "{flat} corners of a flat foot");
        // The volume is that of rods and foot, and the surface faces outwards.
        let volume: f64 = made
            .mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| DVec3::from(made.mesh.positions[i as usize].map(f64::from)));
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        let disc = base::ops::PI * 0.012 * 0.012 * 0.0045;
        let rods = base::ops::PI * 0.0015 * 0.0015 * (0.1 + 2.0 * 0.06);
        assert!(volume > 0.7 * (disc + rods) && volume < 1.5 * (disc + rods), "{volume} {}", disc + rods);
        let again = solid(&plant, &model, &spec, &Run::plain()).expect("a body");
        assert_eq!(again.mesh, made.mesh);
    }

    #[test]
    fn a_wall_that_is_too_thin_is_refused_with_the_least() {
        let (plant, model) = shrub();
        let spec = SolidSpec { height_m: 2.0, wall_m: 0.0002 };
        let Err(SolidError::TooFine { least_m, .. }) = solid(&plant, &model, &spec, &Run::plain()) else {
            panic!("too fine")
        };
        assert!(least_m > 0.0002 && least_m < 0.02, "{least_m}");
        let nothing = solid(&Plant::default(), &Model::default(), &spec, &Run::plain());
        assert_eq!(nothing.expect_err("nothing"), SolidError::Nothing);
    }
}
