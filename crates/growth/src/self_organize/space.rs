//! Free space as markers: a bud has light if any free marker is nearest to it and in its cone.

use base::{Budget, Counted, OverBudget};
use geom::KdTree;
use glam::DVec3;

use super::grove::{Grove, Kept, NONE, WAITS};

/// Marks a marker without a bud.
const FREE: u32 = u32::MAX;

/// Markers, and the perception of the buds in the last round. Palubicki et al. 2009, section 4.1.
#[derive(Clone, Debug)]
pub(super) struct Space {
    markers: Vec<DVec3>,
    grid: KdTree,
    gone: Vec<bool>,
    occupancy: f64,
    perception: f64,
    cos_half: f64,
    /// Nearest bud of each marker in this round: distance squared and the bud's row.
    best: Vec<(f64, u32)>,
    /// Sum of directions of each bud: `1 + per_node` rows per joint, the terminal bud first.
    sum: Vec<DVec3>,
    stride: usize,
    /// Direction of growth of each axillary bud.
    bud_heading: Vec<DVec3>,
    near: Vec<usize>,
    /// Number of markers that buds have examined.
    looks: u64,
}

impl Space {
    /// Indexes the markers. `reach`: occupancy and perception radius, metres; `half_angle` of the cone, radians.
    pub(super) fn new(markers: &[DVec3], reach: (f64, f64), half_angle: f64) -> Self {
        Self {
            grid: KdTree::new(markers),
            gone: vec![false; markers.len()],
            best: vec![(f64::INFINITY, FREE); markers.len()],
            markers: markers.to_vec(),
            occupancy: reach.0,
            perception: reach.1,
            cos_half: base::ops::cos(half_angle),
            sum: Vec::new(),
            stride: 1,
            bud_heading: Vec::new(),
            near: Vec::new(),
            looks: 0,
        }
    }

    /// Stores the directions of growth of the buds of the next joint.
    pub(super) fn set_buds(&mut self, headings: impl Iterator<Item = DVec3>) {
        self.bud_heading.extend(headings);
    }

    /// Removes the markers within the occupancy radius of new joints permanently.
    pub(super) fn take_room(&mut self, joints: &[DVec3]) {
        let mut near = core::mem::take(&mut self.near);
        for &p in joints {
            near.clear();
            self.grid.within(p, self.occupancy, &mut near);
            self.looks += near.len() as u64;
            near.iter().for_each(|&m| self.gone[m] = true);
        }
        self.near = near;
    }

    /// Assigns every free marker to the nearest bud in whose cone it lies.
    ///
    /// # Errors
    /// [`OverBudget`].
    pub(super) fn look(&mut self, grove: &Grove, budget: &Budget) -> Result<(), OverBudget> {
        self.stride = 1 + grove.per_node;
        self.best.fill((f64::INFINITY, FREE));
        self.sum.clear();
        self.sum.resize(grove.len() * self.stride, DVec3::ZERO);
        for j in 0..grove.len() {
            budget.check(
                Counted::MarkerQueries,
                self.looks,
                "lower light.perception, light.markers or years",
            )?;
            if grove.main[j] == NONE {
                self.claim(grove.skeleton.position[j], grove.heading[j], j * self.stride);
            }
            for (i, k) in grove.bud_range(j).enumerate() {
                if grove.lateral[k] == WAITS {
                    let row = j * self.stride + 1 + i;
                    self.claim(grove.skeleton.position[j], self.bud_heading[k], row);
                }
            }
        }
        for (m, &(_, row)) in self.best.iter().enumerate() {
            if row != FREE {
                let j = row as usize / self.stride;
                self.sum[row as usize] += (self.markers[m] - grove.skeleton.position[j]).normalize_or_zero();
            }
        }
        Ok(())
    }

    fn claim(&mut self, at: DVec3, heading: DVec3, row: usize) {
        let mut near = core::mem::take(&mut self.near);
        near.clear();
        self.grid.within(at, self.perception, &mut near);
        self.looks += near.len() as u64;
        for &m in near.iter().filter(|&&m| !self.gone[m]) {
            let to = self.markers[m] - at;
            let d2 = to.length_squared();
            if d2 < self.best[m].0 && to.dot(heading) >= self.cos_half * d2.sqrt() {
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "fewer buds than 2^32: joints are bounded"
                )]
                let row = row as u32;
                self.best[m] = (d2, row);
            }
        }
        self.near = near;
    }

    /// Returns Q of the buds of a joint: 1 if any found room, 0 if none did.
    pub(super) fn light_at(&self, j: usize) -> f64 {
        let rows = &self.sum[j * self.stride..(j + 1) * self.stride];
        if rows.iter().any(|s| *s != DVec3::ZERO) { 1.0 } else { 0.0 }
    }

    /// Returns the direction V of one bud.
    pub(super) fn direction_of_bud(&self, joint: usize, bud: Option<usize>) -> DVec3 {
        let per_node = self.stride - 1;
        let row = joint * self.stride + bud.map_or(0, |k| 1 + k - joint * per_node);
        self.sum[row].normalize_or_zero()
    }

    /// Removes the buds of shed joints and their perception.
    pub(super) fn keep(&mut self, kept: &Kept) {
        kept.squeeze(&mut self.sum, self.stride);
        kept.squeeze(&mut self.bud_heading, self.stride - 1);
    }
}
