//! The plants as a shell shows them: figures and names. Meshes are columns, fetched one by one.

use std::collections::BTreeMap;
use std::sync::Arc;

use burgeon::document::{Command, Document, Maker, PlantId, SketchCommand, TreeCommand};
use burgeon::mesh::{AlphaMode, Model, Texture, TriMesh};
use burgeon::skin::SkinSpec;
use burgeon::{FrontView, ItemReport, Refusal, SceneError, Warning, set_of};
use schemars::JsonSchema;
use serde::Serialize;

use crate::ObstacleView;

/// Share of the triangles that a preview has while a stroke is drawn.
pub(crate) const PREVIEW_DETAIL: f64 = 0.4;

/// Number in a [`crate::PlantView`] of a model that is not a plant of the document: a model file, another seed.
pub const GUEST: PlantId = PlantId(u32::MAX);

/// A column of vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Three floats a vertex, metres.
    Positions,
    /// Three floats a vertex.
    Normals,
    /// Two floats a vertex, v down; may be empty.
    Uvs,
    /// Three floats a vertex, linear; may be empty.
    Colors,
    /// Four floats a vertex, each 0 to 1: sway of the plant, sway of the limb, flutter, phase; usually empty.
    Wind,
    /// Three floats a vertex, metres: the point about which wind turns it; usually empty.
    Pivots,
}

impl Column {
    pub(crate) fn values(self, mesh: &TriMesh) -> &[f32] {
        match self {
            Self::Positions => mesh.positions.as_flattened(),
            Self::Normals => mesh.normals.as_flattened(),
            Self::Uvs => mesh.uvs.as_flattened(),
            Self::Colors => mesh.colors.as_flattened(),
            Self::Wind => mesh.wind.as_flattened(),
            Self::Pivots => mesh.pivots.as_flattened(),
        }
    }
}

/// Every plant of a scene, as it was made last.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SceneView {
    /// Revision of the document at the evaluation.
    pub revision: u64,
    /// A model that is shown instead.
    pub guest: Option<PlantView>,
    /// Views in the document's order.
    pub plants: Vec<PlantView>,
}

/// A plant as it is seen.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PlantView {
    /// Its name within the document, or [`GUEST`].
    pub id: PlantId,
    /// Whether its meshes differ from those of the last view.
    pub fresh: bool,
    /// Name of its meshes: plants with the same meshes share it. None for a preview.
    pub mesh: Option<u64>,
    /// Reason why it could not be made; earlier results stay.
    pub error: Option<Refusal>,
    /// The entry of the report.
    pub item: Option<ItemReport>,
    /// Warnings about it.
    pub warnings: Vec<WarningView>,
    /// Stages that were computed again.
    pub stages: Vec<&'static str>,
    /// Placement of a drawing in the front view.
    pub front: Option<Front>,
    /// Days from bud to full bloom, and from there to wilted.
    pub days: Option<[f64; 2]>,
    /// Lower corner of its bounds, metres.
    pub min: [f64; 3],
    /// Upper corner of its bounds, metres.
    pub max: [f64; 3],
    /// Its meshes.
    pub parts: Vec<PartView>,
    /// Materials of the meshes.
    pub materials: Vec<MaterialView>,
    /// Obstacles that it grows around.
    pub obstacles: Vec<ObstacleView>,
}

/// Placement of a drawing in the front view of its plant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Front {
    /// Metres for each unit of the drawing.
    pub metres_per_unit: f64,
    /// Position of the plant's origin in the drawing, along x.
    pub x: f64,
    /// Position of the plant's origin in the drawing, along y, up.
    pub y: f64,
}

impl From<FrontView> for Front {
    fn from(front: FrontView) -> Self {
        Self { metres_per_unit: front.metres_per_unit, x: front.origin.x, y: front.origin.y }
    }
}

/// A warning.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct WarningView {
    /// A stable word, such as `unlike-a-plant`.
    pub code: &'static str,
    /// A sentence in English.
    pub message: String,
    /// Numbers and names in it.
    pub fields: BTreeMap<&'static str, String>,
}

impl From<&Warning> for WarningView {
    fn from(warning: &Warning) -> Self {
        let Warning { code, message, fields } = warning;
        let mut warning = Self { code, message: message.clone(), fields: BTreeMap::new() };
        warning.fields.extend(fields.iter().cloned());
        warning
    }
}

/// One mesh.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PartView {
    /// Its name in files.
    pub name: String,
    /// Row of its material.
    pub material: usize,
}

/// Appearance of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MaterialView {
    /// Its name in files.
    pub name: String,
    /// Kind of its organs: bark, leaf, petal, ...
    pub kind: &'static str,
    /// Linear red, green, blue.
    pub color: [f32; 3],
    /// Roughness, 0 to 1.
    pub roughness: f32,
    /// Translucency, 0 to 1.
    pub translucency: f32,
    /// Whether the texture has holes.
    pub masked: bool,
    /// Whether it is visible from both sides.
    pub two_sided: bool,
    /// Its picture.
    pub texture: Option<TextureView>,
    /// Normals of its relief, as glTF has them.
    pub normal: Option<TextureView>,
    /// Red is occlusion; green is multiplied with the roughness.
    pub orm: Option<TextureView>,
}

impl MaterialView {
    fn pictures(&self) -> impl Iterator<Item = TextureView> {
        [self.texture, self.normal, self.orm].into_iter().flatten()
    }
}

/// A picture by its number: its pixels are fetched once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct TextureView {
    /// Its number for [`crate::Workspace::texture`], never reused for another picture.
    pub number: u32,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
}

/// Pictures with the numbers by which shells refer to them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Textures {
    rows: Vec<(u32, Arc<Texture>)>,
    next: u32,
}

impl Textures {
    pub(crate) fn get(&self, number: u32) -> Option<&Texture> {
        self.rows.iter().find(|(n, _)| *n == number).map(|(_, t)| &**t)
    }

    /// Drops all but those of these views.
    pub(crate) fn keep<'a>(&mut self, views: impl Iterator<Item = &'a PlantView>) {
        let seen = views.flat_map(|v| &v.materials).flat_map(MaterialView::pictures).map(|t| t.number);
        let seen = set_of(seen);
        self.rows.retain(|(number, _)| seen.contains_key(number));
    }

    fn view(&mut self, texture: &Arc<Texture>) -> TextureView {
        TextureView { number: self.number_of(texture), width: texture.width, height: texture.height }
    }

    fn number_of(&mut self, texture: &Arc<Texture>) -> u32 {
        let same = |t: &Arc<Texture>| Arc::ptr_eq(t, texture) || t == texture;
        if let Some((number, _)) = self.rows.iter().find(|(_, t)| same(t)) {
            return *number;
        }
        let number = self.next;
        self.next = self.next.wrapping_add(1);
        self.rows.push((number, Arc::clone(texture)));
        number
    }
}

impl PlantView {
    pub(crate) fn empty(id: PlantId) -> Self {
        Self {
            id,
            fresh: true,
            mesh: None,
            error: None,
            item: None,
            warnings: Vec::new(),
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

    pub(crate) fn from_model(id: PlantId, model: &Model, textures: &mut Textures) -> Self {
        let mut view = Self::empty(id);
        let bounds = model.bounds();
        if !bounds.is_empty() {
            (view.min, view.max) = (bounds.min.to_array(), bounds.max.to_array());
        }
        let parts = model.parts.iter();
        view.parts = parts.map(|p| PartView { name: p.name.clone(), material: p.material.index() }).collect();
        let materials = model.materials.iter().map(|m| MaterialView {
            name: m.name.clone(),
            kind: m.kind.word(),
            color: m.base_color,
            roughness: m.roughness,
            translucency: m.translucency,
            masked: m.alpha == AlphaMode::Mask,
            two_sided: m.double_sided,
            texture: m.texture.as_ref().map(|t| textures.view(t)),
            normal: m.maps.normal.as_ref().map(|t| textures.view(t)),
            orm: m.maps.orm.as_ref().map(|t| textures.view(t)),
        });
        view.materials = materials.collect();
        view
    }
}

/// Outcome of making a plant.
#[derive(Debug)]
pub(crate) enum Outcome {
    Made,
    /// There is nothing to make it of yet.
    Bare,
    Failed(SceneError),
}

/// Returns the command that makes a plant's mesh coarser by a factor.
pub(crate) fn coarser(document: &Document, id: PlantId, factor: f64) -> Option<Command> {
    let coarse = |skin: &SkinSpec| {
        let detail = (skin.detail * factor).clamp(0.1, 8.0);
        SkinSpec { detail, ..skin.clone() }
    };
    match &document.plant(id)?.settings().maker {
        Maker::Sketch(s) => Some(SketchCommand::SetSkin(coarse(&s.skin)).for_plant(id)),
        Maker::Tree(t) => Some(TreeCommand::SetSkin(coarse(&t.skin)).for_plant(id)),
        _ => None,
    }
}
