//! What can be wrong with the settings of a plant.

use bloom::FlowerSpec;
use spec::RangeFault;

/// Most obstacles of a tree.
pub(crate) const MAX_OBSTACLES: usize = 64;
/// Most pictures of one plant.
pub(crate) const MAX_PICTURES: usize = 16;
/// Most layers of a drawing.
pub(crate) const MAX_LAYERS: usize = 100;
/// Most edits by hand of a plant.
pub(crate) const MAX_EDITS: usize = 1000;

/// The first setting of a plant that is at fault, with what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingFault {
    /// A number is out of the range that its schema has.
    #[error(transparent)]
    Range(#[from] RangeFault),
    /// More obstacles than a tree may have.
    #[error("a tree has at most {MAX_OBSTACLES} obstacles; join some of them into one mesh")]
    Obstacles,
    /// An obstacle that is nowhere.
    #[error("every number of an obstacle must be finite")]
    Obstacle,
    /// Too far away, or too large or small.
    #[error("a plant stands within 100 km, 0.001 to 1000 times its size")]
    Place,
    /// A photograph that cannot be seen.
    #[error("the photograph lies out of reach; put it nearer and make it larger")]
    Photo,
    /// A material whose picture is not there.
    #[error("the picture of a material is not there; choose one")]
    Picture,
    /// More pictures than a plant may have.
    #[error("a plant has at most {MAX_PICTURES} pictures; use one of them again")]
    Pictures,
    /// A layer without a name, or two of one name.
    #[error("each layer of a drawing has a name of its own")]
    LayerName,
    /// More layers than a drawing may have.
    #[error("a drawing has at most {MAX_LAYERS} layers; join some")]
    Layers,
    /// No such flower.
    #[error("the flower {name:?} is unknown; use one of {}", FlowerSpec::PRESETS.join(", "))]
    Flower {
        /// What was asked for, shortened.
        name: String,
    },
    /// A growth law that cannot be used.
    #[error("{0}")]
    Law(String),
    /// A petal colour that is not known.
    #[error("the petal colour {word:?} is unknown; use one of {known}")]
    Petals {
        /// What was asked for.
        word: String,
        /// All that there are.
        known: String,
    },
    /// Edits by hand of what has no branches.
    #[error("a {maker} has no branches to edit by hand")]
    NoBranches {
        /// The word of its maker.
        maker: &'static str,
    },
    /// More edits than a plant may have.
    #[error("a plant has at most {MAX_EDITS} edits by hand; remove some")]
    Edits,
    /// An edit that cannot be.
    #[error("edit {row} by hand: {why}")]
    Edit {
        /// From 0.
        row: usize,
        /// What is wrong with it.
        why: String,
    },
}

base::coded!(SettingFault {
    Self::Obstacles => "too-many-obstacles" { most = MAX_OBSTACLES },
    Self::Obstacle => "obstacle-not-finite" {},
    Self::Place => "place-too-far" {},
    Self::Photo => "photo-too-far" {},
    Self::Picture => "no-picture" {},
    Self::Pictures => "too-many-pictures" { most = MAX_PICTURES },
    Self::LayerName => "layer-name" {},
    Self::Layers => "too-many-layers" { most = MAX_LAYERS },
    Self::Flower { name } => "no-species" { name },
    Self::Law(why) => "law" { why },
    Self::Petals { word, known } => "no-petal-colour" { word, known },
    Self::NoBranches { maker } => "no-branches" { maker },
    Self::Edits => "too-many-edits" { most = MAX_EDITS },
    Self::Edit { row, why } => "edit-at-fault" { row, why },
} wraps {
    Self::Range(e) => e, RangeFault;
});
