//! The result of reading a drawing: still flat, in ink coordinates.
//!
//! `Ink + classes -> Reading -> Plant`

use glam::DVec2;
use ink::{Source, StrokeClass};
use plant::AxisKind;
use serde::{Deserialize, Serialize};

use crate::{Evidence, Kind, Scored};

/// The organ that one stroke became. The words of the command line's contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum OrganWord {
    /// A petal (or several).
    Petal,
    /// A leaf (or several).
    Leaf,
    /// A branch, stem or stalk.
    Branch,
    /// A trunk or body.
    Trunk,
    /// Filled with twigs.
    TwigContour,
    /// Filled with leaves.
    LeafContour,
    /// The midrib or a side vein of a leaf.
    Vein,
    /// The centre of a flower.
    Disc,
    /// A fruit.
    Fruit,
    /// A thorn.
    Thorn,
    /// A root.
    Root,
    /// Stamens or a pistil.
    Stamen,
    /// Part of the plant's pot.
    Pot,
    /// Recognised and left out.
    Ignored,
}

impl OrganWord {
    /// Returns the word in reports.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Petal => "petal",
            Self::Leaf => "leaf",
            Self::Branch => "branch",
            Self::Trunk => "trunk",
            Self::TwigContour => "twig_contour",
            Self::LeafContour => "leaf_contour",
            Self::Vein => "vein",
            Self::Disc => "disc",
            Self::Fruit => "fruit",
            Self::Thorn => "thorn",
            Self::Root => "root",
            Self::Stamen => "stamen",
            Self::Pot => "pot",
            Self::Ignored => "ignored",
        }
    }
}

/// How one stroke was understood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeReading {
    /// Its index in the drawing.
    pub index: u32,
    /// Its class.
    pub class: StrokeClass,
    /// The organ that it became.
    pub organ: OrganWord,
    /// How sure this class is, 0 to 1: the share that the classifier gave it, even if a [rule](crate::RULES) chose it
    /// over a larger one; 1 for a class that the user set and for a single line.
    pub confidence: f64,
    /// The source of the class.
    pub source: Source,
}

impl StrokeReading {
    /// Returns the row of a stroke that became nothing.
    pub(crate) const fn left_out(index: u32) -> Self {
        Self {
            index,
            class: StrokeClass::Other,
            organ: OrganWord::Ignored,
            confidence: 0.0,
            source: Source::Classifier,
        }
    }
}

/// The bearer of something: a place along an axis of the reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attachment {
    /// Row of [`Reading::axes`].
    pub axis: usize,
    /// Arc length from that axis's base to the place, ink units.
    pub at: f64,
}

/// An axis: a stem, branch, stalk, trunk or root, as a line with its base first.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisReading {
    /// The line, at least 2 points, ink coordinates.
    pub points: Vec<DVec2>,
    /// The kind of axis.
    pub kind: AxisKind,
    /// Its place on its bearer; `None` for an axis that stands on the ground. Always an earlier row.
    pub bearer: Option<Attachment>,
    /// Half width at each point where it was drawn as an outline; empty for a line.
    pub half_width: Vec<f64>,
    /// The stroke it came from.
    pub source: Option<u32>,
}

/// One leaf or petal as an outline.
#[derive(Clone, Debug, PartialEq)]
pub struct BladeReading {
    /// A simple closed polygon, counter-clockwise, first point not repeated, ink coordinates.
    pub outline: Vec<DVec2>,
    /// The point where it is attached.
    pub root: DVec2,
    /// The point farthest out.
    pub tip: DVec2,
    /// The midrib, root to tip, at least 2 points: the vein that was drawn, or found from the outline.
    pub midrib: Vec<DVec2>,
    /// Further veins drawn inside it.
    pub veins: Vec<VeinReading>,
    /// Its place on its bearer (leaves; petals are borne by their flower).
    pub bearer: Option<Attachment>,
    /// Ring of the flower, 0 outermost (petals only).
    pub whorl: u32,
    /// Its layer among those that it overlaps: -1 behind all of them, 1 in front of all; `None` if it overlaps none.
    pub front: Option<f64>,
    /// The stroke it came from.
    pub source: Option<u32>,
    /// Its drawn colour.
    pub color: Option<[u8; 3]>,
}

/// A vein other than the midrib.
#[derive(Clone, Debug, PartialEq)]
pub struct VeinReading {
    /// At least 2 points, ink coordinates, as it was drawn.
    pub points: Vec<DVec2>,
    /// The stroke it came from.
    pub source: Option<u32>,
}

/// The centre of a flower as it was drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscReading {
    /// Middle.
    pub centre: DVec2,
    /// Mean radius.
    pub radius: f64,
    /// The stroke it came from.
    pub source: Option<u32>,
    /// The colour it was drawn in.
    pub color: Option<[u8; 3]>,
}

/// A flower.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowerReading {
    /// The mean of the petals' roots, or the middle of the disc.
    pub centre: DVec2,
    /// Its petals, of all whorls.
    pub petals: Vec<BladeReading>,
    /// The drawn centre.
    pub disc: Option<DiscReading>,
    /// Lines from the centre outwards that are stamens or a pistil.
    pub stamens: Vec<Vec<DVec2>>,
    /// Its place on its bearer.
    pub bearer: Option<Attachment>,
}

/// The filling of a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum RegionKind {
    /// Twigs only (a branch contour).
    Twigs,
    /// Leaves along grown midribs (a leaf contour).
    Leaves,
    /// Twigs with leaves (the crown of a tree).
    Crown,
}

/// A contour to be filled.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionReading {
    /// A simple closed polygon, counter-clockwise, ink coordinates.
    pub outline: Vec<DVec2>,
    /// Its filling.
    pub kind: RegionKind,
    /// Rows of [`Reading::axes`] that run into it: the growth starts from these. Never empty: where the drawing
    /// has no such axis, the reading adds a trunk.
    pub bearers: Vec<usize>,
    /// The stroke it came from.
    pub source: Option<u32>,
    /// Its drawn colour.
    pub color: Option<[u8; 3]>,
}

/// A fruit as it was drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct FruitReading {
    /// A simple closed polygon, counter-clockwise, ink coordinates.
    pub outline: Vec<DVec2>,
    /// Its place on its bearer.
    pub bearer: Option<Attachment>,
    /// The stroke it came from.
    pub source: Option<u32>,
    /// Its drawn colour.
    pub color: Option<[u8; 3]>,
}

/// The pot or vase of a plant, from all strokes that were drawn for it.
#[derive(Clone, Debug, PartialEq)]
pub struct PotReading {
    /// Its lines, ink coordinates: outlines, sides, a rim.
    pub lines: Vec<Vec<DVec2>>,
    /// The first of the strokes that it came from.
    pub source: Option<u32>,
    /// Its drawn colour.
    pub color: Option<[u8; 3]>,
}

/// The result of reading a drawing.
///
/// Ink coordinates: y up, the drawing's bounding box has diagonal 1 and its lower left corner at the origin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Every stroke of the drawing, in its order.
    pub strokes: Vec<StrokeReading>,
    /// Axes; a bearer's row comes before the rows that it bears.
    pub axes: Vec<AxisReading>,
    /// Flowers.
    pub flowers: Vec<FlowerReading>,
    /// Leaves that are not part of a flower.
    pub leaves: Vec<BladeReading>,
    /// Contours to be filled.
    pub regions: Vec<RegionReading>,
    /// Fruits.
    pub fruits: Vec<FruitReading>,
    /// Pots.
    pub pots: Vec<PotReading>,
    /// Thorns: root and tip, with their bearers.
    pub thorns: Vec<(Vec<DVec2>, Option<Attachment>, Option<u32>)>,
    /// Whether it is a woody plant (trunk outline, crown, several orders of branches) rather than a herb.
    pub woody: bool,
    /// Strokes that were drawn more boldly or more lightly than usual, by their indices, and the factor: 1 is as
    /// usual.
    pub pressed: Vec<(u32, f64)>,
    /// The plants that the drawing shows, from left to right.
    pub plants: Vec<PlantReading>,
}

/// One plant of a drawing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlantReading {
    /// Its strokes, by their indices in the drawing, ascending.
    pub strokes: Vec<u32>,
    /// Its height in the drawing, ink units.
    pub height: f64,
    /// The kind that it was read as.
    pub kind: Kind,
    /// The plant of its kind that it looks like at a glance, one of [`WORDS`](crate::glance::WORDS), such as a pear;
    /// `None` if no word is likelier than all others of that kind together. Of 142 words that were given for new
    /// drawings 124 are right (`docs/strokes.md`).
    pub word: Option<&'static str>,
    /// Evidence for that kind.
    pub evidence: Evidence,
    /// Kinds that it may be with how likely each is, at most three: the kind that was read first, then the others, the
    /// best first.
    pub readings: Vec<Scored>,
}
