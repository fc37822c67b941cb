//! `burgeon leaf`: measured marks to a leaf or a whole plant.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use burgeon::formats::{PngCache, Room, marks_template, read_picture, write_marks, write_rays};
use burgeon::geom::RingRule;
use burgeon::glam::DVec3;
use burgeon::leaf::{
    FullMarks, LeafGrowth, LeafPaint, LeafSpec, Marks, PalmateSpec, ParallelSpec, Rays, ScanSpec,
    ThicknessRule, VeinParameters,
};
use burgeon::skin::SkinSpec;
use burgeon::{ItemReport, LeafError, LeafOptions, MadePlant, Report, RunReport, Seed, ShootSpec};
use companions::LIMITS;

use crate::args::{AxesArgs, EXPORT, LeafArgs, ParametersWord, RingsWord, SurfaceWord, VenationWord};
use crate::failure::{Failure, Outcome};
use crate::leaf_data::{self, Form, ReadLeaf};
use crate::levels::Whole;
use crate::machine::Machine;
use crate::materials::Materials;
use crate::origin::Origin;
use crate::output::Outputs;
use crate::{checks, edits, files, levels, picture, report, say};

pub(crate) fn leaf(args: &LeafArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = [
        ("-o", args.output.as_ref()),
        ("--png", args.png.as_ref()),
        ("--marks", args.marks.as_ref()),
        ("--report", args.common.report.as_ref()),
    ];
    let picture = Some(&args.look.texture)
        .filter(|t| !["veins", "plain", "scan"].iter().any(|word| t.as_os_str() == *word));
    let mut outputs =
        Outputs::new(&outputs, &args.inputs.iter().chain(picture).chain(&args.edits).collect::<Vec<_>>())?;
    check_used(args)?;
    if args.template {
        return template(args, outputs);
    }
    if args.inputs.is_empty() && args.venation.is_none() {
        return Err(Failure::Bad(
            "burgeon leaf needs a file of marks; --template makes one to fill in (see --help)".into(),
        ));
    }
    if args.output.is_none()
        && args.marks.is_none()
        && args.png.is_none()
        && args.common.report.is_none()
        && !args.common.json
    {
        return Err(Failure::Bad(
            "say what to make of it: -o OUT, --png FILE.png, --report FILE.json or --json".into(),
        ));
    }
    let format = args
        .output
        .as_deref()
        .map(|p| files::plan_plant(&mut outputs, p, args.export.lod_files()))
        .transpose()?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    if let Some(format) = format {
        // Input may be in any unit; a leaf made from numbers alone has only the unit of the output.
        args.given.check_axes(!args.inputs.is_empty() || format.holds(Room::Axes))?;
    }
    let blown = format.is_some_and(|format| format.holds(Room::Wind));
    args.given.only_if_holds(blown, &["wind"], Room::Wind)?;
    args.given.refuse(&["foliage"], "trees and drawings", "the leaf that is made has its own form")?;
    args.export.check_used(&args.given, (format, args.png.is_some()), true)?;
    let Product { mut made, marks, offset_m } =
        if args.scan { scan(args, &machine)? } else { make(args, &machine)? };
    machine.cancel.check()?;
    let item = std::mem::take(&mut made.item);
    if let Some(path) = &args.edits {
        edits::some_done(path, &item, item.edits.len())?;
    }
    let levels = made.levels(&args.export.levels(format), &machine.run());
    let mut levels = levels.map_err(|e| failure(args, e.into()))?;
    let without = levels.copies.iter_mut().map(|(rest, _)| rest);
    levels.lods.iter_mut().chain(without).for_each(|m| m.offset_m = made.model.offset_m);
    if let (Some(path), Some(marks)) = (&args.marks, &marks) {
        outputs.write("--marks", path, |out| match marks {
            Measured::Rows(marks) => write_marks(marks, &item.name, out),
            Measured::Rays(rays) => write_rays(rays, &item.name, out),
        })?;
    }
    let mut items = vec![item];
    checks::accept(&items, &args.checks)?;
    if let Some((path, format)) = args.output.as_deref().zip(format) {
        // --unit and --up applied to the input: glTF in metres with +Y up is expected.
        let plain = !format.holds(Room::Axes) && !args.inputs.is_empty();
        let axes = if plain { &AxesArgs::default() } else { &args.axes };
        let form = levels::Form::new(path, format, &args.export, axes);
        let whole = Whole { plant: &made.plant, model: made.model.clone(), levels };
        levels::write(&mut outputs, &form, whole, &mut items, &mut PngCache::new(), &machine)?;
    }
    if let Some(png) = &args.png {
        let spec = args.picture.spec(args.seed);
        let drawn = machine
            .with_progress("picture", |_| burgeon::render::render(&made.model, &spec, &machine.run()))?;
        picture::write(&mut outputs, "--png", png, &drawn)?;
    }
    items[0].timings_ms.total = machine.whole_ms();
    let mut run = RunReport::new("leaf", args.seed);
    run.engine = args.export.report();
    run.input.offset_m = offset_m;
    run.input.path = args.inputs.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(", ");
    run.items = items;
    run.ok = 1;
    report::finish(&run, &args.common, outputs)?;
    if !machine.quiet {
        let item = &run.items[0];
        item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", run.input.path)));
        say::line(&summary(item, args.png.as_deref()));
        run.items[1..].iter().for_each(|i| say::line(&report::summary(i, None)));
    }
    Ok(())
}

/// Fails on options that this kind of leaf does not use, as far as the command line gives the kind.
fn check_used(args: &LeafArgs) -> Outcome {
    let given = &args.given;
    given.only_if(args.template, &["rows"], "--template", "no template is written")?;
    if args.template {
        for options in [&MESH[..], &SURFACE, &LOOK, &PLANT, &MADE, &EXPORT] {
            given.refuse(options, "leaves that are made", "--template writes a file to fill in")?;
        }
    }
    given.check_picture(args.png.is_some(), &args.picture)?;
    given.only_if(args.plant.plant, &PLANT[1..], "--plant", "a single leaf is made")?;
    if args.plant.plant {
        given.refuse(&["marks"], "single leaves", "a whole plant has no marks")?;
    }
    let growth = !args.look.days.is_empty();
    given.only_if(growth, &["day"], "--days", "no stages are named")?;
    let nurbs = matches!(args.shape.surface, SurfaceWord::Nurbs);
    given.only_if(nurbs, &["vein_weight"], "--surface nurbs", "this blade is of another kind")?;
    let palmate = args.venation == Some(VenationWord::Palmate);
    given.only_if(palmate, &["depth"], "--venation palmate", "this leaf is none")?;
    given.only_if(
        args.venation.is_some(),
        &["veins"],
        "--venation",
        "this leaf has the veins of its data",
    )?;
    if args.venation.is_some() {
        let measured = ["thickness", "graph", "number"];
        given.refuse(&measured, "measured leaves", "--venation makes one from numbers")?;
    }
    if args.venation == Some(VenationWord::Parallel) {
        given.refuse(&["side_veins"], "lobed leaves", "parallel veins have none between them")?;
    }
    if args.scan {
        let others = ["thickness", "side_veins", "graph", "length", "number", "materials"];
        for options in [&MESH[..], &SURFACE, &LOOK[..3], &others] {
            given.refuse(options, "leaves of marks and veins", "--scan makes the surface that it finds")?;
        }
        if given.has("texture")
            && !["scan", "plain"].iter().any(|word| args.look.texture.as_os_str() == *word)
        {
            return Err(Failure::Bad(format!(
                "--texture {}: a leaf of a scan has the colours of its points (scan) or is plain",
                args.look.texture.display()
            )));
        }
    } else if args.look.texture.as_os_str() == "scan" {
        return Err(Failure::Bad(
            "--texture scan is for leaves of scans: give one with --scan, or say veins or plain".into(),
        ));
    }
    Ok(())
}

/// Options for meshing blade and veins.
const MESH: [&str; 6] = ["subdivisions", "sides", "rings", "caps", "margin_vein", "wind"];
/// Options for the surface of the blade.
const SURFACE: [&str; 3] = ["surface", "parameters", "vein_weight"];
/// Options for bending and painting the leaf, its paint last.
const LOOK: [&str; 4] = ["curl", "wilt", "ball", "texture"];
/// Options of a whole plant, and those that only a plant has.
const PLANT: [&str; 5] = ["plant", "leaves", "height", "azimuth", "edits"];
/// Other options that only a leaf with meshes has.
const MADE: [&str; 14] = [
    "strict",
    "materials",
    "number",
    "length",
    "thickness",
    "side_veins",
    "graph",
    "png",
    "marks",
    "inputs",
    "up",
    "unit",
    "report",
    "json",
];

fn template(args: &LeafArgs, mut outputs: Outputs) -> Outcome {
    let text = marks_template(args.rows as usize);
    match &args.output {
        Some(path) => {
            outputs.write("-o", path, |out| Ok(out.write_all(text.as_bytes())?))?;
            outputs.place()
        }
        None => {
            say::data(text.trim_end()).map_err(|e| Failure::io(Path::new("standard output"), "written", &e))
        }
    }
}

fn summary(item: &ItemReport, png: Option<&Path>) -> String {
    let line = report::summary(item, png);
    match &item.leaf {
        Some(l) if l.scan.is_some() => {
            let f = &l.fit_error;
            let fit = format!(
                "{:.0} mm long, RMS {:.2} mm, 95 % within {:.2} mm, {:.1} % of the cloud explained",
                l.length_mm,
                f.rms_mm,
                f.p95_mm,
                100.0 * f.explained
            );
            line.replacen("; ", &format!(", {fit}; "), 1)
        }
        Some(l) => {
            let counts = format!(
                "{} rows, {:.0} mm, veins {}/{}, blade {}/{}",
                l.rows, l.length_mm, l.veins.vertices, l.veins.faces, l.blade.vertices, l.blade.faces
            );
            line.replacen("; ", &format!(", {counts}; "), 1)
        }
        None => line,
    }
}

/// Collects the settings from the options.
fn options(args: &LeafArgs, in_file: Option<ThicknessRule>) -> Outcome<LeafOptions> {
    let (shape, look) = (&args.shape, &args.look);
    let (texture, picture) = match look.texture.to_str() {
        Some("veins") => (LeafPaint::Veins, None),
        Some("plain") => (LeafPaint::Plain, None),
        _ => {
            let path = &look.texture;
            let picture = read_picture(&files::read_bytes(path, LIMITS.picture)?);
            let picture = picture
                .ok_or_else(|| Failure::bad_file(path, "is no PNG or JPEG picture that can be read"))?;
            (LeafPaint::default(), Some(Arc::new(picture)))
        }
    };
    let spec = LeafSpec {
        surface: shape.surface.into(),
        curl: look.curl,
        wilt: look.wilt,
        balls: look.ball.clone(),
        texture,
        thickness: in_file.or(shape.thickness.map(Into::into)),
        parameters: match shape.parameters {
            ParametersWord::Shared => VeinParameters::Shared,
            ParametersWord::Own => VeinParameters::Own,
        },
        vein_weight: shape.vein_weight,
        rings: match shape.rings {
            RingsWord::Plain => RingRule::Plain,
            RingsWord::Envelope => RingRule::Envelope,
        },
        subdivisions: shape.subdivisions,
        sides: shape.sides,
        caps: shape.caps,
        margin_vein: shape.margin_vein,
        ..LeafSpec::default()
    };
    let side_veins =
        args.side_veins.unwrap_or(if args.venation == Some(VenationWord::Palmate) { 4 } else { 0 });
    let materials = args.materials.as_deref().map(Materials::read).transpose()?;
    let worn = materials.unwrap_or_default().worn();
    let skin = SkinSpec { wind: args.wind || args.export.sway, worn, ..SkinSpec::default() };
    let edits = args.edits.as_deref().map(edits::read).transpose()?.unwrap_or_default();
    Ok(LeafOptions { spec, skin, picture, side_veins, edits })
}

/// Result before it is written.
struct Product {
    made: MadePlant,
    marks: Option<Measured>,
    /// Offset subtracted from a scan's coordinates.
    offset_m: Option<[f64; 3]>,
}

/// Content of `--marks`.
enum Measured {
    Rows(Marks),
    Rays(Rays),
}

/// Size above which a scanned leaf suggests another unit, metres.
const LARGEST_M: f64 = 3.0;
/// Size below which a scanned leaf suggests another unit, metres.
const SMALLEST_M: f64 = 0.002;
/// Usual size of scanned leaves, metres: of two units, the one that gives a leaf nearer to it is likelier.
const USUAL_M: f64 = 0.08;

/// Tries another unit where none was given and metres give no plausible leaf; warns of this, and of a given unit that
/// gives none.
fn check_unit(args: &LeafArgs, points: &mut [DVec3], report: &mut Report) {
    let finite = || points.iter().filter(|p| p.is_finite());
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let [low, high] = finite().fold(none, |[a, b], &p| [a.min(p), b.max(p)]);
    let size = (high - low).max_element();
    if !(size > 0.0 && size.is_finite()) {
        return;
    }
    if args.given.has("unit") {
        if !(SMALLEST_M..=LARGEST_M).contains(&size) {
            doubtful(report, size);
        }
        return;
    }
    if size <= LARGEST_M {
        if size < SMALLEST_M {
            doubtful(report, size);
        }
        return;
    }
    let away = |scale: f64| {
        let ratio = size * scale / USUAL_M;
        ratio.max(1.0 / ratio)
    };
    let (word, name, scale) =
        if away(0.01) < away(0.001) { ("cm", "centimetres", 0.01) } else { ("mm", "millimetres", 0.001) };
    points.iter_mut().for_each(|p| *p *= scale);
    report.warn(
        "unit-guessed",
        format!(
            "the cloud is {size:.1} wide, which is no leaf in metres: it was taken for {name}, {:.0} mm; --unit {word} says \
             so, --unit mm, cm or m something else",
            1e3 * size * scale
        ),
    );
}

fn doubtful(report: &mut Report, size: f64) {
    report.warn(
        "unit-doubtful",
        format!(
            "the cloud is {size:.6} m wide in the unit that was taken, which is no leaf; is --unit right?"
        ),
    );
}

/// Makes a leaf of a scan.
fn scan(args: &LeafArgs, machine: &Machine) -> Outcome<Product> {
    let [path] = args.inputs.as_slice() else {
        return Err(Failure::Bad("--scan takes one cloud, of one leaf; give one file".into()));
    };
    let mut report = Report::default();
    let axes = files::axes(args.axes.up, args.axes.unit);
    let opened = files::open_cloud(path)?;
    let (cloud, read_ms) = machine.timed(|| files::read_cloud(path, opened, &axes, &mut report));
    let mut cloud = cloud?;
    args.given.only_if(!cloud.colors.is_empty(), &["texture"], "clouds with colours", "this one has none")?;
    if args.look.texture.as_os_str() == "plain" {
        cloud.colors.clear();
    }
    check_unit(args, &mut cloud.points, &mut report);
    let mut origin = Origin::default();
    origin.bring(&mut cloud.points, &axes, &mut report);
    let made = machine.with_progress("scan", |_| {
        let (name, spec) = (files::stem(path), ScanSpec::default());
        burgeon::make_leaf_from_scan(&name, &cloud, &spec, &machine.run())
    });
    let (mut made, found) = made.map_err(|e| failure(args, e))?;
    made.model.offset_m = origin.offset_m;
    let item = &mut made.item;
    item.warnings.splice(0..0, report.warnings.iter().map(ToString::to_string));
    item.timings_ms.add_io(read_ms, 0.0);
    let offset_m = origin.offset_in(&axes);
    Ok(Product { made, marks: Some(Measured::Rows(found.marks)), offset_m })
}

fn make(args: &LeafArgs, machine: &Machine) -> Outcome<Product> {
    if let Some(word) = args.venation {
        let (name, veins) = veins_of(args, word)?;
        let leaf = ReadLeaf {
            name: name.into(),
            form: Form::Rays(Rays::default()),
            thickness: None,
            warnings: vec![],
        };
        return rays(args, leaf, veins, machine);
    }
    let several = args.plant.plant || !args.look.days.is_empty();
    if args.inputs.len() > 1 && !several {
        return Err(Failure::Bad(
            "several files make one leaf only with --days (stages of one leaf) or --plant (a whole plant)"
                .into(),
        ));
    }
    let (read, read_ms) =
        machine.timed(|| args.inputs.iter().map(|p| leaf_data::read(p, args)).collect::<Outcome<Vec<_>>>());
    let mut read = read?;
    if let [ReadLeaf { form: Form::Rays(veins), .. }] = read.as_mut_slice() {
        let veins = std::mem::take(veins);
        let leaf = read.remove(0);
        let mut product = rays(args, leaf, veins, machine)?;
        product.made.item.timings_ms.add_io(read_ms, 0.0);
        return Ok(product);
    }
    args.given.refuse(&["side_veins"], "leaves of chief veins", "this is one of rows of marks")?;
    let name = read.first().map_or_else(|| "leaf".into(), |r| r.name.clone());
    let options = options(args, read.iter().find_map(|r| r.thickness))?;
    let seed = Seed::new(args.seed);
    let mut report = Report::default();
    let mut full = Vec::with_capacity(read.len());
    for (one, path) in read.iter().zip(&args.inputs) {
        let Form::Rows(marks) = &one.form else {
            let why = "is a leaf of chief veins; --plant and --days are for leaves of rows of marks";
            return Err(Failure::bad_file(path, why));
        };
        report.warnings.extend(one.warnings.iter().cloned());
        full.push(marks.complete(&mut report).map_err(|e| Failure::bad_file(path, e))?);
    }
    let (mut made, marks) = if args.plant.plant {
        let spec = ShootSpec {
            leaves: args.plant.leaves,
            height_m: args.plant.height,
            azimuth_deg: args.plant.azimuth,
            ..ShootSpec::default()
        };
        let made = machine.with_progress("plant", |_| {
            burgeon::make_shoot("plant", &full, &spec, &options, seed, &machine.run())
        });
        let mut made = made.map_err(|e| failure(args, e))?;
        made.item.warnings.splice(0..0, report.warnings.iter().map(ToString::to_string));
        (made, None)
    } else {
        let marks = grown(args, full)?;
        let made = burgeon::make_leaf_of(&name, &marks, &options, seed, &machine.run(), report);
        let made = made.map_err(|e| failure(args, e))?;
        let shaped = options.spec.shaped(&marks).map_err(|e| failure(args, e.into()))?;
        (made, Some(Measured::Rows(shaped.to_marks())))
    };
    made.item.timings_ms.add_io(read_ms, 0.0);
    Ok(Product { made, marks, offset_m: None })
}

/// Makes a leaf of chief veins, from numbers or digitised.
fn rays(args: &LeafArgs, leaf: ReadLeaf, rays: Rays, machine: &Machine) -> Outcome<Product> {
    for options in [&SURFACE[..], &["texture", "margin_vein", "plant", "days"]] {
        args.given.refuse(options, "leaves of rows of marks", "this is one of chief veins")?;
    }
    let options = options(args, leaf.thickness)?;
    let made = burgeon::make_ray_leaf(&leaf.name, &rays, &options, &machine.run());
    let mut made = made.map_err(|e| failure(args, e))?;
    made.item.warnings.splice(0..0, leaf.warnings.iter().map(ToString::to_string));
    let rays = options.spec.shaped_rays(&rays).map_err(|e| failure(args, LeafError::from(e)))?;
    Ok(Product { made, marks: Some(Measured::Rays(rays)), offset_m: None })
}

/// Makes the chief veins of --venation.
fn veins_of(args: &LeafArgs, word: VenationWord) -> Outcome<(&'static str, Rays)> {
    Ok(match word {
        VenationWord::Palmate => {
            let spec = PalmateSpec::default();
            let veins = odd(args.veins.unwrap_or(spec.veins), 11)?;
            let length_m = args.length.unwrap_or(spec.length_m);
            ("palmate", Rays::palmate(&PalmateSpec { veins, length_m, depth: args.depth }))
        }
        VenationWord::Parallel => {
            let spec = ParallelSpec::default();
            let veins = odd(args.veins.unwrap_or(spec.veins), 31)?;
            let length_m = args.length.unwrap_or(spec.length_m);
            ("parallel", Rays::parallel(&ParallelSpec { veins, length_m, ..spec }))
        }
    })
}

fn odd(veins: u32, most: u32) -> Outcome<u32> {
    if veins % 2 == 1 && (3..=most).contains(&veins) {
        return Ok(veins);
    }
    Err(Failure::Bad(format!("--veins {veins}: give an odd number from 3 to {most}, one vein is the midrib")))
}

fn failure(args: &LeafArgs, error: LeafError) -> Failure {
    match error {
        LeafError::Cancelled(_) => Failure::Cancelled,
        other => Failure::bad_file(
            args.inputs.first().map_or(Path::new("leaf"), PathBuf::as_path),
            format_args!("{other}{}", leaf_data::way_out(&other)),
        ),
    }
}

/// Returns the only leaf, or the leaf of the day that was asked for.
fn grown(args: &LeafArgs, mut full: Vec<FullMarks>) -> Outcome<FullMarks> {
    let Some(day) = args.look.day else {
        return full.pop().ok_or_else(|| Failure::Bug("no leaf was read".into()));
    };
    if args.look.days.len() != full.len() {
        return Err(Failure::Bad(format!(
            "--days names {} for {}; give one day a file",
            say::counted(args.look.days.len() as u64, "day", "days"),
            say::counted(full.len() as u64, "file", "files")
        )));
    }
    let stages = args.look.days.iter().copied().zip(full).collect();
    LeafGrowth::new(stages).and_then(|g| g.marks_on_day(day)).map_err(|e| Failure::Bad(e.to_string()))
}
