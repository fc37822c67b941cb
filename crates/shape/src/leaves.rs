//! Leaves: fewer or more of them in a region, and leaves for new wood.

use base::ops::PI;
use base::{Draw, Seed};
use glam::{DQuat, DVec3};
use growth::add_leaves;
use plant::{AxisId, AxisKind, OrganKind, Plant, Shape};

use crate::bench::{Bench, Stop, unread};
use crate::draft::{At, Borne, Draft};
use crate::edit::LeafRegion;
use crate::habit::Habit;
use crate::outcome::{Changed, Why};

/// Most leaves of a plant after an edit.
const MOST_LEAVES: usize = 2_000_000;

/// Returns a number in [0, 1) that belongs to a key.
fn unit(seed: Seed) -> f64 {
    (seed.number() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

/// Returns the rows of the leaves in a region, and whether its branch was found by likeness.
fn chosen(draft: &Draft, region: &LeafRegion) -> Result<(Vec<usize>, bool), Why> {
    let leaves = draft.organs.iter().enumerate();
    let leaves = leaves.filter(|(_, o)| o.alive && o.what.kind == OrganKind::Leaf);
    let (rows, by_likeness): (Vec<usize>, bool) = match region {
        LeafRegion::All => (leaves.map(|(i, _)| i).collect(), false),
        LeafRegion::Branch(axis) => {
            let (b, by_likeness) = axis.find_in(draft)?;
            let inside = draft.subtree(b);
            let on = |at: Option<At>| at.is_some_and(|at| inside.get(at.branch) == Some(&true));
            (leaves.filter(|(_, o)| on(o.at)).map(|(i, _)| i).collect(), by_likeness)
        }
        LeafRegion::Stroke { points, radius_m } => {
            if points.is_empty() || !points.iter().all(|p| p.is_finite()) {
                return Err(Why::BadNumber { field: "points" });
            }
            if !radius_m.is_finite() || *radius_m <= 0.0 {
                return Err(Why::BadNumber { field: "radius_m" });
            }
            let line = if points.len() == 1 { vec![points[0]; 2] } else { points.clone() };
            let middle = |o: &plant::Organ| {
                let length = match draft.shapes.get(o.shape.index()) {
                    Some(Shape::Blade(b)) => b.length(),
                    _ => 0.0,
                };
                o.frame.place(DVec3::Y * (0.5 * length), o.scale)
            };
            let near = |o: &plant::Organ| geom::nearest_on_polyline3(&line, middle(o)).0 <= *radius_m;
            (leaves.filter(|(_, o)| near(&o.what)).map(|(i, _)| i).collect(), false)
        }
    };
    if rows.is_empty() { Err(Why::NoLeaves) } else { Ok((rows, by_likeness)) }
}

/// Thins leaves or adds some. On the same plant, a smaller `keep` keeps a subset of what a larger one keeps.
pub(crate) fn density(
    draft: &mut Draft,
    region: &LeafRegion,
    keep: f64,
    seed: Seed,
    bench: &Bench<'_>,
) -> Result<Changed, Stop> {
    if !(0.0..=4.0).contains(&keep) {
        return Err(Why::BadNumber { field: "keep" }.into());
    }
    let (rows, by_likeness) = chosen(draft, region)?;
    let mut changed = Changed { by_likeness, ..Changed::default() };
    if keep <= 1.0 {
        for row in rows {
            let key = Seed::new(draft.organs[row].what.key).child(seed.number());
            if unit(key) < keep {
                continue;
            }
            draft.organs[row].alive = false;
            let stalk = draft.organs[row].at.filter(|at| draft.branches[at.branch].kind == AxisKind::Petiole);
            if let Some(at) = stalk {
                let bears = |a: Option<At>| a.is_some_and(|a| a.branch == at.branch);
                let busy = draft.organs.iter().any(|o| o.alive && bears(o.at))
                    || draft.branches.iter().any(|b| b.alive && bears(b.bearer));
                draft.branches[at.branch].alive = busy;
            }
        }
        return Ok(changed);
    }
    let spacing = bench.habit(draft).leaves.map_or(0.0, |l| l.spec.spacing_m);
    for row in rows {
        let key = Seed::new(draft.organs[row].what.key).child(seed.number());
        // 2.3 times as many: one more for each leaf, and a second one for three in ten of them.
        let more = keep - 1.0;
        let whole = more.floor();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 4")]
        let n = whole as u32 + u32::from(unit(key) < more - whole);
        for k in 1..=n {
            if draft.organs.len() >= MOST_LEAVES {
                break;
            }
            let share = f64::from(k) / f64::from(n + 1);
            changed.leaves_added += usize::from(add_beside(draft, row, share * spacing, k, key));
        }
    }
    Ok(changed)
}

/// Adds a copy of a leaf, a little below it and around its shoot by the golden angle.
fn add_beside(draft: &mut Draft, row: usize, down: f64, k: u32, key: Seed) -> bool {
    let Some(at) = draft.organs[row].at else { return false };
    let turn = |along: DVec3| base::turn::about(along, f64::from(k) * 137.507_764 * (PI / 180.0)).normalize();
    let mut leaf = draft.organs[row].clone();
    leaf.what.key = key.child(u64::from(k)).number();
    let branch = &draft.branches[at.branch];
    if branch.kind == AxisKind::Petiole {
        // The stalk is copied with its leaf.
        let Some(foot) = branch.bearer else { return false };
        let mut stalk = branch.clone();
        stalk.key = key.child(u64::from(k)).child(1).number();
        let centre = stalk.points[0];
        let quat = turn(draft.branches[foot.branch].tangent(foot.node));
        stalk.points.iter_mut().for_each(|p| *p = centre + quat * (*p - centre));
        leaf.at = Some(At { branch: draft.branches.len(), node: at.node });
        draft.branches.push(stalk);
        place(&mut leaf, centre, centre, quat);
    } else {
        let along = branch.tangent(at.node);
        let (_, share) = geom::nearest_on_polyline3(&branch.points, leaf.what.frame.origin);
        let whole = branch.length();
        let on = |s: f64| geom::point_at3(&branch.points, s.clamp(0.0, whole));
        let (Some(from), Some(to)) = (on(share * whole), on(share * whole - down)) else { return false };
        place(&mut leaf, from, to, turn(along));
    }
    draft.organs.push(leaf);
    true
}

fn place(leaf: &mut Borne<plant::Organ>, from: DVec3, to: DVec3, quat: DQuat) {
    let f = leaf.what.frame;
    let origin = to + quat * (f.origin - from);
    leaf.what.frame = plant::Frame::looking(origin, quat * f.along, quat * f.normal);
}

/// Puts leaves on the branches that this edit made, arranged as the plant's other leaves.
pub(crate) fn dress(draft: &mut Draft, habit: &Habit, bench: &Bench<'_>) -> Result<(), Stop> {
    let Some(leaves) = &habit.leaves else { return Ok(()) };
    let fresh: Vec<usize> = (0..draft.branches.len())
        .filter(|&i| {
            draft.branches[i].alive && draft.branches[i].fresh && draft.branches[i].points.len() >= 2
        })
        .collect();
    let mut bare = Plant::default();
    for &b in &fresh {
        let branch = &draft.branches[b];
        let id = bare.add_axis(branch.kind, None, branch.key, &branch.points, None);
        let first = bare.axis(id).nodes.start as usize;
        bare.nodes.radius_m[first..].copy_from_slice(&branch.radii);
    }
    let blade = leaves.blade.clone();
    let (obstacles, run) = (bench.obstacles, bench.run);
    add_leaves(&mut bare, &leaves.spec, blade, &[], obstacles, Seed::new(1), run, &mut unread())?;
    for organ in bare.organs {
        let Some(node) = organ.bearer else { continue };
        let axis = bare.nodes.axis[node.index()];
        let first = bare.axes[axis.index()].nodes.start as usize;
        let at = At { branch: fresh[AxisId::index(axis)], node: node.index() - first };
        let paint = leaves.paints.get(Seed::new(organ.key).stream(Draw::Tint).below(leaves.paints.len()));
        let what = plant::Organ { shape: leaves.shape, paint: paint.copied().unwrap_or_default(), ..organ };
        draft.organs.push(Borne { what, at: Some(at), alive: true });
    }
    Ok(())
}
