//! The map between ink coordinates and the plant's drawing plane.

use glam::{DVec2, DVec3};

/// Scale and offset from ink coordinates to plant metres: `plant.xy = (ink - origin_ink) * metres_per_ink`.
///
/// ```
/// use glam::DVec2;
/// let map = sketch::PlantMap { metres_per_ink: 2.0, origin_ink: DVec2::new(0.5, 0.0) };
/// assert_eq!(map.plant_from_ink(DVec2::new(1.0, 1.0)), DVec2::new(1.0, 2.0));
/// assert_eq!(map.ink_from_plant(DVec2::new(1.0, 2.0)), DVec2::new(1.0, 1.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantMap {
    /// Metres per ink unit, above 0.
    pub metres_per_ink: f64,
    /// The ink point that becomes the plant's origin: the root of the main axis, on the ground.
    pub origin_ink: DVec2,
}

impl PlantMap {
    /// Returns an ink point in the plane z = 0 of the plant, metres.
    pub fn plant_from_ink(&self, ink: DVec2) -> DVec2 {
        (ink - self.origin_ink) * self.metres_per_ink
    }

    /// Returns an ink point at a given depth of the plant (`z` in metres).
    pub fn plant_at_depth(&self, ink: DVec2, z: f64) -> DVec3 {
        self.plant_from_ink(ink).extend(z)
    }

    /// Returns the ink point of a plant point (its front view).
    pub fn ink_from_plant(&self, plant: DVec2) -> DVec2 {
        plant / self.metres_per_ink + self.origin_ink
    }
}
