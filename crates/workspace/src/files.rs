//! Files in and out of a workspace, as bytes.

use std::sync::Arc;

use burgeon::bloom::FlowerSpec;
use burgeon::document::{
    self, CommandError, Document, DocumentPlant, Editor, FlowerCommand, FlowerMaker, LeafData, LeafMaker,
    Maker, SceneCommand, TreeCommand,
};
use burgeon::formats::{
    DrawingFormat, ExportSpec, Foreign, ModelFormat, no_files, read_drawings, read_model,
};
use burgeon::growth::Obstacle;
use burgeon::ink::Drawing;
use burgeon::leaf::LeafSpec;
use burgeon::spec::{self, through_json};
use burgeon::{LeafError, Report, SceneError, leaf_balls, leaf_marks, read_tree_spec, tree_settings};
use schemars::JsonSchema;
use serde::Serialize;

use crate::{WarningView, Workspace, WorkspaceError};

/// Kind of an opened file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FileKind {
    /// A project, which replaced the document.
    Project,
    /// A drawing, which replaced the document.
    Drawing,
    /// A model, which is shown.
    Model,
    /// Measurements, which went to a leaf.
    Leaf,
    /// A new tree.
    Tree,
    /// A new flower that opens.
    Flower,
    /// A growth law, which went to the current flower.
    Law,
}

/// Result of opening a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Opened {
    /// Kind of the file.
    pub kind: FileKind,
    /// Its name.
    pub name: String,
    /// Every drawing of the file, at most a thousand.
    pub names: Vec<String>,
    /// Warnings about it.
    pub warnings: Vec<WarningView>,
}

impl Opened {
    fn new(kind: FileKind, name: impl Into<String>) -> Self {
        Self { kind, name: name.into(), names: Vec::new(), warnings: Vec::new() }
    }
}

/// Most drawings of a file that are offered for choice.
const OFFERED: usize = 1000;

impl Workspace {
    /// Opens any file in a known format. A project or drawing replaces the document (one step of undo, or none with
    /// `fresh`), a model is only shown. `row` picks a drawing of an ndjson file.
    ///
    /// # Errors
    /// [`WorkspaceError`]: the fault of the file and its remedy.
    pub fn open(
        &mut self,
        file_name: &str,
        bytes: &[u8],
        row: usize,
        fresh: bool,
    ) -> Result<Opened, WorkspaceError> {
        let (stem, extension) = file_name.rsplit_once('.').unwrap_or((file_name, ""));
        let is = |wanted: &str| extension.eq_ignore_ascii_case(wanted);
        let drawing = DrawingFormat::from_extension(extension);
        let model = ModelFormat::from_extension(extension);
        let model = model.or_else(|| ModelFormat::sniff(bytes)).filter(|_| drawing.is_none());
        let holds = |word: &[u8]| bytes.windows(word.len()).take(4096).any(|w| w == word);
        // Projects are archives; compressed drawings are accepted.
        let ours = |foreign: &Foreign| matches!(foreign, Foreign::Project | Foreign::Zip | Foreign::Gzip);
        if let Some(foreign) = Foreign::sniff(bytes).filter(|foreign| !is("burgeon") && !ours(foreign)) {
            return Err(WorkspaceError::Foreign(foreign));
        }
        if is("burgeon") || document::is_project(bytes) {
            let document = document::read_project(bytes)?;
            let opened = Opened::new(FileKind::Project, document.name());
            self.replace(document, fresh)?;
            Ok(opened)
        } else if is("csv") || (is("json") && holds(b"\"edges\"")) {
            self.open_leaf(stem, file_name, bytes)
        } else if is("toml") {
            let text = core::str::from_utf8(bytes)?;
            if spec::Node::from_toml(text).is_ok_and(|tree| tree.field("whorls").is_some()) {
                let spec: FlowerSpec = spec::from_toml(text).map_err(CommandError::from)?;
                let name = spec.name.clone();
                let flower = FlowerMaker { preset: None, spec: Arc::new(spec), ..FlowerMaker::default() };
                self.add_plant(&name, Maker::Flower(Box::new(flower)))?;
                return Ok(Opened::new(FileKind::Flower, name));
            }
            let spec = read_tree_spec(text, &|_| None)?;
            let settings = tree_settings(&spec, None);
            self.add_plant(&spec.name, Maker::Tree(Box::new(settings)))?;
            Ok(Opened::new(FileKind::Tree, spec.name))
        } else if is("json") && holds(b"burgeon.law/") {
            let law = through_json::from_text(core::str::from_utf8(bytes)?).map_err(WorkspaceError::Law)?;
            self.run(FlowerCommand::SetLaw(Some(Arc::new(law))).for_plant(self.must()?))?;
            Ok(Opened::new(FileKind::Law, stem))
        } else if let Some(format) = model {
            self.show_model(format, stem, bytes)
        } else if let Some(format) = drawing.or_else(|| DrawingFormat::sniff(bytes)) {
            let (drawing, opened) = pick(bytes, format, stem, row)?;
            let document = Document::from_drawing(&drawing);
            if document.plants().iter().all(|p| p.strokes().is_empty()) {
                return Err(WorkspaceError::NoUsableStroke);
            }
            self.replace(document, fresh)?;
            Ok(opened)
        } else {
            Err(Foreign::sniff(bytes).map_or(WorkspaceError::UnknownFile, WorkspaceError::Foreign))
        }
    }

    /// Checks what the document leaves to the sender of a command: that measurements make a leaf, and that the balls
    /// that are moved are its own.
    pub(crate) fn check(&self, command: &document::Command) -> Result<(), WorkspaceError> {
        match command {
            document::Command::Leaf(_, document::LeafCommand::SetData(data)) => check_marks(data),
            document::Command::Leaf(id, document::LeafCommand::Set(settings))
                if !settings.balls.is_empty() =>
            {
                let plant = self.editor.document().plant(*id).map(DocumentPlant::settings);
                if let Some(Maker::Leaf(leaf)) = plant.map(|s| &s.maker) {
                    leaf_balls(&LeafMaker { settings: (**settings).clone(), ..(**leaf).clone() })?;
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Opens measurements of a leaf: they go to the chosen leaf if it has none, else to a new plant.
    fn open_leaf(&mut self, stem: &str, file_name: &str, bytes: &[u8]) -> Result<Opened, WorkspaceError> {
        let data = LeafData { name: file_name.into(), text: core::str::from_utf8(bytes)?.into() };
        check_marks(&data)?;
        let waiting = self
            .current_plant()
            .filter(|p| matches!(&p.settings().maker, Maker::Leaf(l) if l.data.text.is_empty()));
        match waiting.map(DocumentPlant::id) {
            Some(id) => self.editor.run(document::LeafCommand::SetData(data).for_plant(id))?,
            None => {
                self.add_plant(stem, Maker::Leaf(Box::new(LeafMaker { data, ..LeafMaker::default() })))?
            }
        }
        self.guest = None;
        Ok(Opened::new(FileKind::Leaf, stem))
    }

    /// Replaces the document: one step of undo, or `fresh`, without a history.
    pub(crate) fn replace(&mut self, document: Document, fresh: bool) -> Result<(), WorkspaceError> {
        self.editor.cancel_gesture();
        if fresh {
            self.editor = Editor::new(document);
        } else {
            self.editor.run(SceneCommand::Open(Box::new(document)))?;
        }
        self.current = self.editor.document().plants().first().map(DocumentPlant::id);
        self.draft = None;
        self.guest = None;
        Ok(())
    }

    fn show_model(
        &mut self,
        format: ModelFormat,
        stem: &str,
        bytes: &[u8],
    ) -> Result<Opened, WorkspaceError> {
        let mut report = Report::default();
        let model = read_model(bytes, format, stem, &ExportSpec::default(), &no_files, &mut report)?;
        let warnings = report.warnings.iter().map(WarningView::from).collect();
        let opened = Opened { warnings, ..Opened::new(FileKind::Model, &model.name) };
        self.guest = Some(model);
        Ok(opened)
    }

    /// Adds a model file as an obstacle of the current tree.
    ///
    /// # Errors
    /// [`WorkspaceError`]: the fault of the file, or that no tree is chosen.
    pub fn add_obstacle(&mut self, file_name: &str, bytes: &[u8]) -> Result<(), WorkspaceError> {
        let (stem, extension) = file_name.rsplit_once('.').unwrap_or((file_name, ""));
        let format = ModelFormat::from_extension(extension).or_else(|| ModelFormat::sniff(bytes));
        let unknown =
            || Foreign::sniff_no_drawing(bytes).map_or(WorkspaceError::ObstacleFile, WorkspaceError::Foreign);
        let format = format.ok_or_else(unknown)?;
        let model =
            read_model(bytes, format, stem, &ExportSpec::default(), &no_files, &mut Report::default());
        let (vertices, triangles) = model?.triangles();
        if triangles.is_empty() {
            return Err(WorkspaceError::NoSurface);
        }
        let shape = Arc::new(Obstacle::Mesh { vertices, triangles });
        let new = document::NamedObstacle { name: stem.into(), shape };
        Ok(self.editor.run(TreeCommand::AddObstacle(new).for_plant(self.must()?))?)
    }

    /// Returns a small project for a link: rounded, without times and photographs.
    ///
    /// # Errors
    /// [`WorkspaceError::Project`], only by a bug of ours.
    pub fn share(&self) -> Result<Vec<u8>, WorkspaceError> {
        Ok(document::write_project(&self.editor.document().compact(), burgeon::VERSION)?)
    }

    /// Returns the document as a `.burgeon` file.
    ///
    /// # Errors
    /// [`WorkspaceError::Project`], only by a bug of ours.
    pub fn save(&self) -> Result<Vec<u8>, WorkspaceError> {
        Ok(document::write_project(self.editor.document(), burgeon::VERSION)?)
    }
}

/// Checks that measurements make a leaf.
fn check_marks(data: &LeafData) -> Result<(), WorkspaceError> {
    let (marks, _) = leaf_marks(data, &LeafSpec::default())?;
    marks.complete(&mut Report::default()).map_err(|e| SceneError::from(LeafError::from(e)))?;
    Ok(())
}

/// Returns the drawing of this row among the readable ones, and the names of all.
fn pick(
    bytes: &[u8],
    format: DrawingFormat,
    stem: &str,
    row: usize,
) -> Result<(Drawing, Opened), WorkspaceError> {
    let mut opened = Opened::new(FileKind::Drawing, "");
    let mut picked = None;
    let mut failed = None;
    for read in read_drawings(bytes, format, stem).take(OFFERED) {
        match read {
            Ok(read) => {
                if opened.names.len() == row {
                    opened.name.clone_from(&read.drawing.name);
                    opened.warnings = read.warnings.iter().map(WarningView::from).collect();
                    picked = Some(read.drawing.clone());
                }
                opened.names.push(read.drawing.name);
            }
            Err(e) => failed = failed.or(Some(e)),
        }
    }
    match (picked, failed) {
        (Some(drawing), _) => Ok((drawing, opened)),
        (None, Some(e)) => Err(e.into()),
        (None, None) => Err(WorkspaceError::NoDrawing),
    }
}
