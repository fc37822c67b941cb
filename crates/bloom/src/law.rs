//! Organs at several days -> growth laws, saved, plotted, and moved to another species.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::{BloomError, Fit, FitError, Logistic, Offset, Organ, fit_law, fit_logistic};

/// The value of [`GrowthLaw::schema`].
pub const LAW_SCHEMA: &str = "burgeon.law/1";

/// What a law describes.
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

    /// The word in files and plots.
    pub const fn word(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::Size => "size",
        }
    }
}

/// The law of one coordinate of one region of one organ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegionLaw {
    /// Name of the organ.
    pub organ: String,
    /// Region from 1 at the base; 0 for the whole organ.
    pub region: usize,
    /// What of it.
    pub axis: Quantity,
    /// K, p0, r and the constant under the curve; metres and days since the first stage.
    #[serde(flatten)]
    pub law: Logistic,
    /// Standard errors of K, p0 and r.
    pub standard_errors: Option<[f64; 3]>,
    /// Coefficient of determination.
    pub r2: f64,
    /// The same for the degrees of freedom; none with 3 stages.
    pub r2_adjusted: Option<f64>,
    /// Leave-one-out error, metres; none below 4 stages.
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
    /// Regions of each organ.
    pub regions: usize,
    /// Every law.
    pub laws: Vec<RegionLaw>,
}

impl GrowthLaw {
    /// A law without measurements: all of every organ follows one logistic from 10 % to nearly 100 %, faster for a
    /// greater `rate` per day.
    pub fn logistic(name: &str, span_days: f64, rate: f64) -> Self {
        let law = Logistic { k: 1.0, p0: 0.1, r: rate, offset: 0.0 };
        let row = RegionLaw {
            organ: "any".into(),
            region: 0,
            axis: Quantity::Size,
            law,
            standard_errors: None,
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
            regions: 1,
            laws: vec![row],
        }
    }

    /// Everything that makes a law read from a file useless: other schema, no law, numbers that are not finite.
    pub fn validate(&self) -> impl Iterator<Item = LawFault> + '_ {
        let head = (self.schema != LAW_SCHEMA).then(|| LawFault::Schema(self.schema.clone()));
        let span = !(self.span_days > 0.0 && self.span_days.is_finite() && self.first_day.is_finite());
        let rows = self.laws.iter().enumerate().filter_map(|(i, row)| {
            let l = row.law;
            let finite = [l.k, l.p0, l.r, l.offset].iter().all(|x| x.is_finite());
            let sound = finite
                && l.value(0.0).is_finite()
                && l.value(self.span_days).is_finite()
                && row.days.len() == row.values.len();
            (!sound).then_some(LawFault::Row(i))
        });
        head.into_iter()
            .chain(span.then_some(LawFault::Span))
            .chain((self.laws.is_empty() || self.regions == 0).then_some(LawFault::Empty))
            .chain(rows)
    }

    /// How far an organ is on its way from its shape at day `from` to that at day `to`: 0 and 1 at these days,
    /// monotone between (`g = (f(x) - f(from)) / (f(to) - f(from))`).
    ///
    /// `along` is the place on the organ, 0 at the base to 1 at the tip: between the middles of two regions their
    /// laws are blended. A law that hardly moves says nothing about pace: then the organ's size law speaks, then
    /// that of the other organs, then a straight line. An organ that the law does not know follows the first one
    /// that it knows: so a law moves to another species. Days are since the first stage.
    pub fn progress(&self, organ: &str, axis: Quantity, along: f64, from: f64, to: f64, day: f64) -> f64 {
        let straight = if to > from { (day - from) / (to - from) } else { 1.0 };
        let known = self.laws.iter().any(|l| l.organ == organ);
        let organ = if known { organ } else { self.laws.first().map_or("", |l| l.organ.as_str()) };
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

    /// [`progress`](Self::progress) of all three coordinates at once, each weighing as much as it moves: the pace
    /// of a place in a frame that turns with its organ.
    pub fn pace_at(&self, organ: &str, along: f64, from: f64, to: f64, day: f64) -> f64 {
        let known = self.laws.iter().any(|l| l.organ == organ);
        let name = if known { organ } else { self.laws.first().map_or("", |l| l.organ.as_str()) };
        let (mut sum, mut weights) = (0.0, 0.0);
        for axis in Quantity::AXES {
            let rows = self.laws.iter().filter(|l| l.organ == name && l.axis == axis);
            let way: f64 = rows.map(|l| (l.law.value(to) - l.law.value(from)).abs()).sum();
            if way.is_finite() {
                sum += way * self.progress(organ, axis, along, from, to, day);
                weights += way;
            }
        }
        let law = if weights > 0.0 {
            sum / weights
        } else {
            self.progress(organ, Quantity::Size, along, from, to, day)
        };
        // Three stages leave no degree of freedom: what they say of the pace is half believed, the other half is a
        // straight line.
        let determined = self.laws.iter().any(|l| l.days.len() != 3);
        let straight = if to > from { (day - from) / (to - from) } else { 1.0 };
        if determined { law } else { 0.5 * (law + straight) }
    }

    fn pace(&self, organ: &str, region: usize, axis: Quantity, from: f64, to: f64, day: f64) -> Option<f64> {
        let row = self.laws.iter().find(|l| l.organ == organ && l.region == region && l.axis == axis)?;
        row.pace(from, to, day)
    }

    /// Mean of the size laws of all organs.
    fn any_pace(&self, from: f64, to: f64, day: f64) -> Option<f64> {
        let rows = self.laws.iter().filter(|l| l.axis == Quantity::Size);
        let all: Vec<f64> = rows.filter_map(|l| l.pace(from, to, day)).collect();
        (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
    }
}

impl RegionLaw {
    fn pace(&self, from: f64, to: f64, day: f64) -> Option<f64> {
        let (a, b, x) = (self.law.value(from), self.law.value(to), self.law.value(day));
        let level = self.values.iter().map(|v| v.abs()).fold(a.abs().max(b.abs()), f64::max);
        // 3 % of its level: less is noise of the scan; and a law that does not follow its values is none.
        let moves = (b - a).abs() > 0.03 * level && self.r2 > 0.5;
        // Beyond the last stage growth goes on at most half as far again.
        moves.then(|| ((x - a) / (b - a)).clamp(-0.5, 1.5)).filter(|g| g.is_finite())
    }
}

/// What is wrong with a law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawFault {
    /// Not a law, or of a later version.
    #[error("its schema is {0:?}, not \"burgeon.law/1\"")]
    Schema(String),
    /// The span is no positive number.
    #[error("its span_days is not above 0")]
    Span,
    /// There is no law in it.
    #[error("it holds no law")]
    Empty,
    /// A law has numbers that are not finite, or columns of unequal length.
    #[error("law {0} (from 0) has numbers that are of no use")]
    Row(usize),
}

/// One day of a series: its organs, those that are the same carrying the same name on each day.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stage {
    /// The day, in any count.
    pub day: f64,
    /// What was measured.
    pub organs: Vec<Organ>,
}

/// How laws are fitted.
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

/// Fits a law to each organ that is there on at least 3 days: for each region the means of x, y and z from the
/// organ's base (Huai, Yang and Cai 2019, step 3), and the organ's size.
///
/// # Errors
/// [`FitError::TooFew`] below 3 stages, [`FitError::Order`] for days that do not increase, and for a coordinate
/// that changes its sign where the offset is [`Offset::Zero`].
pub fn fit_stages(name: &str, stages: &[Stage], spec: &LawSpec) -> Result<GrowthLaw, BloomError> {
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
    let mut laws = Vec::new();
    for name in names {
        let there: Vec<(f64, &Organ)> = stages
            .iter()
            .filter_map(|s| Some((s.day - first_day, s.organs.iter().find(|o| o.name == name)?)))
            .collect();
        if there.len() < 3 {
            continue;
        }
        let days: Vec<f64> = there.iter().map(|t| t.0).collect();
        let sizes: Vec<f64> = there
            .iter()
            .map(|(_, o)| {
                o.points.iter().map(|p| p.distance(o.base)).sum::<f64>() / o.points.len().max(1) as f64
            })
            .collect();
        laws.push(row(name, 0, Quantity::Size, &days, sizes, spec.offset)?);
        let means: Vec<Vec<DVec3>> = there.iter().map(|(_, o)| region_means(o, regions)).collect();
        for region in 0..regions {
            for (k, axis) in Quantity::AXES.into_iter().enumerate() {
                let values: Vec<f64> = means.iter().map(|m| m[region][k]).collect();
                laws.push(row(name, region + 1, axis, &days, values, spec.offset)?);
            }
        }
    }
    let span_days = stages[stages.len() - 1].day - first_day;
    Ok(GrowthLaw { schema: LAW_SCHEMA.into(), name: name.to_owned(), first_day, span_days, regions, laws })
}

/// Mean place of each region from the base; of an empty region that of the one before.
fn region_means(organ: &Organ, regions: usize) -> Vec<DVec3> {
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

fn row(
    organ: &str,
    region: usize,
    axis: Quantity,
    days: &[f64],
    values: Vec<f64>,
    offset: Offset,
) -> Result<RegionLaw, FitError> {
    let fit: Fit =
        if days.len() > 3 { fit_logistic(days, &values, offset)? } else { fit_law(days, &values, offset)? };
    Ok(RegionLaw {
        organ: organ.to_owned(),
        region,
        axis,
        law: fit.law,
        standard_errors: fit.standard_errors,
        r2: fit.r2,
        r2_adjusted: fit.r2_adjusted,
        loo_rmse: fit.loo_rmse,
        days: days.to_vec(),
        values,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::{Draw, Seed};

    /// A straight organ whose tip moves by a known law.
    fn stage(day: f64, law: &Logistic) -> Stage {
        let mut s = Seed::new(9).stream(Draw::Test);
        let length = law.value(day);
        let way: Vec<f64> = (0..900).map(|_| s.uniform()).collect();
        let points = way.iter().map(|w| DVec3::new(w * length, 0.3 * w * length, 0.0) + DVec3::ONE).collect();
        let organ = Organ {
            name: "petal".into(),
            rows: (0..900).collect(),
            points,
            way,
            base: DVec3::ONE,
            tip: DVec3::ONE + DVec3::X * length,
        };
        Stage { day: day + 100.0, organs: vec![organ] }
    }

    #[test]
    fn the_law_that_made_the_stages_is_found_and_drives_between() {
        let truth = Logistic { k: 0.06, p0: 0.01, r: 0.6, offset: 0.0 };
        let stages: Vec<Stage> = [0.0, 1.0, 2.0, 4.0, 6.0, 9.0].iter().map(|&d| stage(d, &truth)).collect();
        let law = fit_stages("made", &stages, &LawSpec::default()).unwrap();
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
        let fit = |s: &[Stage]| fit_stages("x", s, &LawSpec::default()).unwrap_err();
        assert_eq!(fit(&two), BloomError::Fit(FitError::TooFew { got: 2 }));
        let disorder = [stage(0.0, &l), stage(2.0, &l), stage(1.0, &l)];
        assert_eq!(fit(&disorder), BloomError::Fit(FitError::Order { day: 101.0, before: 102.0 }));
    }
}
