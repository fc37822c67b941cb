//! The new seat of a branch: `Draft, branch, destination -> wood or ground`

use glam::{DQuat, DVec3};

use crate::draft::{At, Draft};
use crate::edit::Destination;
use crate::outcome::Why;

/// Destination of a branch in a plant.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Goal {
    /// Onto a branch, at a share of its length.
    Wood(usize, f64),
    /// By a vector, metres, for a branch on the ground.
    Ground(DVec3),
}

/// Resolves a destination in the plant as it is.
pub(crate) fn goal(draft: &Draft, b: usize, to: &Destination) -> Result<Goal, Why> {
    let bearer = draft.branches[b].bearer;
    match to {
        Destination::SlideM(by) => {
            let at = bearer.ok_or(Why::NoBearer)?;
            let whole = draft.branches[at.branch].length();
            let by = if by.is_finite() { *by } else { return Err(Why::BadNumber { field: "slide-m" }) };
            let share = draft.share_of_bearer(b) + if whole > 0.0 { by / whole } else { 0.0 };
            Ok(Goal::Wood(at.branch, share))
        }
        Destination::Place { axis, at } => {
            let share = if at.is_finite() { *at } else { return Err(Why::BadNumber { field: "at" }) };
            Ok(Goal::Wood(axis.find_in(draft)?.0, share))
        }
        Destination::ByM(by) => {
            if !by.is_finite() || by.length() > 1e6 {
                return Err(Why::BadNumber { field: "by-m" });
            }
            let base = draft.branches[b].points.first().copied().unwrap_or(DVec3::ZERO);
            Ok(bearer.map_or(Goal::Ground(*by), |at| {
                let share = geom::nearest_on_polyline3(&draft.branches[at.branch].points, base + *by).1;
                Goal::Wood(at.branch, share)
            }))
        }
    }
}

/// A seat on wood for a branch, and the rotation that keeps its angle to its bearer.
pub(crate) struct Seat {
    pub(crate) at: At,
    pub(crate) target: DVec3,
    pub(crate) turn: DQuat,
}

/// Finds the seat on wood and makes a node for it where there is none.
pub(crate) fn onto(draft: &mut Draft, b: usize, host: usize, share: f64) -> Seat {
    let node = draft.node_at(host, share.clamp(0.0, 1.0));
    // Read after the new node, which may have shifted the old one.
    let old = draft.branches[b].bearer;
    let before = old.map_or(DVec3::Y, |at| draft.branches[at.branch].tangent(at.node));
    let (target, after) = (draft.branches[host].points[node], draft.branches[host].tangent(node));
    let turn = base::turn::between(before, after).normalize();
    Seat { at: At { branch: host, node }, target, turn }
}
