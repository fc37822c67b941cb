//! The structure of a plant with the meshes of its organs, as a file.

use std::io::Write;

use formats::{ExportSpec, WriteError, write_opf as write};
use plant::Plant;
use skin::{SkinSpec, shape_meshes};

/// Writes a plant as Open Plant Format: its structure, and its organs as [`skin::skin`] draws them with the usual
/// fineness. See [`formats::write_opf`].
///
/// # Errors
/// [`WriteError::Io`].
pub fn write_opf(plant: &Plant, spec: &ExportSpec, out: impl Write) -> Result<(), WriteError> {
    write(plant, &shape_meshes(plant, &SkinSpec::default()), spec, out)
}
