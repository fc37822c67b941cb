//! PCD of the Point Cloud Library, versions 0.5 to 0.7.

use super::{CloudFormat, MAX_POINTS, Sink, too_many};
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

pub(super) fn read(bytes: &[u8], sink: &mut Sink) -> Result<(), CloudError> {
    let header = header(bytes)?;
    let find = |name: &str| header.fields.iter().position(|f| f.name == name);
    let (Some(x), Some(y), Some(z)) = (find("x"), find("y"), find("z")) else {
        return Err(fail(Place::File, "FIELDS names no x, y and z"));
    };
    if header.points > MAX_POINTS {
        return Err(too_many(CloudFormat::Pcd));
    }
    let rest = &bytes[header.body.min(bytes.len())..];
    let wanted = [x, y, z];
    match header.coding {
        Coding::Text => text(rest, &header, wanted, sink),
        Coding::Binary => {
            let stride: usize = header.fields.iter().map(|f| f.size * f.count).sum();
            if rest.len() / stride.max(1) < header.points {
                let there = rest.len() / stride.max(1);
                let inside = format!("the points: {} are announced, {there} are there", header.points);
                return Err(truncated(bytes.len(), inside));
            }
            let offset = |k: usize| header.fields[..k].iter().map(|f| f.size * f.count).sum::<usize>();
            let at = wanted.map(|k| (offset(k), header.fields[k].clone()));
            for row in rest.chunks_exact(stride).take(header.points) {
                let p = [0, 1, 2].map(|k| scalar(&row[at[k].0..], &at[k].1));
                if !sink.push(p, None) {
                    return Err(too_many(CloudFormat::Pcd));
                }
            }
            Ok(())
        }
        Coding::Compressed => compressed(rest, &header, wanted, sink),
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

fn text(rest: &[u8], header: &Header, wanted: [usize; 3], sink: &mut Sink) -> Result<(), CloudError> {
    let column = |k: usize| header.fields[..k].iter().map(|f| f.count).sum::<usize>();
    let columns = wanted.map(column);
    let mut seen = 0;
    for line in rest.split(|&b| b == b'\n') {
        if seen == header.points {
            break;
        }
        let mut p = [f64::NAN; 3];
        let mut any = false;
        for (k, word) in line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()).enumerate() {
            any = true;
            if let Some(axis) = columns.iter().position(|&c| c == k) {
                let number = core::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
                p[axis] = number
                    .ok_or_else(|| fail(Place::Item(format!("point {seen}")), "a coordinate is no number"))?;
            }
        }
        if !any {
            continue;
        }
        seen += 1;
        if !sink.push(p, None) {
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
fn compressed(rest: &[u8], header: &Header, wanted: [usize; 3], sink: &mut Sink) -> Result<(), CloudError> {
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
        let p = wanted.map(|k| {
            let field = &header.fields[k];
            plain.get(offset(k) + i * field.size * field.count..).map_or(f64::NAN, |raw| scalar(raw, field))
        });
        if !sink.push(p, None) {
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
