//! A request from Python -> a document of one plant -> the plant.

use std::cell::RefCell;
use std::path::Path;
use std::sync::Arc;

use burgeon::bloom::{BloomError, FlowerSpec, GrowthLaw, Offset, Series};
use burgeon::document::{
    Document, DocumentPlant, Editor, FlowerMaker, LeafData, LeafMaker, Maker, PlantId, Settings,
    SketchCommand,
};
use burgeon::formats::{CloudFormat, DrawingFormat, ExportSpec, MarksAxes, ModelFormat};
use burgeon::glam::{DVec2, DVec3};
use burgeon::ink::{Drawing, StrokeClass};
use burgeon::leaf::{LeafSpec, PalmateSpec, ParallelSpec, Rays, ScanSpec};
use burgeon::mesh::PointCloud;
use burgeon::sketch::SketchSpec;
use burgeon::skin::SkinSpec;
use burgeon::{
    HeightError, LeafOptions, NamedMesh, Preset, Report, SceneEvaluator, Seed, Spec, TreeGoal, TreeSpec,
};
use companions::{LIMITS, Named, NamedFault, NamedFileError, Trust};
use pyo3::prelude::*;

use crate::asked::Asked;
use crate::compute::{aside, compute};
use crate::fault::{beyond, choice, not_readable, refused, unlike, unusable, wrong};
use crate::held::{Held, run};
use crate::model::{axes, colours};
use crate::plant::RawPlant;

/// Source of a spec: a preset by its word, the text of a file with the file's place, or fields alone.
#[derive(FromPyObject)]
pub(crate) struct Base {
    #[pyo3(item)]
    preset: Option<String>,
    #[pyo3(item)]
    toml: Option<(String, std::path::PathBuf)>,
    /// Whether its paths may lead anywhere.
    #[pyo3(item)]
    trust_paths: bool,
}

/// Size that a tree grows to, as Python requests it.
#[derive(FromPyObject)]
pub(crate) struct Size {
    /// Height, metres.
    #[pyo3(item)]
    height: Option<f64>,
    /// Diameter at breast height, metres.
    #[pyo3(item)]
    dbh: Option<f64>,
}

impl Size {
    fn goal(&self) -> PyResult<Option<TreeGoal>> {
        let goal = |name: &str, value: Option<f64>, (least, most): (f64, f64)| {
            let Some(value) = value else { return Ok(None) };
            let fault = || beyond(name, value, &format!("{least} to {most} m"));
            (least..=most).contains(&value).then_some(value).map(Some).ok_or_else(fault)
        };
        let height = goal("height", self.height, TreeGoal::HEIGHTS_M)?.map(TreeGoal::Height);
        Ok(goal("dbh", self.dbh, TreeGoal::DIAMETERS_M)?.map(TreeGoal::Dbh).or(height))
    }
}

/// Grows a tree; `leaf`: the leaf that it bears; `size`: the size that it grows to.
#[pyfunction]
pub(crate) fn grow(
    py: Python<'_>,
    base: Base,
    asked: Asked<'_>,
    leaf: Option<PyRef<'_, RawPlant>>,
    size: Size,
) -> PyResult<RawPlant> {
    let (spec, preset) = base.tree(py)?;
    let mut spec = asked.spec(py, &spec)?;
    let (skin, wind) = asked.skin(py)?;
    let leaf = match (leaf, spec.blade.file.take()) {
        (Some(leaf), _) => Some(lender(py, &leaf)?),
        (None, Some(file)) => Some(leaf_beside(py, &base, &file, asked.seed())?),
        (None, None) => None,
    };
    let height_m = match size.goal()? {
        None => None,
        Some(goal) => {
            let (seed, budget) = (asked.seed(), asked.budget()?);
            let height = compute(py, budget, |run| burgeon::aim_at(&mut spec, seed, goal, run))?;
            Some(height.map_err(|e| match e {
                HeightError::Tree(e) => refused(py, &e),
                e => unusable(py, &format_args!("{}: {e}", goal.word())),
            })?)
        }
    };
    let name = spec.name.clone();
    let mut tree = burgeon::tree_settings(&spec, preset);
    (tree.skin, tree.height_m) = (skin, height_m);
    asked.bearing(py, &name, Maker::Tree(Box::new(tree)), leaf, wind).map(RawPlant)
}

impl Base {
    /// Returns the spec of a tree, and its species.
    pub(crate) fn tree(&self, py: Python<'_>) -> PyResult<(TreeSpec, Option<&'static str>)> {
        match (&self.preset, &self.toml) {
            (Some(word), _) => {
                let preset = Preset::find(word).ok_or_else(|| {
                    let known: Vec<&str> = burgeon::PRESETS.iter().map(|p| p.key).collect();
                    choice("spec", word, &known, "there is no preset")
                })?;
                Ok((preset.spec().map_err(|e| refused(py, &e))?, Some(preset.key)))
            }
            (None, Some((text, path))) => {
                let not_read = RefCell::new(None);
                let spec = burgeon::read_tree_spec(text, &|name| {
                    let mesh = named_mesh(&Named { naming: path, name }, self.trust());
                    mesh.map_err(|e| not_read.replace(Some(e))).ok().flatten()
                });
                if let Some(e) = not_read.into_inner() {
                    return Err(not_readable(py, &e));
                }
                Ok((spec.map_err(|e| refused(py, &e.in_text(text)))?, None))
            }
            (None, None) => Ok((TreeSpec::default(), None)),
        }
    }

    /// Returns a source of fields alone; file names are relative to a file.
    pub(crate) fn from_fields(beside: std::path::PathBuf, trust_paths: bool) -> Self {
        Self { preset: None, toml: Some((String::new(), beside)), trust_paths }
    }

    /// Returns the text of a file.
    pub(crate) fn text(&self) -> Option<&str> {
        self.toml.as_ref().map(|(text, _)| text.as_str())
    }

    /// Returns the file to which the names of others are relative.
    pub(crate) fn naming(&self) -> &Path {
        self.toml.as_ref().map_or(Path::new("spec.toml"), |(_, spec)| spec)
    }

    pub(crate) fn trust(&self) -> Trust {
        Trust { paths: self.trust_paths, allow: "trust_paths=True" }
    }

    /// Returns the tree of a spec that this one names.
    pub(crate) fn tree_beside(&self, py: Python<'_>, name: &str) -> PyResult<TreeSpec> {
        let named = Named { naming: self.naming(), name };
        let bytes = named.open(self.trust(), LIMITS.text).and_then(|(file, _)| named.read(file, LIMITS.text));
        let bytes = bytes.map_err(|e| not_readable(py, &e))?;
        let text = String::from_utf8(bytes).map_err(|e| unusable(py, &format!("{name}: {e}")))?;
        let own = Self { preset: None, toml: Some((text, named.path())), trust_paths: self.trust_paths };
        Ok(own.tree(py)?.0)
    }
}

/// Returns the settings of a leaf of marks, of a vein graph or of numbers, for a tree to bear.
fn lender(py: Python<'_>, leaf: &RawPlant) -> PyResult<Settings> {
    let held = &leaf.0;
    let own = held.document.plant(held.id).map(DocumentPlant::settings);
    let leaf = own.filter(|s| matches!(s.maker, Maker::Leaf(_))).cloned();
    leaf.ok_or_else(|| unusable(py, &"leaf must be a leaf of marks, of a vein graph or of numbers"))
}

/// Returns the leaf of a file that a spec names, relative to the spec.
fn leaf_beside(py: Python<'_>, base: &Base, file: &str, seed: Seed) -> PyResult<Settings> {
    let named = Named { naming: base.naming(), name: file };
    let path = named.path();
    let unread = |why: &dyn std::fmt::Display| unusable(py, &format!("blade.file {file:?}: {why}"));
    if !path.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv") || e.eq_ignore_ascii_case("json")) {
        return Err(unread(&"Python reads leaves of marks (.csv) and of vein graphs (.json)"));
    }
    let bytes = named.open(base.trust(), LIMITS.text).and_then(|(file, _)| named.read(file, LIMITS.text));
    let bytes = bytes.map_err(|e| match e.fault {
        NamedFault::Missing => unread(&e.fault),
        _ => not_readable(py, &e),
    })?;
    let text = String::from_utf8(bytes).map_err(|e| unread(&e))?;
    let data = LeafData { name: file.to_owned(), text: text.into() };
    let maker = Maker::Leaf(Box::new(LeafMaker { data, settings: LeafSpec::default() }));
    Ok(Settings { name: file.to_owned(), seed, maker, ..Settings::default() })
}

/// Reads a mesh or cloud that a spec names, in metres, +Y up; none for other files.
pub(crate) fn named_mesh(named: &Named<'_>, trust: Trust) -> Result<Option<NamedMesh>, NamedFileError> {
    match named.open(trust, LIMITS.model) {
        Ok((file, _)) => Ok(mesh_of(&named.path(), &named.read(file, LIMITS.model)?)),
        Err(NamedFileError { fault: NamedFault::Missing, .. }) => Ok(None),
        Err(e) => Err(e),
    }
}

fn mesh_of(path: &Path, bytes: &[u8]) -> Option<NamedMesh> {
    let extension = path.extension()?.to_str()?;
    let (axes, mut report) = (ExportSpec::default(), Report::default());
    let cloud = CloudFormat::from_extension(extension);
    if let Some(format @ (CloudFormat::Xyz | CloudFormat::Pcd | CloudFormat::Las | CloudFormat::E57)) = cloud
    {
        let cloud = burgeon::formats::read_cloud(bytes, format, &axes, &mut report).ok()?;
        return Some((cloud.points, Vec::new()));
    }
    let format = ModelFormat::from_extension(extension)?;
    let none = burgeon::formats::no_files;
    let model = burgeon::formats::read_model(bytes, format, "obstacle", &axes, &none, &mut report).ok()?;
    Some(model.triangles())
}

/// Makes a flower on a day; none for full bloom.
#[pyfunction]
pub(crate) fn bloom(
    py: Python<'_>,
    base: Base,
    asked: Asked<'_>,
    day: Option<f64>,
    law: Option<PyRef<'_, RawLaw>>,
) -> PyResult<RawPlant> {
    let spec = match (&base.preset, &base.toml) {
        (Some(word), _) => {
            let none = || choice("spec", word, FlowerSpec::PRESETS, "there is no flower");
            burgeon::bloom::preset(word).ok_or_else(none)?
        }
        (None, Some((text, _))) => burgeon::spec::from_toml(text).map_err(|e| refused(py, &e))?,
        (None, None) => FlowerSpec::default(),
    };
    let spec = asked.spec(py, &spec)?;
    let (_, wind) = asked.skin(py)?;
    let (name, day) = (spec.name.clone(), day.unwrap_or(spec.opening_days));
    let law = law.map(|l| Arc::new(l.0.clone()));
    let flower = FlowerMaker { preset: base.preset, spec: Arc::new(spec), day, law };
    asked.alone(py, &name, Maker::Flower(Box::new(flower)), wind).map(RawPlant)
}

/// Makes a leaf of numbers, or of a file of marks or veins, given by name and text.
#[pyfunction]
pub(crate) fn leaf(
    py: Python<'_>,
    file: Option<(String, String)>,
    toml: Option<String>,
    asked: Asked<'_>,
) -> PyResult<RawPlant> {
    let base = match toml {
        Some(text) => burgeon::spec::from_toml(&text).map_err(|e| refused(py, &e))?,
        None => LeafSpec::default(),
    };
    let settings: LeafSpec = asked.spec(py, &base)?;
    let (_, wind) = asked.skin(py)?;
    let (name, text) = file.unwrap_or_else(|| ("leaf".into(), String::new()));
    let data = LeafData { name: name.clone(), text: text.into() };
    asked.alone(py, &name, Maker::Leaf(Box::new(LeafMaker { data, settings })), wind).map(RawPlant)
}

/// Chief veins that start together: those of a kind, with its numbers; or those of a file, by its name and text.
#[derive(FromPyObject)]
pub(crate) struct Veins {
    #[pyo3(item)]
    venation: Option<String>,
    #[pyo3(item)]
    file: Option<(String, String)>,
    #[pyo3(item)]
    veins: Option<u32>,
    #[pyo3(item)]
    length_m: Option<f64>,
    #[pyo3(item)]
    depth: Option<f64>,
    #[pyo3(item)]
    side_veins: Option<u32>,
}

/// Returns an optional number within its range.
fn within(name: &str, value: Option<f64>, usual: f64, [least, most]: [f64; 2]) -> PyResult<f64> {
    let value = value.unwrap_or(usual);
    if (least..=most).contains(&value) {
        return Ok(value);
    }
    Err(beyond(name, value, &format!("{least} to {most}")))
}

impl Veins {
    fn count(&self, usual: u32, most: u32) -> PyResult<u32> {
        let veins = self.veins.unwrap_or(usual);
        if veins % 2 == 1 && (3..=most).contains(&veins) {
            return Ok(veins);
        }
        Err(beyond("veins", veins, &format!("an odd number from 3 to {most} (one is the midrib)")))
    }

    fn rays(&self) -> PyResult<(&'static str, Rays)> {
        let length = |usual| within("length", self.length_m, usual, [0.001, 10.0]);
        match self.venation.as_deref() {
            Some("palmate") => {
                let usual = PalmateSpec::default();
                let depth = within("depth", self.depth, usual.depth, [0.0, 0.9])?;
                let veins = self.count(usual.veins, 11)?;
                let spec = PalmateSpec { veins, length_m: length(usual.length_m)?, depth };
                Ok(("palmate", Rays::palmate(&spec)))
            }
            Some("parallel") if self.depth.is_some() => {
                Err(wrong("depth is of palmate leaves: leave it out", "depth", "given", "left out"))
            }
            Some("parallel") => {
                let usual = ParallelSpec::default();
                let veins = self.count(usual.veins, 31)?;
                Ok((
                    "parallel",
                    Rays::parallel(&ParallelSpec { veins, length_m: length(usual.length_m)?, ..usual }),
                ))
            }
            other => {
                Err(beyond("venation", format!("{:?}", other.unwrap_or_default()), "palmate or parallel"))
            }
        }
    }
}

/// Makes a leaf of chief veins that start together.
#[pyfunction]
pub(crate) fn leaf_of_veins(py: Python<'_>, veins: Veins, asked: Asked<'_>) -> PyResult<RawPlant> {
    let mut spec = asked.spec(py, &LeafSpec::default())?;
    let (_, wind) = asked.skin(py)?;
    let (name, rays) = match &veins.file {
        None => {
            let (name, rays) = veins.rays()?;
            (name.to_owned(), rays)
        }
        Some((name, text)) => {
            let read = burgeon::formats::read_rays(text.as_bytes(), name, MarksAxes::default());
            let read = read.map_err(|e| unusable(py, &format!("{name}: {e}")))?;
            spec.thickness = spec.thickness.or(read.thickness);
            (read.name, read.rays)
        }
    };
    let budget = asked.budget()?;
    let usual = if veins.venation.as_deref() == Some("palmate") { 4 } else { 0 };
    let side_veins = veins.side_veins.unwrap_or(usual);
    if side_veins > 12 {
        return Err(beyond("side_veins", side_veins, "0 to 12"));
    }
    let skin = SkinSpec { wind, ..SkinSpec::default() };
    let options = LeafOptions { spec, skin, side_veins, ..LeafOptions::default() };
    let made = compute(py, budget, |run| burgeon::make_ray_leaf(&name, &rays, &options, run))?;
    Ok(RawPlant(Held::lone(made.map_err(|e| refused(py, &e))?, None, budget)))
}

/// Makes a leaf of a scan: points in metres, with their colours as bytes if they have some, or the bytes of a file,
/// its extension and its unit; and its texture (`scan`, `plain`).
#[pyfunction]
pub(crate) fn leaf_of_scan(
    py: Python<'_>,
    name: &str,
    file: Option<(Vec<u8>, String, String)>,
    points: (Vec<[f64; 3]>, Vec<u8>),
    texture: &str,
    budget: f64,
) -> PyResult<RawPlant> {
    let mut cloud = match file {
        None => {
            let (points, colors) = points;
            let points = points.into_iter().map(DVec3::from_array).collect();
            PointCloud { points, colors: colours(&colors), ..PointCloud::default() }
        }
        Some((bytes, extension, unit)) => {
            let format = CloudFormat::from_extension(&extension);
            let format = format
                .ok_or_else(|| unusable(py, &format!("{name}: is no cloud (.xyz, .ply, .pcd, .las)")))?;
            let axes = axes(&unit, "y")?;
            let read = aside(py, move || {
                burgeon::formats::read_cloud(&*bytes, format, &axes, &mut Report::default())
            })?;
            read.map_err(|e| unusable(py, &format!("{name}: {e}")))?
        }
    };
    if texture == "plain" {
        cloud.colors.clear();
    }
    if !(1.0..=1000.0).contains(&budget) {
        return Err(beyond("budget", budget, "1 to 1000"));
    }
    let spec = ScanSpec::default();
    let made = compute(py, budget, |run| burgeon::make_leaf_from_scan(name, &cloud, &spec, run))?;
    Ok(RawPlant(Held::lone(made.map_err(|e| refused(py, &e))?.0, None, budget)))
}

/// Returns whether the text of a file of marks describes chief veins that start together.
#[pyfunction]
pub(crate) fn is_rays(text: &str) -> bool {
    burgeon::formats::is_rays(text.as_bytes())
}

/// Strokes of a drawing: the bytes of a file and its extension, or points.
#[derive(FromPyObject)]
pub(crate) struct Ink {
    #[pyo3(item)]
    file: Option<(Vec<u8>, String)>,
    #[pyo3(item)]
    lines: Vec<Vec<[f64; 2]>>,
}

/// Makes the plant of a drawing.
#[pyfunction]
pub(crate) fn sketch(
    py: Python<'_>,
    name: &str,
    ink: Ink,
    asked: Asked<'_>,
    classes: Vec<(usize, String)>,
    day: Option<f64>,
) -> PyResult<RawPlant> {
    let drawing = match ink.file {
        Some((bytes, extension)) => {
            let format = DrawingFormat::from_extension(&extension).or_else(|| DrawingFormat::sniff(&bytes));
            let format = format
                .ok_or_else(|| unlike(py, name, &bytes, "is no drawing (.svg, .inkml, .ndjson, .json)"))?;
            let own = name.to_owned();
            let (first, several) = aside(py, move || {
                let mut read = burgeon::formats::read_drawings(&*bytes, format, &own);
                (read.next(), read.next().is_some())
            })?;
            let first = first.ok_or_else(|| unusable(py, &format!("{name}: holds no drawing")))?;
            let drawing = first.map_err(|e| unusable(py, &format!("{name}: {e}")))?.drawing;
            if several {
                return Err(unusable(py, &format!("{name}: holds several drawings; give one")));
            }
            drawing
        }
        None => {
            let lines = ink.lines.into_iter().map(|l| l.into_iter().map(DVec2::from_array).collect());
            let lines: Vec<Vec<DVec2>> = lines.collect();
            Drawing::from_polylines(name, &lines)
        }
    };
    let mut document = Document::from_drawing(&drawing);
    let Some(plant) = document.plants().first() else {
        return Err(unusable(py, &"internal error, a bug in burgeon: a drawing is one plant"));
    };
    let (id, strokes) = (plant.id(), plant.strokes().iter().map(|s| s.id).collect::<Vec<_>>());
    let spec = asked.spec(py, &SketchSpec::default())?;
    let (skin, wind) = asked.skin(py)?;
    let mut commands = vec![
        SketchCommand::SetSketch(Box::new(spec)).for_plant(id),
        SketchCommand::SetSkin(skin).for_plant(id),
        burgeon::document::PlantCommand::SetSeed(asked.seed()).for_plant(id),
        SketchCommand::SetDay(day).for_plant(id),
    ];
    for (row, word) in classes {
        let count = strokes.len();
        let stroke = strokes.get(row).ok_or_else(|| {
            let line = format!("classes: there is no stroke {row}; the drawing has {count}");
            wrong(&line, "classes", &row.to_string(), &format!("0 to {}", count.saturating_sub(1)))
        })?;
        let class = StrokeClass::from_word(&word).ok_or_else(|| {
            choice(
                &format!("classes[{row}]"),
                &word,
                &StrokeClass::ALL.map(StrokeClass::word),
                "there is no class",
            )
        })?;
        commands.push(SketchCommand::SetClass(vec![*stroke], Some(class)).for_plant(id));
    }
    let mut editor = Editor::new(document);
    commands.into_iter().try_for_each(|command| run(py, &mut editor, command))?;
    document = editor.document().clone();
    asked.made(py, document, id, wind).map(RawPlant)
}

/// Makes every visible plant of a project of the Studio, or one of them by its row.
#[pyfunction]
#[pyo3(signature = (bytes, budget, wind, only = None))]
pub(crate) fn open_project(
    py: Python<'_>,
    bytes: Vec<u8>,
    budget: f64,
    wind: bool,
    only: Option<usize>,
) -> PyResult<Vec<RawPlant>> {
    let document = aside(py, move || burgeon::document::read_project(&bytes))?;
    let document = document.map_err(|e| unusable(py, &e))?;
    let seen = document.plants().iter().filter(|p| !p.settings().hidden);
    let ids: Vec<PlantId> = seen.map(DocumentPlant::id).collect();
    let wanted = ids.into_iter().enumerate().filter(|(row, _)| only.is_none_or(|only| only == *row));
    wanted
        .map(|(_, id)| id)
        .map(|id| {
            let mut scene = SceneEvaluator::default();
            scene.set_wind(wind);
            Held::make(py, scene, document.clone(), id, budget).map(RawPlant)
        })
        .collect()
}

/// A growth law.
#[pyclass(frozen, module = "burgeon._burgeon")]
pub(crate) struct RawLaw(GrowthLaw);

impl RawLaw {
    pub(crate) const fn from_law(law: GrowthLaw) -> Self {
        Self(law)
    }

    pub(crate) const fn law(&self) -> &GrowthLaw {
        &self.0
    }
}

#[pymethods]
impl RawLaw {
    /// Fits a law to the sizes of each organ: name, days, sizes in metres.
    #[staticmethod]
    fn fit(
        py: Python<'_>,
        name: &str,
        organs: Vec<(String, Vec<f64>, Vec<f64>)>,
        budget: f64,
    ) -> PyResult<Self> {
        let series = organs.into_iter().map(|(organ, days, values)| (organ, Series { days, values }));
        let series: Vec<(String, Series)> = series.collect();
        let law = compute(py, budget, |run| burgeon::bloom::fit_sizes(name, &series, Offset::Auto, run))?;
        law.map(Self).map_err(|e| match e {
            BloomError::OverBudget(much) => refused(py, &much),
            other => unusable(py, &other),
        })
    }

    /// Reads a law from a file of `burgeon bloom fit`.
    #[staticmethod]
    fn read(py: Python<'_>, text: &str) -> PyResult<Self> {
        let law: GrowthLaw = serde_json::from_str(text)
            .map_err(|e| unusable(py, &format!("is no growth law: {}", burgeon::plainly(&e.to_string()))))?;
        let fault = law.validate().next();
        fault.map_or(Ok(Self(law)), |fault| Err(unusable(py, &format!("cannot be used: {fault}"))))
    }

    /// Returns the law in the form of its file.
    fn json(&self) -> String {
        serde_json::to_string(&self.0).unwrap_or_default()
    }

    /// Returns the sizes of an organ on some days, metres; organs are counted as in the fit.
    fn values(&self, organ: usize, days: Vec<f64>) -> PyResult<Vec<f64>> {
        let count = self.0.laws.len();
        let none = || beyond("organ", organ, &format!("0 to {}", count.saturating_sub(1)));
        let law = self.0.laws.get(organ).ok_or_else(none)?;
        Ok(days.into_iter().map(|d| law.value(d - self.0.first_day)).collect())
    }

    /// Returns whether the days determine the law of each organ.
    fn determined(&self) -> Vec<bool> {
        self.0.laws.iter().map(burgeon::bloom::RegionLaw::is_determined).collect()
    }
}

/// Returns the schema of a maker's options, as JSON.
#[pyfunction]
pub(crate) fn schema(maker: &str) -> PyResult<String> {
    Ok(match maker {
        "tree" => burgeon::tree_schema().to_string(),
        "flower" => burgeon::flower_schema().to_string(),
        "leaf" => burgeon::leaf_schema().to_string(),
        "sketch" => SketchSpec::schema().to_string(),
        "skin" => SkinSpec::schema().to_string(),
        other => {
            return Err(beyond("maker", format!("{other:?}"), "tree, flower, leaf, sketch or skin"));
        }
    })
}

/// Returns the words of trees and of flowers that come with the program.
#[pyfunction]
pub(crate) fn presets() -> (Vec<&'static str>, Vec<&'static str>) {
    (burgeon::PRESETS.iter().map(|p| p.key).collect(), FlowerSpec::PRESETS.to_vec())
}
