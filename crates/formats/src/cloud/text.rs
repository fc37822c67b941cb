//! Lines of numbers, and the vertices of an OBJ.

use base::Report;

use super::{CloudFormat, Sink, too_many};
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

/// What the commas of a row do.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Commas {
    /// `1.5,2,3` or `1.5, 2, 3`.
    Separate,
    /// `1,5;2;3` or `1,5 2 3`.
    Decimal,
}

/// What the commas of a row can only mean: its first three columns are numbers that way and not the other. `None` where
/// both ways or none lead to numbers.
fn commas(line: &[u8]) -> Option<Commas> {
    let starts = |mut words: &mut dyn Iterator<Item = Option<f64>>| {
        let first = (&mut words).take(3);
        first.flatten().count() == 3
    };
    let separate = starts(&mut line.split(|&b| b == b',').map(|w| number(w.trim_ascii())));
    let decimal = starts(&mut columns(line).map(decimal));
    match (separate, decimal) {
        (true, false) => Some(Commas::Separate),
        (false, true) => Some(Commas::Decimal),
        _ => None,
    }
}

/// The words between semicolons, tabs and blanks.
fn columns(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|&b| b == b';' || b.is_ascii_whitespace()).filter(|w| !w.is_empty())
}

/// A number with a decimal comma or none.
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

/// The first ten numbers of a row.
struct Row<'a> {
    numbers: [f64; 10],
    count: usize,
    /// The first of the first three words that is no number.
    broken: Option<&'a [u8]>,
}

fn row<'a>(words: impl Iterator<Item = &'a [u8]>, number: fn(&[u8]) -> Option<f64>) -> Row<'a> {
    let mut row = Row { numbers: [0.0; 10], count: 0, broken: None };
    for (k, word) in words.enumerate() {
        row.count = k + 1;
        match number(word) {
            Some(x) if k < 10 => row.numbers[k] = x,
            None if k < 3 => row.broken = row.broken.or(Some(word)),
            _ => {}
        }
    }
    row
}

/// A row of three numbers is among the first lines, of which five may be a header.
pub(super) fn starts(start: &[u8]) -> bool {
    let lines = start.split(|&b| b == b'\n').map(<[u8]>::trim_ascii);
    let lines = lines.filter(|l| !l.is_empty() && !l.starts_with(b"#") && !l.starts_with(b"//"));
    let numbers = |l: &[u8]| {
        let Row { count, broken, .. } = row(words(l), number);
        count >= 3 && broken.is_none()
    };
    !start.contains(&0) && lines.take(6).any(numbers)
}

/// In what numbers a colour is written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Coding {
    /// sRGB, 0 to 255.
    Byte,
    /// sRGB, 0 to 1.
    Share,
    /// The share of light that is thrown back, 0 to 1, as multispectral scanners measure it; near infrared follows.
    Reflectance,
}

/// What the first row shows of colours.
struct Colours {
    /// Before which column red stands.
    at: usize,
    coding: Coding,
}

impl Colours {
    /// Whole numbers to 255 in the last three of six columns; or, after a normal (unit length), such numbers or shares of 255.
    /// Shares of four bands are reflectances.
    fn shown(row: &[f64; 10], count: usize) -> Option<Self> {
        let bytes = |c: &[f64]| {
            let byte = |x: &f64| (0.0..=255.0).contains(x) && x.fract() <= 0.0;
            c.iter().all(byte) && c.iter().any(|x| *x > 1.0)
        };
        // Six digits of a share of 255 are this near to a whole number.
        let share = |x: &f64| (0.0..=1.0).contains(x) && (x * 255.0 - (x * 255.0).round()).abs() < 1e-3;
        let normal = row[3..6].iter().map(|x| x * x).sum::<f64>();
        if count == 6 && bytes(&row[3..6]) {
            return Some(Self { at: 3, coding: Coding::Byte });
        }
        if count < 9 || (normal - 1.0).abs() > 1e-3 {
            return None;
        }
        let coding = if bytes(&row[6..9]) {
            Coding::Byte
        } else if !row[6..9].iter().all(share) {
            return None;
        } else if count == 10 && share(&row[9]) && row[9] < 1.0 {
            // A fourth share that is 1 is an opacity.
            Coding::Reflectance
        } else {
            Coding::Share
        };
        Some(Self { at: 6, coding })
    }

    /// Numbers beyond the range are its ends.
    fn of(&self, row: &[f64; 10]) -> [u8; 3] {
        let srgb = |x: f64| match self.coding {
            Coding::Byte => x.trunc(),
            Coding::Share => (x * 255.0).round(),
            Coding::Reflectance => f64::from(base::byte_of_light(x)),
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturation is wanted")]
        [0, 1, 2].map(|k| srgb(row[self.at + k]) as u8)
    }

    /// Which columns are left out, of so many.
    fn left_out(colours: Option<&Self>, count: usize) -> Option<String> {
        let after =
            |last: usize| if last == count { format!("{count}") } else { format!("{last} to {count}") };
        match colours {
            Some(c) if c.at == 3 => None,
            Some(_) if count == 9 => Some("4 to 6".into()),
            Some(_) => Some(format!("4 to 6 and {}", after(10))),
            None => (count > 3).then(|| format!("4 to {count}")),
        }
    }
}

/// Three or more columns: x y z, then what the first row shows: normals (unit length) or colours (whole numbers
/// to 255), or a normal and then colours, as such numbers, as shares of 1, or as reflectances of four bands. Anything else is left out. Where semicolons, tabs or blanks separate, a comma is a decimal comma.
pub(super) fn read(bytes: &[u8], sink: &mut Sink, report: &mut Report) -> Result<(), CloudError> {
    let fail = |number: usize, what: String| {
        let advice =
            "give one point a line: x y z, separated by spaces, semicolons or, with decimal points, commas";
        CloudError::new(CloudFormat::Xyz, Place::line(number), FileFault::malformed(what, advice))
    };
    if bytes.iter().take(4096).any(|&b| b == 0) {
        return Err(fail(1, "it is not text".into()));
    }
    let mut columns: Option<usize> = None;
    let mut colours = None;
    let (mut style, mut points) = (None, false);
    for (index, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let line = line.trim_ascii();
        if line.is_empty() || line.starts_with(b"#") || line.starts_with(b"//") {
            continue;
        }
        let own = line.contains(&b',').then(|| commas(line)).flatten();
        let Row { numbers: row, count, broken } = match own {
            Some(Commas::Decimal) => row(self::columns(line), decimal),
            _ => row(words(line), number),
        };
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
        points |= line.contains(&b'.');
        if columns.is_none() && broken.is_some() && index < 5 {
            report.warn("scan-header", format!("line {} is taken for a header", index + 1));
            continue;
        }
        // A line with the number of points alone is the header of a PTS file.
        if columns.is_none() && count == 1 && broken.is_none() {
            continue;
        }
        if let Some(word) = broken {
            let word = base::quoted(&String::from_utf8_lossy(word));
            return Err(fail(index + 1, format!("{word:?} is no number")));
        }
        if count < 3 {
            return Err(fail(index + 1, format!("there are {count} numbers, at least 3 are needed")));
        }
        if columns.is_none() {
            columns = Some(count);
            colours = Colours::shown(&row, count);
            if let Some(which) = Colours::left_out(colours.as_ref(), count) {
                report.warn("scan-columns", format!("columns {which} were left out"));
            }
            if colours.as_ref().is_some_and(|c: &Colours| c.coding == Coding::Reflectance) {
                let message = "columns 7 to 9 are taken for reflectances of red, green and blue, as near infrared follows";
                report.warn("scan-reflectance", message);
            }
        } else if columns != Some(count) {
            let wanted = columns.unwrap_or(3);
            return Err(fail(
                index + 1,
                format!("there are {count} columns, the lines before have {wanted}"),
            ));
        }
        let color = colours.as_ref().map(|c: &Colours| c.of(&row));
        if !sink.push([row[0], row[1], row[2]], color) {
            return Err(too_many(CloudFormat::Xyz));
        }
    }
    if columns == Some(6) && style == Some(Commas::Separate) && !points {
        let message = "no number has a decimal point: commas were taken for separators; if they are decimal commas, separate \
                       the columns by semicolons";
        report.warn("scan-commas", message);
    }
    Ok(())
}

/// The `v` lines of an OBJ.
pub(super) fn read_obj(bytes: &[u8], sink: &mut Sink) -> Result<(), CloudError> {
    for (index, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let mut words = words(line);
        if words.next() != Some(b"v") {
            continue;
        }
        let mut p = [0.0; 3];
        for x in &mut p {
            *x = words.next().and_then(number).ok_or_else(|| {
                let fault = FileFault::malformed("a vertex without three numbers", "export the scan again");
                CloudError::new(CloudFormat::Obj, Place::line(index + 1), fault)
            })?;
        }
        if !sink.push(p, None) {
            return Err(too_many(CloudFormat::Obj));
        }
    }
    Ok(())
}
