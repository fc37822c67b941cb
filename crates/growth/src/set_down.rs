//! Placement of obstacles by hand.
//!
//! `Obstacle, SetDown -> Obstacle`

use base::ops::{self, TAU};
use glam::{DQuat, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Obstacle;

/// A movement: scaling and rotation about a point, followed by a translation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SetDown {
    /// Fixed point of the scaling and rotation; metres.
    #[schemars(with = "[f64; 3]")]
    pub about: DVec3,
    /// Rotation as a quaternion (x, y, z, w) of any length above 0.
    #[schemars(with = "[f64; 4]")]
    pub turn: DQuat,
    /// Factor on the size, 0.01 to 100.
    pub times: f64,
    /// Offset, metres.
    #[schemars(with = "[f64; 3]")]
    pub by: DVec3,
}

impl Default for SetDown {
    fn default() -> Self {
        Self { about: DVec3::ZERO, turn: DQuat::IDENTITY, times: 1.0, by: DVec3::ZERO }
    }
}

/// Rotation, radians, below which an obstacle counts as upright as before: nobody makes a smaller one on purpose.
const STEADY: f64 = 0.05;
/// Sides of a cylinder that is no longer upright.
const SIDES: u32 = 32;
/// Largest distance of a place from the origin, metres.
const FAR_M: f64 = 1e5;
/// Faces of a box whose corner `k` is at its upper end in x, y and z if bits 0, 1 and 2 of `k` are set.
const FACES: [[u32; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

impl SetDown {
    /// Returns the same with a rotation of length 1, or none if it is negligible; `None` for numbers out of range.
    pub fn sound(self) -> Option<Self> {
        let Self { about, turn, times, by } = self;
        let near = |p: DVec3| p.is_finite() && p.abs().max_element() <= FAR_M;
        let is_turn = turn.is_finite() && (1e-12..1e12).contains(&turn.length_squared());
        if !(near(about) && near(by) && is_turn && (0.01..=100.0).contains(&times)) {
            return None;
        }
        let turn = turn.normalize();
        let is_steady = 2.0 * ops::acos_clamped(turn.w.abs()) < STEADY;
        Some(Self { turn: if is_steady { DQuat::IDENTITY } else { turn }, ..self })
    }

    fn put(&self, p: DVec3) -> DVec3 {
        self.about + self.turn * (p - self.about) * self.times + self.by
    }
}

impl Obstacle {
    /// Returns the obstacle after a movement. Boxes and cylinders that are tilted become meshes, cylinders of 32 sides.
    /// `how` must be [sound](SetDown::sound).
    ///
    /// ```
    /// use glam::{DQuat, DVec3};
    /// use growth::{Obstacle, SetDown};
    /// let wall = Obstacle::Plane { point: DVec3::X, normal: DVec3::X };
    /// let quarter = SetDown { turn: DQuat::from_xyzw(0.0, 1.0, 0.0, 1.0), ..SetDown::default() };
    /// let Obstacle::Plane { point, normal } = wall.placed(&quarter.sound().expect("sound")) else { unreachable!() };
    /// assert!((point + DVec3::Z).length() < 1e-12 && (normal + DVec3::Z).length() < 1e-12);
    /// ```
    #[must_use]
    pub fn placed(&self, how: &SetDown) -> Self {
        let SetDown { turn, times, .. } = *how;
        let put = |p: DVec3| how.put(p);
        match self {
            Self::Sphere { centre, radius_m } => {
                Self::Sphere { centre: put(*centre), radius_m: radius_m * times }
            }
            Self::Plane { point, normal } => Self::Plane { point: put(*point), normal: turn * *normal },
            Self::Mesh { vertices, triangles } => Self::Mesh {
                vertices: vertices.iter().map(|p| put(*p)).collect(),
                triangles: triangles.clone(),
            },
            Self::Box { min, max } if turn == DQuat::IDENTITY => Self::Box { min: put(*min), max: put(*max) },
            Self::Box { min, max } => {
                let end = |k: usize, axis: usize| if k >> axis & 1 == 1 { max[axis] } else { min[axis] };
                let corners = (0..8).map(|k| put(DVec3::new(end(k, 0), end(k, 1), end(k, 2))));
                Self::Mesh { vertices: corners.collect(), triangles: FACES.to_vec() }
            }
            // Rotated about itself it is the same one.
            Self::Cylinder { base, radius_m, height_m } if (turn * DVec3::Y).y > 1.0 - 1e-9 => {
                Self::Cylinder { base: put(*base), radius_m: radius_m * times, height_m: height_m * times }
            }
            Self::Cylinder { base, radius_m, height_m } => {
                let rim = |y: f64| {
                    (0..SIDES).map(move |k| {
                        let (sin, cos) = ops::sin_cos(TAU * f64::from(k) / f64::from(SIDES));
                        put(*base + DVec3::new(radius_m * cos, y, -radius_m * sin))
                    })
                };
                let ends = [0.0, *height_m].map(|y| put(*base + DVec3::Y * y));
                let faces = (0..SIDES).flat_map(|k| {
                    let next = (k + 1) % SIDES;
                    let (above, beyond) = (k + SIDES, next + SIDES);
                    [
                        [k, next, beyond],
                        [k, beyond, above],
                        [2 * SIDES, next, k],
                        [2 * SIDES + 1, above, beyond],
                    ]
                });
                Self::Mesh {
                    vertices: rim(0.0).chain(rim(*height_m)).chain(ends).collect(),
                    triangles: faces.collect(),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Obstacles;
    use crate::solid::tests::sphere;

    fn all() -> Vec<Obstacle> {
        let (vertices, triangles) = sphere(12, 16);
        vec![
            Obstacle::Box { min: DVec3::new(-1.0, 0.0, -0.5), max: DVec3::new(1.0, 2.0, 0.5) },
            Obstacle::Sphere { centre: DVec3::Y, radius_m: 1.0 },
            Obstacle::Cylinder { base: DVec3::ZERO, radius_m: 0.8, height_m: 2.0 },
            Obstacle::Plane { point: DVec3::X, normal: DVec3::new(2.0, 0.0, 1.0) },
            Obstacle::Mesh { vertices, triangles },
        ]
    }

    #[test]
    fn what_is_in_a_thing_is_in_it_where_a_hand_sets_it_down() {
        let mut s = base::Seed::new(5).stream(base::Draw::Test);
        for o in all() {
            for _ in 0..6 {
                let mut n = || s.range(-1.0, 1.0);
                let how = SetDown {
                    about: DVec3::new(n(), n(), n()),
                    turn: DQuat::from_xyzw(n(), n(), n(), n()),
                    times: 1.0 + 0.9 * n(),
                    by: DVec3::new(n(), n(), n()),
                };
                let how = how.sound().expect("sound");
                let ready = |o: &Obstacle| Obstacles::new(core::slice::from_ref(o), 0.0).expect("sound");
                let (before, after) = (ready(&o), ready(&o.placed(&how)));
                let mut compared = [0; 2];
                for _ in 0..1000 {
                    let p = DVec3::new(s.range(-2.0, 2.0), s.range(-1.0, 3.0), s.range(-2.0, 2.0));
                    let is_in = |p: DVec3| before.inside(p).is_some();
                    // Near the surface it may be either: the sides of a cylinder are flat now.
                    let around = DVec3::AXES.iter().flat_map(|a| [*a * 0.02, *a * -0.02]);
                    if around.map(|d| is_in(p + d)).all(|near| near == is_in(p)) {
                        let there = after.inside(how.put(p)).is_some();
                        assert_eq!(there, is_in(p), "{o:?} {how:?} {p}");
                        compared[usize::from(there)] += 1;
                    }
                }
                assert!(compared[0] > 100 && compared[1] > 20, "{o:?}: {compared:?}");
            }
        }
    }

    #[test]
    fn a_thing_that_is_hardly_turned_stays_what_it_is() {
        let slight =
            SetDown { turn: DQuat::from_xyzw(0.01, 0.0, 0.0, 1.0), times: 2.0, ..SetDown::default() };
        for o in all() {
            assert_eq!(o.placed(&slight.sound().expect("sound")).shape(), o.shape());
        }
        for bad in [
            SetDown { times: f64::NAN, ..SetDown::default() },
            SetDown { times: 0.0, ..SetDown::default() },
            SetDown { by: DVec3::splat(1e9), ..SetDown::default() },
            SetDown { turn: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..SetDown::default() },
            SetDown { turn: DQuat::from_xyzw(f64::INFINITY, 0.0, 0.0, 1.0), ..SetDown::default() },
        ] {
            assert_eq!(bad.sound(), None, "{bad:?}");
        }
    }
}
