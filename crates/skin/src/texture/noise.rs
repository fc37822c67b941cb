//! Noise that repeats at the edges of a texture, with the same bits everywhere.

/// Evaluates gradient noise on a lattice that repeats every `period` cells in x and in y; about -1 to 1.
pub(crate) fn gradient(x: f64, y: f64, period: (i32, i32), salt: u32) -> f64 {
    let (ix, iy) = (floor(x), floor(y));
    let (u, v) = (x - f64::from(ix), y - f64::from(iy));
    let (x0, y0) = (wrap(ix, period.0), wrap(iy, period.1));
    let x1 = if x0 + 1 == period.0 { 0 } else { x0 + 1 };
    let y1 = if y0 + 1 == period.1 { 0 } else { y0 + 1 };
    let corner = |cx: i32, cy: i32, dx: f64, dy: f64| {
        let (gx, gy) = DIRECTIONS[(hash(cx, cy, salt) >> 28) as usize];
        gx * dx + gy * dy
    };
    let (su, sv) = (fade(u), fade(v));
    let low = base::ops::lerp(corner(x0, y0, u, v), corner(x1, y0, u - 1.0, v), su);
    let high = base::ops::lerp(corner(x0, y1, u, v - 1.0), corner(x1, y1, u - 1.0, v - 1.0), su);
    1.5 * base::ops::lerp(low, high, sv)
}

/// Sums octaves of [`gradient`], each of twice the frequency and half the height of the one before.
pub(crate) fn octaves(x: f64, y: f64, period: (i32, i32), salt: u32, n: u32) -> f64 {
    let (mut sum, mut height, mut k) = (0.0, 0.5, 1);
    for i in 0..n {
        let f = f64::from(k);
        sum += height * gradient(x * f, y * f, (period.0 * k, period.1 * k), salt.wrapping_add(i));
        height *= 0.5;
        k *= 2;
    }
    sum
}

/// Returns the distances to the nearest and second nearest of one random point per cell, repeating every `period`
/// cells.
pub(crate) fn cells(x: f64, y: f64, period: (i32, i32), salt: u32) -> (f64, f64) {
    let (ix, iy) = (floor(x), floor(y));
    let (fx, fy) = (f64::from(ix), f64::from(iy));
    let (mut first, mut second) = (9.0_f64, 9.0_f64);
    for dy in -1..=1 {
        for dx in -1..=1 {
            let h = hash(wrap(ix + dx, period.0), wrap(iy + dy, period.1), salt);
            let px = fx + f64::from(dx) + unit(h);
            let py = fy + f64::from(dy) + unit(h.wrapping_mul(0x9e37_79b9).rotate_left(13));
            let d = (px - x) * (px - x) + (py - y) * (py - y);
            if d < first {
                second = first;
                first = d;
            } else if d < second {
                second = d;
            }
        }
    }
    (first.sqrt(), second.sqrt())
}

/// Plates that cover a tile: the cells of points on a lattice with every other row offset by half a cell, as in bricks,
/// so that elongated plates end in wedges between their neighbours.
#[derive(Debug)]
pub(crate) struct Plates {
    grid: (i32, i32),
    /// Offset of each point from the corner of its cell, and its number.
    points: Vec<(f64, f64, u32)>,
}

/// Position of a place among [`Plates`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plate {
    /// Random number of the plate, 0 to 1.
    pub(crate) own: f64,
    /// Random number of the nearest border, the same from both of its sides.
    pub(crate) border: f64,
    /// Distance from that border, in widths of the tile.
    pub(crate) edge: f64,
    /// Direction of that border: 1 along v, 0 across it.
    pub(crate) upright: f64,
}

impl Plates {
    /// Lays out plates. `grid`: their numbers across and along, at least 3 each; an even number along. `jitter` 0 is a
    /// regular lattice.
    pub(crate) fn new(grid: (i32, i32), jitter: f64, salt: u32) -> Self {
        let cells = (0..grid.1).flat_map(|j| (0..grid.0).map(move |i| (i, j)));
        let points = cells
            .map(|(i, j)| {
                let h = hash(i, j, salt);
                let off = |h: u32| 0.5 + jitter * (unit(h) - 0.5);
                let shift = if j % 2 == 0 { 0.0 } else { 0.5 };
                (shift + off(h), off(h.wrapping_mul(0x9e37_79b9).rotate_left(13)), hash(j, i, salt ^ 0x55))
            })
            .collect();
        Self { grid, points }
    }

    /// Returns the plate at u and v, one turn of the tile each.
    pub(crate) fn plate_at(&self, u: f64, v: f64) -> Plate {
        let (nx, ny) = (f64::from(self.grid.0), f64::from(self.grid.1));
        let (x, y) = (u * nx, v * ny);
        let j = floor(y);
        let mut near = [(0.0, 0.0, 0_u32, f64::MAX); 9];
        let (mut k, mut first) = (0, 0);
        for dy in -1..=1 {
            let row = wrap(j + dy, self.grid.1);
            let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
            let i = floor(x - shift);
            for dx in -1..=1 {
                let column = wrap(i + dx, self.grid.0);
                #[expect(clippy::cast_sign_loss, reason = "within the lattice")]
                let (px, py, id) = self.points[(row * self.grid.0 + column) as usize];
                let (dx, dy) = (f64::from(i + dx) + px - x, f64::from(j + dy) + py - y);
                near[k] = (dx, dy, id, dx * dx + dy * dy);
                if near[k].3 < near[first].3 {
                    first = k;
                }
                k += 1;
            }
        }
        let (ox, oy, own, _) = near[first];
        // The nearest border, its square distance as a fraction: one division for all.
        let (mut edge, mut below, mut border, mut upright) = (f64::MAX, 1.0, 0, 1.0);
        for (k, &(px, py, id, _)) in near.iter().enumerate() {
            if k == first {
                continue;
            }
            // The line half way between both points; its distance as measured on the tile, where cells are not square.
            let (ax, ay) = (px - ox, py - oy);
            let off = 0.5 * ((px + ox) * ax + (py + oy) * ay);
            let (gx, gy) = (ax * nx, ay * ny);
            let slope = gx * gx + gy * gy;
            if off * off * below < edge * slope {
                (edge, below, border, upright) = (off * off, slope, id ^ own, gx * gx);
            }
        }
        let number = |id: u32| unit(id.wrapping_mul(0x2c1b_3c6d) ^ (id >> 9));
        Plate {
            own: number(own),
            border: number(border),
            edge: (edge / below).sqrt(),
            upright: (upright / below).sqrt(),
        }
    }
}

/// Returns the distance from the nearest of short strokes across a tile, at most one per cell: 0 in its middle and 1 at
/// its edge.
///
/// `of` maps a cell's number (0 to 1) to half of a stroke's length and of its thickness in cells, at most 1 and 0.5;
/// `None` for a cell without a stroke.
pub(crate) fn strokes(
    (x, y): (f64, f64),
    grid: (i32, i32),
    salt: u32,
    of: impl Fn(f64) -> Option<(f64, f64)>,
) -> f64 {
    let (ix, iy) = (floor(x), floor(y));
    let mut nearest = f64::MAX;
    for dy in -1..=1 {
        for dx in -1..=1 {
            let h = hash(wrap(ix + dx, grid.0), wrap(iy + dy, grid.1), salt);
            let Some((length, thick)) = of(unit(h)) else { continue };
            let px = f64::from(ix + dx) + unit(h.wrapping_mul(0x9e37_79b9).rotate_left(7));
            let py = f64::from(iy + dy) + unit(h.wrapping_mul(0x85eb_ca6b).rotate_left(17));
            let (a, b) = ((x - px) / length, (y - py) / thick);
            nearest = nearest.min(a * a + b * b);
        }
    }
    nearest.sqrt()
}

/// Returns a number in \[0, 1) for an integer.
pub(crate) fn random(k: i32, salt: u32) -> f64 {
    unit(hash(k, 77, salt))
}

/// Rounds a small number down. `f64::floor` is a call into a library on processors without SSE 4.1.
fn floor(x: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "texture coordinates are small")]
    let toward_zero = x as i32;
    toward_zero - i32::from(f64::from(toward_zero) > x)
}

/// Wraps a cell into the tile. Most are already: a remainder costs more than the rest of the noise.
fn wrap(k: i32, n: i32) -> i32 {
    if (0..n).contains(&k) { k } else { k.rem_euclid(n) }
}

fn unit(h: u32) -> f64 {
    f64::from(h >> 8) / 16_777_216.0
}

fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

fn hash(x: i32, y: i32, salt: u32) -> u32 {
    let mut h = x.cast_unsigned().wrapping_mul(0x85eb_ca6b)
        ^ y.cast_unsigned().wrapping_mul(0xc2b2_ae35)
        ^ salt.wrapping_mul(0x27d4_eb2f);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    h ^ (h >> 15)
}

// Sixteen directions, a turn of 22.5 degrees apart.
const C1: f64 = 0.923_879_532_511_286_7;
const S1: f64 = 0.382_683_432_365_089_8;
const D: f64 = core::f64::consts::FRAC_1_SQRT_2;
const DIRECTIONS: [(f64, f64); 16] = [
    (1.0, 0.0),
    (C1, S1),
    (D, D),
    (S1, C1),
    (0.0, 1.0),
    (-S1, C1),
    (-D, D),
    (-C1, S1),
    (-1.0, 0.0),
    (-C1, -S1),
    (-D, -D),
    (-S1, -C1),
    (0.0, -1.0),
    (S1, -C1),
    (D, -D),
    (C1, -S1),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_repeats_at_the_edge() {
        for k in 0..50 {
            let (x, y) = (0.17 * f64::from(k), 0.31 * f64::from(k));
            let here = octaves(x, y, (4, 3), 5, 3);
            let there = octaves(x + 4.0, y - 3.0, (4, 3), 5, 3);
            assert!((here - there).abs() < 1e-9, "{here} {there}");
            assert!(here.abs() <= 1.6, "{here}");
            let (a, b) = cells(x, y, (5, 5), 1);
            let (c, d) = cells(x + 5.0, y + 5.0, (5, 5), 1);
            assert!((a - c).abs() < 1e-9 && (b - d).abs() < 1e-9 && a <= b, "{a} {b} {c} {d}");
        }
    }
}
