//! Reasons why a scene could not be made.

use base::{Cancelled, OverBudget, Stopped};
use formats::LeafFileError;

use crate::make::MakeError;
use crate::opening::OpeningError;
use crate::trees::TreeError;
use makers::LeafError;

/// Reason why a plant of a scene could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The drawing makes no plant.
    #[error(transparent)]
    Sketch(#[from] MakeError),
    /// Its flowers do not open.
    #[error(transparent)]
    Opening(#[from] OpeningError),
    /// The tree does not grow.
    #[error(transparent)]
    Tree(TreeError),
    /// The leaf's file cannot be read.
    #[error(transparent)]
    File(#[from] LeafFileError),
    /// The leaf's veins make no marks.
    #[error(transparent)]
    Graph(#[from] leaf::GraphError),
    /// The marks make no leaf.
    #[error(transparent)]
    Leaf(LeafError),
    /// The plant whose leaf is borne has no leaf.
    #[error("the plant \"{0}\", whose leaf this one bears, has no leaf yet")]
    Lender(String),
    /// A coarser copy was requested of a plant that is not made.
    #[error("the plant \"{0}\" has not been made yet")]
    NotMade(String),
    /// The plants that are shown already take as many bytes as allowed.
    #[error(
        "there is no room for it: the plants of this scene already take {} MB of memory; hide or delete some of them",
        .0 >> 20
    )]
    NoRoom(usize),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The result would exceed the budget.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
}

impl SceneError {
    /// Whether it is not a fault: the person asked to stop.
    pub fn is_cancelled(&self) -> bool {
        matches!(
            self,
            Self::Cancelled(_)
                | Self::Sketch(MakeError::Cancelled(_))
                | Self::Opening(OpeningError::Make(MakeError::Cancelled(_)))
                | Self::Tree(TreeError::Cancelled(_))
                | Self::Leaf(LeafError::Cancelled(_))
        )
    }

    /// Whether there is nothing to make yet: an empty sheet.
    pub fn is_bare(&self) -> bool {
        matches!(self, Self::Sketch(MakeError::NoStrokes { .. }))
    }
}

impl From<TreeError> for SceneError {
    fn from(e: TreeError) -> Self {
        if let TreeError::Cancelled(c) = e { Self::Cancelled(c) } else { Self::Tree(e) }
    }
}

impl From<Stopped> for SceneError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Cancelled(c) => Self::Cancelled(c),
            Stopped::OverBudget(o) => Self::OverBudget(o),
        }
    }
}

impl From<LeafError> for SceneError {
    fn from(e: LeafError) -> Self {
        if let LeafError::Cancelled(c) = e { Self::Cancelled(c) } else { Self::Leaf(e) }
    }
}

base::coded!(SceneError {
    Self::Lender(name) => "lender-without-leaf" { name },
    Self::NotMade(name) => "plant-not-made" { name },
    Self::NoRoom(bytes) => "scene-full" { mb = bytes >> 20 },
} wraps {
    Self::Sketch(e) => e, MakeError;
    Self::Opening(e) => e, OpeningError;
    Self::Tree(e) => e, TreeError;
    Self::File(e) => e, LeafFileError;
    Self::Graph(e) => e, leaf::GraphError;
    Self::Leaf(e) => e, LeafError;
    Self::Cancelled(e) => e, Cancelled;
    Self::OverBudget(e) => e, OverBudget;
});
