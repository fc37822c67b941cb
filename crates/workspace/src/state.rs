//! The document as a shell shows it: everything but points, meshes and pictures.

use burgeon::bloom::FlowerSpec;
use burgeon::document::{
    Document, DocumentPlant, Editor, Maker, PhotoPlace, PlantId, PlantNumbers, StrokeId,
};
use burgeon::growth::{Obstacle, TreeSpec};
use burgeon::ink::{Layer, StrokeClass, StrokeMode};
use burgeon::sketch::SketchSpec;
use burgeon::skin::{OrganMaterial, SkinSpec};
use burgeon::spec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A document with its history, as lists and panels show it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct DocumentState<'a> {
    /// Grows with every change.
    pub revision: u64,
    /// Name of the step that undo takes back.
    pub undo: Option<&'a str>,
    /// Name of the step that redo does again.
    pub redo: Option<&'a str>,
    /// Steps that can be undone.
    pub steps: usize,
    /// Name of the scene.
    pub name: &'a str,
    /// The plant that is chosen.
    pub current: Option<PlantId>,
    /// The plants in the order in which they were added.
    pub plants: Vec<PlantState<'a>>,
    /// Their numbers.
    pub numbers: PlantNumbers,
}

impl<'a> DocumentState<'a> {
    pub(crate) fn from_editor(editor: &'a Editor, current: Option<PlantId>) -> Self {
        let document = editor.document();
        Self {
            revision: editor.revision(),
            undo: editor.done().last().map(|s| s.name.as_str()),
            redo: editor.undone().last().map(|s| s.name.as_str()),
            steps: editor.done().len(),
            name: document.name(),
            current,
            plants: document.plants().iter().map(|p| PlantState::from_plant(p, document)).collect(),
            numbers: document.numbers(),
        }
    }
}

/// One plant; of `sketch`, `tree`, `leaf` and `flower`, the field of its maker is present.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PlantState<'a> {
    /// Its name within the document.
    pub id: PlantId,
    /// Its maker.
    pub maker: MakerWord,
    /// Its name.
    pub name: &'a str,
    /// Seed as text: JavaScript's numbers hold 53 bits.
    pub seed: String,
    /// Whether dice leave its seed alone.
    pub locked: bool,
    /// Whether its place is locked.
    pub fixed: bool,
    /// Whether it is left out of the view.
    pub hidden: bool,
    /// The group it belongs to; empty for none.
    pub group: &'a str,
    /// Position, metres.
    pub position: [f64; 3],
    /// Turn about +Y, degrees.
    pub yaw_deg: f64,
    /// Scale.
    pub scale: f64,
    /// Whether others may bear its leaf.
    pub lends: bool,
    /// The materials of its leaves, petals and sepals.
    pub wear: WearState<'a>,
    /// Hand edits, in the order in which they are applied.
    pub edits: Vec<EditState>,
    /// State of a drawing.
    pub sketch: Option<SketchState<'a>>,
    /// State of a tree.
    pub tree: Option<TreeState<'a>>,
    /// State of a measured leaf.
    pub leaf: Option<LeafState<'a>>,
    /// State of a flower.
    pub flower: Option<FlowerState<'a>>,
}

/// The materials that a person gave to kinds of organs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct WearState<'a> {
    /// Material of all leaves.
    pub leaf: Option<&'a OrganMaterial>,
    /// Material of all petals.
    pub petal: Option<&'a OrganMaterial>,
    /// Material of all sepals and bracts.
    pub sepal: Option<&'a OrganMaterial>,
}

/// The maker of a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MakerWord {
    /// Drawn with a pen.
    Sketch,
    /// Grown.
    Tree,
    /// Measured.
    Leaf,
    /// A species that opens.
    Flower,
}

/// A hand edit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct EditState {
    /// Its word in [`burgeon::shape::HandEdit`].
    pub op: &'static str,
    /// Whether it is left out for now.
    pub off: bool,
}

/// A drawing without its points.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SketchState<'a> {
    /// Settings for reading it.
    pub sketch: &'a SketchSpec,
    /// Settings for meshing it.
    pub skin: &'a SkinSpec,
    /// Its strokes in the order in which they were drawn.
    pub strokes: Vec<StrokeState<'a>>,
    /// Its layers from below upwards.
    pub layers: &'a [Layer],
    /// The photograph under it.
    pub photo: Option<PhotoState>,
    /// The day at which its flowers are shown.
    pub day: Option<f64>,
    /// The plant whose leaf it bears.
    pub leaf: Option<PlantId>,
}

/// A stroke without its points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct StrokeState<'a> {
    /// Its name within the document.
    pub id: StrokeId,
    /// Mode in which it was drawn.
    pub mode: StrokeMode,
    /// The class that the person set.
    pub class: Option<StrokeClass>,
    /// Class that it was clearly shown as when the last stroke was drawn.
    pub shown: Option<StrokeClass>,
    /// Its own colour.
    pub color: Option<[u8; 3]>,
    /// Its own width, in the drawing's unit.
    pub width: Option<f64>,
    /// Name of its layer; none for the sheet itself.
    pub layer: Option<&'a str>,
    /// Its own material.
    pub material: Option<&'a OrganMaterial>,
}

/// Placement of a photograph, and its size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PhotoState {
    /// Requested placement.
    pub place: PhotoPlace,
    /// Height in the drawing's unit, which follows from the picture.
    pub height: f64,
    /// Pixels across and down.
    pub pixels: (u32, u32),
}

/// Settings of a tree.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct TreeState<'a> {
    /// The species that the spec came from.
    pub preset: Option<&'a str>,
    /// The spec, without obstacles.
    #[schemars(with = "std::collections::BTreeMap<String, Value>")]
    #[serde(serialize_with = "spec::through_json::serialize")]
    pub spec: &'a TreeSpec,
    /// Settings for meshing it.
    pub skin: &'a SkinSpec,
    /// The plant whose leaf it bears.
    pub leaf: Option<PlantId>,
    /// Obstacles that it grows around.
    pub obstacles: Vec<NamedShape<'a>>,
}

/// An obstacle with its name.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct NamedShape<'a> {
    /// Name in lists.
    pub name: &'a str,
    /// The solid.
    pub shape: ObstacleView,
}

/// An obstacle to be shown: of a mesh only the size; its corners are fetched separately.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ObstacleView {
    /// Any shape but a mesh.
    Shape(Obstacle),
    /// A mesh.
    Mesh {
        /// Always `mesh`.
        shape: &'static str,
        /// Number of triangles.
        triangles: usize,
    },
}

impl ObstacleView {
    pub(crate) fn from_obstacle(shape: &Obstacle) -> Self {
        match shape {
            Obstacle::Mesh { triangles, .. } => Self::Mesh { shape: "mesh", triangles: triangles.len() },
            other => Self::Shape(other.clone()),
        }
    }
}

/// Source of a leaf.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LeafState<'a> {
    /// Name of the file of marks or veins.
    pub file: &'a str,
    /// Its text.
    pub text: &'a str,
    /// Settings for making the leaf of it.
    pub settings: &'a burgeon::leaf::LeafSpec,
}

/// Settings of a flower, and its day.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FlowerState<'a> {
    /// The species that the spec came from.
    pub preset: Option<&'a str>,
    /// The spec.
    #[schemars(with = "std::collections::BTreeMap<String, Value>")]
    #[serde(serialize_with = "spec::through_json::serialize")]
    pub spec: &'a FlowerSpec,
    /// Days since the bud.
    pub day: f64,
    /// Name of the fitted law that sets its pace.
    pub law: Option<&'a str>,
}

impl<'a> PlantState<'a> {
    fn from_plant(plant: &'a DocumentPlant, document: &Document) -> Self {
        let s = plant.settings();
        let mut state = Self {
            id: plant.id(),
            maker: MakerWord::Sketch,
            name: &s.name,
            seed: s.seed.number().to_string(),
            locked: s.locked,
            fixed: s.fixed,
            group: &s.group,
            hidden: s.hidden,
            position: s.placement.position.to_array(),
            yaw_deg: s.placement.yaw_deg,
            scale: s.placement.scale,
            lends: document.lends_leaf(plant.id()),
            wear: WearState {
                leaf: s.wear.leaf.as_ref(),
                petal: s.wear.petal.as_ref(),
                sepal: s.wear.sepal.as_ref(),
            },
            edits: s.edits.iter().map(|e| EditState { op: e.edit.word(), off: e.off }).collect(),
            sketch: None,
            tree: None,
            leaf: None,
            flower: None,
        };
        match &s.maker {
            Maker::Sketch(k) => {
                let strokes = plant.strokes().iter().map(|s| StrokeState {
                    id: s.id,
                    mode: s.stroke.mode,
                    class: s.class,
                    shown: s.shown,
                    color: s.stroke.color,
                    width: s.stroke.width,
                    layer: s.stroke.layer.as_deref(),
                    material: s.material.as_deref(),
                });
                let photo = k.photo.as_ref();
                state.sketch = Some(SketchState {
                    sketch: &k.sketch,
                    skin: &k.skin,
                    strokes: strokes.collect(),
                    layers: &k.layers,
                    photo: photo.map(|p| PhotoState { place: p.place, height: p.height(), pixels: p.size() }),
                    day: k.day,
                    leaf: k.leaf,
                });
            }
            Maker::Tree(t) => {
                let obstacles = t.obstacles.iter();
                let obstacles = obstacles
                    .map(|o| NamedShape { name: &o.name, shape: ObstacleView::from_obstacle(&o.shape) });
                state.maker = MakerWord::Tree;
                state.tree = Some(TreeState {
                    preset: t.preset.as_deref(),
                    spec: &t.spec,
                    skin: &t.skin,
                    leaf: t.leaf,
                    obstacles: obstacles.collect(),
                });
            }
            Maker::Leaf(l) => {
                state.maker = MakerWord::Leaf;
                state.leaf =
                    Some(LeafState { file: &l.data.name, text: &l.data.text, settings: &l.settings });
            }
            Maker::Flower(f) => {
                state.maker = MakerWord::Flower;
                state.flower = Some(FlowerState {
                    preset: f.preset.as_deref(),
                    spec: &f.spec,
                    day: f.day,
                    law: f.law.as_ref().map(|l| l.name.as_str()),
                });
            }
            _ => {}
        }
        state
    }
}

/// The pen that a stroke is drawn with; a field left out is that of the default pen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PenStyle {
    /// Colour of the stroke, sRGB.
    pub color: Option<[u8; 3]>,
    /// Width in the drawing's unit, above 0.
    pub width: Option<f64>,
    /// The name of the layer.
    pub layer: Option<String>,
    /// The class of strokes that are drawn with it, if the person chose one.
    pub class: Option<StrokeClass>,
}
