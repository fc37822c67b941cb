//! Levels of detail that keep the view within a number of triangles: for a headset, which draws everything twice.
//!
//! `most triangles + plants as made -> the finest levels that fit -> the part of them that the shell shows`

use burgeon::document::PlantId;
use burgeon::{LiteMap, PlantLevel, Run};

use crate::Workspace;
use crate::shown::Shown;

/// The coarsest level.
const COARSEST: u32 = 6;

impl Workspace {
    /// Limits the triangles of all plants together from the next evaluation on, the largest coarser than the others;
    /// `None` shows all of each. Documents, files, reports and edits use the finest level.
    ///
    /// Not guaranteed: very many plants may exceed the limit even at the coarsest level.
    pub fn set_most_triangles(&mut self, most: Option<u64>) {
        self.levels.most = most;
    }

    /// Makes the levels that would be shown of the plants as they were made last, and keeps them alongside the current
    /// ones until they are needed: so nobody who enters a headset waits for a mesh. They take as much memory as they
    /// will there.
    pub fn ready_levels(&mut self, most: u64, run: &Run<'_>) {
        if self.levels.most.is_none() {
            self.levels.ready = self.levels_within(most, run);
        }
    }

    /// Makes the shown levels. A plant whose level cannot be made stays as it is.
    pub(crate) fn make_levels(&mut self, run: &Run<'_>) {
        self.levels.shown = match self.levels.most {
            Some(most) => self.levels_within(most, run),
            None => LiteMap::default(),
        };
    }

    fn levels_within(&mut self, most: u64, run: &Run<'_>) -> LiteMap<PlantId, Shown> {
        let mut before = std::mem::take(&mut self.levels.ready);
        for (id, shown) in std::mem::take(&mut self.levels.shown) {
            before.insert(id, shown);
        }
        let document = self.editor.document();
        let mut rows: Vec<Row> = document
            .plants()
            .iter()
            .filter(|p| !p.settings().hidden)
            .filter_map(|p| {
                let made = self.scene.get(p.id())?;
                let triangles = made.model.triangle_count() as u64;
                Some(Row { id: p.id(), revision: made.revision, triangles, level: 0, made: None })
            })
            .collect();
        while rows.iter().map(|r| r.triangles).sum::<u64>() > most {
            let coarser = rows.iter_mut().filter(|r| r.level < COARSEST).max_by_key(|r| r.triangles);
            let Some(row) = coarser else { break };
            let known = before.remove(&row.id).filter(|s| s.revision == row.revision);
            // The level shown before is the most likely one to fit now.
            row.level = known.as_ref().map_or(row.level + 1, |s| s.level.max(row.level + 1));
            let again = known.filter(|s| s.level == row.level).map(|s| s.made);
            let made = again.or_else(|| {
                let plant = document.plant(row.id)?;
                self.scene.level(plant, row.level, run).ok()
            });
            let Some(made) = made else {
                row.level = COARSEST;
                continue;
            };
            row.triangles = made.model.triangle_count() as u64;
            row.made = Some(made);
        }
        let mut within = LiteMap::default();
        for Row { id, revision, level, made, .. } in rows {
            if let Some(made) = made {
                within.insert(id, Shown { revision, level, made });
            }
        }
        within
    }
}

struct Row {
    id: PlantId,
    revision: u64,
    triangles: u64,
    level: u32,
    made: Option<PlantLevel>,
}
