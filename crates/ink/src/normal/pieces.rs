//! Lines that were drawn in pieces, or twice.

use glam::DVec2;

use super::{Change, Figure, LIMITS, Work, chord_of, is_closed, length_of, places, some_of};
use crate::InkSample;

/// Number of points of a line that are compared with another.
const COMPARED: usize = 24;
/// Largest difference of the lengths of two equally long lines, as a share of the longer one.
const AS_LONG: f64 = 0.18;
/// Least cosine between pieces of one sub-path that continue each other: 45 degrees.
const STRAIGHT_ON: f64 = 0.7;
/// Distance within which segments of a polyline meet, as a share of the drawing's diagonal.
const MEET_EXACTLY: f64 = 1e-3;
/// Distance within which segments of a polyline meet, as a share of the shorter segment's length.
const MEET_SEGMENT: f64 = 0.1;
/// Largest mean distance of a line drawn twice by one program, as a share of the drawing's diagonal.
const BY: f64 = 0.003;
/// Largest distance anywhere of a line drawn twice, as a share of the drawing's diagonal.
const BY_AT_MOST: f64 = 0.006;
/// Largest mean distance of a line drawn twice, as a share of its length.
const BY_SHARE: f64 = 0.06;
/// Largest distance anywhere of a line drawn twice, as a share of its length.
const BY_AT_MOST_SHARE: f64 = 0.12;
/// Most pieces of an outline.
const PIECES: usize = 3;

impl Work {
    /// Merges sub-paths of one figure, and successive figures, that run the same way: programs that imitate a hand draw
    /// each line twice.
    pub(super) fn merge_repeats(&mut self) {
        let mut out = self.none_out();
        let diagonal = self.diagonal();
        for (figure, out) in self.figures.iter().zip(&mut out) {
            for l in 1..figure.lines.len() {
                let (before, line) = (&figure.lines[l - 1], &figure.lines[l]);
                // The edges of a thin ring lie as near, but they run in opposite directions, or the even-odd rule
                // applies.
                let is_painted = figure.fill.is_some_and(|f| !f.even_odd) && is_turned_alike(before, line);
                if (figure.lined || is_painted)
                    && !out[l - 1]
                    && goes_along(before, line, &within_figure(diagonal, line))
                {
                    out[l] = true;
                }
            }
        }
        for k in 1..self.figures.len() {
            let (before, figure) = (&self.figures[k - 1], &self.figures[k]);
            if let ([a], [b]) = (before.lines.as_slice(), figure.lines.as_slice())
                && (before.lined && figure.lined && before.fill == figure.fill && is_like(before, figure))
                && !out[k - 1][0]
                && goes_along(a, b, &between_figures(diagonal, b))
            {
                out[k][0] = true;
            }
        }
        self.leave_out(&out, Change::DrawnTwice);
    }

    pub(super) fn join_pieces(&mut self) {
        let diagonal = self.diagonal();
        let mut joined = 0;
        for figure in &mut self.figures {
            if figure.lined && figure.lines.len() > 1 {
                joined += join_sub_paths(&mut figure.lines, LIMITS.meet * diagonal);
            }
        }
        joined += self.join_segments(diagonal);
        joined += self.join_outlines(diagonal);
        self.note(Change::Joined, joined);
    }

    /// Joins short lines in elements of their own, each of which begins where the one before ended. Where a long line
    /// is written so, short ones are, too.
    fn join_segments(&mut self, diagonal: f64) -> usize {
        let mut runs: Vec<Vec<Figure>> = Vec::with_capacity(self.figures.len());
        for figure in core::mem::take(&mut self.figures) {
            match runs.last_mut() {
                Some(run) if goes_on(run, &figure, diagonal) => run.push(figure),
                _ => runs.push(vec![figure]),
            }
        }
        let longest = runs.iter().map(Vec::len).max().unwrap_or_default();
        let least = if longest >= LIMITS.segments { 2 } else { usize::MAX };
        let mut joined = 0;
        for run in runs {
            if run.len() < least {
                self.figures.extend(run);
                continue;
            }
            joined += run.len();
            let mut pieces = run.into_iter();
            if let Some(mut first) = pieces.next() {
                first.lines[0].extend(pieces.flat_map(|piece| piece.lines.into_iter().flatten().skip(1)));
                self.figures.push(first);
            }
        }
        joined
    }

    /// Joins two or three successive open lines that make one closed outline.
    fn join_outlines(&mut self, diagonal: f64) -> usize {
        let mut joined = 0;
        let mut figures: Vec<Figure> = Vec::with_capacity(self.figures.len());
        let mut rest = core::mem::take(&mut self.figures).into_iter().peekable();
        let mut waiting: Vec<Figure> = Vec::new();
        loop {
            while waiting.len() < PIECES
                && let Some(next) = rest.next()
            {
                waiting.push(next);
            }
            if waiting.is_empty() {
                break;
            }
            let found = (2..=waiting.len()).find_map(|n| Some((n, outline_of(&waiting[..n], diagonal)?)));
            if let Some((n, outline)) = found {
                let mut first = waiting.remove(0);
                waiting.drain(..n - 1);
                first.lines = vec![outline];
                figures.push(first);
                joined += n;
            } else {
                figures.push(waiting.remove(0));
            }
        }
        self.figures = figures;
        joined
    }
}

/// Whether two outlines run round in the same direction.
fn is_turned_alike(a: &[InkSample], b: &[InkSample]) -> bool {
    geom::signed_area(&places(a)) * geom::signed_area(&places(b)) > 0.0
}

fn is_like(a: &Figure, b: &Figure) -> bool {
    let (s, o) = (&a.like, &b.like);
    (s.color, s.mode, &s.layer, s.hidden) == (o.color, o.mode, &o.layer, o.hidden)
}

/// A line that may be a piece of a longer one.
struct Segment {
    from: DVec2,
    to: DVec2,
    length: f64,
}

/// Returns the only line of a figure, if it is drawn and encloses nothing.
fn segment_of(figure: &Figure) -> Option<Segment> {
    let is_area = figure.fill.is_some_and(|f| f.said);
    match (figure.lined, figure.lines.as_slice()) {
        (true, [line]) if line.len() == 2 || !(is_area || is_closed(line)) => {
            let (from, to) = (line.first()?.at, line.last()?.at);
            Some(Segment { from, to, length: length_of(line) })
        }
        _ => None,
    }
}

/// Whether a short line begins where the last of a run of short lines ended, and is painted like it.
fn goes_on(run: &[Figure], next: &Figure, diagonal: f64) -> bool {
    let (Some(before), Some(s)) = (run.last().and_then(segment_of), segment_of(next)) else { return false };
    let shorter = before.length.min(s.length);
    let meet = (MEET_EXACTLY * diagonal).min(MEET_SEGMENT * shorter);
    before.length.max(s.length) <= LIMITS.segment * diagonal
        && before.to.distance(s.from) <= meet
        && is_like(&run[0], next)
}

/// Joins sub-paths that begin where the one before ends and continue it. Straight pieces need not continue, as the
/// sides of a polygon are drawn one by one, but then all of them must meet.
fn join_sub_paths(lines: &mut Vec<Vec<InkSample>>, meet: f64) -> usize {
    let exact = 0.02 * meet;
    let polygon = lines.len() > 2
        && lines.iter().all(|l| chord_of(l).length() >= LIMITS.straight * length_of(l))
        && lines.windows(2).all(|w| end_to_start(&w[0], &w[1]) <= meet);
    let before = lines.len();
    let mut out: Vec<Vec<InkSample>> = Vec::with_capacity(before);
    for line in lines.drain(..) {
        match out.last_mut() {
            Some(last)
                if polygon
                    || (end_to_start(last, &line) <= exact
                        && !is_closed(last)
                        && !is_closed(&line)
                        && leads_on(last, &line)) =>
            {
                last.extend(line.into_iter().skip(1));
            }
            _ => out.push(line),
        }
    }
    *lines = out;
    if lines.len() < before { before - lines.len() + 1 } else { 0 }
}

fn end_to_start(a: &[InkSample], b: &[InkSample]) -> f64 {
    match (a.last(), b.first()) {
        (Some(a), Some(b)) => a.at.distance(b.at),
        _ => f64::INFINITY,
    }
}

fn leads_on(a: &[InkSample], b: &[InkSample]) -> bool {
    let ([.., p, q], [r, s, ..]) = (a, b) else { return false };
    let (from, to) = (q.at - p.at, s.at - r.at);
    from.dot(to) >= STRAIGHT_ON * from.length() * to.length()
}

/// Largest distance between two lines that are one: on the average, and anywhere.
struct Near {
    mean: f64,
    most: f64,
}

/// Returns the limits for lines in figures of their own, which may be two needles or the sides of a stem: only a
/// difference that a pen's tremble explains makes them one.
fn between_figures(diagonal: f64, line: &[InkSample]) -> Near {
    let long = length_of(line);
    Near {
        mean: (BY * diagonal).min(BY_SHARE * long),
        most: (BY_AT_MOST * diagonal).min(BY_AT_MOST_SHARE * long),
    }
}

fn within_figure(diagonal: f64, line: &[InkSample]) -> Near {
    let (far, own) = (LIMITS.twice * length_of(line), between_figures(diagonal, line));
    Near { mean: own.mean.max(0.5 * far), most: own.most.max(1.5 * far) }
}

/// Whether two lines run the same way from end to end, or round and round.
fn goes_along(a: &[InkSample], b: &[InkSample], near: &Near) -> bool {
    let (long, other) = (length_of(a), length_of(b));
    if !(long > 0.0 && (long - other).abs() <= AS_LONG * long.max(other)) {
        return false;
    }
    let (a, b) = (places(a), places(b));
    let lies_by = |from: &[DVec2], to: &[DVec2]| {
        let away = |p: DVec2| geom::closest_on_polyline(to, p).map_or(f64::INFINITY, |c| c.point.distance(p));
        let even = geom::resample(from, long / 24.0);
        let all: Vec<f64> = some_of(&even, COMPARED).map(away).collect();
        let most = all.iter().copied().fold(0.0, f64::max);
        #[expect(clippy::cast_precision_loss, reason = "a few points")]
        let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
        most <= near.most && mean <= near.mean
    };
    lies_by(&a, &b) && lies_by(&b, &a)
}

/// Returns the closed outline that open lines make together, end to end in their order.
fn outline_of(pieces: &[Figure], diagonal: f64) -> Option<Vec<InkSample>> {
    let mut lines: Vec<&[InkSample]> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        match piece.lines.as_slice() {
            [line] if piece.lined && line.len() > 3 && !is_closed(line) && is_like(&pieces[0], piece) => {
                lines.push(line);
            }
            _ => return None,
        }
    }
    let shortest = lines.iter().map(|l| length_of(l)).fold(f64::INFINITY, f64::min);
    let tolerance = (LIMITS.meet * diagonal).min(LIMITS.meet_share * shortest);
    [false, true].into_iter().find_map(|turned| {
        let mut way = oriented(lines[0], turned);
        for line in &lines[1..] {
            let end = way.last()?.at;
            let turned = end.distance(line.last()?.at) < end.distance(line.first()?.at);
            let next = oriented(line, turned);
            if end.distance(next.first()?.at) > tolerance {
                return None;
            }
            way.extend(next);
        }
        if chord_of(&way).length() > tolerance {
            return None;
        }
        let start = *way.first()?;
        way.push(start);
        let length = length_of(&way);
        (geom::signed_area(&places(&way)).abs() >= LIMITS.round * length * length).then_some(way)
    })
}

fn oriented(line: &[InkSample], turned: bool) -> Vec<InkSample> {
    let mut out = line.to_vec();
    if turned {
        out.reverse();
    }
    out
}
