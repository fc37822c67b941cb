//! Files that are being written: hidden, beside their target, under a name that nobody else has.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::hash::{BuildHasher as _, Hasher as _, RandomState};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

/// Drafts of this process, for a program that is ended in the middle.
static DRAFTS: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
/// Folders in which old drafts were looked for.
static SWEPT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

const START: &str = ".burgeon-";
const END: &str = ".part";
/// A draft that nobody wrote to for so long was left by a process that was killed.
const STALE: Duration = Duration::from_secs(24 * 60 * 60);

/// A temporary file in the folder of its target; removed unless it is put in place.
#[derive(Debug)]
pub(crate) struct Draft {
    path: PathBuf,
}

impl Draft {
    /// A new, empty file in a folder, in which drafts that were left behind are removed first.
    pub(crate) fn create(folder: &Path) -> io::Result<(Self, File)> {
        sweep_once(folder);
        let create = |path: &Path| File::options().write(true).create_new(true).open(path);
        Self::fresh(folder, create)
    }

    /// A second name of a file that this draft is to replace, by which it can be put back. Not on every file system, and
    /// only of files of the same owner: in a folder such as /tmp another's name could not be removed again.
    pub(crate) fn keeping(&self, file: &Path) -> io::Result<Self> {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt as _;
            if fs::symlink_metadata(file)?.uid() != fs::symlink_metadata(&self.path)?.uid() {
                return Err(io::ErrorKind::PermissionDenied.into());
            }
        }
        let folder = file.parent().unwrap_or(Path::new("."));
        Self::fresh(folder, |path| fs::hard_link(file, path)).map(|(draft, ())| draft)
    }

    // A name that is taken is another's: it is left alone and the next one is tried.
    fn fresh<T>(folder: &Path, make: impl Fn(&Path) -> io::Result<T>) -> io::Result<(Self, T)> {
        let mut last = io::Error::from(io::ErrorKind::AlreadyExists);
        for _ in 0..64 {
            let path = folder.join(format!("{START}{:016x}{END}", random()));
            // Under the lock: what is made is known, so that it is removed when the program is ended.
            let mut drafts = DRAFTS.lock().unwrap_or_else(PoisonError::into_inner);
            match make(&path) {
                Ok(made) => {
                    drafts.insert(path.clone());
                    return Ok((Self { path }, made));
                }
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => last = e,
                Err(e) => return Err(e),
            }
        }
        Err(last)
    }

    /// Gives the file its name; what had that name is replaced.
    pub(crate) fn put(&mut self, place: &Path) -> io::Result<()> {
        fs::rename(&self.path, place)?;
        DRAFTS.lock().unwrap_or_else(PoisonError::into_inner).remove(&self.path);
        self.path = PathBuf::new();
        Ok(())
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if DRAFTS.lock().unwrap_or_else(PoisonError::into_inner).remove(&self.path) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Removes what is half-written; for the end of the program.
pub(crate) fn remove_all() {
    let mut drafts = DRAFTS.lock().unwrap_or_else(PoisonError::into_inner);
    drafts.iter().for_each(|path| drop(fs::remove_file(path)));
    drafts.clear();
}

/// [`remove_all`] where nothing may be waited for: the caller may hold what it takes.
pub(crate) fn abandon_all() {
    if let Ok(drafts) = DRAFTS.try_lock() {
        drafts.iter().for_each(|path| drop(fs::remove_file(path)));
    }
}

// Keys of hash maps are random numbers of the system, which is all that is wanted here: other processes, and others in
// containers where each has the same number, take other names.
fn random() -> u64 {
    RandomState::new().build_hasher().finish()
}

/// Whether a name is one of [`Draft`]'s, or of those of versions 0.1 (numbers with a dash).
fn is_ours(name: &str) -> bool {
    let Some(middle) = name.strip_prefix(START).and_then(|n| n.strip_suffix(END)) else { return false };
    let number = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    match middle.split_once('-') {
        Some((process, count)) => number(process) && number(count),
        None => middle.len() == 16 && middle.bytes().all(|b| b.is_ascii_hexdigit()),
    }
}

fn sweep_once(folder: &Path) {
    if SWEPT.lock().is_ok_and(|mut swept| swept.insert(folder.to_path_buf())) {
        sweep(folder, SystemTime::now());
    }
}

// Errors do not matter: somebody else may sweep at the same time.
fn sweep(folder: &Path, now: SystemTime) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if !entry.file_name().to_str().is_some_and(is_ours) {
            continue;
        }
        let stale = |m: &fs::Metadata| {
            let age = m.modified().ok().and_then(|t| now.duration_since(t).ok());
            m.is_file() && age.is_some_and(|age| age > STALE)
        };
        // Of the entry itself, not of what a link points to.
        if entry.metadata().is_ok_and(|m| stale(&m)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_drafts_are_ours() {
        for name in [".burgeon-0123456789abcdef.part", ".burgeon-17-3.part"] {
            assert!(is_ours(name), "{name}");
        }
        for name in [
            ".burgeon-.part",
            ".burgeon-bee.part",
            "burgeon-1-1.part",
            ".burgeon-1-1.partly",
            ".burgeon--.part",
        ] {
            assert!(!is_ours(name), "{name}");
        }
    }

    #[test]
    fn a_name_that_is_taken_is_left_alone() {
        let folder = std::env::temp_dir().join(format!("burgeon-draft-{:x}", random()));
        fs::create_dir(&folder).expect("a folder");
        let mut tries = std::cell::Cell::new(0);
        let taken = folder.join("taken");
        fs::write(&taken, "another's").expect("writes");
        let made = Draft::fresh(&folder, |path| {
            tries.set(tries.get() + 1);
            let path = if tries.get() < 4 { &taken } else { path };
            File::options().write(true).create_new(true).open(path)
        });
        drop(made.expect("the fourth name is free"));
        assert_eq!(*tries.get_mut(), 4);
        let failed = Draft::fresh(&folder, |_| File::options().write(true).create_new(true).open(&taken));
        assert_eq!(failed.err().map(|e| e.kind()), Some(io::ErrorKind::AlreadyExists));
        assert_eq!(fs::read_to_string(&taken).expect("still there"), "another's");
        assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 1);
        fs::remove_dir_all(&folder).expect("removed");
    }
}
