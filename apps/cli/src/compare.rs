//! `burgeon compare oak`: one oak by three methods, side by side.

use std::path::PathBuf;

use burgeon::formats::{ExportSpec, ModelFormat};
use burgeon::render::{Picture, View};
use burgeon::skin::SkinSpec;
use burgeon::{OAK_METHODS, PAPER_OAKS, PaperOak, Preset, Report, Seed, TreeOptions, make_tree, tree_size};
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::args::{CommonArgs, PictureArgs, ranged, seed};
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::{output, picture, report, say};

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon compare oak
  burgeon compare oak --png oaks.png --report oaks.json
  burgeon compare oak --height 15 --detail 2")]
pub(crate) struct CompareArgs {
    /// What to compare.
    #[arg(value_enum)]
    pub(crate) what: CompareWord,
    /// The three side by side, seen from the front, to one scale; --size is that of each.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Height that all are scaled to, metres, 0.1 to 1000.
    #[arg(long, value_name = "METRES", default_value_t = 10.0, value_parser = |s: &str| ranged(s, 0.1, 1000.0))]
    pub(crate) height: f64,
    /// Fineness of the meshes, 0.1 to 8.
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = |s: &str| ranged(s, 0.1, 8.0))]
    pub(crate) detail: f64,
    /// Number that all chance follows from.
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum CompareWord {
    /// L-system, space colonization and space competition, as the paper's Table 2
    Oak,
}

/// One method.
#[derive(Debug, Serialize)]
struct Row {
    method: &'static str,
    preset: &'static str,
    height_m: f64,
    crown_m: f64,
    nodes: u64,
    branches: u64,
    vertices: u64,
    triangles: u64,
    leaves: u64,
    /// Growth, wood, leaves and meshes.
    seconds: f64,
    /// As binary glTF with textures.
    bytes: u64,
    digest: String,
    /// What the paper printed for this method, thousands and seconds.
    paper: PaperRow,
}

#[derive(Clone, Copy, Debug, Serialize)]
struct PaperRow {
    vertices_k: f64,
    triangles_k: f64,
    seconds: f64,
}

impl From<PaperOak> for PaperRow {
    fn from(p: PaperOak) -> Self {
        Self { vertices_k: p.vertices_k, triangles_k: p.triangles_k, seconds: p.seconds }
    }
}

/// The report of this command.
#[derive(Debug, Serialize)]
struct Comparison {
    schema: &'static str,
    command: &'static str,
    version: &'static str,
    seed: u64,
    rows: Vec<Row>,
    notes: &'static str,
}

const NOTES: &str = "All three stand at one height; crown is the mean width of the branches; leaves have one form and size. \
                     Seconds are growth, wood, leaves and meshes on this machine; the paper's are on its own.";

pub(crate) fn compare(args: &CompareArgs) -> Outcome {
    let CompareWord::Oak = args.what;
    let machine = Machine::new(args.common.threads, args.common.quiet || args.common.json);
    let outputs = [("--png", args.png.as_ref()), ("--report", args.common.report.as_ref())];
    output::check_outputs(&outputs, &[])?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    let made = machine.with_progress("compare", |progress| {
        progress.expect(OAK_METHODS.len());
        let mut made = Vec::new();
        for (&(method, preset), paper) in OAK_METHODS.iter().zip(PAPER_OAKS) {
            made.push(oak(args, &machine, method, preset, paper)?);
            progress.reached(made.len());
        }
        Outcome::Ok(made)
    })?;
    let (rows, pictures): (Vec<_>, Vec<_>) = made.into_iter().unzip();
    if let Some(png) = &args.png {
        picture::write(png, &side_by_side(&pictures.into_iter().flatten().collect::<Vec<_>>()))?;
    }
    if !machine.quiet {
        table(&rows);
    }
    let comparison = Comparison {
        schema: "burgeon.comparison/1",
        command: "compare",
        version: burgeon::VERSION,
        seed: args.seed,
        rows,
        notes: NOTES,
    };
    report::finish_any(&comparison, &args.common)
}

fn oak(
    args: &CompareArgs,
    machine: &Machine,
    method: &'static str,
    key: &'static str,
    paper: PaperOak,
) -> Outcome<(Row, Option<Picture>)> {
    let bug = |e: &dyn std::fmt::Display| Failure::Bug(format!("preset {key}: {e}"));
    let preset = Preset::find(key).ok_or_else(|| bug(&"is missing"))?;
    let spec = preset.spec().map_err(|e| bug(&e))?;
    let options = TreeOptions {
        skin: SkinSpec { detail: args.detail, ..SkinSpec::default() },
        height_m: Some(args.height),
        ..TreeOptions::default()
    };
    let make = || make_tree(&spec, Seed::new(args.seed), &options, &machine.run());
    // Once before the clock starts: textures are painted on first use only.
    make().map_err(|e| cancelled_or(e, &bug))?;
    let (made, ms) = machine.timed(make);
    let made = made.map_err(|e| cancelled_or(e, &bug))?;
    let mut bytes = Vec::new();
    let (axes, mut told) = (ExportSpec::default(), Report::default());
    burgeon::formats::write_model(&made.model, ModelFormat::Glb, &axes, &mut bytes, &mut told)
        .map_err(|e| bug(&e))?;
    let picture = match &args.png {
        Some(_) => {
            let picture = burgeon::render::PictureSpec { view: View::Front, ..args.picture.spec(args.seed) };
            Some(burgeon::render::render(&made.model, &picture, &machine.run())?)
        }
        None => None,
    };
    let size = tree_size(&made.grown);
    let counts = made.item.counts;
    let row = Row {
        method,
        preset: key,
        height_m: size.height_m,
        crown_m: size.crown_m,
        nodes: counts.nodes,
        branches: counts.branches,
        vertices: counts.vertices,
        triangles: counts.triangles,
        leaves: counts.leaves,
        seconds: ms / 1000.0,
        bytes: bytes.len() as u64,
        digest: made.item.digest,
        paper: paper.into(),
    };
    Ok((row, picture))
}

fn cancelled_or(error: burgeon::TreeError, bug: &dyn Fn(&dyn std::fmt::Display) -> Failure) -> Failure {
    match error {
        burgeon::TreeError::Cancelled(_) => Failure::Cancelled,
        other => bug(&other),
    }
}

fn table(rows: &[Row]) {
    say::line(&format!(
        "{:<20}{:>8}{:>8}{:>11}{:>11}{:>9}{:>10}{:>12}   paper: vertices, triangles, seconds",
        "method", "height", "crown", "vertices", "triangles", "leaves", "seconds", "bytes"
    ));
    for r in rows {
        say::line(&format!(
            "{:<20}{:>6.1} m{:>6.1} m{:>11}{:>11}{:>9}{:>10.3}{:>12}   {:.1}k, {:.1}k, {:.0}",
            r.method,
            r.height_m,
            r.crown_m,
            say::grouped(r.vertices),
            say::grouped(r.triangles),
            say::grouped(r.leaves),
            r.seconds,
            say::grouped(r.bytes),
            r.paper.vertices_k,
            r.paper.triangles_k,
            r.paper.seconds
        ));
    }
}

/// Pictures of one height, joined from left to right.
fn side_by_side(pictures: &[Picture]) -> Picture {
    let height = pictures.first().map_or(0, |p| p.height);
    let width = pictures.iter().map(|p| p.width).sum();
    let mut pixels = Vec::with_capacity(4 * (width * height) as usize);
    for y in 0..height as usize {
        for p in pictures.iter().filter(|p| p.height == height) {
            let row = 4 * p.width as usize;
            pixels.extend_from_slice(p.pixels.get(y * row..(y + 1) * row).unwrap_or_default());
        }
    }
    Picture { width, height, pixels }
}
