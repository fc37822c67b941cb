//! Clean-up after a process that was killed: complete sets of files are put in place, all other files are removed.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Component, Path, PathBuf};
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};

use crate::disk;
use crate::inputs::{self, FileId};
use crate::lease::{Holder, Lease, Role};

/// Age at which a file without a lock counts as left by a killed process.
const STALE: Duration = Duration::from_secs(24 * 60 * 60);
/// Longest list of files that is read, bytes: that of 100,000 files.
const MAX_LIST: u64 = 64 << 20;

/// Files of a complete set.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Set {
    pub(crate) files: Vec<Entry>,
}

/// A draft that is to have a name in its folder.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Entry {
    /// `None` where it is that of the list, which may be moved.
    pub(crate) folder: Option<OsString>,
    pub(crate) draft: OsString,
    pub(crate) place: OsString,
    /// Previous file of that name: if it is another now, somebody else has written it since, and it stays.
    pub(crate) before: Option<Stamp>,
}

/// Mark that distinguishes a file from one that was written later.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq, Eq)]
pub(crate) struct Stamp {
    bytes: u64,
    modified: Option<SystemTime>,
    /// Its number on the disk, or 0.
    number: u64,
}

impl Stamp {
    pub(crate) fn read(path: &Path) -> Option<Self> {
        let metadata = fs::symlink_metadata(path).ok()?;
        #[cfg(unix)]
        let number = std::os::unix::fs::MetadataExt::ino(&metadata);
        #[cfg(not(unix))]
        let number = 0;
        Some(Self { bytes: metadata.len(), modified: metadata.modified().ok(), number })
    }
}

impl Entry {
    /// Returns the paths of its draft and of its place; `None` if the list is not one of ours: no list can name a file
    /// elsewhere.
    fn paths(&self, list: &Path) -> Option<(PathBuf, PathBuf)> {
        let folder = match &self.folder {
            Some(folder) => PathBuf::from(folder),
            None => list.parent()?.to_path_buf(),
        };
        let draft =
            self.draft.to_str().and_then(Role::from_file_name).is_some_and(|(_, role)| role == Role::Part);
        let mut parts = Path::new(&self.place).components();
        let place = matches!((parts.next(), parts.next()), (Some(Component::Normal(name)), None) if name == self.place);
        (draft && place).then(|| (folder.join(&self.draft), folder.join(&self.place)))
    }
}

/// Finishes or removes the remains of ended processes in a folder. Errors do not matter: somebody else may sweep at the
/// same time.
pub(crate) fn sweep(own: &Lease) {
    let mut runs: BTreeMap<String, Vec<(PathBuf, Role)>> = BTreeMap::new();
    for entry in fs::read_dir(&own.folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let Some((run, role)) = name.to_str().and_then(Role::from_file_name) else { continue };
        // Properties of the entry itself, not of the target of a link.
        if run != own.run && entry.metadata().is_ok_and(|m| m.is_file() && own.owns(&m)) {
            runs.entry(run.to_owned()).or_default().push((entry.path(), role));
        }
    }
    let now = SystemTime::now();
    for (run, files) in &runs {
        match Holder::find(&own.folder, run) {
            Holder::Alive => {}
            Holder::Gone(lock) => {
                clear(own, files, |_| true);
                drop(lock);
            }
            Holder::Unknown => clear(own, files, |path| is_stale(path, now)),
        }
    }
}

fn is_stale(path: &Path, now: SystemTime) -> bool {
    let modified = fs::symlink_metadata(path).and_then(|m| m.modified());
    modified.is_ok_and(|t| now.duration_since(t).is_ok_and(|age| age > STALE))
}

/// Finishes the sets of a run and removes its other files, the lock last. If a set cannot be finished now, all files
/// stay for the next command.
fn clear(own: &Lease, files: &[(PathBuf, Role)], is_left: impl Fn(&Path) -> bool) {
    let of = |wanted: Role| files.iter().filter(move |(_, role)| *role == wanted).map(|(path, _)| path);
    if !files.iter().all(|(path, _)| is_left(path)) {
        // For a run without a lock, only the old drafts are removed: they belong to no set.
        if of(Role::Set).chain(of(Role::See)).next().is_none() {
            of(Role::Part).filter(|path| is_left(path)).for_each(|path| drop(disk::remove(path)));
        }
        return;
    }
    let lists: BTreeSet<PathBuf> =
        of(Role::Set).cloned().chain(of(Role::See).filter_map(|p| elsewhere(p))).collect();
    for list in &lists {
        if !matches!(finish(own, list), Ok(true)) {
            return;
        }
    }
    for role in [Role::See, Role::Part, Role::Lock] {
        of(role).for_each(|path| drop(disk::remove(path)));
    }
}

/// Returns the list that a file of a folder points to, if it still exists.
fn elsewhere(pointer: &Path) -> Option<PathBuf> {
    let list = PathBuf::from(serde_json::from_slice::<OsString>(&read(pointer).ok()?).ok()?);
    let name = list.file_name()?.to_str()?;
    (list.is_absolute() && Role::from_file_name(name)?.1 == Role::Set && list.is_file()).then_some(list)
}

fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::options().read(true).open(path)?.take(MAX_LIST).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Puts the rest of a set in place; returns false where that must wait, as one of its places is an input of this
/// command.
fn finish(own: &Lease, list: &Path) -> io::Result<bool> {
    let Ok(metadata) = fs::symlink_metadata(list) else { return Ok(true) };
    if !metadata.is_file() || !own.owns(&metadata) {
        return Ok(false);
    }
    let set: Set = serde_json::from_slice(&read(list)?)?;
    let all: Option<Vec<_>> = set.files.iter().map(|e| Some((e.paths(list)?, &e.before))).collect();
    let all = all.ok_or(io::ErrorKind::InvalidData)?;
    // An entry without a draft is in place already.
    let rest: Vec<_> = all
        .iter()
        .filter_map(|((draft, place), before)| {
            Some((draft, place, before, fs::symlink_metadata(draft).ok()?))
        })
        .collect();
    let may = |place: &Path, draft: &fs::Metadata| {
        draft.is_file()
            && own.owns(draft)
            && FileId::from_path(place).is_none_or(|id| inputs::read_as(&id).is_none())
    };
    if !rest.iter().all(|(_, place, _, draft)| may(place, draft)) {
        return Ok(false);
    }
    for (draft, place, before, _) in &rest {
        let now = Stamp::read(place);
        let is_free = now.is_none() || now == ***before;
        if is_free { disk::rename(draft, place)? } else { disk::remove(draft)? }
    }
    let folders: BTreeSet<&Path> = all.iter().filter_map(|((draft, _), _)| draft.parent()).collect();
    folders.into_iter().try_for_each(disk::sync_folder)?;
    disk::remove(list)?;
    Ok(true)
}
