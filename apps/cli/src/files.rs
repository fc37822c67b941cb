//! Files by their extension or, failing that, by their first bytes.

use std::fs::File;
use std::io::{BufReader, Read as _, Seek as _};
use std::path::{Component, Path};

use burgeon::formats::{DrawingFormat, ExportSpec, ModelFormat, PngCache, obj_files, write_glb_with};
use burgeon::mesh::Model;
use burgeon::{Report, Warning};

use crate::failure::{Failure, Outcome};
use crate::output;

/// What a file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Drawing(DrawingFormat),
    Model(ModelFormat),
}

pub(crate) fn extension(path: &Path) -> Option<&str> {
    path.extension().and_then(|e| e.to_str())
}

/// The file's name without extension, for names of drawings and models.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "drawing".into(), |s| s.to_string_lossy().into_owned())
}

/// Opens a file and finds out what it holds.
pub(crate) fn open(path: &Path) -> Outcome<(BufReader<File>, Kind)> {
    let failed = |e: &std::io::Error| Failure::io(path, "read", e);
    if path.is_dir() {
        return Err(Failure::at(path, "is a folder; name the files in it"));
    }
    let mut file = File::open(path).map_err(|e| failed(&e))?;
    let known = extension(path).and_then(|e| {
        let drawing = DrawingFormat::from_extension(e).map(Kind::Drawing);
        drawing.or_else(|| ModelFormat::from_extension(e).map(Kind::Model))
    });
    let kind = match known {
        Some(kind) => kind,
        None => {
            let mut start = Vec::new();
            file.by_ref().take(4096).read_to_end(&mut start).map_err(|e| failed(&e))?;
            file.rewind().map_err(|e| failed(&e))?;
            let drawing = DrawingFormat::sniff(&start).map(Kind::Drawing);
            drawing.or_else(|| ModelFormat::sniff(&start).map(Kind::Model)).ok_or_else(|| {
                Failure::at(
                    path,
                    "is neither a drawing (.svg, .inkml, .ndjson, .json) nor a model (.glb, .gltf, .obj, .ply, \
                     .stl); give the file the extension of its format",
                )
            })?
        }
    };
    Ok((BufReader::new(file), kind))
}

pub(crate) fn axes(up: crate::args::UpWord, unit: crate::args::UnitWord) -> ExportSpec {
    ExportSpec { up: up.into(), unit: unit.into() }
}

/// Reads a model, with what its reader has to say.
pub(crate) fn read_model(path: &Path, axes: &ExportSpec) -> Outcome<(Model, ModelFormat, Vec<Warning>)> {
    let (file, kind) = open(path)?;
    let format = match kind {
        Kind::Model(format) => format,
        Kind::Drawing(format) => {
            return Err(Failure::at(
                path,
                format_args!(
                    "is a drawing ({}), not a model; `burgeon sketch` makes a model of it",
                    format.word()
                ),
            ));
        }
    };
    let mut report = Report::default();
    let beside = |name: &str| resolve(path, name);
    let model = burgeon::formats::read_model(file, format, &stem(path), axes, &beside, &mut report);
    Ok((model.map_err(|e| Failure::at(path, e))?, format, report.warnings))
}

/// Largest file that a model may refer to: 256 MiB.
const MAX_SIDE_FILE: u64 = 256 << 20;

// A material file or texture in the model's folder or below it: a file from elsewhere must not make us read
// other places.
fn resolve(model: &Path, name: &str) -> Option<Vec<u8>> {
    let name = name.replace('\\', "/");
    let relative = Path::new(&name);
    if !relative.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir)) {
        return None;
    }
    let path = model.parent().unwrap_or_else(|| Path::new("")).join(relative);
    let file = File::open(path).ok()?;
    if !file.metadata().ok().is_some_and(|m| m.is_file() && m.len() <= MAX_SIDE_FILE) {
        return None;
    }
    let mut bytes = Vec::new();
    file.take(MAX_SIDE_FILE).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

/// The format of a model's file name, if we write it.
pub(crate) fn writable(path: &Path) -> Outcome<ModelFormat> {
    match extension(path).and_then(ModelFormat::from_extension) {
        Some(ModelFormat::Gltf) => {
            Err(Failure::at(path, "glTF is written as binary; end the name with .glb"))
        }
        Some(format) => Ok(format),
        None => Err(Failure::at(
            path,
            "models are written as .glb, .obj, .ply or .stl; end the name with one of them",
        )),
    }
}

/// Writes a model whole: for an OBJ first its textures and its material file.
pub(crate) fn write_model(
    path: &Path,
    model: &Model,
    format: ModelFormat,
    axes: &ExportSpec,
    cache: &mut PngCache,
) -> Outcome<Vec<Warning>> {
    let mut report = Report::default();
    match format {
        ModelFormat::Glb if axes.is_default() => {
            output::write_whole(path, |out| write_glb_with(model, cache, out))?;
        }
        ModelFormat::Obj => {
            let files = obj_files(model, &stem(path), axes).map_err(|e| output::write_failed(path, e))?;
            let bytes =
                |path: &Path, bytes: &[u8]| output::write_whole(path, |out| Ok(out.write_all(bytes)?));
            for (name, png) in &files.textures {
                bytes(&path.with_file_name(name), png)?;
            }
            bytes(&path.with_extension("mtl"), &files.mtl)?;
            bytes(path, &files.obj)?;
        }
        _ => output::write_whole(path, |out| {
            burgeon::formats::write_model(model, format, axes, out, &mut report)
        })?,
    }
    Ok(report.warnings)
}
