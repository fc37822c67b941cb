//! What hands did, as a file: the same gestures again, without a hand, a page or a headset.
//!
//! `JSON -> GestureRecord -> each step by the same tools -> edits of the document`

use burgeon::Run;
use burgeon::document::ShapeCommand;
use burgeon::shape::{MOST_POINTS, ToolKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

use crate::{ShapeInput, ShapeReach, Workspace, WorkspaceError};

/// The value of [`GestureRecord::schema`].
pub const GESTURES_SCHEMA: &str = "burgeon.gestures/1";

/// Most steps of a record: an hour of a hand at 72 pictures a second.
pub const MOST_STEPS: usize = 300_000;

/// Most bytes of a record that are read.
const MOST_BYTES: usize = 256 << 20;

/// What hands did to the plants of a session, in its order. Poses are in the coordinates of the plant, metres.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GestureRecord {
    /// Always [`GESTURES_SCHEMA`].
    pub schema: String,
    /// The steps.
    pub steps: Vec<GestureStep>,
}

/// One thing that a hand did with a tool.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GestureStep {
    /// The tool, as it was set.
    pub tool: ToolKind,
    /// How far beside a branch it still was meant.
    pub reach: ShapeReach,
    /// What the hand did.
    pub input: ShapeInput,
}

impl GestureRecord {
    /// Reads a record.
    ///
    /// # Errors
    /// [`WorkspaceError::Record`] for what is cut off or no record, [`WorkspaceError::RecordForm`] for one of another form,
    /// [`WorkspaceError::RecordLong`] for one that is too long, or whose moves are.
    ///
    /// ```
    /// use workspace::{GestureRecord, WorkspaceError};
    /// let none = br#"{"schema":"burgeon.gestures/1","steps":[]}"#;
    /// assert!(GestureRecord::read(none).is_ok());
    /// assert!(matches!(GestureRecord::read(&none[..30]), Err(WorkspaceError::Record(_))));
    /// ```
    pub fn read(bytes: &[u8]) -> Result<Self, WorkspaceError> {
        if bytes.len() > MOST_BYTES {
            return Err(WorkspaceError::RecordLong { most: MOST_STEPS });
        }
        let record: Self = serde_json::from_slice(bytes).map_err(WorkspaceError::Record)?;
        if record.schema != GESTURES_SCHEMA {
            return Err(WorkspaceError::RecordForm(record.schema.chars().take(60).collect()));
        }
        let long = |s: &GestureStep| matches!(&s.input, ShapeInput::Move(moves) if moves.len() > MOST_POINTS);
        if record.steps.len() > MOST_STEPS || record.steps.iter().any(long) {
            return Err(WorkspaceError::RecordLong { most: MOST_STEPS });
        }
        Ok(record)
    }
}

impl Workspace {
    /// Does again what hands did to the current plant; how many edits that made. Each is a step of undo.
    ///
    /// Guaranteed: the document that the same inputs to [`Workspace::shape`] made, with an evaluation after each edit. A
    /// gesture that the record does not end is let go without an edit.
    ///
    /// # Errors
    /// [`WorkspaceError`]: why a step was refused; those before it stay.
    pub fn replay(&mut self, record: &GestureRecord, run: &Run<'_>) -> Result<usize, WorkspaceError> {
        let mut edits = 0;
        self.evaluate(run)?;
        for GestureStep { tool, reach, input } in &record.steps {
            let answer = self.shape(*tool, *reach, input.clone())?;
            if let Some(edit) = answer.commit {
                let plant = self.must()?;
                self.run(ShapeCommand::Add(Arc::new(edit)).of(plant))?;
                self.evaluate(run)?;
                edits += 1;
            }
        }
        self.let_go();
        Ok(edits)
    }
}
