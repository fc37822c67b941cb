//! Fits the logistic growth law to a series of days and values, with its standard errors (Huai, Yang and Cai 2019, eq
//! 6).

use base::ops;
use serde::{Deserialize, Serialize};

/// Parameters of `f(x) = offset + K / (1 + (K / p0 - 1) exp(-r x))`: `f(0) = offset + p0`.
///
/// `r > 0` tends to `offset + K`. Both decreasing and increasing series have this form: `p0 > K > 0` decays, `K < 0`
/// grows downwards. A series that changes its sign needs an `offset`.
///
/// ```
/// let law = bloom::Logistic { k: 10.0, p0: 1.0, r: 0.5, offset: 0.0 };
/// assert_eq!(law.value(0.0), 1.0);
/// assert!((law.value(60.0) - 10.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Logistic {
    /// K, the final state, in the unit of the series, without the offset.
    #[serde(rename = "K")]
    pub k: f64,
    /// The state at day 0, without the offset; of the same sign as K.
    pub p0: f64,
    /// Rate, per day.
    pub r: f64,
    /// A constant under the whole curve; 0 in the paper.
    #[serde(default)]
    pub offset: f64,
}

impl Logistic {
    /// Returns the value at `x` days; the offset alone for K = 0.
    pub fn value(&self, x: f64) -> f64 {
        if self.k.abs() <= 0.0 {
            return self.offset;
        }
        self.offset + self.k / (1.0 + (self.k / self.p0 - 1.0) * ops::exp(-self.r * x))
    }
}

/// Largest K/p0, and inverse of the smallest, in the search of a fit.
const MAX_RATIO: f64 = 1e4;
/// Largest product of the rate and the span of the days in the search of a fit.
const MAX_TURN: f64 = 60.0;

impl Logistic {
    /// Whether a fit over `span` days ended on a bound of K/p0 or of the rate: the series determines no logistic, and
    /// K, p0 and r mean nothing by themselves.
    pub fn on_bound(&self, span: f64) -> bool {
        let q = (self.k / self.p0).abs();
        // 0.99: the search ends before a bound that it would step over.
        q >= 0.99 * MAX_RATIO || q <= 1.0 / (0.99 * MAX_RATIO) || (self.r * span).abs() >= 0.99 * MAX_TURN
    }
}

/// Choice of the constant under the curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Offset {
    /// 0 unless the series changes its sign or touches 0; then a tenth of its range beyond its first value, so that
    /// growth starts near 0.
    #[default]
    Auto,
    /// Always 0, as in the paper. A series that changes its sign is refused.
    Zero,
}

/// A fitted law with its figures of merit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The law.
    pub law: Logistic,
    /// Standard errors of K, p0 and r; `None` without a degree of freedom (3 values), or if the series does not
    /// determine them.
    pub standard_errors: Option<[f64; 3]>,
    /// Coefficient of determination, 1 - SSE / SST; 1 for a constant series that is fitted exactly.
    pub r2: f64,
    /// R2 adjusted for the degrees of freedom, 1 - (1 - R2)(n - 1)/(n - 3); `None` for 3 values.
    pub r2_adjusted: Option<f64>,
    /// Root mean square error of each value predicted from the others; `None` below 4 values.
    pub loo_rmse: Option<f64>,
    /// Each value minus its prediction from the others; empty below 4 values.
    pub left_out: Vec<f64>,
    /// Sum of squared residuals.
    pub sse: f64,
    /// Steps of Levenberg and Marquardt, over all starts.
    pub steps: u32,
}

/// Reason why no logistic can be fitted to a series.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// There are fewer values than parameters.
    #[error(
        "{got} {} cannot determine the 3 parameters of a growth law; give at least 3 days",
        if *got == 1 { "stage" } else { "stages" }
    )]
    TooFew {
        /// Number of values.
        got: usize,
    },
    /// The columns differ in length.
    #[error("{days} days but {values} values; give one value a day")]
    Length {
        /// Number of days.
        days: usize,
        /// Number of values.
        values: usize,
    },
    /// A value is NaN or infinite.
    #[error("value {index} of the series is not a finite number")]
    NotFinite {
        /// Its index from 0.
        index: usize,
    },
    /// Two stages share one day, or are out of order.
    #[error("day {day} does not come after day {before}; sort the stages by day, one a day")]
    Order {
        /// The misplaced day.
        day: f64,
        /// The one before it.
        before: f64,
    },
    /// The sign changes and no offset is allowed.
    #[error("the series changes its sign, which a law without offset cannot; allow an offset")]
    Sign,
}

/// Fits K, p0 and r to values at days that increase strictly; at least 3.
///
/// Guaranteed: within K/p0 from 1e-4 to 1e4 and a rate of at most 60 per span a least-squares minimum to 1e-7 standard
/// errors, the lowest of those reached from nine rates of either sign; the best of each sign is followed. Not
/// guaranteed: that the series determines all three parameters (see the standard errors). Cost: about 8 microseconds
/// for 25 values with [`fit_law`], n times that here, as each value is left out once; for more than 100 values
/// `loo_rmse` follows from the leverage of each, in linear time.
///
/// # Errors
/// [`FitError`].
///
/// ```
/// let days = [0.0, 2.0, 4.0, 6.0, 8.0];
/// let values = days.map(|d| bloom::Logistic { k: 8.0, p0: 1.0, r: 0.7, offset: 0.0 }.value(d));
/// let fit = bloom::fit_logistic(&days, &values, bloom::Offset::Auto)?;
/// assert!((fit.law.k - 8.0).abs() < 1e-9 && fit.r2 > 0.999_999);
/// # Ok::<(), bloom::FitError>(())
/// ```
pub fn fit_logistic(days: &[f64], values: &[f64], offset: Offset) -> Result<Fit, FitError> {
    fit_logistic_while(days, values, offset, || Ok(()))
}

/// Most values of which each is left out in turn, with a refit of the rest. With more, one hardly moves the curve: the
/// effect by its leverage changes the reported error by less than three thousandths
/// (`long_series_are_left_out_by_leverage`).
const LEFT_OUT_IN_TURN: usize = 100;

/// As [`fit_logistic`], but checks before each left-out value whether the fit is still wanted.
pub(crate) fn fit_logistic_while<E: From<FitError>>(
    days: &[f64],
    values: &[f64],
    offset: Offset,
    mut is_wanted: impl FnMut() -> Result<(), E>,
) -> Result<Fit, E> {
    let mut fit = fit_law(days, values, offset)?;
    let n = days.len();
    if n > LEFT_OUT_IN_TURN {
        is_wanted()?;
        fit.left_out = left_out_by_leverage(days, values, &fit);
    } else if n >= 4 {
        let (mut d, mut v) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for out in 0..n {
            is_wanted()?;
            d.clear();
            v.clear();
            d.extend((0..n).filter(|&i| i != out).map(|i| days[i]));
            v.extend((0..n).filter(|&i| i != out).map(|i| values[i]));
            // The constant under the curve, too, is that of the others: a value does not influence its own prediction.
            let constant = constant_under(&v, offset).unwrap_or(fit.law.offset);
            v.iter_mut().for_each(|v| *v -= constant);
            fit.left_out.push(values[out] - constant - fit_core(&d, &v).law.value(days[out]));
        }
    }
    if n >= 4 {
        let sum: f64 = fit.left_out.iter().map(|e| e * e).sum();
        fit.loo_rmse = Some((sum / n as f64).sqrt());
    }
    Ok(fit)
}

/// Returns leave-one-out errors by the linearised least squares at the fit: each residual over the remaining share
/// after its leverage (Allen 1974).
fn left_out_by_leverage(days: &[f64], values: &[f64], fit: &Fit) -> Vec<f64> {
    let Logistic { k, p0, r, offset } = fit.law;
    // In the units of the fit, so that the normal matrix is as well conditioned as there.
    let scale_x = days.iter().map(|d| d.abs()).fold(0.0, f64::max).max(1e-300);
    let slopes = |day: f64| {
        let e = ops::exp(-r * day);
        let g = 1.0 / (1.0 + (k / p0 - 1.0) * e);
        let square = k * g * g;
        let by_k = g - square * e / p0;
        let by_p0 = square * (k / p0) * e / p0;
        [by_k, by_p0, square * (k / p0 - 1.0) * (day / scale_x) * e]
    };
    let rows: Vec<[f64; 3]> = days.iter().map(|&d| slopes(d)).collect();
    let mut normal = [[0.0; 3]; 3];
    for d in &rows {
        for (i, row) in normal.iter_mut().enumerate() {
            (0..3).for_each(|j| row[j] += d[i] * d[j]);
        }
    }
    let inverse = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|unit| solve3(normal, unit));
    let errors = days.iter().zip(values).zip(&rows).map(|((&day, value), d)| {
        let error = value - offset - Logistic { offset: 0.0, ..fit.law }.value(day);
        // If the days do not determine all three, no value has a leverage.
        let leverage = match inverse {
            [Some(a), Some(b), Some(c)] => {
                (0..3).map(|i| d[i] * (a[i] * d[0] + b[i] * d[1] + c[i] * d[2])).sum::<f64>()
            }
            _ => 0.0,
        };
        let free = 1.0 - leverage;
        if free > 1e-9 { error / free } else { error }
    });
    errors.collect()
}

/// As [`fit_logistic`], without leaving any value out: `loo_rmse` stays `None`.
///
/// # Errors
/// [`FitError`].
pub fn fit_law(days: &[f64], values: &[f64], offset: Offset) -> Result<Fit, FitError> {
    if days.len() != values.len() {
        return Err(FitError::Length { days: days.len(), values: values.len() });
    }
    if days.len() < 3 {
        return Err(FitError::TooFew { got: days.len() });
    }
    // 1e100: squares and sums of squares stay finite.
    if let Some(index) = days.iter().zip(values).position(|(d, v)| !(d.abs() <= 1e100 && v.abs() <= 1e100)) {
        return Err(FitError::NotFinite { index });
    }
    if let Some(w) = days.windows(2).find(|w| w[1] <= w[0]) {
        return Err(FitError::Order { day: w[1], before: w[0] });
    }
    let constant = constant_under(values, offset)?;
    let shifted: Vec<f64> = values.iter().map(|v| v - constant).collect();
    let mut fit = fit_core(days, &shifted);
    fit.law.offset = constant;
    Ok(fit)
}

/// Returns the constant under the curve of a series.
fn constant_under(values: &[f64], offset: Offset) -> Result<f64, FitError> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let changes = low <= 0.0 && high >= 0.0;
    Ok(if !changes || high <= low {
        0.0
    } else if offset == Offset::Zero {
        return Err(FitError::Sign);
    } else if values[values.len() - 1] >= values[0] {
        low - 0.1 * (high - low)
    } else {
        high + 0.1 * (high - low)
    })
}

/// Days and values scaled to 1, so that limits and steps mean the same for every series.
struct Scaled {
    x: Vec<f64>,
    y: Vec<f64>,
    sst: f64,
    /// `exp(-r x)` at the latest rate.
    e: Vec<f64>,
}

/// A state of the search: sum of squares, normal matrix, gradient.
struct State {
    p: [f64; 3],
    sse: f64,
    normal: [[f64; 3]; 3],
    gradient: [f64; 3],
}

impl Scaled {
    /// Returns the sum of squares at `p = [K, p0, r]`, or `None` if the curve has a pole at or between the days.
    fn state(&mut self, p: [f64; 3]) -> Option<State> {
        let [k, p0, r] = p;
        let q = k / p0;
        // Beyond these bounds a curve is a step or a straight exponential: a series whose best fit lies there
        // determines no logistic, and its parameters would diverge.
        let last = self.x.len() - 1;
        let span = self.x[last] - self.x[0];
        if !((1.0 / MAX_RATIO..=MAX_RATIO).contains(&q) && (r * span).abs() <= MAX_TURN) {
            return None;
        }
        ops::exps(-r, &self.x, &mut self.e);
        let pole_free = |e: f64| 1.0 + (q - 1.0) * e > 1e-12;
        if !(pole_free(self.e[0]) && pole_free(self.e[last])) {
            return None;
        }
        let mut s = State { p, sse: 0.0, normal: [[0.0; 3]; 3], gradient: [0.0; 3] };
        let inverse_p0 = 1.0 / p0;
        for ((&x, &y), &e) in self.x.iter().zip(&self.y).zip(&self.e) {
            let g = 1.0 / (1.0 + (q - 1.0) * e);
            let f = k * g;
            let fg = f * g;
            // f = K g, g = 1 / (1 + (K/p0 - 1) e): df/dK = g - K g^2 e/p0; df/dp0 = K^2 g^2 e/p0^2;
            // df/dr = K g^2 (K/p0 - 1) x e.
            let d0 = g - fg * e * inverse_p0;
            let d1 = fg * q * e * inverse_p0;
            let d2 = fg * (q - 1.0) * x * e;
            let residual = y - f;
            s.sse += residual * residual;
            s.gradient[0] += d0 * residual;
            s.gradient[1] += d1 * residual;
            s.gradient[2] += d2 * residual;
            s.normal[0][0] += d0 * d0;
            s.normal[0][1] += d0 * d1;
            s.normal[0][2] += d0 * d2;
            s.normal[1][1] += d1 * d1;
            s.normal[1][2] += d1 * d2;
            s.normal[2][2] += d2 * d2;
        }
        s.normal[1][0] = s.normal[0][1];
        s.normal[2][0] = s.normal[0][2];
        s.normal[2][1] = s.normal[1][2];
        s.sse.is_finite().then_some(s)
    }

    /// Returns the best K and p0 for a rate, from `1/y = a + b exp(-r x)`, linear in a and b; errors of `1/y` are those
    /// of y over y squared. Also returns its sum of squares.
    fn start(&mut self, r: f64) -> Option<([f64; 3], f64)> {
        let (mut ww, mut we, mut wee, mut wy, mut wey) = (0.0, 0.0, 0.0, 0.0, 0.0);
        ops::exps(-r, &self.x, &mut self.e);
        for (&y, &e) in self.y.iter().zip(&self.e) {
            let inverse = y * y * y;
            let w = inverse * y;
            ww += w;
            we += w * e;
            wee += w * e * e;
            wy += inverse;
            wey += inverse * e;
        }
        let det = ww * wee - we * we;
        let a = (wy * wee - wey * we) / det;
        let b = (wey * ww - wy * we) / det;
        // 1/f = 1/K + (1/p0 - 1/K) e.
        let p = [1.0 / a, 1.0 / (a + b), r];
        if !p.iter().all(|x| x.is_finite()) {
            return None;
        }
        let q = p[0] / p[1];
        let positive = |e: f64| 1.0 + (q - 1.0) * e > 1e-9;
        if !(q > 0.0 && positive(self.e[0]) && positive(self.e[self.e.len() - 1])) {
            return None;
        }
        let sse = self.y.iter().zip(&self.e).map(|(&y, &e)| {
            let d = y - p[0] / (1.0 + (q - 1.0) * e);
            d * d
        });
        Some((p, sse.sum()))
    }

    /// Descends by Levenberg 1944 and Marquardt 1963, scaled by the diagonal. `rival` is the sum of squares of another
    /// valley.
    fn descend(&mut self, p: [f64; 3], steps: &mut u32, rival: f64) -> Option<State> {
        let mut now = self.state(p)?;
        let mut lambda = 1e-3;
        let mut quiet = 0;
        let mut earlier = now.sse;
        for round in 1..=400 {
            *steps += 1;
            let mut a = now.normal;
            for (i, row) in a.iter_mut().enumerate() {
                row[i] += lambda * row[i].max(1e-300);
            }
            let next = solve3(a, now.gradient).and_then(|step| {
                let size = (0..3).map(|i| (step[i] / now.p[i]).abs()).fold(0.0, f64::max);
                let promise: f64 = (0..3).map(|i| step[i] * now.gradient[i]).sum();
                Some((self.state([0, 1, 2].map(|i| now.p[i] + step[i]))?, size, promise))
            });
            match next {
                // The last step: 1e-7 standard errors, of which a part remains. Whether the sum of squares falls is
                // rounding. Not if a large lambda made it small.
                Some((next, _, promise))
                    if lambda <= 1e-2
                        && promise <= 1e-15 * now.sse
                        && next.sse <= now.sse * (1.0 + 1e-12) =>
                {
                    now = next;
                    break;
                }
                Some((next, size, _)) if next.sse <= now.sse => {
                    let gain = now.sse - next.sse;
                    now = next;
                    lambda = (lambda * 0.1).max(1e-15);
                    // Twice, as the first small step may be due to a large lambda.
                    quiet = if size < 1e-10 || gain <= 1e-16 * now.sse { quiet + 1 } else { 0 };
                    if quiet >= 2 || now.sse <= 1e-30 * self.sst {
                        break;
                    }
                }
                _ => lambda *= 10.0,
            }
            // Rounding can miss the exact minimum for ever.
            if lambda > 1e12 {
                break;
            }
            // The search leaves a valley that would not fall below the other one in PACE times the last four steps, and
            // any that is still above after 26.
            if round % 4 == 0 {
                if now.sse > rival && (now.sse - rival > PACE * (earlier - now.sse) || round > 25) {
                    break;
                }
                earlier = now.sse;
            }
        }
        Some(now)
    }
}

/// Largest ratio of a start to the best valley found: others are not followed.
const HOPELESS: f64 = 300.0;

/// Factor on the latest gain of a valley: 2 more of 60,000 synthetic series of six shapes than with 100 end in the
/// higher valley.
const PACE: f64 = 30.0;

fn fit_core(days: &[f64], values: &[f64]) -> Fit {
    let n = days.len();
    let scale_x = days.iter().map(|d| d.abs()).fold(0.0, f64::max).max(1e-300);
    let scale_y = values.iter().map(|v| v.abs()).fold(0.0, f64::max);
    let mean = values.iter().sum::<f64>() / n as f64;
    if scale_y <= 0.0 || values.iter().all(|v| (v - mean).abs() <= 1e-14 * scale_y) {
        // Constant: every rate fits, none is determined.
        let law = Logistic { k: mean, p0: mean, r: 0.0, offset: 0.0 };
        // A law of 0 would be 0/0: its p0 is 1 with K 0, which is 0 everywhere.
        let law = if scale_y <= 0.0 { Logistic { k: 0.0, p0: 1.0, ..law } } else { law };
        let adjusted = (n > 3).then_some(1.0);
        return Fit {
            law,
            standard_errors: None,
            r2: 1.0,
            r2_adjusted: adjusted,
            loo_rmse: None,
            left_out: vec![],
            sse: 0.0,
            steps: 0,
        };
    }
    let mut scaled = Scaled {
        x: days.iter().map(|d| d / scale_x).collect(),
        y: values.iter().map(|v| v / scale_y).collect(),
        sst: values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (scale_y * scale_y),
        e: vec![0.0; n],
    };
    let span = scaled.x[n - 1] - scaled.x[0];
    // Rates per span: from a nearly straight line to a step within the series; a negative rate decays to 0 along an S.
    let rates = [0.3, 1.5, 4.0, 10.0, 30.0, -0.7, -2.0, -5.0, -12.0].map(|r| r / span);
    let mut starts: Vec<_> = rates.iter().filter_map(|&r| scaled.start(r)).collect();
    base::sort_by(&mut starts, |a, b| a.1.total_cmp(&b.1));
    let flat = mean / scale_y;
    starts.push(([flat * 1.05, flat * 0.95, 1.0 / span], scaled.sst));
    // The best start, and the best of the opposite sign: growth and decay are separate valleys.
    let first = starts[0].0[2];
    if let Some(other) = starts.iter().position(|(p, _)| p[2] * first < 0.0) {
        let other = starts.remove(other);
        starts.insert(1, other);
    }
    let mut steps = 0;
    let mut best: Option<State> = None;
    for (p, sse) in starts.iter().take(2) {
        let limit = best.as_ref().map_or(f64::INFINITY, |b| b.sse * (1.0 + 1e-9));
        let met = best.as_ref().is_some_and(|b| b.sse <= 1e-24 * scaled.sst);
        if met || *sse > HOPELESS * limit {
            break;
        }
        if let Some(end) = scaled.descend(*p, &mut steps, limit)
            && best.as_ref().is_none_or(|b| end.sse < b.sse)
        {
            best = Some(end);
        }
    }
    let end = best.or_else(|| scaled.state([flat, flat, 0.0]));
    let Some(end) = end else {
        let law = Logistic { k: mean, p0: mean, r: 0.0, offset: 0.0 };
        let sse = scaled.sst * scale_y * scale_y;
        let left_out = vec![];
        return Fit {
            law,
            standard_errors: None,
            r2: 0.0,
            r2_adjusted: None,
            loo_rmse: None,
            left_out,
            sse,
            steps,
        };
    };
    let [k, p0, r] = end.p;
    let r2 = 1.0 - end.sse / scaled.sst;
    let degrees = n - 3;
    let errors = (degrees > 0).then(|| covariance(&end.normal)).flatten().map(|c| {
        let variance = end.sse / degrees as f64;
        let e = c.map(|c| (c * variance).sqrt());
        [e[0] * scale_y, e[1] * scale_y, e[2] / scale_x]
    });
    Fit {
        law: Logistic { k: k * scale_y, p0: p0 * scale_y, r: r / scale_x, offset: 0.0 },
        standard_errors: errors.filter(|e| e.iter().all(|x| x.is_finite())),
        r2,
        r2_adjusted: (degrees > 0).then(|| 1.0 - (1.0 - r2) * (n - 1) as f64 / degrees as f64),
        loo_rmse: None,
        left_out: vec![],
        sse: end.sse * scale_y * scale_y,
        steps,
    }
}

/// Solves by Cramer's rule after scaling rows and columns to a unit diagonal; [`geom::solve_positive`] rounds
/// differently, and laws are compared to the last bit.
fn solve3(a: [[f64; 3]; 3], b: [f64; 3]) -> Option<[f64; 3]> {
    let s = [0, 1, 2].map(|i| 1.0 / a[i][i].sqrt());
    if !s.iter().all(|s| s.is_finite()) {
        return None;
    }
    let (x, y, z) = (a[0][1] * s[0] * s[1], a[0][2] * s[0] * s[2], a[1][2] * s[1] * s[2]);
    // Cholesky of [1 x y; x 1 z; y z 1].
    let d1 = (1.0 - x * x).sqrt();
    let l = (z - x * y) / d1;
    let d2 = (1.0 - y * y - l * l).sqrt();
    let b = [b[0] * s[0], b[1] * s[1], b[2] * s[2]];
    let u1 = (b[1] - x * b[0]) / d1;
    let u2 = (b[2] - y * b[0] - l * u1) / d2;
    let v2 = u2 / d2;
    let v1 = (u1 - l * v2) / d1;
    let v0 = b[0] - x * v1 - y * v2;
    let out = [v0 * s[0], v1 * s[1], v2 * s[2]];
    out.iter().all(|x| x.is_finite()).then_some(out)
}

/// Returns the diagonal of the inverse of a normal matrix.
fn covariance(a: &[[f64; 3]; 3]) -> Option<[f64; 3]> {
    let mut out = [0.0; 3];
    for i in 0..3 {
        let mut unit = [0.0; 3];
        unit[i] = 1.0;
        out[i] = solve3(*a, unit)?[i];
    }
    out.iter().all(|&c| c > 0.0).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The claim of [`LEFT_OUT_IN_TURN`] about longer series: the error by leverage is that of leaving each value out
    /// in turn.
    #[test]
    fn long_series_are_left_out_by_leverage() {
        let truth = Logistic { k: 0.1, p0: 0.012, r: 0.05, offset: 0.0 };
        for (n, noise, least) in [(101, 0.001, 0.001), (101, 0.01, 0.01), (400, 0.003, 0.003)] {
            let mut s = base::Seed::new(n).stream(base::Draw::Test);
            let days: Vec<f64> = (0..n).map(|i| 200.0 * i as f64 / n as f64).collect();
            // Noise with variance 1.
            let mut z = || (0..4).map(|_| s.range(-0.5, 0.5)).sum::<f64>() * 3.0_f64.sqrt();
            let values: Vec<f64> = days.iter().map(|&d| truth.value(d) + noise * z()).collect();
            let fit = fit_logistic(&days, &values, Offset::Auto).expect("fits");
            let mut sum = 0.0;
            for out in 0..days.len() {
                let keep = |all: &[f64], offset: f64| -> Vec<f64> {
                    all.iter().enumerate().filter(|(i, _)| *i != out).map(|(_, x)| x - offset).collect()
                };
                let rest = fit_core(&keep(&days, 0.0), &keep(&values, fit.law.offset));
                let error = rest.law.value(days[out]) + fit.law.offset - values[out];
                sum += error * error;
            }
            let (in_turn, told) = ((sum / days.len() as f64).sqrt(), fit.loo_rmse.expect("told"));
            println!("{n} values: {in_turn:.7} in turn, {told:.7} by leverage");
            assert!((told - in_turn).abs() < 3e-3 * in_turn, "{n}: {told} {in_turn}");
            assert!(told > 0.8 * least && told < 1.2 * least, "{told}");
        }
    }

    #[test]
    fn a_long_series_that_determines_nothing_has_an_error_all_the_same() {
        let days: Vec<f64> = (0..300).map(f64::from).collect();
        let told = |value: &dyn Fn(f64) -> f64| {
            let values: Vec<f64> = days.iter().map(|&d| value(d)).collect();
            fit_logistic(&days, &values, Offset::Auto).expect("fits").loo_rmse.expect("told")
        };
        assert!(told(&|_| 5.0) < 1e-9 && told(&|_| 0.0) < 1e-9);
        assert!(told(&|d| if d > 150.0 { 1.0 } else { 0.1 }).is_finite());
        assert!(told(&|d| 1e-3 * d + 1.0).is_finite());
    }
}
