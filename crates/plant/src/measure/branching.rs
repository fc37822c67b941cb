//! Strahler's orders and the exponent of radii at forks.

use base::ops;
use serde::{Deserialize, Serialize};

use super::wood::internodes;
use crate::Plant;

/// Orders counted from the tips (Strahler 1957): a tip has order 1; below a confluence of two or more shoots of the
/// highest order k the order is k + 1.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Strahler {
    /// The highest order; 0 for a plant without shoots.
    pub order: u32,
    /// Streams of each order, from order 1: unbroken runs of internodes of that order.
    pub streams: Vec<usize>,
    /// Bifurcation ratios: streams of order k over those of k + 1, from k = 1.
    pub ratios: Vec<f64>,
    /// Bifurcation ratio of the whole plant: 10 to the slope of log streams against order (Horton 1945), by least
    /// squares; `None` for fewer than two orders.
    pub bifurcation_ratio: Option<f64>,
}

pub(super) fn strahler(plant: &Plant, shoot: &[bool]) -> Strahler {
    // For each node, the highest order of the shoots above it, and the number of shoots with that order.
    let mut meets = vec![(0_u32, 0_u32); plant.nodes.position.len()];
    let join = |at: &mut (u32, u32), order: u32| {
        if order > at.0 {
            *at = (order, 1);
        } else if order == at.0 {
            at.1 += 1;
        }
    };
    let mut streams: Vec<usize> = Vec::new();
    // Bearers come first: going backwards, the orders of everything that a node bears are known.
    for (axis, _) in plant.axes.iter().zip(shoot).rev().filter(|(_, s)| **s) {
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        for node in rows.clone().rev() {
            let (highest, count) = meets[node];
            let order = if highest == 0 { 1 } else { highest + u32::from(count > 1) };
            if order > highest {
                let row = order as usize - 1;
                streams.resize(streams.len().max(row + 1), 0);
                streams[row] += 1;
            }
            if node > rows.start {
                join(&mut meets[node - 1], order);
            } else if let Some(b) = axis.bearer {
                join(&mut meets[b.index()], order);
            }
        }
    }
    let ratios = streams.windows(2).map(|w| w[0] as f64 / w[1] as f64).collect();
    let order = u32::try_from(streams.len()).unwrap_or(u32::MAX);
    Strahler { order, bifurcation_ratio: horton(&streams), streams, ratios }
}

/// Fits Horton's law of stream numbers, `log N_k = a - k log R`, and returns the ratio R.
fn horton(streams: &[usize]) -> Option<f64> {
    let n = streams.len() as f64;
    if streams.len() < 2 {
        return None;
    }
    let (mut sum, mut moment) = (0.0, 0.0);
    for (k, &count) in streams.iter().enumerate() {
        let x = k as f64 - (n - 1.0) / 2.0;
        sum += x * x;
        moment += x * ops::ln(count as f64);
    }
    Some(ops::exp(-moment / sum))
}

/// Fitted relation of the radii at forks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RadiusExponent {
    /// Exponent n: 2 preserves the cross-sectional area (Leonardo), 3 is Murray's law. Between 0.5 and 10.
    pub exponent: f64,
    /// Number of forks in the fit.
    pub forks: usize,
    /// Root mean square of `ln r - ln (sum r_i^n)^(1/n)`: the relative error of the radius below a fork.
    pub residual: f64,
}

/// One fork: the radius below, and the range of the radii above in one list.
struct Fork {
    below: f64,
    from: usize,
    to: usize,
}

/// Returns the exponent that predicts the radii below forks without bias in the mean of their logarithms.
///
/// A fork is a node from which two or more shoots continue. The radius of the continuing axis is that of its next node,
/// of a borne axis that of its first. `ln (sum r_i^n)^(1/n)` falls as n grows: there is exactly one such n, found by
/// bisection.
pub(super) fn radius_exponent(plant: &Plant, shoot: &[bool]) -> Option<RadiusExponent> {
    let mut above: Vec<(usize, f64)> = Vec::new();
    for (axis, _) in plant.axes.iter().zip(shoot).filter(|(_, s)| **s) {
        let skip = usize::from(axis.bearer.is_some());
        if let Some(b) = axis.bearer {
            above.push((b.index(), plant.nodes.radius_m[axis.nodes.start as usize]));
        }
        above.extend(internodes(axis).skip(skip).map(|(i, j)| (i, plant.nodes.radius_m[j])));
    }
    above.retain(|(_, r)| *r > 0.0);
    base::sort_by_key(&mut above, |(node, _)| *node);
    let mut forks = Vec::new();
    let mut from = 0;
    for group in above.chunk_by(|a, b| a.0 == b.0) {
        let below = plant.nodes.radius_m[group[0].0];
        if group.len() > 1 && below > 0.0 {
            forks.push(Fork { below, from, to: from + group.len() });
        }
        from += group.len();
    }
    if forks.is_empty() {
        return None;
    }
    let misfit = |fork: &Fork, n: f64| {
        // Relative to the radius below, so that powers of small radii do not underflow.
        let sum: f64 = above[fork.from..fork.to].iter().map(|(_, r)| ops::powf(r / fork.below, n)).sum();
        -ops::ln(sum) / n
    };
    let mean = |n: f64| forks.iter().map(|f| misfit(f, n)).sum::<f64>() / forks.len() as f64;
    let (mut low, mut high) = (0.5, 10.0);
    // 40 halvings of 9.5: 1e-11. The ends stand for forks that no exponent fits.
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if mean(middle) < 0.0 { low = middle } else { high = middle }
    }
    let exponent = 0.5 * (low + high);
    let squares = forks.iter().map(|f| misfit(f, exponent)).map(|m| m * m).sum::<f64>();
    Some(RadiusExponent { exponent, forks: forks.len(), residual: (squares / forks.len() as f64).sqrt() })
}
