//! Warnings about plants and files can be translated into Chinese: each code of a warning has its text in the page.

use std::fs;
use std::path::Path;

use workspace::Workspace;

const CRATES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
const TEXTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../apps/studio-web/src/text/zh-errors.ts");
/// Crates that make plants, read files or measure.
const TOLD: [&str; 12] = [
    "bloom/src",
    "forest/src",
    "formats/src",
    "growth/src",
    "ink/src",
    "leaf/src",
    "mechanics/src",
    "reading/src",
    "scan/src",
    "sketch/src",
    "burgeon/src",
    "workspace/src",
];
/// Warnings made otherwise than by a call of `warn` with the code in it.
const NAMED: [(&str, &[&str]); 20] = [
    ("unlike-a-plant", &[]),
    ("edit-not-done", &["edit", "word", "why"]),
    ("sample-skipped", &["stroke", "count"]),
    ("stray-skipped", &["stroke", "count"]),
    ("growth-too-much", &["year", "years", "joints", "next", "most"]),
    ("off-sheet", &["count"]),
    ("paper-left-out", &["count"]),
    ("labels-left-out", &["count"]),
    ("filled-outline", &["count"]),
    ("traced-ink", &["count"]),
    ("drawn-twice", &["count"]),
    ("pieces-joined", &["count"]),
    ("colour-under-line", &["count"]),
    ("shade-left-out", &["count"]),
    ("hatching-left-out", &["count"]),
    ("light-dark", &["value"]),
    ("light-no-leaves", &[]),
    ("light-rough", &["value", "bound"]),
    ("light-leaf-meshes", &["value", "bound"]),
    ("light-dense", &["value", "bound"]),
];

/// A code and the fields that go with it.
type Found = (String, Vec<String>);

/// Finds the calls of `warn` and the warnings made otherwise, before the tests of a file.
fn codes(folder: &Path, found: &mut Vec<Found>) {
    for entry in fs::read_dir(folder).expect("a folder of the workspace") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            codes(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = fs::read_to_string(&path).expect("UTF-8");
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            for call in code.split(".warn(").skip(1) {
                let code = call.trim_start().strip_prefix('"').and_then(|rest| rest.split('"').next());
                found.extend(code.map(|code| (code.to_owned(), Vec::new())));
            }
            for made in code.split("code: \"").skip(1) {
                found.extend(made.split('"').next().map(|code| (code.to_owned(), Vec::new())));
            }
            for call in code.split("base::warn!(").skip(1) {
                let (code, rest) =
                    call.split('"').nth(1).zip(call.split_once('{')).expect("a code and fields");
                let fields = rest.1.split_once('}').expect("fields").0.split(',');
                let names = fields.filter_map(|f| Some(f.split_once('=')?.0.trim().to_owned()));
                found.push((code.to_owned(), names.collect()));
            }
        }
    }
}

#[test]
fn each_warning_has_a_chinese_text() {
    let named = NAMED.map(|(code, fields)| (code.to_owned(), fields.iter().map(|&f| f.to_owned()).collect()));
    let mut found: Vec<Found> = named.into();
    let of_check = |code: &str| (code.to_owned(), vec!["value".to_owned(), "bound".to_owned()]);
    found.extend(burgeon::CHECKS.into_iter().map(of_check));
    for folder in TOLD {
        codes(&Path::new(CRATES).join(folder), &mut found);
    }
    found.sort_unstable();
    found.dedup();
    assert!(found.len() > 20, "{found:?}");
    let texts = fs::read_to_string(TEXTS).expect("the texts of the page");
    let texts = texts.split("zhWarnings").nth(1).expect("texts of warnings");
    for (code, fields) in found {
        let starts = [format!("  {code}:"), format!("'{code}':")];
        let text = starts.iter().find_map(|start| texts.split_once(start.as_str()));
        let text = text.and_then(|(_, rest)| rest.split('\'').nth(1));
        let text = text.unwrap_or_else(|| panic!("no Chinese text for {code}"));
        // Growth stops by several rules, each with its own number.
        for field in fields.iter().filter(|f| *f != "round") {
            assert!(text.contains(&format!("{{{field}}}")), "{code}: {field} is not in \"{text}\"");
        }
    }
}

/// Warnings about an opened file have codes and numbers, not sentences alone.
#[test]
fn files_are_warned_of_with_codes() {
    let mut workspace = Workspace::default();
    let svg = br#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 99 99"><text>a</text>
<path id="p" stroke="black" fill="none" d="M10 10L20 60L30 5 L"/></svg>"#;
    let opened = workspace.open("a.svg", svg, 0, false).unwrap();
    let told: Vec<_> = opened.warnings.iter().map(|w| (w.code, w.fields.clone())).collect();
    let fields = |pairs: &[(&'static str, &str)]| pairs.iter().map(|(k, v)| (*k, (*v).to_owned())).collect();
    let broken = fields(&[("attribute", "d"), ("line", "2"), ("name", "<path> `p`")]);
    let left_out = fields(&[("count", "1"), ("what", "text")]);
    assert_eq!(told, [("svg-broken", broken), ("svg-left-out", left_out)]);
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n";
    let opened = workspace.open("a.obj", obj, 0, false).unwrap();
    let told: Vec<_> = opened.warnings.iter().map(|w| (w.code, w.fields["count"].as_str())).collect();
    assert_eq!(told, [("obj-left-out", "1")]);
}
