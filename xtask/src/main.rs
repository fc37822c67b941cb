//! `cargo xtask`: set-up, checks and chores. Installs what is missing, so that a fresh machine with rustup and
//! Node needs nothing else.

mod archive;
mod blender;
mod golden;
mod minutes;
mod native;
mod notices;
mod npm;
mod python;
mod studio;
mod toolchain;
mod web;

use std::process::ExitCode;

use minutes::Minutes;
use xtask::shell::{self, Outcome, cargo, in_parallel, repository, say};

const HELP: &str = "\
cargo xtask COMMAND

  run            sets up what is missing, turns the sample sketch into out/sample.glb and a picture, then builds the
                 Studio and opens it with the sample (not with --no-open, in CI, or where there is no screen)
  studio [FILE]  builds the Studio and opens it; options of `burgeon studio` may follow
  build-web      builds the Studio as a folder of static files, apps/studio-web/dist
  test           sets up what the tests need and runs them: native, WASM in Node, Khronos validator, npm, Python, Studio.
                 With --all everything of it: all on one thread and on four, all species in each test,
                 all interruptions of commands and kills of pages, all journeys in a headset, whether the fuzz targets
                 compile, and the packages for people (npm, wheel, archive, extension for Blender)
  bless WHY      writes fixtures/digests.json anew where plants are meant to change, and the reason into CHANGELOG.md
  gallery        makes every fixture drawing and writes docs/gallery.md and docs/table1.md
  species [KEY..] grows every preset and scene of docs/trees.md and docs/shaping.md, and the Studio's small pictures, or
                 the presets that are named alone
  sheets [KEY..] makes a page of each species, or of these, to look at: nine seeds, four ages, three levels (out/sheets)
  flowers        makes the pictures of docs/bloom.md and of the venations in docs/leaves.md
  types          writes the schemas of specs and the TypeScript types of what travels between page and core
  habits         checks licences and versions of dependencies, spelling, numbers without a name, and that the crates could be
                 published
  layers         checks that each crate uses only what ARCHITECTURE.md allows, no modules in a circle, no two public
                 types of one name, and no test that is skipped unseen
  train-strokes  trains the stroke classifier from its table, and says what it and each rule are worth (docs/strokes.md)
  train-no-plants  learns what is no plant, from drawings in all styles; with --end, judges what is kept
  train-confidence  fits how likely a reading is right; with --end, measures it on what is kept
  read-drawings  reads drawings of people and made ones: kinds, numbers of plants, contact sheets (--part, --sheets),
                 or whether they are read alike when they are drawn in another way (--changed), or as programs write them
                 (--written)
  read-in-turn   draws drawings stroke by stroke in several orders: how often strokes become something else (docs/strokes.md)
  train-kinds    learns which kind of plant explains a whole drawing best (docs/strokes.md)
  train-glance   learns what drawings look like at a glance, from pictures that npm has (docs/strokes.md)
  test-web       the WASM, validator and Studio part of `test` alone
  test-studio    the Studio part of `test` alone
  test-python    the Python part of `test` alone (docs/python.md)
  blender        builds the extension for Blender, target/blender (docs/blender.md)
  test-blender   tests the extension without a window; no part of `test`, as it downloads Blender as a module (1 GB)
  archive        one file to download: the command with the Studio in it, manual pages, completions (target/archives)
  npm            builds the npm package as a tarball, target/npm, and says how large its cores are (docs/npm.md)
  test-npm       the npm part of `test` alone
  bench-npm      measures the npm package beside another maker of trees, in Node and in a browser
  wheel          builds the Python package for this system, target/wheels; with --manylinux for every Linux with glibc 2.28
                 or a newer one (blender takes it, too)
  bench-web      measures the Studio in a browser: pen, undo, opening, memory, first paint, transfer
  setup          installs the wasm32 target and the WASM tools only
";

/// Chores of the crate `lab`, which is compiled only for them.
const LABORATORY: [&str; 11] = [
    "gallery",
    "species",
    "sheets",
    "flowers",
    "train-strokes",
    "train-kinds",
    "train-glance",
    "train-no-plants",
    "train-confidence",
    "read-drawings",
    "read-in-turn",
];

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let rest = args.get(1..).unwrap_or_default();
    let outcome = match args.first().map(String::as_str) {
        Some("run") => run(rest),
        Some("test") => share(rest).and_then(test),
        Some("bless") => golden::bless(rest),
        Some(chore) if LABORATORY.contains(&chore) => laboratory(&args),
        Some("types") => types(),
        Some("habits" | "layers") => checks(&args),
        Some("studio") => web::setup().and_then(|tools| studio::open(&tools, rest)),
        Some("build-web") => web::setup().and_then(|tools| studio::build(&tools, true)),
        Some("test-web") => web::setup()
            .and_then(|tools| web::test(&tools, false, Share::Some).and_then(|()| test_studio(&tools))),
        Some("test-studio") => web::setup().and_then(|tools| test_studio(&tools)),
        Some("bench-web") => web::setup().and_then(|tools| studio::bench(&tools)),
        Some("archive") => archive::run(),
        Some("npm") => web::setup().and_then(|tools| npm::pack(&tools)),
        Some("test-npm") => web::setup().and_then(|tools| npm::test(&tools)),
        Some("bench-npm") => web::setup().and_then(|tools| npm::bench(&tools)),
        Some("wheel") => python::Reach::parse(rest).and_then(python::wheel),
        Some("test-python") => python::test(false),
        Some("blender") => python::Reach::parse(rest).and_then(blender::pack),
        Some("test-blender") => blender::test(),
        Some("setup") => web::setup().map(|_| ()),
        Some("help" | "-h" | "--help") | None => {
            say(HELP);
            Ok(())
        }
        Some(other) => Err(format!("no such command: {other}\n\n{HELP}")),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Runs a chore of the laboratory, optimised: most of them draw and read thousands of drawings.
fn laboratory(args: &[String]) -> Outcome {
    let lab = ["run", "--release", "--quiet", "--package", "burgeon-lab", "--"];
    cargo(&lab.into_iter().chain(args.iter().map(String::as_str)).collect::<Vec<_>>())
}

/// Runs a check of the sources, by the program that can parse them. Named as a program and not as a package, it uses
/// what the tests have compiled.
fn checks(args: &[String]) -> Outcome {
    let program = ["run", "--quiet", "--bin", "xtask-checks", "--"];
    cargo(&program.into_iter().chain(args.iter().map(String::as_str)).collect::<Vec<_>>())
}

/// Does the main job on the sample sketch, as a newcomer would.
fn run(args: &[String]) -> Outcome {
    let root = repository();
    let burgeon = shell::quick_burgeon()?;
    std::fs::create_dir_all(root.join("out")).map_err(|e| format!("cannot make the folder out: {e}"))?;
    say("\n$ burgeon sketch fixtures/sketches/sample.svg -o out/sample.glb --png out/sample.png");
    shell::command(
        &burgeon,
        &[
            "sketch",
            "fixtures/sketches/sample.svg",
            "-o",
            "out/sample.glb",
            "--png",
            "out/sample.png",
            "--report",
            "out/sample.json",
        ],
    )?;
    say("
Made from fixtures/sketches/sample.svg:
  out/sample.glb   the plant: open it in Blender, Godot, Unity or any glTF viewer
  out/sample.png   a picture of it
  out/sample.json  what each stroke was understood as, counts, times, fidelity
Next: draw your own (docs/drawings.md) and give it to the same command, target/quick/burgeon. That is built quickly;
`cargo build --release --package burgeon-cli` makes a quick one, target/release/burgeon.");
    if args.iter().any(|a| a == "--no-open") || studio::headless() {
        say(
            "The Studio is not opened here (--no-open, CI or no screen). `cargo xtask studio` builds and serves it.",
        );
        return Ok(());
    }
    say("\nNow the Studio: draw on the left, see it grow on the right.");
    let sample = root.join("fixtures/sketches/sample.svg").to_string_lossy().into_owned();
    studio::open(&web::setup()?, &[sample])
}

/// Runs the tests that compare schemas and TypeScript types, and lets them write these.
fn types() -> Outcome {
    let mut c = shell::prepare(
        shell::cargo_path(),
        &["test", "--workspace", "--test", "suite", "--", "schemas::", "wire::", "types::"],
    );
    c.env("BURGEON_WRITE_TYPES", "1");
    shell::finish(c)
}

fn test_studio(tools: &web::Tools) -> Outcome {
    studio::check(tools)?;
    studio::journeys(false, Share::All)?;
    studio::kills(Share::All)
}

/// Extent of the tests where a part is nearly as good a check as all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Share {
    /// A part, by a rule given where it is applied: in each run.
    Some,
    /// All: each night, and before a release.
    All,
}

fn share(args: &[String]) -> Outcome<Share> {
    match args {
        [] => Ok(Share::Some),
        [all] if all == "--all" => Ok(Share::All),
        _ => Err("`cargo xtask test` takes --all or nothing".into()),
    }
}

/// Number of moments at which each command is interrupted when all is tested.
const ALL_INTERRUPTS: &str = "20";

/// Runs everything that must be green. Steps that mostly wait run in parallel with those that compute.
fn test(share: Share) -> Outcome {
    let mut minutes = Minutes::default();
    let tools = minutes.measure("tools", web::setup)?;
    minutes
        .measure("tests and programs compiled", || cargo(&["test", "--workspace", "--no-run", "--quiet"]))?;
    minutes.measure("native tests, cores compiled", || {
        in_parallel(|| test_native(share), || web::compile(&tools))
    })?;
    minutes.measure("digests, WASM in Node, validator", || web::test(&tools, true, share))?;
    minutes.measure("npm", || npm::test(&tools))?;
    minutes.measure("the page in Node", || studio::check(&tools))?;
    minutes.measure("Python, kills of pages, journeys", || {
        let python_and_kills = || python::test(true).and_then(|()| studio::kills(share));
        in_parallel(python_and_kills, || studio::journeys(true, share))
    })?;
    if share == Share::All {
        minutes.measure("fuzz targets", fuzz_targets)?;
        minutes.measure("the npm package", || npm::pack(&tools))?;
        minutes.measure("the wheel", || python::wheel(python::Reach::Own))?;
        minutes.measure("the archive", archive::run)?;
        minutes.measure("the extension for Blender", || blender::pack(python::Reach::Own))?;
    }
    minutes.tell();
    Ok(())
}

/// Checks that the fuzz targets, which are a workspace of their own, compile: this needs neither `cargo fuzz` nor its
/// compiler.
fn fuzz_targets() -> Outcome {
    let target = shell::target_dir().join("fuzz");
    let mut c = shell::prepare(
        shell::cargo_path(),
        &["check", "--quiet", "--locked", "--manifest-path", "fuzz/Cargo.toml", "--target-dir"],
    );
    c.arg(target);
    shell::finish(c)
}

fn test_native(share: Share) -> Outcome {
    say("$ cargo test --workspace --no-fail-fast");
    let mut c = shell::prepare(shell::cargo_path(), &["test", "--workspace", "--no-fail-fast"]);
    if share == Share::All {
        c.envs([("BURGEON_TESTS", "all"), ("BURGEON_INTERRUPTS", ALL_INTERRUPTS)]);
    }
    shell::finish(c)?;
    // The library as users' programs call it: built with the tests.
    for (example, args) in [("inventory", &[][..]), ("stand", &["hazel", "--seeds", "2", "--ages", "5,10"])] {
        say(&format!("$ {example} {}", args.join(" ")));
        shell::command(shell::example(example), args)?;
    }
    Ok(())
}
