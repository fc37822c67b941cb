//! Measures each stroke among the others: `Ink -> Vec<StrokeFeatures>`.

mod companions;

use std::sync::Arc;

use base::{Executor, LiteMap, Run, map_indexed, ops};
use geom::convex_hull;
use glam::DVec2;

use self::companions::{COMPANIONS, Grid, LONGEST, companions, grid};
use super::Classified;
use super::features::{Shape, StrokeFeatures, shape, signed_area};
use super::region::Region;
use crate::Ink;

/// Most strokes, longest first, that can hold others.
const MOST_REGIONS: usize = 2000;
/// Distance beyond which an end is loose: one fifth of the diagonal.
const LOOSE: f64 = 0.2;
/// Distance within which an end touches a stroke: four line widths of a felt pen.
const TOUCH: f64 = 0.03;
/// In a drawing of fewer strokes, all of them describe the whole.
const ALL_TELL: usize = 512;

/// Returns how many strokes, from the first, describe the whole drawing: most length, longest strokes, body, ranks.
///
/// In a large drawing it grows by steps of a sixteenth to a thirty-second, so that most strokes that are added are
/// compared with what the strokes before them were compared with, and leave these as they are.
const fn telling(strokes: usize) -> usize {
    if strokes < ALL_TELL { strokes } else { strokes - strokes % (1 << (strokes.ilog2() - 4)) }
}

/// Measures every stroke of a drawing, on its own and among the others.
///
/// One row per stroke of `ink.strokes`, in its order; every number is finite. No feature depends on the
/// direction of a stroke, nor on left and right. About 50 microseconds a stroke in a sketch of 30, spread over
/// the executor's threads; linear in strokes beyond 48.
///
/// ```
/// use glam::DVec2;
/// let stem = vec![DVec2::ZERO, DVec2::new(0.0, 300.0)];
/// let ink = ink::clean(&ink::Drawing::from_polylines("stem", &[stem]), &mut base::Report::default());
/// let rows = ink::features(&ink, &base::Run::plain());
/// assert_eq!((rows.len(), rows[0].upright), (1, 1.0));
/// assert!((rows[0].gap - 1.0).abs() < 1e-9);
/// ```
pub fn features(ink: &Ink, run: &Run<'_>) -> Vec<StrokeFeatures> {
    features_again(ink, |_| true, &mut KeptMeasures::default(), run)
}

/// Measures the `wanted` strokes as [`features`] does; of the others, only what these depend on.
pub(super) fn features_again(
    ink: &Ink,
    wanted: impl Fn(usize) -> bool,
    kept: &mut KeptMeasures,
    run: &Run<'_>,
) -> Vec<StrokeFeatures> {
    let wanted: Vec<bool> = (0..ink.strokes.len()).map(wanted).collect();
    let scene = Scene::new(ink, &wanted, kept, run.executor);
    let rows = scene.rows(&wanted, kept, run);
    kept.keep(ink, scene, &rows);
    if run.cancel.check().is_err() {
        *kept = KeptMeasures::default();
    }
    rows.finished
}

/// Measurements of the strokes of a drawing, on their own and among the others, kept for the next evaluation: a stroke
/// that is added leaves most of the others as they are, unless it widens the drawing. Keeping them changes no result.
#[derive(Clone, Debug, Default)]
pub struct KeptMeasures {
    strokes: Arc<Vec<KeptStroke>>,
    whole: Whole,
    /// Features with which each stroke was last classified, and its class.
    pub(super) judged: Arc<Vec<(StrokeFeatures, Classified)>>,
    /// Measurements of each plant of several, by its first stroke.
    plants: LiteMap<usize, Self>,
}

/// A stroke as measured.
#[derive(Clone, Debug)]
struct KeptStroke {
    points: Arc<[DVec2]>,
    shape: Arc<Shape>,
    /// Features of the stroke alone.
    own: StrokeFeatures,
    companions: Arc<[usize]>,
    told: Told,
    /// Features among the others, without [`Scene::whole`]; `None` where they were not wanted.
    row: Option<StrokeFeatures>,
}

/// The whole drawing, with which a stroke is compared in addition to its companions.
#[derive(Clone, Debug, Default, PartialEq)]
struct Whole {
    size: DVec2,
    body: Body,
    /// See [`Scene::amid`]; `None` in a drawing of few strokes, where it differs from stroke to stroke.
    amid: Option<Region>,
    /// The longest strokes.
    longest: Vec<usize>,
    grid: Grid,
}

impl KeptMeasures {
    pub(super) fn measures_of_plant(&mut self, rows: &[usize]) -> &mut Self {
        self.plants.entry(rows.first().copied().unwrap_or_default()).or_default()
    }

    fn keep(&mut self, ink: &Ink, scene: Scene, rows: &Rows) {
        let (mut strokes, old) = (Vec::with_capacity(ink.strokes.len()), core::mem::take(&mut self.strokes));
        let columns = scene.shapes.into_iter().zip(scene.rows).zip(scene.companions);
        for (i, (((shape, own), companions), stroke)) in columns.zip(&ink.strokes).enumerate() {
            let points = match old.get(i).filter(|k| *k.points == *stroke.points) {
                Some(known) => Arc::clone(&known.points),
                None => stroke.points.as_slice().into(),
            };
            let (told, row) = (rows.told[i], rows.among[i]);
            strokes.push(KeptStroke { points, shape, own, companions, told, row });
        }
        (self.strokes, self.whole) = (Arc::new(strokes), scene.whole);
    }
}

/// Counts the other strokes with which each stroke is compared.
#[cfg(test)]
pub(super) fn companion_counts(ink: &Ink) -> Vec<usize> {
    let scene = Scene::new(ink, &vec![true; ink.strokes.len()], &KeptMeasures::default(), &base::Serial);
    scene.companions.iter().map(|c| c.len()).collect()
}

struct Scene {
    shapes: Vec<Arc<Shape>>,
    /// Whether each of them is unchanged since it was kept.
    same: Vec<bool>,
    rows: Vec<StrokeFeatures>,
    companions: Vec<Arc<[usize]>>,
    ink: f64,
    longest: f64,
    whole: Whole,
    /// Region inside the hull of all the other strokes, for each stroke that is wanted; in a drawing of very many
    /// strokes, that of all strokes.
    amid: Vec<Region>,
}

/// Rows of a scene.
struct Rows {
    /// Finished rows in the order of the strokes.
    finished: Vec<StrokeFeatures>,
    /// Rows without the features that are the same on every row; `None` for strokes that were not wanted.
    among: Vec<Option<StrokeFeatures>>,
    told: Vec<Told>,
}

/// The largest region that one stroke, or two whose ends meet, enclose.
#[derive(Clone, Debug, Default, PartialEq)]
struct Body {
    region: Region,
    members: [usize; 2],
    min: DVec2,
    max: DVec2,
    solid: f64,
}

/// Features of a stroke that the others and the whole drawing depend on.
#[derive(Clone, Copy, Debug)]
struct Told {
    corners: f64,
    gap: f64,
    /// How well another upright line runs parallel to it, 0 to 1.
    pair: f64,
    /// Number of strokes inside it.
    held: f64,
}

impl Told {
    /// Returns the features that other strokes depend on.
    fn to_others(self) -> [f64; 3] {
        [self.corners, self.gap, self.pair]
    }
}

/// The strokes nearest to the two ends.
struct Meeting {
    /// Distance and stroke at the lower end.
    low: (f64, usize),
    high: (f64, usize),
}

fn lower_end(s: &Shape) -> DVec2 {
    if s.first().y <= s.last().y { s.first() } else { s.last() }
}

fn upper_end(s: &Shape) -> DVec2 {
    if s.first().y <= s.last().y { s.last() } else { s.first() }
}

fn log1(x: f64) -> f64 {
    ops::ln(1.0 + x)
}

fn to_f64(n: usize) -> f64 {
    n as f64
}

fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// Returns the distance of `p` to the samples' polyline (segments) and the nearest sample; `reach` lets far boxes be
/// skipped.
fn distance_to(s: &Shape, p: DVec2, reach: f64) -> (f64, usize) {
    let outside = (s.min - p).max(p - s.max).max(DVec2::ZERO);
    if outside.length_squared() > reach * reach {
        return (f64::INFINITY, 0);
    }
    // Samples lie at even steps: a run of segments is skipped where its middle is too far for any of them.
    const RUN: usize = 12;
    let last = s.points.len().saturating_sub(1);
    let half_run = s.length / last.max(1) as f64 * (RUN / 2 + 1) as f64;
    let mut best = (f64::INFINITY, 0);
    for start in (0..last).step_by(RUN) {
        let end = (start + RUN).min(last);
        let bound = best.0.min(reach) + half_run;
        if s.points[usize::midpoint(start, end)].distance_squared(p) > bound * bound {
            continue;
        }
        for k in start..end {
            let (a, d) = (s.points[k], s.points[k + 1] - s.points[k]);
            let t = share((p - a).dot(d), d.length_squared()).clamp(0.0, 1.0);
            let here = (a + d * t).distance(p);
            if here < best.0 {
                best = (here, k);
            }
        }
    }
    best
}

impl Scene {
    fn new(ink: &Ink, wanted: &[bool], kept: &KeptMeasures, executor: &dyn Executor) -> Self {
        let n = ink.strokes.len();
        let known = |i: usize| kept.strokes.get(i).filter(|k| *k.points == *ink.strokes[i].points);
        let known: Vec<Option<&KeptStroke>> = (0..n).map(known).collect();
        let fresh: Vec<usize> = (0..n).filter(|&i| known[i].is_none()).collect();
        let measured = map_indexed(executor, fresh.len(), |k| shape(&ink.strokes[fresh[k]].points));
        let mut measured = measured.into_iter().map(|(shape, own)| (Arc::new(shape), own));
        let all = known.iter().filter_map(|k| match k {
            Some(k) => Some((Arc::clone(&k.shape), k.own)),
            None => measured.next(),
        });
        let (mut shapes, rows): (Vec<Arc<Shape>>, Vec<StrokeFeatures>) = all.unzip();
        let m = telling(n);
        // If the strokes that describe the whole are unchanged, the kept description still holds.
        let as_before =
            n > COMPANIONS + 1 && telling(kept.strokes.len()) == m && known[..m].iter().all(Option::is_some);
        let order = if as_before { Vec::new() } else { by_length(&shapes[..m]) };
        enclose(&mut shapes, &order, m);
        let same = |(k, s): (&Option<&KeptStroke>, _)| k.is_some_and(|k| Arc::ptr_eq(&k.shape, s));
        let same: Vec<bool> = known.iter().zip(&shapes).map(same).collect();
        let low = shapes.iter().fold(DVec2::INFINITY, |a, s| a.min(s.min));
        let high = shapes.iter().fold(DVec2::NEG_INFINITY, |a, s| a.max(s.max));
        let size = if shapes.is_empty() { DVec2::ONE } else { (high - low).max(DVec2::splat(1e-6)) };
        let total = shapes[..m].iter().map(|s| s.length).sum();
        let longest = shapes[..m].iter().fold(0.0_f64, |a, s| a.max(s.length));
        let grid = if n > COMPANIONS + 1 { grid(&shapes) } else { Grid::new() };
        let (whole, amid) = if as_before {
            let whole = Whole { size, grid, ..kept.whole.clone() };
            let amid = whole.amid.iter().cloned().collect();
            (whole, amid)
        } else {
            let amid = amid(&shapes[..m], &wanted[..m]);
            let whole = Whole {
                size,
                body: body(&shapes, &order),
                amid: if n > COMPANIONS + 1 { amid.first().cloned() } else { None },
                longest: order.iter().copied().take(LONGEST).collect(),
                grid,
            };
            (whole, amid)
        };
        let companions = companions(&shapes, &same, &whole, kept);
        Self { shapes, same, rows, companions, ink: total, longest, whole, amid }
    }

    fn rows(&self, wanted: &[bool], kept: &KeptMeasures, run: &Run<'_>) -> Rows {
        let ranks = ranks(&self.shapes, telling(self.shapes.len()));
        // Strokes that are unchanged, as are all their companions.
        let settled = |i: usize| {
            let known = kept.strokes.get(i).filter(|k| self.same[i] && k.row.is_some())?;
            let same = Arc::ptr_eq(&known.companions, &self.companions[i]);
            (same && self.companions[i].iter().all(|&j| self.same[j])).then_some(known)
        };
        let settled: Vec<Option<&KeptStroke>> = (0..wanted.len()).map(settled).collect();
        let alone = map_indexed(run.executor, wanted.len(), |i| match settled[i] {
            Some(known) => (known.told, self.rows[i]),
            None => self.alone(i, ranks[i], wanted[i], run),
        });
        let (mut told, mut rows): (Vec<Told>, Vec<StrokeFeatures>) = alone.into_iter().unzip();
        let framed = {
            let (Whole { size, body, amid, .. }, was) = (&self.whole, &kept.whole);
            amid.is_some() && (size, body, amid) == (&was.size, &was.body, &was.amid)
        };
        let heard = |j: usize| {
            let was = kept.strokes.get(j).map(|k| k.told.to_others());
            was == Some(told[j].to_others())
        };
        let heard: Vec<bool> = (0..told.len()).map(heard).collect();
        let among = map_indexed(run.executor, rows.len(), |i| {
            let still = |_: &&KeptStroke| framed && self.companions[i].iter().all(|&j| heard[j]);
            if let Some(known) = settled[i].filter(still)
                && let Some(mut f) = known.row
            {
                self.place(i, ranks[i], &mut f);
                return (known.told.held, f);
            }
            let mut f =
                if settled[i].is_some() { self.alone(i, ranks[i], wanted[i], run).1 } else { rows[i] };
            if run.cancel.check().is_err() {
                return (0.0, f);
            }
            if wanted[i] {
                self.alike(i, &mut f);
                self.sides(i, &mut f);
                self.around(i, &told, &mut f);
                self.holding(i, &told, &mut f);
                self.meeting(i, &told, &mut f);
            }
            (self.held(i), f)
        });
        for ((told, row), (held, f)) in told.iter_mut().zip(&mut rows).zip(among) {
            (told.held, *row) = (held, f);
        }
        let among = rows.iter().zip(wanted).map(|(row, &wanted)| wanted.then_some(*row)).collect();
        self.whole(&told, &mut rows);
        Rows { finished: rows.into_iter().map(StrokeFeatures::tamed).collect(), among, told }
    }

    /// Measures a stroke without regard to the features of others.
    fn alone(&self, i: usize, rank: f64, wanted: bool, run: &Run<'_>) -> (Told, StrokeFeatures) {
        let mut f = self.rows[i];
        if run.cancel.check().is_err() {
            return (Told { corners: f.corners, gap: f.gap, pair: 0.0, held: 0.0 }, f);
        }
        self.place(i, rank, &mut f);
        let upright = f.upright > 0.6 && f.length > 0.2;
        let even = if upright || wanted { self.partner(i, &mut f) } else { 0.0 };
        let pair = if upright { even } else { 0.0 };
        (Told { corners: f.corners, gap: f.gap, pair, held: 0.0 }, f)
    }

    /// Measures size, place and order in the drawing.
    fn place(&self, i: usize, rank: f64, f: &mut StrokeFeatures) {
        let s = &self.shapes[i];
        let last = to_f64(telling(self.shapes.len()).saturating_sub(1));
        f.length = s.length;
        f.width = s.size().x / self.whole.size.x;
        f.height = s.size().y / self.whole.size.y;
        f.bottom = s.min.y / self.whole.size.y;
        f.ends_apart = (s.first().x - s.last().x).abs() / self.whole.size.x;
        f.order = share(to_f64(i), last).min(1.0);
        f.first = if i == 0 { 1.0 } else { 0.0 };
        f.rank = rank;
        f.of_longest = share(s.length, self.longest.max(s.length));
        f.of_ink = share(s.length, self.ink);
        let near = |k: Option<usize>| {
            k.and_then(|k| self.shapes.get(k))
                .map_or((-1.0, 0.0), |o| (o.round, share(o.length, o.length + s.length)))
        };
        (f.before_round, f.before_length) = near(i.checked_sub(1));
        (f.after_round, f.after_length) = near(i.checked_add(1));
    }

    /// Counts strokes of about its size and form.
    fn alike(&self, i: usize, f: &mut StrokeFeatures) {
        let s = &self.shapes[i];
        let same = |j: usize| {
            let o = &self.shapes[j];
            o.length < 1.6 * s.length && s.length < 1.6 * o.length && (o.round - s.round).abs() < 0.2
        };
        let count = to_f64(self.companions[i].iter().filter(|&&j| same(j)).count());
        f.alike = log1(count);
    }

    /// Measures how many strokes share its place.
    fn sides(&self, i: usize, f: &mut StrokeFeatures) {
        let s = &self.shapes[i];
        let margin = DVec2::splat(0.1);
        let mut company = 0.0;
        for &j in &*self.companions[i] {
            let o = &self.shapes[j];
            if o.min.cmpge(s.min - margin).all() && o.max.cmple(s.max + margin).all() {
                company += 1.0;
            }
        }
        f.company = share(company, to_f64(self.companions[i].len()));
    }

    /// Measures the most characteristic strokes above and below its middle.
    fn around(&self, i: usize, told: &[Told], f: &mut StrokeFeatures) {
        let s = &self.shapes[i];
        for &j in &*self.companions[i] {
            let o = &self.shapes[j];
            let wide = o.size().x / self.whole.size.x;
            if o.middle.y > s.middle.y {
                f.round_above = f.round_above.max(o.round);
                f.wide_above = f.wide_above.max(wide);
                f.corners_above = f.corners_above.max(told[j].corners);
                f.pair_above = f.pair_above.max(told[j].pair);
            } else {
                f.wide_below = f.wide_below.max(wide);
                f.pair_below = f.pair_below.max(told[j].pair);
            }
        }
    }

    /// Counts the strokes that it holds.
    fn held(&self, i: usize) -> f64 {
        let s = &self.shapes[i];
        let holds = |o: &Shape| o.length < s.length && part_inside(o, &s.region, s) > 0.7;
        let held = self.companions[i].iter().filter(|&&j| s.round > 0.1 && holds(&self.shapes[j]));
        to_f64(held.count())
    }

    /// Measures the strokes that hold it.
    fn holding(&self, i: usize, told: &[Told], f: &mut StrokeFeatures) {
        let s = &self.shapes[i];
        for &j in &*self.companions[i] {
            let o = &self.shapes[j];
            if o.hull_area > 0.02 * o.length * o.length && o.length > s.length {
                let held = part_inside(s, &o.hull_region, o);
                if held > f.in_hull + 0.05 {
                    f.in_hull = held;
                }
            }
            if o.round > 0.1 && o.area > 0.0 {
                let held = part_inside(s, &o.region, o);
                if held > f.inside + 0.05 {
                    f.inside = held;
                    f.inside_round = o.round;
                    f.inside_corners = told[j].corners;
                }
            }
        }
        f.is_body = if self.whole.body.members.contains(&i) { 1.0 } else { 0.0 };
        f.in_body = share_inside(s, &self.whole.body.region);
        f.amid = self.amid.get(i).or(self.amid.first()).map_or(0.0, |region| share_inside(s, region));
    }

    /// Measures how its ends meet other strokes, and theirs meet it.
    fn meeting(&self, i: usize, told: &[Told], f: &mut StrokeFeatures) {
        let s = &self.shapes[i];
        let (low, high) = (lower_end(s), upper_end(s));
        let mut best = Meeting { low: (LOOSE, usize::MAX), high: (LOOSE, usize::MAX) };
        let (mut at_low, mut at_high) = (0, 0);
        let (mut guests, mut stems) = (0.0, 0.0);
        for &j in &*self.companions[i] {
            let o = &self.shapes[j];
            let d = distance_to(o, low, best.low.0.max(TOUCH));
            let at_one = d.0 < TOUCH;
            if d.0 < best.low.0 {
                (best.low, at_low) = ((d.0, j), d.1);
            }
            let d = distance_to(o, high, best.high.0.max(TOUCH));
            let at_other = d.0 < TOUCH;
            if d.0 < best.high.0 {
                (best.high, at_high) = ((d.0, j), d.1);
            }
            if at_one && at_other {
                f.both_same = 1.0;
            }
            for end in [o.first(), o.last()] {
                if distance_to(s, end, TOUCH).0 < TOUCH {
                    guests += 1.0;
                    let below = end.y < (s.min.y + s.max.y) / 2.0;
                    if below && !o.encloses() && end == upper_end(o) {
                        stems += 1.0;
                    }
                }
            }
        }
        f.low_gap = best.low.0 / LOOSE;
        f.high_gap = best.high.0 / LOOSE;
        let host = |j: usize| {
            self.shapes.get(j).map_or((-0.5, 0.0), |o| (o.round, share(o.length, o.length + s.length)))
        };
        (f.low_round, f.low_length) = host(best.low.1);
        (f.high_round, f.high_length) = host(best.high.1);
        if let Some(o) = self.shapes.get(best.low.1) {
            let along = to_f64(at_low) / to_f64(o.points.len().max(2) - 1);
            f.low_where = 2.0 * along.min(1.0 - along);
        }
        let (near, at) =
            if best.low.0 <= best.high.0 { (best.low.1, at_low) } else { (best.high.1, at_high) };
        if let Some((m, o)) = told.get(near).zip(self.shapes.get(near)) {
            f.near_gap = m.gap;
            let last = o.points.len() - 1;
            let along = (o.points[(at + 4).min(last)] - o.points[at.saturating_sub(4)]).normalize_or_zero();
            f.near_along = (s.last() - s.first()).normalize_or_zero().dot(along).abs();
        }
        let touching = |d: f64| if d < TOUCH { 0.5 } else { 0.0 };
        f.ends_touch = touching(best.low.0) + touching(best.high.0);
        f.stems = log1(stems);
        f.guests = log1(guests);
    }

    /// Returns how well another stroke runs parallel to it at an even distance, 0 to 1: the other side of a trunk.
    fn partner(&self, i: usize, f: &mut StrokeFeatures) -> f64 {
        const STATIONS: usize = 8;
        let s = &self.shapes[i];
        let mut best = 0.0;
        if s.points.len() < STATIONS {
            return best;
        }
        let station = |o: &Shape, k: usize| o.points[k * (o.points.len() - 1) / (STATIONS - 1)];
        for &j in &*self.companions[i] {
            let o = &self.shapes[j];
            if o.length < 0.5 * s.length || s.length < 0.5 * o.length {
                continue;
            }
            for turned in [false, true] {
                let mut offsets = [DVec2::ZERO; STATIONS];
                for (k, d) in offsets.iter_mut().enumerate() {
                    *d = station(o, if turned { STATIONS - 1 - k } else { k }) - station(s, k);
                }
                let mean = offsets.iter().sum::<DVec2>() / to_f64(STATIONS);
                let spread = (offsets.iter().map(|d| (*d - mean).length_squared()).sum::<f64>()
                    / to_f64(STATIONS))
                .sqrt();
                // Lies next to it, not in its prolongation: the part of the offset across the chord.
                let chord = (s.last() - s.first()).normalize_or_zero();
                let beside = mean.perp_dot(chord).abs();
                let even = (1.0 - 4.0 * spread / s.length).max(0.0)
                    * (1.0 - 2.0 * (mean.dot(chord)).abs() / s.length).max(0.0)
                    * (1.0 - beside / s.length).max(0.0);
                if even > best {
                    best = even;
                    f.partner_gap = beside / s.length;
                }
            }
        }
        best
    }

    /// Computes statistics of the whole drawing, the same on every row.
    fn whole(&self, told: &[Told], all: &mut [StrokeFeatures]) {
        if all.is_empty() {
            return;
        }
        let telling = telling(all.len());
        let (rows, told, shapes) = (&all[..telling], &told[..telling], &self.shapes[..telling]);
        let n = to_f64(telling);
        let box_area = self.whole.size.x * self.whole.size.y;
        let mean = |g: &dyn Fn(&StrokeFeatures) -> f64| rows.iter().map(g).sum::<f64>() / n;
        let most = |g: &dyn Fn(&StrokeFeatures) -> f64| rows.iter().map(g).fold(0.0_f64, f64::max);
        let body_size = self.whole.body.max - self.whole.body.min;
        // The lowest of the strokes that span a fifth of the drawing: the pot, if there is one.
        let base = rows
            .iter()
            .filter(|f| f.width > 0.2)
            .min_by(|a, b| a.bottom.total_cmp(&b.bottom))
            .copied()
            .unwrap_or_default();
        let d = StrokeFeatures {
            d_strokes: ops::ln(n) / 4.0,
            d_tall: self.whole.size.y / (self.whole.size.x + self.whole.size.y),
            d_ink: log1(self.ink),
            d_round: to_f64(shapes.iter().filter(|s| s.encloses()).count()) / n,
            d_largest: shapes.iter().fold(0.0_f64, |a, s| a.max(s.area)) / box_area,
            d_short: mean(&|f| if f.length < 0.1 { 1.0 } else { 0.0 }),
            d_pair: told.iter().fold(0.0_f64, |a, t| a.max(t.pair)),
            d_foot: self.band(0.0, 0.2),
            d_corners: most(&|f| f.corners),
            d_holds: log1(told.iter().fold(0.0_f64, |a, t| a.max(t.held))),
            d_base_round: base.round,
            d_base_opening: base.opening,
            d_body_area: share(body_size.x * body_size.y, box_area),
            d_body_solid: self.whole.body.solid,
            d_body_bottom: self.whole.body.min.y / self.whole.size.y,
            ..StrokeFeatures::default()
        };
        for f in all {
            f.d_strokes = d.d_strokes;
            f.d_tall = d.d_tall;
            f.d_ink = d.d_ink;
            f.d_round = d.d_round;
            f.d_largest = d.d_largest;
            f.d_short = d.d_short;
            f.d_pair = d.d_pair;
            f.d_foot = d.d_foot;
            f.d_corners = d.d_corners;
            f.d_holds = d.d_holds;
            f.d_base_round = d.d_base_round;
            f.d_base_opening = d.d_base_opening;
            f.d_body_area = d.d_body_area;
            f.d_body_solid = d.d_body_solid;
            f.d_body_bottom = d.d_body_bottom;
        }
    }

    /// Returns the width of the ink between two shares of the drawing's height, over the drawing's width.
    fn band(&self, low: f64, high: f64) -> f64 {
        let (a, b) = self.shapes[..telling(self.shapes.len())]
            .iter()
            .flat_map(|s| &s.points)
            .filter(|p| p.y >= low * self.whole.size.y && p.y <= high * self.whole.size.y)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.x), b.max(p.x)));
        (b - a).max(0.0) / self.whole.size.x
    }
}

/// Computes [`Scene::amid`].
fn amid(shapes: &[Arc<Shape>], wanted: &[bool]) -> Vec<Region> {
    let both = |a: &[DVec2], b: &[DVec2]| convex_hull(&[a, b].concat());
    if shapes.len() > COMPANIONS + 1 {
        let all: Vec<DVec2> = shapes.iter().flat_map(|s| s.hull.iter().copied()).collect();
        return vec![Region::new(&convex_hull(&all))];
    }
    let mut regions = vec![Region::default(); shapes.len()];
    let is_wanted = |w: &bool| *w;
    let Some((first, last)) = wanted.iter().position(is_wanted).zip(wanted.iter().rposition(is_wanted))
    else {
        return regions;
    };
    // Hulls of the strokes after each, then of those before it.
    let mut after = vec![Vec::new(); shapes.len() + 1];
    for i in (first + 1..shapes.len()).rev() {
        after[i] = both(&after[i + 1], &shapes[i].hull);
    }
    let mut before = Vec::new();
    for i in 0..=last {
        if wanted[i] {
            regions[i] = Region::new(&both(&before, &after[i + 1]));
        }
        before = both(&before, &shapes[i].hull);
    }
    regions
}

/// Computes the regions that the shapes enclose: for the longest ones only, and for those that came after all that
/// describe the whole, so that very many strokes fit into memory.
fn enclose(shapes: &mut [Arc<Shape>], order: &[usize], telling: usize) {
    let later = (telling..shapes.len()).map(|i| (i - telling, i));
    for (rank, i) in order.iter().copied().enumerate().chain(later) {
        let wanted = rank < MOST_REGIONS;
        if let Some(s) = shapes.get_mut(i).filter(|s| s.enclosed != wanted) {
            Arc::make_mut(s).enclose(wanted);
        }
    }
}

/// Returns the numbers of the strokes, longest first.
fn by_length(shapes: &[Arc<Shape>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..shapes.len()).collect();
    base::sort_by(&mut order, |&a, &b| shapes[b].length.total_cmp(&shapes[a].length).then(a.cmp(&b)));
    order
}

/// Finds the body of a drawing: see [`Body`].
fn body(shapes: &[Arc<Shape>], order: &[usize]) -> Body {
    // Largest distance between joined ends: a seventh of the drawing's diagonal.
    const JOIN: f64 = 0.15;
    let big = &order[..order.len().min(6)];
    let mut best = (0.0, Body::default());
    let mut offer = |outline: Vec<DVec2>, members: [usize; 2]| {
        let area = signed_area(&outline).abs();
        if area > 1.1 * best.0 {
            let hull = convex_hull(&outline);
            let min = outline.iter().fold(DVec2::INFINITY, |a, &p| a.min(p));
            let max = outline.iter().fold(DVec2::NEG_INFINITY, |a, &p| a.max(p));
            let solid = share(area, signed_area(&hull).abs());
            best = (area, Body { region: Region::new(&outline), members, min, max, solid });
        }
    };
    for &a in big {
        if shapes[a].encloses() {
            offer(shapes[a].points.iter().copied().step_by(2).collect(), [a, a]);
        }
    }
    for (k, &a) in big.iter().enumerate() {
        for &b in &big[k + 1..] {
            let (s, o) = (&shapes[a], &shapes[b]);
            for turned in [false, true] {
                let (from, to) = if turned { (o.first(), o.last()) } else { (o.last(), o.first()) };
                if s.last().distance(to) < JOIN && s.first().distance(from) < JOIN {
                    let mut outline: Vec<DVec2> = s.points.iter().copied().step_by(4).collect();
                    let other = o.points.iter().copied().step_by(4);
                    if turned {
                        outline.extend(other.rev())
                    } else {
                        outline.extend(other)
                    }
                    offer(outline, [a, b]);
                }
            }
        }
    }
    best.1
}

/// Returns the share of `s` inside a polygon.
fn share_inside(s: &Shape, region: &Region) -> f64 {
    const EVERY: usize = 6;
    let inside = s.points.iter().skip(EVERY / 2).step_by(EVERY).filter(|&&p| region.contains(p)).count();
    to_f64(inside) / to_f64(s.points.len().saturating_sub(EVERY / 2).div_ceil(EVERY).max(1))
}

/// Returns the share of `s` inside `region`, whose box is that of `o`.
fn part_inside(s: &Shape, region: &Region, o: &Shape) -> f64 {
    if s.min.cmpgt(o.max).any() || s.max.cmplt(o.min).any() {
        return 0.0;
    }
    const EVERY: usize = 8;
    let in_box = |p: DVec2| p.cmpge(o.min).all() && p.cmple(o.max).all();
    let inside = |&&p: &&DVec2| in_box(p) && region.contains(p);
    let count = s.points.iter().skip(EVERY / 2).step_by(EVERY).filter(inside).count();
    to_f64(count) / to_f64(s.points.len().saturating_sub(EVERY / 2).div_ceil(EVERY).max(1))
}

/// Returns for each stroke the share of the first `telling` strokes that are shorter.
fn ranks(shapes: &[Arc<Shape>], telling: usize) -> Vec<f64> {
    let mut sorted: Vec<f64> = shapes[..telling].iter().map(|s| s.length).collect();
    base::sort_numbers(&mut sorted);
    let others = to_f64(telling.saturating_sub(1));
    let shorter = |l: f64| share(to_f64(sorted.partition_point(|&other| other < l)), others).min(1.0);
    shapes.iter().map(|s| shorter(s.length)).collect()
}
