//! What happened to a document, with all that is needed to take it back.

use crate::state::Settings;
use crate::{Document, DocumentStroke};

/// One change, applied forwards and backwards. Rows are ascending.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Strokes came in at these rows (of the document after).
    Added {
        /// Row and stroke.
        rows: Vec<(usize, DocumentStroke)>,
        /// The next stroke number, before and after.
        next_id: (u32, u32),
    },
    /// Strokes at these rows (of the document before) went.
    Removed {
        /// Row and stroke.
        rows: Vec<(usize, DocumentStroke)>,
    },
    /// Strokes were edited in place.
    Edited {
        /// Row, before, after.
        rows: Vec<(usize, DocumentStroke, DocumentStroke)>,
    },
    /// Settings were set.
    Set {
        /// As they were.
        before: Box<Settings>,
        /// As they are.
        after: Box<Settings>,
    },
    /// Another document took the place.
    Opened {
        /// As it was.
        before: Box<Document>,
        /// As it is.
        after: Box<Document>,
    },
}

impl Event {
    /// Makes the change.
    pub(crate) fn apply(&self, document: &mut Document) {
        match self {
            Self::Added { rows, next_id } => {
                insert(rows, document);
                document.next_id = next_id.1;
            }
            Self::Removed { rows } => take_out(rows, document),
            Self::Edited { rows } => {
                for (row, _, after) in rows {
                    put(*row, after, document);
                }
            }
            Self::Set { after, .. } => document.settings = Settings::clone(after),
            Self::Opened { after, .. } => *document = Document::clone(after),
        }
    }

    /// Takes the change back; `document` must be as [`Event::apply`] left it.
    pub(crate) fn revert(&self, document: &mut Document) {
        match self {
            Self::Added { rows, next_id } => {
                take_out(rows, document);
                document.next_id = next_id.0;
            }
            Self::Removed { rows } => insert(rows, document),
            Self::Edited { rows } => {
                for (row, before, _) in rows {
                    put(*row, before, document);
                }
            }
            Self::Set { before, .. } => document.settings = Settings::clone(before),
            Self::Opened { before, .. } => *document = Document::clone(before),
        }
    }
}

fn put(row: usize, stroke: &DocumentStroke, document: &mut Document) {
    if let Some(place) = document.strokes.get_mut(row) {
        *place = stroke.clone();
    }
}

// One pass, so that clearing a large drawing stays linear.
fn insert(rows: &[(usize, DocumentStroke)], document: &mut Document) {
    let mut old = std::mem::take(&mut document.strokes).into_iter();
    let mut new = rows.iter().peekable();
    loop {
        let at = document.strokes.len();
        match new.next_if(|(row, _)| *row <= at) {
            Some((_, stroke)) => document.strokes.push(stroke.clone()),
            None => match old.next() {
                Some(stroke) => document.strokes.push(stroke),
                None => break,
            },
        }
    }
    document.strokes.extend(new.map(|(_, stroke)| stroke.clone()));
}

fn take_out(rows: &[(usize, DocumentStroke)], document: &mut Document) {
    let mut gone = rows.iter().map(|(row, _)| *row).peekable();
    let mut row = 0;
    document.strokes.retain(|_| {
        let keep = gone.next_if_eq(&row).is_none();
        row += 1;
        keep
    });
}
