//! Trees of a stand by cells, in a counting sort.

use glam::DVec2;

use super::Member;

/// Start of the trees of each cell; trees are in order of their cells.
pub(super) struct Grid {
    low: DVec2,
    side: f64,
    columns: usize,
    rows: usize,
    starts: Vec<u32>,
}

impl Grid {
    /// Sorts trees by square cells of at least `side`, with at most as many cells as trees. Within a cell the order
    /// stays.
    pub(super) fn sort(members: &mut Vec<Member>, low: DVec2, size: DVec2, side: f64) -> Self {
        let least = (size.x * size.y / members.len().max(1) as f64).sqrt();
        let side = side.max(least).max(size.max_element() / 60_000.0);
        let count = |length: f64| base::ops::whole((length / side).ceil()).max(1) as usize;
        let (columns, rows) = (count(size.x), count(size.y));
        let mut grid = Self { low, side, columns, rows, starts: vec![0; columns * rows + 1] };
        for m in members.iter() {
            let cell = grid.cell(m.place());
            grid.starts[cell + 1] += 1;
        }
        for c in 1..grid.starts.len() {
            grid.starts[c] += grid.starts[c - 1];
        }
        let mut next = grid.starts.clone();
        let mut sorted = vec![Member::default(); members.len()];
        for m in members.iter() {
            let slot = &mut next[grid.cell(m.place())];
            sorted[*slot as usize] = *m;
            *slot += 1;
        }
        *members = sorted;
        grid
    }

    /// Returns the mean number of trees in the cells around a tree.
    pub(super) fn neighbours(&self, members: usize) -> f64 {
        let cells = (self.columns * self.rows) as f64;
        members as f64 / cells * cells.min(9.0)
    }

    fn split(&self, p: DVec2) -> (usize, usize) {
        let at = (p - self.low) / self.side;
        let index = |v: f64, count: usize| (base::ops::whole(v) as usize).min(count - 1);
        (index(at.x, self.columns), index(at.y, self.rows))
    }

    fn cell(&self, p: DVec2) -> usize {
        let (x, y) = self.split(p);
        y * self.columns + x
    }

    /// Returns the trees in the cells around a place, as ranges of rows: all trees nearer than the side of a cell,
    /// and some others.
    pub(super) fn near(&self, p: DVec2) -> impl Iterator<Item = core::ops::Range<usize>> + '_ {
        let (x, y) = self.split(p);
        let (x0, x1) = (x.saturating_sub(1), (x + 1).min(self.columns - 1));
        (y.saturating_sub(1)..=(y + 1).min(self.rows - 1)).map(move |row| {
            let first = row * self.columns;
            self.starts[first + x0] as usize..self.starts[first + x1 + 1] as usize
        })
    }
}
