//! XML within bounds: the size of everything that roxmltree does not limit is counted before it starts.

use roxmltree::{Document, Node, ParsingOptions};

use crate::DrawingFormat;
use crate::error::{DrawingError, FileFault, Place};

/// Deepest nesting of elements; drawing programs stay below 50.
pub(super) const MAX_DEPTH: usize = 256;
/// Most elements and texts of a file.
const MAX_NODES: u32 = 4_000_000;
/// Most attributes of an element: roxmltree compares each with every other.
const MAX_ATTRIBUTES: usize = 500;
/// Most name spaces: roxmltree copies those in scope for every element that declares one.
const MAX_NAMESPACES: usize = 2_000;
/// Most bytes to which entities may expand.
const MAX_EXPANSION: u64 = 256 << 20;

const SIMPLIFY: &str = "save it as plain SVG or simplify it in the drawing program";

/// Parses `text`; refuses it if that would cost too much.
pub(super) fn parse(text: &str, format: DrawingFormat) -> Result<Document<'_>, DrawingError> {
    scan(text, format)?;
    let limit = |what, limit| FileFault::TooMuch { what, limit, advice: SIMPLIFY };
    if expansion(text) > MAX_EXPANSION {
        let fault = limit("the text that its entities could expand to, in bytes,", MAX_EXPANSION);
        return Err(DrawingError::new(format, Place::File, fault));
    }
    let options = ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|e| {
        let pos = e.pos();
        let at = Place::Line { line: u64::from(pos.row), column: Some(u64::from(pos.col)) };
        let (place, fault) = match e {
            roxmltree::Error::NodesLimitReached => {
                (Place::File, limit("the number of elements", u64::from(MAX_NODES)))
            }
            roxmltree::Error::EntityReferenceLoop(_) => (
                at,
                FileFault::unsupported("an entity that refers to itself or to too many others", SIMPLIFY),
            ),
            e => {
                let message = e.to_string();
                let what = message.rsplit_once(" at ").map_or(message.as_str(), |(head, _)| head);
                (at, FileFault::malformed(what, "mend the XML there or export the drawing again"))
            }
        };
        DrawingError::new(format, place, fault)
    })
}

/// Returns tag and id of an element, with its line.
pub(super) fn place(node: Node<'_, '_>) -> Place {
    let position = node.document().text_pos_at(node.range().start);
    let tag = node.tag_name().name();
    let name = node
        .attributes()
        .find(|a| a.name() == "id")
        .map_or_else(|| format!("<{tag}>"), |id| format!("<{tag}> `{}`", base::quoted(id.value())));
    Place::Element { name, line: u64::from(position.row) }
}

/// Returns an upper bound of the bytes that entity references can become: roxmltree follows at most 255 references
/// inside one reference, and one value cannot be longer than the document type declaration.
fn expansion(text: &str) -> u64 {
    if !text.contains("<!ENTITY") {
        return 0;
    }
    let start = text.find("<!DOCTYPE").unwrap_or(0);
    let end = text.rfind(']').map_or(text.len(), |i| i + 1).max(start);
    let declaration = &text[start..end];
    let known = ["#", "lt;", "gt;", "amp;", "quot;", "apos;"];
    let references = |text: &str| {
        text.match_indices('&').filter(|&(i, _)| !known.iter().any(|k| text[i + 1..].starts_with(k))).count()
            as u64
    };
    let inside = if declaration.contains('&') { 255 } else { 1 };
    references(text).saturating_mul(declaration.len() as u64).saturating_mul(inside)
}

fn line_column(text: &str, at: usize) -> Place {
    let before = &text.as_bytes()[..at.min(text.len())];
    let line = 1 + before.iter().filter(|&&b| b == b'\n').count() as u64;
    let start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
    let column = 1 + String::from_utf8_lossy(&before[start..]).chars().count() as u64;
    Place::Line { line, column: Some(column) }
}

/// Walks over the tags once: bounds depth, attributes and name spaces, and finds where a truncated file ends.
fn scan(text: &str, format: DrawingFormat) -> Result<(), DrawingError> {
    let bytes = text.as_bytes();
    let mut open: Vec<usize> = Vec::new();
    let mut namespaces = 0;
    let mut at = 0;
    let cut = |from: usize, inside: &str| {
        Err(DrawingError::new(
            format,
            line_column(text, from),
            FileFault::Truncated { inside: inside.to_owned() },
        ))
    };
    let too_much = |from: usize, what, limit: usize| {
        let fault = FileFault::TooMuch { what, limit: limit as u64, advice: SIMPLIFY };
        Err(DrawingError::new(format, line_column(text, from), fault))
    };
    while let Some(start) = find(bytes, at, b"<") {
        let rest = &bytes[start..];
        let skip = |end: &[u8]| find(bytes, start + 1, end).map(|i| i + end.len());
        if rest.starts_with(b"<!--") {
            let Some(next) = skip(b"-->") else { return cut(start, "a comment that begins here") };
            at = next;
        } else if rest.starts_with(b"<![CDATA[") {
            let Some(next) = skip(b"]]>") else { return cut(start, "a CDATA section that begins here") };
            at = next;
        } else if rest.starts_with(b"<?") {
            let Some(next) = skip(b"?>") else { return cut(start, "an instruction that begins here") };
            at = next;
        } else if rest.starts_with(b"<!") {
            let Some(next) = skip(b">") else { return cut(start, "a declaration that begins here") };
            at = next;
        } else {
            let Some((end, attributes)) = tag_end(bytes, start) else {
                return cut(start, &format!("the tag {} that begins here", tag_name(bytes, start)));
            };
            let tag = &bytes[start..end];
            if attributes > MAX_ATTRIBUTES {
                return too_much(start, "the number of attributes of one element", MAX_ATTRIBUTES);
            }
            namespaces += tag.windows(5).filter(|w| w == b"xmlns").count();
            if namespaces > MAX_NAMESPACES {
                return too_much(start, "the number of name space declarations", MAX_NAMESPACES);
            }
            if rest.starts_with(b"</") {
                open.pop();
            } else if !tag.ends_with(b"/>") {
                open.push(start);
                if open.len() > MAX_DEPTH {
                    return too_much(start, "the nesting of elements", MAX_DEPTH);
                }
            }
            at = end;
        }
    }
    match open.last() {
        Some(&start) => {
            let inside = format!("the element {} that begins here", tag_name(bytes, start));
            cut(start, &inside)
        }
        None => Ok(()),
    }
}

fn find(bytes: &[u8], from: usize, what: &[u8]) -> Option<usize> {
    let first = *what.first()?;
    let mut at = from;
    loop {
        at += bytes.get(at..)?.iter().position(|&b| b == first)?;
        if bytes[at..].starts_with(what) {
            return Some(at);
        }
        at += 1;
    }
}

/// Returns the position after the `>` that ends the tag at `start`, and the number of its attributes.
fn tag_end(bytes: &[u8], start: usize) -> Option<(usize, usize)> {
    let mut quote = None;
    let mut attributes = 0;
    for (i, &b) in bytes.iter().enumerate().skip(start) {
        match (quote, b) {
            (Some(q), b) if q == b => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => {
                quote = Some(b);
                attributes += 1;
            }
            (None, b'>') => return Some((i + 1, attributes)),
            // A new tag inside a tag: not well-formed, and roxmltree says so with its place.
            (None, b'<') if i > start => return Some((i, attributes)),
            _ => {}
        }
    }
    None
}

fn tag_name(bytes: &[u8], start: usize) -> String {
    let name: Vec<u8> =
        bytes[start + 1..].iter().copied().take(40).take_while(|b| !b" \t\r\n/>".contains(b)).collect();
    format!("<{}>", String::from_utf8_lossy(&name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        parse(text, DrawingFormat::Svg).map_or_else(|e| e.to_string(), |_| "fine".into())
    }

    #[test]
    fn truncated_xml_names_line_and_column() {
        assert_eq!(
            message("<svg>\n <g>\n  <path d=\"M0 0"),
            "SVG, line 3, column 3: the file ends inside the tag <path> that begins here; it is cut off: save or copy it again"
        );
        assert!(message("<svg>\n <g>").contains("line 2, column 2: the file ends inside the element <g>"));
        assert!(message("<svg><!-- x").contains("inside a comment"));
    }

    #[test]
    fn billion_laughs_is_refused_quickly() {
        let mut dtd = String::from("<!DOCTYPE svg [<!ENTITY a0 \"ha\">");
        for i in 1..30 {
            let refs = format!("&a{};", i - 1).repeat(10);
            dtd += &format!("<!ENTITY a{i} \"{refs}\">");
        }
        let text = format!("{dtd}]><svg>&a29;</svg>");
        let m = message(&text);
        assert!(m.contains("entit"), "{m}");
    }

    #[test]
    fn entity_of_many_references_is_refused() {
        let text = format!(
            "<!DOCTYPE svg [<!ENTITY a \"{}\">]><svg>{}</svg>",
            "x".repeat(100_000),
            "&a;".repeat(10_000)
        );
        assert!(message(&text).contains("entities could expand"), "{}", message(&text));
    }

    #[test]
    fn name_space_entities_of_drawing_programs_are_read() {
        let text = "<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" \"x.dtd\" [<!ENTITY ns_svg \"http://www.w3.org/2000/svg\">]>\
                    <svg xmlns=\"&ns_svg;\"><g/></svg>";
        assert_eq!(message(text), "fine");
    }

    #[test]
    fn deep_nesting_and_many_attributes_are_refused() {
        assert!(message(&"<g>".repeat(100_000)).contains("nesting of elements"));
        let many: String = (0..100_000).map(|i| format!(" a{i}=''")).collect();
        assert!(message(&format!("<svg{many}/>")).contains("attributes of one element"));
        let spaces: String = (0..10_000).map(|i| format!("<g xmlns:a{i}='{i}'/>")).collect();
        assert!(message(&format!("<svg>{spaces}</svg>")).contains("name space"));
    }
}
