//! Smooth curves through or along points, sampled.

use crate::vector::{Vector, distinct};
use glam::DVec3;

// More samples than this on one piece must be a mistake.
const MAX_PER_PIECE: usize = 4096;

/// Samples quadratic Bezier pieces that join with one tangent, `per_piece` samples each; the ends are kept.
///
/// The points are control points: the curve runs from each midpoint of a segment to the next, drawn towards
/// the point between, and passes through the first and last point only. Unusable and repeated points are
/// dropped; fewer than three distinct points are returned as they are. With n distinct points the result has
/// `(n - 2) * per_piece + 1` points; `per_piece` is clamped to 1..=4096.
///
/// Yang et al. (2019): `P0 = (M0 + M1)/2`, control point `M1`, `P2 = (M1 + M2)/2`.
pub fn bezier_quadratic_c1(points: &[DVec3], per_piece: usize) -> Vec<DVec3> {
    let m = distinct(points);
    if m.len() < 3 {
        return m;
    }
    let per_piece = per_piece.clamp(1, MAX_PER_PIECE);
    let last = m.len() - 1;
    let mut out = Vec::with_capacity((last - 1) * per_piece + 1);
    out.push(m[0]);
    for i in 1..last {
        let start = if i == 1 { m[0] } else { (m[i - 1] + m[i]) * 0.5 };
        let end = if i + 1 == last { m[last] } else { (m[i] + m[i + 1]) * 0.5 };
        for k in 1..per_piece {
            let t = k as f64 / per_piece as f64;
            let u = 1.0 - t;
            out.push(start * (u * u) + m[i] * (2.0 * u * t) + end * (t * t));
        }
        out.push(end);
    }
    out
}

/// Samples a centripetal Catmull-Rom curve through all points, `per_piece` samples between each two.
///
/// Passes through every distinct point, never makes a loop or cusp within a piece, and has a continuous
/// tangent. Beyond the ends the line is continued by reflection. Unusable and repeated points are dropped;
/// fewer than three distinct points are returned as they are. With n distinct points the result has
/// `(n - 1) * per_piece + 1` points; `per_piece` is clamped to 1..=4096.
///
/// Yuksel, Schaefer and Keyser 2011 (knots at the square root of the chord), by the pyramid of Barry and
/// Goldman 1988.
pub fn catmull_rom(points: &[DVec3], per_piece: usize) -> Vec<DVec3> {
    let p = distinct(points);
    if p.len() < 3 {
        return p;
    }
    let per_piece = per_piece.clamp(1, MAX_PER_PIECE);
    let last = p.len() - 1;
    let mut out = Vec::with_capacity(last * per_piece + 1);
    out.push(p[0]);
    for i in 0..last {
        let before = if i == 0 { p[0] * 2.0 - p[1] } else { p[i - 1] };
        let after = if i + 1 == last { p[last] * 2.0 - p[last - 1] } else { p[i + 2] };
        let quad = [before, p[i], p[i + 1], after];
        for k in 1..per_piece {
            out.push(centripetal(quad, k as f64 / per_piece as f64));
        }
        out.push(p[i + 1]);
    }
    out
}

/// Returns the point at share `t` between the second and third of four distinct points.
fn centripetal(p: [DVec3; 4], t: f64) -> DVec3 {
    let gap = |a: DVec3, b: DVec3| Vector::distance(a, b).sqrt();
    let k1 = gap(p[0], p[1]);
    let k2 = k1 + gap(p[1], p[2]);
    let k3 = k2 + gap(p[2], p[3]);
    let x = k1 + (k2 - k1) * t;
    let mix = |a: DVec3, b: DVec3, from: f64, to: f64| {
        // The gap can vanish compared with a much larger one; the piece is then the straight line.
        let share = if to > from { (x - from) / (to - from) } else { t };
        a + (b - a) * share
    };
    let (a, b, c) = (mix(p[0], p[1], 0.0, k1), mix(p[1], p[2], k1, k2), mix(p[2], p[3], k2, k3));
    let point = mix(mix(a, b, 0.0, k2), mix(b, c, k1, k3), k1, k2);
    if point.usable() { point } else { p[1] + (p[2] - p[1]) * t }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polyline_length3;

    fn zigzag() -> Vec<DVec3> {
        vec![DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), DVec3::new(2.0, -1.0, 1.0), DVec3::new(3.0, 0.0, 0.0)]
    }

    #[test]
    fn bezier_keeps_ends_and_midpoints() {
        let m = zigzag();
        let out = bezier_quadratic_c1(&m, 8);
        assert_eq!((out.len(), out[0], out[16]), (17, m[0], m[3]));
        assert_eq!(out[8], (m[1] + m[2]) * 0.5);
        let (before, after) = (out[8] - out[7], out[9] - out[8]);
        assert!(before.normalize().dot(after.normalize()) > 0.955, "tangent is continuous at the joint");
    }

    #[test]
    fn bezier_of_a_parabola_is_exact() {
        // One piece with control point M1 is the parabola itself.
        let out =
            bezier_quadratic_c1(&[DVec3::ZERO, DVec3::new(0.5, 1.0, 0.0), DVec3::new(1.0, 0.0, 0.0)], 10);
        for p in out {
            assert!((p.y - 2.0 * p.x * (1.0 - p.x)).abs() < 1e-15, "{p}");
        }
    }

    #[test]
    fn catmull_rom_passes_through_all_points() {
        let p = zigzag();
        let out = catmull_rom(&p, 10);
        assert_eq!(out.len(), 31);
        for (i, q) in p.iter().enumerate() {
            assert_eq!(out[i * 10], *q);
        }
    }

    #[test]
    fn catmull_rom_of_a_straight_line_is_straight() {
        let p = [0.0, 0.1, 3.0, 3.5].map(|x| DVec3::new(x, 2.0 * x, 0.0));
        let out = catmull_rom(&p, 16);
        assert!((polyline_length3(&out) - polyline_length3(&p)).abs() < 1e-12, "no to and fro");
    }

    #[test]
    fn too_few_points_come_back() {
        assert_eq!(catmull_rom(&[DVec3::X, DVec3::X, DVec3::NAN], 4), vec![DVec3::X]);
        assert_eq!(bezier_quadratic_c1(&[], 4), vec![]);
    }
}
