//! Exports: the scene or one plant, in every format that the command line writes.

use burgeon::document::{self, Document, DocumentPlant, Maker, PlantId};
use burgeon::formats::{self, ExportSpec, ModelFormat, obj_files, usd_files};
use burgeon::mesh::Model;
use burgeon::{Report, Run, SceneEvaluator, coarser, scene_model};

use crate::session::{Told, words};
use crate::wire::ExportOptions;

/// The file, or a zip of several.
pub(crate) fn export(
    scene: &mut SceneEvaluator,
    document: &Document,
    only: Option<PlantId>,
    format: &str,
    options: &ExportOptions,
    run: &Run<'_>,
) -> Told<Vec<u8>> {
    let wind = options.wind && ModelFormat::from_extension(format).is_some_and(ModelFormat::carries_wind);
    let mut aside;
    let scene = if wind {
        // What is shown stays without: its meshes would be half as large again.
        aside = scene.clone();
        aside.set_wind(true);
        &mut aside
    } else {
        scene
    };
    let chosen = |p: &&DocumentPlant| only.map_or(!p.settings().hidden, |id| p.id() == id);
    let mut made = Vec::new();
    for plant in document.plants().iter().filter(chosen) {
        match scene.update(plant.id(), document, run) {
            Ok(()) => made.push(plant),
            Err(e) if e.is_bare() && only.is_none() => {}
            Err(e) => return Err(words(e)),
        }
    }
    if made.is_empty() {
        return Err("there is no plant yet: draw at least one line, or add a tree, a leaf or a flower".into());
    }
    if format == "mtg" || format == "qsm" {
        return structure(scene, &made, format, options);
    }
    let spec = options.spec()?;
    let levels = options.levels.clamp(1, 4);
    let mut files = Vec::new();
    for level in 0..levels {
        let mut models = Vec::new();
        for plant in &made {
            let placement =
                if only.is_some() { document::Placement::default() } else { plant.settings().placement };
            models.push((placement, at_level(scene, document, plant, (level, wind), run)?));
        }
        let model = scene_model(document.name(), models.iter().map(|(at, m)| (*at, m)));
        let stem = if levels == 1 { "plant".into() } else { format!("plant_LOD{level}") };
        files.extend(written(&model, format, &stem, &spec)?);
    }
    if format == "usda" {
        // With or without textures: the name of what is saved is known before they are.
        return document::pack(&files).map_err(words);
    }
    packed(files)
}

/// A plant's model, coarser for each level.
fn at_level(
    scene: &SceneEvaluator,
    document: &Document,
    plant: &DocumentPlant,
    (level, wind): (u32, bool),
    run: &Run<'_>,
) -> Told<Model> {
    let shown = scene.get(plant.id()).ok_or("there is no plant yet")?;
    if level == 0 {
        return Ok(shown.model.clone());
    }
    match (&plant.settings().maker, shown.plant) {
        (Maker::Tree(tree), Some(grown)) => {
            let seed = plant.settings().seed;
            let skin = burgeon::skin::SkinSpec { seed, wind, ..tree.skin.clone() };
            let (copy, skin) = coarser(grown, &skin, level);
            let mut model = burgeon::skin::skin(&copy, &skin, run).map_err(words)?;
            // Colours and textures are those of the finest.
            model.name.clone_from(&shown.model.name);
            for m in &mut model.materials {
                if let Some(fine) = shown.model.materials.iter().find(|f| f.name == m.name) {
                    *m = fine.clone();
                }
            }
            Ok(model)
        }
        (Maker::Sketch(sketch), _) => {
            let mut skin = sketch.skin.clone();
            for _ in 0..level {
                skin.detail = (skin.detail / 3.0).max(0.1);
                skin.sides = (skin.sides / 2).max(3);
            }
            let mut coarse = document::Editor::new(document.clone());
            coarse.run(document::SketchCommand::SetSkin(skin).of(plant.id())).map_err(words)?;
            let mut aside = scene.clone();
            aside.update(plant.id(), coarse.document(), run).map_err(words)?;
            Ok(aside.get(plant.id()).ok_or("internal: no model")?.model.clone())
        }
        // A measured leaf and a flower are one level.
        _ => Ok(shown.model.clone()),
    }
}

/// MTG or the table of cylinders: a file a plant.
fn structure(
    scene: &SceneEvaluator,
    made: &[&DocumentPlant],
    format: &str,
    options: &ExportOptions,
) -> Told<Vec<u8>> {
    let spec = options.spec()?;
    let mut files = Vec::new();
    for plant in made {
        let Some(grown) = scene.get(plant.id()).and_then(|p| p.plant) else { continue };
        let mut out = Vec::new();
        if format == "mtg" {
            formats::write_mtg(grown, &spec, &mut out).map_err(words)?;
        } else {
            formats::write_qsm(grown, &spec, &mut out).map_err(words)?;
        }
        let extension = if format == "mtg" { "mtg" } else { "csv" };
        files.push((format!("plant-{}.{extension}", plant.id().0 + 1), out));
    }
    if files.is_empty() {
        return Err("only plants with axes have a structure: a sketch or a tree".into());
    }
    packed(files)
}

/// One file as it is, several as a zip.
pub(crate) fn packed(mut files: Vec<(String, Vec<u8>)>) -> Told<Vec<u8>> {
    match files.len() {
        1 => Ok(files.swap_remove(0).1),
        _ => document::pack(&files).map_err(words),
    }
}

/// The files of a model.
pub(crate) fn written(
    model: &Model,
    format: &str,
    stem: &str,
    spec: &ExportSpec,
) -> Told<Vec<(String, Vec<u8>)>> {
    let format =
        ModelFormat::from_extension(format).ok_or_else(|| format!("models are not written as {format:?}"))?;
    if format == ModelFormat::Obj {
        let files = obj_files(model, stem, spec).map_err(words)?;
        let mut all = vec![(format!("{stem}.obj"), files.obj), (format!("{stem}.mtl"), files.mtl)];
        all.extend(files.textures);
        return Ok(all);
    }
    if format == ModelFormat::Usda {
        let files = usd_files(model, stem, spec).map_err(words)?;
        let mut all = vec![(format!("{stem}.usda"), files.usda)];
        all.extend(files.textures);
        return Ok(all);
    }
    let mut out = Vec::new();
    formats::write_model(model, format, spec, &mut out, &mut Report::default()).map_err(words)?;
    let extension = match format {
        ModelFormat::Ply => "ply",
        ModelFormat::Stl => "stl",
        _ => "glb",
    };
    Ok(vec![(format!("{stem}.{extension}"), out)])
}
