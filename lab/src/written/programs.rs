//! Ways of SVG and other files to express the same.

use std::fmt::Write as _;

use base::Stream;
use formats::DrawingFormat;
use glam::DVec2;
use serde_json::{Value, json};

use super::page::{Line, PEN, Page, Written, path_data, shaken, stroked};

pub(super) fn whole_units(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        let points: Vec<DVec2> = l.points.iter().map(|p| p.round()).collect();
        stroked(&path_data(&points), &l.color)
    });
    Some(page.svg(&body))
}

pub(super) fn a_steady_hand(page: &Page, r: &mut Stream) -> Option<Written> {
    let body = page.each(|l| stroked(&path_data(&shaken(r, &l.points, 0.8)), &l.color));
    Some(page.svg(&body))
}

/// Returns the lines before a transform of the page is undone.
fn moved(page: &Page, to: impl Fn(DVec2) -> DVec2) -> String {
    page.each(|l| {
        let points: Vec<DVec2> = l.points.iter().map(|p| to(*p)).collect();
        let data = if l.closed { path_data(&points) } else { open_data(&points) };
        stroked(&data, &l.color)
    })
}

fn open_data(points: &[DVec2]) -> String {
    path_data(points).trim_end_matches('Z').to_owned()
}

pub(super) fn css_transform(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = moved(page, |p| (p - DVec2::new(40.0, 30.0)) * 0.5);
    Some(page.svg(&format!(
        "<style>#all .drawn {{ transform: translate(40px, 30px) scale(200%) }}</style><g id=\"all\"><g class=\"drawn\">{body}</g></g>\n"
    )))
}

/// Writes a half turn about the middle of the sheet, in CSS.
pub(super) fn css_origin(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = moved(page, |p| page.size - p);
    Some(page.svg(&format!("<g style=\"transform-origin:50% 50%;transform:rotate(0.5turn)\">{body}</g>\n")))
}

/// Writes the same about the middle of the drawing's own box.
pub(super) fn css_fill_box(page: &Page, _: &mut Stream) -> Option<Written> {
    let all: Vec<DVec2> = page.lines.iter().flat_map(|l| &l.points).copied().collect();
    let (lo, hi) = geom::bounds(&all)?;
    let body = moved(page, |p| lo + hi - p);
    Some(page.svg(&format!(
        "<style>.turned{{transform-box:fill-box;transform-origin:center;transform:rotate(180deg)}}</style><g class=\"turned\">{body}</g>\n"
    )))
}

pub(super) fn mirrored_twice(page: &Page, _: &mut Stream) -> Option<Written> {
    let DVec2 { x, y } = page.size;
    let body = moved(page, |p| DVec2::new(x - p.x, p.y));
    Some(page.svg(&format!(
        "<g transform=\"matrix(-1 0 0 1 {x:.4} 0)\"><g transform=\"rotate(360,{x},{y})\">{body}</g></g>\n"
    )))
}

pub(super) fn stretched_sheet(page: &Page, _: &mut Stream) -> Option<Written> {
    let DVec2 { x, y } = page.size;
    let body = moved(page, |p| DVec2::new(p.x * 0.5, p.y));
    Some(
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.3} {y:.3}\" width=\"{x:.3}\" height=\"{y:.3}\" preserveAspectRatio=\"none\">{body}</svg>\n",
            0.5 * x
        )
        .into(),
    )
}

/// Writes an inner sheet that is moved to its place, and a symbol with a sheet of its own.
pub(super) fn inner_sheets(page: &Page, _: &mut Stream) -> Option<Written> {
    let DVec2 { x, y } = page.size;
    let body = moved(page, |p| p * DVec2::new(0.25, 0.5));
    Some(page.svg(&format!(
        "<symbol id=\"s\" viewBox=\"0 0 {:.3} {:.3}\" preserveAspectRatio=\"none\">{body}</symbol><svg width=\"{x:.3}\" height=\"{y:.3}\"><use href=\"#s\" width=\"{x:.3}\" height=\"{y:.3}\"/></svg>\n",
        0.25 * x,
        0.5 * y
    )))
}

pub(super) fn used_symbols(page: &Page, _: &mut Stream) -> Option<Written> {
    let mut defs = String::from("<defs>");
    let mut uses = String::new();
    for (k, line) in page.lines.iter().enumerate() {
        let data = path_data(&line.points);
        let _ = write!(defs, "<path id=\"p{k}\" d=\"{data}\"/>");
        let _ = writeln!(uses, "<use xlink:href=\"#p{k}\" stroke=\"{}\" fill=\"none\"/>", line.color);
    }
    let DVec2 { x, y } = page.size;
    Some(
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" viewBox=\"0 0 {x:.2} {y:.2}\">{defs}</defs>{uses}</svg>\n"
        )
        .into(),
    )
}

/// Writes a `use` of its own group among good lines.
pub(super) fn use_of_itself(page: &Page, _: &mut Stream) -> Option<Written> {
    Some(page.svg(&format!("<g id=\"all\">{}<use href=\"#all\"/></g>\n", page.paths())))
}

/// Writes styles by descendants, in a sheet with rules for screens.
pub(super) fn styled_by_descendants(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| format!("<path d=\"{}\"/>\n", path_data(&l.points)));
    let sheet = "<style><![CDATA[@charset \"utf-8\"; @media print { .no { display: none } } svg g.ink > path { fill: none !important; stroke: rgb(20% 30% 20%); stroke-width: 4px }]]></style>";
    Some(page.svg(&format!("{sheet}<g class=\"ink\">{body}</g>\n")))
}

/// Writes colours in all notations of CSS.
pub(super) fn colours_of_css(page: &Page, _: &mut Stream) -> Option<Written> {
    const COLOURS: [&str; 5] =
        ["hsl(120 40% 30%)", "rgb(30, 60, 30, 1)", "darkolivegreen", "var(--ink, #234)", "currentColor"];
    let mut k = 0;
    let body = page.each(|l| {
        k += 1;
        format!(
            "<path d=\"{}\" style=\"stroke:{};stroke-width:4;fill:#0000\"/>\n",
            path_data(&l.points),
            COLOURS[k % COLOURS.len()]
        )
    });
    Some(page.svg(&format!("<g color=\"#232\">{body}</g>\n")))
}

/// Writes relative commands, numbers without separators, and curves through the points.
pub(super) fn short_numbers_and_curves(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        let mut data = format!("M{:.1},{:.1}", l.points[0].x, l.points[0].y);
        let mut at = (l.points[0] * 10.0).round() / 10.0;
        for w in l.points.windows(2) {
            let (to, middle) = (w[1] - at, w[0].midpoint(w[1]) - at);
            let _ = write!(data, "q{:.1} {:.1} {:.1} {:.1}", middle.x, middle.y, to.x, to.y);
            at += (to * 10.0).round() / 10.0;
        }
        let data = data.replace(" 0.", " .").replace(" -", "-");
        stroked(&(data + if l.closed { "z" } else { "" }), &l.color)
    });
    Some(page.svg(&body))
}

pub(super) fn packed(page: &Page, _: &mut Stream) -> Option<Written> {
    use std::io::Write as _;
    let text = page.svg(&page.paths()).bytes;
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    packer.write_all(&text).ok()?;
    Some(Written { bytes: packer.finish().ok()?, format: DrawingFormat::Svg })
}

fn excalidraw(kind: &str, elements: &[Value]) -> Written {
    let file = json!({"type": kind, "version": 2, "source": "https://excalidraw.com", "elements": elements, "appState": {}});
    Written { bytes: file.to_string().into_bytes(), format: DrawingFormat::Excalidraw }
}

fn element(line: &Line, kind: &str, background: &str) -> Value {
    let from = line.points[0];
    let points: Vec<[f64; 2]> = line.points.iter().map(|p| (*p - from).to_array()).collect();
    json!({"type": kind, "x": from.x, "y": from.y, "strokeColor": line.color, "backgroundColor": background,
        "strokeWidth": PEN, "opacity": 100, "angle": 0, "isDeleted": false, "points": points, "fillStyle": "hachure"})
}

pub(super) fn excalidraw_pen(page: &Page, _: &mut Stream) -> Option<Written> {
    let elements: Vec<Value> = page.lines.iter().map(|l| element(l, "freedraw", "transparent")).collect();
    Some(excalidraw("excalidraw", &elements))
}

pub(super) fn excalidraw_filled_lines(page: &Page, _: &mut Stream) -> Option<Written> {
    let elements: Vec<Value> = page.lines.iter().map(|l| element(l, "line", "#b2f2bb")).collect();
    Some(excalidraw("excalidraw", &elements))
}

/// Writes a frame as a rectangle, words and arrows, and something deleted.
pub(super) fn excalidraw_clipboard(page: &Page, _: &mut Stream) -> Option<Written> {
    let mut elements = vec![
        json!({"type": "rectangle", "x": 10, "y": 10, "width": page.size.x - 20.0, "height": page.size.y - 20.0,
            "strokeColor": "#1e1e1e", "backgroundColor": "#fff9db", "roundness": {"type": 3}}),
        json!({"type": "text", "x": 20, "y": 20, "text": "a plant"}),
        json!({"type": "arrow", "x": 20, "y": 40, "points": [[0, 0], [100, 100]]}),
        json!({"type": "line", "x": 0, "y": 0, "points": [[0, 0], [400, 300]], "isDeleted": true}),
    ];
    elements.extend(page.lines.iter().map(|l| element(l, "freedraw", "transparent")));
    Some(excalidraw("excalidraw/clipboard", &elements))
}

pub(super) fn tldraw(page: &Page, _: &mut Stream) -> Option<Written> {
    let mut records = vec![json!({"typeName": "page", "id": "page:p", "name": "p", "index": "a1"})];
    for (k, line) in page.lines.iter().enumerate() {
        let from = line.points[0];
        let points: Vec<Value> =
            line.points.iter().map(|p| *p - from).map(|p| json!({"x": p.x, "y": p.y, "z": 0.5})).collect();
        records.push(
            json!({"typeName": "shape", "type": "draw", "id": format!("shape:{k:05}"), "parentId": "page:p",
            "index": format!("b{k:05}"), "x": from.x, "y": from.y, "rotation": 0, "opacity": 1,
            "props": {"color": "black", "size": "m", "fill": "none", "isClosed": line.closed, "isPen": false,
                "segments": [{"type": "free", "points": points}]}}),
        );
    }
    records.push(json!({"typeName": "shape", "type": "text", "id": "shape:t", "parentId": "page:p", "index": "c1", "props": {}}));
    let file = json!({"tldrawFileFormatVersion": 1, "schema": {}, "records": records});
    Some(Written { bytes: file.to_string().into_bytes(), format: DrawingFormat::Tldraw })
}
