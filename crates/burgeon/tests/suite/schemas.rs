//! The JSON Schemas that come with the program, made from the Rust types.
//!
//! `cargo xtask types` writes them to `crates/*/schemas`; this test fails when one is stale.

use burgeon::{bloom, growth, leaf, sketch, skin};
use serde::Serialize as _;
use serde_json::Value;
use serde_json::ser::{PrettyFormatter, Serializer};
use spec::Spec;

/// Writes one field on each line, so that changes can be read; without indents, which would be downloaded.
fn text(schema: &Value) -> String {
    let mut out = Vec::new();
    let mut to = Serializer::with_formatter(&mut out, PrettyFormatter::with_indent(b""));
    schema.serialize(&mut to).expect("plain data");
    String::from_utf8(out).expect("JSON is UTF-8") + "\n"
}

fn compare<T: Spec>(file: &str, stale: &mut Vec<String>) {
    let path = format!("{}/../{file}", env!("CARGO_MANIFEST_DIR"));
    let made = text(&spec::made_schema::<T>());
    if std::env::var_os("BURGEON_WRITE_TYPES").is_some() {
        std::fs::create_dir_all(std::path::Path::new(&path).parent().expect("a folder"))
            .expect("can be made");
        std::fs::write(&path, &made).expect("can be written");
    }
    if std::fs::read_to_string(&path).ok() != Some(made) {
        stale.push(file.to_owned());
    }
}

#[test]
fn the_schemas_that_are_kept_are_those_of_the_types() {
    let mut stale = Vec::new();
    compare::<growth::TreeSpec>("growth/schemas/tree.json", &mut stale);
    compare::<bloom::FlowerSpec>("bloom/schemas/flower.json", &mut stale);
    compare::<leaf::LeafSpec>("leaf/schemas/leaf.json", &mut stale);
    compare::<sketch::SketchSpec>("sketch/schemas/sketch.json", &mut stale);
    compare::<skin::SkinSpec>("skin/schemas/skin.json", &mut stale);
    compare::<skin::Wear>("skin/schemas/materials.json", &mut stale);
    assert!(stale.is_empty(), "stale, run `cargo xtask types`: {stale:?}");
}

/// Checks that each field, and each form where there are several, exists with the same range and meaning.
fn part<T: Spec>() {
    let made = spec::made_schema::<T>();
    let kept = T::schema().pointer(T::PART).unwrap_or_else(|| panic!("nothing at {}", T::PART));
    assert_eq!(made["oneOf"], kept["oneOf"], "{}", T::PART);
    let fields = |schema: &Value| schema["properties"].as_object().cloned().unwrap_or_default();
    let (made, mut kept) = (fields(&made), fields(kept));
    kept.remove("kind");
    assert_eq!(made, kept, "{}", T::PART);
    assert!(
        !made.is_empty() || T::schema().pointer(T::PART).is_some_and(|p| p["oneOf"].is_array()),
        "{}",
        T::PART
    );
}

#[test]
fn parts_have_the_schemas_of_their_types() {
    part::<skin::OrganMaterial>();
    part::<growth::Arrangement>();
    part::<growth::ColonizeSpec>();
    part::<growth::CompetitionSpec>();
    part::<growth::Envelope>();
    part::<growth::FoliageSpec>();
    part::<growth::GuidedSpec>();
    part::<growth::Obstacle>();
    part::<growth::SelfOrganizingSpec>();
    part::<growth::Tropism>();
    part::<growth::WoodSpec>();
}
