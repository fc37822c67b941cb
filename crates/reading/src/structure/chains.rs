//! Finds blades whose outline was drawn in several strokes, from end to end: both sides of a leaf, which meet at its
//! tip, or one stroke for each lobe.
//!
//! `ends of lines -> partners -> chains -> outlines`

use geom::contains;
use glam::DVec2;
use ink::{Ink, StrokeMode};

use super::sheet::{Form, Sheet, convexity, goes_round};
use crate::near::Near;

/// Limits of lines that meet and form the outline of one blade. Lengths are in ink units (the drawing's diagonal is
/// 1).
struct ChainLimits {
    /// Two ends meet if they are nearer than this.
    meet: f64,
    /// Least length of each line.
    length: f64,
    /// Most lines of one outline.
    most: usize,
    /// The outline has at least this share of the area of its hull.
    convex: f64,
    /// Most ends of lines outside the outline that lie on it: an axis bears more.
    borne: usize,
    /// Other lines may end where two meet if more than this share of their points lies in the outline: midribs do.
    inside: f64,
}

const LIMITS: ChainLimits =
    ChainLimits { meet: 0.012, length: 0.02, most: 6, convex: 0.6, borne: 10, inside: 0.8 };

/// An outline in several strokes.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    /// Their rows, the longest first.
    pub(crate) rows: Vec<usize>,
    pub(crate) outline: Vec<DVec2>,
    /// Area over that of its hull.
    convexity: f64,
}

/// A line and whether it is followed backwards.
#[derive(Clone, Copy, Debug)]
struct Step {
    row: usize,
    is_turned: bool,
}

/// Finds the blades of a drawing whose outlines were drawn in several strokes. `may_be`: whether a row may be part of
/// one. Cost: pairs of ends of lines, and the strokes for each chain.
pub(crate) fn chains(ink: &Ink, sheet: &Sheet, may_be: impl Fn(usize) -> bool) -> Vec<Chain> {
    let is_part = |&k: &usize| {
        let (facts, stroke) = (&sheet.facts[k], &ink.strokes[k]);
        facts.form == Form::Line
            && facts.holder.is_none()
            && stroke.mode == StrokeMode::Parts
            && stroke.length > LIMITS.length
            && may_be(k)
    };
    let rows: Vec<usize> = (0..ink.strokes.len()).filter(is_part).collect();
    let mut near = Near::new(LIMITS.meet);
    ink.strokes.iter().enumerate().for_each(|(k, s)| near.add_line(k, &s.points));
    let partners = Partners::new(ink, &rows);
    let mut found: Vec<Chain> = Vec::new();
    for &row in &rows {
        for is_turned in [false, true] {
            found.extend(outlines_from(ink, &near, &partners, Step { row, is_turned }));
        }
    }
    // A line belongs to the outline that is most like a blade; if several are, to that of more lines.
    base::sort_by(&mut found, |a, b| {
        b.convexity.total_cmp(&a.convexity).then(b.rows.len().cmp(&a.rows.len())).then(a.rows.cmp(&b.rows))
    });
    let mut kept: Vec<Chain> = Vec::new();
    for chain in found {
        if !kept.iter().any(|other| other.rows.iter().any(|k| chain.rows.contains(k))) {
            kept.push(chain);
        }
    }
    kept
}

/// Ends of lines that are nearest to one another.
struct Partners {
    /// The line that continues from the start or the end of each line, by rows.
    next: base::LiteMap<(usize, bool), Step>,
}

impl Partners {
    fn new(ink: &Ink, rows: &[usize]) -> Self {
        let ends: Vec<(usize, bool, DVec2)> = rows
            .iter()
            .flat_map(|&k| {
                let points = &ink.strokes[k].points;
                [(k, false, points[0]), (k, true, points[points.len() - 1])]
            })
            .collect();
        let nearest = |i: usize| {
            let others = (0..ends.len()).filter(|&j| ends[j].0 != ends[i].0);
            let off = |j: &usize| ends[*j].2.distance(ends[i].2);
            others.filter(|j| off(j) < LIMITS.meet).min_by(|a, b| off(a).total_cmp(&off(b)))
        };
        let nearest: Vec<Option<usize>> = (0..ends.len()).map(nearest).collect();
        let mut next = base::LiteMap::new();
        for (i, partner) in nearest.iter().enumerate() {
            if let Some(j) = partner.filter(|&j| nearest[j] == Some(i)) {
                let (row, is_end, _) = ends[j];
                // A line that is entered at its end is followed backwards.
                next.insert((ends[i].0, ends[i].1), Step { row, is_turned: is_end });
            }
        }
        Self { next }
    }

    fn after(&self, step: Step) -> Option<Step> {
        self.next.get(&(step.row, !step.is_turned)).copied()
    }
}

/// Returns the outlines of blades that begin with a line.
fn outlines_from(ink: &Ink, near: &Near, partners: &Partners, first: Step) -> Vec<Chain> {
    let mut steps = vec![first];
    let mut outline = followed(ink, first);
    let mut found = Vec::new();
    while steps.len() < LIMITS.most
        && let Some(next) = steps.last().and_then(|&last| partners.after(last))
        && !steps.iter().any(|s| s.row == next.row)
    {
        steps.push(next);
        outline.extend(followed(ink, next));
        if let Some(convexity) = blade_convexity(&outline)
            && are_free(ink, near, &steps, &outline)
        {
            let mut rows: Vec<usize> = steps.iter().map(|s| s.row).collect();
            base::sort_by(&mut rows, |&a, &b| {
                ink.strokes[b].length.total_cmp(&ink.strokes[a].length).then(a.cmp(&b))
            });
            found.push(Chain { rows, outline: outline.clone(), convexity });
        }
    }
    found
}

fn followed(ink: &Ink, step: Step) -> Vec<DVec2> {
    let points = &ink.strokes[step.row].points;
    if step.is_turned { points.iter().rev().copied().collect() } else { points.clone() }
}

/// Returns the convexity of an outline, if it is that of a blade.
fn blade_convexity(outline: &[DVec2]) -> Option<f64> {
    let own = convexity(outline);
    (own > LIMITS.convex && goes_round(outline, geom::polyline_length(outline))).then_some(own)
}

/// Whether only lines in the outline end where its lines meet, and it bears little outside.
fn are_free(ink: &Ink, near: &Near, steps: &[Step], outline: &[DVec2]) -> bool {
    let is_other = |k: usize| {
        let points = &ink.strokes[k].points;
        let inside = points.iter().filter(|p| contains(outline, **p)).count();
        !steps.iter().any(|s| s.row == k) && (inside as f64) <= LIMITS.inside * points.len() as f64
    };
    let mut joints = steps.iter().skip(1).filter_map(|&s| followed(ink, s).first().copied());
    joints.all(|p| near.nearest(p, super::LIMITS.junction, is_other).is_none())
        && ends_on(ink, outline, is_other) <= LIMITS.borne
}

/// Counts the ends of strokes that lie on an outline.
fn ends_on(ink: &Ink, outline: &[DVec2], is_other: impl Fn(usize) -> bool) -> usize {
    let is_on = |p: DVec2| geom::distance_to_polyline(outline, p).is_some_and(|d| d < super::LIMITS.junction);
    let others = (0..ink.strokes.len()).filter(|&k| is_other(k)).map(|k| &ink.strokes[k].points);
    others.map(|points| [points[0], points[points.len() - 1]].into_iter().filter(|&p| is_on(p)).count()).sum()
}
