//! Blades given as surfaces: splines through measured veins, grids of points.

use base::{Digest, Digestible};
use geom::{BallBSpline, SplineSurface, SurfacePoint, subdivided};
use glam::DVec3;

use crate::{FlatLeaf, Frame};

/// One vein: a ball B-spline and the parameters of its marks.
#[derive(Clone, Debug, PartialEq)]
pub struct Vein {
    /// Centre line and radius, from the root, or from the left margin to the right.
    pub curve: BallBSpline,
    /// Parameters of its marks (or of their greatest influence), at least 2; they split the curve into spans for
    /// meshing.
    pub marks: Vec<f64>,
}

/// The veins of a blade.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Venation {
    /// The midrib or the chief veins, then the veins that leave them.
    pub veins: Vec<Vein>,
    /// Veins whose marks are so dense that no point is needed between them.
    pub fine: Vec<Vein>,
    /// Veins along the margin; drawn on request.
    pub margins: Vec<Vein>,
}

/// Texture coordinates of a blade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Chart {
    /// Position in the box around the blade laid flat ([`FlatLeaf`]), tip at the top.
    Unrolled,
    /// Position at u and 1 - v, with its own colours: no texture.
    Parameters(VeinShade),
}

/// Colours by the distance from the nearest vein, linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VeinShade {
    /// Colour on the veins.
    pub vein: [f32; 3],
    /// Colour between the veins.
    pub blade: [f32; 3],
    /// Distance over which the veins' colour fades, metres, above 0.
    pub reach_m: f64,
}

/// A point of the margin, with the nearest point of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RimPoint {
    /// Parameter u of the nearest point, within the surface's domain.
    pub u: f64,
    /// Parameter v of the nearest point.
    pub v: f64,
    /// The point of the margin.
    pub place: DVec3,
}

/// A blade as a spline surface with its veins (Wang et al. 2011, section 2), in its own frame like a
/// [`Blade`](crate::Blade).
///
/// u runs from the left margin to the right, v from the root to the tip, so that `du x dv` points to the upper side.
#[derive(Clone, Debug, PartialEq)]
pub struct SplineBlade {
    /// The surface.
    pub surface: SplineSurface,
    /// The parameter u of the midrib.
    pub middle: f64,
    /// Its veins.
    pub veins: Venation,
    /// The margin, if it is not the surface's own edge: counter-clockwise seen from the upper side; otherwise empty.
    pub rim: Vec<RimPoint>,
    /// Its place in a texture.
    pub chart: Chart,
    /// Number of the texture, from 0; leaves with the same number share it.
    pub form: u32,
}

/// A blade as a grid of points, in its own frame like a [`Blade`](crate::Blade).
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Row after row from the root to the tip, each from the right margin to the left: the upper side is seen with x to
    /// the right.
    pub points: Vec<DVec3>,
    /// Texture coordinate u of each column, at least 2.
    pub across: Vec<f64>,
    /// Share of the way to the tip of each row, at least 2.
    pub along: Vec<f64>,
    /// Linear RGB of each point; empty for none.
    pub colors: Vec<[f32; 3]>,
    /// Its veins.
    pub veins: Venation,
    /// Number of a texture of its own, from 0, in common numbering with those of a [`SplineBlade`]; its veins are
    /// painted on that texture. `None` if it has none.
    pub form: Option<u32>,
}

impl Venation {
    /// Iterates over all veins.
    pub fn all(&self) -> impl Iterator<Item = &Vein> {
        self.veins.iter().chain(&self.fine).chain(&self.margins)
    }

    /// Moves the veins; `place` is a rigid motion.
    #[must_use]
    fn moved(mut self, place: impl Fn(DVec3) -> DVec3) -> Self {
        for vein in self.veins.iter_mut().chain(&mut self.fine).chain(&mut self.margins) {
            vein.curve = vein.curve.clone().moved(&place);
        }
        self
    }
}

impl SplineBlade {
    /// Returns the blade in its own frame, and the frame, of a blade that was measured in the plant's coordinates.
    pub fn framed(self) -> (Self, Frame) {
        let v = self.surface.v().domain();
        let (root, tip) = (self.surface.point(self.middle, v.0), self.surface.point(self.middle, v.1));
        let normal = self.surface.point_at(self.middle, 0.5 * (v.0 + v.1)).normal.unwrap_or(DVec3::Z);
        let frame = Frame::looking(root, tip - root, normal);
        let surface = self.surface.moved(|p| frame.localise(p));
        let rim = self.rim.into_iter().map(|r| RimPoint { place: frame.localise(r.place), ..r }).collect();
        (Self { surface, rim, veins: self.veins.moved(|p| frame.localise(p)), ..self }, frame)
    }

    /// Returns the parameters of the grid with `steps` parts per span of marks along v: u of the columns, v of the
    /// rows.
    ///
    /// Marks of chief veins that start together are denser across than along: they get half as many parts.
    pub fn grid_at(&self, steps: usize) -> (Vec<f64>, Vec<f64>) {
        let across = if self.chart == Chart::Unrolled { steps } else { steps / 2 };
        (subdivided(self.surface.columns_at(), across), subdivided(self.surface.rows_at(), steps))
    }

    /// Lays the blade flat, with `steps` parts between marks.
    pub fn flat(&self, steps: usize) -> FlatLeaf {
        let steps = steps.clamp(1, 64);
        let (us, vs) = self.grid_at(steps);
        let flat = FlatLeaf::from_grid(&self.surface.grid(&us, &vs), us.len(), steps);
        let rim = self.flat_rim(&flat, &us, &vs);
        flat.within(rim)
    }

    /// Returns the points at its marks.
    pub(crate) fn marks(&self) -> Vec<DVec3> {
        let grid = self.surface.grid(self.surface.columns_at(), self.surface.rows_at());
        grid.iter().map(|p: &SurfacePoint| p.position).collect()
    }

    /// Returns the straight distance from the root to the tip, metres.
    pub fn reach(&self) -> f64 {
        let (a, b) = self.surface.v().domain();
        self.surface.point(self.middle, a).distance(self.surface.point(self.middle, b))
    }

    /// Returns the length along the midrib, metres.
    pub fn length(&self) -> f64 {
        let (_, vs) = self.grid_at(4);
        let line: Vec<DVec3> = vs.iter().map(|&v| self.surface.point(self.middle, v)).collect();
        geom::polyline_length3(&line)
    }

    /// Returns the area of one side, metres squared; to about a per cent.
    pub fn area_m2(&self) -> f64 {
        if let Some(net) = self.netted(2) {
            return area(&net.points, net.triangles.into_iter());
        }
        let (us, vs) = self.grid_at(2);
        let points: Vec<DVec3> = self.surface.grid(&us, &vs).iter().map(|p| p.position).collect();
        let veins = Venation::default();
        let sheet = Sheet { points, across: us, along: vs, colors: vec![], veins, form: None };
        area(&sheet.points, sheet.triangles())
    }

    pub(crate) fn sound(&self) -> bool {
        let veins = self.veins.all().all(|v| v.marks.len() >= 2 && v.marks.iter().all(|m| m.is_finite()));
        let rim = self.rim.iter().all(|r| r.place.is_finite() && r.u.is_finite() && r.v.is_finite());
        veins && rim && self.middle.is_finite() && self.marks().iter().all(|p| p.is_finite())
    }
}

impl Sheet {
    /// Returns the sheet in its own frame, and the frame, of a sheet that was measured in the plant's coordinates.
    /// `None` for fewer than two rows or columns.
    pub fn framed(mut self) -> Option<(Self, Frame)> {
        let (columns, rows) = (self.across.len(), self.along.len());
        if columns < 2 || rows < 2 || self.points.len() != columns * rows {
            return None;
        }
        let at = |i: usize, j: usize| self.points[i * columns + j];
        // The middle of an even number of columns lies between two.
        let middle = |i: usize| 0.5 * (at(i, (columns - 1) / 2) + at(i, columns / 2));
        let (root, tip) = (middle(0), middle(rows - 1));
        let half = rows / 2;
        let wide = at(half, 0) - at(half, columns - 1);
        let frame = Frame::looking(root, tip - root, wide.cross(tip - root));
        self.points.iter_mut().for_each(|p| *p = frame.localise(*p));
        self.veins = self.veins.moved(|p| frame.localise(p));
        Some((self, frame))
    }

    /// Iterates over the two triangles of each cell, counter-clockwise seen from the upper side.
    pub fn triangles(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        let columns = self.across.len();
        let cell = move |k: usize| {
            let a = k / (columns - 1) * columns + k % (columns - 1);
            [[a, a + columns, a + 1], [a + 1, a + columns, a + columns + 1]]
        };
        let cells = columns.saturating_sub(1) * self.along.len().saturating_sub(1);
        (0..cells).flat_map(cell)
    }

    /// Returns the straight distance from the root to the middle of the last row, metres.
    pub fn reach(&self) -> f64 {
        let columns = self.across.len();
        self.points.len().checked_sub(columns).map_or(0.0, |last| self.points[last + columns / 2].length())
    }

    pub(crate) fn sound(&self) -> bool {
        let n = self.points.len();
        let grid = self.across.len() >= 2 && self.along.len() >= 2;
        let full = n == self.across.len() * self.along.len() && [0, n].contains(&self.colors.len());
        grid && full && self.points.iter().all(|p| p.is_finite())
    }
}

/// Returns the area of a blade given as points and triangles.
pub(crate) fn area(points: &[DVec3], triangles: impl Iterator<Item = [usize; 3]>) -> f64 {
    let of = |t: [usize; 3]| {
        let [a, b, c] = t.map(|k| points[k]);
        (b - a).cross(c - a).length() / 2.0
    };
    triangles.map(of).fold(0.0, |sum, a| sum + a)
}

impl Digestible for Vein {
    fn digest(&self, d: &mut Digest) {
        d.add(self.curve.basis().knots()).add(&(self.curve.controls().len() as u64));
        for ball in self.curve.controls() {
            d.add(&ball.centre).add(&ball.radius);
        }
        d.add(&self.curve.weights().map(<[f64]>::to_vec)).add(&self.marks);
    }
}

impl Digestible for Venation {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.veins).add(&self.fine).add(&self.margins);
    }
}

impl Digestible for SplineBlade {
    fn digest(&self, d: &mut Digest) {
        let s = &self.surface;
        d.add(s.u().knots()).add(s.v().knots()).add(s.controls()).add(&s.weights().map(<[f64]>::to_vec));
        d.add(s.columns_at()).add(s.rows_at());
        d.add(&self.middle).add(&self.veins).add(&self.form);
        if !self.rim.is_empty() {
            d.add(&self.rim);
        }
        match self.chart {
            Chart::Unrolled => {
                d.add(&0_u8);
            }
            Chart::Parameters(VeinShade { vein, blade, reach_m }) => {
                d.add(&1_u8).add(&vein).add(&blade).add(&reach_m);
            }
        }
    }
}

impl Digestible for Sheet {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.points).add(&self.across).add(&self.along).add(&self.colors).add(&self.veins);
        if let Some(form) = self.form {
            d.add(&form);
        }
    }
}

impl Digestible for RimPoint {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.u).add(&self.v).add(&self.place);
    }
}
