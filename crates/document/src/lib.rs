//! The user's work, as it is saved: descriptions, never results.
//!
//! `Command -> Editor (decide -> Event -> apply) -> Document <-> project file (.burgeon)`
//!
//! | module | owns |
//! |---|---|
//! | `state` | [`Document`]: plants with name, seed, place, hand edits, strokes |
//! | `makers` | [`Maker`]: the settings of each maker |
//! | `command` | [`Command`]: requests, checked against the document; a small enum for each maker |
//! | `event` | [`Event`]: changes, applied forwards and backwards |
//! | `editor` | [`Editor`]: named, unlimited undo; a gesture is one step |
//! | `file` | [`read_project`], [`write_project`]: a zip of versioned JSON |
//! | `versions` | the structs of each version of the file |
//! | `photo`, `picture` | [`Photo`]: the picture under the drawing; [`WornPicture`]: pictures of materials |
//! | `archive` | [`pack`] and the bounded reading of zip files |
//!
//! Coordinates of strokes are the drawing's own unit, y up, as in [`ink::Drawing`].

mod archive;
mod command;
mod editor;
mod event;
mod fault;
mod file;
mod ids;
mod makers;
mod names;
mod photo;
mod picture;
mod state;
mod versions;

pub use archive::{ArchiveError, pack};
pub use command::{
    Carry, Command, CommandError, FlowerCommand, LeafCommand, NewPlant, NewStroke, PlantCommand,
    SceneCommand, ShapeCommand, SketchCommand, TreeCommand,
};
pub use editor::{Editor, Step};
pub use event::{Event, StrokeRows};
pub use fault::SettingFault;
pub use file::{MAX_PROJECT_BYTES, PROJECT_SCHEMA, ProjectError, is_project, read_project, write_project};
pub use ids::{PlantId, PlantNumbers, StrokeId};
pub use makers::{FlowerMaker, LeafData, LeafMaker, Maker, NamedObstacle, SketchSettings, TreeSettings};
pub use photo::{MAX_PHOTO_BYTES, Photo, PhotoError, PhotoPlace};
pub use picture::{PictureError, WornPicture, WornPictures};
pub use state::{
    Document, DocumentFault, DocumentPlant, DocumentStroke, Placement, PlantEdit, Settings, range_fault,
};
