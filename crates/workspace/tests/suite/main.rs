//! The integration tests, linked as one program. One module of them: `cargo test -p burgeon-workspace --test suite MODULE::`.

mod drawing;
mod later;
mod previews;
mod typescript;
mod warnings;
mod wire;
