//! `burgeon leaf` as other programs call it.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::missing;
use crate::tools;
use std::fs;
use std::path::Path;

use serde_json::Value;
use tools::{bad, burgeon, folder, good};

fn fixture(name: &str) -> String {
    format!("{}/../../fixtures/leaves/{name}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn report_has_the_counts_of_table_1() {
    let at = folder("leaf-table");
    let want = [("leaf1.csv", [3610, 3500, 1581, 1500]), ("leaf2.csv", [6130, 5950, 2666, 2550])];
    for (name, counts) in want {
        let text = good(&at, &["leaf", &fixture(name), "-o", "leaf.glb", "--json", "--texture", "plain"]);
        let report: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(report["command"], "leaf");
        let leaf = &report["items"][0]["leaf"];
        let n = |a: &str, b: &str| leaf[a][b].as_u64().unwrap();
        let got = [n("veins", "vertices"), n("veins", "faces"), n("blade", "vertices"), n("blade", "faces")];
        assert_eq!(got, counts);
        assert!(leaf["vein_gap_mm"].as_f64().unwrap() < 1e-6);
        assert_eq!(&fs::read(at.join("leaf.glb")).unwrap()[..4], b"glTF");
    }
}

#[test]
fn template_asks_for_what_is_missing() {
    let at = folder("leaf-template");
    let text = good(&at, &["leaf", "--template", "--rows", "3"]);
    assert!(text.contains("row,mark,x,y,z,thickness,midrib") && text.contains("3,7,,,,,"), "{text}");
    good(&at, &["leaf", "--template", "-o", "marks.csv"]);
    let error = bad(&at, &["leaf", "marks.csv", "-o", "leaf.glb"]);
    assert!(error.contains("marks.csv") && error.contains("x is missing"), "{error}");
    assert!(!at.join("leaf.glb").exists());
}

#[test]
fn growth_pose_and_plant_are_made() {
    let at = folder("leaf-more");
    let (a, b) = (fixture("leaf2.csv"), fixture("leaf1.csv"));
    good(&at, &["leaf", &a, &b, "--days", "5,9", "--day", "7", "-o", "seven.obj", "--texture", "plain"]);
    good(
        &at,
        &["leaf", &b, "--curl", "0.3", "--wilt", "1", "-o", "limp.stl", "--rings", "envelope", "--caps"],
    );
    let plant = ["leaf", &b, &a, "--plant", "--leaves", "5", "-o", "p.glb", "--json", "--subdivisions", "2"];
    let report: Value = serde_json::from_str(&good(&at, &plant)).unwrap();
    assert_eq!(report["items"][0]["counts"]["leaves"], 5);
    let error = bad(&at, &["leaf", &a, &b, "--days", "5,9", "--day", "12", "-o", "x.glb"]);
    assert!(error.contains("day 12 is outside"), "{error}");
    let error = bad(&at, &["leaf", &a, &b, "--days", "9,5", "--day", "7", "-o", "x.glb"]);
    assert!(error.contains("order"), "{error}");
    let error = bad(&at, &["leaf", &a, &b, "-o", "x.glb"]);
    assert!(error.contains("--plant"), "{error}");
    assert!(bad(&at, &["leaf"]).contains("--template"));
    assert!(bad(&at, &["leaf", "none.csv", "-o", "x.glb"]).contains("none.csv"));
}

/// Uses a pinnate leaf as a vein graph in pixels: midrib, six pairs of side veins.
#[test]
fn control_balls_are_moved_and_told_where_there_are_none() {
    let at = folder("leaf-balls");
    let leaf = fixture("leaf1.csv");
    let length = |args: &[&str]| {
        let text =
            good(&at, &[&["leaf", &leaf, "-o", "leaf.glb", "--json", "--marks", "m.csv"], args].concat());
        let report: Value = serde_json::from_str(&text).unwrap();
        report["items"][0]["leaf"]["length_mm"].as_f64().unwrap()
    };
    let plain = length(&[]);
    // The tip continues for 50 mm in the direction of the whole leaf: its end hangs.
    let longer = length(&["--ball", "0,1,0,0.05,0", "--surface", "nurbs"]);
    assert!(longer > plain + 20.0 && longer <= plain + 50.0, "{plain} {longer}");
    let marks = fs::read_to_string(at.join("m.csv")).unwrap();
    // The moved marks are written.
    good(&at, &["leaf", "m.csv", "-o", "again.glb"]);
    assert!(marks.contains("tip"), "{marks}");
    assert!((length(&["--ball=0,1,0,0.03,0", "--ball=0,1,0,0.02,0"]) - longer).abs() < 1e-9, "moves add up");
    let none = bad(&at, &["leaf", &leaf, "-o", "x.glb", "--ball", "11,1,0,0,0.1"]);
    assert!(none.contains("no control ball 1 in row 11"), "{none}");
    for (ball, why) in
        [("1,1,0,0", "is not ROW,MARK"), ("1,1,0,0,99", "must be -10 to 10"), ("1,1,0,0,0,99", "0.05 to 20")]
    {
        let error = bad(&at, &["leaf", &leaf, "-o", "x.glb", "--ball", ball]);
        assert!(error.contains(why), "{error}");
    }
}

fn vein_graph() -> String {
    let (mut nodes, mut edges) = (Vec::new(), Vec::new());
    for k in 0..=50 {
        nodes.push(format!("[100, {}, {}]", 600 - 10 * k, 6.0 - 0.08 * f64::from(k)));
        edges.extend((k > 0).then(|| format!("[{}, {k}]", k - 1)));
    }
    for pair in 0..6_u32 {
        let foot = 3 + 7 * pair;
        for side in [-1.0, 1.0] {
            let mut last = foot as usize;
            for i in 1..=8 {
                let t = f64::from(i) * (14.0 - 1.5 * f64::from(pair));
                let y = 600.0 - 10.0 * f64::from(foot) - 0.6 * t;
                nodes.push(format!("[{}, {y}, 2.0]", 100.0 + side * t));
                edges.push(format!("[{last}, {}]", nodes.len() - 1));
                last = nodes.len() - 1;
            }
        }
    }
    format!(r#"{{"unit": "pixel", "nodes_xyr": [{}], "edges": [{}]}}"#, nodes.join(","), edges.join(","))
}

#[test]
fn vein_graph_becomes_a_leaf_as_long_as_was_said() {
    let at = folder("leaf-graph");
    fs::write(at.join("veins.json"), vein_graph()).unwrap();
    let args = [
        "leaf",
        "veins.json",
        "--length",
        "0.06",
        "-o",
        "v.glb",
        "--marks",
        "m.csv",
        "--json",
        "--texture",
        "plain",
    ];
    let report: Value = serde_json::from_str(&good(&at, &args)).unwrap();
    let leaf = &report["items"][0]["leaf"];
    assert_eq!(leaf["rows"], 7, "{leaf}");
    assert!((leaf["length_mm"].as_f64().unwrap() - 60.0).abs() < 1e-6, "{leaf}");
    assert!(leaf["vein_gap_mm"].as_f64().unwrap() < 1e-6, "{leaf}");
    // The marks found give the same leaf again.
    let again: Value =
        serde_json::from_str(&good(&at, &["leaf", "m.csv", "--json", "--texture", "plain"])).unwrap();
    assert_eq!(again["items"][0]["leaf"]["rows"], 7);

    for (name, text, want) in [
        ("no.json", "{}".to_owned(), "nodes_xyr"),
        ("edge.json", vein_graph().replace("[0, 1]", "[0, 99999]"), "99999"),
        ("thin.json", vein_graph().replacen("600, 6]", "600, 0]", 1), "radius"),
        ("unit.json", vein_graph().replace("pixel", "mile"), "a unit is m, cm, mm or pixel"),
        ("cut.json", vein_graph()[..400].to_owned(), "line 1"),
    ] {
        fs::write(at.join(name), text).unwrap();
        let error = bad(&at, &["leaf", name, "-o", "x.glb"]);
        assert!(error.contains(name) && error.contains(want), "{error}");
    }
    assert!(!at.join("x.glb").exists());
}

#[test]
fn any_leaf_becomes_the_leaf_of_a_sketched_plant() {
    let at = folder("leaf-on-plant");
    let drawing = format!("{}/../../fixtures/sketches/gallery/house-plant.svg", env!("CARGO_MANIFEST_DIR"));
    fs::write(at.join("veins.json"), vein_graph()).unwrap();
    good(&at, &["leaf", &fixture("leaf1.csv"), "-o", "leaf.glb"]);
    let digest = |template: Option<&str>| {
        let mut args = vec!["sketch", drawing.as_str(), "-o", "plant.glb", "--json"];
        args.extend(template.iter().flat_map(|t| ["--leaf-template", t]));
        let report: Value = serde_json::from_str(&good(&at, &args)).unwrap();
        let item = &report["items"][0];
        (item["digest"].as_str().unwrap().to_owned(), item["counts"]["leaves"].as_u64().unwrap())
    };
    let (plain, leaves) = digest(None);
    let mut seen = vec![plain];
    for template in [fixture("leaf1.csv"), "leaf.glb".into(), "veins.json".into()] {
        let (digest, count) = digest(Some(&template));
        assert_eq!(count, leaves, "{template}");
        assert!(!seen.contains(&digest), "{template}: another leaf makes another plant");
        seen.push(digest);
    }
    let error = bad(&at, &["sketch", &drawing, "-o", "x.glb", "--leaf-template", &drawing]);
    assert!(error.contains("house-plant.svg"), "{error}");
    let error = bad(&at, &["sketch", &drawing, "-o", "x.glb", "--leaf-template", "none.csv"]);
    assert!(error.contains("none.csv"), "{error}");
}

#[test]
fn wrong_marks_are_told_with_their_place() {
    let at = folder("leaf-bad");
    let whole = fs::read_to_string(fixture("leaf1.csv")).unwrap();
    let line = |start: &str| whole.lines().find(|l| l.starts_with(start)).unwrap().to_owned();
    let (tip, mark) = (line("tip,"), line("3,4,"));
    let mut fields: Vec<&str> = mark.split(',').collect();
    fields[5] = "0";
    let zero = fields.join(",");
    fields[5] = "-0.4";
    let negative = fields.join(",");
    fields[2] = "NaN";
    let nan = fields.join(",");
    for (name, text, want) in [
        ("missing.csv", whole.replace(&format!("{mark}\n"), ""), "row 3 has 6 of 7 marks: mark 4 is missing"),
        ("tips.csv", format!("{whole}{tip}\n"), "the tip is given twice"),
        ("zero.csv", whole.replace(&mark, &zero), "must be above 0"),
        ("negative.csv", whole.replace(&mark, &negative), "must be above 0"),
        ("nan.csv", whole.replace(&mark, &nan), "no finite number"),
        ("short.csv", whole.replace(&mark, "3,4,1.0,2.0"), "z is missing"),
        ("twice.csv", format!("{whole}{mark}\n"), "row 3, mark 4 is given twice"),
        ("empty.csv", String::new(), "empty"),
    ] {
        fs::write(at.join(name), text).unwrap();
        let error = bad(&at, &["leaf", name, "-o", "x.glb"]);
        assert!(error.contains(name) && error.contains(want), "{error}");
    }
    fs::write(at.join("few.xyz"), "1 2 3\n4 5 6\n").unwrap();
    assert!(bad(&at, &["leaf", "--scan", "few.xyz", "-o", "x.glb"]).contains("at least 100"));
    assert!(!at.join("x.glb").exists());
}

#[test]
fn chief_veins_that_start_together_make_a_leaf() {
    let at = folder("leaf-venation");
    good(&at, &["leaf", "--venation", "palmate", "--veins", "7", "-o", "m.glb", "--marks", "m.csv"]);
    good(&at, &["leaf", "--venation", "parallel", "--length", "0.4", "-o", "p.glb", "--marks", "p.csv"]);
    for (file, length, veins) in [("m.csv", 100.0, 7), ("p.csv", 400.0, 9)] {
        good(&at, &["leaf", file, "-o", "again.glb", "--report", "r.json", "--quiet"]);
        let report: Value = serde_json::from_str(&fs::read_to_string(at.join("r.json")).unwrap()).unwrap();
        let leaf = &report["items"][0]["leaf"];
        assert!(leaf["vein_gap_mm"].as_f64().unwrap() < 1e-6, "{file}: {leaf}");
        assert!(leaf["fit_error"]["max_mm"].as_f64().unwrap() < 1e-6, "{file}: {leaf}");
        let long = leaf["length_mm"].as_f64().unwrap();
        assert!((long / length - 1.0).abs() < 0.15, "{file} is {long} mm long");
        // Veins of 10-sided rings, five parts for each span.
        let marks = if file == "m.csv" { 9 } else { 13 };
        let rings = 5 * (marks - 1) + 1;
        assert_eq!(leaf["veins"]["vertices"].as_u64(), Some(10 * rings * veins), "{file}");
    }
    let text = fs::read_to_string(at.join("p.csv")).unwrap();
    let line = text.lines().find(|l| l.starts_with("3,5,")).unwrap();
    for (name, text, want) in [
        ("gap.csv", text.replace(&format!("{line}\n"), ""), "vein 3: mark 5 is missing"),
        ("short.csv", text.replace("\n11,13,", "\n# 11,13,"), "vein 11 has 12 marks, vein 1 has 13"),
        ("twice.csv", format!("{text}{line}\n"), "vein 3, mark 5 is given twice"),
    ] {
        fs::write(at.join(name), text).unwrap();
        let error = bad(&at, &["leaf", name, "-o", "x.glb"]);
        assert!(error.contains(name) && error.contains(want), "{error}");
    }
    assert!(
        bad(&at, &["leaf", "--venation", "palmate", "--veins", "4", "-o", "x.glb"]).contains("odd number")
    );
    assert!(bad(&at, &["leaf", "p.csv", "--surface", "nurbs", "-o", "x.glb"]).contains("rows of marks"));
}

#[test]
fn profiles_of_maize_become_leaves_of_their_length() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/leaves/maize_leaves.json");
    let Ok(text) = fs::read_to_string(&file) else {
        return missing::skipped(file.display());
    };
    // Every eighth, by the command line; all use the same reader.
    profiles("leaf-profiles", &text, 8, 79);
}

#[test]
fn our_own_profiles_become_leaves_of_their_length() {
    let text = fs::read_to_string(fixture("nine-midribs.json")).unwrap();
    profiles("leaf-own-profiles", &text, 3, 9);
}

/// Makes every `step`th of `count` leaves that were digitised from the side, in centimetres.
fn profiles(name: &str, text: &str, step: usize, count: usize) {
    let dir = folder(name);
    let leaves: Vec<Value> = serde_json::from_str(text).unwrap();
    let numbers =
        |v: &Value| -> Vec<f64> { v.as_array().unwrap().iter().filter_map(Value::as_f64).collect() };
    fs::write(dir.join("maize.json"), text).unwrap();
    for (k, leaf) in leaves.iter().enumerate().step_by(step) {
        let (x, y) = (numbers(&leaf["x"]), numbers(&leaf["y"]));
        let steps = x
            .windows(2)
            .zip(y.windows(2))
            .map(|(x, y)| [x[1] - x[0], y[1] - y[0]])
            .map(|[a, b]| (a * a + b * b).sqrt());
        let want = 10.0 * steps.sum::<f64>();
        let number = (k + 1).to_string();
        let args = ["leaf", "maize.json", "--unit", "cm", "--number", &number, "--json"];
        let report: Value = serde_json::from_str(&good(&dir, &args)).unwrap();
        let got = report["items"][0]["leaf"]["length_mm"].as_f64().unwrap();
        eprintln!("leaf {number}: {got:.1} of {want:.1} mm");
        // 20 chords of the midrib are a little shorter than its own.
        assert!(got <= want * (1.0 + 1e-9) && got > 0.98 * want, "leaf {number}: {got} {want}");
    }
    let beyond = (count + 1).to_string();
    let told = bad(&dir, &["leaf", "maize.json", "--number", &beyond, "-o", "x.glb"]);
    assert!(told.contains(&format!("holds {count} leaves")), "{told}");
    // 42 m without a unit is not a leaf.
    let out = burgeon(&dir, &["leaf", "maize.json", "-o", "x.glb"]);
    let warned = String::from_utf8_lossy(&out.stderr).into_owned();
    let several = format!("{count} leaves");
    assert!(warned.contains("taken for centimetres") && warned.contains(&several), "{warned}");
}

#[test]
fn our_own_files_are_read_where_they_are_offered() {
    let dir = folder("leaf-own-files");
    good(&dir, &["leaf", "--venation", "palmate", "-o", "x.glb", "--marks", "rays.csv"]);
    good(&dir, &["leaf", &fixture("leaf1.csv"), "-o", "x.glb", "--marks", "rows.csv"]);
    fs::write(dir.join("small.toml"), "[method]\nkind = \"colonization\"\npoints = 60\nenvelope = { shape = \"sphere\", centre = [0, 1, 0], radius_m = 0.5 }\n").unwrap();
    let digest = |template: &[&str]| {
        let args = [
            &["grow", "small.toml", "--json", "--no-textures", "--png", "x.png", "--size", "20x20"],
            template,
        ]
        .concat();
        let report: Value = serde_json::from_str(&good(&dir, &args)).unwrap();
        report["items"][0]["digest"].as_str().unwrap().to_owned()
    };
    let own = digest(&[]);
    for file in ["rays.csv", "rows.csv"] {
        assert_ne!(digest(&["--leaf-template", file]), own, "{file} changes the leaves");
        assert_eq!(burgeon(&dir, &["leaf", file, "-o", "y.glb"]).status.code(), Some(0), "{file}");
    }
}

#[test]
fn numbers_with_decimal_commas_are_read_or_refused_by_name() {
    let dir = folder("leaf-commas");
    let text = fs::read_to_string(fixture("leaf1.csv")).unwrap();
    let digest = |name: &str| {
        let report: Value =
            serde_json::from_str(&good(&dir, &["leaf", name, "--json", "--texture", "plain"])).unwrap();
        report["items"][0]["digest"].as_str().unwrap().to_owned()
    };
    fs::write(dir.join("points.csv"), &text).unwrap();
    // As a spreadsheet with decimal commas writes it.
    let table = |line: &str| {
        if line.starts_with('#') { line.to_owned() } else { line.replace(',', ";").replace('.', ",") }
    };
    let semicolons = text.lines().map(table).collect::<Vec<_>>().join("\n");
    fs::write(dir.join("semicolons.csv"), semicolons).unwrap();
    assert_eq!(digest("points.csv"), digest("semicolons.csv"));
    fs::write(dir.join("mixed.csv"), text.replace("26.5,414.8", "26,5,414,8")).unwrap();
    let told = bad(&dir, &["leaf", "mixed.csv", "-o", "x.glb"]);
    assert!(told.contains("line 7") && told.contains("semicolons"), "{told}");
    // One mark multiplied by a hundred is reported.
    fs::write(dir.join("stray.csv"), text.replace("26.5,414.8", "2650,41480")).unwrap();
    let out = burgeon(&dir, &["leaf", "stray.csv", "-o", "x.glb"]);
    assert!(String::from_utf8_lossy(&out.stderr).contains("row 1, mark 1 lies"), "{out:?}");
    // Statements of the file are not contradicted without an error.
    let told = bad(&dir, &["leaf", "points.csv", "--unit", "cm", "-o", "x.glb"]);
    assert!(told.contains("# unit: mm") && told.contains("--unit"), "{told}");
}
