//! `burgeon light`: the light that each organ of a plant absorbs.
//!
//! | file | owns |
//! |---|---|
//! | `source` | sky and sun by the options |
//! | `stand` | the plants in the light: a plant of any maker, or the plants of a project |

mod source;
mod stand;

use std::path::Path;

use burgeon::formats::{ExportSpec, ModelFormat, PngCache, StructureFormat};
use burgeon::light::{LightError, LightSpec, Optics};
use burgeon::plant::Plant;
use burgeon::{
    LightFigures, LightOptions, LightSources, LitStand, Report, RunReport, Seed, SourceFigures, Stood,
    UpAxis, light_stand,
};
use serde::Serialize;

use crate::args::{AxesArgs, LightArgs, PlantFormat};
use crate::failure::{Failure, Outcome};
use crate::files::{self, Goal};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{checks, picture, report, say};
use stand::Grown;

/// Figures of the plant in light, and the sources of light.
#[derive(Debug, Serialize)]
struct LightTally {
    #[serde(flatten)]
    figures: LightFigures,
    /// Rows of the table.
    rows: u64,
    /// Light at the end of the colours' scale, for each square metre.
    colours_to_per_m2: f64,
    #[serde(flatten)]
    sources: SourceFigures,
}

#[derive(Debug, Serialize)]
struct LightRun {
    #[serde(flatten)]
    run: RunReport,
    light: LightTally,
}

/// Kind of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Output {
    Table,
    Model,
    Structure(StructureFormat),
}

pub(crate) fn light(args: &LightArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = [
        ("-o", args.output.as_ref()),
        ("--png", args.png.as_ref()),
        ("--report", args.common.report.as_ref()),
    ];
    let inputs = [Some(&args.what), args.source.sky_table.as_ref()];
    let mut outputs = Outputs::new(&outputs, &inputs.into_iter().flatten().collect::<Vec<_>>())?;
    let output = args.output.as_deref().map(output_of).transpose()?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    args.given.check_picture(args.png.is_some(), &args.picture)?;
    let LightSources { beams, unit, figures: sources } = source::sources(&args.source)?;
    let mut told = Report::default();
    let grown = machine.with_progress("grow", |_| Grown::new(args, &mut told, &machine))?;
    outputs.check()?;
    machine.cancel.check()?;
    let options = LightOptions { unit, ..options_of(args, LightOptions::new(beams)) };
    let stand = grown.stood()?;
    if let (Some((path, Output::Structure(_))), [_, _, ..]) = (args.output.as_deref().zip(output), &stand[..])
    {
        return Err(Failure::bad_file(path, ONE_PLANT));
    }
    let seed = Seed::new(args.seed.unwrap_or(1));
    let lit = machine
        .with_progress("light", |_| light_stand(&stand, &options, (seed, &machine.run()), &mut told))
        .map_err(|e| failure(&args.what, e))?;
    let mut items = grown.items();
    if let Some(item) = items.first_mut() {
        item.add_checks(told);
        item.output = args.output.as_ref().map_or_else(String::new, |p| p.display().to_string());
    }
    checks::accept(&items, &args.checks)?;
    let coloured = || lit.heat_map(grown.name(), &stand);
    if let Some((path, output)) = args.output.as_deref().zip(output) {
        match output {
            Output::Table => outputs.write("-o", path, |out| Ok(lit.write_csv(out)?))?,
            Output::Structure(format) => write_structure(&mut outputs, path, format, &lit, &stand)?,
            Output::Model => {
                let (model, nothing) = (coloured(), Plant::default());
                let format = PlantFormat::Model(ModelFormat::Glb);
                let goal = Goal::new("-o", path);
                let axes = AxesArgs::default();
                files::write_plant(
                    &mut outputs,
                    goal,
                    (&nothing, &model),
                    format,
                    &axes,
                    &mut PngCache::new(),
                )?;
            }
        }
    }
    if let Some(png) = &args.png {
        let (model, view) = (coloured(), args.picture.spec(seed.number()));
        let drawn =
            machine.with_progress("picture", |_| burgeon::render::render(&model, &view, &machine.run()))?;
        picture::write(&mut outputs, "--png", png, &drawn)?;
    }
    if let [only] = &mut items[..] {
        only.timings_ms.total = machine.whole_ms();
    }
    let mut run = RunReport::new("light", seed.number());
    run.input.path = args.what.display().to_string();
    run.ok = items.len() as u64;
    run.items = items;
    let light = LightTally {
        figures: lit.figures,
        rows: lit.organs.len() as u64,
        colours_to_per_m2: lit.brightest(),
        sources,
    };
    let run = LightRun { run, light };
    report::finish(&run, &args.common, outputs)?;
    if !machine.quiet {
        for item in &run.run.items {
            item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", item.name)));
        }
        say::line(&summary(args, &lit, &run.light, machine.whole_ms()));
    }
    Ok(())
}

/// Message about a file of structure, which holds one plant.
const ONE_PLANT: &str = "is the structure of one plant, and several stand in the light: write a table (.csv)";

/// Writes the structure of the only plant, with light in columns of its own.
fn write_structure(
    outputs: &mut Outputs,
    path: &Path,
    format: StructureFormat,
    lit: &LitStand,
    stand: &[Stood<'_>],
) -> Outcome {
    let [only] = stand else { return Err(Failure::bad_file(path, ONE_PLANT)) };
    let columns = lit.columns(0, only.plant);
    let axes = ExportSpec { up: UpAxis::Z, ..ExportSpec::default() };
    outputs.write("-o", path, |out| burgeon::write_structure_with(only.plant, &columns, format, &axes, out))
}

fn output_of(path: &Path) -> Outcome<Output> {
    let structure = files::extension(path).and_then(StructureFormat::from_extension);
    if let Some(format @ (StructureFormat::Mtg | StructureFormat::Opf)) = structure {
        return Ok(Output::Structure(format));
    }
    match files::extension(path) {
        Some(e) if e.eq_ignore_ascii_case("csv") => Ok(Output::Table),
        Some(e) if e.eq_ignore_ascii_case("glb") => Ok(Output::Model),
        _ => Err(Failure::bad_file(
            path,
            "light is written as a table (.csv), with the structure of the plant (.mtg, .opf) or on its model (.glb); end the name \
             with one of them",
        )),
    }
}

fn options_of(args: &LightArgs, usual: LightOptions) -> LightOptions {
    let stand = &args.stand;
    let spec = LightSpec {
        lines: stand.rays.unwrap_or(usual.spec.lines),
        bounces: stand.bounces.unwrap_or(usual.spec.bounces),
        soil_reflectance: stand.soil.unwrap_or(usual.spec.soil_reflectance),
        repeat_m: stand.repeat,
        ..usual.spec
    };
    let leaf = stand.leaf.map(|[reflectance, transmittance]| Optics { reflectance, transmittance });
    let wood = stand.wood.map(|reflectance| Optics { reflectance, transmittance: 0.0 });
    LightOptions { spec, leaf: leaf.unwrap_or(usual.leaf), wood: wood.unwrap_or(usual.wood), ..usual }
}

fn failure(what: &Path, error: LightError) -> Failure {
    match error {
        LightError::Cancelled(_) => Failure::Cancelled,
        e => Failure::bad_file(what, e),
    }
}

fn summary(args: &LightArgs, lit: &LitStand, tally: &LightTally, ms: f64) -> String {
    let f = &lit.figures;
    let made = [args.output.as_ref(), args.png.as_ref()].into_iter().flatten();
    let made: Vec<String> = made.map(|p| p.display().to_string()).collect();
    let made = if made.is_empty() { args.what.display().to_string() } else { made.join(", ") };
    let unit = f.unit.word();
    let shown = [
        ("fAPAR", f.fapar),
        ("LAI", f.leaf_area_index),
        ("k", f.extinction),
        ("sunlit", f.sunlit),
        ("leaves, over the open", f.leaf_share),
    ];
    let shown = shown.into_iter().filter_map(|(name, value)| Some(format!(", {name} {:.2}", value?)));
    let colours = if args.png.is_some()
        || args.output.as_deref().is_some_and(|p| matches!(output_of(p), Ok(Output::Model)))
    {
        format!("; colours to {:.3} {unit}/m2", tally.colours_to_per_m2)
    } else {
        String::new()
    };
    format!(
        "{made}: {} absorb {:.3} {unit} of {:.3} {unit}/m2{}{colours}; {ms:.0} ms",
        say::counted(tally.rows, "axis or organ", "axes and organs"),
        f.absorbed,
        f.incoming_per_m2,
        shown.collect::<String>()
    )
}
