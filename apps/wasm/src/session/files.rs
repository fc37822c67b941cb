//! Files in and out of the session.

use std::sync::Arc;

use burgeon::document::{
    self, Document, DocumentPlant, Editor, LeafData, LeafMaker, Maker, SceneCommand, TreeCommand,
};
use burgeon::formats::{self, DrawingFormat, ExportSpec, ModelFormat, no_files, read_drawings, read_model};
use burgeon::glam::DVec3;
use burgeon::growth::Obstacle;
use burgeon::ink::Drawing;
use burgeon::{CancelToken, Report, Run, leaf_marks, read_tree_spec, tree_settings};

use super::{Session, Told, words};
use crate::exports;
use crate::host::{Attentive, BUDGET, Host};
use crate::wire::{Opened, WireCommand};

/// Drawings of a file that are offered for choice.
const OFFERED: usize = 1000;

impl Session {
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
        let run = Run { cancel: &cancel, executor: &Attentive(&cancel), clock: &Host, budget: BUDGET };
        exports::export(&mut self.scene, self.editor.document(), only, format, &options, &run)
    }
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
