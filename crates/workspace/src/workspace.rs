//! The open document: plants, strokes, commands, gestures, undo.

use std::sync::Arc;

use burgeon::document::{
    self, Document, DocumentPlant, Editor, Maker, NewPlant, NewStroke, Photo, PhotoPlace, PlantCommand,
    PlantId, SceneCommand, Settings, SketchCommand, StrokeId, WornPicture,
};
use burgeon::formats::{self, DrawingFormat, read_drawings};
use burgeon::glam::DVec2;
use burgeon::ink::{Drawing, InkSample, Stroke, StrokeClass};
use burgeon::mesh::Model;
use burgeon::skin::{OrganMaterial, Pattern, Wearer};
use burgeon::{Evaluator, ItemReport, LiteMap, Preset, Run, SceneEvaluator, tree_settings};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::export_preview::{ExportPreview, PrintFigures, WrittenFigures};
use crate::held::Held;
use crate::kept::Kept;
use crate::shown::Levels;
use crate::view::{Outcome, Textures};
use crate::{DocumentState, Scatter, WorkspaceError};

/// Room between a new tree and the other plants, metres: as wide as the crown of a tree.
const TREE_ROOM: f64 = 4.0;
/// Room between a new plant other than a tree and the others, metres: as wide as a hand.
const ROOM: f64 = 0.25;

/// Requests that take more than one [`document::Command`]. One step of undo each.
///
/// ```
/// let action: workspace::Action = serde_json::from_str(r#"{"add":{"name":"my oak","maker":{"tree":"oak"}}}"#)?;
/// assert!(matches!(action, workspace::Action::Add { .. }));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Action {
    /// Replaces the document by an empty one.
    New,
    /// Adds a plant next to the others and chooses it. It replaces a sheet on which nothing was drawn.
    Add {
        /// Its name.
        name: String,
        /// Its maker.
        maker: NewMaker,
    },
    /// Gives a tree or a flower another species.
    Preset {
        /// The plant.
        plant: PlantId,
        /// The key of the preset.
        key: String,
    },
    /// Splits a drawing of several plants into drawings of one plant each.
    Split {
        /// The drawing.
        plant: PlantId,
    },
    /// Shows the scene again, not a model.
    CloseModel,
    /// Copies of a plant in many places.
    Scatter(Scatter),
}

/// The maker of a new plant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NewMaker {
    /// An empty sheet.
    Sketch,
    /// A tree of this preset.
    Tree(String),
    /// A leaf of a few numbers, until it is given marks.
    Leaf,
    /// A flower of this species.
    Flower(String),
}

/// A document with its history, its plants as they were made last, and the held tool.
///
/// Guaranteed: after an error everything is as it was. Apart from drafts, gestures and the numbers of textures, the
/// view never depends on earlier requests.
///
/// ```
/// use burgeon::Run;
/// use workspace::{Action, NewMaker, Workspace};
/// let mut workspace = Workspace::default();
/// workspace.act(&Action::Add { name: "a lily".into(), maker: NewMaker::Flower("lily".into()) })?;
/// let view = workspace.evaluate(&Run::plain())?;
/// assert_eq!(view.plants[0].item.as_ref().and_then(|i| i.counts.flowers), Some(1));
/// assert_eq!(workspace.undo(), Some("add-plant"));
/// # Ok::<(), workspace::WorkspaceError>(())
/// ```
#[derive(Debug, Default)]
pub struct Workspace {
    pub(crate) editor: Editor,
    pub(crate) scene: SceneEvaluator,
    /// The plant that was chosen.
    pub(crate) current: Option<PlantId>,
    pub(crate) draft: Option<NewStroke>,
    /// The current plant while a stroke is drawn.
    pub(crate) preview: Option<Evaluator>,
    /// The plant and the revision whose classes the previews of a draft began with.
    pub(crate) followed: Option<(PlantId, u64)>,
    pub(crate) preview_item: Option<ItemReport>,
    pub(crate) previewed: bool,
    /// A model file that is shown instead of the scene.
    pub(crate) guest: Option<Model>,
    /// The same description with another seed, shown for a moment.
    pub(crate) variant: Option<Model>,
    /// Much coarser previews of trees that are still being made.
    pub(crate) coarse: LiteMap<PlantId, Model>,
    /// The preview of an export.
    pub(crate) export_preview: Option<ExportPreview>,
    /// The last body that was made for a printer.
    pub(crate) printed: Option<PrintFigures>,
    pub(crate) written: Option<WrittenFigures>,
    /// Outcome of each plant at the last evaluation.
    pub(crate) outcomes: LiteMap<PlantId, Outcome>,
    /// Source of each plant's meshes in the last view: a revision, or a preview.
    pub(crate) meshes: LiteMap<PlantId, Option<u64>>,
    pub(crate) kept: Kept,
    /// Plants that are shown coarser than they were made.
    pub(crate) levels: Levels,
    /// Strokes whose points the shell has. Holding them keeps their addresses from being used again.
    given: LiteMap<StrokeId, Arc<Stroke>>,
    pub(crate) textures: Textures,
    /// A tool that shapes a plant.
    pub(crate) held: Option<Held>,
    /// The photograph that the shell has.
    given_photo: Option<Arc<[u8]>>,
    /// Place along x of the plant that was added last, metres.
    /// Place along x of the next plant, metres.
    placed: Option<f64>,
    place_next: Option<f64>,
}

impl Workspace {
    /// Returns the current document, including an open gesture.
    pub fn document(&self) -> &Document {
        self.editor.document()
    }

    /// Returns the plant on the sheet and in the panel: the chosen one, or the last.
    pub fn current(&self) -> Option<PlantId> {
        let document = self.editor.document();
        let chosen = self.current.filter(|&id| document.plant(id).is_some());
        chosen.or_else(|| document.plants().last().map(DocumentPlant::id))
    }

    pub(crate) fn current_plant(&self) -> Option<&DocumentPlant> {
        self.editor.document().plant(self.current()?)
    }

    pub(crate) fn must(&self) -> Result<PlantId, WorkspaceError> {
        self.current().ok_or(WorkspaceError::NoPlant)
    }

    /// Chooses the plant that strokes, drafts, tools and exports apply to.
    ///
    /// # Errors
    /// [`WorkspaceError::PlantGone`].
    pub fn select(&mut self, plant: PlantId) -> Result<(), WorkspaceError> {
        if self.editor.document().plant(plant).is_none() {
            return Err(WorkspaceError::PlantGone);
        }
        self.current = Some(plant);
        self.draft = None;
        self.guest = None;
        self.let_go();
        Ok(())
    }

    /// Starts empty, drops the history and frees the memory of the document.
    pub fn close(&mut self) {
        let kept = Kept { most: self.kept.most, ..Kept::at_most(self.kept.limit) };
        *self = Self { kept, ..Self::default() };
    }

    /// Runs a command as one step of undo, or as part of the open gesture. A copy of a plant is chosen.
    ///
    /// # Errors
    /// [`WorkspaceError`]: the reason why it was refused.
    pub fn run(&mut self, command: impl Into<document::Command>) -> Result<(), WorkspaceError> {
        let command = command.into();
        self.let_go();
        self.check(&command)?;
        let copies = matches!(command, document::Command::Scene(SceneCommand::Duplicate(..)));
        self.editor.run(command)?;
        if copies {
            self.current = self.editor.document().plants().last().map(DocumentPlant::id);
        }
        self.guest = None;
        Ok(())
    }

    /// Performs an action of more than one command, as one step of undo.
    ///
    /// # Errors
    /// [`WorkspaceError`]: the reason why it was refused.
    pub fn act(&mut self, action: &Action) -> Result<(), WorkspaceError> {
        match action {
            Action::New => self.run(SceneCommand::Open(Box::default())),
            Action::Add { name, maker } => {
                self.let_go();
                let maker = match maker {
                    NewMaker::Sketch => Maker::default(),
                    NewMaker::Tree(key) => Maker::Tree(Box::new(preset(key)?)),
                    NewMaker::Leaf => Maker::Leaf(Box::default()),
                    NewMaker::Flower(species) => Maker::Flower(Box::new(flower(species)?)),
                };
                self.add_plant(name, maker)?;
                self.guest = None;
                Ok(())
            }
            Action::Preset { plant, key } => {
                let opens = |p: &DocumentPlant| matches!(p.settings().maker, Maker::Flower(_));
                if self.editor.document().plant(*plant).is_some_and(opens) {
                    let document::FlowerMaker { preset, spec, .. } = flower(key)?;
                    return self.run(document::FlowerCommand::SetSpec(preset, spec).for_plant(*plant));
                }
                let document::TreeSettings { preset, spec, .. } = preset(key)?;
                self.run(document::TreeCommand::SetSpec(preset, spec).for_plant(*plant))
            }
            Action::Split { plant } => {
                self.let_go();
                burgeon::split(&mut self.editor, *plant, &Run::plain())?;
                self.current = self.editor.document().plants().last().map(DocumentPlant::id);
                (self.guest, self.draft) = (None, None);
                Ok(())
            }
            Action::CloseModel => {
                self.guest = None;
                Ok(())
            }
            Action::Scatter(wanted) => self.scatter(wanted),
        }
    }

    /// Returns the place of the last plant that requests since the last call added: metres along x.
    ///
    /// The widths of the others are known only where they were grown. A shell that repeats the requests without growing
    /// them, as after a fault, sets the place beforehand with [`Workspace::place_next`].
    pub fn placed(&mut self) -> Option<f64> {
        self.place_next = None;
        self.placed.take()
    }

    /// Sets the place of the plant that the next request adds, along x in metres, instead of next to the others.
    pub fn place_next(&mut self, x: f64) {
        self.place_next = Some(x);
    }

    /// Adds a plant next to the others and chooses it. It replaces a sheet on which nothing was drawn.
    pub(crate) fn add_plant(&mut self, name: &str, maker: Maker) -> Result<(), WorkspaceError> {
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
            let beside = || (10.0 * (right.fold(0.0, f64::max) + room)).round() / 10.0;
            let x = self.place_next.filter(|x| x.is_finite()).unwrap_or_else(beside);
            settings.placement.position.x = x;
        }
        self.placed = Some(settings.placement.position.x);
        let add = SceneCommand::Add(Box::new(NewPlant { settings, strokes: Vec::new() }));
        if let Some(blank) = blank {
            self.editor.begin_gesture("add-plant")?;
            let done = self.editor.run(add).and_then(|()| self.editor.run(SceneCommand::Remove(vec![blank])));
            if let Err(e) = done {
                self.editor.cancel_gesture();
                return Err(e.into());
            }
            self.editor.commit();
        } else {
            self.editor.run(add)?;
        }
        self.current = self.editor.document().plants().last().map(DocumentPlant::id);
        self.draft = None;
        Ok(())
    }

    /// Adds a stroke to the current drawing and returns its number. `shown`: the classes that its strokes were shown as
    /// when this one was drawn, where they are new; none for strokes whose class was unclear. Reading departs from them
    /// only for clear evidence ([`SketchCommand::Draw`]).
    ///
    /// # Errors
    /// [`WorkspaceError`]: no point is finite, or the plant is not a drawing.
    pub fn add_stroke(
        &mut self,
        stroke: impl Into<NewStroke>,
        shown: Vec<(StrokeId, Option<StrokeClass>)>,
    ) -> Result<StrokeId, WorkspaceError> {
        self.draft = None;
        self.guest = None;
        let id = self.must()?;
        self.editor.run(SketchCommand::Draw(stroke.into(), shown).for_plant(id))?;
        let last = self.editor.document().plant(id).and_then(|p| p.strokes().last());
        last.map(|s| s.id).ok_or(WorkspaceError::Internal("no stroke"))
    }

    /// Gives a stroke of the current drawing other points ([`SketchCommand::Straighten`]).
    ///
    /// # Errors
    /// [`WorkspaceError`]: the stroke is not there, or a point is not finite.
    pub fn straighten(&mut self, stroke: StrokeId, samples: Vec<InkSample>) -> Result<(), WorkspaceError> {
        let id = self.must()?;
        Ok(self.editor.run(SketchCommand::Straighten(stroke, samples).for_plant(id))?)
    }

    /// Shows a stroke that is still being drawn and is not in the document; one without points takes it away.
    pub fn draft(&mut self, stroke: impl Into<NewStroke>) {
        self.draft = Some(stroke.into()).filter(|s| !s.stroke.samples.is_empty());
        if self.draft.is_some() {
            self.guest = None;
        }
    }

    /// Opens a gesture: the commands staged up to [`Workspace::commit`] form one step of this name.
    ///
    /// # Errors
    /// While another is open.
    pub fn begin(&mut self, name: &str) -> Result<(), WorkspaceError> {
        self.let_go();
        Ok(self.editor.begin_gesture(name)?)
    }

    /// Replaces the commands of the open gesture by one command.
    ///
    /// # Errors
    /// [`WorkspaceError`]: the reason why it was refused.
    pub fn stage(&mut self, command: impl Into<document::Command>) -> Result<(), WorkspaceError> {
        let command = command.into();
        self.check(&command)?;
        Ok(self.editor.stage(command)?)
    }

    /// Closes the gesture.
    pub fn commit(&mut self) {
        self.editor.commit();
    }

    /// Closes the gesture and takes its commands back.
    pub fn abandon(&mut self) {
        self.editor.cancel_gesture();
    }

    /// Returns strokes of the current drawing as a drawing in our JSON, for a clipboard.
    ///
    /// # Errors
    /// [`WorkspaceError::NoStroke`] when none of them exists.
    pub fn copy(&self, ids: &[StrokeId]) -> Result<Vec<u8>, WorkspaceError> {
        let plant = self.current_plant().ok_or(WorkspaceError::NoStroke)?;
        let chosen = plant.strokes().iter().filter(|s| ids.contains(&s.id));
        let strokes: Vec<Stroke> = chosen.map(|s| Stroke::clone(&s.stroke)).collect();
        if strokes.is_empty() {
            return Err(WorkspaceError::NoStroke);
        }
        let mut out = Vec::new();
        let drawing =
            Drawing { name: plant.settings().name.clone(), strokes, layers: plant.layers().to_vec() };
        formats::write_drawing(&drawing, &mut out)?;
        Ok(out)
    }

    /// Adds the strokes of a drawing as text (our JSON, SVG, InkML), moved by `by`; returns their numbers.
    ///
    /// # Errors
    /// [`WorkspaceError`]: the fault of the text.
    pub fn paste(&mut self, text: &str, by: DVec2) -> Result<Vec<StrokeId>, WorkspaceError> {
        let format = DrawingFormat::sniff(text.as_bytes()).ok_or(WorkspaceError::NoClipboard)?;
        let read = read_drawings(text.as_bytes(), format, "clipboard").next();
        let mut strokes = read.ok_or(WorkspaceError::NoClipboard)??.drawing.strokes;
        for p in strokes.iter_mut().flat_map(|s| &mut s.samples) {
            p.at += by;
        }
        let id = self.must()?;
        let before = self.current_plant().map_or(0, |p| p.strokes().len());
        let new = strokes.into_iter().map(NewStroke::from).collect();
        self.editor.run(SketchCommand::AddStrokes(new).for_plant(id))?;
        self.guest = None;
        let strokes = self.current_plant().map_or(&[][..], DocumentPlant::strokes);
        Ok(strokes.iter().skip(before).map(|s| s.id).collect())
    }

    /// Puts a photograph (PNG) under the current drawing: lower left corner and width in the drawing's unit.
    ///
    /// # Errors
    /// [`WorkspaceError::Photo`] when it is not a PNG or too large.
    pub fn place_photo(&mut self, png: &[u8], at: DVec2, width: f64) -> Result<(), WorkspaceError> {
        let mut photo = Photo::new(png.into())?;
        photo.place = PhotoPlace { x: at.x, y: at.y, width, ..photo.place };
        Ok(self.editor.run(SketchCommand::SetPhoto(Box::new(photo)).for_plant(self.must()?))?)
    }

    /// Gives organs of the current plant a material with a picture (PNG): those read from `strokes`, or, without any,
    /// all of a kind. One step of undo.
    ///
    /// # Errors
    /// [`WorkspaceError::Picture`] when it is not a PNG or too large; [`WorkspaceError::Command`].
    pub fn wear_picture(
        &mut self,
        (wearer, strokes): (Wearer, Vec<StrokeId>),
        material: OrganMaterial,
        png: &[u8],
    ) -> Result<(), WorkspaceError> {
        let picture = WornPicture::new(png.into())?;
        let id = self.must()?;
        let worn =
            Some(OrganMaterial { pattern: Pattern::Picture, picture: Some(picture.name()), ..material });
        let known = self.current_plant().is_some_and(|p| p.settings().pictures.contains_key(&picture.name()));
        let add = (!known).then(|| PlantCommand::AddPicture(picture).for_plant(id));
        let wear = match strokes.is_empty() {
            true => PlantCommand::Wear(wearer, worn).for_plant(id),
            false => SketchCommand::SetMaterial(strokes, worn).for_plant(id),
        };
        self.let_go();
        self.editor.begin_gesture("material")?;
        let done = add.map_or(Ok(()), |add| self.editor.run(add)).and_then(|()| self.editor.run(wear));
        if let Err(e) = done {
            self.editor.cancel_gesture();
            return Err(e.into());
        }
        self.editor.commit();
        self.guest = None;
        Ok(())
    }

    /// Returns the photograph's file if the shell has another one; it counts as delivered from now on.
    pub fn fresh_photo(&mut self) -> Option<Arc<[u8]>> {
        let photo = self.current_plant()?.settings().photo().map(|p| Arc::clone(p.png()))?;
        let had = self.given_photo.as_ref().is_some_and(|had| Arc::ptr_eq(&photo, had));
        self.given_photo = Some(Arc::clone(&photo));
        (!had).then_some(photo)
    }

    /// Undoes the last step and returns its name.
    pub fn undo(&mut self) -> Option<&str> {
        self.guest = None;
        self.let_go();
        self.editor.undo()
    }

    /// Redoes the last undone step and returns its name.
    pub fn redo(&mut self) -> Option<&str> {
        self.guest = None;
        self.let_go();
        self.editor.redo()
    }

    /// Returns the document as lists and panels show it, without points.
    pub fn state(&self) -> DocumentState<'_> {
        DocumentState::from_editor(&self.editor, self.current())
    }

    /// Returns strokes of the current drawing whose points the shell does not have yet; they count as delivered from
    /// now on.
    pub fn fresh_strokes(&mut self) -> Vec<StrokeId> {
        let mut fresh = Vec::new();
        let mut given = LiteMap::new();
        let plant = self.current().and_then(|id| self.editor.document().plant(id));
        for s in plant.map_or(&[][..], DocumentPlant::strokes) {
            if !self.given.get(&s.id).is_some_and(|old| Arc::ptr_eq(old, &s.stroke)) {
                fresh.push(s.id);
            }
            given.insert(s.id, Arc::clone(&s.stroke));
        }
        self.given = given;
        fresh
    }

    /// Returns a stroke of the current drawing.
    pub fn stroke(&self, id: StrokeId) -> Option<&Stroke> {
        let plant = self.current_plant()?;
        plant.strokes().get(plant.row(id)?).map(|s| &*s.stroke)
    }

    /// Drops the held tool after a change of the document, or of the shown plant.
    pub(crate) fn let_go(&mut self) {
        self.held = None;
    }
}

fn flower(species: &str) -> Result<document::FlowerMaker, WorkspaceError> {
    let unknown = || document::SettingFault::Flower { name: species.into() };
    let flower = document::FlowerMaker::from_preset(species);
    flower.ok_or_else(|| document::CommandError::OutOfRange(unknown()).into())
}

fn preset(key: &str) -> Result<document::TreeSettings, WorkspaceError> {
    let preset = Preset::find(key).ok_or_else(|| WorkspaceError::NoTree(key.into()))?;
    Ok(tree_settings(&preset.spec().map_err(burgeon::TreeError::from)?, Some(key)))
}
