//! TypeScript types of the messages between a page and a workspace, made from the Rust types.
//!
//! `cargo xtask types` writes them to `apps/studio-web/src/wire.ts`; this test fails when that file is stale.

use crate::typescript;
use std::fmt::Write as _;

use burgeon::document::Command;
use burgeon::formats::{DrawingFormat, FormatRow, ModelFormat, StructureFormat};
use burgeon::shape::ToolKind;
use burgeon::skin::OrganMaterial;
use burgeon::{Coded, Engine, LeafBalls, Refusal};
use schemars::JsonSchema;
use schemars::generate::{SchemaGenerator, SchemaSettings};
use workspace::{
    Action, DocumentState, EngineAnswer, EngineAsk, ExportRequest, ExportView, GestureRecord, LightAsk,
    LightView, Opened, PenStyle, PrintFigures, SceneView, ShapeAnswer, ShapeInput, ShapeReach, SizeGoal,
    WorkspaceError, WrittenFigures,
};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../apps/studio-web/src/wire.ts");

const HEAD: &str = "\
// Made by `cargo xtask types` from the types of the crate `workspace`. Change those instead.

/** What has no type of its own here: the page passes it on. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
";

#[test]
fn the_types_of_the_page_are_those_of_the_workspace() {
    let made = types();
    if std::env::var_os("BURGEON_WRITE_TYPES").is_some() {
        std::fs::write(FILE, &made).expect("strings take all");
    }
    let kept = std::fs::read_to_string(FILE).unwrap_or_default();
    let differs = made.lines().zip(kept.lines()).find(|(a, b)| a != b);
    assert!(made == kept, "stale, run `cargo xtask types`; first {differs:?}");
}

/// Writes the formats that are written, as the page lists them.
fn formats(out: &mut String) {
    let models = ModelFormat::ALL.into_iter().map(|f| ("model", f.row()));
    let structures = StructureFormat::ALL.into_iter().map(|f| ("structure", f.row()));
    let drawings = DrawingFormat::ALL.into_iter().map(|f| ("drawing", f.row()));
    *out += "\n/** The formats that are written, by their words. */\nexport const FORMATS = {\n";
    for (kind, row) in models.chain(structures).chain(drawings).filter(|(_, row)| row.is_written()) {
        let FormatRow { word, media_type, about, .. } = row;
        let (ending, zipped) = (row.endings[0], !row.beside.is_empty());
        let holds: Vec<&str> = row.holds.iter().map(|room| room.word()).collect();
        writeln!(
            out,
            "  {word}: {{\n    kind: {kind:?},\n    ending: {ending:?},\n    type: {media_type:?},\n    about: {about:?},\n    \
             holds: {holds:?},\n    zipped: {zipped},\n  }},"
        )
        .expect("strings take all");
    }
    *out += "} as const;\n";
}

/// Writes the programs that plants go to, as the page lists them.
fn engines(out: &mut String) {
    *out += "\n/** The programs that plants go to, by their words. */\nexport const ENGINES = {\n";
    for engine in Engine::ALL {
        let (word, about, endings) = (engine.word(), engine.about(), engine.endings());
        writeln!(out, "  {word}: {{ about: {about:?}, endings: {endings:?} }},").expect("strings take all");
    }
    *out += "} as const;\n";
}

fn types() -> String {
    // Types as the core writes them: every field is present.
    let mut all = SchemaSettings::draft2020_12().for_serialize().into_generator();
    fn add<T: JsonSchema>(all: &mut SchemaGenerator) {
        all.subschema_for::<T>();
    }
    add::<Command>(&mut all);
    add::<Action>(&mut all);
    add::<DocumentState<'_>>(&mut all);
    add::<SceneView>(&mut all);
    add::<Opened>(&mut all);
    add::<ExportRequest>(&mut all);
    add::<EngineAsk>(&mut all);
    add::<EngineAnswer>(&mut all);
    add::<PrintFigures>(&mut all);
    add::<WrittenFigures>(&mut all);
    add::<SizeGoal>(&mut all);
    add::<LightAsk>(&mut all);
    add::<LightView>(&mut all);
    add::<PenStyle>(&mut all);
    add::<OrganMaterial>(&mut all);
    add::<ExportView>(&mut all);
    add::<ToolKind>(&mut all);
    add::<ShapeReach>(&mut all);
    add::<ShapeInput>(&mut all);
    add::<ShapeAnswer>(&mut all);
    add::<LeafBalls>(&mut all);
    add::<GestureRecord>(&mut all);
    add::<Refusal>(&mut all);
    let mut out = HEAD.to_owned();
    let mut codes = Vec::new();
    WorkspaceError::codes(&mut codes);
    codes.sort_unstable();
    codes.dedup();
    out += "\n/** Every code of a `Refusal`, with its fields. */\nexport const CODES = {\n";
    for (code, fields) in codes {
        writeln!(out, "  {code:?}: {fields:?},").expect("strings take all");
    }
    out += "} as const;\n";
    formats(&mut out);
    engines(&mut out);
    typescript::declare(&mut out, &all.take_definitions(true));
    out
}
