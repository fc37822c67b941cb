//! Text or JSON -> a spec; one field of a spec.

use base::Slip;
use serde_json::Value;

use crate::{Node, RangeFault, Spec, TextFault, check};

/// A fault in a spec that somebody wrote.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpecFault {
    /// The text is not such a spec: it is not TOML, a field is unknown or missing, or a value is of the wrong kind.
    #[error("{}{}{}{}", on(*line), lead(path), base::plainly(message), Slip::in_field(path, None, message).hint())]
    Text {
        /// Line, from 1; `None` where there is no text.
        line: Option<usize>,
        /// Names and rows that lead to the fault; empty for the whole spec.
        path: String,
        /// The fault in words.
        message: String,
    },
    /// A number is out of its range.
    #[error("{}{fault}", on(*line))]
    Range {
        /// Line, from 1; `None` where there is no text.
        line: Option<usize>,
        /// Path, value and range.
        fault: RangeFault,
    },
    /// The field to be set does not exist.
    #[error("the spec has no {0}")]
    Pointer(String),
}

base::coded!(SpecFault {
    Self::Pointer(path) => "spec-pointer" { path },
} wraps {
    Self::Text { line, path, message } => &Slip::in_field(path, *line, message), Slip;
    Self::Range { fault, .. } => fault, RangeFault;
});

fn on(line: Option<usize>) -> String {
    line.map(|line| format!("line {line}: ")).unwrap_or_default()
}

fn lead(path: &str) -> String {
    if path.is_empty() { String::new() } else { format!("{path}: ") }
}

impl SpecFault {
    /// Makes the fault of a text that was read.
    pub fn in_text(text: &str, fault: TextFault) -> Self {
        let TextFault { path, message, at } = fault;
        Self::Text { line: Some(line_at(text, at)), path, message }
    }
}

impl From<RangeFault> for SpecFault {
    fn from(fault: RangeFault) -> Self {
        Self::Range { line: None, fault }
    }
}

/// Returns the line (from 1) of a byte.
pub fn line_at(text: &str, at: usize) -> usize {
    text.as_bytes()[..at.min(text.len())].iter().filter(|b| **b == b'\n').count() + 1
}

/// Reads a spec from TOML and checks its ranges.
///
/// # Errors
/// [`SpecFault`] with the line of the fault.
pub fn from_toml<T: Spec>(text: &str) -> Result<T, SpecFault> {
    let tree = Node::from_toml(text).map_err(|fault| SpecFault::in_text(text, fault))?;
    let spec = tree.read().map_err(|fault| SpecFault::in_text(text, fault))?;
    check(&spec).map_err(|fault| {
        let line = tree.at_path(&fault.path).map(|node| line_at(text, node.at));
        SpecFault::Range { line, fault }
    })?;
    Ok(spec)
}

/// Reads a spec that is kept as JSON. Ranges are not checked: a file of an earlier version opens whatever its numbers
/// are, and its maker reports any fault.
///
/// # Errors
/// [`SpecFault::Text`] with the names of the fields that lead to the fault.
pub fn from_json<T: Spec>(value: &Value) -> Result<T, SpecFault> {
    if !value.is_object() {
        // Serde would read a list as the first fields.
        let message = "a spec is a JSON object with a field for each thing that is asked for".into();
        return Err(SpecFault::Text { line: None, path: String::new(), message });
    }
    let read = Node::from_json(value).read();
    read.map_err(|TextFault { path, message, .. }| SpecFault::Text { line: None, path, message })
}

/// Returns a spec as JSON.
pub fn to_json<T: Spec>(spec: &T) -> Value {
    serde_json::to_value(spec).unwrap_or_default()
}

/// Returns the spec with one field changed, named by a JSON pointer such as `/method/points`. Commands, panels and
/// options that name a field share this function.
///
/// # Errors
/// [`SpecFault`]: the field does not exist, the value is of the wrong kind, or it is out of range.
///
/// ```
/// # #[derive(Clone, schemars::JsonSchema, serde::Serialize, serde::Deserialize)]
/// # #[serde(deny_unknown_fields)]
/// # struct Pot {
/// #     #[schemars(range(min = 0.0, max = 2.0), extend("x-unit" = "m"))]
/// #     height_m: f64,
/// # }
/// # spec::schemas!(Pot);
/// let pot = spec::set(&Pot { height_m: 1.0 }, "/height_m", 0.5.into())?;
/// assert_eq!(pot.height_m, 0.5);
/// assert!(spec::set(&pot, "/height_m", 3.0.into()).is_err() && spec::set(&pot, "/width_m", 1.0.into()).is_err());
/// # Ok::<(), spec::SpecFault>(())
/// ```
pub fn set<T: Spec>(spec: &T, pointer: &str, value: Value) -> Result<T, SpecFault> {
    let mut all = to_json(spec);
    let (parent, key) = pointer.rsplit_once('/').unwrap_or(("", pointer));
    let nowhere = || SpecFault::Pointer(base::brief(pointer));
    match all.pointer_mut(parent).ok_or_else(nowhere)? {
        Value::Object(fields) => drop(fields.insert(key.into(), value)),
        Value::Array(rows) => {
            let row = key.parse::<usize>().ok().and_then(|row| rows.get_mut(row));
            *row.ok_or_else(nowhere)? = value;
        }
        _ => return Err(nowhere()),
    }
    let spec = from_json(&all)?;
    check(&spec)?;
    Ok(spec)
}

/// Keys whose values distinguish forms: fields of one form do not fit another.
const TAGS: [&str; 2] = ["kind", "shape"];

/// Puts `fields` in the place of those of `into`, table by table; a table of another form replaces the existing one.
fn merge(into: &mut Value, fields: Value) {
    match (into, fields) {
        (Value::Object(old), Value::Object(new)) => {
            let other = TAGS.iter().any(|t| new.get(*t).is_some_and(|tag| old.get(*t) != Some(tag)));
            if other {
                *old = new;
                return;
            }
            for (name, value) in new {
                match old.get_mut(&name) {
                    Some(there) => merge(there, value),
                    None => drop(old.insert(name, value)),
                }
            }
        }
        (into, fields) => *into = fields,
    }
}

/// Returns the spec with some fields replaced, table by table, as programs ask for in addition to a preset. A table of
/// another form (`kind`, `shape`) replaces the existing one.
///
/// # Errors
/// [`SpecFault`]: a field does not exist, a value is of the wrong kind, or one is out of range.
///
/// ```
/// # #[derive(Clone, schemars::JsonSchema, serde::Serialize, serde::Deserialize)]
/// # #[serde(deny_unknown_fields)]
/// # struct Pot {
/// #     #[schemars(range(min = 0.0, max = 2.0), extend("x-unit" = "m"))]
/// #     height_m: f64,
/// #     soil: String,
/// # }
/// # spec::schemas!(Pot);
/// let pot = Pot { height_m: 1.0, soil: "loam".into() };
/// let higher = spec::with_fields(&pot, serde_json::json!({ "height_m": 1.5 }))?;
/// assert_eq!((higher.height_m, higher.soil.as_str()), (1.5, "loam"));
/// assert!(spec::with_fields(&pot, serde_json::json!({ "width_m": 1.5 })).is_err());
/// # Ok::<(), spec::SpecFault>(())
/// ```
pub fn with_fields<T: Spec>(spec: &T, fields: Value) -> Result<T, SpecFault> {
    let mut all = to_json(spec);
    merge(&mut all, fields);
    let spec = from_json(&all)?;
    check(&spec)?;
    Ok(spec)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Coded as _;

    #[derive(Clone, Debug, PartialEq, schemars::JsonSchema, serde::Serialize, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Bed {
        width_m: f64,
        soil: Soil,
    }

    #[derive(Clone, Debug, PartialEq, schemars::JsonSchema, serde::Serialize, serde::Deserialize)]
    #[serde(rename_all = "kebab-case")]
    enum Soil {
        Sand,
        Loam,
    }

    crate::schemas!(Bed);

    #[test]
    fn of_what_is_not_known_the_nearest_is_meant() {
        for (text, hint) in [
            ("width_n = 1\nsoil = \"loam\"", Some("width_m")),
            ("width_m = 1\nsoil = \"laom\"", Some("loam")),
            ("width_m = 1\nsoil = \"gravel\"", None),
            ("width_m = \"`width_n`\"\nsoil = \"loam\"", None),
        ] {
            let said = from_toml::<Bed>(text).expect_err("not sound").to_string();
            let meant = hint.map(|word| format!("; is `{word}` meant?"));
            assert!(meant.map_or(!said.contains("meant"), |meant| said.ends_with(&meant)), "{said}");
        }
    }

    #[test]
    fn common_slips_have_codes_of_their_own() {
        for (text, code, fields) in [
            (
                "width_m = 1\nsoil = \"loam\"\ndepth = 1",
                "spec-unknown",
                vec![("name", "depth"), ("path", "")],
            ),
            ("width_m = 1", "spec-missing", vec![("name", "soil"), ("path", "")]),
            (
                "width_m = 1\nsoil = \"clay\"",
                "spec-choice",
                vec![("choices", "sand, loam"), ("name", "clay"), ("path", "soil")],
            ),
        ] {
            let told = from_toml::<Bed>(text).expect_err("not sound").details();
            assert_eq!(
                (told.code, told.fields.iter().map(|(k, v)| (*k, v.as_str())).collect::<Vec<_>>()),
                (code, fields),
                "{text}"
            );
        }
        let told = from_toml::<Bed>("width_m = 1\nsoil = ").expect_err("no TOML").details();
        assert_eq!((told.code, told.fields["line"].as_str()), ("spec-syntax", "2"));
        let told = from_toml::<Bed>("width_m = true\nsoil = \"loam\"").expect_err("no number").details();
        assert_eq!((told.code, told.fields["path"].as_str()), ("spec-kind", "width_m"));
    }
}
