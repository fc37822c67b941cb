//! Files of users: inputs are never replaced, outputs are whole, and a refused command changes nothing.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::missing;
use crate::tools;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use tools::{FLOWER, bad, burgeon, folder, good, names, status};

/// Returns everything below a folder: links with their targets, files with their bytes.
fn all(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for name in names(folder) {
        let path = folder.join(&name);
        if let Ok(link) = fs::read_link(&path) {
            files.insert(name, link.into_os_string().into_encoded_bytes());
        } else if path.is_dir() {
            files.extend(all(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
            files.insert(name + "/", Vec::new());
        } else {
            files.insert(name, fs::read(&path).unwrap());
        }
    }
    files
}

/// Checks that the command is refused with one line that holds these parts, and every file is unchanged.
fn refused(folder: &Path, args: &[&str], parts: &[&str]) {
    let before = all(folder);
    let line = bad(folder, args);
    assert!(parts.iter().all(|p| line.contains(p)), "{args:?} said {line:?} without {parts:?}");
    let after = all(folder);
    let [a, b] = [&before, &after].map(|files| files.keys().collect::<Vec<_>>());
    assert_eq!(a, b, "{args:?}");
    let changed = before.iter().filter(|(name, bytes)| after[*name] != **bytes).map(|(name, _)| name);
    assert_eq!(changed.collect::<Vec<_>>(), Vec::<&String>::new(), "{args:?}");
}

const INPUT: &str = "would replace the input";
const SAME: &str = "name the same file; give one another name";

const BOX: &str = "v 3 0 3\nv 4 0 3\nv 3 1 3\nv 3 0 4\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n";
const SMALL: &str = "[method]\nkind = \"competition\"\npoints = 60\n";

fn fixture(name: &str) -> String {
    format!("{}/../../fixtures/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// Writes a picture of a few pixels.
fn png(folder: &Path, name: &str) {
    fs::write(folder.join("box.obj"), BOX).unwrap();
    good(folder, &["render", "box.obj", "-o", name, "--size", "8x8"]);
}

#[test]
fn a_texture_that_was_read_is_not_replaced_by_one_that_is_written() {
    let dir = folder("files-leaf");
    fs::copy(fixture("leaves/leaf1.csv"), dir.join("leaf1.csv")).unwrap();
    png(&dir, "l-leaf.png");
    refused(
        &dir,
        &["leaf", "leaf1.csv", "-o", "l.obj", "--texture", "l-leaf.png"],
        &["l-leaf.png: a texture of -o", INPUT],
    );
    for (option, name) in [("--png", "l-leaf.png"), ("--marks", "leaf1.csv"), ("--report", "leaf1.csv")] {
        let args = ["leaf", "leaf1.csv", "-o", "x.glb", "--texture", "l-leaf.png", option, name];
        refused(&dir, &args, &[name, option, INPUT]);
    }
    refused(&dir, &["leaf", "leaf1.csv", "-o", "l.obj", "--png", "l-leaf.png"], &["l-leaf.png", SAME]);
    refused(&dir, &["leaf", "--template", "leaf1.csv", "-o", "leaf1.csv"], &["-o", INPUT]);
    // Not an input: from an earlier run.
    good(&dir, &["leaf", "leaf1.csv", "-o", "l.obj"]);
    good(&dir, &["leaf", "leaf1.csv", "-o", "l.obj", "--surface", "bezier"]);
}

#[test]
fn obstacles_meshes_and_leaves_of_a_tree_are_kept() {
    let dir = folder("files-grow");
    fs::write(dir.join("ob-lod1.obj"), BOX).unwrap();
    fs::write(dir.join("house.obj"), BOX).unwrap();
    fs::write(dir.join("leaf.obj"), "v 0 0 0\nv 0.02 0.03 0\nv 0 0.06 0\nv -0.02 0.03 0\nf 1 2 3 4\n")
        .unwrap();
    fs::write(dir.join("small.toml"), SMALL).unwrap();
    let named = format!(
        "{SMALL}[[obstacles]]\nshape = \"mesh\"\nfile = \"house.obj\"\n[blade]\nfile = \"leaf.obj\"\n"
    );
    fs::write(dir.join("named.toml"), named).unwrap();
    let args = ["grow", "small.toml", "-o", "ob.obj", "--lods", "1", "--obstacle", "ob-lod1.obj"];
    refused(&dir, &args, &["ob-lod1.obj: --lods", INPUT]);
    for (name, by) in [("house.obj", "-o"), ("leaf.obj", "-o")] {
        refused(&dir, &["grow", "named.toml", "-o", name], &[name, by, INPUT]);
    }
    for report in ["t-lod1.obj", "t-lod1.mtl", "t.mtl", "T.OBJ", "t-bark-young.png"] {
        let args = ["grow", "small.toml", "-o", "t.obj", "--lods", "1", "--report", report];
        refused(&dir, &args, &[report, "--report", SAME]);
    }
    let args = ["grow", "small.toml", "-o", "t.obj", "--leaf-template", "leaf.obj", "--report", "leaf.obj"];
    refused(&dir, &args, &["--report", INPUT]);
}

#[test]
fn what_a_model_names_is_kept() {
    let dir = folder("files-convert");
    png(&dir, "t-wood.png");
    fs::write(dir.join("t.mtl"), "newmtl wood\nmap_Kd t-wood.png\n").unwrap();
    let uv = "vt 0 0\nvt 1 0\nvt 0 1\n";
    fs::write(dir.join("a.obj"), format!("mtllib t.mtl\n{}{uv}usemtl wood\nf 1/1 2/2 3/3\n", &BOX[..32]))
        .unwrap();
    refused(&dir, &["convert", "a.obj", "-o", "t.obj"], &["t.mtl: the materials of -o", INPUT]);
    refused(&dir, &["convert", "a.obj", "-o", "t.usda"], &["t-wood.png: a texture of -o", INPUT]);
    refused(&dir, &["convert", "a.obj", "-o", "x.glb", "--png", "t-wood.png"], &["--png", INPUT]);
    refused(&dir, &["convert", "a.obj", "-o", "x.glb", "--report", "t.mtl"], &["--report", INPUT]);
    refused(&dir, &["info", "a.obj", "--report", "t.mtl"], &["--report", INPUT]);
    refused(&dir, &["render", "a.obj", "-o", "t-wood.png"], &["-o", INPUT]);
    let numbers: Vec<u8> =
        [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    fs::write(dir.join("p.bin"), &numbers).unwrap();
    let gltf = r#"{"asset": {"version": "2.0"}, "buffers": [{"uri": "p.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0}"#;
    fs::write(dir.join("a.gltf"), gltf).unwrap();
    good(&dir, &["info", "a.gltf"]);
    refused(&dir, &["convert", "a.gltf", "-o", "x.obj", "--report", "p.bin"], &["p.bin", "--report", INPUT]);
    // Named, but not read, because we cannot use it. Or outside the model's folder.
    fs::create_dir(dir.join("sub")).unwrap();
    fs::write(dir.join("sub/b.mtl"), "newmtl wood\nmap_Bump -bm 0.2 n.png\nmap_Kd ../t-wood.png\n").unwrap();
    fs::write(dir.join("sub/b.obj"), format!("mtllib b.mtl\n{BOX}")).unwrap();
    fs::copy(dir.join("t-wood.png"), dir.join("sub/n.png")).unwrap();
    for name in ["sub/n.png", "t-wood.png"] {
        let args = ["convert", "sub/b.obj", "-o", "x.glb", "--trust-paths", "--png", name];
        refused(&dir, &args, &["--png", INPUT]);
    }
    let names = r#"{"asset": {"version": "2.0"}, "images": [{"uri": "sub/n.png"}, {"uri": "data:,"}], "#;
    let named = gltf.replacen(r#"{"asset": {"version": "2.0"}, "#, names, 1);
    fs::write(dir.join("b.gltf"), &named).unwrap();
    refused(&dir, &["convert", "b.gltf", "-o", "x.obj", "--png", "sub/n.png"], &["--png", INPUT]);
    let json = format!("{named:width$}", width = named.len().next_multiple_of(4)).into_bytes();
    let [all, part] = [20 + json.len(), json.len()].map(|n| u32::try_from(n).unwrap().to_le_bytes());
    let glb = [&b"glTF\x02\0\0\0"[..], &all, &part, b"JSON", &json].concat();
    fs::write(dir.join("b.glb"), glb).unwrap();
    for name in ["sub/n.png", "p.bin"] {
        refused(&dir, &["convert", "b.glb", "-o", "x.obj", "--report", name], &["--report", INPUT]);
    }
    // A model may be converted into the same folder.
    good(&dir, &["convert", "a.obj", "-o", "a.ply"]);
}

#[test]
fn drawings_and_their_settings_are_kept() {
    let dir = folder("files-sketch");
    fs::write(dir.join("s.svg"), FLOWER).unwrap();
    fs::write(dir.join("c.json"), r#"{"0": "axis"}"#).unwrap();
    fs::write(dir.join("spec.json"), r#"{"height_m": 2}"#).unwrap();
    fs::write(dir.join("leaf.obj"), "v 0 0 0\nv 0.02 0.03 0\nv 0 0.06 0\nv -0.02 0.03 0\nf 1 2 3 4\n")
        .unwrap();
    let sketch = ["sketch", "s.svg", "-o", "s.obj", "--classes", "c.json", "--spec", "spec.json"];
    let with = |more: &[&'static str]| [&sketch[..], &["--leaf-template", "leaf.obj"], more].concat();
    for (more, parts) in [
        (&["--png", "s-leaf.png"][..], ["--png and a texture of -o", SAME]),
        (&["--report", "s.mtl"], ["--report and the materials of -o", SAME]),
        (&["--report", "c.json"], ["--report", INPUT]),
        (&["--report", "spec.json"], ["--report", INPUT]),
    ] {
        refused(&dir, &with(more), &parts);
    }
    refused(&dir, &["sketch", "s.svg", "-o", "leaf.obj", "--leaf-template", "leaf.obj"], &["-o", INPUT]);
    good(&dir, &with(&["--png", "s.png", "--report", "s.json", "--qsm", "s.csv"]));
    assert_eq!(good(&dir, &["convert", "s.svg", "-o", "d.json", "-q"]), "");
    let before = all(&dir);
    good(&dir, &with(&["--png", "s.png", "--qsm", "s.csv", "--threads", "1"]));
    assert!(before == all(&dir), "the same again, in the place of what was there");
}

#[test]
fn laws_scans_and_edits_are_kept() {
    let dir = folder("files-bloom");
    let scan = |length: f64| -> String {
        let points = (0..200).map(|k| (f64::from(k % 10) - 4.5, f64::from(k / 10)));
        points.map(|(u, v)| format!("{} {} {}\n", 0.02 * u * length, 0.05 * v, 0.05 * v * length)).collect()
    };
    let mut stages = String::from("unit = \"mm\"\nsplit = \"none\"\nclean = false\n");
    for (day, length) in [(0, 20.0), (2, 31.0), (4, 42.0), (7, 50.0)] {
        fs::write(dir.join(format!("s{day}.xyz")), scan(length)).unwrap();
        stages += &format!("[[stage]]\nfile = \"s{day}.xyz\"\nday = {day}\n");
    }
    fs::write(dir.join("stages.toml"), stages).unwrap();
    let fit = ["bloom", "fit", "stages.toml", "-o"];
    for (more, parts) in [
        (&["stages.toml"][..], ["stages.toml: -o", INPUT]),
        (&["s2.xyz"], ["s2.xyz: -o", INPUT]),
        (&["law.json", "--plot", "s7.xyz"], ["s7.xyz: --plot", INPUT]),
        (&["law.json", "--report", "s7.xyz"], ["s7.xyz: --report", INPUT]),
        (&["law.json", "--report", "law.json"], ["-o and --report", SAME]),
    ] {
        refused(&dir, &[&fit[..], more].concat(), &parts);
    }
    good(&dir, &[&fit[..], &["law.json"]].concat());
    good(&dir, &["bloom", "run", "stages.toml", "--law", "law.json", "--day", "3", "-o", "day3.ply", "-q"]);
    let run = ["bloom", "run", "day3.ply", "--end", "s7.xyz", "--law", "law.json", "--whole", "--no-clean"];
    let with = |more: &[&'static str]| [&run[..], &["--unit", "mm"], more].concat();
    refused(&dir, &with(&["--day", "4", "-o", "day3.ply"]), &["day3.ply: -o", INPUT]);
    refused(
        &dir,
        &with(&["--day", "4", "-o", "x.ply", "--report", "law.json"]),
        &["law.json: --report", INPUT],
    );
    let compared = with(&["--day", "4", "-o", "x.ply", "--compare", "s4.xyz", "--report", "s4.xyz"]);
    refused(&dir, &compared, &["s4.xyz: --report", INPUT]);
    refused(&dir, &["bloom", "run", "rose", "-o", "x.glb", "--png", "x.jpg"], &["x.jpg", ".png"]);
    fs::write(dir.join("petal.obj"), "v 0 0 0\nv 0.02 0.03 0\nv 0 0.06 0\nv -0.02 0.03 0\nf 1 2 3 4\n")
        .unwrap();
    let own = ["bloom", "run", "rose", "--petal", "petal.obj", "--day", "3", "-o", "petal.obj"];
    refused(&dir, &own, &["petal.obj: -o", INPUT]);
    // A folder that was made for frames is removed with them.
    let frames = ["bloom", "run", "lily", "--frames", "2", "-o", "a/b", "--report", "a/b/lily-001.glb"];
    refused(&dir, &frames, &["lily-001.glb: --report and -o", SAME]);
    fs::create_dir_all(dir.join("a/b")).unwrap();
    refused(&dir, &frames, &["lily-001.glb: --report and -o", SAME]);
    refused(&dir, &["bloom", "run", "day3.ply", "-o", "new/frames"], &["--end is missing"]);
    good(
        &dir,
        &["bloom", "run", "lily", "--frames", "2", "-o", "lily", "--report", "lily/report.json", "-q"],
    );
    good(
        &dir,
        &["bloom", "run", "lily", "--frames", "2", "-o", "lily", "--report", "lily/report.json", "-q"],
    );
    assert_eq!(names(&dir.join("lily")), ["lily-000.glb", "lily-001.glb", "report.json"]);

    fs::write(dir.join("small.toml"), SMALL).unwrap();
    let cut = r#"{"schema": "burgeon.edits/1", "edits": [{"op": "prune", "axis": {"path": [0, 0]}}]}"#;
    fs::write(dir.join("edits.json"), cut).unwrap();
    let shape = ["shape", "small.toml", "--edits", "edits.json", "-o"];
    refused(
        &dir,
        &[&shape[..], &["x.glb", "--report", "edits.json"]].concat(),
        &["edits.json: --report", INPUT],
    );
    refused(&dir, &[&shape[..], &["x.obj", "--lods", "1", "--report", "x-lod1.mtl"]].concat(), &[SAME]);
}

/// Makes four drawings whose models, textures and pictures would share names, and names of other languages.
fn batch() -> String {
    let stem = r#"[[[0,3,9,10],[0,50,120,180]]]"#;
    let leaf = r#"[[[10,12,11],[200,120,20]],[[11,40,60,40,12],[120,80,90,120,121]]]"#;
    let drawing = |word: &str, drawing: &str| {
        format!("{{\"word\":\"\",\"key_id\":\"{word}\",\"drawing\":{drawing}}}\n")
    };
    let words =
        ["a", "a-leaf", "a-stem", "A", "a-", "花", "花 2", "é", "e\u{301}", "\u{202e}gpj.x", "CON", "a/../b"];
    words.iter().map(|w| drawing(w, if w.starts_with('a') { leaf } else { stem })).collect()
}

#[test]
fn files_of_one_drawing_are_not_those_of_another() {
    let dir = folder("files-batch");
    fs::write(dir.join("b.ndjson"), batch()).unwrap();
    for format in ["obj", "usda"] {
        let made = [1, 2, 8].map(|threads: u32| {
            let [out, threads] = [format!("{format}{threads}"), threads.to_string()];
            let args = ["sketch", "b.ndjson", "-o", &out, "--png", &out, "--qsm", &out, "--format", format];
            let args =
                [&args[..], &["--size", "16x12", "--threads", &threads, "--report", "r.json"]].concat();
            good(&dir, &args);
            all(&dir.join(&out))
        });
        assert!(made[0] == made[1] && made[0] == made[2], "files do not depend on threads");
        let endings = |e: &str| made[0].keys().filter(|n| n.ends_with(e) && !n.contains("--")).count();
        let plants = tools::json(&dir.join("r.json"))["ok"].clone();
        assert_eq!(plants, 12);
        for e in [&format!(".{format}"), ".csv", ".png"] {
            assert_eq!(endings(e), 12, "{e}: {:?}", made[0].keys());
        }
        // Each model has the textures that it names.
        let dir = dir.join(format!("{format}1"));
        for name in names(&dir).iter().filter(|n| n.ends_with(".obj")) {
            let info: serde_json::Value =
                serde_json::from_str(&good(&dir, &["info", name, "--json"])).unwrap();
            assert_eq!(info["model"]["warnings"], serde_json::json!([]), "{name}");
        }
    }
    for name in [
        "a.obj",
        "A-2.obj",
        "a-leaf.obj",
        "花.obj",
        "花-2.obj",
        "é.obj",
        "é-2.obj",
        "gpj.x.obj",
        "CON-drawing.obj",
    ] {
        assert!(dir.join("obj1").join(name).is_file(), "{name}: {:?}", names(&dir.join("obj1")));
    }
}

#[test]
fn names_of_other_languages_are_kept() {
    let dir = folder("files-unicode");
    let long = "花".repeat(70);
    for name in ["花", "Grüße 🌹", "हिन्दी", long.as_str()] {
        fs::write(dir.join(format!("{name}.svg")), FLOWER).unwrap();
    }
    let inputs = names(&dir);
    let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
    good(&dir, &[&["sketch"], &inputs[..], &["-o", "out/", "--format", "obj", "-q"]].concat());
    let models: Vec<String> = names(&dir.join("out")).into_iter().filter(|n| n.ends_with(".obj")).collect();
    let cut = format!("{}.obj", "花".repeat(66));
    assert_eq!(models, ["Grüße-🌹.obj", "हिन्दी.obj", "花.obj", cut.as_str()]);
    // The longest possible name: names of the files next to it are shorter.
    let model = format!("{}.obj", "花".repeat(83));
    good(&dir, &["sketch", "花.svg", "-o", &model]);
    let info: serde_json::Value = serde_json::from_str(&good(&dir, &["info", &model, "--json"])).unwrap();
    assert_eq!(info["model"]["warnings"], serde_json::json!([]));
}

#[test]
fn a_drawing_of_a_batch_whose_file_was_read_fails_alone() {
    let dir = folder("files-batch-input");
    fs::write(dir.join("b.ndjson"), batch()).unwrap();
    fs::create_dir(dir.join("out")).unwrap();
    fs::copy(fixture("leaves/leaf1.csv"), dir.join("out/a.csv")).unwrap();
    let before = fs::read(dir.join("out/a.csv")).unwrap();
    let args =
        ["sketch", "b.ndjson", "--qsm", "out", "--leaf-template", "out/a.csv", "--report", "out/花.csv"];
    let out = burgeon(&dir, &args);
    let said = String::from_utf8(out.stderr.clone()).unwrap();
    assert_eq!(status(&out), 2, "{said}");
    assert!(
        said.contains("a.csv: --qsm would replace the input") && said.contains("花.csv: --report and --qsm"),
        "{said}"
    );
    assert_eq!(fs::read(dir.join("out/a.csv")).unwrap(), before);
    let report = tools::json(&dir.join("out/花.csv"));
    assert_eq!((&report["ok"], &report["failed"]), (&10.into(), &2.into()));
}

#[test]
fn edits_that_all_fail_make_no_plant() {
    let dir = folder("files-edits");
    fs::write(dir.join("small.toml"), SMALL).unwrap();
    let prune =
        |path: &str, at: &str| format!(r#"{{"op": "prune", "axis": {{"path": {path}}}, "at": {at}}}"#);
    for (name, edits, parts) in [
        ("one.json", vec![prune("[0, 999]", "0")], ["its edit could not be done", "no branch number 999"]),
        (
            "two.json",
            vec![prune("[0, 999]", "0"), prune("[0, 998]", "0")],
            ["none of its 2 edits could be done", "no branch number 999"],
        ),
        ("far.json", vec![prune("[0, 0]", "0"), prune("[0, 1]", "1.5")], ["edit 1 (prune)", "at is 1.5"]),
        ("below.json", vec![prune("[0, 0]", "-0.25")], ["edit 0 (prune)", "at is -0.25"]),
        (
            "place.json",
            vec![r#"{"op": "move", "axis": {"path": [0, 1]}, "to": {"place": {"axis": {"path": [0]}, "at": 7}}}"#.into()],
            ["edit 0 (move)", "at is 7, "],
        ),
        (
            "drawn.json",
            vec![r#"{"op": "sketch-branch", "bearer": {"path": [0]}, "at": 1.01, "points": [[0, 3, 0], [1, 4, 0]]}"#.into()],
            ["edit 0 (sketch-branch)", "at is 1.01, "],
        ),
    ] {
        let text = format!(r#"{{"schema": "burgeon.edits/1", "edits": [{}]}}"#, edits.join(", "));
        fs::write(dir.join(name), text).unwrap();
        let args = ["shape", "small.toml", "--edits", name, "-o", "x.obj", "--png", "x.png", "--report", "x.json"];
        refused(&dir, &args, &[name, parts[0], parts[1]]);
        refused(&dir, &["shape", "small.toml", "--edits", name, "--list"], &parts);
    }
}

#[test]
fn drafts_of_processes_that_were_killed_are_swept() {
    let dir = folder("files-drafts");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    let day = std::time::Duration::from_secs(24 * 60 * 60 + 60);
    let old = std::time::SystemTime::now() - day;
    let stale = [".burgeon-17-0.part", ".burgeon-0123456789abcdef.part"];
    // Too young, another's name, a folder: these are not ours to remove.
    let kept = [".burgeon-17-1.part", ".burgeon-fedcba9876543210.part", ".burgeon-mine.part"];
    for name in stale.iter().chain(&kept) {
        fs::write(dir.join(name), "half").unwrap();
    }
    for name in stale.iter().chain(&kept[2..]) {
        fs::File::options().write(true).open(dir.join(name)).unwrap().set_modified(old).unwrap();
    }
    good(&dir, &["sketch", "rose.svg", "-o", "rose.glb", "--png", "rose.png", "--size", "16x12"]);
    let mut left: Vec<&str> = [&kept[..], &["rose.glb", "rose.png", "rose.svg"]].concat();
    left.sort_unstable();
    assert_eq!(names(&dir), left);
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    use std::process::{Command, Stdio};

    use super::*;

    #[test]
    fn an_input_is_known_by_any_of_its_names() {
        let dir = folder("files-links");
        fs::write(dir.join("a.obj"), BOX).unwrap();
        good(&dir, &["convert", "a.obj", "-o", "a.glb"]);
        fs::hard_link(dir.join("a.glb"), dir.join("hard.glb")).unwrap();
        symlink("a.glb", dir.join("soft.glb")).unwrap();
        fs::create_dir(dir.join("sub")).unwrap();
        symlink("../a.glb", dir.join("sub/soft.glb")).unwrap();
        symlink("sub", dir.join("other")).unwrap();
        fs::write(dir.join("x.ply"), "old").unwrap();
        fs::hard_link(dir.join("x.ply"), dir.join("y.png")).unwrap();
        for output in ["hard.glb", "soft.glb", "sub/../a.glb", "other/soft.glb", "./sub/soft.glb"] {
            refused(&dir, &["convert", "a.glb", "-o", output], &[output, INPUT]);
            refused(&dir, &["convert", output, "-o", "a.glb"], &["a.glb", INPUT]);
        }
        refused(&dir, &["convert", "a.glb", "-o", "x.ply", "--png", "y.png"], &["-o and --png", SAME]);
        refused(&dir, &["convert", "a.glb", "-o", "sub/z.obj", "--report", "other/z.MTL"], &[SAME]);
        let before = all(&dir);
        let stdin = fs::File::open(dir.join("a.glb")).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_burgeon"));
        let out =
            command.args(["convert", "-", "-o", "hard.glb"]).current_dir(&dir).stdin(stdin).output().unwrap();
        assert_eq!(status(&out), 2, "{out:?}");
        assert!(String::from_utf8(out.stderr).unwrap().contains(INPUT));
        assert!(before == all(&dir));
    }

    #[test]
    fn rights_are_kept_and_links_that_lead_nowhere_refused() {
        let dir = folder("files-rights");
        fs::write(dir.join("rose.svg"), FLOWER).unwrap();
        for (name, mode) in [("own.obj", 0o600), ("own.mtl", 0o640), ("wide.glb", 0o666)] {
            fs::write(dir.join(name), "old").unwrap();
            fs::set_permissions(dir.join(name), fs::Permissions::from_mode(mode)).unwrap();
        }
        symlink("own.obj", dir.join("link.obj")).unwrap();
        good(&dir, &["sketch", "rose.svg", "-o", "own.obj"]);
        good(&dir, &["sketch", "rose.svg", "-o", "link.obj"]);
        good(&dir, &["sketch", "rose.svg", "-o", "wide.glb"]);
        for (name, mode) in [("own.obj", 0o600), ("own.mtl", 0o640), ("wide.glb", 0o666)] {
            let data = fs::metadata(dir.join(name)).unwrap();
            assert_eq!((data.permissions().mode() & 0o777, data.len() > 3), (mode, true), "{name}");
        }
        symlink("nowhere/x.glb", dir.join("dangling.glb")).unwrap();
        symlink("round.glb", dir.join("round.glb")).unwrap();
        for name in ["dangling.glb", "round.glb"] {
            refused(&dir, &["sketch", "rose.svg", "-o", name], &[name, "leads to no file"]);
        }
        symlink("nowhere.mtl", dir.join("d.mtl")).unwrap();
        refused(&dir, &["sketch", "rose.svg", "-o", "d.obj"], &["d.mtl", "leads to no file"]);
    }

    /// Runs in a shell that lets no file grow beyond some kilobytes: a disk that becomes full half-way.
    fn cramped(dir: &Path, kilobytes: u32, args: &[&str]) -> std::process::Output {
        let script = format!("trap '' XFSZ; ulimit -f {}; exec \"$0\" \"$@\"", 2 * kilobytes);
        let mut command = Command::new("sh");
        command.args(["-c", &script, env!("CARGO_BIN_EXE_burgeon")]).args(args).current_dir(dir);
        command.stdin(Stdio::null()).output().unwrap()
    }

    #[test]
    fn a_disk_that_is_full_in_the_middle_leaves_everything_as_it_was() {
        let dir = folder("files-full");
        fs::write(dir.join("rose.svg"), FLOWER).unwrap();
        fs::write(dir.join("small.toml"), SMALL).unwrap();
        let sketch = [
            "sketch", "rose.svg", "-o", "r.obj", "--png", "r.png", "--size", "200x150", "--report", "r.json",
        ];
        let grow = ["grow", "small.toml", "-o", "g.obj", "--lods", "2", "--qsm", "g.csv"];
        let frames = ["bloom", "run", "tulip", "-o", "frames", "--frames", "3", "--format", "obj"];
        for args in [&sketch[..], &grow, &frames] {
            // First without earlier files, then over those of an earlier run.
            for earlier in [false, true] {
                if earlier {
                    good(&dir, args);
                    let made: Vec<String> = all(&dir).into_keys().filter(|n| !n.ends_with('/')).collect();
                    let made = made.iter().filter(|n| !["rose.svg", "small.toml"].contains(&n.as_str()));
                    made.for_each(|n| fs::write(dir.join(n), format!("earlier {n}")).unwrap());
                }
                let before = all(&dir);
                let mut failed = 0;
                for kilobytes in [0, 1, 4, 16, 64, 256] {
                    let out = cramped(&dir, kilobytes, args);
                    if out.status.success() {
                        break;
                    }
                    failed += 1;
                    let said = String::from_utf8(out.stderr.clone()).unwrap();
                    assert_eq!(status(&out), 2, "{args:?} in {kilobytes} kB: {said}");
                    assert!(said.lines().count() == 1 && said.contains("cannot be written"), "{said}");
                    assert!(before == all(&dir), "{args:?} in {kilobytes} kB: {:?}", names(&dir));
                }
                assert!(failed >= 4, "{args:?}: failed {failed} times");
            }
        }
    }

    #[test]
    fn what_standard_output_refuses_leaves_no_file() {
        let dir = folder("files-stdout");
        fs::write(dir.join("rose.svg"), FLOWER).unwrap();
        let Ok(full) = fs::File::options().write(true).open("/dev/full") else {
            return missing::skipped("/dev/full");
        };
        for args in [
            &["sketch", "rose.svg", "-o", "x.obj", "--json"][..],
            &["sketch", "rose.svg", "-o", "x.obj", "--report", "/dev/full"],
        ] {
            let before = all(&dir);
            let mut command = Command::new(env!("CARGO_BIN_EXE_burgeon"));
            let out =
                command.args(args).current_dir(&dir).stdout(full.try_clone().unwrap()).output().unwrap();
            assert_eq!(status(&out), 2, "{args:?}: {out:?}");
            assert!(before == all(&dir), "{args:?}: {:?}", names(&dir));
        }
    }
}
