//! Notices of the licences of other people's work that a package contains.
//!
//! `cargo metadata, packages of npm -> packages that are linked -> their licence texts, each once`

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::toolchain::shown;
use xtask::shell::{Outcome, cargo_path, output, prepare, repository};

/// File of the notices in a package.
pub(crate) const NOTICES: &str = "THIRD-PARTY-NOTICES.txt";

/// Starts of the names of files that hold a licence or a notice, in capitals.
const LICENCE_FILES: [&str; 5] = ["LICENSE", "LICENCE", "COPYING", "NOTICE", "UNLICENSE"];

/// A package that other people wrote.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Foreign {
    name: String,
    version: String,
    /// Its licence as an SPDX expression.
    licence: String,
    /// Where its sources are, for licences that ask for them.
    sources: String,
    folder: PathBuf,
}

/// Writes the notices of a package of ours to `file`. `of_page`: it has the Studio in it, too.
pub(crate) fn write(package: &str, of_page: bool, file: &Path) -> Outcome {
    let metadata = output(prepare(cargo_path(), &["metadata", "--format-version", "1", "--locked"]))?;
    let metadata = serde_json::from_str(&metadata).map_err(|e| format!("cargo metadata: {e}"))?;
    let mut linked = linked_crates(&metadata, package)?;
    if of_page {
        linked.extend(page_modules(&repository().join("apps/studio-web"))?);
    }
    let text = notices(package, &linked)?;
    std::fs::write(file, text).map_err(|e| format!("{}: {e}", shown(file)))
}

/// Returns the crates from elsewhere that are linked into one of ours, on any system.
fn linked_crates(metadata: &Value, package: &str) -> Outcome<BTreeSet<Foreign>> {
    let packages: BTreeMap<&str, &Value> =
        rows(&metadata["packages"]).filter_map(|p| Some((p["id"].as_str()?, p))).collect();
    let nodes: BTreeMap<&str, &Value> =
        rows(&metadata["resolve"]["nodes"]).filter_map(|n| Some((n["id"].as_str()?, n))).collect();
    let root = packages.iter().find(|(_, p)| p["name"] == package).map(|(id, _)| *id);
    let mut open = vec![root.ok_or_else(|| format!("no package {package}"))?];
    let (mut seen, mut found) = (BTreeSet::new(), BTreeSet::new());
    while let Some(id) = open.pop() {
        if !seen.insert(id) {
            continue;
        }
        if let Some(p) = packages.get(id).filter(|p| !p["source"].is_null()) {
            found.insert(foreign_crate(p));
        }
        let deps = nodes.get(id).into_iter().flat_map(|n| rows(&n["deps"]));
        // What only builds or tests is in no package.
        open.extend(deps.filter(|d| is_linked(d)).filter_map(|d| d["pkg"].as_str()));
    }
    Ok(found)
}

fn is_linked(dependency: &Value) -> bool {
    rows(&dependency["dep_kinds"]).any(|kind| kind["kind"].is_null())
}

fn foreign_crate(package: &Value) -> Foreign {
    let text = |field: &str| package[field].as_str().unwrap_or_default().to_owned();
    let manifest = PathBuf::from(text("manifest_path"));
    Foreign {
        name: text("name"),
        version: text("version"),
        licence: text("license"),
        sources: text("repository"),
        folder: manifest.parent().map(Path::to_path_buf).unwrap_or_default(),
    }
}

/// Returns the packages of npm that the page is built of.
fn page_modules(page: &Path) -> Outcome<Vec<Foreign>> {
    let own = package_json(page)?;
    let names = own["dependencies"].as_object().into_iter().flatten().map(|(name, _)| name);
    names
        .map(|name| {
            let folder = page.join("node_modules").join(name);
            let package = package_json(&folder)?;
            let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
            Ok(Foreign {
                name: name.clone(),
                version: text(&package["version"]),
                licence: text(&package["license"]),
                sources: text(&package["repository"]["url"]),
                folder,
            })
        })
        .collect()
}

fn package_json(folder: &Path) -> Outcome<Value> {
    let path = folder.join("package.json");
    let text = std::fs::read(&path).map_err(|e| format!("{}: {e}", shown(&path)))?;
    serde_json::from_slice(&text).map_err(|e| format!("{}: {e}", shown(&path)))
}

fn rows(list: &Value) -> impl Iterator<Item = &Value> {
    list.as_array().into_iter().flatten()
}

/// Returns the notices: all packages with their licences, then each text once, below the packages that have it.
fn notices(package: &str, linked: &BTreeSet<Foreign>) -> Outcome<String> {
    let mut out = format!("{package} contains work of other people, under these licences:\n\n");
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for Foreign { name, version, licence, sources, folder } in linked {
        out += &format!("- {name} {version}: {licence} {sources}\n");
        for text in licence_texts(folder)? {
            texts.entry(text).or_default().push(format!("{name} {version}"));
        }
    }
    for (text, packages) in texts {
        out += &format!("\n{}\n{}\n\n{text}\n", "=".repeat(78), packages.join(", "));
    }
    Ok(out)
}

/// Returns the texts of a package's licences and notices, with one kind of line ends.
fn licence_texts(folder: &Path) -> Outcome<Vec<String>> {
    let fault = |path: &Path, e: std::io::Error| format!("{}: {e}", shown(path));
    let entries = std::fs::read_dir(folder).map_err(|e| fault(folder, e))?;
    let mut files: Vec<PathBuf> =
        entries.filter_map(Result::ok).map(|e| e.path()).filter(|p| p.is_file()).collect();
    files.retain(|path| {
        let name = path.file_name().map(|n| n.to_string_lossy().to_uppercase()).unwrap_or_default();
        LICENCE_FILES.iter().any(|start| name.starts_with(start))
    });
    files.sort();
    let text = |path: &PathBuf| {
        let bytes = std::fs::read(path).map_err(|e| fault(path, e))?;
        Ok(String::from_utf8_lossy(&bytes).replace("\r\n", "\n").trim().to_owned())
    };
    files.iter().map(text).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn crates_that_are_linked_are_found_and_those_that_build_or_test_are_not() {
        let package = |id: &str, source: Value| {
            json!({ "id": id, "name": id, "version": "1.0.0", "license": "MIT", "repository": "here",
                "manifest_path": format!("{id}/Cargo.toml"), "source": source })
        };
        let to = |id: &str, kind: Value| json!({ "pkg": id, "dep_kinds": [{ "kind": kind }] });
        let node = |id: &str, deps: &[Value]| json!({ "id": id, "deps": deps });
        let metadata = json!({
            "packages": [
                package("ours", Value::Null), package("also-ours", Value::Null), package("linked", json!("registry")),
                package("builds", json!("registry")), package("tests", json!("registry")),
            ],
            "resolve": { "nodes": [
                node("ours", &[to("also-ours", Value::Null), to("builds", json!("build")), to("tests", json!("dev"))]),
                node("also-ours", &[to("linked", Value::Null), to("ours", json!("dev"))]),
            ] },
        });
        let found = linked_crates(&metadata, "ours").expect("a package");
        assert_eq!(found.iter().map(|f| f.name.as_str()).collect::<Vec<_>>(), ["linked"]);
        assert!(linked_crates(&metadata, "nobody").is_err());
    }

    #[test]
    fn the_command_has_a_text_of_each_licence() {
        let file = std::env::temp_dir().join(format!("burgeon-notices-{}.txt", std::process::id()));
        write("burgeon-cli", false, &file).expect("notices");
        let text = std::fs::read_to_string(&file).expect("written");
        std::fs::remove_file(&file).expect("removed");
        assert!(text.contains("- glam ") && text.contains("- clap "), "{}", &text[..text.len().min(3000)]);
        assert!(text.contains("Permission is hereby granted") && text.contains("Apache License"));
        assert!(!text.contains("- burgeon"), "our own is no work of other people");
    }
}
