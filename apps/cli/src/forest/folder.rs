//! The folder of a tileset: its files come to be one after another, and those that are there already stay.

use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use burgeon::Digest;
use serde::{Deserialize, Serialize};

use crate::failure::{Failure, Outcome};
use crate::inputs;
use crate::output::Outputs;

/// Every file of a finished tileset with its digest.
pub(super) const MANIFEST: &str = "manifest.json";
/// The same of one that is being written: a line a file.
pub(super) const JOURNAL: &str = "unfinished.jsonl";
/// What readers open; there as long as all that it names is.
pub(super) const TILESET: &str = "tileset.json";
/// The value of [`Manifest::schema`].
const SCHEMA: &str = "burgeon.forest/1";
/// Files are put in place together up to so many, and so many bytes.
const BATCH: usize = 64;
const BATCH_BYTES: usize = 16 << 20;
/// No manifest is larger; a tile has some 90 bytes in it.
const MOST_BYTES: u64 = 1 << 30;

/// A file as it was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Entry {
    /// From the folder, with `/`.
    pub(super) file: String,
    /// The first 32 digits of its SHA-256.
    pub(super) digest: String,
    pub(super) bytes: u64,
}

impl Entry {
    pub(super) fn of(file: &str, bytes: &[u8]) -> Self {
        let mut digest = Digest::new();
        digest.bytes(bytes);
        Self { file: file.to_owned(), digest: digest.hex(), bytes: bytes.len() as u64 }
    }
}

/// What a folder holds.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Manifest {
    pub(super) schema: String,
    pub(super) version: String,
    /// What it was made from: the trees, their species, the options and the version. Equal keys, equal tiles.
    pub(super) key: String,
    pub(super) files: Vec<Entry>,
}

/// The first line of a journal.
#[derive(Debug, Serialize, Deserialize)]
struct Head {
    schema: String,
    key: String,
}

/// A folder that is being filled.
#[derive(Debug)]
pub(super) struct Folder {
    path: PathBuf,
    key: String,
    /// What an earlier run wrote from the same input.
    known: BTreeMap<String, Entry>,
    /// Files of another forest that the folder held.
    stale: Vec<String>,
    /// All of this run.
    files: BTreeMap<String, Entry>,
    waiting: Vec<(String, Vec<u8>)>,
    waiting_bytes: usize,
    /// The journal lies there.
    is_open: bool,
    /// The manifest of this forest lies there: what is missing is made again, and the bytes are those that it says.
    is_whole: bool,
    /// Makes the folder go again if nothing comes to lie in it.
    _made: Outputs,
    /// Files that were there already.
    pub(super) kept: u64,
    pub(super) written: u64,
}

impl Folder {
    /// Looks at what is there.
    pub(super) fn open(path: &Path, key: &str) -> Outcome<Self> {
        check(path)?;
        let mut made = Outputs::default();
        made.folder(path)?;
        let manifest = read(&path.join(MANIFEST))?;
        let journal = read(&path.join(JOURNAL))?;
        let mut folder = Self {
            path: path.to_path_buf(),
            key: key.to_owned(),
            known: BTreeMap::new(),
            stale: Vec::new(),
            files: BTreeMap::new(),
            waiting: Vec::new(),
            waiting_bytes: 0,
            is_open: false,
            is_whole: false,
            _made: made,
            kept: 0,
            written: 0,
        };
        if let Some(manifest) = manifest {
            let manifest: Manifest = serde_json::from_slice(&manifest)
                .ok()
                .filter(|m: &Manifest| m.schema == SCHEMA)
                .ok_or_else(|| {
                    Failure::at(&path.join(MANIFEST), "is not the manifest of a forest; name another folder")
                })?;
            folder.is_whole = manifest.key == key;
            folder.take(folder.is_whole, manifest.files);
        }
        if let Some(journal) = journal {
            let text = String::from_utf8_lossy(&journal).into_owned();
            let mut lines = text.lines();
            let head = lines.next().and_then(|l| serde_json::from_str::<Head>(l).ok());
            // A line that was cut off by the power says nothing.
            let entries = lines.filter_map(|l| serde_json::from_str(l).ok()).collect();
            let is_same = head.is_some_and(|h| h.key == key);
            folder.is_open = is_same;
            folder.take(is_same, entries);
        }
        Ok(folder)
    }

    fn take(&mut self, is_same: bool, entries: Vec<Entry>) {
        for entry in entries.into_iter().filter(|e| is_below(&e.file)) {
            if is_same {
                self.known.insert(entry.file.clone(), entry);
            } else {
                self.stale.push(entry.file);
            }
        }
    }

    /// The bytes of a file that an earlier run wrote whole, which stays.
    pub(super) fn keep(&mut self, file: &str) -> Option<Vec<u8>> {
        if let Some((_, bytes)) = self.waiting.iter().find(|(name, _)| name == file) {
            return Some(bytes.clone());
        }
        let known = self.files.get(file).or_else(|| self.known.get(file))?.clone();
        let mut bytes = Vec::new();
        // Not an input: it may be written over.
        inputs::open_own(&self.path.join(file)).ok()?.take(known.bytes + 1).read_to_end(&mut bytes).ok()?;
        if Entry::of(file, &bytes) != known {
            return None;
        }
        if self.files.insert(file.to_owned(), known).is_none() {
            self.kept += 1;
        }
        Some(bytes)
    }

    /// Whether this run has written or kept a file.
    pub(super) fn has(&self, file: &str) -> bool {
        self.files.contains_key(file) || self.waiting.iter().any(|(name, _)| name == file)
    }

    /// Writes a file, soon.
    pub(super) fn put(&mut self, file: &str, bytes: Vec<u8>) -> Outcome {
        if self.has(file) {
            return Ok(());
        }
        self.waiting_bytes += bytes.len();
        self.waiting.push((file.to_owned(), bytes));
        if self.waiting.len() >= BATCH || self.waiting_bytes >= BATCH_BYTES { self.flush() } else { Ok(()) }
    }

    /// Puts all that waits in place, and notes it.
    pub(super) fn flush(&mut self) -> Outcome {
        if self.waiting.is_empty() {
            return Ok(());
        }
        self.begin()?;
        let mut outputs = Outputs::default();
        let mut lines = String::new();
        let mut entries = Vec::with_capacity(self.waiting.len());
        for (file, bytes) in std::mem::take(&mut self.waiting) {
            let path = self.path.join(&file);
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder).map_err(|e| Failure::io(folder, "created", &e))?;
            }
            outputs.write("-o", &path, |out| Ok(out.write_all(&bytes)?))?;
            let entry = Entry::of(&file, &bytes);
            let line = serde_json::to_string(&entry).map_err(|e| Failure::Bug(e.to_string()))?;
            lines.push_str(&line);
            lines.push('\n');
            entries.push(entry);
        }
        self.waiting_bytes = 0;
        outputs.place()?;
        self.note(&lines)?;
        self.written += entries.len() as u64;
        self.files.extend(entries.into_iter().map(|e| (e.file.clone(), e)));
        Ok(())
    }

    /// From now on the folder says that it is not finished.
    fn begin(&mut self) -> Outcome {
        if self.is_open || self.is_whole {
            return Ok(());
        }
        // First the journal with what may stay, then what readers open goes.
        let head = Head { schema: SCHEMA.into(), key: self.key.clone() };
        let mut text = serde_json::to_string(&head).map_err(|e| Failure::Bug(e.to_string()))?;
        for entry in self.known.values() {
            text.push('\n');
            text.push_str(&serde_json::to_string(entry).map_err(|e| Failure::Bug(e.to_string()))?);
        }
        text.push('\n');
        let journal = self.path.join(JOURNAL);
        crate::output::write_one("-o", &journal, |out| Ok(out.write_all(text.as_bytes())?))?;
        for file in [TILESET, MANIFEST] {
            self.remove(file)?;
        }
        self.is_open = true;
        Ok(())
    }

    fn note(&self, lines: &str) -> Outcome {
        if self.is_whole {
            return Ok(());
        }
        let path = self.path.join(JOURNAL);
        let failed = |e: &std::io::Error| Failure::io(&path, "written", e);
        let mut journal = OpenOptions::new().append(true).create(true).open(&path).map_err(|e| failed(&e))?;
        journal.write_all(lines.as_bytes()).map_err(|e| failed(&e))
    }

    fn remove(&self, file: &str) -> Outcome {
        let path = self.path.join(file);
        match fs::remove_file(&path) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(Failure::io(&path, "removed", &e)),
            _ => Ok(()),
        }
    }

    /// The path of a file of the folder.
    pub(super) fn path(&self, file: &str) -> PathBuf {
        self.path.join(file)
    }

    /// Bytes of all files so far, and how many they are.
    pub(super) fn size(&self) -> (u64, u64) {
        (self.files.values().map(|e| e.bytes).sum(), self.files.len() as u64)
    }

    /// Lays the manifest of all files to `last`, which are put in place with it. `last` are not yet in place.
    pub(super) fn manifest(&self, last: &[Entry], outputs: &mut Outputs) -> Outcome {
        let files: BTreeMap<&String, &Entry> =
            self.files.iter().chain(last.iter().map(|e| (&e.file, e))).collect();
        let manifest = Manifest {
            schema: SCHEMA.into(),
            version: burgeon::VERSION.into(),
            key: self.key.clone(),
            files: files.into_values().cloned().collect(),
        };
        let mut text = serde_json::to_vec(&manifest).map_err(|e| Failure::Bug(e.to_string()))?;
        text.push(b'\n');
        outputs.write("-o", &self.path.join(MANIFEST), |out| Ok(out.write_all(&text)?))
    }

    /// Removes the journal, and what is left of another forest, after all is in place.
    pub(super) fn end(&self, last: &[Entry]) -> Outcome {
        self.remove(JOURNAL)?;
        for file in &self.stale {
            let is_ours = self.files.contains_key(file) || last.iter().any(|e| e.file == *file);
            if !is_ours && ![TILESET, MANIFEST].contains(&file.as_str()) {
                self.remove(file)?;
            }
        }
        Ok(())
    }
}

/// Fails early for a folder that is not a forest's.
pub(super) fn check(path: &Path) -> Outcome {
    if path.exists() && !path.is_dir() {
        return Err(Failure::at(path, "is a file, but a forest needs a folder; name another one"));
    }
    let is_ours = [MANIFEST, JOURNAL].iter().any(|file| path.join(file).exists());
    if !is_ours && path.is_dir() && has_files(path)? {
        return Err(Failure::at(
            path,
            "is a folder with other files in it, and tiles of a forest want one of their own; name a new one",
        ));
    }
    Ok(())
}

/// A file of a manifest lies below the folder.
fn is_below(file: &str) -> bool {
    let is_name =
        |part: &str| !part.is_empty() && part != "." && part != ".." && !part.contains(['\\', ':', '\0']);
    file.split('/').all(is_name)
}

/// A small file, if it is there.
fn read(path: &Path) -> Outcome<Option<Vec<u8>>> {
    let file = match inputs::open_own(path) {
        Ok(file) => file,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(Failure::io(path, "read", &e)),
    };
    let mut bytes = Vec::new();
    file.take(MOST_BYTES).read_to_end(&mut bytes).map_err(|e| Failure::io(path, "read", &e))?;
    Ok(Some(bytes))
}

/// A folder has files but those that are hidden.
fn has_files(path: &Path) -> Outcome<bool> {
    let entries = fs::read_dir(path).map_err(|e| Failure::io(path, "read", &e))?;
    let mut names = entries.filter_map(|e| Some(e.ok()?.file_name()));
    Ok(names.any(|name| !name.to_string_lossy().starts_with('.')))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_a_manifest_stay_below_its_folder() {
        for good in ["tileset.json", "tiles/0/1-2-3.glb"] {
            assert!(is_below(good), "{good}");
        }
        for bad in ["", "/etc/passwd", "../a", "tiles/../../a", "a//b", "c:\\a", "./a"] {
            assert!(!is_below(bad), "{bad}");
        }
    }
}
