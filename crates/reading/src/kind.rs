//! The kinds of plants.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The kind of plant that a drawing shows. The words of the command line's contract.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A flower on its stem, or its head alone.
    Flower,
    /// Several flowers of one plant, or a row of them.
    Flowers,
    /// A stem with leaves.
    Stem,
    /// A tree: a trunk and a crown, or bare branches.
    Tree,
    /// A tree with a pointed crown.
    Conifer,
    /// Fronds at the top of a trunk.
    Palm,
    /// A crown on the ground.
    Bush,
    /// A thick body with arms or thorns.
    Cactus,
    /// Blades from the ground.
    Grass,
    /// One leaf.
    Leaf,
    /// A fruit.
    Fruit,
    /// A plant in a pot.
    HousePlant,
    /// A root, tuber, pod or bulb.
    Vegetable,
    /// Nothing that was recognised.
    #[default]
    None,
}

base::words!(Kind {
    Flower = "flower",
    Flowers = "flowers",
    Stem = "stem",
    Tree = "tree",
    Conifer = "conifer",
    Palm = "palm",
    Bush = "bush",
    Cactus = "cactus",
    Grass = "grass",
    Leaf = "leaf",
    Fruit = "fruit",
    HousePlant = "house_plant",
    Vegetable = "vegetable",
    None = "none",
});

impl Kind {
    /// Its place in [`ALL`](Self::ALL).
    pub const fn place(self) -> usize {
        self as usize
    }

    /// Whether both kinds are built alike: a conifer is a tree, and a root or pod a body as a fruit is.
    pub fn is_like(self, other: Self) -> bool {
        let group = |k| match k {
            Self::Conifer => Self::Tree,
            Self::Vegetable => Self::Fruit,
            Self::Flowers => Self::Flower,
            other => other,
        };
        group(self) == group(other)
    }
}

/// One interpretation of a plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scored {
    /// The kind that the plant would be.
    pub kind: Kind,
    /// How well it explains the drawing, among all kinds, or, in the description of a plant, how likely it is right:
    /// 0 to 1.
    pub score: f64,
}
