//! Rotations with the same bits on native and WASM.
//!
//! `glam`'s own functions of angles call the platform's sine and cosine; these call [`ops`]. Everything else of
//! `glam` (products, lengths, normals) is made of exact operations and may be used as it is.

use glam::{DQuat, DVec2, DVec3};

use crate::ops;

/// Returns the unit vector at an angle in radians from +x towards +y.
#[inline]
pub fn direction(angle: f64) -> DVec2 {
    let (s, c) = ops::sin_cos(angle);
    DVec2::new(c, s)
}

/// Returns the rotation by an angle in radians about a unit vector, right-handed.
///
/// ```
/// use glam::DVec3;
/// let turned = base::turn::about(DVec3::Y, base::ops::FRAC_PI_2) * DVec3::Z;
/// assert!(turned.distance(DVec3::X) < 1e-15);
/// ```
#[inline]
pub fn about(axis: DVec3, angle: f64) -> DQuat {
    let (s, c) = ops::sin_cos(0.5 * angle);
    DQuat::from_xyzw(axis.x * s, axis.y * s, axis.z * s, c)
}

/// Returns the smallest rotation of one unit vector onto another; of opposite vectors any half turn.
pub fn between(from: DVec3, to: DVec3) -> DQuat {
    const NEARLY: f64 = 1.0 - 2.0 * f64::EPSILON;
    let dot = from.dot(to);
    if dot > NEARLY {
        DQuat::IDENTITY
    } else if dot < -NEARLY {
        about(from.any_orthonormal_vector(), ops::PI)
    } else {
        let c = from.cross(to);
        DQuat::from_xyzw(c.x, c.y, c.z, 1.0 + dot).normalize()
    }
}

/// Returns a share of a rotation, the shorter way round: none at 0, all of it at 1 (spherical linear interpolation).
///
/// ```
/// use glam::DVec3;
/// let quarter = base::turn::about(DVec3::Y, 1.0);
/// let half = base::turn::part(quarter, 0.5);
/// assert!((half.w - base::turn::about(DVec3::Y, 0.5).w).abs() < 1e-15);
/// ```
pub fn part(turn: DQuat, share: f64) -> DQuat {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let angle = ops::acos_clamped(turn.w);
    let sine = ops::sin(angle);
    if turn.w > 1.0 - f64::EPSILON || sine <= 0.0 {
        return (DQuat::IDENTITY + (turn - DQuat::IDENTITY) * share).normalize();
    }
    let (rest, part) = (ops::sin(angle * (1.0 - share)), ops::sin(angle * share));
    (DQuat::IDENTITY * rest + turn * part) * (1.0 / sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_between_vectors_brings_one_onto_the_other() {
        let vectors =
            [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::new(0.6, 0.0, -0.8), DVec3::new(0.0, 0.28, 0.96)];
        for a in vectors {
            for b in vectors.into_iter().chain([-a, a]) {
                assert!((between(a, b) * a).distance(b) < 1e-14, "{a} {b}");
            }
        }
    }

    #[test]
    fn parts_of_a_turn_add_up_to_it() {
        let axis = DVec3::new(0.36, 0.48, 0.8);
        for angle in [0.0, 1e-12, 0.3, 2.0, 3.1] {
            let whole = about(axis, angle);
            for sign in [whole, -whole] {
                let twice = part(sign, 0.5) * part(sign, 0.5);
                assert!(twice.dot(whole).abs() > 1.0 - 1e-14, "{angle}");
                assert!((part(sign, 0.25).dot(about(axis, 0.25 * angle)) - 1.0).abs() < 1e-14, "{angle}");
            }
        }
    }
}
