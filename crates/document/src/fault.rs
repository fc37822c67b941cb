//! Faults in the settings of a plant.

use bloom::FlowerSpec;
use spec::RangeFault;

/// Most obstacles of a tree.
pub(crate) const MAX_OBSTACLES: usize = 64;
/// Most pictures of one plant.
pub(crate) const MAX_PICTURES: usize = 16;
/// Most layers of a drawing.
pub(crate) const MAX_LAYERS: usize = 100;
/// Most hand edits of a plant.
pub(crate) const MAX_EDITS: usize = 1000;

/// The first setting of a plant that is at fault, with a remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingFault {
    /// A number is out of the range in its schema.
    #[error(transparent)]
    Range(#[from] RangeFault),
    /// The tree has too many obstacles.
    #[error("a tree has at most {MAX_OBSTACLES} obstacles; join some of them into one mesh")]
    Obstacles,
    /// A number of an obstacle is not finite.
    #[error("every number of an obstacle must be finite")]
    Obstacle,
    /// The plant stands too far away, or is too large or small.
    #[error("a plant stands within 100 km, 0.001 to 1000 times its size")]
    Place,
    /// The photograph cannot be seen.
    #[error("the photograph lies out of reach; put it nearer and make it larger")]
    Photo,
    /// The picture of a material is missing.
    #[error("the picture of a material is not there; choose one")]
    Picture,
    /// The plant has too many pictures.
    #[error("a plant has at most {MAX_PICTURES} pictures; use one of them again")]
    Pictures,
    /// A layer has no name, or two layers share one.
    #[error("each layer of a drawing has a name of its own")]
    LayerName,
    /// The drawing has too many layers.
    #[error("a drawing has at most {MAX_LAYERS} layers; join some")]
    Layers,
    /// There is no flower of this name.
    #[error("the flower {name:?} is unknown; use one of {}", FlowerSpec::PRESETS.join(", "))]
    Flower {
        /// The requested name, shortened.
        name: String,
    },
    /// The growth law cannot be used.
    #[error("{0}")]
    Law(String),
    /// The petal colour is unknown.
    #[error("the petal colour {word:?} is unknown; use one of {known}")]
    Petals {
        /// The requested colour.
        word: String,
        /// List of the known colours.
        known: String,
    },
    /// The plant has hand edits but no branches.
    #[error("a {maker} has no branches to edit by hand")]
    NoBranches {
        /// The word of its maker.
        maker: &'static str,
    },
    /// The plant has too many hand edits.
    #[error("a plant has at most {MAX_EDITS} edits by hand; remove some")]
    Edits,
    /// A hand edit is not possible.
    #[error("edit {row} by hand: {why}")]
    Edit {
        /// Row of the edit, from 0.
        row: usize,
        /// The reason.
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
