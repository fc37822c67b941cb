//! Model -> Wavefront OBJ, its material file and its textures.

use std::io::Write as _;

use mesh::{AlphaMode, Model};

use super::picture::srgb;
use super::{ExportSpec, TextureFiles, check, file_name, unit};
use crate::error::WriteError;

/// The files that make up an OBJ. The OBJ names its material file, which names its textures: keep the names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ObjFiles {
    /// `STEM.obj`.
    pub obj: Vec<u8>,
    /// `STEM.mtl`.
    pub mtl: Vec<u8>,
    /// The name by which the OBJ refers to its material file: the stem with every character replaced that OBJ cannot
    /// hold.
    pub mtl_name: String,
    /// Name and bytes of each texture, `STEM-MATERIAL.png`.
    pub textures: Vec<(String, Vec<u8>)>,
}

/// Names of the files of one model, without folder and extension. A `&str` converts to the same name for all.
#[derive(Clone, Copy, Debug)]
pub struct FileStems<'a> {
    /// The OBJ and its material file.
    pub model: &'a str,
    /// Prefix of textures, before `-MATERIAL.png`.
    pub textures: &'a str,
}

impl<'a> From<&'a str> for FileStems<'a> {
    fn from(stem: &'a str) -> Self {
        Self { model: stem, textures: stem }
    }
}

/// Writes a model as OBJ, MTL and PNG files of these names.
///
/// Guaranteed: names, positions, normals, texture coordinates, materials and colours come back when read here; other
/// programs do not see kind, translucency and sidedness, which OBJ cannot express.
///
/// # Errors
/// [`WriteError`] for a model that is not sound.
///
/// ```
/// let files = formats::obj_files(&mesh::Model::default(), "oak", &formats::ExportSpec::default())?;
/// assert!(files.obj.starts_with(b"# Burgeon"));
/// # Ok::<(), formats::WriteError>(())
/// ```
pub fn obj_files<'a>(
    model: &Model,
    stems: impl Into<FileStems<'a>>,
    spec: &ExportSpec,
) -> Result<ObjFiles, WriteError> {
    check(model)?;
    let stems = stems.into();
    let [stem, textures] = [stems.model, stems.textures].map(|s| file_name(s, "model"));
    let mut obj = Vec::with_capacity(64 + 100 * model.vertex_count() + 40 * model.triangle_count());
    writeln!(obj, "# Burgeon {}; {}, +{:?} up", env!("CARGO_PKG_VERSION"), spec.unit.plural(), spec.up)?;
    obj.extend_from_slice(spec.offset_line(model.offset_m, "#").as_bytes());
    writeln!(obj, "# model {}\nmtllib {stem}.mtl", one_line(&model.name))?;
    // OBJ counts all vertices of a file, from 1.
    let (mut v, mut vt, mut vn) = (1_usize, 1_usize, 1_usize);
    for part in model.parts.iter().filter(|p| !p.mesh.positions.is_empty()) {
        let mesh = &part.mesh;
        writeln!(obj, "o {}\nusemtl {}", one_line(&part.name), one_line(&model.material(part).name))?;
        for (i, &p) in mesh.positions.iter().enumerate() {
            let [x, y, z] = spec.point(p);
            write!(obj, "v {x} {y} {z}")?;
            if let Some(c) = mesh.colors.get(i) {
                let [r, g, b] = c.map(srgb);
                write!(obj, " {r} {g} {b}")?;
            }
            obj.push(b'\n');
        }
        for [u, v] in &mesh.uvs {
            // OBJ's v points up.
            writeln!(obj, "vt {u} {}", 1.0 - v)?;
        }
        for &n in &mesh.normals {
            let [x, y, z] = spec.direction(unit(n));
            writeln!(obj, "vn {x} {y} {z}")?;
        }
        for t in &mesh.triangles {
            obj.push(b'f');
            for i in t.map(|i| i as usize) {
                match (mesh.uvs.is_empty(), mesh.normals.is_empty()) {
                    (true, true) => write!(obj, " {}", v + i)?,
                    (false, true) => write!(obj, " {}/{}", v + i, vt + i)?,
                    (true, false) => write!(obj, " {}//{}", v + i, vn + i)?,
                    (false, false) => write!(obj, " {}/{}/{}", v + i, vt + i, vn + i)?,
                }
            }
            obj.push(b'\n');
        }
        v += mesh.positions.len();
        vt += mesh.uvs.len();
        vn += mesh.normals.len();
    }
    let mut textures = TextureFiles::new(&textures);
    let mtl = materials(model, &mut textures)?;
    let textures = textures.into_files();
    Ok(ObjFiles { obj, mtl, mtl_name: format!("{stem}.mtl"), textures })
}

fn materials(model: &Model, textures: &mut TextureFiles<'_>) -> Result<Vec<u8>, WriteError> {
    let mut mtl = Vec::new();
    for m in &model.materials {
        let [r, g, b] = m.base_color;
        let sides = if m.double_sided { " double-sided" } else { "" };
        writeln!(mtl, "newmtl {}", one_line(&m.name))?;
        // Properties without an MTL keyword, in a comment that our own reader understands.
        writeln!(mtl, "# burgeon kind={} translucency={}{sides}", m.kind.word(), m.translucency)?;
        writeln!(mtl, "Kd {r} {g} {b}\nKs 0 0 0\nPr {}\nPm 0\nd 1\nillum 1", m.roughness)?;
        if let Some(texture) = &m.texture {
            let name = textures.name(texture, &m.name)?;
            writeln!(mtl, "map_Kd {name}")?;
            if m.alpha == AlphaMode::Mask {
                writeln!(mtl, "map_d {name}")?;
            }
        }
        let maps = [
            ("norm", "normal", &m.maps.normal),
            ("map_Pr", "orm", &m.maps.orm),
            // Height as a share of the texture's width.
            ("bump -bm 0.03", "height", &m.maps.height),
        ];
        for (word, what, map) in maps {
            if let Some(map) = map {
                // In the texture of occlusion and roughness, the second channel is the roughness.
                let channel = if word == "map_Pr" { " -imfchan g" } else { "" };
                let name = textures.name(map, &format!("{}-{what}", m.name))?;
                writeln!(mtl, "{word}{channel} {name}")?;
            }
        }
        mtl.push(b'\n');
    }
    Ok(mtl)
}

/// Returns a name without line breaks.
fn one_line(name: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if name.trim().is_empty() { "unnamed".into() } else { name.trim().to_owned() }
}
