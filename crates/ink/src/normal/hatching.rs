//! Strokes that shade an outline: parallel lines, zigzag, dots.

use base::LiteMap;
use glam::DVec2;

use super::{Change, Extent, LIMITS, Work, chord_of, is_closed, length_of, places};
use crate::InkSample;

/// Least chord over length of a stroke of a hatching.
const NEARLY_STRAIGHT: f64 = 0.94;
/// Turns of a zigzag are sharper than this cosine: 115 degrees.
const SHARP: f64 = -0.42;
/// Least turns of a zigzag.
const TURNS: usize = 6;
/// Least share of turns among all corners of a zigzag.
const TURNS_SHARE: f64 = 0.6;
/// Least cosine between a piece of a zigzag and its direction.
const ALONG: f64 = 0.85;
/// Number of places along a zigzag that are checked.
const ALONG_ZIGZAG: f64 = 48.0;
/// Neighbouring hatches are nearer than this share of the drawing's diagonal, or than their length.
const APART: f64 = 0.02;
/// Least dots of a stipple within an outline.
const DOTS: usize = 12;
/// Dots of one pen differ by no more than this share of their size.
const SAME_DOT: f64 = 0.2;
/// Ends of hatches lie this near to the outline, as a share of its narrower side.
const AT_EDGE: f64 = 0.16;
/// Share of the hatches that lie within the outline and end on it.
const MOST: f64 = 0.75;
/// Most overlapping outlines that are tested for the one that a hatch shades.
const OVERLAPPING: usize = 6;
/// Least hatches of an outline that do not run across it.
const MANY: usize = 8;
/// Hatches from one edge are nearer to one another than this share of their length; side veins are farther apart.
const DENSE: f64 = 0.35;
/// Short strokes within an outline are no longer than this share of its narrower side.
const SHORT: f64 = 0.45;
/// Most directions in which the hatching of one drawing runs.
const WAYS: usize = 6;
/// A few strokes in an outline are hatching if many in others run the same way within this cosine: 6 degrees.
const SAME_WAY: f64 = 0.995;

struct Outline {
    figure: usize,
    points: Vec<DVec2>,
    extent: Extent,
}

/// An open line that may be a hatch.
#[derive(Clone, Copy)]
struct Hatch {
    figure: usize,
    line: usize,
    from: DVec2,
    to: DVec2,
}

impl Work {
    pub(super) fn leave_hatching_out(&mut self) {
        let diagonal = self.diagonal();
        let outlines = self.closed_outlines();
        if outlines.is_empty() {
            return;
        }
        let mut out = self.none_out();
        let mut colors: Vec<(usize, [u8; 3])> = Vec::new();
        let mut run: Vec<Hatch> = Vec::new();
        let mut dots: Vec<Hatch> = Vec::new();
        let mut compared = 0;
        for (k, figure) in self.figures.iter().enumerate() {
            for (l, line) in figure.lines.iter().enumerate() {
                let (Some(first), Some(last)) = (line.first(), line.last()) else { continue };
                let hatch = Hatch { figure: k, line: l, from: first.at, to: last.at };
                if Extent::from_line(line)
                    .is_some_and(|e| e.size().max_element() <= 0.6 * LIMITS.dot * diagonal)
                {
                    dots.push(hatch);
                    continue;
                }
                let straight = figure.lined && chord_of(line).length() >= NEARLY_STRAIGHT * length_of(line);
                if !(straight
                    && run.last().is_none_or(|before| self.goes_with(before, &run[0], &hatch, diagonal)))
                {
                    self.end_run(&mut run, &outlines, &mut out, &mut colors);
                }
                if straight {
                    run.push(hatch);
                }
                compared += outlines.len();
                if figure.lined
                    && compared < LIMITS.pairs
                    && is_zigzag(line, diagonal)
                    && let Some(o) =
                        around(&geom::resample(&places(line), length_of(line) / ALONG_ZIGZAG), &outlines)
                    && o.figure != k
                {
                    out[k][l] = true;
                    colors.extend(figure.like.color.map(|c| (o.figure, c)));
                }
            }
        }
        self.end_run(&mut run, &outlines, &mut out, &mut colors);
        self.find_few_hatches(&outlines, &mut out, &mut colors);
        self.find_stipple(&dots, &outlines, &mut out);
        for (figure, color) in colors {
            let f = &mut self.figures[figure];
            if f.fill.is_none() {
                f.like.color = Some(color);
            }
        }
        self.leave_out(&out, Change::Hatching);
    }

    /// Finds the hatching of outlines that are too small for many hatches, if others are hatched: lines across them
    /// that run the same way, are painted alike and are no longer than the others.
    fn find_few_hatches(
        &self,
        outlines: &[Outline],
        out: &mut [Vec<bool>],
        colors: &mut Vec<(usize, [u8; 3])>,
    ) {
        let hatch = |figure: usize, line: usize| {
            let samples = &self.figures[figure].lines[line];
            Some(Hatch { figure, line, from: samples.first()?.at, to: samples.last()?.at })
        };
        let rows =
            || (0..self.figures.len()).flat_map(|f| (0..self.figures[f].lines.len()).map(move |l| (f, l)));
        let known: Vec<Hatch> = rows().filter(|&(f, l)| out[f][l]).filter_map(|(f, l)| hatch(f, l)).collect();
        let Some(longest) = known.iter().map(|h| h.from.distance(h.to)).reduce(f64::max) else { return };
        let mut ways: Vec<(DVec2, Option<[u8; 3]>)> = Vec::new();
        for h in &known {
            let (way, color) = ((h.to - h.from).normalize_or_zero(), self.figures[h.figure].like.color);
            if !ways.iter().any(|(w, c)| *c == color && w.dot(way).abs() >= SAME_WAY) {
                ways.push((way, color));
            }
        }
        if ways.len() > WAYS || rows().count() * outlines.len() > LIMITS.pairs {
            return;
        }
        for (f, l) in rows().filter(|&(f, l)| !out[f][l]).collect::<Vec<_>>() {
            let (figure, Some(h)) = (&self.figures[f], hatch(f, l)) else { continue };
            let (way, length) = (h.to - h.from, h.from.distance(h.to));
            let runs_so =
                |(w, c): &(DVec2, _)| *c == figure.like.color && w.dot(way).abs() >= SAME_WAY * length;
            let straight =
                chord_of(&figure.lines[l]).length() >= NEARLY_STRAIGHT * length_of(&figure.lines[l]);
            if !(figure.lined && straight && length <= longest && ways.iter().any(runs_so)) {
                continue;
            }
            if let Some(row) = outline_of(&h, outlines).filter(|&row| outlines[row].is_crossed_by(&h)) {
                out[f][l] = true;
                colors.extend(figure.like.color.map(|c| (outlines[row].figure, c)));
            }
        }
    }

    fn closed_outlines(&self) -> Vec<Outline> {
        let mut out = Vec::new();
        for (figure, f) in self.figures.iter().enumerate() {
            for line in f.lines.iter().filter(|l| is_closed(l)) {
                out.extend(Extent::from_line(line).map(|extent| Outline {
                    figure,
                    points: places(line),
                    extent,
                }));
            }
        }
        // The smallest outline around a point is the one that it lies in.
        base::sort_by(&mut out, |a, b| a.extent.area().total_cmp(&b.extent.area()));
        out
    }

    /// Whether a line is the next hatch: painted alike, parallel, and next to the one before.
    fn goes_with(&self, before: &Hatch, first: &Hatch, next: &Hatch, diagonal: f64) -> bool {
        let like = |h: &Hatch| {
            let s = &self.figures[h.figure].like;
            (s.color, s.mode, s.layer.clone())
        };
        let (a, b, c) = (before.to - before.from, next.to - next.from, first.to - first.from);
        let longest = a.length().max(b.length());
        let apart = before.from.midpoint(before.to).distance(next.from.midpoint(next.to));
        like(before) == like(next)
            && b.dot(c).abs() >= LIMITS.parallel * b.length() * c.length()
            && (before.figure == next.figure || apart <= longest.max(APART * diagonal))
    }

    fn end_run(
        &self,
        run: &mut Vec<Hatch>,
        outlines: &[Outline],
        out: &mut [Vec<bool>],
        colors: &mut Vec<(usize, [u8; 3])>,
    ) {
        let hatches = core::mem::take(run);
        if hatches.len() < LIMITS.hatches {
            return;
        }
        // Adjacent outlines may be hatched one after the other, in one direction.
        let mut by_outline: LiteMap<usize, Vec<Hatch>> = LiteMap::new();
        for hatch in hatches {
            if let Some(row) = outline_of(&hatch, outlines) {
                by_outline.entry(row).or_default().push(hatch);
            }
        }
        for (row, hatches) in by_outline {
            let outline = &outlines[row];
            if !outline.is_hatched_by(&hatches) {
                continue;
            }
            hatches.iter().for_each(|h| out[h.figure][h.line] = true);
            let color = self.figures[hatches[0].figure].like.color;
            colors.extend(color.map(|c| (outline.figure, c)));
        }
    }
}

/// Returns the outline that a hatch shades: of those that overlap, the one that it crosses, or else the smallest.
fn outline_of(hatch: &Hatch, outlines: &[Outline]) -> Option<usize> {
    let middle = hatch.from.midpoint(hatch.to);
    let around = || (0..outlines.len()).filter(|&row| outlines[row].holds(middle)).take(OVERLAPPING);
    around().find(|&row| outlines[row].is_crossed_by(hatch)).or_else(|| around().next())
}

impl Outline {
    fn holds(&self, p: DVec2) -> bool {
        let is_boxed = self.extent.lo.cmple(p).all() && self.extent.hi.cmpge(p).all();
        is_boxed && geom::contains(&self.points, p)
    }

    /// Whether a point lies on its edge.
    fn has_on_edge(&self, p: DVec2) -> bool {
        let near = AT_EDGE * self.extent.size().min_element();
        geom::closest_on_polyline(&self.points, p).is_some_and(|c| c.point.distance(p) <= near)
    }

    /// Whether a line crosses it from edge to edge.
    fn is_crossed_by(&self, hatch: &Hatch) -> bool {
        self.has_on_edge(hatch.from) && self.has_on_edge(hatch.to)
    }

    /// Whether enough lines cross it from edge to edge, or many dense ones begin at its edge, or are short within it.
    fn is_hatched_by(&self, hatches: &[Hatch]) -> bool {
        let is_most_of = |holds: fn(&Self, &Hatch) -> bool| {
            let count = hatches.iter().filter(|h| holds(self, h)).count();
            #[expect(clippy::cast_precision_loss, reason = "numbers of strokes")]
            let is_most = count as f64 >= MOST * hatches.len() as f64;
            is_most
        };
        let from_edge = |o: &Self, h: &Hatch| o.has_on_edge(h.from) || o.has_on_edge(h.to);
        let is_short = |o: &Self, h: &Hatch| {
            h.from.distance(h.to) <= SHORT * o.extent.size().min_element() && o.holds(h.from) && o.holds(h.to)
        };
        (hatches.len() >= LIMITS.hatches && is_most_of(Self::is_crossed_by))
            || (hatches.len() >= MANY && is_most_of(from_edge) && is_dense(hatches))
            || (hatches.len() >= MANY && is_most_of(is_short))
    }
}

/// Whether most hatches are nearer to the one before than their own length.
fn is_dense(hatches: &[Hatch]) -> bool {
    let middle = |h: &Hatch| h.from.midpoint(h.to);
    let near = |w: &&[Hatch]| middle(&w[0]).distance(middle(&w[1])) <= DENSE * w[0].from.distance(w[0].to);
    #[expect(clippy::cast_precision_loss, reason = "numbers of strokes")]
    let is_most = hatches.windows(2).filter(near).count() as f64 >= MOST * (hatches.len() - 1) as f64;
    is_most
}

/// Returns the smallest outline that most points lie in.
fn around<'a>(points: &[DVec2], outlines: &'a [Outline]) -> Option<&'a Outline> {
    let some: Vec<DVec2> = super::some_of(points, 24).collect();
    #[expect(clippy::cast_precision_loss, reason = "a few points")]
    let holds = |o: &&Outline| {
        let inside = some.iter().filter(|p| o.holds(**p)).count();
        inside as f64 >= MOST * some.len() as f64
    };
    outlines.iter().find(holds)
}

/// Whether a line runs to and fro.
fn is_zigzag(line: &[InkSample], diagonal: f64) -> bool {
    if line.len() < TURNS || chord_of(line).length() > 0.6 * length_of(line) {
        return false;
    }
    let corners = geom::simplify(&places(line), 0.004 * diagonal);
    let turns = corners.windows(3).filter(|w| {
        let (a, b) = (w[1] - w[0], w[2] - w[1]);
        a.dot(b) <= SHARP * a.length() * b.length()
    });
    let turns = turns.count();
    #[expect(clippy::cast_precision_loss, reason = "numbers of corners")]
    let share = turns as f64 / corners.len().saturating_sub(2).max(1) as f64;
    (turns >= TURNS && share >= TURNS_SHARE) || runs_to_and_fro(&corners)
}

/// Whether most of a line runs along one direction, alternating forth and back.
fn runs_to_and_fro(corners: &[DVec2]) -> bool {
    let pieces: Vec<DVec2> = corners.windows(2).map(|w| w[1] - w[0]).collect();
    let longest = pieces.iter().copied().max_by(|a, b| a.length().total_cmp(&b.length()));
    let Some(way) = longest.map(DVec2::normalize_or_zero) else { return false };
    let along: Vec<f64> = pieces
        .iter()
        .map(|p| p.dot(way))
        .zip(&pieces)
        .filter(|(along, p)| along.abs() >= ALONG * p.length())
        .map(|(along, _)| along)
        .collect();
    let whole: f64 = pieces.iter().map(|p| p.length()).sum();
    let turns = along.windows(2).filter(|w| w[0] * w[1] < 0.0).count();
    turns >= TURNS && along.iter().map(|a| a.abs()).sum::<f64>() >= TURNS_SHARE * whole
}

impl Work {
    /// Finds tiny dots in outlines: many in one of them, or many painted as areas of one size in all.
    fn find_stipple(&self, dots: &[Hatch], outlines: &[Outline], out: &mut [Vec<bool>]) {
        if dots.len() < DOTS || dots.len() * outlines.len() > LIMITS.pairs {
            return;
        }
        let size = |d: &Hatch| {
            Extent::from_line(&self.figures[d.figure].lines[d.line]).map_or(0.0, |e| e.size().max_element())
        };
        let mut inside: Vec<Vec<&Hatch>> = outlines.iter().map(|_| Vec::new()).collect();
        for dot in dots {
            let own = |o: &Outline| o.figure != dot.figure && o.extent.size().min_element() > 2.0 * size(dot);
            if let Some(row) = outlines.iter().position(|o| own(o) && o.holds(dot.from)) {
                inside[row].push(dot);
            }
        }
        let mut areas: Vec<&Hatch> = inside.iter().flatten().copied().collect();
        areas.retain(|d| !self.figures[d.figure].lined);
        let mut sizes: Vec<f64> = areas.iter().map(|d| size(d)).collect();
        base::sort_numbers(&mut sizes);
        let usual = sizes.get(sizes.len() / 2).copied().unwrap_or_default();
        areas.retain(|d| (size(d) - usual).abs() <= SAME_DOT * usual);
        if areas.len() < 2 * DOTS {
            areas.clear();
        }
        let many = inside.into_iter().filter(|d| d.len() >= DOTS).flatten();
        many.chain(areas).for_each(|d| out[d.figure][d.line] = true);
    }
}
