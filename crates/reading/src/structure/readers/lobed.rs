//! One lobed leaf: lobes that spread like fingers from where its petiole is attached (maple, hemp).

use ink::StrokeClass;

use super::{Part, Proposal, Scene, length_of};
use crate::Kind;
use crate::blade::nearest_on_ring;

/// What a palmately lobed leaf must have.
struct LobedLimits {
    /// It covers more than this share of all that is enclosed.
    whole: f64,
    /// A tip lies farther from the base than this share of its length.
    out: f64,
    /// How many tips, and how many notches between them at least.
    tips: usize,
    notches: usize,
    /// It is deeply cut: its area over that of its hull is below this.
    convexity: f64,
    /// Notches lie nearer to the base than this share of the distance of the tips, on average.
    cut: f64,
    /// Its petiole, or its midrib, ends nearer than this to its outline, ink units.
    attached: f64,
    /// Its petiole is at most this share of its length.
    petiole: f64,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
}

const LOBED: LobedLimits = LobedLimits {
    whole: 0.9,
    out: 0.2,
    tips: 5,
    notches: 4,
    convexity: 0.72,
    cut: 0.72,
    attached: 0.08,
    petiole: 1.0,
    likelihood: 4000.0,
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let row = scene.main_face(LOBED.whole)?;
    let face = &scene.faces[row];
    let shape = &face.shape;
    let ends = scene
        .lines
        .iter()
        .chain(scene.marks_of(row))
        .flat_map(|l| [l.points[0], l.points[l.points.len() - 1]]);
    let nearest = ends.map(|p| nearest_on_ring(&face.outline, p)).min_by(|a, b| a.1.total_cmp(&b.1));
    let (root, _) = nearest.filter(|(_, off)| *off < LOBED.attached)?;
    let length = shape.length();
    let tips: Vec<f64> =
        shape.corners.iter().map(|p| p.distance(root)).filter(|d| *d > LOBED.out * length).collect();
    let notches: Vec<f64> = shape.notches.iter().map(|p| p.distance(root)).collect();
    let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len().max(1) as f64;
    if tips.len() < LOBED.tips
        || notches.len() < LOBED.notches
        || shape.convexity > LOBED.convexity
        || mean(&notches) > LOBED.cut * mean(&tips)
        || length_of(scene.lines.iter()) > LOBED.petiole * length
    {
        return None;
    }
    let mut parts = vec![Part::of_face(face, StrokeClass::Blade, Some(root))];
    parts.extend(scene.marks_of(row).map(|m| Part::of_run(m, StrokeClass::Vein)));
    parts.extend(scene.lines.iter().map(|l| Part::of_run(l, StrokeClass::Axis)));
    Some(Proposal { kind: Kind::Leaf, parts, heads: Vec::new(), likelihood: LOBED.likelihood, word: None })
}
