//! Frames along a line in space that do not twist.

use crate::vector::Vector;
use glam::DVec3;

/// A point of a curve with three unit vectors at right angles; `binormal = tangent x normal`.
///
/// ```
/// use glam::DVec3;
/// let frames = geom::rotation_minimising_frames(&[DVec3::ZERO, DVec3::Y], Some(DVec3::X));
/// assert_eq!((frames[1].normal, frames[1].binormal), (DVec3::X, -DVec3::Z));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame3 {
    /// The point of the curve.
    pub origin: DVec3,
    /// Unit vector along the curve.
    pub tangent: DVec3,
    /// Unit vector across the curve.
    pub normal: DVec3,
    /// `tangent x normal`.
    pub binormal: DVec3,
}

/// Returns one frame per point of a line, with the least rotation about the tangent.
///
/// The tangent at an inner point halves the angle of its two segments; where the line turns back on itself it
/// is the direction of arrival. `first_normal` need not be at right angles to the line (its part along the
/// line is removed); without it, or if it is parallel to the line, a fixed rule chooses. Guaranteed: as many
/// frames as points, all orthonormal. A repeated or unusable point gets the frame of the point before it (the
/// first usable one, at the start); a line without length points along +Y. Cost: linear.
///
/// Wang, Jüttler, Zheng and Liu 2008, double reflection: fourth order in the step.
pub fn rotation_minimising_frames(points: &[DVec3], first_normal: Option<DVec3>) -> Vec<Frame3> {
    let (places, owner) = distinct_places(points);
    let tangents = tangents(&places);
    let (Some(&t0), Some(&p0)) = (tangents.first(), places.first()) else {
        let at_origin = frame(DVec3::ZERO, DVec3::Y, perpendicular(DVec3::Y, first_normal));
        return vec![at_origin; points.len()];
    };
    let mut frames = Vec::with_capacity(places.len());
    frames.push(frame(p0, t0, perpendicular(t0, first_normal)));
    for i in 1..places.len() {
        let before: Frame3 = frames[i - 1];
        let normal = double_reflection(&before, places[i], tangents[i]);
        frames.push(frame(places[i], tangents[i], perpendicular(tangents[i], Some(normal))));
    }
    owner.into_iter().map(|k| frames[k]).collect()
}

/// Returns the distinct usable points, and for each point which of them represents it.
fn distinct_places(points: &[DVec3]) -> (Vec<DVec3>, Vec<usize>) {
    let mut places: Vec<DVec3> = Vec::with_capacity(points.len());
    let owner = points
        .iter()
        .map(|&p| {
            if p.usable() && places.last().is_none_or(|&q| Vector::distance(p, q) > 0.0) {
                places.push(p);
            }
            places.len().saturating_sub(1)
        })
        .collect();
    (places, owner)
}

fn tangents(places: &[DVec3]) -> Vec<DVec3> {
    let mut into = None; // direction of arrival
    let n = places.len();
    (0..n)
        .map(|i| {
            let out = if i + 1 < n { (places[i + 1] - places[i]).direction() } else { None };
            let tangent = match (into, out) {
                // 1e-9: at a turn of 180 degrees the sum of the two directions is rounding noise.
                (Some(a), Some(b)) => {
                    let sum: DVec3 = a + b;
                    if Vector::length(sum) > 1e-9 { sum.direction().unwrap_or(a) } else { a }
                }
                (Some(a), None) | (None, Some(a)) => a,
                (None, None) => DVec3::Y,
            };
            into = out.or(into);
            tangent
        })
        .collect()
}

/// Carries the normal from one frame to the next point (not yet made orthonormal).
fn double_reflection(from: &Frame3, place: DVec3, tangent: DVec3) -> DVec3 {
    let reflect = |v: DVec3, mirror: Option<DVec3>| mirror.map_or(v, |m| v - m * (2.0 * Vector::dot(m, v)));
    let first = (place - from.origin).direction();
    let (normal, carried) = (reflect(from.normal, first), reflect(from.tangent, first));
    // Without length there is no second mirror: the first one alone has brought the tangents together.
    let gap = tangent - carried;
    if Vector::length(gap) > 1e-12 { reflect(normal, gap.direction()) } else { normal }
}

/// Returns a unit vector at right angles to the unit vector `tangent`, as near to `wish` as possible.
pub(crate) fn perpendicular(tangent: DVec3, wish: Option<DVec3>) -> DVec3 {
    let across = |v: DVec3| {
        let v = v.direction()?;
        let v = v - tangent * Vector::dot(v, tangent);
        // 1e-6: closer to parallel than this the rest is rounding noise. Twice is enough (Kahan).
        let v = if Vector::length(v) > 1e-6 { v.direction()? } else { return None };
        (v - tangent * Vector::dot(v, tangent)).direction()
    };
    // The coordinate axis that is least along the tangent; x first, so that it is the normal of a vertical line.
    let (x, y, z) = (tangent.x.abs(), tangent.y.abs(), tangent.z.abs());
    let axis = if x <= y && x <= z {
        DVec3::X
    } else if z <= y {
        DVec3::Z
    } else {
        DVec3::Y
    };
    wish.filter(|w| w.usable()).and_then(across).or_else(|| across(axis)).unwrap_or(DVec3::X)
}

fn frame(origin: DVec3, tangent: DVec3, normal: DVec3) -> Frame3 {
    Frame3 { origin, tangent, normal, binormal: tangent.cross(normal) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::ops;

    fn assert_orthonormal(f: &Frame3) {
        for v in [f.tangent, f.normal, f.binormal] {
            assert!((v.length() - 1.0).abs() < 1e-12, "{f:?}");
        }
        let skew = f.tangent.dot(f.normal).abs() + f.tangent.dot(f.binormal).abs();
        assert!(skew < 1e-12, "{f:?}");
    }

    /// Returns the rotation about the tangent from one normal to the next, after turning tangent onto tangent.
    fn twist(a: &Frame3, b: &Frame3) -> f64 {
        let axis = a.tangent.cross(b.tangent);
        let angle = ops::atan2(axis.length(), a.tangent.dot(b.tangent));
        let carried = if axis.length() > 1e-14 {
            base::turn::about(axis.normalize(), angle) * a.normal
        } else {
            a.normal
        };
        ops::atan2(carried.cross(b.normal).dot(b.tangent), carried.dot(b.normal))
    }

    fn helix(n: u32) -> Vec<DVec3> {
        (0..n)
            .map(|i| {
                let a = f64::from(i) * 4.0 * ops::PI / f64::from(n - 1);
                DVec3::new(ops::cos(a), ops::sin(a), 0.3 * a)
            })
            .collect()
    }

    #[test]
    fn helix_twists_by_no_more_than_the_turning_demands() {
        let frames = rotation_minimising_frames(&helix(400), None);
        let total: f64 = frames.windows(2).map(|w| twist(&w[0], &w[1])).sum();
        frames.iter().for_each(assert_orthonormal);
        // Parallel transport on the tangent sphere: the steps' twists vanish to third order.
        assert!(total.abs() < 1e-2, "{total}");
        // The Frenet frame of the same helix turns by torsion x length = 0.3/1.044 * 4 pi.
        let angle = |f: &Frame3| {
            let inwards = DVec3::new(-f.origin.x, -f.origin.y, 0.0).normalize();
            ops::atan2(inwards.dot(f.binormal), inwards.dot(f.normal))
        };
        let expected = 0.3 / (1.09_f64).sqrt() * 4.0 * ops::PI;
        let turned = (angle(&frames[399]) - angle(&frames[0])).abs() % ops::TAU;
        let error = (turned - expected % ops::TAU).abs().min((ops::TAU - turned - expected % ops::TAU).abs());
        assert!(error < 2e-2, "{turned} {expected}");
    }

    #[test]
    fn a_plane_curve_keeps_its_plane_normal() {
        let circle: Vec<_> =
            (0..50).map(|i| DVec3::from((base::turn::direction(f64::from(i) * 0.1), 0.0))).collect();
        for f in rotation_minimising_frames(&circle, Some(DVec3::Z)) {
            assert!((f.normal - DVec3::Z).length() < 1e-12, "{f:?}");
        }
    }

    #[test]
    fn frames_survive_repeats_turns_and_nan() {
        let line = [
            DVec3::NAN,
            DVec3::ZERO,
            DVec3::ZERO,
            DVec3::Y,
            DVec3::ZERO, // turns back
            DVec3::X,
            DVec3::INFINITY,
        ];
        let frames = rotation_minimising_frames(&line, Some(DVec3::Y));
        assert_eq!(frames.len(), 7);
        frames.iter().for_each(assert_orthonormal);
        assert_eq!((frames[0], frames[6]), (frames[1], frames[5]));
        assert_eq!(frames[0].tangent, DVec3::Y);
        let lone = rotation_minimising_frames(&[DVec3::ONE], None);
        assert_eq!((lone[0].origin, lone[0].tangent, lone[0].normal), (DVec3::ONE, DVec3::Y, DVec3::X));
        assert!(rotation_minimising_frames(&[], None).is_empty());
        assert_eq!(rotation_minimising_frames(&[DVec3::NAN; 2], None).len(), 2);
    }
}
