//! What a person made and what is saved: descriptions, never results.
//!
//! `Command -> Editor (decide -> Event -> apply) -> Document <-> project file (.burgeon)`
//!
//! | module | owns |
//! |---|---|
//! | `state` | [`Document`]: strokes with their corrections, settings, seed |
//! | `command` | [`Command`]: what can be asked, checked against the document |
//! | `event` | [`Event`]: what happened; applied forwards and backwards |
//! | `editor` | [`Editor`]: named, unlimited undo; a gesture is one step |
//! | `file` | [`read_project`], [`write_project`]: a zip of versioned JSON |
//! | `photo` | [`Photo`]: what lies under the drawing |
//! | `archive` | [`pack`] and the bounded reading of zip files |
//!
//! Coordinates are the drawing's own unit, y up, as in [`sketch::Drawing`].

mod archive;
mod command;
mod editor;
mod event;
mod file;
mod photo;
mod state;

pub use archive::{ArchiveError, pack};
pub use command::{Command, CommandError, NewStroke};
pub use editor::{Editor, Step};
pub use event::Event;
pub use file::{MAX_PROJECT_BYTES, PROJECT_SCHEMA, ProjectError, is_project, read_project, write_project};
pub use photo::{MAX_PHOTO_BYTES, Photo, PhotoError};
pub use state::{Document, DocumentFault, DocumentStroke, Settings, StrokeId, range_fault};
