//! `cargo xtask train-no-plants`: drawings in all styles -> the coefficients of the model that recognises other things
//! than plants.
//!
//! A logistic regression with noise and dropout (Srivastava et al. 2014). First by folds, so that each drawing is
//! judged by a model that did not learn from its word or name: these figures choose the limit. Then from all that are
//! not held out for the end. The same drawings give the same coefficients.

use std::fmt::Write as _;
use std::fs;

use base::{Draw, Report, Run, Seed, ops};
use reading::{NO_PLANT_LIMITS, no_plant_feature_names};

use crate::adam::{self, ByWeight, Moments};
use crate::in_all_styles::{Set, Styled, gathered, lot};
use crate::made_drawings::varied;
use crate::read_drawings::sketches;
use crate::train_kinds::short;
use xtask::shell::{Outcome, repository, say};

/// Number of folds; each drawing is judged by a model that did not learn from its fold.
const FOLDS: u64 = 5;
/// Number of steps.
const STEPS: usize = 3000;
/// Number of drawings in each step.
const BATCH: usize = 256;
/// Length of the first step.
const RATE: f64 = 2e-3;
/// Decay of coefficients towards 0.
const PULL: f64 = 0.01;
/// Noise on numbers whose standard deviation is 1.
const NOISE: f64 = 0.4;
/// Share of numbers that is dropped in each look.
const DROP: f64 = 0.2;
/// Weight of a variation of a drawing.
const VARIED: f64 = 0.6;
/// Share of the plants that may be false alarms.
const ALARMS: f64 = 0.02;
/// Weight of a drawing of the SPG set in the share of false alarms: the set shows only three things.
const SPG: f64 = 0.25;

/// Returns the weight of all drawings of a set, and the number of variations of each for training.
const fn weight(set: Set) -> (f64, u64) {
    match set {
        Set::Things => (3.0, 4),
        Set::Public => (2.0, 4),
        Set::Icons => (1.0, 4),
        Set::Lucide => (1.0, 1),
        Set::Spg | Set::LineArt => (0.5, 1),
        Set::Illustrations => (0.2, 4),
        Set::MadePlants | Set::MadeThings | Set::Scenes => (0.2, 0),
        Set::Programs => (0.1, 1),
        Set::Tabler | Set::TreesByHand => (0.0, 0),
    }
}

/// The numbers of a drawing.
struct Row {
    set: Set,
    fold: u64,
    is_kept: bool,
    is_varied: bool,
    numbers: Vec<f64>,
}

/// Trains the model and writes `crates/reading/data/no_plants.csv`. With `--end`, writes nothing, and reports instead
/// for which of the drawings held out the committed coefficients give a warning, or with `--read` for which others by
/// people.
///
/// # Errors
/// A sentence: npm is missing, or a file cannot be read or written.
pub(crate) fn run(args: &[String]) -> Outcome {
    let Some(folder) = sketches(args) else { return Ok(()) };
    let all = gathered(&folder)?;
    for (option, is_kept) in [("--end", true), ("--read", false)] {
        if args.iter().any(|a| a == option) {
            say(&table(&read(&all, is_kept), NO_PLANT_LIMITS.chance_most));
            return Ok(());
        }
    }
    let mut rows = measured(&all);
    rows.retain(|r| !r.is_kept);
    let mut judged: Vec<(Set, f64)> = Vec::new();
    for fold in 0..FOLDS {
        let model = Model::learn(&rows, |r| r.fold != fold);
        let own = rows.iter().filter(|r| r.fold == fold && !r.is_varied);
        judged.extend(own.map(|r| (r.set, model.chance(&r.numbers))));
    }
    say(&report(&judged));
    let path = repository().join("crates/reading/data/no_plants.csv");
    fs::write(&path, Model::learn(&rows, |_| true).text()).map_err(|e| format!("{}: {e}", path.display()))
}

/// Reads the drawings held out for the end, or all others by people, and returns whether reading warns of each.
fn read(all: &[Styled], is_kept: bool) -> Vec<(Set, f64)> {
    let own = all.iter().filter(|s| s.is_kept == is_kept && (is_kept || s.set.is_by_people()));
    let judge = |s: &Styled| {
        let mut report = Report::default();
        let ink = ink::clean(&s.drawing, &mut report);
        let classes = ink::classify(&ink, &Run::plain());
        reading::read(&ink, &classes, &mut report);
        let is_told = report.warnings.iter().any(|w| w.code == reading::UNLIKE_A_PLANT);
        (s.set, f64::from(u8::from(is_told)))
    };
    own.map(judge).collect()
}

/// Measures every drawing, and variations of those for training, on two threads.
fn measured(all: &[Styled]) -> Vec<Row> {
    const HANDS: usize = 2;
    let part = all.len().div_ceil(16 * HANDS).max(1);
    let mut found: Vec<(usize, Vec<Row>)> = std::thread::scope(|scope| {
        let own = |hand: usize| all.chunks(part).enumerate().filter(move |(k, _)| k % HANDS == hand);
        let hands: Vec<_> = (0..HANDS)
            .map(|hand| {
                let parts = own(hand);
                scope.spawn(move || parts.map(|(k, part)| (k, rows_of(part))).collect::<Vec<_>>())
            })
            .collect();
        let joined = |h: std::thread::ScopedJoinHandle<'_, Vec<(usize, Vec<Row>)>>| {
            h.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        hands.into_iter().flat_map(joined).collect()
    });
    found.sort_by_key(|(k, _)| *k);
    found.into_iter().flat_map(|(_, rows)| rows).collect()
}

fn rows_of(part: &[Styled]) -> Vec<Row> {
    let mut rows = Vec::new();
    for s in part.iter().filter(|s| !s.is_kept) {
        for copy in 0..=weight(s.set).1 {
            let drawing = if copy > 0 { &varied(&s.drawing, copy) } else { &s.drawing };
            let ink = ink::clean(drawing, &mut Report::default());
            if ink.strokes.is_empty() || ink.strokes.len() > MOST_STROKES {
                continue;
            }
            let numbers = reading::no_plant_row(&ink, &ink::classify(&ink, &Run::plain()));
            let fold = lot(&s.group) / 7 % FOLDS;
            rows.push(Row { set: s.set, fold, is_kept: s.is_kept, is_varied: copy > 0, numbers });
        }
    }
    rows
}

/// Most strokes of a drawing that the model of kinds judges.
const MOST_STROKES: usize = 1000;

struct Model {
    constant: f64,
    /// Mean and standard deviation of each number.
    scale: Vec<(f64, f64)>,
    coefficients: Vec<f64>,
}

impl Model {
    fn learn(rows: &[Row], is_learnt: impl Fn(&Row) -> bool) -> Self {
        let rows: Vec<&Row> = rows.iter().filter(|r| r.set.is_learnt_from() && is_learnt(r)).collect();
        let own = |r: &Row| if r.is_varied { VARIED } else { 1.0 };
        let sums = Set::ALL.map(|set| rows.iter().filter(|r| r.set == set).map(|r| own(r)).sum::<f64>());
        let weights: Vec<f64> = (rows.iter())
            .map(|r| weight(r.set).0 * own(r) / sums[Set::ALL.iter().position(|s| *s == r.set).unwrap_or(0)])
            .collect();
        let total: f64 = weights.iter().sum();
        let numbers = no_plant_feature_names().len();
        let round = |x: f64| (x * 1000.0).round() / 1000.0;
        let mean_of =
            |of: &dyn Fn(&Row) -> f64| rows.iter().zip(&weights).map(|(r, w)| w * of(r)).sum::<f64>() / total;
        let scale: Vec<(f64, f64)> = (0..numbers)
            .map(|i| {
                let mean = mean_of(&|r| r.numbers[i]);
                let spread = mean_of(&|r| (r.numbers[i] - mean) * (r.numbers[i] - mean)).sqrt();
                if spread < 0.002 { (0.0, 1.0) } else { (round(mean), round(spread)) }
            })
            .collect();
        let mut model = Self { constant: 0.0, scale, coefficients: vec![0.0; numbers] };
        let known: Vec<Vec<f64>> = rows.iter().map(|r| model.spreads(&r.numbers)).collect();
        let drawn = ByWeight::new(weights.iter().copied());
        let r = &mut Seed::new(41).stream(Draw::Template);
        let mut moments = [Moments::new(1), Moments::new(numbers)];
        for step in 0..STEPS {
            let (mut constant, mut slope) = ([0.0], vec![0.0; numbers]);
            for _ in 0..BATCH {
                let Some(at) = drawn.draw(r) else { continue };
                let mut x = known[at].clone();
                for pair in x.chunks_mut(2) {
                    pair.iter_mut().zip(r.normals()).for_each(|(x, n)| *x += NOISE * n);
                }
                x.iter_mut().for_each(|x| *x *= if r.chance(DROP) { 0.0 } else { 1.0 / (1.0 - DROP) });
                let meant = f64::from(u8::from(!rows[at].set.shows_a_plant()));
                let miss = (logistic(model.sum(&x)) - meant) / BATCH as f64;
                constant[0] += miss;
                slope.iter_mut().zip(&x).for_each(|(s, x)| *s += miss * x);
            }
            let rate = adam::rate(RATE, step, STEPS);
            let mut own = [model.constant];
            moments[0].step(&mut own, &constant, step + 1, rate, 0.0);
            model.constant = own[0];
            moments[1].step(&mut model.coefficients, &slope, step + 1, rate, PULL);
        }
        model.constant = round(model.constant);
        model.coefficients.iter_mut().for_each(|c| *c = round(*c));
        model
    }

    fn spreads(&self, numbers: &[f64]) -> Vec<f64> {
        let most = NO_PLANT_LIMITS.spreads_most;
        numbers.iter().zip(&self.scale).map(|(x, (mean, s))| ((x - mean) / s).clamp(-most, most)).collect()
    }

    fn sum(&self, spreads: &[f64]) -> f64 {
        self.constant + spreads.iter().zip(&self.coefficients).map(|(x, c)| x * c).sum::<f64>()
    }

    fn chance(&self, numbers: &[f64]) -> f64 {
        logistic(self.sum(&self.spreads(numbers)))
    }

    fn text(&self) -> String {
        let mut text = format!(
            "# Written by cargo xtask train-no-plants from drawings of \"Quick, Draw!\" (Google, CC BY 4.0), SPG, icons, line art and made ones.\n\
             name,mean,spread,coefficient\none,0,1,{}\n",
            short(self.constant, 3)
        );
        let rows = no_plant_feature_names().into_iter().zip(&self.scale).zip(&self.coefficients);
        for ((name, (mean, spread)), c) in rows {
            let _ = writeln!(text, "{name},{},{},{}", short(*mean, 3), short(*spread, 3), short(*c, 3));
        }
        text
    }
}

fn logistic(sum: f64) -> f64 {
    1.0 / (1.0 + ops::exp(-sum))
}

/// Reports the results by folds, with the limit that programs have and with the one that gives the allowed share of
/// false alarms.
fn report(judged: &[(Set, f64)]) -> String {
    let limit = limit(judged);
    let mut out = String::new();
    for most in [NO_PLANT_LIMITS.chance_most, limit] {
        let _ = writeln!(out, "by folds, no plant above {most:.3}:\n{}", table(judged, most));
    }
    out
}

/// Returns the limit above which the allowed share of plants by people lies.
fn limit(judged: &[(Set, f64)]) -> f64 {
    let plants = judged.iter().filter(|(set, _)| set.shows_a_plant() && set.is_by_people());
    let mut plants: Vec<(f64, f64)> =
        plants.map(|(set, c)| (*c, if *set == Set::Spg { SPG } else { 1.0 })).collect();
    plants.sort_by(|a, b| b.0.total_cmp(&a.0));
    let total: f64 = plants.iter().map(|p| p.1).sum();
    let mut sum = 0.0;
    for (chance, weight) in plants {
        sum += weight;
        if sum > ALARMS * total {
            return chance;
        }
    }
    0.0
}

fn table(judged: &[(Set, f64)], most: f64) -> String {
    let mut out = String::new();
    let (mut sums, mut all) = ([0.0; 2], [0.0; 2]);
    for set in Set::ALL {
        let own: Vec<f64> = judged.iter().filter(|j| j.0 == set).map(|j| j.1).collect();
        let told = own.iter().filter(|c| **c > most).count();
        if set.is_by_people() {
            let weight = if set == Set::Spg { SPG } else { 1.0 };
            let at = usize::from(set.shows_a_plant());
            sums[at] += weight * told as f64;
            all[at] += weight * own.len() as f64;
        }
        if !own.is_empty() {
            let share = 100.0 * told as f64 / own.len() as f64;
            let _ = writeln!(out, "  {:32} {told:>5} of {:>5} {share:>6.1} %", set.word(), own.len());
        }
    }
    let share = |k: usize| 100.0 * sums[k] / f64::max(all[k], 1.0);
    let _ = writeln!(
        out,
        "  by people: other things {:.1} % told, plants {:.2} %, one of SPG as {SPG}",
        share(0),
        share(1)
    );
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_lets_as_many_plants_pass_as_are_asked_for() {
        let plant = |k: u32| (Set::Icons, f64::from(k) / 100.0);
        let mut judged: Vec<(Set, f64)> = (0..100).map(plant).collect();
        judged.push((Set::Things, 1.0));
        let most = limit(&judged);
        assert_eq!(judged.iter().filter(|j| j.0 == Set::Icons && j.1 > most).count(), 2);
    }
}
