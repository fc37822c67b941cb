//! A conifer in outline: a crown with its apex in the middle, widest at its foot, over a trunk.

use geom::{bounds, polyline_length};
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{Part, Proposal, Scene};
use crate::Kind;
use crate::contour::runs_at;

/// Requirements of a conifer. Shares of the crown's height or width.
struct ConiferLimits {
    /// The crown covers more than this share of the enclosed area.
    whole: f64,
    /// Tiers have more than this share of the area of the largest.
    tier: f64,
    /// The lowest face is the trunk if its width is below this share of the widest.
    trunk_wide: f64,
    /// Its apex lies within this share of its width from its middle,
    centred: f64,
    /// and is narrower than this at a tenth of the height below the top.
    pointed: f64,
    /// Its foot is wider than this share of the widest level.
    foot: f64,
    /// It is widest below this height.
    widest: f64,
    /// At each level, left and right of the apex differ by less than this share of the width.
    lopsided: f64,
    /// Its height is at least this share of its width.
    tall: f64,
    /// It has no level narrower than this share of the widest of those above: tiers, no necks.
    tiers: f64,
    /// Levels at which it is measured.
    levels: usize,
    /// Greatest share of its box that it fills: a triangle fills this much; a dome fills more.
    full: f64,
    /// Its trunk is in this lowest part of it,
    trunk_low: f64,
    /// is this near to its middle,
    trunk_middle: f64,
    /// and reaches below it by more than this, ink units.
    trunk_below: f64,
    /// No line outside is longer than this.
    longest_line: f64,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
}

const CONIFER: ConiferLimits = ConiferLimits {
    whole: 0.7,
    tier: 0.12,
    trunk_wide: 0.5,
    centred: 0.12,
    pointed: 0.42,
    foot: 0.4,
    widest: 0.45,
    lopsided: 0.22,
    tall: 0.75,
    tiers: 0.45,
    levels: 16,
    full: 0.68,
    trunk_low: 0.3,
    trunk_middle: 0.3,
    trunk_below: 0.02,
    longest_line: 0.6,
    likelihood: 5000.0,
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let largest = scene.faces.iter().map(|f| f.shape.area).fold(0.0, f64::max);
    // One outline, or tiers one over the other.
    let trunk = trunk_among(&scene.faces);
    let is_tier = |&k: &usize| trunk != Some(k) && scene.faces[k].shape.area > CONIFER.tier * largest;
    let tiers: Vec<&Face> = (0..scene.faces.len()).filter(is_tier).map(|k| &scene.faces[k]).collect();
    let face = match tiers[..] {
        [one] => one.clone(),
        _ => scene.union(&tiers)?,
    };
    let trunk_area = trunk.map_or(0.0, |k| scene.faces[k].shape.area);
    if face.shape.area < CONIFER.whole * (scene.enclosed() - trunk_area) || !is_crown(&face) {
        return None;
    }
    let (low, high) = bounds(&face.outline)?;
    // The trunk: lines or a face below the crown, in its middle.
    let below = |p: DVec2| {
        p.y < low.y + CONIFER.trunk_low * (high.y - low.y)
            && (p.x - low.midpoint(high).x).abs() < CONIFER.trunk_middle * (high.x - low.x)
    };
    let stands = |points: &[DVec2]| {
        bounds(points).is_some_and(|(a, b)| a.y < low.y - CONIFER.trunk_below && below(a.midpoint(b)))
    };
    let trunk_face = (0..scene.faces.len()).find(|k| !is_tier(k) && stands(&scene.faces[*k].outline));
    let lines: Vec<_> = scene.lines.iter().filter(|l| stands(&l.points)).collect();
    if trunk_face.is_none() && lines.is_empty() {
        return None;
    }
    if scene.lines.iter().any(|l| polyline_length(&l.points) > CONIFER.longest_line * (high.y - low.y)) {
        return None;
    }
    let mut parts = vec![Part::from_face(&face, StrokeClass::Crown, None)];
    match trunk_face {
        Some(k) => parts.push(Part::from_face(&scene.faces[k], StrokeClass::TrunkOutline, None)),
        None => {
            let class = if lines.len() > 1 { StrokeClass::TrunkOutline } else { StrokeClass::Axis };
            parts.extend(lines.iter().map(|l| Part::from_run(l, class)));
        }
    }
    Some(Proposal {
        kind: Kind::Conifer,
        parts,
        heads: Vec::new(),
        likelihood: CONIFER.likelihood,
        word: None,
        is_of_pieces: false,
    })
}

/// The row of the lowest face, if it is much narrower than the widest: tiers widen downwards, so that is the trunk.
fn trunk_among(faces: &[Face]) -> Option<usize> {
    let width = |f: &Face| bounds(&f.outline).map_or(0.0, |(low, high)| high.x - low.x);
    let lowest =
        (0..faces.len()).min_by(|&a, &b| faces[a].shape.middle.y.total_cmp(&faces[b].shape.middle.y))?;
    let widest = faces.iter().map(width).fold(0.0, f64::max);
    (width(&faces[lowest]) < CONIFER.trunk_wide * widest).then_some(lowest)
}

/// Whether an outline is the crown of a conifer.
fn is_crown(face: &Face) -> bool {
    let outline = &face.outline;
    let Some((low, high)) = bounds(outline) else { return false };
    let size = high - low;
    let Some(apex) = outline.iter().max_by(|a, b| a.y.total_cmp(&b.y)) else { return false };
    let centred = (apex.x - low.midpoint(high).x).abs() < CONIFER.centred * size.x;
    let level = |k: usize| {
        let y = high.y - (k as f64 + 0.5) / CONIFER.levels as f64 * size.y;
        let runs = runs_at(outline, y);
        Some((runs.first()?.0, runs.last()?.1))
    };
    let Some(levels) = (0..CONIFER.levels).map(level).collect::<Option<Vec<(f64, f64)>>>() else {
        return false;
    };
    let widths: Vec<f64> = levels.iter().map(|(a, b)| b - a).collect();
    let even = levels.iter().all(|(a, b)| ((b - apex.x) - (apex.x - a)).abs() < CONIFER.lopsided * size.x);
    let most = widths.iter().copied().fold(0.0, f64::max);
    let widest = widths.iter().position(|w| *w == most).unwrap_or(0);
    let mut before: f64 = 0.0;
    let tiered = widths.iter().all(|&w| {
        let ok = w > CONIFER.tiers * before;
        before = before.max(w);
        ok
    });
    centred
        && even
        && tiered
        && widths[CONIFER.levels - 1] > CONIFER.foot * most
        && widths[1] < CONIFER.pointed * most
        && widest as f64 > (1.0 - CONIFER.widest) * CONIFER.levels as f64
        && size.y > CONIFER.tall * size.x
        && face.shape.area < CONIFER.full * size.x * size.y
}
