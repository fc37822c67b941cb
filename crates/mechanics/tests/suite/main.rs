//! The integration tests, linked as one program. One module of them:
//! `cargo test -p burgeon-mechanics --test suite MODULE::`.

mod beams;
mod hostile;
mod plants;
