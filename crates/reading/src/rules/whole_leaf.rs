//! The rule about a whole leaf: an outline in one to three strokes, a line along its middle, and lines that leave it.
//!
//! As in the rules about a whole tree and a whole flower, only shapes and places count.

use geom::{bounds, closest_on_polyline, convex_hull, pca2, polyline_length, signed_area, simple_outline};
use glam::DVec2;
use ink::StrokeClass;

use super::{Findings, STALK, openness, share_inside, unsure};
use crate::Kind;
use crate::blade::{first_round, split_stalks};
use crate::draft::Draft;
use crate::rings::rings;
use crate::thresholds::MOUTH;

/// The margin is at least this share of the drawing, corner to corner.
const LARGE: f64 = 0.5;
/// A leaf without lobes fills more than this share of its hull.
const FULL: f64 = 0.7;
/// A lobed leaf with side veins fills more than this share of its hull.
const LOBED: f64 = 0.35;
/// Greatest part of the margin that was not drawn, as a share of its size.
const GAP: f64 = 0.25;
/// A vein lies in its leaf with more than this share of its length.
const INSIDE: f64 = 0.6;
/// A midrib does so with more than this share: it may go on as a petiole.
const MIDRIB_INSIDE: f64 = 0.5;
/// A midrib is longer than this share of its leaf.
const ALONG: f64 = 0.4;
/// A midrib is straighter than this: its chord over its length.
const STRAIGHT: f64 = 0.8;
/// A midrib keeps this near to the middle, as a share of the leaf's width.
const MIDDLE: f64 = 0.25;
/// A side vein comes this near to the midrib, as a share of the leaf's size.
const TOUCH: f64 = 0.07;
/// The length of a leaf without side veins is more than this factor of its width.
const SLENDER: f64 = 1.25;
/// The cosine of the angle between its midrib and its length is above this.
const LENGTHWISE: f64 = 0.85;
/// Number of the longest strokes that may form the margin.
const LONGEST: usize = 5;
/// One in this number of side veins may be something else.
const ODD: usize = 8;
/// The farthest point of a line drawn there and back lies half its length away (*geometry*), or nearly.
const THERE_AND_BACK: core::ops::Range<f64> = 0.45..0.55;
/// Points of a line that are looked at.
const SAMPLES: usize = 40;

/// A margin and the strokes that form it.
struct Margin {
    strokes: Vec<usize>,
    outline: Vec<DVec2>,
    /// Diagonal of its box.
    size: f64,
    /// Share of its hull that it fills.
    full: f64,
    /// The midrib that was drawn in one go with it.
    rib: Option<Vec<DVec2>>,
}

/// Finds one leaf with its midrib, and with or without side veins.
pub(super) fn whole_leaf(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    let count = draft.class.len();
    let other = draft.kind.is_some_and(|kind| kind != Kind::Leaf);
    if other || count < 2 || !(0..count).all(|k| unsure(draft, k)) {
        return found;
    }
    let all = (0..count).flat_map(|k| &draft.ink.strokes[k].points).copied().collect::<Vec<_>>();
    let Some((lo, hi)) = bounds(&all) else { return found };
    let leaf = margins(draft)
        .into_iter()
        .filter(|m| m.size > LARGE * lo.distance(hi))
        .find_map(|m| veins(draft, &m).map(|veins| (m, veins)));
    if let Some((margin, veins)) = leaf {
        margin.strokes.into_iter().for_each(|k| found.settle(k, StrokeClass::Blade));
        veins.into_iter().for_each(|k| found.settle(k, StrokeClass::Vein));
    }
    found
}

/// Returns the outlines that may be the margin of a leaf: single strokes that are closed, then two or three that close
/// together.
fn margins(draft: &Draft<'_>) -> Vec<Margin> {
    let length = |k: usize| draft.ink.strokes[k].length;
    let mut longest: Vec<usize> = (0..draft.class.len()).collect();
    base::sort_by(&mut longest, |&a, &b| length(b).total_cmp(&length(a)).then(a.cmp(&b)));
    longest.truncate(LONGEST);
    let mut found: Vec<Margin> = Vec::new();
    for &k in &longest {
        let points = &draft.ink.strokes[k].points;
        // With its midrib in one go, or with its petiole.
        let round = first_round(points);
        if round.len() < points.len() {
            let rib = if round[0] == points[0] {
                &points[round.len()..]
            } else {
                &points[..points.len() - round.len()]
            };
            found.extend(margin(round, vec![k]).map(|m| Margin { rib: Some(rib.to_vec()), ..m }));
        }
        let closed = split_stalks(points, STALK).0;
        let gap = closed.first().zip(closed.last()).map_or(f64::INFINITY, |(a, b)| a.distance(*b));
        if gap < MOUTH * polyline_length(&closed) {
            found.extend(margin(&closed, vec![k]));
        }
    }
    let open: Vec<usize> = longest.into_iter().filter(|&k| openness(&draft.ink.strokes[k]) > MOUTH).collect();
    for (i, &a) in open.iter().enumerate() {
        for (j, &b) in open.iter().enumerate().skip(i + 1) {
            found.extend(closing(draft, &[a, b]));
            for &c in &open[j + 1..] {
                found.extend(closing(draft, &[a, b, c]));
            }
        }
    }
    found
}

/// Returns the margin of strokes that close together.
fn closing(draft: &Draft<'_>, strokes: &[usize]) -> Option<Margin> {
    let points: Vec<&[DVec2]> = strokes.iter().map(|&k| draft.ink.strokes[k].points.as_slice()).collect();
    let [ring] = &rings(&points)[..] else { return None };
    let margin = margin(&ring.points, strokes.to_vec())?;
    let shut = ring.gaps.iter().all(|&g| {
        let (a, b) = ring.gap(g);
        a.distance(b) < GAP * margin.size
    });
    shut.then_some(margin)
}

fn margin(points: &[DVec2], strokes: Vec<usize>) -> Option<Margin> {
    let outline = simple_outline(points)?;
    let (lo, hi) = bounds(points)?;
    let full = signed_area(&outline) / signed_area(&convex_hull(points)).max(1e-12);
    Some(Margin { strokes, outline, size: lo.distance(hi), full, rib: None })
}

/// Returns the lines in a leaf, if its margin holds nothing else and one of them is a midrib.
fn veins(draft: &Draft<'_>, margin: &Margin) -> Option<Vec<usize>> {
    let rest: Vec<usize> = (0..draft.class.len()).filter(|k| !margin.strokes.contains(k)).collect();
    let inside = |k: usize| {
        let points = &draft.ink.strokes[k].points;
        share_inside(points, points.len().div_ceil(SAMPLES), &margin.outline)
    };
    let pca = pca2(&margin.outline)?;
    let length = pca.extent[0].max(pca.extent[1]);
    let width = pca.extent[0].min(pca.extent[1]);
    let middle = geom::centroid(&margin.outline);
    let is_midrib = |p: &[DVec2]| {
        let (a, b) = far_ends(p);
        a.distance(b) > ALONG * length && is_line(p, STRAIGHT) && distance(p, middle) < MIDDLE * width
    };
    let longest = |&a: &usize, &b: &usize| {
        draft.ink.strokes[a].length.total_cmp(&draft.ink.strokes[b].length).then(b.cmp(&a))
    };
    let midrib = rest
        .iter()
        .copied()
        .filter(|&k| is_midrib(&draft.ink.strokes[k].points) && inside(k) > MIDRIB_INSIDE)
        .max_by(longest);
    let rib = match (&margin.rib, midrib) {
        (_, Some(k)) => &draft.ink.strokes[k].points,
        (Some(rib), None) if rib.len() > 1 && is_midrib(rib) => rib,
        _ => return None,
    };
    let side: Vec<usize> = rest.iter().copied().filter(|&k| Some(k) != midrib).collect();
    let lines =
        side.iter().filter(|&&k| is_line(&draft.ink.strokes[k].points, 0.5) && inside(k) > INSIDE).count();
    // A piece of the margin or of the petiole may be left over.
    if lines + side.len() / ODD + usize::from(side.len() > 2) < side.len() {
        return None;
    }
    // A side vein begins at the midrib, or crosses it.
    let leaves =
        |k: usize| draft.ink.strokes[k].points.iter().any(|&p| distance(rib, p) < TOUCH * margin.size);
    let branching = side.iter().filter(|&&k| leaves(k)).count();
    let (a, b) = far_ends(rib);
    let lengthwise = (b - a).normalize_or_zero().dot(pca.major).abs() > LENGTHWISE;
    let sound = if side.is_empty() {
        margin.full > FULL && length > SLENDER * width && lengthwise
    } else {
        branching >= 2 && 2 * branching > side.len() && margin.full > LOBED
    };
    sound.then(|| rest.into_iter().filter(|&k| Some(k) == midrib || inside(k) > INSIDE).collect())
}

/// Whether points form a line, drawn once or there and back.
fn is_line(points: &[DVec2], straight: f64) -> bool {
    let (a, b) = far_ends(points);
    let length = polyline_length(points);
    let once = points[0].distance(points[points.len() - 1]) > straight * length;
    once || (a.distance(b) > THERE_AND_BACK.start * length && a.distance(b) < THERE_AND_BACK.end * length)
}

/// Returns the first point and the one farthest from it.
fn far_ends(points: &[DVec2]) -> (DVec2, DVec2) {
    let a = points[0];
    let far = points.iter().copied().max_by(|p, q| a.distance(*p).total_cmp(&a.distance(*q)));
    (a, far.unwrap_or(a))
}

fn distance(line: &[DVec2], p: DVec2) -> f64 {
    closest_on_polyline(line, p).map_or(f64::INFINITY, |c| c.distance)
}
