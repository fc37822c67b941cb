//! `burgeon convert`: models to models, drawings to drawings, the structure of plants to structure and models.

use burgeon::formats::{
    CloudFormat, DrawingFormat, ExportSpec, ModelFormat, PngCache, ReadDrawing, Room, StructureFormat,
    read_drawings, write_cloud_ply, write_drawing, write_svg,
};
use burgeon::mesh::{Model, PointCloud};
use burgeon::{ItemReport, Report, RunReport, Seed, StructureModel, StructureOptions, Warning};

use crate::args::{ConvertArgs, PackWord, PlantFormat};
use crate::failure::{Failure, Outcome};
use crate::files::{self, Goal, Kind};
use crate::machine::Machine;
use crate::origin::Origin;
use crate::output::Outputs;
use crate::{inputs, picture, report, say, structure};

pub(crate) fn convert(args: &ConvertArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs =
        [("-o", Some(&args.output)), ("--png", args.png.as_ref()), ("--report", args.common.report.as_ref())];
    let mut outputs = Outputs::new(&outputs, &[&args.input])?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    let (input, kind) = match far_or_bare(args, &machine)? {
        Opened::Points(cloud) => return points(args, cloud, outputs, &machine),
        Opened::Other(input, kind) => (input, kind),
    };
    if let Kind::Structure(format) = kind {
        return structure_file(args, (input, format), outputs, &machine);
    }
    args.given.refuse(&["plant", "thickness_unit"], "files of structure", "it is no such file")?;
    check_used(args, kind)?;
    let is = |wanted: &str| files::extension(&args.output).is_some_and(|e| e.eq_ignore_ascii_case(wanted));
    let to_drawing = is("json") || is("svg");
    let mut item = match (kind, to_drawing) {
        (Kind::Drawing(format), true) => drawing(args, input, format, &mut outputs, &machine)?,
        (Kind::Project, true) => project(args, input, &mut outputs, &machine)?,
        // Handled above.
        (Kind::Structure(_), _) => return Err(Failure::Bug("the structure of a plant is no model".into())),
        (Kind::Model(_), false) => model(args, input, kind, &mut outputs, &machine)?,
        (Kind::Drawing(_), false) => {
            return Err(Failure::bad_file(
                &args.input,
                "is a drawing: it converts to .json and .svg; `burgeon sketch` makes a model of it",
            ));
        }
        (Kind::Project, false) => {
            return Err(Failure::bad_file(
                &args.input,
                "is a project: it converts to .json and .svg; `burgeon sketch` makes a model of it",
            ));
        }
        (Kind::Model(_), true) => {
            return Err(Failure::bad_file(
                &args.output,
                format_args!("a model converts to {}, not to a drawing", ModelFormat::written_endings()),
            ));
        }
    };
    item.timings_ms.total = machine.whole_ms();
    let mut run = RunReport::new("convert", args.seed);
    run.input.path = args.input.display().to_string();
    run.input.drawings = u64::from(to_drawing);
    run.items.push(item);
    run.ok = 1;
    report::finish(&run, &args.common, outputs)?;
    if !machine.quiet {
        let item = &run.items[0];
        item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", args.input.display())));
        let what = match kind {
            Kind::Model(_) => say::counted(item.counts.triangles, "triangle", "triangles"),
            Kind::Drawing(_) | Kind::Project | Kind::Structure(_) => format!("drawing \"{}\"", item.name),
        };
        say::line(&format!("{}: {what}; {:.0} ms", item.output, item.timings_ms.total));
    }
    Ok(())
}

fn model(
    args: &ConvertArgs,
    input: files::Input,
    kind: Kind,
    outputs: &mut Outputs,
    machine: &Machine,
) -> Outcome<ItemReport> {
    let format = files::plan_model(outputs, &args.output)?;
    args.given.only_if_holds(format.holds(Room::Packing), &["pack"], Room::Packing)?;
    let read_axes = read_axes(args)?;
    let (read, read_ms) = machine.timed(|| files::read_opened_model(&args.input, input, kind, &read_axes));
    let (model, _, mut warnings) = read?;
    outputs.check()?;
    machine.cancel.check()?;
    let (written, write_ms) = machine.timed(|| {
        let axes = files::axes(args.axes.up, args.axes.unit);
        let packing = args.pack.map(PackWord::packing);
        let goal = Goal { packing, ..Goal::new("-o", &args.output) };
        files::write_model(outputs, goal, &model, format, &axes, &mut PngCache::new())
    });
    warnings.extend(written?);
    if let Some(png) = &args.png {
        let spec = args.picture.spec(args.seed);
        let drawn =
            machine.with_progress("picture", |_| burgeon::render::render(&model, &spec, &machine.run()))?;
        picture::write(outputs, "--png", png, &drawn)?;
    }
    let mut item = picture::model_item(&model, &args.output, &warnings);
    item.timings_ms.add_io(read_ms, write_ms);
    Ok(item)
}

/// Returns axes and unit of a model or a cloud that is read.
fn read_axes(args: &ConvertArgs) -> Outcome<ExportSpec> {
    let unit = match args.structure.in_unit {
        None => args.axes.unit,
        Some(unit) => unit.unit().ok_or_else(|| {
            Failure::Bad("--in-unit: only files of structure have this unit; give m, cm or mm".into())
        })?,
    };
    Ok(files::axes(args.structure.in_up.or(args.axes.up), unit))
}

/// Converts the structure of a plant: to structure, where it stays in its place, or to a model.
fn structure_file(
    args: &ConvertArgs,
    (input, format): (files::Input, StructureFormat),
    mut outputs: Outputs,
    machine: &Machine,
) -> Outcome {
    let written = files::plan_plant(&mut outputs, &args.output, 0)?;
    let is_model = matches!(written, PlantFormat::Model(_));
    args.given.check_picture(args.png.is_some(), &args.picture)?;
    args.given.check_axes(written.holds(Room::Axes))?;
    args.given.only_if_holds(written.holds(Room::Packing), &["pack"], Room::Packing)?;
    let mut told = Report::default();
    let (read, read_ms) =
        machine.timed(|| structure::read(&args.input, input, format, &args.structure.spec(), &mut told));
    let (mut plant, tally) = structure::choose(&args.input, read?, args.plant.as_deref())?;
    outputs.check()?;
    machine.cancel.check()?;
    let mut item = ItemReport { name: plant.name.clone(), ..ItemReport::default() };
    let mut model = Model::default();
    if is_model || args.png.is_some() {
        let (options, seed) = (StructureOptions::default(), Seed::new(args.seed));
        let copy = plant.clone();
        let StructureModel { made, foot } =
            structure::make(&args.input, (copy, &tally), &options, seed, machine)?;
        if is_model {
            plant = made.plant;
            told.warnings.extend(structure::moved(foot).map(|message| Warning {
                code: "moved",
                message,
                fields: vec![],
            }));
        }
        (model, item) = (made.model, made.item);
    } else {
        item.warnings = structure::doubts(&plant, &tally);
    }
    item.output = args.output.display().to_string();
    item.warnings.splice(0..0, told.warnings.iter().map(ToString::to_string));
    let goal = Goal { packing: args.pack.map(PackWord::packing), ..Goal::new("-o", &args.output) };
    let cache = &mut PngCache::new();
    let (done, write_ms) = machine
        .timed(|| files::write_plant(&mut outputs, goal, (&plant, &model), written, &args.axes, cache));
    done?.tell(&mut item);
    if let Some(png) = &args.png {
        let spec = args.picture.spec(args.seed);
        let drawn =
            machine.with_progress("picture", |_| burgeon::render::render(&model, &spec, &machine.run()))?;
        picture::write(&mut outputs, "--png", png, &drawn)?;
    }
    if args.common.reports() {
        item.plant = Some(plant.measure());
    }
    item.timings_ms.add_io(read_ms, write_ms);
    item.timings_ms.total = machine.whole_ms();
    let mut run = RunReport::new("convert", args.seed);
    run.input.path = args.input.display().to_string();
    run.items.push(item);
    run.ok = 1;
    report::finish(&run, &args.common, outputs)?;
    if !machine.quiet {
        let item = &run.items[0];
        item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", args.input.display())));
        let nodes = say::counted(plant.nodes.position.len() as u64, "node", "nodes");
        let axes = say::counted(plant.axes.len() as u64, "axis", "axes");
        say::line(&format!("{}: {axes}, {nodes}; {:.0} ms", item.output, item.timings_ms.total));
    }
    Ok(())
}

/// Fails on unused options.
fn check_used(args: &ConvertArgs, kind: Kind) -> Outcome {
    let given = &args.given;
    let Kind::Model(read) = kind else {
        let png = ["png"];
        given.refuse(
            &png,
            "models",
            "a drawing has no picture; `burgeon sketch --png` makes one of its plant",
        )?;
        let others = [
            "size",
            "view",
            "frames",
            "background",
            "no_shadow",
            "supersample",
            "up",
            "unit",
            "in_up",
            "in_unit",
            "pack",
        ];
        return given.refuse(&others, "models", "a drawing is converted");
    };
    given.check_picture(args.png.is_some(), &args.picture)?;
    let written = files::writable(&args.output).is_ok_and(|f| f.holds(Room::Axes));
    given.only_if(
        read.holds(Room::Axes),
        &["in_up", "in_unit"],
        "models that do not fix their axes and unit",
        "glTF is in metres, +Y up",
    )?;
    given.check_axes(written || read.holds(Room::Axes))
}

/// A cloud, with the messages of its reader, the place of its origin and the time of reading.
struct Read {
    cloud: PointCloud,
    warnings: Vec<String>,
    origin: Origin,
    axes: ExportSpec,
    ms: f64,
}

/// Result of opening the input.
enum Opened {
    Points(Read),
    Other(files::Input, Kind),
}

/// Returns the points of a file that is read as a scan: of a format that holds nothing else, or so far from their
/// origin that they need double precision.
fn far_or_bare(args: &ConvertArgs, machine: &Machine) -> Outcome<Opened> {
    let path = &args.input;
    let other = || files::open(path).map(|(input, kind)| Opened::Other(input, kind));
    let (input, format, only) = if inputs::is_stdin(path) {
        let (input, start) = files::peek(path)?;
        match files::sniff_points(&start) {
            Some(format) => (input, format, true),
            None => return files::kind_of(path, &start).map(|kind| Opened::Other(input, kind)),
        }
    } else {
        let Some(format) = files::extension(path).and_then(CloudFormat::from_extension) else {
            return other();
        };
        if format == CloudFormat::Xyz && path.is_file() {
            let (input, start) = files::peek(path)?;
            // A table may hold cylinders as well as points.
            if let Some(structure) = StructureFormat::sniff(&start) {
                return Ok(Opened::Other(input, Kind::Structure(structure)));
            }
        }
        let only = !matches!(format, CloudFormat::Ply | CloudFormat::Obj);
        if !path.is_file() || (!only && files::has_faces(path)) {
            return other();
        }
        (files::open_bytes(path)?, format, only)
    };
    let axes = read_axes(args)?;
    let mut report = Report::default();
    let (cloud, ms) = machine.timed(|| files::read_cloud(path, (input, format), &axes, &mut report));
    let mut cloud = match cloud {
        Ok(cloud) => cloud,
        Err(e) if only => return Err(e),
        // The reader of models reports the fault.
        Err(_) => return other(),
    };
    let mut origin = Origin::default();
    origin.bring(&mut cloud.points, &axes, &mut report);
    cloud.offset_m = origin.offset_m;
    let warnings = report.warnings.iter().map(ToString::to_string).collect();
    if only || origin.offset_m.is_some() {
        return Ok(Opened::Points(Read { cloud, warnings, origin, axes, ms }));
    }
    other()
}

/// Converts a cloud: to PLY in double precision.
fn points(args: &ConvertArgs, read: Read, mut outputs: Outputs, machine: &Machine) -> Outcome {
    args.given.refuse(&["pack"], "models with faces", "points are converted")?;
    args.given.refuse(&["plant", "thickness_unit"], "files of structure", "points are converted")?;
    // Axes and unit always apply: no cloud fixes them.
    args.given.check_picture(args.png.is_some(), &args.picture)?;
    let format = files::writable(&args.output)?;
    let axes = files::axes(args.axes.up, args.axes.unit);
    let model = burgeon::cloud_model(&files::stem(&args.input), &read.cloud);
    let mut warnings = read.warnings;
    let (written, write_ms) = machine.timed(|| match format {
        ModelFormat::Ply => {
            outputs.write("-o", &args.output, |out| write_cloud_ply(&read.cloud, &axes, out)).map(|()| vec![])
        }
        _ => {
            let goal = Goal::new("-o", &args.output);
            files::write_model(&mut outputs, goal, &model, format, &axes, &mut PngCache::new())
        }
    });
    warnings.extend(written?.iter().map(ToString::to_string));
    let mut item = picture::model_item(&model, &args.output, &[]);
    if let Some(png) = &args.png {
        let spec = args.picture.spec(args.seed);
        let model = picture::with_dots(model);
        let drawn =
            machine.with_progress("picture", |_| burgeon::render::render(&model, &spec, &machine.run()))?;
        picture::write(&mut outputs, "--png", png, &drawn)?;
    }
    item.timings_ms.add_io(read.ms, write_ms);
    item.timings_ms.total = machine.whole_ms();
    item.warnings = warnings;
    let mut run = RunReport::new("convert", args.seed);
    run.input.path = args.input.display().to_string();
    run.input.offset_m = read.origin.offset_in(&read.axes);
    run.items.push(item);
    run.ok = 1;
    report::finish(&run, &args.common, outputs)?;
    if !machine.quiet {
        let item = &run.items[0];
        item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", args.input.display())));
        let count = say::counted(item.counts.vertices, "point", "points");
        say::line(&format!("{}: {count}; {:.0} ms", item.output, item.timings_ms.total));
    }
    Ok(())
}

fn project(
    args: &ConvertArgs,
    input: files::Input,
    outputs: &mut Outputs,
    machine: &Machine,
) -> Outcome<ItemReport> {
    let (read, read_ms) = machine.timed(|| {
        let document = files::read_project(&args.input, input)?;
        files::drawing_of(&args.input, &document).map(|(read, _)| read)
    });
    write(args, &read?, read_ms, outputs, machine)
}

fn drawing(
    args: &ConvertArgs,
    input: files::Input,
    format: DrawingFormat,
    outputs: &mut Outputs,
    machine: &Machine,
) -> Outcome<ItemReport> {
    let mut drawings = read_drawings(input, format, &files::stem(&args.input));
    let (first, read_ms) = machine.timed(|| drawings.next());
    let first = first.ok_or_else(|| Failure::bad_file(&args.input, "holds no drawing"))?;
    let first = first.map_err(|e| Failure::bad_file(&args.input, e))?;
    if drawings.next().is_some() {
        return Err(Failure::bad_file(
            &args.input,
            "holds several drawings, a .json or .svg file holds one; split the file by lines",
        ));
    }
    write(args, &first, read_ms, outputs, machine)
}

fn write(
    args: &ConvertArgs,
    first: &ReadDrawing,
    read_ms: f64,
    outputs: &mut Outputs,
    machine: &Machine,
) -> Outcome<ItemReport> {
    let svg = files::extension(&args.output).is_some_and(|e| e.eq_ignore_ascii_case("svg"));
    let (written, write_ms) = machine.timed(|| {
        outputs.write("-o", &args.output, |out| {
            if svg { write_svg(&first.drawing, out) } else { write_drawing(&first.drawing, out) }
        })
    });
    written?;
    let mut item = ItemReport {
        name: first.drawing.name.clone(),
        output: args.output.display().to_string(),
        warnings: first.warnings.iter().map(ToString::to_string).collect(),
        ..ItemReport::default()
    };
    item.timings_ms.add_io(read_ms, write_ms);
    Ok(item)
}
