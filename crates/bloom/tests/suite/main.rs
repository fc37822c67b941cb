//! The integration tests, linked as one program. One module of them:
//! `cargo test -p burgeon-bloom --test suite MODULE::`.

#[path = "../../../base/tests/missing/mod.rs"]
mod missing;

mod flowers;
mod scipy;
mod tomato;
mod truth;
