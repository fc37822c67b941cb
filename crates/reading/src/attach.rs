//! Finds the bearer of each part: stems lead to flowers, leaves get their petioles, fruits and roots their places.

use base::ops;
use geom::{bounds, contains, point_at, polyline_length};
use glam::DVec2;
use ink::{Ink, StrokeClass};
use plant::AxisKind;

use crate::blade::{LENS, Sheetlet, found_midrib, midrib, tip};
use crate::branches::{Line, oriented};
use crate::draft::{Draft, FlowerDraft};
use crate::flowers::whorls;
use crate::kept::{alike, same_bits};
use crate::near::Near;
use crate::overlap::layers;
use crate::rules::STAMENS;
use crate::thresholds::{FEWEST_PETALS, ROUNDING, SAME_PLACE, STOPPED_SHORT, WELL_SHORT};
use crate::veins::{VeinLine, Veins, choose_midrib};
use crate::{
    Attachment, BladeReading, DiscReading, FlowerReading, FruitReading, Kind, OrganWord, VeinReading,
};

/// A leaf nearer to its bearer than this sits on it; farther, it has a stalk.
const SESSILE: f64 = 0.02;
/// As [`SESSILE`], as a share of the leaf's size: large leaves leave a larger gap.
const SESSILE_SHARE: f64 = 0.08;
/// Fewest petals that were drawn as lines.
const FEWEST_RAYS: usize = 5;
/// Most petals that were drawn as lines.
const MOST_RAYS: usize = 200;
/// A petal drawn as a line begins within this many radii of the disc's centre.
const RAY_FOOT: f64 = 1.6;
/// A petal drawn as a line points away from the disc: the cosine of its angle to the radius is above this.
const RAY_WAY: f64 = 0.7;
/// A petal drawn as a line reaches at most this factor farther than the median one.
const LONG_RAY: f64 = 1.8;
/// Lines that are a tuft of grass at least: three are a stem with two branches.
const FEWEST_BLADES: usize = 4;
/// Straightness of the ground under a tuft: the distance between its ends is more than this share of its length.
const LEVEL_STRAIGHT: f64 = 0.93;
/// The ends of the ground under a tuft differ in height by less than this share of its width.
const LEVEL_RISE: f64 = 0.15;
/// A disc at the top of a trunk is a nut if its radius is less than this factor of the trunk's width there; else a
/// flower.
const NUT: f64 = 1.2;
/// A stamen begins within this share of its flower's reach of the centre.
const STAMEN_FOOT: f64 = 0.3;
/// A stamen is at most this factor of its flower's reach long.
const STAMEN_LENGTH: f64 = 1.3;
/// Fewest lines over petals that are stamens.
const FEWEST_STAMENS: u32 = 3;
/// Lines over petals are stamens if they lie aside from the middles of their petals by more than this share of the
/// angle between two, on average: for lines of random direction that is half (*geometry*).
const ASIDE: f64 = 0.3;
/// A stamen that stands out of a flower in profile begins this near to its centre, as a share of a petal.
const BURST_FOOT: f64 = 0.2;
/// The cosine of the angle between such a stamen and its petal is above this.
const BURST_WAY: f64 = 0.94;
/// Such a stamen ends within this factor of its petal's size.
const BURST_LONG: f64 = 1.35;
/// Stamens are shorter than this share of the longest line: that one is the stem.
const NO_STEM: f64 = 0.6;
/// A root lies under the ground by more than this on average.
const UNDER: f64 = 0.005;
/// A root rises above the ground nowhere by more than this.
const OVER: f64 = 0.04;
/// Roots begin this far from the sides of a trunk's foot, which flares.
const FLARE: f64 = 0.08;
/// A stem belongs to a flower if it ends within this factor of its petals' reach from its centre.
const BEYOND: f64 = 1.35;
/// A stem ends at a flower rather than passing it if less than this share of the stem, or of the reach, is left.
const AT_END: f64 = 0.25;
/// Places nearer than this are one: less than a step of the pen. *Sampled*.
const STEP: f64 = 0.004;
/// A flower nearer to an axis than this sits on it: some two steps of the pen. *Sampled*.
const ON_AXIS: f64 = 0.012;
/// More lines than this are no tuft of grass that a person drew.
const MOST_GRASS: usize = 2_000;
/// Leaves and flowers farther than this from every axis are borne by none.
const FAR: f64 = 0.25;
/// A frond begins within this distance of the top of a trunk if others begin so near that they surely are fronds.
const ROUND_TOP: f64 = 0.1;

/// Turns lines that fan out from the top of a trunk without a crown into the fronds of a palm; if the plant is known
/// to be a palm, they may begin farther away.
pub(crate) fn fronds(draft: &mut Draft<'_>) {
    let bare = draft.regions.is_empty() && (draft.open_top || !draft.blades.is_empty());
    if draft.bodies.is_empty() || !bare || draft.is_tree() {
        return;
    }
    let tops: Vec<(DVec2, f64)> = draft
        .bodies
        .iter()
        .filter_map(|&r| {
            let top = *draft.forest.axes[r].points.last()?;
            Some((top, WELL_SHORT + draft.forest.half_width(r, f64::INFINITY)))
        })
        .collect();
    // A plant known to be a palm has nothing else up there.
    let palm = draft.kind == Some(Kind::Palm);
    let from_top = |line: &Line| {
        let ends = [line.points[0], line.points[line.points.len() - 1]];
        let near = |p: DVec2| tops.iter().map(|(t, r)| t.distance(p) - r).fold(f64::INFINITY, f64::min);
        let last = near(ends[1]) < near(ends[0]);
        let at_top = near(ends[usize::from(last)]) < if palm { ROUND_TOP } else { 0.0 };
        (at_top && polyline_length(&line.points) > WELL_SHORT).then_some(last)
    };
    let fans: Vec<Option<bool>> = draft.lines.iter().map(from_top).collect();
    if fans.iter().flatten().count() + draft.blades.len() < 2 {
        return;
    }
    into_blades(draft, fans);
}

/// Makes blades of lines; each is given whether its last point is its root, or nothing where it stays a line.
fn into_blades(draft: &mut Draft<'_>, roots: Vec<Option<bool>>) {
    for (line, root) in std::mem::take(&mut draft.lines).into_iter().zip(roots) {
        let stroke = line.source.and_then(|i| draft.ink.strokes.binary_search_by_key(&i, |s| s.index).ok());
        let blade = root.zip(stroke).and_then(|(last, k)| {
            let points = oriented(&line.points, last);
            Sheetlet::lens(&points, k, LENS * polyline_length(&points))
        });
        match blade {
            Some(blade) => {
                draft.set_organ(line.source, OrganWord::Leaf);
                draft.blades.push(blade);
            }
            None => draft.lines.push(line),
        }
    }
}

/// Turns lines all round a disc that point away from it into petals, if the plant is taken for a flower.
pub(crate) fn rays(draft: &mut Draft<'_>, discs: &[(DiscReading, usize)]) {
    if !draft.kind.is_some_and(|k| k.is_like(Kind::Flower)) || draft.lines.len() > MOST_RAYS {
        return;
    }
    for (disc, _) in discs {
        // For a line that points away: whether its last point is at the disc.
        let away = |line: &Line| {
            let ends = [line.points[0], line.points[line.points.len() - 1]];
            let last = ends[1].distance(disc.centre) < ends[0].distance(disc.centre);
            let (root, tip) = (ends[usize::from(last)] - disc.centre, ends[usize::from(!last)] - disc.centre);
            let out = tip - root;
            let at_disc = root.length() < RAY_FOOT * disc.radius;
            (at_disc && out.dot(root) > RAY_WAY * out.length() * root.length())
                .then_some((last, tip.length()))
        };
        let found: Vec<Option<(bool, f64)>> = draft.lines.iter().map(away).collect();
        let mut reach: Vec<f64> = found.iter().flatten().map(|f| f.1).collect();
        base::sort_numbers(&mut reach);
        let Some(&usual) = reach.get(reach.len() / 2).filter(|_| reach.len() >= FEWEST_RAYS) else {
            continue;
        };
        // The stem goes on where petals end.
        let petal = |ray: Option<(bool, f64)>| ray.filter(|r| r.1 < LONG_RAY * usual).map(|r| r.0);
        into_blades(draft, found.into_iter().map(petal).collect());
    }
}

/// Turns single lines that stand next to one another and bear nothing into blades of grass.
pub(crate) fn grass_blades(draft: &mut Draft<'_>) {
    let bare = draft.blades.is_empty()
        && draft.regions.is_empty()
        && draft.forest.axes.is_empty()
        && !draft.class.iter().any(|c| {
            use StrokeClass::{Corolla, Crown, Disc, Fruit, Pot, Scribble};
            [Corolla, Crown, Disc, Fruit, Pot, Scribble].contains(c)
        });
    let few = draft.lines.len() < FEWEST_BLADES || draft.lines.len() > MOST_GRASS;
    if !bare || few || draft.is_tree() {
        return;
    }
    let mut near = Near::new(0.04);
    for (i, line) in draft.lines.iter().enumerate() {
        near.add_line(i, &line.points);
    }
    // A branch starts somewhere along another line; a blade of grass on the ground or where others start.
    let foot = |l: &Line| {
        let (a, b) = (l.points[0], l.points[l.points.len() - 1]);
        if a.y < b.y { a } else { b }
    };
    let level = |l: &Line| {
        let (a, b) = (l.points[0], l.points[l.points.len() - 1]);
        let straight = a.distance(b) > LEVEL_STRAIGHT * polyline_length(&l.points);
        straight && (a.y - b.y).abs() < LEVEL_RISE * (a.x - b.x).abs()
    };
    let branches = (0..draft.lines.len())
        .filter(|&i| {
            let p = foot(&draft.lines[i]);
            let own = |j: usize| {
                j != i && foot(&draft.lines[j]).distance(p) > WELL_SHORT && !level(&draft.lines[j])
            };
            near.nearest(p, SESSILE, own).is_some()
        })
        .count();
    if branches * 3 > draft.lines.len() || draft.lines.iter().all(level) {
        return;
    }
    for line in std::mem::take(&mut draft.lines) {
        let stroke = line.source.and_then(|i| draft.ink.strokes.binary_search_by_key(&i, |s| s.index).ok());
        let last = line.points[0].y > line.points[line.points.len() - 1].y;
        let blade = stroke.filter(|_| !level(&line)).and_then(|k| {
            let points = oriented(&line.points, last);
            Sheetlet::lens(&points, k, 0.028 * polyline_length(&points))
        });
        match blade {
            Some(blade) => {
                draft.set_organ(line.source, OrganWord::Leaf);
                draft.blades.push(Sheetlet { leaf: true, ..blade });
            }
            // The line of the ground under it.
            None if level(&line) => draft.set_organ(line.source, OrganWord::Ignored),
            None => draft.lines.push(line),
        }
    }
}

/// Returns the discs of flowers, and the strokes of the discs that are nuts at the top of a trunk or fruits in a
/// crown.
pub(crate) fn part_discs(
    draft: &Draft<'_>,
    discs: Vec<(DiscReading, usize)>,
) -> (Vec<(DiscReading, usize)>, Vec<usize>) {
    let mut nuts = Vec::new();
    let flowers = discs
        .into_iter()
        .filter(|(disc, stroke)| {
            let in_crown = draft.regions.iter().any(|r| contains(&r.outline, disc.centre));
            let on_trunk = draft.open_top
                && draft.bodies.iter().any(|&r| {
                    let axis = &draft.forest.axes[r];
                    let wide = 1.5 * draft.forest.half_width(r, f64::INFINITY);
                    axis.points
                        .last()
                        .is_some_and(|t| t.distance(disc.centre) < disc.radius + wide + STOPPED_SHORT)
                        && disc.radius < NUT * wide
                });
            if in_crown || on_trunk {
                nuts.push(*stroke);
            }
            !(in_crown || on_trunk)
        })
        .collect();
    (flowers, nuts)
}

/// Takes lines out of petals that lie over them and are no veins of theirs: they begin at the middle of the flower and
/// do not lead along the petals.
fn over_petals(draft: &mut Draft<'_>, flowers: &[FlowerDraft], veins: &mut Veins) {
    veins.resize(draft.blades.len(), Vec::new());
    for flower in flowers.iter().filter(|f| f.petals.len() >= FEWEST_PETALS) {
        #[expect(clippy::cast_precision_loss, reason = "petals")]
        let room = ops::PI / flower.petals.len() as f64;
        let (mut lines, mut aside) = (0_u32, 0.0);
        for &i in &flower.petals {
            let blade = &draft.blades[i];
            let axis = blade.middle - flower.centre;
            for VeinLine { points: line, .. } in &veins[i] {
                let (a, b) = (line[0] - flower.centre, line[line.len() - 1] - flower.centre);
                let far = if a.length() < b.length() { b } else { a };
                lines += 1;
                aside += (ops::atan2(axis.perp_dot(far), axis.dot(far)).abs() / room).min(1.0);
            }
        }
        let burst = bursting_lines(draft, flower) + lines as usize;
        let out = burst > 1 + lines as usize && burst >= FEWEST_STAMENS as usize;
        let all = out || (lines >= FEWEST_STAMENS && aside > ASIDE * f64::from(lines));
        for &i in &flower.petals {
            let (over, own): (Vec<_>, Vec<_>) = std::mem::take(&mut veins[i])
                .into_iter()
                .partition(|v| all || draft.rule[v.stroke] == Some(STAMENS));
            veins[i] = own;
            for VeinLine { points, stroke } in over {
                draft.lines.push(Line { points, source: Some(draft.ink.strokes[stroke].index) });
            }
        }
    }
}

/// Whether a line begins where the petals do, runs in the direction of one, and ends not far beyond it.
fn bursting<'a>(draft: &'a Draft<'_>, flower: &'a FlowerDraft) -> impl Fn(&Line) -> bool + 'a {
    let widest = flower.petals.iter().map(|&i| draft.blades[i].size).fold(0.0, f64::max);
    move |line| {
        let (a, b) = (line.points[0] - flower.centre, line.points[line.points.len() - 1] - flower.centre);
        let (foot, top) = if a.length_squared() < b.length_squared() { (a, b) } else { (b, a) };
        let near = |size: f64| foot.length() < BURST_FOOT * size && top.length() < BURST_LONG * size;
        // Most lines of a drawing are far away.
        near(widest)
            && flower.petals.iter().any(|&i| {
                let blade = &draft.blades[i];
                let axis = blade.middle - flower.centre;
                near(blade.size) && axis.dot(top) > BURST_WAY * axis.length() * top.length()
            })
    }
}

fn bursting_lines(draft: &Draft<'_>, flower: &FlowerDraft) -> usize {
    let bursts = bursting(draft, flower);
    draft.lines.iter().filter(|l| bursts(l)).count()
}

/// Turns short lines from a flower's centre outwards into its stamens.
pub(crate) fn stamens(
    draft: &mut Draft<'_>,
    flowers: &mut [FlowerDraft],
    roots: &[DVec2],
    veins: &mut Veins,
) {
    over_petals(draft, flowers, veins);
    for k in draft.strokes_of_class(StrokeClass::Other) {
        if draft.rule[k] == Some(STAMENS) {
            draft.organ[k] = OrganWord::Stamen;
        }
    }
    if flowers.is_empty() || draft.lines.is_empty() {
        return;
    }
    let mut index = Near::new(0.1);
    let mut reach = Vec::new();
    for (f, flower) in flowers.iter().enumerate() {
        index.add_line(f, &[flower.centre]);
        let petals = flower.petals.iter().map(|&i| draft.blades[i].size).fold(0.0, f64::max);
        let apart = flower.petals.iter().map(|&i| roots[i].distance(flower.centre)).fold(0.0, f64::max);
        reach.push((0.75 * petals + 0.5 * apart).max(flower.disc.map_or(0.0, |d| 3.0 * d.radius)));
    }
    // Both ends lie within the reach of the flower, and so does the line between them.
    let farthest = reach.iter().copied().fold(ROUNDING, f64::max).min(0.3);
    let longest = draft.longest();
    let alone = draft.lines.len() == 1;
    let bundle = |f: &FlowerDraft| {
        let petals = f.disc.is_none() && f.petals.len() >= FEWEST_PETALS;
        petals && bursting_lines(draft, f) >= FEWEST_STAMENS as usize
    };
    let bundles: Vec<bool> = flowers.iter().map(bundle).collect();
    for line in std::mem::take(&mut draft.lines) {
        let (a, b) = (line.points[0], line.points[line.points.len() - 1]);
        let length = polyline_length(&line.points);
        let burst = (0..flowers.len()).find(|&f| bundles[f] && bursting(draft, &flowers[f])(&line));
        let found = index.nearest(a.midpoint(b), farthest, |f| {
            let centre = flowers[f].centre;
            let disc = flowers[f].disc.map_or(0.0, |d| 1.35 * d.radius);
            let (near, far) =
                (a.distance(centre).min(b.distance(centre)), a.distance(centre).max(b.distance(centre)));
            near < disc.max(STAMEN_FOOT * reach[f]) && far < reach[f] && length < STAMEN_LENGTH * reach[f]
        });
        if let Some(f) = burst {
            let centre = flowers[f].centre;
            flowers[f].stamens.push(oriented(&line.points, b.distance(centre) < a.distance(centre)));
            draft.set_organ(line.source, OrganWord::Stamen);
            continue;
        }
        match found {
            Some((e, _)) if !alone && (length < NO_STEM * longest || draft.lines.is_empty()) => {
                let last = b.distance(e.point) < a.distance(e.point);
                flowers[e.owner].stamens.push(oriented(&line.points, last));
                draft.set_organ(line.source, OrganWord::Stamen);
            }
            _ => draft.lines.push(line),
        }
    }
}

/// Marks axes below the ground line, or downwards from the foot of a trunk, as roots.
pub(crate) fn roots(draft: &mut Draft<'_>) {
    let ground =
        draft.strokes_of_class(StrokeClass::Ground).into_iter().next().map(|k| &draft.ink.strokes[k].points);
    let ground_y = ground.and_then(|g| bounds(g)).map(|(lo, hi)| 0.5 * (lo.y + hi.y));
    let feet: Vec<(usize, DVec2, f64)> = draft
        .bodies
        .iter()
        .map(|&r| (r, draft.forest.axes[r].points[0], draft.forest.half_width(r, 0.0)))
        .collect();
    let mut found = Vec::new();
    for (row, axis) in draft.forest.axes.iter().enumerate() {
        if draft.bodies.contains(&row) || !axis.half_width.is_empty() {
            continue;
        }
        #[expect(clippy::cast_precision_loss, reason = "a mean of a few points")]
        let mean = axis.points.iter().map(|p| p.y).sum::<f64>() / axis.points.len() as f64;
        let top = axis.points.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let under_ground = ground_y.is_some_and(|y| mean < y - UNDER && top < y + OVER);
        let below_foot = feet.iter().any(|(_, p, w)| {
            top < p.y + STOPPED_SHORT
                && mean < p.y - SAME_PLACE
                && axis.points[0].distance(*p) < 2.0 * w + FLARE
        });
        if under_ground || below_foot {
            found.push(row);
        }
    }
    for row in found {
        draft.forest.axes[row].kind = AxisKind::Root;
        let source = draft.forest.axes[row].source;
        draft.set_organ(source, OrganWord::Root);
        // Upper end first.
        let free = draft.forest.axes[row].bearer.is_none();
        let points_up = {
            let p = &draft.forest.axes[row].points;
            p[p.len() - 1].y > p[0].y
        };
        let bears = draft.forest.axes.iter().any(|a| a.bearer.is_some_and(|b| b.axis == row));
        if free && points_up && !bears {
            draft.forest.axes[row].points.reverse();
        }
    }
    for axis in 0..draft.forest.axes.len() {
        if draft.forest.axes[axis].kind == AxisKind::Root {
            let source = draft.forest.axes[axis].source;
            draft.set_organ(source, OrganWord::Root);
        }
    }
}

/// Flowers on their stems, leaves on their bearers.
pub(crate) fn organs(
    draft: &mut Draft<'_>,
    flowers: Vec<FlowerDraft>,
    roots: &[DVec2],
    mut veins: Veins,
    soil: &Near,
) -> (Vec<FlowerReading>, Vec<BladeReading>) {
    veins.resize(draft.blades.len(), Vec::new());
    let ink = draft.ink;
    let mut lines_of = |i: usize| -> Vec<VeinReading> {
        let of = |v: VeinLine| VeinReading { points: v.points, source: Some(ink.strokes[v.stroke].index) };
        std::mem::take(&mut veins[i]).into_iter().map(of).collect()
    };
    let mut is_petal = vec![false; draft.blades.len()];
    let mut read = Vec::new();
    for flower in flowers {
        if flower.petals.is_empty() && flower.disc.is_none() {
            continue;
        }
        let mut petals = Vec::new();
        for &i in &flower.petals {
            is_petal[i] = true;
            draft.organ[draft.blades[i].stroke] = OrganWord::Petal;
            petals.push(blade_reading(draft, i, roots[i], lines_of(i)));
        }
        let rings = whorls(draft, &flower, &petals);
        petals.iter_mut().zip(rings).for_each(|(petal, whorl)| petal.whorl = whorl);
        order(&mut petals, draft.ink);
        if let Some(disc) = flower.disc {
            draft.set_organ(disc.source, OrganWord::Disc);
        }
        let reach = petals
            .iter()
            .map(|p| p.tip.distance(flower.centre))
            .fold(flower.disc.map_or(0.0, |d| 1.4 * d.radius), f64::max);
        let bearer = flower_bearer(draft, flower.centre, reach);
        read.push(FlowerReading {
            centre: flower.centre,
            petals,
            disc: flower.disc,
            stamens: flower.stamens,
            bearer,
        });
    }
    let mut leaves = Vec::new();
    for i in 0..draft.blades.len() {
        if !is_petal[i] {
            let mut leaf = blade_reading(draft, i, roots[i], lines_of(i));
            leaf.bearer = leaf_bearer(draft, &leaf, draft.blades[i].size, soil);
            leaves.push(leaf);
        }
    }
    order(&mut leaves, draft.ink);
    (read, leaves)
}

/// Notes which of the blades lies in front.
fn order(blades: &mut [BladeReading], ink: &Ink) {
    let layers = layers(blades, ink);
    blades.iter_mut().zip(layers).for_each(|(blade, layer)| blade.front = layer);
}

fn blade_reading(draft: &Draft<'_>, i: usize, root: DVec2, veins: Vec<VeinReading>) -> BladeReading {
    let blade = &draft.blades[i];
    let s = &draft.ink.strokes[blade.stroke];
    let read = draft.kept.borrow_mut().leaves.get(
        s.index,
        |(outline, at, lines)| {
            same_bits(*at, root)
                && alike(outline, &blade.outline)
                && lines.len() == veins.len()
                && lines.iter().zip(&veins).all(|(a, b)| a.source == b.source && alike(&a.points, &b.points))
        },
        || (blade.outline.clone(), root, veins.clone()),
        || ribbed(&blade.outline, root, veins.clone()),
    );
    BladeReading { source: Some(s.index), color: s.color, ..read }
}

/// Returns a blade with its tip and midrib.
fn ribbed(outline: &[DVec2], root: DVec2, veins: Vec<VeinReading>) -> BladeReading {
    let far = tip(outline, root);
    let (rib, veins) = choose_midrib(veins, root, far);
    let veins = veins.into_iter().filter(|v| v.points.len() > 1).collect();
    let rib = match rib {
        Some(drawn) => midrib(&drawn, root, far),
        None => found_midrib(outline, root, far),
    };
    BladeReading {
        outline: outline.to_vec(),
        root,
        tip: far,
        midrib: rib,
        veins,
        bearer: None,
        whorl: 0,
        front: None,
        source: None,
        color: None,
    }
}

/// Finds or makes the stem of a flower: an axis that passes through its centre, one that ends within it (and is led
/// on to the centre), or a stalk from the nearest axis.
fn flower_bearer(draft: &mut Draft<'_>, centre: DVec2, reach: f64) -> Option<Attachment> {
    let (at, gap) = draft
        .forest
        .nearest(centre, (BEYOND * reach).clamp(WELL_SHORT, 0.5))
        .or_else(|| draft.forest.nearest(centre, FAR))?;
    if draft.forest.axes[at.axis].kind == AxisKind::Root {
        return None;
    }
    let length = draft.forest.length(at.axis);
    let tip = *draft.forest.axes[at.axis].points.last()?;
    if length - at.at < AT_END * length.min(reach) + SAME_PLACE && gap < (BEYOND * reach).max(WELL_SHORT) {
        let way = tip.distance(centre);
        if way > STEP {
            let more: Vec<DVec2> = (1..=6).map(|i| tip.lerp(centre, f64::from(i) / 6.0)).collect();
            let width = draft.forest.half_width(at.axis, f64::INFINITY);
            draft.forest.extend(at.axis, &more, width);
        }
        return Some(Attachment { axis: at.axis, at: draft.forest.length(at.axis) });
    }
    if gap < ON_AXIS {
        return Some(at);
    }
    let stalk = stalk(draft, at, centre, AxisKind::Stem)?;
    Some(Attachment { axis: stalk, at: draft.forest.length(stalk) })
}

/// Finds the bearer of a leaf; a leaf that does not touch it gets a stalk.
fn leaf_bearer(draft: &mut Draft<'_>, leaf: &BladeReading, size: f64, soil: &Near) -> Option<Attachment> {
    let (at, gap) = draft
        .forest
        .nearest(leaf.root, (0.3 * size).max(0.05))
        .or_else(|| draft.forest.nearest(leaf.root, FAR))?;
    let on_ground = gap > SESSILE && soil.nearest(leaf.root, gap, |_| true).is_some();
    if draft.forest.axes[at.axis].kind == AxisKind::Root || on_ground {
        return None;
    }
    if gap < SESSILE || gap < SESSILE_SHARE * size {
        return Some(at);
    }
    let stalk = stalk(draft, at, leaf.root, AxisKind::Petiole)?;
    Some(Attachment { axis: stalk, at: draft.forest.length(stalk) })
}

/// Adds a stalk from a place on an axis to `to`; it leaves its bearer a little below the nearest place.
fn stalk(draft: &mut Draft<'_>, at: Attachment, to: DVec2, kind: AxisKind) -> Option<usize> {
    let foot = point_at(&draft.forest.axes[at.axis].points, at.at)?;
    let lower = Attachment { axis: at.axis, at: (at.at - 0.5 * foot.distance(to)).max(0.0) };
    let from = point_at(&draft.forest.axes[at.axis].points, lower.at)?;
    let bend = from.lerp(to, 0.6) + (foot - from) * 0.1;
    let line: Vec<DVec2> =
        (0..=10).map(|i| f64::from(i) / 10.0).map(|t| from.lerp(bend, t).lerp(bend.lerp(to, t), t)).collect();
    let row = draft.forest.push(line, Vec::new(), Some(lower), None)?;
    draft.forest.axes[row].kind = kind;
    Some(row)
}

/// Hangs fruits on the nearest axis.
pub(crate) fn fruits(draft: &mut Draft<'_>, fruits: &mut [FruitReading]) {
    for fruit in fruits {
        let middle = geom::centroid(&fruit.outline);
        fruit.bearer = draft.forest.nearest(middle, FAR).map(|f| f.0);
    }
}
