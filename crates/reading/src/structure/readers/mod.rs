//! Readers: each says of a drawing what plant it is by its faces and lines, or nothing.
//!
//! `Scene -> Proposal`: the parts of the plant, cut from the strokes as they are needed. A reader never looks at the kind that
//! the drawing resembles; it says what it sees only where the arrangement leaves little doubt.

mod bloom;
mod clover;
mod conifer;
mod cup;
mod leaf;
mod lobed;
mod sprig;
#[cfg(test)]
mod tests;

use base::LiteMap;
use geom::{bounds, polyline_length};
use glam::DVec2;
use ink::{Ink, StrokeClass, StrokeMode};

use super::faces::{Face, Faces, Place, Run};
use crate::Kind;
use crate::blade::nearest_on_ring;
use crate::thresholds::STRAIGHT;

/// The source of a class that follows from the arrangement of faces and lines.
pub const ARRANGEMENT: &str = "arrangement";

/// One part of a plant.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) points: Vec<DVec2>,
    pub(crate) class: StrokeClass,
    /// Where it is attached, if that is known.
    pub(crate) root: Option<DVec2>,
    /// Rows of the strokes that it is made of, the first most of it.
    pub(crate) strokes: Vec<usize>,
}

/// A plant that a reader sees.
#[derive(Clone, Debug)]
pub(crate) struct Proposal {
    pub(crate) kind: Kind,
    pub(crate) parts: Vec<Part>,
    /// Flowers: rows of the parts that are petals of one.
    pub(crate) heads: Vec<Vec<usize>>,
    /// How many times as often this arrangement is found in drawings of the kind as in others (a likelihood ratio): the readers'
    /// judgement, to be weighed with how likely the kind is otherwise.
    pub(crate) likelihood: f64,
}

/// What touches and what is small, for all readers. Lengths are in ink units (the drawing's diagonal is 1).
pub(crate) struct ReaderLimits {
    /// A line that ends nearer than this to an outline touches it.
    pub(crate) touch: f64,
    /// A drawing of more strokes is no icon, and no single leaf.
    pub(crate) most_strokes: usize,
    /// Faces below this share of the area of all are dirt, or shade.
    pub(crate) speck: f64,
    /// A leaf is at least so convex (area over that of the hull), and between so slender and so wide (width over length).
    pub(crate) leaf_convex: f64,
    pub(crate) leaf_slender: [f64; 2],
}

pub(crate) const LIMITS: ReaderLimits = ReaderLimits {
    touch: 0.035,
    most_strokes: 80,
    speck: 0.01,
    leaf_convex: 0.84,
    leaf_slender: [0.12, 0.86],
};

/// What the readers look at.
pub(crate) struct Scene {
    all: Faces,
    /// Faces that are no specks.
    pub(crate) faces: Vec<Face>,
    /// Lines outside all faces.
    pub(crate) lines: Vec<Run>,
    /// Lines within a face: its row among `faces`.
    pub(crate) marks: Vec<(usize, Run)>,
    /// Strokes that lead from one end to the other without a detour.
    pub(crate) straight: LiteMap<usize, Vec<DVec2>>,
    pub(crate) low: DVec2,
    pub(crate) high: DVec2,
}

impl Scene {
    /// `None` for drawings of too many strokes or with contours, and where nothing is enclosed.
    pub(crate) fn new(ink: &Ink) -> Option<Self> {
        // Contours that are to be filled say themselves what they are.
        let is_part = |s: &ink::InkStroke| s.mode == StrokeMode::Parts;
        if ink.strokes.is_empty()
            || ink.strokes.len() > LIMITS.most_strokes
            || !ink.strokes.iter().all(is_part)
        {
            return None;
        }
        let all = Faces::new(ink)?;
        let (faces, runs) = (all.faces.clone(), all.runs.clone());
        let area: f64 = faces.iter().map(|f| f.shape.area).sum();
        let mut rows = Vec::with_capacity(faces.len());
        let mut kept = Vec::new();
        for face in faces {
            let large = face.shape.area > LIMITS.speck * area;
            rows.push(large.then_some(kept.len()));
            if large {
                kept.push(face);
            }
        }
        let boxes = ink.strokes.iter().filter_map(|s| bounds(&s.points));
        let (low, high) = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let mut scene = Self {
            all,
            faces: kept,
            lines: Vec::new(),
            marks: Vec::new(),
            straight: LiteMap::new(),
            low,
            high,
        };
        for (k, stroke) in ink.strokes.iter().enumerate() {
            let (a, b) = (stroke.points[0], stroke.points[stroke.points.len() - 1]);
            if a.distance(b) > STRAIGHT * stroke.length {
                scene.straight.insert(k, stroke.points.clone());
            }
        }
        for run in runs {
            match run.place {
                Place::Outside => scene.lines.push(run),
                Place::Within(face) => {
                    if let Some(face) = rows[face] {
                        scene.marks.push((face, run));
                    }
                }
                Place::Between => {}
            }
        }
        (!scene.faces.is_empty()).then_some(scene)
    }

    /// The end of a line that touches a face, if one does.
    pub(crate) fn touching_end(&self, line: &Run, face: usize) -> Option<DVec2> {
        let ends = [line.points[0], line.points[line.points.len() - 1]];
        let off = |p: DVec2| nearest_on_ring(&self.faces[face].outline, p).1;
        ends.into_iter().filter(|&p| off(p) < LIMITS.touch).min_by(|a, b| off(*a).total_cmp(&off(*b)))
    }

    /// Several faces as one, if they hang together.
    pub(crate) fn union(&self, faces: &[&Face]) -> Option<Face> {
        self.all.union(faces)
    }

    /// Lines within a face.
    pub(crate) fn marks_of(&self, face: usize) -> impl Iterator<Item = &Run> {
        self.marks.iter().filter(move |(f, _)| *f == face).map(|(_, run)| run)
    }
}

impl Part {
    pub(crate) fn of_run(run: &Run, class: StrokeClass) -> Self {
        Self { points: run.points.clone(), class, root: None, strokes: vec![run.stroke] }
    }

    pub(crate) fn of_face(face: &Face, class: StrokeClass, root: Option<DVec2>) -> Self {
        let mut points = face.outline.clone();
        points.extend(face.outline.first());
        Self { points, class, root, strokes: face.strokes.clone() }
    }
}

/// Whether an outline has the form of a leaf, seen from where it is attached: convex and longish, with its tip far out.
pub(crate) fn is_leaf_from(face: &Face, root: DVec2) -> bool {
    let shape = &face.shape;
    let far = face.outline.iter().map(|p| p.distance(root)).fold(0.0, f64::max);
    shape.convexity > LIMITS.leaf_convex
        && (LIMITS.leaf_slender[0]..LIMITS.leaf_slender[1]).contains(&shape.slenderness)
        && shape.tip_from(root).is_some_and(|tip| tip.distance(root) > TIP * far)
}

/// The tip of a leaf lies farther from its root than this share of the farthest point.
const TIP: f64 = 0.88;

/// What the readers propose for a drawing, the surest first.
pub(crate) fn propose(ink: &Ink) -> Vec<Proposal> {
    let Some(scene) = Scene::new(ink) else { return Vec::new() };
    let readers = [
        leaf::propose,
        clover::propose,
        lobed::propose,
        bloom::propose,
        cup::propose,
        sprig::propose,
        conifer::propose,
    ];
    let mut found: Vec<Proposal> = readers.iter().filter_map(|reader| reader(&scene)).collect();
    base::sort_by(&mut found, |a, b| b.likelihood.total_cmp(&a.likelihood));
    found
}

/// The widest angle between neighbouring directions, radians.
pub(crate) fn widest_gap(ways: impl Iterator<Item = DVec2>) -> f64 {
    let mut angles: Vec<f64> = ways.map(|d| base::ops::atan2(d.y, d.x)).collect();
    base::sort_by(&mut angles, f64::total_cmp);
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return base::ops::TAU };
    let seam = first + base::ops::TAU - last;
    angles.windows(2).map(|w| w[1] - w[0]).fold(seam, f64::max)
}

/// How long all these lines are.
pub(crate) fn length_of<'a>(lines: impl Iterator<Item = &'a Run>) -> f64 {
    lines.map(|l| polyline_length(&l.points)).sum()
}
