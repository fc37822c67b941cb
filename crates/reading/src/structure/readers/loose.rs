//! Loose leaves, which may overlap: several outlines with a tip, most of them with a midrib or all of them lenses, and
//! no stem that bears them.

use geom::polyline_length;
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::{Face, Run};
use super::super::shape::is_lens_of;
use super::{Part, Proposal, Scene, adjoins, has_straight_side, is_leaf_from};
use crate::Kind;
use crate::blade::nearest_on_ring;
use crate::thresholds::{FEWEST_PETALS, STRAIGHT};

/// Limits of the reader of loose leaves.
struct LooseLimits {
    /// Numbers of leaves.
    count: core::ops::RangeInclusive<usize>,
    /// Leaves cover more than this share of the enclosed area.
    whole: f64,
    /// Each leaf has more than this share of the area of the largest.
    alike: f64,
    /// More than this share of the leaves have a midrib.
    with_rib: f64,
    /// A midrib is longer than this share of its leaf.
    rib: f64,
    /// A midrib begins this near to the margin, as a share of the leaf's length.
    from_margin: f64,
    /// Midribs do not all begin within this share of the longest leaf from the first, as those of petals do.
    one_place: f64,
    /// A line outside is shorter than this factor of the longest leaf: a petiole, not a stem.
    petiole: f64,
    /// Least convexity of a leaf that is partly hidden (area over that of the hull).
    convex_behind: f64,
    /// Slenderness of a leaf without midrib that is a lens.
    lens: core::ops::Range<f64>,
    /// See [`Proposal::likelihood`], for leaves with midribs, and for lenses without.
    likelihood: [f64; 2],
}

const LOOSE: LooseLimits = LooseLimits {
    count: 2..=5,
    whole: 0.9,
    alike: 0.15,
    with_rib: 0.5,
    rib: 0.15,
    from_margin: 0.3,
    one_place: 0.3,
    petiole: 0.75,
    convex_behind: 0.75,
    lens: 0.08..0.72,
    likelihood: [3000.0, 60_000.0],
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let largest = scene.faces.iter().map(|f| f.shape.area).fold(0.0, f64::max);
    let is_leaf = |&k: &usize| scene.faces[k].shape.area > LOOSE.alike * largest;
    let rows: Vec<usize> = (0..scene.faces.len()).filter(is_leaf).collect();
    let area: f64 = rows.iter().map(|&k| scene.faces[k].shape.area).sum();
    let longest = rows.iter().map(|&k| scene.faces[k].shape.length()).fold(0.0, f64::max);
    if !LOOSE.count.contains(&rows.len())
        || area < LOOSE.whole * scene.enclosed()
        || scene.lines.iter().any(|line| polyline_length(&line.points) > LOOSE.petiole * longest)
    {
        return None;
    }
    let is_lens = |&k: &usize| {
        let face = &scene.faces[k];
        is_lens_of(&face.outline, LOOSE.lens) && !has_straight_side(face)
    };
    if scene.marks.is_empty() && scene.lines.is_empty() && rows.iter().all(is_lens) {
        return Some(fallen_lenses(scene, &rows));
    }
    let ribs: Vec<Option<DVec2>> = rows.iter().map(|&k| rib_base(scene, k)).collect();
    let bases: Vec<DVec2> = ribs.iter().flatten().copied().collect();
    if bases.len() as f64 <= LOOSE.with_rib * rows.len() as f64 {
        return None;
    }
    let is_fan = bases.iter().all(|p| p.distance(bases[0]) < LOOSE.one_place * longest);
    if is_fan && rows.len() >= FEWEST_PETALS {
        return None;
    }
    let mut parts = Vec::new();
    for (&row, rib) in rows.iter().zip(&ribs) {
        let face = &scene.faces[row];
        let root = rib.or_else(|| rows.iter().find_map(|&k| behind(face, &scene.faces[k])))?;
        let is_hidden = rows.iter().any(|&k| k != row && adjoins(face, &scene.faces[k]));
        let is_sound = is_hidden && face.shape.convexity > LOOSE.convex_behind || is_leaf_from(face, root);
        if !is_sound {
            return None;
        }
        parts.push(Part::from_face(face, StrokeClass::Blade, Some(root)));
    }
    parts.extend(scene.marks.iter().map(|(_, mark)| Part::from_run(mark, StrokeClass::Vein)));
    parts.extend(scene.lines.iter().map(|line| Part::from_run(line, StrokeClass::Axis)));
    let likelihood = LOOSE.likelihood[0];
    Some(Proposal { kind: Kind::Leaf, parts, heads: Vec::new(), likelihood, word: None, is_of_pieces: true })
}

/// Proposes that lenses are leaves; each is attached at its lower end.
fn fallen_lenses(scene: &Scene, rows: &[usize]) -> Proposal {
    let leaf = |&row: &usize| {
        let face = &scene.faces[row];
        let root = face.shape.ends.into_iter().min_by(|p, q| p.y.total_cmp(&q.y));
        Part::from_face(face, StrokeClass::Blade, root)
    };
    let parts = rows.iter().map(leaf).collect();
    Proposal {
        kind: Kind::Leaf,
        parts,
        heads: Vec::new(),
        likelihood: LOOSE.likelihood[1],
        word: None,
        is_of_pieces: true,
    }
}

/// Where the midrib of a face leaves it, if it has one: the longest line in it, if that is straight, leads along it and
/// begins near its margin.
fn rib_base(scene: &Scene, row: usize) -> Option<DVec2> {
    let face = &scene.faces[row];
    let length = |run: &Run| polyline_length(&run.points);
    let rib = scene.marks_of(row).max_by(|a, b| length(a).total_cmp(&length(b)))?;
    let (a, b) = (rib.points[0], rib.points[rib.points.len() - 1]);
    let [(from_a, off_a), (from_b, off_b)] = [a, b].map(|p| nearest_on_ring(&face.outline, p));
    let (base, off) = if off_a < off_b { (from_a, off_a) } else { (from_b, off_b) };
    let is_rib = a.distance(b) > STRAIGHT * length(rib)
        && length(rib) > LOOSE.rib * face.shape.length()
        && off < LOOSE.from_margin * face.shape.length();
    is_rib.then_some(base)
}

/// The place where a face goes behind another: its point nearest to that one's middle, if they adjoin.
fn behind(face: &Face, front: &Face) -> Option<DVec2> {
    let middle = front.shape.middle;
    let is_other = !core::ptr::eq(face, front) && adjoins(face, front);
    let nearest = face.outline.iter().min_by(|a, b| a.distance(middle).total_cmp(&b.distance(middle)));
    nearest.copied().filter(|_| is_other)
}
