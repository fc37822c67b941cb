//! Whatever a command does, it ends soon after a request, and leaves nothing half-written.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io::Read as _;
use std::os::unix::process::ExitStatusExt as _;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

use crate::{forest, missing, replay, species, tools};
use tools::{burgeon, folder, good, names, status};

/// Number of moments at which each command is interrupted, unless `BURGEON_INTERRUPTS` gives another.
const MOMENTS: usize = 5;
/// Number of commands at a time.
const AT_ONCE: usize = 2;
/// Time within which a command ends, in addition to the time that a busy machine takes to start one.
const SOON: Duration = Duration::from_secs(1);
/// Latest moment: a command that takes longer does the same for a long time.
const LATEST: Duration = Duration::from_millis(1500);

/// Commands that are interrupted: arguments, in which `in/` names inputs. All files are written below `out`.
const COMMANDS: [&[&str]; 22] = [
    &["sketch", "in/sample.svg", "-o", "out/s.obj", "--png", "out/s.png", "--report", "out/s.json"],
    &["sketch", "in/a.svg", "in/b.svg", "in/c.svg", "in/d.svg", "in/e.svg", "-o", "out/", "--png", "out/"],
    &[
        "leaf",
        "in/leaf.csv",
        "--plant",
        "--leaves",
        "40",
        "-o",
        "out/l.glb",
        "--lods",
        "2",
        "--png",
        "out/l.png",
    ],
    &["grow", "oak", "-o", "out/g.glb", "--lods", "2", "--png", "out/g.png", "--qsm", "out/g.csv"],
    &["scan", "in/tree.xyz", "-o", "out/c.glb", "--qsm", "out/c.csv", "--report", "out/c.json"],
    &["light", "oak", "-o", "out/h.csv", "--png", "out/h.png", "--report", "out/h.json"],
    &["shape", "oak", "--list"],
    &["replay", "in/hands.json", "--film", "out/r.gif", "--size", "160x120", "--report", "out/r.json"],
    &["compare", "oak", "--png", "out/v.png", "--report", "out/v.json"],
    &["render", "in/tree.glb", "-o", "out/p.png", "--size", "1600x1200", "--report", "out/p.json"],
    &["convert", "in/tree.glb", "-o", "out/t.obj", "--report", "out/t.json"],
    &["info", "in/tree.glb", "--report", "out/i.json"],
    &["bloom", "run", "tulip", "-o", "out", "--frames", "6", "--report", "out/b.json"],
    &["bloom", "fit", "in/growth.csv", "-o", "out/f.json", "--plot", "out/f.svg", "--report", "out/r.json"],
    &["species", "fit", "in/species.csv", "-o", "out/s.toml", "--trees", "40", "--report", "out/s.json"],
    forest::SMALL,
    &["studio", "in/sample.svg", "--folder", "in/page", "--no-open"],
    &["presets", "--show", "oak"],
    &["man", "out"],
    &["completions", "bash"],
    // Nothing comes from standard input, and nobody reads the pipe.
    &["info", "-", "--report", "out/i.json"],
    &["convert", "in/tree.glb", "-o", "in/pipe.stl"],
];

/// Writes the inputs of all commands.
fn inputs(dir: &Path) {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    fs::create_dir_all(dir.join("page")).unwrap();
    fs::write(dir.join("page/index.html"), "<!doctype html>page").unwrap();
    let copies = [("sketches/sample.svg", "sample.svg"), ("leaves/leaf1.csv", "leaf.csv")];
    fs::write(dir.join("growth.csv"), "day,size\n0,0.1\n3,0.3\n6,0.8\n9,1.4\n12,1.7\n15,1.8\n").unwrap();
    let drawings =
        ["a", "b", "c", "d", "e"].map(|n| (format!("sketches/table1/{n}.svg"), format!("{n}.svg")));
    let copies = copies.map(|(from, to)| (from.to_owned(), to.to_owned())).into_iter().chain(drawings);
    for (from, to) in copies {
        fs::copy(fixtures.join(from), dir.join(to)).unwrap();
    }
    fs::write(dir.join("hands.json"), replay::record(12)).unwrap();
    fs::write(dir.join("species.csv"), species::trees(6, 3)).unwrap();
    forest::inventory(dir, 4);
    good(dir, &["grow", "hazel", "-o", "tree.glb", "-q"]);
    assert!(Command::new("mkfifo").arg(dir.join("pipe.stl")).status().unwrap().success(), "mkfifo");
    let mut points = String::new();
    // A stem and four limbs.
    for k in 0..24_000_u32 {
        let (around, along) = (f64::from(k % 24) / 24.0 * std::f64::consts::TAU, f64::from(k / 24) / 1000.0);
        #[expect(clippy::disallowed_methods, reason = "points of a test")]
        let (sin, cos) = around.sin_cos();
        let (x, y, z) = match k / 24 % 5 {
            0 => (0.08 * cos, 0.08 * sin, 6.0 * along),
            1 => (2.0 * along, 0.03 * sin, 3.0 + along + 0.03 * cos),
            2 => (-2.0 * along, 0.03 * sin, 3.5 + along + 0.03 * cos),
            3 => (0.03 * sin, 2.0 * along, 4.0 + along + 0.03 * cos),
            _ => (0.03 * sin, -2.0 * along, 4.5 + along + 0.03 * cos),
        };
        writeln!(points, "{x:.4} {y:.4} {z:.4}").unwrap();
    }
    fs::write(dir.join("tree.xyz"), points).unwrap();
}

fn start(dir: &Path, args: &[&str]) -> Child {
    let _ = fs::remove_dir_all(dir.join("out"));
    fs::create_dir(dir.join("out")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_burgeon"));
    command.args(args).current_dir(dir).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

/// Returns the files below `out`, in folders below it as well, with their lengths.
fn made(dir: &Path) -> BTreeMap<String, u64> {
    let mut found = BTreeMap::new();
    let mut open = vec![String::new()];
    while let Some(folder) = open.pop() {
        for name in names(&dir.join("out").join(&folder)) {
            let name = if folder.is_empty() { name } else { format!("{folder}/{name}") };
            let about = fs::metadata(dir.join("out").join(&name)).unwrap();
            if about.is_dir() {
                open.push(name);
            } else {
                found.insert(name, about.len());
            }
        }
    }
    found
}

/// Journal of a forest that is not whole: the next run goes on where it ends.
const JOURNAL: &str = "unfinished.jsonl";

/// Waits for the end and returns its time.
fn ended(child: &mut Child) -> (ExitStatus, Duration) {
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return (status, begun.elapsed());
        }
        if begun.elapsed() > 30 * SOON {
            child.kill().unwrap();
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Returns the duration of a command, at most [`LATEST`], and its files.
fn whole(dir: &Path, args: &[&str]) -> (Duration, BTreeMap<String, u64>) {
    let mut child = start(dir, args);
    let begun = Instant::now();
    let waits = args[0] == "studio" || args[1] == "-" || args.contains(&"in/pipe.stl");
    if waits {
        std::thread::sleep(LATEST / 3);
        assert_eq!(child.try_wait().unwrap(), None, "{args:?} waits");
        child.kill().unwrap();
        child.wait().unwrap();
        return (begun.elapsed(), BTreeMap::new());
    }
    let out = child.wait_with_output().unwrap();
    assert!(out.status.success(), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
    (begun.elapsed().min(LATEST), made(dir))
}

/// Returns the time that a process takes to start and end.
fn starting(dir: &Path) -> Duration {
    let begun = Instant::now();
    good(dir, &["--version"]);
    begun.elapsed()
}

fn interrupt(dir: &Path, args: &[&str], whole: &BTreeMap<String, u64>, (after, signal): (Duration, Signal)) {
    let what = format!("{args:?}, {signal} after {after:?}");
    let mut child = start(dir, args);
    // Somebody reads its output: more than a pipe holds would block it.
    let mut said = child.stdout.take().unwrap();
    let reader = std::thread::spawn(move || std::io::copy(&mut said, &mut std::io::sink()));
    std::thread::sleep(after);
    kill(Pid::from_raw(child.id().try_into().unwrap()), signal).unwrap();
    let (status, time) = ended(&mut child);
    reader.join().unwrap().unwrap();
    let limit = SOON + 10 * starting(dir);
    assert!(time < limit, "{what}: ended after {time:?}, not {limit:?}");
    let mut said = String::new();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    let now = made(dir);
    let is_draft = |name: &String| name.split('/').any(|part| part.starts_with(".burgeon-"));
    assert!(!now.keys().any(is_draft), "{what}: {now:?}");
    match status.code() {
        Some(0) => assert_eq!(now.len(), whole.len(), "{what}"),
        Some(130) => {
            let told = said.lines().filter(|l| l.starts_with("error: stopped; ")).count();
            assert_eq!(told, usize::from(args[0] != "studio"), "{what}: {said}");
        }
        // So early that the program had not begun.
        None => assert!(status.signal() == Some(signal as i32) && now.is_empty(), "{what}: {now:?}"),
        Some(other) => panic!("{what}: status {other}: {said}"),
    }
    if args.contains(&"out/") {
        // In a batch, each drawing is whole.
        let of =
            |end: &str| now.keys().filter_map(|n| n.strip_suffix(end)).map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(of(".glb"), of(".png"), "{what}");
    } else if args[0] == "forest" {
        // Each file is whole, and either a journal or all of them are there.
        let is_begun = now.keys().any(|name| name.ends_with(JOURNAL));
        assert!(now.is_empty() || is_begun || now.len() == whole.len(), "{what}: {now:?}");
    } else {
        assert!(now.is_empty() || now.len() == whole.len(), "{what}: {now:?}");
    }
    // Reports contain times, and a journal grows.
    let is_same = |(name, bytes): (&String, &u64)| {
        name.ends_with(".json") || name.ends_with(JOURNAL) || whole.get(name) == Some(bytes)
    };
    assert!(now.iter().all(is_same), "{what}: {now:?}, not {whole:?}");
}

#[test]
fn every_command_ends_soon_after_it_is_asked_to() {
    let dir = folder("signals");
    inputs(&dir);
    let asked = std::env::var("BURGEON_INTERRUPTS").ok().and_then(|n| n.parse::<usize>().ok());
    let moments = asked.unwrap_or(MOMENTS);
    std::thread::scope(|scope| {
        for worker in 0..AT_ONCE {
            let own = folder(&format!("signals-{worker}"));
            std::os::unix::fs::symlink(&dir, own.join("in")).unwrap();
            scope.spawn(move || {
                for (k, args) in COMMANDS.iter().enumerate().skip(worker).step_by(AT_ONCE) {
                    let (time, whole) = whole(&own, args);
                    let mut state = k as u64;
                    for moment in 0..moments {
                        state = state
                            .wrapping_mul(6_364_136_223_846_793_005)
                            .wrapping_add(1_442_695_040_888_963_407);
                        let share = (state >> 11) as f64 / (1_u64 << 53) as f64;
                        let signal = [Signal::SIGINT, Signal::SIGTERM][moment % 2];
                        interrupt(&own, args, &whole, (time.mul_f64(share), signal));
                    }
                }
            });
        }
    });
}

/// Limits that a shell sets: of processor time, and of the size of files.
#[test]
fn limits_of_the_system_leave_no_drafts() {
    let dir = folder("signals-limits");
    let limited = |limit: &str, args: &[&str]| {
        let script = format!("ulimit -S {limit}; exec \"$0\" \"$@\"");
        let mut command = Command::new("sh");
        command.args(["-c", &script, env!("CARGO_BIN_EXE_burgeon")]).args(args).current_dir(&dir);
        command.output().unwrap()
    };
    let oak = ["grow", "oak", "-o", "o.obj", "--lods", "2", "--png", "o.png"];
    let small = limited("-f 8", &oak);
    let said = String::from_utf8_lossy(&small.stderr).into_owned();
    assert_eq!(status(&small), 2, "{said}");
    assert!(said.contains("larger than the disk or a limit of this account allows"), "{said}");
    assert_eq!(names(&dir), Vec::<String>::new());
    let large = [&oak[..], &["--detail", "4", "--size", "4000x4000", "--threads", "1"]].concat();
    let short = limited("-t 1", &large);
    let said = String::from_utf8_lossy(&short.stderr).into_owned();
    assert_eq!(status(&short), 130, "{said}");
    assert!(said.contains("stopped"), "{said}");
    assert_eq!(names(&dir), Vec::<String>::new());
}

/// Output that nobody receives is not a success; a reader that closed the pipe has what it needs.
#[test]
fn a_full_disk_behind_standard_output_is_an_error() {
    let dir = folder("signals-full");
    fs::write(dir.join("rose.svg"), tools::FLOWER).unwrap();
    let Ok(full) = fs::File::options().write(true).open("/dev/full") else {
        return missing::skipped("/dev/full");
    };
    for args in [
        &["--help"][..],
        &["--version"],
        &["grow", "--help"],
        &["info", "rose.svg"],
        &["info", "rose.svg", "--json"],
        &["sketch", "rose.svg", "-o", "x.glb"],
        &["convert", "rose.svg", "-o", "x.json"],
        &["presets"],
        &["completions", "bash"],
        &["man", "pages"],
    ] {
        let run = |out: Stdio| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_burgeon"));
            command.args(args).current_dir(&dir).stdout(out).output().unwrap()
        };
        let out = run(full.try_clone().unwrap().into());
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(status(&out), 2, "{args:?}: {said}");
        assert!(
            said.starts_with("error: standard output: cannot be written: the disk is full"),
            "{args:?}: {said}"
        );
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let out = run(writer.into());
        assert_eq!((status(&out), out.stderr.len()), (0, 0), "{args:?}: {out:?}");
    }
    assert_eq!(status(&burgeon(&dir, &["--version"])), 0);
}
