//! What travels between worker and session as JSON; `types.ts` has the same as TypeScript types.

use std::sync::Arc;

use burgeon::document::{
    Command, Document, DocumentPlant, FlowerCommand, FlowerSettings, LeafCommand, LeafData, LeafSettings,
    Maker, NamedObstacle, Photo, Placement, PlantCommand, PlantId, SceneCommand, ShapeCommand, SketchCommand,
    TreeCommand,
};
use burgeon::glam::{DVec2, DVec3};
use burgeon::growth::Obstacle;
use burgeon::shape::HandEdit;
use burgeon::sketch::{SketchSpec, StrokeClass, StrokeMode};
use burgeon::skin::{PetalColor, SkinSpec};
use burgeon::{ItemReport, Preset, bloom, leaf_marks, tree_settings};
use burgeon::{Seed, Unit, UpAxis, document::StrokeId, formats::ExportSpec};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = include_str!("types.ts");

/// A command as the page sends it: its name and in it its fields, braces also where there are none. Those that name no
/// plant are for the one that is chosen.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum WireCommand {
    Remove {
        ids: Vec<u32>,
    },
    Move {
        ids: Vec<u32>,
        x: f64,
        y: f64,
    },
    Class {
        ids: Vec<u32>,
        class: Option<StrokeClass>,
    },
    Mode {
        ids: Vec<u32>,
        mode: StrokeMode,
    },
    Color {
        ids: Vec<u32>,
        color: Option<[u8; 3]>,
    },
    Duplicate {
        ids: Vec<u32>,
        x: f64,
        y: f64,
    },
    /// How the photograph lies.
    Photo {
        x: f64,
        y: f64,
        width: f64,
        opacity: f64,
        paint: bool,
    },
    PhotoOff {},
    Clear {},
    Sketch {
        spec: Box<SketchSpec>,
    },
    Skin {
        skin: Skin,
    },
    Day {
        day: Option<f64>,
    },
    /// An empty document in the place of this one.
    New {},
    RenameScene {
        name: String,
    },
    /// `preset`: a tree's, or a flower's species.
    Add {
        maker: String,
        name: String,
        #[serde(default)]
        preset: Option<String>,
    },
    DuplicatePlant {
        plant: u32,
        by: [f64; 3],
    },
    RemovePlant {
        plant: u32,
    },
    Rename {
        plant: u32,
        name: String,
    },
    Seed {
        seed: String,
    },
    Lock {
        on: bool,
    },
    Hide {
        plant: u32,
        on: bool,
    },
    Place {
        plant: u32,
        position: [f64; 3],
        yaw_deg: f64,
        scale: f64,
    },
    /// Another species for a tree.
    Preset {
        key: String,
    },
    /// One field of a tree's spec, by its JSON pointer.
    Tree {
        path: String,
        value: Value,
    },
    /// A new obstacle, or another shape for that of a row.
    Obstacle {
        name: String,
        shape: Obstacle,
        #[serde(default)]
        row: Option<usize>,
    },
    ObstacleOff {
        row: usize,
    },
    LeafOf {
        lender: Option<u32>,
    },
    Leaf {
        settings: Box<LeafSettings>,
    },
    Marks {
        name: String,
        text: String,
    },
    Flower {
        settings: Box<FlowerSettings>,
    },
    Law {
        text: Option<String>,
    },
    /// One more edit by hand, or another in the place of that of a row.
    Shape {
        edit: Box<HandEdit>,
        #[serde(default)]
        row: Option<usize>,
    },
    ShapeLeave {
        row: usize,
        off: bool,
    },
    ShapeRemove {
        rows: Vec<usize>,
    },
}

impl WireCommand {
    /// `current`: the plant that is chosen.
    pub(crate) fn command(&self, current: Option<PlantId>, document: &Document) -> Result<Command, String> {
        let here = || current.ok_or("there is no plant; add one first");
        let scene = |c| Ok(Command::Scene(c));
        match self {
            Self::New {} => scene(SceneCommand::Open(Box::default())),
            Self::RenameScene { name } => scene(SceneCommand::Rename(name.clone())),
            Self::DuplicatePlant { plant, by } => {
                scene(SceneCommand::Duplicate(PlantId(*plant), DVec3::from_array(*by)))
            }
            Self::RemovePlant { plant } => scene(SceneCommand::Remove(vec![PlantId(*plant)])),
            Self::Rename { plant, name } => Ok(PlantCommand::Rename(name.clone()).of(PlantId(*plant))),
            Self::Hide { plant, on } => Ok(PlantCommand::Hide(*on).of(PlantId(*plant))),
            Self::Place { plant, position, yaw_deg, scale } => {
                let placement =
                    Placement { position: DVec3::from_array(*position), yaw_deg: *yaw_deg, scale: *scale };
                Ok(PlantCommand::Place(placement).of(PlantId(*plant)))
            }
            Self::Seed { seed } => {
                let number = seed.parse().ok().ok_or("the seed is a whole number from 0 to 2^64 - 1")?;
                Ok(PlantCommand::SetSeed(Seed::new(number)).of(here()?))
            }
            Self::Lock { on } => Ok(PlantCommand::Lock(*on).of(here()?)),
            Self::LeafOf { lender } => {
                let (id, lender) = (here()?, lender.map(PlantId));
                let is_tree =
                    document.plant(id).is_some_and(|p| matches!(p.settings().maker, Maker::Tree(_)));
                Ok(if is_tree {
                    TreeCommand::SetLeaf(lender).of(id)
                } else {
                    SketchCommand::SetLeaf(lender).of(id)
                })
            }
            Self::Preset { .. } | Self::Tree { .. } | Self::Obstacle { .. } | Self::ObstacleOff { .. } => {
                Ok(self.tree(document.plant(here()?))?.of(here()?))
            }
            Self::Leaf { settings } => Ok(LeafCommand::Set(settings.clone()).of(here()?)),
            Self::Marks { name, text } => {
                let data = LeafData { name: name.clone(), text: text.as_str().into() };
                let (marks, _) = leaf_marks(&data, 0.1).map_err(|e| e.to_string())?;
                if let Some(fault) = marks.validate().next() {
                    return Err(fault.to_string());
                }
                Ok(LeafCommand::SetData(data).of(here()?))
            }
            Self::Flower { settings } => Ok(FlowerCommand::Set(settings.clone()).of(here()?)),
            Self::Law { text } => {
                let read =
                    |t: &String| serde_json::from_str::<bloom::GrowthLaw>(t).map_err(|e| e.to_string());
                Ok(FlowerCommand::SetLaw(text.as_ref().map(read).transpose()?.map(Arc::new)).of(here()?))
            }
            Self::Shape { edit, row } => {
                let edit = Arc::new(HandEdit::clone(edit));
                let command = match row {
                    Some(row) => ShapeCommand::Replace(*row, edit),
                    None => ShapeCommand::Add(edit),
                };
                Ok(command.of(here()?))
            }
            Self::ShapeLeave { row, off } => Ok(ShapeCommand::Leave(*row, *off).of(here()?)),
            Self::ShapeRemove { rows } => Ok(ShapeCommand::Remove(rows.clone()).of(here()?)),
            _ => Ok(self.sketch(document.plant(here()?))?.of(here()?)),
        }
    }

    fn tree(&self, plant: Option<&DocumentPlant>) -> Result<TreeCommand, String> {
        if !matches!(plant.map(|p| &p.settings().maker), Some(Maker::Tree(_))) {
            return Err("the plant is no tree".into());
        }
        let command = match self {
            Self::Preset { key } => {
                let preset = Preset::find(key).ok_or_else(|| format!("there is no tree {key:?}"))?;
                let settings = tree_settings(&preset.spec().map_err(|e| e.to_string())?, Some(key));
                TreeCommand::SetSpec(settings.preset, settings.spec)
            }
            Self::Tree { path, value } => TreeCommand::SetField(path.clone(), value.clone()),
            Self::Obstacle { name, shape, row } => {
                let new = NamedObstacle { name: name.clone(), shape: Arc::new(shape.clone()) };
                row.map_or_else(
                    || TreeCommand::AddObstacle(new.clone()),
                    |row| TreeCommand::SetObstacle(row, new.clone()),
                )
            }
            Self::ObstacleOff { row } => TreeCommand::RemoveObstacle(*row),
            _ => return Err("internal: no command of a tree".into()),
        };
        Ok(command)
    }

    fn sketch(&self, plant: Option<&DocumentPlant>) -> Result<SketchCommand, String> {
        let ids = |ids: &[u32]| ids.iter().copied().map(StrokeId).collect();
        Ok(match self {
            Self::Remove { ids: i } => SketchCommand::RemoveStrokes(ids(i)),
            Self::Move { ids: i, x, y } => SketchCommand::MoveStrokes(ids(i), DVec2::new(*x, *y)),
            Self::Class { ids: i, class } => SketchCommand::SetClass(ids(i), *class),
            Self::Mode { ids: i, mode } => SketchCommand::SetMode(ids(i), *mode),
            Self::Color { ids: i, color } => SketchCommand::SetColor(ids(i), *color),
            Self::Duplicate { ids: i, x, y } => SketchCommand::Duplicate(ids(i), DVec2::new(*x, *y)),
            Self::Photo { x, y, width, opacity, paint } => {
                let photo = plant.and_then(|p| p.settings().photo());
                let mut photo = photo.cloned().ok_or("there is no photograph under the drawing")?;
                (photo.x, photo.y, photo.width) = (*x, *y, *width);
                (photo.opacity, photo.paint) = (*opacity, *paint);
                SketchCommand::SetPhoto(Some(Box::new(photo)))
            }
            Self::PhotoOff {} => SketchCommand::SetPhoto(None),
            Self::Clear {} => SketchCommand::Clear,
            Self::Sketch { spec } => SketchCommand::SetSketch(spec.clone()),
            Self::Skin { skin } => SketchCommand::SetSkin(skin.spec()?),
            Self::Day { day } => SketchCommand::SetDay(*day),
            _ => return Err("internal: no command of a sketch".into()),
        })
    }
}

/// The skin's settings by their words.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Skin {
    detail: f64,
    sides: u32,
    textures: bool,
    petals: Option<String>,
    variation: f64,
}

impl Skin {
    pub(crate) fn of(s: &SkinSpec) -> Self {
        Self {
            detail: s.detail,
            sides: s.sides,
            textures: s.textures,
            petals: s.petals.map(|p| p.word().into()),
            variation: s.variation,
        }
    }

    fn spec(&self) -> Result<SkinSpec, String> {
        let Self { detail, sides, textures, petals, variation } = self;
        let color = |word: &String| {
            let found = PetalColor::ALL.into_iter().find(|c| c.word() == *word);
            found.ok_or_else(|| format!("the petal colour {word:?} is unknown"))
        };
        let petals = petals.as_ref().map(color).transpose()?;
        let (detail, sides) = (*detail, *sides);
        Ok(SkinSpec {
            detail,
            sides,
            textures: *textures,
            petals,
            variation: *variation,
            ..SkinSpec::default()
        })
    }
}

#[derive(Debug, Serialize)]
pub(crate) struct StrokeState {
    pub(crate) id: u32,
    pub(crate) mode: StrokeMode,
    pub(crate) class: Option<StrokeClass>,
    pub(crate) color: Option<[u8; 3]>,
}

#[derive(Debug, Serialize)]
pub(crate) struct DocumentState<'a> {
    pub(crate) revision: u64,
    pub(crate) undo: Option<&'a str>,
    pub(crate) redo: Option<&'a str>,
    pub(crate) steps: usize,
    pub(crate) name: &'a str,
    pub(crate) current: Option<u32>,
    pub(crate) plants: Vec<PlantState<'a>>,
}

#[derive(Debug, Serialize)]
pub(crate) struct PlantState<'a> {
    id: u32,
    maker: &'static str,
    name: &'a str,
    /// As text: JavaScript's numbers hold 53 bits.
    seed: String,
    locked: bool,
    hidden: bool,
    position: [f64; 3],
    yaw_deg: f64,
    scale: f64,
    /// Whether others may bear its leaf.
    lends: bool,
    edits: Vec<EditState>,
    sketch: Option<SketchState<'a>>,
    tree: Option<TreeState<'a>>,
    leaf: Option<LeafState<'a>>,
    flower: Option<FlowerState<'a>>,
}

#[derive(Debug, Serialize)]
struct EditState {
    op: &'static str,
    off: bool,
}

#[derive(Debug, Serialize)]
struct SketchState<'a> {
    sketch: &'a SketchSpec,
    skin: Skin,
    strokes: Vec<StrokeState>,
    photo: Option<PhotoState>,
    day: Option<f64>,
    leaf: Option<u32>,
}

#[derive(Debug, Serialize)]
struct TreeState<'a> {
    preset: Option<&'a str>,
    spec: &'a burgeon::TreeSpec,
    skin: Skin,
    leaf: Option<u32>,
    obstacles: Vec<NamedShape<'a>>,
}

#[derive(Debug, Serialize)]
struct NamedShape<'a> {
    name: &'a str,
    shape: ObstacleView,
}

#[derive(Debug, Serialize)]
struct LeafState<'a> {
    file: &'a str,
    text: &'a str,
    settings: &'a LeafSettings,
}

#[derive(Debug, Serialize)]
struct FlowerState<'a> {
    settings: &'a FlowerSettings,
    law: Option<&'a str>,
}

/// An obstacle for the page: a mesh is told by its size only, its corners are asked for.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum ObstacleView {
    Shape(Obstacle),
    Mesh { shape: &'static str, triangles: usize },
}

impl ObstacleView {
    pub(crate) fn of(shape: &Obstacle) -> Self {
        match shape {
            Obstacle::Mesh { triangles, .. } => Self::Mesh { shape: "mesh", triangles: triangles.len() },
            other => Self::Shape(other.clone()),
        }
    }
}

impl<'a> PlantState<'a> {
    pub(crate) fn of(plant: &'a DocumentPlant, document: &Document) -> Self {
        let s = plant.settings();
        let leaf = s.maker.leaf().map(|id| id.0);
        let mut state = Self {
            id: plant.id().0,
            maker: s.maker.word(),
            name: &s.name,
            seed: s.seed.number().to_string(),
            locked: s.locked,
            hidden: s.hidden,
            position: s.placement.position.to_array(),
            yaw_deg: s.placement.yaw_deg,
            scale: s.placement.scale,
            lends: document.lends_leaf(plant.id()),
            edits: s.edits.iter().map(|e| EditState { op: e.edit.word(), off: e.off }).collect(),
            sketch: None,
            tree: None,
            leaf: None,
            flower: None,
        };
        match &s.maker {
            Maker::Sketch(k) => {
                let strokes = plant.strokes().iter().map(|s| StrokeState {
                    id: s.id.0,
                    mode: s.stroke.mode,
                    class: s.class,
                    color: s.stroke.color,
                });
                state.sketch = Some(SketchState {
                    sketch: &k.sketch,
                    skin: Skin::of(&k.skin),
                    strokes: strokes.collect(),
                    photo: k.photo.as_ref().map(PhotoState::of),
                    day: k.day,
                    leaf,
                });
            }
            Maker::Tree(t) => {
                let obstacles = t.obstacles.iter();
                let obstacles =
                    obstacles.map(|o| NamedShape { name: &o.name, shape: ObstacleView::of(&o.shape) });
                state.tree = Some(TreeState {
                    preset: t.preset.as_deref(),
                    spec: &t.spec,
                    skin: Skin::of(&t.skin),
                    leaf,
                    obstacles: obstacles.collect(),
                });
            }
            Maker::Leaf(l) => {
                state.leaf =
                    Some(LeafState { file: &l.data.name, text: &l.data.text, settings: &l.settings });
            }
            Maker::Flower(f) => {
                state.flower =
                    Some(FlowerState { settings: &f.settings, law: f.law.as_ref().map(|l| l.name.as_str()) });
            }
            _ => {}
        }
        state
    }
}

#[derive(Debug, Serialize)]
pub(crate) struct PhotoState {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
    opacity: f64,
    paint: bool,
    pixels: (u32, u32),
}

impl PhotoState {
    pub(crate) fn of(p: &Photo) -> Self {
        let Photo { x, y, width, opacity, paint, .. } = *p;
        Self { x, y, width, height: p.height(), opacity, paint, pixels: p.size() }
    }
}

/// How a model is written.
#[derive(Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct ExportOptions {
    /// Levels of detail, 1 to 4: each has about half of the triangles of the one before.
    pub(crate) levels: u32,
    pub(crate) up: String,
    pub(crate) unit: String,
    /// The whole scene, else the plant that is chosen.
    pub(crate) whole: bool,
    /// How wind moves drawings and trees, where the format has room for it.
    pub(crate) wind: bool,
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self { levels: 1, up: "y".into(), unit: "m".into(), whole: false, wind: false }
    }
}

impl ExportOptions {
    pub(crate) fn spec(&self) -> Result<ExportSpec, String> {
        let up = match self.up.as_str() {
            "y" => UpAxis::Y,
            "z" => UpAxis::Z,
            other => return Err(format!("up is y or z, not {other:?}")),
        };
        let unit = match self.unit.as_str() {
            "m" => Unit::Metre,
            "cm" => Unit::Centimetre,
            "mm" => Unit::Millimetre,
            other => return Err(format!("the unit is m, cm or mm, not {other:?}")),
        };
        Ok(ExportSpec { up, unit })
    }
}

#[derive(Debug, Default, Serialize)]
pub(crate) struct Opened {
    pub(crate) kind: &'static str,
    pub(crate) name: String,
    /// Every drawing of the file, at most a thousand.
    pub(crate) names: Vec<String>,
    pub(crate) warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
pub(crate) struct TextureView {
    pub(crate) number: usize,
    pub(crate) width: u32,
    pub(crate) height: u32,
}

#[derive(Debug, Serialize)]
pub(crate) struct MaterialView {
    pub(crate) name: String,
    pub(crate) kind: &'static str,
    pub(crate) color: [f32; 3],
    pub(crate) roughness: f32,
    pub(crate) translucency: f32,
    pub(crate) masked: bool,
    pub(crate) two_sided: bool,
    pub(crate) texture: Option<TextureView>,
}

#[derive(Debug, Serialize)]
pub(crate) struct PartView {
    pub(crate) name: String,
    pub(crate) material: usize,
}

#[derive(Debug, Serialize)]
pub(crate) struct Front {
    pub(crate) metres_per_unit: f64,
    pub(crate) x: f64,
    pub(crate) y: f64,
}

#[derive(Debug, Serialize)]
pub(crate) struct View {
    pub(crate) revision: u64,
    pub(crate) guest: Option<PlantView>,
    pub(crate) plants: Vec<PlantView>,
}

#[derive(Debug, Serialize)]
pub(crate) struct PlantView {
    id: u32,
    /// The page does not have these meshes.
    pub(crate) fresh: bool,
    pub(crate) error: Option<String>,
    pub(crate) item: Option<ItemReport>,
    pub(crate) stages: Vec<&'static str>,
    pub(crate) front: Option<Front>,
    /// Bud to full bloom, and from there to wilted.
    pub(crate) days: Option<[f64; 2]>,
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
    pub(crate) parts: Vec<PartView>,
    pub(crate) materials: Vec<MaterialView>,
    pub(crate) obstacles: Vec<ObstacleView>,
}

impl PlantView {
    pub(crate) fn empty(id: u32) -> Self {
        Self {
            id,
            fresh: true,
            error: None,
            item: None,
            stages: Vec::new(),
            front: None,
            days: None,
            min: [0.0; 3],
            max: [0.0; 3],
            parts: Vec::new(),
            materials: Vec::new(),
            obstacles: Vec::new(),
        }
    }
}
