//! Plausibility: whether a person would accept a result, for all makers.
//!
//! Each check compares a measured value with one of [`PLAUSIBLE`]; makers add their own facts. The table of checks is
//! in `docs/limits.md`.

use base::{Bound, Check, Report, Severity, ops};
use bloom::{GrowthLaw, Quantity, RegionLaw};
use formats::StructureTally;
use glam::DVec3;
use growth::{Method, TreeSpec};
use ink::Ink;
use plant::{OrganKind, Plant};
use reading::{Kind, OrganWord, Reading};
use scan::{PipeSource, ScanTally};

use crate::report::{GrowthReport, LeafReport, ReadingReport};

/// Limits between which results are plausible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlausibilityLimits {
    /// The longest side of a plant, metres: trees could reach 122 to 130 m (Koch et al., Nature 428, 2004).
    pub size_most_m: f64,
    /// The longest side of a plant, metres: the smallest flowering plants, of the genus Wolffia, are half a millimetre
    /// long. A round bound below them.
    pub size_least_m: f64,
    /// The length of a leaf on a plant, metres: the longest that was measured, of the palm Raphia regalis, had 25.11 m.
    /// A round bound above it.
    pub leaf_most_m: f64,
    /// The length of a blade in one piece, metres: those of the banana Musa ingens have 5 m (Argent, Notes from the
    /// Royal Botanic Garden Edinburgh 35, 1976).
    pub blade_most_m: f64,
    /// The length of a measured leaf, metres: less than a millimetre is a wrong unit.
    pub blade_least_m: f64,
    /// The height of a stem, as a multiple of that at which a column of wood as thick as its foot would buckle under
    /// its own weight. Culms are hollow: a reed of 4 m and 1 cm has 1.08. A round bound above it.
    pub slender_most: f64,
    /// The volume of the shoot over the cube of the plant's longest side: a spherical cactus has 0.52.
    pub volume_most: f64,
    /// The same for a plant larger than [`Self::tall_m`]: a tree of 22 m whose trunk is a cylinder of 10 m across and
    /// 11 m high, as stout as a baobab, has 0.081.
    pub wood_most: f64,
    /// Size above which a plant is no longer a sphere, metres: the largest barrel cacti, of Echinocactus platyacanthus,
    /// have 2.5 m, one has 2.95 m.
    pub tall_m: f64,
    /// One side of all leaves over the square of the plant's longest side: leaf area indices are 18 at most (Asner,
    /// Scurlock and Hicke, Global Ecology and Biogeography 12, 2003), and no crown is wider than the longest side. A
    /// round bound above it.
    pub leaf_area_most: f64,
    /// The share of the input that may stay unused: ink, points, stages.
    pub unused_most: f64,
    /// Least diagonal of the plant's front over that of the drawing, or of the tree's box over that of its points: half
    /// of it is missing.
    pub extent_least: f64,
    /// Largest value of the same ratio: half of it is too much.
    pub extent_most: f64,
    /// Least probability that a reading is right: of 42 drawings by people below this, 18 were read right
    /// (`docs/strokes.md`).
    pub score_least: f64,
    /// The height of a tree of a scan, metres: a lower one is a seedling, or in another unit.
    pub tree_least_m: f64,
    /// The share of a scan's rings whose radius was seen: the others have the radius of the pipe model.
    pub circles_least: f64,
    /// Most trunks in a scan from which one was chosen, unless somebody chose it.
    pub stems_most: f64,
    /// The share of a tree's points that are connected to nothing on the ground: its crown beyond a gap.
    pub loose_most: f64,
    /// The height of a tree over that of the highest point that may be its own.
    pub top_least: f64,
    /// The share of a tree's points near its wood, or in its leaves.
    pub explained_least: f64,
    /// Least volume of all wood over that of a cylinder of its height and diameter at 1.3 m: stems alone have 0.3 to
    /// 0.6 (Kramer and Akca, Leitfaden zur Waldmesslehre, 1995), and branches of broad crowns at most as much again. A
    /// round bound beyond.
    pub form_least: f64,
    /// Largest value of the same ratio.
    pub form_most: f64,
    /// Least circles to which the exponent of the pipe model is fitted.
    pub circles_fewest: f64,
    /// Least exponent of the pipe model: the fit of scans ends at 1.25.
    pub exponent_least: f64,
    /// Largest exponent of the pipe model: the fit of scans ends at 4.
    pub exponent_most: f64,
    /// The share of the points of a plant of several organs that one organ may have: among three or more, and among
    /// two. In seedlings with separated organs the largest has 39 to 47 %.
    pub organ_most: [f64; 2],
    /// Crossings of the margin of a measured leaf with itself.
    pub crossings_most: f64,
    /// The share of growth laws that the days may leave undetermined.
    pub undetermined_most: f64,
    /// The size at the end of its law over that at the beginning: less means a table in the wrong order.
    pub growth_least: f64,
}

/// The limits that all makers are checked against.
pub const PLAUSIBLE: PlausibilityLimits = PlausibilityLimits {
    size_most_m: 130.0,
    size_least_m: 0.000_3,
    leaf_most_m: 26.0,
    blade_most_m: 5.0,
    blade_least_m: 0.001,
    slender_most: 1.5,
    volume_most: 0.8,
    wood_most: 0.1,
    tall_m: 3.0,
    leaf_area_most: 20.0,
    unused_most: 0.6,
    extent_least: 0.5,
    extent_most: 1.5,
    score_least: 0.4,
    tree_least_m: 0.3,
    circles_least: 0.05,
    stems_most: 1.0,
    loose_most: 0.2,
    top_least: 0.8,
    explained_least: 0.6,
    form_least: 0.2,
    form_most: 2.0,
    circles_fewest: 8.0,
    exponent_least: 1.26,
    exponent_most: 3.99,
    organ_most: [0.7, 0.9],
    crossings_most: 0.0,
    undetermined_most: 0.6,
    growth_least: 0.95,
};

/// Factor of the buckling height: a column of green wood of `d` metres in diameter buckles at this times d^(2/3)
/// metres, (7.837 E / 16 w)^(1/3) for a cylinder (Greenhill 1881), with a stiffness E of 10.3 `GPa` and the weight w of
/// water, 9.81 kN in a cubic metre.
const BUCKLING: f64 = 80.1;

/// Names of all checks, which are the codes of their warnings.
pub const CHECKS: [&str; 32] = [
    "nothing-made",
    "size-large",
    "size-small",
    "leaf-long",
    "stem-slender",
    "volume-large",
    "leaf-area-large",
    "ink-unexplained",
    "extent-small",
    "extent-large",
    "lines-bare",
    "reading-unsure",
    "growth-unused",
    "blade-long",
    "blade-short",
    "margin-crossed",
    "marks-unexplained",
    "tree-small",
    "scan-unused",
    "scan-radii-unseen",
    "several-stems",
    "scan-loose",
    "tree-cut",
    "scan-unexplained",
    "volume-small-for-stem",
    "volume-large-for-stem",
    "pipe-exponent-default",
    "pipe-exponent-on-bound",
    "one-organ",
    "laws-undetermined",
    "laws-shrink",
    "structure-unused",
];

/// Form in which a value is shown to people.
#[derive(Clone, Copy)]
enum Figure {
    Share,
    Metres,
    Number,
}

impl Figure {
    /// Formats a value with three significant digits and its unit.
    fn show(self, value: f64) -> String {
        let (value, unit) = match self {
            Self::Share => (100.0 * value, " %"),
            Self::Metres => (value, " m"),
            Self::Number => (value, ""),
        };
        let size = value.abs();
        match size {
            _ if size == 0.0 => format!("0{unit}"),
            _ if !(1e-4..1e6).contains(&size) => format!("{value:.1e}{unit}"),
            _ if size >= 100.0 => format!("{value:.0}{unit}"),
            _ if size >= 1.0 => format!("{}{unit}", (value * 10.0).round() / 10.0),
            _ => format!("{}{unit}", (value * 1e4).round() / 1e4),
        }
    }
}

/// One check as written below; `message` holds `{value}`.
struct Test {
    name: &'static str,
    value: f64,
    bound: Bound,
    figure: Figure,
    message: &'static str,
    advice: &'static str,
}

impl Test {
    fn tell(self, report: &mut Report) {
        self.tell_as(Severity::Warning, report);
    }

    fn tell_as(self, severity: Severity, report: &mut Report) {
        let Self { name, value, bound, figure, message, advice } = self;
        debug_assert!(CHECKS.contains(&name), "{name} is listed");
        let shown = [figure.show(value), figure.show(bound.number())];
        let message = message.replace("{value}", &shown[0]);
        report.check(Check { name, value, bound, shown, severity, message, advice });
    }
}

/// Checks any plant. Cost: linear in nodes and organs.
pub(crate) fn check_plant(plant: &Plant, report: &mut Report) {
    Test {
        name: "nothing-made",
        value: (plant.axes.len() + plant.organs.len()) as f64,
        bound: Bound::AtLeast(1.0),
        figure: Figure::Number,
        message: "the plant has {value} axes and organs",
        advice: "draw or measure a stem or a leaf, give growth room and points, or take back edits that remove everything",
    }
    .tell_as(Severity::Error, report);
    let Some((low, high)) = plant.extent() else { return };
    let size = (high - low).max_element();
    if size <= 0.0 {
        return;
    }
    check_size(size, report);
    check_leaves(plant, size, report);
    check_wood(plant, size, report);
}

fn check_size(size: f64, report: &mut Report) {
    Test {
        name: "size-large",
        value: size,
        bound: Bound::AtMost(PLAUSIBLE.size_most_m),
        figure: Figure::Metres,
        message: "the plant is {value} large",
        advice: "no plant is: check the unit of the input, or set its height",
    }
    .tell(report);
    Test {
        name: "size-small",
        value: size,
        bound: Bound::AtLeast(PLAUSIBLE.size_least_m),
        figure: Figure::Metres,
        message: "the plant is only {value} large",
        advice: "no plant is so small: check the unit of the input, or set its height",
    }
    .tell(report);
}

fn check_leaves(plant: &Plant, size: f64, report: &mut Report) {
    let reaches: Vec<f64> = plant.shapes.iter().map(plant::Shape::reach).collect();
    let areas: Vec<f64> = plant.shapes.iter().map(plant::Shape::one_side_m2).collect();
    let leaves = || plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
    let of = |values: &[f64], o: &plant::Organ| values.get(o.shape.index()).copied().unwrap_or(0.0);
    let longest = leaves().map(|o| of(&reaches, o) * o.scale).fold(0.0, f64::max);
    if longest <= 0.0 {
        return;
    }
    Test {
        name: "leaf-long",
        value: longest,
        bound: Bound::AtMost(PLAUSIBLE.leaf_most_m),
        figure: Figure::Metres,
        message: "the longest leaf has {value}",
        advice: "no leaf is so long: check the unit of the input, or set the height",
    }
    .tell(report);
    let area: f64 = leaves().map(|o| of(&areas, o) * o.scale * o.scale).sum();
    Test {
        name: "leaf-area-large",
        value: area / (size * size),
        bound: Bound::AtMost(PLAUSIBLE.leaf_area_most),
        figure: Figure::Number,
        message: "the leaves have {value} times the area of a square as wide as the plant",
        advice: "no crown bears so many: set fewer or smaller leaves",
    }
    .tell(report);
}

fn check_wood(plant: &Plant, size: f64, report: &mut Report) {
    let (mut volume, mut thickest, mut top) = (0.0, 0.0_f64, 0.0_f64);
    for axis in plant.axes.iter().filter(|a| a.kind.is_shoot()) {
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        let (line, radii) = (&plant.nodes.position[rows.clone()], &plant.nodes.radius_m[rows]);
        for (p, r) in line.windows(2).zip(radii.windows(2)) {
            volume += ops::PI / 3.0 * p[0].distance(p[1]) * (r[0] * r[0] + r[0] * r[1] + r[1] * r[1]);
        }
        if axis.bearer.is_none() {
            let foot = line.first().map_or(0.0, |p| p.y);
            thickest = radii.iter().fold(thickest, |a, &r| a.max(r));
            top = line.iter().fold(top, |a, p| a.max(p.y - foot));
        }
    }
    if volume <= 0.0 {
        return;
    }
    Test {
        name: "volume-large",
        value: volume / (size * size * size),
        bound: Bound::AtMost(if size > PLAUSIBLE.tall_m {
            PLAUSIBLE.wood_most
        } else {
            PLAUSIBLE.volume_most
        }),
        figure: Figure::Number,
        message: "the stems have {value} times the volume of a cube as wide as the plant",
        advice: "they are too thick for its height: check the unit and the radii, or set the height",
    }
    .tell(report);
    if top > 0.0 && thickest > 0.0 {
        Test {
            name: "stem-slender",
            value: top / (BUCKLING * ops::powf(2.0 * thickest, 2.0 / 3.0)),
            bound: Bound::AtMost(PLAUSIBLE.slender_most),
            figure: Figure::Number,
            message: "the main stem has {value} times the height at which it would buckle under its own weight",
            advice: "it is too thin: check the radii, or set the height",
        }
        .tell(report);
    }
}

/// A drawing and the plant made of it, before hand edits.
pub(crate) struct Sketched<'a> {
    pub(crate) ink: &'a Ink,
    pub(crate) reading: &'a Reading,
    /// Diagonal of the front of the meshes over that of the drawing; `None` if edits changed the plant.
    pub(crate) extent: Option<f64>,
    /// Whether nobody said what the drawing shows.
    pub(crate) is_guessed: bool,
}

/// Checks a plant as it was read from a file of structure. Cost: linear.
pub fn check_read(plant: &Plant, tally: &StructureTally) -> Report {
    let mut report = Report::default();
    check_plant(plant, &mut report);
    check_structure(tally, &mut report);
    report
}

/// Checks the plant of a file of structure.
pub(crate) fn check_structure(tally: &StructureTally, report: &mut Report) {
    if tally.entries == 0 {
        return;
    }
    Test {
        name: "structure-unused",
        value: tally.entries.saturating_sub(tally.used) as f64 / tally.entries as f64,
        bound: Bound::AtMost(PLAUSIBLE.unused_most),
        figure: Figure::Share,
        message: "{value} of the entries of the file are in no plant",
        advice: "they have no place, or no size: export the plant with its geometry",
    }
    .tell(report);
}

/// Checks the plant of a drawing.
pub(crate) fn check_sketch(made: &Sketched<'_>, report: &mut Report) {
    let ignored =
        base::set_of(made.reading.strokes.iter().filter(|s| s.organ == OrganWord::Ignored).map(|s| s.index));
    let sum = |all: bool| -> f64 {
        let counted = made.ink.strokes.iter().filter(|s| all || ignored.contains_key(&s.index));
        counted.fold(0.0, |sum, s| sum + s.length)
    };
    let whole = sum(true);
    if whole > 0.0 {
        Test {
            name: "ink-unexplained",
            value: sum(false) / whole,
            bound: Bound::AtMost(PLAUSIBLE.unused_most),
            figure: Figure::Share,
            message: "{value} of the ink, by length, is no part of the plant",
            advice: "say what these strokes are, or draw the plant without what is around it",
        }
        .tell(report);
    }
    if let Some(extent) = made.extent {
        check_extent(extent, "the plant has {value} of the drawing's extent", report);
    }
    let tangled = reading::tangled_length(made.reading);
    if tangled > 0.0 {
        Test {
            name: "lines-bare",
            value: tangled,
            bound: Bound::AtMost(reading::TANGLE_LIMITS.length_most),
            figure: Figure::Number,
            message: "lines {value} times as long as the drawing's diagonal are axes that lead to no organ",
            advice: "shading and outlines of ink are read as twigs: draw the outline of each organ with one line, over \
                     the picture if it is one, or say what the strokes are",
        }
        .tell(report);
    }
    let score = ReadingReport::from_reading(made.reading).first().map(|r| r.score);
    // A line by itself is a stem by rule, so that no kind was compared with another. A tangle has been reported
    // already.
    let is_lone_stem = made.reading.strokes.len() == 1
        && made.reading.plants.iter().all(|p| matches!(p.kind, Kind::Stem | Kind::None));
    let is_weighed = made.is_guessed && !is_lone_stem && tangled == 0.0;
    if let Some(score) = score.filter(|_| is_weighed) {
        Test {
            name: "reading-unsure",
            value: score,
            bound: Bound::AtLeast(PLAUSIBLE.score_least),
            figure: Figure::Number,
            message: "the reading explains the drawing with a score of {value}",
            advice: "most readings below that are wrong: say what kind of plant it is, or what its strokes are",
        }
        .tell(report);
    }
}

/// Checks `value`, the size of the result over that of its input.
fn check_extent(value: f64, message: &'static str, report: &mut Report) {
    Test {
        name: "extent-small",
        value,
        bound: Bound::AtLeast(PLAUSIBLE.extent_least),
        figure: Figure::Share,
        message,
        advice: "much of the input is not in it: leave out what is far from the plant, or say what it is",
    }
    .tell(report);
    Test {
        name: "extent-large",
        value,
        bound: Bound::AtMost(PLAUSIBLE.extent_most),
        figure: Figure::Share,
        message,
        advice: "it reaches beyond its input: say what the strokes at its end are, or give more of them",
    }
    .tell(report);
}

/// Checks a grown tree.
pub(crate) fn check_tree(spec: &TreeSpec, plant: &Plant, growth: &GrowthReport, report: &mut Report) {
    if growth.attractors > 0 {
        Test {
            name: "growth-unused",
            value: growth.unreachable as f64 / growth.attractors as f64,
            bound: Bound::AtMost(PLAUSIBLE.unused_most),
            figure: Figure::Share,
            message: "{value} of the points that growth follows were never reached",
            advice: "bring the root nearer, let branches see farther, or move obstacles out of the crown",
        }
        .tell(report);
    }
    let Method::Points { points, .. } = &spec.method else { return };
    let box_of = |all: &mut dyn Iterator<Item = DVec3>| {
        let (low, high) = all.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        (high - low).length()
    };
    let given = box_of(&mut points.iter().chain(&spec.roots).copied());
    let grown = box_of(&mut plant.nodes.position.iter().copied());
    if given > 0.0 && grown.is_finite() {
        check_extent(grown / given, "the tree has {value} of the extent of its points", report);
    }
}

/// Checks a leaf of marks, veins or a scan.
pub(crate) fn check_leaf(leaf: &LeafReport, crossings: Option<usize>, report: &mut Report) {
    let length = leaf.length_mm * 1e-3;
    Test {
        name: "blade-long",
        value: length,
        bound: Bound::AtMost(PLAUSIBLE.blade_most_m),
        figure: Figure::Metres,
        message: "the blade is {value} long",
        advice: "no blade in one piece is: check the unit of the input, or set its length",
    }
    .tell(report);
    Test {
        name: "blade-short",
        value: length,
        bound: Bound::AtLeast(PLAUSIBLE.blade_least_m),
        figure: Figure::Metres,
        message: "the blade is {value} long",
        advice: "no blade that can be measured is so short: check the unit of the input, or set its length",
    }
    .tell(report);
    let explained = match &leaf.scan {
        Some(scan) => leaf.fit_error.explained.min(scan.covered),
        None => leaf.fit_error.explained,
    };
    Test {
        name: "marks-unexplained",
        value: 1.0 - explained,
        bound: Bound::AtMost(PLAUSIBLE.unused_most),
        figure: Figure::Share,
        message: "{value} of what was measured is farther than 2 mm from the blade",
        advice: "check the unit, and that it is one leaf that lies open; approximate surfaces need more marks",
    }
    .tell(report);
    if let Some(crossings) = crossings {
        Test {
            name: "margin-crossed",
            value: crossings as f64,
            bound: Bound::AtMost(PLAUSIBLE.crossings_most),
            figure: Figure::Number,
            message: "the margin of the leaf crosses itself {value} times",
            advice: "check the order of the marks: from the tip to the base, and in each row from side to side",
        }
        .tell(report);
    }
}

/// Checks a tree of a scan; `is_placed`: somebody said which of several trees it is.
pub(crate) fn check_scan(plant: &Plant, tally: &ScanTally, is_placed: bool, report: &mut Report) {
    let height = plant.extent().map_or(0.0, |(low, high)| high.y - low.y);
    Test {
        name: "tree-small",
        value: height,
        bound: Bound::AtLeast(PLAUSIBLE.tree_least_m),
        figure: Figure::Metres,
        message: "the tree is only {value} high",
        advice: "check the unit of the scan; a seedling is better made as a leaf or from its organs",
    }
    .tell(report);
    let above = tally.points.saturating_sub(tally.ground);
    let others = if is_placed { 0 } else { tally.others + tally.other_things };
    if above > 0 {
        Test {
            name: "scan-unused",
            value: (tally.noise + others).min(above) as f64 / above as f64,
            bound: Bound::AtMost(PLAUSIBLE.unused_most),
            figure: Figure::Share,
            message: "{value} of the points above the ground are no part of the tree",
            advice: "cut the tree out of the scan, say where it stands, or let wider gaps be bridged",
        }
        .tell(report);
    }
    if tally.rings > 0 {
        Test {
            name: "scan-radii-unseen",
            value: tally.circles as f64 / tally.rings as f64,
            bound: Bound::AtLeast(PLAUSIBLE.circles_least),
            figure: Figure::Share,
            message: "{value} of the tree's sections show a radius",
            advice: "radii and volume are guessed: scan nearer, from more sides, or without leaves",
        }
        .tell(report);
    }
    check_cloud(height, tally, is_placed, report);
    check_volume(plant, report);
    check_pipes(tally, report);
}

/// Checks that the cloud holds the whole tree, and nothing else.
fn check_cloud(height: f64, tally: &ScanTally, is_placed: bool, report: &mut Report) {
    if !is_placed {
        Test {
            name: "several-stems",
            value: tally.stems.max(1) as f64,
            bound: Bound::AtMost(PLAUSIBLE.stems_most),
            figure: Figure::Number,
            message: "{value} trunks stand in the scan, of which one was taken",
            advice: "say where the stem stands that is meant, or make a tree of each",
        }
        .tell(report);
    }
    let own = tally.wood + tally.leaves + tally.loose;
    if own > 0 {
        Test {
            name: "scan-loose",
            value: tally.loose as f64 / own as f64,
            bound: Bound::AtMost(PLAUSIBLE.loose_most),
            figure: Figure::Share,
            message: "{value} of the points of the tree lie beyond a gap, and were left out",
            advice: "let wider gaps be bridged, or cut out what is not the tree",
        }
        .tell(report);
        Test {
            name: "scan-unexplained",
            value: tally.explained,
            bound: Bound::AtLeast(PLAUSIBLE.explained_least),
            figure: Figure::Share,
            message: "{value} of the points of the tree lie near its wood or in its leaves",
            advice: "much of the cloud is not in the model: let wider gaps be bridged, say smaller cubes, or scan more densely",
        }
        .tell(report);
    }
    if tally.top_m > 0.0 {
        Test {
            name: "tree-cut",
            value: height / tally.top_m,
            bound: Bound::AtLeast(PLAUSIBLE.top_least),
            figure: Figure::Share,
            message: "the tree is {value} as high as its points",
            advice: "its top was left out: let wider gaps be bridged, or say where the stem stands",
        }
        .tell(report);
    }
}

/// Checks the volume of a tree against its height and its diameter.
fn check_volume(plant: &Plant, report: &mut Report) {
    let m = plant.measure();
    let Some(dbh) = m.dbh_m.filter(|d| *d > 0.0 && m.height_m > PLAUSIBLE.tall_m) else { return };
    let form = m.wood_volume_m3 / (0.25 * ops::PI * dbh * dbh * m.height_m);
    Test {
        name: "volume-small-for-stem",
        value: form,
        bound: Bound::AtLeast(PLAUSIBLE.form_least),
        figure: Figure::Number,
        message: "the wood has {value} times the volume of a cylinder of its height and diameter",
        advice: "much of the tree is missing, or its diameter is wrong: let wider gaps be bridged, or scan from more sides",
    }
    .tell(report);
    Test {
        name: "volume-large-for-stem",
        value: form,
        bound: Bound::AtMost(PLAUSIBLE.form_most),
        figure: Figure::Number,
        message: "the wood has {value} times the volume of a cylinder of its height and diameter",
        advice: "no tree has: its branches are too thick, or it is several trees. Scan nearer or without leaves, or make a tree of \
                 each stem",
    }
    .tell(report);
}

/// Checks that the radii of thin branches follow from the measured ones.
fn check_pipes(tally: &ScanTally, report: &mut Report) {
    Test {
        name: "pipe-exponent-default",
        value: tally.pipe_circles as f64,
        bound: Bound::AtLeast(PLAUSIBLE.circles_fewest),
        figure: Figure::Number,
        message: "{value} sound circles were found",
        advice: "the exponent of the pipe model is that of other trees, so volume and radii of branches are guessed: scan nearer, \
                 from more sides, or without leaves",
    }
    .tell(report);
    if tally.pipe_source == PipeSource::Default {
        return;
    }
    let exponent = tally.pipe_exponent;
    let [low, high] = [PLAUSIBLE.exponent_least, PLAUSIBLE.exponent_most];
    Test {
        name: "pipe-exponent-on-bound",
        value: exponent,
        bound: if exponent < low { Bound::AtLeast(low) } else { Bound::AtMost(high) },
        figure: Figure::Number,
        message: "the exponent of the pipe model is {value}",
        advice: "its fit ends there, so radii of thin branches are not to be trusted: scan nearer, or without leaves",
    }
    .tell(report);
}

/// Checks a plant of labelled organs by the points of each.
pub(crate) fn check_organs(points: &[usize], report: &mut Report) {
    let sum: usize = points.iter().sum();
    let most = points.iter().copied().max().unwrap_or(0);
    if points.len() < 2 || sum == 0 {
        return;
    }
    Test {
        name: "one-organ",
        value: most as f64 / sum as f64,
        bound: Bound::AtMost(PLAUSIBLE.organ_most[usize::from(points.len() < 3)]),
        figure: Figure::Share,
        message: "one organ has {value} of all points",
        advice: "the organs were not told apart: label them by hand",
    }
    .tell(report);
}

/// Checks growth laws, with their warnings.
pub fn check_law(law: &GrowthLaw) -> Report {
    let mut report = Report::default();
    let all = law.laws.len();
    if all == 0 {
        return report;
    }
    // A constant size is no evidence of growth, however well a law follows it.
    let is_still = |values: &[f64]| values.windows(2).all(|w| w[0] == w[1]);
    let tells_nothing =
        |l: &&RegionLaw| !l.is_determined() || (l.axis == Quantity::Size && is_still(&l.values));
    let undetermined = law.laws.iter().filter(tells_nothing).count();
    Test {
        name: "laws-undetermined",
        value: undetermined as f64 / all as f64,
        bound: Bound::AtMost(PLAUSIBLE.undetermined_most),
        figure: Figure::Share,
        message: "{value} of the laws are not determined by their days, and drive nothing",
        advice: "measure on more days, from the beginning of growth to its end",
    }
    .tell(&mut report);
    let sizes = law.laws.iter().filter(|l| l.axis == Quantity::Size);
    let ends = sizes.filter_map(|l| Some((*l.values.first()?, *l.values.last()?)));
    let least = ends.filter(|(first, _)| *first > 0.0).map(|(first, last)| last / first).reduce(f64::min);
    if let Some(least) = least {
        Test {
            name: "laws-shrink",
            value: least,
            bound: Bound::AtLeast(PLAUSIBLE.growth_least),
            figure: Figure::Share,
            message: "a size has {value} of its first value on the last day",
            advice: "organs do not shrink as they grow: check days, order and unit of the table",
        }
        .tell(&mut report);
    }
    report
}

#[cfg(test)]
mod tests {
    use plant::AxisKind;

    use super::*;

    fn failed(report: &Report) -> Vec<&'static str> {
        report.checks.iter().filter(|c| !c.holds()).map(|c| c.name).collect()
    }

    fn column(height: f64, radius: f64) -> Plant {
        let mut plant = Plant::default();
        plant.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * height], None);
        plant.nodes.radius_m = vec![radius; 2];
        plant
    }

    fn failed_of(plant: &Plant) -> Vec<&'static str> {
        let mut report = Report::default();
        check_plant(plant, &mut report);
        assert_eq!(failed(&report), report.warnings.iter().map(|w| w.code).collect::<Vec<_>>());
        failed(&report)
    }

    #[test]
    fn the_docs_have_a_row_for_each_check_and_for_nothing_else() {
        let docs = include_str!("../../../docs/limits.md");
        let part = docs.split("\n## ").find(|part| part.starts_with("What is checked of results\n")).unwrap();
        let rows = part.lines().filter(|line| line.starts_with("| `"));
        // The first cell has the names, each in backticks.
        let names = |row: &'static str| {
            row.split('|').nth(1).into_iter().flat_map(|c| c.split('`').skip(1).step_by(2))
        };
        let mut told: Vec<&str> = rows.flat_map(names).collect();
        let mut made: Vec<&str> = CHECKS.into_iter().chain(crate::lit::LIGHT_CHECKS).collect();
        told.sort_unstable();
        made.sort_unstable();
        assert_eq!(told, made);
    }

    #[test]
    fn columns_are_plausible_between_the_bounds() {
        assert_eq!(failed_of(&column(20.0, 0.2)), [""; 0]);
        assert_eq!(failed_of(&Plant::default()), ["nothing-made"]);
        assert_eq!(failed_of(&column(140.0, 4.0)), ["size-large"]);
        assert_eq!(failed_of(&column(0.4, 0.2)), [""; 0]);
        assert_eq!(failed_of(&column(0.000_2, 0.000_02)), ["size-small"]);
        assert_eq!(failed_of(&column(20.0, 5.0)), ["volume-large"]);
        // A column of 0.1 m buckles at 17.26 m.
        assert_eq!(failed_of(&column(1.5 * 17.2, 0.05)), [""; 0]);
        assert_eq!(failed_of(&column(1.5 * 17.5, 0.05)), ["stem-slender"]);
    }

    fn item_of(plant: &Plant) -> crate::ItemReport {
        let (mut checks, mut item) = (Report::default(), crate::ItemReport::default());
        check_plant(plant, &mut checks);
        item.add_checks(checks);
        item
    }

    #[test]
    fn only_an_error_refuses_unless_asked_to_be_strict() {
        let thin = item_of(&column(30.0, 0.05));
        assert_eq!((thin.refusal(false), thin.warnings.len()), (None, 1));
        assert_eq!(thin.refusal(true).map(|c| c.name.as_str()), Some("stem-slender"));
        assert_eq!(item_of(&Plant::default()).refusal(false).map(|c| c.name.as_str()), Some("nothing-made"));
    }

    #[test]
    fn organs_that_were_not_told_apart_are_doubted() {
        let told = |points: &[usize]| {
            let mut report = Report::default();
            check_organs(points, &mut report);
            failed(&report)
        };
        assert_eq!(told(&[950, 30, 20]), ["one-organ"]);
        assert_eq!(told(&[138, 22, 20]), ["one-organ"]);
        assert_eq!(told(&[80, 20]), [""; 0]);
        assert_eq!(told(&[500, 300, 200]), [""; 0]);
    }

    #[test]
    fn figures_have_the_digits_that_count() {
        let shown = [
            (0.7234, Figure::Share),
            (0.000_3, Figure::Metres),
            (2100.4, Figure::Metres),
            (0.0, Figure::Number),
        ];
        let words = shown.map(|(value, figure)| figure.show(value));
        assert_eq!(words, ["72.3 %", "0.0003 m", "2100 m", "0"]);
    }
}
