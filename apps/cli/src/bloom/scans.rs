//! Scans of several days -> the shape of any day: points, or a plant.

use std::path::Path;

use burgeon::bloom::{
    self, BloomError, FlowerSpec, GrowthLaw, Motion, MotionSpec, OrganPoints, RegisterSpec, RigidMotion,
    Settled,
};
use burgeon::formats::ExportSpec;
use burgeon::glam::DVec3;
use burgeon::mesh::Model;
use burgeon::{
    LeafError, Levels, MadePlant, OrganFit, Run, Seed, SeedlingError, SeedlingOptions, make_seedling,
};

use super::told::{BloomReport, ErrorReport, ResidualReport, ScannedPlant, tell};
use super::write::{levels_of, write_show};
use super::{Show, Shown, hand_edits, no_pace};
use crate::args::{BloomRunArgs, FrameWord, ScanTextureWord};
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::materials::Materials;
use crate::output::Outputs;
use crate::stages::{self, Loaded};
use crate::{edits, files, inputs, poses, report};

/// Fails on options that shapes of these scans do not use.
fn check(args: &BloomRunArgs) -> Outcome {
    let start = Path::new(&args.start);
    if !args.plant && files::extension(&args.output).is_some() {
        // Points have only surfaces, no structure.
        files::writable(&args.output)?;
    }
    let several =
        args.end.is_some() || files::extension(start).is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let stages = "scans of several days";
    args.given.only_if(
        several || !args.plant,
        &["law", "lattice", "straight"],
        stages,
        "this is one scan",
    )?;
    if args.plant && several && args.is_film() {
        return Err(Failure::Bad(
            "--plant makes a plant of one day, and no animation: say which with --day, or name a folder for all days".into(),
        ));
    }
    Ok(())
}

pub(super) fn run(
    args: &BloomRunArgs,
    law: Option<GrowthLaw>,
    mut outputs: Outputs,
    machine: &Machine,
) -> Outcome {
    let start = Path::new(&args.start);
    check(args)?;
    let axes = files::axes(args.axes.up, args.axes.unit);
    let options = stages::Options { clean: !args.no_clean, split: !args.whole };
    let (loaded, read_ms) = machine.timed(|| {
        machine.with_progress("scans", |_| load_shapes(args, &axes, options, law.as_ref(), machine))
    });
    let mut loaded = loaded?;
    let coloured = loaded.stages.iter().flat_map(|s| &s.organs).any(|o| !o.colors.is_empty());
    args.given.only_if(coloured, &["texture"], "scans with colours", "these have none")?;
    if args.texture == ScanTextureWord::Plain {
        loaded.stages.iter_mut().flat_map(|s| &mut s.organs).for_each(|o| o.colors.clear());
    }
    outputs.check()?;
    let first_day = loaded.stages.first().map_or(0.0, |s| s.day);
    let last_day = loaded.stages.last().map_or(0.0, |s| s.day);
    let law = law.unwrap_or_else(|| GrowthLaw::even(first_day, last_day));
    if args.plant && loaded.mesh.is_some() {
        return Err(Failure::bad_file(
            start,
            "is a model with faces; --plant makes plants of scans, which are points",
        ));
    }
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
    let options_of_plant = args.plant.then(|| plant_options(args)).transpose()?;
    let errors = compared(args, &made, &mut loaded, (options, options_of_plant.as_ref()), machine)?;
    let (mut scanned, mut item) = (None, None);
    let mut show = Show {
        name: loaded.name.clone(),
        days: [first_day, last_day],
        best: last_day,
        shape: Box::new(|day| {
            let organs = made.shape(day, args.frame)?;
            // The range of single precision, including squares.
            if !organs.points.iter().all(|p| p.abs().max_element() <= 1e15) {
                let line =
                    format!("on day {day} the shape has no finite size; choose a day nearer to the stages");
                return Err(Failure::bad_file(start, line));
            }
            if let Some(options) = &options_of_plant {
                let (plant, told) =
                    plant_of(&loaded.name, &organs, day, options, &compute).map_err(failed(start))?;
                if let Some(edits) = &args.edits {
                    edits::some_done(edits, &plant.item, options.leaf.edits.len())?;
                }
                let levels = plant.levels(&levels_of(args), &compute);
                let levels = levels.map_err(|s| failed(start)(LeafError::from(s).into()))?;
                scanned = Some(told);
                let checks = plant.item.checks.clone();
                item = Some(plant.item);
                let model = Model { offset_m: loaded.origin.offset_m, ..plant.model };
                return Ok(Shown { plant: Some(plant.plant), model, levels, overlap: None, checks });
            }
            let mut model =
                burgeon::motion_model(&loaded.name, loaded.mesh.as_ref(), &organs.rows, &organs.points);
            burgeon::colour_points(&mut model, &organs.colors);
            let model = Model { offset_m: loaded.origin.offset_m, ..model };
            Ok(Shown { plant: None, model, levels: Levels::default(), overlap: None, checks: vec![] })
        }),
    };
    let (written, write_ms) = machine.timed(|| write_show(args, &mut show, &axes, &mut outputs, machine));
    let written = written?;
    drop(show);
    let mut head = report::report_one("bloom run", args.seed, &args.start, &loaded.name, &args.output);
    head.input.offset_m = loaded.origin.offset_in(&loaded.axes);
    head.items[0].warnings.clone_from(&loaded.warnings);
    head.items[0].warnings.extend(no_pace(args, &made.law));
    head.items[0].warnings.extend(poses::doubts(&made.settled.steps));
    if let Some(item) = item {
        head.items[0].warnings.extend(item.warnings);
        head.items[0].edits = item.edits;
    }
    let told = BloomReport {
        head,
        residuals: made.residuals(),
        error: errors.map(|e| e.0),
        aligned: errors.map(|e| e.1),
        poses: made.settled.steps.iter().map(poses::PoseReport::from).collect(),
        stages: loaded.told.clone(),
        lattice: Some(args.lattice),
        plant: scanned,
        times: [read_ms, fit_ms, write_ms],
    };
    tell(args, machine, told, written, outputs)
}

/// Scans in motion from day to day.
struct Scans<'a> {
    start: &'a Path,
    compute: &'a Run<'a>,
    settled: Settled,
    /// `None` for one day of clouds.
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
        // A cloud of one day has no vertices to keep: it holds the points of both adjacent scans. So does a plant.
        let motion = match args.day {
            Some(_) if loaded.mesh.is_none() => None,
            _ if args.plant => None,
            _ => Some(Motion::new(&settled.stages, law.clone(), spec, compute)?),
        };
        let first_day = loaded.stages.first().map_or(0.0, |s| s.day);
        Ok(Self { start: Path::new(&args.start), compute, settled, motion, law, spec, first_day })
    }

    fn shape(&self, day: f64, frame: FrameWord) -> Outcome<Organs> {
        let failed = Failure::bloom(self.start);
        let mut organs = match &self.motion {
            Some(motion) => {
                let points = motion.points_on_day(day - self.first_day, self.compute).map_err(failed)?;
                Organs { rows: motion.organs.clone(), points, colors: motion.colors(day - self.first_day) }
            }
            // One scan has one day.
            None if self.settled.stages.len() == 1 => {
                let organs = self.settled.stages.iter().flat_map(|s| &s.organs);
                Organs::from_points(organs.map(OrganPoints::from).collect())
            }
            None => Organs::from_points(
                self.settled.day(&self.law, &self.spec, day, self.compute).map_err(failed)?,
            ),
        };
        let pose = self.settled.pose(day);
        if frame == FrameWord::Scanner && pose != RigidMotion::REST {
            organs.points.iter_mut().for_each(|p| *p = pose.apply(*p));
        }
        Ok(organs)
    }

    /// Returns the residual of each registration.
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

/// Returns the error against the scan of --compare: of the shape as it stands, and after its best rigid motion.
fn compared(
    args: &BloomRunArgs,
    made: &Scans<'_>,
    loaded: &mut Loaded,
    (options, plant): (stages::Options, Option<&SeedlingOptions>),
    machine: &Machine,
) -> Outcome<Option<(ErrorReport, ErrorReport)>> {
    let (Some(scan), Some(day)) = (&args.compare, args.day) else { return Ok(None) };
    // In the same way as the stages: their file may give unit and up axis.
    let measured = stages::read_points(scan, loaded, options.clean, Seed::new(args.seed), machine)?;
    let organs = made.shape(day, FrameWord::Scanner)?;
    let shape = match plant {
        // The surface of a plant is compared.
        Some(options) => {
            let made = make_seedling(&loaded.name, &organs.rows(), options, made.compute);
            burgeon::surface_places(&made.map_err(failed(scan))?.0.model)
        }
        None => organs.points,
    };
    let against = |shape: &[DVec3]| bloom::compare(&measured, shape, made.compute).map(ErrorReport::from);
    let error = against(&shape).map_err(Failure::bloom(scan))?;
    if error.mean_mm.max(error.back_mean_mm) > 500.0 * burgeon::geom::extent(&shape) {
        loaded.warnings.push(format!(
            "{}: is half the plant's size away from it; is its unit that of the stages?",
            scan.display()
        ));
    }
    let pose = bloom::best_move(&shape, &measured, made.compute).map_err(Failure::bloom(scan))?;
    let moved: Vec<DVec3> = shape.iter().map(|&p| pose.apply(p)).collect();
    Ok(Some((error, against(&moved).map_err(Failure::bloom(scan))?)))
}

/// Points of a day, and the rows of each organ.
struct Organs {
    rows: Vec<(String, core::ops::Range<usize>)>,
    points: Vec<DVec3>,
    /// Colours of each organ; empty, or one for each point.
    colors: Vec<Vec<[u8; 3]>>,
}

impl Organs {
    /// Returns each organ with its points.
    fn rows(&self) -> Vec<OrganPoints> {
        let of = |((name, rows), colors): (&(String, core::ops::Range<usize>), &Vec<[u8; 3]>)| OrganPoints {
            name: name.clone(),
            points: self.points[rows.clone()].to_vec(),
            colors: colors.clone(),
        };
        self.rows.iter().zip(&self.colors).map(of).collect()
    }

    fn from_points(organs: Vec<OrganPoints>) -> Self {
        let mut out = Self { rows: Vec::new(), points: Vec::new(), colors: Vec::new() };
        for OrganPoints { name, points, colors } in organs {
            out.colors.push(colors);
            let start = out.points.len();
            out.points.extend(points);
            out.rows.push((name, start..out.points.len()));
        }
        out
    }
}

/// Returns the options of a plant made of scans.
fn plant_options(args: &BloomRunArgs) -> Outcome<SeedlingOptions> {
    let mut options = SeedlingOptions::default();
    options.leaf.edits = hand_edits(args)?;
    options.leaf.skin.wind = args.wind || args.export.sway;
    if let Some(path) = &args.materials {
        options.leaf.skin.worn = Materials::read(path)?.worn();
    }
    Ok(options)
}

/// Makes the plant of a day, and its warnings.
fn plant_of(
    name: &str,
    organs: &Organs,
    day: f64,
    options: &SeedlingOptions,
    run: &Run<'_>,
) -> Result<(MadePlant, ScannedPlant), SeedlingError> {
    let (made, found, error): (MadePlant, Vec<OrganFit>, _) =
        make_seedling(name, &organs.rows(), options, run)?;
    Ok((made, ScannedPlant { day, organs: found, error: error.into() }))
}

fn failed(path: &Path) -> impl Fn(SeedlingError) -> Failure + '_ {
    move |error| match error {
        SeedlingError::Leaf(LeafError::Cancelled(_)) | SeedlingError::Organ(BloomError::Cancelled) => {
            Failure::Cancelled
        }
        other => Failure::bad_file(path, other),
    }
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
        let hint = burgeon::meant(&args.start, FlowerSpec::PRESETS.iter().copied());
        return Err(Failure::Bad(format!(
            "{}: there is no such file, and no such flower ({names}); check the spelling{hint}",
            args.start
        )));
    }
    if args.plant && args.end.is_none() {
        args.given.refuse(&["end_day"], "an --end", "there is one scan")?;
        let day = args.start_day.or(args.day).unwrap_or(0.0);
        return stages::load_files(&[(start, day)], options, axes, Seed::new(args.seed), machine);
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
    stages::load_files(&[(start, first), (end, last)], options, axes, Seed::new(args.seed), machine)
}
