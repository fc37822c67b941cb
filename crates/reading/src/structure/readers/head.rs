//! A flower whose petals cannot be told apart (rose, peony, poppy): one closed head on a stem that bears leaves below it.

use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{Axis, LIMITS, Part, Proposal, Scene};
use crate::Kind;
use crate::blade::nearest_on_ring;

/// What a flower head must have.
struct HeadLimits {
    /// It is at least so convex,
    convex: f64,
    /// and at least so round (width over length).
    round: f64,
    /// It is at least so high and wide, ink units.
    size: f64,
    /// Its stem goes on below it by more than this share of its height.
    stem: f64,
    /// The stem is attached below this height, a share of the head's.
    base: f64,
    /// Petals within it have more than the first and less than the second share of its area.
    petal: [f64; 2],
    /// The largest leaf is smaller than this share of the head: an ear ends in a grain like the others.
    leaf: f64,
    /// What is neither head nor leaf covers less than this share of all that is enclosed.
    other: f64,
    /// See [`Proposal::likelihood`], of a head with lines or faces in it, and of an empty one.
    likelihood: [f64; 2],
}

const HEAD: HeadLimits = HeadLimits {
    convex: 0.85,
    round: 0.6,
    size: 0.2,
    stem: 0.3,
    base: 0.35,
    petal: [0.04, 0.9],
    leaf: 0.6,
    other: 0.1,
    likelihood: [3000.0, 300.0],
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let (mut members, head) = scene.highest_group()?;
    let is_within = |k: &usize| geom::contains(&head.outline, scene.faces[*k].shape.middle);
    let inner: Vec<usize> =
        (0..scene.faces.len()).filter(|k| !members.contains(k)).filter(is_within).collect();
    members.extend(inner);
    let (low, high) = geom::bounds(&head.outline)?;
    let size = high - low;
    if head.shape.convexity < HEAD.convex
        || head.shape.slenderness < HEAD.round
        || size.min_element() < HEAD.size
    {
        return None;
    }
    let goes_below = |axis: &&Axis| axis.points.iter().any(|p| p.y < low.y - HEAD.stem * size.y);
    // A trunk has two sides.
    let below: Vec<&Axis> = scene.axes.iter().filter(goes_below).collect();
    let [stem] = below[..] else { return None };
    let on_head = |p: DVec2| Some(nearest_on_ring(&head.outline, p)).filter(|(_, d)| *d < LIMITS.touch);
    let (base, _) = stem.ends().into_iter().find_map(on_head)?;
    if base.y > low.y + HEAD.base * size.y {
        return None;
    }
    let beside = || (0..scene.faces.len()).filter(|k| !members.contains(k));
    let leaves = scene.leaves_among(beside(), HEAD.other)?;
    let largest = beside().map(|k| scene.faces[k].shape.area).fold(0.0, f64::max);
    if leaves.is_empty() || largest > HEAD.leaf * head.shape.area {
        return None;
    }
    let petals = petals(scene, &members, &head, base);
    let heads = vec![(0..petals.len()).collect()];
    let is_marked = petals.len() > 1 || scene.marks.iter().any(|(face, _)| members.contains(face));
    let mut parts = petals;
    parts.extend(leaves);
    parts.extend(scene.axes.iter().map(Part::of_axis));
    let likelihood = HEAD.likelihood[usize::from(!is_marked)];
    Some(Proposal { kind: Kind::Flower, parts, heads, likelihood, word: None })
}

/// The head as a whole, and before it the petals that are seen in it.
fn petals(scene: &Scene, members: &[usize], head: &Face, base: DVec2) -> Vec<Part> {
    let [least, most] = HEAD.petal.map(|share| share * head.shape.area);
    let is_petal = |f: &&Face| f.shape.area > least && f.shape.area < most;
    let inner = members.iter().map(|&k| &scene.faces[k]).filter(is_petal);
    let root = |f: &Face| Some(nearest_on_ring(&f.outline, base).0);
    core::iter::once(Part::of_face(head, StrokeClass::Blade, Some(base)))
        .chain(inner.map(|f| Part::of_face(f, StrokeClass::Blade, root(f))))
        .collect()
}
