//! `cargo xtask layers`: modules of a crate that use one another in a cycle are one module in several files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use syn::visit::Visit;
use syn::{Attribute, Item, ItemMod, ItemUse, UseTree};

use xtask::shell::{Outcome, repository, say};

/// For each module below another, or below a crate's root, its siblings that it uses, each with one place of use.
type Uses = BTreeMap<String, BTreeMap<String, String>>;

/// Searches for cycles among the modules of every crate.
pub(crate) fn check() -> Outcome {
    let mut roots = Vec::new();
    for folder in ["crates", "apps", "."] {
        let folder = repository().join(folder);
        let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let sources = entries.filter_map(Result::ok).map(|e| e.path().join("src"));
        roots.extend(sources.flat_map(|s| [s.join("lib.rs"), s.join("main.rs")]).filter(|f| f.is_file()));
    }
    roots.sort();
    let (mut faults, mut files) = (Vec::new(), 0);
    for root in &roots {
        let mut sources = Files::default();
        for parent in parents(root, &mut sources)? {
            let uses = uses(&parent, &mut sources)?;
            files += uses.len();
            faults.extend(circles(&uses).iter().map(|c| format!("{}: {c}", parent.file.display())));
        }
    }
    if faults.is_empty() {
        say(&format!("circles: none among {files} files of {} crates", roots.len()));
        Ok(())
    } else {
        Err(format!("modules that use one another in a circle:\n  {}", faults.join("\n  ")))
    }
}

/// Files of a crate, each parsed once: a file is visited for each module above it.
#[derive(Default)]
struct Files(BTreeMap<PathBuf, Rc<syn::File>>);

impl Files {
    fn parse(&mut self, path: &Path) -> Outcome<Rc<syn::File>> {
        if let Some(file) = self.0.get(path) {
            return Ok(Rc::clone(file));
        }
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let file = syn::parse_file(&text).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(Rc::clone(self.0.entry(path.into()).or_insert(Rc::new(file))))
    }
}

/// A module with modules below it, or the root of a crate.
struct Parent {
    file: PathBuf,
    /// Folder of the files of the modules below it.
    folder: PathBuf,
    /// Its path from the root.
    module: Vec<String>,
}

impl Parent {
    /// Returns a module in a file of its own; `module`: its path from the root.
    fn new(file: &Path, module: Vec<String>) -> Self {
        let is_folder = file.file_name().is_some_and(|n| n == "mod.rs" || n == "lib.rs" || n == "main.rs");
        let folder = if is_folder { file.parent().unwrap_or(file).into() } else { file.with_extension("") };
        Self { file: file.into(), folder, module }
    }

    /// Returns the file of a module below it, if it has one.
    fn child(&self, name: &str) -> Option<PathBuf> {
        let own = [self.folder.join(format!("{name}.rs")), self.folder.join(name).join("mod.rs")];
        own.into_iter().find(|p| p.is_file())
    }

    /// Returns the part of a path from the root that follows its own path.
    fn below<'a>(&self, path: &'a [String]) -> &'a [String] {
        path.strip_prefix(&self.module[..]).unwrap_or_default()
    }
}

/// Returns the root of a crate and all modules with modules below them.
fn parents(root: &Path, files: &mut Files) -> Outcome<Vec<Parent>> {
    let mut all = Vec::new();
    let mut open = vec![Parent::new(root, Vec::new())];
    while let Some(parent) = open.pop() {
        for module in declared(&*files.parse(&parent.file)?) {
            let name = module.ident.to_string();
            if let Some(file) = parent.child(&name) {
                open.push(Parent::new(&file, parent.module.iter().cloned().chain([name]).collect()));
            }
        }
        all.push(parent);
    }
    Ok(all)
}

/// Returns which module uses which, among those that their parent declares. Tests may use any module.
fn uses(parent: &Parent, files: &mut Files) -> Outcome<Uses> {
    let file = files.parse(&parent.file)?;
    let modules: BTreeSet<String> = declared(&file).map(|m| m.ident.to_string()).collect();
    // Names that the parent gives to its modules' items: `parent::Name` means the module that has it.
    let mut names = BTreeMap::new();
    for item in &file.items {
        if let Item::Use(u) = item {
            let mut paths = Vec::new();
            flatten(&u.tree, &mut Vec::new(), &mut paths);
            for path in paths {
                let path: Vec<_> = path.into_iter().skip_while(|p| p == "crate" || p == "self").collect();
                let own = if path.first().is_some_and(|p| modules.contains(p)) {
                    &path[..]
                } else {
                    parent.below(&path)
                };
                if let [first, .., last] = own
                    && modules.contains(first)
                {
                    names.insert(last.clone(), first.clone());
                }
            }
        }
    }
    let mut all = Uses::new();
    for module in &modules {
        let Some(path) = parent.child(module) else { continue };
        let own = parent.module.iter().chain([module]).cloned().collect();
        let mut seen = Seen { module: own, paths: Vec::new() };
        seen.file(&path, files)?;
        let found = all.entry(module.clone()).or_default();
        for (path, place) in seen.paths {
            let path = parent.below(&path);
            let Some(first) = path.first() else { continue };
            let used = if modules.contains(first) { Some(first) } else { names.get(first) };
            if let Some(used) = used.filter(|u| *u != module) {
                found.entry(used.clone()).or_insert_with(|| format!("{place} uses {}", path.join("::")));
            }
        }
    }
    Ok(all)
}

/// Returns modules in files of their own, without those of tests.
fn declared(file: &syn::File) -> impl Iterator<Item = &ItemMod> {
    file.items.iter().filter_map(|item| match item {
        Item::Mod(m) if m.content.is_none() && !is_test(&m.attrs) => Some(m),
        _ => None,
    })
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes
        .iter()
        .any(|a| a.path().is_ident("cfg") && a.parse_args::<syn::Path>().is_ok_and(|p| p.is_ident("test")))
}

/// Collects the paths of a `use`, one for each name.
fn flatten(tree: &UseTree, before: &mut Vec<String>, out: &mut Vec<Vec<String>>) {
    let whole = |name: String| before.iter().cloned().chain([name]).collect();
    match tree {
        UseTree::Path(p) => {
            before.push(p.ident.to_string());
            flatten(&p.tree, before, out);
            before.pop();
        }
        UseTree::Name(n) => out.push(whole(n.ident.to_string())),
        UseTree::Rename(n) => out.push(whole(n.ident.to_string())),
        UseTree::Glob(_) => out.push(before.clone()),
        UseTree::Group(g) => g.items.iter().for_each(|t| flatten(t, before, out)),
    }
}

/// Names that a module and the modules below it use, from the crate's root on, and their files.
struct Seen {
    /// Path from the root of the module that is visited.
    module: Vec<String>,
    paths: Vec<(Vec<String>, String)>,
}

impl Seen {
    fn file(&mut self, path: &Path, files: &mut Files) -> Outcome {
        let file = files.parse(path)?;
        let place = path.strip_prefix(repository()).unwrap_or(path).display().to_string();
        let before = self.paths.len();
        self.visit_file(&file);
        self.paths[before..].iter_mut().for_each(|(_, at)| at.clone_from(&place));
        let parent = Parent::new(path, Vec::new());
        for module in declared(&file) {
            let name = module.ident.to_string();
            if let Some(path) = parent.child(&name) {
                self.module.push(name);
                self.file(&path, files)?;
                self.module.pop();
            }
        }
        Ok(())
    }

    /// Keeps a path that starts at the crate's root or above this module.
    fn keep(&mut self, path: &[String]) {
        let ups = path.iter().take_while(|p| *p == "super").count();
        let from = match path.first().map(String::as_str) {
            Some("crate") => &[][..],
            Some("super") => &self.module[..self.module.len().saturating_sub(ups)],
            _ => return,
        };
        let rest = path.iter().skip(ups.max(1)).filter(|p| *p != "self");
        self.paths.push((from.iter().chain(rest).cloned().collect(), String::new()));
    }
}

impl<'a> Visit<'a> for Seen {
    fn visit_item_mod(&mut self, module: &'a ItemMod) {
        if !is_test(&module.attrs) {
            self.module.push(module.ident.to_string());
            syn::visit::visit_item_mod(self, module);
            self.module.pop();
        }
    }

    fn visit_item_use(&mut self, item: &'a ItemUse) {
        let mut paths = Vec::new();
        flatten(&item.tree, &mut Vec::new(), &mut paths);
        paths.iter().for_each(|p| self.keep(p));
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        self.keep(&names);
        syn::visit::visit_path(self, path);
    }
}

/// Describes each cycle: modules from which every other of the cycle can be reached.
fn circles(uses: &Uses) -> Vec<String> {
    let reached = |from: &String| {
        let (mut open, mut all) = (vec![from], BTreeSet::new());
        while let Some(module) = open.pop() {
            for next in uses.get(module).into_iter().flat_map(BTreeMap::keys) {
                if all.insert(next) {
                    open.push(next);
                }
            }
        }
        all
    };
    let reach: BTreeMap<&String, BTreeSet<&String>> = uses.keys().map(|m| (m, reached(m))).collect();
    let mut told = BTreeSet::new();
    let mut out = Vec::new();
    for (module, all) in &reach {
        let circle: Vec<&&String> =
            all.iter().filter(|m| reach.get(**m).is_some_and(|r| r.contains(module))).collect();
        if circle.is_empty() || !told.insert(circle.clone()) {
            continue;
        }
        let inside = |used: &String| circle.iter().any(|m| **m == used);
        let edges = circle.iter().flat_map(|m| uses[**m].iter().filter(|(used, _)| inside(used)));
        let edges: Vec<String> = edges.map(|(_, place)| format!("\n    {place}")).collect();
        out.push(edges.concat());
    }
    out
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    fn circles_in(files: &[(&str, &str)]) -> Vec<String> {
        static MADE: AtomicUsize = AtomicUsize::new(0);
        let number = MADE.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("burgeon-circles-{}-{number}", std::process::id()));
        for (name, text) in files {
            let path = folder.join(name);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("can be made");
            std::fs::write(path, text).expect("can be written");
        }
        let mut sources = Files::default();
        let all = parents(&folder.join("lib.rs"), &mut sources).expect("can be parsed");
        let uses = all.iter().map(|parent| uses(parent, &mut sources).expect("can be parsed"));
        let found = uses.flat_map(|uses| circles(&uses)).collect();
        std::fs::remove_dir_all(folder).expect("was made");
        found
    }

    #[test]
    fn circles_are_found_through_names_of_the_root_and_modules_below() {
        let root = ("lib.rs", "mod a; mod b; mod c; pub use b::Thing;");
        let fine =
            [root, ("a.rs", "use crate::Thing;"), ("b.rs", "pub struct Thing;"), ("c.rs", "use crate::a;")];
        assert_eq!(circles_in(&fine), Vec::<String>::new());
        let back = ("b/mod.rs", "mod d; #[cfg(test)] mod tests { use crate::c; }");
        let bad = [root, fine[1], fine[3], back, ("b/d.rs", "fn f() { super::super::a::g(); }")];
        let found = circles_in(&bad);
        assert!(
            found.len() == 1 && found[0].contains("d.rs uses a::g") && found[0].contains("uses Thing"),
            "{found:?}"
        );
    }

    #[test]
    fn circles_are_found_among_files_below_a_module() {
        let root = ("lib.rs", "mod a;");
        let parent = ("a/mod.rs", "mod b; mod c; mod d; pub use c::Thing; fn own() {}");
        let fine = [
            root,
            parent,
            ("a/b.rs", "use super::Thing; fn f() { super::own(); }"),
            ("a/c.rs", "pub struct Thing;"),
            ("a/d.rs", "#[cfg(test)] mod tests { use super::super::b; }"),
        ];
        assert_eq!(circles_in(&fine), Vec::<String>::new());
        let found =
            circles_in(&[root, parent, fine[2], ("a/c.rs", "use crate::a::b;"), fine[4], ("none.rs", "")]);
        assert!(found.len() == 1 && found[0].contains("c.rs uses b"), "{found:?}");
    }
}
