//! Shoots in needles or scales, too fine for outlines: where on the shoot's plane a needle is.
//!
//! `axes of a blade + Needles -> needles as tapered lines, in the cells of a grid -> which is seen at a place`

use base::{Draw, Seed, ops};
use glam::DVec2;
use plant::{Blade, Needles};

/// What is seen at a place of a shoot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SeenNeedle {
    /// The wood of an axis.
    Wood,
    Needle {
        /// From its middle line to its margin, -1 to 1.
        across: f64,
        /// From its foot to its tip, 0 to 1.
        along: f64,
        /// 0 to 1, its own.
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

/// The needles of a blade, to be found by place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NeedleMap {
    lines: Vec<Line>,
    low: DVec2,
    cell: f64,
    columns: usize,
    /// By cell: what may be seen in it, the lowest first.
    cells: Vec<Vec<u32>>,
}

/// Cells along the length of a shoot.
const CELLS: f64 = 96.0;
/// Half of an axis's thickness over a needle's width.
const AXIS: f64 = 0.75;

impl Line {
    fn at(&self, p: DVec2) -> Option<SeenNeedle> {
        let along = self.to - self.from;
        let t = (p - self.from).dot(along) / along.length_squared().max(1e-18);
        if !(-0.02..=1.0).contains(&t) {
            return None;
        }
        let off = along.perp_dot(p - self.from) / along.length().max(1e-9);
        // A needle is as wide to two thirds of its length, and then drawn to a point.
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
    /// Cost: linear in the needles.
    fn new(blade: &Blade, needles: &Needles) -> Self {
        let mut lines = Vec::new();
        for (row, axis) in core::iter::once(&blade.midrib).chain(&blade.veins).enumerate() {
            lay(needles, axis, row, blade.length(), &mut lines);
        }
        // What lies lower is behind: wood, then needles from the sides, then those in front.
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

    /// What is seen at a place of the plane.
    pub(crate) fn at(&self, p: DVec2) -> Option<SeenNeedle> {
        let q = (p - self.low) / self.cell;
        if !(q.is_finite() && q.x >= 0.0 && q.y >= 0.0 && q.x < self.columns as f64) {
            return None;
        }
        let cell = self
            .cells
            .get(ops::whole(q.y.floor()) as usize * self.columns + ops::whole(q.x.floor()) as usize)?;
        cell.iter().rev().find_map(|&i| self.lines[i as usize].at(p))
    }
}

/// The needles of one axis, and its wood.
fn lay(needles: &Needles, axis: &[DVec2], row: usize, unit: f64, out: &mut Vec<Line>) {
    // That of the blade ends where its last needles begin.
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
    // From the sides, and in two rows that lie more forward and hide the wood.
    for (layer, share, lean) in [(0_u64, 1.0, 1.0), (1, 0.82, 0.55), (2, 0.6, 0.25)] {
        let seed = Seed::new(row as u64).child(layer);
        let mut walked = 0.35 * spacing;
        let mut k = 0_u32;
        while walked < whole {
            let (from, way) = point(axis, walked);
            let chance = |n: u64| seed.child(8 * u64::from(k) + n).stream(Draw::Curl).uniform();
            let side = if (u64::from(k) + layer).is_multiple_of(2) { 1.0 } else { -1.0 };
            // Towards the tip needles are shorter and close up.
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

/// Takes so much off the end of a line.
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

/// The place so far along a line, and where it goes there.
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

/// Which places of a blade's plane are leaf.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cut {
    outline: geom::Inside,
    pub(crate) needles: Option<NeedleMap>,
}

impl Cut {
    pub(crate) fn new(blade: &Blade) -> Self {
        let needles = blade.needles.as_ref().map(|n| NeedleMap::new(blade, n));
        Self { outline: geom::Inside::of(&blade.outline), needles }
    }

    pub(crate) fn has(&self, p: DVec2) -> bool {
        match &self.needles {
            Some(map) => map.at(p).is_some(),
            None => self.outline.has(p),
        }
    }

    /// Whether it is between needles: there a card is a hole from near by, and closed from far away.
    pub(crate) fn between(&self, p: DVec2) -> bool {
        self.needles.is_some() && self.outline.has(p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plant::{Lift, Relief};

    fn shoot() -> Blade {
        Blade {
            outline: [(0.0, 0.0), (0.3, 0.3), (0.0, 1.0), (-0.3, 0.3)]
                .map(|(x, y)| DVec2::new(x, y))
                .to_vec(),
            midrib: vec![DVec2::ZERO, DVec2::Y],
            veins: vec![vec![DVec2::new(0.0, 0.3), DVec2::new(0.2, 0.6)]],
            needles: None,
            lift: Lift::Flat,
            relief: Relief::default(),
        }
    }

    /// `sketch` counts the shoots of a drawn conifer by what each covers.
    #[test]
    fn a_spruces_shoot_covers_a_fifth_of_the_square_of_its_length() {
        let cut = Cut::new(&Blade::shoot(Needles::of_length(0.075), 3, 1.0));
        let places = (-100..100).flat_map(|i| (0..200).map(move |j| (f64::from(i), f64::from(j))));
        let covered = places.filter(|&(x, y)| cut.has(DVec2::new(x + 0.5, y + 0.5) / 200.0)).count();
        let share = covered as f64 / 40_000.0;
        assert!((0.17..0.24).contains(&share), "{share}");
    }

    #[test]
    fn needles_stand_on_axes_reach_as_far_as_they_are_long_and_leave_sky() {
        let needles = Needles { length: 0.1, width: 0.012, spacing: 0.03, angle: 0.9 };
        let map = NeedleMap::new(&shoot(), &needles);
        assert!(map.at(DVec2::new(0.0, 0.01)).is_some(), "the foot of the axis is there");
        let (mut seen, mut all) = (0, 0);
        for i in -60..60 {
            for j in 0..120 {
                let p = DVec2::new(f64::from(i), f64::from(j)) / 120.0;
                let near = [shoot().midrib, shoot().veins[0].clone()]
                    .iter()
                    .filter_map(|axis| geom::distance_to_polyline(axis, p))
                    .fold(f64::INFINITY, f64::min);
                let here = map.at(p).is_some();
                assert!(!here || near < 0.115, "{p}: {near}");
                if near < 0.05 && p.y < 0.9 {
                    all += 1;
                    seen += i32::from(here);
                }
            }
        }
        let share = f64::from(seen) / f64::from(all);
        assert!((0.4..0.95).contains(&share), "{share} of what is near an axis is needle");
        assert!(map.at(DVec2::new(0.3, 0.05)).is_none() && map.at(DVec2::NAN).is_none());
    }

    #[test]
    fn a_blade_without_axes_has_no_needles() {
        let bare = Blade { midrib: vec![], veins: vec![], ..shoot() };
        let map = NeedleMap::new(&bare, &Needles { length: 0.1, width: 0.01, spacing: 0.03, angle: 0.9 });
        assert!(map.at(DVec2::new(0.0, 0.5)).is_none());
    }
}
