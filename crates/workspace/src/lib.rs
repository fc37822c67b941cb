//! What a person does with a document: draws, drafts, shapes by hand, looks, opens and exports. Any shell may hold one.
//!
//! `Command | Action | stroke | pointer -> Workspace -> DocumentState, SceneView, columns of meshes, files`
//!
//! | module | owns |
//! |---|---|
//! | `workspace` | [`Workspace`]: the document with its history, the plant that is chosen, the draft |
//! | `files` | files in and out |
//! | `export` | models and structures as files |
//! | `exported` | exports that are shown before they are written |
//! | `evaluate` | plants made and shown, meshes as columns |
//! | `kept` | how long results are kept |
//! | `levels`, `shown` | levels of detail for shells that draw little |
//! | `record` | gestures as a file, and their replay |
//! | `shaping` | tools that shape a plant by hand |
//! | `state` | what a shell shows of the document |
//! | `view` | what a shell shows of the plants |
//! | `error` | [`WorkspaceError`] |
//!
//! It reads no clock and opens no file: what computes takes a [`burgeon::Run`], files come and go as bytes.

mod copies;
mod error;
mod evaluate;
mod export;
mod export_preview;
mod exported;
mod files;
mod held;
mod kept;
mod levels;
mod record;
mod scatter;
mod shaping;
mod shown;
mod state;
mod view;
mod workspace;

#[cfg(test)]
mod tests;

pub use error::WorkspaceError;
pub use export::{ExportFormat, ExportRequest, NamedFile, packed};
pub use exported::{ExportView, ExportedPlant, PartFigures};
pub use files::{FileKind, Opened};
pub use held::CarriedPose;
pub use kept::{KEPT_BYTES, SHOWN_BYTES};
pub use record::{GESTURES_SCHEMA, GestureDeed, GestureRecord, GestureStep, HandDeed, MOST_STEPS, Replayed};
pub use scatter::{Ground, Scatter, stand};
pub use shaping::{Grown, Picked, ShapeAnswer, ShapeInput, ShapePointer, ShapeReach, ShapeStep};
pub use state::{
    DocumentState, EditState, FlowerState, LeafState, MakerWord, NamedShape, ObstacleView, PenStyle,
    PhotoState, PlantState, SketchState, StrokeState, TreeState, WearState,
};
pub use view::{
    Column, Front, GUEST, MaterialView, PartView, PlantView, SceneView, TextureView, WarningView,
};
pub use workspace::{Action, NewMaker, Workspace};
