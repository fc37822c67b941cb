//! Results of makers: a plant, its meshes, its entry of the report.

use base::{Digest, Report, Run, Stopped};
use document::PlantEdit;
use mesh::Model;
use plant::Plant;
use reading::Reading;
use skin::{Layout, SkinSpec, SurfacePictures};

use crate::checks::check_plant;
use crate::levels::{LaidOut, LevelSpec, Levels, level_of, levels_of};
use crate::report::{CheckReport, Counts, ItemReport, TimingsMs};
use crate::shaping::EditReport;

/// Everything made from one drawing.
#[derive(Clone, Debug)]
pub struct Made {
    /// The reading, still flat.
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
    /// Places of the plant's parts in the model.
    pub layout: Layout,
    /// Skin settings with which it was meshed.
    pub(crate) skin: SkinSpec,
    /// The report's entry; `output` and the times of reading and writing are the shell's to fill.
    pub item: ItemReport,
}

impl MadePlant {
    /// Returns a coarser copy of the meshes, with the same materials: each level has at most half of the triangles of
    /// the one before. Plants of hundreds of leaves or axes lose some of them, others keep all.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn at_level(&self, level: u32, run: &Run<'_>) -> Result<Model, Stopped> {
        Ok(coarse(&self.plant, &self.skin, &self.model, level, run)?.0)
    }

    /// Returns coarser copies and the other levels of `spec`.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn levels(&self, spec: &LevelSpec, run: &Run<'_>) -> Result<Levels, Stopped> {
        coarser_copies(spec, (&self.model, &self.plant, &self.layout), &self.skin, run)
    }

    /// Makes an entry with counts, times, warnings and the outcomes of the requested edits; [`Self::with_digest`] adds
    /// the digest.
    pub(crate) fn untold(
        plant: Plant,
        ((model, layout), skin): ((Model, Layout), SkinSpec),
        (edits, asked): (Vec<EditReport>, &[PlantEdit]),
        report: &Report,
    ) -> Self {
        let mut warnings = report.warnings.clone();
        warnings.extend(edits.iter().filter_map(|e| e.warning(asked)));
        let mut item = ItemReport {
            name: plant.name.clone(),
            counts: Counts {
                vertices: model.vertex_count() as u64,
                triangles: model.triangle_count() as u64,
                ..Counts::from_plant(&plant)
            },
            timings_ms: TimingsMs::from_report(report),
            edits,
            checks: report.checks.iter().map(CheckReport::from).collect(),
            ..ItemReport::default()
        }
        .warning(warnings);
        let mut checks = Report::default();
        check_plant(&plant, &mut checks);
        item.add_checks(checks);
        Self { plant, model, layout, skin, item }
    }

    /// Adds checks of facts that only the maker knows.
    pub(crate) fn check(mut self, checks: impl FnOnce(&mut Report)) -> Self {
        let mut report = Report::default();
        checks(&mut report);
        self.item.add_checks(report);
        self
    }

    /// Adds the digest of the meshes.
    pub(crate) fn with_digest(mut self) -> Self {
        self.item.digest = digest(&self.model);
        self
    }
}

/// Returns the digest of a plant's meshes.
pub(crate) fn digest(model: &Model) -> String {
    let mut digest = Digest::new();
    digest.add(model);
    digest.hex()
}

/// Makes the levels of a plant without pictures of its own.
pub(crate) fn coarser_copies(
    spec: &LevelSpec,
    (model, plant, layout): (&Model, &Plant, &Layout),
    skin: &SkinSpec,
    run: &Run<'_>,
) -> Result<Levels, Stopped> {
    let levels = levels_of(plant, (skin, model), spec.lods, |plant, skin| {
        skin::skin_laid_out(plant, skin, SurfacePictures::default(), None, run)
    })?;
    let mut levels = levels.into_iter();
    Levels::new(spec, (model, plant, layout), |_| Ok(levels.next()), run)
}

/// Makes a level of a plant without pictures of its own, see [`level_of`].
pub(crate) fn coarse(
    plant: &Plant,
    skin: &SkinSpec,
    fine: &Model,
    level: u32,
    run: &Run<'_>,
) -> Result<LaidOut, Stopped> {
    level_of(plant, (skin, fine), level, |plant, skin| {
        skin::skin_laid_out(plant, skin, SurfacePictures::default(), None, run)
    })
}
