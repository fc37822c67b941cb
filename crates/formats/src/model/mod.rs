//! bytes <-> [`mesh::Model`].

mod axes;
mod columns;
mod exr;
mod glb_levels;
mod glb_nodes;
mod glb_pack;
mod glb_read;
mod glb_write;
mod gltf;
mod gltf_bytes;
mod gltf_look;
mod gltf_text;
mod meshopt;
mod meshopt_filter;
mod named;
mod obj_read;
mod obj_write;
mod picture;
pub(crate) mod ply_read;
mod ply_write;
mod stl;
mod usd_assembly;
mod usd_write;
mod usdz;

use std::io::{Read, Write};
use std::sync::Arc;

use base::Report;
use glam::DVec3;
use mesh::{MaterialKind, Model};

pub use axes::ExportSpec;
pub(crate) use columns::{CompressedColumn, compressed_floats, compressed_turns};
pub use exr::{half_bits, write_exr};
pub use glb_levels::write_glb_levels;
pub use glb_nodes::{NamedNodes, write_glb_nodes};
pub use glb_pack::{Packing, write_glb_joined, write_glb_packed};
pub(crate) use glb_write::write_container;
pub use glb_write::{
    Level, Morph, write_glb, write_glb_morph, write_glb_rigged, write_glb_scene, write_glb_with,
};
pub(crate) use gltf_text::encoded;
pub use named::decode_uri;
pub use obj_write::{FileStems, ObjFiles, obj_files};
pub use picture::{PngCache, read_picture, write_png};
pub use ply_write::write_ply;
pub use stl::write_stl;
pub use usd_assembly::{Assembly, AssemblyJoint, BoundCopies, WindGroup, assembly_files};
pub(crate) use usd_write::{Identifiers, Quoted, identifier};
pub use usd_write::{UsdFiles, usd_files};

use crate::error::{FileFault, ModelError, Place, WriteError};
use crate::foreign::Foreign;
use crate::{Beside, ModelFormat, Room};

/// Largest model file that is read: 1 GiB.
pub const MAX_MODEL_BYTES: u64 = 1 << 30;
/// Most vertices or triangles of a model that is read.
pub(crate) const MAX_ROWS: usize = 32 << 20;

/// A file to which a model refers: a buffer, a material file, a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SideFile<'a> {
    /// Its path as written, with the separators of any system.
    pub name: &'a str,
    /// The material file that names it, by the path that the model has for it: paths are relative to the file that
    /// names them. None: the model itself names it.
    pub by: Option<&'a str>,
}

/// Reason why a resolver does not return a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoFile {
    /// There is none: the model is read without it, where that is possible.
    Missing,
    /// The file must not be read, and neither is the model: the reason, what names the file, and what to do.
    Refused(String),
}

/// Finds a file to which a model refers. The caller decides where it may lie, as a model may come from anybody.
pub type Resolver<'a> = &'a dyn Fn(SideFile<'_>) -> Result<Vec<u8>, NoFile>;

/// A resolver that finds nothing.
///
/// # Errors
/// Always [`NoFile::Missing`].
pub fn no_files(_: SideFile<'_>) -> Result<Vec<u8>, NoFile> {
    Err(NoFile::Missing)
}

/// Reads a model.
///
/// `spec` gives the unit and up axis of the file if the format does not (OBJ, PLY, STL); the model comes back in
/// metres, +Y up. `resolve` finds the files to which an OBJ or a glTF refers; each is requested once. Missing normals
/// are computed. Guaranteed: `model.validate()` finds nothing but degenerate triangles. The `report` lists what was
/// left out.
///
/// # Errors
/// [`ModelError`] with the place in the file and what to do.
pub fn read_model(
    input: impl Read,
    format: ModelFormat,
    name: &str,
    spec: &ExportSpec,
    resolve: Resolver<'_>,
    report: &mut Report,
) -> Result<Model, ModelError> {
    let file = |fault| ModelError::new(format, Place::File, fault);
    let mut bytes = Vec::new();
    input.take(MAX_MODEL_BYTES + 1).read_to_end(&mut bytes).map_err(|e| file(FileFault::Io(e)))?;
    if bytes.len() as u64 > MAX_MODEL_BYTES {
        return Err(file(FileFault::TooMuch {
            what: "the size in bytes",
            limit: MAX_MODEL_BYTES,
            advice: "split the model into several files",
        }));
    }
    if bytes.is_empty() {
        return Err(file(FileFault::Empty));
    }
    FileFault::if_foreign(Foreign::sniff_no_drawing(&bytes)).map_err(file)?;
    let mut model = match format {
        ModelFormat::Glb | ModelFormat::Gltf => {
            warn_of_axes(format, spec, report);
            return glb_read::read(&bytes, format, name, resolve, report);
        }
        ModelFormat::Obj => obj_read::read(&bytes, name, resolve, report)?,
        ModelFormat::Ply => ply_read::read(&bytes, name, report)?,
        ModelFormat::Stl => stl::read(&bytes, name, report)?,
        ModelFormat::Usda | ModelFormat::Usdz => {
            return Err(file(FileFault::unsupported(
                "reading USD",
                "USD is written only; open it in a program for scenes, or use the .glb of the same model",
            )));
        }
    };
    spec.import(&mut model);
    for part in &mut model.parts {
        if part.mesh.normals.len() != part.mesh.positions.len() {
            part.mesh.compute_normals();
        }
    }
    Ok(model)
}

/// Writes a model to one stream, without the companion files that some formats have
/// ([`FormatRow::beside`](crate::FormatRow)): see [`model_files`]. Wind is left out, with a warning, if the format
/// has no room for it.
///
/// # Errors
/// [`WriteError`] of the sink or for a model that is not sound.
pub fn write_model(
    model: &Model,
    format: ModelFormat,
    spec: &ExportSpec,
    mut out: impl Write,
    report: &mut Report,
) -> Result<(), WriteError> {
    match format {
        ModelFormat::Glb => {
            warn_of_axes(format, spec, report);
            write_glb(model, out)
        }
        ModelFormat::Ply => {
            warn_of_wind(model, format.name(), report);
            write_ply(model, spec, out)
        }
        ModelFormat::Stl => {
            warn_of_wind(model, format.name(), report);
            write_stl(model, spec, out)
        }
        ModelFormat::Usdz => usdz::write_usdz(&usd_files(model, "model", spec)?, "model", out),
        ModelFormat::Obj | ModelFormat::Gltf | ModelFormat::Usda => {
            let files = model_files(model, format, "model", spec, &mut PngCache::new(), report)?;
            Ok(out.write_all(&files.own)?)
        }
    }
}

/// A model's file and the companion files that it names: keep the names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ModelFiles {
    /// Bytes of the model's own file.
    pub own: Vec<u8>,
    /// The companion files.
    pub beside: Vec<BesideFile>,
}

/// A companion file that a model's own file names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BesideFile {
    /// Its content.
    pub what: Beside,
    /// Its name, without a folder.
    pub name: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

impl ModelFiles {
    fn new(own: Vec<u8>, textures: Vec<(String, Vec<u8>)>) -> Self {
        let file = |(name, bytes)| BesideFile { what: Beside::Textures, name, bytes };
        Self { own, beside: textures.into_iter().map(file).collect() }
    }

    /// Returns all files with their names, first the model's own, `name`.
    pub fn named(self, name: String) -> Vec<(String, Vec<u8>)> {
        let beside = self.beside.into_iter().map(|file| (file.name, file.bytes));
        std::iter::once((name, self.own)).chain(beside).collect()
    }
}

/// Writes a model with its companion files, which are named after `stems`. Wind is left out, with a warning, if the
/// format has no room for it. `cache`: encoded textures, kept for the next time.
///
/// # Errors
/// [`WriteError`] for a model that is not sound.
///
/// ```
/// use formats::{Beside, ModelFormat, PngCache, model_files};
/// let (model, mut report) = (mesh::Model::default(), base::Report::default());
/// let spec = formats::ExportSpec::default();
/// let files = model_files(&model, ModelFormat::Obj, "oak", &spec, &mut PngCache::new(), &mut report)?;
/// assert_eq!((files.beside[0].what, &files.beside[0].name[..]), (Beside::Materials, "oak.mtl"));
/// # Ok::<(), formats::WriteError>(())
/// ```
pub fn model_files<'a>(
    model: &Model,
    format: ModelFormat,
    stems: impl Into<FileStems<'a>>,
    spec: &ExportSpec,
    cache: &mut PngCache,
    report: &mut Report,
) -> Result<ModelFiles, WriteError> {
    let stems = stems.into();
    match format {
        ModelFormat::Obj => {
            warn_of_wind(model, format.name(), report);
            let ObjFiles { obj, mtl, mtl_name, textures } = obj_files(model, stems, spec)?;
            let mut files = ModelFiles::new(obj, textures);
            files.beside.insert(0, BesideFile { what: Beside::Materials, name: mtl_name, bytes: mtl });
            Ok(files)
        }
        ModelFormat::Usda => {
            let UsdFiles { usda, textures } = usd_files(model, stems.textures, spec)?;
            Ok(ModelFiles::new(usda, textures))
        }
        ModelFormat::Glb | ModelFormat::Gltf => {
            warn_of_axes(format, spec, report);
            let mut glb = Vec::new();
            write_glb_with(model, cache, &mut glb)?;
            gltf_files(glb, format, stems)
        }
        ModelFormat::Ply | ModelFormat::Stl | ModelFormat::Usdz => {
            let mut own = Vec::new();
            write_model(model, format, spec, &mut own, report)?;
            Ok(ModelFiles::new(own, Vec::new()))
        }
    }
}

/// Returns the files of a binary glTF in `format`, which must have room for the same contents ([`Room::Packing`] and
/// the like).
///
/// # Errors
/// [`WriteError::ReadOnly`] for other formats.
pub fn gltf_files<'a>(
    glb: Vec<u8>,
    format: ModelFormat,
    stems: impl Into<FileStems<'a>>,
) -> Result<ModelFiles, WriteError> {
    match format {
        ModelFormat::Glb => Ok(ModelFiles::new(glb, Vec::new())),
        ModelFormat::Gltf => gltf_text::text_files(&glb, stems.into()),
        _ => Err(WriteError::ReadOnly { format: format.name(), instead: ".glb" }),
    }
}

/// Returns the companion files of a model whose names are known before there is a model; textures are named after
/// materials.
pub fn names_beside(format: ModelFormat, stem: &str) -> Vec<(Beside, String)> {
    let named = |what: &Beside| Some((*what, format!("{}.{}", file_name(stem, "model"), what.ending()?)));
    format.row().beside.iter().filter_map(named).collect()
}

/// Warns if a format fixes its axes and unit and `spec` asks for others.
fn warn_of_axes(format: ModelFormat, spec: &ExportSpec, report: &mut Report) {
    if !format.holds(Room::Axes) && !spec.is_default() {
        report.warn(
            "gltf-fixed-units",
            "glTF is always in metres with +Y up: the unit and up axis asked for were not used",
        );
    }
}

/// Warns if a model has wind and the format has no room for it.
pub fn warn_of_wind(model: &Model, format: &str, report: &mut Report) {
    if model.parts.iter().any(|p| !p.mesh.wind.is_empty()) {
        base::warn!(
            report,
            "wind-left-out",
            { format = format },
            "{format} has no room for wind: it was left out; .glb and .usda have"
        );
    }
}

/// Most bytes of a name: they leave room for a material's name and an extension in the 255 that file systems allow.
const MOST_STEM_BYTES: usize = 208;

/// Returns a name that every file system accepts, and that a file can hold without quotes: letters, digits, signs and
/// marks of any language with `-`, `_` and `.`; all else becomes `-`, and characters that are invisible or change the
/// direction of writing are left out. At most 100 characters and 208 bytes; `otherwise` if nothing is left.
///
/// Not guaranteed: Unicode's normal form, and that no system reserves the name for a device.
///
/// ```
/// assert_eq!(formats::file_name("a rose/../花 🌹", "model"), "a-rose-..-花-🌹");
/// ```
pub fn file_name(name: &str, otherwise: &str) -> String {
    let keep = |c: char| if usual(c) { c } else { '-' };
    let mut out = String::new();
    for c in name.chars().filter(|&c| !unseen(c)).map(keep).take(100) {
        if out.len() + c.len_utf8() > MOST_STEM_BYTES {
            break;
        }
        out.push(c);
    }
    let name = out.trim_matches('.');
    if name.is_empty() { otherwise.to_owned() } else { name.to_owned() }
}

fn usual(c: char) -> bool {
    if c.is_ascii() {
        return c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    }
    // Neither the replacement character nor code points that are not characters.
    !c.is_control() && !c.is_whitespace() && c != char::REPLACEMENT_CHARACTER && (c as u32 & 0xfffe) != 0xfffe
}

/// Returns whether a character is a `Default_Ignorable_Code_Point` of Unicode: signs of direction, joiners, variation
/// selectors. Some file systems ignore them.
fn unseen(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}'..='\u{1160}' | '\u{17b4}'..='\u{17b5}'
        | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}'
        | '\u{3164}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fff8}'
        | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}')
}

/// Refuses models that no file should hold. Degenerate triangles may pass.
pub(crate) fn check(model: &Model) -> Result<(), WriteError> {
    for part in &model.parts {
        let fail = |fault| Err(WriteError::Model { part: part.name.clone(), fault });
        if part.material.index() >= model.materials.len() {
            return fail(mesh::MeshFault::Material(part.material.index()));
        }
        // Writers repair invalid normals.
        let bad = part.mesh.validate();
        let mut bad =
            bad.filter(|f| !matches!(f, mesh::MeshFault::Degenerate(_) | mesh::MeshFault::Normal(_)));
        if let Some(fault) = bad.next() {
            return fail(fault);
        }
    }
    Ok(())
}

/// Clamps to 0 to 1, as materials demand; NaN becomes 0.
pub(crate) fn share(x: f32) -> f32 {
    if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) }
}

/// Texture files next to a model, `STEM-MATERIAL.png`, each once; where they are to be light, `.jpg` if they have no holes.
pub(crate) struct TextureFiles<'a> {
    stem: &'a str,
    /// Name and bytes.
    files: Vec<(String, Vec<u8>)>,
    /// The texture of each file.
    written: Vec<Arc<mesh::Texture>>,
    cache: PngCache,
    is_light: bool,
}

impl<'a> TextureFiles<'a> {
    pub(crate) fn new(stem: &'a str) -> Self {
        Self { stem, files: Vec::new(), written: Vec::new(), cache: PngCache::new(), is_light: false }
    }

    /// Makes those of a light file, for programs that read JPEG.
    pub(crate) fn light(stem: &'a str) -> Self {
        Self { is_light: true, ..Self::new(stem) }
    }

    /// Returns the name of the file that holds a texture; `material` is the first that uses it.
    pub(crate) fn name(
        &mut self,
        texture: &Arc<mesh::Texture>,
        material: &str,
    ) -> Result<String, WriteError> {
        let known = self.written.iter().position(|t| Arc::ptr_eq(t, texture) || t == texture);
        if let Some(known) = known {
            return Ok(self.files[known].0.clone());
        }
        let jpeg = if self.is_light { glb_pack::jpeg(texture)? } else { None };
        let ending = if jpeg.is_some() { "jpg" } else { "png" };
        let mut name = format!("{}-{}.{ending}", self.stem, file_name(material, "texture"));
        // On some disks, two names that differ only in case are the same file.
        while self.files.iter().any(|(n, _)| n.to_lowercase() == name.to_lowercase()) {
            name.insert_str(name.len() - 4, "-2");
        }
        let bytes = match jpeg {
            Some((bytes, _)) => bytes,
            None => self.cache.png(texture)?,
        };
        self.files.push((name.clone(), bytes.to_vec()));
        self.written.push(Arc::clone(texture));
        Ok(name)
    }

    pub(crate) fn into_files(self) -> Vec<(String, Vec<u8>)> {
        self.files
    }
}

/// Returns a unit normal in any case: glTF's validator and lighting demand it.
pub(crate) fn unit(n: [f32; 3]) -> [f32; 3] {
    // In f64, because the squares of 1e-23 and of 1e20 are beyond f32.
    let wide = DVec3::from(n.map(f64::from));
    let length = wide.length();
    if (length - 1.0).abs() < 1e-4 {
        n
    } else if length > 0.0 && length.is_finite() {
        (wide / length).as_vec3().to_array()
    } else {
        [0.0, 1.0, 0.0]
    }
}

/// Makes names distinct: a repeated one gets `-2`, `-3`, ...
#[derive(Debug, Default)]
pub(crate) struct Names(std::collections::BTreeMap<String, usize>);

impl Names {
    pub(crate) fn fresh(&mut self, wanted: &str, otherwise: &str) -> String {
        let wanted = if wanted.trim().is_empty() { otherwise } else { wanted };
        let mut name = wanted.to_owned();
        while self.0.contains_key(&name) {
            let count = self.0.entry(wanted.to_owned()).or_insert(1);
            *count += 1;
            name = format!("{wanted}-{count}");
        }
        self.0.insert(name.clone(), 1);
        name
    }
}

/// Returns the kind that a word or a name such as `leaf-2` stands for.
pub(crate) fn kind_of(name: &str) -> MaterialKind {
    use MaterialKind::{Bark, Disc, Fruit, Leaf, Other, Petal, Root, Stamen, Stem, YoungBark};
    let lower = name.to_ascii_lowercase();
    let begins = |kind: &MaterialKind| {
        let rest = lower.strip_prefix(kind.word());
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_alphabetic()))
    };
    // The longer word comes first.
    [YoungBark, Bark, Stem, Leaf, Petal, Disc, Fruit, Root, Stamen].into_iter().find(begins).unwrap_or(Other)
}
