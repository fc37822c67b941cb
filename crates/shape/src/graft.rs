//! Grafting: adds grown wood to a plant as branches.
//!
//! `Skeleton that starts at nodes of the draft -> wood -> branches, pipes`

use base::Seed;
use glam::DVec3;
use growth::{JointId, Skeleton, WoodSpec, make_wood};

use crate::bench::{Bench, MOST_AXES, Stop};
use crate::draft::{At, Branch, Draft};
use crate::habit::{Habit, kind_on};
use crate::outcome::Why;
use crate::pipes::{Pipes, fit};

/// The wood of a plant as a skeleton, and the node of each joint.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hosts {
    pub(crate) skeleton: Skeleton,
    pub(crate) node: Vec<At>,
}

impl Hosts {
    /// Collects all living shoots that satisfy `wanted`, with their bearers.
    pub(crate) fn collect(draft: &Draft, wanted: impl Fn(usize) -> bool) -> Self {
        let mut hosts = Self::default();
        let mut joints: Vec<Vec<Option<JointId>>> =
            draft.branches.iter().map(|b| vec![None; b.points.len()]).collect();
        let mut tree = 0;
        for b in draft.order() {
            let branch = &draft.branches[b];
            if !branch.is_shoot() || !wanted(b) {
                continue;
            }
            let joint_at = |at: At| joints.get(at.branch)?.get(at.node).copied().flatten();
            let mut last = branch.bearer.and_then(joint_at);
            for (node, &place) in branch.points.iter().enumerate() {
                // A borne axis starts on an existing joint.
                if node == 0 && last.is_some() {
                    continue;
                }
                let id = match last {
                    Some(parent) => hosts.skeleton.push(place, parent, 0),
                    None => {
                        tree += 1;
                        hosts.skeleton.push_root(place, tree - 1)
                    }
                };
                hosts.node.push(At { branch: b, node });
                joints[b][node] = Some(id);
                last = Some(id);
            }
        }
        hosts
    }
}

/// Places a bud that is to grow out of a node beyond its bark; the first piece leads out through the bark. A bud along
/// the bearer would lie far away.
pub(crate) fn out_of_bark(draft: &Draft, at: At, heading: DVec3) -> (Hosts, Skeleton, JointId) {
    let branch = &draft.branches[at.branch];
    let (start, along, thick) = (branch.points[at.node], branch.tangent(at.node), branch.radii[at.node]);
    let mut hosts = Hosts { skeleton: Skeleton::default(), node: vec![at] };
    let root = hosts.skeleton.push_root(start, 0);
    let mut from = hosts.skeleton.clone();
    let steep = (heading - along * heading.dot(along)).length().max(0.35);
    let joint = from.push(start + heading * (thick / steep), root, 0);
    (hosts, from, joint)
}

/// Grafts everything of `grown` beyond the joints of `hosts` onto the draft.
///
/// `pipes`: wood added and removed before, as by a cut. Returns the new branches; radii below all of it are settled.
pub(crate) fn graft_all(
    draft: &mut Draft,
    hosts: &Hosts,
    grown: &Skeleton,
    habit: &Habit,
    mut pipes: Pipes,
    seed: Seed,
    bench: &Bench<'_>,
) -> Result<Vec<usize>, Stop> {
    let old = hosts.node.len();
    // Each host joint with new children gets a small skeleton of its own.
    let mut root_of: Vec<usize> = (0..grown.len()).collect();
    let mut rows: Vec<Vec<usize>> = vec![Vec::new(); old];
    for j in old..grown.len() {
        let Some(p) = grown.parent[j] else { continue };
        let root = if p.index() < old { p.index() } else { root_of[p.index()] };
        root_of[j] = root;
        if let Some(rows) = rows.get_mut(root) {
            rows.push(j);
        }
    }
    let mut made = Vec::new();
    let mut new_id: Vec<Option<JointId>> = vec![None; grown.len()];
    for (root, rows) in rows.iter().enumerate().filter(|(_, r)| !r.is_empty()) {
        let mut little = Skeleton::default();
        let first = little.push_root(grown.position[root], 0);
        for &j in rows {
            let Some(p) = grown.parent[j] else { continue };
            let parent = if p.index() == root { Some(first) } else { new_id[p.index()] };
            if let Some(parent) = parent {
                new_id[j] = Some(little.push(grown.position[j], parent, grown.birth[j]));
            }
        }
        let place = seed.child(root as u64);
        let added = graft(draft, hosts.node[root], &little, habit, place, bench)?;
        for &b in &added {
            if draft.branches[b].bearer == Some(hosts.node[root]) {
                fit(draft, b, habit.tip_m);
                pipes.book(draft.branches[b].bearer, draft.branches[b].radii[0], 1.0, habit.exponent);
            }
        }
        made.extend(added);
        if draft.branches.len() > MOST_AXES {
            return Err(Why::TooMany { most: MOST_AXES }.into());
        }
    }
    pipes.bounded = true;
    pipes.settle(draft, habit.exponent, habit.tip_m);
    Ok(made)
}

/// Grafts one skeleton, whose root lies on a node. Radii below are not settled.
fn graft(
    draft: &mut Draft,
    at: At,
    skeleton: &Skeleton,
    habit: &Habit,
    seed: Seed,
    bench: &Bench<'_>,
) -> Result<Vec<usize>, Stop> {
    let spec = WoodSpec {
        pipe_exponent: habit.exponent,
        tip_radius_m: habit.tip_m.clamp(1e-6, 10.0),
        ..WoodSpec::default()
    };
    let wood = make_wood(skeleton, &spec, bench.obstacles, bench.run)?;
    let kind = kind_on(draft.branches[at.branch].kind);
    let host = draft.branches[at.branch].points[at.node];
    let mut made: Vec<usize> = Vec::with_capacity(wood.plant.axes.len());
    for (i, axis) in wood.plant.axes.iter().enumerate() {
        let id = plant::AxisId::new(i);
        let mut points: Vec<DVec3> = wood.plant.axis_points(id).to_vec();
        let mut radii = wood.plant.axis_radii(id).to_vec();
        let bearer = axis.bearer.and_then(|node| {
            let owner = wood.plant.nodes.axis[node.index()].index();
            let node = node.index() - wood.plant.axes[owner].nodes.start as usize;
            // An axis that starts at the root starts on the host.
            let on_host = wood.plant.axes[owner].bearer.is_none() && node == 0;
            (!on_host).then(|| At { branch: made[owner], node })
        });
        if axis.bearer.is_none()
            && let (Some(p), [r0, r1, ..]) = (points.first_mut(), radii.as_mut_slice())
        {
            // The root's own radius is that of all axes that start there.
            (*p, *r0) = (host, *r1);
        }
        made.push(draft.branches.len());
        draft.branches.push(Branch {
            kind,
            key: seed.child(axis.key).number(),
            source: None,
            colors: Vec::new(),
            bearer: Some(bearer.unwrap_or(at)),
            points,
            radii,
            alive: true,
            fresh: true,
        });
    }
    Ok(made)
}
