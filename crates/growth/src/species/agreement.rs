//! Tests whether the traits of two samples of trees may come from one distribution.

use base::ops;

use super::Traits;
use super::traits::Trait;

/// One trait of one order in two samples of trees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// The order, 0 for trunks.
    pub order: usize,
    /// The trait.
    pub which: Trait,
    /// Number of values in each sample.
    pub counts: [usize; 2],
    /// Their medians.
    pub medians: [f64; 2],
    /// The greatest distance between the two distributions, 0 to 1.
    pub distance: f64,
    /// Probability of at least this distance, if all values were drawn independently from one distribution.
    pub p: f64,
}

/// Compares two samples by the test of Kolmogorov and Smirnov, trait by trait up to an order.
///
/// Not guaranteed: that p is valid if the axes of a tree resemble one another, as they do; it is then too small.
pub fn agree(first: &Traits, second: &Traits, orders: usize) -> Vec<Agreement> {
    let mut out = Vec::new();
    for (order, (a, b)) in first.orders.iter().zip(&second.orders).enumerate().take(orders) {
        for which in Trait::ALL.into_iter().filter(|t| t.is_of(order)) {
            let [x, y] = [a, b].map(|t| {
                let mut values = t.values(which).to_vec();
                base::sort_numbers(&mut values);
                values
            });
            if x.is_empty() || y.is_empty() {
                continue;
            }
            let distance = distance(&x, &y);
            let (n, m) = (x.len() as f64, y.len() as f64);
            out.push(Agreement {
                order,
                which,
                counts: [x.len(), y.len()],
                medians: [super::quantile_of(&x, 0.5), super::quantile_of(&y, 0.5)],
                distance,
                p: tail(distance, n * m / (n + m)),
            });
        }
    }
    out
}

/// Difference relative to the mean below which values count as equal: rules have five digits, and an axis continues
/// slightly beyond a fork.
const ONE_VALUE: f64 = 2e-3;

/// Returns the greatest distance between the distributions of sorted values.
fn distance(x: &[f64], y: &[f64]) -> f64 {
    let (mut i, mut j, mut most) = (0, 0, 0.0_f64);
    let near = ONE_VALUE * (x.iter().sum::<f64>() / x.len() as f64).abs();
    while i < x.len() && j < y.len() {
        let at = x[i].min(y[j]);
        let within = at + near;
        i += x[i..].iter().take_while(|v| **v <= within).count();
        j += y[j..].iter().take_while(|v| **v <= within).count();
        most = most.max((i as f64 / x.len() as f64 - j as f64 / y.len() as f64).abs());
    }
    most
}

/// Returns the tail of Kolmogorov's distribution, with the correction for few values (Stephens 1970).
fn tail(distance: f64, n: f64) -> f64 {
    let root = n.sqrt();
    let t = distance * (root + 0.12 + 0.11 / root);
    if t < 0.2 {
        return 1.0;
    }
    let term = |k: i32| {
        let sign = if k % 2 == 1 { 2.0 } else { -2.0 };
        sign * ops::exp(-2.0 * f64::from(k * k) * t * t)
    };
    (1..=100).map(term).sum::<f64>().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_test_of_kolmogorov_and_smirnov_is_that_of_tables() {
        // The 5 % point is 1.358, the 1 % point 1.628 (Smirnov 1948).
        assert!((tail(1.358 / 1e3, 1e6) - 0.05).abs() < 1e-3 && (tail(1.628 / 1e3, 1e6) - 0.01).abs() < 3e-4);
        assert!((distance(&[1.0, 2.0, 3.0, 4.0], &[3.0, 4.0, 5.0, 6.0]) - 0.5).abs() < 1e-12);
        assert!(distance(&[1.0, 1.0, 2.0], &[1.0, 1.0, 2.0]) < 1e-12);
        assert!(
            (distance(&[0.5, 0.5, 1.0], &[0.500_02, 1.0, 1.0]) - 1.0 / 3.0).abs() < 1e-12,
            "rounding is none"
        );
    }
}
