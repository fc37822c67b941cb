//! Noise that repeats at the edges of a texture, with the same bits everywhere.

/// Gradient noise on a lattice that repeats every `period` cells in x and in y; about -1 to 1.
pub(crate) fn gradient(x: f64, y: f64, period: (i32, i32), salt: u32) -> f64 {
    let (ix, iy) = (floor(x), floor(y));
    let (u, v) = (x - f64::from(ix), y - f64::from(iy));
    // Wrapped once per axis: four remainders a corner would cost more than the noise.
    let (x0, y0) = (ix.rem_euclid(period.0), iy.rem_euclid(period.1));
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

/// Octaves of [`gradient`], each of twice the frequency and half the height of the one before.
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

/// Distances to the nearest and second nearest of one random point per cell, repeating every `period` cells.
pub(crate) fn cells(x: f64, y: f64, period: (i32, i32), salt: u32) -> (f64, f64) {
    let (ix, iy) = (floor(x), floor(y));
    let (fx, fy) = (f64::from(ix), f64::from(iy));
    let (mut first, mut second) = (9.0_f64, 9.0_f64);
    for dy in -1..=1 {
        for dx in -1..=1 {
            let h = hash((ix + dx).rem_euclid(period.0), (iy + dy).rem_euclid(period.1), salt);
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

/// A number in \[0, 1) for an integer.
pub(crate) fn random(k: i32, salt: u32) -> f64 {
    unit(hash(k, 77, salt))
}

/// Of a small number. `f64::floor` is a call into a library on processors without SSE 4.1.
fn floor(x: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "texture coordinates are small")]
    let toward_zero = x as i32;
    toward_zero - i32::from(f64::from(toward_zero) > x)
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
