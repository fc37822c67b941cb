//! The laboratory: training and measurement of the reading of drawings, and the pictures of the docs. `cargo xtask
//! help` describes each command, and `cargo xtask COMMAND` runs it.

mod ablation;
mod adam;
mod contact_sheet;
mod flowers;
mod gallery;
mod in_all_styles;
mod made_drawings;
mod made_strokes;
mod pixels;
mod quickdraw;
mod read_drawings;
mod read_in_turn;
mod scenes;
mod sheets;
mod species;
mod train_confidence;
mod train_glance;
mod train_kinds;
mod train_no_plants;
mod train_strokes;
mod workshop;
mod written;

use std::process::ExitCode;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let rest = args.get(1..).unwrap_or_default();
    let outcome = match args.first().map(String::as_str) {
        Some("gallery") => gallery::run(),
        Some("species") => species::run(rest),
        Some("sheets") => sheets::run(rest),
        Some("flowers") => flowers::run(),
        Some("train-kinds") => train_kinds::run(rest),
        Some("train-glance") => train_glance::run(rest),
        Some("train-no-plants") => train_no_plants::run(rest),
        Some("train-confidence") => train_confidence::run(rest),
        Some("train-strokes") => train_strokes::run(rest),
        Some("read-drawings") => read_drawings::run(rest),
        Some("read-in-turn") => read_in_turn::run(rest),
        _ => Err("no such command of the laboratory (see cargo xtask help)".into()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}
