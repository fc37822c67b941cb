//! Margins of a blade that differ from the edge of its surface: teeth, lobes of the base.

use std::collections::BTreeMap;

use geom::{KdTree2, SurfacePoint};
use glam::{DVec2, DVec3};

use crate::{FlatLeaf, RimPoint, SplineBlade};

/// A blade within its rim as triangles; see [`SplineBlade::netted`].
#[derive(Clone, Debug, Default)]
pub struct Netted {
    /// Points: those of the rim first.
    pub points: Vec<DVec3>,
    /// Unit normals of the upper side.
    pub normals: Vec<DVec3>,
    /// The points laid flat.
    pub flat: Vec<DVec2>,
    /// Corners, counter-clockwise seen from the upper side.
    pub triangles: Vec<[usize; 3]>,
}

/// Share of the domain by which a pinched place is moved inwards before it is evaluated.
pub(crate) const INNER: f64 = 1e-3;
/// Least distance of grid points from the margin, as a share of a cell, which avoids needle triangles.
const CLEAR: f64 = 0.3;

impl SplineBlade {
    /// Returns the directions at a place of the surface: towards the right margin, towards the tip, to the upper side.
    /// `None` where the surface is pinched.
    pub fn directions(&self, u: f64, v: f64) -> Option<[DVec3; 3]> {
        let (low, high) = self.surface.v().domain();
        let at = self.surface.point_at(u, v + INNER * (0.5 * (low + high) - v));
        let (across, normal) = (at.du.try_normalize()?, at.normal?);
        Some([across, normal.cross(across), normal])
    }

    /// Triangulates the blade within its rim, with `steps` parts between marks; `None` without a rim, or if the
    /// flattened rim crosses itself: then the surface alone is the blade.
    ///
    /// The rim's points are kept, each as a corner; between them lies the grid of the surface. Cost: n log n.
    pub fn netted(&self, steps: usize) -> Option<Netted> {
        if self.rim.is_empty() {
            return None;
        }
        let steps = steps.clamp(1, 64);
        let (us, vs) = self.grid_at(steps);
        let grid = self.surface.grid(&us, &vs);
        let flat = FlatLeaf::from_grid(&grid, us.len(), steps);
        let rim = self.flat_rim(&flat, &us, &vs);
        let columns = us.len();
        // A single cell would depend on its place across the blade, so this takes the median of all cells.
        let cells: Vec<f64> = flat.points.windows(2).map(|w| w[0].distance(w[1])).collect();
        let mut sorted = cells;
        base::sort_numbers(&mut sorted);
        let clear = CLEAR * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
        let near = KdTree2::new(&dense(&rim, 0.5 * clear));
        // Points outside are left out by the triangulation, points near the rim here.
        let inner: Vec<usize> =
            (0..flat.points.len()).filter(|&k| near.nearest(flat.points[k], clear).is_none()).collect();
        let number: BTreeMap<usize, usize> = inner.iter().enumerate().map(|(i, &k)| (k, i)).collect();
        let joined = |a: usize, b: usize| Some([*number.get(&a)?, *number.get(&b)?]);
        let along =
            (1..vs.len()).filter_map(|i| joined((i - 1) * columns + columns / 2, i * columns + columns / 2));
        let across = (0..vs.len()).step_by(steps).flat_map(|i| (1..columns).map(move |j| i * columns + j));
        let lines: Vec<[usize; 2]> = along.chain(across.filter_map(|k| joined(k - 1, k))).collect();
        let places: Vec<DVec2> = inner.iter().map(|&k| flat.points[k]).collect();
        let triangles = geom::triangulate_within(&rim, &places, &lines)?;
        let normal_at = |p: &SurfacePoint, u: f64, v: f64| {
            let beside = || self.directions(u, v).map(|d| d[2]);
            p.normal.or_else(beside).unwrap_or(DVec3::Z)
        };
        let mut out = Netted::default();
        let mut used = vec![None; rim.len() + inner.len()];
        for (k, r) in self.rim.iter().enumerate() {
            used[k] = Some(k);
            out.points.push(r.place);
            out.normals.push(normal_at(&self.surface.point_at(r.u, r.v), r.u, r.v));
            out.flat.push(rim[k]);
        }
        for t in triangles {
            let corners = t.map(|c| match used[c] {
                Some(at) => at,
                None => {
                    let k = inner[c - rim.len()];
                    let at = out.points.len();
                    out.points.push(grid[k].position);
                    out.normals.push(normal_at(&grid[k], us[k % columns], vs[k / columns]));
                    out.flat.push(flat.points[k]);
                    used[c] = Some(at);
                    at
                }
            });
            out.triangles.push(corners);
        }
        Some(out)
    }

    /// Returns the rim laid flat, with the grid of the surface at `us` and `vs`.
    pub(crate) fn flat_rim(&self, flat: &FlatLeaf, us: &[f64], vs: &[f64]) -> Vec<DVec2> {
        let cell = |at: &[f64], x: f64| {
            let k = at.partition_point(|&a| a <= x).clamp(1, at.len() - 1);
            (k - 1, ((x - at[k - 1]) / (at[k] - at[k - 1])).clamp(0.0, 1.0))
        };
        let middle = 0.5 * (vs[0] + vs[vs.len() - 1]);
        let place = |r: &RimPoint| {
            let (j, s) = cell(us, r.u);
            let sides = |v: f64| {
                let (i, t) = cell(vs, v);
                let at = |j: usize| {
                    flat.points[i * flat.columns + j].lerp(flat.points[(i + 1) * flat.columns + j], t)
                };
                [at(j), at(j + 1)]
            };
            let [left, right] = sides(r.v);
            let on = left.lerp(right, s);
            let [left, right] = sides(r.v + INNER * (middle - r.v));
            let off = r.place - self.surface.point(r.u, r.v);
            match (self.directions(r.u, r.v), (right - left).try_normalize()) {
                (Some([across, along, _]), Some(x)) => on + x * off.dot(across) + x.perp() * off.dot(along),
                _ => on,
            }
        };
        self.rim.iter().map(place).collect()
    }
}

/// Returns a closed line with points at most `step` apart.
fn dense(line: &[DVec2], step: f64) -> Vec<DVec2> {
    let ends = line.iter().skip(1).chain(line.first());
    let parts = |a: DVec2, b: DVec2| {
        let parts = if step > 0.0 { (a.distance(b) / step).ceil().clamp(1.0, 1000.0) } else { 1.0 };
        let many = core::iter::successors(Some(0.0), move |k: &f64| (k + 1.0 < parts).then_some(k + 1.0));
        many.map(move |k| a.lerp(b, k / parts))
    };
    line.iter().zip(ends).flat_map(|(&a, &b)| parts(a, b)).collect()
}
