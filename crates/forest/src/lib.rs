//! Stands of trees: one row for each tree, and where its figures come from.
//!
//! | module | owns |
//! |---|---|
//! | `stand` | [`Stand`]: the trees of a forest with their measures and places |
//! | `species`, `allometry` | [`Allometry`]: height, stem, crown and age of a species, each from each |

mod allometry;
mod species;
mod stand;

pub use allometry::{
    Allometry, BREAST_M, Figures, Found, Group, Measured, Predicted, Setting, UnknownSpecies,
};
pub use stand::{Figure, Given, Stand, StandFault, Tree};
