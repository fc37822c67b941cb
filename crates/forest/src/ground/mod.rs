//! The ground of a stand: flat, a map of heights, or triangles.

mod map;
mod mask;
mod mesh;
mod png_gray;

use base::{Cancelled, OverBudget, Run};
use glam::DVec3;

use crate::Stand;

pub use map::{HeightMap, MapScale};
pub use mask::Mask;
pub use mesh::GroundMesh;

/// Ground of a stand. Coordinates are those of [`Stand`]: +X east, +Y up, +Z south.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Ground {
    /// The plane y = 0.
    #[default]
    Flat,
    /// A grid of heights.
    Map(HeightMap),
    /// Triangles.
    Mesh(GroundMesh),
}

impl Ground {
    /// Returns the height at a place; none outside of the ground and where it has no data. Cost: constant; on
    /// triangles, linear in those of one cell.
    ///
    /// ```
    /// assert_eq!(forest::Ground::Flat.height_m(3.0, 4.0), Some(0.0));
    /// ```
    pub fn height_m(&self, x: f64, z: f64) -> Option<f64> {
        match self {
            Self::Flat => Some(0.0),
            Self::Map(map) => map.sample(x, z).map(|(height, _)| height),
            Self::Mesh(mesh) => mesh.sample(x, z).map(|(height, _)| height),
        }
    }

    /// Returns the unit normal at a place, upwards; none as for [`height_m`](Self::height_m).
    pub fn normal(&self, x: f64, z: f64) -> Option<DVec3> {
        match self {
            Self::Flat => Some(DVec3::Y),
            Self::Map(map) => map.sample(x, z).map(|(_, normal)| normal),
            Self::Mesh(mesh) => mesh.sample(x, z).map(|(_, normal)| normal),
        }
    }

    /// Sets trees onto the ground, and leans them: `lean` 0 leaves them upright, 1 sets them square to the slope.
    /// Trees outside of the ground stay where they are; returns their number.
    ///
    /// # Errors
    /// [`Cancelled`]: some trees may already be set.
    pub fn set_down(&self, stand: &mut Stand, lean: f64, run: &Run<'_>) -> Result<u32, Cancelled> {
        let mut outside = 0;
        for trees in stand.trees.chunks_mut(4096) {
            run.cancel.check()?;
            for tree in trees {
                let (x, z) = (tree.foot_m.x, tree.foot_m.z);
                match (self.height_m(x, z), self.normal(x, z)) {
                    (Some(height), Some(normal)) => {
                        tree.foot_m.y = height;
                        tree.up = DVec3::Y.lerp(normal, lean.clamp(0.0, 1.0)).normalize();
                    }
                    _ => outside += 1,
                }
            }
        }
        Ok(outside)
    }
}

/// Error of making a ground or mask.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GroundError {
    /// The bytes are not such a picture.
    #[error("the {0} cannot be read: {1}")]
    Unreadable(&'static str, String),
    /// A height map with too few distinct heights.
    #[error(
        "the height map has {0}: its ground would be terraces. Save it with 16 bits of grey, or as GeoTIFF of heights"
    )]
    Depth(String),
    /// A map without a place, or in degrees.
    #[error("the GeoTIFF {0}")]
    Placement(&'static str),
    /// No cell has a height.
    #[error("the height map has no data in any cell")]
    NoData,
    /// A map or mesh that is too small.
    #[error("the {0} is too small: it needs at least {1}")]
    TooSmall(&'static str, &'static str),
    /// Numbers of a mesh or a scale that give no ground.
    #[error("the ground's {0}")]
    Numbers(&'static str),
    /// Too many cells or triangles.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
}

base::coded!(GroundError {
    Self::Unreadable(what, why) => "ground-unreadable" { what, why },
    Self::Depth(depth) => "ground-depth" { depth },
    Self::Placement(why) => "ground-placement" { why },
    Self::NoData => "ground-no-data" {},
    Self::TooSmall(what, least) => "ground-too-small" { what, least },
    Self::Numbers(why) => "ground-numbers" { why },
} wraps {
    Self::OverBudget(e) => e, OverBudget;
});
