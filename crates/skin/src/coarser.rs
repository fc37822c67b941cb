//! Coarser copies of a tree, for a distant view.

use std::sync::Arc;

use crate::shoots::{FoliageStyle, Shoots};
use crate::spec::SkinSpec;
use glam::{DVec2, DVec3};
use plant::{AxisKind, Blade, FlowerId, Frame, NodeId, Organ, OrganKind, Plant, Shape};

/// Least axes that are thinned in the first level, because of fewer each is seen. In each further level, which is for
/// half the size, half of this.
const FEW_AXES: usize = 100;
/// Least leaves that are thinned in the first level; in each further level half of this.
const FEW_LEAVES: usize = 300;
/// Largest width of flowers of a coarser copy that are halved more than once, as a share of the plant's size.
const WIDEST_FLOWER: f64 = 0.05;
/// Least flowers that are thinned in the first level; in each further level half of this.
const FEW_FLOWERS: usize = 120;
/// Number that gives the least petals of a thinned flower: it keeps all of them in the first level, at least half of
/// this number in the second, and half of that in each further one.
const FEW_PETALS: usize = 5;

/// Returns how often `count` things can be halved, at most `level` times, before so few are left that each is seen:
/// `few` in the first level.
fn halvings(count: usize, few: usize, level: u32) -> u32 {
    let few = few >> level.saturating_sub(1);
    (count / few.max(1)).checked_ilog2().unwrap_or(0).min(level)
}

/// Largest ratio of the triangles of leaves to those of the level before.
const LEAVES_LEFT: f64 = 0.51;
/// The same for plants that lose no axes: their leaves compensate for the triangles that axes keep.
const LEAVES_LEFT_ALONE: f64 = 0.42;

/// Returns how often the leaves of a plant are halved: as seldom as a level still has at most half of the leaves'
/// triangles of the one before, so that the remaining leaves are no larger than necessary. The first level halves them
/// once.
fn leaf_halvings(plant: &Plant, skin: &SkinSpec, places: &Places, level: u32) -> u32 {
    let (level, count) = (level.min(6), leaves(plant).count());
    let first = halvings(count, FEW_LEAVES, level.min(1));
    if level < 2 {
        return first;
    }
    let fronds = has_fronds(plant, skin);
    let drawn = |at: u32| {
        let style = crowded(plant, skin, at);
        if fronds {
            let mut copy = plant.clone();
            widen(&mut copy, f64::from(1_u32 << first), leaflet_level(plant, at));
            return crate::drawn_triangles(&copy, &style);
        }
        crate::drawn_triangles(plant, &style)
    };
    let of_all = |each: &[usize], halved: u32| {
        let staying = leaves(plant).enumerate().filter(|(row, _)| places.stays(*row, halved));
        staying.map(|(_, o)| each.get(o.shape.index()).copied().unwrap_or(0)).sum::<usize>() as f64
    };
    let least = if plant.axes.len() > FEW_AXES { LEAVES_LEFT } else { LEAVES_LEFT_ALONE };
    let mut halved = first;
    let mut before = of_all(&drawn(1), halved);
    for at in 2..=level {
        let (most, each) = (halvings(count, FEW_LEAVES, at), drawn(at));
        while halved < most && of_all(&each, halved) > least * before {
            halved += 1;
        }
        before = of_all(&each, halved);
    }
    halved
}

/// Returns how often the flowers of a plant are halved, and the petals of each. From the second level on petals are
/// halved first, and more petals of flowers that would become too wide.
fn flower_halvings(plant: &Plant, level: u32) -> [u32; 2] {
    let petals = || plant.organs.iter().filter(|o| o.kind == OrganKind::Petal);
    let of_each = petals().count() / plant.flowers.len().max(1);
    let most_petals = if level > 1 { halvings(of_each, FEW_PETALS, level) } else { 0 };
    let first = most_petals.min(1);
    let most = halvings(plant.flowers.len(), FEW_FLOWERS, level).min(level - first);
    let size = plant.extent().map_or(0.0, |(low, high)| (high - low).length());
    let reach = |o: &Organ| plant.shapes.get(o.shape.index()).map_or(0.0, |s| s.reach() * o.scale);
    let longest = petals().map(reach).filter(|r| r.is_finite()).fold(0.0, f64::max);
    let fits = |n: &u32| 2.0 * longest * f64::from(1_u32 << n).sqrt() <= WIDEST_FLOWER * size;
    let flowers = (1..=most).rev().find(fits).unwrap_or(most.min(1));
    [flowers, most_petals.min(first.max(level - flowers))]
}

/// Returns the skin settings of a coarser copy: with the triangles of a plant of as many parts as the original has.
fn crowded(plant: &Plant, skin: &SkinSpec, level: u32) -> SkinSpec {
    let axes = plant.axes.iter().filter(|a| a.kind != AxisKind::Petiole).count();
    let crowd = skin.crowd.unwrap_or([axes, plant.organs.len()]);
    let fine = 1.0 / f64::from(1_u32 << level);
    let sides = skin.sides.saturating_sub(2 * level).max(3);
    SkinSpec { detail: skin.detail * fine, sides, crowd: Some(crowd), ..skin.clone() }
}

/// Places of leaves or flowers, each given by a number of its axis and its position among those of that axis.
#[derive(Default)]
struct Places(Vec<(u64, usize)>);

impl Places {
    /// Finds the places of things that these nodes bear, with a key each for those without a bearer.
    fn find(plant: &Plant, borne: impl Iterator<Item = (Option<NodeId>, u64)>) -> Self {
        let mut counts = vec![0_usize; plant.axes.len()];
        let mixed = |key: u64| base::Seed::new(key).child(0).number();
        let place = |(bearer, key): (Option<NodeId>, u64)| {
            let axis = bearer.and_then(|b| plant.nodes.axis.get(b.index())).map(|a| a.index());
            let row = axis.and_then(|a| Some((plant.axes.get(a)?, counts.get_mut(a)?)));
            row.map_or((mixed(key), 0), |(axis, n)| (mixed(axis.key), core::mem::replace(n, *n + 1)))
        };
        Self(borne.map(place).collect())
    }

    fn find_leaves(plant: &Plant) -> Self {
        Self::find(plant, leaves(plant).map(|o| (o.bearer, o.key)))
    }

    /// Whether the thing of a row remains after `halvings`. One in two on an axis does, alternately the left and the
    /// right one, so that no gaps appear; where each axis has one thing, that of one axis in two does.
    fn stays(&self, row: usize, halvings: u32) -> bool {
        let Some(&(axis, mut place)) = self.0.get(row) else { return true };
        (0..halvings).all(|h| {
            let one = place + place / 2;
            place /= 2;
            (one as u64 + (axis >> h)).is_multiple_of(2)
        })
    }
}

fn leaves(plant: &Plant) -> impl Iterator<Item = &Organ> {
    plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf)
}

/// Returns how much larger leaves are after `halvings` than on `plant`: the remaining ones cover the area of all.
fn larger(plant: &Plant, places: &Places, halvings: u32) -> f64 {
    let (mut all, mut kept) = (0.0, 0.0);
    for (row, leaf) in leaves(plant).enumerate() {
        let area = if leaf.scale.is_finite() { leaf.scale * leaf.scale } else { 0.0 };
        all += area;
        kept += if places.stays(row, halvings) { area } else { 0.0 };
    }
    if kept > 0.0 { (all / kept).sqrt().min(f64::from(1_u32 << halvings)) } else { 1.0 }
}

/// Gives leaves of a coarser copy of `plant` that may enter an obstacle their original size, at which they grew next to
/// it; or a smaller one, where they are drawn too wide even for that. `own`: the skin settings of `plant`.
pub fn keep_out(
    copy: &mut Plant,
    (skin, own): (&SkinSpec, &SkinSpec),
    plant: &Plant,
    level: u32,
    is_free: &dyn Fn(&Frame, f64, &[DVec3]) -> bool,
) {
    let places = Places::find_leaves(plant);
    let larger = larger(plant, &places, leaf_halvings(plant, own, &places, level));
    let drawn = crate::drawn_shapes(copy, skin);
    for organ in copy.organs.iter_mut().filter(|o| o.kind == OrganKind::Leaf) {
        for smaller in [larger, 4.0, 4.0] {
            if !is_free(&organ.frame, organ.scale, &drawn[organ.shape.index()]) {
                organ.scale /= smaller;
            }
        }
    }
}

/// Least leaves on an axis that may be the leaflets of a frond.
const FROND: usize = 16;
/// Least mean cosine between leaflets of a frond and its plane.
const LEVEL: f64 = 0.7;
/// Least mean cosine between leaflets on one side of a frond.
const PARALLEL: f64 = 0.95;
/// Least leaflets that lose their form in the second level: fewer hook where they hang, and that is seen.
const MANY_LEAFLETS: usize = 1_000;
/// Largest width over length of a leaflet of a frond, or of a petal, that stands for several, before it becomes longer,
/// too.
const STOUT: f64 = 1.0;

/// Whether the leaves of a plant stand on fronds, as those of palms and ferns, and are drawn as outlines.
fn has_fronds(plant: &Plant, skin: &SkinSpec) -> bool {
    if skin.foliage != FoliageStyle::Outlines {
        return false;
    }
    let axis = |o: &Organ| o.bearer.and_then(|b| plant.nodes.axis.get(b.index()).copied());
    let all: Vec<&Organ> = leaves(plant).collect();
    let (mut flat, mut parallel, mut pairs) = (0.0, 0.0, 0_usize);
    for w in all.windows(3).filter(|w| axis(w[0]).is_some() && axis(w[0]) == axis(w[2])) {
        flat += w[0].frame.normal.dot(w[1].frame.normal).abs();
        parallel += w[0].frame.along.dot(w[2].frame.along);
        pairs += 1;
    }
    let mut axes: Vec<_> = all.iter().filter_map(|o| axis(o)).collect();
    axes.dedup();
    let n = pairs.max(1) as f64;
    let blades =
        plant.shapes.iter().all(|s| matches!(s, Shape::Blade(b) if b.needles.is_none() && b.length() > 0.0));
    blades && all.len() >= FROND * axes.len().max(1) && flat >= LEVEL * n && parallel >= PARALLEL * n
}

/// Returns the level whose form leaflets of fronds have: where they are few, that of the level before.
fn leaflet_level(plant: &Plant, level: u32) -> u32 {
    level.saturating_sub(u32::from(leaves(plant).count() < MANY_LEAFLETS))
}

/// Makes leaflets of fronds that stand for several `times` as large in area: wider while they are slender, which keeps
/// fronds at their width. From the second level on all have one plain form. Returns the enlargement that is still
/// missing.
fn widen(copy: &mut Plant, times: f64, level: u32) -> f64 {
    let mut left: f64 = 1.0;
    for shape in &mut copy.shapes {
        let Shape::Blade(blade) = shape else { continue };
        let length = blade.length();
        if level > 1 {
            let half = geom::signed_area(&blade.outline) / length;
            // A wide foot, so that those of a frond join along its stalk; folded in the second level, and flat after
            // it.
            let (right, at) = (DVec2::new(half, 0.0), DVec2::new(0.0, length));
            blade.outline = vec![DVec2::ZERO, right, at, DVec2::new(-half, 0.0)];
            if level > 2 {
                blade.outline.remove(0);
            }
            blade.midrib = vec![DVec2::ZERO, at];
        }
        if let Some(wider) = widened(blade, times) {
            left = left.max((times / wider).sqrt());
        }
    }
    left
}

/// Makes a blade wider, up to `times`, while it is slender; returns the factor.
fn widened(blade: &mut Blade, times: f64) -> Option<f64> {
    let half = blade.outline.iter().map(|p| p.x.abs()).fold(0.0, f64::max);
    if blade.needles.is_some() || half.is_nan() || half <= 0.0 {
        return None;
    }
    let wider = (0.5 * STOUT * blade.length() / half).clamp(1.0, times.max(1.0));
    blade.outline.iter_mut().for_each(|p| p.x *= wider);
    blade.veins.clear();
    Some(wider)
}

/// Makes petals that stand for several `times` as large in area: wider while they are slender, so that spikes and
/// plumes keep their thickness; [`cover_as_much`] then makes them no longer than necessary.
fn widen_petals(copy: &mut Plant, plant: &Plant, times: f64) {
    let mut seen = vec![false; copy.shapes.len()];
    for petal in plant.organs.iter().filter(|o| o.kind == OrganKind::Petal) {
        let row = petal.shape.index();
        let Some(Shape::Blade(blade)) = copy.shapes.get_mut(row) else { continue };
        if !std::mem::replace(&mut seen[row], true) {
            widened(blade, times);
        }
    }
}

/// Gives a coarser copy of a plant its longest axes. Returns where each node of the plant is in the copy: itself, or
/// the node that bore its axis.
fn longest_axes(
    copy: &mut Plant,
    plant: &Plant,
    level: u32,
    [shoots, fronds]: [bool; 2],
) -> Vec<Option<NodeId>> {
    let length = |axis: &plant::Axis| {
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        plant.nodes.position[rows].windows(2).map(|w| w[0].distance(w[1])).sum::<f64>()
    };
    let mut lengths: Vec<f64> = plant.axes.iter().map(length).collect();
    base::sort_by(&mut lengths, |a, b| b.total_cmp(a));
    // Shoots have twigs of their own, and leaves hide those of a crown, but leaflets without the stalk of their frond
    // float.
    let hidden = !fronds && leaves(plant).count() > plant.axes.len();
    let finer = u32::from((shoots || hidden) && level > 1);
    let kept_axes = lengths.len() >> halvings(lengths.len(), FEW_AXES, level + finer);
    let least = lengths.get(kept_axes).copied().unwrap_or(0.0);
    let mut moved: Vec<Option<NodeId>> = vec![None; plant.nodes.position.len()];
    let mut gone = vec![false; plant.axes.len()];
    for (row, axis) in plant.axes.iter().enumerate() {
        let bearer = axis.bearer.and_then(|b| moved.get(b.index()).copied().flatten());
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        let orphan = axis.bearer.is_some_and(|b| gone[plant.nodes.axis[b.index()].index()]);
        let unseen = matches!(axis.kind, AxisKind::Root | AxisKind::Stub) && level > 1;
        if rows.len() < 2 || orphan || unseen || (axis.order > 0 && length(axis) < least) {
            gone[row] = true;
            moved[rows].fill(bearer);
            continue;
        }
        let points = &plant.nodes.position[rows.clone()];
        let id = copy.add_axis(axis.kind, bearer, axis.key, points, axis.source);
        for (new, old) in copy.axis(id).node_ids().zip(rows) {
            copy.nodes.radius_m[new.index()] = plant.nodes.radius_m[old];
            moved[old] = Some(new);
        }
    }
    moved
}

/// Returns a copy of `plant` for level `level` (1 to 6; 0 is the plant itself), and its skin settings.
///
/// Each level omits the shorter half of the axes, and as many leaves and flowers as necessary for half of the
/// triangles, while there are many for the size at which it is seen; from the second level on there are no roots,
/// flowers have fewer petals, and many flowers have no stalks. The remaining leaves and flowers grow so that together
/// they cover the same area, leaflets of fronds in width before length; those of omitted axes sit on the bearers of the
/// axes. The choice follows from the keys of their axes and their positions on these, evenly along each: every level's
/// are among those of the one before. Sides and rings become fewer. With [`FoliageStyle::ByLevel`] leaves become cards
/// in the first level, and cards of shoots in the others, with twice as many leaves from each level to the next. Cost:
/// n log n in axes and leaves.
pub fn coarser(plant: &Plant, skin: &SkinSpec, level: u32) -> (Plant, SkinSpec) {
    coarser_with(plant, skin, level, None)
}

/// [`coarser`] with the painted shoots of another plant, if they fit.
pub fn coarser_with(
    plant: &Plant,
    skin: &SkinSpec,
    level: u32,
    painted: Option<&Shoots>,
) -> (Plant, SkinSpec) {
    let level = level.min(6);
    let own = || painted.and_then(|s| s.lent(plant)).or_else(|| Shoots::find(plant)).map(Arc::new);
    let shoots = (skin.foliage == FoliageStyle::ByLevel && level > 0).then(own).flatten();
    let mut copy = Plant {
        name: plant.name.clone(),
        shapes: plant.shapes.clone(),
        paint: plant.paint,
        ..Plant::default()
    };
    let fronds = has_fronds(plant, skin);
    let moved = longest_axes(&mut copy, plant, level, [shoots.is_some(), fronds]);
    let now = |bearer: Option<NodeId>| bearer.and_then(|b| moved.get(b.index()).copied().flatten());
    let [flower_halvings, petal_halvings] = flower_halvings(plant, level);
    let places = Places::find(plant, plant.flowers.iter().map(|f| f.bearer).zip(0..));
    let mut flowers: Vec<Option<FlowerId>> = Vec::with_capacity(plant.flowers.len());
    for (row, flower) in plant.flowers.iter().enumerate() {
        let id = places.stays(row, flower_halvings).then_some(FlowerId::new(copy.flowers.len()));
        flowers.push(id);
        if id.is_some() {
            copy.flowers.push(plant::Flower { bearer: now(flower.bearer), ..flower.clone() });
        }
    }
    let fewer_flowers = (plant.flowers.len() as f64 / copy.flowers.len().max(1) as f64).sqrt();
    widen_petals(&mut copy, plant, fewer_flowers * fewer_flowers * f64::from(1_u32 << petal_halvings));
    let mut petals = vec![0_usize; plant.flowers.len()];
    let whole_shoots = shoots.as_ref().filter(|_| level > 1);
    let places = Places::find_leaves(plant);
    let leaf_halvings = if whole_shoots.is_some() { 0 } else { leaf_halvings(plant, skin, &places, level) };
    let mut larger = larger(plant, &places, leaf_halvings);
    if fronds {
        larger = widen(&mut copy, larger * larger, leaflet_level(plant, level));
    }
    let mut row = 0;
    for organ in &plant.organs {
        let flower = organ.flower.map(|f| flowers.get(f.index()).copied().flatten());
        let leaf = organ.kind == OrganKind::Leaf;
        row += usize::from(leaf);
        // Stalks of many flowers are seen in the first level alone.
        let stalk = organ.kind == OrganKind::Pedicel && level > 1 && flower_halvings > 0;
        if flower == Some(None) || stalk || (leaf && !places.stays(row - 1, leaf_halvings)) {
            continue;
        }
        if let (OrganKind::Petal, Some(row)) = (organ.kind, organ.flower) {
            let nth = petals.get_mut(row.index()).map_or(0, |n| std::mem::replace(n, *n + 1));
            if !nth.is_multiple_of(1 << petal_halvings) {
                continue;
            }
        }
        // A stalk is unchanged: it leads to the middle of its flower.
        let larger = match organ.kind {
            OrganKind::Leaf => larger,
            OrganKind::Pedicel => 1.0,
            _ if flower.is_some() => fewer_flowers,
            _ => 1.0,
        };
        copy.organs.push(Organ {
            bearer: now(organ.bearer),
            flower: flower.flatten(),
            scale: organ.scale * larger,
            ..organ.clone()
        });
    }
    if let Some(shoots) = whole_shoots {
        shoots.stand_in(&mut copy, 1 << (level - 2));
    }
    let foliage =
        if level > 0 && skin.foliage == FoliageStyle::ByLevel { FoliageStyle::Cards } else { skin.foliage };
    let coarse = SkinSpec { foliage, shoots, ..crowded(plant, skin, level) };
    cover_as_much(&mut copy, &coarse, (plant, skin), |kind| kind == OrganKind::Leaf);
    cover_as_much(&mut copy, &coarse, (plant, skin), |kind| kind == OrganKind::Petal);
    (copy, coarse)
}

/// Gives the leaves or petals of a coarser copy the size at which they cover the same area as those of the plant, both
/// as drawn: a leaf of few triangles has not the area of its form.
fn cover_as_much(
    copy: &mut Plant,
    coarse: &SkinSpec,
    (plant, skin): (&Plant, &SkinSpec),
    is: impl Fn(OrganKind) -> bool,
) {
    let covered = |plant: &Plant, skin: &SkinSpec| {
        let areas = crate::drawn_areas(plant, skin);
        let leaves = plant.organs.iter().filter(|o| is(o.kind) && o.scale.is_finite());
        let area = |o: &Organ| areas.get(o.shape.index()).copied().unwrap_or(0.0) * o.scale * o.scale;
        leaves.map(area).sum::<f64>()
    };
    let (wanted, have) = (covered(plant, skin), covered(copy, coarse));
    if have > 0.0 && wanted > 0.0 {
        let size = (wanted / have).sqrt().clamp(0.5, 2.0);
        copy.organs.iter_mut().filter(|o| is(o.kind)).for_each(|o| o.scale *= size);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaflets_go_evenly_and_on_both_sides_of_a_frond() {
        let places = Places((0..64).map(|n| (0b101, n)).collect());
        let mut before: Vec<usize> = (0..64).collect();
        for halvings in 1..=4_u32 {
            let stay: Vec<usize> = (0..64).filter(|&n| places.stays(n, halvings)).collect();
            assert_eq!(stay.len(), 64 >> halvings);
            assert!(stay.iter().all(|n| before.contains(n)), "{halvings}: of those of the level before");
            let gap = stay.windows(2).map(|w| w[1] - w[0]).max().unwrap_or(0);
            assert!(gap < 2 << halvings, "{halvings}: a gap of {gap}");
            let left = stay.iter().filter(|n| **n % 2 == 0).count();
            assert_eq!(left, stay.len() / 2, "{halvings}");
            before = stay;
        }
    }

    #[test]
    fn leaflets_become_wider_while_they_are_slender() {
        let blade = |half: f64| Blade {
            outline: vec![DVec2::ZERO, DVec2::new(half, 0.5), DVec2::Y, DVec2::new(-half, 0.5)],
            midrib: vec![DVec2::ZERO, DVec2::Y],
            veins: vec![vec![DVec2::ZERO, DVec2::Y].into()],
            needles: None,
            lift: plant::Lift::Flat,
            relief: plant::Relief::default(),
        };
        for (half, times, want) in [(0.05, 4.0, 4.0), (0.05, 40.0, 10.0), (0.8, 4.0, 1.0), (0.05, 0.5, 1.0)] {
            let mut wide = blade(half);
            let got = widened(&mut wide, times).expect("it has a width");
            assert!((got - want).abs() < 1e-12, "{half}, {times}: {got}");
            assert!((wide.outline[1].x - half * want).abs() < 1e-12 && wide.outline[2] == DVec2::Y);
            assert!(wide.veins.is_empty(), "its veins are not where they were");
        }
        assert_eq!(widened(&mut blade(0.0), 2.0), None);
        assert_eq!(widened(&mut blade(f64::NAN), 2.0), None);
    }

    /// Makes a crown of `count` fronds of twenty leaflets, which hang from the stalk by `falls` radians on both sides.
    fn fronds(count: u32, falls: f64) -> Plant {
        let mut plant = Plant { name: "palm".to_owned(), ..Plant::default() };
        plant.shapes.push(Shape::Blade(plant::BladeForm::Leaflet.blade()));
        plant.add_axis(AxisKind::Branch, None, 0, &[DVec3::ZERO, DVec3::Y], None);
        let foot = NodeId::new(1);
        for k in 0..count {
            let out = base::turn::about(DVec3::Y, f64::from(k)) * DVec3::X;
            let points: Vec<DVec3> = (0..12).map(|n| DVec3::Y + out * (0.1 * f64::from(n))).collect();
            let id = plant.add_axis(AxisKind::Branch, Some(foot), u64::from(k), &points, None);
            let nodes: Vec<NodeId> = plant.axis(id).node_ids().skip(2).collect();
            for node in nodes {
                for side in [1.0, -1.0] {
                    let aside = out.cross(DVec3::Y) * side;
                    let (s, c) = base::ops::sin_cos(falls);
                    let frame = Frame::looking(
                        plant.nodes.position[node.index()],
                        aside * c - DVec3::Y * s,
                        DVec3::Y,
                    );
                    plant.organs.push(Organ {
                        kind: OrganKind::Leaf,
                        bearer: Some(node),
                        flower: None,
                        shape: plant::ShapeId::new(0),
                        frame,
                        scale: 0.4,
                        paint: plant::Paint::default(),
                        key: plant.organs.len() as u64,
                        source: None,
                    });
                }
            }
        }
        plant
    }

    #[test]
    fn leaflets_keep_the_stalk_of_their_frond() {
        let skin = SkinSpec { foliage: FoliageStyle::Outlines, ..SkinSpec::default() };
        // As many as would lose half of their stalks in the second level if leaves hid them.
        let palm = fronds(60, 0.3);
        assert!(has_fronds(&palm, &skin));
        for level in 1..=2 {
            let (copy, _) = coarser(&palm, &skin, level);
            // The stem bears the leaves of an omitted axis, far from where they lie.
            let away =
                |o: &Organ| o.bearer.map_or(1.0, |b| copy.nodes.position[b.index()].distance(o.frame.origin));
            assert!(leaves(&copy).count() >= 60 && leaves(&copy).all(|o| away(o) < 1e-9), "{level}");
        }
    }

    #[test]
    fn fronds_may_fall_off_on_both_sides_but_not_hang() {
        let skin = SkinSpec { foliage: FoliageStyle::Outlines, ..SkinSpec::default() };
        for (falls, want) in [(0.0, true), (0.3, true), (0.7, false)] {
            assert_eq!(has_fronds(&fronds(9, falls), &skin), want, "{falls}");
        }
    }

    #[test]
    fn leaves_that_stand_alone_stay_on_every_second_twig() {
        let places = Places((0..1000).map(|key| (base::Seed::new(key).child(0).number(), 0)).collect());
        for halvings in 1..=3_u32 {
            let stay = (0..1000).filter(|&n| places.stays(n, halvings)).count();
            assert!((850..1150).contains(&(stay << halvings)), "{halvings}: {stay}");
        }
    }
}
