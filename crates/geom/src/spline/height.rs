//! Fits a smooth height field over a plane to scattered points, by penalised least squares.

use glam::{DVec2, DVec3};

use super::{Basis, SplineError, Weights};
use crate::linear::solve_positive;
use crate::vector::Vector as _;

/// A bicubic height over a rectangle of the xy plane.
///
/// ```
/// use geom::HeightField;
/// use glam::DVec3;
/// let slope: Vec<DVec3> =
///     (0..100).map(|k| DVec3::new(f64::from(k % 10), f64::from(k / 10), f64::from(k % 10) * 0.5)).collect();
/// let field = HeightField::fit(&slope, &[], [6, 6], 1e-3)?;
/// assert!((field.height(4.5, 3.0).0 - 2.25).abs() < 1e-9);
/// # Ok::<(), geom::SplineError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    u: Basis,
    v: Basis,
    lo: DVec2,
    size: DVec2,
    heights: Vec<f64>,
}

impl HeightField {
    /// Fits the height field with `controls` controls along x and y (each 4 to 40) to points.
    ///
    /// `weights` are one per point, at least 0, or empty for all 1. `smoothing` is the weight of the bending of the
    /// controls relative to the points near one: above 0; 1e-3 bridges holes and hardly smooths, 1 smooths. Planes are
    /// reproduced exactly. Cost: 16² times the points and the cube of the controls.
    ///
    /// # Errors
    /// [`SplineError::TooFew`] for less than 3 usable points, [`SplineError::Parameters`] if they lie on a line.
    pub fn fit(
        points: &[DVec3],
        weights: &[f64],
        controls: [usize; 2],
        smoothing: f64,
    ) -> Result<Self, SplineError> {
        let [nx, ny] = controls.map(|n| n.clamp(4, 40));
        let (u, v) = (Basis::uniform(3, nx)?, Basis::uniform(3, ny)?);
        let weight = |k: usize| weights.get(k).map_or(1.0, |w| if *w > 0.0 { w.min(1e6) } else { 0.0 });
        let used = || points.iter().enumerate().filter(|(k, p)| p.usable() && weight(*k) > 0.0);
        let given = used().count();
        if given < 3 {
            return Err(SplineError::TooFew { needed: 3, given });
        }
        let mut lo = DVec2::INFINITY;
        let mut hi = DVec2::NEG_INFINITY;
        for (_, p) in used() {
            lo = lo.min(p.truncate());
            hi = hi.max(p.truncate());
        }
        let size = (hi - lo).max(DVec2::splat(f64::MIN_POSITIVE));
        let mut field = Self { u, v, lo, size, heights: vec![] };
        let n = nx * ny;
        let mut normal = vec![0.0; n * n];
        let mut right = vec![0.0; n];
        let mut total = 0.0;
        for (k, p) in used() {
            let (a, b) = field.weights(p.x, p.y);
            let w = weight(k);
            total += w;
            let cells: Vec<(usize, f64)> = cells(&a, &b, nx).collect();
            for &(i, x) in &cells {
                right[i] += w * x * p.z;
                for &(j, y) in &cells {
                    normal[i * n + j] += w * x * y;
                }
            }
        }
        let stiff = if smoothing > 0.0 { smoothing.min(1e6) } else { 1e-9 } * total / n as f64;
        add_bending(&mut normal, [&field.u, &field.v], stiff);
        // Where there are no points at all, a small regularisation maintains a plane through the others.
        for i in 0..n {
            normal[i * n + i] += 1e-9 * stiff;
        }
        solve_positive(&mut normal, &mut right).ok_or(SplineError::Parameters)?;
        field.heights = right;
        Ok(field)
    }

    /// Returns the height at (x, y) and its slope there; outside the rectangle that of the nearest point in it.
    pub fn height(&self, x: f64, y: f64) -> (f64, DVec2) {
        let (a, b) = self.weights(x, y);
        let q = self.place(x, y);
        let (da, db) = (self.u.derivative(q.x), self.v.derivative(q.y));
        let nx = self.u.controls();
        let sum = |a: &Weights, b: &Weights| cells(a, b, nx).map(|(i, w)| w * self.heights[i]).sum::<f64>();
        (sum(&a, &b), DVec2::new(sum(&da, &b), sum(&a, &db)) / self.size)
    }

    fn place(&self, x: f64, y: f64) -> DVec2 {
        ((DVec2::new(x, y) - self.lo) / self.size).clamp(DVec2::ZERO, DVec2::ONE)
    }

    fn weights(&self, x: f64, y: f64) -> (Weights, Weights) {
        let q = self.place(x, y);
        (self.u.weights(q.x), self.v.weights(q.y))
    }
}

fn cells<'a>(a: &'a Weights, b: &'a Weights, nx: usize) -> impl Iterator<Item = (usize, f64)> + 'a {
    let rows = b.values().iter().enumerate();
    rows.flat_map(move |(j, &y)| {
        let along = a.values().iter().enumerate();
        along.map(move |(i, &x)| ((b.first + j) * nx + a.first + i, x * y))
    })
}

/// Adds the squares of the bending along both directions and of the twist; 0 for planes.
fn add_bending(normal: &mut [f64], [u, v]: [&Basis; 2], weight: f64) {
    let (nx, ny) = (u.controls(), v.controls());
    let n = nx * ny;
    let mut add = |terms: &[(usize, f64)]| {
        for &(i, a) in terms {
            for &(j, b) in terms {
                normal[i * n + j] += weight * a * b;
            }
        }
    };
    // Controls stand at the Greville abscissae, denser at the ends: the change of slope, in steps of the middle.
    let bend = |basis: &Basis, k: usize| {
        let g = |i: usize| basis.greville(i) * basis.controls() as f64;
        let (a, b) = (1.0 / (g(k + 1) - g(k)), 1.0 / (g(k + 2) - g(k + 1)));
        [a, -a - b, b]
    };
    for y in 0..ny {
        for x in 0..nx {
            let at = |dx: usize, dy: usize| (y + dy) * nx + x + dx;
            if x + 2 < nx {
                let [a, b, c] = bend(u, x);
                add(&[(at(0, 0), a), (at(1, 0), b), (at(2, 0), c)]);
            }
            if y + 2 < ny {
                let [a, b, c] = bend(v, y);
                add(&[(at(0, 0), a), (at(0, 1), b), (at(0, 2), c)]);
            }
            if x + 1 < nx && y + 1 < ny {
                add(&[(at(0, 0), 1.0), (at(1, 0), -1.0), (at(0, 1), -1.0), (at(1, 1), 1.0)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::{Draw, Seed, ops};

    #[test]
    fn a_bowl_with_noise_and_a_hole_is_found() {
        let mut s = Seed::new(4).stream(Draw::Test);
        let truth = |x: f64, y: f64| 0.2 * x * x + 0.1 * ops::sin(3.0 * y);
        let mut points = Vec::new();
        while points.len() < 3000 {
            let (x, y) = (s.range(-1.0, 1.0), s.range(-2.0, 2.0));
            if DVec2::new(x, y).length() > 0.3 {
                points.push(DVec3::new(x, y, truth(x, y) + 0.01 * s.normal()));
            }
        }
        let field = HeightField::fit(&points, &[], [8, 12], 1e-3).unwrap();
        for (x, y) in [(0.0, 0.0), (0.5, 1.2), (-0.8, -1.5), (0.1, -0.2)] {
            let (z, slope) = field.height(x, y);
            assert!((z - truth(x, y)).abs() < 0.01, "{x} {y}: {z} {}", truth(x, y));
            assert!((slope.x - 0.4 * x).abs() < 0.1, "{slope}");
        }
    }

    #[test]
    fn too_few_points_and_weights_of_zero_are_refused() {
        let p = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::NAN];
        assert!(matches!(HeightField::fit(&p[..2], &[], [4, 4], 1.0), Err(SplineError::TooFew { .. })));
        assert!(matches!(
            HeightField::fit(&p, &[1.0, 0.0, 1.0], [4, 4], 1.0),
            Err(SplineError::TooFew { .. })
        ));
        assert!(HeightField::fit(&p, &[], [4, 4], 1.0).is_ok());
    }
}
