//! Errors of the conversion.

use base::OverBudget;
use plant::PlantFault;

/// Reason why a plant cannot be made into a mechanism.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MechanicsError {
    /// No axis above the ground.
    #[error(
        "the plant has no stem or branch above the ground, so nothing can bend: draw or grow a stem, or export its meshes \
         (.obj, .glb) as one rigid body"
    )]
    NoStem,
    /// The axes have no thickness, and so neither mass nor stiffness.
    #[error(
        "the stems and branches of the plant have no thickness, so they have neither mass nor stiffness: give them radii \
         (a pipe model, wider strokes) and export again"
    )]
    NoThickness,
    /// A mass or stiffness is not a finite number above 0.
    #[error("{what} of the plant is {value}, which no simulator takes: check the plant's size and unit")]
    Number {
        /// The quantity.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// The plant is not sound: a bug of its maker.
    #[error("the plant is not sound: {0}")]
    Unsound(PlantFault),
    /// The plant has more nodes and organs than the budget allows.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
}
