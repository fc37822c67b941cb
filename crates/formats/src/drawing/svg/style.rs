//! Presentation of an SVG element: attributes, `style="..."`, and the simple selectors of `<style>` sheets.

use base::LiteMap;

use ink::StrokeMode;
use roxmltree::Node;

use crate::drawing::mode::mode_in;
use crate::drawing::parse_color;

/// How a line or an area is painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    None,
    Color([u8; 3]),
    /// A gradient or pattern: painted, but no single colour.
    Server,
}

impl Paint {
    pub(super) fn color(self) -> Option<[u8; 3]> {
        if let Self::Color(rgb) = self { Some(rgb) } else { None }
    }
}

/// What an element inherits and hands down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) stroke: Paint,
    pub(super) fill: Paint,
    /// Somebody asked for this fill: black is only what SVG does unasked.
    pub(super) fill_said: bool,
    color: [u8; 3],
    pub(super) visible: bool,
    /// Not inherited, but hides everything below.
    pub(super) displayed: bool,
    pub(super) mode: StrokeMode,
    /// As attributes and `style` say it, in the units of the element; sheets of style are not asked.
    pub(super) width: Option<f64>,
    /// Row of the layer.
    pub(super) layer: Option<usize>,
    /// On a layer that is hidden.
    pub(super) hidden: bool,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            stroke: Paint::None,
            fill: Paint::Color([0; 3]),
            fill_said: false,
            color: [0; 3],
            visible: true,
            displayed: true,
            mode: StrokeMode::Parts,
            width: None,
            layer: None,
            hidden: false,
        }
    }
}

impl Style {
    /// The style of `node`, whose parent has `self`.
    pub(super) fn of(self, node: Node<'_, '_>, sheet: &Sheet) -> Self {
        let mut style = Self { displayed: true, ..self };
        // `color` first: the others may refer to it.
        for name in ["color", "stroke", "fill", "visibility", "display", "stroke-width"] {
            if let Some(value) = node.attribute(name) {
                style.set(name, value);
            }
        }
        sheet.apply(node, &mut style);
        if let Some(inline) = node.attribute("style") {
            declarations(inline).for_each(|(name, value)| style.set(name, value));
        }
        if let Some(mode) = own_mode(node) {
            style.mode = mode;
        }
        style
    }

    fn set(&mut self, name: &str, value: &str) {
        let value = value.trim().trim_end_matches("!important").trim_end();
        if value == "inherit" {
            return;
        }
        match name {
            "color" => self.color = parse_color(value).unwrap_or(self.color),
            "stroke" => self.stroke = self.paint(value),
            "fill" => {
                self.fill = self.paint(value);
                self.fill_said = true;
            }
            "visibility" => self.visible = !matches!(value, "hidden" | "collapse"),
            "display" => self.displayed = value != "none",
            "stroke-width" => {
                // Of a percentage of the sheet nobody draws.
                self.width = Some(super::length(value, 0.0)).filter(|w| w.is_finite() && *w > 0.0);
            }
            _ => {}
        }
    }

    fn paint(&self, value: &str) -> Paint {
        match value {
            "none" | "transparent" => Paint::None,
            "currentColor" | "currentcolor" => Paint::Color(self.color),
            _ => parse_color(value).map_or(Paint::Server, Paint::Color),
        }
    }
}

/// The mode that an element's own label, id or class asks for.
fn own_mode(node: Node<'_, '_>) -> Option<StrokeMode> {
    ["data-mode", "label", "id", "data-name", "class"].iter().find_map(|name| {
        // By local name: the label lives in Inkscape's name space.
        node.attributes().filter(|a| a.name() == *name).find_map(|a| mode_in(a.value()))
    })
}

fn declarations(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.split(';').filter_map(|d| d.split_once(':')).map(|(name, value)| (name.trim(), value.trim()))
}

/// The rules of `<style>` elements that have one plain selector: `tag`, `.class`, `#id`, `*`.
#[derive(Debug, Default)]
pub(super) struct Sheet {
    /// Selector -> the properties that concern us; a later value replaces an earlier one.
    rules: LiteMap<String, LiteMap<String, String>>,
    /// Selectors that were not understood.
    pub(super) ignored: usize,
}

/// More rules than any drawing has: the rest is not looked at.
const MAX_RULES: usize = 20_000;

impl Sheet {
    pub(super) fn add(&mut self, text: &str) {
        let plain = without_comments(text);
        let mut rest = plain.as_str();
        while let Some((selectors, after)) = rest.split_once('{') {
            let Some((body, after)) = after.split_once('}') else { return };
            rest = after;
            let wanted: Vec<(String, String)> = declarations(body)
                .filter(|(name, _)| matches!(*name, "color" | "stroke" | "fill" | "visibility" | "display"))
                // No value that we understand is longer; every element reads them.
                .map(|(name, value)| (name.to_owned(), value.chars().take(64).collect()))
                .collect();
            if wanted.is_empty() {
                continue;
            }
            for selector in selectors.split(',').map(str::trim) {
                let plain = !selector.is_empty()
                    && selector
                        .bytes()
                        .skip(1)
                        .all(|b| b.is_ascii_alphanumeric() || matches!(b, b'-' | b'_'));
                if plain && self.rules.len() < MAX_RULES {
                    let rule = self.rules.entry(selector.to_owned()).or_default();
                    for (name, value) in &wanted {
                        rule.insert(name.clone(), value.clone());
                    }
                } else {
                    self.ignored += 1;
                }
            }
        }
    }

    fn apply(&self, node: Node<'_, '_>, style: &mut Style) {
        if self.rules.is_empty() {
            return;
        }
        let mut by = |selector: &str| {
            for (name, value) in self.rules.get(selector).into_iter().flatten() {
                style.set(name, value);
            }
        };
        by("*");
        by(node.tag_name().name());
        for class in node.attribute("class").unwrap_or_default().split_ascii_whitespace().take(64) {
            by(&format!(".{class}"));
        }
        if let Some(id) = node.attribute("id") {
            by(&format!("#{id}"));
        }
    }
}

fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("/*") {
        out.push_str(before);
        rest = after.split_once("*/").map_or("", |(_, after)| after);
    }
    out.push_str(rest);
    out
}
