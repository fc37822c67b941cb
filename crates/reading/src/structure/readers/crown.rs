//! A broad-leaved tree: a crown in one outline with a flat foot, on a trunk that is a single line.

use geom::bounds;
use ink::StrokeClass;

use super::{Part, Proposal, Scene};
use crate::Kind;
use crate::contour::width_at;

/// Requirements of a crown with a flat foot. Shares of its height or width.
struct CrownLimits {
    /// It covers more than this share of the enclosed area.
    whole: f64,
    /// Its least convexity.
    convex: f64,
    /// Near its foot it has at least this share of its whole width,
    flat: f64,
    /// at this height,
    flat_at: f64,
    /// and near its top at most this share,
    top: f64,
    /// at this height.
    top_at: f64,
    /// Its trunk is in its middle, within this share of its width,
    central: f64,
    /// and reaches below it by at least this share of its height.
    trunk: f64,
    /// See [`Proposal::likelihood`]: a mushroom stands on two lines.
    likelihood: f64,
}

const CROWN: CrownLimits = CrownLimits {
    whole: 0.9,
    convex: 0.8,
    flat: 0.75,
    flat_at: 0.12,
    top: 0.75,
    top_at: 0.88,
    central: 0.15,
    trunk: 0.25,
    likelihood: 300.0,
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let row = scene.main_face(CROWN.whole)?;
    let face = &scene.faces[row];
    let [line] = &scene.lines[..] else { return None };
    let (low, high) = bounds(&face.outline)?;
    let size = high - low;
    let (foot, top) = bounds(&line.points)?;
    let width = |share: f64| width_at(&face.outline, low.y + share * size.y);
    let is_central = (foot.midpoint(top).x - low.midpoint(high).x).abs() < CROWN.central * size.x
        && top.x - foot.x < CROWN.central * size.x;
    let is_crown = face.shape.convexity > CROWN.convex
        && size.x > size.y
        && width(CROWN.flat_at) > CROWN.flat * size.x
        && width(CROWN.top_at) < CROWN.top * size.x
        && low.y - foot.y > CROWN.trunk * size.y
        && (top.y - low.y).abs() < scene.touch;
    (is_central && is_crown).then(|| Proposal {
        kind: Kind::Tree,
        parts: vec![Part::from_face(face, StrokeClass::Crown, None), Part::from_run(line, StrokeClass::Axis)],
        heads: Vec::new(),
        likelihood: CROWN.likelihood,
        word: None,
        is_of_pieces: false,
    })
}
