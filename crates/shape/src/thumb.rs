//! A thumb on a touchpad or stick: exact rotations, and the tilt of the drawing plane (the VR paper).

use base::ops::{self, PI};
use glam::DVec2;

/// Distance from the centre, as a share of the pad, within which the angle of a thumb is undefined.
const DEAD: f64 = 0.15;

/// A thumb that rotates the held branch, on a pad or stick of radius 1.
///
/// ```
/// use glam::DVec2;
/// use shape::Thumb;
/// let mut thumb = Thumb::default();
/// assert_eq!(thumb.turn(Some(DVec2::X)), 0.0); // it was put down
/// assert!((thumb.turn(Some(DVec2::Y)) - 1.570_796).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Thumb {
    last: Option<DVec2>,
}

impl Thumb {
    /// Returns the rotation since the last position, radians, counter-clockwise: `atan2(a x b, a . b)`, above -pi and
    /// at most pi.
    ///
    /// `at`: position of the thumb, the centre of the pad 0, its rim 1, x to the right and y up; `None` when it is
    /// lifted. 0 when it has just been put down, near the centre, or for invalid positions. The rotations add up to the
    /// angle between the first and the last position, over any number of rounds, if no step is half a round or more.
    pub fn turn(&mut self, at: Option<DVec2>) -> f64 {
        let now = at.filter(|p| p.is_finite() && p.length() >= DEAD);
        let turn = match (self.last, now) {
            (Some(a), Some(b)) => ops::atan2(a.perp_dot(b), a.dot(b)),
            _ => 0.0,
        };
        // A move through the centre to the other side is not a rotation: it begins anew there.
        self.last = now;
        turn
    }
}

/// Returns the tilt of the drawing plane, radians, -pi/2 to pi/2: by the distance from the centre, away from the viewer
/// in the upper half of the pad and towards the viewer in the lower one. For controllers that only point, it sets the
/// depth of a stroke.
///
/// `at` as in [`Thumb::turn`]; 0 near the centre, on the line between the halves, or for invalid positions.
pub fn lean_of_thumb(at: DVec2) -> f64 {
    let reach = at.length();
    if !at.is_finite() || reach < DEAD || at.y == 0.0 {
        return 0.0;
    }
    0.5 * PI * reach.min(1.0) * at.y.signum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn on_rim(angle: f64, reach: f64) -> DVec2 {
        let (s, c) = ops::sin_cos(angle);
        DVec2::new(c, s) * reach
    }

    #[test]
    fn rounds_add_up() {
        for rounds in [-3.0, -0.25, 0.5, 2.0] {
            let mut thumb = Thumb::default();
            let whole = 2.0 * PI * rounds;
            // The radius changes on the way: an angle does not depend on it.
            let places = (0..=60).map(|k| f64::from(k) / 60.0);
            let sum: f64 = places.map(|t| thumb.turn(Some(on_rim(0.7 + whole * t, 0.3 + 0.7 * t)))).sum();
            assert!((sum - whole).abs() < 1e-9, "{rounds}: {sum}");
        }
    }

    #[test]
    fn a_thumb_that_is_lifted_or_near_the_centre_turns_nothing() {
        let mut thumb = Thumb::default();
        assert_eq!(thumb.turn(Some(DVec2::X)), 0.0);
        assert_eq!(thumb.turn(None), 0.0);
        assert_eq!(thumb.turn(Some(DVec2::Y)), 0.0, "put down elsewhere");
        assert_eq!(thumb.turn(Some(DVec2::splat(0.05))), 0.0);
        assert_eq!(thumb.turn(Some(-DVec2::X)), 0.0, "through the centre");
        assert_eq!(thumb.turn(Some(DVec2::splat(f64::NAN))), 0.0);
    }

    #[test]
    fn the_plane_leans_with_the_distance() {
        assert_eq!(lean_of_thumb(DVec2::new(0.1, 0.1)), 0.0);
        assert!((lean_of_thumb(DVec2::new(0.3, 0.4)) - 0.25 * PI).abs() < 1e-12);
        assert!((lean_of_thumb(DVec2::new(0.0, -2.0)) + 0.5 * PI).abs() < 1e-12, "a stick beyond its rim");
        assert_eq!(lean_of_thumb(DVec2::X), 0.0);
        assert_eq!(lean_of_thumb(DVec2::new(f64::INFINITY, 1.0)), 0.0);
    }

    proptest! {
        #[test]
        fn a_step_is_the_angle_between_its_ends(
            from in 0.0..2.0 * PI, by in -3.0..3.0_f64, r in DEAD..1.0, s in DEAD..1.0,
        ) {
            let mut thumb = Thumb::default();
            thumb.turn(Some(on_rim(from, r * 1.001)));
            let turn = thumb.turn(Some(on_rim(from + by, s * 1.001)));
            prop_assert!((turn - by).abs() < 1e-9);
        }
    }
}
