//! Coarser copies of a tree, for far away.

use growth::Obstacles;
use plant::{NodeId, OrganKind, Plant};
use skin::SkinSpec;

/// How much larger leaves are: the square root of the share that is gone keeps the area that they cover.
fn larger(level: u32) -> f64 {
    f64::from(1_u32 << level.min(6)).sqrt()
}

/// Gives leaves of a coarser copy that would enter an obstacle their own size again, in which they grew beside it.
pub(super) fn keep_out(copy: &mut Plant, level: u32, obstacles: &Obstacles) {
    if obstacles.is_empty() {
        return;
    }
    let corners: Vec<_> = copy.shapes.iter().map(plant::Shape::corners).collect();
    for organ in copy.organs.iter_mut().filter(|o| o.kind == OrganKind::Leaf) {
        if !obstacles.admit(&organ.frame, organ.scale, &corners[organ.shape.index()]) {
            organ.scale /= larger(level);
        }
    }
}

/// A copy of `plant` for level `level` (1 to 6; 0 is the plant itself), and how to skin it.
///
/// Each level leaves out a half of the leaves, and from level 2 on the shorter half of the axes, with what they bear.
/// Leaves that stay grow so that together they cover as much; those of axes that are gone sit on what bore the axes.
/// Which leaves stay follows from their keys: every level's are among those of the one before. Sides and rings
/// become fewer. Cost: n log n in axes.
pub fn coarser(plant: &Plant, skin: &SkinSpec, level: u32) -> (Plant, SkinSpec) {
    let level = level.min(6);
    let length = |axis: &plant::Axis| {
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        plant.nodes.position[rows].windows(2).map(|w| w[0].distance(w[1])).sum::<f64>()
    };
    let mut lengths: Vec<f64> = plant.axes.iter().map(length).collect();
    base::sort_by(&mut lengths, |a, b| b.total_cmp(a));
    let kept_axes = lengths.len() >> level.saturating_sub(1);
    let least = if level < 2 { 0.0 } else { lengths.get(kept_axes).copied().unwrap_or(0.0) };
    let mut copy = Plant {
        name: plant.name.clone(),
        flowers: plant.flowers.clone(),
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
        if rows.len() < 2 || orphan || (axis.order > 0 && length(axis) < least) {
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
    let share = 1_u32 << level;
    let larger = larger(level);
    for organ in &plant.organs {
        let leaf = organ.kind == OrganKind::Leaf;
        // Mixed: of keys that differ little, too, one in two stays.
        if leaf && !base::Seed::new(organ.key).child(0).number().is_multiple_of(u64::from(share)) {
            continue;
        }
        let bearer = organ.bearer.and_then(|b| moved.get(b.index()).copied().flatten());
        let scale = if leaf { organ.scale * larger } else { organ.scale };
        copy.organs.push(plant::Organ { bearer, scale, ..organ.clone() });
    }
    let fine = 1.0 / f64::from(share);
    let sides = skin.sides.saturating_sub(2 * level).max(3);
    (copy, SkinSpec { detail: skin.detail * fine, sides, ..skin.clone() })
}
