//! The integration tests, linked as one program. One module of them: `cargo test -p burgeon-sketch --test suite
//! MODULE::`.

mod bodies;
mod build;
mod tools;
