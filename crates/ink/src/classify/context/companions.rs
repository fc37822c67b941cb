//! Companions of a stroke: the other strokes with which it is compared.

use std::sync::Arc;

use base::LiteMap;

use super::{KeptMeasures, Whole};
use crate::classify::features::Shape;

/// Most strokes that one stroke is compared with: the longest ones and its neighbours. The bound keeps a drawing of
/// 100,000 strokes linear.
pub(super) const COMPANIONS: usize = 48;
/// Number of companions that are the longest strokes of the whole drawing.
pub(super) const LONGEST: usize = 16;
/// Number of cells along the diagonal of the grid in which neighbours are looked up.
const CELLS: f64 = 24.0;
/// Most strokes kept in one cell.
const PER_CELL: usize = 6;

/// Strokes in each cell.
pub(super) type Grid = LiteMap<(i64, i64), Vec<usize>>;

/// Returns the places at which a stroke is looked up, in cells.
fn places(s: &Shape) -> [(f64, f64); 3] {
    [s.first(), s.points[s.points.len() / 2], s.last()]
        .map(|p| ((p.x * CELLS).floor(), (p.y * CELLS).floor()))
}

#[expect(clippy::cast_possible_truncation, reason = "ink coordinates lie in [0, 1]; `as` saturates")]
fn key(x: f64, y: f64) -> (i64, i64) {
    (x as i64, y as i64)
}

/// Returns the cells at a place and around it.
fn cells((x, y): (f64, f64)) -> impl Iterator<Item = (i64, i64)> {
    [0.0, -1.0, 1.0].into_iter().flat_map(move |dy| [0.0, -1.0, 1.0].map(|dx| key(x + dx, y + dy)))
}

/// Enters strokes into the cells that they lie in.
pub(super) fn grid(shapes: &[Arc<Shape>]) -> Grid {
    let mut grid = Grid::new();
    for (i, s) in shapes.iter().enumerate() {
        for (x, y) in places(s) {
            let slot = grid.entry(key(x, y)).or_default();
            if slot.len() < PER_CELL && slot.last() != Some(&i) {
                slot.push(i);
            }
        }
    }
    grid
}

/// Returns for each stroke the others that it is compared with, ascending: all of them in a sketch, else the longest of
/// the drawing and a bounded number of neighbours. Companions are reused where neither the stroke nor its cells
/// changed.
pub(super) fn companions(
    shapes: &[Arc<Shape>],
    same: &[bool],
    whole: &Whole,
    kept: &KeptMeasures,
) -> Vec<Arc<[usize]>> {
    let n = shapes.len();
    if n <= COMPANIONS + 1 {
        return (0..n).map(|i| (0..n).filter(|&j| j != i).collect()).collect();
    }
    let Whole { grid, longest, .. } = whole;
    let lasting = |cell: &(i64, i64), slot: &Vec<usize>| {
        kept.whole.grid.get(cell) == Some(slot) && slot.iter().all(|&j| same[j])
    };
    let changed = grid.iter().filter(|(cell, slot)| !lasting(cell, slot)).map(|(cell, _)| *cell);
    let gone = kept.whole.grid.keys().filter(|cell| !grid.contains_key(cell)).copied();
    let changed = base::set_of(changed.chain(gone));
    let before = kept.strokes.len();
    let known = |i: usize| {
        let known = kept.strokes.get(i).filter(|_| same[i] && kept.whole.longest == *longest)?;
        // The stroke that was last may now have one behind it.
        let last = (i + 1 < n) == (i + 1 < before);
        let lasts = last && places(&shapes[i]).into_iter().flat_map(cells).all(|c| !changed.contains_key(&c));
        lasts.then(|| Arc::clone(&known.companions))
    };
    let anew = |i: usize| {
        let mut near: Vec<usize> = Vec::new();
        for cell in places(&shapes[i]).into_iter().flat_map(cells) {
            near.extend(grid.get(&cell).into_iter().flatten());
        }
        near.sort_unstable();
        near.dedup();
        base::sort_by(&mut near, |&a, &b| {
            let far = |j: usize| shapes[j].middle.distance_squared(shapes[i].middle);
            far(a).total_cmp(&far(b)).then(a.cmp(&b))
        });
        near.retain(|&j| j != i);
        near.truncate(COMPANIONS - LONGEST);
        near.extend(longest.iter().filter(|&&j| j != i));
        near.extend([i.wrapping_sub(1), i + 1].into_iter().filter(|&j| j < n));
        near.sort_unstable();
        near.dedup();
        near.into()
    };
    (0..n).map(|i| known(i).unwrap_or_else(|| anew(i))).collect()
}
