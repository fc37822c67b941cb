//! The bare structure that growth makes: joints, each with its parent.
//!
//! `grower -> Skeleton -> prune, at_age, to_plant`

use base::{Digest, Digestible};
use glam::DVec3;

base::define_id! {
    /// One joint of a skeleton.
    pub struct JointId;
}

/// A forest of joints. A joint always comes after its parent.
///
/// ```
/// use glam::DVec3;
/// use growth::Skeleton;
/// let mut s = Skeleton::default();
/// let root = s.push_root(DVec3::ZERO, 0);
/// let up = s.push(DVec3::Y, root, 1);
/// s.push(DVec3::Y * 2.0, up, 2);
/// assert_eq!((s.len(), s.at_age(1).len(), s.validate().count()), (3, 2, 0));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skeleton {
    /// Position, metres, +Y up.
    pub position: Vec<DVec3>,
    /// Parent of each joint; `None` for roots.
    pub parent: Vec<Option<JointId>>,
    /// Index of the tree that each joint belongs to.
    pub tree: Vec<u32>,
    /// The step of growth in which each joint appeared.
    pub birth: Vec<u32>,
    /// Least radius of a joint (wood never shrinks); 0 if growth did not compute it.
    pub radius_m: Vec<f64>,
}

/// A fault of a skeleton: always our bug.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SkeletonFault {
    /// The columns differ in length.
    #[error("the columns differ in length")]
    Ragged,
    /// A position is not finite, or a radius is negative or not finite.
    #[error("{0}: bad position or radius")]
    Numbers(JointId),
    /// The parent does not come before the joint.
    #[error("{0}: the parent does not come before it")]
    Parent(JointId),
    /// The parent belongs to another tree or was born later.
    #[error("{0}: belongs to another tree than its parent, or is older")]
    Lineage(JointId),
}

impl Skeleton {
    /// Returns the number of joints.
    pub const fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are no joints.
    pub const fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Adds the first joint of tree `tree`.
    pub fn push_root(&mut self, at: DVec3, tree: u32) -> JointId {
        self.add(at, None, tree, 0)
    }

    /// Adds a child of `parent`.
    pub fn push(&mut self, at: DVec3, parent: JointId, birth: u32) -> JointId {
        self.add(at, Some(parent), self.tree[parent.index()], birth)
    }

    fn add(&mut self, at: DVec3, parent: Option<JointId>, tree: u32, birth: u32) -> JointId {
        self.position.push(at);
        self.parent.push(parent);
        self.tree.push(tree);
        self.birth.push(birth);
        self.radius_m.push(0.0);
        JointId::new(self.position.len() - 1)
    }

    /// Returns the unit direction in which a joint grew; up for roots.
    pub fn heading(&self, joint: JointId) -> DVec3 {
        let from = self.parent[joint.index()].map_or(DVec3::ZERO, |p| self.position[p.index()]);
        if self.parent[joint.index()].is_none() {
            return DVec3::Y;
        }
        (self.position[joint.index()] - from).normalize_or(DVec3::Y)
    }

    /// Returns the diagonal of the box around all joints, metres.
    pub(crate) fn size(&self) -> f64 {
        let all = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (lo, hi) = self.position.iter().fold(all, |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        if self.is_empty() { 0.0 } else { lo.distance(hi) }
    }

    /// Returns the last step of growth.
    pub fn age(&self) -> u32 {
        self.birth.iter().copied().max().unwrap_or(0)
    }

    /// Returns the skeleton as it was after step `age`. Radii are dropped, as they were smaller then.
    #[must_use]
    pub fn at_age(&self, age: u32) -> Self {
        let mut young = self.keep(|j| self.birth[j] <= age);
        young.radius_m.fill(0.0);
        young
    }

    /// Returns the skeleton without `joint` and all that grew from it. Everything else stays as it is and in order.
    ///
    /// ```
    /// use glam::DVec3;
    /// let mut s = growth::Skeleton::default();
    /// let root = s.push_root(DVec3::ZERO, 0);
    /// let left = s.push(DVec3::X, root, 1);
    /// let right = s.push(DVec3::NEG_X, root, 1);
    /// s.push(DVec3::X * 2.0, left, 2);
    /// assert_eq!(s.prune(left).position, [DVec3::ZERO, DVec3::NEG_X]);
    /// # let _ = right;
    /// ```
    #[must_use]
    pub fn prune(&self, joint: JointId) -> Self {
        self.keep(|j| j != joint.index())
    }

    /// Returns the joints for which `stays` holds; joints without their parent are removed too.
    #[must_use]
    pub fn keep(&self, stays: impl Fn(usize) -> bool) -> Self {
        self.keep_mapped(stays).0
    }

    /// As [`keep`](Self::keep), with the new handle of every old joint.
    pub(crate) fn keep_mapped(&self, stays: impl Fn(usize) -> bool) -> (Self, Vec<Option<JointId>>) {
        let mut kept = Self::default();
        let mut new_id: Vec<Option<JointId>> = Vec::with_capacity(self.len());
        for j in 0..self.len() {
            let parent = self.parent[j].map(|p| new_id[p.index()]);
            new_id.push(match parent {
                Some(None) => None,
                _ if !stays(j) => None,
                parent => {
                    let id = kept.add(self.position[j], parent.flatten(), self.tree[j], self.birth[j]);
                    kept.radius_m[id.index()] = self.radius_m[j];
                    Some(id)
                }
            });
        }
        (kept, new_id)
    }

    /// Returns one tree of several.
    #[must_use]
    pub fn tree(&self, tree: u32) -> Self {
        self.keep(|j| self.tree[j] == tree)
    }

    /// Returns the number of children of each joint.
    pub fn children(&self) -> Vec<u32> {
        let mut children = vec![0; self.len()];
        for p in self.parent.iter().flatten() {
            children[p.index()] += 1;
        }
        children
    }

    /// Iterates over all faults. Cost: linear.
    pub fn validate(&self) -> impl Iterator<Item = SkeletonFault> + '_ {
        let n = self.len();
        let ragged = [self.parent.len(), self.tree.len(), self.birth.len(), self.radius_m.len()]
            .iter()
            .any(|&l| l != n);
        let joints = if ragged { 0 } else { n };
        let each = (0..joints).filter_map(|j| {
            let id = JointId::new(j);
            let r = self.radius_m[j];
            if !(self.position[j].is_finite() && r.is_finite() && r >= 0.0) {
                return Some(SkeletonFault::Numbers(id));
            }
            let p = self.parent[j]?.index();
            if p >= j {
                return Some(SkeletonFault::Parent(id));
            }
            let kin = self.tree[p] == self.tree[j] && self.birth[p] <= self.birth[j];
            (!kin).then_some(SkeletonFault::Lineage(id))
        });
        ragged.then_some(SkeletonFault::Ragged).into_iter().chain(each)
    }
}

impl Digestible for Skeleton {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.position).add(&self.radius_m).add(&(self.len() as u64));
        for j in 0..self.len() {
            d.add(&self.parent[j].map(JointId::raw)).add(&self.tree[j]).add(&self.birth[j]);
        }
    }
}
