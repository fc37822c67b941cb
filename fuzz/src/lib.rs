//! Functions of all fuzz targets: plain functions of bytes, which tests on a stable compiler call too.
//!
//! `bytes -> a target -> nothing, or a panic that names the violated property`
//!
//! | module | its targets |
//! |---|---|
//! | `readers` | any bytes as a file of one format: sound, or an error |
//! | `asked` | any text as a description: specs, materials, pictures, files that a model names |
//! | `made` | steps after the readers: drawings read and built, edits, copies, growth laws, scans of several days |
//! | `worked` | a document in use: files opened, commands, records of hands |
//!
//! The test `kept` of the crate `workspace` includes this file as a module, with every input of `fuzz/kept`.

mod asked;
mod made;
mod readers;
mod worked;

/// A target: returns whether it accepted its input; false for one that was refused with a reason. If it does not
/// return, it found a bug.
pub type Target = fn(&[u8]) -> bool;

/// Variable that makes every refusal print its reason: for people who examine one input.
pub const SAYS: &str = "BURGEON_KEPT_SAYS";

/// Every target by its name, except for `request`, which includes a private file of the command line.
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

/// Runs a target by its name. Returns whether it accepted its input.
///
/// # Panics
/// When the target finds a bug, or does not exist.
pub fn run(name: &str, bytes: &[u8]) -> bool {
    let found = TARGETS.iter().find(|(known, _)| *known == name);
    let (_, target) = found.expect("a target of the table");
    target(bytes)
}

/// Splits off the first line: the form in which a target takes a file with its name.
fn split_first_line(bytes: &[u8]) -> (String, &[u8]) {
    let end = bytes.iter().position(|&b| b == b'\n').unwrap_or(bytes.len());
    let rest = bytes.get(end + 1..).unwrap_or_default();
    (String::from_utf8_lossy(&bytes[..end]).into_owned(), rest)
}

/// Checks that an error has a message; returns false, as its input was not accepted.
fn refused(error: &dyn std::fmt::Display) -> bool {
    assert!(error.to_string().len() > 10, "the error says nothing: {error}");
    if std::env::var_os(SAYS).is_some() {
        eprintln!("  {error}");
    }
    false
}
