//! A branch in the hand: how it goes, with all that it bears, as one solid thing.
//!
//! `Plant, branch, where to -> a turn and a way`

use glam::{DQuat, DVec3};
use plant::{AxisId, Plant};

/// How a branch and all that it bears is carried: `p -> to + turn * (p - from)`, metres.
///
/// What it bears goes with it as it is, and nothing else moves: so a shell may move what it shows of the branch, and needs
/// no mesh of the plant before the hand lets go. Radii of what bears it may change then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried {
    /// The branch.
    pub axis: AxisId,
    /// Where it began.
    pub from: DVec3,
    /// Where it begins now.
    pub to: DVec3,
    /// How it is turned about that.
    pub turn: DQuat,
}

impl Carried {
    /// Where a point of the branch is now.
    pub fn place(&self, p: DVec3) -> DVec3 {
        self.to + self.turn * (p - self.from)
    }

    /// From its bearer onto a place of an axis, at a share of its length. `None` where either is no line, or nothing bears
    /// the branch.
    pub(crate) fn onto(plant: &Plant, axis: AxisId, host: AxisId, share: f64) -> Option<Self> {
        let from = *plant.axis_points(axis).first()?;
        let bearer = plant.axis(axis).bearer?;
        let old = *plant.nodes.axis.get(bearer.index())?;
        let mut old_node = bearer.index().checked_sub(plant.axis(old).nodes.start as usize)?;
        let mut line = plant.axis_points(host).to_vec();
        if line.len() < 2 {
            return None;
        }
        let node = match Seat::of(&line, share) {
            Seat::Node(node) => node,
            Seat::Before(node, t) => {
                line.insert(node, line[node - 1].lerp(line[node], t));
                old_node += usize::from(old == host && old_node >= node);
                node
            }
        };
        let along = if old == host { line.as_slice() } else { plant.axis_points(old) };
        let turn = base::turn::between(tangent(along, old_node), tangent(&line, node)).normalize();
        Some(Self { axis, from, to: line[node], turn })
    }
}

/// Where on a line something sits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Seat {
    /// At a node that is there.
    Node(usize),
    /// Between the node before this one and this one, at a share of the way.
    Before(usize, f64),
}

impl Seat {
    /// At a share of a line's length; a node within a hundredth of the length is used.
    pub(crate) fn of(points: &[DVec3], share: f64) -> Self {
        let lengths = lengths(points);
        let whole = lengths.last().copied().unwrap_or(0.0);
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
        let s = share * whole;
        let near = |i: &usize| (lengths[*i] - s).abs() <= 0.01 * whole;
        let nearest = (0..lengths.len())
            .min_by(|&i, &j| (lengths[i] - s).abs().total_cmp(&(lengths[j] - s).abs()))
            .filter(near);
        if let Some(node) = nearest {
            return Self::Node(node);
        }
        let i = lengths.partition_point(|&l| l < s).clamp(1, lengths.len().saturating_sub(1).max(1));
        let (Some(&a), Some(&b)) = (lengths.get(i - 1), lengths.get(i)) else { return Self::Node(0) };
        Self::Before(i, ((s - a) / (b - a).max(1e-300)).clamp(0.0, 1.0))
    }
}

/// Arc length at every point.
pub(crate) fn lengths(points: &[DVec3]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut at = Vec::with_capacity(points.len());
    for (i, p) in points.iter().enumerate() {
        if i > 0 {
            sum += p.distance(points[i - 1]);
        }
        at.push(sum);
    }
    at
}

/// From base to tip, or any direction of a line that ends where it starts.
pub(crate) fn direction(points: &[DVec3]) -> DVec3 {
    let (Some(a), Some(b)) = (points.first(), points.last()) else { return DVec3::Y };
    (*b - *a).try_normalize().unwrap_or(DVec3::Y)
}

/// Unit tangent at a node.
pub(crate) fn tangent(points: &[DVec3], node: usize) -> DVec3 {
    let last = points.len().saturating_sub(1);
    let (a, b) = (node.saturating_sub(1).min(last), (node + 1).min(last));
    (points[b] - points[a]).try_normalize().unwrap_or_else(|| direction(points))
}
