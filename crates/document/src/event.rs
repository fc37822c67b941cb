//! Changes of a document, with all that is needed to revert them.

use crate::state::Settings;
use crate::{Document, DocumentPlant, DocumentStroke, PlantId};

/// Strokes with their rows, ascending.
pub type StrokeRows = Vec<(usize, DocumentStroke)>;

/// One change, applied forwards and backwards.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Strokes were inserted at these rows (of the sketch after the change).
    Added {
        /// The plant of the strokes.
        plant: PlantId,
        /// Row and stroke.
        rows: StrokeRows,
        /// The next stroke number, before and after.
        next_stroke: (u32, u32),
    },
    /// Strokes at these rows (of the sketch before the change) were removed.
    Removed {
        /// The plant of the strokes.
        plant: PlantId,
        /// Row and stroke.
        rows: StrokeRows,
    },
    /// Strokes were edited in place.
    Edited {
        /// The plant of the strokes.
        plant: PlantId,
        /// Row, before, after.
        rows: Vec<(usize, DocumentStroke, DocumentStroke)>,
    },
    /// The settings of a plant were changed.
    Set {
        /// The plant.
        plant: PlantId,
        /// The settings before.
        before: Box<Settings>,
        /// The settings after.
        after: Box<Settings>,
    },
    /// A plant was added.
    PlantAdded {
        /// Its row after the change.
        row: usize,
        /// The plant.
        plant: Box<DocumentPlant>,
        /// The next plant number, before and after.
        next_plant: (u32, u32),
        /// The next stroke number, before and after.
        next_stroke: (u32, u32),
    },
    /// A plant was removed.
    PlantRemoved {
        /// Its row before the change.
        row: usize,
        /// The plant.
        plant: Box<DocumentPlant>,
    },
    /// The scene was renamed.
    Renamed {
        /// The name before.
        before: String,
        /// The name after.
        after: String,
    },
    /// Another document replaced this one.
    Opened {
        /// The document before.
        before: Box<Document>,
        /// The document after.
        after: Box<Document>,
    },
}

impl Event {
    /// Applies the change.
    pub(crate) fn apply(&self, document: &mut Document) {
        match self {
            Self::Added { plant, rows, next_stroke } => {
                strokes(document, *plant, |s| insert(rows, s));
                document.next_stroke = next_stroke.1;
            }
            Self::Removed { plant, rows } => strokes(document, *plant, |s| take_out(rows, s)),
            Self::Edited { plant, rows } => strokes(document, *plant, |s| {
                rows.iter().for_each(|(row, _, after)| put(*row, after, s));
            }),
            Self::Set { plant, after, .. } => set(document, *plant, after),
            Self::PlantAdded { row, plant, next_plant, next_stroke } => {
                document.plants.insert((*row).min(document.plants.len()), DocumentPlant::clone(plant));
                (document.next_plant, document.next_stroke) = (next_plant.1, next_stroke.1);
            }
            Self::PlantRemoved { plant, .. } => document.plants.retain(|p| p.id != plant.id),
            Self::Renamed { after, .. } => document.name.clone_from(after),
            Self::Opened { after, .. } => *document = Document::clone(after),
        }
    }

    /// Reverts the change; `document` must be as [`Event::apply`] left it.
    pub(crate) fn revert(&self, document: &mut Document) {
        match self {
            Self::Added { plant, rows, next_stroke } => {
                strokes(document, *plant, |s| take_out(rows, s));
                document.next_stroke = next_stroke.0;
            }
            Self::Removed { plant, rows } => strokes(document, *plant, |s| insert(rows, s)),
            Self::Edited { plant, rows } => strokes(document, *plant, |s| {
                rows.iter().for_each(|(row, before, _)| put(*row, before, s));
            }),
            Self::Set { plant, before, .. } => set(document, *plant, before),
            Self::PlantAdded { plant, next_plant, next_stroke, .. } => {
                document.plants.retain(|p| p.id != plant.id);
                (document.next_plant, document.next_stroke) = (next_plant.0, next_stroke.0);
            }
            Self::PlantRemoved { row, plant } => {
                document.plants.insert((*row).min(document.plants.len()), DocumentPlant::clone(plant));
            }
            Self::Renamed { before, .. } => document.name.clone_from(before),
            Self::Opened { before, .. } => *document = Document::clone(before),
        }
    }
}

fn strokes(document: &mut Document, plant: PlantId, change: impl FnOnce(&mut Vec<DocumentStroke>)) {
    if let Some(plant) = document.plant_mut(plant) {
        change(&mut plant.strokes);
    }
}

fn set(document: &mut Document, plant: PlantId, settings: &Settings) {
    if let Some(plant) = document.plant_mut(plant) {
        plant.settings = settings.clone();
    }
}

fn put(row: usize, stroke: &DocumentStroke, strokes: &mut [DocumentStroke]) {
    if let Some(place) = strokes.get_mut(row) {
        *place = stroke.clone();
    }
}

// One pass, so that clearing a large drawing stays linear.
fn insert(rows: &[(usize, DocumentStroke)], strokes: &mut Vec<DocumentStroke>) {
    let mut old = std::mem::take(strokes).into_iter();
    let mut new = rows.iter().peekable();
    loop {
        let at = strokes.len();
        match new.next_if(|(row, _)| *row <= at) {
            Some((_, stroke)) => strokes.push(stroke.clone()),
            None => match old.next() {
                Some(stroke) => strokes.push(stroke),
                None => break,
            },
        }
    }
    strokes.extend(new.map(|(_, stroke)| stroke.clone()));
}

fn take_out(rows: &[(usize, DocumentStroke)], strokes: &mut Vec<DocumentStroke>) {
    let mut gone = rows.iter().map(|(row, _)| *row).peekable();
    let mut row = 0;
    strokes.retain(|_| {
        let keep = gone.next_if_eq(&row).is_none();
        row += 1;
        keep
    });
}
