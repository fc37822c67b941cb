//! Joints that move a model's vertices.

use glam::{DQuat, DVec3};

use crate::Model;

/// A joint: a place that turns and moves, and what is held by it.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// Where it is at rest, metres. It is not turned then.
    pub at: DVec3,
}

/// What holds a vertex: at most four joints, by their rows, each with a share; shares add up to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Rows of joints; of no matter where the share is 0.
    pub joints: [u16; 4],
    /// Their shares, 0 to 1.
    pub shares: [f32; 4],
}

/// Joints of a model and how they move, in a loop.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rig {
    /// All joints. None hangs on another: each move is that of the joint alone.
    pub joints: Vec<Joint>,
    /// Of each part of the model, what holds each vertex.
    pub holds: Vec<Vec<Hold>>,
    /// Seconds of the keys, from 0, increasing; at the last all is as at the first.
    pub seconds: Vec<f32>,
    /// Of each joint at each key, its turn, and how far it is from its place at rest, metres.
    pub moves: Vec<Vec<(DQuat, DVec3)>>,
}

impl Rig {
    /// Whether it fits a model: a hold for each vertex, joints that are there, shares that add up, a move for each key.
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

    /// Where a vertex that is at `p` at rest is at a key: the mean of what its joints make of it.
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
