//! Messages of serde's readers about a text, as codes with fields: `message -> Slip`.

use core::fmt;

use crate::{Coded, Told};

/// An error in a text that a user wrote, in the words of the reader that found it.
///
/// Common errors have codes of their own, so that every language has its own words for them; the others keep the words
/// of the reader.
///
/// ```
/// use base::{Coded, Slip};
/// let told = Slip::from_message("unknown field `depth`, expected `width` at line 3 column 7").details();
/// assert_eq!((told.code, told.fields["line"].as_str()), ("slip-at", "3"));
/// let what = &told.causes["what"];
/// assert_eq!((what.code, what.fields["name"].as_str()), ("spec-unknown", "depth"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slip {
    /// Names and rows on the way to the error; empty if they are not known.
    path: String,
    /// Line and column from 1.
    place: Option<(usize, Option<usize>)>,
    /// The error in the reader's words, without the place.
    why: String,
}

impl Slip {
    /// Reads a message of `serde_json`, with or without a place at its end and field names at its start.
    pub fn from_message(message: &str) -> Self {
        let placed = message.rsplit_once(" at line ").and_then(|(why, place)| {
            let (line, column) = place.split_once(" column ")?;
            Some((why, (line.parse().ok()?, column.parse().ok())))
        });
        let (why, place) = placed.map_or((message, None), |(why, place)| (why, Some(place)));
        let in_field = why.split_once(": ").filter(|(path, why)| {
            !path.contains(' ') && ["unknown ", "missing ", "invalid "].iter().any(|s| why.starts_with(s))
        });
        let (path, why) = in_field.unwrap_or(("", why));
        let why = crate::nearest::without_hint(why);
        Self { path: path.to_owned(), place, why: crate::brief(why_of(why)) }
    }

    /// Makes a slip from the names and rows on the way to a value, the line of the text (from 1) if known, and a
    /// message about the value.
    pub fn in_field(path: &str, line: Option<usize>, why: &str) -> Self {
        Self { path: path.to_owned(), place: line.map(|line| (line, None)), why: crate::brief(why_of(why)) }
    }

    /// Returns the known name that an unknown field or word was meant to be; empty if none is near.
    ///
    /// ```
    /// let slip = base::Slip::from_message("unknown field `depht`, expected `width` or `depth`");
    /// assert_eq!(slip.hint(), "; is `depth` meant?");
    /// ```
    pub fn hint(&self) -> String {
        let unknown = ["unknown field", "unknown variant"].iter().any(|start| self.why.starts_with(start));
        let mut quoted = self.why.split('`').skip(1).step_by(2);
        quoted.next().filter(|_| unknown).map(|word| crate::meant(word, quoted)).unwrap_or_default()
    }

    /// Returns the error without words of any natural language.
    fn plain(&self) -> Option<String> {
        for start in ["invalid type: ", "invalid value: "] {
            if let Some((found, wanted)) =
                self.why.strip_prefix(start).and_then(|w| w.split_once(", expected "))
            {
                return Some(format!("{start}{}, expected {}", found_words(found), wanted_words(wanted)));
            }
        }
        let (count, wanted) = self.why.strip_prefix("invalid length ")?.split_once(", expected ")?;
        Some(format!("invalid length {count}, expected {}", wanted_words(wanted)))
    }

    fn said(&self) -> Said<'_> {
        let (path, why) = (self.path.as_str(), self.why.as_str());
        let quoted = |what: &str| {
            let mut names = why.strip_prefix(what)?.split('`').skip(1).step_by(2);
            Some((names.next()?, names.collect::<Vec<_>>().join(", ")))
        };
        let instead = |what: &str| why.strip_prefix(what)?.split_once(", expected ");
        if let Some((name, _)) = quoted("unknown field") {
            Said::Unknown { path, name }
        } else if let Some((name, _)) = quoted("missing field") {
            Said::Missing { path, name }
        } else if let Some((name, choices)) = quoted("unknown variant") {
            Said::Choice { path, name, choices }
        } else if let Some((found, wanted)) = instead("invalid type: ").or_else(|| instead("invalid value: "))
        {
            let (kind, value) = found_kind(found);
            Said::Kind { path, found: kind, value, wanted: wanted_kind(wanted) }
        } else if let Some((found, wanted)) = instead("invalid length ") {
            let wanted = wanted.rsplit(' ').next().filter(|n| n.parse::<usize>().is_ok());
            Said::Length { path, found, wanted: wanted.unwrap_or("fewer") }
        } else if why.starts_with("EOF while parsing") {
            Said::Ends
        } else if is_json_syntax(why) {
            Said::Json
        } else if path.is_empty() {
            Said::Other { why }
        } else {
            Said::InField { path, why }
        }
    }
}

/// Rewrites a message of a JSON or TOML reader for people: kinds of values in words instead of names of types. Other
/// messages stay as they are.
///
/// ```
/// let told = "points: invalid type: string \"many\", expected u32 at line 2 column 9";
/// let plain = "points: invalid type: the text \"many\", expected a whole number from 0 to 4294967295 at line 2 column 9";
/// assert_eq!(base::plainly(told), plain);
/// assert_eq!(base::plainly("a law needs a day"), "a law needs a day");
/// ```
pub fn plainly(message: &str) -> String {
    let slip = Slip::from_message(message);
    let Some(plain) = slip.plain() else { return why_of(message).to_owned() };
    let lead = if slip.path.is_empty() { String::new() } else { format!("{}: ", slip.path) };
    let place = match slip.place {
        Some((line, Some(column))) => format!(" at line {line} column {column}"),
        _ => String::new(),
    };
    format!("{lead}{plain}{place}")
}

/// Returns a reader's message, replaced if it names an untagged enum and not a field.
fn why_of(why: &str) -> &str {
    if why.starts_with("data did not match any variant of untagged enum") {
        return "it has none of the forms that are known";
    }
    why
}

/// Describes in words what serde found.
fn found_words(found: &str) -> String {
    match found_kind(found) {
        ("a text", text) => format!("the text \"{text}\""),
        (kind, "") => kind.to_owned(),
        (_, value) => value.to_owned(),
    }
}

/// Describes in words what serde expected. Words of our own readers stay as they are.
fn wanted_words(wanted: &str) -> String {
    let count = wanted.split(' ').find_map(|word| word.parse::<u32>().ok());
    match (wanted_kind(wanted), wanted, count) {
        ("a whole number", "u8", _) => format!("a whole number from 0 to {}", u8::MAX),
        ("a whole number", "u16", _) => format!("a whole number from 0 to {}", u16::MAX),
        ("a whole number", "u32", _) => format!("a whole number from 0 to {}", u32::MAX),
        ("a whole number", "u64" | "usize", _) => "a whole number from 0".to_owned(),
        ("a list", _, Some(count)) => format!("a list of {count}"),
        ("another kind of value", own, _) => own.to_owned(),
        (kind, ..) => kind.to_owned(),
    }
}

/// Whether this message of `serde_json` means that the text is not JSON.
fn is_json_syntax(why: &str) -> bool {
    const STARTS: [&str; 11] = [
        "expected ",
        "trailing ",
        "invalid escape",
        "invalid number",
        "invalid unicode",
        "control character",
        "key must be",
        "lone leading surrogate",
        "unexpected end of hex",
        "recursion limit",
        "number out of range",
    ];
    STARTS.iter().any(|start| why.starts_with(start))
}

/// Returns the kind and the value that serde found; the value is empty if the message omits it.
fn found_kind(found: &str) -> (&'static str, &str) {
    let value = found.split_once(['`', '"']).and_then(|(_, rest)| rest.rsplit_once(['`', '"']));
    let kind = match found.split(' ').next().unwrap_or_default() {
        "boolean" => "true or false",
        "integer" => "a whole number",
        "floating" => "a number",
        "string" | "character" => "a text",
        "sequence" => "a list",
        "map" => "a table",
        "null" | "unit" | "Option" => "nothing",
        _ => "another kind of value",
    };
    (kind, value.map_or("", |(value, _)| value))
}

/// Returns the kind of value that serde expected.
fn wanted_kind(wanted: &str) -> &'static str {
    match wanted {
        "a boolean" => "true or false",
        "enum" => "a word",
        "f32" | "f64" => "a number",
        "a string" | "string" | "a character" => "a text",
        _ if wanted.starts_with(['i', 'u']) && wanted[1..].parse::<u8>().is_ok() => "a whole number",
        "usize" | "isize" => "a whole number",
        _ if wanted.starts_with("a sequence") => "a list",
        _ if wanted.starts_with("a tuple") || wanted.starts_with("an array") => "a list",
        _ if wanted.starts_with("tuple ") => "a list",
        _ if wanted.starts_with("fewer elements") || wanted.starts_with("more elements") => "a list",
        _ if wanted.starts_with("struct ") || wanted.starts_with("a map") => "a table",
        _ if wanted.contains("tagged enum ") => "a table",
        _ if wanted.starts_with("variant ") || wanted.starts_with("enum ") => "a word",
        _ if wanted.starts_with("a word") => "a word",
        _ => "another kind of value",
    }
}

impl fmt::Display for Slip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.plain().as_deref().unwrap_or(&self.why))
    }
}

/// The error without its place.
enum Said<'a> {
    Unknown { path: &'a str, name: &'a str },
    Missing { path: &'a str, name: &'a str },
    Choice { path: &'a str, name: &'a str, choices: String },
    Kind { path: &'a str, found: &'static str, value: &'a str, wanted: &'static str },
    Length { path: &'a str, found: &'a str, wanted: &'a str },
    Json,
    Ends,
    InField { path: &'a str, why: &'a str },
    Other { why: &'a str },
}

crate::coded!(Said<'_> {
    Self::Unknown { path, name } => "spec-unknown" { path, name },
    Self::Missing { path, name } => "spec-missing" { path, name },
    Self::Choice { path, name, choices } => "spec-choice" { path, name, choices },
    Self::Kind { path, found, value, wanted } => "spec-kind" { path, found, value, wanted },
    Self::Length { path, found, wanted } => "spec-length" { path, found, wanted },
    Self::Json => "not-json" {},
    Self::Ends => "json-ends" {},
    Self::InField { path, why } => "spec-text" { path, why },
    Self::Other { why } => "slip" { why },
});

impl Coded for Slip {
    fn codes(all: &mut Vec<crate::Code>) {
        Said::codes(all);
        for code in [("slip-at", &["line", "column", "what"][..]), ("spec-syntax", &["line", "why"])] {
            if !all.contains(&code) {
                all.push(code);
            }
        }
    }

    fn details(&self) -> Told {
        let said = self.said();
        match (self.place, &said) {
            (Some((line, Some(column))), _) => {
                Told::new("slip-at", &[("line", &line), ("column", &column), ("what", self)])
                    .with(Some(("what", said.details())))
            }
            // The error concerns the text as a whole and no field: it is not TOML.
            (Some((line, None)), Said::Other { .. } | Said::Json) if !self.why.starts_with("invalid") => {
                Told::new("spec-syntax", &[("line", &line), ("why", self)])
            }
            _ => said.details(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields(told: &Told) -> Vec<(&str, &str)> {
        told.fields.iter().map(|(name, value)| (*name, value.as_str())).collect()
    }

    #[test]
    fn what_serde_says_of_json_has_codes() {
        for (message, code, want) in [
            ("missing field `name`", "spec-missing", vec![("name", "name"), ("path", "")]),
            (
                "invalid type: string \"tall\", expected f64",
                "spec-kind",
                vec![("found", "a text"), ("path", ""), ("value", "tall"), ("wanted", "a number")],
            ),
            (
                "invalid type: boolean `true`, expected u32",
                "spec-kind",
                vec![
                    ("found", "true or false"),
                    ("path", ""),
                    ("value", "true"),
                    ("wanted", "a whole number"),
                ],
            ),
            (
                "invalid value: integer `-1`, expected u8",
                "spec-kind",
                vec![
                    ("found", "a whole number"),
                    ("path", ""),
                    ("value", "-1"),
                    ("wanted", "a whole number"),
                ],
            ),
            (
                "invalid type: null, expected struct Pot with 2 elements",
                "spec-kind",
                vec![("found", "nothing"), ("path", ""), ("value", ""), ("wanted", "a table")],
            ),
            (
                "invalid length 2, expected an array of length 3",
                "spec-length",
                vec![("found", "2"), ("path", ""), ("wanted", "3")],
            ),
            (
                "edits[2].turn: missing field `degrees`",
                "spec-missing",
                vec![("name", "degrees"), ("path", "edits[2].turn")],
            ),
            (
                "invalid type: map, expected enum",
                "spec-kind",
                vec![("found", "a table"), ("path", ""), ("value", ""), ("wanted", "a word")],
            ),
            ("expected value", "not-json", vec![]),
            ("EOF while parsing an object", "json-ends", vec![]),
            ("a law needs a day", "slip", vec![("why", "a law needs a day")]),
        ] {
            let plain = Slip::from_message(message);
            assert_eq!((plain.details().code, fields(&plain.details())), (code, want.clone()), "{message}");
            let placed = Slip::from_message(&format!("{message} at line 12 column 5"));
            let told = placed.details();
            let why = placed.to_string();
            assert_eq!(why, plainly(message).trim_start_matches("edits[2].turn: "));
            assert!(
                !["u32", "u8", "f64", "struct", "enum", "string", "integer", "array"]
                    .iter()
                    .any(|t| why.contains(t))
            );
            let at = [("column", "5"), ("line", "12"), ("what", why.as_str())];
            assert_eq!((told.code, fields(&told)), ("slip-at", at.to_vec()));
            assert_eq!((told.causes["what"].code, fields(&told.causes["what"])), (code, want));
        }
    }

    #[test]
    fn a_hint_is_no_choice() {
        let plain = "unknown variant `laom`, expected `sand` or `loam`";
        let slip = Slip::from_message(&format!(
            "soil: {plain}{} at line 1 column 2",
            Slip::from_message(plain).hint()
        ));
        assert_eq!((slip.hint().as_str(), slip.to_string().as_str()), ("; is `loam` meant?", plain));
        assert_eq!(slip.details().causes["what"].fields["choices"], "sand, loam");
    }

    #[test]
    fn what_is_told_is_among_the_codes() {
        let mut codes = Vec::new();
        Slip::codes(&mut codes);
        let once = codes.clone();
        Slip::codes(&mut codes);
        assert_eq!(codes, once);
        for slip in [
            Slip::from_message("x"),
            Slip::from_message("x at line 1 column 2"),
            Slip::in_field("", Some(3), "x"),
        ] {
            let told = slip.details();
            assert!(codes.iter().any(|(code, names)| *code == told.code && names.len() == told.fields.len()));
        }
    }
}
