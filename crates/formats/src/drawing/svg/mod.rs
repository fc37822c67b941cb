//! SVG -> strokes: every visible sub-path is one stroke, in document order.
//!
//! Structure, ids and layers come from the XML itself; paths, shapes, transforms, `use` and the few style
//! properties that matter here are read by the modules beside this one.

mod path;
mod ribbon;
mod style;
mod write;

pub use write::write_svg;

use base::LiteMap;
use std::sync::Arc;

use base::Report;
use glam::{DAffine2, DVec2};
use ink::{Drawing, InkSample, Layer, Stroke};
use roxmltree::{Node, NodeId};

use self::path::SubPath;
use self::style::{Paint, Sheet, Style};
use super::{number_end, xml};
use crate::DrawingFormat;
use crate::error::{DrawingError, FileFault, Place};

const FORMAT: DrawingFormat = DrawingFormat::Svg;

/// Deepest chain of `use` elements; drawing programs stay below 4.
const MAX_USE: usize = 16;
/// Most elements after all `use` are expanded.
const MAX_ELEMENTS: usize = 200_000;
/// Most pieces of paths after all `use` are expanded.
const MAX_PIECES: usize = 6_000_000;
/// Most bytes of attributes after all `use` are expanded: each expansion reads them again.
const MAX_WORK: usize = 256 << 20;

/// A curve's error as a share of the drawing's diagonal: a tenth of the step that cleaning resamples with.
const FLATNESS: f64 = 5e-4;

/// A drawn element in the file's coordinates.
struct Shape {
    paths: Vec<SubPath>,
    style: Style,
    id: Option<String>,
    /// In the file's coordinates.
    width: Option<f64>,
}

/// More layers than that are one with the sheet.
const MAX_LAYERS: usize = 100;

struct Reader<'a> {
    /// In the order of ids; of one that several have, the first.
    by_id: Vec<(&'a str, NodeId)>,
    sheet: Sheet,
    viewport: DVec2,
    shapes: Vec<Shape>,
    layers: Vec<Layer>,
    elements: usize,
    pieces: usize,
    work: usize,
    left_out: LiteMap<&'static str, usize>,
    broken: Vec<Broken>,
}

/// An attribute that cannot be read to its end, and where it stands.
struct Broken {
    name: String,
    line: u64,
    attribute: &'static str,
}

pub(super) fn read(text: &str, name: &str, report: &mut Report) -> Result<Drawing, DrawingError> {
    let document = xml::parse(text, FORMAT)?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        let what = format!("the outermost element is <{}>, not <svg>", root.tag_name().name());
        let fault = FileFault::malformed(what, "is it really an SVG file?");
        return Err(DrawingError::new(FORMAT, xml::place(root), fault));
    }
    let mut sheet = Sheet::default();
    let mut by_id = Vec::new();
    for node in root.descendants().filter(Node::is_element) {
        if let Some(id) = node.attribute("id") {
            by_id.push((id, node.id()));
        }
        if node.tag_name().name() == "style" {
            node.children().filter_map(|n| n.text()).for_each(|css| sheet.add(css));
        }
    }
    base::sort_by(&mut by_id, |a, b| a.0.cmp(b.0));
    let mut reader = Reader {
        by_id,
        sheet,
        viewport: viewport(root),
        shapes: Vec::new(),
        layers: Vec::new(),
        elements: 0,
        pieces: 0,
        work: 0,
        left_out: LiteMap::new(),
        broken: Vec::new(),
    };
    reader.walk(root, Style::default(), DAffine2::IDENTITY, Depth::default())?;
    reader.tell(report);
    let title = root.children().find(|n| n.tag_name().name() == "title").and_then(|n| n.text());
    let title = title.map(str::trim).filter(|t| !t.is_empty());
    // A file's stem names it better than a title that every export of a program shares.
    let name = if name.is_empty() { title.unwrap_or_default() } else { name };
    // What is hidden comes last: numbers of strokes, and all that follows from them, are as if it were not there.
    let (hidden, seen): (Vec<Shape>, Vec<Shape>) = reader.shapes.into_iter().partition(|s| s.style.hidden);
    let mut all = strokes(&seen, &reader.layers, report);
    all.extend(strokes(&hidden, &reader.layers, &mut Report::default()));
    Ok(Drawing { name: name.to_owned(), strokes: all, layers: reader.layers })
}

#[derive(Clone, Copy, Default)]
struct Depth {
    elements: usize,
    uses: usize,
}

impl<'a> Reader<'a> {
    /// Bounded recursion: by the nesting of the XML, the chain of `use`, and both together.
    fn walk(
        &mut self,
        node: Node<'a, 'a>,
        inherited: Style,
        parent: DAffine2,
        depth: Depth,
    ) -> Result<(), DrawingError> {
        self.elements += 1;
        let limit = |what, limit: usize| {
            let advice = "expand the `use` elements in the drawing program or simplify the drawing";
            DrawingError::new(
                FORMAT,
                xml::place(node),
                FileFault::TooMuch { what, limit: limit as u64, advice },
            )
        };
        if self.elements > MAX_ELEMENTS {
            return Err(limit("the number of elements after expanding `use`", MAX_ELEMENTS));
        }
        if self.pieces > MAX_PIECES {
            return Err(limit("the number of points after expanding `use`", MAX_PIECES));
        }
        self.work += node.attributes().map(|a| a.value().len()).sum::<usize>();
        if self.work > MAX_WORK {
            return Err(limit("the text after expanding `use`, in bytes,", MAX_WORK));
        }
        if depth.elements > xml::MAX_DEPTH {
            return Err(limit("the nesting of elements", xml::MAX_DEPTH));
        }
        if depth.uses > MAX_USE {
            return Err(limit("the nesting of `use`", MAX_USE));
        }
        let mut style = inherited.of(node, &self.sheet);
        let seen = style.displayed && style.visible;
        if is_layer(node) {
            style.layer = self.layer(node, inherited.hidden || !seen).or(style.layer);
            if !seen && style.layer.is_some() {
                self.leave_out("hidden layer");
                (style.hidden, style.displayed, style.visible) = (true, true, true);
            }
        }
        if !style.displayed {
            self.leave_out("hidden");
            return Ok(());
        }
        let here = parent * self.own_transform(node);
        let deeper = Depth { elements: depth.elements + 1, ..depth };
        match node.tag_name().name() {
            "svg" | "g" | "a" | "switch" => {
                let here = if depth.elements == 0 { here } else { here * nested_viewport(node) };
                for child in node.children().filter(Node::is_element) {
                    self.walk(child, style, here, deeper)?;
                }
            }
            "use" => {
                let shift = DAffine2::from_translation(DVec2::new(self.x(node, "x"), self.y(node, "y")));
                let href = node.attributes().find(|a| a.name() == "href").map_or("", |a| a.value());
                let place = |id| {
                    self.by_id.get(self.by_id.partition_point(|row| row.0 < id)).filter(|row| row.0 == id)
                };
                let target = href.strip_prefix('#').and_then(place);
                let Some(target) = target.and_then(|&(_, id)| node.document().get_node(id)) else {
                    self.leave_out("use of something that is not in the file");
                    return Ok(());
                };
                let deeper = Depth { uses: depth.uses + 1, ..deeper };
                if target.tag_name().name() == "symbol" {
                    let style = style.of(target, &self.sheet);
                    for child in target.children().filter(Node::is_element) {
                        self.walk(child, style, here * shift, deeper)?;
                    }
                } else {
                    self.walk(target, style, here * shift, deeper)?;
                }
            }
            "text" => self.leave_out("text"),
            "image" => self.leave_out("image"),
            "foreignObject" => self.leave_out("foreignObject"),
            _ => self.shape(node, style, here),
        }
        Ok(())
    }

    /// The row of a layer: new, with a name that no other has. `None` where there are too many.
    fn layer(&mut self, node: Node<'_, '_>, hidden: bool) -> Option<usize> {
        if self.layers.len() >= MAX_LAYERS {
            return None;
        }
        let of = |name: &str| node.attributes().find(|a| a.name() == name).map(|a| a.value());
        let said = of("label").or(of("id")).unwrap_or_default();
        let plain: String = said.chars().map(|c| if c.is_control() { ' ' } else { c }).take(180).collect();
        let plain = if plain.trim().is_empty() { "layer".to_owned() } else { plain.trim().to_owned() };
        let taken = |name: &str| self.layers.iter().any(|l| &*l.name == name);
        let mut name = plain.clone();
        for k in 2..=MAX_LAYERS {
            if !taken(&name) {
                break;
            }
            name = format!("{plain} {k}");
        }
        let locked = of("insensitive") == Some("true");
        self.layers.push(Layer { name: name.into(), hidden, locked });
        Some(self.layers.len() - 1)
    }

    fn own_transform(&mut self, node: Node<'_, '_>) -> DAffine2 {
        let Some(text) = node.attribute("transform") else { return DAffine2::IDENTITY };
        path::transform(text).unwrap_or_else(|| {
            self.broken(node, "transform");
            DAffine2::IDENTITY
        })
    }

    fn shape(&mut self, node: Node<'_, '_>, style: Style, here: DAffine2) {
        let (paths, fault) = match node.tag_name().name() {
            "path" => path::parse(node.attribute("d").unwrap_or_default()),
            tag @ ("polyline" | "polygon") => {
                let (path, fault) =
                    path::poly(node.attribute("points").unwrap_or_default(), tag == "polygon");
                (path.into_iter().collect(), fault)
            }
            "line" => {
                let from = DVec2::new(self.x(node, "x1"), self.y(node, "y1"));
                let to = DVec2::new(self.x(node, "x2"), self.y(node, "y2"));
                let pieces = vec![path::Piece::Line(to)];
                (vec![SubPath { start: from, pieces, closed: false }], None)
            }
            "rect" => (self.rect(node, style), None),
            tag @ ("circle" | "ellipse") => {
                let centre = DVec2::new(self.x(node, "cx"), self.y(node, "cy"));
                let r = if tag == "circle" {
                    DVec2::splat(self.x(node, "r"))
                } else {
                    DVec2::new(self.x(node, "rx"), self.y(node, "ry"))
                };
                let drawn = r.x > 0.0 && r.y > 0.0;
                (drawn.then(|| path::ellipse(centre, r)).into_iter().collect(), None)
            }
            // Definitions, metadata, names of other programs: nothing that is drawn where it stands.
            _ => return,
        };
        if fault.is_some() {
            self.broken(node, if node.has_attribute("points") { "points" } else { "d" });
        }
        if paths.is_empty() {
            return;
        }
        if !style.visible {
            return self.leave_out("hidden");
        }
        if style.stroke == Paint::None && style.fill == Paint::None {
            return self.leave_out("shape without stroke and fill");
        }
        let mut paths = paths;
        for path in &mut paths {
            path.transform(here);
            self.pieces += path.pieces.len() + 1;
        }
        let id = node.attribute("id").map(str::to_owned);
        let scale = here.matrix2.determinant().abs().sqrt();
        let painted = style.stroke != Paint::None;
        let width = style.width.map(|w| w * scale).filter(|w| painted && w.is_finite() && *w > 0.0);
        self.shapes.push(Shape { paths, style, id, width });
    }

    fn rect(&mut self, node: Node<'_, '_>, style: Style) -> Vec<SubPath> {
        let at = DVec2::new(self.x(node, "x"), self.y(node, "y"));
        let size = DVec2::new(self.x(node, "width"), self.y(node, "height"));
        if !(size.x > 0.0 && size.y > 0.0) {
            return Vec::new();
        }
        // 0.95: programs that paint the sheet leave at most a thin rim.
        let sheet = style.stroke == Paint::None && size.cmpge(self.viewport * 0.95).all();
        if sheet && self.viewport.min_element() > 0.0 {
            self.leave_out("rectangle that paints the whole sheet");
            return Vec::new();
        }
        let (rx, ry) = (node.attribute("rx"), node.attribute("ry"));
        let (rx, ry) = (rx.or(ry).map(|v| self.length(v, 0)), ry.or(rx).map(|v| self.length(v, 1)));
        vec![path::rect(at, size, DVec2::new(rx.unwrap_or(0.0), ry.unwrap_or(0.0)))]
    }

    fn x(&self, node: Node<'_, '_>, name: &str) -> f64 {
        node.attribute(name).map_or(0.0, |v| self.length(v, 0))
    }

    fn y(&self, node: Node<'_, '_>, name: &str) -> f64 {
        node.attribute(name).map_or(0.0, |v| self.length(v, 1))
    }

    fn length(&self, text: &str, axis: usize) -> f64 {
        length(text, if axis == 0 { self.viewport.x } else { self.viewport.y })
    }

    fn leave_out(&mut self, what: &'static str) {
        *self.left_out.entry(what).or_default() += 1;
    }

    fn broken(&mut self, node: Node<'_, '_>, attribute: &'static str) {
        // The place of an element costs a walk over the text: a few are enough for the user to find the rest.
        if self.broken.len() < 5 {
            if let Place::Element { name, line } = xml::place(node) {
                self.broken.push(Broken { name, line, attribute });
            }
        } else {
            self.leave_out("further broken attribute");
        }
    }

    fn tell(&self, report: &mut Report) {
        for broken in &self.broken {
            base::warn!(
                report,
                "svg-broken",
                { line = broken.line, name = broken.name, attribute = broken.attribute },
                "line {line}, {name}: the attribute `{attribute}` is broken; what could be read before the fault was kept"
            );
        }
        for (what, count) in &self.left_out {
            base::warn!(report, "svg-left-out", { what = what, count = count }, "left out: {what} ({count})");
        }
        if self.sheet.ignored > 0 {
            base::warn!(
                report,
                "svg-style",
                { count = self.sheet.ignored },
                "{count} compound style selectors were not looked at"
            );
        }
    }
}

/// Whether an element is a layer of Inkscape's.
fn is_layer(node: Node<'_, '_>) -> bool {
    node.tag_name().name() == "g"
        && node.attributes().any(|a| a.name() == "groupmode" && a.value() == "layer")
}

/// A length in user units; percents of `whole`.
fn length(text: &str, whole: f64) -> f64 {
    let text = text.trim();
    let end = number_end(text);
    let value: f64 = text[..end].parse().unwrap_or(0.0);
    // CSS: 96 px to the inch.
    value
        * match &text[end..] {
            "%" => whole / 100.0,
            "mm" => 96.0 / 25.4,
            "cm" => 96.0 / 2.54,
            "in" => 96.0,
            "pt" => 96.0 / 72.0,
            "pc" | "em" | "rem" => 16.0,
            _ => 1.0,
        }
}

fn view_box(node: Node<'_, '_>) -> Option<[f64; 4]> {
    let text = node.attribute("viewBox")?;
    let mut numbers = text.split([' ', ',', '\t', '\n', '\r']).filter(|t| !t.is_empty());
    let mut out = [0.0; 4];
    for value in &mut out {
        *value = numbers.next()?.parse().ok()?;
    }
    (out[2] > 0.0 && out[3] > 0.0).then_some(out)
}

/// Width and height of the sheet in user units; zero where the file does not say.
fn viewport(root: Node<'_, '_>) -> DVec2 {
    match view_box(root) {
        Some([_, _, w, h]) => DVec2::new(w, h),
        None => {
            let side = |name| root.attribute(name).map_or(0.0, |v| length(v, 0.0));
            DVec2::new(side("width"), side("height"))
        }
    }
}

/// Placement of an inner `<svg>`.
fn nested_viewport(node: Node<'_, '_>) -> DAffine2 {
    if node.tag_name().name() != "svg" {
        return DAffine2::IDENTITY;
    }
    let side = |name| node.attribute(name).map_or(0.0, |v| length(v, 0.0));
    let shift = DAffine2::from_translation(DVec2::new(side("x"), side("y")));
    let Some([x, y, w, h]) = view_box(node) else { return shift };
    let scale = (side("width") / w).min(side("height") / h);
    let scale = if scale > 0.0 { scale } else { 1.0 };
    shift * DAffine2::from_scale(DVec2::splat(scale)) * DAffine2::from_translation(DVec2::new(-x, -y))
}

fn strokes(shapes: &[Shape], layers: &[Layer], report: &mut Report) -> Vec<Stroke> {
    let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let points = shapes.iter().flat_map(|s| &s.paths).flat_map(SubPath::control_points);
    for p in points.filter(|p| p.is_finite()) {
        min = min.min(p);
        max = max.max(p);
    }
    let diagonal = (max - min).length();
    let tolerance = (diagonal * FLATNESS).max(f64::MIN_POSITIVE);
    let flat: Vec<Vec<Vec<DVec2>>> =
        shapes.iter().map(|s| s.paths.iter().map(|p| p.flatten(tolerance)).collect()).collect();
    let candidates: Vec<ribbon::Candidate<'_>> = shapes
        .iter()
        .zip(&flat)
        .map(|(shape, lines)| ribbon::Candidate {
            lines,
            fill_only: shape.style.stroke == Paint::None,
            fill_said: shape.style.fill_said,
        })
        .collect();
    let centre_lines = ribbon::centre_lines(&candidates, diagonal);
    let mut out = Vec::new();
    let mut reduced = 0_usize;
    for ((shape, lines), centre) in shapes.iter().zip(flat).zip(centre_lines) {
        let color = shape.style.stroke.color().or_else(|| shape.style.fill.color());
        let layer = shape.style.layer.and_then(|row| layers.get(row));
        let stroke = |samples: Vec<InkSample>| Stroke {
            samples,
            mode: shape.style.mode,
            color,
            width: shape.width,
            layer: layer.map(|l| Arc::clone(&l.name)),
            hidden: shape.style.hidden,
            id: shape.id.clone(),
        };
        if let Some(line) = centre {
            reduced += 1;
            let samples = line.into_iter().map(|(at, pressure)| InkSample {
                at: up(at),
                time_ms: None,
                pressure: Some(pressure),
            });
            out.push(stroke(samples.collect()));
        } else {
            out.extend(lines.into_iter().map(|l| stroke(l.into_iter().map(|p| up(p).into()).collect())));
        }
    }
    if reduced > 0 {
        base::warn!(
            report,
            "filled-outline",
            { count = reduced },
            "{count} filled shapes are strokes of a variable-width pen: their centre lines were taken, \
             and their widths as pressure"
        );
    }
    out
}

/// The sheet's y points down, ours up.
fn up(p: DVec2) -> DVec2 {
    DVec2::new(p.x, 0.0 - p.y)
}

#[cfg(test)]
mod tests;
