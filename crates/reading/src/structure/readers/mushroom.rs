//! A mushroom: a cap like half a ball, and in its middle a stem that is narrower and stands below it.

use geom::bounds;
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::{Face, Run};
use super::{Axis, Part, Proposal, Scene, length_of, upright, widest};
use crate::Kind;
use crate::blade::nearest_on_ring;
use crate::contour::width_at;

/// Requirements of a mushroom. Heights are measured along the line from the middle of its stem to the middle of its
/// cap.
struct MushroomLimits {
    /// Least steepness of that line (its sine).
    upright: f64,
    /// Least convexity of its cap,
    convex: f64,
    /// which covers at least this share of its box: more than a triangle, which is a conifer.
    full: f64,
    /// Least width of its cap, in heights.
    wide: f64,
    /// The cap is widest below this share of its height: a crown is widest in its middle.
    widest: f64,
    /// Least and greatest width of its stem, as shares of the cap's width.
    stem_wide: [f64; 2],
    /// The stem goes on below the cap by at least this share of the cap's height,
    stem_long: f64,
    /// and begins within this share of the cap's width from its middle.
    central: f64,
    /// Lines outside are at most this share of the cap's outline.
    lines: f64,
    /// Levels of the cap at which its width is measured.
    levels: usize,
    /// A cap without lobes has at least this convexity: crowns of trees have lobes, and a flat underside as well.
    smooth: f64,
    /// A cap with a flat underside has near its foot at least this share of its greatest width.
    flat: f64,
    /// Share of the height of a cap that is near its foot.
    flat_at: f64,
    /// Both sides of a stem begin and end at most this far apart in height, and begin at most this far below the cap, as
    /// a share of the height of the drawing.
    level: f64,
    /// See [`Proposal::likelihood`], for a cap with a round underside, and for one with a flat one.
    likelihood: [f64; 2],
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
    smooth: 0.96,
    flat: 0.75,
    flat_at: 0.1,
    level: 0.13,
    likelihood: [12.0, FLAT_CAP],
};

/// See [`Proposal::likelihood`]: a smooth cap with a flat underside.
pub(super) const FLAT_CAP: f64 = 400.0;

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    // The ground on which the stem stands is no part of it.
    let is_ground = |line: &&Run| line.points.iter().all(|p| p.y < scene.low.y + scene.touch);
    let in_faces = (0..scene.faces.len()).find_map(|k| {
        let others = (0..scene.faces.len()).filter(|&j| j != k).map(|j| &scene.faces[j]).collect();
        let stem = &scene.faces[k];
        let lines = scene.lines.iter().filter(|l| !is_ground(l));
        cap_over(scene, stem, others).map(|cap| (cap, stem.clone(), length_of(lines)))
    });
    let between_lines = || {
        let (stem, sides) = stem_of_sides(scene)?;
        let lines = scene.lines.iter().filter(|l| !sides.contains(&l.stroke));
        let cap = cap_over(scene, &stem, scene.faces.iter().collect())?;
        Some((cap, stem, length_of(lines)))
    };
    let (cap, stem, lines) = in_faces.or_else(between_lines)?;
    if lines > MUSHROOM.lines * cap.face.shape.perimeter {
        return None;
    }
    let mut parts = [&cap.face, &stem].map(|face| Part::from_face(face, StrokeClass::Fruit, None)).to_vec();
    parts.extend(scene.lines.iter().filter(is_ground).map(|line| Part::from_run(line, StrokeClass::Ground)));
    let likelihood = MUSHROOM.likelihood[usize::from(cap.is_flat)];
    Some(Proposal {
        kind: Kind::Vegetable,
        parts,
        heads: Vec::new(),
        likelihood,
        word: Some("mushroom"),
        is_of_pieces: true,
    })
}

/// A cap, and whether its underside is flat.
struct Cap {
    face: Face,
    is_flat: bool,
}

/// Returns the stem between two lines that lead down side by side, and the strokes of its sides.
fn stem_of_sides(scene: &Scene) -> Option<(Face, [usize; 2])> {
    let [left, right] = &scene.axes[..] else { return None };
    let level = MUSHROOM.level * (scene.high.y - scene.low.y);
    let ([left_foot, left_top], [right_foot, right_top]) = (left.foot_and_top(), right.foot_and_top());
    if (left_foot.y - right_foot.y).abs() > level || (left_top.y - right_top.y).abs() > level {
        return None;
    }
    let lowest = |face: &Face| face.outline.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let roof = scene.faces.iter().map(lowest).fold(f64::INFINITY, f64::min);
    // Sides that end a little below the cap go on up to it.
    let up = |axis: &Axis, foot: DVec2, top: DVec2| {
        let mut points = axis.points.clone();
        if points[0] != foot {
            points.reverse();
        }
        points.extend((top.y < roof && roof - top.y < level).then_some(DVec2::new(top.x, roof)));
        points
    };
    let mut outline = up(left, left_foot, left_top);
    outline.extend(up(right, right_foot, right_top).into_iter().rev());
    let sides = [left.stroke, right.stroke];
    Some((Face::around(&outline, &sides)?, sides))
}

/// Returns the cap over a stem that these faces make together.
fn cap_over(scene: &Scene, stem: &Face, others: Vec<&Face>) -> Option<Cap> {
    // Spots lie in the cap.
    let is_spot = |face: &Face| {
        others.iter().any(|f| f.shape.area > face.shape.area && geom::contains(&f.outline, face.shape.middle))
    };
    let others: Vec<&Face> = others.iter().copied().filter(|f| !is_spot(f)).collect();
    let cap = match others[..] {
        [] => return None,
        [one] => one.clone(),
        // Spots on the rim part the cap.
        _ => scene.union(&others).or_else(|| Face::hull(&others))?,
    };
    let up = (cap.shape.middle - stem.shape.middle).normalize_or_zero();
    let [own, below] = [&cap, stem].map(|face| upright(&face.outline, stem.shape.middle, up));
    let ((low, high), (foot, neck)) = (bounds(&own)?, bounds(&below)?);
    let size = high - low;
    let width = |share: f64| width_at(&own, low.y + share * size.y);
    let (most, at) = widest(MUSHROOM.levels, width)?;
    let stem_wide = (neck.x - foot.x) / size.x;
    let touches = stem.outline.iter().any(|p| nearest_on_ring(&cap.outline, *p).1 < scene.touch);
    let is_cap = cap.shape.convexity > MUSHROOM.convex
        && cap.shape.area > MUSHROOM.full * size.x * size.y
        && size.x > MUSHROOM.wide * size.y
        && at < MUSHROOM.widest;
    let is_stem = (MUSHROOM.stem_wide[0]..MUSHROOM.stem_wide[1]).contains(&stem_wide)
        && low.y - foot.y > MUSHROOM.stem_long * size.y
        && neck.midpoint(foot).x - low.midpoint(high).x < MUSHROOM.central * size.x
        && low.midpoint(high).x - neck.midpoint(foot).x < MUSHROOM.central * size.x;
    let is_smooth = cap.shape.notches.is_empty() && cap.shape.convexity > MUSHROOM.smooth;
    let is_flat = is_smooth && width(MUSHROOM.flat_at) > MUSHROOM.flat * most;
    (up.y > MUSHROOM.upright && touches && is_cap && is_stem).then_some(Cap { face: cap, is_flat })
}
