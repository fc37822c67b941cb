//! The leaf unrolled into a plane, like a photograph of the pressed leaf.

use geom::SurfacePoint;
use glam::{DVec2, DVec3};

/// A leaf laid flat: the midrib along +y from the origin, side veins with their true lengths.
///
/// Each step along a row keeps its length and its component along the midrib. Exact for a leaf that only bends along
/// the midrib or rolls about it.
///
/// Guaranteed: as many points as the grid; the margin's points are those of the first and last column. Not
/// guaranteed: that a badly folded leaf does not overlap itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlatLeaf {
    /// The points, row after row from the root, each row from left to right, metres.
    pub points: Vec<DVec2>,
    /// Points per row; the midrib is the middle one.
    pub columns: usize,
    /// Rows of points between neighbouring side veins: row `i * steps` is a side vein, the last is the tip.
    pub steps: usize,
    /// The margin, counter-clockwise, if it differs from the outline of the points; otherwise empty.
    pub rim: Vec<DVec2>,
    min: DVec2,
    size: DVec2,
}

impl FlatLeaf {
    /// Lays the grid of a surface flat: rows from the root up, `columns` points each from left to right.
    pub fn from_grid(points: &[SurfacePoint], columns: usize, steps: usize) -> Self {
        let middle = columns / 2;
        let rows = points.len() / columns;
        let at = |i: usize, j: usize| points[i * columns + j].position;
        let mut flat = vec![DVec2::ZERO; points.len()];
        let mut y = 0.0;
        for i in 0..rows {
            if i > 0 {
                y += at(i, middle).distance(at(i - 1, middle));
            }
            let before = at(i.saturating_sub(1), middle);
            let after = at((i + 1).min(rows - 1), middle);
            let along = (after - before).try_normalize().unwrap_or(DVec3::Y);
            flat[i * columns + middle] = DVec2::new(0.0, y);
            for side in [-1.0, 1.0] {
                let mut place = DVec2::new(0.0, y);
                let mut last = at(i, middle);
                for k in 1..=middle {
                    let j = if side < 0.0 { middle - k } else { middle + k };
                    let step = at(i, j) - last;
                    let rise = step.dot(along);
                    place += DVec2::new(side * (step.length_squared() - rise * rise).max(0.0).sqrt(), rise);
                    flat[i * columns + j] = place;
                    last = at(i, j);
                }
            }
        }
        let min = flat.iter().fold(DVec2::INFINITY, |a, &b| a.min(b));
        let max = flat.iter().fold(DVec2::NEG_INFINITY, |a, &b| a.max(b));
        let size = (max - min).max(DVec2::splat(f64::MIN_POSITIVE));
        Self { points: flat, columns, steps, rim: Vec::new(), min, size }
    }

    /// Returns the same leaf with a margin of its own, which widens the box around it.
    #[must_use]
    pub(crate) fn within(mut self, rim: Vec<DVec2>) -> Self {
        let max = rim.iter().fold(self.min + self.size, |a, &b| a.max(b));
        self.min = rim.iter().fold(self.min, |a, &b| a.min(b));
        self.size = max - self.min;
        self.rim = rim;
        self
    }

    /// Returns the texture coordinates of a point: the box around the flat leaf is the image, tip at the top.
    #[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in the mesh, by design")]
    pub fn uv_of(&self, p: DVec2) -> [f32; 2] {
        let p = (p - self.min) / self.size;
        [p.x as f32, (1.0 - p.y) as f32]
    }

    /// As [`uv_of`](Self::uv_of), for point `k`.
    pub fn uv(&self, k: usize) -> [f32; 2] {
        self.uv_of(self.points[k])
    }

    /// Returns the lowest corner and the size of the box around the flat leaf, metres.
    pub fn extent(&self) -> (DVec2, DVec2) {
        (self.min, self.size)
    }

    /// Returns the number of rows of points.
    pub fn rows(&self) -> usize {
        self.points.len().checked_div(self.columns).unwrap_or(0)
    }

    /// Returns the margin, counter-clockwise: its own, or that of the points from the root, lowest row to the right, up
    /// to the tip, down on the left.
    pub fn outline(&self) -> Vec<DVec2> {
        if !self.rim.is_empty() {
            return self.rim.clone();
        }
        let (n, rows) = (self.columns, self.rows());
        let middle = n / 2;
        if rows == 0 {
            return Vec::new();
        }
        let lowest = self.points[middle..n].iter();
        let right = (1..rows).map(|i| &self.points[i * n + n - 1]);
        // The tip is one point.
        let left = (0..rows.saturating_sub(1)).rev().map(|i| &self.points[i * n]);
        let back = self.points[1..middle].iter();
        lowest.chain(right).chain(left).chain(back).copied().collect()
    }

    /// Returns the midrib from root to tip.
    pub fn midrib(&self) -> Vec<DVec2> {
        (0..self.rows()).map(|i| self.points[i * self.columns + self.columns / 2]).collect()
    }

    /// Returns the side veins from the lowest up, each from the midrib outwards, left and right in turn.
    pub fn side_veins(&self) -> Vec<Vec<DVec2>> {
        let (n, middle) = (self.columns, self.columns / 2);
        let rows = (0..self.rows().saturating_sub(1)).step_by(self.steps.max(1));
        rows.flat_map(|i| {
            let row = &self.points[i * n..(i + 1) * n];
            [row[..=middle].iter().rev().copied().collect(), row[middle..].to_vec()]
        })
        .collect()
    }
}
