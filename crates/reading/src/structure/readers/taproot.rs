//! A root with its leaves (carrot, radish, turnip): a body that tapers away from the lines or leaves on it.

use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{LIMITS, Part, Proposal, Scene, upright};
use crate::Kind;
use crate::blade::nearest_on_ring;

/// Requirements of a root.
struct TaprootLimits {
    /// Its body covers more than this share of the enclosed area,
    whole: f64,
    /// has at least this convexity,
    convex: f64,
    /// and is at least this slender.
    slender: f64,
    /// Near its tip it is narrower than this share of its width near its leaves.
    taper: f64,
    /// Both places, shares of the way from the leaves to the tip.
    places: [f64; 2],
    /// At least this many lines or leaves stand on it,
    leaves: usize,
    /// within this share of its length of one another.
    together: f64,
    /// They begin this near to it, ink units.
    near: f64,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
}

const TAPROOT: TaprootLimits = TaprootLimits {
    whole: 0.6,
    convex: 0.9,
    slender: 0.6,
    taper: 0.5,
    places: [0.25, 0.85],
    leaves: 2,
    together: 0.15,
    near: 0.06,
    likelihood: 2000.0,
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let row = scene.main_face(TAPROOT.whole)?;
    let body = &scene.faces[row];
    if body.shape.convexity < TAPROOT.convex || body.shape.slenderness > TAPROOT.slender {
        return None;
    }
    let on_body = |p: DVec2| Some(nearest_on_ring(&body.outline, p)).filter(|(_, off)| *off < TAPROOT.near);
    let nearest = |points: &[DVec2]| {
        points.iter().filter_map(|&p| on_body(p)).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(p, _)| p)
    };
    let (mut parts, mut feet) = (Vec::new(), Vec::new());
    // If the tip is thin, its own outline encloses nothing.
    for line in scene.lines.iter().filter(|l| !body.strokes.contains(&l.stroke)) {
        let ends = [line.points[0], line.points[line.points.len() - 1]];
        feet.push(nearest(&ends)?);
        parts.push(Part::from_run(line, StrokeClass::Axis));
    }
    for face in (0..scene.faces.len()).filter(|k| *k != row).map(|k| &scene.faces[k]) {
        let root = nearest(&face.outline)?;
        // A tuft in one outline has a notch between each two of its leaves.
        feet.extend(core::iter::repeat_n(root, face.shape.notches.len() + 1));
        parts.push(Part::from_face(face, StrokeClass::Blade, Some(root)));
    }
    let top = feet.iter().sum::<DVec2>() / feet.len().max(1) as f64;
    let length = body.shape.length();
    let is_together = feet.iter().all(|p| p.distance(top) < TAPROOT.together * length);
    if feet.len() < TAPROOT.leaves || !is_together || !tapers_from(body, top) {
        return None;
    }
    parts.insert(0, Part::from_face(body, StrokeClass::Fruit, None));
    Some(Proposal {
        kind: Kind::Vegetable,
        parts,
        heads: Vec::new(),
        likelihood: TAPROOT.likelihood,
        word: Some("carrot"),
        is_of_pieces: false,
    })
}

/// Whether a body narrows downwards from a place on it to the point that is farthest from there.
fn tapers_from(body: &Face, top: DVec2) -> bool {
    let far = |a: &&DVec2, b: &&DVec2| a.distance_squared(top).total_cmp(&b.distance_squared(top));
    let Some(tip) = body.outline.iter().max_by(far).copied() else { return false };
    let along = (tip - top).normalize_or_zero();
    // Upright from the leaves, a level of the outline is a section across.
    let turned = upright(&body.outline, top, along);
    let [wide, narrow] =
        TAPROOT.places.map(|share| crate::contour::width_at(&turned, share * tip.distance(top)));
    tip.y < top.y - LIMITS.touch && narrow < TAPROOT.taper * wide
}
