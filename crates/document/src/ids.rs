//! Names of plants and strokes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Names one stroke for the lifetime of the document, whatever is drawn or erased around it. Never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct StrokeId(pub u32);

/// Names one plant for the lifetime of the document. Never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct PlantId(pub u32);

/// Numbers of the plants of a document: files do not store them, but commands name plants by them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlantNumbers {
    /// Number of each plant, in the order of the document.
    pub plants: Vec<PlantId>,
    /// Number of the next new plant; above all others.
    pub next: u32,
}
