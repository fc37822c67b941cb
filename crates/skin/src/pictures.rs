//! Where surfaces take their pixels from.

use std::sync::Arc;

use mesh::Texture;

use crate::traced::Traced;

/// Pictures that lie on the surfaces of a plant, in the place of painted textures.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfacePictures<'a> {
    /// The photograph under a drawing.
    pub traced: Option<&'a Traced>,
    /// Of measured leaves, by the number of their form ([`plant::SplineBlade::form`]).
    pub leaves: &'a [Option<Arc<Texture>>],
}
