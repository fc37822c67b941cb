//! Habits that no compiler checks: what dependencies may be, spelling, numbers without a name, packages that could be
//! published.

use std::path::PathBuf;

use crate::bare_numbers;
use crate::shell::{Outcome, cargo, finish, installed, output, prepare, say};

/// A program that checks one of them.
struct Checker {
    /// Its package.
    package: &'static str,
    version: &'static str,
    program: &'static str,
}

const DENY: Checker = Checker { package: "cargo-deny", version: "0.20.2", program: "cargo-deny" };
const TYPOS: Checker = Checker { package: "typos-cli", version: "1.52.0", program: "typos" };

/// Runs them all.
pub(crate) fn check() -> Outcome {
    bare_numbers::check()?;
    if let Some(deny) = DENY.found() {
        say("$ cargo deny check licenses bans sources (deny.toml)");
        finish(prepare(&deny, &["--log-level", "error", "check", "licenses", "bans", "sources"]))?;
        // The list of advisories lies elsewhere: it cannot be had everywhere.
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
        "xtask",
    ]);
    cargo(&package)
}

impl Checker {
    /// The program: installed for this checkout, or now; none where that fails, and says so.
    fn found(&self) -> Option<PathBuf> {
        // It runs for a second: what it takes to build counts.
        match installed((self.package, self.program), self.version, &[], "0") {
            Ok(program) => Some(program),
            Err(e) => {
                say(&format!("skipped: {} cannot be installed here ({e})", self.package));
                None
            }
        }
    }
}
