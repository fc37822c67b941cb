//! The integration tests, linked as one program. One module of them: `cargo test -p burgeon --test suite MODULE::`.

#[path = "../../../base/tests/missing/mod.rs"]
mod missing;
#[path = "../../../base/tests/share/mod.rs"]
mod share;

mod again;
mod colours;
mod doubts;
mod fidelity;
mod levels;
mod lives;
mod scans;
mod schemas;
mod wood;

/// Where a test grows a species at many ages or measures all of its meshes, each run looks at one species of so many.
const SPECIES: usize = 4;
