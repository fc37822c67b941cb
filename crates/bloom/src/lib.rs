//! Flowers that open: organs from scans, growth laws fitted to stages, deformation over time.
//!
//! `stages -> organs -> regions -> GrowthLaw -> Lattice -> any day`
//!
//! After Huai, Yang and Cai 2019 (paper 003): control points of a lattice around an organ move along a logistic
//! law that was fitted to scans of other days.
//!
//! | module | owns |
//! |---|---|
//! | `obb` | [`Obb`]: the box of an organ |
//! | `lattice` | [`Lattice`], [`Weights`]: Bernstein free-form deformation |
//! | `logistic` | [`fit_logistic`]: K, p0, r with their errors |
//! | `register` | [`register`]: the lattice that carries one scan into another |
//! | `error` | [`compare`]: distances both ways |

mod error;
mod errors;
mod kernel;
mod lattice;
mod linalg;
mod logistic;
mod obb;
mod register;
mod thin;

pub use error::{Distances, ShapeError, compare};
pub use errors::BloomError;
pub use lattice::{Lattice, Weights};
pub use logistic::{Fit, FitError, Logistic, Offset, fit_law, fit_logistic};
pub use obb::Obb;
pub use register::{RegisterSpec, Registration, register};
