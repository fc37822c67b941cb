//! JSON Schemas -> the types of TypeScript.

use std::fmt::Write as _;

use serde_json::{Map, Value};

/// Declares a type for each of these schemas.
pub(crate) fn declare(out: &mut String, schemas: &Map<String, Value>) {
    for (name, schema) in schemas {
        let text = typed(schema, "");
        let gap = if text.starts_with('\n') { "" } else { " " };
        write!(out, "\n{}export type {name} ={gap}{text};\n", doc(schema, "")).expect("strings take all");
    }
}

/// Returns the first sentence of a description as a comment.
fn doc(schema: &Value, indent: &str) -> String {
    let Some(text) = schema["description"].as_str() else { return String::new() };
    let text = text.split("\n\n").next().unwrap_or_default().replace('\n', " ");
    let end = text.find(". ").map_or(text.len(), |k| k + 1);
    format!("/** {} */\n{indent}", &text[..end])
}

fn typed(schema: &Value, indent: &str) -> String {
    let Some(schema) = schema.as_object() else { return "Json".into() };
    if let Some(name) = schema.get("$ref").and_then(Value::as_str) {
        return name.rsplit('/').next().unwrap_or_default().into();
    }
    if let Some(value) = schema.get("const") {
        return value.to_string();
    }
    if let Some(values) = schema.get("enum").and_then(Value::as_array) {
        return values.iter().map(ToString::to_string).collect::<Vec<_>>().join(" | ");
    }
    let choices = ["oneOf", "anyOf"].iter().find_map(|k| schema.get(*k)?.as_array());
    let own = object_or_plain(schema, indent);
    match (choices, own) {
        (Some(choices), own) => {
            let inner = format!("{indent}  ");
            let rows =
                choices.iter().map(|c| format!("\n{indent}  | {}{}", doc(c, &inner), typed(c, &inner)));
            let union = rows.collect::<String>();
            if own == "Json" { union } else { format!("{own} & ({union})") }
        }
        (None, own) => own,
    }
}

fn object_or_plain(schema: &Map<String, Value>, indent: &str) -> String {
    let one = |word: &str| match word {
        "null" => "null".into(),
        "boolean" => "boolean".into(),
        "integer" | "number" => "number".into(),
        "string" => "string".into(),
        "array" => array(schema, indent),
        "object" => object(schema, indent),
        other => panic!("no TypeScript for {other}"),
    };
    match schema.get("type") {
        Some(Value::String(word)) => one(word),
        Some(Value::Array(words)) => {
            words.iter().filter_map(Value::as_str).map(one).collect::<Vec<_>>().join(" | ")
        }
        _ => "Json".into(),
    }
}

fn array(schema: &Map<String, Value>, indent: &str) -> String {
    let each = |items: &[Value]| items.iter().map(|i| typed(i, indent)).collect::<Vec<_>>().join(", ");
    if let Some(items) = schema.get("prefixItems").and_then(Value::as_array) {
        return format!("[{}]", each(items));
    }
    let item = schema.get("items").cloned().unwrap_or_default();
    match (schema.get("minItems").and_then(Value::as_u64), schema.get("maxItems").and_then(Value::as_u64)) {
        (Some(low), Some(high)) if low == high => {
            format!("[{}]", each(&vec![item; usize::try_from(low).expect("a few")]))
        }
        _ => {
            let one = typed(&item, indent);
            if one.contains(['|', '&']) { format!("({one})[]") } else { format!("{one}[]") }
        }
    }
}

fn object(schema: &Map<String, Value>, indent: &str) -> String {
    let Some(fields) = schema.get("properties").and_then(Value::as_object) else {
        let value = schema.get("additionalProperties").map_or("Json".into(), |v| typed(v, indent));
        return format!("Record<string, {value}>");
    };
    let required: Vec<&str> = schema
        .get("required")
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect();
    let inner = format!("{indent}  ");
    let mut out = String::from("{\n");
    for (name, field) in fields {
        let key = if name.contains('-') { format!("'{name}'") } else { name.clone() };
        let mark = if required.contains(&name.as_str()) { "" } else { "?" };
        writeln!(out, "{inner}{}{key}{mark}: {};", doc(field, &inner), typed(field, &inner))
            .expect("strings take all");
    }
    write!(out, "{indent}}}").expect("strings take all");
    out
}
