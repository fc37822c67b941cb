//! Units and up axes of files: inside, everything is in metres, +Y up.

use base::{Unit, UpAxis};
use glam::DVec3;
use mesh::Model;

/// Unit and up axis of a file whose format does not fix them (OBJ, PLY, STL, USD).
///
/// ```
/// use base::{Unit, UpAxis};
/// let spec = formats::ExportSpec { up: UpAxis::Z, unit: Unit::Centimetre };
/// assert_eq!(spec.point([1.0, 2.0, 3.0]), [100.0, -300.0, 200.0]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExportSpec {
    /// The up axis; the default is +Y.
    pub up: UpAxis,
    /// The unit of length; the default is metres.
    pub unit: Unit,
}

impl ExportSpec {
    /// Returns whether the file is in metres, +Y up.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Converts a model's position to the unit and axes of the file.
    pub fn point(&self, p: [f32; 3]) -> [f32; 3] {
        let per_metre = match self.unit {
            Unit::Metre => return self.direction(p),
            Unit::Centimetre => 100.0,
            Unit::Millimetre => 1000.0,
            Unit::Foot => 1.0 / 0.3048,
        };
        self.direction(p).map(|x| x * per_metre)
    }

    /// Converts a model's direction to the axes of the file.
    pub fn direction(&self, n: [f32; 3]) -> [f32; 3] {
        match self.up {
            UpAxis::Y => n,
            UpAxis::Z => [n[0], -n[2], n[1]],
        }
    }

    /// Converts a point of the file to metres, +Y up.
    ///
    /// ```
    /// use base::{Unit, UpAxis};
    /// let spec = formats::ExportSpec { up: UpAxis::Z, unit: Unit::Centimetre };
    /// assert_eq!(spec.inward(glam::DVec3::new(0.0, 0.0, 300.0)), glam::DVec3::new(0.0, 3.0, 0.0));
    /// ```
    pub fn inward(&self, p: DVec3) -> DVec3 {
        let turned = if self.up == UpAxis::Z { DVec3::new(p.x, p.z, -p.y) } else { p };
        // No factor of 1: it would change the sign of a zero.
        if self.unit == Unit::Metre { turned } else { turned * self.unit.metres() }
    }

    /// Converts a place or offset in metres, +Y up, to the unit and axes of the file.
    pub fn place(&self, p: DVec3) -> [f64; 3] {
        let p = if self.up == UpAxis::Z { DVec3::new(p.x, -p.z, p.y) } else { p };
        (p * (1.0 / self.unit.metres())).to_array()
    }

    /// Returns a line on the offset that was subtracted from all positions, in the unit and axes of the file; empty
    /// if there was none.
    pub(crate) fn offset_line(&self, offset_m: Option<DVec3>, mark: &str) -> String {
        offset_m.map_or(String::new(), |o| {
            let [x, y, z] = self.place(o);
            format!("{mark} offset {x} {y} {z}\n")
        })
    }

    /// Converts a model that was read to metres, +Y up.
    pub(crate) fn import(&self, model: &mut Model) {
        if self.is_default() {
            return;
        }
        let turn = |p: [f32; 3]| match self.up {
            UpAxis::Y => p,
            UpAxis::Z => [p[0], p[2], -p[1]],
        };
        #[expect(clippy::cast_possible_truncation, reason = "0.01 and 0.001 as f32")]
        let metres = self.unit.metres() as f32;
        for part in &mut model.parts {
            part.mesh.positions.iter_mut().for_each(|p| *p = turn(*p).map(|x| x * metres));
            part.mesh.pivots.iter_mut().for_each(|p| *p = turn(*p).map(|x| x * metres));
            part.mesh.normals.iter_mut().for_each(|n| *n = turn(*n));
        }
    }
}
