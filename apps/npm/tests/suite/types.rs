//! The TypeScript types of the npm package, made from the Rust types and from the schemas of specs.
//!
//! `cargo xtask types` writes them to `apps/npm/lib`; this test fails when they are stale.

use crate::typescript;
use std::fmt::Write as _;

use burgeon::Refusal;
use burgeon_npm::{FlowerAsked, LeafAsked, PlantView, SketchAsked, TreeAsked};
use schemars::JsonSchema;
use schemars::generate::{SchemaGenerator, SchemaSettings};
use serde_json::{Map, Value};

const HEAD: &str = "\
// Made by `cargo xtask types` from the types of the crate. Change those instead.

/** What has no type of its own here. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
";

fn check(file: &str, made: &str) {
    let path = format!("{}/lib/{file}", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("BURGEON_WRITE_TYPES").is_some() {
        std::fs::write(&path, made).expect("strings take all");
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    let differs = made.lines().zip(kept.lines()).find(|(a, b)| a != b);
    assert!(made == kept, "{file} is stale, run `cargo xtask types`; first {differs:?}");
}

#[test]
fn what_travels_has_the_types_of_the_core() {
    let mut all = SchemaSettings::draft2020_12().for_serialize().into_generator();
    fn add<T: JsonSchema>(all: &mut SchemaGenerator) {
        all.subschema_for::<T>();
    }
    add::<PlantView>(&mut all);
    add::<Refusal>(&mut all);
    // Fields of a request may be left out.
    let mut asked = SchemaSettings::draft2020_12().for_deserialize().into_generator();
    add::<TreeAsked>(&mut asked);
    add::<SketchAsked>(&mut asked);
    add::<LeafAsked>(&mut asked);
    add::<FlowerAsked>(&mut asked);
    let mut out = HEAD.to_owned();
    typescript::declare(&mut out, &all.take_definitions(true));
    typescript::declare(&mut out, &asked.take_definitions(true));
    check("wire.ts", &out);
}

/// Adds the schema of a spec, under the name of its type.
fn named(all: &mut Map<String, Value>, name: &str, schema: &Value) {
    let mut schema = schema.clone();
    let parts = schema.as_object_mut().and_then(|s| s.remove("$defs"));
    let parts = parts.as_ref().and_then(Value::as_object).cloned().unwrap_or_default();
    for (part, schema) in parts.into_iter().chain([(name.to_owned(), schema)]) {
        if let Some(before) = all.insert(part.clone(), schema.clone()) {
            assert_eq!(before, schema, "{part} is the name of two types");
        }
    }
}

#[test]
fn specs_have_the_types_of_their_schemas() {
    let mut all = Map::new();
    named(&mut all, "TreeSpec", burgeon::tree_schema());
    named(&mut all, "SketchSpec", burgeon::sketch_schema());
    named(&mut all, "LeafSpec", burgeon::leaf_schema());
    named(&mut all, "FlowerSpec", burgeon::flower_schema());
    named(&mut all, "SkinSpec", burgeon::skin_schema());
    let mut out = HEAD.to_owned();
    let mut words = |name: &str, doc: &str, keys: &[&str]| {
        let keys: Vec<String> = keys.iter().map(|k| format!("  '{k}',\n")).collect();
        write!(out, "\n/** {doc} */\nexport const {name} = [\n{}] as const;\n", keys.concat())
            .expect("strings take all");
    };
    let trees: Vec<&str> = burgeon::PRESETS.iter().map(|p| p.key).collect();
    words("TREES", "The species of trees.", &trees);
    words("FLOWERS", "The species of flowers.", burgeon::bloom::FlowerSpec::PRESETS);
    words("PARTS", "The parts of plants, by the numbers in tables.", &burgeon::PARTS);
    typescript::declare(&mut out, &all);
    check("spec.ts", &out);
}
