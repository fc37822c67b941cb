//! The structure of a plant as a file, with the meshes of its organs where the format has them.

use std::io::Write;

use formats::{AddedColumn, ExportSpec, Room, StructureFormat, WriteError};
use plant::Plant;
use skin::{SkinSpec, shape_meshes};

/// Writes the structure of a plant; where the format has meshes, its organs as [`skin::skin`] draws them with the
/// default fineness. See [`formats::write_structure`].
///
/// # Errors
/// [`WriteError::Io`].
pub fn write_structure(
    plant: &Plant,
    format: StructureFormat,
    spec: &ExportSpec,
    out: impl Write,
) -> Result<(), WriteError> {
    write_structure_with(plant, &[], format, spec, out)
}

/// Writes as [`write_structure`] does, with additional columns of axes and organs: see
/// [`formats::write_structure_with`].
///
/// # Errors
/// [`WriteError::Io`].
pub fn write_structure_with(
    plant: &Plant,
    added: &[AddedColumn],
    format: StructureFormat,
    spec: &ExportSpec,
    out: impl Write,
) -> Result<(), WriteError> {
    let has_meshes = format.holds(Room::OrganMeshes);
    let shapes = if has_meshes { shape_meshes(plant, &SkinSpec::default()) } else { Vec::new() };
    formats::write_structure_with(plant, &shapes, added, format, spec, out)
}
