//! Stems, branches and trunks that were drawn by both their sides: two lines that run side by side become one.

use geom::{bounds, closest_on_polyline, polyline_length};
use glam::DVec2;
use ink::{Ink, StrokeMode};

use super::sheet::{Form, Sheet};

/// Limits of two lines that are the sides of one axis. Lengths are in ink units (the drawing's diagonal is 1).
struct TubeLimits {
    /// Sides are nearer than this to one another,
    apart: f64,
    /// and run side by side over more than this share of the shorter one,
    along: f64,
    /// and over this factor of their distance.
    slender: f64,
    /// Their distance is nowhere less than this share of the greatest: a leaf narrows to its tip.
    narrow: f64,
    /// A third line within this factor of the distance makes them hatching, veins or a bundle.
    third: f64,
    /// Its ends are farther apart than this share of its length: half a circle has 0.64.
    straight: f64,
    /// Least length of the shorter side.
    length: f64,
    /// Fewest places of a line that are looked at.
    places: usize,
    /// Number of lines of a bundle that is the stem of sheaths or fibres: a banana, an old trunk.
    sheaths: core::ops::RangeInclusive<usize>,
    /// Each line of such a bundle is longer than this.
    sheath: f64,
}

const LIMITS: TubeLimits = TubeLimits {
    apart: 0.09,
    along: 0.7,
    slender: 3.5,
    narrow: 0.3,
    third: 1.6,
    straight: 0.6,
    length: 0.06,
    places: 12,
    sheaths: 3..=6,
    sheath: 0.25,
};

/// An axis between two lines.
#[derive(Clone, Debug)]
pub(crate) struct Tube {
    /// Rows of its sides.
    pub(crate) sides: [usize; 2],
    /// The line in the middle between them.
    pub(crate) middle: Vec<DVec2>,
    /// Mean distance between the sides.
    pub(crate) width: f64,
    /// Rows of lines between them, for a bundle.
    pub(crate) between: Vec<usize>,
}

impl Tube {
    /// Whether a line is a side of it, or lies between its sides.
    pub(crate) fn has(&self, row: usize) -> bool {
        self.sides.contains(&row) || self.between.contains(&row)
    }

    /// Whether two lines are its sides.
    fn joins(&self, one: usize, other: usize) -> bool {
        self.sides.contains(&one) && self.sides.contains(&other)
    }

    /// Whether a line belongs to both.
    fn meets(&self, other: &Self) -> bool {
        other.rows().iter().any(|&row| self.has(row))
    }

    /// Returns the rows of all its lines.
    pub(crate) fn rows(&self) -> Vec<usize> {
        self.sides.iter().chain(&self.between).copied().collect()
    }
}

/// Finds all pairs of sides. Cost: pairs of lines that are near, their points each.
pub(crate) fn tubes(ink: &Ink, sheet: &Sheet) -> Vec<Tube> {
    let lines: Vec<usize> = (0..ink.strokes.len())
        .filter(|&k| {
            let facts = &sheet.facts[k];
            facts.form == Form::Line && facts.holder.is_none() && ink.strokes[k].mode == StrokeMode::Parts
        })
        .filter(|&k| ink.strokes[k].length > LIMITS.length)
        .collect();
    let mut found: Vec<Tube> = Vec::new();
    for (i, &a) in lines.iter().enumerate() {
        for &b in &lines[i + 1..] {
            found.extend(tube(ink, a, b));
        }
    }
    // Lines with several partners are hatching or a bundle.
    let partners = |k: usize, near: f64| {
        found.iter().filter(|t| t.sides.contains(&k) && t.width < LIMITS.third * near).count()
    };
    let alone = found.iter().filter(|t| t.sides.iter().all(|&k| partners(k, t.width) == 1)).cloned();
    let mut kept: Vec<Tube> = alone.collect();
    let bundles = bundles(ink, &found).into_iter().filter(|b| !kept.iter().any(|tube| tube.meets(b)));
    let bundles: Vec<Tube> = bundles.collect();
    kept.extend(bundles);
    kept
}

/// Joins lines side by side of which each pair is near into one axis between the outer two. Among bundles with a line
/// in common, keeps that of most lines.
fn bundles(ink: &Ink, pairs: &[Tube]) -> Vec<Tube> {
    let mut lines: Vec<usize> = pairs.iter().flat_map(|t| t.sides).collect();
    lines.sort_unstable();
    lines.dedup();
    let mut found: Vec<Tube> = pairs.iter().filter_map(|widest| bundle(ink, pairs, &lines, widest)).collect();
    base::sort_by(&mut found, |a, b| b.between.len().cmp(&a.between.len()).then(a.sides.cmp(&b.sides)));
    let mut kept: Vec<Tube> = Vec::new();
    for tube in found {
        if !kept.iter().any(|other| other.meets(&tube)) {
            kept.push(tube);
        }
    }
    kept
}

/// Returns a pair with the lines that are near to both its sides, if they all lie between these and are long.
fn bundle(ink: &Ink, pairs: &[Tube], lines: &[usize], widest: &Tube) -> Option<Tube> {
    let width = |one: usize, other: usize| pairs.iter().find(|t| t.joins(one, other)).map(|t| t.width);
    let [a, b] = widest.sides;
    let is_near = |k: &usize| *k != a && *k != b && width(*k, a).is_some() && width(*k, b).is_some();
    let between: Vec<usize> = lines.iter().copied().filter(is_near).collect();
    let is_nearer = |k: usize, side: usize| width(k, side).is_some_and(|w| w < widest.width);
    let are_between = between.iter().all(|&k| is_nearer(k, a) && is_nearer(k, b));
    let tube = Tube { between, ..widest.clone() };
    let rows = tube.rows();
    let are_long = rows.iter().all(|&k| ink.strokes[k].length > LIMITS.sheath);
    (are_between && are_long && LIMITS.sheaths.contains(&rows.len())).then_some(tube)
}

/// Returns two lines as the sides of one axis, if they run side by side.
fn tube(ink: &Ink, a: usize, b: usize) -> Option<Tube> {
    let (one, other) = (&ink.strokes[a], &ink.strokes[b]);
    let (short, long) = if one.length < other.length { (one, other) } else { (other, one) };
    let (low, high) = bounds(&short.points)?;
    let (from, to) = bounds(&long.points)?;
    if (low - LIMITS.apart).cmpgt(to).any() || (high + LIMITS.apart).cmplt(from).any() {
        return None;
    }
    let step = (short.points.len() / (3 * LIMITS.places)).max(1);
    let mut pairs: Vec<(DVec2, DVec2)> = Vec::new();
    let mut places = 0_usize;
    let last = long.points.len() - 1;
    for (i, &p) in short.points.iter().enumerate() {
        if i % step != 0 && i + 1 != short.points.len() {
            continue;
        }
        places += 1;
        let q = closest_on_polyline(&long.points, p)?.point;
        let is_end = q.distance(long.points[0]) < long.step || q.distance(long.points[last]) < long.step;
        if p.distance(q) < LIMITS.apart && !is_end {
            pairs.push((p, q));
        }
    }
    if places < LIMITS.places || (pairs.len() as f64) < LIMITS.along * places as f64 {
        return None;
    }
    let widths = || pairs.iter().map(|(p, q)| p.distance(*q));
    let width = widths().sum::<f64>() / pairs.len() as f64;
    let (least, most) = widths().fold((f64::INFINITY, 0.0_f64), |(l, m), w| (l.min(w), m.max(w)));
    let middle: Vec<DVec2> = pairs.iter().map(|(p, q)| p.midpoint(*q)).collect();
    let length = polyline_length(&middle);
    // The line between them leads on: it does not run to and fro.
    let reach = middle[0].distance(middle[middle.len() - 1]);
    let leads_on = reach > LIMITS.straight * length;
    let long_enough = length > LIMITS.slender * width;
    (least > LIMITS.narrow * most && long_enough && leads_on).then_some(Tube {
        sides: [a, b],
        middle,
        width,
        between: Vec::new(),
    })
}
