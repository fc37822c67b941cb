//! Nothing is unbounded: an excessive input is refused in one line, soon and without the memory that it asks for.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use serde_json::{Map, Value, json};
use tools::{bad, burgeon, folder, good, names, status};

/// Time limit, far more than any test here needs: a debug build on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Specs and their refusals. Each once took gigabytes or minutes.
const SPECS: &[(&str, &str, &[&str])] = &[
    (
        "a crown of a thousand kilometres",
        "[method]\nkind = \"competition\"\n[method.envelope]\nshape = \"sphere\"\ncentre = [0, 4, 0]\nradius_m = 1e6",
        &["along one shoot", "100,000", "step_m", "--budget"],
    ),
    (
        "steps of a thousand kilometres",
        "[method]\nkind = \"competition\"\nstep_m = 1e6",
        &["steps of 1000000 m", "step_m", "8.0"],
    ),
    (
        "a kill distance of a thousand kilometres",
        "[method]\nkind = \"competition\"\nkill_m = 1e6",
        &["steps of 500000 m", "kill_m", "8.0"],
    ),
    (
        "internodes of a kilometre",
        "[method]\nkind = \"self-organizing\"\ninternode_m = 1000\nyears = 40",
        &["along one shoot", "leaves.spacing_m", "--budget"],
    ),
    (
        "ten million attraction points",
        "[method]\nkind = \"competition\"\npoints = 10000000",
        &["10,000,000 attraction points", "2,000,000", "lower points", "--budget 5"],
    ),
    (
        "ten million points of a colony",
        "[method]\nkind = \"colonization\"\npoints = 10000000\n[method.envelope]\nshape = \"sphere\"\ncentre = [0, 4, 0]\n\
         radius_m = 2",
        &["10,000,000 attraction points", "lower points"],
    ),
    (
        "a module of a hundred kilometres",
        "[method]\nkind = \"lsystem\"\nmost_modules = 1000000\nrules = \"axiom = F(100001)\\nsteps = 0\"",
        &["833,342", "leaves along one shoot", "100,000"],
    ),
    (
        "rules that explode within their modules",
        "[method]\nkind = \"lsystem\"\nmost_modules = 100000000\nrules = \"axiom = A\\nsteps = 40\\nA -> A A\"",
        &["joints", "2,000,000", "most_modules"],
    ),
    (
        "a thousand years without enough shade to end them",
        "[method]\nkind = \"self-organizing\"\nyears = 1000\nmax_joints = 2000000000",
        &["joints", "lower years"],
    ),
    (
        "a stroke of a brush cut into millions",
        "[method]\nkind = \"guided\"\n[[method.strokes]]\npoints = [[0, 0, 0], [0, 1e6, 0], [0, 0, 0], [0, 1e6, 0]]\n\
         radius_m = [1e-6]\n[method.envelope]\nshape = \"sphere\"\ncentre = [0, 900000, 0]\nradius_m = 1",
        &["limit of"],
    ),
    (
        "a bole up to a crown in the sky",
        "[method]\nkind = \"guided\"\n[method.envelope]\nshape = \"sphere\"\ncentre = [0, 900000, 0]\nradius_m = 1",
        &["along one shoot", "envelope nearer"],
    ),
];

#[test]
fn what_is_too_much_is_refused_in_one_line() {
    let dir = folder("too-much");
    for (what, text, parts) in SPECS {
        fs::write(dir.join("spec.toml"), text).unwrap();
        let line = bad(&dir, &["grow", "spec.toml", "-o", "x.glb"]);
        assert!(parts.iter().all(|p| line.contains(p)), "{what}: {line}");
        assert_eq!(names(&dir), ["spec.toml"], "{what}");
    }
}

#[test]
fn ten_thousand_roots_are_too_many() {
    let dir = folder("roots");
    let roots: Vec<String> = (0..10_000).map(|i| format!("[{}, 0, {}]", i % 100 * 9, i / 100 * 9)).collect();
    fs::write(dir.join("wood.toml"), format!("roots = [{}]", roots.join(", "))).unwrap();
    let line = bad(&dir, &["grow", "wood.toml", "-o", "x.glb"]);
    assert!(line.contains("10,000 roots are more than the limit of 1,000"), "{line}");
}

#[test]
fn a_plant_of_the_finest_leaves_is_refused_and_a_single_one_is_not() {
    let dir = folder("finest");
    let marks = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/leaves/leaf1.csv");
    let marks = marks.to_str().unwrap();
    let finest = ["--subdivisions", "64", "--sides", "64"];
    let plant = [&["leaf", marks, "--plant", "--leaves", "200", "-o", "x.glb"][..], &finest].concat();
    let line = bad(&dir, &plant);
    assert!(line.contains("triangles") && line.contains("16,000,000") && line.contains("sides"), "{line}");
    good(&dir, &["leaf", marks, "--subdivisions", "32", "--sides", "32", "-o", "x.stl", "-q"]);
}

#[test]
fn five_thousand_edits_are_too_many() {
    let dir = folder("edits");
    let edit = json!({"op": "prune", "axis": {"path": [0, 0]}, "at": 0.5});
    let template: Value = serde_json::from_str(&good(&dir, &["shape", "--template"])).unwrap();
    let of = |n: usize| {
        let mut file = template.clone();
        file["edits"] = Value::Array(vec![edit.clone(); n]);
        fs::write(dir.join("edits.json"), file.to_string()).unwrap();
    };
    of(5000);
    let shape = ["shape", "dead-oak", "--edits", "edits.json", "-o", "x.glb"];
    let line = bad(&dir, &shape);
    assert!(
        line.contains("5,000 edits are more than the limit of 1,000") && line.contains("--budget 5"),
        "{line}"
    );
    of(20);
    good(&dir, &shape);
}

#[test]
fn a_drawing_of_very_many_strokes_is_refused_in_every_format() {
    let dir = folder("strokes");
    let (mut ink, mut svg) =
        (String::from("<ink xmlns=\"http://www.w3.org/2003/InkML\">"), String::from("<svg>"));
    for i in 0..30_000 {
        let (x, y) = (i % 500, i / 500);
        write!(ink, "<trace>{x} {y}, {} {}</trace>", x + 1, y + 1).unwrap();
        write!(svg, "<path fill=\"none\" stroke=\"#000\" d=\"M{x} {y}L{} {}\"/>", x + 1, y + 1).unwrap();
    }
    fs::write(dir.join("many.inkml"), ink + "</ink>").unwrap();
    fs::write(
        dir.join("many.svg"),
        svg.replace("<svg>", "<svg xmlns=\"http://www.w3.org/2000/svg\">") + "</svg>",
    )
    .unwrap();
    for file in ["many.inkml", "many.svg"] {
        let line = bad(&dir, &["sketch", file, "-o", "x.glb"]);
        assert!(line.contains("30,000 strokes are more than the limit of 20,000"), "{line}");
    }
}

/// Writes a cylinder: slivers all around and fans at both ends, which make an index slow.
fn tower(n: u32) -> String {
    let mut obj = String::new();
    // A step around the circle, by the first terms of sine and cosine: the angle is small.
    let a = std::f64::consts::TAU / f64::from(n);
    let (cos, sin) = (1.0 - a * a / 2.0 + a * a * a * a / 24.0, a - a * a * a / 6.0);
    let (mut x, mut z) = (1.0, 0.0);
    for _ in 0..n {
        writeln!(obj, "v {0} 0 {z}\nv {0} 4 {z}", 2.0 + x).unwrap();
        (x, z) = (x * cos - z * sin, x * sin + z * cos);
    }
    writeln!(obj, "v 2 0 0\nv 2 4 0").unwrap();
    for i in 0..n {
        let (a, b) = (2 * i + 1, 2 * ((i + 1) % n) + 1);
        let (low, high) = (2 * n + 1, 2 * n + 2);
        writeln!(
            obj,
            "f {a} {} {b}\nf {b} {} {}\nf {low} {a} {b}\nf {high} {} {}",
            a + 1,
            a + 1,
            b + 1,
            b + 1,
            a + 1
        )
        .unwrap();
    }
    obj
}

#[test]
fn an_obstacle_of_a_hundred_thousand_triangles_is_fine() {
    let dir = folder("obstacle");
    fs::write(dir.join("slivers.obj"), tower(100_000)).unwrap();
    let line = bad(&dir, &["grow", "oak", "--obstacle", "slivers.obj", "-o", "x.stl"]);
    assert!(
        line.contains("slivers") && line.contains("even triangles") && line.contains("--budget 3"),
        "{line}"
    );
    fs::write(dir.join("tower.obj"), tower(25_000)).unwrap();
    let started = Instant::now();
    good(&dir, &["grow", "oak", "--obstacle", "tower.obj", "-o", "x.stl"]);
    // Seconds; before, more than a minute in a release build, which is many minutes here. The rest is for a busy
    // machine.
    assert!(started.elapsed() < Duration::from_secs(150), "{:?}", started.elapsed());
}

/// Pseudo-random numbers for choices.
struct Dice(u64);

impl Dice {
    fn next(&mut self, below: usize) -> usize {
        // Splitmix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        usize::try_from((z ^ (z >> 31)) % below.max(1) as u64).unwrap()
    }

    fn one_in(&mut self, n: usize) -> bool {
        self.next(n) == 0
    }

    fn pick<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.next(all.len())]
    }
}

/// Makes specs whose numbers lie at the ends of the ranges in the schema of specs, and in between.
struct Extremes<'a> {
    defs: &'a Map<String, Value>,
    dice: Dice,
}

impl Extremes<'_> {
    /// Returns a value of a schema; `None` where it may be omitted.
    fn value(&mut self, name: &str, schema: &Value) -> Option<Value> {
        if let Some(of) = schema["$ref"].as_str() {
            return self.value(name, &self.defs[of.rsplit('/').next().unwrap()]);
        }
        if let Some(fixed) = schema.get("const") {
            return Some(fixed.clone());
        }
        if let Some(words) = schema["enum"].as_array() {
            return Some(self.dice.pick(words).clone());
        }
        for key in ["oneOf", "anyOf"] {
            if let Some(all) = schema[key].as_array() {
                let some: Vec<&Value> = all.iter().filter(|s| s["type"] != "null").collect();
                let chosen = *self.dice.pick(&some);
                return self.value(name, chosen);
            }
        }
        let kind = match &schema["type"] {
            Value::Array(all) => all.iter().find_map(|t| t.as_str().filter(|t| *t != "null")),
            kind => kind.as_str(),
        };
        match kind? {
            // Existing branches.
            "array" if name == "path" => {
                Some(if self.dice.one_in(2) { json!([0]) } else { json!([0, self.dice.next(9)]) })
            }
            "integer" | "number" => Some(self.number(schema, kind? == "integer")),
            "boolean" => Some(Value::Bool(self.dice.one_in(2))),
            "string" if name == "rules" => {
                let rules = [
                    "axiom = A\nsteps = 100\nA -> F A",
                    "axiom = A\nsteps = 60\nA -> F [ +(40) A ] [ -(40) A ]",
                    "axiom = F(900000)\nsteps = 1",
                    "axiom = A\nsteps = 14\nA -> F(0.1) L A A",
                ];
                Some((*self.dice.pick(&rules)).into())
            }
            "array" => {
                let few = schema["minItems"].as_u64().unwrap_or(1 + self.dice.next(3) as u64);
                Some((0..few).filter_map(|_| self.value(name, &schema["items"])).collect())
            }
            "object" => Some(self.object(schema, 5)),
            _ => None,
        }
    }

    fn number(&mut self, schema: &Value, whole: bool) -> Value {
        let end = |key: &str| schema[key].as_f64();
        // A number without a range is a coordinate.
        let (lo, hi) =
            (end("minimum").unwrap_or(-1e6), end("maximum").unwrap_or(if whole { 4e9 } else { 1e6 }));
        let x = match self.dice.next(5) {
            0 => lo,
            1 | 2 => hi,
            3 => (lo.abs().max(1e-3) * hi.abs().max(1e-3)).sqrt().clamp(lo, hi),
            _ => lo.max(1.0).min(hi),
        };
        if whole { format!("{x:.0}").parse().unwrap() } else { json!(x) }
    }

    /// Returns the required fields, and one in `n` of the others.
    fn object(&mut self, schema: &Value, n: usize) -> Value {
        let required = schema["required"].as_array().cloned().unwrap_or_default();
        let mut out = Map::new();
        for (name, field) in schema["properties"].as_object().into_iter().flatten() {
            let must = required.iter().any(|r| r == name);
            if (must || self.dice.one_in(n)) && name != "file" {
                out.extend(self.value(name, field).map(|v| (name.clone(), v)));
            }
        }
        Value::Object(out)
    }
}

/// Writes TOML: each field in one line.
fn toml_of(spec: &Value) -> String {
    fn inline(value: &Value) -> String {
        match value {
            Value::Object(fields) => {
                let all: Vec<String> = fields.iter().map(|(k, v)| format!("{k} = {}", inline(v))).collect();
                format!("{{ {} }}", all.join(", "))
            }
            Value::Array(all) => format!("[{}]", all.iter().map(inline).collect::<Vec<_>>().join(", ")),
            // Strings, numbers and truth are written as in JSON.
            plain => plain.to_string(),
        }
    }
    let fields = spec.as_object().unwrap().iter();
    fields.map(|(k, v)| format!("{k} = {}\n", inline(v))).collect()
}

/// Runs a command and returns its status, its stderr, and its time. Ends it at the time limit.
fn patiently(dir: &Path, args: &[&str]) -> (Option<i32>, String, Duration) {
    let started = Instant::now();
    let mut command = Command::new(env!("CARGO_BIN_EXE_burgeon"));
    let log = fs::File::create(dir.join("said.txt")).unwrap();
    let pipes = command.args(args).current_dir(dir).stdin(Stdio::null()).stdout(Stdio::null()).stderr(log);
    let mut child = pipes.spawn().unwrap();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status.code();
        }
        if started.elapsed() > PATIENCE {
            child.kill().unwrap();
            child.wait().unwrap();
            break None;
        }
        std::thread::sleep(Duration::from_millis(3));
    };
    (status, fs::read_to_string(dir.join("said.txt")).unwrap(), started.elapsed())
}

/// Checks extreme specs; `BURGEON_EXTREMES=5000` tries more.
#[test]
fn specs_at_the_ends_of_all_ranges_make_a_plant_or_one_line() {
    let dir = folder("extremes");
    good(&dir, &["presets", "--schema", "schema.json"]);
    let schema = tools::json(&dir.join("schema.json"));
    let defs = schema["$defs"].as_object().unwrap();
    let count = std::env::var("BURGEON_EXTREMES").ok().and_then(|n| n.parse().ok()).unwrap_or(100);
    let (next, made) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let one = |i: usize, dir: &Path| {
        let mut extremes = Extremes { defs, dice: Dice(i as u64) };
        // Each method in turn; of all other fields now and then one.
        let methods = defs["Method"]["oneOf"].as_array().unwrap();
        let method = &methods[i % methods.len()];
        let mut spec = extremes.object(&schema, 12);
        let sparse = if i.is_multiple_of(3) { 4 } else { 12 };
        spec["method"] = extremes.object(method, sparse);
        fs::write(dir.join("spec.toml"), toml_of(&spec)).unwrap();
        let (status, said, time) = patiently(dir, &["grow", "spec.toml", "--json", "--threads", "1"]);
        let text = fs::read_to_string(dir.join("spec.toml")).unwrap();
        let errors: Vec<&str> = said.lines().filter(|l| l.starts_with("error: ")).collect();
        match status {
            Some(0) => _ = made.fetch_add(1, Ordering::Relaxed),
            Some(2) => assert!(errors.len() == 1 && !said.contains("memory"), "{said}\n{text}"),
            _ => panic!("{status:?} after {time:?}: {said}\n{text}"),
        }
    };
    // Two at a time: a spec may take some hundred megabytes.
    std::thread::scope(|scope| {
        for worker in 0..std::thread::available_parallelism().map_or(1, usize::from).min(2) {
            let (own, next, one) = (dir.join(worker.to_string()), &next, &one);
            fs::create_dir_all(&own).unwrap();
            scope.spawn(move || {
                while let i = next.fetch_add(1, Ordering::Relaxed)
                    && i < count
                {
                    one(i, &own);
                }
            });
        }
    });
    let made = made.into_inner();
    assert!(made * 8 > count, "{made} of {count} made a plant: the generator tries nonsense only");
}

#[test]
fn edits_at_the_ends_of_all_ranges_are_done_or_said() {
    let dir = folder("extreme-edits");
    good(&dir, &["shape", "--schema", "schema.json"]);
    let schema = tools::json(&dir.join("schema.json"));
    let defs = schema["$defs"].as_object().unwrap();
    let edits = &schema["properties"]["edits"];
    let mut done = 0;
    for i in 0..60 {
        let mut extremes = Extremes { defs, dice: Dice(1000 + i) };
        let all = extremes.value("edits", edits).unwrap();
        fs::write(dir.join("edits.json"), json!({ "schema": "burgeon.edits/1", "edits": all }).to_string())
            .unwrap();
        let (status, said, time) =
            patiently(&dir, &["shape", "dead-oak", "--edits", "edits.json", "--json", "--threads", "1"]);
        let errors = said.lines().filter(|l| l.starts_with("error: ")).count();
        match status {
            Some(0) => done += 1,
            Some(2) => assert!(errors == 1 && !said.contains("memory"), "{said}\n{all}"),
            _ => panic!("{status:?} after {time:?}: {said}\n{all}"),
        }
        assert!(time < PATIENCE / 3, "{time:?}: {all}");
    }
    assert!(done > 6, "{done} were done: the generator tries nonsense only");
}

#[test]
fn presets_and_fixtures_pass_at_the_usual_budget() {
    let dir = folder("usual");
    let presets: Value = serde_json::from_str(&good(&dir, &["presets", "--json"])).unwrap();
    for row in presets.as_array().unwrap() {
        let key = row["preset"].as_str().unwrap();
        let command: &[&str] = if row["method"] == "flower" {
            &["bloom", "run", key, "-o", "flower.glb", "--frames", "2", "--json"]
        } else {
            &["grow", key, "--json"]
        };
        let out = burgeon(&dir, command);
        assert_eq!(status(&out), 0, "{key}: {}", String::from_utf8_lossy(&out.stderr));
    }
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    for (place, command) in [
        ("sketches", "sketch"),
        ("sketches/table1", "sketch"),
        ("sketches/gallery", "sketch"),
        ("projects", "sketch"),
        ("leaves", "leaf"),
    ] {
        for entry in fs::read_dir(fixtures.join(place)).unwrap() {
            let path = entry.unwrap().path();
            let known = path.extension().is_some_and(|e| e == "svg" || e == "burgeon" || e == "csv");
            if !known {
                continue;
            }
            let out = burgeon(&dir, &[command, path.to_str().unwrap(), "--json"]);
            assert_eq!(status(&out), 0, "{}: {}", path.display(), String::from_utf8_lossy(&out.stderr));
        }
    }
}

#[test]
fn the_budget_is_raised_by_its_option_and_only_within_its_range() {
    let dir = folder("raised");
    fs::write(
        dir.join("many.toml"),
        "bare = true\n[method]\nkind = \"competition\"\npoints = 2100000\nlifespan = 1",
    )
    .unwrap();
    let line = bad(&dir, &["grow", "many.toml", "-o", "x.stl"]);
    assert!(line.contains("2,100,000 attraction points") && line.contains("--budget 2"), "{line}");
    good(&dir, &["grow", "many.toml", "-o", "x.stl", "--budget", "2", "-q"]);
    for wrong in ["0.5", "1001", "nan", "lots"] {
        assert!(
            bad(&dir, &["grow", "oak", "-o", "x.stl", "--budget", wrong]).contains("--budget"),
            "{wrong}"
        );
    }
}

#[cfg(unix)]
#[test]
fn memory_that_the_system_refuses_is_one_line_and_nothing_half_written() {
    let dir = folder("starved");
    fs::write(dir.join("spec.toml"), "[method]\nkind = \"competition\"\npoints = 900000\nkill_m = 0.02")
        .unwrap();
    let program = env!("CARGO_BIN_EXE_burgeon");
    let script = format!("ulimit -v 260000; exec '{program}' grow spec.toml -o x.glb --threads 1");
    let out = Command::new("sh").args(["-c", &script]).current_dir(&dir).output().unwrap();
    let text = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(2), "{text}");
    assert!(text.lines().count() == 1 && text.starts_with("error: ") && text.contains("memory"), "{text}");
    assert_eq!(names(&dir), ["spec.toml"]);
}
