//! The integration tests, linked as one program. One module of them: `cargo test -p burgeon-npm --test suite MODULE::`.
#![cfg(feature = "makers")]

#[path = "../../../../crates/workspace/tests/suite/typescript.rs"]
mod typescript;

mod types;
