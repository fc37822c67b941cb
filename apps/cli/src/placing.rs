//! Naming of complete drafts, all of them or none.
//!
//! Several are first listed in a file (a *set*). From then on the set counts as written: a process that writes into one
//! of its folders after this one was killed, or the power failed, finishes it ([`crate::sweep`]).

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{PoisonError, RwLock, TryLockError};
use std::time::{Duration, Instant};

use crate::disk;
use crate::draft::Draft;
use crate::lease::{self, Role};
use crate::sweep::{Entry, Set, Stamp};

/// Held while names are given: for reading by those who give them, for writing by the thread that ends the program.
static PLACING: RwLock<()> = RwLock::new(());
/// Longest time that the end of the program waits for names that are being given.
const PATIENCE: Duration = Duration::from_millis(300);
/// Interval between two checks.
const GLANCE: Duration = Duration::from_millis(2);

/// A complete draft and the path that it is to have.
#[derive(Debug)]
pub(crate) struct Move {
    pub(crate) draft: Draft,
    pub(crate) place: PathBuf,
}

/// Previous file in the place of a renamed one.
#[derive(Debug)]
enum Before {
    Nothing,
    Kept(Draft),
    /// On a disk without hard links, or of another owner.
    Lost,
}

/// Reason why files are not in place.
#[derive(Debug)]
pub(crate) struct Refused {
    /// The number of the file at which it was found.
    pub(crate) file: usize,
    pub(crate) error: io::Error,
}

/// Gives all drafts their names, on the disk when it returns, or restores everything.
pub(crate) fn put_all(moves: &[Move]) -> Result<(), Refused> {
    let _placing = PLACING.read().unwrap_or_else(PoisonError::into_inner);
    let before: Vec<Before> = moves.iter().map(Before::keep).collect();
    let folders: BTreeSet<&Path> = moves.iter().filter_map(|m| m.place.parent()).collect();
    let sync = || folders.iter().try_for_each(|f| disk::sync_folder(f));
    let last = |error| Refused { file: moves.len().saturating_sub(1), error };
    let list = match moves {
        [_, _, ..] => {
            // A list on the disk may name only drafts that are on the disk, too.
            sync().map_err(last)?;
            Some(List::write(moves).map_err(last)?)
        }
        _ => None,
    };
    let mut placed = 0;
    let outcome = put_each(moves, &mut placed).and_then(|()| sync().map_err(last));
    if outcome.is_err() {
        moves[..placed].iter().zip(before).rev().for_each(|(m, before)| before.restore(m));
    }
    if let Some(list) = list {
        list.end();
    }
    outcome
}

fn put_each(moves: &[Move], placed: &mut usize) -> Result<(), Refused> {
    for (file, m) in moves.iter().enumerate() {
        m.draft.put(&m.place).map_err(|error| Refused { file, error })?;
        *placed = file + 1;
    }
    Ok(())
}

impl Before {
    fn keep(m: &Move) -> Self {
        match fs::symlink_metadata(&m.place) {
            Ok(_) => m.draft.keeping(&m.place).map_or(Self::Lost, Self::Kept),
            Err(_) => Self::Nothing,
        }
    }

    /// Restores the previous file. The new file is a draft again, until the list that names it is gone.
    fn restore(self, m: &Move) {
        // Only the original error is reported.
        match self {
            Self::Nothing => drop(m.draft.take_back(&m.place)),
            Self::Kept(kept) => drop(m.draft.take_back(&m.place).and_then(|()| kept.put(&m.place))),
            Self::Lost => {}
        }
    }
}

/// List of a set on the disk.
struct List {
    path: PathBuf,
    /// Files in the other folders of the set that point to the list.
    pointers: Vec<PathBuf>,
}

impl List {
    fn write(moves: &[Move]) -> io::Result<Self> {
        let home = moves[0].draft.lease();
        let mut list = Self { path: home.name(Role::Set), pointers: Vec::new() };
        let absolute = fs::canonicalize(&home.folder)?;
        match list.written(moves, &absolute) {
            Ok(()) => Ok(list),
            Err(e) => {
                list.end();
                Err(e)
            }
        }
    }

    fn written(&mut self, moves: &[Move], absolute: &Path) -> io::Result<()> {
        let mut told = BTreeSet::from([&moves[0].draft.lease().folder]);
        let name = self.path.file_name().unwrap_or_default();
        for m in moves {
            let lease = m.draft.lease();
            if told.insert(&lease.folder) {
                let pointer = lease.name(Role::See);
                self.pointers.push(pointer.clone());
                write(&lease.folder, &pointer, &absolute.join(name).into_os_string())?;
            }
        }
        let files = moves.iter().map(|m| m.entry(&moves[0])).collect::<io::Result<_>>()?;
        write(&moves[0].draft.lease().folder, &self.path, &Set { files })
    }

    /// Removes it. If it remains nevertheless, the next command finds it finished.
    fn end(self) {
        std::iter::once(&self.path).chain(&self.pointers).for_each(|path| drop(disk::remove(path)));
    }
}

impl Move {
    fn entry(&self, first: &Self) -> io::Result<Entry> {
        let folder = &self.draft.lease().folder;
        let folder = match *folder == first.draft.lease().folder {
            true => None,
            false => Some(fs::canonicalize(folder)?.into_os_string()),
        };
        let name = |path: &Path| path.file_name().unwrap_or_default().to_os_string();
        let (draft, place) = (name(self.draft.path()), name(&self.place));
        Ok(Entry { folder, draft, place, before: Stamp::read(&self.place) })
    }
}

/// Writes a small file, which is whole on the disk as soon as it has its name.
fn write(folder: &Path, path: &Path, content: &impl serde::Serialize) -> io::Result<()> {
    let (draft, mut file) = Draft::create(folder)?;
    file.write_all(&serde_json::to_vec(content)?)?;
    file.sync()?;
    drop(file);
    draft.put(path)?;
    disk::sync_folder(folder)
}

/// Removes half-written files at the end of the program; waits for a set that is being put in place. If that takes too
/// long, the next command finishes it.
pub(crate) fn leave_nothing() {
    let end = Instant::now() + PATIENCE;
    loop {
        match PLACING.try_write() {
            Ok(guard) => {
                std::mem::forget(guard);
                return lease::remove_all();
            }
            Err(TryLockError::Poisoned(_)) => return lease::remove_all(),
            Err(TryLockError::WouldBlock) if Instant::now() < end => std::thread::sleep(GLANCE),
            Err(TryLockError::WouldBlock) => return,
        }
    }
}

/// Calls [`leave_nothing`] if it need not wait: the caller may hold the lock.
pub(crate) fn abandon() {
    if let Ok(guard) = PLACING.try_write() {
        std::mem::forget(guard);
        lease::abandon_all();
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::fs;
    use std::path::PathBuf;
    use std::time::{Duration, SystemTime};

    use crate::disk::faults::{self, Fault};
    use crate::lease::{Lease, Role};
    use crate::output::Outputs;
    use crate::sweep;

    /// Files of a set in two folders, an existing one and a new one in each.
    const NAMES: [&str; 4] = ["here/a.glb", "here/b.png", "there/c.json", "there/d.csv"];
    /// Whether each file of the set exists before.
    const OLD: [bool; 4] = [true, false, false, true];

    struct Place(PathBuf);

    impl Place {
        fn new(test: &str) -> Self {
            let folder = std::env::temp_dir().join(format!("burgeon-{test}-{}", std::process::id()));
            let _ = fs::remove_dir_all(&folder);
            for name in ["here", "there", "held"] {
                fs::create_dir_all(folder.join(name)).expect("a folder");
            }
            Self(fs::canonicalize(folder).expect("it is there"))
        }

        /// Restores the state before the set is written.
        fn reset(&self) {
            for name in ["here", "there", "held"] {
                for entry in fs::read_dir(self.0.join(name)).expect("a folder").flatten() {
                    fs::remove_file(entry.path()).expect("removed");
                }
            }
            for (name, _) in NAMES.iter().zip(OLD).filter(|(_, old)| *old) {
                fs::write(self.0.join(name), "old").expect("written");
            }
        }

        /// Writes `names` as a command does.
        fn write(&self, names: &[&str]) -> bool {
            let mut outputs = Outputs::default();
            let written = names.iter().try_for_each(|name| {
                outputs.write("-o", &self.0.join(name), |out| Ok(out.write_all(b"new")?))
            });
            written.and_then(|()| outputs.place()).is_ok()
        }

        /// Sweeps these folders as the next command that writes into them does.
        fn sweep(&self, folders: &[&str]) {
            for folder in folders {
                let (lease, _) = Lease::acquire(&self.0.join(folder)).expect("a lock");
                sweep::sweep(&lease);
            }
        }

        /// Ages files that no lock protects beyond the limit.
        fn grow_old(&self) {
            let then = SystemTime::now() - Duration::from_secs(48 * 60 * 60);
            for path in self.left() {
                let file = fs::File::options().write(true).open(path).expect("it is there");
                file.set_modified(then).expect("set");
            }
        }

        /// Returns hidden files.
        fn left(&self) -> Vec<PathBuf> {
            let folders =
                ["here", "there"].map(|f| fs::read_dir(self.0.join(f)).expect("a folder").flatten());
            let all = folders.into_iter().flatten();
            all.filter(|e| e.file_name().to_str().is_some_and(|n| Role::from_file_name(n).is_some()))
                .map(|e| e.path())
                .collect()
        }

        /// Whether all files are new; otherwise asserts that none is.
        fn is_new(&self, names: &[&str], at: &str) -> bool {
            let is = |name: &&str| fs::read_to_string(self.0.join(name)).ok();
            let now: Vec<Option<String>> = names.iter().map(is).collect();
            if now.iter().all(|text| text.as_deref() == Some("new")) {
                return true;
            }
            let old = NAMES.iter().zip(OLD).filter(|(name, _)| names.contains(name));
            let old: Vec<Option<String>> = old.map(|(_, old)| old.then(|| "old".to_owned())).collect();
            assert_eq!(now, old, "{at}");
            false
        }
    }

    impl Drop for Place {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    /// Tries every call of a set, calling `test` with each, and returns whether it did.
    fn each_call(fault: Fault, place: &Place, names: &[&str], mut test: impl FnMut(usize, bool) -> bool) {
        for call in 0.. {
            assert!(call < 500, "no end");
            place.reset();
            faults::plan(fault, call, &place.0.join("held"));
            let succeeded = place.write(names);
            if !test(call, succeeded) {
                assert!(call > 4 * names.len() && succeeded, "{call} calls");
                return;
            }
        }
    }

    #[test]
    fn a_call_that_fails_leaves_all_or_nothing() {
        let place = Place::new("fails");
        for names in [&NAMES[..1], &NAMES[..2], &NAMES[..]] {
            let mut failed = 0;
            each_call(Fault::Fails, &place, names, |call, succeeded| {
                let came = faults::end();
                let at = format!("{} files, call {call}", names.len());
                assert_eq!(place.is_new(names, &at), succeeded, "{at}");
                place.sweep(&["here", "there"]);
                place.grow_old();
                place.sweep(&["here", "there"]);
                assert_eq!(place.is_new(names, &at), succeeded, "{at}, swept");
                assert_eq!(place.left(), Vec::<PathBuf>::new(), "{at}");
                failed += usize::from(!succeeded);
                came
            });
            assert!(failed > 4 * names.len(), "{failed} failed");
        }
    }

    #[test]
    fn lost_power_leaves_all_or_nothing_after_the_next_command() {
        let place = Place::new("power");
        let mut state = 7_u64;
        let mut random = move |most: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as usize % most
        };
        for names in [&NAMES[..1], &NAMES[..2], &NAMES[..]] {
            // In whichever order the folders are written into.
            for next in [["here", "there"], ["there", "here"]] {
                for _ in 0..6 {
                    let (mut new, mut old) = (0, 0);
                    each_call(Fault::PowerLoss, &place, names, |call, succeeded| {
                        let came = faults::reboot(&mut random);
                        let at = format!("{} files, call {call}, {next:?}", names.len());
                        place.sweep(&next);
                        let is_new = place.is_new(names, &at);
                        assert!(is_new || !succeeded, "{at}: it was said to be written");
                        place.grow_old();
                        place.sweep(&next);
                        assert_eq!(place.is_new(names, &at), is_new, "{at}");
                        assert_eq!(place.left(), Vec::<PathBuf>::new(), "{at}");
                        *(if is_new { &mut new } else { &mut old }) += 1;
                        came
                    });
                    assert!(new > 1 && old > names.len(), "{new} new, {old} old");
                }
            }
        }
    }

    #[test]
    fn a_set_that_is_finished_later_spares_what_others_wrote_since() {
        let place = Place::new("since");
        let names = &NAMES[..2];
        // The last calls are those after the list is written: two names, a folder, the list.
        let mut found = false;
        for call in 0..60 {
            place.reset();
            faults::plan(Fault::PowerLoss, call, &place.0.join("held"));
            place.write(names);
            faults::reboot(|most| most - 1);
            let lists = place.left().iter().filter(|p| p.extension() == Some("set".as_ref())).count();
            if lists == 0 || place.0.join(NAMES[1]).exists() {
                continue;
            }
            found = true;
            fs::write(place.0.join(NAMES[1]), "another's").expect("written");
            place.sweep(&["here"]);
            let text = |k: usize| fs::read_to_string(place.0.join(NAMES[k])).expect("there");
            assert_eq!([text(0), text(1)], ["new", "another's"]);
            assert_eq!(place.left(), Vec::<PathBuf>::new());
        }
        assert!(found, "no set was left unfinished");
    }

    #[test]
    fn a_list_names_no_file_elsewhere() {
        let place = Place::new("elsewhere");
        place.reset();
        let run = ".burgeon-0123456789abcdef";
        let here = place.0.join("here");
        for (draft, name) in
            [(format!("{run}-1.part"), "../there/x"), ("a.glb".into(), "x"), (format!("{run}-1.part"), "..")]
        {
            fs::write(here.join(format!("{run}-1.part")), "evil").expect("written");
            fs::write(here.join(format!("{run}.lock")), "").expect("written");
            let unix = |text: &str| serde_json::json!({ "Unix": text.as_bytes() });
            let file = serde_json::json!({"folder": null, "draft": unix(&draft), "place": unix(name), "before": null});
            fs::write(here.join(format!("{run}-2.set")), serde_json::json!({ "files": [file] }).to_string())
                .expect("written");
            place.sweep(&["here"]);
            assert!(!place.0.join("there/x").exists() && !here.join("x").exists(), "{draft} {name}");
            assert!(here.join("a.glb").exists());
        }
    }
}
