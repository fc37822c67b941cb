//! How long results are kept: as long as there is room. Those that were not shown for longest go first.

use std::collections::{BTreeMap, BTreeSet};

use burgeon::document::{DocumentPlant, PlantId};

use crate::Workspace;

/// How much is kept unless [`Workspace::keep_at_most`] says otherwise: 256 MiB, a quarter of what a tab may ask for.
pub const KEPT_BYTES: usize = 256 << 20;

/// When each plant was shown last.
#[derive(Debug)]
pub(crate) struct Kept {
    pub(crate) limit: usize,
    now: u64,
    shown: BTreeMap<PlantId, u64>,
}

impl Default for Kept {
    fn default() -> Self {
        Self::at_most(KEPT_BYTES)
    }
}

impl Kept {
    pub(crate) fn at_most(limit: usize) -> Self {
        Self { limit, now: 0, shown: BTreeMap::new() }
    }
}

impl Workspace {
    /// About how many bytes the results of all plants take.
    pub fn kept_bytes(&self) -> usize {
        self.scene.kept().map(|(_, bytes)| bytes).sum()
    }

    /// How many bytes the results of all plants may take before those of plants that are hidden or deleted go. What is
    /// shown always stays. From the next evaluation on; default [`KEPT_BYTES`].
    pub fn keep_at_most(&mut self, bytes: usize) {
        self.kept.limit = bytes;
    }

    /// Forgets what is not shown until the rest fits. A plant that comes back is made again, with the same bits.
    pub(crate) fn make_room(&mut self) {
        let plants = self.editor.document().plants().iter();
        let shown: BTreeSet<PlantId> =
            plants.filter(|p| !p.settings().hidden).map(DocumentPlant::id).collect();
        self.kept.now += 1;
        for &id in &shown {
            self.kept.shown.insert(id, self.kept.now);
        }
        let mut total = self.kept_bytes();
        let last = |id| self.kept.shown.get(&id).copied().unwrap_or(0);
        let aside = self.scene.kept().filter(|(id, _)| !shown.contains(id));
        let mut aside: Vec<(u64, PlantId, usize)> = aside.map(|(id, bytes)| (last(id), id, bytes)).collect();
        aside.sort_unstable();
        for (_, id, bytes) in aside {
            if total <= self.kept.limit {
                break;
            }
            self.scene.forget(id);
            total -= bytes;
        }
        let kept: BTreeSet<PlantId> = self.scene.kept().map(|(id, _)| id).collect();
        self.kept.shown.retain(|id, _| kept.contains(id));
        self.outcomes.retain(|id, _| kept.contains(id) || shown.contains(id));
    }
}
