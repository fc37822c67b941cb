//! Places cross-sections along a spine, and orients them.

use glam::DVec3;

use crate::spine::{Reach, Spine, Station};

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
    /// Returns the transverse unit vector at an angle given by its cosine and sine, from `across` towards `up`.
    pub(crate) fn ray(&self, (cos, sin): (f64, f64)) -> DVec3 {
        self.across * cos + self.up * sin
    }

    /// Returns the outward normal of the tube along `ray`, which leans with the taper.
    pub(crate) fn normal(&self, ray: DVec3) -> DVec3 {
        (ray - self.tangent * self.slope).normalize()
    }
}

// Least distance from the centre line, in radii, at which neighbouring ring planes may meet: they never fold over.
const CLEARANCE: f64 = 1.15;

/// Returns `spine` as it is drawn, and the index of its first ring: about `count` rings from arc length `from` to the
/// end, denser where the line turns or swells, and more where the line would deviate from the straight pieces between
/// them by more than `tolerance` for its radius there. This, not the smooth line, bears other axes.
///
/// On a bearer the line has two more samples without rings: at its exit, from where the fillet runs straight to the
/// first ring, and as far back on that straight line as its start.
pub(crate) fn drawn(
    spine: &Spine,
    reach: Option<&Reach>,
    count: f64,
    tolerance: impl Fn(f64) -> f64,
) -> (Spine, usize) {
    let stations = stations(spine, reach.map_or(0.0, |r| r.top), count);
    let stations = refined(spine, &stations, tolerance);
    let foot = reach.map_or_else(Vec::new, |r| {
        let along = (stations[0].centre - r.exit.centre).try_normalize().unwrap_or(r.exit.tangent);
        vec![
            Station { centre: r.exit.centre - along * r.exit.s, tangent: along, ..spine.station_at(0.0) },
            r.exit,
        ]
    });
    let all = || foot.iter().chain(&stations);
    let line = Spine {
        p: all().map(|s| s.centre).collect(),
        t: all().map(|s| s.tangent).collect(),
        r: all().map(|s| s.radius).collect(),
        s: all().map(|s| s.s).collect(),
        knots: Vec::new(),
    };
    (line, foot.len())
}

/// Returns the rings at the samples of a drawn line from index `first` on: planes bisecting its bends, twist minimal
/// (double reflection, Wang et al. 2008).
pub(crate) fn rings(line: &Spine, first: usize) -> Vec<Ring> {
    let n = line.p.len();
    let tangents = eased_tangents(line, first);
    let mut rings: Vec<Ring> = Vec::with_capacity(n - first);
    for (k, tangent) in (first..n).zip(tangents) {
        let across = match rings.last() {
            None => tangent.any_orthonormal_vector(),
            Some(before) => transport(before, line.p[k], tangent),
        };
        let (a, b) = (k.saturating_sub(1).max(first), (k + 1).min(n - 1));
        let h = line.s[b] - line.s[a];
        let slope = if h > 0.0 { (line.r[b] - line.r[a]) / h } else { 0.0 };
        rings.push(Ring {
            centre: line.p[k],
            tangent,
            across,
            up: tangent.cross(across),
            radius: line.r[k],
            slope: slope.clamp(-1.0, 1.0),
        });
    }
    rings
}

/// Returns the normals of the rings at the samples of a drawn line: those below ring `first`, which are not drawn, are
/// perpendicular to the line.
pub(crate) fn planes(line: &Spine, first: usize) -> Vec<DVec3> {
    let below = &line.t[..first.min(line.t.len())];
    below.iter().copied().chain(eased_tangents(line, first)).collect()
}

/// Returns stations at equal shares of a weight made of length, turning and swelling.
fn stations(spine: &Spine, from: f64, count: f64) -> Vec<Station> {
    let length = spine.length();
    let from = from.clamp(0.0, length * 0.98);
    let start = spine.piece(from);
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
    // A straight axis gets even rings; one that turns by a radian in total spends half of them on its bends.
    let (per_turn, per_swell) = (1.0 / (turning + 1.0), 0.5 / (swelling + 1.0));
    for k in pieces {
        let w = visible(k) / left + turn(k) * per_turn + swell(k) * per_swell;
        weight.push(weight[weight.len() - 1] + w);
    }
    // Rings nearer than 0.35 radii add triangles but no shape.
    let most = (left * left / (0.35 * radius).max(f64::MIN_POSITIVE)).min(4000.0);
    let n = base::ops::whole(count.min(most.max(3.0)).round().max(2.0));
    let total = weight[weight.len() - 1];
    let mut out = Vec::with_capacity(n as usize);
    let mut k = 0;
    for j in 0..n {
        let station = match j {
            0 => spine.station_at(from),
            _ if j == n - 1 => spine.station_at(length),
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

/// Adds between any two stations the samples of `spine` needed to stay within the tolerance (Douglas and Peucker 1973).
/// Cost: n log n in samples.
fn refined(spine: &Spine, stations: &[Station], tolerance: impl Fn(f64) -> f64) -> Vec<Station> {
    let mut out = Vec::with_capacity(2 * stations.len());
    out.extend(stations.first());
    let mut ahead: Vec<Station> = Vec::new();
    for pair in stations.windows(2) {
        let mut from = pair[0];
        ahead.push(pair[1]);
        while let Some(to) = ahead.last() {
            if let Some(k) = farthest(spine, &from, to, &tolerance) {
                ahead.push(spine.station(k, spine.s[k]));
            } else {
                from = *to;
                out.push(from);
                ahead.pop();
            }
        }
    }
    out
}

/// Returns the sample between two stations that deviates most, in its tolerances, from the cone between them, if by
/// more than one.
fn farthest(spine: &Spine, from: &Station, to: &Station, tolerance: impl Fn(f64) -> f64) -> Option<usize> {
    let a = spine.s.partition_point(|&s| s <= from.s);
    let b = spine.s.partition_point(|&s| s < to.s).min(spine.s.len() - 1).max(a);
    let along = to.centre - from.centre;
    let (square, length) = (along.length_squared().max(f64::MIN_POSITIVE), to.s - from.s);
    let mut worst: Option<(f64, usize)> = None;
    for k in a..b {
        let p = spine.p[k] - from.centre;
        let off = (p - along * (p.dot(along) / square).clamp(0.0, 1.0)).length();
        let radius = base::ops::lerp(from.radius, to.radius, (spine.s[k] - from.s) / length);
        let off = (off + (spine.r[k] - radius).abs()) / tolerance(spine.r[k]).max(f64::MIN_POSITIVE);
        if off > worst.map_or(1.0, |w| w.0) {
            worst = Some((off, k));
        }
    }
    // With many samples the middle half is split, so that each search covers fewer than before.
    let edge = if b - a > 64 { (b - a) / 4 } else { 0 };
    worst.map(|(_, k)| k.clamp(a + edge, b - 1 - edge))
}

/// Returns ring plane normals whose turn from ring to ring keeps the planes apart within the tube.
fn eased_tangents(line: &Spine, first: usize) -> Vec<DVec3> {
    let (p, t, r) = (&line.p[first..], &line.t[first..], &line.r[first..]);
    let n = p.len();
    let limit = |i: usize| {
        let chord = p[i].distance(p[i - 1]);
        let reach = CLEARANCE * r[i].max(r[i - 1]);
        // Planes that turn by a meet at chord / (2 tan(a / 2)) from the line; held as the cosine of a.
        let half = chord / (2.0 * reach.max(f64::MIN_POSITIVE));
        (1.0 - half * half) / (1.0 + half * half)
    };
    let tight = (1..n).any(|i| t[i].dot(t[i - 1]) < limit(i));
    if !tight {
        return t.to_vec();
    }
    let mut forward: Vec<DVec3> = t.to_vec();
    let mut backward = forward.clone();
    for i in 1..n {
        forward[i] = within(forward[i - 1], forward[i], limit(i));
    }
    for i in (1..n).rev() {
        backward[i - 1] = within(backward[i], backward[i - 1], limit(i));
    }
    // The mean prefers neither end; a last pass restores the bound that averaging may have broken.
    let mut mean: Vec<DVec3> =
        forward.iter().zip(&backward).map(|(a, b)| (*a + *b).try_normalize().unwrap_or(*a)).collect();
    if first == 0 {
        // The start of an axis without a bearer is given: a trunk is horizontal at the ground.
        mean[0] = t[0];
    }
    for i in 1..n {
        mean[i] = within(mean[i - 1], mean[i], limit(i));
    }
    mean
}

/// Returns `b`, or the direction towards it at an angle of cosine `cos` from `a` if it is farther.
fn within(a: DVec3, b: DVec3, cos: f64) -> DVec3 {
    if a.dot(b) >= cos {
        return b;
    }
    let side = (b - a * a.dot(b)).try_normalize().unwrap_or_else(|| a.any_orthonormal_vector());
    a * cos + side * (1.0 - cos * cos).max(0.0).sqrt()
}

/// Returns the next ring's `across` without twist: double reflection.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a line that zigzags by 40 degrees.
    fn zigzag() -> Spine {
        let points: Vec<DVec3> = (0..12)
            .map(|i| DVec3::new(if i % 2 == 0 { 0.0 } else { 0.2 }, 0.5 * f64::from(i), 0.0))
            .collect();
        let radii: Vec<f64> = (0..12).map(|i| 0.05 - 0.004 * f64::from(i)).collect();
        Spine::new(&points, &radii, 40, None).unwrap()
    }

    #[test]
    fn few_rings_still_follow_the_line() {
        let spine = zigzag();
        let loose = drawn(&spine, None, 3.0, |_| f64::INFINITY).0;
        assert_eq!(loose.p.len(), 3);
        for share in [1.0, 0.3] {
            let (line, first) = drawn(&spine, None, 3.0, |r| share * r);
            assert_eq!((first, rings(&line, first).len()), (0, line.p.len()));
            let mut hint = 0;
            for (p, r) in spine.p.iter().zip(&spine.r) {
                let (at, piece) = line.nearest(*p, hint);
                hint = piece;
                assert!(at.centre.distance(*p) <= share * r * 1.000_001, "{share}: {p} is off");
            }
            // Fewer than the samples: only as many as needed.
            assert!(line.p.len() < spine.p.len() && line.p.len() >= 13, "{} rings", line.p.len());
        }
    }

    #[test]
    fn a_leaning_trunk_meets_the_ground_all_round() {
        for lean in [0.1, 0.5, 0.9] {
            let points: Vec<DVec3> = (0..6).map(|i| DVec3::new(lean, 1.0, 0.0) * f64::from(i)).collect();
            let mut spine = Spine::new(&points, &[0.4; 6], 60, None).unwrap();
            spine.stand();
            let (line, first) = drawn(&spine, None, 40.0, |r| 0.1 * r);
            let rings = rings(&line, first);
            assert!(rings[0].across.y.abs() < 1e-12 && rings[0].up.y.abs() < 1e-12, "{lean}: {:?}", rings[0]);
            // No ring intersects the next one, except for a sliver where the trunk leans most.
            for pair in rings.windows(2) {
                for turn in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)] {
                    let [a, b] = [0, 1].map(|k| pair[k].centre + pair[k].ray(turn) * pair[k].radius);
                    assert!((b - a).dot(pair[0].tangent) > -0.01 * pair[0].radius, "{lean}: {a} {b}");
                }
            }
        }
        // The foot of a stem lying on the ground is cut across.
        let mut lying = Spine::new(&[DVec3::ZERO, DVec3::new(2.0, 0.2, 0.0)], &[0.1, 0.1], 20, None).unwrap();
        lying.stand();
        assert!(rings(&lying, 0)[0].tangent.x > 0.9);
    }

    #[test]
    fn what_lies_below_the_first_ring_is_straight() {
        let spine = zigzag();
        let exit = spine.station_at(0.3);
        let (line, first) = drawn(&spine, Some(&Reach { exit, on: 1.0, top: 0.8 }), 6.0, |r| r);
        assert_eq!((first, line.s[1], line.s[2]), (2, 0.3, spine.station_at(0.8).s));
        let (a, b) = (line.p[1] - line.p[0], line.p[2] - line.p[1]);
        assert!(a.normalize().dot(b.normalize()) > 1.0 - 1e-12);
        assert!((a.length() - 0.3).abs() < 1e-12);
    }
}
