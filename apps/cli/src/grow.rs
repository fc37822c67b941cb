//! `burgeon grow`: a species or a spec to a tree.

use std::cell::RefCell;
use std::path::Path;

use burgeon::formats::{CloudFormat, ExportSpec, ModelFormat, PngCache, Room};
use burgeon::glam::DVec3;
use burgeon::growth::{
    ColonizeSpec, CompetitionSpec, Envelope, GrowthError, GuidedSpec, Method, OAK_RULES, Obstacle,
    SelfOrganizingSpec,
};
use burgeon::skin::SkinSpec;
use burgeon::{
    HeightError, ItemReport, LeafTemplate, MadeTree, NamedMesh, Preset, Report, RunReport, Seed, TreeError,
    TreeGoal, TreeOptions, TreeSpec, aim_at, make_tree, method_word, read_tree_spec,
};

use crate::args::{GrowArgs, MethodWord, PlantFormat, PointsArgs, Seen};
use crate::failure::{Failure, Outcome};
use crate::levels::{Form, Whole};
use crate::machine::Machine;
use crate::materials::Materials;
use crate::origin::Origin;
use crate::output::Outputs;
use crate::{checks, files, inputs, levels, picture, report, say};

pub(crate) fn grow(args: &GrowArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = [
        ("-o", args.output.as_ref()),
        ("--png", args.png.as_ref()),
        ("--qsm", args.qsm.as_ref()),
        ("--drawing", args.drawing.as_ref()),
        ("--report", args.common.report.as_ref()),
    ];
    let inputs = args.what.iter().chain(&args.growth.obstacle).chain(&args.points.attractors);
    let inputs = inputs.chain(&args.growth.leaf_template).chain(&args.surface.skin.materials);
    let mut outputs = Outputs::new(&outputs, &inputs.collect::<Vec<_>>())?;
    let plan = |path| files::plan_plant(&mut outputs, path, args.surface.export.lod_files());
    let format = args.output.as_deref().map(plan).transpose()?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    if let Some(path) = &args.drawing {
        files::drawing_writable(path)?;
    }
    check_used(args, format)?;
    let mut told = Report::default();
    let mut origin = Origin::default();
    let (spec, read_ms) = machine.timed(|| asked(args, &mut origin, &mut told));
    let mut spec = spec?;
    let leaves = ["leaf_keep", "leaf_template"];
    args.given.only_if(!spec.bare, &leaves, "trees with leaves", "this one is bare")?;
    let sheds = !spec.bare && spec.look.autumn_color.is_some();
    args.given.only_if(
        sheds,
        &["season"],
        "trees that shed their leaves",
        "this one is bare or an evergreen",
    )?;
    let leaf = leaf_of(args, &mut spec, &machine)?;
    let materials = args.surface.skin.materials.as_deref().map(Materials::read).transpose()?;
    outputs.check()?;
    let seed = Seed::new(args.seed);
    let height_m = set_age(args, &mut spec, seed, &machine)?;
    let options = TreeOptions {
        skin: SkinSpec { worn: materials.unwrap_or_default().worn(), ..args.surface.spec() },
        leaf,
        levels: args.surface.export.levels(format),
        height_m,
        ..TreeOptions::default()
    };
    let made = machine.with_progress("grow", |_| make_tree(&spec, seed, &options, &machine.run()));
    let MadeTree { grown, mut model, layout, mut levels, mut item } =
        made.map_err(|e| failure(args, &spec, e))?;
    let without = levels.copies.iter_mut().map(|(rest, _)| rest);
    levels.lods.iter_mut().chain([&mut model]).chain(without).for_each(|m| m.offset_m = origin.offset_m);
    machine.cancel.check()?;
    item.warnings.splice(0..0, told.warnings.iter().map(ToString::to_string));
    item.timings_ms.add_io(read_ms, 0.0);
    if args.common.reports() {
        item.plant = Some(grown.plant.measure());
    }
    let mut items = vec![item];
    checks::accept(&items, &args.checks).map_err(|f| f.in_file(Path::new(&named(args))))?;
    if let Some((path, format)) = args.output.as_deref().zip(format) {
        let form = Form::new(path, format, &args.surface.export, &args.axes);
        let whole = Whole { plant: &grown.plant, model: model.clone(), levels };
        levels::write(&mut outputs, &form, whole, &mut items, &mut PngCache::new(), &machine)?;
    }
    if let Some(path) = &args.qsm {
        files::write_qsm(&mut outputs, path, &grown.plant, &args.axes)?;
    }
    if let Some(path) = &args.drawing {
        let lines = burgeon::drawn((&grown.plant, &model, &layout), &machine.run())?;
        files::write_drawing(&mut outputs, path, &spec.name, &lines)?;
    }
    if let Some(png) = &args.png {
        let view = args.picture.spec(args.seed);
        let mut shown = model;
        burgeon::show_obstacles(&mut shown, &spec.obstacles);
        let drawn =
            machine.with_progress("picture", |_| burgeon::render::render(&shown, &view, &machine.run()))?;
        picture::write(&mut outputs, "--png", png, &drawn)?;
    }
    items[0].timings_ms.total = machine.whole_ms();
    let mut run = RunReport::new("grow", args.seed);
    run.engine = args.surface.export.report();
    run.input.path = named(args);
    run.input.offset_m = origin.offset_in(&files::axes(args.axes.up, args.axes.unit));
    run.ok = 1;
    run.items = items;
    report::finish(&run, &args.common, outputs)?;
    if !machine.quiet {
        for item in &run.items {
            item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", item.name)));
        }
        say::line(&summary(&run.items[0], args.png.as_deref()));
        run.items[1..].iter().for_each(|i| say::line(&report::summary(i, None)));
    }
    Ok(())
}

/// Sets the age at which the tree has the height of --height or the diameter of --dbh; returns the height to which it is
/// scaled.
fn set_age(args: &GrowArgs, spec: &mut TreeSpec, seed: Seed, machine: &Machine) -> Outcome<Option<f64>> {
    let free = spec.obstacles.is_empty();
    args.given.only_if(free, &["height", "dbh"], "trees without obstacles", "this one would meet its own")?;
    let goal = match (args.growth.height, args.growth.dbh) {
        (_, Some(dbh)) => TreeGoal::Dbh(dbh),
        (Some(height), None) => TreeGoal::Height(height),
        (None, None) => return Ok(None),
    };
    let fail = |spec: &TreeSpec, e: HeightError| match e {
        HeightError::Tree(e) => failure(args, spec, e),
        e => Failure::bad_file(Path::new(&named(args)), format_args!("--{}: {e}", goal.word())),
    };
    aim_at(spec, seed, goal, &machine.run()).map(Some).map_err(|e| fail(spec, e))
}

/// Fails on unused options.
fn check_used(args: &GrowArgs, format: Option<PlantFormat>) -> Outcome {
    let given = &args.given;
    given.check_picture(args.png.is_some(), &args.picture)?;
    let seen = Seen::new(format, args.png.as_ref(), &args.common);
    // A drawing shows the meshes.
    given.check_surface(Seen { report: seen.report || args.drawing.is_some(), ..seen })?;
    let written = args.qsm.is_some() || format.is_some_and(|f| f.holds(Room::Axes));
    args.surface.check_used(given, format, args.png.is_some())?;
    let plain = args.growth.leaf_template.is_none();
    given.only_if(plain, &["foliage"], "leaves of the species", "--leaf-template gives another")?;
    let read = !args.growth.obstacle.is_empty() || args.points.attractors.is_some();
    given.check_axes(written || read || !args.points.root.is_empty())
}

fn named(args: &GrowArgs) -> String {
    let path = args.what.as_ref().or(args.points.attractors.as_ref());
    path.map_or_else(|| "tree".into(), |p| p.display().to_string())
}

fn summary(item: &ItemReport, png: Option<&Path>) -> String {
    let line = report::summary(item, png);
    let Some(g) = &item.growth else { return line };
    let points = if g.attractors > 0 {
        format!(", {} of {} points consumed", say::grouped(g.consumed), say::grouped(g.attractors))
    } else {
        String::new()
    };
    line.replacen("; ", &format!(" by {}{points}; ", g.method), 1)
}

fn failure(args: &GrowArgs, spec: &TreeSpec, error: TreeError) -> Failure {
    if matches!(error, TreeError::Cancelled(_)) {
        return Failure::Cancelled;
    }
    // Meshes of --obstacle come after those of the spec.
    let own = spec.obstacles.len() - args.growth.obstacle.len();
    let at = |error: &dyn std::fmt::Display| Failure::bad_file(Path::new(&named(args)), error);
    match error {
        TreeError::Growth(GrowthError::Obstacle { obstacle, fault, .. }) if obstacle >= own => {
            let path = &args.growth.obstacle[obstacle - own];
            let name = path.display().to_string();
            at(&GrowthError::Obstacle { obstacle, name, fault })
        }
        TreeError::Growth(e @ GrowthError::Nothing { .. }) if args.points.attractors.is_some() => {
            at(&e.to_string().replace("(kill_m)", "(--kill)").replace("(attraction_m)", "(--influence)"))
        }
        other => match args.what.as_deref().filter(|what| what.is_file()).map(files::read_text) {
            Some(Ok(text)) => at(&other.in_text(&text)),
            _ => at(&other),
        },
    }
}

/// Returns the spec with the options applied.
fn asked(args: &GrowArgs, origin: &mut Origin, told: &mut Report) -> Outcome<TreeSpec> {
    let mut spec = match &args.what {
        Some(what) => read_spec(what, told)?,
        None => TreeSpec::default(),
    };
    if let Some(method) = args.growth.method
        && method.word() != method_word(&spec.method)
    {
        let envelope = envelope_of(&spec.method).cloned();
        spec.method = default_method(method, envelope);
        spec.name = format!("{} by {}", spec.name, method.word());
    }
    if let Some(path) = &args.points.attractors {
        let points = read_points(path, args, origin, told)?;
        if args.what.is_none() {
            spec.name = files::stem(path);
        }
        spec.method = Method::Points { points, steps: steps_of(&spec.method) };
    }
    let axes = files::axes(args.axes.up, args.axes.unit);
    distances(&args.points, axes.unit.metres(), &mut spec.method)?;
    if !args.points.root.is_empty() {
        spec.roots = args.points.root.iter().map(|p| axes.inward(*p)).collect();
    }
    if origin.offset_m.is_some() {
        if args.points.root.is_empty() {
            return Err(Failure::Bad(
                "the points lie far from the origin: say with --root X,Y,Z, in their coordinates, where the tree stands"
                    .into(),
            ));
        }
        spec.roots.iter_mut().for_each(|r| *r = origin.place(*r));
    }
    for path in &args.growth.obstacle {
        let (model, _, warnings) = files::read_model(path, &axes)?;
        told.warnings.extend(warnings);
        let (vertices, triangles) = model.triangles();
        if triangles.is_empty() {
            let why = "has no faces, so there is nothing to grow around; export the obstacle as a mesh";
            return Err(Failure::bad_file(path, why));
        }
        spec.obstacles.push(Obstacle::Mesh { vertices, triangles });
    }
    if let Some(keep) = args.growth.leaf_keep {
        spec.leaves.leaf_keep = keep;
    }
    spec.age = args.growth.age.or(spec.age);
    spec.look.season = args.growth.season.unwrap_or(spec.look.season);
    Ok(spec)
}

/// Returns the leaf of --leaf-template, or the one that the spec names, next to the spec.
fn leaf_of(args: &GrowArgs, spec: &mut TreeSpec, machine: &Machine) -> Outcome<Option<LeafTemplate>> {
    let named = spec.blade.file.take();
    let path = match (&args.growth.leaf_template, named) {
        (Some(path), _) => Some(path.clone()),
        (None, Some(file)) => {
            Some(inputs::named_path(args.what.as_deref().unwrap_or(Path::new("spec.toml")), &file)?)
        }
        (None, None) => None,
    };
    path.map(|p| crate::leaf_data::template_of(&p, args.seed, machine)).transpose()
}

/// Reads the species whose leaves a plant that did not grow by it gets (`--leaves`).
pub(crate) fn read_leaves(what: &Path, told: &mut Report) -> Outcome<TreeSpec> {
    let spec = read_spec(what, told)?;
    if spec.bare || spec.blade.file.is_some() {
        return Err(Failure::Bad("--leaves: this species bears no leaves of its own; name another".into()));
    }
    Ok(spec)
}

/// Reads a preset by its key, or a file.
pub(crate) fn read_spec(what: &Path, told: &mut Report) -> Outcome<TreeSpec> {
    let key = what.to_str().unwrap_or_default();
    let preset = Preset::find(key).filter(|_| !what.is_file());
    if let Some(preset) = preset {
        return preset.spec().map_err(|e| Failure::Bug(format!("preset {key}: {e}")));
    }
    if files::extension(what).is_none() && !what.exists() && !inputs::is_stdin(what) {
        let hint = burgeon::meant(key, burgeon::PRESETS.iter().map(|p| p.key));
        return Err(Failure::Bad(format!(
            "there is no preset `{key}`; `burgeon presets` lists them, and a spec's name ends with .toml{hint}"
        )));
    }
    spec_of(what, &files::read_text(what)?, told)
}

/// Reads the spec of a text that was read from `what`.
pub(crate) fn spec_of(what: &Path, text: &str, told: &mut Report) -> Outcome<TreeSpec> {
    let (warnings, failed) = (RefCell::new(Vec::new()), RefCell::new(None));
    let open = |name: &str| match named_mesh(what, name, &mut warnings.borrow_mut()) {
        Ok(mesh) => mesh,
        Err(failure) => {
            failed.replace(Some(failure));
            None
        }
    };
    let spec = read_tree_spec(text, &open);
    // Reports the fault of the file, rather than that it is useless.
    if let Some(failure) = failed.into_inner() {
        return Err(failure);
    }
    let mut spec = spec.map_err(|e| Failure::bad_file(what, e))?;
    if spec.name == TreeSpec::default().name {
        spec.name = files::stem(what);
    }
    told.warnings.extend(warnings.into_inner());
    Ok(spec)
}

/// Reads a mesh or cloud that a spec names, next to the spec; `None` if there is no such file. In metres, +Y up.
fn named_mesh(spec: &Path, name: &str, warnings: &mut Vec<burgeon::Warning>) -> Outcome<Option<NamedMesh>> {
    let path = inputs::named_path(spec, name)?;
    let known = |e| CloudFormat::from_extension(e).is_some() || ModelFormat::from_extension(e).is_some();
    if !path.exists() || !files::extension(&path).is_some_and(known) {
        return Ok(None);
    }
    let axes = ExportSpec::default();
    if let Some(format @ (CloudFormat::Xyz | CloudFormat::Pcd | CloudFormat::Las | CloudFormat::E57)) =
        files::extension(&path).and_then(CloudFormat::from_extension)
    {
        let mut report = Report::default();
        let cloud = files::read_cloud(&path, (files::open_bytes(&path)?, format), &axes, &mut report)?;
        warnings.extend(report.warnings);
        return Ok(Some((cloud.points, Vec::new())));
    }
    let (model, _, told) = files::read_model(&path, &axes)?;
    warnings.extend(told);
    Ok(Some(model.triangles()))
}

fn read_points(path: &Path, args: &GrowArgs, origin: &mut Origin, told: &mut Report) -> Outcome<Vec<DVec3>> {
    let axes = files::axes(args.axes.up, args.axes.unit);
    let mut points = files::read_cloud(path, files::open_cloud(path)?, &axes, told)?.points;
    origin.bring(&mut points, &axes, told);
    Ok(points)
}

fn envelope_of(method: &Method) -> Option<&Envelope> {
    match method {
        Method::Colonization { envelope, .. } => Some(envelope),
        Method::Competition(s) => Some(&s.envelope),
        Method::Guided(s) => s.envelope.as_ref(),
        _ => None,
    }
}

fn steps_of(method: &Method) -> ColonizeSpec {
    match method {
        Method::Colonization { steps, .. } | Method::Points { steps, .. } => steps.clone(),
        _ => ColonizeSpec::default(),
    }
}

fn default_method(word: MethodWord, envelope: Option<Envelope>) -> Method {
    let envelope = envelope.unwrap_or_default();
    match word {
        MethodWord::Competition => {
            Method::Competition(CompetitionSpec { envelope, ..CompetitionSpec::default() })
        }
        MethodWord::Colonization => {
            Method::Colonization { envelope, points: 1500, hollow: 0.0, steps: ColonizeSpec::default() }
        }
        MethodWord::Guided => Method::Guided(GuidedSpec::from_crown(envelope)),
        MethodWord::SelfOrganizing => Method::SelfOrganizing(SelfOrganizingSpec::default()),
        MethodWord::Lsystem => Method::Lsystem { rules: OAK_RULES.into(), most_modules: 5_000_000 },
    }
}

/// Applies --step, --influence and --kill to the methods that have them.
fn distances(args: &PointsArgs, metres: f64, method: &mut Method) -> Outcome {
    let [step_m, influence_m, kill_m] = [args.step, args.influence, args.kill].map(|x| Some(x? * metres));
    if [step_m, influence_m, kill_m].iter().all(Option::is_none) {
        return Ok(());
    }
    if let (Some(kill), Some(influence)) = (args.kill, args.influence)
        && kill > influence
    {
        return Err(Failure::Bad(format!(
            "--kill {kill} is above --influence {influence}: points would be consumed before they attract; make \
             --kill at most {influence}"
        )));
    }
    let (attraction, kill, step) = match method {
        Method::Colonization { steps, .. } | Method::Points { steps, .. } => {
            (&mut steps.attraction_m, &mut steps.kill_m, &mut steps.step_m)
        }
        Method::Competition(s) => (&mut s.attraction_m, &mut s.kill_m, &mut s.step_m),
        _ => {
            return Err(Failure::Bad(
                "--step, --influence and --kill are for --method competition and colonization, and for --attractors"
                    .into(),
            ));
        }
    };
    *attraction = influence_m.unwrap_or(*attraction);
    *kill = kill_m.unwrap_or(*kill);
    *step = step_m.or(*step);
    Ok(())
}
