//! Help texts that list formats, from the table of formats.

use burgeon::formats::{DrawingFormat, ModelFormat, RobotFormat, Room, StructureFormat};

use super::plant_format::PlantFormat;

/// Returns the endings of files of the structure of plants, for messages.
pub(crate) fn structure_endings() -> String {
    format!("{} or a table of cylinders (.csv, .txt)", StructureFormat::read_endings())
}

/// Describes a plant as a model, as its structure or as a robot.
pub(crate) fn plant_output() -> String {
    let (models, structures) = (ModelFormat::written_endings(), PlantFormat::structure_endings());
    let robots = RobotFormat::written_endings();
    format!(
        "The model ({models}), the structure ({structures}), or bodies and joints for simulators ({robots})."
    )
}

pub(crate) fn sketch_output() -> String {
    let plant = plant_output();
    format!("{plant} For several drawings a folder, which is created and gets one file each.")
}

pub(crate) fn leaf_output() -> String {
    format!("{} With --template the file to fill in.", plant_output())
}

pub(crate) fn bloom_output() -> String {
    let (moving, models) = (ModelFormat::endings_with(Room::Morphs), ModelFormat::written_endings());
    let structures = PlantFormat::structure_endings();
    format!(
        "The result: an animation ({moving}), one shape ({models}; --day, or another format than {moving}), the structure of \
         a flower or drawing ({structures}), or a folder (a file a frame)."
    )
}

/// `of`: the subject, with a space before it, if only some have it.
pub(crate) fn wind(of: &str) -> String {
    let endings = ModelFormat::endings_with(Room::Wind);
    format!(
        "Also write how wind moves each vertex{of}, for shaders, into {endings}: attributes _WIND and _PIVOT, in USD primvars \
         (docs/exports.md)."
    )
}

/// Describes a model, or the structure of a plant.
pub(crate) fn render_input() -> String {
    format!(
        "The model ({}), or the structure of a plant ({}).",
        ModelFormat::read_endings(),
        structure_endings()
    )
}

pub(crate) fn info_input() -> String {
    let (models, drawings) = (ModelFormat::read_endings(), DrawingFormat::read_endings());
    let structures = structure_endings();
    format!(
        "The file: a model ({models}), a drawing ({drawings}), the structure of a plant ({structures}) or a project (.burgeon)."
    )
}

pub(crate) fn obstacle() -> String {
    let models = ModelFormat::read_endings();
    format!(
        "A solid mesh ({models}) to grow around, in the axes of --up and the --unit (glTF: metres, +Y up); may be given \
         several times."
    )
}

/// `subject`: the plant that bears the leaf, and what it bears without one.
pub(crate) fn leaf_template(subject: &str) -> String {
    let models = ModelFormat::read_endings();
    format!(
        "A leaf that {subject}: marks (.csv), a vein graph (.json) or a model of one leaf ({models}) with its root at the \
         origin."
    )
}

pub(crate) fn convert() -> String {
    let (read, written) = (ModelFormat::read_endings(), ModelFormat::written_endings());
    let (drawn, kept) = (DrawingFormat::read_endings(), DrawingFormat::written_endings());
    let structures = structure_endings();
    format!(
        "Convert a model, a drawing or the structure of a plant to another format\n\nModels: {read} to {written}. Drawings: \
         {drawn} to {kept}. A drawing becomes a model with `burgeon sketch`. Structure of plants: {structures} to the same (a \
         table of cylinders as .qsm.csv) and to models; `burgeon shape` has all options of their surface."
    )
}
