//! Reasons why a request was refused.

use burgeon::document::{ArchiveError, CommandError, PhotoError, PictureError, ProjectError};
use burgeon::formats::{DrawingError, DrawingFormat, Foreign, ModelError, ModelFormat, WriteError};
use burgeon::light::LightError;
use burgeon::skin::SolidError;
use burgeon::{
    AllowanceError, AssemblyError, HeightError, LightSourceError, SceneError, Slip, SplitError, Stopped,
    TreeError, WrongEngineFile,
};

/// Reason why a workspace refused a request; the workspace is unchanged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WorkspaceError {
    /// The document has no plant.
    #[error("there is no plant; add one first")]
    NoPlant,
    /// The plant that is to be chosen was deleted.
    #[error("that plant is not there any more")]
    PlantGone,
    /// No preset has that key.
    #[error("there is no tree {0:?}")]
    NoTree(String),
    /// None of the strokes exists.
    #[error("no stroke is selected")]
    NoStroke,
    /// The text is not a drawing.
    #[error("the clipboard holds no drawing")]
    NoClipboard,
    /// The file has no drawing.
    #[error("there is no drawing in it")]
    NoDrawing,
    /// Every stroke is empty.
    #[error("there is no stroke in it that can be used")]
    NoUsableStroke,
    /// The kind of the file is unknown.
    #[error(
        "this is no file that Burgeon reads: give a project (.burgeon), a drawing ({}), marks of a leaf (.csv), a tree or \
         flower (.toml) or a model ({})",
        DrawingFormat::read_endings(),
        ModelFormat::read_endings()
    )]
    UnknownFile,
    /// It is a file of another program.
    #[error("{0}")]
    Foreign(Foreign),
    /// The bytes are not UTF-8.
    #[error(transparent)]
    NotText(#[from] core::str::Utf8Error),
    /// The obstacle is not a model.
    #[error("an obstacle is a model: give a {} file", ModelFormat::read_endings())]
    ObstacleFile,
    /// A model without triangles.
    #[error("there is no surface in it")]
    NoSurface,
    /// There is nothing to export.
    #[error("there is no plant yet: draw at least one line, or add a tree, a leaf or a flower")]
    NothingMade,
    /// A model that is only shown is neither a plant nor a drawing.
    #[error("models are not written as {0:?}")]
    Format(&'static str),
    /// A body for a printer is made of one plant.
    #[error("a print is one body: choose one plant, not the whole scene")]
    PrintsOne,
    /// A number of the request is outside its range.
    #[error("{field} must be {range}, not {value}")]
    Range {
        /// Its name.
        field: &'static str,
        /// The number.
        value: f64,
        /// What it may be.
        range: String,
    },
    /// The plant cannot be as small as requested.
    #[error(transparent)]
    Allowance(#[from] AllowanceError),
    /// A tree cannot have the size.
    #[error(transparent)]
    Height(HeightError),
    /// Only trees have a diameter at breast height.
    #[error("only a grown tree has a diameter at breast height; give a height or a width")]
    NoGirth,
    /// The plant cannot be a skeleton with leaves on its joints.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// A skeleton with leaves on its joints has one level.
    #[error("Nanite makes coarser copies itself: export one level of detail, without a budget")]
    AssemblyLevels,
    /// No body for a printer can be made.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// A program is not given files of this format.
    #[error(transparent)]
    EngineFile(#[from] WrongEngineFile),
    /// Sky and sun give no light.
    #[error(transparent)]
    Source(LightSourceError),
    /// Light cannot be followed.
    #[error(transparent)]
    Light(LightError),
    /// The tool needs a plant.
    #[error("there is no plant to shape yet")]
    NothingToShape,
    /// No copy has room at the requested place.
    #[error("no copy has room there: make the place larger or the spacing smaller")]
    NowhereToStand,
    /// The document refused.
    #[error(transparent)]
    Command(#[from] CommandError),
    /// The project cannot be read or written.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// The drawing cannot be read.
    #[error(transparent)]
    Drawing(#[from] DrawingError),
    /// The model cannot be read.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The tree's file cannot be read.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// The growth law cannot be read.
    #[error("the growth law: {}", burgeon::plainly(&.0.to_string()))]
    Law(#[source] serde_json::Error),
    /// The record of gestures cannot be read.
    #[error("the record of gestures: {}", burgeon::plainly(&.0.to_string()))]
    Record(#[source] serde_json::Error),
    /// The record of gestures is of another form.
    #[error("the record of gestures is of another form: {0:?}")]
    RecordForm(String),
    /// The record of gestures is too long.
    #[error("the record of gestures is too long: at most {most} steps")]
    RecordLong {
        /// Largest number of steps.
        most: usize,
    },
    /// The project in a record of gestures is not base64.
    #[error("the project in the record of gestures is not in base64")]
    RecordProject,
    /// The numbers in a record of gestures are not those of its plants.
    #[error("the numbers in the record of gestures are not those of the plants of its project")]
    RecordNumbers,
    /// A record refers to an edit that no gesture made.
    #[error("the record of gestures keeps an edit that none of its gestures made")]
    RecordKeeps,
    /// The plant cannot be made.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The drawing stays one plant.
    #[error(transparent)]
    Split(#[from] SplitError),
    /// The photograph is not accepted.
    #[error(transparent)]
    Photo(#[from] PhotoError),
    /// The picture cannot be a material of organs.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Several files do not fit into one.
    #[error(transparent)]
    Archive(#[from] ArchiveError),
    /// Stopped from outside: a newer change, or the person.
    #[error("cancelled")]
    Cancelled,
    /// A command that cannot be read: a bug of the shell.
    #[error("the message cannot be read: {}", burgeon::plainly(.0))]
    Message(String),
    /// Our bug.
    #[error("internal: {0}")]
    Internal(&'static str),
}

impl From<Stopped> for WorkspaceError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Cancelled(_) => Self::Cancelled,
            Stopped::OverBudget(o) => Self::Tree(TreeError::OverBudget(o)),
        }
    }
}

burgeon::coded!(WorkspaceError {
    Self::NoPlant => "no-plant" {},
    Self::PlantGone => "plant-gone" {},
    Self::NoTree(name) => "no-tree" { name },
    Self::NoStroke => "no-stroke" {},
    Self::NoClipboard => "no-clipboard" {},
    Self::NoDrawing => "no-drawing" {},
    Self::NoUsableStroke => "no-usable-stroke" {},
    Self::UnknownFile => "unknown-file" {},
    Self::NotText(why) => "not-text" { why },
    Self::ObstacleFile => "obstacle-file" {},
    Self::NoSurface => "no-surface" {},
    Self::NothingMade => "nothing-made" {},
    Self::Format(format) => "no-such-export" { format },
    Self::NothingToShape => "nothing-to-shape" {},
    Self::Range { field, value, range } => "field-range" { field, range, value },
    Self::NoGirth => "no-girth" {},
    Self::PrintsOne => "prints-one" {},
    Self::Assembly(why) => "no-assembly" { why },
    Self::AssemblyLevels => "assembly-levels" {},
    Self::Solid(why) => "no-print" { why },
    Self::EngineFile(WrongEngineFile { wanted, given }) => "engine-file" { wanted = wanted.join(" / ."), given },
    Self::NowhereToStand => "nowhere-to-stand" {},
    Self::Law(why) => "law" { why = &Slip::from_message(&why.to_string()) => Slip },
    Self::Record(why) => "record" { why = &Slip::from_message(&why.to_string()) => Slip },
    Self::RecordForm(form) => "record-form" { form },
    Self::RecordLong { most } => "record-long" { most },
    Self::RecordProject => "record-project" {},
    Self::RecordNumbers => "record-numbers" {},
    Self::RecordKeeps => "record-keeps" {},
    Self::Cancelled => "cancelled" {},
    Self::Message(why) => "message" { why = &Slip::from_message(why) => Slip },
    Self::Internal(why) => "internal" { why },
} wraps {
    Self::Command(e) => e, CommandError;
    Self::Project(e) => e, ProjectError;
    Self::Foreign(e) => e, Foreign;
    Self::Drawing(e) => e, DrawingError;
    Self::Model(e) => e, ModelError;
    Self::Tree(e) => e, TreeError;
    Self::Allowance(e) => e, AllowanceError;
    Self::Height(e) => e, HeightError;
    Self::Scene(e) => e, SceneError;
    Self::Split(e) => e, SplitError;
    Self::Photo(e) => e, PhotoError;
    Self::Picture(e) => e, PictureError;
    Self::Write(e) => e, WriteError;
    Self::Source(e) => e, LightSourceError;
    Self::Light(e) => e, LightError;
    Self::Archive(e) => e, ArchiveError;
});
