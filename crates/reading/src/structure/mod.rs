//! The structure of a drawing, whatever kind of plant it shows: strokes that enclose something, strokes that go on
//! behind others, strokes inside others, and repeated strokes.
//!
//! `Ink -> Sheet -> classes of strokes, completed outlines`, and a score of any reading of the same ink.
//!
//! | module | holds |
//! |---|---|
//! | `sheet` | the facts of each stroke, found once and never changed |
//! | `hidden` | outlines completed behind the strokes that cover them |
//! | `classes` | the classes of strokes by these facts |
//! | `chains` | blades whose outline was drawn in several strokes |
//! | `score` | how well a reading explains the drawing |
//! | `tubes` | stems that were drawn by both their sides |
//! | `vessel` | pots that were drawn in several strokes |
//! | `faces`, `shape` | the areas that lines enclose together, and the form of outlines |
//! | `readers` | plants that are recognised by the arrangement of their faces and lines |
//! | `masses` | plants that are recognised by the areas that hatched and engraved lines cover |
//! | `painted` | plants that are recognised by the colours of a painted picture |
//! | `compose` | from the parts that a reader proposes to a reading |

mod chains;
mod classes;
mod compose;
mod faces;
mod hidden;
pub(crate) mod masses;
pub(crate) mod painted;
pub(crate) mod readers;
mod score;
mod shape;
mod sheet;
mod tubes;
mod vessel;

pub(crate) use chains::chains;
pub(crate) use classes::{Hidden, STRUCTURE, Structure};
pub(crate) use compose::{Composed, Joined};
pub use readers::ARRANGEMENT;
pub(crate) use readers::widest_gap;
pub(crate) use score::score;
pub(crate) use shape::is_lens;
pub(crate) use sheet::{Sheet, slenderness};
pub(crate) use tubes::{Tube, tubes};
pub(crate) use vessel::vessel;

/// Limits between the forms of strokes, and for deciding by structure. Lengths are in ink units (the drawing's
/// diagonal is 1).
#[derive(Clone, Copy, Debug)]
pub(crate) struct StructureLimits {
    /// A drawing of fewer strokes has too little structure; the kinds of whole drawings were learnt from such
    /// drawings.
    pub(crate) fewest_strokes: usize,
    /// Structure decides only if more than this share of the ends of open strokes lies on other strokes: otherwise
    /// lines stop short of one another, and their ends mean nothing. The share is 0.67 to 1 for 16 botanical
    /// illustrations, and 0 to 0.42 for 49 doodles with as many strokes, except for one (0.67).
    pub(crate) careful: f64,
    /// An end nearer than this to another stroke lies on it: one and a half steps of the pen.
    pub(crate) junction: f64,
    /// Ends nearer than this share of the stroke's length close it.
    pub(crate) closed: f64,
    /// An open stroke between two junctions encloses something if it leaves its chord by more than this share of the
    /// chord.
    pub(crate) bulge: f64,
    /// It encloses nothing if at least this many outlines lie in it: it is a branch over the organs that it bears.
    pub(crate) spanned: usize,
    /// It bulges to one side: to the opposite side by less than this share of that.
    pub(crate) one_sided: f64,
    /// A stroke is both sides of a blade, wherever its ends lie, if they are nearer than this share of its length,
    pub(crate) hairpin: f64,
    /// and it encloses more than this factor of the triangle of its ends and its tip,
    pub(crate) round_something: f64,
    /// and more than this share of its hull.
    pub(crate) round_convex: f64,
    /// A stroke lies in an outline with more than this share of its points.
    pub(crate) inside: f64,
    /// An outline lies in another one only if its area is below this share of the other's.
    pub(crate) smaller: f64,
    /// Outlines are alike if neither has more than this many times the area of the other.
    pub(crate) alike_area: f64,
    /// Outlines are alike if their slenderness (width over length, 0 to 1) differs by less than this.
    pub(crate) alike_slenderness: f64,
    /// At least this many similar outlines are organs of one kind.
    pub(crate) repeated: usize,
    /// At least this many marks in one outline are its texture (scales, seeds), not its veins.
    pub(crate) texture: usize,
    /// The diagonals of the boxes of most of them are shorter than this share of that of its box.
    pub(crate) small_mark: f64,
    /// A midrib is longer than this share of the diagonal of its leaf's box,
    pub(crate) midrib: f64,
    /// one of a blade that is more slender than this is no crown,
    pub(crate) slender: f64,
    /// and the midrib and its side veins are at least this many lines.
    pub(crate) veins: usize,
    /// Repeated outlines are fruits or florets, not blades, if they are rounder than this: 4 pi area / perimeter^2, 1
    /// for a circle.
    pub(crate) round: f64,
    /// Repeated outlines are fruits only if they are plumper than this (slenderness).
    pub(crate) plump: f64,
    /// Repeated round outlines smaller than this share of the squared diagonal are fruits or florets.
    pub(crate) small_area: f64,
    /// Larger ones are fruits only if they are circles: rounder than this,
    pub(crate) circular: f64,
    /// about as wide as long, within this share,
    pub(crate) as_wide_as_long: f64,
    /// and stand round no empty middle, as petals do: none is nearer to it than this share of their mean distance from
    /// it.
    pub(crate) empty_middle: f64,
    /// A petal has at least this factor of the area of its flower's disc,
    pub(crate) petal: f64,
    /// and at least this many petals meet at the disc.
    pub(crate) petals_about: usize,
    /// A flower head has at least this many rays,
    pub(crate) rays: usize,
    /// and no wider angle than this between neighbours, radians.
    pub(crate) ray_gap: f64,
    /// A class of the stroke classifier that structure does not contradict stands if its share is above this.
    pub(crate) believed: f64,
    /// The sides of a trunk are farther apart than this; those of a stem are nearer.
    pub(crate) trunk: f64,
    /// Weight of the share of the kind of plant (0 to 1) in the score of a reading of that kind.
    pub(crate) weight_of_kind: f64,
    /// A drawing of at least this many strokes is one of many organs.
    pub(crate) many_strokes: usize,
    /// If it was read as one solid, a structural reading may explain this much less.
    pub(crate) solid_of_many: f64,
    /// A reading as a palm, if that is likely, may explain this much less.
    pub(crate) palm: f64,
    /// Kinds were not learnt from drawings of this many strokes or more: resemblance to a kind weighs less against
    /// their structure.
    pub(crate) no_doodle: usize,
    /// The structural reading replaces another one only if its score is better by more than this.
    pub(crate) clearly_better: f64,
    /// A drawing of more strokes is not examined: the facts of each are found among those of all others.
    pub(crate) most_strokes: usize,
}

/// Chosen on 16 illustrations and on doodles of the choosing part; see `docs/strokes.md`.
pub(crate) const LIMITS: StructureLimits = StructureLimits {
    fewest_strokes: 8,
    careful: 0.6,
    junction: 0.0075,
    closed: 0.08,
    bulge: 0.3,
    spanned: 3,
    one_sided: 0.35,
    hairpin: 0.5,
    round_something: 1.15,
    round_convex: 0.5,
    inside: 0.85,
    smaller: 0.5,
    alike_area: 2.5,
    alike_slenderness: 0.2,
    repeated: 4,
    texture: 6,
    small_mark: 0.35,
    midrib: 0.45,
    slender: 0.55,
    veins: 4,
    round: 0.85,
    plump: 0.72,
    small_area: 0.0015,
    circular: 0.93,
    as_wide_as_long: 0.86,
    empty_middle: 0.6,
    petal: 2.5,
    petals_about: 3,
    rays: 7,
    ray_gap: 1.6,
    believed: 0.5,
    trunk: 0.025,
    weight_of_kind: 0.02,
    many_strokes: 15,
    solid_of_many: 0.05,
    palm: 0.05,
    no_doodle: 40,
    clearly_better: 0.02,
    most_strokes: 400,
};

#[cfg(test)]
mod tests;
