//! Edits that fill a given room by space colonisation: a silhouette, or the room of a branch that was cut off.

use base::{Draw, Seed};
use glam::{DVec2, DVec3};
use growth::{ColonizeSpec, JointId, colonize_from};

use crate::bench::{Bench, Stop, unread};
use crate::draft::{At, Draft};
use crate::edit::{Mirror, ViewPlane};
use crate::graft::{Hosts, graft_all};
use crate::habit::Habit;
use crate::key::AxisKey;
use crate::leaves::dress;
use crate::mask::Mask;
use crate::outcome::{Changed, Why};
use crate::pipes::Pipes;

// Children of an edit's seed, by their use.
const REGROW: u64 = 0x7265_6772;
const FILL: u64 = 0x6669_6c6c;

/// A requested silhouette.
pub(crate) struct Outline<'a> {
    pub(crate) plane: &'a ViewPlane,
    pub(crate) outline: &'a [DVec2],
    pub(crate) density: f64,
    pub(crate) trim: bool,
    pub(crate) mirror: Option<Mirror>,
}

/// Most markers of an edit.
const MOST_MARKERS: usize = 40_000;

pub(crate) fn regrow(
    draft: &mut Draft,
    axis: &AxisKey,
    seed: Seed,
    bench: &Bench<'_>,
) -> Result<Changed, Stop> {
    let (b, by_likeness) = axis.find_in(draft)?;
    let habit = bench.habit(draft);
    let old = draft.branches[b].clone();
    let at = old.bearer;
    let inside = draft.subtree(b);
    // The step suits the branch: a twig of three internodes must still be a twig.
    let step = habit.internode_m.min(0.12 * old.length().max(1e-9));
    let mut markers = Vec::new();
    let own = seed.child(REGROW).child(old.key);
    for (i, branch) in draft.branches.iter().enumerate() {
        if !inside[i] || !branch.alive || !branch.is_shoot() || markers.len() > MOST_MARKERS {
            continue;
        }
        let mut stream = own.child(branch.key).stream(Draw::Attractors);
        let line = geom::resample3(&branch.points, 0.5 * step);
        // The base of the branch itself is not scattered: the new branch grows where the old one did.
        for p in line.into_iter().skip(1) {
            let d = loop_in_ball(&mut stream);
            markers.push(p + d * (1.4 * step));
        }
    }
    let start = old.points.first().copied().unwrap_or(DVec3::ZERO);
    let heading = old.points.get(1).map_or(DVec3::Y, |p| (*p - start).normalize_or(DVec3::Y));
    let first = start + heading * step;
    markers.retain(|m| m.distance(start) > 1.5 * step);
    if markers.is_empty() {
        return Err(Why::TooSmall { what: "branch" }.into());
    }
    let radius = old.radii.first().copied().unwrap_or(0.0);
    let spec = ColonizeSpec {
        attraction_m: 8.0 * step,
        kill_m: step,
        step_m: Some(0.55 * step),
        inertia: 0.4,
        max_joints: 400_000,
        ..ColonizeSpec::default()
    };
    let removed = draft.remove(&inside);
    let mut pipes = Pipes::default();
    pipes.book(at, radius, -1.0, habit.exponent);
    let mut hosts = Hosts::default();
    let root = hosts.skeleton.push_root(start, 0);
    let Some(at) = at else {
        let added = regrow_stem(draft, &old, first, (&markers, &spec), &habit, bench)?;
        return Ok(Changed { removed, added, by_likeness, ..Changed::default() });
    };
    hosts.node.push(at);
    let mut start_from = hosts.skeleton.clone();
    start_from.push(first, root, 0);
    let grown = colonize_from(start_from, &markers, bench.obstacles, &spec, bench.run, &mut unread())?;
    let made = graft_all(draft, &hosts, &grown.skeleton, &habit, pipes, own, bench)?;
    if let Some(&new) = made.first() {
        // Key and number stay with the place: other edits may refer to this branch.
        draft.branches[new].key = old.key;
        draft.exchange(new, b);
    }
    dress(draft, &habit, bench)?;
    Ok(Changed { removed, added: made.len(), by_likeness, ..Changed::default() })
}

/// Grows a whole stem: a new axis of one internode on the ground, on which the rest is grafted.
fn regrow_stem(
    draft: &mut Draft,
    old: &crate::draft::Branch,
    first: DVec3,
    (markers, spec): (&[DVec3], &ColonizeSpec),
    habit: &Habit,
    bench: &Bench<'_>,
) -> Result<usize, Stop> {
    let start = old.points.first().copied().unwrap_or(DVec3::ZERO);
    let b = draft.branches.len();
    draft.branches.push(crate::draft::Branch {
        points: vec![start, first],
        radii: vec![habit.tip_m; 2],
        alive: true,
        fresh: true,
        ..old.clone()
    });
    let hosts = Hosts::collect(draft, |i| i == b);
    let start = hosts.skeleton.clone();
    let grown = colonize_from(start, markers, bench.obstacles, spec, bench.run, &mut unread())?;
    let made = graft_all(draft, &hosts, &grown.skeleton, habit, Pipes::default(), Seed::new(old.key), bench)?;
    dress(draft, habit, bench)?;
    Ok(made.len() + 1)
}

/// Returns a point drawn uniformly from the unit ball.
pub(crate) fn loop_in_ball(stream: &mut base::Stream) -> DVec3 {
    for _ in 0..64 {
        let d = DVec3::new(stream.range(-1.0, 1.0), stream.range(-1.0, 1.0), stream.range(-1.0, 1.0));
        if d.length_squared() <= 1.0 {
            return d;
        }
    }
    DVec3::ZERO
}

pub(crate) fn silhouette(
    draft: &mut Draft,
    wanted: &Outline<'_>,
    seed: Seed,
    bench: &Bench<'_>,
) -> Result<Changed, Stop> {
    if !(0.1..=10.0).contains(&wanted.density) {
        return Err(Why::BadNumber { field: "density" }.into());
    }
    let mask = Mask::new(wanted.plane, wanted.outline, wanted.mirror)?;
    let habit = bench.habit(draft);
    let (removed, pipes) = if wanted.trim { trim(draft, &mask, &habit) } else { (0, Pipes::default()) };
    let hosts = Hosts::collect(draft, |_| true);
    if hosts.node.is_empty() {
        return Err(Why::NoBranches.into());
    }
    // The depth of the crown is that of the wood seen inside the outline, or else that of a lone trunk below it.
    let depths: Vec<f64> =
        hosts.skeleton.position.iter().filter(|p| mask.covers(**p)).map(|p| mask.depth_of(*p)).collect();
    let depth = if depths.is_empty() {
        hosts.skeleton.position.last().map_or(0.0, |p| mask.depth_of(*p))
    } else {
        depths.iter().sum::<f64>() / depths.len() as f64
    };
    let own = seed.child(FILL);
    // The number of markers suits the plant's internodes: the new part must not be thinner than the old.
    let natural = mask.volume() / base::ops::powf(1.2 * habit.internode_m, 3.0);
    let per_pixel = (natural / mask.pixels() as f64).clamp(1.0, 12.0) * wanted.density;
    let most = MOST_MARKERS as f64 / mask.pixels() as f64;
    let mut markers = mask.markers(per_pixel.min(most), depth, own);
    let volume = mask.volume();
    let spacing = base::ops::cbrt(volume / markers.len().max(1) as f64).max(1e-9);
    let grid = geom::KdTree::new(&hosts.skeleton.position);
    let gap = |markers: &[DVec3]| {
        let away = |m: &DVec3| {
            Some(grid.nearest(*m, f64::INFINITY).map(|i| hosts.skeleton.position[i])?.distance(*m))
        };
        let least = markers.iter().filter_map(away).fold(f64::INFINITY, f64::min);
        // The markers must lie within reach of wood.
        (least <= 0.5 * habit.size_m.max(mask.pixel * 48.0)).then_some(least)
    };
    let images = mask.images(&markers, depth);
    let (gap, alone) = match (gap(&markers), gap(&images)) {
        (Some(gap), Some(other)) => (gap.max(other), false),
        (gap, other) => (gap.or(other).ok_or(Why::NothingGrew)?, !images.is_empty()),
    };
    markers.extend(images);
    let spec = ColonizeSpec {
        attraction_m: (8.0 * spacing).max(1.05 * gap + spacing),
        kill_m: 1.25 * spacing,
        step_m: Some(0.6 * spacing),
        inertia: 0.3,
        max_joints: 400_000,
        ..ColonizeSpec::default()
    };
    let start = hosts.skeleton.clone();
    let grown = colonize_from(start, &markers, bench.obstacles, &spec, bench.run, &mut unread())?;
    let old = hosts.node.len();
    // A twig may cross the line by less than a step; one that goes farther was growing around it.
    let skeleton = grown.skeleton.keep(|j| j < old || mask.near(grown.skeleton.position[j], spacing));
    let made = graft_all(draft, &hosts, &skeleton, &habit, pipes, own, bench)?;
    dress(draft, &habit, bench)?;
    let dropped = if wanted.trim { trim_leaves(draft, &mask, &habit) } else { 0 };
    if made.is_empty() && removed + dropped == 0 {
        return Err(Why::NothingGrew.into());
    }
    let alone = if alone { made.len() } else { 0 };
    Ok(Changed { removed, added: made.len(), alone, ..Changed::default() })
}

// Largest distance of a bend outside the outline that still counts as crown, in pixels of the mask: a twentieth of it.
const BEND: f64 = 2.4;

/// Cuts branches where they leave the outline, except for small bends; branches that never enter it are removed, too,
/// down to the last place that bears one that does. Returns how many were removed, and their pipes.
fn trim(draft: &mut Draft, mask: &Mask, habit: &Habit) -> (usize, Pipes) {
    let mut removed = 0;
    let mut pipes = Pipes::default();
    let order = draft.order();
    let reaches = reaching(draft, &order, mask);
    // Highest order last: everything on a branch that is cut is removed with it.
    for b in order {
        let branch = &draft.branches[b];
        if !branch.alive || !branch.is_shoot() || branch.points.len() < 2 {
            continue;
        }
        // A stem stands below the crown: it is cut only above a place where it was inside.
        let stem = branch.bearer.is_none();
        let fine = geom::resample3(&branch.points, (0.5 * mask.pixel).max(branch.length() / 2000.0));
        let Some(last) = last_inside(&fine, mask, stem) else {
            if stem {
                continue;
            }
            let at = highest_needed(draft, b, &reaches);
            removed += cut(draft, b, at, &mut pipes, habit);
            continue;
        };
        if last + 1 < fine.len() {
            let share = if last == 0 { 0.0 } else { (last as f64 + 0.5) / (fine.len() - 1) as f64 };
            removed += cut(draft, b, share, &mut pipes, habit);
        }
    }
    (removed, pipes)
}

/// Returns the last sample of a line before it leaves the outline for good, or for more than a bend; `None` where it
/// never enters. A line that starts next to the outline counts as inside from the start.
fn last_inside(line: &[DVec3], mask: &Mask, stem: bool) -> Option<usize> {
    let slack = BEND * mask.pixel;
    let mut last = line.first().filter(|p| !stem && mask.near(**p, slack)).map(|_| 0);
    for (k, p) in line.iter().enumerate() {
        if mask.covers(*p) {
            last = Some(k);
        } else if last.is_some() && !mask.near(*p, slack) {
            break;
        }
    }
    last
}

/// Marks the branches that enter the outline, or bear one that does.
fn reaching(draft: &Draft, order: &[usize], mask: &Mask) -> Vec<bool> {
    let mut reaches: Vec<bool> =
        draft.branches.iter().map(|b| b.alive && b.points.iter().any(|p| mask.covers(*p))).collect();
    // Bearers come first in the order.
    for &b in order.iter().rev() {
        if let Some(at) = draft.branches[b].bearer {
            reaches[at.branch] |= reaches[b];
        }
    }
    reaches
}

/// Returns the share of a branch's length up to the last node that bears something that enters the outline; 0 for none.
fn highest_needed(draft: &Draft, b: usize, reaches: &[bool]) -> f64 {
    let borne = draft.branches.iter().zip(reaches).filter(|(c, reaches)| c.alive && **reaches);
    let nodes = borne.filter_map(|(c, _)| Some(c.bearer.filter(|p| p.branch == b)?.node));
    let Some(node) = nodes.max() else { return 0.0 };
    let points = &draft.branches[b].points;
    let below = geom::polyline_length3(&points[..(node + 1).min(points.len())]);
    // Cuts a little above the node, which must stay.
    let whole = draft.branches[b].length();
    if whole > 0.0 { (below / whole + 1e-3).min(1.0) } else { 0.0 }
}

/// Cuts a branch at a share of its length. It leaves no stump: the crown should look as if it had grown like this, so
/// the cut end becomes a tip.
fn cut(draft: &mut Draft, b: usize, share: f64, pipes: &mut Pipes, habit: &Habit) -> usize {
    let (bearer, base) = (draft.branches[b].bearer, draft.branches[b].radii[0]);
    let nodes = draft.branches[b].points.len();
    let removed = draft.cut(b, share);
    let branch = &draft.branches[b];
    match branch.radii.last() {
        Some(&radius) if branch.alive => {
            if branch.points.len() < nodes {
                let at = At { branch: b, node: branch.radii.len() - 1 };
                pipes.book(Some(at), radius, -1.0, habit.exponent);
                pipes.book(Some(at), habit.tip_m.min(radius), 1.0, habit.exponent);
            }
        }
        _ => pipes.book(bearer, base, -1.0, habit.exponent),
    }
    removed
}

/// Removes leaves whose root is outside.
fn trim_leaves(draft: &mut Draft, mask: &Mask, habit: &Habit) -> usize {
    let reach = habit.leaves.as_ref().map_or(0.0, |l| 0.5 * l.spec.length_m);
    let mut dropped = 0;
    for o in draft.organs.iter_mut().filter(|o| o.alive && o.what.kind == plant::OrganKind::Leaf) {
        if !mask.near(o.what.frame.origin, reach) {
            o.alive = false;
            dropped += 1;
        }
    }
    dropped
}

/// Returns the joint of a node.
pub(crate) fn joint_of(hosts: &Hosts, at: At) -> Option<JointId> {
    hosts.node.iter().position(|n| *n == at).map(JointId::new)
}
