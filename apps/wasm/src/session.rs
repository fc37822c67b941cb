//! The Studio's session without its JavaScript face: it runs and is tested natively.

use std::collections::BTreeMap;
use std::sync::Arc;

use burgeon::document::{self, Command, Document, Editor, NewStroke, Photo, StrokeId};
use burgeon::formats::{
    self, DrawingFormat, ExportSpec, ModelFormat, no_files, obj_files, read_drawings, read_model,
};
use burgeon::glam::DVec2;
use burgeon::mesh::{AlphaMode, Model, Texture};
use burgeon::plant::{OrganKind, Shape};
use burgeon::sketch::{Drawing, InkSample, Stroke, StrokeMode};
use burgeon::{CancelToken, Evaluator, ItemReport, MakeError, Report, Run, Seed, SketchOptions};

use crate::host::{Attentive, Host};
use crate::wire::{
    DocumentState, ExportOptions, Front, MaterialView, Opened, PartView, PhotoState, Skin, StrokeState,
    TextureView, View, WireCommand,
};

/// Share of the triangles while a stroke is drawn.
const PREVIEW_DETAIL: f64 = 0.4;
/// Drawings of a file that are offered for choice.
const OFFERED: usize = 1000;

/// One document, its history, its plant, and what the page was given already.
#[derive(Debug, Default)]
pub(crate) struct Session {
    editor: Editor,
    evaluator: Evaluator,
    draft: Option<Stroke>,
    /// The plant while a stroke is drawn.
    preview: Option<Evaluator>,
    previewed: bool,
    /// A model file that is looked at instead of the plant.
    guest: Option<Model>,
    /// Another plant of the same drawing, looked at for a moment.
    variant: Option<Model>,
    /// The document has no usable stroke: nothing is shown.
    bare: bool,
    /// Points that the page has. Holding them keeps their addresses from being used again.
    given: BTreeMap<u32, Arc<Stroke>>,
    textures: Vec<Arc<Texture>>,
    /// The photograph that the page has.
    given_photo: Option<Arc<[u8]>>,
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

    /// Starts empty and forgets the history: the memory of the document is given back.
    pub(crate) fn close(&mut self) {
        *self = Self::default();
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
        let command = self.parse(command)?;
        self.editor.run(command).map_err(words)?;
        self.guest = None;
        Ok(())
    }

    pub(crate) fn begin(&mut self, name: &str) -> Told {
        self.editor.begin_gesture(name).map_err(words)
    }

    pub(crate) fn stage(&mut self, command: &str) -> Told {
        let command = self.parse(command)?;
        self.editor.stage(command).map_err(words)
    }

    pub(crate) fn commit(&mut self) {
        self.editor.commit();
    }

    pub(crate) fn abandon(&mut self) {
        self.editor.cancel_gesture();
    }

    fn parse(&self, command: &str) -> Told<Command> {
        let photo = self.editor.document().settings().photo.as_ref();
        serde_json::from_str::<WireCommand>(command).map_err(words)?.command(photo)
    }

    /// Strokes as a drawing in our JSON, for the clipboard.
    pub(crate) fn copy(&self, ids: &[u32]) -> Told<String> {
        let document = self.editor.document();
        let chosen = document.strokes().iter().filter(|s| ids.contains(&s.id.0));
        let strokes: Vec<Stroke> = chosen.map(|s| Stroke::clone(&s.stroke)).collect();
        if strokes.is_empty() {
            return Err("no stroke is selected".into());
        }
        let mut out = Vec::new();
        let drawing = Drawing { name: document.settings().name.clone(), strokes };
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
        let before = self.editor.document().strokes().len();
        let new = strokes.into_iter().map(|stroke| NewStroke { stroke, class: None }).collect();
        self.editor.run(Command::AddStrokes(new)).map_err(words)?;
        self.guest = None;
        Ok(self.editor.document().strokes().iter().skip(before).map(|s| s.id.0).collect())
    }

    /// Puts a photograph under the drawing.
    pub(crate) fn place_photo(&mut self, png: &[u8], x: f64, y: f64, width: f64) -> Told {
        let mut photo = Photo::new(png.into()).map_err(words)?;
        (photo.x, photo.y, photo.width) = (x, y, width);
        self.editor.run(Command::SetPhoto(Some(Box::new(photo)))).map_err(words)
    }

    /// The photograph's file if the page has another one; empty if it has this one or there is none.
    pub(crate) fn fresh_photo(&mut self) -> Vec<u8> {
        let photo = self.editor.document().settings().photo.as_ref().map(|p| Arc::clone(p.png()));
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
            photo: settings.photo.as_ref().map(PhotoState::of),
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
        let mut options = SketchOptions::of_document(document);
        // Fast while the pen is down, fine when it is lifted.
        self.previewed = self.draft.is_some();
        let evaluator = if self.previewed {
            options.skin.detail = (options.skin.detail * PREVIEW_DETAIL).max(0.1);
            self.preview.get_or_insert_with(Evaluator::previewing)
        } else {
            &mut self.evaluator
        };
        let mut item = None;
        if self.guest.is_none() {
            match evaluator.update(&drawing, &options, document.settings().seed, &run) {
                Ok(made) => (item, self.bare) = (Some(made), false),
                Err(MakeError::NoStrokes { .. }) => self.bare = true,
                Err(e) => return Err(words(e)),
            }
        }
        let view = self.view(item);
        serde_json::to_string(&view).map_err(words)
    }

    /// What made the plant that is shown.
    fn current(&self) -> &Evaluator {
        self.preview.as_ref().filter(|_| self.previewed).unwrap_or(&self.evaluator)
    }

    fn view(&mut self, item: Option<ItemReport>) -> View {
        let mut textures = std::mem::take(&mut self.textures);
        let front = self.current().front().filter(|_| item.is_some());
        let mut view = View {
            revision: self.editor.revision(),
            item,
            stages: self.current().stages_done().to_vec(),
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
        let looked_at = self.variant.as_ref().or(self.guest.as_ref());
        looked_at.or_else(|| self.current().model().filter(|_| !self.bare))
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

    /// Makes the plant of another seed for a look, with fewer triangles; [`Session::end_variant`] goes back.
    pub(crate) fn variant(&mut self, seed: &str, detail: f64) -> Told<String> {
        let seed = Seed::new(seed.parse().ok().ok_or("the seed is a whole number")?);
        let document = self.editor.document();
        let mut options = SketchOptions::of_document(document);
        options.skin.seed = seed;
        options.skin.detail = (options.skin.detail * detail).clamp(0.1, 8.0);
        let mut aside = self.evaluator.clone();
        let cancel = CancelToken::new();
        let run = Run { cancel: &cancel, executor: &Attentive(&cancel), clock: &Host };
        aside.update(&document.drawing(), &options, seed, &run).map_err(words)?;
        self.variant = aside.model().cloned();
        serde_json::to_string(&self.view(None)).map_err(words)
    }

    pub(crate) fn end_variant(&mut self) {
        self.variant = None;
    }

    /// Pairs of points of the plant's axes: x, y, z and order of each; then of its blades, from root to tip, with
    /// "order" 100 (leaves) or 101 (petals). Empty while a model file is looked at.
    pub(crate) fn skeleton(&self) -> Vec<f32> {
        let plant = self.current().plant().filter(|_| self.guest.is_none() && !self.bare);
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
        let options: ExportOptions = serde_json::from_str(options).map_err(words)?;
        let spec = options.spec()?;
        if format == "json" {
            let mut out = Vec::new();
            formats::write_drawing(&self.editor.document().drawing(), &mut out).map_err(words)?;
            return Ok(out);
        }
        if self.guest.is_none() {
            self.draft = None;
            self.evaluate()?;
        }
        let format = ModelFormat::from_extension(format)
            .ok_or_else(|| format!("models are not written as {format:?}"))?;
        let model = self.model().ok_or("there is no plant yet: draw at least one line")?;
        if options.levels <= 1 || self.guest.is_some() {
            let mut files = written(model, format, "plant", &spec)?;
            // One file is given as it is, an OBJ with its materials as a zip.
            return match files.len() {
                1 => Ok(files.swap_remove(0).1),
                _ => document::pack(&files).map_err(words),
            };
        }
        let mut files = written(model, format, "plant_LOD0", &spec)?;
        let document = self.editor.document();
        let (drawing, seed) = (document.drawing(), document.settings().seed);
        let mut asked = SketchOptions::of_document(document);
        let mut aside = self.evaluator.clone();
        let cancel = CancelToken::new();
        let run = Run { cancel: &cancel, executor: &Attentive(&cancel), clock: &Host };
        for level in 1..options.levels.min(4) {
            asked.skin.detail = (asked.skin.detail / 3.0).max(0.1);
            asked.skin.sides = (asked.skin.sides / 2).max(3);
            aside.update(&drawing, &asked, seed, &run).map_err(words)?;
            let model = aside.model().ok_or("internal: no model")?;
            files.extend(written(model, format, &format!("plant_LOD{level}"), &spec)?);
        }
        document::pack(&files).map_err(words)
    }
}

/// The files of a model.
fn written(
    model: &Model,
    format: ModelFormat,
    stem: &str,
    spec: &ExportSpec,
) -> Told<Vec<(String, Vec<u8>)>> {
    if format == ModelFormat::Obj {
        let files = obj_files(model, stem, spec).map_err(words)?;
        let mut all = vec![(format!("{stem}.obj"), files.obj), (format!("{stem}.mtl"), files.mtl)];
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
            let file = s.export(format, "{}").unwrap();
            let mut other = Session::default();
            let opened = json(&other.open(&format!("plant.{format}"), &file, 0, false).unwrap());
            assert_eq!(opened["kind"], "model");
            let view = json(&other.evaluate().unwrap());
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
        let before = s.evaluate().unwrap();
        s.draft("leaf-contour", &line(&[(0.0, 0.0), (40.0, 0.0), (40.0, 40.0)])).unwrap();
        assert_eq!(json(&s.evaluate().unwrap())["item"]["strokes"].as_array().unwrap().len(), 2);
        s.draft("parts", &[]).unwrap();
        let after = s.evaluate().unwrap();
        assert_eq!(json(&before)["item"]["digest"], json(&after)["item"]["digest"]);
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
        let plain = json(&s.evaluate().unwrap());
        let points = s.stroke_points(0);
        let (x, y) = (points[0], points[1]);
        assert!(s.place_photo(b"GIF", x, y, 1.0).is_err());
        s.place_photo(&photo(), -1e4, -1e4, 2e4).unwrap();
        assert_eq!((s.fresh_photo(), s.fresh_photo()), (photo(), Vec::new()));
        let traced = json(&s.evaluate().unwrap());
        assert_eq!(traced["item"]["digest"], plain["item"]["digest"], "the plant is the same");
        assert_eq!(traced["stages"].as_array().unwrap().len(), 1, "only the surface is made again");
        let names = |v: &Value| -> Vec<String> {
            v["parts"].as_array().unwrap().iter().map(|p| p["name"].as_str().unwrap().to_owned()).collect()
        };
        assert!(names(&traced).contains(&"petals-traced".to_owned()), "{:?}", names(&traced));
        let part = names(&traced).iter().position(|n| n == "petals-traced").unwrap();
        let uvs = s.column(part, Column::Uvs);
        assert_eq!(uvs.len() / 2, s.column(part, Column::Positions).len() / 3);
        assert!(uvs.iter().all(|x| (0.0..=1.0).contains(x)));
        // A small photograph far away traces nothing; one that does not paint neither.
        s.run(r#"{"do":"photo","x":-9000,"y":-9000,"width":1,"opacity":0.5,"paint":true}"#).unwrap();
        assert_eq!(names(&json(&s.evaluate().unwrap())), names(&plain));
        s.run(r#"{"do":"photo","x":-1e4,"y":-1e4,"width":2e4,"opacity":0.2,"paint":false}"#).unwrap();
        assert_eq!(names(&json(&s.evaluate().unwrap())), names(&plain));
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
        let plant = json(&s.evaluate().unwrap());
        let text = s.copy(&[0, 1]).unwrap();
        assert!(s.copy(&[99]).is_err() && s.paste("no drawing", 0.0, 0.0).is_err());
        assert_eq!(s.paste(&text, 5.0, 0.0).unwrap(), [15, 16]);
        assert_eq!(s.stroke_points(15)[0], s.stroke_points(0)[0] + 5.0);
        s.run(r#"{"do":"duplicate","ids":[0],"x":0,"y":1}"#).unwrap();
        assert_eq!((s.undo().as_deref(), s.undo().as_deref()), (Some("duplicate"), Some("draw")));

        let other = json(&s.variant("77", 0.4).unwrap());
        let positions = s.column(0, Column::Positions);
        s.end_variant();
        assert!(other["item"].is_null() && !positions.is_empty());
        let again = json(&s.evaluate().unwrap());
        assert_eq!(
            again["item"]["digest"], plant["item"]["digest"],
            "a look at another seed changes nothing"
        );
        assert!(s.column(0, Column::Positions).len() > positions.len());
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
        let shared = json(&linked.evaluate().unwrap());
        assert_eq!(shared["item"]["counts"]["flowers"], plant["item"]["counts"]["flowers"]);
    }
}
