//! Meshes with many places.

use glam::{DQuat, DVec3};

use crate::{MaterialId, Part, TriMesh};

/// Place of a copy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyPlace {
    /// Position of the mesh's origin, metres.
    pub at: DVec3,
    /// Rotation.
    pub turn: DQuat,
    /// Scale factor.
    pub scale: f64,
    /// Factor of its colour, linear RGB.
    pub color: [f32; 3],
}

/// A mesh, stored once, and the places of all its copies.
#[derive(Clone, Debug, PartialEq)]
pub struct Copies {
    /// Name of the part that the copies form.
    pub name: String,
    /// Its material.
    pub material: MaterialId,
    /// The mesh, in its own coordinates.
    pub mesh: TriMesh,
    /// Places, at least one.
    pub places: Vec<CopyPlace>,
}

impl Copies {
    /// Returns all copies as one part, for programs without instances.
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
