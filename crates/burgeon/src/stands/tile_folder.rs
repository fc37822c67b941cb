//! The folder of a tileset: its files are written one after another, and existing ones stay.

use std::collections::BTreeMap;
use std::io::Write;

use base::Digest;
use formats::WriteError;
use serde::{Deserialize, Serialize};

use super::plan::ForestTilesError;

/// Name of the file that lists every file of a finished tileset with its digest.
pub const TILES_MANIFEST: &str = "manifest.json";
/// Name of the same list for an unfinished tileset: one line for each file.
pub const TILES_JOURNAL: &str = "unfinished.jsonl";
/// Name of the file that readers open; it exists only while every file that it names does.
pub const TILESET: &str = "tileset.json";
/// The value of [`Manifest::schema`].
const SCHEMA: &str = "burgeon.forest/1";
/// Most files that are put in place together.
const BATCH: usize = 64;
/// Most bytes that are put in place together.
const BATCH_BYTES: usize = 16 << 20;
/// Largest size of a manifest; a tile takes some 90 bytes in it.
const MOST_BYTES: u64 = 1 << 30;

/// The disk of a shell, below the folder of a tileset. Names of files are paths with `/` from that folder.
pub trait TileDisk {
    /// Errors of the shell.
    type Error: From<ForestTilesError>;

    /// Returns the bytes of a file, at most `most` and one more; `None` for a file that does not exist.
    ///
    /// # Errors
    /// Error of a file that exists and cannot be read.
    fn read(&self, file: &str, most: u64) -> Result<Option<Vec<u8>>, Self::Error>;

    /// Puts files in place, all of them or none, and makes the folders that they need.
    ///
    /// # Errors
    /// Error of a disk that refuses.
    fn place(&mut self, files: &[(String, Vec<u8>)]) -> Result<(), Self::Error>;

    /// Adds text to the end of a file.
    ///
    /// # Errors
    /// Error of a disk that refuses.
    fn append(&mut self, file: &str, text: &str) -> Result<(), Self::Error>;

    /// Removes a file, if it is there.
    ///
    /// # Errors
    /// Error of a disk that refuses.
    fn remove(&mut self, file: &str) -> Result<(), Self::Error>;

    /// Writes a file of the last step as a stream. It need not be in place before the shell ends.
    ///
    /// # Errors
    /// Error of a disk that refuses, and of `write`.
    fn write_last(
        &mut self,
        file: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> Result<(), WriteError>,
    ) -> Result<(), Self::Error>;
}

/// A file as it was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TileFile {
    /// Path from the folder, with `/`.
    pub file: String,
    /// The first 32 digits of its SHA-256.
    pub digest: String,
    /// Its size.
    pub bytes: u64,
}

impl TileFile {
    fn new(file: &str, bytes: &[u8]) -> Self {
        let mut digest = Digest::new();
        digest.bytes(bytes);
        Self { file: file.to_owned(), digest: digest.hex(), bytes: bytes.len() as u64 }
    }
}

/// The files of a folder.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Manifest {
    schema: String,
    version: String,
    /// Digest of its inputs: the trees, their species, the options and the version. Equal keys, equal tiles.
    key: String,
    files: Vec<TileFile>,
}

/// The first line of a journal.
#[derive(Debug, Serialize, Deserialize)]
struct Head {
    schema: String,
    key: String,
}

/// A folder that is being filled.
#[derive(Debug)]
pub struct TileFolder<D> {
    disk: D,
    key: String,
    /// Files that an earlier run wrote from the same input.
    known: BTreeMap<String, TileFile>,
    /// Files of another forest that the folder held.
    stale: Vec<String>,
    /// All files of this run.
    files: BTreeMap<String, TileFile>,
    waiting: Vec<(String, Vec<u8>)>,
    waiting_bytes: usize,
    /// Whether the journal exists there.
    is_open: bool,
    /// Whether the manifest of this forest exists there: missing files are made again, with the bytes that it lists.
    is_whole: bool,
    kept: u64,
    written: u64,
    /// Files of the last step.
    last: Vec<TileFile>,
}

impl<D: TileDisk> TileFolder<D> {
    /// Reads the present state of the folder. `key`: [`ForestPlan::key`](super::ForestPlan::key).
    ///
    /// # Errors
    /// [`ForestTilesError::NoManifest`] for a folder of something else.
    pub fn open(disk: D, key: &str) -> Result<Self, D::Error> {
        let manifest = disk.read(TILES_MANIFEST, MOST_BYTES)?;
        let journal = disk.read(TILES_JOURNAL, MOST_BYTES)?;
        let mut folder = Self {
            disk,
            key: key.to_owned(),
            known: BTreeMap::new(),
            stale: Vec::new(),
            files: BTreeMap::new(),
            waiting: Vec::new(),
            waiting_bytes: 0,
            is_open: false,
            is_whole: false,
            kept: 0,
            written: 0,
            last: Vec::new(),
        };
        if let Some(manifest) = manifest {
            let manifest = serde_json::from_slice(&manifest).ok().filter(|m: &Manifest| m.schema == SCHEMA);
            let manifest = manifest.ok_or(ForestTilesError::NoManifest)?;
            folder.is_whole = manifest.key == key;
            folder.take(folder.is_whole, manifest.files);
        }
        if let Some(journal) = journal {
            let text = String::from_utf8_lossy(&journal).into_owned();
            let mut lines = text.lines();
            let head = lines.next().and_then(|l| serde_json::from_str::<Head>(l).ok());
            // A line that a power failure cut off is ignored.
            let files = lines.filter_map(|l| serde_json::from_str(l).ok()).collect();
            folder.is_open = head.is_some_and(|h| h.key == key);
            folder.take(folder.is_open, files);
        }
        Ok(folder)
    }

    fn take(&mut self, is_same: bool, files: Vec<TileFile>) {
        for own in files.into_iter().filter(|f| is_below(&f.file)) {
            if is_same {
                self.known.insert(own.file.clone(), own);
            } else {
                self.stale.push(own.file);
            }
        }
    }

    /// Keeps a file that an earlier run wrote in full, and returns its bytes.
    pub(crate) fn keep(&mut self, file: &str) -> Option<Vec<u8>> {
        if let Some((_, bytes)) = self.waiting.iter().find(|(name, _)| name == file) {
            return Some(bytes.clone());
        }
        let known = self.files.get(file).or_else(|| self.known.get(file))?.clone();
        // A file that cannot be read is made again.
        let bytes = self.disk.read(file, known.bytes).ok().flatten()?;
        if TileFile::new(file, &bytes) != known {
            return None;
        }
        if self.files.insert(file.to_owned(), known).is_none() {
            self.kept += 1;
        }
        Some(bytes)
    }

    /// Whether this run has written or kept a file.
    fn has(&self, file: &str) -> bool {
        self.files.contains_key(file) || self.waiting.iter().any(|(name, _)| name == file)
    }

    /// Queues a file for writing.
    pub(crate) fn put(&mut self, file: &str, bytes: Vec<u8>) -> Result<(), D::Error> {
        if self.has(file) {
            return Ok(());
        }
        self.waiting_bytes += bytes.len();
        self.waiting.push((file.to_owned(), bytes));
        if self.waiting.len() >= BATCH || self.waiting_bytes >= BATCH_BYTES { self.flush() } else { Ok(()) }
    }

    /// Puts all queued files in place, and lists them in the journal.
    pub(crate) fn flush(&mut self) -> Result<(), D::Error> {
        if self.waiting.is_empty() {
            return Ok(());
        }
        self.begin()?;
        let files = std::mem::take(&mut self.waiting);
        self.waiting_bytes = 0;
        self.disk.place(&files)?;
        let made: Vec<TileFile> = files.iter().map(|(file, bytes)| TileFile::new(file, bytes)).collect();
        self.written += made.len() as u64;
        self.note(&made)?;
        self.files.extend(made.into_iter().map(|f| (f.file.clone(), f)));
        Ok(())
    }

    /// Takes over files that others have put in place: other processes, other machines. They are listed, and their
    /// digests are compared with the files when these are needed.
    ///
    /// # Errors
    /// Error of a disk that refuses.
    pub fn adopt(&mut self, files: Vec<TileFile>) -> Result<(), D::Error> {
        self.begin()?;
        self.note(&files)?;
        self.take(true, files);
        Ok(())
    }

    /// Marks the folder as unfinished from now on.
    fn begin(&mut self) -> Result<(), D::Error> {
        if self.is_open || self.is_whole {
            return Ok(());
        }
        // First the journal with the files that may stay is written, then the file that readers open is removed.
        let head = line(&Head { schema: SCHEMA.into(), key: self.key.clone() })?;
        let known: Vec<String> = self.known.values().map(line).collect::<Result<_, _>>()?;
        let text = head + &known.concat();
        self.disk.place(&[(TILES_JOURNAL.to_owned(), text.into_bytes())])?;
        for file in [TILESET, TILES_MANIFEST] {
            self.disk.remove(file)?;
        }
        self.is_open = true;
        Ok(())
    }

    fn note(&mut self, files: &[TileFile]) -> Result<(), D::Error> {
        if self.is_whole {
            return Ok(());
        }
        let lines: Vec<String> = files.iter().map(line).collect::<Result<_, _>>()?;
        self.disk.append(TILES_JOURNAL, &lines.concat())
    }

    /// Returns the bytes of a file of this folder.
    pub(crate) fn read(&self, file: &str) -> Result<Option<Vec<u8>>, D::Error> {
        self.disk.read(file, u64::MAX - 1)
    }

    /// Writes a file of the last step.
    pub(crate) fn write_last(
        &mut self,
        file: &str,
        mut write: impl FnMut(&mut dyn Write) -> Result<(), WriteError>,
    ) -> Result<(), D::Error> {
        let (mut digest, mut bytes) = (Digest::new(), 0);
        self.disk.write_last(file, &mut |out| {
            (digest, bytes) = (Digest::new(), 0);
            write(&mut Tally { out, digest: &mut digest, bytes: &mut bytes })
        })?;
        self.last.push(TileFile { file: file.to_owned(), digest: digest.hex(), bytes });
        Ok(())
    }

    /// Adds the manifest of all files to those of the last step.
    pub(crate) fn manifest(&mut self) -> Result<(), D::Error> {
        let files: BTreeMap<&String, &TileFile> =
            self.files.values().chain(&self.last).map(|own| (&own.file, own)).collect();
        let manifest = Manifest {
            schema: SCHEMA.into(),
            version: crate::VERSION.into(),
            key: self.key.clone(),
            files: files.into_values().cloned().collect(),
        };
        let text = line(&manifest)?;
        self.disk.write_last(TILES_MANIFEST, &mut |out| Ok(out.write_all(text.as_bytes())?))
    }

    /// Removes the journal, and the remains of another forest, after all files are in place.
    ///
    /// # Errors
    /// Error of a disk that refuses.
    pub fn end(&mut self) -> Result<(), D::Error> {
        self.disk.remove(TILES_JOURNAL)?;
        for file in std::mem::take(&mut self.stale) {
            let is_ours = self.files.contains_key(&file) || self.last.iter().any(|own| own.file == file);
            if !is_ours && ![TILESET, TILES_MANIFEST].contains(&file.as_str()) {
                self.disk.remove(&file)?;
            }
        }
        Ok(())
    }

    /// Returns every file so far.
    pub fn files(&self) -> impl Iterator<Item = &TileFile> {
        self.files.values().chain(&self.last)
    }

    /// Returns the numbers of files that an earlier run wrote and that stay, and of those that this one wrote before
    /// the last step.
    pub const fn kept_and_written(&self) -> (u64, u64) {
        (self.kept, self.written)
    }

    /// Returns the disk.
    pub const fn disk(&mut self) -> &mut D {
        &mut self.disk
    }
}

fn line(value: &impl Serialize) -> Result<String, ForestTilesError> {
    let text = serde_json::to_string(value).map_err(|e| ForestTilesError::Bug(e.to_string()))?;
    Ok(text + "\n")
}

/// Whether a file of a manifest lies below the folder.
fn is_below(file: &str) -> bool {
    let is_name =
        |part: &str| !part.is_empty() && part != "." && part != ".." && !part.contains(['\\', ':', '\0']);
    file.split('/').all(is_name)
}

/// Counts and digests the bytes that it passes on.
struct Tally<'a> {
    out: &'a mut dyn Write,
    digest: &'a mut Digest,
    bytes: &'a mut u64,
}

impl Write for Tally<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let n = self.out.write(bytes)?;
        self.digest.bytes(&bytes[..n]);
        *self.bytes += n as u64;
        Ok(n)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

impl std::fmt::Debug for Tally<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Tally").field("bytes", self.bytes).finish_non_exhaustive()
    }
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
