//! Our own `drawing/1` JSON, read and written; described in `docs/drawings.md`.

use std::io::Write;
use std::sync::Arc;

use base::Report;
use glam::DVec2;
use ink::{Drawing, InkSample, Layer, Stroke, StrokeMode};
use serde::{Deserialize, Serialize};

use super::{mode::mode_in, parse_color};
use crate::DrawingFormat;
use crate::error::{DrawingError, FileFault, Place, WriteError};

const SCHEMA: &str = "drawing/1";

#[derive(Serialize, Deserialize)]
struct File {
    burgeon: Option<String>,
    #[serde(default)]
    name: String,
    #[serde(default)]
    y: Up,
    #[serde(default)]
    layers: Vec<Layer>,
    strokes: Vec<FileStroke>,
}

#[derive(Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Up {
    #[default]
    Up,
    Down,
}

#[derive(Serialize, Deserialize)]
struct FileStroke {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    id: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mode: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    color: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    width: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    layer: Option<Arc<str>>,
    /// `x, y`, then time in ms and pressure where known; `null` for an unknown time before a known pressure.
    points: Vec<Vec<Option<f64>>>,
}

pub(super) fn error_at(format: DrawingFormat, line: usize, e: &serde_json::Error) -> DrawingError {
    let place = Place::Line {
        line: (line + e.line().saturating_sub(1)) as u64,
        column: Some(e.column() as u64).filter(|&c| c > 0),
    };
    let message = e.to_string();
    // serde_json repeats the place at the end of its message, and counts the lines of the fragment.
    let what = message.rsplit_once(" at line ").map_or(message.as_str(), |(head, _)| head).to_owned();
    let fault = if e.is_eof() {
        FileFault::Truncated { inside: "a JSON value".into() }
    } else if e.is_syntax() && what.starts_with("expected value") {
        // The most frequent cause: a program that writes its not-a-number as it is.
        FileFault::malformed(
            format!("{what} (NaN and Infinity are none in JSON)"),
            "leave such points out or mend the file there",
        )
    } else {
        FileFault::malformed(what, "see docs/drawings.md for the form of this file")
    };
    DrawingError::new(format, place, fault)
}

pub(super) fn read(text: &str, name: &str, report: &mut Report) -> Result<Drawing, DrawingError> {
    read_at(text, 1, name, DrawingFormat::Json, report)
}

pub(super) fn read_at(
    text: &str,
    line: usize,
    name: &str,
    format: DrawingFormat,
    report: &mut Report,
) -> Result<Drawing, DrawingError> {
    let file: File = serde_json::from_str(text).map_err(|e| error_at(format, line, &e))?;
    match file.burgeon.as_deref() {
        Some(SCHEMA) => {}
        Some(other) => {
            let fault = FileFault::unsupported(
                format!("\"burgeon\": {other:?}"),
                "this version reads \"drawing/1\"; take a newer Burgeon for newer files",
            );
            return Err(DrawingError::new(format, Place::line(line), fault));
        }
        None => {
            let fault = FileFault::malformed(
                "the key \"burgeon\" is missing",
                "write \"burgeon\": \"drawing/1\" first, so that the file says what it is",
            );
            return Err(DrawingError::new(format, Place::line(line), fault));
        }
    }
    let mut strokes = Vec::with_capacity(file.strokes.len());
    let mut layers = file.layers;
    for (i, stroke) in file.strokes.into_iter().enumerate() {
        let mut stroke = read_stroke(stroke, i, file.y, format, report)?;
        // A layer that the file does not describe is visible.
        if let Some(name) = &stroke.layer
            && !layers.iter().any(|l| l.name == *name)
        {
            layers.push(Layer { name: Arc::clone(name), ..Layer::default() });
        }
        stroke.hidden = layers.iter().any(|l| l.hidden && Some(&l.name) == stroke.layer.as_ref());
        strokes.push(stroke);
    }
    let name = if file.name.is_empty() { name.to_owned() } else { file.name };
    Ok(Drawing { name, strokes, layers })
}

fn read_stroke(
    stroke: FileStroke,
    index: usize,
    up: Up,
    format: DrawingFormat,
    report: &mut Report,
) -> Result<Stroke, DrawingError> {
    let bad = |item: String, what: String, advice| {
        DrawingError::new(format, Place::Item(item), FileFault::malformed(what, advice))
    };
    let mode = match stroke.mode.as_deref() {
        None => StrokeMode::Parts,
        Some(word) => mode_in(word).ok_or_else(|| {
            let advice = "use \"parts\", \"branch-contour\" or \"leaf-contour\"";
            bad(format!("stroke {index}"), format!("mode {word:?} is unknown"), advice)
        })?,
    };
    let color = stroke.color.as_deref().and_then(parse_color);
    if let (None, Some(word)) = (color, &stroke.color) {
        base::warn!(
            report,
            "color-unknown",
            { stroke = index, color = word },
            "stroke {stroke}: color {color:?} is not #rrggbb and was ignored"
        );
    }
    let mut samples = Vec::with_capacity(stroke.points.len());
    for (k, p) in stroke.points.iter().enumerate() {
        let (Some(Some(x)), Some(Some(y))) = (p.first().copied(), p.get(1).copied()) else {
            let item = format!("stroke {index}, point {k}");
            return Err(bad(
                item,
                "x or y is missing".into(),
                "a point is [x, y], [x, y, ms] or [x, y, ms, pressure]",
            ));
        };
        samples.push(InkSample {
            at: DVec2::new(x, if up == Up::Down { 0.0 - y } else { y }),
            time_ms: p.get(2).copied().flatten(),
            pressure: p.get(3).copied().flatten(),
        });
    }
    let width = stroke.width.filter(|w| w.is_finite() && *w > 0.0);
    Ok(Stroke { samples, mode, color, width, layer: stroke.layer, hidden: false, id: stroke.id })
}

/// Writes a drawing as `drawing/1` JSON, y up, one stroke a line.
///
/// Guaranteed: reading it back gives the same drawing, except that points that are not finite are left out
/// (JSON has no word for them).
///
/// # Errors
/// [`WriteError::Io`] of the sink.
///
/// ```
/// use formats::{DrawingFormat, read_drawings, write_drawing};
/// let stem = ink::Drawing::from_polylines("stem", &[vec![glam::DVec2::ZERO, glam::DVec2::Y]]);
/// let mut file = Vec::new();
/// write_drawing(&stem, &mut file)?;
/// assert_eq!(read_drawings(&file[..], DrawingFormat::Json, "").next().unwrap()?.drawing, stem);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_drawing(drawing: &Drawing, mut out: impl Write) -> Result<(), WriteError> {
    let json = |e: serde_json::Error| WriteError::Io(e.into());
    write!(out, "{{\"burgeon\":\"{SCHEMA}\",\"name\":")?;
    serde_json::to_writer(&mut out, &drawing.name).map_err(json)?;
    out.write_all(b",\"y\":\"up\"")?;
    if !drawing.layers.is_empty() {
        out.write_all(b",\"layers\":")?;
        serde_json::to_writer(&mut out, &drawing.layers).map_err(json)?;
    }
    out.write_all(b",\"strokes\":[")?;
    for (i, stroke) in drawing.strokes.iter().enumerate() {
        out.write_all(if i == 0 { b"\n" } else { b",\n" })?;
        let points = stroke.samples.iter().filter(|s| s.at.is_finite()).map(|s| {
            let mut point = vec![Some(s.at.x), Some(s.at.y)];
            match (s.time_ms.filter(|t| t.is_finite()), s.pressure.filter(|p| p.is_finite())) {
                (None, None) => {}
                (time, None) => point.push(time),
                (time, pressure) => point.extend([time, pressure]),
            }
            point
        });
        let mode = match stroke.mode {
            StrokeMode::Parts => "parts",
            StrokeMode::BranchContour => "branch-contour",
            StrokeMode::LeafContour => "leaf-contour",
        };
        let line = FileStroke {
            id: stroke.id.clone(),
            mode: Some(mode.to_owned()),
            color: stroke.color.map(|[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}")),
            width: stroke.width,
            layer: stroke.layer.clone(),
            points: points.collect(),
        };
        serde_json::to_writer(&mut out, &line).map_err(json)?;
    }
    out.write_all(b"\n]}\n")?;
    Ok(())
}
