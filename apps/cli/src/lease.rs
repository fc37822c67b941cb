//! The lock of a process in a folder into which it writes, and the files that it must not leave behind there.
//!
//! A process that writes into a folder keeps a lock file there as long as it has drafts. Where the lock is free, its
//! holder is gone, whatever machine, container or user it was: the next command that writes there finishes or removes
//! the remains.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, TryLockError};
use std::hash::{BuildHasher as _, Hasher as _, RandomState};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use crate::disk::{self, NewFile};

/// Files and folders that this process must not leave behind when it is interrupted.
pub(crate) struct State {
    pub(crate) drafts: BTreeSet<PathBuf>,
    locks: BTreeSet<PathBuf>,
    /// Folders made for outputs, to be removed if they are empty.
    folders: Vec<PathBuf>,
    leases: BTreeMap<PathBuf, Weak<Lease>>,
    /// Folders that were searched for the remains of others.
    swept: BTreeSet<PathBuf>,
}

static STATE: Mutex<State> = Mutex::new(State {
    drafts: BTreeSet::new(),
    locks: BTreeSet::new(),
    folders: Vec::new(),
    leases: BTreeMap::new(),
    swept: BTreeSet::new(),
});
/// Counter of drafts.
static COUNT: AtomicU64 = AtomicU64::new(0);
/// Number of tries for a free name: a name that is taken belongs to another.
pub(crate) const TRIES: usize = 64;

pub(crate) fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Role of a temporary file of a command in a folder. Its name is `.burgeon-RUN-NUMBER.part`, for example.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// A file that is not complete, or not in place.
    Part,
    /// A list of the files of a set that are complete and are to be put in place.
    Set,
    /// A pointer to the other folder with that list.
    See,
    /// A lock held by the process that owns the others.
    Lock,
}

impl Role {
    const ALL: [Self; 4] = [Self::Part, Self::Set, Self::See, Self::Lock];

    const fn extension(self) -> &'static str {
        match self {
            Self::Part => ".part",
            Self::Set => ".set",
            Self::See => ".see",
            Self::Lock => ".lock",
        }
    }

    /// Returns the run and the role of a file that has one of our names.
    pub(crate) fn from_file_name(name: &str) -> Option<(&str, Self)> {
        let rest = name.strip_prefix(START)?;
        let (role, rest) = Self::ALL.iter().find_map(|r| Some((*r, rest.strip_suffix(r.extension())?)))?;
        let (run, number) = rest.split_once('-').map_or((rest, None), |(run, number)| (run, Some(number)));
        let is_number = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
        let is_run = run.len() == 16 && run.bytes().all(|b| b.is_ascii_hexdigit());
        let is_ours = match (role, number) {
            (Self::Lock, None) => is_run,
            // Earlier versions had drafts of a random number alone, and of two numbers.
            (Self::Part, None) => is_run,
            (Self::Part, Some(number)) => is_number(number) && (is_run || is_number(run)),
            (Self::Set | Self::See, Some(number)) => is_number(number) && is_run,
            _ => false,
        };
        is_ours.then_some((run, role))
    }
}

const START: &str = ".burgeon-";

/// The lock of this process in a folder, released with the last of its drafts there.
#[derive(Debug)]
pub(crate) struct Lease {
    pub(crate) folder: PathBuf,
    pub(crate) run: String,
    /// The lock file; on a disk without locks, only a file.
    file: NewFile,
}

impl Lease {
    /// Returns the lock of a folder, and whether it is the first one there: then nobody has searched for the remains of
    /// others.
    pub(crate) fn acquire(folder: &Path) -> io::Result<(Arc<Self>, bool)> {
        let mut state = state();
        let held = state.leases.get(folder).and_then(Weak::upgrade);
        let lease = match held {
            Some(lease) => lease,
            None => Arc::new(Self::take(folder, &mut state)?),
        };
        state.leases.insert(folder.to_path_buf(), Arc::downgrade(&lease));
        Ok((lease, state.swept.insert(folder.to_path_buf())))
    }

    fn take(folder: &Path, state: &mut State) -> io::Result<Self> {
        let mut last = io::Error::from(io::ErrorKind::AlreadyExists);
        for _ in 0..TRIES {
            let run = format!("{:016x}", random());
            let path = folder.join(format!("{START}{run}{}", Role::Lock.extension()));
            let file = match NewFile::create(&path) {
                Ok(file) => file,
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {
                    last = e;
                    continue;
                }
                Err(e) => return Err(e),
            };
            // Another process that sweeps at this moment may take it for a remaining one.
            let lost = matches!(file.file().try_lock(), Err(TryLockError::WouldBlock));
            if lost || fs::symlink_metadata(&path).is_err() {
                continue;
            }
            state.locks.insert(path);
            return Ok(Self { folder: folder.to_path_buf(), run, file });
        }
        Err(last)
    }

    fn path(&self) -> PathBuf {
        self.folder.join(format!("{START}{}{}", self.run, Role::Lock.extension()))
    }

    /// Returns a name that is unique to this process.
    pub(crate) fn name(&self, role: Role) -> PathBuf {
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        self.folder.join(format!("{START}{}-{number}{}", self.run, role.extension()))
    }

    /// Whether a file has the same owner as those of this process.
    pub(crate) fn owns(&self, metadata: &fs::Metadata) -> bool {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt as _;
            self.file.file().metadata().is_ok_and(|own| own.uid() == metadata.uid())
        }
        #[cfg(not(unix))]
        {
            let _ = metadata;
            true
        }
    }
}

impl Drop for Lease {
    fn drop(&mut self) {
        let path = self.path();
        let mut state = state();
        // Another lease may have been taken meanwhile.
        if state.leases.get(&self.folder).is_some_and(|l| l.strong_count() == 0) {
            state.leases.remove(&self.folder);
        }
        if state.locks.remove(&path) {
            let _ = disk::remove(&path);
        }
    }
}

/// Registers a folder made for outputs: it is removed at the end of the program if it is empty.
pub(crate) fn is_made(folder: &Path) {
    state().folders.push(folder.to_path_buf());
}

/// Removes half-written files at the end of the program: nothing more can be made afterwards.
pub(crate) fn remove_all() {
    let state = state();
    remove(&state);
    std::mem::forget(state);
}

/// Calls [`remove_all`] if it need not wait: the caller may hold the lock.
pub(crate) fn abandon_all() {
    if let Ok(state) = STATE.try_lock() {
        remove(&state);
        std::mem::forget(state);
    }
}

fn remove(state: &State) {
    state.drafts.iter().chain(&state.locks).for_each(|path| drop(fs::remove_file(path)));
    state.folders.iter().rev().for_each(|folder| drop(fs::remove_dir(folder)));
}

// Keys of hash maps are random numbers of the system, which is enough here: other processes, and those in containers
// where each has the same number, use other names.
pub(crate) fn random() -> u64 {
    RandomState::new().build_hasher().finish()
}

/// State of the lock of a run.
#[derive(Debug)]
pub(crate) enum Holder {
    /// Its process is gone; the lock is ours now.
    Gone(File),
    Alive,
    /// The lock does not exist, or the disk has none.
    Unknown,
}

impl Holder {
    pub(crate) fn find(folder: &Path, run: &str) -> Self {
        let path = folder.join(format!("{START}{run}{}", Role::Lock.extension()));
        if !fs::symlink_metadata(&path).is_ok_and(|m| m.is_file()) {
            return Self::Unknown;
        }
        let Ok(file) = File::options().read(true).write(true).open(&path) else { return Self::Unknown };
        match file.try_lock() {
            Ok(()) => Self::Gone(file),
            Err(TryLockError::WouldBlock) => Self::Alive,
            Err(TryLockError::Error(_)) => Self::Unknown,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_drafts_are_ours() {
        for (name, run, role) in [
            (".burgeon-0123456789abcdef.part", "0123456789abcdef", Role::Part),
            (".burgeon-0123456789abcdef-12.part", "0123456789abcdef", Role::Part),
            (".burgeon-0123456789abcdef-3.set", "0123456789abcdef", Role::Set),
            (".burgeon-0123456789abcdef-3.see", "0123456789abcdef", Role::See),
            (".burgeon-0123456789abcdef.lock", "0123456789abcdef", Role::Lock),
            (".burgeon-17-3.part", "17", Role::Part),
        ] {
            assert_eq!(Role::from_file_name(name), Some((run, role)), "{name}");
        }
        for name in [
            ".burgeon-.part",
            ".burgeon-bee.part",
            "burgeon-1-1.part",
            ".burgeon-1-1.partly",
            ".burgeon--.part",
            ".burgeon-17-3.set",
            ".burgeon-0123456789abcdef.set",
            ".burgeon-0123456789abcdef-1.lock",
            ".burgeon-0123456789abcdef-bee.part",
        ] {
            assert_eq!(Role::from_file_name(name), None, "{name}");
        }
    }
}
