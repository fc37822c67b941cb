//! PCD of the Point Cloud Library, versions 0.5 to 0.7.

use super::columns::{Columns, said};
use super::sink::Sink;
use super::{CloudFormat, MAX_POINTS, too_many};
use crate::error::{CloudError, FileFault, Place};

const MAX_HEADER_LINES: usize = 200;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Signed,
    Unsigned,
    Float,
}

#[derive(Clone, Debug)]
struct Field {
    name: String,
    size: usize,
    kind: Kind,
    count: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Coding {
    Text,
    Binary,
    Compressed,
}

impl Coding {
    const fn name(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Binary => "binary",
            Self::Compressed => "compressed",
        }
    }
}

struct Header {
    fields: Vec<Field>,
    points: usize,
    coding: Coding,
    body: usize,
}

fn fail(place: Place, what: impl Into<String>) -> CloudError {
    CloudError::new(CloudFormat::Pcd, place, FileFault::malformed(what, "export the scan again"))
}

fn truncated(at: usize, inside: impl Into<String>) -> CloudError {
    CloudError::new(CloudFormat::Pcd, Place::Byte(at as u64), FileFault::Truncated { inside: inside.into() })
}

/// Which fields are used, and which are read: each once, in the order of `used`.
struct Wanted {
    columns: Columns,
    used: Vec<usize>,
}

impl Wanted {
    fn from_header(header: &Header) -> Option<Self> {
        let mut columns = Columns::named(header.fields.iter().map(|f| f.name.as_str()))?;
        columns.packed = columns.packed.filter(|&k| header.fields[k].size == 4);
        let used = columns.used().collect();
        Some(Self { columns, used })
    }

    /// Gives a point to the sink; `value`: of the k-th field that is used. `false` when there are too many.
    fn push(&self, header: &Header, value: impl Fn(usize) -> f64, sink: &mut Sink) -> bool {
        let place = [value(0), value(1), value(2)];
        let said = self.columns.class.and_then(|class| said(class, value(self.used.len() - 1), sink));
        if let Some(field) = self.columns.packed {
            let color = unpacked(&header.fields[field], value(3));
            return sink.push(place, Some(color), said);
        }
        if self.columns.color.is_some() {
            return sink.push_raw(place, [value(3), value(4), value(5)], said);
        }
        sink.push(place, None, said)
    }
}

/// A colour that is packed into the bits of a number, red uppermost: of a float, as PCL has it, or of a whole number.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bits")]
fn unpacked(field: &Field, value: f64) -> [u8; 3] {
    let bits = match field.kind {
        Kind::Float => (value as f32).to_bits(),
        Kind::Signed => value as i64 as u32,
        Kind::Unsigned => value as u32,
    };
    let [_, red, green, blue] = bits.to_be_bytes();
    [red, green, blue]
}

pub(super) fn read(bytes: &[u8], sink: &mut Sink) -> Result<(), CloudError> {
    let mut header = header(bytes)?;
    let wanted =
        Wanted::from_header(&header).ok_or_else(|| fail(Place::File, "FIELDS names no x, y and z"))?;
    if let Some(packed) = wanted.columns.packed.filter(|_| header.coding != Coding::Text) {
        // Bits of an opaque red are no number as a float, and would not come through as one.
        header.fields[packed].kind = Kind::Unsigned;
    }
    if header.points > MAX_POINTS {
        return Err(too_many(CloudFormat::Pcd));
    }
    sink.columns = header.fields.iter().map(|f| f.name.clone()).collect();
    sink.detail = header.coding.name().to_owned();
    let is_whole = |c: [usize; 3]| c.iter().all(|&k| header.fields[k].kind != Kind::Float);
    sink.has_whole_colors = wanted.columns.color.is_some_and(is_whole);
    let rest = &bytes[header.body.min(bytes.len())..];
    match header.coding {
        Coding::Text => text(rest, &header, &wanted, sink),
        Coding::Binary => {
            let stride: usize = header.fields.iter().map(|f| f.size * f.count).sum();
            if rest.len() / stride.max(1) < header.points {
                let there = rest.len() / stride.max(1);
                let inside = format!("the points: {} are announced, {there} are there", header.points);
                return Err(truncated(bytes.len(), inside));
            }
            let offset = |k: usize| header.fields[..k].iter().map(|f| f.size * f.count).sum::<usize>();
            let at: Vec<(usize, &Field)> =
                wanted.used.iter().map(|&k| (offset(k), &header.fields[k])).collect();
            for row in rest.chunks_exact(stride).take(header.points) {
                if !wanted.push(&header, |k| scalar(&row[at[k].0..], at[k].1), sink) {
                    return Err(too_many(CloudFormat::Pcd));
                }
            }
            Ok(())
        }
        Coding::Compressed => compressed(rest, &header, &wanted, sink),
    }
}

fn header(bytes: &[u8]) -> Result<Header, CloudError> {
    let mut at = 0;
    let (mut names, mut sizes, mut kinds, mut counts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut width, mut height, mut points) = (None, None, None);
    for number in 1..=MAX_HEADER_LINES {
        let Some(length) = bytes.get(at..).and_then(|b| b.iter().position(|&b| b == b'\n')) else {
            return Err(truncated(bytes.len(), "the header"));
        };
        let line = String::from_utf8_lossy(&bytes[at..at + length]).into_owned();
        at += length + 1;
        let mut words = line.split_ascii_whitespace();
        let word = words.next().unwrap_or_default().to_ascii_uppercase();
        let words: Vec<&str> = words.collect();
        let bad = || fail(Place::line(number), format!("{word} is broken"));
        let whole = |w: &[&str]| w.first().and_then(|w| w.parse::<usize>().ok()).ok_or_else(bad);
        match word.as_str() {
            "" | "VERSION" | "VIEWPOINT" => {}
            w if w.starts_with('#') => {}
            "FIELDS" | "COLUMNS" => names = words.iter().map(|w| (*w).to_owned()).collect(),
            "SIZE" => {
                sizes =
                    words.iter().map(|w| w.parse().ok()).collect::<Option<Vec<usize>>>().ok_or_else(bad)?;
            }
            "TYPE" => {
                let kind = |w: &&str| match *w {
                    "I" => Some(Kind::Signed),
                    "U" => Some(Kind::Unsigned),
                    "F" => Some(Kind::Float),
                    _ => None,
                };
                kinds = words.iter().map(kind).collect::<Option<Vec<Kind>>>().ok_or_else(bad)?;
            }
            "COUNT" => {
                counts =
                    words.iter().map(|w| w.parse().ok()).collect::<Option<Vec<usize>>>().ok_or_else(bad)?;
            }
            "WIDTH" => width = Some(whole(&words)?),
            "HEIGHT" => height = Some(whole(&words)?),
            "POINTS" => points = Some(whole(&words)?),
            "DATA" => {
                let coding = match words.first().copied() {
                    Some("ascii") => Coding::Text,
                    Some("binary") => Coding::Binary,
                    Some("binary_compressed") => Coding::Compressed,
                    _ => return Err(bad()),
                };
                let n = names.len();
                if counts.is_empty() {
                    counts = vec![1; n];
                }
                if n == 0 || n > 64 || sizes.len() != n || kinds.len() != n || counts.len() != n {
                    return Err(fail(Place::File, "FIELDS, SIZE, TYPE and COUNT differ in length"));
                }
                if !sizes.iter().all(|s| [1, 2, 4, 8].contains(s))
                    || !counts.iter().all(|c| (1..=4096).contains(c))
                {
                    return Err(fail(Place::File, "SIZE must be 1, 2, 4 or 8 and COUNT 1 to 4096"));
                }
                let product = width.zip(height).and_then(|(w, h): (usize, usize)| w.checked_mul(h));
                let points =
                    points.or(product).ok_or_else(|| fail(Place::File, "the number of points is missing"))?;
                let fields = names.into_iter().zip(sizes).zip(kinds).zip(counts);
                let fields =
                    fields.map(|(((name, size), kind), count)| Field { name, size, kind, count }).collect();
                return Ok(Header { fields, points, coding, body: at });
            }
            _ => return Err(fail(Place::line(number), "a line of the header is not understood")),
        }
    }
    Err(fail(Place::line(MAX_HEADER_LINES), "the header does not end"))
}

fn scalar(raw: &[u8], field: &Field) -> f64 {
    let mut b = [0_u8; 8];
    b.iter_mut().zip(raw.iter().take(field.size)).for_each(|(b, r)| *b = *r);
    let four = [b[0], b[1], b[2], b[3]];
    match (field.kind, field.size) {
        (Kind::Float, 4) => f64::from(f32::from_le_bytes(four)),
        (Kind::Float, 8) => f64::from_le_bytes(b),
        (Kind::Float, _) => f64::NAN,
        (Kind::Signed, 1) => f64::from(i8::from_le_bytes([b[0]])),
        (Kind::Signed, 2) => f64::from(i16::from_le_bytes([b[0], b[1]])),
        (Kind::Signed, 4) => f64::from(i32::from_le_bytes(four)),
        (Kind::Signed, _) => i64::from_le_bytes(b) as f64,
        (Kind::Unsigned, _) => u64::from_le_bytes(b) as f64,
    }
}

fn text(rest: &[u8], header: &Header, wanted: &Wanted, sink: &mut Sink) -> Result<(), CloudError> {
    let column = |k: usize| header.fields[..k].iter().map(|f| f.count).sum::<usize>();
    let columns: Vec<usize> = wanted.used.iter().map(|&k| column(k)).collect();
    let mut seen = 0;
    for line in rest.split(|&b| b == b'\n') {
        if seen == header.points {
            break;
        }
        let mut values = vec![f64::NAN; columns.len()];
        let mut any = false;
        for (k, word) in line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()).enumerate() {
            any = true;
            if let Some(axis) = columns.iter().position(|&c| c == k) {
                let number = core::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
                values[axis] = number
                    .ok_or_else(|| fail(Place::Item(format!("point {seen}")), "a coordinate is no number"))?;
            }
        }
        if !any {
            continue;
        }
        seen += 1;
        if !wanted.push(header, |k| values[k], sink) {
            return Err(too_many(CloudFormat::Pcd));
        }
    }
    if seen < header.points {
        let inside = format!("the points: {} are announced, {seen} are there", header.points);
        return Err(truncated(header.body + rest.len(), inside));
    }
    Ok(())
}

/// Two sizes, then LZF; unpacked, all values of a field follow one another.
fn compressed(rest: &[u8], header: &Header, wanted: &Wanted, sink: &mut Sink) -> Result<(), CloudError> {
    let word = |at: usize| {
        let b =
            rest.get(at..at + 4).ok_or_else(|| truncated(header.body, "the sizes of the packed points"))?;
        Ok::<usize, CloudError>(u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize)
    };
    let (packed, unpacked) = (word(0)?, word(4)?);
    let stride: usize = header.fields.iter().map(|f| f.size * f.count).sum();
    if header.points.checked_mul(stride) != Some(unpacked) {
        return Err(fail(Place::Byte(header.body as u64), "the unpacked size is not that of the points"));
    }
    let data =
        rest.get(8..8 + packed).ok_or_else(|| truncated(header.body + rest.len(), "the packed points"))?;
    // LZF packs at most 264 bytes into 3.
    if unpacked / 100 > packed {
        return Err(fail(
            Place::Byte(header.body as u64),
            "the packed points cannot unpack to the announced size",
        ));
    }
    let plain = lzf(data, unpacked)
        .ok_or_else(|| fail(Place::Byte(header.body as u64), "the packed points are broken"))?;
    let offset =
        |k: usize| header.fields[..k].iter().map(|f| f.size * f.count).sum::<usize>() * header.points;
    for i in 0..header.points {
        let value = |k: usize| {
            let (k, field) = (wanted.used[k], &header.fields[wanted.used[k]]);
            plain.get(offset(k) + i * field.size * field.count..).map_or(f64::NAN, |raw| scalar(raw, field))
        };
        if !wanted.push(header, value, sink) {
            return Err(too_many(CloudFormat::Pcd));
        }
    }
    Ok(())
}

/// Unpacks LZF to exactly `size` bytes.
fn lzf(data: &[u8], size: usize) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(size.min(data.len().saturating_mul(100)));
    let mut at = 0;
    while let Some(&control) = data.get(at) {
        at += 1;
        let control = usize::from(control);
        if control < 32 {
            out.extend_from_slice(data.get(at..=at + control)?);
            at += control + 1;
        } else {
            let mut length = control >> 5;
            if length == 7 {
                length += usize::from(*data.get(at)?);
                at += 1;
            }
            let back = ((control & 31) << 8) + usize::from(*data.get(at)?) + 1;
            at += 1;
            let from = out.len().checked_sub(back)?;
            for k in 0..length + 2 {
                out.push(out[from + k]);
            }
        }
        if out.len() > size {
            return None;
        }
    }
    (out.len() == size).then_some(out)
}
