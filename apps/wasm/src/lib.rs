//! Burgeon for the browser and Node: parses, converts, calls. No algorithms.
//!
//! | part | for |
//! |---|---|
//! | [`StudioSession`] | the Studio's worker: a [`workspace::Workspace`] |
//! | [`studio_schema`] | the panels of the page |
//! | `checks`, a feature | Node: drawings, leaves, flowers, trees and projects have the same bits as natively |

#[cfg(any(feature = "checks", test))]
mod checks;
mod host;

use burgeon::document::{NewStroke, PlantId, StrokeId};
use burgeon::glam::DVec2;
use burgeon::ink::{InkSample, Stroke, StrokeMode};
use burgeon::skin::OrganMaterial;
use burgeon::{Refusal, Seed, bloom};
use serde::Serialize;
use serde::de::DeserializeOwned;
use wasm_bindgen::prelude::*;
use workspace::{
    Column, EngineAsk, ExportRequest, LightAsk, PenStyle, SizeGoal, Workspace, WorkspaceError, packed,
};

#[cfg(any(feature = "checks", test))]
pub use crate::checks::*;
use crate::host::page_run;

/// Returns the options of trees, leaves and flowers, as JSON Schemas with meaning, unit (`x-unit`), range and
/// default; and the species of trees and flowers.
///
/// # Errors
/// Never, but for our own bugs.
#[wasm_bindgen]
pub fn studio_schema() -> Result<String, JsError> {
    let presets: Vec<_> = burgeon::PRESETS
        .iter()
        .filter(|p| p.same_as.is_none())
        .filter_map(|p| {
            let spec = p.spec().ok()?;
            let fields = burgeon::spec::to_json(&spec);
            Some(serde_json::json!({ "key": p.key, "species": spec.species, "about": spec.about, "spec": fields }))
        })
        .collect();
    let flowers = bloom::FlowerSpec::PRESETS.iter().filter_map(|key| {
        let spec = burgeon::spec::to_json(&bloom::preset(key)?);
        Some(serde_json::json!({ "key": key, "spec": spec }))
    });
    let flowers: Vec<_> = flowers.collect();
    let materials = burgeon::skin::MATERIALS.iter();
    let materials: Vec<_> =
        materials.map(|(key, m)| serde_json::json!({ "key": key, "material": m })).collect();
    Ok(serde_json::to_string(&serde_json::json!({
        "sketch": burgeon::sketch_schema(),
        "skin": burgeon::skin_schema(),
        "tree": burgeon::tree_schema(),
        "leaf": burgeon::leaf_schema(),
        "flower": burgeon::flower_schema(),
        "material": burgeon::material_schema(),
        "materials": materials,
        "trees": presets,
        "flowers": flowers,
    }))?)
}

/// Returns the settings of an export that a program wants: `EngineAsk` in, `EngineAnswer` out, both JSON.
///
/// # Errors
/// When the program is not given files of that format.
#[wasm_bindgen]
pub fn settle_export(ask: &str) -> Result<String, Refused> {
    to_json(&from_json::<EngineAsk>(ask)?.settle()?)
}

/// A `Refusal` as JSON, which the worker catches.
#[derive(Debug)]
pub struct Refused(String);

impl From<Refused> for JsValue {
    fn from(refused: Refused) -> Self {
        Self::from_str(&refused.0)
    }
}

impl From<WorkspaceError> for Refused {
    fn from(error: WorkspaceError) -> Self {
        Self(Refusal::from_error(&error).into_json())
    }
}

impl From<serde_json::Error> for Refused {
    fn from(error: serde_json::Error) -> Self {
        WorkspaceError::Message(error.to_string()).into()
    }
}

fn to_json(value: &impl Serialize) -> Result<String, Refused> {
    Ok(serde_json::to_string(value)?)
}

fn from_json<T: DeserializeOwned>(text: &str) -> Result<T, Refused> {
    Ok(burgeon::spec::through_json::from_text(text)?)
}

/// Makes a stroke. `samples`: x, y (up), milliseconds, pressure of each point; NaN if unknown.
///
/// `pen`: `PenStyle` as JSON; empty for the pen of every sheet.
fn stroke(mode: &str, samples: &[f64], pen: &str) -> Result<NewStroke, Refused> {
    let pen = if pen.is_empty() { PenStyle::default() } else { from_json(pen)? };
    let PenStyle { color, width, layer, class } = pen;
    let mode: StrokeMode = from_json(&to_json(&mode)?)?;
    let layer = layer.map(Into::into);
    let stroke = Stroke { samples: ink(samples), mode, color, width, layer, ..Stroke::default() };
    Ok(NewStroke { class, ..NewStroke::from(stroke) })
}

/// x, y (up), milliseconds, pressure of each point; NaN where not known. Points that are nowhere are left out.
fn ink(samples: &[f64]) -> Vec<InkSample> {
    let known = |x: f64| x.is_finite().then_some(x);
    let samples = samples.chunks_exact(4).filter(|p| p[0].is_finite() && p[1].is_finite());
    let sample =
        |p: &[f64]| InkSample { at: DVec2::new(p[0], p[1]), time_ms: known(p[2]), pressure: known(p[3]) };
    samples.map(sample).collect()
}

fn numbers(ids: Vec<StrokeId>) -> Vec<u32> {
    ids.into_iter().map(|id| id.0).collect()
}

/// The document of the Studio with its history and its plants. Lives in a worker; nothing here waits for the page.
///
/// JSON in and out is typed for the page in `apps/studio-web/src/wire.ts`. After an error nothing has changed.
#[wasm_bindgen]
#[derive(Debug)]
pub struct StudioSession(Workspace);

#[wasm_bindgen]
impl StudioSession {
    /// Returns an empty document.
    #[wasm_bindgen(constructor)]
    #[expect(clippy::new_without_default, reason = "called from JavaScript only")]
    pub fn new() -> Self {
        host::tell_of_panics();
        let mut workspace = Workspace::default();
        workspace.measure_later(true);
        Self(workspace)
    }

    /// See [`Workspace::open`]: `Opened` as JSON.
    ///
    /// # Errors
    /// The fault of the file, and what to do.
    pub fn open(&mut self, file_name: &str, bytes: &[u8], row: u32, fresh: bool) -> Result<String, Refused> {
        to_json(&self.0.open(file_name, bytes, row as usize, fresh)?)
    }

    /// See [`Workspace::select`].
    ///
    /// # Errors
    /// When there is no such plant.
    pub fn select(&mut self, plant: u32) -> Result<(), Refused> {
        Ok(self.0.select(PlantId(plant))?)
    }

    /// See [`Workspace::add_obstacle`].
    ///
    /// # Errors
    /// The fault of the file, or that no tree is selected.
    pub fn add_obstacle(&mut self, file_name: &str, bytes: &[u8]) -> Result<(), Refused> {
        Ok(self.0.add_obstacle(file_name, bytes)?)
    }

    /// See [`Workspace::placed`].
    pub fn placed(&mut self) -> Option<f64> {
        self.0.placed()
    }

    /// See [`Workspace::place_next`].
    pub fn place_next(&mut self, x: f64) {
        self.0.place_next(x);
    }

    /// Returns the corners of an obstacle that is a mesh, three for each triangle.
    pub fn obstacle(&self, plant: u32, row: usize) -> Vec<f32> {
        self.0.obstacle(PlantId(plant), row)
    }

    /// Starts with an empty document and forgets everything, including the history.
    pub fn close(&mut self) {
        self.0.close();
    }

    /// Adds a stroke and returns its number. `samples`: x, y (up), milliseconds, pressure of each point; NaN if
    /// unknown; `pen`: a `PenStyle` as JSON, or empty; `shown`: pairs of a stroke and its class or null as JSON, see
    /// [`Workspace::add_stroke`].
    ///
    /// # Errors
    /// When no point is finite, the mode is unknown, or the layer is hidden or locked.
    pub fn add_stroke(
        &mut self,
        mode: &str,
        samples: &[f64],
        pen: &str,
        shown: &str,
    ) -> Result<u32, Refused> {
        Ok(self.0.add_stroke(stroke(mode, samples, pen)?, from_json(shown)?)?.0)
    }

    /// Gives a stroke other points: `samples` as of [`Self::add_stroke`]. A step of undo of its own.
    ///
    /// # Errors
    /// When the stroke is not there, or no point is finite.
    pub fn straighten(&mut self, stroke: u32, samples: &[f64]) -> Result<(), Refused> {
        Ok(self.0.straighten(StrokeId(stroke), ink(samples))?)
    }

    /// Shows a stroke that is still being drawn; an empty one takes it away.
    ///
    /// # Errors
    /// When the mode is unknown.
    pub fn draft(&mut self, mode: &str, samples: &[f64], pen: &str) -> Result<(), Refused> {
        self.0.draft(stroke(mode, samples, pen)?);
        Ok(())
    }

    /// Applies a `Command` (JSON).
    ///
    /// # Errors
    /// Why it was refused.
    pub fn run(&mut self, command: &str) -> Result<(), Refused> {
        Ok(self.0.run(from_json::<burgeon::document::Command>(command)?)?)
    }

    /// Applies an `Action` (JSON).
    ///
    /// # Errors
    /// Why it was refused.
    pub fn act(&mut self, action: &str) -> Result<(), Refused> {
        Ok(self.0.act(&from_json(action)?)?)
    }

    /// Returns strokes as a drawing in our JSON.
    ///
    /// # Errors
    /// When there is none of them.
    pub fn copy(&self, ids: &[u32]) -> Result<String, Refused> {
        let ids: Vec<StrokeId> = ids.iter().copied().map(StrokeId).collect();
        Ok(String::from_utf8_lossy(&self.0.copy(&ids)?).into_owned())
    }

    /// Adds the strokes of a drawing given as text (our JSON, SVG, InkML), moved; returns their numbers.
    ///
    /// # Errors
    /// The fault of the drawing.
    pub fn paste(&mut self, text: &str, x: f64, y: f64) -> Result<Vec<u32>, Refused> {
        Ok(numbers(self.0.paste(text, DVec2::new(x, y))?))
    }

    /// Puts a photograph (PNG) under the drawing: left lower corner and width in the drawing's unit.
    ///
    /// # Errors
    /// When it is no PNG or too large.
    pub fn place_photo(&mut self, png: &[u8], x: f64, y: f64, width: f64) -> Result<(), Refused> {
        Ok(self.0.place_photo(png, DVec2::new(x, y), width)?)
    }

    /// See [`Workspace::wear_picture`]: `Wearer` and `OrganMaterial` as JSON, and a PNG.
    ///
    /// # Errors
    /// When it is no PNG or too large.
    pub fn wear_picture(
        &mut self,
        wearer: &str,
        strokes: &[u32],
        material: &str,
        png: &[u8],
    ) -> Result<(), Refused> {
        let strokes = strokes.iter().copied().map(StrokeId).collect();
        Ok(self.0.wear_picture((from_json(wearer)?, strokes), from_json(material)?, png)?)
    }

    /// Returns the RGBA bytes of a petal in a material (`OrganMaterial` as JSON).
    ///
    /// # Errors
    /// When the material cannot be read.
    pub fn swatch(&self, material: &str, width: u32, height: u32) -> Result<Vec<u8>, Refused> {
        let material: OrganMaterial = from_json(material)?;
        Ok(burgeon::skin::swatch(&material, width.min(512), height.min(512), &burgeon::Serial).pixels)
    }

    /// Returns the photograph's file if the page has another one, else nothing.
    pub fn fresh_photo(&mut self) -> Vec<u8> {
        self.0.fresh_photo().map_or_else(Vec::new, |png| png.to_vec())
    }

    /// Shows the plant of another seed (`PlantView` as JSON; the columns follow its number) until `end_variant`.
    ///
    /// # Errors
    /// `cancelled`, or why there is none.
    pub fn variant(&mut self, seed: &str, detail: f64) -> Result<String, Refused> {
        let seed: Seed = Seed::new(
            seed.parse().map_err(|_digits| WorkspaceError::Message(format!("{seed:?} is no seed")))?,
        );
        to_json(&page_run(|run| self.0.variant(seed, detail, run))?)
    }

    /// Returns to the plant itself.
    pub fn end_variant(&mut self) {
        self.0.end_variant();
    }

    /// Returns pairs of points of the axes: x, y, z, order.
    pub fn skeleton(&self) -> Vec<f32> {
        self.0.skeleton()
    }

    /// See [`Workspace::set_most_triangles`]; 0: all.
    pub fn set_most_triangles(&mut self, most: u32) {
        self.0.set_most_triangles((most > 0).then_some(most.into()));
    }

    /// See [`Workspace::ready_levels`].
    pub fn ready_levels(&mut self, most: u32) {
        page_run(|run| self.0.ready_levels(most.into(), run));
    }

    /// See [`Workspace::shape`]: `ToolKind`, `ShapeReach` and `ShapeInput` in, `ShapeAnswer` out, all JSON.
    ///
    /// # Errors
    /// When there is no plant, or the words are unknown.
    pub fn shape(&mut self, tool: &str, reach: &str, input: &str) -> Result<String, Refused> {
        to_json(&self.0.shape(from_json(tool)?, from_json(reach)?, from_json(input)?)?)
    }

    /// Returns a picked branch and all that it bears: pairs of points, x, y, z and radius of each.
    pub fn branch(&self, axis: u32) -> Vec<f32> {
        self.0.branch(axis)
    }

    /// Returns the control balls of the chosen leaf: `LeafBalls` as JSON.
    ///
    /// # Errors
    /// When the chosen plant is not a leaf, or makes none.
    pub fn balls(&self) -> Result<String, Refused> {
        to_json(&self.0.balls()?)
    }

    /// Returns the triangles of the meshes that the tool holds: part, first, and the one after the last, of each
    /// range.
    pub fn held_rows(&self) -> Vec<u32> {
        self.0.held_rows().to_vec()
    }

    /// Returns a small `.burgeon` file for a link: rounded, without times and photograph.
    ///
    /// # Errors
    /// Never, but for our own bugs.
    pub fn share(&self) -> Result<Vec<u8>, Refused> {
        Ok(self.0.share()?)
    }

    /// Opens a gesture: everything staged up to `commit` is one step of this name.
    ///
    /// # Errors
    /// While another is open.
    pub fn begin(&mut self, name: &str) -> Result<(), Refused> {
        Ok(self.0.begin(name)?)
    }

    /// Replaces the effect of the open gesture by one `Command` (JSON).
    ///
    /// # Errors
    /// Why it was refused.
    pub fn stage(&mut self, command: &str) -> Result<(), Refused> {
        Ok(self.0.stage(from_json::<burgeon::document::Command>(command)?)?)
    }

    /// Closes the gesture.
    pub fn commit(&mut self) {
        self.0.commit();
    }

    /// Closes the gesture and undoes its effect.
    pub fn abandon(&mut self) {
        self.0.abandon();
    }

    /// Undoes the last step and returns its name.
    pub fn undo(&mut self) -> Option<String> {
        self.0.undo().map(str::to_owned)
    }

    /// Redoes the last undone step and returns its name.
    pub fn redo(&mut self) -> Option<String> {
        self.0.redo().map(str::to_owned)
    }

    /// Returns the document as `DocumentState` (JSON), without points.
    ///
    /// # Errors
    /// Never, but for our own bugs.
    pub fn state(&self) -> Result<String, Refused> {
        to_json(&self.0.state())
    }

    /// Returns the numbers of strokes whose points the page does not have yet, and counts them as fetched.
    pub fn fresh_strokes(&mut self) -> Vec<u32> {
        numbers(self.0.fresh_strokes())
    }

    /// Returns x, y (up) and pressure (NaN if unknown) of each point of a stroke.
    pub fn stroke_points(&self, id: u32) -> Vec<f64> {
        let samples = self.0.stroke(StrokeId(id)).map_or(&[][..], |s| &s.samples);
        samples.iter().flat_map(|p| [p.at.x, p.at.y, p.pressure.unwrap_or(f64::NAN)]).collect()
    }

    /// Makes coarse previews of large trees that have to be grown: an array of `PlantView` as JSON. See
    /// [`Workspace::preview_trees`].
    ///
    /// # Errors
    /// `cancelled`.
    pub fn preview_trees(&mut self) -> Result<String, Refused> {
        to_json(&page_run(|run| self.0.preview_trees(run))?)
    }

    /// Brings the plants up to date: `SceneView` as JSON.
    ///
    /// # Errors
    /// `cancelled`.
    pub fn evaluate(&mut self) -> Result<String, Refused> {
        to_json(&page_run(|run| self.0.evaluate(run))?)
    }

    /// Completes the measures that the last evaluation postponed: `SceneView` as JSON, empty if nothing. See
    /// [`Workspace::measure`].
    ///
    /// # Errors
    /// `cancelled`.
    pub fn measure(&mut self) -> Result<String, Refused> {
        page_run(|run| self.0.measure(run))?.map_or_else(|| Ok(String::new()), |view| to_json(&view))
    }

    /// Returns three floats for each vertex, metres.
    pub fn positions(&self, plant: u32, part: usize) -> Vec<f32> {
        self.0.column(PlantId(plant), part, Column::Positions).to_vec()
    }

    /// Returns three floats for each vertex.
    pub fn normals(&self, plant: u32, part: usize) -> Vec<f32> {
        self.0.column(PlantId(plant), part, Column::Normals).to_vec()
    }

    /// Returns two floats for each vertex, v down; may be empty.
    pub fn uvs(&self, plant: u32, part: usize) -> Vec<f32> {
        self.0.column(PlantId(plant), part, Column::Uvs).to_vec()
    }

    /// Returns three floats for each vertex, linear; may be empty.
    pub fn colors(&self, plant: u32, part: usize) -> Vec<f32> {
        self.0.column(PlantId(plant), part, Column::Colors).to_vec()
    }

    /// Returns three indices for each triangle.
    pub fn indices(&self, plant: u32, part: usize) -> Vec<u32> {
        self.0.indices(PlantId(plant), part).to_vec()
    }

    /// Returns the RGBA bytes of a texture by its number in the last view.
    pub fn texture(&self, number: u32) -> Vec<u8> {
        self.0.texture(number).to_vec()
    }

    /// Returns the document as a `.burgeon` file.
    ///
    /// # Errors
    /// Never, but for our own bugs.
    pub fn save(&self) -> Result<Vec<u8>, Refused> {
        Ok(self.0.save()?)
    }

    /// Exports the visible plants as a file, or a zip of several: `ExportRequest` as JSON.
    ///
    /// # Errors
    /// When there is nothing to export.
    pub fn export(&mut self, request: &str) -> Result<Vec<u8>, Refused> {
        let request: ExportRequest = from_json(request)?;
        Ok(packed(request.format, page_run(|run| self.0.export(&request, run))?)?)
    }

    /// See [`Workspace::printed`]: `PrintFigures` as JSON, or null.
    ///
    /// # Errors
    /// Never, but for our own bugs.
    pub fn printed(&self) -> Result<String, Refused> {
        to_json(&self.0.printed())
    }

    /// See [`Workspace::size`]: numbers of plants and `SizeGoal` in, a list of `Command` out, all JSON.
    ///
    /// # Errors
    /// When a plant cannot have the size.
    pub fn size(&mut self, plants: &str, goal: &str) -> Result<String, Refused> {
        let (plants, goal): (Vec<PlantId>, SizeGoal) = (from_json(plants)?, from_json(goal)?);
        to_json(&page_run(|run| self.0.size(&plants, goal, run))?)
    }

    /// See [`Workspace::written`]: `WrittenFigures` as JSON, or null.
    ///
    /// # Errors
    /// Never, but for our own bugs.
    pub fn written(&self) -> Result<String, Refused> {
        to_json(&self.0.written())
    }

    /// See [`Workspace::preview_export`]: `ExportRequest` in, `ExportView` out, both JSON.
    ///
    /// # Errors
    /// When there is nothing to export.
    pub fn preview_export(&mut self, request: &str, level: u32) -> Result<String, Refused> {
        let request: ExportRequest = from_json(request)?;
        to_json(&page_run(|run| self.0.preview_export(&request, level, run))?)
    }

    /// See [`Workspace::light`]: `LightAsk` in, `LightView` out, both JSON.
    ///
    /// # Errors
    /// `cancelled`, or why there is no light.
    pub fn light(&mut self, asked: &str) -> Result<String, Refused> {
        let asked: LightAsk = from_json(asked)?;
        to_json(&page_run(|run| self.0.light(&asked, run))?)
    }

    /// Returns a column of the shown export or the plants in light: 0 positions, 1 normals, 2 texture coordinates, 3 colours, 4 wind, 5
    /// pivots.
    pub fn exported_column(&self, model: usize, part: usize, column: usize) -> Vec<f32> {
        use Column::{Colors, Normals, Pivots, Positions, Uvs, Wind};
        let column = [Positions, Normals, Uvs, Colors, Wind, Pivots].get(column);
        column.map_or_else(Vec::new, |&c| self.0.exported_column(model, part, c).to_vec())
    }

    /// Returns three indices for each triangle of the shown export.
    pub fn exported_indices(&self, model: usize, part: usize) -> Vec<u32> {
        self.0.exported_indices(model, part).to_vec()
    }

    /// See [`Workspace::end_preview`].
    pub fn end_preview(&mut self) {
        self.0.end_preview();
    }
}
