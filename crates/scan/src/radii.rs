//! Radii of axes: circles where there are points, the pipe model where there are few.
//!
//! Along an axis the logarithm of the radius is that of the pipe model plus an offset that drifts slowly. Circles are
//! measurements of it, each with an error; a smoother (Rauch, Tung and Striebel 1965) weighs both.

use base::{Cancelled, Draw, Run, Seed, map_indexed, ops};
use glam::{DVec2, DVec3};

use crate::circle::{Circle, fit_circle};
use crate::levels::Rings;
use crate::ways::Ways;

/// Most points of a cross-section that are used.
const MOST: usize = 400;
/// A circle with a greater error of the logarithm is useless.
const VAGUE: f64 = 0.5;
/// A circle with points on a smaller share of its circumference is useless.
const ARC: f64 = 0.3;
/// A circle with a greater share of the points inside is useless: leaves and twigs fill it.
const HOLLOW: f64 = 0.08;
/// Number of axes measured in one job.
const GROUP: usize = 32;

/// Measurement at a ring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measured {
    pub(crate) radius: f64,
    /// Standard error of the logarithm of the radius.
    pub(crate) error: f64,
    /// Centre of the circle.
    pub(crate) middle: DVec3,
    pub(crate) covered: f64,
}

/// Measures circles at all rings of all axes, `None` for rings without one.
pub(crate) fn measure(
    points: &[DVec3],
    ways: &Ways,
    rings: &Rings,
    axes: &[(u32, Vec<u32>)],
    noise: f64,
    run: &Run<'_>,
) -> Result<Vec<Vec<Option<Measured>>>, Cancelled> {
    let groups = axes.len().div_ceil(GROUP);
    let found = map_indexed(run.executor, groups, |g| {
        let part = &axes[g * GROUP..((g + 1) * GROUP).min(axes.len())];
        let measured = part.iter().map(|(_, own)| {
            run.cancel.check()?;
            Ok(along(points, ways, rings, own, noise))
        });
        measured.collect::<Result<Vec<_>, Cancelled>>()
    });
    let mut all = Vec::with_capacity(axes.len());
    for group in found {
        all.extend(group?);
    }
    Ok(all)
}

fn along(points: &[DVec3], ways: &Ways, rings: &Rings, run: &[u32], noise: f64) -> Vec<Option<Measured>> {
    let middle = |i: usize| rings.rings[run[i] as usize].middle;
    (0..run.len())
        .map(|i| {
            let ring = &rings.rings[run[i] as usize];
            // The direction is taken over a piece as long as it is thick.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few rings")]
            let reach = (1.5 * ring.spread / rings.band).ceil().clamp(1.0, 8.0) as usize + 1;
            let (a, b) = (i.saturating_sub(reach), (i + reach).min(run.len() - 1));
            let axis = (middle(b) - middle(a)).try_normalize()?;
            let own = i.saturating_sub(1)..=(i + 1).min(run.len() - 1);
            let rows = own.flat_map(|k| &rings.rings[run[k] as usize].cubes);
            let section: Vec<DVec3> = rows
                .flat_map(|&c| ways.voxels.rows(c as usize))
                .map(|&p| points[p as usize] - ring.middle)
                .filter(|d| d.dot(axis).abs() < 1.2 * rings.band)
                .collect();
            let (u, v) = axis.any_orthonormal_pair();
            let flat: Vec<DVec2> = section
                .iter()
                .step_by(section.len().div_ceil(MOST).max(1))
                .map(|d| DVec2::new(d.dot(u), d.dot(v)))
                .collect();
            let far = flat.iter().map(|p| p.length()).fold(0.0, f64::max);
            let mut stream = Seed::new(u64::from(run[i])).stream(Draw::Sampling);
            let circle = fit_circle(&flat, noise, 1.5 * far, &mut stream)?;
            // If the scatter of a ring's points does not match its circle, some are of another ring.
            let flat = 0.29 * rings.band;
            let wide = (ring.spread * ring.spread - flat * flat).max(0.0).sqrt().max(0.2 * ring.spread);
            let ratio = circle.radius / wide;
            let odd = if (0.6..1.6).contains(&ratio) { 0.0 } else { 0.3 * ops::ln(ratio).abs() };
            let error = error_of(&circle, noise) + odd;
            // A circle that is less certain than the model is mostly of twigs next to one another, and too wide.
            if error > VAGUE || circle.covered < ARC || circle.inside > HOLLOW {
                return None;
            }
            let middle = ring.middle + u * circle.centre.x + v * circle.centre.y;
            Some(Measured { radius: circle.radius, error, middle, covered: circle.covered })
        })
        .collect()
}

/// Returns the standard error of the logarithm of a circle's radius, from scatter, short arcs, and points elsewhere.
fn error_of(c: &Circle, noise: f64) -> f64 {
    let scatter = c.rms / (c.radius * (c.own as f64 / 3.0).sqrt());
    // A quarter arc gives the radius to a third, half a circle to a tenth.
    let arc = 0.8 * (1.0 - c.covered) * (1.0 - c.covered) * (1.0 - c.covered);
    // Beam width and noise blur thin branches.
    let blur = 0.5 * noise / c.radius;
    let others = 0.6 * (1.0 - c.share);
    let rough = 0.5 * c.rms / c.radius;
    (0.02 * 0.02 + scatter * scatter + arc * arc + blur * blur + others * others + rough * rough).sqrt()
}

/// The first fit of the pipe model uses loads down to the greatest one divided by this.
const OCTAVES: f64 = 16.0;

/// Least and greatest slope b of a fitted pipe model: exponents of 4 and 1.25.
const SLOPES: [f64; 2] = [0.25, 0.8];

/// Source of the exponent of the pipe model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PipeSource {
    /// Fitted to circles.
    Fitted,
    /// The fit ended on a bound, 1.25 or 4.
    OnBound,
    /// Too few circles are sound: the exponent is that of other trees.
    #[default]
    Default,
}

base::words!(PipeSource { Fitted = "fitted", OnBound = "bound", Default = "default" });

/// The pipe model as measured: `ln r = a + b ln load`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pipes {
    pub(crate) source: PipeSource,
    pub(crate) a: f64,
    pub(crate) b: f64,
    /// Scatter of circles about it.
    pub(crate) scatter: f64,
    /// Number of circles to which it was fitted.
    pub(crate) count: usize,
}

impl Pipes {
    /// Fits the model to loads (metres of wood above) and circles. It ignores wood that would be thinner than
    /// `least`, because circles there are of twigs next to one another. Also returns the least load that it used.
    pub(crate) fn fit(rows: &[(f64, Measured)], least: f64) -> (Self, f64) {
        let most = rows.iter().map(|r| r.0).fold(0.0, f64::max);
        let mut from = most / OCTAVES;
        let above = |from: f64| rows.iter().copied().filter(|r| r.0 >= from).collect::<Vec<_>>();
        let mut fit = Self::fit_all(&above(from));
        for _ in 0..4 {
            from = ops::exp((ops::ln(least.max(1e-6)) - fit.a) / fit.b).min(most / OCTAVES);
            fit = Self::fit_all(&above(from));
        }
        (fit, from)
    }

    /// Fits the model to all rows; each octave of loads has the same weight.
    fn fit_all(rows: &[(f64, Measured)]) -> Self {
        let sound: Vec<(f64, f64, f64)> = rows
            .iter()
            .filter(|(load, m)| *load > 0.0 && m.error < 0.25 && m.covered > 0.4)
            .map(|(load, m)| (ops::ln(*load), ops::ln(m.radius), m.error))
            .collect();
        // Without circles: the usual model of trees.
        let source = PipeSource::Default;
        let usual = Self { source, a: ops::ln(0.006), b: 0.42, scatter: 0.4, count: sound.len() };
        if sound.len() < 8 {
            let mut off: Vec<f64> = sound.iter().map(|(l, r, _)| r - usual.b * l).collect();
            base::sort_numbers(&mut off);
            return Self { a: off.get(off.len() / 2).copied().unwrap_or(usual.a), ..usual };
        }
        // Twigs outnumber limbs: each octave of loads has the same weight.
        let octave = |l: f64| {
            #[expect(clippy::cast_possible_truncation, reason = "few octaves")]
            let o = (l / ops::ln(2.0)).floor() as i64;
            o
        };
        let mut counts = base::LiteMap::<i64, f64>::new();
        sound.iter().for_each(|s| *counts.entry(octave(s.0)).or_default() += 1.0);
        let weight = |l: f64| {
            let n = counts.get(&octave(l)).copied().unwrap_or(1.0);
            1.0 / n.max(30.0).sqrt()
        };
        let mut fit = Self::start(&sound, &weight, usual);
        for _ in 0..20 {
            let width = 3.0 * fit.scatter;
            let mut sums = [0.0; 5];
            for &(l, r, e) in &sound {
                let off = (r - fit.a - fit.b * l) / width;
                let tukey = (1.0 - off * off).max(0.0);
                let w = tukey * tukey * weight(l) / (0.05 * 0.05 + e * e);
                [w, w * l, w * l * l, w * r, w * l * r].iter().zip(&mut sums).for_each(|(x, s)| *s += x);
            }
            let [w, l, ll, r, lr] = sums;
            let det = w * ll - l * l;
            let b = if det > 1e-9 * w * w { (w * lr - l * r) / det } else { fit.b };
            let source =
                if b > SLOPES[0] && b < SLOPES[1] { PipeSource::Fitted } else { PipeSource::OnBound };
            let b = b.clamp(SLOPES[0], SLOPES[1]);
            fit = Self { source, a: (r - b * l) / w.max(1e-300), b, ..fit };
            fit.scatter = fit.spread(&sound, &weight);
        }
        fit
    }

    /// Returns the line with the least scatter among many through two circles.
    fn start(sound: &[(f64, f64, f64)], weight: &dyn Fn(f64) -> f64, usual: Self) -> Self {
        let mut stream = Seed::new(sound.len() as u64).stream(Draw::Sampling);
        let few: Vec<(f64, f64, f64)> = sound.iter().copied().step_by(sound.len() / 2000 + 1).collect();
        let mut best = usual;
        best.scatter = f64::INFINITY;
        for _ in 0..300 {
            let [p, q] = [0; 2].map(|_: u8| few[stream.below(few.len())]);
            let b = (p.1 - q.1) / (p.0 - q.0);
            if (p.0 - q.0).abs() < 1.0 || !(SLOPES[0]..SLOPES[1]).contains(&b) {
                continue;
            }
            let line = Self { a: p.1 - b * p.0, b, ..usual };
            let scatter = line.spread(&few, weight);
            if scatter < best.scatter {
                best = Self { scatter, ..line };
            }
        }
        if best.scatter.is_finite() { best } else { usual }
    }

    /// Returns the scatter about the line: 1.48 weighted medians are a standard deviation.
    fn spread(&self, sound: &[(f64, f64, f64)], weight: &dyn Fn(f64) -> f64) -> f64 {
        let mut off: Vec<(f64, f64)> = sound
            .iter()
            .map(|&(l, r, e)| ((r - self.a - self.b * l).abs(), weight(l) / (0.05 * 0.05 + e * e)))
            .collect();
        base::sort_by(&mut off, |a, b| a.0.total_cmp(&b.0));
        let half = 0.5 * off.iter().map(|o| o.1).sum::<f64>();
        let mut sum = 0.0;
        let median = off.iter().find(|o| {
            sum += o.1;
            sum >= half
        });
        (1.48 * median.map_or(0.3, |m| m.0)).clamp(0.05, 0.6)
    }

    /// Returns the logarithm of the radius below `load` metres of wood.
    fn log_radius(&self, load: f64) -> f64 {
        self.a + self.b * ops::ln(load.max(1e-6))
    }
}

/// Radii along an axis.
pub(crate) struct Smoothed {
    pub(crate) radii: Vec<f64>,
    /// Offsets of their logarithms from the pipe model.
    pub(crate) offsets: Vec<f64>,
    /// Standard errors of the offsets.
    pub(crate) errors: Vec<f64>,
}

/// Computes the radii along one axis. `below`: the offset of its bearer from the pipe model.
pub(crate) fn smooth(
    loads: &[f64],
    measured: &[Option<Measured>],
    pipes: &Pipes,
    below: Option<f64>,
    step: f64,
) -> Smoothed {
    let n = loads.len();
    let start = pipes.scatter * pipes.scatter;
    let wander = step * step;
    let (mut mean, mut variance) = (vec![0.0; n], vec![0.0; n]);
    let (mut ahead, mut ahead_v) = (vec![0.0; n], vec![0.0; n]);
    let (mut x, mut v) = (0.5 * below.unwrap_or(0.0), start);
    for i in 0..n {
        if i > 0 {
            // The offset drifts: its variance grows from ring to ring.
            v += wander;
        }
        (ahead[i], ahead_v[i]) = (x, v);
        if let Some(m) = &measured[i] {
            let off = ops::ln(m.radius) - pipes.log_radius(loads[i]) - x;
            let mut e2 = m.error * m.error;
            // A circle beyond three standard errors is of something else, or beyond two if it is wider, because
            // neighbouring twigs widen circles.
            let far = off * off / (if off > 0.0 { 4.0 } else { 9.0 } * (e2 + v));
            if far > 1.0 {
                e2 *= far * far;
            }
            let gain = v / (v + e2);
            x += gain * off;
            v *= 1.0 - gain;
        }
        (mean[i], variance[i]) = (x, v);
    }
    for i in (0..n.saturating_sub(1)).rev() {
        let back = variance[i] / ahead_v[i + 1].max(1e-12);
        mean[i] += back * (mean[i + 1] - ahead[i + 1]);
        variance[i] += back * back * (variance[i + 1] - ahead_v[i + 1]);
    }
    let mut logs: Vec<f64> = (0..n).map(|i| pipes.log_radius(loads[i]) + mean[i]).collect();
    falling(&mut logs);
    let radii = logs.into_iter().map(ops::exp).collect();
    Smoothed { radii, offsets: mean, errors: variance.into_iter().map(|v| v.max(0.0).sqrt()).collect() }
}

/// Replaces the values by the nearest sequence that never rises (pool adjacent violators).
fn falling(values: &mut [f64]) {
    let mut blocks: Vec<(f64, usize)> = vec![];
    for &v in values.iter() {
        blocks.push((v, 1));
        while let [.., (a, n), (b, m)] = blocks[..]
            && b > a
        {
            blocks.truncate(blocks.len() - 2);
            blocks.push(((a * n as f64 + b * m as f64) / (n + m) as f64, n + m));
        }
    }
    let flat = blocks.into_iter().flat_map(|(v, n)| core::iter::repeat_n(v, n));
    values.iter_mut().zip(flat).for_each(|(to, v)| *to = v);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured_circle(radius: f64, error: f64) -> Measured {
        Measured { radius, error, middle: DVec3::ZERO, covered: 1.0 }
    }

    #[test]
    fn a_pipe_model_comes_back_from_its_circles() {
        let rows: Vec<(f64, Measured)> = (1..400)
            .map(|k| {
                let load = 0.05 * f64::from(k * k);
                let r = 0.01 * ops::powf(load, 0.45) * if k % 17 == 0 { 2.5 } else { 1.0 };
                (load, measured_circle(r, 0.05))
            })
            .collect();
        let (p, _) = Pipes::fit(&rows, 0.001);
        assert!((p.b - 0.45).abs() < 0.01 && (p.a - ops::ln(0.01)).abs() < 0.03, "{p:?}");
    }

    #[test]
    fn what_was_not_measured_follows_the_model_and_outliers_count_little() {
        let source = PipeSource::Fitted;
        let pipes = Pipes { source, a: ops::ln(0.01), b: 0.5, scatter: 0.2, count: 100 };
        let loads: Vec<f64> = (1..=20).rev().map(f64::from).collect();
        let mut measured: Vec<Option<Measured>> =
            loads.iter().map(|l| Some(measured_circle(1.2 * ops::exp(pipes.log_radius(*l)), 0.05))).collect();
        measured[4] = Some(measured_circle(1.0, 0.05));
        measured[10..].fill(None);
        let r = smooth(&loads, &measured, &pipes, None, 0.03).radii;
        for (r, l) in r.iter().zip(&loads).take(10) {
            assert!((r / ops::exp(pipes.log_radius(*l)) - 1.2).abs() < 0.06, "{r} {l}");
        }
        assert!(r.windows(2).all(|w| w[1] <= w[0] + 1e-12));
    }
}
