//! The Studio's session without its JavaScript face: it runs and is tested natively.
//!
//! | module | owns |
//! |---|---|
//! | here | the document: plants, strokes, commands, gestures, undo |
//! | `files` | files in and out |
//! | `shaping` | tools that shape a plant by hand |
//! | `views` | evaluation and what the page is shown |

mod files;
mod shaping;
mod views;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::sync::Arc;

#[cfg(test)]
use burgeon::document::Document;
use burgeon::document::{
    self, DocumentPlant, Editor, Maker, NewPlant, NewStroke, Photo, PlantId, SceneCommand, Settings,
    SketchCommand, StrokeId,
};
use burgeon::formats::{self, DrawingFormat, read_drawings};
use burgeon::glam::DVec2;
use burgeon::ink::{Drawing, InkSample, Stroke, StrokeMode};
use burgeon::mesh::{Model, Texture};
use burgeon::{Evaluator, ItemReport, Preset, SceneEvaluator, tree_settings};

use crate::wire::{DocumentState, PlantState, WireCommand};

/// Share of the triangles while a stroke is drawn.
const PREVIEW_DETAIL: f64 = 0.4;
/// The number in `PlantView` of what is no plant of the document: a model that is looked at, another seed.
const GUEST: PlantId = PlantId(u32::MAX);
/// Room between a new plant and the others, metres: as wide as the crown of a tree, or a hand.
const TREE_ROOM: f64 = 4.0;
const ROOM: f64 = 0.25;

/// One document, its history, its plants, and what the page was given already.
#[derive(Debug, Default)]
pub(crate) struct Session {
    editor: Editor,
    scene: SceneEvaluator,
    /// The plant on the sheet and in the panel: commands that name no plant are its.
    current: Option<PlantId>,
    draft: Option<Stroke>,
    /// The current plant while a stroke is drawn.
    preview: Option<Evaluator>,
    /// The plant and the revision whose classes the looks at a draft began with.
    followed: Option<(PlantId, u64)>,
    preview_item: Option<ItemReport>,
    previewed: bool,
    /// A model file that is looked at instead of the scene.
    guest: Option<Model>,
    /// Another plant of the same description, looked at for a moment.
    variant: Option<Model>,
    /// What came of each plant at the last evaluation.
    outcomes: BTreeMap<PlantId, Outcome>,
    /// What each plant's meshes were made of when the page got them: a revision, or a look.
    meshes: BTreeMap<PlantId, Option<u64>>,
    /// Points that the page has. Holding them keeps their addresses from being used again.
    given: BTreeMap<u32, Arc<Stroke>>,
    textures: Vec<Arc<Texture>>,
    /// A tool that shapes a plant.
    held: Option<shaping::Held>,
    /// The photograph that the page has.
    given_photo: Option<Arc<[u8]>>,
}

/// What came of a plant.
#[derive(Clone, Debug)]
enum Outcome {
    Made,
    /// Nothing to make it of yet.
    Bare,
    Failed(String),
}

/// A column of vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Column {
    Positions,
    Normals,
    Uvs,
    Colors,
}

pub(crate) type Told<T = ()> = Result<T, String>;

pub(crate) fn words(e: impl ToString) -> String {
    e.to_string()
}

impl Session {
    /// The plant on the sheet: the one that was chosen, or the last.
    fn current_id(&self) -> Option<PlantId> {
        let document = self.editor.document();
        let chosen = self.current.filter(|&id| document.plant(id).is_some());
        chosen.or_else(|| document.plants().last().map(DocumentPlant::id))
    }

    fn current_plant(&self) -> Option<&DocumentPlant> {
        self.editor.document().plant(self.current_id()?)
    }

    fn must(&self) -> Told<PlantId> {
        self.current_id().ok_or_else(|| "there is no plant; add one first".into())
    }

    pub(crate) fn select(&mut self, plant: u32) -> Told {
        if self.editor.document().plant(PlantId(plant)).is_none() {
            return Err("that plant is not there any more".into());
        }
        self.current = Some(PlantId(plant));
        self.draft = None;
        self.guest = None;
        self.let_go();
        Ok(())
    }

    /// Adds a plant beside the others and chooses it. A sheet on which nothing was drawn gives way.
    fn add_plant(&mut self, name: &str, maker: Maker) -> Told {
        let document = self.editor.document();
        let blank = match document.plants() {
            [only]
                if only.settings().sketch().is_some()
                    && only.strokes().is_empty()
                    && maker.word() != "sketch" =>
            {
                Some(only.id())
            }
            _ => None,
        };
        let mut settings = Settings { name: name.into(), maker, ..Settings::default() };
        if blank.is_none() && !document.plants().is_empty() {
            let room = if matches!(settings.maker, Maker::Tree(_)) { TREE_ROOM } else { ROOM };
            let right = document.plants().iter().filter_map(|p| {
                let model = self.scene.get(p.id())?.model;
                let at = p.settings().placement;
                Some(at.position.x + at.scale * model.bounds().max.x.max(0.0))
            });
            settings.placement.position.x = (10.0 * (right.fold(0.0, f64::max) + room)).round() / 10.0;
        }
        let add = SceneCommand::Add(Box::new(NewPlant { settings, strokes: Vec::new() }));
        if let Some(blank) = blank {
            self.editor.begin_gesture("add-plant").map_err(words)?;
            let done = self.editor.run(add).and_then(|()| self.editor.run(SceneCommand::Remove(vec![blank])));
            if let Err(e) = done {
                self.editor.cancel_gesture();
                return Err(words(e));
            }
            self.editor.commit();
        } else {
            self.editor.run(add).map_err(words)?;
        }
        self.current = self.editor.document().plants().last().map(DocumentPlant::id);
        self.draft = None;
        Ok(())
    }

    /// Starts empty and forgets the history: the memory of the document is given back.
    pub(crate) fn close(&mut self) {
        *self = Self::default();
    }

    pub(crate) fn add_stroke(&mut self, mode: &str, samples: &[f64]) -> Told<u32> {
        let stroke = stroke(mode, samples)?;
        self.draft = None;
        self.guest = None;
        let id = self.must()?;
        self.editor
            .run(SketchCommand::AddStrokes(vec![NewStroke { stroke, class: None }]).of(id))
            .map_err(words)?;
        let last = self.editor.document().plant(id).and_then(|p| p.strokes().last());
        last.map(|s| s.id.0).ok_or_else(|| "internal: no stroke".into())
    }

    pub(crate) fn draft(&mut self, mode: &str, samples: &[f64]) -> Told {
        self.draft = Some(stroke(mode, samples)?).filter(|s| !s.samples.is_empty());
        if self.draft.is_some() {
            self.guest = None;
        }
        Ok(())
    }

    pub(crate) fn run(&mut self, command: &str) -> Told {
        let command: WireCommand = serde_json::from_str(command).map_err(words)?;
        self.run_wire(&command)
    }

    fn run_wire(&mut self, command: &WireCommand) -> Told {
        self.let_go();
        match command {
            WireCommand::Add { maker, name, preset } => {
                let maker = match (maker.as_str(), preset.as_deref()) {
                    ("sketch", _) => Maker::default(),
                    ("tree", key) => {
                        let key = key.unwrap_or("oak");
                        let preset = Preset::find(key).ok_or_else(|| format!("there is no tree {key:?}"))?;
                        Maker::Tree(Box::new(tree_settings(&preset.spec().map_err(words)?, Some(key))))
                    }
                    ("leaf", _) => Maker::Leaf(Box::default()),
                    ("flower", species) => {
                        let mut flower = document::FlowerMaker::default();
                        if let Some(species) = species {
                            flower.settings.species = species.into();
                        }
                        Maker::Flower(Box::new(flower))
                    }
                    (other, _) => return Err(format!("there is no maker {other:?}")),
                };
                self.add_plant(name, maker)?;
            }
            other => {
                let command = other.command(self.must().ok(), self.editor.document())?;
                let copies = matches!(command, document::Command::Scene(SceneCommand::Duplicate(..)));
                self.editor.run(command).map_err(words)?;
                if copies {
                    self.current = self.editor.document().plants().last().map(DocumentPlant::id);
                }
            }
        }
        self.guest = None;
        Ok(())
    }

    pub(crate) fn begin(&mut self, name: &str) -> Told {
        self.let_go();
        self.editor.begin_gesture(name).map_err(words)
    }

    pub(crate) fn stage(&mut self, command: &str) -> Told {
        let command: WireCommand = serde_json::from_str(command).map_err(words)?;
        let command = command.command(self.must().ok(), self.editor.document())?;
        self.editor.stage(command).map_err(words)
    }

    pub(crate) fn commit(&mut self) {
        self.editor.commit();
    }

    pub(crate) fn abandon(&mut self) {
        self.editor.cancel_gesture();
    }

    /// Strokes as a drawing in our JSON, for the clipboard.
    pub(crate) fn copy(&self, ids: &[u32]) -> Told<String> {
        let plant = self.current_plant().ok_or("no stroke is selected")?;
        let chosen = plant.strokes().iter().filter(|s| ids.contains(&s.id.0));
        let strokes: Vec<Stroke> = chosen.map(|s| Stroke::clone(&s.stroke)).collect();
        if strokes.is_empty() {
            return Err("no stroke is selected".into());
        }
        let mut out = Vec::new();
        let drawing = Drawing { name: plant.settings().name.clone(), strokes };
        formats::write_drawing(&drawing, &mut out).map_err(words)?;
        String::from_utf8(out).map_err(words)
    }

    /// Adds the strokes of any drawing as text, moved; their numbers.
    pub(crate) fn paste(&mut self, text: &str, x: f64, y: f64) -> Told<Vec<u32>> {
        let format = DrawingFormat::sniff(text.as_bytes()).ok_or("the clipboard holds no drawing")?;
        let read = read_drawings(text.as_bytes(), format, "clipboard").next();
        let read = read.ok_or("the clipboard holds no drawing")?.map_err(words)?;
        let mut strokes = read.drawing.strokes;
        for p in strokes.iter_mut().flat_map(|s| &mut s.samples) {
            p.at += DVec2::new(x, y);
        }
        let id = self.must()?;
        let before = self.current_plant().map_or(0, |p| p.strokes().len());
        let new = strokes.into_iter().map(|stroke| NewStroke { stroke, class: None }).collect();
        self.editor.run(SketchCommand::AddStrokes(new).of(id)).map_err(words)?;
        self.guest = None;
        let strokes = self.current_plant().map_or(&[][..], DocumentPlant::strokes);
        Ok(strokes.iter().skip(before).map(|s| s.id.0).collect())
    }

    /// Puts a photograph under the drawing.
    pub(crate) fn place_photo(&mut self, png: &[u8], x: f64, y: f64, width: f64) -> Told {
        let mut photo = Photo::new(png.into()).map_err(words)?;
        (photo.x, photo.y, photo.width) = (x, y, width);
        self.editor.run(SketchCommand::SetPhoto(Some(Box::new(photo))).of(self.must()?)).map_err(words)
    }

    /// The photograph's file if the page has another one; empty if it has this one or there is none.
    pub(crate) fn fresh_photo(&mut self) -> Vec<u8> {
        let photo = self.current_plant().and_then(|p| p.settings().photo()).map(|p| Arc::clone(p.png()));
        let same = match (&photo, &self.given_photo) {
            (Some(now), Some(had)) => Arc::ptr_eq(now, had),
            (None, _) => true,
            _ => false,
        };
        if photo.is_some() {
            self.given_photo.clone_from(&photo);
        }
        photo.filter(|_| !same).map_or_else(Vec::new, |p| p.to_vec())
    }

    pub(crate) fn undo(&mut self) -> Option<String> {
        self.guest = None;
        self.let_go();
        self.editor.undo().map(str::to_owned)
    }

    pub(crate) fn redo(&mut self) -> Option<String> {
        self.guest = None;
        self.let_go();
        self.editor.redo().map(str::to_owned)
    }

    pub(crate) fn state(&self) -> Told<String> {
        let document = self.editor.document();
        let state = DocumentState {
            revision: self.editor.revision(),
            undo: self.editor.done().last().map(|s| s.name.as_str()),
            redo: self.editor.undone().last().map(|s| s.name.as_str()),
            steps: self.editor.done().len(),
            name: document.name(),
            current: self.current_id().map(|id| id.0),
            plants: document.plants().iter().map(|p| PlantState::of(p, document)).collect(),
        };
        serde_json::to_string(&state).map_err(words)
    }

    pub(crate) fn fresh_strokes(&mut self) -> Vec<u32> {
        let mut fresh = Vec::new();
        let mut given = BTreeMap::new();
        let id = self.current_id();
        let plant = id.and_then(|id| self.editor.document().plant(id));
        for s in plant.map_or(&[][..], DocumentPlant::strokes) {
            if !self.given.get(&s.id.0).is_some_and(|old| Arc::ptr_eq(old, &s.stroke)) {
                fresh.push(s.id.0);
            }
            given.insert(s.id.0, Arc::clone(&s.stroke));
        }
        self.given = given;
        fresh
    }

    pub(crate) fn stroke_points(&self, id: u32) -> Vec<f64> {
        let plant = self.current_plant();
        let found = plant.and_then(|p| p.strokes().get(p.row(StrokeId(id))?));
        let samples = found.map_or(&[][..], |s| &s.stroke.samples);
        samples.iter().flat_map(|p| [p.at.x, p.at.y, p.pressure.unwrap_or(f64::NAN)]).collect()
    }

    #[cfg(test)]
    pub(crate) fn document(&self) -> &Document {
        self.editor.document()
    }
}

fn stroke(mode: &str, samples: &[f64]) -> Told<Stroke> {
    let mode = match mode {
        "parts" => StrokeMode::Parts,
        "branch-contour" => StrokeMode::BranchContour,
        "leaf-contour" => StrokeMode::LeafContour,
        other => return Err(format!("the mode {other:?} is unknown")),
    };
    let known = |x: f64| x.is_finite().then_some(x);
    let samples = samples.chunks_exact(4).filter(|p| p[0].is_finite() && p[1].is_finite());
    let samples = samples.map(|p| InkSample {
        at: DVec2::new(p[0], p[1]),
        time_ms: known(p[2]),
        pressure: known(p[3]),
    });
    Ok(Stroke { samples: samples.collect(), mode, ..Stroke::default() })
}
