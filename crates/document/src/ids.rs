//! Names of plants and strokes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Names one stroke for as long as the document lives, whatever is drawn or erased around it. Never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct StrokeId(pub u32);

/// Names one plant for as long as the document lives. Never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct PlantId(pub u32);
