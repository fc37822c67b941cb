//! Messages to people: no word of the programming language, no place in axes that nobody gave, files of other programs
//! by their names, and one warning for many equal ones.
#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "tests, whose files need not be the same everywhere"
)]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use burgeon::Spec;
use burgeon::bloom::FlowerSpec;
use burgeon::growth::TreeSpec;
use burgeon::leaf::LeafSpec;
use burgeon::sketch::SketchSpec;
use burgeon::skin::SkinSpec;
use serde_json::{Value, json};

use crate::tools::{bad, folder, good, json as read_json};

/// Names of types and paths of Rust, and words of its readers.
const FOREIGN: [&str; 13] = [
    "usize",
    "isize",
    "Self::",
    "crate::",
    "struct ",
    "enum ",
    "untagged",
    "serde",
    "expected a sequence",
    "a map",
    "a string",
    "floating point",
    ".part",
];

/// Whether a word such as `u32` or `f64` is in it.
fn names_a_number_type(text: &str) -> bool {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric());
    words.filter_map(|w| w.strip_prefix(['i', 'u', 'f'])).any(|bits| ["8", "16", "32", "64"].contains(&bits))
}

fn assert_plain(text: &str) {
    assert!(!names_a_number_type(text), "{text}");
    assert!(FOREIGN.iter().all(|word| !text.contains(word)), "{text}");
}

/// Returns values of every kind.
fn kinds() -> [Value; 8] {
    [
        json!("text"),
        json!(true),
        json!(-1),
        json!(1.5),
        json!([1, 2]),
        json!({"a": 1}),
        json!(null),
        json!(1e300),
    ]
}

/// Finds the paths to all fields of a spec with their values.
fn fields(spec: &Value, path: &[String], found: &mut Vec<Vec<String>>) {
    let Value::Object(inner) = spec else { return };
    for (name, value) in inner {
        let path = [path, std::slice::from_ref(name)].concat();
        found.push(path.clone());
        fields(value, &path, found);
    }
}

/// Counts the values of other kinds that are refused in all fields of a spec, each in plain words.
fn refusals<T: Spec>(whole: &T) -> usize {
    let mut paths = Vec::new();
    fields(&burgeon::spec::to_json(whole), &[], &mut paths);
    let mut refused = 0;
    for path in &paths {
        for kind in kinds() {
            let spec = path.iter().rev().fold(kind, |inner, name| json!({ name: inner }));
            if let Err(fault) = burgeon::spec::with_fields(whole, spec) {
                assert_plain(&fault.to_string());
                refused += 1;
            }
        }
    }
    refused
}

#[test]
fn no_message_names_a_type_of_ours() {
    let all = [
        refusals(&TreeSpec::default()),
        refusals(&FlowerSpec::default()),
        refusals(&LeafSpec::default()),
        refusals(&SketchSpec::default()),
        refusals(&SkinSpec::default()),
    ];
    assert!(all.iter().sum::<usize>() > 500 && all.iter().all(|n| *n > 5), "{all:?}");
    let at = folder("words-types");
    fs::write(at.join("t.toml"), "[method]\nkind = \"colonization\"\npoints = \"many\"").unwrap();
    let said = bad(&at, &["grow", "t.toml", "-o", "x.mtg"]);
    assert!(said.contains("line 3: method.points: ") && said.contains("expected a whole number"), "{said}");
    assert_plain(&said);
    for edit in [
        r#"{"op":"paint"}"#,
        r#"{"op":"prune","axis":3}"#,
        r#"{"op":"prune","axis":{"path":"x"},"at":true}"#,
        "7",
    ] {
        fs::write(at.join("e.json"), format!(r#"{{"schema":"burgeon.edits/1","edits":[{edit}]}}"#)).unwrap();
        assert!(is_refused_plainly(&at, &["shape", "grass", "--edits", "e.json", "-o", "x.glb"]));
    }
    for text in ["[1]", r#"{"schema": 1}"#, r#"{"laws": "x"}"#] {
        fs::write(at.join("l.json"), text).unwrap();
        assert!(is_refused_plainly(
            &at,
            &["bloom", "run", "tulip", "--law", "l.json", "--day", "1", "-o", "x.glb"]
        ));
        assert!(is_refused_plainly(&at, &["leaf", "l.json", "-o", "x.glb"]));
        assert!(is_refused_plainly(&at, &["sketch", "l.json", "-o", "x.glb"]));
    }
}

/// Whether it is refused, in plain words.
fn is_refused_plainly(at: &Path, args: &[&str]) -> bool {
    let out = crate::tools::burgeon(at, args);
    let text = String::from_utf8(out.stderr).unwrap();
    assert_plain(&text);
    out.status.code() == Some(2)
}

/// Finds all files below a folder whose names have this ending.
fn below(folder: &Path, end: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            below(&path, end, found);
        } else if path.to_str().is_some_and(|p| p.ends_with(end)) {
            found.push(path);
        }
    }
}

const CRATES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../crates");

#[test]
fn texts_of_schemas_are_for_people() {
    let mut files = Vec::new();
    below(Path::new(CRATES), ".json", &mut files);
    let schemas: Vec<_> = files.iter().filter(|f| f.parent().unwrap().ends_with("schemas")).collect();
    assert!(schemas.len() >= 6, "{schemas:?}");
    for file in schemas {
        for text in described(&read_json(file)) {
            for link in ["](", "[`", "::", "```"] {
                assert!(!text.contains(link), "{}: {text}", file.display());
            }
        }
    }
}

/// Returns all descriptions in a schema.
fn described(schema: &Value) -> Vec<String> {
    match schema {
        Value::Object(fields) => fields
            .iter()
            .flat_map(|(name, value)| match value {
                Value::String(text) if name == "description" => vec![text.clone()],
                other => described(other),
            })
            .collect(),
        Value::Array(rows) => rows.iter().flat_map(described).collect(),
        _ => Vec::new(),
    }
}

/// The library serves Python, npm and the Studio, too: its messages name no option of the command line.
#[test]
fn the_library_names_no_option_of_the_command_line() {
    let mut files = Vec::new();
    below(Path::new(CRATES), ".rs", &mut files);
    files.retain(|f| {
        let path = f.to_str().unwrap();
        path.contains("/src/") && !path.contains("/training/") && !path.ends_with("tests.rs")
    });
    let mut found = String::new();
    for file in &files {
        let text = fs::read_to_string(file).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap();
        for line in code.lines().filter(|l| !l.trim_start().starts_with("//")) {
            let option = |rest: &str| rest.starts_with(|c: char| c.is_ascii_lowercase());
            if line.split("--").skip(1).any(option) {
                writeln!(found, "{}: {}", file.display(), line.trim()).unwrap();
            }
        }
    }
    assert!(files.len() > 200 && found.is_empty(), "{found}");
}

/// Returns first bytes of files of other programs, and the names of these files.
fn others() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let zip = |name: &str| [&b"PK\x03\x04"[..], &[0; 26], name.as_bytes()].concat();
    vec![
        ("png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec(), "a picture (PNG)"),
        ("jpg", b"\xff\xd8\xff\xe0\0\x10JFIF".to_vec(), "a picture (JPEG)"),
        ("pdf", b"%PDF-1.7\n%".to_vec(), "a PDF document"),
        ("gz", b"\x1f\x8b\x08\0\0\0".to_vec(), "compressed with gzip"),
        ("kra", zip("mimetypeapplication/x-krita"), "a Krita document"),
        ("procreate", zip("Document.archivebplist00"), "a Procreate document"),
        ("zip", zip("word/document.xml"), "a ZIP archive"),
        ("e57", b"ASTM-E57\x01\0\0\0".to_vec(), "E57"),
        ("excalidraw", br#"{"type": "excalidraw", "version": 2}"#.to_vec(), "a drawing of Excalidraw"),
        ("tldr", br#"{"tldrawFileFormatVersion": 1}"#.to_vec(), "a drawing of tldraw"),
    ]
}

#[test]
fn files_of_other_programs_are_named() {
    let at = folder("words-foreign");
    for (own, bytes, name) in others() {
        let drawn = ["excalidraw", "tldr"].contains(&own);
        // Compressed drawings and archives of projects may be read where they are accepted.
        let packed = ["gz", "zip"].contains(&own);
        for end in [own, "toml", "csv", "las", "ply"] {
            let file = format!("given.{end}");
            fs::write(at.join(&file), &bytes).unwrap();
            let is_cloud = ["las", "ply"].contains(&end);
            let mut uses: Vec<Vec<&str>> = Vec::new();
            if end == "toml" {
                uses.push(vec!["grow", &file, "-o", "x.glb"]);
                uses.push(vec!["bloom", "fit", &file, "-o", "x.json"]);
                uses.push(vec!["shape", "grass", "--edits", &file, "-o", "x.glb"]);
                uses.push(vec!["replay", &file, "--png", "x.png"]);
            }
            if end == "csv" {
                uses.push(vec!["forest", &file, "-o", "stand"]);
                uses.push(vec!["leaf", &file, "-o", "x.glb"]);
            }
            if is_cloud || end == own {
                uses.push(vec!["scan", &file, "-o", "x.glb"]);
            }
            if end == "ply" {
                uses.push(vec!["render", &file, "-o", "x.png"]);
            }
            if end == own && !drawn && own != "gz" {
                uses.push(vec!["sketch", &file, "-o", "x.glb"]);
                uses.push(vec!["render", &file, "-o", "x.png"]);
                uses.push(vec!["convert", &file, "-o", "x.ply"]);
                uses.push(vec!["info", &file]);
            }
            for args in uses {
                let said = bad(&at, &args);
                assert!(said.contains(name), "{args:?}: {said}");
                assert!(said.contains(&file), "{args:?}: {said}");
            }
        }
        if !drawn && !packed {
            fs::write(at.join("given.svg"), &bytes).unwrap();
            assert!(bad(&at, &["sketch", "given.svg", "-o", "x.glb"]).contains(name));
            fs::write(at.join("given.burgeon"), &bytes).unwrap();
            assert!(bad(&at, &["sketch", "given.burgeon", "-o", "x.glb"]).contains(name));
        }
    }
}

/// What is packed as gzip is unpacked where it is a drawing, and named where it is not.
#[test]
fn a_packed_file_that_is_no_drawing_is_named_as_packed() {
    let at = folder("words-packed");
    // As `gzip` writes them: no compression, then the sum and length of the text.
    let packed = |text: &[u8], sum: u32| {
        let length = u16::try_from(text.len()).unwrap();
        let head =
            [&b"\x1f\x8b\x08\0\0\0\0\0\0\x03\x01"[..], &length.to_le_bytes(), &(!length).to_le_bytes()];
        [&head.concat(), text, &sum.to_le_bytes(), &u32::from(length).to_le_bytes()].concat()
    };
    fs::write(at.join("cloud.xyz.gz"), packed(b"0 0 0\n1 1 1\n", 0x7a6a_bf90)).unwrap();
    fs::write(at.join("picture.svgz"), packed(b"<svg/>", 0xacb9_fb49)).unwrap();
    for args in [&["sketch", "cloud.xyz.gz", "-o", "x.glb"][..], &["info", "cloud.xyz.gz"]] {
        let said = bad(&at, args);
        assert!(said.contains("compressed with gzip; unpack it"), "{said}");
    }
    let said = bad(&at, &["sketch", "picture.svgz", "-o", "x.glb"]);
    assert!(said.contains("there is no stroke in it"), "{said}");
}

#[test]
fn an_age_beyond_life_names_its_end() {
    let at = folder("words-age");
    for (preset, end) in [("oak", "40"), ("alder", "24"), ("birch", "30"), ("maize", "1")] {
        let said = bad(&at, &["grow", preset, "--age", "5000", "-o", "x.mtg"]);
        assert!(said.contains(&format!("age must be 1 to {end}, not 5000")), "{said}");
    }
    let said = bad(&at, &["grow", "oak", "--method", "guided", "--age", "5000", "-o", "x.mtg"]);
    assert!(said.contains("age must be 1 to 40"), "{said}");
    fs::write(
        at.join("steps.toml"),
        "[method]\nkind = \"lsystem\"\nmost_modules = 1000\nrules = \"axiom = A\\nsteps = 6\\nA -> F(0.1) A\"",
    )
    .unwrap();
    good(&at, &["grow", "steps.toml", "--age", "6", "-o", "x.mtg", "--quiet"]);
    assert!(bad(&at, &["grow", "steps.toml", "--age", "7", "-o", "x.mtg"]).contains("age must be 1 to 6"));
}

/// Writes a scan of stems on the ground, +Z up: position along x and height of each, metres.
pub(crate) fn stems(all: &[(f64, f64)]) -> String {
    let mut text = String::new();
    for i in 0..3200 {
        let (x, y) = (f64::from(i % 80) * 0.1 - 2.0, f64::from(i / 80) * 0.1 - 2.0);
        writeln!(text, "{x:.3} {y:.3} 0").unwrap();
    }
    for (x, height) in all {
        for i in 0..3840 {
            let (angle, z) = (f64::from(i % 24) * 0.2618, f64::from(i / 24) * height / 160.0);
            writeln!(text, "{:.4} {:.4} {z:.4}", x + 0.1 * angle.cos(), 0.1 * angle.sin()).unwrap();
        }
    }
    text
}

#[test]
fn a_place_is_told_as_it_was_given() {
    let at = folder("words-place");
    fs::write(at.join("stem.xyz"), stems(&[(0.0, 3.0)])).unwrap();
    good(&at, &["scan", "stem.xyz", "--at", "0,0", "-o", "x.mtg", "--quiet"]);
    let said = bad(&at, &["scan", "stem.xyz", "--at", "9.45,1.25", "-o", "x.mtg"]);
    assert!(said.contains("of 9.45,1.25;") && !said.contains("-1.25"), "{said}");
}

#[test]
fn twenty_warnings_that_are_alike_are_one() {
    let at = folder("words-alike");
    let dots: String =
        (0..20).map(|k| format!(r##"<path fill="none" stroke="#000" d="M{k} 5"/>"##)).collect();
    fs::write(at.join("dots.svg"), crate::tools::FLOWER.replace("</svg>", &format!("{dots}</svg>"))).unwrap();
    let args = ["sketch", "dots.svg", "-o", "x.glb", "--no-textures", "--json"];
    let report: Value = serde_json::from_str(&good(&at, &args)).unwrap();
    let warnings = &report["items"][0]["warnings"];
    assert_eq!(*warnings, json!(["stroke 8 has one point and was left out (and 19 more like it)"]));
}
