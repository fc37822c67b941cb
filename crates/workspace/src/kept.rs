//! How long results are kept: as long as there is room. Those that were not shown for longest go first.

use burgeon::LiteMap;
use burgeon::document::PlantId;

/// How much is kept unless [`crate::Workspace::keep_at_most`] says otherwise: 256 MiB, a quarter of what a tab may ask for.
pub const KEPT_BYTES: usize = 256 << 20;

/// How much all results may take before no further plant is made, unless [`crate::Workspace::show_at_most`] says
/// otherwise: 2.5 GiB. A page can address 4 GiB; one more plant may need 1 GiB while it is made.
pub const SHOWN_BYTES: usize = 5 << 29;

/// When each plant was shown last.
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
