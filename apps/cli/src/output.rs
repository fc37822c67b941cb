//! Outputs of a command: known before any of them is in place, compared with all inputs, written whole or not at all.

use std::fs::{self, File, Metadata};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use burgeon::formats::WriteError;

use crate::disk;
use crate::draft::Draft;
use crate::failure::{Failure, Outcome};
use crate::inputs::{self, FileId};
use crate::lease;
use crate::names::folded;
use crate::placing::{Move, Refused, put_all};
use crate::signals::Stoppable;

/// Outputs of a command, or of one drawing of many.
///
/// Everything is written to drafts and compared with inputs and other outputs; [`place`](Self::place) then renames all
/// of them. Outputs that are dropped before leave nothing behind.
#[derive(Debug, Default)]
pub(crate) struct Outputs {
    /// Every file that is known to be written, the reserved ones of the whole batch first.
    planned: Vec<Planned>,
    /// Number of these that others write.
    reserved: usize,
    ready: Vec<Ready>,
    /// Folders made for the outputs, the outermost first.
    made: Vec<PathBuf>,
}

#[derive(Clone, Debug)]
struct Planned {
    /// The option that requests it, in words.
    by: String,
    /// Path as given.
    target: PathBuf,
    place: Place,
}

/// Final place of a file, with links followed.
#[derive(Clone, Debug)]
struct Place {
    path: PathBuf,
    /// Identity of the existing file.
    file: Option<FileId>,
    folder: Option<FileId>,
    /// Its name, [`folded`]: case is ignored on every disk, so that a command behaves the same on all.
    name: String,
    /// Whether it is written directly: a renamed file in place of /dev/null would break the machine.
    device: bool,
}

impl Place {
    /// Fails early and clearly when nothing can be written there.
    fn resolve(target: &Path) -> Outcome<Self> {
        check_target(target)?;
        let there = fs::metadata(target).ok();
        let device = is_device(target, there.as_ref());
        if there.is_none() && fs::symlink_metadata(target).is_ok() {
            let what = "is a link that leads to no file; make the file that it names, or remove the link";
            return Err(Failure::bad_file(target, what));
        }
        if !device && there.as_ref().is_some_and(|m| m.permissions().readonly()) {
            return Err(Failure::bad_file(
                target,
                "is write-protected; give another name or lift the protection",
            ));
        }
        let path = fs::canonicalize(target).unwrap_or_else(|_| {
            let folder = folder_of(target);
            let folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_path_buf());
            folder.join(target.file_name().unwrap_or_default())
        });
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let file = there.filter(Metadata::is_file).and_then(|_| FileId::from_path(target));
        Ok(Self { name: folded(&name), file, folder: FileId::from_path(folder_of(&path)), path, device })
    }

    fn is(&self, other: &Self) -> bool {
        match (&self.file, &other.file) {
            _ if self.device || other.device => false,
            (Some(a), Some(b)) => a == b,
            _ => self.name == other.name && self.folder == other.folder,
        }
    }
}

/// A file that is written and not yet in place.
#[derive(Debug)]
struct Ready {
    target: PathBuf,
    place: PathBuf,
    what: Written,
}

#[derive(Debug)]
enum Written {
    File(Draft),
    /// Bytes for a device.
    Bytes(Vec<u8>),
}

impl Outputs {
    /// Plans outputs by the option that names each, before anything is computed. `inputs` are those that options name;
    /// files that these name in turn are known when they are read.
    pub(crate) fn new(named: &[(&str, Option<&PathBuf>)], inputs: &[&PathBuf]) -> Outcome<Self> {
        inputs.iter().for_each(|path| inputs::announce(path));
        let mut outputs = Self::default();
        for (by, path) in named.iter().filter_map(|&(by, path)| Some((by, path?))) {
            outputs.plan(by, path)?;
        }
        Ok(outputs)
    }

    /// Returns the outputs of one drawing of a batch, which differ from the batch's own.
    pub(crate) fn for_one(&self) -> Self {
        let (planned, reserved) = (self.planned.clone(), self.planned.len());
        Self { planned, reserved, ready: Vec::new(), made: Vec::new() }
    }

    /// Plans one more file, before anything is computed: refused if it is an input or another output, or cannot be
    /// written.
    pub(crate) fn plan(&mut self, by: &str, target: &Path) -> Outcome {
        self.add(by, target)?;
        let Some(Planned { place, .. }) = self.planned.last().filter(|p| !p.place.device) else {
            return Ok(());
        };
        // An empty draft shows whether the rights suffice, before the work rather than after it.
        Draft::create(folder_of(&place.path)).map(drop).map_err(|e| Failure::io(target, "written", &e))
    }

    fn add(&mut self, by: &str, target: &Path) -> Outcome {
        let place = Place::resolve(target)?;
        if let Some(other) = self.planned.iter().find(|p| p.place.is(&place)) {
            let what = format_args!("{} and {by} name the same file; give one another name", other.by);
            return Err(Failure::bad_file(target, what));
        }
        let planned = Planned { by: by.to_owned(), target: target.to_path_buf(), place };
        planned.is_no_input()?;
        self.planned.push(planned);
        Ok(())
    }

    /// Makes a folder for many files, with those above it. They are removed again if they stay empty.
    pub(crate) fn folder(&mut self, folder: &Path) -> Outcome {
        if folder.exists() && !folder.is_dir() {
            return Err(Failure::bad_file(folder, "is a file, but several files need a folder; name one"));
        }
        let missing = folder.ancestors().take_while(|f| !f.as_os_str().is_empty() && !f.exists());
        let missing: Vec<PathBuf> = missing.map(Path::to_path_buf).collect();
        missing.iter().rev().for_each(|folder| lease::is_made(folder));
        self.made.extend(missing.into_iter().rev());
        fs::create_dir_all(folder).map_err(|e| Failure::io(folder, "created", &e))?;
        Draft::create(folder).map(drop).map_err(|e| Failure::io(folder, "written", &e))
    }

    /// Writes a file, which is not yet in place.
    ///
    /// A link is followed: its target is replaced. A device or a pipe (`/dev/stdout`) is written directly, at the end.
    pub(crate) fn write(
        &mut self,
        by: &str,
        target: &Path,
        write: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
    ) -> Outcome {
        let own = |p: &&Planned| p.by == by && p.target == target;
        if !self.planned.iter().skip(self.reserved).any(|p| own(&p)) {
            self.add(by, target)?;
        }
        let Some(planned) = self.planned.iter().skip(self.reserved).find(own) else { return Ok(()) };
        let what = if planned.place.device {
            let mut bytes = Vec::new();
            write(&mut bytes).map_err(|e| write_failed(target, e))?;
            Written::Bytes(bytes)
        } else {
            Written::File(draft_of(&planned.place.path, target, write)?)
        };
        self.ready.push(Ready { target: target.to_path_buf(), place: planned.place.path.clone(), what });
        Ok(())
    }

    /// Checks that no file to be written was read: inputs name more files than the options do.
    pub(crate) fn check(&self) -> Outcome {
        self.planned.iter().skip(self.reserved).try_for_each(|p| {
            let place = Place::resolve(&p.target)?;
            Planned { place, ..p.clone() }.is_no_input()
        })
    }

    /// Puts everything in place, or nothing.
    pub(crate) fn place(mut self) -> Outcome {
        self.check()?;
        let (files, devices): (Vec<Ready>, Vec<Ready>) =
            std::mem::take(&mut self.ready).into_iter().partition(|r| matches!(r.what, Written::File(_)));
        // Devices first: if one refuses, no file remains.
        for Ready { target, what, .. } in &devices {
            let Written::Bytes(bytes) = what else { continue };
            let write = || File::options().write(true).open(target)?.write_all(bytes);
            write().map_err(|e| Failure::io(target, "written", &e))?;
        }
        let (mut moves, mut targets) = (Vec::with_capacity(files.len()), Vec::with_capacity(files.len()));
        for Ready { target, place, what } in files {
            let Written::File(draft) = what else { continue };
            moves.push(Move { draft, place });
            targets.push(target);
        }
        let refused = |Refused { file, error }| Failure::io(&targets[file], "written", &error);
        put_all(&moves).map_err(refused)?;
        // The folders themselves must last like the files in them.
        let outside = self.made.iter().map(|folder| folder_of(folder));
        outside.for_each(|folder| drop(disk::sync_folder(folder)));
        Ok(())
    }
}

impl Drop for Outputs {
    fn drop(&mut self) {
        // Only empty ones are removed.
        self.ready.clear();
        self.made.iter().rev().for_each(|folder| drop(fs::remove_dir(folder)));
    }
}

impl Planned {
    fn is_no_input(&self) -> Outcome {
        match self.place.file.as_ref().and_then(inputs::read_as) {
            Some(input) => {
                let (by, input) = (&self.by, input.display());
                let what = format_args!("{by} would replace the input {input}; give another name");
                Err(Failure::bad_file(&self.target, what))
            }
            None => Ok(()),
        }
    }
}

/// Writes one file.
pub(crate) fn write_one(
    by: &str,
    target: &Path,
    write: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
) -> Outcome {
    let mut outputs = Outputs::default();
    outputs.write(by, target, write)?;
    outputs.place()
}

/// Makes a complete draft of a file, with the rights of the file that it is to replace.
fn draft_of(
    place: &Path,
    target: &Path,
    write: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
) -> Outcome<Draft> {
    let failed = |e: &io::Error| Failure::io(target, "written", e);
    let (draft, file) = Draft::create(folder_of(place)).map_err(|e| failed(&e))?;
    if let (Ok(old), Ok(new)) = (fs::metadata(place), file.file().metadata())
        && old.permissions() != new.permissions()
    {
        file.file().set_permissions(old.permissions()).map_err(|e| failed(&e))?;
    }
    let mut out = BufWriter::new(Stoppable(file));
    write(&mut out).map_err(|e| write_failed(target, e))?;
    let Stoppable(file) = out.into_inner().map_err(|e| failed(e.error()))?;
    // Otherwise a crash of the machine could leave an empty file under the target's name.
    file.sync().map_err(|e| failed(&e))?;
    Ok(draft)
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn is_device(target: &Path, there: Option<&Metadata>) -> bool {
    ["/dev/stdout", "/dev/stderr", "/dev/fd", "/proc/self/fd"].iter().any(|p| target.starts_with(p))
        || there.is_some_and(|m| !m.is_file() && !m.is_dir())
}

/// Makes the failure of a write that did not succeed.
pub(crate) fn write_failed(target: &Path, error: WriteError) -> Failure {
    match error {
        WriteError::Io(e) => Failure::io(target, "written", &e),
        e @ WriteError::Model { .. } => Failure::Bug(format!("{}: {e}", target.display())),
        e => Failure::bad_file(target, e),
    }
}

/// Whether a name can be that of a file.
pub(crate) fn check_target(target: &Path) -> Outcome {
    if target.as_os_str() == "-" {
        return Err(Failure::bad_file(
            target,
            "is no name for a result; name a file (./- for one that is called -)",
        ));
    }
    if target.file_name().is_none() || target.is_dir() {
        return Err(Failure::bad_file(target, "is a folder; name a file in it"));
    }
    let folder = folder_of(target);
    if !folder.is_dir() {
        let what =
            if folder.exists() { "is a file, not a folder" } else { "does not exist; create it first" };
        return Err(Failure::bad_file(target, format_args!("the folder {} {what}", folder.display())));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If the second of two files cannot be put in place, the old bytes of the first, if any, are restored.
    #[test]
    fn a_file_that_cannot_be_put_in_place_takes_the_others_back() {
        let folder = std::env::temp_dir().join(format!("burgeon-outputs-{}", std::process::id()));
        for earlier in [Some("earlier"), None] {
            fs::create_dir_all(folder.join("made")).expect("a folder");
            let [a, b] = ["made/a", "b"].map(|n| folder.join(n));
            earlier.map(|text| fs::write(&a, text)).transpose().expect("writes");
            let mut outputs = Outputs::default();
            for path in [&a, &b] {
                outputs.write("-o", path, |out| Ok(out.write_all(b"new")?)).expect("a draft");
            }
            // Somebody removes the second draft.
            let draft = fs::read_dir(&folder)
                .expect("a folder")
                .flatten()
                .find(|e| e.path().extension() == Some("part".as_ref()));
            fs::remove_file(draft.expect("the draft").path()).expect("removed");
            let failure = outputs.place().expect_err("one is missing");
            assert!(matches!(failure, Failure::Bad(line) if line.contains("cannot be written")));
            assert_eq!(fs::read_to_string(&a).ok().as_deref(), earlier);
            assert_eq!(
                fs::read_dir(folder.join("made")).expect("a folder").count(),
                usize::from(earlier.is_some())
            );
            assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 1);
            fs::remove_dir_all(&folder).expect("removed");
        }
    }

    #[test]
    fn folders_that_stay_empty_go() {
        let folder = std::env::temp_dir().join(format!("burgeon-folders-{}", std::process::id()));
        let mut outputs = Outputs::default();
        outputs.folder(&folder.join("a/b")).expect("made");
        assert!(folder.join("a/b").is_dir());
        drop(outputs);
        assert!(!folder.exists());
    }
}
