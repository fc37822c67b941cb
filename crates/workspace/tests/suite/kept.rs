//! Every input of `fuzz/kept` and every large generated one, through its fuzz target, on any compiler.
//!
//! `BURGEON_KEPT_MUTANTS=200` tries as many mutants of each kept input as well: fuzzing for those without a nightly
//! compiler. A failure names target, input and mutant, and is reproducible. `BURGEON_KEPT_TARGET=reading` takes the
//! targets of that name only, `BURGEON_KEPT_FIRST=200` other mutants, `BURGEON_KEPT_SAYS=1` prints each input before it
//! is run.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use base::{Draw, Seed, Stream};

use super::piles::Pile;

#[path = "../../../../fuzz/src/lib.rs"]
#[expect(unreachable_pub, reason = "what the crate of fuzz targets gives to its programs")]
mod targets;

use targets::TARGETS;

const FUZZ: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz");

/// Time limit of one input in a development build on a busy machine: the slowest takes a tenth of it.
const ONE_INPUT: Duration = Duration::from_secs(60);
/// Time limit of one mutant.
const ONE_MUTANT: Duration = Duration::from_secs(25);

/// Returns the kept inputs of each target, by their names, in their order.
fn kept() -> BTreeMap<String, Vec<(String, Vec<u8>)>> {
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    let list = |folder: &Path| {
        let entries = fs::read_dir(folder).expect("a folder of the repository");
        let mut paths: Vec<_> = entries.map(|e| e.expect("an entry").path()).collect();
        paths.sort();
        paths
    };
    let mut folders = list(&Path::new(FUZZ).join("kept"));
    // A part of the command, which replays its inputs itself.
    folders.retain(|folder| name(folder) != "request");
    let read = |file: &Path| (name(file), fs::read(file).expect("a file of the repository"));
    folders.iter().map(|f| (name(f), list(f).iter().map(|file| read(file)).collect())).collect()
}

/// Checks that every target is a program that runs each night, has its function, and has small kept inputs.
#[test]
fn every_target_has_a_function_and_kept_inputs() {
    let manifest = fs::read_to_string(Path::new(FUZZ).join("Cargo.toml")).expect("a file of the repository");
    let bins = manifest.split("[[bin]]").skip(1);
    let name = |bin: &str| bin.split('"').nth(1).expect("its name").to_owned();
    let mut programs: Vec<String> = bins.map(name).filter(|n| n != "request").collect();
    programs.sort();
    let mut functions: Vec<&str> = TARGETS.iter().map(|(name, _)| *name).collect();
    functions.sort_unstable();
    assert_eq!(programs, functions);
    let kept = kept();
    assert_eq!(
        kept.keys().map(String::as_str).collect::<Vec<_>>(),
        functions,
        "each has a folder in fuzz/kept"
    );
    for (target, inputs) in kept {
        assert!(!inputs.is_empty(), "{target} keeps nothing");
        for (input, bytes) in inputs {
            assert!(bytes.len() <= 16 << 10, "{target}/{input}: {} bytes; make large ones here", bytes.len());
        }
    }
}

/// Runs a target and returns whether it accepted its input, and how long that took.
fn run_timed(target: &str, input: &str, bytes: &[u8], most: Duration) -> (bool, Duration) {
    if std::env::var_os(targets::SAYS).is_some() {
        eprintln!("{target}/{input}\n{}", bytes[..bytes.len().min(16 << 10)].escape_ascii());
    }
    let from = Instant::now();
    let ended = std::panic::catch_unwind(|| targets::run(target, bytes));
    let took = from.elapsed();
    assert!(took < most, "{target}/{input} took {took:?}");
    (ended.unwrap_or_else(|_| panic!("{target}/{input}: see above")), took)
}

/// Names that begin with `bad-` are refused, all others accepted: so the targets do get as far as they should.
#[test]
fn every_kept_input_is_refused_or_sound_as_its_name_says() {
    let (mut count, mut slowest, mut wrong) = (0, (Duration::ZERO, String::new()), Vec::new());
    for (target, inputs) in kept() {
        for (input, bytes) in inputs {
            let (taken, took) = run_timed(&target, &input, &bytes, ONE_INPUT);
            if taken == input.starts_with("bad-") {
                wrong.push(format!("{target}/{input}: {}", if taken { "was taken" } else { "was refused" }));
            }
            slowest = slowest.max((took, format!("{target}/{input}")));
            count += 1;
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    println!("{count} inputs; the slowest: {} in {:?}", slowest.1, slowest.0);
}

/// Tests that a reader asks the shell for files that a model names, by the name in the file, and never opens them; a
/// `<use>` of itself ends, and the rest of the drawing is read.
#[test]
fn what_files_refer_to_is_not_followed() {
    use burgeon::formats::{DrawingFormat, ExportSpec, ModelFormat, no_files, read_drawings, read_model};
    let kept = kept();
    let bytes = |target: &str, input: &str| -> &[u8] {
        let found = kept[target].iter().find(|(name, _)| name == input);
        found.map(|(_, bytes)| bytes.as_slice()).expect("a kept input")
    };
    let gltf = &bytes("links", "bad-gltf-whose-buffer-lies-above-its-folder")["a.gltf\n".len()..];
    let mut report = burgeon::Report::default();
    let read = read_model(gltf, ModelFormat::Gltf, "m", &ExportSpec::default(), &no_files, &mut report);
    assert!(read.expect_err("without its buffer").to_string().contains("../../../etc/passwd"));
    let svg = bytes("svg", "use-that-refers-to-itself.svg");
    let read = read_drawings(svg, DrawingFormat::Svg, "m").next().expect("one drawing");
    assert_eq!(read.expect("the rest of it").drawing.strokes.len(), 1);
}

/// Returns a drawing of a pile as a text of the target `reading`.
fn strokes(pile: Pile, count: u32) -> Vec<u8> {
    let mut text = String::new();
    for stroke in &pile.drawing(count).strokes {
        for sample in &stroke.samples {
            let _ = write!(text, "{:.3} {:.3} ", sample.at.x, sample.at.y);
        }
        text.push('\n');
    }
    text.into_bytes()
}

/// Returns a growth table of this many rows: as many plants as give each 25 days.
fn growth_table(rows: u32) -> Vec<u8> {
    let mut text = String::from("# unit: mm\nday,size,plant\n");
    for row in 0..rows {
        let (plant, day) = (row / 25, row % 25);
        let size = 200.0 / (1.0 + 20.0 * base::ops::exp(-0.3 * f64::from(day))) + f64::from(plant % 7);
        let _ = writeln!(text, "{day},{size:.3},{plant}");
    }
    text.into_bytes()
}

/// Returns a triangle after this many lines that name the same library of materials.
fn libraries(lines: usize) -> Vec<u8> {
    let lines = "mtllib a.mtl\n".repeat(lines);
    let shape = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3";
    format!("a.obj\n{lines}{shape}\n=== a.mtl\nnewmtl red\nKd 1 0 0\n").into_bytes()
}

/// Inputs that are large, and therefore generated: the other deeds of hostile files.
#[test]
fn large_hostile_inputs_are_refused_or_sound() {
    let svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\">{}", "<g>".repeat(100_000)).into_bytes();
    let spec = format!("tree\nname = {}", "[".repeat(100_000)).into_bytes();
    let mut inputs: Vec<(&str, &str, bool, Vec<u8>)> = vec![
        // The stem copied onto itself, until the plant is too large.
        ("copies", "copies of copies of copies", false, [0, 0, 128].repeat(30)),
        ("law_after", "a growth table of 3,000 rows", true, growth_table(3_000)),
        ("marks", "a growth table of 200,000 rows", true, growth_table(200_000)),
        ("links", "an OBJ with 20,000 mtllib lines", true, libraries(20_000)),
        ("svg", "100,000 groups, never closed", false, svg),
        ("json", "100,000 open lists", false, "[".repeat(100_000).into_bytes()),
        ("specs", "100,000 open lists", false, spec),
    ];
    inputs.extend(Pile::ALL.map(|pile| ("reading", pile.name(), true, strokes(pile, 700))));
    for (target, input, is_good, bytes) in inputs {
        let (taken, took) = run_timed(target, input, &bytes, ONE_INPUT);
        assert_eq!(taken, is_good, "{target}: {input}");
        println!("{target}: {input}: {took:?}");
    }
}

/// Words that break readers: huge numbers, openings without closings, separators.
const NASTY: [&[u8]; 24] = [
    b"NaN",
    b"1e999",
    b"-1e300",
    b"1e-400",
    b"99999999999999999999",
    b"-",
    b"\0",
    b"\xff\xff\xff\xff",
    b"<",
    b">",
    b"\"",
    b"[[[[",
    b"{\"a\":",
    b"#",
    b"]",
    b"}",
    b",",
    b"\n",
    b"null",
    b"4294967295",
    b"\x7f\x7f\x7f\x7f",
    b"0",
    b"=",
    b"../",
];

/// Changes a kept input in one to six places.
fn mutant(bytes: &[u8], random: &mut Stream) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(6) {
        if bytes.is_empty() {
            break;
        }
        let at = random.below(bytes.len());
        let end = at + random.below(1 + (bytes.len() - at).min(40));
        let word = NASTY[random.below(NASTY.len())];
        match random.below(7) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = u8::try_from(random.below(256)).unwrap_or_default(),
            2 => drop(bytes.drain(at..end)),
            3 => {
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, copy);
            }
            4 => drop(bytes.splice(at..at, word.iter().copied())),
            5 => drop(bytes.splice(at..end, word.iter().copied())),
            _ => {
                // Another number: readers rely too much on counts, places and sizes.
                if let Some(digit) = bytes[at..].iter().position(u8::is_ascii_digit) {
                    bytes[at + digit] = b'0' + u8::try_from(random.below(10)).unwrap_or_default();
                    if random.below(2) == 0 {
                        bytes.splice(at + digit..at + digit, *b"98");
                    }
                }
            }
        }
    }
    bytes
}

/// On demand: `BURGEON_KEPT_MUTANTS` of each kept input, of the targets whose names begin with `BURGEON_KEPT_TARGET`.
#[test]
fn mutants_of_kept_inputs_are_refused_or_sound() {
    let wanted = std::env::var("BURGEON_KEPT_MUTANTS").ok().and_then(|n| n.parse().ok()).unwrap_or(1_u64);
    let first = std::env::var("BURGEON_KEPT_FIRST").ok().and_then(|n| n.parse().ok()).unwrap_or(0_u64);
    let only = std::env::var("BURGEON_KEPT_TARGET").unwrap_or_default();
    for (target, inputs) in kept().into_iter().filter(|(target, _)| target.starts_with(&only)) {
        let (mut count, mut slowest) = (0, Duration::ZERO);
        let from = Instant::now();
        for (input, bytes) in &inputs {
            // Seeded by the name, so that a mutant stays the same when other inputs are added.
            let seed = input.bytes().fold(Seed::new(1), |seed, byte| seed.child(u64::from(byte)));
            for k in first..first + wanted {
                let mut random = seed.child(k).stream(Draw::Test);
                let (_, took) = run_timed(
                    &target,
                    &format!("{input}, mutant {k}"),
                    &mutant(bytes, &mut random),
                    ONE_MUTANT,
                );
                slowest = slowest.max(took);
                count += 1;
            }
        }
        println!("{target}: {count} mutants in {:?}, the slowest in {slowest:?}", from.elapsed());
    }
}
