//! A tool in the hand.

use std::sync::Arc;

use burgeon::document::PlantId;
use burgeon::plant::Plant;
use burgeon::shape::{HandEdit, Thumb, Tool};
use schemars::JsonSchema;
use serde::Serialize;

/// A gesture that is going on, or was and waits for its command.
#[derive(Clone, Debug)]
pub(crate) struct Held {
    pub(crate) tool: Tool,
    pub(crate) plant: PlantId,
    /// The plant as it was when the gesture began.
    pub(crate) before: Plant,
    /// It has so many triangles that a gesture shows it coarser and without a digest.
    pub(crate) large: bool,
    /// What letting go would make, or made: shown until the command comes.
    pub(crate) preview: Option<Arc<HandEdit>>,
    /// The thumb on its pad or stick.
    pub(crate) thumb: Thumb,
    /// How far the drawing plane leans by it, radians.
    pub(crate) lean: f64,
    /// What of the meshes it carries, where it moves them and makes none.
    pub(crate) rows: Option<Rows>,
    /// And where it carried them last.
    pub(crate) carried: Option<CarriedPose>,
}

/// Triangles that a hand carries.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    /// The name of the meshes.
    pub(crate) mesh: u64,
    /// Part, first triangle, and the one after the last, of each range.
    pub(crate) ranges: Vec<[u32; 3]>,
}

/// How a branch and what it bears is moved: `p -> to + turn (p - from)`, metres of the plant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct CarriedPose {
    /// The name of the meshes of which [`Workspace::held_rows`](crate::Workspace::held_rows) are.
    pub mesh: u64,
    /// Where it began.
    pub from: [f64; 3],
    /// Where it begins now.
    pub to: [f64; 3],
    /// A unit quaternion: x, y, z, w.
    pub turn: [f64; 4],
}
