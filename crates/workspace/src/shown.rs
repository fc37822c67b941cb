//! Levels of detail that are shown.

use burgeon::document::PlantId;
use burgeon::{LiteMap, PlantLevel};

/// Levels that are shown in place of plants.
#[derive(Debug, Default)]
pub(crate) struct Levels {
    /// Most triangles of all plants together.
    pub(crate) most: Option<u64>,
    pub(crate) shown: LiteMap<PlantId, Shown>,
    /// Levels that were made in advance.
    pub(crate) ready: LiteMap<PlantId, Shown>,
}

/// The level of one plant.
#[derive(Debug)]
pub(crate) struct Shown {
    /// Revision of the finest meshes.
    pub(crate) revision: u64,
    pub(crate) level: u32,
    pub(crate) made: PlantLevel,
}

impl Levels {
    /// Returns the level that is shown of a plant, if not its finest meshes.
    pub(crate) fn get(&self, id: PlantId) -> Option<&PlantLevel> {
        self.shown.get(&id).map(|s| &s.made)
    }

    /// Returns the name of the meshes that are shown of a plant whose finest meshes have this one.
    pub(crate) fn name(&self, id: PlantId, revision: u64) -> u64 {
        // Far above all revisions, and still a whole number in JavaScript.
        self.shown.get(&id).map_or(revision, |s| revision + (u64::from(s.level) << 48))
    }
}
