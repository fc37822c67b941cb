//! What is told of a plant can be told in Chinese: each code of a warning has its text in the page.

use std::fs;
use std::path::Path;

const CRATES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
const TEXTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../apps/studio-web/src/text/zh-errors.ts");
/// Those that make plants. What readers of files warn of is told when a file is opened, in the core's words.
const MAKERS: [&str; 7] = ["bloom", "growth", "ink", "leaf", "reading", "sketch", "studio"];
/// Given to `warn` by a name.
const NAMED: [&str; 4] = ["unlike-a-plant", "edit-not-done", "sample-skipped", "stray-skipped"];

/// The codes that stand first in a call of `warn`, before the tests of a file.
fn codes(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder of the workspace") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            codes(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = fs::read_to_string(&path).expect("UTF-8");
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            for call in code.split(".warn(").skip(1) {
                let code = call.trim_start().strip_prefix('"').and_then(|rest| rest.split('"').next());
                found.extend(code.map(ToOwned::to_owned));
            }
        }
    }
}

#[test]
fn each_warning_of_a_plant_has_a_chinese_text() {
    let mut found: Vec<String> = NAMED.map(Into::into).into();
    for name in MAKERS {
        codes(&Path::new(CRATES).join(name).join("src"), &mut found);
    }
    found.sort_unstable();
    found.dedup();
    assert!(found.len() > 20, "{found:?}");
    let texts = fs::read_to_string(TEXTS).expect("the texts of the page");
    let texts = texts.split("zhWarnings").nth(1).expect("texts of warnings");
    let missing: Vec<_> = found
        .iter()
        .filter(|c| !texts.contains(&format!("  {c}: ")) && !texts.contains(&format!("'{c}': ")))
        .collect();
    assert!(missing.is_empty(), "no Chinese text for {missing:?}");
}
