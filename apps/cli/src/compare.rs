//! `burgeon compare oak`: one oak by three methods, side by side.

use std::path::PathBuf;

use burgeon::formats::{ExportSpec, ModelFormat};
use burgeon::render::{Picture, View};
use burgeon::skin::SkinSpec;
use burgeon::{
    MadeTree, OAK_METHODS, PAPER_OAKS, PaperOak, Preset, Report, Seed, TreeOptions, TreeSpec, make_tree,
    tree_size,
};
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
    /// One side of all blades.
    leaf_area_m2: f64,
    /// Wood of trunk and branches as the pipe model has it.
    wood_m3: f64,
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

const NOTES: &str = "All three stand at one height with one number of leaves of one form and size (the best lit of each, as many \
                     as the tree with fewest has), and with one thickness of trunks and twigs; crown is the mean width of \
                     the branches. Seconds are growth, wood, leaves and meshes on this machine; the paper's are on its own.";

pub(crate) fn compare(args: &CompareArgs) -> Outcome {
    let CompareWord::Oak = args.what;
    let machine = Machine::new(args.common.threads, args.common.quiet || args.common.json);
    let outputs = [("--png", args.png.as_ref()), ("--report", args.common.report.as_ref())];
    output::check_outputs(&outputs, &[])?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    let made = machine.with_progress("compare", |progress| {
        progress.expect(2 * OAK_METHODS.len());
        let mut oaks = Vec::new();
        for &(method, key) in &OAK_METHODS {
            oaks.push(Oak::new(args, &machine, method, key)?);
            progress.reached(oaks.len());
        }
        // Leaves for leaves: each tree keeps as many of its best lit ones as the one with fewest has.
        let fewest = oaks.iter().map(|o| o.leaves).min().unwrap_or(0);
        let mut made = Vec::new();
        for (mut oak, paper) in oaks.into_iter().zip(PAPER_OAKS) {
            oak.keep(fewest);
            made.push(oak.row(args, &machine, paper)?);
            progress.reached(OAK_METHODS.len() + made.len());
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

/// One of the oaks, grown once: so textures are painted before a clock starts, and its leaves are counted.
struct Oak {
    method: &'static str,
    key: &'static str,
    spec: TreeSpec,
    leaves: u64,
}

impl Oak {
    fn new(args: &CompareArgs, machine: &Machine, method: &'static str, key: &'static str) -> Outcome<Self> {
        let preset = Preset::find(key).ok_or_else(|| Failure::Bug(format!("preset {key}: is missing")))?;
        let spec = preset.spec().map_err(|e| cancelled_or(e, key))?;
        let mut oak = Self { method, key, spec, leaves: 0 };
        oak.leaves = oak.made(args, machine)?.item.counts.leaves;
        Ok(oak)
    }

    fn made(&self, args: &CompareArgs, machine: &Machine) -> Outcome<MadeTree> {
        let options = TreeOptions {
            skin: SkinSpec { detail: args.detail, ..SkinSpec::default() },
            height_m: Some(args.height),
            ..TreeOptions::default()
        };
        let made = make_tree(&self.spec, Seed::new(args.seed), &options, &machine.run());
        made.map_err(|e| cancelled_or(e, self.key))
    }

    /// Leaves so many leaves that `count` stay.
    fn keep(&mut self, count: u64) {
        let keep = &mut self.spec.leaves.leaf_keep;
        *keep = (*keep * count as f64 / self.leaves.max(1) as f64).min(1.0);
    }

    fn row(&self, args: &CompareArgs, machine: &Machine, paper: PaperOak) -> Outcome<(Row, Option<Picture>)> {
        let (made, ms) = machine.timed(|| self.made(args, machine));
        let made = made?;
        let mut bytes = Vec::new();
        let (axes, mut told) = (ExportSpec::default(), Report::default());
        burgeon::formats::write_model(&made.model, ModelFormat::Glb, &axes, &mut bytes, &mut told)
            .map_err(|e| Failure::Bug(format!("preset {}: {e}", self.key)))?;
        let picture = match &args.png {
            Some(_) => {
                let picture =
                    burgeon::render::PictureSpec { view: View::Front, ..args.picture.spec(args.seed) };
                Some(burgeon::render::render(&made.model, &picture, &machine.run())?)
            }
            None => None,
        };
        let size = tree_size(&made.grown);
        let counts = made.item.counts;
        let measures = made.grown.plant.measure();
        let row = Row {
            method: self.method,
            preset: self.key,
            height_m: size.height_m,
            crown_m: size.crown_m,
            nodes: counts.nodes,
            branches: counts.branches,
            vertices: counts.vertices,
            triangles: counts.triangles,
            leaves: counts.leaves,
            leaf_area_m2: measures.leaf_area_m2,
            wood_m3: measures.wood_volume_m3,
            seconds: ms / 1000.0,
            bytes: bytes.len() as u64,
            digest: made.item.digest,
            paper: paper.into(),
        };
        Ok((row, picture))
    }
}

fn cancelled_or(error: burgeon::TreeError, key: &str) -> Failure {
    match error {
        burgeon::TreeError::Cancelled(_) => Failure::Cancelled,
        other => Failure::Bug(format!("preset {key}: {other}")),
    }
}

fn table(rows: &[Row]) {
    say::line(&format!(
        "{:<20}{:>8}{:>8}{:>9}{:>8}{:>9}{:>10}{:>10}{:>9}{:>12}   paper: vertices, triangles, seconds",
        "method", "height", "crown", "leaves", "area", "wood", "vertices", "triangles", "seconds", "bytes"
    ));
    for r in rows {
        say::line(&format!(
            "{:<20}{:>6.1} m{:>6.1} m{:>9}{:>5.0} m2{:>6.2} m3{:>10}{:>10}{:>9.3}{:>12}   {:.1}k, {:.1}k, {:.0}",
            r.method,
            r.height_m,
            r.crown_m,
            say::grouped(r.leaves),
            r.leaf_area_m2,
            r.wood_m3,
            say::grouped(r.vertices),
            say::grouped(r.triangles),
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
