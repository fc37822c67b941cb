//! Settings of a picture.

use base::Seed;
use glam::{DVec2, DVec3};

/// Azimuth and elevation of the three-quarter view, radians.
pub(crate) const THREE_QUARTER: (f64, f64) = (0.55, 0.21);
/// Most frames of a sheet that are still legible.
pub(crate) const MAX_FRAMES: u32 = 360;
const MAX_SIZE: u32 = 8192;

/// Viewpoint of a picture. The model always fills the picture except for a margin, unless the view is
/// [`View::Pinhole`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum View {
    /// Orthographic along -Z: the view of the drawing. X goes right, Y goes up.
    Front,
    /// Perspective from the front right, a little above.
    #[default]
    ThreeQuarter,
    /// Orthographic along -X, from the plant's right: Z goes left, Y goes up.
    Side,
    /// Orthographic along -Y, from above: X goes right, Z goes down.
    Top,
    /// Perspective from any side.
    Orbit {
        /// Azimuth around the vertical axis, radians: 0 from the front (+Z), a quarter turn from the right (+X).
        azimuth: f64,
        /// Elevation above the horizon, radians, clamped to -1.5 to 1.5.
        elevation: f64,
    },
    /// A sheet of `frames` perspective views around the vertical axis.
    Turntable {
        /// Number of views, 1 to 360.
        frames: u32,
    },
    /// Perspective by a calibrated camera with a given position.
    Pinhole(Pinhole),
}

/// A camera with its position and intrinsics in the convention of computer vision: x right, y down, z along the view.
///
/// A point at (x, y, z) metres of the camera appears at pixel (fx x / z + cx, fy y / z + cy), with (0, 0) the upper
/// left corner of the picture and (0.5, 0.5) the centre of its first pixel. No distortion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinhole {
    /// Position of the eye, metres.
    pub eye_m: DVec3,
    /// To the right of the picture, a unit vector.
    pub right: DVec3,
    /// Down the picture, a unit vector at a right angle to `right`.
    pub down: DVec3,
    /// fx and fy, pixels, above 0.
    pub focal_px: DVec2,
    /// cx and cy, pixels.
    pub principal_px: DVec2,
}

impl Pinhole {
    /// Tolerance for the unit length and the right angle of the axes.
    const AXES_OFF_MOST: f64 = 1e-6;

    /// Whether all numbers are finite, the axes orthonormal and the focal lengths above 0.
    pub fn is_sound(&self) -> bool {
        let unit = |v: DVec3| v.is_finite() && (v.length() - 1.0).abs() <= Self::AXES_OFF_MOST;
        let places = self.eye_m.is_finite() && self.principal_px.is_finite() && self.focal_px.is_finite();
        let square = self.right.dot(self.down).abs() <= Self::AXES_OFF_MOST;
        places && unit(self.right) && unit(self.down) && square && self.focal_px.min_element() > 0.0
    }
}

/// Background of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Background {
    /// A light blue sky above a pale ground, as bright as the light that comes from it.
    #[default]
    Sky,
    /// Nothing: alpha is 0 where there is neither model nor shadow.
    Transparent,
    /// One sRGB colour.
    Plain([u8; 3]),
}

/// Contents and appearance of a picture.
///
/// ```
/// let spec = render::PictureSpec { view: render::View::Front, ..Default::default() };
/// assert_eq!((spec.width, spec.height), (1024, 768));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PictureSpec {
    /// Pixels across, 1 to 8192, default 1024.
    pub width: u32,
    /// Pixels down, 1 to 8192, default 768.
    pub height: u32,
    /// Viewpoint, default three-quarter.
    pub view: View,
    /// Background, default sky.
    pub background: Background,
    /// The model casts a shadow on the ground below it, default true. Not visible in the horizontal views front and
    /// side.
    pub ground_shadow: bool,
    /// Samples along a pixel's edge (16 a pixel for 4), 1 to 6, default 4.
    pub supersample: u32,
    /// Margin on each side, as a share of the picture's edge, 0 to 0.45, default 0.06.
    pub margin: f64,
    /// Brightness, 0.1 to 10, default 1.
    pub exposure: f64,
    /// Seed of the pattern of the lights.
    pub seed: Seed,
    /// Unit vector towards the sun, above the horizon. Default none: it stands next to the viewer, to the upper left.
    pub sun: Option<DVec3>,
    /// Brightness of the sun, 0 to 4, as a share of the usual, default 1.
    pub sunshine: f64,
    /// Brightness of the sky and of the light reflected by the ground, 0 to 4, as a share of the usual, default 1.
    pub skylight: f64,
}

impl Default for PictureSpec {
    fn default() -> Self {
        Self {
            width: 1024,
            height: 768,
            view: View::default(),
            background: Background::default(),
            ground_shadow: true,
            supersample: 4,
            margin: 0.06,
            exposure: 1.0,
            seed: Seed::default(),
            sun: None,
            sunshine: 1.0,
            skylight: 1.0,
        }
    }
}

impl PictureSpec {
    /// Returns the same with every number inside its range; a number that is not finite, or a camera that is not sound,
    /// takes its default.
    #[must_use]
    pub fn clamped(&self) -> Self {
        let finite = |x: f64, default: f64| if x.is_finite() { x } else { default };
        let view = match self.view {
            View::Orbit { azimuth, elevation } => View::Orbit {
                azimuth: finite(azimuth, THREE_QUARTER.0),
                elevation: finite(elevation, THREE_QUARTER.1).clamp(-1.5, 1.5),
            },
            View::Turntable { frames } => View::Turntable { frames: frames.clamp(1, MAX_FRAMES) },
            View::Pinhole(camera) if !camera.is_sound() => View::default(),
            other => other,
        };
        Self {
            width: self.width.clamp(1, MAX_SIZE),
            height: self.height.clamp(1, MAX_SIZE),
            view,
            background: self.background,
            ground_shadow: self.ground_shadow,
            supersample: self.supersample.clamp(1, 6),
            margin: finite(self.margin, 0.06).clamp(0.0, 0.45),
            exposure: finite(self.exposure, 1.0).clamp(0.1, 10.0),
            seed: self.seed,
            sun: self.sun.and_then(DVec3::try_normalize).filter(|s| s.y > 0.0),
            sunshine: finite(self.sunshine, 1.0).clamp(0.0, 4.0),
            skylight: finite(self.skylight, 1.0).clamp(0.0, 4.0),
        }
    }
}
