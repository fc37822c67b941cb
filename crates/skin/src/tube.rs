//! A closed tube around a line with radii.

use glam::DVec3;
use mesh::TriMesh;

use crate::rings::{drawn, rings};
use crate::sleeve::{Circle, Sleeve, drop_flat};
use crate::spine::Spine;

/// Settings of a [`tube`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TubeSpec {
    /// Sides of the cross-section, 3 to 64.
    pub sides: u32,
    /// Cross-sections along the tube, 2 or more; fewer are made if they would stand closer than about a third of the
    /// radius.
    pub rings: u32,
    /// Repetitions of the texture around the tube, 1 or more.
    pub repeats: u32,
}

impl Default for TubeSpec {
    fn default() -> Self {
        Self { sides: 8, rings: 32, repeats: 1 }
    }
}

/// Makes a closed tube around a smooth line through `points`, with a radius at each, both in metres.
///
/// Guaranteed: unit normals; finite for any input; the surface is closed, its base flat, its end round (beyond the last
/// point by nine tenths of the radius); u runs around from 0 to `repeats` with the first column repeated, v along it in
/// the same measure, so that texels are square. Points that are not finite or repeat are left out; fewer than 2 points
/// give an empty mesh. Radii below 1/2000 of the length are raised to that. Not guaranteed: that parts of a line that
/// passes near itself stay apart.
///
/// ```
/// use glam::DVec3;
/// let mesh = skin::tube(&[DVec3::ZERO, DVec3::Y], &[0.1, 0.05], &skin::TubeSpec::default());
/// assert_eq!(mesh.validate().count(), 0);
/// ```
pub fn tube(points: &[DVec3], radii: &[f64], spec: &TubeSpec) -> TriMesh {
    let count = f64::from(spec.rings.max(2));
    let Some(spine) = Spine::new(points, radii, 4 * spec.rings.max(2) as usize, None) else {
        return TriMesh::default();
    };
    let circle = Circle::new(spec.sides);
    let (line, first) = drawn(&spine, None, count, |_| f64::INFINITY);
    let rings = rings(&line, first);
    let mut mesh = TriMesh::default();
    let mut out = Sleeve::new(&mut mesh, &circle, spec.repeats);
    out.flat_base(&rings[0]);
    out.rings(&rings);
    out.round_tip(&rings[rings.len() - 1], 2);
    drop_flat(&mut mesh);
    mesh
}
