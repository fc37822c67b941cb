//! Points of a scan.

use base::{Digest, Digestible};
use glam::DVec3;

use crate::Bounds;

/// The class of a point of a scan, as its file names it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PointClass {
    /// Nothing.
    #[default]
    Unknown,
    /// It lies on the ground.
    Ground,
    /// It lies on wood.
    Wood,
    /// It lies on a leaf.
    Leaf,
}

base::words!(PointClass { Unknown = "unknown", Ground = "ground", Wood = "wood", Leaf = "leaf" });

/// A scanned cloud of points. f64, as scans lie far from their origin.
///
/// ```
/// use glam::DVec3;
/// let c = mesh::PointCloud { points: vec![DVec3::ZERO, DVec3::Y], ..mesh::PointCloud::default() };
/// assert_eq!(c.bounds().size(), DVec3::Y);
/// assert!(c.is_sound());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// Positions in metres, +Y up, finite.
    pub points: Vec<DVec3>,
    /// sRGB bytes; empty or one colour for each point.
    pub colors: Vec<[u8; 3]>,
    /// Classes of the points in their file; empty, or one for each point.
    pub classes: Vec<PointClass>,
    /// Offset that was subtracted from all points, metres.
    pub offset_m: Option<DVec3>,
}

impl PointCloud {
    /// Returns whether every point is finite, and colours are absent or complete.
    pub fn is_sound(&self) -> bool {
        let fits = |rows: usize| rows == 0 || rows == self.points.len();
        self.points.iter().all(|p| p.is_finite()) && fits(self.colors.len()) && fits(self.classes.len())
    }

    /// Returns the box around all points.
    pub fn bounds(&self) -> Bounds {
        let mut b = Bounds::EMPTY;
        self.points.iter().for_each(|&p| b.include(p));
        b
    }

    /// Returns the offset to subtract from the points of a cloud that lies a kilometre or more from its origin, such
    /// as one in UTM coordinates, where the single precision of meshes is a tenth of a millimetre and worse: its
    /// centre in whole metres. `None` for a cloud near its origin.
    pub fn far_offset(points: &[DVec3]) -> Option<DVec3> {
        let middle = |axis: fn(&DVec3) -> f64| {
            let mut x: Vec<f64> = points.iter().map(axis).collect();
            let half = x.len() / 2;
            // The median: stray points and zeros for missing ones do not move it.
            base::sort_numbers(&mut x);
            x.get(half).map_or(0.0, |x| x.round())
        };
        let middle = DVec3::new(middle(|p| p.x), middle(|p| p.y), middle(|p| p.z));
        (middle.abs().max_element() >= 1000.0 && middle.is_finite()).then_some(middle)
    }

    /// Returns the points of the given rows, in that order, with their colours. Rows beyond the end are left out.
    #[must_use]
    pub fn select(&self, rows: &[usize]) -> Self {
        Self {
            points: rows.iter().filter_map(|&i| self.points.get(i).copied()).collect(),
            colors: rows.iter().filter_map(|&i| self.colors.get(i).copied()).collect(),
            classes: rows.iter().filter_map(|&i| self.classes.get(i).copied()).collect(),
            offset_m: self.offset_m,
        }
    }
}

impl Digestible for PointCloud {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.points).add(&self.colors);
    }
}
