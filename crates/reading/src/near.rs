//! Finds points and lines near a point, in constant time for any drawing.

use std::collections::BTreeMap;

use glam::DVec2;
use ink::InkStroke;

use crate::thresholds::ROUNDING;

/// Most entries kept in one cell: 100,000 strokes on top of one another must not make every query linear.
const CELL_CAP: usize = 48;

/// One indexed point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub(crate) point: DVec2,
    pub(crate) owner: usize,
    /// Arc length from the start of its owner.
    pub(crate) at: f64,
}

/// Most cells along a side that are rows of a table; finer cells, or cells beyond the sheet, are looked up by key.
const MOST_CELLS: i64 = 512;

/// A grid of points that belong to lines. Crowded cells keep their first entries only: index the most important
/// owner first.
#[derive(Clone, Debug)]
pub(crate) struct Near {
    cell: f64,
    /// Cells along a side of the sheet, 0 to 1.
    side: i64,
    /// For each cell of the sheet, column by column, one more than the row of its list; 0 for an empty cell.
    sheet: Vec<u32>,
    /// The same for cells beyond the sheet.
    beyond: BTreeMap<(i64, i64), u32>,
    lists: Vec<Vec<Entry>>,
}

impl Near {
    pub(crate) fn new(cell: f64) -> Self {
        let cell = cell.max(1e-6);
        #[expect(clippy::cast_possible_truncation, reason = "at most a million")]
        let side = ((1.0 / cell).ceil() as i64 + 1).min(MOST_CELLS);
        Self { cell, side, sheet: Vec::new(), beyond: BTreeMap::new(), lists: Vec::new() }
    }

    fn key(&self, p: DVec2) -> (i64, i64) {
        #[expect(clippy::cast_possible_truncation, reason = "saturates, and ink lies within 0 and 1")]
        let key = ((p.x / self.cell).floor() as i64, (p.y / self.cell).floor() as i64);
        key
    }

    /// Returns the row of a cell in the table of the sheet, if it lies there.
    fn row(&self, (x, y): (i64, i64)) -> Option<usize> {
        let on = (0..self.side).contains(&x) && (0..self.side).contains(&y);
        usize::try_from(x * self.side + y).ok().filter(|_| on)
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
        let key = self.key(entry.point);
        let name = match self.row(key) {
            Some(row) => {
                if self.sheet.is_empty() {
                    self.sheet = vec![0; usize::try_from(self.side * self.side).unwrap_or(0)];
                }
                &mut self.sheet[row]
            }
            None => self.beyond.entry(key).or_default(),
        };
        if *name == 0 {
            self.lists.push(Vec::new());
            *name = u32::try_from(self.lists.len()).unwrap_or(0);
        }
        let list = &mut self.lists[*name as usize - 1];
        if list.len() < CELL_CAP {
            list.push(entry);
        }
    }

    /// Calls `f` with every entry within `r` of `p` and its distance, in a fixed order: that of the cells, column by
    /// column. `r` of a few cells.
    pub(crate) fn visit(&self, p: DVec2, r: f64, mut f: impl FnMut(&Entry, f64)) {
        let (lo, hi) = (self.key(p - DVec2::splat(r)), self.key(p + DVec2::splat(r)));
        let mut look = |name: u32| {
            for e in &self.lists[name as usize - 1] {
                let d = e.point.distance(p);
                if d <= r {
                    f(e, d);
                }
            }
        };
        // In a column: cells below the sheet, on it and above it.
        let beyond = |x: i64, from: i64, to: i64, look: &mut dyn FnMut(u32)| {
            if from <= to && !self.beyond.is_empty() {
                self.beyond.range((x, from)..=(x, to)).for_each(|(_, name)| look(*name));
            }
        };
        for x in lo.0..=hi.0 {
            if !(0..self.side).contains(&x) {
                beyond(x, lo.1, hi.1, &mut look);
                continue;
            }
            beyond(x, lo.1, hi.1.min(-1), &mut look);
            let (from, to) = (lo.1.max(0), hi.1.min(self.side - 1));
            if let (Some(from), Some(to)) = (self.row((x, from)), self.row((x, to)))
                && let Some(cells) = self.sheet.get(from..=to)
            {
                cells.iter().filter(|name| **name > 0).for_each(|name| look(*name));
            }
            beyond(x, lo.1.max(self.side), hi.1, &mut look);
        }
    }

    /// Returns the entry nearest to `p` within `r` that `want` accepts.
    pub(crate) fn nearest(&self, p: DVec2, r: f64, want: impl Fn(usize) -> bool) -> Option<(Entry, f64)> {
        self.outwards(r, |r| {
            let mut best: Option<(Entry, f64)> = None;
            self.visit(p, r, |e, d| {
                if best.is_none_or(|(_, b)| d < b) && want(e.owner) {
                    best = Some((*e, d));
                }
            });
            best
        })
    }

    /// Returns what `find` finds within a small radius, or else within one twice as large, and so on up to `r`. The
    /// result is the same as that of `find(r)` if `find` returns the nearest of something.
    pub(crate) fn outwards<T>(&self, r: f64, find: impl Fn(f64) -> Option<T>) -> Option<T> {
        let mut within = 0.5 * self.cell;
        while within < r {
            let found = find(within);
            if found.is_some() {
                return found;
            }
            within *= 2.0;
        }
        find(r)
    }
}

/// Polygons by their bounding boxes: which may contain a point?
#[derive(Clone, Debug)]
pub(crate) struct Boxes {
    cells: Vec<Vec<usize>>,
    /// A little larger than the polygons.
    bounds: Vec<(DVec2, DVec2)>,
}

/// Side of a cell: a twenty-fifth of the drawing, so that a petal covers a few cells.
const BOX_CELL: f64 = 0.04;
/// The lowest cell along a side. Ink lies within 0 and 1; extended lines are looked up in the cells from -1 to 2.
const FIRST_BOX: i64 = -25;
/// Cells along a side.
const BOXES: i64 = 76;

impl Boxes {
    pub(crate) fn new<'a>(polygons: impl Iterator<Item = &'a [DVec2]>) -> Self {
        let mut found = Self { cells: vec![Vec::new(); Self::row((BOXES, 0))], bounds: Vec::new() };
        for (owner, polygon) in polygons.enumerate() {
            let corners = geom::bounds(polygon);
            let (lo, hi) = corners.unwrap_or((DVec2::INFINITY, DVec2::NEG_INFINITY));
            found.bounds.push((lo - ROUNDING, hi + ROUNDING));
            if corners.is_none() {
                continue;
            }
            let (a, b) = (Self::key(lo), Self::key(hi));
            for x in a.0..=b.0 {
                for y in a.1..=b.1 {
                    let list = &mut found.cells[Self::row((x, y))];
                    if list.len() < CELL_CAP {
                        list.push(owner);
                    }
                }
            }
        }
        found
    }

    fn key(p: DVec2) -> (i64, i64) {
        #[expect(clippy::cast_possible_truncation, reason = "clamped")]
        let key = |v: f64| (v.clamp(-1.0, 2.0) / BOX_CELL).floor() as i64 - FIRST_BOX;
        (key(p.x), key(p.y))
    }

    fn row((x, y): (i64, i64)) -> usize {
        usize::try_from(x * BOXES + y).unwrap_or(0)
    }

    /// Returns the rows of polygons whose box contains `p`.
    pub(crate) fn around(&self, p: DVec2) -> impl Iterator<Item = usize> {
        let within = move |&&b: &&usize| {
            let (lo, hi) = self.bounds[b];
            p.x >= lo.x && p.y >= lo.y && p.x <= hi.x && p.y <= hi.y
        };
        self.cells[Self::row(Self::key(p))].iter().filter(within).copied()
    }
}

/// Returns the distance between a stroke's ends, as a share of its length.
pub(crate) fn openness(s: &InkStroke) -> f64 {
    s.points[0].distance(s.points[s.points.len() - 1]) / s.length.max(1e-12)
}
