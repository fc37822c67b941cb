//! Reports tests that are skipped on machines without what they need.

use std::fmt::Display;
use std::io::Write as _;

/// Reports that a test is skipped because something is missing. `eprintln!` would not do: the output of a passing test
/// is captured, and nobody would see that it tested nothing.
pub(crate) fn skipped(what: impl Display) {
    let _ = writeln!(std::io::stderr(), "skipped: {what} is not there");
}
