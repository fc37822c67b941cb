//! The files of a plant: its model, coarser copies in separate files or in the same, leaves as instances, joints that
//! sway.

use std::sync::Arc;

use burgeon::formats::{
    ExportSpec, ModelFormat, Packing, PngCache, Room, WriteError, assembly_files, gltf_files,
};
use burgeon::mesh::Model;
use burgeon::skin::SolidSpec;
use burgeon::{
    Allowance, AllowanceError, Engine, ExportChoice, FileForm, Levels, SceneError, Unit, UpAxis, assemble,
    name_after, print_plant,
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
    /// Most triangles of the model.
    #[pyo3(item)]
    triangles: Option<u64>,
    /// Most megabytes of its files.
    #[pyo3(item)]
    megabytes: Option<f64>,
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

    fn allowance(&self) -> PyResult<Allowance> {
        let (least, most) = Allowance::TRIANGLES;
        if let Some(count) = self.triangles.filter(|count| !(least..=most).contains(count)) {
            return Err(beyond("triangles", count, &format!("{least} to {most}")));
        }
        let (least, most) = Allowance::MEGABYTES;
        if let Some(size) = self.megabytes.filter(|size| !(least..=most).contains(size)) {
            return Err(beyond("megabytes", size, &format!("{least} to {most}")));
        }
        Ok(Allowance::new(self.triangles, self.megabytes))
    }

    /// Fails for options that a printed body does not have.
    fn check_print(&self) -> PyResult<()> {
        if self.lods > 0 {
            return refuse("lods", "a print is one body: it has no coarser copies");
        }
        if self.triangles.is_some() {
            return refuse("triangles", "a print is one body: its size and walls set its triangles");
        }
        Ok(())
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

impl Held {
    /// Returns whether it has columns for wind.
    fn is_blown(&self) -> bool {
        self.model().parts.iter().any(|p| !p.mesh.wind.is_empty())
    }

    /// Returns its coarser copies, finest first, and for each of all the leaves that are copies, if they are asked for.
    fn levels(&self, py: Python<'_>, form: &Form, lods: u32) -> PyResult<Levels> {
        let mut levels = Levels::default();
        if form.instances {
            levels.copies.push(burgeon::skin::copies(self.plant(), self.model(), self.layout()));
        }
        for level in 1..=lods {
            let made = compute(py, self.budget, |run| -> Result<_, SceneError> {
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
            let (model, split) = made.map_err(|e| refused(py, &e))?;
            if form.instances {
                levels.copies.push(split.unwrap_or_else(|| (model.clone(), Vec::new())));
            }
            levels.lods.push(model);
        }
        if let Some(size) = form.impostor {
            let made = compute(py, self.budget, |run| burgeon::render::impostor(self.model(), size, run))?;
            if let Some(far) = made.map_err(|e| refused(py, &SceneError::from(e)))? {
                if form.instances {
                    levels.copies.push((far.clone(), Vec::new()));
                }
                levels.lods.push(far);
            }
        }
        Ok(levels)
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
    let allowance = form.allowance()?;
    let held = if (form.sway || has_wind) && !plant.is_blown() {
        plant.after_with(py, Some(true), [])?
    } else {
        Arc::clone(plant)
    };
    if engine.is_some_and(|engine| engine.has_assembly(extension)) {
        return assembly(py, &held, stem, (&form, &spec, set));
    }
    let is_print = engine == Some(Engine::Print);
    if is_print {
        form.check_print()?;
    }
    let lods = if is_print { 0 } else { allowance.levels(form.lods) };
    let levels = held.levels(py, &form, lods)?;
    let own = if is_print {
        let solid = SolidSpec::default();
        let made = compute(py, held.budget, |run| print_plant(held.plant(), held.model(), &solid, run))?;
        Some(made.map_err(|e| unusable(py, &e))?.model)
    } else {
        None
    };
    let nodes = engine.filter(|_| has_nodes);
    let is_one_file = (form.one_file || nodes.is_some()) && format.holds(Room::Levels);
    let file = FileForm { format, axes: spec, packing, sways: form.sway, is_one_file, nodes };
    let writing = Writing { held, own, levels, form, allowance, file };
    let (extension, stem) = (extension.to_owned(), stem.to_owned());
    let files = aside(py, move || writing.files(&extension, &stem))?.map_err(|e| unusable(py, &e))?;
    let (files, line) = files.map_err(|e| unusable(py, &e))?;
    let set = set.into_iter().chain(line).collect();
    Ok((files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect(), set))
}

/// The files of a plant with a skeleton and leaves on its joints.
fn assembly<'py>(
    py: Python<'py>,
    held: &Arc<Held>,
    stem: &str,
    (form, spec, set): (&Form, &ExportSpec, Vec<String>),
) -> PyResult<Written<'py>> {
    for (name, is_given) in [
        ("lods", form.lods > 0),
        ("triangles", form.triangles.is_some()),
        ("megabytes", form.megabytes.is_some()),
    ] {
        if is_given {
            return refuse(name, "Nanite makes coarser copies itself");
        }
    }
    let parts = (held.plant(), held.model(), held.layout());
    let made = compute(py, held.budget, |run| assemble(parts, run))?;
    let mut made = made.map_err(|e| unusable(py, &e))?;
    name_after(&held.plant().name, &mut made.model);
    let files = assembly_files(&made, stem, spec).map_err(|e| unusable(py, &e))?;
    let files = files.named(format!("{stem}.usda"));
    Ok((files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect(), set))
}

/// Contents and settings of the files.
struct Writing {
    held: Arc<Held>,
    /// Its model, where that is not the plant's.
    own: Option<Model>,
    levels: Levels,
    form: Form,
    allowance: Allowance,
    file: FileForm,
}

/// Files by their names, and in words how the model was reduced.
type Reduced = (Vec<(String, Vec<u8>)>, Option<String>);

impl Writing {
    /// Names all parts and materials after the plant.
    fn name(&mut self) {
        let name = &self.held.plant().name;
        let model = self.own.get_or_insert_with(|| self.held.model().clone());
        let rest = self.levels.copies.iter_mut().map(|(rest, _)| rest);
        self.levels.lods.iter_mut().chain(rest).chain([model]).for_each(|model| name_after(name, model));
    }

    /// Reduces the model to the allowed size; says in words how.
    fn fit(&mut self, cache: &mut PngCache) -> Result<Result<Option<String>, AllowanceError>, WriteError> {
        if !self.allowance.is_any() {
            return Ok(Ok(None));
        }
        let model = self.own.take().unwrap_or_else(|| self.held.model().clone());
        let levels = std::mem::take(&mut self.levels);
        let asked = (self.form.lods, self.form.impostor.is_some());
        let (plant, file) = (self.held.plant(), self.file);
        let weigh = |model: &Model, levels: &Levels| file.weigh(plant, &levels.split(model), cache);
        let fitted = levels.within(model, self.allowance, asked, weigh)?;
        Ok(fitted.map(|fitted| {
            let line = fitted.line();
            (self.own, self.levels) = (Some(fitted.model), fitted.levels);
            line
        }))
    }

    fn files(mut self, extension: &str, stem: &str) -> Result<Result<Reduced, AllowanceError>, WriteError> {
        let mut cache = PngCache::new();
        if self.form.names {
            self.name();
        }
        let line = match self.fit(&mut cache)? {
            Ok(line) => line,
            Err(e) => return Ok(Err(e)),
        };
        let (held, file) = (&self.held, &self.file);
        let model = self.own.as_ref().unwrap_or(held.model());
        let levels = self.levels.split(model);
        if file.is_one_file {
            let mut bytes = Vec::new();
            file.write_levels(held.plant(), &levels, &mut cache, &mut bytes)?;
            let mut files = gltf_files(bytes, file.format, stem)?;
            files.beside.extend(file.textures_beside(held.plant(), model, stem)?);
            return Ok(Ok((files.named(format!("{stem}.{extension}")), line)));
        }
        let mut files = Vec::new();
        let models = std::iter::once(model).chain(&self.levels.lods);
        for (k, (level, model)) in levels.iter().zip(models).enumerate() {
            let stem = if k == 0 { stem.to_owned() } else { format!("{stem}-lod{k}") };
            if file.format.holds(Room::Joints) {
                let mut bytes = Vec::new();
                file.write_glb(held.plant(), std::slice::from_ref(level), &mut cache, &mut bytes)?;
                let written = gltf_files(bytes, file.format, &stem[..])?;
                files.extend(written.named(format!("{stem}.{extension}")));
            } else {
                files.extend(written(model, file.format, extension, &stem, &file.axes)?);
            }
        }
        Ok(Ok((files, line)))
    }
}
