//! Plant -> multiscale tree graph (Godin and Caraglio 1998), as `AMAPmod` and `OpenAlea` read it.

use std::io::Write;

use glam::DVec3;
use plant::{AxisId, AxisKind, Organ, OrganKind, Plant, Shape};

use super::{AddedColumn, Borne, Subject, decimal, length, micrometres, numbered, place, turn};
use crate::{ExportSpec, WriteError};

/// Symbols of the borne vertices: nodes and the kinds of organs.
const BORNE: [char; 13] = ['N', 'L', 'K', 'E', 'D', 'F', 'U', 'B', 'S', 'H', 'C', 'T', 'Q'];

/// Columns of numbers and words after the code.
const FEATURES: [(&str, &str); 15] = [
    ("Kind", "ALPHA"),
    ("XX", "REAL"),
    ("YY", "REAL"),
    ("ZZ", "REAL"),
    ("BotDia", "REAL"),
    ("TopDia", "REAL"),
    ("Length", "REAL"),
    ("Area", "REAL"),
    ("Flower", "INT"),
    ("DX", "REAL"),
    ("DY", "REAL"),
    ("DZ", "REAL"),
    ("NX", "REAL"),
    ("NY", "REAL"),
    ("NZ", "REAL"),
];

/// Writes a sound plant as MTG text (FORM-A): the plant `P`, its axes `A`, their nodes `N` and organs (`L` leaf, `K`
/// petal, `D` disc, `E` sepal, `F` floret, `H` anther, `U` fruit, `B` body, `S` stamen, `C` pistil, `T` thorn, `Q`
/// pedicel).
///
/// A node has its position (`XX`, `YY`, `ZZ`) and the diameter there (`TopDia`); the first node of a borne axis has
/// the diameter at the axis's base, too (`BotDia`), and is the axis's second point: the first lies at the bearer.
/// Organs have their root's position, length, one-sided area, direction (`DX` to `DZ`) and upper side (`NX` to `NZ`).
/// Lengths are in `spec`'s unit, to a micrometre; areas in its square. Not written: the outlines of blades, colours,
/// strokes. Cost: linear.
///
/// # Errors
/// [`WriteError::Io`].
///
/// ```
/// use glam::DVec3;
/// let mut p = plant::Plant::default();
/// p.add_axis(plant::AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
/// let mut out = Vec::new();
/// formats::write_mtg(&p, &formats::ExportSpec::default(), &mut out)?;
/// assert!(String::from_utf8(out)?.contains("\n\t^<N2"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn write_mtg(plant: &Plant, spec: &ExportSpec, out: impl Write) -> Result<(), WriteError> {
    write_mtg_with(plant, &[], spec, out)
}

/// Writes as [`write_mtg`] does, with further features of axes and organs.
pub(super) fn write_mtg_with(
    plant: &Plant,
    added: &[AddedColumn],
    spec: &ExportSpec,
    out: impl Write,
) -> Result<(), WriteError> {
    let borne = Borne::from_plant(plant);
    let deepest = plant.axes.iter().map(|a| a.order as usize).max().unwrap_or(0);
    // Columns of the code: the plant, an axis of each order, and the vertices that the last of them bear.
    let areas = plant.shapes.iter().map(Shape::one_side_m2).collect();
    let mut writer = Writer { plant, added, spec, out, columns: deepest + 3, areas };
    writer.head()?;
    writer.line(0, "/P1", &Row::default())?;
    for (id, _) in numbered(plant).filter(|(id, _)| plant.axis(*id).bearer.is_none()) {
        writer.tree(id, &borne)?;
    }
    let lone = plant.organs.iter().enumerate().filter(|(_, o)| o.bearer.is_none());
    for ((i, organ), k) in lone.zip(plant.axes.len() + 1..) {
        // An organ must belong to an axis, so each organ without a bearer gets one of its own.
        writer.line(1, &format!("/A{k}"), &Row::kind("none"))?;
        writer.organ(1, "^/", i, organ)?;
    }
    Ok(())
}

/// Features of one line; empty ones are left out.
#[derive(Default)]
struct Row {
    kind: &'static str,
    at: Option<DVec3>,
    base: Option<f64>,
    top: Option<f64>,
    length: Option<f64>,
    area: Option<f64>,
    flower: Option<u32>,
    along: Option<DVec3>,
    normal: Option<DVec3>,
    subject: Option<Subject>,
}

impl Row {
    fn kind(kind: &'static str) -> Self {
        Self { kind, ..Self::default() }
    }
}

struct Writer<'a, W> {
    plant: &'a Plant,
    added: &'a [AddedColumn],
    spec: &'a ExportSpec,
    out: W,
    columns: usize,
    /// Area of one side of each shape, square metres, at scale 1.
    areas: Vec<f64>,
}

/// An axis that is being written, and the progress.
struct Frame {
    axis: AxisId,
    /// Index of its next node.
    node: usize,
    /// Axes on the last node that are still to be written.
    waiting: Vec<AxisId>,
}

impl<W: Write> Writer<'_, W> {
    fn head(&mut self) -> Result<(), WriteError> {
        let up = match self.spec.up {
            base::UpAxis::Y => 'Y',
            base::UpAxis::Z => 'Z',
        };
        let out = &mut self.out;
        writeln!(out, "# Burgeon {}", env!("CARGO_PKG_VERSION"))?;
        writeln!(
            out,
            "# Lengths in {} and {up} upwards. TopDia is the diameter at a node",
            self.spec.unit.plural()
        )?;
        writeln!(out, "CODE:\tFORM-A\n\nCLASSES:\nSYMBOL\tSCALE\tDECOMPOSITION\tINDEXATION\tDEFINITION")?;
        writeln!(out, "$\t0\tFREE\tFREE\tIMPLICIT\nP\t1\tFREE\tFREE\tEXPLICIT\nA\t2\tFREE\tFREE\tEXPLICIT")?;
        for symbol in BORNE {
            writeln!(out, "{symbol}\t3\tFREE\tFREE\tEXPLICIT")?;
        }
        writeln!(out, "\nDESCRIPTION:\nLEFT\tRIGHT\tRELTYPE\tMAX\nA\tA\t+\t?")?;
        let borne = BORNE.map(String::from).join(",");
        writeln!(out, "N\tN\t<\t1\nN\t{borne}\t+\t?\n\nFEATURES:\nNAME\tTYPE")?;
        for (name, kind) in FEATURES {
            writeln!(out, "{name}\t{kind}")?;
        }
        for column in self.added {
            writeln!(out, "{}\tREAL", column.name)?;
        }
        write!(out, "\nMTG:\nENTITY-CODE{}", "\t".repeat(self.columns))?;
        let own = FEATURES.iter().map(|(name, _)| *name);
        let names: Vec<&str> = own.chain(self.added.iter().map(|c| c.name.as_str())).collect();
        Ok(writeln!(out, "{}", names.join("\t"))?)
    }

    fn line(&mut self, column: usize, code: &str, row: &Row) -> Result<(), WriteError> {
        let spec = self.spec;
        let long = |x: Option<f64>| x.map(|x| micrometres(spec, length(spec, x))).unwrap_or_default();
        let unit = |v: Option<DVec3>| {
            v.map_or_else(Default::default, |v| turn(spec, v).to_array().map(|x| decimal(x, 6)))
        };
        let at =
            row.at.map_or_else(Default::default, |p| place(spec, p).to_array().map(|x| micrometres(spec, x)));
        let area = row.area.map(|a| decimal(length(spec, length(spec, a)), 9)).unwrap_or_default();
        let flower = row.flower.map(|f| f.to_string()).unwrap_or_default();
        let (dir, up): ([String; 3], [String; 3]) = (unit(row.along), unit(row.normal));
        let at: [String; 3] = at;
        let (before, after) = ("\t".repeat(column), "\t".repeat(self.columns - column));
        let mut text = format!("{before}{code}{after}{}", row.kind);
        let numbers =
            at.iter().cloned().chain([long(row.base), long(row.top), long(row.length), area, flower]);
        let added = self.added.iter().map(|column| column.cell(row.subject));
        for cell in numbers.chain(dir).chain(up).chain(added) {
            text.push('\t');
            text.push_str(&cell);
        }
        Ok(writeln!(self.out, "{}", text.trim_end_matches('\t'))?)
    }

    /// Writes an axis that stands on the ground and all that it bears; with an explicit stack, as the orders may be
    /// many.
    fn tree(&mut self, root: AxisId, borne: &Borne) -> Result<(), WriteError> {
        let mut stack: Vec<Frame> = Vec::new();
        self.open(root, 1, "/", &mut stack)?;
        while let Some(frame) = stack.last_mut() {
            if let Some(child) = frame.waiting.pop() {
                let column = stack.len() + 1;
                self.open(child, column, "+", &mut stack)?;
                continue;
            }
            let axis = self.plant.axis(frame.axis);
            let Some(node) = axis.node_ids().nth(frame.node) else {
                stack.pop();
                continue;
            };
            let first = if axis.bearer.is_some() { 1 } else { 0 };
            // Numbered so that node k of every axis is its k-th point after the bearer.
            let code = if frame.node == first {
                format!("^/N{}", frame.node + 1 - first)
            } else {
                format!("^<N{}", frame.node + 1 - first)
            };
            let borne_base = (first == 1 && frame.node == 1).then_some(axis.nodes.start as usize);
            frame.node += 1;
            frame.waiting = Borne::on(&borne.axes, node).collect();
            frame.waiting.reverse();
            let column = stack.len();
            let row = Row {
                at: Some(self.plant.nodes.position[node.index()]),
                base: borne_base.map(|b| 2.0 * self.plant.nodes.radius_m[b]),
                top: Some(2.0 * self.plant.nodes.radius_m[node.index()]),
                ..Row::default()
            };
            self.line(column, &code, &row)?;
            for organ in Borne::on(&borne.organs, node) {
                self.organ(column + 1, "+", organ, &self.plant.organs[organ])?;
            }
        }
        Ok(())
    }

    fn open(
        &mut self,
        id: AxisId,
        column: usize,
        edge: &str,
        stack: &mut Vec<Frame>,
    ) -> Result<(), WriteError> {
        let axis = self.plant.axis(id);
        let kind = match axis.kind {
            AxisKind::Branch if axis.order == 0 => "trunk",
            AxisKind::Branch => "branch",
            AxisKind::Twig => "twig",
            AxisKind::Stem => "stem",
            AxisKind::Petiole => "petiole",
            AxisKind::Root => "root",
            AxisKind::Stub => "stub",
            _ => "axis",
        };
        stack.push(Frame { axis: id, node: usize::from(axis.bearer.is_some()), waiting: Vec::new() });
        let row = Row { subject: Some(Subject::Axis(id.index())), ..Row::kind(kind) };
        self.line(column, &format!("{edge}A{}", id.index() + 1), &row)
    }

    fn organ(&mut self, column: usize, edge: &str, row: usize, organ: &Organ) -> Result<(), WriteError> {
        let (symbol, kind) = match organ.kind {
            OrganKind::Petal => ('K', "petal"),
            OrganKind::Disc => ('D', "disc"),
            OrganKind::Fruit | OrganKind::Syncarp => ('U', "fruit"),
            OrganKind::Stamen => ('S', "stamen"),
            OrganKind::Pistil => ('C', "pistil"),
            OrganKind::Sepal => ('E', "sepal"),
            OrganKind::Anther => ('H', "anther"),
            OrganKind::Floret => ('F', "floret"),
            OrganKind::Body => ('B', "body"),
            OrganKind::Pot => ('O', "pot"),
            OrganKind::Thorn => ('T', "thorn"),
            OrganKind::Pedicel => ('Q', "pedicel"),
            _ => ('L', "leaf"),
        };
        let long = self.plant.shapes[organ.shape.index()].length();
        let features = Row {
            kind,
            at: Some(organ.frame.origin),
            length: long.map(|l| l * organ.scale),
            area: Some(self.areas[organ.shape.index()] * organ.scale * organ.scale),
            flower: organ.flower.map(|f| f.raw() + 1),
            along: Some(organ.frame.along),
            normal: Some(organ.frame.normal),
            subject: Some(Subject::Organ(row)),
            ..Row::default()
        };
        self.line(column, &format!("{edge}{symbol}{}", row + 1), &features)
    }
}
