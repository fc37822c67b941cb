//! Model -> a GLB that is light to carry: columns in few bits, compressed, textures as JPEG.

use std::io::Write;
use std::sync::Arc;

use glam::DVec3;
use mesh::{CopyPlace, MaterialKind, Model, TriMesh};
use serde_json::{Value, json};

use super::glb_write::{Encoded, InstanceColumns, Level, Writer, check_levels, pivot_row, row};
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

/// Steps of compressed positions, metres, and least steps within the size of a model: finer ones are not seen and do not
/// compress.
const STEP_M: f64 = 0.001;
const STEPS: f64 = 8192.0;
/// Textures within the range of compressed coordinates, of which each has 512 steps, and of a large plant 255, which fit into a byte.
const TEXTURES: f32 = 65_535.0 / 512.0;
const TEXTURES_OF_LARGE: f32 = 257.0;
/// Most steps of a place of a compressed instance from the origin: 24 bits hold twice as many.
const STEPS_FROM_ORIGIN: f64 = 4_194_304.0;
/// Least steps of the largest of the sizes of compressed instances.
const SIZES: f64 = 256.0;
/// What sixteen bits count to.
const MOST: f64 = 65_535.0;
/// Of JPEG textures: differences are hardly seen beside the picture.
const QUALITY: u8 = 88;

/// What a packed file does without.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// Columns in few bits (`KHR_mesh_quantization`): positions to a 65,535th of the model's size, normals to a degree,
    /// texture coordinates to a 65,535th of their range, colours to a 255th. Most programs read it.
    Quantized,
    /// Those, compressed (`EXT_meshopt_compression`), with positions in steps of a millimetre or of an 8,192th of the model's
    /// size, whichever is finer, texture coordinates in steps of a 512th of a texture if they are within 128 of it, normals to a
    /// degree (of plants of more than eight metres: a 255th within 257, normals of leaves to four degrees), and textures with
    /// holes as WebP without loss (`EXT_texture_webp`; as PNG without the feature `webp`). Instances stand where they should to
    /// half a millimetre (half a 8,192th of the size of small plants), turned to two thirds of a degree, with a size to a 512th
    /// of the largest and a colour to a 255th. A reader must know both: three.js with its decoder, Babylon, Godot, and Burgeon do;
    /// Blender does not.
    Compressed,
}

/// Writes a model as [`super::write_glb`] does, packed, and textures without holes as JPEG. `_PIVOT` is in the
/// coordinates of its node, as positions are.
///
/// Guaranteed: the same model gives the same bytes; vertices that no triangle uses are left out.
/// Not guaranteed: the order of vertices; the order of a triangle's corners beyond their turn.
///
/// # Errors
/// As [`super::write_glb`].
pub fn write_glb_packed(
    model: &Model,
    packing: Packing,
    cache: &mut PngCache,
    out: impl Write,
) -> Result<(), WriteError> {
    write_packed(&[Level::plain(model)], packing, cache, out)
}

/// [`write_glb_packed`] of several levels: see [`super::write_glb_levels`].
pub(super) fn write_packed(
    levels: &[Level<'_>],
    packing: Packing,
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
    let mut packer = Packer { w, packing, fallback: 0 };
    for (level, number) in levels.iter().zip(0..) {
        let under = packer.w.level(&levels[0].model.name, number)?;
        packer.level(level, under, cache)?;
    }
    packer.finish(out)
}

/// A texture as JPEG; one with holes, which JPEG cannot have, and one whose alpha is its matter, as PNG.
fn jpeg_or_png(texture: &Arc<mesh::Texture>, cache: &mut PngCache) -> Result<Encoded, WriteError> {
    if let Some(jpeg) = jpeg(texture)? { Ok(jpeg) } else { Ok((cache.png(texture)?, "image/png")) }
}

/// As [`jpeg_or_png`], but as WebP, without loss, in the place of PNG.
fn jpeg_or_webp(texture: &Arc<mesh::Texture>, cache: &mut PngCache) -> Result<Encoded, WriteError> {
    if let Some(jpeg) = jpeg(texture)? {
        return Ok(jpeg);
    }
    let webp = webp(texture).map(|bytes| (bytes.into(), WEBP_TYPE));
    webp.map_or_else(|| Ok((cache.png(texture)?, "image/png")), Ok)
}

/// `None` of what has holes, or is too large for it.
fn jpeg(texture: &mesh::Texture) -> Result<Option<Encoded>, WriteError> {
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
    fn of(level: &Level<'_>, material: usize, packing: Packing, large: bool) -> Self {
        let parts = level.model.parts.iter().map(|p| (p.material, &p.mesh));
        let all = parts.chain(level.copies.iter().map(|c| (c.material, &c.mesh)));
        let own = all.filter(|(m, _)| m.index() == material);
        let (mut low, mut high) = ([0.0_f32; 2], [1.0_f32; 2]);
        for uv in own.flat_map(|(_, mesh)| &mesh.uvs).filter(|uv| uv.iter().all(|x| x.is_finite())) {
            for k in 0..2 {
                (low[k], high[k]) = (low[k].min(uv[k]), high[k].max(uv[k]));
            }
        }
        let many = large && level.copies.iter().all(|c| c.material.index() != material);
        let least = match packing {
            Packing::Quantized => 0.0,
            Packing::Compressed if many => TEXTURES_OF_LARGE,
            Packing::Compressed => TEXTURES,
        };
        Self { low, size: [0, 1].map(|k| (high[k] - low[k]).max(least)) }
    }

    /// Puts coordinates from 0 to 1 back into the frame.
    fn transform(&self) -> Option<Value> {
        let plain = self.low == [0.0; 2] && self.size == [1.0; 2];
        (!plain).then(|| json!({ TRANSFORM: { "offset": self.low, "scale": self.size } }))
    }
}

/// The mesh with only the vertices that triangles use, in the order of their first use; of points all.
fn used(mesh: &TriMesh) -> TriMesh {
    if mesh.triangles.is_empty() {
        return mesh.clone();
    }
    let mut new = vec![u32::MAX; mesh.positions.len()];
    let mut order: Vec<usize> = Vec::with_capacity(mesh.positions.len());
    let mut place = |old: u32| {
        let at = &mut new[old as usize];
        if *at == u32::MAX {
            // As many as there were, which fit.
            *at = u32::try_from(order.len()).unwrap_or(u32::MAX);
            order.push(old as usize);
        }
        *at
    };
    let triangles = mesh.triangles.iter().map(|t| t.map(&mut place)).collect();
    fn of<T: Copy>(column: &[T], order: &[usize]) -> Vec<T> {
        order.iter().filter_map(|&i| column.get(i).copied()).collect()
    }
    TriMesh {
        positions: of(&mesh.positions, &order),
        normals: of(&mesh.normals, &order),
        uvs: of(&mesh.uvs, &order),
        colors: of(&mesh.colors, &order),
        wind: of(&mesh.wind, &order),
        pivots: of(&mesh.pivots, &order),
        triangles,
    }
}

/// A colour as bytes, opaque.
fn color_bytes(color: [f32; 3]) -> [u8; 4] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let [r, g, b] = color.map(|x| (share(x) * 255.0).round() as u8);
    [r, g, b, 255]
}

/// 0 to 1 in sixteen bits.
fn fine(x: f64) -> [u8; 2] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 65,535")]
    let n = (x.clamp(0.0, 1.0) * MOST).round() as u16;
    n.to_le_bytes()
}

struct Packer {
    w: Writer,
    packing: Packing,
    /// Bytes that the file would have without compression.
    fallback: usize,
}

/// How a column is laid out.
struct Layout {
    kind: u32,
    shape: &'static str,
    stride: usize,
    bounds: Option<[Vec<f64>; 2]>,
    /// How compressed bytes store it, by the word of the extension.
    filter: Option<&'static str>,
    /// Rows are of vertices.
    is_vertex: bool,
}

impl Packer {
    /// Materials and meshes of a level, below a node.
    fn level(&mut self, level: &Level<'_>, under: u32, cache: &mut PngCache) -> Result<(), WriteError> {
        let model = level.model;
        // One whose positions are in steps of a millimetre.
        let bounds = model.bounds();
        let large = !bounds.is_empty() && bounds.size().max_element() >= STEP_M * STEPS;
        let frames: Vec<Frame> =
            (0..model.materials.len()).map(|m| Frame::of(level, m, self.packing, large)).collect();
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
        let whole = cube(model.bounds());
        let parts = model.parts.iter().filter(|p| !p.mesh.positions.is_empty());
        let parts = parts.map(|p| (&p.name, p.material, &p.mesh, whole, None));
        let copies = level.copies.iter();
        let copies = copies.map(|c| (&c.name, c.material, &c.mesh, cube(c.mesh.bounds()), Some(&c.places)));
        for (name, material, mesh, (origin, size), places) in parts.chain(copies) {
            let mesh = used(mesh);
            let frame = &frames[material.index()];
            // One leaf of a large plant is a small part of a picture.
            let many =
                large && places.is_none() && model.materials[material.index()].kind == MaterialKind::Leaf;
            let (material, steps) = (first + material.raw(), if many { COARSE } else { FINE });
            let primitive = self.primitive(&mesh, (origin, size), frame, (material, steps))?;
            let root = &mut self.w.root;
            root.meshes.push(Mesh {
                name: Some(name.clone()),
                primitives: vec![primitive],
                weights: Vec::new(),
            });
            let at = row(root.nodes.len())?;
            root.nodes.push(Node {
                name: Some(name.clone()),
                mesh: Some(row(root.meshes.len() - 1)?),
                translation: places.is_none().then(|| origin.to_array()),
                scale: places.is_none().then_some([size; 3]),
                ..Node::default()
            });
            root.nodes[under as usize].children.push(at);
            if let Some(places) = places {
                // Where the mesh stands whose coordinates are those of its own cube.
                let stand = |p: &CopyPlace| CopyPlace {
                    at: p.at + p.turn * (origin * p.scale),
                    scale: p.scale * size,
                    ..*p
                };
                self.stand(&places.iter().map(stand).collect::<Vec<_>>())?;
            }
        }
        Ok(())
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

    fn primitive(
        &mut self,
        mesh: &TriMesh,
        (origin, size): (DVec3, f64),
        frame: &Frame,
        (material, steps): (u32, i8),
    ) -> Result<Primitive, WriteError> {
        let local = |p: [f32; 3]| (DVec3::from(p.map(f64::from)) - origin) / size;
        let mut attributes =
            Attributes { position: Some(self.positions(mesh, &local)?), ..Default::default() };
        let column =
            |kind, shape, stride| Layout { kind, shape, stride, bounds: None, filter: None, is_vertex: true };
        if !mesh.normals.is_empty() {
            #[expect(clippy::cast_possible_truncation, reason = "-127 to 127")]
            let byte = |x: f32| ((x.clamp(-1.0, 1.0) * 127.0).round() as i8).to_le_bytes()[0];
            let bytes = mesh.normals.iter().flat_map(|&n| {
                if self.packing == Packing::Compressed {
                    return octahedral(unit(n), steps);
                }
                let [x, y, z] = unit(n).map(byte);
                [x, y, z, 0]
            });
            let bytes: Vec<u8> = bytes.collect();
            attributes.normal =
                Some(self.column(&bytes, Layout { filter: Some(OCTAHEDRAL), ..column(I8, "VEC3", 4) })?);
        }
        if !mesh.uvs.is_empty() {
            let bytes = mesh.uvs.iter().flat_map(|uv| {
                let [u, v] = [0, 1].map(|k| fine(f64::from((uv[k] - frame.low[k]) / frame.size[k])));
                [u[0], u[1], v[0], v[1]]
            });
            attributes.uv = Some(self.column(&bytes.collect::<Vec<u8>>(), column(U16, "VEC2", 4))?);
        }
        if !mesh.colors.is_empty() {
            let bytes = mesh.colors.iter().flat_map(|&c| color_bytes(c));
            attributes.color = Some(self.column(&bytes.collect::<Vec<u8>>(), column(U8, "VEC4", 4))?);
        }
        if !mesh.wind.is_empty() {
            let bytes = mesh.wind.iter().flatten().flat_map(|&x| fine(f64::from(x)));
            attributes.wind = Some(self.column(&bytes.collect::<Vec<u8>>(), column(U16, "VEC4", 8))?);
        }
        if !mesh.pivots.is_empty() {
            let rows = mesh.pivots.iter().flat_map(|&p| pivot_row(local(p).as_vec3().to_array()));
            let bytes: Vec<u8> = rows.flat_map(f32::to_le_bytes).collect();
            attributes.pivot = Some(self.column(&bytes, column(FLOAT, "VEC4", 16))?);
        }
        let points = mesh.triangles.is_empty();
        Ok(Primitive {
            attributes,
            indices: if points { None } else { Some(self.indices(mesh)?) },
            material: Some(material),
            mode: points.then_some(POINTS),
            ..Primitive::default()
        })
    }

    fn positions(&mut self, mesh: &TriMesh, local: &dyn Fn([f32; 3]) -> DVec3) -> Result<u32, WriteError> {
        let (mut low, mut high) = ([u16::MAX; 3], [0_u16; 3]);
        let bytes: Vec<u8> = (mesh.positions.iter())
            .flat_map(|&p| {
                let [x, y, z] = local(p).to_array().map(fine);
                for (k, n) in [x, y, z].map(u16::from_le_bytes).into_iter().enumerate() {
                    (low[k], high[k]) = (low[k].min(n), high[k].max(n));
                }
                [x[0], x[1], y[0], y[1], z[0], z[1], 0, 0]
            })
            .collect();
        // Of normalised integers the integers themselves.
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

    fn indices(&mut self, mesh: &TriMesh) -> Result<u32, WriteError> {
        if self.packing == Packing::Quantized {
            return self.w.indices(mesh);
        }
        let small = mesh.positions.len() < 65_536;
        let stride = if small { 2 } else { 4 };
        let stream = encode_triangles(&mesh.triangles);
        let view =
            self.compressed(&stream, 3 * mesh.triangles.len() * stride, (stride, "TRIANGLES", None))?;
        self.w.root.accessors.push(Accessor {
            buffer_view: Some(view),
            component_type: if small { U16 } else { U32 },
            count: 3 * mesh.triangles.len() as u64,
            shape: "SCALAR".into(),
            ..Accessor::default()
        });
        row(self.w.root.accessors.len() - 1)
    }

    /// A view of what a stream holds, which is `length` bytes.
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
            // The buffer of what is not there without the extension.
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
