//! A plant as named nodes of one file: levels of detail, and shapes for collisions with its wood.

use std::io::Write;

use formats::{BesideFile, NamedNodes, PngCache, WriteError, write_glb_nodes};
use mesh::Model;
use plant::Plant;

use crate::engine::{Engine, ShapeNames};
use crate::pivot_painter::PivotPainter;

/// Writes the GLB of a plant for a program that tells levels and shapes for collisions by the names of their nodes
/// ([`Engine::has_nodes`]). `levels`: its models, the finest first.
///
/// Guaranteed: below a root with the plant's name one node for each level (`oak_LOD0`, `oak_LOD1`, ...; `oak_mesh` if
/// there is only one), and the wood as the program wants it for collisions: `oak_collider`, `oak-colonly`, or
/// `UCX_oak_mesh_00` and so on. A plant without stems has no shape. Wind columns are texture coordinates
/// ([`write_glb_nodes`]); where the program reads pivots from textures ([`engine_textures`]), set 1 says where.
///
/// # Errors
/// As [`write_glb_nodes`].
pub fn write_engine_glb(
    engine: Engine,
    plant: &Plant,
    levels: &[&Model],
    cache: &mut PngCache,
    out: impl Write,
) -> Result<(), WriteError> {
    let stem = formats::file_name(&plant.name, "plant").to_lowercase();
    let count = levels.len();
    let name = |k: usize| if count == 1 { format!("{stem}_mesh") } else { format!("{stem}_LOD{k}") };
    let levels: Vec<(String, &Model)> =
        levels.iter().enumerate().map(|(k, model)| (name(k), *model)).collect();
    let pieces = skin::colliders(plant);
    let shapes = match (engine.shape_names(), levels.first()) {
        (Some(ShapeNames::Whole(ending)), _) if !pieces.is_empty() => {
            vec![(format!("{stem}{ending}"), skin::joined_colliders(&pieces))]
        }
        (Some(ShapeNames::Pieces(start)), Some((shown, _))) => {
            let named = |(k, piece)| (format!("{start}{shown}_{k:02}"), piece);
            pieces.into_iter().enumerate().map(named).collect()
        }
        _ => Vec::new(),
    };
    let painter = if engine.paints_pivots() { PivotPainter::new(plant) } else { None };
    let cells = painter.map_or_else(Vec::new, |p| levels.iter().map(|(_, model)| p.cells(model)).collect());
    write_glb_nodes(&NamedNodes { name: stem, levels, shapes, cells }, cache, out)
}

/// Returns the textures that belong to the GLB of a plant for a program ([`write_engine_glb`]) and that it does not name:
/// for Unreal the pivots, parents, directions and extents of the plant's parts as Pivot Painter 2 has them,
/// `STEM-pivots.exr` and `STEM-axes.png`; none for others, and for a plant without parts. `model`: its finest level, with
/// columns of the wind.
///
/// # Errors
/// [`WriteError`].
pub fn engine_textures(
    engine: Engine,
    plant: &Plant,
    model: &Model,
    stem: &str,
) -> Result<Vec<BesideFile>, WriteError> {
    let painter = if engine.paints_pivots() { PivotPainter::new(plant) } else { None };
    painter.map_or_else(|| Ok(Vec::new()), |painter| painter.textures(model, stem))
}
