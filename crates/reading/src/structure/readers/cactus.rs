//! A columnar cactus: an upright body with a round top, and arms that leave its sides and turn up.

use geom::{bounds, polyline_length};
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{Axis, LIMITS, Part, Proposal, Scene};
use crate::Kind;
use crate::blade::{nearest_on_ring, ring_round};
use crate::contour::width_at;

/// Limits of the reader of cacti.
struct CactusLimits {
    /// The body covers more than this share of the enclosed area.
    whole: f64,
    /// The height of the body is more than this factor of its width,
    tall: f64,
    /// and its convexity at least this (area over that of the hull).
    convex: f64,
    /// The top is round: at this share of the height below it the width is more than this share of that of the body.
    top: [f64; 2],
    /// The foot is as wide as the body: more than this share of that.
    foot: f64,
    /// Arms leave the body between these shares of its height.
    joints: [f64; 2],
    /// An arm ends above its joint by more than this share of the body's height,
    rises: f64,
    /// and this far from the body's side, as a share of the body's width.
    off: f64,
    /// An arm that is one line is half as wide as this share of the body's width.
    half_width: f64,
    /// A line below this share of the body's height is ground.
    ground: f64,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
}

const CACTUS: CactusLimits = CactusLimits {
    whole: 0.6,
    tall: 1.5,
    convex: 0.9,
    top: [0.06, 0.35],
    foot: 0.7,
    joints: [0.1, 0.9],
    rises: 0.1,
    off: 0.25,
    half_width: 0.3,
    ground: 0.08,
    likelihood: 3000.0,
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let row = scene.main_face(CACTUS.whole)?;
    let body = &scene.faces[row];
    let (low, high) = bounds(&body.outline)?;
    let size = high - low;
    if size.y < CACTUS.tall * size.x
        || body.shape.convexity < CACTUS.convex
        || !has_round_top(body, low, size)
    {
        return None;
    }
    let is_ground = |points: &[DVec2]| points.iter().all(|p| p.y < low.y + CACTUS.ground * size.y);
    let mut parts = vec![Part::from_face(body, StrokeClass::TrunkOutline, None)];
    for axis in scene.axes.iter().filter(|a| !is_ground(&a.points)) {
        let line = arm(&axis.points, body, low, size)?;
        let points = column(&line, CACTUS.half_width * size.x)?;
        let strokes = vec![axis.stroke];
        parts.push(Part { points, class: StrokeClass::TrunkOutline, root: Some(line[0]), strokes });
    }
    for face in (0..scene.faces.len()).filter(|k| *k != row).map(|k| &scene.faces[k]) {
        let [a, b] = face.shape.ends;
        arm(&[a, b], body, low, size)?;
        parts.push(Part::from_face(face, StrokeClass::TrunkOutline, None));
    }
    let arms = parts.len() - 1;
    parts.extend(scene.axes.iter().filter(|a| is_ground(&a.points)).map(ground));
    let likelihood = CACTUS.likelihood;
    let word = Some("cactus");
    (arms > 0).then_some(Proposal {
        kind: Kind::Cactus,
        parts,
        heads: Vec::new(),
        likelihood,
        word,
        is_of_pieces: false,
    })
}

fn ground(axis: &Axis) -> Part {
    Part { class: StrokeClass::Ground, ..Part::from_axis(axis) }
}

/// Whether a body is a column that is closed by a dome: neither a cone nor a bottle.
fn has_round_top(body: &Face, low: DVec2, size: DVec2) -> bool {
    let width = |share: f64| width_at(&body.outline, low.y + share * size.y);
    let middle = width(0.5);
    width(1.0 - CACTUS.top[0]) > CACTUS.top[1] * middle && width(CACTUS.top[0]) > CACTUS.foot * middle
}

/// Returns a line from its joint with the body outwards, if it is an arm.
fn arm(line: &[DVec2], body: &Face, low: DVec2, size: DVec2) -> Option<Vec<DVec2>> {
    let off = |p: &DVec2| nearest_on_ring(&body.outline, *p).1;
    let mut line = line.to_vec();
    if off(line.last()?) < off(line.first()?) {
        line.reverse();
    }
    let (joint, tip) = (*line.first()?, *line.last()?);
    let level = (joint.y - low.y) / size.y;
    let is_arm = off(&joint) < LIMITS.touch
        && (CACTUS.joints[0]..CACTUS.joints[1]).contains(&level)
        && tip.y > joint.y + CACTUS.rises * size.y
        && off(&tip) > CACTUS.off * size.x;
    is_arm.then_some(line)
}

/// Returns the outline of a column round a line.
fn column(line: &[DVec2], half_width: f64) -> Option<Vec<DVec2>> {
    let spine = geom::resample(line, polyline_length(line) / 24.0);
    let tip = *spine.last()?;
    // The tip is round.
    let half_width_at = |i: usize| {
        let past = (spine[i].distance(tip) / half_width).min(1.0);
        half_width * (past * (2.0 - past)).sqrt()
    };
    let ring = ring_round(&spine, half_width_at);
    let mut outline = geom::simple_outline(&ring)?;
    outline.extend(outline.first().copied());
    Some(outline)
}
