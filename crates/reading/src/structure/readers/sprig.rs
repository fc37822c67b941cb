//! A stem with leaves: two or more outlines with a tip, all attached to lines.

use geom::polyline_length;
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{Part, Proposal, Scene, is_leaf_from};
use crate::Kind;
use crate::blade::nearest_on_ring;
use crate::thresholds::FEWEST_PETALS;

/// Requirements of a sprig.
struct SprigLimits {
    /// Leaves cover more than this share of the enclosed area.
    whole: f64,
    /// Leaves have more than this share of the area of the largest.
    alike: f64,
    /// Its stem is at least this share of the length of the longest leaf,
    stem: f64,
    /// and the lines reach at least this share of the drawing's height below the middle of the lowest leaf.
    below: f64,
    /// Leaves begin in one place within this share of their length.
    one_place: f64,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
}

const SPRIG: SprigLimits =
    SprigLimits { whole: 0.9, alike: 0.12, stem: 0.4, below: 0.05, one_place: 0.3, likelihood: 1500.0 };

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let longest = scene.axes.iter().map(|a| polyline_length(&a.points)).fold(0.0, f64::max);
    let mut leaves: Vec<(&Face, DVec2)> =
        scene.faces.iter().filter_map(|face| Some((face, scene.root_of(face)?))).collect();
    // A leaf that touches no stem stands on the leaf below it.
    let on_leaf = |face: &Face| {
        let near = leaves.iter().flat_map(|(f, _)| &f.outline).map(|&p| nearest_on_ring(&face.outline, p));
        near.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, d)| *d < scene.touch).map(|(p, _)| p)
    };
    let free = scene.faces.iter().filter(|f| !leaves.iter().any(|(leaf, _)| core::ptr::eq(*leaf, *f)));
    let upper: Vec<(&Face, DVec2)> = free.filter_map(|face| Some((face, on_leaf(face)?))).collect();
    leaves.extend(upper);
    let area = |f: &Face| f.shape.area;
    // Slivers between leaf and stem are none.
    let large = leaves.iter().map(|(f, _)| area(f)).fold(0.0, f64::max);
    leaves.retain(|(f, _)| area(f) > SPRIG.alike * large);
    let own: f64 = leaves.iter().map(|(f, _)| area(f)).sum();
    let long = leaves.iter().map(|(f, _)| f.shape.length()).fold(0.0, f64::max);
    if leaves.len() < 2
        || own < SPRIG.whole * scene.enclosed()
        || longest < SPRIG.stem * long
        || !leaves.iter().all(|(f, root)| is_leaf_from(f, *root))
    {
        return None;
    }
    let low = scene.axes.iter().flat_map(|a| &a.points).map(|p| p.y).fold(f64::INFINITY, f64::min);
    let leaf_low = leaves.iter().map(|(f, _)| f.shape.middle.y).fold(f64::INFINITY, f64::min);
    if low > leaf_low - SPRIG.below * (scene.high.y - scene.low.y) || has_whorl(&leaves) {
        return None;
    }
    let mut parts: Vec<Part> =
        leaves.iter().map(|(face, root)| Part::from_face(face, StrokeClass::Blade, Some(*root))).collect();
    parts.extend(scene.axes.iter().map(Part::from_axis));
    parts.extend(scene.marks.iter().map(|(_, run)| Part::from_run(run, StrokeClass::Vein)));
    Some(Proposal {
        kind: Kind::Stem,
        parts,
        heads: Vec::new(),
        likelihood: SPRIG.likelihood,
        word: None,
        is_of_pieces: false,
    })
}

/// Whether some leaves begin in one place, as petals do (He and Cheng 2021, section 4.1: more than two).
fn has_whorl(leaves: &[(&Face, DVec2)]) -> bool {
    let begins_at = |p: DVec2| {
        let near = |(f, root): &&(&Face, DVec2)| root.distance(p) < SPRIG.one_place * f.shape.length();
        leaves.iter().filter(near).count()
    };
    leaves.iter().any(|(_, root)| begins_at(*root) >= FEWEST_PETALS)
}
