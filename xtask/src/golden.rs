//! Digests of all results in the repository: a change of any plant must be intended and explained.
//!
//! `cargo xtask test` compares them with `fixtures/digests.json`; `cargo xtask bless "why"` rewrites that file and adds
//! the reason to the changelog.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::native;
use xtask::shell::{Outcome, burgeon, debug_burgeon, finish, output, prepare, repository, say, target_dir};

/// Digest (and for trees the size of their meshes) of each result.
type Digests = BTreeMap<String, String>;

/// Most names of changed digests in a message.
const LISTED: usize = 20;

fn file() -> PathBuf {
    repository().join("fixtures/digests.json")
}

fn json(path: &Path) -> Outcome<Value> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
}

/// Returns the digests of drawings, from the report that names them, of leaves, flowers and trees, from their file, and
/// of projects and hand edits, which are made here.
fn measured(drawings: &Path, organs: &Path, out: &Path) -> Outcome<Digests> {
    let mut all = Digests::new();
    let digest = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let mut add = |name: String, digest: String| match all.insert(name.clone(), digest) {
        _ if all[&name].is_empty() => Err(format!("{name}: nothing was made")),
        Some(_) => Err(format!("{name}: is there twice")),
        None => Ok(()),
    };
    for item in json(drawings)?["items"].as_array().into_iter().flatten() {
        add(format!("drawing {}", digest(&item["name"])), digest(&item["digest"]))?;
    }
    for (name, value) in json(organs)?.as_object().into_iter().flatten() {
        add(name.clone(), digest(value))?;
    }
    let report = out.join("golden.json");
    let mut made = |what: &str, mut command: Command| -> Outcome {
        command.args(["--quiet", "--report"]).arg(&report);
        output(command)?;
        for item in json(&report)?["items"].as_array().into_iter().flatten() {
            add(format!("{what} {}", digest(&item["name"])), digest(&item["digest"]))?;
        }
        Ok(())
    };
    let projects = repository().join("fixtures/projects");
    for version in 1..=7 {
        let name = format!("version-{version}");
        let mut c = prepare(burgeon("debug"), &["sketch"]);
        c.arg(projects.join(format!("{name}.burgeon")));
        made(&format!("project {name}"), c)?;
    }
    let edits = out.join("edits.json");
    let text = output(prepare(burgeon("debug"), &["shape", "--template"]))?;
    std::fs::write(&edits, text).map_err(|e| format!("{}: {e}", edits.display()))?;
    for plant in ["oak", "fixtures/sketches/table1/h.svg"] {
        let mut c = prepare(burgeon("debug"), &["shape", plant, "--detail", "0.1", "--edits"]);
        c.arg(&edits);
        made("edits", c)?;
    }
    Ok(all)
}

/// Compares the new digests with the expected ones.
pub(crate) fn check(drawings: &Path, organs: &Path, out: &Path) -> Outcome {
    let now = measured(drawings, organs, out)?;
    let before = expected()?;
    let changed = changes(&before, &now);
    if changed.is_empty() {
        say(&format!("{} digests are those of fixtures/digests.json", now.len()));
        return Ok(());
    }
    Err(format!(
        "{} of {} digests are not those of fixtures/digests.json:\n{}\nIf these plants are meant to change, say why: \
         cargo xtask bless \"why\"",
        changed.len(),
        now.len(),
        listed(&changed, "\n")
    ))
}

fn expected() -> Outcome<Digests> {
    if !file().exists() {
        return Ok(Digests::new());
    }
    serde_json::from_value(json(&file())?).map_err(|e| format!("{}: {e}", file().display()))
}

/// Returns the names of new, missing and changed digests.
fn changes(before: &Digests, now: &Digests) -> Vec<String> {
    let mut names: Vec<&String> = before.keys().chain(now.keys()).collect();
    names.sort();
    names.dedup();
    names.into_iter().filter(|n| before.get(*n) != now.get(*n)).cloned().collect()
}

fn listed(names: &[String], between: &str) -> String {
    let mut words: Vec<String> = names.iter().take(LISTED).cloned().collect();
    if names.len() > LISTED {
        words.push(format!("and {} more", names.len() - LISTED));
    }
    words.join(between)
}

/// `cargo xtask bless WHY`: makes the present results the expected ones.
pub(crate) fn bless(why: &[String]) -> Outcome {
    let why = why.join(" ");
    let why = why.trim();
    if why.len() < 10 || why.contains('\n') {
        return Err(
            "say in one line why the plants change: cargo xtask bless \"Leaves of oaks are lobed\"".into()
        );
    }
    debug_burgeon(false)?;
    let out = target_dir().join("xtask-bless");
    let _ = std::fs::remove_dir_all(&out);
    std::fs::create_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    let (drawings, organs) = native::all(&out)?;
    let now = measured(&drawings, &organs, &out)?;
    let changed = changes(&expected()?, &now);
    if changed.is_empty() {
        say("nothing changed: fixtures/digests.json is as it was");
        return Ok(());
    }
    let text = serde_json::to_string_pretty(&now).map_err(|e| e.to_string())?;
    std::fs::write(file(), text + "\n").map_err(|e| format!("{}: {e}", file().display()))?;
    let log = repository().join("CHANGELOG.md");
    let text = std::fs::read_to_string(&log).map_err(|e| format!("{}: {e}", log.display()))?;
    let line = format!("- {} (plants: {}).\n", why.trim_end_matches('.'), listed(&changed, ", "));
    let Some((head, tail)) = text.split_once("### Changed\n") else {
        return Err(format!("{}: has no part `### Changed` for the reason", log.display()));
    };
    std::fs::write(&log, format!("{head}### Changed\n{line}{tail}"))
        .map_err(|e| format!("{}: {e}", log.display()))?;
    say(&format!("{} digests written to fixtures/digests.json, the reason to CHANGELOG.md", changed.len()));
    finish(prepare("git", &["diff", "--stat", "--", "CHANGELOG.md", "fixtures/digests.json"]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_new_gone_or_different_is_a_change() {
        let map = |rows: &[(&str, &str)]| -> Digests {
            rows.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect()
        };
        let before = map(&[("a", "1"), ("b", "2"), ("c", "3")]);
        let now = map(&[("a", "1"), ("b", "4"), ("d", "5")]);
        assert_eq!(changes(&before, &now), ["b", "c", "d"]);
        assert!(changes(&now, &now).is_empty());
        let many: Vec<String> = (0..25).map(|i| i.to_string()).collect();
        assert!(listed(&many, ", ").ends_with("19, and 5 more"));
    }
}
