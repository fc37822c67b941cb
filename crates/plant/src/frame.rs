//! Local frames of organs.

use base::{Digest, Digestible};
use glam::DVec3;

/// A local right-handed frame in the plant: `right` x `along` = `normal`, unit vectors at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Point of attachment of the organ (the root of a blade), metres.
    pub origin: DVec3,
    /// Local +x: across.
    pub right: DVec3,
    /// Local +y: from root to tip.
    pub along: DVec3,
    /// Local +z: the upper (inner) side.
    pub normal: DVec3,
}

impl Frame {
    /// Makes the frame at `origin` whose y axis is `along` and whose z axis is as near to `towards` as possible. Falls
    /// back to any perpendicular when the two are parallel, to +Y when `along` is zero.
    ///
    /// ```
    /// use glam::DVec3;
    /// let f = plant::Frame::looking(DVec3::ZERO, DVec3::Y, DVec3::Z);
    /// assert_eq!((f.right, f.along, f.normal), (DVec3::X, DVec3::Y, DVec3::Z));
    /// ```
    pub fn looking(origin: DVec3, along: DVec3, towards: DVec3) -> Self {
        let along = along.try_normalize().unwrap_or(DVec3::Y);
        let side = along.cross(towards);
        let right =
            if side.length_squared() > 1e-24 { side.normalize() } else { along.any_orthonormal_vector() };
        Self { origin, right, along, normal: right.cross(along) }
    }

    /// Converts local to plant coordinates, with the organ's scale.
    pub fn place(&self, local: DVec3, scale: f64) -> DVec3 {
        self.origin + (self.right * local.x + self.along * local.y + self.normal * local.z) * scale
    }

    /// Rotates a local direction into the plant.
    pub fn rotate(&self, local: DVec3) -> DVec3 {
        self.right * local.x + self.along * local.y + self.normal * local.z
    }

    /// Converts plant to local coordinates (inverse of [`place`](Self::place) with scale 1).
    pub fn localise(&self, world: DVec3) -> DVec3 {
        let d = world - self.origin;
        DVec3::new(d.dot(self.right), d.dot(self.along), d.dot(self.normal))
    }
}

impl Digestible for Frame {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.origin).add(&self.right).add(&self.along).add(&self.normal);
    }
}
