//! Files by their extension or, failing that, by their first bytes.

use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Cursor, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use burgeon::document::{self, Document, DocumentPlant, MAX_PROJECT_BYTES};
use burgeon::formats::{
    Beside, BesideFile, CloudFacts, CloudFormat, DrawingFormat, ExportSpec, FileFault, FileStems, Foreign,
    MAX_MODEL_BYTES, ModelFiles, ModelFormat, NoFile, Packing, PngCache, ReadDrawing, RobotFormat, Room,
    SideFile, StructureFormat, WriteError, decode_uri, gltf_files, model_files, names_beside, warn_of_wind,
    write_glb_packed, write_glb_with,
};
use burgeon::mesh::{Model, PointCloud};
use burgeon::plant::Plant;
use burgeon::{
    DrawnLine, ItemReport, Report, RobotError, RobotReport, Run, Spec, Unit, UpAxis, Warning, plainly,
};
use companions::{LIMITS, Named, NamedFault};
use serde::Deserialize;

use crate::args::{AxesArgs, PlantFormat, structure_endings};
use crate::failure::{Failure, Outcome, line_of};
use crate::inputs;
use crate::output::{self, Outputs};
use crate::signals::Stoppable;

/// Content of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Drawing(DrawingFormat),
    Model(ModelFormat),
    /// The structure of plants.
    Structure(StructureFormat),
    /// A `.burgeon` file.
    Project,
}

pub(crate) fn extension(path: &Path) -> Option<&str> {
    path.extension().and_then(|e| e.to_str())
}

/// Bytes of a file, a pipe or standard input.
pub(crate) type Input = Box<dyn BufRead + Send>;

/// Returns the file's name without extension, for names of drawings and models.
pub(crate) fn stem(path: &Path) -> String {
    if inputs::is_stdin(path) {
        return "drawing".into();
    }
    path.file_stem().map_or_else(|| "drawing".into(), |s| s.to_string_lossy().into_owned())
}

/// Opens a file and finds its kind of content. The file is read once without seeking, so pipes work, too.
pub(crate) fn open(path: &Path) -> Outcome<(Input, Kind)> {
    let known = extension(path).and_then(|e| {
        let drawing = DrawingFormat::from_extension(e).map(Kind::Drawing);
        let project = e.eq_ignore_ascii_case("burgeon").then_some(Kind::Project);
        let structure = StructureFormat::from_extension(e).map(Kind::Structure);
        drawing.or_else(|| ModelFormat::from_extension(e).map(Kind::Model)).or(structure).or(project)
    });
    if let Some(kind) = known {
        return Ok((open_bytes(path)?, kind));
    }
    let (input, start) = peek(path)?;
    let kind = kind_of(path, &start)?;
    Ok((input, kind))
}

/// Returns the kind of a file whose name does not give it, or an error that says what it may be instead.
pub(crate) fn kind_of(path: &Path, start: &[u8]) -> Outcome<Kind> {
    sniff(start).ok_or_else(|| {
        if let Some(foreign) = Foreign::sniff(start) {
            return Failure::bad_file(path, foreign);
        }
        let (drawings, models) = (DrawingFormat::read_endings(), ModelFormat::read_endings());
        Failure::bad_file(
            path,
            format_args!(
                "is neither a drawing ({drawings}), nor a project (.burgeon), nor a model ({models}), nor the structure of a \
                 plant ({}); give the file the extension of its format",
                structure_endings()
            ),
        )
    })
}

/// Returns the kind that the first bytes indicate, if any.
pub(crate) fn sniff(start: &[u8]) -> Option<Kind> {
    let drawing = DrawingFormat::sniff(start).map(Kind::Drawing);
    // Other programs keep archives, too; a project that was packed anew is known by its name.
    let project = (Foreign::sniff(start) == Some(Foreign::Project)).then_some(Kind::Project);
    let structure = || StructureFormat::sniff(start).map(Kind::Structure);
    drawing.or_else(|| ModelFormat::sniff(start).map(Kind::Model)).or_else(structure).or(project)
}

/// Returns the format of standard input that holds points alone. An OBJ may have its faces anywhere, so it counts as a
/// model.
pub(crate) fn sniff_points(start: &[u8]) -> Option<CloudFormat> {
    let format = CloudFormat::sniff(start)?;
    let points = match format {
        CloudFormat::Ply => !ply_has_faces(start),
        CloudFormat::Obj => false,
        _ => sniff(start).is_none(),
    };
    points.then_some(format)
}

/// Opens an existing file and returns its first bytes, which are still to be read.
pub(crate) fn peek(path: &Path) -> Outcome<(Input, Vec<u8>)> {
    let mut input = open_bytes(path)?;
    let mut start = Vec::new();
    let read = Read::by_ref(&mut input).take(4096).read_to_end(&mut start);
    read.map_err(|e| Failure::io(path, "read", &e))?;
    if start.is_empty() {
        return Err(Failure::bad_file(path, "is empty; was it saved completely?"));
    }
    Ok((Box::new(BufReader::new(Cursor::new(start.clone()).chain(input))), start))
}

/// Opens the bytes of a file, a pipe or standard input, whatever they are.
pub(crate) fn open_bytes(path: &Path) -> Outcome<Input> {
    static TAKEN: AtomicBool = AtomicBool::new(false);
    if inputs::is_stdin(path) {
        if TAKEN.swap(true, Ordering::Relaxed) {
            let line = "is asked for twice, but can be read only once; give one of the two as a file";
            return Err(Failure::bad_file(path, line));
        }
        return Ok(Box::new(BufReader::new(Stoppable(std::io::stdin()))));
    }
    if path.is_dir() {
        return Err(Failure::bad_file(path, "is a folder; name a file in it"));
    }
    let file = inputs::open(path).map_err(|e| Failure::io(path, "read", &e))?;
    Ok(Box::new(BufReader::new(Stoppable(file))))
}

/// Whether the header of a PLY announces faces, or an OBJ has an `f` line.
pub(crate) fn has_faces(path: &Path) -> bool {
    let Ok(mut file) = inputs::open(path) else { return false };
    let extension = extension(path).unwrap_or_default().to_ascii_lowercase();
    let mut start = Vec::new();
    let limit = if extension == "obj" { 64 << 20 } else { 8192 };
    if Read::by_ref(&mut file).take(limit).read_to_end(&mut start).is_err() {
        return false;
    }
    match extension.as_str() {
        "ply" => ply_has_faces(&start),
        "obj" => start.windows(3).any(|w| w == b"\nf "),
        _ => false,
    }
}

fn ply_has_faces(start: &[u8]) -> bool {
    let head = String::from_utf8_lossy(start);
    let head = head.split("end_header").next().unwrap_or_default();
    head.lines().any(|l| l.starts_with("element face") && !l.trim_end().ends_with(" 0"))
}

/// The format of a file that holds points alone, by its extension or, failing that, by its first bytes.
pub(crate) fn points_alone(path: &Path) -> Outcome<Option<CloudFormat>> {
    if inputs::is_stdin(path) || !path.is_file() {
        return Ok(None);
    }
    let extension = extension(path).unwrap_or_default();
    let format = CloudFormat::from_extension(extension);
    let is_known = DrawingFormat::from_extension(extension).is_some()
        || StructureFormat::from_extension(extension).is_some()
        || extension.eq_ignore_ascii_case("burgeon");
    // A table may be anything.
    let is_table = ["csv", "txt"].iter().any(|e| extension.eq_ignore_ascii_case(e));
    match format {
        Some(CloudFormat::Ply | CloudFormat::Obj) => Ok(format.filter(|_| !has_faces(path))),
        Some(_) if !is_table => Ok(format),
        None if is_known || ModelFormat::from_extension(extension).is_some() => Ok(None),
        _ => Ok(sniff_points(&peek(path)?.1)),
    }
}

/// Opens a scan: its format by its extension or, failing that, by its first bytes.
pub(crate) fn open_cloud(path: &Path) -> Outcome<(Input, CloudFormat)> {
    if let Some(format) = extension(path).and_then(CloudFormat::from_extension) {
        return Ok((open_bytes(path)?, format));
    }
    let (input, start) = peek(path)?;
    let found = CloudFormat::sniff(&start);
    if let Some(foreign) = Foreign::sniff_no_drawing(&start).filter(|_| found != Some(CloudFormat::E57)) {
        return Err(Failure::bad_file(path, foreign));
    }
    let format = found.ok_or_else(|| {
        let line = "is no scan that is read; end the name with .ply, .xyz, .txt, .pcd, .las, .e57 or .obj";
        Failure::bad_file(path, line)
    })?;
    Ok((input, format))
}

/// Reads a scan.
pub(crate) fn read_cloud(
    path: &Path,
    (input, format): (Input, CloudFormat),
    axes: &ExportSpec,
    report: &mut Report,
) -> Outcome<PointCloud> {
    read_cloud_with_facts(path, (input, format), axes, report).map(|(cloud, _)| cloud)
}

/// [`read_cloud`] with what the file says of itself.
pub(crate) fn read_cloud_with_facts(
    path: &Path,
    (input, format): (Input, CloudFormat),
    axes: &ExportSpec,
    report: &mut Report,
) -> Outcome<(PointCloud, CloudFacts)> {
    burgeon::formats::read_cloud_with_facts(input, format, axes, report)
        .map_err(|e| Failure::bad_file(path, e))
}

/// Reads the bytes of a file, at most `limit`.
pub(crate) fn read_bytes(path: &Path, limit: u64) -> Outcome<Vec<u8>> {
    bytes_of(path, open_bytes(path)?, limit)
}

fn bytes_of(path: &Path, input: Input, limit: u64) -> Outcome<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = input.take(limit + 1).read_to_end(&mut bytes);
    read.map_err(|e| Failure::io(path, "read", &e))?;
    if bytes.len() as u64 > limit {
        let line = format_args!(
            "is larger than {} MiB, too large for such a file; is it the right one?",
            limit >> 20
        );
        return Err(Failure::bad_file(path, line));
    }
    Ok(bytes)
}

/// Refuses the bytes of a file of another program, which is named.
pub(crate) fn refuse_foreign(path: &Path, bytes: &[u8]) -> Outcome {
    Foreign::sniff_no_drawing(bytes).map_or(Ok(()), |foreign| Err(Failure::bad_file(path, foreign)))
}

/// Reads the text of a small file, such as settings: at most 16 MiB.
pub(crate) fn read_text(path: &Path) -> Outcome<String> {
    text_of(path, open_bytes(path)?)
}

/// Reads as [`read_text`] does, from a file that is open already.
pub(crate) fn text_of(path: &Path, input: Input) -> Outcome<String> {
    let bytes = bytes_of(path, input, LIMITS.text)?;
    refuse_foreign(path, &bytes)?;
    String::from_utf8(bytes).map_err(|e| {
        let after = e.utf8_error().valid_up_to();
        Failure::bad_file(
            path,
            format_args!("after {after} bytes the text is not UTF-8; save it again as UTF-8"),
        )
    })
}

/// Reads a settings file that a person wrote: JSON by its extension, otherwise TOML.
pub(crate) fn read_spec<T: Spec>(path: &Path) -> Outcome<T> {
    let text = read_text(path)?;
    let json = extension(path).is_some_and(|e| e.eq_ignore_ascii_case("json"));
    if !json {
        return burgeon::spec::from_toml(&text).map_err(|e| Failure::bad_file(path, e));
    }
    let value = serde_json::from_str(&text)
        .map_err(|e| Failure::bad_file(path, format_args!("is not JSON: {}", plainly(&e.to_string()))))?;
    let spec = burgeon::spec::from_json(&value).map_err(|e| Failure::bad_file(path, e))?;
    burgeon::spec::check(&spec).map_err(|fault| Failure::bad_file(path, fault))?;
    Ok(spec)
}

/// Reads a project.
pub(crate) fn read_project(path: &Path, input: Input) -> Outcome<Document> {
    let mut bytes = Vec::new();
    let bounded = input.take(MAX_PROJECT_BYTES as u64 + 1).read_to_end(&mut bytes);
    bounded.map_err(|e| Failure::io(path, "read", &e))?;
    // A project is an archive; other files may have its name.
    let foreign = Foreign::sniff(&bytes).filter(|f| !matches!(f, Foreign::Project | Foreign::Zip));
    if let Some(foreign) = foreign {
        return Err(Failure::bad_file(path, foreign));
    }
    document::read_project(&bytes).map_err(|e| Failure::bad_file(path, e))
}

/// Message about a project without plants.
pub(crate) const EMPTY: &str = "is an empty project: it has no plant; add one in the Studio";

/// Returns the only drawing of a project, as if it had been read from a file of strokes, and its plant.
pub(crate) fn drawing_of<'a>(
    path: &Path,
    document: &'a Document,
) -> Outcome<(ReadDrawing, &'a DocumentPlant)> {
    if document.plants().is_empty() {
        return Err(Failure::bad_file(path, EMPTY));
    }
    let [plant] = document.plants() else {
        let line = format!(
            "is a scene of {} plants, not one drawing; `burgeon sketch` makes all of them",
            document.plants().len()
        );
        return Err(Failure::bad_file(path, line));
    };
    if plant.settings().sketch().is_none() {
        let line =
            format!("holds a {}, not a drawing; `burgeon sketch` makes it", plant.settings().maker.word());
        return Err(Failure::bad_file(path, line));
    }
    if plant.strokes().is_empty() {
        return Err(Failure::bad_file(path, "holds no stroke; open it in the Studio and draw"));
    }
    Ok((ReadDrawing { drawing: plant.drawing(), warnings: Vec::new() }, plant))
}

/// Returns the axes of models: +Y up by default.
pub(crate) fn axes(up: impl Into<Option<UpAxis>>, unit: Unit) -> ExportSpec {
    ExportSpec { up: up.into().unwrap_or_default(), unit }
}

/// Reads a model, with the messages of its reader.
pub(crate) fn read_model(path: &Path, axes: &ExportSpec) -> Outcome<(Model, ModelFormat, Vec<Warning>)> {
    let (input, kind) = open(path)?;
    read_opened_model(path, input, kind, axes)
}

/// Reads as [`read_model`] does, from a file that is open already.
pub(crate) fn read_opened_model(
    path: &Path,
    input: Input,
    kind: Kind,
    axes: &ExportSpec,
) -> Outcome<(Model, ModelFormat, Vec<Warning>)> {
    let mut input = input;
    let format = match kind {
        Kind::Model(format) => format,
        Kind::Drawing(format) => {
            let start = input.fill_buf().map_err(|e| Failure::io(path, "read", &e))?;
            if let Some(foreign) = Foreign::sniff(start) {
                return Err(Failure::bad_file(path, foreign));
            }
            return Err(Failure::bad_file(
                path,
                format_args!(
                    "is a drawing ({}), not a model; `burgeon sketch` makes a model of it",
                    format.name()
                ),
            ));
        }
        Kind::Structure(format) => {
            let name = format.name();
            let line = format_args!(
                "is the structure of a plant ({name}), not a model; `burgeon shape` makes a model of it"
            );
            return Err(Failure::bad_file(path, line));
        }
        Kind::Project => {
            return Err(Failure::bad_file(
                path,
                "is a project, not a model; `burgeon sketch` makes a model of it",
            ));
        }
    };
    let mut report = Report::default();
    let input = if format.holds(Room::Axes) { input } else { announce_gltf(path, input)? };
    let named = |file: SideFile<'_>| resolve(path, file);
    let model = burgeon::formats::read_model(input, format, &stem(path), axes, &named, &mut report);
    let model = model.map_err(|e| match e.fault {
        // The reason itself names the files.
        FileFault::Refused { why } => Failure::Bad(why),
        _ => Failure::bad_file(path, e),
    });
    Ok((model?, format, report.warnings))
}

/// Files that a glTF names, read or not: only some of its pictures are.
#[derive(Default, Deserialize)]
#[serde(default)]
struct GltfFiles {
    buffers: Vec<GltfFile>,
    images: Vec<GltfFile>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct GltfFile {
    uri: Option<String>,
}

/// Protects the files that a glTF names from being overwritten. The input starts anew.
fn announce_gltf(model: &Path, mut input: Input) -> Outcome<Input> {
    let failed = |e: &std::io::Error| Failure::io(model, "read", e);
    let mut start = Vec::new();
    input.by_ref().take(20).read_to_end(&mut start).map_err(|e| failed(&e))?;
    // A binary one has its JSON first, after 20 bytes: the magic, version and length, and the JSON's own length and
    // type.
    let (from, length) = match start.as_slice() {
        &[b'g', b'l', b'T', b'F', _, _, _, _, _, _, _, _, a, b, c, d, ..] => {
            (20, u64::from(u32::from_le_bytes([a, b, c, d])))
        }
        _ => (0, MAX_MODEL_BYTES),
    };
    input.by_ref().take(length).read_to_end(&mut start).map_err(|e| failed(&e))?;
    // The reader of models reports any fault.
    let files: GltfFiles =
        start.get(from..).and_then(|json| serde_json::from_slice(json).ok()).unwrap_or_default();
    let names = files.buffers.iter().chain(&files.images).filter_map(|f| f.uri.as_deref());
    let names: BTreeSet<&str> = names.filter(|n| !n.starts_with("data:")).collect();
    for name in names.into_iter().take(MOST_NAMED) {
        inputs::announce_named(model, name);
        decode_uri(name).iter().for_each(|name| inputs::announce_named(model, name));
    }
    Ok(Box::new(BufReader::new(Cursor::new(start).chain(input))))
}

/// Most files that one file names: the reader of models refuses more.
const MOST_NAMED: usize = 4096;

/// Protects the textures that a material file names from being overwritten.
fn announce_textures(library: &Path, text: &[u8]) {
    let text = String::from_utf8_lossy(text);
    let mut names = BTreeSet::new();
    for line in text.lines() {
        let (key, rest) = line.trim().split_once(char::is_whitespace).unwrap_or_default();
        if key.starts_with("map_") || ["bump", "disp", "decal", "refl", "norm"].contains(&key) {
            let rest = rest.trim();
            let name = if rest.starts_with('-') { rest.rsplit(' ').next().unwrap_or(rest) } else { rest };
            names.insert(name);
        }
    }
    names.into_iter().take(MOST_NAMED).for_each(|name| inputs::announce_named(library, name));
}

/// Reads a file that a model, or its file of materials, names. An optional file may be missing; a forbidden one ends
/// the command.
fn resolve(model: &Path, file: SideFile<'_>) -> Result<Vec<u8>, NoFile> {
    let library = file.by.map(|by| Named { naming: model, name: by }.path());
    let naming = library.as_deref().unwrap_or(model);
    let bytes = inputs::named_bytes(naming, file.name, LIMITS.side_file).map_err(|e| match e.fault {
        NamedFault::Missing => NoFile::Missing,
        _ => NoFile::Refused(line_of(&e)),
    })?;
    let path = Named { naming, name: file.name }.path();
    if extension(&path).is_some_and(|e| e.eq_ignore_ascii_case("mtl")) {
        announce_textures(&path, &bytes);
    }
    Ok(bytes)
}

/// Returns the format of a model's file name, if we write it.
pub(crate) fn writable(path: &Path) -> Outcome<ModelFormat> {
    let format = extension(path).and_then(ModelFormat::from_extension);
    format.filter(|format| format.row().is_written()).ok_or_else(|| {
        let endings = ModelFormat::written_endings();
        Failure::bad_file(
            path,
            format_args!("models are written as {endings}; end the name with one of them"),
        )
    })
}

/// Returns the format of a plant's file name, if we write it.
pub(crate) fn plant_writable(path: &Path) -> Outcome<PlantFormat> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if let Some(format) = PlantFormat::from_two_words(&name) {
        return Ok(format);
    }
    match extension(path).and_then(PlantFormat::from_extension) {
        Some(format @ (PlantFormat::Structure(_) | PlantFormat::Robot(_))) => Ok(format),
        Some(PlantFormat::Model(_)) => writable(path).map(PlantFormat::Model),
        None => {
            Err(Failure::bad_file(path, format!("{}; end the name with one of them", PlantFormat::endings())))
        }
    }
}

/// Target of a model or plant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal<'a> {
    /// The option that requests it.
    pub(crate) by: &'a str,
    pub(crate) path: &'a Path,
    /// Whether it is one of a batch, by a name of [`crate::names`]: its textures are `NAME--MATERIAL.png`, a name that
    /// no other output can have.
    pub(crate) of_many: bool,
    /// Packing of a .glb.
    pub(crate) packing: Option<Packing>,
}

impl<'a> Goal<'a> {
    pub(crate) const fn new(by: &'a str, path: &'a Path) -> Self {
        Self { by, path, of_many: false, packing: None }
    }

    /// Returns the names of the files next to the model's own: its name, and a longer one for textures in a batch.
    pub(crate) fn stems(&self) -> (String, String) {
        let name = stem(self.path);
        let textures = if self.of_many { format!("{name}-") } else { name.clone() };
        (name, textures)
    }

    fn sibling(&self, name: &str) -> PathBuf {
        self.path.with_file_name(name)
    }

    /// Describes a file that the model's own names.
    fn by_way_of(&self, what: Beside) -> String {
        format!("{} of {}", what.phrase(), self.by)
    }
}

/// Returns the format of a model's file, and plans it as -o, with the known files next to it.
pub(crate) fn plan_model(outputs: &mut Outputs, path: &Path) -> Outcome<ModelFormat> {
    let format = writable(path)?;
    plan_beside(outputs, Goal::new("-o", path), format)?;
    Ok(format)
}

/// Plans as [`plan_model`] does, for a plant and its coarser copies.
pub(crate) fn plan_plant(outputs: &mut Outputs, path: &Path, lods: u32) -> Outcome<PlantFormat> {
    let format = plant_writable(path)?;
    let PlantFormat::Model(model) = format else { return Ok(format) };
    plan_beside(outputs, Goal::new("-o", path), model)?;
    for level in 1..=lods as usize {
        let path = lod(path, level);
        outputs.plan("--lods", &path)?;
        plan_beside(outputs, Goal::new("--lods", &path), model)?;
    }
    Ok(format)
}

// Textures are known only when the plant is.
fn plan_beside(outputs: &mut Outputs, goal: Goal<'_>, format: ModelFormat) -> Outcome {
    for (what, name) in names_beside(format, &stem(goal.path)) {
        outputs.plan(&goal.by_way_of(what), &goal.sibling(&name))?;
    }
    Ok(())
}

/// `tree.glb` -> `tree-lod1.glb`.
pub(crate) fn lod(path: &Path, level: usize) -> PathBuf {
    let extension = extension(path).unwrap_or_default();
    path.with_file_name(format!("{}-lod{level}.{extension}", stem(path)))
}

/// Messages of the writer of a plant.
#[derive(Debug, Default)]
pub(crate) struct PlantWritten {
    pub(crate) warnings: Vec<Warning>,
    /// For a robot: its structure.
    pub(crate) robot: Option<RobotReport>,
}

impl PlantWritten {
    /// Adds the messages to the report of the plant.
    pub(crate) fn tell(self, item: &mut ItemReport) {
        item.warnings.extend(self.warnings.iter().map(ToString::to_string));
        item.robot = self.robot.or(item.robot.take());
    }
}

impl From<Vec<Warning>> for PlantWritten {
    fn from(warnings: Vec<Warning>) -> Self {
        Self { warnings, robot: None }
    }
}

/// Writes a plant: its model, or its structure with +Z up unless `up` says otherwise.
pub(crate) fn write_plant(
    outputs: &mut Outputs,
    goal: Goal<'_>,
    (plant, model): (&Plant, &Model),
    format: PlantFormat,
    args: &AxesArgs,
    cache: &mut PngCache,
) -> Outcome<PlantWritten> {
    match format {
        PlantFormat::Model(format) => {
            write_model(outputs, goal, model, format, &axes(args.up, args.unit), cache).map(Into::into)
        }
        PlantFormat::Structure(format) => {
            write_structure(outputs, (goal.by, goal.path), plant, format, args)?;
            let mut report = Report::default();
            warn_of_wind(model, format.name(), &mut report);
            Ok(report.warnings.into())
        }
        PlantFormat::Robot(format) => write_robot(outputs, goal, plant, format),
    }
}

/// Writes a plant as bodies and joints, with their meshes in separate files.
fn write_robot(
    outputs: &mut Outputs,
    goal: Goal<'_>,
    plant: &Plant,
    format: RobotFormat,
) -> Outcome<PlantWritten> {
    let mut report = Report::default();
    let (_, stem) = goal.stems();
    let made = burgeon::write_robot(plant, format, &stem, &Run::plain(), &mut report);
    let robot = made.map_err(|e| match e {
        RobotError::Write(e) => output::write_failed(goal.path, e),
        e => Failure::bad_file(goal.path, e),
    })?;
    write_files(outputs, goal, Ok(robot.files))?;
    Ok(PlantWritten { warnings: report.warnings, robot: Some(robot.report) })
}

/// Writes a plant's structure, with +Z up unless `args` say otherwise.
pub(crate) fn write_structure(
    outputs: &mut Outputs,
    (by, path): (&str, &Path),
    plant: &Plant,
    format: StructureFormat,
    args: &AxesArgs,
) -> Outcome {
    let axes = field_axes(args);
    outputs.write(by, path, |out| burgeon::write_structure(plant, format, &axes, out))
}

/// Writes a plant's cylinders, with +Z up unless `args` say otherwise.
pub(crate) fn write_qsm(outputs: &mut Outputs, path: &Path, plant: &Plant, args: &AxesArgs) -> Outcome {
    write_structure(outputs, ("--qsm", path), plant, StructureFormat::Qsm, args)
}

/// Whether a drawing of a plant can have this name.
pub(crate) fn drawing_writable(path: &Path) -> Outcome {
    match extension(path) {
        Some(extension) if extension.eq_ignore_ascii_case("svg") => Ok(()),
        _ => Err(Failure::bad_file(path, "drawings are written as .svg; end the name with it")),
    }
}

/// Writes a line drawing of a plant.
pub(crate) fn write_drawing(outputs: &mut Outputs, path: &Path, name: &str, lines: &[DrawnLine]) -> Outcome {
    let lines = lines.iter().map(|line| (line.kind.word(), line.points.clone()));
    let drawing = burgeon::drawing_of(name, lines);
    outputs.write("--drawing", path, |out| burgeon::formats::write_svg(&drawing, out))
}

// The programs that read MTG, OPF, QSM and SWC files have Z upwards.
fn field_axes(args: &AxesArgs) -> ExportSpec {
    axes(args.up.unwrap_or(UpAxis::Z), args.unit)
}

/// Writes a model and the files that its own names.
pub(crate) fn write_model(
    outputs: &mut Outputs,
    goal: Goal<'_>,
    model: &Model,
    format: ModelFormat,
    axes: &ExportSpec,
    cache: &mut PngCache,
) -> Outcome<Vec<Warning>> {
    let mut report = Report::default();
    if let Some(packing) = goal.packing.filter(|_| format.holds(Room::Packing)) {
        write_gltf(outputs, goal, format, |out| write_glb_packed(model, packing, cache, out))?;
    } else if format.holds(Room::Packing) && axes.is_default() {
        write_gltf(outputs, goal, format, |out| write_glb_with(model, cache, out))?;
    } else if format.row().beside.is_empty() {
        outputs.write(goal.by, goal.path, |out| {
            burgeon::formats::write_model(model, format, axes, out, &mut report)
        })?;
    } else {
        let (name, textures) = goal.stems();
        let stems = FileStems { model: &name, textures: &textures };
        let files = model_files(model, format, stems, axes, cache, &mut report);
        write_files(outputs, goal, files)?;
    }
    Ok(report.warnings)
}

/// Writes the result of `write`, a binary glTF, in a format of its family.
pub(crate) fn write_gltf(
    outputs: &mut Outputs,
    goal: Goal<'_>,
    format: ModelFormat,
    write: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
) -> Outcome {
    if format.row().beside.is_empty() {
        return outputs.write(goal.by, goal.path, write);
    }
    let mut glb = Vec::new();
    let (name, textures) = goal.stems();
    let stems = FileStems { model: &name, textures: &textures };
    let files = write(&mut glb).and_then(|()| gltf_files(glb, format, stems));
    write_files(outputs, goal, files)
}

pub(crate) fn write_files(
    outputs: &mut Outputs,
    goal: Goal<'_>,
    files: Result<ModelFiles, WriteError>,
) -> Outcome {
    let ModelFiles { own, beside } = files.map_err(|e| output::write_failed(goal.path, e))?;
    write_beside(outputs, goal, Ok(beside))?;
    outputs.write(goal.by, goal.path, |out| Ok(out.write_all(&own)?))
}

/// Writes the companion files of a model.
pub(crate) fn write_beside(
    outputs: &mut Outputs,
    goal: Goal<'_>,
    files: Result<Vec<BesideFile>, WriteError>,
) -> Outcome {
    for file in files.map_err(|e| output::write_failed(goal.path, e))? {
        let (by, path) = (goal.by_way_of(file.what), goal.sibling(&file.name));
        outputs.write(&by, &path, |out| Ok(out.write_all(&file.bytes)?))?;
    }
    Ok(())
}
