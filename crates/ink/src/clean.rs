//! He and Cheng (2021), section 3: the pen's samples to clean strokes of even step in ink coordinates.
//!
//! `Drawing -> Ink`

use std::sync::{Arc, OnceLock};

use base::{CancelToken, Report, Run, ops};
use geom::polyline_length;
use glam::DVec2;

use crate::again::drawn_again;
use crate::subjects::subjects;
use crate::{Drawing, StrokeMode, Subjects};

/// Even step of resampled strokes, as a share of the drawing's diagonal: the line width of a felt pen on a sheet.
pub(crate) const STEP: f64 = 0.005;
/// Least steps of a resampled stroke, so that small leaves keep their form.
const MIN_STEPS: f64 = 16.0;
/// Most points that all strokes together are resampled to (in addition to `MIN_STEPS` of each): bounds memory.
const MAX_POINTS: f64 = 400_000.0;
/// Half window m of Eq 1, in steps: 3 steps reach past the jitter of a mouse, not past a petal's tip.
const HALF_WINDOW: usize = 3;
/// Cosine of the sharpest turn that is smoothed: 60 degrees; sharper corners are kept.
const CORNER_COS: f64 = 0.5;
/// Largest coordinate: beyond it a difference of two coordinates could overflow.
const LARGEST: f64 = 1e304;
/// A sample this many times farther from the middle than nine tenths of all samples is a stray.
const STRAY: f64 = 1000.0;
/// Most warnings of one kind that are reported one by one.
const TOLD: usize = 20;

/// Map from the drawing to ink coordinates: `ink = (drawing - origin) * scale`.
///
/// ```
/// use glam::DVec2;
/// let map = ink::InkMap { origin: DVec2::new(10.0, 0.0), scale: 0.5 };
/// assert_eq!(map.to_ink(DVec2::new(12.0, 4.0)), DVec2::new(1.0, 2.0));
/// assert_eq!(map.to_drawing(DVec2::new(1.0, 2.0)), DVec2::new(12.0, 4.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InkMap {
    /// The drawing's lower left corner, in the drawing's unit.
    pub origin: DVec2,
    /// One over the drawing's diagonal, above 0.
    pub scale: f64,
}

impl InkMap {
    /// Maps a point from the drawing's coordinates to ink coordinates.
    pub fn to_ink(&self, p: DVec2) -> DVec2 {
        (p - self.origin) * self.scale
    }

    /// Maps a point from ink coordinates to the drawing's.
    pub fn to_drawing(&self, p: DVec2) -> DVec2 {
        p / self.scale + self.origin
    }
}

impl Default for InkMap {
    fn default() -> Self {
        Self { origin: DVec2::ZERO, scale: 1.0 }
    }
}

/// One clean stroke, ink coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InkStroke {
    /// Its index in the drawing.
    pub index: u32,
    /// At least 2 finite points, none repeated: even steps of [`InkStroke::step`], smoothed by Eq 1, both ends and
    /// corners above 60 degrees kept.
    pub points: Vec<DVec2>,
    /// The pen's samples, normalised but neither resampled nor smoothed; at least 2.
    pub raw: Vec<DVec2>,
    /// Milliseconds at each point of `raw`, if the file had them for every one.
    pub times_ms: Option<Vec<f64>>,
    /// Mean pen pressure 0 to 1, if known.
    pub pressure: Option<f64>,
    /// The mode that it was drawn in.
    pub mode: StrokeMode,
    /// Its colour as sRGB, if the file has one.
    pub color: Option<[u8; 3]>,
    /// Width of its pen, ink units, if the file has one.
    pub width: Option<f64>,
    /// Length of `points`, above 0.
    pub length: f64,
    /// Distance of neighbouring points before smoothing.
    pub step: f64,
    pub(crate) found: Arc<Found>,
}

/// Facts about the points of a stroke, found when first asked for. They follow from the points, so two strokes are
/// equal whatever is already known of them.
#[derive(Debug, Default)]
pub(crate) struct Found {
    hull: OnceLock<Vec<DVec2>>,
    outline: OnceLock<Option<Vec<DVec2>>>,
}

impl PartialEq for Found {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl InkStroke {
    /// Returns the convex hull of its points ([`geom::convex_hull`]), computed once.
    pub fn hull(&self) -> &[DVec2] {
        self.found.hull.get_or_init(|| geom::convex_hull(&self.points))
    }

    /// Returns its points as a closed outline ([`geom::simple_outline`]), if they form one, computed once.
    pub fn outline(&self) -> Option<&[DVec2]> {
        self.found.outline.get_or_init(|| geom::simple_outline(&self.points)).as_deref()
    }
}

/// A clean drawing: y up, its bounding box has diagonal 1 and its lower left corner at the origin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ink {
    /// The strokes that can be used, in the drawing's order.
    pub strokes: Vec<InkStroke>,
    /// Indices of the drawing's strokes that cannot be used (one point, no length, no finite sample), ascending.
    pub skipped: Vec<u32>,
    /// Map from the drawing's coordinates to ink coordinates.
    pub map: InkMap,
    /// Which strokes are of one plant.
    pub subjects: Subjects,
}

impl Ink {
    /// Returns the width of the pen in which most of the drawing was drawn, ink units: the median over its strokes.
    /// 0 where no stroke has one.
    pub fn pen_width(&self) -> f64 {
        let mut widths: Vec<f64> = self.strokes.iter().filter_map(|s| s.width).collect();
        base::sort_numbers(&mut widths);
        widths.get(widths.len() / 2).copied().unwrap_or_default()
    }

    /// Returns other lines on the same sheet as if they were the whole drawing, each with the colour of its stroke:
    /// parts of strokes, or outlines that several strokes make together. `lines`: points in ink coordinates and the row
    /// of a stroke.
    ///
    /// Their indices are their places in `lines`. Lines of rows that do not exist have no colour.
    pub fn with_lines(&self, lines: &[(Vec<DVec2>, usize)]) -> Self {
        let stroke = |(index, (points, row)): (u32, &(Vec<DVec2>, usize))| InkStroke {
            index,
            raw: points.clone(),
            color: self.strokes.get(*row).and_then(|s| s.color),
            width: self.strokes.get(*row).and_then(|s| s.width),
            ..InkStroke::default()
        };
        let strokes: Vec<InkStroke> = (0_u32..).zip(lines).map(stroke).collect();
        let rows: Vec<usize> = (0..strokes.len()).collect();
        Self { strokes, map: self.map, ..Self::default() }.part(&rows)
    }

    /// Returns some of the strokes, by their rows, as if they were the whole drawing: their box has diagonal 1.
    ///
    /// They keep their indices. Rows that do not exist are left out; where the strokes have no extent, the result is
    /// empty.
    pub fn part(&self, rows: &[usize]) -> Self {
        let chosen: Vec<&InkStroke> = rows.iter().filter_map(|&k| self.strokes.get(k)).collect();
        let points = chosen.iter().flat_map(|s| &s.raw);
        let (lo, hi) =
            points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
        let scale = 1.0 / ops::hypot(hi.x - lo.x, hi.y - lo.y);
        if !(lo.is_finite() && scale.is_finite() && scale > 0.0) {
            return Self::default();
        }
        let to_part = InkMap { origin: lo, scale };
        let map = InkMap { origin: self.map.to_drawing(lo), scale: self.map.scale * scale };
        let mut strokes: Vec<InkStroke> = chosen
            .into_iter()
            .map(|s| InkStroke {
                index: s.index,
                raw: s.raw.iter().map(|&p| to_part.to_ink(p)).collect(),
                times_ms: s.times_ms.clone(),
                pressure: s.pressure,
                mode: s.mode,
                color: s.color,
                width: s.width.map(|w| w * scale),
                ..InkStroke::default()
            })
            .collect();
        even(&mut strokes, &[], Run::plain().cancel);
        let plants = vec![(0..strokes.len()).collect()];
        Self { strokes, map, subjects: Subjects { plants, ..Subjects::default() }, ..Self::default() }
    }
}

/// Cleans a drawing: He and Cheng (2021), section 3, Eq 1.
///
/// Guaranteed: every coordinate is finite and within \[0, 1\]; the number of points is bounded by 400,000 plus
/// 18 for each stroke. Samples that are not finite, strays that blow the box up a thousandfold and strokes
/// without length are left out with a warning that names the stroke; hidden strokes without one. Linear in samples.
///
/// ```
/// use glam::DVec2;
/// let drawing = ink::Drawing::from_polylines("stem", &[vec![DVec2::ZERO, DVec2::new(0.0, 300.0)]]);
/// let ink = ink::clean(&drawing, &mut base::Report::default());
/// assert_eq!((ink.strokes.len(), ink.strokes[0].points.len()), (1, 201));
/// assert!((ink.strokes[0].length - 1.0).abs() < 1e-12);
/// ```
pub fn clean(drawing: &Drawing, report: &mut Report) -> Ink {
    clean_again(drawing, None, &Run::plain(), report)
}

/// Cleans a drawing that changed a little as [`clean`] does: unchanged strokes in an unchanged box are taken over from
/// the previous ink, which gives the same result. A cancelled run ends soon, with meaningless ink.
pub fn clean_again(drawing: &Drawing, before: Option<&Ink>, run: &Run<'_>, report: &mut Report) -> Ink {
    let mut notes = Notes::default();
    let usable = usable_samples(drawing, &mut notes);
    let map = ink_map(drawing, &usable);
    let mut ink = Ink { map: map.unwrap_or_default(), ..Ink::default() };
    for (index, (stroke, kept)) in (0_u32..).zip(drawing.strokes.iter().zip(&usable)) {
        let raw: Vec<DVec2> = if map.is_some() {
            kept.iter().map(|&k| ink.map.to_ink(stroke.samples[k].at)).collect()
        } else {
            Vec::new()
        };
        if run.cancel.check().is_err() {
            return ink;
        }
        if stroke.hidden {
            continue;
        }
        let length = polyline_length(&raw);
        if length < 1e-9 {
            notes.skipped.push((index, raw.len()));
            ink.skipped.push(index);
            continue;
        }
        let times: Option<Vec<f64>> =
            kept.iter().map(|&k| stroke.samples[k].time_ms.filter(|t| t.is_finite())).collect();
        ink.strokes.push(InkStroke {
            index,
            raw,
            times_ms: times,
            pressure: mean_pressure(kept.iter().filter_map(|&k| stroke.samples[k].pressure)),
            mode: stroke.mode,
            color: stroke.color,
            width: stroke.width.map(|w| w * ink.map.scale),
            length,
            ..InkStroke::default()
        });
    }
    even(&mut ink.strokes, before.map_or(&[], |b| &b.strokes), run.cancel);
    let lines: Vec<(&[DVec2], f64)> = ink.strokes.iter().map(|s| (&*s.points, s.length)).collect();
    let alike = |a: usize, b: usize| {
        let (a, b) = (&ink.strokes[a], &ink.strokes[b]);
        a.mode == b.mode && a.color == b.color
    };
    let again = drawn_again(&lines, alike, run.cancel);
    if run.cancel.check().is_err() {
        return ink;
    }
    ink.subjects = subjects(&lines).without(again);
    notes.tell(report);
    if ink.strokes.is_empty() {
        report.warn("empty-drawing", "the drawing has no stroke that can be used: draw a line or an outline");
    }
    ink
}

/// Resamples and smooths strokes whose `raw` is known. `before`: the previous strokes, some of them the same.
fn even(strokes: &mut [InkStroke], before: &[InkStroke], cancel: &CancelToken) {
    for stroke in strokes.iter_mut() {
        stroke.length = polyline_length(&stroke.raw);
    }
    let total: f64 = strokes.iter().map(|s| s.length).sum();
    let step = STEP.max(total / MAX_POINTS);
    for stroke in strokes {
        if cancel.check().is_err() {
            return;
        }
        stroke.step = step.min(stroke.length / MIN_STEPS);
        let at = before.binary_search_by_key(&stroke.index, |s| s.index);
        let known = at.ok().map(|at| &before[at]);
        if let Some(known) = known.filter(|k| k.step == stroke.step && k.raw == stroke.raw) {
            (stroke.points, stroke.length) = (known.points.clone(), known.length);
            stroke.found = Arc::clone(&known.found);
            continue;
        }
        stroke.points = smooth(&resample(&stroke.raw, stroke.length, stroke.step), stroke.step);
        stroke.length = polyline_length(&stroke.points);
    }
}

/// Returns for each stroke the numbers of usable samples: finite, and not strays.
fn usable_samples(drawing: &Drawing, notes: &mut Notes) -> Vec<Vec<usize>> {
    let finite = |p: DVec2| p.x.abs() <= LARGEST && p.y.abs() <= LARGEST;
    let mut kept: Vec<Vec<usize>> = Vec::with_capacity(drawing.strokes.len());
    for (index, stroke) in (0_u32..).zip(&drawing.strokes) {
        if stroke.hidden {
            kept.push(Vec::new());
            continue;
        }
        let good: Vec<usize> = (0..stroke.samples.len()).filter(|&k| finite(stroke.samples[k].at)).collect();
        if good.len() < stroke.samples.len() {
            notes.broken.push((index, stroke.samples.len() - good.len()));
        }
        kept.push(good);
    }
    if no_strays(drawing, &kept) {
        return kept;
    }
    let places = || kept.iter().zip(&drawing.strokes).flat_map(|(k, s)| k.iter().map(|&i| s.samples[i].at));
    let mut xs: Vec<f64> = places().map(|p| p.x).collect();
    let mut ys: Vec<f64> = places().map(|p| p.y).collect();
    if xs.len() < 5 {
        return kept;
    }
    let middle = DVec2::new(quantile(&mut xs, 0.5), quantile(&mut ys, 0.5));
    // Takes the larger of both coordinates: squares could overflow, and a stray is far beyond any rounding.
    let far = |p: DVec2| (p - middle).abs().max_element();
    let mut distances: Vec<f64> = places().map(far).collect();
    let limit = quantile(&mut distances, 0.9) * STRAY;
    if limit > 0.0 {
        for (index, (k, stroke)) in (0_u32..).zip(kept.iter_mut().zip(&drawing.strokes)) {
            let before = k.len();
            k.retain(|&i| far(stroke.samples[i].at) <= limit);
            if k.len() < before {
                notes.strays.push((index, before - k.len()));
            }
        }
    }
    kept
}

/// Whether no sample can be a stray, without a sort: a tenth of all lie in the first third and a tenth in the last
/// third of the width, or of the height. On whichever side the middle lies, nine tenths are then not near it.
fn no_strays(drawing: &Drawing, kept: &[Vec<usize>]) -> bool {
    let places = || kept.iter().zip(&drawing.strokes).flat_map(|(k, s)| k.iter().map(|&i| s.samples[i].at));
    let (mut lo, mut hi, mut all) = (DVec2::INFINITY, DVec2::NEG_INFINITY, 0_usize);
    for p in places() {
        (lo, hi, all) = (lo.min(p), hi.max(p), all + 1);
    }
    let third = hi / 3.0 - lo / 3.0;
    let (mut low, mut high) = ([0_usize; 2], [0_usize; 2]);
    for p in places() {
        for (axis, (count, other)) in low.iter_mut().zip(&mut high).enumerate() {
            *count += usize::from(p[axis] < lo[axis] + third[axis]);
            *other += usize::from(p[axis] > hi[axis] - third[axis]);
        }
    }
    // Slightly more than the tenth beyond the quantile of nine tenths.
    let enough = all / 10 + 3;
    let wide = |axis: usize| third[axis] > 0.1 * third.max_element();
    (0..2).any(|axis| wide(axis) && low[axis] >= enough && high[axis] >= enough)
}

/// Returns the map that puts the lower left corner at the origin and makes the diagonal 1; `None` without an extent.
fn ink_map(drawing: &Drawing, kept: &[Vec<usize>]) -> Option<InkMap> {
    let mut lo = DVec2::INFINITY;
    let mut hi = DVec2::NEG_INFINITY;
    for (stroke, numbers) in drawing.strokes.iter().zip(kept) {
        for &k in numbers {
            lo = lo.min(stroke.samples[k].at);
            hi = hi.max(stroke.samples[k].at);
        }
    }
    let scale = 1.0 / ops::hypot(hi.x - lo.x, hi.y - lo.y);
    (lo.is_finite() && scale.is_finite() && scale > 0.0).then_some(InkMap { origin: lo, scale })
}

fn mean_pressure(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, n) =
        values.filter(|v| v.is_finite()).fold((0.0, 0.0), |(s, n), v| (s + v.clamp(0.0, 1.0), n + 1.0));
    (n > 0.0).then(|| sum / n)
}

/// Returns the quantile `q` of the values. `values` is not empty.
fn quantile(values: &mut [f64], q: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "q is within 0 and 1")]
    #[expect(clippy::cast_precision_loss, reason = "a rank need not be exact beyond 2^53 samples")]
    let rank = ((values.len() - 1) as f64 * q) as usize;
    base::sort_numbers(values);
    values[rank]
}

/// Takes even steps of at most `step` along a polyline of length `length`, both ends kept.
fn resample(raw: &[DVec2], length: f64, step: f64) -> Vec<DVec2> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded by MAX_POINTS")]
    let steps = (length / step - 1e-6).ceil().clamp(1.0, MAX_POINTS) as usize;
    let even = length / f64::from(u32::try_from(steps).unwrap_or(u32::MAX));
    let mut points = Vec::with_capacity(steps + 1);
    points.push(raw[0]);
    let (mut gone, mut next) = (0.0, even);
    for w in raw.windows(2) {
        let d = w[0].distance(w[1]);
        while next <= gone + d && points.len() < steps {
            points.push(w[0].lerp(w[1], (next - gone) / d));
            next += even;
        }
        gone += d;
    }
    points.push(raw[raw.len() - 1]);
    points
}

/// Applies Eq 1 between the corners: the ends of the stroke and corners above 60 degrees stay in place.
fn smooth(points: &[DVec2], step: f64) -> Vec<DVec2> {
    // The weight falls to 1/e at two steps: c = (2 step)^2.
    let c = 4.0 * step * step;
    let mut out = points.to_vec();
    let corners = corners(points);
    for pair in corners.windows(2) {
        for i in pair[0] + 1..pair[1] {
            // The window is cut equally on both sides at a corner: a one-sided mean would shorten the line.
            let m = HALF_WINDOW.min(i - pair[0]).min(pair[1] - i);
            let (mut sum, mut weights) = (DVec2::ZERO, 0.0);
            for p in &points[i - m..=i + m] {
                let w = ops::exp(-p.distance_squared(points[i]) / c);
                sum += *p * w;
                weights += w;
            }
            out[i] = sum / weights;
        }
    }
    // Where the pen went back on its own line two neighbours may meet.
    out.dedup();
    out
}

/// Returns the first and last point and the sharpest point of every corner above 60 degrees, ascending.
fn corners(points: &[DVec2]) -> Vec<usize> {
    let last = points.len() - 1;
    let mut found = vec![0];
    let mut best: Option<(f64, usize)> = None;
    for i in 1..last {
        let k = HALF_WINDOW.min(i).min(last - i);
        let (a, b) = (points[i] - points[i - k], points[i + k] - points[i]);
        let cos = a.dot(b) / (a.length() * b.length()).max(1e-300);
        if cos < CORNER_COS {
            if best.is_none_or(|(c, _)| cos < c) {
                best = Some((cos, i));
            }
        } else if let Some((_, at)) = best.take() {
            found.push(at);
        }
    }
    found.extend(best.map(|(_, at)| at));
    found.push(last);
    found
}

/// Samples and strokes that cleaning left out, reported briefly however many they are.
#[derive(Debug, Default)]
struct Notes {
    broken: Vec<(u32, usize)>,
    strays: Vec<(u32, usize)>,
    skipped: Vec<(u32, usize)>,
}

impl Notes {
    fn tell(&self, report: &mut Report) {
        tell(report, "sample-skipped", &self.broken, |i, n| {
            format!("stroke {i}: {n} sample(s) are not usable numbers and were left out")
        });
        tell(report, "stray-skipped", &self.strays, |i, n| {
            format!(
                "stroke {i}: {n} sample(s) lie a thousand times farther out than the drawing and were left out"
            )
        });
        tell(report, "stroke-skipped", &self.skipped, |i, n| match n {
            0 => format!("stroke {i} has no usable point and was left out"),
            1 => format!("stroke {i} has one point and was left out"),
            _ => format!("stroke {i} has no length and was left out"),
        });
    }
}

fn tell(
    report: &mut Report,
    code: &'static str,
    notes: &[(u32, usize)],
    words: impl Fn(u32, usize) -> String,
) {
    for &(index, n) in notes.iter().take(TOLD) {
        report.warn_of(code, &[("stroke", &index), ("count", &n)], words(index, n));
    }
    if notes.len() > TOLD {
        base::warn!(
            report,
            "strokes-likewise",
            { count = notes.len() - TOLD },
            "and {count} more strokes likewise"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Stroke;
    use proptest::prelude::*;

    fn lines(lines: &[Vec<DVec2>]) -> Drawing {
        Drawing::from_polylines("test", lines)
    }

    fn codes(report: &Report) -> Vec<&'static str> {
        report.warnings.iter().map(|w| w.code).collect()
    }

    #[test]
    fn box_has_diagonal_one_at_the_origin() {
        let d = lines(&[
            vec![DVec2::new(5.0, 7.0), DVec2::new(8.0, 7.0)],
            vec![DVec2::new(8.0, 7.0), DVec2::new(8.0, 11.0)],
        ]);
        let ink = clean(&d, &mut Report::default());
        assert_eq!((ink.map.origin, ink.map.scale), (DVec2::new(5.0, 7.0), 0.2));
        assert_eq!(ink.strokes[0].points[0], DVec2::ZERO);
        assert!(
            ink.strokes[1].points.last().is_some_and(|p| p.distance(DVec2::new(0.6, 0.8)) < 1e-12),
            "far corner"
        );
    }

    #[test]
    fn empty_and_dots_give_an_empty_ink_and_warnings() {
        for d in [lines(&[]), lines(&[vec![]]), lines(&[vec![DVec2::ONE]]), lines(&[vec![DVec2::ONE; 7]])] {
            let mut report = Report::default();
            let ink = clean(&d, &mut report);
            assert!(ink.strokes.is_empty(), "nothing to draw: {d:?}");
            assert_eq!(ink.skipped.len(), d.strokes.len());
            assert!(codes(&report).contains(&"empty-drawing"), "{report:?}");
        }
    }

    #[test]
    fn nan_stray_and_dot_are_named_and_left_out() {
        let mut line: Vec<DVec2> = (0..20).map(|i| DVec2::new(f64::from(i), 0.0)).collect();
        line[3].y = f64::NAN;
        line[9] = DVec2::new(1e300, 0.0);
        let mut report = Report::default();
        let ink = clean(&lines(&[line, vec![DVec2::new(2.0, 2.0)], vec![DVec2::X, DVec2::Y]]), &mut report);
        assert_eq!(codes(&report), ["sample-skipped", "stray-skipped", "stroke-skipped"]);
        assert_eq!((ink.strokes.len(), ink.strokes[1].index, &ink.skipped[..]), (2, 2, &[1][..]));
        assert!(
            (ink.map.scale - 1.0 / ops::hypot(19.0, 2.0)).abs() < 1e-3,
            "the stray must not set the scale"
        );
    }

    #[test]
    fn a_drawing_at_1e300_is_as_good_as_any() {
        let d = lines(&[vec![DVec2::splat(-1e300), DVec2::new(1e300, 0.0), DVec2::splat(1e300)]]);
        let ink = clean(&d, &mut Report::default());
        assert!(
            (ink.strokes[0].raw[2] - DVec2::splat(0.5_f64.sqrt())).length() < 1e-12,
            "{:?}",
            ink.strokes[0].raw
        );
    }

    #[test]
    fn smoothing_removes_jitter_and_keeps_ends_and_corners() {
        let zigzag = |i: i32| DVec2::new(f64::from(i), if i % 2 == 0 { 0.25 } else { -0.25 });
        let mut line: Vec<DVec2> = (0..=100).map(zigzag).collect();
        line.extend((1..=100).map(|i| DVec2::new(100.0, 0.25 + f64::from(i))));
        let ink = clean(&lines(&[line]), &mut Report::default());
        let s = &ink.strokes[0];
        let roughness = |p: &[DVec2]| p.windows(3).map(|w| (w[0] + w[2] - 2.0 * w[1]).length()).sum::<f64>();
        let before = roughness(&resample(&s.raw, polyline_length(&s.raw), s.step));
        assert!(roughness(&s.points) < 0.5 * before, "{} of {before}", roughness(&s.points));
        assert_eq!((s.points[0], s.points[s.points.len() - 1]), (s.raw[0], s.raw[s.raw.len() - 1]));
        let corner = s.points.iter().map(|p| p.distance(s.raw[100])).fold(1.0, f64::min);
        assert!(corner < STEP, "corner moved by {corner}");
    }

    #[test]
    fn a_cancelled_run_cleans_nothing() {
        let drawing = lines(&[vec![DVec2::ZERO, DVec2::Y], vec![DVec2::X, DVec2::ONE]]);
        let cancel = CancelToken::new();
        let run = Run { cancel: &cancel, ..Run::plain() };
        let clean = || clean_again(&drawing, None, &run, &mut Report::default()).strokes.len();
        assert_eq!(clean(), 2);
        cancel.cancel();
        assert_eq!(clean(), 0);
    }

    #[test]
    fn a_hundred_thousand_strokes_stay_bounded() {
        let d = Drawing {
            name: String::new(),
            layers: Vec::new(),
            strokes: (0..100_000)
                .map(|i| {
                    let x = f64::from(i);
                    let samples = [DVec2::new(x, 0.0), DVec2::new(x, 1e5)].map(Into::into).to_vec();
                    Stroke { samples, ..Stroke::default() }
                })
                .collect(),
        };
        let ink = clean(&d, &mut Report::default());
        let points: usize = ink.strokes.iter().map(|s| s.points.len()).sum();
        assert!(ink.strokes.len() == 100_000 && points <= 400_000 + 1_800_000, "{points}");
    }

    proptest! {
        #[test]
        fn any_drawing_gives_clean_ink(strokes in strokes()) {
            let mut report = Report::default();
            let ink = clean(&lines(&strokes), &mut report);
            prop_assert_eq!(ink.strokes.len() + ink.skipped.len(), strokes.len());
            for s in &ink.strokes {
                prop_assert!(s.points.len() >= 2 && s.raw.len() >= 2 && s.length > 0.0, "{:?}", s);
                for p in s.points.iter().chain(&s.raw) {
                    prop_assert!(p.min_element() > -1e-9 && p.max_element() < 1.0 + 1e-9, "{}", p);
                }
                prop_assert!(s.points.windows(2).all(|w| w[0] != w[1]), "repeated point");
            }
        }
    }

    fn strokes() -> impl Strategy<Value = Vec<Vec<DVec2>>> {
        let value = prop_oneof![8 => -10.0..10.0, 1 => Just(f64::NAN), 1 => Just(1e300), 1 => Just(0.0), 1 => Just(1e-12)];
        let point = (value.clone(), value).prop_map(|(x, y)| DVec2::new(x, y));
        prop::collection::vec(prop::collection::vec(point, 0..12), 0..6)
    }
}
