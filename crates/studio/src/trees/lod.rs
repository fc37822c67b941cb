//! Coarser copies of a tree, for far away.

use plant::{NodeId, OrganKind, Plant};
use skin::SkinSpec;

/// A copy of `plant` for level `level` (1 to 6; 0 is the plant itself), and how to skin it.
///
/// Each level leaves out the axes of the highest order that is left (from level 2 on) and a half of the leaves; those
/// that stay grow so that together they cover as much. Leaves of axes that are gone sit on what bore the axes. Which
/// leaves stay follows from their keys: every level's are among those of the one before. Sides and rings become
/// fewer. Cost: linear.
pub fn coarser(plant: &Plant, skin: &SkinSpec, level: u32) -> (Plant, SkinSpec) {
    let level = level.min(6);
    let orders = plant.axes.iter().map(|a| a.order).max().unwrap_or(0);
    let highest = orders.saturating_sub(level.saturating_sub(1)).max(orders.min(1));
    let mut copy = Plant {
        name: plant.name.clone(),
        flowers: plant.flowers.clone(),
        shapes: plant.shapes.clone(),
        ..Plant::default()
    };
    // Where each node of the plant is in the copy: itself, or the node that bore its axis.
    let mut moved: Vec<Option<NodeId>> = vec![None; plant.nodes.position.len()];
    for axis in &plant.axes {
        let bearer = axis.bearer.and_then(|b| moved.get(b.index()).copied().flatten());
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        if axis.order > highest || rows.len() < 2 {
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
    let share = 1 << level;
    // The square root of the share keeps the area that the leaves cover.
    let larger = f64::from(share).sqrt();
    for organ in &plant.organs {
        let leaf = organ.kind == OrganKind::Leaf;
        if leaf && organ.key.reverse_bits() % u64::from(share as u32) != 0 {
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
