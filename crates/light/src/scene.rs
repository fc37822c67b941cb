//! Scenes that light falls on: triangles, their owners, and the reflectance and transmittance of these.

use base::{Budget, Counted};
use glam::DVec3;
use spec::RangeFault;

use crate::LightError;

/// Optical properties of a surface. Reflection and transmission are diffuse (Lambert).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Optics {
    /// Share of the light that is reflected, 0 to 1.
    pub reflectance: f64,
    /// Share of the light that is transmitted, 0 to 1; together with the reflectance at most 1.
    pub transmittance: f64,
}

impl Optics {
    /// Leaves in photosynthetically active light: broad leaves of the table of Dorman and Sellers (1989), which land
    /// surface models use.
    pub const LEAF: Self = Self { reflectance: 0.10, transmittance: 0.05 };
    /// Wood, bark and all other opaque matter, of the same table.
    pub const WOOD: Self = Self { reflectance: 0.16, transmittance: 0.0 };
    /// A surface that absorbs all light.
    pub const BLACK: Self = Self { reflectance: 0.0, transmittance: 0.0 };

    /// Returns the share of the light that is not absorbed.
    pub fn scattered(self) -> f64 {
        self.reflectance + self.transmittance
    }

    pub(crate) fn check(self) -> Result<(), RangeFault> {
        for (path, value) in [
            ("reflectance", self.reflectance),
            ("transmittance", self.transmittance),
            ("reflectance + transmittance", self.scattered()),
        ] {
            check_range(path, value, [0.0, 1.0], "")?;
        }
        Ok(())
    }
}

pub(crate) fn check_range(
    path: &str,
    value: f64,
    [least, most]: [f64; 2],
    unit: &'static str,
) -> Result<(), RangeFault> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(RangeFault { path: path.into(), value, least: Some(least), most: Some(most), above: None, unit })
}

/// Surfaces in metres, +Y up, +X east, -Z north.
#[derive(Clone, Debug, Default)]
pub struct LitScene {
    /// Corners.
    pub points: Vec<DVec3>,
    /// Rows of `points`, counter-clockwise seen from the front. Both sides of each triangle receive light.
    pub triangles: Vec<[u32; 3]>,
    /// Owner of each triangle: a row of `receivers`. Consecutive triangles of one receiver are cheapest.
    pub owners: Vec<u32>,
    /// Optical properties of each owner.
    pub receivers: Vec<Optics>,
}

/// Most triangles of a patch: neighbours of one receiver that scatter light together. Two rings of a tube of eight
/// sides.
const PATCH_TRIANGLES: usize = 32;

/// Largest distance, metres: farther away, sub-pixels of lines would no longer be whole numbers.
const FARTHEST_M: f64 = 1e5;

/// Groups of triangles of one receiver that scatter light evenly, each side by itself.
#[derive(Clone, Debug, Default)]
pub(crate) struct Patches {
    /// Patch of each triangle.
    pub(crate) of_triangle: Vec<u32>,
    /// Row of the receiver.
    pub(crate) receiver: Vec<u32>,
    /// Area of each patch, square metres.
    pub(crate) area: Vec<f64>,
}

impl LitScene {
    /// Returns the normal of a triangle, of twice its area in length.
    pub(crate) fn normal(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.triangles[triangle].map(|i| self.points[i as usize]);
        (b - a).cross(c - a)
    }

    pub(crate) fn check(&self, budget: &Budget) -> Result<(), LightError> {
        let advice = "choose fewer or coarser plants";
        budget.check(Counted::Triangles, self.triangles.len() as u64, advice)?;
        for optics in &self.receivers {
            optics.check()?;
        }
        let is_near = |i: &u32| {
            let point = self.points.get(*i as usize);
            point.is_some_and(|p| p.is_finite() && p.abs().max_element() <= FARTHEST_M)
        };
        if let Some(triangle) = self.triangles.iter().position(|t| !t.iter().all(is_near)) {
            return Err(LightError::FarAway { triangle, most_m: FARTHEST_M });
        }
        let owned = self.owners.len() == self.triangles.len()
            && self.owners.iter().all(|o| (*o as usize) < self.receivers.len());
        let has_area = (0..self.triangles.len()).any(|t| self.normal(t).length_squared() > 0.0);
        if owned && has_area { Ok(()) } else { Err(LightError::Empty) }
    }

    pub(crate) fn patches(&self) -> Patches {
        let mut patches = Patches::default();
        let mut size = 0;
        for (triangle, owner) in self.owners.iter().enumerate() {
            if size == PATCH_TRIANGLES || patches.receiver.last() != Some(owner) {
                patches.receiver.push(*owner);
                patches.area.push(0.0);
                size = 0;
            }
            size += 1;
            if let Some(area) = patches.area.last_mut() {
                *area += 0.5 * self.normal(triangle).length();
            }
            patches.of_triangle.push(u32::try_from(patches.receiver.len() - 1).unwrap_or(u32::MAX));
        }
        patches
    }
}
