//! Every file that a command reads, so that none of them is overwritten.

use std::collections::BTreeMap;
use std::fs::{self, File, Metadata};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use companions::{LIMITS, Named, NamedFault, NamedFileError, Trust};

/// Whether the path is `-`, which stands for standard input.
pub(crate) fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Identity of a file, whatever its name: names differ by links, hard links, case and mounts.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum FileId {
    /// Device and number on it.
    #[cfg(unix)]
    Inode(u64, u64),
    /// Where the system does not number files: the path without links, as the disk writes it.
    #[cfg(not(unix))]
    Path(PathBuf),
}

impl FileId {
    /// Returns the identity of an existing file or folder; links are followed.
    pub(crate) fn from_path(path: &Path) -> Option<Self> {
        Self::new(path, &fs::metadata(path).ok()?)
    }

    #[cfg(unix)]
    #[expect(clippy::unnecessary_wraps, reason = "elsewhere there may be none")]
    fn new(_: &Path, metadata: &Metadata) -> Option<Self> {
        use std::os::unix::fs::MetadataExt as _;
        Some(Self::Inode(metadata.dev(), metadata.ino()))
    }

    #[cfg(not(unix))]
    fn new(path: &Path, _: &Metadata) -> Option<Self> {
        fs::canonicalize(path).ok().map(Self::Path)
    }
}

/// Files that this command has read or is going to read: a process runs one command.
static READ: Mutex<BTreeMap<FileId, PathBuf>> = Mutex::new(BTreeMap::new());

fn note(path: &Path, source: &Path, metadata: &Metadata) {
    // Pipes and devices are not replaced anyway.
    if !metadata.is_file() {
        return;
    }
    if let (Some(id), Ok(mut read)) = (FileId::new(source, metadata), READ.lock()) {
        read.entry(id).or_insert_with(|| path.to_path_buf());
    }
}

/// Registers a file that an option names, before anything is computed. `-` is the file behind standard input, if it is
/// one.
pub(crate) fn announce(path: &Path) {
    let (path, source) = match path.as_os_str() == "-" {
        true => (Path::new("standard input"), Path::new("/dev/stdin")),
        false => (path, path),
    };
    if let Ok(metadata) = fs::metadata(source) {
        note(path, source, &metadata);
    }
}

/// Opens a file for reading. Files opened in any other way are not protected from being overwritten.
pub(crate) fn open(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    if let Ok(metadata) = file.metadata() {
        note(path, path, &metadata);
    }
    Ok(file)
}

/// Returns the text of one of the system's own small files.
pub(crate) fn system_text(path: &Path) -> Option<String> {
    let mut text = String::new();
    open(path).ok()?.take(LIMITS.text).read_to_string(&mut text).ok()?;
    Some(text)
}

/// Whether files may name others outside their folders; a process runs one command.
static TRUSTED: AtomicBool = AtomicBool::new(false);

/// Sets the value of --trust-paths.
pub(crate) fn trust_paths(trusted: bool) {
    TRUSTED.store(trusted, Ordering::Relaxed);
}

fn trust() -> Trust {
    Trust { paths: TRUSTED.load(Ordering::Relaxed), allow: "--trust-paths" }
}

/// Returns the path of a file that another one names, if it may be opened. A missing file may be: opening it reports
/// that.
pub(crate) fn named_path(naming: &Path, name: &str) -> Result<PathBuf, NamedFileError> {
    let named = Named { naming, name };
    match named.find(trust()) {
        Err(e) if !matches!(e.fault, NamedFault::Missing) => return Err(e),
        _ => announce(&named.path()),
    }
    Ok(named.path())
}

/// Registers a file that another one names, read or not. The disk is not asked for one that must not be read.
pub(crate) fn announce_named(naming: &Path, name: &str) {
    let named = Named { naming, name };
    if named.find(trust()).is_ok() {
        announce(&named.path());
    }
}

/// Reads a file that another one names: at most `limit` bytes.
pub(crate) fn named_bytes(naming: &Path, name: &str, limit: u64) -> Result<Vec<u8>, NamedFileError> {
    let named = Named { naming, name };
    let (file, path) = named.open(trust(), limit)?;
    if let Ok(metadata) = file.metadata() {
        note(&named.path(), &path, &metadata);
    }
    named.read(file, limit)
}

/// Opens a file of an earlier run of the same command, which this run continues: not an input, as it may be rewritten.
pub(crate) fn open_own(path: &Path) -> io::Result<File> {
    File::open(path)
}

/// Reads a file of an earlier run.
pub(crate) fn read_own(path: &Path) -> io::Result<Vec<u8>> {
    fs::read(path)
}

/// Returns the path by which a file was read.
pub(crate) fn read_as(id: &FileId) -> Option<PathBuf> {
    READ.lock().ok()?.get(id).cloned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Files that are not opened through [`open`] could be overwritten.
    #[test]
    fn nothing_is_read_past_this_module() {
        let mut found = Vec::new();
        let mut folders = vec![PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/src"))];
        let mut sources = Vec::new();
        while let Some(folder) = folders.pop() {
            for path in fs::read_dir(folder).expect("our own sources").flatten().map(|e| e.path()) {
                // The Studio's server writes only files that it opened.
                if path.is_dir() && !path.ends_with("studio") {
                    folders.push(path);
                } else if path.is_file() {
                    sources.push(path);
                }
            }
        }
        for path in sources.into_iter().filter(|p| !p.ends_with("inputs.rs")) {
            let text = fs::read_to_string(&path).expect("text");
            let text = text.split("#[cfg(test)]").next().unwrap_or_default();
            let ways = ["File::open(", "fs::read(", "fs::read_to_string("];
            found.extend(
                ways.iter().filter(|w| text.contains(*w)).map(|w| format!("{w} in {}", path.display())),
            );
        }
        assert_eq!(found, Vec::<String>::new());
    }
}
