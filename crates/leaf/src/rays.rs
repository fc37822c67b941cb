//! Leaves whose chief veins start together: palmate (maple) and parallel (grass, lily).
//!
//! `Rays -> RayLeaf { blade, veins } -> LeafMesh`

use base::ops;
use geom::{NaturalCubic, SplineError, SplineSurface, subdivided};
use glam::DVec3;
use plant::{Chart, SplineBlade, Vein, VeinShade, Venation};

use crate::thickness::ThicknessRule;

/// Lines of marks that all run from the base of the leaf towards its margin.
///
/// A ray with thickness is a vein, one without only marks the position of the blade: a notch between lobes, or a
/// margin. Guaranteed by the constructors: the same marks on every ray, first and last ray on the margin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rays {
    /// The rays from right to left seen on the upper side with the tip up, at least 3.
    pub rays: Vec<ChiefVein>,
}

/// One line of marks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChiefVein {
    /// Points from the base outwards, metres; as many as on every other ray, at least 3.
    pub points: Vec<DVec3>,
    /// Thickness of the vein at each point, metres, above 0; all `None` if the ray is not a vein.
    pub thickness: Vec<Option<f64>>,
}

/// Reason why rays cannot make a leaf. Rays and marks are counted from 1, as in the file.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RaysError {
    /// There are too few rays or marks for a surface.
    #[error(
        "{rays} veins of {marks} marks are too few for a blade; it needs 3 lines of 3 marks, margins counted"
    )]
    TooFew {
        /// Number of rays.
        rays: usize,
        /// Number of marks on the first ray.
        marks: usize,
    },
    /// Rays have different numbers of marks.
    #[error("vein {ray} has {got} marks, vein 1 has {wanted}; put as many on each")]
    Unequal {
        /// Number of the chief vein, from 1.
        ray: usize,
        /// Number of its marks.
        got: usize,
        /// Number of marks on the first.
        wanted: usize,
    },
    /// A coordinate is not a usable number.
    #[error("vein {ray}, mark {mark}: a coordinate is not a finite number; measure it again")]
    NotFinite {
        /// Number of the chief vein, from 1.
        ray: usize,
        /// Number of the mark, from 1.
        mark: usize,
    },
    /// A thickness is 0, negative or not a number.
    #[error(
        "vein {ray}, mark {mark}: a thickness must be above 0, not {value}; leave it empty if it was not measured"
    )]
    Thickness {
        /// Number of the chief vein, from 1.
        ray: usize,
        /// Number of the mark, from 1.
        mark: usize,
        /// The value given, metres.
        value: f64,
    },
    /// Two consecutive marks coincide.
    #[error("vein {ray}: marks {mark} and {next} are the same point; remove one of them", next = .mark + 1)]
    Repeated {
        /// Number of the chief vein, from 1.
        ray: usize,
        /// Number of the first of the two marks, from 1.
        mark: usize,
    },
    /// The ball to be moved does not exist.
    #[error(
        "there is no control ball {mark} on vein {ray}: the leaf has veins 1 to {rays} of marks 1 to {marks}"
    )]
    NoBall {
        /// The requested chief vein.
        ray: usize,
        /// The requested mark.
        mark: usize,
        /// Number of veins of the leaf.
        rays: usize,
        /// Number of marks on each.
        marks: usize,
    },
    /// No vein has a thickness.
    #[error("no vein has a thickness; measure it on at least one")]
    NoVein,
    /// The surface cannot be made.
    #[error(transparent)]
    Spline(#[from] SplineError),
}

/// A palmate leaf defined by a few numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmateSpec {
    /// Number of chief veins, one per lobe, 3 to 11, odd. Default 5.
    pub veins: u32,
    /// Length of the middle lobe from the base, metres, above 0. Default 0.1.
    pub length_m: f64,
    /// Depth of the notches, 0 (a round leaf) to 0.9. Default 0.5.
    pub depth: f64,
}

impl Default for PalmateSpec {
    fn default() -> Self {
        Self { veins: 5, length_m: 0.1, depth: 0.5 }
    }
}

/// A leaf of parallel veins defined by a few numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelSpec {
    /// Number of veins, 3 to 31, odd; the middle one is thicker. Default 9.
    pub veins: u32,
    /// Length, metres, above 0. Default 0.3.
    pub length_m: f64,
    /// Greatest width over length, 0.005 to 1. Default 0.09.
    pub width: f64,
}

impl Default for ParallelSpec {
    fn default() -> Self {
        Self { veins: 9, length_m: 0.3, width: 0.09 }
    }
}

/// Points on each ray of a made leaf, including the base.
const MADE_MARKS: usize = 9;

impl Rays {
    /// Makes a lobed leaf like a maple's, its base at the origin, middle lobe along +y, upper side towards +z.
    pub fn palmate(spec: &PalmateSpec) -> Self {
        let k = spec.veins.clamp(3, 11) | 1;
        let half = f64::from(k / 2);
        let depth = spec.depth.clamp(0.0, 0.9);
        // Lobes fan out to 58 degrees on either side if there are three, to 130 if there are many; outer lobes are
        // shorter.
        let fan = 1.02 + 1.25 * (1.0 - 1.0 / half);
        let lobe = |i: f64| {
            let out = (i - half) / half;
            (out * fan, spec.length_m * (1.0 - (0.28 + 0.1 * half).min(0.58) * out * out))
        };
        // Along a gap between lobes: share of the angle, and of the distance from notch to tip. Two teeth per side.
        let side = [
            (0.0, 1.0),
            (0.045, 0.87),
            (0.095, 0.72),
            (0.165, 0.75),
            (0.21, 0.5),
            (0.29, 0.38),
            (0.36, 0.36),
            (0.43, 0.12),
        ];
        let mut out = Self::default();
        let mut ray = |angle: f64, length: f64, vein: bool| {
            let (sin, cos) = ops::sin_cos(angle);
            let points = (0..MADE_MARKS).map(|m| {
                let t = m as f64 / (MADE_MARKS - 1) as f64;
                let r = length * t;
                // The blade droops slightly at its ends, and lies deeper along its veins.
                let bend = -0.9 * r * r / spec.length_m;
                let fold = if vein { -0.02 * spec.length_m * t * (1.0 - 0.7 * t) } else { 0.0 };
                DVec3::new(r * sin, r * cos, 0.25 * bend + fold)
            });
            let thickness = (0..MADE_MARKS).map(|m| {
                let t = m as f64 / (MADE_MARKS - 1) as f64;
                vein.then_some(0.016 * length * (1.0 - 0.85 * t))
            });
            out.rays.push(ChiefVein { points: points.collect(), thickness: thickness.collect() });
        };
        // From right (+x) to left. Beyond the outermost lobe the margin runs back to the stalk.
        let (edge, last) = lobe(f64::from(k - 1));
        let back = [(0.62, 0.34), (0.46, 0.46), (0.3, 0.55), (0.17, 0.68), (0.07, 0.8)];
        let room = core::f64::consts::PI - 0.12 - edge;
        let ends = |side: f64| back.map(|(a, r)| (side * (edge + a * room * 0.9), r * last));
        for (angle, length) in ends(1.0) {
            ray(angle, length, false);
        }
        for i in (0..k).rev() {
            let (angle, length) = lobe(f64::from(i));
            ray(angle, length, true);
            if i == 0 {
                break;
            }
            let (next, other) = lobe(f64::from(i - 1));
            let notch = (1.0 - depth) * length.min(other);
            for (share, up) in &side[1..] {
                ray(ops::lerp(angle, next, *share), notch + (length - notch) * up, false);
            }
            ray(ops::lerp(angle, next, 0.5), notch, false);
            for (share, up) in side[1..].iter().rev() {
                ray(ops::lerp(next, angle, *share), notch + (other - notch) * up, false);
            }
        }
        let mut left = ends(-1.0);
        left.reverse();
        for (angle, length) in left {
            ray(angle, length, false);
        }
        out
    }

    /// Makes a long leaf like a lily's or a grass's, its base at the origin, along +y, upper side towards +z.
    pub fn parallel(spec: &ParallelSpec) -> Self {
        let k = spec.veins.clamp(3, 31) | 1;
        let wide = 0.5 * spec.width.clamp(0.005, 1.0) * spec.length_m;
        let profile = |t: f64| {
            // Half as wide at the base, widest at two fifths, pointed.
            let rise = 0.5 + 0.5 * ops::sin(core::f64::consts::FRAC_PI_2 * (t / 0.4).min(1.0));
            let fall = if t > 0.4 { 1.0 - ops::powf((t - 0.4) / 0.6, 2.2) } else { 1.0 };
            wide * rise * fall
        };
        Self::side_by_side(k, MADE_MARKS + 4, wide, |t, s| {
            let x = s * profile(t);
            // Arching over, with a keel.
            let arch = -0.28 * spec.length_m * t * t;
            DVec3::new(x, spec.length_m * t * (1.0 - 0.08 * t * t), arch + 0.35 * x.abs())
        })
    }

    /// Makes `k` (odd) parallel veins and the two margins from right to left, through `marks` points each. `place` maps
    /// the share of the length from the base and of the half width (1 right margin, -1 left) to a point. `wide`: half
    /// of the greatest width, which sets the thickness, for the midrib rather more than double.
    pub(crate) fn side_by_side(k: u32, marks: usize, wide: f64, place: impl Fn(f64, f64) -> DVec3) -> Self {
        let ray = |j: u32| {
            let s = 1.0 - 2.0 * f64::from(j) / f64::from(k + 1);
            let middle = (s.abs() < 1e-9, (1..=k).contains(&j));
            let share = |m: usize| m as f64 / (marks - 1) as f64;
            let points = (0..marks).map(|m| place(share(m), s));
            let thickness = (0..marks).map(|m| {
                let base = if middle.0 { 0.11 } else { 0.05 };
                middle.1.then_some(wide * base * (1.0 - 0.8 * share(m)))
            });
            ChiefVein { points: points.collect(), thickness: thickness.collect() }
        };
        Self { rays: (0..k + 2).map(ray).collect() }
    }

    /// Iterates over all faults of the points and thicknesses.
    pub fn validate(&self) -> impl Iterator<Item = RaysError> + '_ {
        let marks = self.rays.first().map_or(0, |r| r.points.len());
        let few = self.rays.len() < 3 || marks < 3;
        let few = few.then_some(RaysError::TooFew { rays: self.rays.len(), marks });
        let none = !self.rays.iter().any(ChiefVein::is_vein);
        let each = self.rays.iter().enumerate().flat_map(move |(i, ray)| {
            let unequal = (ray.points.len() != marks || ray.thickness.len() != marks)
                .then_some(RaysError::Unequal { ray: i + 1, got: ray.points.len(), wanted: marks });
            let places = ray.points.iter().enumerate();
            let bad = places
                .filter(|(_, p)| !(p.is_finite() && p.abs().max_element() < 1e100))
                .map(move |(m, _)| RaysError::NotFinite { ray: i + 1, mark: m + 1 });
            let twice = ray.points.windows(2).enumerate();
            let twice = twice
                .filter(|(_, w)| w[0] == w[1])
                .map(move |(m, _)| RaysError::Repeated { ray: i + 1, mark: m + 1 });
            let thin = ray.thickness.iter().enumerate().filter_map(move |(m, t)| {
                let value = t.filter(|&t| !(t > 0.0 && t < 1e100))?;
                Some(RaysError::Thickness { ray: i + 1, mark: m + 1, value })
            });
            unequal.into_iter().chain(bad).chain(twice).chain(thin)
        });
        few.into_iter().chain(each).chain(none.then_some(RaysError::NoVein))
    }

    /// Returns the same leaf with all lengths times `factor`.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        for ray in &mut self.rays {
            ray.points.iter_mut().for_each(|p| *p *= factor);
            ray.thickness.iter_mut().flatten().for_each(|t| *t *= factor);
        }
        self
    }

    /// Returns the length of the middle vein, or of the middle ray if there is none, by its chords.
    pub fn length(&self) -> f64 {
        let veins: Vec<&ChiefVein> = self.rays.iter().filter(|r| r.is_vein()).collect();
        let middle = veins.get(veins.len() / 2).copied().or_else(|| self.rays.get(self.rays.len() / 2));
        middle.map_or(0.0, |r| geom::polyline_length3(&r.points))
    }
}

impl ChiefVein {
    /// Whether a thickness was measured on it.
    pub fn is_vein(&self) -> bool {
        self.thickness.iter().any(Option::is_some)
    }

    /// Returns every thickness, missing ones interpolated along the ray.
    fn full(&self) -> Vec<f64> {
        let mut way = vec![0.0];
        for w in self.points.windows(2) {
            way.push(way[way.len() - 1] + w[0].distance(w[1]));
        }
        crate::marks::spread(&way, &self.thickness).unwrap_or_else(|| vec![0.0; way.len()])
    }
}

/// A blade with its chief veins, all through the marks.
///
/// Guaranteed: every vein lies on the blade at every parameter, as it is a line of constant u of the same controls.
///
/// ```
/// use leaf::{PalmateSpec, RayLeaf, Rays, ThicknessRule};
/// let leaf = RayLeaf::new(&Rays::palmate(&PalmateSpec::default()), ThicknessRule::Diameter)?;
/// assert_eq!(leaf.veins.len(), 5);
/// assert!(leaf.vein_gap(8) < 1e-9);
/// # Ok::<(), leaf::RaysError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RayLeaf {
    /// The blade: u from left to right, v from the base outwards.
    pub blade: SplineSurface,
    /// The veins from left to right, each from the base outwards.
    pub veins: Vec<Vein>,
    /// The parameter u of each vein.
    pub at: Vec<f64>,
    /// Side veins of lobes, made by [`RayLeaf::add_side_veins`]; they lie on the blade at their marks.
    pub sides: Vec<Vein>,
}

impl RayLeaf {
    /// Fits an interpolating blade and veins through the marks. Cost: linear in the marks.
    ///
    /// # Errors
    /// The first fault of [`Rays::validate`], or [`RaysError::Spline`].
    pub fn new(rays: &Rays, thickness: ThicknessRule) -> Result<Self, RaysError> {
        if let Some(fault) = rays.validate().next() {
            return Err(fault);
        }
        let radius = match thickness {
            ThicknessRule::Diameter => 0.5,
            ThicknessRule::Radius => 1.0,
        };
        let marks = rays.rays[0].points.len();
        let from_left = || rays.rays.iter().rev();
        let grid: Vec<DVec3> = (0..marks).flat_map(|m| from_left().map(move |r| r.points[m])).collect();
        let blade = SplineSurface::interpolate(&grid, rays.rays.len())?;
        let along = NaturalCubic::new(blade.rows_at())?;
        let mut out = Self { veins: vec![], at: vec![], sides: vec![], blade };
        for (ray, &u) in from_left().zip(out.blade.columns_at()) {
            if ray.is_vein() {
                let radii: Vec<f64> = ray.full().into_iter().map(|t| t * radius).collect();
                let curve = out.blade.column_vein(u, &along.controls(&radii)?)?;
                out.veins.push(Vein { curve, marks: out.blade.rows_at().to_vec() });
                out.at.push(u);
            }
        }
        Ok(out)
    }

    /// Returns the greatest distance of any vein's centre line from the blade, metres, at `steps` parameters per span.
    pub fn vein_gap(&self, steps: usize) -> f64 {
        let mut gap: f64 = 0.0;
        for (vein, &u) in self.veins.iter().zip(&self.at) {
            for t in subdivided(&vein.marks, steps) {
                gap = gap.max(vein.curve.ball(t).centre.distance(self.blade.point(u, t)));
            }
        }
        gap
    }

    /// Returns the leaf as a shape of a plant, in its measured place, in these colours.
    pub fn blade(&self, shade: VeinShade) -> SplineBlade {
        let (a, b) = self.blade.u().domain();
        let veins = Venation { veins: self.veins.clone(), fine: self.sides.clone(), margins: Vec::new() };
        let (surface, chart) = (self.blade.clone(), Chart::Parameters(shade));
        SplineBlade { surface, rim: Vec::new(), middle: 0.5 * (a + b), veins, chart, form: 0 }
    }
}

base::coded!(RaysError {
    Self::TooFew { rays, marks } => "veins-too-few" { rays, marks },
    Self::Unequal { ray, got, wanted } => "veins-unequal" { ray, got, wanted },
    Self::NotFinite { ray, mark } => "veins-not-finite" { ray, mark },
    Self::Thickness { ray, mark, value } => "veins-thickness" { ray, mark, value },
    Self::Repeated { ray, mark } => "veins-repeated" { ray, mark },
    Self::NoBall { ray, mark, rays, marks } => "veins-ball-none" { ray, mark, rays, marks },
    Self::NoVein => "veins-none" {},
} wraps {
    Self::Spline(e) => e, SplineError;
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn veins_lie_on_the_blade_and_pass_through_their_marks() {
        for rays in [
            Rays::palmate(&PalmateSpec { veins: 7, ..PalmateSpec::default() }),
            Rays::palmate(&PalmateSpec { veins: 3, depth: 0.2, ..PalmateSpec::default() }),
            Rays::parallel(&ParallelSpec::default()),
        ] {
            assert_eq!(rays.validate().next(), None);
            let leaf = RayLeaf::new(&rays, ThicknessRule::Diameter).unwrap();
            assert!(leaf.vein_gap(16) < 1e-9, "{}", leaf.vein_gap(16));
            let veins: Vec<&ChiefVein> = rays.rays.iter().rev().filter(|r| r.is_vein()).collect();
            assert_eq!(leaf.veins.len(), veins.len());
            for (vein, ray) in leaf.veins.iter().zip(veins) {
                for (m, (&t, p)) in vein.marks.iter().zip(&ray.points).enumerate() {
                    let ball = vein.curve.ball(t);
                    assert!(ball.centre.distance(*p) < 1e-12, "mark {m}");
                    assert!((2.0 * ball.radius - ray.thickness[m].unwrap()).abs() < 1e-12, "mark {m}");
                }
            }
        }
    }

    #[test]
    fn what_is_wrong_is_told() {
        let good = Rays::parallel(&ParallelSpec { veins: 3, ..ParallelSpec::default() });
        let with = |change: &dyn Fn(&mut Rays)| {
            let mut rays = good.clone();
            change(&mut rays);
            RayLeaf::new(&rays, ThicknessRule::Diameter).map(drop).unwrap_err()
        };
        assert_eq!(with(&|r| r.rays.truncate(2)), RaysError::TooFew { rays: 2, marks: 13 });
        assert!(matches!(
            with(&|r| r.rays[1].points.truncate(12)),
            RaysError::Unequal { ray: 2, got: 12, .. }
        ));
        assert_eq!(with(&|r| r.rays[2].points[3].x = f64::NAN), RaysError::NotFinite { ray: 3, mark: 4 });
        assert!(matches!(
            with(&|r| r.rays[1].thickness[2] = Some(0.0)),
            RaysError::Thickness { mark: 3, .. }
        ));
        assert_eq!(
            with(&|r| r.rays[1].points[5] = r.rays[1].points[4]),
            RaysError::Repeated { ray: 2, mark: 5 }
        );
        let bare = |r: &mut Rays| r.rays.iter_mut().for_each(|r| r.thickness.fill(None));
        assert_eq!(with(&bare), RaysError::NoVein);
    }
}
