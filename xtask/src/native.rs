//! All results of the repository, made by the native program on four threads, and a part of them on one: their digests.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::Share;
use crate::toolchain::shown;
use xtask::shell::{Outcome, burgeon, finish, in_parallel, prepare, repository, say};

/// Returns the report of all drawings and the digests of leaves, flowers and trees, by the native program alone.
pub(crate) fn all(out: &Path) -> Outcome<(PathBuf, PathBuf)> {
    let drawings = models(&drawings()?, &out.join("native"), Share::All)?;
    Ok((drawings, organs(out, Share::All)?.0))
}

/// Returns every drawing among the fixtures, in order of name.
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

/// Number of shapes of each flower in the comparison.
pub(crate) const FRAMES: &str = "5";

/// Writes the points of a bent leaf of `length` mm, in millimetres.
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

/// Writes files for every kind of leaf and organ: a pinnate net of veins, palmate and parallel veins, a scan, three
/// stages.
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

/// Of the results made on four threads, one of this many is also made on one thread, in order of name from the first
/// on, unless all is tested. All are compared with the expected digests, and with WASM.
const ON_ONE_THREAD: usize = 4;

/// Returns every `ON_ONE_THREAD`th, or all.
fn sample<T: Clone>(all: &[T], share: Share) -> Vec<T> {
    let step = match share {
        Share::All => 1,
        Share::Some => ON_ONE_THREAD,
    };
    all.iter().step_by(step).cloned().collect()
}

/// Makes the digests of every kind of leaf, every flower and the tree of every preset, by the native program on four
/// threads, and of a part of them on one; returns their file and their input files.
pub(crate) fn organs(out: &Path, share: Share) -> Outcome<(PathBuf, Vec<PathBuf>)> {
    let burgeon = burgeon("debug");
    let mut files: Vec<PathBuf> =
        (1..=3).map(|k| repository().join(format!("fixtures/leaves/leaf{k}.csv"))).collect();
    files.extend(made_organs(out, &burgeon)?);
    let law = out.join("stages.law.json");
    let mut c = prepare(&burgeon, &["bloom", "fit", "--quiet", "-o"]);
    c.arg(&law).arg(out.join("stages.toml"));
    finish(c)?;
    let made = Organs { burgeon, files, law, out };
    let whole = made.list()?;
    let sample = sample(&whole, share);
    let [digests, others] = in_parallel(|| made.digests(&whole, "4"), || made.digests(&sample, "1"))?;
    if let Some((name, _)) = others.iter().find(|(name, digest)| digests.get(*name) != Some(*digest)) {
        return Err(format!("{name}: its digest differs between 1 and 4 threads"));
    }
    say(&format!(
        "{} of {} digests of leaves, flowers and trees were asked for on 1 and 4 threads and are the same",
        others.len(),
        digests.len()
    ));
    let path = out.join("organs.json");
    let text = serde_json::Value::Object(digests).to_string();
    std::fs::write(&path, text).map_err(|e| format!("{}: {e}", shown(&path)))?;
    Ok((path, made.files))
}

/// Placeholder for the file of a model in a command.
const GLB: &str = "{model}";

/// Inputs and program for organs.
struct Organs<'a> {
    burgeon: PathBuf,
    files: Vec<PathBuf>,
    law: PathBuf,
    out: &'a Path,
}

/// A leaf, a flower or a tree of the comparison: its name, and its command.
#[derive(Clone, Debug)]
struct Organ {
    name: String,
    args: Vec<String>,
}

impl Organs<'_> {
    /// Lists all of them, in order of name. `GLB` stands for a file that is written but not read.
    fn list(&self) -> Outcome<Vec<Organ>> {
        let mut list = Vec::new();
        let mut add = |name: &str, args: &[&str], last: &[&Path]| {
            let last = last.iter().map(|p| p.display().to_string());
            let args = args.iter().map(|a| (*a).to_owned()).chain(last).collect();
            list.push(Organ { name: name.to_owned(), args });
        };
        let opening = ["bloom", "run", "--frames", FRAMES, "-o", GLB];
        for path in &self.files {
            let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
            match path.extension().and_then(|e| e.to_str()).unwrap_or_default() {
                "svg" => add(&name, &opening, &[path]),
                "xyz" if name.starts_with("stage") => {}
                "xyz" => add(&name, &["leaf", "--scan", "--unit", "mm"], &[path]),
                _ => add(&name, &["leaf"], &[path]),
            }
        }
        for species in presets_in("crates/bloom/presets")? {
            add(&species, &opening, &[Path::new(&species)]);
        }
        let stages = self.out.join("stages.toml");
        add("stages", &opening, &[&stages, Path::new("--law"), &self.law]);
        for preset in &presets_in("crates/burgeon/presets")? {
            // Needles are painted on cards where there are textures: the counts are those of trees drawn without.
            let args = ["grow", preset, "--detail", DETAIL, "--no-textures", "-o", GLB];
            add(&format!("tree {preset}"), &args, &[]);
        }
        list.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(list)
    }

    /// Makes each with the given number of threads and returns the digests.
    fn digests(&self, list: &[Organ], threads: &str) -> Outcome<serde_json::Map<String, serde_json::Value>> {
        let report = self.out.join(format!("organ-{threads}.json"));
        let glb = self.out.join(format!("organ-{threads}.glb")).display().to_string();
        let mut digests = serde_json::Map::new();
        for Organ { name, args } in list {
            let mut c = prepare(&self.burgeon, &[]);
            c.args(args.iter().map(|a| if a == GLB { &glb } else { a }));
            c.args(["--quiet", "--threads", threads, "--report"]).arg(&report);
            let status = c.status().map_err(|e| format!("{}: {e}", shown(&self.burgeon)))?;
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
            digests.insert(name.clone(), digest.into());
        }
        Ok(digests)
    }
}

/// Returns the keys of the presets in a folder.
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

/// Makes every drawing with the native program on four threads and a part of them on one; returns the report of all.
pub(crate) fn models(drawings: &[PathBuf], to: &Path, share: Share) -> Outcome<PathBuf> {
    std::fs::create_dir_all(to).map_err(|e| format!("{}: {e}", shown(to)))?;
    let (report, digests) = made_drawings(drawings, to, "4")?;
    let (_, others) = made_drawings(&sample(drawings, share), to, "1")?;
    if let Some((name, _)) = others.iter().find(|(name, digest)| digests.get(*name) != Some(*digest)) {
        return Err(format!("{name}: its digest differs between 1 and 4 threads"));
    }
    if others.is_empty() {
        return Err("there are no digests of drawings".into());
    }
    say(&format!(
        "{} of {} digests of drawings were asked for on 1 and 4 threads and are the same",
        others.len(),
        digests.len()
    ));
    Ok(report)
}

/// Makes drawings with the given number of threads: their report, and their digests by name.
fn made_drawings(
    drawings: &[PathBuf],
    to: &Path,
    threads: &str,
) -> Outcome<(PathBuf, BTreeMap<String, String>)> {
    let report = to.join(format!("threads-{threads}.json"));
    let mut c = prepare(burgeon("debug"), &["sketch", "--quiet", "--threads", threads]);
    c.args(drawings).arg("-o").arg(to.join(threads)).arg("--report").arg(&report);
    finish(c)?;
    let text = std::fs::read_to_string(&report).map_err(|e| format!("{}: {e}", shown(&report)))?;
    let json: serde_json::Value =
        serde_json::from_str(&text).map_err(|e| format!("{}: {e}", shown(&report)))?;
    let items = json["items"].as_array().into_iter().flatten();
    let digests = items.map(|item| (item["name"].to_string(), item["digest"].to_string()));
    Ok((report, digests.collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fourth_is_asked_for_on_one_thread_or_all() {
        let all: Vec<u8> = (0..9).collect();
        assert_eq!(sample(&all, Share::Some), [0, 4, 8]);
        assert_eq!(sample(&all, Share::All), all);
    }
}
