//! tldraw's files (`.tldr`): JSON with records, of which the shapes are read.

use base::{LiteMap, Report, ops};
use glam::{DAffine2, DVec2};
use ink::{Drawing, Figure, Fill, InkSample, Stroke};
use serde_json::Value;

use super::json::error_at;
use super::plain_strokes;
use crate::DrawingFormat;
use crate::error::{DrawingError, FileFault, Place};

const FORMAT: DrawingFormat = DrawingFormat::Tldraw;
/// Number of points of a quarter of an ellipse.
const ARC: u32 = 16;
/// Deepest nesting of groups.
const MAX_DEPTH: usize = 64;
/// Paint of less than this opacity is invisible.
const UNSEEN: f64 = 0.005;
/// Colours of tldraw by name, as it shows them on paper.
const COLORS: [(&str, [u8; 3]); 13] = [
    ("black", [29, 29, 29]),
    ("grey", [159, 168, 178]),
    ("light-violet", [224, 133, 244]),
    ("violet", [174, 62, 201]),
    ("blue", [68, 101, 233]),
    ("light-blue", [75, 161, 241]),
    ("yellow", [241, 172, 75]),
    ("orange", [225, 105, 25]),
    ("green", [9, 146, 104]),
    ("light-green", [76, 176, 94]),
    ("light-red", [248, 119, 119]),
    ("red", [224, 49, 49]),
    ("white", [255, 255, 255]),
];
/// Widths of the four pens.
const PENS: [(&str, f64); 4] = [("s", 2.0), ("m", 3.5), ("l", 5.0), ("xl", 10.0)];

pub(super) fn read(text: &str, name: &str, report: &mut Report) -> Result<Drawing, DrawingError> {
    let value: Value = serde_json::from_str(text).map_err(|e| error_at(FORMAT, 1, &e))?;
    let Some(records) = value.get("records").and_then(Value::as_array) else {
        let fault =
            FileFault::malformed("the list \"records\" is missing", "save the drawing again in tldraw");
        return Err(DrawingError::new(FORMAT, Place::File, fault));
    };
    let shapes: LiteMap<&str, &Value> =
        records.iter().filter(|r| word(r, "typeName") == "shape").map(|r| (word(r, "id"), r)).collect();
    let mut order: Vec<(Vec<&str>, &Value)> = shapes.values().map(|s| (way(&shapes, s), *s)).collect();
    base::sort_by(&mut order, |a, b| a.0.cmp(&b.0));
    let mut left_out: LiteMap<&'static str, usize> = LiteMap::new();
    let mut figures = Vec::new();
    for (_, shape) in order {
        match figure(&shapes, shape) {
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

fn word<'v>(value: &'v Value, key: &str) -> &'v str {
    value.get(key).and_then(Value::as_str).unwrap_or_default()
}

fn number(value: &Value, key: &str) -> Option<f64> {
    value.get(key).and_then(Value::as_f64)
}

/// Returns the shapes from the outermost group to this one.
fn ancestors<'v>(shapes: &LiteMap<&'v str, &'v Value>, shape: &'v Value) -> Vec<&'v Value> {
    let mut out = vec![shape];
    let mut at = shape;
    while let Some(parent) = shapes.get(word(at, "parentId")).filter(|_| out.len() < MAX_DEPTH) {
        out.push(parent);
        at = parent;
    }
    out.reverse();
    out
}

/// Returns the order of a shape on the page: the indices of its groups and its own.
fn way<'v>(shapes: &LiteMap<&'v str, &'v Value>, shape: &'v Value) -> Vec<&'v str> {
    ancestors(shapes, shape).into_iter().map(|s| word(s, "index")).collect()
}

/// Returns the figure of a shape, or a word for what is left out; the word is empty for groups, whose shapes are
/// read.
fn figure<'v>(shapes: &LiteMap<&'v str, &'v Value>, shape: &'v Value) -> Result<Figure, &'static str> {
    let empty = Value::Null;
    let props = shape.get("props").unwrap_or(&empty);
    let size = DVec2::new(number(props, "w").unwrap_or(0.0), number(props, "h").unwrap_or(0.0));
    let mut closed = false;
    let line: Vec<InkSample> = match word(shape, "type") {
        "draw" | "highlight" => {
            closed = props.get("isClosed").and_then(Value::as_bool).unwrap_or(false);
            pen(props)?
        }
        "line" => corners(props),
        "geo" => {
            closed = true;
            match word(props, "geo") {
                "ellipse" | "oval" | "cloud" => super::ellipse(size, ARC),
                "triangle" => super::polygon(size, &[[0.5, 0.0], [1.0, 1.0], [0.0, 1.0]]),
                "diamond" | "rhombus" => {
                    super::polygon(size, &[[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]])
                }
                "rectangle" => super::polygon(size, &super::CORNERS),
                _ => return Err("shape of an unknown form"),
            }
        }
        "group" => return Err(""),
        "text" | "note" => return Err("text"),
        "arrow" => return Err("arrow"),
        "image" | "video" => return Err("image"),
        "frame" => return Err("frame"),
        _ => return Err("element of an unknown kind"),
    };
    let chain = ancestors(shapes, shape);
    let opacity: f64 = chain.iter().map(|s| number(s, "opacity").unwrap_or(1.0)).product();
    if opacity < UNSEEN {
        return Err("invisible");
    }
    let place = chain.iter().fold(DAffine2::IDENTITY, |outer, s| outer * own_place(s));
    let scale = number(props, "scale").unwrap_or(1.0);
    let color = COLORS.iter().find(|(name, _)| *name == word(props, "color")).map(|c| c.1);
    let width = PENS.iter().find(|(name, _)| *name == word(props, "size")).map(|p| p.1 * scale);
    let up = |p: DVec2| DVec2::new(p.x, 0.0 - p.y);
    let line = line.into_iter().map(|s| InkSample { at: up(place.transform_point2(s.at)), ..s }).collect();
    let filled = closed && !matches!(word(props, "fill"), "" | "none");
    Ok(Figure {
        like: Stroke {
            color,
            width: width.filter(|w| w.is_finite() && *w > 0.0),
            id: Some(word(shape, "id").to_owned()).filter(|id| !id.is_empty()),
            ..Stroke::default()
        },
        lines: vec![line],
        lined: true,
        // tldraw fills with a tint of the line's own colour.
        fill: filled.then_some(Fill { color, said: true, opacity, even_odd: false }),
    })
}

fn own_place(shape: &Value) -> DAffine2 {
    let at = DVec2::new(number(shape, "x").unwrap_or(0.0), number(shape, "y").unwrap_or(0.0));
    let (sin, cos) = ops::sin_cos(number(shape, "rotation").unwrap_or(0.0));
    DAffine2::from_cols_array(&[cos, sin, -sin, cos, at.x, at.y])
}

/// Returns the samples of the pen's segments.
fn pen(props: &Value) -> Result<Vec<InkSample>, &'static str> {
    let scale = DVec2::new(number(props, "scaleX").unwrap_or(1.0), number(props, "scaleY").unwrap_or(1.0));
    let pressed = props.get("isPen").and_then(Value::as_bool).unwrap_or(false);
    let mut out: Vec<InkSample> = Vec::new();
    for segment in props.get("segments").and_then(Value::as_array).into_iter().flatten() {
        let Some(points) = segment.get("points").and_then(Value::as_array) else {
            return Err("line in a packed form (save it with an older tldraw, or as SVG)");
        };
        for point in points {
            let (Some(x), Some(y)) = (number(point, "x"), number(point, "y")) else { continue };
            let pressure = number(point, "z").filter(|_| pressed);
            let sample = InkSample { at: DVec2::new(x, y) * scale, time_ms: None, pressure };
            if out.last().is_none_or(|last| last.at != sample.at) {
                out.push(sample);
            }
        }
    }
    Ok(out)
}

/// Returns the points of a line: a map, in the order of their indices.
fn corners(props: &Value) -> Vec<InkSample> {
    let points = props.get("points").and_then(Value::as_object);
    let mut all: Vec<(&str, DVec2)> = points
        .into_iter()
        .flat_map(|points| points.values())
        .filter_map(|p| Some((word(p, "index"), DVec2::new(number(p, "x")?, number(p, "y")?))))
        .collect();
    base::sort_by(&mut all, |a, b| a.0.cmp(b.0));
    all.into_iter().map(|(_, p)| p.into()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOME: &str = r#"{"tldrawFileFormatVersion":1,"schema":{},"records":[
        {"typeName":"page","id":"page:p"},
        {"typeName":"shape","id":"shape:g","type":"group","x":100,"y":0,"rotation":1.5707963267948966,
         "parentId":"page:p","index":"a2","props":{}},
        {"typeName":"shape","id":"shape:b","type":"draw","x":1,"y":2,"rotation":0,"parentId":"shape:g","index":"a1",
         "props":{"color":"green","size":"m","isPen":true,"isClosed":false,
          "segments":[{"type":"free","points":[{"x":0,"y":0,"z":0.5},{"x":10,"y":0,"z":0.7}]}]}},
        {"typeName":"shape","id":"shape:a","type":"geo","x":0,"y":0,"parentId":"page:p","index":"a1",
         "props":{"geo":"ellipse","w":10,"h":20,"color":"red","fill":"solid"}},
        {"typeName":"shape","id":"shape:t","type":"text","parentId":"page:p","index":"a3","props":{}},
        {"typeName":"shape","id":"shape:i","type":"line","opacity":0,"parentId":"page:p","index":"a4",
         "props":{"points":{"q":{"index":"a2","x":1,"y":1},"p":{"index":"a1","x":0,"y":0}}}}]}"#;

    #[test]
    fn shapes_are_read_in_the_order_of_the_page() {
        let mut report = Report::default();
        let drawing = read(SOME, "t", &mut report).expect("reads");
        assert_eq!(drawing.strokes.len(), 2);
        assert_eq!(drawing.strokes[0].color, Some([224, 49, 49]), "the lower one first");
        let pen = &drawing.strokes[1];
        let away = pen.samples[1].at - DVec2::new(98.0, -11.0);
        assert!(away.length() < 1e-9, "turned with its group: {:?}", pen.samples[1].at);
        assert_eq!((pen.samples[1].pressure, pen.width), (Some(0.7), Some(3.5)));
        let told: Vec<&str> = report.warnings.iter().map(|w| w.message.as_str()).collect();
        assert_eq!(told.len(), 2, "{told:?}");
    }

    #[test]
    fn groups_in_circles_and_other_json_do_no_harm() {
        let circle = r#"{"records":[{"typeName":"shape","id":"a","type":"draw","parentId":"b","props":{}},
            {"typeName":"shape","id":"b","type":"group","parentId":"a"}]}"#;
        assert!(
            read(circle, "t", &mut Report::default())
                .expect("reads")
                .strokes
                .iter()
                .all(|s| s.samples.is_empty())
        );
        for text in ["{}", "[]", r#"{"records":3}"#, "{"] {
            read(text, "t", &mut Report::default()).expect_err(text);
        }
    }
}
