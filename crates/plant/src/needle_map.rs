//! Shoots in needles or scales, too fine for outlines: positions of the needles in the shoot's plane.
//!
//! `axes of a blade + Needles -> needles as tapered lines, in the cells of a grid -> visible needle, total cover`

use base::{Draw, Seed, ops};
use glam::DVec2;

use crate::{Blade, Needles};

/// Visible part of a shoot at a point of its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeenNeedle {
    /// The wood of an axis.
    Wood,
    /// A needle or a scale.
    Needle {
        /// Position from its middle line to its margin, -1 to 1.
        across: f64,
        /// Position from its foot to its tip, 0 to 1.
        along: f64,
        /// Shade of the individual needle, 0 to 1.
        shade: f64,
    },
}

/// A needle, or a piece of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    from: DVec2,
    to: DVec2,
    half: f64,
    shade: f64,
    wood: bool,
}

/// The needles of a blade that is a shoot, searchable by place: those that pictures of it show.
///
/// ```
/// use plant::{Blade, NeedleMap, Needles};
/// let shoot = Blade::shoot(Needles::with_length(0.1), 3, 1.0);
/// let map = NeedleMap::from_blade(&shoot).expect("needles");
/// assert!(map.covered() > 0.1 && map.covered() < 0.5);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct NeedleMap {
    lines: Vec<Line>,
    low: DVec2,
    cell: f64,
    columns: usize,
    /// For each cell the lines that may be visible in it, the lowest first.
    cells: Vec<Vec<u32>>,
}

/// Cells along the length of a shoot.
const CELLS: f64 = 96.0;
/// Sample points along the edge of a cell for the measured cover: within half a per cent of the result with ten times
/// as many.
const LOOKS: u32 = 3;
/// Half of an axis's thickness relative to a needle's width.
const AXIS: f64 = 0.75;

impl Line {
    fn seen_at(&self, p: DVec2) -> Option<SeenNeedle> {
        let along = self.to - self.from;
        let t = (p - self.from).dot(along) / along.length_squared().max(1e-18);
        if !(-0.02..=1.0).contains(&t) {
            return None;
        }
        let off = along.perp_dot(p - self.from) / along.length().max(1e-9);
        // A needle keeps its width for two thirds of its length, and then tapers to a point.
        let half = if self.wood { self.half } else { self.half * (1.0 - ops::smoothstep(0.55, 1.06, t)) };
        if off.abs() > half {
            return None;
        }
        Some(if self.wood {
            SeenNeedle::Wood
        } else {
            SeenNeedle::Needle { across: off / half, along: t.clamp(0.0, 1.0), shade: self.shade }
        })
    }
}

impl NeedleMap {
    /// Makes the map of a blade; `None` if it is not a shoot in needles. Cost: linear in the needles.
    pub fn from_blade(blade: &Blade) -> Option<Self> {
        blade.needles.as_ref().map(|needles| Self::new(blade, needles))
    }

    fn new(blade: &Blade, needles: &Needles) -> Self {
        let mut lines = Vec::new();
        for (row, axis) in blade.lines().enumerate() {
            lay(needles, axis, row, blade.length(), &mut lines);
        }
        // Lower lines are behind: wood, then needles from the sides, then those in front.
        let corners = || lines.iter().flat_map(|l| [l.from, l.to]);
        let low = corners().fold(DVec2::INFINITY, DVec2::min) - 1e-3;
        let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max) + 1e-3;
        let sound = low.is_finite() && high.is_finite() && blade.length() > 0.0;
        let cell = if sound { blade.length() / CELLS } else { 1.0 };
        let count = |x: f64| ops::whole((x / cell).clamp(0.0, 1e3).floor()) as usize;
        let (columns, rows) =
            if sound { (count(high.x - low.x) + 1, count(high.y - low.y) + 1) } else { (0, 0) };
        let mut cells = vec![Vec::new(); columns * rows];
        for (line, index) in lines.iter().zip(0_u32..).filter(|_| sound) {
            let (a, b) = (line.from.min(line.to) - line.half - low, line.from.max(line.to) + line.half - low);
            for row in count(a.y)..=count(b.y).min(rows - 1) {
                for column in count(a.x)..=count(b.x).min(columns - 1) {
                    cells[row * columns + column].push(index);
                }
            }
        }
        Self { lines, low, cell, columns, cells }
    }

    /// Returns the visible part at a point of the plane.
    pub fn seen_at(&self, p: DVec2) -> Option<SeenNeedle> {
        let q = (p - self.low) / self.cell;
        if !(q.is_finite() && q.x >= 0.0 && q.y >= 0.0 && q.x < self.columns as f64) {
            return None;
        }
        let cell = self
            .cells
            .get(ops::whole(q.y.floor()) as usize * self.columns + ops::whole(q.x.floor()) as usize)?;
        cell.iter().rev().find_map(|&i| self.lines[i as usize].seen_at(p))
    }

    /// Returns the area of the plane that needles or scales cover, in the square of the blade's unit: wood does not
    /// count, and overlaps count once. Cost: some milliseconds.
    pub fn covered(&self) -> f64 {
        let step = self.cell / f64::from(LOOKS);
        let mut seen = 0_u32;
        for (k, _) in self.cells.iter().enumerate().filter(|(_, lines)| !lines.is_empty()) {
            let corner =
                self.low + DVec2::new((k % self.columns) as f64, (k / self.columns) as f64) * self.cell;
            for (i, j) in (0..LOOKS).flat_map(|i| (0..LOOKS).map(move |j| (i, j))) {
                let p = corner + DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) * step;
                seen += u32::from(matches!(self.seen_at(p), Some(SeenNeedle::Needle { .. })));
            }
        }
        f64::from(seen) * step * step
    }
}

/// Lays out the needles of one axis, and its wood.
fn lay(needles: &Needles, axis: &[DVec2], row: usize, unit: f64, out: &mut Vec<Line>) {
    // The wood of the blade ends where its last needles begin.
    let mut axis = axis.to_vec();
    if row == 0 {
        shorten(&mut axis, 0.9 * needles.length * unit);
    }
    let axis = &axis[..];
    let whole: f64 = axis.windows(2).map(|w| w[0].distance(w[1])).sum();
    let half = 0.5 * needles.width * unit;
    let spacing = (needles.spacing * unit).max(whole / 400.0);
    if !(whole > 0.0 && spacing > 0.0) {
        return;
    }
    out.extend(axis.windows(2).map(|w| Line {
        from: w[0],
        to: w[1],
        half: half * AXIS,
        shade: 0.5,
        wood: true,
    }));
    // From the sides, and in two rows that lean more forward and hide the wood.
    for (layer, share, lean) in [(0_u64, 1.0, 1.0), (1, 0.82, 0.55), (2, 0.6, 0.25)] {
        let seed = Seed::new(row as u64).child(layer);
        let mut walked = 0.35 * spacing;
        let mut k = 0_u32;
        while walked < whole {
            let (from, way) = point(axis, walked);
            let chance = |n: u64| seed.child(8 * u64::from(k) + n).stream(Draw::Curl).uniform();
            let side = if (u64::from(k) + layer).is_multiple_of(2) { 1.0 } else { -1.0 };
            // Towards the tip needles become shorter and denser.
            let close =
                ops::smoothstep(1.0 - 1.2 * needles.length * unit / whole.max(1e-9), 1.0, walked / whole);
            let turn = side * needles.angle * lean * (0.85 + 0.3 * chance(1)) * (1.0 - 0.6 * close);
            let (s, c) = ops::sin_cos(turn);
            let to = DVec2::new(way.x * c + way.y * s, way.y * c - way.x * s);
            let length = needles.length * unit * share * (0.85 + 0.25 * chance(2)) * (1.0 - 0.35 * close);
            out.push(Line { from, to: from + to * length, half, shade: chance(3), wood: false });
            walked += 0.5 * spacing * (0.85 + 0.3 * chance(4));
            k += 1;
        }
    }
}

/// Shortens a line at its end by a length.
fn shorten(line: &mut Vec<DVec2>, mut by: f64) {
    while let [.., a, b] = line[..] {
        let d = a.distance(b);
        line.pop();
        if d > by {
            line.push(b.lerp(a, by / d));
            return;
        }
        by -= d;
    }
}

/// Returns the point at a distance along a line, and the direction there.
fn point(line: &[DVec2], mut walked: f64) -> (DVec2, DVec2) {
    for w in line.windows(2) {
        let d = w[0].distance(w[1]);
        if walked <= d && d > 0.0 {
            return (w[0].lerp(w[1], walked / d), (w[1] - w[0]) / d);
        }
        walked -= d;
    }
    let end = line.last().copied().unwrap_or(DVec2::ZERO);
    (end, DVec2::Y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lift, Relief};

    fn shoot() -> Blade {
        Blade {
            outline: [(0.0, 0.0), (0.3, 0.3), (0.0, 1.0), (-0.3, 0.3)]
                .map(|(x, y)| DVec2::new(x, y))
                .to_vec(),
            midrib: vec![DVec2::ZERO, DVec2::Y],
            veins: vec![vec![DVec2::new(0.0, 0.3), DVec2::new(0.2, 0.6)].into()],
            needles: None,
            lift: Lift::Flat,
            relief: Relief::default(),
        }
    }

    #[test]
    fn what_needles_cover_is_their_own_area_where_they_stand_free() {
        // One needle of each layer, 0.7 up a bare axis, of constant width for two thirds and then tapering to a point.
        let needles = Needles { length: 0.2, width: 0.02, spacing: 2.0, angle: 0.9 };
        let bare = Blade { veins: vec![], ..shoot() };
        let map = NeedleMap::new(&bare, &needles);
        let free = map.lines.iter().filter(|l| !l.wood).map(|l| l.from.distance(l.to)).sum::<f64>();
        let taper =
            (0..1000).map(|k| 1.0 - ops::smoothstep(0.55, 1.06, (f64::from(k) + 0.5) / 1000.0)).sum::<f64>();
        let area = free * needles.width * taper / 1000.0;
        assert_eq!(map.lines.iter().filter(|l| !l.wood).count(), 3);
        // Their feet share a corner of a needle's width.
        assert!((0.8..1.0).contains(&(map.covered() / area)), "{} of {area}", map.covered());
    }

    #[test]
    fn what_is_covered_is_within_a_per_cent_of_a_finer_look_and_scales_cover_more_of_their_outline() {
        let share = |length: f64, shoots: u32| {
            let blade = Blade::shoot(Needles::with_length(length), shoots, 1.0);
            let map = NeedleMap::from_blade(&blade).expect("needles");
            let places = (-600..600).flat_map(|i| (0..1200).map(move |j| (f64::from(i), f64::from(j))));
            let at = |(x, y): (f64, f64)| map.seen_at(DVec2::new(x + 0.5, y + 0.5) / 1200.0);
            let seen = places.filter(|&p| matches!(at(p), Some(SeenNeedle::Needle { .. }))).count();
            let fine = seen as f64 / (1200.0 * 1200.0);
            assert!((map.covered() / fine - 1.0).abs() < 0.01, "{length}: {} {fine}", map.covered());
            map.covered() / geom::signed_area(&blade.outline).abs()
        };
        let (needles, scales) = (share(0.075, 3), share(0.016, 8));
        assert!(needles > 0.2 && needles < 0.9 && scales > 0.2 && scales < 0.9, "{needles} {scales}");
    }

    #[test]
    fn needles_stand_on_axes_reach_as_far_as_they_are_long_and_leave_sky() {
        let needles = Needles { length: 0.1, width: 0.012, spacing: 0.03, angle: 0.9 };
        let map = NeedleMap::new(&shoot(), &needles);
        assert!(map.seen_at(DVec2::new(0.0, 0.01)).is_some(), "the foot of the axis is there");
        let (mut seen, mut all) = (0, 0);
        for i in -60..60 {
            for j in 0..120 {
                let p = DVec2::new(f64::from(i), f64::from(j)) / 120.0;
                let near = shoot()
                    .lines()
                    .filter_map(|axis| geom::distance_to_polyline(axis, p))
                    .fold(f64::INFINITY, f64::min);
                let here = map.seen_at(p).is_some();
                assert!(!here || near < 0.115, "{p}: {near}");
                if near < 0.05 && p.y < 0.9 {
                    all += 1;
                    seen += i32::from(here);
                }
            }
        }
        let share = f64::from(seen) / f64::from(all);
        assert!((0.4..0.95).contains(&share), "{share} of what is near an axis is needle");
        assert!(map.seen_at(DVec2::new(0.3, 0.05)).is_none() && map.seen_at(DVec2::NAN).is_none());
    }

    #[test]
    fn a_blade_without_axes_has_no_needles() {
        let bare = Blade { midrib: vec![], veins: vec![], ..shoot() };
        let map = NeedleMap::new(&bare, &Needles { length: 0.1, width: 0.01, spacing: 0.03, angle: 0.9 });
        assert!(map.seen_at(DVec2::new(0.0, 0.5)).is_none() && map.covered() <= 0.0);
    }
}
