//! Meshes: their columns, files and pictures.

use std::sync::Arc;

use burgeon::formats::{ExportSpec, FormatRow, ModelFormat, PngCache, StructureFormat};
use burgeon::glam::{DVec2, DVec3};
use burgeon::mesh::Model;
use burgeon::render::{Background, PictureSpec, Pinhole, View};
use burgeon::{Digest, Report, Seed, Unit, UpAxis};
use pyo3::exceptions::{PyIndexError, PyKeyError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::column::{Column, Owner};
use crate::compute::{aside, compute};
use crate::fault::{beyond, unusable, wrong};
use crate::held::Held;

/// Owner of a model.
#[derive(Clone)]
enum Of {
    Plant(Arc<Held>),
    Own(Arc<Model>),
}

/// Meshes and materials, which never change.
#[pyclass(frozen, module = "burgeon._burgeon")]
pub(crate) struct RawModel(Of);

impl RawModel {
    pub(crate) fn from_plant(plant: Arc<Held>) -> Self {
        Self(Of::Plant(plant))
    }

    pub(crate) fn new(model: Model) -> Self {
        Self(Of::Own(Arc::new(model)))
    }

    pub(crate) fn get(&self) -> &Model {
        match &self.0 {
            Of::Plant(plant) => plant.model(),
            Of::Own(model) => model,
        }
    }

    fn owner(&self) -> Owner {
        match &self.0 {
            Of::Plant(plant) => plant.clone(),
            Of::Own(model) => model.clone(),
        }
    }
}

/// Returns the colours of points, from three bytes each.
pub(crate) fn colours(bytes: &[u8]) -> Vec<[u8; 3]> {
    bytes.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
}

/// Returns the unit and up axis of a file, from their words.
pub(crate) fn axes(unit: &str, up: &str) -> PyResult<ExportSpec> {
    let known = Unit::from_word(unit);
    let unit = known.ok_or_else(|| beyond("unit", format!("{unit:?}"), &Unit::words()))?;
    let known = UpAxis::from_word(up);
    let up = known.ok_or_else(|| beyond("up", format!("{up:?}"), &UpAxis::words()))?;
    Ok(ExportSpec { up, unit })
}

/// Settings of a picture, as Python requests it.
#[derive(FromPyObject)]
pub(crate) struct Look {
    #[pyo3(item)]
    size: (u32, u32),
    #[pyo3(item)]
    view: String,
    #[pyo3(item)]
    azimuth: f64,
    #[pyo3(item)]
    elevation: f64,
    #[pyo3(item)]
    background: String,
    #[pyo3(item)]
    shadow: bool,
    #[pyo3(item)]
    supersample: u32,
    #[pyo3(item)]
    seed: u64,
    #[pyo3(item)]
    camera: Option<Eye>,
    /// Direction towards the sun.
    #[pyo3(item)]
    sun: Option<[f64; 3]>,
    #[pyo3(item)]
    sunshine: f64,
    #[pyo3(item)]
    skylight: f64,
}

/// A calibrated camera, as Python requests it.
#[derive(FromPyObject)]
pub(crate) struct Eye {
    #[pyo3(item)]
    position: [f64; 3],
    #[pyo3(item)]
    right: [f64; 3],
    #[pyo3(item)]
    down: [f64; 3],
    #[pyo3(item)]
    focal: [f64; 2],
    #[pyo3(item)]
    principal: [f64; 2],
}

impl Eye {
    fn view(&self) -> PyResult<View> {
        let camera = Pinhole {
            eye_m: DVec3::from_array(self.position),
            right: DVec3::from_array(self.right),
            down: DVec3::from_array(self.down),
            focal_px: DVec2::from_array(self.focal),
            principal_px: DVec2::from_array(self.principal),
        };
        if !camera.is_sound() {
            return Err(beyond("camera", "one that is not", "finite, with axes at right angles"));
        }
        Ok(View::Pinhole(camera))
    }
}

impl Look {
    fn spec(&self) -> PyResult<PictureSpec> {
        let (width, height) = self.size;
        if !(1..=8192).contains(&width) || !(1..=8192).contains(&height) {
            return Err(beyond("size", format!("{width} x {height}"), "1 to 8192 pixels each way"));
        }
        if !(1..=6).contains(&self.supersample) {
            return Err(beyond("supersample", self.supersample, "1 to 6"));
        }
        let named = match self.view.as_str() {
            "front" => View::Front,
            "three-quarter" => View::ThreeQuarter,
            "side" => View::Side,
            "top" => View::Top,
            "turntable" => View::Turntable { frames: 8 },
            "orbit" => {
                View::Orbit { azimuth: self.azimuth.to_radians(), elevation: self.elevation.to_radians() }
            }
            other => {
                let views = "front, three-quarter, side, top, turntable or orbit";
                return Err(beyond("view", format!("{other:?}"), views));
            }
        };
        let view = self.camera.as_ref().map_or(Ok(named), Eye::view)?;
        if !self.azimuth.is_finite() || !(-85.0..=85.0).contains(&self.elevation) {
            return Err(beyond("elevation", self.elevation, "-85 to 85 deg"));
        }
        let background = match self.background.as_str() {
            "sky" => Background::Sky,
            "transparent" => Background::Transparent,
            "white" => Background::Plain([255; 3]),
            other => {
                let parts = other.strip_prefix('#').filter(|h| h.len() == 6 && h.is_ascii());
                let parts = parts.and_then(|h| u32::from_str_radix(h, 16).ok());
                match parts {
                    Some(rgb) => Background::Plain([16, 8, 0].map(|by| (rgb >> by & 0xff) as u8)),
                    None => {
                        let words = "sky, transparent, white or a colour as #rrggbb";
                        return Err(beyond("background", format!("{other:?}"), words));
                    }
                }
            }
        };
        Ok(PictureSpec {
            width,
            height,
            view,
            background,
            ground_shadow: self.shadow,
            supersample: self.supersample,
            seed: Seed::new(self.seed),
            sun: self.sun.map(DVec3::from_array),
            sunshine: self.sunshine,
            skylight: self.skylight,
            ..PictureSpec::default()
        })
    }
}

#[pymethods]
impl RawModel {
    #[getter]
    fn name(&self) -> &str {
        &self.get().name
    }

    /// Returns for each part: name, row of its material, vertices, triangles.
    fn parts(&self) -> Vec<(String, usize, usize, usize)> {
        let part = |p: &burgeon::mesh::Part| {
            (p.name.clone(), p.material.index(), p.mesh.positions.len(), p.mesh.triangles.len())
        };
        self.get().parts.iter().map(part).collect()
    }

    /// Returns a column of a part, without a copy; empty if the model has none.
    fn column(&self, part: usize, name: &str) -> PyResult<Column> {
        let parts = &self.get().parts;
        let none =
            || PyIndexError::new_err(format!("there is no part {part}: the model has {}", parts.len()));
        let mesh = &parts.get(part).ok_or_else(none)?.mesh;
        let owner = self.owner();
        Ok(match name {
            "positions" => Column::from_rows(owner, &mesh.positions),
            "normals" => Column::from_rows(owner, &mesh.normals),
            "uvs" => Column::from_rows(owner, &mesh.uvs),
            "colors" => Column::from_rows(owner, &mesh.colors),
            "wind" => Column::from_rows(owner, &mesh.wind),
            "pivots" => Column::from_rows(owner, &mesh.pivots),
            "triangles" => Column::from_rows(owner, &mesh.triangles),
            other => return Err(PyKeyError::new_err(format!("a mesh has no column {other:?}"))),
        })
    }

    /// Returns each material as a dict; its textures as RGBA columns or None.
    fn materials<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let material = |m: &burgeon::mesh::Material| {
            let dict = PyDict::new(py);
            dict.set_item("name", &m.name)?;
            dict.set_item("kind", m.kind.word())?;
            dict.set_item("base_color", m.base_color.to_vec())?;
            dict.set_item("roughness", m.roughness)?;
            dict.set_item("translucency", m.translucency)?;
            dict.set_item("double_sided", m.double_sided)?;
            dict.set_item("cut_out", m.alpha == burgeon::mesh::AlphaMode::Mask)?;
            let textures = [
                ("texture", &m.texture),
                ("normal", &m.maps.normal),
                ("orm", &m.maps.orm),
                ("height", &m.maps.height),
                ("through", &m.maps.through),
            ];
            for (name, texture) in textures {
                let column = texture.as_ref().map(|t| {
                    let shape = [t.height as usize, t.width as usize, 4];
                    Py::new(py, Column::from_rows(t.clone(), &t.pixels).shaped(&shape))
                });
                dict.set_item(name, column.transpose()?)?;
            }
            Ok(dict)
        };
        self.get().materials.iter().map(material).collect()
    }

    /// Returns the fingerprint of meshes and materials.
    fn digest(&self, py: Python<'_>) -> PyResult<String> {
        let own = Self(self.0.clone());
        aside(py, move || {
            let mut digest = Digest::new();
            digest.add(own.get());
            digest.hex()
        })
    }

    /// Returns the files of a format by its extension: names and bytes, the model's own first.
    #[pyo3(signature = (extension, stem, unit, up))]
    fn files<'py>(
        &self,
        py: Python<'py>,
        extension: &str,
        stem: &str,
        unit: &str,
        up: &str,
    ) -> PyResult<Vec<(String, Bound<'py, PyBytes>)>> {
        let spec = axes(unit, up)?;
        let format = model_format(extension)?;
        let (own, extension, stem) = (Self(self.0.clone()), extension.to_owned(), stem.to_owned());
        let files = aside(py, move || written(own.get(), format, &extension, &stem, &spec))?;
        let files = files.map_err(|e| unusable(py, &e))?;
        Ok(files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect())
    }

    /// Renders a picture: RGBA bytes, rows from the top.
    fn render(&self, py: Python<'_>, look: Look) -> PyResult<Column> {
        let spec = look.spec()?;
        let drawn = compute(py, 1.0, |run| burgeon::render::render(self.get(), &spec, run))?;
        let picture = drawn.map_err(|e| crate::fault::refused(py, &e))?;
        let shape = [picture.height as usize, picture.width as usize, 4];
        Ok(Column::new(picture.pixels).shaped(&shape))
    }

    /// Renders the colour of the surfaces without light: RGBA bytes, rows from the top.
    fn albedo(&self, py: Python<'_>, look: Look) -> PyResult<Column> {
        let spec = look.spec()?;
        let drawn = compute(py, 1.0, |run| burgeon::render::albedo(self.get(), &spec, run))?;
        let picture = drawn.map_err(|e| crate::fault::refused(py, &e))?;
        let shape = [picture.height as usize, picture.width as usize, 4];
        Ok(Column::new(picture.pixels).shaped(&shape))
    }

    /// Returns for each pixel of a picture: part, triangle (-1 for nothing), distance (infinite for nothing), normal
    /// (0 for nothing).
    fn masks(&self, py: Python<'_>, look: Look) -> PyResult<(Column, Column, Column, Column)> {
        let spec = look.spec()?;
        let seen =
            compute(py, 1.0, |run| burgeon::render::hits(self.get(), std::slice::from_ref(&spec), run))?;
        let seen = seen.map_err(|e| crate::fault::refused(py, &e))?;
        let shape = [spec.height as usize, spec.width as usize];
        let count = shape[0] * shape[1];
        let (mut parts, mut triangles) = (vec![-1_i32; count], vec![-1_i32; count]);
        let mut distances = vec![f32::INFINITY; count];
        let mut normals = vec![[0.0_f32; 3]; count];
        for hit in seen.iter().flatten() {
            let at = hit.pixel as usize;
            parts[at] = i32::try_from(hit.part).unwrap_or(i32::MAX);
            triangles[at] = i32::try_from(hit.triangle).unwrap_or(i32::MAX);
            #[expect(clippy::cast_possible_truncation, reason = "a distance in a mesh of single precision")]
            let distance = hit.distance_m as f32;
            distances[at] = distance;
            normals[at] = hit.normal.as_vec3().to_array();
        }
        let [parts, triangles] = [parts, triangles].map(|c| Column::new(c).shaped(&shape));
        let normals = Column::new(normals).shaped(&[shape[0], shape[1], 3]);
        Ok((parts, triangles, Column::new(distances).shaped(&shape), normals))
    }
}

/// Returns the formats of models and of structure that Burgeon writes: kind, word, extension, and the contents for
/// which their files have room.
#[pyfunction]
pub(crate) fn formats() -> Vec<(&'static str, &'static str, &'static str, Vec<&'static str>)> {
    let models = ModelFormat::ALL.into_iter().map(|f| ("model", f.row()));
    let structures = StructureFormat::ALL.into_iter().map(|f| ("structure", f.row()));
    let written = models.chain(structures).filter(|(_, row)| row.is_written());
    let rooms = |row: &FormatRow| row.holds.iter().map(|room| room.word()).collect();
    written.map(|(kind, row)| (kind, row.word, row.endings[0], rooms(row))).collect()
}

/// Returns the format of a model by its extension.
pub(crate) fn model_format(extension: &str) -> PyResult<ModelFormat> {
    let format = ModelFormat::from_extension(extension).filter(|f| f.row().is_written());
    format.ok_or_else(|| {
        let known = ModelFormat::written_endings();
        let line = format!("models are written as {known}, not .{extension}");
        wrong(&line, "path", &format!(".{extension}"), &known)
    })
}

/// Writes the files of a model: its own, then those that it names.
pub(crate) fn written(
    model: &Model,
    format: ModelFormat,
    extension: &str,
    stem: &str,
    spec: &ExportSpec,
) -> Result<Vec<(String, Vec<u8>)>, burgeon::formats::WriteError> {
    let (cache, report) = (&mut PngCache::new(), &mut Report::default());
    let files = burgeon::formats::model_files(model, format, stem, spec, cache, report)?;
    Ok(files.named(format!("{stem}.{extension}")))
}

/// Returns the bytes of a file, written without Python's lock.
pub(crate) fn bytes_of<E: std::fmt::Display + Send + 'static>(
    py: Python<'_>,
    write: impl FnOnce(&mut Vec<u8>) -> Result<(), E> + Send + 'static,
) -> PyResult<Bound<'_, PyBytes>> {
    let written = aside(py, move || {
        let mut bytes = Vec::new();
        write(&mut bytes).map(|()| bytes)
    })?;
    Ok(PyBytes::new(py, &written.map_err(|e| unusable(py, &e))?))
}

/// Encodes RGBA bytes as a PNG.
#[pyfunction]
pub(crate) fn png<'py>(
    py: Python<'py>,
    width: u32,
    height: u32,
    pixels: &[u8],
) -> PyResult<Bound<'py, PyBytes>> {
    let pixels = pixels.to_vec();
    bytes_of(py, move |bytes| burgeon::formats::write_png(width, height, &pixels, bytes))
}

/// Writes lines (x, y upwards) as an SVG drawing; each lies on the layer of its word.
#[pyfunction]
pub(crate) fn drawing_svg<'py>(
    py: Python<'py>,
    name: &str,
    lines: Vec<(String, Vec<[f64; 2]>)>,
) -> PyResult<Bound<'py, PyBytes>> {
    let lines = lines
        .iter()
        .map(|(word, line)| (word.as_str(), line.iter().map(|p| DVec2::from_array(*p)).collect()));
    let drawing = burgeon::drawing_of(name, lines);
    bytes_of(py, move |bytes| burgeon::formats::write_svg(&drawing, bytes))
}
