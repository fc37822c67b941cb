//! Levels of detail that keep what is shown within a number of triangles: for a headset, which draws all twice.
//!
//! `most triangles + plants as they were made -> the finest levels that fit -> what the shell shows of them`

use burgeon::document::PlantId;
use burgeon::{LiteMap, PlantLevel, Run};

use crate::Workspace;
use crate::shown::Shown;

/// The coarsest level.
const COARSEST: u32 = 6;

impl Workspace {
    /// From the next evaluation on shows at most so many triangles of all plants together, the largest coarser than the
    /// others; none: all of each. Documents, files, reports and edits are of the finest.
    ///
    /// Not guaranteed: of very many plants even the coarsest levels may have more.
    pub fn set_most_triangles(&mut self, most: Option<u64>) {
        self.levels.most = most;
    }

    /// Makes the levels that would be shown of the plants as they were made last, and keeps them beside what is shown until
    /// they are wished for: whoever enters a headset waits for no mesh then. They take as much memory as they will take there.
    pub fn ready_levels(&mut self, most: u64, run: &Run<'_>) {
        if self.levels.most.is_none() {
            self.levels.ready = self.levels_within(most, run);
        }
    }

    /// Makes the levels that are shown. A level that cannot be made leaves its plant as it is.
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
            // What was shown before is most likely what fits now, too.
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
