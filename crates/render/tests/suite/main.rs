//! The integration tests, linked as one program. One module of them:
//! `cargo test -p burgeon-render --test suite MODULE::`.

mod pictures;
