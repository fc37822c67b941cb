//! The integration tests, linked as one program. One module of them: `cargo test -p burgeon-scan --test suite MODULE::`.

mod trees;
