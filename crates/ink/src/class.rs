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

impl StrokeClass {
    /// Every class, in the order of the trained model's label numbers.
    pub const ALL: [Self; 12] = [
        Self::Blade,
        Self::Corolla,
        Self::Axis,
        Self::TrunkOutline,
        Self::Crown,
        Self::Vein,
        Self::Disc,
        Self::Pot,
        Self::Ground,
        Self::Fruit,
        Self::Scribble,
        Self::Other,
    ];

    /// Returns its place in [`ALL`](Self::ALL), the trained model's label number.
    pub const fn place(self) -> usize {
        self as usize
    }

    /// Returns the word in reports, label files and class overrides.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Blade => "blade",
            Self::Corolla => "corolla",
            Self::Axis => "axis",
            Self::TrunkOutline => "trunk_outline",
            Self::Crown => "crown",
            Self::Vein => "vein",
            Self::Disc => "disc",
            Self::Pot => "pot",
            Self::Ground => "ground",
            Self::Fruit => "fruit",
            Self::Scribble => "scribble",
            Self::Other => "other",
        }
    }

    /// Returns the class of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.word() == word)
    }
}
