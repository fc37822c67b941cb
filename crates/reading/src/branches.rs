//! The hierarchy of axes, from the longest stroke outwards (He and Cheng 2021, section 4.2).
//!
//! A line is borne by the line of the last level that one of its ends comes nearest to, if nearer than a threshold.
//! Beyond the paper: outlined trunks come first; the threshold is a share of the drawing; lines that cross a bearer
//! are split there; a line that touches nothing is led to the nearest axis or stands on its own; two strokes of one
//! stem are joined; lines that go down from a base are roots.

use geom::{bounds, closest_on_polyline, distance_to_polyline, point_at, polyline_length};
use glam::DVec2;
use plant::AxisKind;

use crate::body::Limb;
use crate::near::Near;
use crate::thresholds::{NO_LENGTH, ROUNDING, WELL_SHORT};
use crate::{Attachment, AxisReading};

/// An end this near to a line touches it: a finger's width on a sheet.
const TOUCH: f64 = 0.045;
/// An end this near may still belong to it, if the line is longer than twice the gap.
const REACH: f64 = 0.15;
/// Shorter pieces of a crossing line are overshoot.
const OVERSHOOT: f64 = 0.025;
/// Half widths of wood at most: a stroke of a broad brush. Nothing thicker is looked for from its surface.
const THICKEST: f64 = 0.15;
/// Lines that one end is compared with, nearest first.
const MOST_CONTACTS: usize = 16;
/// In a drawing of more lines than this a line that touches nothing is not led to an axis (keeps it linear).
const MOST_LED: usize = 3_000;
/// Stems are joined at most this often (each costs a pass over the axes).
const MOST_JOINS: usize = 64;
/// A base farther than this from its bearer is led to it by a piece of its own: less than a step of the pen. *Sampled*.
const STEP: f64 = 0.004;
/// A line that touches the lowest part of a stem, this share of its length, begins at its foot.
const FOOT: f64 = 0.04;
/// A line that goes down by more than this share of its length is a root, or the rest of the stem.
const DOWN: f64 = 0.3;
/// A line whose nearest place on an axis is in this lowest share of it stands next to it.
const NEIGHBOUR: f64 = 0.12;
/// A line that is as long as this share of the axis is a stem of its own.
const AS_LONG: f64 = 0.6;

/// A line that will be an axis.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) points: Vec<DVec2>,
    pub(crate) source: Option<u32>,
}

/// Points that distinguish the base of a line from its tip.
#[derive(Clone, Debug)]
pub(crate) struct Hints {
    /// Points of leaves, flowers and crowns: a stem ends there.
    pub(crate) organs: Near,
    /// Points of pots and the ground: a stem begins there.
    pub(crate) soil: Near,
}

impl Default for Hints {
    fn default() -> Self {
        Self { organs: Near::new(TOUCH), soil: Near::new(TOUCH) }
    }
}

/// The axes found so far.
#[derive(Clone, Debug)]
pub(crate) struct Forest {
    pub(crate) axes: Vec<AxisReading>,
    pub(crate) order: Vec<u32>,
    near: Near,
    /// Largest half width.
    thickest: f64,
    joins: usize,
}

/// One end of a line at another line.
#[derive(Clone, Copy, Debug)]
struct Contact {
    line: usize,
    /// The line's last point (else its first).
    last: bool,
    distance: f64,
}

impl Forest {
    pub(crate) fn new() -> Self {
        Self { axes: Vec::new(), order: Vec::new(), near: Near::new(TOUCH), thickest: 0.0, joins: 0 }
    }

    /// Adds the limbs of a body; `bearer` bears the first one. Returns the row of the first, if there is one.
    pub(crate) fn add_body(
        &mut self,
        limbs: Vec<Limb>,
        bearer: Option<Attachment>,
        source: Option<u32>,
    ) -> Option<usize> {
        let first = self.axes.len();
        let mut rows: Vec<Option<usize>> = Vec::new();
        for limb in limbs {
            let parent = limb.parent.and_then(|p| rows.get(p).copied().flatten());
            let attachment = match (parent, limb.points.first()) {
                (Some(row), Some(&p)) => self.on(row, p),
                _ => bearer,
            };
            rows.push(self.push(limb.points, limb.half_width, attachment, source));
        }
        (self.axes.len() > first).then_some(first)
    }

    /// Adds one axis, base first; its base is led to the bearer. `None` for a line without length.
    pub(crate) fn push(
        &mut self,
        mut points: Vec<DVec2>,
        mut half_width: Vec<f64>,
        bearer: Option<Attachment>,
        source: Option<u32>,
    ) -> Option<usize> {
        if let Some(b) = bearer
            && let (Some(foot), Some(&first)) = (point_at(&self.axes[b.axis].points, b.at), points.first())
        {
            let gap = foot.distance(first);
            if gap > STEP {
                points.insert(0, foot);
                if let Some(&w) = half_width.first() {
                    half_width.insert(0, w);
                }
            } else if let Some(p) = points.first_mut() {
                *p = foot;
            }
        }
        if half_width.len() != points.len() {
            half_width.clear();
        }
        if points.len() < 2 || polyline_length(&points) <= NO_LENGTH {
            return None;
        }
        let row = self.axes.len();
        self.near.add_line(row, &points);
        self.thickest = half_width.iter().copied().fold(self.thickest, f64::max);
        self.order.push(bearer.map_or(0, |b| self.order[b.axis] + 1));
        self.axes.push(AxisReading { points, kind: AxisKind::Stem, bearer, half_width, source });
        Some(row)
    }

    /// Returns the place on an axis nearest to `p`.
    pub(crate) fn on(&self, row: usize, p: DVec2) -> Option<Attachment> {
        let c = closest_on_polyline(&self.axes.get(row)?.points, p)?;
        Some(Attachment { axis: row, at: c.at })
    }

    /// Returns the half width of an axis at an arc length; 0 for a line.
    pub(crate) fn half_width(&self, row: usize, at: f64) -> f64 {
        let axis = &self.axes[row];
        let mut gone = 0.0;
        for (w, h) in axis.points.windows(2).zip(&axis.half_width) {
            gone += w[0].distance(w[1]);
            if gone >= at {
                return *h;
            }
        }
        axis.half_width.last().copied().unwrap_or(0.0)
    }

    /// Returns the axis whose surface is nearest to `p` within `r`, the place on it and the distance of its surface.
    pub(crate) fn nearest(&self, p: DVec2, r: f64) -> Option<(Attachment, f64)> {
        let row = self.nearest_axis(p, r)?;
        let c = closest_on_polyline(&self.axes[row].points, p)?;
        let surface = (c.distance - self.half_width(row, c.at)).max(0.0);
        Some((Attachment { axis: row, at: c.at }, surface))
    }

    /// Returns only the distance of [`Forest::nearest`].
    fn clearance(&self, p: DVec2, r: f64) -> Option<f64> {
        let row = self.nearest_axis(p, r)?;
        if self.axes[row].half_width.is_empty() {
            return distance_to_polyline(&self.axes[row].points, p);
        }
        self.nearest(p, r).map(|found| found.1)
    }

    /// Returns the axis with the point whose surface is nearest to `p` within `r`.
    fn nearest_axis(&self, p: DVec2, r: f64) -> Option<usize> {
        // A thick trunk's middle line is farther away than its surface.
        let thick = self.axes.iter().take(64).any(|a| !a.half_width.is_empty());
        let thickest = if thick { THICKEST.min(self.thickest) } else { 0.0 };
        let find = |r: f64| {
            let mut best: Option<(f64, usize)> = None;
            self.near.visit(p, r + thickest, |e, d| {
                let surface = if thick { d - self.half_width(e.owner, e.at) } else { d };
                if surface <= r && best.is_none_or(|(b, _)| surface < b) {
                    best = Some((surface, e.owner));
                }
            });
            best
        };
        // A thicker axis may be nearer than the one that was found first.
        let found = if self.thickest > THICKEST { find(r) } else { self.near.outwards(r, find) };
        found.map(|found| found.1)
    }

    /// Returns the length of an axis.
    pub(crate) fn length(&self, row: usize) -> f64 {
        polyline_length(&self.axes[row].points)
    }

    /// Puts an axis's tip at `end` and goes on indexing it there.
    pub(crate) fn extend(&mut self, row: usize, more: &[DVec2], end_width: f64) {
        let axis = &mut self.axes[row];
        let from = axis.half_width.last().copied();
        for (i, &p) in (1_u32..).zip(more) {
            axis.points.push(p);
            if let Some(w) = from {
                let t = f64::from(i) / f64::from(u32::try_from(more.len()).unwrap_or(1).max(1));
                axis.half_width.push(w + (end_width - w) * t);
            }
        }
        self.thickest = axis.half_width.iter().copied().fold(self.thickest, f64::max);
        let points = axis.points.clone();
        self.near.add_line(row, &points[points.len().saturating_sub(more.len() + 1)..]);
    }

    /// Builds the hierarchy of `lines` on top of the axes that exist already.
    pub(crate) fn grow(&mut self, mut lines: Vec<Line>, hints: &Hints) {
        lines.retain(|l| l.points.len() >= 2 && polyline_length(&l.points) > NO_LENGTH);
        let length: Vec<f64> = lines.iter().map(|l| polyline_length(&l.points)).collect();
        let mut order: Vec<usize> = (0..lines.len()).collect();
        base::sort_by(&mut order, |&a, &b| length[b].total_cmp(&length[a]).then(a.cmp(&b)));
        // Dense drawings are drawn with finer gaps; this also bounds how many lines an end can touch.
        #[expect(clippy::cast_precision_loss, reason = "a count")]
        let touch = TOUCH.min(0.7 / (lines.len() as f64).sqrt());
        let contacts = contacts(&lines, &order, touch);
        let floor = lines.iter().flat_map(|l| l.points.iter()).map(|p| p.y).fold(f64::INFINITY, f64::min);
        let mut row_of: Vec<Option<usize>> = vec![None; lines.len()];
        let mut done = vec![false; lines.len()];
        let mut frontier = self.attach_to_bodies(&lines, &mut done, &mut row_of, touch);
        let seeds = seed_order(&lines, &length, &order, hints, floor);
        for seed in seeds {
            self.grow_levels(&lines, &contacts, (&mut frontier, hints), &mut done, &mut row_of, touch);
            if done[seed] {
                continue;
            }
            done[seed] = true;
            let row = if lines.len() > MOST_LED {
                self.push(standing(&lines[seed].points, hints), Vec::new(), None, lines[seed].source)
            } else {
                self.seed(&lines[seed], hints, touch)
            };
            if let Some(row) = row {
                row_of[seed] = Some(row);
                frontier = vec![seed];
            }
        }
        self.grow_levels(&lines, &contacts, (&mut frontier, hints), &mut done, &mut row_of, touch);
    }

    /// Adds level 1 of an outlined trunk: the lines whose ends touch it.
    fn attach_to_bodies(
        &mut self,
        lines: &[Line],
        done: &mut [bool],
        row_of: &mut [Option<usize>],
        touch: f64,
    ) -> Vec<usize> {
        let bodies = self.clone();
        let mut frontier = Vec::new();
        if bodies.axes.is_empty() {
            return frontier;
        }
        for (j, line) in lines.iter().enumerate() {
            let found = [false, true]
                .into_iter()
                .filter_map(|last| bodies.nearest(end(&line.points, last), touch).map(|(a, d)| (d, last, a)))
                .min_by(|x, y| x.0.total_cmp(&y.0));
            if let Some((_, last, bearer)) = found {
                done[j] = true;
                row_of[j] = self.push(oriented(&line.points, last), Vec::new(), Some(bearer), line.source);
                frontier.push(j);
            }
        }
        frontier
    }

    fn grow_levels(
        &mut self,
        lines: &[Line],
        contacts: &[Vec<Contact>],
        (frontier, hints): (&mut Vec<usize>, &Hints),
        done: &mut [bool],
        row_of: &mut [Option<usize>],
        touch: f64,
    ) {
        while !frontier.is_empty() {
            // The nearest line of the last level bears each new line.
            let mut best: base::LiteMap<usize, (f64, bool, usize)> = base::LiteMap::new();
            for &i in frontier.iter() {
                for c in &contacts[i] {
                    if !done[c.line] && best.get(&c.line).is_none_or(|b| c.distance < b.0) {
                        best.insert(c.line, (c.distance, c.last, i));
                    }
                }
            }
            let mut next = Vec::new();
            let mut below: base::LiteMap<usize, Vec<(usize, bool)>> = base::LiteMap::new();
            for (j, (_, last, i)) in best {
                done[j] = true;
                let Some(row) = row_of[i] else { continue };
                match self.bear(row, &lines[j], last, touch) {
                    Borne::Axis(new) => row_of[j] = new,
                    Borne::Below => below.entry(row).or_default().push((j, last)),
                }
                next.push(j);
            }
            for (row, list) in below {
                self.below(row, &list, (lines, hints), row_of);
            }
            *frontier = next;
        }
    }

    /// Adds a line that touches `row` with one end.
    fn bear(&mut self, row: usize, line: &Line, last: bool, touch: f64) -> Borne {
        let points = oriented(&line.points, last);
        let Some(at) = closest_on_polyline(&self.axes[row].points, points[0]) else {
            return Borne::Axis(None);
        };
        let stands = self.axes[row].bearer.is_none() && self.axes[row].half_width.is_empty();
        if stands && at.at < touch.max(FOOT * self.length(row)) {
            let base = self.axes[row].points[0].y;
            let far = points[points.len() - 1].y;
            let top = points.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
            if far < base - DOWN * polyline_length(&points) && top < base + touch {
                return Borne::Below;
            }
            // Several stems from one foot: each stands on the ground.
            return Borne::Axis(self.push(points, Vec::new(), None, line.source));
        }
        Borne::Axis(self.push(points, Vec::new(), Some(Attachment { axis: row, at: at.at }), line.source))
    }

    /// Adds lines that go down from the foot of `row`: one is the rest of the stem, several are roots, and so is a
    /// line that goes down from the ground.
    fn below(
        &mut self,
        row: usize,
        list: &[(usize, bool)],
        (lines, hints): (&[Line], &Hints),
        row_of: &mut [Option<usize>],
    ) {
        let soil = |p: DVec2| hints.soil.nearest(p, TOUCH, |_| true).is_some();
        let taproot = |j: usize, last: bool| {
            let p = &lines[j].points;
            soil(end(p, last)) && !soil(end(p, !last))
        };
        if let &[(j, last)] = list
            && !taproot(j, last)
            && self.joins < MOST_JOINS
        {
            self.joins += 1;
            let mut lower = oriented(&lines[j].points, last);
            lower.reverse();
            let added =
                polyline_length(&lower) + lower.last().map_or(0.0, |p| p.distance(self.axes[row].points[0]));
            lower.extend_from_slice(&self.axes[row].points);
            self.axes[row].points = lower;
            for axis in &mut self.axes {
                if let Some(b) = axis.bearer.as_mut().filter(|b| b.axis == row) {
                    b.at += added;
                }
            }
            let points = self.axes[row].points.clone();
            self.near.add_line(row, &points);
            row_of[j] = Some(row);
            return;
        }
        for &(j, last) in list {
            let bearer = Some(Attachment { axis: row, at: 0.0 });
            row_of[j] = self.push(oriented(&lines[j].points, last), Vec::new(), bearer, lines[j].source);
            if let Some(new) = row_of[j] {
                self.axes[new].kind = AxisKind::Root;
            }
        }
    }

    /// Adds a line that no end leads to: it crosses an axis, is led to the nearest, or stands on its own.
    fn seed(&mut self, line: &Line, hints: &Hints, touch: f64) -> Option<usize> {
        if self.axes.is_empty() {
            return self.push(standing(&line.points, hints), Vec::new(), None, line.source);
        }
        let length = polyline_length(&line.points);
        if let Some(cut) = self.crossing(&line.points, 0.5 * touch) {
            let (a, b) = (oriented(&line.points[..=cut], true), line.points[cut..].to_vec());
            let bearer = self.nearest(line.points[cut], touch).map(|(b, _)| b);
            let rows = [a, b].map(|part| {
                let long = polyline_length(&part) > OVERSHOOT;
                long.then(|| self.push(part, Vec::new(), bearer, line.source)).flatten()
            });
            if let Some(row) = rows.into_iter().flatten().next() {
                return Some(row);
            }
        }
        let points = standing(&line.points, hints);
        if hints.soil.nearest(points[0], TOUCH, |_| true).is_some() {
            return self.push(points, Vec::new(), None, line.source);
        }
        let found = [false, true]
            .into_iter()
            .filter_map(|last| {
                let p = end(&line.points, last);
                let (a, d) = self.nearest(p, REACH.min(0.5 * length))?;
                // A branch leaves its bearer upwards or sideways rather than hanging from it.
                Some((d + if p.y > end(&line.points, !last).y + 0.5 * length { 0.03 } else { 0.0 }, last, a))
            })
            .min_by(|x, y| x.0.total_cmp(&y.0));
        match found {
            // Neighbours on the ground and lines as long as the bearer are stems of their own.
            Some((_, last, bearer))
                if bearer.at > NEIGHBOUR * self.length(bearer.axis)
                    && length < AS_LONG * self.length(bearer.axis) =>
            {
                self.push(oriented(&line.points, last), Vec::new(), Some(bearer), line.source)
            }
            _ => self.push(points, Vec::new(), None, line.source),
        }
    }

    /// Returns the inner point at which a line crosses an axis, if it does.
    fn crossing(&self, points: &[DVec2], near: f64) -> Option<usize> {
        let n = points.len();
        let stride = n.div_ceil(100).max(1);
        (1..n.saturating_sub(1))
            .step_by(stride)
            .filter_map(|i| self.clearance(points[i], near).map(|d| (d, i)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, i)| i)
    }
}

enum Borne {
    Axis(Option<usize>),
    Below,
}

fn end(points: &[DVec2], last: bool) -> DVec2 {
    if last { points[points.len() - 1] } else { points[0] }
}

/// Returns the line with its `last` (or else first) point first.
pub(crate) fn oriented(points: &[DVec2], last: bool) -> Vec<DVec2> {
    let mut points = points.to_vec();
    if last {
        points.reverse();
    }
    points
}

/// Returns a line on the ground, base first: the base is in the soil, or away from leaves and flowers, or lower.
fn standing(points: &[DVec2], hints: &Hints) -> Vec<DVec2> {
    let near = |index: &Near, last| index.nearest(end(points, last), TOUCH, |_| true).is_some();
    let soil = [near(&hints.soil, false), near(&hints.soil, true)];
    let organ = [near(&hints.organs, false), near(&hints.organs, true)];
    let last = if soil[0] != soil[1] {
        soil[1]
    } else if organ[0] != organ[1] {
        organ[0]
    } else {
        end(points, true).y < end(points, false).y
    };
    oriented(points, last)
}

/// For each line finds the ends of other lines that touch it, nearest first.
fn contacts(lines: &[Line], order: &[usize], touch: f64) -> Vec<Vec<Contact>> {
    let mut near = Near::new(touch);
    for &i in order {
        near.add_line(i, &lines[i].points);
    }
    let mut found: Vec<Vec<Contact>> = vec![Vec::new(); lines.len()];
    // A little larger than within reach.
    let reach = touch + ROUNDING;
    let boxes: Vec<(DVec2, DVec2)> = lines
        .iter()
        .map(|line| {
            bounds(&line.points).map_or((DVec2::ZERO, DVec2::ZERO), |(lo, hi)| (lo - reach, hi + reach))
        })
        .collect();
    for (j, line) in lines.iter().enumerate() {
        for last in [false, true] {
            let p = end(&line.points, last);
            // The index holds points half a cell apart.
            let mut hits: Vec<(usize, f64)> = Vec::new();
            near.visit(p, 1.3 * touch, |e, d| match hits.iter_mut().rev().find(|h| h.0 == e.owner) {
                Some(hit) => hit.1 = hit.1.min(d),
                None if e.owner != j => hits.push((e.owner, d)),
                None => {}
            });
            base::sort_by(&mut hits, |a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            for (i, _) in hits.into_iter().take(MOST_CONTACTS) {
                let (lo, hi) = boxes[i];
                if p.x < lo.x || p.y < lo.y || p.x > hi.x || p.y > hi.y {
                    continue;
                }
                if let Some(distance) = distance_to_polyline(&lines[i].points, p).filter(|d| *d <= touch) {
                    found[i].push(Contact { line: j, last, distance });
                }
            }
        }
    }
    found
}

/// Orders lines by length, the longest first; a line that stands on the ground counts half as much again.
fn seed_order(lines: &[Line], length: &[f64], order: &[usize], hints: &Hints, floor: f64) -> Vec<usize> {
    let score: Vec<f64> = lines
        .iter()
        .zip(length)
        .map(|(line, l)| {
            let stands = [false, true].into_iter().any(|last| {
                let p = end(&line.points, last);
                p.y < floor + WELL_SHORT || hints.soil.nearest(p, TOUCH, |_| true).is_some()
            });
            if stands { 1.5 * l } else { *l }
        })
        .collect();
    let mut seeds = order.to_vec();
    base::sort_by(&mut seeds, |&a, &b| score[b].total_cmp(&score[a]).then(a.cmp(&b)));
    seeds
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(from: (f64, f64), to: (f64, f64)) -> Line {
        let (a, b) = (DVec2::from(from), DVec2::from(to));
        Line { points: (0..=40).map(|i| a.lerp(b, f64::from(i) / 40.0)).collect(), source: None }
    }

    fn grown(lines: Vec<Line>) -> Forest {
        let mut forest = Forest::new();
        forest.grow(lines, &Hints::default());
        forest
    }

    #[test]
    fn a_tree_of_lines_has_its_levels() {
        // Drawn twigs first, the trunk last and from the top down.
        let f = grown(vec![
            line((0.7, 0.7), (0.75, 0.85)),
            line((0.8, 0.8), (0.51, 0.5)),
            line((0.49, 0.4), (0.2, 0.6)),
            line((0.5, 0.9), (0.5, 0.0)),
        ]);
        assert_eq!(f.order, [0, 1, 1, 2]);
        assert_eq!(f.axes[0].points[0], DVec2::new(0.5, 0.0));
        assert!(f.axes.iter().skip(1).all(|a| a.bearer.is_some()), "all borne");
        let twig = f.axes[3].bearer.expect("borne");
        let foot = point_at(&f.axes[twig.axis].points, twig.at).expect("on it");
        assert!(foot.distance(f.axes[3].points[0]) < 1e-9, "the base lies on the bearer");
    }

    #[test]
    fn stems_from_one_foot_all_stand_on_the_ground() {
        let f = grown(vec![
            line((0.5, 0.0), (0.5, 0.9)),
            line((0.5, 0.01), (0.8, 0.7)),
            line((0.2, 0.6), (0.51, 0.0)),
        ]);
        assert_eq!(f.order, [0, 0, 0]);
        assert!(f.axes.iter().all(|a| a.points[0].y < 0.02), "feet first");
    }

    #[test]
    fn a_crossing_line_becomes_two_branches() {
        let f = grown(vec![line((0.5, 0.0), (0.5, 0.9)), line((0.2, 0.7), (0.8, 0.6))]);
        assert_eq!(f.order, [0, 1, 1]);
    }

    #[test]
    fn a_stem_in_two_strokes_is_one_and_lines_below_a_foot_are_roots() {
        let f = grown(vec![
            line((0.5, 0.4), (0.5, 1.0)),
            line((0.5, 0.0), (0.5, 0.39)),
            line((0.5, 0.2), (0.7, 0.3)),
        ]);
        assert_eq!(f.order, [0, 1]);
        assert!(
            f.axes[0].points[0].y < 1e-9 && f.axes[1].bearer.is_some_and(|b| (b.at - 0.2).abs() < 0.01),
            "{f:?}"
        );
        let f = grown(vec![
            line((0.5, 0.3), (0.5, 1.0)),
            line((0.5, 0.3), (0.3, 0.1)),
            line((0.5, 0.3), (0.6, 0.05)),
            line((0.51, 0.3), (0.8, 0.2)),
        ]);
        let roots = f.axes.iter().filter(|a| a.kind == AxisKind::Root).count();
        assert!(roots >= 2, "{:?}", f.axes.iter().map(|a| (a.kind, a.bearer)).collect::<Vec<_>>());
    }

    #[test]
    fn a_hundred_thousand_lines_alike_end_soon() {
        let f = grown(vec![line((0.5, 0.0), (0.5, 0.9)); 3_000]);
        assert!(!f.axes.is_empty() && f.axes.len() <= 6_000);
    }
}
