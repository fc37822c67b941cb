//! The files of a plant: its model, coarser copies in separate files or in the same, leaves as instances, joints that
//! sway.

use std::sync::Arc;

use burgeon::formats::{
    ExportSpec, Level, ModelFormat, Packing, PngCache, Room, WriteError, assembly_files, gltf_files,
    write_glb_levels, write_glb_rigged,
};
use burgeon::mesh::{Copies, Model};
use burgeon::skin::SolidSpec;
use burgeon::{
    Engine, ExportChoice, SceneError, Unit, UpAxis, assemble, name_after, print_plant, write_engine_glb,
};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::compute::{aside, compute};
use crate::fault::{beyond, refused, unusable, wrong};
use crate::held::Held;
use crate::model::{axes, model_format, written};

/// Settings for writing a plant, as Python requests it.
#[derive(Clone, FromPyObject)]
pub(crate) struct Form {
    #[pyo3(item)]
    unit: String,
    #[pyo3(item)]
    up: String,
    /// Number of coarser copies.
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
    /// The program that it is for.
    #[pyo3(item)]
    engine: Option<String>,
    /// Whether unit, up axis and number of coarser copies are asked for.
    #[pyo3(item)]
    given: [bool; 3],
    /// Parts and materials are named after the plant.
    #[pyo3(item)]
    names: bool,
}

/// How a plant is written for a program.
#[derive(Default)]
struct Settled {
    engine: Option<Engine>,
    /// Whether columns of the wind are wanted.
    has_wind: bool,
    /// Whether levels and shapes for collisions are nodes of one file.
    has_nodes: bool,
    /// What was set.
    set: Vec<String>,
}

/// Refuses an option that does not fit with the rest.
fn refuse<T>(option: &str, line: &str) -> PyResult<T> {
    Err(wrong(line, option, "given", "left out"))
}

impl Form {
    fn packing(&self) -> PyResult<Option<Packing>> {
        let Some(word) = self.pack.as_deref() else { return Ok(None) };
        let packing = Packing::from_word(word);
        packing.map(Some).ok_or_else(|| beyond("pack", format!("{word:?}"), &Packing::words()))
    }

    /// Sets what the program wants and Python leaves open.
    fn settle(&mut self, extension: &str, is_blown: bool) -> PyResult<Settled> {
        let Some(word) = &self.engine else {
            return Ok(Settled { has_wind: is_blown, ..Settled::default() });
        };
        let engine = Engine::from_word(word);
        let engine = engine.ok_or_else(|| beyond("engine", format!("{word:?}"), &Engine::words()))?;
        let [unit, up, lods] = self.given;
        let mut choice = ExportChoice {
            up: UpAxis::from_word(&self.up).filter(|_| up),
            unit: Unit::from_word(&self.unit).filter(|_| unit),
            lods: Some(self.lods).filter(|_| lods),
            packing: self.packing()?,
            has_wind: is_blown,
            sways: self.sway,
            is_one_file: self.one_file,
            is_still: self.instances || self.impostor.is_some(),
            has_names: self.names,
        };
        let set = engine.settle(extension, &mut choice);
        let set = set.map_err(|e| wrong(&format!("engine={word:?}: {e}"), "engine", word, "left out"))?;
        let set = set.iter().map(ToString::to_string).collect();
        self.up = choice.up.map_or_else(|| self.up.clone(), |up| up.word().to_owned());
        self.unit = choice.unit.map_or_else(|| self.unit.clone(), |unit| unit.word().to_owned());
        self.lods = choice.lods.unwrap_or(self.lods);
        self.pack = choice.packing.map(|packing| packing.word().to_owned());
        (self.sway, self.names) = (choice.sways, choice.has_names);
        let has_nodes = engine.has_nodes(&choice);
        Ok(Settled { engine: Some(engine), has_wind: choice.has_wind, has_nodes, set })
    }

    /// Fails for unused options, and for those that exclude each other.
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

/// A model, and its division into the rest and copied leaves.
type Split = (Model, Option<(Model, Vec<Copies>)>);

/// Returns the level of a file for a model.
fn level<'a>(model: &'a Model, split: Option<&'a (Model, Vec<Copies>)>) -> Level<'a> {
    match split {
        Some((rest, copies)) => Level { model: rest, copies },
        None => Level::plain(model),
    }
}

impl Held {
    /// Returns whether it has columns for wind.
    fn is_blown(&self) -> bool {
        self.model().parts.iter().any(|p| !p.mesh.wind.is_empty())
    }

    /// Returns its coarser copies, finest first.
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

/// Files by their names, and what was set for a program.
pub(crate) type Written<'py> = (Vec<(String, Bound<'py, PyBytes>)>, Vec<String>);

/// The files of a plant's model by its extension: names and bytes, the model's own first, then its coarser copies.
pub(crate) fn files<'py>(
    py: Python<'py>,
    plant: &Arc<Held>,
    (extension, stem): (&str, &str),
    mut form: Form,
) -> PyResult<Written<'py>> {
    let format = model_format(extension)?;
    let Settled { engine, has_wind, has_nodes, set } = form.settle(extension, plant.is_blown())?;
    let spec = axes(&form.unit, &form.up)?;
    let packing = form.packing()?;
    form.check(format, plant)?;
    let held = if (form.sway || has_wind) && !plant.is_blown() {
        plant.after_with(py, Some(true), [])?
    } else {
        Arc::clone(plant)
    };
    if engine.is_some_and(|engine| engine.has_assembly(extension)) {
        return assembly(py, &held, stem, (&form, &spec, set));
    }
    let coarser = held.coarser(py, &form)?;
    let printed = if engine == Some(Engine::Print) {
        if !coarser.is_empty() {
            return refuse("lods", "a print is one body: it has no coarser copies");
        }
        let solid = SolidSpec::default();
        let made = compute(py, held.budget, |run| print_plant(held.plant(), held.model(), &solid, run))?;
        Some(made.map_err(|e| unusable(py, &e))?.model)
    } else {
        None
    };
    let nodes = engine.filter(|_| has_nodes);
    let writing = Writing { held, coarser, printed, form, nodes, format, packing, spec };
    let (extension, stem) = (extension.to_owned(), stem.to_owned());
    let files = aside(py, move || writing.files(&extension, &stem))?.map_err(|e| unusable(py, &e))?;
    Ok((files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect(), set))
}

/// The files of a plant with a skeleton and leaves on its joints.
fn assembly<'py>(
    py: Python<'py>,
    held: &Arc<Held>,
    stem: &str,
    (form, spec, set): (&Form, &ExportSpec, Vec<String>),
) -> PyResult<Written<'py>> {
    if form.lods > 0 {
        return refuse("lods", "Nanite makes coarser copies itself");
    }
    let parts = (held.plant(), held.model(), held.layout());
    let made = compute(py, held.budget, |run| assemble(parts, run))?;
    let mut made = made.map_err(|e| unusable(py, &e))?;
    name_after(&held.plant().name, &mut made.model);
    let files = assembly_files(&made, stem, spec).map_err(|e| unusable(py, &e))?;
    let files = files.named(format!("{stem}.usda"));
    Ok((files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect(), set))
}

/// A model, and what it is without leaves that are one form, with names after the plant.
fn named_after(plant: &str, model: &Model, split: Option<&(Model, Vec<Copies>)>) -> Split {
    let mut named = (model.clone(), split.cloned());
    name_after(plant, &mut named.0);
    if let Some((rest, _)) = &mut named.1 {
        name_after(plant, rest);
    }
    named
}

/// Contents and settings of the files.
struct Writing {
    held: Arc<Held>,
    coarser: Vec<Split>,
    /// The one body that a printer gets.
    printed: Option<Model>,
    form: Form,
    /// The program that wants levels and shapes for collisions as nodes of one file.
    nodes: Option<Engine>,
    format: ModelFormat,
    packing: Option<Packing>,
    spec: ExportSpec,
}

impl Writing {
    fn files(&self, extension: &str, stem: &str) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
        let (held, form, packing) = (&self.held, &self.form, self.packing);
        let model = self.printed.as_ref().unwrap_or(held.model());
        let split = form.instances.then(|| burgeon::skin::copies(held.plant(), model, held.layout()));
        let models = std::iter::once((model, split.as_ref()));
        let models = models.chain(self.coarser.iter().map(|(m, s)| (m, s.as_ref())));
        let named: Vec<Split> = if form.names {
            let name = &held.plant().name;
            models.clone().map(|(model, split)| named_after(name, model, split)).collect()
        } else {
            Vec::new()
        };
        let models: Vec<_> =
            if form.names { named.iter().map(|(m, s)| (m, s.as_ref())).collect() } else { models.collect() };
        let levels: Vec<Level<'_>> = models.iter().map(|(model, split)| level(model, *split)).collect();
        let mut cache = PngCache::new();
        if form.one_file || self.nodes.is_some() {
            let mut bytes = Vec::new();
            match self.nodes {
                Some(engine) => {
                    let models: Vec<&Model> = models.iter().map(|(model, _)| *model).collect();
                    write_engine_glb(engine, held.plant(), &models, &mut cache, &mut bytes)?;
                }
                None => write_glb_levels(&levels, packing, &mut cache, &mut bytes)?,
            }
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
