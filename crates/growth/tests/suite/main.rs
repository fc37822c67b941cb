//! The integration tests, linked as one program. One module of them:
//! `cargo test -p burgeon-growth --test suite MODULE::`.

mod properties;
