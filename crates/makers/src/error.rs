//! Reasons why no plant of leaves was made.

use base::{Cancelled, OverBudget, Stopped};
use bloom::BloomError;
use geom::SplineError;
use leaf::{MarksError, RaysError, ScanError};

/// Reason why no leaf was made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LeafError {
    /// The marks make no leaf.
    #[error(transparent)]
    Marks(#[from] MarksError),
    /// The surface cannot be made.
    #[error(transparent)]
    Spline(#[from] SplineError),
    /// The chief veins make no leaf.
    #[error(transparent)]
    Rays(#[from] RaysError),
    /// The scan has no leaf.
    #[error(transparent)]
    Scan(#[from] ScanError),
    /// The scan has more than one leaf.
    #[error(
        "the cloud shows {0} blades that part on necks of their own: it is a plant or a leaf of leaflets, not one blade. Cut \
         one out of it, or make all of it as a plant of scans (docs/bloom.md)"
    )]
    Several(usize),
    /// There is no leaf to put on a plant.
    #[error("a plant needs at least one leaf")]
    NoLeaves,
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The result would exceed the budget.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
}

impl From<Stopped> for LeafError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Cancelled(c) => Self::Cancelled(c),
            Stopped::OverBudget(o) => Self::OverBudget(o),
        }
    }
}

base::coded!(LeafError {
    Self::Spline(why) => "leaf-surface" { why => SplineError },
    Self::Rays(why) => "leaf-veins" { why => RaysError },
    Self::Scan(why) => "leaf-scan" { why => ScanError },
    Self::Several(blades) => "scan-several" { blades },
    Self::NoLeaves => "no-leaves" {},
} wraps {
    Self::Marks(e) => e, MarksError;
    Self::Cancelled(e) => e, Cancelled;
    Self::OverBudget(e) => e, OverBudget;
});

/// Reason why organs make no plant.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SeedlingError {
    /// An organ has too few points.
    #[error(transparent)]
    Organ(#[from] BloomError),
    /// Fault of meshes and edits.
    #[error(transparent)]
    Leaf(#[from] LeafError),
}
