//! Keep-outs and water: polygons and lines by the cells of a grid.

use geom::Inside;
use glam::DVec2;

use crate::spec::Water;

/// Number of cells along each side of the grid.
const CELLS: usize = 128;

/// Boxes by the cells that they overlap.
struct Boxes {
    low: DVec2,
    cell: DVec2,
    cells: Vec<Vec<u32>>,
}

impl Boxes {
    fn new(low: DVec2, size: DVec2) -> Self {
        Self { low, cell: size / CELLS as f64, cells: vec![Vec::new(); CELLS * CELLS] }
    }

    fn index(&self, p: DVec2) -> (usize, usize) {
        let at = (p - self.low) / self.cell;
        let index = |v: f64| (base::ops::whole(v) as usize).min(CELLS - 1);
        (index(at.x), index(at.y))
    }

    fn add(&mut self, low: DVec2, high: DVec2, row: u32) {
        let ((x0, y0), (x1, y1)) = (self.index(low), self.index(high));
        for y in y0..=y1 {
            for x in x0..=x1 {
                self.cells[y * CELLS + x].push(row);
            }
        }
    }

    fn near(&self, p: DVec2) -> &[u32] {
        let (x, y) = self.index(p);
        &self.cells[y * CELLS + x]
    }
}

/// Keep-outs of a stand, and the distance to water.
pub(super) struct Shapes {
    outline: Option<Inside>,
    polygons: Vec<Inside>,
    polygon_boxes: Boxes,
    /// Segments with half the width of their river; 0 for shores.
    segments: Vec<(DVec2, DVec2, f64)>,
    segment_boxes: Boxes,
    /// Greatest distance from water that a species needs, metres.
    reach_m: f64,
}

fn points(of: &[[f64; 2]]) -> Vec<DVec2> {
    of.iter().map(|p| DVec2::from(*p)).filter(|p| p.is_finite()).collect()
}

impl Shapes {
    /// Sorts the shapes of a stand into a grid. `low` and `size`: the area.
    pub(super) fn new(
        low: DVec2,
        size: DVec2,
        outline: &[[f64; 2]],
        keep_out: &[Vec<[f64; 2]>],
        water: &[Water],
        reach_m: f64,
    ) -> Self {
        let mut shapes = Self {
            outline: (!outline.is_empty()).then(|| Inside::new(&points(outline))),
            polygons: Vec::new(),
            polygon_boxes: Boxes::new(low, size),
            segments: Vec::new(),
            segment_boxes: Boxes::new(low, size),
            reach_m,
        };
        keep_out.iter().for_each(|polygon| shapes.add_polygon(&points(polygon)));
        for water in water {
            let mut line = points(&water.points);
            if water.width_m.is_none() {
                shapes.add_polygon(&line);
                line.extend(line.first().copied());
            }
            let half = 0.5 * water.width_m.unwrap_or(0.0);
            for pair in line.windows(2) {
                let (low, high) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
                let reach = DVec2::splat(half + reach_m);
                let row = u32::try_from(shapes.segments.len()).unwrap_or(u32::MAX);
                shapes.segment_boxes.add(low - reach, high + reach, row);
                shapes.segments.push((pair[0], pair[1], half));
            }
        }
        shapes
    }

    fn add_polygon(&mut self, polygon: &[DVec2]) {
        let Some((low, high)) = geom::bounds(polygon) else { return };
        self.polygon_boxes.add(low, high, u32::try_from(self.polygons.len()).unwrap_or(u32::MAX));
        self.polygons.push(Inside::new(polygon));
    }

    /// Returns whether a tree may stand there.
    pub(super) fn is_open(&self, p: DVec2) -> bool {
        self.outline.as_ref().is_none_or(|outline| outline.has(p))
            && !self.polygon_boxes.near(p).iter().any(|&k| self.polygons[k as usize].has(p))
            && (self.segments.is_empty() || self.water_m(p) > 0.0)
    }

    /// Returns the distance to the nearest water, metres, as far as a species needs it; infinite beyond.
    pub(super) fn water_m(&self, p: DVec2) -> f64 {
        let near = self.segment_boxes.near(p).iter().map(|&k| {
            let (a, b, half) = self.segments[k as usize];
            (geom::distance_to_segment(a, b, p) - half).max(0.0)
        });
        near.filter(|d| *d <= self.reach_m).fold(f64::INFINITY, f64::min)
    }
}
