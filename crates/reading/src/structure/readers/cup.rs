//! A flower in profile: petals that rise from one base like a fan, with their tips above (tulip, lotus, crocus).

use geom::convex_hull;
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{Axis, Part, Proposal, Scene, halves};
use crate::Kind;
use crate::blade::nearest_on_ring;

/// Requirements of a flower in profile. Shares of the height of the head.
struct CupLimits {
    /// The stem is attached below this height,
    base: f64,
    /// in the middle of the head: within this share of its width to either side.
    middle: f64,
    /// At the first height a head without a stem has at least the second share of its width: a crown stands on a
    /// trunk.
    foot: [f64; 2],
    /// Its tips lie above this height.
    tips: f64,
    /// Its notches lie above this height.
    notches: f64,
    /// Number of petals: faces with a tip each, or lobes of one face.
    petals: core::ops::RangeInclusive<usize>,
    /// Least convexity of a petal (area over that of the hull),
    convex: f64,
    /// at least this many are visible down to their base,
    in_front: usize,
    /// and the area of a petal completed behind others is at most this factor of its visible part.
    hidden: f64,
    /// That factor for a petal that stands behind the others.
    behind: f64,
    /// Greatest area of the largest petal relative to the smallest.
    alike: f64,
    /// A line that goes farther than this from the head leads out of it.
    leads_out: f64,
    /// Tips fan out to both sides: on average within this share of the width from the base.
    fanned: f64,
    /// The visible part of a petal comes nearer to its base than this share of its length.
    seen: f64,
    /// Petals cover more than this share of the head; the rest are leaves that float or bracts.
    most: f64,
    /// The halves of the head left and right of its base differ by less than this share of it,
    lopsided: f64,
    /// or by less than this without a stem.
    stemless_lopsided: f64,
    /// A single face has no corner in its lower half except within this distance of its base,
    low_corner: f64,
    /// and has at least this convexity,
    whole_convex: f64,
    /// and at most this many notches.
    most_notches: usize,
    /// Least height and width of the head, as shares of the drawing's diagonal.
    size: f64,
    /// Faces that are neither petal nor leaf cover less than this share of the enclosed area.
    other: f64,
    /// See [`Proposal::likelihood`], if two petals are visible down to their base, and if one is.
    likelihood: [f64; 2],
}

const CUP: CupLimits = CupLimits {
    base: 0.3,
    middle: 0.3,
    foot: [0.15, 0.3],
    tips: 0.5,
    notches: 0.35,
    petals: 3..=9,
    convex: 0.72,
    in_front: 2,
    hidden: 2.2,
    behind: 8.0,
    alike: 7.0,
    leads_out: 0.06,
    fanned: 0.22,
    seen: 0.4,
    most: 0.6,
    lopsided: 0.35,
    stemless_lopsided: 0.2,
    low_corner: 0.3,
    whole_convex: 0.7,
    most_notches: 3,
    size: 0.2,
    other: 0.12,
    likelihood: [30_000.0, 1000.0],
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let (members, head) = scene.highest_group()?;
    let faces: Vec<&Face> = members.iter().map(|&k| &scene.faces[k]).collect();
    let (low, high) = geom::bounds(&head.outline)?;
    let size = high - low;
    if size.min_element() < CUP.size {
        return None;
    }
    let at_base = |p: DVec2| {
        p.y < low.y + CUP.base * size.y && (p.x - low.midpoint(high).x).abs() < CUP.middle * size.x
    };
    // No line leads out of it above its base, and at most one stem below: a trunk has two sides.
    let off_head = |p: DVec2| {
        if geom::contains(&head.outline, p) { 0.0 } else { nearest_on_ring(&head.outline, p).1 }
    };
    let leads_out = |line: &[DVec2]| line.iter().map(|&p| off_head(p)).fold(0.0, f64::max) > CUP.leads_out;
    let out: Vec<&Vec<DVec2>> = scene.axes.iter().map(|a| &a.points).filter(|l| leads_out(l)).collect();
    let from_head = out.iter().filter(|l| off_head(l[0]).min(off_head(l[l.len() - 1])) < scene.touch).count();
    if from_head > 1 || out.iter().any(|l| l.iter().any(|p| p.y > low.y + CUP.tips * size.y)) {
        return None;
    }
    let goes_below = |axis: &Axis| axis.points.iter().any(|q| q.y < low.y - scene.touch);
    let is_stem_end = |p: DVec2| {
        nearest_on_ring(&head.outline, p).1 < scene.touch
            || scene.axes.iter().any(|a| goes_below(a) && a.points.contains(&p))
    };
    let stem = scene.axes.iter().flat_map(Axis::ends).find(|&p| at_base(p) && is_stem_end(p));
    let base = match stem {
        Some(p) => nearest_on_ring(&head.outline, p).0,
        None => {
            let middle = DVec2::new(low.midpoint(high).x, low.y);
            nearest_on_ring(&head.outline, middle).0
        }
    };
    let foot = crate::contour::width_at(&head.outline, low.y + CUP.foot[0] * size.y);
    if stem.is_none() && foot < CUP.foot[1] * size.x {
        return None;
    }
    let [left, right] = halves(&head.outline, base.x);
    let lopsided = if stem.is_some() { CUP.lopsided } else { CUP.stemless_lopsided };
    if (right - left).abs() > lopsided * (right + left) {
        return None;
    }
    let (petals, in_front) = match faces.len() {
        1 => (lobes(&head, base, low.y, size.y)?, CUP.in_front),
        _ => fan(&faces, base, low.y, size)?,
    };
    if in_front < CUP.in_front && stem.is_none() {
        return None;
    }
    let mut parts: Vec<Part> = petals
        .into_iter()
        .map(|(points, strokes)| Part { points, class: StrokeClass::Blade, root: Some(base), strokes })
        .collect();
    let heads = vec![(0..parts.len()).collect()];
    let beside = || (0..scene.faces.len()).filter(|k| !members.contains(k));
    if beside().map(|k| scene.faces[k].shape.area).fold(0.0, f64::max) > head.shape.area {
        return None;
    }
    parts.extend(scene.leaves_among(beside(), CUP.other)?);
    parts.extend(scene.axes.iter().map(Part::from_axis));
    let likelihood = CUP.likelihood[usize::from(in_front < CUP.in_front)];
    Some(Proposal { kind: Kind::Flower, parts, heads, likelihood, word: None, is_of_pieces: false })
}

type Petal = (Vec<DVec2>, Vec<usize>);

/// Returns faces that rise from the base, each with a tip, extended to the base if they are hidden; and the number of
/// those visible down to it.
fn fan(faces: &[&Face], base: DVec2, low: f64, size: DVec2) -> Option<(Vec<Petal>, usize)> {
    let height = size.y;
    let tip = |f: &Face| f.shape.tip_from(base);
    let rises = |f: &&&Face| tip(f).is_some_and(|t| t.y > low + CUP.notches * height);
    let petals: Vec<&&Face> = faces.iter().filter(rises).collect();
    let area = |list: &[&&Face]| list.iter().map(|f| f.shape.area).sum::<f64>();
    let whole: f64 = faces.iter().map(|f| f.shape.area).sum();
    let largest = petals.iter().map(|f| f.shape.area).fold(0.0, f64::max);
    let is_seen = |f: &Face| {
        let length = tip(f).map_or(0.0, |t| t.distance(base));
        nearest_on_ring(&f.outline, base).1 < CUP.seen * length
    };
    // For a petal behind others the tip is enough.
    let in_front: Vec<&&&Face> = petals.iter().filter(|f| is_seen(f)).collect();
    let sound = |f: &&&&Face| f.shape.convexity > CUP.convex && CUP.alike * f.shape.area > largest;
    if !CUP.petals.contains(&petals.len())
        || in_front.is_empty()
        || !in_front.iter().all(sound)
        || area(&petals) < CUP.most * whole
    {
        return None;
    }
    let mean = petals.iter().filter_map(|f| tip(f)).sum::<DVec2>() / petals.len() as f64;
    // They rise: petals all round a middle belong to a flower seen from the front.
    if mean.y < low + CUP.tips * height || (mean.x - base.x).abs() > CUP.fanned * size.x {
        return None;
    }
    let led = |f: &&&Face| {
        let mut points = f.outline.clone();
        points.push(base);
        let hull = convex_hull(&points);
        let most = if is_seen(f) { CUP.hidden } else { CUP.behind };
        (geom::signed_area(&hull) < most * f.shape.area).then(|| (hull, f.strokes.clone()))
    };
    Some((petals.iter().map(led).collect::<Option<_>>()?, in_front.len()))
}

/// Cuts one face whose upper side has tips and notches into lobes, from the notches to the base.
fn lobes(head: &Face, base: DVec2, low: f64, height: f64) -> Option<Vec<Petal>> {
    let is_high = |p: &&DVec2, least: f64| p.y > low + least * height;
    let tips = head.shape.corners.iter().filter(|p| is_high(p, CUP.tips)).count();
    let notches: Vec<DVec2> =
        head.shape.notches.iter().filter(|p| is_high(p, CUP.notches)).copied().collect();
    let low_corners = head
        .shape
        .corners
        .iter()
        .filter(|p| !is_high(p, CUP.tips) && p.distance(base) > CUP.low_corner * height);
    if tips + 1 < *CUP.petals.start()
        || notches.is_empty()
        || notches.len() < head.shape.notches.len()
        || notches.len() > CUP.most_notches
        || head.shape.convexity < CUP.whole_convex
        || low_corners.count() > 0
    {
        return None;
    }
    let n = head.outline.len();
    let nearest = |p: DVec2| {
        (0..n).min_by(|&a, &b| {
            head.outline[a].distance_squared(p).total_cmp(&head.outline[b].distance_squared(p))
        })
    };
    // Counter-clockwise from the base: up the right side, over the tips, down the left.
    let start = nearest(base)?;
    let mut cuts: Vec<usize> = notches.iter().filter_map(|&p| Some((nearest(p)? + n - start) % n)).collect();
    base::sort_by(&mut cuts, usize::cmp);
    cuts.insert(0, 0);
    cuts.push(n);
    let lobe = |w: &[usize]| {
        let mut points: Vec<DVec2> =
            (w[0]..=w[1].min(n - 1)).map(|k| head.outline[(start + k) % n]).collect();
        points.push(base);
        (points, head.strokes.clone())
    };
    Some(cuts.windows(2).map(lobe).collect())
}
