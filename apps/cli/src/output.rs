//! Files appear whole or not at all.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

use burgeon::formats::WriteError;

use crate::failure::{Failure, Outcome};

/// Drafts that are being written, for a program that is ended in the middle.
static DRAFTS: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// A temporary file beside its target; removed unless renamed.
struct Draft {
    path: PathBuf,
}

impl Draft {
    fn beside(target: &Path) -> Self {
        let path = draft_path(target);
        if let Ok(mut drafts) = DRAFTS.lock() {
            drafts.insert(path.clone());
        }
        Self { path }
    }

    fn create(&self) -> io::Result<File> {
        File::options().write(true).create_new(true).open(&self.path)
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // Gone already after the rename.
        let _ = fs::remove_file(&self.path);
        if let Ok(mut drafts) = DRAFTS.lock() {
            drafts.remove(&self.path);
        }
    }
}

/// Removes what is half-written; for the end of the program.
pub(crate) fn remove_drafts() {
    if let Ok(mut drafts) = DRAFTS.lock() {
        drafts.iter().for_each(|path| drop(fs::remove_file(path)));
        drafts.clear();
    }
}

/// [`remove_drafts`] where nothing may be waited for: the caller may hold what it takes.
pub(crate) fn abandon_drafts() {
    if let Ok(drafts) = DRAFTS.try_lock() {
        drafts.iter().for_each(|path| drop(fs::remove_file(path)));
    }
}

/// Writes a file through a temporary one beside it, which is renamed once it is complete.
///
/// A link is followed: what it points to is replaced. A device or a pipe (`/dev/stdout`) is written as it is.
pub(crate) fn write_whole(
    target: &Path,
    write: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
) -> Outcome {
    check_target(target)?;
    let failed = |e: &io::Error| Failure::io(target, "written", e);
    if is_device(target) {
        let mut out = BufWriter::new(File::options().write(true).open(target).map_err(|e| failed(&e))?);
        write(&mut out).map_err(|e| write_failed(target, e))?;
        return out.flush().map_err(|e| failed(&e));
    }
    let place = fs::canonicalize(target).unwrap_or_else(|_| target.to_path_buf());
    if fs::metadata(&place).is_ok_and(|m| m.permissions().readonly()) {
        return Err(Failure::at(target, "is write-protected; give another name or lift the protection"));
    }
    let draft = Draft::beside(&place);
    let mut out = BufWriter::new(draft.create().map_err(|e| failed(&e))?);
    write(&mut out).map_err(|e| write_failed(target, e))?;
    let file = out.into_inner().map_err(|e| failed(e.error()))?;
    // So that a crash of the machine does not leave an empty file under the target's name.
    file.sync_data().map_err(|e| failed(&e))?;
    drop(file);
    fs::rename(&draft.path, &place).map_err(|e| failed(&e))
}

// Not to be replaced by a file: a renamed file in the place of /dev/null would break the machine.
fn is_device(target: &Path) -> bool {
    ["/dev/stdout", "/dev/stderr", "/dev/fd", "/proc/self/fd"].iter().any(|p| target.starts_with(p))
        || fs::metadata(target).is_ok_and(|m| !m.is_file() && !m.is_dir())
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
    if target.as_os_str() == "-" {
        return Err(Failure::at(
            target,
            "is no name for a result; name a file (./- for one that is called -)",
        ));
    }
    if target.file_name().is_none() || target.is_dir() {
        return Err(Failure::at(target, "is a folder; name a file in it"));
    }
    let folder = target.parent().filter(|p| !p.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|p| !p.is_dir()) {
        let what =
            if folder.exists() { "is a file, not a folder" } else { "does not exist; create it first" };
        return Err(Failure::at(target, format_args!("the folder {} {what}", folder.display())));
    }
    Ok(())
}

/// [`check_target`] for each output, by the option that names it, before anything is computed: outputs that
/// are one file and outputs that would replace an input are refused as well.
pub(crate) fn check_outputs(outputs: &[(&str, Option<&PathBuf>)], inputs: &[&PathBuf]) -> Outcome {
    let place = |path: &Path| match fs::canonicalize(path) {
        Ok(place) => place,
        Err(_) => {
            let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
            let parent = fs::canonicalize(parent).unwrap_or_else(|_| parent.to_path_buf());
            parent.join(path.file_name().unwrap_or_default())
        }
    };
    let mut taken: Vec<(&str, PathBuf)> = Vec::new();
    for &(option, path) in outputs {
        let Some(path) = path else { continue };
        check_target(path)?;
        if is_device(path) {
            continue;
        }
        let place = place(path);
        if let Some((other, _)) = taken.iter().find(|(_, p)| *p == place) {
            return Err(Failure::at(path, format_args!("{other} and {option} name the same file")));
        }
        if inputs.iter().any(|input| fs::canonicalize(input).is_ok_and(|input| input == place)) {
            let what = format_args!("{option} would replace the input; give another name");
            return Err(Failure::at(path, what));
        }
        try_folder(path, &place)?;
        taken.push((option, place));
    }
    Ok(())
}

// An empty draft tells what the rights say, before the work rather than after it.
fn try_folder(target: &Path, place: &Path) -> Outcome {
    let draft = Draft::beside(place);
    draft.create().map(drop).map_err(|e| Failure::io(target, "written", &e))
}

/// Makes a folder for a batch, with those above it.
pub(crate) fn make_folder(folder: &Path) -> Outcome {
    if folder.exists() && !folder.is_dir() {
        return Err(Failure::at(folder, "is a file, but several drawings need a folder; name one"));
    }
    fs::create_dir_all(folder).map_err(|e| Failure::io(folder, "created", &e))?;
    try_folder(folder, &folder.join("any"))
}

// Beside the target, hidden, unique in this process and among others.
fn draft_path(target: &Path) -> PathBuf {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    // Not made of the target's name, which may be as long as names can be.
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    target.with_file_name(format!(".burgeon-{}-{count}.part", std::process::id()))
}
