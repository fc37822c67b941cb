//! Names of plants and strokes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Names one stroke for as long as the document lives, whatever is drawn or erased around it. Never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct StrokeId(pub u32);

/// Names one plant for as long as the document lives. Never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct PlantId(pub u32);

/// The numbers that the plants of a document go by: a file keeps none, and commands name plants by them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlantNumbers {
    /// Of each plant, in the order of the document.
    pub plants: Vec<PlantId>,
    /// The one that a new plant is given; above all others.
    pub next: u32,
}
