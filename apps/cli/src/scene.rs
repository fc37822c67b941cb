//! `burgeon sketch SCENE.burgeon`: every plant of a project that holds more than one drawing.

use std::path::Path;

use burgeon::document::{Document, DocumentPlant};
use burgeon::formats::{PngCache, Room, write_glb_scene};
use burgeon::mesh::Standing;
use burgeon::{RunReport, SceneEvaluator, scene_model, standing};

use crate::args::{EXPORT, Seen, SketchArgs};
use crate::failure::{Failure, Outcome};
use crate::files::{self, Goal, Kind};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{picture, say};

/// Returns the document of a project that is more than one drawing; `None` for all other files.
pub(crate) fn read_file(path: &Path) -> Outcome<Option<Document>> {
    // Tested only by its name: standard input can be opened once.
    if !files::extension(path).is_some_and(|e| e.eq_ignore_ascii_case("burgeon")) {
        return Ok(None);
    }
    let (input, kind) = files::open(path)?;
    if !matches!(kind, Kind::Project) {
        return Ok(None);
    }
    let document = files::read_project(path, input)?;
    Ok(document.only_sketch().is_none().then_some(document))
}

/// Options for which a scene's plants have their own settings.
const OF_ONE_DRAWING: [&str; 22] = [
    "seed",
    "split",
    "spec",
    "classes",
    "read_as",
    "height",
    "branch_depth",
    "leaf_depth",
    "flip_flowers",
    "density",
    "tropism",
    "pipe_exponent",
    "phototropism",
    "gravity",
    "leaf_template",
    "detail",
    "sides",
    "textures",
    "no_textures",
    "materials",
    "petals",
    "variation",
];

/// Makes every plant that is not hidden and writes the scene as one model, with an entry of the report for each.
pub(crate) fn make(args: &SketchArgs, path: &Path, document: &Document, machine: &Machine) -> Outcome {
    let given = &args.given;
    let line = "this is a scene, whose plants have their own settings; change them in the Studio";
    given.refuse(&OF_ONE_DRAWING, "drawings", line)?;
    given.refuse(&["format"], "folders of models", "a scene is one model")?;
    given.refuse(
        &EXPORT,
        "drawings",
        "a scene is written as it stands; export its plants from the Studio",
    )?;
    if document.plants().is_empty() {
        return Err(Failure::bad_file(path, files::EMPTY));
    }
    if document.plants().iter().all(|p| p.settings().hidden) {
        return Err(Failure::bad_file(
            path,
            "shows nothing: all of its plants are hidden; show one in the Studio",
        ));
    }
    let mut outputs = Outputs::new(
        &[
            ("-o", args.output.as_ref()),
            ("--png", args.png.as_ref()),
            ("--qsm", args.qsm.as_ref()),
            ("--report", args.common.report.as_ref()),
        ],
        &[&path.to_path_buf()],
    )?;
    let format = args.output.as_deref().map(|p| files::plan_plant(&mut outputs, p, 0)).transpose()?;
    given.check_picture(args.png.is_some(), &args.picture)?;
    given.check_surface(Seen::new(format, args.png.as_ref(), &args.common))?;
    given.check_axes(args.qsm.is_some() || format.is_some_and(|f| f.holds(Room::Axes)))?;
    let mut scene = SceneEvaluator::default();
    scene.set_wind(args.surface.skin.wind);
    let mut report = RunReport::new("sketch", 1);
    report.input.path = path.display().to_string();
    report.input.drawings = document.plants().len() as u64;
    report.input.strokes = document.plants().iter().map(|p| p.strokes().len() as u64).sum();
    let seen: Vec<&DocumentPlant> = document.plants().iter().filter(|p| !p.settings().hidden).collect();
    for plant in &seen {
        let name = &plant.settings().name;
        let made = machine.with_progress(name, |_| scene.update(plant.id(), document, &machine.run()));
        made.map_err(|e| {
            if e.is_cancelled() {
                Failure::Cancelled
            } else {
                Failure::bad_file(path, format_args!("{name}: {e}"))
            }
        })?;
        report.items.extend(scene.get(plant.id()).map(|p| p.report()));
    }
    crate::checks::accept(&report.items, &args.checks)?;
    let plants = seen.iter().filter_map(|p| Some(standing(p, scene.get(p.id())?.model)));
    let plants: Vec<Standing<'_>> = plants.collect();
    let model = scene_model(document.name(), &plants);
    let structure = || {
        let [only] = seen.as_slice() else {
            return Err(Failure::bad_file(
                path,
                "holds several plants; a structure (MTG, OPF, QSM, SWC) or a robot (MJCF, URDF) is of one",
            ));
        };
        let plant = scene.get(only.id()).and_then(|p| p.plant);
        plant.ok_or_else(|| Failure::Bug("no plant was made".into()))
    };
    if let Some(qsm) = &args.qsm {
        files::write_qsm(&mut outputs, qsm, structure()?, &args.axes)?;
    }
    if let Some((out, format)) = args.output.as_deref().zip(format) {
        let nothing = burgeon::plant::Plant::default();
        let plant = if format.model().is_none() { structure()? } else { &nothing };
        let goal = Goal::new("-o", out);
        let mut cache = PngCache::new();
        if let Some(gltf) = format.model().filter(|format| format.holds(Room::Instances)) {
            // Models that occur several times are written once.
            files::write_gltf(&mut outputs, goal, gltf, |to| {
                write_glb_scene(document.name(), &plants, &mut cache, to)
            })?;
        } else {
            files::write_plant(&mut outputs, goal, (plant, &model), format, &args.axes, &mut cache)?;
        }
        for item in &mut report.items {
            item.output = out.display().to_string();
        }
    }
    if let Some(png) = &args.png {
        let drawn = burgeon::render::render(&model, &args.picture.spec(1), &machine.run())?;
        picture::write(&mut outputs, "--png", png, &drawn)?;
    }
    // With several plants, each entry has its own time of making; all their files are one.
    if let [only] = &mut report.items[..] {
        only.timings_ms.total = machine.whole_ms();
    }
    report.ok = report.items.len() as u64;
    crate::report::finish(&report, &args.common, outputs)?;
    if !machine.quiet {
        for item in &report.items {
            item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", item.name)));
            say::line(&crate::report::summary(item, args.png.as_deref()));
        }
    }
    Ok(())
}
