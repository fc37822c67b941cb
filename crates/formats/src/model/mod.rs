//! bytes <-> [`mesh::Model`].

mod axes;
mod glb_write;
mod gltf;
mod picture;

use mesh::Model;

pub use axes::ExportSpec;
pub use glb_write::{write_glb, write_glb_with};
pub use picture::{PngCache, read_picture, write_png};

use crate::error::WriteError;

/// The file formats that hold models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ModelFormat {
    /// Binary glTF 2.0: one file with textures and materials.
    Glb,
    /// glTF 2.0 as JSON with embedded buffers; read only.
    Gltf,
    /// Wavefront OBJ with its material file and textures beside it.
    Obj,
    /// Polygon file format: one mesh with colours at its vertices.
    Ply,
    /// Stereolithography: bare triangles.
    Stl,
}

impl ModelFormat {
    /// Every format.
    pub const ALL: [Self; 5] = [Self::Glb, Self::Gltf, Self::Obj, Self::Ply, Self::Stl];

    /// The name for messages.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Glb => "GLB",
            Self::Gltf => "glTF",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
        }
    }

    /// The format that a file's extension (without the dot, any case) stands for.
    ///
    /// ```
    /// use formats::ModelFormat;
    /// assert_eq!(ModelFormat::from_extension("GLB"), Some(ModelFormat::Glb));
    /// ```
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "glb" => Some(Self::Glb),
            "gltf" => Some(Self::Gltf),
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            _ => None,
        }
    }

    /// The format that the first bytes of a file look like. A binary STL has no mark and is not recognised.
    pub fn sniff(start: &[u8]) -> Option<Self> {
        let text = start.trim_ascii_start();
        if start.starts_with(b"glTF") {
            Some(Self::Glb)
        } else if start.starts_with(b"ply\n") || start.starts_with(b"ply\r") {
            Some(Self::Ply)
        } else if text.starts_with(b"solid ") {
            Some(Self::Stl)
        } else if text.starts_with(b"{") && start.windows(7).any(|w| w == b"\"asset\"") {
            Some(Self::Gltf)
        } else if [&b"v "[..], b"vn ", b"mtllib ", b"o ", b"g "].iter().any(|w| text.starts_with(w)) {
            Some(Self::Obj)
        } else {
            None
        }
    }

    /// The axes and the unit are the format's own: metres, +Y up.
    pub const fn fixed_axes(self) -> bool {
        matches!(self, Self::Glb | Self::Gltf)
    }
}

/// Refuses models that no file should be made of. Degenerate triangles may pass.
pub(crate) fn check(model: &Model) -> Result<(), WriteError> {
    for part in &model.parts {
        let fail = |fault| Err(WriteError::Model { part: part.name.clone(), fault });
        if part.material.index() >= model.materials.len() {
            return fail(mesh::Fault::Material(part.material.index()));
        }
        // Odd normals are mended on the way out.
        let bad = part.mesh.validate();
        let mut bad = bad.filter(|f| !matches!(f, mesh::Fault::Degenerate(_) | mesh::Fault::Normal(_)));
        if let Some(fault) = bad.next() {
            return fail(fault);
        }
    }
    Ok(())
}

/// A unit normal in any case: glTF's validator and lighting demand it.
pub(crate) fn unit(n: [f32; 3]) -> [f32; 3] {
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    if (length - 1.0).abs() < 1e-4 {
        n
    } else if length > 0.0 && length.is_finite() {
        n.map(|x| x / length)
    } else {
        [0.0, 1.0, 0.0]
    }
}
