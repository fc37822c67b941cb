//! Drawn things that are not plants: the sun, clouds, birds, a butterfly, a word. They are left out, and reported.
//!
//! A drawing falls into pieces by place alone. A piece is no plant if the model of kinds says so, or if it hangs in the
//! air and is of a kind that needs ground to stand on: a bush in the sky is a cloud.

use base::Report;
use glam::DVec2;
use ink::{Classified, Ink, Source, StrokeClass};

use crate::kinds::Shares;
use crate::{Kind, OrganWord, StrokeReading};
use geom::bounds;

/// The rule that a stroke is of no plant.
pub const BESIDE_THE_PLANT: &str = "beside-the-plant";
/// A piece that hangs higher than this share of the drawing's height stands on no ground of its own.
const HANGS: f64 = 0.25;
/// Greatest size of a piece that is left out, relative to the largest plant.
const SMALL: f64 = 0.7;
/// Least share of no plant for which a piece that hangs in the air is left out.
const HANGING: f64 = 0.3;
/// Least share of no plant for which a piece that stands on the ground is left out.
const STANDING: f64 = 0.6;
/// A piece that stands is surely a plant if its share of no plant is less than this; others are left out next to one.
const PLANT: f64 = 0.3;
/// Greatest height of a letter relative to the largest plant.
const LETTER: f64 = 0.3;
/// Fewest letters of a word.
const LETTERS: usize = 3;
/// Greatest gap between two letters, as a share of the height of the higher one.
const SPACED: f64 = 0.9;
/// Greatest overlap of two letters, as a share of the height of the higher one.
const OVERLAP: f64 = 0.3;
/// Letters of one word share at least this part of the height of the lower one.
const IN_LINE: f64 = 0.4;
/// Least height of the lower of two letters relative to the higher: a small letter next to a capital.
const ALIKE: f64 = 0.3;

/// One piece of a drawing.
pub(crate) struct Piece<'a> {
    /// Rows of its strokes in the whole drawing.
    pub(crate) rows: &'a [usize],
    pub(crate) shares: &'a Shares,
    /// Whether the user classified one of its strokes.
    pub(crate) named: bool,
}

impl<'a> Piece<'a> {
    pub(crate) fn new(rows: &'a [usize], classes: &[Classified], shares: &'a Shares) -> Self {
        let named = classes.iter().any(|c| c.source == Source::User);
        Self { rows, shares, named }
    }
}

/// Returns for each piece whether it is left out. `as_one`: the share of no plant for several pieces taken together.
pub(crate) fn find_left_out(ink: &Ink, pieces: &[Piece<'_>], as_one: impl Fn(&[usize]) -> f64) -> Vec<bool> {
    let boxes: Vec<(DVec2, DVec2)> = pieces.iter().map(|p| box_of(ink, p.rows)).collect();
    let low = boxes.iter().map(|b| b.0.y).fold(f64::INFINITY, f64::min);
    let high = boxes.iter().map(|b| b.1.y).fold(f64::NEG_INFINITY, f64::max);
    let tall = (high - low).max(1e-9);
    let size = |k: usize| boxes[k].0.distance(boxes[k].1);
    let hangs = |k: usize| boxes[k].0.y > low + HANGS * tall;
    let plants: Vec<usize> =
        (0..pieces.len()).filter(|&k| !hangs(k) && pieces[k].shares.no_plant < PLANT).collect();
    let largest = plants.iter().map(|&k| size(k)).fold(0.0, f64::max);
    let mut out: Vec<bool> = (0..pieces.len())
        .map(|k| {
            let (shares, best) = (pieces[k].shares, pieces[k].shares.kinds.first().map(|s| s.kind));
            let small = size(k) < SMALL * largest && !pieces[k].named;
            let rooted = best.is_some_and(needs_ground);
            let none = shares.no_plant > if hangs(k) { HANGING } else { STANDING };
            small && (none || (hangs(k) && rooted))
        })
        .collect();
    for word in words(&boxes, &out, LETTER * largest) {
        let rows: Vec<usize> = word.iter().flat_map(|&k| pieces[k].rows.iter().copied()).collect();
        let named = word.iter().any(|&k| pieces[k].named);
        let rest = (0..pieces.len()).any(|k| plants.contains(&k) && !word.contains(&k));
        if rest && !named && as_one(&rows) > STANDING {
            word.iter().for_each(|&k| out[k] = true);
        }
    }
    out
}

/// Whether a kind grows from the ground, whatever is drawn next to it.
const fn needs_ground(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Bush
            | Kind::Tree
            | Kind::Conifer
            | Kind::Palm
            | Kind::Cactus
            | Kind::Grass
            | Kind::Stem
            | Kind::HousePlant
    )
}

fn box_of(ink: &Ink, rows: &[usize]) -> (DVec2, DVec2) {
    let own = rows.iter().filter_map(|&row| bounds(&ink.strokes.get(row)?.points));
    own.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default()
}

/// Finds rows of small pieces of similar height next to one another. `boxes` run from left to right.
fn words(boxes: &[(DVec2, DVec2)], out: &[bool], most: f64) -> Vec<Vec<usize>> {
    let mut found: Vec<Vec<usize>> = Vec::new();
    let tall = |k: usize| (boxes[k].1.y - boxes[k].0.y).max(1e-9);
    for k in (0..boxes.len()).filter(|&k| !out[k] && tall(k) < most) {
        let follows = |word: &&mut Vec<usize>| {
            let Some(&last) = word.last() else { return false };
            let (a, b) = (boxes[last], boxes[k]);
            let (less, more) = (tall(last).min(tall(k)), tall(last).max(tall(k)));
            let beside = b.0.x - a.1.x < SPACED * more && b.0.x - a.1.x > -OVERLAP * more;
            let level = (a.0.y.max(b.0.y) - a.1.y.min(b.1.y)) < -IN_LINE * less;
            beside && level && less > ALIKE * more
        };
        match found.iter_mut().find(follows) {
            Some(word) => word.push(k),
            None => found.push(vec![k]),
        }
    }
    found.retain(|w| w.len() >= LETTERS);
    found
}

/// Reports which strokes were left out and marks them as ignored.
pub(crate) fn tell(
    ink: &Ink,
    classes: &[Classified],
    rows: &[usize],
    report: &mut Report,
) -> Vec<StrokeReading> {
    let count = rows.len();
    base::warn!(
        report,
        "left-out",
        { count = count },
        "{count} stroke(s) next to the plant do not look like a plant and were left out"
    );
    let reading = |&row: &usize| {
        let said = classes.get(row).copied().unwrap_or_default();
        Some(StrokeReading {
            index: ink.strokes.get(row)?.index,
            class: StrokeClass::Other,
            organ: OrganWord::Ignored,
            confidence: said.shares[StrokeClass::Other.place()],
            source: Source::Rule(BESIDE_THE_PLANT),
        })
    };
    rows.iter().filter_map(reading).collect()
}

#[cfg(test)]
mod tests {
    use base::{Run, ops};
    use ink::Drawing;

    use super::*;
    use crate::Reading;

    fn line(a: (f64, f64), b: (f64, f64)) -> Vec<DVec2> {
        let (a, b) = (DVec2::from(a), DVec2::from(b));
        (0..=20).map(|i| a.lerp(b, f64::from(i) / 20.0)).collect()
    }

    fn ring(x: f64, y: f64, r: f64, lobes: f64) -> Vec<DVec2> {
        (0..=60)
            .map(|i| ops::TAU * f64::from(i) / 60.0)
            .map(|a| (a, r * (1.0 - 0.1 * ops::cos(lobes * a))))
            .map(|(a, r)| DVec2::new(x + r * ops::cos(a), y + r * ops::sin(a)))
            .collect()
    }

    fn tree() -> Vec<Vec<DVec2>> {
        vec![line((-0.8, 0.0), (-0.6, 5.0)), line((0.8, 0.0), (0.6, 5.0)), ring(0.0, 7.5, 3.0, 9.0)]
    }

    fn sun() -> Vec<Vec<DVec2>> {
        let ray = |k: i32| {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 9.0);
            line((8.0 + 1.2 * c, 10.0 + 1.2 * s), (8.0 + 1.9 * c, 10.0 + 1.9 * s))
        };
        core::iter::once(ring(8.0, 10.0, 0.9, 0.0)).chain((0..9).map(ray)).collect()
    }

    fn read(lines: &[Vec<DVec2>], by_user: &[usize]) -> (Reading, Vec<&'static str>) {
        let mut report = Report::default();
        let ink = ink::clean(&Drawing::from_polylines("scene", lines), &mut report);
        let mut classes = ink::classify(&ink, &Run::plain());
        by_user.iter().for_each(|&k| classes[k] = Classified::by_user(StrokeClass::Disc));
        let reading = crate::read(&ink, &classes, &mut report);
        assert_eq!(reading.validate().count(), 0);
        (reading, report.warnings.iter().map(|w| w.code).collect())
    }

    fn left(reading: &Reading) -> Vec<usize> {
        let left = reading.strokes.iter().filter(|s| s.source == Source::Rule(BESIDE_THE_PLANT));
        left.map(|s| s.index as usize).collect()
    }

    #[test]
    fn the_sun_and_a_cloud_are_left_out_and_the_tree_is_read() {
        let cloud: Vec<DVec2> =
            ring(-8.0, 10.0, 1.6, 7.0).iter().map(|p| DVec2::new(p.x, 5.0 + 0.5 * p.y)).collect();
        for beside in [sun(), vec![cloud]] {
            let lines = [tree(), beside].concat();
            let (reading, codes) = read(&lines, &[]);
            assert_eq!(left(&reading), (3..lines.len()).collect::<Vec<_>>());
            assert_eq!((reading.plants.len(), reading.plants[0].kind), (1, Kind::Tree));
            assert!(codes.contains(&"left-out"), "{codes:?}");
        }
    }

    #[test]
    fn what_the_user_names_stays_and_so_do_plants() {
        let lines = [tree(), sun()].concat();
        assert_eq!(left(&read(&lines, &[3]).0), [] as [usize; 0]);
        // Another, smaller tree next to it.
        let small =
            tree().into_iter().map(|l| l.into_iter().map(|p| p * 0.5 + DVec2::new(9.0, 0.0)).collect());
        let lines = [tree(), small.collect()].concat();
        let (reading, codes) = read(&lines, &[]);
        assert_eq!((left(&reading).len(), reading.plants.len()), (0, 2));
        assert!(!codes.contains(&"left-out"), "{codes:?}");
        // Nothing but the sun: the best plant is made of it.
        let (reading, _) = read(&sun(), &[]);
        assert!(left(&reading).is_empty() && !reading.plants.is_empty());
    }
}
