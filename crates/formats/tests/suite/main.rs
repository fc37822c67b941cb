//! The integration tests, linked as one program. One module of them: `cargo test -p burgeon-formats --test suite MODULE::`.

#[path = "../../../base/tests/effort/mod.rs"]
mod effort;
#[path = "../../../base/tests/missing/mod.rs"]
mod missing;

mod drawings;
mod glb;
mod margins;
mod models;
mod mtg_reader;
mod mutations;
mod opf;
mod opf_reader;
mod read_structure;
mod scans;
mod structure;
mod tiles;
mod types;
