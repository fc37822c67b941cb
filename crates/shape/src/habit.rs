//! Properties that new wood needs to match a plant: learnt from the plant itself, for the plants of every maker.
//!
//! `Draft -> thickness of tips, exponent, internodes, leaves`

use base::ops;
use glam::DVec3;
use growth::FoliageSpec;
use plant::{AxisKind, Blade, OrganKind, Paint, Shape, ShapeId};

use crate::draft::Draft;

/// The habit of a plant.
#[derive(Clone, Debug)]
pub(crate) struct Habit {
    /// Exponent t of `r^t = sum of r_i^t` (Yang et al. 2019, Eq 4).
    pub(crate) exponent: f64,
    /// Radius of a tip, metres.
    pub(crate) tip_m: f64,
    /// Base radius over length of a borne branch.
    pub(crate) slender: f64,
    /// Distance between two nodes of a shoot, metres.
    pub(crate) internode_m: f64,
    /// Angle between a branch and its bearer, degrees.
    pub(crate) angle_deg: f64,
    /// Diagonal of the box around the wood, metres.
    pub(crate) size_m: f64,
    /// Leaves on shoots, if the plant has any.
    pub(crate) leaves: Option<LeafHabit>,
}

/// Arrangement of leaves.
#[derive(Clone, Debug)]
pub(crate) struct LeafHabit {
    pub(crate) spec: FoliageSpec,
    pub(crate) blade: Blade,
    pub(crate) shape: ShapeId,
    /// Colours of the leaves.
    pub(crate) paints: Vec<Paint>,
}

/// Returns the median; `or` where there is none.
fn median(mut values: Vec<f64>, or: f64) -> f64 {
    values.retain(|v| v.is_finite());
    base::median(values).unwrap_or(or)
}

impl Habit {
    /// Learns the habit of a plant. `exponent`: the maker's, where it is known. Cost: linear in the plant.
    pub(crate) fn learn(draft: &Draft, exponent: Option<f64>) -> Self {
        let size_m = draft.size();
        let children = draft.children();
        let shoots = || draft.branches.iter().enumerate().filter(|(_, b)| b.alive && b.is_shoot());
        let is_twig = |i: usize| !children[i].iter().any(|&c| draft.branches[c].is_shoot());
        let tips = shoots().filter(|(i, _)| is_twig(*i)).filter_map(|(_, b)| b.radii.last().copied());
        let tip_m = median(tips.filter(|r| *r > 0.0).collect(), 6e-4 * size_m).max(1e-6);
        let borne = || shoots().filter(|(_, b)| b.bearer.is_some() && b.length() > 0.0);
        let slender = borne().map(|(_, b)| b.radii[0] / b.length()).collect();
        let segments = |twigs: bool| -> Vec<f64> {
            let of = shoots().filter(|(i, _)| !twigs || is_twig(*i));
            of.flat_map(|(_, b)| b.points.windows(2).map(|w| w[0].distance(w[1])))
                .filter(|l| *l > 0.0)
                .collect()
        };
        // Drawn axes are sampled densely: a piece that looks like an internode there is a dot of the pen.
        let internode = median(segments(true), 0.03 * size_m).clamp(0.012 * size_m, 0.06 * size_m);
        let angles = borne().filter_map(|(_, b)| {
            let at = b.bearer?;
            let along = draft.branches[at.branch].tangent(at.node);
            Some(ops::acos_clamped(b.direction().dot(along)) * (180.0 / ops::PI))
        });
        let angle_deg = median(angles.collect(), 50.0).clamp(20.0, 80.0);
        Self {
            exponent: exponent.unwrap_or_else(|| learnt_exponent(draft, &children, tip_m)).clamp(1.5, 4.0),
            tip_m,
            slender: median(slender, 0.012).clamp(0.002, 0.06),
            internode_m: internode,
            angle_deg,
            size_m,
            leaves: leaf_habit(draft),
        }
    }
}

/// Learns the exponent from `r = tip N^(1/t)` for a branch that feeds N tips.
fn learnt_exponent(draft: &Draft, children: &[Vec<usize>], tip_m: f64) -> f64 {
    let mut tips = vec![0_usize; draft.branches.len()];
    for b in draft.order().into_iter().rev() {
        let branch = &draft.branches[b];
        if branch.is_shoot() {
            tips[b] += 1 + children[b].iter().map(|&c| tips[c]).sum::<usize>();
        }
    }
    let of = |(i, n): (usize, &usize)| {
        let thick = draft.branches[i].radii[0] / tip_m;
        (*n >= 4 && thick > 1.05).then(|| ops::ln(*n as f64) / ops::ln(thick))
    };
    median(tips.iter().enumerate().filter_map(of).collect(), 2.4)
}

fn leaf_habit(draft: &Draft) -> Option<LeafHabit> {
    let leaves = || {
        draft.organs.iter().filter(|o| o.alive && o.what.kind == OrganKind::Leaf && o.what.flower.is_none())
    };
    let mut counts = vec![0_usize; draft.shapes.len()];
    for o in leaves() {
        *counts.get_mut(o.what.shape.index())? += 1;
    }
    // The most frequent form, the first of equals.
    let (shape, count) = counts.iter().enumerate().rev().max_by_key(|(_, n)| **n)?;
    let Shape::Blade(blade) = draft.shapes.get(shape)? else { return None };
    if *count == 0 {
        return None;
    }
    let id = ShapeId::new(shape);
    let of_shape = || leaves().filter(|o| o.what.shape == id);
    let length_m = median(of_shape().map(|o| o.what.scale * blade.length()).collect(), 0.0);
    let on_shoot = |o: &&crate::draft::Borne<_>| o.at.is_some_and(|at| draft.branches[at.branch].is_shoot());
    let (mut thickest, mut angles) = (Vec::new(), Vec::new());
    let mut leafy = vec![0_usize; draft.branches.len()];
    for o in leaves().filter(on_shoot) {
        let Some(at) = o.at else { continue };
        let branch = &draft.branches[at.branch];
        leafy[at.branch] += 1;
        thickest.push(branch.radii.get(at.node).copied().unwrap_or(0.0));
        let angle = ops::acos_clamped(o.what.frame.along.dot(branch.tangent(at.node)));
        angles.push(angle * (180.0 / ops::PI));
    }
    base::sort_numbers(&mut thickest);
    // Nine in ten leaves sit on thinner wood.
    let max_radius_m = thickest.get(thickest.len() * 9 / 10).copied().map_or(f64::INFINITY, |r| 1.2 * r);
    let bearing = draft.branches.iter().zip(&leafy).filter(|(_, n)| **n > 0);
    let run: f64 = bearing
        .flat_map(|(b, _)| b.points.windows(2).zip(&b.radii[1..]))
        .filter(|(_, r)| **r <= max_radius_m)
        .map(|(w, _)| w[0].distance(w[1]))
        .sum();
    let borne: usize = leafy.iter().sum();
    let spacing = if borne > 0 { run / borne as f64 } else { 0.7 * length_m };
    let spec = FoliageSpec {
        spacing_m: spacing.clamp(0.05 * length_m, 4.0 * length_m).clamp(1e-4, 1e3),
        length_m: length_m.clamp(1e-4, 100.0),
        angle_deg: median(angles, 55.0).clamp(10.0, 90.0),
        max_radius_m: max_radius_m.min(100.0),
        max_leaves: 200_000,
        ..FoliageSpec::default()
    };
    let paints = of_shape().map(|o| o.what.paint).collect();
    (length_m > 0.0).then(|| LeafHabit { spec, blade: blade.clone(), shape: id, paints })
}

/// Returns the kind of axis that grows on one of this kind.
pub(crate) const fn kind_on(bearer: AxisKind) -> AxisKind {
    match bearer {
        AxisKind::Stem | AxisKind::Petiole => AxisKind::Stem,
        AxisKind::Twig => AxisKind::Twig,
        AxisKind::Root => AxisKind::Root,
        _ => AxisKind::Branch,
    }
}

/// Softens a line's corners; its ends stay.
pub(crate) fn softened(line: &[DVec3], times: usize) -> Vec<DVec3> {
    let mut line = line.to_vec();
    for _ in 0..times {
        let before = line.clone();
        for (p, w) in line.iter_mut().skip(1).zip(before.windows(3)) {
            *p = (w[0] + w[1] * 2.0 + w[2]) * 0.25;
        }
    }
    line
}
