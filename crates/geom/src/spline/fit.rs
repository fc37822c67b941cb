//! Fits controls to points: interpolation with natural ends, least squares.

use glam::DVec3;

use super::{Basis, SplineError};
use crate::linear::{Blend, solve_positive};

/// Returns the parameters that split each span between `marks` into `steps` equal parts (at least 1).
///
/// ```
/// assert_eq!(geom::subdivided(&[0.0, 1.0, 3.0], 2), [0.0, 0.5, 1.0, 2.0, 3.0]);
/// ```
pub fn subdivided(marks: &[f64], steps: usize) -> Vec<f64> {
    let steps = steps.max(1);
    let mut out = Vec::with_capacity(marks.len() * steps);
    for w in marks.windows(2) {
        out.extend((0..steps).map(|k| base::ops::lerp(w[0], w[1], k as f64 / steps as f64)));
    }
    out.extend(marks.last());
    out
}

/// Returns the parameters of points by the length of the chords between them, from 0 to 1.
///
/// Repeated points get equal parameters: merge them first if increasing ones are needed. `None` if all points coincide,
/// or for fewer than two.
pub fn chord_parameters(points: &[DVec3]) -> Option<Vec<f64>> {
    let mut sum = 0.0;
    let mut out = vec![0.0];
    for w in points.windows(2) {
        sum += w[0].distance(w[1]);
        out.push(sum);
    }
    if points.len() < 2 || !(sum > 0.0 && sum < 1e100) {
        return None;
    }
    for t in &mut out {
        *t /= sum;
    }
    Some(out)
}

/// The system of the cubic spline through points at given parameters with natural ends (C'' = 0).
///
/// Factored once, it is solved for any number of sets of values at those parameters in linear time.
///
/// Wang et al. (2011), section 2.1.2: end knots fourfold, an inner knot at each inner parameter, `n + 2` controls for
/// `n` points; the first and last control are the first and last point.
///
/// ```
/// let spline = geom::NaturalCubic::new(&[0.0, 0.5, 1.0])?;
/// // Three points on a line in even steps: the controls lie on it too.
/// let controls = spline.controls(&[0.0, 1.0, 2.0])?;
/// assert!((controls[2] - 1.0).abs() < 1e-15 && controls.len() == 5);
/// # Ok::<(), geom::SplineError>(())
/// ```
#[derive(Clone, Debug)]
pub struct NaturalCubic {
    basis: Basis,
    parameters: Vec<f64>,
    // Row k of the factored tridiagonal system for the controls 1 to n: lower factor, inverse pivot, upper.
    rows: Vec<[f64; 3]>,
    // Coefficients of the first and of the last point on the right-hand side.
    ends: [f64; 2],
}

impl NaturalCubic {
    /// Makes the system for points at `parameters`.
    ///
    /// # Errors
    /// [`SplineError::Parameters`] unless there are at least 2 and they increase.
    pub fn new(parameters: &[f64]) -> Result<Self, SplineError> {
        let basis = Basis::natural(parameters)?;
        let t = basis.knots();
        let m = t.len();
        let n = parameters.len();
        let mut rows = Vec::with_capacity(n);
        // C''(start) = 0: (P1 - P0) / d0 = (P2 - P1) / d1, and mirrored at the end.
        let (d0, d1) = (t[4] - t[1], t[5] - t[2]);
        let (e0, e1) = (t[m - 2] - t[m - 5], t[m - 3] - t[m - 6]);
        rows.push([0.0, 1.0 / d0 + 1.0 / d1, -1.0 / d1]);
        for &u in &parameters[1..n - 1] {
            let w = basis.weights(u);
            let v = w.values();
            rows.push([v[0], v[1], v[2]]);
        }
        rows.push([-1.0 / e1, 1.0 / e0 + 1.0 / e1, 0.0]);
        // Thomas: the collocation matrix is totally positive, so no pivoting is needed (de Boor 1978, ch. XIII).
        for k in 0..n {
            let lower = if k == 0 { 0.0 } else { rows[k][0] * rows[k - 1][1] };
            let pivot = rows[k][1] - if k == 0 { 0.0 } else { lower * rows[k - 1][2] };
            if !(pivot.abs() > 0.0 && pivot.is_finite()) {
                return Err(SplineError::Parameters);
            }
            rows[k][0] = lower;
            rows[k][1] = 1.0 / pivot;
        }
        Ok(Self { basis, parameters: parameters.to_vec(), rows, ends: [1.0 / d0, 1.0 / e0] })
    }

    /// Returns the basis of the spline.
    pub fn basis(&self) -> &Basis {
        &self.basis
    }

    /// Returns the parameters of the points.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Returns the controls of the spline through `values`, one value per parameter. Cost: linear.
    ///
    /// # Errors
    /// [`SplineError::Parameters`] if the numbers differ.
    pub fn controls<V: Blend>(&self, values: &[V]) -> Result<Vec<V>, SplineError> {
        let n = self.parameters.len();
        let (Some(&first), Some(&last), true) = (values.first(), values.last(), values.len() == n) else {
            return Err(SplineError::Parameters);
        };
        let mut out = Vec::with_capacity(n + 2);
        out.push(first);
        for (k, row) in self.rows.iter().enumerate() {
            let value = match k {
                0 => first * self.ends[0],
                _ if k + 1 == n => last * self.ends[1],
                _ => values[k],
            };
            out.push(if k == 0 { value } else { value - out[k] * row[0] });
        }
        out.push(last);
        for k in (0..n).rev() {
            let row = &self.rows[k];
            let value = if k + 1 == n { out[k + 1] } else { out[k + 1] - out[k + 2] * row[2] };
            out[k + 1] = value * row[1];
        }
        Ok(out)
    }
}

/// Returns the basis and controls of the least-squares curve with `controls` controls; the ends are kept.
///
/// Piegl and Tiller, The NURBS Book, section 9.4.1 (Eqs 9.65 to 9.69).
pub(super) fn least_squares<V: Blend>(
    parameters: &[f64],
    values: &[V],
    degree: usize,
    controls: usize,
) -> Result<(Basis, Vec<V>), SplineError> {
    let m = values.len();
    let degree = degree.min(controls.saturating_sub(1));
    if controls < 2 || m <= controls {
        return Err(SplineError::TooFew { needed: controls.max(2) + 1, given: m });
    }
    if parameters.len() != m || !parameters.windows(2).all(|w| w[0] <= w[1]) {
        return Err(SplineError::Parameters);
    }
    let (first, last) = (values[0], values[m - 1]);
    let (a, b) = (parameters[0], parameters[m - 1]);
    // Every inner span contains data: knots are distributed by the number of points (Eq 9.68).
    let step = m as f64 / (controls - degree) as f64;
    let inner = (1..controls - degree).map(|j| {
        let x = j as f64 * step;
        let i = crate::vector::to_index(x, m - 1).max(1);
        let part = x - i as f64;
        (1.0 - part) * parameters[i - 1] + part * parameters[i]
    });
    let ends = |x| core::iter::repeat_n(x, degree + 1);
    let basis = Basis::new(degree, ends(a).chain(inner).chain(ends(b)).collect())?;
    let unknown = controls - 2;
    let mut normal = vec![0.0; unknown * unknown];
    let mut right = vec![first * 0.0; unknown];
    for k in 1..m - 1 {
        let w = basis.weights(parameters[k]);
        let of = |i: usize| w.values().get(i.wrapping_sub(w.first)).copied().unwrap_or(0.0);
        let rest = values[k] - first * of(0) - last * of(controls - 1);
        let near = w.first.max(1)..(w.first + w.values().len()).min(controls - 1);
        for i in near.clone() {
            right[i - 1] = right[i - 1] + rest * of(i);
            for j in near.clone() {
                normal[(i - 1) * unknown + j - 1] += of(i) * of(j);
            }
        }
    }
    solve_positive(&mut normal, &mut right).ok_or(SplineError::Parameters)?;
    let mut all = Vec::with_capacity(controls);
    all.push(first);
    all.extend(right);
    all.push(last);
    Ok((basis, all))
}
