//! What stands in the light: a plant of any maker, or all plants of a project.

use std::path::Path;
use std::sync::Arc;

use burgeon::document::{
    Document, DocumentPlant, Editor, FlowerMaker, Maker, NewPlant, PlantCommand, PlantId, SceneCommand,
    Settings, SketchCommand, TreeCommand,
};
use burgeon::formats::read_drawings;
use burgeon::skin::SkinSpec;
use burgeon::{ItemReport, Preset, Report, SceneEvaluator, Seed, Stood, standing, tree_settings};

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
        let document = plain(path, document(args, told)?)?;
        let seen: Vec<PlantId> =
            document.plants().iter().filter(|p| !p.settings().hidden).map(DocumentPlant::id).collect();
        if document.plants().is_empty() {
            return Err(Failure::at(path, files::EMPTY));
        }
        if seen.is_empty() {
            return Err(Failure::at(
                path,
                "shows nothing: all of its plants are hidden; show one in the Studio",
            ));
        }
        let mut scene = SceneEvaluator::default();
        for id in &seen {
            scene
                .update(*id, &document, &machine.run())
                .map_err(|e| if e.is_cancelled() { Failure::Cancelled } else { Failure::at(path, e) })?;
        }
        Ok(Self { document, seen, scene })
    }

    pub(super) fn name(&self) -> &str {
        self.document.name()
    }

    /// The plants where they stand.
    pub(super) fn stood(&self) -> Outcome<Vec<Stood<'_>>> {
        let stood = |id: &PlantId| {
            let (plant, made) = (self.document.plant(*id)?, self.scene.get(*id)?);
            Some(Stood { standing: standing(plant, made.model), plant: made.plant?, layout: made.owners? })
        };
        let all: Option<Vec<_>> = self.seen.iter().map(stood).collect();
        all.ok_or_else(|| Failure::Bug("a plant was not made".into()))
    }

    /// What the report says of each plant.
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
    // A preset or a spec: of standard input, what is nothing else.
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
            let first = drawings.next().ok_or_else(|| Failure::at(what, "holds no drawing"))?;
            let read = first.map_err(|e| Failure::at(what, e))?;
            if drawings.next().is_some() {
                return Err(Failure::at(what, "holds several drawings; give one"));
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
            Err(Failure::at(what, what_it_is))
        }
        (_, Kind::Model(format)) => {
            let what_it_is = format_args!(
                "is a model ({}), of which is not known what its organs are; give a preset, a spec, a drawing or a project",
                format.word()
            );
            Err(Failure::at(what, what_it_is))
        }
    }
}

fn bug(e: impl std::fmt::Display) -> Failure {
    Failure::Bug(e.to_string())
}

/// A document of one plant.
fn alone(args: &LightArgs, name: &str, maker: Maker) -> Outcome<Document> {
    let mut editor = Editor::new(Document::default());
    let sheet: Vec<PlantId> = editor.document().plants().iter().map(DocumentPlant::id).collect();
    let settings = Settings { name: name.to_owned(), maker, ..Settings::default() };
    let plant = NewPlant { settings, strokes: Vec::new() };
    editor.run(SceneCommand::Add(Box::new(plant))).map_err(|e| Failure::at(&args.what, e))?;
    editor.run(SceneCommand::Rename(name.to_owned())).map_err(bug)?;
    if !sheet.is_empty() {
        editor.run(SceneCommand::Remove(sheet)).map_err(bug)?;
    }
    let ids: Vec<PlantId> = editor.document().plants().iter().map(DocumentPlant::id).collect();
    seeded(args, editor.document().clone(), &ids)
}

/// With the seed that was asked for.
fn seeded(args: &LightArgs, document: Document, ids: &[PlantId]) -> Outcome<Document> {
    let mut editor = Editor::new(document);
    let seed = Seed::new(args.seed.unwrap_or(1));
    for id in ids {
        if editor.document().plant(*id).is_some_and(|p| p.settings().seed != seed) {
            editor.run(PlantCommand::SetSeed(seed).of(*id)).map_err(bug)?;
        }
    }
    Ok(editor.document().clone())
}

/// Without textures, which light does not see.
fn plain(path: &Path, document: Document) -> Outcome<Document> {
    let mut editor = Editor::new(document);
    let plants: Vec<(PlantId, Maker)> =
        editor.document().plants().iter().map(|p| (p.id(), p.settings().maker.clone())).collect();
    for (id, maker) in plants {
        let bare = |skin: &SkinSpec| skin.textures.then(|| SkinSpec { textures: false, ..skin.clone() });
        let command = match maker {
            Maker::Sketch(s) => bare(&s.skin).map(|skin| SketchCommand::SetSkin(skin).of(id)),
            Maker::Tree(t) => bare(&t.skin).map(|skin| TreeCommand::SetSkin(skin).of(id)),
            _ => None,
        };
        if let Some(command) = command {
            editor.run(command).map_err(|e| Failure::at(path, e))?;
        }
    }
    Ok(editor.document().clone())
}
