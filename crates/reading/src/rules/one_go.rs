//! The rule about plants drawn in one go: a stem, and leaves or petals as loops along it.

use geom::{convex_hull, polyline_length, signed_area};
use glam::DVec2;
use ink::StrokeClass;

use super::{Findings, free, unsure};
use crate::draft::{Draft, OneGo};
use crate::thresholds::ROUNDING;

/// Fewest stems with leaves if the whole is taken for a kind that has none.
const FEWEST: usize = 2;
/// Points of a stroke that are compared with each other.
const LOOKED: usize = 160;
/// A loop is at least this share of its stroke long.
const LOOP: f64 = 0.07;
/// A loop closes where the pen comes back to within this distance of its line.
const CLOSES: f64 = 0.012;
/// Least closing distance, as a share of the loop's length.
const CLOSES_SHARE: f64 = 0.05;
/// Greatest closing distance, as a share of the loop's length.
const CLOSES_MOST: f64 = 0.08;
/// Least area of a loop over the square of its length; it is 0.08 for a circle, 0.05 for a lens four times as long as
/// wide (*geometry*).
const OPEN: f64 = 0.018;
/// A loop fills more than this share of its hull.
const FULL: f64 = 0.75;
/// Greatest area over the square of its reach of a single loop, which may be the crown of a tree: less than 0.4 for a
/// lens, 0.79 for a circle (*geometry*).
const LENS: f64 = 0.42;
/// The same limit for several loops.
const LENSES: f64 = 0.6;
/// The stem is more than this share of the stroke long.
const STEM: f64 = 0.15;
/// The ends of the stem are farther apart than this share of its length: it leads somewhere.
const LEADS: f64 = 0.5;

/// Finds stems with leaves: lines that come back to themselves along their way.
pub(super) fn one_go(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Blade, Fruit, TrunkOutline, Vein};
    let mut found = Findings::default();
    let mut parts: Vec<(usize, OneGo)> = (0..draft.class.len())
        .filter(|&k| free(draft, k) && [Axis, Blade, Fruit, TrunkOutline, Vein].contains(&draft.class[k]))
        .filter_map(|k| Some((k, apart(&draft.ink.strokes[k].points)?)))
        .collect();
    // A single one may be a fruit with its stalk, if the whole looks like it; several are no coincidence.
    if parts.len() < FEWEST {
        parts.retain(|(k, _)| unsure(draft, *k));
    }
    parts.iter().for_each(|(k, _)| found.settle(*k, Blade));
    found.one_go = parts;
    found
}

/// Separates the loops of a line from its stem; `None` if it is no stem with loops.
fn apart(points: &[DVec2]) -> Option<OneGo> {
    let length = polyline_length(points);
    let stride = points.len().div_ceil(LOOKED);
    let p: Vec<DVec2> = points.iter().step_by(stride).chain(points.last()).copied().collect();
    let mut way = vec![0.0];
    for w in p.windows(2) {
        way.push(way[way.len() - 1] + w[0].distance(w[1]));
    }
    let (mut loops, mut stem, mut from) = (Vec::new(), Vec::new(), 0);
    let mut j = 0;
    while j < p.len() {
        let closing = |j: usize| closing((&p, &way), from, j, LOOP * length);
        let Some(first) = closing(j) else {
            j += 1;
            continue;
        };
        // A few points further on may come nearer.
        let ahead = (j + 1..p.len()).map_while(closing).take(LOOKED / 10);
        let best = ahead.fold(first, |a, b| if b.0 < a.0 { b } else { a });
        let (_, start, end) = best;
        if !is_loop(&p[start..=end], way[end] - way[start]) {
            return None;
        }
        stem.extend_from_slice(&p[from..=start]);
        loops.push(p[start..=end].to_vec());
        (from, j) = (end, end + 1);
    }
    stem.extend_from_slice(&p[from..]);
    stem.dedup();
    let most = if loops.len() == 1 { LENS } else { LENSES };
    let slim = |l: &Vec<DVec2>| {
        let reach = l.iter().map(|q| q.distance(l[0])).fold(0.0, f64::max);
        signed_area(l).abs() < most * reach * reach
    };
    let left = polyline_length(&stem);
    let leads = stem.len() > 2 && stem[0].distance(stem[stem.len() - 1]) > LEADS * left;
    let apart = loops.iter().enumerate().all(|(i, l)| {
        let middle = geom::centroid(&convex_hull(l));
        loops.iter().enumerate().all(|(k, other)| k == i || !geom::contains(other, middle))
    });
    (!loops.is_empty() && loops.iter().all(slim) && leads && left > STEM * length && apart)
        .then_some(OneGo { loops, stem })
}

/// Finds where the line from `from` on comes nearest to its point `j` and closes a loop of at least that length: the
/// distance, and both places.
fn closing((p, way): (&[DVec2], &[f64]), from: usize, j: usize, least: f64) -> Option<(f64, usize, usize)> {
    let mut best: Option<(f64, usize, usize)> = None;
    let mut i = from;
    while i < j && way[j] - way[i] > least {
        let (gap, long) = (p[i].distance(p[j]), way[j] - way[i]);
        let closes = CLOSES.min(CLOSES_MOST * long).max(CLOSES_SHARE * long);
        if gap < closes && best.is_none_or(|b| gap < b.0) {
            best = Some((gap, i, j));
        }
        // The distance shrinks by no more than the length along the line, and shorter loops close nearer.
        let far = way[i] + (gap - closes) - ROUNDING;
        i += 1;
        while i < j && way[i] < far {
            i += 1;
        }
    }
    best
}

fn is_loop(line: &[DVec2], length: f64) -> bool {
    let area = signed_area(line).abs();
    let hull = convex_hull(line);
    hull.len() > 2 && area > OPEN * length * length && area > FULL * signed_area(&hull)
}
