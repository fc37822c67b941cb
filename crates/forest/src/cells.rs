//! Points on the ground by square cells, for finding neighbours: sorted, so that memory does not depend on the
//! distances.

use glam::DVec2;

/// Points by the cells in which they lie.
#[derive(Debug)]
pub(crate) struct SortedCells {
    side: f64,
    /// Cell and point, in order of the cells: row by row, then along the row.
    rows: Vec<(u64, u32)>,
}

/// Offset of coordinates, so that cells on both sides of the origin have keys in order.
const MIDDLE: i64 = 1 << 31;

impl SortedCells {
    /// Sorts points into cells. Cost: n log n. `side`: above 0. Points must be finite, and at most 2^31 sides from
    /// the origin.
    pub(crate) fn new(points: impl Iterator<Item = DVec2>, side: f64) -> Self {
        let mut rows: Vec<(u64, u32)> = (0..).zip(points).map(|(i, p)| (key(p, side), i)).collect();
        rows.sort_unstable();
        Self { side, rows }
    }

    /// Returns the cells with their points.
    pub(crate) fn cells(&self) -> impl Iterator<Item = &[(u64, u32)]> {
        self.rows.chunk_by(|a, b| a.0 == b.0)
    }

    /// Returns the points in the cells that are at most `ring` cells away from that of `p`, among them all within
    /// `ring` sides.
    pub(crate) fn near(&self, p: DVec2, ring: i64) -> impl Iterator<Item = u32> + '_ {
        let (x, y) = cell(p, self.side);
        (y - ring..=y + ring).flat_map(move |row| {
            let from = self.rows.partition_point(|r| r.0 < packed(x - ring, row));
            let to = self.rows[from..].partition_point(|r| r.0 <= packed(x + ring, row)) + from;
            self.rows[from..to].iter().map(|r| r.1)
        })
    }
}

fn cell(p: DVec2, side: f64) -> (i64, i64) {
    #[expect(clippy::cast_possible_truncation, reason = "saturates; far cells are then one")]
    let whole = |x: f64| (x / side).floor() as i64;
    (whole(p.x), whole(p.y))
}

fn key(p: DVec2, side: f64) -> u64 {
    let (x, y) = cell(p, side);
    packed(x, y)
}

fn packed(x: i64, y: i64) -> u64 {
    #[expect(clippy::cast_sign_loss, reason = "clamped to 0 and more")]
    let half = |v: i64| v.saturating_add(MIDDLE).clamp(0, 2 * MIDDLE - 1) as u64;
    (half(y) << 32) | half(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_those_of_a_plain_search() {
        let mut stream = base::Seed::new(4).stream(base::Draw::Test);
        let points: Vec<DVec2> =
            (0..400).map(|_| DVec2::new(stream.range(-9.0, 9.0), stream.range(-9.0, 9.0))).collect();
        let cells = SortedCells::new(points.iter().copied(), 1.5);
        assert_eq!(cells.cells().map(<[_]>::len).sum::<usize>(), 400);
        for p in &points {
            let close = |q: &DVec2| q.distance(*p) < 1.5;
            let mut found: Vec<u32> = cells.near(*p, 1).filter(|&i| close(&points[i as usize])).collect();
            found.sort_unstable();
            let plain: Vec<u32> = (0..400).filter(|&i| close(&points[i as usize])).collect();
            assert_eq!(found, plain);
        }
    }
}
