//! Commands of hand edits, for every plant with branches.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shape::HandEdit;

use super::{Command, CommandError, set};
use crate::event::Event;
use crate::state::PlantEdit;
use crate::{DocumentPlant, PlantId};

/// Commands on the hand edits of a plant. Edits are named by their rows, from 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ShapeCommand {
    /// Adds an edit after the others.
    Add(Arc<HandEdit>),
    /// Replaces the edit of a row.
    Replace(usize, Arc<HandEdit>),
    /// Switches the edit of a row off or on.
    Leave(usize, bool),
    /// Removes the edits of these rows.
    Remove(Vec<usize>),
}

impl ShapeCommand {
    /// Returns the command for a plant.
    pub fn for_plant(self, plant: PlantId) -> Command {
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
