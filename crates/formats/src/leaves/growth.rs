//! Growth tables as CSV: the size of organs by day, one line a measurement, in any order.

use std::io::Read;

use base::{Unit, Warning};

use super::LeafFileError;
use super::fields::Fields;
use crate::error::{FileFault, Place};

/// More measurements than anybody types.
const MOST: usize = 200_000;

/// One measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct GrowthEntry {
    /// The day, or the age in days.
    pub day: f64,
    /// The size, metres.
    pub size: f64,
    /// The organ: `leaf-3`, say; empty without that column.
    pub organ: String,
    /// The plant; empty without that column.
    pub plant: String,
}

/// What was in a growth table.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadGrowth {
    /// The measurements, in the order of the file.
    pub rows: Vec<GrowthEntry>,
    /// What was odd and what was done about it.
    pub warnings: Vec<Warning>,
}

/// Names that a column may have; the first is the one that messages use.
const DAY: [&str; 4] = ["day", "age", "time", "days"];
const SIZE: [&str; 7] = ["size", "length", "height", "width", "circumference", "diameter", "value"];
const ORGAN: [&str; 2] = ["organ", "leaf"];
const PLANT: [&str; 4] = ["plant", "tree", "id", "subject"];

/// Reads a growth table: `day,size[,organ][,plant]`, one line a measurement.
///
/// The first line names the columns, in any order; `day` may also be called age or time, `size` length, height, width,
/// circumference, diameter or value, `plant` tree or id. Other columns are left out with a warning. Fields are separated
/// as in [`read_marks`](crate::read_marks). A line `# unit: mm` wins over `unit`. Lines without a size are left out: a
/// day on which nothing was measured.
///
/// # Errors
/// [`LeafFileError`] with the line, for columns that are missing or there twice, numbers that are none, and sizes that
/// are negative.
pub fn read_growth(input: impl Read, mut unit: Unit) -> Result<ReadGrowth, LeafFileError> {
    let text = super::text(input)?;
    let mut columns: Option<(Fields, [Option<usize>; 4])> = None;
    let mut out = ReadGrowth { rows: vec![], warnings: vec![] };
    let mut empty = 0;
    for (k, line) in text.lines().enumerate() {
        let line = line.trim_start_matches('\u{feff}').trim();
        let placed = |fault| LeafFileError::new(Place::line(k + 1), fault);
        if let Some(comment) = line.strip_prefix('#') {
            unit = unit_of(comment).map_err(placed)?.unwrap_or(unit);
        } else if !line.is_empty() {
            let Some((fields, columns)) = &columns else {
                let fields = Fields::of_header(line);
                columns = Some((fields, header(&fields.split(line), &mut out.warnings).map_err(placed)?));
                continue;
            };
            match entry(fields, columns, line).map_err(placed)? {
                Some(row) => out.rows.push(row),
                None => empty += 1,
            }
            if out.rows.len() > MOST {
                let (what, limit, advice) = ("the number of measurements", MOST as u64, "split the table");
                return Err(placed(FileFault::TooMuch { what, limit, advice }));
            }
        }
    }
    if out.rows.is_empty() {
        return Err(LeafFileError::new(Place::File, FileFault::Empty));
    }
    if empty > 0 {
        let message = format!("{empty} lines have no size: they were left out");
        out.warnings.push(Warning { code: "size-missing", message, fields: Vec::new() });
    }
    let metres = match unit {
        Unit::Metre => 1.0,
        Unit::Centimetre => 0.01,
        Unit::Millimetre => 0.001,
    };
    out.rows.iter_mut().for_each(|r| r.size *= metres);
    Ok(out)
}

fn unit_of(comment: &str) -> Result<Option<Unit>, FileFault> {
    let Some((key, value)) = comment.split_once(':') else { return Ok(None) };
    if !key.trim().eq_ignore_ascii_case("unit") {
        return Ok(None);
    }
    let word = value.trim().to_ascii_lowercase();
    let unknown =
        || FileFault::malformed(format!("`unit: {word}` is not understood"), "a unit is m, cm or mm");
    Unit::from_word(&word).map(Some).ok_or_else(unknown)
}

fn header(fields: &[&str], warnings: &mut Vec<Warning>) -> Result<[Option<usize>; 4], FileFault> {
    let names: [&[&str]; 4] = [&DAY, &SIZE, &ORGAN, &PLANT];
    let mut columns = [None; 4];
    let mut others = Vec::new();
    for (k, field) in fields.iter().enumerate() {
        let word = field.trim_matches('"').to_ascii_lowercase();
        match names.iter().position(|n| n.contains(&word.as_str())) {
            Some(slot) if columns[slot].replace(k).is_some() => {
                let what = format!("the column `{}` is there twice", names[slot][0]);
                return Err(FileFault::malformed(what, "rename or remove one of them"));
            }
            Some(_) => {}
            None => others.push(base::brief(field.trim_matches('"'))),
        }
    }
    for (slot, name) in [(0, "day"), (1, "size")] {
        if columns[slot].is_none() {
            let what = format!("there is no column `{name}`");
            return Err(FileFault::malformed(what, "begin with a line of names: day,size,organ,plant"));
        }
    }
    if !others.is_empty() {
        let message = format!("the columns {} were left out", others.join(", "));
        warnings.push(Warning { code: "column-unknown", message, fields: Vec::new() });
    }
    Ok(columns)
}

fn entry(
    fields: &Fields,
    columns: &[Option<usize>; 4],
    line: &str,
) -> Result<Option<GrowthEntry>, FileFault> {
    let cells = fields.row(line)?;
    let cell = |slot: usize| {
        columns[slot].and_then(|k: usize| cells.get(k)).map_or("", |c| c.trim_matches('"').trim())
    };
    let number = |slot: usize, name: &str| {
        fields.number(cell(slot)).ok_or_else(|| {
            let what = format!("the {name} `{}` is no number", cell(slot));
            FileFault::malformed(what, "give a number, or leave the line out")
        })
    };
    let day = number(0, "day")?;
    if ["", "na", "nan", "-"].contains(&cell(1).to_ascii_lowercase().as_str()) {
        return Ok(None);
    }
    let size = number(1, "size")?;
    if size < 0.0 {
        return Err(FileFault::malformed(format!("the size {size} is negative"), "a size is 0 or more"));
    }
    let name = |slot: usize| cell(slot).chars().take(200).collect();
    Ok(Some(GrowthEntry { day, size, organ: name(2), plant: name(3) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<ReadGrowth, String> {
        read_growth(text.as_bytes(), Unit::Metre).map_err(|e| e.to_string())
    }

    #[test]
    fn columns_have_the_names_that_people_give_them() {
        let t = read("\"rownames\",\"Tree\",\"age\",\"circumference\"\n1,\"3\",118,30\n2,\"3\",484,NA\n")
            .unwrap();
        assert_eq!(t.rows, [GrowthEntry { day: 118.0, size: 30.0, organ: String::new(), plant: "3".into() }]);
        assert_eq!(t.warnings.len(), 2, "{:?}", t.warnings);
        let t = read("# unit: mm\nday;size;organ\n1;2,5;leaf-1\n").unwrap();
        assert!((t.rows[0].size - 0.0025).abs() < 1e-15 && t.rows[0].organ == "leaf-1");
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        for (text, want) in [
            ("", "empty"),
            ("day,size\n", "empty"),
            ("day,colour\n1,2\n", "no column `size`"),
            ("day,size,length\n1,2,3\n", "`size` is there twice"),
            ("day,size\n1,2\nx,2\n", "line 3: the day `x` is no number"),
            ("day,size\n1,-2\n", "negative"),
            ("day,size\n1,2,3\n", "3 fields"),
            ("# unit: ell\nday,size\n1,2\n", "`unit: ell`"),
        ] {
            let e = read(text).unwrap_err();
            assert!(e.contains(want), "{e:?} should say {want:?}");
        }
    }
}
