//! A drawn outline of a trunk or a cactus to axes with half widths: the middle lines of its limbs.
//!
//! The outline is put on a grid; the base is its lowest opening; the trunk is the cheapest way, in the middle of
//! the body, from the base to its far end, and every part that no limb covers yet gets a limb of its own (the
//! idea of TEASAR, Sato et al. 2000, in two dimensions).

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use geom::{bounds, distance_to_polyline, polyline_length, resample, smooth_gaussian};
use glam::DVec2;

use crate::rings::Ring;
use crate::thresholds::ROUNDING;

/// Cells along the longer side of a body's box.
const CELLS: f64 = 80.0;
/// Most limbs of one body.
const MOST_LIMBS: usize = 24;
/// Points along a limb: this share of the drawing apart.
const LIMB_STEP: f64 = 0.012;
/// A drawn end lies this far from where its limb begins: lines across a foot sag.
const SLACK: f64 = 0.015;
/// A part that stands out by less than this factor of the body's half width there is a bump, not a limb.
const BUMP: f64 = 1.3;
/// A part that stands out by less than this share of the body's box is a bump, not a limb.
const BUMP_LEAST: f64 = 0.07;
/// An opening is wider than this number of cells: smaller ones are the steps of the grid (*geometry*).
const OPENING_CELLS: f64 = 3.0;
/// A limb ends in an opening nearer than this factor of its half width.
const ENDS_AT: f64 = 1.5;
/// One end of a limb lies in an opening nearer than this share of its half width.
const IN_OPENING: f64 = 0.8;
/// If a limb's end is farther away than its sides by this factor, the width was measured to the sides.
const SIDES_NEARER: f64 = 1.25;
/// The opening on which a body stands, in widths of the body; a level one may be wider.
const FOOT_WIDTH: core::ops::Range<f64> = 0.6..2.2;
/// The opening on which a body stands lies in this lowest share of its height.
const FOOT_LOW: f64 = 0.35;
/// The opening of a body that was left open above lies higher than this share of its height.
const TOP_HIGH: f64 = 0.75;
/// A body stands on a drawn line if the line runs along more than this share of its foot.
const FOOT_FILLED: f64 = 0.75;
/// Factor by which the middle of the foot may lie higher than its ends.
const SAGS: f64 = 2.5;
/// A body without such an opening stands on the lowest part of this share of its height.
const LOWEST: f64 = 0.05;

/// One limb of a body, base first.
#[derive(Clone, Debug)]
pub(crate) struct Limb {
    pub(crate) points: Vec<DVec2>,
    pub(crate) half_width: Vec<f64>,
    /// The limb that bears it, an earlier one.
    pub(crate) parent: Option<usize>,
    /// Its far end was drawn (a rounded arm) rather than left open (a trunk that runs into a crown).
    pub(crate) closed_end: bool,
}

/// Returns the outline of a line with its half width at each point: up its left side, and back.
pub(crate) fn ribbon(points: &[DVec2], half_width: &[f64]) -> Vec<DVec2> {
    let n = points.len();
    let side = |k: usize, s: f64| {
        let along = points[(k + 1).min(n - 1)] - points[k.saturating_sub(1)];
        points[k] + along.normalize_or(DVec2::Y).perp() * (s * half_width[k])
    };
    let left = (0..n).map(|k| side(k, 1.0));
    left.chain((0..n).rev().map(|k| side(k, -1.0))).collect()
}

/// Returns the limbs of a body, its trunk first; empty if the outline has no area.
///
/// `base`: where the body stands, if that is known (an arm of a cactus stands on the body).
pub(crate) fn limbs(ring: &Ring, base: Option<DVec2>) -> Vec<Limb> {
    let Some(mask) = Mask::new(&ring.points) else { return Vec::new() };
    let opened = base.is_none().then(|| mask.without_foot(ring)).flatten();
    // A limb that ends this low on a drawn foot is a corner of it.
    let corner =
        opened.as_ref().map(|_| mask.band(ring).map_or(f64::NEG_INFINITY, |(low, band)| low + SAGS * band));
    let ring = opened.as_ref().unwrap_or(ring);
    let base = base.unwrap_or_else(|| mask.base(ring));
    let Some(root) = mask.nearest_inside(base) else { return Vec::new() };
    let clearance = mask.clearance();
    let deepest = clearance.iter().copied().fold(0.5, f64::max);
    let way = mask.flood(root, |_| 1.0);
    let cheap = mask.flood(root, |c| {
        let narrow = (deepest / clearance[c].max(0.5)).min(30.0);
        narrow * narrow
    });
    let mut covered: Vec<Option<usize>> = vec![None; mask.inside.len()];
    // The corners of a flared foot or an open top are no limbs.
    let openings: Vec<(DVec2, DVec2)> = ring.gaps.iter().map(|&g| ring.gap(g)).collect();
    let mut limbs: Vec<Limb> = Vec::new();
    for _ in 0..MOST_LIMBS {
        let first = limbs.is_empty();
        // A trunk that was left open above ends in the middle of the opening.
        let top = if first { mask.top(ring, base) } else { None };
        let Some(far) = top.or_else(|| mask.farthest(root, &way, &covered, first)) else { break };
        let mut path = vec![far];
        let mut at = far;
        while at != root && covered[at].is_none() {
            at = cheap.from[at];
            path.push(at);
        }
        let parent = covered[at];
        // A bump of the outline is no limb: one stands out by more than the body's own half width there.
        let bump = !first
            && (way.cost[far] - way.cost[at] < (BUMP * clearance[at]).max(BUMP_LEAST * CELLS)
                || corner.is_some_and(|y| mask.middle(far).y < y)
                || openings.iter().any(|&(a, b)| {
                    let tip = mask.middle(far);
                    a.distance(tip).min(b.distance(tip)) < OPENING_CELLS * mask.cell
                        && limbs[0].wide_at(a.midpoint(b), mask.cell)
                }));
        let name = if bump { parent.unwrap_or(0) } else { limbs.len() };
        for &c in &path {
            mask.cover(&mut covered, c, BUMP * clearance[c] + 1.5, name);
        }
        if !bump {
            path.reverse();
            let line: Vec<DVec2> = path.iter().map(|&c| mask.middle(c)).collect();
            limbs.push(finish(ring, &mask, line, parent, first.then_some(base)));
        }
    }
    limbs
}

/// Turns a path of cells into a smooth line with half widths measured on the drawn lines.
fn finish(
    ring: &Ring,
    mask: &Mask,
    mut line: Vec<DVec2>,
    parent: Option<usize>,
    base: Option<DVec2>,
) -> Limb {
    let drawn = ring.drawn();
    let clear =
        |p: DVec2| drawn.iter().filter_map(|d| distance_to_polyline(d, p)).fold(f64::INFINITY, f64::min);
    if let (Some(base), Some(first)) = (base, line.first_mut()) {
        *first = base;
    }
    let last = line.last().copied().unwrap_or_default();
    let open = ring
        .gaps
        .iter()
        .map(|&g| ring.gap(g))
        .filter(|(a, b)| a.distance(*b) > OPENING_CELLS * mask.cell)
        .map(|(a, b)| a.midpoint(b))
        .filter(|m| m.distance(last) < ENDS_AT * clear(last).max(2.0 * mask.cell))
        .min_by(|a, b| a.distance(last).total_cmp(&b.distance(last)));
    if let Some(middle) = open {
        line.push(middle);
    }
    let even = resample(&line, mask.cell);
    let calm = smooth_gaussian(&even, 6, 36.0 * mask.cell * mask.cell);
    let calm = smooth_gaussian(&calm, 6, 36.0 * mask.cell * mask.cell);
    let points = resample(&calm, LIMB_STEP);
    let half_width = points.iter().map(|&p| clear(p)).collect();
    let mut limb = Limb { points, half_width, parent, closed_end: open.is_none() };
    limb.mend_widths();
    limb
}

impl Limb {
    /// Whether one of the limb's ends lies at `opening`.
    fn wide_at(&self, opening: DVec2, cell: f64) -> bool {
        let near = |p: Option<&DVec2>, w: Option<&f64>| {
            p.zip(w).is_some_and(|(p, w)| p.distance(opening) < IN_OPENING * w + OPENING_CELLS * cell)
        };
        near(self.points.first(), self.half_width.first()) || near(self.points.last(), self.half_width.last())
    }

    /// Corrects the widths at a drawn base line and at a drawn tip, where the nearest line is the end, not the side:
    /// the base goes on as wide as it is above, the tip is a dome.
    fn mend_widths(&mut self) {
        let total = polyline_length(&self.points);
        let at: Vec<f64> = (0..self.points.len()).map(|i| polyline_length(&self.points[..=i])).collect();
        let n = at.len();
        if n < 2 {
            self.half_width = vec![0.0; n];
            return;
        }
        // Until the sides are clearly nearer than the end is: the distance to the end itself grows as fast as the way.
        if let Some(i) = (0..n).find(|&i| at[i] > SIDES_NEARER * self.half_width[i] + SLACK) {
            let w = self.half_width[i].min(0.5 * total);
            self.half_width[..i].iter_mut().for_each(|h| *h = h.max(w));
        }
        if self.closed_end
            && let Some(i) =
                (0..n).rev().find(|&i| total - at[i] > SIDES_NEARER * self.half_width[i] + SLACK && i + 1 < n)
        {
            let radius = self.half_width[i];
            for (width, at) in self.half_width.iter_mut().zip(&at).skip(i + 1) {
                let below = (radius - (total - at)).max(0.0);
                *width = (radius * radius - below * below).max(0.0).sqrt();
            }
        }
    }
}

/// The inside of an outline on a grid.
#[derive(Debug)]
struct Mask {
    origin: DVec2,
    cell: f64,
    nx: usize,
    ny: usize,
    inside: Vec<bool>,
}

/// Ways from one cell to all others.
#[derive(Debug)]
struct Flood {
    cost: Vec<f64>,
    from: Vec<usize>,
}

#[derive(PartialEq)]
struct Reached(f64, usize);
impl Eq for Reached {}
impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "cell numbers are small and clamped"
)]
impl Mask {
    /// Fills by winding number, so a line that crosses itself encloses the areas that a person sees as enclosed.
    fn new(outline: &[DVec2]) -> Option<Self> {
        let (lo, hi) = bounds(outline)?;
        let cell = (hi - lo).max_element() / CELLS;
        if cell <= ROUNDING || outline.len() < 3 {
            return None;
        }
        // One empty cell all round.
        let origin = lo - DVec2::splat(1.5 * cell);
        let (nx, ny) = (((hi.x - origin.x) / cell) as usize + 3, ((hi.y - origin.y) / cell) as usize + 3);
        let mut inside = vec![false; nx * ny];
        let mut rows: Vec<Vec<(f64, i32)>> = vec![Vec::new(); ny];
        for (i, &a) in outline.iter().enumerate() {
            let b = outline[(i + 1) % outline.len()];
            let (low, high, sign) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
            let first = ((low.y - origin.y) / cell - 0.5).ceil().max(0.0) as usize;
            for (row, list) in rows.iter_mut().enumerate().skip(first) {
                let y = origin.y + (row as f64 + 0.5) * cell;
                if y >= high.y {
                    break;
                }
                if y >= low.y && high.y > low.y {
                    list.push((low.x + (high.x - low.x) * (y - low.y) / (high.y - low.y), sign));
                }
            }
        }
        for (row, list) in rows.iter_mut().enumerate() {
            base::sort_by(list, |a, b| a.0.total_cmp(&b.0));
            let mut winding = 0;
            for w in list.windows(2) {
                winding += w[0].1;
                if winding != 0 {
                    let a = ((w[0].0 - origin.x) / cell - 0.5).ceil().max(0.0) as usize;
                    let b = (((w[1].0 - origin.x) / cell - 0.5).floor().max(0.0) as usize).min(nx - 1);
                    (a..=b).for_each(|x| inside[row * nx + x] = true);
                }
            }
        }
        inside.contains(&true).then_some(Self { origin, cell, nx, ny, inside })
    }

    fn middle(&self, c: usize) -> DVec2 {
        self.origin + DVec2::new((c % self.nx) as f64 + 0.5, (c / self.nx) as f64 + 0.5) * self.cell
    }

    fn nearest_inside(&self, p: DVec2) -> Option<usize> {
        (0..self.inside.len()).filter(|&c| self.inside[c]).min_by(|&a, &b| {
            self.middle(a).distance_squared(p).total_cmp(&self.middle(b).distance_squared(p))
        })
    }

    /// Returns the place where the body stands: the middle of its lowest opening; without one, the middle of its
    /// lowest part.
    fn base(&self, ring: &Ring) -> DVec2 {
        let area = self.inside.iter().filter(|i| **i).count() as f64 * self.cell * self.cell;
        let width = 2.0 * area / polyline_length(&ring.points).max(1e-9);
        let (lo, hi) = bounds(&ring.points).unwrap_or_default();
        let opening = ring
            .gaps
            .iter()
            .map(|&g| ring.gap(g))
            .filter(|(a, b)| {
                let d = a.distance(*b);
                d > FOOT_WIDTH.start * width && (d < FOOT_WIDTH.end * width || (a.y - b.y).abs() < 0.5 * d)
            })
            .map(|(a, b)| a.midpoint(b))
            .filter(|m| m.y < lo.y + FOOT_LOW * (hi.y - lo.y))
            .min_by(|a, b| a.y.total_cmp(&b.y));
        opening.unwrap_or_else(|| {
            let low: Vec<DVec2> = (0..self.inside.len())
                .filter(|&c| self.inside[c])
                .map(|c| self.middle(c))
                .filter(|p| p.y < lo.y + LOWEST * (hi.y - lo.y) + self.cell)
                .collect();
            let x = low.iter().map(|p| p.x).sum::<f64>() / (low.len() as f64).max(1.0);
            if low.is_empty() { lo.midpoint(hi) } else { DVec2::new(x, lo.y) }
        })
    }

    /// Returns the lowest height of a body, and the height above it up to which its feet reach.
    fn band(&self, ring: &Ring) -> Option<(f64, f64)> {
        let (lo, hi) = bounds(&ring.points)?;
        Some((lo.y, (LOWEST * (hi.y - lo.y)).max(OPENING_CELLS * self.cell)))
    }

    /// Returns the outline of a body that stands on a drawn line, open all along that line: so a flared foot is as
    /// wide as it was drawn, and its corners are no roots. `None` for a body that is open below or stands on separate
    /// roots.
    fn without_foot(&self, ring: &Ring) -> Option<Ring> {
        let (lo, hi) = bounds(&ring.points)?;
        let (_, band) = self.band(ring)?;
        let low = |p: DVec2| p.y < lo.y + band;
        // It is open there already, however uneven its feet are.
        let open = |(a, b): (DVec2, DVec2)| {
            a.distance(b) > OPENING_CELLS * self.cell && a.midpoint(b).y < 0.5 * (lo.y + hi.y)
        };
        if ring.gaps.iter().map(|&g| ring.gap(g)).any(open) {
            return None;
        }
        let corners = (0..ring.points.len()).filter(|&k| low(ring.points[k]));
        let x = |k: &usize| ring.points[*k].x;
        let left = corners.clone().min_by(|a, b| x(a).total_cmp(&x(b)))?;
        let right = corners.max_by(|a, b| x(a).total_cmp(&x(b)))?;
        let (a, b) = (ring.points[left], ring.points[right]);
        let on_it = |c: &usize| {
            let p = self.middle(*c);
            p.y < lo.y + SAGS * band && p.x > a.x && p.x < b.x && self.inside[*c]
        };
        let stood: Vec<usize> = (0..self.inside.len()).filter(on_it).map(|c| c % self.nx).collect();
        let filled = base::set_of(stood).len() as f64;
        if b.x - a.x < OPENING_CELLS * self.cell || filled < FOOT_FILLED * (b.x - a.x) / self.cell {
            return None;
        }
        // The way over the top, from the right corner to the left one or in reverse.
        let n = ring.points.len();
        let way = |from: usize, to: usize| -> Vec<usize> {
            (0..=(to + n - from) % n).map(|k| (from + k) % n).collect()
        };
        let ways = [way(left, right), way(right, left)];
        let top = |w: &Vec<usize>| w.iter().map(|&k| ring.points[k].y).fold(f64::NEG_INFINITY, f64::max);
        let kept = if top(&ways[0]) > top(&ways[1]) { &ways[0] } else { &ways[1] };
        let mut gaps: Vec<usize> = (0..kept.len() - 1).filter(|&k| ring.gaps.contains(&kept[k])).collect();
        gaps.push(kept.len() - 1);
        let points = kept.iter().map(|&k| ring.points[k]).collect();
        Some(Ring { points, parts: ring.parts.clone(), gaps })
    }

    /// Returns the cell in the middle of a wide opening at the body's upper end.
    fn top(&self, ring: &Ring, base: DVec2) -> Option<usize> {
        let (lo, hi) = bounds(&ring.points)?;
        let height = hi.y - lo.y;
        let middle = ring
            .gaps
            .iter()
            .map(|&g| ring.gap(g))
            .filter(|(a, b)| a.distance(*b) > OPENING_CELLS * self.cell && a.distance(*b) < 0.5 * height)
            .map(|(a, b)| a.midpoint(b))
            .filter(|m| m.y > lo.y + TOP_HIGH * height && m.distance(base) > 0.5 * height)
            .max_by(|a, b| a.y.total_cmp(&b.y))?;
        self.nearest_inside(middle)
    }

    /// Returns the distance to the outside in cells (chamfer 1, sqrt 2: within 8 %).
    fn clearance(&self) -> Vec<f64> {
        let far = (self.nx + self.ny) as f64;
        let mut d: Vec<f64> = self.inside.iter().map(|&i| if i { far } else { 0.0 }).collect();
        let diagonal = core::f64::consts::SQRT_2;
        let nx = self.nx;
        for c in nx + 1..d.len() {
            if self.inside[c] {
                d[c] = d[c].min(d[c - 1] + 1.0).min(d[c - nx] + 1.0);
                d[c] = d[c].min(d[c - nx - 1] + diagonal).min(d[c - nx + 1] + diagonal);
            }
        }
        for c in (0..d.len() - nx - 1).rev() {
            if self.inside[c] {
                d[c] = d[c].min(d[c + 1] + 1.0).min(d[c + nx] + 1.0);
                d[c] = d[c].min(d[c + nx + 1] + diagonal).min(d[c + nx - 1] + diagonal);
            }
        }
        d
    }

    /// Finds shortest paths inside (Dijkstra); `weight` multiplies the length of a step into a cell.
    fn flood(&self, root: usize, weight: impl Fn(usize) -> f64) -> Flood {
        let mut flood =
            Flood { cost: vec![f64::INFINITY; self.inside.len()], from: vec![root; self.inside.len()] };
        flood.cost[root] = 0.0;
        let mut heap = BinaryHeap::from([Reverse(Reached(0.0, root))]);
        while let Some(Reverse(Reached(cost, c))) = heap.pop() {
            if cost > flood.cost[c] {
                continue;
            }
            // The outer cells are never inside, so every neighbour exists.
            for (step, length) in [
                (c - 1, 1.0),
                (c + 1, 1.0),
                (c - self.nx, 1.0),
                (c + self.nx, 1.0),
                (c - self.nx - 1, core::f64::consts::SQRT_2),
                (c - self.nx + 1, core::f64::consts::SQRT_2),
                (c + self.nx - 1, core::f64::consts::SQRT_2),
                (c + self.nx + 1, core::f64::consts::SQRT_2),
            ] {
                let next = cost + length * weight(step);
                if self.inside[step] && next < flood.cost[step] {
                    flood.cost[step] = next;
                    flood.from[step] = c;
                    heap.push(Reverse(Reached(next, step)));
                }
            }
        }
        flood
    }

    /// Returns the cell where the next limb ends: the highest end for the trunk, the farthest bare part for the
    /// others.
    fn farthest(&self, root: usize, way: &Flood, covered: &[Option<usize>], trunk: bool) -> Option<usize> {
        let base = self.middle(root);
        let score = |c: usize| {
            let p = self.middle(c);
            // If two ends are equally far away, the trunk takes the one above the base, an arm the other.
            if trunk {
                p.distance(base) + 0.8 * (p.y - base.y) - 0.4 * (p.x - base.x).abs()
            } else {
                way.cost[c]
            }
        };
        (0..self.inside.len())
            .filter(|&c| way.cost[c].is_finite() && covered[c].is_none())
            .max_by(|&a, &b| score(a).total_cmp(&score(b)).then(b.cmp(&a)))
    }

    fn cover(&self, covered: &mut [Option<usize>], c: usize, radius: f64, limb: usize) {
        let r = radius.ceil() as usize;
        let (cx, cy) = (c % self.nx, c / self.nx);
        for y in cy.saturating_sub(r)..=(cy + r).min(self.ny - 1) {
            for x in cx.saturating_sub(r)..=(cx + r).min(self.nx - 1) {
                let (dx, dy) = (x.abs_diff(cx) as f64, y.abs_diff(cy) as f64);
                let k = y * self.nx + x;
                if self.inside[k] && covered[k].is_none() && dx * dx + dy * dy <= radius * radius {
                    covered[k] = Some(limb);
                }
            }
        }
    }
}
