//! Filled outlines of variable-width pens -> the line along which the pen moved.
//!
//! Outline -> its two ends -> its two sides, paired -> the middle between them and the width.

use base::LiteMap;
use glam::DVec2;

use super::{Change, Work, places};
use crate::InkSample;

impl Work {
    /// Replaces areas that are the stroke of a variable-width pen by its centre line.
    pub(super) fn take_pen_outlines(&mut self) {
        if self.figures.iter().all(|f| f.lined) {
            return;
        }
        self.split_pens_strokes();
        let lines: Vec<Vec<Vec<DVec2>>> =
            self.figures.iter().map(|f| f.lines.iter().map(|l| places(l)).collect()).collect();
        // Among opaque areas, translucent ones shade what they lie on.
        let opaque = self.figures.iter().any(|f| !is_translucent(f));
        let candidate = |(lines, f): (_, &super::Figure)| Candidate {
            lines,
            fill_only: !(f.lined || is_solid(f) || (opaque && is_translucent(f))),
            fill_said: f.fill.is_some_and(|f| f.said),
            color: f.fill.and_then(|f| f.color),
        };
        let candidates: Vec<Candidate<'_>> =
            lines.iter().map(Vec::as_slice).zip(&self.figures).map(candidate).collect();
        let found = centre_lines(&candidates, self.diagonal());
        let mut reduced = 0;
        for (figure, centre) in self.figures.iter_mut().zip(found) {
            let Some(centre) = centre else { continue };
            reduced += 1;
            let sample = |(at, pressure)| InkSample { at, time_ms: None, pressure: Some(pressure) };
            figure.lines = vec![centre.into_iter().map(sample).collect()];
            figure.like.color = figure.like.color.or(figure.fill.and_then(|f| f.color));
            (figure.lined, figure.fill) = (true, None);
        }
        self.note(Change::PenOutline, reduced);
    }
}

fn is_translucent(figure: &super::Figure) -> bool {
    figure.fill.is_some_and(|f| f.opacity < super::LIMITS.translucent)
}

impl Work {
    /// Splits areas whose sub-paths are strokes of a pen: programs merge them into one path when they expand lines.
    fn split_pens_strokes(&mut self) {
        let diagonal = self.diagonal();
        let mut figures: Vec<super::Figure> = Vec::with_capacity(self.figures.len());
        for figure in core::mem::take(&mut self.figures) {
            let many = (3..MOST_STROKES).contains(&figure.lines.len());
            let parts = (!figure.lined && figure.fill.is_some_and(|f| f.said) && many)
                .then(|| pens_strokes(&figure.lines, diagonal));
            let Some(parts) = parts.flatten() else {
                figures.push(figure);
                continue;
            };
            let mut lines = figure.lines.into_iter();
            for part in parts {
                let lines = lines.by_ref().take(part).collect();
                figures.push(super::Figure { lines, like: figure.like.clone(), ..figure });
            }
        }
        self.figures = figures;
    }
}

/// Returns how many successive sub-paths belong to each stroke of a pen: one, or two for a stroke that closes on
/// itself. `None` where they are not strokes of a pen.
fn pens_strokes(lines: &[Vec<InkSample>], diagonal: f64) -> Option<Vec<usize>> {
    let lines: Vec<Vec<DVec2>> = lines.iter().map(|l| places(l)).collect();
    let is_pen = |r: &Ribbon| r.width < SLENDER * r.length && r.width < WIDEST * diagonal;
    let mut parts = Vec::new();
    let (mut of_pens, mut all, mut k) = (0.0, 0.0, 0);
    while k < lines.len() {
        let closed = lines.get(k + 1).and_then(|inner| closed_ribbon(&lines[k], inner)).filter(is_pen);
        let count = if closed.is_some() { 2 } else { 1 };
        let around: f64 = lines[k..k + count].iter().map(|l| perimeter(l)).sum();
        all += around;
        if closed.is_some() || open_ribbon(&lines[k]).is_some_and(|r| is_pen(&r)) {
            of_pens += around;
        }
        parts.push(count);
        k += count;
    }
    (of_pens >= OF_PENS * all).then_some(parts)
}

/// Whether two sub-paths that run round in the same direction are painted as one area: programs that imitate a hand
/// draw it twice.
fn is_solid(figure: &super::Figure) -> bool {
    let turned = |line: &[InkSample]| geom::signed_area(&places(line)) > 0.0;
    match figure.lines.as_slice() {
        [a, b] => !figure.fill.is_some_and(|f| f.even_odd) && turned(a) == turned(b),
        _ => false,
    }
}

/// A shape's flattened sub-paths and how it is painted.
#[derive(Clone, Copy, Debug)]
struct Candidate<'a> {
    lines: &'a [Vec<DVec2>],
    /// Whether it is painted by its area alone.
    fill_only: bool,
    /// Whether the file asks for the fill.
    fill_said: bool,
    color: Option<[u8; 3]>,
}

/// A centre line: points with the width there.
type Centre = Vec<(DVec2, f64)>;

/// Mean width over length below which an area is a pen's stroke. A slender leaf (1 : 8) has 0.08 .. 0.09, a
/// pen's stroke of 2 % of the sheet over half of it 0.04.
const SLENDER: f64 = 0.07;
/// The same limit where the file does not even ask for the fill, as in files written by hand.
const SLENDER_UNSAID: f64 = 0.03;
/// A pen is no wider than this share of the drawing's diagonal.
const WIDEST: f64 = 0.06;
/// Least share of a pen's strokes among the outlines of a path that consists of them; the rest are dashes.
const OF_PENS: f64 = 0.85;
/// Most sub-paths of a path that is drawn; a path with more is traced.
const MOST_STROKES: usize = 1000;

/// Returns for each candidate the centre line with pressures (width over the greatest width), or `None` where the
/// outline itself is the stroke.
fn centre_lines(candidates: &[Candidate<'_>], diagonal: f64) -> Vec<Option<Vec<(DVec2, f64)>>> {
    let measured: Vec<Option<Ribbon>> = candidates.iter().map(measure).collect();
    let sure = |c: &Candidate<'_>, r: &Ribbon| {
        let most = if c.fill_said { SLENDER } else { SLENDER_UNSAID };
        r.width / r.length < most && r.width < WIDEST * diagonal
    };
    // Pens of the drawing by colour: petals among green stems are not dashes of the pen that drew these.
    let mut pens: LiteMap<Option<[u8; 3]>, Vec<f64>> = LiteMap::new();
    for (c, ribbon) in candidates.iter().zip(&measured) {
        if let Some(ribbon) = ribbon.as_ref().filter(|r| sure(c, r)) {
            pens.entry(c.color).or_default().push(ribbon.width);
        }
    }
    let pens: LiteMap<_, Option<f64>> =
        pens.into_iter().map(|(color, widths)| (color, base::median(widths))).collect();
    let pen_of = |c: &Candidate<'_>| pens.get(&c.color).copied().flatten();
    let mut found: Vec<Option<Centre>> = candidates
        .iter()
        .zip(measured)
        .map(|(c, r)| {
            let ribbon = r?;
            // Short dashes of the same pen are not slender, but as wide as its other strokes.
            let dash =
                pen_of(c).is_some_and(|pen| ribbon.width < 1.5 * pen && ribbon.width < 0.5 * ribbon.length);
            (sure(c, &ribbon) || (c.fill_said && dash)).then_some(ribbon.centre)
        })
        .collect();
    let widest = found.iter().flatten().flatten().map(|p| p.1).fold(0.0, f64::max);
    for (_, width) in found.iter_mut().flatten().flatten() {
        *width = if widest > 0.0 { (*width / widest).clamp(0.0, 1.0) } else { 1.0 };
    }
    found
}

struct Ribbon {
    centre: Centre,
    width: f64,
    length: f64,
}

fn measure(candidate: &Candidate<'_>) -> Option<Ribbon> {
    if !candidate.fill_only {
        return None;
    }
    match candidate.lines {
        [outline] => open_ribbon(outline),
        [a, b] => closed_ribbon(a, b),
        _ => None,
    }
}

fn perimeter(closed: &[DVec2]) -> f64 {
    closed.windows(2).map(|w| (w[1] - w[0]).length()).sum()
}

fn area(closed: &[DVec2]) -> f64 {
    let origin = closed.first().copied().unwrap_or_default();
    0.5 * closed.windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum::<f64>()
}

/// Returns area and perimeter of an outline as a ring, or `None` if it is open or has no size.
fn ring(line: &[DVec2]) -> Option<(f64, f64)> {
    let (first, last) = (line.first()?, line.last()?);
    let p = perimeter(line);
    if !(line.len() >= 5 && p.is_finite() && p > 0.0 && (*first - *last).length() <= 0.01 * p) {
        return None;
    }
    Some((p, area(line).abs()))
}

/// Returns `n` points at equal distances along a closed line.
fn resample(line: &[DVec2], perimeter: f64, n: usize) -> Vec<DVec2> {
    #[expect(clippy::cast_precision_loss, reason = "a few hundred points")]
    let step = perimeter / n as f64;
    let mut out = Vec::with_capacity(n);
    let (mut travelled, mut next) = (0.0, 0.0);
    for w in line.windows(2) {
        let length = (w[1] - w[0]).length();
        while next < travelled + length && out.len() < n {
            out.push(w[0].lerp(w[1], (next - travelled) / length));
            next += step;
        }
        travelled += length;
    }
    while out.len() < n {
        out.push(line.last().copied().unwrap_or_default());
    }
    out
}

/// Finds the centre line of a pen's stroke with two ends.
fn open_ribbon(line: &[DVec2]) -> Option<Ribbon> {
    let (p, a) = ring(line)?;
    // For a ribbon: area = width * length, perimeter = 2 * length.
    let width = 2.0 * a / p;
    // Far from a ribbon: skip the search. A circle has 1/4, a square 1/4, a 1 : 4 leaf 0.15.
    let slender = width > 0.0 && width / (0.5 * p) < 0.3;
    if !slender {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 24..200")]
    let half = (0.75 * p / width).clamp(24.0, 120.0) as usize;
    let n = 2 * half;
    let q = resample(line, p, n);
    let at = |i: usize| q[i % n];
    // Finds the ends: from there both sides run parallel.
    let score = |i: usize, step: usize| {
        (1..half).step_by(step).map(|k| (at(i + k) - at(i + n - k)).length()).sum::<f64>()
    };
    let least = |from: usize, to: usize, step: usize| {
        let scores = (from..to).step_by(step).map(|i| (score(i, step), i));
        scores.min_by(|a, b| a.0.total_cmp(&b.0)).map(|s| s.1)
    };
    // Searches first in strides, then one by one around the best.
    let stride = half / 24;
    let near = least(0, half, stride)? + n;
    let tip = least(near - stride, near + stride + 1, 1)? % n;
    let left: Vec<DVec2> = (0..=half).map(|k| at(tip + k)).collect();
    let right: Vec<DVec2> = (0..=half).map(|k| at(tip + n - k)).collect();
    let centre = pair(&left, &right);
    let length: f64 = centre.windows(2).map(|w| (w[1].0 - w[0].0).length()).sum();
    #[expect(clippy::cast_precision_loss, reason = "a few hundred points")]
    let mean = centre.iter().map(|c| c.1).sum::<f64>() / centre.len().max(1) as f64;
    // An outline that overlaps itself has a smaller area than a ribbon, so the distance of the sides decides.
    let width = mean.max(width);
    (length > 0.0).then_some(Ribbon { centre, width, length })
}

/// Finds the centre line of a pen's stroke that closes on itself: an outer and an inner outline.
fn closed_ribbon(a: &[DVec2], b: &[DVec2]) -> Option<Ribbon> {
    let ((pa, aa), (pb, ab)) = (ring(a)?, ring(b)?);
    let (outer, inner, po) = if aa >= ab { (a, b, pa) } else { (b, a, pb) };
    let length = 0.5 * (pa + pb);
    let width = (aa - ab).abs() / length;
    let slender = width > 0.0 && width / length < 0.2;
    if !slender || !inside(outer, *inner.first()?) {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 32..256")]
    let n = (1.5 * length / width).clamp(32.0, 256.0) as usize;
    let (o, i) = (resample(outer, po, n), resample(inner, pa + pb - po, n));
    let mut centre: Centre = o
        .iter()
        .filter_map(|&p| {
            let near = i
                .iter()
                .copied()
                .min_by(|x, y| (*x - p).length_squared().total_cmp(&(*y - p).length_squared()))?;
            Some(((p + near) * 0.5, (p - near).length()))
        })
        .collect();
    centre.extend(centre.first().copied());
    Some(Ribbon { centre, width, length })
}

fn inside(closed: &[DVec2], p: DVec2) -> bool {
    let crossings = closed.windows(2).filter(|w| {
        let (a, b) = (w[0], w[1]);
        (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x
    });
    crossings.count() % 2 == 1
}

/// Pairs the two sides by dynamic time warping: the monotone pairing with the least sum of distances.
fn pair(left: &[DVec2], right: &[DVec2]) -> Centre {
    let (n, m) = (left.len(), right.len());
    let distance = |i: usize, j: usize| (left[i] - right[j]).length();
    let mut cost = vec![f64::INFINITY; n * m];
    for i in 0..n {
        for j in 0..m {
            let before = match (i, j) {
                (0, 0) => 0.0,
                (0, _) => cost[j - 1],
                (_, 0) => cost[(i - 1) * m],
                _ => cost[(i - 1) * m + j - 1].min(cost[(i - 1) * m + j]).min(cost[i * m + j - 1]),
            };
            cost[i * m + j] = before + distance(i, j);
        }
    }
    let (mut i, mut j) = (n - 1, m - 1);
    let mut pairs = vec![(i, j)];
    while i > 0 || j > 0 {
        let at = |i: Option<usize>, j: Option<usize>| match (i, j) {
            (Some(i), Some(j)) => cost[i * m + j],
            _ => f64::INFINITY,
        };
        let (up, back) = (i.checked_sub(1), j.checked_sub(1));
        let (diagonal, a, b) = (at(up, back), at(up, Some(j)), at(Some(i), back));
        if diagonal <= a && diagonal <= b {
            (i, j) = (i - 1, j - 1);
        } else if a <= b {
            i -= 1;
        } else {
            j -= 1;
        }
        pairs.push((i, j));
    }
    pairs.reverse();
    let raw: Centre = pairs.iter().map(|&(i, j)| ((left[i] + right[j]) * 0.5, distance(i, j))).collect();
    // Half steps of one side make small teeth, which a mean of three removes.
    let smooth = |k: usize| match (k.checked_sub(1).and_then(|k| raw.get(k)), raw.get(k + 1)) {
        (Some(a), Some(b)) => ((a.0 + raw[k].0 * 2.0 + b.0) * 0.25, (a.1 + 2.0 * raw[k].1 + b.1) * 0.25),
        _ => raw[k],
    };
    (0..raw.len()).map(smooth).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::ops;

    /// Returns the outline of a pen of the given widths along `way`.
    fn outline(way: &[DVec2], width: impl Fn(f64) -> f64) -> Vec<DVec2> {
        let n = way.len();
        let side = |sign: f64| {
            (0..n).map(move |i| (i, sign)).map(|(i, sign)| {
                let t = (way[(i + 1).min(n - 1)] - way[i.saturating_sub(1)]).normalize_or_zero();
                #[expect(clippy::cast_precision_loss, reason = "few points")]
                let w = width(i as f64 / (n - 1) as f64);
                way[i] + t.perp() * (sign * 0.5 * w)
            })
        };
        let mut out: Vec<DVec2> = side(1.0).collect();
        let mut back: Vec<DVec2> = side(-1.0).collect();
        back.reverse();
        out.extend(back);
        out.push(out[0]);
        out
    }

    fn arc(n: u32, angle: f64) -> Vec<DVec2> {
        (0..=n)
            .map(|i| {
                let (s, c) = ops::sin_cos(angle * f64::from(i) / f64::from(n));
                DVec2::new(c, s) * 10.0
            })
            .collect()
    }

    fn one(lines: &[Vec<DVec2>]) -> Option<Vec<(DVec2, f64)>> {
        let c = Candidate { lines, fill_only: true, fill_said: true, color: None };
        centre_lines(&[c], 30.0).pop().flatten()
    }

    #[test]
    fn a_bent_pen_stroke_becomes_its_centre_line() {
        for angle in [0.5, 2.0, 5.0, 6.2] {
            let shape = outline(&arc(80, angle), |t| 0.2 + 0.4 * t * (1.0 - t));
            let line = one(&[shape]).unwrap_or_else(|| panic!("{angle} is a ribbon"));
            let worst = line.iter().map(|(p, _)| (p.length() - 10.0).abs()).fold(0.0, f64::max);
            assert!(worst < 0.16, "{angle}: {worst}");
            let length: f64 = line.windows(2).map(|w| (w[1].0 - w[0].0).length()).sum();
            assert!((length - 10.0 * angle).abs() < 0.06 * 10.0 * angle, "{angle}: {length}");
            let middle = line[line.len() / 2].1;
            let early = line[line.len() / 10].1;
            assert!(
                middle > 0.75 && early < 0.9 * middle + 0.1,
                "pressure follows the width: {early} {middle}"
            );
        }
    }

    #[test]
    fn a_closed_pen_stroke_becomes_a_loop() {
        let ring = |r: f64| arc(90, ops::TAU).into_iter().map(|p| p * (r / 10.0)).collect::<Vec<_>>();
        let line = one(&[ring(10.2), ring(9.8)]).expect("a ribbon");
        assert!(line.iter().all(|(p, _)| (p.length() - 10.0).abs() < 0.1));
        assert_eq!(line.first(), line.last());
    }

    #[test]
    fn leaves_and_discs_stay_outlines() {
        let circle = arc(60, ops::TAU);
        assert!(one(std::slice::from_ref(&circle)).is_none(), "disc");
        for aspect in [2.0, 4.0, 6.0] {
            let leaf: Vec<DVec2> = circle.iter().map(|p| DVec2::new(p.x, p.y / aspect)).collect();
            assert!(one(&[leaf]).is_none(), "leaf of 1 : {aspect}");
        }
        let square = [[0.0, 0.0], [5.0, 0.0], [5.0, 5.0], [0.0, 5.0], [0.0, 0.0]].map(DVec2::from).to_vec();
        assert!(one(&[square]).is_none(), "square");
    }

    #[test]
    fn short_dashes_of_the_same_pen_go_along() {
        let long = vec![outline(&arc(80, 2.0), |_| 0.4)];
        let dash = vec![outline(&[DVec2::ZERO, DVec2::X * 0.7, DVec2::X * 1.4], |_| 0.4)];
        let c = |lines| Candidate { lines, fill_only: true, fill_said: true, color: None };
        assert!(centre_lines(&[c(&dash)], 30.0)[0].is_none(), "alone it could be anything");
        assert!(centre_lines(&[c(&long), c(&dash)], 30.0)[1].is_some(), "beside a stroke it is one");
    }

    #[test]
    fn hostile_outlines_are_left_alone() {
        let nan = vec![DVec2::splat(f64::NAN); 9];
        let huge: Vec<DVec2> = arc(20, ops::TAU).into_iter().map(|p| p * 1e299).collect();
        for shape in [nan, huge, vec![], vec![DVec2::ONE], vec![DVec2::ONE; 100]] {
            assert!(one(std::slice::from_ref(&shape)).is_none(), "{shape:?}");
        }
    }
}
