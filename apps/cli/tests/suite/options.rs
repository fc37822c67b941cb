//! Every option of every command in every kind of use: it changes the output, or it is an error that names its users.
//! None is ignored.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;
use tools::{FLOWER, folder, good, status};

/// Options that steer how a command runs or reports, whatever it makes; -o is in each use.
const RUNNING: [&str; 11] = [
    "help",
    "version",
    "threads",
    "quiet",
    "seed",
    "report",
    "json",
    "output",
    "budget",
    "strict",
    "trust-paths",
];

/// A value other than the default, for each option that takes one.
const VALUES: &[(&str, &str)] = &[
    ("age", "1"),
    ("at", "2,0"),
    ("attractors", "points.xyz"),
    ("azimuth", "90"),
    ("background", "white"),
    ("ball", "2,3,0,0,0.02"),
    ("bounces", "1"),
    ("branch-depth", "paper"),
    ("by", "block"),
    ("cell", "0.2"),
    ("classes", "classes.csv"),
    ("compare", "end.xyz"),
    ("curl", "0.4"),
    ("date", "2026-05-11"),
    ("dates", "dmy"),
    ("day", "0.3"),
    ("days", "1,2"),
    ("dbh", "0.1"),
    ("density", "3"),
    ("depth", "0.2"),
    ("detail", "3"),
    ("diffuse", "40"),
    ("direct", "60"),
    ("drawing", "drawn.svg"),
    ("edits", "edits.json"),
    ("end", "start.xyz"),
    ("end-day", "30"),
    ("as", "fruit"),
    ("flip-flowers", "0"),
    ("for", "three"),
    ("format", "obj"),
    ("frame", "plant"),
    ("foliage", "cards"),
    ("frames", "3"),
    ("gap", "0"),
    ("graph", "palmate"),
    ("gravity", "0.9"),
    ("height", "3"),
    ("hour", "10"),
    ("impostor", "256"),
    ("in-unit", "mm"),
    ("in-up", "z"),
    ("influence", "0.9"),
    ("kill", "0.2"),
    ("lattice", "3x2x2"),
    ("law", "law.json"),
    ("leaf", "0.3,0.2"),
    ("leaf-depth", "paper"),
    ("leaf-keep", "0.3"),
    ("leaf-template", "leaf.csv"),
    ("leaves", "4"),
    ("length", "0.35"),
    ("list", "1"),
    ("lod-file", "one"),
    ("lods", "1"),
    ("marks", "found.csv"),
    ("materials", "materials.toml"),
    ("megabytes", "0.001"),
    ("method", "guided"),
    ("mtg", "structure.mtg"),
    ("number", "2"),
    ("obstacle", "box.obj"),
    ("parameters", "own"),
    ("pack", "quantized"),
    ("petal", "leaf.csv"),
    ("petals", "blue"),
    ("phototropism", "0.9"),
    ("pipe-exponent", "3"),
    ("place", "47,8"),
    ("plant", "1"),
    ("plot", "plot.svg"),
    ("png", "picture.png"),
    ("print-height", "40"),
    ("print-wall", "2"),
    ("qsm", "wood.csv"),
    ("rays", "3000"),
    ("regions", "2"),
    ("repeat", "3x3"),
    ("rings", "envelope"),
    ("root", "0,0,0.4"),
    ("rows", "4"),
    ("save", "saved.burgeon"),
    ("schema", "schema.json"),
    ("season", "0.5"),
    ("seconds", "2"),
    ("side-veins", "3"),
    ("sheet", "Notes"),
    ("sides", "5"),
    ("size", "30x20"),
    ("sky", "uniform"),
    ("sky-table", "sky.csv"),
    ("soil", "0.5"),
    ("spec", "spec.json"),
    ("split", "parts.burgeon"),
    ("start-day", "0.2"),
    ("step", "0.05"),
    ("subdivisions", "3"),
    ("sun", "170,40"),
    ("thickness-unit", "mm"),
    ("supersample", "2"),
    ("surface", "bezier"),
    ("texture", "veins"),
    ("textures", "256"),
    ("thickness", "radius"),
    ("trees", "40"),
    ("triangles", "100"),
    ("tropism", "0.9"),
    ("turbidity", "5"),
    ("unit", "cm"),
    ("up", "z"),
    ("variation", "0"),
    ("vein-weight", "9"),
    ("veins", "7"),
    ("venation", "palmate"),
    ("view", "side"),
    ("wilt", "0.6"),
    ("wood", "0.4"),
    ("zone", "2"),
    ("show", "oak"),
];

/// Kinds of use: a working command, to which each of its options is added.
const USES: &[&[&str]] = &[
    &["sketch", "rose.svg", "-o", "o.glb", "--no-textures"],
    &["sketch", "rose.svg", "-o", "o.mtg"],
    &["sketch", "rose.svg", "--qsm", "o.csv"],
    &["sketch", "rose.svg", "-o", "folder/", "--no-textures"],
    &["sketch", "one.burgeon", "-o", "o.glb", "--no-textures"],
    &["sketch", "scene.burgeon", "-o", "o.obj"],
    &["grow", "small.toml", "-o", "o.glb", "--no-textures"],
    &["grow", "bare.toml", "-o", "o.mtg"],
    &["grow", "bare.toml", "-o", "o.opf"],
    &["grow", "light.toml", "--png", "o.png", "--size", "40x30", "--no-textures"],
    &["leaf", "leaf.csv", "-o", "o.ply", "--texture", "plain"],
    &["leaf", "--template", "-o", "o.csv"],
    &["leaf", "--scan", "blade.xyz", "-o", "o.glb"],
    &["leaf", "--venation", "palmate", "-o", "o.glb"],
    &["leaf", "--venation", "parallel", "-o", "o.obj"],
    &["leaf", "rays.csv", "-o", "o.glb"],
    &["leaf", "graph.json", "-o", "o.glb", "--texture", "plain"],
    &["leaf", "leaf.csv", "--plant", "-o", "o.glb", "--texture", "plain"],
    &["leaf", "leaf.csv", "--plant", "-o", "o.mtg", "--texture", "plain"],
    &["bloom", "fit", "growth.csv", "-o", "o.json"],
    &["bloom", "run", "tulip", "-o", "o.glb", "--day", "2"],
    &["bloom", "run", "rose.svg", "-o", "o.obj"],
    &["bloom", "run", "rose", "-o", "o.mtg"],
    &["bloom", "run", "start.xyz", "--end", "end.xyz", "-o", "o.ply", "--day", "0.4"],
    &["bloom", "run", "start.xyz", "--plant", "-o", "o.glb"],
    &["light", "small.toml", "-o", "o.csv"],
    &["light", "small.toml", "-o", "o.glb"],
    &["light", "rose.svg", "--sun", "180,50", "--direct", "90", "--png", "o.png", "--size", "40x30"],
    &["light", "small.toml", "--place", "48,2", "--date", "2026-06-21", "-o", "o.csv"],
    &["shape", "small.toml", "--edits", "edits.json", "-o", "o.glb", "--no-textures"],
    &["shape", "rose.svg", "--edits", "edits.json", "-o", "o.mtg"],
    &["shape", "one.burgeon", "--edits", "edits.json", "-o", "o.glb"],
    &["shape", "--template"],
    &["convert", "rose.svg", "-o", "o.json"],
    &["convert", "points.xyz", "-o", "o.ply"],
    &["convert", "box.obj", "-o", "o.glb"],
    &["render", "box.obj", "-o", "o.png", "--size", "40x30", "--view", "turntable"],
    &["render", "box.glb", "-o", "o.png", "--size", "40x30", "--view", "front"],
    &["scan", "stem.xyz", "-o", "o.glb", "--no-textures"],
    &["scan", "stem.xyz", "--qsm", "o.csv"],
    &["scan", "stem.xyz", "--all", "-o", "folder/", "--no-textures"],
    &["species", "fit", "trees.csv", "-o", "o.toml"],
    &["info", "box.obj"],
    &["info", "box.glb"],
    &["info", "rose.svg"],
];

/// Options that apply to such input, but have nothing to change in this one: no contour to fill, no branch other than
/// the stem, one plant, veins as thick as the sides of the finest need.
const NOTHING_TO_STEER: &[(&str, &[&str])] = &[
    ("one.burgeon", &["branch-depth", "density", "tropism", "phototropism", "gravity", "sides", "plant"]),
    // From the front at eye level the ground, and a shadow on it, is a line.
    ("--view", &["no-shadow"]),
    // Its days are numbers.
    ("growth.csv", &["dates"]),
    // The scan is of a bare stem.
    ("--plant", &["materials"]),
    // A stem is bare and has no gap, and a trunk its sides by its girth.
    ("stem.xyz", &["gap", "sides", "materials"]),
];

const SMALL: &str = r#"
name = "small"
[method]
kind = "colonization"
points = 60
envelope = { shape = "sphere", centre = [0.0, 1.0, 0.0], radius_m = 0.5 }
[method.steps]
attraction_m = 0.8
kill_m = 0.3
"#;

const BOX: &str = "v 0.2 0.7 -1\nv 2 0.7 -1\nv 2 0.7 1\nv 0.2 0.7 1\nv 0.2 2 -1\nv 2 2 -1\nv 2 2 1\nv 0.2 2 1\n\
                   f 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

/// Writes the files for all uses.
fn inputs(dir: &Path) {
    let write = |name: &str, text: &str| fs::write(dir.join(name), text).unwrap();
    // A branch with a contour that twigs fill, for density, tropism and similar options.
    let contour = r##"<path id="branch-contour" fill="none" stroke="#000" d="M101 270C130 262 160 262 176 274C160 286 130 284 101 272"/></svg>"##;
    write("rose.svg", &FLOWER.replace("</svg>", contour));
    write("classes.csv", "1,axis\n");
    write("growth.csv", "day,size\n0,1\n1,2\n2,3.5\n4,5\n6,5.5\n");
    write("trees.csv", &crate::species::trees(6, 5));
    write("spec.json", r#"{"height_m": 2}"#);
    let shaded = "pattern = \"shaded\"\ncolor = \"#aa3355\"";
    write("materials.toml", &format!("[leaf]\n{shaded}\n[petal]\n{shaded}\n"));
    write("small.toml", SMALL);
    write("sky.csv", "azimuth,elevation,par\n0,30,20\n180,60,70\n");
    write("bare.toml", &format!("bare = true\n{SMALL}"));
    write(
        "light.toml",
        "name = \"light\"\n[method]\nkind = \"self-organizing\"\nyears = 3\n[look]\nautumn_color = \"#d9a437\"\n",
    );
    write("box.obj", BOX);
    good(dir, &["convert", "box.obj", "-o", "box.glb", "--quiet"]);
    // Two stems of which the second is not as tall, with the ground under them.
    write("stem.xyz", &crate::words::stems(&[(0.0, 3.0), (2.0, 2.4)]));
    let points: Vec<String> = (0..200)
        .map(|i| {
            // Even steps of an irrational number fill a square.
            let [x, z] = [0.618, 0.414].map(|step: f64| (f64::from(i) * step).fract() - 0.5);
            format!("{x} {} {z}", 0.3 + f64::from(i % 40) * 0.02)
        })
        .collect();
    write("points.xyz", &points.join("\n"));
    // Two sheets, the second longer and bent: a blade of 0.1 m.
    for (name, length, bend) in [("start.xyz", 0.1, 0.0), ("end.xyz", 0.14, 0.03), ("blade.xyz", 0.1, 0.01)] {
        let sheet = (0..1200).map(|i| {
            let (u, v) = (f64::from(i % 60) / 59.0, f64::from(i / 60) / 19.0 - 0.5);
            let half = 0.12 * u * (1.0 - u) + 0.002;
            // The longer one leans: control points that turn with it take another path.
            let (s, c) = if bend > 0.02 { (0.6, 0.8) } else { (0.0, 1.0) };
            let (y, z) = (length * u, bend * u * u);
            format!("{:.5} {:.5} {:.5}", 2.0 * v * half, c * y - s * z, s * y + c * z)
        });
        // And a stray point.
        let sheet = sheet.chain(["0.3 0.3 0.3".to_owned()].into_iter().filter(|_| name != "blade.xyz"));
        write(name, &sheet.collect::<Vec<_>>().join("\n"));
    }
    let edits = r#"{"schema": "burgeon.edits/1", "edits": [{"op": "rotate", "axis": {"path": [0]}, "turn": {"about": [0, 0, 1], "degrees": 30}}]}"#;
    write("edits.json", edits);
    let leaf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/leaves/leaf1.csv");
    // Without the lines that give thickness, unit and axis, which override the options.
    let text = fs::read_to_string(leaf).unwrap();
    let rows: Vec<&str> = text.lines().filter(|l| !l.starts_with('#')).collect();
    write("leaf.csv", &rows.join("\n"));
    good(dir, &["leaf", "--venation", "palmate", "-o", "x.glb", "--marks", "rays.csv"]);
    let rays = fs::read_to_string(dir.join("rays.csv")).unwrap();
    let rows: Vec<&str> = rays.lines().filter(|l| !l.starts_with('#')).collect();
    write("rays.csv", &rows.join("\n"));
    // A midrib of 101 nodes with eight pairs of side veins, as on a scanner.
    let mut nodes: Vec<String> =
        (0..=100).map(|k| format!("[500,{},{}]", 10 * k, 6.0 - 0.04 * f64::from(k))).collect();
    let mut edges: Vec<String> = (0..100).map(|k| format!("[{k},{}]", k + 1)).collect();
    for (pair, side) in (0..8).flat_map(|pair| [(pair, -1.0), (pair, 1.0)]) {
        let at = 4 + 11 * pair;
        let mut last = at;
        for i in 1..=12 {
            let t = f64::from(i) / 12.0 * (300.0 - 2.5 * at as f64);
            edges.push(format!("[{last},{}]", nodes.len()));
            last = nodes.len();
            nodes.push(format!("[{},{},2]", 500.0 + side * t, 10.0 * at as f64 + 0.5 * t));
        }
    }
    write(
        "graph.json",
        &format!(
            "{{\"unit\": \"pixel\", \"nodes_xyr\": [{}], \"edges\": [{}]}}",
            nodes.join(","),
            edges.join(",")
        ),
    );
    fs::remove_file(dir.join("x.glb")).unwrap();
}

/// Returns the options that a command's help lists, and whether a value follows.
fn listed(dir: &Path, use_: &[&str]) -> Vec<(String, bool)> {
    let words = if ["bloom", "species"].contains(&use_[0]) { 2 } else { 1 };
    let help = good(dir, &[&use_[..words], &["--help"]].concat());
    let option = |line: &str| {
        let line = line.trim_start();
        let after_short = line.get(4..).filter(|_| line.starts_with('-') && line.get(2..4) == Some(", "));
        let mut words = after_short.unwrap_or(line).split_whitespace();
        let name = words.next()?.strip_prefix("--")?.trim_end_matches("...").to_owned();
        Some((name, words.next().is_some_and(|w| w.starts_with(['<', '[']))))
    };
    help.lines().take_while(|l| !l.starts_with("Examples")).filter_map(option).collect()
}

/// Returns the results of a command: its files and what it printed, without times.
fn made(dir: &Path, scratch: &Path, args: &[&str]) -> (i32, String, BTreeMap<String, Vec<u8>>) {
    let _ = fs::remove_dir_all(scratch);
    fs::create_dir_all(scratch).unwrap();
    for entry in fs::read_dir(dir).unwrap() {
        let entry = entry.unwrap();
        fs::hard_link(entry.path(), scratch.join(entry.file_name())).unwrap();
    }
    let report = ["--report", "report.json"];
    let with_report = !args.contains(&"--template") && !args.contains(&"--list");
    let all = if with_report { [args, &report].concat() } else { args.to_vec() };
    let mut command = Command::new(env!("CARGO_BIN_EXE_burgeon"));
    let out = command.args(&all).current_dir(scratch).stdin(Stdio::null()).output().unwrap();
    let mut files = BTreeMap::new();
    let mut folders = vec![scratch.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let mut bytes = fs::read(&path).unwrap();
            let name = path.strip_prefix(scratch).unwrap().to_string_lossy().into_owned();
            if name == "report.json" {
                let mut value: Value = serde_json::from_slice(&bytes).unwrap();
                forget_times(&mut value);
                bytes = value.to_string().into_bytes();
            }
            files.insert(name, bytes);
        }
    }
    let printed = if with_report { String::new() } else { String::from_utf8_lossy(&out.stdout).into_owned() };
    files.insert("standard output".into(), printed.into_bytes());
    (status(&out), String::from_utf8_lossy(&out.stderr).into_owned(), files)
}

fn forget_times(value: &mut Value) {
    match value {
        Value::Object(map) => {
            map.remove("timings_ms");
            map.values_mut().for_each(forget_times);
        }
        Value::Array(rows) => rows.iter_mut().for_each(forget_times),
        _ => {}
    }
}

/// Returns the options that a use ignores.
fn ignored(dir: &Path, scratch: &Path, use_: &[&str]) -> Vec<String> {
    let (code, said, plain) = made(dir, scratch, use_);
    assert_eq!(code, 0, "{use_:?}: {said}");
    let mut ignored = Vec::new();
    for (option, takes_value) in listed(dir, use_) {
        let long = format!("--{option}");
        if RUNNING.contains(&option.as_str()) || use_.contains(&long.as_str()) {
            continue;
        }
        if NOTHING_TO_STEER.iter().any(|(input, options)| use_.contains(input) && options.contains(&&*option))
        {
            continue;
        }
        let species = use_[0] == "scan" && option == "leaves";
        let value = VALUES.iter().find(|(name, _)| *name == option).map(|(_, value)| *value);
        // Files of structure have +Z up already, and so have scans of trees.
        let field = use_[0] == "scan"
            || use_.iter().any(|word| word.ends_with(".mtg") || word.ends_with(".opf") || *word == "--qsm");
        let value = if field && option == "up" { Some("y") } else { value };
        let value = if species { Some("hazel") } else { value };
        assert!(!takes_value || value.is_some(), "{use_:?}: no value for {long}");
        let mut args = use_.to_vec();
        args.push(&long);
        args.extend(value.filter(|_| takes_value));
        let (code, said, files) = made(dir, scratch, &args);
        let refused = code == 2 && said.lines().count() == 1;
        if !(refused || code == 0 && files != plain) {
            ignored.push(format!("{} ({code}): {said}", args.join(" ")));
        }
    }
    ignored
}

#[test]
fn no_option_is_ignored() {
    let dir = folder("options");
    inputs(&dir);
    projects(&dir);
    let next = std::sync::atomic::AtomicUsize::new(0);
    let found = std::sync::Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for worker in ["options-a", "options-b"] {
            let (dir, next, found) = (&dir, &next, &found);
            scope.spawn(move || {
                let scratch = folder(worker);
                while let Some(use_) = USES.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
                    let rows = ignored(dir, &scratch, use_);
                    found.lock().unwrap().extend(rows);
                }
            });
        }
    });
    let found = found.into_inner().unwrap();
    assert!(found.is_empty(), "ignored:\n{}", found.join("\n"));
}

/// Makes a project of one drawing and one of several plants.
fn projects(dir: &Path) {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/projects");
    fs::copy(fixtures.join("version-1.burgeon"), dir.join("one.burgeon")).unwrap();
    fs::copy(fixtures.join("version-3.burgeon"), dir.join("scene.burgeon")).unwrap();
}
