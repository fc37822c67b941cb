//! Colours and fineness of measured leaves, and plants of them.

use std::sync::Arc;

use base::{Run, Seed};
use leaf::{Leaf, LeafPaint, LeafSpec};
use mesh::Texture;
use plant::{Frame, NodeId, Organ, OrganKind, Paint, Plant, Shape, ShapeId, SplineBlade};
use skin::{LeafColours, LeafMeshSpec};

/// Settings of measured leaves that decide on their colours and the fineness of their meshes.
#[derive(Clone, Copy, Debug)]
pub struct LeafLook<'a> {
    /// Surface, veins, resolution, wilt, colour.
    pub spec: &'a LeafSpec,
    /// A picture of the pressed leaf that replaces the spec's colour, cropped to its box, tip at the top.
    pub picture: Option<&'a Arc<Texture>>,
}

/// A plant of measured leaves, before it is meshed.
#[derive(Clone, Debug, Default)]
pub struct LeafyPlant {
    /// The plant.
    pub plant: Plant,
    /// Pictures of the forms of its leaves; `None` for a form in plain colours.
    pub textures: Vec<Option<Arc<Texture>>>,
}

/// Advice for a leaf with too many triangles.
pub(crate) const COARSER: &str = "lower subdivisions or sides, or make fewer leaves";

impl LeafLook<'_> {
    /// Returns the fineness of the meshes of blade and veins.
    pub fn mesh(self) -> LeafMeshSpec {
        let LeafSpec { rings, subdivisions, sides, caps, margin_vein, .. } = *self.spec;
        LeafMeshSpec {
            subdivisions: subdivisions as usize,
            sides: sides as usize,
            rings,
            caps,
            margin: margin_vein,
        }
    }

    /// Returns the paint of a leaf that is lighter or darker by `tint`: a texture keeps its colours, else it has one
    /// colour.
    pub fn paint(self, tint: [f32; 3]) -> Paint {
        if self.picture.is_some() || self.spec.texture == LeafPaint::Veins {
            return Paint::Natural(tint);
        }
        let plain = base::linear_color(LeafColours::default().wilted(self.spec.wilt).blade);
        Paint::Tinted([0, 1, 2].map(|k| plain[k] * tint[k]))
    }

    /// Returns the picture of a leaf: the pressed leaf, or its veins as they are painted; `None` for a plain colour.
    pub(crate) fn texture(self, leaf: &Leaf, seed: Seed, run: &Run<'_>) -> Option<Arc<Texture>> {
        if let Some(picture) = self.picture {
            return Some(Arc::clone(picture));
        }
        (self.spec.texture == LeafPaint::Veins).then(|| {
            let colours = LeafColours::default().wilted(self.spec.wilt);
            let flat = leaf.blade().flat(self.spec.subdivisions as usize);
            Arc::new(skin::vein_texture(&flat, &colours, 768, seed, run.executor))
        })
    }
}

impl LeafyPlant {
    /// Makes a plant of a name, without parts.
    pub(crate) fn named(name: &str) -> Self {
        Self { plant: Plant { name: name.into(), ..Plant::default() }, textures: Vec::new() }
    }
}

/// Adds a leaf that was measured in the plant's coordinates; its frame is that of its root and tip.
pub(crate) fn bear(plant: &mut Plant, blade: SplineBlade, bearer: Option<NodeId>, paint: Paint, key: u64) {
    let (blade, frame) = blade.framed();
    let shape = plant.add_shape(Shape::Spline(Arc::new(blade)));
    add_leaf(plant, shape, frame, bearer, paint, key);
}

/// Adds a leaf of a shape that the plant has.
pub(crate) fn add_leaf(
    plant: &mut Plant,
    shape: ShapeId,
    frame: Frame,
    bearer: Option<NodeId>,
    paint: Paint,
    key: u64,
) {
    let (kind, flower, source) = (OrganKind::Leaf, None, None);
    plant.organs.push(Organ { kind, bearer, flower, shape, frame, scale: 1.0, paint, key, source });
}
