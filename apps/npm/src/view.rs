//! What JavaScript is told of a plant. `cargo xtask types` writes these types as TypeScript.

use burgeon::ItemReport;
use schemars::JsonSchema;
use serde::Serialize;

/// A plant as it was made.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PlantView {
    /// Its name in files.
    pub name: String,
    /// `tree`, `sketch`, `leaf` or `flower`.
    pub maker: &'static str,
    /// The species, where it is one that comes with the program.
    pub preset: Option<String>,
    /// The entry of the report.
    pub report: ItemReport,
    /// Bud to full bloom, and from there to wilted, days; of what opens.
    pub days: Option<[f64; 2]>,
    /// Lower corner of its bounds, metres.
    pub min: [f64; 3],
    /// Upper corner of its bounds, metres.
    pub max: [f64; 3],
    /// Levels of detail, the finest first.
    pub levels: Vec<LevelView>,
    /// Pictures; materials name them by row.
    pub textures: Vec<TextureView>,
}

/// A level of detail.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LevelView {
    /// Its meshes.
    pub parts: Vec<PartView>,
    /// What they are made of.
    pub materials: Vec<MaterialView>,
}

/// One mesh.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PartView {
    /// Its name in files.
    pub name: String,
    /// Row of its material.
    pub material: usize,
}

/// How a mesh looks.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MaterialView {
    /// Its name in files.
    pub name: String,
    /// What it is of: bark, leaf, petal, ...
    pub kind: &'static str,
    /// Linear red, green, blue.
    pub color: [f32; 3],
    /// 0 to 1.
    pub roughness: f32,
    /// 0 to 1.
    pub translucency: f32,
    /// The texture has holes.
    pub masked: bool,
    /// Seen from both sides.
    pub two_sided: bool,
    /// Row of its picture.
    pub texture: Option<usize>,
    /// Row of the normals of its relief, as glTF has them.
    pub normal: Option<usize>,
    /// Row of a picture in which red is occlusion and green is multiplied with the roughness.
    pub orm: Option<usize>,
}

/// A picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct TextureView {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
}
