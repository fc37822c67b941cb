//! Duplicates of wood: a copy of a branch elsewhere, and mirror images.
//!
//! `Draft, branch -> a second branch, with all that it bears`

use base::{Counted, Run, Seed};
use glam::{DQuat, DVec3};
use plant::{FlowerId, Frame};

use crate::bench::{Bench, MOST_AXES, Stop};
use crate::draft::{At, Draft};
use crate::edit::{Destination, Mirror};
use crate::key::AxisKey;
use crate::outcome::{Changed, Why};
use crate::pipes::{Pipes, fit};
use crate::seat::{Goal, goal, onto};
use crate::sketch_branch::own_seed;

const COPY: u64 = 0x636f_7079;
const MIRROR: u64 = 0x6d69_7272;

/// Advice for a plant that its copies make too large.
const FEWER_COPIES: &str = "copy fewer branches, or smaller ones";
/// Largest distance of a mirrored branch's intended base from wood that can bear it, as a share of the plant's size;
/// the same as for [`AxisKey::Near`].
const NEAR: f64 = 0.1;

/// Copies a branch with all that it bears. Cost: linear in the plant.
pub(crate) fn copy(
    draft: &mut Draft,
    axis: &AxisKey,
    to: &Destination,
    bench: &Bench<'_>,
) -> Result<Changed, Stop> {
    let (b, by_likeness) = axis.find_in(draft)?;
    let goal = goal(draft, b, to)?;
    let habit = bench.habit(draft);
    let base = draft.branches[b].points.first().copied().unwrap_or(DVec3::ZERO);
    // The place may be on the branch itself, or on a branch that it bears: it exists before the branch is copied.
    let (at, target, turn) = match goal {
        Goal::Wood(host, share) => {
            let seat = onto(draft, b, host, share);
            (Some(seat.at), seat.target, seat.turn)
        }
        Goal::Ground(by) => (None, base + by, DQuat::IDENTITY),
    };
    let own = own_seed(draft, Seed::new(draft.branches[b].key).child(COPY), target);
    let what = draft.subtree(b);
    let rows = draft.twin(&what, own, bench.run)?;
    let Some(top) = rows[b] else { return Err(Why::BranchGone.into()) };
    let made: Vec<bool> = (0..draft.branches.len()).map(|i| i >= what.len()).collect();
    draft.carry(&made, base, target, turn);
    draft.branches[top].bearer = at;
    fit(draft, top, habit.tip_m);
    let mut pipes = Pipes::default();
    pipes.bounded = true;
    pipes.book(at, draft.branches[top].radii.first().copied().unwrap_or(0.0), 1.0, habit.exponent);
    pipes.settle(draft, habit.exponent, habit.tip_m);
    let added = draft.branches[what.len()..].iter().filter(|b| b.is_shoot()).count();
    Ok(Changed { added, by_likeness, ..Changed::default() })
}

/// Mirrors the wood that an edit made (all branches from `old` on) in a plane.
///
/// Guaranteed: each mirrored branch is the image of its twin, moved rigidly to the wood nearest to its intended base;
/// it ends where an obstacle begins. Wood on the plane itself has no image. Not guaranteed: that there is wood to bear
/// it; `alone` counts the branches without.
pub(crate) fn complete(
    draft: &mut Draft,
    mirror: Mirror,
    old: usize,
    changed: &mut Changed,
    bench: &Bench<'_>,
) -> Result<(), Stop> {
    let (through, normal) = mirror.axes()?;
    let habit = bench.habit(draft);
    let image = |p: DVec3| Mirror::image(through, normal, p);
    let off = |p: &DVec3| (*p - through).dot(normal).abs();
    let end = draft.branches.len();
    let is_new = |b: usize| (old..end).contains(&b);
    let tops: Vec<usize> = (old..end)
        .filter(|&b| draft.branches[b].alive && draft.branches[b].is_shoot())
        .filter(|&b| draft.branches[b].bearer.is_none_or(|at| !is_new(at.branch)))
        .collect();
    let mut pipes = Pipes::default();
    pipes.bounded = true;
    for top in tops {
        let branch = &draft.branches[top];
        let Some(base) = branch.points.first().copied() else { continue };
        let what = draft.subtree(top);
        let on_plane = match branch.bearer {
            None => off(&base) < habit.internode_m,
            Some(_) => {
                let wood = draft.branches.iter().zip(&what).filter(|(_, inside)| **inside);
                wood.flat_map(|(b, _)| &b.points).all(|p| off(p) < habit.tip_m)
            }
        };
        if on_plane {
            continue;
        }
        let wanted = image(base);
        let seat = match branch.bearer {
            None => None,
            Some(_) => match nearest_wood(draft, old, wanted, NEAR * habit.size_m) {
                Some((host, share)) => {
                    let node = draft.node_at(host, share);
                    Some((At { branch: host, node }, draft.branches[host].points[node]))
                }
                None => {
                    changed.alone += what.iter().filter(|inside| **inside).count();
                    continue;
                }
            },
        };
        let target = seat.map_or(wanted, |(_, place)| place);
        let own = own_seed(draft, Seed::new(draft.branches[top].key).child(MIRROR), target);
        let (first, organs) = (draft.branches.len(), draft.organs.len());
        let rows = draft.twin(&what, own, bench.run)?;
        let Some(twin) = rows[top] else { continue };
        let by = target - wanted;
        for branch in &mut draft.branches[first..] {
            branch.points.iter_mut().for_each(|p| *p = image(*p) + by);
        }
        let along = |v: DVec3| v - normal * (2.0 * v.dot(normal));
        for o in &mut draft.organs[organs..] {
            let f = o.what.frame;
            o.what.frame = Frame::looking(image(f.origin) + by, along(f.along), along(f.normal));
        }
        let at = seat.map(|(at, _)| at);
        draft.branches[twin].bearer = at;
        end_at_obstacles(draft, first, bench);
        let alive = draft.branches[first..].iter().filter(|b| b.alive).count();
        changed.alone += rows.iter().flatten().count() - alive;
        if !draft.branches[twin].alive {
            continue;
        }
        changed.added += draft.branches[first..].iter().filter(|b| b.alive && b.is_shoot()).count();
        fit(draft, twin, habit.tip_m);
        pipes.book(at, draft.branches[twin].radii[0], 1.0, habit.exponent);
    }
    pipes.settle(draft, habit.exponent, habit.tip_m);
    Ok(())
}

/// Finds the shoot among those before `old` that comes nearest to a point, and the place on it.
fn nearest_wood(draft: &Draft, old: usize, p: DVec3, within_m: f64) -> Option<(usize, f64)> {
    let shoots = draft.branches[..old].iter().enumerate().filter(|(_, b)| b.alive && b.is_shoot());
    let near = shoots.map(|(i, b)| (geom::nearest_on_polyline3(&b.points, p), i));
    let ((gap, share), host) = near.reduce(|a, b| if b.0.0 < a.0.0 { b } else { a })?;
    (gap <= within_m).then_some((host, share))
}

/// Ends new branches, with all that they bear beyond, where an obstacle begins.
fn end_at_obstacles(draft: &mut Draft, first: usize, bench: &Bench<'_>) {
    if bench.obstacles.is_empty() {
        return;
    }
    for b in first..draft.branches.len() {
        let branch = &draft.branches[b];
        // The first node belongs to the bearer.
        let from = usize::from(branch.bearer.is_some());
        let open = from + branch.points[from..].iter().take_while(|p| bench.obstacles.free(**p)).count();
        if !branch.alive || open == branch.points.len() {
            continue;
        }
        if open < 2 {
            let gone = draft.subtree(b);
            draft.remove(&gone);
            continue;
        }
        let beyond = |at: Option<At>| at.is_some_and(|at| at.branch == b && at.node >= open);
        let tops: Vec<usize> = (first..draft.branches.len())
            .filter(|&i| draft.branches[i].alive && beyond(draft.branches[i].bearer))
            .collect();
        for top in tops {
            let gone = draft.subtree(top);
            draft.remove(&gone);
        }
        draft.drop_fallen(|at| at.branch == b && at.node >= open);
        draft.branches[b].points.truncate(open);
        draft.branches[b].radii.truncate(open);
    }
}

impl Draft {
    /// Duplicates branches in place, with all organs and flowers on them: new rows at the end, `fresh`, each with a key
    /// of its own. Returns the row of each twin; the bearer of a branch that is not copied bears its twin, too.
    fn twin(&mut self, what: &[bool], own: Seed, run: &Run<'_>) -> Result<Vec<Option<usize>>, Stop> {
        let mut rows = vec![None; self.branches.len()];
        let mut next = self.branches.len();
        for ((row, branch), inside) in rows.iter_mut().zip(&self.branches).zip(what) {
            if *inside && branch.alive {
                *row = Some(next);
                next += 1;
            }
        }
        if next > MOST_AXES {
            return Err(Why::TooMany { most: MOST_AXES }.into());
        }
        let hangs = |at: Option<At>| at.is_some_and(|at| rows.get(at.branch).is_some_and(Option::is_some));
        let organs = self.organs.iter().filter(|o| o.alive && hangs(o.at)).count();
        let flowers = self.flowers.iter().filter(|f| f.alive && hangs(f.at)).count();
        let copied = self.branches.iter().zip(&rows).filter(|(_, row)| row.is_some());
        let nodes: usize = copied.map(|(b, _)| b.points.len()).sum();
        let pieces = self.pieces() + (nodes + organs + flowers) as u64;
        run.budget.check(Counted::Pieces, pieces, FEWER_COPIES)?;
        let follow = |at: Option<At>| {
            at.map(|at| At { branch: rows.get(at.branch).copied().flatten().unwrap_or(at.branch), ..at })
        };
        for (b, _) in rows.iter().enumerate().filter(|(_, row)| row.is_some()) {
            let mut branch = self.branches[b].clone();
            branch.key = own.child(branch.key).number();
            branch.source = None;
            branch.bearer = follow(branch.bearer);
            branch.fresh = true;
            self.branches.push(branch);
        }
        let mut flowers = vec![None; self.flowers.len()];
        for (f, row) in flowers.iter_mut().enumerate() {
            if self.flowers[f].alive && hangs(self.flowers[f].at) {
                let mut flower = self.flowers[f].clone();
                flower.at = follow(flower.at);
                *row = Some(FlowerId::new(self.flowers.len()));
                self.flowers.push(flower);
            }
        }
        for o in 0..self.organs.len() {
            if !self.organs[o].alive || !hangs(self.organs[o].at) {
                continue;
            }
            let mut organ = self.organs[o].clone();
            organ.what.key = own.child(organ.what.key).number();
            organ.what.source = None;
            organ.at = follow(organ.at);
            organ.what.flower = organ.what.flower.and_then(|f| flowers.get(f.index()).copied().flatten());
            self.organs.push(organ);
        }
        Ok(rows)
    }
}
