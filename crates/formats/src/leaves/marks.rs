//! Marks of a leaf as CSV: one line a mark, in any order.

use std::collections::BTreeMap;
use std::io::{Read, Write};

use base::{Unit, UpAxis, Warning};
use glam::DVec3;
use leaf::{MARKS_A_ROW, MarkRow, Marks, ThicknessRule};

use super::LeafFileError;
use super::fields::Fields;
use crate::error::{FileFault, Place, WriteError};

// Most rows, more side veins than any leaf has; keeps a slip such as row 1000000 from filling memory.
const MAX_ROWS: usize = 10_000;
// Most points of the margin: a point every tenth of a millimetre round a leaf of a metre.
const MAX_MARGIN: usize = 20_000;
/// The row in the key of a point of the margin.
const MARGIN: usize = usize::MAX;

/// Unit and up axis of a file that does not give them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MarksAxes {
    /// Unit of coordinates and thickness.
    pub unit: Unit,
    /// The axis that points up.
    pub up: UpAxis,
}

/// Contents of a file of marks.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadMarks {
    /// The leaf's name in the file, or the one given to the reader.
    pub name: String,
    /// The marks in metres, +Y up.
    pub marks: Marks,
    /// Meaning of the thickness, if the file gives it.
    pub thickness: Option<ThicknessRule>,
    /// Unit and up axis that were used: the file's, or those given to the reader.
    pub axes: MarksAxes,
    /// The file gives its unit; if not, that of the reader was used.
    pub is_unit_said: bool,
    /// Warnings of the reader.
    pub warnings: Vec<Warning>,
}

/// The columns of a line, by name.
#[derive(Default)]
struct Columns {
    row: Option<usize>,
    mark: Option<usize>,
    axes: [Option<usize>; 3],
    thickness: Option<usize>,
    midrib: Option<usize>,
}

#[derive(Clone, Copy)]
struct Entry {
    line: usize,
    point: DVec3,
    thickness: Option<f64>,
    midrib: Option<f64>,
}

/// Reads marks: `row,mark,x,y,z,thickness,midrib`, one line a mark.
///
/// Rows count from 1 at the tip, marks from 1 (right margin) to 7 (left margin); the tip is a line whose row is
/// `tip`, or a row 0, or a first row of seven equal points. Rows `margin` are points of a separate margin, with marks
/// counted once round it; without them the margin is that of the rows' ends. `thickness` is the side vein's, `midrib`
/// the midrib's at mark 4 and at the tip; both may be empty. Fields are separated as those of the first line: by
/// commas, semicolons or tabs; with the latter two, numbers may have decimal commas.
/// Lines `# unit: mm`, `# up: z`, `# thickness: radius` and `# name: ...` describe the file and win over `axes`.
///
/// # Errors
/// [`LeafFileError`] with the line, for missing, repeated or extra marks, rows that are left out, cells that are not
/// numbers, and thickness that is not above 0.
pub fn read_marks(input: impl Read, name: &str, axes: MarksAxes) -> Result<ReadMarks, LeafFileError> {
    let file = |fault| LeafFileError::new(Place::File, fault);
    let text = super::text(input)?;
    let mut out = ReadMarks {
        name: name.into(),
        marks: Marks::default(),
        thickness: None,
        axes,
        is_unit_said: false,
        warnings: vec![],
    };
    let mut axes = axes;
    let mut columns: Option<(Fields, Columns)> = None;
    let mut entries: BTreeMap<(usize, usize), Entry> = BTreeMap::new();
    for (k, line) in text.lines().enumerate() {
        let line = line.trim_start_matches('\u{feff}').trim();
        if let Some(comment) = super::comment_of(line) {
            out.is_unit_said |= says_unit(comment);
            setting(comment, &mut axes, &mut out.name, &mut out.thickness)
                .map_err(|e| LeafFileError::new(Place::line(k + 1), e))?;
        } else if !super::is_blank(line) {
            let placed = |fault| LeafFileError::new(Place::line(k + 1), fault);
            match &columns {
                None => {
                    let fields = Fields::from_header(line);
                    columns = Some((fields, header(&fields.split(line)).map_err(placed)?));
                }
                Some((fields, columns)) => {
                    let (key, entry) = mark(columns, fields, line, k + 1).map_err(placed)?;
                    if let Some(first) = entries.insert(key, entry) {
                        let what = match key {
                            (MARGIN, m) => {
                                format!("margin, point {m} is given twice, first on line {}", first.line)
                            }
                            (0, _) => format!("the tip is given twice, first on line {}", first.line),
                            (r, m) => {
                                format!("row {r}, mark {m} is given twice, first on line {}", first.line)
                            }
                        };
                        return Err(placed(FileFault::malformed(what, "remove one of the two")));
                    }
                }
            }
        }
    }
    if columns.is_none() {
        return Err(file(FileFault::Empty));
    }
    gather(&entries, &mut out)?;
    out.axes = axes;
    orient(&mut out.marks, axes);
    for (row, mark, times) in out.marks.strays() {
        out.warnings.push(Warning {
            code: "mark-stray",
            message: format!(
                "row {row}, mark {mark} lies {times:.0} times as far from its neighbours as marks do here: was it entered \
                 wrongly?"
            ),
            fields: Vec::new(),
        });
    }
    let length = out.marks.length();
    // 2 mm to 10 m: from the smallest leaf that callipers can measure to that of a palm.
    if !(0.002..=10.0).contains(&length) {
        out.warnings.push(Warning {
            code: "leaf-size",
            message: format!(
                "the leaf is {length:.4} m long: is the unit right? Say it in the file (`# unit: mm`), or when you read it"
            ),
            fields: Vec::new(),
        });
    }
    out.warnings = base::gathered(out.warnings);
    Ok(out)
}

/// Returns whether a comment is `unit: ...`.
pub(super) fn says_unit(comment: &str) -> bool {
    comment.split_once(':').is_some_and(|(key, _)| key.trim().eq_ignore_ascii_case("unit"))
}

/// Reads `# key: value`; other comments are ignored.
pub(super) fn setting(
    comment: &str,
    axes: &mut MarksAxes,
    name: &mut String,
    rule: &mut Option<ThicknessRule>,
) -> Result<(), FileFault> {
    let Some((key, value)) = comment.split_once(':') else { return Ok(()) };
    let (key, value) = (key.trim().to_ascii_lowercase(), value.trim());
    let word = value.to_ascii_lowercase();
    let unknown = |advice| Err(FileFault::malformed(format!("`{key}: {value}` is not understood"), advice));
    match (key.as_str(), word.as_str()) {
        ("unit", word) => match Unit::from_word(word) {
            Some(unit) => axes.unit = unit,
            None => return unknown("a unit is m, cm or mm"),
        },
        ("up", word) => match UpAxis::from_word(word) {
            Some(up) => axes.up = up,
            None => return unknown("the axis that points up is y or z"),
        },
        ("thickness", "diameter") => *rule = Some(ThicknessRule::Diameter),
        ("thickness", "radius") => *rule = Some(ThicknessRule::Radius),
        ("thickness", _) => return unknown("a thickness is a diameter or a radius"),
        ("name", _) if !value.is_empty() => *name = value.chars().take(200).collect(),
        _ => {}
    }
    Ok(())
}

fn header(fields: &[&str]) -> Result<Columns, FileFault> {
    let mut columns = Columns::default();
    for (k, field) in fields.iter().enumerate() {
        let slot = match field.to_ascii_lowercase().as_str() {
            "row" => &mut columns.row,
            "mark" => &mut columns.mark,
            "x" => &mut columns.axes[0],
            "y" => &mut columns.axes[1],
            "z" => &mut columns.axes[2],
            "thickness" => &mut columns.thickness,
            "midrib" => &mut columns.midrib,
            _ => continue,
        };
        if slot.replace(k).is_some() {
            let what = format!("the column `{field}` is there twice");
            return Err(FileFault::malformed(what, "rename or remove one of them"));
        }
    }
    let needed = [
        ("row", columns.row),
        ("mark", columns.mark),
        ("x", columns.axes[0]),
        ("y", columns.axes[1]),
        ("z", columns.axes[2]),
    ];
    match needed.iter().find(|n| n.1.is_none()) {
        Some((name, _)) => Err(FileFault::malformed(
            format!("the first line has no column `{name}`"),
            "start with the line row,mark,x,y,z,thickness,midrib (docs/leaves.md has an example)",
        )),
        None => Ok(columns),
    }
}

/// Returns the place of a line's mark and its values. The tip is (0, 1).
fn mark(
    columns: &Columns,
    format: &Fields,
    text: &str,
    line: usize,
) -> Result<((usize, usize), Entry), FileFault> {
    let fields = format.row(text)?;
    let field = |column: Option<usize>| column.and_then(|k| fields.get(k)).copied().unwrap_or_default();
    let row = field(columns.row);
    let tip = row.eq_ignore_ascii_case("tip") || row == "0";
    let count = |text: &str, what: &str, most: usize, advice| match text.parse::<usize>() {
        Ok(n) if (1..=most).contains(&n) => Ok(n),
        _ => Err(FileFault::malformed(format!("`{text}` is no number of a {what}"), advice)),
    };
    let margin = row.eq_ignore_ascii_case("margin");
    let key = if tip {
        (0, 1)
    } else if margin {
        let advice = "points of the margin count from 1, once round the blade";
        (MARGIN, count(field(columns.mark), "point of the margin", MAX_MARGIN, advice)?)
    } else {
        let row =
            count(row, "row", MAX_ROWS, "rows count from 1 at the tip; the tip itself is the row `tip`")?;
        (
            row,
            count(
                field(columns.mark),
                "mark",
                MARKS_A_ROW,
                "a row has the marks 1 (right margin) to 7 (left)",
            )?,
        )
    };
    let number = |column: Option<usize>, what: &str| -> Result<Option<f64>, FileFault> {
        let text = field(column);
        if text.is_empty() {
            return Ok(None);
        }
        match format.number(text) {
            Some(x) => Ok(Some(x)),
            None => Err(FileFault::malformed(
                format!("{what} `{text}` is no finite number"),
                "write numbers like 12.5 (12,5 where semicolons separate the fields), or leave a thickness empty",
            )),
        }
    };
    let mut point = [0.0; 3];
    for (value, (column, what)) in point.iter_mut().zip(columns.axes.iter().zip(["x", "y", "z"])) {
        let missing = || FileFault::malformed(format!("{what} is missing"), "a mark needs x, y and z");
        *value = number(*column, what)?.ok_or_else(missing)?;
    }
    let above = |column, what: &str| match number(column, what)? {
        Some(t) if t <= 0.0 => Err(FileFault::malformed(
            format!("{what} is {t}, but must be above 0"),
            "leave it empty if it was not measured",
        )),
        other => Ok(other),
    };
    let thickness = above(columns.thickness, "the thickness")?;
    let midrib = above(columns.midrib, "the midrib's thickness")?;
    Ok((key, Entry { line, point: DVec3::from_array(point), thickness, midrib }))
}

fn gather(entries: &BTreeMap<(usize, usize), Entry>, out: &mut ReadMarks) -> Result<(), LeafFileError> {
    let fail =
        |what: String, advice| Err(LeafFileError::new(Place::File, FileFault::Malformed { what, advice }));
    let rows = entries.keys().map(|k| k.0).filter(|&r| r != MARGIN).max().unwrap_or(0);
    let margin = entries.range((MARGIN, 0)..).map(|(k, e)| (k.1, e));
    for (k, (point, entry)) in margin.enumerate() {
        if point != k + 1 {
            return fail(
                format!("the margin has no point {} (line {} is point {point})", k + 1, entry.line),
                "number the points of the margin from 1 without gaps",
            );
        }
        if entry.thickness.or(entry.midrib).is_some() {
            return fail(
                format!("margin, point {point} (line {}) has a thickness", entry.line),
                "a margin is a line: leave its thickness empty",
            );
        }
        out.marks.margin.push(entry.point);
    }
    for r in 1..=rows {
        let have = |m: usize| entries.get(&(r, m));
        let known = (1..=MARKS_A_ROW).filter(|&m| have(m).is_some()).count();
        if known == 0 {
            return fail(format!("row {r} is missing"), "number the rows from 1 without gaps");
        }
        let mut row = MarkRow::default();
        for m in 1..=MARKS_A_ROW {
            let Some(entry) = have(m) else {
                let what = format!("row {r} has {known} of {MARKS_A_ROW} marks: mark {m} is missing");
                return fail(what, "measure it, or leave the row out and number the others anew");
            };
            row.points[m - 1] = entry.point;
            row.thickness[m - 1] = entry.thickness;
            row.midrib = row.midrib.or(entry.midrib.filter(|_| m == MARKS_A_ROW / 2 + 1));
            if entry.midrib.is_some() && m != MARKS_A_ROW / 2 + 1 {
                let what = format!("row {r}, mark {m} (line {}) has a thickness of the midrib", entry.line);
                return fail(what, "only mark 4 lies on the midrib: move the value there");
            }
        }
        out.marks.rows.push(row);
    }
    let repeated = out.marks.rows.first().filter(|r| r.points.iter().all(|&p| p == r.points[0])).cloned();
    match (entries.get(&(0, 1)), repeated) {
        (Some(tip), Some(row)) if row.points[0] != tip.point => {
            return fail("row 1 is one point, but not the tip".into(), "give the tip once, as the row `tip`");
        }
        (tip, Some(row)) => {
            if tip.is_some() {
                let message = "row 1 repeats the tip and was left out; rows are numbered from the next one";
                out.warnings.push(Warning {
                    code: "tip-repeated",
                    message: message.into(),
                    fields: Vec::new(),
                });
            }
            out.marks.tip = row.points[0];
            out.marks.tip_thickness = tip.and_then(|t| t.midrib.or(t.thickness)).or(row.midrib);
            out.marks.rows.remove(0);
        }
        (Some(tip), None) => {
            out.marks.tip = tip.point;
            out.marks.tip_thickness = tip.midrib.or(tip.thickness);
        }
        (None, None) => {
            return fail(
                "the tip is missing".into(),
                "add a line  tip,,x,y,z  with the place of the leaf's tip",
            );
        }
    }
    if out.marks.rows.is_empty() {
        return fail(
            "there is no row of marks".into(),
            "measure 7 marks along each of at least 2 side veins",
        );
    }
    Ok(())
}

fn orient(marks: &mut Marks, axes: MarksAxes) {
    let unit = axes.unit.metres();
    let point = |p: DVec3| match axes.up {
        UpAxis::Y => p * unit,
        UpAxis::Z => DVec3::new(p.x, p.z, -p.y) * unit,
    };
    for row in &mut marks.rows {
        row.points = row.points.map(point);
        row.thickness = row.thickness.map(|t| t.map(|t| t * unit));
        row.midrib = row.midrib.map(|t| t * unit);
    }
    marks.tip = point(marks.tip);
    marks.margin.iter_mut().for_each(|p| *p = point(*p));
    marks.tip_thickness = marks.tip_thickness.map(|t| t * unit);
}

/// Writes marks as CSV in millimetres, +Z up, to a thousandth.
///
/// # Errors
/// [`WriteError::Io`].
pub fn write_marks(marks: &Marks, name: &str, mut out: impl Write) -> Result<(), WriteError> {
    let name: String = name.chars().filter(|c| !c.is_control()).collect();
    write!(out, "# burgeon leaf marks\n# name: {name}\n# unit: mm\n# up: z\n# thickness: diameter\n")?;
    out.write_all(b"row,mark,x,y,z,thickness,midrib\n")?;
    let place = |p: DVec3| format!("{:.3},{:.3},{:.3}", p.x * 1e3, -p.z * 1e3, p.y * 1e3);
    let thick = |t: Option<f64>| t.map_or_else(String::new, |t| format!("{:.4}", t * 1e3));
    writeln!(out, "tip,,{},,{}", place(marks.tip), thick(marks.tip_thickness))?;
    for (i, row) in marks.rows.iter().enumerate() {
        for (j, &p) in row.points.iter().enumerate() {
            let midrib = thick(row.midrib.filter(|_| j == MARKS_A_ROW / 2));
            writeln!(out, "{},{},{},{},{midrib}", i + 1, j + 1, place(p), thick(row.thickness[j]))?;
        }
    }
    for (k, &p) in marks.margin.iter().enumerate() {
        writeln!(out, "margin,{},{},,", k + 1, place(p))?;
    }
    Ok(())
}

/// Returns a file to fill in, with `rows` rows and instructions.
pub fn marks_template(rows: usize) -> String {
    let rows = rows.clamp(2, MAX_ROWS);
    let mut text = String::from(
        "# Marks of one leaf for `burgeon leaf`. Fill in the numbers; lines that start with # are notes.\n\
         # name: my leaf\n\
         # unit: mm\n\
         # up: z\n\
         # thickness: diameter\n\
         #\n\
         # Look at the upper side with the tip up. Row 1 is the pair of side veins nearest to the tip, the last row\n\
         # the lowest pair. Each row has 7 marks at equal distances along its veins, from the right margin (1) over\n\
         # the midrib (4) to the left margin (7). The tip is marked once.\n\
         # A margin with teeth may be given as well: lines  margin,1,x,y,z,,  counted once round the blade.\n\
         # Column thickness: of the side vein at the mark; at mark 4 where it leaves the midrib. Enough: marks 1 and 4.\n\
         # Column midrib: thickness of the midrib itself, at the tip and at mark 4 of each row.\n\
         # A thickness that was not measured stays empty and is interpolated.\n\
         row,mark,x,y,z,thickness,midrib\n\
         tip,,,,,,\n",
    );
    for row in 1..=rows {
        for mark in 1..=MARKS_A_ROW {
            text.push_str(&format!("{row},{mark},,,,,\n"));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Marks {
        let row = |y: f64| MarkRow {
            points: core::array::from_fn(|j| DVec3::new(0.03 - 0.01 * j as f64, 0.001 * j as f64, -y)),
            thickness: [Some(0.0004), None, None, Some(0.002), None, None, None],
            midrib: Some(0.006),
        };
        let rows = vec![row(0.08), row(0.04), row(0.0)];
        Marks { rows, tip: DVec3::new(0.0, 0.002, -0.12), tip_thickness: Some(0.001), margin: Vec::new() }
    }

    #[test]
    fn a_margin_comes_back_and_its_faults_name_the_point() {
        let corners = [[0.03, -0.001], [0.035, -0.05], [0.0, -0.12], [-0.035, -0.04], [-0.03, -0.001]];
        let margin = corners.map(|[x, z]| DVec3::new(x, 0.0, z)).to_vec();
        let marks = Marks { margin, ..sample() };
        let mut bytes = Vec::new();
        write_marks(&marks, "a leaf", &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let back = read(&text).unwrap().marks;
        assert_eq!(back.margin.len(), 5);
        assert!(back.margin.iter().zip(&marks.margin).all(|(a, b)| a.distance(*b) < 1e-6));
        let said = |text: &str| read(text).unwrap_err().to_string();
        assert!(said(&text.replace("margin,2,", "margin,7,")).contains("the margin has no point 2"));
        assert!(said(&text.replace("margin,2,", "margin,0,")).contains("count from 1"));
        assert!(said(&text.replace("margin,2,", "margin,1,")).contains("margin, point 1 is given twice"));
        let thick = text.replace("margin,5,-30.000,1.000,0.000,,", "margin,5,-30.000,1.000,0.000,0.1,");
        assert!(said(&thick).contains("margin, point 5"), "{thick}");
    }

    fn read(text: &str) -> Result<ReadMarks, LeafFileError> {
        read_marks(text.as_bytes(), "test", MarksAxes::default())
    }

    fn written() -> String {
        let mut bytes = Vec::new();
        write_marks(&sample(), "a leaf", &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn a_spreadsheet_may_save_the_template() {
        let padded = |text: &str| -> String {
            let line = |l: &str| {
                if l.starts_with('#') { format!("\"{l}\",,,,,,\n,,,,,,\n") } else { format!("{l}\n") }
            };
            text.lines().map(line).collect()
        };
        let back = read(&padded(&written())).unwrap();
        assert_eq!((back.name.as_str(), back.marks), ("a leaf", read(&written()).unwrap().marks));
    }

    #[test]
    fn marks_come_back_as_they_were_written() {
        let back = read(&written()).unwrap();
        assert_eq!((back.name.as_str(), back.thickness), ("a leaf", Some(ThicknessRule::Diameter)));
        assert_eq!(back.warnings, []);
        assert!(back.marks.tip.distance(sample().tip) < 1e-12);
        for (a, b) in back.marks.rows.iter().zip(&sample().rows) {
            assert!(a.points.iter().zip(b.points).all(|(p, q)| p.distance(q) < 1e-12));
            assert_eq!(a.thickness[1], None);
            assert!((a.midrib.unwrap() - 0.006).abs() < 1e-12);
        }
    }

    #[test]
    fn order_separator_and_extra_columns_do_not_matter() {
        let text = written();
        let mut lines: Vec<String> = text.lines().map(|l| l.replace(',', ";")).collect();
        let at = lines.iter().position(|l| l.starts_with("row")).unwrap();
        lines[at].push_str(";note");
        lines[at + 1..].reverse();
        let back = read(&format!("\u{feff}{}", lines.join("\r\n"))).unwrap();
        assert_eq!(back.marks, read(&text).unwrap().marks);
    }

    #[test]
    fn first_row_of_one_point_is_the_tip() {
        let tip = (1..=7).map(|m| format!("1,{m},0,120,2,,\n")).collect::<String>();
        let body: String = written()
            .lines()
            .filter(|l| !l.starts_with("tip"))
            .map(|l| match l.split_once(',') {
                Some((row, rest)) if row.parse::<u32>().is_ok() => {
                    format!("{},{rest}\n", row.parse::<u32>().unwrap() + 1)
                }
                _ => format!("{l}\n"),
            })
            .collect();
        let back = read(&(body.clone() + &tip)).unwrap();
        assert_eq!(back.marks.rows.len(), 3);
        assert!(back.marks.tip.distance(sample().tip) < 1e-12);
        let both = read(&(body + &tip + "tip,,0,120,2,,1\n")).unwrap();
        assert_eq!((both.warnings[0].code, both.marks.rows.len()), ("tip-repeated", 3));
    }

    #[test]
    fn bad_files_are_refused_with_place_and_advice() {
        let cases: Vec<(String, &str)> = vec![
            (String::new(), "empty"),
            ("row,mark,x,y\n".into(), "line 1: the first line has no column `z`"),
            ("row,mark,x,y,z,x\n".into(), "`x` is there twice"),
            (written() + "2,8,0,0,0,,\n", "`8` is no number of a mark"),
            (written() + "2,3,0,0,0,,\n", "row 2, mark 3 is given twice, first on line 17"),
            (written() + "tip,,0,0,0,,\n", "the tip is given twice, first on line 7"),
            (written() + "5,1,0,0,0,,\n", "row 4 is missing"),
            (written() + "4,1,0,0,0,,\n", "row 4 has 1 of 7 marks: mark 2 is missing"),
            (written() + "4,1,0,nan,0,,\n", "y `nan` is no finite number"),
            (written() + "4,1,0,,0,,\n", "y is missing"),
            (written() + "4,1,0,0,0,0,\n", "the thickness is 0, but must be above 0"),
            (written() + "4,1,0,0,0,-2,\n", "the thickness is -2, but must be above 0"),
            (written().replace("unit: mm", "unit: inch"), "line 3: `unit: inch` is not understood"),
            (written().replace("tip,,", "# "), "the tip is missing"),
            (marks_template(3), "x is missing"),
        ];
        for (text, want) in cases {
            let got = read(&text).unwrap_err().to_string();
            assert!(got.contains(want), "{got:?} does not say {want:?}");
        }
        assert!(read_marks(&b"row\xff\xfe"[..], "x", MarksAxes::default()).is_err());
    }

    #[test]
    fn damaged_files_never_panic() {
        let text = written();
        let mut stream = base::Seed::new(7).stream(base::Draw::Test);
        let odd = [b',', b'\n', b'-', b'0', b'9', b'e', b'#', b':', 0xff, b'\t'];
        let mut refused = 0;
        for _ in 0..2000 {
            let mut bytes = text.clone().into_bytes();
            for _ in 0..=stream.below(4) {
                if bytes.is_empty() {
                    break;
                }
                let at = stream.below(bytes.len());
                match stream.below(3) {
                    0 => bytes[at] = odd[stream.below(odd.len())],
                    1 => drop(bytes.remove(at)),
                    _ => bytes.truncate(at.max(1)),
                }
            }
            match read_marks(bytes.as_slice(), "x", MarksAxes::default()) {
                Ok(read) => drop(read.marks.complete(&mut base::Report::default())),
                Err(e) => refused += usize::from(!e.to_string().is_empty()),
            }
        }
        assert!(refused > 200, "{refused}");
    }

    #[test]
    fn leaf_of_an_odd_size_is_told() {
        let back = read(&written().replace("unit: mm", "unit: m")).unwrap();
        assert_eq!(back.warnings[0].code, "leaf-size");
    }
}
