//! `burgeon shape`: hand edits on a plant of any maker.

use std::path::Path;

use burgeon::bloom::FlowerSpec;
use burgeon::document::{Document, PlantEdit};
use burgeon::formats::{PngCache, Room, StructureFormat, read_drawings};
use burgeon::glam::DVec3;
use burgeon::mesh::Model;
use burgeon::plant::Plant;
use burgeon::skin::SkinSpec;
use burgeon::{
    BranchRow, EditReport, FlowerOptions, ItemReport, LevelSpec, Levels, MadePlant, MadeTree, Preset, Report,
    RunReport, Seed, Stopped, StructureModel, StructureOptions, TreeError, TreeOptions, branch_rows,
    edits_schema, edits_template, make_flower, make_tree,
};

use crate::args::{PlantFormat, Seen, ShapeArgs, StructureArgs};
use crate::failure::{Failure, Outcome};
use crate::files::Kind;
use crate::levels::{Form, Whole};
use crate::machine::Machine;
use crate::materials::Materials;
use crate::output::Outputs;
use crate::{bloom, checks, edits, files, grow, inputs, levels, picture, project, report, say, structure};

/// A plant of any maker, with its meshes.
struct Shaped {
    plant: Plant,
    model: Model,
    levels: Levels,
    item: ItemReport,
    seed: Seed,
    /// The project with the edits.
    edited: Option<Document>,
}

pub(crate) fn shape(args: &ShapeArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = [
        ("-o", args.output.as_ref()),
        ("--png", args.png.as_ref()),
        ("--schema", args.schema.as_ref()),
        ("--save", args.save.as_ref()),
        ("--report", args.common.report.as_ref()),
    ];
    let inputs = args.what.iter().chain(&args.edits).chain(&args.leaves);
    let mut outputs = Outputs::new(&outputs, &inputs.collect::<Vec<_>>())?;
    if let Some(path) = &args.schema {
        let text = serde_json::to_string_pretty(&edits_schema())
            .map_err(|e| Failure::Bug(format!("the schema cannot be written as JSON: {e}")))?;
        outputs.write("--schema", path, |file| Ok(writeln!(file, "{text}")?))?;
    }
    let plan = |path| files::plan_plant(&mut outputs, path, args.surface.export.lod_files());
    let format = args.output.as_deref().map(plan).transpose()?;
    check_used(args, format)?;
    if args.template {
        out(edits_template().trim_end())?;
        return outputs.place();
    }
    let Some(what) = &args.what else { return outputs.place() };
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    let edits = args.edits.as_deref().map(edits::read).transpose()?.unwrap_or_default();
    let asked = edits.len();
    let mut told = Report::default();
    let spec = args.surface.export.levels(format);
    let made = machine.with_progress("shape", |_| make(args, (what, edits), &spec, &mut told, &machine))?;
    outputs.check()?;
    machine.cancel.check()?;
    let Shaped { plant, model, levels, mut item, seed, edited } = made;
    if let Some(path) = &args.edits {
        edits::some_done(path, &item, asked)?;
    }
    if let Some((path, document)) = args.save.as_ref().zip(edited) {
        project::save(&mut outputs, "--save", path, &document)?;
    }
    item.warnings.splice(0..0, told.warnings.iter().map(ToString::to_string));
    if args.common.reports() {
        item.plant = Some(plant.measure());
    }
    let mut items = vec![item];
    checks::accept(&items, &args.checks)?;
    if let Some((path, format)) = args.output.as_deref().zip(format) {
        let form = Form::new(path, format, &args.surface.export, &args.axes);
        let whole = Whole { plant: &plant, model: model.clone(), levels };
        levels::write(&mut outputs, &form, whole, &mut items, &mut PngCache::new(), &machine)?;
    }
    if let Some(png) = &args.png {
        let spec = args.picture.spec(seed.number());
        let drawn =
            machine.with_progress("picture", |_| burgeon::render::render(&model, &spec, &machine.run()))?;
        picture::write(&mut outputs, "--png", png, &drawn)?;
    }
    items[0].timings_ms.total = machine.whole_ms();
    let mut run = RunReport::new("shape", seed.number());
    run.engine = args.surface.export.report();
    run.input.path = what.display().to_string();
    run.ok = 1;
    if let Some(order) = args.list {
        items[0].branches = branch_rows(&plant, order);
    }
    run.items = items;
    report::finish(&run, &args.common, outputs)?;
    if !machine.quiet {
        let item = &run.items[0];
        item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", item.name)));
        edit_lines(&item.edits).iter().for_each(|line| say::line(line));
        say::line(&report::summary(item, args.png.as_deref()));
        run.items[1..].iter().for_each(|i| say::line(&report::summary(i, None)));
    }
    match args.list {
        // With --json, standard output is the report, which lists them.
        Some(_) if !args.common.json => list(&run.items[0].branches),
        _ => Ok(()),
    }
}

/// Returns a line for each edit that was done; one for all that follow one another and did the same.
fn edit_lines(edits: &[EditReport]) -> Vec<String> {
    let done: Vec<&EditReport> = edits.iter().filter(|e| e.done).collect();
    let alike = |a: &&EditReport, b: &&EditReport| a.said == b.said && a.index + 1 == b.index;
    let line = |same: &[&EditReport]| match same {
        [first, .., last] => format!("edits {} to {}, each: {}", first.index, last.index, first.said),
        _ => same.iter().map(|e| format!("edit {}: {}", e.index, e.said)).collect(),
    };
    done.chunk_by(alike).map(line).collect()
}

/// Fails on unused options.
fn check_used(args: &ShapeArgs, format: Option<PlantFormat>) -> Outcome {
    let given = &args.given;
    let plants = [
        "what",
        "edits",
        "output",
        "plant",
        "save",
        "png",
        "seed",
        "list",
        "strict",
        "report",
        "json",
        "leaves",
        "in_up",
        "in_unit",
        "thickness_unit",
    ];
    let users = "plants that are shaped";
    if args.template {
        given.refuse(&plants, users, "--template prints an example of edits")?;
    }
    if args.what.is_none() {
        given.refuse(&plants, users, "none is named")?;
    }
    given.check_picture(args.png.is_some(), &args.picture)?;
    given.check_surface(Seen::new(format, args.png.as_ref(), &args.common))?;
    args.surface.check_used(given, format, args.png.is_some())?;
    given.check_axes(format.is_some_and(|f| f.holds(Room::Axes)))
}

fn out(text: &str) -> Outcome {
    say::data(text).map_err(|e| Failure::io(Path::new("standard output"), "written", &e))
}

fn make(
    args: &ShapeArgs,
    (what, edits): (&Path, Vec<PlantEdit>),
    levels: &LevelSpec,
    told: &mut Report,
    machine: &Machine,
) -> Outcome<Shaped> {
    if let Some(spec) = bloom::species(what)? {
        not_structure(args, "a flower is made")?;
        return flower(args, (what, edits), &spec, levels, machine);
    }
    let seed = Seed::new(args.seed.unwrap_or(1));
    let is_preset = what.to_str().and_then(Preset::find).is_some() && !what.is_file();
    let is_spec = files::extension(what).is_none_or(|e| e.eq_ignore_ascii_case("toml"));
    let stdin = inputs::is_stdin(what).then(|| files::peek(what)).transpose()?;
    // A preset or a spec; from standard input, anything of no other kind.
    let piped = stdin.as_ref().map(|(_, start)| files::sniff(start));
    if is_preset || piped.map_or(is_spec, |kind| kind.is_none()) {
        no_project(args, what)?;
        not_structure(args, "a tree is grown")?;
        let spec = match stdin {
            Some((input, _)) => grow::spec_of(what, &files::text_of(what, input)?, told)?,
            None => grow::read_spec(what, told)?,
        };
        let skin = skin_of(args)?;
        let options = TreeOptions { skin, levels: *levels, edits, ..TreeOptions::default() };
        let made = make_tree(&spec, seed, &options, &machine.run()).map_err(|e| match e {
            TreeError::Cancelled(_) => Failure::Cancelled,
            other => Failure::bad_file(what, other),
        })?;
        let MadeTree { grown, model, levels, item, .. } = made;
        return Ok(Shaped { plant: grown.plant, model, levels, item, seed, edited: None });
    }
    let opened = match stdin {
        Some((input, start)) => (input, files::kind_of(what, &start)?),
        None => files::open(what)?,
    };
    if let (file, Kind::Structure(format)) = opened {
        return measured(args, (what, edits), (file, format), levels, told, machine);
    }
    not_structure(args, "it is no such file")?;
    let (document, id) = match opened {
        // Handled above.
        (_, Kind::Structure(_)) => return Err(Failure::Bug("a plant that was read is no document".into())),
        (file, Kind::Drawing(format)) => {
            args.given.refuse(&["plant"], "projects (.burgeon)", "a drawing is one plant")?;
            let mut drawings = read_drawings(file, format, &files::stem(what));
            let first = drawings.next().ok_or_else(|| Failure::bad_file(what, "holds no drawing"))?;
            let read = first.map_err(|e| Failure::bad_file(what, e))?;
            told.warnings.extend(read.warnings);
            let document = Document::from_drawing(&read.drawing);
            let id = project::choose(what, &document, None)?;
            (document, id)
        }
        (file, Kind::Project) => {
            let document = files::read_project(what, file)?;
            let id = project::choose(what, &document, args.plant.as_deref())?;
            (document, id)
        }
        (_, Kind::Model(format)) => {
            let what_it_is = format_args!(
                "is a model ({}), which has no branches to edit; give a preset, a spec or a drawing",
                format.word()
            );
            return Err(Failure::bad_file(what, what_it_is));
        }
    };
    let document = project::edited(what, document, id, edits)?;
    let asked = project::asked(what, &document, id, args.seed, &args.surface)?;
    let asked = match &args.surface.skin.materials {
        Some(path) => Materials::read(path)?.on(asked, id)?,
        None => asked,
    };
    let (plant, model, levels, item) = project::make((what, &asked, id), &args.surface, levels, machine)?;
    let seed = asked.plant(id).map_or(seed, |p| p.settings().seed);
    Ok(Shaped { plant, model, levels, item, seed, edited: Some(document) })
}

fn skin_of(args: &ShapeArgs) -> Outcome<SkinSpec> {
    let materials = args.surface.skin.materials.as_deref().map(Materials::read).transpose()?;
    Ok(SkinSpec { worn: materials.unwrap_or_default().worn(), ..args.surface.spec() })
}

/// Fails on options of files of structure for anything else, which in turn needs edits.
fn not_structure(args: &ShapeArgs, this: &str) -> Outcome {
    StructureArgs::refuse(&args.given, this)?;
    args.given.refuse(&["leaves"], "files of structure", this)?;
    if args.edits.is_none() && args.list.is_none() {
        let line = "--edits EDITS.json is missing: `burgeon shape --template` prints one";
        return Err(Failure::Bad(line.into()));
    }
    Ok(())
}

/// Makes a plant of a file of structure.
fn measured(
    args: &ShapeArgs,
    (what, edits): (&Path, Vec<PlantEdit>),
    (file, format): (files::Input, StructureFormat),
    levels: &LevelSpec,
    told: &mut Report,
    machine: &Machine,
) -> Outcome<Shaped> {
    let save = "is no project (.burgeon), which --save is for";
    args.save.as_ref().map_or(Ok(()), |_| Err(Failure::bad_file(what, save)))?;
    let leaves = args.leaves.as_deref().map(|what| grow::read_leaves(what, told)).transpose()?;
    let read = structure::read(what, file, format, &args.structure.spec(), told)?;
    let (plant, tally) = structure::choose(what, read, args.plant.as_deref())?;
    let seed = Seed::new(args.seed.unwrap_or(1));
    let options = StructureOptions { leaves, skin: skin_of(args)?, edits };
    let StructureModel { made, foot } = structure::make(what, (plant, &tally), &options, seed, machine)?;
    let levels = made.levels(levels, &machine.run()).map_err(|stopped| match stopped {
        Stopped::Cancelled(_) => Failure::Cancelled,
        Stopped::OverBudget(much) => Failure::bad_file(what, much),
    })?;
    let MadePlant { plant, model, mut item, .. } = made;
    item.warnings.extend(structure::moved(foot));
    Ok(Shaped { plant, model, levels, item, seed, edited: None })
}

/// Makes a flower in full bloom.
fn flower(
    args: &ShapeArgs,
    (what, edits): (&Path, Vec<PlantEdit>),
    spec: &FlowerSpec,
    levels: &LevelSpec,
    machine: &Machine,
) -> Outcome<Shaped> {
    no_project(args, what)?;
    args.given.refuse(
        &["textures", "no_textures"],
        "trees and drawings",
        "a flower has the colours of its species",
    )?;
    let seed = Seed::new(args.seed.unwrap_or(1));
    let options = FlowerOptions { skin: skin_of(args)?, edits };
    let run = machine.run();
    let failed = |stopped| match stopped {
        Stopped::Cancelled(_) => Failure::Cancelled,
        Stopped::OverBudget(much) => Failure::bad_file(what, much),
    };
    let day = (spec.opening_days, &spec.own_law());
    let made = make_flower(&spec.name, spec, day, &options, seed, &run).map_err(failed)?;
    let levels = made.levels(levels, &run).map_err(failed)?;
    let MadePlant { plant, model, item, .. } = made;
    Ok(Shaped { plant, model, levels, item, seed, edited: None })
}

/// Fails on options of projects for anything else.
fn no_project(args: &ShapeArgs, what: &Path) -> Outcome {
    let option = args.plant.as_ref().map(|_| "--plant").or(args.save.as_ref().map(|_| "--save"));
    match option {
        Some(option) => {
            Err(Failure::bad_file(what, format_args!("is no project (.burgeon), which {option} is for")))
        }
        None => Ok(()),
    }
}

fn list(branches: &[BranchRow]) -> Outcome {
    let mut lines = vec![format!(
        "{:<18}{:>6}{:>24}{:>9}{:>18}{:>9}{:>7}",
        "path", "at", "base, m", "length", "direction", "radius", "bears"
    )];
    for row in branches {
        let path = row.path.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        let b = row.base_m;
        lines.push(format!(
            "{:<18}{:>6.2}{:>24}{:>7.2} m{:>18}{:>6.1} cm{:>7}",
            format!("[{path}]"),
            row.at,
            format!("{:.2}, {:.2}, {:.2}", b.x, b.y, b.z),
            row.length_m,
            heading(row.direction),
            100.0 * row.radius_m,
            row.bears
        ));
    }
    out(&lines.join("\n"))
}

/// Describes the direction of a branch in words.
fn heading(d: DVec3) -> String {
    let mut words = Vec::new();
    if d.y.abs() > 0.5 {
        words.push(if d.y > 0.0 { "up" } else { "down" });
    }
    if d.x.abs() > 0.4 {
        words.push(if d.x > 0.0 { "right" } else { "left" });
    }
    if d.z.abs() > 0.4 {
        words.push(if d.z > 0.0 { "front" } else { "back" });
    }
    words.join(" ")
}
