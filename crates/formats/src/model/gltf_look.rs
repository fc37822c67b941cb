//! Materials and their textures: Burgeon <-> glTF.

use std::sync::Arc;

use base::LiteMap;
use mesh::{AlphaMode, Impostor, Maps, Model};
use serde_json::{Value, json};

use super::glb_write::{Writer, row};
use super::gltf::{Image, Material, Pbr, Root, Texture, TextureInfo};
use super::gltf_bytes::{Bytes, MeshFault, item, load_uri};
use super::named::{Files, NAMED};
use super::picture::{WEBP_TYPE, read_webp};
use super::{Names, PngCache, kind_of, read_picture, share};
use crate::error::{FileFault, WriteError};

/// The extension for light through a thin blade; viewers without it show the blade as opaque.
const TRANSMISSION: &str = "KHR_materials_diffuse_transmission";
/// The extension for textures as WebP.
pub(super) const WEBP: &str = "EXT_texture_webp";

impl Writer {
    /// Adds the model's materials and returns the row of the first.
    pub(super) fn materials(&mut self, model: &Model, cache: &mut PngCache) -> Result<u32, WriteError> {
        let first = row(self.root.materials.len())?;
        for (k, material) in model.materials.iter().enumerate() {
            let placed = self.placed.get(k).cloned().flatten();
            let put =
                |info: Option<TextureInfo>| info.map(|i| TextureInfo { extensions: placed.clone(), ..i });
            let of = |map: &str| format!("{}-{map}", material.name);
            let maps = &material.maps;
            let texture = put(self.texture(material.texture.as_ref(), &material.name, cache)?);
            let normal = put(self.texture(maps.normal.as_ref(), &of("normal"), cache)?);
            let orm = put(self.texture(maps.orm.as_ref(), &of("orm"), cache)?);
            let extensions = self.through(material, cache)?;
            let [r, g, b] = material.base_color.map(share);
            self.root.materials.push(Material {
                name: Some(material.name.clone()),
                pbr_metallic_roughness: Pbr {
                    base_color_factor: Some([r, g, b, 1.0]),
                    base_color_texture: texture,
                    // The map's blue must not make the material metallic, too.
                    metallic_factor: Some(0.0),
                    roughness_factor: Some(share(material.roughness)),
                    metallic_roughness_texture: orm.clone(),
                },
                normal_texture: normal,
                occlusion_texture: orm,
                alpha_mode: (material.alpha == AlphaMode::Mask).then(|| "MASK".into()),
                double_sided: material.double_sided,
                extensions,
                extras: Some(extras(material)),
            });
        }
        Ok(first)
    }

    fn through(
        &mut self,
        material: &mesh::Material,
        cache: &mut PngCache,
    ) -> Result<Option<Value>, WriteError> {
        let share = share(material.translucency);
        // In a solid it would be the light in its volume, which is another extension's.
        if share <= 0.0 || !material.double_sided {
            return Ok(None);
        }
        let name = format!("{}-through", material.name);
        let texture = self.texture(material.maps.through.as_ref(), &name, cache)?;
        let mut look = json!({ "diffuseTransmissionFactor": share });
        if let Some(texture) = texture {
            look["diffuseTransmissionTexture"] = json!({ "index": texture.index });
        }
        // The light through a leaf has the leaf's colour, but is yellower: more red and green than blue.
        if material.kind == mesh::MaterialKind::Leaf {
            look["diffuseTransmissionColorFactor"] = json!([1.0, 0.95, 0.55]);
        }
        self.uses(TRANSMISSION);
        Ok(Some(json!({ TRANSMISSION: look })))
    }

    /// Returns the texture's row in the file, in which equal ones are stored once.
    fn texture(
        &mut self,
        texture: Option<&Arc<mesh::Texture>>,
        name: &str,
        cache: &mut PngCache,
    ) -> Result<Option<TextureInfo>, WriteError> {
        let Some(texture) = texture else { return Ok(None) };
        let known = self.images.iter().position(|t| Arc::ptr_eq(t, texture) || t == texture);
        if let Some(known) = known {
            return Ok(Some(TextureInfo { index: row(known)?, ..TextureInfo::default() }));
        }
        let (bytes, kind) = (self.encode)(texture, cache)?;
        let view = self.view(None, |bin| bin.extend_from_slice(&bytes))?;
        self.root.images.push(Image {
            name: Some(name.to_owned()),
            buffer_view: Some(view),
            mime_type: Some(kind.into()),
            uri: None,
        });
        let image = row(self.root.images.len() - 1)?;
        // A reader without WebP finds no picture; the required extension tells it so.
        let webp = kind == WEBP_TYPE;
        if webp {
            self.needs(WEBP);
        }
        self.root.textures.push(Texture {
            sampler: Some(0),
            source: (!webp).then_some(image),
            extensions: webp.then(|| json!({ WEBP: { "source": image } })),
        });
        self.images.push(Arc::clone(texture));
        Ok(Some(TextureInfo { index: row(self.images.len() - 1)?, ..TextureInfo::default() }))
    }
}

/// Returns the row of a texture's image: the WebP, if there is one.
fn source(texture: &Texture) -> Option<usize> {
    let webp = || usize::try_from(texture.extensions.as_ref()?.get(WEBP)?.get("source")?.as_u64()?).ok();
    webp().or_else(|| Some(texture.source? as usize))
}

/// Returns the properties that glTF has no field for.
fn extras(material: &mesh::Material) -> Value {
    let mut extras = json!({
        "kind": material.kind.word(),
        "translucency": share(material.translucency),
    });
    if let Some(Impostor { frames, centre, radius_m }) = material.impostor {
        extras["impostor"] = json!({
            "layout": "hemi-octahedral",
            "frames": frames,
            "centre": centre,
            "radius": radius_m,
            "depth": "alpha of normalTexture",
        });
    }
    extras
}

/// The pictures of a document, each read once.
pub(super) struct Pictures<'a> {
    root: &'a Root,
    bytes: &'a Bytes<'a>,
    files: Files<'a>,
    read: Vec<Option<Option<Arc<mesh::Texture>>>>,
    /// The pictures of files, which images may share.
    named: LiteMap<&'a str, Option<Arc<mesh::Texture>>>,
    pixels: usize,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(root: &'a Root, bytes: &'a Bytes<'a>, files: Files<'a>) -> Self {
        let read = vec![None; root.images.len()];
        Self { root, bytes, files, read, named: LiteMap::new(), pixels: 0 }
    }

    /// Returns the picture that `info` names; none if it names none, or one that cannot be read.
    fn get(&mut self, info: Option<&TextureInfo>) -> Result<Option<Arc<mesh::Texture>>, MeshFault> {
        let texture = info.and_then(|info| self.root.textures.get(info.index as usize));
        let Some(source) = texture.and_then(source).filter(|&s| s < self.read.len()) else { return Ok(None) };
        if let Some(known) = &self.read[source] {
            return Ok(known.clone());
        }
        let image = &self.root.images[source];
        let picture = match (image.buffer_view, &image.uri) {
            (Some(view), _) => {
                let bytes = self.bytes.view(self.root, view).ok().map(|(b, _)| b.to_vec());
                self.decode(bytes)
            }
            (None, Some(uri)) => match self.named.get(uri.as_str()) {
                Some(known) => known.clone(),
                None => {
                    let bytes = match load_uri(uri, &mut self.files, &item("image", source)) {
                        Err(fault @ (_, FileFault::Refused { .. } | FileFault::TooMuch { .. })) => {
                            return Err(fault);
                        }
                        bytes => bytes.ok().flatten(),
                    };
                    let picture = self.decode(bytes);
                    self.named.insert(uri, picture.clone());
                    picture
                }
            },
            (None, None) => None,
        };
        self.read[source] = Some(picture.clone());
        Ok(picture)
    }

    fn decode(&mut self, bytes: Option<Vec<u8>>) -> Option<Arc<mesh::Texture>> {
        let bytes = bytes.filter(|_| self.pixels < NAMED.pixels)?;
        let picture = read_picture(&bytes).or_else(|| read_webp(&bytes))?;
        self.pixels = self.pixels.saturating_add(picture.pixels.len());
        Some(Arc::new(picture))
    }

    /// Returns the materials by their rows, and for each whether a texture was left out.
    pub(super) fn materials(&mut self) -> Result<Vec<(mesh::Material, bool)>, MeshFault> {
        let mut names = Names::default();
        let root = self.root;
        let each = root.materials.iter().map(|m| {
            let pbr = &m.pbr_metallic_roughness;
            let look = m.extensions.as_ref().and_then(|e| e.get(TRANSMISSION));
            let through: Option<TextureInfo> = look
                .and_then(|l| l.get("diffuseTransmissionTexture")?.get("index")?.as_u64())
                .and_then(|i| Some(TextureInfo { index: u32::try_from(i).ok()?, ..TextureInfo::default() }));
            let texture = self.get(pbr.base_color_texture.as_ref())?;
            let maps = Maps {
                normal: self.get(m.normal_texture.as_ref())?,
                orm: self.orm(m)?,
                height: None,
                through: self.get(through.as_ref())?,
            };
            let name = names.fresh(m.name.as_deref().unwrap_or_default(), "material");
            let lost = texture.is_none() && pbr.base_color_texture.is_some();
            Ok((material(m, name, texture, maps), lost))
        });
        each.collect()
    }

    /// Returns occlusion and roughness in one picture; roughness alone gets full white as occlusion.
    fn orm(&mut self, m: &Material) -> Result<Option<Arc<mesh::Texture>>, MeshFault> {
        let rough = m.pbr_metallic_roughness.metallic_roughness_texture.as_ref();
        let Some(picture) = self.get(rough)? else { return Ok(None) };
        if m.occlusion_texture.as_ref().is_some_and(|o| Some(o.index) == rough.map(|r| r.index)) {
            return Ok(Some(picture));
        }
        let mut alone = (*picture).clone();
        alone.pixels.chunks_exact_mut(4).for_each(|p| p[0] = 255);
        Ok(Some(Arc::new(alone)))
    }
}

fn material(m: &Material, name: String, texture: Option<Arc<mesh::Texture>>, maps: Maps) -> mesh::Material {
    let pbr = &m.pbr_metallic_roughness;
    let extra = |key: &str| m.extras.as_ref().and_then(|e| e.get(key));
    let [r, g, b, _] = pbr.base_color_factor.unwrap_or([1.0; 4]);
    let kind = kind_of(extra("kind").and_then(|k| k.as_str()).unwrap_or(&name));
    let factor = || m.extensions.as_ref()?.get(TRANSMISSION)?.get("diffuseTransmissionFactor");
    #[expect(clippy::cast_possible_truncation, reason = "a share between 0 and 1")]
    let translucency = extra("translucency").or_else(factor).and_then(Value::as_f64).unwrap_or(0.0) as f32;
    mesh::Material {
        name,
        kind,
        base_color: [r, g, b],
        roughness: pbr.roughness_factor.unwrap_or(1.0),
        translucency: translucency.clamp(0.0, 1.0),
        texture,
        maps,
        // Blended leaves become leaves with holes: no renderer sorts blended ones well.
        alpha: match m.alpha_mode.as_deref() {
            None | Some("OPAQUE") => AlphaMode::Opaque,
            Some(_) => AlphaMode::Mask,
        },
        double_sided: m.double_sided,
        impostor: extra("impostor").and_then(impostor),
    }
}

/// Parses the extras of an impostor.
#[expect(clippy::cast_possible_truncation, reason = "meshes are f32 by design")]
fn impostor(known: &Value) -> Option<Impostor> {
    let number = |v: &Value| v.as_f64().map(|x| x as f32).filter(|x| x.is_finite());
    let [x, y, z] = known.get("centre")?.as_array()?.as_slice() else { return None };
    let frames = known.get("frames")?.as_u64().and_then(|n| u32::try_from(n).ok()).filter(|n| *n >= 2)?;
    Some(Impostor {
        frames,
        centre: [number(x)?, number(y)?, number(z)?],
        radius_m: number(known.get("radius")?)?,
    })
}
