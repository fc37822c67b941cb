//! Depth of branches by maximum entropy (He and Cheng 2021, section 5.2, Eq 4; docs/papers.md).
//!
//! `flat AxisPlans -> rotation of each branch about its bearer -> z of every node`
//!
//! A rotation by phi about the bearer that keeps the drawing turns the distance from the bearer's line into depth:
//! `z = z_bearer + side * q_perp * tan(phi)`, `side` being the half plane (left or right) in which the branch was
//! drawn. |phi| stays below 65 degrees, so left branches stay left.

use base::{Draw, Seed, ops};
use glam::{DVec2, DVec3};
use plant::AxisKind;

use super::Plans;
use super::axes::AxisPlan;
use crate::{BranchDepth, SketchSpec};

/// Largest rotation, radians: 65 degrees lengthen a branch at right angles 2.4 times.
const MOST: f64 = 65.0 * (ops::PI / 180.0);
/// Deviation of the first guess, radians (25 degrees).
const SPREAD: f64 = 25.0 * (ops::PI / 180.0);
/// Least rotation of the first guess in `riesz` mode, radians (12 degrees): a lone pair would stay in the plane.
const LEAST: f64 = 12.0 * (ops::PI / 180.0);
/// Lengthening that costs nothing in `riesz` mode: 15 % go unnoticed (30 degrees at right angles).
const FREE: f64 = 0.15;
/// Sweeps of the coordinate ascent (the paper needs no optimum).
const SWEEPS: usize = 80;
/// Greatest distance in the bearer's order at which siblings affect each other: the cost stays linear.
const SEEN: usize = 16;
/// Length over which directions at an attachment are measured, ink units.
const WINDOW: f64 = 0.03;
/// Steepest rise that a branch takes over from its bearer.
const HANDED_ON: f64 = 1.2;

/// A branch as the entropy sees it: in the frame of its bearer (along, across, towards the viewer).
#[derive(Clone, Debug)]
pub(crate) struct Child {
    /// Drawn displacement from the attachment to the branch's middle: along the bearer and across it.
    pub(crate) middle: DVec2,
    /// Drawn pieces, same frame.
    pub(crate) pieces: Vec<DVec2>,
    /// +1 to the left of the bearer, -1 to the right.
    pub(crate) side: f64,
    /// Rise that it takes over from the bearer.
    pub(crate) rise: f64,
    /// First guess, radians.
    pub(crate) first: f64,
}

impl Child {
    /// Returns the displacement in space at a rotation: along, across, towards the viewer.
    fn space(&self, q: DVec2, phi: f64) -> DVec3 {
        DVec3::new(q.x, q.y, self.side * q.y * ops::tan(phi) + q.x * self.rise)
    }

    fn direction(&self, phi: f64) -> DVec3 {
        self.space(self.middle, phi).try_normalize().unwrap_or(DVec3::X)
    }

    /// Returns (length in space - drawn length) / drawn length.
    fn lengthening(&self, phi: f64) -> f64 {
        let flat: f64 = self.pieces.iter().map(|q| q.length()).sum();
        let deep: f64 = self.pieces.iter().map(|&q| self.space(q, phi).length()).sum();
        if flat > 0.0 { deep / flat - 1.0 } else { 0.0 }
    }
}

/// Gives every planned axis its depth, bearers before the axes that they bear.
pub(crate) fn branch_depths(plans: &mut Plans, mode: BranchDepth, seed: Seed) {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); plans.rows.len()];
    let mut ground = Vec::new();
    for (row, plan) in plans.rows.iter().enumerate() {
        match plan.as_ref().map(|p| p.bearer) {
            Some(Some((on, _))) => children[on].push(row),
            Some(None) => ground.push(row),
            None => {}
        }
    }
    spread_ground(plans, &ground, mode, seed);
    for (row, borne) in children.iter_mut().enumerate() {
        let Some(parent) = plans.rows[row].clone().filter(|_| !borne.is_empty()) else { continue };
        // Neighbours along the bearer become neighbours in the list.
        base::sort_by_key(borne, |&c| plans.rows[c].as_ref().map_or(0, |p| p.bearer.map_or(0, |b| b.1)));
        let seen: Vec<(Child, DVec2, DVec2)> = borne
            .iter()
            .filter_map(|&c| {
                let plan = plans.rows[c].as_ref()?;
                let node = plan.bearer.map_or(0, |b| b.1);
                let along = parent.direction(node, WINDOW);
                let rise = parent.slope(node, WINDOW).clamp(-HANDED_ON, HANDED_ON);
                Some((child(plan, along, rise, mode, seed), along, along.perp()))
            })
            .collect();
        let only: Vec<Child> = seen.iter().map(|s| s.0.clone()).collect();
        let turned = most_entropy(&only, mode, |_, _| true);
        for (((c, along, across), phi), &row) in seen.iter().zip(turned).zip(borne.iter()) {
            let Some(plan) = plans.rows[row].as_mut() else { continue };
            let node = plan.bearer.map_or(0, |b| b.1);
            let base = parent.points[node.min(parent.points.len() - 1)];
            for p in &mut plan.points {
                let q = p.truncate() - base.truncate();
                p.z = base.z + c.space(DVec2::new(q.dot(*along), q.dot(*across)), phi).z;
            }
        }
    }
}

/// Spreads several axes that stand on the ground about the plumb line through the first of the longest. Axes whose
/// feet are farther apart than the length of the longer one belong to plants side by side, and do not affect each
/// other.
fn spread_ground(plans: &mut Plans, ground: &[usize], mode: BranchDepth, seed: Seed) {
    let standing: Vec<usize> = ground.to_vec();
    if standing.len() < 2 {
        return;
    }
    let length = |row: &usize| plans.rows[*row].as_ref().and_then(|p| p.at.last().copied()).unwrap_or(0.0);
    let Some(main) = standing.iter().copied().reduce(|a, b| if length(&b) > length(&a) { b } else { a })
    else {
        return;
    };
    let Some(foot) = plans.rows[main].as_ref().map(|p| p.points[0].truncate()) else { return };
    let children: Vec<Child> = standing
        .iter()
        .filter_map(|&row| plans.rows[row].as_ref().map(|p| child(p, DVec2::Y, 0.0, mode, seed)))
        .collect();
    let feet: Vec<(DVec2, f64)> = standing
        .iter()
        .filter_map(|row| Some((plans.rows[*row].as_ref()?.points[0].truncate(), length(row))))
        .collect();
    let turned = most_entropy(&children, mode, |i, j| {
        let ((a, high), (b, other)) = (feet[i], feet[j]);
        a.distance(b) <= high.max(other)
    });
    for ((c, phi), &row) in children.iter().zip(turned).zip(&standing) {
        let Some(plan) = plans.rows[row].as_mut() else { continue };
        let own = plan.points[0].truncate();
        // Feet that stand apart in the drawing stand a little apart in depth, too.
        let base_z = (0.5 * (foot.x - own.x) * c.side * ops::tan(phi)).clamp(-0.12, 0.12);
        for p in &mut plan.points {
            let q = p.truncate() - own;
            p.z = base_z + c.space(DVec2::new(q.y, -q.x), phi).z;
        }
    }
}

fn child(plan: &AxisPlan, along: DVec2, rise: f64, mode: BranchDepth, seed: Seed) -> Child {
    let across = along.perp();
    let base = plan.points[0].truncate();
    let local = |p: DVec3| {
        let q = p.truncate() - base;
        DVec2::new(q.dot(along), q.dot(across))
    };
    #[expect(clippy::cast_precision_loss, reason = "nodes of one axis")]
    let middle = plan.points.iter().map(|&p| local(p)).sum::<DVec2>() / plan.points.len() as f64;
    let stride = plan.points.len().div_ceil(8).max(1);
    let mut stops: Vec<DVec2> = plan.points.iter().step_by(stride).map(|&p| local(p)).collect();
    if let Some(&last) = plan.points.last() {
        stops.push(local(last));
    }
    let pieces = stops.windows(2).map(|w| w[1] - w[0]).filter(|q| q.length_squared() > 0.0).collect();
    let mut first = SPREAD * seed.child(plan.key).stream(Draw::BranchDepth).normal();
    if mode == BranchDepth::Riesz && first.abs() < LEAST {
        first = if first < 0.0 { -LEAST } else { LEAST };
    }
    Child {
        middle,
        pieces,
        side: if middle.y < 0.0 { -1.0 } else { 1.0 },
        rise,
        first: first.clamp(-MOST, MOST),
    }
}

/// Returns the rotations of siblings at which Eq 4 is large: coordinate ascent with halving steps.
///
/// `paper`: `alpha * mean angle + beta * mean exp(-lengthening)`; `riesz`: `-alpha * mean 1/angle^2` instead, since
/// the sum of angles does not distinguish an even spread from two clumps (docs/papers.md). alpha = beta = 1. Siblings
/// in the order of their places along the bearer; `sees`: whether two that are near in that order affect each other.
pub(crate) fn most_entropy(
    children: &[Child],
    mode: BranchDepth,
    sees: impl Fn(usize, usize) -> bool,
) -> Vec<f64> {
    let n = children.len();
    let mut phi: Vec<f64> = children.iter().map(|c| c.first).collect();
    let mut dir: Vec<DVec3> = children.iter().zip(&phi).map(|(c, &p)| c.direction(p)).collect();
    let window = |i: usize| (i.saturating_sub(SEEN)..(i + SEEN + 1).min(n)).filter(move |&j| j != i);
    let near: Vec<Vec<usize>> = (0..n).map(|i| window(i).filter(|&j| sees(i, j)).collect()).collect();
    let most = n.min(SEEN * 2 + 1).saturating_sub(1);
    let score = |i: usize, own: DVec3, at: f64, dir: &[DVec3]| {
        let seen = most - (window(i).count() - near[i].len());
        #[expect(clippy::cast_precision_loss, reason = "counts")]
        let (pairs, count) = ((n * seen) as f64 / 2.0, n as f64);
        let angles: f64 = near[i]
            .iter()
            .map(|&j| {
                let theta = ops::acos_clamped(own.dot(dir[j]));
                match mode {
                    BranchDepth::Paper => theta,
                    // 0.02 rad: branches drawn over one another must not outweigh all others.
                    BranchDepth::Riesz => -1.0 / (theta * theta).max(4e-4),
                }
            })
            .sum();
        let free = if mode == BranchDepth::Riesz { FREE } else { 0.0 };
        angles / pairs.max(1.0) + ops::exp(-(children[i].lengthening(at) - free).max(0.0)) / count
    };
    let mut step = 12.0 * (ops::PI / 180.0);
    // Tried at this step, and none of those that affect it has moved since: it would stay in place.
    let mut settled = vec![false; n];
    for _ in 0..SWEEPS {
        let mut moved = false;
        for i in 0..n {
            if core::mem::replace(&mut settled[i], true) {
                continue;
            }
            let mut best = (score(i, dir[i], phi[i], &dir), phi[i], dir[i]);
            for to in [phi[i] - step, phi[i] + step] {
                let to = to.clamp(-MOST, MOST);
                let d = children[i].direction(to);
                let s = score(i, d, to, &dir);
                if s > best.0 + 1e-12 {
                    best = (s, to, d);
                    moved = true;
                }
            }
            if best.1.to_bits() != phi[i].to_bits() {
                (phi[i], dir[i]) = (best.1, best.2);
                settled[i] = false;
                near[i].iter().for_each(|&j| settled[j] = false);
            }
        }
        if !moved {
            step *= 0.5;
            settled.fill(false);
            if step < 0.5 * (ops::PI / 180.0) {
                break;
            }
        }
    }
    phi
}

/// Bends borne branches towards the light (up) and down under their weight, along their length; the parts that they
/// bear move with them. Changes the front view: both are 0 by default.
pub(crate) fn bend_by_light_and_weight(plans: &mut Plans, spec: &SketchSpec) {
    let sound = |x: f64, lo: f64| if x.is_finite() { x.clamp(lo, 1.0) } else { 0.0 };
    let (light, weight) = (sound(spec.phototropism, -1.0), sound(spec.gravity, 0.0));
    if light == 0.0 && weight == 0.0 {
        return;
    }
    let before: Vec<Option<Vec<DVec3>>> =
        plans.rows.iter().map(|r| r.as_ref().map(|p| p.points.clone())).collect();
    for (row, old) in before.iter().enumerate() {
        let Some((on, node)) = plans.rows[row].as_ref().and_then(|p| p.bearer) else { continue };
        let Some(base) = plans.rows[on].as_ref().and_then(|p| p.points.get(node).copied()) else { continue };
        let (Some(plan), Some(old)) = (plans.rows[row].as_mut(), old) else { continue };
        if plan.kind == AxisKind::Root {
            continue;
        }
        let total: f64 = old.windows(2).map(|w| w[0].distance(w[1])).sum();
        let (mut here, mut passed) = (base, 0.0);
        plan.points[0] = base;
        for i in 1..old.len() {
            let piece = old[i] - old[i - 1];
            passed += piece.length();
            let share = if total > 0.0 { passed / total } else { 0.0 };
            // 60 degrees at the tip of a branch under full pull; heavier (longer) branches sag more.
            let up = share * (light - weight * (total / 0.3).min(1.5));
            here += turn_towards(piece, if up >= 0.0 { DVec3::Y } else { DVec3::NEG_Y }, up.abs());
            plan.points[i] = here;
        }
    }
}

fn turn_towards(piece: DVec3, target: DVec3, pull: f64) -> DVec3 {
    let Some(d) = piece.try_normalize() else { return piece };
    let Some(axis) = d.cross(target).try_normalize() else { return piece };
    let apart = ops::acos_clamped(d.dot(target));
    let angle = (pull * ops::sin(apart) * (ops::PI / 3.0)).min(apart);
    base::turn::about(axis, angle) * piece
}

#[cfg(test)]
mod tests {
    use super::*;
    use reading::{Attachment, AxisReading, Reading};

    /// Straight children at right angles to the bearer, on both sides, all at one place.
    fn whorl(left: usize, right: usize, first: impl Fn(usize) -> f64) -> Vec<Child> {
        (0..left + right)
            .map(|i| {
                let side = if i < left { 1.0 } else { -1.0 };
                let q = DVec2::new(0.0, side);
                Child { middle: q, pieces: vec![q], side, rise: 0.0, first: first(i) }
            })
            .collect()
    }

    fn least_angle(children: &[Child], phi: &[f64]) -> f64 {
        let d: Vec<DVec3> = children.iter().zip(phi).map(|(c, &p)| c.direction(p)).collect();
        let mut least = f64::INFINITY;
        for i in 0..d.len() {
            for j in 0..i {
                least = least.min(ops::acos_clamped(d[i].dot(d[j])));
            }
        }
        least
    }

    #[test]
    fn riesz_spreads_where_the_sum_of_angles_clumps() {
        // Three on each side: the sum of angles is as large for two opposite clumps as for an even spread.
        let children = whorl(3, 3, |i| [0.20, 0.22, 0.24, -0.20, -0.22, -0.24][i]);
        let paper = least_angle(&children, &most_entropy(&children, BranchDepth::Paper, |_, _| true));
        let riesz = least_angle(&children, &most_entropy(&children, BranchDepth::Riesz, |_, _| true));
        assert!(riesz > 2.0 * paper.max(0.05), "riesz {riesz}, paper {paper}");
        assert!(riesz > 0.45, "{riesz}");
    }

    #[test]
    fn rotations_stay_in_bounds_and_on_their_side() {
        let children = whorl(9, 2, |i| if i % 2 == 0 { 1.1 } else { -1.1 });
        for mode in [BranchDepth::Paper, BranchDepth::Riesz] {
            for (c, phi) in children.iter().zip(most_entropy(&children, mode, |_, _| true)) {
                assert!(phi.abs() <= MOST + 1e-12);
                assert!(c.direction(phi).y * c.side > 0.0);
            }
        }
    }

    #[test]
    fn plants_side_by_side_are_turned_each_by_itself() {
        let stem = |x: f64, lean: f64, source: u32| AxisReading {
            points: (0..=20).map(|i| DVec2::new(x + lean * f64::from(i), 0.01 * f64::from(i))).collect(),
            kind: AxisKind::Stem,
            bearer: None,
            half_width: vec![],
            source: Some(source),
        };
        // Tufts of four stems of 0.2, 0.5 apart.
        let tufts = |count: u32| {
            let stems = (0..4 * count).map(|k| {
                let (tuft, own) = (f64::from(k / 4), f64::from(k % 4));
                stem(0.5 * tuft + 0.01 * own, 0.002 * (own - 1.5), k)
            });
            let mut plans = Plans::new(&Reading { axes: stems.collect(), ..Reading::default() });
            branch_depths(&mut plans, BranchDepth::Riesz, Seed::new(3));
            plans
        };
        // Less the depth of their feet, which follows from the longest axis.
        let deep = |plans: &Plans, row: usize| {
            let points = &plans.rows[row].as_ref().expect("a stem").points;
            points.iter().map(|p| p.z - points[0].z).collect::<Vec<f64>>()
        };
        let (one, many) = (tufts(1), tufts(30));
        for row in 0..4 {
            let (a, b) = (deep(&one, row), deep(&many, row));
            assert!(a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12), "{row}");
        }
        assert!(deep(&one, 0).last().is_some_and(|z| z.abs() > 1e-3));
    }

    fn tree() -> Reading {
        let line = |a: DVec2, b: DVec2, bend: f64| -> Vec<DVec2> {
            (0..=40)
                .map(|i| {
                    let t = f64::from(i) / 40.0;
                    a.lerp(b, t) + (b - a).perp() * (bend * t * (1.0 - t))
                })
                .collect()
        };
        let axis = |points: Vec<DVec2>, bearer: Option<(usize, f64)>, source: u32| AxisReading {
            points,
            kind: AxisKind::Branch,
            bearer: bearer.map(|(axis, at)| Attachment { axis, at }),
            half_width: vec![],
            source: Some(source),
        };
        let p = DVec2::new;
        let mut axes = vec![axis(line(p(0.3, 0.0), p(0.3, 0.8), 0.0), None, 0)];
        for i in 0..6_u32 {
            let (h, side) = (0.25 + 0.09 * f64::from(i), if i % 2 == 0 { 1.0 } else { -1.0 });
            let end = p(0.3 + side * 0.25, h + 0.12);
            axes.push(axis(line(p(0.3, h), end, 0.2 * side), Some((0, h)), i + 1));
        }
        axes.push(axis(line(p(0.42, 0.33), p(0.5, 0.45), 0.0), Some((1, 0.14)), 7));
        Reading { axes, woody: true, ..Reading::default() }
    }

    #[test]
    fn the_projection_is_the_drawing_and_depth_is_there() {
        let reading = tree();
        for mode in [BranchDepth::Paper, BranchDepth::Riesz] {
            let flat = Plans::new(&reading);
            let mut plans = flat.clone();
            branch_depths(&mut plans, mode, Seed::new(3));
            let mut depth = 0.0_f64;
            for (a, b) in flat.rows.iter().flatten().zip(plans.rows.iter().flatten()) {
                for (p, q) in a.points.iter().zip(&b.points) {
                    assert_eq!((p.x, p.y), (q.x, q.y));
                    depth = depth.max(q.z.abs());
                }
                if let Some((on, node)) = b.bearer {
                    assert_eq!(b.points[0], plans.rows[on].as_ref().expect("there").points[node]);
                }
            }
            assert!(depth > 0.05, "{mode:?}: {depth}");
        }
    }

    #[test]
    fn one_branch_more_elsewhere_changes_no_first_guess() {
        let reading = tree();
        let plans = Plans::new(&reading);
        let mut fewer = reading.clone();
        fewer.axes.remove(6);
        fewer.axes[6].bearer = Some(Attachment { axis: 1, at: 0.14 });
        let others = Plans::new(&fewer);
        let key = |p: &Plans, source: u32| {
            p.rows.iter().flatten().find(|a| a.source == Some(source)).map(|a| a.key)
        };
        for source in [0, 1, 2, 3, 4, 5, 7] {
            assert!(key(&plans, source).is_some());
            assert_eq!(key(&plans, source), key(&others, source));
        }
    }

    #[test]
    fn light_lifts_tips_and_weight_lowers_them_and_children_stay_attached() {
        let reading = tree();
        let mut flat = Plans::new(&reading);
        branch_depths(&mut flat, BranchDepth::Riesz, Seed::new(3));
        let tip = |p: &Plans, row: usize| p.rows[row].as_ref().and_then(|a| a.points.last().copied());
        for (light, weight, up) in [(0.8, 0.0, true), (0.0, 0.9, false)] {
            let spec = SketchSpec { phototropism: light, gravity: weight, ..SketchSpec::default() };
            let mut bent = flat.clone();
            bend_by_light_and_weight(&mut bent, &spec);
            let (a, b) = (tip(&flat, 2).expect("tip"), tip(&bent, 2).expect("tip"));
            assert!(if up { b.y > a.y + 0.005 } else { b.y < a.y - 0.005 }, "{a} {b}");
            for plan in bent.rows.iter().flatten() {
                if let Some((on, node)) = plan.bearer {
                    assert_eq!(plan.points[0], bent.rows[on].as_ref().expect("there").points[node]);
                }
            }
        }
    }
}
