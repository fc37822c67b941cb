//! Clouds as lines of numbers, and the vertices of an OBJ.

use base::Report;
use mesh::PointClass;

use super::columns::{ClassColumn, Columns};
use super::sink::{Coding, Said, Sink, byte};
use super::{CloudFormat, too_many};
use crate::error::{CloudError, FileFault, Place};

fn is_separator(b: u8) -> bool {
    b.is_ascii_whitespace() || b == b',' || b == b';'
}

fn number(word: &[u8]) -> Option<f64> {
    core::str::from_utf8(word).ok()?.parse().ok()
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|&b| is_separator(b)).filter(|w| !w.is_empty())
}

/// Meaning of the commas of a row.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Commas {
    /// `1.5,2,3` or `1.5, 2, 3`.
    Separate,
    /// `1,5;2;3` or `1,5 2 3`.
    Decimal,
}

/// Returns the only possible meaning of the commas of a row: with it alone the columns of its place are numbers and, if a
/// header gives the number of columns, the row has that number. `None` if both meanings or neither fit.
fn commas(line: &[u8], place: [usize; 3], wanted: Option<usize>) -> Option<Commas> {
    let fits = |row: Row<'_>, number: fn(&[u8]) -> Option<f64>| {
        let is_number = |k: usize| row.words.get(k).is_some_and(|w| number(w).is_some());
        place.into_iter().all(is_number) && wanted.is_none_or(|wanted| row.words.len() == wanted)
    };
    let separate = fits(Row::parse(fields(line), number), number);
    let decimal = fits(Row::parse(columns(line), decimal), decimal);
    match (separate, decimal) {
        (true, false) => Some(Commas::Separate),
        (false, true) => Some(Commas::Decimal),
        _ => None,
    }
}

/// Fields between commas; an empty field is a column, too.
fn fields(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|&b| b == b',').map(<[u8]>::trim_ascii)
}

/// The words between semicolons, tabs and blanks.
fn columns(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|&b| b == b';' || b.is_ascii_whitespace()).filter(|w| !w.is_empty())
}

/// Parses a number with a decimal comma, a decimal point or neither.
fn decimal(word: &[u8]) -> Option<f64> {
    let Some(comma) = word.iter().position(|&b| b == b',') else { return number(word) };
    let digit = |b: Option<&u8>| b.is_some_and(u8::is_ascii_digit);
    if word.contains(&b'.') || !digit(word.get(comma + 1)) {
        return None;
    }
    let mut word = word.to_vec();
    word[comma] = b'.';
    number(&word)
}

/// First ten numbers of a row.
struct Row<'a> {
    numbers: Vec<f64>,
    words: Vec<&'a [u8]>,
}

/// Most columns of a row.
const MAX_COLUMNS: usize = 256;

impl<'a> Row<'a> {
    fn parse(words: impl Iterator<Item = &'a [u8]>, number: fn(&[u8]) -> Option<f64>) -> Self {
        let words: Vec<&[u8]> = words.take(MAX_COLUMNS + 1).collect();
        Self { numbers: words.iter().map(|word| number(word).unwrap_or(f64::NAN)).collect(), words }
    }

    /// The first of the columns whose word is no number.
    fn broken(&self, columns: impl IntoIterator<Item = usize>) -> Option<&'a [u8]> {
        let is_number = |word: &[u8]| number(word).is_some() || decimal(word).is_some();
        columns.into_iter().find_map(|k| self.words.get(k).copied().filter(|w| !is_number(w)))
    }
}

/// Returns whether one of the first lines, of which five may be a header, is a row of three numbers.
pub(super) fn starts(start: &[u8]) -> bool {
    let lines = start.split(|&b| b == b'\n').map(<[u8]>::trim_ascii);
    let lines = lines.filter(|l| !l.is_empty() && !l.starts_with(b"#") && !l.starts_with(b"//"));
    let numbers = |l: &[u8]| {
        let three = Row::parse(words(l).take(3), number);
        three.words.len() == 3 && three.broken(0..3).is_none()
    };
    !start.contains(&0) && lines.take(6).any(numbers)
}

/// Columns of colours that the first row shows if no header names them.
struct Colours {
    /// Index of the column of red.
    at: usize,
    coding: Coding,
}

impl Colours {
    /// Whole numbers to 255 in the last three of six columns; or, after a normal (unit length), such numbers or shares of 255.
    /// Shares of four bands are reflectances.
    /// In a PTS file, which begins with the number of its points, they follow an intensity.
    fn shown(row: &[f64], is_pts: bool) -> Option<Self> {
        let bytes = |c: &[f64]| {
            let byte = |x: &f64| (0.0..=255.0).contains(x) && x.fract() <= 0.0;
            c.iter().all(byte) && c.iter().any(|x| *x > 1.0)
        };
        // A share of 255 that is written with six digits is this near to a whole number.
        let share = |x: &f64| (0.0..=1.0).contains(x) && (x * 255.0 - (x * 255.0).round()).abs() < 1e-3;
        let count = row.len();
        if count == 6 && bytes(&row[3..6]) {
            return Some(Self { at: 3, coding: Coding::Byte });
        }
        if count == 7 && is_pts && bytes(&row[4..7]) {
            return Some(Self { at: 4, coding: Coding::Byte });
        }
        if count < 9 || (row[3..6].iter().map(|x| x * x).sum::<f64>() - 1.0).abs() > 1e-3 {
            return None;
        }
        let coding = if bytes(&row[6..9]) {
            Coding::Byte
        } else if !row[6..9].iter().all(share) {
            return None;
        } else if count == 10 && share(&row[9]) && row[9] < 1.0 {
            // A fourth share of 1 is an opacity.
            Coding::Reflectance
        } else {
            Coding::Share
        };
        Some(Self { at: 6, coding })
    }

    fn rgb(&self, row: &[f64]) -> [u8; 3] {
        self.coding.bytes([0, 1, 2].map(|k| row[self.at + k]))
    }

    /// Names the columns that are left out, out of `count`.
    fn left_out(colours: Option<&Self>, count: usize) -> Option<String> {
        let after =
            |last: usize| if last == count { format!("{count}") } else { format!("{last} to {count}") };
        match colours {
            Some(c) if c.at == 3 => None,
            Some(c) if c.at == 4 => Some("4".into()),
            Some(_) if count == 9 => Some("4 to 6".into()),
            Some(_) => Some(format!("4 to 6 and {}", after(10))),
            None => (count > 3).then(|| format!("4 to {count}")),
        }
    }
}

/// Meaning of the columns of a text.
enum Layout {
    /// By their names, in a header.
    Named(Columns),
    /// x y z, then what the first row shows.
    Shown(Option<Colours>),
}

impl Layout {
    /// By the names of a header, where it has as many as the first row, or by that row; what is left out is told.
    fn detect(
        header: Option<&Header>,
        row: &Row<'_>,
        is_pts: bool,
        sink: &mut Sink,
        report: &mut Report,
    ) -> Self {
        let count = row.words.len();
        if let Some(Header { names, columns }) = header.filter(|h| h.names.len() == count) {
            sink.columns.clone_from(names);
            let used: Vec<usize> = columns.used().collect();
            let rest = names.iter().enumerate().filter(|(k, _)| !used.contains(k));
            let rest: Vec<String> = rest.map(|(_, name)| base::quoted(name)).collect();
            if !rest.is_empty() {
                report.warn("scan-columns", format!("columns left out: {}", rest.join(", ")));
            }
            return Self::Named(columns.clone());
        }
        let colours = Colours::shown(&row.numbers, is_pts);
        sink.columns = ["x", "y", "z"].map(String::from).to_vec();
        if let Some(which) = Colours::left_out(colours.as_ref(), count) {
            report.warn("scan-columns", format!("columns {which} were left out"));
        }
        if let Some(c) = &colours {
            sink.columns.extend(["red", "green", "blue"].map(String::from));
            if c.coding == Coding::Reflectance {
                let message = "columns 7 to 9 are taken for reflectances of red, green and blue, as near infrared follows";
                report.warn("scan-reflectance", message);
            }
        }
        Self::Shown(colours)
    }

    fn place(&self) -> [usize; 3] {
        match self {
            Self::Named(columns) => columns.place,
            Self::Shown(_) => [0, 1, 2],
        }
    }

    /// Gives a row to the sink; `false` when there are too many.
    fn push(&self, row: &Row<'_>, sink: &mut Sink) -> bool {
        let place = self.place().map(|k| row.numbers[k]);
        match self {
            Self::Shown(colours) => sink.push(place, colours.as_ref().map(|c| c.rgb(&row.numbers)), None),
            Self::Named(columns) => {
                let said = columns.class.map(|class| said(class, row, sink));
                match columns.color {
                    Some(c) => sink.push_raw(place, c.map(|k| row.numbers[k]), said),
                    None => sink.push(place, None, said),
                }
            }
        }
    }
}

/// Returns the class of a row: a number of LAS, or a word.
fn said(class: ClassColumn, row: &Row<'_>, sink: &mut Sink) -> Said {
    let unknown = Said::Class(PointClass::Unknown);
    let number = row.numbers[class.at];
    if number.is_nan() {
        return Said::from_word(&String::from_utf8_lossy(row.words[class.at])).unwrap_or(unknown);
    }
    if !class.is_numbered {
        return unknown;
    }
    byte(number).map_or(unknown, |class| sink.numbered(class))
}

/// The names of columns.
struct Header {
    names: Vec<String>,
    columns: Columns,
}

impl Header {
    /// Reads a line that names x, y and z; a comment counts only if it begins with a column that is used.
    fn parse(line: &[u8], is_comment: bool) -> Option<Self> {
        let text = core::str::from_utf8(line).ok()?;
        let has_commas = text.contains([',', ';', '\t']);
        let split = |c: char| if has_commas { matches!(c, ',' | ';' | '\t') } else { c.is_whitespace() };
        let names = text.trim_start_matches(['/', '#', ' ']).split(split).map(str::trim);
        let names = names.filter(|w| has_commas || !w.is_empty()).take(MAX_COLUMNS);
        let names: Vec<String> = names.map(|name| name.trim_matches(['"', '\'']).to_owned()).collect();
        let columns = Columns::named(names.iter().map(String::as_str))?;
        let is_header = !is_comment || columns.used().any(|k| k == 0);
        is_header.then_some(Self { names, columns })
    }
}

/// Lines before the points that may be a header.
const HEADER_LINES: usize = 5;

/// Three or more columns. A header names them in any order: coordinates, colours (0 to 1, 255 or 65535), a class. Without one they
/// are x y z, then what the first row shows: normals (unit length) or colours (whole numbers to 255), or a normal and then colours,
/// as such numbers, as shares of 1, or as reflectances of four bands. Anything else is left out. Where semicolons, tabs or
/// blanks separate, a comma is a decimal comma.
pub(super) fn read(bytes: &[u8], sink: &mut Sink, report: &mut Report) -> Result<(), CloudError> {
    let fail = |number: usize, what: String| {
        let advice =
            "give one point a line: x y z, separated by spaces, semicolons or, with decimal points, commas";
        CloudError::new(CloudFormat::Xyz, Place::line(number), FileFault::malformed(what, advice))
    };
    if bytes.iter().take(4096).any(|&b| b == 0) {
        return Err(fail(1, "it is not text".into()));
    }
    let mut shown: Option<(Layout, usize)> = None;
    let mut header: Option<Header> = None;
    let (mut style, mut has_points, mut is_pts) = (None, false, false);
    for (index, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let line = line.trim_ascii();
        let is_comment = line.starts_with(b"#") || line.starts_with(b"//");
        if shown.is_none() && header.is_none() && index < HEADER_LINES {
            header = Header::parse(line, is_comment);
            if header.is_some() {
                continue;
            }
        }
        if line.is_empty() || is_comment {
            continue;
        }
        let named = header.as_ref().filter(|_| shown.is_none());
        let place = shown.as_ref().map(|(layout, _)| layout.place());
        let place = place.or(named.map(|h| h.columns.place)).unwrap_or([0, 1, 2]);
        let wanted = shown.as_ref().map(|(_, count)| *count).or(named.map(|h| h.names.len()));
        let own = line.contains(&b',').then(|| {
            commas(line, place, wanted)
                .or_else(|| commas(line, place, None))
                .or_else(|| commas(line, [0, 1, 2], None))
        });
        let own = own.flatten();
        let row = match own {
            Some(Commas::Decimal) => Row::parse(columns(line), decimal),
            Some(Commas::Separate) => Row::parse(fields(line), number),
            None => Row::parse(words(line), number),
        };
        let count = row.words.len();
        let broken = row.broken(place);
        if shown.is_none() && broken.is_some() && index < HEADER_LINES {
            report.warn("scan-header", format!("line {} is taken for a header", index + 1));
            continue;
        }
        // Numbers whichever way, but not the same ones.
        if line.contains(&b',')
            && count >= 3
            && broken.is_none()
            && (own.is_none() || style.is_some_and(|s| own != Some(s)))
        {
            let what = "it is not clear which commas are decimal commas and which separate numbers";
            return Err(fail(index + 1, what.into()));
        }
        style = style.or(own.filter(|_| broken.is_none()));
        has_points |= line.contains(&b'.');
        // A line with the number of points alone is the header of a PTS file.
        if shown.is_none() && count == 1 && broken.is_none() {
            is_pts = true;
            continue;
        }
        if count > MAX_COLUMNS {
            return Err(fail(index + 1, format!("there are more than {MAX_COLUMNS} columns")));
        }
        if shown.is_none() && count >= 3 {
            shown = Some((Layout::detect(header.as_ref(), &row, is_pts, sink, report), count));
        }
        let place = shown.as_ref().map_or([0, 1, 2], |(layout, _)| layout.place());
        if let Some(word) = row.broken(place) {
            let word = base::quoted(&String::from_utf8_lossy(word));
            return Err(fail(index + 1, format!("{word:?} is no number")));
        }
        let Some((layout, wanted)) = &shown else {
            return Err(fail(index + 1, format!("there are {count} numbers, at least 3 are needed")));
        };
        if *wanted != count {
            return Err(fail(
                index + 1,
                format!("there are {count} columns, the lines before have {wanted}"),
            ));
        }
        if !layout.push(&row, sink) {
            return Err(too_many(CloudFormat::Xyz));
        }
    }
    if shown.is_some_and(|(_, count)| count == 6) && style == Some(Commas::Separate) && !has_points {
        let message = "no number has a decimal point: commas were taken for separators; if they are decimal commas, separate \
                       the columns by semicolons";
        report.warn("scan-commas", message);
    }
    Ok(())
}

/// Reads the `v` lines of an OBJ, with their colours if all of them have one.
pub(super) fn read_obj(bytes: &[u8], sink: &mut Sink, report: &mut Report) -> Result<(), CloudError> {
    let columns_of = |line| {
        let mut words = words(line);
        (words.next() == Some(b"v")).then(|| words.count())
    };
    let columns = || bytes.split(|&b| b == b'\n').filter_map(columns_of);
    let (some, all) = (columns().any(|n| n >= 6), columns().all(|n| n >= 6));
    let is_colored = some && all;
    if some && !all {
        report.warn("scan-colours", "only some of its vertices have colours, so they were left out");
    }
    for (index, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let mut words = words(line);
        if words.next() != Some(b"v") {
            continue;
        }
        let row = Row::parse(words, number);
        let fail = |what: String| {
            let fault = FileFault::malformed(what, "export the scan again");
            CloudError::new(CloudFormat::Obj, Place::line(index + 1), fault)
        };
        if row.words.len() < 3 || row.broken(0..3).is_some() {
            return Err(fail("a vertex without three numbers".into()));
        }
        let place = [0, 1, 2].map(|k| row.numbers[k]);
        let taken = if is_colored {
            sink.push_raw(place, [3, 4, 5].map(|k| row.numbers[k]), None)
        } else {
            sink.push(place, None, None)
        };
        if !taken {
            return Err(too_many(CloudFormat::Obj));
        }
    }
    let colors = ["red", "green", "blue"].into_iter().filter(|_| is_colored);
    sink.columns = ["x", "y", "z"].into_iter().chain(colors).map(String::from).collect();
    Ok(())
}
