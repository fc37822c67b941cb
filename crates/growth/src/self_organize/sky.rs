//! Light from the sky on buds: a level square leaf at each joint, and the lines of light that meet it first.

use base::{Run, Seed};
use glam::DVec3;
use light::{Beams, Exposure, LightSpec, LitScene, Optics, SkyKind, exposure};

use crate::GrowthError;

/// Irradiance of the open sky: the result is a share of it.
const OPEN: f64 = 1.0;

/// Light on the leaves of all joints.
pub(super) struct Sky {
    beams: Beams,
    /// Edge of a leaf, metres.
    leaf_m: f64,
    lines: u32,
    /// Light in the open.
    pub(super) full: f64,
    exposures: Vec<Exposure>,
}

impl Sky {
    pub(super) fn new(leaf_m: f64, lines: u32, full: f64) -> Result<Self, GrowthError> {
        let beams = Beams::sky(SkyKind::Overcast, OPEN).map_err(light_fault)?;
        Ok(Self { beams, leaf_m, lines, full, exposures: Vec::new() })
    }

    /// Returns the work of a year in joints.
    pub(super) fn work(&self, joints: usize) -> usize {
        // Each of 46 directions takes about the time of a joint for four leaves, or for 32 lines.
        46 * (joints / 4 + self.lines as usize / 32)
    }

    /// Computes the light of every joint.
    pub(super) fn look(&mut self, joints: &[DVec3], seed: Seed, run: &Run<'_>) -> Result<(), GrowthError> {
        let half = 0.5 * self.leaf_m;
        let mut scene = LitScene { receivers: vec![Optics::BLACK; joints.len()], ..LitScene::default() };
        for (owner, joint) in (0_u32..).zip(joints) {
            let corner = |x: f64, z: f64| *joint + DVec3::new(x * half, 0.0, z * half);
            scene.points.extend([corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)]);
            let first = 4 * owner;
            scene.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            scene.owners.extend([owner; 2]);
        }
        let lowest = joints.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let spec =
            LightSpec { lines: self.lines, bounces: 0, ground_m: lowest - 1.0, ..LightSpec::default() };
        self.exposures = exposure(&scene, &self.beams, &spec, seed, run).map_err(light_fault)?;
        Ok(())
    }

    /// Returns the light of each joint: `full` in the open.
    pub(super) fn lights(&self) -> impl Iterator<Item = f64> {
        let open = OPEN * self.leaf_m * self.leaf_m;
        self.exposures.iter().map(move |e| self.full * e.incident_w / open)
    }

    /// Returns the direction from which a joint gets most of its light; zero in the dark.
    pub(super) fn towards(&self, joint: usize) -> DVec3 {
        self.exposures.get(joint).map_or(DVec3::ZERO, |e| e.towards_w.normalize_or_zero())
    }

    /// Removes joints that were shed.
    pub(super) fn keep(&mut self, kept: &super::Kept) {
        kept.squeeze(&mut self.exposures, 1);
    }
}

fn light_fault(fault: light::LightError) -> GrowthError {
    match fault {
        light::LightError::Cancelled(cancelled) => cancelled.into(),
        light::LightError::OverBudget(much) => much.into(),
        other => GrowthError::Light { why: other.to_string() },
    }
}
