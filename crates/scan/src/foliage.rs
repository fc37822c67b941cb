//! Leaves told from wood by the ways from the foot.
//!
//! Water, and the shortest way, comes to a leaf through the wood that bears it. Many ways run through wood and few through
//! a leaf (Vicari et al. 2019); what the ways to wood pass is wood again. Geometry says whether there are leaves at all:
//! wood is a line or a surface at the size of a twig, a crown in leaf is neither (Wang, Momo Takoudjou and Casella 2020).

use base::{CancelToken, Cancelled};
use glam::DVec3;

use crate::ways::{CUBES_AT_ONCE, NONE, Ways};

/// Metres beyond which no leaf with its stalk reaches.
const LEAF: f64 = 0.15;
/// Wood is seen as far as this from the ways that run through it, in cubes.
const ASIDE: f64 = 4.0;
/// Radius in which the form of the cloud is seen, metres; and the least cubes that show it.
const FORM: f64 = 0.06;
const FEW: usize = 8;
/// A line, or a surface: shares of variances.
const LINE: f64 = 0.7;
const FLAT: f64 = 0.06;
/// Share of scattered cubes from which on a tree is in leaf.
pub(crate) const SCATTERED: f64 = 0.36;
/// Cubes that are looked at.
const SAMPLE: usize = 20_000;
/// Cubes of these between two looks whether the tree is still wanted: each has up to some thousand neighbours.
const PLACES_AT_ONCE: usize = 64;

/// Which cubes of the tree are wood.
pub(crate) fn wood(
    ways: &Ways,
    mine: impl Fn(usize) -> bool,
    cancel: &CancelToken,
) -> Result<Vec<bool>, Cancelled> {
    let beyond = beyond(ways, &mine);
    let mut wood: Vec<bool> = (0..ways.len()).map(|c| mine(c) && beyond[c] >= LEAF).collect();
    // The whole surface of the wood that the ways run along.
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

/// A cube and those that the way to it passes.
fn retrace(ways: &Ways, c: usize, wood: &mut [bool]) {
    wood[c] = true;
    let mut at = ways.parent[c];
    while at != NONE && !wood[at as usize] {
        wood[at as usize] = true;
        at = ways.parent[at as usize];
    }
}

/// How far the ways go on beyond each cube.
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

/// The share of cubes about which the cloud is neither a line nor a surface.
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
