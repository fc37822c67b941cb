//! The key of a link on this machine: whoever has it gets the opened file, and no other user of the machine.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::gate::{Random, is_same, secret};

/// A key that is valid as long as the server runs; a browser that comes with it keeps it as a cookie.
#[derive(Debug)]
pub(crate) struct LocalKey {
    key: String,
    opener: Mutex<Option<Opener>>,
}

impl LocalKey {
    pub(crate) fn new(random: Random) -> Self {
        Self { key: secret(random), opener: Mutex::default() }
    }

    /// Returns the key itself, for the link and the cookie.
    pub(crate) fn key(&self) -> &str {
        &self.key
    }

    pub(crate) fn is_key(&self, given: &str) -> bool {
        is_same(&self.key, given)
    }

    /// Makes a page that leads a browser to the link, until the first one comes.
    pub(crate) fn lead_to(&self, link: &str) -> io::Result<PathBuf> {
        let opener = Opener::new(&std::env::temp_dir(), &self.key, link)?;
        let path = opener.0.clone();
        *self.opener.lock().unwrap_or_else(PoisonError::into_inner) = Some(opener);
        Ok(path)
    }

    /// Removes the page after a browser has come by it.
    pub(crate) fn arrived(&self) {
        self.opener.lock().unwrap_or_else(PoisonError::into_inner).take();
    }
}

/// A page that leads to a link and that only its owner may read. Every user of a machine sees a program's arguments, so
/// a browser is given the name of this file instead of the link.
#[derive(Debug)]
struct Opener(PathBuf);

impl Opener {
    fn new(folder: &Path, key: &str, link: &str) -> io::Result<Self> {
        // Not the key: everybody sees the name. The key cannot be found from its hash.
        let name: String = {
            use sha2::{Digest as _, Sha256};
            Sha256::digest(key).iter().take(8).map(|b| format!("{b:02x}")).collect()
        };
        let path = folder.join(format!("burgeon-studio-{name}.html"));
        let mut options = File::options();
        options.write(true).create_new(true);
        #[cfg(unix)]
        {
            use std::os::unix::fs::OpenOptionsExt as _;
            options.mode(0o600);
        }
        let mut file = options.open(&path)?;
        let opener = Self(path);
        // Of the characters of a link, only `&` needs an escape in HTML.
        let link = link.replace('&', "&amp;");
        writeln!(
            file,
            "<!doctype html><meta charset=utf-8><meta name=referrer content=no-referrer>\
             <meta http-equiv=refresh content=\"0;url={link}\"><title>Burgeon Studio</title><a href=\"{link}\">Burgeon Studio</a>"
        )?;
        Ok(opener)
    }
}

impl Drop for Opener {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_that_leads_to_a_link_is_for_its_owner_and_goes_when_a_browser_came() {
        let local = LocalKey::new(super::super::lan::RANDOM);
        assert!(local.key().len() == 32 && local.is_key(local.key()) && !local.is_key(""));
        let link = format!("http://127.0.0.1:7734/?open=opened%2Fa.svg&key={}", local.key());
        let path = local.lead_to(&link).unwrap();
        assert!(!path.to_string_lossy().contains(local.key()), "its name is no secret");
        let page = fs::read_to_string(&path).unwrap();
        assert!(page.contains(&format!("url={}", link.replace('&', "&amp;"))), "{page}");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
        }
        local.arrived();
        assert!(!path.exists());
    }
}
