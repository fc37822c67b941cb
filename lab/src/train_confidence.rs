//! `cargo xtask train-confidence`: drawings by people whose kind is known -> the probability that a reading is right.
//!
//! A logistic regression over the evidence for a reading ([`reading::Evidence`]), by Newton's method. The same drawings
//! give the same coefficients.

use std::fmt::Write as _;
use std::fs;

use base::{Report, Run, ops};
use reading::{CONFIDENCE_LIMITS, EVIDENCE_NAMES, Evidence, Kind};

use crate::in_all_styles::{Set, Styled, gathered};
use crate::read_drawings::sketches;
use xtask::shell::{Outcome, repository, say};

/// Number of bins of the reliability of scores.
const BINS: usize = 10;
/// Strength of the decay of each coefficient towards 0, in drawings.
const PULL: f64 = 1.0;
/// Number of Newton steps.
const STEPS: usize = 30;
/// Number of coefficients.
const NUMBERS: usize = EVIDENCE_NAMES.len();

/// Returns the weight of all drawings of a set: the model of kinds learnt nothing from icons and trees by hand, and
/// most of the others by heart.
const fn weight(set: Set) -> f64 {
    match set {
        Set::TreesByHand | Set::Icons => 1.0,
        Set::Public => 0.8,
        Set::Spg => 0.25,
        _ => 0.0,
    }
}

/// A drawing that was read.
struct Judged {
    set: Set,
    evidence: Evidence,
    score: f64,
    is_right: bool,
    is_kept: bool,
}

/// Fits the confidence and writes `crates/reading/data/confidence.csv`. With `--end`, writes nothing, and reports the
/// reliability of the committed one on the drawings held out.
///
/// # Errors
/// A sentence: npm is missing, or a file cannot be read or written.
pub(crate) fn run(args: &[String]) -> Outcome {
    let Some(folder) = sketches(args) else { return Ok(()) };
    let at_the_end = args.iter().any(|a| a == "--end");
    let mut judged: Vec<Judged> = gathered(&folder)?.iter().filter_map(judge).collect();
    judged.retain(|j| j.is_kept == at_the_end);
    let structure = judged.iter().filter(|j| j.evidence.by_structure);
    let (many, few): (Vec<&Judged>, Vec<&Judged>) =
        structure.partition(|j| j.evidence.strokes >= CONFIDENCE_LIMITS.many_strokes);
    for (name, own) in [("many", many), ("fewer", few)] {
        let right = own.iter().filter(|j| j.is_right).count();
        say(&format!("by structure, of {name} strokes: {right} of {} right", own.len()));
    }
    let arranged: Vec<&Judged> = judged.iter().filter(|j| j.evidence.by_arrangement).collect();
    let right = arranged.iter().filter(|j| j.is_right).count();
    say(&format!("by arrangement: {right} of {} right", arranged.len()));
    if at_the_end {
        tell(&judged, &|j| j.score);
        return Ok(());
    }
    // Both have a minimum confidence of their own.
    judged.retain(|j| !j.evidence.by_structure && !j.evidence.by_arrangement);
    let told = |score: &dyn Fn(&Judged) -> f64| tell(&judged, score);
    say("the share of the kind:");
    told(&|j| j.evidence.share);
    let fitted = fit(&judged);
    say("fitted:");
    told(&|j| chance(&fitted, &j.evidence));
    let mut text = String::from(
        "# Written by cargo xtask train-confidence from drawings of \"Quick, Draw!\" (Google, CC BY 4.0), SPG, icons and trees by hand.\n\
         name,coefficient\n",
    );
    for (name, c) in EVIDENCE_NAMES.iter().zip(fitted) {
        let _ = writeln!(text, "{name},{c:.3}");
    }
    let path = repository().join("crates/reading/data/confidence.csv");
    fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))
}

/// Reports the reliability of scores, set by set.
fn tell(judged: &[Judged], score: &dyn Fn(&Judged) -> f64) {
    for set in [Set::Public, Set::Spg, Set::TreesByHand, Set::Icons, Set::Illustrations] {
        say(&reliability(set.word(), judged.iter().filter(|j| j.set == set), score));
    }
    say(&reliability("all but SPG", judged.iter().filter(|j| j.set != Set::Spg), score));
    say(&reliability("all", judged.iter(), score));
}

fn judge(s: &Styled) -> Option<Judged> {
    let meant = s.kind.filter(|_| weight(s.set) > 0.0 || s.set == Set::Illustrations)?;
    let mut report = Report::default();
    let ink = ink::clean(&s.drawing, &mut report);
    let reading = reading::read(&ink, &ink::classify(&ink, &Run::plain()), &mut report);
    // As in reports: the kind of the largest, and the mean of all.
    let largest = reading.plants.iter().reduce(|a, b| if b.height > a.height { b } else { a })?;
    let scores = reading.plants.iter().filter_map(|p| p.readings.first()).map(|r| r.score);
    let score = scores.sum::<f64>() / reading.plants.len() as f64;
    let is_right = largest.kind.is_like(meant) && largest.kind != Kind::None;
    Some(Judged { set: s.set, evidence: largest.evidence, score, is_right, is_kept: s.is_kept })
}

fn chance(coefficients: &[f64; NUMBERS], evidence: &Evidence) -> f64 {
    let sum: f64 = evidence.row().iter().zip(coefficients).map(|(x, c)| x * c).sum();
    1.0 / (1.0 + ops::exp(-sum))
}

/// Returns the coefficients of the logistic regression of maximum likelihood.
fn fit(judged: &[Judged]) -> [f64; NUMBERS] {
    let most = judged.len() as f64;
    let count = |set: Set| judged.iter().filter(|j| j.set == set).count().max(1) as f64;
    let sets: f64 = Set::ALL.iter().filter(|s| judged.iter().any(|j| j.set == **s)).map(|s| weight(*s)).sum();
    let mut own = [0.0; NUMBERS];
    for _ in 0..STEPS {
        let mut slope = [0.0; NUMBERS];
        let mut bend = [[0.0; NUMBERS]; NUMBERS];
        for (k, row) in bend.iter_mut().enumerate() {
            row[k] = PULL;
            slope[k] = PULL * own[k];
        }
        for j in judged {
            let (x, p) = (j.evidence.row(), chance(&own, &j.evidence));
            let w = most * weight(j.set) / sets / count(j.set);
            let miss = w * (p - f64::from(u8::from(j.is_right)));
            for a in 0..NUMBERS {
                slope[a] += miss * x[a];
                (0..NUMBERS).for_each(|b| bend[a][b] += w * p * (1.0 - p) * x[a] * x[b]);
            }
        }
        let step = solved(bend, slope);
        own.iter_mut().zip(step).for_each(|(c, s)| *c -= s);
    }
    own
}

/// Solves a system of linear equations whose matrix is positive definite (Gauss).
fn solved(mut rows: [[f64; NUMBERS]; NUMBERS], mut right: [f64; NUMBERS]) -> [f64; NUMBERS] {
    for k in 0..NUMBERS {
        for below in k + 1..NUMBERS {
            let above = rows[k];
            let share = rows[below][k] / above[k];
            rows[below].iter_mut().zip(above).for_each(|(x, a)| *x -= share * a);
            right[below] -= share * right[k];
        }
    }
    for k in (0..NUMBERS).rev() {
        let known: f64 = (k + 1..NUMBERS).map(|c| rows[k][c] * right[c]).sum();
        right[k] = (right[k] - known) / rows[k][k];
    }
    right
}

/// Reports for each bin of scores their number, their mean and the number of right ones; and the expected calibration
/// error (Naeini, Cooper and Hauskrecht 2015).
fn reliability<'a>(
    name: &str,
    judged: impl Iterator<Item = &'a Judged>,
    score: &dyn Fn(&Judged) -> f64,
) -> String {
    let mut bins = [(0_usize, 0.0, 0_usize); BINS];
    for j in judged {
        let score = score(j);
        let at = (0..BINS).rfind(|k| score * BINS as f64 >= *k as f64).unwrap_or(0);
        bins[at].0 += 1;
        bins[at].1 += score;
        bins[at].2 += usize::from(j.is_right);
    }
    let all = bins.iter().map(|b| b.0).sum::<usize>().max(1) as f64;
    let error: f64 = bins.iter().map(|b| (b.1 - b.2 as f64).abs()).sum::<f64>() / all;
    let right: usize = bins.iter().map(|b| b.2).sum();
    let mut out = format!("{name}: {right} of {all} right, expected calibration error {error:.3}\n");
    for (k, (n, sum, right)) in bins.iter().enumerate().filter(|(_, b)| b.0 > 0) {
        let mean = sum / *n as f64;
        let _ =
            writeln!(out, "  from {:.1}: {n:4}, mean score {mean:.3}, right {right}", k as f64 / BINS as f64);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(share: f64, is_right: bool) -> Judged {
        let evidence = Evidence { share, ..Evidence::default() };
        Judged { set: Set::Icons, evidence, score: share, is_right, is_kept: false }
    }

    #[test]
    fn what_is_fitted_is_as_sure_as_it_is_right() {
        // Half of those with a share of 0.95 are right; one of ten of those with 0.1.
        let mut all: Vec<Judged> = (0..200).map(|k| judged(0.95, k % 2 == 0)).collect();
        all.extend((0..200).map(|k| judged(0.1, k % 10 == 0)));
        let own = fit(&all);
        assert!((chance(&own, &all[0].evidence) - 0.5).abs() < 0.02);
        assert!((chance(&own, &all[300].evidence) - 0.1).abs() < 0.02);
        let told = reliability("all", all.iter(), &|j| chance(&own, &j.evidence));
        assert!(told.starts_with("all: 120 of 400 right, expected calibration error 0.0"), "{told}");
        let raw = reliability("all", all.iter(), &|j| j.score);
        assert!(raw.contains("error 0.225"), "{raw}");
    }
}
