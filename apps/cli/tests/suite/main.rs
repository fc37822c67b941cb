//! Integration tests, linked as one program. To run one module: `cargo test -p burgeon-cli --test suite MODULE::`.

#[path = "../../../../crates/base/tests/missing/mod.rs"]
mod missing;

mod absurd;
mod bloom;
mod cloud_files;
mod clouds;
mod command;
mod export;
mod files;
mod forest;
mod generated;
mod grow;
mod hostile;
mod kills;
mod leaf;
mod light;
mod limits;
mod named;
mod options;
mod replay;
mod robots;
mod scans;
mod shape;
mod signals;
mod species;
mod structure;
mod times;
mod tools;
mod truth;
mod words;
