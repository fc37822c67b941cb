//! What lines enclose where they leave gaps: `lines + gap -> the largest piece, and its outline`.
//!
//! A ball that is larger than the gaps rolls round the drawing; what it cannot reach is inside (trapped-ball segmentation,
//! Zhang, Chen, Zhang, Hu and Martin 2009, section 4). Bays that are wider than the ball stay bays.

use geom::{bounds, simple_outline, simplify};
use glam::DVec2;

/// Cells along the longer side of the drawing.
const ALONG: usize = 96;
/// Cells that the radius of a ball may have. One as wide as the drawing finds no way into any gap; of lines that are specks beside
/// it, the picture would hold nothing else.
const WIDEST_BALL: f64 = ALONG as f64;
/// Corners of the outline lie within this of its cells, in cells.
const CALM: f64 = 0.5;

/// A picture of square cells with a margin in which the ball has room.
#[derive(Clone)]
struct Cells {
    wide: usize,
    tall: usize,
    size: f64,
    corner: DVec2,
}

impl Cells {
    fn place(&self, p: DVec2) -> usize {
        let q = (p - self.corner) / self.size;
        self.row(q.y, self.tall) * self.wide + self.row(q.x, self.wide)
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the cells")]
    fn row(&self, v: f64, n: usize) -> usize {
        (v.max(0.0) as usize).min(n - 1)
    }

    /// Steps from a cell to all cells within a ball, and those beside it.
    fn around(&self, at: usize, ball: &[(isize, isize)]) -> impl Iterator<Item = usize> {
        let (x, y, wide, tall) = (at % self.wide, at / self.wide, self.wide, self.tall);
        ball.iter().filter_map(move |&(dx, dy)| {
            let (x, y) = (x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
            (x < wide && y < tall).then_some(y * wide + x)
        })
    }
}

const BESIDE: [(isize, isize); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// The largest piece of a drawing that a ball cannot reach.
pub(crate) struct Sealed {
    cells: Cells,
    piece: Vec<bool>,
}

impl Sealed {
    /// The piece that a ball of a radius leaves; `None` where there is none, or the ball is larger than all the lines. Cost:
    /// linear in points, and the picture times the ball.
    pub(crate) fn new(lines: &[&[DVec2]], radius: f64) -> Option<Self> {
        let (lo, hi) = lines.iter().filter_map(|l| bounds(l)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let size = (hi - lo).max_element() / ALONG as f64;
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        let reach = radius / size;
        if reach > WIDEST_BALL {
            return None;
        }
        let ball = ball(reach);
        let margin = reach.ceil() + 2.0;
        let count = |length: f64| whole((length / size).ceil() + 2.0 * margin + 1.0);
        let cells = Cells {
            wide: count(hi.x - lo.x),
            tall: count(hi.y - lo.y),
            size,
            corner: lo - DVec2::splat(margin * size),
        };
        let near = grown(&cells, &drawn(&cells, lines), &ball);
        let middles = flood(&cells, 0, &|k| !near[k]);
        let outside = grown(&cells, &middles, &ball);
        let piece = largest(&cells, &|k| !outside[k])?;
        Some(Self { cells, piece })
    }

    /// Its outline, counter-clockwise, without a crossing: it runs along the lines, off them by less than a hundredth of the
    /// drawing.
    pub(crate) fn outline(&self) -> Option<Vec<DVec2>> {
        simple_outline(&simplify(&around(&self.cells, &self.piece)?, CALM * self.cells.size))
    }

    /// The largest piece of it in which a ball of a radius rolls, so that single lines are none (opening, Serra 1982).
    pub(crate) fn opened(&self, radius: f64) -> Option<Self> {
        let (cells, ball) = (self.cells.clone(), ball(radius / self.cells.size));
        let out: Vec<bool> = self.piece.iter().map(|p| !p).collect();
        let rim = grown(&cells, &out, &ball);
        let deep: Vec<bool> = rim.iter().map(|r| !r).collect();
        let open = grown(&cells, &deep, &ball);
        let piece = largest(&cells, &|k| open[k])?;
        Some(Self { cells, piece })
    }
}

/// All cells that a ball covers in some cell.
fn grown(cells: &Cells, from: &[bool], ball: &[(isize, isize)]) -> Vec<bool> {
    let mut all = from.to_vec();
    let rim = |k: usize| cells.around(k, &BESIDE).any(|b| !from[b]);
    for at in (0..from.len()).filter(|&k| from[k] && rim(k)) {
        cells.around(at, ball).for_each(|k| all[k] = true);
    }
    all
}

/// The largest piece of cells that hangs together.
fn largest(cells: &Cells, is: &dyn Fn(usize) -> bool) -> Option<Vec<bool>> {
    let mut seen = vec![false; cells.wide * cells.tall];
    let mut best: (usize, Option<Vec<bool>>) = (0, None);
    for k in 0..seen.len() {
        if !seen[k] && is(k) {
            let piece = flood(cells, k, is);
            seen.iter_mut().zip(&piece).for_each(|(s, p)| *s |= p);
            let area = piece.iter().filter(|p| **p).count();
            if area > best.0 {
                best = (area, Some(piece));
            }
        }
    }
    best.1
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few cells")]
fn whole(x: f64) -> usize {
    x.max(0.0) as usize
}

fn ball(reach: f64) -> Vec<(isize, isize)> {
    let n = whole(reach.ceil()).cast_signed();
    let square = (-n..=n).flat_map(|y| (-n..=n).map(move |x| (x, y)));
    square.filter(|&(x, y)| ((x * x + y * y) as f64) <= reach * reach).collect()
}

fn drawn(cells: &Cells, lines: &[&[DVec2]]) -> Vec<bool> {
    let mut drawn = vec![false; cells.wide * cells.tall];
    for pair in lines.iter().flat_map(|l| l.windows(2)) {
        let steps = whole((pair[0].distance(pair[1]) / (0.5 * cells.size)).ceil()).clamp(1, 4 * ALONG);
        (0..=steps).for_each(|i| drawn[cells.place(pair[0].lerp(pair[1], i as f64 / steps as f64))] = true);
    }
    drawn
}

/// What hangs together with a cell.
fn flood(cells: &Cells, from: usize, is: &dyn Fn(usize) -> bool) -> Vec<bool> {
    let mut found = vec![false; cells.wide * cells.tall];
    let mut ahead = vec![from];
    found[from] = true;
    while let Some(at) = ahead.pop() {
        for k in cells.around(at, &BESIDE) {
            if !found[k] && is(k) {
                found[k] = true;
                ahead.push(k);
            }
        }
    }
    found
}

/// The middles of the cells at the rim of a piece, counter-clockwise: lines run through them.
fn around(cells: &Cells, piece: &[bool]) -> Option<Vec<DVec2>> {
    let first = piece.iter().position(|p| *p)?;
    let has = |(x, y): (isize, isize)| {
        let cell = usize::try_from(y).ok().zip(usize::try_from(x).ok());
        cell.is_some_and(|(y, x)| x < cells.wide && y < cells.tall && piece[y * cells.wide + x])
    };
    // The cells to the left and to the right of the side that leaves a corner in each direction.
    let left = |(x, y): (isize, isize), way: usize| [(x, y), (x - 1, y), (x - 1, y - 1), (x, y - 1)][way];
    let right = |(x, y): (isize, isize), way: usize| [(x, y - 1), (x, y), (x - 1, y), (x - 1, y - 1)][way];
    // The lowest row of the piece: below its first cell there is nothing.
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

#[cfg(test)]
mod tests {
    use geom::{contains, signed_area};

    use super::*;

    fn sealed(lines: &[&[DVec2]], radius: f64) -> Vec<DVec2> {
        Sealed::new(lines, radius).and_then(|s| s.outline()).expect("lines have cells")
    }

    fn square(gap: f64) -> Vec<DVec2> {
        let corners =
            [[0.5 + 0.5 * gap, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0], [0.5 - 0.5 * gap, 0.0]];
        corners.map(DVec2::from).to_vec()
    }

    #[test]
    fn a_gap_narrower_than_the_ball_is_closed_and_a_wider_one_is_not() {
        let area = |gap: f64| signed_area(&sealed(&[&square(gap)], 0.05));
        assert!((area(0.08) - 1.0).abs() < 0.03, "{}", area(0.08));
        assert!(area(0.2) < 0.1, "{}", area(0.2));
    }

    #[test]
    fn a_bay_wider_than_the_ball_stays_a_bay() {
        let p = |x: f64, y: f64| DVec2::new(x, y);
        let bay = [
            p(0.0, 0.0),
            p(0.4, 0.0),
            p(0.4, 0.6),
            p(0.6, 0.6),
            p(0.6, 0.0),
            p(1.0, 0.0),
            p(1.0, 1.0),
            p(0.0, 1.0),
            p(0.0, 0.0),
        ];
        let outline = sealed(&[&bay], 0.05);
        assert!(
            !contains(&outline, p(0.5, 0.3))
                && contains(&outline, p(0.2, 0.3))
                && contains(&outline, p(0.5, 0.8))
        );
    }

    #[test]
    fn a_ball_larger_than_the_lines_is_given_up_at_once() {
        let speck =
            |size: f64| Sealed::new(&[&square(0.1).iter().map(|p| *p * size).collect::<Vec<_>>()], 0.05);
        assert!(speck(0.06).is_some());
        // Pictures of 500 thousand million cells, as the ball needs room.
        assert!(speck(1e-5).is_none() && speck(1e-300).is_none());
    }

    #[test]
    fn lines_without_extent_have_no_outline() {
        assert!(Sealed::new(&[], 0.05).is_none());
        assert!(Sealed::new(&[&[DVec2::ONE, DVec2::ONE]], 0.05).is_none());
    }
}
