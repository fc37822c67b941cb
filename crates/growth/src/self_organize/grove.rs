//! The growing trees: joints with their buds.

use glam::DVec3;

use crate::{JointId, Skeleton};

/// No joint.
pub(super) const NONE: u32 = u32::MAX;

/// All trees of a run. Every joint ends an internode, may bear axillary buds, and carries the terminal bud if
/// nothing continues its axis.
#[derive(Clone, Debug)]
pub(super) struct Grove {
    pub(super) skeleton: Skeleton,
    /// What continues the axis.
    pub(super) main: Vec<u32>,
    /// Direction in which the joint grew, and a unit vector across it, carried along the axis without twist.
    pub(super) heading: Vec<DVec3>,
    pub(super) side: Vec<DVec3>,
    /// Number of the joint along its axis.
    pub(super) rank: Vec<u32>,
    /// Radius to the power of the pipe exponent; never falls.
    pub(super) wood: Vec<f64>,
    /// Buds at a joint.
    pub(super) per_node: usize,
    /// For each bud: the branch that it grew into, whether it still waits, and where it would grow.
    pub(super) lateral: Vec<u32>,
    pub(super) waits: Vec<bool>,
    pub(super) bud_heading: Vec<DVec3>,
}

impl Grove {
    pub(super) fn new(roots: Skeleton, per_node: usize) -> Self {
        let n = roots.len();
        Self {
            skeleton: roots,
            main: vec![NONE; n],
            heading: vec![DVec3::Y; n],
            side: vec![DVec3::X; n],
            rank: vec![0; n],
            wood: vec![0.0; n],
            per_node,
            lateral: vec![NONE; n * per_node],
            waits: vec![false; n * per_node],
            bud_heading: vec![DVec3::Y; n * per_node],
        }
    }

    pub(super) fn len(&self) -> usize {
        self.skeleton.len()
    }

    pub(super) fn parent(&self, j: usize) -> Option<usize> {
        self.skeleton.parent[j].map(JointId::index)
    }

    pub(super) fn bud_range(&self, j: usize) -> core::ops::Range<usize> {
        j * self.per_node..(j + 1) * self.per_node
    }

    pub(super) fn waiting_buds(&self, j: usize) -> u32 {
        self.bud_range(j).map(|k| u32::from(self.waits[k])).sum()
    }

    pub(super) fn starts_axis(&self, j: usize) -> bool {
        self.parent(j).is_none_or(|p| self.main[p] as usize != j)
    }

    /// Adds an internode; `bud` is the axillary bud it grows from, `None` for the terminal one.
    pub(super) fn grow(
        &mut self,
        parent: usize,
        bud: Option<usize>,
        heading: DVec3,
        length: f64,
        birth: u32,
    ) -> usize {
        let at = self.skeleton.position[parent] + heading * length;
        let id = self.skeleton.push(at, JointId::new(parent), birth);
        match bud {
            None => self.main[parent] = id.raw(),
            Some(k) => {
                self.lateral[k] = id.raw();
                self.waits[k] = false;
            }
        }
        let across = self.side[parent] - heading * self.side[parent].dot(heading);
        self.main.push(NONE);
        self.heading.push(heading);
        self.side.push(if across.length() > 1e-3 {
            across.normalize()
        } else {
            heading.any_orthonormal_vector()
        });
        self.rank.push(if bud.is_none() { self.rank[parent] + 1 } else { 0 });
        self.wood.push(0.0);
        for _ in 0..self.per_node {
            self.lateral.push(NONE);
            self.waits.push(false);
            self.bud_heading.push(heading);
        }
        id.index()
    }

    /// Keeps the joints for which `stays` holds. The buds of branches that are gone do not sprout again.
    pub(super) fn keep(&mut self, stays: &[bool]) {
        let (skeleton, new_id) = self.skeleton.keep_mapped(|j| stays[j]);
        let renamed = |old: u32| {
            let id = if old == NONE { None } else { new_id[old as usize] };
            id.map_or(NONE, JointId::raw)
        };
        let kept: Vec<usize> = (0..self.len()).filter(|&j| new_id[j].is_some()).collect();
        let n = self.per_node;
        let buds = || kept.iter().flat_map(move |&j| j * n..(j + 1) * n);
        self.lateral = buds().map(|k| renamed(self.lateral[k])).collect();
        self.waits = buds().map(|k| self.waits[k]).collect();
        self.bud_heading = buds().map(|k| self.bud_heading[k]).collect();
        self.main = kept.iter().map(|&j| renamed(self.main[j])).collect();
        self.heading = kept.iter().map(|&j| self.heading[j]).collect();
        self.side = kept.iter().map(|&j| self.side[j]).collect();
        self.rank = kept.iter().map(|&j| self.rank[j]).collect();
        self.wood = kept.iter().map(|&j| self.wood[j]).collect();
        self.skeleton = skeleton;
    }

    /// `d^n = d1^n + d2^n`, never less than before (Palubicki 2009, section 4.6).
    pub(super) fn thicken(&mut self, tip: f64) {
        let mut above = vec![0.0; self.len()];
        for j in (0..self.len()).rev() {
            let own: f64 = if above[j] > 0.0 { above[j] } else { tip };
            self.wood[j] = self.wood[j].max(own);
            if let Some(p) = self.parent(j) {
                above[p] += self.wood[j];
            }
        }
    }
}
