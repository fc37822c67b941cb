//! The cone on which the petals of a flower lie (paper 000, section 5.1).

use glam::DVec3;

/// A cone: apex, unit axis from the apex into the opening, half opening angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Where the petals are rooted.
    pub apex: DVec3,
    /// Unit vector from the apex into the cone.
    pub axis: DVec3,
    /// Angle between the axis and a generator, radians, in (0, pi/2].
    pub half_angle: f64,
}

/// Which of the two crossings of a view ray with a cone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sheet {
    /// The one nearer to the viewer (greater z).
    Near,
    /// The farther one.
    Far,
}
