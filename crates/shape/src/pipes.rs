//! Radii after a cut or a graft: the pipe model, applied only to the changed parts.
//!
//! `r^t = sum of r_i^t` (He and Cheng 2021, Eq 6; Yang et al. 2019, Eq 4)

use base::ops;

use crate::draft::{At, Draft};

/// Returns the largest radius of old wood after a graft: a tenth more, and one and a half tips.
///
/// A twig may become a branch, but a trunk stays the same to the eye: filling an outline is about the crown. The limit
/// grows with the radius, so that nothing becomes thicker than its bearer.
fn most(old_m: f64, tip_m: f64) -> f64 {
    1.1 * old_m + 1.5 * tip_m
}

/// Thins a new branch on old wood, with all that it bears, so that its base suits its bearer; tips stay.
pub(crate) fn fit(draft: &mut Draft, b: usize, tip_m: f64) {
    let branch = &draft.branches[b];
    let (Some(at), Some(&base)) = (branch.bearer, branch.radii.first()) else { return };
    let bearer = &draft.branches[at.branch];
    let Some(&on) = bearer.radii.get(at.node).filter(|_| branch.fresh && !bearer.fresh) else { return };
    let limit = most(on, tip_m);
    if base <= limit || base <= tip_m {
        return;
    }
    let share = (limit - tip_m) / (base - tip_m);
    let inside = draft.subtree(b);
    for (branch, _) in draft.branches.iter_mut().zip(inside).filter(|(_, inside)| *inside) {
        for r in branch.radii.iter_mut().filter(|r| **r > tip_m) {
            *r = tip_m + (*r - tip_m) * share;
        }
    }
}

/// Pipes (`r^t`) added to a node or removed from it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pipes {
    /// Whether old wood grows by a bounded amount only, as under a graft; a moved branch keeps its thickness.
    pub(crate) bounded: bool,
    changes: Vec<(At, f64)>,
}

impl Pipes {
    /// Books a branch of this base radius as added to (`sign` 1) or removed from (`sign` -1) a node.
    pub(crate) fn book(&mut self, at: Option<At>, base_radius_m: f64, sign: f64, exponent: f64) {
        if let Some(at) = at {
            self.changes.push((at, sign * ops::powf(base_radius_m.max(0.0), exponent)));
        }
    }

    /// Sets the radii from those nodes down to the ground.
    ///
    /// Guaranteed: finite; nothing elsewhere changes; radii that fell towards the tip still do; no node becomes thinner
    /// than the thickest branch that it bears, nor than a tip, unless it was.
    pub(crate) fn settle(self, draft: &mut Draft, exponent: f64, tip_m: f64) {
        if self.changes.is_empty() {
            return;
        }
        let mut delta: Vec<Vec<(usize, f64)>> = vec![Vec::new(); draft.branches.len()];
        for (at, pipes) in self.changes {
            if pipes.is_finite() && draft.branches[at.branch].alive {
                delta[at.branch].push((at.node, pipes));
            }
        }
        // The thickest branch at each node: no fork may be thinner than its branches.
        let children = draft.children();
        for b in draft.order().into_iter().rev() {
            let mut here = core::mem::take(&mut delta[b]);
            if here.is_empty() {
                continue;
            }
            base::sort_by(&mut here, |a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
            let mut thickest = vec![0.0_f64; draft.branches[b].radii.len()];
            for &c in &children[b] {
                let child = &draft.branches[c];
                if let (Some(at), Some(&r)) = (child.bearer, child.radii.first())
                    && let Some(slot) = thickest.get_mut(at.node)
                {
                    *slot = slot.max(r);
                }
            }
            let branch = &mut draft.branches[b];
            let (before, bearer) = (branch.radii[0], branch.bearer);
            let (mut sum, mut old_above) = (0.0, 0.0);
            // Above the highest change not a bit may change: a power and its root are not the identity.
            let highest = here.last().map_or(0, |(n, _)| *n).min(branch.radii.len().saturating_sub(1));
            for node in (0..=highest).rev() {
                while here.last().is_some_and(|(n, _)| *n >= node) {
                    sum += here.pop().map_or(0.0, |(_, p)| p);
                }
                let old = branch.radii[node];
                let pipes = ops::powf((ops::powf(old, exponent) + sum).max(0.0), 1.0 / exponent);
                let wanted = if branch.fresh || !self.bounded { pipes } else { pipes.min(most(old, tip_m)) };
                let floor = thickest[node].max(old.min(tip_m));
                // An intended step in the radii (a swollen node) stays one.
                let above = branch.radii.get(node + 1).copied().unwrap_or(0.0);
                let least = if old >= old_above { above } else { above.min(old.max(wanted)) };
                (branch.radii[node], old_above) = (wanted.max(floor).max(least), old);
            }
            if branch.radii.iter().any(|r| !r.is_finite()) {
                branch.radii.iter_mut().for_each(|r| *r = if r.is_finite() { *r } else { tip_m });
            }
            fit(draft, b, tip_m);
            let change = ops::powf(draft.branches[b].radii[0], exponent) - ops::powf(before, exponent);
            if let Some(at) = bearer.filter(|_| change != 0.0 && change.is_finite()) {
                delta[at.branch].push((at.node, change));
            }
        }
    }
}
