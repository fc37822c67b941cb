//! Colour under lines, and shade over colour.

use glam::DVec2;

use super::{Change, Extent, Figure, Fill, LIMITS, Work, is_closed, places, some_of};
use crate::InkSample;

/// An area in the colour of another one is part of it if it stands out by at most this share of the drawing's diagonal,
const STANDS_OUT: f64 = 0.04;
/// if more than this share of its points lie in the other one: a rim has half of them there,
const PART_INSIDE: f64 = 0.35;
/// and if the other one is this many times larger: dots side by side are alike.
const MUCH_LARGER: f64 = 2.0;
/// Most areas times sub-paths of areas for which parts and tones are looked for.
const MOST_MERGED: usize = 1 << 16;
/// Most points of an outline in which parts are looked for.
const ROUND: usize = 512;
/// Number of points of an area that are compared with an outline.
const COMPARED: usize = 32;
/// An area under an outline has at least this share of its box.
const SAME_SIZE: f64 = 0.6;
/// Least share of the points of a shade that lie within the shaded outline.
const WITHIN: f64 = 0.85;
/// Area of an opaque shade, as a share of the area that it shades.
const PART: core::ops::Range<f64> = 0.1..0.85;
/// Least share of the points of an opaque shade that follow the outline.
const ALONG: f64 = 0.3;
/// That share for a shade in the hue of what it lies on.
const TINT_ALONG: f64 = 0.12;
/// Least value of each channel of a gloss.
const GLOSS: u8 = 235;
/// A small shade or gloss has the hue of what it lies on, within this, degrees,
const SAME_HUE: f64 = 8.0;
/// where both have channels that differ by at least this: grey has no hue.
const HUED: u8 = 40;
/// Greys of which each channel is at least this are tones of white.
const PALE: u8 = 120;

/// Returns the hue of a colour in degrees, 0 to 360, and the difference between its largest and its smallest channel: 0 for
/// grey, which has hue 0.
pub fn hue(c: [u8; 3]) -> (f64, u8) {
    let (low, high) = c.iter().fold((u8::MAX, 0), |(l, h), &x| (l.min(x), h.max(x)));
    let [r, g, b] = c.map(f64::from);
    let span = high - low;
    if span == 0 {
        return (0.0, 0);
    }
    let sixth = if c[0] == high {
        (g - b) / f64::from(span)
    } else if c[1] == high {
        2.0 + (b - r) / f64::from(span)
    } else {
        4.0 + (r - g) / f64::from(span)
    };
    ((60.0 * sixth).rem_euclid(360.0), span)
}

/// Returns the angle between two hues, degrees: 0 to 180.
pub fn hues_apart(a: f64, b: f64) -> f64 {
    let apart = (a - b).abs();
    apart.min(360.0 - apart)
}

/// A closed outline of a figure.
struct Outline {
    figure: usize,
    points: Vec<DVec2>,
    extent: Extent,
    area: f64,
}

impl Work {
    /// Removes areas that cannot be told from a larger area of their colour, its parts or a rim round it; and tones of
    /// an area on it. Cost: bounded.
    pub(super) fn merge_areas_of_one_colour(&mut self) {
        let outlines = self.outlines();
        let areas: Vec<&Outline> = outlines.iter().filter(|o| is_area(&self.figures[o.figure])).collect();
        let lines: usize = areas.iter().map(|a| self.figures[a.figure].lines.len()).sum();
        if areas.len() * lines > MOST_MERGED {
            return;
        }
        let slack = STANDS_OUT * self.diagonal();
        let coarse: Vec<Vec<DVec2>> = areas.iter().map(|a| some_of(&a.points, ROUND).collect()).collect();
        let (mut parts, mut tones) = (self.none_out(), self.none_out());
        for part in &areas {
            let larger = || areas.iter().zip(&coarse).filter(|(whole, _)| whole.area > part.area);
            if larger().any(|(whole, outline)| self.is_part_of(part, (whole, outline), slack)) {
                parts[part.figure].fill(true);
            } else if larger().any(|(below, _)| self.is_tone_of(part, below)) {
                tones[part.figure].fill(true);
            }
        }
        let (merged, shades) = (count_of(&parts), count_of(&tones));
        if self.take_out(&either(parts, tones)) > 0 {
            self.note(Change::DrawnTwice, merged);
            self.note(Change::Shade, shades);
        }
    }

    /// Whether an area cannot be told from a larger one of its colour, of which `outline` has some points.
    fn is_part_of(&self, part: &Outline, (whole, outline): (&Outline, &[DVec2]), slack: f64) -> bool {
        let look = |o: &Outline| self.figures[o.figure].fill.map(|f| (f.color, f.opacity));
        let has_colour = look(part).is_some_and(|(color, _)| color.is_some());
        let lines = &self.figures[part.figure].lines;
        let is_held =
            |line: &Vec<InkSample>| Extent::from_line(line).is_some_and(|e| whole.extent.holds(e, slack));
        if !has_colour
            || look(part) != look(whole)
            || whole.area < MUCH_LARGER * part.area
            || !lines.iter().all(is_held)
        {
            return false;
        }
        let points: Vec<DVec2> =
            lines.iter().flat_map(|line| some_of(&places(line), COMPARED).collect::<Vec<_>>()).collect();
        let off = |p: DVec2| geom::closest_on_polyline(outline, p).map_or(0.0, |c| c.point.distance(p));
        share(&points, |p| geom::contains(outline, p)) > PART_INSIDE
            && points.iter().all(|&p| geom::contains(outline, p) || off(p) <= slack)
    }

    /// Whether an area is a tone of one that was painted before it.
    fn is_tone_of(&self, part: &Outline, below: &Outline) -> bool {
        let color = |o: &Outline| self.figures[o.figure].fill.and_then(|f| f.color);
        let is_tone = color(part).zip(color(below)).is_some_and(|(own, below)| is_tint(own, below));
        below.figure < part.figure && is_tone && self.is_shade(part, below)
    }

    /// Gives lines the colour of the areas under them and removes these; removes areas within others that shade them.
    pub(super) fn colour_lines(&mut self) {
        for figure in &mut self.figures {
            if let Some(Fill { color: Some(color), said: true, opacity, .. }) = figure.fill
                && figure.lined
                && opacity > 0.0
                && color.iter().any(|c| *c < LIMITS.white)
            {
                figure.like.color = Some(color);
            }
        }
        let outlines = self.outlines();
        let areas: Vec<&Outline> = outlines.iter().filter(|o| is_area(&self.figures[o.figure])).collect();
        if areas.is_empty() || areas.len() * outlines.len() > LIMITS.pairs {
            return;
        }
        let mut color_of: Vec<(usize, [u8; 3])> = Vec::new();
        let (mut under, mut shade) = (self.none_out(), self.none_out());
        for area in &areas {
            let near = || outlines.iter().filter(|o| o.figure != area.figure && o.extent.meets(area.extent));
            let covers = |o: &Outline| !self.is_translucent(o) || self.is_translucent(area);
            let above = |o: &&Outline| self.figures[o.figure].lined || o.figure > area.figure && covers(o);
            let line = near().find(|o| above(o) && lies_under(area, o));
            if let Some(line) = line {
                // Of two areas, the upper one is visible.
                let lined = self.figures[line.figure].lined;
                if let Some(color) = self.figures[area.figure].fill.and_then(|f| f.color).filter(|_| lined) {
                    color_of.push((line.figure, color));
                }
                under[area.figure].fill(true);
            } else if near().any(|o| self.is_shade(area, o)) {
                shade[area.figure].fill(true);
            }
        }
        // The lowest area is the colour; the areas above it shade it.
        for (figure, color) in color_of.into_iter().rev() {
            if color.iter().any(|c| *c < LIMITS.white) {
                self.figures[figure].like.color = Some(color);
            }
        }
        let colours = count_of(&under);
        let shades = count_of(&shade);
        if self.take_out(&either(under, shade)) > 0 {
            self.note(Change::Colour, colours);
            self.note(Change::Shade, shades);
        }
    }

    /// Returns the first sub-path of each figure, if it is closed; an area is.
    fn outlines(&self) -> Vec<Outline> {
        let outline = |(figure, f): (usize, &Figure)| {
            let line = f.lines.first()?;
            let extent = Extent::from_line(line)?;
            let points = places(line);
            let area = geom::signed_area(&points).abs();
            ((is_closed(line) || is_area(f)) && area > 0.0).then_some(Outline {
                figure,
                points,
                extent,
                area,
            })
        };
        self.figures.iter().enumerate().filter_map(outline).collect()
    }

    fn is_translucent(&self, area: &Outline) -> bool {
        self.figures[area.figure].fill.is_some_and(|f| f.opacity < LIMITS.translucent)
    }

    /// Whether an area shades what an outline encloses: see-through and within it, or a part of it along its edge.
    fn is_shade(&self, area: &Outline, of: &Outline) -> bool {
        let below = &self.figures[of.figure];
        let fill = self.figures[area.figure].fill;
        let translucent = self.is_translucent(area);
        let larger = area.area <= if translucent { 1.1 } else { PART.end } * of.area;
        let slack = 0.1 * of.extent.size().max_element();
        if !(larger && of.extent.holds(area.extent, slack)) || (below.fill.is_none() && !below.lined) {
            return false;
        }
        let within = |p: DVec2| {
            geom::contains(&of.points, p)
                || geom::closest_on_polyline(&of.points, p)
                    .is_some_and(|c| c.point.distance(p) <= 0.3 * slack)
        };
        let points: Vec<DVec2> = some_of(&area.points, COMPARED).collect();
        if share(&points, within) < WITHIN {
            return false;
        }
        let edge = 0.04 * of.extent.size().min_element();
        let on_edge =
            |p: DVec2| geom::closest_on_polyline(&of.points, p).is_some_and(|c| c.point.distance(p) <= edge);
        let small = area.area < PART.start * of.area;
        let colors = fill.and_then(|f| f.color).zip(below.color_seen());
        let tint = colors.is_some_and(|(own, below)| is_tint(own, below));
        let along = if tint { TINT_ALONG } else { ALONG };
        translucent
            || (!small && share(&points, on_edge) >= along)
            || (small && (tint || colors.is_some_and(|(own, below)| is_gloss(own, below))))
    }
}

/// Whether a colour is white and the other is not.
fn is_gloss(own: [u8; 3], below: [u8; 3]) -> bool {
    let is_white = |c: [u8; 3]| c.iter().all(|c| *c >= GLOSS);
    is_white(own) && !is_white(below)
}

/// Whether a colour is a lighter or darker tone of another.
fn is_tint(own: [u8; 3], below: [u8; 3]) -> bool {
    let is_pale = |c: [u8; 3]| hue(c).1 < HUED && c.iter().all(|c| *c >= PALE);
    let [(a, own_span), (b, below_span)] = [own, below].map(hue);
    own_span.min(below_span) >= HUED && hues_apart(a, b) < SAME_HUE || is_pale(own) && is_pale(below)
}

/// Returns what is left out by one or the other.
fn either(mut out: Vec<Vec<bool>>, more: Vec<Vec<bool>>) -> Vec<Vec<bool>> {
    for (out, more) in out.iter_mut().zip(more) {
        out.iter_mut().zip(more).for_each(|(out, more)| *out |= more);
    }
    out
}

fn count_of(out: &[Vec<bool>]) -> usize {
    out.iter().flatten().filter(|o| **o).count()
}

fn is_area(figure: &Figure) -> bool {
    !figure.lined && figure.fill.is_some()
}

#[expect(clippy::cast_precision_loss, reason = "a few points")]
fn share(points: &[DVec2], holds: impl Fn(DVec2) -> bool) -> f64 {
    points.iter().filter(|p| holds(**p)).count() as f64 / points.len().max(1) as f64
}

/// Whether a coloured area has the form of an outline and lies under it, up to a small shift.
fn lies_under(area: &Outline, line: &Outline) -> bool {
    let (a, b) = (area.extent, line.extent);
    let common = a.hi.min(b.hi) - a.lo.max(b.lo);
    let common = common.x.max(0.0) * common.y.max(0.0);
    if common < SAME_SIZE * (a.area() + b.area() - common) {
        return false;
    }
    let shift = b.middle() - a.middle();
    let near = LIMITS.under * b.size().min_element();
    if shift.length() > 2.0 * near {
        return false;
    }
    let by = |p: DVec2| {
        geom::closest_on_polyline(&line.points, p + shift)
            .is_some_and(|c| c.point.distance(p + shift) <= near)
    };
    let points: Vec<DVec2> = some_of(&area.points, COMPARED).collect();
    share(&points, by) >= WITHIN
}
