//! Classes that the user sets for strokes: CSV, JSON, or a report with corrections.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Mutex;

use burgeon::ClassOverrides;
use burgeon::ink::StrokeClass;
use serde_json::Value;

use crate::failure::{Failure, Outcome};

/// Overrides of a run, by the drawing's name.
#[derive(Debug, Default)]
pub(crate) struct Classes {
    /// Overrides for the only drawing of the run.
    any: ClassOverrides,
    named: BTreeMap<String, ClassOverrides>,
    used: Mutex<BTreeSet<String>>,
}

impl Classes {
    pub(crate) fn read(path: &Path) -> Outcome<Self> {
        let text = crate::files::read_text(path)?;
        Self::parse(&text).map_err(|what| Failure::bad_file(path, what))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let mut out = Self::default();
        if text.trim_start().starts_with(['{', '[']) {
            let json: Value = serde_json::from_str(text).map_err(|e| format!("is not valid JSON: {e}"))?;
            out.add_json(&json)?;
        } else {
            for (k, line) in text.lines().enumerate() {
                out.add_csv(line, k == 0).map_err(|what| format!("line {}: {what}", k + 1))?;
            }
        }
        if out.any.is_empty() && out.named.is_empty() {
            return Err("sets no class; write lines such as \"3,axis\" (stroke from 0, class)".into());
        }
        Ok(out)
    }

    fn add_csv(&mut self, line: &str, first: bool) -> Result<(), String> {
        let line = line.trim().trim_start_matches('\u{feff}');
        if line.is_empty() || line.starts_with('#') {
            return Ok(());
        }
        // A drawing's name may hold commas: the last two cells are the stroke and the class.
        let mut cells = line.rsplitn(3, [',', ';', '\t']).map(|c| c.trim().trim_matches('"'));
        let (class, stroke, name) = (cells.next(), cells.next(), cells.next());
        let stroke = stroke.ok_or("a line holds a stroke and a class, such as \"3,axis\"")?;
        if first
            && stroke.parse::<u32>().is_err()
            && StrokeClass::from_word(class.unwrap_or_default()).is_none()
        {
            return Ok(()); // a header
        }
        let index = index_of(stroke)?;
        let class = class_of(class.unwrap_or_default())?;
        self.overrides_mut(name).insert(index, class);
        Ok(())
    }

    fn overrides_mut(&mut self, name: Option<&str>) -> &mut ClassOverrides {
        match name {
            Some(name) => self.named.entry(name.to_owned()).or_default(),
            None => &mut self.any,
        }
    }

    fn add_json(&mut self, json: &Value) -> Result<(), String> {
        if let Some(items) = json.get("items").and_then(Value::as_array) {
            return items.iter().try_for_each(|item| self.add_report_item(item));
        }
        match json {
            Value::Object(map) => {
                for (key, value) in map {
                    match value {
                        Value::Object(strokes) => {
                            for (stroke, class) in strokes {
                                self.add_entry(Some(key), stroke, class)?;
                            }
                        }
                        Value::Array(list) => self.add_list(Some(key), list)?,
                        class => self.add_entry(None, key, class)?,
                    }
                }
                Ok(())
            }
            Value::Array(list) => self.add_list(None, list),
            _ => Err("holds neither an object nor a list".into()),
        }
    }

    // Adds one class for each stroke in order; null keeps the class found.
    fn add_list(&mut self, name: Option<&str>, list: &[Value]) -> Result<(), String> {
        for (k, class) in list.iter().enumerate().filter(|(_, class)| !class.is_null()) {
            self.add_entry(name, &k.to_string(), class)?;
        }
        Ok(())
    }

    fn add_entry(&mut self, name: Option<&str>, stroke: &str, class: &Value) -> Result<(), String> {
        let index = index_of(stroke)?;
        let word = class.as_str().ok_or_else(|| format!("the class of stroke {index} is not a word"))?;
        let class = class_of(word)?;
        self.overrides_mut(name).insert(index, class);
        Ok(())
    }

    fn add_report_item(&mut self, item: &Value) -> Result<(), String> {
        let name = item.get("name").and_then(Value::as_str).ok_or("an item of the report has no name")?;
        let strokes = item.get("strokes").and_then(Value::as_array);
        for stroke in strokes.ok_or_else(|| format!("item \"{name}\" has no strokes"))? {
            let index = stroke.get("index").and_then(Value::as_u64);
            let index = index.ok_or_else(|| format!("a stroke of item \"{name}\" has no index"))?;
            let class = stroke.get("class").unwrap_or(&Value::Null);
            self.add_entry(Some(name), &index.to_string(), class)?;
        }
        Ok(())
    }

    /// Fails when entries without a drawing's name are used with more than one drawing.
    pub(crate) fn fits_batch(&self, path: Option<&Path>) -> Outcome {
        match path {
            Some(path) if !self.any.is_empty() => Err(Failure::bad_file(
                path,
                "names no drawing, but there are several; write drawing,stroke,class or {\"drawing\": {\"3\": \"axis\"}}",
            )),
            _ => Ok(()),
        }
    }

    /// Returns the overrides for a drawing.
    pub(crate) fn for_drawing(&self, name: &str) -> ClassOverrides {
        let mut out = self.any.clone();
        if let Some(named) = self.named.get(name) {
            for (&stroke, &class) in named {
                out.insert(stroke, class);
            }
            if let Ok(mut used) = self.used.lock() {
                used.insert(name.to_owned());
            }
        }
        out
    }

    /// Returns the names in the file that no drawing had.
    pub(crate) fn unused(&self) -> Vec<&str> {
        let used = self.used.lock();
        let is_used = |name: &String| used.as_ref().is_ok_and(|used| used.contains(name));
        self.named.keys().filter(|name| !is_used(name)).map(String::as_str).collect()
    }
}

fn index_of(text: &str) -> Result<u32, String> {
    text.parse().ok().ok_or_else(|| format!("\"{text}\" is not a stroke's number (from 0)"))
}

fn class_of(word: &str) -> Result<StrokeClass, String> {
    StrokeClass::from_word(word).ok_or_else(|| {
        let words: Vec<&str> = StrokeClass::ALL.iter().map(|c| c.word()).collect();
        format!("\"{word}\" is not a class; choose among {}", words.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn classes(text: &str, drawing: &str) -> Vec<(u32, &'static str)> {
        let all = Classes::parse(text).unwrap();
        all.for_drawing(drawing).into_iter().map(|(k, c)| (k, c.word())).collect()
    }

    #[test]
    fn every_form_is_read() {
        let want = [(0, "blade"), (3, "axis")];
        for text in [
            "stroke,class\n0,blade\n# a remark\n3, axis\n",
            "drawing,stroke,class\nmy, rose,0,blade\n\"my, rose\",3,axis",
            "my, rose;0;blade\nmy, rose;3;axis\nother;1;crown",
            r#"{"0": "blade", "3": "axis"}"#,
            r#"["blade", null, null, "axis"]"#,
            r#"{"my, rose": {"0": "blade", "3": "axis"}, "other": {"1": "crown"}}"#,
            r#"{"items": [{"name": "my, rose", "strokes": [{"index": 0, "class": "blade"}, {"index": 3, "class": "axis"}]}]}"#,
        ] {
            assert_eq!(classes(text, "my, rose"), want, "{text}");
        }
    }

    #[test]
    fn mistakes_are_named() {
        for (text, part) in [
            ("", "sets no class"),
            ("0,blade\n1,petall", "line 2: \"petall\" is not a class; choose among blade"),
            ("0,blade\nx,axis", "line 2: \"x\" is not a stroke's number"),
            ("blade", "a stroke and a class"),
            ("{\"0\": 5}", "the class of stroke 0 is not a word"),
            ("{\"0\"", "is not valid JSON"),
        ] {
            let got = Classes::parse(text).err().unwrap_or_default();
            assert!(got.contains(part), "{text:?} gave {got:?}");
        }
    }

    #[test]
    fn unused_names_are_found() {
        let all = Classes::parse("rose,0,blade\nlily,1,axis").unwrap();
        all.for_drawing("rose");
        assert_eq!(all.unused(), ["lily"]);
    }
}
