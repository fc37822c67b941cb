//! How a whole drawing looks: `ink -> numbers`, for the model of kinds.
//!
//! Nothing here knows a plant. Each number is about 0 to 1, and none depends on the direction of strokes, on left and
//! right, or on the size of the sheet; they depend on the order of strokes only where more than eight strokes end in
//! one place. The model (`kinds`) learns what they are worth.

use base::ops;
use geom::{bounds, signed_area};
use glam::DVec2;
use ink::{Ink, InkStroke};

use crate::grid::{Grid, Hole};
use crate::near::openness;
use crate::thresholds::ROUNDING;

/// Bands into which the height is cut.
const BANDS: usize = 8;
/// The measures: a name, and how many numbers it has, the lowest band first.
pub(crate) const GROUPS: &[(&str, usize)] = &[
    ("band-ink", BANDS),
    ("band-wide", BANDS),
    ("band-off-centre", BANDS),
    ("band-filled", BANDS),
    ("band-runs", BANDS),
    ("band-holes", 4),
    ("band-wide-holes", 4),
    ("holes", 3),
    ("largest-hole", 7),
    ("second-hole", 3),
    ("wide-holes", 3),
    ("largest-wide-hole", 5),
    ("way-by-cell", 32),
    ("turning", 4),
    ("corners", 4),
    ("hairpins", 4),
    ("corner-way", 4),
    ("one-way-round", 1),
    ("to-and-fro", 4),
    ("symmetric", 3),
    ("ring-ink", 4),
    ("ring-outward", 4),
    ("sector-ink", 5),
    ("high-ring-ink", 3),
    ("high-ring-outward", 3),
    ("silhouette", 7),
    ("reach", 7),
    ("foot", 8),
    ("openness", 3),
    ("lengths", 5),
    ("longest", 2),
    ("loops", 4),
    ("lines", 6),
    ("ends", 6),
    ("loose-ends", 3),
    ("crossed", 4),
    ("tilt", 2),
];

/// How many numbers these are together.
pub(crate) const COUNT: usize = {
    let (mut sum, mut k) = (0, 0);
    while k < GROUPS.len() {
        sum += GROUPS[k].1;
        k += 1;
    }
    sum
};

/// Cells along the longer side of a fine grid.
const FINE: usize = 44;
/// Cells along the longer side of a wide grid, in which small gaps close.
const WIDE: usize = 18;
// Boundaries of the numbers. The model learns what each is worth, so the exact boundaries matter little; everything
// that depends on them must be learnt again when one is changed (`cargo xtask train-kinds`).

/// Quotients with a divisor below this are 0: *geometry*.
const NOTHING: f64 = 1e-12;
/// A stroke whose ends are nearer than this share of its length is a loop.
pub(crate) const LOOP: f64 = 0.25;
/// A stroke whose ends are farther apart than this share of its length is a line.
pub(crate) const LINE: f64 = 0.8;
/// Limits of openness between closed, bent and straight strokes.
const OPENNESS: [f64; 2] = [0.2, 0.7];
/// Openness below which a stroke counts as having no ends.
const CLOSED: f64 = 0.1;
/// Limits between lengths of strokes, as shares of the drawing's longer side.
const LENGTHS: [f64; 4] = [0.08, 0.25, 0.7, 1.8];
/// Limits between sizes of loops, as shares of the drawing's longer side.
const LOOP_SIZES: [f64; 2] = [0.12, 0.45];
/// Limits between areas of holes, as shares of the drawing's box.
const HOLES: [f64; 2] = [0.01, 0.08];
/// Tangent of an eighth of half a turn, which divides level, slanting and upright lines evenly (*geometry*, rounded).
const EIGHTH: f64 = 0.414;
/// A corner turns by more than this angle, radians: 52 degrees.
const CORNER: f64 = 0.9;
/// A hairpin turns by more than this angle, radians: 120 degrees.
const HAIRPIN: f64 = 2.1;
/// A line turns back by more than this share of the drawing's longer side.
const TURNS_BACK: f64 = 0.05;
/// A row of a standing part is narrower than this share of the widest row.
const NARROW: f64 = 0.35;
/// A row of a line has less ink than this share of the widest row.
const LINE_INK: f64 = 0.12;
/// Most runs of ink in a row of two lines: a third one may lie between them.
const TWO_LINES: f64 = 3.0;
/// The first row wider than this share of the widest is where the plant widens.
const WIDENS: f64 = 0.7;
/// Ends meet where they are nearer than this share of the drawing's longer side.
const MEETS: f64 = 0.04;
/// Most ends that are kept of one place.
const CELL_CAP: usize = 8;

fn log(x: f64) -> f64 {
    ops::ln(1.0 + x) / 4.0
}

fn share(part: f64, whole: f64) -> f64 {
    if whole > NOTHING { part / whole } else { 0.0 }
}

fn to_f64(n: usize) -> f64 {
    n as f64
}

/// The drawing in its box.
struct Frame<'a> {
    strokes: &'a [InkStroke],
    lo: DVec2,
    size: DVec2,
    centre: DVec2,
    /// Longer side of the box.
    long: f64,
    /// Length for which each point stands; the points of all strokes.
    weight: Vec<f64>,
    total: f64,
}

impl<'a> Frame<'a> {
    fn new(ink: &'a Ink) -> Option<Self> {
        let all: Vec<DVec2> = ink.strokes.iter().flat_map(|s| s.points.iter().copied()).collect();
        let (lo, hi) = bounds(&all)?;
        let long = (hi - lo).max_element().max(1e-9);
        // A line has no width: a small share of its length takes its place.
        let size = (hi - lo).max(DVec2::splat(0.02 * long));
        let weight = ink.strokes.iter().map(|s| s.length / to_f64(s.points.len())).collect();
        let total = ink.strokes.iter().map(|s| s.length).sum();
        Some(Self { strokes: &ink.strokes, lo, size, centre: lo.midpoint(hi), long, weight, total })
    }

    /// Returns every point with the length that it stands for, as a share of all.
    fn points(&self) -> impl Iterator<Item = (DVec2, f64)> {
        let rows = self.strokes.iter().zip(&self.weight);
        let total = self.total;
        rows.flat_map(move |(s, w)| s.points.iter().map(move |p| (*p, w / total)))
    }

    /// Returns the height of a point, 0 below to 1 above.
    fn height(&self, p: DVec2) -> f64 {
        ((p.y - self.lo.y) / self.size.y).clamp(0.0, 1.0)
    }

    /// Returns the distance from the middle, 0 to 1 at the sides.
    fn off_centre(&self, p: DVec2) -> f64 {
        ((p.x - self.centre.x).abs() / (0.5 * self.size.x)).min(1.0)
    }
}

/// Returns the index of a share, 0 to 1, among `n` equal parts.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1 times a small number")]
fn place(share: f64, n: usize) -> usize {
    ((share * n as f64) as usize).min(n - 1)
}

/// Returns all numbers, in the order of [`GROUPS`]; zeros for an empty drawing. `all`: its points, and their hull.
/// Linear in points.
pub(crate) fn look(ink: &Ink, all: (&[DVec2], &[DVec2])) -> Vec<f64> {
    let Some(frame) = Frame::new(ink) else { return vec![0.0; COUNT] };
    let (fine, wide) = (Grid::new(ink, FINE), Grid::new(ink, WIDE));
    let mut row = Vec::with_capacity(COUNT);
    bands(&frame, &fine, &mut row);
    holes(&fine, &wide, &mut row);
    ways(&frame, &mut row);
    turns(&frame, &mut row);
    row.extend(fine.symmetric());
    rings(&frame, &fine, &mut row);
    silhouette(&frame, all, &fine, &mut row);
    row.extend(foot(&fine));
    strokes(&frame, &mut row);
    ends(&frame, &fine, &mut row);
    row.extend(fine.crossed());
    row.extend(tilt(&frame));
    debug_assert_eq!(row.len(), COUNT, "one number for each name");
    row.iter_mut().for_each(|x| *x = if x.is_finite() { x.clamp(-4.0, 4.0) } else { 0.0 });
    row
}

fn bands(frame: &Frame<'_>, fine: &Grid, row: &mut Vec<f64>) {
    let mut ink = [0.0; BANDS];
    let mut across = [(f64::INFINITY, f64::NEG_INFINITY); BANDS];
    let mut off = [0.0; BANDS];
    for (p, w) in frame.points() {
        let b = place(frame.height(p), BANDS);
        ink[b] += w;
        off[b] += w * frame.off_centre(p);
        across[b] = (across[b].0.min(p.x), across[b].1.max(p.x));
    }
    row.extend(ink.map(|x| 2.0 * x));
    row.extend(across.map(|(a, b)| (b - a).max(0.0) / frame.size.x));
    row.extend((0..BANDS).map(|b| share(off[b], ink[b])));
    let rows = fine.rows();
    let mean = |b: usize, of: &dyn Fn(&crate::grid::GridRow) -> f64| {
        let own: Vec<f64> = (0..rows.len())
            .filter(|&r| place((to_f64(r) + 0.5) / to_f64(rows.len()), BANDS) == b)
            .map(|r| of(&rows[r]))
            .collect();
        share(own.iter().sum(), to_f64(own.len()))
    };
    row.extend((0..BANDS).map(|b| mean(b, &|r| r.filled)));
    row.extend((0..BANDS).map(|b| mean(b, &|r| r.runs / 5.0)));
}

fn holes(fine: &Grid, wide: &Grid, row: &mut Vec<f64>) {
    row.extend(fine.hole_bands());
    row.extend(wide.hole_bands());
    let sizes = |grid: &Grid| {
        let count = |from: f64, to: f64| {
            log(to_f64(grid.holes.iter().filter(|h| h.area >= from && h.area < to).count()))
        };
        [count(0.0, HOLES[0]), count(HOLES[0], HOLES[1]), count(HOLES[1], 2.0)]
    };
    let first = |grid: &Grid, k: usize| grid.holes.get(k).copied().unwrap_or_default();
    row.extend(sizes(fine));
    let h: Hole = first(fine, 0);
    row.extend([h.area, h.middle, h.low, h.high, h.wide, h.full, h.off]);
    let h = first(fine, 1);
    row.extend([h.area, h.middle, h.full]);
    row.extend(sizes(wide));
    let h = first(wide, 0);
    row.extend([h.area, h.middle, h.low, h.wide, h.full]);
}

/// Measures the directions of lines by cell: four rows, the middle and the sides. Level, rising outwards, upright,
/// rising inwards.
fn ways(frame: &Frame<'_>, row: &mut Vec<f64>) {
    let mut sums = [0.0; 32];
    for s in frame.strokes {
        for w in s.points.windows(2) {
            let (d, p) = (w[1] - w[0], w[0].midpoint(w[1]));
            let side = if frame.off_centre(p) < 0.5 { 0 } else { 1 };
            let (u, v) = (d.x.abs(), d.y.abs());
            let rises_right = d.x * d.y > 0.0;
            let way = match () {
                () if v < EIGHTH * u => 0,
                () if u < EIGHTH * v => 2,
                () if rises_right == (p.x > frame.centre.x) => 1,
                () => 3,
            };
            sums[(place(frame.height(p), 4) * 2 + side) * 4 + way] += d.length() / frame.total;
        }
    }
    row.extend(sums.map(|x| 4.0 * x));
}

/// Measures how lines turn: gently or sharply, always in one direction or to and fro.
fn turns(frame: &Frame<'_>, row: &mut Vec<f64>) {
    const WINDOW: f64 = 0.03;
    let (mut turning, mut corners, mut hairpins) = ([0.0; 4], [0.0; 4], [0.0; 4]);
    let (mut up, mut down, mut outward, mut inward) = (0.0, 0.0, 0.0, 0.0);
    let (mut one_way, mut any_way) = (0.0, 0.0);
    let (mut level, mut upright, mut most) = (0.0, 0.0, [0.0_f64; 2]);
    for s in frame.strokes {
        let n = s.points.len();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a window has few steps")]
        let k = ((WINDOW / s.step.max(1e-9)).round().clamp(1.0, 64.0) as usize).min(n / 2).max(1);
        let angle = |i: usize| {
            let (a, b) = (s.points[i] - s.points[i - k], s.points[i + k] - s.points[i]);
            ops::atan2(a.perp_dot(b), a.dot(b))
        };
        let angles: Vec<f64> = (k..n.saturating_sub(k)).map(angle).collect();
        let (mut sum, mut size) = (0.0, 0.0);
        for (j, &a) in angles.iter().enumerate() {
            let p = s.points[j + k];
            let band = place(frame.height(p), 4);
            turning[band] += a.abs() / to_f64(k);
            (sum, size) = (sum + a / to_f64(k), size + a.abs() / to_f64(k));
            let around = &angles[j.saturating_sub(k)..(j + k + 1).min(angles.len())];
            let sharpest = a.abs() > CORNER && around.iter().all(|b| b.abs() <= a.abs() + ROUNDING);
            // On a plateau keep the first.
            if !sharpest || (j > 0 && (angles[j - 1].abs() - a.abs()).abs() <= ROUNDING) {
                continue;
            }
            corners[band] += 1.0;
            if a.abs() > HAIRPIN {
                hairpins[band] += 1.0;
            }
            let tip = (p - s.points[j].midpoint(s.points[j + 2 * k])).normalize_or_zero();
            let away = if p.x > frame.centre.x { tip.x } else { -tip.x };
            up += tip.y.max(0.0);
            down += (-tip.y).max(0.0);
            outward += away.max(0.0);
            inward += (-away).max(0.0);
        }
        (one_way, any_way) = (one_way + sum.abs(), any_way + size);
        let back = [reversals(s, frame.long, |p| p.x), reversals(s, frame.long, |p| p.y)];
        (level, upright) = (level + back[0], upright + back[1]);
        most = [most[0].max(back[0]), most[1].max(back[1])];
    }
    row.extend(turning.map(|x| log(x / ops::TAU)));
    row.extend(corners.map(log));
    row.extend(hairpins.map(log));
    row.extend([up, down, outward, inward].map(log));
    row.push(share(one_way, any_way));
    row.extend([level, upright, most[0], most[1]].map(log));
}

/// Counts how often a stroke turns back along an axis, by more than a twentieth of the drawing.
fn reversals(s: &InkStroke, long: f64, of: impl Fn(DVec2) -> f64) -> f64 {
    let least = TURNS_BACK * long;
    let (mut low, mut high) = (of(s.points[0]), of(s.points[0]));
    let (mut way, mut count) = (0, 0.0);
    for &p in &s.points {
        let x = of(p);
        (low, high) = (low.min(x), high.max(x));
        if way <= 0 && x > low + least {
            count += if way < 0 { 1.0 } else { 0.0 };
            (way, high) = (1, x);
        } else if way >= 0 && x < high - least {
            count += if way > 0 { 1.0 } else { 0.0 };
            (way, low) = (-1, x);
        }
        if way > 0 {
            low = high;
        } else if way < 0 {
            high = low;
        }
    }
    count
}

/// Measures rings round the middle of the whole, and round the middle of the upper part; sectors from below to above.
fn rings(frame: &Frame<'_>, fine: &Grid, row: &mut Vec<f64>) {
    let around = |centre: DVec2, from: f64, n: usize| -> (Vec<f64>, Vec<f64>) {
        let (mut ink, mut outward) = (vec![0.0; n], vec![0.0; n]);
        let mut whole = 0.0;
        for s in frame.strokes {
            for w in s.points.windows(2) {
                let (d, p) = (w[1] - w[0], w[0].midpoint(w[1]));
                if p.y < from {
                    continue;
                }
                let (r, length) = (p - centre, d.length());
                let ring = place((r.length() / (0.6 * frame.long)).min(1.0), n);
                ink[ring] += length;
                outward[ring] += d.dot(r.normalize_or_zero()).abs();
                whole += length;
            }
        }
        let shares = outward.iter().zip(&ink).map(|(o, i)| share(*o, *i)).collect();
        (ink.iter().map(|i| share(*i, whole)).collect(), shares)
    };
    let centre = fine.middle(0.0);
    let (ink, outward) = around(centre, f64::NEG_INFINITY, 4);
    row.extend(ink);
    row.extend(outward);
    let mut sectors = [0.0; 5];
    for (p, w) in frame.points() {
        let r = p - centre;
        sectors[place(ops::atan2(r.y, r.x.abs()) / ops::PI + 0.5, 5)] += w;
    }
    row.extend(sectors);
    let (ink, outward) = around(fine.middle(0.5), frame.lo.y + 0.4 * frame.size.y, 3);
    row.extend(ink);
    row.extend(outward);
}

/// Measures the filled outline of the whole.
fn silhouette(frame: &Frame<'_>, (all, hull): (&[DVec2], &[DVec2]), fine: &Grid, row: &mut Vec<f64>) {
    let hull_area = if hull.len() > 2 { signed_area(hull) } else { 0.0 };
    let (filled, rim, inked) = fine.areas();
    let cell = fine.cell * fine.cell;
    row.extend([
        share(filled * cell, frame.size.x * frame.size.y),
        share(filled * cell, hull_area).min(2.0) / 2.0,
        share(filled.sqrt(), rim),
        share(inked, filled),
        (fine.middle(0.0).y - frame.lo.y) / frame.size.y,
        frame.points().map(|(p, w)| w * frame.height(p)).sum(),
        share(hull_area, frame.size.x * frame.size.y),
    ]);
    let centre = fine.middle(0.0);
    let mut reach = [0.0_f64; 7];
    for p in all {
        let r = *p - centre;
        let sector = place(ops::atan2(r.y, r.x.abs()) / ops::PI + 0.5, 7);
        reach[sector] = reach[sector].max(r.length() / frame.long);
    }
    row.extend(reach);
}

/// Measures the part that stands below: a line, two lines side by side, something narrow under something wide.
fn foot(fine: &Grid) -> [f64; 8] {
    let rows = fine.rows();
    let n = rows.len();
    let widest = rows.iter().map(|r| r.across).fold(0.0, f64::max).max(1e-9);
    let upto = |from: usize, is: &dyn Fn(&crate::grid::GridRow) -> bool| {
        share(to_f64(rows[from..].iter().take_while(|r| is(r)).count()), to_f64(n))
    };
    // The lowest row is often a ground or the foot of a trunk.
    let from = (n / 20 + 1).min(n - 1);
    let narrow = |r: &crate::grid::GridRow| r.across < NARROW * widest;
    let low: Vec<f64> = rows[..n.div_ceil(3)].iter().map(|r| r.across / widest).collect();
    let thin = low.iter().copied().fold(1.0, f64::min);
    let jump = rows.windows((n / 8).max(2)).map(|w| w[w.len() - 1].across - w[0].across).fold(0.0, f64::max);
    [
        upto(from, &narrow),
        upto(from, &|r| r.runs <= 1.0 && r.ink < LINE_INK * widest.max(1.0)),
        upto(from, &|r| narrow(r) && r.runs >= 2.0 && r.runs <= TWO_LINES),
        share(low.iter().sum(), to_f64(low.len())),
        thin,
        jump.min(2.0),
        share(to_f64(rows.iter().filter(|r| r.runs == 2.0).count()), to_f64(n)),
        share(to_f64(rows.iter().position(|r| r.across > WIDENS * widest).unwrap_or(0)), to_f64(n)),
    ]
}

/// Strokes by their form.
fn strokes(frame: &Frame<'_>, row: &mut Vec<f64>) {
    let mut open = [0.0; 3];
    let mut lengths = [0.0; 5];
    let mut loops = [0.0; 3];
    let mut lines = [0.0; 5];
    let (mut loop_height, mut line_length) = (0.0, 0.0);
    let mut sorted: Vec<f64> = Vec::new();
    for s in frame.strokes {
        let o = openness(s);
        open[if o < OPENNESS[0] {
            0
        } else if o < OPENNESS[1] {
            1
        } else {
            2
        }] += 1.0;
        let l = s.length / frame.long;
        sorted.push(s.length / frame.total);
        lengths[LENGTHS.iter().filter(|&&x| l > x).count()] += 1.0;
        let Some((lo, hi)) = bounds(&s.points) else { continue };
        let (size, middle) = ((hi - lo).max_element() / frame.long, lo.midpoint(hi));
        if o < LOOP {
            loops[if size < LOOP_SIZES[0] {
                0
            } else if size < LOOP_SIZES[1] {
                1
            } else {
                2
            }] += 1.0;
            loop_height += frame.height(middle);
        }
        if o > LINE {
            let d = s.points[s.points.len() - 1] - s.points[0];
            let way = match () {
                () if d.y.abs() < EIGHTH * d.x.abs() => 0,
                () if d.x.abs() < EIGHTH * d.y.abs() => 1,
                () if (d.x * d.y > 0.0) == (middle.x > frame.centre.x) => 2,
                () => 3,
            };
            lines[way] += 1.0;
            lines[4] += frame.height(middle);
            line_length += l;
        }
    }
    base::sort_numbers(&mut sorted);
    sorted.reverse();
    row.extend(open.map(log));
    row.extend(lengths.map(log));
    row.extend([0, 1].map(|k| sorted.get(k).copied().unwrap_or_default()));
    let loop_count: f64 = loops.iter().sum();
    let line_count: f64 = lines[..4].iter().sum();
    row.extend(loops.map(log));
    row.push(share(loop_height, loop_count));
    row.extend([0, 1, 2, 3].map(|k| log(lines[k])));
    row.extend([share(lines[4], line_count), share(line_length, line_count)]);
}

/// Measures how ends meet other strokes: at an end, in the middle, not at all.
fn ends(frame: &Frame<'_>, fine: &Grid, row: &mut Vec<f64>) {
    let near = MEETS * frame.long;
    let at_end = EndGrid::new(frame, near);
    let (mut joined, mut on, mut loose) = (0.0, 0.0, 0.0);
    let mut loose_by = [0.0; 3];
    for (k, s) in frame.strokes.iter().enumerate() {
        if openness(s) < CLOSED {
            continue;
        }
        for p in [s.points[0], s.points[s.points.len() - 1]] {
            if at_end.has_other(p, k) {
                joined += 1.0;
            } else if fine.has_other(p, k) {
                on += 1.0;
            } else {
                loose += 1.0;
                loose_by[place(frame.height(p), 3)] += 1.0;
            }
        }
    }
    let all = joined + on + loose;
    row.extend([log(joined), log(on), log(loose), share(joined, all), share(on, all), share(loose, all)]);
    row.extend(loose_by.map(log));
}

/// Ends of strokes by cell.
struct EndGrid {
    near: f64,
    cells: std::collections::BTreeMap<(i64, i64), Vec<(DVec2, usize)>>,
}

impl EndGrid {
    fn new(frame: &Frame<'_>, near: f64) -> Self {
        let mut grid = Self { near, cells: std::collections::BTreeMap::new() };
        for (k, s) in frame.strokes.iter().enumerate() {
            for p in [s.points[0], s.points[s.points.len() - 1]] {
                let own = grid.cells.entry(Self::key(p, near)).or_default();
                if own.len() < CELL_CAP {
                    own.push((p, k));
                }
            }
        }
        grid
    }

    #[expect(clippy::cast_possible_truncation, reason = "ink lies within 0 and 1")]
    fn key(p: DVec2, near: f64) -> (i64, i64) {
        ((p.x / near).floor() as i64, (p.y / near).floor() as i64)
    }

    fn has_other(&self, p: DVec2, stroke: usize) -> bool {
        let (x, y) = Self::key(p, self.near);
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
        around
            .filter_map(|c| self.cells.get(&c))
            .flatten()
            .any(|&(q, k)| k != stroke && q.distance(p) < self.near)
    }
}

/// Measures how long and how slanted the cloud of ink is, in any direction.
fn tilt(frame: &Frame<'_>) -> [f64; 2] {
    let mean = frame.points().fold(DVec2::ZERO, |m, (p, w)| m + p * w);
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
    for (p, w) in frame.points() {
        let d = p - mean;
        (xx, yy, xy) = (xx + w * d.x * d.x, yy + w * d.y * d.y, xy + w * d.x * d.y);
    }
    let (half, apart) = (0.5 * (xx + yy), (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt());
    [share((half - apart).max(0.0), half + apart).sqrt(), share(2.0 * xy.abs(), xx + yy)]
}

#[cfg(test)]
mod tests {
    use base::Report;
    use ink::Drawing;

    use super::*;

    /// A tree with a lobed crown to the left, a trunk of two lines and a loose twig.
    fn lines() -> Vec<Vec<DVec2>> {
        let ring = (0..=80).map(|k| {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 80.0);
            let lobe = 1.0 + 0.12 * ops::sin(7.0 * ops::TAU * f64::from(k) / 80.0);
            DVec2::new(-8.0 + 30.0 * lobe * c, 90.0 + 24.0 * lobe * s)
        });
        let line = |a: DVec2, b: DVec2| (0..=20).map(|k| a.lerp(b, f64::from(k) / 20.0)).collect::<Vec<_>>();
        vec![
            ring.collect(),
            line(DVec2::new(-6.0, 0.0), DVec2::new(-5.0, 64.0)),
            line(DVec2::new(7.0, 1.0), DVec2::new(5.0, 65.0)),
            line(DVec2::new(8.0, 30.0), DVec2::new(31.0, 47.0)),
        ]
    }

    fn looks(lines: &[Vec<DVec2>]) -> Vec<f64> {
        let ink = ink::clean(&Drawing::from_polylines("drawing", lines), &mut Report::default());
        let all: Vec<DVec2> = ink.strokes.iter().flat_map(|s| s.points.iter().copied()).collect();
        look(&ink, (&all, &geom::convex_hull(&all)))
    }

    fn names() -> Vec<String> {
        GROUPS.iter().flat_map(|&(name, n)| (0..n).map(move |k| format!("{name}-{k}"))).collect()
    }

    fn same(what: &str, other: &[Vec<DVec2>]) {
        let (a, b) = (looks(&lines()), looks(other));
        for ((name, a), b) in names().iter().zip(a).zip(b) {
            // A point on the border of two cells may fall into either.
            assert!((a - b).abs() < 0.06, "{what}: {name} was {a} and is {b}");
        }
    }

    #[test]
    fn neither_the_direction_nor_the_order_of_strokes_counts() {
        let mut other = lines();
        other.iter_mut().for_each(|l| l.reverse());
        same("direction", &other);
        other.rotate_left(2);
        same("order", &other);
    }

    #[test]
    fn neither_left_and_right_nor_the_size_of_the_sheet_counts() {
        let moved = |by: DVec2, to: DVec2| -> Vec<Vec<DVec2>> {
            lines().into_iter().map(|l| l.into_iter().map(|p| p * by + to).collect()).collect()
        };
        same("mirror", &moved(DVec2::new(-1.0, 1.0), DVec2::ZERO));
        same("size", &moved(DVec2::splat(7.3), DVec2::new(-400.0, 90.0)));
    }

    #[test]
    fn above_and_below_count() {
        let turned: Vec<Vec<DVec2>> =
            lines().into_iter().map(|l| l.into_iter().map(|p| DVec2::new(p.x, -p.y)).collect()).collect();
        let (a, b) = (looks(&lines()), looks(&turned));
        let apart: f64 = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum();
        assert!(apart > 3.0, "{apart}");
    }

    #[test]
    fn every_drawing_has_finite_numbers() {
        let dot = vec![vec![DVec2::ZERO, DVec2::splat(1e-9)]];
        let level = vec![vec![DVec2::ZERO, DVec2::X]];
        let upright = vec![vec![DVec2::ZERO, DVec2::Y], vec![DVec2::ZERO, DVec2::Y]];
        for lines in [Vec::new(), dot, level, upright, lines()] {
            let row = looks(&lines);
            assert_eq!(row.len(), COUNT);
            assert!(row.iter().all(|x| x.is_finite()));
        }
    }
}
