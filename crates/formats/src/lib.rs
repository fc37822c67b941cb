//! Readers of strokes, readers and writers of models, on byte streams: no paths, no file system.
//!
//! bytes -> [`read_drawings`] -> [`sketch::Drawing`]; [`mesh::Model`] -> [`write_glb`] -> bytes.
//!
//! What comes in may be hostile: sizes, nesting and expansion are bounded, errors name the place and what to
//! do, and nothing panics. Inside, y points up and lengths are metres; everything else is turned at this
//! border.

mod drawing;
mod error;
mod model;

pub use drawing::{DrawingFormat, Drawings, MAX_DRAWING_BYTES, ReadDrawing, read_drawings, write_drawing};
pub use error::{DrawingError, FileFault, ModelError, Place, WriteError};
pub use model::{ExportSpec, ModelFormat, PngCache, read_picture, write_glb, write_glb_with, write_png};
