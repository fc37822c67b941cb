//! Plants as rigid bodies and springy joints, for simulators of robots.
//!
//! `Plant -> lines with loads -> joints by bending energy -> Mechanism -> mass and stiffness -> time step`
//!
//! | module | owns |
//! |---|---|
//! | `tissue` | [`Tissue`], [`WoodGroup`]: how stiff, heavy and strong wood and green stems are |
//! | `line` | axes as bent lines with taper; what each place of them bears |
//! | `choice` | which places become joints |
//! | `mechanism` | [`Mechanism`]: bodies, joints, capsules, fruits on stalks that break |
//! | `fruits` | which fruits can break off, and which axes bear too much of them |
//! | `build` | [`articulate`]: the whole way |
//! | `dynamics` | [`Mechanism::frequencies`], [`Mechanism::deflection`]: small movements about the rest pose |

mod build;
mod choice;
mod dynamics;
mod error;
mod fruits;
mod line;
mod mechanism;
mod tissue;

pub use build::{MechanicsSpec, articulate};
pub use dynamics::Frequencies;
pub use error::MechanicsError;
pub use mechanism::{Body, Capsule, Mechanism, SpringJoint, Stalk};
pub use tissue::{Tissue, WoodGroup};
