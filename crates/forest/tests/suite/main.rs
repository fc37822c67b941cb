//! The integration tests, linked as one program. One module of them: `cargo test -p burgeon-forest --test suite MODULE::`.

mod files;
