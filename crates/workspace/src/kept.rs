//! Retention of results: they are kept as long as there is room, and those not shown for longest are dropped first.

use burgeon::LiteMap;
use burgeon::document::PlantId;

/// Default of [`crate::Workspace::keep_at_most`]: 256 MiB, a quarter of the memory that a tab may request.
pub const KEPT_BYTES: usize = 256 << 20;

/// Default of [`crate::Workspace::show_at_most`], the size of all results at which no further plant is made: 2.5 GiB. A
/// page can address 4 GiB; one more plant may need 1 GiB while it is made.
pub const SHOWN_BYTES: usize = 5 << 29;

/// The last time that each plant was shown.
#[derive(Debug)]
pub(crate) struct Kept {
    pub(crate) limit: usize,
    pub(crate) most: usize,
    pub(crate) now: u64,
    pub(crate) shown: LiteMap<PlantId, u64>,
}

impl Default for Kept {
    fn default() -> Self {
        Self::at_most(KEPT_BYTES)
    }
}

impl Kept {
    pub(crate) fn at_most(limit: usize) -> Self {
        Self { limit, most: SHOWN_BYTES, now: 0, shown: LiteMap::new() }
    }
}
