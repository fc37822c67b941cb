//! `burgeon completions` and `burgeon man`: descriptions of the command for shells and `man`.

use std::path::Path;

use burgeon::formats::WriteError;
use clap::CommandFactory as _;

use crate::args::{Cli, CompletionsArgs, ManArgs};
use crate::failure::{Failure, Outcome};
use crate::output::Outputs;
use crate::say;

pub(crate) fn completions(args: &CompletionsArgs) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "burgeon", &mut script);
    let text = String::from_utf8_lossy(&script);
    say::data(text.trim_end()).map_err(|e| Failure::io(Path::new("standard output"), "written", &e))
}

pub(crate) fn man(args: &ManArgs) -> Outcome {
    let mut outputs = Outputs::default();
    outputs.folder(&args.folder)?;
    let mut command = Cli::command();
    command.build();
    let count = pages(&command, "burgeon", &args.folder, &mut outputs)?;
    outputs.place()?;
    say::line(&format!("{}: {}", args.folder.display(), say::counted(count, "page", "pages")));
    Ok(())
}

/// Writes the page of a command and those of the commands below it, `burgeon-bloom-fit.1`; returns their number.
fn pages(command: &clap::Command, name: &str, folder: &Path, outputs: &mut Outputs) -> Outcome<u64> {
    // A name of several words is one word on its page, as with git.
    let named: &'static str = String::leak(name.to_owned());
    let page = clap_mangen::Man::new(command.clone().name(named)).section("1").source(burgeon::VERSION);
    let path = folder.join(format!("{name}.1"));
    outputs.write("FOLDER", &path, |mut out| page.render(&mut out).map_err(WriteError::from))?;
    let below = command.get_subcommands().filter(|c| !c.is_hide_set() && c.get_name() != "help");
    below
        .map(|c| pages(c, &format!("{name}-{}", c.get_name()), folder, outputs))
        .try_fold(1, |sum, n| Ok(sum + n?))
}
