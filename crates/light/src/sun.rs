//! Position of the sun, brightness of the sun and of a clear sky.

use base::ops;
use glam::DVec3;

use crate::LightError;
use crate::scene::check_range;

/// A direction towards the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// Azimuth clockwise from north, degrees, 0 to 360.
    pub azimuth_deg: f64,
    /// Elevation above the horizon, degrees; of the centre of the sun, without refraction.
    pub elevation_deg: f64,
}

impl SunPosition {
    /// Returns the unit vector towards it.
    pub fn direction(self) -> DVec3 {
        direction_to(self.azimuth_deg, self.elevation_deg)
    }
}

/// Returns the unit vector towards a place of the sky. Degrees: azimuth clockwise from north (-Z), elevation above the
/// horizon.
///
/// ```
/// let east = light::direction_to(90.0, 0.0);
/// assert!(east.distance(glam::DVec3::X) < 1e-15);
/// ```
pub fn direction_to(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let (sin, cos) = ops::sin_cos(azimuth_deg.to_radians());
    let (up, flat) = ops::sin_cos(elevation_deg.to_radians());
    DVec3::new(sin * flat, up, -cos * flat)
}

/// A place on Earth and a date.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPlace {
    /// Latitude, degrees, -90 to 90; north is positive.
    pub latitude_deg: f64,
    /// Longitude, degrees, -180 to 180; east is positive.
    pub longitude_deg: f64,
    /// Altitude above the sea, metres, -500 to 9,000.
    pub altitude_m: f64,
    /// Year (1950 to 2050), month and day.
    pub date: [u32; 3],
}

impl SunPlace {
    /// # Errors
    /// [`LightError::Range`]: a number is out of its range.
    pub fn check(&self) -> Result<(), LightError> {
        let [year, month, day] = self.date;
        check_range("latitude", self.latitude_deg, [-90.0, 90.0], "degrees")?;
        check_range("longitude", self.longitude_deg, [-180.0, 180.0], "degrees")?;
        check_range("altitude", self.altitude_m, [-500.0, 9_000.0], "m")?;
        check_range("year", f64::from(year), [1950.0, 2050.0], "")?;
        check_range("month", f64::from(month), [1.0, 12.0], "")?;
        check_range("day", f64::from(day), [1.0, f64::from(days_of(year, month))], "")?;
        Ok(())
    }

    /// Returns the days since noon of 1 January 2000 (UT), at an hour (UT) of the day.
    fn days(&self, hour_ut: f64) -> f64 {
        let [year, month, day] = self.date.map(f64::from);
        // Julian day at midnight by Meeus (1998), chapter 7, of the Gregorian calendar.
        let (y, m) = if month <= 2.0 { (year - 1.0, month + 12.0) } else { (year, month) };
        let century = (y / 100.0).floor();
        let julian = (365.25 * (y + 4716.0)).floor()
            + (30.6001 * (m + 1.0)).floor()
            + day
            + (2.0 - century + (century / 4.0).floor())
            - 1524.5;
        julian + hour_ut / 24.0 - 2_451_545.0
    }

    /// Returns the position of the sun at an hour of the day, universal time; hours below 0 and above 24 are of the
    /// days before and after.
    ///
    /// By the Astronomical Almanac in the form of Michalsky (1988): within 0.01 degrees from 1950 to 2050. Without
    /// refraction, which lifts the sun by 0.5 degrees at the horizon and by less than 0.1 degrees from 10 degrees on.
    pub fn sun(&self, hour_ut: f64) -> SunPosition {
        let n = self.days(hour_ut);
        let mean_longitude = 280.460 + 0.985_647_4 * n;
        let anomaly = (357.528 + 0.985_600_3 * n).to_radians();
        let longitude =
            (mean_longitude + 1.915 * ops::sin(anomaly) + 0.020 * ops::sin(2.0 * anomaly)).to_radians();
        let tilt = (23.439 - 4e-7 * n).to_radians();
        let (sin_l, cos_l) = ops::sin_cos(longitude);
        let (sin_e, cos_e) = ops::sin_cos(tilt);
        let right_ascension = ops::atan2(cos_e * sin_l, cos_l);
        let sin_d = sin_e * sin_l;
        let cos_d = (1.0 - sin_d * sin_d).max(0.0).sqrt();
        let sidereal_h = 6.697_375 + 0.065_709_824_2 * n + hour_ut;
        let hour_angle = (sidereal_h * 15.0 + self.longitude_deg).to_radians() - right_ascension;
        let (sin_h, cos_h) = ops::sin_cos(hour_angle);
        let (sin_p, cos_p) = ops::sin_cos(self.latitude_deg.to_radians());
        let up = sin_d * sin_p + cos_d * cos_p * cos_h;
        let (east, north) = (-cos_d * sin_h, sin_d * cos_p - cos_d * sin_p * cos_h);
        let elevation_deg = ops::asin(up.clamp(-1.0, 1.0)).to_degrees();
        SunPosition { azimuth_deg: ops::atan2(east, north).to_degrees().rem_euclid(360.0), elevation_deg }
    }

    /// Returns the brightness of sun and sky on a clear day, by the model of the European Solar Radiation Atlas
    /// (Rigollier, Bauer and Wald 2000). `turbidity`: Linke's, for an air mass of 2; 2 is very clear and cold, 3 clear
    /// and warm, 5 moist, 7 polluted; 1 to 10.
    ///
    /// Not covered: clouds. The authors found errors of some 5 to 10 % against hours measured under clear skies.
    ///
    /// # Errors
    /// [`LightError::Range`], [`LightError::BelowHorizon`].
    pub fn clear(&self, hour_ut: f64, turbidity: f64) -> Result<Sunlight, LightError> {
        self.check()?;
        check_range("turbidity", turbidity, [1.0, 10.0], "")?;
        let sun = self.sun(hour_ut);
        if sun.elevation_deg <= 0.0 {
            return Err(LightError::BelowHorizon { elevation_deg: -sun.elevation_deg });
        }
        let sine = ops::sin(sun.elevation_deg.to_radians());
        let outside = SOLAR_CONSTANT * self.nearness(hour_ut);
        let mass = air_mass(sun.elevation_deg, self.altitude_m);
        let direct = outside * sine * ops::exp(-0.8662 * turbidity * mass * rayleigh(mass));
        let diffuse = outside * diffuse_at_zenith(turbidity) * diffuse_angular(turbidity, sine);
        Ok(Sunlight { sun, direct, diffuse: diffuse.max(0.0) })
    }

    /// Returns the brightness of the sun relative to that at its mean distance.
    fn nearness(&self, hour_ut: f64) -> f64 {
        // Day of the year as an angle, from 1 January; the Atlas's eccentricity correction.
        let first = Self { date: [self.date[0], 1, 1], ..*self };
        let day = (self.days(hour_ut) - first.days(0.0)).floor() + 1.0;
        1.0 + 0.03344 * ops::cos(day * ops::TAU / 365.25 - 0.048_869)
    }
}

fn days_of(year: u32, month: u32) -> u32 {
    let leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    match month {
        2 => 28 + u32::from(leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Irradiance by the sun outside the atmosphere at its mean distance, all wavelengths, W/m2.
const SOLAR_CONSTANT: f64 = 1_367.0;

/// Light of all wavelengths on a horizontal surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sunlight {
    /// Position of the sun.
    pub sun: SunPosition,
    /// Direct light of the sun, W/m2 on a horizontal surface.
    pub direct: f64,
    /// Diffuse light of the sky, W/m2.
    pub diffuse: f64,
}

/// Returns the air mass on the path of the light, relative to a vertical path from sea level (Kasten and Young 1989).
fn air_mass(elevation_deg: f64, altitude_m: f64) -> f64 {
    let pressure = ops::exp(-altitude_m / 8434.5);
    let sine = ops::sin(elevation_deg.to_radians());
    pressure / (sine + 0.50572 * ops::powf(elevation_deg + 6.07995, -1.6364))
}

/// Returns the optical thickness of pure air per air mass (Kasten 1996).
fn rayleigh(mass: f64) -> f64 {
    // The polynomial holds for the sun above 2 degrees.
    if mass > 20.0 {
        return 1.0 / (10.4 + 0.718 * mass);
    }
    let m = mass;
    1.0 / (6.6296 + m * (1.7513 + m * (-0.1202 + m * (0.0065 - m * 0.00013))))
}

/// Returns the transmission function of diffuse light with the sun at the zenith (Rigollier and others 2000, Eq 18).
fn diffuse_at_zenith(turbidity: f64) -> f64 {
    -1.5843e-2 + 3.0543e-2 * turbidity + 3.797e-4 * turbidity * turbidity
}

/// Returns the dependence of diffuse light on the elevation of the sun (Rigollier and others 2000, Eq 19 and 20).
fn diffuse_angular(turbidity: f64, sine: f64) -> f64 {
    let (t, least) = (turbidity, 2e-3 / diffuse_at_zenith(turbidity));
    let a0 = 2.6463e-1 - 6.1581e-2 * t + 3.1408e-3 * t * t;
    let a0 = if a0 * diffuse_at_zenith(turbidity) < 2e-3 { least } else { a0 };
    let a1 = 2.0402 + 1.8945e-2 * t - 1.1161e-2 * t * t;
    let a2 = -1.3025 + 3.9231e-2 * t + 8.5079e-3 * t * t;
    a0 + a1 * sine + a2 * sine * sine
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(latitude_deg: f64, longitude_deg: f64, date: [u32; 3]) -> SunPlace {
        SunPlace { latitude_deg, longitude_deg, altitude_m: 0.0, date }
    }

    #[test]
    fn the_sun_stands_over_the_tropics_at_the_solstices() {
        // Declination at noon of 21 June 2026 (UT) is 23.44 degrees: over the tropic the sun is at the zenith.
        let june = place(23.437, 0.0, [2026, 6, 21]);
        let noon = (0..200).map(|k| june.sun(11.0 + 0.01 * f64::from(k)).elevation_deg).fold(0.0, f64::max);
        assert!(noon > 89.9, "{noon}");
        let december = place(-23.437, 0.0, [2026, 12, 21]);
        let noon =
            (0..200).map(|k| december.sun(11.0 + 0.01 * f64::from(k)).elevation_deg).fold(0.0, f64::max);
        assert!(noon > 89.9, "{noon}");
    }

    #[test]
    fn the_sun_rises_in_the_east_and_culminates_in_the_south() {
        let paris = place(48.85, 2.35, [2026, 3, 20]);
        let (morning, noon, evening) = (paris.sun(6.5), paris.sun(11.97), paris.sun(17.5));
        assert!((80.0..100.0).contains(&morning.azimuth_deg), "{morning:?}");
        assert!((178.0..182.0).contains(&noon.azimuth_deg), "{noon:?}");
        // At the equinox it culminates as far from the zenith as the place from the equator.
        assert!((noon.elevation_deg - (90.0 - 48.85)).abs() < 0.2, "{noon:?}");
        assert!((260.0..280.0).contains(&evening.azimuth_deg), "{evening:?}");
    }

    #[test]
    fn the_position_of_reda_and_andreas_example_is_met() {
        // Reda and Andreas (2004): 17 October 2003, 19:30:30 UT, 39.742476 N, 105.1786 W: zenith angle 50.11162 degrees
        // with 0.016 degrees of refraction, azimuth 194.34024 degrees.
        let golden = place(39.742_476, -105.1786, [2003, 10, 17]);
        let sun = golden.sun(19.0 + 30.5 / 60.0);
        assert!((sun.azimuth_deg - 194.340).abs() < 0.01, "{sun:?}");
        assert!((90.0 - sun.elevation_deg - 50.128).abs() < 0.01, "{sun:?}");
    }

    #[test]
    fn a_clear_noon_is_as_bright_as_the_formulas_say() {
        // Sun at the zenith, turbidity 3, air mass 1: 1/(6.6296 + 1.7513 - 0.1202 + 0.0065 - 0.00013) = 0.120962.
        assert!((rayleigh(1.0) - 0.120_962).abs() < 1e-6);
        assert!((air_mass(90.0, 0.0) - 1.0).abs() < 1e-3);
        assert!((ops::exp(-0.8662 * 3.0 * rayleigh(1.0)) - 0.7303).abs() < 1e-4);
        let noon = place(0.0, 0.0, [2026, 3, 20]).clear(12.12, 3.0).expect("the sun is up");
        assert!((980.0..1020.0).contains(&noon.direct), "{noon:?}");
        assert!((100.0..115.0).contains(&noon.diffuse), "{noon:?}");
        let hazy = place(0.0, 0.0, [2026, 3, 20]).clear(12.12, 6.0).expect("the sun is up");
        assert!(hazy.direct < noon.direct && hazy.diffuse > noon.diffuse);
    }

    #[test]
    fn nights_and_days_that_are_none_are_refused() {
        let night = place(48.0, 2.0, [2026, 1, 1]).clear(0.0, 3.0);
        assert!(matches!(night, Err(LightError::BelowHorizon { elevation_deg }) if elevation_deg > 60.0));
        assert!(place(48.0, 2.0, [2026, 2, 29]).check().is_err());
        assert!(place(48.0, 2.0, [2028, 2, 29]).check().is_ok());
        assert!(place(f64::NAN, 2.0, [2026, 2, 2]).check().is_err());
    }
}
