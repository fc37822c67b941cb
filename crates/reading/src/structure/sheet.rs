//! The facts of each stroke: its form, its outline, the outline that holds it, the strokes that it holds.

use base::ops;
use geom::{bounds, contains, convex_hull, distance_to_polyline, pca2, polyline_length, signed_area};
use glam::DVec2;
use ink::{Ink, InkStroke, StrokeMode};

use super::LIMITS;
use super::hidden::complete;
use crate::blade::nearest_on_ring;
use crate::near::Near;

/// Points of a stroke that are looked at to find its share in an outline.
const PLACES: usize = 9;

/// How a stroke lies on the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// It is closed.
    Ring,
    /// Both ends stop on other strokes and it bulges between them: it goes on behind those.
    Bay,
    /// It encloses nothing.
    Line,
}

/// An outline with its measures.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    /// Its points; for a bay with the hidden part.
    pub(crate) points: Vec<DVec2>,
    low: DVec2,
    high: DVec2,
    /// Share of the squared diagonal of the drawing, at least 0.
    pub(crate) area: f64,
    /// 4 pi area / perimeter^2: 1 for a circle.
    pub(crate) roundness: f64,
    /// Width over length, by the second moments of its points: 0 to 1.
    pub(crate) slenderness: f64,
}

impl Outline {
    fn new(points: Vec<DVec2>) -> Option<Self> {
        let (low, high) = bounds(&points)?;
        let area = signed_area(&points).abs();
        let closing = points.first()?.distance(*points.last()?);
        let perimeter = polyline_length(&points) + closing;
        let roundness = 4.0 * ops::PI * area / (perimeter * perimeter).max(f64::MIN_POSITIVE);
        let slenderness = slenderness(&points);
        Some(Self { points, low, high, area, roundness, slenderness })
    }

    /// Whether two outlines are of one kind of organ, by size and form.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let ratio = self.area / other.area.max(f64::MIN_POSITIVE);
        (1.0 / LIMITS.alike_area..LIMITS.alike_area).contains(&ratio)
            && (self.slenderness - other.slenderness).abs() < LIMITS.alike_slenderness
    }

    /// Whether a point of it lies on another outline.
    pub(crate) fn touches(&self, other: &Self) -> bool {
        let reach = 2.0 * LIMITS.junction;
        let is_near =
            (self.low - reach).cmple(other.high).all() && (self.high + reach).cmpge(other.low).all();
        is_near && self.points.iter().any(|&p| nearest_on_ring(&other.points, p).1 < reach)
    }

    /// Whether a line lies inside, or on the margin.
    fn holds(&self, line: &[DVec2]) -> bool {
        let (low, high) = (self.low - LIMITS.junction, self.high + LIMITS.junction);
        let is_in = |p: &DVec2| {
            p.cmpge(low).all()
                && p.cmple(high).all()
                && (contains(&self.points, *p)
                    || distance_to_polyline(&self.points, *p).is_some_and(|d| d < 0.5 * LIMITS.junction))
        };
        let places = line.iter().step_by((line.len() / PLACES).max(1));
        let count = places.len();
        let hits = places.filter(|p| is_in(p)).count();
        hits as f64 > LIMITS.inside * count as f64
    }
}

/// The facts of one stroke.
#[derive(Clone, Debug)]
pub(crate) struct Facts {
    pub(crate) form: Form,
    /// The outline of a ring or bay.
    pub(crate) outline: Option<Outline>,
    /// The smallest outline in which it lies, by its stroke's row.
    pub(crate) holder: Option<usize>,
    /// How many of its two ends lie on other strokes.
    joined: usize,
    /// Strokes that lie in its outline and in no smaller one.
    pub(crate) marks: usize,
    /// Whether these are the venation of a leaf: a midrib with others that begin on it.
    pub(crate) is_veined: bool,
    /// Whether one of them leads through most of the outline: a midrib.
    pub(crate) has_midrib: bool,
    /// Whether these are many and small: scales or seeds.
    pub(crate) is_textured: bool,
}

/// The facts of all strokes of one plant, by their rows.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub(crate) facts: Vec<Facts>,
    /// The share of the ends of open strokes that lie on other strokes, 0 to 1; 1 if all are closed.
    joined: f64,
}

impl Sheet {
    /// Finds the facts. Cost: strokes times outlines, a few comparisons each; used for drawings of at most some
    /// hundred strokes.
    pub(crate) fn new(ink: &Ink) -> Self {
        let mut near = Near::new(LIMITS.junction);
        ink.strokes.iter().enumerate().for_each(|(k, s)| near.add_line(k, &s.points));
        let is_of_many = ink.strokes.len() >= LIMITS.many_strokes;
        let mut facts: Vec<Facts> =
            ink.strokes.iter().enumerate().map(|(k, s)| alone(&near, k, s, is_of_many)).collect();
        let mut holders: Vec<Option<usize>> = (0..facts.len()).map(|k| holder(ink, &facts, k)).collect();
        let spanning = spanning(&facts, &holders);
        if !spanning.is_empty() {
            for k in spanning {
                (facts[k].form, facts[k].outline) = (Form::Line, None);
            }
            holders = (0..facts.len()).map(|k| holder(ink, &facts, k)).collect();
        }
        let mut held: Vec<Vec<usize>> = vec![Vec::new(); facts.len()];
        for (k, holder) in holders.into_iter().enumerate() {
            facts[k].holder = holder;
            if let Some(holder) = holder {
                facts[holder].marks += 1;
                held[holder].push(k);
            }
        }
        describe_marks(ink, &mut facts, &held);
        let open = facts.iter().filter(|f| f.form != Form::Ring).count();
        let joined: usize = facts.iter().filter(|f| f.form != Form::Ring).map(|f| f.joined).sum();
        let joined = if open > 0 { joined as f64 / (2 * open) as f64 } else { 1.0 };
        Self { facts, joined }
    }

    /// Whether it was drawn with care: most lines end on others.
    pub(crate) fn is_careful(&self) -> bool {
        self.joined > LIMITS.careful
    }

    /// Returns rows of the outlines that are like that of a stroke, including itself; none for a line.
    pub(crate) fn alike(&self, k: usize) -> Vec<usize> {
        let Some(own) = &self.facts[k].outline else { return Vec::new() };
        let like = |f: &Facts| f.outline.as_ref().is_some_and(|o| own.is_like(o));
        (0..self.facts.len()).filter(|&j| like(&self.facts[j])).collect()
    }
}

/// Returns bays in which several outlines lie: they are no outlines but branches that span the organs that hang from
/// them.
fn spanning(facts: &[Facts], holders: &[Option<usize>]) -> Vec<usize> {
    let held =
        |k: usize| (0..facts.len()).filter(|&j| holders[j] == Some(k) && facts[j].form != Form::Line).count();
    (0..facts.len()).filter(|&k| facts[k].form == Form::Bay && held(k) >= LIMITS.spanned).collect()
}

/// Returns the facts of a stroke from the stroke itself and from the strokes at its ends. `is_of_many`: whether the
/// drawing is one of many organs; in others an open arc is a gloss, or a line of a hasty hand.
fn alone(near: &Near, k: usize, stroke: &InkStroke, is_of_many: bool) -> Facts {
    let points = &stroke.points;
    let (start, end) = (points[0], points[points.len() - 1]);
    let covered = |p: DVec2| near.nearest(p, LIMITS.junction, |owner| owner != k).is_some();
    let ends = [start, end].map(covered);
    let (form, outline) = if stroke.mode != StrokeMode::Parts {
        (Form::Line, None)
    } else if start.distance(end) < LIMITS.closed * stroke.length {
        (Form::Ring, Outline::new(points.clone()))
    } else if bulges(points) && ends == [true; 2] || is_of_many && goes_round(points, stroke.length) {
        (Form::Bay, Outline::new(complete(points)))
    } else {
        (Form::Line, None)
    };
    let form = if outline.is_none() { Form::Line } else { form };
    let joined = ends.into_iter().filter(|on| *on).count();
    Facts {
        form,
        outline,
        holder: None,
        joined,
        marks: 0,
        is_veined: false,
        has_midrib: false,
        is_textured: false,
    }
}

/// Whether a line leads out and back again, round something: both sides of a blade, with its tip between them,
/// wherever its ends lie. Two stalks that spread from one foot go round nothing: they are straight, or bend outwards.
pub(crate) fn goes_round(points: &[DVec2], length: f64) -> bool {
    let (start, end) = (points[0], points[points.len() - 1]);
    let Some(tip) = farthest_from_chord(points) else { return false };
    let triangle = 0.5 * (tip - start).perp_dot(end - start).abs();
    let area = signed_area(points).abs();
    start.distance(end) < LIMITS.hairpin * length
        && area > LIMITS.round_something * triangle
        && convexity(points) > LIMITS.round_convex
}

/// Returns the area that a line encloses, over that of its hull: 1 for a convex outline.
pub(crate) fn convexity(points: &[DVec2]) -> f64 {
    signed_area(points).abs() / signed_area(&convex_hull(points)).abs().max(f64::MIN_POSITIVE)
}

/// Returns the point of a line that is farthest from the middle between its ends.
fn farthest_from_chord(points: &[DVec2]) -> Option<DVec2> {
    let middle = points.first()?.midpoint(*points.last()?);
    let off = |p: &DVec2| p.distance_squared(middle);
    points.iter().max_by(|a, b| off(a).total_cmp(&off(b))).copied()
}

/// Describes the marks in each outline. `held`: for each outline the rows of the strokes in it.
fn describe_marks(ink: &Ink, facts: &mut [Facts], held: &[Vec<usize>]) {
    for (k, held) in held.iter().enumerate() {
        let Some(outline) = &facts[k].outline else { continue };
        let extent = outline.low.distance(outline.high);
        let strokes: Vec<&InkStroke> = held.iter().map(|&j| &ink.strokes[j]).collect();
        let lines = held.iter().filter(|&&j| facts[j].form == Form::Line).map(|&j| &ink.strokes[j]).collect();
        let has_midrib =
            outline.slenderness < LIMITS.slender && strokes.iter().any(|s| s.length > LIMITS.midrib * extent);
        let is_veined = is_venation(lines, held.len(), extent);
        let is_small = |s: &&&InkStroke| {
            bounds(&s.points).map_or(0.0, |(low, high)| low.distance(high)) < LIMITS.small_mark * extent
        };
        let is_textured = !is_veined
            && held.len() >= LIMITS.texture
            && 2 * strokes.iter().filter(is_small).count() > held.len();
        facts[k] = Facts { has_midrib, is_veined, is_textured, ..facts[k].clone() };
    }
}

/// Whether lines in an outline of this extent are the venation of a leaf: the longest leads through most of it, and
/// most of its marks are lines that begin on that.
fn is_venation(lines: Vec<&InkStroke>, marks: usize, extent: f64) -> bool {
    let Some(midrib) = lines.iter().copied().max_by(|a, b| a.length.total_cmp(&b.length)) else {
        return false;
    };
    let is_on = |p: DVec2| distance_to_polyline(&midrib.points, p).is_some_and(|d| d < 2.0 * LIMITS.junction);
    let begins_on_midrib = |s: &&InkStroke| {
        !core::ptr::eq(*s, midrib) && [s.points[0], s.points[s.points.len() - 1]].into_iter().any(is_on)
    };
    let side_veins = lines.into_iter().filter(begins_on_midrib).count();
    marks >= LIMITS.veins
        && midrib.length > LIMITS.midrib * extent
        && 2 * side_veins + 1 >= marks
        && side_veins + 1 >= LIMITS.veins
}

/// Whether a line leaves its chord far, and to one side.
fn bulges(points: &[DVec2]) -> bool {
    let (start, end) = (points[0], points[points.len() - 1]);
    let chord = end - start;
    let along = chord.normalize_or_zero();
    let offs = points.iter().map(|p| along.perp_dot(*p - start));
    let (low, high) = offs.fold((0.0_f64, 0.0_f64), |(low, high), off| (low.min(off), high.max(off)));
    let (more, less) = (high.max(-low), high.min(-low));
    more > LIMITS.bulge * chord.length() && less < LIMITS.one_sided * more
}

/// Returns the smallest outline in which a stroke lies.
fn holder(ink: &Ink, facts: &[Facts], k: usize) -> Option<usize> {
    let own = facts[k].outline.as_ref().map(|o| o.area);
    let holds = |(j, f): (usize, &Facts)| {
        let outline = f.outline.as_ref().filter(|_| j != k)?;
        let small = own.is_none_or(|own| own < LIMITS.smaller * outline.area);
        (small && outline.holds(&ink.strokes[k].points)).then_some((outline.area, j))
    };
    facts.iter().enumerate().filter_map(holds).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, j)| j)
}

/// Returns width over length of a set of points: the square root of the ratio of their second moments.
pub(crate) fn slenderness(points: &[DVec2]) -> f64 {
    let [long, wide] = pca2(points).map_or([0.0; 2], |p| p.lambda);
    if long > 0.0 { (wide / long).sqrt() } else { 1.0 }
}
