//! Fits the ellipse as which the rim of a flower appears to petal tips.

use crate::pca::symmetric_2x2;
use crate::vector::Vector;
use base::ops;
use glam::DVec2;
use nalgebra::{Matrix2, Matrix3, SymmetricEigen, Vector3};

/// An ellipse in the plane.
///
/// ```
/// use glam::DVec2;
/// let tips: Vec<DVec2> =
///     (0..6).map(|k| DVec2::from_angle(k as f64 * 1.0)).map(|p| DVec2::new(3.0 * p.x, p.y)).collect();
/// let e = geom::fit_ellipse(&tips).unwrap();
/// assert!((e.major - 3.0).abs() < 1e-9 && (e.minor - 1.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// The centre.
    pub centre: DVec2,
    /// Semi-major axis, a length > 0.
    pub major: f64,
    /// Semi-minor axis, 0 <= minor <= major.
    pub minor: f64,
    /// Unit vector along the major axis; x > 0, or x = 0 and y > 0. The x axis for a circle.
    pub axis: DVec2,
}

impl Ellipse {
    /// Returns minor / major, in \[0, 1\]: the sine of the angle between the flower's axis and the drawing plane.
    pub fn ratio(&self) -> f64 {
        self.minor / self.major
    }
}

/// Returns the usable points relative to their mean, the mean, and the root mean square distance from it.
fn centre_and_scale(points: &[DVec2]) -> Option<(Vec<DVec2>, DVec2, f64)> {
    let usable: Vec<DVec2> = points.iter().copied().filter(|p| p.usable()).collect();
    let first = *usable.first()?;
    let n = usable.len() as f64;
    let centre = first + usable.iter().map(|&p| p - first).sum::<DVec2>() / n;
    let scale = (usable.iter().map(|&p| (p - centre).length_squared()).sum::<f64>() / n).sqrt();
    (scale > 0.0 && (1.0 / scale).is_finite()).then_some((usable, centre, scale))
}

/// Fits the best ellipse in the algebraic sense; always an ellipse, never another conic.
///
/// Needs at least 5 different usable points; `None` with fewer, or for points (nearly) on a straight line.
/// Exact, up to rounding, for points of an ellipse; with noise somewhat too small. Invariant under shift,
/// rotation and scale. Cost: linear.
///
/// Halir and Flusser 1998, with centred data (Chernov).
pub fn fit_ellipse(points: &[DVec2]) -> Option<Ellipse> {
    let (usable, centre, scale) = centre_and_scale(points)?;
    let mut distinct: Vec<DVec2> = usable.iter().map(|&p| (p - centre) / scale).collect();
    let data = distinct.clone();
    base::sort_by(&mut distinct, |p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    distinct.dedup();
    if distinct.len() < 5 {
        return None;
    }
    let (mut s1, mut s2, mut s3) = (Matrix3::zeros(), Matrix3::zeros(), Matrix3::zeros());
    for p in &data {
        let quadratic = Vector3::new(p.x * p.x, p.x * p.y, p.y * p.y);
        let linear = Vector3::new(p.x, p.y, 1.0);
        s1 += quadratic * quadratic.transpose();
        s2 += quadratic * linear.transpose();
        s3 += linear * linear.transpose();
    }
    let t = -(s3.try_inverse()? * s2.transpose());
    let reduced: Matrix3<f64> = s1 + s2 * t;
    // Minimise a'Ra under a'Ca = 1, C = [0 0 2; 0 -1 0; 2 0 0] (4 a0 a2 - a1^2), as the eigenproblem of
    // L^-1 C L^-T with R = LL'. C has one positive eigenvalue, so exactly one solution is an ellipse.
    // 1e-15 of the trace makes R definite for exact points, where its least eigenvalue is 0 or rounding.
    let lift = 1e-15 * reduced.trace();
    let symmetric = (reduced + reduced.transpose()) * 0.5;
    let lower = [1.0, 16.0, 256.0, 4096.0]
        .into_iter()
        .find_map(|times| (symmetric + Matrix3::identity() * (lift * times)).cholesky())?
        .l();
    let inverse = lower.try_inverse()?;
    let constraint = Matrix3::new(0.0, 0.0, 2.0, 0.0, -1.0, 0.0, 2.0, 0.0, 0.0);
    let problem = inverse * constraint * inverse.transpose();
    if !problem.iter().all(|x| x.is_finite()) {
        return None;
    }
    let eigen = SymmetricEigen::try_new((problem + problem.transpose()) * 0.5, f64::EPSILON, 200)?;
    let a1 = inverse.transpose() * eigen.eigenvectors.column(eigen.eigenvalues.imax());
    let a2 = t * a1;
    let unit = from_conic([a1[0], a1[1], a1[2], a2[0], a2[1], a2[2]])?;
    let fit = Ellipse {
        centre: centre + unit.centre * scale,
        major: unit.major * scale,
        minor: unit.minor * scale,
        axis: unit.axis,
    };
    (fit.centre.usable() && fit.major.is_finite() && fit.major > 0.0).then_some(fit)
}

/// Returns the ellipse `a x^2 + b xy + c y^2 + d x + e y + f = 0`, if it is one.
fn from_conic([a, b, c, d, e, f]: [f64; 6]) -> Option<Ellipse> {
    let middle = Matrix2::new(2.0 * a, b, b, 2.0 * c).try_inverse()? * nalgebra::Vector2::new(-d, -e);
    let level = -(f + 0.5 * (d * middle[0] + e * middle[1]));
    // Sign such that the quadratic form is positive.
    let sign = if a + c < 0.0 { -1.0 } else { 1.0 };
    let ([great, small], across) = symmetric_2x2(sign * a, sign * 0.5 * b, sign * c);
    let level = sign * level;
    let (major, minor) = ((level / small).sqrt(), (level / great).sqrt());
    let round = great - small <= 1e-14 * great;
    let axis = if round { DVec2::X } else { across.perp() };
    let axis = if axis.x < 0.0 || (axis.x <= 0.0 && axis.y < 0.0) { -axis } else { axis };
    let sound = small > 0.0 && major.is_finite() && minor > 0.0;
    sound.then_some(Ellipse {
        centre: DVec2::new(middle[0], middle[1]),
        major,
        minor: minor.min(major),
        axis,
    })
}

/// Fits the ellipse through the tips of equally spaced petals, from their first harmonic.
///
/// Needs at least 3 usable points; `None` with fewer or if all coincide. The tips may come in any order and are sorted
/// by their angle about the mean. Exact if they are the parallel projection of a regular polygon (for 3 tips: Steiner's
/// circumscribed ellipse; for 4: from conjugate diameters). Tips on a straight line give `minor` 0. Cost: n log n.
///
/// The "highly symmetric" assumption of He and Cheng (2021), section 5.1.
pub fn fit_ellipse_harmonic(tips: &[DVec2]) -> Option<Ellipse> {
    let (usable, centre, scale) = centre_and_scale(tips)?;
    let n = usable.len();
    if n < 3 {
        return None;
    }
    let mut offsets: Vec<(f64, DVec2)> =
        usable.iter().map(|&p| (p - centre) / scale).map(|d| (ops::atan2(d.y, d.x), d)).collect();
    base::sort_by(&mut offsets, |p, q| {
        p.0.total_cmp(&q.0).then(p.1.length_squared().total_cmp(&q.1.length_squared()))
    });
    let (mut cosine, mut sine) = (DVec2::ZERO, DVec2::ZERO);
    for (k, (_, d)) in offsets.iter().enumerate() {
        let (s, c) = ops::sin_cos(ops::TAU * k as f64 / n as f64);
        cosine += *d * (c * 2.0 / n as f64);
        sine += *d * (s * 2.0 / n as f64);
    }
    let xx = cosine.x * cosine.x + sine.x * sine.x;
    let xy = cosine.x * cosine.y + sine.x * sine.y;
    let yy = cosine.y * cosine.y + sine.y * sine.y;
    let ([greatest, _], axis) = symmetric_2x2(xx, xy, yy);
    let major = greatest.max(0.0).sqrt();
    // The determinant is the product of the axes: no difference of nearly equal squares.
    let minor = if major > 0.0 { (cosine.perp_dot(sine).abs() / major).min(major) } else { 0.0 };
    (major > 0.0).then_some(Ellipse { centre, major: major * scale, minor: minor * scale, axis })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Returns equally spaced tips (in the plane of the flower) on an ellipse.
    pub(crate) fn tips(e: &Ellipse, n: usize, first: f64) -> Vec<DVec2> {
        (0..n)
            .map(|k| ops::sin_cos(first + ops::TAU * k as f64 / n as f64))
            .map(|(s, c)| e.centre + e.axis * (e.major * c) + e.axis.perp() * (e.minor * s))
            .collect()
    }

    fn examples() -> Vec<Ellipse> {
        [(1.0, 0.999), (3.0, 1.0), (0.02, 0.019), (50.0, 1.0), (1e-6, 4e-7)]
            .iter()
            .zip([0.3, -1.2, 1.5, 0.0, 0.7])
            .map(|(&(major, minor), angle)| Ellipse {
                centre: DVec2::new(7.0, -2.0) * major,
                major,
                minor,
                axis: base::turn::direction(angle),
            })
            .collect()
    }

    fn assert_same(found: &Ellipse, e: &Ellipse, tolerance: f64) {
        assert!((found.centre - e.centre).length() < tolerance * e.major, "{found:?} {e:?}");
        assert!((found.major - e.major).abs() < tolerance * e.major, "{found:?} {e:?}");
        assert!((found.minor - e.minor).abs() < tolerance * e.major, "{found:?} {e:?}");
        let sharp = 1.0 - e.minor / e.major;
        assert!(found.axis.perp_dot(e.axis).abs() * sharp < tolerance, "{found:?} {e:?}");
    }

    #[test]
    fn both_fits_are_exact_on_exact_tips() {
        for e in examples() {
            for n in 3..9 {
                let mut tips = tips(&e, n, 0.4);
                tips.reverse();
                tips.rotate_left(n / 2);
                assert_same(&fit_ellipse_harmonic(&tips).unwrap(), &e, 1e-11);
                if n >= 5 {
                    assert_same(&fit_ellipse(&tips).unwrap(), &e, 1e-6);
                } else {
                    assert_eq!(fit_ellipse(&tips), None);
                }
            }
        }
    }

    #[test]
    fn uneven_points_of_a_part_of_the_ellipse_suffice() {
        let e = Ellipse { centre: DVec2::ONE, major: 2.0, minor: 1.0, axis: DVec2::Y };
        let part: Vec<DVec2> = (0..12)
            .map(|k| ops::sin_cos(0.02 * f64::from(k * k)))
            .map(|(s, c)| e.centre + DVec2::new(s, 2.0 * c))
            .collect();
        assert_same(&fit_ellipse(&part).unwrap(), &e, 1e-8);
    }

    #[test]
    fn degenerate_tips() {
        let line: Vec<DVec2> = (0..8).map(|k| DVec2::new(f64::from(k), 2.0 * f64::from(k))).collect();
        assert_eq!(fit_ellipse(&line), None);
        assert!(fit_ellipse_harmonic(&line).is_some_and(|e| e.minor < 1e-12 && e.major > 1.0));
        assert_eq!(fit_ellipse_harmonic(&[DVec2::ONE; 6]), None);
        assert_eq!(fit_ellipse(&[DVec2::ONE; 6]), None);
        let wild = [DVec2::NAN, DVec2::X, DVec2::new(1e300, 0.0), DVec2::Y, DVec2::INFINITY];
        assert_eq!((fit_ellipse(&wild), fit_ellipse_harmonic(&wild)), (None, None));
    }
}
