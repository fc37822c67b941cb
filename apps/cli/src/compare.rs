//! `burgeon compare oak|guided`: one oak by several methods, next to each other.

use burgeon::formats::{ExportSpec, ModelFormat};
use burgeon::growth::Method;
use burgeon::render::{Picture, View};
use burgeon::skin::SkinSpec;
use burgeon::{
    GUIDED_METHODS, MadeTree, OAK_METHODS, PAPER_OAKS, PaperOak, Preset, Report, Seed, TreeOptions, TreeSpec,
    guided_methods, make_tree, tree_size,
};
use serde::Serialize;

use crate::args::{CompareArgs, CompareWord};
use crate::curve::{self, Curve};
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{picture, report, say};

impl CompareWord {
    /// Returns the trees, not grown yet.
    fn trees(self) -> Outcome<Vec<Oak>> {
        match self {
            Self::Oak => {
                let trees = OAK_METHODS.iter().zip(PAPER_OAKS);
                trees
                    .map(|(&(method, key), paper)| {
                        Ok(Oak { method, key, spec: preset(key)?, paper: Some(paper), leaves: 0 })
                    })
                    .collect()
            }
            Self::Guided => {
                let oak = preset("oak")?;
                let trees = GUIDED_METHODS.into_iter().zip(compared()?);
                let oak_by = |(name, method)| {
                    let spec = TreeSpec { method, ..oak.clone() };
                    Oak { method: name, key: "oak", spec, paper: None, leaves: 0 }
                };
                Ok(trees.map(oak_by).collect())
            }
        }
    }

    const fn notes(self) -> &'static str {
        match self {
            Self::Oak => NOTES,
            Self::Guided => GUIDED_NOTES,
        }
    }
}

fn preset(key: &'static str) -> Outcome<TreeSpec> {
    let preset = Preset::find(key).ok_or_else(|| Failure::Bug(format!("preset {key}: is missing")))?;
    preset.spec().map_err(|e| Failure::Bug(format!("preset {key}: {e}")))
}

/// Returns guided growth and its baseline in the crown of the oak.
fn compared() -> Outcome<[Method; 2]> {
    guided_methods(&preset("oak")?.method)
        .ok_or_else(|| Failure::Bug("preset oak: has no envelope".to_owned()))
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
    /// Leaf area, one side of all blades.
    leaf_area_m2: f64,
    /// Volume of the wood of trunk and branches by the pipe model.
    wood_m3: f64,
    /// Time of growth alone.
    growth_seconds: f64,
    /// Time of growth, wood, leaves and meshes.
    seconds: f64,
    /// Size as binary glTF with textures.
    bytes: u64,
    digest: String,
    /// Figures of Yang et al. (2019), Table 2, for this method, thousands and seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    paper: Option<PaperRow>,
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
    /// Figures of growth alone, by rounds.
    #[serde(skip_serializing_if = "Option::is_none")]
    curve: Option<Curve>,
    notes: &'static str,
}

const NOTES: &str = "All three stand at one height with one number of leaves of one form and size (the best lit of each, as many \
                     as the tree with fewest has), and with one thickness of trunks and twigs; crown is the mean width of \
                     the branches. Seconds are growth, wood, leaves and meshes on this machine; those of Yang et al. (2019) are \
                     on theirs.";

const GUIDED_NOTES: &str = "Both grow in the oak's envelope with internodes of one length, one perception, occupancy, angle, phyllotaxis, \
                            bias and number of rounds, stand at one height and keep one number of leaves. Guided growth makes \
                            markers for each bud in each round, its baseline scatters as many to a volume once. The curve is \
                            growth alone on one thread: at equal quality each has filled as much of the crown. The paper's \
                            own times are lost.";

pub(crate) fn compare(args: &CompareArgs) -> Outcome {
    let trees = args.what.trees()?;
    let machine = Machine::new(&args.common);
    let outputs = [("--png", args.png.as_ref()), ("--report", args.common.report.as_ref())];
    let mut outputs = Outputs::new(&outputs, &[])?;
    let given = &args.given;
    given.check_picture(args.png.is_some(), &args.picture)?;
    given.refuse(&["view"], "other commands' pictures", "trees are compared from the front")?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    let made = machine.with_progress("compare", |progress| {
        let count = trees.len();
        progress.expect(2 * count);
        let mut oaks = Vec::new();
        for mut oak in trees {
            oak.leaves = oak.made(args, &machine)?.item.counts.leaves.unwrap_or_default();
            oaks.push(oak);
            progress.reached(oaks.len());
        }
        // An equal number of leaves: each tree keeps as many of its best lit ones as the tree with fewest has.
        let fewest = oaks.iter().map(|o| o.leaves).min().unwrap_or(0);
        let mut made = Vec::new();
        for mut oak in oaks {
            oak.keep(fewest);
            made.push(oak.row(args, &machine)?);
            progress.reached(count + made.len());
        }
        Outcome::Ok(made)
    })?;
    let (rows, pictures): (Vec<_>, Vec<_>) = made.into_iter().unzip();
    if let Some(png) = &args.png {
        let drawn = side_by_side(&pictures.into_iter().flatten().collect::<Vec<_>>());
        picture::write(&mut outputs, "--png", png, &drawn)?;
    }
    let comparison = Comparison {
        schema: "burgeon.comparison/1",
        command: "compare",
        version: burgeon::VERSION,
        seed: args.seed,
        rows,
        curve: match args.what {
            CompareWord::Oak => None,
            CompareWord::Guided => Some(curve::curve(&compared()?, args.seed, &machine)?),
        },
        notes: args.what.notes(),
    };
    report::finish(&comparison, &args.common, outputs)?;
    if !machine.quiet {
        table(&comparison.rows);
        comparison.curve.iter().for_each(curve::table);
    }
    Ok(())
}

/// One of the oaks, grown once, so that textures are painted before timing starts, and its leaves are counted.
struct Oak {
    method: &'static str,
    key: &'static str,
    spec: TreeSpec,
    paper: Option<PaperOak>,
    leaves: u64,
}

impl Oak {
    fn made(&self, args: &CompareArgs, machine: &Machine) -> Outcome<MadeTree> {
        let options = TreeOptions {
            skin: SkinSpec { detail: args.detail, ..SkinSpec::default() },
            height_m: Some(args.height),
            ..TreeOptions::default()
        };
        let made = make_tree(&self.spec, Seed::new(args.seed), &options, &machine.run());
        made.map_err(|e| cancelled_or(e, self.key))
    }

    /// Reduces the leaves so that `count` remain.
    fn keep(&mut self, count: u64) {
        let keep = &mut self.spec.leaves.leaf_keep;
        *keep = (*keep * count as f64 / self.leaves.max(1) as f64).min(1.0);
    }

    fn row(&self, args: &CompareArgs, machine: &Machine) -> Outcome<(Row, Option<Picture>)> {
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
            nodes: counts.nodes.unwrap_or_default(),
            branches: counts.branches.unwrap_or_default(),
            vertices: counts.vertices,
            triangles: counts.triangles,
            leaves: counts.leaves.unwrap_or_default(),
            leaf_area_m2: measures.leaf_area_m2,
            wood_m3: measures.wood_volume_m3,
            growth_seconds: made.item.timings_ms.structure / 1000.0,
            seconds: ms / 1000.0,
            bytes: bytes.len() as u64,
            digest: made.item.digest,
            paper: self.paper.map(PaperRow::from),
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
    let paper =
        if rows.iter().any(|r| r.paper.is_some()) { "   paper: vertices, triangles, seconds" } else { "" };
    say::line(&format!(
        "{:<20}{:>8}{:>8}{:>8}{:>9}{:>8}{:>9}{:>10}{:>10}{:>9}{:>9}{:>12}{paper}",
        "method",
        "height",
        "crown",
        "nodes",
        "leaves",
        "area",
        "wood",
        "vertices",
        "triangles",
        "growth",
        "seconds",
        "bytes"
    ));
    for r in rows {
        let paper = r.paper.map_or_else(String::new, |p| {
            format!("   {:.1}k, {:.1}k, {:.0}", p.vertices_k, p.triangles_k, p.seconds)
        });
        say::line(&format!(
            "{:<20}{:>6.1} m{:>6.1} m{:>8}{:>9}{:>5.0} m2{:>6.2} m3{:>10}{:>10}{:>9.3}{:>9.3}{:>12}{paper}",
            r.method,
            r.height_m,
            r.crown_m,
            say::grouped(r.nodes),
            say::grouped(r.leaves),
            r.leaf_area_m2,
            r.wood_m3,
            say::grouped(r.vertices),
            say::grouped(r.triangles),
            r.growth_seconds,
            r.seconds,
            say::grouped(r.bytes),
        ));
    }
}

/// Joins pictures of one height from left to right.
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
