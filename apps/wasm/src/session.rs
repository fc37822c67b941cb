//! The Studio's session without its JavaScript face: it runs and is tested natively.

use std::collections::BTreeMap;
use std::sync::Arc;

use burgeon::document::{
    self, Document, DocumentPlant, Editor, LeafData, LeafMaker, Maker, NewPlant, NewStroke, Photo, PlantId,
    SceneCommand, Settings, SketchCommand, StrokeId, TreeCommand,
};
use burgeon::formats::{self, DrawingFormat, ExportSpec, ModelFormat, no_files, read_drawings, read_model};
use burgeon::glam::{DVec2, DVec3};
use burgeon::growth::Obstacle;
use burgeon::mesh::{AlphaMode, Model, Texture};
use burgeon::plant::{OrganKind, Shape};
use burgeon::sketch::{Drawing, InkSample, Stroke, StrokeMode};
use burgeon::{
    CancelToken, Evaluator, ItemReport, MakeError, Preset, Report, Run, SceneError, SceneEvaluator, Seed,
    SketchOptions, leaf_marks, read_tree_spec, tree_settings,
};

use crate::exports;
use crate::host::{Attentive, Host};
use crate::wire::{
    DocumentState, Front, MaterialView, ObstacleView, Opened, PartView, PlantState, PlantView, TextureView,
    View, WireCommand,
};

/// Share of the triangles while a stroke is drawn.
const PREVIEW_DETAIL: f64 = 0.4;
/// Drawings of a file that are offered for choice.
const OFFERED: usize = 1000;
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
        Ok(())
    }

    pub(crate) fn open(&mut self, file_name: &str, bytes: &[u8], row: u32, fresh: bool) -> Told<String> {
        let (stem, extension) = file_name.rsplit_once('.').unwrap_or((file_name, ""));
        let is = |wanted: &str| extension.eq_ignore_ascii_case(wanted);
        let drawing = DrawingFormat::from_extension(extension);
        let model = ModelFormat::from_extension(extension);
        let model = model.or_else(|| ModelFormat::sniff(bytes)).filter(|_| drawing.is_none());
        let holds = |word: &[u8]| bytes.windows(word.len()).take(4096).any(|w| w == word);
        let opened = if is("burgeon") || document::is_project(bytes) {
            let document = document::read_project(bytes).map_err(words)?;
            let name = document.name().to_owned();
            self.place(document, fresh)?;
            Opened { kind: "project", name, ..Opened::default() }
        } else if is("csv") || (is("json") && holds(b"\"edges\"")) {
            self.open_leaf(stem, file_name, bytes)?
        } else if is("toml") {
            let text = std::str::from_utf8(bytes).map_err(words)?;
            let spec = read_tree_spec(text, &|_| None).map_err(words)?;
            let settings = tree_settings(&spec, None);
            self.add_plant(&spec.name, Maker::Tree(Box::new(settings)))?;
            Opened { kind: "tree", name: spec.name, ..Opened::default() }
        } else if is("json") && holds(b"burgeon.law/") {
            self.run_wire(&WireCommand::Law { text: Some(String::from_utf8_lossy(bytes).into_owned()) })?;
            Opened { kind: "law", name: stem.into(), ..Opened::default() }
        } else if let Some(format) = model {
            self.look_at(format, stem, bytes)?
        } else if let Some(format) = drawing.or_else(|| DrawingFormat::sniff(bytes)) {
            let (drawing, opened) = pick(bytes, format, stem, row)?;
            let document = Document::from_drawing(&drawing);
            if document.plants().iter().all(|p| p.strokes().is_empty()) {
                return Err("there is no stroke in it that can be used".into());
            }
            self.place(document, fresh)?;
            opened
        } else {
            return Err(
                "this is no file that Burgeon reads: give a project (.burgeon), a drawing (.svg, .inkml, \
                        .ndjson, .json), marks of a leaf (.csv), a tree (.toml) or a model (.glb, .gltf, .obj, .ply, \
                        .stl)"
                    .into(),
            );
        };
        serde_json::to_string(&opened).map_err(words)
    }

    /// Measurements of a leaf: they go to the leaf that is chosen if it has none, else to a new plant.
    fn open_leaf(&mut self, stem: &str, file_name: &str, bytes: &[u8]) -> Told<Opened> {
        let text = std::str::from_utf8(bytes).map_err(words)?;
        let data = LeafData { name: file_name.into(), text: text.into() };
        leaf_marks(&data, 0.1)
            .and_then(|(marks, _)| {
                Ok(marks.complete(&mut Report::default()).map_err(burgeon::LeafError::from)?)
            })
            .map_err(words)?;
        let waiting = self
            .current_plant()
            .filter(|p| matches!(&p.settings().maker, Maker::Leaf(l) if l.data.text.is_empty()));
        match waiting.map(DocumentPlant::id) {
            Some(id) => self.editor.run(document::LeafCommand::SetData(data).of(id)).map_err(words)?,
            None => {
                self.add_plant(stem, Maker::Leaf(Box::new(LeafMaker { data, ..LeafMaker::default() })))?
            }
        }
        self.guest = None;
        Ok(Opened { kind: "leaf", name: stem.into(), ..Opened::default() })
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

    fn place(&mut self, document: Document, fresh: bool) -> Told {
        self.editor.cancel_gesture();
        if fresh {
            self.editor = Editor::new(document);
        } else {
            self.editor.run(SceneCommand::Open(Box::new(document))).map_err(words)?;
        }
        self.current = self.editor.document().plants().first().map(DocumentPlant::id);
        self.draft = None;
        self.guest = None;
        Ok(())
    }

    fn look_at(&mut self, format: ModelFormat, stem: &str, bytes: &[u8]) -> Told<Opened> {
        let mut report = Report::default();
        let model =
            read_model(bytes, format, stem, &ExportSpec::default(), &no_files, &mut report).map_err(words)?;
        let name = model.name.clone();
        self.guest = Some(model);
        let warnings = report.warnings.iter().map(words).collect();
        Ok(Opened { kind: "model", name, warnings, ..Opened::default() })
    }

    /// A model file as an obstacle of the current tree.
    pub(crate) fn add_obstacle(&mut self, file_name: &str, bytes: &[u8]) -> Told {
        let (stem, extension) = file_name.rsplit_once('.').unwrap_or((file_name, ""));
        let format = ModelFormat::from_extension(extension).or_else(|| ModelFormat::sniff(bytes));
        let format = format.ok_or("an obstacle is a model: give a .glb, .gltf, .obj, .ply or .stl file")?;
        let model =
            read_model(bytes, format, stem, &ExportSpec::default(), &no_files, &mut Report::default());
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for part in model.map_err(words)?.parts {
            let first = u32::try_from(vertices.len()).map_err(words)?;
            vertices.extend(part.mesh.positions.iter().map(|p| DVec3::from_array(p.map(f64::from))));
            triangles.extend(part.mesh.triangles.iter().map(|t| t.map(|i| i.saturating_add(first))));
        }
        if triangles.is_empty() {
            return Err("there is no surface in it".into());
        }
        let shape = Arc::new(Obstacle::Mesh { vertices, triangles });
        let new = document::NamedObstacle { name: stem.into(), shape };
        self.editor.run(TreeCommand::AddObstacle(new).of(self.must()?)).map_err(words)
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
        self.editor.undo().map(str::to_owned)
    }

    pub(crate) fn redo(&mut self) -> Option<String> {
        self.guest = None;
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

    pub(crate) fn evaluate(&mut self) -> Told<String> {
        let cancel = CancelToken::new();
        let executor = Attentive(&cancel);
        let run = Run { cancel: &cancel, executor: &executor, clock: &Host };
        self.previewed = false;
        let current = self.current_id();
        let drawn = self.draft.is_some();
        if self.guest.is_none() {
            let document = self.editor.document();
            self.scene.retain(document);
            for plant in document.plants().iter().filter(|p| !p.settings().hidden) {
                let id = plant.id();
                let outcome = if drawn && Some(id) == current {
                    self.previewed = true;
                    let look = self.preview.get_or_insert_with(Evaluator::previewing);
                    let looked = preview(look, plant, self.draft.as_ref(), &run);
                    looked.map(|item| self.preview_item = Some(item)).map_err(SceneError::from)
                } else if drawn && self.outcomes.contains_key(&id) {
                    continue; // the pen goes first
                } else {
                    self.scene.update(id, document, &run)
                };
                let outcome = match outcome {
                    Ok(()) => Outcome::Made,
                    Err(e) if e.is_cancelled() => return Err("cancelled".into()),
                    Err(e) if e.is_bare() => Outcome::Bare,
                    Err(e) => Outcome::Failed(words(e)),
                };
                self.outcomes.insert(id, outcome);
            }
        }
        let view = self.view();
        serde_json::to_string(&view).map_err(words)
    }

    fn view(&mut self) -> View {
        let mut view = View { revision: self.editor.revision(), guest: None, plants: Vec::new() };
        let mut textures = std::mem::take(&mut self.textures);
        let mut given = BTreeMap::new();
        if let Some(model) = &self.guest {
            let mut seen = plant_view(GUEST, model, &mut textures);
            seen.fresh = true;
            view.guest = Some(seen);
        }
        for plant in self.editor.document().plants() {
            let id = plant.id();
            let previewed = self.previewed && self.current_id() == Some(id);
            let model = self.model(id);
            // None for what the page shows nothing of, or a look: whatever comes next is new to it.
            let shown = !previewed && model.is_some();
            let revision = self.scene.get(id).map(|p| p.revision).filter(|_| shown);
            let mut seen = model.map_or_else(|| PlantView::empty(id.0), |m| plant_view(id, m, &mut textures));
            seen.fresh = previewed || model.is_none() || self.meshes.get(&id) != Some(&revision);
            seen.item = self.item(id);
            seen.stages = if previewed {
                self.preview.as_ref().map_or_else(Vec::new, |e| e.stages_done().to_vec())
            } else {
                self.scene.get(id).map_or_else(Vec::new, |p| p.stages.to_vec())
            };
            let front = if previewed {
                self.preview.as_ref().and_then(Evaluator::front)
            } else {
                self.scene.get(id).and_then(|p| p.front)
            };
            seen.front = front.filter(|_| model.is_some()).map(|f| Front {
                metres_per_unit: f.metres_per_unit,
                x: f.origin.x,
                y: f.origin.y,
            });
            seen.days = self.scene.days(id, self.editor.document());
            if let Some(Outcome::Failed(why)) = self.outcomes.get(&id) {
                seen.error = Some(why.clone());
            }
            if let Maker::Tree(t) = &plant.settings().maker {
                seen.obstacles = t.obstacles.iter().map(|o| ObstacleView::of(&o.shape)).collect();
            }
            given.insert(id, revision);
            view.plants.push(seen);
        }
        self.meshes = given;
        self.textures = textures;
        view
    }

    fn item(&self, id: PlantId) -> Option<ItemReport> {
        if !matches!(self.outcomes.get(&id), Some(Outcome::Made)) {
            return None;
        }
        if self.previewed && self.current_id() == Some(id) {
            return self.preview_item.clone();
        }
        self.scene.get(id).map(|p| p.item.clone())
    }

    /// What is shown of a plant.
    fn model(&self, id: PlantId) -> Option<&Model> {
        if id == GUEST {
            return self.variant.as_ref().or(self.guest.as_ref());
        }
        if matches!(self.outcomes.get(&id), None | Some(Outcome::Bare)) {
            return None;
        }
        if self.previewed && self.current_id() == Some(id) {
            return self.preview.as_ref()?.model();
        }
        self.scene.get(id).map(|p| p.model)
    }

    pub(crate) fn column(&self, plant: u32, part: usize, column: Column) -> Vec<f32> {
        let Some(part) = self.model(PlantId(plant)).and_then(|m| m.parts.get(part)) else {
            return Vec::new();
        };
        let mesh = &part.mesh;
        match column {
            Column::Positions => mesh.positions.as_flattened().to_vec(),
            Column::Normals => mesh.normals.as_flattened().to_vec(),
            Column::Uvs => mesh.uvs.as_flattened().to_vec(),
            Column::Colors => mesh.colors.as_flattened().to_vec(),
        }
    }

    pub(crate) fn indices(&self, plant: u32, part: usize) -> Vec<u32> {
        let part = self.model(PlantId(plant)).and_then(|m| m.parts.get(part));
        part.map_or_else(Vec::new, |p| p.mesh.triangles.as_flattened().to_vec())
    }

    /// Corners of an obstacle that is a mesh, three to a triangle; empty for others.
    pub(crate) fn obstacle(&self, plant: u32, row: usize) -> Vec<f32> {
        let plant = self.editor.document().plant(PlantId(plant));
        let Some(Maker::Tree(tree)) = plant.map(|p| &p.settings().maker) else { return Vec::new() };
        let Some(Obstacle::Mesh { vertices, triangles }) = tree.obstacles.get(row).map(|o| &*o.shape) else {
            return Vec::new();
        };
        let corners = triangles.iter().flatten().filter_map(|&i| vertices.get(i as usize));
        corners.flat_map(|p| p.as_vec3().to_array()).collect()
    }

    pub(crate) fn texture(&self, number: usize) -> Vec<u8> {
        self.textures.get(number).map_or_else(Vec::new, |t| t.pixels.clone())
    }

    /// Makes the current plant of another seed for a look, a drawing with fewer triangles;
    /// [`Session::end_variant`] goes back.
    pub(crate) fn variant(&mut self, seed: &str, detail: f64) -> Told<String> {
        let seed = Seed::new(seed.parse().ok().ok_or("the seed is a whole number")?);
        let id = self.must()?;
        let mut document = Editor::new(self.editor.document().clone());
        let mut change = |c| match document.run(c) {
            Ok(()) | Err(document::CommandError::Nothing(_)) => Ok(()),
            Err(e) => Err(words(e)),
        };
        change(document::PlantCommand::SetSeed(seed).of(id))?;
        let maker = self.current_plant().map(|p| p.settings().maker.clone());
        let coarse = |skin: &burgeon::skin::SkinSpec| {
            let detail = (skin.detail * detail).clamp(0.1, 8.0);
            burgeon::skin::SkinSpec { detail, ..skin.clone() }
        };
        match &maker {
            Some(Maker::Sketch(s)) => change(SketchCommand::SetSkin(coarse(&s.skin)).of(id))?,
            Some(Maker::Tree(t)) => change(TreeCommand::SetSkin(coarse(&t.skin)).of(id))?,
            _ => {}
        }
        let mut aside = self.scene.clone();
        let cancel = CancelToken::new();
        let run = Run { cancel: &cancel, executor: &Attentive(&cancel), clock: &Host };
        aside.update(id, document.document(), &run).map_err(words)?;
        let model = aside.get(id).map(|p| p.model.clone()).ok_or("there is no plant yet")?;
        let seen = plant_view(GUEST, &model, &mut self.textures);
        self.variant = Some(model);
        serde_json::to_string(&seen).map_err(words)
    }

    pub(crate) fn end_variant(&mut self) {
        self.variant = None;
    }

    /// Pairs of points of the current plant's axes: x, y, z and order of each; then of its blades, from root to tip,
    /// with "order" 100 (leaves) or 101 (petals). Empty while a model file is looked at.
    pub(crate) fn skeleton(&self) -> Vec<f32> {
        let id = self.current_id().filter(|&id| self.guest.is_none() && self.model(id).is_some());
        let previewed = self.preview.as_ref().filter(|_| self.previewed).and_then(Evaluator::plant);
        let plant = id.and_then(|id| previewed.or_else(|| self.scene.get(id)?.plant));
        let Some(plant) = plant else { return Vec::new() };
        let mut out = Vec::new();
        for axis in &plant.axes {
            let nodes = plant.nodes.position.get(axis.nodes.start as usize..axis.nodes.end as usize);
            for pair in nodes.unwrap_or_default().windows(2) {
                for p in pair {
                    let p = p.as_vec3();
                    #[expect(clippy::cast_precision_loss, reason = "orders are small")]
                    out.extend([p.x, p.y, p.z, axis.order as f32]);
                }
            }
        }
        for organ in &plant.organs {
            let Some(Shape::Blade(blade)) = plant.shapes.get(organ.shape.index()) else { continue };
            let tip = organ.frame.origin + organ.frame.along * (blade.length() * organ.scale);
            let kind = if organ.kind == OrganKind::Petal { 101.0 } else { 100.0 };
            for p in [organ.frame.origin, tip].map(|p| p.as_vec3()) {
                out.extend([p.x, p.y, p.z, kind]);
            }
        }
        out
    }

    /// A small project for a link.
    pub(crate) fn share(&self) -> Told<Vec<u8>> {
        let document = self.editor.document().compact();
        document::write_project(&document, burgeon::VERSION).map_err(words)
    }

    pub(crate) fn save(&self) -> Told<Vec<u8>> {
        document::write_project(self.editor.document(), burgeon::VERSION).map_err(words)
    }

    pub(crate) fn export(&mut self, format: &str, options: &str) -> Told<Vec<u8>> {
        let options: crate::wire::ExportOptions = serde_json::from_str(options).map_err(words)?;
        if format == "json" {
            let plant = self.current_plant().ok_or("there is no drawing")?;
            let mut out = Vec::new();
            formats::write_drawing(&plant.drawing(), &mut out).map_err(words)?;
            return Ok(out);
        }
        if let Some(model) = &self.guest {
            return exports::packed(exports::written(model, format, "plant", &options.spec()?)?);
        }
        self.draft = None;
        let only = if options.whole { None } else { Some(self.must()?) };
        let cancel = CancelToken::new();
        let run = Run { cancel: &cancel, executor: &Attentive(&cancel), clock: &Host };
        exports::export(&mut self.scene, self.editor.document(), only, format, &options, &run)
    }

    #[cfg(test)]
    pub(crate) fn document(&self) -> &Document {
        self.editor.document()
    }
}

/// The plant of a stroke that is still being drawn.
fn preview(
    look: &mut Evaluator,
    plant: &DocumentPlant,
    draft: Option<&Stroke>,
    run: &Run<'_>,
) -> Result<ItemReport, MakeError> {
    let mut drawing = plant.drawing();
    drawing.strokes.extend(draft.cloned());
    let mut options = SketchOptions::of_plant(plant);
    // Fast while the pen is down, fine when it is lifted.
    options.skin.detail = (options.skin.detail * PREVIEW_DETAIL).max(0.1);
    look.update(&drawing, &options, plant.settings().seed, run)
}

fn plant_view(id: PlantId, model: &Model, textures: &mut Vec<Arc<Texture>>) -> PlantView {
    let mut view = PlantView::empty(id.0);
    let bounds = model.bounds();
    if !bounds.is_empty() {
        (view.min, view.max) = (bounds.min.to_array(), bounds.max.to_array());
    }
    let parts = model.parts.iter();
    view.parts = parts.map(|p| PartView { name: p.name.clone(), material: p.material.index() }).collect();
    let materials = model.materials.iter().map(|m| MaterialView {
        name: m.name.clone(),
        kind: m.kind.word(),
        color: m.base_color,
        roughness: m.roughness,
        translucency: m.translucency,
        masked: m.alpha == AlphaMode::Mask,
        two_sided: m.double_sided,
        texture: m.texture.as_ref().map(|t| TextureView {
            number: number_of(textures, t),
            width: t.width,
            height: t.height,
        }),
    });
    view.materials = materials.collect();
    view
}

fn number_of(textures: &mut Vec<Arc<Texture>>, texture: &Arc<Texture>) -> usize {
    let same = |t: &Arc<Texture>| Arc::ptr_eq(t, texture) || t == texture;
    textures.iter().position(same).unwrap_or_else(|| {
        textures.push(Arc::clone(texture));
        textures.len() - 1
    })
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

/// The drawing of this row among those that can be read, and the names of all.
fn pick(bytes: &[u8], format: DrawingFormat, stem: &str, row: u32) -> Told<(Drawing, Opened)> {
    let mut opened = Opened { kind: "drawing", ..Opened::default() };
    let mut picked = None;
    let mut failed = None;
    for read in read_drawings(bytes, format, stem).take(OFFERED) {
        match read {
            Ok(read) => {
                if opened.names.len() == row as usize {
                    opened.name.clone_from(&read.drawing.name);
                    opened.warnings = read.warnings.iter().map(words).collect();
                    picked = Some(read.drawing.clone());
                }
                opened.names.push(read.drawing.name);
            }
            Err(e) => failed = failed.or(Some(e)),
        }
    }
    match (picked, failed) {
        (Some(drawing), _) => Ok((drawing, opened)),
        (None, Some(e)) => Err(words(e)),
        (None, None) => Err("there is no drawing in it".into()),
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use serde_json::Value;

    fn line(points: &[(f64, f64)]) -> Vec<f64> {
        points.iter().flat_map(|&(x, y)| [x, y, f64::NAN, 0.5]).collect()
    }

    fn stem() -> Vec<f64> {
        line(&(0..40).map(|k| (0.1 * f64::from(k % 7), 5.0 * f64::from(k))).collect::<Vec<_>>())
    }

    fn json(text: &str) -> Value {
        serde_json::from_str(text).unwrap()
    }

    /// What is seen of the model that is looked at, or of the plant that is chosen.
    fn look(s: &mut Session) -> Value {
        let view = json(&s.evaluate().unwrap());
        let id = s.current_id().map(|id| id.0);
        let plant = view["plants"].as_array().unwrap().iter().find(|p| p["id"].as_u64() == id.map(u64::from));
        if view["guest"].is_null() { plant.cloned().unwrap_or_default() } else { view["guest"].clone() }
    }

    fn sample() -> Vec<u8> {
        std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/sketches/sample.svg")).unwrap()
    }

    #[test]
    fn a_stroke_becomes_a_plant_and_undo_takes_it_back() {
        let mut s = Session::default();
        assert_eq!(look(&mut s)["item"], Value::Null);
        let id = s.add_stroke("parts", &stem()).unwrap();
        assert_eq!(s.fresh_strokes(), [id]);
        assert_eq!(s.fresh_strokes(), [0; 0]);
        assert_eq!(s.stroke_points(id).len(), 120);
        let view = look(&mut s);
        assert_eq!(view["item"]["counts"]["branches"], 1);
        assert!(view["item"]["strokes"][0]["organ"].is_string());
        assert!(s.column(0, 0, Column::Positions).len() > 300 && s.indices(0, 0).len() > 300);
        let texture = &view["materials"][0]["texture"];
        assert_eq!(
            s.texture(0).len() as u64,
            4 * texture["width"].as_u64().unwrap() * texture["height"].as_u64().unwrap()
        );
        assert_eq!(s.undo().as_deref(), Some("draw"));
        let view = look(&mut s);
        assert_eq!((&view["item"], view["parts"].as_array().unwrap().len()), (&Value::Null, 0));
        assert_eq!(s.redo().as_deref(), Some("draw"));
        assert_eq!(look(&mut s)["item"]["counts"]["branches"], 1);
    }

    #[test]
    fn the_project_is_the_same_plant_elsewhere() {
        let mut s = Session::default();
        s.open("sample.svg", &sample(), 0, false).unwrap();
        s.run(r#"{"do":"seed","seed":"18446744073709551615"}"#).unwrap();
        s.run(r#"{"do":"class","ids":[0],"class":"axis"}"#).unwrap();
        let here = look(&mut s);
        let mut other = Session::default();
        let opened = json(&other.open("x.burgeon", &s.save().unwrap(), 0, true).unwrap());
        assert_eq!(opened["kind"], "project");
        let there = look(&mut other);
        assert_eq!(here["item"]["digest"], there["item"]["digest"]);
        assert_eq!(json(&other.state().unwrap())["plants"][0]["seed"], "18446744073709551615");
        assert_eq!(other.undo(), None, "opened fresh");
        let plant = &s.editor.document().plants()[0];
        let options = SketchOptions::of_plant(plant);
        let made =
            burgeon::make_from_sketch(&plant.drawing(), &options, plant.settings().seed, &Run::plain());
        assert_eq!(here["item"]["digest"], made.unwrap().item.digest.as_str());
    }

    #[test]
    fn every_format_opens_and_a_bad_file_changes_nothing() {
        let mut s = Session::default();
        s.open("sample.svg", &sample(), 0, false).unwrap();
        let state = s.state().unwrap();
        for (name, bytes) in [
            ("x.svg", &b"<svg"[..]),
            ("x.burgeon", b"PK\x03\x04"),
            ("x.glb", b"glTF"),
            ("x.exe", b"MZ"),
            ("x.json", b"{}"),
            ("x.ndjson", b"\n\n"),
            ("", b""),
        ] {
            let said = s.open(name, bytes, 0, false).unwrap_err();
            assert!(said.len() > 20, "{name}: {said}");
            assert_eq!(s.state().unwrap(), state, "{name}");
        }
        for format in ["glb", "ply", "stl"] {
            let file = s.export(format, "{}").unwrap();
            let mut other = Session::default();
            let opened = json(&other.open(&format!("plant.{format}"), &file, 0, false).unwrap());
            assert_eq!(opened["kind"], "model");
            let view = look(&mut other);
            assert!(!view["parts"].as_array().unwrap().is_empty() && view["max"][1].as_f64().unwrap() > 0.1);
            assert!(other.export("glb", "{}").unwrap().starts_with(b"glTF"));
        }
        assert!(s.export("obj", "{}").unwrap().starts_with(b"PK"));
        assert!(s.export("exe", "{}").is_err());
        let drawing = s.export("json", "{}").unwrap();
        assert_eq!(json(&Session::default().open("d.json", &drawing, 0, false).unwrap())["kind"], "drawing");
        let two = concat!(
            r#"{"word":"a","drawing":[[[0,9],[0,90]]]}"#,
            "\nbad\n",
            r#"{"word":"b","drawing":[[[0,5],[0,70]]]}"#,
            "\n"
        );
        let opened = json(&s.open("two.ndjson", two.as_bytes(), 1, false).unwrap());
        assert_eq!((opened["names"].as_array().unwrap().len(), &opened["name"]), (2, &opened["names"][1]));
    }

    #[test]
    fn a_drag_is_staged_and_a_draft_leaves_no_trace() {
        let mut s = Session::default();
        let id = s.add_stroke("parts", &stem()).unwrap();
        s.begin("move").unwrap();
        s.stage(&format!(r#"{{"do":"move","ids":[{id}],"x":5,"y":1}}"#)).unwrap();
        s.stage(&format!(r#"{{"do":"move","ids":[{id}],"x":50,"y":0}}"#)).unwrap();
        s.commit();
        assert_eq!(s.stroke_points(id)[0], 50.0);
        assert_eq!(json(&s.state().unwrap())["steps"], 2);
        let before = look(&mut s);
        s.draft("leaf-contour", &line(&[(0.0, 0.0), (40.0, 0.0), (40.0, 40.0)])).unwrap();
        assert_eq!(look(&mut s)["item"]["strokes"].as_array().unwrap().len(), 2);
        s.draft("parts", &[]).unwrap();
        let after = look(&mut s);
        assert_eq!(before["item"]["digest"], after["item"]["digest"]);
        assert!(s.draft("crayon", &[]).is_err() && s.run(r#"{"do":"explode"}"#).is_err());
    }

    fn photo() -> Vec<u8> {
        let pixels: Vec<u8> = (0..64).flat_map(|k| [200, 3 * (k % 8), 3 * (k / 8), 255]).collect();
        let mut png = Vec::new();
        formats::write_png(8, 8, &pixels, &mut png).unwrap();
        png
    }

    #[test]
    fn traced_organs_take_the_photograph_and_others_do_not() {
        let mut s = Session::default();
        s.open("sample.svg", &sample(), 0, true).unwrap();
        let plain = look(&mut s);
        let points = s.stroke_points(0);
        let (x, y) = (points[0], points[1]);
        assert!(s.place_photo(b"GIF", x, y, 1.0).is_err());
        s.place_photo(&photo(), -1e4, -1e4, 2e4).unwrap();
        assert_eq!((s.fresh_photo(), s.fresh_photo()), (photo(), Vec::new()));
        let traced = look(&mut s);
        assert_eq!(traced["item"]["digest"], plain["item"]["digest"], "the plant is the same");
        assert_eq!(traced["stages"].as_array().unwrap().len(), 1, "only the surface is made again");
        let names = |v: &Value| -> Vec<String> {
            v["parts"].as_array().unwrap().iter().map(|p| p["name"].as_str().unwrap().to_owned()).collect()
        };
        assert!(names(&traced).contains(&"petals-traced".to_owned()), "{:?}", names(&traced));
        let part = names(&traced).iter().position(|n| n == "petals-traced").unwrap();
        let uvs = s.column(0, part, Column::Uvs);
        assert_eq!(uvs.len() / 2, s.column(0, part, Column::Positions).len() / 3);
        assert!(uvs.iter().all(|x| (0.0..=1.0).contains(x)));
        // A small photograph far away traces nothing; one that does not paint neither.
        s.run(r#"{"do":"photo","x":-9000,"y":-9000,"width":1,"opacity":0.5,"paint":true}"#).unwrap();
        assert_eq!(names(&look(&mut s)), names(&plain));
        s.run(r#"{"do":"photo","x":-1e4,"y":-1e4,"width":2e4,"opacity":0.2,"paint":false}"#).unwrap();
        assert_eq!(names(&look(&mut s)), names(&plain));
        let mut other = Session::default();
        other.open("p.burgeon", &s.save().unwrap(), 0, true).unwrap();
        assert_eq!(other.fresh_photo(), photo());
        s.run(r#"{"do":"photo-off"}"#).unwrap();
        assert!(s.run(r#"{"do":"photo","x":0,"y":0,"width":1,"opacity":0.2,"paint":true}"#).is_err());
        assert_eq!(s.undo().as_deref(), Some("photo"));
    }

    #[test]
    fn copies_variants_levels_and_links() {
        let mut s = Session::default();
        s.open("sample.svg", &sample(), 0, true).unwrap();
        let plant = look(&mut s);
        let text = s.copy(&[0, 1]).unwrap();
        assert!(s.copy(&[99]).is_err() && s.paste("no drawing", 0.0, 0.0).is_err());
        assert_eq!(s.paste(&text, 5.0, 0.0).unwrap(), [15, 16]);
        assert_eq!(s.stroke_points(15)[0], s.stroke_points(0)[0] + 5.0);
        s.run(r#"{"do":"duplicate","ids":[0],"x":0,"y":1}"#).unwrap();
        assert_eq!((s.undo().as_deref(), s.undo().as_deref()), (Some("duplicate"), Some("draw")));

        let other = json(&s.variant("77", 0.4).unwrap());
        let positions = s.column(u32::MAX, 0, Column::Positions);
        s.end_variant();
        assert!(other["item"].is_null() && !positions.is_empty());
        let again = look(&mut s);
        assert_eq!(
            again["item"]["digest"], plant["item"]["digest"],
            "a look at another seed changes nothing"
        );
        assert!(s.column(0, 0, Column::Positions).len() > positions.len());
        assert_eq!(s.skeleton().len() % 8, 0);
        assert!(!s.skeleton().is_empty());

        let levels = s.export("glb", r#"{"levels":3}"#).unwrap();
        assert!(
            levels.starts_with(b"PK")
                && levels.windows(9).any(|w| w == b"LOD2.glb\0" || &w[..8] == b"LOD2.glb")
        );
        assert!(s.export("ply", r#"{"up":"x"}"#).is_err());

        let link = s.share().unwrap();
        assert!(link.len() < 16 << 10, "{} bytes", link.len());
        let mut linked = Session::default();
        linked.open("x.burgeon", &link, 0, true).unwrap();
        let shared = look(&mut linked);
        assert_eq!(shared["item"]["counts"]["flowers"], plant["item"]["counts"]["flowers"]);
    }

    const BUSH: &str = "name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 200\nlifespan = 1\n";

    fn marks() -> Vec<u8> {
        std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/leaves/leaf1.csv")).unwrap()
    }

    /// Name, digest and problem of every plant.
    fn scene(s: &mut Session) -> Vec<(String, String, Value)> {
        let state = json(&s.state().unwrap());
        let view = json(&s.evaluate().unwrap());
        let both = state["plants"].as_array().unwrap().iter().zip(view["plants"].as_array().unwrap());
        let word = |v: &Value| v.as_str().unwrap_or_default().to_owned();
        both.map(|(p, v)| (word(&p["name"]), word(&v["item"]["digest"]), v["error"].clone())).collect()
    }

    #[test]
    fn a_tree_a_leaf_and_a_flower_in_one_scene() {
        let mut s = Session::default();
        let opened = json(&s.open("bush.toml", BUSH.as_bytes(), 0, false).unwrap());
        assert_eq!(
            (opened["kind"].as_str(), s.document().plants().len()),
            (Some("tree"), 1),
            "the blank sheet gave way"
        );
        s.evaluate().unwrap();
        s.open("leaf1.csv", &marks(), 0, false).unwrap();
        s.run(r#"{"do":"add","maker":"flower","name":"a rose","preset":"rose"}"#).unwrap();
        let made = scene(&mut s);
        assert_eq!(made.len(), 3);
        assert!(made.iter().all(|(_, digest, error)| digest.len() > 8 && error.is_null()), "{made:?}");
        // Nothing is grown or sent again for a change elsewhere.
        s.run(r#"{"do":"flower","settings":{"species":"rose","day":1.5}}"#).unwrap();
        let view = json(&s.evaluate().unwrap());
        let fresh: Vec<bool> = (0..3).map(|k| view["plants"][k]["fresh"].as_bool().unwrap()).collect();
        assert_eq!(fresh, [false, false, true]);
        assert_eq!(view["plants"][2]["days"].as_array().unwrap().len(), 2);
        let mut other = Session::default();
        other.open("three.burgeon", &s.save().unwrap(), 0, true).unwrap();
        assert_eq!(scene(&mut other), scene(&mut s));
        // An obstacle is grown around; a spec that is none is refused.
        let ids: Vec<u32> = s.document().plants().iter().map(|p| p.id().0).collect();
        assert_eq!(ids.len(), made.len());
        s.select(ids[0]).unwrap();
        let before = scene(&mut s);
        s.run(r#"{"do":"obstacle","name":"ball","shape":{"shape":"sphere","centre":[0,3,0],"radius_m":1}}"#)
            .unwrap();
        assert_ne!(scene(&mut s)[0].1, before[0].1);
        assert!(s.run(r#"{"do":"tree","path":"/age","value":"old"}"#).is_err());
        assert!(s.run(r#"{"do":"tree","path":"/no/such","value":1}"#).is_err());
        s.run(r#"{"do":"tree","path":"/clearance_m","value":-1}"#).unwrap();
        assert!(scene(&mut s)[0].2.as_str().unwrap().contains("clearance_m"), "{:?}", scene(&mut s)[0]);
        s.undo();
        let model = s.export("obj", "{}").unwrap();
        assert!(model.starts_with(b"PK"));
        let ball = s.export("ply", "{}").unwrap();
        s.add_obstacle("itself.ply", &ball).unwrap();
        assert!(!s.obstacle(ids[0], 1).is_empty() && s.obstacle(ids[0], 0).is_empty());
        s.undo();
        s.undo();
        s.run(&format!(r#"{{"do":"leaf-of","lender":{}}}"#, ids[1])).unwrap();
        let borne = scene(&mut s);
        assert!(borne[0].2.is_null() && borne[0].1 != before[0].1);
        // Hidden plants are not in an export of the scene.
        let whole = s.export("glb", r#"{"whole":true}"#).unwrap();
        s.run(&format!(r#"{{"do":"hide","plant":{},"on":true}}"#, ids[2])).unwrap();
        assert!(s.export("glb", r#"{"whole":true}"#).unwrap().len() < whole.len());
        assert!(s.export("mtg", "{}").unwrap().len() > 200);
        s.run(&format!(r#"{{"do":"remove-plant","plant":{}}}"#, ids[1])).unwrap();
        assert_eq!(scene(&mut s)[0].1, before[0].1, "its own leaf again");
        while s.undo().is_some() {}
        assert_eq!(s.document(), &Document::default());
    }

    #[test]
    fn a_drawn_flower_opens_and_closes() {
        let mut s = Session::default();
        s.open("sample.svg", &sample(), 0, true).unwrap();
        let drawn = look(&mut s);
        s.run(r#"{"do":"day","day":0}"#).unwrap();
        let bud = look(&mut s);
        assert!(bud["fresh"].as_bool().unwrap() && bud["error"].is_null(), "{}", bud["error"]);
        let days = bud["days"].as_array().unwrap();
        assert_eq!((days.len(), &bud["item"]["digest"]), (2, &drawn["item"]["digest"]));
        let closed = s.column(0, 0, Column::Positions);
        s.run(r#"{"do":"day","day":6}"#).unwrap();
        s.evaluate().unwrap();
        let last = s.model(PlantId(0)).unwrap().parts.len() - 1;
        let open = s.column(0, last, Column::Positions);
        assert!(!open.is_empty() && closed != open);
        s.undo();
        s.undo();
        assert_eq!(look(&mut s)["parts"], drawn["parts"]);
        // What was taken off the page comes back with its meshes.
        s.run(r#"{"do":"new"}"#).unwrap();
        assert!(look(&mut s)["parts"].as_array().unwrap().is_empty());
        s.undo();
        let back = look(&mut s);
        assert!(back["fresh"].as_bool().unwrap() && back["parts"] == drawn["parts"]);
    }
}
