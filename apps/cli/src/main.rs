//! The `burgeon` command: parse, read, call, report. No algorithms.

mod args;
mod bloom;
mod checks;
mod classes;
mod compare;
mod convert;
mod curve;
mod disk;
mod draft;
mod edits;
mod failure;
mod files;
mod fit;
mod forest;
mod grow;
mod info;
mod inputs;
mod leaf;
mod leaf_data;
mod lease;
mod lettering;
mod levels;
mod light;
mod machine;
mod manual;
mod materials;
mod memory;
mod names;
mod origin;
mod output;
mod petals;
mod picture;
mod placing;
mod plot;
mod plot_map;
mod poses;
mod presets;
mod project;
mod replay;
mod report;
mod say;
mod scan;
mod scene;
mod shape;
mod signals;
mod sketch;
mod species;
mod species_plot;
mod stages;
mod structure;
mod studio;
mod sweep;
mod table;

use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

use clap::Parser as _;
use clap::error::{ContextValue, ErrorKind};

use args::{Cli, Command};
use failure::Failure;

fn main() -> ExitCode {
    signals::listen();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(e) => return usage(&e),
    };
    // A panic is our bug: one line and status 1 instead of Rust's own text and status 101.
    std::panic::set_hook(Box::new(|info| {
        let place = info.location().map_or_else(String::new, |l| format!(" ({}:{})", l.file(), l.line()));
        let payload = info.payload();
        let what = payload.downcast_ref::<&str>().copied().map(str::to_owned);
        let what = what.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
        say::error(&format!("internal error, a bug in burgeon: {what}{place}"));
    }));
    let outcome = std::panic::catch_unwind(|| match cli.command {
        Command::Sketch(mut args) => args.settle().and_then(|()| sketch::sketch(&args)),
        Command::Leaf(mut args) => args.settle().and_then(|()| leaf::leaf(&args)),
        Command::Grow(mut args) => args.settle().and_then(|()| grow::grow(&args)),
        Command::Scan(mut args) if args.all => args.settle().and_then(|()| plot::scan_all(&args)),
        Command::Scan(mut args) => args.settle().and_then(|()| scan::scan(&args)),
        Command::Forest(args) => forest::forest(&args),
        Command::Light(args) => light::light(&args),
        Command::Shape(mut args) => args.settle().and_then(|()| shape::shape(&args)),
        Command::Replay(args) => replay::replay(&args),
        Command::Presets(args) => presets::presets(&args),
        Command::Compare(args) => compare::compare(&args),
        Command::Render(args) => picture::render(&args),
        Command::Convert(args) => convert::convert(&args),
        Command::Info(args) => info::info(&args),
        Command::Bloom(mut command) => command.settle().and_then(|()| bloom::bloom(&command)),
        Command::Species(command) => species::species(&command),
        Command::Studio(args) => studio::studio(&args),
        Command::Completions(args) => manual::completions(&args),
        Command::Man(args) => manual::man(&args),
    });
    match outcome {
        Ok(Ok(())) => match say::lost() {
            None => ExitCode::SUCCESS,
            Some(e) => Failure::io(Path::new("standard output"), "written", &e).tell(),
        },
        // Work that is stopped half-way may give other reasons.
        Ok(Err(Failure::Bad(_) | Failure::Reported)) if signals::token().check().is_err() => {
            Failure::Cancelled.tell()
        }
        Ok(Err(failure)) => failure.tell(),
        Err(_) => ExitCode::from(1),
    }
}

// Prints help and version unchanged, and bad usage as one line.
fn usage(e: &clap::Error) -> ExitCode {
    if matches!(
        e.kind(),
        ErrorKind::DisplayHelp
            | ErrorKind::DisplayVersion
            | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
    ) {
        let printed = e.print().and_then(|()| std::io::stdout().flush());
        return match printed {
            Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
                Failure::io(Path::new("standard output"), "written", &e).tell()
            }
            _ => ExitCode::from(if e.use_stderr() { 2 } else { 0 }),
        };
    }
    let mut text = e.to_string();
    for (_, value) in e.context() {
        if let ContextValue::String(value) = value {
            text = text.replace(value.as_str(), &burgeon::quoted(value));
        }
    }
    let lines = text.lines().map(str::trim);
    let lines = lines.take_while(|l| !l.starts_with("Usage:") && !l.starts_with("For more information"));
    let line = lines.filter(|l| !l.is_empty()).collect::<Vec<_>>().join(" ");
    say::error(&format!("{} (see --help)", line.trim_start_matches("error: ")));
    ExitCode::from(2)
}
