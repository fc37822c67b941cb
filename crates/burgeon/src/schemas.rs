//! JSON Schemas of settings, for programs that make panels of them.

use bloom::FlowerSpec;
use leaf::LeafSpec;
use sketch::SketchSpec;
use skin::{OrganMaterial, SkinSpec};
use spec::Spec;

/// Returns the JSON Schema of the settings of a measured leaf.
pub fn leaf_schema() -> &'static serde_json::Value {
    LeafSpec::schema()
}

/// Returns the JSON Schema of the settings of a drawing.
pub fn sketch_schema() -> &'static serde_json::Value {
    SketchSpec::schema()
}

/// Returns the JSON Schema of the settings of a plant's surface.
pub fn skin_schema() -> &'static serde_json::Value {
    SkinSpec::schema()
}

/// Returns the JSON Schema of a material of leaves, petals or sepals.
pub fn material_schema() -> &'static serde_json::Value {
    static PART: std::sync::OnceLock<serde_json::Value> = std::sync::OnceLock::new();
    PART.get_or_init(|| {
        // Its references point into the schema of a file of materials.
        let mut part = OrganMaterial::schema().pointer(OrganMaterial::PART).cloned().unwrap_or_default();
        part["$defs"] = OrganMaterial::schema()["$defs"].clone();
        if let Some(parts) = part["$defs"].as_object_mut() {
            parts.retain(|name, _| name != "OrganMaterial" && name != "StrokeWear");
        }
        part
    })
}

/// Returns the JSON Schema of the settings of a flower.
///
/// ```
/// assert_eq!(burgeon::flower_schema()["properties"]["opening_days"]["x-unit"], "d");
/// ```
pub fn flower_schema() -> &'static serde_json::Value {
    FlowerSpec::schema()
}
