//! A tree at a younger age.
//!
//! `Skeleton of the whole tree + share of its life -> Skeleton, thinner and shorter, with the same branches`
//!
//! The leader, the path to the highest joint, rises by the law of Chapman and Richards. The share of its length that a
//! branch has reached equals the share that its bearer has reached of its part beyond that branch, so that a crown is a
//! cone below its tip, in leaf nearly from its foot on, at each age. Limbs that reach far aside wait for the leader to
//! get ahead of them and catch up later (apical control: Wilson, American Journal of Botany 87, 2000), and twigs are
//! complete after few years.
//!
//! Joints of large axes appear early and move apart; those of twigs appear one by one. So a leader has most of its
//! limbs early: in a wood the lowest die while new ones grow at the top, which looks the same at each age, although
//! there they are not the same ones. Stretches that bear nothing in the whole tree, the bole and the inner halves of
//! limbs, lengthen with their axis.

use base::ops;
use glam::DVec3;

use crate::wood::{boles, main_children, pipes, radii};
use crate::{JointId, Skeleton, WoodSpec};

/// Shape of growth (Richards 1959).
const SHAPE: f64 = 1.35;
/// Rate of growth per year: trees in the open have a third of the height at forty years after ten, and two thirds after
/// twenty.
const RATE_A_YEAR: f64 = 0.05;
/// Least and greatest rate over a whole life, for very short and very long lives.
const RATE: [f64; 2] = [1.6, 6.0];
/// Height of a leader above a limb under full apical control, relative to how far that limb reaches aside.
const CONTROL: f64 = 4.0;
/// Ratio of the reach of limbs to the height above which trees, such as umbrella thorns, are wider early, too. Crowns
/// of young trees are about half as wide as they are high.
const WIDE: f64 = 0.5;
/// Ratio of width to height below which crowns are columns from the start.
const SLENDER: f64 = 0.09;
/// Largest share of their length that limbs on the leader of such a column have, relative to that of the leader.
const COLUMN: f64 = 1.2;
/// Distance of the bearer's tip beyond the shortest twig at which the twig is complete, relative to the twig's length.
const WHOLE_AT: f64 = 1.2;
/// Share of a leader's growth that lengthens all of its internodes rather than adding new ones at its tip, 0 to 1;
/// smaller for shorter axes, and nearly 0 for twigs. With 1, a young tree is the whole one scaled down, and as dense in
/// twigs as a thicket; with 0 it is the foot of the whole one, with as many limbs as that has there.
const SIMILAR: f64 = 0.8;
/// Share of an axis without branches above which the stretch counts as bare.
const GAP: f64 = 0.08;
/// Least share of an axis's pipes that counts as a branch of it.
const COUNTS: f64 = 0.01;
/// Least share of an internode that is drawn at the tip of a growing shoot.
const BEGUN: f64 = 0.12;
/// Least number of branches at one joint that are the fronds of a palm or a tree fern.
const FRONDS: usize = 8;
/// Least length of the stem that bears such fronds, as a share of the height.
const ON_A_STEM: f64 = 0.25;
/// Exponent of the stem's share that gives the length of the fronds of a young palm: they come before the stem.
const FRONDS_FIRST: f64 = 0.4;
/// Least exponent of the height by which stems thicken, so that no young tree is stouter than the whole one (elastic
/// similarity: `McMahon`, Science 179, 1973).
const ELASTIC: f64 = 1.5;
/// Least ratio of the radius of twigs of the youngest tree to that of the whole tree.
const SLIMMEST: f64 = 0.16;

/// Returns the share of the final length at a share of a life of `years` years.
pub(crate) fn grown_by(life: f64, years: u32) -> f64 {
    let rate = (RATE_A_YEAR * f64::from(years)).clamp(RATE[0], RATE[1]);
    let all = 1.0 - ops::exp(-rate);
    ops::powf((1.0 - ops::exp(-rate * life.clamp(0.0, 1.0))) / all, SHAPE)
}

/// Returns the skeleton at a share of its life, above 0 and below 1, and the index in it of each of its joints.
///
/// Nested: a part that exists at one share exists at each later one. Given radii of the skeleton become thinner by the
/// pipes that do not exist yet. Cost: linear.
pub(crate) fn younger(
    full: &Skeleton,
    wood: &WoodSpec,
    life: f64,
    years: u32,
) -> (Skeleton, Vec<Option<JointId>>) {
    let axes = Axes::find(full, wood);
    let n = full.len();
    let leader = grown_by(life, years);
    // For each joint's axis, the present shares of its length and of its joints; for each joint, the share of its own
    // internode, and its position.
    let (mut grown, mut own, mut place) = (vec![leader; n], vec![1.0; n], full.position.clone());
    let mut opened: Vec<f64> =
        (0..n).map(|j| if full.parent[j].is_none() { axes.open(j, leader) } else { 0.0 }).collect();
    for j in 0..n {
        let Some(p) = full.parent[j].map(JointId::index) else { continue };
        (grown[j], opened[j]) = if axes.head[j] == axes.head[p] {
            (grown[p], opened[p])
        } else if axes.rosette[p] {
            (ops::powf(grown[p], FRONDS_FIRST), 1.0)
        } else {
            let share = axes.branch(j, p, grown[p], opened[p]);
            (share, axes.open(j, share))
        };
        let internode = axes.internode(full, j);
        let before = axes.shot_before(j, p);
        let shot = axes.shot[j] - before;
        let tip = opened[j] * axes.all_shot[axes.head[j]];
        own[j] = if tip >= axes.shot[j] { 1.0 } else { ((tip - before) / shot.max(1e-12)).clamp(0.0, 1.0) };
        let length = grown[j] * (internode - shot) + own[j] * shot * grown[j] / opened[j].max(1e-12);
        place[j] = place[p] + (full.position[j] - full.position[p]) * (length / internode.max(1e-12));
    }
    let there = |j: usize| {
        let Some(p) = full.parent[j].map(JointId::index) else { return true };
        own[j] >= 1.0 || (own[j] >= BEGUN && own[p] >= 1.0)
    };
    let (mut young, ids) = full.keep_mapped(there);
    for (id, at) in ids.iter().zip(&place) {
        if let Some(id) = id {
            young.position[id.index()] = *at;
        }
    }
    thinner(full, &mut young, &ids, wood);
    (young, ids)
}

/// Returns for each joint whether it bears the fronds of a palm or a tree fern.
fn rosettes(full: &Skeleton) -> Vec<bool> {
    let mut children = vec![0_usize; full.len()];
    full.parent.iter().flatten().for_each(|p| children[p.index()] += 1);
    let foot = full.position.first().map_or(0.0, |p| p.y);
    let high = full.position.iter().map(|p| p.y - foot).fold(0.0, f64::max);
    let on_a_stem = |j: usize| full.position[j].y - foot >= ON_A_STEM * high;
    let rosette: Vec<bool> = (0..full.len()).map(|j| children[j] >= FRONDS && on_a_stem(j)).collect();
    let branches = |of: &dyn Fn(usize) -> bool| -> usize {
        children.iter().enumerate().filter(|(j, _)| of(*j)).map(|(_, n)| n.saturating_sub(1)).sum()
    };
    // Twigs of a dense column may meet in one joint, too, but are few of all.
    if 2 * branches(&|j| rosette[j]) >= branches(&|_| true) { rosette } else { vec![false; full.len()] }
}

/// Returns the factor on the length of leaves, which are a part of the tree's own height, at a share of its life. On a
/// stem that bears nothing else, as in a banana, they come before the stem as fronds do.
pub(crate) fn fronds_by(full: &Skeleton, leaf_m: f64, life: f64, years: u32) -> f64 {
    let grown = grown_by(life, years);
    let mut borne = vec![0_usize; full.len()];
    full.parent.iter().flatten().for_each(|p| borne[p.index()] += 1);
    let one_stem = borne.iter().all(|n| *n <= 1) && leaf_m < full.size();
    if one_stem || rosettes(full).contains(&true) { ops::powf(grown, FRONDS_FIRST) } else { grown }
}

/// Returns the factor, 1 or less, on the thickness of each young tree relative to its pipes, as it has the foot of most
/// of its limbs. Stems of palms and ferns have their thickness before their height: they are not thinned.
pub(crate) fn slimmer(full: &Skeleton, young: &Skeleton, wood: &WoodSpec) -> Vec<f64> {
    if rosettes(full).contains(&true) {
        return Vec::new();
    }
    let trees = full.tree.iter().max().map_or(0, |t| *t as usize + 1);
    let measured = |s: &Skeleton| {
        let (thick, mut of) = (radii(s, wood), vec![(0.0_f64, 0.0_f64); trees]);
        let mut foot = vec![0.0; trees];
        for (j, parent) in s.parent.iter().enumerate() {
            let t = s.tree[j] as usize;
            if parent.is_none() {
                foot[t] = s.position[j].y;
            }
            of[t] = (of[t].0.max(s.position[j].y - foot[t]), of[t].1.max(thick[j]));
        }
        of
    };
    let slim = |((high, thick), (now, r)): ((f64, f64), (f64, f64))| {
        let usual = thick * ops::powf((now / high.max(1e-9)).clamp(0.0, 1.0), ELASTIC);
        if r <= 0.0 { 1.0 } else { (usual / r).clamp(SLIMMEST, 1.0) }
    };
    measured(full).into_iter().zip(measured(young)).map(slim).collect()
}

/// The axes of a whole tree: their joints and their growth.
struct Axes {
    /// Whether each joint bears fronds.
    rosette: Vec<bool>,
    /// The first joint of each joint's axis, roots for trunks.
    head: Vec<usize>,
    /// For each joint, the distance along its axis from its start on the bearer, metres.
    along: Vec<f64>,
    /// The part of `along` that is not bare.
    shot: Vec<f64>,
    /// By head: length of the axis, the part of it that is not bare, and how far aside it ends, metres.
    whole: Vec<f64>,
    all_shot: Vec<f64>,
    aside: Vec<f64>,
    /// By tree: the length of its leader, and of the longest branch that leaves it, and how far aside any of these
    /// ends.
    leader: Vec<f64>,
    limb: Vec<f64>,
    reach: Vec<f64>,
    tree: Vec<u32>,
}

impl Axes {
    fn find(full: &Skeleton, wood: &WoodSpec) -> Self {
        let n = full.len();
        let mut main = main_children(full, &radii(full, wood));
        lead_to_the_top(full, &mut main);
        let rosette = rosettes(full);
        main.iter_mut().zip(&rosette).filter(|(_, r)| **r).for_each(|(m, _)| *m = None);
        let on_bole = boles(full, &main);
        let pipes = pipes(full, wood.internode_share);
        let trees = full.tree.iter().max().map_or(0, |t| *t as usize + 1);
        let none = || vec![0.0; n];
        let mut axes = Self {
            rosette,
            head: (0..n).collect(),
            along: none(),
            shot: none(),
            whole: none(),
            all_shot: none(),
            aside: none(),
            leader: vec![1e-12; trees],
            limb: vec![1e-12; trees],
            reach: vec![1e-12; trees],
            tree: full.tree.clone(),
        };
        for j in 0..n {
            if let Some(p) = full.parent[j].map(JointId::index).filter(|&p| main[p] == Some(JointId::new(j)))
            {
                axes.head[j] = axes.head[p];
            }
        }
        // Joints with a branch that counts, and those with one further on.
        let mut bears = vec![false; n];
        for j in 0..n {
            if let Some(p) = full.parent[j].map(JointId::index).filter(|_| axes.head[j] == j) {
                bears[p] |= pipes[j] >= COUNTS * pipes[axes.head[p]];
            }
        }
        let mut later = bears.clone();
        for j in (0..n).rev() {
            later[j] |= main[j].is_some_and(|m| later[m.index()]);
            if main[j].is_none() {
                let (end, head) = (full.position[j], axes.head[j]);
                let foot = full.parent[head].map_or(end, |p| full.position[p.index()]);
                axes.aside[head] = DVec3::new(end.x - foot.x, 0.0, end.z - foot.z).length();
            }
        }
        axes.measure(full);
        let mut quiet = none();
        for j in 0..n {
            let Some(p) = full.parent[j].map(JointId::index) else { continue };
            let (h, internode) = (axes.head[j], axes.internode(full, j));
            quiet[j] = internode + if h == j || bears[p] || on_bole[p] { 0.0 } else { quiet[p] };
            let bare = match (on_bole[j], later[j]) {
                (true, _) => internode,
                (_, true) => (quiet[j] - GAP * axes.whole[h]).clamp(0.0, internode),
                _ => 0.0,
            };
            axes.shot[j] = axes.shot_before(j, p) + internode - bare;
            axes.all_shot[h] = axes.all_shot[h].max(axes.shot[j]);
        }
        axes
    }

    /// Measures lengths.
    fn measure(&mut self, full: &Skeleton) {
        for j in 0..full.len() {
            let Some(p) = full.parent[j].map(JointId::index) else { continue };
            let h = self.head[j];
            self.along[j] = self.internode(full, j) + if h == j { 0.0 } else { self.along[p] };
            self.whole[h] = self.whole[h].max(self.along[j]);
        }
        for h in (0..full.len()).filter(|&j| self.head[j] == j) {
            let t = self.tree[h] as usize;
            match full.parent[h].map(|p| self.head[p.index()]) {
                None => self.leader[t] = self.leader[t].max(self.whole[h]),
                Some(bearer) if full.parent[bearer].is_none() => {
                    self.limb[t] = self.limb[t].max(self.whole[h]);
                    self.reach[t] = self.reach[t].max(self.aside[h]);
                }
                Some(_) => {}
            }
        }
    }

    fn internode(&self, full: &Skeleton, j: usize) -> f64 {
        full.parent[j].map_or(0.0, |p| full.position[p.index()].distance(full.position[j]))
    }

    /// Returns the part of the axis of `j` that is not bare up to its parent `p`.
    fn shot_before(&self, j: usize, p: usize) -> f64 {
        if self.head[j] == self.head[p] { self.shot[p] } else { 0.0 }
    }

    /// Returns the present share of joints of the axis which begins with joint `h`, at a share of its length.
    fn open(&self, h: usize, grown: f64) -> f64 {
        let size = (self.whole[h] / self.leader[self.tree[h] as usize]).min(1.0);
        ops::powf(grown, 1.0 - SIMILAR * size)
    }

    /// Returns the present share of length of the branch which begins with joint `h`, on joint `p` of its bearer, when
    /// the bearer has `bearer` of its own, and `begun` of its joints.
    fn branch(&self, h: usize, p: usize, bearer: f64, begun: f64) -> f64 {
        let b = self.head[p];
        let beyond = self.whole[b] - self.along[p];
        if beyond <= 1e-9 {
            return bearer;
        }
        // The current position of the branch on its bearer, and the distance of the bearer's tip beyond it.
        let foot = bearer * (self.along[p] - self.shot[p])
            + self.shot[p].min(begun * self.all_shot[b]) * bearer / begun.max(1e-12);
        let now = (bearer * self.whole[b] - foot).max(0.0);
        let t = self.tree[h] as usize;
        let length = self.whole[h];
        let small = (1.0 - length / self.limb[t]).max(0.05);
        let needed = (WHOLE_AT * length / (small * small)).min(beyond).max(1e-12);
        let broad = self.reach[t] / self.leader[t];
        let full = (CONTROL * (WIDE / broad) * (WIDE / broad)).clamp(1.0, CONTROL);
        let control = 1.0 + (full - 1.0) * (self.whole[b] / self.leader[t]).min(1.0);
        let free = (needed / (control * self.aside[h]).max(1e-12)).min(1.0);
        let share = (now / needed).min(1.0);
        // Limbs that waited catch up by the third power.
        let reached = share * (free + (1.0 - free) * share * share);
        let leads = self.whole[b] >= self.leader[t];
        if leads { reached.min(COLUMN * bearer * (broad / SLENDER).max(1.0)) } else { reached }
    }
}

/// Makes the path to the highest joint of each tree its leader.
fn lead_to_the_top(full: &Skeleton, main: &mut [Option<JointId>]) {
    let trees = full.tree.iter().max().map_or(0, |t| *t as usize + 1);
    let mut top: Vec<Option<usize>> = vec![None; trees];
    for j in 0..full.len() {
        let best = &mut top[full.tree[j] as usize];
        if best.is_none_or(|b| full.position[j].y > full.position[b].y) {
            *best = Some(j);
        }
    }
    for mut j in top.into_iter().flatten() {
        while let Some(p) = full.parent[j].map(JointId::index) {
            main[p] = Some(JointId::new(j));
            j = p;
        }
    }
}

/// Reduces given radii to those of the present pipes.
fn thinner(full: &Skeleton, young: &mut Skeleton, ids: &[Option<JointId>], wood: &WoodSpec) {
    if full.radius_m.iter().all(|r| *r <= 0.0) {
        return;
    }
    let (all, now) = (pipes(full, wood.internode_share), pipes(young, wood.internode_share));
    for (j, id) in ids.iter().enumerate() {
        if let Some(id) = id {
            // A tip is as thin as any, and the foot of the whole tree keeps its thickness; between them, by its share
            // of pipes, and quickly: free-standing oaks of ten years are 5 to 12 cm thick at breast height.
            let (all, now) = (all[j].max(1.0), now[id.index()].max(1.0));
            let by_pipes = |pipes: f64| wood.tip_radius_m * ops::powf(pipes, 1.0 / wood.pipe_exponent);
            let stout = full.radius_m[j].max(1e-9) / by_pipes(all);
            let share =
                if all > 1.0 + 1e-9 { (ops::ln(now) / ops::ln(all)).clamp(0.0, 1.0).sqrt() } else { 1.0 };
            let r = by_pipes(now) * ops::powf(stout, share);
            young.radius_m[id.index()] = r.min(full.radius_m[j]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CompetitionSpec, Obstacles, compete};
    use base::{Report, Run, Seed};

    #[test]
    fn heights_follow_the_curve() {
        for years in [1, 40, 300] {
            assert!(grown_by(0.0, years) < 1e-12 && (grown_by(1.0, years) - 1.0).abs() < 1e-12);
            assert!(
                (1..=50)
                    .all(|i| grown_by(f64::from(i) / 50.0, years) > grown_by(f64::from(i - 1) / 50.0, years))
            );
        }
    }

    #[test]
    fn a_tree_only_grows_and_ends_as_itself() {
        let spec = CompetitionSpec { points: 600, ..CompetitionSpec::default() };
        let (run, none) = (Run::plain(), Obstacles::none());
        let full = compete(&[DVec3::ZERO], &none, &spec, Seed::new(1), &run, &mut Report::default());
        let full = full.expect("sound").skeleton;
        let top = |s: &Skeleton| s.position.iter().map(|p| p.y).fold(0.0, f64::max);
        let wood = WoodSpec::default();
        let mut last: (usize, f64, Vec<bool>) = (1, 0.0, vec![false; full.len()]);
        for i in 1..=12 {
            let (young, ids) = younger(&full, &wood, f64::from(i) / 12.0, 40);
            assert_eq!(young.validate().count(), 0);
            assert!(young.len() >= last.0 && top(&young) >= last.1, "{i}: {} {}", young.len(), top(&young));
            assert!(
                ids.iter().zip(&last.2).all(|(id, before)| id.is_some() || !before),
                "{i}: nothing is lost"
            );
            last = (young.len(), top(&young), ids.iter().map(Option::is_some).collect());
        }
        assert_eq!(last.0, full.len());
        assert!((last.1 - top(&full)).abs() < 1e-9);
        // A third of its life gives about two fifths of its height, with limbs of its own.
        let (young, _) = younger(&full, &wood, 0.33, 40);
        assert!((0.33..0.6).contains(&(top(&young) / top(&full))) && young.len() > 30, "{}", young.len());
    }

    #[test]
    fn fronds_are_most_of_what_a_palm_bears_and_twigs_of_one_joint_few() {
        // A stem of ten joints that bears a limb at each, and ten more at its top.
        let stem = |limbs: bool| {
            let mut s = Skeleton::default();
            let mut top = s.push_root(DVec3::ZERO, 0);
            for n in 1..=10 {
                top = s.push(DVec3::Y * f64::from(n), top, 0);
                for k in 0..if limbs { 3 } else { 0 } {
                    s.push(DVec3::new(f64::from(k) + 1.0, f64::from(n), 0.0), top, 0);
                }
            }
            for k in 0..10 {
                s.push(DVec3::new(f64::from(k), 10.0, 1.0), top, 0);
            }
            s
        };
        assert_eq!(rosettes(&stem(false)).iter().filter(|r| **r).count(), 1, "a palm");
        assert_eq!(rosettes(&stem(true)).iter().filter(|r| **r).count(), 0, "a column");
    }

    #[test]
    fn nothing_jumps_as_a_tree_grows() {
        let spec = CompetitionSpec { points: 600, ..CompetitionSpec::default() };
        let (run, none) = (Run::plain(), Obstacles::none());
        let full = compete(&[DVec3::ZERO], &none, &spec, Seed::new(2), &run, &mut Report::default());
        let (full, wood) = (full.expect("sound").skeleton, WoodSpec::default());
        let at = |i: u32| younger(&full, &wood, f64::from(i) / 250.0, 40);
        let mut last = at(24);
        for i in 25..250 {
            let now = at(i);
            for (a, b) in last.1.iter().zip(&now.1) {
                if let (Some(a), Some(b)) = (a, b) {
                    let moved = last.0.position[a.index()].distance(now.0.position[b.index()]);
                    assert!(moved < 0.03 * full.size(), "{i}: {moved} m of {} m", full.size());
                }
            }
            last = now;
        }
        // The limit is the whole tree.
        let (nearly, ids) = younger(&full, &wood, 1.0 - 1e-9, 40);
        for (j, id) in ids.iter().enumerate() {
            let off = id.map_or(0.0, |id| nearly.position[id.index()].distance(full.position[j]));
            assert!(off < 1e-5, "{j}: {off}");
        }
    }
}
