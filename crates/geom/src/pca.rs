//! Principal axes of points, and the box along them.

use crate::vector::Vector;
use glam::{DVec2, DVec3};

/// Principal axes of a set of points in the plane.
///
/// ```
/// use glam::{DVec2, DVec3};
/// let p = geom::pca2(&[DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(2.0, 1.0)]).unwrap();
/// assert!((p.major - DVec2::X).length() < 1e-12);
/// assert_eq!(p.extent, [4.0, 1.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pca2 {
    /// The mean of the points.
    pub centre: DVec2,
    /// Unit direction of greatest variance; x > 0, or x = 0 and y > 0.
    pub major: DVec2,
    /// Unit direction at a right angle, left of `major`.
    pub minor: DVec2,
    /// Variances along the two axes (mean squares), greatest first, never negative.
    pub lambda: [f64; 2],
    /// Edge lengths along the two axes of the box around the points.
    pub extent: [f64; 2],
}

/// Returns the principal axes of the usable points; `None` if there are none.
///
/// Points without a preferred direction (all equal, or a regular polygon) have the x axis as `major`.
pub fn pca2(points: &[DVec2]) -> Option<Pca2> {
    let usable = || points.iter().copied().filter(|p| p.usable());
    let n = usable().count() as f64;
    let first = usable().next()?;
    // Relative to the first point: far from the origin the mean would lose digits.
    let centre = first + usable().map(|p| p - first).sum::<DVec2>() / n;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for d in usable().map(|p| p - centre) {
        xx += d.x * d.x / n;
        xy += d.x * d.y / n;
        yy += d.y * d.y / n;
    }
    let (lambda, major) = symmetric_2x2(xx, xy, yy);
    let minor = major.perp();
    let extent = [major, minor].map(|axis| {
        let along = || usable().map(|p| (p - centre).dot(axis));
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    });
    Some(Pca2 { centre, major, minor, lambda: lambda.map(|l| l.max(0.0)), extent })
}

/// Returns the eigenvalues of a symmetric 2 x 2 matrix, greater first, with the unit eigenvector of the first: x > 0,
/// or x = 0 and y > 0; the x axis if there is no preferred direction.
pub(crate) fn symmetric_2x2(xx: f64, xy: f64, yy: f64) -> ([f64; 2], DVec2) {
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let spread = (half * half + xy * xy).sqrt();
    // The row of the eigenvector equation without cancellation.
    let v = if half >= 0.0 { DVec2::new(half + spread, xy) } else { DVec2::new(xy, spread - half) };
    // 1e-12: a difference of the size of rounding defines no direction.
    let v = if spread > 1e-12 * mean.abs() { v.direction().unwrap_or(DVec2::X) } else { DVec2::X };
    let v = if v.x < 0.0 || (v.x <= 0.0 && v.y < 0.0) { -v } else { v };
    ([mean + spread, mean - spread], v)
}

/// Returns the mean of the usable points, their principal axes (unit, at right angles, greatest variance first, right
/// handed) and the variances along them; `None` if there is no usable point.
pub fn pca3(points: &[DVec3]) -> Option<(DVec3, [DVec3; 3], [f64; 3])> {
    let usable = || points.iter().copied().filter(|p| p.usable());
    let n = usable().count() as f64;
    let first = usable().next()?;
    let centre = first + usable().map(|p| p - first).sum::<DVec3>() / n;
    let mut m = nalgebra::Matrix3::zeros();
    for d in usable().map(|p| p - centre) {
        let d = nalgebra::Vector3::new(d.x, d.y, d.z);
        m += d * d.transpose() / n;
    }
    // Powers of two do not change the directions; the solver works best near 1.
    let scale = m.amax();
    let eigen = nalgebra::SymmetricEigen::new(if scale > 0.0 { m / scale } else { m });
    let mut order = [0, 1, 2];
    base::sort_by(&mut order, |&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let axis = |k: usize| {
        let v = eigen.eigenvectors.column(k);
        DVec3::new(v[0], v[1], v[2]).direction().unwrap_or(DVec3::X)
    };
    let (a, b) = (axis(order[0]), axis(order[1]));
    let variances = order.map(|k| (eigen.eigenvalues[k] * scale).max(0.0));
    Some((centre, [a, b, a.cross(b)], variances))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pca3_finds_the_axes_of_a_box() {
        let corners: Vec<DVec3> = (0..8)
            .map(|k| DVec3::new(f64::from(k % 2), 5.0 * f64::from(k / 2 % 2), 2.0 * f64::from(k / 4)))
            .collect();
        let (centre, axes, variances) = pca3(&corners).unwrap();
        assert!(centre.distance(DVec3::new(0.5, 2.5, 1.0)) < 1e-12);
        assert!(axes[0].y.abs() > 1.0 - 1e-12 && axes[1].z.abs() > 1.0 - 1e-12);
        assert!((axes[0].cross(axes[1]) - axes[2]).length() < 1e-12);
        assert!((variances[0] - 6.25).abs() < 1e-12 && (variances[2] - 0.25).abs() < 1e-12);
        assert_eq!(pca3(&[DVec3::NAN]), None);
    }

    #[test]
    fn axes_of_a_turned_rectangle() {
        let axis = base::turn::direction(2.2);
        let at = |u: f64, v: f64| DVec2::new(100.0, -7.0) + axis * u + axis.perp() * v;
        let p = pca2(&[at(3.0, 1.0), at(-3.0, 1.0), at(-3.0, -1.0), at(3.0, -1.0)]).unwrap();
        assert!(p.major.perp_dot(axis).abs() < 1e-12 && p.major.x > 0.0, "{p:?}");
        assert!((p.lambda[0] - 9.0).abs() < 1e-9 && (p.lambda[1] - 1.0).abs() < 1e-9, "{p:?}");
        assert!((p.extent[0] - 6.0).abs() < 1e-9 && (p.extent[1] - 2.0).abs() < 1e-9, "{p:?}");
    }

    #[test]
    fn vertical_line_and_degenerate_input() {
        let p = pca2(&[DVec2::ZERO, DVec2::NAN, DVec2::new(0.0, 2.0)]).unwrap();
        assert_eq!((p.major, p.extent), (DVec2::Y, [2.0, 0.0]));
        assert_eq!(pca2(&[DVec2::NAN]), None);
        assert_eq!(pca2(&[DVec2::ONE; 3]).map(|p| (p.major, p.lambda)), Some((DVec2::X, [0.0, 0.0])));
    }
}
