//! Sky and sun by the options.

use std::path::Path;

use burgeon::LightUnit;
use burgeon::light::{Beams, LightError, SkyKind, SunPlace, SunPosition, Sunlight};
use serde::Serialize;

use crate::args::{SkyWord, SourceArgs};
use crate::failure::{Failure, Outcome};
use crate::files;

/// The share of the sun's energy that is photosynthetically active: 0.45 to 0.50 by air and season.
const PAR_SHARE: f64 = 0.48;

/// PAR of the sky where nothing is said, W/m2.
const USUAL_DIFFUSE: f64 = 100.0;

/// Parts of an hour in the sum of a day.
const PARTS_OF_HOUR: u32 = 2;

/// Where light comes from, for the report.
#[derive(Debug, Serialize)]
pub(super) struct Sources {
    /// On a horizontal surface, for each square metre.
    direct_per_m2: f64,
    diffuse_per_m2: f64,
    /// `overcast`, `uniform`, `clear` or `measured`.
    sky: &'static str,
    /// Where the sun stands: degrees from north over east, degrees above the horizon.
    sun_azimuth_deg: Option<f64>,
    sun_elevation_deg: Option<f64>,
    /// Hours in the sun, of a day.
    day_hours: Option<f64>,
}

fn refused(e: LightError) -> Failure {
    Failure::Bad(e.to_string())
}

/// All light, and what it is counted in.
pub(super) fn beams(args: &SourceArgs) -> Outcome<(Beams, LightUnit, Sources)> {
    if let Some(path) = &args.sky_table {
        return measured(path);
    }
    if args.date.is_some() && args.place.is_none() {
        return Err(Failure::Bad("--date is for the sun of a place: say --place instead of --sun".into()));
    }
    let turbidity = args.turbidity.unwrap_or(3.0);
    let Some(([latitude_deg, longitude_deg, altitude_m], date)) = args.place.zip(args.date) else {
        let sun = args.sun.map(|[azimuth_deg, elevation_deg]| SunPosition { azimuth_deg, elevation_deg });
        return moment(args, sun, args.direct.unwrap_or(0.0), args.diffuse.unwrap_or(USUAL_DIFFUSE));
    };
    let place = SunPlace { latitude_deg, longitude_deg, altitude_m, date };
    place.check().map_err(|e| Failure::Bad(format!("--date: {e}")))?;
    let zone = args.zone.unwrap_or_else(|| (longitude_deg / 15.0).round());
    if args.daily {
        return day(args, &place, zone, turbidity);
    }
    let hour = args.hour.unwrap_or(12.0) - zone;
    let Sunlight { sun, direct, diffuse } = place.clear(hour, turbidity).map_err(refused)?;
    let direct = args.direct.unwrap_or(PAR_SHARE * direct);
    moment(args, Some(sun), direct, args.diffuse.unwrap_or(PAR_SHARE * diffuse))
}

/// The distribution of the sky.
fn kind(args: &SourceArgs, sun: Option<SunPosition>) -> Outcome<(SkyKind, &'static str)> {
    match (args.sky, sun) {
        (Some(SkyWord::Overcast), _) | (None, None) => Ok((SkyKind::Overcast, "overcast")),
        (Some(SkyWord::Uniform), _) => Ok((SkyKind::Uniform, "uniform")),
        (_, Some(sun)) => Ok((SkyKind::Clear(sun), "clear")),
        (Some(SkyWord::Clear), None) => Err(Failure::Bad(
            "--sky clear is bright around the sun: say where that stands with --sun or --place".into(),
        )),
    }
}

fn moment(
    args: &SourceArgs,
    sun: Option<SunPosition>,
    direct: f64,
    diffuse: f64,
) -> Outcome<(Beams, LightUnit, Sources)> {
    if sun.is_none() && args.direct.is_some() {
        return Err(Failure::Bad(
            "--direct is light of a sun: say where it stands with --sun or --place".into(),
        ));
    }
    let (kind, sky) = kind(args, sun)?;
    let mut beams = Beams::default();
    if let Some(sun) = sun {
        beams.add_sun(sun, direct).map_err(refused)?;
    }
    beams.add_sky(kind, diffuse).map_err(refused)?;
    let sources = Sources {
        direct_per_m2: direct,
        diffuse_per_m2: diffuse,
        sky,
        sun_azimuth_deg: sun.map(|s| s.azimuth_deg),
        sun_elevation_deg: sun.map(|s| s.elevation_deg),
        day_hours: None,
    };
    Ok((beams, LightUnit::Watt, sources))
}

/// A clear day, part by part.
fn day(
    args: &SourceArgs,
    place: &SunPlace,
    zone: f64,
    turbidity: f64,
) -> Outcome<(Beams, LightUnit, Sources)> {
    let mut beams = Beams::default();
    let megajoules = PAR_SHARE * 3600.0 / f64::from(PARTS_OF_HOUR) / 1e6;
    let (mut sums, mut parts, mut sky) = ([0.0; 2], 0.0, "clear");
    for part in 0..24 * PARTS_OF_HOUR {
        let hour = (f64::from(part) + 0.5) / f64::from(PARTS_OF_HOUR) - zone;
        let light = match place.clear(hour, turbidity) {
            Err(LightError::BelowHorizon { .. }) => continue,
            other => other.map_err(refused)?,
        };
        let (kind, word) = kind(args, Some(light.sun))?;
        let [direct, diffuse] = [light.direct, light.diffuse].map(|w| w * megajoules);
        beams.add_sun(light.sun, direct).map_err(refused)?;
        beams.add_sky(kind, diffuse).map_err(refused)?;
        sums = [sums[0] + direct, sums[1] + diffuse];
        parts += 1.0;
        sky = word;
    }
    if parts == 0.0 {
        return Err(Failure::Bad(
            "--date: the sun does not rise there on that day; choose another day".into(),
        ));
    }
    let sources = Sources {
        direct_per_m2: sums[0],
        diffuse_per_m2: sums[1],
        sky,
        sun_azimuth_deg: None,
        sun_elevation_deg: None,
        day_hours: Some(parts / f64::from(PARTS_OF_HOUR)),
    };
    Ok((beams, LightUnit::Megajoule, sources))
}

/// A sky of a table.
fn measured(path: &Path) -> Outcome<(Beams, LightUnit, Sources)> {
    let text = files::read_text(path)?;
    let mut beams = Beams::default();
    let rows =
        text.lines().zip(1..).filter(|(l, _)| !l.trim().is_empty() && !l.trim_start().starts_with('#'));
    for (number, (line, row)) in rows.enumerate() {
        let cells: Vec<&str> = line.split([',', ';', '\t']).map(str::trim).collect();
        let numbers: Option<Vec<f64>> = cells.iter().map(|c| c.parse().ok()).collect();
        let found = match numbers.as_deref() {
            // Names of columns.
            None if number == 0 => continue,
            Some(&[azimuth_deg, elevation_deg, horizontal]) => {
                beams.add_beam(SunPosition { azimuth_deg, elevation_deg }, horizontal)
            }
            _ => {
                let what = "is no row of azimuth, elevation and W/m2, three numbers with commas between them";
                return Err(Failure::at(path, format_args!("line {row} {what}")));
            }
        };
        found.map_err(|e| Failure::at(path, format_args!("line {row}: {e}")))?;
    }
    if beams.horizontal() <= 0.0 {
        return Err(Failure::at(path, "holds no light: give rows of azimuth, elevation and W/m2 above 0"));
    }
    let sources = Sources {
        direct_per_m2: 0.0,
        diffuse_per_m2: beams.horizontal(),
        sky: "measured",
        sun_azimuth_deg: None,
        sun_elevation_deg: None,
        day_hours: None,
    };
    Ok((beams, LightUnit::Watt, sources))
}
