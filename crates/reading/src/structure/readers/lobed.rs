//! One lobed leaf: lobes that spread like fingers from the base, where its petiole is attached (hemp), or a blade with
//! pointed lobes that is widest in its middle (maple): tiers of a conifer are widest at its foot.

use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{Part, Proposal, Scene, length_of, upright, widest};
use crate::Kind;
use crate::blade::nearest_on_ring;
use crate::contour::runs_at;

/// Requirements of a palmately lobed leaf.
struct LobedLimits {
    /// It covers more than this share of the enclosed area.
    whole: f64,
    /// A tip lies farther from the base than this share of its length.
    out: f64,
    /// Fewest tips.
    tips: usize,
    /// Fewest notches between the tips.
    notches: usize,
    /// It is deeply cut: its area over that of its hull is below this.
    convexity: f64,
    /// Notches lie nearer to the base than this share of the distance of the tips, on average.
    cut: f64,
    /// Fewest notches of a blade with pointed lobes.
    few_notches: usize,
    /// Greatest convexity of a blade with pointed lobes.
    pointed_convexity: f64,
    /// A blade with pointed lobes is widest between these shares of the way from its base to its far end.
    widest: core::ops::Range<f64>,
    /// Levels at which its width is measured.
    levels: usize,
    /// Its petiole, or its midrib, ends nearer than this to its outline, ink units.
    attached: f64,
    /// Its petiole is at most this share of its length.
    petiole: f64,
    /// The petiole of a blade with pointed lobes is one line of at most this share: a trunk is longer or has two sides.
    short_petiole: f64,
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
    few_notches: 2,
    pointed_convexity: 0.86,
    widest: 0.3..0.8,
    levels: 16,
    attached: 0.08,
    petiole: 1.0,
    short_petiole: 0.45,
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
    let is_fingered = notches.len() >= LOBED.notches
        && shape.convexity <= LOBED.convexity
        && mean(&notches) <= LOBED.cut * mean(&tips);
    let is_pointed = || {
        scene.lines.len() <= 1
            && length_of(scene.lines.iter()) < LOBED.short_petiole * length
            && notches.len() >= LOBED.few_notches
            && shape.convexity <= LOBED.pointed_convexity
            && widest_level(face, root).is_some_and(|level| LOBED.widest.contains(&level))
    };
    if tips.len() < LOBED.tips
        || length_of(scene.lines.iter()) > LOBED.petiole * length
        || !(is_fingered || is_pointed())
    {
        return None;
    }
    let mut parts = vec![Part::from_face(face, StrokeClass::Blade, Some(root))];
    parts.extend(scene.marks_of(row).map(|m| Part::from_run(m, StrokeClass::Vein)));
    parts.extend(scene.lines.iter().map(|l| Part::from_run(l, StrokeClass::Axis)));
    Some(Proposal {
        kind: Kind::Leaf,
        parts,
        heads: Vec::new(),
        likelihood: LOBED.likelihood,
        word: None,
        is_of_pieces: true,
    })
}

/// Returns where a blade is widest, as a share of the way from its base to its far end.
fn widest_level(face: &Face, root: DVec2) -> Option<f64> {
    let along = (face.shape.middle - root).try_normalize()?;
    let turned = upright(&face.outline, root, along);
    let (low, high) = geom::bounds(&turned)?;
    // A notched blade has several runs at a level.
    let width = |share: f64| {
        let runs = runs_at(&turned, low.y + share * (high.y - low.y));
        runs.first().zip(runs.last()).map_or(0.0, |(first, last)| last.1 - first.0)
    };
    widest(LOBED.levels, width).map(|(_, share)| share)
}
