//! Triangle meshes and materials: the result of every maker, and the source of files and pictures.
//!
//! `plant -> skin -> Model -> formats | render`
//!
//! Knows nothing of plants or GPUs. f32/u32 columns in metres, right-handed, +Y up.

mod cloud;
mod copies;
mod material;
mod rig;
mod standing;
mod trimesh;

pub use cloud::{PointClass, PointCloud};
pub use copies::{Copies, CopyPlace};
pub use material::{AlphaMode, Impostor, Maps, Material, MaterialId, MaterialKind, Texture};
pub use rig::{Hold, Joint, Rig};
pub use standing::{Standing, scene_copies, scene_model};
pub use trimesh::{Bounds, MeshFault, Model, Part, TriMesh};
