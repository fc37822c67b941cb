//! Plants that stand together: their places, their meshes, their cloud.

use std::sync::Arc;

use burgeon::document::Placement;
use burgeon::formats::{PngCache, WriteError, gltf_files, write_glb_scene};
use burgeon::glam::DVec3;
use burgeon::mesh::Standing;
use burgeon::{PotSpec, SceneSite, SceneSiteSpec, Seed, Stood};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::column::Column;
use crate::compute::{aside, compute};
use crate::fault::{beyond, refused, unusable, wrong};
use crate::held::Held;
use crate::light::LightAsked;
use crate::model::{RawModel, model_format};
use crate::plant::{RawPlant, Scan, cloud};

/// Most plants of a stand that a scanner measures at once.
const MOST: usize = 2000;

/// Plants, and the places of their copies.
#[pyclass(frozen, module = "burgeon._burgeon")]
#[derive(Clone)]
pub(crate) struct RawGrove {
    plants: Vec<Arc<Held>>,
    /// Rows of the plants, and the place of each.
    stand: Vec<(usize, Placement)>,
    /// Ground of the plants.
    site: Option<Arc<SceneSite>>,
}

/// Ground of plants, as Python requests it.
#[derive(FromPyObject)]
pub(crate) struct Ground {
    #[pyo3(item)]
    soil: [f64; 2],
    #[pyo3(item)]
    relief: f64,
    #[pyo3(item)]
    stones: u32,
    #[pyo3(item)]
    stone_size: f64,
    /// Centre of the soil, radius, height.
    #[pyo3(item)]
    pots: Vec<([f64; 3], f64, f64)>,
    #[pyo3(item)]
    seed: u64,
}

impl Ground {
    fn site(&self, py: Python<'_>) -> PyResult<SceneSite> {
        let pot = |&(at, radius_m, height_m): &([f64; 3], f64, f64)| PotSpec {
            soil_m: DVec3::from_array(at),
            radius_m,
            height_m,
        };
        let spec = SceneSiteSpec {
            soil_m: self.soil,
            relief_m: self.relief,
            stones: self.stones,
            stone_m: self.stone_size,
            pots: self.pots.iter().map(pot).collect(),
        };
        burgeon::make_site(&spec, Seed::new(self.seed)).map_err(|e| refused(py, &e))
    }
}

/// Returns places in a rectangle `width` by `depth` metres around the origin: x, z, yaw in degrees, scale.
#[pyfunction]
pub(crate) fn places(
    area: (f64, f64),
    spacing: f64,
    vary: f64,
    seed: u64,
) -> PyResult<Vec<(f64, f64, f64, f64)>> {
    let (width, depth) = area;
    let fields = [
        ("area[0]", width, 0.1, 1000.0),
        ("area[1]", depth, 0.1, 1000.0),
        ("spacing", spacing, 0.05, 100.0),
        ("vary", vary, 0.0, 0.9),
    ];
    for (name, value, least, most) in fields {
        if !(least..=most).contains(&value) {
            return Err(beyond(name, value, &format!("{least} to {most}")));
        }
    }
    let (x, z) = (0.5 * width, 0.5 * depth);
    let outline = [[-x, -z], [x, -z], [x, z], [-x, z]];
    let found = workspace::stand(&outline, spacing, vary, MOST + 1, Seed::new(seed));
    if found.len() > MOST {
        let line = format!("a grove has at most {MOST} plants: give more spacing, or less area");
        return Err(wrong(&line, "spacing", &spacing.to_string(), "more"));
    }
    Ok(found.into_iter().map(|p| (p.position.x, p.position.z, p.yaw_deg, p.scale)).collect())
}

impl RawGrove {
    fn standing(&self) -> Vec<Standing<'_>> {
        let plants = self.plants_standing();
        let site = self.site.iter().map(|site| Standing::home("site", &site.model));
        plants.chain(site).collect()
    }

    fn plants_standing(&self) -> impl Iterator<Item = Standing<'_>> {
        self.stand.iter().filter_map(|(row, place)| {
            let held = self.plants.get(*row)?;
            Some(burgeon::standing_at(held.name(), held.model(), place))
        })
    }
}

impl RawGrove {
    /// Returns the plants in their places.
    fn stood(&self) -> Vec<Stood<'_>> {
        let stood = self.plants_standing().zip(&self.stand).filter_map(|(standing, (row, _))| {
            let held = self.plants.get(*row)?;
            Some(Stood { standing, plant: held.plant(), layout: held.layout() })
        });
        stood.collect()
    }
}

#[pymethods]
impl RawGrove {
    /// Puts plants into their places. `stand`: row of the plant, x, y, z, yaw in degrees, scale.
    #[new]
    #[pyo3(signature = (plants, stand, ground))]
    fn new(
        py: Python<'_>,
        plants: Vec<PyRef<'_, RawPlant>>,
        stand: Vec<(usize, [f64; 3], f64, f64)>,
        ground: Option<Ground>,
    ) -> PyResult<Self> {
        if stand.is_empty() || stand.len() > MOST {
            return Err(beyond("places", format!("{} rows", stand.len()), &format!("1 to {MOST} rows")));
        }
        let plants: Vec<Arc<Held>> = plants.iter().map(|p| Arc::clone(&p.0)).collect();
        let place = |(k, (row, at, yaw_deg, scale)): (usize, (usize, [f64; 3], f64, f64))| {
            let sound = at.iter().chain([&yaw_deg, &scale]).all(|x| x.is_finite()) && scale > 0.0;
            if row >= plants.len() || !sound {
                let told = format!("plant {row} at {at:?}, turned {yaw_deg}, scale {scale}");
                let range = "finite numbers, a scale above 0, and a plant that is there";
                return Err(beyond(&format!("places[{k}]"), told, range));
            }
            Ok((row, Placement { position: DVec3::from_array(at), yaw_deg, scale }))
        };
        let stand = stand.into_iter().enumerate().map(place).collect::<PyResult<_>>()?;
        let site = ground.map(|ground| ground.site(py)).transpose()?.map(Arc::new);
        Ok(Self { plants, stand, site })
    }

    /// Returns the labels of the model's last parts, which belong to no plant, as numbers in the list of parts.
    fn site_labels(&self) -> Vec<u8> {
        self.site.as_ref().map_or_else(Vec::new, |site| site.labels.clone())
    }

    /// Returns the number of triangles of each part of the model that belongs to no plant.
    fn site_triangles(&self) -> Vec<usize> {
        let parts = self.site.iter().flat_map(|site| &site.model.parts);
        parts.map(|part| part.mesh.triangles.len()).collect()
    }

    /// Returns the light on each axis and organ: columns, and figures as JSON.
    fn light<'py>(&self, py: Python<'py>, asked: LightAsked) -> PyResult<(Bound<'py, PyDict>, String)> {
        let made = compute(py, 1.0, |run| {
            let stood = self.stood();
            asked.light(&stood, Seed::new(1), run)
        })?;
        crate::light::columns(py, made)
    }

    /// Returns all of it as one model.
    fn model(&self, py: Python<'_>, name: &str) -> PyResult<RawModel> {
        let (own, name) = (self.clone(), name.to_owned());
        aside(py, move || RawModel::new(burgeon::scene_model(&name, &own.standing())))
    }

    /// Returns the files of a format in which copies share their meshes: names and bytes, the model's own first.
    fn files<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        extension: &str,
        stem: &str,
    ) -> PyResult<Vec<(String, Bound<'py, PyBytes>)>> {
        let format = model_format(extension)?;
        let (own, name) = (self.clone(), name.to_owned());
        let (file, stem) = (format!("{stem}.{extension}"), stem.to_owned());
        let files = aside(py, move || {
            let mut glb = Vec::new();
            write_glb_scene(&name, &own.standing(), &mut PngCache::new(), &mut glb)?;
            Ok::<_, WriteError>(gltf_files(glb, format, &stem[..])?.named(file))
        })?;
        let files = files.map_err(|e| unusable(py, &e))?;
        Ok(files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect())
    }

    /// Returns the points that a scanner around all of it measures; `tree` is the place.
    fn survey<'py>(&self, py: Python<'py>, scan: Scan) -> PyResult<Bound<'py, PyDict>> {
        let (spec, seed) = scan.spec();
        let made = compute(py, 1.0, |run| {
            burgeon::survey_stand(&self.stood(), self.site.as_deref(), &spec, (seed, run))
        })?;
        let (seen, trees) = made.map_err(|e| refused(py, &e))?;
        let dict = cloud(py, seen)?;
        dict.set_item("tree", Py::new(py, Column::new(trees))?)?;
        Ok(dict)
    }
}
