//! The extension for Blender: the file that people install, and its tests with Blender as a module of Python.

use crate::python::{BUILD, Reach, build, environment, install, lint, optimised, pip};
use crate::toolchain::shown;
use std::path::{Path, PathBuf};
use xtask::shell::{Outcome, finish, output, prepare, repository, say, target_dir};

/// Imports of the tests: a gigabyte, and for one version of Python only, so that it is no part of `test`.
const TEST: &[&str] = &["bpy>=4.2", "numpy", "pytest"];

/// Builds the extension for users, for this system: the wheel optimised, into `target/blender`.
pub(crate) fn pack(reach: Reach) -> Outcome {
    let python = environment()?.ok_or("Python 3.9 or newer is missing: install it with its module venv")?;
    let file = packed(&python, &optimised(&python, reach)?)?;
    say(&format!(
        "{}: Blender 4.2 and newer installs it (Edit, Preferences, Get Extensions, Install from Disk)",
        shown(&file)
    ));
    Ok(())
}

/// Packs the extension with this wheel.
fn packed(python: &Path, wheel: &Path) -> Outcome<PathBuf> {
    let folder = target_dir().join("blender");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", shown(&folder)))?;
    let file = folder.join(format!("burgeon_plants-{}.zip", env!("CARGO_PKG_VERSION")));
    let mut c = prepare(python, &["apps/blender/pack.py"]);
    c.arg(wheel).arg(&file);
    finish(c)?;
    Ok(file)
}

/// Tests the extension without a window, in a virtual environment of its own.
pub(crate) fn test() -> Outcome {
    let python = environment()?.ok_or("Python is missing: install it with its module venv")?;
    install(&python, BUILD)?;
    lint(&python)?;
    let folder = target_dir().join("blender-python");
    let own = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    // Found without importing: Blender takes long to start.
    let there = "import importlib.util, sys; sys.exit(any(importlib.util.find_spec(n) is None for n in ('bpy', 'pytest')))";
    if output(prepare(&own, &["-c", there])).is_err() {
        let mut c = prepare(&python, &["-m", "venv", "--clear"]);
        c.arg(&folder);
        finish(c)?;
        say(&format!("$ pip install {}", TEST.join(" ")));
        let mut c = pip(&own, &[]);
        c.args(TEST);
        finish(c)
            .map_err(|e| format!("{e}; each version of bpy is for one of Python: 4.2 to 4.5 for 3.11"))?;
    }
    let wheel = build(&python, &["--profile", "dev", "--features", "tested"])?;
    let file = packed(&python, &wheel)?;
    let mut c = pip(&own, &["--force-reinstall", "--no-deps"]);
    c.arg(&wheel);
    finish(c)?;
    say("$ pytest (in apps/blender)");
    let tests = repository().join("apps/blender");
    let mut c = prepare(&own, &["-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir"]);
    c.arg(&tests).arg(tests.join("tests"));
    c.env("PYTHONDONTWRITEBYTECODE", "1").env("BURGEON_EXTENSION", file);
    finish(c)
}
