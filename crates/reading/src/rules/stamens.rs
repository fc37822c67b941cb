//! The rule about stamens: lines from the middle of a flower, each with a small ring at its end.

use glam::DVec2;
use ink::StrokeClass;

use super::{CLOSED, Findings, free, openness};
use crate::draft::Draft;
use crate::thresholds::{FEWEST_PETALS, STRAIGHT};
use geom::bounds;

/// Fewest stamens.
const FEWEST: usize = 3;
/// A ring at the end of a line is smaller than this share of the line.
const SMALL: f64 = 0.45;
/// Its middle is nearer to the end than this factor of its own size.
const AT_END: f64 = 1.0;
/// The lines begin within this share of their length of one place.
const ONE_PLACE: f64 = 0.6;
/// Petals are larger than this factor of the lines' length.
const PETAL: f64 = 1.2;
/// Petals come within this share of the lines' length of that place.
const NEAR: f64 = 0.6;

struct Stamen {
    line: usize,
    knob: usize,
    foot: DVec2,
    long: f64,
}

/// Finds stamens: lines with a ring at one end that begin in one place, round which there are petals.
pub(super) fn stamens(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    let strokes = &draft.ink.strokes;
    let all = || (0..draft.class.len()).filter(|&k| free(draft, k));
    let boxes: Vec<Option<(DVec2, DVec2)>> = strokes.iter().map(|s| bounds(&s.points)).collect();
    let size = |k: usize| boxes[k].map_or(0.0, |(lo, hi)| lo.distance(hi));
    let closed: Vec<usize> = all().filter(|&k| openness(&strokes[k]) < CLOSED).collect();
    let mut stamens: Vec<Stamen> = Vec::new();
    for line in all().filter(|&k| openness(&strokes[k]) > STRAIGHT) {
        let p = &strokes[line].points;
        let (a, b) = (p[0], p[p.len() - 1]);
        let at = |k: usize, end: DVec2| {
            let (lo, hi) = boxes[k].unwrap_or_default();
            lo.midpoint(hi).distance(end) < AT_END * size(k)
        };
        let knobs = closed.iter().copied().filter(|&k| size(k) < SMALL * strokes[line].length);
        let mut pair = knobs.filter_map(|k| {
            let (first, last) = (at(k, a), at(k, b));
            (first != last).then_some((k, if first { b } else { a }))
        });
        // Takes a ring that no other line has.
        let free = pair.find(|(k, _)| stamens.iter().all(|s| s.knob != *k));
        stamens.extend(free.map(|(knob, foot)| Stamen { line, knob, foot, long: a.distance(b) }));
    }
    if stamens.len() < FEWEST {
        return found;
    }
    let mut left: Vec<usize> = (0..stamens.len()).collect();
    while let Some(&first) = left.first() {
        let seed = &stamens[first];
        let (own, rest): (Vec<usize>, Vec<usize>) =
            left.iter().partition(|&&i| stamens[i].foot.distance(seed.foot) < ONE_PLACE * seed.long);
        left = rest;
        #[expect(clippy::cast_precision_loss, reason = "a count")]
        let middle = own.iter().map(|&i| stamens[i].foot).sum::<DVec2>() / own.len() as f64;
        let petal = |&&k: &&usize| {
            let near = strokes[k].points.iter().any(|p| p.distance(middle) < NEAR * seed.long);
            near && size(k) > PETAL * seed.long && own.iter().all(|&i| stamens[i].knob != k)
        };
        if own.len() >= FEWEST && closed.iter().filter(petal).count() >= FEWEST_PETALS {
            for &i in &own {
                found.settle(stamens[i].line, StrokeClass::Axis);
                found.settle(stamens[i].knob, StrokeClass::Other);
            }
        }
    }
    found
}
