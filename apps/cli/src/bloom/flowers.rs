//! Whole flowers and drawings of flowers, from bud to end.

use std::path::Path;

use burgeon::bloom::{self, FlowerSpec, GrowthLaw};
use burgeon::{FlowerOptions, MakeError, OpeningError, OpeningPlant, Seed, Stopped, make_flower};

use super::told::{BloomReport, tell};
use super::write::{levels_of, write_show};
use super::{Show, Shown, hand_edits, no_pace};
use crate::args::BloomRunArgs;
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::materials::Materials;
use crate::output::Outputs;
use crate::petals::{drawing, petal_form};
use crate::{edits, files, report};

/// Fails on options of scans.
fn no_scans(args: &BloomRunArgs, name: &str) -> Outcome {
    let given = &args.given;
    let options = [
        "end",
        "compare",
        "lattice",
        "straight",
        "frame",
        "texture",
        "whole",
        "no_clean",
        "start_day",
        "end_day",
        "plant",
    ];
    given.refuse(&options, "scans and models", &format!("{name} is a whole flower"))?;
    super::plant_formats(args)
}

/// Opens a drawing of flowers.
pub(super) fn drawn_flower(
    args: &BloomRunArgs,
    path: &Path,
    law: Option<GrowthLaw>,
    mut outputs: Outputs,
    machine: &Machine,
) -> Outcome {
    no_scans(args, &args.start)?;
    let ((drawing, mut options), read_ms) = {
        let (read, ms) = machine.timed(|| drawing(path));
        (read?, ms)
    };
    options.skin.wind = args.wind || args.export.sway;
    if let Some(path) = &args.materials {
        options.skin.worn = Materials::read(path)?.worn();
    }
    let asked = hand_edits(args)?;
    let count = asked.len();
    options.edits.extend(asked);
    let seed = Seed::new(args.seed);
    let (plant, made_ms) = machine.timed(|| OpeningPlant::new(&drawing, &options, seed, &machine.run()));
    let mut plant = plant.map_err(|e| match e {
        OpeningError::Make(MakeError::Cancelled(_)) => Failure::Cancelled,
        other => Failure::bad_file(path, other),
    })?;
    if let Some(edits) = &args.edits {
        edits::some_done(edits, &plant.item, count)?;
    }
    let law = law.unwrap_or_else(|| plant.law());
    let axes = files::axes(args.axes.up, args.axes.unit);
    let mut head = report::report_one("bloom run", args.seed, &args.start, &plant.name, &args.output);
    head.engine = args.export.report();
    head.items[0].warnings.clone_from(&plant.item.warnings);
    head.items[0].warnings.extend(no_pace(args, &law));
    head.items[0].edits.clone_from(&plant.item.edits);
    head.items[0].checks.clone_from(&plant.item.checks);
    let mut show = Show {
        name: files::stem(path),
        days: [0.0, plant.days[0] + plant.days[1]],
        best: plant.days[0],
        shape: Box::new(|day| {
            let open = plant.make_on_day(day, &law, seed, &machine.run())?;
            let levels = plant.levels(&open, &levels_of(args), &machine.run())?;
            Ok(Shown {
                plant: Some(open.plant),
                model: open.model,
                levels,
                overlap: Some(open.overlap),
                checks: vec![],
            })
        }),
    };
    let (written, write_ms) = machine.timed(|| write_show(args, &mut show, &axes, &mut outputs, machine));
    let written = written?;
    let times = [read_ms, made_ms, write_ms];
    let told = BloomReport::from_flower(head, times);
    tell(args, machine, told, written, outputs)
}

/// Returns a flower by its name, or from a file of its own; `None` for scans and drawings.
pub(crate) fn species(start: &Path) -> Outcome<Option<FlowerSpec>> {
    let preset = start.to_str().and_then(bloom::preset).filter(|_| !start.exists() || start.is_dir());
    if preset.is_some()
        || !files::extension(start).is_some_and(|e| e.eq_ignore_ascii_case("toml"))
        || !start.exists()
    {
        return Ok(preset);
    }
    let text = files::read_text(start)?;
    // A file of stages has no whorls.
    let whorls = burgeon::spec::Node::from_toml(&text).is_ok_and(|tree| tree.field("whorls").is_some());
    whorls.then(|| burgeon::spec::from_toml(&text).map_err(|e| Failure::bad_file(start, e))).transpose()
}

pub(super) fn flower(
    args: &BloomRunArgs,
    spec: FlowerSpec,
    law: Option<GrowthLaw>,
    mut outputs: Outputs,
    machine: &Machine,
) -> Outcome {
    no_scans(args, &spec.name)?;
    let spec = match &args.petal {
        Some(path) => {
            let (form, aspect) = petal_form(path, args.seed, machine)?;
            spec.with_petals(form, aspect)
        }
        None => spec,
    };
    let law = law.unwrap_or_else(|| spec.own_law());
    let seed = Seed::new(args.seed);
    let mut options = FlowerOptions { edits: hand_edits(args)?, ..FlowerOptions::default() };
    options.skin.wind = args.wind || args.export.sway;
    if let Some(path) = &args.materials {
        options.skin.worn = Materials::read(path)?.worn();
    }
    let failed = |stopped| match stopped {
        Stopped::Cancelled(_) => Failure::Cancelled,
        Stopped::OverBudget(much) => Failure::bad_file(Path::new(&args.start), much),
    };
    let mut head = report::report_one("bloom run", args.seed, &args.start, &spec.name, &args.output);
    head.engine = args.export.report();
    head.items[0].warnings.extend(no_pace(args, &law));
    if let Some(edits) = &args.edits {
        let day = (spec.opening_days, &law);
        let made = make_flower(&spec.name, &spec, day, &options, seed, &machine.run()).map_err(failed)?;
        edits::some_done(edits, &made.item, options.edits.len())?;
        (head.items[0].warnings, head.items[0].edits) = (made.item.warnings, made.item.edits);
    }
    let axes = files::axes(args.axes.up, args.axes.unit);
    let mut show = Show {
        name: spec.name.clone(),
        days: [0.0, spec.opening_days + spec.wilting_days],
        best: spec.opening_days,
        shape: Box::new(|day| {
            let made = make_flower(&spec.name, &spec, (day, &law), &options, seed, &machine.run());
            let made = made.map_err(failed)?;
            let levels = made.levels(&levels_of(args), &machine.run()).map_err(failed)?;
            let overlap = bloom::part_overlap(&made.plant, None);
            let (plant, checks) = (Some(made.plant), made.item.checks);
            Ok(Shown { plant, model: made.model, levels, overlap: Some(overlap), checks })
        }),
    };
    let (written, write_ms) = machine.timed(|| write_show(args, &mut show, &axes, &mut outputs, machine));
    let written = written?;
    let times = [0.0, 0.0, write_ms];
    let told = BloomReport::from_flower(head, times);
    tell(args, machine, told, written, outputs)
}
