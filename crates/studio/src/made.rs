//! What makers give: a plant, its meshes, its entry of the report.

use mesh::Model;
use plant::Plant;
use reading::Reading;

use crate::report::ItemReport;

/// Everything made from one drawing.
#[derive(Clone, Debug)]
pub struct Made {
    /// What was meant, still flat.
    pub reading: Reading,
    /// The plant.
    pub plant: Plant,
    /// Its meshes and materials.
    pub model: Model,
    /// The report's entry; `output` and the times of reading and writing are the shell's to fill.
    pub item: ItemReport,
}

/// A plant of measured leaves or of flowers that open, with its meshes.
#[derive(Clone, Debug)]
pub struct MadePlant {
    /// The plant.
    pub plant: Plant,
    /// Its meshes and materials.
    pub model: Model,
    /// The report's entry; `output` and the times of reading and writing are the shell's to fill.
    pub item: ItemReport,
}
