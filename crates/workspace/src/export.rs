//! Exports: the scene or one plant, in every format that the command line writes.

use burgeon::document::{self, Document, DocumentPlant, PlantId};
use burgeon::formats::{self, ExportSpec, ModelFormat, PngCache, StructureFormat, obj_files, usd_files};
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

/// As what something is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ExportFormat {
    /// A binary glTF file.
    #[default]
    Glb,
    /// A USD stage with its textures.
    Usda,
    /// OBJ with its material file and textures.
    Obj,
    /// Triangles with colours.
    Ply,
    /// Bare triangles.
    Stl,
    /// The current drawing in our JSON.
    Json,
    /// The current drawing as SVG, with its layers.
    Svg,
    /// The structure of each plant.
    #[serde(untagged)]
    Structure(StructureFormat),
}

impl ExportFormat {
    pub(crate) fn model(self) -> Result<ModelFormat, WorkspaceError> {
        Ok(match self {
            Self::Glb => ModelFormat::Glb,
            Self::Usda => ModelFormat::Usda,
            Self::Obj => ModelFormat::Obj,
            Self::Ply => ModelFormat::Ply,
            Self::Stl => ModelFormat::Stl,
            Self::Structure(format) => return Err(WorkspaceError::Format(format.word())),
            Self::Json => return Err(WorkspaceError::Format("json")),
            Self::Svg => return Err(WorkspaceError::Format("svg")),
        })
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
    pub up: Up,
    /// The unit of the file.
    pub unit: LengthUnit,
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
            up: Up::Y,
            unit: LengthUnit::M,
            whole: false,
            wind: false,
            one_file,
            sway,
            impostor,
        }
    }
}

/// A vertical axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Up {
    /// As inside.
    Y,
    /// As Blender and most CAD programs have it.
    Z,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LengthUnit {
    /// Metres, as inside.
    M,
    /// Centimetres.
    Cm,
    /// Millimetres.
    Mm,
}

impl ExportRequest {
    /// Whether what is written says how wind moves it.
    pub(crate) fn blown(&self) -> bool {
        (self.wind && self.format.model().is_ok_and(ModelFormat::carries_wind)) || self.sways()
    }

    fn sways(&self) -> bool {
        self.sway && self.format == ExportFormat::Glb
    }

    /// Whether the level after the others is views from all sides.
    pub(crate) fn ends_far(&self) -> bool {
        self.impostor && self.format == ExportFormat::Glb
    }

    /// Whether each level is written as one model of the whole scene.
    fn joined(&self) -> bool {
        let one = self.format == ExportFormat::Glb && self.one_file && self.levels > 1;
        self.sways() || self.ends_far() || one
    }

    pub(crate) fn spec(&self) -> ExportSpec {
        let up = match self.up {
            Up::Y => UpAxis::Y,
            Up::Z => UpAxis::Z,
        };
        let unit = match self.unit {
            LengthUnit::M => Unit::Metre,
            LengthUnit::Cm => Unit::Centimetre,
            LengthUnit::Mm => Unit::Millimetre,
        };
        ExportSpec { up, unit }
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
        if let ExportFormat::Json | ExportFormat::Svg = wanted.format {
            let drawing = self.current_plant().ok_or(WorkspaceError::NoDrawing)?.drawing();
            let mut out = Vec::new();
            if wanted.format == ExportFormat::Svg {
                formats::write_svg(&drawing, &mut out)?;
                return Ok(vec![("drawing.svg".into(), out)]);
            }
            formats::write_drawing(&drawing, &mut out)?;
            return Ok(vec![("drawing.json".into(), out)]);
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
                let at = Level::of(scene, document, &made, level, run)?;
                Ok(scene_model(document.name(), &at.standing(&made, only.is_some())))
            })
            .collect();
        return joined(models?, wanted, run);
    }
    let mut files = Vec::new();
    for level in 0..levels {
        let at = Level::of(scene, document, &made, level, run)?;
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
    let mut cache = PngCache::new();
    let mut out = Vec::new();
    if wanted.one_file && !wanted.sways() {
        let levels: Vec<formats::Level<'_>> = models.iter().map(formats::Level::plain).collect();
        formats::write_glb_levels(&levels, None, &mut cache, &mut out)?;
        return Ok(vec![("plant.glb".into(), out)]);
    }
    let alone = models.len() == 1;
    let file = |(level, model): (usize, &Model)| {
        let mut out = Vec::new();
        let gust = burgeon::skin::gust(model);
        match burgeon::skin::sway(model, gust).filter(|_| wanted.sways()) {
            Some(rig) => formats::write_glb_rigged(model, &rig, &mut cache, &mut out)?,
            None => formats::write_glb_with(model, &mut cache, &mut out)?,
        }
        let name = if alone { "plant.glb".into() } else { format!("plant_LOD{level}.glb") };
        Ok((name, out))
    };
    models.iter().enumerate().map(file).collect()
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
        document: &Document,
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
                at.models.push(scene.at_level(plant, document, level, run)?);
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

/// The files of a scene. Binary glTF has each model once, however often it stands there; others have room for one model.
pub(crate) fn scene_files(
    name: &str,
    plants: &[Standing<'_>],
    format: ModelFormat,
    stem: &str,
    spec: &ExportSpec,
    cache: &mut PngCache,
) -> Result<Vec<NamedFile>, WorkspaceError> {
    if format == ModelFormat::Glb {
        let mut out = Vec::new();
        formats::write_glb_scene(name, plants, cache, &mut out)?;
        return Ok(vec![(format!("{stem}.glb"), out)]);
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

/// One file as it is, several as a zip; USD always as a zip, so that the name of what is saved is known before its
/// textures are.
///
/// # Errors
/// [`WorkspaceError::Archive`] for what no zip holds.
pub fn packed(format: ExportFormat, mut files: Vec<NamedFile>) -> Result<Vec<u8>, WorkspaceError> {
    match files.len() {
        1 if format != ExportFormat::Usda => Ok(files.swap_remove(0).1),
        _ => Ok(document::pack(&files)?),
    }
}

/// The files of a model.
pub(crate) fn written(
    model: &Model,
    format: ModelFormat,
    stem: &str,
    spec: &ExportSpec,
) -> Result<Vec<NamedFile>, WorkspaceError> {
    let (main, beside) = match format {
        ModelFormat::Obj => {
            let files = obj_files(model, stem, spec)?;
            let mut beside = vec![(format!("{stem}.mtl"), files.mtl)];
            beside.extend(files.textures);
            (("obj", files.obj), beside)
        }
        ModelFormat::Usda => {
            let files = usd_files(model, stem, spec)?;
            (("usda", files.usda), files.textures)
        }
        _ => {
            let mut out = Vec::new();
            formats::write_model(model, format, spec, &mut out, &mut Report::default())?;
            ((format.extension(), out), Vec::new())
        }
    };
    let mut all = vec![(format!("{stem}.{}", main.0), main.1)];
    all.extend(beside);
    Ok(all)
}
