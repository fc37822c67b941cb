//! `burgeon bloom run`: shapes at any day, whole flowers that open.

use std::path::{Path, PathBuf};

use burgeon::bloom::{
    self, BloomError, FlowerSpec, GrowthLaw, Motion, MotionSpec, RegisterSpec, RigidMotion, Settled,
    ShapeError,
};
use burgeon::document::PlantEdit;
use burgeon::formats::{ExportSpec, ModelFormat, Morph, PngCache, write_cloud_ply, write_glb_morph};
use burgeon::glam::DVec3;
use burgeon::mesh::{Model, PointCloud};
use burgeon::plant::{Measures, Plant};
use burgeon::{
    Counts, Digest, FlowerOptions, MakeError, OpeningError, OpeningPlant, Run, RunReport, Seed, Stopped,
    make_flower,
};
use serde::Serialize;

use crate::args::{AxesArgs, BloomCommand, BloomRunArgs, FrameWord, PictureArgs, PlantFormat};
use crate::failure::{Failure, Outcome};
use crate::files::Goal;
use crate::machine::Machine;
use crate::materials::Materials;
use crate::output::Outputs;
use crate::petals::{drawing, is_drawing, petal_form};
use crate::stages::{self, Loaded};
use crate::{edits, files, fit, inputs, names, picture, poses, report, say};

/// Distances in millimetres: measured to reconstructed, and back.
#[derive(Clone, Copy, Debug, Serialize)]
struct ErrorReport {
    paper_mm: f64,
    mean_mm: f64,
    rms_mm: f64,
    p95_mm: f64,
    max_mm: f64,
    coverage: f64,
    back_paper_mm: f64,
    back_mean_mm: f64,
    back_rms_mm: f64,
    back_max_mm: f64,
}

impl From<ShapeError> for ErrorReport {
    fn from(e: ShapeError) -> Self {
        let (a, b) = (e.to_model, e.to_scan);
        Self {
            paper_mm: a.paper * 1e3,
            mean_mm: a.mean * 1e3,
            rms_mm: a.rms * 1e3,
            p95_mm: a.p95 * 1e3,
            max_mm: a.max * 1e3,
            coverage: e.coverage,
            back_paper_mm: b.paper * 1e3,
            back_mean_mm: b.mean * 1e3,
            back_rms_mm: b.rms * 1e3,
            back_max_mm: b.max * 1e3,
        }
    }
}

#[derive(Debug, Serialize)]
struct ResidualReport {
    organ: String,
    from_day: f64,
    to_day: f64,
    #[serde(flatten)]
    error: ErrorReport,
}

/// What `run` adds to the report.
#[derive(Debug, Serialize)]
struct MotionReport {
    #[serde(flatten)]
    run: RunReport,
    frames: u32,
    day: Option<f64>,
    /// Control points round each organ; none for flowers, which have no lattice.
    lattice: Option<[usize; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<ErrorReport>,
    /// The error after the best rigid move of the shape onto the scan.
    #[serde(skip_serializing_if = "Option::is_none")]
    aligned: Option<ErrorReport>,
    /// How plant and organs moved between scans.
    poses: Vec<poses::PoseReport>,
    /// What the registration of each organ left.
    residuals: Vec<ResidualReport>,
    /// Share of petal triangles that cross another petal, at each frame of a flower.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    overlap: Vec<f64>,
    stages: Vec<stages::StageReport>,
}

pub(crate) fn bloom(command: &BloomCommand) -> Outcome {
    match command {
        BloomCommand::Fit(args) => fit::fit(args),
        BloomCommand::Run(args) => run(args),
    }
}

fn read_law(path: &Path) -> Outcome<GrowthLaw> {
    let text = files::read_text(path)?;
    let law: GrowthLaw = serde_json::from_str(&text).map_err(|e| {
        Failure::at(path, format_args!("is no growth law: {e}; make one with `burgeon bloom fit`"))
    })?;
    let fault = law.validate().next();
    match fault {
        Some(fault) => Err(Failure::at(path, format_args!("cannot be used: {fault}"))),
        None => Ok(law),
    }
}

/// What there is at a day.
struct Shown {
    /// None of scans, of which only points are known.
    plant: Option<Plant>,
    model: Model,
    /// Coarser copies.
    lods: Vec<Model>,
    /// The share of petal triangles that cross another petal.
    overlap: Option<f64>,
}

type Shape<'a> = Box<dyn FnMut(f64) -> Outcome<Shown> + 'a>;

/// Shapes over time, wherever they come from.
struct Show<'a> {
    name: String,
    /// First and last day, in the user's count.
    days: [f64; 2],
    /// The day of a picture that names none.
    best: f64,
    shape: Shape<'a>,
}

/// The outputs of `run`: -o is a file, or a folder for the shapes of all days.
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
            files::plan_plant(&mut outputs, &args.output, args.lods)?;
        }
        (None, Some(_)) => {
            return Err(Failure::at(&args.output, "has no extension; end it with .glb, .ply, .obj or .stl"));
        }
        // First: a report may lie in it.
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
    let mut outputs = planned(args)?;
    let law = args.law.as_deref().map(read_law).transpose()?;
    if args.day.is_some_and(|d| !d.is_finite()) {
        return Err(Failure::Bad("--day must be a finite number".into()));
    }
    let start = Path::new(&args.start);
    check_used(args)?;
    if let Some(spec) = species(start)? {
        return flower(args, spec, law, outputs, &machine);
    }
    let flowers = format!("whole flowers ({})", FlowerSpec::PRESETS.join(", "));
    args.given.refuse(&["petal"], &flowers, &format!("{} is none", args.start))?;
    if is_drawing(start) {
        return drawn_flower(args, start, law, outputs, &machine);
    }
    let plants = ["wind", "edits", "lods", "materials"];
    args.given.refuse(&plants, &format!("{flowers} and drawings"), &format!("{} is none", args.start))?;
    if files::extension(&args.output).is_some() {
        // Of scans only surfaces are known, no structure.
        files::writable(&args.output)?;
    }
    let axes = files::axes(args.axes.up, args.axes.unit);
    let options = stages::Options { clean: !args.no_clean, split: !args.whole };
    let (loaded, read_ms) = machine.timed(|| {
        machine.with_progress("scans", |_| load_shapes(args, &axes, options, law.as_ref(), &machine))
    });
    let mut loaded = loaded?;
    outputs.check()?;
    let first_day = loaded.stages.first().map_or(0.0, |s| s.day);
    let last_day = loaded.stages.last().map_or(0.0, |s| s.day);
    let law = law.unwrap_or_else(|| GrowthLaw::even(first_day, last_day));
    let compute = machine.run();
    let (made, fit_ms) =
        machine.timed(|| machine.with_progress("registration", |_| Scans::new(args, &loaded, law, &compute)));
    let made = made.map_err(Failure::bloom(start))?;
    let told_apart = made.settled.steps.iter().any(|s| s.organs.len() > 1);
    let users = "plants of which two organs or more are there on two days";
    args.given.only_if(
        told_apart,
        &["frame"],
        users,
        "here nothing tells the plant's motion from the organ's",
    )?;
    let errors = compared(args, &made, &mut loaded, options, &machine)?;
    let mut show = Show {
        name: loaded.name.clone(),
        days: [first_day, last_day],
        best: last_day,
        shape: Box::new(|day| {
            let Organs { rows, points } = made.shape(day, args.frame)?;
            // What single precision holds, squares included.
            if !points.iter().all(|p| p.abs().max_element() <= 1e15) {
                let line =
                    format!("on day {day} the shape has no finite size; choose a day nearer to the stages");
                return Err(Failure::at(start, line));
            }
            let model = burgeon::motion_model(&loaded.name, loaded.mesh.as_ref(), &rows, &points);
            let model = Model { offset_m: loaded.origin.offset_m, ..model };
            Ok(Shown { plant: None, model, lods: Vec::new(), overlap: None })
        }),
    };
    let (written, write_ms) = machine.timed(|| write_show(args, &mut show, &axes, &mut outputs, &machine));
    let written = written?;
    let mut head = report::of_one("bloom run", args.seed, &args.start, &loaded.name, &args.output);
    head.input.offset_m = loaded.origin.told(&loaded.axes);
    head.items[0].warnings.clone_from(&loaded.warnings);
    head.items[0].warnings.extend(no_pace(args, &made.law));
    let told = BloomReport {
        head,
        residuals: made.residuals(),
        error: errors.map(|e| e.0),
        aligned: errors.map(|e| e.1),
        poses: made.settled.steps.iter().map(poses::PoseReport::from).collect(),
        stages: loaded.told.clone(),
        lattice: Some(args.lattice),
        times: [read_ms, fit_ms, write_ms],
    };
    tell(args, &machine, told, written, outputs)
}

/// Scans on their way from day to day.
struct Scans<'a> {
    start: &'a Path,
    compute: &'a Run<'a>,
    settled: Settled,
    /// None for one day of clouds.
    motion: Option<Motion>,
    law: GrowthLaw,
    spec: MotionSpec,
    first_day: f64,
}

impl<'a> Scans<'a> {
    fn new(
        args: &'a BloomRunArgs,
        loaded: &Loaded,
        law: GrowthLaw,
        compute: &'a Run<'a>,
    ) -> Result<Self, BloomError> {
        let spec = MotionSpec {
            register: RegisterSpec { counts: args.lattice, ..RegisterSpec::default() },
            straight: args.straight,
        };
        let settled = bloom::settle(&loaded.stages, &spec.register, compute)?;
        // A cloud of one day has no vertices to keep: it holds the points of both scans round it.
        let motion = match args.day {
            Some(_) if loaded.mesh.is_none() => None,
            _ => Some(Motion::new(&settled.stages, law.clone(), spec, compute)?),
        };
        let first_day = loaded.stages.first().map_or(0.0, |s| s.day);
        Ok(Self { start: Path::new(&args.start), compute, settled, motion, law, spec, first_day })
    }

    fn shape(&self, day: f64, frame: FrameWord) -> Outcome<Organs> {
        let failed = Failure::bloom(self.start);
        let mut organs = match &self.motion {
            Some(motion) => {
                let points = motion.at(day - self.first_day, self.compute).map_err(failed)?;
                Organs { rows: motion.organs.clone(), points }
            }
            None => Organs::of(self.settled.day(&self.law, &self.spec, day, self.compute).map_err(failed)?),
        };
        let pose = self.settled.pose(day);
        if frame == FrameWord::Scanner && pose != RigidMotion::REST {
            organs.points.iter_mut().for_each(|p| *p = pose.apply(*p));
        }
        Ok(organs)
    }

    /// What each registration left.
    fn residuals(&self) -> Vec<ResidualReport> {
        let of_motion = self.motion.iter().flat_map(|m| &m.residuals);
        let of_motion =
            of_motion.map(|(organ, from, to, e)| (organ, from + self.first_day, to + self.first_day, e));
        let of_steps = self.settled.steps.iter().filter(|_| self.motion.is_none());
        let of_steps =
            of_steps.flat_map(|s| s.organs.iter().map(|o| (&o.organ, s.from_day, s.to_day, &o.residual)));
        let told = of_motion.chain(of_steps).map(|(organ, from_day, to_day, e)| {
            let (organ, error) = (organ.clone(), ErrorReport::from(*e));
            ResidualReport { organ, from_day, to_day, error }
        });
        told.collect()
    }
}

/// The error against the scan of --compare: as the shape stands, and after its best rigid move.
fn compared(
    args: &BloomRunArgs,
    made: &Scans<'_>,
    loaded: &mut Loaded,
    options: stages::Options,
    machine: &Machine,
) -> Outcome<Option<(ErrorReport, ErrorReport)>> {
    let (Some(scan), Some(day)) = (&args.compare, args.day) else { return Ok(None) };
    // As the stages are: their file may say unit and up axis.
    let measured = stages::read_points(scan, loaded, options.clean, Seed::new(args.seed), machine)?;
    let shape = made.shape(day, FrameWord::Scanner)?.points;
    let against = |shape: &[DVec3]| bloom::compare(&measured, shape, made.compute).map(ErrorReport::from);
    let error = against(&shape).map_err(Failure::bloom(scan))?;
    if error.mean_mm.max(error.back_mean_mm) > 500.0 * extent(&shape) {
        loaded.warnings.push(format!(
            "{}: is half the plant's size away from it; is its unit that of the stages?",
            scan.display()
        ));
    }
    let pose = bloom::best_move(&shape, &measured, made.compute).map_err(Failure::bloom(scan))?;
    let moved: Vec<DVec3> = shape.iter().map(|&p| pose.apply(p)).collect();
    Ok(Some((error, against(&moved).map_err(Failure::bloom(scan))?)))
}

/// Everything that the report of `run` is made of, beside what was written.
struct BloomReport {
    head: RunReport,
    residuals: Vec<ResidualReport>,
    error: Option<ErrorReport>,
    aligned: Option<ErrorReport>,
    poses: Vec<poses::PoseReport>,
    stages: Vec<stages::StageReport>,
    lattice: Option<[usize; 3]>,
    times: [f64; 3],
}

impl BloomReport {
    fn of_flower(head: RunReport, times: [f64; 3]) -> Self {
        let (residuals, poses, stages) = (vec![], vec![], vec![]);
        Self { head, residuals, error: None, aligned: None, poses, stages, lattice: None, times }
    }
}

fn tell(
    args: &BloomRunArgs,
    machine: &Machine,
    mut told: BloomReport,
    written: Written,
    outputs: Outputs,
) -> Outcome {
    let item = &mut told.head.items[0];
    (item.counts, item.plant) = (written.counts, written.measures);
    item.digest = written.digest;
    item.timings_ms.structure = told.times[1];
    item.timings_ms.add_io(told.times[0], told.times[2]);
    item.timings_ms.total = machine.whole_ms();
    let report = MotionReport {
        run: told.head,
        frames: written.frames,
        day: args.day,
        lattice: told.lattice,
        error: told.error,
        aligned: told.aligned,
        poses: told.poses,
        residuals: told.residuals,
        overlap: written.overlap,
        stages: told.stages,
    };
    report::finish(&report, &args.common, outputs)?;
    if !machine.quiet {
        let item = &report.run.items[0];
        item.warnings.iter().for_each(|w| say::warning(w));
        if let Some(e) = &report.error {
            say::line(&format!(
                "error: {:.3} mm (mean over x, y, z as the paper has it); Euclidean, scan to model: {:.3} mm mean, {:.3} \
                 RMS, {:.3} 95 %, {:.3} max, {:.1} % within 2 mm; model to scan: {:.3} mean, {:.3} RMS, {:.3} max",
                e.paper_mm,
                e.mean_mm,
                e.rms_mm,
                e.p95_mm,
                e.max_mm,
                e.coverage * 100.0,
                e.back_mean_mm,
                e.back_rms_mm,
                e.back_max_mm
            ));
        }
        if let Some(e) = &report.aligned {
            say::line(&format!(
                "after the best rigid move: scan to model {:.3} mm mean, model to scan {:.3}",
                e.mean_mm, e.back_mean_mm
            ));
        }
        report.poses.iter().flat_map(poses::PoseReport::lines).for_each(|l| say::line(&l));
        let frames = say::counted(u64::from(report.frames), "shape", "shapes");
        let points = say::counted(item.counts.vertices, "point", "points");
        say::line(&format!(
            "{}: {frames} of {points}; {:.0} ms",
            args.output.display(),
            item.timings_ms.total
        ));
    }
    Ok(())
}

/// Points of a day, and the rows of each organ.
struct Organs {
    rows: Vec<(String, core::ops::Range<usize>)>,
    points: Vec<DVec3>,
}

impl Organs {
    fn of(organs: Vec<(String, Vec<DVec3>)>) -> Self {
        let mut out = Self { rows: Vec::new(), points: Vec::new() };
        for (name, points) in organs {
            let start = out.points.len();
            out.points.extend(points);
            out.rows.push((name, start..out.points.len()));
        }
        out
    }
}

/// What is said of a law that sets no pace.
fn no_pace(args: &BloomRunArgs, law: &GrowthLaw) -> Option<String> {
    let path = args.law.as_ref().filter(|_| !law.sets_pace())?;
    Some(format!(
        "{}: its stages determine no law that moves: everything goes at an even pace",
        path.display()
    ))
}

/// The largest side of the box round some points.
fn extent(points: &[DVec3]) -> f64 {
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let [low, high] = points.iter().fold(none, |[a, b], &p| [a.min(p), b.max(p)]);
    (high - low).max_element()
}

fn load_shapes(
    args: &BloomRunArgs,
    axes: &ExportSpec,
    options: stages::Options,
    law: Option<&GrowthLaw>,
    machine: &Machine,
) -> Outcome<Loaded> {
    let start = Path::new(&args.start);
    let stdin = inputs::is_stdin(start);
    if files::extension(start).is_some_and(|e| e.eq_ignore_ascii_case("toml"))
        || (stdin && args.end.is_none())
    {
        let options = ["end", "start_day", "end_day", "whole", "no_clean"];
        let this = "a stages file says so itself (file, day, split, clean)";
        args.given.refuse(&options, "a START and an END", this)?;
        return stages::load(start, axes, Seed::new(args.seed), machine);
    }
    if !start.exists() && !stdin {
        let names = FlowerSpec::PRESETS.join(", ");
        return Err(Failure::Bad(format!(
            "{}: there is no such file, and no such flower ({names}); check the spelling",
            args.start
        )));
    }
    let Some(end) = &args.end else {
        return Err(Failure::Bad(
            "--end is missing: name the last shape, or give a stages file as START".into(),
        ));
    };
    let first = args.start_day.or(law.map(|l| l.first_day)).unwrap_or(0.0);
    let last = args.end_day.or(law.map(|l| l.first_day + l.span_days)).unwrap_or(first + 1.0);
    let ordered = last > first;
    if !ordered {
        return Err(Failure::Bad(format!(
            "the day of END ({last}) does not come after that of START ({first})"
        )));
    }
    stages::load_pair(start, first, end, last, options, axes, Seed::new(args.seed), machine)
}

/// Fails on options that this kind of output does not use.
fn check_used(args: &BloomRunArgs) -> Outcome {
    let given = &args.given;
    let picture = ["size", "view"];
    given.only_if(args.png.is_some(), &picture, "pictures", "--png FILE.png, which makes one, is missing")?;
    let extension = files::extension(&args.output);
    let several = args.day.is_none() && extension.is_none_or(|e| e.eq_ignore_ascii_case("glb"));
    let one = "one shape is written";
    given.only_if(several, &["frames"], "animations (.glb without --day) and folders", one)?;
    let film = several && extension.is_some();
    given.only_if(film, &["seconds"], "animations (.glb without --day)", "none is written")?;
    let structure = extension.and_then(PlantFormat::from_extension);
    let structure = matches!(structure, Some(PlantFormat::Structure(_)));
    let users = "models of one shape (--day, or another format than .glb)";
    given.only_if(!several && !structure, &["lods"], users, "none is written")?;
    given.only_if(
        extension.is_none(),
        &["format"],
        "folders",
        "-o names a file, whose extension says its format",
    )
}

/// Fails on options of scans.
fn no_scans(args: &BloomRunArgs, name: &str) -> Outcome {
    let given = &args.given;
    let options =
        ["end", "compare", "lattice", "straight", "frame", "whole", "no_clean", "start_day", "end_day"];
    given.refuse(&options, "scans and models", &format!("{name} is a whole flower"))?;
    let folder = files::extension(&args.output).is_none();
    let written =
        if folder { PlantFormat::Model(args.format.format()) } else { files::plant_writable(&args.output)? };
    let wind = matches!(written, PlantFormat::Model(format) if format.carries_wind());
    // An animation moves its vertices itself.
    let film =
        args.day.is_none() && files::extension(&args.output).is_some_and(|e| e.eq_ignore_ascii_case("glb"));
    given.only_if(
        wind && !film,
        &["wind"],
        "models of one day as .glb (--day), .usda or .usdz",
        "none is made",
    )?;
    given.check_axes(!written.fixed_axes())
}

/// A drawing whose flowers open.
fn drawn_flower(
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
    options.skin.wind = args.wind;
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
        other => Failure::at(path, other),
    })?;
    if let Some(edits) = &args.edits {
        edits::some_done(edits, &plant.item, count)?;
    }
    let law = law.unwrap_or_else(|| plant.law());
    let axes = files::axes(args.axes.up, args.axes.unit);
    let mut head = report::of_one("bloom run", args.seed, &args.start, &plant.name, &args.output);
    head.items[0].warnings.clone_from(&plant.item.warnings);
    head.items[0].warnings.extend(no_pace(args, &law));
    head.items[0].edits.clone_from(&plant.item.edits);
    let mut show = Show {
        name: files::stem(path),
        days: [0.0, plant.days[0] + plant.days[1]],
        best: plant.days[0],
        shape: Box::new(|day| {
            let open = plant.at(day, &law, seed, &machine.run())?;
            let lods = (1..=args.lods).map(|level| plant.at_level(&open, level, &machine.run()));
            let lods = lods.collect::<Result<_, _>>()?;
            Ok(Shown { plant: Some(open.plant), model: open.model, lods, overlap: Some(open.overlap) })
        }),
    };
    let (written, write_ms) = machine.timed(|| write_show(args, &mut show, &axes, &mut outputs, machine));
    let written = written?;
    let times = [read_ms, made_ms, write_ms];
    let told = BloomReport::of_flower(head, times);
    tell(args, machine, told, written, outputs)
}

/// A flower by its name, or of a file of its own; none for scans and drawings.
pub(crate) fn species(start: &Path) -> Outcome<Option<FlowerSpec>> {
    let preset = start.to_str().and_then(bloom::preset).filter(|_| !start.exists() || start.is_dir());
    if preset.is_some()
        || !files::extension(start).is_some_and(|e| e.eq_ignore_ascii_case("toml"))
        || !start.exists()
    {
        return Ok(preset);
    }
    let text = files::read_text(start)?;
    // A file of stages has none.
    let whorls = burgeon::spec::Node::from_toml(&text).is_ok_and(|tree| tree.field("whorls").is_some());
    whorls.then(|| burgeon::spec::from_toml(&text).map_err(|e| Failure::at(start, e))).transpose()
}

fn flower(
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
    options.skin.wind = args.wind;
    if let Some(path) = &args.materials {
        options.skin.worn = Materials::read(path)?.worn();
    }
    let failed = |stopped| match stopped {
        Stopped::Cancelled(_) => Failure::Cancelled,
        Stopped::OverBudget(much) => Failure::at(Path::new(&args.start), much),
    };
    let mut head = report::of_one("bloom run", args.seed, &args.start, &spec.name, &args.output);
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
            let lods = (1..=args.lods).map(|level| made.at_level(level, &machine.run()));
            let lods = lods.collect::<Result<_, _>>().map_err(failed)?;
            let overlap = bloom::part_overlap(&made.plant, None);
            Ok(Shown { plant: Some(made.plant), model: made.model, lods, overlap: Some(overlap) })
        }),
    };
    let (written, write_ms) = machine.timed(|| write_show(args, &mut show, &axes, &mut outputs, machine));
    let written = written?;
    let times = [0.0, 0.0, write_ms];
    let told = BloomReport::of_flower(head, times);
    tell(args, machine, told, written, outputs)
}

/// The edits by hand that are asked for.
fn hand_edits(args: &BloomRunArgs) -> Outcome<Vec<PlantEdit>> {
    Ok(args.edits.as_deref().map(edits::read).transpose()?.unwrap_or_default())
}

/// What was written.
#[derive(Default)]
struct Written {
    frames: u32,
    /// Of the last one.
    counts: Counts,
    measures: Option<Measures>,
    digest: String,
    overlap: Vec<f64>,
}

impl Written {
    fn take(&mut self, shown: &Shown) {
        self.frames += 1;
        self.counts = match &shown.plant {
            Some(plant) => Counts::of_plant(plant),
            None => Counts::default(),
        };
        self.counts.vertices = shown.model.vertex_count() as u64;
        self.counts.triangles = shown.model.triangle_count() as u64;
        self.measures = shown.plant.as_ref().map(Plant::measure);
        self.overlap.extend(shown.overlap);
    }
}

fn write_show(
    args: &BloomRunArgs,
    show: &mut Show<'_>,
    axes: &ExportSpec,
    outputs: &mut Outputs,
    machine: &Machine,
) -> Outcome<Written> {
    let mut written = Written::default();
    let mut digest = Digest::new();
    let extension = files::extension(&args.output).map(str::to_ascii_lowercase);
    let at = |k: u32| {
        let share = f64::from(k) / f64::from(args.frames - 1);
        show.days[0] + (show.days[1] - show.days[0]) * share
    };
    let mut one = |day: f64, path: &Path, written: &mut Written, digest: &mut Digest| -> Outcome {
        machine.cancel.check()?;
        let shown = (show.shape)(day)?;
        digest.add(&shown.model);
        written.take(&shown);
        write_one(outputs, path, &shown, (axes, &args.axes))
    };
    match (extension.as_deref(), args.day) {
        (None, _) => {
            let name = names::safe(&show.name);
            for k in 0..args.frames {
                let name = format!("{name}-{k:03}.{}", args.format.extension());
                one(at(k), &args.output.join(name), &mut written, &mut digest)?;
            }
        }
        (Some(_), Some(day)) => one(day, &args.output, &mut written, &mut digest)?,
        (Some("glb"), None) => {
            let mut models = Vec::new();
            for k in 0..args.frames {
                machine.cancel.check()?;
                let shown = (show.shape)(at(k))?;
                digest.add(&shown.model);
                written.take(&shown);
                models.push(shown.model);
            }
            // The frame nearest to full bloom is the model itself: what shows no animation, or no colours of one,
            // shows the open flower.
            let far = |k: u32| (at(k) - show.best).abs();
            let best = (0..args.frames).min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(0);
            #[expect(clippy::cast_possible_truncation, reason = "seconds of an animation")]
            let second = |k: u32| (args.seconds * f64::from(k) / f64::from(args.frames - 1)) as f32;
            if let Some(model) = models.get(best as usize) {
                let keys = (0..args.frames).zip(&models).filter(|(k, _)| *k != best);
                let keys = keys.map(|(k, m)| (second(k), m)).collect();
                let morph = Morph { name: "growth", at: second(best), keys };
                outputs.write("-o", &args.output, |out| write_glb_morph(model, &morph, out))?;
            }
        }
        (Some(_), None) => one(show.best, &args.output, &mut written, &mut digest)?,
    }
    if let Some(png) = &args.png {
        let model = (show.shape)(args.day.unwrap_or(show.best))?.model;
        let look = PictureArgs {
            size: args.size,
            view: args.view,
            frames: 8,
            background: burgeon::render::Background::Sky,
            no_shadow: false,
            supersample: 4,
        };
        let spec = look.spec(args.seed);
        let model = picture::with_dots(model);
        let drawn =
            machine.with_progress("picture", |_| burgeon::render::render(&model, &spec, &machine.run()))?;
        picture::write(outputs, "--png", png, &drawn)?;
    }
    written.digest = digest.hex();
    Ok(written)
}

/// Clouds as PLY in double precision, everything else by the writers of models.
fn write_one(
    outputs: &mut Outputs,
    path: &Path,
    Shown { plant, model, lods, .. }: &Shown,
    (axes, named): (&ExportSpec, &AxesArgs),
) -> Outcome {
    if let (Some(plant), format @ PlantFormat::Structure(_)) = (plant, files::plant_writable(path)?) {
        let (goal, cache) = (Goal::new("-o", path), &mut PngCache::new());
        return files::write_plant(outputs, goal, (plant, model), format, named, cache).map(drop);
    }
    let bare = model.parts.iter().all(|p| p.mesh.triangles.is_empty());
    let format: ModelFormat = files::writable(path)?;
    if bare && format == ModelFormat::Ply {
        let mut cloud = PointCloud { offset_m: model.offset_m, ..PointCloud::default() };
        for part in &model.parts {
            let color = model.material(part).base_color;
            for p in &part.mesh.positions {
                cloud.points.push(DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2])));
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
                cloud.colors.push(color.map(|c| (c.clamp(0.0, 1.0).sqrt() * 255.0) as u8));
            }
        }
        return outputs.write("-o", path, |out| write_cloud_ply(&cloud, axes, out));
    }
    // --unit and --up were those of the scans: a GLB in metres with +Y up is no surprise.
    let axes = if format == ModelFormat::Glb { &ExportSpec::default() } else { axes };
    let mut cache = PngCache::new();
    files::write_model(outputs, Goal::new("-o", path), model, format, axes, &mut cache)?;
    for (model, level) in lods.iter().zip(1..) {
        let path = files::lod(path, level);
        files::write_model(outputs, Goal::new("--lods", &path), model, format, axes, &mut cache)?;
    }
    Ok(())
}
