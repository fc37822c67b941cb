//! A drawing on a grid of square cells: ink, enclosed cells, and the outside.

use glam::DVec2;
use ink::Ink;

use geom::bounds;

/// Margin of cells round the drawing, so that the outside is connected.
const MARGIN: usize = 1;
/// Marks a cell without a stroke.
const NOBODY: u32 = u32::MAX;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cell {
    Open,
    Outside,
    Ink,
    /// Enclosed.
    Hole,
}

/// A drawing on a grid of square cells. The longer side has a fixed number of cells, and the middle of the drawing
/// lies in the middle of the grid, so that left and right are treated alike.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    wide: usize,
    tall: usize,
    /// Size of a cell, ink units.
    pub(crate) cell: f64,
    centre: DVec2,
    cells: Vec<Cell>,
    /// The lowest and the highest number of the strokes in a cell.
    owners: Vec<[u32; 2]>,
    /// How often a line came into each cell.
    visits: Vec<u16>,
    /// The enclosed regions, the largest first.
    pub(crate) holes: Vec<Hole>,
}

/// One enclosed region; shares of the box of the drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Hole {
    pub(crate) area: f64,
    /// Height of its middle.
    pub(crate) middle: f64,
    /// Height of its lowest cell.
    pub(crate) low: f64,
    /// Height of its highest cell.
    pub(crate) high: f64,
    pub(crate) wide: f64,
    /// Share of its own box that it fills.
    pub(crate) full: f64,
    /// Distance of its middle from the middle of the drawing.
    pub(crate) off: f64,
}

/// One row of cells.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct GridRow {
    /// Share of the width that is ink or enclosed.
    pub(crate) filled: f64,
    /// Share of the width from the first to the last ink.
    pub(crate) across: f64,
    /// Share of the width that is ink.
    pub(crate) ink: f64,
    /// Runs of ink.
    pub(crate) runs: f64,
}

impl Grid {
    /// Draws the ink on a grid. `along`: cells of the longer side. Linear in points.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a grid has few cells")]
    pub(crate) fn new(ink: &Ink, along: usize) -> Self {
        let boxes = ink.strokes.iter().filter_map(|s| bounds(&s.points));
        let (lo, hi) = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default();
        let size = hi - lo;
        let cell = (size.max_element() / along as f64).max(1e-9);
        let count = |length: f64| ((length / cell - 1e-9).ceil().max(1.0) as usize).min(along) + 2 * MARGIN;
        let (wide, tall) = (count(size.x), count(size.y));
        let n = wide * tall;
        let mut grid = Self {
            wide,
            tall,
            cell,
            centre: lo.midpoint(hi),
            cells: vec![Cell::Open; n],
            owners: vec![[NOBODY, 0]; n],
            visits: vec![0; n],
            holes: Vec::new(),
        };
        for (k, s) in (0_u32..).zip(&ink.strokes) {
            let mut before = usize::MAX;
            let mut mark = |p: DVec2| {
                let at = grid.cell_index(p);
                if at != before {
                    grid.visits[at] = grid.visits[at].saturating_add(1);
                    before = at;
                }
                grid.cells[at] = Cell::Ink;
                let [low, high] = grid.owners[at];
                grid.owners[at] = if low == NOBODY { [k, k] } else { [low.min(k), high.max(k)] };
            };
            mark(s.points[0]);
            for w in s.points.windows(2) {
                // Half a cell at a time, however far apart the points are.
                let steps = ((w[0].distance(w[1]) / (0.5 * cell)).ceil().max(1.0) as usize).min(4 * along);
                (1..=steps).for_each(|i| mark(w[0].lerp(w[1], i as f64 / steps as f64)));
            }
        }
        grid.flood_outside();
        grid.find_holes();
        grid
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the grid")]
    fn cell_index(&self, p: DVec2) -> usize {
        let q = (p - self.centre) / self.cell;
        let place = |v: f64, n: usize| ((v + 0.5 * n as f64).max(0.0) as usize).clamp(MARGIN, n - 1 - MARGIN);
        place(q.y, self.tall) * self.wide + place(q.x, self.wide)
    }

    /// Returns the left, right, lower and upper neighbours of a cell.
    fn neighbours(&self, at: usize) -> [Option<usize>; 4] {
        let x = at % self.wide;
        [
            (x > 0).then(|| at - 1),
            (x + 1 < self.wide).then(|| at + 1),
            at.checked_sub(self.wide),
            (at + self.wide < self.cells.len()).then(|| at + self.wide),
        ]
    }

    fn flood(&mut self, from: usize, to: Cell) -> Vec<usize> {
        let mut found = vec![from];
        self.cells[from] = to;
        let mut next = 0;
        while let Some(&at) = found.get(next) {
            next += 1;
            for b in self.neighbours(at).into_iter().flatten() {
                if self.cells[b] == Cell::Open {
                    self.cells[b] = to;
                    found.push(b);
                }
            }
        }
        found
    }

    fn flood_outside(&mut self) {
        self.flood(0, Cell::Outside);
    }

    fn find_holes(&mut self) {
        let (across, up) = ((self.wide - 2 * MARGIN) as f64, (self.tall - 2 * MARGIN) as f64);
        for from in 0..self.cells.len() {
            if self.cells[from] != Cell::Open {
                continue;
            }
            let found = self.flood(from, Cell::Hole);
            let (mut x, mut y) = ((usize::MAX, 0), (usize::MAX, 0));
            let mut sum = (0.0, 0.0);
            for &at in &found {
                let (c, r) = (at % self.wide - MARGIN, at / self.wide - MARGIN);
                x = (x.0.min(c), x.1.max(c));
                y = (y.0.min(r), y.1.max(r));
                sum = (sum.0 + c as f64 + 0.5, sum.1 + r as f64 + 0.5);
            }
            let n = found.len() as f64;
            let (w, h) = ((x.1 - x.0 + 1) as f64, (y.1 - y.0 + 1) as f64);
            self.holes.push(Hole {
                area: n / (across * up),
                middle: sum.1 / n / up,
                low: y.0 as f64 / up,
                high: (y.1 + 1) as f64 / up,
                wide: w / across,
                full: n / (w * h),
                off: (sum.0 / n / across - 0.5).abs() * 2.0,
            });
        }
        base::sort_by(&mut self.holes, |a, b| {
            b.area.total_cmp(&a.area).then(a.middle.total_cmp(&b.middle)).then(a.off.total_cmp(&b.off))
        });
    }

    /// Returns the rows of the drawing, the lowest first; at least one.
    pub(crate) fn rows(&self) -> Vec<GridRow> {
        let across = (self.wide - 2 * MARGIN) as f64;
        (MARGIN..self.tall - MARGIN)
            .map(|r| {
                let cells = &self.cells[r * self.wide..(r + 1) * self.wide];
                let count = |is: fn(&Cell) -> bool| cells.iter().filter(|c| is(c)).count() as f64;
                let first = cells.iter().position(|c| *c == Cell::Ink);
                let last = cells.iter().rposition(|c| *c == Cell::Ink);
                let runs = cells.windows(2).filter(|w| w[0] != Cell::Ink && w[1] == Cell::Ink).count();
                GridRow {
                    filled: count(|c| matches!(c, Cell::Ink | Cell::Hole)) / across,
                    across: first.zip(last).map_or(0.0, |(a, b)| (b - a + 1) as f64) / across,
                    ink: count(|c| *c == Cell::Ink) / across,
                    runs: runs as f64,
                }
            })
            .collect()
    }

    /// Returns the share of each quarter of the height that is enclosed.
    pub(crate) fn hole_bands(&self) -> [f64; 4] {
        let mut sums = [(0.0, 0.0); 4];
        let rows = self.tall - 2 * MARGIN;
        for r in 0..rows {
            let cells = &self.cells[(r + MARGIN) * self.wide..(r + MARGIN + 1) * self.wide];
            let own = &mut sums[4 * r / rows];
            own.0 += cells.iter().filter(|c| **c == Cell::Hole).count() as f64;
            own.1 += (self.wide - 2 * MARGIN) as f64;
        }
        sums.map(|(a, b)| if b > 0.0 { a / b } else { 0.0 })
    }

    /// Measures how similar left and right are: ink (within one cell), filled cells; and above and below.
    pub(crate) fn symmetric(&self) -> [f64; 3] {
        let filled = |c: Cell| matches!(c, Cell::Ink | Cell::Hole);
        let (mut ink, mut met) = (0.0_f64, 0.0);
        let (mut both, mut either, mut upside, mut any) = (0.0, 0.0_f64, 0.0, 0.0_f64);
        for at in 0..self.cells.len() {
            let (x, y) = (at % self.wide, at / self.wide);
            let mirror = y * self.wide + (self.wide - 1 - x);
            let turned = (self.tall - 1 - y) * self.wide + x;
            if self.cells[at] == Cell::Ink {
                ink += 1.0;
                let around = [Some(mirror), mirror.checked_sub(1), Some(mirror + 1)];
                let above = [mirror.checked_sub(self.wide), Some(mirror + self.wide)];
                let found = around.into_iter().chain(above).flatten();
                let found = found.filter_map(|m| self.cells.get(m)).any(|c| *c == Cell::Ink);
                met += f64::from(u8::from(found));
            }
            let here = filled(self.cells[at]);
            let pair = |other: usize| (here && filled(self.cells[other]), here || filled(self.cells[other]));
            let (b, e) = pair(mirror);
            (both, either) = (both + f64::from(u8::from(b)), either + f64::from(u8::from(e)));
            let (b, e) = pair(turned);
            (upside, any) = (upside + f64::from(u8::from(b)), any + f64::from(u8::from(e)));
        }
        [met / ink.max(1.0), both / either.max(1.0), upside / any.max(1.0)]
    }

    /// Returns the middle of the filled cells above a share of the height, ink coordinates.
    pub(crate) fn middle(&self, from: f64) -> DVec2 {
        let (mut sum, mut n) = (DVec2::ZERO, 0.0);
        let low = MARGIN as f64 + from * (self.tall - 2 * MARGIN) as f64;
        for (at, cell) in self.cells.iter().enumerate() {
            let (x, y) = ((at % self.wide) as f64 + 0.5, (at / self.wide) as f64 + 0.5);
            if matches!(cell, Cell::Ink | Cell::Hole) && y >= low {
                (sum, n) = (sum + DVec2::new(x, y), n + 1.0);
            }
        }
        if n < 1.0 {
            return self.centre;
        }
        let half = 0.5 * DVec2::new(self.wide as f64, self.tall as f64);
        self.centre + (sum / n - half) * self.cell
    }

    /// Counts filled cells, those of them at the rim, and cells with ink.
    pub(crate) fn areas(&self) -> (f64, f64, f64) {
        let (mut filled, mut rim, mut ink) = (0.0, 0.0, 0.0);
        for (at, cell) in self.cells.iter().enumerate() {
            if matches!(cell, Cell::Open | Cell::Outside) {
                continue;
            }
            filled += 1.0;
            ink += f64::from(u8::from(*cell == Cell::Ink));
            let outside = |b: Option<usize>| b.is_none_or(|b| self.cells[b] == Cell::Outside);
            rim += f64::from(u8::from(self.neighbours(at).into_iter().any(outside)));
        }
        (filled, rim, ink)
    }

    /// Whether another stroke than `stroke` runs through the cell of a point or one next to it.
    pub(crate) fn has_other(&self, p: DVec2, stroke: usize) -> bool {
        let at = self.cell_index(p);
        let stroke = u32::try_from(stroke).unwrap_or(NOBODY);
        let other = |b: usize| {
            let [low, high] = self.owners[b];
            low != NOBODY && (low != stroke || high != stroke)
        };
        other(at) || self.neighbours(at).into_iter().flatten().any(other)
    }

    /// Returns shares of the cells with ink: with several strokes, entered twice, three times and more; and the mean
    /// number of entries.
    pub(crate) fn crossed(&self) -> [f64; 4] {
        let (mut n, mut several, mut twice, mut thrice, mut sum) = (0.0_f64, 0.0, 0.0, 0.0, 0.0);
        for (owners, &visits) in self.owners.iter().zip(&self.visits) {
            if visits == 0 {
                continue;
            }
            n += 1.0;
            several += f64::from(u8::from(owners[0] != owners[1]));
            twice += f64::from(u8::from(visits > 1));
            thrice += f64::from(u8::from(visits > 2));
            sum += f64::from(visits.min(8));
        }
        let n = n.max(1.0);
        [several / n, twice / n, thrice / n, sum / n / 4.0]
    }
}
