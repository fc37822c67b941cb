//! Excalidraw's files (`.excalidraw`) and its clipboard text: JSON with a list of elements.

use base::{LiteMap, Report, ops};
use glam::DVec2;
use ink::{Drawing, Figure, Fill, InkSample, Stroke};
use serde::Deserialize;

use super::json::error_at;
use super::{parse_color, plain_strokes};
use crate::DrawingFormat;
use crate::error::{DrawingError, FileFault, Place};

const FORMAT: DrawingFormat = DrawingFormat::Excalidraw;
/// Number of points of a quarter of an ellipse, and of a piece of a curve.
const ARC: u32 = 16;
/// Paint of less than this opacity, in percent, is invisible.
const UNSEEN: f64 = 0.5;

#[derive(Deserialize)]
struct File {
    elements: Vec<Element>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Element {
    id: Option<String>,
    #[serde(rename = "type")]
    kind: String,
    x: f64,
    y: f64,
    width: f64,
    height: f64,
    angle: f64,
    stroke_color: String,
    background_color: String,
    stroke_width: f64,
    opacity: f64,
    is_deleted: bool,
    points: Vec<Vec<f64>>,
    pressures: Vec<f64>,
    /// An object for round corners and curves, null for straight lines; only its presence is read.
    roundness: Option<serde::de::IgnoredAny>,
}

impl Default for Element {
    fn default() -> Self {
        Self {
            id: None,
            kind: String::new(),
            x: 0.0,
            y: 0.0,
            width: 0.0,
            height: 0.0,
            angle: 0.0,
            stroke_color: "#000000".into(),
            background_color: "transparent".into(),
            stroke_width: 1.0,
            opacity: 100.0,
            is_deleted: false,
            points: Vec::new(),
            pressures: Vec::new(),
            roundness: None,
        }
    }
}

pub(super) fn read(text: &str, name: &str, report: &mut Report) -> Result<Drawing, DrawingError> {
    let value: serde_json::Value = serde_json::from_str(text).map_err(|e| error_at(FORMAT, 1, &e))?;
    let kind = value.get("type").and_then(serde_json::Value::as_str).unwrap_or_default();
    if !kind.starts_with("excalidraw") {
        let fault = FileFault::malformed(
            "the key \"type\" does not say \"excalidraw\"",
            "save the drawing again in Excalidraw",
        );
        return Err(DrawingError::new(FORMAT, Place::File, fault));
    }
    let file: File = serde_json::from_value(value).map_err(|e| error_at(FORMAT, 1, &e))?;
    let mut left_out: LiteMap<&'static str, usize> = LiteMap::new();
    let mut figures = Vec::new();
    for element in &file.elements {
        match figure(element) {
            Ok(figure) => figures.push(figure),
            Err("") => {}
            Err(what) => *left_out.entry(what).or_default() += 1,
        }
    }
    for (what, count) in &left_out {
        base::warn!(report, "svg-left-out", { what = what, count = count }, "left out: {what} ({count})");
    }
    Ok(Drawing {
        name: name.to_owned(),
        strokes: plain_strokes(figures, None, &[], report),
        layers: Vec::new(),
    })
}

/// Returns the figure of an element, or a word for what is left out; the word is empty for deleted elements.
fn figure(element: &Element) -> Result<Figure, &'static str> {
    if element.is_deleted {
        return Err("");
    }
    let size = DVec2::new(element.width, element.height);
    let line: Vec<InkSample> = match element.kind.as_str() {
        "freedraw" => pen(element),
        "line" => {
            let points: Vec<DVec2> = points(element).collect();
            let line = if element.roundness.is_some() { curve(&points) } else { points };
            line.into_iter().map(Into::into).collect()
        }
        "ellipse" => super::ellipse(size, ARC),
        "rectangle" | "embeddable" | "iframe" => super::polygon(size, &super::CORNERS),
        "diamond" => super::polygon(size, &[[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]]),
        "text" => return Err("text"),
        "arrow" => return Err("arrow"),
        "image" => return Err("image"),
        "frame" | "magicframe" => return Err("frame"),
        _ => return Err("element of an unknown kind"),
    };
    let stroke = paint(&element.stroke_color);
    let closed = line.len() > 2
        && line.first().zip(line.last()).is_some_and(|(a, b)| {
            let around: f64 = line.windows(2).map(|w| w[0].at.distance(w[1].at)).sum();
            a.at.distance(b.at) <= 0.06 * around
        });
    let fill = paint(&element.background_color).filter(|_| closed);
    if element.opacity < UNSEEN || (stroke.is_none() && fill.is_none()) {
        return Err("invisible");
    }
    let place = placement(element, &line);
    let line = line.into_iter().map(|s| InkSample { at: place(s.at), ..s }).collect();
    Ok(Figure {
        like: Stroke {
            color: stroke.or(fill),
            width: Some(element.stroke_width).filter(|w| w.is_finite() && *w > 0.0 && stroke.is_some()),
            id: element.id.clone(),
            ..Stroke::default()
        },
        lines: vec![line],
        lined: stroke.is_some(),
        fill: fill.map(|color| Fill {
            color: Some(color),
            said: true,
            opacity: element.opacity / 100.0,
            even_odd: false,
        }),
    })
}

/// Returns the map from the coordinates of an element to ours: rotated about the centre of its box, moved, y up.
fn placement(element: &Element, line: &[InkSample]) -> impl Fn(DVec2) -> DVec2 + use<> {
    let places: Vec<DVec2> = line.iter().map(|s| s.at).collect();
    let (lo, hi) = geom::bounds(&places).unwrap_or_default();
    let middle = (lo + hi) * 0.5;
    let (sin, cos) = ops::sin_cos(element.angle);
    let at = DVec2::new(element.x, element.y);
    move |p| {
        let p = p - middle;
        let turned = DVec2::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos) + middle + at;
        DVec2::new(turned.x, 0.0 - turned.y)
    }
}

fn points(element: &Element) -> impl Iterator<Item = DVec2> + '_ {
    element.points.iter().filter_map(|p| Some(DVec2::new(*p.first()?, *p.get(1)?)))
}

fn pen(element: &Element) -> Vec<InkSample> {
    let pressure = |k: usize| element.pressures.get(k).copied().filter(|p| p.is_finite());
    let sample = |(k, at)| InkSample { at, time_ms: None, pressure: pressure(k) };
    points(element).enumerate().map(sample).collect()
}

/// Returns a smooth curve through the points.
fn curve(points: &[DVec2]) -> Vec<DVec2> {
    let last = points.len().saturating_sub(1);
    let mut out: Vec<DVec2> = points.first().copied().into_iter().collect();
    for k in 0..last {
        let (p, q) = (points[k], points[k + 1]);
        let from = (q - points[k.saturating_sub(1)]) * 0.5;
        let to = (points[(k + 2).min(last)] - p) * 0.5;
        for i in 1..=ARC {
            let t = f64::from(i) / f64::from(ARC);
            let (t2, t3) = (t * t, t * t * t);
            let (a, b) = (2.0 * t3 - 3.0 * t2 + 1.0, 3.0 * t2 - 2.0 * t3);
            out.push(p * a + q * b + from * (t3 - 2.0 * t2 + t) + to * (t3 - t2));
        }
    }
    out
}

fn paint(color: &str) -> Option<[u8; 3]> {
    if color == "transparent" { None } else { parse_color(color) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOME: &str = r##"{"type":"excalidraw/clipboard","elements":[
        {"type":"freedraw","x":10,"y":20,"points":[[0,0],[3,4],[5,8]],"pressures":[0.5,0.6],"strokeColor":"#2e7d32"},
        {"type":"line","x":0,"y":0,"points":[[0,0],[10,0],[10,10]],"roundness":{"type":2}},
        {"type":"ellipse","x":0,"y":0,"width":10,"height":4,"angle":1.5707963267948966,"backgroundColor":"#ffc9c9"},
        {"type":"arrow","x":0,"y":0,"points":[[0,0],[9,9]]},{"type":"text","x":1,"y":1,"text":"a leaf"},
        {"type":"line","isDeleted":true,"points":[[0,0],[1,1]]},
        {"type":"line","opacity":0,"points":[[0,0],[1,1]]}]}"##;

    #[test]
    fn elements_become_strokes_with_y_up() {
        let mut report = Report::default();
        let drawing = read(SOME, "e", &mut report).expect("reads");
        assert_eq!(drawing.strokes.len(), 3);
        let pen = &drawing.strokes[0];
        assert_eq!(pen.samples[1].at, DVec2::new(13.0, -24.0));
        assert_eq!((pen.samples[1].pressure, pen.samples[2].pressure), (Some(0.6), None));
        assert_eq!(pen.color, Some([46, 125, 50]));
        assert!(drawing.strokes[1].samples.len() > 20, "a curve");
        let ring: Vec<DVec2> = drawing.strokes[2].samples.iter().map(|s| s.at).collect();
        let (lo, hi) = geom::bounds(&ring).expect("points");
        assert!(((hi - lo) - DVec2::new(4.0, 10.0)).length() < 1e-9, "a quarter turn: {lo} {hi}");
        assert_eq!(drawing.strokes[2].color, Some([255, 201, 201]), "the fill is its colour");
        let told: Vec<&str> = report.warnings.iter().map(|w| w.message.as_str()).collect();
        for what in ["text (1)", "arrow (1)", "invisible (1)"] {
            assert!(told.iter().any(|t| t.contains(what)), "{what}: {told:?}");
        }
    }

    #[test]
    fn other_json_is_refused() {
        for text in ["{}", "[]", r#"{"type":"excalidraw"}"#, r#"{"type":"excalidraw","elements":3}"#, "{"] {
            read(text, "e", &mut Report::default()).expect_err(text);
        }
    }
}
