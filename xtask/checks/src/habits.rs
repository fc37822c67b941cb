//! Habits that no compiler checks: kinds of dependencies, spelling, numbers without a name, packages that could be
//! published.

use std::path::PathBuf;

use crate::bare_numbers;
use xtask::shell::{Outcome, cache_dir, cargo, finish, installed, output, prepare, say};

/// A program that checks one of them.
struct Checker {
    /// Its package.
    package: &'static str,
    version: &'static str,
    program: &'static str,
    /// Package for Python of the same version that contains the built program, if there is one.
    wheel: Option<&'static str>,
}

const DENY: Checker =
    Checker { package: "cargo-deny", version: "0.20.2", program: "cargo-deny", wheel: None };
const TYPOS: Checker =
    Checker { package: "typos-cli", version: "1.52.0", program: "typos", wheel: Some("typos") };

/// Runs all checkers.
pub(crate) fn check() -> Outcome {
    bare_numbers::check()?;
    if let Some(deny) = DENY.found() {
        say("$ cargo deny check licenses bans sources (deny.toml)");
        finish(prepare(&deny, &["--log-level", "error", "check", "licenses", "bans", "sources"]))?;
        // The list of advisories is on another host, which is not always reachable.
        say("$ cargo deny fetch db");
        match output(prepare(&deny, &["--log-level", "error", "fetch", "db"])) {
            Ok(_) => finish(prepare(&deny, &["--log-level", "error", "check", "advisories"]))?,
            Err(e) => say(&format!("skipped: security advisories cannot be fetched here ({e})")),
        }
    }
    if let Some(typos) = TYPOS.found() {
        say("$ typos (typos.toml)");
        finish(prepare(&typos, &["--format", "brief"]))?;
    }
    let mut package = vec!["package", "--workspace", "--no-verify", "--allow-dirty", "--quiet"];
    package.extend([
        "--exclude",
        "burgeon-wasm",
        "--exclude",
        "burgeon-python",
        "--exclude",
        "burgeon-npm",
        "--exclude",
        "burgeon-bench",
        "--exclude",
        "burgeon-lab",
        "--exclude",
        "xtask",
        "--exclude",
        "xtask-checks",
    ]);
    cargo(&package)
}

impl Checker {
    /// Returns the program: installed for this checkout, or now; `None` and a message where that fails.
    fn found(&self) -> Option<PathBuf> {
        if let Some(program) = self.wheel.and_then(|wheel| self.unpacked(wheel)) {
            return Some(program);
        }
        // It runs for a second, so the time to build it matters.
        match installed((self.package, self.program), self.version, &[], "0") {
            Ok(program) => Some(program),
            Err(e) => {
                say(&format!("skipped: {} cannot be installed here ({e})", self.package));
                None
            }
        }
    }

    /// Returns the program of a wheel, unpacked into the cache if it is not there: in seconds, where building it takes
    /// minutes. `None` where there is no Python for it.
    fn unpacked(&self, wheel: &str) -> Option<PathBuf> {
        let root = cache_dir().join(format!("{}-{}-wheel", self.program, self.version));
        let program = root.join("bin").join(self.program);
        if program.exists() {
            return Some(program);
        }
        let package = format!("{wheel}=={}", self.version);
        say(&format!("$ pip install {package} (once)"));
        let mut environment = prepare("python3", &["-m", "venv", "--clear"]);
        environment.arg(&root);
        let quietly = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", &package];
        let installed = output(environment).and_then(|_| output(prepare(root.join("bin/python"), &quietly)));
        (installed.is_ok() && program.exists()).then_some(program)
    }
}
