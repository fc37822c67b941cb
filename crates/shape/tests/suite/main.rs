//! The integration tests, linked as one program. One module of them: `cargo test -p burgeon-shape --test suite MODULE::`.

mod edits;
mod tools;
