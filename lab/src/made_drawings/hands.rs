//! A drawing as other people might have drawn it.
//!
//! Drawings for training are few, and no two people draw alike: a model should not depend on the movement of one hand
//! in a drawing. So every variation is bent as a whole, each of its strokes is changed a little by itself, and strokes
//! are split, joined or repeated where another person would do so.

use std::f64::consts::TAU;

use base::{Draw, Seed, Stream, ops};
use glam::DVec2;
use ink::{Drawing, InkSample, Stroke};

type Lines = Vec<Vec<DVec2>>;

/// Returns a variation of a drawing. `copy` distinguishes the variations; the same in every call.
pub(crate) fn varied(drawing: &Drawing, copy: u64) -> Drawing {
    let r = &mut Seed::new(copy).child(hash(&drawing.name)).stream(Draw::Template);
    let lines: Lines = drawing.strokes.iter().map(|s| s.samples.iter().map(|p| p.at).collect()).collect();
    let lines = drawn_again(r, lines);
    let stroke = |line: Vec<DVec2>| Stroke {
        samples: line.into_iter().map(InkSample::from).collect(),
        ..Stroke::default()
    };
    let strokes = lines.into_iter().map(stroke).collect();
    Drawing { name: drawing.name.clone(), strokes, ..Drawing::default() }
}

/// Returns lines in another order, bent and slanted, some split in two, some two joined, one repeated or omitted.
pub(crate) fn drawn_again(r: &mut Stream, mut lines: Lines) -> Lines {
    lines.retain(|l| l.len() > 1);
    let Some((lo, hi)) = extent(&lines) else { return lines };
    let long = (hi - lo).max_element().max(1e-9);
    if lines.len() > 4 && r.chance(0.4) {
        let gone = r.below(lines.len());
        lines.remove(gone);
    }
    for k in (1..lines.len()).rev() {
        lines.swap(k, r.below(k + 1));
    }
    if r.chance(0.3) {
        lifted(r, &mut lines);
    }
    if r.chance(0.3) {
        not_lifted(r, &mut lines, 0.05 * long);
    }
    if r.chance(0.25) {
        // The longest line as often as all others: it changes the whole most.
        let longest = (0..lines.len()).max_by(|&a, &b| length(&lines[a]).total_cmp(&length(&lines[b])));
        let any = r.below(lines.len());
        let twice = lines[longest.filter(|_| r.chance(0.5)).unwrap_or(any)].clone();
        let off = DVec2::new(r.normal(), r.normal()) * (0.008 * long);
        lines.push(twice.into_iter().map(|p| p + off).collect());
    }
    if r.chance(0.25) {
        lines.iter_mut().for_each(|l| shorter(r, l));
    }
    let each = r.range(0.0, 0.05);
    lines.iter_mut().for_each(|l| by_itself(r, l, each));
    bent(r, &mut lines, (lo, hi));
    lines
}

/// Splits a stroke, as if the pen had been lifted.
fn lifted(r: &mut Stream, lines: &mut Lines) {
    let k = r.below(lines.len());
    let n = lines[k].len();
    if n > 5 {
        let at = 2 + r.below(n - 4);
        let mut rest = lines[k].split_off(at);
        rest.insert(0, lines[k][at - 1]);
        lines.push(rest);
    }
}

/// Joins two strokes that end near each other.
fn not_lifted(r: &mut Stream, lines: &mut Lines, near: f64) {
    let first = r.below(lines.len());
    let Some(&end) = lines[first].last() else { return };
    let next = (0..lines.len()).find(|&k| k != first && lines[k][0].distance(end) < near);
    if let Some(next) = next {
        let rest = lines[next].clone();
        lines[first].extend(rest);
        lines.remove(next);
    }
}

/// Shortens a line, so that ends do not meet.
fn shorter(r: &mut Stream, line: &mut Vec<DVec2>) {
    let n = line.len();
    let cut = n / 25;
    if n > 12 && r.chance(0.5) {
        line.truncate(n - r.below(cut + 1));
    }
}

/// Makes one stroke a little larger, turned and moved.
fn by_itself(r: &mut Stream, line: &mut [DVec2], by: f64) {
    let mean = line.iter().copied().sum::<DVec2>() / line.len().max(1) as f64;
    let (lo, hi) = line.iter().fold((mean, mean), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    let size = (hi - lo).max_element();
    let turn = super::direction(r.normal() * 2.0 * by);
    let grown = 1.0 + r.normal() * 2.0 * by;
    let to = mean + DVec2::new(r.normal(), r.normal()) * (0.5 * by * size);
    line.iter_mut().for_each(|p| *p = to + turn.rotate((*p - mean) * grown));
}

/// Turns, stretches, slants, and bends the whole by slow waves.
fn bent(r: &mut Stream, lines: &mut Lines, (lo, hi): (DVec2, DVec2)) {
    let long = (hi - lo).max_element().max(1e-9);
    let (stretch, slant) = (r.range(0.82, 1.22), r.range(-0.1, 0.1));
    let turn = super::direction(r.range(-12.0, 12.0) * TAU / 360.0);
    let wave = r.range(0.0, 0.04);
    let waves: Vec<(DVec2, f64, DVec2)> = (0..3)
        .map(|_| {
            let way = super::direction(r.range(0.0, TAU)) * (r.range(0.5, 1.6) * TAU);
            let push = super::direction(r.range(0.0, TAU)) * (wave * r.range(0.3, 1.0));
            (way, r.range(0.0, TAU), push)
        })
        .collect();
    for p in lines.iter_mut().flatten() {
        let q = (*p - lo) / long;
        let moved: DVec2 = waves.iter().map(|(way, at, push)| *push * ops::sin(way.dot(q) + at)).sum();
        let q = q + moved;
        *p = lo + turn.rotate(DVec2::new(q.x * stretch + q.y * slant, q.y)) * long;
    }
}

fn extent(lines: &Lines) -> Option<(DVec2, DVec2)> {
    let ends = lines.iter().flatten().map(|&p| (p, p));
    ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

fn length(line: &[DVec2]) -> f64 {
    line.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// Returns a number for a name.
fn hash(name: &str) -> u64 {
    name.bytes().fold(7, |h, b| h.wrapping_mul(31).wrapping_add(u64::from(b)))
}
