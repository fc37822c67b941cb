//! Chores: see `cargo xtask`.

mod made_strokes;
mod train_strokes;

use std::process::ExitCode;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let done = match args.split_first() {
        Some((task, rest)) if task == "train-strokes" => train_strokes::run(rest),
        _ => Err("usage: cargo xtask train-strokes [--measure <sketches folder>]".to_owned()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
