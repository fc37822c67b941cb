//! A branch in the hand: how it moves, with all that it bears, as one rigid body.
//!
//! `Plant, branch, destination -> a rotation and a translation`

use glam::{DQuat, DVec3};
use plant::{AxisId, Plant};

/// Rigid motion of a branch and all that it bears: `p -> to + turn * (p - from)`, metres.
///
/// Everything on the branch moves with it unchanged, and nothing else moves: so a shell may move the triangles of the
/// branch that it shows, and needs no mesh of the plant before the hand lets go. Radii of its bearer may change then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried {
    /// The branch.
    pub axis: AxisId,
    /// Base of the branch before.
    pub from: DVec3,
    /// Base of the branch now.
    pub to: DVec3,
    /// Rotation about its base.
    pub turn: DQuat,
}

impl Carried {
    /// Returns the present position of a point of the branch.
    pub fn place(&self, p: DVec3) -> DVec3 {
        self.to + self.turn * (p - self.from)
    }

    /// Moves it from its bearer to a place on an axis, at a share of its length. `None` where either is not a line, or
    /// nothing bears the branch.
    pub(crate) fn onto(plant: &Plant, axis: AxisId, host: AxisId, share: f64) -> Option<Self> {
        let from = *plant.axis_points(axis).first()?;
        let bearer = plant.axis(axis).bearer?;
        let old = *plant.nodes.axis.get(bearer.index())?;
        let mut old_node = bearer.index().checked_sub(plant.axis(old).nodes.start as usize)?;
        let mut line = plant.axis_points(host).to_vec();
        if line.len() < 2 {
            return None;
        }
        let node = match Seat::find(&line, share) {
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

/// Place of something on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Seat {
    /// At an existing node.
    Node(usize),
    /// Between the node before this one and this one, at a share of the distance.
    Before(usize, f64),
}

impl Seat {
    /// Finds the seat at a share of a line's length; a node within a hundredth of the length is used.
    pub(crate) fn find(points: &[DVec3], share: f64) -> Self {
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

/// Returns the arc length at every point.
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

/// Returns the direction from base to tip, or any direction of a line that ends where it starts.
pub(crate) fn direction(points: &[DVec3]) -> DVec3 {
    let (Some(a), Some(b)) = (points.first(), points.last()) else { return DVec3::Y };
    (*b - *a).try_normalize().unwrap_or(DVec3::Y)
}

/// Returns the unit tangent at a node.
pub(crate) fn tangent(points: &[DVec3], node: usize) -> DVec3 {
    let last = points.len().saturating_sub(1);
    let (a, b) = (node.saturating_sub(1).min(last), (node + 1).min(last));
    (points[b] - points[a]).try_normalize().unwrap_or_else(|| direction(points))
}
