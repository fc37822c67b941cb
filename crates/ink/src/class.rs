//! Classes of strokes, and their words.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The class of one stroke, named by the words of the command line's contract.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum StrokeClass {
    /// One petal or leaf as a nearly closed outline.
    Blade,
    /// Several petals, fronds or grass blades in one stroke.
    Corolla,
    /// A stem, branch, stalk or spine drawn as a line.
    Axis,
    /// A trunk (or cactus body or arm) drawn as an outline.
    TrunkOutline,
    /// The outline of a tree's crown.
    Crown,
    /// A vein or midrib of a blade.
    Vein,
    /// The centre of a flower.
    Disc,
    /// A flower pot.
    Pot,
    /// The ground.
    Ground,
    /// A fruit.
    Fruit,
    /// Shading, bark lines.
    Scribble,
    /// Nothing of the plant.
    #[default]
    Other,
}

// The choices are in the order of the trained model's label numbers.
base::words!(StrokeClass {
    Blade = "blade",
    Corolla = "corolla",
    Axis = "axis",
    TrunkOutline = "trunk_outline",
    Crown = "crown",
    Vein = "vein",
    Disc = "disc",
    Pot = "pot",
    Ground = "ground",
    Fruit = "fruit",
    Scribble = "scribble",
    Other = "other",
});

impl StrokeClass {
    /// Returns its place in [`ALL`](Self::ALL), the trained model's label number.
    pub const fn place(self) -> usize {
        self as usize
    }
}
