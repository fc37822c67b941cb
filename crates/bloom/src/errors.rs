//! Errors of this crate.

/// Reason why the input allows no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BloomError {
    /// A lattice has too few or too many control points, or other numbers than requested.
    #[error(
        "a lattice of {counts:?} control points does not fit; give 2 to 16 along each axis, such as 4x4x4"
    )]
    Lattice {
        /// Control points along each axis.
        counts: [usize; 3],
    },
    /// Two columns that belong together differ in length.
    #[error("{what}: {is} rows, {wanted} are wanted")]
    Length {
        /// Name of the column.
        what: &'static str,
        /// Actual number of rows.
        is: usize,
        /// Number of rows needed.
        wanted: usize,
    },
    /// There are too few points to work with.
    #[error(
        "{what} has {is} usable points, at least {wanted} are needed; scan it more densely or leave it out"
    )]
    TooFew {
        /// Name of the cloud.
        what: String,
        /// Actual number of points.
        is: usize,
        /// Number of points needed.
        wanted: usize,
    },
    /// A series cannot be fitted.
    #[error(transparent)]
    Fit(#[from] crate::FitError),
    /// A limit of the budget was exceeded.
    #[error(transparent)]
    OverBudget(#[from] base::OverBudget),
    /// The user asked to stop.
    #[error("cancelled")]
    Cancelled,
}

impl From<base::Cancelled> for BloomError {
    fn from(_: base::Cancelled) -> Self {
        Self::Cancelled
    }
}
