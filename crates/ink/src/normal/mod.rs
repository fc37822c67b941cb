//! Normal form of what drawing programs paint: plain strokes, one for each line that was meant.
//!
//! `figures and sheet -> Normal (strokes and what was done to them)`
//!
//! | step | module |
//! |---|---|
//! | outside the sheet, pages, frames, ruling | `paper` |
//! | leader lines from words | `labels` |
//! | rims of stickers, layers under the whole drawing | `backing` |
//! | line art painted as one area with holes | `cells` |
//! | outlines of a pen's stroke, traced ink | `ribbon`, `traced` |
//! | a line drawn twice, segments, outlines in pieces | `pieces` |
//! | areas of one colour, colour under a line, shade over colour | `colour` |
//! | hatching, stipple | `hatching` |
//!
//! A figure holds what a file says of one element and is never changed in place by its surroundings: each step judges
//! the figures that it receives and returns those that are left.

mod backing;
mod cells;
mod colour;
mod hatching;
mod labels;
mod paper;
mod pieces;
mod ribbon;
mod traced;

pub use colour::{hue, hues_apart};

use base::LiteMap;
use glam::DVec2;

use crate::{InkSample, Stroke};

/// Limits of the normal form, as shares of the drawing's diagonal where nothing else is said.
///
/// They were measured on drawings as programs write them; plain strokes of a pen lie outside all of them.
struct Limits {
    /// A line is straight if its chord is this share of its length.
    straight: f64,
    /// Largest distance at which two ends meet.
    meet: f64,
    /// The ends of an outline lie within this share of its length.
    gap: f64,
    /// A hand that closes an outline draws on past its beginning over at most this share of its length.
    overshoot: f64,
    /// An outline encloses at least this area, as a share of its length squared: a leaf of 1 : 8 has 0.02.
    round: f64,
    /// Two ends of an outline in pieces meet within this share of the shorter piece.
    meet_share: f64,
    /// Least segments of a line in segments, one after the other.
    segments: usize,
    /// Pieces of a line in segments are no longer than this.
    segment: f64,
    /// A rectangle of paper has this share of its length on the sides of its box.
    on_sides: f64,
    /// Paper holds this share of all other lines.
    held: f64,
    /// Least share of the paper's width that sky and ground span.
    across: f64,
    /// Least lines of ruled paper, and least dots of dotted paper along a side.
    ruled: usize,
    /// Least strokes of a hatching.
    hatches: usize,
    /// Least cosine between strokes of one direction.
    parallel: f64,
    /// Dots of a stipple are no larger than this.
    dot: f64,
    /// The same line drawn twice lies within this share of its length.
    twice: f64,
    /// Colour lies under a line within this share of its narrower side.
    under: f64,
    /// Areas below this opacity shade what they lie on.
    translucent: f64,
    /// Least value of each channel of the white of the paper.
    white: u8,
    /// Most pairs of areas and outlines that are compared.
    pairs: usize,
}

const LIMITS: Limits = Limits {
    straight: 0.985,
    meet: 0.012,
    gap: 0.06,
    overshoot: 0.2,
    round: 0.018,
    meet_share: 0.12,
    segments: 6,
    segment: 0.06,
    on_sides: 0.8,
    held: 0.95,
    across: 0.94,
    ruled: 6,
    hatches: 5,
    parallel: 0.94,
    dot: 0.012,
    twice: 0.03,
    under: 0.14,
    translucent: 0.6,
    white: 246,
    pairs: 4_000_000,
};

/// An area that is painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fill {
    /// Its colour, or the mean of its gradient; `None` where the file does not say.
    pub color: Option<[u8; 3]>,
    /// Whether the file asks for it: SVG paints black by default.
    pub said: bool,
    /// Opacity, 0 to 1.
    pub opacity: f64,
    /// Whether the even-odd rule applies: points in an even number of sub-paths are not painted, however these run.
    pub even_odd: bool,
}

/// One painted element of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// Attributes of its strokes, without samples; its colour is the line's.
    pub like: Stroke,
    /// Its sub-paths, y up.
    pub lines: Vec<Vec<InkSample>>,
    /// Whether its outline is painted.
    pub lined: bool,
    /// Its area, if painted.
    pub fill: Option<Fill>,
}

impl Figure {
    /// Returns its visible colour: that of its area, else of its line.
    fn color_seen(&self) -> Option<[u8; 3]> {
        self.fill.and_then(|f| f.color).or(self.like.color)
    }
}

/// A change made to a drawing to get plain strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Change {
    /// Lies outside the sheet.
    OffSheet,
    /// Page, frame, card, sky, ground, cast shadow or ruling.
    Paper,
    /// A line from words to what they name, or its head.
    Labels,
    /// The outline of a pen's stroke: its centre line was taken.
    PenOutline,
    /// Traced ink: the centre lines of what is connected were taken.
    TracedInk,
    /// A line that was drawn twice.
    DrawnTwice,
    /// Pieces whose ends meet.
    Joined,
    /// A coloured area under a line: the line has the colour.
    Colour,
    /// Areas that shade what they lie on.
    Shade,
    /// Hatching and stipple.
    Hatching,
}

impl Change {
    /// Returns its code in reports.
    pub const fn code(self) -> &'static str {
        match self {
            Self::OffSheet => "off-sheet",
            Self::Paper => "paper-left-out",
            Self::Labels => "labels-left-out",
            Self::PenOutline => "filled-outline",
            Self::TracedInk => "traced-ink",
            Self::DrawnTwice => "drawn-twice",
            Self::Joined => "pieces-joined",
            Self::Colour => "colour-under-line",
            Self::Shade => "shade-left-out",
            Self::Hatching => "hatching-left-out",
        }
    }

    /// Returns its meaning in words, for a number of shapes or strokes.
    pub fn sentence(self, count: usize) -> String {
        match self {
            Self::OffSheet => format!("{count} shapes lie outside the sheet and were left out"),
            Self::Paper => {
                format!(
                    "{count} lines belong to the paper (page, frame, card, sky, ground, cast shadow, ruling, lines in its colour) and were left out"
                )
            }
            Self::Labels => format!("{count} lines lead from words to the drawing and were left out"),
            Self::PenOutline => format!(
                "{count} filled shapes are strokes of a variable-width pen: their centre lines were taken, \
                 and their widths as pressure"
            ),
            Self::TracedInk => format!(
                "{count} filled shapes are traced ink: centre lines were taken; engravings and traced scans are \
                 mostly misread: if the plant is wrong, draw its outlines with a pen"
            ),
            Self::DrawnTwice => format!("{count} lines were drawn twice: each is one stroke"),
            Self::Joined => format!("{count} pieces whose ends meet were joined to longer strokes"),
            Self::Colour => format!("{count} coloured areas lie under lines: the lines have their colour"),
            Self::Shade => format!("{count} areas shade the parts below them and were left out"),
            Self::Hatching => format!("{count} strokes are hatching or stipple and were left out"),
        }
    }
}

/// Plain strokes, with the changes that gave them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Normal {
    /// Strokes in the order of the figures.
    pub strokes: Vec<Stroke>,
    /// Changes, each with the number of shapes or strokes that it concerns.
    pub changes: LiteMap<Change, usize>,
}

/// Reduces figures to plain strokes.
///
/// `sheet`: the corners of the sheet, if the file has one. `words`: boxes around its texts, lower and upper corner.
/// Guaranteed: lines of a pen that are none of what [`Change`] names pass through unchanged, in their order; not
/// everything is left out. Cost: about linear in points, apart from comparing areas with outlines, which is bounded.
///
/// ```
/// use ink::{Figure, InkSample, normalise};
/// let line = [[0.0, 0.0], [1.0, 5.0]].map(|p| InkSample::from(glam::DVec2::from(p))).to_vec();
/// let figure = Figure { lines: vec![line.clone()], lined: true, ..Figure::default() };
/// assert_eq!(normalise(vec![figure], None, &[]).strokes[0].samples, line);
/// ```
pub fn normalise(figures: Vec<Figure>, sheet: Option<(DVec2, DVec2)>, words: &[(DVec2, DVec2)]) -> Normal {
    let mut work = Work { figures, sheet, changes: LiteMap::new() };
    work.figures.iter_mut().for_each(drop_points);
    work.off_sheet();
    work.leave_labels_out(words);
    work.leave_paper_out();
    work.leave_backings_out();
    work.open_line_art();
    work.merge_areas_of_one_colour();
    work.take_pen_outlines();
    work.take_traced_ink();
    work.merge_repeats();
    work.join_pieces();
    work.leave_hatching_out();
    work.colour_lines();
    let mut strokes = Vec::new();
    for figure in work.figures {
        let Figure { like, lines, .. } = figure;
        strokes.extend(lines.into_iter().map(|samples| Stroke { samples, ..like.clone() }));
    }
    Normal { strokes, changes: work.changes }
}

/// Drops sub-paths without extent, where a program put its pen down, if there are others.
fn drop_points(figure: &mut Figure) {
    if figure.lines.iter().any(|l| length_of(l) > 0.0) {
        figure.lines.retain(|l| l.len() > 1);
    }
}

/// Figures in the course of the steps.
struct Work {
    figures: Vec<Figure>,
    sheet: Option<(DVec2, DVec2)>,
    changes: LiteMap<Change, usize>,
}

impl Work {
    fn note(&mut self, change: Change, count: usize) {
        if count > 0 {
            *self.changes.entry(change).or_default() += count;
        }
    }

    /// Removes lines, but never all of them, and returns how many. `out[figure][line]`.
    fn take_out(&mut self, out: &[Vec<bool>]) -> usize {
        let count = out.iter().flatten().filter(|o| **o).count();
        if count == 0 || count == out.iter().map(Vec::len).sum::<usize>() {
            return 0;
        }
        for (figure, out) in self.figures.iter_mut().zip(out) {
            let mut row = out.iter();
            figure.lines.retain(|_| !row.next().copied().unwrap_or_default());
        }
        self.figures.retain(|f| !f.lines.is_empty());
        count
    }

    fn leave_out(&mut self, out: &[Vec<bool>], change: Change) {
        let count = self.take_out(out);
        self.note(change, count);
    }

    /// Returns for each line of each figure whether it is left out: none yet.
    fn none_out(&self) -> Vec<Vec<bool>> {
        self.figures.iter().map(|f| vec![false; f.lines.len()]).collect()
    }

    fn diagonal(&self) -> f64 {
        let boxes = self.figures.iter().flat_map(|f| &f.lines).filter_map(|l| Extent::from_line(l));
        boxes.reduce(Extent::with).map_or(0.0, |b| b.size().length())
    }
}

/// A box around points.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Extent {
    lo: DVec2,
    hi: DVec2,
}

impl Extent {
    /// Returns the box of the finite points of a line.
    fn from_line(line: &[InkSample]) -> Option<Self> {
        let finite = line.iter().map(|s| s.at).filter(|p| p.abs().max_element() < 1e150);
        finite.map(|p| Self { lo: p, hi: p }).reduce(Self::with)
    }

    fn with(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    fn size(self) -> DVec2 {
        self.hi - self.lo
    }

    fn middle(self) -> DVec2 {
        (self.lo + self.hi) * 0.5
    }

    fn area(self) -> f64 {
        self.size().x * self.size().y
    }

    fn meets(self, other: Self) -> bool {
        self.lo.cmple(other.hi).all() && self.hi.cmpge(other.lo).all()
    }

    /// Whether it contains the other, up to `slack`.
    fn holds(self, other: Self, slack: f64) -> bool {
        (self.lo - slack).cmple(other.lo).all() && (self.hi + slack).cmpge(other.hi).all()
    }
}

fn places(line: &[InkSample]) -> Vec<DVec2> {
    line.iter().map(|s| s.at).collect()
}

fn length_of(line: &[InkSample]) -> f64 {
    line.windows(2).map(|w| w[1].at.distance(w[0].at)).sum()
}

fn chord_of(line: &[InkSample]) -> DVec2 {
    match (line.first(), line.last()) {
        (Some(a), Some(b)) => b.at - a.at,
        _ => DVec2::ZERO,
    }
}

/// Whether the ends of a line meet, or a hand drew on past the beginning of an outline.
fn is_closed(line: &[InkSample]) -> bool {
    if line.len() <= 3 {
        return false;
    }
    let length = length_of(line);
    chord_of(line).length() <= LIMITS.gap * length || overshoots(&places(line), length)
}

/// Whether a line encloses an area and one of its ends lies on the part of it about the other end.
fn overshoots(line: &[DVec2], length: f64) -> bool {
    let lies_on_beginning = |line: &[DVec2]| {
        let mut way = 0.0;
        let count = line.windows(2).take_while(|w| {
            way += w[0].distance(w[1]);
            way <= LIMITS.overshoot * length
        });
        let beginning = &line[..=count.count()];
        let end = line.last().and_then(|p| geom::distance_to_polyline(beginning, *p));
        end.is_some_and(|d| d <= LIMITS.gap * length)
    };
    let encloses = geom::signed_area(line).abs() >= LIMITS.round * length * length;
    encloses
        && (lies_on_beginning(line) || lies_on_beginning(&line.iter().rev().copied().collect::<Vec<_>>()))
}

/// Returns up to `n` points of a line, evenly spaced by their numbers.
fn some_of(line: &[DVec2], n: usize) -> impl Iterator<Item = DVec2> + '_ {
    let stride = line.len().div_ceil(n).max(1);
    line.iter().copied().step_by(stride)
}

#[cfg(test)]
mod tests;
