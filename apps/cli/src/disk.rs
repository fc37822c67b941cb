//! Operations on files on their way to a place, one function each: tests can make any of them fail, or simulate a loss
//! of power.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// One change of a disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Act {
    Create,
    Write,
    Sync,
    Rename,
    Link,
    Remove,
    SyncFolder,
}

#[cfg(all(test, unix))]
use faults::before;

#[cfg(not(all(test, unix)))]
#[expect(clippy::unnecessary_wraps, reason = "in tests it fails")]
const fn before(_: Act, _: &Path, _: &Path) -> io::Result<()> {
    Ok(())
}

/// A file that is being written.
#[derive(Debug)]
pub(crate) struct NewFile {
    path: PathBuf,
    file: File,
}

impl NewFile {
    /// Creates a file under a name that nobody has.
    pub(crate) fn create(path: &Path) -> io::Result<Self> {
        before(Act::Create, path, path)?;
        let file = File::options().read(true).write(true).create_new(true).open(path)?;
        Ok(Self { path: path.to_path_buf(), file })
    }

    pub(crate) const fn file(&self) -> &File {
        &self.file
    }

    /// Waits until the disk has its bytes.
    pub(crate) fn sync(&self) -> io::Result<()> {
        before(Act::Sync, &self.path, &self.path)?;
        // Tests are interested only in failing files.
        if cfg!(test) { Ok(()) } else { self.file.sync_all() }
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        before(Act::Write, &self.path, &self.path)?;
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Gives a file another name in its folder; a file of that name is replaced.
pub(crate) fn rename(from: &Path, to: &Path) -> io::Result<()> {
    before(Act::Rename, from, to)?;
    fs::rename(from, to)
}

/// Gives a file a second name.
pub(crate) fn link(file: &Path, name: &Path) -> io::Result<()> {
    before(Act::Link, file, name)?;
    fs::hard_link(file, name)
}

pub(crate) fn remove(path: &Path) -> io::Result<()> {
    before(Act::Remove, path, path)?;
    fs::remove_file(path)
}

/// Waits until the disk has the names of a folder, so that renamed files stay renamed when the power fails. Not every
/// system and disk can do this; where one cannot, the function returns at once.
pub(crate) fn sync_folder(folder: &Path) -> io::Result<()> {
    before(Act::SyncFolder, folder, folder)?;
    #[cfg(all(unix, not(test)))]
    {
        use io::ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
        let synced = File::options().read(true).open(folder).and_then(|f| f.sync_all());
        match synced {
            Err(e) if !matches!(e.kind(), InvalidInput | PermissionDenied | Unsupported) => return Err(e),
            _ => {}
        }
    }
    Ok(())
}

/// Failing disks for tests, for the calling thread only.
#[cfg(all(test, unix))]
pub(crate) mod faults {
    use std::cell::RefCell;
    use std::collections::BTreeMap;

    use super::*;

    thread_local! {
        static DISK: RefCell<Option<Disk>> = const { RefCell::new(None) };
    }

    /// Behaviour of a call.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(crate) enum Fault {
        /// It fails, and later calls succeed.
        Fails,
        /// Nothing succeeds from it on, until [`reboot`].
        PowerLoss,
    }

    /// Undo of a change that the disk did not have yet.
    enum Undo {
        Remove(PathBuf),
        Rename { from: PathBuf, to: PathBuf, replaced: Option<PathBuf> },
        Restore { path: PathBuf, held: PathBuf },
    }

    struct Disk {
        fault: Fault,
        /// Number of the failing call.
        at: usize,
        calls: usize,
        /// A folder for files that may have to be restored.
        held: PathBuf,
        names: usize,
        /// Changes by folder, in order.
        unsynced: BTreeMap<PathBuf, Vec<Undo>>,
        /// Files whose bytes the disk does not have, with another name of each.
        unwritten: BTreeMap<PathBuf, PathBuf>,
    }

    /// Makes a later call fail, the first one being 0. `held` is a folder on the same disk.
    pub(crate) fn plan(fault: Fault, at: usize, held: &Path) {
        let disk = Disk {
            fault,
            at,
            calls: 0,
            held: held.to_path_buf(),
            names: 0,
            unsynced: BTreeMap::new(),
            unwritten: BTreeMap::new(),
        };
        DISK.set(Some(disk));
    }

    /// Ends the faults; returns whether the planned one occurred.
    pub(crate) fn end() -> bool {
        DISK.take().is_some_and(|disk| disk.calls > disk.at)
    }

    /// Starts after a loss of power: for each folder some of the last changes that were not synced are lost, as
    /// `random` chooses, and files that were not synced are empty. Returns whether the power was lost.
    pub(crate) fn reboot(mut random: impl FnMut(usize) -> usize) -> bool {
        let Some(disk) = DISK.take() else { return false };
        if disk.calls <= disk.at {
            return false;
        }
        for mut changes in disk.unsynced.into_values() {
            let kept = random(changes.len() + 1);
            for undo in changes.drain(kept..).rev() {
                undo.run().expect("a change is taken back");
            }
        }
        for held in disk.unwritten.values() {
            File::options().write(true).open(held).and_then(|f| f.set_len(0)).expect("emptied");
        }
        true
    }

    impl Undo {
        fn run(self) -> io::Result<()> {
            match self {
                Self::Remove(path) => fs::remove_file(path),
                Self::Rename { from, to, replaced } => {
                    fs::rename(&to, from)?;
                    replaced.map_or(Ok(()), |held| fs::hard_link(held, to))
                }
                Self::Restore { path, held } => fs::hard_link(held, path),
            }
        }
    }

    impl Disk {
        fn hold(&mut self, path: &Path) -> io::Result<PathBuf> {
            self.names += 1;
            let held = self.held.join(self.names.to_string());
            fs::hard_link(path, &held).map(|()| held)
        }

        fn note(&mut self, act: Act, from: &Path, to: &Path) -> io::Result<()> {
            let undo = match act {
                Act::Create | Act::Link => Undo::Remove(to.to_path_buf()),
                Act::Rename => {
                    let replaced = if to.exists() { Some(self.hold(to)?) } else { None };
                    Undo::Rename { from: from.to_path_buf(), to: to.to_path_buf(), replaced }
                }
                Act::Remove => Undo::Restore { path: from.to_path_buf(), held: self.hold(from)? },
                Act::Write => {
                    if !self.unwritten.contains_key(from) {
                        let held = self.hold(from)?;
                        self.unwritten.insert(from.to_path_buf(), held);
                    }
                    return Ok(());
                }
                Act::Sync => {
                    self.unwritten.remove(from);
                    return Ok(());
                }
                Act::SyncFolder => {
                    self.unsynced.remove(from);
                    return Ok(());
                }
            };
            let folder = to.parent().expect("a file is in a folder").to_path_buf();
            self.unsynced.entry(folder).or_default().push(undo);
            Ok(())
        }
    }

    pub(super) fn before(act: Act, from: &Path, to: &Path) -> io::Result<()> {
        DISK.with_borrow_mut(|disk| {
            let Some(disk) = disk else { return Ok(()) };
            let call = disk.calls;
            disk.calls += 1;
            if call == disk.at || (call > disk.at && disk.fault == Fault::PowerLoss) {
                return Err(io::Error::other(format!("planned: {act:?} of {}", to.display())));
            }
            disk.note(act, from, to)
        })
    }
}
