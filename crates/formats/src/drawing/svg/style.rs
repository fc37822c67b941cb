//! Presentation of an SVG element: attributes, `style="..."`, and the simple selectors of `<style>` sheets.

use base::LiteMap;

use ink::StrokeMode;
use roxmltree::Node;

use crate::drawing::mode::mode_in;
use crate::drawing::{parse_color, xml};

/// Paint of a line or an area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    None,
    Color([u8; 3]),
    /// A gradient or pattern: painted, but not with a single colour.
    Server,
}

impl Paint {
    pub(super) fn color(self) -> Option<[u8; 3]> {
        if let Self::Color(rgb) = self { Some(rgb) } else { None }
    }
}

/// The style that an element inherits and hands down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) stroke: Paint,
    pub(super) fill: Paint,
    /// The file asks for this fill; otherwise it is SVG's default of black.
    pub(super) fill_said: bool,
    color: [u8; 3],
    pub(super) visible: bool,
    /// Not inherited, but hides everything below.
    pub(super) displayed: bool,
    pub(super) mode: StrokeMode,
    /// In the units of the element.
    pub(super) width: Option<f64>,
    /// The line has no width: it is invisible.
    no_width: bool,
    /// Product of the opacities of the element and all ancestors.
    pub(super) opacity: f64,
    fill_opacity: f64,
    /// Opacity of the gradient that fills it; 1 for a colour.
    gradient_opacity: f64,
    stroke_opacity: f64,
    /// `fill-rule`.
    pub(super) even_odd: bool,
    /// Row of the layer.
    pub(super) layer: Option<usize>,
    /// The element is on a hidden layer.
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
            no_width: false,
            opacity: 1.0,
            fill_opacity: 1.0,
            gradient_opacity: 1.0,
            stroke_opacity: 1.0,
            even_odd: false,
            layer: None,
            hidden: false,
        }
    }
}

/// Paint of less than this opacity is invisible.
const UNSEEN: f64 = 0.004;

/// The mean of a gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gradient {
    color: [u8; 3],
    /// 0 to 1.
    opacity: f64,
}

/// Meaning of the values `url(#..)`: the mean of each gradient.
pub(super) type Servers = LiteMap<String, Gradient>;

impl Style {
    /// Returns whether the line is visible.
    pub(super) fn is_lined(&self) -> bool {
        self.stroke != Paint::None && !self.no_width && self.opacity * self.stroke_opacity > UNSEEN
    }

    /// Returns whether the area is visible.
    pub(super) fn is_filled(&self) -> bool {
        self.fill != Paint::None && self.area_opacity() > UNSEEN
    }

    /// Returns the opacity of the area.
    pub(super) fn area_opacity(&self) -> f64 {
        self.opacity * self.fill_opacity * self.gradient_opacity
    }

    /// Returns the style of `node`, whose parent has `self`.
    pub(super) fn for_child(self, node: Node<'_, '_>, sheet: &Sheet) -> Self {
        let mut style = Self { displayed: true, opacity: 1.0, ..self };
        // `color` comes first, because the others may refer to it.
        for name in [
            "color",
            "stroke",
            "fill",
            "visibility",
            "display",
            "stroke-width",
            "opacity",
            "fill-opacity",
            "stroke-opacity",
            "fill-rule",
        ] {
            if let Some(value) = node.attribute(name) {
                style.set(name, value, &sheet.servers);
            }
        }
        sheet.apply(node, &mut style);
        if let Some(inline) = node.attribute("style") {
            declarations(inline).for_each(|(name, value)| style.set(name, value, &sheet.servers));
        }
        // Opacity is not inherited, but multiplied: an element is seen through all of its ancestors.
        style.opacity *= self.opacity;
        if let Some(mode) = own_mode(node) {
            style.mode = mode;
        }
        style
    }

    fn set(&mut self, name: &str, value: &str, servers: &Servers) {
        let value = value.trim().trim_end_matches("!important").trim_end();
        if value == "inherit" {
            return;
        }
        match name {
            "color" => self.color = parse_color(value).unwrap_or(self.color),
            "stroke" => self.stroke = self.paint(value, servers),
            "fill" => {
                self.fill = self.paint(value, servers);
                self.gradient_opacity =
                    reference(value).and_then(|(id, _)| servers.get(id)).map_or(1.0, |g| g.opacity);
                self.fill_said = true;
            }
            "visibility" => self.visible = !matches!(value, "hidden" | "collapse"),
            "display" => self.displayed = value != "none",
            "stroke-width" => {
                // Nobody gives a width as a percentage of the sheet.
                let width = super::length(value, 0.0);
                self.no_width = width == 0.0 && value.starts_with(['0', '.']);
                self.width = Some(width).filter(|w| w.is_finite() && *w > 0.0);
            }
            "fill-rule" => self.even_odd = value == "evenodd",
            "opacity" => self.opacity = share(value).unwrap_or(self.opacity),
            "fill-opacity" => self.fill_opacity = share(value).unwrap_or(self.fill_opacity),
            "stroke-opacity" => self.stroke_opacity = share(value).unwrap_or(self.stroke_opacity),
            _ => {}
        }
    }

    fn paint(&self, value: &str, servers: &Servers) -> Paint {
        if let Some((id, fallback)) = reference(value) {
            let known = servers.get(id).map(|g| g.color).or_else(|| parse_color(fallback));
            return known.map_or(Paint::Server, Paint::Color);
        }
        match value {
            _ if is_clear(value) => Paint::None,
            "none" | "transparent" => Paint::None,
            "currentColor" | "currentcolor" => Paint::Color(self.color),
            _ => parse_color(value).map_or(Paint::Server, Paint::Color),
        }
    }
}

/// Parses a number from 0 to 1, or a percentage.
fn share(text: &str) -> Option<f64> {
    let value = match text.trim().strip_suffix('%') {
        Some(percent) => percent.trim().parse::<f64>().ok()? / 100.0,
        None => text.trim().parse().ok()?,
    };
    value.is_finite().then_some(value.clamp(0.0, 1.0))
}

/// Returns whether a colour has an alpha of its own that is 0.
fn is_clear(value: &str) -> bool {
    let inner = value.strip_prefix("rgba(").or_else(|| value.strip_prefix("rgb("));
    if let Some(inner) = inner {
        let parts = inner.trim_end_matches(')').split([',', ' ', '/']).filter(|p| !p.is_empty());
        return parts.skip(3).any(|alpha| share(alpha) == Some(0.0));
    }
    value.strip_prefix('#').is_some_and(|hex| match hex.len() {
        4 => hex.ends_with('0'),
        8 => hex.ends_with("00"),
        _ => false,
    })
}

/// Returns the id of `url(#id)`, and the text after it.
pub(super) fn reference(value: &str) -> Option<(&str, &str)> {
    let (inside, rest) = value.trim().strip_prefix("url(")?.split_once(')')?;
    Some((inside.trim().trim_matches(['"', '\'']).strip_prefix('#')?, rest.trim()))
}

/// Returns the mean of each gradient; one that refers to another has that one's.
pub(super) fn servers(root: Node<'_, '_>, sheet: &Sheet) -> Servers {
    let mut own = Servers::new();
    let mut refers: Vec<(String, String)> = Vec::new();
    let gradients = root.descendants().filter(|n| n.tag_name().name().ends_with("Gradient"));
    for node in gradients {
        let Some(id) = node.attribute("id") else { continue };
        let stops: Vec<Gradient> = node.children().filter_map(|stop| stop_paint(stop, sheet)).collect();
        let href = node.attributes().find(|a| a.name() == "href").and_then(|a| a.value().strip_prefix('#'));
        if let Some(mean) = mean(&stops) {
            own.insert(id.to_owned(), mean);
        } else if let Some(href) = href {
            refers.push((id.to_owned(), href.to_owned()));
        }
    }
    // Four rounds follow any chain that a program writes.
    for _ in 0..4 {
        for (id, href) in &refers {
            if let Some(&mean) = own.get(href) {
                own.insert(id.clone(), mean);
            }
        }
    }
    own
}

/// Returns the colour and the opacity of a gradient's stop.
fn stop_paint(stop: Node<'_, '_>, sheet: &Sheet) -> Option<Gradient> {
    if stop.tag_name().name() != "stop" {
        return None;
    }
    let mut color = stop.attribute("stop-color").unwrap_or("black").to_owned();
    let mut opacity = stop.attribute("stop-opacity").unwrap_or("1").to_owned();
    let mut set = |name: &str, value: &str| match name {
        "stop-color" => value.clone_into(&mut color),
        "stop-opacity" => value.clone_into(&mut opacity),
        _ => {}
    };
    sheet.each_of(stop, |name, value| set(name, value));
    for (name, value) in stop.attribute("style").into_iter().flat_map(declarations) {
        set(name, value);
    }
    Some(Gradient { color: parse_color(&color)?, opacity: share(&opacity).unwrap_or(1.0) })
}

/// Returns the mean of a gradient's stops: stops that are seen through give less of their colour.
fn mean(stops: &[Gradient]) -> Option<Gradient> {
    if stops.is_empty() {
        return None;
    }
    let count = stops.len() as f64;
    let opaque: f64 = stops.iter().map(|s| s.opacity).sum();
    let weight = |s: &Gradient| if opaque > 0.0 { s.opacity / opaque } else { 1.0 / count };
    let channel = |k: usize| {
        let mean: f64 = stops.iter().map(|s| weight(s) * f64::from(s.color[k])).sum();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a channel")]
        let channel = mean.round().clamp(0.0, 255.0) as u8;
        channel
    };
    Some(Gradient { color: [channel(0), channel(1), channel(2)], opacity: opaque / count })
}

/// Returns the mode that an element's own label, id or class asks for.
fn own_mode(node: Node<'_, '_>) -> Option<StrokeMode> {
    ["data-mode", "label", "id", "data-name", "class"].iter().find_map(|name| {
        // Attributes are found by local name: the label lives in Inkscape's name space.
        node.attributes().filter(|a| a.name() == *name).find_map(|a| mode_in(a.value()))
    })
}

/// Returns the last value that a declaration block gives a property.
pub(super) fn declared<'t>(text: &'t str, wanted: &str) -> Option<&'t str> {
    declarations(text).filter(|(name, _)| *name == wanted).last().map(|(_, value)| value)
}

fn declarations(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.split(';').filter_map(|d| d.split_once(':')).map(|(name, value)| (name.trim(), value.trim()))
}

/// Rules of `<style>` elements: selectors of tags, classes, ids and `*`, alone, together (`g.leaf#a`), as descendants
/// (`.a .b`) and as children (`.a > .b`).
#[derive(Debug, Default)]
pub(super) struct Sheet {
    /// Rules in the order of the sheet, by the last simple part of the selector, which finds the rules of an element.
    rules: LiteMap<String, Vec<Rule>>,
    count: usize,
    /// Means of gradients.
    pub(super) servers: Servers,
    /// Selectors that were not understood.
    pub(super) ignored: usize,
}

/// A rule with properties that the reader uses.
#[derive(Debug)]
struct Rule {
    selector: Vec<Compound>,
    /// Number of ids, classes and tags.
    weight: [usize; 3],
    /// At most one for each property that the reader uses: a later rule of the same selector replaces it.
    wanted: Vec<Declared>,
}

/// A property, its value, and the place of its rule in the sheet.
#[derive(Clone, Debug)]
struct Declared {
    name: String,
    value: String,
    order: usize,
}

/// Simple selectors that one element has to meet, and whether the compound before it stands for the parent.
#[derive(Debug, Default, PartialEq)]
struct Compound {
    simple: Vec<String>,
    child: bool,
}

/// Most rules, more than any drawing has: the reader ignores the rest.
const MAX_RULES: usize = 20_000;
/// Most selectors that end in one name, more than any drawing has: each element of that name is compared with all of
/// them.
const MAX_SELECTORS_OF_NAME: usize = 256;
/// Most simple selectors in a row, more than any drawing has.
const MAX_SIMPLE: usize = 16;
/// Deepest nesting of rules within rules, deeper than any program writes.
const MAX_NESTED: usize = 4;

impl Sheet {
    pub(super) fn add(&mut self, text: &str) {
        self.add_rules(&without_comments(text), 0);
    }

    /// Adds rules, and those within rules for screens, as deep as programs nest them.
    fn add_rules(&mut self, text: &str, depth: usize) {
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('{') {
            // `@charset` and `@import` end at their semicolon.
            let prelude = before.rsplit(';').next().unwrap_or_default().trim();
            let end = block_end(after);
            let body = &after[..end];
            rest = after.get(end + 1..).unwrap_or_default();
            match prelude.strip_prefix('@') {
                Some(rule) if holds_on_screen(rule) && depth < MAX_NESTED => self.add_rules(body, depth + 1),
                Some(_) => {}
                None => self.add_block(prelude, body),
            }
        }
    }

    /// Adds the declarations of one block for each of its selectors.
    fn add_block(&mut self, selectors: &str, body: &str) {
        let wanted: Vec<(String, String)> = declarations(body)
            .filter(|(name, _)| CONCERNS.contains(name))
            // No value that the reader knows is longer; every element reads them.
            .map(|(name, value)| (name.to_owned(), value.chars().take(64).collect()))
            .collect();
        if wanted.is_empty() {
            return;
        }
        for selector in selectors.split(',').map(str::trim) {
            let read = selector_of(selector).filter(|_| self.count < MAX_RULES);
            let Some(selector) = read else {
                self.ignored += 1;
                continue;
            };
            self.count += 1;
            self.add_rule(selector, &wanted);
        }
    }

    /// Adds a rule, or its declarations to the rule of the same selector.
    fn add_rule(&mut self, selector: Vec<Compound>, wanted: &[(String, String)]) {
        let order = self.count;
        let key = selector.last().and_then(|c| c.simple.last()).cloned().unwrap_or_default();
        let rules = self.rules.entry(key).or_default();
        let known = rules.iter().position(|rule| rule.selector == selector);
        let Some(row) = known.or((rules.len() < MAX_SELECTORS_OF_NAME).then_some(rules.len())) else {
            self.ignored += 1;
            return;
        };
        if row == rules.len() {
            let weight = weight_of(&selector);
            rules.push(Rule { selector, weight, wanted: Vec::new() });
        }
        let [ids, classes, _] = rules[row].weight;
        // One width for all paths is that of the pen, and does not describe a stroke; our own files have it.
        let is_usual = |name: &str, value: &str| {
            name == "stroke-width" && ids + classes == 0 && !value.trim_start_matches(['0', '.']).is_empty()
        };
        for (name, value) in wanted.iter().filter(|(name, value)| !is_usual(name, value)) {
            rules[row].wanted.retain(|d| d.name != *name);
            rules[row].wanted.push(Declared { name: name.clone(), value: value.clone(), order });
        }
    }

    fn apply(&self, node: Node<'_, '_>, style: &mut Style) {
        self.each_of(node, |name, value| style.set(name, value, &self.servers));
    }

    /// Returns the last value that the sheet gives a property of an element.
    pub(super) fn value(&self, node: Node<'_, '_>, wanted: &str) -> Option<String> {
        let mut found = None;
        self.each_of(node, |name, value| {
            if name == wanted {
                found = Some(value.to_owned());
            }
        });
        found
    }

    /// Calls `set` with all declarations of the sheet for an element, by increasing weight.
    fn each_of(&self, node: Node<'_, '_>, mut set: impl FnMut(&str, &str)) {
        if self.rules.is_empty() {
            return;
        }
        let mut keys = vec!["*".to_owned(), node.tag_name().name().to_owned()];
        let classes = node.attribute("class").unwrap_or_default();
        keys.extend(classes.split_ascii_whitespace().take(64).map(|class| format!(".{class}")));
        keys.extend(node.attribute("id").map(|id| format!("#{id}")));
        let mut found: Vec<([usize; 3], &Declared)> = Vec::new();
        for key in &keys {
            let rules = self.rules.get(key.as_str()).into_iter().flatten();
            for rule in rules.filter(|rule| meets(node, &rule.selector)) {
                found.extend(rule.wanted.iter().map(|declared| (rule.weight, declared)));
            }
        }
        base::sort_by(&mut found, |a, b| a.0.cmp(&b.0).then(a.1.order.cmp(&b.1.order)));
        for (_, declared) in found {
            set(&declared.name, &declared.value);
        }
    }
}

/// Returns the end of the block within which `text` begins: its closing brace, or the end of the text.
fn block_end(text: &str) -> usize {
    let mut open = 0_usize;
    for (at, c) in text.char_indices() {
        match c {
            '{' => open += 1,
            '}' if open == 0 => return at,
            '}' => open -= 1,
            _ => {}
        }
    }
    text.len()
}

/// Returns whether the rules within an at-rule (its words after the `@`) apply to a light screen.
fn holds_on_screen(rule: &str) -> bool {
    let rule = rule.to_ascii_lowercase();
    let (name, query) = rule.split_once(|c: char| c.is_whitespace() || c == '(').unwrap_or((&rule, ""));
    match name {
        "media" => !["print", "speech", "dark", "not "].iter().any(|word| query.contains(word)),
        "supports" | "layer" => true,
        _ => false,
    }
}

/// Returns the number of ids, classes and tags that a selector names: the more, the greater its weight.
fn weight_of(selector: &[Compound]) -> [usize; 3] {
    let simple = || selector.iter().flat_map(|c| &c.simple);
    let count = |first: char| simple().filter(|s| s.starts_with(first)).count();
    let (ids, classes) = (count('#'), count('.'));
    [ids, classes, simple().filter(|s| *s != "*").count() - ids - classes]
}

/// Properties that the reader uses.
const CONCERNS: [&str; 18] = [
    "color",
    "stroke",
    "stroke-width",
    "fill",
    "visibility",
    "display",
    "opacity",
    "fill-opacity",
    "stroke-opacity",
    "fill-rule",
    "stop-color",
    "transform",
    "transform-origin",
    "transform-box",
    "clip-path",
    "mask",
    "font-size",
    "text-anchor",
];

/// Parses a selector; `None` if it asks for more than names, or is too long.
fn selector_of(text: &str) -> Option<Vec<Compound>> {
    let mut out: Vec<Compound> = Vec::new();
    let mut child = false;
    for word in text.replace('>', " > ").split_ascii_whitespace() {
        if word == ">" {
            child = true;
            continue;
        }
        let mut simple: Vec<String> = Vec::new();
        for c in word.chars() {
            match c {
                '.' | '#' | '*' => simple.push(c.to_string()),
                _ if c.is_alphanumeric() || matches!(c, '-' | '_') => match simple.last_mut() {
                    Some(last) if last != "*" => last.push(c),
                    _ => simple.push(c.to_string()),
                },
                _ => return None,
            }
        }
        if simple.iter().any(|s| matches!(s.as_str(), "." | "#")) {
            return None;
        }
        out.push(Compound { simple, child });
        child = false;
    }
    let all: usize = out.iter().map(|c| c.simple.len()).sum();
    ((1..=MAX_SIMPLE).contains(&all) && !child && !out[0].child).then_some(out)
}

/// Returns whether an element meets a selector; if several ancestors match a part, the nearest is taken.
fn meets(node: Node<'_, '_>, selector: &[Compound]) -> bool {
    let mut at = Some(node);
    let mut anywhere = false;
    for part in selector.iter().rev() {
        let found =
            at.into_iter().flat_map(|n| n.ancestors()).take(if anywhere { xml::MAX_DEPTH } else { 1 });
        let Some(found) = found.into_iter().find(|a| part.simple.iter().all(|s| is_named(*a, s))) else {
            return false;
        };
        (at, anywhere) = (found.parent(), !part.child);
    }
    true
}

fn is_named(node: Node<'_, '_>, simple: &str) -> bool {
    if let Some(class) = simple.strip_prefix('.') {
        node.attribute("class").is_some_and(|all| all.split_ascii_whitespace().any(|c| c == class))
    } else if let Some(id) = simple.strip_prefix('#') {
        node.attribute("id") == Some(id)
    } else {
        node.is_element() && (simple == "*" || node.tag_name().name() == simple)
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
