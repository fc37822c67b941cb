//! `burgeon render`, and pictures for the other commands.

use std::path::Path;

use burgeon::formats::{ExportSpec, Room};
use burgeon::glam::DVec3;
use burgeon::mesh::{Model, TriMesh};
use burgeon::render::Picture;
use burgeon::{Counts, Digest, ItemReport, Report, RunReport, Seed, StructureOptions, Warning};

use crate::args::{RenderArgs, StructureArgs};
use crate::failure::{Failure, Outcome};
use crate::files::Kind;
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{files, report, say, structure};

pub(crate) fn render(args: &RenderArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    check_name(&args.output)?;
    let outputs = [("-o", Some(&args.output)), ("--report", args.common.report.as_ref())];
    let mut outputs = Outputs::new(&outputs, &[&args.input])?;
    let axes = files::axes(args.axes.up, args.axes.unit);
    args.given.check_picture(true, &args.picture)?;
    let (read, read_ms) = machine.timed(|| model_of(args, &axes, &machine));
    let (model, warnings) = read?;
    outputs.check()?;
    let spec = args.picture.spec(args.seed);
    let (picture, draw_ms) = machine.timed(|| {
        machine.with_progress("picture", |_| burgeon::render::render(&model, &spec, &machine.run()))
    });
    let picture = picture?;
    let (written, write_ms) = machine.timed(|| write(&mut outputs, "-o", &args.output, &picture));
    written?;
    let mut run = RunReport::new("render", args.seed);
    run.input.path = args.input.display().to_string();
    let mut item = model_item(&model, &args.output, &warnings);
    item.timings_ms.mesh = draw_ms;
    item.timings_ms.add_io(read_ms, write_ms);
    item.timings_ms.total = machine.whole_ms();
    run.items.push(item);
    run.ok = 1;
    report::finish(&run, &args.common, outputs)?;
    if !machine.quiet {
        let item = &run.items[0];
        item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", args.input.display())));
        let triangles = say::counted(item.counts.triangles, "triangle", "triangles");
        let size = format!("{}x{}", picture.width, picture.height);
        say::line(&format!(
            "{}: {size}, {triangles}; {:.0} ms",
            args.output.display(),
            item.timings_ms.total
        ));
    }
    Ok(())
}

/// Returns the model of a file, or of the plant of a file of structure, with the warnings about it.
fn model_of(args: &RenderArgs, axes: &ExportSpec, machine: &Machine) -> Outcome<(Model, Vec<Warning>)> {
    let path = &args.input;
    let (input, kind) = files::open(path)?;
    let Kind::Structure(format) = kind else {
        StructureArgs::refuse(&args.given, "a model is shown")?;
        args.given.refuse(&["plant"], "files of structure", "a model is shown")?;
        let (model, format, warnings) = files::read_opened_model(path, input, kind, axes)?;
        args.given.check_axes(format.holds(Room::Axes))?;
        return Ok((model, warnings));
    };
    let mut told = Report::default();
    let spec = args.structure.spec_of_input(&args.axes, &args.given);
    let read = structure::read(path, input, format, &spec, &mut told)?;
    let (plant, tally) = structure::choose(path, read, args.plant.as_deref())?;
    let (options, seed) = (StructureOptions::default(), Seed::new(args.seed));
    let made = structure::make(path, (plant, &tally), &options, seed, machine)?.made;
    told.warnings.extend(made.item.told);
    Ok((made.model, told.warnings))
}

/// Checks the name of a picture: pictures are PNG whatever the name, so the name must agree.
pub(crate) fn check_name(path: &Path) -> Outcome {
    if files::extension(path).is_some_and(|e| e.eq_ignore_ascii_case("png")) {
        Ok(())
    } else {
        Err(Failure::bad_file(path, "pictures are written as PNG; end the name with .png"))
    }
}

/// Makes a report's item about a model.
pub(crate) fn model_item(model: &Model, output: &Path, warnings: &[Warning]) -> ItemReport {
    let counts = Counts {
        vertices: model.vertex_count() as u64,
        triangles: model.triangle_count() as u64,
        ..Counts::default()
    };
    let mut digest = Digest::new();
    digest.add(model);
    ItemReport {
        name: model.name.clone(),
        output: output.display().to_string(),
        counts,
        digest: digest.hex(),
        warnings: warnings.iter().map(ToString::to_string).collect(),
        ..ItemReport::default()
    }
}

/// Writes a picture as PNG.
pub(crate) fn write(outputs: &mut Outputs, by: &str, path: &Path, picture: &Picture) -> Outcome {
    outputs.write(by, path, |out| {
        burgeon::formats::write_png(picture.width, picture.height, &picture.pixels, out)
    })
}

/// Replaces points by small tetrahedra.
pub(crate) fn with_dots(mut model: Model) -> Model {
    let size = model.bounds().size().max_element() * 0.0022;
    for part in model.parts.iter_mut().filter(|p| p.mesh.triangles.is_empty()) {
        // More than 40,000 dots show no more detail.
        let step = part.mesh.positions.len().div_ceil(40_000).max(1);
        let mut dots = TriMesh::default();
        for (row, p) in part.mesh.positions.iter().enumerate().step_by(step) {
            let color = part.mesh.colors.get(row).copied();
            let p = DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]));
            let corners = [
                DVec3::new(1.0, 1.0, 1.0),
                DVec3::new(-1.0, -1.0, 1.0),
                DVec3::new(-1.0, 1.0, -1.0),
                DVec3::new(1.0, -1.0, -1.0),
            ];
            let [a, b, c, d] = corners.map(|q| dots.push(p + q * size));
            dots.colors.extend(color.iter().flat_map(|c| [*c; 4]));
            dots.triangles.extend([[a, b, c], [a, d, b], [a, c, d], [b, d, c]]);
        }
        dots.compute_normals();
        part.mesh = dots;
    }
    model
}
