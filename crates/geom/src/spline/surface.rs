//! Surfaces from a grid of marks: Bezier, approximating, interpolating or rational.

use core::iter::Sum;
use core::ops::{Add, Mul};

use glam::DVec3;

use super::ball::{Ball, BallBSpline};
use super::fit::{NaturalCubic, chord_parameters};
use super::{Basis, SplineError, Weights};
use crate::vector::Vector as _;

/// A tensor-product surface over (u, v): u runs along a row of marks, v from row to row.
///
/// Wang et al. (2011), section 2.2: `P(u, v) = sum_ij N_i(v) N_j(u) P_ij`, with weights the quotient of NURBS.
///
/// ```
/// use geom::SplineSurface;
/// use glam::DVec3;
/// let grid = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y];
/// let plane = SplineSurface::bezier(&grid, 2)?;
/// assert_eq!(plane.point(0.25, 0.5), DVec3::new(0.25, 0.5, 0.0));
/// assert_eq!(plane.point_at(0.5, 0.5).normal, Some(DVec3::Z));
/// # Ok::<(), geom::SplineError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SplineSurface {
    u: Basis,
    v: Basis,
    controls: Vec<DVec3>,
    weights: Option<Vec<f64>>,
    places: [Vec<f64>; 2],
}

/// A point of a surface with derivatives and normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point.
    pub position: DVec3,
    /// Derivative along the row.
    pub du: DVec3,
    /// Derivative from row to row.
    pub dv: DVec3,
    /// `du x dv` of unit length; `None` where the surface is pinched.
    pub normal: Option<DVec3>,
}

impl SplineSurface {
    /// Makes the Bezier surface with the marks as controls, `columns` per row.
    ///
    /// # Errors
    /// [`SplineError`] for less than 2 rows or columns, more than 64, unequal rows, unusable points.
    pub fn bezier(grid: &[DVec3], columns: usize) -> Result<Self, SplineError> {
        let rows = rows_of(grid, columns)?;
        Self::from_controls(Basis::bezier(columns)?, Basis::bezier(rows)?, grid.to_vec(), None)
    }

    /// Makes the bicubic B-spline surface with the marks as controls. Fewer than 4 rows or columns lower the degree.
    ///
    /// # Errors
    /// [`SplineError`] for less than 2 rows or columns, unequal rows, unusable points.
    pub fn approximate(grid: &[DVec3], columns: usize) -> Result<Self, SplineError> {
        let rows = rows_of(grid, columns)?;
        Self::from_controls(Basis::uniform(3, columns)?, Basis::uniform(3, rows)?, grid.to_vec(), None)
    }

    /// As [`approximate`](Self::approximate), drawn towards marks of larger weight.
    ///
    /// # Errors
    /// Those of `approximate`, and [`SplineError::NotFinite`] for weights that are not above 0.
    pub fn nurbs(grid: &[DVec3], weights: &[f64], columns: usize) -> Result<Self, SplineError> {
        let rows = rows_of(grid, columns)?;
        let (u, v) = (Basis::uniform(3, columns)?, Basis::uniform(3, rows)?);
        Self::from_controls(u, v, grid.to_vec(), Some(weights.to_vec()))
    }

    /// Makes the bicubic surface through all marks, with natural edges.
    ///
    /// Parameters are chord lengths, averaged over rows and over columns; a row or column without length (the repeated
    /// tip of a leaf) does not contribute. Cost: linear in the marks.
    ///
    /// # Errors
    /// [`SplineError`] for less than 2 rows or columns, unequal rows, unusable points, or if neighbouring rows
    /// or columns coincide everywhere.
    pub fn interpolate(grid: &[DVec3], columns: usize) -> Result<Self, SplineError> {
        let rows = rows_of(grid, columns)?;
        let along: Vec<Vec<DVec3>> = grid.chunks_exact(columns).map(<[DVec3]>::to_vec).collect();
        let across: Vec<Vec<DVec3>> =
            (0..columns).map(|j| (0..rows).map(|i| grid[i * columns + j]).collect()).collect();
        let u = NaturalCubic::new(&mean_parameters(&along)?)?;
        let v = NaturalCubic::new(&mean_parameters(&across)?)?;
        Self::interpolate_at(&u, &v, grid)
    }

    /// Makes the surface through marks at given parameters.
    ///
    /// # Errors
    /// [`SplineError::Ragged`] if the numbers differ, [`SplineError::NotFinite`].
    pub fn interpolate_at(u: &NaturalCubic, v: &NaturalCubic, grid: &[DVec3]) -> Result<Self, SplineError> {
        let (columns, rows) = (u.parameters().len(), v.parameters().len());
        if grid.len() != columns * rows {
            return Err(SplineError::Ragged { points: grid.len(), columns });
        }
        let wide = columns + 2;
        let mut middle = Vec::with_capacity(wide * rows);
        for row in grid.chunks_exact(columns) {
            middle.extend(u.controls(row)?);
        }
        let mut controls = vec![DVec3::ZERO; wide * (rows + 2)];
        for j in 0..wide {
            let column: Vec<DVec3> = (0..rows).map(|i| middle[i * wide + j]).collect();
            for (i, c) in v.controls(&column)?.into_iter().enumerate() {
                controls[i * wide + j] = c;
            }
        }
        let mut surface = Self::from_controls(u.basis().clone(), v.basis().clone(), controls, None)?;
        surface.places = [u.parameters().to_vec(), v.parameters().to_vec()];
        Ok(surface)
    }

    /// Makes a surface of given bases and controls, row after row.
    ///
    /// # Errors
    /// [`SplineError::Ragged`] if the numbers do not fit, [`SplineError::NotFinite`].
    pub fn from_controls(
        u: Basis,
        v: Basis,
        controls: Vec<DVec3>,
        weights: Option<Vec<f64>>,
    ) -> Result<Self, SplineError> {
        let (columns, rows) = (u.controls(), v.controls());
        let given = weights.as_ref().map_or(controls.len(), |w| w.len().min(controls.len()));
        if given != columns * rows || controls.len() != given {
            return Err(SplineError::Ragged { points: given, columns });
        }
        if let Some(bad) = controls.iter().position(|p| !p.usable()) {
            return Err(SplineError::NotFinite(bad));
        }
        if let Some(bad) = weights.iter().flatten().position(|w| !(*w > 0.0 && *w < 1e100)) {
            return Err(SplineError::NotFinite(bad));
        }
        let places =
            [(0..columns).map(|j| u.greville(j)).collect(), (0..rows).map(|i| v.greville(i)).collect()];
        Ok(Self { u, v, controls, weights, places })
    }

    /// Moves every control: the same surface elsewhere, if `place` is a rigid motion.
    #[must_use]
    pub fn moved(mut self, place: impl Fn(DVec3) -> DVec3) -> Self {
        self.controls.iter_mut().for_each(|p| *p = place(*p));
        self
    }

    /// Returns the basis along a row.
    pub fn u(&self) -> &Basis {
        &self.u
    }

    /// Returns the basis from row to row.
    pub fn v(&self) -> &Basis {
        &self.v
    }

    /// Returns the controls, row after row.
    pub fn controls(&self) -> &[DVec3] {
        &self.controls
    }

    /// Returns the weights of a rational surface, one per control.
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }

    /// Returns the parameters u of the columns of marks (interpolating) or of their greatest influence (otherwise).
    pub fn columns_at(&self) -> &[f64] {
        &self.places[0]
    }

    /// Returns the parameters v of the rows of marks or of their greatest influence.
    pub fn rows_at(&self) -> &[f64] {
        &self.places[1]
    }

    /// Returns the point at (u, v), each clamped to its domain.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        self.sum(&self.u.weights(u), &self.v.weights(v)).point()
    }

    /// Returns the point at (u, v) with derivatives and normal.
    pub fn point_at(&self, u: f64, v: f64) -> SurfacePoint {
        self.joined((&self.u.weights(u), &self.u.derivative(u)), (&self.v.weights(v), &self.v.derivative(v)))
    }

    /// Evaluates all pairs of `us` and `vs`, row after row; the weights of each parameter are computed once.
    pub fn grid(&self, us: &[f64], vs: &[f64]) -> Vec<SurfacePoint> {
        let across: Vec<_> = us.iter().map(|&u| (self.u.weights(u), self.u.derivative(u))).collect();
        let mut out = Vec::with_capacity(us.len() * vs.len());
        for &v in vs {
            let along = (self.v.weights(v), self.v.derivative(v));
            out.extend(across.iter().map(|(w, d)| self.joined((w, d), (&along.0, &along.1))));
        }
        out
    }

    /// Returns the curve of constant v as a ball B-spline with the given control radii, one per control of
    /// [`u`](Self::u).
    ///
    /// Its centre line lies on the surface at every parameter.
    ///
    /// # Errors
    /// [`SplineError`] if there are not as many radii as controls.
    pub fn row_vein(&self, v: f64, radii: &[f64]) -> Result<BallBSpline, SplineError> {
        let w = self.v.weights(v);
        let columns = self.u.controls();
        let at = |j: usize| self.line(&w, w.first * columns + j, columns);
        self.vein(&self.u, at, radii)
    }

    /// Returns the curve of constant u as a ball B-spline with the given control radii, one per control of
    /// [`v`](Self::v).
    ///
    /// # Errors
    /// [`SplineError`] if there are not as many radii as controls.
    pub fn column_vein(&self, u: f64, radii: &[f64]) -> Result<BallBSpline, SplineError> {
        let w = self.u.weights(u);
        let columns = self.u.controls();
        let at = |i: usize| self.line(&w, i * columns + w.first, 1);
        self.vein(&self.v, at, radii)
    }

    fn vein(
        &self,
        basis: &Basis,
        at: impl Fn(usize) -> Weighted,
        radii: &[f64],
    ) -> Result<BallBSpline, SplineError> {
        let n = basis.controls();
        if radii.len() != n {
            return Err(SplineError::TooFew { needed: n, given: radii.len() });
        }
        let sums: Vec<Weighted> = (0..n).map(at).collect();
        let balls = sums.iter().zip(radii).map(|(s, &r)| Ball::new(s.point(), r)).collect();
        let weights = self.weights.as_ref().map(|_| sums.iter().map(|s| s.weight).collect());
        BallBSpline::new(basis.clone(), balls, weights)
    }

    fn control(&self, k: usize) -> Weighted {
        let weight = self.weights.as_ref().map_or(1.0, |w| w[k]);
        Weighted { sum: self.controls[k] * weight, weight }
    }

    fn line(&self, w: &Weights, first: usize, step: usize) -> Weighted {
        w.values().iter().enumerate().map(|(k, &x)| self.control(first + k * step) * x).sum()
    }

    fn sum(&self, u: &Weights, v: &Weights) -> Weighted {
        let columns = self.u.controls();
        let rows = v.values().iter().enumerate();
        rows.map(|(i, &y)| self.line(u, (v.first + i) * columns + u.first, 1) * y).sum()
    }

    fn joined(&self, (u, u1): (&Weights, &Weights), (v, v1): (&Weights, &Weights)) -> SurfacePoint {
        let a = self.sum(u, v);
        let position = a.point();
        // Quotient rule: the sum of derivative weights is 0 without weights, so this is the derivative itself.
        let slope = |d: Weighted| (d.sum - position * d.weight) / a.weight;
        let (du, dv) = (slope(self.sum(u1, v)), slope(self.sum(u, v1)));
        let cross = du.cross(dv);
        // 1e-9: an angle between the directions, or a ratio of their lengths, below which the normal is noise.
        let (a, b) = (du.length(), dv.length());
        let sound = cross.length() > 1e-9 * a * b && a.min(b) > 1e-9 * a.max(b);
        let normal = if sound { cross.try_normalize() } else { None };
        SurfacePoint { position, du, dv, normal }
    }
}

/// A point times its weight, and the weight.
#[derive(Clone, Copy, Debug, Default)]
struct Weighted {
    sum: DVec3,
    weight: f64,
}

impl Weighted {
    fn point(self) -> DVec3 {
        self.sum / self.weight
    }
}

impl Add for Weighted {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { sum: self.sum + other.sum, weight: self.weight + other.weight }
    }
}

impl Mul<f64> for Weighted {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { sum: self.sum * factor, weight: self.weight * factor }
    }
}

impl Sum for Weighted {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::default(), |a, b| a + b)
    }
}

fn rows_of(grid: &[DVec3], columns: usize) -> Result<usize, SplineError> {
    if columns < 2 {
        return Err(SplineError::TooFew { needed: 2, given: columns });
    }
    if !grid.len().is_multiple_of(columns) {
        return Err(SplineError::Ragged { points: grid.len(), columns });
    }
    let rows = grid.len() / columns;
    if rows < 2 {
        return Err(SplineError::TooFew { needed: 2, given: rows });
    }
    match grid.iter().position(|p| !p.usable()) {
        Some(bad) => Err(SplineError::NotFinite(bad)),
        None => Ok(rows),
    }
}

/// Returns the mean of the chord parameters of all lines that have a length.
fn mean_parameters(lines: &[Vec<DVec3>]) -> Result<Vec<f64>, SplineError> {
    let each: Vec<Vec<f64>> = lines.iter().filter_map(|l| chord_parameters(l)).collect();
    let n = lines.first().map_or(0, Vec::len);
    if each.is_empty() {
        return Err(SplineError::TooFew { needed: 2, given: 1 });
    }
    let count = each.len() as f64;
    let mut mean: Vec<f64> = (0..n).map(|k| each.iter().map(|l| l[k]).sum::<f64>() / count).collect();
    if let Some(last) = mean.last_mut() {
        *last = 1.0;
    }
    Ok(mean)
}
