//! The WASM build and the checks that run in Node.

use std::path::{Path, PathBuf};

use crate::golden;
use crate::shell::{
    Outcome, burgeon, cache_dir, cargo_path, command, debug_burgeon, finish, output, prepare, repository,
    say, target_dir,
};
use crate::toolchain::{TARGET, WasmCargo, is_root_on_debian, shown, wasm_cargo};

/// Everything that the WASM tests need.
#[derive(Debug)]
pub(crate) struct Tools {
    cargo: WasmCargo,
    wasm_bindgen: PathBuf,
}

/// Installs what is missing.
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

/// wasm-bindgen's program, of the version of the crate in the lock file.
fn wasm_bindgen() -> Outcome<PathBuf> {
    let lock =
        std::fs::read_to_string(repository().join("Cargo.lock")).map_err(|e| format!("Cargo.lock: {e}"))?;
    let version = lock
        .split("[[package]]")
        .find(|p| p.contains("name = \"wasm-bindgen\"\n"))
        .and_then(|p| p.split("version = \"").nth(1)?.split('"').next())
        .ok_or("Cargo.lock names no wasm-bindgen")?
        .to_owned();
    let root = cache_dir().join(format!("wasm-bindgen-{version}"));
    let program = root.join("bin").join(format!("wasm-bindgen{}", std::env::consts::EXE_SUFFIX));
    if program.exists() {
        return Ok(program);
    }
    say(&format!("$ cargo install wasm-bindgen-cli --version ={version} (once)"));
    // No --locked: the lock file inside that crate may name versions that a registry does not serve.
    let root_arg = root.to_string_lossy().into_owned();
    let exact = format!("={version}");
    let mut c = prepare(cargo_path(), &["install", "--quiet", "wasm-bindgen-cli", "--version", &exact]);
    c.args(["--no-default-features", "--bin", "wasm-bindgen", "--root", &root_arg]);
    c.env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1");
    finish(c)?;
    Ok(program)
}

/// Builds the WASM package, runs it in Node beside the native program, and validates every GLB. `tested`: the tests of
/// the workspace have just run.
pub(crate) fn test(tools: &Tools, tested: bool) -> Outcome {
    debug_burgeon(tested)?;
    let out = target_dir().join("xtask-test");
    let _ = std::fs::remove_dir_all(&out);
    std::fs::create_dir_all(&out).map_err(|e| format!("{}: {e}", shown(&out)))?;
    let wasm = build_wasm(tools, false)?;
    bindgen(tools, &wasm, "nodejs", &out.join("wasm"))?;
    let drawings = fixture_drawings()?;
    let native = native_models(&drawings, &out.join("native"))?;
    let (organs, leaves) = native_organs(&out)?;
    golden::check(&native, &organs, &out)?;
    say(&format!("$ node digests.mjs ({} drawings)", drawings.len()));
    let mut c = prepare("node", &["xtask/node/digests.mjs"]);
    c.arg(out.join("wasm/burgeon_wasm.js")).arg(&native).args(&drawings);
    finish(c)?;
    say("$ node organs.mjs (leaves, flowers and trees)");
    let mut c = prepare("node", &["xtask/node/organs.mjs"]);
    c.arg(out.join("wasm/burgeon_wasm.js")).arg(&organs).args([FRAMES, DETAIL]).args(&leaves);
    finish(c)?;
    let project = repository().join("fixtures/projects/version-4.burgeon");
    let report = out.join("scene.json");
    let mut c = prepare(burgeon("debug"), &[]);
    c.args(["sketch", "--quiet"]).arg(&project).arg("-o").arg(out.join("native/scene.glb"));
    c.arg("--report").arg(&report);
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

/// The report of all drawings and the digests of leaves, flowers and trees, by the native program alone.
pub(crate) fn native(out: &Path) -> Outcome<(PathBuf, PathBuf)> {
    let drawings = native_models(&fixture_drawings()?, &out.join("native"))?;
    Ok((drawings, native_organs(out)?.0))
}

/// Packages of the downloaded core that read, write and pass on, or compute little, rather than grow and draw: half
/// of it would be their code, which is compiled for size there.
const SMALL: &[&str] = &[
    "burgeon",
    "burgeon-document",
    "burgeon-formats",
    "burgeon-leaf",
    "burgeon-shape",
    "burgeon-wasm",
    "burgeon-workspace",
    "fdeflate",
    "flate2",
    "hashbrown",
    "image",
    "indexmap",
    "miniz_oxide",
    "moxcms",
    "png",
    "pxfm",
    "rawzip",
    "roxmltree",
    "schemars",
    "serde",
    "serde_core",
    "serde_json",
    "sha2",
    "toml",
    "toml_parser",
    "zune-jpeg",
];

/// Builds the core for the browser and returns the file.
pub(crate) fn build_wasm(tools: &Tools, release: bool) -> Outcome<PathBuf> {
    let mut args = vec!["build", "--package", "burgeon-wasm", "--target", TARGET];
    let small: Vec<String> =
        SMALL.iter().map(|name| format!("--config=profile.release.package.{name}.opt-level=\"s\"")).collect();
    if release {
        args.push("--release");
    }
    say(&format!("$ cargo {}", args.join(" ")));
    if release {
        args.extend(small.iter().map(String::as_str));
        // In one unit, a package has each generic function once.
        args.push("--config=profile.release.codegen-units=1");
    }
    let mut c = tools.cargo.command(&args);
    if release {
        // The classifier's sums run four abreast. The same bits: Rust never reorders floating-point sums by itself.
        c.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", "-Ctarget-feature=+simd128");
    } else if tools.cargo == WasmCargo::Own {
        // What only this target compiles passes no other check.
        c.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", "-Dwarnings");
    }
    finish(c)?;
    let built = match tools.cargo {
        WasmCargo::Own => target_dir(),
        WasmCargo::Debian => target_dir().join("debian"),
    };
    let profile = if release { "release" } else { "debug" };
    Ok(built.join(TARGET).join(profile).join("burgeon_wasm.wasm"))
}

/// Makes the JavaScript package of a built core: `target` is `nodejs` or `web`.
pub(crate) fn bindgen(tools: &Tools, wasm: &Path, target: &str, to: &Path) -> Outcome {
    let (wasm, to) = (wasm.to_string_lossy().into_owned(), to.to_string_lossy().into_owned());
    // Names of functions double the download and serve only debuggers.
    let slim = ["--remove-name-section", "--remove-producers-section"];
    let args = [&["--target", target, "--out-dir", &to][..], &slim, &[&wasm]].concat();
    command(&tools.wasm_bindgen, &args)
}

/// Every drawing among the fixtures, in order of name.
fn fixture_drawings() -> Outcome<Vec<PathBuf>> {
    let mut folders = vec![repository().join("fixtures/sketches")];
    let mut drawings = Vec::new();
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", shown(&folder)))?;
        for path in entries.filter_map(Result::ok).map(|e| e.path()) {
            let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
            if path.is_dir() {
                folders.push(path);
            } else if matches!(extension, "svg" | "inkml" | "ndjson" | "json") {
                drawings.push(path);
            }
        }
    }
    drawings.sort();
    if drawings.is_empty() { Err("no drawings under fixtures/sketches".into()) } else { Ok(drawings) }
}

/// Shapes of each flower in the comparison.
const FRAMES: &str = "5";

/// The points of a bent leaf of `length` mm, in millimetres.
fn made_scan(length: f64) -> String {
    let mut text = String::new();
    for i in 0..60 {
        for j in 0..21 {
            let (v, u) = (f64::from(i) / 59.0, f64::from(j) / 10.0 - 1.0);
            let half = 0.25 * length * (1.0 - (2.0 * v - 1.0) * (2.0 * v - 1.0)) + 0.3;
            let bend = 0.002 * length * length * v * v * (1.0 - 0.2 * u * u);
            text.push_str(&format!("{} {} {}\n", u * half, v * length, bend));
        }
    }
    text
}

/// Files for every kind of leaf and organ: a pinnate net of veins, palmate and parallel veins, a scan, three stages.
fn made_organs(out: &Path, burgeon: &Path) -> Outcome<Vec<PathBuf>> {
    let mut nodes: Vec<[f64; 3]> =
        (0..=40).map(|i| [200.0, 500.0 - 10.0 * f64::from(i), 8.0 - 0.15 * f64::from(i)]).collect();
    let mut edges: Vec<[usize; 2]> = (0..40).map(|i| [i, i + 1]).collect();
    for i in [4_usize, 11, 18, 25, 32] {
        for side in [-1.0, 1.0] {
            for k in 1..=6 {
                let before = if k == 1 { i } else { nodes.len() - 1 };
                let (step, [x, y, _]) = (f64::from(k), nodes[i]);
                nodes.push([x + side * 16.0 * step, y - 9.0 * step, 3.0 - 0.3 * step]);
                edges.push([before, nodes.len() - 1]);
            }
        }
    }
    let graph = serde_json::json!({ "unit": "pixel", "nodes_xyr": nodes, "edges": edges }).to_string();
    let mut files = Vec::new();
    let mut put = |name: &str, text: String| -> Outcome {
        let path = out.join(name);
        std::fs::write(&path, text).map_err(|e| format!("{}: {e}", shown(&path)))?;
        files.push(path);
        Ok(())
    };
    put("veins.json", graph)?;
    put("scan.xyz", made_scan(70.0))?;
    for (k, length) in [(1, 24.0), (2, 35.0), (3, 41.0)] {
        put(&format!("stage{k}.xyz"), made_scan(length))?;
    }
    for word in ["palmate", "parallel"] {
        let path = out.join(format!("{word}.csv"));
        finish({
            let mut c = prepare(burgeon, &["leaf", "--quiet", "--venation", word, "--marks"]);
            c.arg(&path);
            c
        })?;
        files.push(path);
    }
    let stages = |k| format!("[[stage]]\nfile = \"stage{k}.xyz\"\nday = {}\n", k - 1);
    let stages = format!(
        "unit = \"mm\"\nsplit = \"none\"\nclean = false\n{}",
        (1..=3).map(stages).collect::<String>()
    );
    let path = out.join("stages.toml");
    std::fs::write(&path, stages).map_err(|e| format!("{}: {e}", shown(&path)))?;
    files.push(repository().join("fixtures/sketches/gallery/tulip.svg"));
    Ok(files)
}

/// Fineness of the trees' surfaces in the comparison.
const DETAIL: &str = "0.1";

/// The digests of every kind of leaf, every flower and the tree of every preset, by the native program on one and on
/// four threads; returns their file and the files that they were made of.
fn native_organs(out: &Path) -> Outcome<(PathBuf, Vec<PathBuf>)> {
    let burgeon = burgeon("debug");
    let mut files: Vec<PathBuf> =
        (1..=3).map(|k| repository().join(format!("fixtures/leaves/leaf{k}.csv"))).collect();
    files.extend(made_organs(out, &burgeon)?);
    let law = out.join("stages.law.json");
    let mut c = prepare(&burgeon, &["bloom", "fit", "--quiet", "-o"]);
    c.arg(&law).arg(out.join("stages.toml"));
    finish(c)?;
    let presets = tree_presets()?;
    let mut all = Vec::new();
    for threads in ["1", "4"] {
        let mut digests = serde_json::Map::new();
        let report = out.join("organ.json");
        let mut digest_of = |name: String, c: &mut std::process::Command| -> Outcome {
            c.args(["--quiet", "--threads", threads, "--report"]).arg(&report);
            let status = c.status().map_err(|e| format!("{}: {e}", shown(&burgeon)))?;
            let text = std::fs::read_to_string(&report).map_err(|e| format!("{}: {e}", shown(&report)))?;
            let json: serde_json::Value =
                serde_json::from_str(&text).map_err(|e| format!("{}: {e}", shown(&report)))?;
            let item = &json["items"][0];
            let digest = item["digest"].as_str().unwrap_or_default();
            if !status.success() || digest.is_empty() {
                return Err(format!("{name}: the native program made nothing"));
            }
            let of_tree = format!("{digest} {} {}", item["counts"]["vertices"], item["counts"]["triangles"]);
            let digest = if name.starts_with("tree ") { of_tree } else { digest.to_owned() };
            digests.insert(name, digest.into());
            Ok(())
        };
        let opening = ["bloom", "run", "--frames", FRAMES, "-o"];
        let glb = out.join("flower.glb");
        for path in &files {
            let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
            let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
            match extension {
                "svg" => digest_of(name, prepare(&burgeon, &opening).arg(&glb).arg(path))?,
                "xyz" if name.starts_with("stage") => {}
                "xyz" => digest_of(name, prepare(&burgeon, &["leaf", "--scan", "--unit", "mm"]).arg(path))?,
                _ => digest_of(name, prepare(&burgeon, &["leaf"]).arg(path))?,
            }
        }
        for species in ["rose", "lily", "tulip", "sunflower", "clivia"] {
            digest_of(species.into(), prepare(&burgeon, &opening).arg(&glb).arg(species))?;
        }
        let mut c = prepare(&burgeon, &opening);
        digest_of("stages".into(), c.arg(&glb).arg(out.join("stages.toml")).arg("--law").arg(&law))?;
        for preset in &presets {
            let mut c = prepare(&burgeon, &["grow", preset, "--detail", DETAIL]);
            digest_of(format!("tree {preset}"), &mut c)?;
        }
        all.push(digests);
    }
    if all[0] != all[1] {
        return Err("digests of leaves, flowers or trees differ between 1 and 4 threads".into());
    }
    say(&format!("{} digests of leaves, flowers and trees are the same on 1 and 4 threads", all[0].len()));
    let path = out.join("organs.json");
    let text = serde_json::Value::Object(all.swap_remove(0)).to_string();
    std::fs::write(&path, text).map_err(|e| format!("{}: {e}", shown(&path)))?;
    Ok((path, files))
}

/// The keys of the presets of `burgeon grow`.
fn tree_presets() -> Outcome<Vec<String>> {
    let folder = repository().join("crates/studio/presets");
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", shown(&folder)))?;
    let files = entries.filter_map(Result::ok).map(|e| e.path());
    let toml = files.filter(|p| p.extension().is_some_and(|e| e == "toml"));
    let mut keys: Vec<String> =
        toml.filter_map(|p| p.file_stem().map(|s| s.to_string_lossy().into_owned())).collect();
    keys.sort();
    if keys.is_empty() { Err(format!("{}: no presets", shown(&folder))) } else { Ok(keys) }
}

/// Makes every drawing with the native program on one and on four threads; returns the report of the first.
fn native_models(drawings: &[PathBuf], to: &Path) -> Outcome<PathBuf> {
    std::fs::create_dir_all(to).map_err(|e| format!("{}: {e}", shown(to)))?;
    let burgeon = burgeon("debug");
    let mut reports = Vec::new();
    for threads in ["1", "4"] {
        let report = to.join(format!("threads-{threads}.json"));
        let folder = to.join(threads);
        let mut c = prepare(&burgeon, &["sketch", "--quiet", "--threads", threads]);
        c.args(drawings).arg("-o").arg(&folder).arg("--report").arg(&report);
        finish(c)?;
        let text = std::fs::read_to_string(&report).map_err(|e| format!("{}: {e}", shown(&report)))?;
        let json: serde_json::Value =
            serde_json::from_str(&text).map_err(|e| format!("{}: {e}", shown(&report)))?;
        let digests: Vec<String> = json["items"]
            .as_array()
            .into_iter()
            .flatten()
            .map(|item| format!("{} {}", item["name"], item["digest"]))
            .collect();
        reports.push((report, digests));
    }
    if reports[0].1 == reports[1].1 && !reports[0].1.is_empty() {
        say(&format!("{} digests are the same on 1 and 4 threads", reports[0].1.len()));
        Ok(reports.swap_remove(0).0)
    } else {
        Err("digests differ between 1 and 4 threads, or there are none".into())
    }
}
