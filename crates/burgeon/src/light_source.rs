//! Sky and sun as people describe them: at a moment, on a clear day, or as measured.
//!
//! `LightSourceSpec -> LightSources { beams, unit, figures }`

use light::{Beams, LightError, SkyKind, SunPlace, SunPosition, Sunlight};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::lit::LightUnit;

/// Share of the sun's energy that is photosynthetically active: 0.45 to 0.50, depending on air and season.
const PAR_SHARE: f64 = 0.48;

/// Default PAR of the sky, W/m2.
const USUAL_DIFFUSE: f64 = 100.0;

/// Default turbidity by Linke: clear air.
const USUAL_TURBIDITY: f64 = 3.0;

/// Default hour of the clock.
const NOON: f64 = 12.0;

/// Parts of an hour in the sum of a day.
const PARTS_OF_HOUR: u32 = 2;

/// Distribution of the light of a sky.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SkyShape {
    /// Three times as bright at the zenith as at the horizon (Moon and Spencer 1942).
    Overcast,
    /// The same everywhere.
    Uniform,
    /// Bright around the sun (CIE S 011, type 12).
    Clear,
}

base::words!(SkyShape { Overcast = "overcast", Uniform = "uniform", Clear = "clear" });

/// A place on earth on a day.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceOnDay {
    /// Place and day.
    pub place: SunPlace,
    /// The hour by the clock, 0 to 24; none: noon.
    pub hour: Option<f64>,
    /// Hours by which the clock is ahead of universal time; none: the longitude over 15, rounded.
    pub zone: Option<f64>,
    /// Linke's turbidity, 1 to 10; none: 3.
    pub turbidity: Option<f64>,
    /// Whether to sum over the day instead of an hour.
    pub daily: bool,
}

/// Sources of light. Irradiances are of photosynthetically active radiation (PAR) on a horizontal surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightSourceSpec {
    /// Distribution of the sky; none: overcast, or clear with a sun.
    pub sky: Option<SkyShape>,
    /// PAR of the sky, W/m2; none: 100, or that of a clear sky at a place.
    pub diffuse: Option<f64>,
    /// PAR of the sun, W/m2; none: 0, or that of a clear sky at a place.
    pub direct: Option<f64>,
    /// Position of the sun, unless a place gives it.
    pub sun: Option<SunPosition>,
    /// Place and day that give the position of the sun.
    pub place: Option<PlaceOnDay>,
}

/// Reason why there is no light.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LightSourceError {
    /// A clear sky without a sun.
    #[error(
        "a clear sky is bright around the sun: say where that stands, by its direction or by a place and a day"
    )]
    ClearWithoutSun,
    /// Direct light without a sun.
    #[error(
        "direct light is light of a sun: say where that stands, by its direction or by a place and a day"
    )]
    DirectWithoutSun,
    /// Polar night.
    #[error("the sun does not rise there on that day: choose another day")]
    NoSunrise,
    /// The place or the day is invalid.
    #[error("{0}")]
    Place(LightError),
    /// The beams are invalid.
    #[error(transparent)]
    Light(#[from] LightError),
}

/// Sources of light, for reports.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SourceFigures {
    /// Light of the sun on a horizontal surface, for each square metre.
    pub direct_per_m2: f64,
    /// Light of the sky on a horizontal surface, for each square metre.
    pub diffuse_per_m2: f64,
    /// `overcast`, `uniform`, `clear` or `measured`.
    pub sky: &'static str,
    /// Azimuth of the sun: degrees from north over east.
    pub sun_azimuth_deg: Option<f64>,
    /// Elevation of the sun, degrees above the horizon.
    pub sun_elevation_deg: Option<f64>,
    /// Hours of sunshine, for a day.
    pub day_hours: Option<f64>,
}

/// All light, and its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct LightSources {
    /// Sky and suns.
    pub beams: Beams,
    /// Watts at a moment, megajoules for a day.
    pub unit: LightUnit,
    /// Figures for reports.
    pub figures: SourceFigures,
}

base::coded!(LightSourceError {
    Self::ClearWithoutSun => "clear-without-sun" {},
    Self::DirectWithoutSun => "direct-without-sun" {},
    Self::NoSunrise => "no-sunrise" {},
} wraps {
    Self::Place(e) => e, LightError;
    Self::Light(e) => e, LightError;
});

impl LightSources {
    /// Makes the light of sky and sun.
    ///
    /// # Errors
    /// [`LightSourceError`].
    pub fn new(spec: &LightSourceSpec) -> Result<Self, LightSourceError> {
        let Some(there) = &spec.place else {
            return moment(spec, spec.sun, spec.direct.unwrap_or(0.0), spec.diffuse.unwrap_or(USUAL_DIFFUSE));
        };
        there.place.check().map_err(LightSourceError::Place)?;
        if there.daily {
            return clear_day(spec, there);
        }
        let hour = there.hour.unwrap_or(NOON) - there.zone_hours();
        let Sunlight { sun, direct, diffuse } = there.place.clear(hour, there.air())?;
        let direct = spec.direct.unwrap_or(PAR_SHARE * direct);
        moment(spec, Some(sun), direct, spec.diffuse.unwrap_or(PAR_SHARE * diffuse))
    }

    /// Makes a sky as it was measured: directions (azimuth, elevation), each with the PAR on a horizontal surface from
    /// there, W/m2.
    ///
    /// # Errors
    /// [`LightSourceError::Light`]: light from below, numbers out of range, or none above 0.
    pub fn measured(beams: impl IntoIterator<Item = (SunPosition, f64)>) -> Result<Self, LightSourceError> {
        let mut all = Beams::default();
        beams.into_iter().try_for_each(|(from, horizontal)| all.add_beam(from, horizontal))?;
        Self::from_measured(all)
    }

    /// Makes the same of beams that were added one by one.
    ///
    /// # Errors
    /// [`LightError::Dark`].
    pub fn from_measured(beams: Beams) -> Result<Self, LightSourceError> {
        if beams.horizontal() <= 0.0 {
            return Err(LightError::Dark.into());
        }
        let figures = SourceFigures {
            direct_per_m2: 0.0,
            diffuse_per_m2: beams.horizontal(),
            sky: "measured",
            sun_azimuth_deg: None,
            sun_elevation_deg: None,
            day_hours: None,
        };
        Ok(Self { beams, unit: LightUnit::Watt, figures })
    }
}

impl PlaceOnDay {
    fn zone_hours(&self) -> f64 {
        self.zone.unwrap_or_else(|| (self.place.longitude_deg / 15.0).round())
    }

    fn air(&self) -> f64 {
        self.turbidity.unwrap_or(USUAL_TURBIDITY)
    }
}

/// Returns the distribution of the sky.
fn kind(
    spec: &LightSourceSpec,
    sun: Option<SunPosition>,
) -> Result<(SkyKind, &'static str), LightSourceError> {
    match (spec.sky, sun) {
        (Some(SkyShape::Overcast), _) | (None, None) => Ok((SkyKind::Overcast, "overcast")),
        (Some(SkyShape::Uniform), _) => Ok((SkyKind::Uniform, "uniform")),
        (_, Some(sun)) => Ok((SkyKind::Clear(sun), "clear")),
        (Some(SkyShape::Clear), None) => Err(LightSourceError::ClearWithoutSun),
    }
}

fn moment(
    spec: &LightSourceSpec,
    sun: Option<SunPosition>,
    direct: f64,
    diffuse: f64,
) -> Result<LightSources, LightSourceError> {
    if sun.is_none() && spec.direct.is_some() {
        return Err(LightSourceError::DirectWithoutSun);
    }
    let (kind, sky) = kind(spec, sun)?;
    let mut beams = Beams::default();
    if let Some(sun) = sun {
        beams.add_sun(sun, direct)?;
    }
    beams.add_sky(kind, diffuse)?;
    let figures = SourceFigures {
        direct_per_m2: direct,
        diffuse_per_m2: diffuse,
        sky,
        sun_azimuth_deg: sun.map(|s| s.azimuth_deg),
        sun_elevation_deg: sun.map(|s| s.elevation_deg),
        day_hours: None,
    };
    Ok(LightSources { beams, unit: LightUnit::Watt, figures })
}

/// Makes a clear day, part by part.
fn clear_day(spec: &LightSourceSpec, there: &PlaceOnDay) -> Result<LightSources, LightSourceError> {
    let mut beams = Beams::default();
    let megajoules = PAR_SHARE * 3600.0 / f64::from(PARTS_OF_HOUR) / 1e6;
    let (mut sums, mut parts, mut sky) = ([0.0; 2], 0.0, "clear");
    for part in 0..24 * PARTS_OF_HOUR {
        let hour = (f64::from(part) + 0.5) / f64::from(PARTS_OF_HOUR) - there.zone_hours();
        let light = match there.place.clear(hour, there.air()) {
            Err(LightError::BelowHorizon { .. }) => continue,
            other => other?,
        };
        let (kind, word) = kind(spec, Some(light.sun))?;
        let [direct, diffuse] = [light.direct, light.diffuse].map(|w| w * megajoules);
        beams.add_sun(light.sun, direct)?;
        beams.add_sky(kind, diffuse)?;
        sums = [sums[0] + direct, sums[1] + diffuse];
        parts += 1.0;
        sky = word;
    }
    if parts == 0.0 {
        return Err(LightSourceError::NoSunrise);
    }
    let figures = SourceFigures {
        direct_per_m2: sums[0],
        diffuse_per_m2: sums[1],
        sky,
        sun_azimuth_deg: None,
        sun_elevation_deg: None,
        day_hours: Some(parts / f64::from(PARTS_OF_HOUR)),
    };
    Ok(LightSources { beams, unit: LightUnit::Megajoule, figures })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moment_has_the_light_that_was_asked_for() {
        let usual = LightSources::new(&LightSourceSpec::default()).expect("light");
        assert!((usual.beams.horizontal() - 100.0).abs() < 1e-9);
        let sun = SunPosition { azimuth_deg: 180.0, elevation_deg: 45.0 };
        let asked = LightSourceSpec {
            sun: Some(sun),
            direct: Some(200.0),
            diffuse: Some(60.0),
            ..LightSourceSpec::default()
        };
        let both = LightSources::new(&asked).expect("light");
        assert!((both.beams.horizontal() - 260.0).abs() < 1e-9);
        assert_eq!(both.figures.sky, "clear");
    }

    #[test]
    fn light_without_a_sun_says_what_is_missing() {
        let direct = LightSourceSpec { direct: Some(1.0), ..LightSourceSpec::default() };
        assert_eq!(LightSources::new(&direct), Err(LightSourceError::DirectWithoutSun));
        let clear = LightSourceSpec { sky: Some(SkyShape::Clear), ..LightSourceSpec::default() };
        assert_eq!(LightSources::new(&clear), Err(LightSourceError::ClearWithoutSun));
        let night =
            SunPlace { latitude_deg: 80.0, longitude_deg: 0.0, altitude_m: 0.0, date: [2026, 12, 21] };
        let there = PlaceOnDay { place: night, hour: None, zone: None, turbidity: None, daily: true };
        let spec = LightSourceSpec { place: Some(there), ..LightSourceSpec::default() };
        assert_eq!(LightSources::new(&spec), Err(LightSourceError::NoSunrise));
        assert_eq!(LightSources::measured([]), Err(LightError::Dark.into()));
    }
}
