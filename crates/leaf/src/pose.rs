//! Curl and wilt: a leaf's marks moved as a living leaf moves.

use base::ops::{self, lerp, smoothstep};
use base::turn;
use glam::{DQuat, DVec3};

use crate::marks::{FullMarks, FullRow, MARKS_A_ROW};

/// How a leaf is bent from the shape in which it was measured.
///
/// Guaranteed: distances between neighbouring marks along the midrib and along the side veins stay (but for
/// the shrinking of a wilted blade), and (0, 0) changes nothing. Not kept: the area of the blade (docs/leaves.md).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Roll of the blade about its midrib: 0 as measured, 1 margins meet above the upper side, -1 below.
    pub curl: f64,
    /// Loss of stiffness: 0 fresh, 1 hanging limp, halves folded down.
    pub wilt: f64,
    /// Where a limp leaf hangs to.
    pub down: DVec3,
}

impl Default for Pose {
    fn default() -> Self {
        Self { curl: 0.0, wilt: 0.0, down: DVec3::NEG_Y }
    }
}

// Half of a full turn to each side brings the margins together above the midrib.
const FULL_CURL: f64 = ops::PI;
// 55 degrees: the halves of a limp tobacco leaf hang like a roof, not like a closed book.
const FULL_FOLD: f64 = 55.0 / 180.0 * ops::PI;
// A limp leaf has lost some of its water, and a tenth of its width with it.
const SHRINK: f64 = 0.1;

const MIDDLE: usize = MARKS_A_ROW / 2;

impl Pose {
    /// The marks in this pose; the root stays where it is.
    ///
    /// Values beyond -1 to 1 (wilt: 0 to 1) are clamped, NaN counts as 0. Cost: linear.
    pub fn apply(&self, marks: &FullMarks) -> FullMarks {
        let clean = |x: f64, lo: f64| if x.is_nan() { 0.0 } else { x.clamp(lo, 1.0) };
        let (curl, wilt) = (clean(self.curl, -1.0), clean(self.wilt, 0.0));
        if curl == 0.0 && wilt == 0.0 {
            return marks.clone();
        }
        let down = self.down.try_normalize().unwrap_or(DVec3::NEG_Y);
        let line = marks.midrib();
        let length = geom::polyline_length3(&line);
        // Rows from the root up; the last of `line` is the tip.
        let rows: Vec<&FullRow> = marks.rows.iter().rev().collect();
        let mut out = Vec::with_capacity(rows.len());
        let mut place = line[0];
        let mut walked = 0.0;
        for (i, row) in rows.iter().enumerate() {
            let step = line[i + 1] - line[i];
            let before = if i == 0 { step } else { line[i] - line[i - 1] };
            let tangent = before.normalize_or_zero() + step.normalize_or_zero();
            let share = if length > 0.0 { walked / length } else { 0.0 };
            let limp = sag(tangent, down, share, wilt);
            let axis = tangent.try_normalize().unwrap_or(DVec3::Y);
            out.push(pose_row(row, axis, limp, place, [curl, wilt]));
            walked += step.length();
            let middle = (walked - 0.5 * step.length()) / length.max(f64::MIN_POSITIVE);
            place += sag(step, down, middle, wilt) * step;
        }
        out.reverse();
        FullMarks { rows: out, tip: place, tip_thickness: marks.tip_thickness }
    }
}

/// The turn of a direction at a share of the way from the root to the tip: towards down, more the farther out.
fn sag(direction: DVec3, down: DVec3, share: f64, wilt: f64) -> DQuat {
    let Some(from) = direction.try_normalize() else { return DQuat::IDENTITY };
    // The stalk holds; from there to the middle the midrib gives way.
    let part = wilt * smoothstep(-0.05, 0.55, share);
    let axis = from.cross(down);
    let angle = ops::atan2(axis.length(), from.dot(down));
    match axis.try_normalize() {
        Some(axis) => turn::about(axis, angle * part),
        // Straight up or down: nothing says to which side it falls.
        None => DQuat::IDENTITY,
    }
}

/// One row moved to `place`: each half turned about the midrib's direction `axis`, then with the midrib.
fn pose_row(row: &FullRow, axis: DVec3, limp: DQuat, place: DVec3, [curl, wilt]: [f64; 2]) -> FullRow {
    let mut points = row.points;
    points[MIDDLE] = place;
    let halves = [(0..MIDDLE).rev().collect::<Vec<_>>(), (MIDDLE + 1..MARKS_A_ROW).collect()];
    for (half, outwards) in halves.iter().zip([1.0, -1.0]) {
        let mut last = row.points[MIDDLE];
        let mut at = place;
        for (k, &j) in half.iter().enumerate() {
            let step = row.points[j] - last;
            last = row.points[j];
            // Lifting the right half (at +across) to the upper side turns it about -tangent.
            let rolled = curl * FULL_CURL * (k as f64 + 0.5) / MIDDLE as f64;
            let angle = outwards * (wilt * FULL_FOLD - rolled);
            let shrink = lerp(1.0, 1.0 - SHRINK, wilt);
            at += limp * (turn::about(axis, angle) * (step * shrink));
            points[j] = at;
        }
    }
    FullRow { points, ..*row }
}

#[cfg(test)]
mod tests {
    use base::Report;

    use super::*;
    use crate::marks::tests::sample;

    fn flat() -> FullMarks {
        let mut marks = sample(8);
        marks.rows.iter_mut().for_each(|r| r.points.iter_mut().for_each(|p| p.z = 0.0));
        marks.complete(&mut Report::default()).unwrap()
    }

    fn lengths(m: &FullMarks) -> Vec<f64> {
        let rows = m.rows.iter().flat_map(|r| r.points.windows(2).map(|w| w[0].distance(w[1])));
        rows.chain(m.midrib().windows(2).map(|w| w[0].distance(w[1]))).collect()
    }

    #[test]
    fn nothing_asked_changes_nothing() {
        assert_eq!(Pose::default().apply(&flat()), flat());
        assert_eq!(Pose { curl: f64::NAN, wilt: f64::NAN, ..Pose::default() }.apply(&flat()), flat());
    }

    #[test]
    fn curl_keeps_lengths_and_brings_the_margins_together_above() {
        let before = flat();
        let after = Pose { curl: 1.0, ..Pose::default() }.apply(&before);
        for (a, b) in lengths(&before).iter().zip(lengths(&after)) {
            assert!((a - b).abs() < 1e-12);
        }
        for (a, b) in before.rows.iter().zip(&after.rows) {
            let gap = |r: &FullRow| r.points[0].distance(r.points[6]);
            assert!(gap(b) < 0.35 * gap(a), "{} {}", gap(a), gap(b));
            // The sample lies in the plane z = 0 with its upper side at +z.
            assert!(b.points[0].z > 0.0 && b.points[6].z > 0.0);
        }
        let under = Pose { curl: -0.5, ..Pose::default() }.apply(&before);
        assert!(under.rows[4].points[0].z < 0.0);
    }

    #[test]
    fn wilted_leaf_hangs_down_and_keeps_its_midrib() {
        let before = flat();
        let down = DVec3::NEG_Z;
        let after = Pose { wilt: 1.0, down, ..Pose::default() }.apply(&before);
        let length = |m: &FullMarks| geom::polyline_length3(&m.midrib());
        assert!((length(&before) - length(&after)).abs() < 1e-12);
        assert_eq!(after.root(), before.root());
        let line = after.midrib();
        let end = (line[8] - line[7]).normalize();
        assert!(end.dot(down) > 0.999, "{end:?}");
        assert!(line[8].z < -0.6, "{:?}", line[8]);
        // More wilt, lower tip, all the way.
        let mut last = 0.0;
        for k in 1..=10 {
            let tip = Pose { wilt: f64::from(k) / 10.0, down, ..Pose::default() }.apply(&before).tip.z;
            assert!(tip < last);
            last = tip;
        }
    }
}
