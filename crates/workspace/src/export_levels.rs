//! Levels of detail of an export, each as one model, within what it may come to.
//!
//! `plants + request -> a model of all plants at each level -> the first that fits and those after it -> files`

use burgeon::document::{Document, DocumentPlant, PlantId};
use burgeon::formats::{self, PngCache, Room};
use burgeon::mesh::{Copies, Model};
use burgeon::plant::Plant;
use burgeon::{FileForm, Levels, Run, SceneEvaluator};
use schemars::JsonSchema;
use serde::Serialize;

use crate::export::{Level, MOST_LEVELS, NamedFile, far, gltf_named, written};
use crate::{ExportRequest, WorkspaceError};

/// Contents of the files of the last export of models.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct WrittenFigures {
    /// Triangles of each level, the finest first, and of the views from all sides; those of copies count each time.
    pub triangles: Vec<u64>,
    /// Level of detail of the first of them: 0, the finest, unless triangles or megabytes are limited.
    pub level: usize,
    /// Number of halvings of the sides of the textures, to keep within the megabytes.
    pub halvings: u32,
}

/// A level as one model of the whole scene, and what it is without leaves of one form, where these are written once.
#[derive(Clone, Debug)]
pub(crate) struct Joined {
    pub(crate) model: Model,
    pub(crate) copies: Option<(Model, Vec<Copies>)>,
}

impl Joined {
    fn level(&self) -> formats::Level<'_> {
        match &self.copies {
            Some((model, copies)) => formats::Level { model, copies },
            None => formats::Level::plain(&self.model),
        }
    }
}

/// Levels of an export: views from all sides, if there are any, are the last.
#[derive(Clone, Debug)]
pub(crate) struct ExportLevels {
    pub(crate) models: Vec<Joined>,
    /// The only exported plant, for programs that want its shapes for collisions; else an empty one.
    pub(crate) plant: Plant,
    pub(crate) figures: WrittenFigures,
}

impl ExportLevels {
    /// Makes the levels of `plants`, of which `scene` has the results. `only`: the one that is exported without its place.
    ///
    /// # Errors
    /// [`WorkspaceError::Allowance`] where even the coarsest level is too large.
    pub(crate) fn make(
        (scene, document): (&SceneEvaluator, &Document),
        plants: &[&DocumentPlant],
        (only, wanted): (Option<PlantId>, &ExportRequest),
        run: &Run<'_>,
    ) -> Result<Self, WorkspaceError> {
        let coarser = wanted.levels.clamp(1, MOST_LEVELS) - 1;
        let models: Result<Vec<Joined>, WorkspaceError> = (0..=wanted.allowance().levels(coarser))
            .map(|level| {
                let at = Level::make(scene, plants, (level, wanted), run)?;
                Ok(at.joined(document.name(), plants, only.is_some()))
            })
            .collect();
        let mut models = models?;
        let far = match models.first().filter(|_| wanted.ends_far()) {
            Some(finest) => far(&finest.model, run)?,
            None => None,
        };
        let has_far = far.is_some();
        models.extend(far.map(|model| {
            let copies = wanted.has_copies().then(|| (model.clone(), Vec::new()));
            Joined { model, copies }
        }));
        let made = Self::new(scene, plants, models);
        let mut fitted = if wanted.allowance().is_any() { made.within(wanted, has_far)? } else { made };
        fitted.figures.triangles =
            fitted.models.iter().map(|joined| joined.model.triangle_count() as u64).collect();
        Ok(fitted)
    }

    /// Takes levels that were made of `plants`.
    pub(crate) fn new(scene: &SceneEvaluator, plants: &[&DocumentPlant], models: Vec<Joined>) -> Self {
        let plant = match plants {
            [only] => scene.get(only.id()).and_then(|made| made.plant).cloned(),
            _ => None,
        };
        Self { models, plant: plant.unwrap_or_default(), figures: WrittenFigures::default() }
    }

    /// Returns the level of a row alone, if there is one.
    pub(crate) fn only(mut self, row: usize) -> Option<Self> {
        if row >= self.models.len() {
            return None;
        }
        self.models = vec![self.models.swap_remove(row)];
        Some(self)
    }

    /// Reduces them to the allowed size. `has_far`: views from all sides are the last.
    fn within(self, wanted: &ExportRequest, has_far: bool) -> Result<Self, WorkspaceError> {
        let Self { models, plant, .. } = self;
        let mut levels = Levels::default();
        for Joined { model, copies } in models {
            levels.lods.push(model);
            levels.copies.extend(copies);
        }
        let finest = if levels.lods.is_empty() { Model::default() } else { levels.lods.remove(0) };
        let (form, mut cache) = (wanted.form()?, PngCache::new());
        let weigh = |model: &Model, levels: &Levels| form.weigh(&plant, &levels.split(model), &mut cache);
        let coarser = wanted.levels.clamp(1, MOST_LEVELS) - 1;
        let fitted = levels.within(finest, wanted.allowance(), (coarser, has_far), weigh)??;
        let figures =
            WrittenFigures { level: fitted.level, halvings: fitted.halvings, ..WrittenFigures::default() };
        let mut copies = fitted.levels.copies.into_iter();
        let kept = std::iter::once(fitted.model).chain(fitted.levels.lods);
        let models = kept.map(|model| Joined { model, copies: copies.next() }).collect();
        Ok(Self { models, plant, figures })
    }

    /// Returns the files: of glTF in one file or several, with joints, as named nodes.
    pub(crate) fn files(&self, wanted: &ExportRequest) -> Result<Vec<NamedFile>, WorkspaceError> {
        let (form, mut cache) = (wanted.form()?, PngCache::new());
        let levels: Vec<formats::Level<'_>> = self.models.iter().map(Joined::level).collect();
        if form.is_one_file && (levels.len() > 1 || form.nodes.is_some()) {
            let mut out = Vec::new();
            form.write_levels(&self.plant, &levels, &mut cache, &mut out)?;
            return gltf_named(out, form.format, "plant");
        }
        let mut files = Vec::new();
        for (k, level) in levels.iter().enumerate() {
            let stem = if levels.len() == 1 { "plant".into() } else { format!("plant_LOD{k}") };
            files.extend(self.file(&form, (level, &stem), &mut cache)?);
        }
        Ok(files)
    }

    fn file(
        &self,
        form: &FileForm,
        (level, stem): (&formats::Level<'_>, &str),
        cache: &mut PngCache,
    ) -> Result<Vec<NamedFile>, WorkspaceError> {
        if !form.format.holds(Room::Levels) {
            return written(level.model, form.format, stem, &form.axes);
        }
        let mut out = Vec::new();
        form.write_glb(&self.plant, core::slice::from_ref(level), cache, &mut out)?;
        gltf_named(out, form.format, stem)
    }
}

#[cfg(test)]
mod tests {
    use burgeon::Coded;

    use super::*;
    use crate::{Action, NewMaker, Workspace};

    /// Writes a tulip, and returns its files and what they hold.
    fn tulip(wanted: &ExportRequest) -> Result<(Vec<NamedFile>, WrittenFigures), WorkspaceError> {
        let mut s = Workspace::default();
        s.act(&Action::Add { name: "tulip".into(), maker: NewMaker::Flower("tulip".into()) })?;
        let files = s.export(wanted, &Run::plain())?;
        Ok((files, s.written().cloned().unwrap_or_default()))
    }

    fn code(wanted: &ExportRequest) -> &'static str {
        tulip(wanted).expect_err("it cannot be").details().code
    }

    #[test]
    fn a_budget_takes_a_coarser_level() {
        let wanted = ExportRequest { levels: 2, packed: true, ..ExportRequest::default() };
        let (files, whole) = tulip(&wanted).unwrap();
        assert_eq!((files.len(), whole.triangles.len(), whole.level, whole.halvings), (2, 2, 0, 0));
        let most = whole.triangles[0] / 3;
        let (fewer, figures) = tulip(&ExportRequest { triangles: Some(most), ..wanted }).unwrap();
        assert!(figures.level > 0 && figures.halvings == 0, "{figures:?}");
        assert!(figures.triangles[0] <= most && figures.triangles[1] < figures.triangles[0], "{figures:?}");
        assert_eq!(fewer.len(), 2, "as many levels as asked");
        // A tulip has no textures that could become smaller.
        let bytes = files[0].1.len() - 1;
        let megabytes = Some(bytes as f64 / 1e6);
        let (lighter, figures) = tulip(&ExportRequest { megabytes, ..wanted }).unwrap();
        assert!(lighter[0].1.len() <= bytes && (figures.level, figures.halvings) == (1, 0), "{figures:?}");
    }

    #[test]
    fn what_cannot_be_is_refused_with_the_least_that_can() {
        let plain = ExportRequest::default();
        assert_eq!(code(&ExportRequest { triangles: Some(100), ..plain }), "least-triangles");
        assert_eq!(code(&ExportRequest { megabytes: Some(0.001), ..plain }), "least-megabytes");
        assert_eq!(code(&ExportRequest { megabytes: Some(f64::NAN), ..plain }), "field-range");
        assert_eq!(code(&ExportRequest { texture_size: Some(10), ..plain }), "field-range");
    }

    #[test]
    fn the_preview_shows_the_level_that_is_written() {
        let mut s = Workspace::default();
        s.act(&Action::Add { name: "tulip".into(), maker: NewMaker::Flower("tulip".into()) }).unwrap();
        let wanted = ExportRequest { packed: true, triangles: Some(2000), ..ExportRequest::default() };
        let view = s.preview_export(&wanted, 0, &Run::plain()).unwrap();
        let files = s.export(&wanted, &Run::plain()).unwrap();
        let seen: u64 = view.parts.iter().map(|part| part.triangles).sum();
        assert_eq!(vec![seen], s.written().unwrap().triangles);
        assert_eq!(view.file_bytes, files[0].1.len() as u64);
    }
}
