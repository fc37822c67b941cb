//! `burgeon shape` as other programs call it: every edit on a species, a drawing and an L-system, and bad input.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::fs;

use serde_json::Value;
use tools::{bad, burgeon, folder, good};

const EDITS: &str = r#"{"schema": "burgeon.edits/1", "edits": [
  {"op": "rotate", "axis": {"path": [0, 1]}, "turn": {"about": [0, 1, 0], "degrees": 40}},
  {"op": "move", "axis": {"path": [0, 1]}, "to": {"slide-m": 0.2}},
  {"op": "prune", "axis": {"path": [0, 0]}},
  {"op": "regrow", "axis": {"path": [0, 0]}, "seed": 7},
  {"op": "sketch-branch", "bearer": {"path": [0]}, "at": 0.4, "points": [[0, 3, 0], [0.8, 3.4, 0.2], [1.8, 3.9, 0.5]]},
  {"op": "brush", "bearer": {"path": [0]}, "points": [[0, 3, 0], [-0.8, 3.5, 0.3], [-1.8, 4.6, 0.5]], "radius_m": [0.4]},
  {"op": "silhouette", "outline": [[-2, 2], [2, 2], [3, 5], [0, 9], [-3, 5]]},
  {"op": "leaf-density", "region": "all", "keep": 0.7},
  {"op": "prune", "axis": {"path": [0, 999]}}
]}"#;

#[test]
fn every_edit_is_done_on_a_species_a_drawing_and_an_l_system() {
    let f = folder("shape-all");
    fs::write(f.join("edits.json"), EDITS).unwrap();
    let tree = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/sketches/table1/h.svg");
    fs::write(f.join("small.toml"), "[method]\nkind = \"competition\"\npoints = 300").unwrap();
    fs::write(f.join("rules.toml"), lsystem()).unwrap();
    for what in ["small.toml", "rules.toml", tree] {
        let args = [
            "shape",
            what,
            "--edits",
            "edits.json",
            "-o",
            "out.glb",
            "--no-textures",
            "--detail",
            "0.3",
            "--json",
        ];
        let report: Value = serde_json::from_str(&good(&f, &args)).unwrap();
        let item = &report["items"][0];
        let edits = item["edits"].as_array().unwrap();
        let undone: Vec<&Value> = edits.iter().filter(|e| e["done"] == false).collect();
        assert_eq!((edits.len(), undone.len()), (9, 1), "{what}: {undone:?}");
        assert_eq!(
            (undone[0]["index"].as_u64(), undone[0]["code"].as_str()),
            (Some(8), Some("no-such-number"))
        );
        assert!(item["warnings"].to_string().contains("there is no branch number 999"), "{what}");
        let again: Value =
            serde_json::from_str(&good(&f, &[&args[..], &["--threads", "1"]].concat())).unwrap();
        assert_eq!(again["items"][0]["digest"], item["digest"], "{what}");
        assert!(fs::metadata(f.join("out.glb")).unwrap().len() > 10_000);
    }
}

fn lsystem() -> String {
    let preset = fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../crates/burgeon/presets/oak-lsystem.toml"
    ));
    // Younger, for a quick test.
    format!("age = 7\n{}", preset.unwrap())
}

#[test]
fn branches_are_listed_and_the_template_is_an_edits_file() {
    let f = folder("shape-list");
    fs::write(f.join("small.toml"), "[method]\nkind = \"competition\"\npoints = 300").unwrap();
    let list = good(&f, &["shape", "small.toml", "--list", "--quiet"]);
    assert!(list.lines().count() > 6 && list.contains("[0, 3]") && !list.contains("[0, 3, 0]"), "{list}");
    let template = good(&f, &["shape", "--template"]);
    fs::write(f.join("t.json"), template).unwrap();
    good(
        &f,
        &["shape", "small.toml", "--edits", "t.json", "-o", "t.glb", "--no-textures", "--detail", "0.3"],
    );
    good(&f, &["shape", "--schema", "schema.json"]);
    let schema: Value = serde_json::from_str(&fs::read_to_string(f.join("schema.json")).unwrap()).unwrap();
    assert!(schema.to_string().contains("silhouette"));
}

#[test]
fn edits_that_do_the_same_are_told_in_one_line() {
    let f = folder("shape-same");
    fs::write(f.join("small.toml"), "[method]\nkind = \"competition\"\npoints = 300").unwrap();
    let copy =
        r#"{"op": "copy", "axis": {"path": [0, 0]}, "to": {"place": {"axis": {"path": [0]}, "at": 0.5}}}"#;
    let prune = r#"{"op": "prune", "axis": {"path": [0, 0]}}"#;
    let edits = [[copy; 20].join(", "), prune.to_owned()].join(", ");
    fs::write(f.join("e.json"), format!("{{\"schema\": \"burgeon.edits/1\", \"edits\": [{edits}]}}"))
        .unwrap();
    let out = burgeon(&f, &["shape", "small.toml", "--edits", "e.json", "-o", "x.glb", "--no-textures"]);
    let said = String::from_utf8_lossy(&out.stdout).into_owned();
    let lines: Vec<&str> = said.lines().filter(|l| l.starts_with("edit")).collect();
    assert!(out.status.success() && lines.len() == 2, "{said}");
    assert!(lines[0].starts_with("edits 0 to 19, each: ") && lines[1].starts_with("edit 20: "), "{said}");
}

#[test]
fn bad_input_says_what_and_where() {
    let f = folder("shape-bad");
    fs::write(f.join("small.toml"), "[method]\nkind = \"competition\"\npoints = 300").unwrap();
    fs::write(f.join("old.json"), r#"{"schema": "burgeon.edits/9", "edits": []}"#).unwrap();
    fs::write(f.join("odd.json"), r#"{"schema": "burgeon.edits/1", "edits": [{"op": "paint"}]}"#).unwrap();
    let told = bad(&f, &["shape", "small.toml", "--edits", "old.json", "-o", "x.glb"]);
    assert!(told.contains("old.json") && told.contains("burgeon.edits/9"), "{told}");
    let told = bad(&f, &["shape", "small.toml", "--edits", "odd.json", "-o", "x.glb"]);
    assert!(told.contains("unknown variant `paint`") && told.contains("--template"), "{told}");
    let told = bad(&f, &["shape", "nothing-like-it", "--edits", "odd.json", "-o", "x.glb"]);
    assert!(told.contains("odd.json") || told.contains("nothing-like-it"), "{told}");
    bad(&f, &["shape", "small.toml", "-o", "x.glb"]);
    assert!(!f.join("x.glb").exists());
}

const GARDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-3.burgeon");

#[test]
fn a_plant_of_a_project_is_chosen_shaped_and_saved() {
    let f = folder("shape-project");
    fs::copy(GARDEN, f.join("garden.burgeon")).unwrap();
    let edits = r#"{"schema": "burgeon.edits/1", "edits": [{"op": "prune", "axis": {"path": [0, 0]}}, {"op": "prune", "axis": {"path": [0, 0]}}]}"#;
    fs::write(f.join("edits.json"), edits).unwrap();
    let json = |args: &[&str]| -> Value { serde_json::from_str(&good(&f, args)).unwrap() };
    let shape = ["shape", "garden.burgeon", "--edits", "edits.json", "--json"];
    let by_name =
        json(&[&shape[..], &["--plant", "Bush", "-o", "bush.glb", "--save", "shaped.burgeon"]].concat());
    let item = &by_name["items"][0];
    assert_eq!(item["edits"].as_array().unwrap().len(), 2);
    assert!(item["edits"].as_array().unwrap().iter().all(|e| e["done"] == true), "{item}");
    assert!(fs::metadata(f.join("bush.glb")).unwrap().len() > 1000);
    let by_number = json(&[&shape[..], &["--plant", "2", "--png", "bush.png"]].concat());
    assert_eq!(by_number["items"][0]["digest"], item["digest"]);
    // The project's own seed, unless another is given; the saved project makes the same plant of it.
    assert_eq!(by_name["seed"], 3);
    let again =
        json(&["shape", "shaped.burgeon", "--plant", "bush", "--report", "again.json", "--json", "--list"]);
    assert_eq!(again["items"][0]["digest"], item["digest"]);
    let scene = json(&["sketch", "shaped.burgeon", "-o", "scene.glb", "--json"]);
    let digests: Vec<&Value> = scene["items"].as_array().unwrap().iter().map(|i| &i["digest"]).collect();
    assert!(digests.contains(&&item["digest"]), "the scene has the same plant");
    let other = json(&[&shape[..], &["--plant", "bush", "--seed", "8", "--png", "x.png"]].concat());
    assert_ne!(other["items"][0]["digest"], item["digest"]);
    // Wind only where it was requested.
    let blown = |name: &str| -> bool {
        let info = json(&["info", name, "--json"]);
        info["model"]["parts"].as_array().unwrap().iter().all(|p| p["wind"] == true)
    };
    json(&[&shape[..], &["--plant", "bush", "--wind", "-o", "wind.glb"]].concat());
    assert!(blown("wind.glb") && !blown("bush.glb"));
    // One more edit comes after the existing ones.
    let more = json(&[
        "shape",
        "shaped.burgeon",
        "--edits",
        "edits.json",
        "--plant",
        "bush",
        "--save",
        "more.burgeon",
        "--json",
    ]);
    assert_eq!(more["items"][0]["edits"].as_array().unwrap().len(), 4);
}

#[test]
fn a_choice_among_plants_that_is_missing_or_wrong_names_them() {
    let f = folder("shape-choice");
    fs::copy(GARDEN, f.join("garden.burgeon")).unwrap();
    fs::write(f.join("edits.json"), EDITS).unwrap();
    fs::write(f.join("small.toml"), "[method]\nkind = \"competition\"\npoints = 300").unwrap();
    let told =
        |args: &[&str]| bad(&f, &[&["shape"], args, &["--edits", "edits.json", "-o", "x.glb"]].concat());
    let none = told(&["garden.burgeon"]);
    assert!(none.contains("--plant") && none.contains("1 \"drawn\" (sketch), 2 \"bush\" (tree)"), "{none}");
    let unknown = told(&["garden.burgeon", "--plant", "elm"]);
    assert!(unknown.contains("no plant \"elm\"") && unknown.contains("2 \"bush\" (tree)"), "{unknown}");
    assert!(told(&["garden.burgeon", "--plant", "9"]).contains("no plant \"9\""));
    assert!(told(&["garden.burgeon", "--plant", "tobacco"]).contains("is a leaf, which has no branches"));
    assert!(told(&["small.toml", "--plant", "bush"]).contains("no project"));
    assert!(told(&["small.toml", "--save", "y.burgeon"]).contains("--save"));
    assert!(
        told(&["garden.burgeon", "--plant", "bush", "--save", "garden.burgeon"]).contains("garden.burgeon")
    );
    assert!(!f.join("x.glb").exists() && !f.join("y.burgeon").exists());
}

#[test]
fn flowers_and_leaf_shoots_take_edits_and_every_plant_has_levels_of_detail() {
    let f = folder("shape-flowers");
    let json = |args: &[&str]| -> Value {
        serde_json::from_str(&good(&f, &[args, &["--json", "--quiet"]].concat())).unwrap()
    };
    let edits = |name: &str, op: &str| {
        fs::write(f.join(name), format!(r#"{{"schema": "burgeon.edits/1", "edits": [{op}]}}"#)).unwrap();
    };
    edits(
        "lean.json",
        r#"{"op": "rotate", "axis": {"path": [0]}, "turn": {"about": [0, 0, 1], "degrees": 20}}"#,
    );
    edits("none.json", r#"{"op": "prune", "axis": {"path": [0, 999]}}"#);
    let triangles = |item: &Value| item["counts"]["triangles"].as_u64().unwrap();
    let leaf = |k: u32| format!("{}/../../fixtures/leaves/leaf{k}.csv", env!("CARGO_MANIFEST_DIR"));
    let (one, three) = (leaf(1), leaf(3));
    let drawing = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/sketches/table1/a.svg");
    let plants: [(&str, &[&str], u64); 4] = [
        ("rose.glb", &["shape", "rose"], 2),
        ("lily.glb", &["bloom", "run", "lily", "--day", "5"], 1),
        ("shoot.glb", &["leaf", &one, &three, "--plant", "--leaves", "6"], 2),
        ("drawn.glb", &["shape", drawing, "--save", "drawn.burgeon"], 2),
    ];
    for (out, command, levels) in plants {
        let made = |more: &[&str]| json(&[command, &["-o", out], more].concat());
        let lods = levels.to_string();
        let leant = made(&["--edits", "lean.json", "--lods", &lods]);
        let item = &leant["items"][0];
        assert_eq!(item["edits"][0]["done"], true, "{out}: {item}");
        let mut before = 0;
        for level in 0..=levels {
            let name = if level == 0 { out.into() } else { out.replace(".glb", &format!("-lod{level}.glb")) };
            let info = json(&["info", &name]);
            let now = info["model"]["triangles"].as_u64().unwrap();
            assert!(level == 0 || now < before * 3 / 4, "{name}: {now} after {before}");
            before = now;
        }
        if command[0] != "shape" {
            assert_ne!(made(&[])["items"][0]["digest"], item["digest"], "{out}");
        } else {
            assert_eq!(
                triangles(&leant["items"][1]),
                json(&["info", &out.replace(".glb", "-lod1.glb")])["model"]["triangles"]
            );
        }
        let failed = bad(&f, &[command, &["-o", "never.glb", "--edits", "none.json"]].concat());
        assert!(failed.contains("none.json") && failed.contains("its edit could not be done"), "{failed}");
    }
    assert!(!f.join("never.glb").exists());
    // The same edit on every day: an opening flower still has one set of triangles.
    json(&["bloom", "run", "rose", "--edits", "lean.json", "--frames", "3", "-o", "opening.glb"]);
    // A drawing becomes a project with the edit.
    let again = json(&["shape", "drawn.burgeon", "--list"]);
    assert_eq!(again["items"][0]["edits"][0]["done"], true);
}
