//! `cargo xtask layers`: each crate uses only what the table in `ARCHITECTURE.md` allows.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use xtask::shell::{Outcome, cargo_path, output, prepare, repository, say};

/// Words that only shells may use: all code below runs in a browser, on any thread count, with the same bits.
const BANNED: &[(&str, &str)] = &[
    ("std::fs", "files belong to the shells"),
    ("std::net", "the network belongs to the shells"),
    ("std::process", "processes belong to the shells"),
    ("std::env", "the environment belongs to the shells"),
    ("std::time", "clocks belong to the shells: use base::Clock"),
    ("std::thread", "threads belong to the shells: use base::Executor"),
    ("wasm_bindgen", "belongs to apps/wasm"),
    ("web_sys", "belongs to apps/wasm"),
    ("js_sys", "belongs to apps/wasm"),
    ("pyo3", "belongs to apps/py"),
    ("clap", "belongs to apps/cli"),
    ("HashMap", "iterates in another order each time: use BTreeMap or a sorted Vec"),
    ("HashSet", "iterates in another order each time: use BTreeSet or a sorted Vec"),
];

/// Compares `cargo metadata` with the table, searches for banned words, and checks kurbo's features.
pub(crate) fn check() -> Outcome {
    let architecture = read(&repository().join("ARCHITECTURE.md"))?;
    let allowed = table(&architecture);
    if allowed.is_empty() {
        return Err("ARCHITECTURE.md has no table of crates".into());
    }
    let text = output(prepare(cargo_path(), &["metadata", "--format-version", "1"]))?;
    let metadata: Value = serde_json::from_str(&text).map_err(|e| format!("cargo metadata: {e}"))?;
    let mut faults = edges(&metadata, &allowed);
    for name in allowed.keys() {
        let folder = repository().join("crates").join(name).join("src");
        banned_words(&folder, &mut faults)?;
    }
    faults.extend(kurbo_with_std(&metadata));
    if faults.is_empty() {
        say(&format!("layers: {} crates use only what ARCHITECTURE.md allows", allowed.len()));
        Ok(())
    } else {
        Err(format!("layers:\n  {}", faults.join("\n  ")))
    }
}

fn read(path: &Path) -> Outcome<String> {
    std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}

/// Parses rows ``| `crate` | `a`, `b` | ...`` of the document: a crate and the crates that it may use.
fn table(document: &str) -> BTreeMap<String, Vec<String>> {
    let quoted =
        |cell: &str| -> Vec<String> { cell.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let rows = document.lines().filter(|l| l.starts_with("| `"));
    let cells = rows.map(|l| l.split('|').skip(1).take(2).map(quoted).collect::<Vec<_>>());
    cells
        .filter_map(|mut c| {
            let may_use = c.pop()?;
            Some((c.pop()?.into_iter().next()?, may_use))
        })
        .collect()
}

/// Returns edges between our crates that the table does not allow, and crates that it does not name.
fn edges(metadata: &Value, allowed: &BTreeMap<String, Vec<String>>) -> Vec<String> {
    let mut faults = Vec::new();
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let ours = packages.filter_map(|p| {
        let folder = Path::new(p["manifest_path"].as_str()?).parent()?;
        let below = folder.strip_prefix(repository().join("crates")).ok()?;
        Some((below.to_string_lossy().into_owned(), p))
    });
    let ours: Vec<(String, &Value)> = ours.collect();
    let folder_of = |package: &str| {
        ours.iter().find(|(_, p)| p["name"].as_str() == Some(package)).map(|(folder, _)| folder.clone())
    };
    for (folder, package) in &ours {
        let Some(may_use) = allowed.get(folder) else {
            faults.push(format!("crates/{folder} is not in the table of ARCHITECTURE.md"));
            continue;
        };
        let dependencies = package["dependencies"].as_array().into_iter().flatten();
        for dependency in dependencies.filter(|d| d["kind"].is_null()).filter_map(|d| d["name"].as_str()) {
            if let Some(used) = folder_of(dependency).filter(|used| !may_use.contains(used)) {
                faults.push(format!("crates/{folder} uses {used}, which ARCHITECTURE.md does not allow"));
            }
        }
    }
    faults
}

/// Finds banned words outside comments and tests.
fn banned_words(folder: &Path, faults: &mut Vec<String>) -> Outcome {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for path in entries.filter_map(Result::ok).map(|e| e.path()) {
        if path.is_dir() {
            banned_words(&path, faults)?;
        } else if path.extension().is_some_and(|e| e == "rs")
            && path.file_name().is_some_and(|n| n != "tests.rs")
        {
            let text = read(&path)?;
            let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
            let lines = code.lines().enumerate().filter(|(_, l)| !l.trim_start().starts_with("//"));
            for (number, line) in lines {
                for (word, why) in BANNED.iter().filter(|(word, _)| line.contains(word)) {
                    let place = path.strip_prefix(repository()).unwrap_or(&path).display();
                    faults.push(format!("{place}:{}: `{word}`: {why}", number + 1));
                }
            }
        }
    }
    Ok(())
}

/// Reports kurbo's `std` feature, which calls the platform's maths library and so breaks bit-identity.
fn kurbo_with_std(metadata: &Value) -> Option<String> {
    let nodes = metadata["resolve"]["nodes"].as_array()?;
    let mut kurbo = nodes.iter().filter(|n| n["id"].as_str().is_some_and(|id| id.contains("kurbo@")));
    let has_std = |n: &Value| n["features"].as_array().is_some_and(|f| f.iter().any(|f| f == "std"));
    kurbo
        .any(has_std)
        .then(|| "kurbo is built with its feature `std`: results differ between machines".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_reads_crates_and_what_they_may_use() {
        let t = table(
            "text\n| crate | may use |\n|---|---|\n| `base` | – | x |\n| `geom` | `base`, `x` | `no` |\n",
        );
        assert_eq!(t["base"], Vec::<String>::new());
        assert_eq!(t["geom"], ["base", "x"]);
    }

    #[test]
    fn an_edge_outside_the_table_is_found() {
        let path = |c: &str| repository().join("crates").join(c).join("Cargo.toml");
        let metadata = serde_json::json!({ "packages": [
            { "name": "burgeon-a", "manifest_path": path("a"), "dependencies": [{ "name": "burgeon-b", "kind": null }] },
            { "name": "burgeon-b", "manifest_path": path("b"), "dependencies": [] },
        ]});
        let rows = |a: &str| table(&format!("| `a` | {a} |\n| `b` | – |"));
        assert_eq!(edges(&metadata, &rows("`b`")), Vec::<String>::new());
        assert_eq!(edges(&metadata, &rows("–")).len(), 1);
    }
}
