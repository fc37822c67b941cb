//! A tile: copies of plants, and a table of their trees.

use std::io::Write;

use glam::{DQuat, DVec3};
use serde_json::{Value, json};

use super::merge::{Merged, name_once};
use super::shared::SharedModel;
use crate::Packing;
use crate::error::WriteError;
use crate::model::{CompressedColumn, compressed_floats, compressed_turns, write_container};

const INSTANCES: &str = "EXT_mesh_gpu_instancing";
const FEATURES: &str = "EXT_instance_features";
const METADATA: &str = "EXT_structural_metadata";
const COMPRESSION: &str = "EXT_meshopt_compression";

const FLOAT: u32 = 5126;
const I16: u32 = 5122;
/// Places of compressed copies are true to half of this, metres, and sizes to half of the other share of the largest.
const STEP_M: f64 = 0.001;
const SIZES: f64 = 4096.0;
/// Steps that 24 bits hold from the origin.
const STEPS_FROM_ORIGIN: f64 = 4_194_304.0;

/// A copy of a model: scaled, turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Where its origin stands, metres, +Y up.
    pub at: DVec3,
    /// How it is turned.
    pub turn: DQuat,
    /// How much larger it is along its own axes, each above 0.
    pub scale: DVec3,
    /// Row of the tile's table.
    pub tree: u32,
}

/// The copies of one model in a tile.
#[derive(Clone, Copy, Debug)]
pub struct Group<'a> {
    /// What is copied.
    pub model: &'a SharedModel,
    /// Its copies, at least one.
    pub instances: &'a [Instance],
}

/// What a tile tells of a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeRow {
    /// Row of [`TreeTable::species`].
    pub species: u16,
    /// Row of the inventory.
    pub row: u32,
    /// Metres.
    pub height_m: f64,
    /// Metres.
    pub dbh_m: f64,
    /// Metres.
    pub crown_width_m: f64,
    /// Years.
    pub age_years: f64,
}

/// The trees of a tile, as a property table.
#[derive(Clone, Copy, Debug)]
pub struct TreeTable<'a> {
    /// Species of the whole forest.
    pub species: &'a [String],
    /// The trees of this tile.
    pub rows: &'a [TreeRow],
}

/// Where the meshes of a tile lie.
#[derive(Clone, Copy)]
pub enum Linking<'a> {
    /// In the files of the shared models.
    Named,
    /// In the tile itself: `open` reads a file by the name that the shared model has for it.
    Embedded(&'a dyn Fn(&str) -> Result<Vec<u8>, WriteError>),
}

impl std::fmt::Debug for Linking<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if matches!(self, Self::Named) { "Named" } else { "Embedded" })
    }
}

/// Writes a tile as a GLB: a node without a transform at the top of the scene for each mesh, which stands in many places by
/// `EXT_mesh_gpu_instancing` (`TRANSLATION`, `ROTATION`, `SCALE`, `_FEATURE_ID_0`); `EXT_instance_features` leads from a copy to
/// its row in a table of `EXT_structural_metadata` with species, measures and the row of the inventory. Buffers and pictures
/// are those of the shared models, by name. [`Packing::Compressed`] also compresses the places.
///
/// Guaranteed: the same input gives the same bytes; equal materials and textures are there once. Places are single precision,
/// or true to half a millimetre within 4 km of the origin where they are compressed.
/// Not guaranteed: that programs without these extensions show it; it says so (`extensionsRequired`).
/// Cost: linear in copies and meshes; all of the tile is in memory.
///
/// # Errors
/// [`WriteError`] of the sink, for a table beyond 2^23 rows, which a feature's number cannot name, or beyond 4 GiB.
pub fn write_tile(
    name: &str,
    groups: &[Group<'_>],
    table: &TreeTable<'_>,
    packing: Option<Packing>,
    linking: Linking<'_>,
    out: impl Write,
) -> Result<(), WriteError> {
    if table.rows.len() > 1 << 23 {
        return Err(WriteError::TooLarge { what: "the number of trees of a tile", format: "3D Tiles" });
    }
    let mut merged = Merged::new();
    for group in groups.iter().filter(|g| !g.instances.is_empty()) {
        let first = merged.add(group.model)?;
        let features = feature_ids(&mut merged, group.instances, packing);
        let mut before: Option<(DVec3, f64, Value)> = None;
        for part in &group.model.parts {
            let known = before.take().filter(|(o, s, _)| *o == part.origin && (*s - part.size).abs() <= 0.0);
            let attributes = known.map_or_else(
                || {
                    let places = Places::of(group.instances, part.origin, part.size);
                    let mut attributes = places.write(&mut merged, packing);
                    attributes["_FEATURE_ID_0"] = json!(features);
                    attributes
                },
                |(_, _, attributes)| attributes,
            );
            let ids = json!([{ "attribute": 0, "featureCount": table.rows.len(), "propertyTable": 0 }]);
            merged.nodes.push(json!({
                "mesh": first + part.mesh,
                "extensions": { INSTANCES: { "attributes": attributes }, FEATURES: { "featureIds": ids } },
            }));
            before = Some((part.origin, part.size, attributes));
        }
    }
    for word in [INSTANCES, FEATURES, METADATA] {
        name_once(&mut merged.used, word);
    }
    name_once(&mut merged.required, INSTANCES);
    if let Linking::Embedded(open) = linking {
        merged.embed(open)?;
    }
    let metadata = metadata(&mut merged, table);
    merged.extensions.insert(METADATA.into(), metadata);
    let (root, bin) = merged.document(name);
    let text = serde_json::to_vec(&root).map_err(|e| WriteError::Io(e.into()))?;
    write_container(text, &bin, out)
}

/// Columns of the places of copies.
struct Places {
    at: Vec<f64>,
    turn: Vec<[f64; 4]>,
    scale: Vec<f64>,
}

impl Places {
    /// Of a mesh whose coordinates are those of a cube: scaled, turned and moved with it.
    fn of(instances: &[Instance], origin: DVec3, size: f64) -> Self {
        let at = instances.iter().flat_map(|i| (i.at + i.turn * (i.scale * origin)).to_array());
        let turn = instances.iter().map(|i| i.turn.normalize().to_array());
        let scale = instances.iter().flat_map(|i| (i.scale * size).to_array());
        Self { at: at.collect(), turn: turn.collect(), scale: scale.collect() }
    }

    fn write(&self, merged: &mut Merged, packing: Option<Packing>) -> Value {
        let count = self.turn.len();
        let [translation, rotation, scale] = if packing == Some(Packing::Compressed) {
            let farthest = self.at.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let largest = self.scale.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let at = compressed_floats(&self.at, 3, STEP_M.max(farthest / STEPS_FROM_ORIGIN));
            let scale = compressed_floats(&self.scale, 3, largest / SIZES);
            let turn = compressed_turns(&self.turn);
            [(at, FLOAT, "VEC3"), (turn, I16, "VEC4"), (scale, FLOAT, "VEC3")]
                .map(|(column, kind, shape)| compressed(merged, &column, count, (kind, shape)))
        } else {
            let at = floats(merged, &self.at, count, "VEC3");
            let turns: Vec<f64> = self.turn.iter().flatten().copied().collect();
            [at, floats(merged, &turns, count, "VEC4"), floats(merged, &self.scale, count, "VEC3")]
        };
        json!({ "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale })
    }
}

fn floats(merged: &mut Merged, numbers: &[f64], count: usize, shape: &str) -> usize {
    #[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in files, by design")]
    let bytes: Vec<u8> = numbers.iter().flat_map(|&x| (x as f32).to_le_bytes()).collect();
    let view = merged.view(&bytes);
    merged.accessor(json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": shape }))
}

/// A column that a reader decompresses; its view lies in a buffer that has no bytes.
fn compressed(
    merged: &mut Merged,
    column: &CompressedColumn,
    count: usize,
    (kind, shape): (u32, &str),
) -> usize {
    let start = merged.append(&column.stream);
    let length = count * column.stride;
    let (buffer, from) = merged.without_bytes(length);
    let mut packed = json!({
        "buffer": 0,
        "byteOffset": start,
        "byteLength": column.stream.len(),
        "byteStride": column.stride,
        "count": count,
        "mode": "ATTRIBUTES",
    });
    if let Some(filter) = column.filter {
        packed["filter"] = filter.into();
    }
    merged.views.push(json!({
        "buffer": buffer,
        "byteOffset": from,
        "byteLength": length,
        "extensions": { COMPRESSION: packed },
    }));
    let view = merged.views.len() - 1;
    let mut row = json!({ "bufferView": view, "componentType": kind, "count": count, "type": shape });
    if kind != FLOAT {
        row["normalized"] = true.into();
    }
    merged.accessor(row)
}

/// The rows of the table that copies stand for: as floats, which every reader takes.
fn feature_ids(merged: &mut Merged, instances: &[Instance], packing: Option<Packing>) -> usize {
    let ids: Vec<f64> = instances.iter().map(|i| f64::from(i.tree)).collect();
    if packing == Some(Packing::Compressed) {
        let column = compressed_floats(&ids, 1, 1.0);
        return compressed(merged, &column, ids.len(), (FLOAT, "SCALAR"));
    }
    floats(merged, &ids, ids.len(), "SCALAR")
}

fn metadata(merged: &mut Merged, table: &TreeTable<'_>) -> Value {
    let names = table.species.iter().enumerate();
    let names: Vec<Value> = names.map(|(value, name)| json!({ "name": name, "value": value })).collect();
    let measure = |what: &str| json!({ "description": what, "type": "SCALAR", "componentType": "FLOAT32" });
    let tree = json!({
        "name": "Tree",
        "properties": {
            "species": { "type": "ENUM", "enumType": "species" },
            "row": {
                "description": "Row of the inventory, from 1 without its header",
                "type": "SCALAR",
                "componentType": "UINT32",
            },
            "height_m": measure("Height, metres"),
            "dbh_m": measure("Diameter at breast height, metres; 0 below 1.3 m"),
            "crown_width_m": measure("Mean diameter of the crown, metres"),
            "age_years": measure("Age, years"),
        },
    });
    let schema = json!({
        "id": "burgeon_forest",
        "version": "1",
        "classes": { "tree": tree },
        "enums": { "species": { "name": "Species", "valueType": "UINT16", "values": names } },
    });
    let species: Vec<u8> = table.rows.iter().flat_map(|t| t.species.to_le_bytes()).collect();
    let rows: Vec<u8> = table.rows.iter().flat_map(|t| t.row.to_le_bytes()).collect();
    #[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in files, by design")]
    let column = |of: fn(&TreeRow) -> f64| -> Vec<u8> {
        table.rows.iter().flat_map(|t| (of(t) as f32).to_le_bytes()).collect()
    };
    let columns = [
        ("species", species),
        ("row", rows),
        ("height_m", column(|t| t.height_m)),
        ("dbh_m", column(|t| t.dbh_m)),
        ("crown_width_m", column(|t| t.crown_width_m)),
        ("age_years", column(|t| t.age_years)),
    ];
    let mut properties = json!({});
    for (name, bytes) in columns {
        properties[name] = json!({ "values": merged.view(&bytes) });
    }
    let count = table.rows.len();
    let tables = json!([{ "name": "trees", "class": "tree", "count": count, "properties": properties }]);
    json!({ "schema": schema, "propertyTables": tables })
}
