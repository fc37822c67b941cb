//! From flat reading to depth (He and Cheng 2021, section 5): axes by entropy, flowers by cones, leaves by the light
//! prior.
//!
//! `Reading -> AxisPlan (nodes) -> z of every node -> organs in space`

mod axes;
mod branch;
mod bunch;
mod flower;
mod fruit;
mod leaf;
mod scene;
mod solid;

pub(crate) use axes::{Part, Plans};
pub(crate) use branch::{bend_by_light_and_weight, branch_depths};
pub(crate) use bunch::fill_bunches;
pub(crate) use flower::place_flower;
pub(crate) use fruit::place_fruit;
pub(crate) use leaf::{LocalBlade, blade_key, leaf_shape, place_leaf};
pub(crate) use scene::{Bearing, Scene, coloured, drawn_light, usual_colour};
pub(crate) use solid::{place_pot, place_thorn};
