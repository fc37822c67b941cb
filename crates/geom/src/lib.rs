//! Geometry for plants, in f64: curves, frames, fits, triangulation, neighbours. Knows nothing of plants.

mod cone;

pub use cone::{Cone, Sheet};
