//! Reads a drawing by its masses: `lines -> the areas that they cover -> organs`.
//!
//! Most lines of an engraving or a hatched drawing are shade, and mean nothing by themselves. From afar they are areas:
//! wide ones are heads and leaves, slender ones stems. This is the reading of last resort, for drawings whose lines are
//! a tangle otherwise.

mod areas;
mod profile;

use geom::distance_to_polyline;
use glam::DVec2;
use ink::{Ink, StrokeClass};

use super::readers::{Part, Proposal};
use crate::{Kind, palette};
pub(crate) use areas::{Areas, Mass, Stem};
pub(crate) use profile::Profile;

/// Limits of areas and of the organs that they are. Lengths are in ink units (the drawing's diagonal is 1).
struct MassLimits {
    /// Number of cells along the longer side of the drawing.
    along: usize,
    /// Radii of the balls that close gaps between lines, in ascending order.
    balls: [f64; 4],
    /// Exponent by which the area of a mass counts less where it is not convex.
    convex_power: f64,
    /// Pieces below this share of the area of the largest are letters, or dirt.
    piece: f64,
    /// Most pieces, masses, and slender pieces that are looked at, the largest first: more are texture, or dirt.
    most: usize,
    /// Parts in which a ball of this radius finds no room are slender.
    thin: f64,
    /// Slender parts longer than this are stems.
    stem: f64,
    /// Two masses are one if the neck between them is wider than this share of the narrower one.
    neck: f64,
    /// Half of the number of cells over which outlines and paths are smoothed.
    smooth: usize,
    /// Lines nearer to the rim of a mass than this number of cells do not say whether it is radial.
    rim: f64,
    /// Nor do lines nearer to its middle than this share of its radius.
    hub: f64,
    /// A flower head is rounder than this (width over length),
    round: f64,
    /// more convex than this (area over that of the hull),
    convex: f64,
    /// and its lines run away from its middle at least so much (-1 to 1).
    radial: f64,
    /// A flower has between these numbers of lobes.
    lobes: [usize; 2],
    /// The widest lobe is at most this factor of the mean.
    uneven: f64,
    /// A lobe stands out by more than this share of the mean radius.
    prominent: f64,
    /// Number of rays of a head without lobes.
    rays: usize,
    /// Radius of the disc of a head with lobes, and with rays, as shares of its mean radius.
    disc: [f64; 2],
    /// A head without lobes is more convex than this.
    whole: f64,
    /// A petal is shorter at its sides by this share of its length.
    rounded: f64,
    /// A head counts if its radius is more than this share of that of the largest head.
    alike: f64,
    /// Heads are more than this share of the area of all masses.
    heads: f64,
    /// A stem that is a mass is no wider than this share of the head that it bears,
    stalk: f64,
    /// and slenderer than this.
    slender: f64,
    /// Greatest distance between a stem and a mass that touch.
    touch: f64,
}

const MASSES: MassLimits = MassLimits {
    along: 240,
    balls: [0.007, 0.012, 0.018, 0.026],
    convex_power: 4.0,
    piece: 0.05,
    most: 64,
    thin: 0.016,
    stem: 0.05,
    neck: 0.85,
    smooth: 3,
    rim: 3.0,
    hub: 0.25,
    round: 0.66,
    convex: 0.7,
    radial: 0.1,
    lobes: [3, 9],
    uneven: 2.0,
    prominent: 0.08,
    rays: 21,
    disc: [0.14, 0.3],
    whole: 0.88,
    rounded: 0.3,
    alike: 0.35,
    heads: 0.55,
    stalk: 0.6,
    slender: 0.45,
    touch: 0.02,
};

/// Proposes a plant by the masses of a drawing; `None` if these are no plant that can be told.
pub(crate) fn propose(ink: &Ink) -> Option<Proposal> {
    let lines: Vec<&[DVec2]> = ink.strokes.iter().map(|s| s.points.as_slice()).collect();
    let Areas { masses, stems } = Areas::new(&lines)?;
    let is_painted = palette::is_painted(ink);
    let is_foliage =
        |m: &Mass| is_painted && palette::is_mostly_green(m.strokes.iter().map(|&k| &ink.strokes[k]));
    let (mut heads, mut rest): (Vec<&Mass>, Vec<&Mass>) =
        masses.iter().partition(|m| may_be_head(m) && !is_foliage(m));
    let widest = heads.iter().map(|m| m.inner).fold(0.0, f64::max);
    rest.extend(heads.extract_if(.., |m| m.inner <= MASSES.alike * widest));
    let area = |m: &Mass| m.shape.area;
    let all: f64 = masses.iter().map(area).sum();
    if heads.iter().map(|m| area(m)).sum::<f64>() <= MASSES.heads * all {
        return None;
    }
    let mut parts: Vec<Part> = stems.iter().map(Part::from_stem).collect();
    parts.extend(
        rest.into_iter()
            .map(|m| if bears(m, &heads) { Part::from_stalk(m) } else { leaf(m, &stems, &masses) }),
    );
    for head in &heads {
        parts.extend(Profile::new(&head.outline, head.shape.middle).organs(&head.strokes));
    }
    let kind = if heads.len() > 1 { Kind::Flowers } else { Kind::Flower };
    Some(Proposal {
        kind,
        parts,
        heads: Vec::new(),
        // It competes with no other proposal.
        likelihood: 1.0,
        word: None,
        is_of_pieces: true,
    })
}

/// Whether a mass has the form and the lines of a flower head.
fn may_be_head(mass: &Mass) -> bool {
    let shape = &mass.shape;
    shape.slenderness > MASSES.round
        && mass.radial > MASSES.radial
        && (shape.convexity > MASSES.whole
            || shape.convexity > MASSES.convex && Profile::new(&mass.outline, shape.middle).lobes().is_some())
}

/// Whether a mass is the stem of a head: below it, narrower, and longish.
fn bears(mass: &Mass, heads: &[&Mass]) -> bool {
    let ends = [mass.middle_line[0], mass.middle_line[mass.middle_line.len() - 1]];
    mass.shape.slenderness < MASSES.slender
        && heads.iter().any(|head| {
            mass.inner < MASSES.stalk * head.inner
                && mass.shape.middle.y < head.shape.middle.y
                && ends.iter().any(|&p| head.is_near(p, 2.0 * MASSES.touch))
        })
}

/// Returns a leaf: attached where it is nearest to a stem, or to another mass.
fn leaf(mass: &Mass, stems: &[Stem], masses: &[Mass]) -> Part {
    let ends = [mass.middle_line[0], mass.middle_line[mass.middle_line.len() - 1]];
    let to_stem = |p: DVec2| {
        stems.iter().filter_map(|s| distance_to_polyline(&s.points, p)).fold(f64::INFINITY, f64::min)
    };
    let to_mass = |p: DVec2| {
        let others = masses.iter().filter(|m| !core::ptr::eq(*m, mass));
        others.map(|m| crate::blade::nearest_on_ring(&m.outline, p).1).fold(f64::INFINITY, f64::min)
    };
    let off = |p: DVec2| to_stem(p).min(to_mass(p));
    let root = if off(ends[0]) <= off(ends[1]) { ends[0] } else { ends[1] };
    Part {
        points: closed(&mass.outline),
        class: StrokeClass::Blade,
        root: Some(root),
        strokes: mass.strokes.clone(),
    }
}

/// Returns an outline whose last point is its first one.
pub(crate) fn closed(outline: &[DVec2]) -> Vec<DVec2> {
    outline.iter().chain(outline.first()).copied().collect()
}

impl Part {
    fn from_stem(stem: &Stem) -> Self {
        Self {
            points: stem.points.clone(),
            class: StrokeClass::Axis,
            root: None,
            strokes: stem.strokes.clone(),
        }
    }

    fn from_stalk(mass: &Mass) -> Self {
        Self {
            points: mass.middle_line.clone(),
            class: StrokeClass::Axis,
            root: None,
            strokes: mass.strokes.clone(),
        }
    }
}

#[cfg(test)]
mod tests;
