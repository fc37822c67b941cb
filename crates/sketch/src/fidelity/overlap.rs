//! How much a contour and what grew in it are the same area.
//!
//! `contour + twigs and leaves -> cells of both, of either`

use base::map_indexed;
use geom::contains;
use glam::{DVec2, DVec3};
use plant::{AxisId, Plant, Shape};
use reading::RegionKind;

use crate::Built;
use crate::fill::GrownContour;

/// Cells along the longer side of a contour: half a cell is below 1 % of it.
const CELLS: f64 = 64.0;

/// The areas that all contours share with what grew in them, over the areas of either: 0 to 1. `None` without contours.
///
/// Seen from the front. Gaps between leaves up to an eighth of the contour's inradius count as covered, between bare
/// twigs up to half of it: a person, too, sees one crown.
pub(super) fn overlap(built: &Built, run: &base::Run<'_>) -> Option<f64> {
    let shares = map_indexed(run.executor, built.grown.len(), |i| {
        let grown = &built.grown[i];
        let mut grid = Grid::new(&grown.outline)?;
        grid.cover(&built.plant, grown);
        Some(grid.shared(grown))
    });
    let (mut both, mut either) = (0.0, 0.0);
    for (b, e) in shares.into_iter().flatten() {
        both += b;
        either += e;
    }
    (either > 0.0).then(|| both / either)
}

struct Grid {
    low: DVec2,
    cell: f64,
    nx: usize,
    ny: usize,
    covered: Vec<bool>,
}

impl Grid {
    fn new(outline: &[DVec2]) -> Option<Self> {
        let low = outline.iter().copied().reduce(DVec2::min)?;
        let high = outline.iter().copied().reduce(DVec2::max)?;
        let longest = (high - low).max_element();
        if !(longest > 1e-9 && longest.is_finite()) {
            return None;
        }
        let cell = longest / CELLS;
        // A quarter around it: what stands out farther is not seen to the end, but counts.
        let margin = 0.25 * longest;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1.5 CELLS")]
        let count = |extent: f64| ((extent + 2.0 * margin) / cell).ceil() as usize + 1;
        let (nx, ny) = (count(high.x - low.x), count(high.y - low.y));
        Some(Self { low: low - margin, cell, nx, ny, covered: vec![false; nx * ny] })
    }

    fn centre(&self, i: usize) -> DVec2 {
        #[expect(clippy::cast_precision_loss, reason = "cells of a small grid")]
        let at = DVec2::new((i % self.nx) as f64, (i / self.nx) as f64);
        self.low + (at + 0.5) * self.cell
    }

    /// Marks the cells of what grew: blades by their outlines, axes by their lines.
    fn cover(&mut self, plant: &Plant, grown: &GrownContour) {
        for axis in grown.axes.clone() {
            let line = plant.axis_points(AxisId::new(axis));
            line.windows(2).for_each(|w| self.line(w[0].truncate(), w[1].truncate()));
        }
        // One surface for each shape: a crown's leaves share a few.
        let blades: Vec<Option<Vec<DVec3>>> = (plant.shapes.iter())
            .map(|shape| match shape {
                Shape::Blade(blade) => Some(blade.surface().points(&blade.outline)),
                _ => None,
            })
            .collect();
        for organ in &plant.organs[grown.organs.clone()] {
            let Some(Some(blade)) = blades.get(organ.shape.index()) else { continue };
            let ring: Vec<DVec2> =
                blade.iter().map(|&p| organ.frame.place(p, organ.scale).truncate()).collect();
            self.polygon(&ring);
        }
    }

    fn line(&mut self, a: DVec2, b: DVec2) {
        if !(a.is_finite() && b.is_finite()) {
            return;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded by min")]
        let steps = (a.distance(b) / (0.5 * self.cell)).ceil().clamp(1.0, 1e3) as u32;
        for k in 0..=steps {
            let p = (a.lerp(b, f64::from(k) / f64::from(steps)) - self.low) / self.cell;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "cast saturates")]
            let (x, y) = (p.x as usize, p.y as usize);
            if p.min_element() >= 0.0 && x < self.nx && y < self.ny {
                self.covered[y * self.nx + x] = true;
            }
        }
    }

    /// The cells whose middle lies in a polygon, and those on its margin.
    fn polygon(&mut self, ring: &[DVec2]) {
        let n = ring.len();
        (0..n).for_each(|i| self.line(ring[i], ring[(i + 1) % n]));
        let low = ring.iter().fold(DVec2::INFINITY, |a, &p| a.min(p));
        let high = ring.iter().fold(DVec2::NEG_INFINITY, |a, &p| a.max(p));
        // Below two cells its margin is all of it.
        if (high - low).min_element() <= 2.0 * self.cell {
            return;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "casts saturate")]
        let cell = |p: DVec2| (p.x.max(0.0) as usize, p.y.max(0.0) as usize);
        let (first, last) = (cell((low - self.low) / self.cell), cell((high - self.low) / self.cell));
        for y in first.1..=last.1.min(self.ny - 1) {
            for x in first.0..=last.0.min(self.nx - 1) {
                let i = y * self.nx + x;
                if !self.covered[i] && contains(ring, self.centre(i)) {
                    self.covered[i] = true;
                }
            }
        }
    }

    /// The area in both and in either, square metres.
    fn shared(&self, grown: &GrownContour) -> (f64, f64) {
        let inside: Vec<bool> =
            (0..self.covered.len()).map(|i| contains(&grown.outline, self.centre(i))).collect();
        let inradius = self.distances(&inside.iter().map(|i| !i).collect::<Vec<_>>());
        let inradius = inradius.into_iter().fold(0.0, f64::max);
        let bridged = inradius * if grown.kind == RegionKind::Twigs { 0.5 } else { 0.125 };
        let covered = self.closed(bridged);
        let (mut both, mut either) = (0.0, 0.0);
        for (a, b) in inside.into_iter().zip(covered) {
            both += f64::from(u8::from(a && b));
            either += f64::from(u8::from(a || b));
        }
        let area = self.cell * self.cell;
        (both * area, either * area)
    }

    /// What is covered, gaps narrower than twice a radius (in cells) filled: grown by it, then shrunk by it.
    fn closed(&self, radius: f64) -> Vec<bool> {
        let near: Vec<bool> = self.distances(&self.covered).into_iter().map(|d| d <= radius).collect();
        let open: Vec<bool> = near.iter().map(|n| !n).collect();
        self.distances(&open).into_iter().zip(&self.covered).map(|(d, &c)| c || d > radius).collect()
    }

    /// Distance of each cell to the nearest that is set, in cells (chamfer, two sweeps: exact to 8 %).
    fn distances(&self, set: &[bool]) -> Vec<f64> {
        const ACROSS: f64 = core::f64::consts::SQRT_2;
        let (nx, ny) = (self.nx, self.ny);
        let mut d: Vec<f64> = set.iter().map(|&s| if s { 0.0 } else { f64::INFINITY }).collect();
        for i in 0..d.len() {
            let (x, y) = (i % nx, i / nx);
            let mut best = d[i];
            if x > 0 {
                best = best.min(d[i - 1] + 1.0);
            }
            if y > 0 {
                best = best.min(d[i - nx] + 1.0);
                best = if x > 0 { best.min(d[i - nx - 1] + ACROSS) } else { best };
                best = if x + 1 < nx { best.min(d[i - nx + 1] + ACROSS) } else { best };
            }
            d[i] = best;
        }
        for i in (0..d.len()).rev() {
            let (x, y) = (i % nx, i / nx);
            let mut best = d[i];
            if x + 1 < nx {
                best = best.min(d[i + 1] + 1.0);
            }
            if y + 1 < ny {
                best = best.min(d[i + nx] + 1.0);
                best = if x > 0 { best.min(d[i + nx - 1] + ACROSS) } else { best };
                best = if x + 1 < nx { best.min(d[i + nx + 1] + ACROSS) } else { best };
            }
            d[i] = best;
        }
        d
    }
}
