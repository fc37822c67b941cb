//! Stands of trees: one row for each tree, and where its figures come from.
//!
//! | module | owns |
//! |---|---|
//! | `stand` | [`Stand`]: the trees of a forest with their measures and places |
//! | `inventory`, `projection` | [`read_inventory`]: CSV or GeoJSON → [`Stand`] |
//! | `cells` | points on the ground by cells, for neighbours |
//! | `species`, `allometry` | [`Allometry`]: height, stem, crown and age of a species, each from each |

mod allometry;
mod cells;
mod inventory;
mod projection;
mod species;
mod stand;

pub use allometry::{
    Allometry, BREAST_M, Figures, Found, Group, Measured, Predicted, Setting, UnknownSpecies,
};
pub use inventory::{
    BadRows, Crs, FigureCount, InventoryError, InventoryReport, InventorySpec, read_inventory,
};
pub use stand::{Figure, Given, Stand, StandFault, Tree};
