//! The integration tests, linked as one program. One module of them:
//! `cargo test -p burgeon-document --test suite MODULE::`.

mod files;
mod undo;
