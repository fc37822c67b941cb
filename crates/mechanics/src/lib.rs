//! Plants as rigid bodies and springy joints, for simulators of robots.
//!
//! `Plant -> lines with loads -> joints by bending energy -> Mechanism -> mass and stiffness -> time step`
//!
//! | module | owns |
//! |---|---|
//! | `tissue` | [`Tissue`], [`WoodGroup`]: stiffness, density and strength of wood and green stems |
//! | `line` | axes as polylines with taper; the load borne at each place |
//! | `choice` | the choice of the places that become joints |
//! | `mechanism` | [`Mechanism`]: bodies, joints, capsules, fruits on stalks that break |
//! | `fruits` | the fruits that can break off, and the axes that are overloaded with fruits |
//! | `build` | [`articulate`]: the whole conversion |
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
