//! The files of a plant: its model, coarser copies beside it or in it, leaves as instances, joints that sway.

use std::sync::Arc;

use burgeon::SceneError;
use burgeon::formats::{
    ExportSpec, Level, ModelFormat, Packing, PngCache, Room, WriteError, gltf_files, write_glb_levels,
    write_glb_rigged,
};
use burgeon::mesh::{Copies, Model};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::compute::{aside, compute};
use crate::fault::{beyond, refused, unusable, wrong};
use crate::held::Held;
use crate::model::{axes, model_format, written};

/// How a plant is written, as Python asks for it.
#[derive(Clone, FromPyObject)]
pub(crate) struct Form {
    #[pyo3(item)]
    unit: String,
    #[pyo3(item)]
    up: String,
    /// Coarser copies.
    #[pyo3(item)]
    lods: u32,
    #[pyo3(item)]
    one_file: bool,
    #[pyo3(item)]
    instances: bool,
    #[pyo3(item)]
    impostor: Option<u32>,
    #[pyo3(item)]
    pack: Option<String>,
    #[pyo3(item)]
    sway: bool,
}

/// An option that does not fit with the rest.
fn refuse<T>(option: &str, line: &str) -> PyResult<T> {
    Err(wrong(line, option, "given", "left out"))
}

impl Form {
    fn packing(&self) -> PyResult<Option<Packing>> {
        Ok(match self.pack.as_deref() {
            None => None,
            Some("quantized") => Some(Packing::Quantized),
            Some("meshopt") => Some(Packing::Compressed),
            Some(other) => return Err(beyond("pack", format!("{other:?}"), "quantized or meshopt")),
        })
    }

    /// Fails on what nothing uses, and on what excludes another.
    fn check(&self, format: ModelFormat, held: &Held) -> PyResult<()> {
        let swung = self.sway || held.is_blown();
        let asked = [
            ("pack", self.pack.is_some(), Room::Packing),
            ("one_file", self.one_file, Room::Levels),
            ("instances", self.instances, Room::Instances),
            ("sway", self.sway, Room::Joints),
        ];
        if let Some((name, _, room)) = asked.iter().find(|(_, asked, room)| *asked && !format.holds(*room)) {
            return refuse(name, &format!("{name} is of {} files", ModelFormat::endings_with(*room)));
        }
        if self.lods > 6 {
            return Err(beyond("lods", self.lods, "0 to 6"));
        }
        if let Some(size) = self.impostor.filter(|size| !(128..=4096).contains(size)) {
            return Err(beyond("impostor", size, "128 to 4096 pixels"));
        }
        if self.impostor.is_some() && !format.holds(Room::Textures) {
            let endings = ModelFormat::endings_with(Room::Textures);
            return refuse("impostor", &format!("impostor is of models with textures: {endings}"));
        }
        if self.one_file && self.lods == 0 {
            return refuse("one_file", "one_file is of coarser copies: ask for lods");
        }
        if self.sway && (self.pack.is_some() || self.one_file) {
            return refuse("sway", "what sways has files of its own for its levels, and is not packed");
        }
        if swung && (self.instances || self.impostor.is_some()) {
            return refuse(
                if self.instances { "instances" } else { "impostor" },
                "instances and an impostor do not move in the wind: leave out sway, and make it without wind",
            );
        }
        Ok(())
    }
}

/// A model, and what it is without leaves that are one form.
type Split = (Model, Option<(Model, Vec<Copies>)>);

/// What is written of a model.
fn level<'a>(model: &'a Model, split: Option<&'a (Model, Vec<Copies>)>) -> Level<'a> {
    match split {
        Some((rest, copies)) => Level { model: rest, copies },
        None => Level::plain(model),
    }
}

impl Held {
    /// Whether it has columns for wind.
    fn is_blown(&self) -> bool {
        self.model().parts.iter().any(|p| !p.mesh.wind.is_empty())
    }

    /// Its coarser copies, finest first.
    fn coarser(&self, py: Python<'_>, form: &Form) -> PyResult<Vec<Split>> {
        let mut all = Vec::new();
        for level in 1..=form.lods {
            let made = compute(py, self.budget, |run| -> Result<Split, SceneError> {
                if let Some(lone) = &self.lone {
                    return Ok((lone.at_level(level, run)?, None));
                }
                let Some(plant) = self.document.plant(self.id) else {
                    return Ok((self.model().clone(), None));
                };
                let at = self.scene.level(plant, level, run)?;
                let split = if form.instances { at.copies() } else { None };
                Ok((at.model, split))
            })?;
            all.push(made.map_err(|e| refused(py, &e))?);
        }
        if let Some(size) = form.impostor {
            let made = compute(py, self.budget, |run| burgeon::render::impostor(self.model(), size, run))?;
            all.extend(made.map_err(|e| refused(py, &SceneError::from(e)))?.map(|far| (far, None)));
        }
        Ok(all)
    }
}

/// The files of a plant's model by its extension: names and bytes, the model's own first, then its coarser copies.
pub(crate) fn files<'py>(
    py: Python<'py>,
    plant: &Arc<Held>,
    (extension, stem): (&str, &str),
    form: &Form,
) -> PyResult<Vec<(String, Bound<'py, PyBytes>)>> {
    let (format, spec) = (model_format(extension)?, axes(&form.unit, &form.up)?);
    let packing = form.packing()?;
    form.check(format, plant)?;
    let held = if form.sway && !plant.is_blown() {
        plant.after_with(py, Some(true), [])?
    } else {
        Arc::clone(plant)
    };
    let coarser = held.coarser(py, form)?;
    let writing = Writing { held, coarser, form: form.clone(), format, packing, spec };
    let (extension, stem) = (extension.to_owned(), stem.to_owned());
    let files = aside(py, move || writing.files(&extension, &stem))?.map_err(|e| unusable(py, &e))?;
    Ok(files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect())
}

/// What is written, and how.
struct Writing {
    held: Arc<Held>,
    coarser: Vec<Split>,
    form: Form,
    format: ModelFormat,
    packing: Option<Packing>,
    spec: ExportSpec,
}

impl Writing {
    fn files(&self, extension: &str, stem: &str) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
        let (held, form, packing) = (&self.held, &self.form, self.packing);
        let model = held.model();
        let split = form.instances.then(|| burgeon::skin::copies(held.plant(), model, held.layout()));
        let models = std::iter::once((model, split.as_ref()));
        let models: Vec<_> = models.chain(self.coarser.iter().map(|(m, s)| (m, s.as_ref()))).collect();
        let levels: Vec<Level<'_>> = models.iter().map(|(model, split)| level(model, *split)).collect();
        let mut cache = PngCache::new();
        if form.one_file {
            let mut bytes = Vec::new();
            write_glb_levels(&levels, packing, &mut cache, &mut bytes)?;
            return Ok(gltf_files(bytes, self.format, stem)?.named(format!("{stem}.{extension}")));
        }
        let mut files = Vec::new();
        for (k, (level, (model, _))) in levels.iter().zip(&models).enumerate() {
            let stem = if k == 0 { stem.to_owned() } else { format!("{stem}-lod{k}") };
            let rig = form.sway.then(|| burgeon::skin::sway(model, burgeon::skin::gust(model))).flatten();
            if self.format.holds(Room::Joints) {
                let mut bytes = Vec::new();
                match rig {
                    Some(rig) => write_glb_rigged(model, &rig, &mut cache, &mut bytes)?,
                    None => write_glb_levels(std::slice::from_ref(level), packing, &mut cache, &mut bytes)?,
                }
                let written = gltf_files(bytes, self.format, &stem[..])?;
                files.extend(written.named(format!("{stem}.{extension}")));
            } else {
                files.extend(written(model, self.format, extension, &stem, &self.spec)?);
            }
        }
        Ok(files)
    }
}
