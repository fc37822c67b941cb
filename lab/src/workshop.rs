//! A folder for the files from which pictures of the docs are made, and the program that draws them.

use std::path::{Path, PathBuf};

use xtask::shell::{Outcome, built_burgeon, command, repository};

pub(crate) struct Workshop {
    burgeon: PathBuf,
    pub(crate) folder: PathBuf,
}

impl Workshop {
    /// Makes one for the duration of `work`.
    pub(crate) fn with(work: impl FnOnce(&Self) -> Outcome) -> Outcome {
        let burgeon = built_burgeon()?;
        let folder = std::env::temp_dir().join(format!("burgeon-pictures-{}", std::process::id()));
        std::fs::create_dir_all(&folder).map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
        let shop = Self { burgeon, folder };
        let made = work(&shop);
        let _ = std::fs::remove_dir_all(&shop.folder);
        made
    }

    /// Returns the path of a file of this name.
    pub(crate) fn path(&self, name: &str) -> String {
        self.folder.join(name).display().to_string()
    }

    /// Writes a file and returns its path.
    pub(crate) fn file(&self, name: &str, text: &str) -> Result<String, String> {
        let path = self.path(name);
        std::fs::write(Path::new(&path), text).map_err(|e| format!("cannot write {path}: {e}"))?;
        Ok(path)
    }

    pub(crate) fn burgeon(&self, args: &[&str]) -> Outcome {
        command(&self.burgeon, &[args, &["--quiet"]].concat())
    }
}

/// Returns the path of a picture of the docs.
pub(crate) fn picture(name: &str) -> PathBuf {
    repository().join("docs/pictures").join(name)
}
