//! Marks -> veins as ball B-splines and a blade as a spline surface, both of the same controls.

use geom::{Ball, BallBSpline, NaturalCubic, SplineError, SplineSurface, subdivided};
use glam::DVec3;
use plant::{Chart, RimPoint, SplineBlade, Vein, Venation};

use crate::marks::{FullMarks, MARKS_A_ROW};
use crate::spec::{LeafSpec, SurfaceKind, VeinParameters};

/// A leaf as curves and a surface.
///
/// The surface has u from left to right (mark 7 to mark 1), v from the last row to the tip, so that
/// `du x dv` points to the upper side. Guaranteed with shared parameters: every vein lies on the blade.
///
/// ```
/// # use glam::DVec3;
/// use leaf::{Leaf, LeafSpec, MarkRow, Marks};
/// let row = |y: f64| MarkRow {
///     points: std::array::from_fn(|j| DVec3::new(0.03 - 0.01 * j as f64, y, 0.0)),
///     midrib: Some(0.002),
///     ..MarkRow::default()
/// };
/// let marks = Marks { rows: vec![row(0.06), row(0.0)], tip: DVec3::Y * 0.1, ..Marks::default() };
/// let full = marks.complete(&mut base::Report::default())?;
/// let leaf = Leaf::new(&full, &LeafSpec::default())?;
/// let middle = leaf.midrib.curve.ball(0.3);
/// assert!(middle.centre.distance(leaf.blade.point(leaf.middle, 0.3)) < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Leaf {
    /// The blade.
    pub blade: SplineSurface,
    /// The midrib, from the root to the tip.
    pub midrib: Vein,
    /// The side veins from the last row up, each from left to right.
    pub sides: Vec<Vein>,
    /// The margin from the last row to the tip, left and right, with its measured thickness.
    pub margins: [Vein; 2],
    /// The parameter u of the midrib.
    pub middle: f64,
    /// The margin, if it differs from the edge of the surface.
    pub rim: Vec<RimPoint>,
}

impl Leaf {
    /// Fits a blade and veins through or near marks.
    ///
    /// Cost: linear in the marks for interpolation.
    ///
    /// # Errors
    /// [`SplineError`] for marks that fail [`Marks::validate`](crate::Marks::validate), and for more than 63 rows with
    /// [`SurfaceKind::Bezier`].
    pub fn new(marks: &FullMarks, spec: &LeafSpec) -> Result<Self, SplineError> {
        let grid = Grid::new(marks, spec);
        let n = MARKS_A_ROW;
        let blade = match spec.surface {
            SurfaceKind::Bezier => SplineSurface::bezier(&grid.points, n)?,
            SurfaceKind::Approximate => SplineSurface::approximate(&grid.points, n)?,
            SurfaceKind::Interpolate => SplineSurface::interpolate(&grid.points, n)?,
            SurfaceKind::Nurbs => SplineSurface::nurbs(&grid.points, &grid.weights(spec), n)?,
        };
        let solve = match spec.surface {
            SurfaceKind::Interpolate => {
                Some((NaturalCubic::new(blade.columns_at())?, NaturalCubic::new(blade.rows_at())?))
            }
            _ => None,
        };
        let (us, vs) = (blade.columns_at().to_vec(), blade.rows_at().to_vec());
        let across = |radii: &[f64]| match &solve {
            Some((u, _)) => u.controls(radii),
            None => Ok(radii.to_vec()),
        };
        let along = |radii: &[f64]| match &solve {
            Some((_, v)) => v.controls(radii),
            None => Ok(radii.to_vec()),
        };
        let middle = us[n / 2];
        let midrib = Vein { curve: blade.column_vein(middle, &along(&grid.midrib)?)?, marks: vs.clone() };
        let mut sides = Vec::with_capacity(grid.rows);
        for (i, &v) in vs.iter().enumerate().take(grid.rows) {
            let radii = &grid.radii[i * n..(i + 1) * n];
            let own = solve.is_some() && spec.parameters == VeinParameters::Own;
            sides.push(if own {
                own_vein(&grid.points[i * n..(i + 1) * n], radii)?
            } else {
                Vein { curve: blade.row_vein(v, &across(radii)?)?, marks: us.clone() }
            });
        }
        let margin = |j: usize| -> Result<Vein, SplineError> {
            let radii: Vec<f64> = (0..=grid.rows).map(|i| grid.radii[i * n + j]).collect();
            Ok(Vein { curve: blade.column_vein(us[j], &along(&radii)?)?, marks: vs.clone() })
        };
        let margins = [margin(0)?, margin(n - 1)?];
        let mut leaf = Self { blade, midrib, sides, margins, middle, rim: Vec::new() };
        if !marks.margin.is_empty() {
            leaf.rim = marks.rim(&leaf.blade());
        }
        Ok(leaf)
    }

    /// Returns the leaf as a shape of a plant, in its measured place; its texture is the leaf laid flat.
    pub fn blade(&self) -> SplineBlade {
        let mut veins = vec![self.midrib.clone()];
        veins.extend_from_slice(&self.sides);
        SplineBlade {
            surface: self.blade.clone(),
            middle: self.middle,
            veins: Venation { veins, fine: Vec::new(), margins: self.margins.to_vec() },
            rim: self.rim.clone(),
            chart: Chart::Unrolled,
            form: 0,
        }
    }

    /// Returns the greatest distance of any vein's centre line from its place on the blade, metres.
    ///
    /// Measured at `steps` parameters per span. Rounding noise with [`VeinParameters::Shared`].
    pub fn vein_gap(&self, steps: usize) -> f64 {
        let mut gap: f64 = 0.0;
        for t in subdivided(&self.midrib.marks, steps) {
            gap = gap.max(self.midrib.curve.ball(t).centre.distance(self.blade.point(self.middle, t)));
        }
        let us = subdivided(self.blade.columns_at(), steps);
        for (side, &v) in self.sides.iter().zip(self.blade.rows_at()) {
            for (&t, &u) in subdivided(&side.marks, steps).iter().zip(&us) {
                gap = gap.max(side.curve.ball(t).centre.distance(self.blade.point(u, v)));
            }
        }
        gap
    }
}

fn own_vein(points: &[DVec3], radii: &[f64]) -> Result<Vein, SplineError> {
    let marks = geom::chord_parameters(points).ok_or(SplineError::TooFew { needed: 2, given: 1 })?;
    let balls: Vec<Ball> = points.iter().zip(radii).map(|(&p, &r)| Ball::new(p, r)).collect();
    Ok(Vein { curve: BallBSpline::interpolate_at(&NaturalCubic::new(&marks)?, &balls)?, marks })
}

/// Marks in the surface's order: rows from the last to the tip, columns from left to right.
struct Grid {
    rows: usize,
    points: Vec<DVec3>,
    radii: Vec<f64>,
    midrib: Vec<f64>,
}

impl Grid {
    fn new(marks: &FullMarks, spec: &LeafSpec) -> Self {
        let radius = spec.thickness.unwrap_or_default().radius();
        let rows = marks.rows.len();
        let up = || marks.rows.iter().rev();
        let mut points: Vec<DVec3> = up().flat_map(|r| r.points.into_iter().rev()).collect();
        points.extend([marks.tip; MARKS_A_ROW]);
        let mut radii: Vec<f64> = up().flat_map(|r| r.thickness.into_iter().rev()).collect();
        radii.extend([marks.tip_thickness; MARKS_A_ROW]);
        let mut midrib: Vec<f64> = up().map(|r| r.midrib).collect();
        midrib.push(marks.tip_thickness);
        radii.iter_mut().chain(&mut midrib).for_each(|r| *r *= radius);
        Self { rows, points, radii, midrib }
    }

    /// Returns weights from 1 for the thinnest vein to `vein_weight` for the thickest, linear between; the midrib's own
    /// in its column.
    fn weights(&self, spec: &LeafSpec) -> Vec<f64> {
        let n = MARKS_A_ROW;
        let thick = |k: usize| if k % n == n / 2 { self.midrib[k / n] } else { self.radii[k] };
        let all: Vec<f64> = (0..self.points.len()).map(thick).collect();
        let (lo, hi) = all.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &x| (a.min(x), b.max(x)));
        let most = spec.vein_weight.clamp(1.0, 100.0);
        let share = |x: f64| if hi > lo { (x - lo) / (hi - lo) } else { 0.0 };
        all.iter().map(|&x| 1.0 + (most - 1.0) * share(x)).collect()
    }
}

#[cfg(test)]
mod tests {
    use base::Report;

    use super::*;
    use crate::marks::tests::sample;
    use crate::thickness::ThicknessRule;

    fn full(rows: usize) -> FullMarks {
        sample(rows).complete(&mut Report::default()).unwrap()
    }

    #[test]
    fn veins_lie_on_every_kind_of_blade() {
        for surface in SurfaceKind::ALL {
            let leaf = Leaf::new(&full(9), &LeafSpec { surface, ..LeafSpec::default() }).unwrap();
            assert!(leaf.vein_gap(13) < 1e-9, "{surface:?} {}", leaf.vein_gap(13));
        }
    }

    #[test]
    fn veins_of_own_parameters_meet_the_blade_at_the_marks_only() {
        let spec = LeafSpec { parameters: VeinParameters::Own, ..LeafSpec::default() };
        let leaf = Leaf::new(&full(9), &spec).unwrap();
        assert!(leaf.vein_gap(1) < 1e-12, "{}", leaf.vein_gap(1));
        assert!(leaf.vein_gap(8) > 1e-7, "{}", leaf.vein_gap(8));
    }

    #[test]
    fn interpolating_leaf_passes_through_marks_with_their_thickness() {
        let marks = full(6);
        let leaf = Leaf::new(&marks, &LeafSpec::default()).unwrap();
        for (i, row) in marks.rows.iter().rev().enumerate() {
            let vein = &leaf.sides[i];
            for (j, t) in vein.marks.iter().enumerate() {
                let ball = vein.curve.ball(*t);
                assert!(ball.centre.distance(row.points[6 - j]) < 1e-14, "{i} {j}");
                assert!((ball.radius - 0.5 * row.thickness[6 - j]).abs() < 1e-15, "{i} {j}");
            }
            let ball = leaf.midrib.curve.ball(leaf.midrib.marks[i]);
            assert!((ball.radius - 0.5 * row.midrib).abs() < 1e-15);
        }
    }

    #[test]
    fn thickness_as_radius_doubles_the_veins() {
        let thin = Leaf::new(&full(4), &LeafSpec::default()).unwrap();
        let spec = LeafSpec { thickness: Some(ThicknessRule::Radius), ..LeafSpec::default() };
        let thick = Leaf::new(&full(4), &spec).unwrap();
        let r = |l: &Leaf| l.midrib.curve.ball(0.4).radius;
        assert!((r(&thick) - 2.0 * r(&thin)).abs() < 1e-15);
    }

    #[test]
    fn nurbs_comes_nearer_to_the_midrib_than_the_plain_spline() {
        let mut marks = full(8);
        marks.rows.iter_mut().for_each(|r| r.points[3].z = -0.2);
        let depth = |surface| {
            let leaf = Leaf::new(&marks, &LeafSpec { surface, ..LeafSpec::default() }).unwrap();
            leaf.blade.point(leaf.middle, 0.5).z
        };
        assert!(depth(SurfaceKind::Nurbs) < depth(SurfaceKind::Approximate) - 0.005);
    }

    #[test]
    fn flat_leaf_has_its_measured_lengths_however_it_is_bent() {
        let mut marks = sample(8);
        marks.rows.iter_mut().for_each(|r| r.points.iter_mut().for_each(|p| p.z = 0.0));
        let make = |marks: &crate::Marks| {
            let full = marks.complete(&mut Report::default()).unwrap();
            Leaf::new(&full, &LeafSpec::default()).unwrap().blade().flat(6)
        };
        let plain = make(&marks);
        // Bent around a cylinder of radius 0.5 across the midrib.
        let bend = |p: DVec3| {
            let (s, c) = base::ops::sin_cos(p.y / 0.5);
            DVec3::new(p.x, 0.5 * s, 0.5 * (c - 1.0))
        };
        let mut bent = marks.clone();
        bent.rows.iter_mut().for_each(|r| r.points = r.points.map(bend));
        bent.tip = bend(bent.tip);
        let bent = make(&bent);
        for (a, b) in plain.points.iter().zip(&bent.points) {
            assert!(a.distance(*b) < 0.012, "{a:?} {b:?}");
        }
        let area = geom::signed_area(&plain.outline());
        assert!(area > 0.0 && geom::self_crossings(&plain.outline()) == 0, "{area}");
        assert_eq!(plain.side_veins().len(), 16);
    }
}
