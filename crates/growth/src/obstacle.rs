//! Obstacles that a tree grows around.
//!
//! `Obstacle -> Obstacles -> steer, blocks, inside`

use std::sync::Arc;

use glam::DVec3;
use plant::Frame;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{FAR_M, GrowthError, usable, within};
use crate::solid::{Solid, segment_meets_box};

/// A solid thing. Metres, +Y up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "shape", rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Obstacle {
    /// A box along the axes.
    Box {
        /// Lower corner.
        #[schemars(with = "[f64; 3]", inner(range(min = -1e6, max = 1e6)), extend("x-unit" = "m"))]
        min: DVec3,
        /// Upper corner, above the lower one in each coordinate.
        #[schemars(with = "[f64; 3]", inner(range(min = -1e6, max = 1e6)), extend("x-unit" = "m"))]
        max: DVec3,
    },
    /// A ball.
    Sphere {
        /// Its centre.
        #[schemars(with = "[f64; 3]", inner(range(min = -1e6, max = 1e6)), extend("x-unit" = "m"))]
        centre: DVec3,
        /// Its radius, above 0.
        #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
        radius_m: f64,
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
    /// Everything behind a plane: a wall, a slope.
    Plane {
        /// Any point of the plane.
        #[schemars(with = "[f64; 3]", inner(range(min = -1e6, max = 1e6)), extend("x-unit" = "m"))]
        point: DVec3,
        /// Direction away from the solid side; any length above 0.
        #[schemars(with = "[f64; 3]")]
        normal: DVec3,
    },
    /// A mesh, in metres, +Y up; small holes and inverted faces are tolerated (winding number).
    Mesh {
        /// Vertices.
        #[schemars(with = "Vec<[f64; 3]>", extend("x-unit" = "m"))]
        vertices: Vec<DVec3>,
        /// Corners of each triangle.
        triangles: Vec<[u32; 3]>,
    },
}

impl Obstacle {
    /// Returns the obstacle moved by an offset.
    #[must_use]
    pub fn moved(&self, by: DVec3) -> Self {
        let mut new = self.clone();
        match &mut new {
            Self::Box { min, max } => (*min, *max) = (*min + by, *max + by),
            Self::Sphere { centre, .. } => *centre += by,
            Self::Cylinder { base, .. } => *base += by,
            Self::Plane { point, .. } => *point += by,
            Self::Mesh { vertices, .. } => vertices.iter_mut().for_each(|v| *v += by),
        }
        new
    }
}

spec::schemas!(Obstacle => crate::TreeSpec, "/$defs/Obstacle");

/// Obstacles prepared for queries. A clone shares them.
///
/// ```
/// use glam::DVec3;
/// use growth::{Obstacle, Obstacles};
/// let pillar = Obstacle::Cylinder { base: DVec3::ZERO, radius_m: 0.5, height_m: 3.0 };
/// let all = Obstacles::new(&[pillar], 0.1)?;
/// assert_eq!(all.inside(DVec3::new(0.2, 1.0, 0.0)), Some(0));
/// assert!(all.blocks(DVec3::new(-2.0, 1.0, 0.0), DVec3::new(2.0, 1.0, 0.0)));
/// assert!(!all.blocks(DVec3::new(-2.0, 4.0, 0.0), DVec3::new(2.0, 4.0, 0.0)));
/// # Ok::<(), growth::GrowthError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Obstacles {
    bodies: Arc<[Body]>,
    clearance_m: f64,
}

#[derive(Clone, Debug)]
enum Body {
    Box(DVec3, DVec3),
    Sphere(DVec3, f64),
    Cylinder(DVec3, f64, f64),
    Plane(DVec3, DVec3),
    Mesh(Solid),
}

impl Obstacle {
    /// Whether all its numbers are finite: only then can it be saved.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Box { min, max } => min.is_finite() && max.is_finite(),
            Self::Sphere { centre, radius_m } => centre.is_finite() && radius_m.is_finite(),
            Self::Cylinder { base, radius_m, height_m } => {
                base.is_finite() && radius_m.is_finite() && height_m.is_finite()
            }
            Self::Plane { point, normal } => point.is_finite() && normal.is_finite(),
            Self::Mesh { vertices, .. } => vertices.iter().all(|v| v.is_finite()),
        }
    }

    /// Returns the word of its shape in specs.
    pub const fn shape(&self) -> &'static str {
        match self {
            Self::Box { .. } => "box",
            Self::Sphere { .. } => "sphere",
            Self::Cylinder { .. } => "cylinder",
            Self::Plane { .. } => "plane",
            Self::Mesh { .. } => "mesh",
        }
    }
}

fn called(shape: &str) -> String {
    format!("a {shape}")
}

impl Obstacles {
    /// Makes an empty set of obstacles.
    pub fn none() -> Self {
        Self::default()
    }

    /// Checks the numbers and prepares queries. `clearance_m`, 0 or more: nodes keep this distance from every surface.
    ///
    /// # Errors
    /// [`GrowthError::Field`] for the clearance; [`GrowthError::Obstacle`] for numbers out of range or a mesh without
    /// area, with the number of the obstacle.
    pub fn new(obstacles: &[Obstacle], clearance_m: f64) -> Result<Self, GrowthError> {
        within("obstacles.clearance_m", clearance_m, 0.0, FAR_M, "0 to 1e6 m")?;
        let body = |(obstacle, o): (usize, &Obstacle)| {
            let name = called(o.shape());
            Body::new(o).map_err(|fault| GrowthError::Obstacle { obstacle, name, fault: Box::new(fault) })
        };
        let bodies = obstacles.iter().enumerate().map(body).collect::<Result<Arc<[_]>, _>>()?;
        Ok(Self { bodies, clearance_m })
    }

    /// Returns the word of the shape of one of them.
    pub(crate) fn name(&self, obstacle: usize) -> String {
        called(match self.bodies.get(obstacle) {
            Some(Body::Box(..)) => "box",
            Some(Body::Sphere(..)) => "sphere",
            Some(Body::Cylinder(..)) => "cylinder",
            Some(Body::Plane(..)) => "plane",
            Some(Body::Mesh(_)) | None => "mesh",
        })
    }

    /// Whether there are no obstacles.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Returns the first obstacle in which a point lies, by index.
    pub fn inside(&self, p: DVec3) -> Option<usize> {
        self.bodies.iter().position(|b| b.inside(p))
    }

    /// Whether a point keeps the clearance from all obstacles.
    pub fn free(&self, p: DVec3) -> bool {
        self.bodies.iter().all(|b| b.clear(p, self.clearance_m * (1.0 - 1e-9)))
    }

    /// Whether an obstacle stands between two points, or one of them lies in it.
    pub fn blocks(&self, a: DVec3, b: DVec3) -> bool {
        self.bodies.iter().any(|body| body.blocks(a, b))
    }

    /// Returns the unit direction nearest to `wish` in which one step from `from` keeps clear of every obstacle: along
    /// the surface if the straight path leads into it. `None` if there is no way on.
    ///
    /// Guaranteed: the end of the step is `free` and visible from `from`.
    pub fn steer(&self, from: DVec3, wish: DVec3, step_m: f64) -> Option<DVec3> {
        let clear = |direction: DVec3| {
            let to = from + direction * step_m;
            self.free(to) && !self.blocks(from, to)
        };
        if clear(wish) {
            return Some(wish);
        }
        let here = self.nearest(from)?;
        let mut direction = wish;
        // Two walls that meet need two corrections, a corner three; only pathological cases need more.
        for round in 0..6 {
            // First along the surface, then away from whatever is still too near.
            let there = self.nearest(from + direction * step_m)?;
            let (distance, normal) = if round == 0 { (here.0, here.1) } else { there };
            let short = (self.clearance_m - distance.min(there.0)).max(0.0);
            let mut along = direction - normal * direction.dot(normal).min(0.0);
            if along.length() < 0.05 {
                // Head on: upwards along the surface if it rises, otherwise in any direction along it.
                along = DVec3::Y - normal * normal.y;
                if along.length() < 0.05 {
                    along = normal.any_orthonormal_vector();
                }
            }
            let push = if round == 0 { 0.0 } else { short / step_m * 1.02 };
            direction = (along.normalize_or_zero() + normal * (push + 1e-6)).try_normalize()?;
            if clear(direction) {
                return Some(direction);
            }
        }
        // At edges and thin walls: of the directions along the surface and off it, the open one nearest to the wish.
        let across = here.1.any_orthonormal_vector();
        let other = here.1.cross(across);
        let ring = (0..16).map(|k| {
            let (s, c) = base::ops::sin_cos(f64::from(k) * (base::ops::TAU / 16.0));
            across * c + other * s
        });
        let ways = ring.flat_map(|t| [0.05, 0.5, 2.0].map(|off| (t + here.1 * off).normalize()));
        let open = ways.filter(|&d| clear(d));
        open.reduce(|a, b| if b.dot(wish) > a.dot(wish) { b } else { a })
    }

    /// Returns the clearance from surfaces where there is room, metres.
    pub(crate) const fn clearance_m(&self) -> f64 {
        self.clearance_m
    }

    /// Returns how deep a point lies in an obstacle, metres; 0 outside of all.
    pub fn depth(&self, p: DVec3) -> f64 {
        let deep = |b: &Body| if b.inside(p) { -b.distance(p).0 } else { 0.0 };
        self.bodies.iter().map(deep).fold(0.0, f64::max)
    }

    /// Whether an organ is clear of every obstacle, by its frame, scale and the corners of its shape
    /// ([`plant::Shape::corners`]).
    ///
    /// Guaranteed: no corner lies in an obstacle, and none stands between its root and a corner.
    pub fn admit(&self, frame: &Frame, scale: f64, corners: &[DVec3]) -> bool {
        let reach = corners.iter().map(|c| c.length()).fold(0.0, f64::max) * scale;
        // Most organs are far from everything.
        if self.bodies.iter().all(|b| b.clear(frame.origin, reach)) {
            return true;
        }
        let within = self.inside(frame.origin).is_some();
        let mut places = corners.iter().map(|c| frame.place(*c, scale));
        places.all(|p| self.inside(p).is_none() && (within || !self.blocks(frame.origin, p)))
    }

    /// As [`nearest`](Self::nearest), if that is less than `reach` away or inside: much faster far from meshes of
    /// slivers.
    pub(crate) fn nearest_within(&self, p: DVec3, reach: f64) -> Option<(f64, DVec3)> {
        let near = self.bodies.iter().filter(|b| !b.clear(p, reach)).map(|b| b.distance(p));
        near.reduce(|a, b| if b.0 < a.0 { b } else { a })
    }

    /// Returns the distance to the nearest surface (negative inside) and the direction out of it.
    pub(crate) fn nearest(&self, p: DVec3) -> Option<(f64, DVec3)> {
        let all = self.bodies.iter().map(|b| b.distance(p));
        all.reduce(|a, b| if b.0 < a.0 { b } else { a })
    }
}

impl Body {
    fn new(o: &Obstacle) -> Result<Self, GrowthError> {
        spec::check(o)?;
        Ok(match o {
            Obstacle::Box { min, max } => {
                let size = *max - *min;
                for x in size.to_array() {
                    within("max - min", x, 1e-6, FAR_M, "above 0 and at most 1e6 m in each coordinate")?;
                }
                Self::Box(*min, *max)
            }
            Obstacle::Sphere { centre, radius_m } => Self::Sphere(*centre, *radius_m),
            Obstacle::Cylinder { base, radius_m, height_m } => Self::Cylinder(*base, *radius_m, *height_m),
            Obstacle::Plane { point, normal } => {
                let unit = if usable(*normal) { normal.try_normalize() } else { None };
                let range = "a direction with a length";
                let fault = GrowthError::Field { field: "normal", range, value: normal.length() };
                Self::Plane(*point, unit.ok_or(fault)?)
            }
            Obstacle::Mesh { vertices, triangles } => Self::Mesh(Solid::new(vertices, triangles)?),
        })
    }

    fn inside(&self, p: DVec3) -> bool {
        match self {
            Self::Mesh(solid) => solid.inside(p),
            _ => self.distance(p).0 < 0.0,
        }
    }

    /// Whether a point is at least a distance, 0 or more, outside.
    fn clear(&self, p: DVec3, distance: f64) -> bool {
        match self {
            // Slightly farther, so that rounding does not decide whether it is examined.
            Self::Mesh(solid) if solid.nearest_within(p, 1e-9 + 1.001 * distance).is_none() => {
                !solid.inside(p)
            }
            _ => self.distance(p).0 >= distance,
        }
    }

    /// Returns the signed distance (negative inside) and the unit direction outwards.
    fn distance(&self, p: DVec3) -> (f64, DVec3) {
        match self {
            Self::Box(min, max) => {
                let q = p.clamp(*min, *max);
                let gap = p - q;
                let d = gap.length();
                if d > 0.0 {
                    return (d, gap / d);
                }
                let walls = [
                    (p.x - min.x, DVec3::NEG_X),
                    (max.x - p.x, DVec3::X),
                    (p.z - min.z, DVec3::NEG_Z),
                    (max.z - p.z, DVec3::Z),
                    (max.y - p.y, DVec3::Y),
                    (p.y - min.y, DVec3::NEG_Y),
                ];
                let least = walls.into_iter().reduce(|a, b| if b.0 < a.0 { b } else { a });
                least.map_or((0.0, DVec3::Y), |(d, n)| (-d, n))
            }
            Self::Sphere(centre, r) => {
                let out = p - *centre;
                (out.length() - r, out.normalize_or(DVec3::Y))
            }
            Self::Cylinder(base, r, h) => {
                let q = p - *base;
                let flat = DVec3::new(q.x, 0.0, q.z);
                let radial = flat.length() - r;
                let out = flat.normalize_or(DVec3::X);
                let (vertical, up) = if q.y > 0.5 * h { (q.y - h, DVec3::Y) } else { (-q.y, DVec3::NEG_Y) };
                if radial > 0.0 && vertical > 0.0 {
                    let gap = out * radial + up * vertical;
                    return (gap.length(), gap.normalize_or(up));
                }
                if radial > vertical { (radial, out) } else { (vertical, up) }
            }
            Self::Plane(point, normal) => ((p - *point).dot(*normal), *normal),
            Self::Mesh(solid) => {
                let (q, face) = solid.nearest(p);
                let d = p.distance(q);
                let (sign, out) = if solid.inside(p) { (-1.0, q - p) } else { (1.0, p - q) };
                // On the surface itself only the face determines the outward direction.
                (sign * d, if d > 1e-9 { out / d } else { face })
            }
        }
    }

    fn blocks(&self, a: DVec3, b: DVec3) -> bool {
        let d = b - a;
        match self {
            Self::Box(min, max) => segment_meets_box(a, d, *min, *max),
            Self::Sphere(centre, r) => {
                let t = ((*centre - a).dot(d) / d.length_squared().max(1e-300)).clamp(0.0, 1.0);
                (a + d * t).distance_squared(*centre) < r * r
            }
            Self::Cylinder(base, r, h) => segment_meets_cylinder(a - *base, d, *r, *h),
            Self::Plane(point, normal) => (a - *point).dot(*normal) < 0.0 || (b - *point).dot(*normal) < 0.0,
            Self::Mesh(solid) => solid.blocks(a, b),
        }
    }
}

/// Tests the part of the segment at the cylinder's heights against the circle, seen from above.
fn segment_meets_cylinder(a: DVec3, d: DVec3, r: f64, h: f64) -> bool {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    if d.y.abs() < 1e-300 {
        if a.y < 0.0 || a.y > h {
            return false;
        }
    } else {
        let (s, t) = (-a.y / d.y, (h - a.y) / d.y);
        enter = enter.max(s.min(t));
        leave = leave.min(s.max(t));
    }
    if enter > leave {
        return false;
    }
    let flat2 = d.x * d.x + d.z * d.z;
    let nearest = if flat2 > 0.0 { (-(a.x * d.x + a.z * d.z) / flat2).clamp(enter, leave) } else { enter };
    let (x, z) = (a.x + d.x * nearest, a.z + d.z * nearest);
    x * x + z * z < r * r
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::tests::{cube, sphere};

    fn all() -> Vec<Obstacle> {
        let (vertices, triangles) = cube();
        let (ball, faces) = sphere(12, 16);
        vec![
            Obstacle::Box { min: DVec3::new(-1.0, 0.0, -0.5), max: DVec3::new(1.0, 2.0, 0.5) },
            Obstacle::Sphere { centre: DVec3::Y, radius_m: 1.0 },
            Obstacle::Cylinder { base: DVec3::ZERO, radius_m: 0.8, height_m: 2.0 },
            Obstacle::Plane { point: DVec3::X, normal: DVec3::new(2.0, 0.0, 1.0) },
            Obstacle::Mesh { vertices, triangles },
            Obstacle::Mesh { vertices: ball, triangles: faces },
        ]
    }

    #[test]
    fn distance_inside_and_views_agree() {
        let mut s = base::Seed::new(2).stream(base::Draw::Test);
        for o in all() {
            let one = Obstacles::new(core::slice::from_ref(&o), 0.0).expect("sound");
            let mut inside = 0;
            for _ in 0..400 {
                let p = DVec3::new(s.range(-2.0, 2.0), s.range(-1.0, 3.0), s.range(-2.0, 2.0));
                let (d, n) = one.bodies[0].distance(p);
                assert!((n.length() - 1.0).abs() < 1e-9, "{o:?} {p}");
                // The outward direction leads to the surface, unless an edge is nearer to be rounded.
                let (there, _) = one.bodies[0].distance(p - n * d);
                assert!(there.abs() < 1e-6, "{o:?} {p}: {d}, then {there}");
                assert_eq!(one.inside(p).is_some(), d < 0.0, "{o:?} {p} {d}");
                inside += usize::from(d < 0.0);
                let q = DVec3::new(s.range(-2.0, 2.0), s.range(-1.0, 3.0), s.range(-2.0, 2.0));
                let on_the_way = (0..=200).any(|i| {
                    let x = p + (q - p) * (f64::from(i) / 200.0);
                    one.bodies[0].distance(x).0 < -1e-3
                });
                let both_inside = d < 0.0 && one.inside(q).is_some();
                if on_the_way && !both_inside {
                    assert!(one.blocks(p, q), "{o:?}: {p} to {q}");
                }
            }
            assert!(inside > 2, "{o:?}");
        }
    }

    #[test]
    fn steered_steps_are_free_and_in_view() {
        let mut s = base::Seed::new(4).stream(base::Draw::Test);
        for o in all() {
            let one = Obstacles::new(core::slice::from_ref(&o), 0.1).expect("sound");
            let mut steered = 0;
            for _ in 0..400 {
                let p = DVec3::new(s.range(-2.0, 2.0), s.range(-1.0, 3.0), s.range(-2.0, 2.0));
                let wish = DVec3::new(s.normal(), s.normal(), s.normal()).normalize_or(DVec3::Y);
                if !one.free(p) {
                    continue;
                }
                let got = one.steer(p, wish, 0.3);
                let to = p + got.unwrap_or(DVec3::ZERO) * 0.3;
                assert!(got.is_some(), "{o:?}: there is a way from {p} along {wish}");
                assert!(one.free(to) && !one.blocks(p, to), "{o:?} {p} {wish}");
                steered += usize::from(got != Some(wish));
            }
            assert!(steered > 3, "{o:?}: {steered}");
        }
    }

    #[test]
    fn nonsense_is_refused() {
        let bad = [
            Obstacle::Box { min: DVec3::ONE, max: DVec3::ZERO },
            Obstacle::Sphere { centre: DVec3::NAN, radius_m: 1.0 },
            Obstacle::Plane { point: DVec3::ZERO, normal: DVec3::ZERO },
            Obstacle::Cylinder { base: DVec3::ZERO, radius_m: -1.0, height_m: 2.0 },
        ];
        for o in bad {
            let text = Obstacles::new(&[all()[0].clone(), o.clone()], 0.0).expect_err("refused").to_string();
            assert!(text.starts_with(&format!("obstacle 2 (a {}): ", o.shape())), "{text}");
        }
        assert!(Obstacles::new(&[], f64::NAN).is_err());
    }
}
