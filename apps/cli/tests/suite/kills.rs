//! A process that is killed half-way leaves the previous files, or all of its own after the next command.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::ExitStatusExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::tools;
use tools::{FLOWER, burgeon, folder, good, names};

/// Number of processes that are killed, for all commands together.
const KILLS: usize = 200;
/// Number of processes at a time.
const AT_ONCE: usize = 2;

/// Commands that write several files: next to each other, in two folders, with levels, many in a folder.
const COMMANDS: [&[&str]; 4] = [
    &[
        "sketch",
        "rose.svg",
        "-o",
        "out/r.glb",
        "--png",
        "out/r.png",
        "--size",
        "24x16",
        "--report",
        "out/r.json",
        "-q",
    ],
    &["sketch", "rose.svg", "-o", "out/r.obj", "--qsm", "more/r.csv", "--report", "more/r.json", "-q"],
    &["convert", "tiny.obj", "-o", "out/t.obj", "--report", "out/t.json", "-q"],
    &["bloom", "run", "tulip", "-o", "out", "--frames", "3", "--format", "obj", "-q"],
];

/// Seeded numbers below 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn ready(dir: &Path) {
    for name in ["out", "more"] {
        let _ = fs::remove_dir_all(dir.join(name));
        fs::create_dir(dir.join(name)).unwrap();
    }
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    fs::write(dir.join("tiny.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
}

/// Returns every file below a folder that is not hidden.
fn files(dir: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    for name in ["out", "more"] {
        for file in names(&dir.join(name)).iter().filter(|n| !n.starts_with(".burgeon-")) {
            let path = Path::new(name).join(file);
            all.insert(path.clone(), fs::read(dir.join(&path)).unwrap());
        }
    }
    all
}

fn hidden(dir: &Path) -> Vec<String> {
    let all = ["out", "more"].map(|f| names(&dir.join(f)));
    all.into_iter().flatten().filter(|n| n.starts_with(".burgeon-")).collect()
}

/// Kills one process after a part of its duration; returns whether it was still running, and left unfinished files.
fn kill_one(dir: &Path, args: &[&str], whole: &BTreeMap<PathBuf, Vec<u8>>, after: Duration) -> [bool; 2] {
    ready(dir);
    let earlier = || whole.keys().map(|path| (path.clone(), b"earlier".to_vec())).collect::<BTreeMap<_, _>>();
    for (path, bytes) in earlier() {
        fs::write(dir.join(path), bytes).unwrap();
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_burgeon"));
    let mut child = command.args(args).current_dir(dir).stdout(Stdio::null()).spawn().unwrap();
    std::thread::sleep(after);
    child.kill().unwrap();
    let killed = child.wait().unwrap().signal() == Some(9);
    let left = !hidden(dir).is_empty();
    // The next command finishes or removes the remains in the folders that it writes into.
    good(dir, &["convert", "tiny.obj", "-o", "out/next.stl", "--report", "more/next.json", "-q"]);
    ["out/next.stl", "more/next.json"].iter().for_each(|name| fs::remove_file(dir.join(name)).unwrap());
    assert_eq!(hidden(dir), Vec::<String>::new(), "{args:?} after {after:?}");
    let now = files(dir);
    let is_whole = now.len() == whole.len()
        && now.iter().all(|(path, bytes)| bytes != b"earlier" && whole.contains_key(path));
    assert!(is_whole || now == earlier(), "{args:?} after {after:?}: {:?}", now.keys());
    [killed, left]
}

#[test]
fn two_hundred_kills_leave_sets_whole_or_untouched() {
    let dir = folder("kills");
    let mut numbers = Numbers(48);
    let mut plans = Vec::new();
    for args in COMMANDS {
        ready(&dir);
        let begun = Instant::now();
        good(&dir, args);
        let time = begun.elapsed();
        let whole = files(&dir);
        assert!(!whole.is_empty(), "{args:?}");
        for _ in 0..KILLS / COMMANDS.len() {
            // Half of them near the end, when files get their names.
            let share = if numbers.next() < 0.5 { numbers.next() } else { 0.7 + 0.35 * numbers.next() };
            plans.push((args, whole.clone(), time.mul_f64(share)));
        }
    }
    let told: Vec<[bool; 2]> = std::thread::scope(|scope| {
        let work: Vec<_> = (0..AT_ONCE)
            .map(|k| {
                let (own, plans) = (folder(&format!("kills-{k}")), &plans);
                let mine = move || {
                    let mine = plans.iter().skip(k).step_by(AT_ONCE);
                    mine.map(|(args, whole, after)| kill_one(&own, args, whole, *after)).collect::<Vec<_>>()
                };
                scope.spawn(mine)
            })
            .collect();
        work.into_iter().flat_map(|w| w.join().unwrap()).collect()
    });
    let count = |k: usize| told.iter().filter(|t| t[k]).count();
    assert!(
        count(0) > KILLS / 4 && count(1) > KILLS / 20,
        "{} were killed, {} left files",
        count(0),
        count(1)
    );
}

#[test]
fn drafts_of_a_process_that_is_alive_stay() {
    let dir = folder("kills-alive");
    ready(&dir);
    let lock = fs::File::create(dir.join("out/.burgeon-0123456789abcdef.lock")).unwrap();
    lock.lock().unwrap();
    fs::write(dir.join("out/.burgeon-0123456789abcdef-1.part"), "half").unwrap();
    let both = [".burgeon-0123456789abcdef-1.part", ".burgeon-0123456789abcdef.lock"];
    let next = || {
        let out = burgeon(&dir, &["sketch", "rose.svg", "-o", "out/r.glb", "-q"]);
        assert!(out.status.success());
        hidden(&dir)
    };
    assert_eq!(next(), both);
    drop(lock);
    assert_eq!(next(), Vec::<String>::new());
}
