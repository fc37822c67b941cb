//! Records of gestures, as a file: they replay the same gestures without a hand, a page or a headset.
//!
//! `JSON -> GestureRecord -> each step by the same tools -> the document, evaluated as often as in the record`

use std::sync::Arc;

use burgeon::Run;
use burgeon::document::{self, PlantId, PlantNumbers, ShapeCommand};
use burgeon::shape::{HandEdit, MOST_POINTS, ToolKind};
use data_encoding::BASE64;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Action, ShapeInput, ShapeReach, Workspace, WorkspaceError};

/// The value of [`GestureRecord::schema`].
pub const GESTURES_SCHEMA: &str = "burgeon.gestures/1";

/// Most steps of a record: an hour of a hand at 72 pictures a second.
pub const MOST_STEPS: usize = 300_000;

/// Most bytes of a record that are read.
const MOST_BYTES: usize = 256 << 20;

/// Gestures on the plants of a session, in their order. Poses are in the coordinates of the plant, metres.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GestureRecord {
    /// Always [`GESTURES_SCHEMA`].
    pub schema: String,
    /// The project at the start of the session: a `.burgeon` file in base64. Without it, steps continue from the open
    /// document.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub project: Option<String>,
    /// Numbers of the project's plants, by which steps name them. Without them, those of the file apply.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub numbers: Option<PlantNumbers>,
    /// The plant that was worked on first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plant: Option<PlantId>,
    /// The steps.
    pub steps: Vec<GestureStep>,
    /// Digest of the plant that was worked on last, at its last evaluation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digest: Option<String>,
}

/// One step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GestureStep {
    /// Time in ms since the first step. It only sets the pace at which pictures of the record follow one another.
    #[serde(default)]
    pub ms: u32,
    /// The deed.
    pub did: GestureDeed,
}

/// A deed of a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum GestureDeed {
    /// A hand with a tool.
    Hand(Box<HandDeed>),
    /// The edit of the last gesture was requested.
    Keep,
    /// The plants were made again, and shown.
    Seen,
    /// Another plant was chosen.
    Select(PlantId),
    /// A command.
    Command(Box<document::Command>),
    /// An action of more than one command, and the place that it gave a plant.
    Action(Box<Action>, Option<f64>),
    /// Begins a gesture: the commands staged from here on form one step of undo of this name.
    Begin(String),
    /// Replaces the staged command.
    Stage(Box<document::Command>),
    /// Commits the staged command.
    Commit,
    /// Takes the staged command back.
    Abandon,
    /// The last step was taken back.
    Undo,
    /// It was redone.
    Redo,
}

/// A deed of a hand with a tool.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HandDeed {
    /// The tool, with its settings.
    pub tool: ToolKind,
    /// Largest distance from a branch at which it is still meant.
    pub reach: ShapeReach,
    /// Input of the hand.
    pub input: ShapeInput,
}

/// Result of a replay.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Replayed {
    /// Edits that gestures made.
    pub edits: usize,
    /// Digest of the plant that was worked on last; `None` without a plant.
    pub digest: Option<String>,
}

impl GestureRecord {
    /// Reads a record.
    ///
    /// # Errors
    /// [`WorkspaceError::Record`] for text that is cut off or not a record, [`WorkspaceError::RecordForm`] for another
    /// form, [`WorkspaceError::RecordLong`] for a record that is too long, or whose moves are.
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
        let long = |s: &GestureStep| match &s.did {
            GestureDeed::Hand(hand) => {
                matches!(&hand.input, ShapeInput::Move(moves) if moves.len() > MOST_POINTS)
            }
            _ => false,
        };
        if record.steps.len() > MOST_STEPS || record.steps.iter().any(long) {
            return Err(WorkspaceError::RecordLong { most: MOST_STEPS });
        }
        Ok(record)
    }

    /// Returns the project at the start of the session, as bytes of its file.
    ///
    /// # Errors
    /// [`WorkspaceError::RecordProject`].
    pub fn project(&self) -> Result<Option<Vec<u8>>, WorkspaceError> {
        let decode = |text: &String| BASE64.decode(text.as_bytes());
        self.project.as_ref().map(decode).transpose().map_err(|_why| WorkspaceError::RecordProject)
    }
}

impl Workspace {
    /// Replays a record. `saw` is called with each step once it is done.
    ///
    /// Guaranteed: the document that the same requests made, if plants were made again where the record says so. A
    /// gesture that the record does not end is dropped without an edit. The caller has to compare the plant with that
    /// of the record: another version may make other plants.
    ///
    /// # Errors
    /// [`WorkspaceError`]: the reason why a step was refused; the steps before it stay.
    pub fn replay(
        &mut self,
        record: &GestureRecord,
        run: &Run<'_>,
        saw: &mut dyn FnMut(&Self, &GestureStep),
    ) -> Result<Replayed, WorkspaceError> {
        if let Some(project) = record.project()? {
            let found = document::read_project(&project)?;
            let found = match &record.numbers {
                Some(numbers) => found.numbered(numbers).map_err(|_fault| WorkspaceError::RecordNumbers)?,
                None => found,
            };
            self.replace(found, true)?;
        }
        if let Some(plant) = record.plant {
            match self.select(plant) {
                // A file has no numbers; if it has one plant, this is the one meant.
                Err(WorkspaceError::PlantGone)
                    if record.project.is_some()
                        && record.numbers.is_none()
                        && self.document().plants().len() == 1 => {}
                other => other?,
            }
        }
        self.evaluate(run)?;
        let (mut made, mut edits) = (None, 0);
        for step in &record.steps {
            self.do_again(&step.did, &mut made, run)?;
            edits += usize::from(step.did == GestureDeed::Keep);
            saw(self, step);
        }
        self.let_go();
        let view = self.evaluate(run)?;
        let last = self.current().and_then(|id| view.plants.into_iter().find(|p| p.id == id));
        Ok(Replayed { edits, digest: last.and_then(|p| p.item).map(|item| item.digest) })
    }

    /// Replays one step. `made`: the edit that the last gesture made.
    fn do_again(
        &mut self,
        deed: &GestureDeed,
        made: &mut Option<HandEdit>,
        run: &Run<'_>,
    ) -> Result<(), WorkspaceError> {
        match deed {
            GestureDeed::Hand(hand) => {
                let answer = self.shape(hand.tool, hand.reach, hand.input.clone())?;
                *made = answer.commit.or(made.take());
            }
            GestureDeed::Keep => {
                let edit = made.take().ok_or(WorkspaceError::RecordKeeps)?;
                let plant = self.must()?;
                self.run(ShapeCommand::Add(Arc::new(edit)).for_plant(plant))?;
            }
            GestureDeed::Seen => drop(self.evaluate(run)?),
            GestureDeed::Select(plant) => self.select(*plant)?,
            GestureDeed::Command(command) => self.run(document::Command::clone(command))?,
            GestureDeed::Action(action, placed) => {
                if let Some(x) = *placed {
                    self.place_next(x);
                }
                self.act(action)?;
                self.placed();
            }
            GestureDeed::Begin(name) => self.begin(name)?,
            GestureDeed::Stage(command) => self.stage(document::Command::clone(command))?,
            GestureDeed::Commit => self.commit(),
            GestureDeed::Abandon => self.abandon(),
            GestureDeed::Undo => drop(self.undo()),
            GestureDeed::Redo => drop(self.redo()),
        }
        Ok(())
    }
}
