//! `cargo xtask train-kinds`: drawings of the part to learn from -> the coefficients of the model of kinds.
//!
//! A softmax over kinds, linear in the numbers of the whole drawing, by gradient descent with a pull towards 0. Nothing of
//! it is chance: the same drawings give the same coefficients.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use base::{Report, Run, ops};
use ink::Drawing;
use reading::Kind;

use crate::read_drawings::{Part, labelled};
use crate::shell::{Outcome, repository, say};

/// Steps of gradient descent.
const STEPS: usize = 4_000;
/// Length of a step.
const RATE: f64 = 2.0;
/// Pull of every coefficient towards 0.
const PULL: f64 = 0.0002;
/// Kinds that the model tells apart.
const KINDS: [Kind; 11] = [
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
];

/// One plant: its numbers, the place of its kind in [`KINDS`], how much it counts.
struct Row {
    features: Vec<f64>,
    kind: usize,
    weight: f64,
    /// Drawn by people.
    people: bool,
}

/// Learns from the train part, says how good that is on the part to choose by, and writes `crates/reading/data/kinds.csv`.
///
/// # Errors
/// A sentence: a file that cannot be read or written.
pub(crate) fn run(args: &[String]) -> Outcome {
    let folder = args.first().map_or_else(|| repository().join("../shared/data/sketches"), PathBuf::from);
    if !folder.is_dir() {
        say(&format!("skipped: {} is not here", folder.display()));
        return Ok(());
    }
    let train = rows(&labelled(&folder, Part::Train)?);
    let choose = rows(&labelled(&folder, Part::Choose)?);
    let coefficients = descend(&train);
    for (name, rows) in [("train", &train), ("choose", &choose)] {
        say(&format!("{name}: {}", told(rows, &coefficients)));
    }
    let mut text = String::from(
        "# Written by cargo xtask train-kinds from drawings of \"Quick, Draw!\" (Google, CC BY 4.0), SPG and made ones.\nname",
    );
    for kind in KINDS {
        let _ = write!(text, ",{}", kind.word());
    }
    text.push('\n');
    for (i, name) in reading::kind_feature_names().into_iter().enumerate() {
        text.push_str(&name);
        for c in &coefficients {
            let _ = write!(text, ",{:.3}", c[i]);
        }
        text.push('\n');
    }
    let path = repository().join("crates/reading/data/kinds.csv");
    fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))
}

/// Every plant of drawings whose plants are known, measured.
fn rows(drawings: &[(Drawing, Vec<Kind>)]) -> Vec<Row> {
    let mut rows = Vec::new();
    for (drawing, kinds) in drawings {
        let ink = ink::clean(drawing, &mut Report::default());
        if ink.subjects.plants.len() != kinds.len() {
            continue;
        }
        for (plant, kind) in ink.subjects.plants.iter().zip(kinds) {
            let kind = match kind {
                Kind::Conifer => Kind::Tree,
                Kind::Flowers => Kind::Flower,
                k => *k,
            };
            let Some(kind) = KINDS.iter().position(|k| *k == kind) else { continue };
            let part = if kinds.len() > 1 { ink.part(plant) } else { ink.clone() };
            let classes = ink::classify(&part, &Run::plain());
            // Made ones are many and alike.
            let made = drawing.name.starts_with("made-");
            let weight = if made { 0.25 } else { 1.0 };
            rows.push(Row { features: reading::kind_row(&part, &classes), kind, weight, people: !made });
        }
    }
    // A kind of which there are many drawings counts more than one with few, but not as much more.
    let mut count = [0.0_f64; KINDS.len()];
    rows.iter().for_each(|r| count[r.kind] += r.weight);
    for row in &mut rows {
        row.weight /= count[row.kind].sqrt();
    }
    let total: f64 = rows.iter().map(|r| r.weight).sum();
    rows.iter_mut().for_each(|r| r.weight /= total);
    rows
}

fn shares(features: &[f64], coefficients: &[Vec<f64>]) -> Vec<f64> {
    let sums: Vec<f64> =
        coefficients.iter().map(|c| c.iter().zip(features).map(|(c, x)| c * x).sum()).collect();
    let most = sums.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let powers: Vec<f64> = sums.iter().map(|s| ops::exp(s - most)).collect();
    let total: f64 = powers.iter().sum();
    powers.into_iter().map(|p| p / total).collect()
}

fn descend(rows: &[Row]) -> Vec<Vec<f64>> {
    let n = reading::kind_feature_names().len();
    let mut coefficients = vec![vec![0.0; n]; KINDS.len()];
    let mut speed = coefficients.clone();
    for _ in 0..STEPS {
        let mut slope = vec![vec![0.0; n]; KINDS.len()];
        for row in rows {
            let p = shares(&row.features, &coefficients);
            for (k, slope) in slope.iter_mut().enumerate() {
                let miss = (p[k] - f64::from(u8::from(k == row.kind))) * row.weight;
                slope.iter_mut().zip(&row.features).for_each(|(s, x)| *s += miss * x);
            }
        }
        for ((c, s), v) in coefficients.iter_mut().zip(&slope).zip(&mut speed) {
            for ((c, s), v) in c.iter_mut().zip(s).zip(v) {
                *v = 0.9 * *v - RATE * 0.1 * (s + PULL * *c);
                *c += *v;
            }
        }
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
    for row in rows {
        let found = best(row);
        right += usize::from(found == row.kind);
        *confused.entry((row.kind, found)).or_default() += 1;
    }
    let people: Vec<&Row> = rows.iter().filter(|r| r.people).collect();
    let known = people.iter().filter(|r| best(r) == r.kind).count();
    let mut out = format!("{right} of {} right, of people's {known} of {}", rows.len(), people.len());
    for (k, kind) in KINDS.iter().enumerate() {
        let found: Vec<String> = confused
            .iter()
            .filter(|((meant, _), _)| *meant == k)
            .map(|((_, found), n)| format!("{} {n}", KINDS[*found].word()))
            .collect();
        let _ = write!(out, "\n  {:12} {}", kind.word(), found.join(", "));
    }
    out
}
