//! What every fuzz target does with its bytes: plain functions, which tests on a stable compiler call too.
//!
//! `bytes -> a target -> nothing, or a panic that names what does not hold`
//!
//! | module | its targets |
//! |---|---|
//! | `readers` | any bytes as a file of one format: sound, or an error |
//! | `asked` | any text as a description: specs, materials, pictures, files that a model names |
//! | `made` | what comes after the readers: drawings read and built, edits, copies, growth laws, scans of several days |
//! | `worked` | a document in use: files opened, commands, records of hands |
//!
//! The test `kept` of the crate `workspace` takes this file as a module, with every input of `fuzz/kept`.

mod asked;
mod made;
mod readers;
mod worked;

/// A target: whether it took what it was given; false for what was refused with a reason. Where it does not return, it found a
/// bug.
pub type Target = fn(&[u8]) -> bool;

/// With this variable set, whatever is refused is told: for people who look into one input.
pub const SAYS: &str = "BURGEON_KEPT_SAYS";

/// Every target by its name, but for `request`, which takes a private file of the command line.
pub const TARGETS: [(&str, Target); 28] = [
    ("svg", readers::svg),
    ("inkml", readers::inkml),
    ("ndjson", readers::ndjson),
    ("json", readers::json),
    ("glb", readers::glb),
    ("obj", readers::obj),
    ("ply", readers::ply),
    ("stl", readers::stl),
    ("cloud", readers::cloud),
    ("las", readers::las),
    ("marks", readers::marks),
    ("structure", readers::structure),
    ("sheet", readers::sheet),
    ("vein_graph", readers::vein_graph),
    ("project", readers::project),
    ("law", readers::law),
    ("specs", asked::specs),
    ("materials", asked::materials),
    ("pictures", asked::pictures),
    ("links", asked::links),
    ("reading", made::reading),
    ("edits", made::edits),
    ("copies", made::copies),
    ("law_after", made::law_after),
    ("stages", made::stages),
    ("opened", worked::opened),
    ("commands", worked::commands),
    ("records", worked::records),
];

/// Runs a target by its name. Whether it took what it was given.
///
/// # Panics
/// When the target finds a bug, or there is no such target.
pub fn run(name: &str, bytes: &[u8]) -> bool {
    let found = TARGETS.iter().find(|(known, _)| *known == name);
    let (_, target) = found.expect("a target of the table");
    target(bytes)
}

/// The first line, and all after it: how a target takes a file with its name.
fn split_first_line(bytes: &[u8]) -> (String, &[u8]) {
    let end = bytes.iter().position(|&b| b == b'\n').unwrap_or(bytes.len());
    let rest = bytes.get(end + 1..).unwrap_or_default();
    (String::from_utf8_lossy(&bytes[..end]).into_owned(), rest)
}

/// An error says something: false, as what it refuses is not taken.
fn refused(error: &dyn std::fmt::Display) -> bool {
    assert!(error.to_string().len() > 10, "the error says nothing: {error}");
    if std::env::var_os(SAYS).is_some() {
        eprintln!("  {error}");
    }
    false
}
