//! `InkML` (W3C Recommendation, 2011) -> strokes. Y points down, as the standard says, unless its channel is oriented
//! `-ve`. Brush widths and canvas transforms are ignored.

use std::collections::BTreeMap;

use base::LiteMap;

use base::Report;
use glam::DVec2;
use ink::{Drawing, InkSample, Stroke, StrokeMode};
use roxmltree::Node;

use super::mode::mode_in;
use super::{parse_color, xml};
use crate::DrawingFormat;
use crate::error::{DrawingError, FileFault, Place};

const FORMAT: DrawingFormat = DrawingFormat::InkMl;

/// Most channels of a trace; tablets have fewer than twenty.
const MAX_CHANNELS: usize = 64;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Role {
    X,
    Y,
    Time,
    Pressure,
    Other,
}

#[derive(Clone, Debug)]
struct Channel {
    role: Role,
    /// Factor of the value: milliseconds for times, 1 / maximum for pressures, -1 for reversed axes.
    factor: f64,
}

/// Channels in the order in which a point lists them; the ones from `regular` on may be missing.
#[derive(Clone, Debug)]
struct Layout {
    channels: Vec<Channel>,
    regular: usize,
}

impl Default for Layout {
    fn default() -> Self {
        let channel = |role, factor| Channel { role, factor };
        Self { channels: vec![channel(Role::X, 1.0), channel(Role::Y, -1.0)], regular: 2 }
    }
}

#[derive(Clone, Default)]
struct Context {
    layout: Layout,
    color: Option<[u8; 3]>,
}

struct Reader<'a> {
    contexts: LiteMap<&'a str, Context>,
    layouts: LiteMap<&'a str, Layout>,
    brushes: LiteMap<&'a str, Option<[u8; 3]>>,
    /// Settings of plain `<context>` elements in the body, for the traces after them.
    current: Context,
    strokes: Vec<Stroke>,
    by_id: BTreeMap<&'a str, usize>,
    transforms: usize,
}

pub(super) fn read(text: &str, name: &str, report: &mut Report) -> Result<Drawing, DrawingError> {
    let document = xml::parse(text, FORMAT)?;
    let root = document.root_element();
    if root.tag_name().name() != "ink" {
        let what = format!("the outermost element is <{}>, not <ink>", root.tag_name().name());
        let fault = FileFault::malformed(what, "is it really an InkML file?");
        return Err(DrawingError::new(FORMAT, xml::place(root), fault));
    }
    let mut reader = Reader {
        contexts: LiteMap::new(),
        layouts: LiteMap::new(),
        brushes: LiteMap::new(),
        current: Context::default(),
        strokes: Vec::new(),
        by_id: BTreeMap::new(),
        transforms: 0,
    };
    reader.definitions(root)?;
    reader.body(root, None, StrokeMode::Parts)?;
    if reader.transforms > 0 {
        report.warn(
            "inkml-transform",
            "canvas transforms were left aside: points are read as they are written",
        );
    }
    let title = root.children().find(|n| is_annotation(*n, "name")).and_then(|n| n.text());
    let name = title.map_or(name, str::trim);
    Ok(Drawing { name: name.to_owned(), strokes: reader.strokes, ..Drawing::default() })
}

fn is_annotation(node: Node<'_, '_>, kind: &str) -> bool {
    node.tag_name().name() == "annotation" && node.attribute("type") == Some(kind)
}

fn id<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    node.attributes().find(|a| a.name() == "id").map(|a| a.value())
}

fn own_mode(node: Node<'_, '_>) -> Option<StrokeMode> {
    let said = node.children().find(|n| is_annotation(*n, "mode")).and_then(|n| n.text());
    said.and_then(mode_in).or_else(|| id(node).and_then(mode_in))
}

impl<'a> Reader<'a> {
    /// Collects everything that can be referred to, wherever it stands, so that order does not matter.
    fn definitions(&mut self, root: Node<'a, 'a>) -> Result<(), DrawingError> {
        for node in root.descendants().filter(|n| n.tag_name().name() == "traceFormat") {
            if let Some(id) = id(node) {
                self.layouts.insert(id, layout(node)?);
            }
        }
        for node in root.descendants() {
            match node.tag_name().name() {
                "brush" => {
                    let color = node.children().find(|n| n.attribute("name") == Some("color"));
                    let color = color.and_then(|n| n.attribute("value")).and_then(parse_color);
                    if let Some(id) = id(node) {
                        self.brushes.insert(id, color);
                    }
                }
                "canvasTransform" => self.transforms += 1,
                _ => {}
            }
        }
        let contexts: Vec<_> = root.descendants().filter(|n| n.tag_name().name() == "context").collect();
        for node in contexts {
            let context = self.context(node, &Context::default())?;
            if let Some(id) = id(node) {
                self.contexts.insert(id, context);
            }
        }
        Ok(())
    }

    fn context(&self, node: Node<'a, 'a>, inherited: &Context) -> Result<Context, DrawingError> {
        let target = |attribute| node.attribute(attribute).map(local);
        let mut context = match target("contextRef") {
            Some(id) => self.contexts.get(id).cloned().unwrap_or_else(|| inherited.clone()),
            None => inherited.clone(),
        };
        if let Some(layout) = target("traceFormatRef").and_then(|id| self.layouts.get(id)) {
            context.layout = layout.clone();
        }
        // A format stands in the context itself or in its ink source.
        let inner = node.descendants().find(|n| n.tag_name().name() == "traceFormat");
        if let Some(inner) = inner {
            context.layout = layout(inner)?;
        }
        if let Some(&color) = target("brushRef").and_then(|id| self.brushes.get(id)) {
            context.color = color;
        }
        Ok(context)
    }

    /// Reads the traces of an element. The recursion is bounded, because the nesting of the XML is.
    fn body(
        &mut self,
        node: Node<'a, 'a>,
        group: Option<&Context>,
        mode: StrokeMode,
    ) -> Result<(), DrawingError> {
        for child in node.children().filter(Node::is_element) {
            match child.tag_name().name() {
                "context" if group.is_none() => self.current = self.context(child, &self.current)?,
                "traceFormat" if group.is_none() => self.current.layout = layout(child)?,
                "traceGroup" => {
                    let inherited = group.unwrap_or(&self.current).clone();
                    let context = self.context_of(child, &inherited)?;
                    self.body(child, Some(&context), own_mode(child).unwrap_or(mode))?;
                }
                "trace" => {
                    let inherited = group.unwrap_or(&self.current).clone();
                    let context = self.context_of(child, &inherited)?;
                    self.trace(child, &context, own_mode(child).unwrap_or(mode))?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn context_of(&self, node: Node<'a, 'a>, inherited: &Context) -> Result<Context, DrawingError> {
        let mut context = inherited.clone();
        if let Some(reference) = node.attribute("contextRef") {
            let found = self.contexts.get(local(reference)).ok_or_else(|| {
                let what = format!("it refers to the context {reference:?}, which is not in the file");
                let fault = FileFault::malformed(what, "add the context or remove the reference");
                DrawingError::new(FORMAT, xml::place(node), fault)
            })?;
            context = found.clone();
        }
        if let Some(&color) = node.attribute("brushRef").and_then(|r| self.brushes.get(local(r))) {
            context.color = color;
        }
        Ok(context)
    }

    fn trace(&mut self, node: Node<'a, 'a>, context: &Context, mode: StrokeMode) -> Result<(), DrawingError> {
        if node.attribute("type") == Some("penUp") {
            return Ok(());
        }
        let text: String = node.children().filter_map(|n| n.text()).collect();
        let samples = points(&text, &context.layout).map_err(|(point, what)| {
            let place = match xml::place(node) {
                Place::Element { name, line } => {
                    Place::Element { name: format!("{name}, point {point}"), line }
                }
                other => other,
            };
            let advice = "a point is the channels of its traceFormat, and commas part points";
            DrawingError::new(FORMAT, place, FileFault::malformed(what, advice))
        })?;
        let continued = matches!(node.attribute("continuation"), Some("middle" | "end"));
        let prior = node.attribute("priorRef").and_then(|r| self.by_id.get(local(r)).copied());
        let row = match prior.filter(|_| continued) {
            Some(row) => {
                self.strokes[row].samples.extend(samples);
                row
            }
            None => {
                let id = id(node).map(str::to_owned);
                self.strokes.push(Stroke { samples, mode, color: context.color, id, ..Stroke::default() });
                self.strokes.len() - 1
            }
        };
        if let Some(id) = id(node) {
            self.by_id.insert(id, row);
        }
        Ok(())
    }
}

fn local(reference: &str) -> &str {
    reference.strip_prefix('#').unwrap_or(reference)
}

fn layout(node: Node<'_, '_>) -> Result<Layout, DrawingError> {
    let mut layout = Layout { channels: Vec::new(), regular: 0 };
    for child in node.children().filter(Node::is_element) {
        match child.tag_name().name() {
            "channel" => layout.channels.insert(layout.regular, channel(child)?),
            "intermittentChannels" => {
                for inner in child.children().filter(|n| n.tag_name().name() == "channel") {
                    layout.channels.push(channel(inner)?);
                }
                continue;
            }
            _ => continue,
        }
        layout.regular += 1;
    }
    if layout.channels.len() > MAX_CHANNELS {
        let advice = "leave channels other than X, Y, T and F out";
        let fault = FileFault::TooMuch { what: "the number of channels", limit: MAX_CHANNELS as u64, advice };
        return Err(DrawingError::new(FORMAT, xml::place(node), fault));
    }
    let missing = [(Role::X, "X"), (Role::Y, "Y")]
        .into_iter()
        .find(|(role, _)| layout.channels[..layout.regular].iter().all(|c| c.role != *role));
    match missing {
        None => Ok(layout),
        Some((_, name)) => {
            let fault = FileFault::malformed(
                format!("it has no channel {name}"),
                "points without X and Y are no drawing; is it ink of a tablet?",
            );
            Err(DrawingError::new(FORMAT, xml::place(node), fault))
        }
    }
}

fn channel(node: Node<'_, '_>) -> Result<Channel, DrawingError> {
    let role = match node.attribute("name").unwrap_or_default() {
        "X" => Role::X,
        "Y" => Role::Y,
        "T" => Role::Time,
        "F" => Role::Pressure,
        _ => Role::Other,
    };
    let turned = node.attribute("orientation") == Some("-ve");
    let number = |name| node.attribute(name).and_then(|v: &str| v.trim().parse::<f64>().ok());
    let factor = match role {
        Role::X if turned => -1.0,
        // In the standard Y grows downwards; ours grows upwards.
        Role::Y if !turned => -1.0,
        Role::Time => match node.attribute("units") {
            Some("s") => 1000.0,
            Some("us") => 0.001,
            _ => 1.0,
        },
        // A decimal force without a maximum is taken to lie between 0 and 1.
        Role::Pressure => number("max").filter(|&m| m > 0.0 && m.is_finite()).map_or(1.0, |m| 1.0 / m),
        _ => 1.0,
    };
    if matches!(role, Role::X | Role::Y) && node.attribute("type") == Some("boolean") {
        let fault = FileFault::unsupported("a boolean position", "export the ink with numbers");
        return Err(DrawingError::new(FORMAT, xml::place(node), fault));
    }
    Ok(Channel { role, factor })
}

#[derive(Clone, Copy, Default, PartialEq)]
enum Coding {
    #[default]
    Explicit,
    Difference,
    Second,
}

#[derive(Clone, Copy, Default)]
struct Track {
    coding: Coding,
    value: f64,
    velocity: f64,
    acceleration: f64,
    known: bool,
}

/// Returns the points of a trace. On failure: the number of the point and what is wrong.
fn points(text: &str, layout: &Layout) -> Result<Vec<InkSample>, (usize, String)> {
    let mut tracks = vec![Track::default(); layout.channels.len()];
    let mut samples = Vec::new();
    for (k, point) in text.split(',').enumerate() {
        if point.trim().is_empty() {
            continue;
        }
        let mut given = 0;
        let mut rest = point.trim_start();
        let mut fresh = vec![false; tracks.len()];
        while !rest.is_empty() {
            let Some(track) = tracks.get_mut(given) else {
                return Err((k, format!("it has more values than the {} channels", layout.channels.len())));
            };
            let (known, after) = value(rest, track).map_err(|what| (k, what))?;
            fresh[given] = known;
            rest = after.trim_start();
            given += 1;
        }
        if given < layout.regular {
            return Err((k, format!("it has {given} values for {} channels", layout.regular)));
        }
        let mut sample = InkSample::from(DVec2::ZERO);
        for ((channel, track), fresh) in layout.channels.iter().zip(&tracks).zip(fresh) {
            let value = track.value * channel.factor;
            match channel.role {
                Role::X => sample.at.x = if track.known { value + 0.0 } else { f64::NAN },
                Role::Y => sample.at.y = if track.known { value + 0.0 } else { f64::NAN },
                Role::Time => sample.time_ms = fresh.then_some(value),
                Role::Pressure => sample.pressure = fresh.then_some(value.clamp(0.0, 1.0)),
                Role::Other => {}
            }
        }
        samples.push(sample);
    }
    Ok(samples)
}

/// Reads one value of a channel; returns whether it is known now, and the text after it.
fn value<'t>(text: &'t str, track: &mut Track) -> Result<(bool, &'t str), String> {
    let mut text = text;
    let prefix = match text.as_bytes().first() {
        Some(b'\'') => Some(Coding::Difference),
        Some(b'"') => Some(Coding::Second),
        Some(b'!') => Some(Coding::Explicit),
        _ => None,
    };
    if let Some(coding) = prefix {
        // A prefix stays in force for its channel until the next one (section 3.2.1.2).
        track.coding = coding;
        text = text[1..].trim_start();
    }
    let first = text.chars().next().ok_or("a prefix without a value")?;
    match first {
        '*' => {
            // The value stays, or continues at its speed, or continues with its acceleration.
            match track.coding {
                Coding::Explicit => {}
                Coding::Difference => track.value += track.velocity,
                Coding::Second => {
                    track.velocity += track.acceleration;
                    track.value += track.velocity;
                }
            }
            return Ok((track.known, &text[1..]));
        }
        '?' => return Ok((false, &text[1..])),
        'T' | 'F' => {
            track.value = f64::from(u8::from(first == 'T'));
            track.known = true;
            return Ok((true, &text[1..]));
        }
        _ => {}
    }
    let (number, rest) = if let Some(hex) = text.strip_prefix('#') {
        let end = hex.find(|c: char| !c.is_ascii_hexdigit()).unwrap_or(hex.len());
        let n = u64::from_str_radix(&hex[..end], 16)
            .map_err(|e| format!("a hexadecimal number is broken: {e}"))?;
        #[expect(clippy::cast_precision_loss, reason = "tablet coordinates stay far below 2^53")]
        let n = n as f64;
        (n, &hex[end..])
    } else {
        let end = super::number_end(text);
        let n = text[..end].parse::<f64>();
        (n.map_err(|e| format!("{:?} is no number ({e})", base::quoted(text)))?, &text[end..])
    };
    match track.coding {
        Coding::Explicit => {
            track.velocity = if track.known { number - track.value } else { 0.0 };
            track.value = number;
        }
        Coding::Difference => {
            track.velocity = number;
            track.value += number;
        }
        Coding::Second => {
            track.acceleration = number;
            track.velocity += number;
            track.value += track.velocity;
        }
    }
    track.known = true;
    Ok((true, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawing(body: &str) -> Result<Drawing, DrawingError> {
        let text = format!("<ink xmlns=\"http://www.w3.org/2003/InkML\">{body}</ink>");
        read(&text, "t", &mut Report::default())
    }

    fn ways(body: &str) -> Vec<Vec<[f64; 2]>> {
        let strokes = drawing(body).expect("reads").strokes;
        strokes.iter().map(|s| s.samples.iter().map(|p| p.at.to_array()).collect()).collect()
    }

    #[test]
    fn the_standards_example_of_differences() {
        // InkML 3.2.1.2, with its table of decoded values.
        let x = [1125.0, 1148.0, 1178.0, 1211.0, 1251.0, 1297.0, 1349.0, 1404.0];
        let y = [18432.0, 18475.0, 18510.0, 18540.0, 18567.0, 18596.0, 18633.0, 18676.0];
        let want: Vec<[f64; 2]> = x.iter().zip(y).map(|(&x, y): (&f64, f64)| [x, -y]).collect();
        assert_eq!(ways("<trace>1125 18432,'23'43,\"7\"-8,3-5,7-3,6 2,6 8,3 6</trace>")[0], want);
    }

    #[test]
    fn prefixes_last_and_blanks_may_be_missing() {
        assert_eq!(
            ways("<trace>10 0,'1'2,1 2,!5!7</trace>")[0],
            [[10.0, 0.0], [11.0, -2.0], [12.0, -4.0], [5.0, -7.0]]
        );
        assert_eq!(ways("<trace>10-5,\"0\"0</trace>")[0].len(), 2);
    }

    #[test]
    fn channels_in_any_order_and_intermittent() {
        let d = drawing(
            "<definitions><context xml:id='c'><inkSource><traceFormat>\
             <channel name='Y' orientation='-ve'/><channel name='F' max='1000'/><channel name='X'/>\
             <intermittentChannels><channel name='T' units='s'/></intermittentChannels>\
             </traceFormat></inkSource></context></definitions>\
             <traceGroup contextRef='#c' xml:id='leaf-contour 1'><trace xml:id='a'>1 500 2 0.5, 3 250 4</trace></traceGroup>",
        )
        .expect("reads");
        let s = &d.strokes[0];
        assert_eq!(s.mode, StrokeMode::LeafContour);
        assert_eq!(s.id.as_deref(), Some("a"));
        assert_eq!(
            s.samples[0],
            InkSample { at: DVec2::new(2.0, 1.0), time_ms: Some(500.0), pressure: Some(0.5) }
        );
        assert_eq!(s.samples[1], InkSample { at: DVec2::new(4.0, 3.0), time_ms: None, pressure: Some(0.25) });
    }

    #[test]
    fn brush_colours_continuations_and_pen_up() {
        let d = drawing(
            "<definitions><brush xml:id='b'><brushProperty name='width' value='3'/>\
             <brushProperty name='color' value='#10a020'/></brush></definitions>\
             <trace xml:id='p' brushRef='#b' continuation='begin'>0 0, 1 0</trace><trace type='penUp'>5 5, 6 6</trace>\
             <trace continuation='end' priorRef='#p'>2 0, 3 0</trace>",
        )
        .expect("reads");
        assert_eq!(d.strokes.len(), 1);
        assert_eq!(d.strokes[0].samples.len(), 4);
        assert_eq!(d.strokes[0].color, Some([16, 160, 32]));
    }

    #[test]
    fn bad_points_are_named() {
        let e = drawing("\n<trace xml:id='k'>1 2, 3 x</trace>").expect_err("refused").to_string();
        assert!(e.starts_with("InkML, line 2, <trace> `k`, point 1: \"x\" is no number"), "{e}");
        let e = drawing("<trace>1 2, 3</trace>").expect_err("refused").to_string();
        assert!(e.contains("1 values for 2 channels"), "{e}");
        let e = drawing("<trace contextRef='#no'>1 2</trace>").expect_err("refused").to_string();
        assert!(e.contains("\"#no\""), "{e}");
    }
}
