//! Parts of the sheet rather than of the drawing: pages, frames, cards, sky and ground, cast shadows, ruling.

use glam::DVec2;

use super::{Change, Extent, LIMITS, Work, is_closed, length_of, places};
use crate::InkSample;

/// Largest distance of sky and ground from the sides of the paper, as a share of these.
const INSET: f64 = 0.04;
/// A straight line along an axis is no wider than this share of its length.
const THIN: f64 = 0.006;
/// Least sides of a drawing on which borders lie; the ground and one wall lie on two.
const SIDES: usize = 3;
/// The sides of a ring's box differ by no more than this share.
const ROUND_RING: f64 = 0.95;
/// Number of sectors of a circle that are checked for whether a drawing reaches its rim.
const SECTORS: usize = 8;
/// Least reach of a drawing in a ring from its middle, as a share of its radius; marks on a fruit need not reach as
/// far.
const SPANS_RING: f64 = 0.55;
/// Largest reach of a drawing in a ring from its middle, as a share of its radius.
const WITHIN_RING: f64 = 0.93;
/// A drawing reaches equally far all round in a ring if its least reach is more than this share of its largest.
const ALL_ROUND: f64 = 0.75;
/// Least difference in a channel by which two colours differ.
const SAME_COLOR: u8 = 6;

/// Requirements of a shadow that a plant casts on the ground.
struct CastShadow {
    /// It is at least this many times as wide as high.
    wide: f64,
    /// The same if it is seen through, or painted before all else, so that the plant stands on it.
    wide_below_all: f64,
    /// Its middle lies below this height of all else, as a share of that height.
    low: f64,
    /// The same if it is seen through, or painted before all else.
    low_below_all: f64,
    /// Its channels differ by at most this: it is grey or black.
    grey: u8,
}

const CAST_SHADOW: CastShadow =
    CastShadow { wide: 3.0, wide_below_all: 1.6, low: 0.06, low_below_all: 0.3, grey: 24 };

/// A line and its place.
struct Placed {
    figure: usize,
    line: usize,
    extent: Extent,
}

impl Work {
    /// Leaves out figures outside the sheet, where the greater part of the drawing lies on it.
    pub(super) fn off_sheet(&mut self) {
        let Some((lo, hi)) = self.sheet else { return };
        let sheet = Extent { lo, hi };
        let mut out = self.none_out();
        for (figure, out) in self.figures.iter().zip(&mut out) {
            for (line, out) in figure.lines.iter().zip(out) {
                *out = Extent::from_line(line).is_some_and(|e| !e.meets(sheet));
            }
        }
        let (gone, all) = (out.iter().flatten().filter(|o| **o).count(), out.iter().flatten().count());
        if gone * 2 < all {
            self.leave_out(&out, Change::OffSheet);
        }
    }

    pub(super) fn leave_paper_out(&mut self) {
        let mut out = self.none_out();
        let mut placed: Vec<Placed> = Vec::new();
        for (k, figure) in self.figures.iter().enumerate() {
            for (l, line) in figure.lines.iter().enumerate() {
                if let Some(extent) = Extent::from_line(line) {
                    placed.push(Placed { figure: k, line: l, extent });
                }
            }
        }
        if placed.len() < 2 {
            return;
        }
        self.find_ruling(&placed, &mut out);
        self.find_dots(&placed, &mut out);
        let paper = self.find_frames(&placed, &mut out);
        self.find_ground(&placed, paper, &mut out);
        self.find_cast_shadow(&placed, &mut out);
        self.find_borders(&placed, &mut out);
        self.find_ring(&placed, &mut out);
        self.find_unseen(&mut out);
        self.leave_out(&out, Change::Paper);
    }

    /// Finds areas in the colour of the topmost page that lie on no area of another colour. Where there is no page,
    /// white areas; white lines may be meant for a dark one.
    fn find_unseen(&self, out: &mut [Vec<bool>]) {
        let is_paper = |k: usize| out[k].iter().all(|o| *o);
        let area = |k: usize| self.figures[k].fill.filter(|f| f.opacity > LIMITS.translucent);
        let pages = (0..self.figures.len()).rev().filter(|&k| is_paper(k));
        let page = pages.filter_map(|k| area(k)?.color).next();
        let color = page.unwrap_or([u8::MAX; 3]);
        let is_like_paper = |own: Option<[u8; 3]>| {
            own.is_some_and(|own| own.iter().zip(color).all(|(a, b)| a.abs_diff(b) <= SAME_COLOR))
        };
        let drawn: Vec<usize> = (0..self.figures.len()).filter(|&k| !is_paper(k)).collect();
        let lies_under_nothing = |&k: &usize| {
            let painted = self.figures[k].fill.filter(|f| f.said || !self.figures[k].lined);
            painted.is_none_or(|f| is_like_paper(f.color))
        };
        let is_unseen = |&k: &usize| {
            let figure = &self.figures[k];
            !figure.lined || (page.is_some() && is_like_paper(figure.like.color))
        };
        let unseen: Vec<usize> = drawn.iter().copied().filter(is_unseen).collect();
        if unseen.len() < drawn.len() && drawn.iter().all(lies_under_nothing) {
            unseen.into_iter().for_each(|k| out[k].fill(true));
        }
    }

    /// Finds straight lines along an axis outside all else, on three sides of it or more: frames in pieces, crop marks.
    fn find_borders(&self, placed: &[Placed], out: &mut [Vec<bool>]) {
        let is_rule = |p: &&Placed| {
            let figure = &self.figures[p.figure];
            let (size, line) = (p.extent.size(), &figure.lines[p.line]);
            figure.lined
                && size.min_element() <= THIN * size.max_element()
                && length_of(line) < 1.05 * size.max_element()
        };
        let seen = || placed.iter().filter(|p| !out[p.figure][p.line]);
        let drawn = seen().filter(|p| !is_rule(p)).map(|p| p.extent).reduce(Extent::with);
        let Some(drawn) = drawn else { return };
        let mut found: [Vec<&Placed>; 4] = [Vec::new(), Vec::new(), Vec::new(), Vec::new()];
        for p in seen().filter(is_rule) {
            let across = usize::from(p.extent.size().x >= p.extent.size().y);
            let at = p.extent.middle()[across];
            if at < drawn.lo[across] {
                found[2 * across].push(p);
            } else if at > drawn.hi[across] {
                found[2 * across + 1].push(p);
            }
        }
        if found.iter().filter(|side| !side.is_empty()).count() >= SIDES {
            found.iter().flatten().for_each(|p| out[p.figure][p.line] = true);
        }
    }

    /// Finds a circle around all else that the drawing does not fill: a badge. A drawing that reaches its rim all round
    /// is a slice of fruit.
    fn find_ring(&self, placed: &[Placed], out: &mut [Vec<bool>]) {
        let seen = || placed.iter().filter(|p| !out[p.figure][p.line]);
        let Some(p) = seen().max_by(|a, b| a.extent.area().total_cmp(&b.extent.area())) else { return };
        let (figure, half) = (&self.figures[p.figure], p.extent.size() * 0.5);
        let is_circle = half.min_element() >= ROUND_RING * half.max_element()
            && is_ellipse(&figure.lines[p.line], p.extent);
        if !(figure.lined && figure.lines.len() == 1 && is_circle) {
            return;
        }
        let others = seen().filter(|o| (o.figure, o.line) != (p.figure, p.line));
        let points = others.flat_map(|o| &self.figures[o.figure].lines[o.line]).map(|s| s.at);
        let mut reach = [0.0_f64; SECTORS];
        for from_middle in points.map(|q| (q - p.extent.middle()) / half) {
            let (x, y) = (from_middle.x, from_middle.y);
            let sector = usize::from(x > 0.0) + 2 * usize::from(y > 0.0) + 4 * usize::from(x.abs() > y.abs());
            reach[sector] = reach[sector].max(from_middle.length());
        }
        let (least, most) = reach.iter().fold((1.0_f64, 0.0_f64), |(a, b), r| (a.min(*r), b.max(*r)));
        if (SPANS_RING..WITHIN_RING).contains(&most) && least < ALL_ROUND * most {
            out[p.figure][p.line] = true;
        }
    }

    /// Finds rectangles that hold all the rest, and filled ellipses under it. Returns the largest of them, or the
    /// sheet.
    fn find_frames(&self, placed: &[Placed], out: &mut [Vec<bool>]) -> Option<Extent> {
        let mut order: Vec<&Placed> =
            placed.iter().filter(|p| !out[p.figure][p.line] && self.may_be_frame(p)).collect();
        base::sort_by(&mut order, |a, b| b.extent.area().total_cmp(&a.extent.area()));
        let mut paper = self.sheet.map(|(lo, hi)| Extent { lo, hi });
        let mut found = None;
        // A page, a card with its shadow, a frame of two lines: nobody stacks more than that.
        for p in order.into_iter().take(12) {
            let rest: Vec<Extent> = placed
                .iter()
                .filter(|o| !out[o.figure][o.line] && (o.figure, o.line) != (p.figure, p.line))
                .map(|o| o.extent)
                .collect();
            let slack = 0.02 * p.extent.size().max_element();
            let sheet_like =
                |s: Extent| p.extent.size().cmpge(s.size() * LIMITS.across).all() && p.extent.meets(s);
            let held = rest.iter().filter(|r| p.extent.holds(**r, slack)).count();
            #[expect(clippy::cast_precision_loss, reason = "numbers of lines")]
            let holds = held as f64 >= LIMITS.held * rest.len() as f64;
            let rectangle = is_rectangle(&self.figures[p.figure].lines[p.line], p.extent);
            let enough = rest.len() >= if rectangle { 1 } else { 4 };
            if enough && (holds || (rectangle && paper.is_some_and(sheet_like))) {
                out[p.figure][p.line] = true;
                found = found.or(Some(p.extent));
            }
        }
        paper = found.or(paper);
        paper
    }

    fn may_be_frame(&self, p: &Placed) -> bool {
        let figure = &self.figures[p.figure];
        let line = &figure.lines[p.line];
        if !is_closed(line) {
            return false;
        }
        let painted = figure.fill.is_some_and(|f| f.said) && figure.lines.len() == 1;
        is_rectangle(line, p.extent) || (painted && p.figure < 3 && is_ellipse(line, p.extent))
    }

    /// Finds areas that span the paper from side to side along its upper or lower edge.
    fn find_ground(&self, placed: &[Placed], paper: Option<Extent>, out: &mut [Vec<bool>]) {
        let Some(paper) = paper else { return };
        let inset = INSET * paper.size();
        let corner = |right: bool, top: bool| {
            let x = if right { paper.hi.x - inset.x } else { paper.lo.x + inset.x };
            DVec2::new(x, if top { paper.hi.y - inset.y } else { paper.lo.y + inset.y })
        };
        for p in placed {
            let figure = &self.figures[p.figure];
            let wide = p.extent.size().x >= LIMITS.across * paper.size().x;
            if figure.fill.is_none() || figure.lined || !wide || figure.lines.len() > 1 {
                continue;
            }
            let points = places(&figure.lines[p.line]);
            let fills = |top: bool| [false, true].iter().all(|r| geom::contains(&points, corner(*r, top)));
            if fills(false) || fills(true) {
                out[p.figure][p.line] = true;
            }
        }
    }

    /// Finds flat grey ellipses without an outline below all else.
    fn find_cast_shadow(&self, placed: &[Placed], out: &mut [Vec<bool>]) {
        let is_grey = |c: [u8; 3]| {
            let [low, high] = [c.iter().min(), c.iter().max()].map(|x| x.copied().unwrap_or_default());
            high - low <= CAST_SHADOW.grey
        };
        let seen = || placed.iter().filter(|p| !out[p.figure][p.line]);
        let first = seen().map(|p| p.figure).min();
        let is_seen_through =
            |p: &Placed| self.figures[p.figure].fill.is_some_and(|f| f.opacity < LIMITS.translucent);
        let is_below_all = |p: &Placed| Some(p.figure) == first || is_seen_through(p);
        let is_shadow = |p: &&Placed| {
            let figure = &self.figures[p.figure];
            let size = p.extent.size();
            let wide = if is_below_all(p) { CAST_SHADOW.wide_below_all } else { CAST_SHADOW.wide };
            !figure.lined
                && figure.lines.len() == 1
                && figure.fill.is_some_and(|f| f.color.is_none_or(is_grey))
                && size.x >= wide * size.y
                && is_ellipse(&figure.lines[p.line], p.extent)
        };
        let Some(drawn) = seen().filter(|p| !is_shadow(p)).map(|p| p.extent).reduce(Extent::with) else {
            return;
        };
        let is_low = |p: &&Placed| {
            let low = if is_below_all(p) { CAST_SHADOW.low_below_all } else { CAST_SHADOW.low };
            p.extent.middle().y < drawn.lo.y + low * drawn.size().y
        };
        let found: Vec<&Placed> = seen().filter(is_shadow).filter(is_low).collect();
        found.into_iter().for_each(|p| out[p.figure][p.line] = true);
    }

    /// Finds straight lines along an axis, as long as the drawing or the sheet, at even distances, and with them those
    /// across.
    fn find_ruling(&self, placed: &[Placed], out: &mut [Vec<bool>]) {
        let all = placed.iter().map(|p| p.extent).reduce(Extent::with);
        let Some(whole) = self.sheet.map(|(lo, hi)| Extent { lo, hi }).or(all) else { return };
        let mut ruled = false;
        let mut along: [Vec<(f64, &Placed)>; 2] = [Vec::new(), Vec::new()];
        for p in placed {
            let figure = &self.figures[p.figure];
            let line = &figure.lines[p.line];
            if !figure.lined && line.len() > 2 {
                continue;
            }
            let size = p.extent.size();
            for axis in [0, 1] {
                let thin = size[1 - axis] <= THIN * size[axis];
                let long = size[axis] >= 0.8 * whole.size()[axis];
                if thin && long && length_of(line) < 1.05 * size[axis] {
                    along[axis].push((p.extent.middle()[1 - axis], p));
                }
            }
        }
        for lines in &mut along {
            base::sort_by(lines, |a, b| a.0.total_cmp(&b.0));
            let mut gaps: Vec<f64> = lines.windows(2).map(|w| w[1].0 - w[0].0).collect();
            base::sort_numbers(&mut gaps);
            let Some(&usual) = gaps.get(gaps.len() / 2) else { continue };
            let even = gaps.iter().filter(|g| (**g - usual).abs() <= 0.15 * usual).count();
            ruled |= lines.len() >= LIMITS.ruled && usual > 0.0 && even * 10 >= gaps.len() * 7;
        }
        if ruled {
            along.iter().flatten().for_each(|(_, p)| out[p.figure][p.line] = true);
        }
    }

    /// Finds many equal dots in rows and columns.
    fn find_dots(&self, placed: &[Placed], out: &mut [Vec<bool>]) {
        let diagonal = self.diagonal();
        let small = |p: &&Placed| p.extent.size().max_element() <= LIMITS.dot * diagonal;
        let dots: Vec<&Placed> = placed.iter().filter(small).collect();
        let Some(first) = dots.first() else { return };
        let usual = first.extent.size().max_element();
        let alike =
            |p: &&&Placed| (p.extent.size().max_element() - usual).abs() <= 0.05 * usual + 1e-4 * diagonal;
        let dots: Vec<&&Placed> = dots.iter().filter(alike).collect();
        let levels = |axis: usize| {
            let mut at: Vec<f64> = dots.iter().map(|p| p.extent.middle()[axis]).collect();
            base::sort_numbers(&mut at);
            1 + at.windows(2).filter(|w| w[1] - w[0] > 2e-3 * diagonal).count()
        };
        let (columns, rows) = (levels(0), levels(1));
        if columns.min(rows) >= LIMITS.ruled && columns * rows * 2 <= dots.len() * 3 {
            dots.iter().for_each(|p| out[p.figure][p.line] = true);
        }
    }
}

/// Whether a closed line runs along the sides of its box, up to round corners and the tremble of a hand.
fn is_rectangle(line: &[InkSample], extent: Extent) -> bool {
    let size = extent.size();
    if size.min_element() <= 0.02 * size.max_element() {
        return false;
    }
    let near = 0.015 * size.max_element();
    let on_side = |p: DVec2| (p - extent.lo).min(extent.hi - p).min_element() <= near;
    let mut on = 0.0;
    for w in line.windows(2) {
        let middle = w[0].at.midpoint(w[1].at);
        if on_side(w[0].at) && on_side(w[1].at) && on_side(middle) {
            on += w[0].at.distance(w[1].at);
        }
    }
    let around = 2.0 * (size.x + size.y);
    let area = geom::signed_area(&places(line)).abs();
    on >= LIMITS.on_sides * around && area >= 0.85 * extent.area()
}

/// Whether a closed line is the ellipse in its box.
fn is_ellipse(line: &[InkSample], extent: Extent) -> bool {
    let half = extent.size() * 0.5;
    if half.min_element() <= 0.0 || line.len() < 12 {
        return false;
    }
    line.iter().all(|s| (((s.at - extent.middle()) / half).length() - 1.0).abs() < 0.01)
}
