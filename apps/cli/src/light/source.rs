//! Sky and sun by the options.

use std::path::Path;

use burgeon::light::{Beams, LightError, SunPlace, SunPosition};
use burgeon::{LightSourceError, LightSourceSpec, LightSources, PlaceOnDay, SkyShape};

use crate::args::{SkyWord, SourceArgs};
use crate::failure::{Failure, Outcome};
use crate::files;

/// Returns all light, and its unit.
pub(super) fn sources(args: &SourceArgs) -> Outcome<LightSources> {
    if let Some(path) = &args.sky_table {
        return measured(path);
    }
    if args.date.is_some() && args.place.is_none() {
        return Err(Failure::Bad("--date is for the sun of a place: say --place instead of --sun".into()));
    }
    let sun = args.sun.map(|[azimuth_deg, elevation_deg]| SunPosition { azimuth_deg, elevation_deg });
    let place = args.place.zip(args.date).map(|([latitude_deg, longitude_deg, altitude_m], date)| {
        let place = SunPlace { latitude_deg, longitude_deg, altitude_m, date };
        let (hour, zone, turbidity) = (args.hour, args.zone, args.turbidity);
        PlaceOnDay { place, hour, zone, turbidity, daily: args.daily }
    });
    let sky = args.sky.map(shape);
    let spec = LightSourceSpec { sky, diffuse: args.diffuse, direct: args.direct, sun, place };
    LightSources::new(&spec).map_err(|e| Failure::Bad(in_options(&e)))
}

fn shape(word: SkyWord) -> SkyShape {
    match word {
        SkyWord::Overcast => SkyShape::Overcast,
        SkyWord::Uniform => SkyShape::Uniform,
        SkyWord::Clear => SkyShape::Clear,
    }
}

/// Returns the message of an error, with the names of the options.
fn in_options(error: &LightSourceError) -> String {
    match error {
        LightSourceError::ClearWithoutSun => {
            "--sky clear is bright around the sun: say where that stands with --sun or --place".into()
        }
        LightSourceError::DirectWithoutSun => {
            "--direct is light of a sun: say where it stands with --sun or --place".into()
        }
        LightSourceError::NoSunrise | LightSourceError::Place(_) => format!("--date: {error}"),
        LightSourceError::Light(_) => error.to_string(),
    }
}

/// Reads a sky of a table.
fn measured(path: &Path) -> Outcome<LightSources> {
    let text = files::read_text(path)?;
    let mut beams = Beams::default();
    let rows =
        text.lines().zip(1..).filter(|(l, _)| !l.trim().is_empty() && !l.trim_start().starts_with('#'));
    for (number, (line, row)) in rows.enumerate() {
        let cells: Vec<&str> = line.split([',', ';', '\t']).map(str::trim).collect();
        let numbers: Option<Vec<f64>> = cells.iter().map(|c| c.parse().ok()).collect();
        let found = match numbers.as_deref() {
            // The first row may hold the names of columns.
            None if number == 0 => continue,
            Some(&[azimuth_deg, elevation_deg, horizontal]) => {
                beams.add_beam(SunPosition { azimuth_deg, elevation_deg }, horizontal)
            }
            _ => {
                let what = "is no row of azimuth, elevation and W/m2, three numbers with commas between them";
                return Err(Failure::bad_file(path, format_args!("line {row} {what}")));
            }
        };
        found.map_err(|e| Failure::bad_file(path, format_args!("line {row}: {e}")))?;
    }
    LightSources::from_measured(beams).map_err(|e| match e {
        LightSourceError::Light(LightError::Dark) => {
            Failure::bad_file(path, "holds no light: give rows of azimuth, elevation and W/m2 above 0")
        }
        other => Failure::bad_file(path, other),
    })
}
