//! Small dense linear algebra: symmetric eigenvectors, Cholesky, the best rotation between two point sets.

use glam::{DMat3, DQuat, DVec3};

/// Eigenvalues and unit eigenvectors (columns of the returned rows) of a symmetric matrix, largest first.
///
/// Cyclic Jacobi: at most 50 sweeps, far more than the handful that 3 x 3 and 4 x 4 matrices need.
pub(crate) fn eigen<const N: usize>(mut a: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    let mut v = [[0.0; N]; N];
    for (i, row) in v.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for _ in 0..50 {
        let off: f64 = (0..N).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i][j] * a[i][j]).sum();
        let on: f64 = (0..N).map(|i| a[i][i] * a[i][i]).sum();
        if off <= 1e-32 * on || off <= 0.0 {
            break;
        }
        for p in 0..N {
            for q in p + 1..N {
                rotate(&mut a, &mut v, p, q);
            }
        }
    }
    let mut order: Vec<usize> = (0..N).collect();
    base::sort_by(&mut order, |&i, &j| a[j][j].total_cmp(&a[i][i]));
    let mut values = [0.0; N];
    let mut vectors = [[0.0; N]; N];
    for (to, &from) in order.iter().enumerate() {
        values[to] = a[from][from];
        for (k, row) in v.iter().enumerate() {
            vectors[to][k] = row[from];
        }
    }
    (values, vectors)
}

fn rotate<const N: usize>(a: &mut [[f64; N]; N], v: &mut [[f64; N]; N], p: usize, q: usize) {
    if a[p][q].abs() <= 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = if theta >= 0.0 { 1.0 } else { -1.0 } / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for row in a.iter_mut() {
        let (x, y) = (row[p], row[q]);
        row[p] = c * x - s * y;
        row[q] = s * x + c * y;
    }
    let (row_p, row_q) = (a[p], a[q]);
    a[p] = core::array::from_fn(|k| c * row_p[k] - s * row_q[k]);
    a[q] = core::array::from_fn(|k| s * row_p[k] + c * row_q[k]);
    for row in v.iter_mut() {
        let (x, y) = (row[p], row[q]);
        row[p] = c * x - s * y;
        row[q] = s * x + c * y;
    }
}

/// Solves `a x = b` for three right-hand sides, `a` symmetric positive definite of `n` rows (only its lower
/// half is read), both in place.
///
/// `None` if a pivot is not positive. Cost: n cubed over 6 (Cholesky).
pub(crate) fn solve_spd(a: &mut [f64], n: usize, b: &mut [DVec3]) -> Option<()> {
    for i in 0..n {
        let (above, rest) = a.split_at_mut(i * n);
        let row = &mut rest[..n];
        for j in 0..i {
            let other = &above[j * n..j * n + j + 1];
            let dot: f64 = row[..j].iter().zip(other).map(|(x, y)| x * y).sum();
            row[j] = (row[j] - dot) / other[j];
        }
        let dot: f64 = row[..i].iter().map(|x| x * x).sum();
        let pivot = row[i] - dot;
        let sound = pivot > 0.0 && pivot.is_finite();
        if !sound {
            return None;
        }
        row[i] = pivot.sqrt();
        let known: DVec3 = row[..i].iter().zip(&*b).map(|(&l, &x)| x * l).sum();
        b[i] = (b[i] - known) / row[i];
    }
    for i in (0..n).rev() {
        let x = b[i] / a[i * n + i];
        b[i] = x;
        for j in 0..i {
            b[j] -= x * a[i * n + j];
        }
    }
    Some(())
}

/// The rotation that brings `from` nearest to `to` (both relative to their centres), weights 1.
///
/// Horn 1987: the largest eigenvector of a 4 x 4 matrix. Never a reflection.
pub(crate) fn best_rotation(pairs: impl Iterator<Item = (DVec3, DVec3)>) -> DQuat {
    let mut m = DMat3::ZERO;
    for (a, b) in pairs {
        m += DMat3::from_cols(a * b.x, a * b.y, a * b.z);
    }
    // m.col(j)[i] = sum a_i b_j
    let s = |i: usize, j: usize| m.col(j)[i];
    let n = [
        [s(0, 0) + s(1, 1) + s(2, 2), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0)],
        [s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2)],
        [s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), s(1, 1) - s(0, 0) - s(2, 2), s(1, 2) + s(2, 1)],
        [s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), s(2, 2) - s(0, 0) - s(1, 1)],
    ];
    let (_, vectors) = eigen(n);
    let [w, x, y, z] = vectors[0];
    let q = DQuat::from_xyzw(x, y, z, w);
    let length = q.length();
    if length > 0.0 && length.is_finite() { q * (1.0 / length) } else { DQuat::IDENTITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvectors_of_a_known_matrix() {
        let (values, vectors) = eigen([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 5.0]]);
        assert!(values.iter().zip([5.0, 3.0, 1.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{values:?}");
        assert!((vectors[1][0].abs() - 0.5_f64.sqrt()).abs() < 1e-12, "{vectors:?}");
    }

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
        assert!(solve_spd(&mut a, n, &mut b).is_some(), "it is positive definite");
        for (got, want) in b.iter().zip(&want) {
            assert!((*got - *want).length() < 1e-9, "{got} {want}");
        }
        assert!(solve_spd(&mut [0.0], 1, &mut [DVec3::ONE]).is_none(), "singular");
    }

    #[test]
    fn best_rotation_recovers_a_turn() {
        let q = base::turn::about(DVec3::new(1.0, 2.0, -1.0).normalize(), 2.3);
        let points = [DVec3::X, DVec3::Y * 2.0, DVec3::new(0.3, -1.0, 0.7)];
        let r = best_rotation(points.iter().map(|&p| (p, q * p)));
        assert!(points.iter().all(|&p| (r * p - q * p).length() < 1e-12), "{r:?}");
    }
}
