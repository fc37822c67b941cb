//! Outlines that go on behind the strokes that cover them.

use glam::DVec2;

/// Points of the hidden part.
const HIDDEN_POINTS: usize = 9;
/// Points over which the direction at an end is taken.
const TANGENT_POINTS: usize = 3;
/// Length of the handles of the hidden curve if the ends converge, as a share of the distance to their meeting point:
/// between an arc of a circle (0.55 for a quarter of it) and a point (1).
const HANDLE_TO_MEETING: f64 = 0.7;
/// Length of the handles if the ends do not converge, as a share of the distance between the ends.
const HANDLE: f64 = 0.6;
/// The hidden part reaches at most this share of the visible extent beyond the ends.
const REACH: f64 = 0.8;

/// Closes an open line whose ends both stop on something that covers it, behind that: returns `line` first, then the
/// hidden points from its end back to its start.
///
/// The hidden part continues both ends smoothly and bends monotonically ("relatable" edges: Kellman and Shipley 1991):
/// a cubic Bezier curve, whose handles meet where the ends converge.
pub(crate) fn complete(line: &[DVec2]) -> Vec<DVec2> {
    let (Some(&start), Some(&end)) = (line.first(), line.last()) else { return Vec::new() };
    let gap = start.distance(end);
    let leaving =
        |from: DVec2, inner: Option<&DVec2>| inner.map_or(DVec2::ZERO, |&p| from - p).normalize_or_zero();
    let out_of_end = leaving(end, line.iter().rev().nth(TANGENT_POINTS).or_else(|| line.first()));
    let out_of_start = leaving(start, line.get(TANGENT_POINTS).or_else(|| line.last()));
    let extent = line.iter().map(|p| p.distance(start.midpoint(end))).fold(0.0, f64::max);
    let reach = REACH * extent;
    let handles = meeting(end, out_of_end, start, out_of_start)
        .map_or([HANDLE * gap; 2], |ways| ways.map(|way| (HANDLE_TO_MEETING * way).min(reach)));
    let (b, c) = (end + out_of_end * handles[0], start + out_of_start * handles[1]);
    let hidden = (1..=HIDDEN_POINTS).map(|k| {
        let t = k as f64 / (HIDDEN_POINTS + 1) as f64;
        let s = 1.0 - t;
        end * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + start * (t * t * t)
    });
    line.iter().copied().chain(hidden).collect()
}

/// Returns the attachment of an outline that was completed behind something: the middle of its hidden part.
pub(crate) fn hidden_root(completed: &[DVec2]) -> Option<DVec2> {
    completed.len().checked_sub(HIDDEN_POINTS / 2 + 1).and_then(|k| completed.get(k)).copied()
}

/// Returns the lengths of two rays up to their intersection, if they meet.
fn meeting(p: DVec2, along_p: DVec2, q: DVec2, along_q: DVec2) -> Option<[f64; 2]> {
    let cross = along_p.perp_dot(along_q);
    if cross.abs() <= crate::thresholds::ROUNDING {
        return None;
    }
    let reach = [(q - p).perp_dot(along_q) / cross, (q - p).perp_dot(along_p) / cross];
    reach.iter().all(|r| *r > 0.0).then_some(reach)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::ops;

    fn arc(from: f64, to: f64) -> Vec<DVec2> {
        (0..=200)
            .map(|k| from + (to - from) * f64::from(k) / 200.0)
            .map(|a| DVec2::new(ops::cos(a), ops::sin(a)))
            .collect()
    }

    #[test]
    fn three_quarters_of_a_circle_are_completed_to_about_a_circle() {
        let line = arc(0.25 * std::f64::consts::PI, 1.75 * std::f64::consts::PI);
        let whole = complete(&line);
        assert_eq!(whole[..line.len()], line[..], "the visible part stays");
        let off = whole.iter().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 0.12, "{off}");
        let root = hidden_root(&whole).expect("it has one");
        assert!(root.x > 0.8 && root.y.abs() < 0.1, "{root}");
    }

    #[test]
    fn a_petal_that_narrows_ends_where_its_sides_meet() {
        let side = |x: f64| {
            (0..=10).map(move |k| DVec2::new(x * (0.4 + 0.06 * f64::from(k)), 0.4 + 0.06 * f64::from(k)))
        };
        let left: Vec<DVec2> = side(-0.5).collect();
        let mut line = left;
        line.extend(side(0.5).collect::<Vec<_>>().into_iter().rev());
        let root = hidden_root(&complete(&line)).expect("it has one");
        assert!(root.x.abs() < 1e-9 && (0.0..0.35).contains(&root.y), "{root}");
    }

    #[test]
    fn nothing_and_points_in_one_place_do_no_harm() {
        assert!(complete(&[]).is_empty());
        assert!(complete(&[DVec2::ONE; 3]).iter().all(|p| p.is_finite()));
        assert_eq!(hidden_root(&[]), None);
    }
}
