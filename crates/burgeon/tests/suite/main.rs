//! Integration tests, linked as one program. To run one module: `cargo test -p burgeon --test suite MODULE::`.

#[path = "../../../base/tests/missing/mod.rs"]
mod missing;
#[path = "../../../base/tests/share/mod.rs"]
mod share;

mod again;
mod blossom;
mod colours;
mod doubts;
mod drawn;
mod fidelity;
mod levels;
mod lives;
mod scans;
mod schemas;
mod survey;
mod wood;

/// Number of species of which each run tests one, where a test grows a species at many ages or measures all of its
/// meshes.
const SPECIES: usize = 4;
