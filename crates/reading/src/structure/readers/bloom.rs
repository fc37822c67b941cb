//! A flower seen from the front: petals of one form all round a disc, or round the place where they meet.

use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::Face;
use super::{LIMITS, Part, Proposal, Scene, widest_gap};
use crate::Kind;
use crate::blade::nearest_on_ring;

/// Requirements of a flower seen from the front.
struct BloomLimits {
    /// Fewest petals.
    petals: usize,
    /// The smallest petal has more than this share of the area of the largest.
    alike: f64,
    /// Petals come within this share of their reach of the disc, or of their middle.
    meet: f64,
    /// Between neighbours no wider angle than this, radians.
    gap: f64,
    /// Petals have similar reach: the shortest more than this share of the longest.
    reach: f64,
    /// Greatest area of the disc relative to the largest petal.
    disc: f64,
    /// Faces that are neither petal, disc nor leaf cover less than this share of the enclosed area.
    other: f64,
    /// This many petals all round are no coincidence, with a disc or without.
    many: usize,
    /// Circles in a ring are petals if there are at least this many,
    ring: usize,
    /// each at least this round (width over length),
    round: f64,
    /// all at one distance from the middle, within this share of it,
    even: f64,
    /// and no angle between neighbours is wider than this factor of the mean.
    spaced: f64,
    /// See [`Proposal::likelihood`], for petals round a disc or many petals, and for few without a disc.
    likelihood: [f64; 2],
}

const BLOOM: BloomLimits = BloomLimits {
    petals: 4,
    alike: 0.4,
    meet: 0.3,
    gap: 2.0,
    reach: 0.6,
    disc: 3.0,
    other: 0.1,
    many: 8,
    ring: 5,
    round: 0.9,
    even: 0.1,
    spaced: 1.3,
    likelihood: [ROUND_A_DISC, 200.0],
};

/// See [`Proposal::likelihood`]: petals round a disc.
pub(super) const ROUND_A_DISC: f64 = 4000.0;

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let discs = (0..scene.faces.len()).map(Some).chain([None]);
    let best = |a: &Proposal, b: &Proposal| a.likelihood.total_cmp(&b.likelihood);
    discs.filter_map(|disc| around(scene, disc)).max_by(best).or_else(|| ring(scene))
}

/// Proposes a flower whose petals are circles in a ring that do not reach its middle.
fn ring(scene: &Scene) -> Option<Proposal> {
    let faces = &scene.faces;
    let count = faces.len();
    let middle = faces.iter().map(|f| f.shape.middle).sum::<DVec2>() / count.max(1) as f64;
    let away = || faces.iter().map(|f| f.shape.middle.distance(middle));
    let areas = || faces.iter().map(|f| f.shape.area);
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, 0.0_f64), |(l, h), x| (l.min(x), h.max(x)))
    };
    let ((near, far), (small, large)) = (range(&mut away()), range(&mut areas()));
    let is_ring = count >= BLOOM.ring
        && faces.iter().all(|f| f.shape.slenderness > BLOOM.round && f.shape.convexity > BLOOM.round)
        && far - near < BLOOM.even * far
        && small > BLOOM.alike * large
        && widest_gap(faces.iter().map(|f| f.shape.middle - middle))
            < BLOOM.spaced * base::ops::TAU / count as f64
        && scene.lines.is_empty();
    let parts = is_ring.then(|| {
        // A claw leads to the middle.
        let outline = |f: &Face| geom::convex_hull(&[&f.outline[..], &[middle]].concat());
        let petal = |f: &Face| Part {
            points: outline(f),
            class: StrokeClass::Blade,
            root: Some(middle),
            strokes: f.strokes.clone(),
        };
        faces.iter().map(petal).collect()
    })?;
    Some(Proposal {
        kind: Kind::Flower,
        parts,
        heads: vec![(0..count).collect()],
        likelihood: BLOOM.likelihood[0],
        word: None,
        is_of_pieces: true,
    })
}

/// Proposes a flower whose petals stand round a face, or round the place where they meet.
fn around(scene: &Scene, disc: Option<usize>) -> Option<Proposal> {
    let faces = &scene.faces;
    let rest = || (0..faces.len()).filter(move |k| Some(*k) != disc);
    let centre = match disc {
        Some(k) => faces[k].shape.middle,
        None => meeting_place(scene)?,
    };
    let hub = disc.map_or(0.0, |k| (faces[k].shape.area / base::ops::PI).sqrt());
    let reach = |f: &Face| f.outline.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
    let touches =
        |f: &Face| nearest_on_ring(&f.outline, centre).1 < hub + BLOOM.meet * (reach(f) - hub).max(0.0);
    let petals: Vec<usize> = rest().filter(|&k| touches(&faces[k])).collect();
    let areas = || petals.iter().map(|&k| faces[k].shape.area);
    let reaches = || petals.iter().map(|&k| reach(&faces[k]));
    let least = |x: &mut dyn Iterator<Item = f64>| x.fold(f64::INFINITY, f64::min);
    let most = |x: &mut dyn Iterator<Item = f64>| x.fold(0.0, f64::max);
    if petals.len() < BLOOM.petals
        || least(&mut areas()) < BLOOM.alike * most(&mut areas())
        || least(&mut reaches()) < BLOOM.reach * most(&mut reaches())
        || disc.is_some_and(|k| faces[k].shape.area > BLOOM.disc * most(&mut areas()))
        || widest_gap(petals.iter().map(|&k| faces[k].shape.middle - centre)) > BLOOM.gap
    {
        return None;
    }
    let mut parts = scene.leaves_among(rest().filter(|k| !petals.contains(k)), BLOOM.other)?;
    let first = parts.len();
    let to_centre = |f: &Face| Some(nearest_on_ring(&f.outline, centre).0);
    parts
        .extend(petals.iter().map(|&k| Part::from_face(&faces[k], StrokeClass::Blade, to_centre(&faces[k]))));
    let heads = if disc.is_some() { Vec::new() } else { vec![(first..parts.len()).collect()] };
    parts.extend(disc.map(|k| Part::from_face(&faces[k], StrokeClass::Disc, None)));
    let outer = most(&mut reaches());
    parts.extend(
        scene
            .axes
            .iter()
            .filter(|axis| axis.points.iter().any(|p| p.distance(centre) > outer + LIMITS.touch))
            .map(Part::from_axis),
    );
    Some(Proposal {
        kind: Kind::Flower,
        parts,
        heads,
        likelihood: BLOOM.likelihood[usize::from(disc.is_none() && petals.len() < BLOOM.many)],
        word: None,
        is_of_pieces: false,
    })
}

/// Returns the middle of the largest faces, if they are petals that meet there.
fn meeting_place(scene: &Scene) -> Option<DVec2> {
    let largest = scene.faces.iter().map(|f| f.shape.area).fold(0.0, f64::max);
    let large: Vec<&Face> = scene.faces.iter().filter(|f| f.shape.area > BLOOM.alike * largest).collect();
    (large.len() >= BLOOM.petals)
        .then(|| large.iter().map(|f| f.shape.middle).sum::<DVec2>() / large.len() as f64)
}
