//! Where light comes from: beams out of a sky of 46 directions, and suns.

use base::ops;
use glam::DVec3;

use crate::LightError;
use crate::scene::check_range;
use crate::sun::{SunPosition, direction_to};

/// Parallel light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Unit vector towards its source, above the horizon.
    pub to: DVec3,
    /// What it gives a horizontal surface: W/m2, or J/m2 over a time.
    pub horizontal: f64,
    /// Whether it is the sun's: what it meets first is sunlit.
    pub is_sun: bool,
}

/// How the light of a sky is distributed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SkyKind {
    /// The same radiance everywhere: the uniform overcast sky (UOC).
    Uniform,
    /// Three times as bright at the zenith as at the horizon: the standard overcast sky (SOC) of Moon and Spencer (1942).
    Overcast,
    /// The clear sky with low turbidity of CIE S 011 (type 12), bright around the sun.
    Clear(SunPosition),
}

/// How many directions a sky has.
pub const TURTLE_DIRECTIONS: usize = 46;

/// Rings of the turtle: elevation and solid angle of each direction, azimuths; degrees and steradians.
///
/// After den Dulk (1989), *The interpretation of remote sensing, a feasibility study*, Wageningen: the faces of a solid with
/// the symmetry of the dodecahedron, of about the same solid angle each.
const TURTLE: [(f64, f64, &[f64]); 8] = [
    (9.23, 0.1355, &[12.23, 59.77, 84.23, 131.77, 156.23, 203.77, 228.23, 275.77, 300.23, 347.77]),
    (10.81, 0.1476, &[36.0, 108.0, 180.0, 252.0, 324.0]),
    (26.57, 0.1207, &[0.0, 72.0, 144.0, 216.0, 288.0]),
    (31.08, 0.1375, &[23.27, 48.73, 95.27, 120.73, 167.27, 192.73, 239.27, 264.73, 311.27, 336.73]),
    (47.41, 0.1364, &[0.0, 72.0, 144.0, 216.0, 288.0]),
    (52.62, 0.1442, &[36.0, 108.0, 180.0, 252.0, 324.0]),
    (69.16, 0.1378, &[0.0, 72.0, 144.0, 216.0, 288.0]),
    (90.0, 0.1196, &[180.0]),
];

/// The directions of the turtle, with their solid angles in steradians.
pub(crate) fn turtle() -> impl Iterator<Item = (DVec3, f64)> {
    TURTLE.iter().flat_map(|(elevation, solid_angle, azimuths)| {
        azimuths.iter().map(|azimuth| (direction_to(*azimuth, *elevation), *solid_angle))
    })
}

impl SkyKind {
    /// Radiance towards a place of the sky, in any unit.
    fn radiance(self, to: DVec3) -> f64 {
        match self {
            Self::Uniform => 1.0,
            Self::Overcast => (1.0 + 2.0 * to.y) / 3.0,
            Self::Clear(sun) => {
                let away = ops::acos_clamped(to.dot(sun.direction()));
                gradation(to.y) * indicatrix(away)
            }
        }
    }
}

/// How much the zenith differs from the horizon (CIE S 011:2003, type 12: a = -1, b = -0.32).
fn gradation(sine: f64) -> f64 {
    1.0 - ops::exp(-0.32 / sine.max(1e-3))
}

/// How bright the sky is around the sun (CIE S 011:2003, type 12: c = 10, d = -3, e = 0.45).
fn indicatrix(away: f64) -> f64 {
    let cos = ops::cos(away);
    1.0 + 10.0 * (ops::exp(-3.0 * away) - ops::exp(-3.0 * ops::FRAC_PI_2)) + 0.45 * cos * cos
}

/// All light that falls on a scene.
///
/// ```
/// use light::{Beams, SkyKind};
/// let beams = Beams::sky(SkyKind::Overcast, 100.0)?;
/// assert!((beams.horizontal() - 100.0).abs() < 1e-9);
/// # Ok::<(), light::LightError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Beams {
    /// From the sky, in the order of the turtle: what each gives a horizontal surface.
    pub(crate) sky: [f64; TURTLE_DIRECTIONS],
    /// Others.
    pub(crate) others: Vec<Beam>,
}

impl Default for Beams {
    fn default() -> Self {
        Self { sky: [0.0; TURTLE_DIRECTIONS], others: Vec::new() }
    }
}

/// More beams are no finer sky, only slower.
const MOST_BEAMS: usize = 2_000;

impl Beams {
    /// A sky that gives a horizontal surface `horizontal` (W/m2 or J/m2, 0 to 1e9).
    ///
    /// # Errors
    /// [`LightError::Range`].
    pub fn sky(kind: SkyKind, horizontal: f64) -> Result<Self, LightError> {
        let mut beams = Self::default();
        beams.add_sky(kind, horizontal)?;
        Ok(beams)
    }

    /// Adds a sky.
    ///
    /// # Errors
    /// [`LightError::Range`].
    pub fn add_sky(&mut self, kind: SkyKind, horizontal: f64) -> Result<(), LightError> {
        check_range("sky", horizontal, IRRADIANCE, "W/m2")?;
        let shares: Vec<f64> = turtle().map(|(to, angle)| kind.radiance(to) * angle * to.y).collect();
        let whole: f64 = shares.iter().sum();
        for (sum, share) in self.sky.iter_mut().zip(shares) {
            *sum += horizontal * share / whole;
        }
        Ok(())
    }

    /// Adds the light of a sun that gives a horizontal surface `horizontal`, as [`Self::add_beam`].
    ///
    /// # Errors
    /// As [`Self::add_beam`].
    pub fn add_sun(&mut self, sun: SunPosition, horizontal: f64) -> Result<(), LightError> {
        self.add_beam(sun, horizontal)?;
        if let Some(beam) = self.others.last_mut() {
            beam.is_sun = true;
        }
        Ok(())
    }

    /// Adds parallel light from a place of the sky, such as one of a measured sky, that gives a horizontal surface
    /// `horizontal`. Its elevation must be above 0 degrees; what stands lower than [`LOWEST_DEG`](Self::LOWEST_DEG) is taken to
    /// stand there.
    ///
    /// # Errors
    /// [`LightError::BelowHorizon`], [`LightError::Range`]: numbers that are none, or more than 2,000 beams.
    pub fn add_beam(&mut self, from: SunPosition, horizontal: f64) -> Result<(), LightError> {
        let SunPosition { azimuth_deg, elevation_deg } = from;
        check_range("irradiance", horizontal, IRRADIANCE, "W/m2")?;
        check_range("azimuth", azimuth_deg, [-360.0, 360.0], "degrees")?;
        check_range("elevation", elevation_deg, [-90.0, 90.0], "degrees")?;
        check_range("beams", self.others.len() as f64 + 1.0, [0.0, MOST_BEAMS as f64], "")?;
        if elevation_deg <= 0.0 {
            return Err(LightError::BelowHorizon { elevation_deg: -elevation_deg });
        }
        let to = direction_to(azimuth_deg, elevation_deg.max(Self::LOWEST_DEG));
        self.others.push(Beam { to, horizontal, is_sun: false });
        Ok(())
    }

    /// Light that comes in lower than this, in degrees, is taken to come from here: along the horizon, shadows have no end.
    pub const LOWEST_DEG: f64 = 2.0;

    /// What all of it gives a horizontal surface.
    pub fn horizontal(&self) -> f64 {
        self.sky.iter().sum::<f64>() + self.others.iter().map(|b| b.horizontal).sum::<f64>()
    }
}

/// What may be given of an irradiance, or of what it sums up to over a day.
const IRRADIANCE: [f64; 2] = [0.0, 1e9];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_turtle_covers_the_sky_evenly() {
        assert_eq!(turtle().count(), TURTLE_DIRECTIONS);
        let solid: f64 = turtle().map(|(_, angle)| angle).sum();
        assert!((solid - ops::TAU).abs() < 2e-3, "{solid} sr");
        // Of uniform radiance, a horizontal surface gets pi.
        let flat: f64 = turtle().map(|(to, angle)| angle * to.y).sum();
        assert!((flat / ops::PI - 1.0).abs() < 0.015, "{flat}");
        let middle: DVec3 = turtle().map(|(to, angle)| to * angle).sum();
        assert!(middle.x.abs() < 1e-6 && middle.z.abs() < 1e-6, "{middle}");
    }

    #[test]
    fn an_overcast_sky_is_three_times_as_bright_at_the_zenith() {
        let radiance = |deg: f64| SkyKind::Overcast.radiance(direction_to(0.0, deg));
        assert!((radiance(90.0) / radiance(0.0) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_clear_sky_is_brightest_at_the_sun() {
        let sun = SunPosition { azimuth_deg: 144.0, elevation_deg: 47.41 };
        let beams = Beams::sky(SkyKind::Clear(sun), 50.0).expect("a sky");
        let radiance = turtle().zip(beams.sky).map(|((to, angle), e)| (e / (angle * to.y), to));
        let brightest = radiance.max_by(|a, b| a.0.total_cmp(&b.0)).expect("a direction");
        assert!(brightest.1.dot(sun.direction()) > 0.999, "{brightest:?}");
    }

    #[test]
    fn light_from_below_is_refused() {
        let mut beams = Beams::default();
        let place = |elevation_deg| SunPosition { azimuth_deg: 0.0, elevation_deg };
        let below = beams.add_sun(place(-3.0), 1.0);
        assert_eq!(below, Err(LightError::BelowHorizon { elevation_deg: 3.0 }));
        assert!(matches!(beams.add_sun(place(30.0), f64::NAN), Err(LightError::Range(_))));
        assert!(matches!(beams.add_sky(SkyKind::Uniform, -1.0), Err(LightError::Range(_))));
    }
}
