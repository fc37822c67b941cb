//! A pot: a body with a flat foot and a level rim at the foot of the drawing, in which a stem or a leaf stands.

use geom::bounds;
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{Axis, Part, Scene, adjoins};
use crate::contour::width_at;

/// Requirements of a pot. Heights are shares of its own.
struct PotLimits {
    /// Its foot is within this share of the height of the drawing from its lower edge.
    foot: f64,
    /// It is at most this share of the height of the drawing.
    high: f64,
    /// Its least convexity.
    convex: f64,
    /// Heights at which its width is measured: near its rim and near its foot.
    levels: [f64; 2],
    /// Least widths there, as shares of its greatest width.
    wide: [f64; 2],
    /// Corners of the rim lie above this height; a fruit has none there.
    corners: f64,
    /// Its stem ends above this height.
    stem: f64,
    /// Greatest area of its rim relative to its body.
    rim: f64,
}

const POT: PotLimits = PotLimits {
    foot: 0.05,
    high: 0.6,
    convex: 0.85,
    levels: [0.9, 0.1],
    wide: [0.8, 0.4],
    corners: 0.8,
    stem: 0.85,
    rim: 0.8,
};

/// Returns the pot and the rows of the faces that it is made of, ascending: a body, and its rim if that is a face of its
/// own.
pub(super) fn find(scene: &Scene) -> Option<(Part, Vec<usize>)> {
    let faces = &scene.faces;
    for (row, body) in faces.iter().enumerate() {
        let (low, high) = bounds(&body.outline)?;
        if low.y > scene.low.y + POT.foot * (scene.high.y - scene.low.y) {
            continue;
        }
        let is_rim = |k: &usize| {
            *k != row
                && faces[*k].shape.area < POT.rim * body.shape.area
                && faces[*k].shape.middle.y > high.y
                && bounds(&faces[*k].outline).is_some_and(|(l, h)| h.x - l.x > high.x - low.x)
                && adjoins(&faces[*k], body)
        };
        let rim = (0..faces.len()).find(is_rim);
        let whole = rim.and_then(|k| scene.union(&[body, &faces[k]]));
        if let (Some(rim), Some(whole)) = (rim, whole.filter(|pot| is_pot(scene, pot))) {
            let rows = if rim < row { vec![rim, row] } else { vec![row, rim] };
            return Some((Part::from_face(&whole, StrokeClass::Pot, None), rows));
        }
        if is_pot(scene, body) {
            return Some((Part::from_face(body, StrokeClass::Pot, None), vec![row]));
        }
    }
    None
}

fn is_pot(scene: &Scene, face: &Face) -> bool {
    let Some((low, high)) = bounds(&face.outline) else { return false };
    let size = high - low;
    let width = |share: f64| width_at(&face.outline, low.y + share * size.y);
    let is_wide = POT.levels.iter().zip(&POT.wide).all(|(level, wide)| width(*level) > wide * size.x);
    let corners = face.shape.corners.iter().filter(|p| p.y > low.y + POT.corners * size.y).count();
    let is_in = |p: DVec2| {
        p.x > low.x && p.x < high.x && p.y > low.y + POT.stem * size.y && p.y < high.y + scene.touch
    };
    let stands = |stem: &Axis| {
        let [foot, top] = stem.foot_and_top();
        is_in(foot) && top.y > high.y + scene.touch
    };
    size.y < POT.high * (scene.high.y - scene.low.y)
        && face.shape.convexity > POT.convex
        && is_wide
        && corners >= 2
        && scene.axes.iter().any(stands)
}
