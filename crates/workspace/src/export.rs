//! Exports: the scene or one plant, in every format that the command line writes.

use burgeon::document::{self, Document, DocumentPlant, PlantId};
use burgeon::formats::{
    self, DrawingFormat, ExportSpec, ModelFormat, Packing, PngCache, Room, StructureFormat, gltf_files,
    model_files,
};
use burgeon::mesh::{Copies, Model, Standing};
use burgeon::plant::Plant;
use burgeon::skin::{FoliageStyle, SolidError, SolidSpec};
use burgeon::{
    Allowance, Engine, ExportChoice, FileForm, Levels, PrintedPlant, Report, Run, SceneEvaluator, Unit,
    UpAxis, scene_model, standing,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::export_preview::{PrintFigures, SurfaceAsk, WrittenFigures};
use crate::{Workspace, WorkspaceError};

/// Most levels of detail of an export.
pub(crate) const MOST_LEVELS: u32 = 4;

/// Side of the picture with views from all sides, pixels.
const IMPOSTOR: u32 = 1024;

/// Name and bytes of a file.
pub type NamedFile = (String, Vec<u8>);

/// Format of an export, by its word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ExportFormat {
    /// The meshes of the plants.
    Model(ModelFormat),
    /// The structure of each plant.
    Structure(StructureFormat),
    /// The current drawing.
    Drawing(DrawingFormat),
}

impl Default for ExportFormat {
    fn default() -> Self {
        Self::Model(ModelFormat::Glb)
    }
}

impl ExportFormat {
    /// Returns the format of models that it is.
    ///
    /// # Errors
    /// [`WorkspaceError::Format`] for a format that holds no models.
    pub(crate) fn model(self) -> Result<ModelFormat, WorkspaceError> {
        match self {
            Self::Model(format) => Ok(format),
            Self::Structure(format) => Err(WorkspaceError::Format(format.word())),
            Self::Drawing(format) => Err(WorkspaceError::Format(format.word())),
        }
    }

    fn holds(self, room: Room) -> bool {
        self.model().is_ok_and(|format| format.holds(room))
    }
}

/// Subject and format of an export.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExportRequest {
    /// The format.
    pub format: ExportFormat,
    /// Levels of detail, 1 to 4: each has about half of the triangles of the one before.
    pub levels: u32,
    /// The vertical axis of the file.
    pub up: UpAxis,
    /// The unit of the file.
    pub unit: Unit,
    /// Whether the whole scene is exported, else the current plant.
    pub whole: bool,
    /// Whether drawings and trees get wind columns, where the format has room for them.
    pub wind: bool,
    /// Whether all levels go into one file, for glTF (`MSFT_lod`); else each has its own.
    pub one_file: bool,
    /// Whether to write joints and an animation that sways, for glTF; each level then has a file of its own.
    pub sway: bool,
    /// Whether to add a last level, views from all sides in one picture, for glTF.
    pub impostor: bool,
    /// Whether columns are compressed (`EXT_meshopt_compression`), for glTF without joints.
    pub packed: bool,
    /// Whether leaves of one form are written once, for glTF (`EXT_mesh_gpu_instancing`); they do not move in the wind.
    pub instances: bool,
    /// How leaves are drawn, for formats with textures; null for as each plant has it.
    pub foliage: Option<FoliageStyle>,
    /// Pixels of a side of the textures of bark, and of the length of those of leaves, 64 to 4096; null for as shown.
    pub texture_size: Option<u32>,
    /// Most triangles of the finest level, 100 or more: it becomes the first level of detail within them.
    pub triangles: Option<u64>,
    /// Most megabytes of its file, 0.001 to 4000: textures become smaller first, then it becomes the first level of detail
    /// that fits.
    pub megabytes: Option<f64>,
    /// Whether parts and materials are named after their plant.
    pub named: bool,
    /// The program that the files are for: [`Engine::Print`] gets one closed body, the others what the settings above
    /// say.
    pub engine: Option<Engine>,
}

impl Default for ExportRequest {
    fn default() -> Self {
        let format = ExportFormat::default();
        let (one_file, sway, impostor) = (false, false, false);
        Self {
            format,
            levels: 1,
            up: UpAxis::Y,
            unit: Unit::Metre,
            whole: false,
            wind: false,
            one_file,
            sway,
            impostor,
            packed: false,
            instances: false,
            foliage: None,
            texture_size: None,
            triangles: None,
            megabytes: None,
            named: false,
            engine: None,
        }
    }
}

impl ExportRequest {
    /// Range of [`Self::texture_size`], pixels.
    pub const TEXTURE_SIZES: (f64, f64) = (64.0, 4096.0);

    /// Checks that its numbers are within their ranges.
    pub(crate) fn check(&self) -> Result<(), WorkspaceError> {
        let (least, most) = Allowance::TRIANGLES;
        let rows = [
            ("texture_size", self.texture_size.map(f64::from), Self::TEXTURE_SIZES),
            ("triangles", self.triangles.map(|count| count as f64), (least as f64, most as f64)),
            ("megabytes", self.megabytes, Allowance::MEGABYTES),
        ];
        for (field, value, (least, most)) in rows {
            if let Some(value) = value.filter(|value| !(least..=most).contains(value)) {
                return Err(WorkspaceError::Range { field, value, range: format!("{least} to {most}") });
            }
        }
        Ok(())
    }

    /// Returns how large it may be.
    pub(crate) fn allowance(&self) -> Allowance {
        Allowance::new(self.triangles, self.megabytes)
    }

    /// Returns what it asks of the surfaces of all plants: wind columns, how leaves are drawn, the size of textures.
    pub(crate) fn surface(&self) -> SurfaceAsk {
        let is_painted = self.format.holds(Room::Textures);
        (self.blown(), self.foliage.filter(|_| is_painted), self.texture_size.filter(|_| is_painted))
    }

    /// Returns an evaluator with the surfaces that are wanted, if they are others than those of `scene`.
    pub(crate) fn dressed(
        &self,
        scene: &SceneEvaluator,
        document: &Document,
        only: Option<PlantId>,
    ) -> Option<SceneEvaluator> {
        let surface = self.surface();
        if surface == SurfaceAsk::default() {
            return None;
        }
        // The shown meshes stay without wind columns, which would make them half as large again.
        let mut aside = scene.aside(document.plants().iter().filter(chosen(only)));
        let (has_wind, foliage, texture_size) = surface;
        aside.set_wind(has_wind);
        aside.set_foliage(foliage);
        aside.set_texture_size(texture_size);
        Some(aside)
    }

    /// Returns the form of its files.
    pub(crate) fn form(&self) -> Result<FileForm, WorkspaceError> {
        let (format, nodes) = (self.format.model()?, self.nodes());
        let is_one_file = self.one_file && format.holds(Room::Levels) && !self.sways();
        Ok(FileForm {
            format,
            axes: self.spec(),
            packing: self.packing(),
            sways: self.sways(),
            is_one_file: is_one_file || nodes.is_some(),
            nodes,
        })
    }

    /// Whether the written meshes have wind columns.
    pub(crate) fn blown(&self) -> bool {
        let moves = !self.has_copies() && !self.is_print();
        (moves && self.wind && self.format.holds(Room::Wind)) || self.sways()
    }

    fn sways(&self) -> bool {
        self.sway && self.format.holds(Room::Joints) && !self.has_copies()
    }

    /// Whether leaves of one form are written once.
    pub(crate) fn has_copies(&self) -> bool {
        self.instances && self.format.holds(Room::Instances)
    }

    fn packing(&self) -> Option<Packing> {
        let packs = self.packed && self.format.holds(Room::Packing) && !self.sways();
        packs.then_some(Packing::Compressed)
    }

    /// Whether one closed body is written.
    pub(crate) fn is_print(&self) -> bool {
        self.engine == Some(Engine::Print)
    }

    /// Whether a skeleton with leaves on its joints is written.
    pub(crate) fn is_assembly(&self) -> bool {
        let ending = self.format.model().map_or("", ModelFormat::extension);
        !self.whole && self.engine.is_some_and(|engine| engine.has_assembly(ending))
    }

    /// Whether the level after the others is views from all sides.
    pub(crate) fn ends_far(&self) -> bool {
        self.impostor && self.format.holds(Room::Levels)
    }

    /// Whether each level is written as one model of the whole scene.
    pub(crate) fn is_joined(&self) -> bool {
        let one = self.format.holds(Room::Levels) && self.one_file && self.levels > 1;
        let is_named = self.nodes().is_some();
        let is_glb = self.sways() || self.ends_far() || one || self.packing().is_some() || self.has_copies();
        is_glb || is_named || self.allowance().is_any()
    }

    /// Returns the program whose file has the levels of one plant as named nodes, with shapes for collisions.
    pub(crate) fn nodes(&self) -> Option<Engine> {
        let choice = ExportChoice {
            packing: self.packing(),
            sways: self.sways(),
            is_one_file: self.one_file,
            is_still: self.has_copies() || self.ends_far(),
            ..ExportChoice::default()
        };
        let is_glb = self.format.holds(Room::Levels) && !self.whole;
        self.engine.filter(|engine| is_glb && engine.has_nodes(&choice))
    }

    pub(crate) fn spec(&self) -> ExportSpec {
        ExportSpec { up: self.up, unit: self.unit }
    }
}

impl Workspace {
    /// Returns the shown plants as files: several for formats with separate textures, for levels of detail, and for
    /// structures of several plants.
    ///
    /// # Errors
    /// [`WorkspaceError`]: for example when there is nothing to export.
    pub fn export(
        &mut self,
        wanted: &ExportRequest,
        run: &Run<'_>,
    ) -> Result<Vec<NamedFile>, WorkspaceError> {
        if let ExportFormat::Drawing(format) = wanted.format {
            let drawing = self.current_plant().ok_or(WorkspaceError::NoDrawing)?.drawing();
            let mut out = Vec::new();
            match format {
                DrawingFormat::Svg => formats::write_svg(&drawing, &mut out)?,
                DrawingFormat::Json => formats::write_drawing(&drawing, &mut out)?,
                _ => return Err(WorkspaceError::Format(format.word())),
            }
            return Ok(vec![(format!("drawing.{}", format.extension()), out)]);
        }
        if let Some(model) = &self.guest {
            let triangles = vec![model.triangle_count() as u64];
            self.written = Some(WrittenFigures { triangles, ..WrittenFigures::default() });
            return written(model, wanted.format.model()?, "plant", &wanted.spec());
        }
        wanted.check()?;
        self.draft = None;
        let only = if wanted.whole { None } else { Some(self.must()?) };
        if wanted.is_print() {
            let format = wanted.format.model()?;
            let made = print(&mut self.scene, self.editor.document(), only, run)?;
            self.printed = Some(PrintFigures::from_print(&made));
            return written(&made.model, format, "plant", &wanted.spec());
        }
        if wanted.is_assembly() {
            let (scene, document) = (&mut self.scene, self.editor.document());
            let mut aside = wanted.dressed(scene, document, only);
            let scene = aside.as_mut().unwrap_or(scene);
            let made = made(scene, document, only, run)?;
            let (files, triangles) = assembly(scene, &made, wanted, run)?;
            self.written = Some(WrittenFigures { triangles: vec![triangles], ..WrittenFigures::default() });
            return Ok(files);
        }
        let (files, figures) = export(&mut self.scene, self.editor.document(), only, wanted, run)?;
        self.written = Some(figures);
        Ok(files)
    }

    /// Returns figures of the last export of plants as models.
    pub const fn written(&self) -> Option<&WrittenFigures> {
        self.written.as_ref()
    }

    /// Returns figures of the last body that was made for a printer.
    pub const fn printed(&self) -> Option<PrintFigures> {
        self.printed
    }
}

/// Makes one closed body of the only exported plant.
pub(crate) fn print(
    scene: &mut SceneEvaluator,
    document: &Document,
    only: Option<PlantId>,
    run: &Run<'_>,
) -> Result<PrintedPlant, WorkspaceError> {
    let made = made(scene, document, only, run)?;
    let [plant] = made[..] else { return Err(WorkspaceError::PrintsOne) };
    let shown = scene.get(plant.id()).ok_or(WorkspaceError::NothingMade)?;
    let whole = shown.plant.ok_or(WorkspaceError::NothingMade)?;
    match burgeon::print_plant(whole, shown.model, &SolidSpec::default(), run) {
        Err(SolidError::Cancelled(_)) => Err(WorkspaceError::Cancelled),
        other => Ok(other?),
    }
}

/// Writes the only exported plant as a skeleton with leaves on its joints; returns its triangles, too.
pub(crate) fn assembly(
    scene: &SceneEvaluator,
    made: &[&DocumentPlant],
    wanted: &ExportRequest,
    run: &Run<'_>,
) -> Result<(Vec<NamedFile>, u64), WorkspaceError> {
    if wanted.levels > 1 || wanted.allowance().is_any() {
        return Err(WorkspaceError::AssemblyLevels);
    }
    let [plant] = made[..] else { return Err(WorkspaceError::NothingMade) };
    let shown = scene.get(plant.id()).ok_or(WorkspaceError::NothingMade)?;
    let (whole, layout) = shown.plant.zip(shown.owners).ok_or(WorkspaceError::NothingMade)?;
    let mut made = match burgeon::assemble((whole, shown.model, layout), run) {
        Err(_) if run.cancel.check().is_err() => return Err(WorkspaceError::Cancelled),
        made => made?,
    };
    if wanted.named {
        burgeon::name_after(&plant.settings().name, &mut made.model);
    }
    let files = formats::assembly_files(&made, "plant", &wanted.spec())?.named("plant.usda".to_owned());
    Ok((files, shown.model.triangle_count() as u64))
}

fn export(
    scene: &mut SceneEvaluator,
    document: &Document,
    only: Option<PlantId>,
    wanted: &ExportRequest,
    run: &Run<'_>,
) -> Result<(Vec<NamedFile>, WrittenFigures), WorkspaceError> {
    let mut aside = wanted.dressed(scene, document, only);
    let scene = aside.as_mut().unwrap_or(scene);
    let made = made(scene, document, only, run)?;
    if let ExportFormat::Structure(format) = wanted.format {
        let plants = made.iter().map(|p| (p.id(), scene.get(p.id()).and_then(|made| made.plant)));
        let files = structure(plants, format.extension(), |plant, out| {
            burgeon::write_structure(plant, format, &wanted.spec(), out)
        })?;
        return Ok((files, WrittenFigures::default()));
    }
    let (format, spec) = (wanted.format.model()?, wanted.spec());
    let levels = wanted.levels.clamp(1, MOST_LEVELS);
    if wanted.is_joined() {
        let levels = ExportLevels::make((scene, document), &made, (only, wanted), run)?;
        return Ok((levels.files(wanted)?, levels.figures));
    }
    let (mut files, mut figures) = (Vec::new(), WrittenFigures::default());
    for level in 0..levels {
        let at = Level::make(scene, &made, (level, wanted), run)?;
        let stem = if levels == 1 { "plant".into() } else { format!("plant_LOD{level}") };
        let standing = at.standing(&made, only.is_some());
        figures.triangles.push(standing.iter().map(|plant| plant.model.triangle_count() as u64).sum());
        files.extend(scene_files(document.name(), &standing, format, &stem, &spec, &mut PngCache::new())?);
    }
    Ok((files, figures))
}

/// Returns a binary glTF in a format of its family, with the names of its files.
pub(crate) fn gltf_named(
    glb: Vec<u8>,
    format: ModelFormat,
    stem: &str,
) -> Result<Vec<NamedFile>, WorkspaceError> {
    Ok(gltf_files(glb, format, stem)?.named(format!("{stem}.{}", format.extension())))
}

/// Returns views of a model from all sides; `None` for an empty one.
pub(crate) fn far(model: &Model, run: &Run<'_>) -> Result<Option<Model>, WorkspaceError> {
    burgeon::render::impostor(model, IMPOSTOR, run).map_err(|_cancelled| WorkspaceError::Cancelled)
}

/// Returns a filter for the exported plants: all that are not hidden, or one.
pub(crate) fn chosen(only: Option<PlantId>) -> impl Fn(&&DocumentPlant) -> bool {
    move |p| only.map_or(!p.settings().hidden, |id| p.id() == id)
}

/// Brings the exported plants up to date; a scene leaves out plants that have no result yet.
pub(crate) fn made<'a>(
    scene: &mut SceneEvaluator,
    document: &'a Document,
    only: Option<PlantId>,
    run: &Run<'_>,
) -> Result<Vec<&'a DocumentPlant>, WorkspaceError> {
    let mut made = Vec::new();
    for plant in document.plants().iter().filter(chosen(only)) {
        match scene.update(plant.id(), document, run) {
            Ok(()) => made.push(plant),
            Err(e) if e.is_bare() && only.is_none() => {}
            Err(e) if e.is_cancelled() => return Err(WorkspaceError::Cancelled),
            Err(e) => return Err(e.into()),
        }
    }
    if made.is_empty() { Err(WorkspaceError::NothingMade) } else { Ok(made) }
}

/// Models of a level of detail. Copies that share a model share its coarser copies, too.
#[derive(Debug, Default)]
pub(crate) struct Level {
    pub(crate) models: Vec<Model>,
    /// Each model without leaves of one form, and these; empty unless they are written once.
    copies: Vec<(Model, Vec<Copies>)>,
    /// The row of each plant's model.
    pub(crate) rows: Vec<usize>,
}

impl Level {
    /// Makes a level as `wanted` has it; level 0 is the finest.
    pub(crate) fn make(
        scene: &SceneEvaluator,
        plants: &[&DocumentPlant],
        (level, wanted): (u32, &ExportRequest),
        run: &Run<'_>,
    ) -> Result<Self, WorkspaceError> {
        let mut revisions: Vec<u64> = Vec::new();
        let mut at = Self::default();
        for plant in plants {
            let revision = scene.get(plant.id()).map_or(0, |p| p.revision);
            let known = revisions.iter().position(|r| *r == revision);
            at.rows.push(known.unwrap_or(at.models.len()));
            if known.is_none() {
                revisions.push(revision);
                at.push(scene, plant, (level, wanted), run)?;
            }
        }
        Ok(at)
    }

    /// Adds the model of a plant.
    fn push(
        &mut self,
        scene: &SceneEvaluator,
        plant: &DocumentPlant,
        (level, wanted): (u32, &ExportRequest),
        run: &Run<'_>,
    ) -> Result<(), WorkspaceError> {
        let made = scene.level(plant, level, run)?;
        let finest = scene.get(plant.id()).filter(|_| level == 0).and_then(|p| p.plant.zip(p.owners));
        let mut split = wanted.has_copies().then(|| match finest {
            Some((whole, layout)) => Some(burgeon::skin::copies(whole, &made.model, layout)),
            None => made.copies(),
        });
        let mut model = made.model;
        if wanted.named {
            let name = &plant.settings().name;
            let rest = split.iter_mut().flatten().map(|(rest, _)| rest);
            rest.chain([&mut model]).for_each(|m| burgeon::name_after(name, m));
        }
        self.copies.extend(split.take().map(|split| split.unwrap_or_else(|| (model.clone(), Vec::new()))));
        self.models.push(model);
        Ok(())
    }

    /// Returns each plant in its place, or a single one at its origin.
    pub(crate) fn standing<'a>(&'a self, plants: &[&'a DocumentPlant], home: bool) -> Vec<Standing<'a>> {
        self.stand(&self.models, plants, home)
    }

    /// Returns these models, one for each of the own, in the places of the plants.
    fn stand<'a>(
        &'a self,
        models: impl IntoIterator<Item = &'a Model>,
        plants: &[&'a DocumentPlant],
        home: bool,
    ) -> Vec<Standing<'a>> {
        let models: Vec<&Model> = models.into_iter().collect();
        let rows = plants.iter().zip(&self.rows);
        let stands = rows.filter_map(|(plant, &row)| {
            let model = *models.get(row)?;
            Some(if home { Standing::home(&plant.settings().name, model) } else { standing(plant, model) })
        });
        stands.collect()
    }

    /// Joins the plants into one model, and once more without leaves of one form where these are written once.
    pub(crate) fn joined(&self, name: &str, plants: &[&DocumentPlant], home: bool) -> Joined {
        let model = scene_model(name, &self.standing(plants, home));
        let copies = (!self.copies.is_empty()).then(|| {
            let rest = self.stand(self.copies.iter().map(|(rest, _)| rest), plants, home);
            let copies: Vec<&[Copies]> =
                self.rows.iter().filter_map(|row| Some(&*self.copies.get(*row)?.1)).collect();
            (scene_model(name, &rest), burgeon::scene_copies(&rest, &copies))
        });
        Joined { model, copies }
    }
}

/// Returns the files of a scene. glTF has each model once, however often it occurs; others have room for one model.
pub(crate) fn scene_files(
    name: &str,
    plants: &[Standing<'_>],
    format: ModelFormat,
    stem: &str,
    spec: &ExportSpec,
    cache: &mut PngCache,
) -> Result<Vec<NamedFile>, WorkspaceError> {
    if format.holds(Room::Instances) {
        let mut out = Vec::new();
        formats::write_glb_scene(name, plants, cache, &mut out)?;
        return gltf_named(out, format, stem);
    }
    written(&scene_model(name, plants), format, stem, spec)
}

/// Returns one file for each plant.
fn structure<'a>(
    plants: impl Iterator<Item = (PlantId, Option<&'a Plant>)>,
    extension: &str,
    write: impl Fn(&Plant, &mut Vec<u8>) -> Result<(), formats::WriteError>,
) -> Result<Vec<NamedFile>, WorkspaceError> {
    let mut files = Vec::new();
    for (id, plant) in plants {
        let plant = plant.ok_or(WorkspaceError::Internal("no plant"))?;
        let mut out = Vec::new();
        write(plant, &mut out)?;
        files.push((format!("plant-{}.{extension}", id.0 + 1), out));
    }
    Ok(files)
}

/// Returns one file unchanged, several as a zip; formats with separate files always as a zip, so that the name of the
/// saved file is known before its textures are.
///
/// # Errors
/// [`WorkspaceError::Archive`] for files that no zip holds.
pub fn packed(format: ExportFormat, mut files: Vec<NamedFile>) -> Result<Vec<u8>, WorkspaceError> {
    let names_others = format.model().is_ok_and(|format| !format.row().beside.is_empty());
    if files.len() == 1 && !names_others { Ok(files.swap_remove(0).1) } else { Ok(document::pack(&files)?) }
}

/// Returns the files of a model.
pub(crate) fn written(
    model: &Model,
    format: ModelFormat,
    stem: &str,
    spec: &ExportSpec,
) -> Result<Vec<NamedFile>, WorkspaceError> {
    let (cache, report) = (&mut PngCache::new(), &mut Report::default());
    let files = model_files(model, format, stem, spec, cache, report)?;
    Ok(files.named(format!("{stem}.{}", format.extension())))
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
            let mut files = gltf_named(out, form.format, "plant")?;
            if let Some(finest) = self.models.first() {
                let beside = form.textures_beside(&self.plant, &finest.model, "plant")?;
                files.extend(beside.into_iter().map(|file| (file.name, file.bytes)));
            }
            return Ok(files);
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
    use crate::{Action, EngineAsk, NewMaker, Workspace};

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
    fn unreal_gets_a_skeleton_with_its_wind_or_a_mesh_with_its_pivots() {
        let ask = |format, levels| {
            let open = EngineAsk::new(Engine::Unreal, format);
            let answer = EngineAsk { whole: false, levels, ..open }.settle().expect("a file of its own");
            tulip(&answer.request)
        };
        let (files, figures) = ask(ModelFormat::Usda, None).unwrap();
        let text = String::from_utf8_lossy(&files[0].1);
        assert!(files[0].0 == "plant.usda" && text.contains("SkelRoot"), "{}", files[0].0);
        assert!(files.iter().any(|(name, _)| name == "plant-wind.json") && figures.triangles[0] > 100);
        let Err(refused) = ask(ModelFormat::Usda, Some(2)) else { panic!("Nanite makes levels") };
        assert_eq!(refused.details().code, "assembly-levels");
        let (files, _) = ask(ModelFormat::Glb, None).unwrap();
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["plant.glb", "plant-pivots.exr", "plant-axes.png"]);
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
