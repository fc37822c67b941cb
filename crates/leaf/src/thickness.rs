//! Meaning of a measured thickness.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Relation of a measured thickness to its vein's ball.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ThicknessRule {
    /// A calliper's reading: the ball's diameter.
    #[default]
    Diameter,
    /// The ball's radius, as the formulas take it.
    Radius,
}

impl ThicknessRule {
    /// Returns the radius of the ball of a vein with thickness 1.
    pub const fn radius(self) -> f64 {
        match self {
            Self::Diameter => 0.5,
            Self::Radius => 1.0,
        }
    }
}
