//! Everything that the repository makes, made by the native program on one and on four threads: its digests.

use std::path::{Path, PathBuf};

use crate::shell::{Outcome, beside, burgeon, finish, prepare, repository, say};
use crate::toolchain::shown;

/// The report of all drawings and the digests of leaves, flowers and trees, by the native program alone.
pub(crate) fn all(out: &Path) -> Outcome<(PathBuf, PathBuf)> {
    let drawings = models(&drawings()?, &out.join("native"))?;
    Ok((drawings, organs(out)?.0))
}

/// Every drawing among the fixtures, in order of name.
pub(crate) fn drawings() -> Outcome<Vec<PathBuf>> {
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
pub(crate) const FRAMES: &str = "5";

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
pub(crate) const DETAIL: &str = "0.1";

/// The digests of every kind of leaf, every flower and the tree of every preset, by the native program on one and on
/// four threads; returns their file and the files that they were made of.
pub(crate) fn organs(out: &Path) -> Outcome<(PathBuf, Vec<PathBuf>)> {
    let burgeon = burgeon("debug");
    let mut files: Vec<PathBuf> =
        (1..=3).map(|k| repository().join(format!("fixtures/leaves/leaf{k}.csv"))).collect();
    files.extend(made_organs(out, &burgeon)?);
    let law = out.join("stages.law.json");
    let mut c = prepare(&burgeon, &["bloom", "fit", "--quiet", "-o"]);
    c.arg(&law).arg(out.join("stages.toml"));
    finish(c)?;
    let made = Organs { burgeon, files, law, out };
    let [digests, others] = beside(|| made.digests("1"), || made.digests("4"))?;
    if digests != others {
        return Err("digests of leaves, flowers or trees differ between 1 and 4 threads".into());
    }
    say(&format!("{} digests of leaves, flowers and trees are the same on 1 and 4 threads", digests.len()));
    let path = out.join("organs.json");
    let text = serde_json::Value::Object(digests).to_string();
    std::fs::write(&path, text).map_err(|e| format!("{}: {e}", shown(&path)))?;
    Ok((path, made.files))
}

/// What organs are made of, and with.
struct Organs<'a> {
    burgeon: PathBuf,
    files: Vec<PathBuf>,
    law: PathBuf,
    out: &'a Path,
}

impl Organs<'_> {
    /// What is made of each on so many threads.
    fn digests(&self, threads: &str) -> Outcome<serde_json::Map<String, serde_json::Value>> {
        let Self { burgeon, files, law, out } = self;
        let mut digests = serde_json::Map::new();
        let report = out.join(format!("organ-{threads}.json"));
        let mut digest_of = |name: String, c: &mut std::process::Command| -> Outcome {
            c.args(["--quiet", "--threads", threads, "--report"]).arg(&report);
            let status = c.status().map_err(|e| format!("{}: {e}", shown(burgeon)))?;
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
        let glb = out.join(format!("organ-{threads}.glb"));
        for path in files {
            let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
            let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
            match extension {
                "svg" => digest_of(name, prepare(burgeon, &opening).arg(&glb).arg(path))?,
                "xyz" if name.starts_with("stage") => {}
                "xyz" => digest_of(name, prepare(burgeon, &["leaf", "--scan", "--unit", "mm"]).arg(path))?,
                _ => digest_of(name, prepare(burgeon, &["leaf"]).arg(path))?,
            }
        }
        for species in presets_in("crates/bloom/presets")? {
            digest_of(species.clone(), prepare(burgeon, &opening).arg(&glb).arg(species))?;
        }
        let mut c = prepare(burgeon, &opening);
        digest_of("stages".into(), c.arg(&glb).arg(out.join("stages.toml")).arg("--law").arg(law))?;
        for preset in &presets_in("crates/studio/presets")? {
            // Needles are painted on cards where there are textures: the counts are those of what is drawn without.
            let mut c = prepare(burgeon, &["grow", preset, "--detail", DETAIL, "--no-textures", "-o"]);
            c.arg(&glb);
            digest_of(format!("tree {preset}"), &mut c)?;
        }
        Ok(digests)
    }
}

/// The keys of the presets in a folder.
fn presets_in(folder: &str) -> Outcome<Vec<String>> {
    let folder = repository().join(folder);
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", shown(&folder)))?;
    let files = entries.filter_map(Result::ok).map(|e| e.path());
    let toml = files.filter(|p| p.extension().is_some_and(|e| e == "toml"));
    let mut keys: Vec<String> =
        toml.filter_map(|p| p.file_stem().map(|s| s.to_string_lossy().into_owned())).collect();
    keys.sort();
    if keys.is_empty() { Err(format!("{}: no presets", shown(&folder))) } else { Ok(keys) }
}

/// Makes every drawing with the native program on one and on four threads; returns the report of the first.
pub(crate) fn models(drawings: &[PathBuf], to: &Path) -> Outcome<PathBuf> {
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
