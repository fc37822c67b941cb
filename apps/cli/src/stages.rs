//! Stages files and scans: read, cleaned, split into organs that carry the same names on every day.

use std::path::{Path, PathBuf};

use burgeon::bloom::{self, CleanSpec, Oddity, ScanOrgan, SegmentSpec, Stage};
use burgeon::formats::{CloudFormat, ExportSpec};
use burgeon::glam::DVec3;
use burgeon::mesh::{PointCloud, TriMesh};
use burgeon::{Report, Seed, Unit, UpAxis};
use serde::{Deserialize, Serialize};

use crate::failure::{Failure, Outcome};
use crate::files;
use crate::inputs;
use crate::machine::Machine;
use crate::origin::Origin;

/// A stages file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct StagesFile {
    name: Option<String>,
    unit: Option<Unit>,
    up: Option<UpAxis>,
    #[serde(default)]
    split: Split,
    #[serde(default = "yes")]
    clean: bool,
    #[serde(default)]
    stage: Vec<StageEntry>,
}

fn yes() -> bool {
    true
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Split {
    #[default]
    Auto,
    None,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct StageEntry {
    file: PathBuf,
    day: f64,
    unit: Option<Unit>,
    up: Option<UpAxis>,
    #[serde(default)]
    mirror: bool,
    organ: Option<String>,
    region: Option<usize>,
    seed: Option<[f64; 3]>,
    base: Option<[f64; 3]>,
    crop: Option<[[f64; 3]; 2]>,
}

/// Changes made to a scan.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct StageReport {
    file: String,
    day: f64,
    points: usize,
    cropped: usize,
    ground: usize,
    outliers: usize,
    /// Points of things apart from the largest.
    others: usize,
    /// Width, height and depth of the kept points.
    size_mm: [f64; 3],
    organs: Vec<OrganTold>,
}

impl StageReport {
    /// Returns one line for people.
    pub(crate) fn line(&self) -> String {
        let organs: Vec<String> = self.organs.iter().map(|o| format!("{} {}", o.name, o.points)).collect();
        let [w, h, d] = self.size_mm;
        let gone = self.cropped + self.ground + self.outliers + self.others;
        format!(
            "day {}: {} points, {gone} left out; {h:.1} mm high, {w:.1} x {d:.1} mm wide: {}",
            self.day,
            self.points,
            organs.join(", ")
        )
    }
}

#[derive(Clone, Debug, Serialize)]
struct OrganTold {
    name: String,
    points: usize,
}

/// Stages ready for fitting and motion.
#[derive(Debug)]
pub(crate) struct Loaded {
    pub(crate) name: String,
    pub(crate) stages: Vec<Stage>,
    pub(crate) told: Vec<StageReport>,
    pub(crate) warnings: Vec<String>,
    /// Faces of the first shape, where it is a model.
    pub(crate) mesh: Option<TriMesh>,
    /// Unit and up axis of the scans.
    pub(crate) axes: ExportSpec,
    /// Offset subtracted from all scans.
    pub(crate) origin: Origin,
    /// Whether organs have names that were found from day to day, not by hand.
    pub(crate) is_named_alike: bool,
}

/// Treatment of scans.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options {
    pub(crate) clean: bool,
    pub(crate) split: bool,
}

/// Reads points of a scan with their colours, or of a model, in metres, +Y up, and the model's faces.
fn read_any(
    path: &Path,
    axes: &ExportSpec,
    origin: &mut Origin,
    warnings: &mut Vec<String>,
) -> Outcome<(PointCloud, Option<TriMesh>)> {
    let mut tell = |told: Vec<burgeon::Warning>| {
        warnings.extend(told.iter().map(|w| format!("{}: {w}", path.display())));
    };
    let stdin = inputs::is_stdin(path).then(|| files::peek(path)).transpose()?;
    let cloud = match &stdin {
        Some((_, start)) => files::sniff_points(start),
        None => files::extension(path).and_then(CloudFormat::from_extension),
    };
    if path.is_dir() {
        return Err(Failure::bad_file(path, "is a folder; name a file in it"));
    }
    let Some(format) = cloud.filter(|_| stdin.is_some() || !files::has_faces(path)) else {
        let (model, _, told) = match stdin {
            Some((input, start)) => {
                files::read_opened_model(path, input, files::kind_of(path, &start)?, axes)?
            }
            None => files::read_model(path, axes)?,
        };
        tell(told);
        let mut mesh = TriMesh::default();
        for part in &model.parts {
            // Only positions and faces: the other columns of parts may differ.
            mesh.append(&TriMesh {
                positions: part.mesh.positions.clone(),
                triangles: part.mesh.triangles.clone(),
                ..TriMesh::default()
            });
        }
        let points =
            mesh.positions.iter().map(|p| DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2])));
        let cloud = PointCloud { points: points.collect(), ..PointCloud::default() };
        return Ok((cloud, (!mesh.triangles.is_empty()).then_some(mesh)));
    };
    let opened = match stdin {
        Some((input, _)) => input,
        None => files::open_bytes(path)?,
    };
    let mut report = Report::default();
    let mut cloud = files::read_cloud(path, (opened, format), axes, &mut report)?;
    origin.bring(&mut cloud.points, axes, &mut report);
    tell(report.warnings);
    Ok((cloud, None))
}

/// Reads a scan for comparison with the loaded ones: its points, cleaned.
pub(crate) fn read_points(
    path: &Path,
    loaded: &mut Loaded,
    clean: bool,
    seed: Seed,
    machine: &Machine,
) -> Outcome<Vec<DVec3>> {
    let (PointCloud { points, .. }, mesh) =
        read_any(path, &loaded.axes, &mut loaded.origin, &mut loaded.warnings)?;
    if !clean || mesh.is_some() {
        return Ok(points);
    }
    let kept = bloom::clean(&points, &CleanSpec::default(), seed, &machine.run())?.kept;
    Ok(kept.into_iter().map(|i| points[i]).collect())
}

/// Reads and cleans one scan; reports what was removed.
fn prepare(
    path: &Path,
    day: f64,
    (axes, mirror): (&ExportSpec, bool),
    spec: Option<&CleanSpec>,
    seed: Seed,
    machine: &Machine,
    out: &mut Loaded,
) -> Outcome<(PointCloud, Option<TriMesh>, StageReport)> {
    machine.cancel.check()?;
    let Loaded { warnings, origin, .. } = out;
    let (mut cloud, mesh) = read_any(path, axes, origin, warnings)?;
    if mirror {
        cloud.points.iter_mut().for_each(|p| *p = mirrored(*p));
    }
    let points = &cloud.points;
    // The box to keep is given in the coordinates of the file.
    let spec = spec
        .map(|s| CleanSpec { crop: s.crop.map(|c| c.map(|p| mirrored_if(mirror, origin.place(p)))), ..*s });
    let mut told = StageReport {
        file: path.display().to_string(),
        day,
        points: points.len(),
        cropped: 0,
        ground: 0,
        outliers: 0,
        others: 0,
        size_mm: [0.0; 3],
        organs: vec![],
    };
    told.size_mm = (box_of(points) * 1e3).to_array();
    let size = box_of(points).max_element();
    // Between the smallest seedling and the largest thing that anybody scans as a series.
    if size > 20.0 || (size > 0.0 && size < 5e-4) {
        warnings.push(format!(
            "{}: is {size:.4} m in size in the unit that was taken; is it right? `unit = \"mm\"` in the stages file or \
             --unit says another",
            path.display()
        ));
    }
    let Some(spec) = spec.filter(|_| mesh.is_none()) else { return Ok((cloud, mesh, told)) };
    let cleaned = bloom::clean(points, &spec, seed, &machine.run())?;
    told.cropped = cleaned.cropped;
    told.ground = cleaned.ground;
    told.outliers = cleaned.outliers;
    told.others = cleaned.others;
    if cleaned.others > 0 {
        warnings.push(format!(
            "{}: {} points of other things stand apart from the largest one and were left out; `crop` in its [[stage]] says \
             what is meant, `clean = false` keeps all",
            path.display(),
            cleaned.others
        ));
    }
    if cleaned.ground > 0 {
        warnings.push(format!(
            "{}: {} points of a ground plane were left out",
            path.display(),
            cleaned.ground
        ));
    }
    if let Some(across) = cleaned.ground_across {
        let advice = match (across.to_array(), axes.up) {
            ([_, _, 1.0], UpAxis::Y) => "say `up = \"z\"` in the stages file, or --up z",
            ([_, _, -1.0], UpAxis::Z) => "say `up = \"y\"` in the stages file, or --up y",
            _ => "turn the scan so that y or z points up",
        };
        warnings.push(format!(
            "{}: no ground lies across the axis that was taken for up ({}), but a plane of its size lies across \
             another: the plant seems to lie down; {advice}",
            path.display(),
            axes.up.word()
        ));
    }
    if cleaned.outliers * 20 > points.len() {
        warnings.push(format!(
            "{}: {} of {} points were left out as stray; `clean = false` keeps them",
            path.display(),
            cleaned.outliers,
            points.len()
        ));
    }
    let kept = cloud.select(&cleaned.kept);
    told.size_mm = (box_of(&kept.points) * 1e3).to_array();
    Ok((kept, mesh, told))
}

/// Returns the mirror image, next to the origin of the series.
fn mirrored(p: DVec3) -> DVec3 {
    DVec3::new(-p.x, p.y, p.z)
}

fn mirrored_if(mirror: bool, p: DVec3) -> DVec3 {
    if mirror { mirrored(p) } else { p }
}

/// Returns width, height and depth.
fn box_of(points: &[DVec3]) -> DVec3 {
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let [low, high] = points.iter().fold(none, |[a, b], &p| [a.min(p), b.max(p)]);
    (high - low).max(DVec3::ZERO)
}

/// Loads the stages of a file.
pub(crate) fn load(path: &Path, axes: &ExportSpec, seed: Seed, machine: &Machine) -> Outcome<Loaded> {
    let text = files::read_text(path)?;
    let file: StagesFile = toml::from_str(&text).map_err(|e| {
        let line = e.span().map_or(1, |s| text[..s.start.min(text.len())].lines().count().max(1));
        Failure::bad_file(path, format_args!("line {line}: {}; see `burgeon bloom fit --help`", e.message()))
    })?;
    if file.stage.is_empty() {
        return Err(Failure::bad_file(path, "names no stage; add [[stage]] with file and day"));
    }
    let mut out = Loaded {
        name: file.name.clone().unwrap_or_else(|| files::stem(path)),
        stages: vec![],
        told: vec![],
        warnings: vec![],
        mesh: None,
        axes: *axes,
        origin: Origin::default(),
        is_named_alike: false,
    };
    for entry in &file.stage {
        if !entry.day.is_finite() {
            return Err(Failure::bad_file(
                path,
                format_args!("the day of {} is no number", entry.file.display()),
            ));
        }
        add_entry(path, &file, entry, axes, seed, machine, &mut out)?;
    }
    for stage in &mut out.stages {
        stage.organs.retain(|o| o.points.len() >= 8);
    }
    alike(&mut out, file.split == Split::Auto);
    let by_hand = file.stage.iter().any(|e| e.organ.is_some() || e.seed.is_some());
    out.is_named_alike = file.split == Split::Auto && !by_hand;
    if out.is_named_alike {
        odd(&mut out, machine)?;
    }
    Ok(out)
}

/// Warns of scans that are mirrored, lie down, or have another scale than the others. Single organs give no
/// orientation.
fn odd(out: &mut Loaded, machine: &Machine) -> Outcome {
    if out.mesh.is_some() || out.stages.iter().any(|s| s.organs.len() < 2) {
        return Ok(());
    }
    let found =
        bloom::odd_stages(&out.stages, &machine.run()).map_err(Failure::bloom(Path::new("stages")))?;
    for o in found {
        let (day, other) = (out.stages[o.stage].day, out.stages[o.beside].day);
        let nearer = o.as_it_is / o.mended.max(1e-12);
        let which = match o.sure {
            true => format!("the scan of day {day}"),
            false => format!("the scan of day {day} (or that of day {other})"),
        };
        out.warnings.push(match o.oddity {
            Oddity::Mirrored => format!(
                "{which} seems to be mirrored: its mirror image is {nearer:.1} times nearer to day {other}; write `mirror = \
                 true` in its [[stage]], or negate an axis where it is exported"
            ),
            Oddity::Turned(up) => {
                let advice = match (up.to_array(), out.axes.up) {
                    ([_, _, 1.0], UpAxis::Y) => "write `up = \"z\"` in its [[stage]]",
                    ([_, _, -1.0], UpAxis::Z) => "write `up = \"y\"` in its [[stage]]",
                    _ => "say `up` in its [[stage]], or turn it so that y or z points up",
                };
                format!(
                    "{which} seems to lie down or to stand on its head: turned up it is {nearer:.1} times nearer to day \
                     {other}; {advice}"
                )
            }
            Oddity::Scaled(by) => format!(
                "the scan of day {day} is that of day {other} {by:.3} times as large and else the same: is its unit right? \
                 `unit = \"mm\"` in its [[stage]] says another"
            ),
        });
    }
    Ok(())
}

fn add_entry(
    path: &Path,
    file: &StagesFile,
    entry: &StageEntry,
    axes: &ExportSpec,
    seed: Seed,
    machine: &Machine,
    out: &mut Loaded,
) -> Outcome {
    let unit = entry.unit.or(file.unit).unwrap_or(axes.unit);
    let up = entry.up.or(file.up).unwrap_or(axes.up);
    let axes = ExportSpec { up, unit };
    if out.stages.is_empty() {
        out.axes = axes;
    }
    let place = |p: [f64; 3]| axes.inward(DVec3::from_array(p));
    let scan = inputs::named_path(path, &entry.file.to_string_lossy())?;
    let clean = CleanSpec {
        outliers: file.clean,
        plane: file.clean,
        crop: entry.crop.map(|c| c.map(place)),
        ..CleanSpec::default()
    };
    let (PointCloud { points, colors, .. }, mesh, mut told) =
        prepare(&scan, entry.day, (&axes, entry.mirror), Some(&clean), seed, machine, out)?;
    let origin = out.origin;
    let near = |p: [f64; 3]| mirrored_if(entry.mirror, origin.place(place(p)));
    let spec = SegmentSpec { foot: entry.base.map(near), ..SegmentSpec::default() };
    let run = machine.run();
    let mut found = match (&entry.organ, entry.seed) {
        (Some(name), Some(at)) => {
            let mut one = bloom::organ_at(&points, near(at), &spec, &run).map_err(Failure::bloom(&scan))?;
            one.name.clone_from(name);
            vec![one]
        }
        (None, Some(at)) => {
            vec![bloom::organ_at(&points, near(at), &spec, &run).map_err(Failure::bloom(&scan))?]
        }
        (Some(name), None) => {
            vec![bloom::single_organ(&points, name, &spec, &run).map_err(Failure::bloom(&scan))?]
        }
        (None, None) if file.split == Split::None || mesh.is_some() => {
            vec![bloom::single_organ(&points, "organ", &spec, &run).map_err(Failure::bloom(&scan))?]
        }
        (None, None) => bloom::organs(&points, &spec, &run).map_err(Failure::bloom(&scan))?,
    };
    add_faces(&mut found, mesh.as_ref());
    if let (Some(base), [one]) = (entry.base.map(near), &mut found[..]) {
        one.base = base;
    }
    told.organs = found.iter().map(|o| OrganTold { name: o.name.clone(), points: o.points.len() }).collect();
    out.told.push(told);
    if out.stages.is_empty() {
        out.mesh = mesh;
    }
    #[expect(clippy::float_cmp, reason = "the same literal in the same file")]
    let same_day = out.stages.last().is_some_and(|s| s.day == entry.day);
    if !same_day {
        out.stages.push(Stage { day: entry.day, organs: vec![] });
    }
    if let Some(stage) = out.stages.last_mut() {
        for organ in found {
            add_organ(stage, organ.coloured(&colors), entry.region);
        }
    }
    Ok(())
}

/// Gives the only organ of a whole model, each vertex one point, the model's triangles.
fn add_faces(organs: &mut [ScanOrgan], mesh: Option<&TriMesh>) {
    if let ([one], Some(mesh)) = (organs, mesh)
        && one.points.len() == mesh.positions.len()
    {
        one.faces = mesh.triangles.as_slice().into();
    }
}

/// Adds a region of an organ to the other regions of the same day.
fn add_organ(stage: &mut Stage, mut organ: ScanOrgan, region: Option<usize>) {
    let Some(region) = region else {
        stage.organs.push(organ);
        return;
    };
    // Files of regions give the place along the organ themselves: whole numbers, scaled to 0..1 at the end.
    #[expect(clippy::cast_precision_loss, reason = "a handful of regions")]
    let place = region.clamp(1, 20) as f64;
    organ.way.iter_mut().for_each(|w| *w = (place - 1.0 + w.clamp(0.001, 0.999)) / 20.0);
    match stage.organs.iter_mut().find(|o| o.name == organ.name) {
        Some(whole) => {
            whole.points.extend(organ.points);
            whole.colors.extend(organ.colors);
            if whole.colors.len() != whole.points.len() {
                whole.colors.clear();
            }
            whole.way.extend(organ.way);
            whole.rows = (0..whole.points.len()).collect();
            if region == 1 {
                whole.base = organ.base;
            } else {
                whole.tip = organ.tip;
            }
        }
        None => stage.organs.push(organ),
    }
}

/// Gives organs the same names, stretches the lengths of regions, warns of unlike sizes.
fn alike(out: &mut Loaded, split: bool) {
    let size = |s: &Stage| {
        let all = || s.organs.iter().flat_map(|o| &o.points);
        let low = all().fold(DVec3::INFINITY, |a, &p| a.min(p));
        let high = all().fold(DVec3::NEG_INFINITY, |a, &p| a.max(p));
        (high - low).max_element()
    };
    for stage in &mut out.stages {
        for organ in &mut stage.organs {
            let longest = organ.way.iter().copied().fold(0.0, f64::max);
            if longest > 0.0 && longest < 0.999 {
                // Regions were marked in twentieths: their number becomes the whole length.
                let whole = (longest * 20.0).ceil() / 20.0;
                organ.way.iter_mut().for_each(|w| *w /= whole);
            }
        }
    }
    for k in 1..out.stages.len() {
        let (all_before, now) = out.stages.split_at_mut(k);
        let (Some(before), Some(now)) = (all_before.last(), now.first_mut()) else { continue };
        let (a, b) = (size(before), size(now));
        if b > 8.0 * a || a > 8.0 * b {
            out.warnings.push(format!(
                "the scans of day {} and day {} differ in size by a factor of {:.1}; are their units the same? `unit = \"mm\"` in \
                 a [[stage]] says another",
                before.day,
                now.day,
                (b / a).max(a / b)
            ));
        }
        if split && now.organs.iter().any(|o| o.name == "stem") {
            bloom::name_alike(all_before, &mut now.organs, DVec3::Y);
            let leaves = |s: &Stage| s.organs.iter().filter(|o| o.name != "stem").count();
            let again =
                now.organs.iter().any(|o| o.name != "stem" && before.organs.iter().any(|b| b.name == o.name));
            if leaves(before) > 0 && leaves(now) > 0 && !again {
                out.warnings.push(format!(
                    "no leaf of day {} is found again on day {}: are both scans of one plant, with the same side up? \
                     `organ` and `seed` in a [[stage]] name leaves by hand",
                    before.day, now.day
                ));
            }
        }
    }
}

/// Loads the first and last shape, each a file; or one shape.
pub(crate) fn load_files(
    shapes: &[(&Path, f64)],
    options: Options,
    axes: &ExportSpec,
    seed: Seed,
    machine: &Machine,
) -> Outcome<Loaded> {
    let first = shapes.first().map_or_else(|| Path::new(""), |s| s.0);
    let mut out = Loaded {
        name: files::stem(first),
        stages: vec![],
        told: vec![],
        warnings: vec![],
        mesh: None,
        axes: *axes,
        origin: Origin::default(),
        is_named_alike: false,
    };
    let spec = SegmentSpec::default();
    let clean = CleanSpec { outliers: options.clean, plane: options.clean, ..CleanSpec::default() };
    let mut split = options.split;
    let run = machine.run();
    for &(path, day) in shapes {
        let (PointCloud { points, colors, .. }, mesh, mut told) =
            prepare(path, day, (axes, false), Some(&clean), seed, machine, &mut out)?;
        // A model with faces is one organ, and then so is its partner.
        split &= mesh.is_none();
        let mut organs = if split {
            bloom::organs(&points, &spec, &run).map_err(Failure::bloom(path))?
        } else {
            vec![bloom::single_organ(&points, "organ", &spec, &run).map_err(Failure::bloom(path))?]
        };
        add_faces(&mut organs, mesh.as_ref());
        told.organs =
            organs.iter().map(|o| OrganTold { name: o.name.clone(), points: o.points.len() }).collect();
        out.told.push(told);
        if out.stages.is_empty() {
            out.mesh = mesh;
        }
        let organs = organs.into_iter().map(|o| o.coloured(&colors)).collect();
        out.stages.push(Stage { day, organs });
    }
    // A scan that is split into stem and leaves cannot be matched with one that is a single organ.
    let counts: Vec<usize> = out.stages.iter().map(|s| s.organs.len()).collect();
    if split && counts.contains(&1) && counts.iter().any(|&c| c > 1) {
        out.warnings
            .push("one shape is a single organ and the other is not: both are taken as one organ".into());
        for stage in &mut out.stages {
            let all: Vec<DVec3> = stage.organs.iter().flat_map(|o| o.points.iter().copied()).collect();
            let colors: Vec<[u8; 3]> = stage.organs.iter().flat_map(|o| o.colors.iter().copied()).collect();
            let one = bloom::single_organ(&all, "organ", &spec, &run).map_err(Failure::bloom(first))?;
            stage.organs = vec![one.coloured(&colors)];
        }
        split = false;
    }
    alike(&mut out, split);
    if split {
        odd(&mut out, machine)?;
    }
    Ok(out)
}
