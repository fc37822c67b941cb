//! Examples drawn by weight, and gradient descent (Kingma and Ba 2015), with a decay of every coefficient towards 0
//! (Loshchilov and Hutter 2019).

use base::{Stream, ops};

/// Draws examples in proportion to their weights.
pub(crate) struct ByWeight {
    /// Sum of the weights of each example and those before it.
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

    /// Draws the index of an example; `None` if there are none.
    pub(crate) fn draw(&self, r: &mut Stream) -> Option<usize> {
        let drawn = r.uniform() * self.sums.last()?;
        Some(self.sums.partition_point(|&s| s < drawn).min(self.sums.len() - 1))
    }
}

/// A coefficient: steps are computed in double precision.
pub(crate) trait Coefficient: Copy {
    fn wide(self) -> f64;
    fn from_f64(wide: f64) -> Self;
}

impl Coefficient for f64 {
    fn wide(self) -> f64 {
        self
    }
    fn from_f64(wide: f64) -> Self {
        wide
    }
}

impl Coefficient for f32 {
    fn wide(self) -> f64 {
        f64::from(self)
    }
    #[expect(clippy::cast_possible_truncation, reason = "a coefficient is small")]
    fn from_f64(wide: f64) -> Self {
        wide as Self
    }
}

/// Means of gradients and of their squares.
pub(crate) struct Moments {
    slope: Vec<f64>,
    square: Vec<f64>,
}

impl Moments {
    pub(crate) fn new(n: usize) -> Self {
        Self { slope: vec![0.0; n], square: vec![0.0; n] }
    }

    /// Makes a step with its number, from 1; `pull`: the decay, a share of the step.
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
            *c = T::from_f64(
                own - rate * ((*mean / seen[0]) / ((*square / seen[1]).sqrt() + 1e-8) + pull * own),
            );
        }
    }
}

/// Returns the length of a step: half a cosine from `first` down to 0.
pub(crate) fn rate(first: f64, step: usize, steps: usize) -> f64 {
    first * 0.5 * (1.0 + ops::cos(ops::PI * step as f64 / steps as f64))
}
