//! Examples drawn by weight, and steps down a slope (Kingma and Ba 2015), with a pull of every coefficient towards 0 (Loshchilov and Hutter 2019).

use base::{Stream, ops};

/// Draws examples as often as they count.
pub(crate) struct ByWeight {
    /// Of each example and those before it.
    sums: Vec<f64>,
}

impl ByWeight {
    pub(crate) fn new(weights: impl Iterator<Item = f64>) -> Self {
        let sum = |sum: &mut f64, weight: f64| {
            *sum += weight;
            Some(*sum)
        };
        Self { sums: weights.scan(0.0, sum).collect() }
    }

    /// The place of one; none where there are none.
    pub(crate) fn draw(&self, r: &mut Stream) -> Option<usize> {
        let drawn = r.uniform() * self.sums.last()?;
        Some(self.sums.partition_point(|&s| s < drawn).min(self.sums.len() - 1))
    }
}

/// A coefficient: steps are computed in double precision.
pub(crate) trait Coefficient: Copy {
    fn wide(self) -> f64;
    fn of(wide: f64) -> Self;
}

impl Coefficient for f64 {
    fn wide(self) -> f64 {
        self
    }
    fn of(wide: f64) -> Self {
        wide
    }
}

impl Coefficient for f32 {
    fn wide(self) -> f64 {
        f64::from(self)
    }
    #[expect(clippy::cast_possible_truncation, reason = "a coefficient is small")]
    fn of(wide: f64) -> Self {
        wide as Self
    }
}

/// Means of slopes and of their squares.
pub(crate) struct Moments {
    slope: Vec<f64>,
    square: Vec<f64>,
}

impl Moments {
    pub(crate) fn new(n: usize) -> Self {
        Self { slope: vec![0.0; n], square: vec![0.0; n] }
    }

    /// The step of a number, from 1; `pull`: a share of the step.
    pub(crate) fn step<T: Coefficient>(
        &mut self,
        own: &mut [T],
        slope: &[T],
        number: usize,
        rate: f64,
        pull: f64,
    ) {
        const MEMORY: [f64; 2] = [0.9, 0.999];
        let seen = MEMORY.map(|m| 1.0 - ops::powf(m, number as f64));
        let moments = self.slope.iter_mut().zip(&mut self.square);
        for ((c, s), (mean, square)) in own.iter_mut().zip(slope).zip(moments) {
            let s = s.wide();
            *mean = MEMORY[0] * *mean + (1.0 - MEMORY[0]) * s;
            *square = MEMORY[1] * *square + (1.0 - MEMORY[1]) * s * s;
            let own = c.wide();
            *c = T::of(own - rate * ((*mean / seen[0]) / ((*square / seen[1]).sqrt() + 1e-8) + pull * own));
        }
    }
}

/// The length of a step: half a cosine from `first` down to 0.
pub(crate) fn rate(first: f64, step: usize, steps: usize) -> f64 {
    first * 0.5 * (1.0 + ops::cos(ops::PI * step as f64 / steps as f64))
}
