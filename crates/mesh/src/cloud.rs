//! Points of a scan.

use base::{Digest, Digestible};
use glam::DVec3;

use crate::Bounds;

/// A scanned cloud of points. f64, as scans lie far from their origin.
///
/// ```
/// use glam::DVec3;
/// let c = mesh::PointCloud { points: vec![DVec3::ZERO, DVec3::Y], colors: vec![] };
/// assert_eq!(c.bounds().size(), DVec3::Y);
/// assert!(c.is_sound());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// Metres, +Y up, finite.
    pub points: Vec<DVec3>,
    /// sRGB bytes; empty or one a point.
    pub colors: Vec<[u8; 3]>,
}

impl PointCloud {
    /// Every point is finite, and colours are absent or complete.
    pub fn is_sound(&self) -> bool {
        self.points.iter().all(|p| p.is_finite())
            && (self.colors.is_empty() || self.colors.len() == self.points.len())
    }

    /// The box around all points.
    pub fn bounds(&self) -> Bounds {
        let mut b = Bounds::EMPTY;
        self.points.iter().for_each(|&p| b.include(p));
        b
    }

    /// The points of the given rows, in that order, with their colours. Rows beyond the end are left out.
    #[must_use]
    pub fn select(&self, rows: &[usize]) -> Self {
        Self {
            points: rows.iter().filter_map(|&i| self.points.get(i).copied()).collect(),
            colors: rows.iter().filter_map(|&i| self.colors.get(i).copied()).collect(),
        }
    }
}

impl Digestible for PointCloud {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.points).add(&self.colors);
    }
}
