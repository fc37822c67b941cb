//! glTF as text: splits a binary glTF into its JSON, one buffer and its pictures.

use std::io;

use serde_json::{Value, json};

use super::glb_pack::COMPRESSION;
use super::gltf_bytes::chunks;
use super::picture::WEBP_TYPE;
use super::{BesideFile, FileStems, ModelFiles, file_name};
use crate::error::WriteError;
use crate::{Beside, ModelFormat};

/// Splits a binary glTF from one of the writers here: the text, `STEM.bin` with the rest of its buffer, and each
/// picture as `STEM-NAME.png` (`.jpg`, `.webp`). The contents stay the same: extensions, levels, instances, joints.
///
/// Guaranteed: the same file gives the same bytes.
/// Cost: linear; all of it is in memory twice.
///
/// # Errors
/// [`WriteError::Io`] for bytes that are not a binary glTF with one buffer in it.
pub(super) fn text_files(glb: &[u8], stems: FileStems<'_>) -> Result<ModelFiles, WriteError> {
    let other = |e: &dyn std::fmt::Display| WriteError::Io(io::Error::other(e.to_string()));
    let (text, bin) = chunks(glb, ModelFormat::Glb).map_err(|e| other(&e))?;
    let mut root: Value = serde_json::from_slice(text).map_err(|e| other(&e))?;
    let bin = bin.unwrap_or_default();
    let views = rows(&mut root, "bufferViews");
    let mut pictures = Pictures::new(file_name(stems.textures, "model"));
    let mut images = rows(&mut root, "images");
    for image in &mut images {
        let Some(view) = index(image, "bufferView") else { continue };
        let range = views.get(view).and_then(|view| range(view, bin)).ok_or_else(broken)?;
        let uri = encoded(&pictures.add(image, view, range));
        if let Some(image) = image.as_object_mut() {
            image.remove("bufferView");
            image.insert("uri".into(), uri.into());
        }
    }
    let Pictures { files, views: taken, .. } = pictures;
    let (views, buffer, places) = without(views, bin, &taken)?;
    let mut accessors = rows(&mut root, "accessors");
    for accessor in &mut accessors {
        if let Some(view) = index(accessor, "bufferView") {
            accessor["bufferView"] = places.get(view).copied().flatten().ok_or_else(broken)?.into();
        }
    }
    let mut all = Vec::with_capacity(files.len() + 1);
    let mut buffers = rows(&mut root, "buffers");
    if buffer.is_empty() {
        buffers.clear();
    } else if let Some(own) = buffers.first_mut() {
        let name = format!("{}.bin", file_name(stems.model, "model"));
        own["uri"] = encoded(&name).into();
        own["byteLength"] = buffer.len().into();
        all.push(BesideFile { what: Beside::Buffer, name, bytes: buffer });
    }
    all.extend(files);
    let lists = [("bufferViews", views), ("images", images), ("accessors", accessors), ("buffers", buffers)];
    for (name, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
        root[name] = Value::Array(list);
    }
    let mut own = serde_json::to_vec_pretty(&root).map_err(|e| other(&e))?;
    own.push(b'\n');
    Ok(ModelFiles { own, beside: all })
}

fn broken() -> WriteError {
    WriteError::Io(io::Error::other("the binary glTF names bytes that it does not have"))
}

/// Removes a list from the document and returns it.
fn rows(root: &mut Value, name: &str) -> Vec<Value> {
    let taken = root.as_object_mut().and_then(|root| root.remove(name));
    if let Some(Value::Array(rows)) = taken { rows } else { Vec::new() }
}

fn index(row: &Value, name: &str) -> Option<usize> {
    usize::try_from(row.get(name)?.as_u64()?).ok()
}

/// Returns the bytes that a view, or its compressed form, names.
fn range<'a>(view: &Value, bin: &'a [u8]) -> Option<&'a [u8]> {
    let from = index(view, "byteOffset").unwrap_or(0);
    bin.get(from..from.checked_add(index(view, "byteLength")?)?)
}

/// The views except those of pictures, the rest of the buffer, and the new row of each view.
type Rest = (Vec<Value>, Vec<u8>, Vec<Option<usize>>);

fn without(views: Vec<Value>, bin: &[u8], taken: &[usize]) -> Result<Rest, WriteError> {
    let (mut kept, mut buffer, mut places) = (Vec::new(), Vec::new(), Vec::new());
    for (k, mut view) in views.into_iter().enumerate() {
        if taken.contains(&k) {
            places.push(None);
            continue;
        }
        // The data of a compressed view lie where its extension says; the view itself describes them after
        // decompression.
        let is_packed = view.pointer(&format!("/extensions/{COMPRESSION}")).is_some();
        let place = if is_packed { &mut view["extensions"][COMPRESSION] } else { &mut view };
        let bytes = range(place, bin).ok_or_else(broken)?;
        place["byteOffset"] = json!(buffer.len());
        buffer.extend_from_slice(bytes);
        buffer.resize(buffer.len().next_multiple_of(4), 0);
        places.push(Some(kept.len()));
        kept.push(view);
    }
    Ok((kept, buffer, places))
}

/// The pictures of a file, each with a name of its own.
struct Pictures {
    stem: String,
    files: Vec<BesideFile>,
    /// The views of the pictures.
    views: Vec<usize>,
}

impl Pictures {
    fn new(stem: String) -> Self {
        Self { stem, files: Vec::new(), views: Vec::new() }
    }

    /// Adds a picture, and returns the name of its file.
    fn add(&mut self, image: &Value, view: usize, bytes: &[u8]) -> String {
        let word = |key| image.get(key).and_then(Value::as_str).unwrap_or_default();
        let ending = match word("mimeType") {
            "image/jpeg" => "jpg",
            WEBP_TYPE => "webp",
            _ => "png",
        };
        let mut stem = format!("{}-{}", self.stem, file_name(word("name"), "texture"));
        // On some disks, two names that differ only in case are the same file.
        let is_taken = |stem: &str| {
            let same =
                |file: &BesideFile| file.name.to_lowercase() == format!("{stem}.{ending}").to_lowercase();
            self.files.iter().any(same)
        };
        while is_taken(&stem) {
            stem.push_str("-2");
        }
        let name = format!("{stem}.{ending}");
        self.views.push(view);
        self.files.push(BesideFile { what: Beside::Textures, name: name.clone(), bytes: bytes.to_vec() });
        name
    }
}

/// Returns a file's name as a URI: characters beyond ASCII as `%e8%8a%b1`.
pub(crate) fn encoded(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    for byte in name.bytes() {
        match byte {
            b'0'..=b'9' | b'A'..=b'Z' | b'a'..=b'z' | b'-' | b'_' | b'.' => out.push(char::from(byte)),
            _ => out.push_str(&format!("%{byte:02x}")),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use base::Report;
    use glam::{DQuat, DVec3};
    use mesh::{Copies, CopyPlace, Material, MaterialKind, Model, Part, Texture, TriMesh};

    use super::*;
    use crate::model::{
        Level, NoFile, Packing, PngCache, SideFile, gltf_files, model_files, read_model, write_glb_levels,
    };
    use crate::{ExportSpec, ModelFormat};

    /// Returns a square with a texture whose every pixel has the colour `red`.
    fn model(names: &[&str]) -> Model {
        let mut mesh = TriMesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            uvs: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..TriMesh::default()
        };
        mesh.compute_normals();
        let mut model = Model { name: "plant".into(), ..Model::default() };
        for (k, name) in names.iter().enumerate() {
            let mut material = Material::plain(*name, MaterialKind::Leaf, [1.0; 3]);
            let red = u8::try_from(k).unwrap();
            let pixels = [red, 7, 9, if k == 0 { 0 } else { 255 }].repeat(16);
            material.texture = Some(Arc::new(Texture { width: 4, height: 4, pixels }));
            let at = mesh::MaterialId::new(k);
            model.materials.push(material);
            model.parts.push(Part { name: format!("part {k}"), material: at, mesh: mesh.clone() });
        }
        model
    }

    fn read(files: &ModelFiles) -> Model {
        let there = |file: SideFile<'_>| {
            let found = files.beside.iter().find(|f| f.name == file.name);
            found.map(|f| f.bytes.clone()).ok_or(NoFile::Missing)
        };
        let mut report = Report::default();
        let spec = ExportSpec::default();
        let read = read_model(&files.own[..], ModelFormat::Gltf, "plant", &spec, &there, &mut report);
        assert!(report.warnings.is_empty(), "{:?}", report.warnings);
        read.expect("reads")
    }

    fn read_glb(glb: &[u8]) -> Model {
        let (spec, mut report) = (ExportSpec::default(), Report::default());
        read_model(glb, ModelFormat::Glb, "plant", &spec, &crate::no_files, &mut report).expect("reads")
    }

    #[test]
    fn the_files_hold_what_the_binary_file_does() {
        let model = model(&["leaf", "Leaf", "花"]);
        let (spec, mut report) = (ExportSpec::default(), Report::default());
        let files =
            model_files(&model, ModelFormat::Gltf, "my oak", &spec, &mut PngCache::new(), &mut report);
        let files = files.expect("writes");
        let names: Vec<&str> = files.beside.iter().map(|f| &f.name[..]).collect();
        assert_eq!(
            names,
            ["my-oak.bin", "my-oak-leaf.png", "my-oak-Leaf-2.png", "my-oak-花.png"],
            "no two differ by case alone"
        );
        assert!(String::from_utf8(files.own.clone()).unwrap().contains("\"my-oak-%e8%8a%b1.png\""));
        assert_eq!(crate::names_beside(ModelFormat::Gltf, "my oak"), [(Beside::Buffer, names[0].to_owned())]);
        assert_eq!(read(&files), model);
    }

    #[test]
    fn whatever_a_binary_file_holds_is_in_the_text() {
        let finest = model(&["leaf", "bark"]);
        let place =
            |x: f64| CopyPlace { at: DVec3::X * x, turn: DQuat::IDENTITY, scale: 1.0, color: [1.0; 3] };
        let copies = [Copies {
            name: "leaves".into(),
            material: mesh::MaterialId::new(0),
            mesh: finest.parts[0].mesh.clone(),
            places: vec![place(2.0), place(4.0)],
        }];
        for packing in [None, Some(Packing::Quantized), Some(Packing::Compressed)] {
            let levels = [Level { model: &finest, copies: &copies }, Level::plain(&finest)];
            let mut glb = Vec::new();
            write_glb_levels(&levels, packing, &mut PngCache::new(), &mut glb).unwrap();
            let whole = read_glb(&glb);
            let length = glb.len();
            let files = gltf_files(glb, ModelFormat::Gltf, "oak").unwrap();
            assert_eq!(read(&files), whole, "{packing:?}");
            assert_eq!(whole.triangle_count(), 8);
            let beside: usize = files.beside.iter().map(|f| f.bytes.len()).sum();
            assert!(beside < length, "each byte is there once");
        }
    }

    #[test]
    fn a_model_of_nothing_names_no_buffer() {
        let mut glb = Vec::new();
        crate::write_glb(&Model::default(), &mut glb).unwrap();
        let files = gltf_files(glb, ModelFormat::Gltf, "none").unwrap();
        assert_eq!((files.beside.len(), read(&files).parts.len()), (0, 0));
        assert!(gltf_files(b"glTF".to_vec(), ModelFormat::Gltf, "cut").is_err());
        assert!(gltf_files(Vec::new(), ModelFormat::Obj, "other").is_err());
    }
}
