//! Meshes a blade: a constrained Delaunay sheet, lifted and bent, with the texture along its midrib.

use glam::{DVec2, DVec3};
use mesh::TriMesh;
use plant::Blade;

use crate::sleeve::{drop_flat, narrow2};

// Number of triangles below which veins other than the midrib would only leave slivers.
const VEINS_FROM: f64 = 100.0;

/// Meshes a leaf or petal in its own frame (metres at scale 1), one layer, in about `triangles` triangles (8 to
/// 20,000).
///
/// Guaranteed: the boundary follows the outline at the edge length of the triangles; edges lie along the midrib, and
/// along further veins if there are 100 triangles or more, so that folds crease there; triangles wind counter-clockwise
/// seen from the upper side; unit normals, smooth; u in 0..1 with one half on the midrib, v in 0..1 from the highest
/// point of the outline (0) to the lowest (1). Empty if the outline has no area. Not guaranteed: the exact count; the
/// number of triangles is within about a quarter of the wish.
pub fn blade_mesh(blade: &Blade, triangles: f64) -> TriMesh {
    let area = geom::signed_area(&blade.outline).abs();
    let around = closed_length(&blade.outline);
    let wanted = triangles.clamp(8.0, 20_000.0);
    let Some(edge) = edge_length(area, around, wanted) else {
        return TriMesh::default();
    };
    // The margin alone makes a triangle of each of its edges: a bundle of needles, which is all margin, would get far
    // more than requested.
    let edge = edge.max(around / wanted);
    let creases = if triangles >= VEINS_FROM { usize::MAX } else { 1 };
    let lines: Vec<&[DVec2]> = blade.lines().take(creases).map(Vec::as_slice).collect();
    let flat = geom::triangulate_blade(&blade.outline, &lines, edge).or_else(|_| {
        // An outline that crosses itself: its largest simple part, without veins that may lie outside.
        let simple = geom::simple_outline(&blade.outline).unwrap_or_default();
        geom::triangulate_blade(&simple, &[], edge)
    });
    let Ok(flat) = flat else { return TriMesh::default() };
    let chart = BladeChart::new(blade);
    let surface = blade.surface();
    let mut mesh = TriMesh { triangles: flat.triangles, ..TriMesh::default() };
    mesh.positions.reserve(flat.points.len());
    mesh.uvs.reserve(flat.points.len());
    for &p in &flat.points {
        let lifted = surface.point(p);
        mesh.push(if lifted.is_finite() { lifted } else { DVec3::new(p.x, p.y, 0.0) });
        let uv = chart.uv(p);
        mesh.uvs.push(narrow2(uv.x, uv.y));
    }
    drop_flat(&mut mesh);
    mesh.compute_normals();
    mesh
}

pub(crate) fn closed_length(outline: &[DVec2]) -> f64 {
    let n = outline.len();
    (0..n).map(|i| outline[i].distance(outline[(i + 1) % n])).fold(0.0, |sum, d| sum + d)
}

/// Returns the edge length at which a blade has about `triangles` triangles.
///
/// A hexagonal lattice of spacing e has 2.31 / e2 triangles per area; a strip along the boundary contains no inner
/// points, so its triangles are larger. Solved for 1/e.
fn edge_length(area: f64, around: f64, triangles: f64) -> Option<f64> {
    if !(area.is_finite() && around.is_finite() && area > 1e-9 * around * around) {
        return None;
    }
    let b = STRIP * around;
    let inverse = (b + (b * b + 4.0 * LATTICE * area * triangles).sqrt()) / (2.0 * LATTICE * area);
    let edge = 1.0 / inverse;
    (edge.is_finite() && edge > 0.0).then_some(edge)
}

const LATTICE: f64 = 2.31;
const STRIP: f64 = 0.39;

// Steps along the midrib at which its x is stored.
const STEPS: u32 = 32;

/// Texture coordinates of a blade: u from its midrib (0.5) to its widest place (0 and 1), v from tip (0) to root.
///
/// ```
/// use glam::DVec2;
/// use plant::{Blade, Lift, Relief};
/// let blade = Blade {
///     outline: vec![DVec2::ZERO, DVec2::new(0.3, 0.5), DVec2::Y, DVec2::new(-0.3, 0.5)],
///     midrib: vec![DVec2::ZERO, DVec2::Y],
///     veins: vec![],
///     needles: None,
///     lift: Lift::Flat,
///     relief: Relief::default(),
/// };
/// let chart = skin::BladeChart::new(&blade);
/// assert!(chart.place(chart.uv(DVec2::new(0.1, 0.4))).distance(DVec2::new(0.1, 0.4)) < 1e-12);
/// ```
#[derive(Clone, Debug)]
pub struct BladeChart {
    low: f64,
    height: f64,
    half_width: f64,
    /// The midrib's x at even steps of y from `low` up.
    midrib: Vec<f64>,
}

impl BladeChart {
    /// Makes the chart of a blade. Cost: linear in its outline.
    pub fn new(blade: &Blade) -> Self {
        let (low, high) =
            blade.outline.iter().fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(p.y), b.max(p.y)));
        let height = (high - low).max(f64::MIN_POSITIVE);
        let midrib = (0..=STEPS)
            .map(|k| x_at(&blade.midrib, low + height * f64::from(k) / f64::from(STEPS)))
            .collect();
        let mut chart = Self { low, height, half_width: 1.0, midrib };
        let widest = blade.outline.iter().map(|p| (p.x - chart.middle(p.y)).abs()).fold(0.0, f64::max);
        chart.half_width = widest.max(f64::MIN_POSITIVE);
        chart
    }

    fn middle(&self, y: f64) -> f64 {
        let at = ((y - self.low) / self.height).clamp(0.0, 1.0) * f64::from(STEPS);
        let whole = at.floor().min(f64::from(STEPS - 1));
        let k = base::ops::whole(whole) as usize;
        base::ops::lerp(self.midrib[k], self.midrib[k + 1], at - whole)
    }

    /// Returns the position in the texture of a point of the blade's plane, 0 to 1 each.
    pub fn uv(&self, p: DVec2) -> DVec2 {
        let u = 0.5 + 0.5 * (p.x - self.middle(p.y)) / self.half_width;
        let v = 1.0 - (p.y - self.low) / self.height;
        DVec2::new(u, v).clamp(DVec2::ZERO, DVec2::ONE)
    }

    /// Returns the point of the blade's plane at a position in its texture.
    pub fn place(&self, uv: DVec2) -> DVec2 {
        let y = self.low + (1.0 - uv.y) * self.height;
        DVec2::new(self.middle(y) + (2.0 * uv.x - 1.0) * self.half_width, y)
    }
}

/// Returns the x of a line at height `y`: its first crossing, or its nearer end.
fn x_at(line: &[DVec2], y: f64) -> f64 {
    let crossing = line.windows(2).find(|w| (w[0].y <= y) != (w[1].y <= y));
    match crossing {
        Some(w) => base::ops::lerp(w[0].x, w[1].x, (y - w[0].y) / (w[1].y - w[0].y)),
        None => line.iter().min_by(|a, b| (a.y - y).abs().total_cmp(&(b.y - y).abs())).map_or(0.0, |p| p.x),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plant::{Lift, Relief};

    fn leaf(relief: Relief) -> Blade {
        let half: Vec<DVec2> = (0..=16)
            .map(|k| f64::from(k) / 16.0)
            .map(|t| DVec2::new(0.3 * (t * (1.0 - t)).sqrt(), t))
            .collect();
        let mut outline = half.clone();
        outline.extend(half[1..16].iter().rev().map(|p| DVec2::new(-p.x, p.y)));
        let midrib = vec![DVec2::ZERO, DVec2::new(0.0, 0.5), DVec2::new(0.0, 1.0)];
        Blade { outline, midrib, veins: Vec::new(), needles: None, lift: Lift::Flat, relief }
    }

    #[test]
    fn boundary_is_the_outline_and_the_area_is_whole() {
        let blade = leaf(Relief::default());
        let mesh = blade_mesh(&blade, 300.0);
        let mut edges: Vec<(u32, u32)> = mesh
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
            .map(|(a, b)| (a.min(b), a.max(b)))
            .collect();
        edges.sort_unstable();
        let border = edges.chunk_by(|a, b| a == b).filter(|run| run.len() == 1).map(|run| run[0]);
        let mut closed = blade.outline.clone();
        closed.push(blade.outline[0]);
        let mut around = 0.0;
        for (a, b) in border {
            let (p, q) = (mesh.position(a), mesh.position(b));
            around += p.distance(q);
            for p in [p, q] {
                let off = geom::distance_to_polyline(&closed, p.truncate()).unwrap_or(9.0);
                assert!(off < 1e-6, "{p} is {off} off the outline");
            }
        }
        let want = closed_length(&blade.outline);
        assert!((around / want - 1.0).abs() < 0.02, "{around} against {want}");
        let area: f64 = mesh
            .triangles
            .iter()
            .map(|t| t.map(|i| mesh.position(i)))
            .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).z)
            .inspect(|a| assert!(*a > 0.0, "a triangle looks down"))
            .sum();
        let want = geom::signed_area(&blade.outline);
        assert!((area / want - 1.0).abs() < 0.02, "{area} against {want}");
    }

    #[test]
    fn counts_follow_the_wish_and_the_midrib_is_at_one_half() {
        let blade = leaf(Relief { bend_b: 0.2, fold: 0.3, hollow: 0.1, ..Relief::default() });
        for wish in [32.0, 100.0, 300.0, 780.0] {
            let mesh = blade_mesh(&blade, wish);
            let n = f64::from(crate::sleeve::index(mesh.triangles.len()));
            assert!((n / wish - 1.0).abs() < 0.3, "{n} for {wish}");
            assert_eq!(mesh.validate().count(), 0, "{wish}");
            let mut on_midrib = 0;
            for (p, uv) in mesh.positions.iter().zip(&mesh.uvs) {
                assert!((0.0..=1.0).contains(&uv[0]) && (0.0..=1.0).contains(&uv[1]), "{uv:?}");
                if p[0].abs() < 1e-4 {
                    on_midrib += 1;
                    assert!((uv[0] - 0.5).abs() < 1e-3, "{uv:?}");
                }
            }
            assert!(on_midrib >= 3, "{on_midrib} on the midrib: it cannot fold");
        }
    }

    #[test]
    fn outline_without_area_gives_nothing_and_a_crossed_one_something() {
        let mut flat = leaf(Relief::default());
        flat.outline.iter_mut().for_each(|p| p.x = 0.0);
        assert!(blade_mesh(&flat, 300.0).triangles.is_empty());
        let mut nan = leaf(Relief::default());
        nan.outline[3].x = f64::NAN;
        assert_eq!(blade_mesh(&nan, 300.0).validate().count(), 0);
        let mut crossed = leaf(Relief::default());
        crossed.outline.swap(4, 9);
        let mesh = blade_mesh(&crossed, 300.0);
        assert!(!mesh.triangles.is_empty());
        assert_eq!(mesh.validate().count(), 0);
    }
}
