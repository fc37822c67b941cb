//! Degrees on the earth -> metres on a plane: the transverse Mercator projection.

use base::ops;
use glam::DVec2;

/// Semi-major axis of WGS 84, metres.
const MAJOR_M: f64 = 6_378_137.0;
/// Flattening of WGS 84.
const FLATTENING: f64 = 1.0 / 298.257_223_563;
/// Scale on the central meridian of a UTM zone.
const UTM_SCALE: f64 = 0.9996;
/// Easting of the central meridian of a UTM zone, metres.
const UTM_EAST_M: f64 = 500_000.0;
/// Northing of the equator in the zones of the southern hemisphere, metres.
const UTM_SOUTH_M: f64 = 10_000_000.0;

/// A plane that touches or cuts the earth along a meridian (Krueger 1912, in the form of Karney 2011, to the fourth
/// power of the third flattening): exact to less than a millimetre within 3,000 km of the meridian.
///
/// Distances on the plane exceed those on the ground by half the square of the distance from the meridian in radii of
/// the earth: by 1 in 100,000 at 28 km, by 1 in 1,000 at 285 km.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    meridian_deg: f64,
    scale: f64,
    /// Origin, subtracted from eastings and northings.
    origin: DVec2,
}

fn atanh(x: f64) -> f64 {
    0.5 * ops::ln((1.0 + x) / (1.0 - x))
}

fn sinh(x: f64) -> f64 {
    let e = ops::exp(x);
    0.5 * (e - 1.0 / e)
}

fn cosh(x: f64) -> f64 {
    let e = ops::exp(x);
    0.5 * (e + 1.0 / e)
}

impl Plane {
    /// Returns the plane that touches the earth along the meridian of a place, which is its origin.
    pub(crate) fn local(lon_deg: f64, lat_deg: f64) -> Self {
        let plane = Self { meridian_deg: lon_deg, scale: 1.0, origin: DVec2::ZERO };
        Self { origin: plane.metres(lon_deg, lat_deg), ..plane }
    }

    /// Returns a zone of the Universal Transverse Mercator grid, 1 to 60.
    pub(crate) fn utm(zone: u8, is_south: bool) -> Self {
        let meridian_deg = 6.0 * f64::from(zone) - 183.0;
        let north = if is_south { -UTM_SOUTH_M } else { 0.0 };
        Self { meridian_deg, scale: UTM_SCALE, origin: DVec2::new(-UTM_EAST_M, north) }
    }

    /// Returns the zone of a longitude.
    pub(crate) fn utm_zone(lon_deg: f64) -> u8 {
        #[expect(clippy::cast_possible_truncation, reason = "1 to 60")]
        let zone = ops::whole(((lon_deg + 180.0) / 6.0).clamp(0.0, 59.0)) as u8;
        zone + 1
    }

    /// Returns easting and northing of a place.
    pub(crate) fn metres(&self, lon_deg: f64, lat_deg: f64) -> DVec2 {
        let n = FLATTENING / (2.0 - FLATTENING);
        let (n2, n3, n4) = (n * n, n * n * n, n * n * n * n);
        let radius = MAJOR_M / (1.0 + n) * (1.0 + n2 / 4.0 + n4 / 64.0);
        let alpha = [
            n / 2.0 - 2.0 * n2 / 3.0 + 5.0 * n3 / 16.0 + 41.0 * n4 / 180.0,
            13.0 * n2 / 48.0 - 3.0 * n3 / 5.0 + 557.0 * n4 / 1440.0,
            61.0 * n3 / 240.0 - 103.0 * n4 / 140.0,
            49_561.0 * n4 / 161_280.0,
        ];
        let tau = ops::tan(lat_deg * (ops::PI / 180.0));
        let e = 2.0 * n.sqrt() / (1.0 + n);
        let sigma = sinh(e * atanh(e * tau / (1.0 + tau * tau).sqrt()));
        // The tangent of the conformal latitude.
        let t = tau * (1.0 + sigma * sigma).sqrt() - sigma * (1.0 + tau * tau).sqrt();
        let (sin, cos) = ops::sin_cos((lon_deg - self.meridian_deg) * (ops::PI / 180.0));
        let xi = ops::atan2(t, cos);
        let eta = atanh((sin / (1.0 + t * t).sqrt()).clamp(-FARTHEST, FARTHEST));
        let (mut east, mut north) = (eta, xi);
        for (j, a) in (1..).map(|j| 2.0 * f64::from(j)).zip(alpha) {
            let (s, c) = ops::sin_cos(j * xi);
            east += a * c * sinh(j * eta);
            north += a * s * cosh(j * eta);
        }
        DVec2::new(east, north) * (self.scale * radius) - self.origin
    }
}

/// Limit that keeps places a quarter of the earth away from the meridian finite: they have none on the plane, and
/// land far away.
const FARTHEST: f64 = 1.0 - 1e-15;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms() {
        // The quarter of a meridian of WGS 84: 10,001,965.729 m.
        let plane = Plane::local(11.0, 0.0);
        let pole = plane.metres(11.0, 90.0);
        assert!((pole.y - 10_001_965.729).abs() < 2e-3 && pole.x.abs() < 1e-3, "{pole}");
        // A degree on the equator, close to the meridian, is a degree of a circle of the major axis.
        let east = plane.metres(11.01, 0.0).x;
        assert!((east / (MAJOR_M * 0.01 * ops::PI / 180.0) - 1.0).abs() < 1e-7, "{east}");
        assert_eq!(Plane::local(11.5, 48.1).metres(11.5, 48.1), DVec2::ZERO);
    }

    #[test]
    fn utm_of_a_known_place() {
        // The Eiffel Tower: zone 31 N, 448,252 E, 5,411,933 N.
        let zone = Plane::utm_zone(2.2945);
        let at = Plane::utm(zone, false).metres(2.2945, 48.8582);
        assert_eq!(zone, 31);
        assert!((at - DVec2::new(448_252.0, 5_411_933.0)).length() < 1.0, "{at}");
        let south = Plane::utm(31, true).metres(2.2945, -48.8582);
        assert!((south.y - (UTM_SOUTH_M - at.y)).abs() < 1e-6);
        assert_eq!([-180.0, -0.1, 0.0, 179.99, 180.0].map(Plane::utm_zone), [1, 30, 31, 60, 60]);
    }
}
