//! Training of a small network: a softmax over a linear function of the numbers, and over some units that are linear in
//! them where they are above 0.
//!
//! Two networks that begin with different coefficients err in different drawings, so several are trained and their sums
//! averaged. Sums are linear in units: the mean of networks is one network with the units of all.
//!
//! [Adam](crate::adam) on batches drawn by weight, with dropout (Srivastava et al. 2014) of numbers and units. The same
//! rows give the same network.

use base::{Draw, Seed, Stream, ops};

use crate::adam::{self, ByWeight, Moments};

/// Number of networks that are averaged.
const NETWORKS: usize = 3;
/// Number of units of each network.
const OWN_UNITS: usize = 48;
/// Number of units of the mean.
pub(super) const UNITS: usize = NETWORKS * OWN_UNITS;
/// Number of times that each row is used, on the average.
const ROUNDS: usize = 40;
/// Number of rows in each step.
const BATCH: usize = 256;
/// Length of the first step; later ones are shorter, along half a cosine.
const RATE: f64 = 2e-3;
/// Decay of coefficients towards 0, a share of the step.
const PULL: f64 = 0.01;
/// Share of numbers that is dropped in each look.
const DROP_NUMBERS: f64 = 0.2;
/// Share of units that is dropped in each look.
const DROP_UNITS: f64 = 0.3;
/// Noise on numbers whose standard deviation is 1.
const NOISE: f64 = 0.4;

/// Coefficients, row by row.
pub(super) struct Network {
    columns: usize,
    units: usize,
    /// A row for each number: a coefficient for each column.
    pub(super) direct: Vec<f64>,
    /// A row for each number: a coefficient for each unit.
    pub(super) inner: Vec<f64>,
    /// A row for each unit: a coefficient for each column.
    pub(super) outer: Vec<f64>,
}

/// One example: its numbers, its column, its weight.
pub(super) type Example<'a> = (&'a [f64], usize, f64);

impl Network {
    /// Trains the mean of [`NETWORKS`] networks on two threads.
    pub(super) fn learn(examples: &[Example<'_>], columns: usize) -> Self {
        const HANDS: usize = 2;
        let mut all: Vec<(usize, Self)> = std::thread::scope(|scope| {
            let own = |hand| (0..NETWORKS).filter(move |k| k % HANDS == hand);
            let learn =
                move |hand| own(hand).map(|k| (k, Self::one(examples, columns, k))).collect::<Vec<_>>();
            let hands: Vec<_> = (0..HANDS).map(|hand| scope.spawn(move || learn(hand))).collect();
            hands
                .into_iter()
                .flat_map(|h| h.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
                .collect()
        });
        all.sort_by_key(|(k, _)| *k);
        Self::mean(&all.into_iter().map(|(_, net)| net).collect::<Vec<_>>())
    }

    /// Returns one network whose sums are the means of the sums of several of equal form.
    fn mean(nets: &[Self]) -> Self {
        let part = 1.0 / nets.len() as f64;
        let (columns, units) = (nets[0].columns, nets[0].units);
        let numbers = nets[0].direct.len() / columns;
        let sum = |i: usize| nets.iter().map(|n| n.direct[i]).sum::<f64>() * part;
        let inner = |i: usize| nets.iter().flat_map(move |n| &n.inner[i * units..(i + 1) * units]).copied();
        Self {
            columns,
            units: units * nets.len(),
            direct: (0..numbers * columns).map(sum).collect(),
            inner: (0..numbers).flat_map(inner).collect(),
            outer: nets.iter().flat_map(|n| n.outer.iter().map(|c| c * part)).collect(),
        }
    }

    fn one(examples: &[Example<'_>], columns: usize, number: usize) -> Self {
        const UNITS: usize = OWN_UNITS;
        let numbers = examples.first().map_or(0, |e| e.0.len());
        let r = &mut Seed::new(20).child(number as u64).stream(Draw::Template);
        let mut chance =
            |n: usize, spread: f64| -> Vec<f64> { (0..n).map(|_| r.normal() * spread).collect() };
        let mut net = Self {
            columns,
            units: UNITS,
            direct: vec![0.0; numbers * columns],
            inner: chance(numbers * UNITS, 1.0 / (numbers.max(1) as f64).sqrt()),
            outer: chance(UNITS * columns, 1.0 / (UNITS as f64).sqrt()),
        };
        let drawn = ByWeight::new(examples.iter().map(|e| e.2));
        let steps = ROUNDS * examples.len() / BATCH;
        let mut moments = [&net.direct, &net.inner, &net.outer].map(|c| Moments::new(c.len()));
        for step in 0..steps {
            let mut slope = Self::from_weights(
                (columns, UNITS),
                [&net.direct, &net.inner, &net.outer].map(|c| vec![0.0; c.len()]),
            );
            for _ in 0..BATCH {
                if let Some(at) = drawn.draw(r) {
                    net.look(examples[at], r, &mut slope);
                }
            }
            let rate = adam::rate(RATE, step, steps);
            let slopes = [&slope.direct, &slope.inner, &slope.outer];
            let own = [&mut net.direct, &mut net.inner, &mut net.outer];
            for ((own, slope), moments) in own.into_iter().zip(slopes).zip(&mut moments) {
                moments.step(own, slope, step + 1, rate, PULL);
            }
        }
        net
    }

    fn from_weights((columns, units): (usize, usize), [direct, inner, outer]: [Vec<f64>; 3]) -> Self {
        Self { columns, units, direct, inner, outer }
    }

    /// Adds the gradient of one example.
    fn look(&self, (numbers, column, _): Example<'_>, r: &mut Stream, slope: &mut Self) {
        let keep = |r: &mut Stream, drop: f64| if r.chance(drop) { 0.0 } else { 1.0 / (1.0 - drop) };
        let x: Vec<f64> = numbers.iter().map(|x| (x + NOISE * r.normal()) * keep(r, DROP_NUMBERS)).collect();
        let mask: Vec<f64> = (0..OWN_UNITS).map(|_| keep(r, DROP_UNITS)).collect();
        let units = self.units(&x);
        let heard: Vec<f64> = units.iter().zip(&mask).map(|(u, m)| u.max(0.0) * m).collect();
        let mut miss = self.shares(&x, &heard);
        miss[column] -= 1.0;
        let part = 1.0 / BATCH as f64;
        let mut back = [0.0; OWN_UNITS];
        for (k, back) in back.iter_mut().enumerate() {
            let rows = k * self.columns..(k + 1) * self.columns;
            let own = self.outer[rows.clone()].iter().zip(&mut slope.outer[rows]);
            for ((c, s), m) in own.zip(&miss) {
                *back += c * m;
                *s += heard[k] * m * part;
            }
            *back *= if units[k] > 0.0 { mask[k] } else { 0.0 };
        }
        for (i, &x) in x.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            let direct = &mut slope.direct[i * self.columns..(i + 1) * self.columns];
            direct.iter_mut().zip(&miss).for_each(|(s, m)| *s += x * m * part);
            let inner = &mut slope.inner[i * OWN_UNITS..(i + 1) * OWN_UNITS];
            inner.iter_mut().zip(&back).for_each(|(s, b)| *s += x * b * part);
        }
    }

    fn units(&self, x: &[f64]) -> Vec<f64> {
        let mut units = vec![0.0; self.units];
        for (x, row) in x.iter().zip(self.inner.chunks(self.units)).filter(|(x, _)| **x != 0.0) {
            units.iter_mut().zip(row).for_each(|(u, c)| *u += x * c);
        }
        units
    }

    fn shares(&self, x: &[f64], heard: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.columns];
        let rows = self.direct.chunks(self.columns).zip(x).chain(self.outer.chunks(self.columns).zip(heard));
        for (row, x) in rows {
            sums.iter_mut().zip(row).for_each(|(s, c)| *s += x * c);
        }
        let most = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let powers: Vec<f64> = sums.iter().map(|s| ops::exp(s - most)).collect();
        let total: f64 = powers.iter().sum();
        powers.into_iter().map(|p| p / total).collect()
    }

    /// Returns the output of the network for a row of numbers.
    pub(super) fn evaluate(&self, x: &[f64]) -> Vec<f64> {
        let heard: Vec<f64> = self.units(x).into_iter().map(|u| u.max(0.0)).collect();
        self.shares(x, &heard)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_networks_says_what_they_say_on_the_average() {
        let r = &mut Seed::new(3).stream(Draw::Template);
        let rows: Vec<Vec<f64>> = (0..90).map(|_| (0..6).map(|_| r.normal()).collect()).collect();
        let examples: Vec<Example<'_>> =
            rows.iter().enumerate().map(|(k, row)| (&**row, k % 3, 1.0)).collect();
        let nets: Vec<Network> = (0..3).map(|k| Network::one(&examples, 3, k)).collect();
        let mean = Network::mean(&nets);
        for row in &rows {
            let apart = |net: &Network, k: usize| {
                let told = net.evaluate(row);
                ops::ln(told[k] / told[0])
            };
            for k in 1..3 {
                let wanted = nets.iter().map(|n| apart(n, k)).sum::<f64>() / 3.0;
                assert!((apart(&mean, k) - wanted).abs() < 1e-9, "{wanted}");
                assert!((apart(&nets[0], k) - apart(&nets[1], k)).abs() > 1e-6, "they are not the same");
            }
        }
    }
}
