//! The faces that lines enclose together, and how each line runs between them.
//!
//! `strokes -> bridged gaps -> faces, runs`
//!
//! A pen does not close every outline: an outline ends where another begins, a petal stops behind its neighbour, a
//! vein leaves a leaf through the gap at its base. The faces are found in a picture of square cells (gaps are bridged
//! first); their outlines run along the drawn lines themselves.

use base::LiteMap;
use geom::{polyline_length, simple_outline, simplify};
use glam::DVec2;
use ink::{Ink, InkStroke, StrokeMode};

use super::shape::Shape;
use crate::near::Near;
use crate::raster::{BESIDE, Cells, around};

/// Limits for bridging gaps, and for faces too small to count. Lengths are in ink units (the drawing's diagonal is 1).
struct FaceLimits {
    /// Cells along the longer side of the drawing.
    along: usize,
    /// Ends nearer than this share of the stroke's length close it.
    closed: f64,
    /// Ends nearer than this share of the stroke's length close it if it goes round something:
    wide_gap: f64,
    /// it then encloses at least this share of its squared length. A circle encloses 0.08.
    round: f64,
    /// An end nearer than this to another stroke lies on it.
    junction: f64,
    /// Two free ends nearer than this, and nearest to one another, belong together,
    ends: f64,
    /// or nearer than this many widths of the pen: the gap between bold lines is narrower than it is long.
    ends_pens: f64,
    /// ... and with a visible gap of less than this share of the shorter of their strokes.
    ends_share: f64,
    /// A free end nearer than this to the side of a stroke belongs to it.
    side: f64,
    /// Another free end is led straight on, in the direction of its last part of this length,
    heading: f64,
    /// to ink nearer than this
    ahead: f64,
    /// and nearer than this share of its stroke;
    ahead_share: f64,
    /// its own ink lies behind it after this number of cells.
    clear: f64,
    /// Faces are connected across ink of this number of cells to either side.
    seam: isize,
    /// Faces of fewer cells are ink that ran together.
    dirt: usize,
    /// Corners of an outline lie within this of its cells, in cells.
    calm: f64,
    /// Runs of a line shorter than this belong to the run before.
    run: f64,
    /// Distances from a line, in cells, at which the faces on either side are looked up.
    sides: [f64; 3],
    /// Two faces are one that a vein divides if their outlines have at least this share of the shorter one in common,
    vein: f64,
    /// the smaller has at least this share of the other's area,
    vein_area: f64,
    /// and both together are as convex as this (area over that of the hull).
    vein_convex: f64,
    /// Most faces that are checked for a dividing vein: with more, nothing is united.
    most_united: usize,
}

const LIMITS: FaceLimits = FaceLimits {
    along: 256,
    closed: 0.13,
    wide_gap: 0.26,
    round: 0.045,
    junction: 0.0075,
    ends: 0.08,
    ends_pens: 1.6,
    ends_share: 0.35,
    side: 0.03,
    heading: 0.03,
    ahead: 0.2,
    ahead_share: 0.25,
    clear: 4.0,
    seam: 3,
    dirt: 24,
    calm: 0.3,
    run: 0.02,
    sides: [1.6, 2.6, 3.6],
    vein: 0.2,
    vein_area: 0.25,
    vein_convex: 0.92,
    most_united: 48,
};

/// Margin of cells round the drawing, so that the outside is connected.
const MARGIN: f64 = 3.0;

/// Label of cells with ink.
const INK: u32 = u32::MAX;
/// Label of cells of the outside; faces follow.
const OUTSIDE: u32 = 0;

/// An area that lines enclose.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    /// Outline along the lines, simple, counter-clockwise.
    pub(crate) outline: Vec<DVec2>,
    pub(crate) shape: Shape,
    /// The strokes along which its outline runs, the longest part first.
    pub(crate) strokes: Vec<usize>,
    /// Its cells in the picture.
    labels: Vec<u32>,
}

/// The place in which a part of a line runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// The outside lies on both sides of it.
    Outside,
    /// The same face lies on both sides of it.
    Within(usize),
    /// It separates two faces, or a face from the outside.
    Between,
}

/// A part of a stroke that runs in one place.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub(crate) stroke: usize,
    pub(crate) place: Place,
    pub(crate) points: Vec<DVec2>,
}

/// The faces of a drawing and the runs of its lines.
#[derive(Clone, Debug)]
pub(crate) struct Faces {
    pub(crate) faces: Vec<Face>,
    pub(crate) runs: Vec<Run>,
    pub(crate) picture: Picture,
}

/// One stroke's way through a cell.
#[derive(Clone, Copy, Debug)]
struct Mark {
    stroke: usize,
    at: DVec2,
}

/// The picture: the label of each cell, and the stroke that runs through it.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    cells: Cells,
    label: Vec<u32>,
    marks: Vec<Option<Mark>>,
}

impl Faces {
    /// Finds the faces of all strokes drawn in parts mode. Cost: the cells of a picture of fixed size, and linear in
    /// points; used for drawings of at most some hundred strokes.
    pub(crate) fn new(ink: &Ink) -> Option<Self> {
        let lines: Vec<&[DVec2]> = ink.strokes.iter().map(|s| s.points.as_slice()).collect();
        let cells = Cells::new(&lines, LIMITS.along, MARGIN)?;
        let count = cells.count();
        let mut picture = Picture { cells, label: vec![OUTSIDE; count], marks: vec![None; count] };
        for (k, stroke) in ink.strokes.iter().enumerate() {
            if stroke.mode == StrokeMode::Parts {
                picture.draw(&stroke.points, k);
            }
        }
        let (bridges, free) = bridges(ink);
        for (line, stroke) in bridges {
            picture.draw(&line, stroke);
        }
        for (points, stroke) in free {
            if let Some(hit) = picture.ahead(&points) {
                picture.draw(&[points[points.len() - 1], hit], stroke);
            }
        }
        let found = picture.flood();
        let united = picture.unite(found);
        let faces: Vec<Option<Face>> = (1..=united).map(|label| picture.face(&[label])).collect();
        let mut rows = vec![None; faces.len()];
        let mut kept = Vec::new();
        for (label, face) in faces.into_iter().enumerate() {
            if let Some(face) = face {
                rows[label] = Some(kept.len());
                kept.push(face);
            }
        }
        let runs =
            (0..ink.strokes.len()).flat_map(|k| picture.runs(k, &ink.strokes[k].points, &rows)).collect();
        Some(Self { faces: kept, runs, picture })
    }
}

/// Least area of several faces as a share of that of their hull; with less, they are no convex whole.
const FILLS_HULL: f64 = 0.85;

impl Face {
    /// Returns the area that an outline of several strokes encloses as a face; it has no cells in the picture.
    pub(crate) fn around(outline: &[DVec2], strokes: &[usize]) -> Option<Self> {
        let mut outline = outline.to_vec();
        if geom::signed_area(&outline) < 0.0 {
            outline.reverse();
        }
        let shape = Shape::new(&outline)?;
        Some(Self { outline, shape, strokes: strokes.to_vec(), labels: Vec::new() })
    }

    /// Returns the convex hull of several faces as one face; `None` if they fill too little of it.
    pub(crate) fn hull(faces: &[&Self]) -> Option<Self> {
        let points: Vec<DVec2> = faces.iter().flat_map(|f| f.outline.iter().copied()).collect();
        let outline = geom::convex_hull(&points);
        let shape = Shape::new(&outline)?;
        let area: f64 = faces.iter().map(|f| f.shape.area).sum();
        if area < FILLS_HULL * shape.area {
            return None;
        }
        let mut strokes: Vec<usize> = Vec::new();
        for &stroke in faces.iter().flat_map(|f| &f.strokes) {
            if !strokes.contains(&stroke) {
                strokes.push(stroke);
            }
        }
        let labels = faces.iter().flat_map(|f| f.labels.iter().copied()).collect();
        Some(Self { outline, shape, strokes, labels })
    }
}

/// Least area of the outline around several faces as a share of their areas; with less, it is that of only one.
const WHOLE: f64 = 0.9;

impl Picture {
    /// Unites several faces into the area that their outlines enclose together. `None` if they are not connected by
    /// their ink.
    pub(crate) fn union(&self, faces: &[&Face]) -> Option<Face> {
        let labels: Vec<u32> = faces.iter().flat_map(|f| f.labels.iter().copied()).collect();
        let whole = self.face(&labels)?;
        let parts: f64 = faces.iter().map(|f| f.shape.area).sum();
        (whole.shape.area > WHOLE * parts).then_some(whole)
    }

    fn draw(&mut self, line: &[DVec2], stroke: usize) {
        let Self { cells, label, marks } = self;
        cells.walk(line, |at| {
            let cell = cells.place(at);
            label[cell] = INK;
            marks[cell].get_or_insert(Mark { stroke, at });
        });
    }

    /// Returns where a line that stops short would have ended: the first ink ahead of its end, if it is near.
    fn ahead(&self, points: &[DVec2]) -> Option<DVec2> {
        let end = *points.last()?;
        let length = polyline_length(points);
        let before = geom::point_at(points, (length - LIMITS.heading).max(0.0))?;
        let way = (end - before).normalize_or_zero();
        let reach = LIMITS.ahead.min(LIMITS.ahead_share * length);
        let mut step = LIMITS.clear * self.cells.size;
        while step < reach {
            let at = end + way * step;
            let cell = self.cells.place(at);
            if self.label[cell] == INK {
                return self.marks[cell].map(|m| m.at);
            }
            step += 0.5 * self.cells.size;
        }
        None
    }

    /// Labels the areas that lines enclose, 1 and up; returns the last label.
    fn flood(&mut self) -> u32 {
        const FREE: u32 = u32::MAX - 1;
        self.label.iter_mut().filter(|l| **l != INK).for_each(|l| *l = FREE);
        let mut next = OUTSIDE;
        for from in 0..self.label.len() {
            if self.label[from] != FREE {
                continue;
            }
            let mut piece = vec![from];
            self.label[from] = next;
            let mut k = 0;
            while let Some(&at) = piece.get(k) {
                k += 1;
                for beside in self.cells.around(at, &BESIDE) {
                    if self.label[beside] == FREE {
                        self.label[beside] = next;
                        piece.push(beside);
                    }
                }
            }
            if next != OUTSIDE && piece.len() < LIMITS.dirt {
                piece.into_iter().for_each(|at| self.label[at] = INK);
            } else {
                next += 1;
            }
        }
        next.saturating_sub(1)
    }

    /// Returns the outline around all cells of some labels, along the ink.
    fn face(&self, labels: &[u32]) -> Option<Face> {
        let own: Vec<bool> = self.label.iter().map(|l| labels.contains(l)).collect();
        // Between two faces several lines may run side by side.
        let reach = if labels.len() > 1 { LIMITS.seam } else { 1 };
        let square: Vec<(isize, isize)> =
            (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y))).collect();
        let mut mask = own.clone();
        for at in (0..own.len()).filter(|&at| own[at]) {
            self.cells.around(at, &square).filter(|&b| self.label[b] == INK).for_each(|b| mask[b] = true);
        }
        let rim = around(&self.cells, &mask)?;
        let mut owners: LiteMap<usize, usize> = LiteMap::new();
        let along = |p: DVec2| {
            let mark = self.marks[self.cells.place(p)]?;
            *owners.entry(mark.stroke).or_insert(0) += 1;
            Some(mark.at)
        };
        let line: Vec<DVec2> = rim.into_iter().filter_map(along).collect();
        let outline = simple_outline(&simplify(&line, LIMITS.calm * self.cells.size))?;
        let shape = Shape::new(&outline)?;
        let mut strokes: Vec<(usize, usize)> = owners.iter().map(|(k, n)| (*k, *n)).collect();
        base::sort_by_key(&mut strokes, |(k, n)| (core::cmp::Reverse(*n), *k));
        let strokes = strokes.into_iter().map(|(k, _)| k).collect();
        Some(Face { outline, shape, strokes, labels: labels.to_vec() })
    }

    /// Gives one label to the halves of a leaf that its midrib divides; returns the last label.
    fn unite(&mut self, last: u32) -> u32 {
        if last as usize > LIMITS.most_united {
            return last;
        }
        let mut last = last;
        while let Some((keep, give)) = self.halves(last) {
            // The last label fills the gap.
            for label in &mut self.label {
                if *label == give {
                    *label = keep;
                } else if *label == last && give != last {
                    *label = give;
                }
            }
            // Ink between the halves belongs to the line that divides them: it stays ink.
            last -= 1;
        }
        last
    }

    /// Returns two faces that are halves of one, if there are any.
    fn halves(&self, last: u32) -> Option<(u32, u32)> {
        let common = self.common();
        let faces: Vec<Option<Face>> = (1..=last).map(|l| self.face(&[l])).collect();
        let length = |l: u32| faces[l as usize - 1].as_ref().map_or(0.0, |f| f.shape.perimeter);
        let area = |l: u32| faces[l as usize - 1].as_ref().map_or(0.0, |f| f.shape.area);
        common.iter().find_map(|(&(a, b), &cells)| {
            let shared = cells as f64 * self.cells.size;
            let (small, large) = (area(a).min(area(b)), area(a).max(area(b)));
            let near = shared > LIMITS.vein * length(a).min(length(b)) && small > LIMITS.vein_area * large;
            let whole = if near { self.face(&[a, b]) } else { None };
            whole.filter(|f| f.shape.convexity > LIMITS.vein_convex).map(|_| (a, b))
        })
    }

    /// Counts the cells of ink that separate each pair of faces.
    fn common(&self) -> LiteMap<(u32, u32), usize> {
        let mut common = LiteMap::new();
        for at in (0..self.label.len()).filter(|&at| self.label[at] == INK) {
            let mut labels: Vec<u32> = self
                .cells
                .around(at, &BESIDE)
                .map(|b| self.label[b])
                .filter(|l| *l != INK && *l != OUTSIDE)
                .collect();
            labels.sort_unstable();
            labels.dedup();
            if let [a, b] = labels[..] {
                *common.entry((a, b)).or_insert(0) += 1;
            }
        }
        common
    }

    /// Returns the label on one side of a line; `None` if there is ink all the way.
    fn label_on_side(&self, p: DVec2, out: DVec2) -> Option<u32> {
        let look = |d: &f64| self.label[self.cells.place(p + out * (d * self.cells.size))];
        LIMITS.sides.iter().map(look).find(|l| *l != INK)
    }

    fn runs(&self, stroke: usize, points: &[DVec2], rows: &[Option<usize>]) -> Vec<Run> {
        let n = points.len();
        let face = |label: u32| rows.get((label as usize).wrapping_sub(1)).copied().flatten();
        let place = |k: usize| {
            let out = (points[(k + 1).min(n - 1)] - points[k.saturating_sub(1)]).normalize_or_zero().perp();
            match (self.label_on_side(points[k], out), self.label_on_side(points[k], -out)) {
                (Some(OUTSIDE), Some(OUTSIDE)) => Some(Place::Outside),
                (Some(a), Some(b)) if a == b => face(a).map(Place::Within),
                (Some(_), Some(_)) => Some(Place::Between),
                _ => None,
            }
        };
        let mut places: Vec<Option<Place>> = (0..n).map(place).collect();
        // Labels are unknown where lines run together: takes that before, or else that after.
        for k in 1..n {
            places[k] = places[k].or(places[k - 1]);
        }
        for k in (0..n.saturating_sub(1)).rev() {
            places[k] = places[k].or(places[k + 1]);
        }
        let mut runs: Vec<(Place, usize, usize)> = Vec::new();
        for (k, place) in places.into_iter().enumerate() {
            let place = place.unwrap_or(Place::Between);
            match runs.last_mut() {
                Some((before, _, end)) if *before == place => *end = k,
                _ => runs.push((place, k, k)),
            }
        }
        let length = |&(_, a, b): &(Place, usize, usize)| polyline_length(&points[a..=b]);
        while runs.len() > 1 {
            let Some(short) = (0..runs.len()).find(|&i| length(&runs[i]) < LIMITS.run) else { break };
            let (_, from, to) = runs.remove(short);
            if short > 0 {
                runs[short - 1].2 = to;
            } else {
                runs[0].1 = from;
            }
            let mut whole: Vec<(Place, usize, usize)> = Vec::new();
            for run in runs.drain(..) {
                match whole.last_mut() {
                    Some(before) if before.0 == run.0 => before.2 = run.2,
                    _ => whole.push(run),
                }
            }
            runs = whole;
        }
        runs.into_iter()
            .map(|(place, from, to)| {
                // The step to the next run belongs to this one.
                Run { stroke, place, points: points[from..=(to + 1).min(n - 1)].to_vec() }
            })
            .filter(|run| run.points.len() > 1)
            .collect()
    }
}

/// Whether the ends of a stroke close it.
fn is_closed(stroke: &InkStroke) -> bool {
    let points = &stroke.points;
    let gap = points[0].distance(points[points.len() - 1]);
    let goes_round = || geom::signed_area(points).abs() > LIMITS.round * stroke.length * stroke.length;
    gap < LIMITS.closed * stroke.length || gap < LIMITS.wide_gap * stroke.length && goes_round()
}

/// A line with the stroke that it belongs to.
type Owned = (Vec<DVec2>, usize);

/// Returns short lines over the gaps between free ends, and from free ends to the sides of strokes; and strokes whose
/// last point is an end that stays free.
fn bridges(ink: &Ink) -> (Vec<Owned>, Vec<Owned>) {
    let mut near = Near::new(LIMITS.side);
    let parts = || ink.strokes.iter().enumerate().filter(|(_, s)| s.mode == StrokeMode::Parts);
    parts().for_each(|(k, s)| near.add_line(k, &s.points));
    let mut fine = Near::new(LIMITS.junction);
    parts().for_each(|(k, s)| fine.add_line(k, &s.points));
    let mut free: Vec<(DVec2, usize)> = Vec::new();
    for (k, stroke) in parts() {
        if is_closed(stroke) {
            continue;
        }
        let (start, end) = (stroke.points[0], stroke.points[stroke.points.len() - 1]);
        let lies_on = |p: DVec2| fine.nearest(p, LIMITS.junction, |owner| owner != k).is_some();
        free.extend([start, end].into_iter().filter(|&p| !lies_on(p)).map(|p| (p, k)));
    }
    let pen = ink.pen_width();
    let ends = LIMITS.ends.max(LIMITS.ends_pens * pen);
    let nearest = |i: usize| {
        let (p, k) = free[i];
        let others = (0..free.len()).filter(|&j| j != i).map(|j| {
            let (q, other) = free[j];
            let short = ink.strokes[k].length.min(ink.strokes[other].length);
            (p.distance(q), j, short)
        });
        let close = |&(d, _, short): &(f64, usize, f64)| d < ends && d - pen < LIMITS.ends_share * short;
        others.filter(close).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, j, _)| j)
    };
    let partner: Vec<Option<usize>> = (0..free.len()).map(nearest).collect();
    let (mut lines, mut loose) = (Vec::new(), Vec::new());
    for (i, &(p, k)) in free.iter().enumerate() {
        let side = near.nearest(p, LIMITS.side, |owner| owner != k).map(|(entry, _)| entry.point);
        let partner_of_end = partner[i].filter(|&j| partner[j] == Some(i));
        if let Some(j) = partner_of_end {
            if i < j {
                lines.push((vec![p, free[j].0], k));
            }
            // The end of a petal lies on its disc, and near the end of its neighbour as well.
            let is_nearer = |q: &DVec2| p.distance(*q) < p.distance(free[j].0);
            lines.extend(side.filter(is_nearer).map(|q| (vec![p, q], k)));
        } else if let Some(q) = side {
            lines.push((vec![p, q], k));
        } else {
            let mut points = ink.strokes[k].points.clone();
            if points[0] == p {
                points.reverse();
            }
            loose.push((points, k));
        }
    }
    // A stroke that overlaps its own beginning is closed; one that stops short of its own side stays open.
    for (k, stroke) in parts() {
        let (start, end) = (stroke.points[0], stroke.points[stroke.points.len() - 1]);
        if start != end && is_closed(stroke) {
            lines.push((vec![start, end], k));
        }
    }
    (lines, loose)
}
