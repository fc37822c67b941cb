//! `cargo xtask`: set-up, checks and chores. Installs what is missing, so that a fresh machine with rustup and
//! Node needs nothing else.

mod ablation;
mod adam;
mod archive;
mod bare_numbers;
mod blender;
mod circles;
mod contact_sheet;
mod flowers;
mod gallery;
mod golden;
mod habits;
mod layers;
mod made_drawings;
mod made_strokes;
mod names;
mod native;
mod npm;
mod pixels;
mod python;
mod quickdraw;
mod read_drawings;
mod read_in_turn;
mod scenes;
mod sheets;
mod shell;
mod skips;
mod species;
mod studio;
mod toolchain;
mod train_glance;
mod train_kinds;
mod train_strokes;
mod web;
mod workshop;

use std::process::ExitCode;

use shell::{Outcome, beside, cargo, repository, say};

const HELP: &str = "\
cargo xtask COMMAND

  run            sets up what is missing, turns the sample sketch into out/sample.glb and a picture, then builds the
                 Studio and opens it with the sample (not with --no-open, in CI, or where there is no screen)
  studio [FILE]  builds the Studio and opens it; options of `burgeon studio` may follow
  build-web      builds the Studio as a folder of static files, apps/studio-web/dist
  test           sets up what the tests need and runs them all: native, WASM in Node, Khronos validator, npm, Python, Studio
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
  read-drawings  reads drawings of people and made ones: kinds, numbers of plants, contact sheets (--part, --sheets),
                 or whether they are read alike when they are drawn in another way (--changed)
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
  wheel          builds the Python package for this system, target/wheels
  bench-web      measures the Studio in a browser: pen, undo, opening, memory, first paint, transfer
  setup          installs the wasm32 target and the WASM tools only
";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let rest = args.get(1..).unwrap_or_default();
    let outcome = match args.first().map(String::as_str) {
        Some("run") => run(rest),
        Some("test") => test(),
        Some("bless") => golden::bless(rest),
        Some("gallery") => gallery::run(),
        Some("species") => species::run(rest),
        Some("sheets") => sheets::run(rest),
        Some("flowers") => flowers::run(),
        Some("types") => types(),
        Some("habits") => habits::check(),
        Some("layers") => {
            [layers::check, circles::check, names::check, skips::check].iter().try_for_each(|check| check())
        }
        Some("train-kinds") => train_kinds::run(rest),
        Some("train-glance") => train_glance::run(rest),
        Some("train-strokes") => train_strokes::run(rest),
        Some("read-drawings") => read_drawings::run(rest),
        Some("read-in-turn") => read_in_turn::run(rest),
        Some("studio") => web::setup().and_then(|tools| studio::open(&tools, rest)),
        Some("build-web") => web::setup().and_then(|tools| studio::build(&tools, true)),
        Some("test-web") => {
            web::setup().and_then(|tools| web::test(&tools, false).and_then(|()| test_studio(&tools)))
        }
        Some("test-studio") => web::setup().and_then(|tools| test_studio(&tools)),
        Some("bench-web") => web::setup().and_then(|tools| studio::bench(&tools)),
        Some("archive") => archive::run(),
        Some("npm") => web::setup().and_then(|tools| npm::pack(&tools)),
        Some("test-npm") => web::setup().and_then(|tools| npm::test(&tools)),
        Some("bench-npm") => web::setup().and_then(|tools| npm::bench(&tools)),
        Some("wheel") => python::wheel(),
        Some("test-python") => python::test(false),
        Some("blender") => blender::pack(),
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

/// The main job on the sample sketch, as a newcomer would do it.
fn run(args: &[String]) -> Outcome {
    let root = repository();
    let burgeon = shell::built_burgeon()?;
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
Next: draw your own (docs/drawings.md) and give it to the same command.");
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

/// The tests that compare schemas and TypeScript types write them, too.
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
    studio::journeys(false)?;
    studio::kills()
}

/// Everything that must be green. What waits much runs beside what computes.
fn test() -> Outcome {
    let tools = web::setup()?;
    cargo(&["test", "--workspace", "--no-run", "--quiet"])?;
    beside(test_native, || web::compile(&tools))?;
    web::test(&tools, true)?;
    npm::test(&tools)?;
    studio::check(&tools)?;
    beside(|| python::test(true).and_then(|()| studio::kills()), || studio::journeys(true))?;
    Ok(())
}

fn test_native() -> Outcome {
    cargo(&["test", "--workspace", "--no-fail-fast"])?;
    // The library as programs of their own use it: built with the tests.
    for (example, args) in [("inventory", &[][..]), ("stand", &["hazel", "--seeds", "2", "--ages", "5,10"])] {
        say(&format!("$ {example} {}", args.join(" ")));
        shell::command(shell::example(example), args)?;
    }
    Ok(())
}
