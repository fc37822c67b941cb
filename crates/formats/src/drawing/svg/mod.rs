//! SVG -> strokes: every visible sub-path is one stroke, in document order.
//!
//! Structure, ids and layers come from the XML itself; the modules here read paths, shapes, transforms, `use` and the
//! few style properties that matter.

mod path;
mod style;
mod write;

pub use write::write_svg;

use base::LiteMap;
use std::sync::Arc;

use base::Report;
use glam::{DAffine2, DVec2};
use ink::{Drawing, Figure, Fill, Layer, Stroke};
use roxmltree::{Node, NodeId};

use self::path::SubPath;
use self::style::{Paint, Sheet, Style};
use super::{number_end, plain_strokes, xml};
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

/// Tolerance of a flattened curve as a share of the drawing's diagonal: a tenth of the step with which cleaning
/// resamples.
const FLATNESS: f64 = 5e-4;

/// Font size of a text that gives none, as in browsers, in pixels.
const USUAL_FONT: f64 = 16.0;
/// Mean width of a letter, as a share of the font size.
const LETTER_WIDTH: f64 = 0.52;
/// Height of letters above the baseline, as a share of the font size.
const ASCENT: f64 = 0.8;
/// Most letters of a text that count for its width.
const MOST_LETTERS: usize = 200;

/// A drawn element in the file's coordinates.
struct Shape {
    paths: Vec<SubPath>,
    style: Style,
    id: Option<String>,
    /// In the file's coordinates.
    width: Option<f64>,
}

/// Most layers; the elements of further ones are on the sheet itself.
const MAX_LAYERS: usize = 100;

struct Reader<'a> {
    /// In the order of ids; the first of several elements with the same id.
    by_id: Vec<(&'a str, NodeId)>,
    sheet: Sheet,
    viewport: DVec2,
    shapes: Vec<Shape>,
    /// Boxes around texts, in the file's coordinates.
    words: Vec<(DVec2, DVec2)>,
    layers: Vec<Layer>,
    elements: usize,
    pieces: usize,
    work: usize,
    left_out: LiteMap<&'static str, usize>,
    broken: Vec<Broken>,
    /// The targets of the enclosing `use` elements.
    using: Vec<NodeId>,
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
    sheet.servers = style::servers(root, &sheet);
    let mut reader = Reader {
        by_id,
        sheet,
        viewport: viewport(root),
        shapes: Vec::new(),
        words: Vec::new(),
        layers: Vec::new(),
        elements: 0,
        pieces: 0,
        work: 0,
        left_out: LiteMap::new(),
        broken: Vec::new(),
        using: Vec::new(),
    };
    reader.walk(root, Style::default(), stretched(root), Depth::default())?;
    reader.tell(report);
    let title = root.children().find(|n| n.tag_name().name() == "title").and_then(|n| n.text());
    let title = title.map(str::trim).filter(|t| !t.is_empty());
    // The name of the file is better than a title that all exports of a program share.
    let name = if name.is_empty() { title.unwrap_or_default() } else { name };
    // Hidden strokes come last: the numbers of the others, and all that follows from them, are as if the hidden ones
    // were absent.
    let (hidden, seen): (Vec<Shape>, Vec<Shape>) = reader.shapes.into_iter().partition(|s| s.style.hidden);
    let corners = sheet_corners(root);
    let words: Vec<(DVec2, DVec2)> =
        reader.words.iter().map(|w| both((up(w.0), up(w.0)), (up(w.1), up(w.1)))).collect();
    let around = Around { layers: &reader.layers, sheet: corners, words: &words };
    let mut all = strokes(&seen, &around, report);
    all.extend(strokes(&hidden, &around, &mut Report::default()));
    Ok(Drawing { name: name.to_owned(), strokes: all, layers: reader.layers })
}

#[derive(Clone, Copy, Default)]
struct Depth {
    elements: usize,
    uses: usize,
}

impl<'a> Reader<'a> {
    /// Reads an element by [`Self::enter`], turns it in its own box, and cuts it by its clip path and mask.
    fn walk(
        &mut self,
        node: Node<'a, 'a>,
        inherited: Style,
        parent: DAffine2,
        depth: Depth,
    ) -> Result<(), DrawingError> {
        let before = self.shapes.len();
        self.enter(node, inherited, parent, depth)?;
        if self.is_turned_in_own_box(node) {
            self.turn_in_own_box(node, before, parent);
        }
        for window in ["clip-path", "mask"] {
            self.cut(node, before, window, (parent, depth))?;
        }
        Ok(())
    }

    /// Removes the shapes of an element that lie wholly outside its clip path or mask.
    fn cut(
        &mut self,
        node: Node<'a, 'a>,
        before: usize,
        property: &str,
        (parent, depth): (DAffine2, Depth),
    ) -> Result<(), DrawingError> {
        let Some(said) = self.said(node, property) else { return Ok(()) };
        let Some(clip) = style::reference(&said).and_then(|(id, _)| self.target(node, id)) else {
            return Ok(());
        };
        let is_mask = clip.tag_name().name() == "mask";
        let units = clip.attribute(if is_mask { "maskContentUnits" } else { "clipPathUnits" });
        if !(is_mask || clip.tag_name().name() == "clipPath")
            || units == Some("objectBoundingBox")
            || self.shapes.len() == before
            || depth.uses >= MAX_USE
        {
            return Ok(());
        }
        let drawn = self.shapes.len();
        let here = parent * self.own_transform(node) * self.own_transform(clip);
        let deeper = Depth { uses: depth.uses + 1, elements: depth.elements + 1 };
        for child in clip.children().filter(Node::is_element) {
            self.walk(child, Style::default(), here, deeper)?;
        }
        // A mask shows what lies under any paint in it other than black.
        let shows = |shape: &Shape| {
            let paints = [shape.style.stroke, shape.style.fill];
            !is_mask || paints.iter().any(|p| !matches!(p, Paint::None | Paint::Color([0, 0, 0])))
        };
        let window = self.shapes.split_off(drawn).iter().filter(|s| shows(s)).filter_map(extent).reduce(both);
        let inside = |shape: &Shape| match (window, extent(shape)) {
            (Some((lo, hi)), Some((from, to))) => from.cmple(hi).all() && to.cmpge(lo).all(),
            // A window whose shapes cannot be read, such as text, cuts nothing off.
            (window, _) => window.is_some() || clip.children().any(|n| n.is_element()),
        };
        let kept: Vec<Shape> = self.shapes.split_off(before).into_iter().filter(inside).collect();
        for _ in kept.len()..drawn - before {
            self.leave_out("clipped away");
        }
        self.shapes.extend(kept);
        Ok(())
    }

    /// Returns whether an element has a transform about a point in its own box (`transform-box` of CSS).
    fn is_turned_in_own_box(&self, node: Node<'_, '_>) -> bool {
        let own =
            |text: String| matches!(text.trim(), "fill-box" | "content-box" | "stroke-box" | "border-box");
        self.said(node, "transform-box").is_some_and(own)
    }

    /// Applies the transform of an element to the shapes that it has drawn so far, about a point in their box.
    fn turn_in_own_box(&mut self, node: Node<'_, '_>, before: usize, parent: DAffine2) {
        let Some(turn) = self.said(node, "transform").and_then(|t| path::transform(&t, self.viewport)) else {
            return;
        };
        let back = parent.inverse();
        let drawn = self.shapes[before..].iter_mut();
        let moved = |shape: &mut Shape, by: DAffine2| shape.paths.iter_mut().for_each(|p| p.transform(by));
        let mut shapes: Vec<&mut Shape> = drawn.collect();
        if !back.is_finite() {
            return;
        }
        shapes.iter_mut().for_each(|s| moved(s, back));
        let own = shapes.iter().filter_map(|s| extent(s)).reduce(both);
        let (lo, hi) = own.unwrap_or_default();
        let said = node.attribute("style").and_then(|s| style::declared(s, "transform-origin"));
        let said = said.map(str::to_owned).or_else(|| self.sheet.value(node, "transform-origin"));
        let said = said.or_else(|| node.attribute("transform-origin").map(str::to_owned));
        let centre = lo + said.and_then(|text| origin(&text, hi - lo)).unwrap_or_default();
        let turned =
            DAffine2::from_translation(centre) * turn * DAffine2::from_translation(DVec2::ZERO - centre);
        let scale = turn.matrix2.determinant().abs().sqrt();
        for shape in shapes {
            moved(shape, parent * turned);
            shape.width = shape.width.map(|w| w * scale).filter(|w| w.is_finite() && *w > 0.0);
        }
    }

    /// Returns the element with this id.
    fn target(&self, node: Node<'a, 'a>, id: &str) -> Option<Node<'a, 'a>> {
        let row = self.by_id.get(self.by_id.partition_point(|row| row.0 < id)).filter(|row| row.0 == id);
        row.and_then(|&(_, id)| node.document().get_node(id))
    }

    /// Returns a property of an element itself: from its style, from the sheet, or from an attribute.
    fn said(&self, node: Node<'_, '_>, name: &str) -> Option<String> {
        let inline = node.attribute("style").and_then(|s| style::declared(s, name)).map(str::to_owned);
        inline.or_else(|| self.sheet.value(node, name)).or_else(|| node.attribute(name).map(str::to_owned))
    }

    /// Reads an element and its children. The recursion is bounded by the nesting of the XML, the chain of `use`, and
    /// both together.
    fn enter(
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
        let mut style = inherited.for_child(node, &self.sheet);
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
                // Cairo and other programs write text as outlines of its letters.
                if href.starts_with("#glyph") {
                    self.leave_out("text");
                    return Ok(());
                }
                let Some(target) = href.strip_prefix('#').and_then(|id| self.target(node, id)) else {
                    self.leave_out("use of something that is not in the file");
                    return Ok(());
                };
                if self.using.contains(&target.id()) || node.ancestors().any(|a| a == target) {
                    self.leave_out("use that refers to itself");
                    return Ok(());
                }
                self.using.push(target.id());
                let deeper = Depth { uses: depth.uses + 1, ..deeper };
                if target.tag_name().name() == "symbol" {
                    let style = style.for_child(target, &self.sheet);
                    let here = here
                        * shift
                        * viewport_of(target, [node.attribute("width"), node.attribute("height")]);
                    for child in target.children().filter(Node::is_element) {
                        self.walk(child, style, here, deeper)?;
                    }
                } else {
                    self.walk(target, style, here * shift, deeper)?;
                }
                self.using.pop();
            }
            "text" => {
                self.leave_out("text");
                self.words.extend(self.box_of_words(node, here));
            }
            "image" => self.leave_out("image"),
            "foreignObject" => self.leave_out("foreignObject"),
            _ => self.shape(node, style, here),
        }
        Ok(())
    }

    /// Estimates the box of a text, which only the font would give exactly; `None` if it has no letters or no finite
    /// box.
    fn box_of_words(&self, node: Node<'_, '_>, here: DAffine2) -> Option<(DVec2, DVec2)> {
        let spans = || node.descendants().filter(|n| matches!(n.tag_name().name(), "text" | "tspan"));
        let placed = |name: &str| spans().find_map(|n| n.attribute(name)).map(str::to_owned);
        // Font size and anchor are inherited.
        let said = |name: &str| spans().chain(node.ancestors()).find_map(|n| self.said(n, name));
        let at = DVec2::new(
            placed("x").map_or(0.0, |v| self.length(&v, 0)),
            placed("y").map_or(0.0, |v| self.length(&v, 1)),
        );
        let size = said("font-size").map_or(USUAL_FONT, |v| length(&v, USUAL_FONT));
        let letters = node.descendants().filter_map(|n| n.text().filter(|_| n.is_text()));
        let count = letters.map(|t| t.trim().chars().count()).sum::<usize>().min(MOST_LETTERS);
        #[expect(clippy::cast_precision_loss, reason = "a few letters")]
        let width = count as f64 * LETTER_WIDTH * size;
        let before = match said("text-anchor").as_deref().map(str::trim) {
            Some("middle") => 0.5 * width,
            Some("end") => width,
            _ => 0.0,
        };
        let from = at - DVec2::new(before, ASCENT * size);
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        let placed = corners.map(|c| here.transform_point2(from + DVec2::from(c) * DVec2::new(width, size)));
        let boxed = placed.into_iter().map(|p| (p, p)).reduce(both)?;
        (count > 0 && boxed.0.is_finite() && boxed.1.is_finite()).then_some(boxed)
    }

    /// Adds a layer under a name that no other has, and returns its row. `None` if there are too many.
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
        let Some(text) = self.said(node, "transform") else { return DAffine2::IDENTITY };
        if self.is_turned_in_own_box(node) {
            return DAffine2::IDENTITY;
        }
        let Some(own) = path::transform(&text, self.viewport) else {
            self.broken(node, "transform");
            return DAffine2::IDENTITY;
        };
        let origin = self.said(node, "transform-origin").and_then(|text| origin(&text, self.viewport));
        let Some(origin) = origin else { return own };
        DAffine2::from_translation(origin) * own * DAffine2::from_translation(DVec2::ZERO - origin)
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
            "rect" => (self.rect(node), None),
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
            // Definitions, metadata, elements of other programs: nothing that is drawn here.
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
        if !style.is_lined() && !style.is_filled() {
            return self.leave_out("invisible");
        }
        let marker = |name: &&str| self.said(node, name).is_some_and(|v| v.trim() != "none");
        if ["marker-end", "marker-start"].iter().any(marker) {
            return self.leave_out("arrow");
        }
        let mut paths = paths;
        for path in &mut paths {
            path.transform(here);
            self.pieces += path.pieces.len() + 1;
        }
        let id = node.attribute("id").map(str::to_owned);
        let scale = here.matrix2.determinant().abs().sqrt();
        let width = style.width.map(|w| w * scale).filter(|w| style.is_lined() && w.is_finite() && *w > 0.0);
        self.shapes.push(Shape { paths, style, id, width });
    }

    fn rect(&self, node: Node<'_, '_>) -> Vec<SubPath> {
        let at = DVec2::new(self.x(node, "x"), self.y(node, "y"));
        let size = DVec2::new(self.x(node, "width"), self.y(node, "height"));
        if !(size.x > 0.0 && size.y > 0.0) {
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
        // Finding the line of an element costs a walk over the text: a few are enough for the user to find the rest.
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

/// Returns whether an element is a layer of Inkscape.
fn is_layer(node: Node<'_, '_>) -> bool {
    node.tag_name().name() == "g"
        && node.attributes().any(|a| a.name() == "groupmode" && a.value() == "layer")
}

/// Parses a length in user units; percents of `whole`.
fn length(text: &str, whole: f64) -> f64 {
    let text = text.trim();
    let end = number_end(text);
    let value: f64 = text[..end].parse().unwrap_or(0.0);
    // CSS has 96 px to the inch.
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

/// Returns width and height of the sheet in user units; zero if the file does not say.
fn viewport(root: Node<'_, '_>) -> DVec2 {
    match view_box(root) {
        Some([_, _, w, h]) => DVec2::new(w, h),
        None => {
            let side = |name| root.attribute(name).map_or(0.0, |v| length(v, 0.0));
            DVec2::new(side("width"), side("height"))
        }
    }
}

/// Returns the corners of the sheet, y up; `None` if the file does not say.
fn sheet_corners(root: Node<'_, '_>) -> Option<(DVec2, DVec2)> {
    let size = viewport(root);
    let at = view_box(root).map_or(DVec2::ZERO, |[x, y, ..]| DVec2::new(x, y));
    let map = stretched(root);
    let (a, b) = (map.transform_point2(at), map.transform_point2(at + size));
    (size.min_element() > 0.0).then(|| (DVec2::new(a.x, 0.0 - b.y), DVec2::new(b.x, 0.0 - a.y)))
}

/// Returns the stretch of a sheet whose sides need not keep their proportion.
fn stretched(root: Node<'_, '_>) -> DAffine2 {
    let free = root.attribute("preserveAspectRatio").is_some_and(|v| v.trim().starts_with("none"));
    let side = |name| root.attribute(name).filter(|v| !v.contains('%')).map(|v| length(v, 0.0));
    match (view_box(root), side("width"), side("height")) {
        (Some([_, _, w, h]), Some(wide), Some(high)) if free && wide > 0.0 && high > 0.0 => {
            DAffine2::from_scale(DVec2::new((wide / w) / (high / h), 1.0))
        }
        _ => DAffine2::IDENTITY,
    }
}

/// Returns the placement of an inner `<svg>`.
fn nested_viewport(node: Node<'_, '_>) -> DAffine2 {
    if node.tag_name().name() != "svg" {
        return DAffine2::IDENTITY;
    }
    let side = |name| node.attribute(name).map_or(0.0, |v| length(v, 0.0));
    let shift = DAffine2::from_translation(DVec2::new(side("x"), side("y")));
    shift * viewport_of(node, [node.attribute("width"), node.attribute("height")])
}

/// Returns the map from an element's view box to the rectangle in which it is shown.
fn viewport_of(node: Node<'_, '_>, size: [Option<&str>; 2]) -> DAffine2 {
    let Some([x, y, w, h]) = view_box(node) else { return DAffine2::IDENTITY };
    let [wide, high] = size.map(|v| v.map_or(0.0, |v| length(v, 0.0)));
    let from = DAffine2::from_translation(DVec2::new(-x, -y));
    let scale = DVec2::new(wide / w, high / h);
    if !(scale.min_element() > 0.0 && scale.is_finite()) {
        return from;
    }
    let how = node.attribute("preserveAspectRatio").unwrap_or_default();
    if how.trim().starts_with("none") {
        return DAffine2::from_scale(scale) * from;
    }
    let even = if how.contains("slice") { scale.max_element() } else { scale.min_element() };
    let along = |min: &str, max: &str| match () {
        () if how.contains(min) => 0.0,
        () if how.contains(max) => 1.0,
        () => 0.5,
    };
    let free = DVec2::new(wide, high) - DVec2::new(w, h) * even;
    let shift = free * DVec2::new(along("xMin", "xMax"), along("YMin", "YMax"));
    DAffine2::from_translation(shift) * DAffine2::from_scale(DVec2::splat(even)) * from
}

/// Parses `transform-origin`: two lengths, percents of the sheet, or words for its sides.
fn origin(text: &str, sheet: DVec2) -> Option<DVec2> {
    let words: Vec<&str> = text.split_ascii_whitespace().take(2).collect();
    let mut at = [None; 2];
    for (k, word) in words.iter().enumerate() {
        let (axis, share) = match *word {
            "left" => (0, 0.0),
            "right" => (0, 1.0),
            "top" => (1, 0.0),
            "bottom" => (1, 1.0),
            "center" => (k, 0.5),
            number => {
                let whole = if k == 0 { DVec2::new(sheet.x, 0.0) } else { DVec2::new(sheet.y, 0.0) };
                at[k] = path::css_numbers(number, whole)?.first().copied();
                continue;
            }
        };
        at[axis] = Some(sheet[axis] * share);
    }
    let [x, y] = at;
    if x.is_none() && y.is_none() {
        return None;
    }
    Some(DVec2::new(x.unwrap_or(0.5 * sheet.x), y.unwrap_or(0.5 * sheet.y)))
}

/// Returns the box of a shape.
fn extent(shape: &Shape) -> Option<(DVec2, DVec2)> {
    let points = shape.paths.iter().flat_map(SubPath::control_points).filter(|p| p.is_finite());
    points.map(|p| (p, p)).reduce(both)
}

fn both(a: (DVec2, DVec2), b: (DVec2, DVec2)) -> (DVec2, DVec2) {
    (a.0.min(b.0), a.1.max(b.1))
}

/// Surroundings of the strokes.
struct Around<'a> {
    layers: &'a [Layer],
    /// The corners of the sheet, y up.
    sheet: Option<(DVec2, DVec2)>,
    /// Boxes around texts, y up.
    words: &'a [(DVec2, DVec2)],
}

fn strokes(shapes: &[Shape], around: &Around<'_>, report: &mut Report) -> Vec<Stroke> {
    let diagonal = shapes.iter().filter_map(extent).reduce(both).map_or(0.0, |(lo, hi)| (hi - lo).length());
    let tolerance = (diagonal * FLATNESS).max(f64::MIN_POSITIVE);
    let figure = |shape: &Shape| {
        let style = &shape.style;
        let color = Some(style.stroke).filter(|_| style.is_lined()).and_then(Paint::color);
        let like = Stroke {
            samples: Vec::new(),
            mode: style.mode,
            color: color.or_else(|| style.fill.color()),
            width: shape.width,
            layer: style.layer.and_then(|row| around.layers.get(row)).map(|l| Arc::clone(&l.name)),
            hidden: style.hidden,
            id: shape.id.clone(),
        };
        let flat = |p: &SubPath| p.flatten(tolerance).into_iter().map(|p| up(p).into()).collect();
        Figure {
            like,
            lines: shape.paths.iter().map(flat).collect(),
            lined: style.is_lined(),
            fill: style.is_filled().then(|| Fill {
                color: style.fill.color(),
                said: style.fill_said,
                opacity: style.area_opacity(),
                even_odd: style.even_odd,
            }),
        }
    };
    plain_strokes(shapes.iter().map(figure).collect(), around.sheet, around.words, report)
}

/// Flips y: on the sheet it points down, in our drawings up.
fn up(p: DVec2) -> DVec2 {
    DVec2::new(p.x, 0.0 - p.y)
}

#[cfg(test)]
mod tests;
