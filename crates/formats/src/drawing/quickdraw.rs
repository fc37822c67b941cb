//! "Quick, Draw!" ndjson: one drawing a line, raw or simplified, y down.

use std::io::{BufRead, Read as _};

use base::Report;
use glam::DVec2;
use ink::{Drawing, InkSample, Stroke};
use serde::Deserialize;

use super::{MAX_DRAWING_BYTES, ReadDrawing, json, text_of};
use crate::DrawingFormat;
use crate::error::{DrawingError, FileFault, Place};

const FORMAT: DrawingFormat = DrawingFormat::Ndjson;

#[derive(Deserialize)]
struct Record {
    #[serde(default)]
    word: String,
    #[serde(default)]
    key_id: Key,
    drawing: Vec<Vec<Vec<f64>>>,
}

/// A key: the data set writes keys as text, other programs as numbers.
#[derive(Default, Deserialize)]
#[serde(untagged)]
enum Key {
    Text(String),
    Number(u64),
    #[default]
    None,
}

/// The drawings of an ndjson file. Holds one line in memory.
#[derive(Debug)]
pub(super) struct Lines<R> {
    input: R,
    name: String,
    line: usize,
    drawings: usize,
    /// Reading has failed: further attempts would fail for ever.
    broken: bool,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(input: R, name: String) -> Self {
        Self { input, name, line: 0, drawings: 0, broken: false }
    }

    pub(super) fn next(&mut self) -> Option<Result<ReadDrawing, DrawingError>> {
        if self.broken {
            return None;
        }
        loop {
            let mut bytes = Vec::new();
            let read = self.input.by_ref().take(MAX_DRAWING_BYTES).read_until(b'\n', &mut bytes);
            self.line += 1;
            let fail = |line, fault| Some(Err(DrawingError::new(FORMAT, Place::line(line), fault)));
            match read {
                Err(e) => {
                    self.broken = true;
                    return fail(self.line, FileFault::Io(e));
                }
                Ok(0) if self.drawings == 0 => {
                    self.drawings = 1;
                    return Some(Err(DrawingError::new(FORMAT, Place::File, FileFault::Empty)));
                }
                Ok(0) => return None,
                Ok(_) => {}
            }
            if bytes.len() as u64 == MAX_DRAWING_BYTES && bytes.last() != Some(&b'\n') {
                self.drawings += 1;
                return match self.skip_line() {
                    Err(e) => {
                        self.broken = true;
                        fail(self.line, FileFault::Io(e))
                    }
                    Ok(()) => fail(
                        self.line,
                        FileFault::TooMuch {
                            what: "the size of a line in bytes",
                            limit: MAX_DRAWING_BYTES,
                            advice: "one line is one drawing: is it really an ndjson file?",
                        },
                    ),
                };
            }
            if bytes.iter().all(u8::is_ascii_whitespace) {
                continue;
            }
            self.drawings += 1;
            let text = match text_of(bytes) {
                Ok(text) => text,
                Err(fault) => return fail(self.line, fault),
            };
            let fallback = format!("{}-{}", self.name, self.line);
            let mut report = Report::default();
            return Some(read_line(&text, self.line, &fallback, &mut report).and_then(|drawing| {
                if drawing.strokes.is_empty() {
                    Err(DrawingError::new(FORMAT, Place::line(self.line), FileFault::no_strokes(&report)))
                } else {
                    Ok(ReadDrawing { drawing, warnings: report.warnings })
                }
            }));
        }
    }

    fn skip_line(&mut self) -> std::io::Result<()> {
        loop {
            let buffer = self.input.fill_buf()?;
            let end = buffer.iter().position(|&b| b == b'\n');
            let (used, done) = (end.map_or(buffer.len(), |i| i + 1), end.is_some() || buffer.is_empty());
            self.input.consume(used);
            if done {
                return Ok(());
            }
        }
    }
}

/// Reads one line (number `line`, from 1): a Quick, Draw! record or our own `drawing/1`.
pub(super) fn read_line(
    text: &str,
    line: usize,
    name: &str,
    report: &mut Report,
) -> Result<Drawing, DrawingError> {
    if text.contains("\"burgeon\"") {
        return json::read_at(text, line, name, FORMAT, report);
    }
    let record: Record =
        serde_json::from_str(text.trim_end()).map_err(|e| json::error_at(FORMAT, line, &e))?;
    let key = match record.key_id {
        Key::Text(text) => text,
        Key::Number(n) => n.to_string(),
        Key::None => String::new(),
    };
    let name = match (record.word.replace(' ', "-"), key) {
        (word, key) if word.is_empty() && key.is_empty() => name.to_owned(),
        (word, key) if key.is_empty() => format!("{name}-{word}"),
        (word, key) if word.is_empty() => key,
        (word, key) => format!("{word}-{key}"),
    };
    let mut strokes = Vec::with_capacity(record.drawing.len());
    for (i, rows) in record.drawing.iter().enumerate() {
        strokes.push(stroke(rows).map_err(|what| {
            let advice = "a stroke is [[x, ..], [y, ..]] or [[x, ..], [y, ..], [ms, ..]]";
            let place = Place::Item(format!("line {line}, stroke {i}"));
            DrawingError::new(FORMAT, place, FileFault::malformed(what, advice))
        })?);
    }
    Ok(Drawing { name, strokes, ..Drawing::default() })
}

fn stroke(rows: &[Vec<f64>]) -> Result<Stroke, String> {
    let [xs, ys, rest @ ..] = rows else { return Err(format!("it has {} rows", rows.len())) };
    if xs.len() != ys.len() {
        return Err(format!("it has {} x but {} y", xs.len(), ys.len()));
    }
    // A third row holds times only if it never decreases: labelled data sets put part numbers there.
    let times = rest.first().filter(|t| t.len() == xs.len() && t.windows(2).all(|w| w[0] <= w[1]));
    let constant = |t: &[f64]| t.len() > 1 && t.first() == t.last();
    let times = times.filter(|t| !constant(t));
    let samples = xs.iter().zip(ys).enumerate().map(|(i, (&x, &y))| InkSample {
        // The screen's y points down.
        at: DVec2::new(x, 0.0 - y),
        time_ms: times.and_then(|t| t.get(i).copied()),
        pressure: None,
    });
    Ok(Stroke { samples: samples.collect(), ..Stroke::default() })
}
