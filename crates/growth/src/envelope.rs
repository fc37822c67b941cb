//! Crown envelopes and the attraction points scattered in them.
//!
//! `Envelope -> Region -> attractors`

use std::sync::Arc;

use base::{Draw, Seed};
use geom::{KdTree, contains};
use glam::{DVec2, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{FAR_M, GrowthError, usable, within};
use crate::limbs::{Drawn, LimbsSpec};
use crate::solid::Solid;
use crate::variation::{Habit, VariationSpec};

/// The space that a crown may fill. Metres, +Y up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "shape", rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Envelope {
    /// A ball.
    Sphere {
        /// Its centre.
        #[schemars(with = "[f64; 3]", inner(range(min = -1e6, max = 1e6)), extend("x-unit" = "m"))]
        centre: DVec3,
        /// Its radius, above 0.
        #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
        radius_m: f64,
    },
    /// A ball stretched along the axes.
    Ellipsoid {
        /// Its centre.
        #[schemars(with = "[f64; 3]", inner(range(min = -1e6, max = 1e6)), extend("x-unit" = "m"))]
        centre: DVec3,
        /// Half its extents, each above 0.
        #[schemars(with = "[f64; 3]", inner(range(min = 1e-6, max = 1e6)), extend("x-unit" = "m"))]
        radii_m: DVec3,
    },
    /// An upright cone, its point up.
    Cone {
        /// Centre of its base.
        #[schemars(with = "[f64; 3]", inner(range(min = -1e6, max = 1e6)), extend("x-unit" = "m"))]
        base: DVec3,
        /// Radius of its base, above 0.
        #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
        radius_m: f64,
        /// Its height, above 0.
        #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
        height_m: f64,
    },
    /// An upright cylinder.
    Cylinder {
        /// Centre of its base.
        #[schemars(with = "[f64; 3]", inner(range(min = -1e6, max = 1e6)), extend("x-unit" = "m"))]
        base: DVec3,
        /// Its radius, above 0.
        #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
        radius_m: f64,
        /// Its height, above 0.
        #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
        height_m: f64,
    },
    /// A surface of revolution about the vertical through `base`.
    Revolution {
        /// Origin of the heights of the profile.
        #[schemars(with = "[f64; 3]", inner(range(min = -1e6, max = 1e6)), extend("x-unit" = "m"))]
        base: DVec3,
        /// `(radius, height)`, at least 2 points, heights rising, radii 0 or more.
        #[schemars(with = "Vec<[f64; 2]>", extend("x-unit" = "m"))]
        profile: Vec<DVec2>,
    },
    /// A closed outline drawn in the plane z = `centre_z`; across the plane each height is as deep as it is wide.
    Outline {
        /// The outline, at least 3 points.
        #[schemars(with = "Vec<[f64; 2]>", inner(inner(range(min = -1e6, max = 1e6))), extend("x-unit" = "m"))]
        polygon: Vec<DVec2>,
        /// The plane of the drawing.
        #[schemars(range(min = -1000000.0, max = 1e6), extend("x-unit" = "m"))]
        centre_z_m: f64,
        /// Depth over width, above 0; 1 gives round sections.
        #[schemars(range(min = 0.001, max = 1000.0))]
        depth: f64,
    },
    /// A closed mesh. Small holes and inverted faces are tolerated (winding number).
    Mesh {
        /// Vertices.
        #[schemars(with = "Vec<[f64; 3]>", extend("x-unit" = "m"))]
        vertices: Vec<DVec3>,
        /// Corners of each triangle.
        triangles: Vec<[u32; 3]>,
    },
    /// A cloud of points: the space within `reach_m` of any of them.
    Points {
        /// The points, at least one of them usable.
        #[schemars(with = "Vec<[f64; 3]>", extend("x-unit" = "m"))]
        points: Vec<DVec3>,
        /// Distance from a point up to which the space counts, above 0.
        #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
        reach_m: f64,
    },
    /// Masses of foliage on limbs, drawn anew for each seed.
    Limbs(LimbsSpec),
}

spec::schemas!(Envelope => crate::TreeSpec, "/$defs/Envelope");

impl Default for Envelope {
    /// Returns the crown of a young broadleaf tree: a ball of 2 m radius, its middle 4 m above the ground.
    fn default() -> Self {
        Self::Sphere { centre: DVec3::new(0.0, 4.0, 0.0), radius_m: 2.0 }
    }
}

/// An envelope prepared for queries.
///
/// ```
/// use glam::DVec3;
/// use growth::Envelope;
/// let crown = Envelope::Cone { base: DVec3::ZERO, radius_m: 1.0, height_m: 3.0 }.prepare()?;
/// assert!(crown.contains(DVec3::new(0.3, 1.5, 0.3)) && !crown.contains(DVec3::new(0.5, 2.5, 0.0)));
/// let points = crown.scatter(100, 0.0, base::Seed::new(1), |_| true)?;
/// assert!(points.len() == 100 && points.iter().all(|&p| crown.contains(p)));
/// # Ok::<(), growth::GrowthError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Region {
    form: Arc<Form>,
    lo: DVec3,
    hi: DVec3,
    /// Habit of the tree, if it differs from the drawn envelope.
    habit: Option<Habit>,
    /// Factor on the room of the drawn envelope.
    more: f64,
}

#[derive(Clone, Debug)]
enum Form {
    Ellipsoid(DVec3, DVec3),
    Revolution(DVec3, Vec<DVec2>),
    Outline(Vec<DVec2>, f64, f64),
    Mesh(Solid),
    Points(KdTree, f64),
    /// Flattened by the last number, so that the masses are balls.
    Masses(KdTree, f64, f64),
}

/// The room of one tree, relative to its root.
#[derive(Clone, Debug)]
pub(crate) struct Crown {
    pub(crate) region: Region,
    /// Points along trunk and limbs, which the tree grows first.
    pub(crate) lines: Vec<DVec3>,
}

/// Returns the room of each root's tree: one for all if they do not differ. `step`: of growth.
pub(crate) fn crowns(
    envelope: &Envelope,
    variation: &VariationSpec,
    roots: usize,
    step: f64,
    seed: Seed,
) -> Result<Vec<Crown>, GrowthError> {
    if let Envelope::Limbs(limbs) = envelope {
        spec::check(envelope)?;
        check_profile(&limbs.profile)?;
        let crown = |root| limbs_crown(limbs, &variation.habit(seed, root), step);
        return Ok((0..roots as u64).map(crown).collect());
    }
    let region = envelope.prepare()?;
    if variation.is_none() {
        return Ok(vec![Crown { region, lines: Vec::new() }]);
    }
    let crown = |root| Crown { region: region.with_habit(variation.habit(seed, root)), lines: Vec::new() };
    Ok((0..roots as u64).map(crown).collect())
}

fn limbs_crown(limbs: &LimbsSpec, habit: &Habit, step: f64) -> Crown {
    let Drawn { masses, lines } = limbs.draw(habit, step);
    let (reach, flat) = (limbs.mass_m, limbs.flat);
    let size = DVec3::new(reach, reach * flat, reach);
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (lo, hi) = masses.iter().fold(start, |(lo, hi), p| (lo.min(*p - size), hi.max(*p + size)));
    let flattened: Vec<DVec3> = masses.iter().map(|p| p.with_y(p.y / flat)).collect();
    let form = Arc::new(Form::Masses(KdTree::new(&flattened), reach, flat));
    Crown { region: Region { form, lo, hi, habit: None, more: habit.volume() }, lines }
}

impl Envelope {
    /// Checks the numbers and builds the tables for fast queries.
    ///
    /// Cost: linear in points, n log n in triangles.
    ///
    /// # Errors
    /// [`GrowthError::Range`] for numbers out of range, [`GrowthError::Field`] for invalid points and outlines,
    /// [`GrowthError::Mesh`] for a mesh without volume.
    pub fn prepare(&self) -> Result<Region, GrowthError> {
        spec::check(self)?;
        let form = match self {
            Self::Sphere { centre, radius_m } => Form::Ellipsoid(*centre, DVec3::splat(*radius_m)),
            Self::Ellipsoid { centre, radii_m } => Form::Ellipsoid(*centre, *radii_m),
            Self::Cone { base, radius_m, height_m } => {
                let (r, h) = (*radius_m, *height_m);
                Form::Revolution(*base, vec![DVec2::new(r, 0.0), DVec2::new(0.0, h)])
            }
            Self::Cylinder { base, radius_m, height_m } => {
                let (r, h) = (*radius_m, *height_m);
                Form::Revolution(*base, vec![DVec2::new(r, 0.0), DVec2::new(r, h)])
            }
            Self::Revolution { base, profile } => {
                check_profile(profile)?;
                Form::Revolution(*base, profile.clone())
            }
            Self::Outline { polygon, centre_z_m, depth } => {
                // Each scattered point is tested against each point of the outline.
                within("points of envelope.polygon", polygon.len() as f64, 3.0, 1e4, "3 to 10,000")?;
                if polygon.len() < 3 || geom::signed_area(polygon).abs() < 1e-9 {
                    let value = geom::signed_area(polygon);
                    return Err(GrowthError::Field {
                        field: "envelope.polygon",
                        range: "an outline with an area",
                        value,
                    });
                }
                Form::Outline(polygon.clone(), *centre_z_m, *depth)
            }
            Self::Mesh { vertices, triangles } => Form::Mesh(Solid::new(vertices, triangles)?),
            Self::Points { points, reach_m } => {
                let good: Vec<DVec3> = points.iter().copied().filter(|&p| usable(p)).collect();
                if good.is_empty() {
                    return Err(GrowthError::Field {
                        field: "envelope.points",
                        range: "at least one finite point",
                        value: 0.0,
                    });
                }
                Form::Points(KdTree::new(&good), *reach_m)
            }
            Self::Limbs(limbs) => {
                check_profile(&limbs.profile)?;
                // As drawn by the first seed; growth uses each tree's own.
                let habit = VariationSpec::default().habit(Seed::new(0), 0);
                return Ok(limbs_crown(limbs, &habit, limbs.mass_m).region);
            }
        };
        let (lo, hi) = self.bounds(&form);
        Ok(Region { form: Arc::new(form), lo, hi, habit: None, more: 1.0 })
    }

    /// Returns the space that it fills as a whole: masses on limbs become their enclosing profile. For growth that
    /// finds limbs itself.
    #[must_use]
    pub fn whole(&self) -> Self {
        match self {
            Self::Limbs(l) => {
                Self::Revolution { base: DVec3::new(0.0, l.base_m, 0.0), profile: l.profile.clone() }
            }
            other => other.clone(),
        }
    }

    fn bounds(&self, form: &Form) -> (DVec3, DVec3) {
        let of = |points: &mut dyn Iterator<Item = DVec3>| {
            points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)))
        };
        match (form, self) {
            (Form::Ellipsoid(c, r), _) => (*c - *r, *c + *r),
            (Form::Revolution(base, profile), _) => {
                let r = profile.iter().map(|p| p.x).fold(0.0, f64::max);
                let (low, high) = (profile[0].y, profile[profile.len() - 1].y);
                (*base + DVec3::new(-r, low, -r), *base + DVec3::new(r, high, r))
            }
            (Form::Outline(polygon, z, depth), _) => {
                let (lo, hi) = of(&mut polygon.iter().map(|p| p.extend(0.0)));
                let half = 0.5 * (hi.x - lo.x) * depth;
                (lo.with_z(z - half), hi.with_z(z + half))
            }
            (Form::Mesh(solid), _) => solid.bounds(),
            (Form::Points(_, reach), Self::Points { points, .. }) => {
                let (lo, hi) = of(&mut points.iter().copied().filter(|&p| usable(p)));
                (lo - *reach, hi + *reach)
            }
            (Form::Points(..) | Form::Masses(..), _) => (DVec3::ZERO, DVec3::ZERO),
        }
    }
}

fn check_profile(profile: &[DVec2]) -> Result<(), GrowthError> {
    let fault = |range, value| Err(GrowthError::Field { field: "envelope.profile", range, value });
    if profile.len() < 2 {
        return fault("at least 2 points (radius, height)", profile.len() as f64);
    }
    for p in profile {
        within("envelope.profile", p.x, 0.0, FAR_M, "radii from 0 to 1e6 m")?;
        within("envelope.profile", p.y, -FAR_M, FAR_M, "heights within 1e6 m")?;
    }
    if let Some(w) = profile.windows(2).find(|w| w[1].y <= w[0].y) {
        return fault("heights that rise", w[1].y);
    }
    if profile.iter().all(|p| p.x <= 0.0) {
        return fault("a radius above 0", 0.0);
    }
    Ok(())
}

impl Region {
    /// Returns the same region for a tree with another habit.
    pub(crate) fn with_habit(&self, habit: Habit) -> Self {
        let (lo, hi) = habit.around(self.lo, self.hi);
        let more = habit.volume();
        Self { form: Arc::clone(&self.form), lo, hi, habit: Some(habit), more }
    }

    /// Whether a point lies in the envelope (points on its surface may count either way).
    #[inline]
    pub fn contains(&self, p: DVec3) -> bool {
        if !(p.cmpge(self.lo).all() && p.cmple(self.hi).all()) {
            return false;
        }
        match (&*self.form, &self.habit) {
            (Form::Ellipsoid(centre, radii), None) => ((p - *centre) / *radii).length_squared() <= 1.0,
            _ => self.holds(p),
        }
    }

    /// As [`contains`](Self::contains), for a point in the box around the envelope.
    fn holds(&self, p: DVec3) -> bool {
        let p = self.habit.as_ref().map_or(p, |h| h.back(p));
        match &*self.form {
            Form::Ellipsoid(centre, radii) => ((p - *centre) / *radii).length_squared() <= 1.0,
            Form::Revolution(base, profile) => {
                let q = p - *base;
                let above = profile.partition_point(|c| c.y <= q.y).clamp(1, profile.len() - 1);
                let (a, b) = (profile[above - 1], profile[above]);
                let r = a.x + (b.x - a.x) * ((q.y - a.y) / (b.y - a.y));
                q.x * q.x + q.z * q.z <= r * r
            }
            Form::Outline(polygon, centre_z, depth) => {
                let flat = p.truncate();
                contains(polygon, flat) && {
                    let (left, right) = chord(polygon, flat);
                    let half = 0.5 * (right - left) * depth;
                    let across = (p.x - 0.5 * (left + right)) / (0.5 * (right - left)).max(1e-12);
                    let deep = (p.z - centre_z) / half.max(1e-12);
                    across * across + deep * deep <= 1.0
                }
            }
            Form::Mesh(solid) => solid.inside(p),
            Form::Points(grid, reach) => grid.nearest(p, *reach).is_some(),
            Form::Masses(grid, reach, flat) => grid.nearest(p.with_y(p.y / flat), *reach).is_some(),
        }
    }

    /// Whether a ball certainly lies in the envelope; false also in some cases in which it does.
    pub(crate) fn contains_ball(&self, p: DVec3, radius: f64) -> bool {
        // Points on the surface may count either way.
        let radius = radius * (1.0 + 1e-9);
        if !((p - radius).cmpge(self.lo).all() && (p + radius).cmple(self.hi).all()) {
            return false;
        }
        if self.habit.is_some() {
            return false;
        }
        match &*self.form {
            Form::Ellipsoid(centre, radii) => {
                ((p - *centre) / *radii).length() + radius / radii.min_element() <= 1.0
            }
            Form::Revolution(base, profile) => {
                // As wide as the ball at each of its heights: at its ends, and where the profile bends between them.
                let q = p - *base;
                let wide = DVec2::new(q.x, q.z).length() + radius;
                let inside = |y: f64, r: f64| (y - q.y).abs() > radius || r >= wide;
                let fits = |w: &[DVec2]| {
                    let (a, b) = (w[0], w[1]);
                    let at = |y: f64| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
                    let mut ends =
                        [q.y - radius, q.y + radius].into_iter().filter(|y| a.y <= *y && *y <= b.y);
                    inside(a.y, a.x) && inside(b.y, b.x) && ends.all(|y| at(y) >= wide)
                };
                profile.windows(2).all(fits)
            }
            Form::Outline(..) | Form::Mesh(_) | Form::Points(..) | Form::Masses(..) => false,
        }
    }

    /// Returns the lower and upper corner of the box around the envelope.
    pub const fn bounds(&self) -> (DVec3, DVec3) {
        (self.lo, self.hi)
    }

    /// Returns the height above the origin at which the envelope begins, metres; 0 if it contains the origin or nothing
    /// is above it.
    pub(crate) fn foot(&self) -> f64 {
        if self.contains(DVec3::ZERO) {
            return 0.0;
        }
        // A hundredth of its height is fine enough for the end of a bole.
        let step = 0.01 * (self.hi.y - self.lo.y).max(1e-9);
        let mut y = self.lo.y.max(0.0);
        while y < self.hi.y && !self.contains(DVec3::Y * y) {
            y += step;
        }
        if y < self.hi.y { y } else { 0.0 }
    }

    /// Returns the number of points that makes this region as dense as `count` points make the drawn one; at least 1.
    pub(crate) fn count(&self, count: u32) -> usize {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few times a u32")]
        let count = (f64::from(count) * self.more).round().max(1.0) as usize;
        count
    }

    /// Scatters `count` points evenly at random in the envelope where `free` holds.
    ///
    /// `hollow`, 0 to 0.99: points that remain inside when moved away from the centre by `1 / hollow` are left out, so
    /// that only a shell is filled (Runions 2007, Fig 7); 0 fills all. Guaranteed: the first points do not depend on
    /// `count`. Cost: about `count` times box over envelope volume.
    ///
    /// # Errors
    /// [`GrowthError::NoRoom`] if fewer than all points find a place in 2000 + 200 `count` tries.
    pub fn scatter(
        &self,
        count: usize,
        hollow: f64,
        seed: Seed,
        free: impl Fn(DVec3) -> bool,
    ) -> Result<Vec<DVec3>, GrowthError> {
        let hollow = if hollow.is_finite() { hollow.clamp(0.0, 0.99) } else { 0.0 };
        let middle = (self.lo + self.hi) * 0.5;
        let shell = |p: DVec3| hollow <= 0.0 || !self.contains(middle + (p - middle) / hollow);
        let mut stream = seed.stream(Draw::Attractors);
        let tries = count.saturating_mul(200).saturating_add(2000);
        let mut points = Vec::with_capacity(count.min(1 << 24));
        for tried in 0..tries {
            if points.len() >= count {
                break;
            }
            // At half the required rate, and eleven standard deviations away from it, the remaining tries are wasted.
            if tried == 100_000 && points.len() < 250 {
                return Err(GrowthError::NoRoom { found: points.len(), wanted: count, tries: tried });
            }
            let u = DVec3::new(stream.uniform(), stream.uniform(), stream.uniform());
            let p = self.lo + (self.hi - self.lo) * u;
            if self.contains(p) && shell(p) && free(p) {
                points.push(p);
            }
        }
        if points.len() < count {
            return Err(GrowthError::NoRoom { found: points.len(), wanted: count, tries });
        }
        Ok(points)
    }
}

/// Returns where the horizontal through an inner point leaves the outline, left and right.
fn chord(polygon: &[DVec2], p: DVec2) -> (f64, f64) {
    let (mut left, mut right) = (f64::NEG_INFINITY, f64::INFINITY);
    for i in 0..polygon.len() {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        if (a.y > p.y) != (b.y > p.y) {
            let x = a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y));
            if x <= p.x {
                left = left.max(x);
            } else {
                right = right.min(x);
            }
        }
    }
    if left.is_finite() && right.is_finite() { (left, right) } else { (p.x, p.x) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::tests::sphere;

    fn volume(e: &Envelope) -> f64 {
        let region = e.prepare().expect("sound");
        let (lo, hi) = region.bounds();
        let mut s = Seed::new(7).stream(Draw::Test);
        let n = 40_000;
        let hits = (0..n).filter(|_| {
            let u = DVec3::new(s.uniform(), s.uniform(), s.uniform());
            region.contains(lo + (hi - lo) * u)
        });
        let size = hi - lo;
        size.x * size.y * size.z * hits.count() as f64 / f64::from(n)
    }

    #[test]
    fn what_is_said_to_hold_a_ball_holds_all_of_it() {
        let at = DVec3::new(3.0, 5.0, -2.0);
        let waisted = [(0.2, 0.0), (1.0, 0.6), (0.3, 1.4), (0.9, 1.9), (0.9, 2.4), (0.0, 3.0)];
        let forms = [
            Envelope::Sphere { centre: at, radius_m: 1.0 },
            Envelope::Ellipsoid { centre: at, radii_m: DVec3::new(1.0, 2.0, 0.6) },
            Envelope::Cone { base: at, radius_m: 1.0, height_m: 3.0 },
            Envelope::Cylinder { base: at, radius_m: 2.0, height_m: 1.0 },
            Envelope::Revolution { base: at, profile: waisted.map(|(x, y)| DVec2::new(x, y)).to_vec() },
        ];
        let mut s = Seed::new(3).stream(Draw::Test);
        for e in forms {
            let region = e.prepare().expect("sound");
            let (lo, hi) = region.bounds();
            let (mut said, mut held) = (0, 0);
            for _ in 0..4000 {
                let p = lo + (hi - lo) * DVec3::new(s.uniform(), s.uniform(), s.uniform());
                let radius = 0.4 * s.uniform();
                let mut near = (0..60).map(|_| {
                    let way = DVec3::new(s.normal(), s.normal(), s.normal()).normalize_or(DVec3::Y);
                    p + way * radius
                });
                let holds = near.all(|q| region.contains(q));
                held += u32::from(holds);
                if region.contains_ball(p, radius) {
                    said += 1;
                    assert!(holds && region.contains(p), "{e:?}: {radius} about {p}");
                }
            }
            // For most balls that lie inside, this is detected.
            assert!(said * 2 > held && said > 100, "{e:?}: {said} of {held}");
        }
    }

    #[test]
    fn volumes_are_those_of_the_solids() {
        let ball = 4.0 / 3.0 * base::ops::PI;
        let (vertices, triangles) = sphere(24, 32);
        let circle: Vec<DVec2> =
            (0..64).map(|i| base::turn::direction(f64::from(i) * base::ops::TAU / 64.0)).collect();
        let half_circle: Vec<DVec2> = (0..=32)
            .map(|i| {
                let (s, c) = base::ops::sin_cos(base::ops::PI * f64::from(i) / 32.0);
                DVec2::new(s.max(0.0), -c)
            })
            .collect();
        let at = DVec3::new(3.0, 5.0, -2.0);
        let cases = [
            (Envelope::Sphere { centre: at, radius_m: 1.0 }, ball),
            (Envelope::Ellipsoid { centre: at, radii_m: DVec3::new(1.0, 2.0, 3.0) }, 6.0 * ball),
            (Envelope::Cone { base: at, radius_m: 1.0, height_m: 3.0 }, base::ops::PI),
            (Envelope::Cylinder { base: at, radius_m: 2.0, height_m: 0.5 }, 2.0 * base::ops::PI),
            (Envelope::Revolution { base: at, profile: half_circle }, ball),
            (Envelope::Outline { polygon: circle, centre_z_m: 4.0, depth: 1.0 }, ball),
            (Envelope::Mesh { vertices, triangles }, ball),
            (Envelope::Points { points: vec![at, at, DVec3::NAN], reach_m: 1.0 }, ball),
        ];
        for (e, want) in cases {
            let got = volume(&e);
            assert!((got / want - 1.0).abs() < 0.03, "{e:?}: {got}, not {want}");
        }
    }

    #[test]
    fn scatter_keeps_its_first_points_and_fills_only_the_shell_when_hollow() {
        let region = Envelope::default().prepare().expect("sound");
        let few = region.scatter(50, 0.0, Seed::new(1), |_| true).expect("room");
        let many = region.scatter(500, 0.0, Seed::new(1), |_| true).expect("room");
        assert_eq!(few[..], many[..50]);
        let shell = region.scatter(500, 0.8, Seed::new(1), |_| true).expect("room");
        let r = |p: &DVec3| p.distance(DVec3::new(0.0, 4.0, 0.0));
        assert!(shell.iter().all(|p| r(p) >= 1.6 - 1e-9 && r(p) <= 2.0));
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        let bad = [
            Envelope::Sphere { centre: DVec3::ZERO, radius_m: f64::NAN },
            Envelope::Sphere { centre: DVec3::NAN, radius_m: 1.0 },
            Envelope::Cone { base: DVec3::ZERO, radius_m: 1.0, height_m: 0.0 },
            Envelope::Revolution { base: DVec3::ZERO, profile: vec![DVec2::ONE] },
            Envelope::Revolution { base: DVec3::ZERO, profile: vec![DVec2::ONE, DVec2::X] },
            Envelope::Outline { polygon: vec![DVec2::ZERO; 5], centre_z_m: 0.0, depth: 1.0 },
            Envelope::Points { points: vec![DVec3::NAN], reach_m: 1.0 },
        ];
        for e in bad {
            assert!(matches!(e.prepare(), Err(GrowthError::Field { .. } | GrowthError::Range(_))), "{e:?}");
        }
        let region = Envelope::default().prepare().expect("sound");
        let none = region.scatter(5, 0.0, Seed::new(1), |_| false);
        assert_eq!(none, Err(GrowthError::NoRoom { found: 0, wanted: 5, tries: 3000 }));
    }

    #[test]
    fn an_envelope_is_read_back_from_its_file_form() {
        let e = Envelope::Cone { base: DVec3::ZERO, radius_m: 1.0, height_m: 3.0 };
        let text = serde_json::to_string(&e).expect("plain data");
        assert!(text.contains(r#""shape":"cone""#), "{text}");
        assert_eq!(serde_json::from_str::<Envelope>(&text).ok(), Some(e));
    }
}
