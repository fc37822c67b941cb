//! bytes -> [`ink::Drawing`]s, y up, in whatever unit the file has.

mod excalidraw;
mod inkml;
mod json;
mod mode;
mod quickdraw;
mod svg;
mod tldraw;
mod xml;

use std::io::{BufRead, Read};

use base::{Report, Warning};
use glam::DVec2;
use ink::{Drawing, Figure, InkSample, Stroke};

use crate::DrawingFormat;
use crate::error::{DrawingError, FileFault, Place};
use crate::foreign::Foreign;
pub use json::write_drawing;
pub use svg::write_svg;

/// Largest file (or line of a file with a drawing a line) that is read whole: 64 MiB.
pub const MAX_DRAWING_BYTES: u64 = 64 << 20;

/// A drawing and the warnings of its reader.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadDrawing {
    /// The strokes, y up.
    pub drawing: Drawing,
    /// Warnings of what was left out or changed.
    pub warnings: Vec<Warning>,
}

/// The drawings of a file, one at a time: see [`read_drawings`].
#[derive(Debug)]
pub struct Drawings<R>(State<R>);

#[derive(Debug)]
enum State<R> {
    One { input: R, format: DrawingFormat, name: String },
    Lines(quickdraw::Lines<R>),
    Done,
}

/// Reads the drawings of `input`.
///
/// `name` (a file's stem) names drawings that bear no name of their own. An `.ndjson` file yields one item a
/// line and holds no more than one line in memory; its bad lines are errors of single items and the lines
/// after them are still read. The other formats yield exactly one item.
///
/// Not guaranteed: finite coordinates, strokes of two points or more. Cleaning is the sketch crate's work.
///
/// ```
/// use formats::{DrawingFormat, read_drawings};
/// let svg = br#"<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0L3 4"/></svg>"#;
/// let read = read_drawings(&svg[..], DrawingFormat::Svg, "stem").next().unwrap()?;
/// assert_eq!(read.drawing.strokes[0].samples[1].at, glam::DVec2::new(3.0, -4.0));
/// # Ok::<(), formats::DrawingError>(())
/// ```
pub fn read_drawings<R: BufRead>(input: R, format: DrawingFormat, name: &str) -> Drawings<R> {
    let name = name.to_owned();
    Drawings(match format {
        DrawingFormat::Ndjson => State::Lines(quickdraw::Lines::new(input, name)),
        _ => State::One { input, format, name },
    })
}

impl<R: BufRead> Iterator for Drawings<R> {
    type Item = Result<ReadDrawing, DrawingError>;

    fn next(&mut self) -> Option<Self::Item> {
        match core::mem::replace(&mut self.0, State::Done) {
            State::Done => None,
            State::One { input, format, name } => Some(read_one(input, format, &name)),
            State::Lines(mut lines) => {
                let item = lines.next();
                if item.is_some() {
                    self.0 = State::Lines(lines);
                }
                item
            }
        }
    }
}

fn read_one(input: impl Read, format: DrawingFormat, name: &str) -> Result<ReadDrawing, DrawingError> {
    let file = |fault| DrawingError::new(format, Place::File, fault);
    let mut bytes = Vec::new();
    input.take(MAX_DRAWING_BYTES + 1).read_to_end(&mut bytes).map_err(|e| file(FileFault::Io(e)))?;
    if bytes.len() as u64 > MAX_DRAWING_BYTES {
        return Err(file(FileFault::TooMuch {
            what: "the size in bytes",
            limit: MAX_DRAWING_BYTES,
            advice: "simplify the drawing or split it into several files",
        }));
    }
    let is_packed = bytes.starts_with(&GZIP);
    let bytes = unpacked(bytes).map_err(file)?;
    // Any file may be packed so, and only pictures (`.svgz`) are told by that alone.
    if is_packed && format == DrawingFormat::Svg && !begins_as_markup(&bytes) {
        return Err(file(FileFault::Foreign(Foreign::Gzip)));
    }
    let text = text_of(bytes).map_err(file)?;
    if text.trim().is_empty() {
        return Err(file(FileFault::Empty));
    }
    let mut report = Report::default();
    let drawing = match format {
        DrawingFormat::Svg => svg::read(&text, name, &mut report)?,
        DrawingFormat::Excalidraw => excalidraw::read(&text, name, &mut report)?,
        DrawingFormat::Tldraw => tldraw::read(&text, name, &mut report)?,
        // A copy of Excalidraw's clipboard may be saved under any name.
        DrawingFormat::Json if DrawingFormat::sniff(text.as_bytes()) == Some(DrawingFormat::Excalidraw) => {
            excalidraw::read(&text, name, &mut report)?
        }
        DrawingFormat::InkMl => inkml::read(&text, name, &mut report)?,
        DrawingFormat::Json => json::read(&text, name, &mut report)?,
        DrawingFormat::Ndjson => quickdraw::read_line(&text, 1, name, &mut report)?,
    };
    if drawing.strokes.iter().all(|s| s.hidden) {
        return Err(file(FileFault::no_strokes(&report)));
    }
    Ok(ReadDrawing { drawing, warnings: report.warnings })
}

/// First bytes of a file that is packed as gzip.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// Returns whether a text begins with a tag, in UTF-8; of UTF-16, whether it says so.
fn begins_as_markup(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    bytes.trim_ascii_start().starts_with(b"<")
        || [[0xff, 0xfe], [0xfe, 0xff]].iter().any(|m| bytes.starts_with(m))
}

/// Returns the bytes of a file: unpacked if it is packed as gzip (`.svgz`), else as they are.
fn unpacked(bytes: Vec<u8>) -> Result<Vec<u8>, FileFault> {
    if !bytes.starts_with(&GZIP) {
        return Ok(bytes);
    }
    let mut out = Vec::new();
    let read =
        flate2::read::MultiGzDecoder::new(bytes.as_slice()).take(MAX_DRAWING_BYTES + 1).read_to_end(&mut out);
    if let Err(e) = read {
        let what = format!("the packed (gzip) file is broken: {e}");
        return Err(FileFault::malformed(what, "save it again, or save it as plain SVG"));
    }
    if out.len() as u64 > MAX_DRAWING_BYTES {
        return Err(FileFault::TooMuch {
            what: "the size when unpacked, in bytes,",
            limit: MAX_DRAWING_BYTES,
            advice: "simplify the drawing or split it into several files",
        });
    }
    Ok(out)
}

/// Returns the strokes that figures of a drawing program mean, and reports what was done to them.
///
/// `words`: boxes around texts.
fn plain_strokes(
    figures: Vec<Figure>,
    sheet: Option<(DVec2, DVec2)>,
    words: &[(DVec2, DVec2)],
    report: &mut Report,
) -> Vec<Stroke> {
    let normal = ink::normalise(figures, sheet, words);
    for (change, count) in &normal.changes {
        report.warn_of(change.code(), &[("count", count)], change.sentence(*count));
    }
    normal.strokes
}

/// The corners of a box of size 1, y down.
const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// Returns a closed polygon in a box of the given size.
fn polygon(size: DVec2, corners: &[[f64; 2]]) -> Vec<InkSample> {
    let closed = corners.iter().chain(corners.first());
    closed.map(|c| (DVec2::from(*c) * size).into()).collect()
}

/// Returns a closed ellipse in a box of the given size, with `quarter` points for a quarter.
fn ellipse(size: DVec2, quarter: u32) -> Vec<InkSample> {
    let at = |k: u32| {
        let (sin, cos) = base::ops::sin_cos(base::ops::TAU * f64::from(k) / f64::from(4 * quarter));
        (size * 0.5 * (DVec2::new(cos, sin) + 1.0)).into()
    };
    (0..4 * quarter).chain([0]).map(at).collect()
}

/// Returns whether the XML declaration names the encoding of older drawing programs, whose bytes are the first 256
/// characters.
fn says_latin1(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).to_ascii_lowercase();
    let declaration = head.split("?>").next().unwrap_or_default();
    declaration.starts_with("<?xml")
        && ["iso-8859-1", "windows-1252", "latin1"].iter().any(|name| declaration.contains(name))
}

/// Decodes text from UTF-8 (a byte order mark is dropped), UTF-16 with a byte order mark, or Latin-1 if the XML
/// declaration says so.
pub(crate) fn text_of(bytes: Vec<u8>) -> Result<String, FileFault> {
    FileFault::if_foreign(Foreign::sniff(&bytes))?;
    let utf16 = |big: bool| {
        let units = bytes[2..].chunks_exact(2).map(|b| {
            let pair = [b[0], b[1]];
            if big { u16::from_be_bytes(pair) } else { u16::from_le_bytes(pair) }
        });
        char::decode_utf16(units).collect::<Result<String, _>>().map_err(|e| {
            FileFault::malformed(format!("the UTF-16 text is broken: {e}"), "save it again as UTF-8")
        })
    };
    match bytes.get(..2) {
        Some([0xff, 0xfe]) => return utf16(false),
        Some([0xfe, 0xff]) => return utf16(true),
        _ => {}
    }
    if says_latin1(&bytes) && std::str::from_utf8(&bytes).is_err() {
        return Ok(bytes.into_iter().map(char::from).collect());
    }
    let mut text = String::from_utf8(bytes)
        .map_err(|e| FileFault::NotUtf8 { after: e.utf8_error().valid_up_to() as u64 })?;
    if text.starts_with('\u{feff}') {
        text.drain(..'\u{feff}'.len_utf8());
    }
    Ok(text)
}

/// Returns the length of the number that `text` starts with (the grammar of SVG and ink: `1.5.5-3e2` holds three); 0
/// if there is none.
pub(crate) fn number_end(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut i: usize| {
        while bytes.get(i).is_some_and(u8::is_ascii_digit) {
            i += 1;
        }
        i
    };
    let start = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(start);
    let mut end = whole;
    let mut any = whole > start;
    if bytes.get(whole) == Some(&b'.') {
        end = digits(whole + 1);
        any |= end > whole + 1;
    }
    if !any {
        return 0;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(sign);
        if exponent > sign {
            end = exponent;
        }
    }
    end
}

/// Parses `#rgb`, `#rrggbb`, `rgb(..)`, the sixteen HTML names and the common ones that drawing programs write.
pub(crate) fn parse_color(text: &str) -> Option<[u8; 3]> {
    let text = text.trim();
    if let Some(hex) = text.strip_prefix('#') {
        if !hex.is_ascii() {
            return None;
        }
        let digit = |i: usize| u8::from_str_radix(hex.get(i..=i)?, 16).ok();
        let pair = |i: usize| u8::from_str_radix(hex.get(i..i + 2)?, 16).ok();
        return match hex.len() {
            3 | 4 => Some([digit(0)? * 17, digit(1)? * 17, digit(2)? * 17]),
            6 | 8 => Some([pair(0)?, pair(2)?, pair(4)?]),
            _ => None,
        };
    }
    let lower = text.to_ascii_lowercase();
    if let Some(inner) = lower.strip_prefix("rgba(").or_else(|| lower.strip_prefix("rgb(")) {
        let mut out = [0_u8; 3];
        let mut parts = inner.trim_end_matches(')').split([',', ' ', '/']).filter(|p| !p.is_empty());
        for channel in &mut out {
            let part = parts.next()?;
            let value = match part.strip_suffix('%') {
                Some(p) => p.parse::<f64>().ok()? * 2.55,
                None => part.parse::<f64>().ok()?,
            };
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte")]
            let byte = value.round().clamp(0.0, 255.0) as u8;
            *channel = byte;
        }
        return Some(out);
    }
    NAMED.iter().find(|(name, _)| *name == lower).map(|&(_, rgb)| rgb)
}

const NAMED: [(&str, [u8; 3]); 28] = [
    ("black", [0, 0, 0]),
    ("white", [255, 255, 255]),
    ("gray", [128, 128, 128]),
    ("grey", [128, 128, 128]),
    ("silver", [192, 192, 192]),
    ("red", [255, 0, 0]),
    ("maroon", [128, 0, 0]),
    ("yellow", [255, 255, 0]),
    ("olive", [128, 128, 0]),
    ("lime", [0, 255, 0]),
    ("green", [0, 128, 0]),
    ("darkgreen", [0, 100, 0]),
    ("forestgreen", [34, 139, 34]),
    ("aqua", [0, 255, 255]),
    ("cyan", [0, 255, 255]),
    ("teal", [0, 128, 128]),
    ("blue", [0, 0, 255]),
    ("navy", [0, 0, 128]),
    ("fuchsia", [255, 0, 255]),
    ("magenta", [255, 0, 255]),
    ("purple", [128, 0, 128]),
    ("violet", [238, 130, 238]),
    ("pink", [255, 192, 203]),
    ("orange", [255, 165, 0]),
    ("gold", [255, 215, 0]),
    ("brown", [165, 42, 42]),
    ("saddlebrown", [139, 69, 19]),
    ("tan", [210, 180, 140]),
];
