//! Functions for the checks in Node, which compare bits with native results. The page does not use them.

use burgeon::formats::{self, CloudFormat, DrawingFormat, ExportSpec};
use burgeon::glam::DVec3;
use burgeon::growth::{Envelope, Growing, GuidedSpec, Obstacles};
use burgeon::leaf::ScanSpec;
use burgeon::{
    Budget, Digest, FlowerOptions, ItemReport, LeafOptions, OpeningPlant, Preset, Report, Run,
    SceneEvaluator, Seed, SketchOptions, TreeOptions, Unit, bloom, make_flower, make_from_sketch, make_leaf,
    make_tree,
};
use wasm_bindgen::prelude::*;

/// Makes a plant from every drawing of a file (SVG, InkML, QuickDraw ndjson or our JSON, recognised by its name) and
/// returns the report's items as a JSON array.
///
/// # Errors
/// A message for people when the file cannot be read or a drawing has nothing usable.
#[wasm_bindgen]
pub fn sketch_report(file_name: &str, bytes: &[u8], seed: u64) -> Result<String, JsError> {
    let mut items: Vec<ItemReport> = Vec::new();
    let (stem, extension) = file_name.rsplit_once('.').unwrap_or((file_name, ""));
    let format = DrawingFormat::from_extension(extension)
        .or_else(|| DrawingFormat::sniff(bytes))
        .ok_or_else(|| JsError::new("not a drawing: give an SVG, InkML, ndjson or JSON file"))?;
    for read in formats::read_drawings(bytes, format, stem) {
        let made =
            make_from_sketch(&read?.drawing, &SketchOptions::default(), Seed::new(seed), &Run::plain())?;
        items.push(made.item);
    }
    Ok(serde_json::to_string(&items)?)
}

/// Makes a leaf with default options from marks or chief veins (.csv), a vein graph (.json) or a scan in millimetres
/// (.xyz), and returns the report's item as JSON.
///
/// # Errors
/// A message for people when the file holds no leaf.
#[wasm_bindgen]
pub fn leaf_report(file_name: &str, bytes: &[u8], seed: u64) -> Result<String, JsError> {
    let (name, extension) = file_name.rsplit_once('.').unwrap_or((file_name, ""));
    let (seed, run) = (Seed::new(seed), Run::plain());
    let mut options = LeafOptions::default();
    let mut report = Report::default();
    let item = match extension {
        "xyz" => {
            let axes = ExportSpec { unit: Unit::Millimetre, ..ExportSpec::default() };
            let cloud = formats::read_cloud(bytes, CloudFormat::Xyz, &axes, &mut report)?;
            burgeon::make_leaf_from_scan(name, &cloud, &ScanSpec::default(), &run)?.0.item
        }
        "json" => {
            let marks = formats::read_vein_graph(bytes)?.graph.marks(&mut report)?;
            // As in `burgeon leaf`: a graph in pixels becomes 0.1 m long.
            let marks = marks.scaled(0.1 / marks.length());
            make_leaf(name, &marks, &options, seed, &run)?.item
        }
        _ if formats::is_rays(bytes) => {
            let read = formats::read_rays(bytes, name, formats::MarksAxes::default())?;
            options.spec.thickness = read.thickness;
            burgeon::make_ray_leaf(&read.name, &read.rays, &options, &run)?.item
        }
        _ => {
            let read = formats::read_marks(bytes, name, formats::MarksAxes::default())?;
            options.spec.thickness = read.thickness;
            make_leaf(&read.name, &read.marks, &options, seed, &run)?.item
        }
    };
    Ok(serde_json::to_string(&item)?)
}

/// Returns the digest of a whole flower of its species at even days from bud to wilted, as `burgeon bloom run`
/// reports it.
///
/// # Errors
/// A message for people for an unknown species, or fewer than 2 frames.
#[wasm_bindgen]
pub fn flower_digest(species: &str, frames: u32, seed: u64) -> Result<String, JsError> {
    let spec = bloom::preset(species).ok_or_else(|| JsError::new("there is no such flower"))?;
    if frames < 2 {
        return Err(JsError::new("a flower that opens has at least 2 frames"));
    }
    let law = spec.own_law();
    let mut digest = Digest::new();
    for k in 0..frames {
        let day = (spec.opening_days + spec.wilting_days) * (f64::from(k) / f64::from(frames - 1));
        let options = FlowerOptions::default();
        let made = make_flower(&spec.name, &spec, (day, &law), &options, Seed::new(seed), &Run::plain())?;
        digest.add(&made.model);
    }
    Ok(digest.hex())
}

/// Returns the digest of a drawn plant (SVG) whose flowers open, at even days from bud to wilted.
///
/// # Errors
/// A message for people for a drawing without flowers, or fewer than 2 frames.
#[wasm_bindgen]
pub fn opening_digest(name: &str, bytes: &[u8], frames: u32, seed: u64) -> Result<String, JsError> {
    let read = formats::read_drawings(bytes, DrawingFormat::Svg, name).next();
    let drawing = read.ok_or_else(|| JsError::new("there is no drawing"))??.drawing;
    let seed = Seed::new(seed);
    let mut plant = OpeningPlant::new(&drawing, &SketchOptions::default(), seed, &Run::plain())?;
    if frames < 2 {
        return Err(JsError::new("a flower that opens has at least 2 frames"));
    }
    let law = plant.law();
    let mut digest = Digest::new();
    for k in 0..frames {
        let day = (plant.days[0] + plant.days[1]) * (f64::from(k) / f64::from(frames - 1));
        digest.add(&plant.make_on_day(day, &law, seed, &Run::plain())?.model);
    }
    Ok(digest.hex())
}

/// Returns the digest of one organ's motion from a first to a last scan (XYZ in millimetres) by the law that is
/// fitted to three scans, the middle one half way: registration, lattice, law and all.
///
/// # Errors
/// A message for people when the scans show no organ.
#[wasm_bindgen]
pub fn motion_digest(first: &[u8], middle: &[u8], last: &[u8], frames: u32) -> Result<String, JsError> {
    let axes = ExportSpec { unit: Unit::Millimetre, ..ExportSpec::default() };
    let mut stages = Vec::new();
    for (day, bytes) in [(0.0, first), (1.0, middle), (2.0, last)] {
        let cloud = formats::read_cloud(bytes, CloudFormat::Xyz, &axes, &mut Report::default())?;
        let spec = bloom::SegmentSpec::default();
        let organ = bloom::single_organ(&cloud.points, "organ", &spec, &Run::plain())?;
        stages.push(bloom::Stage { day, organs: vec![organ] });
    }
    let law = bloom::fit_stages("stages", &stages, &bloom::LawSpec::default(), &Run::plain())?;
    // In the form in which the program reads it from a file.
    let law = serde_json::from_str(&serde_json::to_string(&law)?)?;
    let run = Run::plain();
    let motion = bloom::Motion::new(&stages, law, bloom::MotionSpec::default(), &run)?;
    let mut digest = Digest::new();
    for k in 0..frames.max(2) {
        let day = 2.0 * (f64::from(k) / f64::from(frames.max(2) - 1));
        let points = motion.points_on_day(day, &run)?;
        digest.add(&burgeon::motion_model("stages", None, &motion.organs, &points));
    }
    Ok(digest.hex())
}

/// Makes the plants of a `.burgeon` project and returns the report's items as a JSON array.
///
/// # Errors
/// A message for people when the file cannot be read or a plant cannot be made.
#[wasm_bindgen]
pub fn scene_report(bytes: &[u8]) -> Result<String, JsError> {
    let document = burgeon::document::read_project(bytes)?;
    let mut scene = SceneEvaluator::default();
    let mut items: Vec<ItemReport> = Vec::new();
    for plant in document.plants() {
        scene.update(plant.id(), &document, &Run::plain())?;
        items.extend(scene.get(plant.id()).map(|p| p.report()));
    }
    Ok(serde_json::to_string(&items)?)
}

/// Returns the digest of the tree of a preset, as `burgeon grow` reports it, and the numbers of vertices and
/// triangles of its plain surface at this detail: `digest vertices triangles`.
///
/// # Errors
/// A message for people for an unknown preset.
#[wasm_bindgen]
pub fn tree_digest(preset: &str, detail: f64, seed: u64) -> Result<String, JsError> {
    let preset = Preset::find(preset).ok_or_else(|| JsError::new("there is no such preset"))?;
    let mut options = TreeOptions::default();
    (options.skin.detail, options.skin.textures) = (detail, false);
    let made = make_tree(&preset.spec()?, Seed::new(seed), &options, &Run::plain())?;
    let (digest, counts) = (&made.item.digest, &made.item.counts);
    Ok(format!("{digest} {} {}", counts.vertices, counts.triangles))
}

/// Returns a run without limits: the 1,300 markers a bud of the VR paper exceed the usual budget.
fn without_budget() -> Run<'static> {
    Run { budget: Budget { times: 1000.0, ..Budget::default() }, ..Run::plain() }
}

/// Guided growth in a ball of 5 m, measured round by round.
#[wasm_bindgen]
#[derive(Debug)]
pub struct GuidedGrowth(Growing);

#[wasm_bindgen]
impl GuidedGrowth {
    /// Grows until at least `buds` buds live, or for 200 rounds. `finer`: divisor of the usual length of internodes.
    ///
    /// # Errors
    /// A message for people for numbers out of range.
    #[wasm_bindgen(constructor)]
    pub fn new(markers: u32, finer: f64, buds: u32) -> Result<Self, JsError> {
        let plain = GuidedSpec::from_crown(Envelope::Sphere { centre: DVec3::Y * 5.0, radius_m: 5.0 });
        let spec = GuidedSpec { markers, internode_m: plain.internode_m / finer, rounds: 200, ..plain };
        let (none, seed, run) = (Obstacles::none(), Seed::new(1), without_budget());
        let mut growing = Self(Growing::plant(&[DVec3::ZERO], &none, &spec, seed, &run)?);
        while growing.living() < buds && growing.0.rounds() < 200 {
            growing.step()?;
        }
        Ok(growing)
    }

    /// Returns the number of living buds.
    #[wasm_bindgen(getter)]
    pub fn living(&self) -> u32 {
        u32::try_from(self.0.living()).unwrap_or(u32::MAX)
    }

    /// Grows one more round.
    ///
    /// # Errors
    /// A message for people if the round exceeds the budget.
    pub fn step(&mut self) -> Result<(), JsError> {
        self.0.step(&without_budget())?;
        Ok(())
    }
}
