//! Readers: each recognises one arrangement of faces and lines as a plant, or returns nothing.
//!
//! `Scene -> Proposal`: the parts of the plant, cut from the strokes as needed. A reader never looks at the kind that
//! the drawing resembles; it proposes a plant only if the arrangement leaves little doubt.

mod bloom;
mod bud;
mod bunch;
mod cactus;
mod chevrons;
mod clover;
mod conifer;
mod crown;
mod cup;
mod fruit;
mod head;
mod leaf;
mod lobed;
mod loose;
mod mushroom;
mod palm;
mod pot;
mod sprig;
mod taproot;
#[cfg(test)]
mod tests;

use geom::{bounds, distance_to_polyline, polyline_length, signed_area};
use glam::DVec2;
use ink::{Ink, StrokeClass, StrokeMode};

use super::faces::{Face, Faces, Picture, Place, Run};
use crate::Kind;
use crate::blade::nearest_on_ring;
use crate::palette::{is_green_stroke, is_painted};
use crate::thresholds::STRAIGHT;

/// The source of a class that follows from the arrangement of faces and lines.
pub const ARRANGEMENT: &str = "arrangement";

/// One part of a plant.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) points: Vec<DVec2>,
    pub(crate) class: StrokeClass,
    /// Its attachment, if that is known.
    pub(crate) root: Option<DVec2>,
    /// Rows of the strokes that it is made of, the one with the largest part first.
    pub(crate) strokes: Vec<usize>,
}

/// A plant that a reader recognised.
#[derive(Clone, Debug)]
pub(crate) struct Proposal {
    pub(crate) kind: Kind,
    pub(crate) parts: Vec<Part>,
    /// Flowers: rows of the parts that are petals of one.
    pub(crate) heads: Vec<Vec<usize>>,
    /// How much more often this arrangement is found in drawings of the kind than in others (a likelihood ratio): the
    /// readers' judgement, to be combined with how likely the kind is otherwise.
    pub(crate) likelihood: f64,
    /// The name of a plant of the kind with this arrangement, if only one has it: a word of [`crate::glance::WORDS`].
    pub(crate) word: Option<&'static str>,
    /// Whether its parts belong together though they do not touch one another.
    pub(crate) is_of_pieces: bool,
}

/// Limits of touching and of small faces, for all readers. Lengths are in ink units (the drawing's diagonal is 1).
pub(crate) struct ReaderLimits {
    /// A line that ends nearer than this to an outline touches it, whatever its pen.
    pub(crate) touch: f64,
    /// Greatest width of a pen within which a line touches an outline.
    pub(crate) widest_pen: f64,
    /// Faces nearer to one another than this are connected.
    pub(crate) adjoining: f64,
    /// Most strokes of an icon, or of a single leaf.
    pub(crate) most_strokes: usize,
    /// Faces below this share of the area of all are dirt, or shade.
    pub(crate) speck: f64,
    /// Least convexity of a leaf (area over that of the hull).
    pub(crate) leaf_convex: f64,
    /// Least and greatest slenderness of a leaf (width over length).
    pub(crate) leaf_slender: [f64; 2],
}

pub(crate) const LIMITS: ReaderLimits = ReaderLimits {
    touch: 0.035,
    widest_pen: 0.09,
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
    /// Returns its start and its end.
    pub(crate) fn ends(&self) -> [DVec2; 2] {
        [self.points[0], self.points[self.points.len() - 1]]
    }

    /// Returns its lower end and its upper end; the end of a level line counts as the lower one.
    pub(crate) fn foot_and_top(&self) -> [DVec2; 2] {
        let [a, b] = self.ends();
        if a.y < b.y { [a, b] } else { [b, a] }
    }
}

/// The faces and lines that readers look at.
pub(crate) struct Scene {
    picture: Picture,
    /// Faces that are no specks.
    pub(crate) faces: Vec<Face>,
    /// Lines outside all faces.
    pub(crate) lines: Vec<Run>,
    /// Lines within a face: its row among `faces`.
    pub(crate) marks: Vec<(usize, Run)>,
    /// Lines that may be stems: whole strokes that lead from one end to the other without a detour and run outside the
    /// faces for part of their length; and the parts of other strokes that run outside.
    pub(crate) axes: Vec<Axis>,
    /// The pot in which a stem stands; it is none of the faces.
    pub(crate) pot: Option<Part>,
    /// The ground on which a line ends, drawn as a flat line.
    pub(crate) ground: Option<Axis>,
    /// A line that ends nearer than this to an outline touches it: [`ReaderLimits::touch`], or the width of the pen.
    pub(crate) touch: f64,
    pub(crate) low: DVec2,
    pub(crate) high: DVec2,
}

impl Scene {
    /// Finds the faces and lines; `None` for drawings of too many strokes or with contours, and if nothing is
    /// enclosed.
    pub(crate) fn new(ink: &Ink) -> Option<Self> {
        // Contours that are to be filled have a class already.
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
        let touch = LIMITS.touch.max(ink.pen_width().min(LIMITS.widest_pen));
        let mut axes = axes(ink, &lines);
        let ground = ground_row(&axes, low, touch).map(|row| axes.remove(row));
        if let Some(ground) = &ground {
            lines.retain(|line| line.stroke != ground.stroke);
        }
        let mut scene =
            Self { picture, faces: kept, lines, marks, axes, pot: None, ground, touch, low, high };
        if let Some((pot, rows)) = pot::find(&scene) {
            scene.pot = Some(pot);
            scene.remove_faces(&rows);
        }
        (!scene.faces.is_empty()).then_some(scene)
    }

    /// Removes faces and the marks in them. `rows`: in ascending order.
    fn remove_faces(&mut self, rows: &[usize]) {
        self.marks.retain(|(face, _)| !rows.contains(face));
        for (face, _) in &mut self.marks {
            *face -= rows.iter().filter(|row| **row < *face).count();
        }
        for &row in rows.iter().rev() {
            self.faces.remove(row);
        }
    }

    /// Returns the end of a line that touches a face, if one does.
    pub(crate) fn touching_end(&self, line: &Run, face: usize) -> Option<DVec2> {
        let ends = [line.points[0], line.points[line.points.len() - 1]];
        let off = |p: DVec2| nearest_on_ring(&self.faces[face].outline, p).1;
        ends.into_iter().filter(|&p| off(p) < self.touch).min_by(|a, b| off(*a).total_cmp(&off(*b)))
    }

    /// Returns the area of all faces together.
    pub(crate) fn enclosed(&self) -> f64 {
        self.faces.iter().map(|f| f.shape.area).sum()
    }

    /// Returns the row of the face that covers more than a share of the enclosed area. `share`: at least 0.5, so that
    /// there is at most one.
    pub(crate) fn main_face(&self, share: f64) -> Option<usize> {
        let least = share * self.enclosed();
        self.faces.iter().position(|f| f.shape.area > least)
    }

    /// Unites several faces, if they are connected.
    pub(crate) fn union(&self, faces: &[&Face]) -> Option<Face> {
        self.picture.union(faces)
    }

    /// Returns the corner of a leaf that lies on a stem, the one nearest to the foot of the stem: the side of a leaf
    /// may touch it, too, and so may the tip of a grain in an ear.
    fn corner_on_stem(&self, face: &Face) -> Option<DVec2> {
        let corner_on = |axis: &Axis| {
            let foot = axis.ends().into_iter().min_by(|p, q| p.y.total_cmp(&q.y))?;
            let is_on = |p: &&DVec2| distance_to_polyline(&axis.points, **p).is_some_and(|d| d < self.touch);
            let corners = face.shape.corners.iter().filter(is_on);
            corners.min_by(|a, b| a.distance(foot).total_cmp(&b.distance(foot))).copied()
        };
        self.axes.iter().find_map(corner_on)
    }

    /// Returns the attachment of a leaf: its point nearest to a stem's end, or to a stem that passes it, or to the end
    /// of its vein.
    pub(crate) fn root_of(&self, face: &Face) -> Option<DVec2> {
        let nearest = |p: DVec2| nearest_on_ring(&face.outline, p);
        let end = self
            .axes
            .iter()
            .flat_map(Axis::ends)
            .map(nearest)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|(_, d)| *d < self.touch);
        let along = || {
            let off = |p: DVec2| {
                let lines = self.axes.iter().filter_map(|a| distance_to_polyline(&a.points, p));
                lines.fold(f64::INFINITY, f64::min)
            };
            let nearest = face.outline.iter().map(|&p| (p, off(p))).min_by(|a, b| a.1.total_cmp(&b.1))?;
            (nearest.1 < self.touch).then_some(nearest)
        };
        let marked = || {
            let row = self.faces.iter().position(|f| core::ptr::eq(f, face))?;
            let ends = self.marks_of(row).flat_map(|m| [m.points[0], m.points[m.points.len() - 1]]);
            ends.map(nearest).min_by(|a, b| a.1.total_cmp(&b.1))
        };
        self.corner_on_stem(face).or_else(|| end.or_else(along).or_else(marked).map(|(p, _)| p))
    }

    /// Returns faces that are leaves on stems, as parts; `None` if others among them cover more than a share of the
    /// enclosed area.
    pub(crate) fn leaves_among(
        &self,
        rows: impl Iterator<Item = usize>,
        most_other: f64,
    ) -> Option<Vec<Part>> {
        let (mut leaves, mut other) = (Vec::new(), 0.0);
        for face in rows.map(|k| &self.faces[k]) {
            match self.root_of(face).filter(|root| is_leaf_from(face, *root)) {
                Some(root) => leaves.push(Part::from_face(face, StrokeClass::Blade, Some(root))),
                None => other += face.shape.area,
            }
        }
        (other <= most_other * self.enclosed()).then_some(leaves)
    }

    /// Returns the rows of the highest face and all connected faces, and all of them as one.
    pub(crate) fn highest_group(&self) -> Option<(Vec<usize>, Face)> {
        let top = |f: &Face| f.outline.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let first =
            (0..self.faces.len()).max_by(|&a, &b| top(&self.faces[a]).total_cmp(&top(&self.faces[b])))?;
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

    /// Returns the lines within a face.
    pub(crate) fn marks_of(&self, face: usize) -> impl Iterator<Item = &Run> {
        self.marks.iter().filter(move |(f, _)| *f == face).map(|(_, run)| run)
    }
}

/// Finds the lines described at [`Scene::axes`].
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

/// The ground is at least this many times as wide as high.
const GROUND_FLAT: f64 = 2.0;
/// A stem ends on the ground at least this share of its width away from its ends.
const GROUND_INNER: f64 = 0.12;

/// Finds the row of the line that is the ground: flat, or a low mound, at the foot of the drawing, and a stem ends on
/// it from above.
fn ground_row(axes: &[Axis], low: DVec2, touch: f64) -> Option<usize> {
    axes.iter().position(|axis| {
        let Some((lo, hi)) = bounds(&axis.points) else { return false };
        let size = hi - lo;
        let inner = GROUND_INNER * size.x;
        let stands = |stem: &Axis| {
            let [foot, _] = stem.foot_and_top();
            foot.x > lo.x + inner
                && foot.x < hi.x - inner
                && foot.y > hi.y - touch
                && distance_to_polyline(&axis.points, foot).is_some_and(|d| d < touch)
        };
        let others = || axes.iter().filter(|a| a.stroke != axis.stroke);
        size.x > GROUND_FLAT * size.y && lo.y < low.y + touch && others().any(stands)
    })
}

/// Whether two faces have a part of their outlines in common.
pub(crate) fn adjoins(a: &Face, b: &Face) -> bool {
    let (Some((low, high)), Some((from, to))) = (bounds(&a.outline), bounds(&b.outline)) else {
        return false;
    };
    // Boxes that lie apart spare the comparison of all points.
    let is_apart = (low - to).max(from - high).max_element() >= LIMITS.adjoining;
    !is_apart && a.outline.iter().any(|p| nearest_on_ring(&b.outline, *p).1 < LIMITS.adjoining)
}

impl Part {
    pub(crate) fn from_axis(axis: &Axis) -> Self {
        let strokes = vec![axis.stroke];
        Self { points: axis.points.clone(), class: StrokeClass::Axis, root: None, strokes }
    }

    pub(crate) fn from_run(run: &Run, class: StrokeClass) -> Self {
        Self { points: run.points.clone(), class, root: None, strokes: vec![run.stroke] }
    }

    pub(crate) fn from_face(face: &Face, class: StrokeClass, root: Option<DVec2>) -> Self {
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
        && !has_straight_side(face)
        && (LIMITS.leaf_slender[0]..LIMITS.leaf_slender[1]).contains(&shape.slenderness)
        && shape.tip_from(root).is_some_and(|tip| tip.distance(root) > TIP * far)
}

/// A straight side deviates from a line by at most this share of its chord.
const SIDE_STRAIGHT: f64 = 0.025;
/// A straight side is at least this share of the length of its face.
const SIDE_LONG: f64 = 0.8;
/// The part of a side by which it is judged, as shares of its chord: its corners may be rounded.
const SIDE_MIDDLE: core::ops::Range<f64> = 0.15..0.85;

/// Whether an outline with two corners is straight from one to the other, as that of a slice is and no leaf's.
pub(crate) fn has_straight_side(face: &Face) -> bool {
    let [a, b] = face.shape.corners[..] else { return false };
    let outline = &face.outline;
    let nearest = |p: DVec2| {
        (0..outline.len()).min_by(|&i, &j| outline[i].distance(p).total_cmp(&outline[j].distance(p)))
    };
    let (Some(from), Some(to)) = (nearest(a), nearest(b)) else { return false };
    let (from, to) = (from.min(to), from.max(to));
    let length = a.distance(b);
    let along = (b - a).normalize_or_zero();
    let is_middle = |p: &&DVec2| SIDE_MIDDLE.contains(&((**p - a).dot(along) / length));
    // From one corner to the other the side stays on one line, at whatever distance from the rounded corners.
    let is_straight = |side: &mut dyn Iterator<Item = &DVec2>| {
        let off = side.filter(is_middle).map(|p| (*p - a).dot(along.perp()));
        let (low, high) = off.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| (l.min(d), h.max(d)));
        high - low < SIDE_STRAIGHT * length
    };
    let one = is_straight(&mut outline[from..=to].iter());
    let other = is_straight(&mut outline[to..].iter().chain(&outline[..=from]));
    length > SIDE_LONG * face.shape.length() && (one || other)
}

/// The tip of a leaf lies farther from its root than this share of the farthest point.
const TIP: f64 = 0.88;

/// Returns the proposals of the readers for a drawing, the surest first. One reader's plant may be part of another's:
/// the one that requires more excludes the other.
pub(crate) fn propose(ink: &Ink) -> Vec<Proposal> {
    let chevrons = chevrons::propose(ink);
    let Some(scene) = Scene::new(ink) else { return chevrons.into_iter().collect() };
    let clover = clover::propose(&scene);
    let lobed = lobed::propose(&scene);
    let bunch = bunch::propose(&scene);
    let may_be_bloom = clover.is_none() && bunch.is_none();
    let bloom = if may_be_bloom { bloom::propose(&scene) } else { None };
    // Petals all round a disc belong to a flower seen from the front.
    let is_from_front = bloom.as_ref().is_some_and(|b| b.likelihood >= bloom::ROUND_A_DISC);
    // Petals seen from the side have no midribs.
    let loose = loose::propose(&scene);
    // A smooth cap with a flat underside is no petal.
    let mushroom = mushroom::propose(&scene);
    let is_capped = mushroom.as_ref().is_some_and(|m| m.likelihood >= mushroom::FLAT_CAP);
    let may_be_cup = clover.is_none() && !is_from_front && loose.is_none() && !is_capped;
    let cup = if may_be_cup { cup::propose(&scene) } else { None };
    // Lobes that spread from the foot are fingers, not tiers.
    let conifer = if lobed.is_none() { conifer::propose(&scene) } else { None };
    let head = if cup.is_none() && !is_from_front { head::propose(&scene) } else { None };
    let bud = bud::propose(&scene, ink);
    // Petals that show above another one are no leaves on a fruit.
    let fruit = if bud.is_none() { fruit::propose(&scene) } else { None };
    let others =
        [cactus::propose, leaf::propose, sprig::propose, palm::propose, taproot::propose, crown::propose]
            .map(|read| read(&scene));
    let mut found: Vec<Proposal> =
        [clover, lobed, loose, bloom, bunch, cup, head, conifer, chevrons, mushroom]
            .into_iter()
            .chain([bud, bud::painted(&scene, ink), fruit])
            .chain(others)
            .flatten()
            .collect();
    found.iter_mut().for_each(|proposal| green_petals_are_leaves(proposal, ink));
    if let Some(ground) = &scene.ground {
        let part = Part { class: StrokeClass::Ground, ..Part::from_axis(ground) };
        found.iter_mut().for_each(|p| p.parts.push(part.clone()));
    }
    if let Some(pot) = &scene.pot {
        for proposal in &mut found {
            proposal.kind = Kind::HousePlant;
            proposal.parts.push(pot.clone());
        }
    }
    base::sort_by(&mut found, |a, b| b.likelihood.total_cmp(&a.likelihood));
    found
}

/// Makes a flower whose petals were all painted green, among other colours, a stem with leaves.
fn green_petals_are_leaves(proposal: &mut Proposal, ink: &Ink) {
    let is_green = |part: &Part| part.strokes.first().is_some_and(|&k| is_green_stroke(&ink.strokes[k]));
    let mut blades = proposal.parts.iter().filter(|p| p.class == StrokeClass::Blade);
    if proposal.kind == Kind::Flower && is_painted(ink) && blades.all(is_green) {
        proposal.kind = Kind::Stem;
        proposal.heads.clear();
    }
}

/// Turns an outline so that `up` points up, about a place that becomes the origin.
pub(crate) fn upright(outline: &[DVec2], origin: DVec2, up: DVec2) -> Vec<DVec2> {
    outline.iter().map(|&p| DVec2::new((p - origin).perp_dot(up), (p - origin).dot(up))).collect()
}

/// Returns the areas of an outline to the left and to the right of a level.
pub(crate) fn halves(outline: &[DVec2], x: f64) -> [f64; 2] {
    [-1.0, 1.0].map(|sign: f64| {
        let half: Vec<DVec2> =
            outline.iter().map(|p| DVec2::new(x + (sign * (p.x - x)).max(0.0), p.y)).collect();
        signed_area(&half).abs()
    })
}

/// Returns the greatest width, and the share of the height at which it is, of those measured at the middles of `levels`
/// levels.
pub(crate) fn widest(levels: usize, width: impl Fn(f64) -> f64) -> Option<(f64, f64)> {
    let shares = (0..levels).map(|level| (level as f64 + 0.5) / levels as f64);
    shares.map(|share| (width(share), share)).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Returns the widest angle between neighbouring directions, radians.
pub(crate) fn widest_gap(ways: impl Iterator<Item = DVec2>) -> f64 {
    let mut angles: Vec<f64> = ways.map(|d| base::ops::atan2(d.y, d.x)).collect();
    base::sort_by(&mut angles, f64::total_cmp);
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return base::ops::TAU };
    let seam = first + base::ops::TAU - last;
    angles.windows(2).map(|w| w[1] - w[0]).fold(seam, f64::max)
}

/// Returns the length of all these lines.
pub(crate) fn length_of<'a>(lines: impl Iterator<Item = &'a Run>) -> f64 {
    lines.map(|l| polyline_length(&l.points)).sum()
}
