//! The tables of formats in the docs, made from the table of formats.
//!
//! `cargo xtask types` writes them; this test fails when one is stale.

use std::fmt::Write as _;

use formats::{Beside, FormatRow, ModelFormat, RobotFormat, Room, StructureFormat};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/exports.md");
/// The lines between which the table of models lies.
const MODELS: [&str; 2] = ["<!-- formats of models: cargo xtask types -->", "<!-- end -->"];

#[test]
fn the_table_of_the_docs_is_that_of_the_core() {
    let page = std::fs::read_to_string(FILE).expect("a page");
    let from = page.find(MODELS[0]).expect("a first line") + MODELS[0].len();
    let to = from + page[from..].find(MODELS[1]).expect("a last line");
    let made = format!("{}\n{}{}", &page[..from], table(), &page[to..]);
    if std::env::var_os("BURGEON_WRITE_TYPES").is_some() {
        std::fs::write(FILE, &made).expect("written");
    }
    let kept = std::fs::read_to_string(FILE).unwrap_or_default();
    assert!(made == kept, "stale, run `cargo xtask types`");
}

fn table() -> String {
    let mut out = "| extension | holds | axes and unit | wind | instances, levels, joints | Burgeon |\n\
                   |---|---|---|---|---|---|\n"
        .to_owned();
    let models = ModelFormat::ALL.into_iter().map(ModelFormat::row);
    let structures = StructureFormat::ALL.into_iter().map(StructureFormat::row);
    let robots = RobotFormat::ALL.into_iter().map(RobotFormat::row);
    for row in models.chain(structures).chain(robots) {
        line(&mut out, row);
    }
    out
}

fn line(out: &mut String, row: &FormatRow) {
    let yes = |rooms: &[Room]| if rooms.iter().all(|room| row.holds.contains(room)) { "yes" } else { "–" };
    let is_robot = RobotFormat::ALL.into_iter().any(|format| format.row() == row);
    let fixed = if is_robot { "metres, +Z up" } else { "metres, +Y up" };
    let axes = if row.holds.contains(&Room::Axes) { "`--up`, `--unit`" } else { fixed };
    let access = match (row.is_read(), row.is_written()) {
        (true, true) => "reads and writes it",
        (true, false) => "reads it",
        _ => "writes it",
    };
    let endings: Vec<String> = row.endings.iter().map(|ending| format!("`.{ending}`")).collect();
    let beside: Vec<String> = row.beside.iter().map(|what| companion_names(*what)).collect();
    let beside = if beside.is_empty() { String::new() } else { format!(" ({})", beside.join(", ")) };
    let many = yes(&[Room::Instances, Room::Levels, Room::Joints]);
    writeln!(
        out,
        "| {} | {}{beside} | {axes} | {} | {many} | {access} |",
        endings.join(", "),
        row.about,
        yes(&[Room::Wind])
    )
    .expect("strings take all");
}

/// The names of the files beside one of the stem `NAME`.
fn companion_names(what: Beside) -> String {
    match (what, what.ending()) {
        (_, Some(ending)) => format!("`NAME.{ending}`"),
        (Beside::Meshes, None) => "`NAME-BODY_PART.stl`".to_owned(),
        (_, None) => "`NAME-MATERIAL.png`".to_owned(),
    }
}
