//! Spine -> rings: where cross-sections stand and how they are turned.

use glam::DVec3;

use crate::spine::{Spine, Station};

/// A cross-section: a station with two unit vectors across, `across` x `up` = `tangent`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ring {
    pub centre: DVec3,
    pub tangent: DVec3,
    pub across: DVec3,
    pub up: DVec3,
    pub radius: f64,
    pub slope: f64,
}

impl Ring {
    /// The unit vector across at an angle given by its cosine and sine, from `across` towards `up`.
    pub(crate) fn ray(&self, (cos, sin): (f64, f64)) -> DVec3 {
        self.across * cos + self.up * sin
    }

    /// The outward normal of the tube along `ray`: leans with the taper.
    pub(crate) fn normal(&self, ray: DVec3) -> DVec3 {
        (ray - self.tangent * self.slope).normalize()
    }
}

// Neighbouring ring planes may meet no nearer than this many radii from the centre line: they never fold over.
const CLEARANCE: f64 = 1.15;

/// About `count` rings from arc length `from` to the end: denser where the line turns or swells, planes
/// bisecting its bends, twist minimal (double reflection, Wang et al. 2008).
pub(crate) fn place(spine: &Spine, from: f64, count: f64) -> Vec<Ring> {
    let stations = stations(spine, from, count);
    let tangents = eased_tangents(&stations);
    let mut rings: Vec<Ring> = Vec::with_capacity(stations.len());
    for (&station, tangent) in stations.iter().zip(tangents) {
        let across = match rings.last() {
            None => tangent.any_orthonormal_vector(),
            Some(before) => transport(before, station.centre, tangent),
        };
        rings.push(Ring {
            centre: station.centre,
            tangent,
            across,
            up: tangent.cross(across),
            radius: station.radius,
            slope: station.slope,
        });
    }
    rings
}

/// Equal shares of a weight made of length, turning and swelling.
fn stations(spine: &Spine, from: f64, count: f64) -> Vec<Station> {
    let length = spine.length();
    let from = from.clamp(0.0, length * 0.98);
    let start = spine.s.partition_point(|&s| s <= from).clamp(1, spine.s.len() - 1) - 1;
    let mut weight: Vec<f64> = Vec::with_capacity(spine.s.len() - start);
    weight.push(0.0);
    let (mut turning, mut swelling, mut radius) = (0.0, 0.0, 0.0);
    let pieces = start..spine.s.len() - 1;
    let turn = |k: usize| (spine.t[k + 1] - spine.t[k]).length();
    let swell =
        |k: usize| (spine.r[k + 1] - spine.r[k]).abs() / (spine.r[k + 1] + spine.r[k]).max(f64::MIN_POSITIVE);
    let visible = |k: usize| (spine.s[k + 1] - spine.s[k].max(from)).max(0.0);
    for k in pieces.clone() {
        turning += turn(k);
        swelling += swell(k);
        radius += spine.r[k] * visible(k);
    }
    let left = length - from;
    // A straight axis gets even rings; one that turns by a radian in all spends half of them on its bends.
    let (per_turn, per_swell) = (1.0 / (turning + 1.0), 0.5 / (swelling + 1.0));
    for k in pieces {
        let w = visible(k) / left + turn(k) * per_turn + swell(k) * per_swell;
        weight.push(weight[weight.len() - 1] + w);
    }
    // Rings nearer than 0.35 radii add triangles but no shape.
    let most = (left * left / (0.35 * radius).max(f64::MIN_POSITIVE)).min(4000.0);
    let n = crate::spec::whole(count.min(most.max(3.0)).round().max(2.0));
    let total = weight[weight.len() - 1];
    let mut out = Vec::with_capacity(n as usize);
    let mut k = 0;
    for j in 0..n {
        let station = match j {
            0 => spine.at(from),
            _ if j == n - 1 => spine.at(length),
            _ => {
                let target = total * f64::from(j) / f64::from(n - 1);
                while k + 2 < weight.len() && weight[k + 1] < target {
                    k += 1;
                }
                let u = (target - weight[k]) / (weight[k + 1] - weight[k]).max(f64::MIN_POSITIVE);
                let (a, b) = (spine.s[start + k].max(from), spine.s[start + k + 1]);
                spine.station(start + k, base::ops::lerp(a, b, u.clamp(0.0, 1.0)))
            }
        };
        out.push(station);
    }
    out
}

/// Ring plane normals whose turn from ring to ring keeps the planes apart within the tube.
fn eased_tangents(stations: &[Station]) -> Vec<DVec3> {
    let n = stations.len();
    let limit = |i: usize| {
        let chord = stations[i].centre.distance(stations[i - 1].centre);
        let reach = CLEARANCE * stations[i].radius.max(stations[i - 1].radius);
        // Planes that turn by a meet at chord / (2 tan(a / 2)) from the line; held as the cosine of a.
        let half = chord / (2.0 * reach.max(f64::MIN_POSITIVE));
        (1.0 - half * half) / (1.0 + half * half)
    };
    let tight = (1..n).any(|i| stations[i].tangent.dot(stations[i - 1].tangent) < limit(i));
    if !tight {
        return stations.iter().map(|s| s.tangent).collect();
    }
    let mut forward: Vec<DVec3> = stations.iter().map(|s| s.tangent).collect();
    let mut backward = forward.clone();
    for i in 1..n {
        forward[i] = within(forward[i - 1], forward[i], limit(i));
    }
    for i in (1..n).rev() {
        backward[i - 1] = within(backward[i], backward[i - 1], limit(i));
    }
    // The mean leans to neither end; a last pass restores the bound that averaging may have broken.
    let mut mean: Vec<DVec3> =
        forward.iter().zip(&backward).map(|(a, b)| (*a + *b).try_normalize().unwrap_or(*a)).collect();
    for i in 1..n {
        mean[i] = within(mean[i - 1], mean[i], limit(i));
    }
    mean
}

/// `b`, or the direction towards it at an angle of cosine `cos` from `a` where it is farther.
fn within(a: DVec3, b: DVec3, cos: f64) -> DVec3 {
    if a.dot(b) >= cos {
        return b;
    }
    let side = (b - a * a.dot(b)).try_normalize().unwrap_or_else(|| a.any_orthonormal_vector());
    a * cos + side * (1.0 - cos * cos).max(0.0).sqrt()
}

/// The next ring's `across` without twist: double reflection.
fn transport(before: &Ring, centre: DVec3, tangent: DVec3) -> DVec3 {
    let reflect = |v: DVec3, by: DVec3| {
        let c = by.length_squared();
        if c > 0.0 { v - by * (2.0 * v.dot(by) / c) } else { v }
    };
    let step = centre - before.centre;
    let across = reflect(before.across, step);
    let across = reflect(across, tangent - reflect(before.tangent, step));
    let square = across - tangent * across.dot(tangent);
    square.try_normalize().unwrap_or_else(|| tangent.any_orthonormal_vector())
}
