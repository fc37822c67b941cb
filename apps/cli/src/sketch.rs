//! `burgeon sketch`: one drawing to one model, or many drawings to a folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use burgeon::document::{CommandError, Document, DocumentPlant, Editor, PlantCommand, SketchCommand};
use burgeon::formats::Room;
use burgeon::formats::{DrawingError, Drawings, PngCache, ReadDrawing, read_drawings};
use burgeon::sketch::SketchSpec;
use burgeon::skin::SkinSpec;
use burgeon::{
    ItemReport, LeafTemplate, Levels, Made, MakeError, Run, RunReport, Seed, SketchOptions, SplitError,
    make_levels_from_sketch,
};

use crate::args::{PlantFormat, ReadingArgs, Seen, SketchArgs, SurfaceArgs};
use crate::classes::Classes;
use crate::failure::{Failure, Outcome};
use crate::files::{self, Goal, Kind};
use crate::levels::{Form, Whole};
use crate::machine::{Machine, Progress};
use crate::materials::Materials;
use crate::output::Outputs;
use crate::{checks, levels, names, output, picture, project, say};

pub(crate) fn sketch(args: &SketchArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    if let [input] = args.inputs.as_slice()
        && let Some(scene) = crate::scene::read_file(input)?
    {
        return crate::scene::make(args, input, &scene, &machine);
    }
    let job = Job::new(args, &machine)?;
    let batch = job.is_batch()?;
    check_used(args, batch)?;
    let report = if batch {
        job.batch(&machine)?
    } else {
        machine.with_progress("drawing to plant", |_| job.one(&machine))?
    };
    if report.failed > 0 { Err(Failure::Reported) } else { Ok(()) }
}

/// Fails on unused options.
fn check_used(args: &SketchArgs, batch: bool) -> Outcome {
    let given = &args.given;
    let folder = batch && args.output.is_some();
    given.only_if(folder, &["format"], "folders of models", "-o names none")?;
    let format = match &args.output {
        Some(_) if batch => Some(args.format.0),
        Some(path) => Some(files::plant_writable(path)?),
        None => None,
    };
    given.only_if(!batch, &["split"], "one drawing", "several make several plants anyway")?;
    let leaf = "a project keeps no leaf of another file";
    given.only_if(args.split.is_none(), &["leaf_template"], "models and pictures", leaf)?;
    given.check_picture(args.png.is_some(), &args.picture)?;
    given.check_surface(Seen::new(format, args.png.as_ref(), &args.common))?;
    let surface = &args.surface;
    surface.export.check_used(given, (format, args.png.is_some()), surface.skin.paints())?;
    given.check_axes(args.qsm.is_some() || format.is_some_and(|f| f.holds(Room::Axes)))
}

/// All inputs and options, read and checked before the first drawing.
struct Job<'a> {
    args: &'a SketchArgs,
    /// Settings of --spec; without it, the defaults or the project's own.
    spec: Option<SketchSpec>,
    classes: Classes,
    /// Leaf of --leaf-template.
    leaf: Option<LeafTemplate>,
    /// Materials of --materials.
    materials: Option<Materials>,
}

impl<'a> Job<'a> {
    fn new(args: &'a SketchArgs, machine: &Machine) -> Outcome<Self> {
        let spec = args.reading.spec.as_deref().map(files::read_spec).transpose()?;
        let classes = args.reading.classes.as_deref().map(Classes::read).transpose()?.unwrap_or_default();
        let template = args.reading.leaf_template.as_deref();
        let leaf = template
            .map(|p| crate::leaf_data::template_of(p, args.seed.unwrap_or(1), machine))
            .transpose()?;
        let materials = args.surface.skin.materials.as_deref().map(Materials::read).transpose()?;
        Ok(Self { args, spec, classes, leaf, materials })
    }

    /// Whether the outputs are folders, rather than files.
    fn is_batch(&self) -> Outcome<bool> {
        let many = self.args.inputs.len() > 1;
        let model = |e: &str| PlantFormat::from_extension(e).is_some();
        let picture = |e: &str| e.eq_ignore_ascii_case("png");
        let table = |e: &str| e.eq_ignore_ascii_case("csv");
        let output =
            self.args.output.as_deref().map(|p| names_folder(p, "-o", model, &PlantFormat::endings(), many));
        let png = self
            .args
            .png
            .as_deref()
            .map(|p| names_folder(p, "--png", picture, "pictures are written as .png", many));
        let qsm = self
            .args
            .qsm
            .as_deref()
            .map(|p| names_folder(p, "--qsm", table, "cylinders are written as .csv", many));
        let (output, png, qsm) = (output.transpose()?, png.transpose()?, qsm.transpose()?);
        let first = output.or(png).or(qsm);
        for (folder, path, option) in [(png, &self.args.png, "--png"), (qsm, &self.args.qsm, "--qsm")] {
            if folder.is_some() && folder != first {
                let other = if output.is_some() { "-o" } else { "--png" };
                return Err(Failure::bad_file(
                    path.as_deref().unwrap_or(Path::new("")),
                    format_args!(
                        "{other} and {option} name a file and a folder; give two files or two folders"
                    ),
                ));
            }
        }
        Ok(many || first.unwrap_or(false))
    }

    /// Returns the options of the project, or the defaults; options of the command line override both.
    fn options(&self, input: &Input) -> SketchOptions {
        let mut options = input.project.as_deref().map(SketchOptions::from_plant).unwrap_or_default();
        if let Some(spec) = &self.spec {
            options.spec.clone_from(spec);
        }
        set_sketch(&mut options.spec, &self.args.reading);
        set_skin(&mut options.skin, &self.args.surface);
        options.skin.seed = self.seed(input.project.as_deref());
        options.classes.extend(self.classes.for_drawing(&input.read.drawing.name));
        options.leaf.clone_from(&self.leaf);
        if let Some(materials) = &self.materials {
            options.skin.worn = materials.worn();
        }
        options
    }

    fn seed(&self, project: Option<&DocumentPlant>) -> Seed {
        let own = || project.map_or_else(Seed::default, |p| p.settings().seed);
        self.args.seed.map_or_else(own, Seed::new)
    }

    fn report(&self, project: Option<&DocumentPlant>) -> RunReport {
        let mut report = RunReport::new("sketch", self.seed(project).number());
        report.engine = self.args.surface.export.report();
        let paths = self.args.inputs.iter().map(|p| p.display().to_string());
        report.input.path = paths.collect::<Vec<_>>().join(", ");
        report
    }

    /// Makes the only drawing of the only input.
    fn one(&self, machine: &Machine) -> Outcome<RunReport> {
        let input = &self.args.inputs[0];
        // An output that cannot be written is reported before an existing file in its place.
        self.args.output.as_deref().map(files::plant_writable).transpose()?;
        let outputs = [
            ("-o", self.args.output.as_ref()),
            ("--png", self.args.png.as_ref()),
            ("--qsm", self.args.qsm.as_ref()),
            ("--split", self.args.split.as_ref()),
            ("--report", self.args.common.report.as_ref()),
        ];
        let mut outputs = Outputs::new(&outputs, &self.inputs())?;
        let beside = self.args.surface.export.lod_files();
        let plan = |path| files::plan_plant(&mut outputs, path, beside);
        let format = self.args.output.as_deref().map(plan).transpose()?;
        let (first, read_ms) = machine.timed(|| -> Outcome<(Input, Source)> {
            let mut drawings = open(input)?;
            let first = drawings.next().ok_or_else(|| Failure::bad_file(input, "holds no drawing"))?;
            Ok((first.map_err(|e| Failure::bad_file(input, e))?, drawings))
        });
        let (read, mut drawings) = first?;
        if drawings.next().is_some() {
            return Err(Failure::bad_file(
                input,
                "holds several drawings; give a folder: -o FOLDER (one model each)",
            ));
        }
        let mut report = self.report(read.project.as_deref());
        report.input.drawings = 1;
        report.input.strokes = read.read.drawing.strokes.len() as u64;
        let target = Target {
            plant: self.args.output.clone().zip(format),
            png: self.args.png.clone(),
            qsm: self.args.qsm.clone(),
            of_many: false,
        };
        if let Some(path) = &self.args.split {
            let document = self.split(&read, &machine.run()).map_err(|failure| failure.in_file(input))?;
            project::save(&mut outputs, "--split", path, &document)?;
        }
        let clocked = (machine, [read_ms, machine.whole_ms()], &machine.run());
        let made = self.made(&read, format, &machine.run()).map_err(|failure| failure.in_file(input))?;
        let mut items = self.write(made, &read, &target, clocked, &mut PngCache::new(), &mut outputs)?;
        items[0].timings_ms.total = machine.whole_ms();
        report.ok = 1;
        self.warn_of_unused(&mut report);
        report.items = items;
        crate::report::finish(&report, &self.args.common, outputs)?;
        if !machine.quiet {
            let item = &report.items[0];
            for warning in item.warnings.iter().chain(&report.warnings) {
                say::warning(&format!("{}: {warning}", input.display()));
            }
            say::line(&crate::report::summary(item, self.args.png.as_deref()));
            report.items[1..].iter().for_each(|i| say::line(&crate::report::summary(i, None)));
        }
        Ok(report)
    }

    fn warn_of_unused(&self, report: &mut RunReport) {
        for name in self.classes.unused() {
            report
                .warnings
                .push(format!("the class file names drawing \"{name}\", which is not among the input"));
        }
    }

    /// Returns every file that options name.
    fn inputs(&self) -> Vec<&PathBuf> {
        let reading = &self.args.reading;
        let surface = &self.args.surface.skin.materials;
        let settings = [&reading.spec, &reading.classes, &reading.leaf_template, surface];
        self.args.inputs.iter().chain(settings.into_iter().flatten()).collect()
    }

    /// Makes one plant.
    fn made(&self, input: &Input, format: Option<PlantFormat>, run: &Run<'_>) -> Outcome<(Made, Levels)> {
        let seed = self.seed(input.project.as_deref());
        let levels = self.args.surface.export.levels(format);
        let made = make_levels_from_sketch(&input.read.drawing, &self.options(input), (seed, &levels), run);
        let (made, levels) = made.map_err(|e| match e {
            MakeError::Cancelled(_) => Failure::Cancelled,
            other => Failure::Bad(other.to_string()),
        })?;
        checks::accept(std::slice::from_ref(&made.item), &self.args.checks)?;
        Ok((made, levels))
    }

    /// Returns the drawing as a document in which each of its plants is a separate one.
    fn split(&self, input: &Input, run: &Run<'_>) -> Outcome<Document> {
        let SketchOptions { spec, skin, classes, photo, .. } = self.options(input);
        // A project has the materials of its strokes and organs, its layers and its pictures.
        let mut document = Document::from_drawing(&input.read.drawing);
        if let Some(project) = input.project.as_deref() {
            document.dress(project);
        }
        let [plant] = document.plants() else { return Err(Failure::Bug("a drawing is one plant".into())) };
        let (id, ids) = (plant.id(), plant.strokes().iter().map(|s| s.id).collect::<Vec<_>>());
        let mut commands = vec![
            SketchCommand::SetSketch(Box::new(spec)).for_plant(id),
            SketchCommand::SetSkin(skin).for_plant(id),
            PlantCommand::SetSeed(self.seed(input.project.as_deref())).for_plant(id),
        ];
        commands.extend(photo.map(|p| SketchCommand::SetPhoto(Box::new(p)).for_plant(id)));
        let said = classes.iter().filter_map(|(&row, &class)| Some((*ids.get(row as usize)?, class)));
        commands.extend(
            said.map(|(stroke, class)| SketchCommand::SetClass(vec![stroke], Some(class)).for_plant(id)),
        );
        let mut editor = Editor::new(match &self.materials {
            Some(materials) => materials.on(document, id)?,
            None => document,
        });
        for command in commands {
            match editor.run(command) {
                Ok(()) | Err(CommandError::Nothing(_)) => {}
                Err(e) => return Err(Failure::Bad(e.to_string())),
            }
        }
        burgeon::split(&mut editor, id, run).map_err(|e| match e {
            SplitError::Make(MakeError::Cancelled(_)) => Failure::Cancelled,
            other => Failure::Bad(other.to_string()),
        })?;
        Ok(editor.document().clone())
    }

    /// Writes a plant's files, which are not yet in place.
    fn write(
        &self,
        (made, levels): (Made, Levels),
        input: &Input,
        target: &Target,
        (machine, [read_ms, begun], run): (&Machine, [f64; 2], &Run<'_>),
        cache: &mut PngCache,
        outputs: &mut Outputs,
    ) -> Outcome<Vec<ItemReport>> {
        let Input { read, project } = input;
        let seed = self.seed(project.as_deref());
        let Made { plant, model, mut item, .. } = made;
        let mut warnings: Vec<String> = read.warnings.iter().map(ToString::to_string).collect();
        warnings.append(&mut item.warnings);
        item.warnings = warnings;
        run.cancel.check()?;
        item.timings_ms.add_io(read_ms, 0.0);
        if let Some(path) = &target.qsm {
            files::write_qsm(outputs, path, &plant, &self.args.axes)?;
        }
        if self.args.common.reports() {
            let (measured, ms) = machine.timed(|| plant.measure());
            item.plant = Some(measured);
            item.timings_ms.measure += ms;
        }
        if let Some(png) = &target.png {
            let (drawn, ms) = machine.timed(|| -> Outcome<()> {
                let drawn = burgeon::render::render(&model, &self.args.picture.spec(seed.number()), run)?;
                picture::write(outputs, "--png", png, &drawn)
            });
            drawn?;
            item.timings_ms.picture += ms;
        }
        let mut items = vec![item];
        if let Some((path, format)) = &target.plant {
            let form = Form::new(path, *format, &self.args.surface.export, &self.args.axes);
            let form = Form { goal: Goal { of_many: target.of_many, ..form.goal }, ..form };
            let whole = Whole { plant: &plant, model, levels };
            levels::write(outputs, &form, whole, &mut items, cache, machine)?;
        }
        items[0].timings_ms.total = read_ms + machine.whole_ms() - begun;
        Ok(items)
    }

    /// Makes every drawing of every input, spread over threads; memory holds one drawing for each thread.
    fn batch(&self, machine: &Machine) -> Outcome<RunReport> {
        self.classes.fits_batch(self.args.reading.classes.as_deref())?;
        let mut outputs = Outputs::new(&[], &self.inputs())?;
        for folder in [&self.args.output, &self.args.png, &self.args.qsm].into_iter().flatten() {
            outputs.folder(folder)?;
        }
        if let Some(path) = &self.args.common.report {
            outputs.plan("--report", path)?;
        }
        let queue = Mutex::new(Queue::new(&self.args.inputs));
        let done = Mutex::new(Done::default());
        let strokes = AtomicU64::new(0);
        let keep_items = self.args.common.reports();
        machine.with_progress("drawings to plants", |progress| {
            burgeon::map_indexed(&machine.threads, machine.threads.count, |_| {
                let mut cache = PngCache::new();
                while machine.cancel.check().is_ok() {
                    let Some(next) = pull(&queue, machine, progress) else { break };
                    let outcome = next.read.and_then(|read| {
                        strokes.fetch_add(read.read.drawing.strokes.len() as u64, Ordering::Relaxed);
                        let run = machine.single();
                        let (target, clocked) =
                            (self.target(&next.name), (machine, [next.read_ms, machine.whole_ms()], &run));
                        let made = self.made(&read, target.plant.as_ref().map(|(_, f)| *f), &run)?;
                        let mut own = outputs.for_one();
                        let items = self.write(made, &read, &target, clocked, &mut cache, &mut own)?;
                        own.place().map(|()| items)
                    });
                    if let Ok(mut done) = done.lock() {
                        done.add(next.index, &next.place, outcome, keep_items);
                    }
                }
            })
        });
        machine.cancel.check()?;
        let (Ok(done), Ok(queue)) = (done.into_inner(), queue.into_inner()) else {
            return Err(Failure::Bug("a thread of the batch died".into()));
        };
        let mut report = self.report(None);
        report.input.drawings = queue.count;
        report.input.strokes = strokes.into_inner();
        self.close(report, done, outputs, machine)
    }

    fn close(
        &self,
        mut report: RunReport,
        mut done: Done,
        outputs: Outputs,
        machine: &Machine,
    ) -> Outcome<RunReport> {
        if let Some(bug) = done.bug {
            return Err(Failure::Bug(bug));
        }
        done.items.sort_by_key(|(index, _)| *index);
        done.failures.sort_by_key(|(index, _)| *index);
        report.ok = done.ok;
        report.failed = done.failed;
        report.items = done.items.into_iter().map(|(_, item)| item).collect();
        report.warnings = done.failures.into_iter().map(|(_, line)| line).collect();
        report.warnings.iter().take(TOLD_FAILURES).for_each(|line| say::error(line));
        let listed = report.warnings.len() as u64;
        if listed < done.failed {
            report.warnings.push(format!("{} failures more are not listed", done.failed - listed));
        }
        let more = done.failed.saturating_sub(TOLD_FAILURES as u64);
        if more > 0 {
            let more = say::counted(more, "drawing", "drawings");
            say::error(&format!("{more} more failed; --report FILE.json lists them"));
        }
        let failures = report.warnings.len();
        self.warn_of_unused(&mut report);
        crate::report::finish(&report, &self.args.common, outputs)?;
        if !machine.quiet {
            report.warnings[failures..].iter().for_each(|w| say::warning(w));
            if done.warnings > 0 {
                let count = say::counted(done.warnings, "warning", "warnings");
                say::warning(&format!("{count} about single drawings; --report FILE.json lists them"));
            }
            let args = &self.args;
            let folder = args.output.as_deref().or(args.png.as_deref()).or(args.qsm.as_deref());
            let folder = folder.map_or_else(String::new, |f| format!(" in {}", f.display()));
            let failed = match report.failed {
                0 => String::new(),
                n => format!(", {} failed", say::counted(n, "drawing", "drawings")),
            };
            let made = say::counted(report.ok, "plant", "plants");
            say::line(&format!(
                "{made}{folder}{failed}; {:.1} s",
                burgeon::Clock::now_ms(&machine.clock) / 1000.0
            ));
        }
        Ok(report)
    }

    fn target(&self, name: &str) -> Target {
        let extension = self.args.format.0.extension();
        let file = |folder: &PathBuf, extension: &str| folder.join(format!("{name}.{extension}"));
        Target {
            plant: self.args.output.as_ref().map(|f| (file(f, extension), self.args.format.0)),
            png: self.args.png.as_ref().map(|f| file(f, "png")),
            qsm: self.args.qsm.as_ref().map(|f| file(f, "csv")),
            of_many: true,
        }
    }
}

/// Files of one plant.
struct Target {
    plant: Option<(PathBuf, PlantFormat)>,
    png: Option<PathBuf>,
    qsm: Option<PathBuf>,
    /// Whether it is one of a batch.
    of_many: bool,
}

/// Most failures of a batch that are printed on stderr.
const TOLD_FAILURES: usize = 20;
/// Most failures of a batch that are kept for the report: a file of noise may have millions of lines.
const LISTED_FAILURES: usize = 10_000;

/// Results of a batch so far.
#[derive(Default)]
struct Done {
    ok: u64,
    warnings: u64,
    items: Vec<(u64, ItemReport)>,
    failed: u64,
    /// The first of them, at most [`LISTED_FAILURES`].
    failures: Vec<(u64, String)>,
    bug: Option<String>,
}

impl Done {
    fn add(&mut self, index: u64, place: &str, outcome: Outcome<Vec<ItemReport>>, keep: bool) {
        match outcome {
            Ok(items) => {
                self.ok += 1;
                self.warnings += items.iter().map(|item| item.warnings.len() as u64).sum::<u64>();
                if keep {
                    self.items.extend(items.into_iter().map(|item| (index, item)));
                }
            }
            Err(Failure::Bad(line)) => {
                self.failed += 1;
                if self.failures.len() < LISTED_FAILURES {
                    self.failures.push((index, format!("{place}: {line}")));
                }
            }
            Err(Failure::Bug(line)) => self.bug = Some(format!("{place}: {line}")),
            Err(Failure::Reported | Failure::Cancelled) => {}
        }
    }
}

/// One drawing of a batch, or the reason why it could not be read.
struct Next {
    index: u64,
    /// Its origin, for messages.
    place: String,
    /// A name that is safe and unique in the folder.
    name: String,
    read: Outcome<Input>,
    read_ms: f64,
}

/// A drawing, and the project that contains it.
struct Input {
    read: ReadDrawing,
    project: Option<Box<DocumentPlant>>,
}

/// Contents of a file: drawings one at a time, or the only one of a project.
enum Source {
    Drawings(Drawings<files::Input>),
    Project(Option<Box<Input>>),
}

impl Source {
    fn next(&mut self) -> Option<Result<Input, DrawingError>> {
        match self {
            Self::Drawings(drawings) => Some(drawings.next()?.map(|read| Input { read, project: None })),
            Self::Project(input) => Some(Ok(*input.take()?)),
        }
    }
}

/// The drawings of all inputs in order, read one at a time.
struct Queue<'a> {
    inputs: std::slice::Iter<'a, PathBuf>,
    open: Option<(&'a PathBuf, Source, u64)>,
    names: BTreeMap<String, u64>,
    count: u64,
    files: usize,
}

impl<'a> Queue<'a> {
    fn new(inputs: &'a [PathBuf]) -> Self {
        Self { inputs: inputs.iter(), open: None, names: BTreeMap::new(), count: 0, files: 0 }
    }

    fn next(&mut self) -> Option<(String, Outcome<Input>)> {
        loop {
            if let Some((path, drawings, of_file)) = &mut self.open {
                if let Some(item) = drawings.next() {
                    *of_file += 1;
                    let place = path.display().to_string();
                    return Some((place, item.map_err(|e| Failure::Bad(e.to_string()))));
                }
                let empty = *of_file == 0;
                let place = path.display().to_string();
                self.open = None;
                if empty {
                    return Some((place, Err(Failure::Bad("holds no drawing".into()))));
                }
            }
            let path = self.inputs.next()?;
            self.files += 1;
            match open(path) {
                Ok(drawings) => self.open = Some((path, drawings, 0)),
                Err(Failure::Bad(line)) => {
                    let place = path.display().to_string();
                    let line = line.trim_start_matches(&place).trim_start_matches(": ").to_owned();
                    return Some((place, Err(Failure::Bad(line))));
                }
                Err(other) => return Some((path.display().to_string(), Err(other))),
            }
        }
    }
}

// Under the lock: the next drawing gets its number and its name, so that both are the same for any number of threads.
fn pull(queue: &Mutex<Queue<'_>>, machine: &Machine, progress: &Progress) -> Option<Next> {
    let mut queue = queue.lock().ok()?;
    let (next, read_ms) = machine.timed(|| queue.next());
    let (mut place, read) = next?;
    let index = queue.count;
    queue.count += 1;
    progress.expect(queue.inputs.len() + queue.files);
    progress.reached(queue.files.saturating_sub(1));
    let mut name = String::new();
    if let Ok(read) = &read {
        name = names::unique(&mut queue.names, &names::safe(&read.read.drawing.name));
        place = format!("{place}, drawing \"{}\"", read.read.drawing.name);
    }
    Some(Next { index, place, name, read, read_ms })
}

fn open(path: &Path) -> Outcome<Source> {
    match files::open(path)? {
        (file, Kind::Drawing(format)) => {
            Ok(Source::Drawings(read_drawings(file, format, &files::stem(path))))
        }
        (file, Kind::Project) => {
            let document = files::read_project(path, file)?;
            let (read, plant) = files::drawing_of(path, &document)?;
            let project = Some(Box::new(plant.clone()));
            Ok(Source::Project(Some(Box::new(Input { read, project }))))
        }
        (_, Kind::Model(format)) => Err(Failure::bad_file(
            path,
            format_args!("is a model ({}), not a drawing; `burgeon render` makes its picture", format.word()),
        )),
        (_, Kind::Structure(format)) => Err(Failure::bad_file(
            path,
            format_args!(
                "is the structure of a plant ({}), not a drawing; `burgeon shape` makes a model of it",
                format.name()
            ),
        )),
    }
}

/// Whether an output names a folder: it is one, ends like one, or has no extension. `known` are the extensions of its
/// files; any other is refused rather than made a folder.
fn names_folder(
    path: &Path,
    option: &str,
    known: impl Fn(&str) -> bool,
    formats: &str,
    many: bool,
) -> Outcome<bool> {
    if path.as_os_str() == "-" {
        return output::check_target(path).map(|()| false);
    }
    if path.is_dir() || path.as_os_str().to_string_lossy().ends_with(['/', std::path::MAIN_SEPARATOR]) {
        return Ok(true);
    }
    match files::extension(path) {
        None => Ok(true),
        Some(e) if !known(e) => Err(Failure::bad_file(
            path,
            format_args!("{formats}; end {option} with one of them, or with / for a folder"),
        )),
        Some(_) if many => Err(Failure::bad_file(
            path,
            format_args!("names one file for several drawings; give a folder: {option} FOLDER"),
        )),
        Some(_) => Ok(false),
    }
}

fn set_sketch(spec: &mut SketchSpec, args: &ReadingArgs) {
    spec.read_as = args.read_as.or(spec.read_as);
    spec.height_m = args.height.or(spec.height_m);
    spec.branch_depth = args.branch_depth.map_or(spec.branch_depth, Into::into);
    spec.leaf_depth = args.leaf_depth.map_or(spec.leaf_depth, Into::into);
    if !args.flip_flowers.is_empty() {
        spec.flipped_flowers.clone_from(&args.flip_flowers);
    }
    spec.fill.density = args.density.unwrap_or(spec.fill.density);
    spec.fill.tropism = args.tropism.unwrap_or(spec.fill.tropism);
    spec.pipe_exponent = args.pipe_exponent.or(spec.pipe_exponent);
    spec.phototropism = args.phototropism.unwrap_or(spec.phototropism);
    spec.gravity = args.gravity.unwrap_or(spec.gravity);
}

fn set_skin(skin: &mut SkinSpec, args: &SurfaceArgs) {
    args.skin.set(skin);
    skin.wind |= args.export.sway;
    skin.foliage = args.export.foliage();
    skin.petals = args.petals.map(Into::into).or(skin.petals);
    skin.variation = args.variation.unwrap_or(skin.variation);
}
