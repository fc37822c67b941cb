//! Joints that move a model's vertices.

use glam::{DQuat, DVec3};

use crate::Model;

/// A joint: a place that rotates and moves, together with the vertices bound to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// Place at rest, metres. Its rotation is then the identity.
    pub at: DVec3,
}

/// Binding of a vertex: at most four joints, by their rows, each with a share; shares add up to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Rows of joints; ignored where the share is 0.
    pub joints: [u16; 4],
    /// Their shares, 0 to 1.
    pub shares: [f32; 4],
}

/// Joints of a model and their looping animation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rig {
    /// All joints. No joint is the child of another: each moves by itself.
    pub joints: Vec<Joint>,
    /// Binding of each vertex, for each part of the model.
    pub holds: Vec<Vec<Hold>>,
    /// Seconds of the keys, from 0, increasing; the last key is equal to the first.
    pub seconds: Vec<f32>,
    /// Rotation and offset from the place at rest in metres, for each joint at each key.
    pub moves: Vec<Vec<(DQuat, DVec3)>>,
}

impl Rig {
    /// Returns whether the rig fits a model: it binds each vertex, its joints exist, its shares add up, and it has a
    /// move for each key.
    pub fn fits(&self, model: &Model) -> bool {
        let held = |h: &Hold| {
            let there =
                h.joints.iter().zip(&h.shares).all(|(j, s)| *s == 0.0 || usize::from(*j) < self.joints.len());
            there
                && h.shares.iter().all(|s| (0.0..=1.0).contains(s))
                && (h.shares.iter().sum::<f32>() - 1.0).abs() < 1e-4
        };
        let sound = |m: &(DQuat, DVec3)| m.0.is_normalized() && m.1.is_finite();
        self.holds.len() == model.parts.len()
            && self.holds.iter().zip(&model.parts).all(|(h, p)| h.len() == p.mesh.positions.len())
            && self.holds.iter().flatten().all(held)
            && self.seconds.windows(2).all(|w| w[0] < w[1])
            && self.seconds.first().is_some_and(|s| *s == 0.0)
            && self.moves.len() == self.joints.len()
            && self.moves.iter().all(|m| m.len() == self.seconds.len() && m.iter().all(sound))
            && self.joints.iter().all(|j| j.at.is_finite())
    }

    /// Returns the position at a key of a vertex that is at `p` at rest: the mean of the positions that its joints
    /// give it.
    pub fn moved(&self, p: DVec3, hold: &Hold, key: usize) -> DVec3 {
        let by = |(joint, share): (&u16, &f32)| {
            let (Some(j), Some((turn, shift))) = (
                self.joints.get(usize::from(*joint)),
                self.moves.get(usize::from(*joint)).and_then(|m| m.get(key)),
            ) else {
                return DVec3::ZERO;
            };
            (j.at + *shift + *turn * (p - j.at)) * f64::from(*share)
        };
        hold.joints.iter().zip(&hold.shares).map(by).sum()
    }
}
