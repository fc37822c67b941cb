//! Commands of edits by hand: of every plant that has branches.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shape::HandEdit;

use super::{Command, CommandError, set};
use crate::event::Event;
use crate::state::PlantEdit;
use crate::{DocumentPlant, PlantId};

/// What can be asked of the edits by hand of a plant. They are named by their rows, from 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ShapeCommand {
    /// Does one more, after the others.
    Add(Arc<HandEdit>),
    /// Does another in the place of that of a row.
    Replace(usize, Arc<HandEdit>),
    /// Leaves the edit of a row out, or does it again.
    Leave(usize, bool),
    /// Takes those of these rows away.
    Remove(Vec<usize>),
}

impl ShapeCommand {
    /// The command for a plant.
    pub fn of(self, plant: PlantId) -> Command {
        Command::Shape(plant, self)
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Add(edit) => edit.word(),
            Self::Replace(..) => "shape-change",
            Self::Leave(..) => "shape-leave",
            Self::Remove(_) => "shape-remove",
        }
    }

    pub(super) fn decide(self, plant: &DocumentPlant) -> Result<Event, CommandError> {
        set(plant, |s| {
            let found = s.maker.word();
            if !s.maker.branches() {
                return Err(CommandError::OtherMaker { wanted: "plant with branches", found });
            }
            let gone = CommandError::Nothing("the edit is not there any more");
            match self {
                Self::Add(edit) => s.edits.push(PlantEdit { edit, off: false }),
                Self::Replace(row, edit) => s.edits.get_mut(row).ok_or(gone)?.edit = edit,
                Self::Leave(row, off) => s.edits.get_mut(row).ok_or(gone)?.off = off,
                Self::Remove(rows) => {
                    if rows.iter().any(|&row| row >= s.edits.len()) {
                        return Err(gone);
                    }
                    let mut row = 0;
                    s.edits.retain(|_| {
                        row += 1;
                        !rows.contains(&(row - 1))
                    });
                }
            }
            Ok(())
        })
    }
}
