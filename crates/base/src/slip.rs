//! What serde's readers say of a text, as codes with fields: `message -> Slip`.

use core::fmt;

use crate::{Coded, Told};

/// A slip in a text that somebody wrote, in the words of the reader that found it.
///
/// The common slips have codes of their own, so that every language has its own words for them; the others keep the
/// words of the reader.
///
/// ```
/// use base::{Coded, Slip};
/// let told = Slip::of("unknown field `depth`, expected `width` at line 3 column 7").told();
/// assert_eq!((told.code, told.fields["line"].as_str()), ("slip-at", "3"));
/// let what = &told.causes["what"];
/// assert_eq!((what.code, what.fields["name"].as_str()), ("spec-unknown", "depth"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slip {
    /// Names and rows that lead to it; empty where they are not known.
    path: String,
    /// Line and column from 1.
    place: Option<(usize, Option<usize>)>,
    /// What is wrong, in the reader's words, without the place.
    why: String,
}

impl Slip {
    /// Of a message of `serde_json`, with or without the place at its end and names of fields before it.
    pub fn of(message: &str) -> Self {
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

    /// Of a message about what names and rows lead to, in a text of which the line (from 1) may be known.
    pub fn in_field(path: &str, line: Option<usize>, why: &str) -> Self {
        Self { path: path.to_owned(), place: line.map(|line| (line, None)), why: crate::brief(why_of(why)) }
    }

    /// Of a field or a word that is not known, which of those that are known is meant; empty if none is near.
    ///
    /// ```
    /// let slip = base::Slip::of("unknown field `depht`, expected `width` or `depth`");
    /// assert_eq!(slip.hint(), "; is `depth` meant?");
    /// ```
    pub fn hint(&self) -> String {
        let unknown = ["unknown field", "unknown variant"].iter().any(|start| self.why.starts_with(start));
        let mut quoted = self.why.split('`').skip(1).step_by(2);
        quoted.next().filter(|_| unknown).map(|word| crate::meant(word, quoted)).unwrap_or_default()
    }

    /// What is wrong, without a word of the language that this is written in.
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

/// A message of a reader of JSON or TOML for people: kinds of values by their words, not by the names of types. Other
/// messages stay as they are.
///
/// ```
/// let told = "points: invalid type: string \"many\", expected u32 at line 2 column 9";
/// let plain = "points: invalid type: the text \"many\", expected a whole number from 0 to 4294967295 at line 2 column 9";
/// assert_eq!(base::plainly(told), plain);
/// assert_eq!(base::plainly("a law needs a day"), "a law needs a day");
/// ```
pub fn plainly(message: &str) -> String {
    let slip = Slip::of(message);
    let Some(plain) = slip.plain() else { return why_of(message).to_owned() };
    let lead = if slip.path.is_empty() { String::new() } else { format!("{}: ", slip.path) };
    let place = match slip.place {
        Some((line, Some(column))) => format!(" at line {line} column {column}"),
        _ => String::new(),
    };
    format!("{lead}{plain}{place}")
}

/// What a reader says, but for the names of types that fit no field of ours.
fn why_of(why: &str) -> &str {
    if why.starts_with("data did not match any variant of untagged enum") {
        return "it has none of the forms that are known";
    }
    why
}

/// What serde found, in words.
fn found_words(found: &str) -> String {
    match found_kind(found) {
        ("a text", text) => format!("the text \"{text}\""),
        (kind, "") => kind.to_owned(),
        (_, value) => value.to_owned(),
    }
}

/// What serde wanted, in words. Words of our own readers stay as they are.
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

/// Whether `serde_json` says so of a text that is no JSON.
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

/// What serde found, as a kind of value and the value itself; the value is empty where it is not told.
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

/// What serde wanted, as a kind of value.
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

/// What is wrong, without the place.
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

    fn told(&self) -> Told {
        let said = self.said();
        match (self.place, &said) {
            (Some((line, Some(column))), _) => {
                Told::new("slip-at", &[("line", &line), ("column", &column), ("what", self)])
                    .with(Some(("what", said.told())))
            }
            // Of the text as a whole, and in nobody's field: it is no TOML.
            (Some((line, None)), Said::Other { .. } | Said::Json) if !self.why.starts_with("invalid") => {
                Told::new("spec-syntax", &[("line", &line), ("why", self)])
            }
            _ => said.told(),
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
            let plain = Slip::of(message);
            assert_eq!((plain.told().code, fields(&plain.told())), (code, want.clone()), "{message}");
            let placed = Slip::of(&format!("{message} at line 12 column 5"));
            let told = placed.told();
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
        let slip = Slip::of(&format!("soil: {plain}{} at line 1 column 2", Slip::of(plain).hint()));
        assert_eq!((slip.hint().as_str(), slip.to_string().as_str()), ("; is `loam` meant?", plain));
        assert_eq!(slip.told().causes["what"].fields["choices"], "sand, loam");
    }

    #[test]
    fn what_is_told_is_among_the_codes() {
        let mut codes = Vec::new();
        Slip::codes(&mut codes);
        let once = codes.clone();
        Slip::codes(&mut codes);
        assert_eq!(codes, once);
        for slip in [Slip::of("x"), Slip::of("x at line 1 column 2"), Slip::in_field("", Some(3), "x")] {
            let told = slip.told();
            assert!(codes.iter().any(|(code, names)| *code == told.code && names.len() == told.fields.len()));
        }
    }
}
