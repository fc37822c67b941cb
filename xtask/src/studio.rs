//! The Studio: its packages, its build, and its tests in a real browser.

use std::path::PathBuf;
use std::process::Command;

use crate::Share;
use crate::toolchain::{apt_install, is_root_on_debian};
use crate::web::{Tools, bench_growth, bindgen, build_wasm};
use xtask::shell::{
    Outcome, burgeon, debug_burgeon, finish, output, prepare, quick_burgeon, repository, say, target_dir,
};

fn folder() -> PathBuf {
    repository().join("apps/studio-web")
}

/// Runs an npm command in the Studio's folder.
fn npm(args: &[&str]) -> Outcome {
    say(&format!("$ npm {} (in apps/studio-web)", args.join(" ")));
    let program = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let mut c = prepare(program, args);
    c.current_dir(folder());
    finish(c)
}

/// Installs the packages of the lock file, if others are installed.
fn packages() -> Outcome {
    let lock = folder().join("package-lock.json");
    let stamp = folder().join("node_modules/.burgeon-lock");
    let wanted = std::fs::read(&lock).map_err(|e| format!("{}: {e}", lock.display()))?;
    if std::fs::read(&stamp).is_ok_and(|there| there == wanted) {
        return Ok(());
    }
    npm(&["ci", "--no-fund", "--no-audit", "--silent"])?;
    std::fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))
}

/// Builds the page as a folder of static files: `apps/studio-web/dist`, which goes into the program, or for tests
/// `apps/studio-web/dist-test`, whose core is quicker to build.
pub(crate) fn build(tools: &Tools, release: bool) -> Outcome {
    packages()?;
    let wasm = build_wasm(tools, release)?;
    bindgen(tools, &wasm, "web", &folder().join("src/wasm"))?;
    let (to, mode) = if release { ("dist", "production") } else { ("dist-test", "test") };
    npm(&["run", "--silent", "build", "--", "--logLevel", "warn", "--outDir", to, "--mode", mode])?;
    if release { renew_program() } else { Ok(()) }
}

/// Packs the stage alone as one script, which the Python package contains, and puts it into `to`.
pub(crate) fn alone(to: &std::path::Path) -> Outcome {
    packages()?;
    npm(&["run", "--silent", "build", "--", "--config", "vite.alone.config.ts", "--logLevel", "warn"])?;
    let from = folder().join("dist-alone/alone.js.gz");
    std::fs::copy(&from, to).map(drop).map_err(|e| format!("{} to {}: {e}", from.display(), to.display()))
}

/// Makes cargo look for the page when it next builds the program: it cannot watch a folder that did not exist.
fn renew_program() -> Outcome {
    let script = repository().join("apps/cli/build.rs");
    let touched = std::fs::File::options().append(true).open(&script);
    let touched = touched.and_then(|file| file.set_modified(std::time::SystemTime::now()));
    touched.map_err(|e| format!("{}: {e}", script.display()))
}

/// Whether there is no screen for a browser, or nobody to look at it.
pub(crate) fn headless() -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|v| !v.is_empty());
    let screenless = cfg!(target_os = "linux") && !set("DISPLAY") && !set("WAYLAND_DISPLAY");
    set("CI") || screenless
}

/// Builds the Studio and serves it until Ctrl-C; `args` go to `burgeon studio`.
pub(crate) fn open(tools: &Tools, args: &[String]) -> Outcome {
    build(tools, true)?;
    let mut c = prepare(quick_burgeon()?, &["studio"]);
    c.args(args);
    finish(c)
}

/// Checks the page: types, style, texts and geometry in Node.
pub(crate) fn check(tools: &Tools) -> Outcome {
    build(tools, false)?;
    npm(&["run", "--silent", "check"])?;
    npm(&["run", "--silent", "lint"])?;
    npm(&["run", "--silent", "test"])
}

/// Runs the main journeys in a browser, once [`check()`] has built the page; of those in a headset one, or all of them.
/// `tested`: whether the tests of the workspace have just run.
pub(crate) fn journeys(tested: bool, share: Share) -> Outcome {
    let Some(browser) = browser() else {
        say("skipped: the Studio's journeys need Chromium; install it or name it in BURGEON_CHROMIUM");
        return Ok(());
    };
    chinese_letters();
    debug_burgeon(tested)?;
    say(&format!("$ node e2e/run.mjs ({})", browser.display()));
    let mut c = prepare("node", &["e2e/run.mjs"]);
    c.current_dir(folder()).arg(&browser).arg(burgeon("debug")).arg(target_dir().join("studio-test"));
    if share == Share::All {
        c.env("HEADSETS", "all");
    }
    finish(c)?;
    say("$ node e2e/morph.mjs");
    let mut c = prepare("node", &["e2e/morph.mjs"]);
    c.current_dir(folder()).arg(browser).arg(burgeon("debug")).arg(target_dir().join("morph-test"));
    finish(c)
}

/// Number of pages that are killed in each run: eight rounds of four, one of them with the whole browser. All are 200.
const SOME_KILLS: &str = "30";

/// Kills pages at any moment and checks that their strokes survive, once [`check()`] has built the page.
pub(crate) fn kills(share: Share) -> Outcome {
    let Some(browser) = browser() else { return Ok(()) };
    say("$ node e2e/kills.mjs");
    let mut c = prepare("node", &["e2e/kills.mjs"]);
    c.current_dir(folder()).arg(&browser).arg(burgeon("debug"));
    if share == Share::Some && std::env::var_os("KILLS").is_none() {
        c.env("KILLS", SOME_KILLS);
    }
    finish(c)
}

/// Measures the released Studio in a browser and prints a table.
pub(crate) fn bench(tools: &Tools) -> Outcome {
    bench_growth(tools)?;
    build(tools, true)?;
    let browser = browser().ok_or("Chromium is missing: install it or name it in BURGEON_CHROMIUM")?;
    debug_burgeon(false)?;
    for script in ["e2e/evaluate.mjs", "e2e/held.mjs"] {
        say(&format!("$ node {script}"));
        let mut c = prepare("node", &[script]);
        c.current_dir(folder());
        finish(c)?;
    }
    say(&format!("$ node e2e/bench.mjs ({})", browser.display()));
    let mut c = prepare("node", &["e2e/bench.mjs"]);
    c.current_dir(folder()).arg(browser).arg(burgeon("debug"));
    finish(c)
}

/// Installs a small font (1.6 MB) with Chinese letters, if there is none and no question is needed: without one the
/// journeys pass, and their pictures show boxes.
fn chinese_letters() {
    let there = output(prepare("fc-list", &[":lang=zh"])).is_ok_and(|fonts| !fonts.trim().is_empty());
    if there || !is_root_on_debian() {
        return;
    }
    let install = || apt_install(&["fonts-wqy-microhei"]);
    let updated = || finish(prepare("apt-get", &["update", "-qq"])).and_then(|()| install());
    if let Err(e) = install().or_else(|_| updated()) {
        say(&e);
    }
}

/// Returns a Chromium: named, found, or installed if that needs no question.
pub(crate) fn browser() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("BURGEON_CHROMIUM") {
        return Some(named.into());
    }
    // The whole path: the launcher of the browser uses no search path.
    let find = || {
        let folders: Vec<PathBuf> =
            std::env::var_os("PATH").map(|p| std::env::split_paths(&p).collect()).unwrap_or_default();
        ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"]
            .into_iter()
            .flat_map(|name| folders.iter().map(move |folder| folder.join(name)))
            .find(|path| {
                let mut c = Command::new(path);
                c.arg("--version");
                path.is_file() && output(c).is_ok()
            })
    };
    find().or_else(|| {
        if !is_root_on_debian() {
            return None;
        }
        let update = || finish(prepare("apt-get", &["update", "-qq"]));
        let installed =
            apt_install(&["chromium"]).or_else(|_| update().and_then(|()| apt_install(&["chromium"])));
        if let Err(e) = installed {
            say(&e);
        }
        find()
    })
}
