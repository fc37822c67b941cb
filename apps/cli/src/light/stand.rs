//! The plants in the light: a plant of any maker, or all plants of a project.

use std::sync::Arc;

use burgeon::document::{
    Document, DocumentPlant, Editor, FlowerMaker, Maker, NewPlant, PlantCommand, PlantId, SceneCommand,
    Settings,
};
use burgeon::formats::read_drawings;
use burgeon::{
    ItemReport, Preset, Report, SceneEvaluator, Seed, Stood, shown_plants, stood_plants, tree_settings,
    without_textures,
};

use crate::args::LightArgs;
use crate::failure::{Failure, Outcome};
use crate::files::{self, Kind};
use crate::machine::Machine;
use crate::{bloom, grow, inputs};

/// Plants that were grown.
pub(super) struct Grown {
    document: Document,
    seen: Vec<PlantId>,
    scene: SceneEvaluator,
}

impl Grown {
    pub(super) fn new(args: &LightArgs, told: &mut Report, machine: &Machine) -> Outcome<Self> {
        let path = &args.what;
        let document = without_textures(&document(args, told)?).map_err(|e| Failure::bad_file(path, e))?;
        let seen = shown_plants(&document);
        if document.plants().is_empty() {
            return Err(Failure::bad_file(path, files::EMPTY));
        }
        if seen.is_empty() {
            return Err(Failure::bad_file(
                path,
                "shows nothing: all of its plants are hidden; show one in the Studio",
            ));
        }
        let mut scene = SceneEvaluator::default();
        for id in &seen {
            scene.update(*id, &document, &machine.run()).map_err(|e| {
                if e.is_cancelled() { Failure::Cancelled } else { Failure::bad_file(path, e) }
            })?;
        }
        Ok(Self { document, seen, scene })
    }

    pub(super) fn name(&self) -> &str {
        self.document.name()
    }

    /// Returns the plants in their places.
    pub(super) fn stood(&self) -> Outcome<Vec<Stood<'_>>> {
        let all = stood_plants(&self.scene, &self.document, &self.seen);
        all.ok_or_else(|| Failure::Bug("a plant was not made".into()))
    }

    /// Returns the report of each plant.
    pub(super) fn items(&self) -> Vec<ItemReport> {
        self.seen.iter().filter_map(|id| self.scene.get(*id)).map(|p| p.report()).collect()
    }
}

fn document(args: &LightArgs, told: &mut Report) -> Outcome<Document> {
    let what = &args.what;
    if let Some(spec) = bloom::species(what)? {
        let (name, day) = (spec.name.clone(), spec.opening_days);
        let flower = FlowerMaker { preset: None, spec: Arc::new(spec), day, law: None };
        return alone(args, &name, Maker::Flower(Box::new(flower)));
    }
    let is_preset = what.to_str().and_then(Preset::find).is_some() && !what.is_file();
    let is_spec = files::extension(what).is_none_or(|e| e.eq_ignore_ascii_case("toml"));
    let stdin = inputs::is_stdin(what).then(|| files::peek(what)).transpose()?;
    let piped = stdin.as_ref().map(|(_, start)| files::sniff(start));
    // A preset or a spec; from standard input, anything of no other kind.
    if is_preset || piped.map_or(is_spec, |kind| kind.is_none()) {
        let spec = match stdin {
            Some((input, _)) => grow::spec_of(what, &files::text_of(what, input)?, told)?,
            None => grow::read_spec(what, told)?,
        };
        return alone(args, &spec.name.clone(), Maker::Tree(Box::new(tree_settings(&spec, None))));
    }
    let opened = match stdin {
        Some((input, start)) => (input, files::kind_of(what, &start)?),
        None => files::open(what)?,
    };
    match opened {
        (file, Kind::Drawing(format)) => {
            let mut drawings = read_drawings(file, format, &files::stem(what));
            let first = drawings.next().ok_or_else(|| Failure::bad_file(what, "holds no drawing"))?;
            let read = first.map_err(|e| Failure::bad_file(what, e))?;
            if drawings.next().is_some() {
                return Err(Failure::bad_file(what, "holds several drawings; give one"));
            }
            told.warnings.extend(read.warnings);
            let document = Document::from_drawing(&read.drawing);
            let ids: Vec<PlantId> = document.plants().iter().map(DocumentPlant::id).collect();
            seeded(args, document, &ids)
        }
        (file, Kind::Project) => {
            let this = "plants of a project have their own";
            args.given.refuse(&["seed"], "species, specs and drawings", this)?;
            files::read_project(what, file)
        }
        (_, Kind::Structure(format)) => {
            let what_it_is = format_args!(
                "is the structure of a plant ({}), whose leaves have no surface; give a preset, a spec, a drawing or a project",
                format.word()
            );
            Err(Failure::bad_file(what, what_it_is))
        }
        (_, Kind::Model(format)) => {
            let what_it_is = format_args!(
                "is a model ({}), of which is not known what its organs are; give a preset, a spec, a drawing or a project",
                format.word()
            );
            Err(Failure::bad_file(what, what_it_is))
        }
    }
}

fn bug(e: impl std::fmt::Display) -> Failure {
    Failure::Bug(e.to_string())
}

/// Makes a document of one plant.
fn alone(args: &LightArgs, name: &str, maker: Maker) -> Outcome<Document> {
    let mut editor = Editor::new(Document::default());
    let sheet: Vec<PlantId> = editor.document().plants().iter().map(DocumentPlant::id).collect();
    let settings = Settings { name: name.to_owned(), maker, ..Settings::default() };
    let plant = NewPlant { settings, strokes: Vec::new() };
    editor.run(SceneCommand::Add(Box::new(plant))).map_err(|e| Failure::bad_file(&args.what, e))?;
    editor.run(SceneCommand::Rename(name.to_owned())).map_err(bug)?;
    if !sheet.is_empty() {
        editor.run(SceneCommand::Remove(sheet)).map_err(bug)?;
    }
    let ids: Vec<PlantId> = editor.document().plants().iter().map(DocumentPlant::id).collect();
    seeded(args, editor.document().clone(), &ids)
}

/// Applies the requested seed.
fn seeded(args: &LightArgs, document: Document, ids: &[PlantId]) -> Outcome<Document> {
    let mut editor = Editor::new(document);
    let seed = Seed::new(args.seed.unwrap_or(1));
    for id in ids {
        if editor.document().plant(*id).is_some_and(|p| p.settings().seed != seed) {
            editor.run(PlantCommand::SetSeed(seed).for_plant(*id)).map_err(bug)?;
        }
    }
    Ok(editor.document().clone())
}
