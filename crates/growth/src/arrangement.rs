//! Phyllotaxis as written in a spec.

use plant::{Divergence, Phyllotaxis};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::GrowthError;

/// Arrangement of buds or leaves around their axis.
///
/// ```
/// use growth::Arrangement;
/// use plant::Phyllotaxis;
/// assert_eq!(Arrangement::Decussate.phyllotaxis()?, Phyllotaxis::Decussate);
/// # Ok::<(), growth::GrowthError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Arrangement {
    /// One per node, turned by the divergence from the one before.
    Spiral {
        /// Divergence, degrees; 137.5 in most plants.
        #[schemars(range(min = -360.0, max = 360.0), extend("x-unit" = "deg"))]
        divergence_deg: f64,
    },
    /// One per node, in two rows.
    Distichous,
    /// Two per node, all in one plane.
    Opposite,
    /// Two per node, each pair at right angles to the one before.
    Decussate,
    /// Several per node, 2 to 12.
    Whorled {
        /// Number of members of a whorl.
        #[schemars(range(min = 2, max = 12))]
        count: u32,
    },
}

spec::schemas!(Arrangement => crate::TreeSpec, "/$defs/Arrangement");

impl Default for Arrangement {
    fn default() -> Self {
        Self::Spiral { divergence_deg: 137.507_764 }
    }
}

impl Arrangement {
    /// Returns the checked form.
    ///
    /// # Errors
    /// [`GrowthError::Range`] for a divergence that is not finite or a whorl of other than 2 to 12.
    pub fn phyllotaxis(self) -> Result<Phyllotaxis, GrowthError> {
        spec::check(&self)?;
        Ok(match self {
            Self::Spiral { divergence_deg } => {
                let fault = |e: base::NotFinite| GrowthError::Field {
                    field: "divergence_deg",
                    range: "-360 to 360",
                    value: e.value,
                };
                Phyllotaxis::Spiral(Divergence::from_deg(divergence_deg).map_err(fault)?)
            }
            Self::Distichous => Phyllotaxis::Distichous,
            Self::Opposite => Phyllotaxis::Opposite,
            Self::Decussate => Phyllotaxis::Decussate,
            Self::Whorled { count } => Phyllotaxis::Whorled(count),
        })
    }
}
