//! Meshes that stand in many places.

use glam::{DQuat, DVec3};

use crate::{MaterialId, Part, TriMesh};

/// Where a copy stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyPlace {
    /// Of the mesh's origin, metres.
    pub at: DVec3,
    /// How it is turned.
    pub turn: DQuat,
    /// How much larger it is.
    pub scale: f64,
    /// By what its colour is multiplied, linear RGB.
    pub color: [f32; 3],
}

/// A mesh once, and all the places where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Copies {
    /// Name of the part that they are of.
    pub name: String,
    /// Its material.
    pub material: MaterialId,
    /// The mesh, in its own coordinates.
    pub mesh: TriMesh,
    /// Places, at least one.
    pub places: Vec<CopyPlace>,
}

impl Copies {
    /// All copies as one part, as programs without instances need them.
    pub fn flattened(&self) -> Part {
        let mut mesh = TriMesh::default();
        for place in &self.places {
            #[expect(clippy::cast_possible_truncation, reason = "meshes are f32 by design")]
            let narrow = |p: DVec3| p.to_array().map(|x| x as f32);
            let wide = |p: &[f32; 3]| DVec3::from(p.map(f64::from));
            let times = |c: &[f32; 3]| [0, 1, 2].map(|k| c[k] * place.color[k]);
            let local = &self.mesh;
            let mut copy = TriMesh {
                positions: local
                    .positions
                    .iter()
                    .map(|p| narrow(place.at + place.turn * wide(p) * place.scale))
                    .collect(),
                normals: local.normals.iter().map(|n| narrow(place.turn * wide(n))).collect(),
                colors: local.colors.iter().map(times).collect(),
                ..local.clone()
            };
            copy.colors.resize(copy.positions.len(), place.color);
            mesh.append(&copy);
        }
        Part { name: self.name.clone(), material: self.material, mesh }
    }
}
