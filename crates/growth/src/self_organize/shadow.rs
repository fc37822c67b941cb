//! Shadow propagation: a voxel grid in which everything that grows darkens the voxels below it.
//!
//! `joints -> corners of squares -> summed over each layer -> shadows`
//!
//! The shadow of one joint is a square in each layer below it. Only the four corners of a square are written; the
//! running sums of a layer (Crow 1984), made once for all joints of a year, fill them in.

use core::ops::Range;

use glam::DVec3;

/// Units of shadow per 1, whole multiples of 2^-20: adding and subtracting in any order gives the same bits.
const UNIT: f64 = 1_048_576.0;
/// Most voxels of a grid (two grids of 128 MiB); joints beyond cast no shadow.
const MOST_VOXELS: usize = 1 << 25;
/// The voxel of a place without one.
pub(crate) const OUTSIDE: u32 = u32::MAX;

/// Shadow values over space; it grows with the trees. Palubicki et al. 2009, section 4.1.
#[derive(Clone, Debug)]
pub(crate) struct ShadowGrid {
    /// Second differences of the shadow over each layer: layers of y, rows of z, x contiguous.
    corners: Vec<i32>,
    /// Shadow of each voxel in units of 2^-20, as it was at the last [`spread`](Self::spread).
    shadow: Vec<i32>,
    /// Contribution of a joint q layers below itself: a b^-q.
    falling: Vec<i32>,
    /// Offsets of the corners of that square from the joint's own voxel; negative ones wrap.
    squares: Vec<[usize; 4]>,
    voxel_m: f64,
    /// Position of voxel (0, 0, 0) in voxels.
    origin: [i64; 3],
    dims: [usize; 3],
    /// Columns (x and z) that any shadow has ever reached, and layers whose corners have changed since `spread`.
    used: [Range<usize>; 2],
    stale: Range<usize>,
}

impl ShadowGrid {
    /// Creates an empty grid: `a` above 0, `b` above 1, `layers` the number of layers below a joint that it shades.
    pub(crate) fn new(voxel_m: f64, a: f64, b: f64, layers: u32) -> Self {
        let mut falling = Vec::with_capacity(layers as usize + 1);
        let mut s = a;
        for _ in 0..=layers {
            falling.push(whole(s * UNIT));
            s /= b;
        }
        Self {
            corners: Vec::new(),
            shadow: Vec::new(),
            falling,
            squares: Vec::new(),
            voxel_m,
            origin: [0; 3],
            dims: [0; 3],
            used: [NONE, NONE],
            stale: NONE,
        }
    }

    /// Returns the number of voxels.
    pub(crate) const fn voxels(&self) -> usize {
        self.corners.len()
    }

    /// Extends the grid to joints in a box, and renumbers `voxels` accordingly. Returns whether the grid has grown.
    pub(crate) fn cover(&mut self, lo: DVec3, hi: DVec3, voxels: &mut [u32]) -> bool {
        let margin = self.falling.len() as i64 + 1;
        let from = self.voxel(lo).map(|v| v - margin);
        let to = self.voxel(hi).map(|v| v + margin + 1);
        let fits =
            (0..3).all(|i| from[i] >= self.origin[i] && to[i] <= self.origin[i] + signed(self.dims[i]));
        if fits && !self.corners.is_empty() {
            return false;
        }
        // The first time it gets its least size; later a quarter more on every side that must grow, so that it seldom
        // does.
        let old = (self.origin, self.dims);
        let (mut origin, mut dims) = ([0; 3], [0; 3]);
        for i in 0..3 {
            let size = to[i] - from[i];
            let end = old.0[i] + signed(old.1[i]);
            let fresh = old.1[i] == 0;
            let more = if fresh { 0 } else { size / 4 };
            let a = if fresh || from[i] < old.0[i] { from[i] - more } else { old.0[i] };
            let b = if fresh || to[i] > end { to[i] + more } else { end };
            origin[i] = a;
            dims[i] = usize::try_from(b - a).unwrap_or(0);
        }
        let most = dims[0].saturating_mul(dims[1]).saturating_mul(dims[2]);
        if most > MOST_VOXELS {
            return false;
        }
        let moved = [0, 1, 2].map(|i| usize::try_from(old.0[i] - origin[i]).unwrap_or(0));
        let number =
            |x: usize, y: usize, z: usize| ((moved[1] + y) * dims[2] + moved[2] + z) * dims[0] + moved[0] + x;
        for voxel in voxels.iter_mut().filter(|v| **v != OUTSIDE) {
            let [x, y, z] = self.coordinates(*voxel);
            *voxel = index(number(x, y, z));
        }
        // Shadows are summed again anyway: the corners move to their memory, and they to that of the corners.
        core::mem::swap(&mut self.corners, &mut self.shadow);
        clear(&mut self.corners, most);
        let columns = self.used[0].clone();
        for y in 0..old.1[1] {
            for z in self.used[1].clone() {
                let row = (y * old.1[2] + z) * old.1[0];
                let to = number(columns.start, y, z);
                self.corners[to..to + columns.len()].copy_from_slice(&self.shadow[row..][columns.clone()]);
            }
        }
        clear(&mut self.shadow, most);
        (self.origin, self.dims) = (origin, dims);
        let square = |q: usize| {
            let (near, wide) = (0_usize.wrapping_sub(q * (dims[2] * dims[0] + dims[0] + 1)), 2 * q + 1);
            [0, wide, wide * dims[0], wide * dims[0] + wide].map(|far| near.wrapping_add(far))
        };
        self.squares = (0..self.falling.len()).map(square).collect();
        for (used, by) in self.used.iter_mut().zip([moved[0], moved[2]]) {
            *used = if used.start >= used.end { NONE } else { used.start + by..used.end + by };
        }
        self.stale = 0..dims[1];
        true
    }

    /// As [`add`](Self::add), for many joints: those of one shoot, which share voxels, are added together.
    pub(crate) fn add_all(&mut self, voxels: impl Iterator<Item = u32>, sign: i32) {
        let (mut last, mut joints) = (OUTSIDE, 0);
        for voxel in voxels {
            if voxel != last {
                self.add(last, joints);
                (last, joints) = (voxel, 0);
            }
            joints += sign;
        }
        self.add(last, joints);
    }

    /// Casts the shadow of `joints` joints in a voxel, or removes it (below 0): `a b^-q` for each on the square of half
    /// width q in the q-th layer below. The indices are (i +- p, j - q, k +- p), p from 0 to q. Visible after
    /// [`spread`](Self::spread). Nothing in [`OUTSIDE`].
    pub(crate) fn add(&mut self, voxel: u32, joints: i32) {
        if voxel == OUTSIDE {
            return;
        }
        let [x, y, z] = self.coordinates(voxel);
        let reached = self.falling.len().min(y + 1);
        for (square, s) in self.squares.iter().zip(&self.falling[..reached]) {
            let s = s.wrapping_mul(joints);
            for (by, s) in square.iter().zip([s, s.wrapping_neg(), s.wrapping_neg(), s]) {
                let corner = &mut self.corners[(voxel as usize).wrapping_add(*by)];
                *corner = corner.wrapping_add(s);
            }
        }
        let layers = self.falling.len();
        stretch(&mut self.stale, y.saturating_sub(layers), y + 1);
        stretch(&mut self.used[0], x - layers, x + layers + 1);
        stretch(&mut self.used[1], z - layers, z + layers + 1);
    }

    /// Makes every shadow that was cast or removed visible to [`shade`](Self::shade) and [`slope`](Self::slope). Cost:
    /// linear in the voxels of the layers that these reach.
    pub(crate) fn spread(&mut self) {
        let (width, [columns, rows]) = (self.dims[0], self.used.clone());
        for layer in core::mem::replace(&mut self.stale, NONE) {
            // The first used row has no shadow yet, nor has the column before the first.
            for z in rows.clone().skip(1) {
                let start = (layer * self.dims[2] + z) * width + columns.start;
                let (before, here) = self.shadow.split_at_mut(start);
                let corners = &self.corners[start..start + columns.len()];
                let mut sum = 0_i32;
                for ((shadow, above), corner) in here.iter_mut().zip(&before[start - width..]).zip(corners) {
                    sum = sum.wrapping_add(*corner);
                    *shadow = above.wrapping_add(sum);
                }
            }
        }
    }

    /// Returns the number of the voxel of a place, [`OUTSIDE`] if it or its lateral shadow lies beyond the grid.
    pub(crate) fn voxel_of(&self, p: DVec3) -> u32 {
        self.inside(p).map_or(OUTSIDE, |[x, y, z]| index((y * self.dims[2] + z) * self.dims[0] + x))
    }

    /// Returns the coordinates of the voxel with this number.
    fn coordinates(&self, voxel: u32) -> [usize; 3] {
        let (row, x) = (voxel as usize / self.dims[0], voxel as usize % self.dims[0]);
        [x, row / self.dims[2], row % self.dims[2]]
    }

    /// Returns the shadow in a voxel; 0 in [`OUTSIDE`].
    #[inline]
    pub(crate) fn shade(&self, voxel: u32) -> f64 {
        f64::from(self.shadow.get(voxel as usize).copied().unwrap_or(0)) / UNIT
    }

    /// Returns the direction in which the shadow decreases fastest around a voxel (not normalised).
    pub(crate) fn slope(&self, voxel: u32) -> DVec3 {
        if voxel == OUTSIDE {
            return DVec3::ZERO;
        }
        let i = voxel as usize;
        let layer = self.dims[2] * self.dims[0];
        let at = |i: usize| f64::from(self.shadow.get(i).copied().unwrap_or(0)) / UNIT;
        let below = i.checked_sub(layer).map_or(0.0, at);
        DVec3::new(at(i - 1) - at(i + 1), below - at(i + layer), at(i - self.dims[0]) - at(i + self.dims[0]))
    }

    /// Returns the contribution of one joint to its own voxel: a.
    pub(crate) fn own(&self) -> f64 {
        f64::from(self.falling[0]) / UNIT
    }

    fn voxel(&self, p: DVec3) -> [i64; 3] {
        (p / self.voxel_m).to_array().map(|c| {
            let c = c.clamp(-1e12, 1e12);
            #[expect(clippy::cast_possible_truncation, reason = "clamped before")]
            let towards_zero = c as i64;
            towards_zero - i64::from((towards_zero as f64) > c)
        })
    }

    /// Returns the voxel of a place, if it and its lateral shadow lie within the grid.
    fn inside(&self, p: DVec3) -> Option<[usize; 3]> {
        let v = self.voxel(p);
        let mut at = [0; 3];
        for i in 0..3 {
            let margin = if i == 1 { 1 } else { self.falling.len() };
            at[i] = usize::try_from(v[i] - self.origin[i]).ok()?;
            if at[i] + margin >= self.dims[i] || (i != 1 && at[i] < margin) {
                return None;
            }
        }
        Some(at)
    }
}

/// The empty range.
const NONE: Range<usize> = Range { start: usize::MAX, end: 0 };

/// Resets a column to `len` zeros.
fn clear(column: &mut Vec<i32>, len: usize) {
    column.clear();
    if column.capacity() < len {
        // Freed first: `resize` alone would copy the old values.
        *column = Vec::new();
        column.reserve(2 * len);
    }
    column.resize(len, 0);
}

fn stretch(range: &mut Range<usize>, from: usize, to: usize) {
    (range.start, range.end) = (range.start.min(from), range.end.max(to));
}

#[expect(clippy::cast_possible_truncation, reason = "clamped before")]
fn whole(x: f64) -> i32 {
    x.clamp(0.0, 1e9) as i32
}

#[expect(clippy::cast_possible_truncation, reason = "at most MOST_VOXELS")]
const fn index(voxel: usize) -> u32 {
    voxel as u32
}

fn signed(n: usize) -> i64 {
    i64::try_from(n).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shade(grid: &ShadowGrid, p: DVec3) -> f64 {
        grid.shade(grid.voxel_of(p))
    }

    #[test]
    fn one_joint_darkens_a_pyramid_below_it() {
        let mut grid = ShadowGrid::new(1.0, 0.5, 2.0, 3);
        let at = DVec3::new(0.5, 10.5, 0.5);
        grid.cover(at - DVec3::splat(6.0), at + DVec3::splat(6.0), &mut []);
        grid.add(grid.voxel_of(at), 1);
        grid.spread();
        for q in -2..=5_i32 {
            for dx in -5..=5_i32 {
                for dz in -5..=5_i32 {
                    let p = at + DVec3::new(f64::from(dx), f64::from(-q), f64::from(dz));
                    let lit = !(0..=3).contains(&q) || dx.abs() > q || dz.abs() > q;
                    let want = if lit { 0.0 } else { 0.5 / f64::from(1 << q) };
                    assert!((shade(&grid, p) - want).abs() < 1e-6, "{dx} {q} {dz}");
                }
            }
        }
        let slope = grid.slope(grid.voxel_of(at - DVec3::Y));
        assert!(slope.y.abs() > slope.x.abs(), "{slope}");
        grid.add(grid.voxel_of(at), -1);
        grid.spread();
        assert!(grid.shadow.iter().chain(&grid.corners).all(|&s| s == 0), "exactly reversible");
    }

    #[test]
    fn many_joints_shade_as_each_would_alone() {
        let mut s = base::Seed::new(3).stream(base::Draw::Test);
        let mut grid = ShadowGrid::new(0.3, 0.1, 1.8, 5);
        let joints: Vec<DVec3> =
            (0..200).map(|_| DVec3::new(s.normal(), s.range(0.0, 4.0), s.normal())).collect();
        // In four years, each of which covers more, and every third joint is shed again.
        for year in joints.chunks(50) {
            let (lo, hi) = year.iter().fold((year[0], year[0]), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
            grid.cover(lo, hi, &mut []);
            year.iter().for_each(|&p| grid.add(grid.voxel_of(p), 1));
            grid.spread();
            year.iter().step_by(3).for_each(|&p| grid.add(grid.voxel_of(p), -1));
        }
        grid.spread();
        let left: Vec<[i64; 3]> = joints
            .chunks(50)
            .flat_map(|year| year.iter().enumerate().filter(|(i, _)| i % 3 > 0))
            .map(|(_, p)| grid.voxel(*p))
            .collect();
        let mut dark = 0;
        for _ in 0..500 {
            let p = DVec3::new(s.normal(), s.range(-1.0, 4.0), s.normal());
            let at = grid.voxel(p);
            if grid.voxel_of(p) == OUTSIDE {
                continue;
            }
            let want: i64 = left
                .iter()
                .filter_map(|j| {
                    let q = usize::try_from(j[1] - at[1]).ok().filter(|q| *q <= 5)?;
                    let aside = (j[0] - at[0]).abs().max((j[2] - at[2]).abs());
                    (aside <= signed(q)).then(|| i64::from(grid.falling[q]))
                })
                .sum();
            assert_eq!(shade(&grid, p), want as f64 / UNIT, "{p}");
            dark += usize::from(want > 0);
        }
        assert!(dark > 200, "{dark}");
    }

    #[test]
    fn shadows_stay_where_they_are_when_the_grid_grows() {
        let mut grid = ShadowGrid::new(0.5, 0.1, 1.8, 4);
        let at = DVec3::new(0.1, 3.0, -0.2);
        assert!(grid.cover(at, at, &mut []) && !grid.cover(at, at, &mut []));
        grid.add(grid.voxel_of(at), 1);
        grid.spread();
        let below = at - DVec3::new(0.4, 0.9, 0.3);
        let before = shade(&grid, below);
        assert!(before > 0.0);
        let mut voxels = [grid.voxel_of(at), OUTSIDE, grid.voxel_of(below)];
        assert!(grid.cover(at - DVec3::splat(9.0), at + DVec3::splat(20.0), &mut voxels));
        assert_eq!(voxels, [grid.voxel_of(at), OUTSIDE, grid.voxel_of(below)]);
        grid.spread();
        assert_eq!(shade(&grid, below), before);
        assert!(!grid.cover(DVec3::splat(-1e9), DVec3::splat(1e9), &mut []), "too large a grid is not made");
        assert_eq!(shade(&grid, below), before);
        grid.add(grid.voxel_of(DVec3::splat(1e9)), 1);
    }
}
