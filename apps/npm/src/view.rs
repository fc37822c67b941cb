//! Description of a plant for JavaScript. `cargo xtask types` writes these types as TypeScript.

use burgeon::{EngineReport, ItemReport};
use schemars::JsonSchema;
use serde::Serialize;

/// A made plant.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PlantView {
    /// Its name in files.
    pub name: String,
    /// `tree`, `sketch`, `leaf` or `flower`.
    pub maker: &'static str,
    /// The species, if it comes with the program.
    pub preset: Option<String>,
    /// The entry of the report.
    pub report: ItemReport,
    /// The program that its files are for, and what was set for it.
    #[serde(rename = "for")]
    pub engine: Option<EngineReport>,
    /// Bud to full bloom, and from there to wilted, days; of what opens.
    pub days: Option<[f64; 2]>,
    /// Lower corner of its bounds, metres.
    pub min: [f64; 3],
    /// Upper corner of its bounds, metres.
    pub max: [f64; 3],
    /// Levels of detail, the finest first.
    pub levels: Vec<LevelView>,
    /// Pictures, to which materials refer by row.
    pub textures: Vec<TextureView>,
}

/// A level of detail.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LevelView {
    /// Its meshes.
    pub parts: Vec<PartView>,
    /// Their materials.
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

/// Appearance of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MaterialView {
    /// Its name in files.
    pub name: String,
    /// Kind of surface: bark, leaf, petal, ...
    pub kind: &'static str,
    /// Base colour: linear red, green, blue.
    pub color: [f32; 3],
    /// Roughness, 0 to 1.
    pub roughness: f32,
    /// Share of light that passes through, 0 to 1.
    pub translucency: f32,
    /// The texture has holes.
    pub masked: bool,
    /// Visible from both sides.
    pub two_sided: bool,
    /// Row of its colour texture.
    pub texture: Option<usize>,
    /// Row of the normals of its relief, in the form of glTF.
    pub normal: Option<usize>,
    /// Row of a picture in which red is occlusion and green is a factor of the roughness.
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
