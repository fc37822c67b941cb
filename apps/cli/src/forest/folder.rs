//! The disk below the folder of a tileset.

use std::fs::{self, OpenOptions};
use std::io::{self, Read as _, Write};
use std::path::{Path, PathBuf};

use burgeon::formats::WriteError;
use burgeon::{ForestTilesError, NurseryError, TILES_JOURNAL, TILES_MANIFEST, TileDisk};

use crate::failure::{Failure, Outcome};
use crate::inputs;
use crate::output::{self, Outputs};

/// A folder of the disk.
#[derive(Debug)]
pub(super) struct FolderDisk {
    path: PathBuf,
    /// Removes the folder again if it stays empty.
    _made: Outputs,
    /// Outputs that are put in place at the end of the command.
    pub(super) outputs: Outputs,
}

impl FolderDisk {
    pub(super) fn new(path: &Path, outputs: Outputs) -> Outcome<Self> {
        check(path)?;
        let mut made = Outputs::default();
        made.folder(path)?;
        Ok(Self { path: path.to_path_buf(), _made: made, outputs })
    }
}

impl TileDisk for FolderDisk {
    type Error = Failure;

    fn read(&self, file: &str, most: u64) -> Outcome<Option<Vec<u8>>> {
        let path = self.path.join(file);
        let failed = |e: &io::Error| Failure::io(&path, "read", e);
        // Not an input: it may be overwritten.
        let file = match inputs::open_own(&path) {
            Ok(file) => file,
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(failed(&e)),
        };
        let mut bytes = Vec::new();
        file.take(most.saturating_add(1)).read_to_end(&mut bytes).map_err(|e| failed(&e))?;
        Ok(Some(bytes))
    }

    fn place(&mut self, files: &[(String, Vec<u8>)]) -> Outcome {
        let mut outputs = Outputs::default();
        for (file, bytes) in files {
            let path = self.path.join(file);
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder).map_err(|e| Failure::io(folder, "created", &e))?;
            }
            outputs.write("-o", &path, |out| Ok(out.write_all(bytes)?))?;
        }
        outputs.place()
    }

    fn append(&mut self, file: &str, text: &str) -> Outcome {
        let path = self.path.join(file);
        let written = OpenOptions::new()
            .append(true)
            .create(true)
            .open(&path)
            .and_then(|mut file| file.write_all(text.as_bytes()));
        written.map_err(|e| Failure::io(&path, "written", &e))
    }

    fn remove(&mut self, file: &str) -> Outcome {
        let path = self.path.join(file);
        match fs::remove_file(&path) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => Err(Failure::io(&path, "removed", &e)),
            _ => Ok(()),
        }
    }

    fn write_last(
        &mut self,
        file: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> Result<(), WriteError>,
    ) -> Outcome {
        self.outputs.write("-o", &self.path.join(file), |out| write(out))
    }
}

impl From<ForestTilesError> for Failure {
    fn from(error: ForestTilesError) -> Self {
        match error {
            ForestTilesError::Nursery(NurseryError::Stopped(stopped)) => stopped.into(),
            ForestTilesError::Write(e @ WriteError::Io(_)) => output::write_failed(Path::new("forest"), e),
            ForestTilesError::Write(e) => Self::Bug(e.to_string()),
            ForestTilesError::Bug(line) => Self::Bug(line),
            e @ ForestTilesError::TooSmall(_) => Self::Bad(format!("{e} (--impostor off)")),
            e @ ForestTilesError::NoManifest => Self::Bad(format!("{TILES_MANIFEST} {e}")),
            e => Self::Bad(e.to_string()),
        }
    }
}

/// Fails early for a folder that does not belong to a forest.
pub(super) fn check(path: &Path) -> Outcome {
    if path.exists() && !path.is_dir() {
        return Err(Failure::bad_file(path, "is a file, but a forest needs a folder; name another one"));
    }
    let is_ours = [TILES_MANIFEST, TILES_JOURNAL].iter().any(|file| path.join(file).exists());
    if !is_ours && path.is_dir() && has_files(path)? {
        return Err(Failure::bad_file(
            path,
            "is a folder with other files in it, and tiles of a forest want one of their own; name a new one",
        ));
    }
    Ok(())
}

/// Whether a folder has files other than hidden ones.
fn has_files(path: &Path) -> Outcome<bool> {
    let entries = fs::read_dir(path).map_err(|e| Failure::io(path, "read", &e))?;
    let mut names = entries.filter_map(|e| Some(e.ok()?.file_name()));
    Ok(names.any(|name| !name.to_string_lossy().starts_with('.')))
}
