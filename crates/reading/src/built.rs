//! The kind of plant that a drawing shows, judged by the parts that were read.

use geom::{bounds, polyline_length, signed_area};
use glam::DVec2;
use ink::StrokeClass;
use plant::AxisKind;

use crate::thresholds::FEWEST_PETALS;
use crate::{AxisReading, Kind, OrganWord, Reading, RegionReading};
/// A crown over less bare trunk than this share of its height is a bush.
const BARE: f64 = 0.1;
/// That share if the trunk has an outline: nobody draws the sides of a hidden trunk.
const BARE_OUTLINE: f64 = 0.04;
/// Least height of a conifer relative to its width.
const POINTED_TALL: f64 = 0.9;
/// Greatest mean width of the upper part of a conifer relative to its lower part.
const POINTED_THIN: f64 = 0.45;
/// The upper part, as shares of the height.
const ABOVE: core::ops::Range<f64> = 0.74..0.92;
/// The lower part, as shares of the height.
const BELOW: core::ops::Range<f64> = 0.08..0.35;
/// Fronds are rooted nearer to the top of their trunk than this share of its length.
const AT_TOP: f64 = 0.45;
/// Fronds are at least this fraction of all leaves.
const MOST: (usize, usize) = (2, 3);
/// One leaf has more than this share of the area of all: it is the plant.
const MAIN_LEAF: f64 = 0.75;
/// Blades of grass are rooted in this lowest share of the drawing.
const ROOTED: f64 = 0.35;
/// At least this fraction of the leaves is rooted there.
const NEARLY_ALL: (usize, usize) = (3, 4);
/// Fewest blades of grass.
const FEWEST_STALKS: usize = 3;

impl Kind {
    /// Returns the kind that the parts of a reading form together: the kind that will be built. A drawing of several
    /// plants has the kind of all parts taken as one plant.
    ///
    /// ```
    /// use reading::{Kind, Reading};
    /// assert_eq!(Kind::from_reading(&Reading::default()), Kind::None);
    /// assert_eq!(Kind::from_word("tree"), Some(Kind::Tree));
    /// ```
    pub fn from_reading(reading: &Reading) -> Self {
        // A bell or tube is one outline.
        let is_bell = |f: &crate::FlowerReading| f.petals.len() == 1 && f.disc.is_none();
        let petals = |f: &crate::FlowerReading| f.petals.len() >= FEWEST_PETALS || is_bell(f);
        let flowers = reading.flowers.iter().filter(|f| petals(f)).count();
        let petal_area: f64 =
            reading.flowers.iter().flat_map(|f| &f.petals).map(|p| signed_area(&p.outline)).sum();
        let leaf_area: f64 = reading.leaves.iter().map(|l| signed_area(&l.outline)).sum();
        let crown_area: f64 = reading.regions.iter().map(|r| signed_area(&r.outline)).sum();
        let fruit_area: f64 = reading.fruits.iter().map(|f| signed_area(&f.outline)).sum();
        let potted = reading.strokes.iter().any(|s| s.class == StrokeClass::Pot);
        let body = reading.axes.iter().find(|a| a.bearer.is_none() && !a.half_width.is_empty());
        let bare = reading.regions.is_empty() && flowers == 0;
        // Fruits in a crown are its fruits.
        if fruit_area > crown_area.max(leaf_area).max(petal_area) && body.is_none() {
            return Self::Fruit;
        }
        if body.is_some() && bare && (leaf_area <= 0.0 || !reading.thorns.is_empty()) {
            let branches = reading.axes.iter().filter(|a| !drawn_thick(a) && a.bearer.is_some()).count();
            let open = reading.woody && branches > 0;
            return if open { Self::Tree } else { Self::Cactus };
        }
        let largest = |a: &&RegionReading, b: &&RegionReading| {
            signed_area(&a.outline).total_cmp(&signed_area(&b.outline))
        };
        let crown = reading.regions.iter().max_by(largest);
        // A tree is no house plant, whatever stands at its foot.
        let tree = crown.map(|c| judge_crown(reading, c)).filter(|k| k.is_like(Self::Tree) && body.is_some());
        if potted {
            return tree.unwrap_or(Self::HousePlant);
        }
        if flowers > 0 && petal_area > crown_area {
            return if flowers == 1 { Self::Flower } else { Self::Flowers };
        }
        if let Some(crown) = crown {
            return judge_crown(reading, crown);
        }
        if let Some(body) = body {
            return judge_body(reading, body);
        }
        judge_blades(reading, leaf_area)
    }
}

fn drawn_thick(axis: &AxisReading) -> bool {
    !axis.half_width.is_empty()
}

/// Returns the kind of a crown: over a trunk it is a tree, on the ground a bush.
fn judge_crown(reading: &Reading, crown: &RegionReading) -> Kind {
    let crowns = reading.regions.iter().filter_map(|r| bounds(&r.outline));
    let all = crowns.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let Some((low, high)) = all else { return Kind::None };
    let height = high.y - low.y;
    let foot = |thick: bool| {
        let standing = reading.axes.iter().filter(|a| a.bearer.is_none() && a.kind != AxisKind::Root);
        let feet = standing.filter(|a| !thick || drawn_thick(a)).filter_map(|a| a.points.first());
        feet.map(|p| p.y).fold(f64::INFINITY, f64::min)
    };
    if low.y - foot(false) < BARE * height && low.y - foot(true) < BARE_OUTLINE * height {
        return Kind::Bush;
    }
    if pointed(&crown.outline) { Kind::Conifer } else { Kind::Tree }
}

/// Whether an outline is much narrower above than below, and higher than wide.
pub(crate) fn pointed(outline: &[DVec2]) -> bool {
    let Some((low, high)) = bounds(outline) else { return false };
    let height = high.y - low.y;
    let mean = |from: f64, to: f64| {
        let row = |i: i32| low.y + (from + (to - from) * f64::from(i) / 5.0) * height;
        (0..6).map(|i| crate::contour::width_at(outline, row(i))).sum::<f64>() / 6.0
    };
    height > POINTED_TALL * (high.x - low.x)
        && mean(ABOVE.start, ABOVE.end) < POINTED_THIN * mean(BELOW.start, BELOW.end)
}

/// Returns the kind of a trunk without a crown: leaves at its top are fronds.
fn judge_body(reading: &Reading, body: &AxisReading) -> Kind {
    let Some((&foot, &top)) = body.points.first().zip(body.points.last()) else { return Kind::None };
    let high = |l: &&crate::BladeReading| l.root.distance(top) < AT_TOP * foot.distance(top);
    let fronds = reading.leaves.iter().filter(high).count();
    if fronds >= FEWEST_PETALS && MOST.1 * fronds >= MOST.0 * reading.leaves.len() {
        Kind::Palm
    } else {
        Kind::Tree
    }
}

/// Leaves and stems only.
fn judge_blades(reading: &Reading, leaf_area: f64) -> Kind {
    let axes: Vec<&AxisReading> = reading.axes.iter().filter(|a| a.kind != AxisKind::Root).collect();
    let largest = reading.leaves.iter().map(|l| signed_area(&l.outline)).fold(0.0, f64::max);
    match (reading.leaves.len(), axes.len()) {
        (0, 0) => Kind::None,
        (0, _) if reading.woody => Kind::Tree,
        (0, _) => Kind::Stem,
        (_, n) if largest > MAIN_LEAF * leaf_area && n <= 2 => {
            let longest = axes.iter().map(|a| polyline_length(&a.points)).fold(0.0, f64::max);
            let size = reading
                .leaves
                .iter()
                .filter_map(|l| bounds(&l.outline))
                .map(|(a, b)| a.distance(b))
                .fold(0.0, f64::max);
            if longest < size { Kind::Leaf } else { Kind::Stem }
        }
        (n, _) => {
            // Blades of grass are rooted on the ground, side by side.
            let low = reading.leaves.iter().map(|l| l.root.y).fold(f64::INFINITY, f64::min);
            let high =
                reading.leaves.iter().flat_map(|l| &l.outline).map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
            let rooted =
                |l: &&crate::BladeReading| l.root.y < low + ROOTED * (high - low) && l.bearer.is_none();
            let ground = reading.leaves.iter().filter(rooted).count();
            let stems = reading.strokes.iter().filter(|s| s.organ == OrganWord::Branch).count();
            if n >= FEWEST_STALKS && NEARLY_ALL.1 * ground >= NEARLY_ALL.0 * n && stems <= n {
                Kind::Grass
            } else {
                Kind::Stem
            }
        }
    }
}
