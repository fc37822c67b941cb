//! Growth tables as CSV: the size of organs by day, one line a measurement, in any order.

use std::io::Read;

use base::{TimeUnit, Unit, Warning, ops};

use super::LeafFileError;
use super::fields::Fields;
use crate::error::{FileFault, Place};

/// A test for one kind of column.
type IsColumn = fn(&Column) -> bool;

/// Most measurements, more than anybody types.
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
    /// The group; empty unless [`GrowthSpec::by`] names its column.
    pub group: String,
}

/// Settings for reading a growth table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct GrowthSpec {
    /// The unit of sizes if the table gives none.
    pub unit: Unit,
    /// The heading of the column of plants, if it is not one of the usual ones.
    pub plant: Option<String>,
    /// The heading of the column of sizes, if the table has several.
    pub size: Option<String>,
    /// The heading of the column of groups.
    pub by: Option<String>,
    /// The order of day, month and year in dates such as 3/4/2024; if none, a date with a day after the twelfth
    /// decides.
    pub dates: Option<DateOrder>,
}

/// The order of the numbers of a date.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DateOrder {
    /// Day, month, year.
    Dmy,
    /// Month, day, year.
    Mdy,
}

base::words!(DateOrder { Dmy = "dmy", Mdy = "mdy" });

/// Contents of a growth table.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadGrowth {
    /// The measurements, in the order of the file; from a wide table line by line.
    pub rows: Vec<GrowthEntry>,
    /// The unit that the file gives, in a heading or in a line `# unit: mm`.
    pub unit: Option<Unit>,
    /// The unit of time that a heading gives (`age_years`); days if it gives none, or if the days are dates.
    pub time: TimeUnit,
    /// Warnings of the reader.
    pub warnings: Vec<Warning>,
}

/// Names that the column of days may have; the first is the one that messages use.
const DAY: [&str; 5] = ["day", "age", "time", "days", "date"];
/// Names that the column of sizes may have.
const SIZE: [&str; 7] = ["size", "length", "height", "width", "circumference", "diameter", "value"];
/// Names that the column of organs may have.
const ORGAN: [&str; 2] = ["organ", "leaf"];
/// Names that the column of plants may have.
const PLANT: [&str; 4] = ["plant", "tree", "id", "subject"];
/// Contents of cells in which nothing was measured.
const MISSING: [&str; 4] = ["", "na", "nan", "-"];

/// Reads a growth table: `day,size[,organ][,plant]`, one line a measurement.
///
/// The first line names the columns, in any order; `day` may also be called age, time or date, `size` length, height,
/// width, circumference, diameter or value, `plant` tree or id. A heading may have its unit (`height_cm`, `Height
/// (cm)`), which wins over a line `# unit: mm`, which wins over `unit`; that of `day` may have one of time
/// (`age_years`, `Time (weeks)`). Days are numbers or dates, which count from the first one (2024-03-05, 05.03.2024;
/// 5/3/2024 if the day of one of them is after the twelfth or [`GrowthSpec::dates`] gives the order). A table without
/// a column of sizes is wide: each column other than the day is an organ or a plant, or each column is a day
/// (`plant,0,3,7`) and each line an organ or a plant. Other columns are left out with a warning. Fields are separated
/// as in [`read_marks`](crate::read_marks). Cells without a size are left out, because nothing was measured; and so
/// are empty lines, also those that spreadsheets pad with separators.
///
/// # Errors
/// [`LeafFileError`] with the line, for columns that are missing or repeated, cells that are not numbers, and sizes
/// that are negative.
pub fn read_growth(input: impl Read, spec: &GrowthSpec) -> Result<ReadGrowth, LeafFileError> {
    let text = super::text(input)?;
    let mut header: Option<Header> = None;
    let mut out = ReadGrowth { rows: vec![], unit: None, time: TimeUnit::Day, warnings: vec![] };
    let order = spec.dates.or_else(|| order_in(&text));
    let mut found = Found::default();
    for (k, line) in text.lines().enumerate() {
        let line = line.trim_start_matches('\u{feff}').trim();
        let placed = |fault| LeafFileError::new(Place::line(k + 1), fault);
        if let Some(comment) = super::comment_of(line) {
            out.unit = unit_of(comment).map_err(placed)?.or(out.unit);
        } else if !super::is_blank(line) {
            let Some(header) = &header else {
                let read = Header::read(line, spec, order, &mut out.warnings).map_err(placed)?;
                out.time = read.time;
                header = Some(read);
                continue;
            };
            header.add(line, &mut found).map_err(placed)?;
            if found.rows.len() > MOST {
                let (what, limit, advice) = ("the number of measurements", MOST as u64, "split the table");
                return Err(placed(FileFault::TooMuch { what, limit, advice }));
            }
        }
    }
    if found.rows.is_empty() {
        return Err(LeafFileError::new(Place::File, FileFault::Empty));
    }
    if found.empty > 0 {
        let message = format!("{} places have no size: they were left out", found.empty);
        out.warnings.push(Warning { code: "size-missing", message, fields: Vec::new() });
    }
    let own = found.rows.iter().find_map(|r| r.unit);
    out.unit = own.or(out.unit);
    let fallback = out.unit.filter(|_| own.is_none()).unwrap_or(spec.unit);
    let first = found.dates.then(|| found.rows.iter().map(|r| r.entry.day).fold(f64::INFINITY, f64::min));
    if let Some(first) = first {
        out.time = TimeUnit::Day;
        let message = format!("days count from the first date, {}", date_of(first));
        out.warnings.push(Warning { code: "days-from-dates", message, fields: Vec::new() });
    }
    out.rows.extend(found.rows.into_iter().map(|Row { mut entry, unit }| {
        entry.size *= unit.unwrap_or(fallback).metres();
        entry.day -= first.unwrap_or(0.0);
        entry
    }));
    Ok(out)
}

/// Measurements as they stand in the file.
#[derive(Default)]
struct Found {
    rows: Vec<Row>,
    /// Number of cells without a size.
    empty: usize,
    /// The days are dates, all of them.
    dates: bool,
    numbers: bool,
}

struct Row {
    entry: GrowthEntry,
    unit: Option<Unit>,
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

/// Content of a column.
#[derive(Clone, Debug, PartialEq)]
enum Column {
    Day,
    Size(Option<Unit>),
    Organ,
    Plant,
    Group,
    /// Sizes of one organ or plant.
    Series(String, Option<Unit>),
    /// Sizes on one day.
    OnDay(Moment),
    Other,
}

/// A day as it is written.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Moment {
    Number(f64),
    Date(f64),
}

struct Header {
    fields: Fields,
    columns: Vec<Column>,
    time: TimeUnit,
    order: Option<DateOrder>,
}

/// Returns a heading of time without its unit, and that unit: `age_years`, `Time (weeks)`.
fn without_time(heading: &str) -> Option<(String, TimeUnit)> {
    let word = heading.to_ascii_lowercase();
    let bare = word.trim_end_matches([')', ']']).trim_end();
    let (name, end) = bare.rfind(['_', '(', '[', ' ']).map_or(("", bare), |at| bare.split_at(at));
    let end = end.trim_matches(['_', '(', '[', ' ']);
    let singular = end.strip_suffix('s').unwrap_or(end);
    let unit = TimeUnit::from_word(singular).or(match singular {
        "d" => Some(TimeUnit::Day),
        "wk" => Some(TimeUnit::Week),
        "yr" | "a" => Some(TimeUnit::Year),
        _ => None,
    })?;
    Some((name.trim_end_matches(['_', '(', '[', ' ']).to_owned(), unit))
}

/// Returns a heading without its unit, in lower case, and that unit: `height_cm`, `Height (cm)`, `height [cm]`.
fn without_unit(heading: &str) -> (String, Option<Unit>) {
    let word = heading.to_ascii_lowercase();
    let bare = word.trim_end_matches([')', ']']).trim_end();
    let split = bare.rfind(['_', '(', '[', ' ']).map(|at| bare.split_at(at));
    let found = split.and_then(|(name, end)| {
        let unit = Unit::from_word(end.trim_matches(['_', '(', '[', ' ']))?;
        Some((name.trim_end_matches(['_', '(', '[', ' ']).to_owned(), Some(unit)))
    });
    found.unwrap_or((word, None))
}

/// Returns whether a heading is the requested one, apart from its case and its unit.
fn is_heading(name: &str, wanted: &str) -> bool {
    name.eq_ignore_ascii_case(wanted) || without_unit(name).0.eq_ignore_ascii_case(wanted)
}

/// Returns the content of a column according to its heading, and the unit of time that the heading gives.
fn column_of(name: &str, spec: &GrowthSpec) -> (Column, Option<TimeUnit>) {
    let asked = |wanted: &Option<String>| wanted.as_deref().is_some_and(|w| is_heading(name, w));
    let (word, unit) = without_unit(name);
    let timed = without_time(name);
    let is = |known: &[&str]| known.contains(&word.as_str());
    let is_day =
        is(&DAY) || timed.as_ref().is_some_and(|(bare, _)| bare.is_empty() || DAY.contains(&bare.as_str()));
    let column = match () {
        () if asked(&spec.by) => Column::Group,
        () if asked(&spec.plant) => Column::Plant,
        () if asked(&spec.size) => Column::Size(unit),
        () if is_day => Column::Day,
        () if is(&SIZE) && spec.size.is_none() => Column::Size(unit),
        () if is(&ORGAN) => Column::Organ,
        () if is(&PLANT) && spec.plant.is_none() => Column::Plant,
        () => Column::Other,
    };
    let time = timed.map(|t| t.1).filter(|_| column == Column::Day);
    (column, time)
}

impl Header {
    fn read(
        line: &str,
        spec: &GrowthSpec,
        order: Option<DateOrder>,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, FileFault> {
        let fields = Fields::from_header(line);
        let names: Vec<&str> = fields.split(line).iter().map(|f| f.trim_matches('"').trim()).collect();
        let (mut columns, mut time) = (Vec::new(), TimeUnit::Day);
        for name in &names {
            let (column, unit) = column_of(name, spec);
            columns.push(column);
            time = unit.unwrap_or(time);
        }
        for (of, wanted) in [("plants", &spec.plant), ("sizes", &spec.size), ("groups", &spec.by)] {
            let Some(wanted) = wanted else { continue };
            if !names.iter().any(|n| is_heading(n, wanted)) {
                let there: Vec<&str> = names.iter().copied().filter(|n| !n.is_empty()).collect();
                let what = format!("there is no column `{wanted}` of {of}, but {}", there.join(", "));
                return Err(FileFault::malformed(what, "name one of these"));
            }
        }
        let kinds: [(&str, IsColumn); 4] = [
            ("day", |c| *c == Column::Day),
            ("size", |c| matches!(c, Column::Size(_))),
            ("organ", |c| *c == Column::Organ),
            ("plant", |c| *c == Column::Plant),
        ];
        for (name, is) in kinds {
            if columns.iter().filter(|c| is(c)).count() > 1 {
                let what = format!("the column `{name}` is there twice");
                return Err(FileFault::malformed(what, "rename or remove one of them"));
            }
        }
        let [has_day, has_size] = [kinds[0].1, kinds[1].1].map(|is| columns.iter().any(is));
        if !has_size {
            widen(&names, &mut columns, has_day, warnings);
        }
        let is_wide = columns.iter().any(|c| matches!(c, Column::Series(..) | Column::OnDay(_)));
        for (name, is_there) in [("day", has_day), ("size", has_size)] {
            if !is_there && !is_wide {
                let what = format!("there is no column `{name}`");
                return Err(FileFault::malformed(what, "begin with a line of names: day,size,organ,plant"));
            }
        }
        let others: Vec<String> = names
            .iter()
            .zip(&columns)
            .filter(|(name, c)| **c == Column::Other && !name.is_empty())
            .map(|(name, _)| base::brief(name).to_string())
            .collect();
        if !others.is_empty() {
            let message = format!("the columns {} were left out", others.join(", "));
            warnings.push(Warning { code: "column-unknown", message, fields: Vec::new() });
        }
        Ok(Self { fields, columns, time, order })
    }

    /// Adds the measurements of a line.
    fn add(&self, line: &str, found: &mut Found) -> Result<(), FileFault> {
        let cells: Vec<&str> = self.fields.row(line)?.iter().map(|c| c.trim_matches('"').trim()).collect();
        let cell = |wanted: &Column| {
            let at = self.columns.iter().position(|c| c == wanted);
            at.and_then(|k| cells.get(k)).copied().unwrap_or("")
        };
        let name = |wanted: &Column| -> String { cell(wanted).chars().take(200).collect() };
        let own =
            if self.columns.contains(&Column::Day) { Some(self.moment(cell(&Column::Day))?) } else { None };
        for (column, text) in self.columns.iter().zip(&cells) {
            let (day, series, unit) = match column {
                Column::Size(unit) => (own, None, *unit),
                Column::Series(name, unit) => (own, Some(name), *unit),
                Column::OnDay(day) => (Some(*day), None, None),
                _ => continue,
            };
            let Some(day) = day else { continue };
            if MISSING.contains(&text.to_ascii_lowercase().as_str()) {
                found.empty += 1;
                continue;
            }
            let size = self.fields.number(text).ok_or_else(|| {
                let what = format!("the size `{text}` is no number");
                FileFault::malformed(what, "give a number, or leave the line out")
            })?;
            if size < 0.0 {
                return Err(FileFault::malformed(
                    format!("the size {size} is negative"),
                    "a size is 0 or more",
                ));
            }
            let day = found.day(day)?;
            let organ = series.cloned().unwrap_or_else(|| name(&Column::Organ));
            let (plant, group) = (name(&Column::Plant), name(&Column::Group));
            found.rows.push(Row { entry: GrowthEntry { day, size, organ, plant, group }, unit });
        }
        Ok(())
    }

    fn moment(&self, text: &str) -> Result<Moment, FileFault> {
        let number = self.fields.number(text).map(Moment::Number);
        let dated = || date(text).or_else(|| slashed(text, self.order?)).map(Moment::Date);
        number.or_else(dated).ok_or_else(|| {
            let what = format!("the day `{text}` is no number and no date");
            let advice = match numbers_of(text, '/') {
                Some(_) => "the day may be the first or the second number: say which (dmy or mdy), or write 2024-03-05",
                None => "give a number of days, or a date such as 2024-03-05",
            };
            FileFault::malformed(what, advice)
        })
    }
}

impl Found {
    fn day(&mut self, day: Moment) -> Result<f64, FileFault> {
        let day = match day {
            Moment::Number(day) => {
                self.numbers = true;
                day
            }
            Moment::Date(day) => {
                self.dates = true;
                day
            }
        };
        if self.dates && self.numbers {
            let what = "some days are dates and some are numbers";
            return Err(FileFault::malformed(what.to_owned(), "write all days in one way"));
        }
        Ok(day)
    }
}

/// Turns the columns of a table without a column of sizes into series next to a column of days, or into days.
fn widen(names: &[&str], columns: &mut [Column], has_day: bool, warnings: &mut Vec<Warning>) {
    let unknown = |c: &Column| *c == Column::Other;
    let wide: Vec<Option<Column>> = names
        .iter()
        .zip(columns.iter())
        .map(|(name, column)| {
            if !unknown(column) || name.is_empty() {
                return None;
            }
            if has_day {
                let (word, unit) = without_unit(name);
                // The heading as written, without the unit.
                let own = unit.map_or(*name, |_| name.get(..word.len()).unwrap_or(name));
                return Some(Column::Series(own.chars().take(200).collect(), unit));
            }
            day_heading(name).map(Column::OnDay)
        })
        .collect();
    let has_unit = wide.iter().flatten().any(|c| matches!(c, Column::Series(_, Some(_))));
    // One column with another name does not make a wide table: it may be anything.
    if wide.iter().flatten().count() < 2 && !has_unit {
        return;
    }
    let told: Vec<String> = names
        .iter()
        .zip(&wide)
        .filter(|(_, w)| w.is_some())
        .map(|(n, _)| base::brief(n).to_string())
        .collect();
    let what = if has_day { "organs or plants" } else { "days" };
    let message = format!("no column is called size: the columns {} were taken for {what}", told.join(", "));
    warnings.push(Warning { code: "table-wide", message, fields: Vec::new() });
    for (column, wide) in columns.iter_mut().zip(wide) {
        if let Some(wide) = wide {
            *column = wide;
        }
    }
}

/// Parses a heading that is a day: `7`, `day 7`, `d7`, `2024-03-05`.
fn day_heading(name: &str) -> Option<Moment> {
    let word = name.to_ascii_lowercase();
    let bare = ["days", "day", "d"].into_iter().find_map(|w| word.strip_prefix(w)).unwrap_or(&word);
    let number = bare.trim_matches([' ', '_', '-', '.']).parse().ok().filter(|x: &f64| x.abs() < 1e9);
    number.map(Moment::Number).or_else(|| date(name).map(Moment::Date))
}

/// Parses three numbers with a sign between them; a time may follow.
fn numbers_of(text: &str, sign: char) -> Option<[u32; 3]> {
    let head = text.split(['T', ' ']).next()?;
    let parts: Vec<u32> = head.split(sign).map(|p| p.parse().ok()).collect::<Option<_>>()?;
    parts.try_into().ok()
}

/// Returns the order of dates such as 3/4/2024 in a text, if one of them has a day after the twelfth.
fn order_in(text: &str) -> Option<DateOrder> {
    let cells = text.split([',', ';', '\t', '\n', '\r', '"']).map(str::trim);
    let dates = cells.filter_map(|cell| numbers_of(cell, '/')).filter(|[_, _, year]| *year >= 1000);
    let mut found = None;
    for [a, b, _] in dates {
        let own = match (a > 12, b > 12) {
            (true, false) => DateOrder::Dmy,
            (false, true) => DateOrder::Mdy,
            _ => continue,
        };
        // Dates that contradict each other do not decide.
        if found.is_some_and(|f| f != own) {
            return None;
        }
        found = Some(own);
    }
    found
}

/// Does the same as [`date`] for 3/4/2024.
fn slashed(text: &str, order: DateOrder) -> Option<f64> {
    let [a, b, year] = numbers_of(text, '/')?;
    match order {
        DateOrder::Dmy => day_of([year, b, a]),
        DateOrder::Mdy => day_of([year, a, b]),
    }
}

/// Returns the days from 1 March of the year 0 to a date: 2024-03-05, 2024/03/05 or 05.03.2024; a time may follow.
pub(super) fn date(text: &str) -> Option<f64> {
    match (numbers_of(text, '-').or_else(|| numbers_of(text, '/')), numbers_of(text, '.')) {
        (Some(ymd), _) => day_of(ymd),
        (None, Some([d, m, y])) => day_of([y, m, d]),
        _ => None,
    }
}

/// Returns the days since 1 March of the year 0.
fn day_of([year, month, day]: [u32; 3]) -> Option<f64> {
    let is_leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let days = [31, if is_leap { 29 } else { 28 }, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let last = *days.get((month as usize).checked_sub(1)?)?;
    if !(1000..=9999).contains(&year) || !(1..=last).contains(&day) {
        return None;
    }
    // If the year begins in March, the leap day is its last.
    let (y, m) = if month < 3 { (year - 1, month + 9) } else { (year, month - 3) };
    Some(f64::from(365 * y + y / 4 - y / 100 + y / 400 + (153 * m + 2) / 5 + day - 1))
}

/// Returns the date of a day that [`date`] returned.
pub(super) fn date_of(day: f64) -> String {
    let day = ops::whole(day);
    // The last year whose first of March is not after the day.
    let mut y = day / 366;
    let first = |y: u32| 365 * y + y / 4 - y / 100 + y / 400;
    while first(y + 1) <= day {
        y += 1;
    }
    let rest = day - first(y);
    let m = (5 * rest + 2) / 153;
    let d = rest - (153 * m + 2) / 5 + 1;
    let (year, month) = if m >= 10 { (y + 1, m - 9) } else { (y, m + 3) };
    format!("{year:04}-{month:02}-{d:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<ReadGrowth, String> {
        read_as(text, &GrowthSpec::default())
    }

    fn read_as(text: &str, spec: &GrowthSpec) -> Result<ReadGrowth, String> {
        read_growth(text.as_bytes(), spec).map_err(|e| e.to_string())
    }

    #[test]
    fn columns_have_the_names_that_people_give_them() {
        let t = read("\"rownames\",\"Tree\",\"age\",\"circumference\"\n1,\"3\",118,30\n2,\"3\",484,NA\n")
            .unwrap();
        let (organ, group) = (String::new(), String::new());
        assert_eq!(t.rows, [GrowthEntry { day: 118.0, size: 30.0, organ, plant: "3".into(), group }]);
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
            ("day,size\n1,2\nx,2\n", "line 3: the day `x` is no number and no date"),
            ("day,size\n1,-2\n", "negative"),
            ("day,size\n1,2,3\n", "3 fields"),
            ("# unit: ell\nday,size\n1,2\n", "`unit: ell`"),
        ] {
            let e = read(text).unwrap_err();
            assert!(e.contains(want), "{e:?} should say {want:?}");
        }
    }

    #[test]
    fn tables_of_spreadsheets_are_read_as_they_are_saved() {
        let t = read(
            "\u{feff}\"# unit: mm\",,,\nDate,Height (cm),Plant,\n,,,\n2024-02-27,1.5,a,\n01.03.2024,2,a,\n",
        )
        .unwrap();
        assert_eq!(t.unit, Some(Unit::Centimetre));
        assert_eq!(t.rows.iter().map(|r| r.day).collect::<Vec<_>>(), [0.0, 3.0], "2024 is a leap year");
        assert!((t.rows[0].size - 0.015).abs() < 1e-15 && t.rows[1].plant == "a", "{:?}", t.rows);
        assert!(t.warnings.iter().any(|w| w.message.contains("2024-02-27")), "{:?}", t.warnings);
        // 3/5/2024 is May or March.
        assert!(read("date,size\n3/5/2024,1\n").unwrap_err().contains("dmy or mdy"));
        assert!(read("date,size\n2024-03-05,1\n7,2\n").unwrap_err().contains("one way"));
        let t = read("day\theight_mm\n1\t2\n").unwrap();
        assert!((t.rows[0].size - 0.002).abs() < 1e-15);
    }

    #[test]
    fn any_column_may_hold_plants_sizes_or_groups() {
        let text = "Seed,Treatment,Age (years),height_cm,width_cm\n7,dry,1,10,4\n8,wet,2,20,5\n";
        let spec = GrowthSpec {
            plant: Some("seed".into()),
            by: Some("Treatment".into()),
            size: Some("width".into()),
            ..GrowthSpec::default()
        };
        let t = read_as(text, &spec).unwrap();
        assert_eq!(t.time, TimeUnit::Year);
        let of = |r: &GrowthEntry| (r.plant.clone(), r.group.clone(), (r.size * 1e3).round());
        assert_eq!(
            t.rows.iter().map(of).collect::<Vec<_>>(),
            [("7".to_owned(), "dry".to_owned(), 40.0), ("8".to_owned(), "wet".to_owned(), 50.0)]
        );
        let gone =
            read_as(text, &GrowthSpec { by: Some("block".into()), ..GrowthSpec::default() }).unwrap_err();
        assert!(gone.contains("`block` of groups") && gone.contains("Treatment"), "{gone}");
    }

    #[test]
    fn dates_with_slashes_are_read_where_they_are_not_open() {
        let days = |text: &str, dates| -> Vec<f64> {
            let spec = GrowthSpec { dates, ..GrowthSpec::default() };
            read_as(text, &spec).unwrap().rows.iter().map(|r| r.day).collect()
        };
        assert_eq!(days("date,size\n1/3/2024,1\n13/3/2024,2\n", None), [0.0, 12.0]);
        assert_eq!(days("date,size\n3/1/2024,1\n3/13/2024,2\n", None), [0.0, 12.0]);
        let open = "date,size\n1/3/2024,1\n2/3/2024,2\n";
        assert_eq!(days(open, Some(DateOrder::Dmy)), [0.0, 1.0]);
        assert_eq!(days(open, Some(DateOrder::Mdy)), [0.0, 31.0]);
    }

    #[test]
    fn wide_tables_have_a_series_in_each_column_or_a_day() {
        let t = read("day,leaf-1,leaf-2_cm\n0,1,10\n3,2,\n").unwrap();
        let rows: Vec<(f64, f64, &str)> = t.rows.iter().map(|r| (r.day, r.size, r.organ.as_str())).collect();
        assert_eq!(rows, [(0.0, 1.0, "leaf-1"), (0.0, 0.1, "leaf-2"), (3.0, 2.0, "leaf-1")]);
        let t = read("# unit: cm\nplant,day 0,day 7\na,1,2\nb,3,NA\n").unwrap();
        let rows: Vec<(f64, f64, &str)> = t.rows.iter().map(|r| (r.day, r.size, r.plant.as_str())).collect();
        assert_eq!(rows, [(0.0, 0.01, "a"), (7.0, 0.02, "a"), (0.0, 0.03, "b")]);
        assert!(t.warnings.iter().any(|w| w.code == "table-wide"), "{:?}", t.warnings);
    }

    #[test]
    fn dates_come_back_from_their_days() {
        for text in ["2000-02-29", "1999-12-31", "2024-01-01", "2024-03-01", "1900-02-28", "2100-03-01"] {
            assert_eq!(date_of(date(text).unwrap()), text);
        }
        assert_eq!(date("2024-03-01").unwrap() - date("2024-02-28").unwrap(), 2.0);
        for text in ["2023-02-29", "2024-13-01", "2024-00-10", "12024-01-01", "2024-01", "a-b-c"] {
            assert_eq!(date(text), None, "{text}");
        }
    }
}
