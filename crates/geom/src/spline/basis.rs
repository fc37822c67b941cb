//! B-spline bases: the weights of the controls at a parameter.

use super::SplineError;

/// The highest degree: a Bezier surface through 64 rows of marks.
pub const MAX_DEGREE: usize = 63;

/// The B-spline basis functions of one degree over one knot vector.
///
/// Guaranteed: at every parameter of the domain the weights are at least 0 and sum to 1, and only
/// `degree + 1` neighbouring ones are above 0. Parameters outside the domain are clamped to it.
///
/// Wang et al. (2011), section 2.1.1; Piegl and Tiller, The NURBS Book, section 2.2.
///
/// ```
/// let basis = geom::Basis::bezier(3)?;
/// assert_eq!(basis.weights(0.5).values(), [0.25, 0.5, 0.25]);
/// # Ok::<(), geom::SplineError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    degree: usize,
    knots: Vec<f64>,
}

/// The weights of neighbouring controls at one parameter.
#[derive(Clone, Copy, Debug)]
pub struct Weights {
    /// Index of the first control with a weight.
    pub first: usize,
    count: usize,
    values: [f64; MAX_DEGREE + 1],
}

impl Weights {
    /// Returns the weights of the controls from [`first`](Self::first) on.
    pub fn values(&self) -> &[f64] {
        &self.values[..self.count]
    }

    /// Returns the weighted sum of the controls; `zero` is the empty sum.
    pub(super) fn sum<V>(&self, controls: &[V], zero: V) -> V
    where
        V: Copy + core::ops::Add<Output = V> + core::ops::Mul<f64, Output = V>,
    {
        let near = controls.iter().skip(self.first);
        self.values().iter().zip(near).fold(zero, |sum, (&w, &c)| sum + c * w)
    }
}

impl Basis {
    /// Makes a basis over given knots; `knots.len() - degree - 1` controls.
    ///
    /// # Errors
    /// [`SplineError::Degree`], [`SplineError::Knots`], [`SplineError::TooFew`].
    pub fn new(degree: usize, knots: Vec<f64>) -> Result<Self, SplineError> {
        if degree == 0 || degree > MAX_DEGREE {
            return Err(SplineError::Degree(degree));
        }
        let controls = knots.len().saturating_sub(degree + 1);
        if controls <= degree {
            return Err(SplineError::TooFew { needed: degree + 1, given: controls });
        }
        let ordered = knots.windows(2).all(|w| w[0] <= w[1]) && knots.iter().all(|k| k.abs() < 1e100);
        if !ordered || knots[degree] >= knots[controls] {
            return Err(SplineError::Knots);
        }
        Ok(Self { degree, knots })
    }

    /// Makes a clamped basis with evenly spaced inner knots over \[0, 1\]. The degree is lowered to `controls - 1` if
    /// needed.
    ///
    /// # Errors
    /// [`SplineError::TooFew`] for less than 2 controls, [`SplineError::Degree`].
    pub fn uniform(degree: usize, controls: usize) -> Result<Self, SplineError> {
        if controls < 2 {
            return Err(SplineError::TooFew { needed: 2, given: controls });
        }
        let degree = degree.min(controls - 1);
        let spans = (controls - degree) as f64;
        let inner = (1..controls - degree).map(|i| i as f64 / spans);
        let ends = |x| core::iter::repeat_n(x, degree + 1);
        Self::new(degree, ends(0.0).chain(inner).chain(ends(1.0)).collect())
    }

    /// Makes the Bernstein polynomials of degree `controls - 1` over \[0, 1\].
    ///
    /// # Errors
    /// [`SplineError::TooFew`] for less than 2 controls, [`SplineError::Degree`] for more than 64.
    pub fn bezier(controls: usize) -> Result<Self, SplineError> {
        Self::uniform(controls.saturating_sub(1).max(1), controls)
    }

    /// Makes the cubic basis of the natural spline: fourfold end knots, one inner knot at each inner parameter.
    ///
    /// Has `parameters.len() + 2` controls.
    ///
    /// # Errors
    /// [`SplineError::Parameters`] unless there are at least 2 and they increase.
    pub fn natural(parameters: &[f64]) -> Result<Self, SplineError> {
        let [first, inner @ .., last] = parameters else { return Err(SplineError::Parameters) };
        if !parameters.windows(2).all(|w| w[0] < w[1]) {
            return Err(SplineError::Parameters);
        }
        let ends = |x| core::iter::repeat_n(x, 4);
        Self::new(3, ends(*first).chain(inner.iter().copied()).chain(ends(*last)).collect())
    }

    /// Returns the degree, 1 to [`MAX_DEGREE`].
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Returns the knots, not decreasing.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Returns the number of controls, above the degree.
    pub fn controls(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    /// Returns the first and the last parameter.
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.degree], self.knots[self.controls()])
    }

    /// Returns the parameter of greatest influence of control `i` (its Greville abscissa); clamped to the last control.
    pub fn greville(&self, i: usize) -> f64 {
        let i = i.min(self.controls() - 1);
        let (a, b) = self.domain();
        // Clamped: the mean of equal knots need not round to that knot.
        (self.knots[i + 1..=i + self.degree].iter().sum::<f64>() / self.degree as f64).clamp(a, b)
    }

    /// Returns the weights of the controls at `t`. Cost: degree squared.
    pub fn weights(&self, t: f64) -> Weights {
        let span = self.span(t);
        self.functions_of_degree(self.degree, span, self.clamp(t))
    }

    /// Returns the derivatives of the weights at `t`; at an inner knot those of the span to its right.
    pub fn derivative(&self, t: f64) -> Weights {
        self.nth_derivative(t, 1)
    }

    /// Returns the second derivatives of the weights at `t`; 0 for degree 1.
    pub fn second_derivative(&self, t: f64) -> Weights {
        self.nth_derivative(t, 2)
    }

    fn clamp(&self, t: f64) -> f64 {
        let (a, b) = self.domain();
        // NaN becomes the start.
        t.max(a).min(b)
    }

    /// Returns the index k with `knots[k] <= t < knots[k + 1]`; at the end of the domain the last such index.
    fn span(&self, t: f64) -> usize {
        let n = self.controls();
        let t = self.clamp(t);
        if t >= self.knots[n] {
            // The last span that is not empty.
            return self.knots[..n].iter().rposition(|&k| k < self.knots[n]).unwrap_or(self.degree);
        }
        self.knots[..=n].partition_point(|&k| k <= t).saturating_sub(1).max(self.degree)
    }

    /// Returns the basis functions of degree `q`, at most the own degree (NURBS Book, A2.2).
    fn functions_of_degree(&self, q: usize, span: usize, t: f64) -> Weights {
        let mut values = [0.0; MAX_DEGREE + 1];
        values[0] = 1.0;
        for j in 1..=q {
            let mut saved = 0.0;
            for (r, value) in values.iter_mut().enumerate().take(j) {
                let right = self.knots[span + r + 1] - t;
                let left = t - self.knots[span + 1 + r - j];
                let share = *value / (right + left);
                *value = saved + right * share;
                saved = left * share;
            }
            values[j] = saved;
        }
        Weights { first: span - q, count: q + 1, values }
    }

    // N'(i, q) = q N(i, q-1) / (t[i+q] - t[i]) - q N(i+1, q-1) / (t[i+q+1] - t[i+1]), applied `order` times.
    fn nth_derivative(&self, t: f64, order: usize) -> Weights {
        let (p, span, t) = (self.degree, self.span(t), self.clamp(t));
        if order > p {
            return Weights { first: span - p, count: p + 1, values: [0.0; MAX_DEGREE + 1] };
        }
        let mut w = self.functions_of_degree(p - order, span, t);
        for q in p - order + 1..=p {
            let first = span - q;
            let mut values = [0.0; MAX_DEGREE + 1];
            for k in 0..q {
                let i = first + k; // the lower function k belongs to the index i + 1
                let width = self.knots[i + 1 + q] - self.knots[i + 1];
                let slope = w.values[k] * q as f64 / width;
                values[k] -= slope;
                values[k + 1] += slope;
            }
            w = Weights { first, count: q + 1, values };
        }
        w
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one_and_derivatives_to_zero() {
        for (degree, controls) in [(1, 2), (2, 7), (3, 4), (3, 13), (5, 9), (16, 17), (63, 64)] {
            let basis = Basis::uniform(degree, controls).unwrap();
            for k in 0..=40 {
                let t = f64::from(k) / 40.0;
                let sum = |w: Weights| w.values().iter().sum::<f64>();
                assert!((sum(basis.weights(t)) - 1.0).abs() < 1e-13, "{degree} {t}");
                assert!(basis.weights(t).values().iter().all(|&w| w >= 0.0), "{degree} {t}");
                let scale = (degree * degree * controls * controls) as f64;
                assert!(sum(basis.derivative(t)).abs() < 1e-12 * scale, "{degree} {t}");
                assert!(sum(basis.second_derivative(t)).abs() < 1e-10 * scale, "{degree} {t}");
            }
        }
    }

    #[test]
    fn basis_keeps_straight_lines() {
        // Controls at the Greville abscissae give the identity (linear precision).
        let basis = Basis::new(3, vec![0., 0., 0., 0., 0.2, 0.35, 0.35, 0.9, 1., 1., 1., 1.]).unwrap();
        let controls: Vec<f64> = (0..basis.controls()).map(|i| basis.greville(i)).collect();
        for t in [0.0, 0.1, 0.2, 0.35, 0.5, 0.9, 1.0] {
            assert!((basis.weights(t).sum(&controls, 0.0) - t).abs() < 1e-15, "{t}");
            assert!((basis.derivative(t).sum(&controls, 0.0) - 1.0).abs() < 1e-13, "{t}");
            assert!(basis.second_derivative(t).sum(&controls, 0.0).abs() < 1e-11, "{t}");
        }
    }

    #[test]
    fn bad_knots_are_refused() {
        assert_eq!(
            Basis::new(3, vec![0., 0., 0., 0., 1., 1., 1.]),
            Err(SplineError::TooFew { needed: 4, given: 3 })
        );
        assert_eq!(Basis::new(1, vec![0., 0., 0., 0.]), Err(SplineError::Knots));
        assert_eq!(Basis::new(1, vec![0., 1., 0.5, 1.]), Err(SplineError::Knots));
        assert_eq!(Basis::new(1, vec![0., f64::NAN, 1., 1.]), Err(SplineError::Knots));
        assert_eq!(Basis::new(0, vec![0., 1.]), Err(SplineError::Degree(0)));
        assert_eq!(Basis::bezier(65), Err(SplineError::Degree(64)));
        assert_eq!(Basis::natural(&[0.0]), Err(SplineError::Parameters));
        assert_eq!(Basis::natural(&[0.0, 0.0, 1.0]), Err(SplineError::Parameters));
    }
}
