//! One plant of a project: chosen by name or number, shaped by hand, and the project saved with the edits.

use std::path::Path;

use burgeon::document::{
    self, Document, DocumentPlant, Editor, Maker, PlantCommand, PlantEdit, PlantId, ShapeCommand,
    SketchCommand, TreeCommand,
};
use burgeon::mesh::Model;
use burgeon::plant::Plant;
use burgeon::skin::SkinSpec;
use burgeon::{ItemReport, LevelSpec, Levels, SceneError, SceneEvaluator, Seed};

use crate::args::{FoliageWord, SkinArgs, TreeSurfaceArgs};
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::output::Outputs;

/// Lists the plants with their numbers, for errors.
fn listed(document: &Document) -> String {
    let plants = document.plants().iter().zip(1..);
    let names = plants.map(|(p, n)| {
        let s = p.settings();
        format!("{n} \"{}\" ({})", s.name, s.maker.word())
    });
    names.collect::<Vec<_>>().join(", ")
}

/// Returns the plant that `--plant` names or numbers (from 1, as in the project); without it the only one that has
/// branches.
pub(crate) fn choose(path: &Path, document: &Document, wanted: Option<&str>) -> Outcome<PlantId> {
    let plants = document.plants();
    let Some(wanted) = wanted else {
        let mut shapable = plants.iter().filter(|p| p.settings().maker.branches());
        return match (shapable.next(), shapable.next()) {
            (Some(only), None) => Ok(only.id()),
            (None, _) => Err(Failure::bad_file(
                path,
                "holds no tree, drawing or flower, which alone have branches to edit",
            )),
            (Some(_), Some(_)) => {
                let line = format!(
                    "holds several plants; choose one by --plant NAME or number: {}",
                    listed(document)
                );
                Err(Failure::bad_file(path, line))
            }
        };
    };
    let named: Vec<&DocumentPlant> =
        plants.iter().filter(|p| p.settings().name.to_lowercase() == wanted.to_lowercase()).collect();
    let numbered = || wanted.parse::<usize>().ok()?.checked_sub(1).and_then(|row| plants.get(row));
    let chosen = match named.as_slice() {
        [only] => only,
        [] => numbered().ok_or_else(|| {
            Failure::bad_file(
                path,
                format_args!("holds no plant \"{wanted}\"; it holds {}", listed(document)),
            )
        })?,
        _ => {
            let line = format!("holds several plants \"{wanted}\"; choose by number: {}", listed(document));
            return Err(Failure::bad_file(path, line));
        }
    };
    if !chosen.settings().maker.branches() {
        let s = chosen.settings();
        let line = format!("\"{}\" is a {}, which has no branches to edit", s.name, s.maker.word());
        return Err(Failure::bad_file(path, line));
    }
    Ok(chosen.id())
}

/// Returns the project with more edits of a plant, each a step.
pub(crate) fn edited(
    path: &Path,
    document: Document,
    id: PlantId,
    edits: Vec<PlantEdit>,
) -> Outcome<Document> {
    let mut editor = Editor::new(document);
    for edit in edits {
        editor.run(ShapeCommand::Add(edit.edit).for_plant(id)).map_err(|e| Failure::bad_file(path, e))?;
    }
    Ok(editor.document().clone())
}

/// Returns the project with another seed and surface of a plant where these were given: to be made, not to be saved.
pub(crate) fn asked(
    path: &Path,
    document: &Document,
    id: PlantId,
    seed: Option<u64>,
    surface: &TreeSurfaceArgs,
) -> Outcome<Document> {
    let mut editor = Editor::new(document.clone());
    let settings = document.plant(id).map(DocumentPlant::settings);
    // Wind is chosen for an export, not saved.
    let asked = |skin: &SkinSpec| {
        let mut asked = skin.clone();
        SkinArgs { wind: skin.wind, ..surface.skin.clone() }.set(&mut asked);
        (asked != *skin).then_some(asked)
    };
    let mut commands = Vec::new();
    match settings.map(|s| &s.maker) {
        Some(Maker::Sketch(s)) => {
            commands.extend(asked(&s.skin).map(|s| SketchCommand::SetSkin(s).for_plant(id)))
        }
        Some(Maker::Tree(t)) => {
            commands.extend(asked(&t.skin).map(|s| TreeCommand::SetSkin(s).for_plant(id)))
        }
        _ if asked(&SkinSpec::default()).is_some() => {
            let line = "holds a flower, whose surface is its species'; leave --detail, --sides and --no-textures out";
            return Err(Failure::bad_file(path, line));
        }
        _ => {}
    }
    let own = settings.map(|s| s.seed);
    if let Some(seed) = seed.map(Seed::new).filter(|s| Some(*s) != own) {
        commands.push(PlantCommand::SetSeed(seed).for_plant(id));
    }
    for command in commands {
        editor.run(command).map_err(|e| Failure::bad_file(path, e))?;
    }
    Ok(editor.document().clone())
}

/// Makes one plant of a document, with the requested wind columns and coarser copies.
pub(crate) fn make(
    (path, document, id): (&Path, &Document, PlantId),
    surface: &TreeSurfaceArgs,
    levels: &LevelSpec,
    machine: &Machine,
) -> Outcome<(Plant, Model, Levels, ItemReport)> {
    let failed =
        |e: SceneError| if e.is_cancelled() { Failure::Cancelled } else { Failure::bad_file(path, e) };
    let none = || Failure::Bug("no plant was made".into());
    let mut scene = SceneEvaluator::default();
    scene.set_wind(surface.skin.wind || surface.export.sway);
    scene.set_foliage(surface.export.foliage.map(FoliageWord::foliage));
    scene.update(id, document, &machine.run()).map_err(failed)?;
    let chosen = document.plant(id).ok_or_else(none)?;
    let levels = scene.levels(chosen, levels, &machine.run()).map_err(failed)?;
    let made = scene.get(id).ok_or_else(none)?;
    Ok((made.plant.ok_or_else(none)?.clone(), made.model.clone(), levels, made.report()))
}

/// Writes a project, which `option` requests.
pub(crate) fn save(outputs: &mut Outputs, option: &'static str, path: &Path, document: &Document) -> Outcome {
    let bytes = document::write_project(document, burgeon::VERSION)
        .map_err(|e| Failure::Bug(format!("the project cannot be written: {e}")))?;
    outputs.write(option, path, |file| Ok(file.write_all(&bytes)?))
}
