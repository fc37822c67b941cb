//! A palm: fronds that spread from the top of a trunk that was drawn by both its sides.

use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{Axis, LIMITS, Part, Proposal, Scene, widest_gap};
use crate::Kind;
use crate::blade::{LENS, lens, nearest_on_ring};

/// Requirements of a palm. Shares of the height of the drawing, if not stated otherwise.
struct PalmLimits {
    /// Fewest fronds.
    fronds: usize,
    /// Least height of a trunk.
    high: f64,
    /// A trunk begins below this height.
    foot: f64,
    /// A trunk that is a face is more slender than this (width over length).
    slender: f64,
    /// The sides of a trunk are nearer to one another than this share of its height, at the foot and at the top.
    apart: f64,
    /// A frond begins this near to the top of the trunk, a share of its own length.
    near: f64,
    /// Its farthest point from there is farther than this share of its length: it begins with its end, not with its
    /// side.
    end_on: f64,
    /// A frond that is a face is more slender than this,
    narrow: f64,
    /// and has at least this convexity.
    convex: f64,
    /// A frond that is a line bends in one direction: the outline of its hull equals its length and chord within this
    /// share.
    one_way: f64,
    /// Fronds leave no angle wider than this free, radians: half a circle and the part that the trunk takes.
    gap: f64,
    /// Faces that are neither trunk nor frond cover less than this share of the enclosed area.
    other: f64,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
}

const PALM: PalmLimits = PalmLimits {
    fronds: 3,
    high: 0.35,
    foot: 0.3,
    slender: 0.42,
    apart: 0.25,
    near: 0.4,
    end_on: 0.75,
    narrow: 0.75,
    convex: 0.6,
    one_way: 0.92,
    gap: 4.3,
    other: 0.15,
    likelihood: 3000.0,
};

/// A trunk that was found.
struct Trunk {
    top: DVec2,
    /// Half its width there.
    half_width: f64,
    parts: Vec<Part>,
    /// Row of the face that it is.
    face: Option<usize>,
    /// Rows of the axes that it is.
    sides: Vec<usize>,
}

impl Trunk {
    /// Whether a frond of this length begins at its top; `off`: its distance from the middle of the top.
    fn bears(&self, off: f64, length: f64) -> bool {
        off - self.half_width < (PALM.near * length).max(LIMITS.touch)
    }
}

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let trunk = trunk_of_face(scene).or_else(|| trunk_of_sides(scene))?;
    let (mut parts, mut ways, mut other) = (Vec::new(), Vec::new(), 0.0);
    for face in (0..scene.faces.len()).filter(|k| Some(*k) != trunk.face).map(|k| &scene.faces[k]) {
        match frond_root(face, &trunk) {
            Some(root) => {
                ways.push(face.shape.middle - trunk.top);
                parts.push(Part::from_face(face, StrokeClass::Blade, Some(root)));
            }
            None => other += face.shape.area,
        }
    }
    for axis in (0..scene.axes.len()).filter(|k| !trunk.sides.contains(k)).map(|k| &scene.axes[k]) {
        if let Some(frond) = frond_of_line(axis, &trunk) {
            ways.extend(frond.points.get(frond.points.len() / 2).map(|p| *p - trunk.top));
            parts.push(frond);
        }
    }
    if ways.len() < PALM.fronds
        || other > PALM.other * scene.enclosed()
        || widest_gap(ways.iter().copied()) > PALM.gap
        || !(ways.iter().any(|w| w.x > 0.0) && ways.iter().any(|w| w.x < 0.0))
    {
        return None;
    }
    parts.extend(trunk.parts);
    parts.extend(scene.marks.iter().map(|(_, run)| Part::from_run(run, StrokeClass::Vein)));
    Some(Proposal {
        kind: Kind::Palm,
        parts,
        heads: Vec::new(),
        likelihood: PALM.likelihood,
        word: None,
        is_of_pieces: false,
    })
}

/// Finds a trunk: a narrow face that stands on the ground.
fn trunk_of_face(scene: &Scene) -> Option<Trunk> {
    let height = scene.high.y - scene.low.y;
    let stands = |face: &Face| {
        geom::bounds(&face.outline).is_some_and(|(low, high)| {
            high.y - low.y > PALM.high * height && low.y < scene.low.y + PALM.foot * height
        })
    };
    let face = scene.faces.iter().position(|f| f.shape.slenderness < PALM.slender && stands(f))?;
    let shape = &scene.faces[face].shape;
    let top = if shape.ends[0].y > shape.ends[1].y { shape.ends[0] } else { shape.ends[1] };
    let half_width = 0.5 * shape.area / shape.length();
    let part = Part::from_face(&scene.faces[face], StrokeClass::TrunkOutline, None);
    Some(Trunk { top, half_width, parts: vec![part], face: Some(face), sides: Vec::new() })
}

/// Finds a trunk: two lines that rise side by side.
fn trunk_of_sides(scene: &Scene) -> Option<Trunk> {
    let height = scene.high.y - scene.low.y;
    let upright = |axis: &Axis| {
        let [foot, top] = axis.foot_and_top();
        let rises = top.y - foot.y > PALM.high * height && foot.y < scene.low.y + PALM.foot * height;
        rises.then_some((foot, top))
    };
    let sides: Vec<(usize, DVec2, DVec2)> = (0..scene.axes.len())
        .filter_map(|k| upright(&scene.axes[k]).map(|(foot, top)| (k, foot, top)))
        .collect();
    let [(a, left, one), (b, right, other)] = sides[..] else { return None };
    let apart = PALM.apart * (one.midpoint(other).y - left.midpoint(right).y);
    if left.distance(right) > apart || one.distance(other) > apart {
        return None;
    }
    let parts = [a, b].map(|k| Part { class: StrokeClass::TrunkOutline, ..Part::from_axis(&scene.axes[k]) });
    let half_width = 0.5 * one.distance(other);
    Some(Trunk { top: one.midpoint(other), half_width, parts: parts.into(), face: None, sides: vec![a, b] })
}

/// Returns where a face begins at the top of the trunk, if it is a frond.
fn frond_root(face: &Face, trunk: &Trunk) -> Option<DVec2> {
    let (root, off) = nearest_on_ring(&face.outline, trunk.top);
    let length = face.shape.length();
    let far = face.outline.iter().map(|p| p.distance(root)).fold(0.0, f64::max);
    (face.shape.slenderness < PALM.narrow
        && face.shape.convexity > PALM.convex
        && trunk.bears(off, length)
        && far > PALM.end_on * length)
        .then_some(root)
}

/// Returns a frond that was drawn as one line, if it begins at the top of the trunk.
fn frond_of_line(axis: &Axis, trunk: &Trunk) -> Option<Part> {
    let mut line = axis.points.clone();
    if axis.ends()[1].distance(trunk.top) < axis.ends()[0].distance(trunk.top) {
        line.reverse();
    }
    let length = geom::polyline_length(&line);
    // The length of a line that bends in one direction is that of its hull's outline, less its chord.
    let chord = axis.ends()[0].distance(axis.ends()[1]);
    if geom::perimeter(&geom::convex_hull(&line)) < PALM.one_way * (length + chord) {
        return None;
    }
    let points = lens(&line, LENS * length).filter(|_| trunk.bears(line[0].distance(trunk.top), length))?;
    Some(Part { points, class: StrokeClass::Blade, root: Some(line[0]), strokes: vec![axis.stroke] })
}
