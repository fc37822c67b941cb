//! Levels of one model -> a GLB, plain or packed.

use std::io::Write;

use super::PngCache;
use super::glb_pack::{Joining, Packing, write_packed};
use super::glb_write::{Level, Morph, write_all};
use crate::error::WriteError;

/// Writes levels of one model, finest first, as one GLB: the first as [`write_glb`](super::write_glb) or, packed, as
/// [`write_glb_packed`](super::write_glb_packed) does; each coarser one below a node of its own that the first's node
/// names (`MSFT_lod`) and that is in no scene, so that a program without levels shows only the first. Each level is
/// meant for half the size in a picture of the one before (`MSFT_screencoverage`); the last is for all sizes below.
/// Textures that levels share are written once. Copies are instances (`EXT_mesh_gpu_instancing`, required if there
/// are any), each with its colour as `_COLOR_0`.
///
/// # Errors
/// As [`write_glb`](super::write_glb), for any of the models.
pub fn write_glb_levels(
    levels: &[Level<'_>],
    packing: Option<Packing>,
    cache: &mut PngCache,
    out: impl Write,
) -> Result<(), WriteError> {
    match packing {
        Some(packing) => write_packed(levels, (packing, Joining::Apart), cache, out),
        None => write_all(levels, &Morph::default(), cache, out),
    }
}
