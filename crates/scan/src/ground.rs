//! The terrain below a tree: a smooth surface through the lowest points of each cell.

use geom::solve_positive;
use glam::DVec3;

/// A terrain: heights above a grid of squares.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    cell: f64,
    low: [f64; 2],
    size: [usize; 2],
    /// Height of each cell's centre, x fastest.
    height: Vec<f64>,
    /// Half the thickness of the layer of ground points, metres.
    pub thickness_m: f64,
}

/// Most squares along the longer side.
const CELLS: f64 = 80.0;

impl Ground {
    /// Finds the ground of a cloud with +Y up; none if the lowest points form no surface. It must explain at least a
    /// third of the squares that hold points, have less than one point in fifty below it, and rise by less than 45
    /// degrees.
    ///
    /// Cost: linear.
    pub fn find(points: &[DVec3]) -> Option<Self> {
        let (low, high) =
            points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
        let size = high - low;
        let wide = size.x.max(size.z);
        if !(wide > 0.0 && wide.is_finite()) {
            return None;
        }
        let cell = (wide / CELLS).max(0.25_f64.min(wide / 8.0));
        let counts = [size.x, size.z].map(|s| index(s / cell) + 1);
        let mut ground = Self {
            cell,
            low: [low.x, low.z],
            size: counts,
            height: vec![f64::INFINITY; counts[0] * counts[1]],
            thickness_m: 0.0,
        };
        let lowest = ground.lowest(points);
        let seen: Vec<usize> = (0..lowest.len()).filter(|&c| lowest[c].is_finite()).collect();
        if seen.len() < 12 {
            return None;
        }
        let trend = Trend::through(&ground, &lowest, &seen)?;
        // Tolerance of a square's lowest point: the ground is rough, and the trend does not know its bumps.
        let near = (0.02 * wide).min(0.3).max(0.1 * cell).min(0.1 * size.y);
        let on: Vec<usize> =
            seen.iter().copied().filter(|&c| (lowest[c] - trend.height(&ground, c)).abs() < near).collect();
        if on.len() * 3 < seen.len() || on.len() < 10 || trend.steep() {
            return None;
        }
        ground.fill(&lowest, &on, &trend, near);
        let mut off: Vec<f64> =
            points.iter().map(|p| p.y - ground.height(*p)).filter(|h| h.abs() < near).map(f64::abs).collect();
        if off.len() < 50 {
            return None;
        }
        base::sort_numbers(&mut off);
        let below = points.iter().filter(|p| p.y - ground.height(**p) < -near).count();
        if below * 50 > points.len() {
            return None;
        }
        // Twice the median holds nine tenths; grass and roots are thicker than noise.
        ground.thickness_m = (3.0 * off[off.len() / 2]).clamp(0.01 * near, near);
        Some(ground)
    }

    /// Returns the height of the ground below a point.
    pub fn height(&self, p: DVec3) -> f64 {
        let at = [p.x, p.z];
        let f =
            [0, 1].map(|k| ((at[k] - self.low[k]) / self.cell - 0.5).clamp(0.0, self.size[k] as f64 - 1.0));
        let i = [0, 1].map(|k| index(f[k]).min(self.size[k].saturating_sub(2)));
        let t = [0, 1].map(|k| (f[k] - i[k] as f64).clamp(0.0, 1.0));
        let h = |dx: usize, dz: usize| {
            let x = (i[0] + dx).min(self.size[0] - 1);
            let z = (i[1] + dz).min(self.size[1] - 1);
            self.height[z * self.size[0] + x]
        };
        let low = h(0, 0) * (1.0 - t[0]) + h(1, 0) * t[0];
        let high = h(0, 1) * (1.0 - t[0]) + h(1, 1) * t[0];
        low * (1.0 - t[1]) + high * t[1]
    }

    fn middle(&self, cell: usize) -> [f64; 2] {
        let at = [cell % self.size[0], cell / self.size[0]];
        [0, 1].map(|k| self.low[k] + (at[k] as f64 + 0.5) * self.cell)
    }

    /// Returns the third lowest point of each square: two may be noise below the ground.
    fn lowest(&self, points: &[DVec3]) -> Vec<f64> {
        let mut three = vec![[f64::INFINITY; 3]; self.height.len()];
        for p in points {
            let at = [p.x, p.z];
            let [x, z] = [0, 1].map(|k| index((at[k] - self.low[k]) / self.cell).min(self.size[k] - 1));
            let best = &mut three[z * self.size[0] + x];
            let place = best.partition_point(|&h| h <= p.y);
            if place < 3 {
                best[place..].rotate_right(1);
                best[place] = p.y;
            }
        }
        three.into_iter().map(|t| t[2]).collect()
    }

    /// Sets the heights of all cells to the trend plus the median offset of the lowest points nearby.
    fn fill(&mut self, lowest: &[f64], on: &[usize], trend: &Trend, near: f64) {
        let mut off = vec![f64::NAN; self.height.len()];
        on.iter().for_each(|&c| off[c] = lowest[c] - trend.height(self, c));
        for c in 0..self.height.len() {
            let [x, z] = [c % self.size[0], c / self.size[0]];
            let mut around = vec![];
            for reach in [1, 3] {
                for v in z.saturating_sub(reach)..(z + reach + 1).min(self.size[1]) {
                    for u in x.saturating_sub(reach)..(x + reach + 1).min(self.size[0]) {
                        around.extend(Some(off[v * self.size[0] + u]).filter(|o| o.is_finite()));
                    }
                }
                if around.len() >= 3 {
                    break;
                }
            }
            base::sort_numbers(&mut around);
            let median = around.get(around.len() / 2).copied().unwrap_or(0.0);
            self.height[c] = trend.height(self, c) + median.clamp(-near, near);
        }
    }
}

/// A quadratic surface over the plane.
struct Trend {
    factors: [f64; 6],
    middle: [f64; 2],
    scale: f64,
}

impl Trend {
    /// Fits the lowest points; those above the surface get less weight from round to round, because below a crown
    /// only the ground is lower.
    fn through(ground: &Ground, lowest: &[f64], seen: &[usize]) -> Option<Self> {
        let middle = [0, 1].map(|k| ground.low[k] + 0.5 * ground.size[k] as f64 * ground.cell);
        let scale = 0.5 * ground.size[0].max(ground.size[1]) as f64 * ground.cell;
        let mut heights: Vec<f64> = seen.iter().map(|&c| lowest[c]).collect();
        base::sort_numbers(&mut heights);
        // Start with a level at the lower quartile.
        let mut trend =
            Self { factors: [heights[heights.len() / 4], 0.0, 0.0, 0.0, 0.0, 0.0], middle, scale };
        let spread = (heights[heights.len() / 2] - heights[0]).max(0.05 * scale);
        for round in 0..14 {
            let width = (spread * base::ops::powf(0.6, f64::from(round))).max(0.01 * scale);
            let n = if round < 4 { 3 } else { 6 };
            let mut m = vec![0.0; n * n];
            let mut b = vec![0.0; n];
            for &c in seen {
                let off = lowest[c] - trend.height(ground, c);
                let r = off / if off > 0.0 { width } else { 2.0 * width };
                let weight = 1.0 / (1.0 + r * r * r * r);
                let row = trend.row(ground, c);
                for i in 0..n {
                    b[i] += weight * row[i] * lowest[c];
                    for j in 0..n {
                        m[i * n + j] += weight * row[i] * row[j];
                    }
                }
            }
            // A small regularisation: curvature needs evidence.
            for i in 0..n {
                m[i * n + i] += if i < 3 { 1e-9 } else { 0.02 } * seen.len() as f64;
            }
            solve_positive(&mut m, &mut b)?;
            trend.factors[..n].copy_from_slice(&b);
        }
        trend.factors.iter().all(|f| f.is_finite()).then_some(trend)
    }

    fn row(&self, ground: &Ground, cell: usize) -> [f64; 6] {
        let at = ground.middle(cell);
        let [x, z] = [0, 1].map(|k| (at[k] - self.middle[k]) / self.scale);
        [1.0, x, z, x * x, x * z, z * z]
    }

    fn height(&self, ground: &Ground, cell: usize) -> f64 {
        self.row(ground, cell).iter().zip(self.factors).map(|(r, f)| r * f).sum()
    }

    fn steep(&self) -> bool {
        let slope =
            (self.factors[1] * self.factors[1] + self.factors[2] * self.factors[2]).sqrt() / self.scale;
        slope > 1.0
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturation is wanted")]
const fn index(x: f64) -> usize {
    x as usize
}
