//! The schema of a type, made once.

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// A maker's spec, or a part of one that is checked by itself. [`schemas!`](crate::schemas) implements it.
pub trait Spec: JsonSchema + Serialize + DeserializeOwned {
    /// Place of its schema in [`schema`](Self::schema), as a JSON pointer; empty for the whole.
    const PART: &'static str = "";

    /// Its JSON Schema, with meaning, unit (`x-unit`), range and default of each field. Made at the first call.
    fn schema() -> &'static Value;
}

/// Implements [`Spec`] for types that derive `JsonSchema`, `Serialize` and `Deserialize`.
///
/// | form | where the schema comes from |
/// |---|---|
/// | `schemas!(Pot)` | derived at its first use |
/// | `schemas!(TreeSpec = include_str!("../schemas/tree.json"))` | a file: a browser downloads no code that derives it |
/// | `schemas!(WoodSpec => TreeSpec, "/$defs/WoodSpec")` | a part of that of another spec |
///
/// `cargo xtask types` writes the files; a test of the facade compares files and parts with what is derived.
///
/// ```
/// use spec::Spec;
/// #[derive(schemars::JsonSchema, serde::Serialize, serde::Deserialize)]
/// struct Pot {
///     #[schemars(range(min = 0.0, max = 2.0), extend("x-unit" = "m"))]
///     height_m: f64,
/// }
/// spec::schemas!(Pot);
/// assert_eq!(Pot::schema()["properties"]["height_m"]["maximum"], 2.0);
/// assert_eq!(spec::check(&Pot { height_m: 3.0 }).unwrap_err().to_string(), "height_m must be 0 to 2 m, not 3");
/// ```
#[macro_export]
macro_rules! schemas {
    ($spec:ty = $text:expr) => {
        impl $crate::Spec for $spec {
            fn schema() -> &'static $crate::serde_json::Value {
                static KEPT: std::sync::OnceLock<$crate::serde_json::Value> = std::sync::OnceLock::new();
                KEPT.get_or_init(|| $crate::kept_schema($text))
            }
        }
    };
    ($spec:ty => $whole:ty, $part:literal) => {
        impl $crate::Spec for $spec {
            const PART: &'static str = $part;

            fn schema() -> &'static $crate::serde_json::Value {
                <$whole as $crate::Spec>::schema()
            }
        }
    };
    ($($spec:ty),* $(,)?) => {$(
        impl $crate::Spec for $spec {
            fn schema() -> &'static $crate::serde_json::Value {
                static KEPT: std::sync::OnceLock<$crate::serde_json::Value> = std::sync::OnceLock::new();
                KEPT.get_or_init($crate::made_schema::<Self>)
            }
        }
    )*};
}

/// Reads the schema in a file that comes with the program.
pub fn kept_schema(text: &str) -> Value {
    let read = serde_json::from_str(text);
    debug_assert!(read.is_ok(), "{read:?}");
    read.unwrap_or_default()
}

/// Derives the schema of a type anew.
pub fn made_schema<T: JsonSchema>() -> Value {
    let mut schema = schemars::SchemaGenerator::default().into_root_schema_for::<T>().to_value();
    unlink(&mut schema);
    schema
}

/// Removes the links from all descriptions: their readers do not have these docs.
fn unlink(schema: &mut Value) {
    match schema {
        Value::Object(fields) => {
            for (name, value) in fields {
                match value {
                    Value::String(text) if name == "description" => *text = without_links(text),
                    other => unlink(other),
                }
            }
        }
        Value::Array(rows) => rows.iter_mut().for_each(unlink),
        _ => {}
    }
}

/// Returns the text up to its example, with each link of rustdoc replaced by the last name that it shows:
/// ``[`Look::ribs`]`` by `` `ribs` ``, ``[`years`](Self::years)`` by `` `years` ``.
fn without_links(text: &str) -> String {
    let text = text.split_once("\n\n```").map_or(text, |(text, _)| text);
    let (mut out, mut rest) = (String::with_capacity(text.len()), text);
    while let Some((before, link)) = rest.split_once("[`") {
        let Some((shown, after)) = link.split_once("`]") else { break };
        let name = shown.rsplit("::").next().unwrap_or(shown);
        out = out + before + "`" + name + "`";
        let target = after.strip_prefix('(').and_then(|to| to.split_once(')'));
        rest = target.map_or(after, |(_, after)| after);
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::without_links;

    #[test]
    fn descriptions_have_no_links_of_the_docs() {
        for (text, want) in [
            ("in years of [`years`](Self::years); none", "in years of `years`; none"),
            ("see [`Look::ribs`].", "see `ribs`."),
            ("A tree.\n\n```\nlet tree = 1;\n```", "A tree."),
            ("[0, 1] or `[a]`, [`b`", "[0, 1] or `[a]`, [`b`"),
        ] {
            assert_eq!(without_links(text), want);
        }
    }
}
