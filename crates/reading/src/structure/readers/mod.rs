//! Readers: each says of a drawing what plant it is by its faces and lines, or nothing.
//!
//! `Scene -> Proposal`: the parts of the plant, cut from the strokes as they are needed. A reader never looks at the kind that
//! the drawing resembles; it says what it sees only where the arrangement leaves little doubt.

mod bloom;
mod clover;
mod conifer;
mod cup;
mod head;
mod leaf;
mod lobed;
mod mushroom;
mod palm;
mod sprig;
mod taproot;
#[cfg(test)]
mod tests;

use geom::{bounds, distance_to_polyline, polyline_length};
use glam::DVec2;
use ink::{Ink, StrokeClass, StrokeMode};

use super::faces::{Face, Faces, Picture, Place, Run};
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
    /// What a plant of the kind is called that has this arrangement, if only one has: a word of [`crate::glance::WORDS`].
    pub(crate) word: Option<&'static str>,
}

/// What touches and what is small, for all readers. Lengths are in ink units (the drawing's diagonal is 1).
pub(crate) struct ReaderLimits {
    /// A line that ends nearer than this to an outline touches it.
    pub(crate) touch: f64,
    /// Faces nearer to one another than this hang together.
    pub(crate) adjoining: f64,
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
    adjoining: 0.0105,
    most_strokes: 80,
    speck: 0.01,
    leaf_convex: 0.84,
    leaf_slender: [0.12, 0.86],
};

/// A line that may be a stem.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    pub(crate) stroke: usize,
    pub(crate) points: Vec<DVec2>,
}

impl Axis {
    /// Where it begins and where it ends.
    pub(crate) fn ends(&self) -> [DVec2; 2] {
        [self.points[0], self.points[self.points.len() - 1]]
    }
}

/// What the readers look at.
pub(crate) struct Scene {
    picture: Picture,
    /// Faces that are no specks.
    pub(crate) faces: Vec<Face>,
    /// Lines outside all faces.
    pub(crate) lines: Vec<Run>,
    /// Lines within a face: its row among `faces`.
    pub(crate) marks: Vec<(usize, Run)>,
    /// Lines that may be stems: strokes that lead from one end to the other without a detour and run outside of the faces for a
    /// part of their way, whole; of other strokes what runs outside.
    pub(crate) axes: Vec<Axis>,
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
        let Faces { faces, runs, picture } = Faces::new(ink)?;
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
        let (mut lines, mut marks) = (Vec::new(), Vec::new());
        for run in runs {
            match run.place {
                Place::Outside => lines.push(run),
                Place::Within(face) => marks.extend(rows[face].map(|face| (face, run))),
                Place::Between => {}
            }
        }
        let axes = axes(ink, &lines);
        (!kept.is_empty()).then_some(Self { picture, faces: kept, lines, marks, axes, low, high })
    }

    /// The end of a line that touches a face, if one does.
    pub(crate) fn touching_end(&self, line: &Run, face: usize) -> Option<DVec2> {
        let ends = [line.points[0], line.points[line.points.len() - 1]];
        let off = |p: DVec2| nearest_on_ring(&self.faces[face].outline, p).1;
        ends.into_iter().filter(|&p| off(p) < LIMITS.touch).min_by(|a, b| off(*a).total_cmp(&off(*b)))
    }

    /// The area of all faces together.
    pub(crate) fn enclosed(&self) -> f64 {
        self.faces.iter().map(|f| f.shape.area).sum()
    }

    /// The row of the face that covers more than a share of all that is enclosed. `share`: at least 0.5, so that there is one at
    /// most.
    pub(crate) fn main_face(&self, share: f64) -> Option<usize> {
        let least = share * self.enclosed();
        self.faces.iter().position(|f| f.shape.area > least)
    }

    /// Several faces as one, if they hang together.
    pub(crate) fn union(&self, faces: &[&Face]) -> Option<Face> {
        self.picture.union(faces)
    }

    /// The corner of a leaf that lies on a stem, the one nearest to the foot of the stem: the side of a leaf may touch it, too, and
    /// the tip of a grain in an ear.
    fn corner_on_stem(&self, face: &Face) -> Option<DVec2> {
        let corner_on = |axis: &Axis| {
            let foot = axis.ends().into_iter().min_by(|p, q| p.y.total_cmp(&q.y))?;
            let is_on =
                |p: &&DVec2| distance_to_polyline(&axis.points, **p).is_some_and(|d| d < LIMITS.touch);
            let corners = face.shape.corners.iter().filter(is_on);
            corners.min_by(|a, b| a.distance(foot).total_cmp(&b.distance(foot))).copied()
        };
        self.axes.iter().find_map(corner_on)
    }

    /// Where a leaf is attached: its point nearest to a stem's end, or to a stem that passes it, or to the end of its vein.
    pub(crate) fn root_of(&self, face: &Face) -> Option<DVec2> {
        let nearest = |p: DVec2| nearest_on_ring(&face.outline, p);
        let end = self
            .axes
            .iter()
            .flat_map(Axis::ends)
            .map(nearest)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|(_, d)| *d < LIMITS.touch);
        let along = || {
            let off = |p: DVec2| {
                let lines = self.axes.iter().filter_map(|a| distance_to_polyline(&a.points, p));
                lines.fold(f64::INFINITY, f64::min)
            };
            let nearest = face.outline.iter().map(|&p| (p, off(p))).min_by(|a, b| a.1.total_cmp(&b.1))?;
            (nearest.1 < LIMITS.touch).then_some(nearest)
        };
        let marked = || {
            let row = self.faces.iter().position(|f| core::ptr::eq(f, face))?;
            let ends = self.marks_of(row).flat_map(|m| [m.points[0], m.points[m.points.len() - 1]]);
            ends.map(nearest).min_by(|a, b| a.1.total_cmp(&b.1))
        };
        self.corner_on_stem(face).or_else(|| end.or_else(along).or_else(marked).map(|(p, _)| p))
    }

    /// Faces that are leaves on stems, as parts; `None` where others among them cover more than a share of all that is enclosed.
    pub(crate) fn leaves_among(
        &self,
        rows: impl Iterator<Item = usize>,
        most_other: f64,
    ) -> Option<Vec<Part>> {
        let (mut leaves, mut other) = (Vec::new(), 0.0);
        for face in rows.map(|k| &self.faces[k]) {
            match self.root_of(face).filter(|root| is_leaf_from(face, *root)) {
                Some(root) => leaves.push(Part::of_face(face, StrokeClass::Blade, Some(root))),
                None => other += face.shape.area,
            }
        }
        (other <= most_other * self.enclosed()).then_some(leaves)
    }

    /// The highest face and all that hang together with it: their rows, and all of them as one.
    pub(crate) fn highest_group(&self) -> Option<(Vec<usize>, Face)> {
        let top = |f: &Face| f.outline.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let first =
            (0..self.faces.len()).max_by(|&a, &b| top(&self.faces[a]).total_cmp(&top(&self.faces[b])))?;
        let adjoins = |a: &Face, b: &Face| {
            a.outline.iter().any(|p| nearest_on_ring(&b.outline, *p).1 < LIMITS.adjoining)
        };
        let mut members = vec![first];
        let is_next =
            |members: &[usize], k: usize| members.iter().any(|&m| adjoins(&self.faces[m], &self.faces[k]));
        while let Some(next) = (0..self.faces.len()).find(|k| !members.contains(k) && is_next(&members, *k)) {
            members.push(next);
        }
        let faces: Vec<&Face> = members.iter().map(|&k| &self.faces[k]).collect();
        let head = if let [one] = faces[..] { one.clone() } else { self.union(&faces)? };
        Some((members, head))
    }

    /// Lines within a face.
    pub(crate) fn marks_of(&self, face: usize) -> impl Iterator<Item = &Run> {
        self.marks.iter().filter(move |(f, _)| *f == face).map(|(_, run)| run)
    }
}

/// See [`Scene::axes`].
fn axes(ink: &Ink, lines: &[Run]) -> Vec<Axis> {
    let is_straight = |stroke: usize| {
        let s = &ink.strokes[stroke];
        s.points[0].distance(s.points[s.points.len() - 1]) > STRAIGHT * s.length
    };
    let mut found: Vec<Axis> = Vec::new();
    for run in lines {
        let stroke = run.stroke;
        if is_straight(stroke) {
            if !found.iter().any(|axis| axis.stroke == stroke) {
                found.push(Axis { stroke, points: ink.strokes[stroke].points.clone() });
            }
            continue;
        }
        match found.last_mut() {
            Some(axis) if axis.stroke == stroke && axis.ends()[1].distance(run.points[0]) < LIMITS.touch => {
                axis.points.extend(&run.points);
            }
            _ => found.push(Axis { stroke, points: run.points.clone() }),
        }
    }
    found
}

impl Part {
    pub(crate) fn of_axis(axis: &Axis) -> Self {
        let strokes = vec![axis.stroke];
        Self { points: axis.points.clone(), class: StrokeClass::Axis, root: None, strokes }
    }

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

/// What the readers propose for a drawing, the surest first. What one sees may be part of what another looks for: the one that
/// needs more rules the other out.
pub(crate) fn propose(ink: &Ink) -> Vec<Proposal> {
    let Some(scene) = Scene::new(ink) else { return Vec::new() };
    let clover = clover::propose(&scene);
    let lobed = lobed::propose(&scene);
    let bloom = if clover.is_none() { bloom::propose(&scene) } else { None };
    // Petals all round a disc are seen from the front.
    let is_from_front = bloom.as_ref().is_some_and(|b| b.likelihood >= bloom::ROUND_A_DISC);
    let cup = if clover.is_none() && !is_from_front { cup::propose(&scene) } else { None };
    // Lobes that spread from the foot are fingers, not tiers.
    let conifer = if lobed.is_none() { conifer::propose(&scene) } else { None };
    let head = if cup.is_none() && !is_from_front { head::propose(&scene) } else { None };
    let others = [leaf::propose, sprig::propose, palm::propose, taproot::propose, mushroom::propose]
        .map(|read| read(&scene));
    let mut found: Vec<Proposal> =
        [clover, lobed, bloom, cup, head, conifer].into_iter().chain(others).flatten().collect();
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
