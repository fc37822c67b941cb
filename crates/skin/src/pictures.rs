//! Pictures from which surfaces take their pixels.

use std::sync::Arc;

use mesh::Texture;

use crate::traced::Traced;

/// Pictures on the surfaces of a plant, instead of painted textures.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfacePictures<'a> {
    /// The photograph under a drawing.
    pub traced: Option<&'a Traced>,
    /// Pictures of measured leaves, by the number of their form ([`plant::SplineBlade::form`]).
    pub leaves: &'a [Option<Arc<Texture>>],
}
