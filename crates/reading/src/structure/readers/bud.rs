//! A flower in profile that is not yet open (a rose): one petal in front and others that show above it, close together.

use geom::{bounds, convex_hull, polyline_length, signed_area};
use glam::DVec2;
use ink::{Ink, StrokeClass};

use super::super::faces::{Face, Run};
use super::{LIMITS, Part, Proposal, Scene, halves, is_leaf_from};
use crate::blade::nearest_on_ring;
use crate::palette::Brights;
use crate::{Kind, palette};

/// Requirements of a flower that is not yet open.
struct BudLimits {
    /// The petal in front covers at least this share of the enclosed area: berries of a bunch are alike.
    whole: f64,
    /// The petal in front is convex (area over that of the hull),
    convex: f64,
    /// at least this round (width over length),
    round: f64,
    /// and no line in it is longer than this share of its length.
    midrib: f64,
    /// A petal behind it lies within this of it, or of another one, in ink units, or within two widths of the pen.
    near: f64,
    /// Its middle lies above this share of the height of the petal in front,
    above: f64,
    /// it is smaller than this share of that petal,
    smaller: f64,
    /// and has at least this convexity.
    upper_convex: f64,
    /// Number of petals behind.
    uppers: core::ops::RangeInclusive<usize>,
    /// Petals behind lie along at least this share of the rim of the petal in front, above its middle: the leaves of a
    /// root or a fruit meet on top of it.
    rim: f64,
    /// All petals fill at least this share of their hull.
    full: f64,
    /// Each half of the head has at least this share of it.
    half: f64,
    /// Lines that lead out of the head do so below this share of its height.
    low: f64,
    /// Faces that are neither petal nor leaf cover less than this share of the enclosed area.
    other: f64,
    /// All bright faces of a painted flower together are more convex than this.
    painted_convex: f64,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
    /// The same of a painted flower.
    painted_likelihood: f64,
}

const BUD: BudLimits = BudLimits {
    whole: 0.55,
    convex: 0.86,
    round: 0.45,
    midrib: 0.35,
    near: 0.065,
    above: 0.55,
    smaller: 0.6,
    upper_convex: 0.72,
    uppers: 2..=8,
    rim: 0.6,
    full: 0.72,
    half: 0.3,
    low: 0.35,
    other: 0.15,
    painted_convex: 0.75,
    likelihood: 1e6,
    painted_likelihood: 500.0,
};

/// Number of places round a petal at which its rim is looked at.
const ROUND: f64 = 64.0;

pub(super) fn propose(scene: &Scene, ink: &Ink) -> Option<Proposal> {
    let area = |f: &Face| f.shape.area;
    let row =
        (0..scene.faces.len()).max_by(|&a, &b| area(&scene.faces[a]).total_cmp(&area(&scene.faces[b])))?;
    let front = &scene.faces[row];
    let (low, high) = bounds(&front.outline)?;
    if area(front) < BUD.whole * scene.enclosed() || !front.shape.notches.is_empty() {
        return None;
    }
    // A midrib makes it a leaf in front of others.
    let is_midrib = |mark: &Run| polyline_length(&mark.points) > BUD.midrib * front.shape.length();
    if scene.marks_of(row).any(is_midrib) {
        return None;
    }
    let is_painted = palette::is_painted(ink);
    let is_green = |f: &Face| {
        is_painted && f.strokes.first().is_some_and(|&k| palette::is_green_stroke(&ink.strokes[k]))
    };
    if front.shape.convexity < BUD.convex || front.shape.slenderness < BUD.round {
        return None;
    }
    let near = BUD.near.max(scene.touch.min(2.0 * LIMITS.touch));
    let may_be_upper = |f: &Face| {
        f.shape.middle.y > low.y + BUD.above * (high.y - low.y)
            && area(f) < BUD.smaller * area(front)
            && f.shape.convexity > BUD.upper_convex
            && !is_green(f)
    };
    let mut members: Vec<&Face> = vec![front];
    let is_next = |members: &[&Face], f: &Face| {
        !members.iter().any(|m| core::ptr::eq(*m, f))
            && may_be_upper(f)
            && members.iter().any(|m| is_near(f, m, near))
    };
    while let Some(next) = scene.faces.iter().find(|f| is_next(&members, f)) {
        members.push(next);
    }
    let uppers = &members[1..];
    let rim: Vec<DVec2> = geom::resample(&front.outline, front.shape.perimeter / ROUND)
        .into_iter()
        .filter(|p| p.y > front.shape.middle.y)
        .collect();
    let is_covered = |p: &&DVec2| uppers.iter().any(|f| nearest_on_ring(&f.outline, **p).1 < near);
    let covered = rim.iter().filter(is_covered).count() as f64;
    if !BUD.uppers.contains(&uppers.len()) || covered < BUD.rim * rim.len() as f64 {
        return None;
    }
    let points: Vec<DVec2> = members.iter().flat_map(|m| m.outline.iter().copied()).collect();
    let hull = convex_hull(&points);
    let covered: f64 = members.iter().map(|m| area(m)).sum();
    if covered < BUD.full * signed_area(&hull) {
        return None;
    }
    let base = nearest_on_ring(&front.outline, DVec2::new(front.shape.middle.x, low.y)).0;
    let [left, right] = halves(&hull, base.x);
    let (lowest, highest) = bounds(&hull)?;
    let leads_out = |p: &DVec2| {
        p.y > lowest.y + BUD.low * (highest.y - lowest.y)
            && !geom::contains(&hull, *p)
            && nearest_on_ring(&hull, *p).1 > near
    };
    // A trunk has two sides.
    let is_from_head = |p: &DVec2| geom::contains(&hull, *p) || nearest_on_ring(&hull, *p).1 < scene.touch;
    if scene.axes.iter().filter(|a| a.ends().iter().any(is_from_head)).count() > 1 {
        return None;
    }
    let is_even = left.min(right) >= BUD.half * (left + right);
    if !is_even || scene.axes.iter().any(|a| a.points.iter().any(leads_out)) {
        return None;
    }
    let mut parts = petals(&members, front, base);
    let heads = vec![(0..parts.len()).collect()];
    let beside =
        (0..scene.faces.len()).filter(|&k| !members.iter().any(|m| core::ptr::eq(*m, &scene.faces[k])));
    parts.extend(scene.leaves_among(beside, BUD.other)?);
    parts.extend(scene.axes.iter().map(Part::from_axis));
    Some(Proposal {
        kind: Kind::Flower,
        parts,
        heads,
        likelihood: BUD.likelihood,
        word: None,
        is_of_pieces: true,
    })
}

/// Proposes a painted flower: faces in bright colours above green ones. Its petals lead to the lowest point of all.
pub(super) fn painted(scene: &Scene, ink: &Ink) -> Option<Proposal> {
    if palette::brights(ink) != Brights::Above {
        return None;
    }
    let is_bright = |f: &Face| f.strokes.first().is_some_and(|&k| palette::is_bright_stroke(&ink.strokes[k]));
    let (bright, green): (Vec<usize>, Vec<usize>) =
        (0..scene.faces.len()).partition(|&k| is_bright(&scene.faces[k]));
    let members: Vec<&Face> = bright.iter().map(|&k| &scene.faces[k]).collect();
    let head = scene.union(&members)?;
    let front = *members.iter().max_by(|a, b| a.shape.area.total_cmp(&b.shape.area))?;
    let (low, _) = bounds(&head.outline)?;
    let is_below = |f: &Face| f.shape.middle.y < head.shape.middle.y;
    if members.len() < 2
        || head.shape.convexity < BUD.painted_convex
        || head.shape.slenderness < BUD.round
        || !green.iter().all(|&k| is_below(&scene.faces[k]))
    {
        return None;
    }
    let base = nearest_on_ring(&head.outline, DVec2::new(head.shape.middle.x, low.y)).0;
    let mut parts = petals(&members, front, base);
    let heads = vec![(0..parts.len()).collect()];
    for face in green.iter().map(|&k| &scene.faces[k]) {
        let root = scene.root_of(face).filter(|root| is_leaf_from(face, *root));
        parts.push(match root {
            Some(root) => Part::from_face(face, StrokeClass::Blade, Some(root)),
            None => stem_in(face, base),
        });
    }
    parts.extend(scene.axes.iter().map(Part::from_axis));
    let likelihood = BUD.painted_likelihood;
    Some(Proposal { kind: Kind::Flower, parts, heads, likelihood, word: None, is_of_pieces: true })
}

/// Returns the stem that a green face is: from its base, through its middle, to its lowest point.
fn stem_in(face: &Face, base: DVec2) -> Part {
    let lowest = face.outline.iter().copied().min_by(|a, b| a.y.total_cmp(&b.y)).unwrap_or(base);
    Part {
        points: vec![base, face.shape.middle, lowest],
        class: StrokeClass::Axis,
        root: None,
        strokes: face.strokes.clone(),
    }
}

/// Returns petals: the one in front as it was drawn, the others led to the base behind it.
fn petals(members: &[&Face], front: &Face, base: DVec2) -> Vec<Part> {
    let petal = |f: &&Face| {
        let points = if core::ptr::eq(*f, front) { f.outline.clone() } else { led_to(f, base) };
        Part { points, class: StrokeClass::Blade, root: Some(base), strokes: f.strokes.clone() }
    };
    members.iter().map(petal).collect()
}

/// Returns the outline of a petal behind others, completed to its base.
fn led_to(face: &Face, base: DVec2) -> Vec<DVec2> {
    convex_hull(&[&face.outline[..], &[base]].concat())
}

/// Whether a face comes within a distance of another one.
fn is_near(face: &Face, other: &Face, near: f64) -> bool {
    face.outline.iter().any(|p| nearest_on_ring(&other.outline, *p).1 < near)
}
