//! Converts modules to a skeleton, leaves and flowers, by a turtle.

use base::ops::{self, PI};
use glam::DVec3;

use super::derive::Modules;
use super::{LeafMark, Lsystem};
use crate::error::usable;
use crate::{JointId, Skeleton};

#[derive(Clone, Copy, Debug)]
struct Turtle {
    joint: JointId,
    heading: DVec3,
    left: DVec3,
    up: DVec3,
    diameter: f64,
}

/// Walks the modules of one tree; a walk that leaves the world stops there. Returns whether it did.
pub(super) fn draw(
    system: &Lsystem,
    modules: &Modules,
    root: DVec3,
    tree: u32,
    skeleton: &mut Skeleton,
    leaves: &mut Vec<LeafMark>,
) -> bool {
    let joint = skeleton.push_root(root, tree);
    skeleton.radius_m[joint.index()] = 0.5 * system.width_m;
    let mut turtle =
        Turtle { joint, heading: DVec3::Y, left: DVec3::NEG_X, up: DVec3::Z, diameter: system.width_m };
    let mut stack: Vec<Turtle> = Vec::new();
    let birth = system.steps.max(1);
    for (symbol, arguments) in modules.iter() {
        let first = arguments.first().copied();
        let angle = first.unwrap_or(system.angle_deg) * (PI / 180.0);
        let t = &mut turtle;
        match symbol {
            b'F' => {
                let length = first.unwrap_or(system.length_m);
                let at = skeleton.position[t.joint.index()] + t.heading * length;
                if !usable(at) {
                    return false;
                }
                if length.abs() > 1e-9 {
                    t.joint = skeleton.push(at, t.joint, birth);
                    skeleton.radius_m[t.joint.index()] = 0.5 * t.diameter;
                }
                t.bend(system.tropism);
            }
            b'+' => t.turn(t.up, angle),
            b'-' => t.turn(t.up, -angle),
            b'&' => t.turn(t.left, angle),
            b'^' => t.turn(t.left, -angle),
            b'\\' => t.turn(t.heading, angle),
            b'/' => t.turn(t.heading, -angle),
            b'|' => t.turn(t.up, PI),
            b'$' => t.level(),
            b'!' => t.diameter = first.unwrap_or(t.diameter * 0.7).max(0.0),
            b'L' | b'*' => leaves.push(LeafMark {
                joint: t.joint,
                heading: t.heading,
                up: t.up,
                scale: first.unwrap_or(1.0),
                flower: symbol == b'*',
            }),
            b'[' => stack.push(*t),
            b']' => turtle = stack.pop().unwrap_or(turtle),
            _ => {}
        }
    }
    true
}

impl Turtle {
    fn turn(&mut self, axis: DVec3, angle: f64) {
        let (s, c) = ops::sin_cos(angle);
        let about = |v: DVec3| v * c + axis.cross(v) * s + axis * (axis.dot(v) * (1.0 - c));
        self.set(about(self.heading), about(self.left));
    }

    /// Keeps the three directions at right angles however often they turn.
    fn set(&mut self, heading: DVec3, left: DVec3) {
        let heading = heading.normalize_or(DVec3::Y);
        let left = (left - heading * left.dot(heading)).try_normalize();
        self.left = left.unwrap_or_else(|| heading.any_orthonormal_vector());
        self.heading = heading;
        self.up = self.heading.cross(self.left);
    }

    /// Rolls until left is horizontal.
    fn level(&mut self) {
        let left = DVec3::Y.cross(self.heading);
        if left.length() > 1e-6 {
            self.set(self.heading, left.normalize());
        }
    }

    /// Turns by the torque of a steady pull: the angle is its strength times the sine between it and the heading.
    fn bend(&mut self, (direction, strength): (DVec3, f64)) {
        let torque = self.heading.cross(direction);
        let size = torque.length();
        if strength != 0.0 && size > 1e-12 {
            self.turn(torque / size, (strength * size).clamp(-1.5, 1.5));
        }
    }
}
