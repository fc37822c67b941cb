//! Why there is no result.

use base::{Cancelled, OverBudget, Stopped};
use spec::RangeFault;

/// Why it is not known what a scene absorbs.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LightError {
    /// There is no surface.
    #[error("there is nothing that light falls on: the plant has no surface")]
    Empty,
    /// A coordinate is NaN, infinite or very large.
    #[error("triangle {triangle} has a corner that is no number or more than {most_m} m away")]
    FarAway {
        /// Its row.
        triangle: usize,
        /// The most that a coordinate may be.
        most_m: f64,
    },
    /// Light comes from below.
    #[error(
        "light comes from {elevation_deg:.1} degrees below the horizon: give an hour of the day at which the sun is up"
    )]
    BelowHorizon {
        /// How far below.
        elevation_deg: f64,
    },
    /// There is no light at all.
    #[error("there is no light: sky and sun together give 0 W/m2")]
    Dark,
    /// A number is out of its range.
    #[error(transparent)]
    Range(#[from] RangeFault),
    /// Lines cross too many surfaces.
    #[error(
        "a line of light would cross {surfaces:.0} surfaces in the mean, and there would be {crossings:.0} million crossings in one direction, more than {most} million: repeat the scene in larger cells, or use fewer rays"
    )]
    Crowded {
        /// In the mean.
        surfaces: f64,
        /// In one direction, millions.
        crossings: f64,
        /// The most, millions.
        most: f64,
    },
    /// It would be too much.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<Stopped> for LightError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Cancelled(c) => Self::Cancelled(c),
            Stopped::OverBudget(much) => Self::OverBudget(much),
        }
    }
}
