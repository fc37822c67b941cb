//! Curves of control balls: tubes with a centre line and a radius, such as a vein.

use core::ops::{Add, Mul, Sub};

use glam::DVec3;

use super::fit::{chord_parameters, least_squares};
use super::{Basis, NaturalCubic, SplineError};
use crate::vector::Vector as _;

/// A point with a radius. Balls form a vector space: centres and radii add and scale alike.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ball {
    /// The centre.
    pub centre: DVec3,
    /// The radius; at least 0 if the ball is a measurement, any number if it is a difference or a control.
    pub radius: f64,
}

impl Ball {
    /// Creates a ball.
    pub const fn new(centre: DVec3, radius: f64) -> Self {
        Self { centre, radius }
    }
}

impl Add for Ball {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { centre: self.centre + other.centre, radius: self.radius + other.radius }
    }
}

impl Sub for Ball {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { centre: self.centre - other.centre, radius: self.radius - other.radius }
    }
}

impl Mul<f64> for Ball {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { centre: self.centre * factor, radius: self.radius * factor }
    }
}

/// A ball B-spline curve: a B-spline (or, with weights, rational) curve of balls.
///
/// Guaranteed: [`ball`](Self::ball) never has a negative radius (a cubic through small radii may dip below 0; it is
/// clamped to 0 there). Not guaranteed: that the tube does not intersect itself (see [`Tube`](super::Tube)).
///
/// Wang et al. (2011), section 2.1.1: `<P; r>(t) = sum N_i(t) <P_i; r_i>`.
///
/// ```
/// use geom::{Ball, BallBSpline};
/// use glam::DVec3;
/// let marks = [Ball::new(DVec3::ZERO, 2.0), Ball::new(DVec3::Y, 1.5), Ball::new(DVec3::Y * 2.0, 1.0)];
/// let vein = BallBSpline::interpolate(&marks)?;
/// let middle = vein.ball(0.5);
/// assert!(middle.centre.distance(DVec3::Y) < 1e-12 && (middle.radius - 1.5).abs() < 1e-12);
/// # Ok::<(), geom::SplineError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct BallBSpline {
    basis: Basis,
    controls: Vec<Ball>,
    weights: Option<Vec<f64>>,
}

/// A ball with its first and second derivative with respect to the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Jet {
    pub(super) ball: Ball,
    pub(super) first: Ball,
    pub(super) second: Ball,
}

impl BallBSpline {
    /// Makes a curve of given control balls; `weights`, if any, make it rational.
    ///
    /// # Errors
    /// [`SplineError::TooFew`] if there are not as many balls and weights as the basis has controls,
    /// [`SplineError::NotFinite`] for unusable numbers or weights that are not above 0.
    pub fn new(basis: Basis, controls: Vec<Ball>, weights: Option<Vec<f64>>) -> Result<Self, SplineError> {
        let needed = basis.controls();
        let given = weights.as_ref().map_or(controls.len(), |w| w.len().min(controls.len()));
        if given != needed || controls.len() != needed {
            return Err(SplineError::TooFew { needed, given });
        }
        if let Some(bad) = controls.iter().position(|c| !usable(c)) {
            return Err(SplineError::NotFinite(bad));
        }
        let bad = weights.iter().flatten().position(|w| !(*w > 0.0 && *w < 1e100));
        if let Some(bad) = bad {
            return Err(SplineError::NotFinite(bad));
        }
        Ok(Self { basis, controls, weights })
    }

    /// Makes the cubic curve with the marks as control balls: near them, smooth, with local control.
    ///
    /// The paper's approximating form; four neighbouring marks shape each piece. Fewer than 4 marks lower the
    /// degree.
    ///
    /// # Errors
    /// [`SplineError::TooFew`] for less than 2 marks, [`SplineError::NotFinite`], [`SplineError::NegativeRadius`].
    pub fn approximate(marks: &[Ball]) -> Result<Self, SplineError> {
        check(marks)?;
        Self::new(Basis::uniform(3, marks.len())?, marks.to_vec(), None)
    }

    /// Makes the cubic curve through all marks, by chord length, with natural ends.
    ///
    /// Marks nearer to the one before than 1e-9 of the whole length are merged with it. Two marks give a
    /// straight piece. Wang et al. (2011), section 2.1.2.
    ///
    /// # Errors
    /// [`SplineError::TooFew`] for less than 2 distinct marks, [`SplineError::NotFinite`],
    /// [`SplineError::NegativeRadius`].
    pub fn interpolate(marks: &[Ball]) -> Result<Self, SplineError> {
        check(marks)?;
        let length: f64 = marks.windows(2).map(|w| w[0].centre.distance(w[1].centre)).sum();
        let mut kept: Vec<Ball> = Vec::with_capacity(marks.len());
        for &mark in marks {
            if kept.last().is_none_or(|k| k.centre.distance(mark.centre) > 1e-9 * length) {
                kept.push(mark);
            }
        }
        let centres: Vec<DVec3> = kept.iter().map(|b| b.centre).collect();
        let parameters =
            chord_parameters(&centres).ok_or(SplineError::TooFew { needed: 2, given: kept.len() })?;
        Self::interpolate_at(&NaturalCubic::new(&parameters)?, &kept)
    }

    /// Makes the curve through marks at the parameters of `spline`, so that several curves share theirs.
    ///
    /// # Errors
    /// [`SplineError::Parameters`] if the numbers differ, [`SplineError::NotFinite`],
    /// [`SplineError::NegativeRadius`].
    pub fn interpolate_at(spline: &NaturalCubic, marks: &[Ball]) -> Result<Self, SplineError> {
        check(marks)?;
        Self::new(spline.basis().clone(), spline.controls(marks)?, None)
    }

    /// Makes the cubic least-squares curve with `controls` control balls along many marks; the ends are kept.
    ///
    /// # Errors
    /// [`SplineError::TooFew`] unless there are more distinct marks than controls (at least 2),
    /// [`SplineError::Parameters`] where the data leave a control undetermined, [`SplineError::NotFinite`],
    /// [`SplineError::NegativeRadius`].
    pub fn fit(marks: &[Ball], controls: usize) -> Result<Self, SplineError> {
        check(marks)?;
        let centres: Vec<DVec3> = marks.iter().map(|b| b.centre).collect();
        let parameters = chord_parameters(&centres).ok_or(SplineError::TooFew { needed: 2, given: 1 })?;
        let (basis, controls) = least_squares(&parameters, marks, 3, controls)?;
        Self::new(basis, controls, None)
    }

    /// Returns the basis: degree and knots.
    pub fn basis(&self) -> &Basis {
        &self.basis
    }

    /// Returns the control balls.
    pub fn controls(&self) -> &[Ball] {
        &self.controls
    }

    /// Returns the control balls for editing: the deformation of Wang et al. (2011), Fig 4.
    ///
    /// One ball affects the curve over `degree + 1` neighbouring spans only.
    pub fn controls_mut(&mut self) -> &mut [Ball] {
        &mut self.controls
    }

    /// Moves the centre of every control ball: the same curve elsewhere, if `place` is a rigid motion.
    #[must_use]
    pub fn moved(mut self, place: impl Fn(DVec3) -> DVec3) -> Self {
        self.controls.iter_mut().for_each(|b| b.centre = place(b.centre));
        self
    }

    /// Returns the weights of a rational curve.
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }

    /// Returns the first and the last parameter.
    pub fn domain(&self) -> (f64, f64) {
        self.basis.domain()
    }

    /// Returns the ball at `t`, clamped to the domain. The radius is at least 0.
    pub fn ball(&self, t: f64) -> Ball {
        let w = self.basis.weights(t);
        let ball = match &self.weights {
            None => w.sum(&self.controls, Ball::default()),
            Some(weights) => {
                let (mut sum, mut all) = (Ball::default(), 0.0);
                for (i, &v) in w.values().iter().enumerate() {
                    let share = v * weights[w.first + i];
                    sum = sum + self.controls[w.first + i] * share;
                    all += share;
                }
                sum * (1.0 / all)
            }
        };
        Ball { radius: ball.radius.max(0.0), ..ball }
    }

    /// Returns the derivative of centre and radius at `t`; 0 for the radius where it is clamped to 0.
    pub fn derivative(&self, t: f64) -> Ball {
        self.jet(t).first
    }

    pub(super) fn jet(&self, t: f64) -> Jet {
        let bases = [self.basis.weights(t), self.basis.derivative(t), self.basis.second_derivative(t)];
        let mut sums = [Ball::default(); 3];
        let mut all = [0.0; 3];
        for (k, w) in bases.iter().enumerate() {
            for (i, &v) in w.values().iter().enumerate() {
                let share = v * self.weights.as_ref().map_or(1.0, |x| x[w.first + i]);
                sums[k] = sums[k] + self.controls[w.first + i] * share;
                all[k] += share;
            }
        }
        let [mut ball, mut first, mut second] = sums;
        if self.weights.is_some() {
            // Quotient rule (NURBS Book, Eq 4.8).
            let part = 1.0 / all[0];
            ball = ball * part;
            first = (first - ball * all[1]) * part;
            second = (second - first * (2.0 * all[1]) - ball * all[2]) * part;
        }
        if ball.radius < 0.0 {
            ball.radius = 0.0;
            first.radius = 0.0;
            second.radius = 0.0;
        }
        Jet { ball, first, second }
    }

    /// Returns the curve with `distance` added to every control radius: its surface lies farther out by that distance.
    ///
    /// Exact for the envelope where no radius falls to 0. A negative distance shrinks the tube.
    #[must_use]
    pub fn offset(&self, distance: f64) -> Self {
        let grown = |b: &Ball| Ball { radius: b.radius + distance, ..*b };
        Self { controls: self.controls.iter().map(grown).collect(), ..self.clone() }
    }

    /// Returns the length of the centre line, by chords of `steps` even parameters. The error falls with steps squared.
    pub fn length(&self, steps: usize) -> f64 {
        let (a, b) = self.domain();
        let steps = steps.clamp(1, 1 << 20);
        let at = |k: usize| self.ball(a + (b - a) * k as f64 / steps as f64).centre;
        (0..steps).map(|k| at(k).distance(at(k + 1))).sum()
    }
}

fn usable(b: &Ball) -> bool {
    b.centre.usable() && b.radius.abs() < 1e100
}

/// Checks that marks are numbers with radii of at least 0.
fn check(marks: &[Ball]) -> Result<(), SplineError> {
    if let Some(bad) = marks.iter().position(|m| !usable(m)) {
        return Err(SplineError::NotFinite(bad));
    }
    match marks.iter().position(|m| m.radius < 0.0) {
        Some(bad) => Err(SplineError::NegativeRadius(bad)),
        None => Ok(()),
    }
}
