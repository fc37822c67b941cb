//! Growth laws from organs on several days: fitted, saved, plotted, and applied to another species.

use base::{CancelToken, Counted, Run, TimeUnit};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::choice::bends;
use crate::forms::{curves_compared, rms};
use crate::left_out::{Sittings, earns, left_out_of_last, left_out_of_mean};
use crate::logistic::fit_logistic_while;
use crate::{
    BloomError, Choice, Fit, FitError, Form, Logistic, Offset, ScanOrgan, Series, SharedFit, choose, fit_law,
    fit_shared,
};

/// The value of [`GrowthLaw::schema`].
pub const LAW_SCHEMA: &str = "burgeon.law/1";

/// Quantity that a law describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// Mean x of a region, from the organ's base.
    X,
    /// Mean y, upwards.
    Y,
    /// Mean z.
    Z,
    /// Mean distance of the whole organ from its base.
    Size,
}

impl Quantity {
    /// The three coordinates.
    pub const AXES: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// Returns the word in files and plots.
    pub const fn word(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::Size => "size",
        }
    }
}

/// Prediction of a law for a day.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// The value, metres.
    pub value: f64,
    /// Interval that contains 9 of 10 new measurements; `None` if it cannot be determined.
    pub interval: Option<[f64; 2]>,
}

/// Ratio of the final value to the measured ones above which the days do not determine it.
const BEYOND: f64 = 10.0;

/// Half width of the interval with nine tenths of Student's distribution, in standard errors, by degrees of freedom
/// from 1.
const STUDENT: [f64; 10] = [6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812];

fn quantile(freedom: usize) -> f64 {
    // Beyond the table it is 1.645 plus a term that decreases with the degrees of freedom, to 0.002.
    STUDENT.get(freedom.max(1) - 1).copied().unwrap_or_else(|| 1.645 + 1.6 / freedom as f64)
}

/// The law of one coordinate of one region of one organ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegionLaw {
    /// Name of the organ.
    pub organ: String,
    /// Region from 1 at the base; 0 for the whole organ.
    pub region: usize,
    /// The quantity.
    pub axis: Quantity,
    /// Form of the curve with K, p0, r and the offset. Default logistic.
    #[serde(default)]
    pub form: Form,
    /// K, p0, r and the constant under the curve; metres and days since the first stage. Growth ends at
    /// [`final_value`](Self::final_value), which is K above that constant. For a straight line K is the value on the
    /// last day and r the change per day; for a constant value K is the last one.
    #[serde(flatten)]
    pub law: Logistic,
    /// Whether the stages determine the law: it predicts left-out stages better than a straight line. A law that is not
    /// determined drives nothing. Absent in a file: determined unless there are 3 values, which leave no degree of
    /// freedom.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub determined: Option<bool>,
    /// Leave-one-out error of the straight line, metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub straight_rmse: Option<f64>,
    /// Error of each value predicted by the one before it, metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last_rmse: Option<f64>,
    /// Standard errors of K, p0 and r.
    pub standard_errors: Option<[f64; 3]>,
    /// Standard errors of the final value and of that on day 0, with the constant under the curve, metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value_errors: Option<[f64; 2]>,
    /// Coefficient of determination.
    pub r2: f64,
    /// The same, adjusted for the degrees of freedom; `None` for 3 stages.
    pub r2_adjusted: Option<f64>,
    /// Leave-one-out error, metres; `None` for fewer than 4 stages.
    pub loo_rmse: Option<f64>,
    /// Days since the first stage.
    pub days: Vec<f64>,
    /// The measured values, metres.
    pub values: Vec<f64>,
}

/// The growth laws of one species.
///
/// ```
/// let law = bloom::GrowthLaw::logistic("lily", 6.0, 0.9);
/// let g = law.progress("petal-1", bloom::Quantity::X, 0.5, 0.0, 6.0, 3.0);
/// assert!(g > 0.4 && g < 0.7);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GrowthLaw {
    /// Always [`LAW_SCHEMA`].
    pub schema: String,
    /// The species or series.
    pub name: String,
    /// Day of the first stage in the series' own count.
    pub first_day: f64,
    /// Days from the first to the last stage, above 0.
    pub span_days: f64,
    /// Unit that is called a day here and in the laws: for a table of ages in years, a year.
    #[serde(default, skip_serializing_if = "TimeUnit::is_day")]
    pub time: TimeUnit,
    /// Regions of each organ.
    pub regions: usize,
    /// Every law.
    pub laws: Vec<RegionLaw>,
}

impl GrowthLaw {
    /// Makes a law without measurements: all of every organ follows one logistic from 10 % to nearly 100 %, faster for
    /// a greater `rate` per day.
    pub fn logistic(name: &str, span_days: f64, rate: f64) -> Self {
        let law = Logistic { k: 1.0, p0: 0.1, r: rate, offset: 0.0 };
        let row = RegionLaw {
            organ: "any".into(),
            region: 0,
            axis: Quantity::Size,
            form: Form::Logistic,
            law,
            determined: None,
            straight_rmse: None,
            last_rmse: None,
            standard_errors: None,
            value_errors: None,
            r2: 1.0,
            r2_adjusted: None,
            loo_rmse: None,
            days: vec![],
            values: vec![],
        };
        Self {
            schema: LAW_SCHEMA.into(),
            name: name.into(),
            first_day: 0.0,
            span_days,
            time: TimeUnit::Day,
            regions: 1,
            laws: vec![row],
        }
    }

    /// Makes an even pace from the first to the last day.
    pub fn even(first_day: f64, last_day: f64) -> Self {
        let mut law = Self::logistic("even", (last_day - first_day).max(1e-9), 1.0);
        law.first_day = first_day;
        law.laws.iter_mut().for_each(|l| l.determined = Some(false));
        law
    }

    /// Iterates over all faults that make a law from a file unusable: other schema, no law, numbers that are not
    /// finite.
    pub fn validate(&self) -> impl Iterator<Item = LawFault> + '_ {
        let head = (self.schema != LAW_SCHEMA).then(|| LawFault::Schema(self.schema.clone()));
        let span = !(self.span_days > 0.0 && self.span_days.is_finite() && self.first_day.is_finite());
        let rows = self.laws.iter().enumerate().filter_map(|(i, row)| {
            let sound = row.is_finite(self.span_days) && row.days.len() == row.values.len();
            (!sound).then_some(LawFault::Row(i))
        });
        head.into_iter()
            .chain(span.then_some(LawFault::Span))
            .chain((self.laws.is_empty() || self.regions == 0).then_some(LawFault::Empty))
            .chain(rows)
    }

    /// Returns the progress of an organ from its shape at day `from` to that at day `to`: 0 and 1 at these days,
    /// monotone between (`g = (f(x) - f(from)) / (f(to) - f(from))`).
    ///
    /// `along` is the position on the organ, 0 at the base to 1 at the tip: between the middles of two regions their
    /// laws are blended. A law that hardly moves does not determine the pace: then the organ's size law applies, then
    /// that of the other organs, then a straight line. An organ that the law does not contain follows the first one
    /// that it contains: in this way a law applies to another species. Days are since the first stage.
    pub fn progress(&self, organ: &str, axis: Quantity, along: f64, from: f64, to: f64, day: f64) -> f64 {
        let straight = even_pace(from, to, day);
        let organ = self.followed(organ);
        let regions = self.regions.max(1);
        let at = (along.clamp(0.0, 1.0) * regions as f64 - 0.5).clamp(0.0, (regions - 1) as f64);
        let low = at.floor();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to regions")]
        let low_region = low as usize + 1;
        let of = |region: usize| {
            self.pace(organ, region, axis, from, to, day)
                .or_else(|| self.pace(organ, 0, Quantity::Size, from, to, day))
                .or_else(|| self.any_pace(from, to, day))
                .unwrap_or(straight)
        };
        let share = at - low;
        let first = of(low_region);
        if share <= 0.0 { first } else { base::ops::lerp(first, of(low_region + 1), share) }
    }

    /// As [`progress`](Self::progress), for all three coordinates at once, each weighted by its movement: the pace of a
    /// place in a frame that turns with its organ.
    pub fn pace_at(&self, organ: &str, along: f64, from: f64, to: f64, day: f64) -> f64 {
        let name = self.followed(organ);
        let (mut sum, mut weights) = (0.0, 0.0);
        for axis in Quantity::AXES {
            let rows = self.laws.iter().filter(|l| l.organ == name && l.axis == axis && l.is_determined());
            let way: f64 = rows.map(|l| (l.value(to) - l.value(from)).abs()).sum();
            if way.is_finite() {
                sum += way * self.progress(organ, axis, along, from, to, day);
                weights += way;
            }
        }
        if weights > 0.0 { sum / weights } else { self.progress(organ, Quantity::Size, along, from, to, day) }
    }

    /// Whether some law sets a pace: one that its stages determine and that moves.
    pub fn sets_pace(&self) -> bool {
        let (first, last) = (0.0, self.span_days);
        self.laws.iter().any(|l| l.pace(first, last, 0.5 * last).is_some())
    }

    /// Returns the organ whose laws an organ follows: its own; otherwise the first organ with a law that is determined.
    fn followed<'a>(&'a self, organ: &'a str) -> &'a str {
        if self.laws.iter().any(|l| l.organ == organ) {
            return organ;
        }
        let able = self.laws.iter().find(|l| l.is_determined() && l.r2 > 0.5);
        able.or_else(|| self.laws.first()).map_or("", |l| l.organ.as_str())
    }

    fn pace(&self, organ: &str, region: usize, axis: Quantity, from: f64, to: f64, day: f64) -> Option<f64> {
        let row = self.laws.iter().find(|l| l.organ == organ && l.region == region && l.axis == axis)?;
        row.pace(from, to, day)
    }

    /// Returns the mean of the size laws of all organs.
    fn any_pace(&self, from: f64, to: f64, day: f64) -> Option<f64> {
        let rows = self.laws.iter().filter(|l| l.axis == Quantity::Size);
        let all: Vec<f64> = rows.filter_map(|l| l.pace(from, to, day)).collect();
        (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
    }
}

/// Returns the elapsed share of the time from `from` to `to`; 0 before and 1 after, since the continuation is unknown.
fn even_pace(from: f64, to: f64, day: f64) -> f64 {
    let share = (day - from) / (to - from);
    if share.is_finite() { share.clamp(0.0, 1.0) } else { 1.0 }
}

impl RegionLaw {
    /// Returns the value on a day since the first stage.
    pub fn value(&self, day: f64) -> f64 {
        let l = self.law;
        match self.form {
            Form::Logistic => l.value(day),
            Form::Gompertz => {
                l.offset + l.k * base::ops::exp(base::ops::ln(l.p0 / l.k) * base::ops::exp(-l.r * day))
            }
            Form::Monomolecular => l.offset + l.k - (l.k - l.p0) * base::ops::exp(-l.r * day),
            Form::Straight => l.offset + l.p0 + l.r * day,
            Form::Still => {
                let before = self.days.partition_point(|d| *d <= day).saturating_sub(1);
                self.values.get(before).copied().unwrap_or(l.offset + l.k)
            }
        }
    }

    /// Returns the limit of the law: K above the constant under the curve. `None` for a straight line, which has no
    /// limit, for a law that is not determined, and if the limit is far beyond the measurements and so unknown.
    pub fn final_value(&self) -> Option<f64> {
        let has_end =
            !matches!(self.form, Form::Straight | Form::Still) && self.is_determined() && self.law.r > 0.0;
        let end = self.law.k + self.law.offset;
        let most = self.values.iter().map(|v| v.abs()).fold(0.0, f64::max);
        (has_end && (self.values.is_empty() || end.abs() <= BEYOND * most)).then_some(end)
    }

    /// Returns the value on a day since the first stage, and the interval that contains 9 of 10 new measurements on it;
    /// no interval without a degree of freedom.
    ///
    /// By the residuals and the errors of the parameters (Seber and Wild 1989, equation 5.23); for a law whose rate
    /// several organs share it is as wide as if they did not. Beyond the days the form of the curve is assumed to hold.
    /// A constant value has the scatter of the steps, more of them the farther the day is.
    pub fn predict(&self, day: f64) -> Prediction {
        let value = self.value(day);
        let half = match self.form {
            Form::Still => self.last_rmse.map(|step| {
                let span = self.days.last().zip(self.days.first()).map_or(1.0, |(b, a)| b - a);
                let pace = span / (self.days.len().max(2) - 1) as f64;
                let beyond = self.days.last().map_or(0.0, |last| (day - last) / pace).max(1.0);
                quantile(self.values.len().saturating_sub(1)) * step * beyond.sqrt()
            }),
            _ => self.half_width(day),
        };
        let interval = half.filter(|h| h.is_finite() && value.is_finite()).map(|h| [value - h, value + h]);
        Prediction { value, interval }
    }

    fn half_width(&self, day: f64) -> Option<f64> {
        // A level under a curve is a fitted parameter, too; that of a monomolecular law is part of K and p0.
        let has_level = self.law.offset.abs() > 0.0 && self.form != Form::Monomolecular;
        let numbers = match self.form {
            Form::Straight => 2,
            _ if has_level => 4,
            _ => 3,
        };
        let freedom = self.values.len().checked_sub(numbers).filter(|f| *f > 0)?;
        let sse: f64 =
            self.days.iter().zip(&self.values).map(|(&d, v)| (v - self.value(d)) * (v - self.value(d))).sum();
        let slopes = |day: f64| self.slopes(day);
        let rows: Vec<[f64; 4]> = self.days.iter().map(|&d| slopes(d)).collect();
        // Parameters in their own units: the effect of p0 on a curve that rises late is a millionth of that of K.
        let sizes = [0, 1, 2, 3].map(|i| rows.iter().map(|row| row[i] * row[i]).sum::<f64>().sqrt());
        let scaled =
            |row: [f64; 4]| [0, 1, 2, 3].map(|i| if sizes[i] > 0.0 { row[i] / sizes[i] } else { 0.0 });
        let mut normal = vec![0.0; numbers * numbers];
        for row in rows.into_iter().map(scaled) {
            for i in 0..numbers {
                (0..numbers).for_each(|j| normal[i * numbers + j] += row[i] * row[j]);
            }
        }
        // Regularises parameters that the days cannot distinguish, without moving the others.
        (0..numbers).for_each(|i| normal[i * numbers + i] += 1e-9);
        let own = scaled(slopes(day));
        let mut by = own[..numbers].to_vec();
        geom::solve_positive(&mut normal, &mut by)?;
        let leverage: f64 = by.iter().zip(&own).map(|(a, b)| a * b).sum();
        let variance = sse / freedom as f64 * (1.0 + leverage.max(0.0));
        // Left-out days also include the uncertainty of the choice of the form.
        let left_out = self.loo_rmse.unwrap_or(0.0);
        // A form chosen among several fits better than a given one: it costs one more degree of freedom.
        let chosen = usize::from(self.form != Form::Straight && freedom > 1);
        Some(quantile(freedom - chosen) * variance.sqrt().max(left_out))
    }

    /// Returns the derivatives of the value on a day with respect to K, p0 and r, each scaled by its size, and to the
    /// level.
    fn slopes(&self, day: f64) -> [f64; 4] {
        if self.form == Form::Straight {
            return [1.0, day, 0.0, 0.0];
        }
        let Logistic { k, p0, r, .. } = self.law;
        let of = |law: Logistic| {
            Self { law, days: vec![], values: vec![], organ: String::new(), ..self.clone() }.value(day)
        };
        let step = 1e-5;
        let change = |change: &dyn Fn(f64) -> Logistic| {
            (of(change(1.0 + step)) - of(change(1.0 - step))) / (2.0 * step)
        };
        [
            change(&|f| Logistic { k: k * f, ..self.law }),
            change(&|f| Logistic { p0: p0 * f, ..self.law }),
            change(&|f| Logistic { r: r * f, ..self.law }),
            1.0,
        ]
    }

    /// Whether its parameters, and its values on the first and the last day, are finite.
    fn is_finite(&self, span_days: f64) -> bool {
        let Logistic { k, p0, r, offset } = self.law;
        [k, p0, r, offset, self.value(0.0), self.value(span_days)].iter().all(|x| x.is_finite())
    }

    /// Makes a straight line from the first value to the last, which determines nothing, for days so close together, or
    /// values so far apart, that the parameters of its curve are not finite.
    fn straightened(self, span_days: f64) -> Self {
        let [first, last] = [self.values.first(), self.values.last()].map(|v| v.copied().unwrap_or(0.0));
        let slope = (last - first) / span_days;
        let r = if slope.is_finite() { slope } else { 0.0 };
        let law = Logistic { k: last, p0: first, r, offset: 0.0 };
        Self {
            form: Form::Straight,
            law,
            determined: Some(false),
            standard_errors: None,
            value_errors: None,
            ..self
        }
    }

    /// Whether the stages determine the law.
    pub fn is_determined(&self) -> bool {
        self.determined.unwrap_or(self.days.len() != 3)
    }

    fn pace(&self, from: f64, to: f64, day: f64) -> Option<f64> {
        if !self.is_determined() {
            return None;
        }
        let (a, b, x) = (self.value(from), self.value(to), self.value(day));
        let level = self.values.iter().map(|v| v.abs()).fold(a.abs().max(b.abs()), f64::max);
        // 3 % of its level: less is noise of the scan; and a law that does not follow its values is unusable.
        let moves = (b - a).abs() > 0.03 * level && self.r2 > 0.5;
        // Beyond the last stage growth continues by at most half.
        moves.then(|| ((x - a) / (b - a)).clamp(-0.5, 1.5)).filter(|g| g.is_finite())
    }
}

/// Fault of a law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawFault {
    /// The file is not a law, or of a later version.
    #[error("its schema is {0:?}, not \"burgeon.law/1\"")]
    Schema(String),
    /// The span is not a positive number.
    #[error("its span_days is not above 0")]
    Span,
    /// The file contains no law.
    #[error("it holds no law")]
    Empty,
    /// A law has numbers that are not finite, or columns of unequal length.
    #[error("law {0} (from 0) has numbers that are of no use")]
    Row(usize),
}

/// One day of a series: its organs, with the same name for the same organ on each day.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stage {
    /// The day, in any count.
    pub day: f64,
    /// The measured organs.
    pub organs: Vec<ScanOrgan>,
}

/// Settings of the fit of laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LawSpec {
    /// Equal parts of each organ from base to tip, 1 to 20. Default 3.
    pub regions: usize,
    /// The constant under the curves. Default [`Offset::Auto`].
    pub offset: Offset,
}

impl Default for LawSpec {
    fn default() -> Self {
        Self { regions: 3, offset: Offset::Auto }
    }
}

/// Fits a law to each organ that exists on at least 3 days: for each region the means of x, y and z from the organ's
/// base (Huai, Yang and Cai 2019, step 3), and the organ's size.
///
/// # Errors
/// [`FitError::TooFew`] below 3 stages, [`FitError::Order`] for days that do not increase, and for a coordinate that
/// changes its sign if the offset is [`Offset::Zero`]; [`BloomError::OverBudget`]; [`BloomError::Cancelled`].
pub fn fit_stages(
    name: &str,
    stages: &[Stage],
    spec: &LawSpec,
    run: &Run<'_>,
) -> Result<GrowthLaw, BloomError> {
    if stages.len() < 3 {
        return Err(FitError::TooFew { got: stages.len() }.into());
    }
    if let Some(w) = stages.windows(2).find(|w| w[1].day <= w[0].day || !w[0].day.is_finite()) {
        return Err(FitError::Order { day: w[1].day, before: w[0].day }.into());
    }
    let first_day = stages[0].day;
    let mut names: Vec<&str> = Vec::new();
    for organ in stages.iter().flat_map(|s| &s.organs) {
        if !names.contains(&organ.name.as_str()) {
            names.push(&organ.name);
        }
    }
    let regions = spec.regions.clamp(1, 20);
    let mut rows: Vec<Measured> = Vec::new();
    for name in names {
        let there: Vec<(f64, &ScanOrgan)> = stages
            .iter()
            .filter_map(|s| Some((s.day - first_day, s.organs.iter().find(|o| o.name == name)?)))
            .collect();
        if there.len() < 3 {
            continue;
        }
        run.cancel.check()?;
        let days: Vec<f64> = there.iter().map(|t| t.0).collect();
        let size = |o: &ScanOrgan| {
            o.points.iter().map(|p| p.distance(o.base)).sum::<f64>() / o.points.len().max(1) as f64
        };
        let mut add = |region, axis, values| {
            let series = Series { days: days.clone(), values };
            rows.push(Measured { organ: name.to_owned(), region, axis, series });
        };
        add(0, Quantity::Size, there.iter().map(|(_, o)| size(o)).collect());
        let means: Vec<Vec<DVec3>> = there.iter().map(|(_, o)| region_means(o, regions)).collect();
        for region in 0..regions {
            for (k, axis) in Quantity::AXES.into_iter().enumerate() {
                add(region + 1, axis, means.iter().map(|m| m[region][k]).collect());
            }
        }
    }
    check_sizes(&rows, run, "give fewer stages, or fewer regions of an organ")?;
    let span_days = stages[stages.len() - 1].day - first_day;
    let laws = fit_rows(rows, span_days, spec.offset, run.cancel)?;
    let (schema, name, time) = (LAW_SCHEMA.into(), name.to_owned(), TimeUnit::Day);
    Ok(GrowthLaw { schema, name, first_day, span_days, time, regions, laws })
}

/// Fits a law to each series of sizes: days, increasing strictly, with values in metres. Series of one kind share
/// parameters that they determine together (`leaf-1` and `leaf-2` are leaves; `tree 3` is a tree).
///
/// # Errors
/// [`FitError`], as [`fit_logistic`](crate::fit_logistic), with fewer than 3 days in every series; a series of fewer is
/// left out. [`BloomError::OverBudget`], before anything is fitted, and [`BloomError::Cancelled`].
pub fn fit_sizes(
    name: &str,
    series: &[(String, Series)],
    offset: Offset,
    run: &Run<'_>,
) -> Result<GrowthLaw, BloomError> {
    let able = || series.iter().filter(|s| s.1.days.len() >= 3);
    let Some(first_day) = able().map(|s| s.1.days[0]).reduce(f64::min) else {
        let most = series.iter().map(|s| s.1.days.len()).max().unwrap_or(0);
        return Err(FitError::TooFew { got: most }.into());
    };
    let last = able().filter_map(|s| s.1.days.last()).fold(first_day, |a, &b| a.max(b));
    let rows = able().map(|(organ, series)| Measured {
        organ: organ.clone(),
        region: 0,
        axis: Quantity::Size,
        series: Series {
            days: series.days.iter().map(|d| d - first_day).collect(),
            values: series.values.clone(),
        },
    });
    let rows: Vec<Measured> = rows.collect();
    check_sizes(&rows, run, "split the table, or give fewer days of each organ")?;
    let laws = fit_rows(rows, last - first_day, offset, run.cancel)?;
    let (schema, name, time) = (LAW_SCHEMA.into(), name.to_owned(), TimeUnit::Day);
    Ok(GrowthLaw { schema, name, first_day, span_days: last - first_day, time, regions: 1, laws })
}

/// Returns the kind of an organ: its name without number, plant and the mark of a new one (`new-leaf-4` is a `leaf`,
/// and so is `plant 3: leaf-2`).
fn kind_of(organ: &str) -> &str {
    let organ = organ.rsplit(": ").next().unwrap_or(organ);
    let name = organ.strip_prefix("new-").unwrap_or(organ);
    name.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches(['-', '_', ' '])
}

/// Checks the number of comparisons of sizes with laws against the budget, before any is made.
fn check_sizes(rows: &[Measured], run: &Run<'_>, remedy: &'static str) -> Result<(), BloomError> {
    let sizes: u64 = rows.iter().map(|r| r.series.values.len() as u64).sum();
    run.budget.check(Counted::Comparisons, sizes.saturating_mul(curves_compared()), remedy)?;
    Ok(())
}

/// One series before its law is known.
#[derive(Clone, Debug)]
pub(crate) struct Measured {
    pub(crate) organ: String,
    pub(crate) region: usize,
    pub(crate) axis: Quantity,
    pub(crate) series: Series,
}

/// Fits laws to all series, in their order. Those of one kind of organ and one axis share rate and time; if no shared
/// law is determined, a series of 5 values or more may determine one of its own.
pub(crate) fn fit_rows(
    rows: Vec<Measured>,
    span: f64,
    offset: Offset,
    cancel: &CancelToken,
) -> Result<Vec<RegionLaw>, BloomError> {
    let group = |r: &Measured| (kind_of(&r.organ).to_owned(), r.axis);
    let groups: Vec<(String, Quantity)> = rows.iter().map(group).collect();
    let mut order: Vec<usize> = (0..rows.len()).collect();
    base::sort_by(&mut order, |&a, &b| groups[a].cmp(&groups[b]).then(a.cmp(&b)));
    let mut laws: Vec<Option<RegionLaw>> = vec![None; rows.len()];
    for mine in order.chunk_by(|&a, &b| groups[a] == groups[b]) {
        let series: Vec<Series> = mine.iter().map(|&i| rows[i].series.clone()).collect();
        // Regions of one organ are left out together.
        let mut organs: Vec<&str> = mine.iter().map(|&i| rows[i].organ.as_str()).collect();
        organs.dedup();
        let whose: Vec<usize> = mine
            .iter()
            .map(|&i| organs.iter().position(|name| *name == rows[i].organ).unwrap_or(0))
            .collect();
        let choice = choose(&series, &whose, cancel)?;
        for (k, &i) in mine.iter().enumerate() {
            let law = row(&rows[i], choice.as_ref().map(|c| (c, k)), (span, offset), cancel)?;
            laws[i] = Some(if law.is_finite(span) { law } else { law.straightened(span) });
        }
    }
    Ok(laws.into_iter().flatten().collect())
}

/// Returns the mean position of each region from the base; an empty region takes that of the one before.
fn region_means(organ: &ScanOrgan, regions: usize) -> Vec<DVec3> {
    let mut last = DVec3::ZERO;
    organ
        .regions(regions)
        .into_iter()
        .map(|rows| {
            if !rows.is_empty() {
                last = rows.iter().map(|&i| organ.points[i] - organ.base).sum::<DVec3>() / rows.len() as f64;
            }
            last
        })
        .collect()
}

/// Makes the law of one series: its own if its days determine that better than the shared one of its kind.
fn row(
    of: &Measured,
    choice: Option<(&Choice, usize)>,
    (span, offset): (f64, Offset),
    cancel: &CancelToken,
) -> Result<RegionLaw, BloomError> {
    let Series { days, values } = &of.series;
    let n = values.len();
    let is_wanted = || cancel.check().map_err(BloomError::from);
    let fit: Fit = if n > 3 {
        fit_logistic_while(days, values, offset, is_wanted)?
    } else {
        fit_law(days, values, offset)?
    };
    let mut out = RegionLaw {
        organ: of.organ.clone(),
        region: of.region,
        axis: of.axis,
        form: Form::Logistic,
        law: fit.law,
        determined: Some(false),
        straight_rmse: None,
        last_rmse: None,
        standard_errors: fit.standard_errors,
        // The constant under its own logistic is not fitted.
        value_errors: fit.standard_errors.map(|[k, p0, _]| [k, p0]),
        r2: fit.r2,
        r2_adjusted: fit.r2_adjusted,
        loo_rmse: fit.loo_rmse,
        days: days.clone(),
        values: values.clone(),
    };
    out.last_rmse = rms_of(&left_out_of_last(&of.series));
    let Some((choice, k)) = choice else { return Ok(out) };
    let one = core::slice::from_ref(&of.series);
    let Some(mut line) = fit_shared(Form::Straight, true, one, cancel)? else { return Ok(out) };
    Sittings::new(one, &[0]).leave_out(&mut line, one, cancel)?;
    out.straight_rmse = line.loo_rmse();
    let shared = rms_of(&choice.fit.left_out[k]);
    if is_own(&fit, (&of.series, &line), span) && (!choice.determined || fit.loo_rmse < shared) {
        out.determined = Some(true);
        return Ok(out);
    }
    if !choice.determined && out.last_rmse < out.straight_rmse {
        let (first, last) = (values[0], values[n - 1]);
        out.form = Form::Still;
        out.law = Logistic { k: last, p0: first, r: 0.0, offset: 0.0 };
        (out.r2, out.r2_adjusted, out.loo_rmse) = (0.0, None, out.last_rmse);
        (out.standard_errors, out.value_errors) = (None, None);
        return Ok(out);
    }
    let at = |day: f64| choice.fit.value(k, day);
    let [_, b] = choice.fit.linear[k];
    let (form, r) = (choice.fit.form, choice.fit.r);
    out.form = form;
    out.law = match form {
        Form::Straight | Form::Still => Logistic { k: at(span), p0: at(0.0), r: b, offset: 0.0 },
        _ => {
            let [k_final, p0] = choice.fit.states(k);
            Logistic { k: k_final, p0, r, offset: at(0.0) - p0 }
        }
    };
    let mean = values.iter().sum::<f64>() / n as f64;
    let sst: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    let sse: f64 = days.iter().zip(values).map(|(&d, v)| (at(d) - v) * (at(d) - v)).sum();
    out.r2 = if sst > 0.0 { 1.0 - sse / sst } else { 1.0 };
    out.r2_adjusted = None;
    out.loo_rmse = shared;
    out.determined = Some(choice.determined);
    let errors = choice.fit.errors.as_ref().filter(|_| choice.determined);
    out.standard_errors = errors.map(|e| [e.states[k][0], e.states[k][1], e.rate]);
    out.value_errors = errors.map(|e| e.values[k]);
    Ok(out)
}

/// Whether the days of a series determine its own logistic: by the rule of [`Choice::determined`].
fn is_own(fit: &Fit, (series, straight): (&Series, &SharedFit), span: f64) -> bool {
    let n = series.values.len();
    if n < 4 || fit.law.on_bound(span) {
        return false;
    }
    // A fit through every value leaves no error to compare.
    if fit.loo_rmse.is_some_and(|e| e <= 1e-9 * series.values[n - 1].abs()) {
        return true;
    }
    let is_sure = fit.standard_errors.is_some_and(|[_, _, r]| fit.law.r.abs() > 2.0 * r);
    #[expect(clippy::cast_possible_wrap, reason = "a count of values")]
    let freedom = n as i64 - 3;
    let gains = |rival: &[Option<f64>]| -> Vec<f64> {
        let pairs = fit.left_out.iter().zip(rival);
        pairs.filter_map(|(own, rival)| Some(rival.as_ref()? * rival.as_ref()? - own * own)).collect()
    };
    let earned = |rival: &[Option<f64>]| earns(gains(rival).into_iter());
    is_sure
        && bends([(straight.sse, straight.freedom), (fit.sse, freedom)])
        && earned(&straight.left_out[0])
        && earned(&left_out_of_mean(series))
}

/// Returns the root mean square of left-out errors; `None` if there are none.
fn rms_of(errors: &[Option<f64>]) -> Option<f64> {
    rms(errors.iter().flatten().copied())
}

#[cfg(test)]
mod trials;

#[cfg(test)]
mod tests {
    use super::*;
    use base::{Draw, Seed};

    /// Makes a straight organ whose tip moves by a known law.
    fn stage(day: f64, law: &Logistic) -> Stage {
        let mut s = Seed::new(9).stream(Draw::Test);
        let length = law.value(day);
        let way: Vec<f64> = (0..900).map(|_| s.uniform()).collect();
        let points = way.iter().map(|w| DVec3::new(w * length, 0.3 * w * length, 0.0) + DVec3::ONE).collect();
        let organ = ScanOrgan {
            name: "petal".into(),
            colors: Vec::new(),
            rows: (0..900).collect(),
            points,
            way,
            base: DVec3::ONE,
            tip: DVec3::ONE + DVec3::X * length,
            ..ScanOrgan::default()
        };
        Stage { day: day + 100.0, organs: vec![organ] }
    }

    #[test]
    fn a_curve_whose_numbers_are_none_becomes_a_straight_line() {
        let curve = RegionLaw {
            form: Form::Gompertz,
            law: Logistic { k: 2.0, p0: 0.0, r: 1e19, offset: 0.0 },
            days: vec![0.0, 2e-16, 4e-16],
            values: vec![1.0, 1.5, 2.0],
            ..GrowthLaw::logistic("a", 1.0, 1.0).laws.remove(0)
        };
        assert!(!curve.is_finite(4e-16));
        let line = curve.straightened(4e-16);
        assert!(line.is_finite(4e-16) && !line.is_determined());
        assert_eq!([line.value(0.0), line.value(4e-16)], [1.0, 2.0]);
    }

    #[test]
    fn the_law_that_made_the_stages_is_found_and_drives_between() {
        let truth = Logistic { k: 0.06, p0: 0.01, r: 0.6, offset: 0.0 };
        let stages: Vec<Stage> = [0.0, 1.0, 2.0, 4.0, 6.0, 9.0].iter().map(|&d| stage(d, &truth)).collect();
        let law = fit_stages("made", &stages, &LawSpec::default(), &Run::plain()).unwrap();
        assert_eq!((law.laws.len(), law.first_day, law.span_days), (10, 100.0, 9.0));
        assert_eq!(law.validate().count(), 0);
        for l in law.laws.iter().filter(|l| l.axis != Quantity::Z) {
            assert!((l.law.r - 0.6).abs() < 1e-5 && l.r2 > 0.999_999, "{l:?}");
            assert!(l.loo_rmse.unwrap() < 1e-6, "{l:?}");
        }
        for day in [0.0, 1.5, 3.0, 9.0] {
            let want = (truth.value(day) - 0.01) / (truth.value(9.0) - 0.01);
            for axis in Quantity::AXES {
                let got = law.progress("petal", axis, 0.8, 0.0, 9.0, day);
                assert!((got - want).abs() < 1e-5, "{axis:?} at {day}: {got} {want}");
            }
            let other = law.progress("sepal", Quantity::X, 0.2, 0.0, 9.0, day);
            assert!((other - want).abs() < 1e-5, "another species follows the same law");
        }
    }

    #[test]
    fn a_law_survives_its_file_and_broken_ones_are_named() {
        let mut law = GrowthLaw::logistic("lily", 6.0, 0.9);
        let text = serde_json::to_string(&law).unwrap();
        assert!(text.contains("\"K\":1.0"), "{text}");
        assert_eq!(serde_json::from_str::<GrowthLaw>(&text).unwrap(), law);
        law.laws[0].law.r = f64::NAN;
        law.span_days = -1.0;
        law.schema = "x".into();
        let faults: Vec<LawFault> = law.validate().collect();
        assert!(
            faults.contains(&LawFault::Schema("x".into())) && faults.contains(&LawFault::Span),
            "{faults:?}"
        );
        assert!(faults.contains(&LawFault::Row(0)), "{faults:?}");
    }

    #[test]
    fn too_few_stages_and_days_out_of_order() {
        let l = Logistic { k: 1.0, p0: 0.1, r: 1.0, offset: 0.0 };
        let two = [stage(0.0, &l), stage(1.0, &l)];
        let fit = |s: &[Stage]| fit_stages("x", s, &LawSpec::default(), &Run::plain()).unwrap_err();
        assert_eq!(fit(&two), BloomError::Fit(FitError::TooFew { got: 2 }));
        let disorder = [stage(0.0, &l), stage(2.0, &l), stage(1.0, &l)];
        assert_eq!(fit(&disorder), BloomError::Fit(FitError::Order { day: 101.0, before: 102.0 }));
    }

    #[test]
    fn a_table_that_is_too_long_is_refused_before_it_is_fitted() {
        let days: Vec<f64> = (0..10).map(f64::from).collect();
        let plant = |k: usize| (format!("plant {k}"), Series { days: days.clone(), values: days.clone() });
        let most = Counted::Comparisons.limit() / curves_compared();
        assert_eq!(most, 48_871, "as docs/limits.md has it");
        let series: Vec<_> = (0..4_888).map(plant).collect();
        let start = std::time::Instant::now();
        let BloomError::OverBudget(much) = fit_sizes("x", &series, Offset::Auto, &Run::plain()).unwrap_err()
        else {
            panic!("not too much");
        };
        assert_eq!((much.what, much.number), (Counted::Comparisons, 48_880 * curves_compared()));
        assert!(start.elapsed().as_secs() < 5, "{:?}", start.elapsed());
        // Whatever the budget, the remaining few are fitted.
        assert!(fit_sizes("x", &series[..3], Offset::Auto, &Run::plain()).is_ok());
    }

    #[test]
    fn a_fit_that_is_stopped_gives_no_law() {
        let l = Logistic { k: 1.0, p0: 0.1, r: 1.0, offset: 0.0 };
        let days = [0.0, 1.0, 2.0, 4.0, 6.0];
        let stages: Vec<Stage> = days.iter().map(|&d| stage(d, &l)).collect();
        let values = days.iter().map(|&d| l.value(d)).collect();
        let series = [("leaf-1".to_owned(), Series { days: days.to_vec(), values })];
        let cancel = CancelToken::new();
        let stopped = Run { cancel: &cancel, ..Run::plain() };
        assert!(fit_sizes("x", &series, Offset::Auto, &stopped).is_ok());
        cancel.cancel();
        assert_eq!(fit_stages("x", &stages, &LawSpec::default(), &stopped), Err(BloomError::Cancelled));
        assert_eq!(fit_sizes("x", &series, Offset::Auto, &stopped), Err(BloomError::Cancelled));
    }
}
