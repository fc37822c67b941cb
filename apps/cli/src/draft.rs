//! Files that are being written: hidden, next to their target, under a name that nobody else has.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::disk::{self, NewFile};
use crate::lease::{Lease, Role, TRIES, state};
use crate::sweep::sweep;

/// A temporary file in the folder of its target; removed unless it is put in place.
#[derive(Debug)]
pub(crate) struct Draft {
    path: PathBuf,
    lease: Arc<Lease>,
}

impl Draft {
    /// Creates an empty file in a folder, where the remains of others are first finished or removed.
    pub(crate) fn create(folder: &Path) -> io::Result<(Self, NewFile)> {
        let (lease, is_first) = Lease::acquire(folder)?;
        if is_first {
            sweep(&lease);
        }
        Self::fresh(&lease, NewFile::create)
    }

    /// Gives a file that this draft is to replace a second name, by which it can be restored. Not on every file system,
    /// and only for files of the same owner: in a folder such as /tmp another's name could not be removed again.
    pub(crate) fn keeping(&self, file: &Path) -> io::Result<Self> {
        if !self.lease.owns(&fs::symlink_metadata(file)?) {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        Self::fresh(&self.lease, |path| disk::link(file, path)).map(|(draft, ())| draft)
    }

    // A name that is taken belongs to another: it is left alone and the next one is tried.
    fn fresh<T>(lease: &Arc<Lease>, make: impl Fn(&Path) -> io::Result<T>) -> io::Result<(Self, T)> {
        let mut last = io::Error::from(io::ErrorKind::AlreadyExists);
        for _ in 0..TRIES {
            let path = lease.name(Role::Part);
            // Under the lock: a new file is registered, so that it is removed when the program ends.
            let mut state = state();
            match make(&path) {
                Ok(made) => {
                    state.drafts.insert(path.clone());
                    return Ok((Self { path, lease: Arc::clone(lease) }, made));
                }
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => last = e,
                Err(e) => return Err(e),
            }
        }
        Err(last)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    pub(crate) const fn lease(&self) -> &Arc<Lease> {
        &self.lease
    }

    /// Gives the file its name; a file of that name is replaced.
    pub(crate) fn put(&self, place: &Path) -> io::Result<()> {
        disk::rename(&self.path, place)?;
        state().drafts.remove(&self.path);
        Ok(())
    }

    /// Undoes [`put`](Self::put).
    pub(crate) fn take_back(&self, place: &Path) -> io::Result<()> {
        disk::rename(place, &self.path)?;
        state().drafts.insert(self.path.clone());
        Ok(())
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if state().drafts.remove(&self.path) {
            let _ = disk::remove(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lease::{Holder, random};

    #[test]
    fn a_name_that_is_taken_is_left_alone() {
        let folder = std::env::temp_dir().join(format!("burgeon-draft-{:x}", random()));
        fs::create_dir(&folder).expect("a folder");
        let (lease, _) = Lease::acquire(&folder).expect("a lock");
        let mut tries = std::cell::Cell::new(0);
        let taken = folder.join("taken");
        fs::write(&taken, "another's").expect("writes");
        let made = Draft::fresh(&lease, |path| {
            tries.set(tries.get() + 1);
            NewFile::create(if tries.get() < 4 { &taken } else { path })
        });
        drop(made.expect("the fourth name is free"));
        assert_eq!(*tries.get_mut(), 4);
        let failed = Draft::fresh(&lease, |_| NewFile::create(&taken));
        assert_eq!(failed.err().map(|e| e.kind()), Some(io::ErrorKind::AlreadyExists));
        assert_eq!(fs::read_to_string(&taken).expect("still there"), "another's");
        drop(lease);
        assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 1);
        fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn a_lock_is_held_as_long_as_there_are_drafts() {
        let folder = std::env::temp_dir().join(format!("burgeon-lease-{:x}", random()));
        fs::create_dir(&folder).expect("a folder");
        let (draft, _) = Draft::create(&folder).expect("a draft");
        let (other, _) = Draft::create(&folder).expect("a draft");
        let run = draft.lease().run.clone();
        assert_eq!(run, other.lease().run);
        drop(draft);
        assert!(matches!(Holder::find(&folder, &run), Holder::Alive));
        drop(other);
        assert!(matches!(Holder::find(&folder, &run), Holder::Unknown));
        assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 0);
        fs::remove_dir(&folder).expect("removed");
    }
}
