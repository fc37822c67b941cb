//! Model -> binary glTF 2.0, in metres, +Y up.

use std::io::Write;
use std::sync::Arc;

use glam::{DQuat, DVec3};
use mesh::{Copies, CopyPlace, Model, Part, Rig, Standing, TriMesh};
use serde_json::{Value, json};

use super::gltf::{
    Accessor, Animation, Asset, Attributes, Buffer, Channel, FLOAT, Keys, Mesh, Node, POINTS, Primitive,
    Root, Sampler, Scene, Skin, Target, U16, U32, View,
};
use super::{PngCache, check, share, unit};
use crate::error::WriteError;

pub(super) const ARRAY_BUFFER: u32 = 34_962;
pub(super) const ELEMENT_ARRAY_BUFFER: u32 = 34_963;
const LINEAR: u32 = 9_729;
const LINEAR_MIPMAP_LINEAR: u32 = 9_987;

/// Writes a model as a GLB: one root node named after the model, one node and mesh for each part, materials with
/// embedded PNG textures (each once), `alphaMode` MASK and `doubleSided` if the material asks for it. The wind's
/// effect on the vertices is written as attributes `_WIND` (VEC4) and `_PIVOT` (VEC4: metres, and 1), if the model
/// has it.
///
/// Guaranteed: the same model gives the same bytes; the Khronos validator finds no error, and warns of
/// nothing but tangents, which viewers compute for normal maps.
/// A part without vertices is left out; one without triangles is written as points.
///
/// # Errors
/// [`WriteError`] for a model that is not sound, beyond 4 GiB, or of the sink.
///
/// ```
/// let mut glb = Vec::new();
/// formats::write_glb(&mesh::Model::default(), &mut glb)?;
/// assert_eq!(&glb[..4], b"glTF");
/// # Ok::<(), formats::WriteError>(())
/// ```
pub fn write_glb(model: &Model, out: impl Write) -> Result<(), WriteError> {
    write_glb_with(model, &mut PngCache::new(), out)
}

/// Writes as [`write_glb`] does and keeps the encoded textures for the next time.
///
/// # Errors
/// As [`write_glb`].
pub fn write_glb_with(model: &Model, cache: &mut PngCache, out: impl Write) -> Result<(), WriteError> {
    write(model, &Morph::default(), cache, out)
}

/// Other shapes of a model, for a morph animation.
#[derive(Clone, Debug, Default)]
pub struct Morph<'a> {
    /// Name of the animation.
    pub name: &'a str,
    /// Second at which the model itself appears; keys may lie before and after it.
    pub at: f32,
    /// Seconds, increasing and different from `at`, and the model at each: the same parts with as many vertices.
    pub keys: Vec<(f32, &'a Model)>,
}

/// Writes as [`write_glb`] does, with an animation through the keys of `morph`, linear between them.
///
/// Wind, if the first shape has it, is that of the first shape: keys do not change it.
///
/// Each key is a morph target (position, normal, and colour if vertex colours change) of every part; viewers blend
/// two at a time. Players without morph targets show the model itself, and players without targets of colours (such
/// as Blender) keep its colours: choose the best-looking shape for it.
///
/// # Errors
/// As [`write_glb`]; [`WriteError::Keys`] if a key has other parts or vertices, or times do not increase or one is
/// that of the model itself.
pub fn write_glb_morph(model: &Model, morph: &Morph<'_>, out: impl Write) -> Result<(), WriteError> {
    let mut before = f32::NEG_INFINITY;
    for (index, (time, key)) in morph.keys.iter().enumerate() {
        let same = key.parts.len() == model.parts.len()
            && key.parts.iter().zip(&model.parts).all(|(a, b)| {
                a.mesh.positions.len() == b.mesh.positions.len()
                    && a.mesh.normals.len() == b.mesh.normals.len()
                    && a.mesh.positions.iter().flatten().all(|x| x.is_finite())
            });
        let later = *time > before && time.is_finite() && (*time - morph.at).abs() > 0.0;
        if !same || !later {
            return Err(WriteError::Keys { key: index });
        }
        before = *time;
    }
    write(model, morph, &mut PngCache::new(), out)
}

/// Writes a scene as a GLB: one root node of this name, below it a node with the place of each plant, and below that
/// a node for each part. A model with several places is written once, and all of its places refer to its meshes; so
/// are equal textures. If there is only one plant, at its original place, its parts are children of the root, as in
/// [`write_glb`].
///
/// Guaranteed: as [`write_glb`]. `_PIVOT` is in the coordinates of the plant's own node.
///
/// # Errors
/// As [`write_glb`].
pub fn write_glb_scene(
    name: &str,
    plants: &[Standing<'_>],
    cache: &mut PngCache,
    out: impl Write,
) -> Result<(), WriteError> {
    let mut models: Vec<&Model> = Vec::new();
    for plant in plants {
        if !models.iter().any(|m| core::ptr::eq(*m, plant.model)) {
            check(plant.model)?;
            models.push(plant.model);
        }
    }
    let mut w = Writer::new(models.iter().map(|m| room(m)).sum());
    let mut written = Vec::with_capacity(models.len());
    for model in &models {
        let first = w.materials(model, cache)?;
        written.push(w.meshes(model, first, &Morph::default())?);
    }
    w.root(name);
    let alone = matches!(plants, [only] if only.is_home());
    for plant in plants {
        let row = models.iter().position(|m| core::ptr::eq(*m, plant.model));
        let meshes = row.and_then(|row| written.get(row)).map_or(&[][..], |m| &m[..]);
        let at = if alone { 0 } else { w.place(plant)? };
        w.hang(at, meshes)?;
    }
    w.finish(out)
}

/// A model as one level of a file.
#[derive(Clone, Copy, Debug)]
pub struct Level<'a> {
    /// Its parts.
    pub model: &'a Model,
    /// Meshes with many places, in materials of the model; they are not among its parts.
    pub copies: &'a [Copies],
}

impl<'a> Level<'a> {
    /// Returns a level with the parts of a model and without copies.
    pub const fn plain(model: &'a Model) -> Self {
        Self { model, copies: &[] }
    }
}

/// Writes a model with joints and their looping animation: as [`write_glb`], with each vertex bound to its joints,
/// and the parts at the top of the scene, where glTF wants skinned meshes. Attributes for wind are left out: joints
/// do the same.
///
/// # Errors
/// As [`write_glb`]; [`WriteError::Rig`] if the rig does not fit the model.
pub fn write_glb_rigged(
    model: &Model,
    rig: &Rig,
    cache: &mut PngCache,
    out: impl Write,
) -> Result<(), WriteError> {
    check(model)?;
    if !rig.fits(model) || rig.joints.is_empty() {
        return Err(WriteError::Rig);
    }
    let mut w = Writer::new(room(model) + 24 * model.vertex_count());
    if let (Some(extras), Some(offset)) = (&mut w.root.asset.extras, model.offset_m) {
        extras["offset_m"] = json!(offset.to_array());
    }
    let first = w.materials(model, cache)?;
    let bare = Morph::default();
    let meshes = w.meshes_of(model, first, &bare, false)?;
    w.root(&model.name);
    w.rig(model, rig, &meshes)?;
    w.finish(out)
}

fn write(model: &Model, morph: &Morph<'_>, cache: &mut PngCache, out: impl Write) -> Result<(), WriteError> {
    write_all(&[Level::plain(model)], morph, cache, out)
}

pub(super) fn write_all(
    levels: &[Level<'_>],
    morph: &Morph<'_>,
    cache: &mut PngCache,
    out: impl Write,
) -> Result<(), WriteError> {
    check_levels(levels)?;
    let mut w = Writer::new(levels.iter().map(|l| room(l.model)).sum());
    let still = Morph::default();
    for (level, number) in levels.iter().zip(0..) {
        let model = level.model;
        if number == 0
            && let (Some(extras), Some(offset)) = (&mut w.root.asset.extras, model.offset_m)
        {
            extras["offset_m"] = json!(offset.to_array());
        }
        let first = w.materials(model, cache)?;
        let morph = if number == 0 { morph } else { &still };
        let meshes = w.meshes(model, first, morph)?;
        let under = w.level(&levels[0].model.name, number)?;
        w.hang(under, &meshes)?;
        for copies in level.copies {
            let part =
                Part { name: copies.name.clone(), material: copies.material, mesh: copies.mesh.clone() };
            let one = Model { parts: vec![part], ..Model::default() };
            let mesh = w.meshes(&one, first, &still)?;
            w.hang(under, &mesh)?;
            w.stand(&copies.places)?;
        }
        if number == 0 {
            w.animation(model, morph)?;
        }
    }
    w.finish(out)
}

/// Refuses levels that no file should hold.
pub(super) fn check_levels(levels: &[Level<'_>]) -> Result<(), WriteError> {
    for level in levels {
        check(level.model)?;
        for copies in level.copies {
            let fail = |fault| Err(WriteError::Model { part: copies.name.clone(), fault });
            if copies.material.index() >= level.model.materials.len() {
                return fail(mesh::MeshFault::Material(copies.material.index()));
            }
            let bad = copies.mesh.validate();
            let mut bad =
                bad.filter(|f| !matches!(f, mesh::MeshFault::Degenerate(_) | mesh::MeshFault::Normal(_)));
            if let Some(fault) = bad.next() {
                return fail(fault);
            }
        }
    }
    Ok(())
}

/// The extension for meshes with many places.
pub(super) const INSTANCES: &str = "EXT_mesh_gpu_instancing";
/// The extension for levels of detail.
const LEVELS: &str = "MSFT_lod";

fn room(model: &Model) -> usize {
    48 * model.vertex_count() + 12 * model.triangle_count() + 1024
}

/// Returns a row of `_PIVOT`: a point with the fourth coordinate 1. It is as wide as `_WIND`, because Blender's
/// importer takes the columns of an application's own attributes in an order that changes with each start, and fails
/// on some orders of columns of two widths.
pub(super) fn pivot_row([x, y, z]: [f32; 3]) -> [f32; 4] {
    [x, y, z, 1.0]
}

pub(super) fn row(n: usize) -> Result<u32, WriteError> {
    u32::try_from(n).ok().ok_or(WriteError::TooLarge { what: "the number of parts", format: "glTF" })
}

/// Indices of so many vertices fit into sixteen bits; 65535 itself is the primitive restart value and may not be an index.
pub(super) const fn has_small_indices(vertices: usize) -> bool {
    vertices < 65_536
}

/// A document and its bytes as a GLB.
pub(crate) fn write_container(
    mut text: Vec<u8>,
    bytes: &[u8],
    mut out: impl Write,
) -> Result<(), WriteError> {
    text.resize(text.len().next_multiple_of(4), b' ');
    let bin = if bytes.is_empty() { 0 } else { 8 + bytes.len() };
    let total = 12 + 8 + text.len() + bin;
    let word = |n: usize| {
        u32::try_from(n)
            .map(u32::to_le_bytes)
            .ok()
            .ok_or(WriteError::TooLarge { what: "the model", format: "GLB (4 GiB)" })
    };
    out.write_all(b"glTF")?;
    out.write_all(&2_u32.to_le_bytes())?;
    out.write_all(&word(total)?)?;
    out.write_all(&word(text.len())?)?;
    out.write_all(b"JSON")?;
    out.write_all(&text)?;
    if !bytes.is_empty() {
        out.write_all(&word(bytes.len())?)?;
        out.write_all(b"BIN\0")?;
        out.write_all(bytes)?;
    }
    Ok(())
}

/// Accessors of instances.
pub(super) struct InstanceColumns {
    pub(super) translation: u32,
    pub(super) rotation: u32,
    pub(super) scale: u32,
    pub(super) color: u32,
}

/// Columns of the wind as attributes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Winds {
    /// `_WIND` and `_PIVOT`.
    Own,
    None,
}

pub(super) struct Writer {
    pub(super) root: Root,
    pub(super) bin: Vec<u8>,
    /// The texture of each image.
    pub(super) images: Vec<Arc<mesh::Texture>>,
    /// Encoder of the textures.
    pub(super) encode: fn(&Arc<mesh::Texture>, &mut PngCache) -> Result<Encoded, WriteError>,
    /// Transform of the textures of each material, as an extension; empty if there is none.
    pub(super) placed: Vec<Option<Value>>,
}

/// Bytes of an image and their type.
pub(super) type Encoded = (Arc<[u8]>, &'static str);

impl Writer {
    pub(super) fn new(room: usize) -> Self {
        let asset = Asset {
            version: "2.0".into(),
            generator: Some(concat!("Burgeon ", env!("CARGO_PKG_VERSION")).into()),
            extras: Some(json!({ "unit": "metre", "up": "+Y" })),
        };
        let root = Root { asset, ..Root::default() };
        Self {
            root,
            bin: Vec::with_capacity(room),
            images: Vec::new(),
            encode: |texture, cache| Ok((cache.png(texture)?, "image/png")),
            placed: Vec::new(),
        }
    }

    pub(super) fn finish(mut self, out: impl Write) -> Result<(), WriteError> {
        if !self.bin.is_empty() && self.root.buffers.is_empty() {
            self.root.buffers.push(Buffer { byte_length: self.bin.len() as u64, ..Buffer::default() });
        }
        if !self.images.is_empty() {
            let sampler = Sampler { mag_filter: Some(LINEAR), min_filter: Some(LINEAR_MIPMAP_LINEAR) };
            self.root.samplers.push(sampler);
        }
        let text = serde_json::to_vec(&self.root).map_err(|e| WriteError::Io(e.into()))?;
        write_container(text, &self.bin, out)
    }

    /// Adds a buffer view of the bytes that `fill` appends.
    pub(super) fn view(
        &mut self,
        target: Option<u32>,
        fill: impl FnOnce(&mut Vec<u8>),
    ) -> Result<u32, WriteError> {
        let start = self.bin.len();
        fill(&mut self.bin);
        let byte_length = (self.bin.len() - start) as u64;
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = View { byte_offset: start as u64, byte_length, target, ..View::default() };
        self.root.buffer_views.push(view);
        row(self.root.buffer_views.len() - 1)
    }

    pub(super) fn column<const N: usize>(
        &mut self,
        shape: &str,
        rows: &[[f32; N]],
        bounds: bool,
    ) -> Result<u32, WriteError> {
        let view = self.view(Some(ARRAY_BUFFER), |bin| {
            bin.extend(rows.iter().flatten().flat_map(|x| x.to_le_bytes()));
        })?;
        let fold = |start: f32, f: fn(f32, f32) -> f32| -> Vec<f64> {
            (0..N).map(|k| f64::from(rows.iter().map(|r| r[k]).fold(start, f))).collect()
        };
        self.root.accessors.push(Accessor {
            buffer_view: Some(view),
            component_type: FLOAT,
            count: rows.len() as u64,
            shape: shape.to_owned(),
            min: bounds.then(|| fold(f32::INFINITY, f32::min)),
            max: bounds.then(|| fold(f32::NEG_INFINITY, f32::max)),
            ..Accessor::default()
        });
        row(self.root.accessors.len() - 1)
    }

    /// A view of triangles.
    pub(super) fn triangles(&mut self, triangles: &[[u32; 3]], is_small: bool) -> Result<u32, WriteError> {
        self.view(Some(ELEMENT_ARRAY_BUFFER), |bin| {
            let indices = triangles.iter().flatten();
            if is_small {
                #[expect(clippy::cast_possible_truncation, reason = "below 65535: checked with the model")]
                bin.extend(indices.flat_map(|&i| (i as u16).to_le_bytes()));
            } else {
                bin.extend(indices.flat_map(|&i| i.to_le_bytes()));
            }
        })
    }

    pub(super) fn indices(&mut self, mesh: &TriMesh) -> Result<u32, WriteError> {
        let small = has_small_indices(mesh.positions.len());
        let view = self.triangles(&mesh.triangles, small)?;
        self.root.accessors.push(Accessor {
            buffer_view: Some(view),
            component_type: if small { U16 } else { U32 },
            count: 3 * mesh.triangles.len() as u64,
            shape: "SCALAR".into(),
            ..Accessor::default()
        });
        row(self.root.accessors.len() - 1)
    }

    /// Adds an extension to those that the file uses, once.
    pub(super) fn uses(&mut self, extension: &str) {
        if !self.root.extensions_used.iter().any(|e| e == extension) {
            self.root.extensions_used.push(extension.to_owned());
        }
    }

    /// Adds an extension to those that a reader must know, once.
    pub(super) fn needs(&mut self, extension: &str) {
        self.uses(extension);
        if !self.root.extensions_required.iter().any(|e| e == extension) {
            self.root.extensions_required.push(extension.to_owned());
        }
    }

    /// Returns the differences of a key in positions, normals and, if `colored`, vertex colours.
    fn target(&mut self, mesh: &TriMesh, key: &TriMesh, colored: bool) -> Result<Attributes, WriteError> {
        let minus = |a: [f32; 3], b: [f32; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let moved: Vec<[f32; 3]> =
            key.positions.iter().zip(&mesh.positions).map(|(&a, &b)| minus(a, b)).collect();
        let mut target =
            Attributes { position: Some(self.column("VEC3", &moved, true)?), ..Default::default() };
        if !mesh.normals.is_empty() {
            let pairs = key.normals.iter().zip(&mesh.normals);
            let turned: Vec<[f32; 3]> = pairs.map(|(&a, &b)| minus(unit(a), unit(b))).collect();
            target.normal = Some(self.column("VEC3", &turned, false)?);
        }
        if colored {
            let pairs = key.colors.iter().zip(&mesh.colors);
            let changed: Vec<[f32; 3]> = pairs.map(|(&a, &b)| minus(a.map(share), b.map(share))).collect();
            target.color = Some(self.column("VEC3", &changed, false)?);
        }
        Ok(target)
    }

    /// Adds one channel for each part, all with the same keys: at a key only its own weight is 1, at the model itself
    /// none.
    fn animation(&mut self, model: &Model, morph: &Morph<'_>) -> Result<(), WriteError> {
        let n = morph.keys.len();
        if n == 0 || self.root.meshes.is_empty() {
            return Ok(());
        }
        let mut times: Vec<f32> = morph.keys.iter().map(|k| k.0).collect();
        let base = times.partition_point(|t| *t < morph.at);
        times.insert(base, morph.at);
        let input = self.scalars(&times, true)?;
        let weights: Vec<f32> = (0..=n)
            .flat_map(|k| (0..=n).filter(|t| *t != base).map(move |t| if t == k { 1.0 } else { 0.0 }))
            .collect();
        let output = self.scalars(&weights, false)?;
        let keys = Keys { input, interpolation: "LINEAR".into(), output };
        let moving = self.root.nodes.iter().enumerate().filter(|(_, node)| node.mesh.is_some());
        let channels = moving
            .map(|(node, _)| {
                Ok(Channel { sampler: 0, target: Target { node: row(node)?, path: "weights".into() } })
            })
            .collect::<Result<Vec<Channel>, WriteError>>()?;
        let name = if morph.name.is_empty() { model.name.clone() } else { morph.name.to_owned() };
        self.root.animations.push(Animation { name, channels, samplers: vec![keys] });
        Ok(())
    }

    fn scalars(&mut self, values: &[f32], bounds: bool) -> Result<u32, WriteError> {
        let view = self.view(None, |bin| bin.extend(values.iter().flat_map(|x| x.to_le_bytes())))?;
        let end = |start: f32, f: fn(f32, f32) -> f32| vec![f64::from(values.iter().copied().fold(start, f))];
        self.root.accessors.push(Accessor {
            buffer_view: Some(view),
            component_type: FLOAT,
            count: values.len() as u64,
            shape: "SCALAR".into(),
            min: bounds.then(|| end(f32::INFINITY, f32::min)),
            max: bounds.then(|| end(f32::NEG_INFINITY, f32::max)),
            ..Accessor::default()
        });
        row(self.root.accessors.len() - 1)
    }

    /// Adds the node above all others, and the scene that shows it.
    pub(super) fn root(&mut self, name: &str) {
        let name = if name.is_empty() { "model" } else { name };
        self.root.nodes.push(Node { name: Some(name.to_owned()), ..Node::default() });
        self.root.scenes.push(Scene { name: Some(name.to_owned()), nodes: vec![0] });
        self.root.scene = Some(0);
    }

    /// Places the mesh of the last node as instances.
    pub(super) fn stand(&mut self, places: &[CopyPlace]) -> Result<(), WriteError> {
        #[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in files, by design")]
        let narrow = |x: f64| x as f32;
        let at: Vec<[f32; 3]> = places.iter().map(|p| p.at.to_array().map(narrow)).collect();
        let turns: Vec<[f32; 4]> = places.iter().map(|p| p.turn.to_array().map(narrow)).collect();
        let scales: Vec<[f32; 3]> = places.iter().map(|p| [narrow(p.scale); 3]).collect();
        let colors: Vec<[f32; 3]> = places.iter().map(|p| p.color.map(share)).collect();
        let columns = InstanceColumns {
            translation: self.rows("VEC3", &at, None)?,
            rotation: self.rows("VEC4", &turns, None)?,
            scale: self.rows("VEC3", &scales, None)?,
            color: self.rows("VEC3", &colors, None)?,
        };
        self.instances(&columns);
        Ok(())
    }

    /// Makes instances of the last node, by accessors with a row for each.
    pub(super) fn instances(&mut self, columns: &InstanceColumns) {
        let attributes = json!({
            "TRANSLATION": columns.translation,
            "ROTATION": columns.rotation,
            "SCALE": columns.scale,
            "_COLOR_0": columns.color,
        });
        self.needs(INSTANCES);
        if let Some(node) = self.root.nodes.last_mut() {
            node.extensions = Some(json!({ INSTANCES: { "attributes": attributes } }));
        }
    }

    /// Returns the node of a level: the root for number 0, which must come first; else a new one.
    pub(super) fn level(&mut self, name: &str, number: u32) -> Result<u32, WriteError> {
        if number == 0 {
            self.root(name);
            return Ok(0);
        }
        self.uses(LEVELS);
        let at = row(self.root.nodes.len())?;
        let name = if name.is_empty() { "model" } else { name };
        self.root.nodes.push(Node { name: Some(format!("{name} lod{number}")), ..Node::default() });
        let root = &mut self.root.nodes[0];
        let ids = root.extensions.get_or_insert_with(|| json!({ LEVELS: { "ids": [] } }));
        if let Some(ids) = ids[LEVELS]["ids"].as_array_mut() {
            ids.push(json!(at));
        }
        // Half of the picture's height, half of that and so on; the last level has no lower bound.
        let ends = (1..=number).map(|k| 1.0 / f64::from(1_u32 << k.min(30))).chain([0.0]);
        root.extras = Some(json!({ "MSFT_screencoverage": ends.collect::<Vec<f64>>() }));
        Ok(at)
    }

    /// Adds a node under the root with the place of the plant.
    fn place(&mut self, plant: &Standing<'_>) -> Result<u32, WriteError> {
        let moved = plant.position != DVec3::ZERO;
        let turned = plant.turn != DQuat::IDENTITY;
        let sized = plant.scale.to_bits() != 1.0_f64.to_bits();
        let at = row(self.root.nodes.len())?;
        self.root.nodes.push(Node {
            name: Some(plant.name.to_owned()),
            translation: moved.then(|| plant.position.to_array()),
            rotation: turned.then(|| plant.turn.to_array()),
            scale: sized.then_some([plant.scale; 3]),
            ..Node::default()
        });
        self.root.nodes[0].children.push(at);
        Ok(at)
    }

    /// Adds a node for each mesh, under a node.
    fn hang(&mut self, under: u32, meshes: &[u32]) -> Result<(), WriteError> {
        for &mesh in meshes {
            let name = self.root.meshes[mesh as usize].name.clone();
            let at = row(self.root.nodes.len())?;
            self.root.nodes.push(Node { name, mesh: Some(mesh), ..Node::default() });
            self.root.nodes[under as usize].children.push(at);
        }
        Ok(())
    }

    /// Adds joints below the root, meshes next to it, and the animation of the joints.
    fn rig(&mut self, model: &Model, rig: &Rig, meshes: &[u32]) -> Result<(), WriteError> {
        let first = row(self.root.nodes.len())?;
        for joint in &rig.joints {
            let at = row(self.root.nodes.len())?;
            self.root.nodes.push(Node {
                name: Some(joint.name.clone()),
                translation: Some(joint.at.to_array()),
                ..Node::default()
            });
            self.root.nodes[0].children.push(at);
        }
        #[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in files, by design")]
        let narrow = |x: f64| x as f32;
        let back: Vec<[f32; 16]> = (rig.joints.iter())
            .map(|j| {
                let [x, y, z] = (-j.at).to_array().map(narrow);
                [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0]
            })
            .collect();
        let back = self.rows("MAT4", &back, None)?;
        let joints = (first..).zip(&rig.joints).map(|(row, _)| row).collect();
        self.root.skins.push(Skin { inverse_bind_matrices: back, joints, skeleton: 0 });
        let parts = rig.holds.iter().zip(&model.parts).filter(|(_, p)| !p.mesh.positions.is_empty());
        for (&mesh, (holds, _)) in meshes.iter().zip(parts) {
            let view = self.view(Some(ARRAY_BUFFER), |bin| {
                // A joint without a share has the row 0, as glTF asks.
                let rows = holds
                    .iter()
                    .flat_map(|h| [0, 1, 2, 3].map(|k| if h.shares[k] > 0.0 { h.joints[k] } else { 0 }));
                bin.extend(rows.flat_map(u16::to_le_bytes));
            })?;
            self.root.accessors.push(Accessor {
                buffer_view: Some(view),
                component_type: U16,
                count: holds.len() as u64,
                shape: "VEC4".into(),
                ..Accessor::default()
            });
            let joints = row(self.root.accessors.len() - 1)?;
            let shares: Vec<[f32; 4]> = holds.iter().map(|h| h.shares).collect();
            let weights = self.column("VEC4", &shares, false)?;
            let made = &mut self.root.meshes[mesh as usize];
            for primitive in &mut made.primitives {
                (primitive.attributes.joints, primitive.attributes.weights) = (Some(joints), Some(weights));
            }
            let at = row(self.root.nodes.len())?;
            let name = made.name.clone();
            self.root.nodes.push(Node { name, mesh: Some(mesh), skin: Some(0), ..Node::default() });
            self.root.scenes[0].nodes.push(at);
        }
        let input = self.scalars(&rig.seconds, true)?;
        let (mut channels, mut samplers) = (Vec::new(), Vec::new());
        for ((moves, joint), node) in rig.moves.iter().zip(&rig.joints).zip(first..) {
            let mut track = |output: u32, path: &str| -> Result<(), WriteError> {
                channels.push(Channel {
                    sampler: row(samplers.len())?,
                    target: Target { node, path: path.into() },
                });
                samplers.push(Keys { input, interpolation: "LINEAR".into(), output });
                Ok(())
            };
            if moves.iter().any(|m| m.0 != DQuat::IDENTITY) {
                let turns: Vec<[f32; 4]> = moves.iter().map(|m| m.0.to_array().map(narrow)).collect();
                track(self.rows("VEC4", &turns, None)?, "rotation")?;
            }
            if moves.iter().any(|m| m.1 != DVec3::ZERO) {
                let places: Vec<[f32; 3]> =
                    moves.iter().map(|m| (joint.at + m.1).to_array().map(narrow)).collect();
                track(self.rows("VEC3", &places, None)?, "translation")?;
            }
        }
        if !channels.is_empty() {
            self.root.animations.push(Animation { name: "wind".into(), channels, samplers });
        }
        Ok(())
    }

    /// Adds rows of floats that are not a column of vertices.
    fn rows<const N: usize>(
        &mut self,
        shape: &str,
        rows: &[[f32; N]],
        target: Option<u32>,
    ) -> Result<u32, WriteError> {
        let view =
            self.view(target, |bin| bin.extend(rows.iter().flatten().flat_map(|x| x.to_le_bytes())))?;
        self.root.accessors.push(Accessor {
            buffer_view: Some(view),
            component_type: FLOAT,
            count: rows.len() as u64,
            shape: shape.to_owned(),
            ..Accessor::default()
        });
        row(self.root.accessors.len() - 1)
    }

    /// Adds the columns of a mesh.
    pub(super) fn attributes(&mut self, mesh: &TriMesh, winds: Winds) -> Result<Attributes, WriteError> {
        let mut attributes =
            Attributes { position: Some(self.column("VEC3", &mesh.positions, true)?), ..Default::default() };
        if !mesh.normals.is_empty() {
            let normals: Vec<[f32; 3]> = mesh.normals.iter().map(|&n| unit(n)).collect();
            attributes.normal = Some(self.column("VEC3", &normals, false)?);
        }
        if !mesh.uvs.is_empty() {
            let finite = |x: f32| if x.is_finite() { x } else { 0.0 };
            let uvs: Vec<[f32; 2]> = mesh.uvs.iter().map(|uv| uv.map(finite)).collect();
            attributes.uv = Some(self.column("VEC2", &uvs, false)?);
        }
        if !mesh.colors.is_empty() {
            let colors: Vec<[f32; 3]> = mesh.colors.iter().map(|c| c.map(share)).collect();
            attributes.color = Some(self.column("VEC3", &colors, false)?);
        }
        if winds == Winds::Own && !mesh.wind.is_empty() {
            attributes.wind = Some(self.column("VEC4", &mesh.wind, false)?);
        }
        if winds == Winds::Own && !mesh.pivots.is_empty() {
            let pivots: Vec<[f32; 4]> = mesh.pivots.iter().map(|&p| pivot_row(p)).collect();
            attributes.pivot = Some(self.column("VEC4", &pivots, false)?);
        }
        Ok(attributes)
    }

    /// Returns the rows of a model's meshes, which it adds; `first` is the row of its first material.
    fn meshes(&mut self, model: &Model, first: u32, morph: &Morph<'_>) -> Result<Vec<u32>, WriteError> {
        self.meshes_of(model, first, morph, true)
    }

    /// Does the same, with or without the wind columns.
    fn meshes_of(
        &mut self,
        model: &Model,
        first: u32,
        morph: &Morph<'_>,
        wind: bool,
    ) -> Result<Vec<u32>, WriteError> {
        let mut meshes = Vec::new();
        for (index, part) in model.parts.iter().enumerate().filter(|(_, p)| !p.mesh.positions.is_empty()) {
            let mesh = &part.mesh;
            let attributes = self.attributes(mesh, if wind { Winds::Own } else { Winds::None })?;
            let points = mesh.triangles.is_empty();
            let mut targets = Vec::with_capacity(morph.keys.len());
            // All targets of a primitive have the same attributes.
            let colored = !mesh.colors.is_empty()
                && morph.keys.iter().all(|(_, k)| k.parts[index].mesh.colors.len() == mesh.colors.len())
                && morph.keys.iter().any(|(_, k)| k.parts[index].mesh.colors != mesh.colors);
            for (_, key) in &morph.keys {
                targets.push(self.target(mesh, &key.parts[index].mesh, colored)?);
            }
            let weights = vec![0.0; targets.len()];
            let primitive = Primitive {
                targets,
                attributes,
                indices: if points { None } else { Some(self.indices(mesh)?) },
                material: Some(first + part.material.raw()),
                mode: points.then_some(POINTS),
                extensions: None,
            };
            self.root.meshes.push(Mesh {
                name: Some(part.name.clone()),
                primitives: vec![primitive],
                weights,
            });
            meshes.push(row(self.root.meshes.len() - 1)?);
        }
        Ok(meshes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh::MaterialId;

    fn model(height: f32) -> Model {
        let mut mesh = TriMesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, height, 0.0]],
            triangles: vec![[0, 1, 2]],
            ..TriMesh::default()
        };
        mesh.compute_normals();
        Model {
            name: "petal".into(),
            parts: vec![Part { name: "petals".into(), material: MaterialId::new(0), mesh }],
            materials: vec![mesh::Material::plain("petal", mesh::MaterialKind::Petal, [1.0; 3])],
            offset_m: None,
        }
    }

    #[test]
    fn morph_targets_and_their_animation_are_written_and_read_back_as_the_first_shape() {
        let [mut a, mut b, mut c] = [1.0, 2.0, 4.0].map(model);
        a.parts[0].mesh.colors = vec![[1.0; 3]; a.parts[0].mesh.positions.len()];
        c.parts[0].mesh.colors = vec![[0.25; 3]; a.parts[0].mesh.positions.len()];
        b.parts[0].mesh.colors.clone_from(&a.parts[0].mesh.colors);
        let morph = Morph { name: "opening", at: 0.0, keys: vec![(1.0, &b), (2.5, &c)] };
        let mut glb = Vec::new();
        write_glb_morph(&a, &morph, &mut glb).unwrap();
        let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
        let json: Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
        let targets = json["meshes"][0]["primitives"][0]["targets"].as_array().unwrap();
        assert_eq!(targets.len(), 2);
        let accessor = |index: &Value| &json["accessors"][usize::try_from(index.as_u64().unwrap()).unwrap()];
        let max = |t: usize| accessor(&targets[t]["POSITION"])["max"][1].as_f64();
        assert_eq!((max(0), max(1)), (Some(1.0), Some(3.0)), "what a key adds");
        let colour = accessor(&targets[1]["COLOR_0"]);
        assert_eq!((&colour["type"], &colour["count"]), (&"VEC3".into(), &json["accessors"][0]["count"]));
        let animation = &json["animations"][0];
        assert_eq!(animation["channels"][0]["target"]["path"], "weights");
        let input = accessor(&animation["samplers"][0]["input"]);
        assert_eq!((input["min"][0].as_f64(), input["max"][0].as_f64()), (Some(0.0), Some(2.5)));
        let output = accessor(&animation["samplers"][0]["output"]);
        assert_eq!(output["count"], 6, "three keys, two weights each");
        let mut report = base::Report::default();
        let back = crate::read_model(
            &glb[..],
            crate::ModelFormat::Glb,
            "x",
            &crate::ExportSpec::default(),
            &crate::no_files,
            &mut report,
        );
        assert_eq!(back.unwrap().parts[0].mesh.positions, a.parts[0].mesh.positions);
        let disorder = Morph { keys: vec![(2.0, &b), (2.0, &c)], ..morph };
        assert!(matches!(write_glb_morph(&a, &disorder, &mut Vec::new()), Err(WriteError::Keys { key: 1 })));
        let twice = Morph { at: 2.0, ..morph };
        let keys = vec![(1.0, &b), (2.0, &c)];
        assert!(matches!(
            write_glb_morph(&a, &Morph { keys, ..twice }, &mut Vec::new()),
            Err(WriteError::Keys { key: 1 })
        ));
    }

    #[test]
    fn the_model_itself_may_lie_between_the_keys() {
        let [bud, bloom, wilted] = [1.0, 2.0, 4.0].map(model);
        let morph = Morph { name: "opening", at: 1.0, keys: vec![(0.0, &bud), (2.0, &wilted)] };
        let mut glb = Vec::new();
        write_glb_morph(&bloom, &morph, &mut glb).unwrap();
        let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
        let json: Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
        let floats = |accessor: &Value| -> Vec<f32> {
            let of = |v: &Value| usize::try_from(v.as_u64().unwrap_or(0)).unwrap();
            let accessor = &json["accessors"][of(accessor)];
            let view = &json["bufferViews"][of(&accessor["bufferView"])];
            let from = 20 + length + 8 + of(&view["byteOffset"]);
            let bytes = &glb[from..from + of(&view["byteLength"])];
            bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect()
        };
        let sampler = &json["animations"][0]["samplers"][0];
        assert_eq!(floats(&sampler["input"]), [0.0, 1.0, 2.0]);
        assert_eq!(floats(&sampler["output"]), [1.0, 0.0, 0.0, 0.0, 0.0, 1.0], "none at the model itself");
    }
}
