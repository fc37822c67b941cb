//! Puts the built page of the Studio into the program, where it is built: `burgeon studio` then needs no files.
//!
//! `cargo xtask build-web` makes the page and triggers this script again. Without the page, the program is built all
//! the same.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let folder = |name: &str| env::var_os(name).map(PathBuf::from).ok_or(io::ErrorKind::NotFound);
    let page = folder("CARGO_MANIFEST_DIR")?.join("../studio-web/dist");
    let mut files = Vec::new();
    if page.join("index.html").is_file() {
        println!("cargo::rerun-if-changed={}", page.display());
        collect(&page.canonicalize()?, "", &mut files)?;
    }
    files.sort();
    // If a packed copy of a file exists, it goes into the program instead, and is unpacked for the few browsers that
    // cannot do it.
    let packed: Vec<String> =
        files.iter().filter_map(|(name, _)| name.strip_suffix(".br")).map(str::to_owned).collect();
    files.retain(|(name, _)| !packed.contains(name));
    let out = folder("OUT_DIR")?;
    let mut source = String::from("&[\n");
    for (k, (name, path)) in files.iter().enumerate() {
        // A copy: the page may be rebuilt before the compiler reads it.
        let copy = out.join(format!("page-{k}"));
        fs::copy(path, &copy)?;
        let _ = writeln!(source, "    ({name:?}, include_bytes!({copy:?}) as &[u8]),");
    }
    source += "]\n";
    fs::write(out.join("page.rs"), source)
}

/// Collects the files of a folder: their names in addresses, and their paths.
fn collect(folder: &Path, before: &str, files: &mut Vec<(String, PathBuf)>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{before}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            collect(&entry.path(), &format!("{name}/"), files)?;
        } else {
            files.push((name, entry.path()));
        }
    }
    Ok(())
}
