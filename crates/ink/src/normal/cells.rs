//! Line art painted as one area with holes over colours -> the outlines of its holes, each with the colour behind it.
//!
//! Drawing programs turn the outlines of a coloured picture into one compound path: its ink runs between the organs,
//! and each organ is a hole in it. The holes are better evidence than the centre lines of the ink, which come apart at
//! every junction.

use glam::DVec2;

use super::{Change, Extent, Figure, LIMITS, Work, is_closed, places, some_of};
use crate::InkSample;

/// Limits by which an area with holes counts as line art. Shares are of areas.
struct CellLimits {
    /// Its ink takes less than this share of what its outer outline encloses.
    ink_most: f64,
    /// Others are painted behind more than this share of its holes.
    covered: f64,
    /// Least share of the places in a hole that show the colour behind it.
    seen: f64,
    /// A hole has at least this share of what the outer outline encloses; smaller ones are gaps between the lines.
    hole_least: f64,
    /// Colour behind lies within the outer outline with this share of its points.
    within: f64,
    /// An area behind a hole that is smaller than this share of the hole is a separate thing, such as the disc of a
    /// flower.
    own_thing: f64,
    /// A point also counts as within the outer outline if it is nearer to it than this share of the drawing's diagonal.
    near: f64,
    /// Channels of colours of one hue, as shares of their sum, differ by less than this: the difference is shade.
    one_hue: f64,
}

const LIMITS_OF_CELLS: CellLimits = CellLimits {
    ink_most: 0.6,
    covered: 0.7,
    seen: 0.5,
    hole_least: 0.004,
    within: 0.85,
    own_thing: 0.5,
    near: 0.01,
    one_hue: 0.15,
};

/// Number of places along each side of the box of a hole at which the colour behind it is looked up.
const PLACES: u32 = 7;
/// Number of points of a hole that are located.
const OF_HOLE: usize = 8;
/// Number of points of an area behind holes that are located.
const OF_AREA: usize = 32;
/// Areas with more sub-paths are traced drawings, not line art over colours.
const MOST_HOLES: usize = 400;

/// A hole of line art, and the topmost area behind it.
struct Hole {
    /// Its sub-path in the figure.
    line: usize,
    outline: Vec<DVec2>,
    area: f64,
    behind: Option<usize>,
}

impl Work {
    /// Replaces line art by its holes. Cost: holes times the points of the areas behind them.
    pub(super) fn open_line_art(&mut self) {
        let outlines: Vec<Option<Vec<DVec2>>> = self.figures.iter().map(painted_outline).collect();
        let mut gone = vec![false; self.figures.len()];
        let mut opened: Vec<(usize, Vec<Figure>)> = Vec::new();
        for (k, outline) in outlines.iter().enumerate() {
            let Some((outer, holes)) =
                outline.as_deref().and_then(|o| Some((o, self.holes(k, o, &outlines)?)))
            else {
                continue;
            };
            opened.push((k, holes.iter().map(|h| self.figure_of(k, h)).collect()));
            for (below, gone) in gone[..k].iter_mut().enumerate() {
                *gone |= outlines[below].as_ref().is_some_and(|o| self.is_behind(below, o, outer, &holes));
            }
        }
        let colours = gone.iter().filter(|g| **g).count();
        let mut opened = opened.into_iter().peekable();
        let mut figures = Vec::with_capacity(self.figures.len());
        for (k, figure) in core::mem::take(&mut self.figures).into_iter().enumerate() {
            match opened.next_if(|(row, _)| *row == k) {
                Some((_, cells)) => figures.extend(cells),
                None if gone[k] => {}
                None => figures.push(figure),
            }
        }
        self.figures = figures;
        self.note(Change::Colour, colours);
    }

    /// Returns the holes of an area, if it is line art over colours. `outer`: its outer outline.
    fn holes(&self, k: usize, outer: &[DVec2], outlines: &[Option<Vec<DVec2>>]) -> Option<Vec<Hole>> {
        let figure = &self.figures[k];
        if figure.lined || !(2..MOST_HOLES).contains(&figure.lines.len()) {
            return None;
        }
        let rings: Vec<Vec<DVec2>> = figure.lines.iter().map(|l| places(l)).collect();
        let areas: Vec<f64> = rings.iter().map(|r| geom::signed_area(r).abs()).collect();
        let whole = geom::signed_area(outer).abs();
        let is_hole = |j: &usize| {
            rings[*j] != outer
                && areas[*j] >= LIMITS_OF_CELLS.hole_least * whole
                && is_closed(&figure.lines[*j])
                && some_of(&rings[*j], OF_HOLE).all(|p| geom::contains(outer, p))
        };
        let candidates: Vec<usize> = (0..rings.len()).filter(is_hole).collect();
        // An island of ink within a hole is not a hole.
        let is_island = |j: usize| {
            candidates.iter().any(|&i| {
                i != j
                    && areas[i] > areas[j]
                    && rings[j].first().is_some_and(|p| geom::contains(&rings[i], *p))
            })
        };
        let holes: Vec<Hole> = candidates
            .iter()
            .filter(|j| !is_island(**j))
            .map(|&j| Hole {
                line: j,
                outline: rings[j].clone(),
                area: areas[j],
                behind: topmost_behind(&figure.lines[j], &rings[j], &outlines[..k]),
            })
            .collect();
        let open: f64 = holes.iter().map(|h| h.area).sum();
        let covered: f64 = holes.iter().filter(|h| h.behind.is_some()).map(|h| h.area).sum();
        let is_line_art =
            whole - open < LIMITS_OF_CELLS.ink_most * whole && covered > LIMITS_OF_CELLS.covered * open;
        is_line_art.then_some(holes)
    }

    /// Returns a hole as an outline that somebody drew, in the colour behind it.
    fn figure_of(&self, k: usize, hole: &Hole) -> Figure {
        let figure = &self.figures[k];
        let mut like = figure.like.clone();
        like.color = hole.behind.and_then(|b| self.figures[b].fill).and_then(|f| f.color).or(like.color);
        Figure { like, lines: vec![figure.lines[hole.line].clone()], lined: true, fill: None }
    }

    /// Whether holes have taken over the colour of an area: it lies within the outer outline and is not a separate
    /// thing in one of them.
    fn is_behind(&self, below: usize, outline: &[DVec2], outer: &[DVec2], holes: &[Hole]) -> bool {
        let points: Vec<DVec2> = some_of(outline, OF_AREA).collect();
        let near = LIMITS_OF_CELLS.near * self.diagonal();
        let is_within = |p: &&DVec2| {
            geom::contains(outer, **p)
                || geom::closest_on_polyline(outer, **p).is_some_and(|c| c.point.distance(**p) < near)
        };
        let inside = points.iter().filter(is_within).count();
        #[expect(clippy::cast_precision_loss, reason = "a few points")]
        let lies_within = inside as f64 >= LIMITS_OF_CELLS.within * points.len() as f64;
        let area = geom::signed_area(outline).abs();
        let is_own_in = |h: &Hole| {
            area < LIMITS_OF_CELLS.own_thing * h.area
                && points.iter().all(|p| geom::contains(&h.outline, *p))
                && !self.is_one_hue(h.behind, below)
        };
        lies_within && !holes.iter().any(is_own_in)
    }

    fn is_one_hue(&self, a: Option<usize>, b: usize) -> bool {
        let color = |k: usize| self.figures[k].fill.and_then(|f| f.color);
        let Some((a, b)) = a.and_then(color).zip(color(b)) else { return false };
        let hue = |c: [u8; 3]| {
            let c = c.map(f64::from);
            let sum = c.iter().sum::<f64>().max(1.0);
            c.map(|x| x / sum)
        };
        hue(a).iter().zip(hue(b)).all(|(a, b)| (a - b).abs() < LIMITS_OF_CELLS.one_hue)
    }
}

/// Returns the outer outline of a figure that is painted by its area.
fn painted_outline(figure: &Figure) -> Option<Vec<DVec2>> {
    if !figure.fill.is_some_and(|f| f.said && f.opacity >= LIMITS.translucent) {
        return None;
    }
    let area = |l: &&Vec<_>| geom::signed_area(&places(l)).abs();
    figure.lines.iter().max_by(|a, b| area(a).total_cmp(&area(b))).map(|l| places(l))
}

/// Returns the topmost of some areas that lies behind most of a hole.
fn topmost_behind(line: &[InkSample], hole: &[DVec2], outlines: &[Option<Vec<DVec2>>]) -> Option<usize> {
    let Extent { lo, hi } = Extent::from_line(line)?;
    let place = |k: u32| (f64::from(k) + 0.5) / f64::from(PLACES);
    let grid =
        (0..PLACES * PLACES).map(|k| lo + (hi - lo) * DVec2::new(place(k % PLACES), place(k / PLACES)));
    let inside: Vec<DVec2> = grid.filter(|p| geom::contains(hole, *p)).collect();
    let is_behind = |o: &Vec<DVec2>| {
        let count = inside.iter().filter(|p| geom::contains(o, **p)).count();
        #[expect(clippy::cast_precision_loss, reason = "a few places")]
        let share = count as f64 / inside.len().max(1) as f64;
        share > LIMITS_OF_CELLS.seen
    };
    outlines.iter().rposition(|o| o.as_ref().is_some_and(is_behind))
}
