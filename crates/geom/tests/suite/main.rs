//! The integration tests, linked as one program. One module of them:
//! `cargo test -p burgeon-geom --test suite MODULE::`.

mod splines;
mod wild_input;
