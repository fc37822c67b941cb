//! How a drawing looks at a glance: `ink -> share of each kind that people were asked to draw`.
//!
//! A small convolutional network (`LeCun`, Bottou, Bengio and Haffner 1998) looks at a picture of the drawing;
//! strokes, their order and their directions do not exist for it. It learnt from pictures of drawings that many people
//! made for a word, which the numbers of [`kind_features`](crate::kind_features) lack most. Its coefficients are data
//! (`data/glance.csv`), learnt by `cargo xtask train-glance`; `docs/strokes.md` describes how, and how good it is.

mod layers;

use std::sync::OnceLock;

use geom::bounds;
use glam::DVec2;
use ink::Ink;

pub use layers::{CHANNELS, GLIMPSE, HIDDEN, Layer, Seen, Sight, pooled};

use crate::Kind;
use crate::kinds::{log_shares, powers};

/// Cells along each side of a [`Picture`].
pub const SIDE: usize = 28;
/// Cells between the first and the last line along a drawing's longer side. The rest leaves room for lines that darken
/// two cells.
const SPAN: f64 = (SIDE - 1) as f64;
/// Darkness of each cell of a drawing, 0 to 1, row by row from the top.
pub type Picture = Vec<f32>;

/// The words that people were asked to draw and that name a kind.
pub const WORDS: [(&str, Kind); 25] = [
    ("tree", Kind::Tree),
    ("bush", Kind::Bush),
    ("palm tree", Kind::Palm),
    ("cactus", Kind::Cactus),
    ("flower", Kind::Flower),
    ("grass", Kind::Grass),
    ("leaf", Kind::Leaf),
    ("house plant", Kind::HousePlant),
    ("apple", Kind::Fruit),
    ("banana", Kind::Fruit),
    ("blackberry", Kind::Fruit),
    ("blueberry", Kind::Fruit),
    ("grapes", Kind::Fruit),
    ("pear", Kind::Fruit),
    ("pineapple", Kind::Fruit),
    ("strawberry", Kind::Fruit),
    ("watermelon", Kind::Fruit),
    ("asparagus", Kind::Vegetable),
    ("broccoli", Kind::Vegetable),
    ("carrot", Kind::Vegetable),
    ("mushroom", Kind::Vegetable),
    ("onion", Kind::Vegetable),
    ("peas", Kind::Vegetable),
    ("potato", Kind::Vegetable),
    ("string bean", Kind::Vegetable),
];

/// Returns a drawing in [`SIDE`] by [`SIDE`] cells, its middle in theirs, its longer side as long as they allow.
///
/// A line darkens the two cells between which it crosses the middle of a column (of a row, if it is steeper), each by
/// its share, as Wu (1991) draws lines without steps; a cell keeps its greatest darkness. Both ends of a stroke are
/// dots. Linear in points.
pub fn picture(ink: &Ink) -> Picture {
    let mut cells = vec![0.0; SIDE * SIDE];
    let boxes = ink.strokes.iter().filter_map(|s| bounds(&s.points));
    let Some((lo, hi)) = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else { return cells };
    let scale = SPAN / (hi - lo).max_element().max(f64::MIN_POSITIVE);
    let middle = lo.midpoint(hi);
    let place = |p: DVec2| (p - middle) * DVec2::new(scale, -scale) + SPAN / 2.0;
    for stroke in &ink.strokes {
        let points: Vec<DVec2> = stroke.points.iter().map(|p| place(*p)).collect();
        points.first().into_iter().chain(points.last()).for_each(|p| darken(&mut cells, p.round(), 1.0));
        points.windows(2).for_each(|pair| line(&mut cells, pair[0], pair[1]));
    }
    cells
}

/// Darkens the cells of one piece of a line.
fn line(cells: &mut Picture, from: DVec2, to: DVec2) {
    let way = to - from;
    let steep = way.y.abs() > way.x.abs();
    let turned = |p: DVec2| if steep { DVec2::new(p.y, p.x) } else { p };
    let (from, way) = (turned(from), turned(way));
    if way.x == 0.0 {
        return;
    }
    let (first, last) = (from.x.min(from.x + way.x).ceil(), from.x.max(from.x + way.x).floor());
    let mut x = first;
    while x <= last {
        let y = from.y + way.y * (x - from.x) / way.x;
        let share = y - y.floor();
        darken(cells, turned(DVec2::new(x, y.floor())), 1.0 - share);
        darken(cells, turned(DVec2::new(x, y.floor() + 1.0)), share);
        x += 1.0;
    }
}

/// Darkens the cell whose middle is `at`, if it lies in the picture.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "within the picture, as was asked"
)]
fn darken(cells: &mut Picture, at: DVec2, share: f64) {
    if at.cmpge(DVec2::ZERO).all() && at.cmplt(DVec2::splat(SIDE as f64)).all() {
        let cell = &mut cells[at.y as usize * SIDE + at.x as usize];
        *cell = cell.max(share as f32);
    }
}

/// The result of a look at a drawing: the mean of the drawing and its mirror image. All 0 if nothing was learnt.
#[derive(Clone, Debug)]
pub(crate) struct Glance {
    /// The share of each of [`WORDS`].
    pub(crate) words: [f64; WORDS.len()],
    /// Activation of each unit.
    units: Vec<f64>,
    /// How well each word describes the drawing, before the softmax.
    sums: Vec<f64>,
}

impl Default for Glance {
    fn default() -> Self {
        Self { words: [0.0; WORDS.len()], units: vec![0.0; HIDDEN], sums: vec![0.0; WORDS.len()] }
    }
}

impl Glance {
    /// Returns one number for each of [`mark_names`]: the units, the logarithm of the share of each word.
    pub(crate) fn marks(&self) -> Vec<f64> {
        self.units.iter().copied().chain(log_shares(&self.sums)).collect()
    }
}

/// Returns how undecided a glance is between words: the entropy of their shares (Shannon 1948), natural units.
pub(crate) fn entropy(words: &[f64; WORDS.len()]) -> f64 {
    -words.iter().filter(|p| **p > 0.0).map(|p| p * base::ops::ln(*p)).sum::<f64>()
}

/// Returns the names of [`Glance::marks`], in their order.
pub(crate) fn mark_names() -> Vec<String> {
    let units = (0..HIDDEN).map(|k| format!("glance-{k}"));
    units.chain(WORDS.iter().map(|(word, _)| format!("glance-{}", word.replace(' ', "-")))).collect()
}

/// Looks at a drawing. The result is the same for its mirror image.
pub(crate) fn look(ink: &Ink) -> Glance {
    let Some(sight) = trained() else { return Glance::default() };
    let picture = picture(ink);
    let mut mirrored = picture.clone();
    mirrored.chunks_mut(SIDE).for_each(<[f32]>::reverse);
    let (one, other) = (sight.look(&picture), sight.look(&mirrored));
    let mean = |a: &[f32], b: &[f32]| -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| (f64::from(*a) + f64::from(*b)) / 2.0).collect()
    };
    let sums = mean(&one.words, &other.words);
    let powers = powers(&sums);
    let total: f64 = powers.iter().sum();
    let mut words = [0.0; WORDS.len()];
    words.iter_mut().zip(powers).for_each(|(share, power)| *share = power / total);
    Glance { words, units: mean(&one.units, &other.units), sums }
}

/// Returns the share of each of [`Kind::ALL`]: the sum of the shares of its words.
pub(crate) fn by_kind(words: &[f64; WORDS.len()]) -> [f64; Kind::ALL.len()] {
    let mut shares = [0.0; Kind::ALL.len()];
    for ((_, kind), share) in WORDS.iter().zip(words) {
        shares[kind.place()] += share;
    }
    shares
}

/// Returns the word for a plant of a known kind: the likeliest of the kind's words, if it is likelier than all its
/// others together.
pub(crate) fn word(kind: Kind, words: &[f64; WORDS.len()]) -> Option<&'static str> {
    let own = || WORDS.iter().zip(words).filter(|((_, k), _)| *k == kind);
    let all: f64 = own().map(|(_, share)| share).sum();
    own().find(|(_, share)| **share > 0.5 * all).map(|((word, _), _)| *word)
}

fn trained() -> Option<&'static Sight> {
    static SIGHT: OnceLock<Option<Sight>> = OnceLock::new();
    SIGHT.get_or_init(|| Sight::parse(include_str!("../data/glance.csv"), WORDS.len())).as_ref()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ink(lines: &[Vec<DVec2>]) -> Ink {
        ink::clean(&ink::Drawing::from_polylines("drawn", lines), &mut base::Report::default())
    }

    #[test]
    fn a_line_between_two_columns_darkens_both_by_half() {
        // A level line above, an upright one in the middle, between the columns 13 and 14.
        let line = |a: [f64; 2], b: [f64; 2]| {
            (0..=20).map(|k| DVec2::from(a).lerp(DVec2::from(b), f64::from(k) / 20.0)).collect::<Vec<_>>()
        };
        let seen = picture(&ink(&[line([0.0, 10.0], [10.0, 10.0]), line([5.0, 10.0], [5.0, 0.0])]));
        assert!(seen[..SIDE].iter().all(|c| (c - 1.0).abs() < 1e-6), "{:?}", &seen[..SIDE]);
        for row in seen.chunks(SIDE).take(SIDE - 1).skip(2) {
            assert!((row[13] - 0.5).abs() < 1e-6 && (row[14] - 0.5).abs() < 1e-6, "{row:?}");
            assert!(row[..12].iter().chain(&row[16..]).all(|c| *c == 0.0));
        }
    }

    #[test]
    fn the_committed_sight_looks_at_every_kind_that_a_word_names_and_does_not_mind_left_and_right() {
        assert!(trained().is_some(), "data/glance.csv is of another form: run `cargo xtask train-glance`");
        let bent: Vec<DVec2> = (0..30).map(|k| DVec2::new(f64::from(k * k) / 9.0, f64::from(k))).collect();
        let mirrored = bent.iter().map(|p| DVec2::new(-p.x, p.y)).collect();
        let seen = |line: Vec<DVec2>| by_kind(&look(&ink(&[line])).words);
        let (one, other) = (seen(bent), seen(mirrored));
        assert!((one.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        for kind in Kind::ALL {
            assert_eq!(one[kind.place()] > 0.0, WORDS.iter().any(|w| w.1 == kind), "{kind:?}");
            assert!((one[kind.place()] - other[kind.place()]).abs() < 1e-6, "{kind:?}");
        }
    }

    #[test]
    fn a_word_is_told_where_it_is_likelier_than_all_others_of_its_kind() {
        let mut words = [0.0; WORDS.len()];
        let at = |word: &str| WORDS.iter().position(|w| w.0 == word).expect("a word");
        (words[at("pear")], words[at("apple")], words[at("carrot")]) = (0.2, 0.1, 0.7);
        assert_eq!(word(Kind::Fruit, &words), Some("pear"));
        words[at("banana")] = 0.15;
        assert_eq!(word(Kind::Fruit, &words), None);
        assert_eq!(word(Kind::Stem, &words), None);
    }

    #[test]
    fn nothing_drawn_is_no_fault() {
        let seen = look(&Ink::default());
        assert!(seen.words.iter().chain(&seen.marks()).all(|s| s.is_finite()));
        assert_eq!(seen.marks().len(), mark_names().len());
    }
}
