//! Subjects: the strokes of each plant. A drawing of several plants is split before any stroke is judged.
//!
//! `clean strokes -> Subjects`
//!
//! Strokes that touch belong together, and so do petals all round one place, strokes above one another, enclosed
//! strokes, and strokes that are near relative to their size. Groups that stand next to one another on the ground, each
//! with something of its own, are several plants. Lines by themselves are not plants: they are grass, or belong to the
//! plant next to them. Distances are shares of the sizes of what they lie between, so neither the sheet nor the order
//! of drawing matters.

use crate::beds::{Bed, Stroke};
use geom::{Spoke, convex_hull, signed_area, wheels};
use glam::DVec2;

/// Most strokes of a drawing that is split: nobody draws a row of plants with more.
const MOST_STROKES: usize = 600;
/// Most groups of touching strokes in a drawing that is split.
const MOST_GROUPS: usize = 160;
/// Strokes nearer than this share of the drawing's height touch.
const TOUCH: f64 = 0.02;
/// A group stands on the ground if its foot is within this share of the drawing's height above the lowest point.
const LEVEL: f64 = 0.2;
/// A stroke whose hull covers this share of the square of its length is closed, too; a half circle has 0.16.
const FULL: f64 = 0.13;
/// [`FULL`] for an arch.
const ARCHED: f64 = 0.04;
/// A group in the air that is farther from all else than this share of its own size does not belong to it.
const CLEAR: f64 = 0.5;
/// A stroke is closed if its ends are nearer than this share of its length.
const CLOSED: f64 = 0.22;

/// The plants of a drawing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Subjects {
    /// Rows of [`Ink::strokes`](crate::Ink::strokes) of each plant, ascending; plants from left to right. Not empty
    /// where there are strokes.
    pub plants: Vec<Vec<usize>>,
    /// Rows of the ground that several plants stand on.
    pub ground: Vec<usize>,
    /// Rows of strokes that only follow another one all the way, each with the row of that one: they belong to no
    /// plant.
    pub again: Vec<(usize, usize)>,
}

impl Subjects {
    /// Makes one plant of all strokes.
    fn one(count: usize) -> Self {
        let all: Vec<usize> = (0..count).collect();
        Self { plants: if count > 0 { vec![all] } else { Vec::new() }, ..Self::default() }
    }

    /// Leaves out repeated strokes, in favour of the lines that they follow.
    pub(crate) fn without(mut self, again: Vec<(usize, usize)>) -> Self {
        let other = |row: &usize| again.binary_search_by_key(row, |a| a.0).is_err();
        self.plants.iter_mut().for_each(|rows| rows.retain(other));
        self.plants.retain(|rows| !rows.is_empty());
        self.ground.retain(other);
        self.again = again;
        self
    }

    /// Whether the drawing has to be split: it shows several plants, or lines that were drawn again.
    pub fn is_parted(&self) -> bool {
        self.plants.len() > 1 || !self.again.is_empty()
    }
}

/// Splits a drawing into its plants. Linear in points up to 600 strokes and 160 groups; beyond, it is one plant.
///
/// `strokes`: points and length of each.
pub(crate) fn subjects(strokes: &[(&[DVec2], f64)]) -> Subjects {
    let count = strokes.len();
    if !(2..=MOST_STROKES).contains(&count) {
        return Subjects::one(count);
    }
    let sheet = Sheet::new(strokes);
    let ground = sheet.grounds();
    let mut groups = sheet.touching(&ground);
    sheet.part_beds(&mut groups, &ground);
    if groups.len() < 2 || groups.len() > MOST_GROUPS {
        return Subjects::one(count);
    }
    sheet.gather(&mut groups);
    if groups.len() < 2 {
        return Subjects::one(count);
    }
    base::sort_by(&mut groups, |a, b| {
        (a.lo.x + a.hi.x).total_cmp(&(b.lo.x + b.hi.x)).then(a.strokes[0].cmp(&b.strokes[0]))
    });
    let plants = groups
        .into_iter()
        .map(|mut g| {
            g.strokes.sort_unstable();
            g.strokes
        })
        .collect();
    Subjects { plants, ground, ..Subjects::default() }
}

/// One stroke, measured.
struct Line {
    lo: DVec2,
    hi: DVec2,
    /// Every few points, including both ends.
    points: Vec<DVec2>,
    /// Whether it encloses an area by itself.
    closed: bool,
    /// Whether it is rather straight.
    straight: bool,
    /// Whether it is a thin upright blade, drawn as an outline.
    slender: bool,
    length: f64,
}

/// Strokes that belong together.
#[derive(Clone, Debug)]
struct Group {
    strokes: Vec<usize>,
    lo: DVec2,
    hi: DVec2,
    /// Whether it is one plant of a bed, which joins no other.
    of_bed: bool,
}

impl Group {
    fn height(&self) -> f64 {
        self.hi.y - self.lo.y
    }

    fn size(&self) -> f64 {
        self.lo.distance(self.hi)
    }
}

struct Sheet {
    lines: Vec<Line>,
    lo: DVec2,
    hi: DVec2,
}

impl Sheet {
    fn new(strokes: &[(&[DVec2], f64)]) -> Self {
        let lines: Vec<Line> = strokes.iter().map(|(points, length)| Line::new(points, *length)).collect();
        let (lo, hi) = lines
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), l| (lo.min(l.lo), hi.max(l.hi)));
        Self { lines, lo, hi }
    }

    fn height(&self) -> f64 {
        self.hi.y - self.lo.y
    }

    /// Returns the lines along the foot of the whole drawing.
    fn grounds(&self) -> Vec<usize> {
        let (wide, high) = (self.hi.x - self.lo.x, self.height());
        let flat = |l: &Line| {
            let (w, h) = (l.hi.x - l.lo.x, l.hi.y - l.lo.y);
            !l.closed && w > 0.5 * wide && h < 0.12 * w && l.lo.y.midpoint(l.hi.y) < self.lo.y + 0.3 * high
        };
        (0..self.lines.len()).filter(|&k| flat(&self.lines[k])).collect()
    }

    /// Splits groups in which several plants of a bed touch one another.
    fn part_beds(&self, groups: &mut Vec<Group>, ground: &[usize]) {
        let strokes = self.lines.iter().enumerate().map(|(k, l)| Stroke {
            points: &l.points,
            lo: l.lo,
            hi: l.hi,
            closed: l.closed,
            straight: l.straight,
            ground: ground.contains(&k),
        });
        let strokes: Vec<Stroke<'_>> = strokes.collect();
        let Some(bed) = Bed::find(&strokes, || self.wheels()) else { return };
        *groups = core::mem::take(groups)
            .into_iter()
            .flat_map(|group| {
                let (plants, of_bed) = bed.plants(&group.strokes);
                plants.into_iter().map(move |own| Group { of_bed, ..self.group(own) })
            })
            .collect();
    }

    /// Returns groups of strokes that touch one another.
    fn touching(&self, ground: &[usize]) -> Vec<Group> {
        let reach = TOUCH * self.height().max(0.05);
        let mut cells: Vec<((i64, i64), usize, DVec2)> = Vec::new();
        let key = |p: DVec2| {
            #[expect(clippy::cast_possible_truncation, reason = "ink lies within 0 and 1")]
            let cell = |v: f64| (v / reach).floor() as i64;
            (cell(p.x), cell(p.y))
        };
        for (k, line) in self.lines.iter().enumerate().filter(|(k, _)| !ground.contains(k)) {
            // Points of the stroke between two kept ones may touch.
            for w in line.points.windows(2) {
                let n = steps(w[0].distance(w[1]) / (0.7 * reach));
                cells.extend((0..n).map(|i| {
                    let p = w[0].lerp(w[1], f64::from(i) / f64::from(n));
                    (key(p), k, p)
                }));
            }
            cells.extend(line.points.last().map(|&p| (key(p), k, p)));
        }
        base::sort_by(&mut cells, |a, b| (a.0, a.1).cmp(&(b.0, b.1)));
        let mut sets = Sets::new(self.lines.len());
        let row = |cell: (i64, i64)| {
            let from = cells.partition_point(|c| c.0 < cell);
            cells[from..].iter().take_while(move |c| c.0 == cell)
        };
        for &((x, y), k, p) in &cells {
            for near in [(x, y), (x + 1, y - 1), (x + 1, y), (x + 1, y + 1), (x, y + 1)] {
                for &(_, j, q) in row(near) {
                    if sets.top(j) != sets.top(k) && p.distance(q) <= reach {
                        sets.join(j, k);
                    }
                }
            }
        }
        self.petals(&mut sets);
        let mut groups: base::LiteMap<usize, Vec<usize>> = base::LiteMap::new();
        for k in (0..self.lines.len()).filter(|k| !ground.contains(k)) {
            groups.entry(sets.top(k)).or_default().push(k);
        }
        groups.into_iter().map(|(_, strokes)| self.group(strokes)).collect()
    }

    /// Joins outlines that point away from one place all round it: petals, whether or not they touch.
    fn petals(&self, sets: &mut Sets) {
        for wheel in self.wheels() {
            wheel.windows(2).for_each(|pair| sets.join(pair[0], pair[1]));
        }
    }

    /// Returns outlines all round one place.
    fn wheels(&self) -> Vec<Vec<usize>> {
        let closed: Vec<usize> = (0..self.lines.len()).filter(|&k| self.lines[k].closed).collect();
        let spoke = |&k: &usize| {
            let line = &self.lines[k];
            let ends = line.points.first().zip(line.points.last()).map(|(a, b)| a.midpoint(*b));
            #[expect(clippy::cast_precision_loss, reason = "a few dozen points")]
            let middle = line.points.iter().sum::<DVec2>() / line.points.len().max(1) as f64;
            Spoke { gap: ends.unwrap_or(middle), middle, size: line.lo.distance(line.hi) }
        };
        let found = wheels(&closed.iter().map(spoke).collect::<Vec<_>>());
        found.into_iter().map(|wheel| wheel.spokes.into_iter().map(|k| closed[k]).collect()).collect()
    }

    fn group(&self, strokes: Vec<usize>) -> Group {
        let (lo, hi) = strokes.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &k| {
            (lo.min(self.lines[k].lo), hi.max(self.lines[k].hi))
        });
        Group { strokes, lo, hi, of_bed: false }
    }

    /// Joins groups that belong together, the nearest first.
    fn gather(&self, groups: &mut Vec<Group>) {
        let cost = |a: &Group, b: &Group| self.belongs(a, b).unwrap_or(f64::INFINITY);
        // Row a holds the cost of joining a with each earlier group.
        let mut costs: Vec<Vec<f64>> =
            (0..groups.len()).map(|a| (0..a).map(|b| cost(&groups[a], &groups[b])).collect()).collect();
        loop {
            let mut best: Option<(f64, usize, usize)> = None;
            for (a, row) in costs.iter().enumerate() {
                for (b, &c) in row.iter().enumerate() {
                    if c.is_finite() && best.is_none_or(|(least, ..)| c < least) {
                        best = Some((c, a, b));
                    }
                }
            }
            // The later group is merged into the earlier one.
            let Some((_, a, b)) = best else { break };
            let other = groups.remove(a);
            costs.remove(a);
            costs[a..].iter_mut().for_each(|row| {
                row.remove(a);
            });
            let strokes = [core::mem::take(&mut groups[b].strokes), other.strokes].concat();
            let of_bed = groups[b].of_bed || other.of_bed;
            groups[b] = Group { of_bed, ..self.group(strokes) };
            for k in 0..groups.len() {
                match k.cmp(&b) {
                    core::cmp::Ordering::Less => costs[b][k] = cost(&groups[b], &groups[k]),
                    core::cmp::Ordering::Greater => costs[k][b] = cost(&groups[k], &groups[b]),
                    core::cmp::Ordering::Equal => {}
                }
            }
        }
        self.tufts(groups);
    }

    /// Treats lines by themselves as grass: neighbours form one tuft, and where there is nothing else, all do.
    fn tufts(&self, groups: &mut Vec<Group>) {
        if groups.iter().all(|g| self.bare(g)) {
            let strokes = groups.iter().flat_map(|g| g.strokes.iter().copied()).collect();
            *groups = vec![self.group(strokes)];
            return;
        }
        base::sort_by(groups, |a, b| a.lo.x.total_cmp(&b.lo.x).then(a.strokes[0].cmp(&b.strokes[0])));
        let mut k = 1;
        while k < groups.len() {
            let (a, b) = (&groups[k - 1], &groups[k]);
            let near = b.lo.x - a.hi.x < 1.2 * a.height().max(b.height());
            if near && self.bare(a) && self.bare(b) {
                let strokes = [&*a.strokes, &*b.strokes].concat();
                groups[k - 1] = self.group(strokes);
                groups.remove(k);
            } else {
                k += 1;
            }
        }
    }

    /// Returns how far two groups are from being one plant; lower is surer, and `None` means two plants.
    fn belongs(&self, a: &Group, b: &Group) -> Option<f64> {
        let (small, large) = if a.size() < b.size() { (a, b) } else { (b, a) };
        let gap = self.gap(small, large, 0.5 * large.size())?;
        let (stand_a, stand_b) = (self.stands(small), self.stands(large));
        // Rows of a bed stand above one another.
        if a.of_bed && b.of_bed && !(stand_a && stand_b) {
            return None;
        }
        let over = overlap(small, large);
        let enclosed = inside(small, large);
        let bare = [self.bare(small), self.bare(large)];
        // Inside the other.
        if enclosed > 0.7 {
            return Some(0.2 * gap / small.size());
        }
        // A group in the air that is clearly apart, as the sun is.
        let clear = gap > CLEAR * small.size() && gap > 3.0 * TOUCH * self.height() && !stand_a;
        // Above one another.
        let apart = (small.lo.y - large.hi.y).max(large.lo.y - small.hi.y).max(0.0);
        let both = stand_a && stand_b;
        let near = apart < 0.35 * large.height().max(small.height());
        if over > 0.5 && !both && near && !(clear && !bare[0] && !bare[1]) {
            return Some(gap / small.height().max(large.height()));
        }
        // Next to each other on the ground, but one reaches into the other below the lower one's top.
        if both {
            let top = small.hi.y.min(large.hi.y);
            if self.overlap_below(small, large, top) > 0.4 {
                return Some(0.3 + gap / small.size());
            }
        }
        // A line with arms may be half of a cactus.
        let plain = |l: &Line| l.length < 1.6 * l.lo.distance(l.hi);
        let few = |g: &Group| g.strokes.len() <= 2 && g.strokes.iter().all(|&k| plain(&self.lines[k]));
        // Single lines are grass together, or belong to the plant next to them.
        match bare {
            [true, true] if gap < 0.8 * small.size() => return Some(0.1 + gap / small.size()),
            [true, false] if few(small) && gap < 0.3 * small.size() => return Some(0.4 + gap / small.size()),
            [false, true] if few(large) && gap < 0.15 * large.size() => {
                return Some(0.4 + gap / small.size());
            }
            // Limbs of one plant drawn in lines.
            [false, false] if self.lines_only(a) && self.lines_only(b) && gap < 0.35 * small.height() => {
                return Some(0.5 + gap / small.size());
            }
            _ => {}
        }
        // A group in the air belongs to the nearest one.
        if !stand_a && !clear && gap < 0.3 * large.size() {
            return Some(0.6 + gap / large.size());
        }
        if !stand_b && gap < 0.2 * large.size() {
            return Some(0.6 + gap / large.size());
        }
        // A small piece close by.
        (small.size() < 0.2 * large.size() && gap < 0.6 * small.size() && self.pieces(small) < 3)
            .then(|| 0.8 + gap / small.size())
    }

    fn pieces(&self, group: &Group) -> usize {
        group.strokes.len()
    }

    /// Whether it reaches down to the ground of the drawing.
    fn stands(&self, group: &Group) -> bool {
        group.lo.y < self.lo.y + LEVEL * self.height()
    }

    /// Whether nothing in it encloses an area.
    fn lines_only(&self, group: &Group) -> bool {
        group.strokes.iter().all(|&k| !self.lines[k].closed)
    }

    /// Whether it has nothing but single lines that stand next to one another, or one or two lines.
    fn bare(&self, group: &Group) -> bool {
        let lines = || group.strokes.iter().map(|&k| &self.lines[k]);
        let rooted = |l: &Line| (l.straight || l.slender) && l.lo.y < group.lo.y + 0.4 * group.height();
        (group.strokes.len() <= 2 && lines().all(|l| !l.closed))
            || lines().all(|l| rooted(l) && (!l.closed || l.slender))
    }

    /// Returns the least distance of two groups, if it is below `most`.
    fn gap(&self, a: &Group, b: &Group, most: f64) -> Option<f64> {
        let apart = (a.lo - b.hi).max(b.lo - a.hi).max(DVec2::ZERO).length();
        if apart > most {
            return None;
        }
        let mut least = f64::INFINITY;
        for &i in &a.strokes {
            for &j in &b.strokes {
                let (l, m) = (&self.lines[i], &self.lines[j]);
                let boxes = (l.lo - m.hi).max(m.lo - l.hi).max(DVec2::ZERO).length();
                if boxes >= least {
                    continue;
                }
                for p in &l.points {
                    for q in &m.points {
                        least = least.min(p.distance(*q));
                    }
                }
            }
        }
        (least <= most).then_some(least)
    }

    /// Returns the [`overlap`] below a height.
    fn overlap_below(&self, a: &Group, b: &Group, top: f64) -> f64 {
        let part = |g: &Group| {
            let points = g.strokes.iter().flat_map(|&k| &self.lines[k].points).filter(|p| p.y <= top);
            points.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, r), p| (l.min(p.x), r.max(p.x)))
        };
        let (a, b) = (part(a), part(b));
        shared(a, b)
    }
}

impl Line {
    fn new(drawn: &[DVec2], length: f64) -> Self {
        let stride = drawn.len().div_ceil(48).max(1);
        let mut points: Vec<DVec2> = drawn.iter().step_by(stride).copied().collect();
        points.extend(drawn.last());
        let (lo, hi) =
            drawn.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
        let ends = drawn[0].distance(drawn[drawn.len() - 1]);
        let hull = convex_hull(&points);
        let area = if hull.len() > 2 { signed_area(&hull) } else { 0.0 };
        let square = length * length;
        // The outline of a bush stands on both its ends.
        let (a, b) = (drawn[0], drawn[drawn.len() - 1]);
        let (wide, tall) = (hi.x - lo.x, hi.y - lo.y);
        let arch = a.y.max(b.y) < lo.y + 0.3 * tall && (a.x - b.x).abs() > 0.6 * tall.max(0.5 * wide);
        let full = area > FULL * square || (arch && area > ARCHED * square);
        let slender = tall > 1.5 * wide && area < 0.16 * lo.distance_squared(hi);
        let straight = ends > 0.8 * length;
        Self {
            lo,
            hi,
            points,
            straight,
            slender,
            length,
            closed: (ends < CLOSED * length || full) && area > 1e-9,
        }
    }
}

/// Returns the share of the narrower one's width that lies over or under the other.
fn overlap(a: &Group, b: &Group) -> f64 {
    shared((a.lo.x, a.hi.x), (b.lo.x, b.hi.x))
}

fn shared(a: (f64, f64), b: (f64, f64)) -> f64 {
    let least = (a.1 - a.0).min(b.1 - b.0);
    let common = a.1.min(b.1) - a.0.max(b.0);
    if least > 1e-6 { common / least } else { f64::from(u8::from(common >= 0.0)) }
}

/// Returns the share of the smaller box that lies in the larger one.
fn inside(small: &Group, large: &Group) -> f64 {
    let side = |a: (f64, f64), b: (f64, f64)| {
        let own = (a.1 - a.0).max(1e-6);
        ((a.1.min(b.1) - a.0.max(b.0)) / own).clamp(0.0, 1.0)
    };
    side((small.lo.x, small.hi.x), (large.lo.x, large.hi.x))
        * side((small.lo.y, small.hi.y), (large.lo.y, large.hi.y))
}

/// Sets of strokes that are joined one after another.
struct Sets(Vec<usize>);

impl Sets {
    fn new(n: usize) -> Self {
        Self((0..n).collect())
    }

    fn top(&mut self, mut k: usize) -> usize {
        while self.0[k] != k {
            self.0[k] = self.0[self.0[k]];
            k = self.0[k];
        }
        k
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.top(a), self.top(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
fn steps(x: f64) -> u32 {
    x.ceil().clamp(1.0, 1000.0) as u32
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use crate::{Drawing, clean};

    fn subjects(lines: &[Vec<DVec2>]) -> Vec<Vec<usize>> {
        clean(&Drawing::from_polylines("row", lines), &mut base::Report::default()).subjects.plants
    }

    fn line(a: (f64, f64), b: (f64, f64)) -> Vec<DVec2> {
        let (a, b) = (DVec2::from(a), DVec2::from(b));
        (0..=20).map(|i| a.lerp(b, f64::from(i) / 20.0)).collect()
    }

    fn ring(x: f64, y: f64, r: f64) -> Vec<DVec2> {
        (0..=40)
            .map(|i| base::ops::sin_cos(base::ops::TAU * f64::from(i) / 40.0))
            .map(|(s, c)| DVec2::new(x + r * c, y + r * s))
            .collect()
    }

    #[test]
    fn what_stands_beside_one_another_on_a_ground_is_several_plants() {
        let mut lines = vec![line((-1.0, 0.0), (9.0, 0.1))];
        for k in 0..4 {
            let x = 2.5 * f64::from(k);
            lines.extend([line((x, 0.0), (x, 2.0)), ring(x, 3.0, 0.9)]);
        }
        assert_eq!(subjects(&lines), [[1, 2], [3, 4], [5, 6], [7, 8]]);
        // In any order, and a crown that does not touch its trunk.
        lines.reverse();
        lines[0] = ring(7.5, 3.1, 0.9);
        assert_eq!(subjects(&lines), [[6, 7], [4, 5], [2, 3], [0, 1]]);
    }

    #[test]
    fn lines_alone_are_grass_and_a_crown_over_two_lines_is_one_tree() {
        let grass: Vec<Vec<DVec2>> =
            (0..9).map(|k| line((f64::from(k), 0.0), (f64::from(k) + 0.2, 1.5))).collect();
        assert_eq!(subjects(&grass).len(), 1);
        let tree = [line((-0.3, 0.0), (-0.3, 2.0)), line((0.3, 0.0), (0.3, 2.0)), ring(0.0, 3.2, 1.0)];
        assert_eq!(subjects(&tree).len(), 1);
    }

    #[test]
    fn any_number_of_strokes_anywhere() {
        let many: Vec<Vec<DVec2>> =
            (0..700).map(|k| ring(f64::from(k % 30), f64::from(k / 30), 0.3)).collect();
        for n in [0, 1, 2, 3, 100, 170, 700] {
            let found = subjects(&many[..n]);
            assert_eq!(found.iter().map(Vec::len).sum::<usize>(), n);
        }
        let alike = vec![line((0.0, 0.0), (1.0, 1.0)); 500];
        assert_eq!(subjects(&alike).len(), 1);
    }
}
