//! Points -> neighbours, by a uniform grid.

use crate::vector::Vector;
use glam::{DVec2, DVec3};

type Cell = [i32; 3];

/// A fixed set of points in space, sorted into cubes, that answers neighbour questions.
///
/// Only occupied cells are stored, in flat sorted arrays, so far outliers cost nothing. Unusable points are
/// never found. Answers do not depend on the cell size; the cost does: best is a cell about as wide as the
/// radius asked for. A cell size that is not positive is replaced by one that suits the spacing of the points.
///
/// ```
/// use glam::DVec3;
/// let grid = geom::Grid3::new(&[DVec3::ZERO, DVec3::X, DVec3::X * 3.0], 1.0);
/// assert_eq!(grid.nearest(DVec3::X * 2.0, 5.0), Some(1)); // as near as point 2, but first
/// let mut near = Vec::new();
/// grid.within(DVec3::ZERO, 1.0, &mut near);
/// assert_eq!(near, [0, 1]);
/// ```
#[derive(Clone, Debug)]
pub struct Grid3 {
    /// Usable points in the order of their cells, with their indices.
    points: Vec<(DVec3, usize)>,
    /// Occupied cells, sorted by z, y, x, each with the index of its first point in `points`.
    cells: Vec<(Cell, usize)>,
    lo: DVec3,
    hi: DVec3,
    cell: f64,
}

impl Grid3 {
    /// Sorts points into cells of the given edge length. Cost: n log n.
    pub fn new(points: &[DVec3], cell: f64) -> Self {
        let usable = || points.iter().enumerate().filter(|(_, p)| p.usable());
        let (mut lo, mut hi, mut count) = (DVec3::INFINITY, DVec3::NEG_INFINITY, 0_usize);
        for (_, &p) in usable() {
            (lo, hi, count) = (lo.min(p), hi.max(p), count + 1);
        }
        if count == 0 {
            return Self { points: vec![], cells: vec![], lo: DVec3::ZERO, hi: DVec3::ZERO, cell: 1.0 };
        }
        let cell = if cell > 0.0 && cell.is_finite() { cell } else { Self::suitable_cell(hi - lo, count) };
        let mut grid = Self { points: Vec::with_capacity(count), cells: vec![], lo, hi, cell };
        let mut keyed: Vec<(Cell, usize)> = usable().map(|(i, &p)| (grid.cell_of(p), i)).collect();
        keyed.sort_unstable();
        for (key, i) in keyed {
            if grid.cells.last().is_none_or(|&(last, _)| last != key) {
                grid.cells.push((key, grid.points.len()));
            }
            grid.points.push((points[i], i));
        }
        grid
    }

    /// An edge with about two points per cell if the points fill their box.
    fn suitable_cell(size: DVec3, count: usize) -> f64 {
        let longest = size.max_element();
        let cell = longest / (0.5 * count as f64).sqrt().max(1.0);
        if cell > 0.0 { cell } else { 1.0 }
    }

    /// The cell of a point, z first. Saturates far outside, which keeps the order and so the answers.
    #[expect(clippy::cast_possible_truncation, reason = "saturation is wanted")]
    fn cell_of(&self, p: DVec3) -> Cell {
        let at = |x: f64, lo: f64| ((x - lo) / self.cell).floor() as i32;
        [at(p.z, self.lo.z), at(p.y, self.lo.y), at(p.x, self.lo.x)]
    }

    /// Calls `f` with every point whose cell meets the box of half width `r` around `p`, and maybe others.
    fn near(&self, p: DVec3, r: f64, mut f: impl FnMut(DVec3, usize)) {
        // Cells are those of the points' box, so that a huge radius does not visit empty space.
        let from = self.cell_of((p - DVec3::splat(r)).max(self.lo));
        let to = self.cell_of((p + DVec3::splat(r)).min(self.hi));
        if from.iter().zip(&to).any(|(a, b)| a > b) {
            return;
        }
        let rows = (i64::from(to[0]) - i64::from(from[0]) + 1)
            .saturating_mul(i64::from(to[1]) - i64::from(from[1]) + 1);
        if rows > i64::try_from(self.cells.len()).unwrap_or(i64::MAX) {
            self.points.iter().for_each(|&(q, i)| f(q, i));
            return;
        }
        for z in from[0]..=to[0] {
            for y in from[1]..=to[1] {
                let first = self.cells.partition_point(|&(c, _)| c < [z, y, from[2]]);
                let row = &self.cells[first..];
                let Some(&(_, start)) = row.first() else { continue };
                let end =
                    row.iter().find(|&&(c, _)| c > [z, y, to[2]]).map_or(self.points.len(), |&(_, k)| k);
                self.points[start..end].iter().for_each(|&(q, i)| f(q, i));
            }
        }
    }

    /// The index of the point nearest to `p` and at most `max` away; of equally near ones the lowest.
    ///
    /// `None` if there is none, if `p` is not usable or `max` is negative or NaN. `max` may be infinite.
    pub fn nearest(&self, p: DVec3, max: f64) -> Option<usize> {
        let sound = max >= 0.0;
        if !p.usable() || !sound || self.points.is_empty() {
            return None;
        }
        let gap = Vector::distance(p, p.clamp(self.lo, self.hi));
        if gap > max {
            return None;
        }
        let farthest = gap + Vector::length(self.hi - self.lo);
        let mut r = (gap + self.cell).min(max);
        loop {
            let mut best: Option<(f64, usize)> = None;
            self.near(p, r, |q, i| {
                let d = Vector::distance(p, q);
                if d <= r && best.is_none_or(|(e, k)| d < e || (d <= e && i < k)) {
                    best = Some((d, i));
                }
            });
            if let Some((_, i)) = best {
                return Some(i);
            }
            if r >= max || r > farthest {
                return None;
            }
            r = (r * 2.0).min(max);
        }
    }

    /// Replaces `out` by the indices of all points at most `r` away from `p`, lowest first.
    ///
    /// Empty if `p` is not usable or `r` is negative or NaN.
    pub fn within(&self, p: DVec3, r: f64, out: &mut Vec<usize>) {
        out.clear();
        let sound = r >= 0.0;
        if !p.usable() || !sound {
            return;
        }
        self.near(p, r, |q, i| {
            if Vector::distance(p, q) <= r {
                out.push(i);
            }
        });
        out.sort_unstable();
    }
}

/// [`Grid3`] in the plane.
///
/// ```
/// use glam::DVec2;
/// let grid = geom::Grid2::new(&[DVec2::ZERO, DVec2::NAN, DVec2::Y], 0.5);
/// assert_eq!(grid.nearest(DVec2::new(0.0, 0.8), f64::INFINITY), Some(2));
/// ```
#[derive(Clone, Debug)]
pub struct Grid2(Grid3);

impl Grid2 {
    /// Sorts points into square cells of the given edge length. Cost: n log n.
    pub fn new(points: &[DVec2], cell: f64) -> Self {
        let flat: Vec<DVec3> = points.iter().map(|p| p.extend(0.0)).collect();
        Self(Grid3::new(&flat, cell))
    }

    /// As [`Grid3::nearest`].
    pub fn nearest(&self, p: DVec2, max: f64) -> Option<usize> {
        self.0.nearest(p.extend(0.0), max)
    }

    /// As [`Grid3::within`].
    pub fn within(&self, p: DVec2, r: f64, out: &mut Vec<usize>) {
        self.0.within(p.extend(0.0), r, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn brute_within(points: &[DVec3], p: DVec3, r: f64) -> Vec<usize> {
        (0..points.len()).filter(|&i| points[i].usable() && Vector::distance(points[i], p) <= r).collect()
    }

    fn brute_nearest(points: &[DVec3], p: DVec3, max: f64) -> Option<usize> {
        let d = |i: usize| Vector::distance(points[i], p);
        let near = brute_within(points, p, max);
        near.into_iter().reduce(|a, b| if d(b) < d(a) { b } else { a })
    }

    /// A lattice has many ties; a few coordinates are wild.
    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![
            12 => (-4..4_i32).prop_map(|i| f64::from(i) * 0.5),
            4 => -2.0..2.0,
            1 => prop::sample::select(vec![1e300, f64::NAN, f64::NEG_INFINITY, 1e99, -1e30, 1e-300]),
        ]
    }

    fn point() -> impl Strategy<Value = DVec3> {
        (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn answers_equal_those_of_looking_at_every_point(
            points in prop::collection::vec(point(), 0..60),
            p in point(),
            r in prop_oneof![0.0..3.0, Just(0.5), Just(f64::INFINITY), Just(-1.0), Just(f64::NAN)],
            cell in prop::sample::select(vec![0.0, 1e-9, 0.1, 0.5, 2.0, 1e9, f64::NAN]),
        ) {
            let grid = Grid3::new(&points, cell);
            let mut out = vec![7];
            grid.within(p, r, &mut out);
            let usable = p.usable();
            prop_assert_eq!(&out, &if usable { brute_within(&points, p, r) } else { vec![] });
            prop_assert_eq!(grid.nearest(p, r), if usable { brute_nearest(&points, p, r) } else { None });
        }
    }
}
