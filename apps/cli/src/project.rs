//! One plant of a project: chosen by name or number, shaped by hand, and the project saved with the edits.

use std::path::Path;

use burgeon::document::{
    self, Document, DocumentPlant, Editor, Maker, PlantCommand, PlantEdit, PlantId, ShapeCommand,
    SketchCommand, TreeCommand,
};
use burgeon::mesh::Model;
use burgeon::plant::Plant;
use burgeon::{ItemReport, SceneEvaluator, Seed};

use crate::args::{SkinArgs, TreeSurfaceArgs};
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::output::Outputs;

/// Whether a plant has branches that hands can shape.
fn branches(plant: &DocumentPlant) -> bool {
    matches!(plant.settings().maker, Maker::Sketch(_) | Maker::Tree(_))
}

/// The plants with their numbers, for errors.
fn listed(document: &Document) -> String {
    let plants = document.plants().iter().zip(1..);
    let names = plants.map(|(p, n)| {
        let s = p.settings();
        format!("{n} \"{}\" ({})", s.name, s.maker.word())
    });
    names.collect::<Vec<_>>().join(", ")
}

/// The plant that `--plant` names or numbers (from 1, as in the project); without it the only one that has branches.
pub(crate) fn choose(path: &Path, document: &Document, wanted: Option<&str>) -> Outcome<PlantId> {
    let plants = document.plants();
    let Some(wanted) = wanted else {
        let mut shapable = plants.iter().filter(|p| branches(p));
        return match (shapable.next(), shapable.next()) {
            (Some(only), None) => Ok(only.id()),
            (None, _) => {
                Err(Failure::at(path, "holds no tree or drawing, which alone have branches to edit"))
            }
            (Some(_), Some(_)) => {
                let line = format!(
                    "holds several plants; choose one by --plant NAME or number: {}",
                    listed(document)
                );
                Err(Failure::at(path, line))
            }
        };
    };
    let named: Vec<&DocumentPlant> =
        plants.iter().filter(|p| p.settings().name.to_lowercase() == wanted.to_lowercase()).collect();
    let numbered = || wanted.parse::<usize>().ok()?.checked_sub(1).and_then(|row| plants.get(row));
    let chosen = match named.as_slice() {
        [only] => only,
        [] => numbered().ok_or_else(|| {
            Failure::at(path, format_args!("holds no plant \"{wanted}\"; it holds {}", listed(document)))
        })?,
        _ => {
            let line = format!("holds several plants \"{wanted}\"; choose by number: {}", listed(document));
            return Err(Failure::at(path, line));
        }
    };
    if !branches(chosen) {
        let s = chosen.settings();
        let line = format!("\"{}\" is a {}, which has no branches to edit", s.name, s.maker.word());
        return Err(Failure::at(path, line));
    }
    Ok(chosen.id())
}

/// The project with more edits of a plant, each a step.
pub(crate) fn edited(
    path: &Path,
    document: Document,
    id: PlantId,
    edits: Vec<PlantEdit>,
) -> Outcome<Document> {
    let mut editor = Editor::new(document);
    for edit in edits {
        editor.run(ShapeCommand::Add(edit.edit).of(id)).map_err(|e| Failure::at(path, e))?;
    }
    Ok(editor.document().clone())
}

/// The project with another seed and surface of a plant where they were asked for: to be made, not to be saved.
pub(crate) fn asked(
    path: &Path,
    document: &Document,
    id: PlantId,
    seed: Option<u64>,
    surface: &TreeSurfaceArgs,
) -> Outcome<Document> {
    if surface.lods > 0 {
        let line = "is a project: --lods is for presets and specs; the Studio exports levels of its plants";
        return Err(Failure::at(path, line));
    }
    let mut editor = Editor::new(document.clone());
    let settings = document.plant(id).map(DocumentPlant::settings);
    let (skin, is_tree) = match settings.map(|s| &s.maker) {
        Some(Maker::Sketch(s)) => (&s.skin, false),
        Some(Maker::Tree(t)) => (&t.skin, true),
        _ => return Err(Failure::Bug("the chosen plant has no branches".into())),
    };
    let mut asked = skin.clone();
    // Wind is chosen for an export, not saved.
    SkinArgs { wind: skin.wind, ..surface.skin.clone() }.set(&mut asked);
    let mut commands = Vec::new();
    if asked != *skin {
        commands.push(match is_tree {
            true => TreeCommand::SetSkin(asked).of(id),
            false => SketchCommand::SetSkin(asked).of(id),
        });
    }
    let own = settings.map(|s| s.seed);
    if let Some(seed) = seed.map(Seed::new).filter(|s| Some(*s) != own) {
        commands.push(PlantCommand::SetSeed(seed).of(id));
    }
    for command in commands {
        editor.run(command).map_err(|e| Failure::at(path, e))?;
    }
    Ok(editor.document().clone())
}

/// Makes one plant of a project, with the columns of wind if they are wanted.
pub(crate) fn make(
    path: &Path,
    document: &Document,
    id: PlantId,
    wind: bool,
    machine: &Machine,
) -> Outcome<(Plant, Model, ItemReport)> {
    let mut scene = SceneEvaluator::default();
    scene.set_wind(wind);
    scene
        .update(id, document, &machine.run())
        .map_err(|e| if e.is_cancelled() { Failure::Cancelled } else { Failure::at(path, e) })?;
    let made =
        scene.get(id).and_then(|made| Some((made.plant?.clone(), made.model.clone(), made.item.clone())));
    made.ok_or_else(|| Failure::Bug("no plant was made".into()))
}

/// Writes a project.
pub(crate) fn save(outputs: &mut Outputs, path: &Path, document: &Document) -> Outcome {
    let bytes = document::write_project(document, burgeon::VERSION)
        .map_err(|e| Failure::Bug(format!("the project cannot be written: {e}")))?;
    outputs.write("--save", path, |file| Ok(file.write_all(&bytes)?))
}
