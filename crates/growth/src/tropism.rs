//! Constant influences on growing tips.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{GrowthError, usable};

/// An influence in one direction: light from above, weight downwards, wind.
///
/// ```
/// use glam::DVec3;
/// use growth::Tropism;
/// let bent = Tropism::sum(&[Tropism::UPWARDS, Tropism { direction: DVec3::X, strength: 0.5 }])?;
/// assert_eq!(bent, DVec3::new(0.5, 0.2, 0.0));
/// # Ok::<(), growth::GrowthError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tropism {
    /// Direction of growth; any length above 0.
    #[schemars(with = "[f64; 3]")]
    pub direction: DVec3,
    /// Strength relative to the pull of free space (which is 1), -10 to 10.
    #[schemars(range(min = -10.0, max = 10.0))]
    pub strength: f64,
}

spec::schemas!(Tropism => crate::TreeSpec, "/$defs/Tropism");

impl Tropism {
    /// A gentle pull towards the light.
    pub const UPWARDS: Self = Self { direction: DVec3::Y, strength: 0.2 };

    /// Returns the sum of all influences.
    ///
    /// # Errors
    /// [`GrowthError::Field`] for a direction without length, [`GrowthError::Range`] for a strength out of range.
    pub fn sum(all: &[Self]) -> Result<DVec3, GrowthError> {
        all.iter().try_fold(DVec3::ZERO, |sum, t| {
            spec::check(t)?;
            let unit = if usable(t.direction) { t.direction.try_normalize() } else { None };
            let range = "a finite direction with a length";
            let fault = GrowthError::Field { field: "tropism.direction", range, value: t.direction.length() };
            Ok(sum + unit.ok_or(fault)? * t.strength)
        })
    }
}
