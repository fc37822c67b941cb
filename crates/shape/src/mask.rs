//! An outline drawn in a plane -> markers in space (the VR paper, silhouette editing).

use base::ops;
use base::{Draw, Seed};
use glam::{DVec2, DVec3};

use crate::edit::{Mirror, ViewPlane};
use crate::outcome::Why;

/// Longer side of the mask, pixels. R of the VR paper is in pixels: 10 of 48 give a crown about 0.4 as deep as broad.
const SIDE: usize = 48;
/// R of the VR paper: radius of a marker's ball far inside the outline, pixels.
const RADIUS_PX: f64 = 10.0;
/// k of the VR paper: rate at which the radius falls towards the edge.
const FALL: f64 = 0.4;

/// A drawn outline, its plane and its pixels.
#[derive(Clone, Debug)]
pub(crate) struct Mask {
    outline: Vec<DVec2>,
    /// The outline, with its first point repeated at the end.
    closed: Vec<DVec2>,
    axes: [DVec3; 3],
    origin: DVec3,
    lo: DVec2,
    /// Side of a pixel, metres.
    pub(crate) pixel: f64,
    columns: usize,
    rows: usize,
    inside: Vec<bool>,
    /// A point and the unit normal of a plane of symmetry: a point counts as inside if its image does.
    mirror: Option<(DVec3, DVec3)>,
}

impl Mask {
    pub(crate) fn new(plane: &ViewPlane, outline: &[DVec2], mirror: Option<Mirror>) -> Result<Self, Why> {
        let axes = plane.axes()?;
        let mirror = mirror.map(|m| m.axes()).transpose()?;
        if !outline.iter().all(|p| p.is_finite() && p.abs().max_element() < 1e6) {
            return Err(Why::BadNumber { field: "outline" });
        }
        let (lo, hi) = outline
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        let size = hi - lo;
        let small = Why::TooSmall { what: "outline" };
        if outline.len() < 3 || size.min_element() <= 1e-9 {
            return Err(small);
        }
        let pixel = size.max_element() / SIDE as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to SIDE")]
        let count = |x: f64| ((x / pixel).ceil() as usize).clamp(1, SIDE);
        let (columns, rows) = (count(size.x), count(size.y));
        let centre = |x: usize, y: usize| lo + DVec2::new(x as f64 + 0.5, y as f64 + 0.5) * pixel;
        let inside: Vec<bool> =
            (0..rows * columns).map(|i| geom::contains(outline, centre(i % columns, i / columns))).collect();
        if inside.iter().filter(|i| **i).count() < 4 {
            return Err(small);
        }
        let closed = [outline, &outline[..1]].concat();
        Ok(Self {
            outline: outline.to_vec(),
            closed,
            axes,
            origin: plane.origin,
            lo,
            pixel,
            columns,
            rows,
            inside,
            mirror,
        })
    }

    fn image(&self, p: DVec3) -> Option<DVec3> {
        self.mirror.map(|(through, normal)| Mirror::image(through, normal, p))
    }

    /// Returns the position at which a point appears in the plane.
    pub(crate) fn seen(&self, p: DVec3) -> DVec2 {
        let d = p - self.origin;
        DVec2::new(d.dot(self.axes[0]), d.dot(self.axes[1]))
    }

    /// Whether a point lies behind or before the outline's inside.
    fn is_behind(&self, p: DVec3) -> bool {
        geom::contains(&self.outline, self.seen(p))
    }

    /// Whether a point, or its image, lies behind or before the outline's inside.
    pub(crate) fn covers(&self, p: DVec3) -> bool {
        self.is_behind(p) || self.image(p).is_some_and(|q| self.is_behind(q))
    }

    /// Whether a point, or its image, appears inside the outline or at most `slack` outside.
    pub(crate) fn near(&self, p: DVec3, slack: f64) -> bool {
        let beside = |p: DVec3| {
            let seen = self.seen(p);
            geom::closest_on_polyline(&self.closed, seen).is_some_and(|c| c.point.distance(seen) <= slack)
        };
        self.covers(p) || beside(p) || self.image(p).is_some_and(beside)
    }

    /// Returns the images of markers in the plane of symmetry, except for those in the room of the markers themselves;
    /// empty without a plane. `depth`: as for [`markers`](Self::markers).
    pub(crate) fn images(&self, markers: &[DVec3], depth: f64) -> Vec<DVec3> {
        let deep = RADIUS_PX * self.pixel;
        let own = |p: &DVec3| self.is_behind(*p) && (self.before(*p) - depth).abs() <= deep;
        markers.iter().filter_map(|m| self.image(*m)).filter(|p| !own(p)).collect()
    }

    /// Returns markers for every masked pixel, `density` of them on the average, each uniform in a ball around the
    /// pixel's middle of radius `r(n) = 2 R / (1 + e^(k n))`, n the unmasked pixels of the 5 x 5 around it.
    ///
    /// Markers that would appear outside the outline are drawn again, and finally set on the pixel: the VR paper's
    /// balls extend beyond the drawn line.
    pub(crate) fn markers(&self, density: f64, depth: f64, seed: Seed) -> Vec<DVec3> {
        let mut markers = Vec::new();
        for (i, _) in self.inside.iter().enumerate().filter(|(_, inside)| **inside) {
            let (x, y) = (i % self.columns, i / self.columns);
            let radius = self.radius(x, y);
            let mut stream = seed.child(i as u64).stream(Draw::Attractors);
            let whole = density.floor();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 10")]
            let count = whole as u32 + u32::from(stream.chance(density - whole));
            let middle = self.lo + DVec2::new(x as f64 + 0.5, y as f64 + 0.5) * self.pixel;
            for _ in 0..count {
                let mut at = (middle, 0.0);
                // After 8 tries, one in a thousand of the pixels well inside has no place off its middle.
                for _ in 0..8 {
                    let d =
                        DVec3::new(stream.range(-1.0, 1.0), stream.range(-1.0, 1.0), stream.range(-1.0, 1.0));
                    let seen = middle + d.truncate() * radius;
                    if d.length_squared() <= 1.0 && geom::contains(&self.outline, seen) {
                        at = (seen, d.z * radius);
                        break;
                    }
                }
                let [right, up, towards] = self.axes;
                markers.push(self.origin + right * at.0.x + up * at.0.y + towards * (depth + at.1));
            }
        }
        markers
    }

    /// Returns the radius of the ball of a pixel's markers, metres.
    fn radius(&self, x: usize, y: usize) -> f64 {
        2.0 * RADIUS_PX / (1.0 + ops::exp(FALL * self.outside_around(x, y))) * self.pixel
    }

    /// Counts masked pixels.
    pub(crate) fn pixels(&self) -> usize {
        self.inside.iter().filter(|i| **i).count()
    }

    /// Returns roughly the volume that markers fill, cubic metres.
    pub(crate) fn volume(&self) -> f64 {
        let masked = self.inside.iter().enumerate().filter(|(_, inside)| **inside);
        // On the average, a ball is two thirds as deep as it is broad.
        let depth = |i: usize| self.radius(i % self.columns, i / self.columns) * 4.0 / 3.0;
        masked.map(|(i, _)| self.pixel * self.pixel * depth(i).max(self.pixel)).sum()
    }

    fn outside_around(&self, x: usize, y: usize) -> f64 {
        let mut n = 0_u32;
        for dy in 0..5 {
            for dx in 0..5 {
                let (Some(px), Some(py)) = ((x + dx).checked_sub(2), (y + dy).checked_sub(2)) else {
                    n += 1;
                    continue;
                };
                let inside = px < self.columns && py < self.rows && self.inside[py * self.columns + px];
                n += u32::from(!inside);
            }
        }
        f64::from(n)
    }

    fn before(&self, p: DVec3) -> f64 {
        (p - self.origin).dot(self.axes[2])
    }

    /// Returns the distance of a point in front of the plane, or that of its image where only the image appears inside
    /// the outline.
    pub(crate) fn depth_of(&self, p: DVec3) -> f64 {
        let other = self.image(p).filter(|q| !self.is_behind(p) && self.is_behind(*q));
        self.before(other.unwrap_or(p))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<DVec2> {
        vec![DVec2::ZERO, DVec2::X * 4.8, DVec2::splat(4.8), DVec2::Y * 4.8]
    }

    #[test]
    fn markers_follow_the_logistic_radii_of_the_paper() {
        let mask = Mask::new(&ViewPlane::default(), &square(), None).expect("sound");
        assert!((mask.columns, mask.rows) == (48, 48) && (mask.pixel - 0.1).abs() < 1e-12);
        assert!(
            (mask.outside_around(20, 20), mask.outside_around(20, 0), mask.outside_around(0, 0))
                == (0.0, 10.0, 16.0)
        );
        let (markers, volume) = (mask.markers(1.0, 0.5, Seed::new(1)), mask.volume());
        assert_eq!((markers.len(), mask.pixels()), (48 * 48, 48 * 48));
        assert!(volume > 20.0 && volume < 40.0, "{volume}");
        let deep = |p: &&DVec3| (p.z - 0.5).abs() > 0.5;
        // Far inside the ball is R = 10 pixels = 1 m, at the edge it is 0.36 pixels.
        let at_edge: Vec<&DVec3> = markers.iter().filter(|p| p.x < 0.1 || p.y < 0.1).collect();
        assert!(markers.iter().filter(deep).count() > 300);
        assert!(at_edge.iter().filter(|p| deep(p)).count() < at_edge.len() / 3);
        assert!(markers.iter().all(|p| mask.covers(*p) && (p.z - 0.5).abs() <= 1.0));
        assert_eq!(mask.markers(2.5, 0.0, Seed::new(1)).len() / 100, 48 * 48 * 5 / 200);
    }

    #[test]
    fn outlines_without_area_say_so() {
        let plane = ViewPlane::default();
        let none = |o: &[DVec2]| Mask::new(&plane, o, None).err();
        assert_eq!(none(&[DVec2::ZERO, DVec2::X]), Some(Why::TooSmall { what: "outline" }));
        assert_eq!(none(&[DVec2::ZERO, DVec2::X, DVec2::X * 2.0]), Some(Why::TooSmall { what: "outline" }));
        assert_eq!(none(&[DVec2::NAN, DVec2::X, DVec2::Y]), Some(Why::BadNumber { field: "outline" }));
        let flat = ViewPlane { right: DVec3::Y, ..plane };
        assert_eq!(Mask::new(&flat, &square(), None).err(), Some(Why::BadNumber { field: "plane" }));
    }
}
