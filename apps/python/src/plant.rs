//! A plant: its tables, its files, and plants derived from it.

use std::sync::Arc;

use burgeon::document::{FlowerCommand, Maker, SketchCommand};
use burgeon::formats::StructureFormat;
use burgeon::glam::DVec3;
use burgeon::mesh::Standing;
use burgeon::plant::Organ;
use burgeon::{DrawnLine, SceneError, Seed, Stood, SurveySpec, Surveyed};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::asked::Asked;
use crate::column::{Column, Owner};
use crate::compute::{aside, compute};
use crate::fault::{beyond, misread, refused, unusable};
use crate::held::Held;
use crate::light::LightAsked;
use crate::model::{RawModel, axes, bytes_of};
use crate::value::json_of;
use crate::write::{Form, Written};

/// A plant, which never changes.
#[pyclass(frozen, module = "burgeon._burgeon")]
pub(crate) struct RawPlant(pub(crate) Arc<Held>);

fn collect_column<T: Send + Sync + crate::column::Row>(values: impl Iterator<Item = T>) -> Column {
    Column::new(values.collect())
}

fn handle(raw: Option<u32>) -> i32 {
    raw.and_then(|r| i32::try_from(r).ok()).unwrap_or(burgeon::NOTHING)
}

/// Returns the columns of a cloud by their names.
pub(crate) fn cloud(py: Python<'_>, cloud: Surveyed) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    let put = |name: &str, column: Column| dict.set_item(name, Py::new(py, column)?);
    put("points", Column::new(cloud.points))?;
    put("normals", Column::new(cloud.normals))?;
    put("part", Column::new(cloud.part))?;
    put("axis", Column::new(cloud.axis))?;
    put("organ", Column::new(cloud.organ))?;
    put("order", Column::new(cloud.order))?;
    put("station", Column::new(cloud.station))?;
    put("distance", Column::new(cloud.distance))?;
    put("share", Column::new(cloud.share))?;
    put("echo", Column::new(cloud.echo))?;
    put("echoes", Column::new(cloud.echoes))?;
    put("time", Column::new(cloud.time))?;
    Ok(dict)
}

/// Positions and beams of a scanner, as Python requests them.
#[derive(FromPyObject)]
pub(crate) struct Scan {
    #[pyo3(item)]
    points: u32,
    #[pyo3(item)]
    stations: u32,
    #[pyo3(item)]
    elevation: f64,
    #[pyo3(item)]
    noise: f64,
    #[pyo3(item)]
    beam: f64,
    #[pyo3(item)]
    pulse: f64,
    #[pyo3(item)]
    path: Vec<[f64; 3]>,
    #[pyo3(item)]
    seed: u64,
}

impl Scan {
    pub(crate) fn spec(&self) -> (SurveySpec, Seed) {
        let spec = SurveySpec {
            points: self.points,
            stations: self.stations,
            elevation_deg: self.elevation,
            noise_m: self.noise,
            beam_mrad: self.beam,
            pulse_m: self.pulse,
            path: self.path.iter().copied().map(DVec3::from_array).collect(),
        };
        (spec, Seed::new(self.seed))
    }
}

#[pymethods]
impl RawPlant {
    #[getter]
    fn name(&self) -> String {
        self.0.name().to_owned()
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.0.seed().number()
    }

    #[getter]
    fn maker(&self) -> &'static str {
        match (&self.0.found, &self.0.lone) {
            (Some(_), _) => "scan",
            (None, Some(_)) => "leaf",
            (None, None) => self.0.maker().map_or("", Maker::word),
        }
    }

    /// Returns the entry of the report, as JSON.
    fn report(&self) -> String {
        self.0.report().and_then(|r| serde_json::to_string(&r).ok()).unwrap_or_default()
    }

    #[getter]
    fn digest(&self) -> String {
        self.0.report().map_or_else(String::new, |r| r.digest)
    }

    /// Returns all measures, as JSON.
    fn measures(&self, py: Python<'_>) -> String {
        let held = &self.0;
        py.detach(|| serde_json::to_string(&held.plant().measure()).unwrap_or_default())
    }

    /// Returns the options of the maker, as JSON.
    fn spec(&self) -> String {
        let json = match self.0.maker() {
            Some(Maker::Sketch(s)) => burgeon::spec::to_json(&s.sketch),
            Some(Maker::Tree(t)) => burgeon::spec::to_json(&burgeon::tree_spec(t)),
            Some(Maker::Leaf(l)) => burgeon::spec::to_json(&l.settings),
            Some(Maker::Flower(f)) => burgeon::spec::to_json(&*f.spec),
            _ => serde_json::Value::Null,
        };
        json.to_string()
    }

    /// Returns a column of the tables; those of nodes without a copy.
    fn column(&self, name: &str) -> PyResult<Column> {
        let plant = self.0.plant();
        let owner = || -> Owner { self.0.clone() };
        let (axes, organs) = (&plant.axes, &plant.organs);
        let vector = |f: fn(&Organ) -> DVec3| collect_column(organs.iter().map(move |o| f(o).to_array()));
        Ok(match name {
            "node_position" => Column::from_rows(owner(), &plant.nodes.position),
            "node_radius" => Column::from_rows(owner(), &plant.nodes.radius_m),
            "node_axis" => Column::from_rows(owner(), &plant.nodes.axis),
            "axis_part" => collect_column(axes.iter().map(|a| burgeon::part_of_axis(a.kind))),
            "axis_bearer" => collect_column(axes.iter().map(|a| handle(a.bearer.map(|n| n.raw())))),
            "axis_parent" => {
                let parent = |n: burgeon::plant::NodeId| plant.nodes.axis.get(n.index()).map(|a| a.raw());
                collect_column(axes.iter().map(|a| handle(a.bearer.and_then(parent))))
            }
            "axis_order" => collect_column(axes.iter().map(|a| a.order)),
            "axis_first" => collect_column(axes.iter().map(|a| a.nodes.start)),
            "axis_end" => collect_column(axes.iter().map(|a| a.nodes.end)),
            "axis_length" => Column::new(plant.axis_lengths_m()),
            "axis_angle" => Column::new(plant.axis_angles_deg()),
            "axis_stroke" => collect_column(axes.iter().map(|a| handle(a.source))),
            "organ_part" => collect_column(organs.iter().map(|o| burgeon::part_of_organ(o.kind))),
            "organ_bearer" => collect_column(organs.iter().map(|o| handle(o.bearer.map(|n| n.raw())))),
            "organ_flower" => collect_column(organs.iter().map(|o| handle(o.flower.map(|f| f.raw())))),
            "organ_shape" => collect_column(organs.iter().map(|o| o.shape.raw())),
            "organ_scale" => collect_column(organs.iter().map(|o| o.scale)),
            "organ_position" => vector(|o| o.frame.origin),
            "organ_along" => vector(|o| o.frame.along),
            "organ_normal" => vector(|o| o.frame.normal),
            "organ_area" => Column::new(plant.organ_areas_m2()),
            "organ_stroke" => collect_column(organs.iter().map(|o| handle(o.source))),
            other => return Err(PyKeyError::new_err(format!("a plant has no column {other:?}"))),
        })
    }

    /// Returns the branches up to an order, as JSON, with the paths that name them in edits.
    fn branches(&self, most_order: u32) -> String {
        serde_json::to_string(&burgeon::branch_rows(self.0.plant(), most_order)).unwrap_or_default()
    }

    fn model(&self) -> RawModel {
        RawModel::from_plant(Arc::clone(&self.0))
    }

    /// Returns a coarser copy of the model.
    fn level(&self, py: Python<'_>, level: u32) -> PyResult<RawModel> {
        if level > 6 {
            return Err(beyond("level", level, "0 to 6"));
        }
        let held = &self.0;
        if let Some(lone) = &held.lone {
            let made = compute(py, held.budget, |run| lone.at_level(level, run))?;
            return Ok(RawModel::new(made.map_err(|e| refused(py, &SceneError::from(e)))?));
        }
        let Some(plant) = held.document.plant(held.id) else { return Ok(self.model()) };
        let made = compute(py, held.budget, |run| held.scene.at_level(plant, level, run))?;
        Ok(RawModel::new(made.map_err(|e: SceneError| refused(py, &e))?))
    }

    /// Returns the part, axis and organ of each triangle, for each part of the model.
    fn labels(&self, py: Python<'_>) -> PyResult<Vec<Column>> {
        let held = Arc::clone(&self.0);
        let labels = aside(py, move || burgeon::triangle_labels(held.plant(), held.model(), held.layout()))?;
        Ok(labels.into_iter().map(Column::new).collect())
    }

    /// Returns a drawing of the plant, as a person would draw it: kind and points of each line, and the row of its
    /// axis or organ.
    fn drawing(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, Column, i32)>> {
        let held = &self.0;
        let made =
            compute(py, held.budget, |run| burgeon::drawn((held.plant(), held.model(), held.layout()), run))?;
        let lines = made.map_err(|e| refused(py, &e))?.into_iter();
        let points = |line: &DrawnLine| collect_column(line.points.iter().map(|p| p.to_array()));
        Ok(lines.map(|line| (line.kind.word(), points(&line), line.row)).collect())
    }

    /// Returns the points that a scanner measures.
    fn survey<'py>(&self, py: Python<'py>, scan: Scan) -> PyResult<Bound<'py, PyDict>> {
        let (spec, seed) = scan.spec();
        let held = &self.0;
        let made = compute(py, held.budget, |run| {
            let of = (held.plant(), held.model(), held.layout());
            burgeon::survey(of, &spec, seed, run)
        })?;
        cloud(py, made.map_err(|e| refused(py, &e))?)
    }

    /// Returns the light on each axis and organ: columns, and figures as JSON.
    fn light<'py>(&self, py: Python<'py>, asked: LightAsked) -> PyResult<(Bound<'py, PyDict>, String)> {
        let held = &self.0;
        let made = compute(py, held.budget, |run| {
            let standing = Standing::home(held.name(), held.model());
            let stood = Stood { standing, plant: held.plant(), layout: held.layout() };
            asked.light(&[stood], held.seed(), run)
        })?;
        crate::light::columns(py, made)
    }

    /// Returns the structure as a file, in a format of [`StructureFormat`] by its word.
    fn structure<'py>(
        &self,
        py: Python<'py>,
        format: &str,
        unit: &str,
        up: &str,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let (spec, held) = (axes(unit, up)?, Arc::clone(&self.0));
        let Some(wanted) = StructureFormat::from_word(format) else {
            let known = StructureFormat::ALL.map(StructureFormat::word).join(", ");
            return Err(beyond("format", format!("{format:?}"), &known));
        };
        bytes_of(py, move |bytes| burgeon::write_structure(held.plant(), wanted, &spec, bytes))
    }

    /// Returns the plant after more edits by hand, given as the list of an edits file.
    fn shape(&self, py: Python<'_>, edits: &Bound<'_, PyAny>) -> PyResult<Self> {
        let edits = json_of(edits, "edits")?;
        let edits: Vec<burgeon::shape::HandEdit> = burgeon::spec::through_json::from_text(&edits.to_string())
            .map_err(|e| misread(py, "edits", &e))?;
        for (k, edit) in edits.iter().enumerate() {
            edit.check().map_err(|why| unusable(py, &format!("edits[{k}] ({}): {why}", edit.word())))?;
        }
        let id = self.0.id;
        let edits =
            edits.into_iter().map(|e| burgeon::document::ShapeCommand::Add(Arc::new(e)).for_plant(id));
        self.0.after(py, edits).map(Self)
    }

    /// Returns the plant with other settings; `seeded`: the request gives the seed.
    fn again(&self, py: Python<'_>, asked: Asked<'_>, seeded: bool, day: Option<f64>) -> PyResult<Self> {
        self.0.again(py, &asked, seeded, day).map(Self)
    }

    /// The files of its model by its extension: names and bytes, the model's own first, then its coarser copies.
    fn files<'py>(&self, py: Python<'py>, extension: &str, stem: &str, form: Form) -> PyResult<Written<'py>> {
        crate::write::files(py, &self.0, (extension, stem), form)
    }

    /// Returns the plant on a day: for flowers, and for drawings whose flowers open.
    fn at(&self, py: Python<'_>, day: f64) -> PyResult<Self> {
        self.0.must_have_document(py)?;
        let id = self.0.id;
        let command = match self.0.maker() {
            Some(Maker::Flower(_)) => FlowerCommand::SetDay(day).for_plant(id),
            Some(Maker::Sketch(_)) => SketchCommand::SetDay(Some(day)).for_plant(id),
            _ => {
                let line = format!("a {} has no days: flowers have, and drawings of flowers", self.maker());
                return Err(unusable(py, &line));
            }
        };
        self.0.after(py, [command]).map(Self)
    }

    /// Returns the days from bud to full bloom, and from there to wilted.
    #[getter]
    fn days(&self) -> Option<[f64; 2]> {
        self.0.scene.days(self.0.id, &self.0.document)
    }

    /// Returns the counts of the points of a scanned tree, as JSON.
    #[getter]
    fn found(&self) -> Option<String> {
        Some(self.0.found.as_ref()?.tally.to_string())
    }

    /// Returns its meshing: fineness and sides.
    #[getter]
    fn surface(&self) -> Option<(f64, u32)> {
        let skin = match self.0.maker()? {
            Maker::Sketch(s) => &s.skin,
            Maker::Tree(t) => &t.skin,
            _ => return None,
        };
        Some((skin.detail, skin.sides))
    }

    /// Returns the day of a flower, or of a drawing whose flowers open.
    #[getter]
    fn day(&self) -> Option<f64> {
        match self.0.maker()? {
            Maker::Flower(f) => Some(f.day),
            Maker::Sketch(s) => s.day,
            _ => None,
        }
    }

    /// Returns its place in its document: x, y, z, rotation about +Y in degrees, scale.
    #[getter]
    fn place(&self) -> ([f64; 3], f64, f64) {
        if let Some(found) = &self.0.found {
            return (found.foot.to_array(), 0.0, 1.0);
        }
        let place = self.0.document.plant(self.0.id).map(|p| p.settings().placement).unwrap_or_default();
        (place.position.to_array(), place.yaw_deg, place.scale)
    }

    /// Returns for a drawing: metres for each of its units, and the point of it that is the plant's origin.
    #[getter]
    fn front(&self) -> Option<(f64, [f64; 2])> {
        self.0.shown()?.front.map(|f| (f.metres_per_unit, f.origin.to_array()))
    }

    /// Returns the plant as a project of the Studio.
    fn project<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.0.must_have_document(py)?;
        let held = Arc::clone(&self.0);
        let bytes = aside(py, move || burgeon::document::write_project(&held.document, burgeon::VERSION))?;
        Ok(PyBytes::new(py, &bytes.map_err(|e| unusable(py, &e))?))
    }
}
