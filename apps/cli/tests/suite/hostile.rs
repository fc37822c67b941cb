//! Mistakes and attacks of users: one clear line, status 2, and nothing broken.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::missing;
use crate::tools;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tools::{FLOWER, bad, burgeon, folder, good, json, names, status};

const STEM: &str = r#"{"word":"stem","key_id":"1","drawing":[[[0,3,9],[0,50,120]]]}"#;

/// Runs with `input` on standard input, through a pipe.
fn piped(folder: &Path, args: &[&str], input: &[u8]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_burgeon"));
    command.args(args).current_dir(folder);
    let pipes = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = pipes.spawn().unwrap();
    child.stdin.take().unwrap().write_all(input).unwrap();
    child.wait_with_output().unwrap()
}

#[test]
fn standard_input_is_read_from_a_pipe() {
    let dir = folder("stdin");
    for (args, input) in [
        (&["sketch", "-", "-o", "a.glb"][..], FLOWER.as_bytes()),
        (&["sketch", "-", "-o", "many/"], STEM.as_bytes()),
        (&["convert", "-", "-o", "b.json"], FLOWER.as_bytes()),
        (&["info", "-"], FLOWER.as_bytes()),
    ] {
        let out = piped(&dir, args, input);
        assert_eq!(status(&out), 0, "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
    }
    assert_eq!(names(&dir), ["a.glb", "b.json", "many"]);
    let glb = fs::read(dir.join("a.glb")).unwrap();
    assert_eq!(status(&piped(&dir, &["render", "-", "-o", "a.png", "--size", "40x30"], &glb)), 0);
    let out = piped(&dir, &["sketch", "-", "-o", "x.glb"], b"");
    assert_eq!(status(&out), 2);
    assert!(String::from_utf8_lossy(&out.stderr).contains("is empty"), "{out:?}");
}

/// Writes a blade of 60 mm in points, +Z up.
fn blade() -> String {
    let mut text = String::new();
    for i in 0..75 {
        for j in -22..=22 {
            let (x, y) = (f64::from(j) * 0.8, f64::from(i) * 0.8);
            let t = y / 60.0;
            if x.abs() < 72.0 * t * (1.0 - t) {
                text += &format!("{x:.3} {y:.3} {:.3}\n", 0.25 * x.abs() - 0.006 * (y - 20.0) * (y - 20.0));
            }
        }
    }
    text
}

#[test]
fn an_input_named_dash_is_what_the_file_would_be() {
    let dir = folder("dash");
    let put = |name: &str, text: &str| fs::write(dir.join(name), text).unwrap();
    put("a.xyz", &blade());
    put("b.xyz", &blade());
    put("rose.svg", FLOWER);
    put("small.toml", "[method]\nkind = \"competition\"\npoints = 200\n");
    put("classes.csv", "0,axis\n");
    let edits = r#"{"schema": "burgeon.edits/1", "edits": [{"op": "rotate", "axis": {"path": [0]}, "turn": {"about": [0, 1, 0], "degrees": 40}}]}"#;
    put("edits.json", edits);
    let mut stages = String::from("unit = \"mm\"\nsplit = \"none\"\n");
    for (file, day) in [("a.xyz", 0), ("b.xyz", 1), ("a.xyz", 2), ("b.xyz", 3)] {
        stages += &format!("[[stage]]\nfile = \"{file}\"\nday = {day}\nbase = [0, 0, 0]\n");
    }
    put("stages.toml", &stages);
    fs::copy(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/leaves/leaf1.csv"), dir.join("leaf.csv"))
        .unwrap();
    for (line, file) in [
        ("leaf --scan IN --unit mm --up z -o out.obj", "a.xyz"),
        ("leaf IN --texture plain -o out.obj", "leaf.csv"),
        ("grow --attractors IN --no-textures -o out.ply", "a.xyz"),
        ("grow IN --no-textures -o out.ply", "small.toml"),
        ("shape IN --edits edits.json --no-textures -o out.ply", "rose.svg"),
        ("shape IN --edits edits.json --no-textures -o out.ply", "small.toml"),
        ("shape rose.svg --edits IN --no-textures -o out.ply", "edits.json"),
        ("sketch rose.svg --classes IN --no-textures -o out.ply", "classes.csv"),
        ("sketch rose.svg --leaf-template IN --no-textures -o out.ply", "leaf.csv"),
        ("bloom run IN --day 1 -o out.ply", "stages.toml"),
        ("bloom run IN --end b.xyz --unit mm --whole --day 0.5 -o out.ply", "a.xyz"),
        ("convert IN --unit mm -o out.ply", "a.xyz"),
    ] {
        let run = |name: &str, input: &[u8]| {
            let args: Vec<&str> = line.split(' ').map(|a| if a == "IN" { name } else { a }).collect();
            let out = piped(&dir, &[&args[..], &["-q"]].concat(), input);
            let out_file = args[args.len() - 1];
            assert_eq!(status(&out), 0, "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
            let bytes = fs::read(dir.join(out_file)).unwrap();
            fs::remove_file(dir.join(out_file)).unwrap();
            bytes
        };
        let (named, dash) = (run(file, b""), run("-", &fs::read(dir.join(file)).unwrap()));
        // Names in an OBJ follow the input's.
        let bare = |b: Vec<u8>| -> Vec<String> {
            let text = String::from_utf8_lossy(&b).into_owned();
            text.lines().filter(|l| !l.starts_with(['#', 'o', 'g', 'm', 'u'])).map(str::to_owned).collect()
        };
        assert!(bare(named) == bare(dash), "{line} differs");
    }
    let before = names(&dir);
    let out = piped(&dir, &["sketch", "-", "--classes", "-", "-o", "x.glb"], b"0,axis\n");
    let line = String::from_utf8(out.stderr.clone()).unwrap();
    assert!(status(&out) == 2 && line.contains("only once"), "{line}");
    for (args, parts) in [
        (&["shape", "-", "--edits", "-", "-o", "x.glb"][..], ["standard input", "only once"]),
        (&["leaf", "--scan", "-", "-o", "x.glb"], ["standard input", "no scan"]),
        (&["grow", "--attractors", "-", "-o", "x.glb"], ["standard input", "no scan"]),
    ] {
        let out = piped(&dir, args, edits.as_bytes());
        let line = String::from_utf8(out.stderr.clone()).unwrap();
        let one = status(&out) == 2 && line.lines().count() == 1;
        assert!(one && parts.iter().all(|p| line.contains(p)), "{args:?}: {line}");
        assert_eq!(names(&dir), before);
    }
}

#[test]
fn days_and_points_beyond_single_precision_make_no_broken_file() {
    let dir = folder("beyond");
    fs::write(dir.join("a.xyz"), blade()).unwrap();
    fs::write(dir.join("far.xyz"), "0 0 1e90\n".repeat(40) + "0 0 0\n1 1 1\n").unwrap();
    let pair = ["bloom", "run", "a.xyz", "--end", "a.xyz", "--whole", "--unit", "mm", "-o", "out.ply"];
    // The motion before the first scan is unknown: the shape is that of its day.
    let points = |day: &str| {
        good(&dir, &[&pair[..], &["--day", day]].concat());
        fs::read(dir.join("out.ply")).unwrap()
    };
    assert!(points("-1e308") == points("-1"), "a shape of no size");
    fs::remove_file(dir.join("out.ply")).unwrap();
    good(&dir, &["convert", "far.xyz", "-o", "far.ply"]);
    assert!(good(&dir, &["info", "far.ply", "--json"]).contains("\"points\": 2"));
}

#[test]
fn lines_about_names_as_long_as_a_disk_takes_are_short() {
    let dir = folder("long-lines");
    for name in ["x".repeat(4000), format!("{}/y.json", "x/".repeat(1000))] {
        let line = bad(&dir, &["shape", "oak", "--edits", &name, "-o", "out.glb"]);
        assert!(line.chars().count() <= 400 && line.contains("cannot be read"), "{line}");
    }
}

#[test]
fn files_of_settings_are_checked() {
    let dir = folder("settings");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    fs::write(dir.join("low.json"), r#"{"height_m": -5}"#).unwrap();
    fs::write(dir.join("dense.json"), r#"{"fill": {"density": 1e300}}"#).unwrap();
    fs::write(dir.join("bytes.json"), b"{\"height_m\": \xff}").unwrap();
    fs::write(dir.join("low.toml"), "seed = 1\n").unwrap();
    fs::write(dir.join("thin.toml"), "read_as = \"tree\"\n\n[fill]\ndensity = 0.01\n").unwrap();
    fs::write(dir.join("word.json"), r#"{"fill": {"densty": 1}}"#).unwrap();
    fs::write(dir.join("list.json"), "[2]").unwrap();
    fs::write(dir.join("half.json"), "{\"height_m\":").unwrap();
    fs::write(dir.join("good.json"), r#"{"height_m": 2}"#).unwrap();
    fs::write(dir.join("good.toml"), "height_m = 2\n").unwrap();
    fs::File::create(dir.join("large.json")).unwrap().set_len(20 << 20).unwrap();
    let before = names(&dir);
    for (file, parts) in [
        ("low.json", ["height_m must be 0.001 to 1000 m", "not -5"]),
        ("dense.json", ["fill.density", "0.1 to 10"]),
        ("low.toml", ["line 1", "unknown field `seed`"]),
        ("thin.toml", ["line 4", "fill.density must be 0.1 to 10"]),
        ("word.json", ["fill", "unknown field `densty`"]),
        ("list.json", ["a spec is a JSON object", "a field for each"]),
        ("half.json", ["is not JSON", "EOF"]),
        ("bytes.json", ["UTF-8", "save it again"]),
        ("large.json", ["larger than 16 MiB", "right one"]),
    ] {
        let line = bad(&dir, &["sketch", "rose.svg", "-o", "x.glb", "--spec", file]);
        assert!(line.contains(file) && parts.iter().all(|p| line.contains(p)), "{file}: {line}");
        assert_eq!(names(&dir), before);
    }
    let line = bad(&dir, &["sketch", "rose.svg", "-o", "x.glb", "--classes", "large.json"]);
    assert!(line.contains("larger than 16 MiB"), "{line}");
    let info = |spec: &[&str]| -> f64 {
        good(&dir, &[&["sketch", "rose.svg", "-o", "x.glb", "-q"][..], spec].concat());
        let info: Value = serde_json::from_str(&good(&dir, &["info", "x.glb", "--json"])).unwrap();
        info["model"]["size"][1].as_f64().unwrap()
    };
    for spec in ["good.json", "good.toml"] {
        let ratio = info(&["--spec", spec]) / info(&["--height", "1"]);
        assert!((ratio - 2.0).abs() < 1e-3, "{spec}: {ratio}");
    }
}

#[test]
fn outputs_that_would_destroy_something_are_refused() {
    let dir = folder("clash");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    good(&dir, &["convert", "rose.svg", "-o", "rose.json"]);
    good(&dir, &["sketch", "rose.svg", "-o", "rose.glb"]);
    fs::create_dir(dir.join("folder")).unwrap();
    let before: Vec<(String, Vec<u8>)> =
        names(&dir).into_iter().map(|n| (n.clone(), fs::read(dir.join(&n)).unwrap_or_default())).collect();
    for (args, parts) in [
        (
            &["sketch", "rose.json", "-o", "x.glb", "--report", "rose.json"][..],
            ["--report", "replace the input"],
        ),
        (
            &["sketch", "rose.json", "-o", "folder", "--report", "./rose.json"],
            ["--report", "replace the input"],
        ),
        (
            &["sketch", "rose.svg", "-o", "x.glb", "--report", "folder/../x.glb"],
            ["-o and --report", "same file"],
        ),
        (&["convert", "rose.glb", "-o", "rose.glb"], ["-o", "replace the input"]),
        (&["convert", "rose.glb", "-o", "x.ply", "--png", "x.ply"], ["x.ply", "same file"]),
        (&["render", "rose.glb", "-o", "x.png", "--report", "rose.glb"], ["--report", "replace the input"]),
        (&["sketch", "rose.svg", "--png", "x.jpg"], ["x.jpg", ".png"]),
        (&["sketch", "rose.svg", "-o", "x.docx"], ["x.docx", ".glb"]),
        (&["sketch", "rose.svg", "-o", "rose.svg"], ["rose.svg", ".glb"]),
        (&["sketch", "rose.svg", "rose.json", "-o", "x.glb"], ["x.glb", "give a folder"]),
        (&["sketch", "rose.svg", "rose.json", "--png", "x.png"], ["x.png", "give a folder"]),
        (&["sketch", "rose.svg", "-o", "x.glb", "--png", "folder"], ["folder", "two files or two folders"]),
        (&["sketch", "rose.svg", "-o", "-"], ["-", "name a file"]),
        (&["sketch", "rose.svg", "-o", "rose.svg/x.glb"], ["rose.svg", "is a file, not a folder"]),
        (&["convert", "rose.glb", "-o", "x.obj", "--png", "x.txt"], ["x.txt", ".png"]),
    ] {
        let line = bad(&dir, args);
        assert!(parts.iter().all(|p| line.contains(p)), "{args:?} said {line:?} without {parts:?}");
        let after: Vec<(String, Vec<u8>)> = names(&dir)
            .into_iter()
            .map(|n| (n.clone(), fs::read(dir.join(&n)).unwrap_or_default()))
            .collect();
        assert!(before == after, "{args:?} changed something: {:?}", names(&dir));
    }
}

#[test]
fn numbers_out_of_range_are_named() {
    let dir = folder("numbers");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    for (option, value, part) in [
        ("--seed", "-1", "from 0 to 18446744073709551615"),
        ("--seed", "1.5", "whole number"),
        ("--seed", "18446744073709551616", "18446744073709551615"),
        ("--detail", "-1", "0.1 to 8"),
        ("--detail", "NaN", "0.1 to 8"),
        ("--height", "-1", "0.001 to 1000"),
        ("--height", "1e-300", "0.001 to 1000"),
        ("--density", "-0.5", "0.1 to 10"),
        ("--gravity", "-0.5", "0 to 1"),
    ] {
        let line = bad(&dir, &["sketch", "rose.svg", "-o", "x.glb", option, value]);
        assert!(line.contains(option) && line.contains(part), "{option} {value}: {line}");
    }
    good(&dir, &["sketch", "rose.svg", "--json", "--seed", "18446744073709551615"]);
    let out = burgeon(&dir, &["sketch", "rose.svg", "-o", "x.glb", "--flip-flowers", "7"]);
    assert_eq!(status(&out), 0);
    assert!(String::from_utf8_lossy(&out.stderr).contains("flower 7"), "{out:?}");
}

#[test]
fn a_file_of_noise_is_told_in_a_few_lines() {
    let dir = folder("noise");
    let noise = "not json\n".repeat(30_000) + STEM;
    fs::write(dir.join("noise.ndjson"), noise).unwrap();
    let out = burgeon(&dir, &["sketch", "noise.ndjson", "-o", "out/", "--report", "r.json"]);
    let errors = String::from_utf8(out.stderr.clone()).unwrap();
    assert_eq!(status(&out), 2);
    assert!(errors.lines().count() <= 21 && errors.contains("29,980 drawings more failed"), "{errors}");
    let report = json(&dir.join("r.json"));
    assert_eq!((&report["ok"], &report["failed"]), (&1.into(), &30_000.into()));
    let warnings = report["warnings"].as_array().unwrap();
    assert!(warnings.len() == 10_001, "{}", warnings.len());
    assert!(warnings[0].as_str().unwrap().contains("line 1"));
}

#[test]
fn odd_names_of_files_are_no_trouble() {
    let dir = folder("odd names");
    let long = format!("{}.glb", "x".repeat(251));
    for name in ["two words.obj", "Grüße 🌹.obj", "-dash.obj", long.as_str()] {
        fs::write(dir.join("in.svg"), FLOWER).unwrap();
        let out = format!("./{name}");
        good(&dir, &["sketch", "in.svg", "-o", &out, "-q"]);
        let info: Value = serde_json::from_str(&good(&dir, &["info", &out, "--json"])).unwrap();
        let materials = info["model"]["materials"].as_array().unwrap();
        assert!(materials.iter().any(|m| m["texture"].is_array()), "{name}: textures are found: {info:#}");
        assert_eq!(info["model"]["warnings"], serde_json::json!([]), "{name}");
    }
    assert!(names(&dir).iter().all(|n| !n.starts_with(".burgeon-")), "{:?}", names(&dir));
    let esc = r#"{"word":"a\u001b[2Jb","key_id":"1","drawing":[[[0],[0]]]}"#;
    fs::write(dir.join("esc.ndjson"), esc).unwrap();
    let out = burgeon(&dir, &["sketch", "esc.ndjson", "-o", "esc/"]);
    assert!(status(&out) == 2 && !out.stderr.contains(&0x1b), "{out:?}");
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _, symlink};

    use super::*;

    #[test]
    fn links_are_followed_and_protected_files_kept() {
        let dir = folder("links");
        fs::write(dir.join("rose.svg"), FLOWER).unwrap();
        fs::create_dir(dir.join("real")).unwrap();
        fs::write(dir.join("real/x.glb"), "old").unwrap();
        symlink("real/x.glb", dir.join("link.glb")).unwrap();
        good(&dir, &["sketch", "rose.svg", "-o", "link.glb"]);
        assert!(fs::symlink_metadata(dir.join("link.glb")).unwrap().is_symlink(), "the link is kept");
        assert!(fs::read(dir.join("real/x.glb")).unwrap().starts_with(b"glTF"), "its file is new");

        fs::write(dir.join("keep.glb"), "mine").unwrap();
        fs::set_permissions(dir.join("keep.glb"), fs::Permissions::from_mode(0o444)).unwrap();
        let line = bad(&dir, &["sketch", "rose.svg", "-o", "keep.glb"]);
        assert!(line.contains("write-protected"), "{line}");
        assert_eq!(fs::read_to_string(dir.join("keep.glb")).unwrap(), "mine");
        assert_eq!(names(&dir), ["keep.glb", "link.glb", "real", "rose.svg"]);
    }

    #[test]
    fn devices_are_written_and_not_replaced() {
        let dir = folder("devices");
        fs::write(dir.join("rose.svg"), FLOWER).unwrap();
        let said = good(&dir, &["sketch", "rose.svg", "-q", "--report", "/dev/stdout"]);
        assert_eq!(serde_json::from_str::<Value>(&said).unwrap()["ok"], 1);
        good(&dir, &["sketch", "rose.svg", "--report", "/dev/null"]);
        assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    }

    #[test]
    fn pipes_beside_a_model_are_not_waited_for() {
        let dir = folder("pipes");
        let made = Command::new("mkfifo").arg(dir.join("a.mtl")).status();
        if !made.is_ok_and(|s| s.success()) {
            return missing::skipped("mkfifo");
        }
        fs::write(dir.join("a.obj"), "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        let line = bad(&dir, &["info", "a.obj"]);
        assert!(line.contains("a.obj: names \"a.mtl\", which is a pipe, not a file"), "{line}");
    }
}
