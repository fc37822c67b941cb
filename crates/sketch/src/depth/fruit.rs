//! Fruits, roots and other bodies: turned about the line of their symmetry, or along their middle where they bend.

use base::ops;
use geom::{
    centroid, contains, convex_hull, distance_to_polyline, pca2, polyline_length, resample, signed_area,
    smooth_gaussian,
};
use glam::{DVec2, DVec3};
use plant::{AxisKind, Frame, Organ, OrganKind, Plant, Shape};
use reading::FruitReading;

use super::axes::{Part, key_of};
use super::scene::{Bearing, Scene, usable};
use super::solid::span;

/// Rings of a body from pole to pole.
const RINGS: usize = 13;
/// A body whose length is more than this factor of its width has an axis of its own; a less slender one looks round
/// (the ratio of the variances is the square).
const ROUND: f64 = 1.25;
/// Gain in symmetry, as a share of the half width, for which another axis is taken instead of that of the stalk.
const CLEARLY: f64 = 0.1;
/// That gain if a long body has no stalk.
const MORE: f64 = 0.04;
/// A bearer that lies inside by more than this share of half its width is on its skin and no stalk: stalks begin in a
/// hollow.
const ON_SKIN: f64 = 0.3;
/// Cosine of the angle within which a direction counts as down: 53 degrees.
const NEARLY_DOWN: f64 = 0.6;
/// Least length of a bent body relative to its width, along its middle; shorter ones are lopsided.
const BENT_LENGTH: f64 = 2.0;
/// Its middle bows by more than this share of the distance of its ends: 0.2 for a banana, 0.05 for a straight root
/// drawn by hand.
const BOW: f64 = 0.1;
/// Its outline fills less than this share of its hull: one side is hollow, unlike that of half a disc.
const HOLLOW: f64 = 0.9;
/// Slenderness above which a body does not turn about an axis across it.
const LONGEST: f64 = 3.0;
/// Greatest radius of its rings as a share of the radius of the bend, so that the inner side of the bend does not
/// fold.
const FOLDS: f64 = 0.95;
/// Points around an outline, any two of which may be its ends.
const AROUND: usize = 72;
/// Pairs of points that are compared from end to end.
const PAIRS: usize = 24;
/// Variance, in steps, of the smoothing of a bent body's middle.
const EVENED: f64 = 6.0;
/// Half window of that smoothing, in steps.
const EVENED_WINDOW: usize = 4;

/// The form of a body in the plane of the drawing.
#[derive(Debug)]
enum Body {
    /// A body turned about `along` through `root`: `(radius, distance from the root along it)`.
    Straight { root: DVec2, along: DVec2, profile: Vec<DVec2> },
    /// A body along a line, with a half width at each of its points.
    Bent { line: Vec<DVec2>, half_width: Vec<f64> },
}

/// Adds a drawn fruit. A long one whose middle bows follows its middle; another is its outline turned about its axis
/// of greatest symmetry, preferring that of its stalk. `depth`: how far it lies in front of its place, ink units.
pub(crate) fn place_fruit(
    plant: &mut Plant,
    scene: &Scene<'_>,
    (fruit, depth): (&FruitReading, f64),
    rank: usize,
    seat: Option<(Bearing, DVec3)>,
) {
    let outline: Vec<DVec2> = fruit.outline.iter().copied().filter(|&p| usable(p)).collect();
    let bearing = match seat {
        Some((b, _)) => Some(b),
        None => scene.bearing(plant, fruit.bearer),
    };
    let Some(body) = body(&outline, bearing.map(|b| b.drawn)) else { return };
    let (root, along) = match &body {
        Body::Straight { root, along, .. } => (*root, *along),
        Body::Bent { line, .. } => (line[0], (line[line.len() - 1] - line[0]).normalize_or(DVec2::NEG_Y)),
    };
    let mut origin = scene.seat(root, bearing.as_ref());
    if let Some((_, at)) = seat {
        origin.z = at.z;
    }
    origin.z += depth * scene.map.metres_per_ink;
    let key = key_of(Part::Fruit, fruit.source, rank as u64, bearing.map_or(0, |b| b.key));
    let link = key_of(Part::Link, None, 0, key);
    let bearer = scene.stalk(plant, bearing.as_ref(), root, origin, AxisKind::Petiole, link);
    let s = scene.map.metres_per_ink;
    let shape = plant.add_shape(match body {
        Body::Straight { profile, .. } => {
            Shape::Revolution { profile: profile.iter().map(|&p| p * s).collect() }
        }
        Body::Bent { line, half_width } => {
            let local = |p: &DVec2| DVec2::new((*p - root).dot(-along.perp()), (*p - root).dot(along));
            Shape::Strand {
                path: line.iter().map(|p| (local(p) * s).extend(0.0)).collect(),
                radius_m: half_width.iter().map(|w| w * s).collect(),
                knob_m: 0.0,
            }
        }
    });
    plant.organs.push(Organ {
        kind: OrganKind::Fruit,
        bearer,
        flower: None,
        shape,
        frame: Frame::looking(origin, along.extend(0.0), DVec3::Z),
        scale: 1.0,
        paint: scene.paint(key, fruit.color),
        key,
        source: fruit.source,
    });
}

/// Returns the form of an outline that hangs at `bearer`; without a bearer its upper end is its root.
fn body(outline: &[DVec2], bearer: Option<DVec2>) -> Option<Body> {
    let all = pca2(outline)?;
    let stalk = stalk(outline, bearer);
    let long = all.lambda[0] >= ROUND * ROUND * all.lambda[1].max(f64::MIN_POSITIVE);
    if long && let Some(bent) = bent(outline, all.centre - stalk.unwrap_or(DVec2::NEG_Y) * all.extent[0]) {
        return Some(bent);
    }
    let hangs = stalk.unwrap_or(DVec2::NEG_Y);
    let usual = if long && stalk.is_none() { all.major } else { hangs };
    let longest = all.lambda[0] >= LONGEST * LONGEST * all.lambda[1];
    let others = [DVec2::NEG_Y, all.major, all.minor];
    let axes = if longest { vec![all.major] } else { [usual].into_iter().chain(others).collect() };
    let lopsided = |along: &DVec2| profile(outline, all.centre, *along).map_or(f64::INFINITY, |p| p.lopsided);
    // Clearly more symmetric than about the usual axis; on a plateau the first.
    let margin = if long && stalk.is_none() { MORE } else { CLEARLY };
    let worth = |(k, along): (usize, DVec2)| (lopsided(&along) + if k > 0 { margin } else { 0.0 }, along);
    let along = axes.into_iter().enumerate().map(worth).reduce(|a, b| if b.0 < a.0 { b } else { a })?.1;
    let along = if along.dot(hangs) < 0.0 { -along } else { along };
    let Profile { rings, low, aside, .. } = profile(outline, all.centre, along)?;
    let root = all.centre + along * low + along.perp() * aside;
    Some(Body::Straight { root, along, profile: rings })
}

/// Returns the direction from the stalk to the middle, exactly down if it is nearly that: stalks are drawn off the
/// middle. `None` if the bearer lies inside, such as a line on the skin.
fn stalk(outline: &[DVec2], bearer: Option<DVec2>) -> Option<DVec2> {
    let (all, bearer) = (pca2(outline)?, bearer?);
    let away = (centroid(outline) - bearer).try_normalize()?;
    let inside = distance_to_polyline(outline, bearer).filter(|_| contains(outline, bearer));
    if inside.is_some_and(|d| d > ON_SKIN * 0.5 * all.extent[1]) {
        return None;
    }
    Some(if away.dot(DVec2::NEG_Y) > NEARLY_DOWN { DVec2::NEG_Y } else { away })
}

/// The profile of an outline about an axis.
#[derive(Debug)]
pub(super) struct Profile {
    /// `(radius, distance from the root along the axis)`, from pole to pole.
    pub(super) rings: Vec<DVec2>,
    /// Place of the lower pole along the axis.
    pub(super) low: f64,
    /// Distance of its middle to the left of the axis.
    pub(super) aside: f64,
    /// Mean distance of the middles of its rings from that middle, as a share of its half width.
    lopsided: f64,
}

/// Returns the mean half width across `along` at rings from pole to pole.
pub(super) fn profile(outline: &[DVec2], centre: DVec2, along: DVec2) -> Option<Profile> {
    let across = along.perp();
    let local: Vec<DVec2> =
        outline.iter().map(|&p| DVec2::new((p - centre).dot(across), (p - centre).dot(along))).collect();
    let (low, high) =
        local.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.y), h.max(p.y)));
    if high - low < 1e-6 {
        return None;
    }
    let mut rings = Vec::with_capacity(RINGS);
    // The half width and the middle of each ring.
    let mut middles: Vec<(f64, f64)> = Vec::with_capacity(RINGS);
    for i in 0..RINGS {
        #[expect(clippy::cast_precision_loss, reason = "rings are few")]
        let t = i as f64 / (RINGS - 1) as f64;
        // Rings close up towards the poles, where the outline turns.
        let share = 0.5 - 0.5 * ops::cos(ops::PI * t);
        let y = low + (high - low) * share;
        let [left, right] = span((0..local.len()).map(|k| [local[k], local[(k + 1) % local.len()]]), y);
        let pole = i == 0 || i + 1 == RINGS;
        let radius = if pole || right < left { 0.0 } else { 0.5 * (right - left) };
        rings.push(DVec2::new(radius, y - low));
        if radius > 0.0 {
            middles.push((radius, 0.5 * (left + right)));
        }
    }
    let total: f64 = middles.iter().map(|m| m.0).sum();
    if total <= 0.0 {
        return None;
    }
    let aside = middles.iter().map(|(r, m)| r * m).sum::<f64>() / total;
    // A narrow place, such as one of the two humps of an apple, has little weight.
    let off: f64 = middles.iter().map(|(r, m)| r * (m - aside).abs()).sum();
    let square: f64 = middles.iter().map(|(r, _)| r * r).sum();
    Some(Profile { rings, low, aside, lopsided: off / square })
}

/// Returns a long body whose middle bows; it begins at the end nearer to `stalk`.
fn bent(outline: &[DVec2], stalk: DVec2) -> Option<Body> {
    if signed_area(outline).abs() > HOLLOW * signed_area(&convex_hull(outline)) {
        return None;
    }
    let (mut a, mut b) = sides(outline)?;
    if stalk.distance(b[PAIRS].midpoint(a[PAIRS])) < stalk.distance(a[0].midpoint(b[0])) {
        a.reverse();
        b.reverse();
    }
    let middle: Vec<DVec2> = a.iter().zip(&b).map(|(a, b)| a.midpoint(*b)).collect();
    let line = smooth_gaussian(&middle, EVENED_WINDOW, EVENED);
    let half_width: Vec<f64> = (0..line.len())
        .map(|k| {
            let along = line[(k + 1).min(line.len() - 1)] - line[k.saturating_sub(1)];
            0.5 * (a[k] - b[k]).dot(along.normalize_or_zero().perp()).abs()
        })
        .collect();
    let widest = half_width.iter().copied().fold(0.0, f64::max);
    let (first, last) = (line[0], line[line.len() - 1]);
    let chord = (last - first).try_normalize()?.perp();
    let bow = line.iter().map(|p| (*p - first).dot(chord).abs()).fold(0.0, f64::max);
    if polyline_length(&line) < BENT_LENGTH * 2.0 * widest || bow < BOW * first.distance(last) {
        return None;
    }
    // Both ends are points of the outline, so that their width is 0.
    let half_width = (0..line.len()).map(|k| half_width[k].min(FOLDS * bend_radius(&line, k))).collect();
    Some(Body::Bent { line, half_width })
}

/// Returns the radius of the circle through a point of a line and those two before and after it; infinite at its ends.
fn bend_radius(line: &[DVec2], k: usize) -> f64 {
    let Some((a, c)) = k.checked_sub(2).and_then(|i| line.get(i)).zip(line.get(k + 2)) else {
        return f64::INFINITY;
    };
    let (p, q) = (line[k] - *a, *c - line[k]);
    let area = p.perp_dot(q).abs();
    p.length() * q.length() * (p + q).length() / (2.0 * area).max(f64::MIN_POSITIVE)
}

/// Returns both sides of an outline from one end to the other, with equally many points. The ends are the two points
/// of the outline for which opposite points are nearest.
fn sides(outline: &[DVec2]) -> Option<(Vec<DVec2>, Vec<DVec2>)> {
    let mut ring = outline.to_vec();
    ring.push(*outline.first()?);
    #[expect(clippy::cast_precision_loss, reason = "points are few")]
    let step = polyline_length(&ring) / AROUND as f64;
    let points = resample(&ring, step);
    let n = points.len().saturating_sub(1);
    if n < AROUND / 2 {
        return None;
    }
    let side = |from: usize, to: usize, back: bool| -> Vec<DVec2> {
        let count = if back { (from + n - to) % n } else { (to + n - from) % n };
        let at = |k: usize| points[if back { (from + n - k % n) % n } else { (from + k) % n }];
        (0..=PAIRS)
            .map(|p| {
                let (whole, rest) = (p * count / PAIRS, p * count % PAIRS);
                #[expect(clippy::cast_precision_loss, reason = "a share of a step")]
                let t = rest as f64 / PAIRS as f64;
                if rest == 0 { at(whole) } else { at(whole).lerp(at(whole + 1), t) }
            })
            .collect()
    };
    let pairs = (0..n).flat_map(|i| (i + n / 4..n.min(i + 1 + n - n / 4)).map(move |j| (i, j)));
    let apart = |&(i, j): &(usize, usize)| -> f64 {
        side(i, j, false).iter().zip(side(i, j, true)).map(|(a, b)| a.distance(b)).sum()
    };
    let (_, (i, j)) = pairs.map(|p| (apart(&p), p)).reduce(|a, b| if b.0 < a.0 { b } else { a })?;
    Some((side(i, j, false), side(i, j, true)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_outline_gives_a_ball() {
        let circle: Vec<DVec2> = (0..64)
            .map(|i| {
                let (s, c) = ops::sin_cos(ops::TAU * f64::from(i) / 64.0);
                DVec2::new(0.3 + 0.1 * c, 0.5 + 0.1 * s)
            })
            .collect();
        let Profile { rings, low, lopsided, aside } =
            profile(&circle, DVec2::new(0.3, 0.5), DVec2::Y).expect("a body");
        assert!((low + 0.1).abs() < 1e-6);
        for r in &rings[1..RINGS - 1] {
            assert!((r.x * r.x + (r.y - 0.1) * (r.y - 0.1) - 0.01).abs() < 2e-4, "{r}");
        }
        assert_eq!((rings[0].x, rings[RINGS - 1].x), (0.0, 0.0));
        assert!(lopsided < 0.01 && aside.abs() < 0.01);
    }

    #[test]
    fn outlines_without_extent_give_nothing() {
        assert!(profile(&[DVec2::ZERO, DVec2::X], DVec2::ZERO, DVec2::Y).is_none());
        assert!(profile(&[], DVec2::ZERO, DVec2::Y).is_none());
    }
}
