//! A stand of trees -> plants that stand for them -> tiles.
//!
//! `Stand, TreeSpec -> Nursery (variants) -> Placed (variant, turn, scale) -> Tiling -> files`
//!
//! | file | owns |
//! |---|---|
//! | `nursery` | which plants are grown for a stand, how thick they are, their meshes |
//! | `placed` | which of them stands for a tree, turned and scaled |
//! | `tiling` | the quadtree: which trees are in a tile, at which level of detail |
//! | `map` | a plan of a stand as a picture |

mod map;
mod nursery;
mod placed;
mod tiling;
mod variant;

pub use map::{SPECIES_COLOURS, stand_map};
pub use nursery::{Nursery, NurseryError, NurseryLook, NurserySpec};
pub use placed::{LIMITS, Misfits, Placed, ScaleLimits};
pub use tiling::{StandTile, TileId, Tiling, TilingError, TilingSpec};
pub use variant::Variant;
