//! Fits a species to measured trees whose trees branch as they do.
//!
//! `plants -> Traits by order -> quantiles -> rules -> TreeSpec`, and back: trees of the spec -> Traits -> their
//! agreement.

mod agreement;
mod rules;
mod traits;

pub use agreement::{Agreement, agree};
pub use rules::{FittedSpecies, SpeciesError, SpeciesLimits, Unfitted, fit_species};
pub use traits::{OrderTraits, Trait, Traits};

/// Returns a quantile of sorted values, interpolated linearly. NaN if there are none.
pub(crate) fn quantile_of(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = share.clamp(0.0, 1.0) * last as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the last place")]
    let low = at as usize;
    base::ops::lerp(sorted[low], sorted[(low + 1).min(last)], at - low as f64)
}
