//! `burgeon forest`: the trees of an inventory as tiles of grown plants.
//!
//! | file | owns |
//! |---|---|
//! | `input` | an inventory or a stand that grows, its ground, the specs of its species |
//! | `folder` | the disk below the folder of the tileset |

mod folder;
mod input;

use std::slice;

use burgeon::forest::Stand;
use burgeon::skin::SkinSpec;
use burgeon::{
    ForestPlan, ForestTilesSpec, ItemReport, ModelsOf, NurseryLook, Report, RunReport, Seed, StandReport,
    TileFolder, TileModels, TileWriter, WholeForest,
};
use serde::Serialize;

use crate::args::ForestArgs;
use crate::failure::{Failure, Outcome};
use crate::machine::{Machine, Progress};
use crate::output::Outputs;
use crate::{picture, report, say};
use folder::FolderDisk;

/// Side of a plan, pixels.
const MAP: u32 = 1_536;

/// Figures of the result.
#[derive(Debug, Default, Serialize)]
struct ForestTally {
    trees: u64,
    species: u64,
    tiles: u64,
    /// Grown plants that stand for the trees.
    variants: u64,
    /// Number of levels of detail.
    levels: u32,
    /// Most trees of a tile of the finest level.
    tile_trees: u32,
    height_error_max_m: f64,
    dbh_error_max_m: f64,
    dbh_error_mean_m: f64,
    crown_error_max_m: f64,
    /// Trees that a limit of scaling changed.
    clipped: u64,
    /// Trees whose stems differ by more than a quarter.
    stems_off: u64,
    /// Files of the folder, and their bytes.
    files: u64,
    bytes: u64,
    /// Files that an earlier run had written, and those that this one wrote before the last step.
    kept: u64,
    written: u64,
    /// Triangles of all trees at each level of detail, finest first.
    triangles: Vec<u64>,
    input: StandReport,
}

impl ForestTally {
    fn new(plan: &ForestPlan, input: StandReport) -> Self {
        Self {
            trees: plan.stand.trees.len() as u64,
            species: plan.stand.species.len() as u64,
            variants: plan.nursery.variants().len() as u64,
            levels: plan.look().levels(),
            tile_trees: plan.tiling_spec.trees,
            height_error_max_m: plan.misfits.height_error_max_m,
            dbh_error_max_m: plan.misfits.dbh_error_max_m,
            dbh_error_mean_m: plan.misfits.dbh_error_mean_m,
            crown_error_max_m: plan.misfits.crown_error_max_m,
            clipped: plan.misfits.clipped,
            stems_off: plan.misfits.stems_off,
            input,
            ..Self::default()
        }
    }
}

#[derive(Debug, Serialize)]
struct ForestRun {
    #[serde(flatten)]
    run: RunReport,
    forest: ForestTally,
}

pub(crate) fn forest(args: &ForestArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let named = [("--map", args.map.as_ref()), ("--report", args.common.report.as_ref())];
    let outputs = Outputs::new(&named, &[&args.input])?;
    check_used(args)?;
    folder::check(&args.output)?;
    if let Some(map) = &args.map {
        picture::check_name(map)?;
    }
    let mut told = Report::default();
    let (stand, input) = machine.with_progress("reading", |_| input::read(args, &machine, &mut told))?;
    outputs.check()?;
    let plan = machine.with_progress("growing", |_| plan(args, stand, &machine, &mut told))?;
    let disk = FolderDisk::new(&args.output, outputs)?;
    let mut folder = TileFolder::open(disk, &plan.key()).map_err(|f| f.in_file(&args.output))?;
    let mut tally = ForestTally::new(&plan, input);
    if let Some(id) = args.tile {
        let tile = plan.tile(id)?;
        let models = models(&plan, ModelsOf::Tile(tile), &mut folder, &machine)?;
        tiles(&TileWriter { plan: &plan, models: &models }, slice::from_ref(tile), &mut folder, &machine)?;
        tally.tiles = 1;
    } else {
        let usd = args.usd.then(|| one_level(args));
        let models = models(&plan, ModelsOf::All { usd }, &mut folder, &machine)?;
        let writer = TileWriter { plan: &plan, models: &models };
        tiles(&writer, plan.tiling.tiles(), &mut folder, &machine)?;
        let whole = WholeForest { glb: args.glb, usd: args.usd, level: one_level(args), place: args.place };
        machine.with_progress("tileset", |_| writer.whole(&whole, &mut folder))?;
        tally.tiles = plan.tiling.tiles().len() as u64;
        tally.triangles = models.triangles(&plan);
    }
    machine.cancel.check()?;
    (tally.kept, tally.written) = folder.kept_and_written();
    for own in folder.files() {
        (tally.files, tally.bytes) = (tally.files + 1, tally.bytes + own.bytes);
    }
    let mut outputs = std::mem::take(&mut folder.disk().outputs);
    if let Some(map) = &args.map {
        let drawn = burgeon::stand_map(&plan.stand, MAP);
        outputs.write("--map", map, |out| {
            burgeon::formats::write_png(drawn.width, drawn.height, &drawn.pixels, out)
        })?;
    }
    plan.misfits.tell(&mut told);
    let mut item = ItemReport { name: "forest".into(), ..ItemReport::default() };
    item.output = args.output.display().to_string();
    item.counts.triangles = tally.triangles.first().copied().unwrap_or(0);
    item.warnings = told.warnings.iter().map(ToString::to_string).collect();
    item.timings_ms.total = machine.whole_ms();
    let mut run = RunReport::new("forest", args.seed);
    run.input.path = args.input.display().to_string();
    run.ok = 1;
    run.items = vec![item];
    let whole = ForestRun { run, forest: tally };
    report::finish(&whole, &args.common, outputs)?;
    if args.tile.is_none() {
        folder.end()?;
    }
    if !machine.quiet {
        let item = &whole.run.items[0];
        item.warnings.iter().for_each(|w| say::warning(w));
        say::line(&summary(&whole));
    }
    Ok(())
}

/// Fails on unused options.
fn check_used(args: &ForestArgs) -> Outcome {
    let surface = &args.surface;
    if surface.finest > surface.lods {
        return Err(Failure::Bad(format!(
            "--finest {} is coarser than --lods {}: make it at most as large",
            surface.finest, surface.lods
        )));
    }
    args.given.only_if(args.glb || args.usd, &["level"], "--glb and --usd", "none of them is given")?;
    let is_png = args.ground.ground.as_deref().and_then(crate::files::extension);
    let is_png = is_png.is_some_and(|e| e.eq_ignore_ascii_case("png"));
    args.given.only_if(
        is_png,
        &["metres_per_cell", "heights"],
        "height maps as PNG",
        "the ground says its metres itself",
    )?;
    args.given.only_if(args.tile.is_none(), &["place"], "tilesets", "a tile alone has none")?;
    if let Some(level) = args.level.filter(|l| !(surface.finest..=surface.lods).contains(l)) {
        return Err(Failure::Bad(format!(
            "--level {level} is none of the levels {} to {} of --finest and --lods: name one of them",
            surface.finest, surface.lods
        )));
    }
    Ok(())
}

/// Returns the level of the files that hold all trees, among those of the tileset.
fn one_level(args: &ForestArgs) -> u32 {
    let surface = &args.surface;
    let level = args.level.unwrap_or((surface.finest + 1).min(surface.lods));
    level.saturating_sub(surface.finest)
}

fn plan(args: &ForestArgs, stand: Stand, machine: &Machine, told: &mut Report) -> Outcome<ForestPlan> {
    let specs = input::specs(args, &stand, told)?;
    let surface = &args.surface;
    let mut skin = SkinSpec { foliage: surface.foliage.foliage(), ..SkinSpec::default() };
    skin.detail = surface.detail.unwrap_or(skin.detail);
    skin.sides = surface.sides.unwrap_or(skin.sides);
    skin.texture_size = surface.textures;
    let look = NurseryLook {
        skin,
        finest: surface.finest,
        lods: surface.lods,
        impostor: Some(surface.impostor).filter(|&size| size > 0),
    };
    let spec = ForestTilesSpec {
        variants: args.variants,
        seed: Seed::new(args.seed),
        look,
        tile_trees: args.tile_trees,
        packing: surface.pack.packing(),
    };
    ForestPlan::new(stand, &specs, spec, &machine.run()).map_err(|e| Failure::from(e).in_file(&args.input))
}

fn models(
    plan: &ForestPlan,
    of: ModelsOf<'_>,
    folder: &mut TileFolder<FolderDisk>,
    machine: &Machine,
) -> Outcome<TileModels> {
    machine.with_progress("models", |p| TileModels::make(plan, of, folder, &machine.run(), &shown(p)))
}

fn tiles(
    writer: &TileWriter<'_>,
    tiles: &[burgeon::StandTile],
    folder: &mut TileFolder<FolderDisk>,
    machine: &Machine,
) -> Outcome {
    machine.with_progress("tiles", |p| writer.tiles(tiles, folder, &machine.run(), &shown(p)))
}

/// Shows the progress of a step.
fn shown(progress: &Progress) -> impl Fn(usize, usize) + '_ {
    |done, all| {
        progress.expect(all);
        progress.reached(done);
    }
}

fn summary(whole: &ForestRun) -> String {
    let (t, item) = (&whole.forest, &whole.run.items[0]);
    let kept = if t.kept > 0 {
        format!(", {} files were there already", say::grouped(t.kept))
    } else {
        String::new()
    };
    format!(
        "{}: {} of {} as {}, in {}, {:.1} MB{kept}; {:.0} ms",
        item.output,
        say::counted(t.trees, "tree", "trees"),
        say::counted(t.species, "species", "species"),
        say::counted(t.variants, "plant", "plants"),
        say::counted(t.tiles, "tile", "tiles"),
        t.bytes as f64 / 1e6,
        item.timings_ms.total
    )
}
