//! Reasons to end a command early, with their exit status.

use std::fmt;
use std::path::Path;
use std::process::ExitCode;

use crate::signals;

/// One clear line for the user: the fault, its place, the remedy.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Bad usage or bad input: exit status 2.
    Bad(String),
    /// The outcome was reported already (a batch with failing drawings): exit status 2, no further message.
    Reported,
    /// The user pressed Ctrl-C, or the program was asked to end: exit status 130.
    Cancelled,
    /// Our own bug: exit status 1.
    Bug(String),
}

pub(crate) type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    /// Makes a failure of bad input in a file.
    pub(crate) fn bad_file(path: &Path, what: impl fmt::Display) -> Self {
        Self::Bad(format!("{}: {}", shown(path), burgeon::brief(&what.to_string())))
    }

    /// Returns the same failure for bad input, with the file that it came from.
    pub(crate) fn in_file(self, path: &Path) -> Self {
        if let Self::Bad(line) = self { Self::bad_file(path, line) } else { self }
    }

    /// Returns the fault of scans, laws or flowers of a file.
    pub(crate) fn bloom(path: &Path) -> impl Fn(burgeon::bloom::BloomError) -> Self + '_ {
        move |e| match e {
            burgeon::bloom::BloomError::Cancelled => Self::Cancelled,
            e => Self::bad_file(path, e),
        }
    }

    /// Makes the failure of a refusal by the operating system.
    pub(crate) fn io(path: &Path, doing: &str, error: &std::io::Error) -> Self {
        let reason = match error.kind() {
            std::io::ErrorKind::NotFound => "there is no such file or folder; check the spelling".to_owned(),
            std::io::ErrorKind::PermissionDenied => {
                "permission denied; choose another place or change its rights".to_owned()
            }
            std::io::ErrorKind::ReadOnlyFilesystem => {
                "the disk is read-only; choose another place".to_owned()
            }
            std::io::ErrorKind::IsADirectory => "it is a folder; name a file in it".to_owned(),
            std::io::ErrorKind::StorageFull | std::io::ErrorKind::QuotaExceeded => {
                "the disk is full; make room or choose another place".to_owned()
            }
            std::io::ErrorKind::FileTooLarge => {
                "it is larger than the disk or a limit of this account allows; choose another place"
                    .to_owned()
            }
            std::io::ErrorKind::InvalidFilename => "the name is too long; choose a shorter one".to_owned(),
            _ => error.to_string(),
        };
        Self::Bad(format!("{}: cannot be {doing}: {reason}", shown(path)))
    }

    /// Reports it on stderr, in one line.
    pub(crate) fn tell(&self) -> ExitCode {
        match self {
            Self::Bad(line) => {
                crate::say::error(&burgeon::brief(&crate::say::short(line)));
                ExitCode::from(2)
            }
            Self::Reported => ExitCode::from(2),
            Self::Cancelled => {
                signals::tell();
                ExitCode::from(signals::STATUS)
            }
            Self::Bug(line) => {
                crate::say::error(&format!("internal error, a bug in burgeon: {line}"));
                ExitCode::from(1)
            }
        }
    }
}

/// Formats a path for messages.
fn shown(path: &Path) -> impl fmt::Display {
    if crate::inputs::is_stdin(path) { Path::new("standard input") } else { path }.display()
}

impl From<companions::NamedFileError> for Failure {
    fn from(e: companions::NamedFileError) -> Self {
        Self::Bad(line_of(&e))
    }
}

/// Describes the fault of a file that another one names.
pub(crate) fn line_of(e: &companions::NamedFileError) -> String {
    format!("{}: names {:?}, {}", shown(&e.naming), burgeon::quoted(&e.name), e.fault)
}

impl From<burgeon::Stopped> for Failure {
    fn from(stopped: burgeon::Stopped) -> Self {
        match stopped {
            burgeon::Stopped::Cancelled(_) => Self::Cancelled,
            burgeon::Stopped::OverBudget(much) => Self::Bad(much.to_string()),
        }
    }
}

impl From<burgeon::Cancelled> for Failure {
    fn from(_: burgeon::Cancelled) -> Self {
        Self::Cancelled
    }
}
