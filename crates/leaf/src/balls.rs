//! Control balls moved and rescaled by hand: the deformation of Wang et al. (2011), Fig 4.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::marks::{FullMarks, MARKS_A_ROW, MarksError};
use crate::rays::{Rays, RaysError};

/// One control ball moved and rescaled: the position of a mark and the thickness of the veins there.
///
/// For an approximating or NURBS surface the marks are the control balls, so that the blade changes only within two
/// rows and two marks; an interpolating one passes through the ball, and changes slightly everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BallMove {
    /// Row of marks from the tip down, from 1, or 0 for the tip; for chief veins the vein from the right margin, from
    /// 1.
    #[schemars(range(min = 0, max = 1000))]
    pub row: u32,
    /// Mark of the row from the right margin, 1 to 7, where 4 is on the midrib; for chief veins the mark from the base.
    #[schemars(range(min = 1, max = 1000))]
    pub mark: u32,
    /// Offset to the right as seen on the upper side with the tip up, towards the tip, and off the upper side; metres,
    /// -10 to 10.
    #[schemars(inner(range(min = -10.0, max = 10.0)), extend("x-unit" = "m"))]
    pub by_m: [f64; 3],
    /// Factor on the thickness of the veins there, 0.05 to 20, default 1.
    #[schemars(range(min = 0.05, max = 20.0))]
    pub thickness: f64,
}

impl Default for BallMove {
    fn default() -> Self {
        Self { row: 1, mark: 4, by_m: [0.0; 3], thickness: 1.0 }
    }
}

const MIDDLE: usize = MARKS_A_ROW / 2;

/// Directions on a leaf: to the right, towards the tip, off the upper side.
struct Sides([DVec3; 3]);

impl Sides {
    /// Builds the frame. `across` points from the left margin to the right one and may have any length.
    fn new(root: DVec3, tip: DVec3, across: DVec3) -> Self {
        let forth = (tip - root).try_normalize().unwrap_or(DVec3::Y);
        let right = (across - forth * across.dot(forth)).try_normalize();
        let right = right.unwrap_or_else(|| forth.any_orthonormal_vector());
        Self([right, forth, right.cross(forth)])
    }

    fn from_marks(marks: &FullMarks) -> Self {
        let across = marks.rows.iter().map(|r| r.points[0] - r.points[MARKS_A_ROW - 1]).sum();
        Self::new(marks.root(), marks.tip, across)
    }

    fn from_rays(rays: &Rays) -> Option<Self> {
        let line = &rays.rays.get(rays.rays.len() / 2)?.points;
        let (first, last) = (&rays.rays.first()?.points, &rays.rays.last()?.points);
        let middle = |points: &[DVec3]| points.get(points.len() / 2).copied();
        Some(Self::new(*line.first()?, *line.last()?, middle(first)? - middle(last)?))
    }

    fn way(&self, by: [f64; 3]) -> DVec3 {
        self.0.iter().zip(by).map(|(&axis, x)| axis * x).sum()
    }
}

/// Applies moves of balls to marks, one after another. The margin follows.
///
/// # Errors
/// [`MarksError::NoBall`] for a ball that the leaf does not have; those of [`Marks::validate`](crate::Marks::validate)
/// for the moved marks.
pub(crate) fn moved(balls: &[BallMove], marks: &FullMarks) -> Result<FullMarks, MarksError> {
    let mut out = marks.clone();
    if balls.is_empty() {
        return Ok(out);
    }
    let (sides, rows) = (Sides::from_marks(marks), marks.rows.len());
    for ball in balls {
        let (row, mark) = (ball.row as usize, ball.mark as usize);
        let way = sides.way(ball.by_m);
        if row == 0 {
            out.tip += way;
            out.tip_thickness *= ball.thickness;
        } else if let (Some(at), 1..=MARKS_A_ROW) = (out.rows.get_mut(row - 1), mark) {
            at.points[mark - 1] += way;
            at.thickness[mark - 1] *= ball.thickness;
            if mark - 1 == MIDDLE {
                at.midrib *= ball.thickness;
            }
        } else {
            return Err(MarksError::NoBall { row, mark, rows });
        }
    }
    match out.to_marks().validate().next() {
        Some(fault) => Err(fault),
        None => Ok(out),
    }
}

/// As [`moved`], for chief veins that start together. A ball at the base, which all veins share, is moved on all of
/// them.
///
/// # Errors
/// [`RaysError::NoBall`] for a ball that the leaf does not have.
pub(crate) fn moved_rays(balls: &[BallMove], rays: &Rays) -> Result<Rays, RaysError> {
    let mut out = rays.clone();
    let Some(sides) = Sides::from_rays(rays) else { return Ok(out) };
    for ball in balls {
        let (ray, mark) = (ball.row as usize, ball.mark as usize);
        let at = ray.checked_sub(1).zip(mark.checked_sub(1));
        let place = at.and_then(|(i, j)| rays.rays.get(i)?.points.get(j).copied());
        let (Some((i, j)), Some(place)) = (at, place) else {
            let marks = rays.rays[0].points.len();
            return Err(RaysError::NoBall { ray, mark, rays: rays.rays.len(), marks });
        };
        let shared = |k: usize| k == i || rays.rays[k].points.get(j) == Some(&place);
        for k in (0..rays.rays.len()).filter(|&k| shared(k)) {
            out.rays[k].points[j] += sides.way(ball.by_m);
        }
        if let Some(Some(thick)) = out.rays[i].thickness.get_mut(j) {
            *thick *= ball.thickness;
        }
    }
    Ok(out)
}

/// Returns the directions of [`BallMove::by_m`] on a leaf, unit vectors.
pub fn ball_sides(marks: &FullMarks) -> [DVec3; 3] {
    Sides::from_marks(marks).0
}

/// As [`ball_sides`], for chief veins.
pub fn ball_sides_of_rays(rays: &Rays) -> [DVec3; 3] {
    Sides::from_rays(rays).map_or([DVec3::X, DVec3::Y, DVec3::Z], |sides| sides.0)
}

#[cfg(test)]
mod tests {
    use base::Report;

    use super::*;
    use crate::marks::tests::sample;
    use crate::{Leaf, LeafSpec, SurfaceKind};

    fn full() -> FullMarks {
        sample(9).complete(&mut Report::default()).unwrap()
    }

    fn with(balls: Vec<BallMove>, surface: SurfaceKind) -> LeafSpec {
        LeafSpec { balls, surface, ..LeafSpec::default() }
    }

    #[test]
    fn a_ball_of_the_approximating_blade_moves_two_rows_and_marks_around_it_only() {
        let ball = BallMove { row: 5, mark: 4, by_m: [0.0, 0.0, 0.3], thickness: 2.0 };
        let spec = with(vec![ball], SurfaceKind::Approximate);
        let (before, after) = (full(), spec.moved(&full()).unwrap());
        let [a, b] = [&before, &after].map(|m| Leaf::new(m, &spec).unwrap());
        let up = |u: f64, v: f64| a.blade.point(u, v).distance(b.blade.point(u, v));
        let ends = |at: &[f64]| (at[0], at[at.len() - 1]);
        let ((u0, u1), (v0, v1)) = (ends(a.blade.columns_at()), ends(a.blade.rows_at()));
        let mut changed = 0;
        for i in 0..=20 {
            for j in 0..=20 {
                let (s, t) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                let moved = up(base::ops::lerp(u0, u1, s), base::ops::lerp(v0, v1, t));
                changed += usize::from(moved > 0.0);
                // Row 5 from the tip of 9 and the tip: control 4 of 10 from the base, of 7 spans.
                assert!(moved == 0.0 || (t * 7.0 > 0.99 && t * 7.0 < 5.01), "{s} {t}: {moved}");
            }
        }
        assert!(changed > 100 && up(a.middle, 0.5 * (v0 + v1)) > 0.05);
        assert_eq!(after.rows[4].midrib, 2.0 * before.rows[4].midrib);
        assert!(Leaf::new(&after, &spec).unwrap().vein_gap(9) < 1e-9, "veins go with the blade");
    }

    #[test]
    fn an_interpolating_blade_goes_through_the_ball() {
        let ball = BallMove { row: 3, mark: 7, by_m: [-0.05, 0.02, 0.1], thickness: 3.0 };
        let spec = with(vec![ball, ball], SurfaceKind::Interpolate);
        let after = spec.moved(&full()).unwrap();
        let (from, to) = (full().rows[2].points[6], after.rows[2].points[6]);
        let way = ball_sides(&full()).map(|side| (side.dot(to - from) * 1e9).round());
        assert_eq!(way, [-1e8, 4e7, 2e8]);
        let leaf = Leaf::new(&after, &spec).unwrap();
        let vein = &leaf.sides[6];
        let ball = vein.curve.ball(vein.marks[0]);
        assert!(ball.centre.distance(to) < 1e-12);
        assert!((ball.radius - 4.5 * full().rows[2].thickness[6]).abs() < 1e-12);
    }

    #[test]
    fn the_tip_and_chief_veins_have_balls_too() {
        let tip = BallMove { row: 0, mark: 1, by_m: [0.0, 0.1, 0.0], thickness: 1.0 };
        let after = with(vec![tip], SurfaceKind::Interpolate).moved(&full()).unwrap();
        assert!((after.tip.distance(full().root()) - 0.1 - full().tip.distance(full().root())).abs() < 1e-9);
        let rays = Rays::palmate(&crate::PalmateSpec::default());
        let spec = |row, mark| {
            let ball = BallMove { row, mark, by_m: [0.0, 0.0, 0.02], thickness: 1.0 };
            with(vec![ball], SurfaceKind::Interpolate)
        };
        let moved = spec(1, 9).shaped_rays(&rays).unwrap();
        assert_eq!(moved.rays[1], rays.rays[1]);
        assert!((moved.rays[0].points[8].distance(rays.rays[0].points[8]) - 0.02).abs() < 1e-12);
        let base = spec(1, 1).shaped_rays(&rays).unwrap();
        assert!(base.rays.iter().all(|r| r.points[0] == base.rays[0].points[0]), "the base stays one");
        let none = spec(99, 1).shaped_rays(&rays);
        assert!(matches!(none, Err(RaysError::NoBall { ray: 99, mark: 1, .. })));
    }

    #[test]
    fn balls_that_are_not_there_and_rows_moved_into_one_another_are_told() {
        let fault = |row, mark, by_m| {
            let ball = BallMove { row, mark, by_m, thickness: 1.0 };
            with(vec![ball], SurfaceKind::Interpolate).shaped(&full()).unwrap_err()
        };
        assert_eq!(fault(10, 4, [0.0; 3]), MarksError::NoBall { row: 10, mark: 4, rows: 9 });
        assert_eq!(fault(2, 8, [0.0; 3]), MarksError::NoBall { row: 2, mark: 8, rows: 9 });
        let onto = full().rows[3].points[3] - full().rows[2].points[3];
        let way = ball_sides(&full()).map(|side| side.dot(onto));
        assert_eq!(fault(3, 4, way), MarksError::SameRow(3));
    }
}
