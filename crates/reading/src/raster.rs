//! A drawing as a picture of square cells, and shapes in such a picture: `lines -> cells -> pieces and their
//! outlines`.

use geom::bounds;
use glam::DVec2;

/// A picture of square cells with a margin in which the ball has room.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    pub(crate) wide: usize,
    pub(crate) tall: usize,
    /// Size of a cell, in the unit of the lines.
    pub(crate) size: f64,
    corner: DVec2,
}

impl Cells {
    /// Returns the size of a cell if this number of cells lies along the longer side of the box of the lines; `None`
    /// for lines without an extent.
    pub(crate) fn size_for(lines: &[&[DVec2]], along: usize) -> Option<f64> {
        let (lo, hi) = bounds_of(lines)?;
        let size = (hi - lo).max_element() / along as f64;
        (size.is_finite() && size > 0.0).then_some(size)
    }

    /// `along`: cells of the longer side of the box of the lines; `margin`: cells round that box. `None` for lines
    /// without an extent.
    pub(crate) fn new(lines: &[&[DVec2]], along: usize, margin: f64) -> Option<Self> {
        let size = Self::size_for(lines, along)?;
        let (lo, hi) = bounds_of(lines)?;
        let count = |length: f64| whole((length / size).ceil() + 2.0 * margin + 1.0);
        let corner = lo - DVec2::splat(margin * size);
        Some(Self { wide: count(hi.x - lo.x), tall: count(hi.y - lo.y), size, corner })
    }

    /// Returns the number of cells.
    pub(crate) const fn count(&self) -> usize {
        self.wide * self.tall
    }

    /// Returns the middle of a cell.
    pub(crate) fn middle(&self, cell: usize) -> DVec2 {
        let (x, y) = (cell % self.wide, cell / self.wide);
        self.corner + DVec2::new(x as f64 + 0.5, y as f64 + 0.5) * self.size
    }

    /// Returns the cell that contains a point; for a point beyond, the nearest cell.
    pub(crate) fn place(&self, p: DVec2) -> usize {
        let q = (p - self.corner) / self.size;
        self.row(q.y, self.tall) * self.wide + self.row(q.x, self.wide)
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the cells")]
    fn row(&self, v: f64, n: usize) -> usize {
        (v.max(0.0) as usize).min(n - 1)
    }

    /// Visits points along a line in steps of half a cell at most, however far apart its own points are.
    pub(crate) fn walk(&self, line: &[DVec2], mut visit: impl FnMut(DVec2)) {
        for pair in line.windows(2) {
            let steps = whole((pair[0].distance(pair[1]) / (0.5 * self.size)).ceil());
            let steps = steps.clamp(1, 4 * (self.wide + self.tall));
            (0..=steps).for_each(|i| visit(pair[0].lerp(pair[1], i as f64 / steps as f64)));
        }
    }

    /// Returns the cells that the steps of `ball` reach from a cell, within the picture.
    pub(crate) fn around(&self, at: usize, ball: &[(isize, isize)]) -> impl Iterator<Item = usize> {
        let (x, y, wide, tall) = (at % self.wide, at / self.wide, self.wide, self.tall);
        ball.iter().filter_map(move |&(dx, dy)| {
            let (x, y) = (x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
            (x < wide && y < tall).then_some(y * wide + x)
        })
    }
}

fn bounds_of(lines: &[&[DVec2]]) -> Option<(DVec2, DVec2)> {
    lines.iter().filter_map(|l| bounds(l)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// Steps to the left and right, upper and lower neighbours of a cell.
pub(crate) const BESIDE: [(isize, isize); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// Returns all cells that a ball covers around any of the given cells.
pub(crate) fn grown(cells: &Cells, from: &[bool], ball: &[(isize, isize)]) -> Vec<bool> {
    let mut all = from.to_vec();
    let rim = |k: usize| cells.around(k, &BESIDE).any(|b| !from[b]);
    for at in (0..from.len()).filter(|&k| from[k] && rim(k)) {
        cells.around(at, ball).for_each(|k| all[k] = true);
    }
    all
}

/// Returns the largest connected piece of cells, of several as large the first. Cost: linear in cells.
pub(crate) fn largest(cells: &Cells, is: &dyn Fn(usize) -> bool) -> Option<Vec<bool>> {
    let pieces = pieces(cells, is);
    let best = pieces.into_iter().rev().max_by_key(Vec::len)?;
    let mut mask = vec![false; cells.count()];
    best.into_iter().for_each(|k| mask[k] = true);
    Some(mask)
}

/// Returns the cells of each connected piece, pieces in the order of their first cells. Cost: linear in cells.
pub(crate) fn pieces(cells: &Cells, is: &dyn Fn(usize) -> bool) -> Vec<Vec<usize>> {
    let mut seen = vec![false; cells.count()];
    let mut found = Vec::new();
    for k in 0..seen.len() {
        if !seen[k] && is(k) {
            found.push(spread(cells, k, is, &mut seen));
        }
    }
    found
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few cells")]
fn whole(x: f64) -> usize {
    x.max(0.0) as usize
}

/// Returns the steps to all cells within a reach, in cells.
pub(crate) fn ball(reach: f64) -> Vec<(isize, isize)> {
    let n = whole(reach.ceil()).cast_signed();
    let square = (-n..=n).flat_map(|y| (-n..=n).map(move |x| (x, y)));
    square.filter(|&(x, y)| ((x * x + y * y) as f64) <= reach * reach).collect()
}

/// Marks the cells through which lines run.
pub(crate) fn drawn(cells: &Cells, lines: &[&[DVec2]]) -> Vec<bool> {
    let mut drawn = vec![false; cells.count()];
    for line in lines {
        cells.walk(line, |at| drawn[cells.place(at)] = true);
    }
    drawn
}

/// Marks the cells connected with a cell.
pub(crate) fn flood(cells: &Cells, from: usize, is: &dyn Fn(usize) -> bool) -> Vec<bool> {
    let mut found = vec![false; cells.count()];
    spread(cells, from, is, &mut found);
    found
}

/// Returns the cells connected with a cell, that cell first, and marks them as seen.
fn spread(cells: &Cells, from: usize, is: &dyn Fn(usize) -> bool, seen: &mut [bool]) -> Vec<usize> {
    seen[from] = true;
    let mut found = vec![from];
    let mut next = 0;
    while let Some(&at) = found.get(next) {
        next += 1;
        for k in cells.around(at, &BESIDE) {
            if !seen[k] && is(k) {
                seen[k] = true;
                found.push(k);
            }
        }
    }
    found
}

/// Returns the centres of the cells at the rim of a piece, counter-clockwise: lines run through them.
pub(crate) fn around(cells: &Cells, piece: &[bool]) -> Option<Vec<DVec2>> {
    let first = piece.iter().position(|p| *p)?;
    let has = |(x, y): (isize, isize)| {
        let cell = usize::try_from(y).ok().zip(usize::try_from(x).ok());
        cell.is_some_and(|(y, x)| x < cells.wide && y < cells.tall && piece[y * cells.wide + x])
    };
    // The cells to the left and to the right of the side that leaves a corner in each direction.
    let left = |(x, y): (isize, isize), way: usize| [(x, y), (x - 1, y), (x - 1, y - 1), (x, y - 1)][way];
    let right = |(x, y): (isize, isize), way: usize| [(x, y - 1), (x, y), (x - 1, y), (x - 1, y - 1)][way];
    // The lowest row of the piece: below its first cell there is no cell of the piece.
    let start = ((first % cells.wide).cast_signed(), (first / cells.wide).cast_signed());
    let (mut at, mut way) = (start, 0_usize);
    let mut line: Vec<DVec2> = Vec::new();
    loop {
        let (x, y) = left(at, way);
        let middle = cells.corner + DVec2::new(x as f64 + 0.5, y as f64 + 0.5) * cells.size;
        if line.last() != Some(&middle) {
            line.push(middle);
        }
        at = (at.0 + BESIDE[way].0, at.1 + BESIDE[way].1);
        // To the left, straight on, to the right: where the piece is on the left and nothing on the right.
        let turns = [way + 1, way, way + 3].map(|w| w % BESIDE.len());
        way = turns.into_iter().find(|&w| has(left(at, w)) && !has(right(at, w)))?;
        if (at, way) == (start, 0) {
            return Some(line);
        }
    }
}

/// Returns the distance of each cell from the nearest of the given cells, in cells: exact, in linear time (Felzenszwalb
/// and Huttenlocher 2012, section 3). If there are none, it is greater than the picture.
pub(crate) fn distances(cells: &Cells, from: &[bool]) -> Vec<f64> {
    let far = square((cells.wide + cells.tall) as f64);
    let mut squares: Vec<f64> = from.iter().map(|f| if *f { 0.0 } else { far }).collect();
    for x in 0..cells.wide {
        let column: Vec<f64> = (0..cells.tall).map(|y| squares[y * cells.wide + x]).collect();
        for (y, square) in lowest_parabola(&column).into_iter().enumerate() {
            squares[y * cells.wide + x] = square;
        }
    }
    for row in squares.chunks_exact_mut(cells.wide) {
        row.copy_from_slice(&lowest_parabola(row));
    }
    squares.into_iter().map(f64::sqrt).collect()
}

pub(crate) fn square(x: f64) -> f64 {
    x * x
}

/// Returns the least of `heights[i] + (x - i)^2` over all `i`, for each place `x`.
fn lowest_parabola(heights: &[f64]) -> Vec<f64> {
    let meets = |a: usize, b: usize| {
        let (x, y) = (a as f64, b as f64);
        ((heights[b] + y * y) - (heights[a] + x * x)) / (2.0 * (y - x))
    };
    // The parabolas that are lowest somewhere, each with the place from which on it is.
    let mut lowest: Vec<(usize, f64)> = vec![(0, f64::NEG_INFINITY)];
    for next in 1..heights.len() {
        let mut from = meets(lowest[lowest.len() - 1].0, next);
        while from <= lowest[lowest.len() - 1].1 {
            lowest.pop();
            from = meets(lowest[lowest.len() - 1].0, next);
        }
        lowest.push((next, from));
    }
    let mut at = 0;
    let height = |x: usize, of: usize| heights[of] + square(x as f64 - of as f64);
    (0..heights.len())
        .map(|x| {
            while lowest.get(at + 1).is_some_and(|next| next.1 < x as f64) {
                at += 1;
            }
            height(x, lowest[at].0)
        })
        .collect()
}
