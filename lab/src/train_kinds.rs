//! `cargo xtask train-kinds`: drawings of the part for training -> the coefficients of the model of kinds.
//!
//! A small network ([`network`]) over the numbers of the whole drawing. The same drawings give the same coefficients.

mod network;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use base::{Report, Run};
use network::{Network, UNITS};
use reading::{KIND_FEATURE_LIMIT, Kind, SEVERAL};

use crate::in_all_styles;
use crate::made_drawings::varied;
use crate::read_drawings::{Labelled, Origin, Part, labelled, sketches};
use xtask::shell::{Outcome, repository, say};

/// Number of variations of each drawing by people that are learnt in addition to it.
const VARIATIONS: u64 = 14;
/// Number of variations of each drawing of the SPG set.
const VARIATIONS_SPG: u64 = 3;
/// Number of variations of each icon.
const VARIATIONS_ICONS: u64 = 14;
/// Number of variations of each made drawing.
const VARIATIONS_MADE: u64 = 1;
/// Weight of a variation, relative to its drawing.
const VARIED: f64 = 0.6;
/// Weight of a made drawing of a row: made ones are many and alike.
const MADE_ROW: f64 = 0.2;
/// Weight of a made drawing of a kind.
const MADE_KIND: f64 = 0.1;
/// Weight of drawings put next to one another.
const TOGETHER: f64 = 0.3;
/// Weight of a drawing of the SPG set, which shows only three things.
const SPG: f64 = 0.3;
/// Weight of an icon: at 0.2 icons are recognised as well as at 2, and cost no doodles: of 642 held out 583 are
/// recognised, 584 without icons, 572 at 2.
const ICON: f64 = 0.2;
/// Weight of trees: they are what people draw most, and few drawings for training show one.
const TREES: f64 = 3.0;
/// Kinds that the model distinguishes; the last is no plant.
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

/// Number of outcomes that the model distinguishes: the kinds, and several plants.
const COLUMNS: usize = KINDS.len() + 1;

fn word(column: usize) -> &'static str {
    KINDS.get(column).map_or(SEVERAL, |k| k.word())
}

fn is_tree(column: usize) -> bool {
    KINDS.get(column) == Some(&Kind::Tree)
}

/// One plant: its numbers, the index of its kind in [`KINDS`], its weight.
#[derive(Clone)]
struct Row {
    features: Vec<f64>,
    kind: usize,
    weight: f64,
    origin: Origin,
}

/// Mean and standard deviation of each number.
struct Scale(Vec<(f64, f64)>);

/// Trains the model of kinds and writes `crates/reading/data/kinds.csv`.
///
/// First from the part for training and icons, and reports the quality on the part for choosing: all choices are made
/// with this model, and `--half` writes it. Then from both: drawings are scarce, and neither contains the part for the
/// end.
///
/// # Errors
/// A sentence: a file cannot be read or written.
pub(crate) fn run(args: &[String]) -> Outcome {
    let half = args.iter().any(|a| a == "--half");
    let Some(folder) = sketches(args) else { return Ok(()) };
    let mut learnt = rows(&labelled(&folder, Part::Train)?, true);
    learnt.extend(rows(&icons(&folder)?, true));
    let choose = labelled(&folder, Part::Choose)?;
    let held_out = rows(&choose, false);
    let path = repository().join("crates/reading/data/kinds.csv");
    let write = |text: String| fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()));
    let first = model(learnt.clone(), held_out);
    if half {
        return write(first);
    }
    // Made drawings are available in any number, and there are enough already.
    let people = choose.into_iter().filter(|d| matches!(d.origin, Origin::Public | Origin::Spg));
    learnt.extend(rows(&people.collect::<Vec<_>>(), true));
    write(model(learnt, Vec::new()))
}

/// Returns icons of plants whose kind is known, without those held out for the end.
fn icons(folder: &Path) -> Outcome<Vec<Labelled>> {
    let icons = in_all_styles::icons_of_kinds(folder)?.into_iter();
    Ok(icons.map(|(kind, drawing)| Labelled { drawing, kinds: vec![kind], origin: Origin::Icons }).collect())
}

/// Trains a model and reports its quality; returns its file.
fn model(mut learnt: Vec<Row>, mut held_out: Vec<Row>) -> String {
    weigh(&mut learnt);
    let scale = Scale::fit(&learnt);
    learnt.iter_mut().chain(&mut held_out).for_each(|r| scale.apply(&mut r.features));
    let examples: Vec<network::Example<'_>> =
        learnt.iter().map(|r| (&*r.features, r.kind, r.weight)).collect();
    let net = Network::learn(&examples, COLUMNS);
    say(&format!("learnt from: {}", report(&learnt, &net)));
    if !held_out.is_empty() {
        say(&format!("held out: {}", report(&held_out, &net)));
    }
    let mut text = String::from(
        "# Written by cargo xtask train-kinds from drawings of \"Quick, Draw!\" (Google, CC BY 4.0), SPG, icons and made ones.\n\
         name,mean,spread",
    );
    let units = (0..UNITS).map(|k| format!("unit-{k}"));
    for word in (0..COLUMNS).map(|c| word(c).to_owned()).chain(units.clone()) {
        let _ = write!(text, ",{word}");
    }
    let numbers = reading::kind_feature_names().into_iter().zip(&scale.0);
    let rows = net.direct.chunks(COLUMNS).zip(net.inner.chunks(UNITS));
    for ((name, (mean, spread)), (direct, inner)) in numbers.zip(rows) {
        let _ = write!(text, "\n{name},{mean:.3},{spread:.3}");
        text.extend(direct.iter().chain(inner).map(|c| format!(",{}", short(*c, 2))));
    }
    for (name, outer) in units.zip(net.outer.chunks(COLUMNS)) {
        let _ = write!(text, "\n{name},0,1");
        text.extend(outer.iter().map(|c| format!(",{}", short(*c, 2))));
    }
    text.push('\n');
    text
}

/// Computes [`rows_of`] on several threads.
fn rows(drawings: &[Labelled], varied_too: bool) -> Vec<Row> {
    const HANDS: usize = 3;
    let part = drawings.len().div_ceil(8 * HANDS).max(1);
    let parts: Vec<&[Labelled]> = drawings.chunks(part).collect();
    let mut found: Vec<Vec<Row>> = parts.iter().map(|_| Vec::new()).collect();
    std::thread::scope(|scope| {
        let mut hands: Vec<Vec<_>> = (0..HANDS).map(|_| Vec::new()).collect();
        for (k, job) in parts.iter().zip(&mut found).enumerate() {
            hands[k % HANDS].push(job);
        }
        for jobs in hands {
            scope.spawn(move || jobs.into_iter().for_each(|(part, to)| *to = rows_of(part, varied_too)));
        }
    });
    found.into_iter().flatten().collect()
}

/// Measures every plant of drawings whose plants are known; of people's drawings also some variations.
fn rows_of(drawings: &[Labelled], varied_too: bool) -> Vec<Row> {
    let mut rows = Vec::new();
    for Labelled { drawing, kinds, origin } in drawings {
        let variations = match origin {
            Origin::Public => VARIATIONS,
            Origin::Spg => VARIATIONS_SPG,
            Origin::Icons => VARIATIONS_ICONS,
            Origin::Kinds => VARIATIONS_MADE,
            Origin::Rows | Origin::Together => 0,
        };
        for copy in 0..=if varied_too { variations } else { 0 } {
            let weight = match origin {
                Origin::Public => 1.0,
                Origin::Spg => SPG,
                Origin::Icons => ICON,
                Origin::Rows => MADE_ROW,
                Origin::Kinds => MADE_KIND,
                Origin::Together => TOGETHER,
            };
            let weight = if copy > 0 { VARIED * weight } else { weight };
            let own = if copy > 0 { &varied(drawing, copy) } else { drawing };
            rows.extend(measured(own, kinds).into_iter().map(|(features, kind)| {
                let weight = if is_tree(kind) { TREES * weight } else { weight };
                Row { features, kind, weight, origin: *origin }
            }));
        }
    }
    rows
}

/// Weights the rows: a kind with many drawings counts more than one with few, but less than in proportion.
fn weigh(rows: &mut [Row]) {
    let mut count = [0.0_f64; COLUMNS];
    rows.iter().for_each(|r| count[r.kind] += r.weight / if is_tree(r.kind) { TREES } else { 1.0 });
    for row in rows.iter_mut() {
        row.weight /= count[row.kind].sqrt();
    }
    let total: f64 = rows.iter().map(|r| r.weight).sum();
    rows.iter_mut().for_each(|r| r.weight /= total);
}

/// Returns the numbers and the kind of each plant of a drawing, unless it is not split into as many; and of several
/// together.
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
    /// Computes the scale as it is written: rounded.
    fn fit(rows: &[Row]) -> Self {
        let n = rows.len().max(1) as f64;
        let round = |x: f64| (x * 1000.0).round() / 1000.0;
        let of = |i: usize| {
            let mean = rows.iter().map(|r| r.features[i]).sum::<f64>() / n;
            let off = |r: &Row| r.features[i] - mean;
            let spread = (rows.iter().map(|r| off(r) * off(r)).sum::<f64>() / n).sqrt();
            // A number that never changes is the constant.
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

/// Formats a coefficient in few bytes.
pub(crate) fn short(c: f64, decimals: usize) -> String {
    let text = format!("{c:.decimals$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    let short = text.replacen("0.", ".", 1);
    if short.is_empty() || short == "-" || short == "-." { "0".to_owned() } else { short }
}

/// Reports how many are right, and for each kind the kinds that it was taken for.
fn report(rows: &[Row], net: &Network) -> String {
    let best = |row: &Row| {
        let p = net.evaluate(&row.features);
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
