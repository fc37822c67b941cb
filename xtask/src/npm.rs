//! The npm package: its core, its types, its build, its tests in Node and in a browser.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::notices::{self, NOTICES};
use crate::studio::browser;
use crate::toolchain::shown;
use crate::web::{Core, Tools, bindgen, build_core};
use xtask::shell::{Outcome, burgeon, finish, output, prepare, repository, say, target_dir};

/// Most bytes of a core that makes only trees, as a page downloads it, compressed (gzip -9).
const GROWTH_BYTES: u64 = 900_000;

/// The two cores: the folder of each, and whether it makes more than trees.
const CORES: [(&str, bool); 2] = [("core", true), ("growth/core", false)];

fn folder() -> PathBuf {
    repository().join("apps/npm")
}

/// Returns an npm command in the package's folder.
fn npm(args: &[&str]) -> std::process::Command {
    say(&format!("$ npm {} (in apps/npm)", args.join(" ")));
    let mut c = prepare(if cfg!(windows) { "npm.cmd" } else { "npm" }, args);
    c.current_dir(folder());
    c
}

/// Installs the packages of the lock file, if others are installed.
fn packages() -> Outcome {
    let stamp = folder().join("node_modules/.burgeon-lock");
    let lock = folder().join("package-lock.json");
    let wanted = std::fs::read(&lock).map_err(|e| format!("{}: {e}", shown(&lock)))?;
    if std::fs::read(&stamp).is_ok_and(|there| there == wanted) {
        return Ok(());
    }
    finish(npm(&["ci", "--no-fund", "--no-audit", "--silent"]))?;
    std::fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", shown(&stamp)))
}

/// Builds the package into `apps/npm/dist`: for users, or for tests, whose core is quicker to build.
fn build(tools: &Tools, release: bool) -> Outcome {
    packages()?;
    let dist = folder().join("dist");
    let _ = std::fs::remove_dir_all(&dist);
    for (place, makers) in CORES {
        let wasm = build_core(tools, Core::Npm { makers }, release)?;
        let to = folder().join("lib").join(place);
        bindgen(tools, &wasm, "web", &to)?;
        copy(&to, &dist.join(place))?;
    }
    say("$ biome check (in apps/npm)");
    let mut c =
        prepare("node", &["node_modules/@biomejs/biome/bin/biome", "check", "--error-on-warnings", "."]);
    c.current_dir(folder());
    finish(c)?;
    say("$ tsc (in apps/npm)");
    let mut c = prepare("node", &["node_modules/typescript/bin/tsc", "-p", "."]);
    c.current_dir(folder());
    finish(c)?;
    notices::write("burgeon-npm", false, &folder().join(NOTICES))?;
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
        let to = folder().join(licence);
        std::fs::copy(repository().join(licence), &to).map_err(|e| format!("{}: {e}", shown(&to)))?;
    }
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Outcome {
    let fault = |path: &Path, e: std::io::Error| format!("{}: {e}", shown(path));
    std::fs::create_dir_all(to).map_err(|e| fault(to, e))?;
    for entry in std::fs::read_dir(from).map_err(|e| fault(from, e))?.filter_map(Result::ok) {
        let target = to.join(entry.file_name());
        std::fs::copy(entry.path(), &target).map_err(|e| fault(&target, e))?;
    }
    Ok(())
}

/// `cargo xtask npm`: packs the package for users as a tarball in `target/npm`. Fails if the small core is too large.
pub(crate) fn pack(tools: &Tools) -> Outcome {
    build(tools, true)?;
    for (place, makers) in CORES {
        let wasm = folder().join("dist").join(place).join("burgeon_npm_bg.wasm");
        let zip = "process.stdout.write(String(require('zlib').gzipSync(require('fs').readFileSync(process.argv[1]), \
                   { level: 9 }).length))";
        let mut c = prepare("node", &["-e", zip]);
        c.arg(&wasm);
        let size: u64 = output(c)?.trim().parse().map_err(|e| format!("{}: {e}", shown(&wasm)))?;
        say(&format!("{}: {} kB, compressed (gzip -9)", shown(&wasm), size.div_ceil(1000)));
        if !makers && size > GROWTH_BYTES {
            return Err(format!("{}: more than {} kB, compressed", shown(&wasm), GROWTH_BYTES / 1000));
        }
    }
    let tarball = tarball()?;
    say(&format!("{}: `npm install` takes it", shown(&tarball)));
    Ok(())
}

fn tarball() -> Outcome<PathBuf> {
    let out = target_dir().join("npm");
    let _ = std::fs::remove_dir_all(&out);
    std::fs::create_dir_all(&out).map_err(|e| format!("{}: {e}", shown(&out)))?;
    let mut c = npm(&["pack", "--silent", "--ignore-scripts", "--pack-destination"]);
    c.arg(&out);
    finish(c)?;
    let files = std::fs::read_dir(&out).map_err(|e| format!("{}: {e}", shown(&out)))?;
    let found =
        files.filter_map(Result::ok).map(|e| e.path()).find(|p| p.extension().is_some_and(|e| e == "tgz"));
    found.ok_or_else(|| format!("{}: npm left no tarball", shown(&out)))
}

/// Builds the package as tests need it, and tests it: as it would be installed, in Node and in a browser.
pub(crate) fn test(tools: &Tools) -> Outcome {
    let started = Instant::now();
    build(tools, false)?;
    let tarball = tarball()?;
    let out = target_dir().join("npm-test");
    say("$ node tests/node.mjs (in apps/npm)");
    let mut c = prepare("node", &["--test-reporter=dot", "--test", "tests/node.mjs"]);
    c.current_dir(folder()).env("BURGEON_TARBALL", &tarball).env("BURGEON", burgeon("debug"));
    finish(c)?;
    let Some(browser) = browser() else {
        say(
            "skipped: the examples of the npm package need Chromium; install it or name it in BURGEON_CHROMIUM",
        );
        return Ok(());
    };
    say(&format!("$ node tests/browser.mjs ({})", browser.display()));
    let mut c = prepare("node", &["tests/browser.mjs"]);
    c.current_dir(folder()).arg(browser).arg(&out).env("BURGEON_TARBALL", &tarball);
    finish(c)?;
    say(&format!("npm: {} s", started.elapsed().as_secs()));
    Ok(())
}

/// Measures the packed package and another maker of trees, in Node and in a browser.
pub(crate) fn bench(tools: &Tools) -> Outcome {
    pack(tools)?;
    let browser = browser().ok_or("Chromium is missing: install it or name it in BURGEON_CHROMIUM")?;
    say(&format!("$ node bench/peers/npm.mjs ({})", browser.display()));
    let mut c = prepare("node", &["bench/peers/npm.mjs"]);
    c.arg(browser);
    finish(c)
}
