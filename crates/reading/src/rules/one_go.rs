//! The rule about plants drawn in one go: a stem, and leaves or petals as loops on its way.

use geom::{convex_hull, polyline_length, signed_area};
use glam::DVec2;
use ink::StrokeClass;

use super::{Findings, free, unsure};
use crate::draft::{Draft, OneGo};
use crate::thresholds::ROUNDING;

/// Stems with leaves at least, where the whole is taken for something that has none.
const FEWEST: usize = 2;
/// Points of a stroke that are compared with each other.
const LOOKED: usize = 160;
/// A loop is at least this share of its stroke, and closes where the pen comes back to within this of itself, but between these
/// shares of the loop.
const LOOP: f64 = 0.07;
const CLOSES: f64 = 0.012;
const CLOSES_SHARE: f64 = 0.05;
const CLOSES_MOST: f64 = 0.08;
/// Its area over the square of its length; that of a circle is 0.08, of a lens four times as long as wide 0.05 (*geometry*).
const OPEN: f64 = 0.018;
/// It fills this share of its hull.
const FULL: f64 = 0.75;
/// Its area over the square of its reach: of a lens less than 0.4, of a circle 0.79 (*geometry*). Of one loop alone, which may
/// be the crown of a tree, and of several.
const LENS: f64 = 0.42;
const LENSES: f64 = 0.6;
/// The stem is at least this share of the stroke, and leads somewhere: its ends are this far apart as a share of it.
const STEM: f64 = 0.15;
const LEADS: f64 = 0.5;

/// Lines that come back to themselves on their way are stems with leaves.
pub(super) fn one_go(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Blade, Fruit, TrunkOutline, Vein};
    let mut found = Findings::default();
    let mut parts: Vec<(usize, OneGo)> = (0..draft.class.len())
        .filter(|&k| free(draft, k) && [Axis, Blade, Fruit, TrunkOutline, Vein].contains(&draft.class[k]))
        .filter_map(|k| Some((k, apart(&draft.ink.strokes[k].points)?)))
        .collect();
    // One may be a fruit with its stalk, if the whole looks like it; several are no chance.
    if parts.len() < FEWEST {
        parts.retain(|(k, _)| unsure(draft, *k));
    }
    parts.iter().for_each(|(k, _)| found.settle(*k, Blade));
    found.one_go = parts;
    found
}

/// The loops of a line and what is left of it; none where it is no stem with loops.
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
        // A few points on it may come nearer.
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

/// Where the line from `from` on comes nearest to its point `j` and closes a loop of at least that length: how near, and
/// from where to where.
fn closing((p, way): (&[DVec2], &[f64]), from: usize, j: usize, least: f64) -> Option<(f64, usize, usize)> {
    let mut best: Option<(f64, usize, usize)> = None;
    let mut i = from;
    while i < j && way[j] - way[i] > least {
        let (gap, long) = (p[i].distance(p[j]), way[j] - way[i]);
        let closes = CLOSES.min(CLOSES_MOST * long).max(CLOSES_SHARE * long);
        if gap < closes && best.is_none_or(|b| gap < b.0) {
            best = Some((gap, i, j));
        }
        // It comes nearer by no more than it goes on, and shorter loops close nearer.
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
