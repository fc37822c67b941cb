//! Errors of light computations.

use base::{Cancelled, OverBudget, Stopped};
use spec::RangeFault;

/// Reason why the absorption of a scene cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LightError {
    /// There is no surface.
    #[error("there is nothing that light falls on: the plant has no surface")]
    Empty,
    /// A coordinate is NaN, infinite or very large.
    #[error("triangle {triangle} has a corner that is no number or more than {most_m} m away")]
    FarAway {
        /// Row of the triangle.
        triangle: usize,
        /// The most that a coordinate may be.
        most_m: f64,
    },
    /// Light comes from below.
    #[error(
        "light comes from {elevation_deg:.1} degrees below the horizon: give an hour of the day at which the sun is up"
    )]
    BelowHorizon {
        /// Angle below the horizon, degrees.
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
        /// Mean number of surfaces that a line crosses.
        surfaces: f64,
        /// Crossings in one direction, millions.
        crossings: f64,
        /// The limit, millions.
        most: f64,
    },
    /// A limit of the budget was exceeded.
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

base::coded!(LightError {
    Self::Empty => "light-empty" {},
    Self::FarAway { triangle, most_m } => "light-far" { triangle, most_m },
    Self::BelowHorizon { elevation_deg } => "sun-below" { elevation_deg = format!("{elevation_deg:.1}") },
    Self::Dark => "no-light" {},
    Self::Crowded { surfaces, crossings, most } => "light-crowded" {
        surfaces = format!("{surfaces:.0}"), crossings = format!("{crossings:.0}"), most
    },
    Self::Cancelled(_) => "cancelled" {},
} wraps {
    Self::Range(e) => e, RangeFault;
    Self::OverBudget(e) => e, OverBudget;
});
