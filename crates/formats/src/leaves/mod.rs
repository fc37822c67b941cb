//! Files of measured leaves: marks and chief veins as CSV, vein graphs as JSON.

mod graph;
mod marks;
mod rays;

use crate::error::{FileFault, Place};

pub use graph::{ReadGraph, read_vein_graph};
pub use marks::{MarksAxes, ReadMarks, marks_template, read_marks, write_marks};
pub use rays::{ReadRays, is_rays, read_rays, write_rays};

/// Largest file of a leaf that is read: 16 MiB, far more than a person can measure.
pub const MAX_LEAF_BYTES: u64 = 16 << 20;

/// A file of a leaf could not be read.
#[derive(Debug, thiserror::Error)]
#[error("leaf file{place}: {fault}")]
pub struct LeafFileError {
    /// Where.
    pub place: Place,
    /// What and what to do.
    pub fault: FileFault,
}

impl LeafFileError {
    pub(crate) fn new(place: Place, fault: FileFault) -> Self {
        Self { place, fault }
    }
}
