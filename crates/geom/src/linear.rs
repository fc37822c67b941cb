//! Small dense linear algebra: systems of equations, the best rotation between two point sets.

use core::ops::{Add, Mul, Sub};

use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix4, SymmetricEigen};

/// A value that can be interpolated: number, point, ball.
pub trait Blend: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> {}
impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>> Blend for T {}

/// Solves `a x = b` for numbers or vectors, `a` symmetric positive definite (only its lower half is read), both in
/// place: `b` becomes `x`.
///
/// `None` if a pivot is below 1e-13 of the largest element of the diagonal. Cost: n cubed over 6 (Cholesky).
pub fn solve_positive<V: Blend>(matrix: &mut [f64], right: &mut [V]) -> Option<()> {
    let n = right.len();
    let largest = (0..n).map(|i| matrix[i * n + i]).fold(0.0, f64::max);
    for i in 0..n {
        for j in 0..=i {
            let (head, tail) = matrix.split_at(i * n);
            let row_j = if i == j { &tail[..j] } else { &head[j * n..j * n + j] };
            let dot: f64 = tail[..j].iter().zip(row_j).map(|(x, y)| x * y).sum();
            let rest = tail[j] - dot;
            if i == j {
                // 1e-13: below this a control is undetermined (no data near it).
                if rest <= 1e-13 * largest || rest.is_nan() {
                    return None;
                }
                matrix[i * n + i] = rest.sqrt();
            } else {
                matrix[i * n + j] = rest / matrix[j * n + j];
            }
        }
    }
    for i in 0..n {
        let mut value = right[i];
        for j in 0..i {
            value = value - right[j] * matrix[i * n + j];
        }
        right[i] = value * (1.0 / matrix[i * n + i]);
    }
    for i in (0..n).rev() {
        let mut value = right[i];
        for j in i + 1..n {
            value = value - right[j] * matrix[j * n + i];
        }
        right[i] = value * (1.0 / matrix[i * n + i]);
    }
    Some(())
}

/// Returns the rotation that brings `from` nearest to `to` (both relative to their centres), weights 1.
///
/// Never a reflection; the identity for fewer than two pairs. Horn (1987), the eigenvector of the largest eigenvalue of
/// the 4 x 4 matrix of his equation for unit quaternions.
pub fn best_rotation(pairs: impl Iterator<Item = (DVec3, DVec3)>) -> DQuat {
    let mut m = DMat3::ZERO;
    for (a, b) in pairs {
        m += DMat3::from_cols(a * b.x, a * b.y, a * b.z);
    }
    // m.col(j)[i] = sum a_i b_j
    let s = |i: usize, j: usize| m.col(j)[i];
    // Symmetric: rows are columns.
    let n = [
        [s(0, 0) + s(1, 1) + s(2, 2), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0)],
        [s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2)],
        [s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), s(1, 1) - s(0, 0) - s(2, 2), s(1, 2) + s(2, 1)],
        [s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), s(2, 2) - s(0, 0) - s(1, 1)],
    ];
    let eigen = SymmetricEigen::new(Matrix4::from(n));
    let largest = eigen.eigenvalues.imax();
    let [w, x, y, z] = eigen.eigenvectors.column(largest).into_owned().into();
    let q = DQuat::from_xyzw(x, y, z, w);
    let length = q.length();
    if length > 0.0 && length.is_finite() { q * (1.0 / length) } else { DQuat::IDENTITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spd_solution_satisfies_its_equations() {
        let n = 7;
        let m: Vec<f64> = (0..n * n).map(|i| (i * 37 % 11) as f64 * 0.3 - 1.0).collect();
        let mut a = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                a[i * n + j] = (0..n).map(|k| m[i * n + k] * m[j * n + k]).sum::<f64>() + f64::from(i == j);
            }
        }
        let keep = a.clone();
        let want: Vec<DVec3> = (0..n).map(|i| DVec3::new(i as f64, 1.0, -(i as f64) * 0.5)).collect();
        let mut b: Vec<DVec3> =
            (0..n).map(|i| (0..n).map(|j| want[j] * keep[i * n + j]).sum::<DVec3>()).collect();
        assert!(solve_positive(&mut a, &mut b).is_some(), "it is positive definite");
        for (got, want) in b.iter().zip(&want) {
            assert!((*got - *want).length() < 1e-9, "{got} {want}");
        }
        assert!(solve_positive(&mut [0.0], &mut [DVec3::ONE]).is_none(), "singular");
    }

    #[test]
    fn best_rotation_recovers_a_turn() {
        let q = base::turn::about(DVec3::new(1.0, 2.0, -1.0).normalize(), 2.3);
        let points = [DVec3::X, DVec3::Y * 2.0, DVec3::new(0.3, -1.0, 0.7)];
        let r = best_rotation(points.iter().map(|&p| (p, q * p)));
        assert!(points.iter().all(|&p| (r * p - q * p).length() < 1e-12), "{r:?}");
    }
}
