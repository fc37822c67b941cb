//! `cargo xtask train-kinds`: drawings of the part to learn from -> the coefficients of the model of kinds.
//!
//! A softmax over kinds, linear in the numbers of the whole drawing, by gradient descent with a pull towards 0. Nothing of
//! it is chance: the same drawings give the same coefficients.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use base::{Report, Run, ops};
use reading::{KIND_FEATURE_LIMIT, Kind, SEVERAL};

use crate::made_drawings::varied;
use crate::read_drawings::{Labelled, Origin, Part, labelled};
use crate::shell::{Outcome, repository, say};

/// Steps of gradient descent.
const STEPS: usize = 800;
/// Length of a step.
const RATE: f64 = 0.1;
/// Pull of every coefficient towards 0.
const PULL: f64 = 0.002;
/// Variations of each drawing by people that are learnt from beside it, and how much one counts.
const VARIATIONS: u64 = 7;
const VARIED: f64 = 0.6;
/// How much a drawing counts: made ones are many and alike, and the SPG set shows three things only.
const MADE_ROW: f64 = 0.2;
const MADE_KIND: f64 = 0.5;
const SPG: f64 = 0.3;
/// Trees count so many times as much: they are what people draw most, and few drawings to learn from show one.
const TREES: f64 = 3.0;
/// Kinds that the model tells apart; the last is no plant.
const KINDS: [Kind; 12] = [
    Kind::Flower,
    Kind::Stem,
    Kind::Tree,
    Kind::Palm,
    Kind::Bush,
    Kind::Cactus,
    Kind::Grass,
    Kind::Leaf,
    Kind::Fruit,
    Kind::HousePlant,
    Kind::Vegetable,
    Kind::None,
];

/// What the model tells apart: the kinds, and several plants.
const COLUMNS: usize = KINDS.len() + 1;

fn word(column: usize) -> &'static str {
    KINDS.get(column).map_or(SEVERAL, |k| k.word())
}

fn is_tree(column: usize) -> bool {
    KINDS.get(column) == Some(&Kind::Tree)
}

/// One plant: its numbers, the place of its kind in [`KINDS`], how much it counts.
struct Row {
    features: Vec<f64>,
    kind: usize,
    weight: f64,
    origin: Origin,
}

/// Mean and spread of each number.
struct Scale(Vec<(f64, f64)>);

/// Learns the model of kinds and writes `crates/reading/data/kinds.csv`.
///
/// With `--half`, from the part to learn from alone, and says how good that is on the part to choose by: all choices are
/// made with this one. Without, from both: drawings are what the model lacks, and the end is in neither.
///
/// # Errors
/// A sentence: a file that cannot be read or written.
pub(crate) fn run(args: &[String]) -> Outcome {
    let half = args.iter().any(|a| a == "--half");
    let folder = args.iter().find(|a| !a.starts_with('-'));
    let folder = folder.map_or_else(|| repository().join("../shared/data/sketches"), PathBuf::from);
    if !folder.is_dir() {
        say(&format!("skipped: {} is not here", folder.display()));
        return Ok(());
    }
    let mut drawings = labelled(&folder, Part::Train)?;
    let choose = labelled(&folder, Part::Choose)?;
    let mut held_out = Vec::new();
    if half {
        held_out = rows(&choose, 0);
    } else {
        // Made drawings are as many as one likes, and enough already.
        drawings.extend(choose.into_iter().filter(|d| matches!(d.origin, Origin::Public | Origin::Spg)));
    }
    let mut learnt = rows(&drawings, VARIATIONS);
    let scale = Scale::of(&learnt);
    learnt.iter_mut().chain(&mut held_out).for_each(|r| scale.apply(&mut r.features));
    let coefficients = descend(&learnt);
    say(&format!("learnt from: {}", told(&learnt, &coefficients)));
    if half {
        say(&format!("held out: {}", told(&held_out, &coefficients)));
    }
    let mut text = String::from(
        "# Written by cargo xtask train-kinds from drawings of \"Quick, Draw!\" (Google, CC BY 4.0), SPG and made ones.\n\
         name,mean,spread",
    );
    for column in 0..COLUMNS {
        let _ = write!(text, ",{}", word(column));
    }
    text.push('\n');
    for (i, (name, (mean, spread))) in reading::kind_feature_names().into_iter().zip(&scale.0).enumerate() {
        let _ = write!(text, "{name},{mean:.3},{spread:.3}");
        for c in &coefficients {
            let _ = write!(text, ",{:.3}", c[i]);
        }
        text.push('\n');
    }
    let path = repository().join("crates/reading/data/kinds.csv");
    fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))
}

/// Every plant of drawings whose plants are known, measured; of people's drawings also some variations.
fn rows(drawings: &[Labelled], variations: u64) -> Vec<Row> {
    let mut rows = Vec::new();
    for Labelled { drawing, kinds, origin } in drawings {
        let people = matches!(origin, Origin::Public | Origin::Spg);
        for copy in 0..=if people { variations } else { 0 } {
            let weight = match origin {
                Origin::Public => 1.0,
                Origin::Spg => SPG,
                Origin::Rows => MADE_ROW,
                Origin::Kinds | Origin::Together => MADE_KIND,
            };
            let weight = if copy > 0 { VARIED * weight } else { weight };
            let own = if copy > 0 { &varied(drawing, copy) } else { drawing };
            rows.extend(measured(own, kinds).into_iter().map(|(features, kind)| {
                let weight = if is_tree(kind) { TREES * weight } else { weight };
                Row { features, kind, weight, origin: *origin }
            }));
        }
    }
    // A kind of which there are many drawings counts more than one with few, but not as much more.
    let mut count = [0.0_f64; COLUMNS];
    rows.iter().for_each(|r| count[r.kind] += r.weight / if is_tree(r.kind) { TREES } else { 1.0 });
    for row in &mut rows {
        row.weight /= count[row.kind].sqrt();
    }
    let total: f64 = rows.iter().map(|r| r.weight).sum();
    rows.iter_mut().for_each(|r| r.weight /= total);
    rows
}

/// The numbers and the kind of each plant of a drawing, unless it is not taken apart into as many; and of several together.
fn measured(drawing: &ink::Drawing, kinds: &[Kind]) -> Vec<(Vec<f64>, usize)> {
    let ink = ink::clean(drawing, &mut Report::default());
    let mut found = Vec::new();
    if kinds.len() > 1 {
        let classes = ink::classify(&ink, &Run::plain());
        found.push((reading::kind_row(&ink, &classes), KINDS.len()));
    }
    let unknown = kinds.iter().all(|k| *k == Kind::None);
    if kinds.len() > 1 && (unknown || ink.subjects.plants.len() != kinds.len()) {
        return found;
    }
    for (k, kind) in kinds.iter().enumerate() {
        let kind = match kind {
            Kind::Conifer => Kind::Tree,
            Kind::Flowers => Kind::Flower,
            k => *k,
        };
        let Some(kind) = KINDS.iter().position(|k| *k == kind) else { continue };
        let part = if kinds.len() > 1 { ink.part(&ink.subjects.plants[k]) } else { ink.clone() };
        let classes = ink::classify(&part, &Run::plain());
        found.push((reading::kind_row(&part, &classes), kind));
    }
    found
}

impl Scale {
    /// As they are written: rounded.
    fn of(rows: &[Row]) -> Self {
        let n = rows.len().max(1) as f64;
        let round = |x: f64| (x * 1000.0).round() / 1000.0;
        let of = |i: usize| {
            let mean = rows.iter().map(|r| r.features[i]).sum::<f64>() / n;
            let off = |r: &Row| r.features[i] - mean;
            let spread = (rows.iter().map(|r| off(r) * off(r)).sum::<f64>() / n).sqrt();
            // What never changes is the constant.
            if spread < 0.002 { (0.0, 1.0) } else { (round(mean), round(spread)) }
        };
        Self((0..reading::kind_feature_names().len()).map(of).collect())
    }

    fn apply(&self, features: &mut [f64]) {
        for (x, (mean, spread)) in features.iter_mut().zip(&self.0) {
            *x = ((*x - mean) / spread).clamp(-KIND_FEATURE_LIMIT, KIND_FEATURE_LIMIT);
        }
    }
}

fn shares(features: &[f64], coefficients: &[Vec<f64>]) -> Vec<f64> {
    let sums: Vec<f64> =
        coefficients.iter().map(|c| c.iter().zip(features).map(|(c, x)| c * x).sum()).collect();
    let most = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let powers: Vec<f64> = sums.iter().map(|s| ops::exp(s - most)).collect();
    let total: f64 = powers.iter().sum();
    powers.into_iter().map(|p| p / total).collect()
}

/// Gradient descent with a memory (Nesterov).
fn descend(rows: &[Row]) -> Vec<Vec<f64>> {
    let n = reading::kind_feature_names().len();
    let mut coefficients = vec![vec![0.0; n]; COLUMNS];
    let mut before = coefficients.clone();
    for step in 0..STEPS {
        let memory = step as f64 / (step as f64 + 3.0);
        let ahead: Vec<Vec<f64>> = (coefficients.iter().zip(&before))
            .map(|(c, b)| c.iter().zip(b).map(|(c, b)| c + memory * (c - b)).collect())
            .collect();
        let mut slope = vec![vec![0.0; n]; COLUMNS];
        for row in rows {
            let p = shares(&row.features, &ahead);
            for (k, slope) in slope.iter_mut().enumerate() {
                let miss = (p[k] - f64::from(u8::from(k == row.kind))) * row.weight;
                slope.iter_mut().zip(&row.features).for_each(|(s, x)| *s += miss * x);
            }
        }
        for ((a, s), b) in ahead.iter().zip(&slope).zip(&mut before) {
            b.iter_mut().zip(a.iter().zip(s)).for_each(|(b, (a, s))| *b = a - RATE * (s + PULL * a));
        }
        core::mem::swap(&mut coefficients, &mut before);
    }
    coefficients
}

/// How many are right, and for each kind what it was taken for.
fn told(rows: &[Row], coefficients: &[Vec<f64>]) -> String {
    let best = |row: &Row| {
        let p = shares(&row.features, coefficients);
        (0..p.len()).max_by(|&a, &b| p[a].total_cmp(&p[b])).unwrap_or(0)
    };
    let mut confused: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let mut right = 0;
    let (mut people, mut known, mut alike) = (0, 0, 0);
    for row in rows {
        let found = best(row);
        right += usize::from(found == row.kind);
        if matches!(row.origin, Origin::Public | Origin::Spg) {
            *confused.entry((row.kind, found)).or_default() += 1;
            people += 1;
            known += usize::from(found == row.kind);
            let like =
                |a: usize, b: usize| KINDS.get(a).zip(KINDS.get(b)).is_some_and(|(a, b)| a.is_like(*b));
            alike += usize::from(like(found, row.kind));
        }
    }
    let mut out = format!(
        "{right} of {} right, of people's {known} of {people}, and {alike} if a root may be a fruit",
        rows.len()
    );
    for k in 0..COLUMNS {
        let found: Vec<String> = confused
            .iter()
            .filter(|((meant, _), _)| *meant == k)
            .map(|((_, found), n)| format!("{} {n}", word(*found)))
            .collect();
        let _ = write!(out, "\n  {:12} {}", word(k), found.join(", "));
    }
    out
}
