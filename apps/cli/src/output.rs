//! Files appear whole or not at all.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use burgeon::formats::WriteError;

use crate::failure::{Failure, Outcome};

/// A temporary file beside its target; removed unless renamed.
struct Draft {
    path: PathBuf,
}

impl Drop for Draft {
    fn drop(&mut self) {
        // Gone already after the rename.
        let _ = fs::remove_file(&self.path);
    }
}

/// Writes a file through a temporary one beside it, which is renamed once it is complete.
pub(crate) fn write_whole(
    target: &Path,
    write: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
) -> Outcome {
    check_target(target)?;
    let draft = Draft { path: draft_path(target) };
    let failed = |e: &std::io::Error| Failure::io(target, "written", e);
    let file = File::options().write(true).create_new(true).open(&draft.path).map_err(|e| failed(&e))?;
    let mut out = BufWriter::new(file);
    match write(&mut out) {
        Ok(()) => {}
        Err(e) => return Err(write_failed(target, e)),
    }
    let file = out.into_inner().map_err(|e| failed(e.error()))?;
    // So that a crash of the machine does not leave an empty file under the target's name.
    file.sync_data().map_err(|e| failed(&e))?;
    drop(file);
    fs::rename(&draft.path, target).map_err(|e| failed(&e))
}

/// Whose fault it is that something could not be written.
pub(crate) fn write_failed(target: &Path, error: WriteError) -> Failure {
    match error {
        WriteError::Io(e) => Failure::io(target, "written", &e),
        e @ WriteError::Model { .. } => Failure::Bug(format!("{}: {e}", target.display())),
        e => Failure::at(target, e),
    }
}

/// Fails early and clearly when nothing can be written there.
pub(crate) fn check_target(target: &Path) -> Outcome {
    if target.file_name().is_none() || target.is_dir() {
        return Err(Failure::at(target, "is a folder; name a file in it"));
    }
    let folder = target.parent().filter(|p| !p.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|p| !p.is_dir()) {
        return Err(Failure::at(
            target,
            format_args!("the folder {} does not exist; create it first", folder.display()),
        ));
    }
    Ok(())
}

/// Makes a folder for a batch, with those above it.
pub(crate) fn make_folder(folder: &Path) -> Outcome {
    if folder.exists() && !folder.is_dir() {
        return Err(Failure::at(folder, "is a file; several drawings need a folder"));
    }
    fs::create_dir_all(folder).map_err(|e| Failure::io(folder, "created", &e))
}

// Beside the target, hidden, unique in this process and among others.
fn draft_path(target: &Path) -> PathBuf {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let mut name = std::ffi::OsString::from(".");
    name.push(target.file_name().unwrap_or_default());
    name.push(format!(".{}-{}.part", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    target.with_file_name(name)
}
