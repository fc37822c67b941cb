//! Checks of the sources, which `cargo xtask layers` and `cargo xtask habits` call.

mod bare_numbers;
mod circles;
mod habits;
mod layers;
mod names;
mod skips;

use std::process::ExitCode;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match args.first().map(String::as_str) {
        Some("habits") => habits::check(),
        Some("layers") => {
            [layers::check, circles::check, names::check, skips::check].iter().try_for_each(|check| check())
        }
        _ => Err("`layers` or `habits` (see cargo xtask help)".into()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}
