//! `burgeon forest`: the trees of an inventory as tiles of grown plants.
//!
//! | file | owns |
//! |---|---|
//! | `input` | an inventory or a stand that grows, its ground, the specs of its species |
//! | `folder` | files that come to be one after another; what an earlier run left |
//! | `models` | the plants' own files, which tiles name |
//! | `write` | tiles, tileset, table, one file of all |

mod folder;
mod input;
mod models;
mod write;

use burgeon::forest::Stand;
use burgeon::formats::Packing;
use burgeon::skin::SkinSpec;
use burgeon::{
    Digest, ItemReport, Misfits, Nursery, NurseryError, NurseryLook, NurserySpec, Report, RunReport, Seed,
    Stopped, Tiling, TilingSpec,
};
use serde::Serialize;

use crate::args::ForestArgs;
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{picture, report, say};
use folder::Folder;
use models::Models;
use write::{Writer, failure as failed_to_write};

/// Pixels of a side of a plan.
const MAP: u32 = 1_536;

/// What was made.
#[derive(Debug, Default, Serialize)]
struct ForestTally {
    trees: u64,
    species: u64,
    tiles: u64,
    /// Grown plants that stand for the trees.
    variants: u64,
    /// Levels of detail.
    levels: u32,
    /// Most trees of a tile of the finest level.
    tile_trees: u32,
    height_error_max_m: f64,
    dbh_error_max_m: f64,
    dbh_error_mean_m: f64,
    crown_error_max_m: f64,
    /// Trees that the limits of scales changed.
    clipped: u64,
    /// Trees whose stems are more than a quarter off.
    stems_off: u64,
    /// Files of the folder, and their bytes.
    files: u64,
    bytes: u64,
    /// Files that an earlier run had written, and those that this one wrote before the last step.
    kept: u64,
    written: u64,
    /// Triangles of all trees at each level of detail, finest first.
    triangles: Vec<u64>,
    input: input::InputTally,
}

#[derive(Debug, Serialize)]
struct ForestRun {
    #[serde(flatten)]
    run: RunReport,
    forest: ForestTally,
}

/// A forest, before its files.
struct Plan {
    stand: Stand,
    nursery: Nursery,
    tiling: Tiling,
    tiling_spec: TilingSpec,
    look: NurseryLook,
    packing: Packing,
    seed: Seed,
    misfits: Misfits,
    /// How many trees each variant stands for.
    trees_of: Vec<u64>,
}

pub(crate) fn forest(args: &ForestArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let named = [("--map", args.map.as_ref()), ("--report", args.common.report.as_ref())];
    let mut outputs = Outputs::new(&named, &[&args.input])?;
    check_used(args)?;
    folder::check(&args.output)?;
    if let Some(map) = &args.map {
        picture::check_name(map)?;
    }
    let mut told = Report::default();
    let (stand, input) = machine.with_progress("reading", |_| input::read(args, &machine, &mut told))?;
    outputs.check()?;
    let plan = machine.with_progress("growing", |_| plan(args, stand, &machine, &mut told))?;
    let mut folder = Folder::open(&args.output, &key(&plan))?;
    let mut tally = ForestTally {
        trees: plan.stand.trees.len() as u64,
        species: plan.stand.species.len() as u64,
        variants: plan.nursery.variants().len() as u64,
        levels: plan.look.levels(),
        tile_trees: plan.tiling_spec.trees,
        height_error_max_m: plan.misfits.height_error_max_m,
        dbh_error_max_m: plan.misfits.dbh_error_max_m,
        dbh_error_mean_m: plan.misfits.dbh_error_mean_m,
        crown_error_max_m: plan.misfits.crown_error_max_m,
        clipped: plan.misfits.clipped,
        stems_off: plan.misfits.stems_off,
        input,
        ..ForestTally::default()
    };
    let mut last = Vec::new();
    if let Some(id) = args.tile {
        let tile = plan.tiling.find(id).ok_or_else(|| no_such_tile(&plan, id))?;
        let models = machine
            .with_progress("models", |p| Models::make(&plan, Some(tile), None, &mut folder, &machine, p))?;
        let writer = Writer { plan: &plan, models: &models, machine: &machine };
        machine.with_progress("tiles", |p| writer.tiles(std::slice::from_ref(tile), &mut folder, p))?;
        tally.tiles = 1;
    } else {
        let models = machine.with_progress("models", |p| {
            Models::make(&plan, None, args.usd.then(|| one_level(args)), &mut folder, &machine, p)
        })?;
        let writer = Writer { plan: &plan, models: &models, machine: &machine };
        machine.with_progress("tiles", |p| writer.tiles(plan.tiling.tiles(), &mut folder, p))?;
        last = machine.with_progress("tileset", |_| writer.whole(args, &folder, &mut outputs))?;
        tally.tiles = plan.tiling.tiles().len() as u64;
        tally.triangles = models.triangles(&plan);
    }
    machine.cancel.check()?;
    (tally.kept, tally.written) = (folder.kept, folder.written);
    (tally.bytes, tally.files) = folder.size();
    tally.bytes += last.iter().map(|e| e.bytes).sum::<u64>();
    tally.files += last.len() as u64;
    if let Some(map) = &args.map {
        let drawn = burgeon::stand_map(&plan.stand, MAP);
        outputs.write("--map", map, |out| {
            burgeon::formats::write_png(drawn.width, drawn.height, &drawn.pixels, out)
        })?;
    }
    if args.tile.is_none() {
        folder.manifest(&last, &mut outputs)?;
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
        folder.end(&last)?;
    }
    if !machine.quiet {
        let item = &whole.run.items[0];
        item.warnings.iter().for_each(|w| say::warning(w));
        say::line(&summary(&whole));
    }
    Ok(())
}

/// Fails on options that nothing uses.
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

/// The level of the files that hold all trees, among those of the tileset.
fn one_level(args: &ForestArgs) -> u32 {
    let surface = &args.surface;
    let level = args.level.unwrap_or((surface.finest + 1).min(surface.lods));
    level.saturating_sub(surface.finest)
}

fn plan(args: &ForestArgs, stand: Stand, machine: &Machine, told: &mut Report) -> Outcome<Plan> {
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
    let tiling_spec = TilingSpec {
        trees: args.tile_trees.unwrap_or_else(|| TilingSpec::usual_trees(stand.trees.len())),
        finest: look.finest,
        levels: look.levels(),
    };
    let tiling = Tiling::new(&stand, tiling_spec).map_err(|e| Failure::at(&args.input, e))?;
    let seed = Seed::new(args.seed);
    let spec = NurserySpec { variants: args.variants, seed };
    let nursery = Nursery::plan(&stand, &specs, &spec, &machine.run()).map_err(|e| failed(args, e))?;
    let (mut misfits, mut trees_of) = (Misfits::default(), vec![0; nursery.variants().len()]);
    for (n, tree) in stand.trees.iter().enumerate() {
        if n % 4096 == 0 {
            machine.cancel.check()?;
        }
        let Some(placed) = nursery.place(tree) else { continue };
        misfits.add(tree, &placed);
        trees_of[placed.variant as usize] += 1;
    }
    let packing = surface.pack.packing();
    Ok(Plan { stand, nursery, tiling, tiling_spec, look, packing, seed, misfits, trees_of })
}

/// What decides every tile.
fn key(plan: &Plan) -> String {
    let mut digest = Digest::new();
    let head = format!(
        "{} {:?} {:?} {:?} {:?} {:?}",
        burgeon::VERSION,
        plan.look,
        plan.tiling_spec,
        plan.packing,
        plan.seed.number(),
        plan.stand.species
    );
    digest.bytes(head.as_bytes());
    // The plants themselves follow from their specs, whose measures these are.
    digest.bytes(format!("{:?}", plan.nursery).as_bytes());
    for t in &plan.stand.trees {
        let numbers = [t.age_years, t.height_m, t.dbh_m, t.crown_width_m, t.yaw];
        let vectors = [t.foot_m, t.up, t.crown_offset_m].map(|v| v.to_array());
        for x in numbers.iter().chain(vectors.as_flattened()) {
            digest.bytes(&x.to_le_bytes());
        }
        digest.bytes(&t.row.to_le_bytes()).bytes(&t.species.to_le_bytes());
    }
    digest.hex()
}

fn no_such_tile(plan: &Plan, id: burgeon::TileId) -> Failure {
    let first = plan.tiling.tiles().last().map_or_else(String::new, |t| t.id.file());
    Failure::Bad(format!(
        "there is no tile {} in this forest; one of those that there are is {first}",
        id.file()
    ))
}

fn failed(args: &ForestArgs, error: NurseryError) -> Failure {
    match error {
        NurseryError::Stopped(Stopped::Cancelled(_)) => Failure::Cancelled,
        NurseryError::Stopped(stopped) => stopped.into(),
        other => Failure::at(&args.input, other),
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
