//! Which levels of detail are shown.

use burgeon::document::PlantId;
use burgeon::{LiteMap, PlantLevel};

/// Levels that are shown in the place of plants.
#[derive(Debug, Default)]
pub(crate) struct Levels {
    /// Triangles of all plants together.
    pub(crate) most: Option<u64>,
    pub(crate) shown: LiteMap<PlantId, Shown>,
    /// Those that were made before they are wished for.
    pub(crate) ready: LiteMap<PlantId, Shown>,
}

/// The level of one plant.
#[derive(Debug)]
pub(crate) struct Shown {
    /// Of the meshes that it is a level of.
    pub(crate) revision: u64,
    pub(crate) level: u32,
    pub(crate) made: PlantLevel,
}

impl Levels {
    /// What is shown of a plant, if not its finest meshes.
    pub(crate) fn of(&self, id: PlantId) -> Option<&PlantLevel> {
        self.shown.get(&id).map(|s| &s.made)
    }

    /// The name of the meshes that are shown of a plant whose finest have this one.
    pub(crate) fn name(&self, id: PlantId, revision: u64) -> u64 {
        // Far above all revisions, and still whole in a number of JavaScript.
        self.shown.get(&id).map_or(revision, |s| revision + (u64::from(s.level) << 48))
    }
}
