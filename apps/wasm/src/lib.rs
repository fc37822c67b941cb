//! Burgeon for the browser and Node: parses, converts, calls. No algorithms.

use burgeon::formats::{self, DrawingFormat};
use burgeon::{ItemReport, Run, Seed, SketchOptions, make_from_sketch};
use wasm_bindgen::prelude::*;

/// Makes a plant from every drawing of a file (SVG, InkML, QuickDraw ndjson or our JSON, told by its name)
/// and returns the report's items as a JSON array.
///
/// # Errors
/// A message for people when the file cannot be read or a drawing has nothing usable.
#[wasm_bindgen]
pub fn sketch_report(file_name: &str, bytes: &[u8], seed: u64) -> Result<String, JsError> {
    let mut items: Vec<ItemReport> = Vec::new();
    let (stem, extension) = file_name.rsplit_once('.').unwrap_or((file_name, ""));
    let format = DrawingFormat::from_extension(extension)
        .or_else(|| DrawingFormat::sniff(bytes))
        .ok_or_else(|| JsError::new("not a drawing: give an SVG, InkML, ndjson or JSON file"))?;
    for read in formats::read_drawings(bytes, format, stem) {
        let made =
            make_from_sketch(&read?.drawing, &SketchOptions::default(), Seed::new(seed), &Run::plain())?;
        items.push(made.item);
    }
    Ok(serde_json::to_string(&items)?)
}
