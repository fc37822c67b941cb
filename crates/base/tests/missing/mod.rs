//! Tests that need what not every machine has.

use std::fmt::Display;
use std::io::Write as _;

/// Says that a test is skipped for want of something. Not by `eprintln!`: what a test that passes prints is captured,
/// and nobody would see that it tested nothing.
pub(crate) fn skipped(what: impl Display) {
    let _ = writeln!(std::io::stderr(), "skipped: {what} is not there");
}
