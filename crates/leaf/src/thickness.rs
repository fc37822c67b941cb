//! What a measured thickness means.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a measured thickness is to its vein's ball.
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
    /// The radius of the ball of a vein that is 1 thick.
    pub const fn radius(self) -> f64 {
        match self {
            Self::Diameter => 0.5,
            Self::Radius => 1.0,
        }
    }
}
