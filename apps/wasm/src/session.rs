//! The Studio's session without its JavaScript face: it runs and is tested natively.

use std::collections::BTreeMap;
use std::sync::Arc;

use burgeon::document::{self, Command, Document, Editor, NewStroke, StrokeId};
use burgeon::formats::{
    self, DrawingFormat, ExportSpec, ModelFormat, no_files, obj_files, read_drawings, read_model,
};
use burgeon::glam::DVec2;
use burgeon::mesh::{AlphaMode, Model, Texture};
use burgeon::sketch::{Drawing, InkSample, Stroke, StrokeMode};
use burgeon::{CancelToken, Evaluator, ItemReport, MakeError, Report, Run, SketchOptions};

use crate::host::{Attentive, Host};
use crate::wire::{
    DocumentState, Front, MaterialView, Opened, PartView, Skin, StrokeState, TextureView, View, WireCommand,
};

/// Drawings of a file that are offered for choice.
const OFFERED: usize = 1000;

/// One document, its history, its plant, and what the page was given already.
#[derive(Debug, Default)]
pub(crate) struct Session {
    editor: Editor,
    evaluator: Evaluator,
    draft: Option<Stroke>,
    /// A model file that is looked at instead of the plant.
    guest: Option<Model>,
    /// The document has no usable stroke: nothing is shown.
    bare: bool,
    /// Points that the page has. Holding them keeps their addresses from being used again.
    given: BTreeMap<u32, Arc<Stroke>>,
    textures: Vec<Arc<Texture>>,
}

/// A column of vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Column {
    Positions,
    Normals,
    Uvs,
    Colors,
}

type Told<T = ()> = Result<T, String>;

fn words(e: impl ToString) -> String {
    e.to_string()
}

impl Session {
    pub(crate) fn open(&mut self, file_name: &str, bytes: &[u8], row: u32, fresh: bool) -> Told<String> {
        let (stem, extension) = file_name.rsplit_once('.').unwrap_or((file_name, ""));
        let is_project = extension.eq_ignore_ascii_case("burgeon") || document::is_project(bytes);
        let drawing = DrawingFormat::from_extension(extension);
        let model = ModelFormat::from_extension(extension);
        let model = model.or_else(|| ModelFormat::sniff(bytes)).filter(|_| drawing.is_none());
        let opened = if is_project {
            let document = document::read_project(bytes).map_err(words)?;
            let name = document.settings().name.clone();
            self.place(document, fresh)?;
            Opened { kind: "project", name, ..Opened::default() }
        } else if let Some(format) = model {
            self.look_at(format, stem, bytes)?
        } else if let Some(format) = drawing.or_else(|| DrawingFormat::sniff(bytes)) {
            let (drawing, opened) = pick(bytes, format, stem, row)?;
            let document = Document::from_drawing(&drawing);
            if document.strokes().is_empty() {
                return Err("there is no stroke in it that can be used".into());
            }
            self.place(document, fresh)?;
            opened
        } else {
            return Err(
                "this is no file that Burgeon reads: give a project (.burgeon), a drawing (.svg, .inkml, \
                        .ndjson, .json) or a model (.glb, .gltf, .obj, .ply, .stl)"
                    .into(),
            );
        };
        serde_json::to_string(&opened).map_err(words)
    }

    fn place(&mut self, document: Document, fresh: bool) -> Told {
        self.editor.cancel_gesture();
        if fresh {
            self.editor = Editor::new(document);
        } else {
            self.editor.run(Command::Open(Box::new(document))).map_err(words)?;
        }
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

    pub(crate) fn add_stroke(&mut self, mode: &str, samples: &[f64]) -> Told<u32> {
        let stroke = stroke(mode, samples)?;
        self.draft = None;
        self.guest = None;
        self.editor.run(Command::AddStrokes(vec![NewStroke { stroke, class: None }])).map_err(words)?;
        self.editor.document().strokes().last().map(|s| s.id.0).ok_or_else(|| "internal: no stroke".into())
    }

    pub(crate) fn draft(&mut self, mode: &str, samples: &[f64]) -> Told {
        self.draft = Some(stroke(mode, samples)?).filter(|s| !s.samples.is_empty());
        if self.draft.is_some() {
            self.guest = None;
        }
        Ok(())
    }

    pub(crate) fn run(&mut self, command: &str) -> Told {
        let command = parse(command)?;
        self.editor.run(command).map_err(words)?;
        self.guest = None;
        Ok(())
    }

    pub(crate) fn begin(&mut self, name: &str) -> Told {
        self.editor.begin_gesture(name).map_err(words)
    }

    pub(crate) fn stage(&mut self, command: &str) -> Told {
        self.editor.stage(parse(command)?).map_err(words)
    }

    pub(crate) fn commit(&mut self) {
        self.editor.commit();
    }

    pub(crate) fn abandon(&mut self) {
        self.editor.cancel_gesture();
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
        let settings = document.settings();
        let strokes = document.strokes().iter().map(|s| StrokeState {
            id: s.id.0,
            mode: s.stroke.mode,
            class: s.class,
            color: s.stroke.color,
        });
        let state = DocumentState {
            revision: self.editor.revision(),
            undo: self.editor.done().last().map(|s| s.name.as_str()),
            redo: self.editor.undone().last().map(|s| s.name.as_str()),
            steps: self.editor.done().len(),
            name: &settings.name,
            seed: settings.seed.number().to_string(),
            sketch: &settings.sketch,
            skin: Skin::of(&settings.skin),
            strokes: strokes.collect(),
        };
        serde_json::to_string(&state).map_err(words)
    }

    pub(crate) fn fresh_strokes(&mut self) -> Vec<u32> {
        let mut fresh = Vec::new();
        let mut given = BTreeMap::new();
        for s in self.editor.document().strokes() {
            if !self.given.get(&s.id.0).is_some_and(|old| Arc::ptr_eq(old, &s.stroke)) {
                fresh.push(s.id.0);
            }
            given.insert(s.id.0, Arc::clone(&s.stroke));
        }
        self.given = given;
        fresh
    }

    pub(crate) fn stroke_points(&self, id: u32) -> Vec<f64> {
        let document = self.editor.document();
        let found = document.row(StrokeId(id)).and_then(|row| document.strokes().get(row));
        let samples = found.map_or(&[][..], |s| &s.stroke.samples);
        samples.iter().flat_map(|p| [p.at.x, p.at.y, p.pressure.unwrap_or(f64::NAN)]).collect()
    }

    pub(crate) fn evaluate(&mut self) -> Told<String> {
        let cancel = CancelToken::new();
        let executor = Attentive(&cancel);
        let run = Run { cancel: &cancel, executor: &executor, clock: &Host };
        let document = self.editor.document();
        let mut drawing = document.drawing();
        drawing.strokes.extend(self.draft.clone());
        let options = SketchOptions::of_document(document);
        let mut item = None;
        if self.guest.is_none() {
            match self.evaluator.update(&drawing, &options, document.settings().seed, &run) {
                Ok(made) => (item, self.bare) = (Some(made), false),
                Err(MakeError::NoStrokes { .. }) => self.bare = true,
                Err(e) => return Err(words(e)),
            }
        }
        let view = self.view(item);
        serde_json::to_string(&view).map_err(words)
    }

    fn view(&mut self, item: Option<ItemReport>) -> View {
        let mut textures = std::mem::take(&mut self.textures);
        let front = self.evaluator.front().filter(|_| item.is_some());
        let mut view = View {
            revision: self.editor.revision(),
            item,
            stages: self.evaluator.stages_done().to_vec(),
            front: front.map(|f| Front { metres_per_unit: f.metres_per_unit, x: f.origin.x, y: f.origin.y }),
            min: [0.0; 3],
            max: [0.0; 3],
            parts: Vec::new(),
            materials: Vec::new(),
        };
        if let Some(model) = self.model() {
            let bounds = model.bounds();
            if !bounds.is_empty() {
                (view.min, view.max) = (bounds.min.to_array(), bounds.max.to_array());
            }
            let parts = model.parts.iter();
            let parts = parts.map(|p| PartView { name: p.name.clone(), material: p.material.index() });
            view.parts = parts.collect();
            view.materials = model
                .materials
                .iter()
                .map(|m| MaterialView {
                    name: m.name.clone(),
                    kind: m.kind.word(),
                    color: m.base_color,
                    roughness: m.roughness,
                    translucency: m.translucency,
                    masked: m.alpha == AlphaMode::Mask,
                    two_sided: m.double_sided,
                    texture: m.texture.as_ref().map(|t| TextureView {
                        number: number_of(&mut textures, t),
                        width: t.width,
                        height: t.height,
                    }),
                })
                .collect();
        }
        self.textures = textures;
        view
    }

    /// What is shown: the guest, else the plant.
    fn model(&self) -> Option<&Model> {
        self.guest.as_ref().or_else(|| self.evaluator.model().filter(|_| !self.bare))
    }

    pub(crate) fn column(&self, part: usize, column: Column) -> Vec<f32> {
        let Some(part) = self.model().and_then(|m| m.parts.get(part)) else { return Vec::new() };
        let mesh = &part.mesh;
        match column {
            Column::Positions => mesh.positions.as_flattened().to_vec(),
            Column::Normals => mesh.normals.as_flattened().to_vec(),
            Column::Uvs => mesh.uvs.as_flattened().to_vec(),
            Column::Colors => mesh.colors.as_flattened().to_vec(),
        }
    }

    pub(crate) fn indices(&self, part: usize) -> Vec<u32> {
        let part = self.model().and_then(|m| m.parts.get(part));
        part.map_or_else(Vec::new, |p| p.mesh.triangles.as_flattened().to_vec())
    }

    pub(crate) fn texture(&self, number: usize) -> Vec<u8> {
        self.textures.get(number).map_or_else(Vec::new, |t| t.pixels.clone())
    }

    pub(crate) fn save(&self) -> Told<Vec<u8>> {
        document::write_project(self.editor.document(), burgeon::VERSION).map_err(words)
    }

    pub(crate) fn export(&mut self, format: &str) -> Told<Vec<u8>> {
        let mut out = Vec::new();
        if format == "json" {
            formats::write_drawing(&self.editor.document().drawing(), &mut out).map_err(words)?;
            return Ok(out);
        }
        if self.guest.is_none() {
            self.draft = None;
            self.evaluate()?;
        }
        let model = self.model().ok_or("there is no plant yet: draw at least one line")?;
        let spec = ExportSpec::default();
        match ModelFormat::from_extension(format) {
            Some(ModelFormat::Obj) => {
                let files = obj_files(model, "plant", &spec).map_err(words)?;
                let mut all = vec![("plant.obj".into(), files.obj), ("plant.mtl".into(), files.mtl)];
                all.extend(files.textures);
                out = document::pack(&all).map_err(words)?;
            }
            Some(format) => {
                formats::write_model(model, format, &spec, &mut out, &mut Report::default()).map_err(words)?
            }
            None => return Err(format!("models are not written as {format:?}")),
        }
        Ok(out)
    }
}

fn number_of(textures: &mut Vec<Arc<Texture>>, texture: &Arc<Texture>) -> usize {
    let same = |t: &Arc<Texture>| Arc::ptr_eq(t, texture) || t == texture;
    textures.iter().position(same).unwrap_or_else(|| {
        textures.push(Arc::clone(texture));
        textures.len() - 1
    })
}

fn parse(command: &str) -> Told<Command> {
    serde_json::from_str::<WireCommand>(command).map_err(words)?.command()
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

    fn sample() -> Vec<u8> {
        std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/sketches/sample.svg")).unwrap()
    }

    #[test]
    fn a_stroke_becomes_a_plant_and_undo_takes_it_back() {
        let mut s = Session::default();
        assert_eq!(json(&s.evaluate().unwrap())["item"], Value::Null);
        let id = s.add_stroke("parts", &stem()).unwrap();
        assert_eq!(s.fresh_strokes(), [id]);
        assert_eq!(s.fresh_strokes(), [0; 0]);
        assert_eq!(s.stroke_points(id).len(), 120);
        let view = json(&s.evaluate().unwrap());
        assert_eq!(view["item"]["counts"]["branches"], 1);
        assert!(view["item"]["strokes"][0]["organ"].is_string());
        assert!(s.column(0, Column::Positions).len() > 300 && s.indices(0).len() > 300);
        let texture = &view["materials"][0]["texture"];
        assert_eq!(
            s.texture(0).len() as u64,
            4 * texture["width"].as_u64().unwrap() * texture["height"].as_u64().unwrap()
        );
        assert_eq!(s.undo().as_deref(), Some("draw"));
        let view = json(&s.evaluate().unwrap());
        assert_eq!((&view["item"], view["parts"].as_array().unwrap().len()), (&Value::Null, 0));
        assert_eq!(s.redo().as_deref(), Some("draw"));
        assert_eq!(json(&s.evaluate().unwrap())["item"]["counts"]["branches"], 1);
    }

    #[test]
    fn the_project_is_the_same_plant_elsewhere() {
        let mut s = Session::default();
        s.open("sample.svg", &sample(), 0, false).unwrap();
        s.run(r#"{"do":"seed","seed":"18446744073709551615"}"#).unwrap();
        s.run(r#"{"do":"class","ids":[0],"class":"axis"}"#).unwrap();
        let here = json(&s.evaluate().unwrap());
        let mut other = Session::default();
        let opened = json(&other.open("x.burgeon", &s.save().unwrap(), 0, true).unwrap());
        assert_eq!(opened["kind"], "project");
        let there = json(&other.evaluate().unwrap());
        assert_eq!(here["item"]["digest"], there["item"]["digest"]);
        assert_eq!(json(&other.state().unwrap())["seed"], "18446744073709551615");
        assert_eq!(other.undo(), None, "opened fresh");
        let document = s.editor.document();
        let made = burgeon::make_from_sketch(
            &document.drawing(),
            &SketchOptions::of_document(document),
            document.settings().seed,
            &Run::plain(),
        );
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
            let file = s.export(format).unwrap();
            let mut other = Session::default();
            let opened = json(&other.open(&format!("plant.{format}"), &file, 0, false).unwrap());
            assert_eq!(opened["kind"], "model");
            let view = json(&other.evaluate().unwrap());
            assert!(!view["parts"].as_array().unwrap().is_empty() && view["max"][1].as_f64().unwrap() > 0.1);
            assert!(other.export("glb").unwrap().starts_with(b"glTF"));
        }
        assert!(s.export("obj").unwrap().starts_with(b"PK"));
        assert!(s.export("exe").is_err());
        let drawing = s.export("json").unwrap();
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
        let before = s.evaluate().unwrap();
        s.draft("leaf-contour", &line(&[(0.0, 0.0), (40.0, 0.0), (40.0, 40.0)])).unwrap();
        assert_eq!(json(&s.evaluate().unwrap())["item"]["strokes"].as_array().unwrap().len(), 2);
        s.draft("parts", &[]).unwrap();
        let after = s.evaluate().unwrap();
        assert_eq!(json(&before)["item"]["digest"], json(&after)["item"]["digest"]);
        assert!(s.draft("crayon", &[]).is_err() && s.run(r#"{"do":"explode"}"#).is_err());
    }
}
