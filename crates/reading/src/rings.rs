//! Joins open strokes into closed outlines: two lines are a trunk, an arc and a line are a crown.

use geom::polyline_length;
use glam::DVec2;

/// Nobody draws one outline with more strokes than this; beyond, every stroke closes on itself (keeps it linear).
const MOST_PARTS: usize = 64;
/// Two strokes are joined over a gap of at most this share of the shorter one. Flared trunks reach 1.2.
const WIDEST_JOIN: f64 = 1.3;

/// An end this near to a line lies on it, as a share of the drawing's diagonal.
const TOUCHES: f64 = 0.03;
/// The side of a line is the line without the first and the last of this number of parts.
const SIDE_BEGINS: usize = 10;

/// A closed outline made of one or more strokes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ring {
    /// In order round the outline; the last point is joined to the first.
    pub(crate) points: Vec<DVec2>,
    /// The strokes in it, as numbers of the caller's list, ascending.
    pub(crate) parts: Vec<usize>,
    /// Segments that were not drawn: from `points[i]` to the next point.
    pub(crate) gaps: Vec<usize>,
}

impl Ring {
    /// Returns both ends of a gap.
    pub(crate) fn gap(&self, i: usize) -> (DVec2, DVec2) {
        (self.points[i], self.points[(i + 1) % self.points.len()])
    }

    /// Returns the drawn lines: the outline without its gaps.
    pub(crate) fn drawn(&self) -> Vec<&[DVec2]> {
        let mut lines = Vec::new();
        let mut start = 0;
        for &g in &self.gaps {
            lines.push(&self.points[start..=g]);
            start = g + 1;
        }
        if start < self.points.len() {
            lines.push(&self.points[start..]);
        }
        lines
    }
}

/// Joins strokes whose ends lie nearer to one another than to their own other ends.
///
/// Greedy, nearest ends first; every stroke is in exactly one ring.
pub(crate) fn rings(strokes: &[&[DVec2]]) -> Vec<Ring> {
    let mate = if strokes.len() > MOST_PARTS { own(strokes.len()) } else { match_ends(strokes) };
    let mut used = vec![false; strokes.len()];
    let mut out = Vec::new();
    for k in 0..strokes.len() {
        if !used[k] {
            out.push(walk(strokes, &mate, k, &mut used));
        }
    }
    out
}

/// Joins strokes as [`rings`] does, but keeps strokes that begin and end on the side of another one as rings of their
/// own: arms on a body.
pub(crate) fn rings_and_arms(strokes: &[&[DVec2]]) -> Vec<Ring> {
    let few = strokes.len() <= MOST_PARTS;
    let (arms, rest): (Vec<usize>, Vec<usize>) = (0..strokes.len()).partition(|&k| few && is_arm(strokes, k));
    let mut found = Vec::new();
    for group in core::iter::once(rest).chain(arms.into_iter().map(|k| vec![k])) {
        let own: Vec<&[DVec2]> = group.iter().map(|&k| strokes[k]).collect();
        found.extend(rings(&own).into_iter().map(|mut ring| {
            ring.parts.iter_mut().for_each(|p| *p = group[*p]);
            ring
        }));
    }
    found
}

/// Whether both ends of a stroke lie on the side of the same longer one.
fn is_arm(strokes: &[&[DVec2]], k: usize) -> bool {
    let (Some(&a), Some(&b)) = (strokes[k].first(), strokes[k].last()) else { return false };
    let length = polyline_length(strokes[k]);
    let touches = |side: &[DVec2], p: DVec2| side.iter().any(|q| q.distance(p) < TOUCHES);
    let bears = |s: &&[DVec2]| {
        let cut = s.len() / SIDE_BEGINS;
        let side = &s[cut..s.len() - cut];
        polyline_length(s) > length && touches(side, a) && touches(side, b)
    };
    let mut others = strokes.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, s)| s);
    others.any(bears)
}

/// Matches each stroke's ends with one another.
fn own(n: usize) -> Vec<usize> {
    (0..2 * n).map(|e| e ^ 1).collect()
}

/// Matches ends with ends. End `2 k` is the first point of stroke k, `2 k + 1` its last.
fn match_ends(strokes: &[&[DVec2]]) -> Vec<usize> {
    let end = |e: usize| {
        let s = strokes[e / 2];
        if e.is_multiple_of(2) { s.first() } else { s.last() }.copied().unwrap_or(DVec2::ZERO)
    };
    let length: Vec<f64> = strokes.iter().map(|s| polyline_length(s)).collect();
    let n = 2 * strokes.len();
    let mut pairs: Vec<(f64, usize, usize)> = (0..n)
        .flat_map(|a| (a + 1..n).map(move |b| (a, b)))
        .map(|(a, b)| (end(a).distance(end(b)), a, b))
        .collect();
    base::sort_by(&mut pairs, |x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    let mut mate: Vec<Option<usize>> = vec![None; n];
    // The chain that each stroke belongs to, named by its lowest stroke.
    let mut chain: Vec<usize> = (0..strokes.len()).collect();
    for (d, a, b) in pairs {
        if mate[a].is_some() || mate[b].is_some() {
            continue;
        }
        let (ca, cb) = (chain[a / 2], chain[b / 2]);
        if ca == cb || d <= WIDEST_JOIN * length[a / 2].min(length[b / 2]) {
            mate[a] = Some(b);
            mate[b] = Some(a);
            let name = ca.min(cb);
            chain.iter_mut().filter(|c| **c == ca || **c == cb).for_each(|c| *c = name);
        }
    }
    // An end without a mate closes on itself: its chain's two ends always find one another above.
    mate.iter().enumerate().map(|(e, m)| m.unwrap_or(e ^ 1)).collect()
}

fn walk(strokes: &[&[DVec2]], mate: &[usize], first: usize, used: &mut [bool]) -> Ring {
    let mut ring = Ring::default();
    let mut enter = 2 * first;
    for _ in 0..=strokes.len() {
        let k = enter / 2;
        used[k] = true;
        ring.parts.push(k);
        if enter.is_multiple_of(2) {
            ring.points.extend_from_slice(strokes[k]);
        } else {
            ring.points.extend(strokes[k].iter().rev());
        }
        ring.gaps.push(ring.points.len().saturating_sub(1));
        enter = mate[enter ^ 1];
        if enter / 2 == first {
            break;
        }
    }
    ring.parts.sort_unstable();
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(a: (f64, f64), b: (f64, f64)) -> Vec<DVec2> {
        let (a, b) = (DVec2::from(a), DVec2::from(b));
        (0..=20).map(|i| a.lerp(b, f64::from(i) / 20.0)).collect()
    }

    #[test]
    fn two_lines_are_one_trunk_and_a_closed_arm_stays_alone() {
        let left = line((0.0, 0.0), (0.1, 1.0));
        let right = line((0.3, 1.0), (0.4, 0.0));
        let arm: Vec<DVec2> =
            [line((0.4, 0.5), (0.6, 0.6)), line((0.6, 0.6), (0.6, 0.55)), line((0.6, 0.55), (0.4, 0.45))]
                .concat();
        let found = rings(&[&left, &arm, &right]);
        let parts: Vec<_> = found.iter().map(|r| r.parts.clone()).collect();
        assert_eq!(parts, [vec![0, 2], vec![1]]);
        assert_eq!(found[0].points.len(), 42);
        assert_eq!(found[0].drawn().len(), 2);
        assert!(
            (geom::signed_area(&found[0].points).abs() - 0.3).abs() < 1e-9,
            "the trunk between the lines"
        );
    }

    #[test]
    fn an_arm_that_ends_near_the_foot_of_its_body_is_its_own() {
        let body = [line((0.0, 0.0), (0.0, 1.0)), line((0.0, 1.0), (0.4, 1.0)), line((0.4, 1.0), (0.4, 0.0))]
            .concat();
        let arm = [line((0.4, 0.8), (0.7, 0.6)), line((0.7, 0.6), (0.4, 0.3))].concat();
        assert_eq!(rings(&[&body, &arm]).len(), 1, "by its ends alone it would be a piece of the body");
        let parts: Vec<_> = rings_and_arms(&[&body, &arm]).into_iter().map(|r| r.parts).collect();
        assert_eq!(parts, [vec![0], vec![1]]);
        let side = line((0.7, 0.0), (0.7, 0.9));
        assert_eq!(rings_and_arms(&[&body, &side]).len(), rings(&[&body, &side]).len());
    }

    #[test]
    fn an_arc_and_a_line_below_are_one_outline() {
        let arc: Vec<DVec2> = (0..=40)
            .map(|i| base::ops::sin_cos(base::ops::PI * f64::from(i) / 40.0))
            .map(|(s, c)| DVec2::new(c, s))
            .collect();
        let base = line((-0.95, -0.05), (0.9, -0.1));
        assert_eq!(rings(&[&arc, &base]).len(), 1);
    }

    #[test]
    fn far_apart_lines_are_not_joined() {
        let (a, b) = (line((0.0, 0.0), (0.0, 0.1)), line((0.9, 0.0), (0.9, 0.1)));
        assert_eq!(rings(&[&a, &b]).len(), 2);
    }
}
