//! Work on a document: drawing, drafts, shaping by hand, viewing, opening and exporting. Any shell may hold one.
//!
//! `Command | Action | stroke | pointer -> Workspace -> DocumentState, SceneView, columns of meshes, files`
//!
//! | module | owns |
//! |---|---|
//! | `workspace` | [`Workspace`]: the document with its history, the chosen plant, the draft |
//! | `files` | files in and out |
//! | `export` | models and structures as files |
//! | `exported` | previews of exports |
//! | `engines` | settings of exports for the programs that plants go to |
//! | `evaluate` | plants made and shown, meshes as columns |
//! | `kept` | retention of results |
//! | `levels`, `shown` | levels of detail for shells that draw little |
//! | `lit` | plants coloured by the light that they absorb |
//! | `record` | gestures as a file, and their replay |
//! | `shaping` | tools that shape a plant by hand |
//! | `state` | the document as a shell shows it |
//! | `view` | the plants as a shell shows them |
//! | `error` | [`WorkspaceError`] |
//!
//! It reads no clock and opens no file: computations take a [`burgeon::Run`], and files are passed as bytes.

mod copies;
mod engines;
mod error;
mod evaluate;
mod export;
mod export_preview;
mod exported;
mod files;
mod held;
mod kept;
mod levels;
mod lit;
mod record;
mod scatter;
mod shaping;
mod shown;
mod sizing;
mod state;
mod view;
mod workspace;

#[cfg(test)]
mod tests;

pub use engines::{EngineAnswer, EngineAsk, EngineSet};
pub use error::WorkspaceError;
pub use export::{ExportFormat, ExportRequest, NamedFile, packed};
pub use export_preview::{PrintFigures, WrittenFigures};
pub use exported::{ExportView, ExportedPlant, PartFigures};
pub use files::{FileKind, Opened};
pub use held::CarriedPose;
pub use kept::{KEPT_BYTES, SHOWN_BYTES};
pub use lit::{LightAsk, LightPlace, LightView};
pub use record::{GESTURES_SCHEMA, GestureDeed, GestureRecord, GestureStep, HandDeed, MOST_STEPS, Replayed};
pub use scatter::{Ground, Scatter, stand};
pub use shaping::{Grown, Picked, ShapeAnswer, ShapeInput, ShapePointer, ShapeReach, ShapeStep};
pub use sizing::SizeGoal;
pub use state::{
    DocumentState, EditState, FlowerState, LeafState, MakerWord, NamedShape, ObstacleView, PenStyle,
    PhotoState, PlantState, SketchState, StrokeState, TreeState, WearState,
};
pub use view::{
    Column, Front, GUEST, MaterialView, PartView, PlantView, SceneView, TextureView, WarningView,
};
pub use workspace::{Action, NewMaker, Workspace};
