//! `cargo xtask layers`: no two crates export types of the same name, which a user could confuse.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use syn::{Item, ItemUse, UseTree, Visibility};

use crate::bare_numbers::packages;
use xtask::shell::{Outcome, repository, say};

/// Names that several crates may have, with these crates, and the reason.
const ALLOWED: &[(&str, &[&str], &str)] = &[
    ("Figure", &["forest", "ink"], "a measure of a tree; one painted element of a file"),
    (
        "Ground",
        &["forest", "scan", "workspace"],
        "what a stand grows on; the terrain of a scan; that of a scene, as a page scatters plants on it",
    ),
    ("Grown", &["growth", "workspace"], "a tree; what a page is told of a shoot that grows in a headset"),
    ("Kind", &["reading", "spec"], "of the plant that a drawing shows; of a node of a text"),
    ("Made", &["burgeon", "npm"], "a plant, and the same for JavaScript"),
    ("MaterialView", &["npm", "workspace"], SHELLS),
    ("PartView", &["npm", "workspace"], SHELLS),
    ("PlantView", &["npm", "workspace"], SHELLS),
    (
        "Refused",
        &["npm", "wasm"],
        "each shell turns a refusal into a JavaScript value, which no crate below may name",
    ),
    ("Stage", &["base", "bloom"], "a step of a computation with its time; a day of a series of scans"),
    ("Step", &["document", "geom"], "a step of the history; a step along a path of least cost"),
    ("TextureView", &["npm", "workspace"], SHELLS),
    ("Weights", &["bloom", "geom"], "of the controls of a lattice; of those of a curve"),
];
const SHELLS: &str =
    "what a page is told differs from what users of npm are told, each by its own wire format";

/// Crates that export each type.
type Exports = BTreeMap<String, BTreeSet<String>>;

/// Compares the exports of the roots of all crates.
pub(crate) fn check() -> Outcome {
    let mut exports = Exports::new();
    for package in packages()? {
        let root = package.join("src").join("lib.rs");
        if !root.is_file() {
            continue;
        }
        let name = package.file_name().unwrap_or_default().to_string_lossy().into_owned();
        for exported in exported(&root)? {
            exports.entry(exported).or_default().insert(name.clone());
        }
    }
    let faults = faults(&exports, ALLOWED);
    if faults.is_empty() {
        say(&format!("names: {} types of crates, none taken twice but {}", exports.len(), ALLOWED.len()));
        return Ok(());
    }
    Err(format!("names of types:\n  {}", faults.join("\n  ")))
}

/// Returns names that are used twice without permission, and unused rows of the table.
fn faults(exports: &Exports, allowed: &[(&str, &[&str], &str)]) -> Vec<String> {
    let may = |name: &str, crates: &BTreeSet<String>| {
        allowed.iter().any(|(n, several, _)| *n == name && crates.iter().eq(several.iter()))
    };
    let twice = exports.iter().filter(|(name, crates)| crates.len() > 1 && !may(name, crates));
    let mut faults: Vec<String> = twice
        .map(|(name, crates)| {
            let crates: Vec<&str> = crates.iter().map(String::as_str).collect();
            format!("{name} is a type of {}: rename all but one", crates.join(" and of "))
        })
        .collect();
    let idle = allowed.iter().filter(|(n, ..)| exports.get(*n).is_none_or(|crates| crates.len() < 2));
    faults.extend(idle.map(|(name, ..)| format!("{name} is taken once only: take it off the list")));
    faults
}

/// Returns the types that a crate's root has or takes from its own modules: not those of other crates.
fn exported(root: &Path) -> Outcome<Vec<String>> {
    let file = parse(root)?;
    let modules: BTreeSet<String> = file
        .items
        .iter()
        .filter_map(|item| if let Item::Mod(m) = item { Some(m.ident.to_string()) } else { None })
        .collect();
    let mut names = types_of(&file);
    for item in &file.items {
        let Item::Use(ItemUse { vis: Visibility::Public(_), tree: UseTree::Path(path), .. }) = item else {
            continue;
        };
        let module = path.ident.to_string();
        if !modules.contains(&module) {
            continue;
        }
        if matches!(*path.tree, UseTree::Glob(_)) {
            let folder = root.parent().unwrap_or(Path::new("."));
            let own = [folder.join(format!("{module}.rs")), folder.join(&module).join("mod.rs")];
            for file in own.iter().filter(|f| f.is_file()) {
                names.extend(types_of(&parse(file)?));
            }
        } else {
            leaves(&path.tree, &mut names);
        }
    }
    names.retain(|name| is_of_type(name));
    Ok(names)
}

fn parse(path: &Path) -> Outcome<syn::File> {
    let fault = |e: &dyn core::fmt::Display| {
        format!("{}: {e}", path.strip_prefix(repository()).unwrap_or(path).display())
    };
    let text = std::fs::read_to_string(path).map_err(|e| fault(&e))?;
    syn::parse_file(&text).map_err(|e| fault(&e))
}

/// Returns the public types of a file.
fn types_of(file: &syn::File) -> Vec<String> {
    let public = |vis: &Visibility, ident: &syn::Ident| {
        matches!(vis, Visibility::Public(_)).then(|| ident.to_string())
    };
    let named = |item: &Item| match item {
        Item::Struct(i) => public(&i.vis, &i.ident),
        Item::Enum(i) => public(&i.vis, &i.ident),
        Item::Trait(i) => public(&i.vis, &i.ident),
        Item::Type(i) => public(&i.vis, &i.ident),
        _ => None,
    };
    file.items.iter().filter_map(named).collect()
}

/// Collects the names in which a tree of a `use` ends.
fn leaves(tree: &UseTree, names: &mut Vec<String>) {
    match tree {
        UseTree::Path(p) => leaves(&p.tree, names),
        UseTree::Name(n) => names.push(n.ident.to_string()),
        UseTree::Rename(n) => names.push(n.rename.to_string()),
        UseTree::Group(g) => g.items.iter().for_each(|t| leaves(t, names)),
        UseTree::Glob(_) => {}
    }
}

/// Whether a name is in camel case: neither a function nor a constant.
fn is_of_type(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_uppercase()) && name.contains(|c: char| c.is_ascii_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_taken_twice_is_found_and_so_is_an_idle_permission() {
        let of = |rows: &[(&str, &[&str])]| -> Exports {
            let set = |crates: &[&str]| crates.iter().map(|c| (*c).to_owned()).collect();
            rows.iter().map(|(name, crates)| ((*name).to_owned(), set(crates))).collect()
        };
        let exports = of(&[("Refusal", &["npm", "workspace"]), ("Stage", &["base", "bloom"])]);
        let stage: (&str, &[&str], &str) = ("Stage", &["base", "bloom"], "differ");
        let found = faults(&exports, &[stage]);
        assert_eq!(found, ["Refusal is a type of npm and of workspace: rename all but one"]);
        // Permission for two crates does not extend to a third.
        let third = of(&[("Stage", &["base", "bloom", "leaf"])]);
        assert_eq!(faults(&third, &[stage]).len(), 1);
        assert_eq!(faults(&of(&[("Stage", &["base"])]), &[stage]).len(), 1);
    }

    #[test]
    fn types_of_the_crate_itself_are_exported() {
        let folder = std::env::temp_dir().join(format!("burgeon-names-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("can be made");
        let root = "mod a; mod b; pub use a::{Thing, THINGS, make, inner::Part as Piece}; pub use b::*;\n\
                    pub use base::Told; use a::Hidden; pub struct Own; struct Private;";
        for (name, text) in [("lib.rs", root), ("b.rs", "pub enum All {} pub(crate) struct Some;")] {
            std::fs::write(folder.join(name), text).expect("can be written");
        }
        let found = exported(&folder.join("lib.rs"));
        std::fs::remove_dir_all(folder).expect("was made");
        assert_eq!(found.expect("can be parsed"), ["Own", "Thing", "Piece", "All"]);
    }
}
