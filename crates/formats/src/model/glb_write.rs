//! Model -> binary glTF 2.0, in metres, +Y up.

use std::io::Write;
use std::sync::Arc;

use mesh::{AlphaMode, Model, TriMesh};
use serde_json::json;

use super::gltf::{
    Accessor, Asset, Attributes, Buffer, FLOAT, Image, Material, Mesh, Node, POINTS, Pbr, Primitive, Root,
    Sampler, Scene, Texture, TextureInfo, U16, U32, View,
};
use super::{PngCache, check, unit};
use crate::error::WriteError;

const ARRAY_BUFFER: u32 = 34_962;
const ELEMENT_ARRAY_BUFFER: u32 = 34_963;
const LINEAR: u32 = 9_729;
const LINEAR_MIPMAP_LINEAR: u32 = 9_987;

/// Writes a model as a GLB: one root node named after the model, one node and mesh a part, materials with
/// embedded PNG textures (each once), `alphaMode` MASK and `doubleSided` where the material says so.
///
/// Guaranteed: the same model gives the same bytes; the Khronos validator finds no error and no warning.
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

/// [`write_glb`] with encoded textures kept for the next time.
///
/// # Errors
/// As [`write_glb`].
pub fn write_glb_with(model: &Model, cache: &mut PngCache, mut out: impl Write) -> Result<(), WriteError> {
    check(model)?;
    let mut w = Writer { root: Root::default(), bin: Vec::with_capacity(room(model)) };
    w.root.asset = Asset {
        version: "2.0".into(),
        generator: Some(concat!("Burgeon ", env!("CARGO_PKG_VERSION")).into()),
        extras: Some(json!({ "unit": "metre", "up": "+Y" })),
    };
    w.materials(model, cache)?;
    w.nodes(model)?;
    if !w.bin.is_empty() {
        w.root.buffers.push(Buffer { byte_length: w.bin.len() as u64, uri: None });
    }
    let mut text = serde_json::to_vec(&w.root).map_err(|e| WriteError::Io(e.into()))?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let bin = if w.bin.is_empty() { 0 } else { 8 + w.bin.len() };
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
    if !w.bin.is_empty() {
        out.write_all(&word(w.bin.len())?)?;
        out.write_all(b"BIN\0")?;
        out.write_all(&w.bin)?;
    }
    Ok(())
}

fn room(model: &Model) -> usize {
    48 * model.vertex_count() + 12 * model.triangle_count() + 1024
}

fn row(n: usize) -> Result<u32, WriteError> {
    u32::try_from(n).ok().ok_or(WriteError::TooLarge { what: "the number of parts", format: "glTF" })
}

struct Writer {
    root: Root,
    bin: Vec<u8>,
}

impl Writer {
    /// Makes a buffer view of what `fill` appends.
    fn view(&mut self, target: Option<u32>, fill: impl FnOnce(&mut Vec<u8>)) -> Result<u32, WriteError> {
        let start = self.bin.len();
        fill(&mut self.bin);
        let byte_length = (self.bin.len() - start) as u64;
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = View { byte_offset: start as u64, byte_length, target, ..View::default() };
        self.root.buffer_views.push(view);
        row(self.root.buffer_views.len() - 1)
    }

    fn column<const N: usize>(
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

    fn indices(&mut self, mesh: &TriMesh) -> Result<u32, WriteError> {
        // 65535 itself is the primitive restart value and may not be an index.
        let small = mesh.positions.len() < 65_536;
        let view = self.view(Some(ELEMENT_ARRAY_BUFFER), |bin| {
            let indices = mesh.triangles.iter().flatten();
            if small {
                #[expect(clippy::cast_possible_truncation, reason = "below 65535: checked with the model")]
                bin.extend(indices.flat_map(|&i| (i as u16).to_le_bytes()));
            } else {
                bin.extend(indices.flat_map(|&i| i.to_le_bytes()));
            }
        })?;
        self.root.accessors.push(Accessor {
            buffer_view: Some(view),
            component_type: if small { U16 } else { U32 },
            count: 3 * mesh.triangles.len() as u64,
            shape: "SCALAR".into(),
            ..Accessor::default()
        });
        row(self.root.accessors.len() - 1)
    }

    fn materials(&mut self, model: &Model, cache: &mut PngCache) -> Result<(), WriteError> {
        let mut images: Vec<Arc<mesh::Texture>> = Vec::new();
        for material in &model.materials {
            let texture = match &material.texture {
                None => None,
                Some(texture) => {
                    let known = images.iter().position(|t| Arc::ptr_eq(t, texture) || t == texture);
                    let index = match known {
                        Some(index) => index,
                        None => {
                            let png = cache.png(texture)?;
                            let view = self.view(None, |bin| bin.extend_from_slice(&png))?;
                            self.root.images.push(Image {
                                name: Some(material.name.clone()),
                                buffer_view: Some(view),
                                mime_type: Some("image/png".into()),
                                uri: None,
                            });
                            self.root.textures.push(Texture {
                                sampler: Some(0),
                                source: Some(row(self.root.images.len() - 1)?),
                            });
                            images.push(Arc::clone(texture));
                            images.len() - 1
                        }
                    };
                    Some(TextureInfo { index: row(index)? })
                }
            };
            let [r, g, b] = material.base_color.map(share);
            self.root.materials.push(Material {
                name: Some(material.name.clone()),
                pbr_metallic_roughness: Pbr {
                    base_color_factor: Some([r, g, b, 1.0]),
                    base_color_texture: texture,
                    metallic_factor: Some(0.0),
                    roughness_factor: Some(share(material.roughness)),
                },
                alpha_mode: (material.alpha == AlphaMode::Mask).then(|| "MASK".into()),
                double_sided: material.double_sided,
                extras: Some(json!({
                    "kind": material.kind.word(),
                    "translucency": share(material.translucency),
                })),
            });
        }
        if !images.is_empty() {
            self.root
                .samplers
                .push(Sampler { mag_filter: Some(LINEAR), min_filter: Some(LINEAR_MIPMAP_LINEAR) });
        }
        Ok(())
    }

    fn nodes(&mut self, model: &Model) -> Result<(), WriteError> {
        let name = if model.name.is_empty() { "model" } else { &model.name };
        self.root.nodes.push(Node { name: Some(name.to_owned()), ..Node::default() });
        let mut children = Vec::new();
        for part in model.parts.iter().filter(|p| !p.mesh.positions.is_empty()) {
            let mesh = &part.mesh;
            let normals: Vec<[f32; 3]> = mesh.normals.iter().map(|&n| unit(n)).collect();
            let mut attributes = Attributes {
                position: Some(self.column("VEC3", &mesh.positions, true)?),
                ..Default::default()
            };
            if !normals.is_empty() {
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
            let points = mesh.triangles.is_empty();
            let primitive = Primitive {
                attributes,
                indices: if points { None } else { Some(self.indices(mesh)?) },
                material: Some(part.material.raw()),
                mode: points.then_some(POINTS),
                extensions: None,
            };
            self.root.meshes.push(Mesh { name: Some(part.name.clone()), primitives: vec![primitive] });
            self.root.nodes.push(Node {
                name: Some(part.name.clone()),
                mesh: Some(row(self.root.meshes.len() - 1)?),
                ..Node::default()
            });
            children.push(row(self.root.nodes.len() - 1)?);
        }
        self.root.nodes[0].children = children;
        self.root.scenes.push(Scene { name: Some(name.to_owned()), nodes: vec![0] });
        self.root.scene = Some(0);
        Ok(())
    }
}

/// 0 to 1, as glTF demands; NaN is 0.
fn share(x: f32) -> f32 {
    if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) }
}
