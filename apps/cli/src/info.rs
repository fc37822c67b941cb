//! `burgeon info`: the contents of a file.

use std::path::Path;

use burgeon::formats::{
    CloudFacts, CloudFormat, DrawingFormat, DrawingSummary, ModelSummary, ReadStructure, Room,
    StructureTally, read_drawings,
};
use burgeon::plant::Measures;
use burgeon::{Report, UpAxis};
use serde::Serialize;

use crate::args::{InfoArgs, StructureArgs};
use crate::failure::{Failure, Outcome};
use crate::files::{self, Kind};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{report, say, structure};

/// Most drawings of a file that are listed one by one.
const LISTED: usize = 20;
/// Most warnings of a file with many drawings that are listed one by one.
const WARNINGS: usize = 50;

pub(crate) fn info(args: &InfoArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = Outputs::new(&[("--report", args.common.report.as_ref())], &[&args.input])?;
    if let Some(format) = files::points_alone(&args.input)? {
        let cloud = Cloud::read(args, format)?;
        return tell(args, &machine, outputs, format.word(), Content::Cloud(cloud));
    }
    let (input, kind) = files::open(&args.input)?;
    let has_axes = match kind {
        Kind::Model(format) => format.holds(Room::Axes),
        Kind::Structure(_) => true,
        Kind::Drawing(_) | Kind::Project => false,
    };
    args.given.check_axes(has_axes)?;
    if !matches!(kind, Kind::Structure(_)) {
        StructureArgs::refuse(&args.given, "it is no such file")?;
    }
    let (format, content) = match kind {
        Kind::Model(_) => {
            let axes = files::axes(args.axes.up, args.axes.unit);
            let (model, format, warnings) = files::read_opened_model(&args.input, input, kind, &axes)?;
            (format.word(), Content::Model(ModelSummary::from_model(&model, &warnings)))
        }
        Kind::Structure(format) => {
            let mut told = Report::default();
            let spec = args.structure.spec_of_input(&args.axes, &args.given);
            let read = structure::read(&args.input, input, format, &spec, &mut told)?;
            (format.word(), Content::Structure(Structure::new(&read, &told)))
        }
        Kind::Drawing(format) => (format.word(), Content::Drawings(drawings(&args.input, input, format)?)),
        Kind::Project => {
            let document = files::read_project(&args.input, input)?;
            let mut out = Drawings::default();
            for plant in document.plants().iter().filter(|p| p.settings().sketch().is_some()) {
                out.add(DrawingSummary::from_drawing(&plant.drawing(), &[]));
            }
            let plants = document.plants().iter().map(|p| PlantInfo {
                name: p.settings().name.clone(),
                maker: p.settings().maker.word(),
                seed: p.settings().seed.number(),
                position_m: p.settings().placement.position.to_array(),
            });
            out.plants = plants.collect();
            if out.plants.is_empty() {
                out.warnings.push("the project is empty: it has no plant".into());
            }
            ("project", Content::Drawings(out))
        }
    };
    tell(args, &machine, outputs, format, content)
}

/// Says what is in the file, and writes the report.
fn tell(
    args: &InfoArgs,
    machine: &Machine,
    outputs: Outputs,
    format: &'static str,
    content: Content,
) -> Outcome {
    // A pipe has no size.
    let bytes = std::fs::metadata(&args.input).ok().filter(std::fs::Metadata::is_file).map(|m| m.len());
    let path = args.input.display().to_string();
    let info = Info { schema: "burgeon.info/1", version: burgeon::VERSION, path, bytes, format, content };
    report::finish(&info, &args.common, outputs)?;
    if !machine.quiet {
        info.lines().iter().for_each(|l| say::line(l));
    }
    Ok(())
}

#[derive(Serialize)]
struct Info {
    schema: &'static str,
    version: &'static str,
    path: String,
    /// Size; null for standard input and pipes.
    bytes: Option<u64>,
    format: &'static str,
    #[serde(flatten)]
    content: Content,
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Content {
    Model(ModelSummary),
    Drawings(Drawings),
    Structure(Structure),
    Cloud(Cloud),
}

/// The points of a scan.
#[derive(Serialize)]
struct Cloud {
    #[serde(flatten)]
    facts: CloudFacts,
    /// The unit that is taken for that of the file, and whether it was asked for.
    taken_unit: &'static str,
    is_unit_asked: bool,
    warnings: Vec<String>,
}

impl Cloud {
    fn read(args: &InfoArgs, format: CloudFormat) -> Outcome<Self> {
        StructureArgs::refuse(&args.given, "it is no such file")?;
        let axes = files::axes(args.axes.up.unwrap_or(UpAxis::Z), args.axes.unit);
        let mut told = Report::default();
        let opened = (files::open_bytes(&args.input)?, format);
        let (_, facts) = files::read_cloud_with_facts(&args.input, opened, &axes, &mut told)?;
        let warnings = told.warnings.iter().map(ToString::to_string).collect();
        let is_unit_asked = args.given.has("unit");
        Ok(Self { facts, taken_unit: args.axes.unit.word(), is_unit_asked, warnings })
    }

    fn lines(&self, out: &mut Vec<String>) {
        let f = &self.facts;
        let detail = if f.detail.is_empty() { String::new() } else { format!(" ({})", f.detail) };
        out.push(format!("  {}{detail}", say::counted(f.points, "point", "points")));
        let size = [0, 1, 2].map(|k| short(f.max[k] - f.min[k])).join(" x ");
        let unit = match &f.unit {
            Some(unit) => format!("in {unit}, by its coordinate system"),
            None if self.is_unit_asked => format!("in {}, as asked", self.taken_unit),
            None => format!("in {} by its size, a guess; --unit says it", f.unit_guess),
        };
        out.push(format!("  {size} (x, y, z of the file), {unit}"));
        let place = |p: [f64; 3]| p.map(|x| format!("{x:.3}")).join(", ");
        out.push(format!("  from ({}) to ({})", place(f.min), place(f.max)));
        out.push(format!("  columns: {}", f.columns.join(", ")));
        if !f.has_colors && f.columns.iter().any(|c| c.eq_ignore_ascii_case("red")) {
            out.push("  all colours are black: they count as none".into());
        }
        for class in &f.classes {
            let used = if class.used_as.is_empty() { String::new() } else { format!(": {}", class.used_as) };
            let points = say::counted(class.points, "point", "points");
            out.push(format!("  class {} ({}): {points}{used}", class.class, class.name));
        }
        if let Some(system) = &f.coordinate_system {
            out.push(format!("  coordinate system: {system}"));
        }
        if let Some(step) = f.step_mm {
            out.push(format!("  coordinates in steps of {} mm", short(step)));
        }
    }
}

/// The structure of plants.
#[derive(Serialize)]
struct Structure {
    /// Number of rows, vertices or elements, and of those used in a plant.
    entries: u64,
    used: u64,
    plants: Vec<MeasuredPlant>,
    warnings: Vec<String>,
}

/// One plant of a file of structure, in its place in the file.
#[derive(Serialize)]
struct MeasuredPlant {
    name: String,
    axes: usize,
    nodes: usize,
    organs: usize,
    measures: Measures,
}

impl Structure {
    fn new(read: &ReadStructure, told: &Report) -> Self {
        let mut warnings: Vec<String> = told.warnings.iter().map(ToString::to_string).collect();
        let alone = read.plants.len() == 1;
        let tally = if alone { read.tally } else { StructureTally::default() };
        warnings.extend(read.plants.iter().flat_map(|plant| structure::doubts(plant, &tally)));
        warnings.truncate(WARNINGS);
        let plants = read.plants.iter().map(|plant| MeasuredPlant {
            name: plant.name.clone(),
            axes: plant.axes.len(),
            nodes: plant.nodes.position.len(),
            organs: plant.organs.len(),
            measures: plant.measure(),
        });
        let StructureTally { entries, used, .. } = read.tally;
        Self { entries, used, plants: plants.collect(), warnings }
    }

    fn lines(&self, out: &mut Vec<String>) {
        let count = |n: usize, one, many| say::counted(n as u64, one, many);
        let plants = count(self.plants.len(), "plant", "plants");
        let [entries, used] = [self.entries, self.used].map(say::grouped);
        out.push(format!("  {plants}; {used} of {entries} entries used"));
        for plant in self.plants.iter().take(LISTED) {
            let m = &plant.measures;
            let axes = count(plant.axes, "axis", "axes");
            let nodes = count(plant.nodes, "node", "nodes");
            let organs = count(plant.organs, "organ", "organs");
            let dbh = m.dbh_m.map_or_else(String::new, |d| format!(", DBH {} m", short(d)));
            let name = &plant.name;
            out.push(format!(
                "  {name}: {axes}, {nodes}, {organs}, up to order {}",
                m.orders.len().saturating_sub(1)
            ));
            let [height, volume, length, area] =
                [m.height_m, m.wood_volume_m3, m.length_m, m.leaf_area_m2].map(short);
            out.push(format!(
                "    {height} m high{dbh}, {volume} m3 of wood in {length} m of branches, {area} m2 of leaves"
            ));
        }
        if self.plants.len() > LISTED {
            out.push(format!("  and {} more", say::grouped((self.plants.len() - LISTED) as u64)));
        }
    }
}

/// Counts over all drawings of a file, and the first of them.
#[derive(Default, Serialize)]
struct Drawings {
    count: usize,
    strokes: usize,
    points: usize,
    failed: usize,
    first: Vec<DrawingSummary>,
    /// For a project: its plants and their makers.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    plants: Vec<PlantInfo>,
    warnings: Vec<String>,
}

/// One plant of a project.
#[derive(Serialize)]
struct PlantInfo {
    name: String,
    maker: &'static str,
    seed: u64,
    position_m: [f64; 3],
}

fn drawings(path: &Path, input: files::Input, format: DrawingFormat) -> Outcome<Drawings> {
    let mut out = Drawings::default();
    let mut first_error = None;
    for item in read_drawings(input, format, &files::stem(path)) {
        match item {
            Ok(read) => {
                out.add(DrawingSummary::from_drawing(&read.drawing, &read.warnings));
            }
            Err(e) => {
                out.failed += 1;
                out.warnings.push(e.to_string());
                first_error.get_or_insert(e);
            }
        }
        out.warnings.truncate(WARNINGS);
    }
    match first_error {
        Some(e) if out.count == 0 => Err(Failure::bad_file(path, e)),
        None if out.count == 0 => Err(Failure::bad_file(path, "holds no drawing")),
        _ => Ok(out),
    }
}

impl Drawings {
    fn add(&mut self, mut summary: DrawingSummary) {
        self.count += 1;
        self.strokes += summary.strokes;
        self.points += summary.points;
        if summary.not_finite > 0 {
            let points = say::counted(summary.not_finite as u64, "point is", "points are");
            summary.warnings.push(format!("{points} not finite"));
        }
        self.warnings.extend(summary.warnings.iter().map(|w| format!("{}: {w}", summary.name)));
        if self.first.len() < LISTED {
            self.first.push(summary);
        }
    }

    fn lines(&self, out: &mut Vec<String>) {
        let count = |n: usize, one, many| say::counted(n as u64, one, many);
        if self.plants.len() > 1 || self.count == 0 {
            out.extend(self.plants.iter().map(|p| format!("  {}: {}, seed {}", p.name, p.maker, p.seed)));
        }
        if self.count > 1 || self.failed > 0 {
            let drawings = count(self.count, "drawing", "drawings");
            let strokes = count(self.strokes, "stroke", "strokes");
            out.push(format!("  {drawings}, {strokes}, {}", count(self.points, "point", "points")));
        }
        out.extend(self.first.iter().map(drawing_line));
        if self.count > self.first.len() {
            out.push(format!("  and {} more", say::grouped((self.count - self.first.len()) as u64)));
        }
        if self.failed > 0 {
            out.push(format!("  {} cannot be read", count(self.failed, "drawing", "drawings")));
        }
    }
}

fn drawing_line(d: &DrawingSummary) -> String {
    let strokes = say::counted(d.strokes as u64, "stroke", "strokes");
    let points = say::counted(d.points as u64, "point", "points");
    let (w, h) = (short(d.max[0] - d.min[0]), short(d.max[1] - d.min[1]));
    let extras = [
        (d.modes[1] > 0, "branch contours"),
        (d.modes[2] > 0, "leaf contours"),
        (d.times, "times"),
        (d.pressures, "pressure"),
    ];
    let extras: Vec<&str> = extras.iter().filter(|e| e.0).map(|e| e.1).collect();
    let extras = if extras.is_empty() { String::new() } else { format!(", with {}", extras.join(", ")) };
    format!("  {}: {strokes}, {points}, {w} x {h} units of the file{extras}", d.name)
}

// About four digits, whatever the size.
fn short(x: f64) -> String {
    match x.abs() {
        a if a == 0.0 || (0.001..1e6).contains(&a) => {
            let digits = if a >= 100.0 { 1 } else { 4 };
            let text = format!("{x:.digits$}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        _ => format!("{x:.3e}"),
    }
}

fn model_lines(m: &ModelSummary, out: &mut Vec<String>) {
    let count = |n: usize, one, many| say::counted(n as u64, one, many);
    let triangles = count(m.triangles, "triangle", "triangles");
    out.push(format!("  {}, {triangles}", count(m.vertices, "vertex", "vertices")));
    let [w, h, d] = m.size.map(short);
    out.push(format!("  {w} m wide (x), {h} m high (y), {d} m deep (z); {} up", m.up));
    let [low, high] = [m.min, m.max].map(|p| p.map(short).join(", "));
    out.push(format!("  from ({low}) to ({high})"));
    for part in &m.parts {
        let columns = [(part.uvs, "texture coordinates"), (part.colors, "colours"), (part.wind, "wind")];
        let columns: Vec<&str> = columns.iter().filter(|c| c.0).map(|c| c.1).collect();
        let with = if columns.is_empty() { String::new() } else { format!(", {}", columns.join(", ")) };
        let triangles = count(part.triangles, "triangle", "triangles");
        out.push(format!("  part {}: {triangles}{with}, material {}", part.name, part.material));
    }
    for material in &m.materials {
        let texture = material.texture.map_or_else(String::new, |[w, h]| format!(", texture {w}x{h}"));
        let sides = if material.double_sided { ", double-sided" } else { "" };
        out.push(format!("  material {}: {}{texture}{sides}", material.name, material.kind));
    }
}

impl Info {
    fn lines(&self) -> Vec<String> {
        let bytes =
            self.bytes.map_or_else(String::new, |n| format!(", {}", say::counted(n, "byte", "bytes")));
        let mut out = vec![format!("{}: {}{bytes}", self.path, self.format)];
        let warnings = match &self.content {
            Content::Model(m) => {
                model_lines(m, &mut out);
                &m.warnings
            }
            Content::Drawings(d) => {
                d.lines(&mut out);
                &d.warnings
            }
            Content::Cloud(c) => {
                c.lines(&mut out);
                &c.warnings
            }
            Content::Structure(s) => {
                s.lines(&mut out);
                &s.warnings
            }
        };
        out.extend(warnings.iter().map(|w| format!("  warning: {w}")));
        out
    }
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_are_short() {
        let got = [0.0, 12.5, 1234.56, -0.25, 1e300, 1e-9].map(short);
        assert_eq!(got, ["0", "12.5", "1234.6", "-0.25", "1.000e300", "1.000e-9"]);
    }
}
