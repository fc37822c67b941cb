//! A tile: copies of plants, and a table of their trees.

use std::io::Write;

use glam::{DQuat, DVec3};
use serde_json::{Value, json};

use super::merge::{Merged, name_once};
use super::shared::{SharedModel, SharedPart};
use crate::Packing;
use crate::error::WriteError;
use crate::model::{CompressedColumn, compressed_floats, compressed_turns, write_container};

const INSTANCES: &str = "EXT_mesh_gpu_instancing";
const FEATURES: &str = "EXT_instance_features";
const METADATA: &str = "EXT_structural_metadata";
const COMPRESSION: &str = "EXT_meshopt_compression";

const FLOAT: u32 = 5126;
const I16: u32 = 5122;
/// Step of the places of compressed copies, metres: the error is at most half of it.
const STEP_M: f64 = 0.001;
/// Number of steps in the largest size of compressed copies: the error of a size is at most half a step.
const SIZES: f64 = 4096.0;
/// Steps of the measures of trees; sixteen bits hold heights and crowns to 655 m, stems to 65 m and ages to 6,553 years.
const HEIGHT_STEP_M: f64 = 0.01;
const DBH_STEP_M: f64 = 0.001;
const CROWN_STEP_M: f64 = 0.01;
const AGE_STEP_YEARS: f64 = 0.1;
/// Largest number of sixteen bits.
const STEPS_OF_MEASURES: f64 = 65_535.0;
/// Steps that 24 bits hold from the origin.
const STEPS_FROM_ORIGIN: f64 = 4_194_304.0;

/// A copy of a model: scaled, turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Place of its origin, metres, +Y up.
    pub at: DVec3,
    /// Its rotation.
    pub turn: DQuat,
    /// Scale factors along its own axes, each above 0.
    pub scale: DVec3,
    /// Row of the tile's table.
    pub tree: u32,
}

/// The copies of one model in a tile.
#[derive(Clone, Copy, Debug)]
pub struct Group<'a> {
    /// The model that is copied.
    pub model: &'a SharedModel,
    /// Its copies, at least one.
    pub instances: &'a [Instance],
}

/// Attributes of a tree in a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeRow {
    /// Row of [`TreeTable::species`].
    pub species: u16,
    /// Row of the inventory.
    pub row: u32,
    /// Height, metres.
    pub height_m: f64,
    /// Diameter at breast height, metres.
    pub dbh_m: f64,
    /// Width of the crown, metres.
    pub crown_width_m: f64,
    /// Age, years.
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

/// Location of the meshes of a tile.
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

/// Writes a tile as a GLB: for each mesh a node without a transform at the top of the scene, with its places as
/// instances by `EXT_mesh_gpu_instancing` (`TRANSLATION`, `ROTATION`, `SCALE`, `_FEATURE_ID_0`);
/// `EXT_instance_features` leads from a copy to its row in a table of `EXT_structural_metadata` with species,
/// measures and the row of the inventory. Buffers and pictures are those of the shared models, by name.
/// [`Packing::Compressed`] also compresses the places.
///
/// Guaranteed: the same input gives the same bytes; equal materials and textures are stored once. Places are single
/// precision, or, if they are compressed, true to half a millimetre within 4 km of the origin.
/// Not guaranteed: that programs without these extensions show it; the tile requires them (`extensionsRequired`).
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
    let (mut places, mut meshes) = (Places::default(), Vec::new());
    for group in groups.iter().filter(|g| !g.instances.is_empty()) {
        let first = merged.add(group.model)?;
        let mut before: Option<(&SharedPart, usize)> = None;
        for part in &group.model.parts {
            let known = before.filter(|(p, _)| p.origin == part.origin && (p.size - part.size).abs() <= 0.0);
            let start = known.map_or_else(|| places.add(group.instances, part), |(_, start)| start);
            meshes.push((first + part.mesh, start, group.instances.len()));
            before = Some((part, start));
        }
    }
    let columns = places.write(&mut merged, packing);
    let (mut attributes, mut written) = (Value::Null, None);
    for (mesh, start, count) in meshes {
        if written != Some(start) {
            attributes = json!({});
            for column in &columns {
                attributes[column.name] = json!(column.accessor(&mut merged, start, count));
            }
            written = Some(start);
        }
        let ids = json!([{ "attribute": 0, "featureCount": table.rows.len(), "propertyTable": 0 }]);
        merged.nodes.push(json!({
            "mesh": mesh,
            "extensions": { INSTANCES: { "attributes": attributes }, FEATURES: { "featureIds": ids } },
        }));
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

/// Columns of the places of all copies, and of their rows in the table.
#[derive(Default)]
struct Places {
    at: Vec<f64>,
    turn: Vec<[f64; 4]>,
    scale: Vec<f64>,
    /// As floats, which every reader takes.
    tree: Vec<f64>,
}

/// A column in the tile's own buffer, of which meshes have parts.
struct PlaceColumn {
    name: &'static str,
    view: usize,
    /// Bytes of a row.
    stride: usize,
    kind: u32,
    shape: &'static str,
}

impl PlaceColumn {
    /// An accessor of rows.
    fn accessor(&self, merged: &mut Merged, start: usize, count: usize) -> usize {
        let mut row = json!({
            "bufferView": self.view,
            "componentType": self.kind,
            "count": count,
            "type": self.shape,
        });
        if start > 0 {
            row["byteOffset"] = json!(start * self.stride);
        }
        if self.kind != FLOAT {
            row["normalized"] = true.into();
        }
        merged.accessor(row)
    }
}

impl Places {
    /// Adds copies of a mesh whose coordinates are those of a cube: scaled, turned and moved with it. Their first row.
    fn add(&mut self, instances: &[Instance], part: &SharedPart) -> usize {
        let start = self.tree.len();
        for i in instances {
            self.at.extend((i.at + i.turn * (i.scale * part.origin)).to_array());
            self.turn.push(i.turn.normalize().to_array());
            self.scale.extend((i.scale * part.size).to_array());
            self.tree.push(f64::from(i.tree));
        }
        start
    }

    fn write(&self, merged: &mut Merged, packing: Option<Packing>) -> [PlaceColumn; 4] {
        let count = self.tree.len();
        let columns = [
            ("TRANSLATION", 12, FLOAT, "VEC3"),
            ("ROTATION", if packing == Some(Packing::Compressed) { 8 } else { 16 }, FLOAT, "VEC4"),
            ("SCALE", 12, FLOAT, "VEC3"),
            ("_FEATURE_ID_0", 4, FLOAT, "SCALAR"),
        ];
        let views = if packing == Some(Packing::Compressed) {
            let farthest = self.at.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let largest = self.scale.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            [
                compressed_floats(&self.at, 3, STEP_M.max(farthest / STEPS_FROM_ORIGIN)),
                compressed_turns(&self.turn),
                compressed_floats(&self.scale, 3, largest / SIZES),
                compressed_floats(&self.tree, 1, 1.0),
            ]
            .map(|column| compressed(merged, &column, count))
        } else {
            let turns: &[f64] = self.turn.as_flattened();
            [&self.at, turns, &self.scale, &self.tree].map(|numbers| floats(merged, numbers))
        };
        let mut views = views.into_iter();
        columns.map(|(name, stride, kind, shape)| {
            let kind = if stride == 8 { I16 } else { kind };
            PlaceColumn { name, view: views.next().unwrap_or(0), stride, kind, shape }
        })
    }
}

fn floats(merged: &mut Merged, numbers: &[f64]) -> usize {
    #[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in files, by design")]
    let bytes: Vec<u8> = numbers.iter().flat_map(|&x| (x as f32).to_le_bytes()).collect();
    merged.view(&bytes)
}

/// A view that a reader decompresses; it lies in a buffer that has no bytes.
fn compressed(merged: &mut Merged, column: &CompressedColumn, count: usize) -> usize {
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
    merged.views.len() - 1
}

/// A measure in steps, at most as many as sixteen bits count.
fn steps(measure: f64, step: f64) -> u16 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 65,535")]
    let steps = (measure / step).round().clamp(0.0, STEPS_OF_MEASURES) as u16;
    steps
}

fn metadata(merged: &mut Merged, table: &TreeTable<'_>) -> Value {
    let names = table.species.iter().enumerate();
    let names: Vec<Value> = names.map(|(value, name)| json!({ "name": name, "value": value })).collect();
    let measure = |what: &str, step: f64| {
        let (component, whole) = ("UINT16", STEPS_OF_MEASURES * step);
        json!({ "description": what, "type": "SCALAR", "componentType": component, "normalized": true, "scale": whole })
    };
    let tree = json!({
        "name": "Tree",
        "properties": {
            "species": { "type": "ENUM", "enumType": "species" },
            "row": {
                "description": "Row of the inventory, from 1 without its header",
                "type": "SCALAR",
                "componentType": "UINT32",
            },
            "height_m": measure("Height, metres", HEIGHT_STEP_M),
            "dbh_m": measure("Diameter at breast height, metres; 0 below 1.3 m", DBH_STEP_M),
            "crown_width_m": measure("Mean diameter of the crown, metres", CROWN_STEP_M),
            "age_years": measure("Age, years", AGE_STEP_YEARS),
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
    let column = |of: fn(&TreeRow) -> f64, step: f64| -> Vec<u8> {
        table.rows.iter().flat_map(|t| steps(of(t), step).to_le_bytes()).collect()
    };
    let columns = [
        ("species", species),
        ("row", rows),
        ("height_m", column(|t| t.height_m, HEIGHT_STEP_M)),
        ("dbh_m", column(|t| t.dbh_m, DBH_STEP_M)),
        ("crown_width_m", column(|t| t.crown_width_m, CROWN_STEP_M)),
        ("age_years", column(|t| t.age_years, AGE_STEP_YEARS)),
    ];
    let mut properties = json!({});
    for (name, bytes) in columns {
        properties[name] = json!({ "values": merged.view(&bytes) });
    }
    let count = table.rows.len();
    let tables = json!([{ "name": "trees", "class": "tree", "count": count, "properties": properties }]);
    json!({ "schema": schema, "propertyTables": tables })
}
