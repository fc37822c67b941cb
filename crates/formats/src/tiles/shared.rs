//! A plant's glTF that many tiles refer to.

use std::io;

use base::Digest;
use glam::DVec3;
use mesh::Bounds;
use serde_json::{Value, json};

use crate::error::WriteError;
use crate::model::{BesideFile, ModelFiles, decode_uri, encoded};

/// Largest number of sixteen bits: positions of packed meshes are normalised.
const MOST: f64 = 65_535.0;
/// Component type `UNSIGNED_SHORT` of glTF.
const U16: u64 = 5123;
/// Number of digits of a digest in a picture's name.
const DIGITS: usize = 16;

/// A mesh of a shared model, and the cube that its positions fill.
#[derive(Clone, Debug)]
pub(super) struct SharedPart {
    pub(super) mesh: usize,
    pub(super) origin: DVec3,
    pub(super) size: f64,
}

/// A model to which tiles refer: its glTF document, with the places of its buffer and pictures.
#[derive(Clone, Debug)]
pub struct SharedModel {
    pub(super) root: Value,
    pub(super) parts: Vec<SharedPart>,
    bounds: Bounds,
    triangles: u64,
}

impl SharedModel {
    /// Reads the glTF text of one plant from [`gltf_files`](crate::gltf_files), plain or packed, without levels,
    /// instances and joints. `folder` leads from a tile to the folder of its files and ends with `/`; empty for the
    /// same folder.
    ///
    /// # Errors
    /// [`WriteError::Io`] for a document of another form.
    pub fn read(gltf: &[u8], folder: &str) -> Result<Self, WriteError> {
        let mut root: Value = serde_json::from_slice(gltf).map_err(|e| other(&e.to_string()))?;
        for list in ["buffers", "images"] {
            let rows = root.get_mut(list).and_then(Value::as_array_mut);
            for row in rows.into_iter().flatten() {
                if let Some(uri) = row.get("uri").and_then(Value::as_str) {
                    row["uri"] = format!("{folder}{uri}").into();
                }
            }
        }
        let mut parts = Vec::new();
        for node in list(&root, "nodes") {
            let Some(mesh) = index(node, "mesh") else { continue };
            if node.get("extensions").is_some() || node.get("skin").is_some() {
                return Err(other("a shared model may hold neither instances nor joints"));
            }
            let numbers = |key| node.get(key).and_then(Value::as_array).map(|a| numbers(a));
            let origin = numbers("translation").unwrap_or_default();
            let size = numbers("scale").map_or(1.0, |s| s.x);
            parts.push(SharedPart { mesh, origin, size });
        }
        let mut shared = Self { root, parts, bounds: Bounds::EMPTY, triangles: 0 };
        (shared.bounds, shared.triangles) = shared.measured()?;
        Ok(shared)
    }

    /// Returns its bounding box, metres, +Y up; empty for a model without triangles.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns the number of its triangles.
    pub fn triangles(&self) -> u64 {
        self.triangles
    }

    fn measured(&self) -> Result<(Bounds, u64), WriteError> {
        let (mut bounds, mut triangles) = (Bounds::EMPTY, 0);
        let (accessors, meshes) = (list(&self.root, "accessors"), list(&self.root, "meshes"));
        for part in &self.parts {
            let mesh = meshes.get(part.mesh).ok_or_else(|| other("a node names a mesh that is not there"))?;
            for primitive in list(mesh, "primitives") {
                let indices = index(primitive, "indices").and_then(|i| accessors.get(i));
                triangles += indices.and_then(|a| a["count"].as_u64()).unwrap_or(0) / 3;
                let positions = index(&primitive["attributes"], "POSITION").and_then(|i| accessors.get(i));
                let positions = positions.ok_or_else(|| other("a mesh has no positions"))?;
                let steps = if positions["componentType"] == U16 { MOST } else { 1.0 };
                for end in ["min", "max"] {
                    let corner = positions[end].as_array().map(|a| numbers(a));
                    let corner = corner.ok_or_else(|| other("positions have no bounds"))?;
                    bounds.include(part.origin + corner / steps * part.size);
                }
            }
        }
        Ok((bounds, triangles))
    }
}

/// Renames the pictures of a plant's files after their bytes, so that plants of one species share them; names begin
/// with `stem`.
///
/// # Errors
/// [`WriteError::Io`] for files that [`gltf_files`](crate::gltf_files) did not write.
pub fn share_pictures(mut files: ModelFiles, stem: &str) -> Result<ModelFiles, WriteError> {
    let mut root: Value = serde_json::from_slice(&files.own).map_err(|e| other(&e.to_string()))?;
    let mut beside: Vec<BesideFile> = Vec::with_capacity(files.beside.len());
    for mut file in files.beside {
        if file.what != crate::Beside::Textures {
            beside.push(file);
            continue;
        }
        let mut digest = Digest::new();
        digest.bytes(&file.bytes);
        let mut hex = digest.hex();
        hex.truncate(DIGITS);
        let ending = file.name.rsplit('.').next().unwrap_or("png").to_owned();
        let name = format!("{stem}-{hex}.{ending}");
        for image in root["images"].as_array_mut().into_iter().flatten() {
            if image["uri"]
                .as_str()
                .is_some_and(|uri| uri == file.name || decode_uri(uri).as_ref() == Some(&file.name))
            {
                *image = json!({ "uri": encoded(&name), "mimeType": image["mimeType"] });
            }
        }
        if !beside.iter().any(|f| f.name == name) {
            file.name = name;
            beside.push(file);
        }
    }
    files.beside = beside;
    files.own = serde_json::to_vec(&root).map_err(|e| other(&e.to_string()))?;
    Ok(files)
}

pub(super) fn other(what: &str) -> WriteError {
    WriteError::Io(io::Error::other(what.to_owned()))
}

/// Returns the rows of a list of a document.
pub(super) fn list<'a>(of: &'a Value, name: &str) -> &'a [Value] {
    of.get(name).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// Returns a number of a row.
pub(super) fn index(row: &Value, name: &str) -> Option<usize> {
    usize::try_from(row.get(name)?.as_u64()?).ok()
}

fn numbers(row: &[Value]) -> DVec3 {
    let at = |k: usize| row.get(k).and_then(Value::as_f64).unwrap_or(0.0);
    DVec3::new(at(0), at(1), at(2))
}
