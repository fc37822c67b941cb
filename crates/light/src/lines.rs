//! Parallel lines through a scene, evenly spaced, and all the surfaces that each of them crosses.
//!
//! A line that passes through an edge of two triangles crosses exactly one of them: corners are whole numbers of
//! sub-pixels, and the arithmetic that decides is exact. Lines through a scene that repeats itself leave its cell on
//! one side and enter again on the other.

use base::CancelToken;
use glam::{DVec2, DVec3};

use crate::{LightError, LitScene};

/// Sub-pixels along the edge of a pixel; a line goes through the middle of each pixel.
const SUB: i64 = 256;

/// Cells of soil along each side of its grid.
pub(crate) const SOIL_SIDE: u32 = 16;

/// The cell of soil that stands for everything outside of the grid: in the open.
pub(crate) const OPEN_SOIL: usize = (SOIL_SIDE * SOIL_SIDE) as usize;

/// Most crossings in one direction: some 24 bytes each on each thread.
const MOST_CROSSINGS: usize = 12_000_000;

/// Largest coordinate, in pixels, whose products in sub-pixels still fit 64-bit integers.
const FARTHEST_PIXEL: f64 = 3.9e6;

/// Sine of the elevation below which a cell that repeats itself has fewer lines: as many as lie as densely across the
/// light as those of this elevation.
const FULL_SINE: f64 = 0.25;

/// Triangles between two checks for cancellation.
const TRIANGLES_AT_ONCE: usize = 100_000;

/// Level of the ground of a scene, and the period of the scene.
#[derive(Clone, Debug)]
pub(crate) struct Ground {
    /// Height of the soil, metres.
    pub(crate) level_m: f64,
    /// Width along X and depth along Z of the cell that repeats itself, metres.
    pub(crate) repeat_m: Option<DVec2>,
    /// Lowest corner of the soil's grid (X, Z), and the size of the whole grid.
    from: DVec2,
    size: DVec2,
}

impl Ground {
    pub(crate) fn new(scene: &LitScene, level_m: f64, repeat_m: Option<[f64; 2]>) -> Self {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for corner in scene.triangles.iter().flatten() {
            low = low.min(scene.points[*corner as usize]);
            high = high.max(scene.points[*corner as usize]);
        }
        let repeat_m = repeat_m.map(DVec2::from_array);
        // An isolated plant shades the ground around it.
        let margin = 0.5 * (high.y - low.y).max(0.0);
        let around = DVec2::new(high.x - low.x, high.z - low.z) + 2.0 * margin;
        let from = DVec2::new(low.x - margin, low.z - margin);
        Self { level_m, repeat_m, from, size: repeat_m.unwrap_or(around.max(DVec2::splat(1e-6))) }
    }

    /// Returns the area of a cell of soil, square metres.
    pub(crate) fn cell_area(&self) -> f64 {
        self.size.x * self.size.y / f64::from(SOIL_SIDE * SOIL_SIDE)
    }

    /// Returns the cell of soil at a place.
    fn cell(&self, at: DVec2) -> usize {
        let share = (at - self.from) / self.size;
        if !(share.cmpge(DVec2::ZERO).all() && share.cmplt(DVec2::ONE).all()) {
            return OPEN_SOIL;
        }
        let row = share * f64::from(SOIL_SIDE);
        row_of(row.y, SOIL_SIDE) * SOIL_SIDE as usize + row_of(row.x, SOIL_SIDE)
    }
}

/// Converts a number of 0 or more to a row below `rows`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded on both sides")]
fn row_of(x: f64, rows: u32) -> usize {
    x.clamp(0.0, f64::from(rows - 1)) as usize
}

/// Lines in one direction. Coordinates across them are in pixels, along them in metres towards the light.
#[derive(Clone, Debug)]
pub(crate) struct Lines {
    to: DVec3,
    /// Pixel coordinates of a point: the vectors to multiply it with, and offsets.
    across: [DVec3; 2],
    first: DVec2,
    along: DVec3,
    /// Height: its change with the second coordinate, its change along the line, and the height of the origin.
    height: [f64; 3],
    columns: u32,
    rows: u32,
    wraps: bool,
    /// Area that each line represents, across it, square metres.
    pub(crate) area: f64,
}

impl Lines {
    /// Makes about `count` lines over the scene, or over its cell. `jitter`: offset of the pixels, 0 to 1.
    pub(crate) fn new(scene: &LitScene, ground: &Ground, to: DVec3, count: u32, jitter: DVec2) -> Self {
        match ground.repeat_m {
            Some(cell) => Self::over_cell(ground, cell, to, (count, jitter)),
            None => Self::over_all(scene, to, count, jitter),
        }
    }

    fn over_cell(ground: &Ground, cell: DVec2, to: DVec3, (count, jitter): (u32, DVec2)) -> Self {
        // Low light crosses many leaves on its way to the ground.
        let count = f64::from(count) * (to.y / FULL_SINE).min(1.0);
        // A whole number of lines for each cell of soil.
        let wanted = (count * cell.x / cell.y).sqrt();
        let whole =
            |n: f64| SOIL_SIDE * base::ops::whole((n / f64::from(SOIL_SIDE)).round().clamp(1.0, 65_536.0));
        let columns = whole(wanted);
        let rows = whole(count / f64::from(columns));
        let pixel = DVec2::new(cell.x / f64::from(columns), cell.y / f64::from(rows));
        let slope = DVec2::new(to.x, to.z) / to.y;
        Self {
            to,
            across: [DVec3::new(1.0, -slope.x, 0.0) / pixel.x, DVec3::new(0.0, -slope.y, 1.0) / pixel.y],
            first: slope * ground.level_m / pixel + jitter,
            along: DVec3::Y,
            height: [0.0, 1.0, 0.0],
            columns,
            rows,
            wraps: true,
            area: pixel.x * pixel.y * to.y,
        }
    }

    fn over_all(scene: &LitScene, to: DVec3, count: u32, jitter: DVec2) -> Self {
        let flat = DVec3::new(to.z, 0.0, -to.x);
        let right = flat.try_normalize().unwrap_or(DVec3::X);
        let up = to.cross(right);
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in scene.triangles.iter().flatten() {
            let p = scene.points[*corner as usize];
            let at = DVec2::new(p.dot(right), p.dot(up));
            (low, high) = (low.min(at), high.max(at));
        }
        let size = (high - low).max(DVec2::splat(1e-3 * (high - low).max_element()));
        let pixel = (size.x * size.y / f64::from(count)).sqrt().max(f64::MIN_POSITIVE);
        // The jitter moves the scene by up to one pixel.
        let pixels = |n: f64| base::ops::whole((n / pixel).ceil().min(1e9)) + 2;
        Self {
            to,
            across: [right / pixel, up / pixel],
            first: -low / pixel + jitter,
            along: to,
            height: [up.y * pixel, to.y, up.y * (low.y - jitter.y * pixel)],
            columns: pixels(size.x),
            rows: pixels(size.y),
            wraps: false,
            area: pixel * pixel,
        }
    }

    /// Returns the area of a horizontal surface that each line represents, square metres.
    pub(crate) fn horizontal_area(&self) -> f64 {
        self.area / self.to.y
    }

    /// Returns the cell of soil at which a line ends.
    fn soil(&self, ground: &Ground, pixel: u32) -> u16 {
        let (column, row) = (pixel % self.columns, pixel / self.columns);
        let cell = if self.wraps {
            let share = |k: u32, of: u32| u64::from(k) * u64::from(SOIL_SIDE) / u64::from(of);
            let place = |k: u32, of: u32| usize::try_from(share(k, of)).unwrap_or_default();
            place(row, self.rows) * SOIL_SIDE as usize + place(column, self.columns)
        } else {
            // Across the line in metres, then along it down to the level.
            let middle = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5) - self.first;
            let [u, v] = self.across.map(|a| a / a.length_squared());
            let flat = u * middle.x + v * middle.y;
            let at = flat + self.to * ((ground.level_m - flat.y) / self.to.y);
            ground.cell(DVec2::new(at.x, at.z))
        };
        u16::try_from(cell).unwrap_or(u16::MAX)
    }

    /// Returns all that each line crosses above the soil, starting from the light.
    ///
    /// # Errors
    /// [`LightError::Crowded`], [`LightError::Cancelled`].
    pub(crate) fn cross(
        &self,
        scene: &LitScene,
        ground: &Ground,
        cancel: &CancelToken,
    ) -> Result<Crossings, LightError> {
        let place = |p: &DVec3| {
            let across = DVec2::new(self.across[0].dot(*p), self.across[1].dot(*p)) + self.first;
            Placed { across, whole: [snapped(across.x), snapped(across.y)], along: self.along.dot(*p) }
        };
        let placed: Vec<Placed> = scene.points.iter().map(place).collect();
        if placed.iter().any(|p| p.across.abs().max_element() > FARTHEST_PIXEL) {
            return Err(self.crowded(scene));
        }
        let mut found: Vec<Found> = Vec::new();
        for (k, corners) in scene.triangles.iter().enumerate() {
            if k % TRIANGLES_AT_ONCE == 0 {
                cancel.check()?;
            }
            let corners = corners.map(|i| &placed[i as usize]);
            let Some(flat) = Flat::new(corners) else { continue };
            let is_front = u32::from(scene.normal(k).dot(self.to) > 0.0);
            let hit = 2 * u32::try_from(k).unwrap_or(u32::MAX / 2) + is_front;
            if flat.size > MOST_CROSSINGS as i64 {
                return Err(self.crowded(scene));
            }
            flat.each_pixel(|x, y| {
                let along = flat.along(x, y);
                let height = self.height[0] * (y as f64 + 0.5) + self.height[1] * along + self.height[2];
                if let Some(pixel) = self.pixel(x, y).filter(|_| height >= ground.level_m) {
                    #[expect(
                        clippy::cast_possible_truncation,
                        reason = "single precision tells layers apart"
                    )]
                    found.push(Found { pixel, along: along as f32, hit });
                }
            });
            if found.len() > MOST_CROSSINGS {
                return Err(self.crowded(scene));
            }
        }
        cancel.check()?;
        Ok(self.sorted(&found, ground))
    }

    fn pixel(&self, x: i64, y: i64) -> Option<u32> {
        let (columns, rows) = (i64::from(self.columns), i64::from(self.rows));
        let (x, y) = if self.wraps { (x.rem_euclid(columns), y.rem_euclid(rows)) } else { (x, y) };
        let is_inside = (0..columns).contains(&x) && (0..rows).contains(&y);
        is_inside.then(|| u32::try_from(y * columns + x).ok()).flatten()
    }

    fn crowded(&self, scene: &LitScene) -> LightError {
        let area: f64 = (0..scene.triangles.len()).map(|t| 0.5 * scene.normal(t).dot(self.to).abs()).sum();
        let crossings = area / self.area;
        let lines = f64::from(self.columns) * f64::from(self.rows);
        LightError::Crowded {
            surfaces: crossings / lines,
            crossings: crossings / 1e6,
            most: MOST_CROSSINGS as f64 / 1e6,
        }
    }

    /// Sorts crossings by line, then from the light on; those at the same place in the order of triangles.
    fn sorted(&self, found: &[Found], ground: &Ground) -> Crossings {
        let mut starts = vec![0_u32; self.columns as usize * self.rows as usize + 1];
        for f in found {
            starts[f.pixel as usize + 1] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut next = starts.clone();
        let mut sorted = vec![(0.0_f32, 0_u32); found.len()];
        for f in found {
            let place = &mut next[f.pixel as usize];
            sorted[*place as usize] = (f.along, f.hit);
            *place += 1;
        }
        let mut crossings = Crossings { hits: Vec::with_capacity(found.len()), ..Crossings::default() };
        for (pixel, ends) in (0_u32..).zip(starts.windows(2)) {
            let line = &mut sorted[ends[0] as usize..ends[1] as usize];
            if line.is_empty() {
                continue;
            }
            // With few crossings, insertion keeps the order of equal ones.
            for i in 1..line.len() {
                let mut k = i;
                while k > 0 && line[k - 1].0 < line[k].0 {
                    line.swap(k - 1, k);
                    k -= 1;
                }
            }
            crossings.hits.extend(line.iter().map(|(_, hit)| *hit));
            crossings.ends.push(u32::try_from(crossings.hits.len()).unwrap_or(u32::MAX));
            crossings.soil.push(self.soil(ground, pixel));
        }
        crossings
    }
}

/// Crossings of the lines of one direction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Crossings {
    /// Twice the row of the triangle, plus 1 if the light meets its front; from the light on, line after line.
    hits: Vec<u32>,
    /// End in `hits` of each line that crosses something.
    ends: Vec<u32>,
    /// Cell of soil below each line.
    soil: Vec<u16>,
}

impl Crossings {
    /// Iterates over the lines that cross something: all crossings of each, and the cell of soil at its end.
    pub(crate) fn lines(&self) -> impl Iterator<Item = (&[u32], usize)> {
        let mut start = 0;
        self.ends.iter().zip(&self.soil).map(move |(end, soil)| {
            let line = &self.hits[start..*end as usize];
            start = *end as usize;
            (line, usize::from(*soil))
        })
    }

    /// Returns how many lines cross something.
    pub(crate) fn count(&self) -> usize {
        self.ends.len()
    }

    pub(crate) fn bytes(&self) -> usize {
        4 * (self.hits.len() + self.ends.len()) + 2 * self.soil.len()
    }
}

/// A place at which a line crosses a triangle.
#[derive(Clone, Copy, Debug)]
struct Found {
    pixel: u32,
    along: f32,
    hit: u32,
}

/// A corner, in coordinates of the lines.
#[derive(Clone, Copy, Debug)]
struct Placed {
    across: DVec2,
    /// Position across the lines, sub-pixels.
    whole: [i32; 2],
    along: f64,
}

#[expect(clippy::cast_possible_truncation, reason = "at most the farthest pixel is kept")]
fn snapped(x: f64) -> i32 {
    (x * SUB as f64).round() as i32
}

/// A triangle in the coordinates of the lines.
struct Flat {
    /// Corners, counter-clockwise, in sub-pixels.
    corners: [[i64; 2]; 3],
    /// First and last columns and rows of pixels whose centres may lie in the triangle.
    columns: [i64; 2],
    rows: [i64; 2],
    /// Coordinate along the line at a place, its gradient across the lines, and its bounds.
    from: DVec2,
    at_from: f64,
    slope: DVec2,
    bounds: [f64; 2],
    /// Measure of the time to scan the triangle: rows, or all pixels.
    size: i64,
}

/// An edge: points inside have at least `least` at `start + x * step`.
#[derive(Clone, Copy)]
struct Edge {
    start: i64,
    step: [i64; 2],
    least: i64,
}

impl Flat {
    /// Returns `None` if no line can cross the triangle.
    fn new([a, b, c]: [&Placed; 3]) -> Option<Self> {
        let corners = [a, b, c].map(|p| p.whole.map(i64::from));
        let range = |k: usize| {
            let of = corners.map(|p| p[k]);
            let (low, high) = (of[0].min(of[1]).min(of[2]), of[0].max(of[1]).max(of[2]));
            [(low + SUB / 2 - 1).div_euclid(SUB), (high - SUB / 2).div_euclid(SUB)]
        };
        let (columns, rows) = (range(0), range(1));
        if columns[0] > columns[1] || rows[0] > rows[1] {
            return None;
        }
        let [p, q, r] = corners;
        let twice = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        if twice == 0 {
            return None;
        }
        let corners = if twice < 0 { [p, r, q] } else { corners };
        let (u, v) = (b.across - a.across, c.across - a.across);
        let (du, dv) = (b.along - a.along, c.along - a.along);
        let slope = DVec2::new(du * v.y - dv * u.y, dv * u.x - du * v.x) / u.perp_dot(v);
        let all = [a.along, b.along, c.along];
        let bounds = [
            all.iter().copied().fold(f64::INFINITY, f64::min),
            all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ];
        let slope = if slope.is_finite() { slope } else { DVec2::ZERO };
        let size = (twice.abs() / (2 * SUB * SUB)).max(rows[1] - rows[0]);
        Some(Self { corners, columns, rows, from: a.across, at_from: a.along, slope, bounds, size })
    }

    fn along(&self, x: i64, y: i64) -> f64 {
        let middle = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        // The slope of a triangle seen almost from its edge is very large.
        (self.at_from + self.slope.dot(middle - self.from)).clamp(self.bounds[0], self.bounds[1])
    }

    fn edges(&self) -> [Edge; 3] {
        [0, 1, 2].map(|k| {
            let (p, q) = (self.corners[k], self.corners[(k + 1) % 3]);
            let [dx, dy] = [q[0] - p[0], q[1] - p[1]];
            // The middle of the first pixel.
            let [x, y] = [self.columns[0], self.rows[0]].map(|first| first * SUB + SUB / 2);
            let start = dx * (y - p[1]) - dy * (x - p[0]);
            // A point on an edge belongs to the triangle for which the edge goes up, or to the left.
            let owns = dy > 0 || (dy == 0 && dx < 0);
            Edge { start, step: [-dy * SUB, dx * SUB], least: i64::from(!owns) }
        })
    }

    /// Calls `found` with the pixels whose centres lie in the triangle.
    fn each_pixel(&self, mut found: impl FnMut(i64, i64)) {
        let edges = self.edges();
        let width = self.columns[1] - self.columns[0];
        for (down, y) in (0..).zip(self.rows[0]..=self.rows[1]) {
            let values = edges.map(|e| e.start + down * e.step[1]);
            let span = if width > FEW_COLUMNS { span(&edges, values, width) } else { [0, width] };
            for x in span[0]..=span[1] {
                let is_inside = (0..3).all(|k| values[k] + x * edges[k].step[0] >= edges[k].least);
                if is_inside {
                    found(self.columns[0] + x, y);
                }
            }
        }
    }
}

/// Most columns that are tested one by one rather than by division.
const FEW_COLUMNS: i64 = 8;

/// Returns the columns, from the first, that are inside of all edges in a row; the first is behind the last if there
/// are none.
fn span(edges: &[Edge; 3], values: [i64; 3], width: i64) -> [i64; 2] {
    let mut span = [0, width];
    for (edge, value) in edges.iter().zip(values) {
        let (missing, step) = (edge.least - value, edge.step[0]);
        match step {
            0 if missing > 0 => return [1, 0],
            0 => {}
            1.. => span[0] = span[0].max(-(-missing).div_euclid(step)),
            _ => span[1] = span[1].min((-missing).div_euclid(-step)),
        }
    }
    span
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Optics;

    fn square(size: f64) -> LitScene {
        let corner = |x: f64, z: f64| DVec3::new(x * size, 1.0, z * size);
        LitScene {
            points: vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)],
            triangles: vec![[0, 2, 1], [0, 3, 2]],
            owners: vec![0, 0],
            receivers: vec![Optics::BLACK],
        }
    }

    #[test]
    fn a_cell_that_is_full_is_crossed_once_by_every_line() {
        let scene = square(2.0);
        let ground = Ground::new(&scene, 0.0, Some([2.0, 2.0]));
        for (to, _) in crate::sky::sky_directions() {
            let lines = Lines::new(&scene, &ground, to, 5_000, DVec2::new(0.3, 0.7));
            let found = lines.cross(&scene, &ground, &CancelToken::new()).expect("crossings");
            assert_eq!(found.count(), (lines.columns * lines.rows) as usize);
            assert!(found.lines().all(|(line, _)| line.len() == 1));
        }
    }

    #[test]
    fn the_area_that_lines_see_is_that_of_the_projection() {
        let scene = square(3.0);
        let ground = Ground::new(&scene, 0.0, None);
        for (to, _) in crate::sky::sky_directions() {
            let lines = Lines::new(&scene, &ground, to, 100_000, DVec2::new(0.3, 0.7));
            let found = lines.cross(&scene, &ground, &CancelToken::new()).expect("crossings");
            let seen = found.count() as f64 * lines.area;
            assert!((seen / (9.0 * to.y) - 1.0).abs() < 0.01, "{seen} of {}", 9.0 * to.y);
        }
    }

    #[test]
    fn what_lies_below_the_soil_is_not_crossed() {
        let scene = square(1.0);
        let ground = Ground::new(&scene, 1.5, None);
        let lines = Lines::new(&scene, &ground, DVec3::Y, 1_000, DVec2::ZERO);
        assert_eq!(lines.cross(&scene, &ground, &CancelToken::new()).expect("nothing").count(), 0);
    }

    #[test]
    fn long_and_short_triangles_meet_along_their_edges() {
        // A fan of slivers around a point fills a disc: every line crosses it once.
        let rim = |k: u32| {
            let (sin, cos) = base::ops::sin_cos(base::ops::TAU * f64::from(k % 97) / 97.0);
            DVec3::new(cos, 0.5, sin)
        };
        let points = [DVec3::new(0.1, 0.5, 0.2)].into_iter().chain((0..97).map(rim)).collect();
        let triangles: Vec<[u32; 3]> = (0..97).map(|k| [0, 1 + (k + 1) % 97, 1 + k]).collect();
        let scene = LitScene { points, owners: vec![0; 97], triangles, receivers: vec![Optics::BLACK] };
        let ground = Ground::new(&scene, 0.0, None);
        let to = crate::direction_to(20.0, 50.0);
        let lines = Lines::new(&scene, &ground, to, 50_000, DVec2::new(0.2, 0.9));
        let found = lines.cross(&scene, &ground, &CancelToken::new()).expect("crossings");
        assert!(found.lines().all(|(line, _)| line.len() == 1));
        assert!((found.count() as f64 * lines.area / (3.1394 * to.y) - 1.0).abs() < 0.002);
    }
}
