//! Tables of cylinders -> cylinders: `TreeQSM` and rTwig, `SimpleForest`, ours.

use std::collections::BTreeMap;

use base::Report;
use glam::DVec3;
use plant::AxisKind;

use super::cylinders::{Cylinder, joined};
use super::joints::{Built, Link, build};
use super::{Fault, Inward, LIMITS, StructureSpec, fault_at, place_of};
use crate::error::FileFault;

/// Content of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    Radius,
    Length,
    /// A coordinate, 0 to 2.
    Start(usize),
    Axis(usize),
    End(usize),
    Id,
    Parent,
    Extension,
    Branch,
    StartRadius,
    EndRadius,
    Other,
}

/// Columns of the text that `TreeQSM` saves without a head.
const BARE: [Column; 14] = [
    Column::Radius,
    Column::Length,
    Column::Start(0),
    Column::Start(1),
    Column::Start(2),
    Column::Axis(0),
    Column::Axis(1),
    Column::Axis(2),
    Column::Parent,
    Column::Extension,
    Column::Branch,
    Column::Other,
    Column::Other,
    Column::Other,
];

/// Separator of the cells of a line.
#[derive(Clone, Copy, Debug)]
enum Separator {
    Char(char),
    Space,
}

impl Separator {
    fn detect(line: &str) -> Self {
        let found = [';', '\t', ','].into_iter().find(|&c| line.contains(c));
        found.map_or(Self::Space, Self::Char)
    }

    fn split(self, line: &str) -> Vec<&str> {
        match self {
            Self::Char(c) => line.split(c).map(|cell| cell.trim().trim_matches('"').trim()).collect(),
            Self::Space => line.split_whitespace().map(|cell| cell.trim_matches('"')).collect(),
        }
    }

    /// Parses a number; it may have a decimal comma if commas do not separate cells.
    fn number(self, text: &str) -> Option<f64> {
        let point = !matches!(self, Self::Char(',')) && !text.contains('.') && text.contains(',');
        let parsed = if point { text.replacen(',', ".", 1).parse() } else { text.parse() };
        parsed.ok().filter(|x: &f64| x.is_finite())
    }
}

/// Returns the columns of a head; one that stands for three coordinates gives three.
fn columns(line: &str) -> Vec<Column> {
    let mut out = Vec::new();
    for cell in Separator::detect(line).split(line) {
        let bare = cell.split(['(', '[']).next().unwrap_or("");
        let word: String = bare.chars().filter(char::is_ascii_alphanumeric).collect();
        match &*word.to_ascii_lowercase() {
            "startpoint" => out.extend([0, 1, 2].map(Column::Start)),
            "axisdirection" => out.extend([0, 1, 2].map(Column::Axis)),
            word => {
                let column = column(word);
                // R repeats some columns under other names.
                let again = column != Column::Other && out.contains(&column);
                out.push(if again { Column::Other } else { column });
            }
        }
    }
    out
}

fn column(word: &str) -> Column {
    match word {
        "radius" | "radiuscyl" => Column::Radius,
        "length" => Column::Length,
        "startx" => Column::Start(0),
        "starty" => Column::Start(1),
        "startz" => Column::Start(2),
        "axisx" => Column::Axis(0),
        "axisy" => Column::Axis(1),
        "axisz" => Column::Axis(2),
        "endx" => Column::End(0),
        "endy" => Column::End(1),
        "endz" => Column::End(2),
        "id" | "cylid" | "cylinderid" => Column::Id,
        "parent" | "parentid" => Column::Parent,
        "extension" | "extensionid" => Column::Extension,
        "branch" | "branchid" | "axisid" => Column::Branch,
        "startradius" => Column::StartRadius,
        "endradius" => Column::EndRadius,
        _ => Column::Other,
    }
}

/// Returns whether a line is the head of such a table.
pub(super) fn is_head(line: &str) -> bool {
    let columns = columns(line);
    [Column::Radius, Column::Start(0), Column::Parent].iter().all(|c| columns.contains(c))
}

/// Returns whether a line belongs to a table without a head.
fn is_bare(line: &str) -> bool {
    let separator = Separator::detect(line);
    let cells = separator.split(line);
    cells.len() >= BARE.len() && cells.iter().all(|c| separator.number(c).is_some())
}

/// A row of the file.
struct Row {
    id: i64,
    parent: Option<i64>,
    extension: Option<i64>,
    branch: Option<i64>,
    ends: [DVec3; 2],
    radius: Option<f64>,
    end_radii: Option<[f64; 2]>,
    line: usize,
}

/// Reads a table of cylinders.
pub(super) fn read(text: &str, spec: &StructureSpec, report: &mut Report) -> Result<Built, Fault> {
    let inward = Inward::new(spec, (None, None));
    let lines = text.lines().enumerate().map(|(k, l)| (k + 1, l.trim()));
    let mut lines = lines.filter(|(_, l)| !l.is_empty() && !l.starts_with('#'));
    let (first_line, first) = lines.next().ok_or((0, FileFault::Empty))?;
    let has_head = !is_bare(first);
    let table = Table::new(
        if has_head { columns(first) } else { BARE.to_vec() },
        Separator::detect(first),
        first_line,
    )?;
    let (mut rows, mut left_out) = (Vec::new(), 0_u64);
    if has_head {
        // The head is not a row.
    } else {
        rows.push(table.row(first, first_line, 0)?);
        report.warn(
            "table-without-head",
            "the table has no head: its columns were taken for those of TreeQSM's text (radius, length, start, axis, parent, \
             extension, branch)",
        );
    }
    for (number, line) in lines {
        if !has_head && !is_bare(line) {
            left_out += 1;
            continue;
        }
        let row = table.row(line, number, rows.len())?;
        rows.push(row);
        if rows.len() > LIMITS.joints {
            let (what, advice) = ("the number of rows", "split the table into one for each tree");
            return Err((number, FileFault::TooMuch { what, limit: LIMITS.joints as u64, advice }));
        }
    }
    if left_out > 0 {
        base::warn!(
            report,
            "rows-left-out",
            { rows = left_out },
            "{rows} rows are no cylinders and were left out"
        );
    }
    let cylinders = cylinders(&table, &rows, &inward)?;
    let (joints, ends) = joined(&cylinders)?;
    let mut built = build(&joints)?;
    built.tally.entries = rows.len() as u64 + left_out;
    built.tally.used = ends.iter().filter(|&&j| built.nodes[j].is_some()).count() as u64;
    Ok(built)
}

struct Table {
    /// Positions of the columns that are read.
    places: Vec<(Column, usize)>,
    separator: Separator,
    has_id: bool,
    has_branch: bool,
    has_extension: bool,
    has_end: bool,
}

impl Table {
    fn new(columns: Vec<Column>, separator: Separator, line: usize) -> Result<Self, Fault> {
        let has = |column: Column| columns.contains(&column);
        let all = |of: fn(usize) -> Column| (0..3).all(|k| has(of(k)));
        let has_end = all(Column::End);
        let missing = [
            ("radius", has(Column::Radius)),
            ("start_x, start_y, start_z", all(Column::Start)),
            (
                "end_x to end_z, or axis_x to axis_z and length",
                has_end || (all(Column::Axis) && has(Column::Length)),
            ),
            ("parent", has(Column::Parent)),
        ];
        if let Some((name, _)) = missing.iter().find(|(_, there)| !there) {
            let advice = "a table of cylinders begins with a line of such names, as TreeQSM, rTwig or SimpleForest write it";
            return Err(fault_at(line, format!("there is no column {name}"), advice));
        }
        let [has_id, has_branch, has_extension] = [Column::Id, Column::Branch, Column::Extension].map(has);
        let places = columns.into_iter().enumerate().filter(|(_, c)| *c != Column::Other);
        let places = places.map(|(at, column)| (column, at)).collect();
        Ok(Self { places, separator, has_id, has_branch, has_extension, has_end })
    }

    fn row(&self, line: &str, number: usize, before: usize) -> Result<Row, Fault> {
        let cells = self.separator.split(line);
        let of = |wanted: Column| {
            let (_, at) = self.places.iter().find(|(c, _)| *c == wanted)?;
            self.separator.number(cells.get(*at)?)
        };
        let triple = |of_axis: fn(usize) -> Column| [0, 1, 2].map(|k| of(of_axis(k)));
        let advice = "give every cylinder a place: three numbers for its start, and for its end or its axis and length";
        let nowhere =
            |what: &str| fault_at(number, format!("the {what} of the cylinder is no place"), advice);
        let start = place_of(triple(Column::Start)).ok_or_else(|| nowhere("start"))?;
        let end = if self.has_end {
            place_of(triple(Column::End)).ok_or_else(|| nowhere("end"))?
        } else {
            let axis = place_of(triple(Column::Axis)).ok_or_else(|| nowhere("axis"))?;
            let long = of(Column::Length).filter(|l| (0.0..LIMITS.farthest).contains(l));
            let long =
                long.ok_or_else(|| fault_at(number, "the length of the cylinder is no length", advice))?;
            start + axis.normalize_or_zero() * long
        };
        // Ids are row names of R, and `NA` stands for none.
        #[expect(clippy::cast_possible_truncation, reason = "whole and small enough")]
        let whole = |c: Column| of(c).filter(|x| x.abs() < 9e15 && x.fract() == 0.0).map(|x| x as i64);
        let id = if self.has_id {
            let what = "the number (id) of the cylinder is no whole number";
            whole(Column::Id)
                .ok_or_else(|| fault_at(number, what, "give each cylinder a number of its own"))?
        } else {
            before as i64 + 1
        };
        let end_radii = of(Column::StartRadius).zip(of(Column::EndRadius)).map(|(a, b)| [a, b]);
        Ok(Row {
            id,
            parent: whole(Column::Parent),
            extension: whole(Column::Extension),
            branch: whole(Column::Branch),
            ends: [start, end],
            radius: of(Column::Radius),
            end_radii,
            line: number,
        })
    }
}

fn cylinders(table: &Table, rows: &[Row], inward: &Inward) -> Result<Vec<Cylinder>, Fault> {
    let mut places: BTreeMap<i64, usize> = BTreeMap::new();
    for (k, row) in rows.iter().enumerate() {
        if places.insert(row.id, k).is_some() {
            let what = format!("the cylinder {} is there twice", row.id);
            return Err(fault_at(row.line, what, "each cylinder has a number of its own"));
        }
    }
    // Rows count from 1 with 0 for none; if -1 stands for none, they count from 0.
    let from_zero = !table.has_id && rows.iter().any(|r| r.parent == Some(-1));
    let shift = i64::from(from_zero);
    let is_none = |id: i64| id < 0 || (id == 0 && !from_zero && !places.contains_key(&0));
    let mut out = Vec::with_capacity(rows.len());
    for row in rows {
        let parent = match row.parent {
            None => None,
            Some(id) if is_none(id) => None,
            Some(id) => Some(*places.get(&(id + shift)).ok_or_else(|| {
                let what = format!("the cylinder {id}, on which it hangs, is not in the table");
                fault_at(row.line, what, "name a cylinder of the table, or 0 for what stands on the ground")
            })?),
        };
        // SimpleForest's first cylinder may hang on itself.
        let parent = parent.filter(|&p| rows[p].id != row.id);
        let link = parent.map_or(Link::Unsaid, |p| {
            let goes_on = if table.has_extension {
                Some(rows[p].extension.is_some_and(|e| e + shift == row.id))
            } else {
                (table.has_branch).then(|| rows[p].branch == row.branch)
            };
            goes_on.map_or(Link::Unsaid, |goes_on| if goes_on { Link::Follows } else { Link::Branches })
        });
        let end_radii = row.end_radii.map(|radii| radii.map(|r| inward.radius(Some(r))));
        out.push(Cylinder {
            ends: row.ends.map(|p| inward.place(p)),
            radius: inward.radius(row.radius),
            end_radii: end_radii.filter(|radii| radii.iter().all(|r| !r.is_nan())),
            parent,
            link,
            kind: AxisKind::Branch,
            line: row.line,
        });
    }
    Ok(out)
}
