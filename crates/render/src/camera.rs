//! The camera of a picture: framing and projection.

use base::ops;
use glam::{DVec2, DVec3};

use crate::spec::{PictureSpec, Pinhole, THREE_QUARTER, View};

/// Half of the vertical angle of view of the perspective views, radians: 11 degrees, a long lens that keeps stems
/// straight.
const HALF_FOV: f64 = 0.192;

/// Maps plant coordinates (metres) to pixels (x right, y down, origin at the upper left corner of the picture).
///
/// ```
/// use glam::DVec3;
/// let spec = render::PictureSpec { width: 200, height: 100, view: render::View::Front, margin: 0.0, ..Default::default() };
/// let camera = render::Camera::framing(&[DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0)], &spec);
/// let p = camera.project(DVec3::new(1.0, 0.5, 7.0));
/// assert!((p.x - 200.0).abs() < 1e-9 && (p.y - 50.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    right: DVec3,
    up: DVec3,
    back: DVec3,
    target: DVec3,
    // Distance of the eye from the target; None: orthographic.
    distance: Option<f64>,
    // Pixels per metre (orthographic) or per unit slope (perspective).
    scale: DVec2,
    centre: DVec2,
}

impl Camera {
    /// Makes the camera of `spec.view` that shows all of `points` (metres; points that are not finite are ignored) with
    /// the margin of `spec`. A turntable's frame holds the volume that the points sweep as they turn around the
    /// vertical axis through the centre of their bounds; a pinhole stays where it is. No points: the unit cube around
    /// the origin.
    pub fn framing(points: &[DVec3], spec: &PictureSpec) -> Self {
        let spec = spec.clamped();
        let (azimuth, elevation, perspective) = match spec.view {
            View::Front => (0.0, 0.0, false),
            View::Side => (ops::FRAC_PI_2, 0.0, false),
            View::Top => (0.0, ops::FRAC_PI_2, false),
            View::ThreeQuarter => (THREE_QUARTER.0, THREE_QUARTER.1, true),
            View::Turntable { .. } => (0.0, THREE_QUARTER.1, true),
            View::Orbit { azimuth, elevation } => (azimuth, elevation, true),
            View::Pinhole(pinhole) => return Self::from_pinhole(&pinhole),
        };
        let (sa, ca) = exact_sin_cos(azimuth);
        let (se, ce) = exact_sin_cos(elevation);
        let right = DVec3::new(ca, 0.0, -sa);
        let back = DVec3::new(sa * ce, se, ca * ce);
        let up = back.cross(right);
        let size = DVec2::new(f64::from(spec.width), f64::from(spec.height));
        let half = size * 0.5 * (1.0 - 2.0 * spec.margin);
        let mut camera = Self {
            right,
            up,
            back,
            target: DVec3::ZERO,
            distance: None,
            scale: DVec2::ONE,
            centre: size * 0.5,
        };
        let cube = [DVec3::splat(-0.5), DVec3::splat(0.5)];
        let points = if points.iter().any(|p| p.is_finite()) { points } else { &cube };
        if matches!(spec.view, View::Turntable { .. }) {
            let ring = swept(points);
            camera.fit_perspective(&ring, half, size.y);
        } else if perspective {
            camera.fit_perspective(points, half, size.y);
        } else {
            camera.fit_orthographic(points, half);
        }
        camera
    }

    fn from_pinhole(pinhole: &Pinhole) -> Self {
        let back = pinhole.down.cross(pinhole.right);
        Self {
            right: pinhole.right,
            up: -pinhole.down,
            back,
            // A metre in front of the eye.
            target: pinhole.eye_m - back,
            distance: Some(1.0),
            scale: pinhole.focal_px,
            centre: pinhole.principal_px,
        }
    }

    /// Makes an orthographic camera that looks from the direction `back` at all within `radius` of `centre`, in a
    /// square of `pixels` pixels a side.
    pub(crate) fn around_sphere(back: DVec3, centre: DVec3, radius: f64, pixels: u32) -> Self {
        let back = back.normalize_or(DVec3::Z);
        let right = DVec3::Y.cross(back).try_normalize().unwrap_or(DVec3::X);
        let half = 0.5 * f64::from(pixels);
        Self {
            right,
            up: back.cross(right),
            back,
            target: centre,
            distance: None,
            scale: DVec2::splat(half / radius.max(f64::MIN_POSITIVE)),
            centre: DVec2::splat(half),
        }
    }

    /// Expresses a direction, or an offset from the target, in the axes of the camera: to the right, up, towards the
    /// viewer.
    pub(crate) fn seen(&self, way: DVec3) -> DVec3 {
        DVec3::new(way.dot(self.right), way.dot(self.up), way.dot(self.back))
    }

    /// Returns the axes of the camera: to the right, up and towards the viewer.
    pub(crate) fn axes(&self) -> [DVec3; 3] {
        [self.right, self.up, self.back]
    }

    /// Returns the camera with the same lens and place after the model has turned by `angle` around the axis of
    /// [`swept`].
    pub(crate) fn turned(mut self, angle: f64, points: &[DVec3]) -> Self {
        let (s, c) = ops::sin_cos(angle);
        let turn = |v: DVec3| DVec3::new(v.x * c + v.z * s, v.y, v.z * c - v.x * s);
        let axis = axis_of(points);
        self.target = turn(self.target - axis) + axis;
        (self.right, self.up, self.back) = (turn(self.right), turn(self.up), turn(self.back));
        self
    }

    // Components along right, up and back.
    fn local(&self, p: DVec3) -> DVec3 {
        let q = p - self.target;
        DVec3::new(q.dot(self.right), q.dot(self.up), q.dot(self.back))
    }

    fn box_of(&self, points: &[DVec3]) -> (DVec3, DVec3) {
        points.iter().filter(|p| p.is_finite()).fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(lo, hi), &p| {
                let q = self.local(p);
                (lo.min(q), hi.max(q))
            },
        )
    }

    fn fit_orthographic(&mut self, points: &[DVec3], half: DVec2) {
        let (lo, hi) = self.box_of(points);
        let mid = (lo + hi) * 0.5;
        self.target = self.right * mid.x + self.up * mid.y + self.back * mid.z;
        let extent = ((hi - lo) * 0.5).max(DVec3::splat(f64::MIN_POSITIVE));
        self.scale = DVec2::splat((half.x / extent.x).min(half.y / extent.y).min(1e300));
    }

    fn fit_perspective(&mut self, points: &[DVec3], half: DVec2, height: f64) {
        let focal = 0.5 * height / ops::tan(HALF_FOV);
        self.scale = DVec2::splat(focal);
        let (lo, hi) = self.box_of(points);
        let mid = (lo + hi) * 0.5;
        self.target = self.right * mid.x + self.up * mid.y + self.back * mid.z;
        let radius = ((hi - lo) * 0.5).length().max(1e-150);
        // The distance is exact for a given target; the target moves to the centre of the visible extent. The shift
        // contracts by about depth / distance, so that a few rounds are enough.
        for _ in 0..6 {
            let mut distance = 1.5 * radius;
            for &p in points.iter().filter(|p| p.is_finite()) {
                let q = self.local(p);
                distance = distance.max(q.z + focal * (q.x.abs() / half.x).max(q.y.abs() / half.y));
            }
            self.distance = Some(distance);
            let mut seen = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            for &p in points.iter().filter(|p| p.is_finite()) {
                let q = self.local(p);
                let s = DVec2::new(q.x, q.y) / (distance - q.z);
                seen = (seen.0.min(s), seen.1.max(s));
            }
            let shift = (seen.0 + seen.1) * 0.5 * distance;
            self.target += self.right * shift.x + self.up * shift.y;
        }
        let far = points.iter().filter(|p| p.is_finite()).fold(1.5 * radius, |far: f64, &p| {
            let q = self.local(p);
            far.max(q.z + focal * (q.x.abs() / half.x).max(q.y.abs() / half.y))
        });
        self.distance = Some(far);
    }

    /// Projects a point to pixel coordinates, with the centre of the upper left pixel at (0.5, 0.5), and in `z` a key
    /// that grows towards the viewer and is linear over the picture. NaN for points behind a perspective camera.
    pub fn project(&self, p: DVec3) -> DVec3 {
        let q = self.local(p);
        match self.distance {
            None => DVec3::new(self.centre.x + q.x * self.scale.x, self.centre.y - q.y * self.scale.y, q.z),
            Some(distance) => {
                let w = distance - q.z;
                if w <= 0.0 || w.is_nan() {
                    return DVec3::NAN;
                }
                let s = self.scale / w;
                DVec3::new(self.centre.x + q.x * s.x, self.centre.y - q.y * s.y, 1.0 / w)
            }
        }
    }

    /// Whether the camera is perspective, not orthographic.
    pub fn is_perspective(&self) -> bool {
        self.distance.is_some()
    }

    /// Returns the eye-side start and unit direction of the ray through a pixel position.
    pub fn ray(&self, pixel: DVec2) -> (DVec3, DVec3) {
        let d = (pixel - self.centre) / self.scale;
        match self.distance {
            None => (self.target + self.right * d.x - self.up * d.y, -self.back),
            Some(distance) => {
                let toward = self.right * d.x - self.up * d.y - self.back;
                (self.target + self.back * distance, toward.normalize_or(-self.back))
            }
        }
    }

    /// Returns the unit vector from `p` towards the viewer.
    pub(crate) fn toward_viewer(&self, p: DVec3) -> DVec3 {
        match self.distance {
            None => self.back,
            Some(distance) => (self.target + self.back * distance - p).normalize_or(self.back),
        }
    }

    /// Returns the horizontal direction to the right of the viewer and the horizontal direction towards the viewer.
    pub(crate) fn level_frame(&self) -> (DVec3, DVec3) {
        (self.right, self.right.cross(DVec3::Y))
    }
}

// Returns a point of the vertical axis through the centre of the bounds.
fn axis_of(points: &[DVec3]) -> DVec3 {
    let (lo, hi) = points
        .iter()
        .filter(|p| p.is_finite())
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    let mid = (lo + hi) * 0.5;
    if mid.is_finite() { DVec3::new(mid.x, 0.0, mid.z) } else { DVec3::ZERO }
}

// Returns rings of the widest reach at 32 heights: the volume that the points sweep as they turn.
fn swept(points: &[DVec3]) -> Vec<DVec3> {
    const BANDS: usize = 32;
    let axis = axis_of(points);
    let finite = || points.iter().filter(|p| p.is_finite());
    let (low, high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.y), h.max(p.y)));
    let step = ((high - low) / BANDS as f64).max(f64::MIN_POSITIVE);
    let mut reach = vec![(0.0_f64, f64::INFINITY, f64::NEG_INFINITY); BANDS];
    for p in finite() {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the bands")]
        let k = (((p.y - low) / step) as usize).min(BANDS - 1);
        let r = ops::hypot(p.x - axis.x, p.z - axis.z);
        reach[k] = (reach[k].0.max(r), reach[k].1.min(p.y), reach[k].2.max(p.y));
    }
    let around = (0..24).map(|k| ops::sin_cos(ops::TAU * f64::from(k) / 24.0));
    let rings = reach.iter().filter(|r| r.1 <= r.2);
    rings
        .flat_map(|&(r, low, high)| {
            let at = move |y: f64, (s, c): (f64, f64)| DVec3::new(axis.x + r * s, y, axis.z + r * c);
            around.clone().flat_map(move |turn| [at(low, turn), at(high, turn)])
        })
        .collect()
}

// Horizontal and vertical views must be so to the last bit: the front view is the drawing.
fn exact_sin_cos(angle: f64) -> (f64, f64) {
    let (s, c) = ops::sin_cos(angle);
    if c.abs() < 1e-15 { (s.signum(), 0.0) } else { (s, c) }
}
