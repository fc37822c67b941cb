//! One fruit: a round body with ribs, and at most a short stalk on top.

use geom::bounds;
use glam::DVec2;
use ink::StrokeClass;

use super::{Part, Proposal, Scene, has_straight_side, length_of};
use crate::Kind;

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
    /// See [`Proposal::likelihood`].
    likelihood: f64,
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
    likelihood: 20.0,
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let row = scene.main_face(FRUIT.whole)?;
    let body = &scene.faces[row];
    let (low, high) = bounds(&body.outline)?;
    let height = high.y - low.y;
    let is_rib = |points: &[DVec2]| bounds(points).is_some_and(|(lo, hi)| hi.y - lo.y > FRUIT.rib * height);
    let ribs = scene.marks_of(row).filter(|mark| is_rib(&mark.points)).count();
    let on_top = |p: &DVec2| p.y > low.y + FRUIT.top * height;
    if body.shape.convexity < FRUIT.convex
        || body.shape.slenderness < FRUIT.round
        || has_straight_side(body)
        || ribs < FRUIT.ribs
        || scene.lines.len() > FRUIT.stalks
        || length_of(scene.lines.iter()) > FRUIT.stalk * body.shape.length()
        || !scene.lines.iter().all(|l| l.points.iter().all(on_top))
    {
        return None;
    }
    let mut parts = vec![Part::of_face(body, StrokeClass::Fruit, None)];
    parts.extend(scene.lines.iter().map(|line| Part::of_run(line, StrokeClass::Axis)));
    let (heads, likelihood) = (Vec::new(), FRUIT.likelihood);
    Some(Proposal { kind: Kind::Fruit, parts, heads, likelihood, word: None })
}
