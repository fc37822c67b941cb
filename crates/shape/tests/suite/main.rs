//! Integration tests, linked as one program. To run one module of them: `cargo test -p burgeon-shape --test suite
//! MODULE::`.

mod edits;
mod tools;
