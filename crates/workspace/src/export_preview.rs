//! State kept for the preview of an export, and what became of the last print.

use burgeon::formats::PngCache;
use burgeon::mesh::Model;
use burgeon::skin::{FoliageStyle, SolidSpec};
use burgeon::{PrintedPlant, SceneEvaluator};
use schemars::JsonSchema;
use serde::Serialize;

#[derive(Debug, Default)]
pub(crate) struct ExportPreview {
    /// Evaluation with other surfaces, of the document at this revision: another level is not skinned twice.
    pub(crate) dressed: Option<((u64, SurfaceAsk), SceneEvaluator)>,
    pub(crate) models: Vec<Model>,
    pub(crate) pngs: PngCache,
}

/// A body for a printer beside its plant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PrintFigures {
    /// Number of times that the plant is larger.
    pub scale: f64,
    /// Least thickness of any part, millimetres: thinner ones are thickened.
    pub wall_mm: f64,
    /// Number of surfaces that were left out, as they hang on nothing or lie within the body.
    pub loose: u32,
}

impl PrintFigures {
    pub(crate) fn from_print(made: &PrintedPlant) -> Self {
        let wall_mm = SolidSpec::default().wall_m * 1e3;
        Self { scale: made.scale, wall_mm, loose: u32::try_from(made.loose).unwrap_or(u32::MAX) }
    }
}

/// Requests to the surfaces of plants: wind columns, how leaves are drawn, pixels of textures.
pub(crate) type SurfaceAsk = (bool, Option<FoliageStyle>, Option<u32>);

/// Contents of the files of the last export of models.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct WrittenFigures {
    /// Triangles of each level, the finest first, and of the views from all sides; those of copies count each time.
    pub triangles: Vec<u64>,
    /// Level of detail of the first of them: 0, the finest, unless triangles or megabytes are limited.
    pub level: usize,
    /// Number of halvings of the sides of the textures, to keep within the megabytes.
    pub halvings: u32,
}
