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
