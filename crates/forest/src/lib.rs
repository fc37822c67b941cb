//! Stands of trees: one row for each tree, with the origin of its figures.
//!
//! | module | owns |
//! |---|---|
//! | `stand` | [`Stand`]: the trees of a forest with their measures and places |
//! | `inventory`, `projection` | [`read_inventory`]: CSV or GeoJSON → [`Stand`] |
//! | `ground` | [`Ground`], [`Mask`]: what stands stand on, and where |
//! | `spec`, `growing` | [`ForestSpec`] → [`grow_stand`] → [`Stand`] |
//! | `cells` | points on the ground by cells, for neighbours |
//! | `stand_csv` | [`write_stand_csv`] |
//! | `species`, `allometry`, `names` | [`Allometry`]: height, stem, crown and age of a species, each from each |

mod allometry;
mod cells;
mod ground;
mod growing;
mod inventory;
mod names;
mod projection;
mod spec;
mod species;
mod stand;
mod stand_csv;

pub use allometry::{Allometry, BREAST_M, Figures, FunctionalGroup, Measured, Predicted, Setting};
pub use ground::{Ground, GroundError, GroundMesh, HeightMap, MapScale, Mask};
pub use growing::{ForestError, GrownStand, Site, StandYear, grow_stand, grow_stand_on};
pub use inventory::{
    BadRows, Crs, FigureCount, InventoryError, InventoryReport, InventorySpec, read_inventory,
};
pub use names::{FoundSpecies, UnknownSpecies};
pub use spec::{ForestSpec, GroundSpec, MaskSpec, PlantingPattern, SpeciesSpec, Water};
pub use stand::{Figure, Given, Stand, StandFault, Tree};
pub use stand_csv::write_stand_csv;
