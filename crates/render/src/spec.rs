//! What is asked of a picture.

use base::Seed;

/// Azimuth and elevation of the three-quarter view, radians.
pub(crate) const THREE_QUARTER: (f64, f64) = (0.55, 0.21);
/// More frames than a sheet can show legibly.
pub(crate) const MAX_FRAMES: u32 = 360;
const MAX_SIZE: u32 = 8192;

/// Where the picture is taken from. The model always fills the picture but for a margin.
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
        /// Around the upright axis, radians: 0 from the front (+Z), a quarter turn from the right (+X).
        azimuth: f64,
        /// Above the horizon, radians, clamped to -1.5 to 1.5.
        elevation: f64,
    },
    /// A sheet of `frames` perspective views around the upright axis.
    Turntable {
        /// Number of views, 1 to 360.
        frames: u32,
    },
}

/// What is behind the model.
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

/// What a picture shows and how.
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
    /// Where from, default three-quarter.
    pub view: View,
    /// What is behind, default sky.
    pub background: Background,
    /// The model casts a shadow on the ground below it, default true. Not seen in the level views front and side.
    pub ground_shadow: bool,
    /// Samples along a pixel's edge (16 a pixel for 4), 1 to 6, default 4.
    pub supersample: u32,
    /// Free share of the picture's edge on each side, 0 to 0.45, default 0.06.
    pub margin: f64,
    /// Brightness, 0.1 to 10, default 1.
    pub exposure: f64,
    /// Turns the pattern of the lights.
    pub seed: Seed,
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
        }
    }
}

impl PictureSpec {
    /// The same with every number inside its range; what is not finite takes its default.
    #[must_use]
    pub fn clamped(&self) -> Self {
        let finite = |x: f64, default: f64| if x.is_finite() { x } else { default };
        let view = match self.view {
            View::Orbit { azimuth, elevation } => View::Orbit {
                azimuth: finite(azimuth, THREE_QUARTER.0),
                elevation: finite(elevation, THREE_QUARTER.1).clamp(-1.5, 1.5),
            },
            View::Turntable { frames } => View::Turntable { frames: frames.clamp(1, MAX_FRAMES) },
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
        }
    }
}
