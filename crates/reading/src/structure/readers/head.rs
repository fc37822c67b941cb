//! A flower in one closed outline on a stem: petals that cannot be separated (rose, peony, poppy), where the stem bears
//! leaves, or petals that are the lobes of the outline.

use geom::polyline_length;
use glam::DVec2;
use ink::StrokeClass;

use super::super::faces::{Face, Run};
use super::{Axis, Part, Proposal, Scene};
use crate::Kind;
use crate::blade::nearest_on_ring;
use crate::corolla::{dips, turned_to_nearest};

/// Requirements of a flower head.
struct HeadLimits {
    /// Least convexity,
    convex: f64,
    /// and least roundness (width over length).
    round: f64,
    /// Least convexity of a head of lobes.
    lobed_convex: f64,
    /// Number of lobes that are petals.
    lobes: core::ops::RangeInclusive<usize>,
    /// A notch between two lobes is at least this deep, as a share of the head's reach.
    notch: f64,
    /// The shortest lobe is at least this share of the longest.
    lobes_alike: f64,
    /// The disc lies within this share of the head's reach from its middle.
    disc: f64,
    /// It covers at most this share of the head.
    disc_area: f64,
    /// A head that is at least this round, with a disc as round, has its rays all round though no notch parts them,
    circle: f64,
    /// this many,
    rays: u32,
    /// if the disc covers between these shares of its area.
    ray_disc: core::ops::Range<f64>,
    /// Points along the outline of a ray, up one side and down the other: shares of its angle and of the head's reach.
    ray: [[f64; 2]; 5],
    /// Least height and width, ink units.
    size: f64,
    /// Its stem goes on below it by more than this share of its height.
    stem: f64,
    /// A stem that stands in a pot goes on below it by more than this share of its height.
    potted_stem: f64,
    /// The stem is attached below this height, a share of the head's.
    base: f64,
    /// Petals within it have more than the first and less than the second share of its area.
    petal: [f64; 2],
    /// The largest leaf is smaller than this share of the head: an ear ends in a grain like the others.
    leaf: f64,
    /// Faces that are neither head nor leaf cover less than this share of the enclosed area.
    other: f64,
    /// See [`Proposal::likelihood`], for a head with lines or faces in it, and for an empty one.
    likelihood: [f64; 2],
    /// That for alike lobes all round a disc.
    lobes_likelihood: f64,
}

const HEAD: HeadLimits = HeadLimits {
    convex: 0.85,
    round: 0.6,
    lobed_convex: 0.6,
    lobes: 4..=12,
    notch: 0.045,
    lobes_alike: 0.5,
    disc: 0.25,
    disc_area: 0.4,
    circle: 0.9,
    rays: 12,
    ray_disc: 0.04..0.5,
    ray: [[0.08, 0.6], [0.18, 0.9], [0.5, 1.0], [0.82, 0.9], [0.92, 0.6]],
    size: 0.2,
    stem: 0.3,
    potted_stem: 0.1,
    base: 0.35,
    petal: [0.04, 0.9],
    leaf: 0.6,
    other: 0.1,
    likelihood: [3000.0, 300.0],
    lobes_likelihood: 30_000.0,
};

pub(super) fn propose(scene: &Scene) -> Option<Proposal> {
    let (mut members, head) = scene.highest_group()?;
    let is_within = |k: &usize| geom::contains(&head.outline, scene.faces[*k].shape.middle);
    let inner: Vec<usize> =
        (0..scene.faces.len()).filter(|k| !members.contains(k)).filter(is_within).collect();
    members.extend(inner);
    let (low, high) = geom::bounds(&head.outline)?;
    let size = high - low;
    let lobes = lobes(scene, &members, &head);
    // Nothing but its disc lies in or next to a flower without a stem.
    let may_be_stemless = lobes.is_some()
        && scene.lines.is_empty()
        && members.len() == scene.faces.len()
        && members.iter().filter(|k| scene.faces[**k].shape.area > HEAD.disc_area * head.shape.area).count()
            == 1;
    let lobes = lobes.or_else(|| rays(scene, &members, &head));
    let least = if lobes.is_some() { HEAD.lobed_convex } else { HEAD.convex };
    if head.shape.convexity < least || head.shape.slenderness < HEAD.round || size.min_element() < HEAD.size {
        return None;
    }
    let stem = if scene.pot.is_some() { HEAD.potted_stem } else { HEAD.stem };
    let goes_below = |axis: &&Axis| axis.points.iter().any(|p| p.y < low.y - stem * size.y);
    // A trunk has two sides.
    let below: Vec<&Axis> = scene.axes.iter().filter(goes_below).collect();
    let on_head = |p: DVec2| Some(nearest_on_ring(&head.outline, p)).filter(|(_, d)| *d < scene.touch);
    let base = match below[..] {
        [stem] => stem.ends().into_iter().find_map(on_head)?.0,
        // A flower that lies by itself shows its petals and its disc.
        [] if may_be_stemless => DVec2::new(low.midpoint(high).x, low.y),
        _ => return None,
    };
    if base.y > low.y + HEAD.base * size.y {
        return None;
    }
    let beside = || (0..scene.faces.len()).filter(|k| !members.contains(k));
    let leaves = scene.leaves_among(beside(), HEAD.other)?;
    let largest = beside().map(|k| scene.faces[k].shape.area).fold(0.0, f64::max);
    if leaves.is_empty() && lobes.is_none() || largest > HEAD.leaf * head.shape.area {
        return None;
    }
    let (mut parts, likelihood) = match lobes {
        Some(lobes) => (lobes, HEAD.lobes_likelihood),
        None => {
            let petals = petals(scene, &members, &head, base);
            let is_marked = petals.len() > 1 || scene.marks.iter().any(|(face, _)| members.contains(face));
            (petals, HEAD.likelihood[usize::from(!is_marked)])
        }
    };
    // A disc gathers its petals.
    let has_disc = parts.iter().any(|part| part.class == StrokeClass::Disc);
    let heads = if has_disc { Vec::new() } else { vec![(0..parts.len()).collect()] };
    parts.extend(leaves);
    parts.extend(scene.axes.iter().map(Part::from_axis));
    Some(Proposal { kind: Kind::Flower, parts, heads, likelihood, word: None, is_of_pieces: false })
}

/// Cuts a round head with a round disc in its middle into rays.
fn rays(scene: &Scene, members: &[usize], head: &Face) -> Option<Vec<Part>> {
    let is_circle = |f: &Face| f.shape.slenderness > HEAD.circle && f.shape.convexity > HEAD.circle;
    let inner = members.iter().map(|&k| &scene.faces[k]);
    let discs: Vec<&Face> = inner.filter(|f| f.shape.area < HEAD.ray_disc.end * head.shape.area).collect();
    let [disc] = discs[..] else { return None };
    let middle = head.shape.middle;
    let reach = (head.shape.area / base::ops::PI).sqrt();
    let is_rayed = is_circle(head)
        && is_circle(disc)
        && disc.shape.area > HEAD.ray_disc.start * head.shape.area
        && disc.shape.middle.distance(middle) < HEAD.disc * reach
        && members.len() == 2;
    let step = base::ops::TAU / f64::from(HEAD.rays);
    let ray = |k: u32| {
        let point = |[turn, far]: [f64; 2]| {
            let (sin, cos) = base::ops::sin_cos((f64::from(k) + turn) * step);
            middle + DVec2::new(cos, sin) * (reach * far)
        };
        let outline = core::iter::once(middle).chain(HEAD.ray.map(point)).chain([middle]);
        let strokes = head.strokes.clone();
        Part { points: outline.collect(), class: StrokeClass::Blade, root: Some(middle), strokes }
    };
    is_rayed.then(|| {
        let mut parts: Vec<Part> = (0..HEAD.rays).map(ray).collect();
        parts.push(Part::from_face(disc, StrokeClass::Disc, None));
        parts
    })
}

/// Cuts a head into lobes round its disc, if its outline has alike ones all round: petals.
fn lobes(scene: &Scene, members: &[usize], head: &Face) -> Option<Vec<Part>> {
    let middle = head.shape.middle;
    let outline = turned_to_nearest(&head.outline, |p| p.distance(middle));
    let away: Vec<f64> = outline.iter().map(|p| p.distance(middle)).collect();
    let reach = away.iter().copied().fold(0.0, f64::max);
    let cuts = dips(&away, HEAD.notch * reach);
    let arcs: Vec<&[DVec2]> = cuts.windows(2).map(|w| &outline[w[0]..=w[1]]).collect();
    let lengths = || arcs.iter().map(|arc| polyline_length(arc));
    let (least, most) = lengths().fold((f64::INFINITY, 0.0_f64), |(l, m), x| (l.min(x), m.max(x)));
    if !HEAD.lobes.contains(&arcs.len()) || least < HEAD.lobes_alike * most {
        return None;
    }
    let is_central = |p: DVec2| p.distance(middle) < HEAD.disc * reach;
    let inner = members.iter().map(|&k| &scene.faces[k]);
    let small = inner.filter(|f| f.shape.area < HEAD.disc_area * head.shape.area);
    let discs = small.map(|f| f.shape.middle).filter(|p| is_central(*p));
    // The end of the outline itself is no disc.
    let is_own = |run: &&Run| head.strokes.contains(&run.stroke);
    let marks = scene.marks.iter().filter(|(face, _)| members.contains(face)).map(|(_, run)| run);
    let marks = marks.filter(|run| !is_own(run));
    let marks = marks.filter(|run| run.points.iter().all(|p| is_central(*p))).map(|run| run.points[0]);
    let has_disc = discs.chain(marks).next().is_some();
    let petal = |arc: &[DVec2]| Part {
        points: arc.iter().copied().chain([middle, arc[0]]).collect(),
        class: StrokeClass::Blade,
        root: Some(middle),
        strokes: head.strokes.clone(),
    };
    has_disc.then(|| arcs.iter().map(|arc| petal(arc)).collect())
}

/// Returns the head as a whole, and in front of it the petals that are visible in it.
fn petals(scene: &Scene, members: &[usize], head: &Face, base: DVec2) -> Vec<Part> {
    let [least, most] = HEAD.petal.map(|share| share * head.shape.area);
    let is_petal = |f: &&Face| f.shape.area > least && f.shape.area < most;
    let inner = members.iter().map(|&k| &scene.faces[k]).filter(is_petal);
    let root = |f: &Face| Some(nearest_on_ring(&f.outline, base).0);
    core::iter::once(Part::from_face(head, StrokeClass::Blade, Some(base)))
        .chain(inner.map(|f| Part::from_face(f, StrokeClass::Blade, root(f))))
        .collect()
}
