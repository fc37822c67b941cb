//! Separation of leaves and wood by the paths from the foot.
//!
//! Water, and the shortest path, reaches a leaf through the wood that bears it. Many paths run through wood and few
//! through a leaf (Vicari et al. 2019); the cubes on the paths to wood are wood again. Geometry shows whether there
//! are leaves at all: at the size of a twig, wood is a line or a surface, and a crown in leaf is neither (Wang, Momo
//! Takoudjou and Casella 2020).

use base::{CancelToken, Cancelled};
use glam::DVec3;
use mesh::PointClass;

use crate::ways::{CUBES_AT_ONCE, NONE, Ways};

/// Greatest reach of a leaf with its stalk, metres.
const LEAF: f64 = 0.15;
/// Greatest distance of visible wood from the paths that run through it, in cubes.
const ASIDE: f64 = 4.0;
/// Least radius in which the form of the cloud is measured, metres.
const FORM: f64 = 0.06;
/// Least number of cubes that show the form.
const FEW: usize = 8;
/// Least difference of the two greatest variances of a line, as a share of the greatest.
const LINE: f64 = 0.7;
/// Greatest share of the least variance of a surface in their sum.
const FLAT: f64 = 0.06;
/// Share of scattered cubes from which a tree is in leaf.
pub(crate) const SCATTERED: f64 = 0.36;
/// Most cubes that are measured.
const SAMPLE: usize = 20_000;
/// Number of these cubes between two checks for cancellation: each has up to some thousand neighbours.
const PLACES_AT_ONCE: usize = 64;

/// Returns for each cube whether it is wood of the tree.
pub(crate) fn wood(
    ways: &Ways,
    mine: impl Fn(usize) -> bool,
    cancel: &CancelToken,
) -> Result<Vec<bool>, Cancelled> {
    let beyond = beyond(ways, &mine);
    let mut wood: Vec<bool> = (0..ways.len()).map(|c| mine(c) && beyond[c] >= LEAF).collect();
    // The whole surface of the wood along which the paths run.
    let core: Vec<usize> = (0..ways.len()).filter(|&c| wood[c]).collect();
    let near = ASIDE * ways.voxels.cell();
    let mut aside = vec![f64::INFINITY; ways.len()];
    let mut front: std::collections::VecDeque<usize> =
        core.into_iter().inspect(|&c| aside[c] = 0.0).collect();
    let mut done = 0_usize;
    while let Some(c) = front.pop_front() {
        done += 1;
        if done.is_multiple_of(CUBES_AT_ONCE) {
            cancel.check()?;
        }
        ways.voxels.near(c, 2, |k| {
            let step = aside[c] + ways.means[c].distance(ways.means[k]);
            if mine(k) && step < near && step < aside[k] {
                aside[k] = step;
                front.push_back(k);
            }
        });
    }
    for (c, _) in aside.iter().enumerate().filter(|(_, a)| **a < near) {
        retrace(ways, c, &mut wood);
    }
    Ok(wood)
}

/// Which cubes of the tree are wood where the file says of points that they are wood or leaf: those with as many points of wood as
/// of leaves, and what the ways to them pass. Points of no class are what the file names no class for.
pub(crate) fn labelled_wood(
    ways: &Ways,
    classes: &[PointClass],
    mine: impl Fn(usize) -> bool,
) -> Option<Vec<bool>> {
    let has = |class| classes.contains(&class);
    let (has_wood, has_leaves) = (has(PointClass::Wood), has(PointClass::Leaf));
    if !has_wood && !has_leaves {
        return None;
    }
    let is_core = |c: usize| {
        let count = |class| ways.voxels.rows(c).iter().filter(|&&p| classes[p as usize] == class).count();
        let (wood, leaves) = (count(PointClass::Wood), count(PointClass::Leaf));
        if has_leaves { leaves == 0 || wood >= leaves } else { wood > 0 }
    };
    let mut wood = vec![false; ways.len()];
    let core: Vec<usize> = (0..ways.len()).filter(|&c| mine(c) && is_core(c)).collect();
    core.iter().for_each(|&c| retrace(ways, c, &mut wood));
    (!core.is_empty()).then_some(wood)
}

/// A cube and those that the way to it passes.
fn retrace(ways: &Ways, c: usize, wood: &mut [bool]) {
    wood[c] = true;
    let mut at = ways.parent[c];
    while at != NONE && !wood[at as usize] {
        wood[at as usize] = true;
        at = ways.parent[at as usize];
    }
}

/// Returns how far the paths continue beyond each cube.
fn beyond(ways: &Ways, mine: impl Fn(usize) -> bool) -> Vec<f64> {
    let mut order: Vec<usize> = (0..ways.len()).filter(|&c| mine(c)).collect();
    order.sort_unstable_by(|&a, &b| ways.way[b].total_cmp(&ways.way[a]).then(a.cmp(&b)));
    let mut end: Vec<f64> = ways.way.clone();
    for &c in &order {
        let p = ways.parent[c];
        if p != NONE {
            end[p as usize] = end[p as usize].max(end[c]);
        }
    }
    end.iter().zip(&ways.way).map(|(e, w)| if w.is_finite() { e - w } else { 0.0 }).collect()
}

/// Returns the share of cubes around which the cloud is neither a line nor a surface.
pub(crate) fn scattered(
    ways: &Ways,
    mine: impl Fn(usize) -> bool,
    cancel: &CancelToken,
) -> Result<f64, Cancelled> {
    let all: Vec<usize> = (0..ways.len()).filter(|&c| mine(c)).collect();
    let cell = ways.voxels.cell();
    let radius = FORM.max(3.0 * cell);
    #[expect(clippy::cast_possible_truncation, reason = "some tens")]
    let reach = (radius / cell).ceil().min(40.0) as i32;
    let (mut seen, mut odd) = (0_usize, 0_usize);
    let mut near: Vec<DVec3> = vec![];
    for (done, &c) in all.iter().step_by(all.len() / SAMPLE + 1).enumerate() {
        if done.is_multiple_of(PLACES_AT_ONCE) {
            cancel.check()?;
        }
        near.clear();
        ways.voxels.near(c, reach, |k| {
            if mine(k) && ways.means[k].distance(ways.means[c]) < radius {
                near.push(ways.means[k]);
            }
        });
        if near.len() < FEW {
            continue;
        }
        let Some((_, _, [a, b, d])) = geom::pca3(&near) else { continue };
        seen += 1;
        odd += usize::from(a - b < LINE * a && d > FLAT * (a + b + d));
    }
    Ok(odd as f64 / seen.max(1) as f64)
}
