//! Shadow propagation: a voxel grid in which everything that grows darkens what is below it.

use glam::DVec3;

/// Shadows are whole multiples of 2^-20: adding and taking away in any order gives the same bits.
const UNIT: f64 = 1_048_576.0;
/// More voxels than this (256 MiB) are not made; what grows beyond casts no shadow.
const MOST_VOXELS: usize = 1 << 26;

/// Shadow values over space; it grows with the trees. Palubicki et al. 2009, section 4.1.
#[derive(Clone, Debug)]
pub(crate) struct ShadowGrid {
    /// Shadow of each voxel in units of 2^-20: layers of y, rows of z, x side by side.
    shadow: Vec<i32>,
    /// What a joint adds q layers below itself: a b^-q.
    falling: Vec<i32>,
    voxel_m: f64,
    /// Place of voxel (0, 0, 0) in voxels.
    origin: [i64; 3],
    dims: [usize; 3],
}

impl ShadowGrid {
    /// `a` above 0, `b` above 1, `layers` the number of layers below the joint that it shades.
    pub(crate) fn new(voxel_m: f64, a: f64, b: f64, layers: u32) -> Self {
        let mut falling = Vec::with_capacity(layers as usize + 1);
        let mut s = a;
        for _ in 0..=layers {
            falling.push(whole(s * UNIT));
            s /= b;
        }
        Self { shadow: Vec::new(), falling, voxel_m, origin: [0; 3], dims: [0; 3] }
    }

    /// Makes room for joints in a box, so that [`add`](Self::add) and [`sample`](Self::sample) find it.
    pub(crate) fn cover(&mut self, lo: DVec3, hi: DVec3) {
        let margin = self.falling.len() as i64 + 1;
        let from = self.voxel(lo).map(|v| v - margin);
        let to = self.voxel(hi).map(|v| v + margin + 1);
        let fits =
            (0..3).all(|i| from[i] >= self.origin[i] && to[i] <= self.origin[i] + signed(self.dims[i]));
        if fits && !self.shadow.is_empty() {
            return;
        }
        // Half as much again on every side that must grow, so that it seldom does.
        let old = (self.origin, self.dims);
        let (mut origin, mut dims) = ([0; 3], [0; 3]);
        for i in 0..3 {
            let size = to[i] - from[i];
            let end = old.0[i] + signed(old.1[i]);
            let fresh = old.1[i] == 0;
            let a = if fresh || from[i] < old.0[i] { from[i] - size / 2 } else { old.0[i] };
            let b = if fresh || to[i] > end { to[i] + size / 2 } else { end };
            origin[i] = a;
            dims[i] = usize::try_from(b - a).unwrap_or(0);
        }
        let most = dims[0].saturating_mul(dims[1]).saturating_mul(dims[2]);
        if most > MOST_VOXELS {
            return;
        }
        let mut shadow = vec![0; most];
        for y in 0..old.1[1] {
            for z in 0..old.1[2] {
                let row = (y * old.1[2] + z) * old.1[0];
                let at = |i: usize, k: usize| usize::try_from(old.0[i] - origin[i]).unwrap_or(0) + k;
                let to = (at(1, y) * dims[2] + at(2, z)) * dims[0] + at(0, 0);
                shadow[to..to + old.1[0]].copy_from_slice(&self.shadow[row..row + old.1[0]]);
            }
        }
        (self.shadow, self.origin, self.dims) = (shadow, origin, dims);
    }

    /// Casts (`sign` 1) or takes back (`sign` -1) the shadow of a joint: `a b^-q` on the square of half width q in
    /// the q-th layer below. The indices are (i +- p, j - q, k +- p), p from 0 to q.
    pub(crate) fn add(&mut self, p: DVec3, sign: i32) {
        let Some([x, y, z]) = self.inside(p) else { return };
        for (q, &s) in self.falling.iter().enumerate() {
            let Some(layer) = y.checked_sub(q) else { break };
            for row in z - q..=z + q {
                let start = (layer * self.dims[2] + row) * self.dims[0] + x;
                for v in &mut self.shadow[start - q..=start + q] {
                    *v = v.wrapping_add(s * sign);
                }
            }
        }
    }

    /// Shadow at a place, and the way in which it falls off fastest (not normalised).
    pub(crate) fn sample(&self, p: DVec3) -> (f64, DVec3) {
        let Some([x, y, z]) = self.inside(p) else { return (0.0, DVec3::ZERO) };
        let i = (y * self.dims[2] + z) * self.dims[0] + x;
        let layer = self.dims[2] * self.dims[0];
        let at = |i: usize| f64::from(self.shadow.get(i).copied().unwrap_or(0)) / UNIT;
        let below = i.checked_sub(layer).map_or(0.0, at);
        let slope = DVec3::new(
            at(i - 1) - at(i + 1),
            below - at(i + layer),
            at(i - self.dims[0]) - at(i + self.dims[0]),
        );
        (at(i), slope)
    }

    /// What one joint adds to its own voxel: a.
    pub(crate) fn own(&self) -> f64 {
        f64::from(self.falling[0]) / UNIT
    }

    fn voxel(&self, p: DVec3) -> [i64; 3] {
        (p / self.voxel_m).floor().to_array().map(|c| {
            #[expect(clippy::cast_possible_truncation, reason = "clamped before")]
            let v = c.clamp(-1e12, 1e12) as i64;
            v
        })
    }

    /// The voxel of a place, if it and what it shades sideways lie within the grid.
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

#[expect(clippy::cast_possible_truncation, reason = "clamped before")]
fn whole(x: f64) -> i32 {
    x.clamp(0.0, 1e9) as i32
}

fn signed(n: usize) -> i64 {
    i64::try_from(n).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_joint_darkens_a_pyramid_below_it() {
        let mut grid = ShadowGrid::new(1.0, 0.5, 2.0, 3);
        let at = DVec3::new(0.5, 10.5, 0.5);
        grid.cover(at, at);
        grid.add(at, 1);
        for q in -2..=5_i32 {
            for dx in -5..=5_i32 {
                for dz in -5..=5_i32 {
                    let p = at + DVec3::new(f64::from(dx), f64::from(-q), f64::from(dz));
                    let lit = !(0..=3).contains(&q) || dx.abs() > q || dz.abs() > q;
                    let want = if lit { 0.0 } else { 0.5 / f64::from(1 << q) };
                    assert!((grid.sample(p).0 - want).abs() < 1e-6, "{dx} {q} {dz}");
                }
            }
        }
        let (_, slope) = grid.sample(at - DVec3::Y);
        assert!(slope.y.abs() > slope.x.abs(), "{slope}");
        grid.add(at, -1);
        assert!(grid.shadow.iter().all(|&s| s == 0), "exactly reversible");
    }

    #[test]
    fn shadows_stay_where_they_are_when_the_grid_grows() {
        let mut grid = ShadowGrid::new(0.5, 0.1, 1.8, 4);
        let at = DVec3::new(0.1, 3.0, -0.2);
        grid.cover(at, at);
        grid.add(at, 1);
        let below = at - DVec3::new(0.4, 0.9, 0.3);
        let before = grid.sample(below).0;
        assert!(before > 0.0);
        grid.cover(at - DVec3::splat(9.0), at + DVec3::splat(20.0));
        assert_eq!(grid.sample(below).0, before);
        grid.cover(DVec3::splat(-1e9), DVec3::splat(1e9));
        assert_eq!(grid.sample(below).0, before, "too large a grid is not made");
        grid.add(DVec3::splat(1e9), 1);
    }
}
