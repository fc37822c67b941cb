//! Faults of a file: what is wrong, where, and what to do about it.

use core::fmt;
use std::io;

use base::{Report, Slip};

use crate::foreign::Foreign;
use crate::{CloudFormat, DrawingFormat, ModelFormat};

/// Position in a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// The file as a whole.
    #[default]
    File,
    /// A line, from 1; the column, from 1, where known.
    Line {
        /// Line from 1.
        line: u64,
        /// Column from 1.
        column: Option<u64>,
    },
    /// An XML element.
    Element {
        /// Tag and id, such as ``path `leaf-3` ``.
        name: String,
        /// Line from 1.
        line: u64,
    },
    /// Bytes from the start of the file.
    Byte(u64),
    /// A named part of the file, such as `mesh 3` or `stroke 2, point 7`.
    Item(String),
}

impl Place {
    pub(crate) fn line(line: usize) -> Self {
        Self::Line { line: line as u64, column: None }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line { line, column: None } => write!(f, ", line {line}"),
            Self::Line { line, column: Some(column) } => write!(f, ", line {line}, column {column}"),
            Self::Element { name, line } => write!(f, ", line {line}, {}", base::brief(name)),
            Self::Byte(at) => write!(f, ", byte {at}"),
            Self::Item(item) => write!(f, ", {}", base::brief(item)),
        }
    }
}

/// Fault of a file of strokes or of a model, as data for messages.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileFault {
    /// The file holds nothing, or only white space.
    #[error("the file is empty; was it saved completely?")]
    Empty,
    /// The text or the bytes break the format's grammar.
    #[error("{}; {advice}", base::plainly(what))]
    Malformed {
        /// What was found.
        what: String,
        /// What to do.
        advice: &'static str,
    },
    /// The file ends in the middle of something.
    #[error("the file ends inside {}; it is cut off: save or copy it again", base::brief(inside))]
    Truncated {
        /// What was not finished.
        inside: String,
    },
    /// The file is allowed by the format, but Burgeon does not read it.
    #[error("{what} is not supported; {advice}")]
    Unsupported {
        /// The unsupported feature.
        what: String,
        /// What to do.
        advice: &'static str,
    },
    /// The file exceeds a bound that keeps hostile files harmless.
    #[error("{what} goes beyond the limit of {limit}; {advice}")]
    TooMuch {
        /// The quantity that is bounded.
        what: &'static str,
        /// The bound.
        limit: u64,
        /// What to do.
        advice: &'static str,
    },
    /// The drawing has no strokes.
    #[error("there is no stroke in it{because}; draw lines, paths or shapes that are visible")]
    NoStrokes {
        /// The file's content instead, in brackets; may be empty.
        because: String,
    },
    /// The bytes are not UTF-8 text.
    #[error("after {after} bytes the text is not UTF-8; save it again as UTF-8")]
    NotUtf8 {
        /// Number of valid bytes before.
        after: u64,
    },
    /// It is a file of another program.
    #[error("{0}")]
    Foreign(Foreign),
    /// The file names another one that must not be read.
    #[error("{why}")]
    Refused {
        /// The file that is named, what names it, why it is not read, and what to do.
        why: String,
    },
    /// Reading failed.
    #[error("it could not be read: {0}")]
    Io(#[from] io::Error),
}

impl FileFault {
    /// Returns [`Self::Foreign`] if the bytes are those of a file that nothing here reads.
    pub(crate) fn if_foreign(foreign: Option<Foreign>) -> Result<(), Self> {
        foreign.map_or(Ok(()), |foreign| Err(Self::Foreign(foreign)))
    }

    /// Returns [`Self::NoStrokes`] with the reasons from the reader's report.
    pub(crate) fn no_strokes(report: &Report) -> Self {
        let reasons: Vec<&str> = report.warnings.iter().take(3).map(|w| w.message.as_str()).collect();
        let because = if reasons.is_empty() { String::new() } else { format!(" ({})", reasons.join("; ")) };
        Self::NoStrokes { because }
    }

    pub(crate) fn malformed(what: impl Into<String>, advice: &'static str) -> Self {
        Self::Malformed { what: base::brief(&what.into()), advice }
    }

    pub(crate) fn unsupported(what: impl Into<String>, advice: &'static str) -> Self {
        Self::Unsupported { what: base::brief(&what.into()), advice }
    }
}

/// Error of reading a drawing.
#[derive(Debug, thiserror::Error)]
#[error("{}{place}: {fault}", format.name())]
pub struct DrawingError {
    /// The format that the reader expected.
    pub format: DrawingFormat,
    /// Where.
    pub place: Place,
    /// The fault, and what to do.
    pub fault: FileFault,
}

impl DrawingError {
    pub(crate) fn new(format: DrawingFormat, place: Place, fault: FileFault) -> Self {
        Self { format, place, fault }
    }
}

/// Error of reading a model.
#[derive(Debug, thiserror::Error)]
#[error("{}{place}: {fault}", format.name())]
pub struct ModelError {
    /// The format that the reader expected.
    pub format: ModelFormat,
    /// Where.
    pub place: Place,
    /// The fault, and what to do.
    pub fault: FileFault,
}

impl ModelError {
    pub(crate) fn new(format: ModelFormat, place: Place, fault: FileFault) -> Self {
        Self { format, place, fault }
    }
}

/// Error of reading a scan.
#[derive(Debug, thiserror::Error)]
#[error("{}{place}: {fault}", format.name())]
pub struct CloudError {
    /// The format that the reader expected.
    pub format: CloudFormat,
    /// Where.
    pub place: Place,
    /// The fault, and what to do.
    pub fault: FileFault,
}

impl CloudError {
    pub(crate) fn new(format: CloudFormat, place: Place, fault: FileFault) -> Self {
        Self { format, place, fault }
    }
}

/// Error of writing; nothing usable was written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The sink failed.
    #[error("writing failed: {0}")]
    Io(#[from] io::Error),
    /// The model is not sound: a bug of the code that made it.
    #[error("part `{part}` cannot be written: {fault}")]
    Model {
        /// Name of the part.
        part: String,
        /// The fault of its mesh.
        fault: mesh::MeshFault,
    },
    /// A texture's pixels do not fit its size, or the size is zero.
    #[error("a texture of {width} by {height} pixels with {bytes} bytes cannot be encoded")]
    Texture {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Bytes given.
        bytes: usize,
    },
    /// The format cannot hold that much.
    #[error("{what} is too large for {format}: split the model or choose another format")]
    TooLarge {
        /// The quantity that is too large.
        what: &'static str,
        /// Name of the format.
        format: &'static str,
    },
    /// A key of an animation does not fit the model, or its time is not after that of the key before.
    #[error("key {key} (from 0) of the animation has other parts or vertices, or does not come later")]
    Keys {
        /// Its index from 0.
        key: usize,
    },
    /// The joints do not fit the model.
    #[error("the joints do not fit the model: each vertex needs a hold, and each joint a move for each key")]
    Rig,
    /// The model has points without triangles, but the format holds only triangles.
    #[error("a cloud of points has no triangles for STL; choose .ply, .obj or .glb")]
    NoTriangles,
    /// Burgeon reads the format, but does not write it.
    #[error("{format} is read but not written; choose {instead}")]
    ReadOnly {
        /// The format asked for.
        format: &'static str,
        /// The formats to choose instead.
        instead: &'static str,
    },
}

base::coded!(FileFault {
    Self::Empty => "file-empty" {},
    Self::Malformed { what, .. } => "file-malformed" { what = &Slip::from_message(what) => Slip },
    Self::Truncated { inside } => "file-truncated" { inside },
    Self::Unsupported { what, .. } => "file-unsupported" { what },
    Self::TooMuch { what, limit, .. } => "file-too-much" { what, limit },
    Self::NoStrokes { .. } => "file-no-strokes" {},
    Self::NotUtf8 { after } => "file-not-utf8" { after },
    Self::Refused { why } => "file-refused" { why },
    Self::Io(why) => "file-io" { why },
} wraps {
    Self::Foreign(foreign) => foreign, Foreign;
});
base::coded!(WriteError { why => "write" { why } });
base::coded!(DrawingError {} wraps { Self { place, fault, .. } => &Placed { place, fault }, Placed<'_> });
base::coded!(ModelError {} wraps { Self { place, fault, .. } => &Placed { place, fault }, Placed<'_> });

/// A fault and where it is.
pub(crate) struct Placed<'a> {
    pub(crate) place: &'a Place,
    pub(crate) fault: &'a FileFault,
}

base::coded!(Placed<'_> {
    Self { place: Place::Line { line, .. } | Place::Element { line, .. }, fault } => "file-line" {
        line, why = fault => FileFault
    },
    Self { place: Place::Item(item), fault } => "file-item" { item, why = fault => FileFault },
} wraps {
    Self { fault, .. } => *fault, FileFault;
});
