//! Model -> a small GLB: columns in few bits, compressed, textures as JPEG.

use std::io::Write;
use std::sync::Arc;

use glam::DVec3;
use mesh::{CopyPlace, MaterialKind, Model, Part, TriMesh};
use serde_json::{Value, json};

use super::glb_write::{
    Encoded, InstanceColumns, Level, Writer, check_levels, has_small_indices, pivot_row, row,
};
use super::gltf::{
    Accessor, Attributes, Buffer, FLOAT, I8, I16, Mesh, Node, POINTS, Primitive, U8, U16, U32, View,
};
use super::meshopt::{encode_attributes, encode_triangles};
use super::meshopt_filter::{
    COARSE, EXPONENTIAL, FINE, OCTAHEDRAL, QUATERNION, exponential, octahedral, power_within, quaternion,
};
use super::picture::{WEBP_TYPE, webp};
use super::{PngCache, share, unit};
use crate::error::WriteError;

const QUANTIZATION: &str = "KHR_mesh_quantization";
const TRANSFORM: &str = "KHR_texture_transform";
pub(super) const COMPRESSION: &str = "EXT_meshopt_compression";

/// Longest step of compressed positions, metres: finer steps are invisible and do not compress.
const STEP_M: f64 = 0.001;
/// Least number of steps within the size of a model.
const STEPS: f64 = 8192.0;
/// Range of compressed coordinates, in textures: each texture has 512 steps.
const TEXTURES: f32 = 65_535.0 / 512.0;
/// The same range for a large plant: each texture has 255 steps, which fit into a byte.
const TEXTURES_OF_LARGE: f32 = 257.0;
/// Greatest distance of a compressed instance from the origin, in steps: 24 bits hold twice as many.
const STEPS_FROM_ORIGIN: f64 = 4_194_304.0;
/// Least number of steps in the largest size of the compressed instances.
const SIZES: f64 = 256.0;
/// Largest number of sixteen bits.
const MOST: f64 = 65_535.0;
/// Quality of JPEG textures, in percent: differences from the original picture are hardly visible.
const QUALITY: u8 = 88;

/// Way of packing a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// Columns in few bits (`KHR_mesh_quantization`): positions to a 65,535th of the model's size, normals to a degree,
    /// texture coordinates to a 65,535th of their range, colours to a 255th. Most programs read it.
    Quantized,
    /// The same columns, compressed (`EXT_meshopt_compression`). Positions are in steps of a millimetre or of an
    /// 8,192th of the model's size, whichever is finer, texture coordinates in steps of a 512th of a texture if they
    /// are within 128 of it, normals to a degree. In plants of more than eight metres, texture coordinates are in
    /// steps of a 255th within 257, and normals of leaves to four degrees. Textures with holes are WebP without loss
    /// (`EXT_texture_webp`), or PNG without the feature `webp`. The places of instances are true to half a millimetre
    /// (half an 8,192th of the size of small plants), their rotations to two thirds of a degree, their sizes to a
    /// 512th of the largest and their colours to a 255th. A reader must know both extensions: three.js with its
    /// decoder, Babylon, Godot, and Burgeon do; Blender does not.
    Compressed,
}

base::words!(Packing { Quantized = "quantized", Compressed = "meshopt" });

/// How the parts of a model are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Joining {
    /// A mesh and columns for each.
    Apart,
    /// One mesh for all that have triangles, with common columns.
    OneMesh,
}

/// Writes a model as [`super::write_glb`] does, packed, and textures without holes as JPEG. `_PIVOT` is in the
/// coordinates of its node, as positions are.
///
/// Guaranteed: the same model gives the same bytes; vertices that no triangle uses are left out.
/// Not guaranteed: the order of vertices; which corner of a triangle comes first.
///
/// # Errors
/// As [`super::write_glb`].
pub fn write_glb_packed(
    model: &Model,
    packing: Packing,
    cache: &mut PngCache,
    out: impl Write,
) -> Result<(), WriteError> {
    write_packed(&[Level::plain(model)], (packing, Joining::Apart), cache, out)
}

/// [`write_glb_packed`] with all parts that have triangles as one mesh, whose primitives share the columns of their vertices: the
/// least text, for a document that is repeated in many others. Where a part has no colours or texture coordinates and another
/// has, its colours are white and its coordinates 0. Compressed texture coordinates are those of large plants for all, so that plants
/// of one species have equal materials.
///
/// # Errors
/// As [`write_glb_packed`].
pub fn write_glb_joined(
    model: &Model,
    packing: Packing,
    cache: &mut PngCache,
    out: impl Write,
) -> Result<(), WriteError> {
    write_packed(&[Level::plain(model)], (packing, Joining::OneMesh), cache, out)
}

/// Writes several levels as [`write_glb_packed`] does: see [`super::write_glb_levels`].
pub(super) fn write_packed(
    levels: &[Level<'_>],
    (packing, joining): (Packing, Joining),
    cache: &mut PngCache,
    out: impl Write,
) -> Result<(), WriteError> {
    check_levels(levels)?;
    let room = |m: &Model| 16 * m.vertex_count() + 6 * m.triangle_count() + 1024;
    let mut w = Writer::new(levels.iter().map(|l| room(l.model)).sum());
    w.encode = if packing == Packing::Compressed { jpeg_or_webp } else { jpeg_or_png };
    w.needs(QUANTIZATION);
    if packing == Packing::Compressed {
        w.needs(COMPRESSION);
    }
    let mut packer = Packer { w, packing, joining, fallback: 0 };
    for (level, number) in levels.iter().zip(0..) {
        let under = packer.w.level(&levels[0].model.name, number)?;
        packer.level(level, under, cache)?;
    }
    packer.finish(out)
}

/// Encodes a texture as JPEG, or as PNG if it has holes, which JPEG cannot store, or uses alpha as data.
fn jpeg_or_png(texture: &Arc<mesh::Texture>, cache: &mut PngCache) -> Result<Encoded, WriteError> {
    if let Some(jpeg) = jpeg(texture)? { Ok(jpeg) } else { Ok((cache.png(texture)?, "image/png")) }
}

/// Does the same as [`jpeg_or_png`], with lossless WebP instead of PNG.
fn jpeg_or_webp(texture: &Arc<mesh::Texture>, cache: &mut PngCache) -> Result<Encoded, WriteError> {
    if let Some(jpeg) = jpeg(texture)? {
        return Ok(jpeg);
    }
    let webp = webp(texture).map(|bytes| (bytes.into(), WEBP_TYPE));
    webp.map_or_else(|| Ok((cache.png(texture)?, "image/png")), Ok)
}

/// Encodes a texture as JPEG; `None` if it has holes or is too large for the format.
pub(super) fn jpeg(texture: &mesh::Texture) -> Result<Option<Encoded>, WriteError> {
    let sides = (u16::try_from(texture.width), u16::try_from(texture.height));
    let (Ok(width), Ok(height)) = sides else { return Ok(None) };
    if texture.pixels.chunks_exact(4).any(|p| p[3] != 255) {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    let encoder = jpeg_encoder::Encoder::new(&mut bytes, QUALITY);
    let written = encoder.encode(&texture.pixels, width, height, jpeg_encoder::ColorType::Rgba);
    written.map_err(|e| WriteError::Io(std::io::Error::other(e)))?;
    Ok(Some((bytes.into(), "image/jpeg")))
}

/// The part of the texture plane in which a material's coordinates lie.
struct Frame {
    low: [f32; 2],
    size: [f32; 2],
}

impl Frame {
    fn for_material(
        level: &Level<'_>,
        material: usize,
        (packing, joining): (Packing, Joining),
        large: bool,
    ) -> Self {
        let parts = level.model.parts.iter().map(|p| (p.material, &p.mesh));
        let all = parts.chain(level.copies.iter().map(|c| (c.material, &c.mesh)));
        let own = all.filter(|(m, _)| m.index() == material);
        let (mut low, mut high) = ([0.0_f32; 2], [1.0_f32; 2]);
        for uv in own.flat_map(|(_, mesh)| &mesh.uvs).filter(|uv| uv.iter().all(|x| x.is_finite())) {
            for k in 0..2 {
                (low[k], high[k]) = (low[k].min(uv[k]), high[k].max(uv[k]));
            }
        }
        let is_shared = joining == Joining::OneMesh && packing == Packing::Compressed;
        if is_shared {
            // The frame of most plants, so that those of one species have equal materials.
            low = low.map(|x| x.floor().min(-1.0));
        }
        let many = (large || is_shared) && level.copies.iter().all(|c| c.material.index() != material);
        let least = match packing {
            Packing::Quantized => 0.0,
            Packing::Compressed if many => TEXTURES_OF_LARGE,
            Packing::Compressed => TEXTURES,
        };
        Self { low, size: [0, 1].map(|k| (high[k] - low[k]).max(least)) }
    }

    /// Returns the transform that maps coordinates from 0 to 1 back into the frame.
    fn transform(&self) -> Option<Value> {
        let plain = self.low == [0.0; 2] && self.size == [1.0; 2];
        (!plain).then(|| json!({ TRANSFORM: { "offset": self.low, "scale": self.size } }))
    }
}

/// Returns the mesh with only the vertices that triangles use, in the order of their first use; a mesh of points is
/// kept whole.
fn used(mesh: &TriMesh) -> TriMesh {
    if mesh.triangles.is_empty() {
        return mesh.clone();
    }
    let mut new = vec![u32::MAX; mesh.positions.len()];
    let mut order: Vec<usize> = Vec::with_capacity(mesh.positions.len());
    let mut place = |old: u32| {
        let at = &mut new[old as usize];
        if *at == u32::MAX {
            // There are at most as many vertices as before, so the number fits.
            *at = u32::try_from(order.len()).unwrap_or(u32::MAX);
            order.push(old as usize);
        }
        *at
    };
    let triangles = mesh.triangles.iter().map(|t| t.map(&mut place)).collect();
    fn reorder<T: Copy>(column: &[T], order: &[usize]) -> Vec<T> {
        order.iter().filter_map(|&i| column.get(i).copied()).collect()
    }
    TriMesh {
        positions: reorder(&mesh.positions, &order),
        normals: reorder(&mesh.normals, &order),
        uvs: reorder(&mesh.uvs, &order),
        colors: reorder(&mesh.colors, &order),
        wind: reorder(&mesh.wind, &order),
        pivots: reorder(&mesh.pivots, &order),
        triangles,
    }
}

/// Returns a colour as bytes, opaque.
fn color_bytes(color: [f32; 3]) -> [u8; 4] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let [r, g, b] = color.map(|x| (share(x) * 255.0).round() as u8);
    [r, g, b, 255]
}

/// Encodes 0 to 1 in sixteen bits.
fn fine(x: f64) -> [u8; 2] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 65,535")]
    let n = (x.clamp(0.0, 1.0) * MOST).round() as u16;
    n.to_le_bytes()
}

/// A mesh among those that share columns.
struct Piece<'a> {
    /// Row of its material.
    material: u32,
    /// With only the vertices that its triangles use.
    mesh: TriMesh,
    frame: &'a Frame,
    /// Steps of its normals.
    steps: i8,
}

/// A column of all pieces, with `rest` for vertices of those that do not have it; none if no piece has it.
fn rows_of<T: Copy, const N: usize>(
    pieces: &[Piece<'_>],
    column: fn(&TriMesh) -> &[T],
    rest: T,
    row: impl Fn(&Piece<'_>, T) -> [u8; N],
) -> Option<Vec<u8>> {
    if pieces.iter().all(|p| column(&p.mesh).is_empty()) {
        return None;
    }
    let mut bytes = Vec::new();
    for piece in pieces {
        let own = column(&piece.mesh);
        for k in 0..piece.mesh.positions.len() {
            bytes.extend(row(piece, own.get(k).copied().unwrap_or(rest)));
        }
    }
    Some(bytes)
}

struct Packer {
    w: Writer,
    packing: Packing,
    joining: Joining,
    /// Bytes that the file would have without compression.
    fallback: usize,
}

/// Layout of a column.
struct Layout {
    kind: u32,
    shape: &'static str,
    stride: usize,
    bounds: Option<[Vec<f64>; 2]>,
    /// The filter of the compressed bytes, by its name in the extension.
    filter: Option<&'static str>,
    /// Each row belongs to a vertex.
    is_vertex: bool,
}

impl Packer {
    /// Writes materials and meshes of a level, below a node.
    fn level(&mut self, level: &Level<'_>, under: u32, cache: &mut PngCache) -> Result<(), WriteError> {
        let model = level.model;
        // A large plant is one whose positions are in steps of a millimetre.
        let bounds = model.bounds();
        let large = !bounds.is_empty() && bounds.size().max_element() >= STEP_M * STEPS;
        let frames: Vec<Frame> = (0..model.materials.len())
            .map(|m| Frame::for_material(level, m, (self.packing, self.joining), large))
            .collect();
        self.w.placed = frames.iter().map(Frame::transform).collect();
        if self.w.placed.iter().any(Option::is_some) {
            self.w.needs(TRANSFORM);
        }
        let first = self.w.materials(model, cache)?;
        let packing = self.packing;
        let cube = |bounds: mesh::Bounds| {
            if bounds.is_empty() {
                return (DVec3::ZERO, 1.0);
            }
            let size = bounds.size().max_element().max(1e-9);
            match packing {
                Packing::Quantized => (bounds.min, size),
                Packing::Compressed => (bounds.min, size.max(MOST * STEP_M.min(size / STEPS))),
            }
        };
        // One leaf of a large plant is a small part of a picture.
        let is_many = |m: mesh::MaterialId| large && model.materials[m.index()].kind == MaterialKind::Leaf;
        let piece = |material: mesh::MaterialId, mesh: &TriMesh, steps: i8| Piece {
            material: first + material.raw(),
            mesh: used(mesh),
            frame: &frames[material.index()],
            steps,
        };
        let whole = cube(model.bounds());
        for parts in self.groups(model) {
            let name = if let [only] = parts[..] { &only.name } else { &model.name };
            let steps = |p: &Part| if is_many(p.material) { COARSE } else { FINE };
            let pieces: Vec<Piece<'_>> = parts.iter().map(|p| piece(p.material, &p.mesh, steps(p))).collect();
            let at = self.mesh(name, &pieces, whole, under)?;
            let node = &mut self.w.root.nodes[at as usize];
            (node.translation, node.scale) = (Some(whole.0.to_array()), Some([whole.1; 3]));
        }
        for copies in level.copies {
            let (origin, size) = cube(copies.mesh.bounds());
            self.mesh(&copies.name, &[piece(copies.material, &copies.mesh, FINE)], (origin, size), under)?;
            // Where the mesh stands whose coordinates are those of its own cube.
            let stand = |p: &CopyPlace| CopyPlace {
                at: p.at + p.turn * (origin * p.scale),
                scale: p.scale * size,
                ..*p
            };
            self.stand(&copies.places.iter().map(stand).collect::<Vec<_>>())?;
        }
        Ok(())
    }

    /// Parts that have vertices, by the mesh that they are in.
    fn groups<'m>(&self, model: &'m Model) -> Vec<Vec<&'m Part>> {
        let parts = model.parts.iter().filter(|p| !p.mesh.positions.is_empty());
        if self.joining == Joining::Apart {
            return parts.map(|p| vec![p]).collect();
        }
        let (solid, points): (Vec<&Part>, Vec<&Part>) = parts.partition(|p| !p.mesh.triangles.is_empty());
        let solid = std::iter::once(solid).filter(|group| !group.is_empty());
        solid.chain(points.into_iter().map(|p| vec![p])).collect()
    }

    /// A mesh below a node, with a primitive for each piece; its node.
    fn mesh(
        &mut self,
        name: &str,
        pieces: &[Piece<'_>],
        cube: (DVec3, f64),
        under: u32,
    ) -> Result<u32, WriteError> {
        let primitives = self.primitives(pieces, cube)?;
        let root = &mut self.w.root;
        root.meshes.push(Mesh { name: Some(name.to_owned()), primitives, weights: Vec::new() });
        let at = row(root.nodes.len())?;
        let mesh = Some(row(root.meshes.len() - 1)?);
        root.nodes.push(Node { name: Some(name.to_owned()), mesh, ..Node::default() });
        root.nodes[under as usize].children.push(at);
        Ok(at)
    }

    /// Lets the mesh of the last node stand in many places: [`Packing`] says how exactly.
    fn stand(&mut self, places: &[CopyPlace]) -> Result<(), WriteError> {
        if self.packing == Packing::Quantized {
            return self.w.stand(places);
        }
        let instance = |kind, shape, stride, filter| Layout {
            kind,
            shape,
            stride,
            bounds: None,
            filter,
            is_vertex: false,
        };
        let all = || places.iter().map(|p| p.at);
        let (low, high) =
            all().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        let farthest = low.abs().max(high.abs()).max_element();
        let step = STEP_M.min((high - low).max_element() / STEPS);
        let at = power_within(step.max(farthest / STEPS_FROM_ORIGIN));
        let largest = places.iter().map(|p| p.scale).fold(0.0, f64::max);
        let scale = power_within(largest / SIZES);
        let translation: Vec<u8> =
            places.iter().flat_map(|p| p.at.to_array()).flat_map(|x| exponential(x, at)).collect();
        let rotation: Vec<u8> = places.iter().flat_map(|p| quaternion(p.turn.to_array())).collect();
        let scales: Vec<u8> = places.iter().flat_map(|p| [exponential(p.scale, scale); 3].concat()).collect();
        let color: Vec<u8> = places.iter().flat_map(|p| color_bytes(p.color)).collect();
        let columns = InstanceColumns {
            translation: self.column(&translation, instance(FLOAT, "VEC3", 12, Some(EXPONENTIAL)))?,
            rotation: self.column(&rotation, instance(I16, "VEC4", 8, Some(QUATERNION)))?,
            scale: self.column(&scales, instance(FLOAT, "VEC3", 12, Some(EXPONENTIAL)))?,
            color: self.column(&color, instance(U8, "VEC4", 4, None))?,
        };
        self.w.instances(&columns);
        Ok(())
    }

    fn primitives(
        &mut self,
        pieces: &[Piece<'_>],
        (origin, size): (DVec3, f64),
    ) -> Result<Vec<Primitive>, WriteError> {
        let local = |p: [f32; 3]| (DVec3::from(p.map(f64::from)) - origin) / size;
        let mut attributes =
            Attributes { position: Some(self.positions(pieces, &local)?), ..Default::default() };
        let column =
            |kind, shape, stride| Layout { kind, shape, stride, bounds: None, filter: None, is_vertex: true };
        #[expect(clippy::cast_possible_truncation, reason = "-127 to 127")]
        let byte = |x: f32| ((x.clamp(-1.0, 1.0) * 127.0).round() as i8).to_le_bytes()[0];
        let packing = self.packing;
        let normal = |piece: &Piece<'_>, n: [f32; 3]| {
            if packing == Packing::Compressed {
                return octahedral(unit(n), piece.steps);
            }
            let [x, y, z] = unit(n).map(byte);
            [x, y, z, 0]
        };
        if let Some(bytes) = rows_of(pieces, |m| &m.normals, [0.0, 0.0, 1.0], normal) {
            attributes.normal =
                Some(self.column(&bytes, Layout { filter: Some(OCTAHEDRAL), ..column(I8, "VEC3", 4) })?);
        }
        let uv = |piece: &Piece<'_>, uv: [f32; 2]| {
            let Frame { low, size } = piece.frame;
            let [u, v] = [0, 1].map(|k| fine(f64::from((uv[k] - low[k]) / size[k])));
            [u[0], u[1], v[0], v[1]]
        };
        if let Some(bytes) = rows_of(pieces, |m| &m.uvs, [0.0; 2], uv) {
            attributes.uv = Some(self.column(&bytes, column(U16, "VEC2", 4))?);
        }
        if let Some(bytes) = rows_of(pieces, |m| &m.colors, [1.0; 3], |_, c| color_bytes(c)) {
            attributes.color = Some(self.column(&bytes, column(U8, "VEC4", 4))?);
        }
        let wind = |_: &Piece<'_>, w: [f32; 4]| -> [u8; 8] {
            let [a, b, c, d] = w.map(|x| fine(f64::from(x)));
            [a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1]]
        };
        if let Some(bytes) = rows_of(pieces, |m| &m.wind, [0.0; 4], wind) {
            attributes.wind = Some(self.column(&bytes, column(U16, "VEC4", 8))?);
        }
        let pivot = |_: &Piece<'_>, p: [f32; 3]| -> [u8; 16] {
            let numbers = pivot_row(local(p).as_vec3().to_array()).map(f32::to_le_bytes);
            std::array::from_fn(|k| numbers[k / 4][k % 4])
        };
        if let Some(bytes) = rows_of(pieces, |m| &m.pivots, [0.0; 3], pivot) {
            attributes.pivot = Some(self.column(&bytes, column(FLOAT, "VEC4", 16))?);
        }
        let indices = self.indices(pieces)?;
        let primitive = |(piece, indices): (&Piece<'_>, Option<u32>)| Primitive {
            attributes: attributes.clone(),
            indices,
            material: Some(piece.material),
            mode: indices.is_none().then_some(POINTS),
            ..Primitive::default()
        };
        Ok(pieces.iter().zip(indices).map(primitive).collect())
    }

    fn positions(
        &mut self,
        pieces: &[Piece<'_>],
        local: &dyn Fn([f32; 3]) -> DVec3,
    ) -> Result<u32, WriteError> {
        let (mut low, mut high) = ([u16::MAX; 3], [0_u16; 3]);
        let bytes: Vec<u8> = (pieces.iter().flat_map(|piece| &piece.mesh.positions))
            .flat_map(|&p| {
                let [x, y, z] = local(p).to_array().map(fine);
                for (k, n) in [x, y, z].map(u16::from_le_bytes).into_iter().enumerate() {
                    (low[k], high[k]) = (low[k].min(n), high[k].max(n));
                }
                [x[0], x[1], y[0], y[1], z[0], z[1], 0, 0]
            })
            .collect();
        // For normalised integers these are the integers themselves.
        let bounds = [low, high].map(|b| b.map(f64::from).to_vec());
        self.column(
            &bytes,
            Layout {
                kind: U16,
                shape: "VEC3",
                stride: 8,
                bounds: Some(bounds),
                filter: None,
                is_vertex: true,
            },
        )
    }

    fn column(&mut self, bytes: &[u8], layout: Layout) -> Result<u32, WriteError> {
        let Layout { kind, shape, stride, bounds, filter, is_vertex } = layout;
        let view = match self.packing {
            Packing::Quantized => {
                let view =
                    self.w.view(Some(super::glb_write::ARRAY_BUFFER), |bin| bin.extend_from_slice(bytes))?;
                self.w.root.buffer_views[view as usize].byte_stride = Some(stride as u64);
                view
            }
            Packing::Compressed => {
                let stream = encode_attributes(bytes, stride);
                self.compressed(&stream, bytes.len(), (stride, "ATTRIBUTES", filter))?
            }
        };
        if !is_vertex {
            let view = &mut self.w.root.buffer_views[view as usize];
            (view.target, view.byte_stride) = (None, None);
        }
        let [min, max] = bounds.map_or([None, None], |b| b.map(Some));
        self.w.root.accessors.push(Accessor {
            buffer_view: Some(view),
            component_type: kind,
            normalized: kind != FLOAT,
            count: (bytes.len() / stride) as u64,
            shape: shape.to_owned(),
            min,
            max,
            ..Accessor::default()
        });
        row(self.w.root.accessors.len() - 1)
    }

    /// Triangles of all pieces in one view, an accessor each; none of a piece of points.
    fn indices(&mut self, pieces: &[Piece<'_>]) -> Result<Vec<Option<u32>>, WriteError> {
        let (mut triangles, mut vertices) = (Vec::new(), 0);
        for piece in pieces {
            triangles.extend(piece.mesh.triangles.iter().map(|t| t.map(|i| i + vertices)));
            vertices += row(piece.mesh.positions.len())?;
        }
        if triangles.is_empty() {
            return Ok(vec![None; pieces.len()]);
        }
        let is_small = has_small_indices(vertices as usize);
        let stride = if is_small { 2 } else { 4 };
        let view = match self.packing {
            Packing::Quantized => self.w.triangles(&triangles, is_small)?,
            Packing::Compressed => {
                let stream = encode_triangles(&triangles);
                self.compressed(&stream, 3 * triangles.len() * stride, (stride, "TRIANGLES", None))?
            }
        };
        let mut start = 0;
        let mut accessors = Vec::with_capacity(pieces.len());
        for piece in pieces {
            let count = 3 * piece.mesh.triangles.len();
            if count == 0 {
                accessors.push(None);
                continue;
            }
            self.w.root.accessors.push(Accessor {
                buffer_view: Some(view),
                byte_offset: (start * stride) as u64,
                component_type: if is_small { U16 } else { U32 },
                count: count as u64,
                shape: "SCALAR".into(),
                ..Accessor::default()
            });
            accessors.push(Some(row(self.w.root.accessors.len() - 1)?));
            start += count;
        }
        Ok(accessors)
    }

    /// Adds a view of the contents of a stream, which are `length` bytes long.
    fn compressed(
        &mut self,
        stream: &[u8],
        length: usize,
        (stride, mode, filter): (usize, &str, Option<&str>),
    ) -> Result<u32, WriteError> {
        let start = self.w.bin.len();
        self.w.bin.extend_from_slice(stream);
        self.w.bin.resize(self.w.bin.len().next_multiple_of(4), 0);
        let indices = mode == "TRIANGLES";
        let mut packed = json!({
            "buffer": 0,
            "byteOffset": start,
            "byteLength": stream.len(),
            "byteStride": stride,
            "count": length / stride,
            "mode": mode,
        });
        if let Some(filter) = filter {
            packed["filter"] = filter.into();
        }
        self.w.root.buffer_views.push(View {
            // The buffer of the data that exist only with the extension.
            buffer: 1,
            byte_offset: self.fallback as u64,
            byte_length: length as u64,
            byte_stride: (!indices).then_some(stride as u64),
            target: Some(if indices {
                super::glb_write::ELEMENT_ARRAY_BUFFER
            } else {
                super::glb_write::ARRAY_BUFFER
            }),
            extensions: Some(json!({ COMPRESSION: packed })),
        });
        self.fallback = (self.fallback + length).next_multiple_of(4);
        row(self.w.root.buffer_views.len() - 1)
    }

    fn finish(mut self, out: impl Write) -> Result<(), WriteError> {
        if self.fallback > 0 {
            let length = self.w.bin.len() as u64;
            let fallback = Some(json!({ COMPRESSION: { "fallback": true } }));
            self.w.root.buffers = vec![
                Buffer { byte_length: length, ..Buffer::default() },
                Buffer { byte_length: self.fallback as u64, extensions: fallback, ..Buffer::default() },
            ];
        }
        self.w.finish(out)
    }
}
