//! Blade -> triangles: a constrained Delaunay sheet, lifted and bent, with the texture along its midrib.

use glam::{DVec2, DVec3};
use mesh::TriMesh;
use plant::Blade;

use crate::tube::{drop_flat, narrow2};

// With fewer triangles than this, veins other than the midrib would leave slivers only.
const VEINS_FROM: f64 = 100.0;

/// The surface of a leaf or petal in its own frame (metres at scale 1), one layer, in about `triangles`
/// triangles (8 to 20,000).
///
/// Guaranteed: the boundary follows the outline at the edge length of the triangles; edges lie along the midrib,
/// and along further veins where there are 100 triangles or more, so that folds crease there; triangles wind
/// counter-clockwise seen from the upper side; unit normals, smooth; u in 0..1 with one half on the midrib, v in
/// 0..1 from the highest point of the outline (0) to the lowest (1). Empty where the outline has no area.
/// Not guaranteed: the exact count; the number of triangles is within about a quarter of the wish.
pub fn blade_mesh(blade: &Blade, triangles: f64) -> TriMesh {
    let area = geom::signed_area(&blade.outline).abs();
    let around = closed_length(&blade.outline);
    let Some(edge) = edge_length(area, around, triangles.clamp(8.0, 20_000.0)) else {
        return TriMesh::default();
    };
    let mut lines: Vec<&[DVec2]> = vec![&blade.midrib];
    if triangles >= VEINS_FROM {
        lines.extend(blade.veins.iter().map(Vec::as_slice));
    }
    let flat = geom::triangulate_blade(&blade.outline, &lines, edge).or_else(|_| {
        // An outline that crosses itself: its largest simple part, without veins that may lie outside.
        let simple = geom::simple_outline(&blade.outline).unwrap_or_default();
        geom::triangulate_blade(&simple, &[], edge)
    });
    let Ok(flat) = flat else { return TriMesh::default() };
    let chart = Chart::new(blade);
    let surface = blade.surface();
    let mut mesh = TriMesh { triangles: flat.triangles, ..TriMesh::default() };
    mesh.positions.reserve(flat.points.len());
    mesh.uvs.reserve(flat.points.len());
    for &p in &flat.points {
        let lifted = surface.point(p);
        mesh.push(if lifted.is_finite() { lifted } else { DVec3::new(p.x, p.y, 0.0) });
        let (u, v) = chart.uv(p);
        mesh.uvs.push(narrow2(u, v));
    }
    drop_flat(&mut mesh);
    mesh.compute_normals();
    mesh
}

pub(crate) fn closed_length(outline: &[DVec2]) -> f64 {
    let n = outline.len();
    (0..n).map(|i| outline[i].distance(outline[(i + 1) % n])).fold(0.0, |sum, d| sum + d)
}

/// The edge length at which a blade has about `triangles` triangles.
///
/// A hexagonal lattice of spacing e has 2.31 / e2 triangles per area; along the boundary a strip holds no inner
/// points, its triangles are larger. Solved for 1/e.
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

// Steps along the midrib at which its x is kept.
const STEPS: u32 = 32;

/// Texture coordinates of a blade: relative to its midrib, in the box of its outline.
struct Chart {
    low: f64,
    height: f64,
    half_width: f64,
    /// The midrib's x at even steps of y from `low` up.
    midrib: Vec<f64>,
}

impl Chart {
    fn new(blade: &Blade) -> Self {
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
        let k = crate::spec::whole(whole) as usize;
        base::ops::lerp(self.midrib[k], self.midrib[k + 1], at - whole)
    }

    fn uv(&self, p: DVec2) -> (f64, f64) {
        let u = 0.5 + 0.5 * (p.x - self.middle(p.y)) / self.half_width;
        let v = 1.0 - (p.y - self.low) / self.height;
        (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0))
    }
}

/// The x of a line at height `y`: its first crossing, or its nearer end.
fn x_at(line: &[DVec2], y: f64) -> f64 {
    let crossing = line.windows(2).find(|w| (w[0].y <= y) != (w[1].y <= y));
    match crossing {
        Some(w) => base::ops::lerp(w[0].x, w[1].x, (y - w[0].y) / (w[1].y - w[0].y)),
        None => line.iter().min_by(|a, b| (a.y - y).abs().total_cmp(&(b.y - y).abs())).map_or(0.0, |p| p.x),
    }
}
