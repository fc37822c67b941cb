//! Settings of a scan of plants, what its points are labelled with, and why there is none.

use base::Cancelled;
use glam::DVec3;
use render::{PictureSpec, View};
use spec::RangeFault;

/// Settings for scanning a plant.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveySpec {
    /// Number of points, 1 to 5 million. Fewer are returned only where the beams meet the plant less often.
    pub points: u32,
    /// Number of places of the scanner, evenly around the plant, 1 to 64. Not read with a path.
    pub stations: u32,
    /// Elevation of the scanner above the horizon of the plant's middle, degrees, -80 to 80. Not read with a path.
    pub elevation_deg: f64,
    /// Standard deviation of the distance along each beam, metres, 0 to 1.
    pub noise_m: f64,
    /// Divergence of a beam, from edge to edge, milliradians, 0 to 50. A beam of 0 is a line.
    pub beam_mrad: f64,
    /// Surfaces of one beam nearer to one another than this give one echo between them, metres, 0 to 5. Not read for
    /// beams of 0.
    pub pulse_m: f64,
    /// The way of a scanner on the move, metres: none for one that stands, or 2 to 256 points. It moves at a constant
    /// speed, and its mirror turns in planes across its way.
    pub path: Vec<DVec3>,
}

impl Default for SurveySpec {
    fn default() -> Self {
        Self {
            points: 20_000,
            stations: 4,
            elevation_deg: 5.0,
            noise_m: 0.0,
            beam_mrad: 0.0,
            pulse_m: 0.25,
            path: Vec::new(),
        }
    }
}

/// Farthest that a point of a path may be from the origin, metres: beyond, single precision of meshes is coarse.
const FARTHEST_M: f64 = 1e5;

impl SurveySpec {
    pub(crate) fn check(&self) -> Result<(), RangeFault> {
        let fields = [
            ("points", f64::from(self.points), [1.0, 5e6], ""),
            ("stations", f64::from(self.stations), [1.0, 64.0], ""),
            ("elevation_deg", self.elevation_deg, [-80.0, 80.0], "deg"),
            ("noise_m", self.noise_m, [0.0, 1.0], "m"),
            ("beam_mrad", self.beam_mrad, [0.0, 50.0], "mrad"),
            ("pulse_m", self.pulse_m, [0.0, 5.0], "m"),
            ("length of path", self.path.len() as f64, self.path_bounds(), "points"),
        ];
        let out = |(_, value, [least, most], _): &(_, f64, [f64; 2], _)| !(*least..=*most).contains(value);
        let fault = |(path, value, [least, most], unit): (String, f64, [f64; 2], &'static str)| {
            let (least, most, above) = (Some(least), Some(most), None);
            Err(RangeFault { path, value, least, most, above, unit })
        };
        if let Some((path, value, bounds, unit)) = fields.into_iter().find(out) {
            return fault((path.into(), value, bounds, unit));
        }
        let places = self.path.iter().enumerate().flat_map(|(row, p)| {
            let place =
                move |(k, value)| (format!("path[{row}][{k}]"), value, [-FARTHEST_M, FARTHEST_M], "m");
            p.to_array().into_iter().enumerate().map(place)
        });
        places
            .into_iter()
            .find(|(_, value, [least, most], _)| !(*least..=*most).contains(value))
            .map_or(Ok(()), fault)
    }

    fn path_bounds(&self) -> [f64; 2] {
        if self.path.is_empty() { [0.0, 0.0] } else { [2.0, 256.0] }
    }

    /// Whether each beam is followed by itself, not as a pixel of a picture.
    pub(crate) fn is_traced(&self) -> bool {
        self.beam_mrad > 0.0 || !self.path.is_empty()
    }

    /// Returns the views of all stations with `pixels` by `pixels` beams.
    pub(crate) fn views(&self, pixels: u32) -> Vec<PictureSpec> {
        let turn = base::ops::TAU / f64::from(self.stations);
        let view =
            |k: u32| View::Orbit { azimuth: turn * f64::from(k), elevation: self.elevation_deg.to_radians() };
        let spec = |k| PictureSpec {
            width: pixels,
            height: pixels,
            view: view(k),
            margin: 0.01,
            ..PictureSpec::default()
        };
        (0..self.stations).map(spec).collect()
    }
}

/// Reason why there is no cloud.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurveyError {
    /// A number is out of its range.
    #[error(transparent)]
    Range(#[from] RangeFault),
    /// No plane across the path meets the plant.
    #[error("no plane across the path meets the plant: lead the path past it")]
    PathPasses,
    /// A point of the path lies in wood.
    #[error("{path} lies in the wood of the plant: lead the path around it")]
    InWood {
        /// The point, by its name.
        path: String,
    },
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

base::coded!(SurveyError {
    Self::PathPasses => "survey-path-passes" {},
    Self::InWood { path } => "survey-in-wood" { path },
} wraps {
    Self::Range(e) => e, RangeFault;
    Self::Cancelled(e) => e, Cancelled;
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_out_of_range_is_refused_by_name() {
        let bad = SurveySpec { stations: 0, ..SurveySpec::default() };
        let fault = bad.check().expect_err("no station");
        assert_eq!(fault.to_string(), "stations must be 1 to 64, not 0");
        assert!(SurveySpec { noise_m: f64::NAN, ..SurveySpec::default() }.check().is_err());
        let bad = SurveySpec { path: vec![DVec3::ZERO; 1], ..SurveySpec::default() };
        assert_eq!(
            bad.check().expect_err("one point").to_string(),
            "length of path must be 2 to 256 points, not 1"
        );
        let path = vec![DVec3::ZERO, DVec3::new(0.0, f64::NAN, 0.0)];
        let fault = SurveySpec { path, ..SurveySpec::default() }.check().expect_err("no number").to_string();
        assert!(fault.starts_with("path[1][1] must be -100,000 to 100,000 m"), "{fault}");
    }
}
