//! The Python package: a virtual environment under `target`, the wheel, its tests.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::toolchain::{apt_install, is_root_on_debian, shown};
use xtask::shell::{
    Outcome, burgeon, command, debug_burgeon, finish, output, prepare, repository, say, target_dir,
};

/// Packages that build the wheel, and lint the Python code.
pub(crate) const BUILD: &[&str] = &["maturin>=1.8,<2", "ruff>=0.14,<1"];
/// Linker that knows the C libraries of old systems, by which a wheel for all of them is built.
const LINKER: &[&str] = &["ziglang>=0.13"];
/// Options of maturin for a wheel of every Linux with glibc 2.28 (2018) or a newer one.
const MANYLINUX: &[&str] = &["--zig", "--compatibility", "manylinux_2_28"];
/// Imports of the tests.
const TEST: &[&str] = &[
    "numpy",
    "pytest",
    "hypothesis",
    "trimesh",
    "pillow",
    "psutil",
    "matplotlib",
    "nbclient",
    "ipykernel",
    "laspy[lazrs]",
    "mlcroissant",
    "pycocotools",
    "mypy",
];
/// Imports of a separate step: large, and not available for every Python.
const RAY: &[&str] = &["ray>=2"];

/// Imports of a separate step: programs that read what is written for simulators; not available for every system.
const SIMULATORS: &[&str] = &["mujoco>=3", "usd-core>=25", "numpy"];

/// Whom a wheel is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reach {
    /// Systems like this one.
    Own,
    /// Every Linux with glibc 2.28 or a newer one.
    Manylinux,
}

impl Reach {
    /// Reads the options of a chore that builds a wheel.
    pub(crate) fn parse(args: &[String]) -> Outcome<Self> {
        match args {
            [] => Ok(Self::Own),
            [option] if option == "--manylinux" && cfg!(target_os = "linux") => Ok(Self::Manylinux),
            _ => Err("it takes --manylinux, on Linux, or nothing".into()),
        }
    }
}

/// Builds the wheel for users: optimised, into `target/wheels`.
pub(crate) fn wheel(reach: Reach) -> Outcome {
    let python = environment()?.ok_or("Python 3.9 or newer is missing: install it with its module venv")?;
    let wheel = optimised(&python, reach)?;
    say(&format!("{}: `pip install` takes it; it serves every Python from 3.9 on", shown(&wheel)));
    Ok(())
}

/// Returns the optimised wheel.
pub(crate) fn optimised(python: &Path, reach: Reach) -> Outcome<PathBuf> {
    match reach {
        Reach::Own => {
            install(python, BUILD)?;
            build(python, &["--release"])
        }
        Reach::Manylinux => {
            install(python, &[BUILD, LINKER].concat())?;
            build(python, &[&["--release"], MANYLINUX].concat())
        }
    }
}

/// Builds the wheel with the same settings as the tests of the workspace, and runs its tests. `tested`: whether these
/// have just run.
pub(crate) fn test(tested: bool) -> Outcome {
    let Some(python) = environment()? else {
        say(
            "skipped: the Python package, as there is no Python 3.9 or newer with its module venv; install python3 and \
             python3-venv",
        );
        return Ok(());
    };
    debug_burgeon(tested)?;
    let started = Instant::now();
    install(&python, &[BUILD, TEST].concat())?;
    lint(&python)?;
    let wheel = build(&python, &["--profile", "dev", "--features", "tested"])?;
    say(&format!("$ pip install {}", shown(&wheel)));
    let mut c = pip(&python, &["--force-reinstall", "--no-deps"]);
    c.arg(&wheel);
    finish(c)?;
    pytest(&python, "not ray and not simulators")?;
    say(&format!("Python: {} s", started.elapsed().as_secs()));
    let started = Instant::now();
    match install(&python, SIMULATORS) {
        Ok(()) => {
            pytest(&python, "simulators")?;
            say(&format!("Python with MuJoCo and USD: {} s", started.elapsed().as_secs()));
        }
        Err(e) => say(&format!("skipped: MuJoCo and USD cannot be had here ({e})")),
    }
    // Large, and not for every system: a separate step.
    let started = Instant::now();
    if let Err(e) = install(&python, RAY) {
        say(&format!("skipped: Ray cannot be had here ({e})"));
        return Ok(());
    }
    pytest(&python, "ray")?;
    say(&format!("Python with Ray: {} s", started.elapsed().as_secs()));
    Ok(())
}

/// Lints the Python code (`apps/ruff.toml`), and checks its format.
pub(crate) fn lint(python: &Path) -> Outcome {
    for how in [&["check", "--quiet"][..], &["format", "--check", "--quiet"]] {
        say(&format!("$ ruff {} (in apps)", how.join(" ")));
        let mut c = prepare(python, &["-m", "ruff"]);
        c.args(how).args(["python", "blender"]).current_dir(repository().join("apps"));
        finish(c)?;
    }
    Ok(())
}

fn package() -> PathBuf {
    repository().join("apps/python")
}

/// Returns the Python of a virtual environment of our own, made if it does not exist; `None` without a Python for it.
pub(crate) fn environment() -> Outcome<Option<PathBuf>> {
    let folder = target_dir().join("python");
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    if output(prepare(&python, &["-c", "import pip"])).is_ok() {
        return Ok(Some(python));
    }
    let found = || ["python3", "python"].into_iter().find(|p| output(prepare(p, &["-c", USABLE])).is_ok());
    let mut maker = found();
    if maker.is_none() && is_root_on_debian() {
        command("apt-get", &["update", "-qq"])?;
        apt_install(&["python3", "python3-venv"])?;
        maker = found();
    }
    let Some(maker) = maker else { return Ok(None) };
    say(&format!("$ {maker} -m venv {}", shown(&folder)));
    let mut c = prepare(maker, &["-m", "venv", "--clear"]);
    c.arg(&folder);
    finish(c)?;
    Ok(Some(python))
}

/// Program that succeeds in a usable Python.
const USABLE: &str = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 9))";

/// Installs packages, unless they were installed before.
pub(crate) fn install(python: &Path, packages: &[&str]) -> Outcome {
    let stamp = target_dir().join("python").join(format!("installed-{}", packages.len()));
    let wanted = packages.join("\n");
    if std::fs::read_to_string(&stamp).is_ok_and(|there| there == wanted) {
        return Ok(());
    }
    say(&format!("$ pip install {}", packages.join(" ")));
    let mut c = pip(python, &[]);
    c.args(packages);
    finish(c)?;
    std::fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", shown(&stamp)))
}

pub(crate) fn pip(python: &Path, extra: &[&str]) -> std::process::Command {
    let mut c = prepare(python, &["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
    c.args(extra);
    c
}

/// Puts the licences of the package and the notices of what it contains into it.
fn licences() -> Outcome {
    let folder = package().join("burgeon/licences");
    let fault = |e: std::io::Error| format!("{}: {e}", shown(&folder));
    std::fs::create_dir_all(&folder).map_err(fault)?;
    for name in ["LICENSE-APACHE", "LICENSE-MIT"] {
        std::fs::copy(repository().join(name), folder.join(name)).map_err(fault)?;
    }
    crate::notices::write("burgeon-python", true, &folder.join(crate::notices::NOTICES))
}

/// Returns the wheel that maturin builds with these options.
pub(crate) fn build(python: &Path, options: &[&str]) -> Outcome<PathBuf> {
    crate::studio::alone(&package().join("burgeon/_alone.js.gz"))?;
    licences()?;
    let out = target_dir().join("wheels");
    let _ = std::fs::remove_dir_all(&out);
    say(&format!("$ maturin build {} (in apps/python)", options.join(" ")));
    let mut c = prepare(python, &["-m", "maturin", "build", "--quiet", "--locked"]);
    c.args(options).arg("--out").arg(&out).current_dir(package());
    // Maturin looks for the environment from which it is called.
    if let Some(folder) = python.parent().and_then(Path::parent) {
        c.env("VIRTUAL_ENV", folder);
    }
    // It asks the first Python of the path for the linker.
    if options.contains(&MANYLINUX[0])
        && let Some(programs) = python.parent()
    {
        let others = std::env::var_os("PATH").unwrap_or_default();
        let paths = std::iter::once(programs.to_path_buf()).chain(std::env::split_paths(&others));
        c.env("PATH", std::env::join_paths(paths).map_err(|e| format!("PATH: {e}"))?);
    }
    finish(c)?;
    let files = std::fs::read_dir(&out).map_err(|e| format!("{}: {e}", shown(&out)))?;
    let wheel =
        files.filter_map(Result::ok).map(|e| e.path()).find(|p| p.extension().is_some_and(|e| e == "whl"));
    wheel.ok_or_else(|| format!("{}: maturin left no wheel", shown(&out)))
}

fn pytest(python: &Path, marked: &str) -> Outcome {
    say(&format!("$ pytest -m \"{marked}\" (in apps/python)"));
    // From another folder: the installed package is tested, not the sources next to the tests.
    let mut c = prepare(python, &["-m", "pytest", "-q", "-p", "no:cacheprovider", "-m", marked, "--rootdir"]);
    c.arg(package()).arg(package().join("tests"));
    c.env("BURGEON", burgeon("debug")).env("PYTHONDONTWRITEBYTECODE", "1");
    finish(c)
}
