//! Files of measured leaves: marks and chief veins as CSV, vein graphs and profiles as JSON.

mod fields;
mod graph;
mod growth;
mod marks;
mod profiles;
mod rays;
mod sheet;

use std::io::Read;

use crate::drawing::text_of;
use crate::error::{FileFault, Place, Placed};
use crate::foreign::Foreign;

pub use graph::{ReadGraph, read_vein_graph};
pub use growth::{DateOrder, GrowthEntry, GrowthSpec, ReadGrowth, read_growth};
pub use marks::{MarksAxes, ReadMarks, marks_template, read_marks, write_marks};
pub use profiles::{ReadProfile, ReadProfiles, read_profiles};
pub use rays::{ReadRays, is_rays, read_rays, write_rays};
pub use sheet::{ReadSheet, read_xlsx};

/// Largest file of a leaf that is read: 16 MiB, far more than a person can measure.
pub const MAX_LEAF_BYTES: u64 = 16 << 20;

/// Error of reading a file of measurements: of a leaf, or of what grows.
#[derive(Debug, thiserror::Error)]
#[error("measurements{place}: {fault}")]
pub struct LeafFileError {
    /// Where.
    pub place: Place,
    /// The fault, and what to do.
    pub fault: FileFault,
}

impl LeafFileError {
    pub(crate) fn new(place: Place, fault: FileFault) -> Self {
        Self { place, fault }
    }
}

/// Contents of a file of a leaf.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LeafFile {
    /// Rows of marks along side veins: CSV with the columns `row,mark`.
    Marks(ReadMarks),
    /// Chief veins: CSV with the columns `vein,mark`.
    Rays(ReadRays),
    /// A network of veins: JSON with `nodes_xyr`.
    Graph(ReadGraph),
    /// Midribs in side view with widths: JSON with `x`, `y`, `s`, `r`.
    Profiles(ReadProfiles),
}

/// Reads a file of a leaf; its kind follows from its contents.
///
/// # Errors
/// [`LeafFileError`], from the reader of that kind.
pub fn read_leaf_file(input: impl Read, name: &str, axes: MarksAxes) -> Result<LeafFile, LeafFileError> {
    let text = text(input)?;
    let start = text.trim_start_matches('\u{feff}').trim_start();
    if !start.starts_with(['{', '[']) {
        let bytes = text.as_bytes();
        return Ok(match is_rays(bytes) {
            true => LeafFile::Rays(read_rays(bytes, name, axes)?),
            false => LeafFile::Marks(read_marks(bytes, name, axes)?),
        });
    }
    // Lists hold profiles; so does an object that has `leaves` or is a profile itself.
    let graph = start.starts_with('{') && !(text.contains("\"leaves\"") || text.contains("\"s\""));
    Ok(match graph {
        true => LeafFile::Graph(read_vein_graph(text.as_bytes())?),
        false => LeafFile::Profiles(read_profiles(text.as_bytes(), name, axes)?),
    })
}

/// Characters that spreadsheets put around a text of one cell: quotes, and separators of the cells that are empty.
const PADDING: [char; 5] = [',', ';', '\t', '"', ' '];

/// Returns the comment of a line, also of one that a spreadsheet saved.
fn comment_of(line: &str) -> Option<&str> {
    line.trim_matches(PADDING).strip_prefix('#')
}

/// Returns whether no cell of a line holds anything.
fn is_blank(line: &str) -> bool {
    line.trim_matches(PADDING).is_empty()
}

/// Reads a whole file of a leaf as text.
fn text(input: impl Read) -> Result<String, LeafFileError> {
    let file = |fault| LeafFileError::new(Place::File, fault);
    let mut bytes = Vec::new();
    input.take(MAX_LEAF_BYTES + 1).read_to_end(&mut bytes).map_err(|e| file(FileFault::Io(e)))?;
    if bytes.len() as u64 > MAX_LEAF_BYTES {
        return Err(file(FileFault::TooMuch {
            what: "the size in bytes",
            limit: MAX_LEAF_BYTES,
            advice: "a file holds what was measured on a leaf",
        }));
    }
    FileFault::if_foreign(Foreign::sniff_no_drawing(&bytes)).map_err(file)?;
    text_of(bytes).map_err(file)
}

base::coded!(LeafFileError {} wraps { Self { place, fault, .. } => &Placed { place, fault }, Placed<'_> });
