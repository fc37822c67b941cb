//! Stands of copied plants -> OGC 3D Tiles 1.1.
//!
//! `glTF of a plant -> SharedModel -> write_tile -> .glb of a tile -> tileset_json`
//!
//! | file | owns |
//! |---|---|
//! | `shared` | a plant's glTF that many tiles refer to |
//! | `merge` | several of those in one document: rows that are equal are there once |
//! | `tile` | a tile: copies of plants, and a table of their trees |
//! | `tileset` | the tree of tiles with their boxes and errors |
//! | `instancer` | the same stand as USD |
//!
//! glTF has +Y up and 3D Tiles have +Z up: a reader turns the content of a tile by a quarter, (x, y, z) to (x, -z,
//! y). Boxes of [`tileset_json`] are turned here, places in tiles are not.

mod instancer;
mod merge;
mod shared;
mod tile;
mod tileset;

pub use instancer::{Prototype, stand_usda};
pub use shared::{SharedModel, share_pictures};
pub use tile::{Group, Instance, Linking, TreeRow, TreeTable, write_tile};
pub use tileset::{TileNode, Tileset, earth_frame, tileset_json};
