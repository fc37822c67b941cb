//! What hands did, as a file: the same gestures again, without a hand, a page or a headset.
//!
//! `JSON -> GestureRecord -> each step by the same tools -> the document, seen as often as it was seen`

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

/// What hands did to the plants of a session, in its order. Poses are in the coordinates of the plant, metres.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GestureRecord {
    /// Always [`GESTURES_SCHEMA`].
    pub schema: String,
    /// The project as the hands found it: a `.burgeon` file in base64. Without one, steps go on from what is open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub project: Option<String>,
    /// The numbers of the project's plants, by which steps name them. Without, the file's own are meant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub numbers: Option<PlantNumbers>,
    /// The plant that was worked on first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plant: Option<PlantId>,
    /// The steps.
    pub steps: Vec<GestureStep>,
    /// The digest of the plant that was worked on last, as it was seen then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digest: Option<String>,
}

/// One step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GestureStep {
    /// When, ms since the first. It decides nothing but how fast pictures of the record follow one another.
    #[serde(default)]
    pub ms: u32,
    /// What.
    pub did: GestureDeed,
}

/// What was done in a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum GestureDeed {
    /// A hand with a tool.
    Hand(Box<HandDeed>),
    /// The edit was asked for that the last gesture made.
    Keep,
    /// The plants were made again, and seen.
    Seen,
    /// Another plant was chosen.
    Select(PlantId),
    /// A command.
    Command(Box<document::Command>),
    /// What is more than one command, and where it put a plant.
    Action(Box<Action>, Option<f64>),
    /// What is staged from here on is one step of undo of this name.
    Begin(String),
    /// In the place of what was staged before.
    Stage(Box<document::Command>),
    /// What was staged is done.
    Commit,
    /// What was staged is taken back.
    Abandon,
    /// The last step was taken back.
    Undo,
    /// It was done again.
    Redo,
}

/// What a hand did with a tool.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HandDeed {
    /// The tool, as it was set.
    pub tool: ToolKind,
    /// How far beside a branch it still was meant.
    pub reach: ShapeReach,
    /// What the hand did.
    pub input: ShapeInput,
}

/// What a replay came to.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Replayed {
    /// Edits that gestures made.
    pub edits: usize,
    /// The digest of the plant that was worked on last; none where there is none.
    pub digest: Option<String>,
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

    /// The project that the hands found, as bytes of its file.
    ///
    /// # Errors
    /// [`WorkspaceError::RecordProject`].
    pub fn project(&self) -> Result<Option<Vec<u8>>, WorkspaceError> {
        let decode = |text: &String| BASE64.decode(text.as_bytes());
        self.project.as_ref().map(decode).transpose().map_err(|_why| WorkspaceError::RecordProject)
    }
}

impl Workspace {
    /// Replays what was recorded. `saw` is told of each step once it is done.
    ///
    /// Guaranteed: the document that the same requests made, if plants were made again where the record says so. A gesture
    /// that the record does not end is let go without an edit. That the plant is the one of the record is for the caller to
    /// compare: another version may make other plants.
    ///
    /// # Errors
    /// [`WorkspaceError`]: why a step was refused; those before it stay.
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
                // A file has no numbers: of one plant it is clear which is meant.
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

    /// `made`: the edit that the last gesture made.
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
                self.run(ShapeCommand::Add(Arc::new(edit)).of(plant))?;
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
