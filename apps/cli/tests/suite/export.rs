//! Export of plants of all makers in the same way: levels, budgets, target programs.
#![expect(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::tools::{FLOWER, bad, folder, good};

const OAK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/sketches/gallery/oak.svg");

/// Returns the entries of the report of a command.
fn items(dir: &Path, args: &[&str]) -> Vec<Value> {
    let report: Value = serde_json::from_str(&good(dir, &[args, &["--json"]].concat())).unwrap();
    report["items"].as_array().unwrap().clone()
}

fn triangles(items: &[Value]) -> Vec<u64> {
    items.iter().map(|item| item["counts"]["triangles"].as_u64().unwrap()).collect()
}

/// Returns the JSON of a GLB.
fn gltf(path: &Path) -> Value {
    let glb = fs::read(path).unwrap();
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&glb[20..20 + length]).unwrap()
}

#[test]
fn each_level_of_any_maker_has_at_most_half_of_the_one_before_while_parts_can_be_coarser() {
    let dir = folder("export-levels");
    fs::write(dir.join("flower.svg"), FLOWER).unwrap();
    // For each maker, the levels that have at most half: parts of few, such as veins and petals, are then as coarse as
    // possible.
    let makers: [(&[&str], usize); 5] = [
        (&["sketch", OAK], 3),
        (&["sketch", "flower.svg"], 2),
        (&["shape", OAK, "--list", "0"], 3),
        (&["leaf", "--venation", "palmate"], 1),
        (&["bloom", "run", "tulip", "--day", "6"], 1),
    ];
    for (maker, halved) in makers {
        let args = [maker, &["-o", "x.glb", "--lods", "3"]].concat();
        let counts = if maker[0] == "bloom" {
            good(&dir, &[&args[..], &["-q"]].concat());
            let files = ["x.glb", "x-lod1.glb", "x-lod2.glb", "x-lod3.glb"];
            let info = |file: &&str| {
                let info: Value = serde_json::from_str(&good(&dir, &["info", file, "--json"])).unwrap();
                info["model"]["triangles"].as_u64().unwrap()
            };
            files.iter().map(info).collect()
        } else {
            triangles(&items(&dir, &args))
        };
        assert_eq!(counts.len(), 4, "{maker:?}");
        assert!(counts.windows(2).all(|w| w[1] > 0 && w[1] < w[0]), "{maker:?}: {counts:?}");
        assert!(counts.windows(2).take(halved).all(|w| 2 * w[1] <= w[0]), "{maker:?}: {counts:?}");
    }
}

#[test]
fn sparser_crowns_have_fewer_triangles() {
    let dir = folder("export-density");
    let counts: Vec<u64> = ["0.1", "0.3", "1"]
        .iter()
        .flat_map(|density| triangles(&items(&dir, &["sketch", OAK, "--density", density])))
        .collect();
    assert!(counts.windows(2).all(|w| w[0] < w[1]), "{counts:?}");
}

#[test]
fn a_drawing_is_exported_as_a_tree_is() {
    let dir = folder("export-drawing");
    let made = |more: &[&str]| {
        let all = [&["sketch", OAK, "--textures", "64", "-o", "oak.glb"], more].concat();
        (items(&dir, &all), gltf(&dir.join("oak.glb")), fs::metadata(dir.join("oak.glb")).unwrap().len())
    };
    let (_, _, plain) = made(&[]);
    let (_, json, packed) = made(&["--pack", "meshopt"]);
    assert!(4 * packed < plain && json["extensionsRequired"].to_string().contains("meshopt"));
    let (_, json, light) = made(&["--instances"]);
    assert!(light < plain && json["extensionsUsed"].to_string().contains("EXT_mesh_gpu_instancing"));
    let (_, json, _) = made(&["--sway"]);
    assert_eq!(json["animations"][0]["name"], "wind");
    let (items, json, _) = made(&["--lods", "2", "--lod-file", "one", "--foliage", "by-level"]);
    assert_eq!(json["nodes"][0]["extensions"]["MSFT_lod"]["ids"].as_array().map(Vec::len), Some(2));
    assert_eq!(items.len(), 3);
    made(&["--impostor", "128"]);
    assert_eq!(
        gltf(&dir.join("oak-lod1.glb"))["materials"][0]["extras"]["impostor"]["type"]
            .as_str()
            .unwrap_or("hemi-octahedral"),
        "hemi-octahedral"
    );
    // In a folder as in a file.
    good(&dir, &["sketch", OAK, "-o", "folder/", "--lods", "1", "--no-textures", "-q"]);
    assert!(dir.join("folder/oak-lod1.glb").exists());
    fs::write(dir.join("flower.svg"), FLOWER).unwrap();
    let alone = bad(&dir, &["leaf", "--venation", "palmate", "-o", "x.glb", "--instances"]);
    assert!(alone.contains("--instances"), "{alone}");
}

#[test]
fn a_budget_is_kept_or_refused_with_the_least_that_there_can_be() {
    let dir = folder("export-budget");
    let oak = ["sketch", OAK, "-o", "oak.glb"];
    let few = items(&dir, &[&oak[..], &["--triangles", "20000", "--lods", "1"]].concat());
    let counts = triangles(&few);
    assert!(counts.len() == 2 && counts[0] <= 20_000 && 2 * counts[1] <= counts[0], "{counts:?}");
    assert!(few[0]["warnings"].to_string().contains("level of detail"), "{}", few[0]["warnings"]);
    items(&dir, &[&oak[..], &["--megabytes", "1"]].concat());
    assert!(fs::metadata(dir.join("oak.glb")).unwrap().len() <= 1_000_000);
    let free = items(&dir, &[&oak[..], &["--triangles", "900000", "--megabytes", "900"]].concat());
    assert!(!free[0]["warnings"].to_string().contains("budget"), "all of it fits");
    let none = bad(&dir, &[&oak[..], &["--triangles", "100"]].concat());
    assert!(none.contains("at least") && none.contains("triangles"), "{none}");
    let none = bad(&dir, &[&oak[..], &["--megabytes", "0.01"]].concat());
    assert!(none.contains("megabytes"), "{none}");
}

#[test]
fn an_engine_sets_what_it_wants_and_says_so() {
    let dir = folder("export-engines");
    let made = |engine: &str, file: &str, more: &[&str]| -> Value {
        let all =
            [&["sketch", OAK, "--textures", "64", "-o", file, "--for", engine, "--json"], more].concat();
        serde_json::from_str(&good(&dir, &all)).unwrap()
    };
    let unity = made("unity", "oak.glb", &[]);
    assert_eq!(unity["for"]["name"], "unity");
    assert!(unity["for"]["set"].to_string().contains("--lods 3") && !dir.join("oak-lod1.glb").exists());
    let json = gltf(&dir.join("oak.glb"));
    let node = |json: &Value, k: usize| json["nodes"][k]["name"].as_str().unwrap().to_owned();
    assert_eq!([1, 4, 5].map(|k| node(&json, k)), ["oak_LOD0", "oak_LOD3", "oak_collider"]);
    assert!(json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_5"].is_u64(), "wind");
    let names: Vec<&str> =
        json["materials"].as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap()).collect();
    assert!(names.iter().all(|name| name.starts_with("oak_")), "{names:?}");
    made("godot", "oak.glb", &[]);
    let json = gltf(&dir.join("oak.glb"));
    assert_eq!([1, 2].map(|k| node(&json, k)), ["oak_mesh", "oak-colonly"]);
    made("unreal", "oak.glb", &[]);
    let json = gltf(&dir.join("oak.glb"));
    assert_eq!(node(&json, 2), "UCX_oak_mesh_00");
    let attributes = &json["meshes"][0]["primitives"][0]["attributes"];
    assert_ne!(attributes["TEXCOORD_1"], attributes["TEXCOORD_0"], "texels of Pivot Painter 2");
    assert!(dir.join("oak-pivots.exr").exists() && dir.join("oak-axes.png").exists());
    made("unity", "oak.glb", &["--sway", "--lods", "1"]);
    assert!(gltf(&dir.join("oak.glb"))["skins"].is_array() && dir.join("oak-lod1.glb").exists());
    let three = made("three", "oak.glb", &["--lods", "0"]);
    assert!(!three["for"]["set"].to_string().contains("--lods"), "the command line wins");
    let json = gltf(&dir.join("oak.glb"));
    assert!(json["meshes"][0]["primitives"][0]["attributes"]["_WIND"].is_u64());
    made("isaac", "oak.usda", &[]);
    let text = fs::read_to_string(dir.join("oak.usda")).unwrap();
    assert!(text.contains("upAxis = \"Z\"") && text.contains("metersPerUnit = 1"));
    let plain: Value = serde_json::from_str(&good(&dir, &["sketch", OAK, "--json"])).unwrap();
    assert!(plain.get("for").is_none());
    let refused = bad(&dir, &["sketch", OAK, "-o", "oak.stl", "--for", "unity"]);
    assert!(refused.contains(".glb") && refused.contains(".stl"), "{refused}");
    assert!(bad(&dir, &["grow", "oak", "--for", "godot", "--png", "x.png"]).contains("-o"));
}

#[test]
fn an_assembly_has_joints_for_its_wood_and_leaves_on_them() {
    let dir = folder("export-assembly");
    let asked = ["grow", "hazel", "--age", "4", "--textures", "64", "--for", "unreal", "-o", "hazel.usda"];
    let report: Value = serde_json::from_str(&good(&dir, &[&asked[..], &["--json"]].concat())).unwrap();
    assert!(report["for"]["set"].to_string().contains("120 joints"), "{}", report["for"]);
    let text = fs::read_to_string(dir.join("hazel.usda")).unwrap();
    let list = |name: &str| -> Vec<String> {
        let line = text.lines().find(|line| line.contains(&format!("{name} = ["))).unwrap();
        let inner = line.split_once('[').and_then(|(_, rest)| rest.split_once("= [")).unwrap().1;
        inner.split(']').next().unwrap().split(',').map(|n| n.trim_matches('"').to_owned()).collect()
    };
    let (joints, bound) = (list("jointNames"), list("bindJoints"));
    assert!(joints.len() > 2 && joints.len() <= 120, "{joints:?}");
    let leaves = report["items"][0]["counts"]["leaves"].as_u64().unwrap();
    assert_eq!(bound.len() as u64, leaves, "each leaf is a copy");
    assert!(bound.iter().all(|name| joints.contains(name)) && bound.iter().any(|name| name != &joints[0]));
    let textures: Vec<&str> = text.split('@').filter(|name| name.ends_with(".jpg")).collect();
    assert!(textures.len() > 3 && !text.contains(".png@"), "{textures:?}");
    for name in textures {
        let bytes = fs::read(dir.join(name)).unwrap();
        assert!(bytes.starts_with(&[0xff, 0xd8, 0xff]), "{name} is a JPEG");
    }
    let wind: Value = serde_json::from_slice(&fs::read(dir.join("hazel-wind.json")).unwrap()).unwrap();
    let named: Vec<&str> =
        wind["Joints"].as_array().unwrap().iter().map(|j| j["JointName"].as_str().unwrap()).collect();
    assert_eq!(named, joints);
    assert!(bad(&dir, &[&asked[..], &["--lods", "2"]].concat()).contains("--lods"));
    assert!(bad(&dir, &[&asked[..], &["--foliage", "cards"]].concat()).contains("holes"));
}

#[test]
fn a_tree_has_the_height_that_is_asked_for_within_its_species() {
    let dir = folder("export-height");
    let tree = |height: &str| items(&dir, &["grow", "hazel", "--height", height, "--detail", "0.2"]);
    for height in ["2", "3"] {
        let measured = tree(height)[0]["plant"]["height_m"].as_f64().unwrap();
        assert!((measured - height.parse::<f64>().unwrap()).abs() < 0.25, "{height}: {measured}");
    }
    let far = bad(&dir, &["grow", "hazel", "--height", "60", "--json"]);
    assert!(far.contains("out of reach"), "{far}");
    let thick = items(&dir, &["grow", "birch", "--dbh", "0.1", "--detail", "0.2"]);
    let dbh = thick[0]["plant"]["dbh_m"].as_f64().unwrap();
    assert!((dbh - 0.1).abs() < 0.01, "{dbh}");
    let far = bad(&dir, &["grow", "birch", "--dbh", "3", "--json"]);
    assert!(far.contains("breast height is out of reach") && far.contains("--dbh"), "{far}");
    let low = bad(&dir, &["grow", "grass", "--dbh", "0.05", "--json"]);
    assert!(low.contains("below breast height") && low.contains("--dbh"), "{low}");
    let latin = items(&dir, &["grow", "corylus avellana", "--age", "3", "--detail", "0.2"]);
    let hazel = items(&dir, &["grow", "hazel", "--age", "3", "--detail", "0.2"]);
    assert_eq!(latin[0]["digest"], hazel[0]["digest"]);
    let old = bad(&dir, &["grow", "hazel", "--age", "5000", "--json"]);
    assert!(old.contains("age must be"), "{old}");
}

#[test]
fn a_print_is_one_closed_body_on_a_flat_foot() {
    let dir = folder("export-print");
    let all = ["sketch", OAK, "-o", "oak.stl", "--for", "print", "--print-height", "60", "--json"];
    let report: Value = serde_json::from_str(&good(&dir, &all)).unwrap();
    assert!(
        report["items"][0]["warnings"].to_string().contains("1 : "),
        "{}",
        report["items"][0]["warnings"]
    );
    let stl = fs::read(dir.join("oak.stl")).unwrap();
    let number = |at: usize| f32::from_le_bytes(stl[at..at + 4].try_into().unwrap());
    let count = u32::from_le_bytes(stl[80..84].try_into().unwrap()) as usize;
    assert_eq!(stl.len(), 84 + 50 * count);
    // Corners by their bits: each edge occurs once in each direction.
    let corner = |t: usize, c: usize| {
        let at = 84 + 50 * t + 12 + 12 * c;
        [0, 4, 8].map(|k| number(at + k).to_bits())
    };
    let mut edges = std::collections::BTreeMap::new();
    let (mut low, mut high) = (f32::MAX, f32::MIN);
    for t in 0..count {
        for c in 0..3 {
            let (a, b) = (corner(t, c), corner(t, (c + 1) % 3));
            *edges.entry((a, b)).or_insert(0) += 1;
            let z = f32::from_bits(a[2]);
            (low, high) = (low.min(z), high.max(z));
        }
    }
    let closed = edges.iter().all(|(&(a, b), &n)| n == 1 && edges.get(&(b, a)) == Some(&1));
    assert!(closed && count > 1000, "{count} triangles");
    assert!(low.abs() < 1e-3 && (high - 60.0).abs() < 2.0, "millimetres, +Z up: {low} to {high}");
    let thin =
        ["sketch", OAK, "-o", "x.stl", "--for", "print", "--print-height", "2000", "--print-wall", "0.2"];
    let refused = bad(&dir, &thin);
    assert!(refused.contains("at least") && refused.contains("mm"), "{refused}");
    assert!(bad(&dir, &["sketch", OAK, "-o", "x.stl", "--print-wall", "1"]).contains("--for print"));
}

#[test]
fn colours_are_not_asked_of_formats_without_any() {
    let dir = folder("colourless");
    for option in [["--textures", "64"], ["--textures", "off"], ["--variation", "0.1"], ["--petals", "blue"]]
    {
        let all = [&["sketch", OAK, "-o", "x.stl"], &option[..]].concat();
        assert!(bad(&dir, &all).contains("STL has none"), "{option:?}");
    }
    let refused = bad(&dir, &["sketch", OAK, "-o", "x.ply", "--textures", "64"]);
    assert!(refused.contains("models and pictures with textures"), "{refused}");
    // What textures show on average is a colour of each vertex.
    good(&dir, &["sketch", OAK, "-o", "x.ply", "-q"]);
    good(&dir, &["sketch", OAK, "-o", "y.ply", "-q", "--textures", "off"]);
    assert!(fs::read(dir.join("x.ply")).unwrap() != fs::read(dir.join("y.ply")).unwrap());
}
