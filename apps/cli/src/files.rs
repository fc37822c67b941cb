//! Files by their extension or, failing that, by their first bytes.

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read};
use std::path::{Component, Path};

use burgeon::document::{self, Document, DocumentPlant, MAX_PROJECT_BYTES};
use burgeon::formats::{
    CloudFormat, DrawingFormat, ExportSpec, ModelFormat, PngCache, ReadDrawing, obj_files, usd_files,
    warn_of_wind, write_glb_with, write_mtg,
};
use burgeon::mesh::{Model, PointCloud};
use burgeon::plant::Plant;
use burgeon::{Report, Warning};

use crate::args::{AxesArgs, UnitWord, UpWord};
use crate::failure::{Failure, Outcome};
use crate::output;

/// What a file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Drawing(DrawingFormat),
    Model(ModelFormat),
    /// A `.burgeon` file.
    Project,
}

pub(crate) fn extension(path: &Path) -> Option<&str> {
    path.extension().and_then(|e| e.to_str())
}

/// Bytes of a file, a pipe or standard input.
pub(crate) type Input = Box<dyn BufRead + Send>;

/// `-` stands for standard input.
pub(crate) fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The file's name without extension, for names of drawings and models.
pub(crate) fn stem(path: &Path) -> String {
    if is_stdin(path) {
        return "drawing".into();
    }
    path.file_stem().map_or_else(|| "drawing".into(), |s| s.to_string_lossy().into_owned())
}

/// Opens a file and finds out what it holds. Read once and never sought in: pipes are as good as files.
pub(crate) fn open(path: &Path) -> Outcome<(Input, Kind)> {
    let failed = |e: &std::io::Error| Failure::io(path, "read", e);
    let mut input: Box<dyn Read + Send> = if is_stdin(path) {
        Box::new(std::io::stdin())
    } else if path.is_dir() {
        return Err(Failure::at(path, "is a folder; name the files in it"));
    } else {
        Box::new(File::open(path).map_err(|e| failed(&e))?)
    };
    let known = extension(path).and_then(|e| {
        let drawing = DrawingFormat::from_extension(e).map(Kind::Drawing);
        let project = e.eq_ignore_ascii_case("burgeon").then_some(Kind::Project);
        drawing.or_else(|| ModelFormat::from_extension(e).map(Kind::Model)).or(project)
    });
    if let Some(kind) = known {
        return Ok((Box::new(BufReader::new(input)), kind));
    }
    let mut start = Vec::new();
    input.by_ref().take(4096).read_to_end(&mut start).map_err(|e| failed(&e))?;
    if start.is_empty() {
        return Err(Failure::at(path, "is empty; was it saved completely?"));
    }
    let drawing = DrawingFormat::sniff(&start).map(Kind::Drawing);
    let project = document::is_project(&start).then_some(Kind::Project);
    let kind = drawing.or_else(|| ModelFormat::sniff(&start).map(Kind::Model)).or(project).ok_or_else(|| {
        Failure::at(
            path,
            "is neither a drawing (.svg, .inkml, .ndjson, .json), nor a project (.burgeon), nor a model (.glb, .gltf, \
             .obj, .ply, .stl); give the file the extension of its format",
        )
    })?;
    Ok((Box::new(BufReader::new(Cursor::new(start).chain(input))), kind))
}

/// A PLY whose header announces faces, or an OBJ with an `f` line.
pub(crate) fn has_faces(path: &Path) -> bool {
    let Ok(mut file) = File::open(path) else { return false };
    let extension = extension(path).unwrap_or_default().to_ascii_lowercase();
    let mut start = Vec::new();
    let limit = if extension == "obj" { 64 << 20 } else { 8192 };
    if file.by_ref().take(limit).read_to_end(&mut start).is_err() {
        return false;
    }
    match extension.as_str() {
        "ply" => {
            let head = String::from_utf8_lossy(&start);
            let head = head.split("end_header").next().unwrap_or_default();
            head.lines().any(|l| l.starts_with("element face") && !l.trim_end().ends_with(" 0"))
        }
        "obj" => start.windows(3).any(|w| w == b"\nf "),
        _ => false,
    }
}

/// Reads a scan.
pub(crate) fn read_cloud(
    path: &Path,
    format: CloudFormat,
    axes: &ExportSpec,
    report: &mut Report,
) -> Outcome<PointCloud> {
    let file = File::open(path).map_err(|e| Failure::io(path, "read", &e))?;
    burgeon::formats::read_cloud(file, format, axes, report).map_err(|e| Failure::at(path, e))
}

/// The text of a small file, such as settings: at most 16 MiB.
pub(crate) fn read_text(path: &Path) -> Outcome<String> {
    const MAX_BYTES: u64 = 16 << 20;
    let failed = |e: &std::io::Error| Failure::io(path, "read", e);
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(|e| failed(&e))?;
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(|e| failed(&e))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Failure::at(
            path,
            "is larger than 16 MiB, too large for such a file; is it the right one?",
        ));
    }
    String::from_utf8(bytes).map_err(|e| {
        let after = e.utf8_error().valid_up_to();
        Failure::at(path, format_args!("after {after} bytes the text is not UTF-8; save it again as UTF-8"))
    })
}

/// Reads a project.
pub(crate) fn read_project(path: &Path, input: Input) -> Outcome<Document> {
    let mut bytes = Vec::new();
    let bounded = input.take(MAX_PROJECT_BYTES as u64 + 1).read_to_end(&mut bytes);
    bounded.map_err(|e| Failure::io(path, "read", &e))?;
    document::read_project(&bytes).map_err(|e| Failure::at(path, e))
}

/// The one drawing of a project, as if it had been read from a file of strokes, and its plant.
pub(crate) fn drawing_of<'a>(
    path: &Path,
    document: &'a Document,
) -> Outcome<(ReadDrawing, &'a DocumentPlant)> {
    let [plant] = document.plants() else {
        let line = format!(
            "is a scene of {} plants, not one drawing; `burgeon sketch` makes all of them",
            document.plants().len()
        );
        return Err(Failure::at(path, line));
    };
    if plant.settings().sketch().is_none() {
        let line =
            format!("holds a {}, not a drawing; `burgeon sketch` makes it", plant.settings().maker.word());
        return Err(Failure::at(path, line));
    }
    if plant.strokes().is_empty() {
        return Err(Failure::at(path, "holds no stroke; open it in the Studio and draw"));
    }
    Ok((ReadDrawing { drawing: plant.drawing(), warnings: Vec::new() }, plant))
}

/// Axes of models: +Y up if nothing was asked for.
pub(crate) fn axes(up: impl Into<Option<UpWord>>, unit: UnitWord) -> ExportSpec {
    ExportSpec { up: up.into().unwrap_or(UpWord::Y).into(), unit: unit.into() }
}

/// Reads a model, with what its reader has to say.
pub(crate) fn read_model(path: &Path, axes: &ExportSpec) -> Outcome<(Model, ModelFormat, Vec<Warning>)> {
    let (input, kind) = open(path)?;
    read_opened_model(path, input, kind, axes)
}

/// [`read_model`] of a file that is open already.
pub(crate) fn read_opened_model(
    path: &Path,
    input: Input,
    kind: Kind,
    axes: &ExportSpec,
) -> Outcome<(Model, ModelFormat, Vec<Warning>)> {
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
        Kind::Project => {
            return Err(Failure::at(path, "is a project, not a model; `burgeon sketch` makes a model of it"));
        }
    };
    let mut report = Report::default();
    let beside = |name: &str| resolve(path, name);
    let model = burgeon::formats::read_model(input, format, &stem(path), axes, &beside, &mut report);
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
    // Asked before it is opened: opening a pipe waits for its writer.
    if !std::fs::metadata(&path).is_ok_and(|m| m.is_file() && m.len() <= MAX_SIDE_FILE) {
        return None;
    }
    let file = File::open(path).ok()?;
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
            "models are written as .glb, .obj, .ply, .stl or .usda; end the name with one of them",
        )),
    }
}

/// What a plant is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlantFormat {
    /// Its meshes.
    Model(ModelFormat),
    /// Its structure, as a multiscale tree graph.
    Mtg,
}

impl PlantFormat {
    pub(crate) fn from_extension(extension: &str) -> Option<Self> {
        if extension.eq_ignore_ascii_case("mtg") {
            return Some(Self::Mtg);
        }
        ModelFormat::from_extension(extension).map(Self::Model)
    }
}

/// The format of a plant's file name, if we write it.
pub(crate) fn plant_writable(path: &Path) -> Outcome<PlantFormat> {
    match extension(path).and_then(PlantFormat::from_extension) {
        Some(PlantFormat::Mtg) => Ok(PlantFormat::Mtg),
        Some(PlantFormat::Model(_)) => writable(path).map(PlantFormat::Model),
        None => Err(Failure::at(
            path,
            "plants are written as .glb, .obj, .ply, .stl, .usda or .mtg; end the name with one of them",
        )),
    }
}

/// Writes a plant whole: its model, or its structure with +Z up unless `up` says otherwise.
pub(crate) fn write_plant(
    path: &Path,
    (plant, model): (&Plant, &Model),
    format: PlantFormat,
    args: &AxesArgs,
    cache: &mut PngCache,
) -> Outcome<Vec<Warning>> {
    match format {
        PlantFormat::Model(format) => write_model(path, model, format, &axes(args.up, args.unit), cache),
        PlantFormat::Mtg => {
            let axes = field_axes(args);
            output::write_whole(path, |out| write_mtg(plant, &axes, out))?;
            let mut report = Report::default();
            warn_of_wind(model, "MTG", &mut report);
            Ok(report.warnings)
        }
    }
}

/// Writes a plant's cylinders whole, with +Z up unless `args` say otherwise.
pub(crate) fn write_qsm(path: &Path, plant: &Plant, args: &AxesArgs) -> Outcome {
    let axes = field_axes(args);
    output::write_whole(path, |out| burgeon::formats::write_qsm(plant, &axes, out))
}

// The programs that read MTG and QSM files have Z upwards.
fn field_axes(args: &AxesArgs) -> ExportSpec {
    axes(args.up.unwrap_or(UpWord::Z), args.unit)
}

/// Writes a model whole: for OBJ and USD first the files that they name.
pub(crate) fn write_model(
    path: &Path,
    model: &Model,
    format: ModelFormat,
    axes: &ExportSpec,
    cache: &mut PngCache,
) -> Outcome<Vec<Warning>> {
    let mut report = Report::default();
    let bytes = |path: &Path, bytes: &[u8]| output::write_whole(path, |out| Ok(out.write_all(bytes)?));
    match format {
        ModelFormat::Glb if axes.is_default() => {
            output::write_whole(path, |out| write_glb_with(model, cache, out))?;
        }
        ModelFormat::Obj => {
            let files = obj_files(model, &stem(path), axes).map_err(|e| output::write_failed(path, e))?;
            warn_of_wind(model, format.word(), &mut report);
            for (name, png) in &files.textures {
                bytes(&path.with_file_name(name), png)?;
            }
            bytes(&path.with_file_name(&files.mtl_name), &files.mtl)?;
            bytes(path, &files.obj)?;
        }
        ModelFormat::Usda => {
            let files = usd_files(model, &stem(path), axes).map_err(|e| output::write_failed(path, e))?;
            for (name, png) in &files.textures {
                bytes(&path.with_file_name(name), png)?;
            }
            bytes(path, &files.usda)?;
        }
        _ => output::write_whole(path, |out| {
            burgeon::formats::write_model(model, format, axes, out, &mut report)
        })?,
    }
    Ok(report.warnings)
}
