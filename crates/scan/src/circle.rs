//! Circles through noisy points of a cross-section.

use base::{Stream, ops};
use glam::DVec2;

/// A circle and how well points support it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Circle {
    pub(crate) centre: DVec2,
    pub(crate) radius: f64,
    /// Root mean square distance between it and its own points.
    pub(crate) rms: f64,
    /// Number of points near it.
    pub(crate) own: usize,
    /// Share of all points that lie near it.
    pub(crate) share: f64,
    /// Share of its circumference that has points, 0 to 1.
    pub(crate) covered: f64,
    /// Share of all points that lie well inside it: wood has none.
    pub(crate) inside: f64,
}

/// Number of sectors of a circumference.
const SECTORS: usize = 16;

/// Fits the circle near which most points lie: the best of many through three points (Fischler and Bolles 1981), then
/// the least squares of the distances of the points near it. `noise`: error of a point. `largest`: greatest radius.
///
/// None for fewer than 6 points, or if no circle is sound.
pub(crate) fn fit_circle(points: &[DVec2], noise: f64, largest: f64, stream: &mut Stream) -> Option<Circle> {
    if points.len() < 6 {
        return None;
    }
    let mut best: Option<(f64, DVec2, f64)> = None;
    for _ in 0..60 {
        let [a, b, c] = [0; 3].map(|_: u8| points[stream.below(points.len())]);
        let Some((centre, radius)) = through(a, b, c) else { continue };
        if radius > largest {
            continue;
        }
        let width = noise.max(0.06 * radius);
        // A soft count of points, less those well inside: bark has nothing in it.
        let score: f64 = points
            .iter()
            .map(|p| {
                let off = p.distance(centre) - radius;
                let near = 1.0 - (off / width) * (off / width);
                near.max(if off < -2.0 * width { -0.5 } else { 0.0 })
            })
            .sum();
        if best.is_none_or(|b| score > b.0) {
            best = Some((score, centre, radius));
        }
    }
    let (_, mut centre, mut radius) = best?;
    for round in 0..8 {
        let width = noise.max(0.06 * radius) * if round < 3 { 2.0 } else { 1.5 };
        (centre, radius) = step(points, centre, radius, width)?;
        if !(radius > 0.0 && radius <= 1.5 * largest) {
            return None;
        }
    }
    let width = 2.0 * noise.max(0.06 * radius);
    let near: Vec<DVec2> =
        points.iter().copied().filter(|p| (p.distance(centre) - radius).abs() < width).collect();
    let mut sectors = [false; SECTORS];
    let mut square = 0.0;
    for p in &near {
        let d = *p - centre;
        square += (d.length() - radius) * (d.length() - radius);
        let turn = (ops::atan2(d.y, d.x) / ops::TAU + 1.0) * SECTORS as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few sectors")]
        let sector = turn as usize % SECTORS;
        sectors[sector] = true;
    }
    if near.len() < 5 {
        return None;
    }
    Some(Circle {
        centre,
        radius,
        rms: (square / near.len() as f64).sqrt(),
        own: near.len(),
        share: near.len() as f64 / points.len() as f64,
        covered: sectors.iter().filter(|s| **s).count() as f64 / SECTORS as f64,
        inside: points.iter().filter(|p| p.distance(centre) < radius - 2.0 * width).count() as f64
            / points.len() as f64,
    })
}

/// Returns a step of Gauss and Newton with Tukey's weights.
fn step(points: &[DVec2], centre: DVec2, radius: f64, width: f64) -> Option<(DVec2, f64)> {
    let mut m = [0.0; 9];
    let mut b = [0.0; 3];
    for p in points {
        let d = *p - centre;
        let length = d.length();
        let off = length - radius;
        let u = off / width;
        if u.abs() >= 1.0 || length < 1e-9 {
            continue;
        }
        let w = (1.0 - u * u) * (1.0 - u * u);
        let row = [d.x / length, d.y / length, 1.0];
        for i in 0..3 {
            b[i] += w * row[i] * off;
            for j in 0..3 {
                m[3 * i + j] += w * row[i] * row[j];
            }
        }
    }
    // A small regularisation keeps short arcs from diverging.
    let whole = m[8];
    (0..2).for_each(|i| m[4 * i] += 0.02 * whole);
    geom::solve_positive(&mut m, &mut b)?;
    Some((centre + DVec2::new(b[0], b[1]), radius + b[2]))
}

fn through(a: DVec2, b: DVec2, c: DVec2) -> Option<(DVec2, f64)> {
    let (u, v) = (b - a, c - a);
    let cross = 2.0 * u.perp_dot(v);
    let (uu, vv) = (u.length_squared(), v.length_squared());
    if cross.abs() < 1e-3 * (uu * vv).sqrt() || cross == 0.0 {
        return None;
    }
    let centre = DVec2::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / cross;
    Some((a + centre, centre.length()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::{Draw, Seed};

    #[test]
    fn an_arc_among_strays_gives_its_circle() {
        let mut s = Seed::new(3).stream(Draw::Test);
        let mut points: Vec<DVec2> = (0..120)
            .map(|_| {
                let (sin, cos) = ops::sin_cos(s.range(0.0, 4.0));
                DVec2::new(1.0, -2.0) + DVec2::new(cos, sin) * (0.2 + 0.003 * s.normal())
            })
            .collect();
        points.extend((0..40).map(|_| DVec2::new(s.range(0.9, 1.6), s.range(-2.3, -1.7))));
        let c = fit_circle(&points, 0.005, 1.0, &mut s).unwrap();
        assert!((c.radius - 0.2).abs() < 0.003 && c.centre.distance(DVec2::new(1.0, -2.0)) < 0.004, "{c:?}");
        assert!((0.5..0.9).contains(&c.covered), "{c:?}");
        assert_eq!(fit_circle(&[DVec2::ZERO; 30], 0.01, 1.0, &mut s), None);
        assert_eq!(fit_circle(&points[..5], 0.01, 1.0, &mut s), None);
    }
}
