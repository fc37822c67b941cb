//! `burgeon convert`: models to models, drawings to drawings.

use burgeon::formats::{
    CloudFormat, DrawingFormat, ExportSpec, ModelFormat, PngCache, ReadDrawing, read_drawings,
    write_cloud_ply, write_drawing,
};
use burgeon::mesh::PointCloud;
use burgeon::{ItemReport, Report, RunReport};

use crate::args::ConvertArgs;
use crate::bloom::with_dots;
use crate::failure::{Failure, Outcome};
use crate::files::{self, Kind};
use crate::machine::Machine;
use crate::origin::Origin;
use crate::{output, picture, report, say};

pub(crate) fn convert(args: &ConvertArgs) -> Outcome {
    let machine = Machine::new(args.common.threads, args.common.quiet || args.common.json);
    let outputs =
        [("-o", Some(&args.output)), ("--png", args.png.as_ref()), ("--report", args.common.report.as_ref())];
    output::check_outputs(&outputs, &[&args.input])?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    if let Some(cloud) = far_or_bare(args, &machine)? {
        return points(args, cloud, &machine);
    }
    let (input, kind) = files::open(&args.input)?;
    let to_drawing = files::extension(&args.output).is_some_and(|e| e.eq_ignore_ascii_case("json"));
    let mut item = match (kind, to_drawing) {
        (Kind::Drawing(format), true) => drawing(args, input, format, &machine)?,
        (Kind::Project, true) => project(args, input, &machine)?,
        (Kind::Model(_), false) => model(args, input, kind, &machine)?,
        (Kind::Drawing(_), false) => {
            return Err(Failure::at(
                &args.input,
                "is a drawing: it converts to .json only; `burgeon sketch` makes a model of it",
            ));
        }
        (Kind::Project, false) => {
            return Err(Failure::at(
                &args.input,
                "is a project: it converts to .json only; `burgeon sketch` makes a model of it",
            ));
        }
        (Kind::Model(_), true) => {
            return Err(Failure::at(
                &args.output,
                "a model converts to .glb, .obj, .ply, .stl or .usda, not to .json",
            ));
        }
    };
    item.timings_ms.total = machine.whole_ms();
    if !machine.quiet {
        item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", args.input.display())));
        let what = match kind {
            Kind::Model(_) => say::counted(item.counts.triangles, "triangle", "triangles"),
            Kind::Drawing(_) | Kind::Project => format!("drawing \"{}\"", item.name),
        };
        say::line(&format!("{}: {what}; {:.0} ms", item.output, item.timings_ms.total));
    }
    let mut run = RunReport::new("convert", args.seed);
    run.input.path = args.input.display().to_string();
    run.input.drawings = u64::from(to_drawing);
    run.items.push(item);
    run.ok = 1;
    report::finish(&run, &args.common)
}

fn model(args: &ConvertArgs, input: files::Input, kind: Kind, machine: &Machine) -> Outcome<ItemReport> {
    let format: ModelFormat = files::writable(&args.output)?;
    let read_axes = files::axes(args.in_up.or(args.axes.up), args.in_unit.unwrap_or(args.axes.unit));
    let (read, read_ms) = machine.timed(|| files::read_opened_model(&args.input, input, kind, &read_axes));
    let (model, _, mut warnings) = read?;
    machine.cancel.check()?;
    let (written, write_ms) = machine.timed(|| {
        let axes = files::axes(args.axes.up, args.axes.unit);
        files::write_model(&args.output, &model, format, &axes, &mut PngCache::new())
    });
    warnings.extend(written?);
    if let Some(png) = &args.png {
        let spec = args.picture.spec(args.seed);
        let drawn =
            machine.with_progress("picture", |_| burgeon::render::render(&model, &spec, &machine.run()))?;
        picture::write(png, &drawn)?;
    }
    let mut item = picture::model_item(&model, &args.output, &warnings);
    item.timings_ms.add_io(read_ms, write_ms);
    Ok(item)
}

/// A cloud, with what its reader says, where its origin is and how long reading took.
struct Read {
    cloud: PointCloud,
    warnings: Vec<String>,
    origin: Origin,
    axes: ExportSpec,
    ms: f64,
}

/// The points of a file that is read as a scan: of a format that holds nothing else, or so far from their origin that
/// they need double precision.
fn far_or_bare(args: &ConvertArgs, machine: &Machine) -> Outcome<Option<Read>> {
    let path = &args.input;
    let Some(format) = files::extension(path).and_then(CloudFormat::from_extension) else { return Ok(None) };
    let only = !matches!(format, CloudFormat::Ply | CloudFormat::Obj);
    if !path.is_file() || (!only && files::has_faces(path)) {
        return Ok(None);
    }
    let axes = files::axes(args.in_up.or(args.axes.up), args.in_unit.unwrap_or(args.axes.unit));
    let mut report = Report::default();
    let (cloud, ms) = machine.timed(|| files::read_cloud(path, format, &axes, &mut report));
    let mut cloud = match cloud {
        Ok(cloud) => cloud,
        Err(e) if only => return Err(e),
        // The reader of models says what is wrong.
        Err(_) => return Ok(None),
    };
    let mut origin = Origin::default();
    origin.bring(&mut cloud.points, &axes, &mut report);
    cloud.offset_m = origin.offset_m;
    let warnings = report.warnings.iter().map(ToString::to_string).collect();
    Ok((only || origin.offset_m.is_some()).then_some(Read { cloud, warnings, origin, axes, ms }))
}

/// Converts a cloud: to PLY in double precision.
fn points(args: &ConvertArgs, read: Read, machine: &Machine) -> Outcome {
    let format = files::writable(&args.output)?;
    let axes = files::axes(args.axes.up, args.axes.unit);
    let model = burgeon::cloud_model(&files::stem(&args.input), &read.cloud);
    let mut warnings = read.warnings;
    let (written, write_ms) = machine.timed(|| match format {
        ModelFormat::Ply => {
            output::write_whole(&args.output, |out| write_cloud_ply(&read.cloud, &axes, out)).map(|()| vec![])
        }
        _ => files::write_model(&args.output, &model, format, &axes, &mut PngCache::new()),
    });
    warnings.extend(written?.iter().map(ToString::to_string));
    let mut item = picture::model_item(&model, &args.output, &[]);
    if let Some(png) = &args.png {
        let spec = args.picture.spec(args.seed);
        let model = with_dots(model);
        let drawn =
            machine.with_progress("picture", |_| burgeon::render::render(&model, &spec, &machine.run()))?;
        picture::write(png, &drawn)?;
    }
    item.timings_ms.add_io(read.ms, write_ms);
    item.timings_ms.total = machine.whole_ms();
    item.warnings = warnings;
    if !machine.quiet {
        item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", args.input.display())));
        let count = say::counted(item.counts.vertices, "point", "points");
        say::line(&format!("{}: {count}; {:.0} ms", item.output, item.timings_ms.total));
    }
    let mut run = RunReport::new("convert", args.seed);
    run.input.path = args.input.display().to_string();
    run.input.offset_m = read.origin.told(&read.axes);
    run.items.push(item);
    run.ok = 1;
    report::finish(&run, &args.common)
}

fn no_picture(args: &ConvertArgs) -> Outcome {
    let why = "is a drawing; `burgeon sketch --png` makes a picture of its plant";
    if args.png.is_some() { Err(Failure::at(&args.input, why)) } else { Ok(()) }
}

fn project(args: &ConvertArgs, input: files::Input, machine: &Machine) -> Outcome<ItemReport> {
    no_picture(args)?;
    let (read, read_ms) = machine.timed(|| {
        let document = files::read_project(&args.input, input)?;
        files::drawing_of(&args.input, &document).map(|(read, _)| read)
    });
    write(args, &read?, read_ms, machine)
}

fn drawing(
    args: &ConvertArgs,
    input: files::Input,
    format: DrawingFormat,
    machine: &Machine,
) -> Outcome<ItemReport> {
    no_picture(args)?;
    let mut drawings = read_drawings(input, format, &files::stem(&args.input));
    let (first, read_ms) = machine.timed(|| drawings.next());
    let first = first.ok_or_else(|| Failure::at(&args.input, "holds no drawing"))?;
    let first = first.map_err(|e| Failure::at(&args.input, e))?;
    if drawings.next().is_some() {
        return Err(Failure::at(
            &args.input,
            "holds several drawings, a .json file holds one; split the file by lines",
        ));
    }
    write(args, &first, read_ms, machine)
}

fn write(args: &ConvertArgs, first: &ReadDrawing, read_ms: f64, machine: &Machine) -> Outcome<ItemReport> {
    let (written, write_ms) =
        machine.timed(|| output::write_whole(&args.output, |out| write_drawing(&first.drawing, out)));
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
