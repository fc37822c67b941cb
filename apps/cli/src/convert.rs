//! `burgeon convert`: models to models, drawings to drawings.

use burgeon::formats::{DrawingFormat, ModelFormat, PngCache, ReadDrawing, read_drawings, write_drawing};
use burgeon::{ItemReport, RunReport};

use crate::args::ConvertArgs;
use crate::failure::{Failure, Outcome};
use crate::files::{self, Kind};
use crate::machine::Machine;
use crate::{output, picture, report, say};

pub(crate) fn convert(args: &ConvertArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs =
        [("-o", Some(&args.output)), ("--png", args.png.as_ref()), ("--report", args.common.report.as_ref())];
    output::check_outputs(&outputs, &[&args.input])?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    let (input, kind) = files::open(&args.input)?;
    let to_drawing = files::extension(&args.output).is_some_and(|e| e.eq_ignore_ascii_case("json"));
    let item = match (kind, to_drawing) {
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
