//! A mushroom: a cap like half a ball, and in its middle a stem that is narrower and stands below it.

use geom::bounds;
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{LIMITS, Part, Proposal, Scene, length_of};
use crate::Kind;
use crate::blade::nearest_on_ring;
use crate::contour::runs_at;

/// What a mushroom must have. Heights are counted along the line from the middle of its stem to the middle of its cap.
struct MushroomLimits {
    /// That line is this steep at least (its sine).
    upright: f64,
    /// Its cap is at least so convex,
    convex: f64,
    /// and covers at least this share of its box: more than a triangle, which is a conifer.
    full: f64,
    /// Its cap is at least so wide, in heights,
    wide: f64,
    /// and widest below this share of its height: a crown is widest in its middle.
    widest: f64,
    /// Its stem is between so wide and so wide, a share of the cap's width,
    stem_wide: [f64; 2],
    /// goes on below the cap by at least this share of the cap's height,
    stem_long: f64,
    /// and begins within this share of the cap's width from its middle.
    central: f64,
    /// Lines outside are at most this share of the cap's outline.
    lines: f64,
    /// Levels of the cap at which its width is measured.
    levels: usize,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
}

const MUSHROOM: MushroomLimits = MushroomLimits {
    upright: 0.6,
    convex: 0.88,
    full: 0.62,
    wide: 1.05,
    widest: 0.4,
    stem_wide: [0.1, 0.72],
    stem_long: 0.25,
    central: 0.2,
    lines: 0.15,
    levels: 16,
    likelihood: 12.0,
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let (cap, stem) = (0..scene.faces.len()).find_map(|k| cap_over(scene, k))?;
    if length_of(scene.lines.iter()) > MUSHROOM.lines * cap.shape.perimeter {
        return None;
    }
    let parts = [&cap, stem].map(|face| Part::of_face(face, StrokeClass::Fruit, None)).to_vec();
    let likelihood = MUSHROOM.likelihood;
    Some(Proposal { kind: Kind::Vegetable, parts, heads: Vec::new(), likelihood, word: Some("mushroom") })
}

/// The cap over a face, if that is a stem, and that face.
fn cap_over(scene: &Scene, row: usize) -> Option<(Face, &Face)> {
    let stem = &scene.faces[row];
    // Spots lie in the cap.
    let is_spot = |face: &Face| {
        scene.faces.iter().any(|f| !core::ptr::eq(f, face) && geom::contains(&f.outline, face.shape.middle))
    };
    let others = scene.faces.iter().filter(|f| !core::ptr::eq(*f, stem));
    let others: Vec<&Face> = others.filter(|f| !is_spot(f)).collect();
    let cap = match others[..] {
        [] => return None,
        [one] => one.clone(),
        _ => scene.union(&others)?,
    };
    let up = (cap.shape.middle - stem.shape.middle).normalize_or_zero();
    // Upright, about the middle of the stem.
    let turned = |face: &Face| -> Vec<DVec2> {
        let from = stem.shape.middle;
        face.outline.iter().map(|p| DVec2::new((*p - from).perp_dot(up), (*p - from).dot(up))).collect()
    };
    let (own, below) = (turned(&cap), turned(stem));
    let ((low, high), (foot, neck)) = (bounds(&own)?, bounds(&below)?);
    let size = high - low;
    let width = |level: usize| {
        let share = (level as f64 + 0.5) / MUSHROOM.levels as f64;
        (runs_at(&own, low.y + share * size.y).iter().map(|(a, b)| b - a).sum::<f64>(), share)
    };
    let (_, widest) = (0..MUSHROOM.levels).map(width).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let stem_wide = (neck.x - foot.x) / size.x;
    let touches = stem.outline.iter().any(|p| nearest_on_ring(&cap.outline, *p).1 < LIMITS.touch);
    let is_cap = cap.shape.convexity > MUSHROOM.convex
        && cap.shape.area > MUSHROOM.full * size.x * size.y
        && size.x > MUSHROOM.wide * size.y
        && widest < MUSHROOM.widest;
    let is_stem = (MUSHROOM.stem_wide[0]..MUSHROOM.stem_wide[1]).contains(&stem_wide)
        && low.y - foot.y > MUSHROOM.stem_long * size.y
        && neck.midpoint(foot).x - low.midpoint(high).x < MUSHROOM.central * size.x
        && low.midpoint(high).x - neck.midpoint(foot).x < MUSHROOM.central * size.x;
    (up.y > MUSHROOM.upright && touches && is_cap && is_stem).then_some((cap, stem))
}
