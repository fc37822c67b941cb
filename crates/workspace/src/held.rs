//! A tool in the hand.

use std::sync::Arc;

use burgeon::document::PlantId;
use burgeon::plant::Plant;
use burgeon::shape::{HandEdit, Thumb, Tool};
use schemars::JsonSchema;
use serde::Serialize;

/// A gesture that is in progress, or has ended and waits for its command.
#[derive(Clone, Debug)]
pub(crate) struct Held {
    pub(crate) tool: Tool,
    pub(crate) plant: PlantId,
    /// The plant at the start of the gesture.
    pub(crate) before: Plant,
    /// Whether it has so many triangles that a gesture shows it coarser and without a digest.
    pub(crate) large: bool,
    /// The edit that a release would make, or made: shown until the command comes.
    pub(crate) preview: Option<Arc<HandEdit>>,
    /// The thumb on its pad or stick.
    pub(crate) thumb: Thumb,
    /// Tilt of the drawing plane by the thumb, radians.
    pub(crate) lean: f64,
    /// Rows of the meshes that it carries, where it moves them rather than making new ones.
    pub(crate) rows: Option<Rows>,
    /// The last pose of those rows.
    pub(crate) carried: Option<CarriedPose>,
}

/// Triangles that a hand carries.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    /// Name of the meshes.
    pub(crate) mesh: u64,
    /// Part, first triangle, and end of each range.
    pub(crate) ranges: Vec<[u32; 3]>,
}

/// Rigid motion of a branch and all that it bears: `p -> to + turn (p - from)`, metres of the plant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct CarriedPose {
    /// Name of the meshes that [`Workspace::held_rows`](crate::Workspace::held_rows) refers to.
    pub mesh: u64,
    /// Base of the branch before.
    pub from: [f64; 3],
    /// Base of the branch now.
    pub to: [f64; 3],
    /// Rotation, a unit quaternion: x, y, z, w.
    pub turn: [f64; 4],
}
