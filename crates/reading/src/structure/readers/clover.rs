//! A compound leaf whose leaflets meet in one place: clover, wood sorrel.

use glam::DVec2;
use ink::StrokeClass;

use super::{Part, Proposal, Scene};
use crate::Kind;
use crate::blade::nearest_on_ring;

/// Requirements of a clover.
struct CloverLimits {
    /// Number of leaflets.
    leaflets: core::ops::RangeInclusive<usize>,
    /// The smallest has more than this share of the area of the largest.
    alike: f64,
    /// They begin within this share of their length from one place.
    meet: f64,
    /// A leaflet is a heart if a notch lies farther from where they meet than this share of its length,
    notch: f64,
    /// in the direction of its own middle: this is the least cosine of the angle between both.
    opposite: f64,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
}

const CLOVER: CloverLimits =
    CloverLimits { leaflets: 3..=4, alike: 0.45, meet: 0.3, notch: 0.55, opposite: 0.985, likelihood: 1e7 };

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let faces = &scene.faces;
    if !CLOVER.leaflets.contains(&faces.len()) {
        return None;
    }
    let largest = faces.iter().map(|f| f.shape.area).fold(0.0, f64::max);
    let middle = faces.iter().map(|f| f.shape.middle).sum::<DVec2>() / faces.len() as f64;
    let is_leaflet = |f: &super::Face| {
        let (_, off) = nearest_on_ring(&f.outline, middle);
        let long = f.outline.iter().map(|p| p.distance(middle)).fold(0.0, f64::max);
        let along = (f.shape.middle - middle).normalize_or_zero();
        let is_opposite = |n: &DVec2| {
            n.distance(middle) > CLOVER.notch * long
                && (*n - middle).normalize_or_zero().dot(along) > CLOVER.opposite
        };
        let heart = f.shape.notches.iter().any(is_opposite);
        f.shape.area > CLOVER.alike * largest && off < CLOVER.meet * long && heart
    };
    if !faces.iter().all(is_leaflet) {
        return None;
    }
    let touches = |p: DVec2| p.distance(middle) < CLOVER.meet * largest.sqrt() + scene.touch;
    let stalks = scene.lines.iter().filter(|l| {
        touches(l.points[0])
            || touches(l.points[l.points.len() - 1])
            || (0..faces.len()).any(|k| scene.touching_end(l, k).is_some())
    });
    let mut parts: Vec<Part> = faces
        .iter()
        .map(|f| Part::from_face(f, StrokeClass::Blade, Some(nearest_on_ring(&f.outline, middle).0)))
        .collect();
    parts.extend(stalks.map(|l| Part::from_run(l, StrokeClass::Axis)));
    parts.extend(scene.marks.iter().map(|(_, run)| Part::from_run(run, StrokeClass::Vein)));
    Some(Proposal {
        kind: Kind::Leaf,
        parts,
        heads: Vec::new(),
        likelihood: CLOVER.likelihood,
        word: None,
        is_of_pieces: true,
    })
}
