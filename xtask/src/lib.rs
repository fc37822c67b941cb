//! What the programs of this repository's chores share.

pub mod shell;
