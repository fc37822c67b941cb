//! Output of the report, and the summary for people.

use std::path::Path;

use burgeon::{ItemReport, RunReport};
use serde::Serialize;

use crate::args::CommonArgs;
use crate::failure::{Failure, Outcome};
use crate::output::Outputs;
use crate::say;

/// Writes the report to the requested place and puts it in place with all other outputs of the command.
pub(crate) fn finish(report: &impl Serialize, args: &CommonArgs, mut outputs: Outputs) -> Outcome {
    if args.report.is_some() || args.json {
        let text = serde_json::to_string_pretty(report)
            .map_err(|e| Failure::Bug(format!("the report cannot be written as JSON: {e}")))?;
        if let Some(path) = &args.report {
            outputs.write("--report", path, |out| Ok(writeln!(out, "{text}")?))?;
        }
        if args.json {
            // Printed before files are in place: if standard output refuses it, no file remains.
            outputs.check()?;
            say::data(&text).map_err(|e| Failure::io(Path::new("standard output"), "written", &e))?;
        }
    }
    outputs.place()
}

/// Returns one line about a plant: its place and its parts.
pub(crate) fn summary(item: &ItemReport, png: Option<&Path>) -> String {
    let c = &item.counts;
    let parts = [
        (c.flowers, "flower", "flowers"),
        (c.petals, "petal", "petals"),
        (c.leaves, "leaf", "leaves"),
        (c.branches, "branch", "branches"),
        (Some(c.triangles), "triangle", "triangles"),
    ];
    let parts =
        parts.into_iter().filter_map(|(n, one, many)| Some(say::counted(n.filter(|&n| n > 0)?, one, many)));
    let made = [Some(item.output.clone()), png.map(|p| p.display().to_string())];
    let made: Vec<String> = made.into_iter().flatten().filter(|s| !s.is_empty()).collect();
    let made = if made.is_empty() { item.name.clone() } else { made.join(", ") };
    format!("{made}: {}; {:.0} ms", parts.collect::<Vec<_>>().join(", "), item.timings_ms.total)
}

/// Makes the report of a command that makes one thing.
pub(crate) fn report_one(command: &str, seed: u64, input: &str, name: &str, output: &Path) -> RunReport {
    let mut run = RunReport::new(command, seed);
    run.input.path = input.to_owned();
    run.items.push(ItemReport {
        name: name.to_owned(),
        output: output.display().to_string(),
        ..ItemReport::default()
    });
    run.ok = 1;
    run
}
