//! Integration tests, linked as one program. To run one module: `cargo test -p burgeon-workspace --test suite
//! MODULE::`.

mod drawing;
mod kept;
mod later;
#[path = "../../../../bench/src/piles.rs"]
#[expect(unreachable_pub, reason = "what the benchmarks give to their programs")]
mod piles;
mod previews;
mod typescript;
mod warnings;
mod wire;
