//! The growing trees: joints with their buds.

use core::ops::Range;

use glam::DVec3;

use crate::{JointId, Skeleton};

/// No joint; for a bud: it grew into a branch that was shed, or never existed.
pub(super) const NONE: u32 = u32::MAX;
/// In the place of a bud's branch: the bud still waits.
pub(super) const WAITS: u32 = u32::MAX - 1;

/// All trees of a run, by columns. Every joint ends an internode, may bear axillary buds, and carries the terminal bud
/// if nothing continues its axis.
#[derive(Clone, Debug)]
pub(super) struct Grove {
    /// While it grows, its radii represent wood: the radius to the power of the pipe exponent, which never decreases.
    pub(super) skeleton: Skeleton,
    /// The joint that continues the axis.
    pub(super) main: Vec<u32>,
    /// Direction in which the joint grew, and a unit vector across it, carried along the axis without twist.
    pub(super) heading: Vec<DVec3>,
    pub(super) side: Vec<DVec3>,
    /// Number of the joint along its axis.
    pub(super) rank: Vec<u32>,
    /// Buds at a joint.
    pub(super) per_node: usize,
    /// For each bud the branch that it grew into, or [`WAITS`].
    pub(super) lateral: Vec<u32>,
    /// A workspace: wood above each joint.
    above: Vec<f64>,
}

/// The joints that stay when some are shed: runs of rows, and the new row of every old one.
#[derive(Clone, Debug, Default)]
pub(super) struct Kept {
    runs: Vec<Range<usize>>,
    new_row: Vec<u32>,
}

impl Kept {
    /// Sets the kept joints by one flag for each joint.
    pub(super) fn set(&mut self, stays: &[bool]) {
        self.runs.clear();
        self.new_row.clear();
        let (mut row, mut next) = (0, 0);
        for run in stays.chunk_by(|a, b| a == b) {
            let old = row..row + run.len();
            row = old.end;
            if run[0] {
                self.new_row.extend(old.clone().map(|j| JointId::new(j - old.start + next).raw()));
                next += run.len();
                self.runs.push(old);
            } else {
                self.new_row.resize(row, NONE);
            }
        }
    }

    /// Closes the gaps of a column with `each` values per joint.
    pub(super) fn squeeze<T: Copy>(&self, column: &mut Vec<T>, each: usize) {
        let mut to = 0;
        for run in &self.runs {
            if run.start * each > to {
                column.copy_within(run.start * each..run.end * each, to);
            }
            to += run.len() * each;
        }
        column.truncate(to);
    }

    fn rename(&self, column: &mut [u32]) {
        for old in column {
            if *old < WAITS {
                *old = self.new_row[*old as usize];
            }
        }
    }
}

impl Grove {
    pub(super) fn new(roots: Skeleton, per_node: usize) -> Self {
        let n = roots.len();
        // Existing joints are bole: each continues its parent.
        let mut main = vec![NONE; n];
        for (j, parent) in roots.parent.iter().enumerate() {
            if let Some(p) = parent {
                main[p.index()] = JointId::new(j).raw();
            }
        }
        Self {
            skeleton: roots,
            main,
            heading: vec![DVec3::Y; n],
            side: vec![DVec3::X; n],
            rank: vec![0; n],
            per_node,
            lateral: vec![NONE; n * per_node],
            above: Vec::new(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.skeleton.len()
    }

    pub(super) fn parent(&self, j: usize) -> Option<usize> {
        self.skeleton.parent[j].map(JointId::index)
    }

    pub(super) fn bud_range(&self, j: usize) -> Range<usize> {
        j * self.per_node..(j + 1) * self.per_node
    }

    pub(super) fn waiting_buds(&self, j: usize) -> u32 {
        self.lateral[self.bud_range(j)].iter().map(|l| u32::from(*l == WAITS)).sum()
    }

    pub(super) fn starts_axis(&self, j: usize) -> bool {
        self.parent(j).is_none_or(|p| self.main[p] as usize != j)
    }

    /// Adds an internode with waiting buds; `bud` is the axillary bud from which it grows, `None` for the terminal one.
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
            Some(k) => self.lateral[k] = id.raw(),
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
        self.lateral.resize(self.lateral.len() + self.per_node, WAITS);
        id.index()
    }

    /// Keeps some joints. The buds of shed branches do not sprout again.
    pub(super) fn keep(&mut self, kept: &Kept) {
        let s = &mut self.skeleton;
        kept.squeeze(&mut s.position, 1);
        kept.squeeze(&mut s.parent, 1);
        kept.squeeze(&mut s.tree, 1);
        kept.squeeze(&mut s.birth, 1);
        kept.squeeze(&mut s.radius_m, 1);
        kept.squeeze(&mut self.main, 1);
        kept.squeeze(&mut self.heading, 1);
        kept.squeeze(&mut self.side, 1);
        kept.squeeze(&mut self.rank, 1);
        kept.squeeze(&mut self.lateral, self.per_node);
        kept.rename(&mut self.main);
        kept.rename(&mut self.lateral);
        for p in self.skeleton.parent.iter_mut().flatten() {
            *p = JointId::new(kept.new_row[p.index()] as usize);
        }
    }

    /// Thickens by `d^n = d1^n + d2^n`, never below the diameter before (Palubicki 2009, section 4.6).
    pub(super) fn thicken(&mut self, tip: f64) {
        let n = self.len();
        self.above.clear();
        self.above.resize(n, 0.0);
        let (above, wood) = (&mut self.above[..n], &mut self.skeleton.radius_m[..n]);
        for (j, parent) in self.skeleton.parent.iter().enumerate().rev() {
            let own: f64 = if above[j] > 0.0 { above[j] } else { tip };
            wood[j] = wood[j].max(own);
            if let Some(p) = parent {
                above[p.index()] += wood[j];
            }
        }
    }
}
