//! What makers give: a plant, its meshes, its entry of the report.

use base::{Digest, Report};
use document::PlantEdit;
use mesh::Model;
use plant::Plant;
use reading::Reading;

use crate::report::{Counts, ItemReport, TimingsMs};
use crate::shaping::EditReport;

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

impl MadePlant {
    /// With an entry that tells counts, times, digest, warnings, and what became of the edits that were asked for.
    pub(crate) fn new(
        plant: Plant,
        model: Model,
        (edits, asked): (Vec<EditReport>, &[PlantEdit]),
        report: &Report,
    ) -> Self {
        let mut digest = Digest::new();
        digest.add(&model);
        let mut warnings: Vec<String> = report.warnings.iter().map(ToString::to_string).collect();
        warnings.extend(edits.iter().filter_map(|e| e.warning(asked)));
        let item = ItemReport {
            name: plant.name.clone(),
            counts: Counts {
                vertices: model.vertex_count() as u64,
                triangles: model.triangle_count() as u64,
                ..Counts::of_plant(&plant)
            },
            timings_ms: TimingsMs::from_report(report),
            digest: digest.hex(),
            warnings,
            edits,
            ..ItemReport::default()
        };
        Self { plant, model, item }
    }
}
