//! Leave-one-out predictions of an organ on a day: from all other values, without that day of the organ.

use base::{CancelToken, Cancelled};

use crate::forms::Linearised;
use crate::{Series, SharedFit, fit_shared};

/// Most values, times the number of left-out sets, for which all parameters are refitted each time. With more, a day of
/// an organ hardly moves the curve, and its effect follows from its leverage (`many_values_are_left_out_by_leverage`).
const LEFT_OUT_BY_REFIT: usize = 20_000;

/// Each value minus its prediction; `None` if the others determine none.
type LeftOut = Vec<Vec<Option<f64>>>;

/// The values of series by organ and day. One sitting is left out as a whole: the regions of a leaf on a day were
/// measured in one scan, and one of them would give away the others.
pub(crate) struct Sittings(Vec<Vec<(usize, usize)>>);

impl Sittings {
    /// Groups the values; `organs` gives the organ of each series.
    pub(crate) fn new(all: &[Series], organs: &[usize]) -> Self {
        let mut rows: Vec<(usize, f64, (usize, usize))> = Vec::new();
        for (k, (series, &organ)) in all.iter().zip(organs).enumerate() {
            rows.extend(series.days.iter().enumerate().map(|(i, &day)| (organ, day, (k, i))));
        }
        base::sort_by(&mut rows, |a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        let is_one = |a: &(usize, f64, (usize, usize)), b: &(usize, f64, (usize, usize))| {
            a.0 == b.0 && a.1.total_cmp(&b.1).is_eq()
        };
        Self(rows.chunk_by(is_one).map(|sitting| sitting.iter().map(|row| row.2).collect()).collect())
    }

    /// Computes the residual of each value without its sitting: exactly, by a fit of all parameters without it, or for
    /// very many values by leverage.
    pub(crate) fn leave_out(
        &self,
        fit: &mut SharedFit,
        all: &[Series],
        cancel: &CancelToken,
    ) -> Result<(), Cancelled> {
        let values: usize = all.iter().map(|s| s.values.len()).sum();
        // Lines share no parameter, and are cheap.
        let is_long = self.0.len().saturating_mul(values) > LEFT_OUT_BY_REFIT;
        fit.left_out = if is_long { by_leverage(fit, all) } else { self.by_refit(fit, all, cancel)? };
        Ok(())
    }

    fn by_refit(&self, fit: &SharedFit, all: &[Series], cancel: &CancelToken) -> Result<LeftOut, Cancelled> {
        let mut out: LeftOut = all.iter().map(|s| vec![None; s.values.len()]).collect();
        for sitting in &self.0 {
            let rest = without(all, sitting);
            let Some(again) = fit_shared(fit.form, fit.level, &rest, cancel)? else { continue };
            // More parameters than values: any curve fits the rest.
            if again.freedom < 0 {
                continue;
            }
            for &(k, i) in sitting {
                out[k][i] = Some(all[k].values[i] - again.value(k, all[k].days[i]));
            }
        }
        Ok(out)
    }

    /// Whether the mean of the squared errors falls by more than its standard error. Each sitting counts once.
    pub(crate) fn earn(&self, law: &[Vec<Option<f64>>], rival: &[Vec<Option<f64>>]) -> bool {
        let gains = self.0.iter().filter_map(|sitting| {
            let gain = |&(k, i): &(usize, usize)| {
                let (law, rival) = (law.get(k)?.get(i).copied()??, rival.get(k)?.get(i).copied()??);
                Some(rival * rival - law * law)
            };
            let each: Vec<f64> = sitting.iter().filter_map(gain).collect();
            (!each.is_empty()).then(|| each.iter().sum::<f64>() / each.len() as f64)
        });
        earns(gains)
    }
}

/// Returns series without some of their values.
fn without(all: &[Series], sitting: &[(usize, usize)]) -> Vec<Series> {
    let mut rest = all.to_vec();
    // From the last value on: the indices of those before it stay valid.
    for &(k, i) in sitting.iter().rev() {
        rest[k].days.remove(i);
        rest[k].values.remove(i);
    }
    rest
}

/// Returns each residual over the remaining share after its leverage (Allen 1974).
fn by_leverage(fit: &SharedFit, all: &[Series]) -> LeftOut {
    let Some(leverage) = Linearised::new(fit, all).map(|l| l.leverage(fit)) else {
        return all.iter().map(|s| vec![None; s.values.len()]).collect();
    };
    let of = |(k, (series, leverage)): (usize, (&Series, Vec<f64>))| {
        let rows = series.days.iter().zip(&series.values).zip(leverage);
        rows.map(|((&day, value), h)| (1.0 - h > 1e-9).then(|| (value - fit.value(k, day)) / (1.0 - h)))
            .collect()
    };
    all.iter().zip(leverage).enumerate().map(of).collect()
}

/// Returns each value minus the mean of the others of its series: the prediction without growth.
pub(crate) fn left_out_of_mean(s: &Series) -> Vec<Option<f64>> {
    let n = s.values.len() as f64;
    let sum: f64 = s.values.iter().sum();
    s.values.iter().map(|y| (n > 1.5).then(|| y - (sum - y) / (n - 1.0))).collect()
}

/// Returns each value minus the one before it, the first minus the next: the prediction by the last value.
pub(crate) fn left_out_of_last(s: &Series) -> Vec<Option<f64>> {
    let v = &s.values;
    let other = |i: usize| if i == 0 { v.get(1) } else { v.get(i - 1) };
    (0..v.len()).map(|i| other(i).map(|o| v[i] - o)).collect()
}

/// Whether the mean of the gains exceeds 0 by more than its standard error.
pub(crate) fn earns(gains: impl Iterator<Item = f64>) -> bool {
    let gains: Vec<f64> = gains.collect();
    let n = gains.len() as f64;
    if gains.len() < 3 {
        return false;
    }
    let mean = gains.iter().sum::<f64>() / n;
    let spread = gains.iter().map(|g| (g - mean) * (g - mean)).sum::<f64>() / (n * (n - 1.0));
    mean > spread.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Form;
    use base::{Draw, Seed};

    /// Makes two leaves of two regions each, grown by one rate, whose regions share the noise of their day.
    fn leaves(days: &[f64], seed: u64) -> (Vec<Series>, Vec<usize>) {
        let mut s = Seed::new(seed).stream(Draw::Test);
        let mut all = Vec::new();
        for size in [20.0, 14.0] {
            let noise: Vec<f64> = days.iter().map(|_| s.range(-0.6, 0.6)).collect();
            for region in [1.0, 0.6] {
                let grown = |day: f64| size * region * (1.0 - base::ops::exp(-0.4 * day)) + 2.0;
                let values = days.iter().zip(&noise).map(|(&d, n)| grown(d) + n).collect();
                all.push(Series { days: days.to_vec(), values });
            }
        }
        (all, vec![0, 0, 1, 1])
    }

    #[test]
    fn what_is_left_out_is_what_a_fit_without_that_day_of_the_organ_says() {
        let (all, organs) = leaves(&[0.0, 1.0, 3.0, 5.0, 8.0], 5);
        let sittings = Sittings::new(&all, &organs);
        assert_eq!(sittings.0.len(), 10, "five days of two leaves");
        let cancel = CancelToken::new();
        for form in [Form::Monomolecular, Form::Logistic, Form::Straight] {
            let mut fit = fit_shared(form, true, &all, &cancel).unwrap().unwrap();
            sittings.leave_out(&mut fit, &all, &cancel).unwrap();
            // The last day, too: the days of the others end before it.
            for day in [0, 2, 4] {
                let mut rest = all.clone();
                for series in &mut rest[2..] {
                    series.days.remove(day);
                    series.values.remove(day);
                }
                let without = fit_shared(form, true, &rest, &cancel).unwrap().unwrap();
                for k in [2, 3] {
                    let want = all[k].values[day] - without.value(k, all[k].days[day]);
                    assert_eq!(fit.left_out[k][day], Some(want), "{form:?}");
                }
            }
        }
    }

    #[test]
    fn values_that_alone_determine_a_number_have_no_prediction() {
        let (all, organs) = leaves(&[0.0, 2.0, 6.0], 1);
        // A single leaf: without one of its three days any rate fits the other two.
        let sittings = Sittings::new(&all[..2], &organs[..2]);
        let cancel = CancelToken::new();
        let mut fit = fit_shared(Form::Monomolecular, true, &all[..2], &cancel).unwrap().unwrap();
        sittings.leave_out(&mut fit, &all[..2], &cancel).unwrap();
        assert!(fit.left_out.iter().flatten().all(Option::is_none), "{fit:?}");
    }

    #[test]
    fn many_values_are_left_out_by_leverage() {
        let days: Vec<f64> = (0..140).map(|d| 0.1 * f64::from(d)).collect();
        let (all, _) = leaves(&days, 9);
        let (all, cancel) = (&all[..1], CancelToken::new());
        let sittings = Sittings::new(all, &[0]);
        for form in Form::LAWS {
            let mut fit = fit_shared(form, true, all, &cancel).unwrap().unwrap();
            sittings.leave_out(&mut fit, all, &cancel).unwrap();
            let exact = fit.loo_rmse().unwrap();
            fit.left_out = by_leverage(&fit, all);
            let near = fit.loo_rmse().unwrap();
            println!("{form:?}: {exact:.5} by refits, {near:.5} by leverage");
            assert!((near / exact - 1.0).abs() < 0.03, "{form:?}: {near} {exact}");
        }
    }
}
