//! Exports: the scene or one plant, in every format that the command line writes.

use burgeon::document::{self, Document, DocumentPlant, PlantId};
use burgeon::formats::{
    self, DrawingFormat, ExportSpec, ModelFormat, PngCache, Room, StructureFormat, gltf_files, model_files,
};
use burgeon::mesh::{Model, Standing};
use burgeon::plant::Plant;
use burgeon::{Report, Run, SceneEvaluator, Unit, UpAxis, scene_model, standing};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Workspace, WorkspaceError};

/// Levels of detail that an export may have.
pub(crate) const MOST_LEVELS: u32 = 4;

/// Pixels along a side of the picture with views from all sides.
const IMPOSTOR: u32 = 1024;

/// A name and the bytes under it.
pub type NamedFile = (String, Vec<u8>);

/// A format that something is written as, by its word.
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
    /// The format of models that it is.
    ///
    /// # Errors
    /// [`WorkspaceError::Format`] for one that holds no models.
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

/// What is exported, and how it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
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
    /// The whole scene, else the current plant.
    pub whole: bool,
    /// How wind moves drawings and trees, where the format has room for it.
    pub wind: bool,
    /// All levels in one file, where it is glTF (`MSFT_lod`); else each has its own.
    pub one_file: bool,
    /// Joints and an animation that sways, where it is glTF; each level then has a file of its own.
    pub sway: bool,
    /// One more level, the last: views from all sides in one picture, where it is glTF.
    pub impostor: bool,
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
        }
    }
}

impl ExportRequest {
    /// Whether what is written says how wind moves it.
    pub(crate) fn blown(&self) -> bool {
        (self.wind && self.format.holds(Room::Wind)) || self.sways()
    }

    fn sways(&self) -> bool {
        self.sway && self.format.holds(Room::Joints)
    }

    /// Whether the level after the others is views from all sides.
    pub(crate) fn ends_far(&self) -> bool {
        self.impostor && self.format.holds(Room::Levels)
    }

    /// Whether each level is written as one model of the whole scene.
    fn joined(&self) -> bool {
        let one = self.format.holds(Room::Levels) && self.one_file && self.levels > 1;
        self.sways() || self.ends_far() || one
    }

    pub(crate) fn spec(&self) -> ExportSpec {
        ExportSpec { up: self.up, unit: self.unit }
    }
}

impl Workspace {
    /// What is shown as files: several for formats with textures beside them, levels of detail, and structures of several
    /// plants.
    ///
    /// # Errors
    /// [`WorkspaceError`]: when there is nothing to export.
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
            return written(model, wanted.format.model()?, "plant", &wanted.spec());
        }
        self.draft = None;
        let only = if wanted.whole { None } else { Some(self.must()?) };
        export(&mut self.scene, self.editor.document(), only, wanted, run)
    }
}

fn export(
    scene: &mut SceneEvaluator,
    document: &Document,
    only: Option<PlantId>,
    wanted: &ExportRequest,
    run: &Run<'_>,
) -> Result<Vec<NamedFile>, WorkspaceError> {
    let mut aside;
    let scene = if wanted.blown() {
        // What is shown stays without: its meshes would be half as large again.
        aside = scene.aside(document.plants().iter().filter(chosen(only)));
        aside.set_wind(true);
        &mut aside
    } else {
        scene
    };
    let made = made(scene, document, only, run)?;
    if let ExportFormat::Structure(format) = wanted.format {
        let plants = made.iter().map(|p| (p.id(), scene.get(p.id()).and_then(|made| made.plant)));
        return structure(plants, format.extension(), |plant, out| {
            burgeon::write_structure(plant, format, &wanted.spec(), out)
        });
    }
    let (format, spec) = (wanted.format.model()?, wanted.spec());
    let levels = wanted.levels.clamp(1, MOST_LEVELS);
    if wanted.joined() {
        let models: Result<Vec<Model>, WorkspaceError> = (0..levels)
            .map(|level| {
                let at = Level::of(scene, &made, level, run)?;
                Ok(scene_model(document.name(), &at.standing(&made, only.is_some())))
            })
            .collect();
        return joined(models?, wanted, run);
    }
    let mut files = Vec::new();
    for level in 0..levels {
        let at = Level::of(scene, &made, level, run)?;
        let stem = if levels == 1 { "plant".into() } else { format!("plant_LOD{level}") };
        let standing = at.standing(&made, only.is_some());
        files.extend(scene_files(document.name(), &standing, format, &stem, &spec, &mut PngCache::new())?);
    }
    Ok(files)
}

/// Levels as glTF, each of one model: in one file or several, with joints, with views from all sides as the last.
fn joined(
    mut models: Vec<Model>,
    wanted: &ExportRequest,
    run: &Run<'_>,
) -> Result<Vec<NamedFile>, WorkspaceError> {
    if wanted.ends_far()
        && let Some(finest) = models.first()
        && let Some(far) = far(finest, run)?
    {
        models.push(far);
    }
    let format = wanted.format.model()?;
    let mut cache = PngCache::new();
    if wanted.one_file && !wanted.sways() {
        let mut out = Vec::new();
        let levels: Vec<formats::Level<'_>> = models.iter().map(formats::Level::plain).collect();
        formats::write_glb_levels(&levels, None, &mut cache, &mut out)?;
        return gltf_named(out, format, "plant");
    }
    let mut files = Vec::new();
    for (level, model) in models.iter().enumerate() {
        let mut out = Vec::new();
        let gust = burgeon::skin::gust(model);
        match burgeon::skin::sway(model, gust).filter(|_| wanted.sways()) {
            Some(rig) => formats::write_glb_rigged(model, &rig, &mut cache, &mut out)?,
            None => formats::write_glb_with(model, &mut cache, &mut out)?,
        }
        let stem = if models.len() == 1 { "plant".into() } else { format!("plant_LOD{level}") };
        files.extend(gltf_named(out, format, &stem)?);
    }
    Ok(files)
}

/// A binary glTF in a format of its family, with the names of its files.
fn gltf_named(glb: Vec<u8>, format: ModelFormat, stem: &str) -> Result<Vec<NamedFile>, WorkspaceError> {
    Ok(gltf_files(glb, format, stem)?.named(format!("{stem}.{}", format.extension())))
}

/// Views of a model from all sides; none of nothing.
pub(crate) fn far(model: &Model, run: &Run<'_>) -> Result<Option<Model>, WorkspaceError> {
    burgeon::render::impostor(model, IMPOSTOR, run).map_err(|_cancelled| WorkspaceError::Cancelled)
}

/// Which plants are written: all that are not hidden, or one.
pub(crate) fn chosen(only: Option<PlantId>) -> impl Fn(&&DocumentPlant) -> bool {
    move |p| only.map_or(!p.settings().hidden, |id| p.id() == id)
}

/// Brings what is written up to date; plants that there is nothing of yet are left out of a scene.
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

/// The models of a level of detail. Copies that share a model share its coarser copies, too.
#[derive(Debug, Default)]
pub(crate) struct Level {
    pub(crate) models: Vec<Model>,
    /// The row of each plant's model.
    pub(crate) rows: Vec<usize>,
}

impl Level {
    /// Level 0 is the finest.
    pub(crate) fn of(
        scene: &SceneEvaluator,
        plants: &[&DocumentPlant],
        level: u32,
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
                at.models.push(scene.at_level(plant, level, run)?);
            }
        }
        Ok(at)
    }

    /// Each plant where it stands, or one where it was made.
    pub(crate) fn standing<'a>(&'a self, plants: &[&'a DocumentPlant], home: bool) -> Vec<Standing<'a>> {
        let rows = plants.iter().zip(&self.rows);
        let stands = rows.filter_map(|(plant, &row)| {
            let model = self.models.get(row)?;
            Some(if home { Standing::home(&plant.settings().name, model) } else { standing(plant, model) })
        });
        stands.collect()
    }
}

/// The files of a scene. glTF has each model once, however often it stands there; others have room for one model.
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

/// A file a plant.
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

/// One file as it is, several as a zip; formats with files beside theirs always as a zip, so that the name of what is saved
/// is known before their textures are.
///
/// # Errors
/// [`WorkspaceError::Archive`] for what no zip holds.
pub fn packed(format: ExportFormat, mut files: Vec<NamedFile>) -> Result<Vec<u8>, WorkspaceError> {
    let names_others = format.model().is_ok_and(|format| !format.row().beside.is_empty());
    if files.len() == 1 && !names_others { Ok(files.swap_remove(0).1) } else { Ok(document::pack(&files)?) }
}

/// The files of a model.
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
