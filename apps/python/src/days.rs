//! Scans of one plant on several days.

use burgeon::bloom::GrowthLaw;
use burgeon::formats::CloudFormat;
use burgeon::glam::DVec3;
use burgeon::mesh::PointCloud;
use burgeon::{Report, ScannedDays, Seed, SeedlingOptions};
use pyo3::prelude::*;

use crate::compute::{aside, compute};
use crate::fault::{beyond, unusable};
use crate::held::Held;
use crate::make::RawLaw;
use crate::model::{axes, colours};
use crate::plant::RawPlant;

/// A scan with its day: the bytes of a file and its name, or points as bytes of `f64`, three each.
#[derive(FromPyObject)]
pub(crate) struct OfDay {
    #[pyo3(item)]
    day: f64,
    #[pyo3(item)]
    file: Option<(Vec<u8>, String)>,
    #[pyo3(item)]
    points: Vec<u8>,
    /// Colours of given points: bytes, three each; empty without colours.
    #[pyo3(item)]
    colors: Vec<u8>,
}

/// Scans of several days, with their organs matched from day to day.
#[pyclass(frozen, module = "burgeon._burgeon")]
pub(crate) struct RawDays {
    name: String,
    days: ScannedDays,
    budget: f64,
}

#[pymethods]
impl RawDays {
    /// Matches scans in the order of their days, in a unit, with an up axis and a texture (`scan`, `plain`);
    /// `single`: each is one organ.
    #[new]
    fn new(
        py: Python<'_>,
        name: String,
        scans: Vec<OfDay>,
        unit_up_texture: (String, String, String),
        single: bool,
        seed: u64,
        budget: f64,
    ) -> PyResult<Self> {
        if !(1.0..=1000.0).contains(&budget) {
            return Err(beyond("budget", budget, "1 to 1000"));
        }
        let (unit, up, texture) = unit_up_texture;
        let spec = axes(&unit, &up)?;
        let mut clouds = Vec::new();
        for scan in scans {
            let mut cloud = match scan.file {
                None => {
                    let number = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_ne_bytes);
                    let row =
                        |row: &[u8]| DVec3::new(number(&row[..8]), number(&row[8..16]), number(&row[16..]));
                    let points = scan.points.chunks_exact(24).map(|r| spec.inward(row(r))).collect();
                    PointCloud { points, colors: colours(&scan.colors), ..PointCloud::default() }
                }
                Some((bytes, file)) => {
                    let extension = file.rsplit('.').next().unwrap_or_default();
                    let format =
                        CloudFormat::from_extension(extension).or_else(|| CloudFormat::sniff(&bytes));
                    let format = format.ok_or_else(|| {
                        unusable(py, &format!("{file}: is no cloud (.xyz, .ply, .pcd, .las)"))
                    })?;
                    let read = aside(py, move || {
                        burgeon::formats::read_cloud(&*bytes, format, &spec, &mut Report::default())
                    })?;
                    read.map_err(|e| unusable(py, &format!("{file}: {e}")))?
                }
            };
            if texture == "plain" {
                cloud.colors.clear();
            }
            clouds.push((scan.day, cloud));
        }
        // All scans get the same offset, so that they keep their relative positions.
        let offset = clouds.first().and_then(|(_, c)| PointCloud::far_offset(&c.points)).unwrap_or_default();
        clouds.iter_mut().flat_map(|(_, c)| &mut c.points).for_each(|p| *p -= offset);
        let made = compute(py, budget, |run| ScannedDays::new(&clouds, single, Seed::new(seed), run))?;
        let days = made.map_err(|e| unusable(py, &format!("{name}: {e}")))?;
        Ok(Self { name, days, budget })
    }

    /// Returns the growth law of the organs.
    fn law(&self, py: Python<'_>) -> PyResult<RawLaw> {
        let law = compute(py, self.budget, |run| self.days.law(&self.name, run))?;
        let law = law.map_err(|e| unusable(py, &format!("{}: {e}", self.name)))?;
        if law.laws.is_empty() {
            return Err(unusable(py, &format!("{}: no organ is there on at least 3 days", self.name)));
        }
        Ok(RawLaw::from_law(law))
    }

    /// Returns the plant on a day; without a law it grows at an even pace.
    fn plant(&self, py: Python<'_>, day: f64, law: Option<PyRef<'_, RawLaw>>) -> PyResult<RawPlant> {
        let law: Option<&GrowthLaw> = law.as_ref().map(|l| l.law());
        let made = compute(py, self.budget, |run| {
            self.days.plant(&self.name, (day, law), &SeedlingOptions::default(), run)
        })?;
        let made = made.map_err(|e| unusable(py, &format!("{}: {e}", self.name)))?;
        Ok(RawPlant(Held::lone(made, None, self.budget)))
    }
}
