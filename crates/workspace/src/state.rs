//! What a shell shows of the document: everything but points, meshes and pictures.

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
    /// The plants in the order in which they came in.
    pub plants: Vec<PlantState<'a>>,
    /// The numbers that they go by.
    pub numbers: PlantNumbers,
}

impl<'a> DocumentState<'a> {
    pub(crate) fn of(editor: &'a Editor, current: Option<PlantId>) -> Self {
        let document = editor.document();
        Self {
            revision: editor.revision(),
            undo: editor.done().last().map(|s| s.name.as_str()),
            redo: editor.undone().last().map(|s| s.name.as_str()),
            steps: editor.done().len(),
            name: document.name(),
            current,
            plants: document.plants().iter().map(|p| PlantState::of(p, document)).collect(),
            numbers: document.numbers(),
        }
    }
}

/// One plant; of `sketch`, `tree`, `leaf` and `flower` that of its maker is there.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PlantState<'a> {
    /// Its name within the document.
    pub id: PlantId,
    /// Its maker.
    pub maker: MakerWord,
    /// Its name.
    pub name: &'a str,
    /// As text: JavaScript's numbers hold 53 bits.
    pub seed: String,
    /// Dice leave its seed alone.
    pub locked: bool,
    /// Whether it stays where it stands.
    pub fixed: bool,
    /// It is left out of the view.
    pub hidden: bool,
    /// The group it belongs to; empty for none.
    pub group: &'a str,
    /// Metres.
    pub position: [f64; 3],
    /// Turn about +Y, degrees.
    pub yaw_deg: f64,
    /// Size.
    pub scale: f64,
    /// Whether others may bear its leaf.
    pub lends: bool,
    /// The materials of its leaves, petals and sepals.
    pub wear: WearState<'a>,
    /// Edits by hand, in the order in which they are done.
    pub edits: Vec<EditState>,
    /// Of a drawing.
    pub sketch: Option<SketchState<'a>>,
    /// Of a tree.
    pub tree: Option<TreeState<'a>>,
    /// Of a measured leaf.
    pub leaf: Option<LeafState<'a>>,
    /// Of a flower.
    pub flower: Option<FlowerState<'a>>,
}

/// The materials that a person gave to kinds of organs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct WearState<'a> {
    /// Of all leaves.
    pub leaf: Option<&'a OrganMaterial>,
    /// Of all petals.
    pub petal: Option<&'a OrganMaterial>,
    /// Of all sepals and bracts.
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

/// What kind of edit by hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct EditState {
    /// The word of [`burgeon::shape::HandEdit`].
    pub op: &'static str,
    /// Left out for now.
    pub off: bool,
}

/// A drawing without its points.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SketchState<'a> {
    /// How it is understood.
    pub sketch: &'a SketchSpec,
    /// How it is meshed.
    pub skin: &'a SkinSpec,
    /// Its strokes in the order in which they were drawn.
    pub strokes: Vec<StrokeState<'a>>,
    /// Its layers from below upwards.
    pub layers: &'a [Layer],
    /// What lies under it.
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
    /// In which mode it was drawn.
    pub mode: StrokeMode,
    /// The class that the person set.
    pub class: Option<StrokeClass>,
    /// What it was shown as, clearly, when the last stroke was drawn.
    pub shown: Option<StrokeClass>,
    /// Its own colour.
    pub color: Option<[u8; 3]>,
    /// Its own width, in the drawing's unit.
    pub width: Option<f64>,
    /// The name of its layer; none for the sheet itself.
    pub layer: Option<&'a str>,
    /// Its own material.
    pub material: Option<&'a OrganMaterial>,
}

/// How a photograph lies, and its size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PhotoState {
    /// As it was asked for.
    pub place: PhotoPlace,
    /// Height in the drawing's unit: it follows from the picture.
    pub height: f64,
    /// Pixels across and down.
    pub pixels: (u32, u32),
}

/// What a tree is grown from.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct TreeState<'a> {
    /// The species that the spec came from.
    pub preset: Option<&'a str>,
    /// The spec, without obstacles.
    #[schemars(with = "std::collections::BTreeMap<String, Value>")]
    #[serde(serialize_with = "spec::through_json::serialize")]
    pub spec: &'a TreeSpec,
    /// How it is meshed.
    pub skin: &'a SkinSpec,
    /// The plant whose leaf it bears.
    pub leaf: Option<PlantId>,
    /// What it grows around.
    pub obstacles: Vec<NamedShape<'a>>,
}

/// An obstacle with its name.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct NamedShape<'a> {
    /// For lists.
    pub name: &'a str,
    /// The solid.
    pub shape: ObstacleView,
}

/// An obstacle to be shown: a mesh is told by its size only, its corners are asked for.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ObstacleView {
    /// Any but a mesh.
    Shape(Obstacle),
    /// A mesh.
    Mesh {
        /// Always `mesh`.
        shape: &'static str,
        /// How many it has.
        triangles: usize,
    },
}

impl ObstacleView {
    pub(crate) fn of(shape: &Obstacle) -> Self {
        match shape {
            Obstacle::Mesh { triangles, .. } => Self::Mesh { shape: "mesh", triangles: triangles.len() },
            other => Self::Shape(other.clone()),
        }
    }
}

/// What a leaf is made of.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LeafState<'a> {
    /// Name of the file of marks or veins.
    pub file: &'a str,
    /// Its text.
    pub text: &'a str,
    /// How the leaf is made of it.
    pub settings: &'a burgeon::leaf::LeafSpec,
}

/// Which flower, on which day.
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
    fn of(plant: &'a DocumentPlant, document: &Document) -> Self {
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
                let obstacles =
                    obstacles.map(|o| NamedShape { name: &o.name, shape: ObstacleView::of(&o.shape) });
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

/// The pen that a stroke is drawn with; what is left out is that of every sheet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PenStyle {
    /// The colour of what is drawn, sRGB.
    pub color: Option<[u8; 3]>,
    /// In the drawing's unit, above 0.
    pub width: Option<f64>,
    /// The name of the layer.
    pub layer: Option<String>,
}
