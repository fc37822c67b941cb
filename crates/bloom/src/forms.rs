//! Fits one law to several series of one kind, which share its rate and time as far as the days determine them.
//!
//! `y_i(t) = A_i + B_i S(t; r, t0)`: each series has its own level and size, all have one rate r and one time t0. Three
//! days cannot determine three parameters and their errors for one series, but they can for several together. A and B
//! are linear and solved for at every r and t0 (Golub and Pereyra 1973: variable projection).

use base::{CancelToken, Cancelled, ops};
use serde::{Deserialize, Serialize};

/// The curve of a law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// `1 / (1 + exp(-r (t - t0)))`: fastest half way.
    #[default]
    Logistic,
    /// `exp(-exp(-r (t - t0)))`: fastest early.
    Gompertz,
    /// `1 - exp(-r (t - t0))`: slower and slower.
    Monomolecular,
    /// A straight line, used if the days determine no law.
    Straight,
    /// The last measured value, unchanged, used if straight lines predict no better.
    Still,
}

impl Form {
    /// The three laws.
    pub const LAWS: [Self; 3] = [Self::Logistic, Self::Gompertz, Self::Monomolecular];

    /// Returns the word in files and reports.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Logistic => "logistic",
            Self::Gompertz => "gompertz",
            Self::Monomolecular => "monomolecular",
            Self::Straight => "straight",
            Self::Still => "still",
        }
    }

    /// Returns how many of r and t0 a fit of this form has: for a monomolecular law another t0 is equivalent to another
    /// level and size.
    fn shared_numbers(self, level: bool) -> usize {
        match self {
            Self::Straight | Self::Still => 0,
            Self::Monomolecular if level => 1,
            _ => 2,
        }
    }

    fn curve(self, r: f64, t0: f64, t: f64) -> f64 {
        let e = ops::exp(-r * (t - t0));
        match self {
            Self::Logistic => 1.0 / (1.0 + e),
            Self::Gompertz => ops::exp(-e),
            Self::Monomolecular => 1.0 - e,
            Self::Straight | Self::Still => t,
        }
    }
}

/// Values of one series.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Days, increasing strictly.
    pub days: Vec<f64>,
    /// One value per day.
    pub values: Vec<f64>,
}

/// Levels, sizes, rate and time of series that share rate and time.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedFit {
    /// The curve.
    pub form: Form,
    /// Whether a level under each curve is free; otherwise it is 0.
    pub level: bool,
    /// Rate, per day.
    pub r: f64,
    /// Time of the curve, days.
    pub t0: f64,
    /// A and B of each series.
    pub linear: Vec<[f64; 2]>,
    /// Standard errors; `None` without a degree of freedom or if the days do not determine the parameters.
    pub errors: Option<SharedErrors>,
    /// Sum of squared residuals of all series.
    pub sse: f64,
    /// Number of values minus number of fitted parameters.
    pub freedom: i64,
    /// Whether r or t0 ended on a bound of the search.
    pub on_bound: bool,
    /// Each value minus its prediction by a fit without its organ on its day; one row per series, empty before
    /// [`crate::choose`] requests it. `None` if the others do not determine the curve.
    pub left_out: Vec<Vec<Option<f64>>>,
}

/// Standard errors of a shared fit.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedErrors {
    /// Errors of the final and the first state of each series ([`SharedFit::states`]).
    pub states: Vec<[f64; 2]>,
    /// Errors of the final value of each series and of that on day 0: the states with the level under them, which is
    /// fitted as well.
    pub values: Vec<[f64; 2]>,
    /// Error of r.
    pub rate: f64,
    /// Error of t0.
    pub time: f64,
}

/// Number of rates on the grid.
const RATES: usize = 55;
/// Range of rates per span on the grid, from nearly straight to a step.
const RATE_RANGE: [f64; 2] = [0.5, 40.0];
/// Number of values of t0 on the grid.
const TIMES: usize = 37;
/// Range of t0 on the grid, in spans from the first day.
const TIME_RANGE: [f64; 2] = [-1.0, 2.0];

/// Series of one kind, grouped by equal days: a curve has the same values on them.
struct Group<'a> {
    series: &'a [Series],
    /// Sum of the values of each series.
    sums: Vec<f64>,
    /// The distinct lists of days.
    days: Vec<&'a [f64]>,
    /// Index of the list of each series.
    list: Vec<usize>,
}

impl<'a> Group<'a> {
    fn new(series: &'a [Series]) -> Self {
        let by_days = |&a: &usize, &b: &usize| {
            let [a, b] = [a, b].map(|i| series[i].days.iter().map(|d| d.to_bits()));
            a.cmp(b)
        };
        let mut order: Vec<usize> = (0..series.len()).collect();
        base::sort_by(&mut order, by_days);
        let mut out = Self {
            series,
            sums: series.iter().map(|s| s.values.iter().sum()).collect(),
            days: Vec::new(),
            list: vec![0; series.len()],
        };
        for alike in order.chunk_by(|a, b| by_days(a, b).is_eq()) {
            alike.iter().for_each(|&i| out.list[i] = out.days.len());
            out.days.push(&series[alike[0]].days);
        }
        out
    }
}

/// Values of a curve on a list of days.
#[derive(Default)]
struct OnDays {
    curve: Vec<f64>,
    mean: f64,
    centre: f64,
    square: f64,
}

impl OnDays {
    /// Returns false for a curve that is constant on these days and so gives no information.
    fn fill(&mut self, level: bool, days: &[f64], curve: impl Fn(f64) -> f64) -> bool {
        self.curve.clear();
        self.curve.extend(days.iter().map(|&t| curve(t)));
        let n = days.len() as f64;
        let mean = self.curve.iter().sum::<f64>() / n;
        let centre = if level { mean } else { 0.0 };
        let square: f64 = self.curve.iter().map(|s| (s - centre) * (s - centre)).sum();
        (self.mean, self.centre, self.square) = (mean, centre, square);
        let flat = square <= 1e-10 * self.curve.iter().map(|s| s * s).sum::<f64>().max(1e-300);
        !flat && square.is_finite()
    }
}

/// All series at one point of the grid.
struct Cell<'a> {
    form: Form,
    level: bool,
    group: &'a Group<'a>,
    on_days: Vec<OnDays>,
    /// A and B of each series.
    linear: Vec<[f64; 2]>,
    /// Residual of each value, one series after the other.
    residuals: Vec<f64>,
}

impl<'a> Cell<'a> {
    fn new(form: Form, level: bool, group: &'a Group<'a>) -> Self {
        let on_days = group.days.iter().map(|_| OnDays::default()).collect();
        Self { form, level, group, on_days, linear: Vec::new(), residuals: Vec::new() }
    }

    /// Returns the sum of squares; `None` if the curve is constant on the days of a series.
    fn fill(&mut self, r: f64, t0: f64) -> Option<f64> {
        let (form, level) = (self.form, self.level);
        for (on, days) in self.on_days.iter_mut().zip(&self.group.days) {
            if !on.fill(level, days, |t| form.curve(r, t0, t)) {
                return None;
            }
        }
        self.linear.clear();
        self.residuals.clear();
        let mut total = 0.0;
        for (k, series) in self.group.series.iter().enumerate() {
            let on = &self.on_days[self.group.list[k]];
            let values = &series.values;
            let pairs = || on.curve.iter().zip(values);
            let b = pairs().map(|(s, y)| (s - on.centre) * y).sum::<f64>() / on.square;
            let a = if level { self.group.sums[k] / on.curve.len() as f64 - b * on.mean } else { 0.0 };
            let first = self.residuals.len();
            self.residuals.extend(pairs().map(|(s, y)| y - a - b * s));
            total += self.residuals[first..].iter().map(|e| e * e).sum::<f64>();
            self.linear.push([a, b]);
        }
        total.is_finite().then_some(total)
    }
}

/// Fits one curve to all series; `None` if each curve of the grid is constant on the days of some series.
///
/// Each series needs 2 days or more. Guaranteed: the least sum of squares of the grid, refined until r and t0 have a
/// relative precision of 1e-9. Cost: about two thousand curves for each value, then a few hundred; a curve is computed
/// once for all series of the same days.
///
/// # Errors
/// [`Cancelled`].
pub fn fit_shared(
    form: Form,
    level: bool,
    all: &[Series],
    cancel: &CancelToken,
) -> Result<Option<SharedFit>, Cancelled> {
    let first = all.iter().filter_map(|s| s.days.first()).copied().fold(f64::INFINITY, f64::min);
    let last = all.iter().filter_map(|s| s.days.last()).copied().fold(f64::NEG_INFINITY, f64::max);
    let span = last - first;
    if all.is_empty() || !(span > 0.0 && span.is_finite()) {
        return Ok(None);
    }
    let values: usize = all.iter().map(|s| s.values.len()).sum();
    let places = grid(form, level, first, span);
    let group = Group::new(all);
    let mut cell = Cell::new(form, level, &group);
    let mut best: Option<(f64, usize)> = None;
    for (at, &[r, t0]) in places.iter().enumerate() {
        cancel.check()?;
        let Some(total) = cell.fill(r, t0) else { continue };
        if best.is_none_or(|(sse, _)| total < sse) {
            best = Some((total, at));
        }
    }
    let Some((_, at)) = best else { return Ok(None) };
    let Some((r, t0)) = refine(&mut cell, (places[at], first, span), cancel)? else {
        return Ok(None);
    };
    let Some(sse) = cell.fill(r, t0) else { return Ok(None) };
    let shared = form.shared_numbers(level);
    let numbers = all.len() * if level { 2 } else { 1 } + shared;
    #[expect(clippy::cast_possible_wrap, reason = "counts of values")]
    let freedom = values as i64 - numbers as i64;
    let per_span = r * span;
    let (edge_t, tiny) = ([TIME_RANGE[0] * span + first, TIME_RANGE[1] * span + first], 1e-6 * span);
    let on_bound = shared > 0
        && (!(RATE_RANGE[0] * 1.001..=RATE_RANGE[1] * 0.999).contains(&per_span)
            || shared > 1 && !(edge_t[0] + tiny..=edge_t[1] - tiny).contains(&t0));
    let mut fit = SharedFit {
        form,
        level,
        r,
        t0,
        linear: cell.linear,
        errors: None,
        sse,
        freedom,
        on_bound,
        left_out: Vec::new(),
    };
    if freedom > 0 && !on_bound {
        fit.errors = Linearised::new(&fit, all).and_then(|l| l.errors(&fit));
    }
    Ok(Some(fit))
}

/// Returns the number of curves of the grid that [`fit_shared`] compares with each value.
pub(crate) fn curves_of(form: Form, level: bool) -> u64 {
    grid(form, level, 0.0, 1.0).len() as u64
}

/// Returns the number of curves of the grid that [`crate::choose`] compares with each value.
pub(crate) fn curves_compared() -> u64 {
    let laws = Form::LAWS.iter().map(|&form| curves_of(form, false) + curves_of(form, true));
    laws.sum::<u64>() + curves_of(Form::Straight, true)
}

/// Returns the rates and times of the initial grid.
fn grid(form: Form, level: bool, first: f64, span: f64) -> Vec<[f64; 2]> {
    let share = |i: usize, n: usize| i as f64 / (n - 1) as f64;
    let times: Vec<f64> = match form {
        Form::Straight | Form::Still => return vec![[0.0, 0.0]],
        // Another t0 is equivalent to another A and B.
        Form::Monomolecular if level => vec![first],
        _ => (0..TIMES)
            .map(|i| first + span * ops::lerp(TIME_RANGE[0], TIME_RANGE[1], share(i, TIMES)))
            .collect(),
    };
    let ratio = RATE_RANGE[1] / RATE_RANGE[0];
    let rates = (0..RATES).map(|i| RATE_RANGE[0] * ops::powf(ratio, share(i, RATES)) / span);
    rates.flat_map(|r| times.iter().map(move |&t0| [r, t0])).collect()
}

/// Final step of the compass search, in the logarithm of r.
const FINEST: f64 = 1e-10;

/// Runs a compass search within the grid's bounds: in the logarithm of r, and in t0.
fn refine(
    cell: &mut Cell<'_>,
    (start, first, span): ([f64; 2], f64, f64),
    cancel: &CancelToken,
) -> Result<Option<(f64, f64)>, Cancelled> {
    let (form, level) = (cell.form, cell.level);
    let [mut r, mut t0] = start;
    let Some(mut best) = cell.fill(r, t0) else { return Ok(None) };
    if form == Form::Straight {
        return Ok(Some((r, t0)));
    }
    let still = form == Form::Monomolecular && level;
    let (low, high) = (RATE_RANGE[0] / span, RATE_RANGE[1] / span);
    let mut step = [0.16, if still { 0.0 } else { 0.084 * span }];
    // r and t0 are correlated along the valley: the search includes both diagonals.
    let ways = [
        [1.0, 0.0],
        [-1.0, 0.0],
        [0.0, 1.0],
        [0.0, -1.0],
        [1.0, 1.0],
        [-1.0, -1.0],
        [1.0, -1.0],
        [-1.0, 1.0],
    ];
    for _ in 0..400 {
        cancel.check()?;
        let next = ways.iter().filter_map(|w| {
            let r = (r * ops::exp(w[0] * step[0])).clamp(low, high);
            let t0 = (t0 + w[1] * step[1]).clamp(first + TIME_RANGE[0] * span, first + TIME_RANGE[1] * span);
            Some((cell.fill(r, t0)?, r, t0))
        });
        match next.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((sse, new_r, new_t0)) if sse < best => (best, r, t0) = (sse, new_r, new_t0),
            _ => step = [step[0] * 0.5, step[1] * 0.5],
        }
        if step[0] < FINEST {
            break;
        }
    }
    Ok(Some((r, t0)))
}

/// One series of a fit whose parameters change slightly.
struct LinearPart {
    curve: Vec<f64>,
    centre: f64,
    square: f64,
    /// Share of the curve's change with r and t0 that A and B absorb.
    taken: [[f64; 2]; 2],
    /// Remainder of that change, one per value.
    rest: [Vec<f64>; 2],
}

/// Linear least squares of all parameters together, near the fit.
pub(crate) struct Linearised {
    parts: Vec<LinearPart>,
    /// Inverse of the normal matrix of r and t0.
    inverse: [[f64; 2]; 2],
}

impl Linearised {
    /// Returns `None` if rate and time cannot be distinguished.
    pub(crate) fn new(fit: &SharedFit, all: &[Series]) -> Option<Self> {
        let shared = fit.form.shared_numbers(fit.level);
        let parts: Vec<LinearPart> =
            all.iter().zip(&fit.linear).map(|(s, &[_, b])| LinearPart::new(fit, s, b)).collect();
        let mut normal = [[0.0; 2]; 2];
        for part in &parts {
            for (i, row) in normal.iter_mut().enumerate().take(shared) {
                for (j, cell) in row.iter_mut().enumerate().take(shared) {
                    *cell += part.rest[i].iter().zip(&part.rest[j]).map(|(x, y)| x * y).sum::<f64>();
                }
            }
        }
        let inverse = match shared {
            0 => [[0.0; 2]; 2],
            1 => [[1.0 / normal[0][0], 0.0], [0.0, 0.0]],
            _ => {
                let det = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
                // Rate and time that cannot be distinguished are not determined.
                if det <= 1e-9 * normal[0][0] * normal[1][1] {
                    return None;
                }
                [[normal[1][1] / det, -normal[0][1] / det], [-normal[1][0] / det, normal[0][0] / det]]
            }
        };
        Some(Self { parts, inverse })
    }

    fn quadratic(&self, v: [f64; 2]) -> f64 {
        let i = self.inverse;
        v[0] * (i[0][0] * v[0] + i[0][1] * v[1]) + v[1] * (i[1][0] * v[0] + i[1][1] * v[1])
    }

    fn errors(&self, fit: &SharedFit) -> Option<SharedErrors> {
        let variance = fit.sse / fit.freedom as f64;
        let start = fit.form.curve(fit.r, fit.t0, 0.0);
        let by_curve = slopes_at(fit.form, fit.r, fit.t0, 0.0);
        // u A + v B, and its change with the curve itself.
        let of = |part: &LinearPart, b: f64, u: f64| {
            [(1.0, [0.0; 2]), (start, by_curve)].map(|(v, direct)| {
                let level = if fit.level { u * u / part.curve.len() as f64 } else { 0.0 };
                let own = level + (v - u * part.centre) * (v - u * part.centre) / part.square;
                let by_shared = [0, 1].map(|k| b * direct[k] - u * part.taken[k][0] - v * part.taken[k][1]);
                (variance * (own + self.quadratic(by_shared))).sqrt()
            })
        };
        let each = |u: f64| -> Vec<[f64; 2]> {
            self.parts.iter().zip(&fit.linear).map(|(part, l)| of(part, l[1], u)).collect()
        };
        let one_if = |is: bool| if is { 1.0 } else { 0.0 };
        let errors = SharedErrors {
            states: each(one_if(fit.whole_level())),
            values: each(one_if(fit.level)),
            rate: (variance * self.inverse[0][0]).sqrt(),
            time: (variance * self.inverse[1][1]).sqrt(),
        };
        let numbers = || errors.states.iter().chain(&errors.values).flatten();
        let is_finite = numbers().chain([&errors.rate, &errors.time]).all(|x| x.is_finite());
        is_finite.then_some(errors)
    }

    /// Returns the leverage of each value: 1 if the fit follows it completely.
    pub(crate) fn leverage(&self, fit: &SharedFit) -> Vec<Vec<f64>> {
        let of = |part: &LinearPart| {
            let level = if fit.level { 1.0 / part.curve.len() as f64 } else { 0.0 };
            let rows = part.curve.iter().zip(&part.rest[0]).zip(&part.rest[1]);
            rows.map(|((s, &by_r), &by_t0)| {
                level + (s - part.centre) * (s - part.centre) / part.square + self.quadratic([by_r, by_t0])
            })
            .collect()
        };
        self.parts.iter().map(of).collect()
    }
}

impl LinearPart {
    fn new(fit: &SharedFit, series: &Series, b: f64) -> Self {
        let curve: Vec<f64> = series.days.iter().map(|&t| fit.form.curve(fit.r, fit.t0, t)).collect();
        let n = curve.len() as f64;
        let centre = if fit.level { curve.iter().sum::<f64>() / n } else { 0.0 };
        let square: f64 = curve.iter().map(|s| (s - centre) * (s - centre)).sum();
        let slopes = slopes(fit.form, fit.r, fit.t0, &series.days);
        let mut taken = [[0.0; 2]; 2];
        let mut rest = [vec![0.0; curve.len()], vec![0.0; curve.len()]];
        for k in 0..fit.form.shared_numbers(fit.level) {
            let mean = if fit.level { slopes[k].iter().sum::<f64>() / n } else { 0.0 };
            let by_b = slopes[k].iter().zip(&curve).map(|(d, s)| d * (s - centre)).sum::<f64>() / square;
            taken[k] = [b * (mean - by_b * centre), b * by_b];
            rest[k] =
                slopes[k].iter().zip(&curve).map(|(d, s)| b * (d - mean - by_b * (s - centre))).collect();
        }
        Self { curve, centre, square, taken, rest }
    }
}

/// Returns the derivatives of the curve with respect to r and t0, at each day.
fn slopes(form: Form, r: f64, t0: f64, days: &[f64]) -> [Vec<f64>; 2] {
    let rows: Vec<[f64; 2]> = days.iter().map(|&t| slopes_at(form, r, t0, t)).collect();
    [rows.iter().map(|d| d[0]).collect(), rows.iter().map(|d| d[1]).collect()]
}

fn slopes_at(form: Form, r: f64, t0: f64, t: f64) -> [f64; 2] {
    let x = t - t0;
    let e = ops::exp(-r * x);
    // d/d(r x) of the curve.
    let d = match form {
        Form::Logistic => e / ((1.0 + e) * (1.0 + e)),
        Form::Gompertz => e * ops::exp(-e),
        Form::Monomolecular => e,
        Form::Straight | Form::Still => 0.0,
    };
    [d * x, -d * r]
}

impl SharedFit {
    /// Whether the level belongs to the states: a monomolecular curve has no part of its own below day 0.
    fn whole_level(&self) -> bool {
        self.level && self.form == Form::Monomolecular
    }

    /// Returns K, the final state of a series, and p0, that on day 0; above the level, except for the monomolecular
    /// law.
    pub fn states(&self, series: usize) -> [f64; 2] {
        let [a, b] = self.linear[series];
        let level = if self.whole_level() { a } else { 0.0 };
        [level + b, level + b * self.form.curve(self.r, self.t0, 0.0)]
    }

    /// Returns the value of a series on a day.
    pub fn value(&self, series: usize, day: f64) -> f64 {
        let [a, b] = self.linear[series];
        a + b * self.form.curve(self.r, self.t0, day)
    }

    /// Returns the root mean square of [`left_out`](Self::left_out); `None` if that is empty.
    pub fn loo_rmse(&self) -> Option<f64> {
        rms(self.left_out.iter().flatten().flatten().copied())
    }
}

/// Returns the root mean square; `None` of an empty list.
pub(crate) fn rms(errors: impl Iterator<Item = f64>) -> Option<f64> {
    let rows: Vec<f64> = errors.collect();
    (!rows.is_empty()).then(|| (rows.iter().map(|e| e * e).sum::<f64>() / rows.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit_shared(form: Form, level: bool, all: &[Series]) -> Option<SharedFit> {
        super::fit_shared(form, level, all, &CancelToken::new()).expect("not cancelled")
    }

    /// Chooses with each series as an organ of its own.
    fn choose(all: &[Series]) -> Option<crate::Choice> {
        let organs: Vec<usize> = (0..all.len()).collect();
        crate::choose(all, &organs, &CancelToken::new()).expect("not cancelled")
    }

    fn made(
        form: Form,
        days: &[f64],
        linear: &[[f64; 2]],
        r: f64,
        t0: f64,
        noise: f64,
        seed: u64,
    ) -> Vec<Series> {
        let mut s = base::Seed::new(seed).stream(base::Draw::Test);
        let value = |[a, b]: [f64; 2], t: f64, z: f64| a + b * form.curve(r, t0, t) + noise * z;
        linear
            .iter()
            .map(|&ab| {
                // The sum of four uniform numbers, of variance 1.
                let mut z = || (0..4).map(|_| s.range(-0.5, 0.5)).sum::<f64>() * 3.0_f64.sqrt();
                let values = days.iter().map(|&t| value(ab, t, z())).collect();
                Series { days: days.to_vec(), values }
            })
            .collect()
    }

    const LINEAR: [[f64; 2]; 6] =
        [[0.0, 20.0], [2.0, 14.0], [1.0, -9.0], [-3.0, 24.0], [0.5, 11.0], [4.0, -17.0]];

    #[test]
    fn three_days_of_several_series_give_the_rate_that_they_share() {
        // The monomolecular law has one shared parameter: three days of six series determine it.
        let all = made(Form::Monomolecular, &[0.0, 1.0, 5.0], &LINEAR, 0.6, 0.0, 0.1, 1);
        let fit = fit_shared(Form::Monomolecular, true, &all).unwrap();
        let se = fit.errors.clone().unwrap().rate;
        assert!((fit.r - 0.6).abs() < 3.0 * se && se < 0.06, "{} ± {se}", fit.r);
        assert_eq!(fit.freedom, 5);
        let choice = choose(&all).unwrap();
        assert!(choice.determined, "{choice:?}");
        assert!(choice.fit.loo_rmse().unwrap() < 0.5 * choice.straight_rmse.unwrap());
    }

    #[test]
    fn rate_time_and_levels_lie_within_three_standard_errors() {
        for form in Form::LAWS {
            for days in [&[0.0, 1.0, 2.0, 4.0, 6.0, 9.0][..], &[0.0, 2.0, 5.0, 9.0]] {
                let all = made(form, days, &LINEAR, 0.7, 3.0, 0.15, 7);
                let fit = fit_shared(form, true, &all).unwrap();
                let SharedErrors { states: linear, rate: r, time: t0, .. } = fit.errors.clone().unwrap();
                assert!((fit.r - 0.7).abs() < 3.0 * r, "{form:?} {} ± {r}", fit.r);
                if form != Form::Monomolecular {
                    assert!((fit.t0 - 3.0).abs() < 3.0 * t0, "{form:?} {} ± {t0}", fit.t0);
                    for (k, (ab, se)) in LINEAR.iter().zip(&linear).enumerate() {
                        let want = [ab[1], ab[1] * form.curve(0.7, 3.0, 0.0)];
                        let got = fit.states(k);
                        assert!(
                            (0..2).all(|k| (got[k] - want[k]).abs() < 3.5 * se[k]),
                            "{got:?} {want:?} {se:?}"
                        );
                    }
                }
                assert!(choose(&all).unwrap().determined, "{form:?}");
            }
        }
    }

    #[test]
    fn a_day_that_was_left_out_is_predicted_better_by_the_law() {
        for form in Form::LAWS {
            let days = [0.0, 1.5, 3.0, 6.0, 10.0];
            let (mut by_law, mut by_line) = (0.0, 0.0);
            for out in 1..4 {
                let all = made(form, &days, &LINEAR, 0.8, 2.0, 0.1, 3);
                let keep = |s: &Series| {
                    let rows = || (0..5).filter(|&i| i != out);
                    Series {
                        days: rows().map(|i| s.days[i]).collect(),
                        values: rows().map(|i| s.values[i]).collect(),
                    }
                };
                let rest: Vec<Series> = all.iter().map(keep).collect();
                let law = choose(&rest).unwrap();
                assert!(law.determined, "{form:?} {out}");
                for (k, s) in all.iter().enumerate() {
                    let (a, b) = (out - 1, out + 1);
                    let share = (days[out] - days[a]) / (days[b] - days[a]);
                    by_line += (ops::lerp(s.values[a], s.values[b], share) - s.values[out]).abs();
                    by_law += (law.fit.value(k, days[out]) - s.values[out]).abs();
                }
            }
            println!("{form:?}: {by_law:.1} by the law, {by_line:.1} by straight lines");
            assert!(by_law < 0.5 * by_line, "{form:?}: {by_law} {by_line}");
        }
    }

    #[test]
    fn noise_and_straight_growth_determine_no_law() {
        let mut determined = 0;
        for seed in 0..40 {
            let line = made(Form::Straight, &[0.0, 1.0, 5.0], &LINEAR, 0.0, 0.0, 0.5, seed);
            determined += u32::from(choose(&line).unwrap().determined);
            let none = made(Form::Straight, &[0.0, 1.0, 5.0, 7.0], &[[1.0, 0.0]; 4], 0.0, 0.0, 0.5, seed);
            determined += u32::from(choose(&none).unwrap().determined);
        }
        println!("{determined} of 80");
        assert!(determined <= 4, "{determined} of 80 series without a law got one");
        assert!(choose(&[]).is_none());
        let two = made(Form::Logistic, &[0.0, 5.0], &LINEAR, 0.7, 3.0, 0.0, 1);
        assert!(!choose(&two).unwrap().determined, "two days determine no law");
    }

    /// A curve is computed once for series of equal days, whatever series lie between.
    #[test]
    fn series_of_equal_days_share_their_curves() {
        let odd = made(Form::Logistic, &[0.0, 2.5, 4.0, 7.0, 9.0], &LINEAR[..3], 0.7, 3.0, 0.15, 7);
        let even = made(Form::Logistic, &[0.0, 1.0, 2.0, 4.0, 6.0, 9.0], &LINEAR[..3], 0.7, 3.0, 0.15, 8);
        let mixed: Vec<Series> = odd.iter().zip(&even).flat_map(|(a, b)| [a.clone(), b.clone()]).collect();
        let group = Group::new(&mixed);
        assert_eq!((group.days.len(), group.list.len()), (2, 6));
        assert!(group.list.iter().zip(&mixed).all(|(&list, s)| group.days[list] == s.days));
        for (form, level) in [(Form::Logistic, true), (Form::Gompertz, false), (Form::Straight, true)] {
            let mut together = Cell::new(form, level, &group);
            let total = together.fill(0.6, 2.0).unwrap();
            let rows = together.residuals.clone();
            let (mut sum, mut alone) = (0.0, Vec::new());
            for one in mixed.chunks(1) {
                let group = Group::new(one);
                let mut cell = Cell::new(form, level, &group);
                sum += cell.fill(0.6, 2.0).unwrap();
                alone.extend(cell.residuals);
            }
            assert!((sum - total).abs() <= 1e-12 * total && rows == alone, "{form:?}");
        }
    }
}
