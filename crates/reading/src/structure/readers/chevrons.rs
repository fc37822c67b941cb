//! A conifer whose branches are lines that lead down from its trunk on both sides, longer from tier to tier.

use geom::{distance_to_polyline, polyline_length};
use glam::DVec2;
use ink::{Ink, InkStroke, StrokeClass};

use super::{LIMITS, Part, Proposal};
use crate::Kind;
use crate::thresholds::STRAIGHT;

/// Requirements of branches that make a conifer. Lengths are in ink units (the drawing's diagonal is 1).
struct ChevronLimits {
    /// Its trunk leads up by at least this share of its length.
    upright: f64,
    /// Its trunk is at least this long.
    trunk: f64,
    /// Fewest branches on each side.
    branches: usize,
    /// Branches begin this near to the trunk.
    near: f64,
    /// A branch leads down by at least the first and at most the second share of its length.
    steep: [f64; 2],
    /// A branch is at least this share of the length of the one above it on its side.
    tapering: f64,
    /// Branches on both sides differ in length by at most this share of the longer one.
    even: f64,
    /// Between tiers the crown keeps this share of its width.
    waist: f64,
    /// See [`Proposal::likelihood`].
    likelihood: f64,
}

const CHEVRON: ChevronLimits = ChevronLimits {
    upright: 0.96,
    trunk: 0.5,
    branches: 2,
    near: 0.06,
    steep: [0.25, 0.94],
    tapering: 0.85,
    even: 0.3,
    waist: 0.55,
    likelihood: 4000.0,
};

/// A branch from its foot on the trunk to its tip.
#[derive(Clone, Copy, Debug)]
struct Branch {
    foot: DVec2,
    tip: DVec2,
    stroke: usize,
}

impl Branch {
    fn length(&self) -> f64 {
        self.foot.distance(self.tip)
    }
}

pub(super) fn propose(ink: &Ink) -> Option<Proposal> {
    if ink.strokes.len() < 1 + CHEVRON.branches || ink.strokes.len() > LIMITS.most_strokes {
        return None;
    }
    let rise = |s: &InkStroke| (s.points[s.points.len() - 1].y - s.points[0].y).abs();
    let trunk =
        (0..ink.strokes.len()).max_by(|&a, &b| rise(&ink.strokes[a]).total_cmp(&rise(&ink.strokes[b])))?;
    let line = &ink.strokes[trunk];
    if rise(line) < CHEVRON.upright * line.length || line.length < CHEVRON.trunk {
        return None;
    }
    let mut sides = [Vec::new(), Vec::new()];
    for (row, stroke) in ink.strokes.iter().enumerate().filter(|(k, _)| *k != trunk) {
        for branch in branches(row, stroke, &line.points)? {
            sides[usize::from(branch.tip.x > branch.foot.x)].push(branch);
        }
    }
    for side in &mut sides {
        base::sort_by(side, |a, b| b.foot.y.total_cmp(&a.foot.y));
    }
    let [left, right] = &sides;
    if left.len() != right.len() || left.len() < CHEVRON.branches || !sides.iter().all(|s| is_tapering(s)) {
        return None;
    }
    let is_even = |(a, b): (&Branch, &Branch)| {
        (a.length() - b.length()).abs() < CHEVRON.even * a.length().max(b.length())
    };
    if !left.iter().zip(right).all(is_even) {
        return None;
    }
    let [a, b] = [line.points[0], line.points[line.points.len() - 1]];
    let apex = if a.y > b.y { a } else { b };
    let apex = DVec2::new(apex.x, apex.y.max(left[0].foot.y).max(right[0].foot.y));
    let mut outline = vec![apex];
    outline.extend(margin(left));
    outline.extend(margin(right).into_iter().rev());
    outline.push(apex);
    let rows: Vec<usize> = sides.iter().flatten().map(|b| b.stroke).collect();
    let crown = Part { points: outline, class: StrokeClass::Crown, root: None, strokes: unique(rows) };
    let wood =
        Part { points: line.points.clone(), class: StrokeClass::Axis, root: None, strokes: vec![trunk] };
    Some(Proposal {
        kind: Kind::Conifer,
        parts: vec![crown, wood],
        heads: Vec::new(),
        likelihood: CHEVRON.likelihood,
        word: None,
        is_of_pieces: true,
    })
}

/// Returns the branches of a stroke: one, or two that meet on the trunk; `None` if it is something else.
fn branches(row: usize, stroke: &InkStroke, trunk: &[DVec2]) -> Option<Vec<Branch>> {
    let points = &stroke.points;
    let off = |p: DVec2| distance_to_polyline(trunk, p).unwrap_or(f64::INFINITY);
    let foot = (0..points.len()).max_by(|&a, &b| points[a].y.total_cmp(&points[b].y))?;
    if off(points[foot]) > CHEVRON.near {
        return None;
    }
    let arms = [&points[..=foot], &points[foot..]];
    let arms: Vec<&[DVec2]> = arms.into_iter().filter(|arm| polyline_length(arm) > CHEVRON.near).collect();
    let branch = |arm: &&[DVec2]| {
        let (first, last) = (arm[0], arm[arm.len() - 1]);
        let tip = if first == points[foot] { last } else { first };
        let way = tip - points[foot];
        let down = -way.y / way.length().max(f64::MIN_POSITIVE);
        let is_straight = way.length() > STRAIGHT * polyline_length(arm);
        let is_branch = is_straight && (CHEVRON.steep[0]..CHEVRON.steep[1]).contains(&down);
        is_branch.then_some(Branch { foot: points[foot], tip, stroke: row })
    };
    let found: Option<Vec<Branch>> = arms.iter().map(branch).collect();
    found.filter(|all| !all.is_empty())
}

/// Whether branches, from the top down, do not get shorter.
fn is_tapering(side: &[Branch]) -> bool {
    side.windows(2).all(|w| w[1].length() > CHEVRON.tapering * w[0].length())
}

/// Returns the margin of a crown along the branches of one side, from the top down, with a waist below each tier but
/// the last.
fn margin(side: &[Branch]) -> Vec<DVec2> {
    let mut points = Vec::new();
    for (k, branch) in side.iter().enumerate() {
        points.push(branch.tip);
        if k + 1 < side.len() {
            points
                .push(DVec2::new(base::ops::lerp(branch.foot.x, branch.tip.x, CHEVRON.waist), branch.tip.y));
        }
    }
    points
}

/// Returns rows without repeats, in ascending order.
fn unique(mut rows: Vec<usize>) -> Vec<usize> {
    rows.sort_unstable();
    rows.dedup();
    rows
}
