//! Fits a curve to each group of plants, and tests whether one curve would do for all.
//!
//! All groups have one form of curve, each with its own parameters. The test compares them with one curve for all: the
//! extra sum of squares (Bates and Watts 1988, section 3.10) as F. Values of one plant are correlated, which F takes
//! for evidence; so plants are also permuted among groups at random, as often as the budget allows.

use base::{CancelToken, Counted, Draw, Run, Seed, ops};

use crate::forms::{curves_compared, curves_of, rms};
use crate::left_out::{Sittings, left_out_of_mean};
use crate::tails::tail_of_f;
use crate::{
    BloomError, FitError, Form, GrowthLaw, LAW_SCHEMA, Logistic, Quantity, RegionLaw, Series, SharedFit,
    fit_shared,
};

/// Measurements of the plants of one group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlantGroup {
    /// Its name.
    pub name: String,
    /// A series for each plant; days in any order, also the same day twice. Values in metres.
    pub plants: Vec<Series>,
}

/// Test of whether groups grow alike.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupTest {
    /// Sum of squared residuals of one curve for all groups, and of a curve for each, square metres.
    pub squares: [f64; 2],
    /// Degrees of freedom: the additional parameters of separate curves, and the remaining ones of the values.
    pub freedom: [u32; 2],
    /// The extra sum of squares over that of separate curves, both by their degrees of freedom.
    pub f: f64,
    /// Probability of an F at least this large if all groups grow alike and all values are independent: plants measured
    /// once.
    pub p: f64,
    /// Result of random permutations of plants among groups, valid also for plants that were measured repeatedly.
    /// `None` for too few plants, or too many values.
    pub permuted: Option<Permuted>,
}

/// Result of permuting plants among groups.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Permuted {
    /// Number of permutations.
    pub times: u32,
    /// Share of the permutations, including the observed one, in which the groups fit as well.
    pub p: f64,
}

/// Curves of groups, and the test of their difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Groups {
    /// A law for each group, with its name as organ.
    pub law: GrowthLaw,
    /// The test; `None` for one group.
    pub test: Option<GroupTest>,
}

/// Number of permutations: the least p is one in 200.
const PERMUTATIONS: u32 = 199;
/// Least number of permutations that are informative.
const FEWEST_PERMUTATIONS: u32 = 19;
/// Least number of days of a group with measurements.
const FEWEST_DAYS: usize = 3;

/// Fits a curve to each group: of the forms, common to all groups, the one with the least information criterion of
/// Akaike, corrected for few values (Hurvich and Tsai 1989).
///
/// Guaranteed: the same bits for the same groups and seed. Cost: some 11,000 curves for each value, and 2,000 more for
/// each permutation.
///
/// # Errors
/// [`FitError::TooFew`] for a group with fewer than 3 days; [`BloomError::OverBudget`], before anything is fitted, and
/// [`BloomError::Cancelled`].
pub fn fit_groups(
    name: &str,
    groups: &[PlantGroup],
    seed: Seed,
    run: &Run<'_>,
) -> Result<Groups, BloomError> {
    let all: Vec<&Series> = groups.iter().flat_map(|g| &g.plants).collect();
    let values: u64 = all.iter().map(|s| s.values.len() as u64).sum();
    let each = curves_compared();
    run.budget.check(Counted::Comparisons, 2 * values * each, "split the table, or give fewer days")?;
    let first_day = all.iter().flat_map(|s| &s.days).copied().fold(f64::INFINITY, f64::min);
    let last_day = all.iter().flat_map(|s| &s.days).copied().fold(f64::NEG_INFINITY, f64::max);
    let pooled: Vec<Series> = groups.iter().map(|g| joined(g.plants.iter(), first_day)).collect();
    for series in &pooled {
        let mut days = series.days.clone();
        days.dedup();
        if days.len() < FEWEST_DAYS {
            return Err(FitError::TooFew { got: days.len() }.into());
        }
    }
    let Some(best) = chosen(&pooled, run.cancel)? else {
        return Err(FitError::TooFew { got: pooled.len() }.into());
    };
    let span_days = last_day - first_day;
    let mut laws = Vec::with_capacity(groups.len());
    for ((group, series), fit) in groups.iter().zip(&pooled).zip(&best) {
        laws.push(law_of(group, series, fit, span_days, run.cancel)?);
    }
    let law = GrowthLaw {
        schema: LAW_SCHEMA.into(),
        name: name.to_owned(),
        first_day,
        span_days,
        time: base::TimeUnit::default(),
        regions: 1,
        laws,
    };
    let test = if groups.len() > 1 { test(groups, &pooled, &best, (first_day, seed), run)? } else { None };
    Ok(Groups { law, test })
}

/// Returns all values of some plants by day, from the first day on.
fn joined<'a>(plants: impl Iterator<Item = &'a Series>, first_day: f64) -> Series {
    let mut pairs: Vec<(f64, f64)> = plants
        .flat_map(|s| s.days.iter().zip(&s.values))
        .map(|(&day, &value)| (day - first_day, value))
        .collect();
    base::sort_by(&mut pairs, |a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let (days, values) = pairs.into_iter().unzip();
    Series { days, values }
}

/// Fits a curve of one form to each group; `None` if it is constant on the days of one.
fn fits(
    (form, level): (Form, bool),
    pooled: &[Series],
    cancel: &CancelToken,
) -> Result<Option<Vec<SharedFit>>, BloomError> {
    let mut out = Vec::with_capacity(pooled.len());
    for series in pooled {
        match fit_shared(form, level, core::slice::from_ref(series), cancel)? {
            Some(fit) => out.push(fit),
            None => return Ok(None),
        }
    }
    Ok(Some(out))
}

/// Returns the fits of the form with the least criterion.
fn chosen(pooled: &[Series], cancel: &CancelToken) -> Result<Option<Vec<SharedFit>>, BloomError> {
    let values: usize = pooled.iter().map(|s| s.values.len()).sum();
    let laws = Form::LAWS.iter().flat_map(|&form| [(form, false), (form, true)]);
    let mut best: Option<(f64, Vec<SharedFit>)> = None;
    for of in laws.chain([(Form::Straight, true)]) {
        let Some(found) = fits(of, pooled, cancel)? else { continue };
        let criterion = criterion(&found, values);
        let is_able = of.0 == Form::Straight || found.iter().all(|f| !f.on_bound && f.freedom > 0);
        if is_able && best.as_ref().is_none_or(|(least, _)| criterion < *least) {
            best = Some((criterion, found));
        }
    }
    Ok(best.map(|b| b.1))
}

/// Returns Akaike's criterion for few values; the scatter is one of the parameters.
fn criterion(fits: &[SharedFit], values: usize) -> f64 {
    let n = values as f64;
    let squares: f64 = fits.iter().map(|f| f.sse).sum();
    let freedom: f64 = fits.iter().map(|f| f.freedom as f64).sum();
    let k = n - freedom + 1.0;
    let few = if n - k - 1.0 > 0.0 { 2.0 * k * (k + 1.0) / (n - k - 1.0) } else { f64::INFINITY };
    n * ops::ln((squares / n).max(f64::MIN_POSITIVE)) + 2.0 * k + few
}

fn law_of(
    group: &PlantGroup,
    series: &Series,
    fit: &SharedFit,
    span: f64,
    cancel: &CancelToken,
) -> Result<RegionLaw, BloomError> {
    let one = core::slice::from_ref(series);
    // A day of a group is left out with all of its plants.
    let (sittings, mut fit) = (Sittings::new(one, &[0]), fit.clone());
    sittings.leave_out(&mut fit, one, cancel)?;
    let mut straight_rmse = None;
    let mut predicts_better = false;
    if let Some(mut line) = fit_shared(Form::Straight, true, one, cancel)? {
        sittings.leave_out(&mut line, one, cancel)?;
        straight_rmse = line.loo_rmse();
        predicts_better = sittings.earn(&fit.left_out, &line.left_out)
            && sittings.earn(&fit.left_out, &[left_out_of_mean(series)]);
    }
    let at = |day: f64| fit.value(0, day);
    let [_, slope] = fit.linear[0];
    let law = match fit.form {
        Form::Straight | Form::Still => Logistic { k: at(span), p0: at(0.0), r: slope, offset: 0.0 },
        _ => {
            let [k, p0] = fit.states(0);
            Logistic { k, p0, r: fit.r, offset: at(0.0) - p0 }
        }
    };
    let values = &series.values;
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let total: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    let is_curve = fit.form != Form::Straight;
    let errors = fit.errors.as_ref().filter(|_| is_curve);
    let value_errors = errors.map(|e| e.values[0]);
    let errors = errors.map(|e| [e.states[0][0], e.states[0][1], e.rate]);
    let is_sure = errors.is_some_and(|[_, _, r]| fit.r.abs() > 2.0 * r);
    Ok(RegionLaw {
        organ: group.name.clone(),
        region: 0,
        axis: Quantity::Size,
        form: fit.form,
        law,
        determined: Some(is_curve && is_sure && predicts_better),
        straight_rmse,
        last_rmse: None,
        standard_errors: errors,
        value_errors,
        r2: if total > 0.0 { 1.0 - fit.sse / total } else { 1.0 },
        r2_adjusted: None,
        loo_rmse: rms(fit.left_out[0].iter().flatten().copied()),
        days: series.days.clone(),
        values: values.clone(),
    })
}

fn test(
    groups: &[PlantGroup],
    pooled: &[Series],
    best: &[SharedFit],
    (first_day, seed): (f64, Seed),
    run: &Run<'_>,
) -> Result<Option<GroupTest>, BloomError> {
    let form = (best[0].form, best[0].level);
    let whole = joined(groups.iter().flat_map(|g| &g.plants), first_day);
    let Some(one) = fits(form, &[whole], run.cancel)? else { return Ok(None) };
    let squares = [one[0].sse, best.iter().map(|f| f.sse).sum()];
    let left: i64 = best.iter().map(|f| f.freedom).sum();
    let (Ok(more), Ok(left)) = (u32::try_from(one[0].freedom - left), u32::try_from(left)) else {
        return Ok(None);
    };
    if more == 0 || left == 0 {
        return Ok(None);
    }
    let (d1, d2) = (f64::from(more), f64::from(left));
    let extra = (squares[0] - squares[1]).max(0.0);
    let f = (extra / d1) / (squares[1] / d2).max(f64::MIN_POSITIVE);
    let p = tail_of_f(f, [d1, d2]);
    let values: u64 = pooled.iter().map(|s| s.values.len() as u64).sum();
    let permuted = permuted(groups, form, squares[1], (first_day, values, seed), run)?;
    Ok(Some(GroupTest { squares, freedom: [more, left], f, p, permuted }))
}

/// Permutes plants among groups, and counts how often the new groups fit as well.
fn permuted(
    groups: &[PlantGroup],
    form: (Form, bool),
    found: f64,
    (first_day, values, seed): (f64, u64, Seed),
    run: &Run<'_>,
) -> Result<Option<Permuted>, BloomError> {
    let sizes: Vec<usize> = groups.iter().map(|g| g.plants.len()).collect();
    let mut plants: Vec<&Series> = groups.iter().flat_map(|g| &g.plants).collect();
    // Half of the budget; each fit searches the whole grid of one form.
    let half = run.budget.limit(Counted::Comparisons) / 2;
    let affordable = half / (values.max(1) * curves_of(form.0, form.1)).max(1);
    let times = u32::try_from(affordable).unwrap_or(u32::MAX).min(PERMUTATIONS);
    if times < FEWEST_PERMUTATIONS || ways(&sizes) < f64::from(FEWEST_PERMUTATIONS + 1) {
        return Ok(None);
    }
    let mut stream = seed.stream(Draw::Test);
    let mut as_well = 1;
    for _ in 0..times {
        run.cancel.check()?;
        for k in (1..plants.len()).rev() {
            plants.swap(k, stream.below(k + 1));
        }
        let mut rest = plants.as_slice();
        let mut mixed = Vec::with_capacity(sizes.len());
        for &size in &sizes {
            let (own, others) = rest.split_at(size);
            mixed.push(joined(own.iter().copied(), first_day));
            rest = others;
        }
        let squares: Option<f64> = fits(form, &mixed, run.cancel)?.map(|f| f.iter().map(|f| f.sse).sum());
        // Groups to which no curve of the form can be fitted show no difference.
        as_well += u32::from(squares.is_some_and(|s| s <= found * (1.0 + 1e-9)));
    }
    Ok(Some(Permuted { times, p: f64::from(as_well) / f64::from(times + 1) }))
}

/// Returns the number of ways to divide plants among groups of these sizes.
fn ways(sizes: &[usize]) -> f64 {
    let (mut all, mut ways) = (0, 1.0);
    for &size in sizes {
        for k in 1..=size {
            all += 1;
            ways *= f64::from(all) / k as f64;
        }
    }
    ways
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normal(s: &mut base::Stream) -> f64 {
        (0..4).map(|_| s.range(-0.5, 0.5)).sum::<f64>() * 3.0_f64.sqrt()
    }

    /// Makes plants of a logistic; each is larger or smaller as a whole by `own`.
    fn group(name: &str, truth: &Logistic, own: f64, plants: usize, seed: u64) -> PlantGroup {
        let mut s = Seed::new(seed).stream(Draw::Test);
        let plant = |_| {
            let size = 1.0 + own * normal(&mut s);
            let days: Vec<f64> = (0..7).map(|d| 5.0 * f64::from(d)).collect();
            let values = days.iter().map(|&d| size * truth.value(d) + 0.8 * normal(&mut s)).collect();
            Series { days, values }
        };
        PlantGroup { name: name.into(), plants: (0..plants).map(plant).collect() }
    }

    const TALL: Logistic = Logistic { k: 60.0, p0: 4.0, r: 0.25, offset: 0.0 };
    const SHORT: Logistic = Logistic { k: 50.0, p0: 4.0, r: 0.25, offset: 0.0 };

    /// Allows some 40 permutations, which take a second and not ten.
    fn brief() -> Run<'static> {
        Run { budget: base::Budget { times: 0.03, raise: None }, ..Run::plain() }
    }

    #[test]
    fn groups_that_grow_apart_are_told_apart() {
        let groups = [group("a", &TALL, 0.0, 6, 1), group("b", &SHORT, 0.0, 6, 2)];
        let found = fit_groups("t", &groups, Seed::new(1), &brief()).unwrap();
        let test = found.test.unwrap();
        assert!(test.p < 1e-6 && test.permuted.is_some_and(|p| p.times > 30 && p.p < 0.035), "{test:?}");
        for (law, truth) in found.law.laws.iter().zip([TALL, SHORT]) {
            assert!(law.is_determined() && law.form == Form::Logistic, "{law:?}");
            assert!((law.final_value().unwrap() - truth.k).abs() < 2.0, "{law:?}");
        }
        assert_eq!(found.law.validate().count(), 0);
        let again = fit_groups("t", &groups, Seed::new(1), &brief()).unwrap();
        assert_eq!(again.test, Some(test));
    }

    /// Plants of one kind differ as wholes: F finds groups where there are none, and permutations do not.
    #[test]
    fn plants_that_differ_are_no_groups() {
        let (mut by_f, mut by_plants) = (0, 0);
        for seed in 0..20 {
            let both = [group("a", &TALL, 0.1, 4, 2 * seed), group("b", &TALL, 0.1, 4, 2 * seed + 1)];
            let test = fit_groups("t", &both, Seed::new(seed), &brief()).unwrap().test.unwrap();
            by_f += u32::from(test.p < 0.05);
            by_plants += u32::from(test.permuted.unwrap().p < 0.05);
        }
        println!("told apart: {by_f} of 20 by F, {by_plants} of 20 by plants");
        assert!(by_plants <= 4 && by_f > by_plants, "{by_f} {by_plants}");
    }

    #[test]
    fn a_group_of_two_days_is_too_little() {
        let two = Series { days: vec![0.0, 1.0, 1.0], values: vec![1.0, 2.0, 2.1] };
        let groups = [group("a", &TALL, 0.0, 2, 1), PlantGroup { name: "b".into(), plants: vec![two] }];
        let failed = fit_groups("t", &groups, Seed::new(1), &brief()).unwrap_err();
        assert_eq!(failed, BloomError::Fit(FitError::TooFew { got: 2 }));
        assert_eq!(ways(&[2, 2]), 6.0);
    }
}
