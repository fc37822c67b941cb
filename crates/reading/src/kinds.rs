//! How well each kind of plant explains a whole drawing: `ink + classes + first reading -> share of each kind`.
//!
//! A small network over numbers of the whole drawing, with a softmax over the kinds. Its coefficients are data
//! (`data/kinds.csv`), learnt by `cargo xtask train-kinds` from drawings by people and made ones of the learning
//! part. For the kinds that are words, its result is combined with how the drawing looks at a
//! [glance](mod@crate::glance). `docs/strokes.md` describes how, and how good it is.

use std::sync::OnceLock;

use base::ops;
use geom::{bounds, contains, convex_hull, signed_area};
use glam::DVec2;
use ink::{Classified, Ink, StrokeClass};

use crate::look::{LINE, LOOP};
use crate::palette::Brights;
use crate::{Kind, Reading, Scored, look};

/// Numbers of a drawing.
pub(crate) const COUNT: usize =
    1 + Kind::ALL.len() + (2 + CLASS_BANDS) * StrokeClass::ALL.len() + SHAPE.len() + look::COUNT;
/// Bands of the height for which the length of each stroke class is measured.
const CLASS_BANDS: usize = 3;
/// Ends of strokes in this lowest share of the height count as a foot. The exact value matters little, as for all
/// numbers of a look: the model learns what the count is worth.
const LOW: f64 = 0.1;
/// Names of the numbers that describe how the whole looks.
const SHAPE: [&str; 20] = [
    "strokes",
    "wide",
    "filled",
    "ink",
    "closed",
    "largest",
    "largest-high",
    "largest-round",
    "largest-full",
    "held",
    "low-ink",
    "high-ink",
    "low-wide",
    "high-wide",
    "middle-wide",
    "upright-lines",
    "level-lines",
    "loops",
    "feet",
    "straight",
];

/// Returns the names of the numbers of [`kind_features`], in their order.
pub fn kind_feature_names() -> Vec<String> {
    let built = Kind::ALL.iter().map(|k| format!("built-{}", k.word()));
    let sums = StrokeClass::ALL.iter().map(|c| format!("sum-{}", c.word()));
    let lengths = StrokeClass::ALL.iter().map(|c| format!("length-{}", c.word()));
    let shape = SHAPE.iter().map(|s| (*s).to_owned());
    let classes = StrokeClass::ALL
        .iter()
        .flat_map(|c| (0..CLASS_BANDS).map(move |b| format!("length-{}-{b}", c.word())));
    let look = look::GROUPS.iter().flat_map(|&(name, n)| {
        (0..n).map(move |k| if n == 1 { name.to_owned() } else { format!("{name}-{k}") })
    });
    core::iter::once("one".to_owned())
        .chain(built)
        .chain(sums)
        .chain(lengths)
        .chain(shape)
        .chain(classes)
        .chain(look)
        .collect()
}

/// Returns the numbers of one plant, each about 0 to 1; independent of the order and direction of strokes, of left
/// and right and of the size of the sheet. Linear in points.
pub fn kind_features(ink: &Ink, classes: &[Classified], first: &Reading) -> Vec<f64> {
    let mut row = vec![1.0];
    let built = Kind::from_reading(first);
    row.extend(Kind::ALL.iter().map(|&k| f64::from(u8::from(k == built))));
    let total: f64 = ink.strokes.iter().map(|s| s.length).sum::<f64>().max(1e-9);
    let share = |k: usize, class: StrokeClass| classes.get(k).map_or(0.0, |c| c.shares[class.place()]);
    for class in StrokeClass::ALL {
        let sum: f64 = (0..ink.strokes.len()).map(|k| share(k, class)).sum();
        row.push(ops::ln(1.0 + sum) / 2.0);
    }
    for class in StrokeClass::ALL {
        let sum: f64 = ink.strokes.iter().enumerate().map(|(k, s)| share(k, class) * s.length).sum();
        row.push(sum / total);
    }
    let all: Vec<DVec2> = ink.strokes.iter().flat_map(|s| s.points.iter().copied()).collect();
    let hull = convex_hull(&all);
    row.extend(shape(ink, (&all, &hull), total));
    row.extend(class_bands(ink, &share, total));
    row.extend(look::look(ink, (&all, &hull)));
    debug_assert_eq!(row.len(), COUNT, "one number for each name");
    row
}

/// Measures how much of each stroke class lies low, in the middle and high.
fn class_bands(ink: &Ink, share: &dyn Fn(usize, StrokeClass) -> f64, total: f64) -> Vec<f64> {
    let ends = ink.strokes.iter().flat_map(|s| &s.points).map(|p| p.y);
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
    let mut sums = vec![0.0; CLASS_BANDS * StrokeClass::ALL.len()];
    for (k, s) in ink.strokes.iter().enumerate() {
        let mut own = [0.0_f64; CLASS_BANDS];
        for p in &s.points {
            let at = (p.y - low) / (high - low).max(1e-9) * CLASS_BANDS as f64;
            own[if at < 1.0 {
                0
            } else if at < 2.0 {
                1
            } else {
                2
            }] += s.length / s.points.len() as f64 / total;
        }
        for (sums, class) in sums.chunks_mut(CLASS_BANDS).zip(StrokeClass::ALL) {
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own * share(k, class));
        }
    }
    sums
}

/// Measures how the whole looks. `all`: its points, and their hull.
fn shape(ink: &Ink, (all, hull): (&[DVec2], &[DVec2]), total: f64) -> [f64; SHAPE.len()] {
    let Some((lo, hi)) = bounds(all) else { return [0.0; SHAPE.len()] };
    let (wide, tall) = ((hi.x - lo.x).max(1e-6), (hi.y - lo.y).max(1e-6));
    let count = all.len().max(1) as f64;
    let hull_area = if hull.len() > 2 { signed_area(hull) } else { 0.0 };
    let open = |k: usize| {
        let s = &ink.strokes[k];
        s.points[0].distance(s.points[s.points.len() - 1]) / s.length.max(1e-9)
    };
    let n = ink.strokes.len();
    let closed: Vec<usize> = (0..n).filter(|&k| open(k) < LOOP).collect();
    let area_of = |k: usize| {
        let hull = ink.strokes[k].hull();
        if hull.len() > 2 { signed_area(hull) } else { 0.0 }
    };
    let largest = (0..n).map(|k| (area_of(k), k)).max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let (area, k) = largest.unwrap_or_default();
    let ring = &ink.strokes[k].points;
    let (l, h) = bounds(ring).unwrap_or_default();
    let own = ink.strokes[k].hull();
    let within = |p: &DVec2| p.cmpge(l).all() && p.cmple(h).all() && contains(own, *p);
    let inside = all.iter().filter(|p| own.len() > 2 && within(p)).count() as f64 / count;
    let full = ink.strokes[k].outline().map_or(0.0, signed_area) / area.max(1e-9);
    let part = |from: f64, to: f64| -> (f64, f64) {
        let band: Vec<DVec2> =
            all.iter().copied().filter(|p| p.y >= lo.y + from * tall && p.y <= lo.y + to * tall).collect();
        let across = bounds(&band).map_or(0.0, |(a, b)| b.x - a.x);
        (band.len() as f64 / count, across / wide)
    };
    let (low, middle, high) = (part(0.0, 0.2), part(0.4, 0.6), part(0.8, 1.0));
    let lines: Vec<usize> = (0..n).filter(|&k| open(k) > LINE).collect();
    let run = |k: usize| {
        let s = &ink.strokes[k].points;
        (s[s.len() - 1] - s[0]).abs()
    };
    let length = |list: &[usize]| list.iter().map(|&k| ink.strokes[k].length).sum::<f64>() / total;
    let upright: Vec<usize> = lines.iter().copied().filter(|&k| run(k).y > 2.0 * run(k).x).collect();
    let level: Vec<usize> = lines.iter().copied().filter(|&k| run(k).x > 2.0 * run(k).y).collect();
    let foot = |s: &ink::InkStroke| s.points.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let feet = ink.strokes.iter().filter(|s| foot(s) < lo.y + LOW * tall).count() as f64;
    let log = |x: f64| ops::ln(1.0 + x) / 4.0;
    [
        log(n as f64),
        wide / (wide + tall),
        hull_area / (wide * tall),
        log(total),
        length(&closed),
        area / hull_area.max(1e-9),
        (l.midpoint(h).y - lo.y) / tall,
        (h.x - l.x).min(h.y - l.y) / (h.x - l.x).max(h.y - l.y).max(1e-9),
        full.min(1.0),
        inside,
        low.0,
        high.0,
        low.1,
        high.1,
        middle.1,
        length(&upright),
        length(&level),
        log(closed.len() as f64),
        log(feet),
        length(&lines),
    ]
}

/// The model: for each number its mean, its spread and a coefficient for each kind and for each unit; for each unit a
/// coefficient for each kind.
struct Model {
    /// The kind of each column; `None` for several plants side by side.
    kinds: Vec<Option<Kind>>,
    rows: Vec<ModelRow>,
    /// A row for each unit.
    units: Vec<Vec<f64>>,
}

struct ModelRow {
    mean: f64,
    spread: f64,
    coefficients: Vec<f64>,
}

/// The word of the column for several plants.
pub const SEVERAL: &str = "several";
/// Prefix of the names of units.
const UNIT: &str = "unit-";
/// Greatest distance from its mean, in spreads, at which a number counts: no single one decides.
pub const KIND_FEATURE_LIMIT: f64 = 4.0;

impl Model {
    fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines().filter(|l| !l.starts_with('#'));
        let words: Vec<&str> = lines.next()?.split(',').skip(3).collect();
        let (units, kinds): (Vec<&str>, Vec<&str>) = words.into_iter().partition(|w| w.starts_with(UNIT));
        let column =
            |word: &&str| if *word == SEVERAL { Some(None) } else { Kind::from_word(word).map(Some) };
        let kinds: Vec<Option<Kind>> = kinds.iter().map(column).collect::<Option<_>>()?;
        let mut row = |name: &str, length: usize| {
            let mut cells = lines.next()?.split(',');
            if cells.next()? != name {
                return None;
            }
            let numbers: Option<Vec<f64>> = cells.map(|c| c.parse().ok()).collect();
            let [mean, spread, coefficients @ ..] = &numbers?[..] else { return None };
            let whole = coefficients.len() == length && *spread > 0.0;
            whole.then(|| ModelRow { mean: *mean, spread: *spread, coefficients: coefficients.to_vec() })
        };
        let names = kind_feature_names();
        let rows: Option<Vec<ModelRow>> =
            names.iter().map(|name| row(name, kinds.len() + units.len())).collect();
        let units: Option<Vec<Vec<f64>>> =
            units.iter().map(|name| Some(row(name, kinds.len())?.coefficients)).collect();
        Some(Self { rows: rows?, units: units?, kinds })
    }

    /// Returns how well each column explains a row of numbers, before the softmax.
    fn sums(&self, row: &[f64]) -> Vec<f64> {
        self.weigh(row).sums
    }

    fn weigh(&self, row: &[f64]) -> Weighed {
        let mut sums = vec![0.0; self.kinds.len() + self.units.len()];
        let spreads = self.rows.iter().zip(row);
        let spreads =
            spreads.map(|(m, x)| ((x - m.mean) / m.spread).clamp(-KIND_FEATURE_LIMIT, KIND_FEATURE_LIMIT));
        let spreads: Vec<f64> = spreads.collect();
        for (m, z) in self.rows.iter().zip(&spreads) {
            sums.iter_mut().zip(&m.coefficients).for_each(|(sum, c)| *sum += c * z);
        }
        let mut units = sums.split_off(self.kinds.len());
        units.iter_mut().for_each(|u| *u = u.max(0.0));
        for (unit, coefficients) in units.iter().zip(&self.units) {
            sums.iter_mut().zip(coefficients).for_each(|(sum, c)| *sum += c * unit);
        }
        Weighed { spreads, units, sums }
    }
}

/// Results of the model for a row of numbers.
struct Weighed {
    /// Distance of each number from its mean, in spreads.
    spreads: Vec<f64>,
    /// Activation of each unit, 0 or more.
    units: Vec<f64>,
    /// How well each column explains the row, before the softmax.
    sums: Vec<f64>,
}

/// Returns the results of the model for a row, one number for each of [`mark_names`]: the row in spreads, its units,
/// the logarithm of the share of each column. Nothing if no model was learnt.
pub(crate) fn marks(row: &[f64]) -> Vec<f64> {
    let Some(model) = trained() else { return Vec::new() };
    let Weighed { mut spreads, units, sums } = model.weigh(row);
    spreads.extend(units);
    spreads.extend(log_shares(&sums));
    spreads
}

/// Returns the names of [`marks`], in their order.
pub(crate) fn mark_names() -> Vec<String> {
    let (units, kinds) = trained().map_or((0, &[][..]), |m| (m.units.len(), &m.kinds[..]));
    let units = (0..units).map(|k| format!("{UNIT}{k}"));
    let shares = kinds.iter().map(|k| format!("share-{}", k.map_or(SEVERAL, Kind::word)));
    kind_feature_names().into_iter().chain(units).chain(shares).collect()
}

fn trained() -> Option<&'static Model> {
    static MODEL: OnceLock<Option<Model>> = OnceLock::new();
    MODEL.get_or_init(|| Model::parse(include_str!("../data/kinds.csv"))).as_ref()
}

/// Returns the numerators of a softmax, the largest 1.
pub(crate) fn powers(sums: &[f64]) -> Vec<f64> {
    let most = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    sums.iter().map(|s| ops::exp(s - most)).collect()
}

/// Returns the logarithms of the shares of a softmax.
pub(crate) fn log_shares(sums: &[f64]) -> Vec<f64> {
    let most = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let total = most + ops::ln(powers(sums).iter().sum());
    sums.iter().map(|s| s - total).collect()
}

/// How well a drawing is explained.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shares {
    /// Every kind with its share among all kinds, the best first.
    pub(crate) kinds: Vec<Scored>,
    /// The share of no plant, among all.
    pub(crate) no_plant: f64,
    /// The share of several plants, among all.
    pub(crate) several: f64,
}

impl Shares {
    /// Reduces the shares of woody kinds: the colours are those of a plant without wood.
    pub(crate) fn without_wood(&mut self) {
        self.reduce(GREEN_WOOD, |kind| kind.is_like(Kind::Tree) || kind == Kind::Palm);
    }

    /// Reduces the shares of kinds whose bright colours lie elsewhere: a flower stands on its green, a fruit hangs from
    /// it, and a root lies below it.
    pub(crate) fn weigh_colours(&mut self, brights: Brights) {
        match brights {
            Brights::Above => self.reduce(MISPLACED_COLOUR, |kind| kind.is_like(Kind::Fruit)),
            Brights::Below => self.reduce(MISPLACED_COLOUR, |kind| kind.is_like(Kind::Flower)),
            Brights::Among => {}
        }
    }

    /// Multiplies the shares of some kinds by a factor; the others share the rest in proportion.
    fn reduce(&mut self, factor: f64, is_reduced: impl Fn(Kind) -> bool) {
        let before: f64 = self.kinds.iter().map(|s| s.score).sum();
        self.kinds.iter_mut().filter(|s| is_reduced(s.kind)).for_each(|s| s.score *= factor);
        let after: f64 = self.kinds.iter().map(|s| s.score).sum();
        let rise = before / after.max(f64::MIN_POSITIVE);
        self.kinds.iter_mut().for_each(|s| s.score *= rise);
        base::sort_by(&mut self.kinds, |a, b| b.score.total_cmp(&a.score).then(a.kind.cmp(&b.kind)));
    }
}

/// A kind keeps this much of its share in a painted drawing whose bright colours lie where it has none.
const MISPLACED_COLOUR: f64 = 0.1;
/// A woody kind keeps this much of its share in a drawing that is painted without wood.
const GREEN_WOOD: f64 = 0.1;
/// A kind that a glance does not see at all keeps this much of its share: a picture so small can mislead.
const UNSEEN: f64 = 0.03;
/// Power to which the glance counts compared with the numbers: of 0 to 1 the best on the choosing part of drawings by
/// people.
const TRUST: f64 = 0.7;

/// Returns the share of each of [`Kind::ALL`], from a row of [`kind_features`] and from a glance.
pub(crate) fn shares(row: &[f64], seen: &[f64; Kind::ALL.len()]) -> Shares {
    let Some(model) = trained() else { return Shares::default() };
    let sums = model.sums(row);
    let mut powers = powers(&sums);
    weigh(&mut powers, &model.kinds, seen);
    let total: f64 = powers.iter().sum();
    let of = |wanted: Option<Kind>| {
        let own = model.kinds.iter().zip(&powers).filter(|(k, _)| **k == wanted);
        own.map(|(_, p)| p).sum::<f64>() / total
    };
    let (no_plant, several) = (of(Some(Kind::None)), of(None));
    let rest = (1.0 - no_plant - several).max(f64::MIN_POSITIVE);
    let plants = model.kinds.iter().flatten().filter(|k| **k != Kind::None);
    let mut kinds: Vec<Scored> =
        plants.map(|&kind| Scored { kind, score: (of(Some(kind)) / rest).min(1.0) }).collect();
    base::sort_by(&mut kinds, |a, b| b.score.total_cmp(&a.score).then(a.kind.cmp(&b.kind)));
    Shares { kinds, no_plant, several }
}

/// Multiplies the results of two models that look at the same thing in different ways and err independently. Only for
/// the kinds that both know; together these keep their share against those that only the numbers know.
fn weigh(powers: &mut [f64], kinds: &[Option<Kind>], seen: &[f64; Kind::ALL.len()]) {
    let seen: Vec<f64> = kinds.iter().map(|k| k.map_or(0.0, |k| seen[k.place()])).collect();
    let known = |powers: &[f64]| -> f64 {
        powers.iter().zip(&seen).filter(|(_, s)| **s > 0.0).map(|(p, _)| *p).sum()
    };
    let before = known(powers);
    powers
        .iter_mut()
        .zip(&seen)
        .filter(|(_, s)| **s > 0.0)
        .for_each(|(p, s)| *p *= ops::powf(s + UNSEEN, TRUST));
    let part = before / known(powers).max(f64::MIN_POSITIVE);
    powers.iter_mut().zip(&seen).filter(|(_, s)| **s > 0.0).for_each(|(p, _)| *p *= part);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_committed_model_belongs_to_the_features() {
        let model = trained().expect("data/kinds.csv is of other features: run `cargo xtask train-kinds`");
        assert_eq!(kind_feature_names().len(), COUNT);
        assert!(model.rows.iter().flat_map(|r| &r.coefficients).all(|c| c.is_finite()));
        assert!(model.units.iter().flatten().all(|c| c.is_finite()) && !model.units.is_empty());
        let row = kind_features(&Ink::default(), &[], &Reading::default());
        assert!(row.iter().all(|x| x.is_finite()));
        let sum: f64 = shares(&row, &[0.0; Kind::ALL.len()]).kinds.iter().map(|s| s.score).sum();
        assert!((sum - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_glance_moves_shares_only_among_the_kinds_that_it_knows() {
        let kinds = [Some(Kind::Tree), Some(Kind::Fruit), Some(Kind::Stem), None];
        let mut seen = [0.0; Kind::ALL.len()];
        (seen[Kind::Tree.place()], seen[Kind::Fruit.place()]) = (0.1, 0.9);
        let mut powers = [0.4, 0.2, 0.3, 0.1];
        weigh(&mut powers, &kinds, &seen);
        assert!((powers[0] + powers[1] - 0.6).abs() < 1e-12 && powers[2..] == [0.3, 0.1], "{powers:?}");
        assert!((powers[0] / powers[1] - 2.0 * ops::powf(0.13 / 0.93, TRUST)).abs() < 1e-12, "{powers:?}");
        let before = powers;
        weigh(&mut powers, &kinds, &[0.0; Kind::ALL.len()]);
        assert_eq!(powers, before, "who sees nothing changes nothing");
    }
}
