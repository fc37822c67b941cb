//! Several glTF documents in one, in which equal rows are stored once.

use serde_json::{Map, Value, json};

use super::shared::{SharedModel, index, list, other};
use crate::error::WriteError;

/// The extension for compressed views.
const COMPRESSION: &str = "EXT_meshopt_compression";

/// A document to which models are added.
#[derive(Debug, Default)]
pub(super) struct Merged {
    pub(super) buffers: Vec<Value>,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
    images: Vec<Value>,
    samplers: Vec<Value>,
    textures: Vec<Value>,
    materials: Vec<Value>,
    pub(super) meshes: Vec<Value>,
    pub(super) nodes: Vec<Value>,
    pub(super) used: Vec<String>,
    pub(super) required: Vec<String>,
    pub(super) extensions: Map<String, Value>,
    pub(super) bin: Vec<u8>,
    /// The buffer without bytes for the tile's own compressed columns, and its length.
    fallback: Option<(usize, usize)>,
}

impl Merged {
    /// Returns an empty document; buffer 0 is the tile's own.
    pub(super) fn new() -> Self {
        Self { buffers: vec![Value::Null], ..Self::default() }
    }

    /// Adds a model without its nodes, and returns the row of its first mesh.
    pub(super) fn add(&mut self, model: &SharedModel) -> Result<usize, WriteError> {
        let root = &model.root;
        let (view, accessor) = (self.views.len(), self.accessors.len());
        // The new row of each buffer, and its start there.
        let mut buffers = Vec::new();
        for row in list(root, "buffers") {
            let is_empty = row.pointer(&format!("/extensions/{COMPRESSION}/fallback")).is_some();
            buffers.push(if is_empty {
                self.without_bytes(index(row, "byteLength").unwrap_or(0))
            } else {
                self.buffers.push(row.clone());
                (self.buffers.len() - 1, 0)
            });
        }
        for row in list(root, "bufferViews") {
            let mut row = row.clone();
            let packed = row.pointer_mut(&format!("/extensions/{COMPRESSION}"));
            if !packed.is_none_or(|packed| lie(packed, &buffers)) || !lie(&mut row, &buffers) {
                return Err(other("a view names a buffer that is not there"));
            }
            // Says nothing that accessors do not say.
            without(&mut row, "target");
            self.views.push(row);
        }
        for row in list(root, "accessors") {
            let mut row = row.clone();
            shift(&mut row, "bufferView", view);
            self.accessors.push(row);
        }
        let keep = |rows: &mut Vec<Value>, name: &str| -> Vec<usize> {
            list(root, name).iter().map(|row| once(rows, row.clone())).collect()
        };
        let (images, samplers) = (keep(&mut self.images, "images"), keep(&mut self.samplers, "samplers"));
        let mut textures = Vec::new();
        for row in list(root, "textures") {
            let mut row = row.clone();
            let mut is_sound = moved(&mut row, "source", &images) & moved(&mut row, "sampler", &samplers);
            let extensions = row.get_mut("extensions").and_then(Value::as_object_mut);
            for (_, extension) in extensions.into_iter().flatten() {
                is_sound &= moved(extension, "source", &images);
            }
            if !is_sound {
                return Err(other("a texture names a picture that is not there"));
            }
            textures.push(once(&mut self.textures, row));
        }
        let mut materials = Vec::new();
        for row in list(root, "materials") {
            let mut row = row.clone();
            if !retexture(&mut row, &textures) {
                return Err(other("a material names a texture that is not there"));
            }
            materials.push(once(&mut self.materials, row));
        }
        let first = self.meshes.len();
        for row in list(root, "meshes") {
            let mut row = row.clone();
            for primitive in row["primitives"].as_array_mut().into_iter().flatten() {
                shift(primitive, "indices", accessor);
                let attributes = primitive["attributes"].as_object_mut();
                for (_, attribute) in attributes.into_iter().flatten() {
                    *attribute = json!(attribute.as_u64().unwrap_or(0) + accessor as u64);
                }
                if !moved(primitive, "material", &materials) {
                    return Err(other("a mesh names a material that is not there"));
                }
            }
            // The species stand in the table; the name of the mesh would be repeated in each tile.
            without(&mut row, "name");
            self.meshes.push(row);
        }
        for (names, of) in [(&mut self.used, "extensionsUsed"), (&mut self.required, "extensionsRequired")] {
            let words = list(root, of).iter().filter_map(Value::as_str);
            words.for_each(|word| name_once(names, word));
        }
        Ok(first)
    }

    /// Adds a view of bytes in the tile's own buffer, aligned to eight bytes as tables demand.
    pub(super) fn view(&mut self, bytes: &[u8]) -> usize {
        let start = self.append(bytes);
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": bytes.len() }));
        self.views.len() - 1
    }

    /// Appends bytes to the tile's own buffer, and returns where they begin.
    pub(super) fn append(&mut self, bytes: &[u8]) -> usize {
        let start = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(8), 0);
        start
    }

    /// Reserves `length` bytes in the buffer without bytes, for a compressed view. Returns the buffer and where they
    /// begin.
    pub(super) fn without_bytes(&mut self, length: usize) -> (usize, usize) {
        let (buffer, start) = self.fallback.unwrap_or_else(|| {
            self.buffers.push(Value::Null);
            (self.buffers.len() - 1, 0)
        });
        self.fallback = Some((buffer, (start + length).next_multiple_of(4)));
        (buffer, start)
    }

    pub(super) fn accessor(&mut self, row: Value) -> usize {
        self.accessors.push(row);
        self.accessors.len() - 1
    }

    /// Embeds the files that the document names in its own buffer.
    pub(super) fn embed(
        &mut self,
        open: &dyn Fn(&str) -> Result<Vec<u8>, WriteError>,
    ) -> Result<(), WriteError> {
        let mut places: Vec<Option<usize>> = vec![None; self.buffers.len()];
        for (place, buffer) in places.iter_mut().zip(std::mem::take(&mut self.buffers)) {
            if let Some(uri) = buffer.get("uri").and_then(Value::as_str) {
                *place = Some(self.append(&open(uri)?));
                self.buffers.push(Value::Null);
            } else {
                self.buffers.push(buffer);
            }
        }
        // The tile's own buffer stays first; those without bytes follow.
        let rest: Vec<usize> = (1..self.buffers.len()).filter(|&b| places[b].is_none()).collect();
        let now = |buffer: usize| rest.iter().position(|&b| b == buffer).map_or(0, |k| k + 1);
        self.fallback = self.fallback.map(|(buffer, length)| (now(buffer), length));
        let moves: Vec<(usize, usize)> =
            (0..).zip(&places).map(|(buffer, place)| (now(buffer), place.unwrap_or(0))).collect();
        for row in &mut self.views {
            lie(row, &moves);
            if let Some(packed) = row.pointer_mut(&format!("/extensions/{COMPRESSION}")) {
                lie(packed, &moves);
            }
        }
        let mut k = 0;
        self.buffers.retain(|_| {
            k += 1;
            places[k - 1].is_none()
        });
        let mut images = std::mem::take(&mut self.images);
        for image in &mut images {
            let Some(uri) = image.get("uri").and_then(Value::as_str).map(str::to_owned) else { continue };
            let view = self.view(&open(&uri)?);
            *image = json!({ "bufferView": view, "mimeType": image["mimeType"] });
        }
        self.images = images;
        Ok(())
    }

    /// Returns the whole document.
    pub(super) fn document(mut self, name: &str) -> (Value, Vec<u8>) {
        if self.bin.is_empty() {
            // A document with no bytes gets a buffer of eight, to which none of its views refers.
            self.bin.resize(8, 0);
        }
        self.buffers[0] = json!({ "byteLength": self.bin.len() });
        if let Some((buffer, length)) = self.fallback {
            let empty = json!({ COMPRESSION: { "fallback": true } });
            self.buffers[buffer] = json!({ "byteLength": length, "extensions": empty });
        }
        let nodes: Vec<usize> = (0..self.nodes.len()).collect();
        let generator = concat!("Burgeon ", env!("CARGO_PKG_VERSION"));
        let mut root = json!({
            "asset": { "version": "2.0", "generator": generator },
            "scene": 0,
            "scenes": [{ "name": name, "nodes": nodes }],
        });
        let lists = [
            ("buffers", self.buffers),
            ("bufferViews", self.views),
            ("accessors", self.accessors),
            ("images", self.images),
            ("samplers", self.samplers),
            ("textures", self.textures),
            ("materials", self.materials),
            ("meshes", self.meshes),
            ("nodes", self.nodes),
        ];
        for (key, rows) in lists.into_iter().filter(|(_, rows)| !rows.is_empty()) {
            root[key] = Value::Array(rows);
        }
        for (key, names) in [("extensionsUsed", self.used), ("extensionsRequired", self.required)] {
            if !names.is_empty() {
                root[key] = json!(names);
            }
        }
        if !self.extensions.is_empty() {
            root["extensions"] = Value::Object(self.extensions);
        }
        (root, self.bin)
    }
}

/// Adds the name of an extension, once.
pub(super) fn name_once(names: &mut Vec<String>, word: &str) {
    if !names.iter().any(|n| n == word) {
        names.push(word.to_owned());
    }
}

/// Returns the index of a row, which it adds if it is new.
fn once(rows: &mut Vec<Value>, row: Value) -> usize {
    rows.iter().position(|r| *r == row).unwrap_or_else(|| {
        rows.push(row);
        rows.len() - 1
    })
}

/// Gives a view the new place of its buffer; false if there is none.
fn lie(row: &mut Value, buffers: &[(usize, usize)]) -> bool {
    let place = index(row, "buffer").and_then(|buffer| buffers.get(buffer));
    let Some((buffer, start)) = place else { return false };
    let start = start + index(row, "byteOffset").unwrap_or(0);
    row["buffer"] = json!(buffer);
    if start > 0 {
        row["byteOffset"] = json!(start);
    } else {
        without(row, "byteOffset");
    }
    true
}

fn without(row: &mut Value, key: &str) {
    if let Some(fields) = row.as_object_mut() {
        fields.remove(key);
    }
}

fn shift(row: &mut Value, key: &str, by: usize) {
    if let Some(at) = index(row, key) {
        row[key] = json!(at + by);
    }
}

/// Replaces a row's `key`, if it has one, by its new index; returns false if there is none.
fn moved(row: &mut Value, key: &str, places: &[usize]) -> bool {
    let Some(at) = index(row, key) else { return true };
    let Some(place) = places.get(at) else { return false };
    row[key] = json!(place);
    true
}

/// Replaces every texture of a material by its new index: wherever `index` occurs in one, it refers to a texture.
fn retexture(value: &mut Value, places: &[usize]) -> bool {
    match value {
        Value::Object(fields) => fields.iter_mut().all(|(key, value)| {
            if key != "index" {
                return key == "extras" || retexture(value, places);
            }
            let place = value.as_u64().and_then(|at| places.get(usize::try_from(at).ok()?));
            place.is_some_and(|place| {
                *value = json!(place);
                true
            })
        }),
        Value::Array(rows) => rows.iter_mut().all(|row| retexture(row, places)),
        _ => true,
    }
}
