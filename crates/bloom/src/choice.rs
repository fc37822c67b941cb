//! Chooses the law that predicts series of one kind best, or straight lines.

use base::{CancelToken, Cancelled};

use crate::left_out::{Sittings, left_out_of_mean};
use crate::tails::tail_of_f;
use crate::{Form, Series, SharedFit, fit_shared};

/// The law that predicts series best, with its comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The best law, or the straight lines.
    pub fit: SharedFit,
    /// Whether the days determine the law: it predicts left-out values better than straight lines and than the mean of
    /// the others, each by more than one standard error of that difference; it fits better than straight lines by more
    /// than chance; its rate is two standard errors from 0; it has a degree of freedom and is on no bound.
    pub determined: bool,
    /// Leave-one-out error of straight lines.
    pub straight_rmse: Option<f64>,
}

/// Chooses by leave-one-out among the three laws, with and without a level, and straight lines.
///
/// `organs` has one entry per series: series of one organ have the same. All values of an organ on one day are left out
/// together, since what shifts one of them shifts the others. `None` without a series of 2 distinct days.
///
/// # Errors
/// [`Cancelled`].
pub fn choose(all: &[Series], organs: &[usize], cancel: &CancelToken) -> Result<Option<Choice>, Cancelled> {
    let Some(mut straight) = fit_shared(Form::Straight, true, all, cancel)? else { return Ok(None) };
    let sittings = Sittings::new(all, organs);
    sittings.leave_out(&mut straight, all, cancel)?;
    let straight_rmse = straight.loo_rmse();
    let still = all.iter().map(left_out_of_mean).collect::<Vec<_>>();
    let mut fits = Vec::new();
    for (&form, level) in Form::LAWS.iter().flat_map(|form| [(form, false), (form, true)]) {
        fits.extend(fit_shared(form, level, all, cancel)?);
    }
    // A rate within two standard errors of 0 does not distinguish a curve from a line.
    fits.retain(|f: &SharedFit| {
        let sure = f.errors.as_ref().is_some_and(|e| f.r > 2.0 * e.rate);
        f.freedom > 0 && !f.on_bound && sure && bends([(straight.sse, straight.freedom), (f.sse, f.freedom)])
    });
    for fit in &mut fits {
        sittings.leave_out(fit, all, cancel)?;
    }
    let able = fits
        .into_iter()
        .filter(|f| sittings.earn(&f.left_out, &straight.left_out) && sittings.earn(&f.left_out, &still));
    let loo = |f: &SharedFit| f.loo_rmse().unwrap_or(f64::INFINITY);
    Ok(Some(match able.min_by(|a, b| loo(a).total_cmp(&loo(b))) {
        Some(fit) => Choice { fit, determined: true, straight_rmse },
        None => Choice { fit: straight, determined: false, straight_rmse },
    }))
}

/// Significance level at which a curve with more parameters fits better than a straight line.
pub(crate) const BENDS: f64 = 0.05;

/// Whether a curve fits better than straight lines by more than chance: extra sum of squares (Bates and Watts 1988),
/// for a curve with more parameters. Each fit is given by its sum of squares and its degrees of freedom, the lines
/// first.
pub(crate) fn bends([(straight, straight_freedom), (curve, freedom)]: [(f64, i64); 2]) -> bool {
    let extra = (straight_freedom - freedom) as f64;
    if extra < 0.5 {
        return curve < straight;
    }
    let f = ((straight - curve) / extra) / (curve / freedom as f64).max(f64::MIN_POSITIVE);
    tail_of_f(f, [extra, freedom as f64]) < BENDS
}
