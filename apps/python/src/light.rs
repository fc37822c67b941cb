//! Light on plants: requests, and the table of results.

use burgeon::light::{LightError, LightSpec, Optics, SunPlace, SunPosition};
use burgeon::{
    LightFigures, LightOptions, LightSourceError, LightSourceSpec, LightSources, LitStand, PlaceOnDay,
    Report, Run, Seed, SkyShape, SourceFigures, Stood, light_stand,
};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

use crate::column::Column;
use crate::fault::{refused, unusable};

/// Lighting of plants, as Python requests it; None stands for the default of the command line.
#[derive(FromPyObject)]
pub(crate) struct LightAsked {
    #[pyo3(item)]
    sky: Option<String>,
    #[pyo3(item)]
    diffuse: Option<f64>,
    #[pyo3(item)]
    direct: Option<f64>,
    /// Azimuth and elevation of the sun, degrees.
    #[pyo3(item)]
    sun: Option<[f64; 2]>,
    /// Latitude and longitude in degrees, metres above the sea.
    #[pyo3(item)]
    place: Option<[f64; 3]>,
    #[pyo3(item)]
    date: Option<[u32; 3]>,
    #[pyo3(item)]
    hour: Option<f64>,
    #[pyo3(item)]
    zone: Option<f64>,
    #[pyo3(item)]
    turbidity: Option<f64>,
    #[pyo3(item)]
    daily: bool,
    /// Rows of azimuth, elevation and PAR on a horizontal surface.
    #[pyo3(item)]
    sky_table: Option<Vec<[f64; 3]>>,
    #[pyo3(item)]
    repeat: Option<[f64; 2]>,
    #[pyo3(item)]
    leaf: Option<[f64; 2]>,
    #[pyo3(item)]
    wood: Option<f64>,
    #[pyo3(item)]
    soil: Option<f64>,
    #[pyo3(item)]
    bounces: Option<u32>,
    #[pyo3(item)]
    rays: Option<u32>,
}

/// Light on plants, with its warnings.
pub(crate) struct Lit {
    stand: LitStand,
    sources: SourceFigures,
    report: Report,
}

/// Figures of the stand and of the light.
#[derive(Serialize)]
struct Figures<'a> {
    #[serde(flatten)]
    stand: &'a LightFigures,
    #[serde(flatten)]
    sources: &'a SourceFigures,
    warnings: Vec<String>,
}

impl LightAsked {
    fn sources(&self) -> Result<LightSources, LightSourceError> {
        if let Some(rows) = &self.sky_table {
            let beam = |&[azimuth_deg, elevation_deg, horizontal]: &[f64; 3]| {
                (SunPosition { azimuth_deg, elevation_deg }, horizontal)
            };
            return LightSources::measured(rows.iter().map(beam));
        }
        let sun = self.sun.map(|[azimuth_deg, elevation_deg]| SunPosition { azimuth_deg, elevation_deg });
        let place = self.place.zip(self.date).map(|([latitude_deg, longitude_deg, altitude_m], date)| {
            let place = SunPlace { latitude_deg, longitude_deg, altitude_m, date };
            let (hour, zone, turbidity) = (self.hour, self.zone, self.turbidity);
            PlaceOnDay { place, hour, zone, turbidity, daily: self.daily }
        });
        let sky = self.sky.as_deref().and_then(SkyShape::from_word);
        LightSources::new(&LightSourceSpec { sky, diffuse: self.diffuse, direct: self.direct, sun, place })
    }

    fn spec(&self, usual: LightSpec) -> LightSpec {
        LightSpec {
            lines: self.rays.unwrap_or(usual.lines),
            bounces: self.bounces.unwrap_or(usual.bounces),
            soil_reflectance: self.soil.unwrap_or(usual.soil_reflectance),
            repeat_m: self.repeat,
            ..usual
        }
    }

    /// Computes the light that the plants absorb.
    pub(crate) fn light(
        &self,
        stand: &[Stood<'_>],
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<Lit, LightSourceError> {
        let LightSources { beams, unit, figures: sources } = self.sources()?;
        let usual = LightOptions::new(beams);
        let leaf = self.leaf.map(|[reflectance, transmittance]| Optics { reflectance, transmittance });
        let wood = self.wood.map(|reflectance| Optics { reflectance, transmittance: 0.0 });
        let options = LightOptions {
            unit,
            spec: self.spec(usual.spec),
            leaf: leaf.unwrap_or(usual.leaf),
            wood: wood.unwrap_or(usual.wood),
            ..usual
        };
        let mut report = Report::default();
        let stand = light_stand(stand, &options, (seed, run), &mut report)?;
        Ok(Lit { stand, sources, report })
    }
}

fn failed(py: Python<'_>, error: &LightSourceError) -> PyErr {
    match error {
        LightSourceError::Light(LightError::Cancelled(_)) => PyKeyboardInterrupt::new_err("stopped"),
        LightSourceError::Light(LightError::OverBudget(much)) => refused(py, much),
        LightSourceError::Light(LightError::Range(range))
        | LightSourceError::Place(LightError::Range(range)) => refused(py, range),
        other => unusable(py, other),
    }
}

/// Returns the table's columns, a row for each axis and organ with a surface, and the figures as JSON.
pub(crate) fn columns<'py>(
    py: Python<'py>,
    made: Result<Lit, LightSourceError>,
) -> PyResult<(Bound<'py, PyDict>, String)> {
    let Lit { stand, sources, report } = made.map_err(|e| failed(py, &e))?;
    let dark =
        report.checks.iter().find(|check| !check.holds() && check.severity == burgeon::Severity::Error);
    if let Some(check) = dark {
        return Err(unusable(py, &format_args!("{}: {}", check.message, check.advice)));
    }
    let dict = PyDict::new(py);
    let put = |name: &str, column: Column| dict.set_item(name, Py::new(py, column)?);
    let organs = &stand.organs;
    let incoming = stand.figures.incoming_per_m2;
    let per_area = |value: fn(&burgeon::light::ReceiverLight) -> f64| {
        organs.iter().map(move |o| value(&o.light) / o.light.area_m2)
    };
    put("plant", Column::new(organs.iter().map(|o| o.plant).collect()))?;
    put("part", Column::new(organs.iter().map(|o| o.part).collect()))?;
    put("row", Column::new(organs.iter().map(|o| o.row).collect()))?;
    put("axis", Column::new(organs.iter().map(|o| o.axis).collect()))?;
    put("order", Column::new(organs.iter().map(|o| o.order).collect()))?;
    put("area", Column::new(organs.iter().map(|o| o.light.area_m2).collect()))?;
    put("height", Column::new(organs.iter().map(|o| o.light.height_m).collect()))?;
    put("incident", Column::new(per_area(|l| l.incident_w).collect()))?;
    put("absorbed", Column::new(per_area(|l| l.absorbed_w).collect()))?;
    put("fapar", Column::new(per_area(|l| l.absorbed_w).map(|w| w / incoming).collect()))?;
    put("sunlit", Column::new(organs.iter().map(|o| o.light.sunlit.unwrap_or(f64::NAN)).collect()))?;
    #[expect(clippy::cast_precision_loss, reason = "counts of lines are far below 2^53")]
    put("lines", Column::new(organs.iter().map(|o| o.light.crossings as f64).collect()))?;
    let warnings = report.checks.iter().filter(|check| !check.holds());
    let warnings = warnings.map(|check| format!("{}: {}", check.message, check.advice)).collect();
    let figures = Figures { stand: &stand.figures, sources: &sources, warnings };
    let json = serde_json::to_string(&figures).map_err(|e| unusable(py, &e))?;
    Ok((dict, json))
}
