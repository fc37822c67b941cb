//! Measures how far a contour and its growth cover the same area.
//!
//! `contour + twigs and leaves -> cells of both, of either`

use core::ops::Range;

use base::{Cancelled, LiteMap, map_until_cancelled};
use geom::contains_along;
use glam::{DVec2, DVec3};
use plant::{AxisId, Plant, Shape};
use reading::RegionKind;

use crate::Built;
use crate::fill::GrownContour;

/// Cells along the longer side of a contour: half a cell is below 1 % of it.
const CELLS: f64 = 64.0;
/// A cell's side in whole numbers, which are compared in half the time.
const SIDE: u32 = 985;
/// A cell's diagonal in the same unit: the ratio is the square root of 2 to 4e-7.
const ACROSS: u32 = 1393;

/// Returns the area that all contours share with their growth, over the area of either: 0 to 1. `None` without
/// contours.
///
/// Seen from the front. Gaps between leaves up to an eighth of the contour's inradius count as covered, between bare
/// twigs up to half of it: a person, too, sees one crown.
pub(super) fn overlap(built: &Built, run: &base::Run<'_>) -> Result<Option<f64>, Cancelled> {
    let shares = map_until_cancelled(run, built.grown.len(), |i| {
        let grown = &built.grown[i];
        let mut grid = Grid::new(&grown.outline)?;
        grid.cover(&built.plant, grown);
        Some(grid.shared(grown))
    })?;
    let (mut both, mut either) = (0.0, 0.0);
    for (b, e) in shares.into_iter().flatten() {
        both += b;
        either += e;
    }
    Ok((either > 0.0).then(|| both / either))
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
        // A quarter around it: growth that stands out farther is cut off, but counts.
        let margin = 0.25 * longest;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1.5 CELLS")]
        let count = |extent: f64| ((extent + 2.0 * margin) / cell).ceil() as usize + 1;
        let (nx, ny) = (count(high.x - low.x), count(high.y - low.y));
        Some(Self { low: low - margin, cell, nx, ny, covered: vec![false; nx * ny] })
    }

    /// Returns whether the middle of each cell of one row lies in a polygon.
    fn within(&self, ring: &[DVec2], cells: Range<usize>) -> Vec<bool> {
        let y = self.centre(cells.start).y;
        contains_along(ring, y, cells.map(|i| self.centre(i).x)).collect()
    }

    fn centre(&self, i: usize) -> DVec2 {
        #[expect(clippy::cast_precision_loss, reason = "cells of a small grid")]
        let at = DVec2::new((i % self.nx) as f64, (i / self.nx) as f64);
        self.low + (at + 0.5) * self.cell
    }

    /// Marks the cells of the growth: blades by their outlines, axes by their lines.
    fn cover(&mut self, plant: &Plant, grown: &GrownContour) {
        for axis in grown.axes.clone() {
            let line = plant.axis_points(AxisId::new(axis));
            line.windows(2).for_each(|w| self.line(w[0].truncate(), w[1].truncate()));
        }
        // One surface for each shape: a crown's leaves share a few.
        let mut blades: LiteMap<usize, Vec<DVec3>> = LiteMap::new();
        for organ in &plant.organs[grown.organs.clone()] {
            let Some(Shape::Blade(shape)) = plant.shapes.get(organ.shape.index()) else { continue };
            let blade =
                blades.entry(organ.shape.index()).or_insert_with(|| shape.surface().points(&shape.outline));
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

    /// Marks the cells whose middle lies in a polygon, and those on its margin.
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
            let cells = y * self.nx + first.0..y * self.nx + last.0.min(self.nx - 1) + 1;
            for (i, inside) in cells.clone().zip(self.within(ring, cells)) {
                self.covered[i] |= inside;
            }
        }
    }

    /// Returns the area in both and in either, square metres.
    fn shared(&self, grown: &GrownContour) -> (f64, f64) {
        let row = |y| self.within(&grown.outline, y * self.nx..(y + 1) * self.nx);
        let inside: Vec<bool> = (0..self.ny).flat_map(row).collect();
        let inradius = self.distances(&inside, false).into_iter().max().unwrap_or_default();
        let bridged = inradius / if grown.kind == RegionKind::Twigs { 2 } else { 8 };
        let covered = self.closed(bridged);
        let (mut both, mut either) = (0_u32, 0_u32);
        for (a, b) in inside.into_iter().zip(covered) {
            both += u32::from(a && b);
            either += u32::from(a || b);
        }
        let area = self.cell * self.cell;
        (f64::from(both) * area, f64::from(either) * area)
    }

    /// Returns the covered cells with gaps narrower than twice a distance filled: grown by it, then shrunk by it.
    fn closed(&self, radius: u32) -> Vec<bool> {
        let near: Vec<bool> = self.distances(&self.covered, true).into_iter().map(|d| d <= radius).collect();
        let open = self.distances(&near, false);
        open.into_iter().zip(&self.covered).map(|(d, &c)| c || d > radius).collect()
    }

    /// Returns the distance of each cell to the nearest one that is, or is not, set, in units where a cell's side is
    /// [`SIDE`] (chamfer, two sweeps: exact to 8 %).
    fn distances(&self, cells: &[bool], set: bool) -> Vec<u32> {
        const FAR: u32 = u32::MAX / 2;
        // With a margin of cells that are far from everything, so that every cell has eight neighbours.
        let wide = self.nx + 2;
        let mut d = vec![FAR; wide * (self.ny + 2)];
        for (row, cells) in d.chunks_exact_mut(wide).skip(1).zip(cells.chunks_exact(self.nx)) {
            for (d, &cell) in row[1..].iter_mut().zip(cells) {
                *d = if cell == set { 0 } else { FAR };
            }
        }
        for y in 1..=self.ny {
            let (above, row) = d[(y - 1) * wide..(y + 1) * wide].split_at_mut(wide);
            for (x, above) in above.windows(3).enumerate() {
                let near = row[x].min(above[1]) + SIDE;
                row[x + 1] = row[x + 1].min(near).min(above[0].min(above[2]) + ACROSS);
            }
        }
        for y in (1..=self.ny).rev() {
            let (row, below) = d[y * wide..(y + 2) * wide].split_at_mut(wide);
            for (x, below) in below.windows(3).enumerate().rev() {
                let near = row[x + 2].min(below[1]) + SIDE;
                row[x + 1] = row[x + 1].min(near).min(below[0].min(below[2]) + ACROSS);
            }
        }
        let mut inner = Vec::with_capacity(self.nx * self.ny);
        for row in d.chunks_exact(wide).skip(1).take(self.ny) {
            inner.extend_from_slice(&row[1..=self.nx]);
        }
        inner
    }
}
