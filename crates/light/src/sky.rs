//! Sources of light: beams from a sky of 46 directions, and suns.

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
    /// Irradiance of a horizontal surface: W/m2, or J/m2 over a time.
    pub horizontal: f64,
    /// Whether the beam is the sun's: the surfaces that it meets first are sunlit.
    pub is_sun: bool,
}

/// Distribution of the light of a sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SkyKind {
    /// The same radiance everywhere: the uniform overcast sky (UOC).
    Uniform,
    /// Three times as bright at the zenith as at the horizon: the standard overcast sky (SOC) of Moon and Spencer
    /// (1942).
    Overcast,
    /// The clear sky with low turbidity of CIE S 011 (type 12), bright around the sun.
    Clear(SunPosition),
}

/// Number of directions of a sky.
pub const SKY_DIRECTIONS: usize = 46;

/// A ring of directions at one elevation, at even distances.
struct Ring {
    /// Sine of the elevation.
    sine: f64,
    /// Share of the solid angle of the half sphere that the ring stands for.
    share: f64,
    /// Number of directions.
    count: u32,
    /// Azimuth of the first direction, as a share of the distance between two.
    first: f64,
}

/// Directions of a sky, from the horizon up.
///
/// The sines of the elevations are the nodes of Gauss and Legendre's rule of five points between 0 and 1, and the shares
/// are its weights: sums over the rings are exact for polynomials of the sine up to the ninth degree, and so is the
/// light that a horizontal surface receives. Azimuths are evenly spaced, so that sums over a ring are exact for the
/// slower waves around the horizon. The counts give about the same solid angle to each direction.
const RINGS: [Ring; 5] = [
    Ring { sine: 0.046_910_077_030_668_02, share: 0.118_463_442_528_094_54, count: 9, first: 0.1 },
    Ring { sine: 0.230_765_344_947_158_45, share: 0.239_314_335_249_683_25, count: 12, first: 0.4 },
    Ring { sine: 0.5, share: 0.284_444_444_444_444_44, count: 12, first: 0.7 },
    Ring { sine: 0.769_234_655_052_841_6, share: 0.239_314_335_249_683_25, count: 8, first: 0.0 },
    Ring { sine: 0.953_089_922_969_331_9, share: 0.118_463_442_528_094_54, count: 5, first: 0.3 },
];

/// Returns the directions of the sky, with their solid angles in steradians.
pub(crate) fn sky_directions() -> impl Iterator<Item = (DVec3, f64)> {
    RINGS.iter().flat_map(|ring| {
        let step = ops::TAU / f64::from(ring.count);
        let flat = (1.0 - ring.sine * ring.sine).sqrt();
        (0..ring.count).map(move |k| {
            let (sin, cos) = ops::sin_cos(step * (f64::from(k) + ring.first));
            (DVec3::new(flat * sin, ring.sine, -flat * cos), step * ring.share)
        })
    })
}

impl SkyKind {
    /// Returns the radiance towards a place of the sky, in any unit.
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

/// Returns the change of radiance from zenith to horizon (CIE S 011:2003, type 12: a = -1, b = -0.32).
fn gradation(sine: f64) -> f64 {
    1.0 - ops::exp(-0.32 / sine.max(1e-3))
}

/// Returns the relative radiance around the sun (CIE S 011:2003, type 12: c = 10, d = -3, e = 0.45).
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
    /// Irradiance of a horizontal surface by each direction of the sky, in the order of their rings.
    pub(crate) sky: [f64; SKY_DIRECTIONS],
    /// Other beams: suns, and places of measured skies.
    pub(crate) others: Vec<Beam>,
}

impl Default for Beams {
    fn default() -> Self {
        Self { sky: [0.0; SKY_DIRECTIONS], others: Vec::new() }
    }
}

/// Most beams: more would not make the sky finer, only the computation slower.
const MOST_BEAMS: usize = 2_000;

impl Beams {
    /// Makes a sky that gives a horizontal surface the irradiance `horizontal` (W/m2 or J/m2, 0 to 1e9).
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
        let shares: Vec<f64> = sky_directions().map(|(to, angle)| kind.radiance(to) * angle * to.y).collect();
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

    /// Adds parallel light from a place of the sky, such as one of a measured sky, that gives a horizontal surface the
    /// irradiance `horizontal`. Its elevation must be above 0 degrees; one below [`LOWEST_DEG`](Self::LOWEST_DEG) is
    /// raised to it.
    ///
    /// # Errors
    /// [`LightError::BelowHorizon`], [`LightError::Range`]: values that are not finite, or more than 2,000 beams.
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

    /// Lowest elevation of light, degrees, to which lower light is raised: along the horizon, shadows would have no
    /// end.
    pub const LOWEST_DEG: f64 = 2.0;

    /// Returns the irradiance of a horizontal surface by all beams.
    pub fn horizontal(&self) -> f64 {
        self.sky.iter().sum::<f64>() + self.others.iter().map(|b| b.horizontal).sum::<f64>()
    }
}

/// Range of an irradiance, or of its sum over a day.
const IRRADIANCE: [f64; 2] = [0.0, 1e9];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_directions_cover_the_sky_evenly() {
        assert_eq!(sky_directions().count(), SKY_DIRECTIONS);
        let solid: f64 = sky_directions().map(|(_, angle)| angle).sum();
        assert!((solid - ops::TAU).abs() < 1e-12, "{solid} sr");
        // A sky of uniform radiance gives a horizontal surface pi.
        let flat: f64 = sky_directions().map(|(to, angle)| angle * to.y).sum();
        assert!((flat / ops::PI - 1.0).abs() < 1e-12, "{flat}");
        // The means of the sine's powers between 0 and 1.
        for power in 2..=9 {
            let power_of = |sine: f64| (0..power).fold(1.0, |product, _| product * sine);
            let mean = sky_directions().map(|(to, angle)| angle * power_of(to.y)).sum::<f64>() / ops::TAU;
            assert!((mean * f64::from(power + 1) - 1.0).abs() < 1e-12, "{power}: {mean}");
        }
        let middle: DVec3 = sky_directions().map(|(to, angle)| to * angle).sum();
        assert!(middle.x.abs() < 1e-12 && middle.z.abs() < 1e-12, "{middle}");
        assert!(sky_directions().all(|(to, _)| (to.length() - 1.0).abs() < 1e-12));
    }

    #[test]
    fn a_plate_of_any_slope_gets_the_light_of_a_uniform_sphere() {
        let mut chance = base::Seed::new(3).stream(base::Draw::Test);
        for _ in 0..500 {
            let up = chance.range(-1.0, 1.0);
            let (sin, cos) = ops::sin_cos(chance.range(0.0, ops::TAU));
            let flat = (1.0 - up * up).sqrt();
            let normal = DVec3::new(flat * sin, up, flat * cos);
            // Both ways along each direction: pi for each side of the plate.
            let sum: f64 = sky_directions().map(|(to, angle)| angle * to.dot(normal).abs()).sum();
            assert!((sum / ops::PI - 1.0).abs() < 0.02, "{normal}: {sum}");
        }
    }

    #[test]
    fn overcast_light_through_a_turbid_medium_is_that_of_the_integral() {
        for lai in [1.0, 2.0, 3.0, 4.0] {
            let through = |sine: f64| ops::exp(-0.5 * lai / sine);
            for kind in [SkyKind::Uniform, SkyKind::Overcast] {
                let beams = Beams::sky(kind, 1.0).expect("a sky");
                let sum: f64 = sky_directions().zip(beams.sky).map(|((to, _), e)| e * through(to.y)).sum();
                let steps = 100_000;
                let mut integral = [0.0; 2];
                for k in 0..steps {
                    let sine = (f64::from(k) + 0.5) / f64::from(steps);
                    let light = kind.radiance(DVec3::new(0.0, sine, 0.0)) * sine;
                    integral[0] += light;
                    integral[1] += light * through(sine);
                }
                let wanted = integral[1] / integral[0];
                assert!((sum - wanted).abs() < 3e-4, "{kind:?}, LAI {lai}: {sum}, not {wanted}");
            }
        }
    }

    #[test]
    fn an_overcast_sky_is_three_times_as_bright_at_the_zenith() {
        let radiance = |deg: f64| SkyKind::Overcast.radiance(direction_to(0.0, deg));
        assert!((radiance(90.0) / radiance(0.0) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_clear_sky_is_brightest_at_the_sun() {
        let sun = SunPosition { azimuth_deg: 135.0, elevation_deg: 50.28 };
        let beams = Beams::sky(SkyKind::Clear(sun), 50.0).expect("a sky");
        let radiance = sky_directions().zip(beams.sky).map(|((to, angle), e)| (e / (angle * to.y), to));
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
