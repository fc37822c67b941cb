//! Reads a painted picture by its colours: `areas and lines in colour -> organs`.
//!
//! In a picture that was painted, an area is an organ and its colour says which: green areas are leaves, green lines
//! stems, and bright areas petals or fruits, by how they lie to one another and to the stems. Wood has bark, and its
//! crowns are read elsewhere.

mod areas;
mod brights;

use geom::{distance_to_polyline, polyline_length};
use glam::DVec2;
use ink::{Ink, StrokeClass, StrokeMode};

use super::masses::{self, Areas};
use super::readers::{Part, Proposal, Scene};
use crate::Kind;
use crate::blade::nearest_on_ring;
use crate::palette;
pub(crate) use areas::Colours;
use areas::{Area, Painted, Tone};

/// Limits of areas and of the organs that they are. Lengths are in ink units (the drawing's diagonal is 1).
struct PaintedLimits {
    /// Areas below this share of all are gloss, or dirt.
    speck: f64,
    /// An area lies in another one with more than this share of its outline,
    inside: f64,
    /// if it has less than this share of the other's area.
    smaller: f64,
    /// Organs nearer than this touch.
    touch: f64,
    /// An area is a stem if its mean width is less than this share of its length.
    stem: f64,
    /// A blade has two corners, or is less convex than this:
    stem_convex: f64,
    /// it is a stem only if it is more slender by this factor.
    blade: f64,
    /// A bright area in a green one is a vein if it is more slender than this (width over length).
    vein: f64,
    /// Number of places across which the middle of a stem is found.
    stem_steps: usize,
    /// A green area less convex than this (area over that of the hull) is a stem with leaves, painted in one.
    joined: f64,
    /// Wood of more than this share of the painted area makes a tree.
    wood: f64,
    /// Green is no fruit where bright areas are more than this share of the painted area.
    bright: f64,
    /// A green area is the rim of the green lines in it if these are longer than this share of it.
    rim: f64,
    /// Percentiles of the width of a rim that are compared,
    rim_range: [usize; 2],
    /// and the least ratio between them.
    rim_even: f64,
    /// A green area lies behind a flower if more than this share of all that is bright lies in it,
    covered: f64,
    /// and covers more than this share of it.
    covers: f64,
    /// A picture with less wood than this share of the painted area has no trunk.
    trunk: f64,
    /// A line of wood that is longer than this may be one.
    trunk_line: f64,
    /// A fruit is more convex than this,
    fruit_convex: f64,
    /// and at least this round (width over length).
    fruit_round: f64,
    /// The disc of a flower is more convex than this,
    disc_convex: f64,
    /// it has at most this share of the area of all its petals, or of the corolla round it,
    disc: f64,
    /// in a corolla it lies nearer to the middle than this share of half its length,
    disc_off: f64,
    /// at least this many petals stand round it (one more of them if it is seen from the side),
    petals: usize,
    /// or this many if there is no disc,
    many_petals: usize,
    /// no angle between neighbours is wider than this, radians,
    gap: f64,
    /// or than this if many petals hang from a disc seen from the side,
    side_gap: f64,
    /// none has less than this share of the area of the largest,
    alike: f64,
    /// and none begins farther from the disc than this share of the distance from the middle to its tip.
    petal_off: f64,
    /// A corolla with a disc and without lobes is less convex than this.
    corolla: f64,
    /// Fruits of a bunch are rounder than this (width over length),
    berry: f64,
    /// and none is a disc among them if it has more than this share of their mean area.
    berry_alike: f64,
    /// Areas of one flower differ by at most this hue, degrees.
    hue: f64,
    /// A line shorter than this is a mark.
    mark: f64,
}

const PAINTED: PaintedLimits = PaintedLimits {
    speck: 0.004,
    inside: 0.8,
    smaller: 0.75,
    touch: 0.03,
    stem: 0.28,
    stem_convex: 0.85,
    blade: 0.6,
    vein: 0.45,
    stem_steps: 12,
    joined: 0.72,
    wood: 0.1,
    bright: 0.3,
    rim: 0.5,
    rim_range: [10, 85],
    rim_even: 0.42,
    covered: 0.5,
    covers: 0.2,
    trunk: 0.02,
    trunk_line: 0.1,
    fruit_convex: 0.9,
    disc_convex: 0.95,
    fruit_round: 0.6,
    disc: 0.8,
    disc_off: 0.45,
    petals: 3,
    many_petals: 5,
    gap: 2.2,
    side_gap: 4.2,
    alike: 0.2,
    petal_off: 0.25,
    corolla: 0.97,
    berry: 0.85,
    berry_alike: 0.5,
    hue: 35.0,
    mark: 0.05,
};

/// Proposes a plant by the colours of a painted picture; `None` if it is none, or shows wood. Cost: quadratic in strokes,
/// times their points: for drawings of few strokes.
pub(crate) fn propose(ink: &Ink) -> Option<Proposal> {
    let is_part = |s: &ink::InkStroke| s.mode == StrokeMode::Parts;
    if !ink.strokes.iter().all(is_part) || !palette::is_coloured(ink) {
        return None;
    }
    let pot = Scene::new(ink).and_then(|scene| scene.pot);
    let painted = Painted::new(ink, pot.as_ref());
    if painted.share_of(Tone::Wood) > PAINTED.wood {
        return None;
    }
    let mut plant = Plant::default();
    let joined: Vec<Option<Areas>> = painted.areas.iter().map(Area::parts).collect();
    plant.add_stems(&painted, &joined);
    plant.add_brights(&painted, palette::brights(ink));
    plant.add_leaves(&painted, &joined);
    plant.parts.extend(pot);
    plant.proposal()
}

/// A plant in the making.
#[derive(Debug, Default)]
struct Plant {
    parts: Vec<Part>,
    heads: Vec<Vec<usize>>,
}

impl Plant {
    /// Adds lines, slender areas, and the stems of areas that are a stem with leaves. `joined`: the parts of each area
    /// that is one.
    fn add_stems(&mut self, painted: &Painted<'_>, joined: &[Option<Areas>]) {
        for line in painted.lines.iter().filter(|l| l.tone != Tone::Bright) {
            if polyline_length(line.points) > PAINTED.mark && !painted.is_mark(line) {
                self.add(line.points.to_vec(), StrokeClass::Axis, None, vec![line.row]);
            }
        }
        for area in painted.areas.iter().filter(|a| a.tone != Tone::Bright && a.is_stem()) {
            self.add(area.middle_line(), StrokeClass::Axis, None, area.strokes.clone());
        }
        for (area, parts) in painted.areas.iter().zip(joined) {
            for stem in parts.iter().flat_map(|p| &p.stems) {
                self.add(stem.points.clone(), StrokeClass::Axis, None, area.strokes.clone());
            }
        }
    }

    /// Adds green areas as leaves, each attached where it is nearest to a stem or another organ.
    ///
    /// They come first, as a part lies in front of those before it, and nothing hides a flower.
    fn add_leaves(&mut self, painted: &Painted<'_>, joined: &[Option<Areas>]) {
        let bearers = self.parts.len();
        let green = |(area, _): &(&Area, &Option<Areas>)| area.tone == Tone::Green && !area.is_stem();
        for (area, parts) in painted.areas.iter().zip(joined).filter(green) {
            let Some(parts) = parts.as_ref().filter(|p| !p.masses.is_empty()) else {
                let root = self.nearest(bearers, area.shape.ends, Some(&area.outline));
                self.add(masses::closed(&area.outline), StrokeClass::Blade, Some(root), area.strokes.clone());
                continue;
            };
            for mass in &parts.masses {
                let root = self.nearest(bearers, mass.shape.ends, None);
                self.add(masses::closed(&mass.outline), StrokeClass::Blade, Some(root), area.strokes.clone());
            }
        }
        let leaves = self.parts.len() - bearers;
        self.parts.rotate_right(leaves);
        self.heads.iter_mut().flatten().for_each(|row| *row += leaves);
    }

    /// Returns the end of a leaf that is nearer to the first parts, or the place of its outline at the end of a stem.
    fn nearest(&self, bearers: usize, ends: [DVec2; 2], outline: Option<&[DVec2]>) -> DVec2 {
        if let Some(place) = outline.and_then(|o| self.end_of_stem_on(o)) {
            return place;
        }
        let off = |p: DVec2| {
            let of_part = |part: &Part| distance_to_polyline(&part.points, p);
            self.parts[..bearers].iter().filter_map(of_part).fold(f64::INFINITY, f64::min)
        };
        let [a, b] = ends;
        let (to_a, to_b) = (off(a), off(b));
        if to_a < to_b || to_a.total_cmp(&to_b).is_eq() && a.y < b.y { a } else { b }
    }

    /// Returns the place of an outline that is nearest to an end of a stem, if one touches it.
    fn end_of_stem_on(&self, outline: &[DVec2]) -> Option<DVec2> {
        let stems = self.parts.iter().filter(|p| p.class == StrokeClass::Axis);
        let ends = stems.flat_map(|s| [s.points[0], s.points[s.points.len() - 1]]);
        let nearest = ends.map(|p| nearest_on_ring(outline, p)).min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.filter(|(_, off)| *off < PAINTED.touch).map(|(place, _)| place)
    }

    fn add(&mut self, points: Vec<DVec2>, class: StrokeClass, root: Option<DVec2>, strokes: Vec<usize>) {
        self.parts.push(Part { points, class, root, strokes });
    }

    fn proposal(self) -> Option<Proposal> {
        let has = |class: StrokeClass| self.parts.iter().any(|p| p.class == class);
        let kind = match self.heads.len() {
            _ if has(StrokeClass::Pot) => Kind::HousePlant,
            0 if has(StrokeClass::Fruit) => Kind::Fruit,
            0 => Kind::Stem,
            1 => Kind::Flower,
            _ => Kind::Flowers,
        };
        let is_plant = has(StrokeClass::Blade) || has(StrokeClass::Fruit);
        let (parts, heads) = (self.parts, self.heads);
        // It is compared with another reading by what that contradicts, not by its likelihood.
        let likelihood = 1.0;
        is_plant.then_some(Proposal { kind, parts, heads, likelihood, word: None, is_of_pieces: true })
    }
}

#[cfg(test)]
mod tests;
