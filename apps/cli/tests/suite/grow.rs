//! `burgeon grow`, `presets` and `compare` as other programs call them, with good and bad input.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;
use tools::{bad, folder, good};

fn item(folder: &Path, args: &[&str]) -> Value {
    let all = [&["grow"], args, &["--json"]].concat();
    let report: Value = serde_json::from_str(&good(folder, &all)).unwrap();
    assert_eq!((report["command"].as_str(), report["ok"].as_u64()), (Some("grow"), Some(1)), "{args:?}");
    report["items"][0].clone()
}

/// Writes points on a lattice of 0.25 m from 1 to 3 m above the ground.
fn cloud(folder: &Path) -> usize {
    let mut text = String::new();
    let mut n = 0;
    for i in 0..9 {
        for j in 0..9 {
            for k in 0..9 {
                let at = |c: i32| 0.25 * f64::from(c - 4);
                text += &format!("{} {} {}\n", at(i), 2.0 + at(j), at(k));
                n += 1;
            }
        }
    }
    fs::write(folder.join("cloud.xyz"), text).unwrap();
    n
}

fn spec(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).unwrap();
}

const SMALL: &str = "name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 200\nlifespan = 1\n";

/// Writes a box as OBJ, from (0.4, 0, -2) to (3, 5, 2); without its last two faces it is open.
fn wall(folder: &Path, name: &str, faces: usize) {
    let mut text = String::new();
    for (x, y, z) in [
        (0.4, 0, -2),
        (3.0, 0, -2),
        (3.0, 5, -2),
        (0.4, 5, -2),
        (0.4, 0, 2),
        (3.0, 0, 2),
        (3.0, 5, 2),
        (0.4, 5, 2),
    ] {
        text += &format!("v {x} {y} {z}\n");
    }
    let quads = ["1 4 3 2", "5 6 7 8", "1 5 8 4", "2 3 7 6", "1 2 6 5", "4 8 7 3"];
    quads[..faces].iter().for_each(|q| text += &format!("f {q}\n"));
    fs::write(folder.join(name), text).unwrap();
}

#[test]
fn one_preset_of_each_method_grows_and_is_drawn() {
    let at = folder("grow-methods");
    for (preset, method, age) in [
        ("terminalia", "competition", "12"),
        ("oak-colonization", "colonization", "30"),
        ("alder", "self-organizing", "10"),
        ("palm", "lsystem", "25"),
    ] {
        let (model, png) = (format!("{preset}.glb"), format!("{preset}.png"));
        let args =
            [preset, "-o", &model, "--png", &png, "--size", "120x120", "--supersample", "1", "--age", age];
        let item = item(&at, &args);
        let growth = &item["growth"];
        assert_eq!(growth["method"], method);
        for key in [
            "attractors",
            "consumed",
            "unreachable",
            "iterations",
            "cycles",
            "nodes",
            "leaves_placed",
            "leaves_kept",
        ] {
            assert!(growth[key].is_u64(), "{preset}: {key} in {growth}");
        }
        assert!(growth["inside_obstacle"].is_null(), "there is none: {growth}");
        assert!(growth["nodes"].as_u64() > Some(20) && item["counts"]["triangles"].as_u64() > Some(300));
        assert!(item["timings_ms"]["structure"].as_f64() > Some(0.0));
        assert!(item["timings_ms"]["mesh"].as_f64() > Some(0.0));
        assert!(fs::metadata(at.join(&model)).unwrap().len() > 10_000);
        assert!(fs::metadata(at.join(&png)).unwrap().len() > 500);
    }
}

#[test]
fn given_points_are_consumed_or_reported() {
    let at = folder("grow-points");
    let n = cloud(&at);
    let args = [
        "--attractors",
        "cloud.xyz",
        "--root",
        "0,0,0",
        "--step",
        "0.1",
        "--influence",
        "0.8",
        "--kill",
        "0.2",
    ];
    let growth = item(&at, &args)["growth"].clone();
    assert_eq!(growth["attractors"], n as u64);
    assert_eq!(growth["consumed"].as_u64().unwrap() + growth["unreachable"].as_u64().unwrap(), n as u64);
    assert_eq!(growth["unreachable"], 0);
    // 100 m away: nothing can reach it. Growth must end and report it.
    let far = fs::read_to_string(at.join("cloud.xyz")).unwrap() + "100 2 0\n100 2.1 0\n";
    fs::write(at.join("far.xyz"), far).unwrap();
    let args = [&["--attractors", "far.xyz"], &args[2..]].concat();
    let item = item(&at, &args);
    assert_eq!(item["growth"]["unreachable"], 2);
    assert!(item["warnings"][0].as_str().unwrap().contains("2 of 731"), "{item}");
}

#[test]
fn points_that_are_no_numbers_are_left_out_and_told() {
    let at = folder("grow-nan");
    cloud(&at);
    let text = fs::read_to_string(at.join("cloud.xyz")).unwrap() + "nan 2 0\n0 inf 0\n";
    fs::write(at.join("nan.xyz"), text).unwrap();
    let item = item(&at, &["--attractors", "nan.xyz", "--influence", "0.8", "--kill", "0.2"]);
    let warnings = item["warnings"].to_string();
    assert!(item["growth"]["consumed"].as_u64() > Some(700), "{item}");
    assert!(warnings.contains('2') && warnings.len() > 10, "{warnings}");
    fs::write(at.join("empty.xyz"), "").unwrap();
    let told = bad(&at, &["grow", "--attractors", "empty.xyz", "--json"]);
    assert!(told.contains("empty.xyz"), "{told}");
}

#[test]
fn distances_must_make_sense() {
    let at = folder("grow-distances");
    cloud(&at);
    let told =
        bad(&at, &["grow", "--attractors", "cloud.xyz", "--influence", "0.2", "--kill", "0.5", "--json"]);
    assert!(told.contains("--kill 0.5 is above --influence 0.2"), "{told}");
    let told = bad(&at, &["grow", "oak", "--kill", "-1", "--json"]);
    assert!(told.contains("--kill") && told.contains("0.000001"), "{told}");
    let told = bad(&at, &["grow", "oak", "--root", "0,nan,0", "--json"]);
    assert!(told.contains("--root"), "{told}");
    // In a spec the attraction distance is raised, with a warning.
    spec(&at, "kill.toml", &format!("{SMALL}kill_m = 2.0\nattraction_m = 1.0\n"));
    let item = item(&at, &["kill.toml"]);
    assert!(item["warnings"][0].as_str().unwrap().contains("below the kill distance"), "{item}");
    let told = bad(&at, &["grow", "palm", "--kill", "1", "--json"]);
    assert!(told.contains("colonization"), "{told}");
}

#[test]
fn obstacles_are_grown_around() {
    let at = folder("grow-obstacles");
    spec(&at, "bush.toml", SMALL);
    wall(&at, "wall.obj", 6);
    let item = item(&at, &["bush.toml", "--obstacle", "wall.obj", "-o", "bush.glb"]);
    assert_eq!(item["growth"]["inside_obstacle"], 0);
    assert_eq!(item["warnings"].as_array().unwrap().len(), 0, "{item}");
    assert!(item["counts"]["leaves"].as_u64() > Some(50));
    let told = bad(&at, &["grow", "bush.toml", "--obstacle", "wall.obj", "--root", "1,1,0", "-o", "x.glb"]);
    assert!(told.contains("root 1 stands inside obstacle 1"), "{told}");
    assert!(!at.join("x.glb").exists());
}

#[test]
fn open_meshes_are_warned_of_and_still_kept_out_of() {
    let at = folder("grow-open");
    spec(&at, "bush.toml", SMALL);
    wall(&at, "open.obj", 5);
    let item = item(&at, &["bush.toml", "--obstacle", "open.obj"]);
    assert!(item["warnings"][0].as_str().unwrap().contains("open mesh (4 edges"), "{item}");
    assert_eq!(item["growth"]["inside_obstacle"], 0);
    let named = format!("[[obstacles]]\nshape = \"mesh\"\nfile = \"open.obj\"\n{SMALL}")
        .replace("name = \"bush\"\n", "");
    spec(&at, "named.toml", &named);
    let same = item_of(&at, "named.toml");
    assert_eq!(same["growth"], item["growth"]);
    spec(&at, "missing.toml", &named.replace("open.obj", "none.obj"));
    let told = bad(&at, &["grow", "missing.toml", "--json"]);
    assert!(told.contains("none.obj"), "{told}");
}

fn item_of(folder: &Path, name: &str) -> Value {
    item(folder, &[name])
}

#[test]
fn slips_in_specs_are_named_with_field_value_and_line() {
    let at = folder("grow-specs");
    for (text, wants) in [
        (format!("{SMALL}kil_m = 2\n"), vec!["line 6", "kil_m"]),
        (format!("{SMALL}lifespan = 99\n").replace("lifespan = 1\n", ""), vec!["lifespan", "1 to 20", "99"]),
        (format!("{SMALL}kill_m = nan\n"), vec!["kill_m", "NaN"]),
        (format!("{SMALL}[leaves]\nleaf_keep = 1.5\n"), vec!["leaf_keep", "0 to 1", "1.5"]),
        (format!("{SMALL}[blade]\nform = \"square\"\n"), vec!["line 7", "square"]),
        (format!("{SMALL}[look]\nleaf_color = \"green\"\n"), vec!["line 7", "green"]),
        ("name = \n".into(), vec!["line 1"]),
        (format!("roots = []\n{SMALL}"), vec!["no roots"]),
        (format!("{SMALL}[method.envelope]\nshape = \"sphere\"\ncentre = [0, 4, 0]\nradius_m = -1\n"), vec!["radius_m"]),
        ("[method]\nkind = \"lsystem\"\nmost_modules = 1000\nrules = \"\"\"\naxiom = A\nsteps = 40\nA -> A A F\n\"\"\"\n".into(),
         vec!["A -> A A F", "explode"]),
    ] {
        spec(&at, "slip.toml", &text);
        let told = bad(&at, &["grow", "slip.toml", "-o", "slip.glb"]);
        for want in wants {
            assert!(told.contains(want), "{want}: {told}");
        }
        assert!(!at.join("slip.glb").exists());
    }
    let told = bad(&at, &["grow", "oka", "-o", "x.glb"]);
    assert!(told.contains("no preset `oka`"), "{told}");
    assert_eq!(fs::read_dir(&at).unwrap().count(), 1, "only the spec is left");
}

#[test]
fn a_million_points_in_one_place_end() {
    let at = folder("grow-heap");
    spec(
        &at,
        "heap.toml",
        "[method]\nkind = \"colonization\"\npoints = 200000\n\
        envelope = { shape = \"sphere\", centre = [0, 2, 0], radius_m = 0.00001 }\n",
    );
    let growth = item(&at, &["heap.toml"])["growth"].clone();
    assert_eq!((growth["attractors"].as_u64(), growth["unreachable"].as_u64()), (Some(200_000), Some(0)));
}

#[test]
fn a_million_given_points_in_one_place_end() {
    let at = folder("grow-million");
    fs::write(at.join("heap.xyz"), "0.5 3 0.25\n".repeat(1_000_000)).unwrap();
    let growth =
        item(&at, &["--attractors", "heap.xyz", "--influence", "1", "--kill", "0.3"])["growth"].clone();
    assert_eq!((growth["consumed"].as_u64(), growth["unreachable"].as_u64()), (Some(1_000_000), Some(0)));
    assert!((5..60).contains(&growth["nodes"].as_u64().unwrap()), "{growth}");
}

#[test]
fn no_points_at_all_is_an_error_that_says_where() {
    let at = folder("grow-nothing");
    for (name, text, wants) in [
        ("empty.xyz", "", "empty"),
        ("comment.xyz", "# nothing\n", "no point"),
        ("nan.xyz", "nan nan nan\nnan 0 1\n", "none of its points is finite"),
    ] {
        fs::write(at.join(name), text).unwrap();
        let told = bad(&at, &["grow", "--attractors", name, "-o", "x.glb"]);
        assert!(told.contains(name) && told.contains(wants), "{told}");
    }
    for kind in ["competition", "colonization"] {
        let shape = "envelope = { shape = \"sphere\", centre = [0, 3, 0], radius_m = 1 }";
        spec(&at, "zero.toml", &format!("[method]\nkind = \"{kind}\"\npoints = 0\n{shape}\n"));
        let told = bad(&at, &["grow", "zero.toml", "-o", "x.glb"]);
        assert!(told.contains("zero.toml: line 3: method.points must be 1 to 10,000,000, not 0"), "{told}");
    }
    assert!(!at.join("x.glb").exists());
}

#[test]
fn inverted_and_empty_obstacles_are_named() {
    let at = folder("grow-inverted");
    spec(&at, "bush.toml", SMALL);
    wall(&at, "wall.obj", 6);
    let text = fs::read_to_string(at.join("wall.obj")).unwrap();
    let inverted = text.lines().map(|l| match l.strip_prefix("f ") {
        Some(face) => format!("f {}\n", face.split(' ').rev().collect::<Vec<_>>().join(" ")),
        None => format!("{l}\n"),
    });
    fs::write(at.join("inverted.obj"), inverted.collect::<String>()).unwrap();
    let around = |name: &str| item(&at, &["bush.toml", "--obstacle", name]);
    let (right, wrong) = (around("wall.obj"), around("inverted.obj"));
    assert!(wrong["warnings"][0].as_str().unwrap().contains("obstacle 1 look inwards"), "{wrong}");
    assert_eq!((&wrong["growth"], &wrong["digest"]), (&right["growth"], &right["digest"]));
    let told =
        bad(&at, &["grow", "bush.toml", "--obstacle", "inverted.obj", "--root", "1,1,0", "-o", "x.glb"]);
    assert!(told.contains("root 1 stands inside obstacle 1") && told.contains("move"), "{told}");
    fs::write(at.join("points.obj"), "v 0 0 0\nv 1 0 0\n").unwrap();
    let told = bad(&at, &["grow", "bush.toml", "--obstacle", "points.obj", "-o", "x.glb"]);
    assert!(told.contains("points.obj") && told.contains("no faces"), "{told}");
    fs::write(at.join("nan.obj"), text.replace("v 3 5 2", "v nan 5 2")).unwrap();
    let told = bad(&at, &["grow", "bush.toml", "--obstacle", "nan.obj", "-o", "x.glb"]);
    assert!(told.contains("nan.obj") && told.contains("line 7") && told.contains("not finite"), "{told}");
    assert!(!at.join("x.glb").exists());
}

#[test]
fn weak_shade_ends_with_a_warning_that_names_the_numbers() {
    let at = folder("grow-shade");
    spec(
        &at,
        "weak.toml",
        "[method]\nkind = \"self-organizing\"\nyears = 40\narrangement = { kind = \"decussate\" }\n\
         max_joints = 3000\nlight = { kind = \"shadow\", a = 0.04, b = 2.2, layers = 4, full = 2.0 }\n",
    );
    let item = item(&at, &["weak.toml", "--leaf-keep", "0.1"]);
    let told = item["warnings"].to_string();
    assert!(told.contains("light.a (0.04)") && told.contains("max_joints (3000)"), "{told}");
    assert!((500..=3000).contains(&item["growth"]["nodes"].as_u64().unwrap()), "{item}");
}

#[test]
fn guided_trees_are_full() {
    let at = folder("grow-guided");
    let bush = "envelope = { shape = \"sphere\", centre = [0, 1.4, 0], radius_m = 1 }\n";
    spec(&at, "bush.toml", &format!("{SMALL}{bush}"));
    let item = item(&at, &["bush.toml", "--method", "guided", "--leaf-keep", "0.2"]);
    assert_eq!(item["growth"]["method"], "guided");
    let (nodes, volume) =
        (item["growth"]["nodes"].as_u64().unwrap(), item["plant"]["crown_volume_m3"].as_f64().unwrap());
    assert!((4_000..60_000).contains(&nodes), "{item}");
    // The ball has 4.2 cubic metres.
    assert!((2.0..4.5).contains(&volume), "a crown of {volume} cubic metres");
}

#[test]
fn guided_growth_is_compared_with_its_baseline() {
    let at = folder("grow-compare-guided");
    let args = ["compare", "guided", "--json", "--png", "two.png", "--size", "80x90", "--supersample", "1"];
    let report: Value =
        serde_json::from_str(&good(&at, &[&args[..], &["--detail", "0.2"]].concat())).unwrap();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(
        rows.iter().map(|r| r["method"].as_str().unwrap()).collect::<Vec<_>>(),
        ["guided growth", "self-organisation"]
    );
    for row in rows {
        assert!((row["height_m"].as_f64().unwrap() - 10.0).abs() < 1e-6, "{row}");
        assert!(row["nodes"].as_u64() > Some(3000) && row["growth_seconds"].as_f64() > Some(0.0), "{row}");
        assert!(row.get("paper").is_none(), "its paper's times are lost");
    }
    // Time against buds, also with the paper's markers, and the resulting ratio where crowns are equally full.
    let points = report["curve"]["points"].as_array().unwrap();
    let of = |p: &Value, key: &str| p[key].as_f64().unwrap();
    assert_eq!(points.len(), 12);
    for method in points.chunks(4) {
        assert!(method.windows(2).all(|w| of(&w[0], "buds") <= of(&w[1], "buds")), "{method:?}");
        assert!(of(&method[3], "filled") > 0.5 && of(&method[0], "filled") < of(&method[3], "filled"));
        assert!(method.iter().all(|p| of(p, "seconds") > 0.0 && of(p, "peak_mib") > 0.0), "{method:?}");
    }
    let ratios = report["curve"]["at_equal_quality"].as_array().unwrap();
    assert_eq!(ratios.iter().map(|r| r["markers"].as_u64().unwrap()).collect::<Vec<_>>(), [60, 1300]);
    assert!(ratios.iter().all(|r| of(r, "filled") > 0.5 && of(r, "times") > 0.0), "{ratios:?}");
    assert_eq!(rows[0]["leaves"].as_u64().unwrap().abs_diff(rows[1]["leaves"].as_u64().unwrap()) / 50, 0);
    let crowns: Vec<f64> = rows.iter().map(|r| r["crown_m"].as_f64().unwrap()).collect();
    assert!((crowns[0] / crowns[1] - 1.0).abs() < 0.3, "like for like: {crowns:?}");
    assert_eq!(fs::read(at.join("two.png")).unwrap()[16..24], [0, 0, 0, 160, 0, 0, 0, 90]);
}

#[test]
fn leaves_age_seed_and_threads_do_what_they_say() {
    let at = folder("grow-options");
    spec(&at, "bush.toml", SMALL);
    let digest = |args: &[&str]| item(&at, &[&["bush.toml"], args].concat())["digest"].clone();
    let leaves = |keep: &str| {
        let g = item(&at, &["bush.toml", "--leaf-keep", keep])["growth"].clone();
        (g["leaves_placed"].as_u64().unwrap(), g["leaves_kept"].as_u64().unwrap())
    };
    let (placed, all) = leaves("1");
    assert_eq!((placed, leaves("0").1), (all, 0));
    assert!(leaves("0.25").1.abs_diff(all / 4) <= 1);
    assert_eq!(digest(&["--threads", "1"]), digest(&["--threads", "4"]));
    assert_ne!(digest(&[]), digest(&["--seed", "2"]));
    let nodes = |args: &[&str]| item(&at, &[&["bush.toml"], args].concat())["growth"]["nodes"].as_u64();
    assert!(nodes(&["--age", "6"]) < nodes(&[]));
    // A plant that sheds no leaves has no season.
    spec(&at, "deciduous.toml", &format!("{SMALL}[look]\nautumn_color = \"#d9a437\"\n"));
    let left =
        |season: &str| item(&at, &["deciduous.toml", "--season", season])["growth"]["leaves_kept"].clone();
    assert_eq!((left("0"), left("0.5"), left("1")), (all.into(), all.into(), 0.into()));
    assert_eq!((left("-1"), left("-0.1")), (0.into(), all.into()));
    for args in [&["bush.toml", "--season", "0.5"][..], &["deciduous.toml", "--season", "1.5"]] {
        assert!(bad(&at, &[&["grow"], args, &["--json"]].concat()).contains("season"), "{args:?}");
    }
    // Levels of detail lie next to the model, each smaller.
    let args = ["grow", "bush.toml", "-o", "bush.glb", "--lods", "2", "--json"];
    let report: Value = serde_json::from_str(&good(&at, &args)).unwrap();
    let triangles = |i: usize| report["items"][i]["counts"]["triangles"].as_u64().unwrap();
    assert!(triangles(1) < triangles(0) && triangles(2) < triangles(1));
    assert_eq!(report["items"][2]["output"], "bush-lod2.glb");
    assert!(at.join("bush-lod1.glb").exists() && at.join("bush-lod2.glb").exists());
    // Wind is written where there is room for it, on every level; elsewhere a warning says that it is not.
    good(&at, &["grow", "bush.toml", "-o", "wind.glb", "--wind", "--lods", "1", "-q"]);
    let blown = |file: &str| {
        let info: Value = serde_json::from_str(&good(&at, &["info", file, "--json"])).unwrap();
        info["model"]["parts"].as_array().unwrap().iter().all(|p| p["wind"] == true)
    };
    assert!(blown("wind.glb") && blown("wind-lod1.glb") && !blown("bush.glb"));
    good(&at, &["convert", "wind.glb", "-o", "kept.glb"]);
    assert_eq!(fs::read(at.join("kept.glb")).unwrap(), fs::read(at.join("wind.glb")).unwrap());
    for out in ["wind.obj", "wind.mtg"] {
        let told = bad(&at, &["grow", "bush.toml", "-o", out, "--wind"]);
        assert!(told.contains("--wind is for models as .glb, "), "{out}: {told}");
    }
    good(&at, &["grow", "bush.toml", "-o", "wind.usda", "--wind"]);
    // One file, which contains the same layer unchanged.
    good(&at, &["grow", "bush.toml", "-o", "wind.usdz", "--wind"]);
    let text = fs::read_to_string(at.join("wind.usdz").with_extension("usda")).unwrap();
    let whole = fs::read(at.join("wind.usdz")).unwrap();
    let layer = text.replace("wind-", "model-");
    assert_eq!(&whole[64..64 + layer.len()], layer.as_bytes());
    assert!(fs::read_to_string(at.join("wind.usda")).unwrap().contains("float4[] primvars:wind"));
    // Another method in the same envelope.
    let other = item(&at, &["bush.toml", "--method", "colonization"]);
    assert_eq!(other["growth"]["method"], "colonization");
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_nothing_behind() {
    let at = folder("grow-cancel");
    spec(
        &at,
        "huge.toml",
        "[method]\nkind = \"colonization\"\npoints = 4000000\n\
        envelope = { shape = \"sphere\", centre = [0, 30, 0], radius_m = 29 }\n",
    );
    let mut child = Command::new(env!("CARGO_BIN_EXE_burgeon"))
        .args(["grow", "huge.toml", "-o", "huge.glb", "--png", "huge.png", "--budget", "4"])
        .current_dir(&at)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    let started = std::time::Instant::now();
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(130));
    assert!(started.elapsed().as_secs() < 60, "{:?}", started.elapsed());
    let left: Vec<_> = fs::read_dir(&at).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["huge.toml"]);
}

#[test]
fn presets_are_listed_shown_and_described() {
    let at = folder("grow-presets");
    let list = good(&at, &["presets"]);
    for name in [
        "pine",
        "terminalia",
        "chinese-fir",
        "oak",
        "willow",
        "palm",
        "bamboo",
        "dead-oak",
        "peony",
        "dandelion",
    ] {
        assert!(list.lines().any(|l| l.starts_with(name)), "{name} in {list}");
    }
    let toml = good(&at, &["presets", "--show", "hazel"]);
    spec(&at, "mine.toml", &toml.replace("lifespan = 3", "lifespan = 1"));
    assert!(item(&at, &["mine.toml"])["counts"]["leaves"].as_u64() > Some(100));
    good(&at, &["presets", "--schema", "tree.schema.json"]);
    let schema: Value =
        serde_json::from_str(&fs::read_to_string(at.join("tree.schema.json")).unwrap()).unwrap();
    let clearance = &schema["properties"]["clearance_m"];
    assert_eq!((clearance["x-unit"].as_str(), clearance["default"].as_f64()), (Some("m"), Some(0.05)));
    assert_eq!((clearance["minimum"].as_f64(), clearance["maximum"].as_f64()), (Some(0.0), Some(1e6)));
    assert!(clearance["description"].as_str().unwrap().contains("obstacles"));
    assert!(bad(&at, &["presets", "--show", "fern"]).contains("fern"));
}

#[test]
fn a_leaf_of_your_own_is_borne() {
    let at = folder("grow-leaf");
    let leaf = format!("{}/../../fixtures/leaves/leaf1.csv", env!("CARGO_MANIFEST_DIR"));
    fs::copy(&leaf, at.join("leaf.csv")).unwrap();
    let digest = |args: &[&str]| item(&at, args)["digest"].as_str().unwrap().to_owned();
    let (own, given) =
        (digest(&["hazel", "-o", "a.glb"]), digest(&["hazel", "-o", "b.glb", "--leaf-template", &leaf]));
    assert_ne!(own, given);
    let toml = good(&at, &["presets", "--show", "hazel"]);
    spec(&at, "mine.toml", &toml.replace("[blade]", "[blade]\nfile = \"leaf.csv\""));
    assert_eq!(digest(&["mine.toml", "-o", "c.glb"]), given, "a spec names its leaf beside itself");
    spec(&at, "lost.toml", &toml.replace("[blade]", "[blade]\nfile = \"none.csv\""));
    assert!(bad(&at, &["grow", "lost.toml", "-o", "d.glb"]).contains("none.csv"));
    let error = bad(&at, &["grow", "hazel", "-o", "d.glb", "--leaf-template", "mine.toml"]);
    assert!(error.contains("mine.toml"), "{error}");
    assert!(!at.join("d.glb").exists());
}

#[test]
fn oaks_are_compared_at_one_height() {
    let at = folder("grow-compare");
    let args = [
        "compare",
        "oak",
        "--json",
        "--png",
        "oaks.png",
        "--size",
        "100x120",
        "--supersample",
        "1",
        "--detail",
        "0.3",
    ];
    let report: Value = serde_json::from_str(&good(&at, &args)).unwrap();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 3);
    for row in rows {
        assert!((row["height_m"].as_f64().unwrap() - 10.0).abs() < 1e-6, "{row}");
        assert!(row["leaves"].as_u64() > Some(1000) && row["bytes"].as_u64() > Some(100_000), "{row}");
        assert!(row["paper"]["triangles_k"].as_f64() > Some(100.0));
    }
    for key in ["leaves", "leaf_area_m2", "wood_m3"] {
        let all: Vec<f64> = rows.iter().map(|r| r[key].as_f64().unwrap()).collect();
        let (least, most) =
            (all.iter().copied().fold(f64::MAX, f64::min), all.iter().copied().fold(0.0, f64::max));
        let (slack, even) = if key == "wood_m3" { (3.0, "like") } else { (1.03, "one") };
        assert!(least > 0.0 && most < slack * least, "{even} {key}: {all:?}");
    }
    let crowns: Vec<f64> = rows.iter().map(|r| r["crown_m"].as_f64().unwrap()).collect();
    let (least, most) =
        (crowns.iter().copied().fold(99.0, f64::min), crowns.iter().copied().fold(0.0, f64::max));
    assert!(most < 1.25 * least, "like for like: {crowns:?}");
    let png = fs::read(at.join("oaks.png")).unwrap();
    assert_eq!(png[16..24], [0, 0, 1, 44, 0, 0, 0, 120], "three of 100 x 120");
}

#[test]
fn structure_and_measures_are_written_for_programs_of_the_field() {
    let dir = folder("structure-of-a-tree");
    let args = ["grow", "palm", "-o", "palm.mtg", "--qsm", "palm.csv", "--report", "palm.json"];
    good(&dir, &args);
    let mtg = fs::read_to_string(dir.join("palm.mtg")).unwrap();
    assert!(mtg.contains("CODE:\tFORM-A") && mtg.contains("\n/P1\n"), "no MTG");
    good(&dir, &["grow", "palm", "-o", "palm.opf"]);
    let opf = fs::read_to_string(dir.join("palm.opf")).unwrap();
    let table = fs::read_to_string(dir.join("palm.csv")).unwrap();
    let report: Value = serde_json::from_str(&fs::read_to_string(dir.join("palm.json")).unwrap()).unwrap();
    let plant = &report["items"][0]["plant"];
    let height = plant["height_m"].as_f64().unwrap();
    assert!((4.0..30.0).contains(&height), "a palm of {height} m");
    assert_eq!(plant["stems"], 1);
    let leaves = opf.matches("<branch class=\"Leaf\"").count();
    assert_eq!(leaves as u64, report["items"][0]["counts"]["leaves"].as_u64().unwrap());
    assert!(opf.contains("metres, +Z up") && opf.ends_with("</topology>\n</opf>\n"), "no OPF");
    let column = |name: &str| table.lines().next().unwrap().split(',').position(|c| c == name).unwrap();
    let (radius, length) = (column("radius"), column("length"));
    let volume: f64 = (table.lines().skip(1))
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
            std::f64::consts::PI * numbers[radius] * numbers[radius] * numbers[length]
        })
        .sum();
    let told = plant["wood_volume_m3"].as_f64().unwrap();
    assert!((volume / told - 1.0).abs() < 1e-3, "cylinders of {volume} and wood of {told} cubic metres");
}

#[test]
fn a_drawing_of_a_tree_is_read_as_a_tree_again() {
    let dir = folder("grow-drawing");
    spec(&dir, "bush.toml", SMALL);
    good(&dir, &["grow", "bush.toml", "--detail", "0.2", "--drawing", "bush.svg"]);
    fs::write(dir.join("tree.json"), "{ \"read_as\": \"tree\" }").unwrap();
    let svg = fs::read_to_string(dir.join("bush.svg")).unwrap();
    assert!(svg.contains("axis") && svg.contains("crown"), "{svg}");
    let report = good(&dir, &["sketch", "bush.svg", "--spec", "tree.json", "--json"]);
    let report: Value = serde_json::from_str(&report).unwrap();
    assert!(report["items"][0]["counts"]["leaves"].as_u64() > Some(10), "{report}");
    assert!(
        bad(&dir, &["grow", "bush.toml", "--drawing", "bush.png"]).contains("drawings are written as .svg")
    );
    assert!(
        bad(&dir, &["grow", "bush.toml", "-o", "same.svg", "--drawing", "same.svg"]).contains("same.svg")
    );
    let twice =
        bad(&dir, &["grow", "bush.toml", "--png", "one.png", "--qsm", "same.svg", "--drawing", "same.svg"]);
    assert!(twice.contains("same.svg"), "{twice}");
}

/// Returns the JSON of a GLB.
fn gltf(path: &Path) -> Value {
    let glb = fs::read(path).unwrap();
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&glb[20..20 + length]).unwrap()
}

#[test]
fn levels_instances_and_joints_are_in_the_file() {
    let dir = folder("grow-forms");
    spec(&dir, "bush.toml", SMALL);
    let plain = ["bush.toml", "--no-textures", "--lods", "2", "-o"];
    let one = item(&dir, &[&plain[..], &["one.glb", "--lod-file", "one"]].concat());
    assert!(!dir.join("one-lod1.glb").exists(), "all levels are in one file");
    let json = gltf(&dir.join("one.glb"));
    assert_eq!(json["nodes"][0]["extensions"]["MSFT_lod"]["ids"].as_array().map(Vec::len), Some(2));
    item(&dir, &[&plain[..], &["each.glb"]].concat());
    assert!(dir.join("each-lod2.glb").exists());

    let glb = |name: &str, more: &[&str]| {
        item(&dir, &[&["bush.toml", "--no-textures", "-o", name], more].concat());
        fs::metadata(dir.join(name)).unwrap().len()
    };
    let flat = glb("flat.glb", &[]);
    let light = glb("light.glb", &["--instances"]);
    assert!(3 * light < 2 * flat, "{light} of {flat} bytes");
    glb("packed.glb", &["--instances", "--pack", "meshopt"]);
    for name in ["light.glb", "packed.glb"] {
        let info: Value = serde_json::from_str(&good(&dir, &["info", name, "--json"])).unwrap();
        let triangles = one["counts"]["triangles"].as_u64().unwrap();
        assert!(
            info.to_string().contains(&triangles.to_string()),
            "{name}: {triangles} triangles are not in {info}"
        );
    }

    let swaying = glb("sway.glb", &["--sway"]);
    let json = gltf(&dir.join("sway.glb"));
    assert!(swaying > flat && json["skins"].as_array().map(Vec::len) == Some(1));
    assert_eq!(json["animations"][0]["name"], "wind");
    let refused = |more: &[&str]| bad(&dir, &[&["grow", "bush.toml", "--no-textures", "-o"], more].concat());
    assert!(refused(&["x.glb", "--sway", "--lods", "1", "--lod-file", "one"]).contains("--sway"));
    assert!(refused(&["x.glb", "--lod-file", "one"]).contains("--lod-file"));
    assert!(refused(&["x.obj", "--instances"]).contains("--instances"));
    assert!(refused(&["x.obj", "--sway"]).contains("--sway"));
}
