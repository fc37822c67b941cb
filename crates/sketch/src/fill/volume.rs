//! The body of a drawn contour.
//!
//! `contour (metres) -> Volume: inside?, clearance, half depth`
//!
//! Seen from the front the body is the contour, exactly. Its depth is not in the drawing: a crown is as deep
//! as it is wide, row by row; a contour around a branch is as deep as its inscribed circles are wide.

use glam::{DVec2, DVec3};

/// Ways to guess the depth of a contour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Inflation {
    /// Every horizontal row becomes a disc: crowns stand around an upright trunk.
    Rows,
    /// A ball rolls along the contour's middle: clusters follow a branch of any direction.
    Ball,
}

/// Cells along the longer side of the contour. 48: a cell is 2 % of the contour, below a leaf's width; the
/// whole grid is built in about 0.1 ms.
const CELLS: f64 = 48.0;
/// Depth of a crown over its width: looks round, keeps limbs from crowding the back.
const ROUND: f64 = 0.92;

/// A contour inflated into space. Lengths are metres in plant coordinates.
///
/// Guaranteed: [`contains_xy`](Self::contains_xy) is exact for the polygon; the other answers are
/// interpolated on a grid of about 48 cells.
#[derive(Clone, Debug)]
pub(super) struct Volume {
    outline: Vec<DVec2>,
    lo: DVec2,
    hi: DVec2,
    cell: f64,
    nx: usize,
    ny: usize,
    /// Signed distance to the contour at cell centres, positive inside.
    clear: Vec<f64>,
    /// Nearest point of the contour.
    nearest: Vec<DVec2>,
    depth: Vec<f64>,
    mid: Vec<f64>,
    /// Edges that touch each row of cells, as ranges of `row_edges`.
    row_start: Vec<usize>,
    row_edges: Vec<usize>,
    /// Area of the contour, m2.
    pub(super) area: f64,
    /// Radius of its greatest inscribed circle, m (to a cell).
    pub(super) inradius: f64,
    /// Half width of its widest row.
    pub(super) half_width: f64,
}

impl Volume {
    /// Returns the body of a simple polygon; `None` if it has almost no area (fewer than 3 points, a sliver,
    /// coordinates that are not finite).
    pub(super) fn new(outline: &[DVec2], inflation: Inflation) -> Option<Self> {
        if outline.len() < 3 || outline.iter().any(|p| !p.is_finite()) {
            return None;
        }
        let lo = outline.iter().copied().reduce(DVec2::min)?;
        let hi = outline.iter().copied().reduce(DVec2::max)?;
        let longest = (hi - lo).max_element();
        let area = shoelace(outline).abs();
        // A sliver narrower than a cell on average has no room for anything.
        let sound = longest.is_finite() && area > longest * longest / CELLS && longest > 1e-9;
        if !sound {
            return None;
        }
        let cell = longest / CELLS;
        let count = |extent: f64| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most CELLS")]
            let n = (extent / cell).ceil() as usize;
            n + 2
        };
        let (nx, ny) = (count(hi.x - lo.x), count(hi.y - lo.y));
        let n = nx * ny;
        let mut volume = Self {
            outline: outline.to_vec(),
            lo: lo - DVec2::splat(cell),
            hi,
            cell,
            nx,
            ny,
            clear: vec![0.0; n],
            nearest: vec![outline[0]; n],
            depth: vec![0.0; n],
            mid: vec![0.0; n],
            row_start: Vec::new(),
            row_edges: Vec::new(),
            area,
            inradius: 0.0,
            half_width: 0.0,
        };
        volume.bucket_edges();
        let inside = volume.scan_rows(inflation);
        volume.distances(&inside);
        volume.inradius = volume.clear.iter().copied().fold(cell * 0.5, f64::max);
        if inflation == Inflation::Ball {
            let r = volume.inradius;
            for (depth, &d) in volume.depth.iter_mut().zip(&volume.clear) {
                *depth = (d.max(0.0) * (2.0 * r - d)).max(0.0).sqrt();
            }
        } else {
            volume.smooth_depth(&inside);
        }
        Some(volume)
    }

    /// Returns the contour.
    pub(super) fn outline(&self) -> &[DVec2] {
        &self.outline
    }

    /// Returns the lower corner of the contour's box.
    pub(super) fn low(&self) -> DVec2 {
        self.lo + DVec2::splat(self.cell)
    }

    /// Returns the upper corner of the contour's box.
    pub(super) const fn high(&self) -> DVec2 {
        self.hi
    }

    /// Returns the height of the contour's box.
    pub(super) fn height(&self) -> f64 {
        self.hi.y - self.low().y
    }

    /// Returns the size of a cell, below which nothing is resolved.
    pub(super) const fn cell(&self) -> f64 {
        self.cell
    }

    /// Returns half the depth of the body at its deepest place.
    pub(super) fn deepest(&self) -> f64 {
        self.depth.iter().copied().fold(0.0, f64::max)
    }

    /// Returns the volume of the body, m3.
    pub(super) fn bulk(&self) -> f64 {
        2.0 * self.cell * self.cell * self.depth.iter().sum::<f64>()
    }

    /// Moves the middle of the body to the lines that run through it, away from z = 0.
    pub(super) fn follow(&mut self, lines: &[DVec3]) {
        if lines.is_empty() {
            return;
        }
        for iy in 0..self.ny {
            for ix in 0..self.nx {
                let c = self.centre(ix, iy);
                // Weighted by 1 / d^4, so that the middle is smooth between two branches of different depth.
                let (mut sum, mut weight) = (0.0, 0.0);
                for p in lines {
                    let d = p.truncate().distance_squared(c) + self.cell * self.cell;
                    let w = 1.0 / (d * d);
                    sum += w * p.z;
                    weight += w;
                }
                self.mid[iy * self.nx + ix] = sum / weight;
            }
        }
    }

    /// Moves the middle of the body to one depth.
    pub(super) fn centre_at(&mut self, z: f64) {
        self.mid.fill(z);
    }

    /// Whether the point is inside the contour, seen from the front. Exact (even-odd).
    pub(super) fn contains_xy(&self, p: DVec2) -> bool {
        let Some((ix, iy)) = self.cell_of(p) else {
            return false;
        };
        let clear = self.clear[iy * self.nx + ix];
        if clear.abs() > 2.0 * self.cell {
            return clear > 0.0;
        }
        let n = self.outline.len();
        let mut inside = false;
        for &e in &self.row_edges[self.row_start[iy]..self.row_start[iy + 1]] {
            let (a, b) = (self.outline[e], self.outline[(e + 1) % n]);
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
        }
        inside
    }

    /// Whether the point is inside the body.
    pub(super) fn contains(&self, p: DVec3) -> bool {
        let xy = p.truncate();
        self.contains_xy(xy) && (p.z - self.mid(xy)).abs() <= self.half_depth(xy)
    }

    /// Returns the distance to the contour in the plane, positive inside.
    pub(super) fn clearance(&self, p: DVec2) -> f64 {
        self.sample(&self.clear, p)
    }

    /// Returns half the depth of the body behind a point of the plane.
    pub(super) fn half_depth(&self, p: DVec2) -> f64 {
        self.sample(&self.depth, p)
    }

    /// Returns the depth of the body's middle.
    pub(super) fn mid(&self, p: DVec2) -> f64 {
        self.sample(&self.mid, p)
    }

    /// Returns the approximate distance of a point from the surface: 0 on it, the inradius at most.
    pub(super) fn inset(&self, p: DVec3) -> f64 {
        let xy = p.truncate();
        self.clearance(xy).min(self.half_depth(xy) - (p.z - self.mid(xy)).abs())
    }

    /// Returns the nearest point of the contour, in the plane.
    pub(super) fn nearest_xy(&self, p: DVec2) -> DVec2 {
        let clamped =
            p.clamp(self.lo, self.lo + DVec2::new(self.nx as f64, self.ny as f64) * self.cell * 0.999_9);
        self.cell_of(clamped).map_or(p, |(ix, iy)| self.nearest[iy * self.nx + ix])
    }

    /// Returns at most `n` points of the contour at equal arc lengths.
    pub(super) fn rim(&self, n: usize) -> Vec<DVec2> {
        let count = self.outline.len();
        let edge = |e: usize| (self.outline[e], self.outline[(e + 1) % count]);
        let whole: f64 = (0..count).map(|e| edge(e).0.distance(edge(e).1)).sum();
        let spacing = whole / n.max(1) as f64;
        let mut out = Vec::with_capacity(n);
        let (mut at, mut next) = (0.0, 0.5 * spacing);
        for (a, b) in (0..count).map(edge) {
            let long = a.distance(b);
            while next < at + long && out.len() < n {
                out.push(a.lerp(b, (next - at) / long));
                next += spacing;
            }
            at += long;
        }
        out
    }

    /// Returns the unit direction into the contour from a point on it; zero if it has none.
    pub(super) fn inward(&self, p: DVec2) -> DVec2 {
        let h = DVec2::splat(self.cell);
        let dx = self.clearance(p + h * DVec2::X) - self.clearance(p - h * DVec2::X);
        let dy = self.clearance(p + h * DVec2::Y) - self.clearance(p - h * DVec2::Y);
        DVec2::new(dx, dy).normalize_or_zero()
    }

    /// Returns the distance from an inner point to the surface along a unit vector, at most `reach`; to half a cell.
    pub(super) fn ray(&self, from: DVec3, direction: DVec3, reach: f64) -> f64 {
        let step = self.cell * 0.5;
        let mut at = 0.0;
        while at < reach {
            if !self.contains(from + direction * (at + step)) {
                return at;
            }
            at += step;
        }
        reach
    }

    /// Whether the straight segment between two points is inside the contour, seen from the front.
    pub(super) fn sees(&self, a: DVec2, b: DVec2) -> bool {
        (1..6).all(|i| self.contains_xy(a.lerp(b, f64::from(i) / 6.0)))
    }

    /// Returns the widest run of inner cells of the row at height `y`: its middle and half width; `None` outside.
    pub(super) fn row(&self, y: f64) -> Option<(f64, f64)> {
        let (_, iy) = self.cell_of(DVec2::new(self.lo.x, y))?;
        let mut best: Option<(usize, usize)> = None;
        let mut start = None;
        for ix in 0..=self.nx {
            let inside = ix < self.nx && self.clear[iy * self.nx + ix] > 0.0;
            match (inside, start) {
                (true, None) => start = Some(ix),
                (false, Some(s)) => {
                    if best.is_none_or(|(a, b)| ix - s > b - a) {
                        best = Some((s, ix));
                    }
                    start = None;
                }
                _ => {}
            }
        }
        best.map(|(a, b)| (self.lo.x + self.cell * 0.5 * (a + b) as f64, self.cell * 0.5 * (b - a) as f64))
    }

    /// Returns the height at which a crown that was drawn in one line with its trunk begins; `None` if there is no
    /// such neck.
    ///
    /// A neck is one narrow run (below 0.4 of the widest row), at least 0.12 of the height long, and opens at once (to
    /// 1.8 times its width over 0.08 of the height): a contour that opens evenly is a shrub.
    pub(super) fn neck(&self) -> Option<f64> {
        let (low, height) = (self.low().y, self.height());
        let width = |t: f64| self.row(low + t * height).map_or(0.0, |(_, w)| w);
        let narrow = 0.4 * self.half_width;
        let rows = (0..40).map(|i| 0.01 + 0.02 * f64::from(i));
        let single = |t: f64| self.inner_cells(low + t * height) as f64 * self.cell <= 2.1 * width(t);
        let top = rows.take_while(|&t| width(t) < narrow && single(t)).last()?;
        let opens = width(top + 0.08) > 1.8 * width(0.75 * top);
        (top >= 0.12 && opens).then_some(low + (top + 0.02) * height)
    }

    fn inner_cells(&self, y: f64) -> usize {
        let Some((_, iy)) = self.cell_of(DVec2::new(self.lo.x, y)) else { return 0 };
        self.clear[iy * self.nx..(iy + 1) * self.nx].iter().filter(|&&c| c > 0.0).count()
    }

    fn centre(&self, ix: usize, iy: usize) -> DVec2 {
        self.lo + DVec2::new(ix as f64 + 0.5, iy as f64 + 0.5) * self.cell
    }

    fn cell_of(&self, p: DVec2) -> Option<(usize, usize)> {
        let q = (p - self.lo) / self.cell;
        if !(q.x >= 0.0 && q.y >= 0.0 && q.x < self.nx as f64 && q.y < self.ny as f64) {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked above")]
        let c = (q.x as usize, q.y as usize);
        Some(c)
    }

    fn sample(&self, field: &[f64], p: DVec2) -> f64 {
        let q = (p - self.lo) / self.cell - DVec2::splat(0.5);
        let q = q.clamp(DVec2::ZERO, DVec2::new(self.nx as f64 - 1.001, self.ny as f64 - 1.001));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped above")]
        let (ix, iy) = (q.x as usize, q.y as usize);
        let t = q - DVec2::new(ix as f64, iy as f64);
        let i = iy * self.nx + ix;
        let low = field[i] + (field[i + 1] - field[i]) * t.x;
        let high = field[i + self.nx] + (field[i + self.nx + 1] - field[i + self.nx]) * t.x;
        low + (high - low) * t.y
    }

    fn bucket_edges(&mut self) {
        let n = self.outline.len();
        let row = |y: f64| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside the grid")]
            let r = ((y - self.lo.y) / self.cell).max(0.0) as usize;
            r.min(self.ny - 1)
        };
        let span = |e: usize| {
            let (a, b) = (self.outline[e].y, self.outline[(e + 1) % n].y);
            row(a.min(b))..=row(a.max(b))
        };
        let mut start = vec![0_usize; self.ny + 1];
        for e in 0..n {
            for r in span(e) {
                start[r + 1] += 1;
            }
        }
        for r in 0..self.ny {
            start[r + 1] += start[r];
        }
        let mut at = start.clone();
        let mut edges = vec![0; start[self.ny]];
        for e in 0..n {
            for r in span(e) {
                edges[at[r]] = e;
                at[r] += 1;
            }
        }
        self.row_start = start;
        self.row_edges = edges;
    }

    /// Marks inner cells, and with [`Inflation::Rows`] turns every inner run into a disc.
    fn scan_rows(&mut self, inflation: Inflation) -> Vec<bool> {
        let n = self.outline.len();
        let mut inside = vec![false; self.nx * self.ny];
        let mut crossings: Vec<f64> = Vec::new();
        for iy in 0..self.ny {
            let y = self.centre(0, iy).y;
            crossings.clear();
            for &e in &self.row_edges[self.row_start[iy]..self.row_start[iy + 1]] {
                let (a, b) = (self.outline[e], self.outline[(e + 1) % n]);
                if (a.y > y) != (b.y > y) {
                    crossings.push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
                }
            }
            base::sort_numbers(&mut crossings);
            for run in crossings.chunks_exact(2) {
                let (centre, half) = (0.5 * (run[0] + run[1]), 0.5 * (run[1] - run[0]));
                self.half_width = self.half_width.max(half);
                for ix in 0..self.nx {
                    let x = self.centre(ix, iy).x;
                    if x > run[0] && x < run[1] {
                        inside[iy * self.nx + ix] = true;
                        if inflation == Inflation::Rows {
                            let d = x - centre;
                            self.depth[iy * self.nx + ix] = ROUND * (half * half - d * d).max(0.0).sqrt();
                        }
                    }
                }
            }
        }
        inside
    }

    /// Two-pass vector distance transform (Danielsson 1980): every cell learns the nearest outline point from
    /// its neighbours.
    fn distances(&mut self, inside: &[bool]) {
        let far = self.lo - DVec2::splat(1e3 * self.cell * CELLS);
        self.nearest.fill(far);
        let n = self.outline.len();
        for e in 0..n {
            let (a, b) = (self.outline[e], self.outline[(e + 1) % n]);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 4 CELLS")]
            let steps = (a.distance(b) / (0.5 * self.cell)).ceil().max(1.0) as usize;
            for s in 0..steps {
                let p = a.lerp(b, s as f64 / steps as f64);
                if let Some((ix, iy)) = self.cell_of(p) {
                    let i = iy * self.nx + ix;
                    let c = self.centre(ix, iy);
                    if p.distance_squared(c) < self.nearest[i].distance_squared(c) {
                        self.nearest[i] = p;
                    }
                }
            }
        }
        for backwards in [false, true] {
            for k in 0..self.nx * self.ny {
                let i = if backwards { self.nx * self.ny - 1 - k } else { k };
                let (ix, iy) = (i % self.nx, i / self.nx);
                let c = self.centre(ix, iy);
                let mut best = self.nearest[i];
                let mut best_d = best.distance_squared(c);
                for dy in -1_isize..=1 {
                    let Some(jy) = iy.checked_add_signed(dy).filter(|&jy| jy < self.ny) else { continue };
                    let row = jy * self.nx;
                    let near = row + ix.saturating_sub(1)..=row + (ix + 1).min(self.nx - 1);
                    for &q in &self.nearest[near] {
                        let d = q.distance_squared(c);
                        if d < best_d {
                            (best, best_d) = (q, d);
                        }
                    }
                }
                self.nearest[i] = best;
            }
        }
        for (i, &inner) in inside.iter().enumerate() {
            let d = self.nearest[i].distance(self.centre(i % self.nx, i / self.nx));
            self.clear[i] = if inner { d } else { -d };
        }
    }

    /// Rounds the steps where a row splits into lobes.
    fn smooth_depth(&mut self, inside: &[bool]) {
        for _ in 0..2 {
            let old = self.depth.clone();
            for iy in 1..self.ny - 1 {
                for ix in 1..self.nx - 1 {
                    let i = iy * self.nx + ix;
                    if inside[i] {
                        let (mut sum, mut count) = (0.0, 0.0);
                        for j in [i, i - 1, i + 1, i - self.nx, i + self.nx] {
                            if inside[j] {
                                sum += old[j];
                                count += 1.0;
                            }
                        }
                        self.depth[i] = sum / count;
                    }
                }
            }
        }
    }
}

/// Returns the part of a polygon above a height (Sutherland and Hodgman; parts may stay joined along the cut).
pub(super) fn above(outline: &[DVec2], y: f64) -> Vec<DVec2> {
    let n = outline.len();
    let mut out = Vec::with_capacity(n + 4);
    for i in 0..n {
        let (a, b) = (outline[i], outline[(i + 1) % n]);
        if a.y >= y {
            out.push(a);
        }
        if (a.y >= y) != (b.y >= y) {
            out.push(DVec2::new(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y), y));
        }
    }
    out
}

/// Returns the signed area. [`geom::signed_area`] is relative to a corner and rounds differently, and plants are
/// compared to the last bit.
fn shoelace(outline: &[DVec2]) -> f64 {
    let n = outline.len();
    0.5 * (0..n).map(|i| outline[i].perp_dot(outline[(i + 1) % n])).sum::<f64>()
}
