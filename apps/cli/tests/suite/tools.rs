//! The binary and folders to run it in.
#![expect(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// Returns a folder for one test, emptied first.
pub(crate) fn folder(test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

pub(crate) fn burgeon(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_burgeon")).args(args).current_dir(folder).output().unwrap()
}

pub(crate) fn status(out: &Output) -> i32 {
    out.status.code().unwrap()
}

/// Returns the output of a command that must succeed.
pub(crate) fn good(folder: &Path, args: &[&str]) -> String {
    let out = burgeon(folder, args);
    assert_eq!(status(&out), 0, "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).unwrap()
}

/// Returns the one line of error of a command that must fail as bad usage or bad input.
pub(crate) fn bad(folder: &Path, args: &[&str]) -> String {
    let out = burgeon(folder, args);
    let text = String::from_utf8(out.stderr.clone()).unwrap();
    assert_eq!(status(&out), 2, "{args:?}: {text}");
    assert_eq!(text.lines().count(), 1, "one line, not {text:?}");
    assert!(text.starts_with("error: "), "{text}");
    text
}

pub(crate) fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

pub(crate) fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// A stem with two leaves and a five-petalled flower, in a hand's uneven lines.
pub(crate) const FLOWER: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 300">
<path fill="none" stroke="#000" d="M100 100C98 150 104 210 101 290"/>
<path fill="none" stroke="#000" d="M101 220C120 190 150 185 165 190C155 210 130 225 101 221"/>
<path fill="none" stroke="#000" d="M101 250C80 225 55 220 40 226C50 243 75 255 100 251"/>
<path fill="none" stroke="#000" d="M100 90C85 70 88 40 100 30C113 41 116 70 101 90"/>
<path fill="none" stroke="#000" d="M100 90C112 70 138 58 152 66C150 82 122 98 101 91"/>
<path fill="none" stroke="#000" d="M100 91C122 96 136 118 132 132C118 134 103 112 100 92"/>
<path fill="none" stroke="#000" d="M99 91C96 112 80 132 66 130C64 116 78 97 98 90"/>
<path fill="none" stroke="#000" d="M98 90C76 96 50 82 48 66C62 58 88 70 99 89"/>
</svg>"##;
