//! Levels of detail that keep what is shown within a number of triangles: for a headset, which draws all twice.
//!
//! `most triangles + plants as they were made -> the finest levels that fit -> what the shell shows of them`

use burgeon::document::PlantId;
use burgeon::{PlantLevel, Run};

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

    /// Makes the levels that are shown. A level that cannot be made leaves its plant as it is.
    pub(crate) fn make_levels(&mut self, run: &Run<'_>) {
        let before = std::mem::take(&mut self.levels.shown);
        let Some(most) = self.levels.most else { return };
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
        let mut before = before;
        while rows.iter().map(|r| r.triangles).sum::<u64>() > most {
            let coarser = rows.iter_mut().filter(|r| r.level < COARSEST).max_by_key(|r| r.triangles);
            let Some(row) = coarser else { break };
            let known = before.remove(&row.id).filter(|s| s.revision == row.revision);
            // What was shown before is most likely what fits now, too.
            row.level = known.as_ref().map_or(row.level + 1, |s| s.level.max(row.level + 1));
            let again = known.filter(|s| s.level == row.level).map(|s| s.made);
            let made = again.or_else(|| {
                let plant = document.plant(row.id)?;
                self.scene.level(plant, document, row.level, run).ok()
            });
            let Some(made) = made else {
                row.level = COARSEST;
                continue;
            };
            row.triangles = made.model.triangle_count() as u64;
            row.made = Some(made);
        }
        for Row { id, revision, level, made, .. } in rows {
            if let Some(made) = made {
                self.levels.shown.insert(id, Shown { revision, level, made });
            }
        }
    }
}

struct Row {
    id: PlantId,
    revision: u64,
    triangles: u64,
    level: u32,
    made: Option<PlantLevel>,
}
