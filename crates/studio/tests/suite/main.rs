//! The integration tests, linked as one program. One module of them: `cargo test -p burgeon --test suite MODULE::`.

#[path = "../../../base/tests/missing/mod.rs"]
mod missing;

mod again;
mod colours;
mod doubts;
mod fidelity;
mod levels;
mod lives;
mod scans;
mod schemas;
mod wood;
