//! The integration tests, linked as one program. One module of them:
//! `cargo test -p burgeon-skin --test suite MODULE::`.

mod colliders;
mod leaves;
mod scenes;
mod surfaces;
mod wind;
