//! `burgeon forest`: an inventory as tiles, alone and together, interrupted and continued.
#![expect(clippy::unwrap_used, reason = "tests")]

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::tools;
use tools::{bad, folder, good, json};

/// Writes an inventory as a forest of the smallest plants that have leaves and levels.
pub(crate) const SMALL: &[&str] = &[
    "forest",
    "in/trees.csv",
    "-o",
    "out/f",
    "--detail",
    "0.1",
    "--sides",
    "3",
    "--textures",
    "64",
    "--lods",
    "1",
    "--impostor",
    "128",
    "--variants",
    "1",
    "--tile-trees",
    "4",
];
/// The options of that command.
const LIGHT: &[&str] = SMALL.split_at(4).1;
const TREES: usize = 16;

/// Writes an inventory of so many trees of two species, `trees.csv`.
pub(crate) fn inventory(at: &Path, trees: usize) {
    let mut text = "x,y,species,height_m,dbh_cm,crown_width_m\n".to_owned();
    for k in 0..trees {
        let (x, y) = (7.0 * (k % 8) as f64 + 0.3, 6.5 * (k / 8) as f64);
        let species = if k % 5 == 0 { "reed" } else { "hazel" };
        let height = if k % 5 == 0 { 2.0 } else { 3.5 + 0.1 * (k % 11) as f64 };
        writeln!(text, "{x},{y},{species},{height},{},{}", 9 + k % 7, 0.42 * height).unwrap();
    }
    fs::write(at.join("trees.csv"), text).unwrap();
}

/// Returns every file below a folder.
fn files(dir: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![dir.to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                open.push(path);
            } else {
                found.insert(path.strip_prefix(dir).unwrap().to_path_buf(), fs::read(&path).unwrap());
            }
        }
    }
    found
}

fn forest(at: &Path, more: &[&str]) -> Value {
    let all = [&["forest", "trees.csv", "--json"], LIGHT, more].concat();
    serde_json::from_str(&good(at, &all)).unwrap()
}

/// Returns document and bytes of a tile.
fn tile(bytes: &[u8]) -> (Value, Vec<u8>) {
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    (serde_json::from_slice(&bytes[20..20 + length]).unwrap(), bytes[28 + length..].to_vec())
}

/// Returns rows of the inventory in the table of a tile.
fn rows(bytes: &[u8]) -> Vec<u32> {
    let (root, bin) = tile(bytes);
    let table = &root["extensions"]["EXT_structural_metadata"]["propertyTables"][0];
    let index = |v: &Value| usize::try_from(v.as_u64().unwrap()).unwrap();
    let view = &root["bufferViews"][index(&table["properties"]["row"]["values"])];
    let start = view["byteOffset"].as_u64().map_or(0, |n| usize::try_from(n).unwrap());
    let own = &bin[start..start + index(&view["byteLength"])];
    own.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect()
}

/// Returns the number of copies of the trees of a tile: for each plant, the largest number that a mesh has.
fn copies(bytes: &[u8]) -> usize {
    let (root, _) = tile(bytes);
    let mut of_ids: BTreeMap<u64, u64> = BTreeMap::new();
    for node in root["nodes"].as_array().unwrap() {
        let ids =
            node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["_FEATURE_ID_0"].as_u64().unwrap();
        let count = root["accessors"][usize::try_from(ids).unwrap()]["count"].as_u64().unwrap();
        of_ids.insert(ids, count);
    }
    usize::try_from(of_ids.values().sum::<u64>()).unwrap()
}

/// Checks a tile and all below it: its box lies in that of the one above, and errors decrease.
fn walk(node: &Value, above: Option<(&[f64], f64)>, seen: &mut Vec<String>) {
    let numbers = node["boundingVolume"]["box"].as_array().unwrap();
    let own: Vec<f64> = numbers.iter().map(|x| x.as_f64().unwrap()).collect();
    let error = node["geometricError"].as_f64().unwrap();
    assert_eq!(own.len(), 12, "a box has twelve numbers");
    if let Some((outer, most)) = above {
        for k in 0..3 {
            let reach = (own[k] - outer[k]).abs() + own[3 + 4 * k];
            assert!(reach <= outer[3 + 4 * k] + 0.05, "{own:?} in {outer:?}");
        }
        assert!(error < most, "{error} < {most}");
    }
    seen.push(node["content"]["uri"].as_str().unwrap().to_owned());
    let below = node["children"].as_array().cloned().unwrap_or_default();
    assert!(!below.is_empty() || error == 0.0, "the finest loses nothing");
    below.iter().for_each(|child| walk(child, Some((&own, error)), seen));
}

#[test]
fn a_forest_is_whole_alone_carried_on_and_repaired() {
    let at = folder("forest-whole");
    inventory(&at, TREES);
    let report = forest(&at, &["-o", "all", "--map", "plan.png", "--glb", "--usd", "--threads", "2"]);
    let tally = &report["forest"];
    assert_eq!((tally["trees"].as_u64(), tally["species"].as_u64()), (Some(TREES as u64), Some(2)));
    assert!(tally["height_error_max_m"].as_f64().unwrap() < 1e-6, "{tally}");
    assert!(tally["dbh_error_max_m"].as_f64().unwrap() < 0.2, "{tally}");
    let whole = files(&at.join("all"));

    // The tileset: every tile exists, and each level of detail has all trees.
    let tileset = json(&at.join("all/tileset.json"));
    assert_eq!(tileset["asset"]["version"], "1.1");
    let mut seen = Vec::new();
    walk(&tileset["root"], None, &mut seen);
    assert_eq!(Some(seen.len() as u64), tally["tiles"].as_u64());
    let mut levels: BTreeMap<&str, Vec<u32>> = BTreeMap::new();
    for uri in &seen {
        let bytes = &whole[Path::new(uri)];
        let level = uri.trim_end_matches(".glb").rsplit('-').next().unwrap();
        let own = rows(bytes);
        assert_eq!(copies(bytes), own.len(), "{uri}");
        levels.entry(level).or_default().extend(own);
        let (root, _) = tile(bytes);
        for list in ["buffers", "images"] {
            for uri in root[list].as_array().into_iter().flatten().filter_map(|row| row["uri"].as_str()) {
                let path = Path::new("tiles/0").join(uri);
                let clean = path.to_str().unwrap().replace("tiles/0/../../", "");
                assert!(whole.contains_key(Path::new(&clean)), "{uri} is there");
            }
        }
    }
    let all: BTreeSet<u32> = (1..=u32::try_from(TREES).unwrap()).collect();
    assert!(levels.len() >= 3, "{levels:?}");
    for (level, rows) in &levels {
        assert_eq!(rows.len(), TREES, "level {level}: each tree once");
        assert_eq!(rows.iter().copied().collect::<BTreeSet<u32>>(), all);
    }
    let csv = String::from_utf8(whole[Path::new("trees.csv")].clone()).unwrap();
    assert_eq!(csv.lines().count(), TREES + 1);
    let manifest: Value = serde_json::from_slice(&whole[Path::new("manifest.json")]).unwrap();
    assert_eq!(
        manifest["files"].as_array().unwrap().len() + 1,
        whole.len(),
        "all but the manifest are in it"
    );

    // A tile alone.
    let finest = seen.iter().find(|uri| uri.ends_with("-0.glb")).unwrap();
    let numbers: Vec<&str> =
        finest.trim_start_matches("tiles/").trim_end_matches(".glb").split(['/', '-']).collect();
    forest(&at, &["-o", "one", "--tile", &numbers.join(","), "--threads", "1"]);
    let one = files(&at.join("one"));
    assert_eq!(one.keys().filter(|p| p.starts_with("tiles")).count(), 1);
    for (path, bytes) in one.iter().filter(|(p, _)| p.as_path() != Path::new("unfinished.jsonl")) {
        assert_eq!(Some(bytes), whole.get(path), "{}", path.display());
    }

    // Again: nothing is made, and damaged or missing files are restored.
    fs::write(at.join("all").join(finest), b"damaged").unwrap();
    fs::remove_file(at.join("all").join(&seen[0])).unwrap();
    let again = forest(&at, &["-o", "all", "--map", "plan.png", "--glb", "--usd"]);
    assert_eq!(again["forest"]["written"], 2);
    assert!(files(&at.join("all")) == whole, "the same files");
}

#[test]
fn a_forest_that_was_killed_is_carried_on() {
    let at = folder("forest-killed");
    inventory(&at, TREES);
    forest(&at, &["-o", "all"]);
    let whole = files(&at.join("all"));
    let all = [&["forest", "trees.csv", "-q", "-o", "again"], LIGHT].concat();
    let mut child = Command::new(env!("CARGO_BIN_EXE_burgeon"))
        .args(&all)
        .current_dir(&at)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // As soon as anything is recorded.
    let (journal, end) = (at.join("again/unfinished.jsonl"), Instant::now() + Duration::from_secs(120));
    while !journal.exists() && child.try_wait().unwrap().is_none() && Instant::now() < end {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    // Existing files are not said to be whole, unless they are.
    assert!(at.join("again/tileset.json").exists() != journal.exists());
    forest(&at, &["-o", "again"]);
    assert!(files(&at.join("again")) == whole, "the same files");

    // Another forest in its place leaves nothing of the first.
    let text = fs::read_to_string(at.join("trees.csv")).unwrap();
    let few: Vec<&str> = text.lines().take(8).collect();
    fs::write(at.join("trees.csv"), few.join("\n")).unwrap();
    forest(&at, &["-o", "again"]);
    forest(&at, &["-o", "fresh"]);
    assert!(files(&at.join("again")) == files(&at.join("fresh")), "the same files");
}

#[test]
fn bad_input_of_a_forest_is_one_line() {
    let at = folder("forest-bad");
    inventory(&at, TREES);
    fs::create_dir(at.join("full")).unwrap();
    fs::write(at.join("full/notes.txt"), "mine").unwrap();
    fs::write(at.join("tree.csv"), "x,y,species\n0,0,quercos robor\n").unwrap();
    fs::write(at.join("stand.toml"), "[[species]]\nname = \"birch\"\n").unwrap();
    let cases: &[(&[&str], &str)] = &[
        (&["trees.csv", "-o", "full"], "other files in it"),
        (&["trees.csv", "-o", "trees.csv"], "is a file"),
        (&["trees.csv", "-o", "new", "--finest", "3", "--lods", "1"], "--finest 3"),
        (&["trees.csv", "-o", "new", "--level", "1"], "--level is for --glb and --usd"),
        (&["trees.csv", "-o", "new", "--glb", "--level", "6"], "none of the levels"),
        (&["trees.csv", "-o", "new", "--place", "200,0,0"], "longitude"),
        (&["trees.csv", "-o", "new", "--tile", "1,2"], "four whole numbers"),
        (&["trees.csv", "-o", "new", "--map", "plan.jpg"], "PNG"),
        (&["trees.csv", "-o", "new", "--map", "trees.csv"], "trees.csv"),
        (&["trees.csv", "-o", "new", "--heights", "1,2"], "--ground"),
        (&["tree.csv", "-o", "new"], "--species NAME"),
        (&["stand.toml", "-o", "new", "--crs", "utm"], "--crs is for inventories"),
        (&["nothing.csv", "-o", "new"], "no such file"),
    ];
    for (args, said) in cases {
        let line = bad(&at, &[&["forest"], *args].concat());
        assert!(line.contains(said), "{args:?}: {line}");
        assert!(!at.join("new").exists(), "{args:?} leaves no folder");
    }
    assert_eq!(fs::read_to_string(at.join("full/notes.txt")).unwrap(), "mine");
}
