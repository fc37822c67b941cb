//! What lies near a point, in constant time whatever was drawn.

use std::collections::BTreeMap;

use glam::DVec2;

/// Most entries kept in one cell: 100,000 strokes on top of one another must not make every query linear.
const CELL_CAP: usize = 48;

/// One indexed point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub(crate) point: DVec2,
    pub(crate) owner: usize,
    /// Arc length of the point on its owner.
    pub(crate) at: f64,
}

/// A grid of points that belong to lines. Crowded cells keep their first entries only: index the most important
/// owner first.
#[derive(Clone, Debug)]
pub(crate) struct Near {
    cell: f64,
    cells: BTreeMap<(i64, i64), Vec<Entry>>,
}

impl Near {
    pub(crate) fn new(cell: f64) -> Self {
        Self { cell: cell.max(1e-6), cells: BTreeMap::new() }
    }

    fn key(&self, p: DVec2) -> (i64, i64) {
        #[expect(clippy::cast_possible_truncation, reason = "saturates, and ink lies within 0 and 1")]
        let key = ((p.x / self.cell).floor() as i64, (p.y / self.cell).floor() as i64);
        key
    }

    /// Indexes a line at about half a cell's spacing; its ends always.
    pub(crate) fn add_line(&mut self, owner: usize, points: &[DVec2]) {
        let mut at = 0.0;
        let mut since = f64::INFINITY;
        for (i, &p) in points.iter().enumerate() {
            if i > 0 {
                let d = p.distance(points[i - 1]);
                at += d;
                since += d;
            }
            if since >= 0.5 * self.cell || i + 1 == points.len() {
                since = 0.0;
                self.add(Entry { point: p, owner, at });
            }
        }
    }

    pub(crate) fn add(&mut self, entry: Entry) {
        let list = self.cells.entry(self.key(entry.point)).or_default();
        if list.len() < CELL_CAP {
            list.push(entry);
        }
    }

    /// Calls `f` with every entry within `r` of `p` and its distance, in a fixed order. `r` of a few cells.
    pub(crate) fn visit(&self, p: DVec2, r: f64, mut f: impl FnMut(&Entry, f64)) {
        let (lo, hi) = (self.key(p - DVec2::splat(r)), self.key(p + DVec2::splat(r)));
        for x in lo.0..=hi.0 {
            for (_, list) in self.cells.range((x, lo.1)..=(x, hi.1)) {
                for e in list {
                    let d = e.point.distance(p);
                    if d <= r {
                        f(e, d);
                    }
                }
            }
        }
    }

    /// The entry nearest to `p` within `r` that `want` accepts.
    pub(crate) fn nearest(&self, p: DVec2, r: f64, want: impl Fn(usize) -> bool) -> Option<(Entry, f64)> {
        let mut best: Option<(Entry, f64)> = None;
        self.visit(p, r, |e, d| {
            if want(e.owner) && best.is_none_or(|(_, b)| d < b) {
                best = Some((*e, d));
            }
        });
        best
    }
}

/// Polygons by their bounding boxes: which may contain a point?
#[derive(Clone, Debug)]
pub(crate) struct Boxes {
    cells: BTreeMap<(i64, i64), Vec<usize>>,
}

/// Cells of a twenty-fifth of the drawing: a petal covers a few of them.
const BOX_CELL: f64 = 0.04;

impl Boxes {
    pub(crate) fn new<'a>(polygons: impl Iterator<Item = &'a [DVec2]>) -> Self {
        let mut cells: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
        for (owner, polygon) in polygons.enumerate() {
            let Some((lo, hi)) = bounds(polygon) else { continue };
            let (a, b) = (Self::key(lo), Self::key(hi));
            for x in a.0..=b.0 {
                for y in a.1..=b.1 {
                    let list = cells.entry((x, y)).or_default();
                    if list.len() < CELL_CAP {
                        list.push(owner);
                    }
                }
            }
        }
        Self { cells }
    }

    fn key(p: DVec2) -> (i64, i64) {
        // Ink lies within 0 and 1; the clamp bounds the cells of a polygon that was extended beyond.
        #[expect(clippy::cast_possible_truncation, reason = "clamped")]
        let key = |v: f64| (v.clamp(-1.0, 2.0) / BOX_CELL).floor() as i64;
        (key(p.x), key(p.y))
    }

    /// Polygons whose box may hold `p`, by row.
    pub(crate) fn around(&self, p: DVec2) -> &[usize] {
        self.cells.get(&Self::key(p)).map_or(&[], Vec::as_slice)
    }
}

/// Lower left and upper right corner; `None` for no points.
pub(crate) fn bounds(points: &[DVec2]) -> Option<(DVec2, DVec2)> {
    let first = *points.first()?;
    Some(points.iter().fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p))))
}
