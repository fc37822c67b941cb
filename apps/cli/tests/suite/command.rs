//! The built binary as other programs call it.

use crate::tools;
use std::fs;
use std::path::Path;

use serde_json::Value;
use tools::{FLOWER, bad, burgeon, folder, good, json, names, status};

/// Three drawings, one broken line and one empty drawing.
const BATCH: &str = concat!(
    r#"{"word":"flower","key_id":"1","drawing":[[[10,12,11],[200,120,20]],[[11,40,60,40,12],[120,80,90,120,121]]]}"#,
    "\n",
    r#"{"word":"flower","key_id":"2","drawing":[[[100,98,101],[250,120,10]]]}"#,
    "\nthis is no drawing\n",
    r#"{"word":"a/b: c","key_id":"3","drawing":[[[0,3,9],[0,50,120]]]}"#,
    "\n",
    r#"{"word":"nothing","key_id":"4","drawing":[]}"#,
    "\n"
);

#[test]
fn sketch_writes_model_picture_and_report() {
    let dir = folder("sketch");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    let args = ["sketch", "rose.svg", "-o", "rose.glb", "--png", "rose.png", "--size", "80x60"];
    let said = good(&dir, &[&args[..], &["--report", "rose.json"]].concat());
    assert!(said.starts_with("rose.glb, rose.png: ") && said.lines().count() == 1, "{said}");
    assert_eq!(names(&dir), ["rose.glb", "rose.json", "rose.png", "rose.svg"]);
    assert!(fs::read(dir.join("rose.glb")).unwrap().starts_with(b"glTF"));
    let png = fs::read(dir.join("rose.png")).unwrap();
    assert_eq!((&png[1..4], &png[16..24]), (&b"PNG"[..], &[0, 0, 0, 80, 0, 0, 0, 60][..]));

    let report = json(&dir.join("rose.json"));
    assert_eq!(report["schema"], "burgeon.report/1");
    assert_eq!((&report["command"], &report["seed"]), (&"sketch".into(), &1.into()));
    assert!(report["version"].is_string());
    assert_eq!(
        report["input"],
        serde_json::json!({"path": "rose.svg", "drawings": 1, "strokes": 8, "offset_m": null, "coordinate_system": null})
    );
    assert_eq!((&report["ok"], &report["failed"]), (&1.into(), &0.into()));
    let item = &report["items"][0];
    assert_eq!(item["output"], "rose.glb");
    let strokes = item["strokes"].as_array().unwrap();
    assert_eq!(strokes.len(), 8);
    for stroke in strokes {
        assert!(stroke["index"].is_u64() && stroke["class"].is_string() && stroke["organ"].is_string());
        assert!((0.0..=1.0).contains(&stroke["confidence"].as_f64().unwrap()), "{stroke}");
        assert!(
            stroke["source"] == "classifier" || stroke["source"].as_str().unwrap().starts_with("rule:"),
            "{stroke}"
        );
    }
    for key in ["flowers", "petals", "leaves", "branches", "nodes", "axes", "vertices", "triangles"] {
        assert!(item["counts"][key].is_u64(), "{key}");
    }
    assert!(item["counts"]["triangles"].as_u64().unwrap() > 100);
    let stages = ["preprocess", "classify", "structure", "depth", "fidelity", "mesh", "measure"];
    for key in ["read", "write", "picture", "total"].iter().chain(&stages) {
        assert!(item["timings_ms"][key].as_f64().unwrap() >= 0.0, "{key}");
    }
    for key in ["reprojection_mean", "reprojection_p95", "excess_mean", "excess_p95", "compared"] {
        assert!(item["fidelity"][key].is_f64(), "{key}");
    }
    assert!(item["fidelity"]["overlap"].is_null(), "nothing grows in a contour");
    assert!(item["digest"].as_str().unwrap().chars().all(|c| c.is_ascii_hexdigit()));
    assert!(item["warnings"].is_array());
}

#[test]
fn sketch_writes_the_structure_and_measures_it() {
    let dir = folder("structure");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    let args = ["sketch", "rose.svg", "-o", "rose.mtg", "--qsm", "rose.csv", "--report", "rose.json"];
    good(&dir, &args);
    let mtg = fs::read_to_string(dir.join("rose.mtg")).unwrap();
    assert!(mtg.contains("metres and Z upwards") && mtg.contains("\n/P1\n\t/A1\t"), "{mtg}");
    let petals = mtg.lines().filter(|l| l.trim_start().starts_with("+K")).count() as u64;
    let report = json(&dir.join("rose.json"));
    let item = &report["items"][0];
    assert_eq!(item["counts"]["petals"], petals);
    let csv = fs::read_to_string(dir.join("rose.csv")).unwrap();
    let rows: Vec<Vec<f64>> =
        csv.lines().skip(1).map(|l| l.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    let plant = &item["plant"];
    let number = |key: &str| plant[key].as_f64().unwrap();
    let length: f64 = rows.iter().map(|r| r[1]).sum();
    assert!(rows.len() > 3 && (length - number("length_m")).abs() < 1e-4, "{plant}");
    // The stem of a flower stands upright: +Z in this file.
    assert!(rows[0][7] > 0.5 && rows[0][8] == 0.0, "{:?}", rows[0]);
    assert!(number("height_m") > 0.3 && number("wood_volume_m3") > 0.0 && number("leaf_area_m2") > 0.0);
    assert!(plant["dbh_m"].is_null(), "a rose is no tree");
    assert_eq!(plant["strahler"]["streams"].as_array().unwrap().len() as u64, plant["strahler"]["order"]);
    good(&dir, &["sketch", "rose.svg", "-o", "y.mtg", "--up", "y", "--unit", "mm"]);
    assert!(fs::read_to_string(dir.join("y.mtg")).unwrap().contains("millimetres and Y upwards"));
    fs::write(dir.join("many.ndjson"), BATCH).unwrap();
    let args = ["sketch", "many.ndjson", "-o", "out", "--format", "mtg", "--qsm", "tables/"];
    assert_eq!(status(&burgeon(&dir, &args)), 2, "two of the drawings are none");
    assert_eq!(names(&dir.join("out")).len(), 3);
    assert_eq!(names(&dir.join("tables")).len(), 3);
    let said = bad(&dir, &["sketch", "rose.svg", "-o", "a.glb", "--qsm", "tables/"]);
    assert!(said.contains("give two files or two folders"), "{said}");
}

#[test]
fn report_goes_to_stdout_alone() {
    let dir = folder("json");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    let said = good(&dir, &["sketch", "rose.svg", "--json"]);
    let report: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(report["items"][0]["output"], "");
    assert_eq!(names(&dir), ["rose.svg"], "nothing is written without -o");
    assert_eq!(good(&dir, &["sketch", "rose.svg", "-o", "rose.glb", "--quiet"]), "");
}

#[test]
fn threads_change_nothing() {
    let dir = folder("threads");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    fs::write(dir.join("many.ndjson"), BATCH).unwrap();
    let mut seen = Vec::new();
    for threads in ["1", "4"] {
        let one = format!("rose-{threads}.glb");
        let picture = format!("rose-{threads}.png");
        let args =
            ["sketch", "rose.svg", "-o", &one, "--png", &picture, "--size", "90x70", "--threads", threads];
        good(&dir, &args);
        let many = format!("many-{threads}");
        let report = format!("many-{threads}.json");
        let out =
            burgeon(&dir, &["sketch", "many.ndjson", "-o", &many, "--threads", threads, "--report", &report]);
        assert_eq!(status(&out), 2);
        let report = json(&dir.join(report));
        let digests: Vec<Value> = report["items"]
            .as_array()
            .unwrap()
            .iter()
            .map(|i| serde_json::json!([i["name"], i["digest"]]))
            .collect();
        let files: Vec<(String, Vec<u8>)> = names(&dir.join(&many))
            .into_iter()
            .map(|n| (n.clone(), fs::read(dir.join(&many).join(n)).unwrap()))
            .collect();
        seen.push((
            fs::read(dir.join(one)).unwrap(),
            fs::read(dir.join(picture)).unwrap(),
            digests,
            files,
            report["warnings"].clone(),
        ));
    }
    assert!(seen[0] == seen[1], "1 and 4 threads differ");
}

#[test]
fn batch_goes_on_past_bad_drawings() {
    let dir = folder("batch");
    fs::write(dir.join("many.ndjson"), BATCH).unwrap();
    let out = burgeon(&dir, &["sketch", "many.ndjson", "-o", "out/deep", "--report", "r.json"]);
    let errors = String::from_utf8(out.stderr.clone()).unwrap();
    assert_eq!(status(&out), 2, "{errors}");
    let report = json(&dir.join("r.json"));
    assert_eq!((&report["ok"], &report["failed"]), (&3.into(), &2.into()), "{report:#}");
    let warnings: Vec<&str> =
        report["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()).collect();
    assert_eq!(warnings.len(), 2);
    assert!(warnings[0].contains("many.ndjson") && warnings[0].contains("line 3"), "{warnings:?}");
    assert!(errors.contains("line 3"), "{errors}");
    let files = names(&dir.join("out/deep"));
    assert_eq!(files.len(), 3, "{files:?}");
    for (item, file) in report["items"].as_array().unwrap().iter().map(|i| (i, i["output"].as_str().unwrap()))
    {
        assert!(dir.join(file).is_file(), "{item}");
        assert!(Path::new(file).parent() == Some(Path::new("out/deep")), "{file} is outside");
    }
    let out = burgeon(&dir, &["sketch", "many.ndjson", "-o", "obj", "--format", "obj", "--no-textures"]);
    assert_eq!(status(&out), 2);
    assert_eq!(names(&dir.join("obj")).iter().filter(|n| n.ends_with(".obj")).count(), 3);
}

#[test]
fn several_drawings_need_a_folder() {
    let dir = folder("several");
    fs::write(dir.join("many.ndjson"), BATCH).unwrap();
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    let line = bad(&dir, &["sketch", "many.ndjson", "-o", "one.glb"]);
    assert!(line.contains("several drawings") && line.contains("-o FOLDER"), "{line}");
    assert_eq!(names(&dir), ["many.ndjson", "rose.svg"]);
    good(&dir, &["sketch", "rose.svg", "rose.svg", "-o", "both", "--quiet"]);
    assert_eq!(names(&dir.join("both")), ["rose-2.glb", "rose.glb"]);
}

#[test]
fn bad_input_is_told_in_one_line_and_leaves_nothing() {
    let dir = folder("bad");
    fs::write(dir.join("empty.svg"), "").unwrap();
    fs::write(dir.join("cut.svg"), &FLOWER[..300]).unwrap();
    fs::write(dir.join("dot.json"), r#"{"burgeon":"drawing/1","name":"dot","strokes":[{"points":[[1,1]]}]}"#)
        .unwrap();
    fs::write(dir.join("noise.glb"), b"glTF but not really").unwrap();
    fs::write(dir.join("what.xyz"), "hello").unwrap();
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    fs::write(dir.join("wrong.csv"), "0,blade\n1,petall\n").unwrap();
    fs::write(dir.join("far.csv"), "99,axis\n").unwrap();
    fs::create_dir(dir.join("folder.glb")).unwrap();
    let before = names(&dir);
    for (args, parts) in [
        (&["sketch", "missing.svg", "-o", "x.glb"][..], &["missing.svg", "no such file"][..]),
        (&["sketch", "empty.svg", "-o", "x.glb"], &["empty.svg", "empty"]),
        (&["sketch", "cut.svg", "-o", "x.glb"], &["cut.svg", "SVG"]),
        (&["sketch", "dot.json", "-o", "x.glb"], &["dot.json", "at least one line"]),
        (&["sketch", "what.xyz", "-o", "x.glb"], &["what.xyz", ".svg"]),
        (&["sketch", "noise.glb", "-o", "x.glb"], &["noise.glb", "not a drawing"]),
        (&["sketch", "rose.svg", "-o", "no/where/x.glb"], &["no/where", "does not exist"]),
        (&["sketch", "rose.svg", "-o", "x.dae"], &["x.dae", ".glb"]),
        (
            &["sketch", "rose.svg", "-o", "x.glb", "--classes", "wrong.csv"],
            &["wrong.csv", "line 2", "petall"],
        ),
        (&["sketch", "rose.svg", "-o", "x.glb", "--classes", "far.csv"], &["rose.svg", "stroke 99"]),
        (&["sketch", "rose.svg", "-o", "x.glb", "--report", "no/r.json"], &["no/r.json", "does not exist"]),
        (&["sketch", "rose.svg"], &["--output"]),
        (&["sketch", "rose.svg", "-o", "x.glb", "--detail", "99"], &["--detail", "0.1 to 8"]),
        (&["sketch", "rose.svg", "-o", "x.glb", "--size", "9000x1"], &["--size", "8192"]),
        (&["sketch", "rose.svg", "-o", "x.glb", "--threads", "0"], &["--threads", "1..=256"]),
        (&["render", "noise.glb", "-o", "x.png"], &["noise.glb"]),
        (&["render", "rose.svg", "-o", "x.png"], &["rose.svg", "burgeon sketch"]),
        (&["render", "noise.glb", "-o", "x.jpg"], &["x.jpg", ".png"]),
        (&["convert", "rose.svg", "-o", "x.glb"], &["rose.svg", "burgeon sketch"]),
        (&["convert", "noise.glb", "-o", "x.docx"], &["x.docx", ".glb"]),
        (&["info", "what.xyz"], &["what.xyz", "no point"]),
        (&["info", "folder.glb"], &["folder.glb", "is a folder"]),
        (&["wood", "x"], &["wood"]),
    ] {
        let line = bad(&dir, args);
        assert!(parts.iter().all(|p| line.contains(p)), "{args:?} said {line:?} without {parts:?}");
        assert_eq!(names(&dir), before, "{args:?} left something");
    }
}

#[test]
fn failed_write_keeps_the_old_file() {
    let dir = folder("keep");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    fs::write(dir.join("cut.svg"), &FLOWER[..300]).unwrap();
    fs::write(dir.join("x.glb"), "the old one").unwrap();
    bad(&dir, &["sketch", "cut.svg", "-o", "x.glb"]);
    assert_eq!(fs::read_to_string(dir.join("x.glb")).unwrap(), "the old one");
    good(&dir, &["sketch", "rose.svg", "-o", "x.glb"]);
    assert!(fs::read(dir.join("x.glb")).unwrap().starts_with(b"glTF"));
    assert_eq!(names(&dir), ["cut.svg", "rose.svg", "x.glb"]);
}

#[test]
fn classes_can_be_corrected_in_the_report() {
    let dir = folder("classes");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    good(&dir, &["sketch", "rose.svg", "--report", "r.json"]);
    let mut report = json(&dir.join("r.json"));
    report["items"][0]["strokes"][1]["class"] = "scribble".into();
    fs::write(dir.join("r.json"), report.to_string()).unwrap();
    let said = good(&dir, &["sketch", "rose.svg", "--classes", "r.json", "--json"]);
    let again: Value = serde_json::from_str(&said).unwrap();
    let strokes = &again["items"][0]["strokes"];
    assert_eq!((&strokes[1]["class"], &strokes[1]["confidence"]), (&"scribble".into(), &1.0.into()));
    assert_eq!(strokes[1]["source"], "user");
    assert_ne!(again["items"][0]["digest"], report["items"][0]["digest"]);
}

#[test]
fn usd_stands_with_its_textures_and_is_not_read() {
    let dir = folder("usd");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    good(&dir, &["sketch", "rose.svg", "-o", "a rose.usda", "--up", "z", "--unit", "cm", "-q"]);
    let text = fs::read_to_string(dir.join("a rose.usda")).unwrap();
    assert!(text.contains("metersPerUnit = 0.01\n    upAxis = \"Z\""), "{}", &text[..400]);
    let named: Vec<&str> = text.split("@./").skip(1).filter_map(|t| t.split('@').next()).collect();
    let there = names(&dir);
    assert!(!named.is_empty() && named.iter().all(|n| there.contains(&(*n).into())), "{named:?} {there:?}");
    assert!(!there.iter().any(|n| n.starts_with(".burgeon-")), "{there:?}");
    let told = bad(&dir, &["info", "a rose.usda"]);
    assert!(told.contains("reading USD is not supported"), "{told}");
    let told = bad(&dir, &["convert", "a rose.usda", "-o", "rose.glb"]);
    assert!(told.contains("reading USD is not supported"), "{told}");
}

#[test]
fn models_convert_render_and_explain_themselves() {
    let dir = folder("models");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    good(&dir, &["sketch", "rose.svg", "-o", "rose.glb", "-q"]);
    good(&dir, &["convert", "rose.glb", "-o", "rose.obj"]);
    assert!(names(&dir).contains(&"rose.mtl".into()), "{:?}", names(&dir));
    good(&dir, &["convert", "rose.obj", "-o", "back.glb"]);
    good(&dir, &["convert", "rose.glb", "-o", "rose.ply", "--up", "z", "--unit", "mm"]);
    good(&dir, &["convert", "rose.svg", "-o", "drawing.json"]);
    let info = |args: &[&str]| -> Value {
        serde_json::from_str(&good(&dir, &[&["info", "--json"][..], args].concat())).unwrap()
    };
    let (first, back) = (info(&["rose.glb"]), info(&["back.glb"]));
    let ply = info(&["rose.ply", "--up", "z", "--unit", "mm"]);
    let size = |v: &Value, k: usize| v["model"]["size"][k].as_f64().unwrap();
    for other in [&back, &ply] {
        assert_eq!(first["model"]["triangles"], other["model"]["triangles"]);
        for k in 0..3 {
            assert!((size(&first, k) - size(other, k)).abs() < 1e-4, "{first:#} {other:#}");
        }
    }
    let raw = info(&["rose.ply"]);
    assert!((size(&raw, 2) - 1000.0 * size(&first, 1)).abs() < 0.1, "z is up, in millimetres: {raw:#}");
    assert_eq!(info(&["drawing.json"])["drawings"]["strokes"], 8);
    let text = good(&dir, &["info", "rose.glb"]);
    assert!(text.contains("m high (y)") && text.contains("material"), "{text}");
    for (view, name) in [("front", "a.png"), ("turntable", "b.png")] {
        let args =
            ["render", "rose.glb", "-o", name, "--view", view, "--size", "120x90", "--background", "#e8f0e0"];
        good(&dir, &args);
        assert!(fs::read(dir.join(name)).unwrap().starts_with(b"\x89PNG"));
    }
}

#[test]
fn help_documents_every_option() {
    let dir = folder("help");
    for command in ["sketch", "render", "convert", "info"] {
        let text = good(&dir, &[command, "--help"]);
        for block in text.split("\n\n").filter(|b| b.trim_start().starts_with('-')) {
            let mut lines = block.lines().filter(|l| !l.trim_start().starts_with('-'));
            assert!(lines.any(|l| l.trim().len() > 8), "{command}: {block:?} is not explained");
        }
    }
    assert!(good(&dir, &["--version"]).starts_with("burgeon "));
}

#[test]
fn own_fixtures_make_plants() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/sketches/sample.svg");
    let dir = folder("fixtures");
    let report: Value =
        serde_json::from_str(&good(&dir, &["sketch", sample.to_str().unwrap(), "--json"])).unwrap();
    let Some(item) = report["items"].get(0) else { panic!("{report:#}") };
    assert!(item["counts"]["petals"].as_u64().unwrap() > 3, "{item:#}");
    assert!(item["counts"]["leaves"].as_u64().unwrap() >= 1, "{item:#}");
}

/// Table 1 of He and Cheng (2021): drawings of the same composition give models of the same composition.
#[test]
fn the_eight_sketches_of_table_1_have_the_papers_counts() {
    // Strokes, leaves and petals, branches, triangles.
    const PAPER: [(&str, [u64; 4]); 8] = [
        ("a", [15, 0, 56, 29_888]),
        ("b", [7, 6, 1, 5_132]),
        ("c", [13, 34, 7, 20_558]),
        ("d", [22, 19, 3, 11_972]),
        ("e", [31, 27, 4, 10_464]),
        ("f", [27, 16, 21, 13_360]),
        ("g", [31, 142, 22, 67_918]),
        ("h", [25, 126, 13, 37_528]),
    ];
    let dir = folder("table1");
    for (name, [strokes, blades, branches, triangles]) in PAPER {
        let drawing =
            Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../fixtures/sketches/table1/{name}.svg"));
        let report: Value =
            serde_json::from_str(&good(&dir, &["sketch", drawing.to_str().unwrap(), "--json"])).unwrap();
        let item = &report["items"][0];
        let count = |key: &str| item["counts"][key].as_u64().unwrap();
        assert_eq!(item["strokes"].as_array().unwrap().len() as u64, strokes, "{name}");
        for (what, ours, paper, percent) in [
            ("leaves and petals", count("leaves") + count("petals"), blades, 5),
            ("branches", count("branches"), branches, 5),
            ("triangles", count("triangles"), triangles, 20),
        ] {
            assert!(
                100 * ours.abs_diff(paper) <= percent * paper,
                "{name}: {ours} {what}, the paper has {paper}"
            );
        }
    }
}

#[test]
fn a_project_brings_its_settings_and_options_win_over_them() {
    let dir = folder("project");
    let fixture = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-1.burgeon");
    fs::copy(fixture, dir.join("sample.burgeon")).unwrap();
    good(&dir, &["sketch", "sample.burgeon", "-o", "a.glb", "--report", "a.json"]);
    let report = json(&dir.join("a.json"));
    assert_eq!((&report["seed"], &report["input"]["strokes"]), (&7.into(), &15.into()));
    assert_eq!(report["items"][0]["strokes"][0]["confidence"], 1.0, "a class that the person set");
    assert!(good(&dir, &["info", "a.glb"]).contains("petal-violet"));
    good(&dir, &["sketch", "sample.burgeon", "-o", "b.glb", "--seed", "8", "--petals", "white"]);
    assert!(good(&dir, &["info", "b.glb"]).contains("petal-white"));
    // The same drawing without the project's settings gives another plant; with them it gives the same.
    good(&dir, &["convert", "sample.burgeon", "-o", "sample.json"]);
    let settings = ["--seed", "7", "--leaf-depth", "signed", "--density", "1.5"];
    good(&dir, &[&["sketch", "sample.json", "-o", "c.glb", "--report", "c.json"], &settings[..]].concat());
    assert_eq!(json(&dir.join("c.json"))["items"][0]["digest"], report["items"][0]["digest"]);
    good(&dir, &["sketch", "sample.json", "-o", "d.glb", "--report", "d.json"]);
    assert_ne!(json(&dir.join("d.json"))["items"][0]["digest"], report["items"][0]["digest"]);
    assert!(good(&dir, &["info", "sample.burgeon"]).contains("15 strokes"));

    let mut bytes = fs::read(fixture).unwrap();
    bytes.truncate(bytes.len() / 2);
    fs::write(dir.join("half.burgeon"), bytes).unwrap();
    assert!(bad(&dir, &["sketch", "half.burgeon", "-o", "e.glb"]).contains("not a whole zip file"));
    assert!(bad(&dir, &["render", "sample.burgeon", "-o", "e.png"]).contains("`burgeon sketch`"));
    assert!(!dir.join("e.glb").exists());
}

#[test]
fn organs_wear_what_a_file_of_materials_says() {
    let dir = folder("materials");
    let drawing = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/sketches/gallery/lily.svg");
    let png = [&b"\x89PNG\r\n\x1a\n"[..], b"not really"].concat();
    fs::write(dir.join("broken.png"), png).unwrap();
    fs::write(dir.join("m.toml"), "[petal]\npattern = \"picotee\"\nroughness = 0.25\n").unwrap();
    good(&dir, &["sketch", drawing, "-o", "a.glb", "--materials", "m.toml"]);
    let info = good(&dir, &["info", "a.glb"]);
    assert!(info.contains("petal-picotee-1") && !info.contains("petal-pink"), "{info}");
    // The picture of a model is also a picture.
    good(&dir, &["sketch", drawing, "--png", "petal.png", "--size", "64x64"]);
    let strokes = "[[strokes]]\nstrokes = [0, 1, 2, 3, 4, 5]\nmaterial = { pattern = \"picture\", picture = \"petal.png\" }\n";
    fs::write(dir.join("s.toml"), strokes).unwrap();
    good(&dir, &["sketch", drawing, "-o", "b.usda", "--materials", "s.toml"]);
    assert!(fs::read_to_string(dir.join("b.usda")).unwrap().contains("picture"));
    fs::write(dir.join("l.json"), r##"{"leaf": {"pattern": "variegated", "color": "#305020"}}"##).unwrap();
    good(&dir, &["leaf", "--venation", "palmate", "-o", "c.glb", "--materials", "l.json"]);
    assert!(good(&dir, &["info", "c.glb"]).contains("leaf-variegated-1"));
    good(&dir, &["bloom", "run", "rose", "--day", "5", "-o", "d.glb", "--materials", "m.toml"]);
    assert!(good(&dir, &["info", "d.glb"]).contains("petal-picotee-1"));
    for (text, words) in [
        ("[petal]\npattern = \"spots\"", "spots"),
        ("[petal]\namount = 3", "petal.amount"),
        ("[petal]\npattern = \"picture\"", "without a picture"),
        ("[petal]\npicture = \"petal.png\"", "pattern = \"picture\""),
        ("[petal]\npattern = \"picture\"\npicture = \"broken.png\"", "no PNG or JPEG"),
        ("[petal]\npattern = \"picture\"\npicture = \"none.png\"", "none.png"),
    ] {
        fs::write(dir.join("x.toml"), text).unwrap();
        let said = bad(&dir, &["sketch", drawing, "-o", "x.glb", "--materials", "x.toml"]);
        assert!(said.contains(words), "{said}");
    }
}

/// Drawings whose strokes are understood only together: a smooth crown on a trunk, a pot, fronds, a rosette.
#[test]
fn the_gallery_is_understood() {
    // Least and most numbers of flowers, petals, leaves, branches.
    const KNOWN: [(&str, [(u64, u64); 4]); 9] = [
        ("apple-tree", [(0, 0), (0, 0), (300, 12_000), (50, 1_200)]),
        ("cactus", [(0, 0), (0, 0), (0, 0), (3, 3)]),
        ("dandelion", [(1, 1), (9, 16), (4, 4), (1, 9)]),
        ("grass", [(0, 0), (0, 0), (0, 9), (0, 9)]),
        ("house-plant", [(0, 0), (0, 0), (5, 5), (5, 8)]),
        ("maple", [(0, 0), (0, 0), (1, 1), (0, 1)]),
        ("palm", [(0, 0), (0, 0), (8, 8), (1, 1)]),
        ("pine", [(0, 0), (0, 0), (300, 12_000), (50, 1_200)]),
        ("poplar", [(0, 0), (0, 0), (300, 12_000), (50, 1_200)]),
    ];
    let dir = folder("gallery");
    for (name, ranges) in KNOWN {
        let drawing =
            Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../fixtures/sketches/gallery/{name}.svg"));
        let report: Value =
            serde_json::from_str(&good(&dir, &["sketch", drawing.to_str().unwrap(), "--json"])).unwrap();
        let counts = &report["items"][0]["counts"];
        for (what, (least, most)) in ["flowers", "petals", "leaves", "branches"].iter().zip(ranges) {
            let n = counts[what].as_u64().unwrap();
            assert!((least..=most).contains(&n), "{name}: {n} {what}");
        }
    }
}

#[test]
fn a_scene_is_made_whole() {
    let dir = folder("scene");
    let fixture = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/projects/version-3.burgeon");
    fs::copy(fixture, dir.join("garden.burgeon")).unwrap();
    good(
        &dir,
        &["sketch", "garden.burgeon", "-o", "garden.glb", "--report", "r.json", "--png", "garden.png"],
    );
    let report = json(&dir.join("r.json"));
    let items = report["items"].as_array().unwrap();
    let names: Vec<&str> = items.iter().filter_map(|i| i["name"].as_str()).collect();
    assert_eq!(names, ["drawn", "bush", "lily"], "the hidden leaf is left out");
    assert!(items.iter().all(|i| i["digest"].as_str().is_some_and(|d| d.len() > 8)), "{items:?}");
    assert!(items[1]["growth"]["nodes"].as_u64().unwrap() > 50);
    let whole = fs::read(dir.join("garden.glb")).unwrap();
    let whole = String::from_utf8_lossy(&whole);
    for plant in ["drawn", "bush", "lily"] {
        assert!(whole.contains(&format!(r#""name":"{plant}""#)), "a node for {plant}");
    }
    let info = good(&dir, &["info", "garden.burgeon"]);
    assert!(info.contains("bush: tree, seed 3") && info.contains("15 strokes"), "{info}");
    assert!(bad(&dir, &["convert", "garden.burgeon", "-o", "x.json"]).contains("scene of 4 plants"));
    assert!(bad(&dir, &["sketch", "garden.burgeon", "-o", "x.mtg"]).contains("several plants"));
    assert!(
        bad(&dir, &["sketch", "garden.burgeon", "-o", "x.glb", "--seed", "2"]).contains("their own settings")
    );
}

#[test]
fn shells_complete_every_command_and_each_has_its_manual_page() {
    let folder = folder("manual");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let out = burgeon(&folder, &["completions", shell]);
        let script = String::from_utf8_lossy(&out.stdout).into_owned();
        assert!(out.status.success(), "{shell}");
        for word in ["sketch", "completions", "no-textures"] {
            assert!(script.contains(word), "{shell} does not know {word}");
        }
    }
    let out = burgeon(&folder, &["completions", "csh"]);
    assert_eq!(out.status.code(), Some(2), "csh is no shell that is known");
    assert!(burgeon(&folder, &["man", "pages"]).status.success(), "pages");
    let page = |name: &str| fs::read_to_string(folder.join("pages").join(name)).unwrap();
    assert!(page("burgeon.1").contains("burgeon\\-sketch"), "the first page names the others");
    assert!(
        page("burgeon-sketch.1").contains(r"\-\-no\-textures"),
        "options stand on the page of their command"
    );
    assert!(page("burgeon-bloom-fit.1").starts_with(".ie"), "a page of groff");
}
