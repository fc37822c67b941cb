//! One leaf or petal: outline, root, tip, midrib.

use geom::{
    bounds, closest_on_polyline, contains, medial_axis_width, resample, signed_area, simple_outline,
    simplify, smooth_gaussian,
};
use glam::DVec2;

use crate::thresholds::{NO_LENGTH, ROUNDING};

/// Points round an outline that the tip is looked for among.
const ROUND: usize = 96;
/// The tip is the farthest of this many sharpest places.
const SHARPEST: usize = 8;
/// A tip turns at least this much over six of the points, radians: 57 degrees.
const POINTED: f64 = 1.0;
/// A loose end of an outline longer than this share of the stroke is a stalk.
const STALK: f64 = 0.07;
/// The ends of a closed blade are at most this share of the stroke apart.
const CLOSED: f64 = 0.035;
/// The square of a blade's size over its area at most: thinner than 1 in 60 is a line that was drawn there and back.
const THINNEST: f64 = 120.0;
/// A midrib drawn in one go with its margin lies in it with more than 4 of 5 of its points.
const RIB_INSIDE: (usize, usize) = (4, 5);
/// The ends of a blade seen from its edge meet within this share of its length.
const EDGE_ON: f64 = 0.1;
/// A line comes back to where it began within this share of its size.
const COMES_BACK: f64 = 0.08;
/// Cutting a stalk off costs less than this share of the gap between the ends, or the gap is a gap.
const STALK_COST: f64 = 0.8;
/// A sharp place is the tip if it lies at least this far out relative to the farthest point.
const SHARP_REACH: f64 = 0.9;
/// Cross-sections of a blade.
const SECTIONS: usize = 11;
/// Cross-sections at either end that are ignored because the outline turns there.
const WILD: usize = 2;
/// Each point of a midrib leads on by this share of its length at least.
const ONWARDS: f64 = 0.02;

/// A blade whose root is not decided yet.
#[derive(Clone, Debug)]
pub(crate) struct Sheetlet {
    /// Simple, counter-clockwise.
    pub(crate) outline: Vec<DVec2>,
    /// Point where the pen began and ended: most people begin a leaf where it is attached.
    pub(crate) gap: DVec2,
    /// Distance between the two ends of the stroke.
    pub(crate) gap_width: f64,
    /// The root, where the way it was drawn leaves no doubt (a piece of a corolla).
    pub(crate) root: Option<DVec2>,
    /// Surely a leaf, whatever stands round it: a frond, a blade of grass.
    pub(crate) leaf: bool,
    /// Stroke of the ink that it came from.
    pub(crate) stroke: usize,
    /// The midrib, where margin and midrib are one stroke.
    pub(crate) rib: Option<Vec<DVec2>>,
    /// Longest diameter.
    pub(crate) size: f64,
    /// Mean of the outline's points.
    pub(crate) middle: DVec2,
}

impl Sheetlet {
    /// Makes a blade of a closed line; `None` if it has almost no area.
    pub(crate) fn new(line: &[DVec2], stroke: usize) -> Option<Self> {
        let outline = simple_outline(&tidy(line))?;
        let (first, last) = (*line.first()?, *line.last()?);
        let (lo, hi) = bounds(&outline)?;
        let size = lo.distance(hi);
        let area = signed_area(&outline);
        if area <= size * size / THINNEST {
            return None;
        }
        Some(Self {
            middle: geom::centroid(&outline),
            // Ends far apart are no gap to be attached at: then the lower end is.
            gap: match first.distance(last) < 0.5 * size {
                true => first.midpoint(last),
                false if first.y < last.y => first,
                false => last,
            },
            gap_width: first.distance(last),
            root: None,
            leaf: false,
            rib: None,
            outline,
            stroke,
            size,
        })
    }

    /// Makes a blade of margin and midrib drawn in one go; `None` if the line is not such a stroke.
    pub(crate) fn with_rib(line: &[DVec2], stroke: usize) -> Option<Self> {
        let margin = first_round(line);
        let blade = Self::new(margin, stroke).filter(|_| margin.len() < line.len())?;
        let from_start = margin.as_ptr() == line.as_ptr();
        let rest = if from_start { &line[margin.len()..] } else { &line[..line.len() - margin.len()] };
        let inside = rest.iter().filter(|p| contains(&blade.outline, **p)).count();
        (RIB_INSIDE.1 * inside > RIB_INSIDE.0 * rest.len())
            .then(|| Self { rib: Some(rest.to_vec()), ..blade })
    }

    /// Makes a blade of the outline of [`lens`].
    pub(crate) fn lens(line: &[DVec2], stroke: usize, half_width: f64) -> Option<Self> {
        let mut lens = Self::new(&lens(line, half_width)?, stroke)?;
        lens.root = line.first().copied();
        Some(lens)
    }

    /// Makes a blade of a closed line that comes back the way it went: a lens round the middle of both ways, as
    /// narrow as a blade may be. `None` if its ends do not meet.
    pub(crate) fn edge_on(line: &[DVec2], stroke: usize) -> Option<Self> {
        let (first, last) = (*line.first()?, *line.last()?);
        let root = first.midpoint(last);
        let far = |&a: &usize, &b: &usize| {
            line[a].distance_squared(root).total_cmp(&line[b].distance_squared(root))
        };
        let turn = (0..line.len()).max_by(far)?;
        let long = line[turn].distance(root);
        if first.distance(last) > EDGE_ON * long {
            return None;
        }
        let evenly = |way: &[DVec2]| resample(way, geom::polyline_length(way) / 16.0);
        let back: Vec<DVec2> = line[turn..].iter().rev().copied().collect();
        let (out, back) = (evenly(&line[..=turn]), evenly(&back));
        let spine: Vec<DVec2> = out.iter().zip(&back).map(|(a, b)| a.midpoint(*b)).collect();
        Some(Self {
            root: None,
            gap: root,
            gap_width: first.distance(last),
            ..Self::lens(&spine, stroke, 0.015 * long)?
        })
    }

    /// Leads the outline on to a point outside it, from its nearest point; returns where it now begins.
    pub(crate) fn claw(&mut self, root: DVec2, foot: DVec2) -> DVec2 {
        let far = |k: &usize| self.outline[*k].distance_squared(root);
        let nearest = (0..self.outline.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
        let Some(at) = nearest else { return root };
        let mut outline = self.outline.clone();
        outline[at] = foot;
        // Not where that would cross the outline.
        match simple_outline(&outline).filter(|o| o.len() == outline.len()) {
            Some(longer) => {
                self.outline = longer;
                self.gap = foot;
                foot
            }
            None => root,
        }
    }

    /// Returns the point of the outline nearest to `p`, and its distance.
    pub(crate) fn nearest(&self, p: DVec2) -> (DVec2, f64) {
        nearest_on_ring(&self.outline, p)
    }

    /// Whether one of some `places` points of its outline is nearer than `reach` to the other one's.
    pub(crate) fn touches(&self, other: &Self, reach: f64, places: usize) -> bool {
        // No point of an outline is farther from its middle than its size.
        if self.middle.distance(other.middle) > self.size + other.size + reach {
            return false;
        }
        let stride = self.outline.len().div_ceil(places).max(1);
        self.outline.iter().step_by(stride).any(|&p| other.nearest(p).1 < reach)
    }
}

/// A leaf or petal drawn as one line is half as wide as this share of its length.
pub(crate) const LENS: f64 = 0.055;

/// Returns the outline of a frond or grass blade that was drawn as one stroke of the pen: widest at a third, pointed
/// at both ends. `None` for a line without length.
pub(crate) fn lens(line: &[DVec2], half_width: f64) -> Option<Vec<DVec2>> {
    let spine = resample(&simplify(line, 0.002), geom::polyline_length(line) / 16.0);
    let n = spine.len();
    if n <= 2 {
        return None;
    }
    let half_width_at = |i: usize| {
        #[expect(clippy::cast_precision_loss, reason = "a few dozen points")]
        let t = i as f64 / (n - 1) as f64;
        half_width * 2.6 * t.sqrt() * (1.0 - t) * (1.0 - 0.25 * t)
    };
    Some(ring_round(&spine, half_width_at))
}

/// Returns the closed line round a spine: along its right side and back along its left one, where points on the spine
/// itself are not repeated. `half_width_at`: half the width at a row of the spine.
pub(crate) fn ring_round(spine: &[DVec2], half_width_at: impl Fn(usize) -> f64) -> Vec<DVec2> {
    let n = spine.len();
    let side = |i: usize, sign: f64| {
        let along = (spine[(i + 1).min(n - 1)] - spine[i.saturating_sub(1)]).normalize_or_zero();
        spine[i] + along.perp() * (sign * half_width_at(i))
    };
    let right = (0..n).map(|i| side(i, -1.0));
    let left = (0..n).rev().filter(|&i| half_width_at(i) > 0.0).map(|i| side(i, 1.0));
    right.chain(left).collect()
}

/// Returns the point of a closed outline nearest to `p`, and its distance.
pub(crate) fn nearest_on_ring(outline: &[DVec2], p: DVec2) -> (DVec2, f64) {
    let open = closest_on_polyline(outline, p);
    let close = match (outline.last(), outline.first()) {
        (Some(&a), Some(&b)) => closest_on_polyline(&[a, b], p),
        _ => None,
    };
    [open, close]
        .into_iter()
        .flatten()
        .min_by(|a, b| a.distance.total_cmp(&b.distance))
        .map_or((p, f64::INFINITY), |c| (c.point, c.distance))
}

/// Leaves out points where a line is straight: outlines are compared point by point.
fn tidy(line: &[DVec2]) -> Vec<DVec2> {
    simplify(line, 0.0006)
}

/// Returns the round part of a line that comes back to where it began and goes on for a good way, or that begins a
/// good way before where it ends; the larger of the two. Returns the whole line if there is none.
pub(crate) fn first_round(points: &[DVec2]) -> &[DVec2] {
    let n = points.len();
    let size = bounds(points).map_or(0.0, |(lo, hi)| lo.distance(hi));
    // Ink is sampled evenly: a share of the points is a share of the length. A midrib is at least a sixth of it.
    let nearest = |from: DVec2, range: core::ops::Range<usize>| {
        range
            .map(|k| (k, points[k].distance(from)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|&(_, d)| d < COMES_BACK * size)
    };
    let ahead = nearest(points[0], n / 2..n * 5 / 6).map(|(k, _)| &points[..=k]);
    let back = nearest(points[n - 1], n / 6..n / 2).map(|(k, _)| &points[k..]);
    let area = |round: &&[DVec2]| signed_area(round).abs();
    ahead.into_iter().chain(back).max_by(|a, b| area(a).total_cmp(&area(b))).unwrap_or(points)
}

/// Splits a blade's stroke into the closed part and loose ends that are stalks or stems (drawn in one go).
///
/// Each loose end runs from its free end to the blade. Quadratic in 160 points at most.
///
/// `near`: how much nearer than its ends the stroke comes to itself where it closes, as a share (blades 0.35).
pub(crate) fn split_stalks(points: &[DVec2], near: f64) -> (Vec<DVec2>, Vec<Vec<DVec2>>) {
    let length = geom::polyline_length(points);
    let whole = || (points.to_vec(), Vec::new());
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return whole() };
    let gap = first.distance(*last);
    if gap < CLOSED * length {
        return whole();
    }
    let stride = points.len().div_ceil(160);
    let n = points.len() / stride;
    let p = |i: usize| points[(i * stride).min(points.len() - 1)];
    // Close i and j nearer than the ends are: the rest of the stroke hangs out. Shorter loose ends are better.
    let mut best: Option<(f64, usize, usize)> = None;
    for i in 0..n / 2 {
        for j in (i + n * 2 / 5).max(i + 3)..n {
            let d = p(i).distance(p(j));
            #[expect(clippy::cast_precision_loss, reason = "at most 160")]
            let loose = (i + n - 1 - j) as f64 / n as f64 * length;
            let cost = d + 0.25 * loose;
            if d < near * gap && best.is_none_or(|(c, ..)| cost < c) {
                best = Some((cost, i, j));
            }
        }
    }
    let Some((cost, i, j)) = best else { return whole() };
    if cost > STALK_COST * gap {
        return whole();
    }
    let (i, j) = (i * stride, (j * stride).min(points.len() - 1));
    let mut stalks = Vec::new();
    if geom::polyline_length(&points[..=i]) > STALK * length {
        stalks.push(points[..=i].to_vec());
    }
    if geom::polyline_length(&points[j..]) > STALK * length {
        stalks.push(points[j..].iter().rev().copied().collect());
    }
    (points[i..=j].to_vec(), stalks)
}

/// Returns the tip: the sharp place of the smoothed outline that is farthest from the root, or the farthest point
/// itself if no sharp place is nearly as far.
pub(crate) fn tip(outline: &[DVec2], root: DVec2) -> DVec2 {
    let Some(farthest) =
        outline.iter().copied().max_by(|a, b| a.distance_squared(root).total_cmp(&b.distance_squared(root)))
    else {
        return root;
    };
    let mut closed = outline.to_vec();
    closed.extend(outline.first());
    #[expect(clippy::cast_precision_loss, reason = "96")]
    let step = geom::polyline_length(&closed) / ROUND as f64;
    let even = resample(&closed, step);
    let n = even.len().saturating_sub(1);
    if n < SHARPEST {
        return farthest;
    }
    let turn = |i: usize| {
        let at = |k: usize| even[k % n];
        let (a, b) = (at(i) - at(i + n - 3), at(i + 3) - at(i));
        base::ops::atan2(a.perp_dot(b), a.dot(b)).abs()
    };
    let mut sharpest: Vec<(f64, usize)> = (0..n).map(|i| (turn(i), i)).filter(|t| t.0 > POINTED).collect();
    base::sort_by(&mut sharpest, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    // On the far side of a round petal the middle counts, not a corner that is a little farther away.
    let out = (geom::centroid(outline) - root).normalize_or_zero();
    let reach = |p: DVec2| 0.5 * (p - root).dot(out) + 0.5 * p.distance(root);
    let farthest = even.iter().copied().max_by(|a, b| reach(*a).total_cmp(&reach(*b))).unwrap_or(farthest);
    let sharp = sharpest
        .iter()
        .take(SHARPEST)
        .map(|&(_, i)| even[i])
        .max_by(|a, b| reach(*a).total_cmp(&reach(*b)))
        .unwrap_or(farthest);
    if reach(sharp) > SHARP_REACH * reach(farthest) { sharp } else { farthest }
}

/// Returns a midrib from the outline alone: through the middles of its cross-sections, root to tip.
pub(crate) fn found_midrib(outline: &[DVec2], root: DVec2, tip: DVec2) -> Vec<DVec2> {
    let mut line = vec![root];
    let sections = medial_axis_width(outline, root, tip, SECTIONS);
    if sections.len() > 2 * WILD {
        line.extend(sections[WILD..sections.len() - WILD].iter().map(|s| s.0).filter(|c| c.is_finite()));
    }
    line.push(tip);
    let reach = root.distance(tip);
    // A wild section (a lobe cut lengthwise) would send the midrib out and back: keep sections that lead on to the
    // tip.
    let along = (tip - root) / reach.max(1e-12);
    let mut ahead = f64::NEG_INFINITY;
    line.retain(|p| {
        let s = (*p - root).dot(along);
        let on = s > ahead + ONWARDS * reach && (s < (1.0 - ONWARDS) * reach || *p == tip);
        if on {
            ahead = s;
        }
        on
    });
    midrib(&line, root, tip)
}

/// Returns a smooth midrib that begins at the root and ends at the tip.
pub(crate) fn midrib(line: &[DVec2], root: DVec2, tip: DVec2) -> Vec<DVec2> {
    let mut whole = vec![root];
    whole.extend(line.iter().copied().filter(|p| p.distance(root) > ROUNDING && p.distance(tip) > ROUNDING));
    whole.push(tip);
    let length = geom::polyline_length(&whole);
    if length <= ROUNDING {
        return vec![root, if tip == root { root + DVec2::new(0.0, NO_LENGTH) } else { tip }];
    }
    let step = length / 12.0;
    let even = resample(&whole, step);
    smooth_gaussian(&even, 2, 4.0 * step * step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::ops;

    fn ellipse(centre: DVec2, a: f64, b: f64, from: f64) -> Vec<DVec2> {
        (0..=60)
            .map(|i| ops::sin_cos(from + ops::TAU * f64::from(i) / 60.0))
            .map(|(s, c)| centre + DVec2::new(a * c, b * s))
            .collect()
    }

    #[test]
    fn tip_is_opposite_the_root_and_the_midrib_goes_through_the_middle() {
        let leaf = Sheetlet::new(&ellipse(DVec2::new(0.5, 0.5), 0.3, 0.1, ops::PI), 0).expect("has area");
        assert!(leaf.gap.distance(DVec2::new(0.2, 0.5)) < 1e-6);
        let t = tip(&leaf.outline, leaf.gap);
        assert!(t.distance(DVec2::new(0.8, 0.5)) < 0.02, "{t}");
        let rib = found_midrib(&leaf.outline, leaf.gap, t);
        assert!(rib.len() >= 10 && rib.iter().all(|p| (p.y - 0.5).abs() < 0.02), "{rib:?}");
    }

    #[test]
    fn a_leaf_with_its_stalk_in_one_stroke_is_taken_apart() {
        let mut line: Vec<DVec2> = (0..20).map(|i| DVec2::new(0.0, f64::from(i) * 0.01)).collect();
        line.extend(ellipse(DVec2::new(0.0, 0.5), 0.1, 0.3, -ops::FRAC_PI_2));
        let (blade, stalks) = split_stalks(&line, 0.35);
        assert_eq!(stalks.len(), 1);
        assert!(
            stalks[0][0] == DVec2::ZERO
                && stalks[0].last().is_some_and(|p| p.distance(DVec2::new(0.0, 0.2)) < 0.05),
            "{stalks:?}"
        );
        assert!(
            Sheetlet::new(&blade, 0).is_some_and(|b| b.outline.iter().all(|p| p.y > 0.12)),
            "no stalk in the outline"
        );
    }

    #[test]
    fn an_open_leaf_without_a_stalk_stays_whole() {
        let line: Vec<DVec2> = ellipse(DVec2::ZERO, 0.1, 0.3, 0.0)[..52].to_vec();
        assert!(split_stalks(&line, 0.35).1.is_empty(), "a gap is no stalk");
    }
}
