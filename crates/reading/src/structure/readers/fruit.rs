//! One fruit: a round body with ribs or with leaves on it, and at most a short stalk on top; or a slice of one.

use geom::bounds;
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::{Face, Run};
use super::{Axis, Part, Proposal, Scene, has_straight_side, length_of};
use crate::Kind;
use crate::blade::nearest_on_ring;

/// Requirements of a fruit.
struct FruitLimits {
    /// It covers at least this share of the enclosed area.
    whole: f64,
    /// Its least convexity.
    convex: f64,
    /// Its least roundness (width over length).
    round: f64,
    /// Fewest ribs: lines on it that run from end to end.
    ribs: usize,
    /// A rib is at least this share of its height.
    rib: f64,
    /// Most lines outside: stalks.
    stalks: usize,
    /// All stalks together are at most this share of its length.
    stalk: f64,
    /// Stalks lie above this share of its height.
    top: f64,
    /// A body with leaves covers at least this share of the enclosed area,
    leafy_whole: f64,
    /// and has at least this convexity: somebody may have bitten into it.
    leafy_convex: f64,
    /// Most leaves on a body.
    leaves: usize,
    /// A leaf covers at most this share of the area of the body,
    leaf: f64,
    /// and has at least this convexity,
    leaf_convex: f64,
    /// and is at most this round (width over length).
    leaf_round: f64,
    /// Leaves reach down at most to this share of the body's height, and their middles lie above the body's.
    leaf_low: f64,
    /// A slice has at least this convexity,
    slice_convex: f64,
    /// and a slenderness in this range: half a disc has about 0.53.
    slice_slender: core::ops::Range<f64>,
    /// A slice covers at least this share of the enclosed area.
    slice_whole: f64,
    /// See [`Proposal::likelihood`], for a body with ribs, one with leaves, and a slice.
    likelihood: [f64; 3],
}

const FRUIT: FruitLimits = FruitLimits {
    whole: 0.85,
    convex: 0.9,
    round: 0.6,
    ribs: 2,
    rib: 0.5,
    stalks: 2,
    stalk: 0.7,
    top: 0.7,
    leafy_whole: 0.7,
    leafy_convex: 0.8,
    leaves: 3,
    leaf: 0.3,
    leaf_convex: 0.7,
    leaf_round: 0.85,
    leaf_low: 0.6,
    slice_convex: 0.94,
    slice_slender: 0.3..0.75,
    slice_whole: 0.9,
    likelihood: [20.0, 200.0, 400.0],
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    with_ribs(scene).or_else(|| with_leaves(scene)).or_else(|| slice(scene))
}

fn proposal(parts: Vec<Part>, likelihood: f64) -> Proposal {
    let (kind, heads) = (Kind::Fruit, Vec::new());
    Proposal { kind, parts, heads, likelihood, word: None, is_of_pieces: true }
}

fn with_ribs(scene: &Scene) -> Option<Proposal> {
    let row = scene.main_face(FRUIT.whole)?;
    let body = &scene.faces[row];
    let (low, high) = bounds(&body.outline)?;
    let height = high.y - low.y;
    let is_rib = |points: &[DVec2]| bounds(points).is_some_and(|(lo, hi)| hi.y - lo.y > FRUIT.rib * height);
    let ribs = scene.marks_of(row).filter(|mark| is_rib(&mark.points)).count();
    if body.shape.convexity < FRUIT.convex
        || body.shape.slenderness < FRUIT.round
        || has_straight_side(body)
        || ribs < FRUIT.ribs
        || !has_stalks_only(scene, body)
    {
        return None;
    }
    let mut parts = vec![Part::from_face(body, StrokeClass::Fruit, None)];
    parts.extend(scene.lines.iter().map(|line| Part::from_run(line, StrokeClass::Axis)));
    Some(Proposal { is_of_pieces: false, ..proposal(parts, FRUIT.likelihood[0]) })
}

/// Whether the lines outside are at most a few short stalks on top of a body.
fn has_stalks_only(scene: &Scene, body: &Face) -> bool {
    let Some((low, high)) = bounds(&body.outline) else { return false };
    let on_top = |p: &DVec2| p.y > low.y + FRUIT.top * (high.y - low.y);
    scene.lines.len() <= FRUIT.stalks
        && length_of(scene.lines.iter()) <= FRUIT.stalk * body.shape.length()
        && scene.lines.iter().all(|l| l.points.iter().all(on_top))
}

/// Proposes a body with leaves above it. Leaves that touch neither the body nor a stalk get a stalk.
fn with_leaves(scene: &Scene) -> Option<Proposal> {
    let row = scene.main_face(FRUIT.leafy_whole)?;
    let body = &scene.faces[row];
    let (low, high) = bounds(&body.outline)?;
    let floor = low.y + FRUIT.leaf_low * (high.y - low.y);
    let is_leaf = |face: &&Face| {
        let shape = &face.shape;
        shape.area < FRUIT.leaf * body.shape.area
            && shape.convexity > FRUIT.leaf_convex
            && shape.slenderness < FRUIT.leaf_round
            && shape.middle.y > body.shape.middle.y
            && bounds(&face.outline).is_some_and(|(lo, _)| lo.y > floor)
    };
    let leaves: Vec<&Face> = (0..scene.faces.len()).filter(|k| *k != row).map(|k| &scene.faces[k]).collect();
    if !(1..=FRUIT.leaves).contains(&leaves.len())
        || !leaves.iter().all(is_leaf)
        || body.shape.convexity < FRUIT.leafy_convex
        || body.shape.slenderness < FRUIT.round
        || has_straight_side(body)
        || !has_stalks_only(scene, body)
    {
        return None;
    }
    let top = nearest_on_ring(&body.outline, DVec2::new(low.midpoint(high).x, high.y)).0;
    let mut parts = vec![Part::from_face(body, StrokeClass::Fruit, None)];
    parts.extend(scene.lines.iter().map(|line| Part::from_run(line, StrokeClass::Axis)));
    for leaf in leaves {
        let (root, stalk) = root_on(scene, body, leaf, top);
        parts.push(Part::from_face(leaf, StrokeClass::Blade, Some(root)));
        parts.extend(stalk);
    }
    Some(proposal(parts, FRUIT.likelihood[1]))
}

/// Returns where a leaf is attached, and the stalk that joins it to the top of the body if it touches nothing.
fn root_on(scene: &Scene, body: &Face, leaf: &Face, top: DVec2) -> (DVec2, Option<Part>) {
    let ends = |line: &Run| [line.points[0], line.points[line.points.len() - 1]];
    let places = scene.lines.iter().flat_map(ends).chain([top]);
    let nearest = |p: DVec2| nearest_on_ring(&leaf.outline, p);
    let (root, off) = places.map(nearest).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_else(|| nearest(top));
    let touches_body = nearest_on_ring(&body.outline, root).1 < scene.touch;
    if off < scene.touch || touches_body {
        return (root, None);
    }
    let strokes = leaf.strokes.clone();
    let stalk = Part { points: vec![top, root], class: StrokeClass::Axis, root: None, strokes };
    (root, Some(stalk))
}

/// Proposes a slice: faces that make half a disc together.
fn slice(scene: &Scene) -> Option<Proposal> {
    let faces: Vec<&Face> = scene.faces.iter().collect();
    let whole = match faces[..] {
        [] => return None,
        [one] => one.clone(),
        _ => scene.union(&faces)?,
    };
    let is_slice = whole.shape.convexity > FRUIT.slice_convex
        && FRUIT.slice_slender.contains(&whole.shape.slenderness)
        && whole.shape.area > FRUIT.slice_whole * scene.enclosed()
        && has_straight_side(&whole);
    let has_flesh = faces.len() > 1 || !scene.marks.is_empty();
    let is_alone = scene.lines.is_empty() && scene.axes.iter().all(|a| is_within(a, &whole, scene.touch));
    let body = vec![Part::from_face(&whole, StrokeClass::Fruit, None)];
    let slice = Proposal { word: Some("watermelon"), ..proposal(body, FRUIT.likelihood[2]) };
    (is_slice && has_flesh && is_alone).then_some(slice)
}

/// Whether a line lies in a face, or within a distance of it.
fn is_within(axis: &Axis, face: &Face, touch: f64) -> bool {
    axis.points
        .iter()
        .all(|&p| geom::contains(&face.outline, p) || nearest_on_ring(&face.outline, p).1 < touch)
}
