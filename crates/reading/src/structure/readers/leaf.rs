//! One simple leaf: an outline with a tip, and a midrib or a petiole at the other end.

use geom::polyline_length;
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::{Face, Run};
use super::{LIMITS, Part, Proposal, Scene, is_leaf_from, length_of};
use crate::Kind;
use crate::blade::nearest_on_ring;

/// Requirements of a leaf.
struct LeafLimits {
    /// It covers more than this share of the enclosed area.
    whole: f64,
    /// Its midrib is at least this share of its length,
    rib: f64,
    /// leads from base to tip within this angle (the cosine),
    rib_along: f64,
    /// and begins this near to its base, a share of its length.
    rib_base: f64,
    /// Its petiole, and all lines outside together, are at most this share of its length.
    petiole: f64,
    /// Without a midrib it is more slender than this.
    without_rib: f64,
    /// See [`Proposal::likelihood`], for a leaf with a midrib, and for one with a petiole alone.
    likelihood: [f64; 2],
}

const LEAF: LeafLimits = LeafLimits {
    whole: 0.9,
    rib: 0.3,
    rib_along: 0.8,
    rib_base: 0.22,
    petiole: 1.1,
    without_rib: 0.8,
    likelihood: [5000.0, 2000.0],
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let row = scene.main_face(LEAF.whole)?;
    let face = &scene.faces[row];
    let length = face.shape.length();
    if length_of(scene.lines.iter()) > LEAF.petiole * length {
        return None;
    }
    let petioles: Vec<(&Run, DVec2)> =
        scene.lines.iter().filter_map(|l| Some((l, scene.touching_end(l, row)?))).collect();
    if petioles.len() < scene.lines.len() || petioles.len() > 2 {
        return None;
    }
    let petiole = petioles.iter().max_by(|a, b| reach(a.0).total_cmp(&reach(b.0)));
    let ribs: Vec<(&Run, DVec2)> =
        scene.marks_of(row).filter_map(|mark| Some((mark, rib_base(face, mark)?))).collect();
    let rib = ribs.iter().max_by(|a, b| reach(a.0).total_cmp(&reach(b.0)));
    let &(_, root) = petiole.or(rib)?;
    if !is_leaf_from(face, root) || petioles.iter().any(|(_, at)| at.distance(root) > LEAF.rib_base * length)
    {
        return None;
    }
    let has_rib = rib.is_some_and(|(_, base)| base.distance(root) < LEAF.rib_base * length);
    let likelihood = match has_rib {
        true => LEAF.likelihood[0],
        // Two lines below an empty outline are the sides of a trunk as well.
        false
            if petioles.len() == 1
                && face.shape.slenderness < LEAF.without_rib
                && scene.marks_of(row).next().is_none() =>
        {
            LEAF.likelihood[1]
        }
        false => return None,
    };
    let mut parts = vec![Part::from_face(face, StrokeClass::Blade, Some(root))];
    parts.extend(scene.marks_of(row).map(|mark| Part::from_run(mark, StrokeClass::Vein)));
    parts.extend(petioles.iter().map(|(line, _)| Part::from_run(line, StrokeClass::Axis)));
    Some(Proposal { kind: Kind::Leaf, parts, heads: Vec::new(), likelihood, word: None, is_of_pieces: true })
}

fn reach(run: &Run) -> f64 {
    polyline_length(&run.points)
}

/// Returns where a line within a leaf begins, if it is the midrib: at the margin, from where it leads to the tip.
fn rib_base(face: &Face, mark: &Run) -> Option<DVec2> {
    let (a, b) = (mark.points[0], mark.points[mark.points.len() - 1]);
    let off = |p: DVec2| nearest_on_ring(&face.outline, p).1;
    let (base, head) = if off(a) < off(b) { (a, b) } else { (b, a) };
    let tip = face.shape.tip_from(base)?;
    let along = (head - base).normalize_or_zero().dot((tip - base).normalize_or_zero());
    (off(base) < LIMITS.touch
        && base.distance(head) > LEAF.rib * face.shape.length()
        && along > LEAF.rib_along)
        .then_some(base)
}
