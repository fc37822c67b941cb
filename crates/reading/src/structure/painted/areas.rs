//! The areas and lines of a painted picture, and their tones.

use geom::resample;
use glam::DVec2;
use ink::{Ink, InkStroke};

use super::super::LIMITS;
use super::super::readers::Part;
use super::super::shape::Shape;
use super::PAINTED;
use super::masses::{Areas, closed};
use crate::rows::OrganWord;
use crate::{Kind, Reading, palette};

/// Number of places round an area at which the width of its rim is measured.
const ROUND: f64 = 96.0;

/// A kind of colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tone {
    /// Leaves and stems.
    Green,
    /// Petals, discs and fruits.
    Bright,
    /// Wood, seeds, soil; and ink of no colour.
    Wood,
}

impl Tone {
    fn new(stroke: &InkStroke) -> Self {
        if palette::is_green_stroke(stroke) {
            Self::Green
        } else if palette::is_bright_stroke(stroke) {
            Self::Bright
        } else {
            Self::Wood
        }
    }
}

/// A line of a picture.
#[derive(Clone, Debug)]
pub(super) struct Line<'a> {
    pub(super) row: usize,
    pub(super) points: &'a [DVec2],
    pub(super) tone: Tone,
}

/// An area of a picture.
#[derive(Clone, Debug)]
pub(super) struct Area {
    /// Its stroke, and those of areas of its tone that lie in it.
    pub(super) strokes: Vec<usize>,
    /// Its outline, counter-clockwise.
    pub(super) outline: Vec<DVec2>,
    pub(super) shape: Shape,
    pub(super) tone: Tone,
}

impl Area {
    fn new((row, stroke): (usize, &InkStroke)) -> Option<Self> {
        let outline = stroke.outline().filter(|_| is_closed(stroke))?.to_vec();
        let shape = Shape::new(&outline)?;
        Some(Self { strokes: vec![row], outline, shape, tone: Tone::new(stroke) })
    }

    /// Whether it lies in another area.
    pub(super) fn lies_in(&self, other: &Self) -> bool {
        let inner = self.outline.iter().filter(|p| geom::contains(&other.outline, **p)).count() as f64;
        self.shape.area < PAINTED.smaller * other.shape.area
            && inner > PAINTED.inside * self.outline.len() as f64
    }

    /// Whether it is as slender as a stem; a blade has two corners.
    pub(super) fn is_stem(&self) -> bool {
        let width = 4.0 * self.shape.area / self.shape.perimeter;
        let is_blade = self.shape.corners.len() == 2 || self.shape.convexity < PAINTED.stem_convex;
        let most = if is_blade { PAINTED.blade * PAINTED.stem } else { PAINTED.stem };
        width < most * self.shape.length()
    }

    /// Whether it is a stem with leaves that were painted as one area.
    pub(super) fn is_joined(&self) -> bool {
        self.tone == Tone::Green && !self.is_stem() && self.shape.convexity < PAINTED.joined
    }

    /// Returns the stem and the leaves of which it consists, if there are several.
    pub(super) fn parts(&self) -> Option<Areas> {
        let parts = self.is_joined().then(|| Areas::new(&[&closed(&self.outline)])).flatten()?;
        (parts.masses.len() + parts.stems.len() > 1).then_some(parts)
    }

    /// Returns the line along its middle, between its two ends that are farthest apart.
    pub(super) fn middle_line(&self) -> Vec<DVec2> {
        let [from, to] = self.shape.ends;
        let place = |p: DVec2| self.outline.iter().position(|q| *q == p).unwrap_or(0);
        let mut ring = self.outline.clone();
        ring.rotate_left(place(from));
        let split = ring.iter().position(|q| *q == to).unwrap_or(ring.len() / 2);
        let one = even(&ring[..=split]);
        ring.push(from);
        let mut other = even(&ring[split..]);
        other.reverse();
        one.iter().zip(&other).map(|(a, b)| a.midpoint(*b)).collect()
    }
}

/// Returns as many points along a side as the middle of a stem has.
fn even(side: &[DVec2]) -> Vec<DVec2> {
    let step = geom::polyline_length(side) / PAINTED.stem_steps as f64;
    let mut points = resample(side, step);
    points.truncate(PAINTED.stem_steps + 1);
    points
}

fn is_closed(stroke: &InkStroke) -> bool {
    let ends = [stroke.points[0], stroke.points[stroke.points.len() - 1]];
    ends[0].distance(ends[1]) < LIMITS.closed * stroke.length
}

/// The areas and lines of a picture, without those of its pot.
pub(super) struct Painted<'a> {
    /// Areas that lie in no other one of their tone, and are no specks.
    pub(super) areas: Vec<Area>,
    pub(super) lines: Vec<Line<'a>>,
    whole: f64,
    colors: Vec<Option<[u8; 3]>>,
}

impl<'a> Painted<'a> {
    pub(super) fn new(ink: &'a Ink, pot: Option<&Part>) -> Self {
        let is_of_pot = |row: usize, s: &InkStroke| {
            pot.is_some_and(|pot| {
                let inner = s.points.iter().filter(|p| geom::contains(&pot.points, **p)).count();
                pot.strokes.contains(&row) || 2 * inner > s.points.len()
            })
        };
        let strokes = || ink.strokes.iter().enumerate().filter(|(row, s)| !is_of_pot(*row, s));
        let found: Vec<Area> = strokes().filter_map(Area::new).collect();
        let lines: Vec<Line<'a>> = strokes()
            .filter(|(row, _)| !found.iter().any(|a| a.strokes[0] == *row))
            .map(|(row, s)| Line { row, points: &s.points, tone: Tone::new(s) })
            .collect();
        // The areas that are seen from outside, the largest first: shade and gloss lie in them.
        let mut order: Vec<usize> = (0..found.len()).collect();
        base::sort_by(&mut order, |&a, &b| found[b].shape.area.total_cmp(&found[a].shape.area));
        let whole: f64 = found.iter().map(|a| a.shape.area).sum();
        let mut areas: Vec<Area> = Vec::new();
        for area in order.into_iter().map(|k| &found[k]) {
            if let Some(outer) = areas.iter_mut().find(|o| o.tone == area.tone && is_shade(area, o)) {
                outer.strokes.push(area.strokes[0]);
            } else if area.shape.area > PAINTED.speck * whole && !is_vein(ink, area, &areas) {
                areas.push(area.clone());
            }
        }
        areas.retain(|a| !is_rim(a, ink, &lines));
        let areas: Vec<Area> = areas.iter().filter(|a| !is_behind(a, &areas)).cloned().collect();
        let colors = ink.strokes.iter().map(|s| s.color).collect();
        Self { areas, lines, whole, colors }
    }

    /// Whether two areas are tones of one hue.
    pub(super) fn are_of_one_hue(&self, a: &Area, b: &Area) -> bool {
        let [Some(a), Some(b)] = [a, b].map(|area| self.colors[area.strokes[0]].map(ink::hue)) else {
            return true;
        };
        ink::hues_apart(a.0, b.0) < PAINTED.hue
    }

    /// Whether a line lies in an area.
    pub(super) fn is_mark(&self, line: &Line<'_>) -> bool {
        self.areas.iter().any(|a| line.points.iter().all(|&p| geom::contains(&a.outline, p)))
    }

    /// Whether it shows neither a trunk nor a line that may be one.
    fn is_without_wood(&self) -> bool {
        let is_trunk = |line: &Line<'_>| {
            line.tone == Tone::Wood
                && geom::polyline_length(line.points) > PAINTED.trunk_line
                && !self.is_mark(line)
        };
        self.share_of(Tone::Wood) < PAINTED.trunk && !self.lines.iter().any(is_trunk)
    }

    /// Returns the share of all painted area that has a tone and lies in no other area.
    pub(super) fn share_of(&self, tone: Tone) -> f64 {
        let is_inner = |a: &Area| self.areas.iter().any(|o| a.lies_in(o));
        let area: f64 =
            self.areas.iter().filter(|a| a.tone == tone && !is_inner(a)).map(|a| a.shape.area).sum();
        area / self.whole.max(f64::MIN_POSITIVE)
    }
}

/// Whether a green area is only the rim round green lines that lie in it: all of its outline is about equally far from
/// what was painted in it. Veins come near the outline.
fn is_rim(area: &Area, ink: &Ink, lines: &[Line<'_>]) -> bool {
    let is_within = |p: &&DVec2| geom::contains(&area.outline, **p);
    let holds = |points: &[DVec2]| {
        points.iter().filter(is_within).count() as f64 > PAINTED.inside * points.len() as f64
    };
    let length: f64 = lines
        .iter()
        .filter(|l| l.tone == Tone::Green && holds(l.points))
        .map(|l| geom::polyline_length(l.points))
        .sum();
    if area.tone != Tone::Green || length < PAINTED.rim * area.shape.length() {
        return false;
    }
    let inner: Vec<&InkStroke> = (0..ink.strokes.len())
        .filter(|row| *row != area.strokes[0])
        .map(|row| &ink.strokes[row])
        .filter(|s| holds(&s.points))
        .collect();
    let off = |p: &DVec2| {
        let to = inner.iter().filter_map(|s| geom::distance_to_polyline(&s.points, *p));
        to.fold(f64::INFINITY, f64::min)
    };
    let mut widths: Vec<f64> =
        resample(&area.outline, area.shape.perimeter / ROUND).iter().map(off).collect();
    base::sort_numbers(&mut widths);
    let [low, high] = PAINTED.rim_range.map(|q| widths[(widths.len() - 1) * q / 100]);
    low > PAINTED.rim_even * high
}

/// Whether a green area lies behind most of what is bright, as a lily's leaf or a card does: from the front it would hide
/// the flower.
fn is_behind(area: &Area, all: &[Area]) -> bool {
    let brights = || all.iter().filter(|a| a.tone == Tone::Bright);
    let inner: f64 = brights().filter(|a| a.lies_in(area)).map(|a| a.shape.area).sum();
    let whole: f64 = brights().map(|a| a.shape.area).sum();
    area.tone == Tone::Green && inner > PAINTED.covered * whole && inner > PAINTED.covers * area.shape.area
}

/// Whether an area is a vein or a gloss on a green one: nearly white, or slender.
fn is_vein(ink: &Ink, area: &Area, larger: &[Area]) -> bool {
    area.tone == Tone::Bright
        && (palette::is_pale_stroke(&ink.strokes[area.strokes[0]]) || area.shape.slenderness < PAINTED.vein)
        && larger.iter().any(|o| o.tone == Tone::Green && area.lies_in(o))
}

/// Whether an area of the tone of a larger one is shade or gloss on it.
fn is_shade(area: &Area, outer: &Area) -> bool {
    area.tone == Tone::Green && area.lies_in(outer)
}

/// What the colours of a painted picture say against readings of it.
pub(crate) struct Colours {
    /// All areas, each with the index of its stroke.
    areas: Vec<(u32, Area)>,
    is_herb: bool,
    is_mostly_bright: bool,
    is_below: bool,
    has_bright: bool,
    has_green: bool,
}

impl Colours {
    /// Finds the areas of a picture; `None` for drawings without the colours of plants. Cost: as [`propose`](super::propose).
    pub(crate) fn new(ink: &Ink) -> Option<Self> {
        if !palette::is_coloured(ink) {
            return None;
        }
        let painted = Painted::new(ink, None);
        let area = |(row, stroke): (usize, &InkStroke)| Some((stroke.index, Area::new((row, stroke))?));
        Some(Self {
            areas: ink.strokes.iter().enumerate().filter_map(area).collect(),
            is_herb: painted.is_without_wood(),
            is_mostly_bright: painted.share_of(Tone::Bright) > PAINTED.bright,
            is_below: palette::brights(ink) == palette::Brights::Below,
            has_bright: painted.areas.iter().any(|a| a.tone == Tone::Bright),
            has_green: ink.strokes.iter().any(palette::is_green_stroke),
        })
    }

    /// Returns the share of the painted area that became organs which never have its colour: 0 to 1.
    pub(crate) fn contradicted(&self, reading: &Reading, kind: Kind) -> f64 {
        let (mut whole, mut wrong) = (0.0, 0.0);
        for (index, area) in &self.areas {
            let Some(said) = reading.strokes.iter().find(|s| s.index == *index) else { continue };
            whole += area.shape.area;
            if self.contradict(area, said.organ, kind) {
                wrong += area.shape.area;
            }
        }
        if whole > 0.0 { wrong / whole } else { 0.0 }
    }

    /// Whether an area never is such an organ of a plant of a kind.
    fn contradict(&self, area: &Area, organ: OrganWord, kind: Kind) -> bool {
        match (area.tone, organ) {
            // A drawing in greens alone may be one of a green pen.
            (Tone::Green, OrganWord::Petal | OrganWord::Disc) => self.has_bright,
            (Tone::Green, OrganWord::Pot) => true,
            (Tone::Green, OrganWord::Fruit) => self.is_mostly_bright || super::super::is_lens(&area.outline),
            (Tone::Green, OrganWord::TwigContour | OrganWord::LeafContour) => self.is_herb,
            (Tone::Green, OrganWord::Trunk) => kind != Kind::Cactus,
            (Tone::Bright, OrganWord::Leaf) => self.has_green,
            (Tone::Bright, OrganWord::TwigContour | OrganWord::LeafContour) => true,
            (Tone::Bright, OrganWord::Trunk | OrganWord::Branch) => {
                !kind.is_like(Kind::Tree) && kind != Kind::Palm
            }
            (Tone::Bright, OrganWord::Petal) => self.is_below,
            (Tone::Bright, OrganWord::Pot) => area.is_round(),
            _ => false,
        }
    }
}

impl Area {
    /// Whether it has the form of the disc of a flower.
    pub(super) fn may_be_disc(&self) -> bool {
        self.is_round() && self.shape.convexity > PAINTED.disc_convex
    }

    /// Whether it is as round as a fruit.
    pub(super) fn is_round(&self) -> bool {
        self.shape.convexity > PAINTED.fruit_convex && self.shape.slenderness > PAINTED.fruit_round
    }
}
