//! Drawings in the format of "Quick, Draw!", and sets in the same format: one JSON object in each line.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec2;
use ink::{Drawing, InkSample, Stroke};
use serde_json::Value;

/// Reads the drawings of a folder's files, by their keys.
pub(crate) fn drawings_of(folder: &Path) -> Result<BTreeMap<String, Drawing>, String> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|f| f.path()).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "ndjson"));
    files.sort();
    let mut drawings = BTreeMap::new();
    for file in files {
        drawings.extend(
            json_lines(&file)?.iter().map(|line| (text_of(line, "key_id").to_owned(), drawing_of(line))),
        );
    }
    Ok(drawings)
}

pub(crate) fn drawing_of(line: &Value) -> Drawing {
    let stroke = |s: &Value| {
        let column = |k: usize| list(s.get(k)).iter().filter_map(Value::as_f64);
        // Points are y down in the files.
        let samples = column(0).zip(column(1)).map(|(x, y)| InkSample::from(DVec2::new(x, -y))).collect();
        Stroke { samples, ..Stroke::default() }
    };
    let name = text_of(line, "key_id").to_owned();
    Drawing { name, strokes: list(line.get("drawing")).iter().map(stroke).collect(), ..Drawing::default() }
}

pub(crate) fn json_lines(path: &Path) -> Result<Vec<Value>, String> {
    let parse = |(k, line): (usize, &str)| {
        serde_json::from_str(line).map_err(|e| format!("{}, line {}: {e}", path.display(), k + 1))
    };
    read(path)?.lines().enumerate().filter(|(_, l)| !l.trim().is_empty()).map(parse).collect()
}

pub(crate) fn text_of<'a>(value: &'a Value, key: &str) -> &'a str {
    value.get(key).and_then(Value::as_str).unwrap_or_default()
}

pub(crate) fn list(value: Option<&Value>) -> &[Value] {
    value.and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

pub(crate) fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}
