//! A tree as it was when it was younger.
//!
//! `Skeleton of the whole tree + share of its life -> Skeleton, thinner and shorter, with the same branches`
//!
//! The trunk rises by the law of Chapman and Richards; every branch starts when its bearer reaches its place and then
//! grows by the same law until the end. The bole below the lowest limb lengthens with the tree, so that a young tree
//! has its crown near the ground: in a wood the lowest limbs die while new ones grow at the top, which looks the same
//! at each age, though there the limbs are not the same ones.

use base::ops;
use glam::DVec3;

use crate::wood::{boles, main_children, pipes, radii};
use crate::{JointId, Skeleton, WoodSpec};

/// Rate and shape of growth (Richards 1959): half of the height is there at two fifths of the life that is looked at.
const RATE: f64 = 1.6;
const SHAPE: f64 = 1.35;
/// The share of its remaining life that the shortest twig takes to its length.
const AT_ONCE: f64 = 0.08;
/// The least share of an internode that is drawn at the tip of a growing shoot.
const BEGUN: f64 = 0.12;

/// The share of the final length at a share of life.
pub(crate) fn grown_by(life: f64) -> f64 {
    let all = 1.0 - ops::exp(-RATE);
    ops::powf((1.0 - ops::exp(-RATE * life.clamp(0.0, 1.0))) / all, SHAPE)
}

/// The share of life at which a share of the length is reached.
fn reached_at(length: f64) -> f64 {
    let all = 1.0 - ops::exp(-RATE);
    let share = ops::powf(length.clamp(0.0, 1.0), 1.0 / SHAPE);
    (-ops::ln(1.0 - all * share) / RATE).min(1.0)
}

/// The skeleton at a share of its life, above 0 and below 1, and where each of its joints is then.
///
/// Nested: what is there at one share is there at each later one. Radii that the skeleton brings along become thinner by
/// the pipes that are not there yet. Cost: linear.
pub(crate) fn younger(full: &Skeleton, wood: &WoodSpec, life: f64) -> (Skeleton, Vec<Option<JointId>>) {
    let radius = radii(full, wood);
    let main = main_children(full, &radius);
    let n = full.len();
    let from = |j: usize| full.parent[j].map_or(0.0, |p| full.position[p.index()].distance(full.position[j]));
    // From each joint on to the end of its axis.
    let mut rest = vec![0.0; n];
    for j in (0..n).rev() {
        if let Some(m) = main[j] {
            rest[j] = rest[m.index()] + from(m.index());
        }
    }
    let on_bole = boles(full, &main);
    let share = grown_by(life);
    let longest = rest.iter().copied().fold(0.0, f64::max);
    // When each axis started, how long it will be, and where on it a joint is.
    let (mut start, mut whole, mut along, mut birth) =
        (vec![0.0; n], rest.clone(), vec![0.0; n], vec![0.0; n]);
    // What a joint is moved by, as the bole below it is not as long yet.
    let mut moved = vec![DVec3::ZERO; n];
    for j in 0..n {
        let Some(p) = full.parent[j].map(JointId::index) else { continue };
        if on_bole[j] {
            moved[j] = moved[p] - (full.position[j] - full.position[p]) * (1.0 - share);
            whole[j] = rest[j];
            continue;
        }
        moved[j] = moved[p];
        if main[p].is_some_and(|m| m.index() == j) {
            (start[j], whole[j], along[j]) = (start[p], whole[p], along[p] + from(j));
        } else {
            (start[j], whole[j], along[j]) = (birth[p], rest[j] + from(j), from(j));
        }
        // Twigs are as long as they will be after few years: shoots of a tree are of like length each year.
        let span = (AT_ONCE + 2.0 * whole[j] / longest.max(1e-12)).min(1.0);
        birth[j] = start[j] + span * (1.0 - start[j]) * reached_at(along[j] / whole[j].max(1e-12));
    }
    let begun = |j: usize| {
        let before = full.parent[j].map_or(0.0, |p| birth[p.index()]);
        ((life - before) / (birth[j] - before).max(1e-12)).clamp(0.0, 1.0)
    };
    let there = |j: usize| {
        let Some(p) = full.parent[j].map(JointId::index) else { return true };
        on_bole[j] || birth[j] <= life || (birth[p] <= life && begun(j) >= BEGUN)
    };
    let (mut young, ids) = full.keep_mapped(there);
    for (j, id) in ids.iter().enumerate() {
        let (Some(id), Some(p)) = (id, full.parent[j]) else { continue };
        let own = if on_bole[j] || birth[j] <= life { 1.0 } else { begun(j) };
        let foot = full.position[p.index()];
        young.position[id.index()] = foot + (full.position[j] - foot) * own + moved[j];
    }
    thinner(full, &mut young, &ids, wood);
    (young, ids)
}

/// Radii of their own become those of the pipes that are there.
fn thinner(full: &Skeleton, young: &mut Skeleton, ids: &[Option<JointId>], wood: &WoodSpec) {
    if full.radius_m.iter().all(|r| *r <= 0.0) {
        return;
    }
    let (all, now) = (pipes(full, wood.internode_share), pipes(young, wood.internode_share));
    for (j, id) in ids.iter().enumerate() {
        if let Some(id) = id {
            // A tip is as thin as any, and the foot of the whole as thick as it is; between them, by its share of pipes,
            // and soon: free-standing oaks of ten years are 5 to 12 cm thick at breast height.
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
    fn lengths_and_times_are_one_law() {
        for i in 0..=20 {
            let life = f64::from(i) / 20.0;
            assert!((reached_at(grown_by(life)) - life).abs() < 1e-9, "{life}");
        }
        assert!(grown_by(0.0) < 1e-12 && (grown_by(1.0) - 1.0).abs() < 1e-12);
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
            let (young, ids) = younger(&full, &wood, f64::from(i) / 12.0);
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
        // A third of its life makes about two fifths of its height, with limbs of its own.
        let (young, _) = younger(&full, &wood, 0.33);
        assert!((0.33..0.6).contains(&(top(&young) / top(&full))) && young.len() > 30, "{}", young.len());
    }
}
