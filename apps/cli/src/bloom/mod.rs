//! `burgeon bloom`: laws, shapes at any day, whole flowers that open.

mod at;
mod flowers;
mod scans;
mod told;
mod write;

use std::path::{Path, PathBuf};

use burgeon::bloom::{FlowerSpec, GrowthLaw};
use burgeon::document::PlantEdit;
use burgeon::formats::{ModelFormat, Room};
use burgeon::mesh::Model;
use burgeon::plant::Plant;
use burgeon::{CheckReport, Levels};

use crate::args::{BloomCommand, BloomRunArgs, EXPORT, PlantFormat};
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::petals::is_drawing;
use crate::{edits, files, fit, picture};

pub(crate) use flowers::species;

pub(crate) fn bloom(command: &BloomCommand) -> Outcome {
    match command {
        BloomCommand::Fit(args) => fit::fit(args),
        BloomCommand::Run(args) => run(args),
        BloomCommand::At(args) => at::tell_days(args),
    }
}

fn read_law(path: &Path) -> Outcome<GrowthLaw> {
    let text = files::read_text(path)?;
    let law: GrowthLaw = serde_json::from_str(&text).map_err(|e| {
        Failure::bad_file(
            path,
            format_args!(
                "is no growth law: {}; make one with `burgeon bloom fit`",
                burgeon::plainly(&e.to_string())
            ),
        )
    })?;
    let fault = law.validate().next();
    match fault {
        Some(fault) => Err(Failure::bad_file(path, format_args!("cannot be used: {fault}"))),
        None => Ok(law),
    }
}

/// Results at a day.
struct Shown {
    /// `None` for scans, of which only points are known.
    plant: Option<Plant>,
    model: Model,
    /// Coarser copies and other levels, of one shape.
    levels: Levels,
    /// Share of petal triangles that cross another petal.
    overlap: Option<f64>,
    /// Checks of the plant, if they belong to this day.
    checks: Vec<CheckReport>,
}

type Shape<'a> = Box<dyn FnMut(f64) -> Outcome<Shown> + 'a>;

/// Shapes over time, from any source.
struct Show<'a> {
    name: String,
    /// First and last day, in the user's count.
    days: [f64; 2],
    /// Default day of a picture.
    best: f64,
    shape: Shape<'a>,
}

/// Plans the outputs of `run`: -o is a file, or a folder for the shapes of all days.
fn planned(args: &BloomRunArgs) -> Outcome<Outputs> {
    let start = PathBuf::from(&args.start);
    let inputs = [
        Some(&start),
        args.end.as_ref(),
        args.petal.as_ref(),
        args.law.as_ref(),
        args.compare.as_ref(),
        args.edits.as_ref(),
    ];
    let mut outputs = Outputs::new(&[], &inputs.into_iter().flatten().collect::<Vec<_>>())?;
    match (files::extension(&args.output), args.day) {
        (Some(_), _) => {
            outputs.plan("-o", &args.output)?;
            files::plan_plant(&mut outputs, &args.output, args.export.lod_files())?;
        }
        (None, Some(_)) => {
            let endings = ModelFormat::written_endings();
            return Err(Failure::bad_file(
                &args.output,
                format_args!("has no extension; end it with {endings}"),
            ));
        }
        // Made first: a report may lie in it.
        (None, None) => outputs.folder(&args.output)?,
    }
    if let Some(png) = &args.png {
        picture::check_name(png)?;
        outputs.plan("--png", png)?;
    }
    if let Some(report) = &args.common.report {
        outputs.plan("--report", report)?;
    }
    Ok(outputs)
}

fn run(args: &BloomRunArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = planned(args)?;
    let law = args.law.as_deref().map(read_law).transpose()?;
    if args.day.is_some_and(|d| !d.is_finite()) {
        return Err(Failure::Bad("--day must be a finite number".into()));
    }
    let start = Path::new(&args.start);
    check_used(args)?;
    if let Some(spec) = species(start)? {
        return flowers::flower(args, spec, law, outputs, &machine);
    }
    let flowers = format!("whole flowers ({})", FlowerSpec::PRESETS.join(", "));
    args.given.refuse(&["petal"], &flowers, &format!("{} is none", args.start))?;
    if is_drawing(start) {
        return flowers::drawn_flower(args, start, law, outputs, &machine);
    }
    if args.plant {
        plant_formats(args)?;
    } else {
        let plants = [&["wind", "edits", "materials"], &EXPORT[..]].concat();
        let users = format!("{flowers}, drawings and scans with --plant");
        args.given.refuse(&plants, &users, &format!("{} is none", args.start))?;
    }
    scans::run(args, law, outputs, &machine)
}

/// Fails on options that the files of plants do not use.
fn plant_formats(args: &BloomRunArgs) -> Outcome {
    let folder = files::extension(&args.output).is_none();
    let written =
        if folder { PlantFormat::Model(args.format.0) } else { files::plant_writable(&args.output)? };
    let wind = written.holds(Room::Wind);
    args.given.only_if(
        // An animation moves its vertices itself.
        wind && !args.is_film(),
        &["wind"],
        &format!("models of one day (--day) as {}", ModelFormat::endings_with(Room::Wind)),
        "none is made",
    )?;
    // Scans have their own axes and unit.
    if args.plant { Ok(()) } else { args.given.check_axes(written.holds(Room::Axes)) }
}

/// Returns the warning about a law that sets no pace.
fn no_pace(args: &BloomRunArgs, law: &GrowthLaw) -> Option<String> {
    let path = args.law.as_ref().filter(|_| !law.sets_pace())?;
    Some(format!(
        "{}: its stages determine no law that moves: everything goes at an even pace",
        path.display()
    ))
}

/// Fails on options that this kind of output does not use.
fn check_used(args: &BloomRunArgs) -> Outcome {
    let given = &args.given;
    let picture = ["size", "view"];
    given.only_if(args.png.is_some(), &picture, "pictures", "--png FILE.png, which makes one, is missing")?;
    let extension = files::extension(&args.output);
    let film = args.is_film();
    let several = film || args.one_day().is_none() && extension.is_none();
    let one = "one shape is written";
    let films = format!("animations ({} without --day)", ModelFormat::endings_with(Room::Morphs));
    given.only_if(several, &["frames"], &format!("{films} and folders"), one)?;
    given.only_if(film, &["seconds"], &films, "none is written")?;
    let structure = extension.and_then(PlantFormat::from_extension);
    let structure = structure.is_some_and(|format| format.model().is_none());
    let moving = ModelFormat::endings_with(Room::Morphs);
    let users = format!("models of one shape (--day, or another format than {moving})");
    given.only_if(!several && !structure, &EXPORT, &users, "none is written")?;
    if let Some(format) = (!several).then_some(extension).flatten().and_then(PlantFormat::from_extension) {
        given.refuse(&["foliage"], "trees and drawings of them", "leaves of a flower have their own form")?;
        args.export.check_used(given, (Some(format), args.png.is_some()), true)?;
    }
    given.only_if(
        extension.is_none(),
        &["format"],
        "folders",
        "-o names a file, whose extension says its format",
    )
}

/// Returns the requested hand edits.
fn hand_edits(args: &BloomRunArgs) -> Outcome<Vec<PlantEdit>> {
    Ok(args.edits.as_deref().map(edits::read).transpose()?.unwrap_or_default())
}
