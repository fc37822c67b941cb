//! The WASM build and the checks that run in Node.

use std::path::{Path, PathBuf};

use crate::toolchain::{TARGET, WasmCargo, is_root_on_debian, shown, wasm_cargo};
use crate::{Share, golden, native};
use xtask::shell::{
    Outcome, burgeon, command, debug_burgeon, finish, installed, output, prepare, repository, say, target_dir,
};

/// Tools for the WASM tests.
#[derive(Debug)]
pub(crate) struct Tools {
    cargo: WasmCargo,
    wasm_bindgen: PathBuf,
}

/// Installs missing tools.
pub(crate) fn setup() -> Outcome<Tools> {
    let node = output(prepare("node", &["--version"])).map_err(|missing| {
        let how = if is_root_on_debian() { " (Debian: `apt-get install nodejs npm`)" } else { "" };
        format!("Node is missing: install version 20 or newer{how} ({missing})")
    })?;
    say(&format!("node {}", node.trim()));
    let cargo = wasm_cargo()?;
    let wasm_bindgen = wasm_bindgen()?;
    if !node_folder().join("node_modules").exists() {
        say("$ npm ci (in xtask/node)");
        let mut c = prepare("npm", &["ci", "--no-fund", "--no-audit", "--silent"]);
        c.current_dir(node_folder());
        finish(c)?;
    }
    Ok(Tools { cargo, wasm_bindgen })
}

fn node_folder() -> PathBuf {
    repository().join("xtask/node")
}

/// Returns wasm-bindgen's program, of the version of the crate in the lock file.
fn wasm_bindgen() -> Outcome<PathBuf> {
    let lock =
        std::fs::read_to_string(repository().join("Cargo.lock")).map_err(|e| format!("Cargo.lock: {e}"))?;
    let version = lock
        .split("[[package]]")
        .find(|p| p.contains("name = \"wasm-bindgen\"\n"))
        .and_then(|p| p.split("version = \"").nth(1)?.split('"').next())
        .ok_or("Cargo.lock names no wasm-bindgen")?
        .to_owned();
    let only = ["--no-default-features", "--bin", "wasm-bindgen"];
    installed(("wasm-bindgen-cli", "wasm-bindgen"), &version, &only, "1")
}

/// Builds the WASM package, runs it in Node and compares it with the native program, and validates every GLB. `tested`:
/// whether the tests of the workspace have just run.
pub(crate) fn test(tools: &Tools, tested: bool, share: Share) -> Outcome {
    debug_burgeon(tested)?;
    let out = target_dir().join("xtask-test");
    let _ = std::fs::remove_dir_all(&out);
    std::fs::create_dir_all(&out).map_err(|e| format!("{}: {e}", shown(&out)))?;
    let wasm = build_wasm(tools, false)?;
    bindgen(tools, &wasm, "nodejs", &out.join("wasm"))?;
    let drawings = native::drawings()?;
    let native = native::models(&drawings, &out.join("native"), share)?;
    let (organs, leaves) = native::organs(&out, share)?;
    golden::check(&native, &organs, &out)?;
    say(&format!("$ node digests.mjs ({} drawings)", drawings.len()));
    let mut c = prepare("node", &["xtask/node/digests.mjs"]);
    c.arg(out.join("wasm/burgeon_wasm.js")).arg(&native).args(&drawings);
    finish(c)?;
    say("$ node organs.mjs (leaves, flowers and trees)");
    let mut c = prepare("node", &["xtask/node/organs.mjs"]);
    c.arg(out.join("wasm/burgeon_wasm.js")).arg(&organs).args([native::FRAMES, native::DETAIL]).args(&leaves);
    finish(c)?;
    let project = repository().join("fixtures/projects/version-5.burgeon");
    let report = out.join("scene.json");
    let mut c = prepare(burgeon("debug"), &[]);
    c.args(["sketch", "--quiet"]).arg(&project).arg("-o").arg(out.join("native/scene.glb"));
    c.arg("--report").arg(&report);
    finish(c)?;
    let mut c = prepare(burgeon("debug"), &[]);
    c.args(["sketch", "--quiet"]).arg(&project).arg("-o").arg(out.join("native/scene-text.gltf"));
    finish(c)?;
    say("$ node scene.mjs (a drawing, a tree and a flower in one project, with edits by hand)");
    let mut c = prepare("node", &["xtask/node/scene.mjs"]);
    c.arg(out.join("wasm/burgeon_wasm.js")).arg(&project).arg(&report);
    finish(c)?;
    say("$ node validate.mjs (Khronos validator)");
    let mut c = prepare("node", &["xtask/node/validate.mjs"]);
    c.arg(out.join("native"));
    finish(c)
}

/// Core that is built for a browser.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Core {
    /// The core of the Studio.
    Studio,
    /// The same with functions that only the checks in Node call.
    Checked,
    /// The core of the npm package: with all makers, or with trees alone.
    Npm {
        /// Whether it has all makers.
        makers: bool,
    },
}

/// Measures rounds of guided growth in Node, in the core as a browser runs it.
pub(crate) fn bench_growth(tools: &Tools) -> Outcome {
    let to = target_dir().join("xtask-bench");
    bindgen(tools, &build_core(tools, Core::Checked, true)?, "nodejs", &to)?;
    say("$ node guided.mjs");
    let mut c = prepare("node", &["xtask/node/guided.mjs"]);
    c.arg(to.join("burgeon_wasm.js"));
    finish(c)
}

/// Compiles the cores that tests need: each is made into a package where it is tested. The core of trees alone is
/// compiled there, too, as it replaces the other one of npm.
pub(crate) fn compile(tools: &Tools) -> Outcome {
    build_core(tools, Core::Checked, false).map(drop)
}

/// Builds the core for the browser and returns the file.
pub(crate) fn build_wasm(tools: &Tools, release: bool) -> Outcome<PathBuf> {
    build_core(tools, if release { Core::Studio } else { Core::Checked }, release)
}

/// Builds a core and returns the file, which the next build of the same package replaces.
pub(crate) fn build_core(tools: &Tools, core: Core, release: bool) -> Outcome<PathBuf> {
    let package = match core {
        Core::Studio | Core::Checked => "burgeon-wasm",
        Core::Npm { .. } => "burgeon-npm",
    };
    let mut args = vec!["build", "--target", TARGET];
    if release {
        args.extend(["--package", package, "--profile=web"]);
    } else {
        // Both packages, with the features of both: their shared dependencies are compiled once.
        args.extend(["--package", "burgeon-wasm", "--package", "burgeon-npm"]);
    }
    match core {
        Core::Checked if release => args.push("--features=checks"),
        Core::Npm { makers: false } => args.push("--no-default-features"),
        Core::Studio | Core::Checked | Core::Npm { makers: true } => {}
    }
    args.extend((!release).then_some("--features=burgeon-wasm/checks"));
    say(&format!("$ cargo {}", args.join(" ")));
    let mut c = tools.cargo.command(&args);
    if release {
        // The classifier's sums run four in parallel. The same bits: Rust never reorders floating-point sums by itself.
        c.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", "-Ctarget-feature=+simd128");
    } else if tools.cargo == WasmCargo::Own {
        // Code that only this target compiles passes no other check.
        c.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", "-Dwarnings");
    }
    finish(c)?;
    let built = match tools.cargo {
        WasmCargo::Own => target_dir(),
        WasmCargo::Debian => target_dir().join("debian"),
    };
    let profile = if release { "web" } else { "debug" };
    let name = format!("{}.wasm", package.replace('-', "_"));
    Ok(built.join(TARGET).join(profile).join(name))
}

/// Makes the JavaScript package of a built core: `target` is `nodejs` or `web`.
pub(crate) fn bindgen(tools: &Tools, wasm: &Path, target: &str, to: &Path) -> Outcome {
    let (wasm, to) = (wasm.to_string_lossy().into_owned(), to.to_string_lossy().into_owned());
    // Names of functions double the download and serve only debuggers.
    let slim = ["--remove-name-section", "--remove-producers-section"];
    let args = [&["--target", target, "--out-dir", &to][..], &slim, &[&wasm]].concat();
    command(&tools.wasm_bindgen, &args)
}
