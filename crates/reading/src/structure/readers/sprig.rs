//! A stem with leaves: two or more outlines with a tip, all attached to lines.

use geom::{distance_to_polyline, polyline_length};
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{LIMITS, Part, Proposal, Scene, is_leaf_from};
use crate::Kind;
use crate::blade::nearest_on_ring;
use crate::thresholds::FEWEST_PETALS;

/// What a sprig must have.
struct SprigLimits {
    /// Leaves cover more than this share of all that is enclosed.
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
    let lines: Vec<(usize, Vec<DVec2>)> = axes(scene);
    let longest = lines.iter().map(|(_, l)| polyline_length(l)).fold(0.0, f64::max);
    let mut leaves: Vec<(&Face, DVec2)> =
        scene.faces.iter().filter_map(|face| Some((face, root_of(scene, face, &lines)?))).collect();
    // A leaf that touches no stem stands on the leaf below it.
    let on_leaf = |face: &Face| {
        let near = leaves.iter().flat_map(|(f, _)| &f.outline).map(|&p| nearest_on_ring(&face.outline, p));
        near.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, d)| *d < LIMITS.touch).map(|(p, _)| p)
    };
    let free = scene.faces.iter().filter(|f| !leaves.iter().any(|(leaf, _)| core::ptr::eq(*leaf, *f)));
    let upper: Vec<(&Face, DVec2)> = free.filter_map(|face| Some((face, on_leaf(face)?))).collect();
    leaves.extend(upper);
    let area = |f: &Face| f.shape.area;
    // Slivers between leaf and stem are none.
    let large = leaves.iter().map(|(f, _)| area(f)).fold(0.0, f64::max);
    leaves.retain(|(f, _)| area(f) > SPRIG.alike * large);
    let total: f64 = scene.faces.iter().map(area).sum();
    let own: f64 = leaves.iter().map(|(f, _)| area(f)).sum();
    let long = leaves.iter().map(|(f, _)| f.shape.length()).fold(0.0, f64::max);
    if leaves.len() < 2
        || own < SPRIG.whole * total
        || longest < SPRIG.stem * long
        || !leaves.iter().all(|(f, root)| is_leaf_from(f, *root))
    {
        return None;
    }
    let low = lines.iter().flat_map(|(_, l)| l).map(|p| p.y).fold(f64::INFINITY, f64::min);
    let leaf_low = leaves.iter().map(|(f, _)| f.shape.middle.y).fold(f64::INFINITY, f64::min);
    if low > leaf_low - SPRIG.below * (scene.high.y - scene.low.y) || has_whorl(&leaves) {
        return None;
    }
    let mut parts: Vec<Part> =
        leaves.iter().map(|(face, root)| Part::of_face(face, StrokeClass::Blade, Some(*root))).collect();
    parts.extend(lines.into_iter().map(|(stroke, points)| Part {
        points,
        class: StrokeClass::Axis,
        root: None,
        strokes: vec![stroke],
    }));
    parts.extend(scene.marks.iter().map(|(_, run)| Part::of_run(run, StrokeClass::Vein)));
    Some(Proposal { kind: Kind::Stem, parts, heads: Vec::new(), likelihood: SPRIG.likelihood })
}

/// The lines that are stems: open strokes that run outside of the leaves for a part of their way, whole; of other strokes what
/// runs outside.
pub(super) fn axes(scene: &Scene) -> Vec<(usize, Vec<DVec2>)> {
    let mut found: Vec<(usize, Vec<DVec2>)> = Vec::new();
    for run in &scene.lines {
        if let Some(line) = scene.straight.get(&run.stroke) {
            if !found.iter().any(|(stroke, _)| *stroke == run.stroke) {
                found.push((run.stroke, line.clone()));
            }
            continue;
        }
        let next_to = |line: &[DVec2]| line.last().is_some_and(|p| p.distance(run.points[0]) < LIMITS.touch);
        match found.last_mut() {
            Some((stroke, line)) if *stroke == run.stroke && next_to(line) => line.extend(&run.points),
            _ => found.push((run.stroke, run.points.clone())),
        }
    }
    found
}

/// Where a leaf is attached: its point nearest to a stem, or to a stem's end.
pub(super) fn root_of(scene: &Scene, face: &Face, lines: &[(usize, Vec<DVec2>)]) -> Option<DVec2> {
    // A stem that ends at the leaf, or else one that passes it.
    let ends = lines.iter().flat_map(|(_, l)| [l[0], l[l.len() - 1]]);
    let end = ends
        .map(|p| nearest_on_ring(&face.outline, p))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|(_, d)| *d < LIMITS.touch);
    let along = || {
        let off = |p: DVec2| {
            lines.iter().filter_map(|(_, l)| distance_to_polyline(l, p)).fold(f64::INFINITY, f64::min)
        };
        let nearest = face.outline.iter().map(|&p| (p, off(p))).min_by(|a, b| a.1.total_cmp(&b.1))?;
        (nearest.1 < LIMITS.touch).then_some(nearest)
    };
    let marked = || {
        let row = scene.faces.iter().position(|f| core::ptr::eq(f, face))?;
        let ends = scene.marks_of(row).flat_map(|m| [m.points[0], m.points[m.points.len() - 1]]);
        ends.map(|p| nearest_on_ring(&face.outline, p)).min_by(|a, b| a.1.total_cmp(&b.1))
    };
    end.or_else(along).or_else(marked).map(|(p, _)| p)
}

/// Whether some leaves begin in one place, as petals do (He and Cheng 2021, section 4.1: more than two).
fn has_whorl(leaves: &[(&Face, DVec2)]) -> bool {
    let begins_at = |p: DVec2| {
        let near = |(f, root): &&(&Face, DVec2)| root.distance(p) < SPRIG.one_place * f.shape.length();
        leaves.iter().filter(near).count()
    };
    leaves.iter().any(|(_, root)| begins_at(*root) >= FEWEST_PETALS)
}
