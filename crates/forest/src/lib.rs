//! Stands of trees: one row for each tree, and where its figures come from.
//!
//! | module | owns |
//! |---|---|
//! | `stand` | [`Stand`]: the trees of a forest with their measures and places |

mod stand;

pub use stand::{Figure, Given, Stand, StandFault, Tree};
