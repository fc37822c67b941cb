//! Files that a file names: where they may lie, and how much of them is read.
//!
//! A model names its materials and buffers, a spec its obstacles, a file of stages its scans. The maker of that file
//! chose the names, and it may have come from anybody. So a name is looked for below the folder of the file that names
//! it, also after links, and only a regular file is ever opened. A user who trusts the file can allow other paths
//! ([`Trust::paths`]): then a path may lead anywhere, and the limits stay.

use std::fmt;
use std::fs::{self, File, Metadata};
use std::io::{self, Read as _};
use std::path::{Component, Path, PathBuf};

/// Most bytes that are read of a file that another one names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// A file that a model names: a buffer, a file of materials, a texture.
    pub side_file: u64,
    /// A picture that a file of materials names.
    pub picture: u64,
    /// A model or a scan that a spec or a file of stages names.
    pub model: u64,
    /// A text, such as the leaf of a spec.
    pub text: u64,
}

/// The limits of the command and of Python.
pub const LIMITS: Limits = Limits { side_file: 256 << 20, picture: 64 << 20, model: 1 << 30, text: 16 << 20 };

/// Places where the files that a file names may lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trust {
    /// Whether they may lie anywhere, also by links; otherwise below the folder of the file that names them.
    pub paths: bool,
    /// The way to trust paths, for messages: an option or an argument.
    pub allow: &'static str,
}

/// A file that another one names, and that was not read.
#[derive(Debug, thiserror::Error)]
#[error("{} names {:?}, {fault}", naming.display(), base::quoted(name))]
pub struct NamedFileError {
    /// The file that names it.
    pub naming: PathBuf,
    /// The path as written.
    pub name: String,
    /// The fault.
    pub fault: NamedFault,
}

/// Reason why a named file is not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NamedFault {
    /// It does not exist.
    #[error("which is not there; check the spelling, and copy it along")]
    Missing,
    /// It lies, or may lie, outside the folder of the file that names it. Whether it exists is not revealed.
    #[error("which is not below its folder; copy it there, or allow it with {allow}")]
    Outside {
        /// The way to allow it.
        allow: &'static str,
    },
    /// A link leads outside of the folder of the file that names it.
    #[error("a link that leads out of its folder; copy the file there, or allow it with {allow}")]
    Link {
        /// The way to allow it.
        allow: &'static str,
    },
    /// It is not a regular file.
    #[error("which is {0}, not a file; put a file there")]
    NotAFile(NotAFile),
    /// It is larger than the limit.
    #[error("which is larger than {} MiB; is it the right file?", limit >> 20)]
    TooLarge {
        /// The limit in bytes.
        limit: u64,
    },
    /// The system refuses.
    #[error("which cannot be read: {0}")]
    Io(io::Error),
}

/// Kind of an object other than a regular file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotAFile {
    /// A folder.
    Folder,
    /// A pipe: opening it waits for somebody who writes into it.
    Pipe,
    /// A socket.
    Socket,
    /// A device, which may never end.
    Device,
    /// Something else.
    Other,
}

impl fmt::Display for NotAFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Folder => "a folder",
            Self::Pipe => "a pipe",
            Self::Socket => "a socket",
            Self::Device => "a device",
            Self::Other => "something else",
        })
    }
}

impl NotAFile {
    /// Returns the kind of the object, if it is not a regular file.
    fn new(metadata: &Metadata) -> Option<Self> {
        let kind = metadata.file_type();
        if kind.is_file() {
            return None;
        }
        #[cfg(unix)]
        {
            use std::os::unix::fs::FileTypeExt as _;
            if kind.is_fifo() {
                return Some(Self::Pipe);
            }
            if kind.is_socket() {
                return Some(Self::Socket);
            }
            if kind.is_char_device() || kind.is_block_device() {
                return Some(Self::Device);
            }
        }
        Some(if kind.is_dir() { Self::Folder } else { Self::Other })
    }
}

/// A name in a file.
#[derive(Clone, Copy, Debug)]
pub struct Named<'a> {
    /// The file that names it; it need not be read.
    pub naming: &'a Path,
    /// The path as written, with separators of Windows or others.
    pub name: &'a str,
}

impl Named<'_> {
    /// Returns the path that is meant: from the folder of the file that names it. The disk is not accessed.
    pub fn path(&self) -> PathBuf {
        self.naming.parent().unwrap_or(Path::new("")).join(self.name.replace('\\', "/"))
    }

    fn folder(&self) -> &Path {
        self.naming.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
    }

    /// Returns the path without links of a regular file that may be read.
    ///
    /// Nothing is opened: no pipe is waited for and no device touched. Not guaranteed: that the same file is there
    /// later.
    ///
    /// # Errors
    /// [`NamedFileError`].
    pub fn find(&self, trust: Trust) -> Result<PathBuf, NamedFileError> {
        self.look(trust).map(|(path, _)| path).map_err(|fault| self.error(fault))
    }

    /// Opens the file and returns it with its path without links; at most `limit` bytes according to the disk.
    ///
    /// Guaranteed: the opened file is the regular file that was checked.
    ///
    /// # Errors
    /// [`NamedFileError`].
    pub fn open(&self, trust: Trust, limit: u64) -> Result<(File, PathBuf), NamedFileError> {
        self.opened(trust, limit).map_err(|fault| self.error(fault))
    }

    /// Reads `file`, which [`Self::open`] opened: at most `limit` bytes, whatever the disk reported.
    ///
    /// # Errors
    /// [`NamedFileError`].
    pub fn read(&self, file: File, limit: u64) -> Result<Vec<u8>, NamedFileError> {
        let mut bytes = Vec::new();
        let read = file.take(limit.saturating_add(1)).read_to_end(&mut bytes);
        read.map_err(|e| self.error(NamedFault::Io(e)))?;
        if bytes.len() as u64 > limit {
            return Err(self.error(NamedFault::TooLarge { limit }));
        }
        Ok(bytes)
    }

    fn error(&self, fault: NamedFault) -> NamedFileError {
        NamedFileError { naming: self.naming.to_path_buf(), name: self.name.to_owned(), fault }
    }

    fn opened(&self, trust: Trust, limit: u64) -> Result<(File, PathBuf), NamedFault> {
        let (path, seen) = self.look(trust)?;
        if seen.len() > limit {
            return Err(NamedFault::TooLarge { limit });
        }
        let file = File::open(&path).map_err(NamedFault::Io)?;
        let opened = file.metadata().map_err(NamedFault::Io)?;
        if let Some(other) = NotAFile::new(&opened) {
            return Err(NamedFault::NotAFile(other));
        }
        if !is_same(&seen, &opened) {
            return Err(NamedFault::Io(io::Error::other("it was replaced in the meantime; try again")));
        }
        Ok((file, path))
    }

    fn look(&self, trust: Trust) -> Result<(PathBuf, Metadata), NamedFault> {
        let allow = trust.allow;
        let path = self.path();
        let folder = if trust.paths { None } else { Some(fs::canonicalize(self.folder()).map_err(missing)?) };
        // Its letters are checked first: whether such a file exists elsewhere is not revealed, and a path on the
        // network is not accessed.
        if let Some(folder) = &folder
            && !self.stays_inside(folder)
        {
            return Err(NamedFault::Outside { allow });
        }
        let real = fs::canonicalize(&path).map_err(missing)?;
        if folder.is_some_and(|folder| !real.starts_with(folder)) {
            return Err(NamedFault::Link { allow });
        }
        let metadata = fs::symlink_metadata(&real).map_err(missing)?;
        match NotAFile::new(&metadata) {
            Some(other) => Err(NamedFault::NotAFile(other)),
            None => Ok((real, metadata)),
        }
    }

    /// Whether the letters of the path lead below the folder; `folder` is the same without links.
    fn stays_inside(&self, folder: &Path) -> bool {
        let name = self.name.replace('\\', "/");
        let name = Path::new(&name);
        let inner = if name.has_root() {
            let written = std::path::absolute(self.folder()).ok();
            let inner = written.and_then(|w| name.strip_prefix(w).ok().map(Path::to_path_buf));
            match inner.or_else(|| name.strip_prefix(folder).ok().map(Path::to_path_buf)) {
                Some(inner) => inner,
                None => return false,
            }
        } else {
            name.to_path_buf()
        };
        let mut depth = 0_usize;
        for part in inner.components() {
            match part {
                Component::Normal(_) => depth += 1,
                Component::CurDir => {}
                Component::ParentDir if depth > 0 => depth -= 1,
                Component::ParentDir | Component::RootDir | Component::Prefix(_) => return false,
            }
        }
        true
    }
}

/// Returns the fault of a path that leads nowhere.
fn missing(error: io::Error) -> NamedFault {
    match error.kind() {
        // No file has a name with a NUL, or one that is too long.
        io::ErrorKind::NotFound
        | io::ErrorKind::NotADirectory
        | io::ErrorKind::InvalidInput
        | io::ErrorKind::InvalidFilename => NamedFault::Missing,
        _ => NamedFault::Io(error),
    }
}

#[cfg(unix)]
fn is_same(a: &Metadata, b: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// Where the system does not number files, size and time identify one.
#[cfg(not(unix))]
fn is_same(a: &Metadata, b: &Metadata) -> bool {
    (a.len(), a.modified().ok()) == (b.len(), b.modified().ok())
}
