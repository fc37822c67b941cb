//! What is kept of an export that is shown before it is written.

use burgeon::SceneEvaluator;
use burgeon::formats::PngCache;
use burgeon::mesh::Model;

#[derive(Debug, Default)]
pub(crate) struct ExportPreview {
    /// With wind, of the document at this revision: another level is not skinned twice.
    pub(crate) blown: Option<(u64, SceneEvaluator)>,
    pub(crate) models: Vec<Model>,
    pub(crate) pngs: PngCache,
}
