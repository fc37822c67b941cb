//! A stand of trees -> plants that stand for them -> tiles.
//!
//! `Stand, TreeSpec -> Nursery (variants) -> Placed (variant, turn, scale) -> Tiling -> files`
//!
//! | file | owns |
//! |---|---|
//! | `nursery` | the plants that are grown for a stand, their thickness, their meshes |
//! | `placed` | the plant that stands for a tree, turned and scaled |
//! | `tiling` | the quadtree: the trees of a tile, and its level of detail |
//! | `plan` | a stand with all that determines its tiles |
//! | `tile_folder` | the files of a tileset: existing ones stay, missing ones are made |
//! | `tile_models`, `tile_writer` | the plants' own files; tiles, tileset, table, one file of all |
//! | `stand_source` | sources of stands: reports, ground and masks of files |
//! | `map` | a plan of a stand as a picture |

mod map;
mod nursery;
mod placed;
mod plan;
mod stand_source;
mod tile_folder;
mod tile_models;
mod tile_writer;
mod tiling;
mod variant;

pub use map::{SPECIES_COLOURS, stand_map};
pub use nursery::{Nursery, NurseryError, NurseryLook, NurserySpec};
pub use placed::{LIMITS, Misfits, Placed, ScaleLimits};
pub use plan::{ForestPlan, ForestTilesError, ForestTilesSpec};
pub use stand_source::{SiteError, SiteFiles, StandReport, read_ground, read_masks};
pub use tile_folder::{TILES_JOURNAL, TILES_MANIFEST, TILESET, TileDisk, TileFile, TileFolder};
pub use tile_models::{ModelsOf, TileModels, Watch};
pub use tile_writer::{TileWriter, WholeForest};
pub use tiling::{StandTile, TileId, Tiling, TilingError, TilingSpec};
pub use variant::Variant;
