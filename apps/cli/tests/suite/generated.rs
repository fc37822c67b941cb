//! Hostile files and command lines, made from good ones by a seeded generator.
//!
//! `BURGEON_HOSTILE=N` runs N cases instead of a few hundred, from `BURGEON_HOSTILE_SEED` on. A case depends on its
//! seed alone, and a failure names it: `BURGEON_HOSTILE=1 BURGEON_HOSTILE_SEED=that` repeats it.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use tools::{FLOWER, folder, good};

const FIXTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");
const LIMIT: Duration = Duration::from_secs(10);

/// Random numbers by splitmix64: the tests of the command do not use the core's.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    #[expect(clippy::cast_possible_truncation, reason = "below n, which is a usize")]
    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % (n.max(1) as u64)) as usize
    }

    fn one<'a, T>(&mut self, of: &'a [T]) -> &'a T {
        &of[self.below(of.len())]
    }
}

/// A command on a good file that is to be broken.
struct Recipe {
    /// The file to be broken. `IN` in the arguments is its name.
    file: String,
    bytes: Vec<u8>,
    args: &'static str,
}

/// Files next to the broken one, and the commands.
struct Ground {
    beside: Vec<(String, Vec<u8>)>,
    recipes: Vec<Recipe>,
}

const INKML: &str = r#"<ink xmlns="http://www.w3.org/2003/InkML"><annotation type="truth">daisy</annotation>
<trace id="a">10 10, 12 40, 11 80, 10 120</trace><trace id="b">10 10, 30 0, 40 12, 28 20, 10 11</trace></ink>"#;
const NDJSON: &str = r#"{"word":"stem","key_id":"1","drawing":[[[0,3,9,2],[0,50,120,190]],[[9,30,44,20,9],[50,40,52,66,51]]]}"#;
const TREE: &str = "name = \"small\"\n[method]\nkind = \"competition\"\npoints = 200\n";
const CLASSES: &str = "stroke,class\n0,axis\n1,blade\n3,blade\n";
const SETTINGS: &str = r#"{"height_m": 2.0, "fill": {"density": 1.0}}"#;
const EDITS: &str = r#"{"schema": "burgeon.edits/1", "edits": [
  {"op": "rotate", "axis": {"path": [0]}, "turn": {"about": [0, 1, 0], "degrees": 40}},
  {"op": "sketch-branch", "bearer": {"path": [0]}, "at": 0.4, "points": [[0, 0.3, 0], [0.1, 0.4, 0], [0.2, 0.5, 0]]},
  {"op": "brush", "bearer": {"path": [0]}, "points": [[0, 0.3, 0], [-0.2, 0.5, 0]], "radius_m": [0.1]},
  {"op": "silhouette", "outline": [[-2, 2], [2, 2], [3, 5], [0, 9], [-3, 5]]},
  {"op": "leaf-density", "region": "all", "keep": 0.7},
  {"op": "prune", "axis": {"path": [0, 0]}, "at": 0.5}
]}"#;
const PCD: &str = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nPOINTS 3\n\
                   DATA ascii\n0 0 0\n1 0 0\n1 1 0.5\n";

/// Writes a blade in points, `length` mm long.
fn blade(length: f64) -> Vec<u8> {
    let mut text = String::new();
    for i in 0..24 {
        for j in 0..9 {
            let (v, u) = (f64::from(i) / 23.0, f64::from(j) / 4.0 - 1.0);
            let half = 0.2 * length * (1.0 - (2.0 * v - 1.0) * (2.0 * v - 1.0)) + 0.5;
            text += &format!("{:.3} {:.3} {:.3}\n", u * half, 0.2 * v * length, v * length);
        }
    }
    text.into_bytes()
}

/// Writes a LAS 1.2 file of 40 points, format 0.
fn las() -> Vec<u8> {
    let mut b = vec![0_u8; 227];
    b[..4].copy_from_slice(b"LASF");
    (b[24], b[25]) = (1, 2);
    b[94..96].copy_from_slice(&227_u16.to_le_bytes());
    b[96..100].copy_from_slice(&227_u32.to_le_bytes());
    b[105..107].copy_from_slice(&20_u16.to_le_bytes());
    b[107..111].copy_from_slice(&40_u32.to_le_bytes());
    for k in 0..3 {
        b[131 + 8 * k..139 + 8 * k].copy_from_slice(&0.001_f64.to_le_bytes());
    }
    for i in 0..40_i32 {
        for x in [i * 37 % 11, i, i * 17 % 7] {
            b.extend(x.to_le_bytes());
        }
        b.extend([0; 8]);
    }
    b
}

/// Makes good files, most of them by the command itself, and the commands that use them.
fn ground() -> Ground {
    let dir = folder("generated-good");
    let put = |name: &str, bytes: &[u8]| fs::write(dir.join(name), bytes).unwrap();
    let mut stages = String::from("unit = \"mm\"\nsplit = \"none\"\n");
    for (k, (day, length)) in [(0, 20.0), (2, 31.0), (4, 42.0), (7, 50.0)].into_iter().enumerate() {
        put(&format!("s{k}.xyz"), &blade(length));
        stages += &format!("[[stage]]\nfile = \"s{k}.xyz\"\nday = {day}\nbase = [0, 0, 0]\n");
    }
    put("stages.toml", stages.as_bytes());
    put("edits.json", EDITS.as_bytes());
    put("flower.svg", FLOWER.as_bytes());
    good(&dir, &["convert", "flower.svg", "-o", "flower.json", "-q"]);
    let sketch = ["sketch", "flower.svg", "--detail", "0.1", "--no-textures", "-q", "-o"];
    for out in ["m.glb", "m.obj", "m.ply", "m.usda", "m.mtg"] {
        let textures = !out.ends_with("mtg");
        let own = if textures { &sketch[..] } else { &["sketch", "flower.svg", "-q", "-o"] };
        good(&dir, &[own, &[out]].concat());
    }
    good(&dir, &["convert", "m.glb", "-o", "m.stl", "-q"]);
    good(&dir, &["convert", "s0.xyz", "-o", "s.ply", "-q", "--unit", "mm"]);
    good(&dir, &["bloom", "fit", "stages.toml", "-o", "law.json", "-q"]);
    put("marks.csv", good(&dir, &["leaf", "--template", "--rows", "3"]).as_bytes());
    put("preset.toml", good(&dir, &["presets", "--show", "palm"]).as_bytes());
    let read = |name: &str| fs::read(dir.join(name)).unwrap();
    let fixture = |name: &str| fs::read(Path::new(FIXTURES).join(name)).unwrap();
    let mut recipes = Vec::new();
    let mut add = |file: &str, bytes: &[u8], args: &[&'static str]| {
        let each = args.iter().map(|args| Recipe { file: file.into(), bytes: bytes.into(), args });
        recipes.extend(each);
    };
    const SKETCH: &str = "sketch IN -o out.glb --no-textures --detail 0.2";
    const LEAF: &str = "leaf IN -o out.glb --texture plain --subdivisions 1 --sides 4";
    const GROW: &str = "grow IN -o out.ply --no-textures --detail 0.1 --age 3";
    const INFO: &str = "info IN";
    const CLOUD: [&str; 4] = [
        "convert IN -o out.ply",
        "leaf --scan IN -o out.glb --unit mm",
        "grow --attractors IN -o out.ply --no-textures --detail 0.1",
        "bloom run IN --end s3.xyz --unit mm --whole --day 0.5 -o out.ply",
    ];
    const MODEL: [&str; 4] = [
        INFO,
        "convert IN -o out.obj",
        "convert IN -o out.glb",
        "render IN -o out.png --size 24x18 --supersample 1",
    ];
    for name in ["sample.svg", "gallery/leaf.svg", "table1/a.svg"] {
        let bytes = fixture(&format!("sketches/{name}"));
        add("x.svg", &bytes, &[SKETCH, "convert IN -o out.json"]);
    }
    add("x.svg", FLOWER.as_bytes(), &[SKETCH, INFO, "shape IN --list", "sketch IN -o out.mtg"]);
    add("x.inkml", INKML.as_bytes(), &[SKETCH, "convert IN -o out.json"]);
    add("x.ndjson", NDJSON.as_bytes(), &["convert IN -o out.json", INFO]);
    add("x.json", &read("flower.json"), &[SKETCH, INFO]);
    for version in [1, 2, 3, 4, 7] {
        let bytes = fixture(&format!("projects/version-{version}.burgeon"));
        add("x.burgeon", &bytes, &[INFO, "sketch IN -o out.ply"]);
    }
    for name in ["leaf1", "leaf3"] {
        add("x.csv", &fixture(&format!("leaves/{name}.csv")), &[LEAF]);
    }
    add("x.csv", &read("marks.csv"), &[LEAF]);
    add(
        "x.csv",
        &fixture("leaves/leaf1.csv"),
        &["sketch flower.svg --leaf-template IN --no-textures -o out.glb"],
    );
    add("x.csv", CLASSES.as_bytes(), &["sketch flower.svg --classes IN --no-textures -o out.glb"]);
    add("x.json", SETTINGS.as_bytes(), &["sketch flower.svg --spec IN --no-textures -o out.glb"]);
    add("x.json", EDITS.as_bytes(), &["shape flower.svg --edits IN --no-textures -o out.glb"]);
    for name in ["m.glb", "m.obj", "m.ply", "m.stl"] {
        add(&name.replace('m', "x"), &read(name), &MODEL);
    }
    add("x.usda", &read("m.usda"), &[INFO]);
    add("x.mtg", &read("m.mtg"), &[INFO]);
    add("x.toml", TREE.as_bytes(), &[GROW, "shape IN --list"]);
    add("x.toml", &read("preset.toml"), &[GROW]);
    add("x.toml", stages.as_bytes(), &["bloom fit IN -o out.json", "bloom run IN --day 3 -o out.ply"]);
    add("x.json", &read("law.json"), &["bloom run lily --law IN --frames 2 -o out.glb"]);
    add("x.csv", &fixture("bloom/logistic.csv"), &["bloom fit IN -o out.json"]);
    add("s0.xyz", &read("s0.xyz"), &["bloom fit stages.toml -o out.json"]);
    add("x.xyz", &read("s0.xyz"), &CLOUD);
    add("x.ply", &read("s.ply"), &CLOUD);
    add("x.pcd", PCD.as_bytes(), &CLOUD);
    add("x.las", &las(), &CLOUD);
    let beside = ["flower.svg", "edits.json", "stages.toml", "s0.xyz", "s1.xyz", "s2.xyz", "s3.xyz"];
    Ground { beside: beside.iter().map(|n| ((*n).to_owned(), read(n))).collect(), recipes }
}

const NUMBERS: [&str; 16] = [
    "NaN",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "-1",
    "0",
    "-0",
    "1e-320",
    "4294967295",
    "99999999999999999999",
    "1e999",
    "1,5",
    "0x10",
    "1e9",
    "",
];
const ENDINGS: [&str; 14] = [
    "svg", "inkml", "ndjson", "json", "glb", "gltf", "obj", "ply", "stl", "burgeon", "csv", "toml", "xyz",
    "las",
];

/// Returns the numbers of a text, by their places.
fn numbers(bytes: &[u8]) -> Vec<(usize, usize)> {
    let (mut found, mut from) = (Vec::new(), None);
    for (i, b) in bytes.iter().chain(b" ").enumerate() {
        match from {
            None if b.is_ascii_digit() => from = Some(i),
            Some(at) if !matches!(b, b'0'..=b'9' | b'.') => {
                found.push((at, i));
                from = None;
            }
            _ => {}
        }
    }
    found
}

/// Breaks some bytes in one way, and describes it.
fn break_once(bytes: &mut Vec<u8>, dice: &mut Dice) -> &'static str {
    let at = dice.below(bytes.len());
    let lines = |bytes: &[u8]| bytes.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect::<Vec<_>>();
    match dice.below(13) {
        0 => {
            bytes.truncate(at);
            "truncated"
        }
        1 if !bytes.is_empty() => {
            bytes[at] ^= 1 << dice.below(8);
            "a bit flipped"
        }
        2..=4 => {
            if let Some(&(a, b)) =
                Some(numbers(bytes)).filter(|n| !n.is_empty()).as_ref().map(|n| dice.one(n))
            {
                bytes.splice(a..b, dice.one(&NUMBERS).bytes());
            }
            "a number replaced"
        }
        5 => {
            bytes.iter_mut().filter(|b| **b == b'.').for_each(|b| *b = b',');
            "decimal commas"
        }
        6 | 7 => {
            let mut rows = lines(bytes);
            let (i, n) = (dice.below(rows.len()), 1 + dice.below(4));
            let end = (i + n).min(rows.len());
            let block: Vec<_> = rows.drain(i..end).collect();
            if dice.below(2) == 0 {
                (0..=dice.below(3)).for_each(|_| drop(rows.splice(i..i, block.iter().cloned())));
            }
            *bytes = rows.join(&b'\n');
            "lines repeated or deleted"
        }
        8 => {
            let deep: &[u8] = dice.one::<&[u8]>(&[b"[".as_slice(), b"{\"a\":", b"<g>", b"(", b"a.", b"[["]);
            let many = deep.repeat(1 + dice.below(20_000));
            bytes.splice(at..at, many);
            "deep nesting"
        }
        9 => match dice.below(5) {
            0 => {
                let text = String::from_utf8_lossy(bytes).into_owned();
                *bytes = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
                bytes.splice(0..0, *b"\xff\xfe");
                "UTF-16"
            }
            1 => {
                bytes.insert(at, 0xe9);
                "Latin-1"
            }
            2 => {
                bytes.splice(0..0, *b"\xef\xbb\xbf");
                "a byte order mark"
            }
            3 => {
                *bytes = lines(bytes).join(&b"\r\n"[..]);
                "CRLF"
            }
            _ => {
                bytes.insert(at, 0);
                "a NUL byte"
            }
        },
        10 => {
            let words: [&[u8]; 9] =
                [b"<", b"\"", b"#", b"null", b",", b"\xff\xff\xff\xff", b"\x7f\x7f\x7f\x7f", b"\n", b"99"];
            bytes.splice(at..at, dice.one(&words).iter().copied());
            "a word inserted"
        }
        11 => {
            let end = (at + dice.below(64)).min(bytes.len());
            bytes.drain(at..end);
            "a piece cut out"
        }
        _ => {
            let end = (at + dice.below(64)).min(bytes.len());
            let piece = bytes[at..end].repeat(1 + dice.below(40));
            bytes.splice(at..at, piece);
            "a piece repeated"
        }
    }
}

/// Way in which the broken file is passed to the command.
enum Given {
    File(String),
    /// Through standard input, as `-`.
    Pipe,
}

/// Puts a broken input into `dir`, and describes it.
fn lay(dir: &Path, recipe: &Recipe, dice: &mut Dice) -> (String, Given, Vec<u8>) {
    let mut bytes = recipe.bytes.clone();
    let path = dir.join(&recipe.file);
    let _ = fs::remove_file(&path);
    let file = Given::File(recipe.file.clone());
    match dice.below(24) {
        0 => fs::create_dir(&path).unwrap(),
        1 => {
            #[cfg(unix)]
            std::os::unix::fs::symlink("nowhere", &path).unwrap();
            return ("a dangling link".into(), file, bytes);
        }
        2 => {
            fs::write(&path, &bytes).unwrap();
            #[cfg(unix)]
            fs::set_permissions(&path, std::os::unix::fs::PermissionsExt::from_mode(0o000)).unwrap();
            return ("no right to read".into(), file, bytes);
        }
        3 => {
            fs::write(&path, b"").unwrap();
            return ("an empty file".into(), file, bytes);
        }
        4 => {
            fs::write(&path, [dice.next().to_le_bytes()[0]]).unwrap();
            return ("one byte".into(), file, bytes);
        }
        5 | 6 => {
            let stem = recipe.file.split('.').next().unwrap();
            let name = format!("{stem}.{}", dice.one(&ENDINGS));
            fs::write(dir.join(&name), &bytes).unwrap();
            return (format!("{} named {name}", recipe.file), Given::File(name), bytes);
        }
        k => {
            let how: Vec<&str> = (0..=dice.below(3)).map(|_| break_once(&mut bytes, dice)).collect();
            if k < 10 && recipe.args.contains("IN") {
                return (format!("{}, piped", how.join(", ")), Given::Pipe, bytes);
            }
            fs::write(&path, &bytes).unwrap();
            return (how.join(", "), file, bytes);
        }
    }
    ("a folder".into(), file, bytes)
}

/// Commands with an option that gets a hostile value; they need no other input than the existing files.
const LINES: [(&str, &[&str]); 6] = [
    (
        "sketch flower.svg --no-textures --png out.png --unit cm -o out.ply",
        &[
            "--seed",
            "--height",
            "--branch-depth",
            "--leaf-depth",
            "--classes",
            "--flip-flowers",
            "--density",
            "--tropism",
            "--pipe-exponent",
            "--phototropism",
            "--gravity",
            "--spec",
            "--detail",
            "--sides",
            "--petals",
            "--variation",
            "--size",
            "--view",
            "--frames",
            "--background",
            "--supersample",
            "--up",
            "--threads",
            "--budget",
            "--format",
            "--leaf-template",
            "--qsm",
            "--nonsense",
        ],
    ),
    (
        "leaf --venation palmate --texture plain -o out.glb",
        &[
            "--veins",
            "--depth",
            "--side-veins",
            "--number",
            "--graph",
            "--rows",
            "--length",
            "--surface",
            "--rings",
            "--thickness",
            "--parameters",
            "--vein-weight",
            "--subdivisions",
            "--sides",
            "--curl",
            "--wilt",
            "--texture",
            "--days",
            "--day",
            "--leaves",
            "--height",
            "--azimuth",
            "--seed",
        ],
    ),
    (
        "grow --attractors s0.xyz --no-textures --detail 0.1 -o out.ply",
        &[
            "--root",
            "--step",
            "--influence",
            "--kill",
            "--age",
            "--leaf-keep",
            "--season",
            "--lods",
            "--method",
            "--obstacle",
            "--seed",
            "--sides",
        ],
    ),
    ("bloom fit stages.toml -o out.json", &["--regions", "--seed", "--plot", "--budget", "--up"]),
    (
        "bloom run s0.xyz --end s3.xyz --whole --unit mm -o out.ply",
        &["--day", "--frames", "--lattice", "--law", "--compare", "--seed", "--format", "--organs"],
    ),
    (
        "shape flower.svg --edits edits.json --no-textures -o out.glb",
        &["--list", "--edits", "--plant", "--lods", "--seed", "--detail"],
    ),
];

fn hostile_line(dice: &mut Dice) -> Vec<OsString> {
    let (line, options) = dice.one(&LINES);
    let mut args: Vec<OsString> = line.split(' ').map(OsString::from).collect();
    for _ in 0..=dice.below(2) {
        args.push(dice.one(options).into());
        match dice.below(20) {
            0 => args.push("9".repeat(1 + dice.below(5000)).into()),
            1 => args.push("x".repeat(100_000).into()),
            2 => args.push("1,2,NaN".into()),
            3 => args.push("1x1e9".into()),
            4 => args.push("line\nbreak \u{1b}[2J".into()),
            5 => args.push("-".into()),
            6 => {}
            #[cfg(unix)]
            7 => args.push(std::os::unix::ffi::OsStringExt::from_vec(b"\xff\xfe".to_vec())),
            _ => args.push(dice.one(&NUMBERS).into()),
        }
    }
    if dice.below(10) == 0 {
        args.push(dice.one(&["", "unknown", "--", "--=", "-o", "-xyz", "no/such/file.svg"]).into());
    }
    args
}

/// Returns every file below a folder, with its content.
fn tree(dir: &Path) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
    let mut all = BTreeMap::new();
    let mut open = vec![dir.to_owned()];
    while let Some(at) = open.pop() {
        for entry in fs::read_dir(at).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path.clone());
            }
            all.insert(path.clone(), fs::read(&path).ok());
        }
    }
    all
}

pub(crate) struct Ran {
    pub(crate) status: Option<i32>,
    pub(crate) told: String,
}

/// Ends a child that takes too long. `None` is the status of one that was ended, or that a signal ended.
fn wait(mut child: Child) -> Option<i32> {
    let from = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status.code();
        }
        if from.elapsed() > LIMIT {
            child.kill().unwrap();
            child.wait().unwrap();
            return None;
        }
        thread::sleep(Duration::from_millis(2));
    }
}

/// Runs a command with its output in files next to the folder, so that no full pipe blocks it.
pub(crate) fn run(dir: &Path, args: &[OsString], input: Option<&[u8]>) -> Ran {
    let [told, said] = ["told", "said"].map(|e| dir.with_extension(e));
    let mut command = Command::new(env!("CARGO_BIN_EXE_burgeon"));
    command.args(args).current_dir(dir).stdin(if input.is_some() { Stdio::piped() } else { Stdio::null() });
    let files = [&told, &said].map(|p| File::create(p).unwrap());
    let [told_to, said_to] = files;
    let mut child = command.stderr(told_to).stdout(said_to).spawn().unwrap();
    let mut pipe = child.stdin.take();
    let status = thread::scope(|scope| {
        scope.spawn(move || pipe.as_mut().zip(input).map(|(pipe, bytes)| pipe.write_all(bytes)));
        wait(child)
    });
    Ran { status, told: String::from_utf8_lossy(&fs::read(told).unwrap()).into_owned() }
}

/// Returns the fault of a run, if any.
fn judge(dir: &Path, before: &BTreeMap<PathBuf, Option<Vec<u8>>>, ran: &Ran) -> Result<(), String> {
    let after = tree(dir);
    if after.keys().any(|p| p.to_string_lossy().contains(".burgeon-")) {
        return Err(format!("left a draft: {:?}", after.keys()));
    }
    if before.iter().any(|(path, bytes)| after.get(path) != Some(bytes)) {
        return Err("changed a file that was there".into());
    }
    let new: Vec<&PathBuf> = after.keys().filter(|p| !before.contains_key(*p)).collect();
    match ran.status {
        Some(2) => {
            let line = ran.told.trim_end_matches('\n');
            if !line.starts_with("error: ") || line.contains('\n') {
                return Err("is not one line of error".into());
            }
            if line.chars().count() > 400 {
                return Err(format!("is a line of {} characters", line.chars().count()));
            }
            if !new.is_empty() {
                return Err(format!("failed and wrote {new:?}"));
            }
            Ok(())
        }
        Some(0) => new.into_iter().try_for_each(|path| readable(path)),
        Some(other) => Err(format!("ended with {other}")),
        None => Err("was ended by a signal or took more than 10 s".into()),
    }
}

fn readable(path: &Path) -> Result<(), String> {
    let bytes = fs::read(path).unwrap_or_default();
    let is = |e: &str| path.extension().is_some_and(|x| x == e);
    let sound = if is("json") {
        serde_json::from_slice::<serde_json::Value>(&bytes).is_ok()
    } else if is("png") {
        bytes.starts_with(b"\x89PNG") && bytes.ends_with(b"IEND\xaeB`\x82")
    } else if ["glb", "obj", "ply", "stl"].iter().any(|e| is(e)) {
        let args = ["info".into(), path.into()];
        let ran = run(path.parent().unwrap(), &args, None);
        ran.status == Some(0)
    } else {
        path.is_dir() || !bytes.is_empty()
    };
    if sound { Ok(()) } else { Err(format!("wrote {}, which cannot be read", path.display())) }
}

/// Runs one case: returns how it ended, or the fault.
fn case(ground: &Ground, seed: u64, dir: &Path) -> Result<Option<i32>, String> {
    let mut dice = Dice(seed);
    let _ = fs::remove_dir_all(dir);
    fs::create_dir_all(dir).unwrap();
    for (name, bytes) in &ground.beside {
        fs::write(dir.join(name), bytes).unwrap();
    }
    let (what, args, input) = if dice.below(6) == 0 {
        ("a hostile line".to_owned(), hostile_line(&mut dice), None)
    } else {
        let recipe = dice.one(&ground.recipes);
        let (what, given, bytes) = lay(dir, recipe, &mut dice);
        let (name, input) = match given {
            Given::File(name) => (name, None),
            Given::Pipe => ("-".to_owned(), Some(bytes)),
        };
        let args = recipe.args.split(' ').map(|a| if a == "IN" { &name } else { a }.into()).collect();
        (what, args, input)
    };
    let before = tree(dir);
    // Warnings are not errors: the summary and they are off.
    let args: Vec<OsString> = args.into_iter().chain(["-q".into()]).collect();
    let ran = run(dir, &args, input.as_deref());
    let fault = |fault: String| {
        let line: String = format!("{args:?}").chars().take(300).collect();
        let told: String = ran.told.chars().take(500).collect();
        format!("seed {seed}: {line} ({what}) {fault}; status {:?}, said {told:?}", ran.status)
    };
    judge(dir, &before, &ran).map_err(fault)?;
    if seed.is_multiple_of(16) {
        let first = tree(dir);
        let again = run(dir, &args, input.as_deref());
        if again.status != ran.status || again.told != ran.told || tree(dir) != first {
            return Err(fault("gives something else the second time".into()));
        }
    }
    Ok(ran.status)
}

pub(crate) fn asked(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |n| n.parse().unwrap())
}

#[test]
fn hostile_input_of_a_generator_is_refused_in_one_line_or_read() {
    let (from, count) = (asked("BURGEON_HOSTILE_SEED", 1), asked("BURGEON_HOSTILE", 400));
    let ground = ground();
    let (next, good) = (AtomicU64::new(from), AtomicU64::new(0));
    let faults = Mutex::new(Vec::new());
    let workers = thread::available_parallelism().map_or(2, usize::from).min(8);
    thread::scope(|scope| {
        for worker in 0..workers {
            let (ground, next, faults, good) = (&ground, &next, &faults, &good);
            scope.spawn(move || {
                let dir = folder(&format!("generated-{worker}"));
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= from + count {
                        break;
                    }
                    match case(ground, seed, &dir.join("case")) {
                        Ok(Some(0)) => drop(good.fetch_add(1, Ordering::Relaxed)),
                        Ok(_) => {}
                        Err(fault) => {
                            // Kept unchanged.
                            let _ = fs::rename(dir.join("case"), folder(&format!("generated-fault-{seed}")));
                            faults.lock().unwrap().push((seed, fault));
                        }
                    }
                }
            });
        }
    });
    let mut faults = faults.into_inner().unwrap();
    faults.sort();
    let lines: Vec<&str> = faults.iter().map(|(_, f)| f.as_str()).collect();
    assert!(
        lines.is_empty(),
        "{} of {count} cases; BURGEON_HOSTILE=1 BURGEON_HOSTILE_SEED=n does case n again:\n{}",
        lines.len(),
        lines.join("\n")
    );
    // Both outcomes must occur: some input is still read, some is refused.
    let good = good.into_inner();
    println!("{count} cases, {good} read, {} refused", count - good);
    assert!(count < 100 || (good > count / 10 && good < count * 9 / 10), "{good} of {count} were read");
}
