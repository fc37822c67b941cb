//! Plants that several models make together, and plants as drawings.
//!
//! `marks | chief veins | clouds -> leaf, bloom -> LeafyPlant -> skin`
//!
//! | module | owns |
//! |---|---|
//! | `look` | [`LeafLook`]: colours and fineness of measured leaves; [`LeafyPlant`]: a plant with the pictures of its leaves |
//! | `measured` | [`build_leaf`], [`build_ray_leaf`]: one leaf of marks or of chief veins |
//! | `shoot` | [`build_shoot`]: measured leaves on one stem |
//! | `scanned` | [`build_scanned_leaf`]: the scan of one leaf |
//! | `seedling` | [`build_seedling`]: the organs of a scanned plant |
//! | `template` | [`LeafTemplate`]: any leaf as the blade of any plant |
//! | `drawn` | [`drawn()`]: line drawings of plants |
//! | `error` | [`LeafError`], [`SeedlingError`] |

mod drawn;
mod error;
mod look;
mod measured;
mod scanned;
mod seedling;
mod shoot;
mod template;

pub use drawn::{DrawnKind, DrawnLine, drawing_of, drawn};
pub use error::{LeafError, SeedlingError};
pub use look::{LeafLook, LeafyPlant};
pub use measured::{RayLeafParts, build_leaf, build_ray_leaf};
pub use scanned::build_scanned_leaf;
pub use seedling::{OrganFit, build_seedling, surface_places};
pub use shoot::{ShootSpec, build_shoot};
pub use template::{LeafTemplate, TemplateError};
