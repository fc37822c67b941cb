//! Coarser copies of a tree, for far away.

use std::sync::Arc;

use growth::Obstacles;
use plant::{AxisKind, FlowerId, NodeId, OrganKind, Plant};
use skin::{FoliageStyle, Shoots, SkinSpec};

/// Fewer axes, leaves or flowers than this are not thinned in the first level: each of them is seen. In each further level,
/// which is for half the size, half as many.
const FEW_AXES: usize = 100;
const FEW_LEAVES: usize = 300;
/// Leaves of a coarser copy are no longer than this share of the plant's size: a few large ones would be spikes.
const LONGEST: f64 = 0.07;
const FEW_FLOWERS: usize = 120;
/// A flower keeps all of its petals in the first level, half of so many in the second, and half of those in each further one.
const FEW_PETALS: usize = 5;

/// How often so many things can be halved, `level` times at most, before fewer are left than can be seen singly: `few` in
/// the first level.
fn halvings(count: usize, few: usize, level: u32) -> u32 {
    let few = few >> level.saturating_sub(1);
    (count / few.max(1)).checked_ilog2().unwrap_or(0).min(level)
}

/// How often the leaves of a plant are halved.
fn leaf_halvings(plant: &Plant, level: u32) -> u32 {
    let leaves = || plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
    let most = halvings(leaves().count(), FEW_LEAVES, level.min(6));
    let size = plant.extent().map_or(0.0, |(low, high)| (high - low).length());
    let reach = |o: &plant::Organ| plant.shapes.get(o.shape.index()).map_or(0.0, |s| s.reach() * o.scale);
    let longest = leaves().map(reach).filter(|r| r.is_finite()).fold(0.0, f64::max);
    let fits = |n: &u32| longest * f64::from(1_u32 << n).sqrt() <= LONGEST * size;
    // Once less at most, and where most triangles are wood: a level has half of those of the one before.
    let woody = plant.axes.len() > leaves().count();
    let least = if level > 2 && most == level && woody { most - 1 } else { most };
    (least..=most).rev().find(fits).unwrap_or(least)
}

/// Whether a leaf or flower with this key outlives so many halvings. Mixed: of keys that differ little, too, one in two
/// stays.
fn stays(key: u64, halvings: u32) -> bool {
    base::Seed::new(key).child(0).number().is_multiple_of(1 << halvings)
}

/// How much larger leaves are after so many halvings than on `plant`: those that stay cover what all did.
fn larger(plant: &Plant, halvings: u32) -> f64 {
    let (mut all, mut kept) = (0.0, 0.0);
    for leaf in plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf && o.scale.is_finite()) {
        let area = leaf.scale * leaf.scale;
        all += area;
        kept += if stays(leaf.key, halvings) { area } else { 0.0 };
    }
    if kept > 0.0 { (all / kept).sqrt().min(f64::from(1_u32 << halvings)) } else { 1.0 }
}

/// Gives leaves of a coarser copy of `plant` that may enter an obstacle their own size again, in which they grew beside
/// it; or, where they are drawn too wide for that too, a smaller one.
pub(super) fn keep_out(copy: &mut Plant, skin: &SkinSpec, plant: &Plant, level: u32, obstacles: &Obstacles) {
    if obstacles.is_empty() {
        return;
    }
    let larger = larger(plant, leaf_halvings(plant, level));
    let drawn = skin::drawn_shapes(copy, skin);
    for organ in copy.organs.iter_mut().filter(|o| o.kind == OrganKind::Leaf) {
        for smaller in [larger, 4.0, 4.0] {
            if !obstacles.admit(&organ.frame, organ.scale, &drawn[organ.shape.index()]) {
                organ.scale /= smaller;
            }
        }
    }
}

/// A copy of `plant` for level `level` (1 to 6; 0 is the plant itself), and how to skin it.
///
/// Each level leaves out the shorter half of the axes, a half of the leaves and a half of the flowers, as long as there
/// are many for the size at which it is seen; from the second level on there are no roots; flowers that are few have fewer petals from the second level on. Leaves and flowers that stay grow so that together they cover as much; those of axes that are gone sit on what bore the axes.
/// Which leaves stay follows from their keys: every level's are among those of the one before. Sides and rings
/// become fewer. With [`FoliageStyle::ByLevel`] leaves become cards in the first level, and cards of shoots in the others, of
/// twice as many leaves from each level to the next. Cost: n log n in axes and leaves.
pub fn coarser(plant: &Plant, skin: &SkinSpec, level: u32) -> (Plant, SkinSpec) {
    let level = level.min(6);
    let shoots = (skin.foliage == FoliageStyle::ByLevel && level > 0)
        .then(|| Shoots::of(plant).map(Arc::new))
        .flatten();
    let length = |axis: &plant::Axis| {
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        plant.nodes.position[rows].windows(2).map(|w| w[0].distance(w[1])).sum::<f64>()
    };
    let mut lengths: Vec<f64> = plant.axes.iter().map(length).collect();
    base::sort_by(&mut lengths, |a, b| b.total_cmp(a));
    // Shoots have twigs of their own.
    let finer = u32::from(shoots.is_some() && level > 1);
    let kept_axes = lengths.len() >> halvings(lengths.len(), FEW_AXES, level + finer);
    let least = lengths.get(kept_axes).copied().unwrap_or(0.0);
    let mut copy = Plant {
        name: plant.name.clone(),
        shapes: plant.shapes.clone(),
        paint: plant.paint,
        ..Plant::default()
    };
    // Where each node of the plant is in the copy: itself, or the node that bore its axis.
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
    let now = |bearer: Option<NodeId>| bearer.and_then(|b| moved.get(b.index()).copied().flatten());
    let flower_halvings = halvings(plant.flowers.len(), FEW_FLOWERS, level);
    let mut flowers: Vec<Option<FlowerId>> = Vec::with_capacity(plant.flowers.len());
    for (flower, key) in plant.flowers.iter().zip(0..) {
        let id = stays(key, flower_halvings).then_some(FlowerId::new(copy.flowers.len()));
        flowers.push(id);
        if id.is_some() {
            copy.flowers.push(plant::Flower { bearer: now(flower.bearer), ..flower.clone() });
        }
    }
    let fewer_flowers = (plant.flowers.len() as f64 / copy.flowers.len().max(1) as f64).sqrt();
    // Flowers that are too few to be fewer have fewer petals.
    let petals = plant.organs.iter().filter(|o| o.kind == OrganKind::Petal).count();
    let of_each = petals / plant.flowers.len().max(1);
    let petal_halvings =
        if level > 1 { halvings(of_each, FEW_PETALS, level).min(level - flower_halvings) } else { 0 };
    let mut petals = vec![0_usize; plant.flowers.len()];
    let whole_shoots = shoots.as_ref().filter(|_| level > 1);
    let leaf_halvings = if whole_shoots.is_some() { 0 } else { leaf_halvings(plant, level) };
    let larger = larger(plant, leaf_halvings);
    for organ in &plant.organs {
        let flower = organ.flower.map(|f| flowers.get(f.index()).copied().flatten());
        let leaf = organ.kind == OrganKind::Leaf;
        if flower == Some(None) || (leaf && !stays(organ.key, leaf_halvings)) {
            continue;
        }
        if let (OrganKind::Petal, Some(row)) = (organ.kind, organ.flower) {
            let nth = petals.get_mut(row.index()).map_or(0, |n| std::mem::replace(n, *n + 1));
            if !nth.is_multiple_of(1 << petal_halvings) {
                continue;
            }
        }
        // A stalk stays as it is: it leads to the middle of its flower.
        let larger = match organ.kind {
            OrganKind::Leaf => larger,
            OrganKind::Pedicel => 1.0,
            _ if flower.is_some() => fewer_flowers,
            _ => 1.0,
        };
        copy.organs.push(plant::Organ {
            bearer: now(organ.bearer),
            flower: flower.flatten(),
            scale: organ.scale * larger,
            ..organ.clone()
        });
    }
    let fine = 1.0 / f64::from(1_u32 << level);
    let axes = plant.axes.iter().filter(|a| a.kind != AxisKind::Petiole).count();
    let crowd = skin.crowd.unwrap_or([axes, plant.organs.len()]);
    let sides = skin.sides.saturating_sub(2 * level).max(3);
    if let Some(shoots) = whole_shoots {
        shoots.stand_in(&mut copy, 1 << (level - 2));
    }
    let foliage =
        if level > 0 && skin.foliage == FoliageStyle::ByLevel { FoliageStyle::Cards } else { skin.foliage };
    let coarse =
        SkinSpec { detail: skin.detail * fine, sides, crowd: Some(crowd), foliage, shoots, ..skin.clone() };
    cover_as_much(&mut copy, &coarse, (plant, skin), |kind| kind == OrganKind::Leaf);
    cover_as_much(&mut copy, &coarse, (plant, skin), |kind| kind == OrganKind::Petal);
    (copy, coarse)
}

/// Gives the leaves or petals of a coarser copy the size at which they cover what those of the plant do as both are drawn: of
/// few triangles a leaf has not the area of its form.
fn cover_as_much(
    copy: &mut Plant,
    coarse: &SkinSpec,
    (plant, skin): (&Plant, &SkinSpec),
    is: impl Fn(OrganKind) -> bool,
) {
    let covered = |plant: &Plant, skin: &SkinSpec| {
        let areas = skin::drawn_areas(plant, skin);
        let leaves = plant.organs.iter().filter(|o| is(o.kind) && o.scale.is_finite());
        let area = |o: &plant::Organ| areas.get(o.shape.index()).copied().unwrap_or(0.0) * o.scale * o.scale;
        leaves.map(area).sum::<f64>()
    };
    let (wanted, have) = (covered(plant, skin), covered(copy, coarse));
    if have > 0.0 && wanted > 0.0 {
        let size = (wanted / have).sqrt().clamp(0.5, 2.0);
        copy.organs.iter_mut().filter(|o| is(o.kind)).for_each(|o| o.scale *= size);
    }
}
