//! Shared parts of the programs for this repository's chores.

pub mod shell;
