//! Decides which blades are petals of one flower, and which are leaves (He and Cheng 2021, section 4.1).
//!
//! Roots of petals lie together, roots of leaves do not: mean shift on roots, clusters of more than 2 are
//! flowers. Beyond the paper: a drawn disc gathers its petals; blades are rooted where they touch their bearer
//! even if the pen began at the tip; leaves that stand thick along a branch are no flower; whorls.

use std::collections::BTreeMap;

use base::LiteMap;

use base::ops;
use geom::{Spoke, bounds, contains, mean_shift, polyline_length, wheels};
use glam::DVec2;
use ink::StrokeClass;

use crate::blade::{Sheetlet, tip};
use crate::body;
use crate::coherence;
use crate::contour::{neck, width_at};
use crate::corolla::{Core, is_cup, split, visits, winding};
use crate::draft::{Draft, FlowerDraft};
use crate::near::Near;
use crate::rings::Ring;
use crate::thresholds::{FEWEST_PETALS, ROUNDING, SAME_PLACE, STOPPED_SHORT, WELL_SHORT};
use crate::{BladeReading, DiscReading, Kind, OrganWord, profile};

/// Roots this near together, as a share of the median petal length, are one flower.
const BANDWIDTH: f64 = 0.25;
/// Most roots that are clustered by mean shift; more are separated by cells.
const MOST_ROOTS: usize = 2_000;
/// A part below a corolla is the trunk of a palm if its height is more than this factor of its width; a petal is less
/// slender.
const SLENDER: f64 = 1.6;
/// A piece of a corolla that is a trunk is longer than this share of the usual piece.
const LONGEST: f64 = 0.9;
/// Such a piece points down: the cosine of its angle to the vertical is above this.
const DOWN: f64 = 0.9;
/// The height of such a piece is more than this factor of its width.
const TRUNK_SLENDER: f64 = 1.8;
/// A trunk is cut off flat: its foot is measured at this share of its height.
const CUT_AT: f64 = 0.06;
/// There it has more than this share of its width at half its height.
const CUT_OFF: f64 = 0.7;
/// Fronds in one stroke come this near to the top of their trunk, as a share of the stroke's size.
const AT_TRUNK: f64 = 0.12;
/// Petals in one stroke come within this number of radii of the middle of their disc.
const AT_DISC: f64 = 1.3;
/// A corolla touches a stem if it comes nearer than this share of its size.
const TOUCHES: f64 = 0.07;
/// Ends of two lines meet within this share of the first one's length.
const MEETS: f64 = 0.08;
/// A line is open if its ends are farther apart than this share of its length.
const APART: f64 = 0.2;
/// The cosine of the angle within which the part ahead of the foot of a cup is its middle.
const AHEAD: f64 = 0.95;
/// A point nearer to the foot of a cup than this share of its reach is part of its foot, not of its rim.
const AT_FOOT: f64 = 0.2;
/// Greatest distance of a cup's front from the foot relative to the dip, which itself lies on it (*geometry*).
const ROUNDED: f64 = 1.01;
/// Step between points of a stem that are compared with a corolla.
const STRIDE: usize = 6;
/// A corolla stands along a stem if it touches more than one in this number of the stem's points.
const ALONG: usize = 3;
/// Such a stem is longer than this share of the corolla's size.
const LONG_STEM: f64 = 0.4;
/// A stroke that turns round its middle by more than this angle is a ring of petals, not a row; all round is 6.3.
const AROUND: f64 = 4.0;
/// A blade nearer to its bearer than this share of the usual petal stands on it.
const STANDS: f64 = 0.2;
/// Fronds begin within this share of their usual length of the top of their trunk.
const FRONDS: f64 = 0.6;
/// Fewest petals of a flower in front of a stem: leaves at a node leave two sides free.
const WHOLE_RING: usize = 5;
/// Between neighbouring petals of such a flower no angle is wider than this, radians.
const CLOSE_RING: f64 = 1.9;
/// Between petals all round no angle is wider than this, radians; half a turn (3.14, *geometry*) is a tuft.
const RING: f64 = 2.6;
/// Petals on a shoot's end begin in one place: nearer than this share of the usual petal.
const ONE_PLACE: f64 = 0.15;
/// Fewest blades of a rosette.
const ROSETTE: usize = 4;
/// Each blade of a rosette comes this near to its middle, as a share of the blade's size.
const TO_MIDDLE: f64 = 0.25;
/// Between neighbours of a rosette no angle is wider than this, radians.
const ROSETTE_GAP: f64 = 2.2;
/// A petal begun at its tip comes within this number of bandwidths of its flower's centre.
const ADOPTED: f64 = 1.2;
/// Least size of petals that is assumed at the foot of a stem that leads up to a disc.
const SMALLEST: f64 = 0.08;
/// Such a stem rises by more than this factor of the usual petal.
const LEADS_UP: f64 = 1.2;
/// Most petals of a flower whose rings are separated: each is compared with each.
const MOST_PETALS: usize = 300;
/// A petal of an inner ring reaches less than this share of the petal behind it.
const INNER: f64 = 0.72;
/// It stands within this share of that petal's half angle.
const IN_FRONT: f64 = 0.8;

/// Returns the discs of the draft: middle and mean radius of each disc stroke.
pub(crate) fn discs(draft: &Draft<'_>) -> Vec<(DiscReading, usize)> {
    let mut discs: Vec<(DiscReading, usize)> = Vec::new();
    for k in draft.strokes_of_class(StrokeClass::Disc) {
        let stroke = &draft.ink.strokes[k];
        let Some((lo, hi)) = bounds(&stroke.points) else { continue };
        let hull = stroke.hull();
        let centre = if hull.len() > 2 { geom::centroid(hull) } else { lo.midpoint(hi) };
        let radius =
            if hull.len() > 2 { (geom::signed_area(hull) / ops::PI).sqrt() } else { 0.25 * lo.distance(hi) };
        let disc =
            DiscReading { centre, radius: radius.max(1e-4), source: Some(stroke.index), color: stroke.color };
        discs.push((disc, k));
    }
    discs
}

/// Cuts corollas into blades. Those that stand on a trunk's top, along a stem or on the ground are leaves.
pub(crate) fn corollas(draft: &mut Draft<'_>, discs: &[(DiscReading, usize)]) {
    let mut centres = Near::new(0.1);
    for (i, (d, _)) in discs.iter().enumerate() {
        centres.add_line(i, &[d.centre]);
    }
    let ink = draft.ink;
    let axes: Vec<&[DVec2]> = draft
        .strokes_of_class(StrokeClass::Axis)
        .into_iter()
        .map(|k| ink.strokes[k].points.as_slice())
        .collect();
    for k in draft.strokes_of_class(StrokeClass::Corolla) {
        let mut points = ink.strokes[k].points.clone();
        // A drawing of grass has no trunk.
        let lone = axes.is_empty() && discs.is_empty() && draft.kind != Some(Kind::Grass);
        if draft.bodies.is_empty()
            && lone
            && let Some(outline) = geom::simple_outline(&points)
            && let Some((trunk, top)) = neck(&outline, false)
            && slender(&trunk)
        {
            let ring = Ring { points: trunk, ..Ring::default() };
            let row = draft.forest.add_body(body::limbs(&ring, None), None, Some(ink.strokes[k].index));
            draft.bodies.extend(row);
            draft.open_top |= row.is_some();
            points = top;
            points.extend(points.first().copied());
        }
        if let Some((other, whole)) = closed_by_another(draft, k) {
            draft.organ[other] = OrganWord::Petal;
            points = whole;
        }
        let core = core_of(draft, &points, discs, &centres, &axes);
        let mut pieces = split(&points, &core, k);
        if let ([_, _], Core::Point(foot, _)) = (&pieces[..], &core)
            && is_cup(&points, *foot)
        {
            let foot = *foot;
            let front = Sheetlet::new(&front_of_cup(&points, foot), k);
            let front =
                front.map(|p| Sheetlet { root: Some(foot), gap: foot, gap_width: 0.0, leaf: false, ..p });
            pieces.extend(front);
        }
        if pieces.is_empty() {
            pieces.extend(Sheetlet::new(&points, k));
        }
        if draft.bodies.is_empty() && lone {
            trunk_piece(draft, &mut pieces);
        }
        draft.organ[k] = if pieces.is_empty() { OrganWord::Ignored } else { OrganWord::Leaf };
        draft.blades.extend(pieces);
    }
}

/// Finds a line that leads from one end of the corolla to the other, such as the round lower half of a cup under its
/// points; returns that line, and both as one.
fn closed_by_another(draft: &Draft<'_>, k: usize) -> Option<(usize, Vec<DVec2>)> {
    let other = draft.strokes_of_class(StrokeClass::Other).into_iter();
    other.map(|other| (other, together(draft, k, other))).find_map(|(other, whole)| Some((other, whole?)))
}

/// Returns two open strokes that meet at both ends as one outline.
pub(crate) fn together(draft: &Draft<'_>, first: usize, second: usize) -> Option<Vec<DVec2>> {
    let line = |k: usize| {
        let s = draft.ink.strokes.get(k)?;
        let [a, b] = [*s.points.first()?, *s.points.last()?];
        (a.distance(b) > APART * s.length).then_some((s, a, b))
    };
    let ((one, a, b), (other, from, to)) = (line(first)?, line(second)?);
    let near = MEETS * one.length;
    let back = b.distance(to) < near && a.distance(from) < near;
    if !back && (b.distance(from) >= near || a.distance(to) >= near) {
        return None;
    }
    let mut points = other.points.clone();
    if back {
        points.reverse();
    }
    Some([&one.points[..], &points].concat())
}

/// Returns a third petal, which stands in front between the two points of a cup, as high as the dip between them.
fn front_of_cup(points: &[DVec2], foot: DVec2) -> Vec<DVec2> {
    let reach = points.iter().map(|p| p.distance(foot)).fold(0.0, f64::max);
    let middle = points.iter().map(|p| *p - foot).sum::<DVec2>().normalize_or_zero();
    let ahead = |p: &&DVec2| {
        (**p - foot).normalize_or_zero().dot(middle) > AHEAD && p.distance(foot) > AT_FOOT * reach
    };
    let dip = points.iter().filter(ahead).map(|p| p.distance(foot)).fold(reach, f64::min);
    points.iter().copied().filter(|p| p.distance(foot) <= dip * ROUNDED).collect()
}

/// Whether a lower part is clearly taller than wide: the trunk of a palm rather than a flower's lowest petal.
fn slender(outline: &[DVec2]) -> bool {
    bounds(outline).is_some_and(|(lo, hi)| hi.y - lo.y > SLENDER * (hi.x - lo.x))
}

/// Takes the trunk out of a palm in one stroke: the longest piece, which points straight down.
fn trunk_piece(draft: &mut Draft<'_>, pieces: &mut Vec<Sheetlet>) {
    let usual = base::median(pieces.iter().map(|p| p.size).collect()).unwrap_or(0.0);
    let floor = pieces.iter().flat_map(|p| &p.outline).map(|p| p.y).fold(f64::INFINITY, f64::min);
    let found = pieces.iter().position(|p| {
        let Some(root) = p.root else { return false };
        let foot = tip(&p.outline, root);
        let down = root - foot;
        let wide = geom::signed_area(&p.outline) / p.size.max(1e-9);
        // A trunk is cut off flat below; a petal is round or pointed.
        let flat = width_at(&p.outline, foot.y + CUT_AT * down.y)
            > CUT_OFF * width_at(&p.outline, foot.y + 0.5 * down.y);
        let long = p.size > LONGEST * usual && down.y > DOWN * down.length() && down.y > TRUNK_SLENDER * wide;
        long && flat && foot.y < floor + WELL_SHORT
    });
    if let Some(k) = found.filter(|_| pieces.len() > 2) {
        let trunk = pieces.remove(k);
        let ring = Ring { points: trunk.outline, ..Ring::default() };
        let row = draft.forest.add_body(
            body::limbs(&ring, None),
            None,
            Some(draft.ink.strokes[trunk.stroke].index),
        );
        draft.bodies.extend(row);
        draft.open_top |= row.is_some();
    }
}

/// Finds the thing round which the petals of one stroke stand.
fn core_of(
    draft: &Draft<'_>,
    points: &[DVec2],
    discs: &[(DiscReading, usize)],
    centres: &Near,
    axes: &[&[DVec2]],
) -> Core {
    let Some((lo, hi)) = bounds(points) else { return Core::Ground(0.0) };
    if draft.kind == Some(Kind::Grass) {
        return Core::Ground(lo.y);
    }
    let size = lo.distance(hi);
    let hull = geom::convex_hull(points);
    let middle = if hull.len() > 2 { geom::centroid(&hull) } else { lo.midpoint(hi) };
    let top = draft
        .bodies
        .iter()
        .filter_map(|&r| draft.forest.axes[r].points.last().copied())
        .find(|&t| contains(&hull, t) || crate::blade::nearest_on_ring(&hull, t).1 < AT_TRUNK * size);
    if let Some(top) = top {
        return Core::Point(top, 0.0);
    }
    let disc = centres
        .nearest(middle, 0.5 * size, |i| {
            let d = &discs[i].0;
            contains(&hull, d.centre) || crate::blade::nearest_on_ring(&hull, d.centre).1 < AT_DISC * d.radius
        })
        .map(|(e, _)| discs[e.owner].0);
    if let Some(disc) = disc {
        return Core::Point(disc.centre, disc.radius);
    }
    let near = TOUCHES * size;
    let mut along: Option<Vec<DVec2>> = None;
    let around = winding(points, middle) > AROUND;
    for line in axes.iter().take(200) {
        for end in [line[0], line[line.len() - 1]] {
            let stands = visits(points, end, near);
            if stands >= 2 || (stands == 1 && is_cup(points, end)) {
                return Core::Point(end, 0.0);
            }
        }
        let touching: usize = line.iter().step_by(STRIDE).filter(|p| visits(points, **p, near) >= 1).count();
        if !around && touching * STRIDE > line.len() / ALONG && polyline_length(line) > LONG_STEM * size {
            along = Some(line.to_vec());
        }
    }
    if let Some(line) = along {
        return Core::Line(line);
    }
    if around { Core::Point(middle, 0.0) } else { Core::Ground(lo.y) }
}

/// Decides roots and gathers flowers. `bearers`: points of everything that can bear a blade.
pub(crate) fn gather(
    draft: &mut Draft<'_>,
    discs: &[(DiscReading, usize)],
    bearers: &Bearers,
) -> (Vec<FlowerDraft>, Vec<DVec2>) {
    let n = draft.blades.len();
    let mut flowers: Vec<FlowerDraft> = Vec::new();
    let mut roots: Vec<Option<DVec2>> = draft.blades.iter().map(|b| b.root).collect();
    // A blade that is surely a leaf belongs to no flower either.
    let mut taken: Vec<bool> = draft.blades.iter().map(|b| b.leaf).collect();
    let usual = base::median(draft.blades.iter().map(|b| b.size).collect()).unwrap_or(0.1);

    known_heads(draft, discs, &mut flowers, &mut roots, &mut taken);
    by_disc(draft, discs, &mut flowers, &mut roots, &mut taken);
    off_disc(draft, &mut flowers, &mut roots, &mut taken);
    on_rings(draft, usual, (bearers, discs), &mut flowers, &mut roots, &mut taken);
    // Petals begin and end at the centre: the pen's own gap is better evidence than a bearer that happens to touch.
    let free: Vec<usize> = (0..n).filter(|&i| !taken[i]).collect();
    let gaps: Vec<DVec2> = free.iter().map(|&i| draft.blades[i].gap).collect();
    for members in clusters(&gaps, BANDWIDTH * usual) {
        let members: Vec<usize> = members.into_iter().map(|m| free[m]).collect();
        let narrow =
            |i: &usize| draft.blades[*i].gap_width < 0.5 * draft.blades[*i].size || roots[*i].is_some();
        if members.iter().all(narrow) && is_flower(draft, &members, usual, bearers, discs) {
            let centre = mean(members.iter().map(|&i| draft.blades[i].gap));
            for &i in &members {
                taken[i] = true;
                roots[i] = Some(roots[i].unwrap_or(draft.blades[i].gap));
            }
            flowers.push(FlowerDraft { centre, petals: members, ..FlowerDraft::default() });
        }
    }
    rosettes(draft, usual, (bearers, discs), &mut flowers, &mut roots, &mut taken);
    adopt(draft, usual, &mut flowers, &mut roots, &mut taken);
    if let [only] = &flowers[..]
        && coherence::is_tuft_in_pot(draft, only)
    {
        only.petals.iter().for_each(|&i| roots[i] = draft.blades[i].root);
        flowers.clear();
    }
    // A drawing of few strokes is still growing: the rest of its plant cannot decide yet.
    let is_many = draft.ink.strokes.len() >= coherence::FEWEST_STROKES;
    if is_many {
        for i in coherence::dissolve(draft, &mut flowers, usual) {
            roots[i] = draft.blades[i].root;
        }
    }
    profile::gather(draft, &mut flowers, &mut roots, &mut taken);
    let roots: Vec<DVec2> =
        roots.iter().zip(&draft.blades).map(|(r, b)| r.unwrap_or_else(|| bearers.root_of(b))).collect();
    if is_many {
        profile::bells(draft, &mut flowers, &roots, &taken);
    }
    for f in &mut flowers {
        if f.disc.is_none() && !f.petals.is_empty() {
            f.centre = mean(f.petals.iter().map(|&i| roots[i]));
        }
    }
    (flowers, roots)
}

/// Gathers flowers whose petals are known and that have no disc.
fn known_heads(
    draft: &Draft<'_>,
    discs: &[(DiscReading, usize)],
    flowers: &mut Vec<FlowerDraft>,
    roots: &mut [Option<DVec2>],
    taken: &mut [bool],
) {
    for head in draft.heads.iter().filter(|h| !discs.iter().any(|(_, k)| h.contains(k))) {
        let petals: Vec<usize> =
            (0..draft.blades.len()).filter(|&i| head.contains(&draft.blades[i].stroke)).collect();
        for &i in &petals {
            taken[i] = true;
            roots[i] = Some(roots[i].unwrap_or(draft.blades[i].gap));
        }
        if !petals.is_empty() {
            let centre = mean(petals.iter().filter_map(|&i| roots[i]));
            flowers.push(FlowerDraft { centre, petals, ..FlowerDraft::default() });
        }
    }
}

/// Gathers petals whose outline comes near a drawn disc; a disc with none stays a flower of its own.
fn by_disc(
    draft: &Draft<'_>,
    discs: &[(DiscReading, usize)],
    flowers: &mut Vec<FlowerDraft>,
    roots: &mut [Option<DVec2>],
    taken: &mut [bool],
) {
    let mut index = Near::new(0.1);
    for (i, (d, _)) in discs.iter().enumerate() {
        flowers.push(FlowerDraft { centre: d.centre, disc: Some(*d), ..FlowerDraft::default() });
        index.add_line(i, &[d.centre]);
    }
    if discs.is_empty() {
        return;
    }
    let known = |blade: &Sheetlet| {
        let head = draft.heads.iter().find(|h| h.contains(&blade.stroke))?;
        discs.iter().position(|(_, k)| head.contains(k))
    };
    let first = flowers.len() - discs.len();
    for (i, blade) in draft.blades.iter().enumerate() {
        if taken[i] {
            continue;
        }
        if let Some(disc) = known(blade) {
            flowers[first + disc].petals.push(i);
            roots[i] = Some(roots[i].unwrap_or_else(|| blade.nearest(discs[disc].0.centre).0));
            taken[i] = true;
            continue;
        }
        let mut best: Option<(f64, usize, DVec2)> = None;
        index.visit(blade.middle, blade.size.min(0.5) + 0.15, |e, away| {
            let disc = &discs[e.owner].0;
            let reach = disc.radius + (0.2 * blade.size).max(0.25 * disc.radius);
            // No point of an outline is farther from its middle than its size.
            if disc.radius >= 2.0 * blade.size || (roots[i].is_none() && away > blade.size + reach + ROUNDING)
            {
                return;
            }
            let (p, d) = match roots[i] {
                // Loops in one go cross themselves farther out than where they stand.
                Some(r) => (r, r.distance(disc.centre).min(blade.gap.distance(disc.centre))),
                None => blade.nearest(disc.centre),
            };
            if d < reach && best.is_none_or(|(b, ..)| d < b) {
                best = Some((d, e.owner, p));
            }
        });
        if let Some((_, owner, p)) = best {
            flowers[first + owner].petals.push(i);
            roots[i] = Some(p);
            taken[i] = true;
        }
    }
}

/// Leads petals that stand off their disc to it: each by a claw, as narrow as the pen.
fn off_disc(
    draft: &mut Draft<'_>,
    flowers: &mut [FlowerDraft],
    roots: &mut [Option<DVec2>],
    taken: &mut [bool],
) {
    for (stroke, petals) in std::mem::take(&mut draft.rings) {
        let source = draft.ink.strokes[stroke].index;
        let of = |f: &&mut FlowerDraft| f.disc.is_some_and(|d| d.source == Some(source));
        let Some(flower) = flowers.iter_mut().find(of) else { continue };
        let Some(disc) = flower.disc else { continue };
        for (i, blade) in draft.blades.iter_mut().enumerate().filter(|(_, b)| petals.contains(&b.stroke)) {
            if !taken[i] {
                flower.petals.push(i);
                taken[i] = true;
                roots[i] = Some(blade.nearest(disc.centre).0);
            } else if !flower.petals.contains(&i) {
                continue;
            }
            let Some(root) = roots[i] else { continue };
            let away = root.distance(disc.centre);
            if away > disc.radius + SAME_PLACE {
                let foot = disc.centre + (root - disc.centre) * (disc.radius / away);
                roots[i] = Some(blade.claw(root, foot));
            }
        }
    }
}

/// Gathers petals that begin on a ring instead of in one place.
fn on_rings(
    draft: &Draft<'_>,
    usual: f64,
    (bearers, discs): (&Bearers, &[(DiscReading, usize)]),
    flowers: &mut Vec<FlowerDraft>,
    roots: &mut [Option<DVec2>],
    taken: &mut [bool],
) {
    let free: Vec<usize> = (0..draft.blades.len()).filter(|&i| !taken[i] && roots[i].is_none()).collect();
    if free.len() > MOST_ROOTS {
        return;
    }
    let spoke = |&i: &usize| {
        let b = &draft.blades[i];
        Spoke { gap: b.gap, middle: b.middle, size: b.size }
    };
    for wheel in wheels(&free.iter().map(spoke).collect::<Vec<_>>()) {
        let centre = wheel.centre;
        let rooted = |&row: &usize| {
            let b = &draft.blades[free[row]];
            // A petal may have been begun at its tip.
            let at_root = b.gap.distance(centre) < b.middle.distance(centre);
            (free[row], if at_root { b.gap } else { b.nearest(centre).0 })
        };
        let rooted: Vec<(usize, DVec2)> = wheel.spokes.iter().map(rooted).collect();
        // Roots in one place are those of He and Cheng (2021).
        let wide = rooted.iter().any(|(_, root)| root.distance(centre) > BANDWIDTH * usual);
        if !wide
            || bears_fronds(draft, centre, usual)
            || bearers.leads_up(centre, usual, discs)
            || bearers.stand(centre, STANDS * usual) == Stand::Body
        {
            continue;
        }
        for &(i, root) in &rooted {
            taken[i] = true;
            roots[i] = Some(root);
        }
        let petals = rooted.into_iter().map(|(i, _)| i).collect();
        flowers.push(FlowerDraft { centre, petals, ..FlowerDraft::default() });
    }
}

/// Whether the open top of a trunk is near: blades that stand round it are fronds.
fn bears_fronds(draft: &Draft<'_>, centre: DVec2, usual: f64) -> bool {
    draft.open_top
        && draft.bodies.iter().any(|&r| {
            let top = draft.forest.axes[r].points.last();
            top.is_some_and(|t| {
                t.distance(centre) < FRONDS * usual + draft.forest.half_width(r, f64::INFINITY)
            })
        })
}

/// Applies the rule of He and Cheng (2021), more than 2 petals, and distinguishes leaves on a branch from petals at a
/// stem's end.
fn is_flower(
    draft: &Draft<'_>,
    members: &[usize],
    usual: f64,
    bearers: &Bearers,
    discs: &[(DiscReading, usize)],
) -> bool {
    if members.len() < FEWEST_PETALS {
        return false;
    }
    let centre = mean(members.iter().map(|&i| draft.blades[i].gap));
    let mut angles: Vec<f64> =
        members.iter().map(|&i| draft.blades[i].middle - centre).map(|v| ops::atan2(v.y, v.x)).collect();
    base::sort_numbers(&mut angles);
    if bears_fronds(draft, centre, usual) || bearers.leads_up(centre, usual, discs) {
        return false;
    }
    let widest = angles
        .windows(2)
        .map(|w| w[1] - w[0])
        .chain(angles.first().zip(angles.last()).map(|(a, b)| a + ops::TAU - b))
        .fold(0.0, f64::max);
    match bearers.stand(centre, 0.4 * usual) {
        // Fronds on a trunk.
        Stand::Body => false,
        // Leaves at a node of a stem: only a whole ring of many petals is a flower in front of it.
        Stand::Along => members.len() >= WHOLE_RING && widest < CLOSE_RING,
        // On the ground a tuft of leaves, unless they stand all round.
        Stand::Soil => widest < RING,
        // A shoot's end may be thick with leaves: petals meet in one place, or stand all round.
        Stand::End => {
            let spread = members.iter().map(|&i| draft.blades[i].gap.distance(centre)).fold(0.0, f64::max);
            spread < ONE_PLACE * usual || widest < RING
        }
        Stand::Free => true,
    }
}

/// Gathers rings of petals whose strokes began elsewhere: blades that touch one another round a common middle.
fn rosettes(
    draft: &Draft<'_>,
    usual: f64,
    (bearers, discs): (&Bearers, &[(DiscReading, usize)]),
    flowers: &mut Vec<FlowerDraft>,
    roots: &mut [Option<DVec2>],
    taken: &mut [bool],
) {
    let free: Vec<usize> = (0..draft.blades.len()).filter(|&i| !taken[i] && roots[i].is_none()).collect();
    if free.len() < FEWEST_PETALS || free.len() > MOST_ROOTS {
        return;
    }
    let middles: Vec<DVec2> = free.iter().map(|&i| draft.blades[i].middle).collect();
    for members in clusters(&middles, 1.1 * usual) {
        let members: Vec<usize> = members.into_iter().map(|m| free[m]).collect();
        if members.len() < ROSETTE {
            continue;
        }
        let centre = mean(members.iter().map(|&i| draft.blades[i].middle));
        let feet: Vec<(DVec2, f64)> = members.iter().map(|&i| draft.blades[i].nearest(centre)).collect();
        if bears_fronds(draft, centre, usual) || bearers.leads_up(centre, usual, discs) {
            continue;
        }
        let close = members.iter().zip(&feet).all(|(&i, f)| f.1 < TO_MIDDLE * draft.blades[i].size)
            && !matches!(bearers.stand(centre, STANDS * usual), Stand::Along | Stand::Body);
        let mut angles: Vec<f64> =
            members.iter().map(|&i| draft.blades[i].middle - centre).map(|v| ops::atan2(v.y, v.x)).collect();
        base::sort_numbers(&mut angles);
        let even = angles.windows(2).all(|w| w[1] - w[0] < ROSETTE_GAP)
            && angles.first().zip(angles.last()).is_some_and(|(a, b)| a + ops::TAU - b < ROSETTE_GAP);
        if close && even {
            for (&i, f) in members.iter().zip(&feet) {
                taken[i] = true;
                roots[i] = Some(f.0);
            }
            flowers.push(FlowerDraft { centre, petals: members, ..FlowerDraft::default() });
        }
    }
}

/// Gives petals that were begun at their tips to the flower whose centre they touch.
fn adopt(
    draft: &Draft<'_>,
    usual: f64,
    flowers: &mut [FlowerDraft],
    roots: &mut [Option<DVec2>],
    taken: &mut [bool],
) {
    let mut index = Near::new(0.1);
    for (f, flower) in flowers.iter().enumerate() {
        if flower.petals.len() > 2 {
            index.add_line(f, &[flower.centre]);
        }
    }
    for (i, blade) in draft.blades.iter().enumerate() {
        if taken[i] || roots[i].is_some() {
            continue;
        }
        let mut best: Option<(f64, usize, DVec2)> = None;
        index.visit(blade.middle, blade.size.min(0.4), |e, _| {
            let (p, d) = blade.nearest(e.point);
            if d < ADOPTED * BANDWIDTH * usual && best.is_none_or(|(b, ..)| d < b) {
                best = Some((d, e.owner, p));
            }
        });
        if let Some((_, f, p)) = best {
            flowers[f].petals.push(i);
            roots[i] = Some(p);
            taken[i] = true;
        }
    }
}

/// How a group of blades stands on its bearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stand {
    Body,
    Along,
    End,
    Soil,
    Free,
}

/// Everything that can bear a blade, before the hierarchy is known.
#[derive(Clone, Debug)]
pub(crate) struct Bearers {
    /// Owner `i` is line `i` of the draft; bodies follow; soil is last.
    near: Near,
    lines: usize,
    length: Vec<f64>,
    soil: usize,
    /// Both ends of the first lines; more are no stems of flowers.
    ends: Vec<(DVec2, DVec2)>,
}

impl Bearers {
    pub(crate) fn new(draft: &Draft<'_>) -> Self {
        let mut near = Near::new(0.04);
        let mut length = Vec::new();
        for line in &draft.lines {
            near.add_line(length.len(), &line.points);
            length.push(polyline_length(&line.points));
        }
        let lines = length.len();
        for axis in &draft.forest.axes {
            near.add_line(length.len(), &axis.points);
            length.push(polyline_length(&axis.points));
        }
        let soil = length.len();
        for line in &draft.soil {
            near.add_line(soil, line);
        }
        let ends =
            draft.lines.iter().take(200).map(|l| (l.points[0], l.points[l.points.len() - 1])).collect();
        Self { near, lines, length, soil, ends }
    }

    /// Whether a stem begins near `p` and ends at a drawn disc well above: blades at its foot are leaves.
    fn leads_up(&self, p: DVec2, usual: f64, discs: &[(DiscReading, usize)]) -> bool {
        self.ends.iter().any(|&(a, b)| {
            let (foot, top) = if a.y < b.y { (a, b) } else { (b, a) };
            let at_disc = |d: &DiscReading| d.centre.distance(top) < 2.0 * d.radius + STOPPED_SHORT;
            foot.distance(p) < 0.5 * usual.max(SMALLEST)
                && top.y - foot.y > LEADS_UP * usual
                && discs.iter().any(|(d, _)| at_disc(d) && d.centre.distance(p) > usual)
        })
    }

    fn stand(&self, p: DVec2, r: f64) -> Stand {
        let Some((e, _)) = self.near.nearest(p, r.max(0.03), |_| true) else { return Stand::Free };
        if e.owner == self.soil {
            return Stand::Soil;
        }
        if e.owner >= self.lines {
            return Stand::Body;
        }
        let length = self.length[e.owner];
        let margin = r.max(0.05 * length);
        if e.at < margin || e.at > length - margin { Stand::End } else { Stand::Along }
    }

    /// Returns the attachment of a single blade: at its gap if that is near a bearer, else at its nearest point to
    /// one, else at its gap.
    fn root_of(&self, blade: &Sheetlet) -> DVec2 {
        let reach = (0.22 * blade.size).clamp(0.015, 0.08);
        let gap = blade.nearest(blade.gap).0;
        if self.near.nearest(gap, reach, |_| true).is_some() {
            return gap;
        }
        let stride = blade.outline.len().div_ceil(64).max(1);
        let touch = blade
            .outline
            .iter()
            .step_by(stride)
            .filter_map(|&p| self.near.nearest(p, reach.max(0.03), |_| true).map(|(_, d)| (d, p)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        touch.map_or(gap, |(_, p)| p)
    }
}

/// Returns the ring of each petal, 0 outermost: a petal in front of a clearly longer one is in an inner ring.
pub(crate) fn whorls(draft: &Draft<'_>, flower: &FlowerDraft, read: &[BladeReading]) -> Vec<u32> {
    let petals: Vec<(f64, f64, f64)> = flower
        .petals
        .iter()
        .zip(read)
        .map(|(&i, read)| {
            let blade = &draft.blades[i];
            let v = read.tip - flower.centre;
            let reach = v.length().max(1e-9);
            let half = 0.5 * geom::signed_area(&blade.outline) / blade.size.max(1e-9);
            (reach, ops::atan2(v.y, v.x), ops::atan2(half, 0.6 * reach))
        })
        .collect();
    let mut order: Vec<usize> = (0..petals.len()).collect();
    base::sort_by(&mut order, |&a, &b| petals[b].0.total_cmp(&petals[a].0).then(a.cmp(&b)));
    let mut whorl = vec![0_u32; petals.len()];
    if petals.len() > MOST_PETALS {
        return whorl;
    }
    for (k, &i) in order.iter().enumerate() {
        for &j in &order[..k] {
            let mut apart = (petals[i].1 - petals[j].1).abs();
            apart = apart.min(ops::TAU - apart);
            if petals[i].0 < INNER * petals[j].0 && apart < IN_FRONT * petals[j].2 {
                whorl[i] = whorl[i].max(whorl[j] + 1);
            }
        }
    }
    // One small petal is a small petal, not a ring.
    let inner = whorl.iter().filter(|w| **w > 0).count();
    if inner < FEWEST_PETALS { vec![0; petals.len()] } else { whorl }
}

/// Clusters of at least 3 points that lie within `bandwidth` of one another.
fn clusters(points: &[DVec2], bandwidth: f64) -> Vec<Vec<usize>> {
    let mut groups: LiteMap<usize, Vec<usize>> = LiteMap::new();
    if points.len() <= MOST_ROOTS {
        for (i, c) in mean_shift(points, bandwidth).into_iter().enumerate() {
            groups.entry(c).or_default().push(i);
        }
    } else {
        // This many roots are grouped by cells of a bandwidth: linear, and as coarse as such a drawing is.
        let mut cells: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
        for (i, p) in points.iter().enumerate() {
            #[expect(clippy::cast_possible_truncation, reason = "saturates")]
            let key = |v: f64| (v / bandwidth.max(1e-4)).floor() as i64;
            cells.entry((key(p.x), key(p.y))).or_default().push(i);
        }
        return cells.into_values().filter(|g| g.len() > 2).collect();
    }
    groups.into_iter().map(|(_, g)| g).filter(|g| g.len() > 2).collect()
}

fn mean(points: impl Iterator<Item = DVec2>) -> DVec2 {
    let (sum, n) = points.fold((DVec2::ZERO, 0.0), |(s, n), p| (s + p, n + 1.0));
    if n > 0.0 { sum / n } else { sum }
}
