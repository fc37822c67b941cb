//! Rules of reading: evidence of the whole drawing about the class of a stroke, against the classifier.
//!
//! A single stroke does not distinguish a leaf from a cactus or grass from a row of trunks; the strokes inside it,
//! below it and missing around it do. Each rule is a row of [`RULES`]; they are applied in that order, and none
//! changes a class that the user set. `cargo xtask train-strokes` reports what each is worth.
//!
//! Their thresholds stand at the top of each module, those of several below; `thresholds` states their units and
//! origins.

mod as_kind;
mod colours;
mod grass;
mod hanging;
mod one_go;
mod pots;
mod shading;
mod stamens;
mod stems;
mod trees;
mod whole_flower;
mod whole_leaf;
mod whole_tree;

use geom::contains;
use glam::DVec2;
use ink::{COMMON_GROUND, DRAWN_AGAIN, LONE_LINE, StrokeClass, StrokeMode};

use crate::blade::nearest_on_ring;
use crate::draft::{Draft, OneGo};
use crate::near::openness;
use crate::thresholds::STRAIGHT;

pub(crate) use as_kind::take_for;
pub(crate) use trees::{IN_CROWN, SMALL};

/// The rule of the kind that a plant is taken for.
pub const READ_AS: &str = "read-as";
/// The rule that the place of a line decides its class.
pub(crate) const VEINS_IN_BLADES: &str = "veins-in-blades";
/// The rule about stamens with their anthers.
pub(crate) const STAMENS: &str = "stamens";
/// The rule that colours distinguish petals from leaves.
pub(crate) const GREEN_LEAVES: &str = "green-leaves";

/// A rule: evidence of the whole drawing about the class of a stroke.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Its name, in kebab-case, in reports and the ablation.
    pub name: &'static str,
    /// Its statement about drawings, in a sentence for people.
    pub why: &'static str,
    applied: Applied,
}

/// The step in which a rule is applied.
#[derive(Clone, Copy, Debug)]
enum Applied {
    /// In turn with the others of the table.
    Here {
        /// Most strokes of a drawing to which it is applied: nobody draws one such plant with more, and rules compare
        /// pairs.
        most_strokes: usize,
        /// Finds the classes that it gives to strokes of a partly understood drawing.
        finds: fn(&Draft<'_>) -> Findings,
    },
    /// In another step, which has information that the table lacks.
    Elsewhere,
}

/// Findings of a rule.
#[derive(Debug, Default)]
struct Findings {
    classes: Vec<(usize, StrokeClass)>,
    /// Lines that were drawn in one go, there and back: the pieces of such a stroke.
    legs: Vec<(usize, [Vec<DVec2>; 2])>,
    /// Petals that stand off their disc: the disc's stroke, and theirs.
    rings: Vec<(usize, Vec<usize>)>,
    /// Stems with leaves along them, drawn in one go.
    one_go: Vec<(usize, OneGo)>,
    /// Two of the lines are surely the sides of a trunk.
    trunk: bool,
    /// Strokes whose class no later rule changes: it follows from the whole drawing.
    settled: Vec<usize>,
    /// Outlines that make up one crown.
    united: Vec<usize>,
}

impl Findings {
    fn set(&mut self, stroke: usize, class: StrokeClass) {
        self.classes.push((stroke, class));
    }

    fn settle(&mut self, stroke: usize, class: StrokeClass) {
        self.set(stroke, class);
        self.settled.push(stroke);
    }
}

const fn rule(
    name: &'static str,
    most_strokes: usize,
    finds: fn(&Draft<'_>) -> Findings,
    why: &'static str,
) -> Rule {
    Rule { name, why, applied: Applied::Here { most_strokes, finds } }
}

const fn elsewhere(name: &'static str, why: &'static str) -> Rule {
    Rule { name, why, applied: Applied::Elsewhere }
}

/// Limit for rules about drawings of any number of strokes.
const ANY: usize = usize::MAX;
/// Limit for rules about a plant with many parts.
const MANY: usize = 400;
/// Limit for rules about a plant with a leaf or a tuft for each of its lines.
const SOME: usize = 60;
/// Limit for rules about a sketch in a few lines.
const FEW: usize = 40;

/// The rules in the order in which they are applied: first those on whose results others build.
pub const RULES: &[Rule] = &[
    // `ink::classify` applies it, because a preview keeps its class.
    elsewhere(
        LONE_LINE,
        "A lone line is a stem: crowns and trunks are recognised by the strokes around them.",
    ),
    // `ink::classify` applies it, because it judges each plant separately.
    elsewhere(COMMON_GROUND, "A low, flat line on which several plants stand is their ground."),
    // `ink::clean` finds them, and `read` leaves them to the lines that they follow.
    elsewhere(DRAWN_AGAIN, "A line that follows another one along its whole length repeats it."),
    // `read` applies it, because it compares pieces that stand next to one another.
    elsewhere(
        crate::BESIDE_THE_PLANT,
        "Strokes apart from a plant are left out if they hang in the air but need ground, or if they do not look like a plant.",
    ),
    // `read` applies it, because it compares whole readings.
    elsewhere(
        READ_AS,
        "The class of a stroke follows from the kind of plant that explains the whole drawing best, or that the user chose.",
    ),
    rule(
        "whole-flower",
        MANY,
        whole_flower::whole_flower,
        "Similar outlines all round a ring, or one lobed outline round it, are petals round a disc.",
    ),
    rule(
        "whole-tree",
        FEW,
        whole_tree::whole_tree,
        "A round part over a narrow, upright one is a crown on its trunk, in whichever way and order they are drawn.",
    ),
    rule(
        "whole-leaf",
        SOME,
        whole_leaf::whole_leaf,
        "An outline that holds only a line along its middle, and lines that branch off it, is a leaf with its veins.",
    ),
    rule(
        STAMENS,
        MANY,
        stamens::stamens,
        "Lines from the middle of a flower that end in small rings are its stamens.",
    ),
    rule(
        "one-go",
        SOME,
        one_go::one_go,
        "A line that returns to itself on its way and continues is a stem, and the loops are its leaves.",
    ),
    rule(
        "fruits-on-twigs",
        MANY,
        hanging::fruits_on_twigs,
        "Similar round rings that hang from twigs or stalks are fruits.",
    ),
    rule(
        "outline-is-no-twig",
        MANY,
        hanging::outlines_are_no_twigs,
        "A small outline on a supposedly bare tree is a leaf.",
    ),
    rule(
        "ground-over-roots",
        SOME,
        pots::ground_over_roots,
        "A long level line on which a plant stands, with only lines below, is the ground over its roots.",
    ),
    rule("hill", SOME, pots::hill, "A wide arc over which everything else stands is a hill."),
    rule(
        "stems-of-leaves",
        MANY,
        stems::stems,
        "Lines that spread from one place, each to a leaf of its own, are stems and not the sides of a trunk.",
    ),
    rule(
        "sides-of-a-trunk",
        MANY,
        trees::trunk_lines,
        "Two lines side by side that carry a crown, or a fan of fronds, are the sides of a trunk.",
    ),
    rule(
        "crown-on-a-trunk",
        MANY,
        trees::crown_on_trunk,
        "The largest closed outline is a crown if the tops of a trunk reach it from below, however smooth it is.",
    ),
    rule(
        "shading",
        MANY,
        shading::shading,
        "A line that runs to and fro in an outline, and lines side by side in a crown, are shading.",
    ),
    rule(
        "line-is-no-fruit",
        MANY,
        trees::line_is_no_fruit,
        "A line that encloses nothing is not a fruit: along the foot of a crown it is the ground, elsewhere a stalk.",
    ),
    rule(
        "fruit-in-a-crown",
        MANY,
        trees::fruit_in_crown,
        "A small ring inside a crown is a fruit, and a small outline that is longer than wide is a leaf.",
    ),
    rule(
        "pot",
        MANY,
        pots::pots,
        "A box at the bottom with a flat top on which the plant stands is its pot.",
    ),
    rule(
        "green-is-no-bark",
        ANY,
        colours::green_is_no_bark,
        "Green lines in a drawing of several colours are neither bark nor clay.",
    ),
    rule(
        "zigzag",
        FEW,
        grass::zigzags,
        "A stroke that goes up and down while it moves sideways is a row of grass blades.",
    ),
    rule(
        "tuft",
        SOME,
        grass::tufts,
        "Two bare lines drawn in one go, down to a sharp point and up again, are blades of grass.",
    ),
    rule(
        "grass",
        ANY,
        grass::grass,
        "Several single lines, without anything that a trunk could carry, are stalks of grass.",
    ),
    // `veins::collect` applies it, because it must know where the blades end.
    elsewhere(VEINS_IN_BLADES, "A line in a blade is a vein, and a line in no blade is a stem."),
    // `Draft::green_leaves` applies it, because it is about blades that are closed.
    elsewhere(
        GREEN_LEAVES,
        "A green part next to petals of another colour is a leaf, even if it lies round their centre.",
    ),
];

/// Applies all rules except those that are switched `off`.
pub(crate) fn apply(draft: &mut Draft<'_>, off: &[&str]) {
    let count = draft.class.len();
    for rule in RULES.iter().filter(|r| !off.contains(&r.name)) {
        if let Applied::Here { most_strokes, finds } = rule.applied
            && count <= most_strokes
        {
            let found = finds(draft);
            take(draft, found, rule.name);
        }
    }
}

/// Takes the findings of a rule over into the draft.
fn take(draft: &mut Draft<'_>, found: Findings, name: &'static str) {
    for (stroke, class) in found.classes {
        draft.class[stroke] = class;
        draft.rule[stroke] = Some(name);
    }
    for (stroke, legs) in found.legs {
        draft.legs.insert(stroke, legs.into());
    }
    for (stroke, parts) in found.one_go {
        draft.one_go.insert(stroke, parts);
    }
    draft.trunk |= found.trunk;
    found.settled.iter().for_each(|&k| draft.settled[k] = true);
    draft.united.extend(found.united);
    draft.rings.extend(found.rings);
}

/// An outline whose ends are nearer than this share of its length was meant to be closed.
const CLOSED: f64 = 0.2;
/// The same for an outline of a crown or a flower, which is drawn with less care than a box.
const SHUT: f64 = 0.24;
/// Least share of the length that the loop of a closed outline with a stalk has.
const STALK: f64 = 0.35;
/// A trunk's top is at most this far from its crown.
const REACH: f64 = 0.07;
/// Greatest width of a standing part relative to its height: a trunk with a flared foot.
const STANDS: f64 = 1.2;
/// A line stands if it is higher than this share of its width.
const UPRIGHT: f64 = 0.8;
/// Two sides of a trunk are farther apart than this, or the line was drawn twice: three steps of the pen (*sampled*).
const SIDES_APART: f64 = 0.015;
/// Step between points of a stroke of which the share inside something is counted: ink is *sampled* more densely than
/// outlines bend.
const STRIDE: usize = 3;
/// A stroke lies inside a crown if at least this share of its points does: it may stick out a little.
const WITHIN: f64 = 0.8;

fn any(draft: &Draft<'_>, classes: &[StrokeClass]) -> bool {
    draft.class.iter().any(|c| classes.contains(c))
}

/// Returns the share of every `stride`th point that lies in a closed outline, 0 to 1; 0 if there are no points.
pub(crate) fn share_inside(points: &[DVec2], stride: usize, outline: &[DVec2]) -> f64 {
    let (mut looked, mut hits) = (0_u32, 0_u32);
    for &p in points.iter().step_by(stride) {
        looked += 1;
        hits += u32::from(contains(outline, p));
    }
    f64::from(hits) / f64::from(looked.max(1))
}

/// Whether a rule may change the class of a stroke: it is not sure.
pub(crate) fn unsure(draft: &Draft<'_>, k: usize) -> bool {
    !draft.settled[k] && !draft.said[k].is_sure() && draft.ink.strokes[k].mode == StrokeMode::Parts
}

/// Whether at most the kind of the whole decided the class of a stroke.
fn free(draft: &Draft<'_>, k: usize) -> bool {
    let settled = draft.settled[k] && draft.rule[k] != Some(READ_AS);
    !settled && !draft.said[k].is_sure() && draft.ink.strokes[k].mode == StrokeMode::Parts
}

/// Returns the highest point and the lowest point.
fn ends(points: &[DVec2]) -> (DVec2, DVec2) {
    let (a, b) = (points[0], points[points.len() - 1]);
    if a.y > b.y { (a, b) } else { (b, a) }
}

/// Returns the distance to an outline, 0 inside.
fn outside(outline: &[DVec2], p: DVec2) -> f64 {
    if contains(outline, p) { 0.0 } else { nearest_on_ring(outline, p).1 }
}

/// Whether a line stands: it is rather straight, and higher than wide.
fn upright(draft: &Draft<'_>, k: usize) -> bool {
    let s = &draft.ink.strokes[k];
    let (top, foot) = ends(&s.points);
    openness(s) > STRAIGHT && top.y - foot.y > UPRIGHT * (top.x - foot.x).abs()
}

/// Returns the upper and lower ends of the upright lines of a class.
fn standing(draft: &Draft<'_>, class: StrokeClass) -> Vec<(usize, DVec2, DVec2)> {
    draft
        .strokes_of_class(class)
        .into_iter()
        .filter(|&k| upright(draft, k))
        .map(|k| {
            let (top, foot) = ends(&draft.ink.strokes[k].points);
            (k, top, foot)
        })
        .collect()
}
