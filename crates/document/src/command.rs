//! What can be asked of a document. A command is checked and becomes an event, or an error and nothing.

use std::collections::BTreeSet;
use std::sync::Arc;

use base::Seed;
use glam::DVec2;
use sketch::{InkSample, SketchSpec, Stroke, StrokeClass, StrokeMode};
use skin::SkinSpec;

use crate::event::Event;
use crate::state::{NAME_LENGTH, Settings, range_fault, sound};
use crate::{Document, DocumentStroke, Photo, StrokeId};

/// A stroke that is to be added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NewStroke {
    /// What the pen left.
    pub stroke: Stroke,
    /// The class, if the person set it.
    pub class: Option<StrokeClass>,
}

impl NewStroke {
    /// A bare line in `parts` mode.
    pub fn line(points: &[DVec2]) -> Self {
        let samples = points.iter().map(|&p| InkSample::from(p)).collect();
        Self { stroke: Stroke { samples, ..Stroke::default() }, class: None }
    }
}

/// What can be asked of a document.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Command {
    /// Adds strokes after the others. Points that are not finite are left out.
    AddStrokes(Vec<NewStroke>),
    /// Adds moved copies of strokes after the others, with what was said of them.
    Duplicate(Vec<StrokeId>, DVec2),
    /// Erases strokes.
    RemoveStrokes(Vec<StrokeId>),
    /// Moves strokes, in the drawing's unit, y up.
    MoveStrokes(Vec<StrokeId>, DVec2),
    /// Sets the class of strokes, or leaves it to the classifier again.
    SetClass(Vec<StrokeId>, Option<StrokeClass>),
    /// Sets the mode of strokes.
    SetMode(Vec<StrokeId>, StrokeMode),
    /// Gives strokes a colour, or takes it away.
    SetColor(Vec<StrokeId>, Option<[u8; 3]>),
    /// Erases every stroke.
    Clear,
    /// Names the plant.
    Rename(String),
    /// Sets the seed.
    SetSeed(Seed),
    /// Sets how the drawing is understood.
    SetSketch(Box<SketchSpec>),
    /// Sets how the plant is meshed and coloured.
    SetSkin(SkinSpec),
    /// Puts a photograph under the drawing, changes how it lies there, or takes it away.
    SetPhoto(Option<Box<Photo>>),
    /// Puts another document in the place of this one.
    Open(Box<Document>),
}

/// Why a command was refused; the document is as it was.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CommandError {
    /// A stroke is named that is not there.
    #[error("there is no stroke {}; it may have been erased", .0.0)]
    NoSuchStroke(StrokeId),
    /// Nothing would change.
    #[error("nothing to do: {0}")]
    Nothing(&'static str),
    /// A setting is out of its range.
    #[error("{0}")]
    OutOfRange(String),
    /// A point would leave the range of numbers.
    #[error("a stroke cannot be moved that far")]
    TooFar,
    /// Strokes are numbered with 32 bits.
    #[error("the document has given all its stroke numbers; copy the strokes into a new one")]
    Full,
    /// A gesture is open and this needs it closed, or the other way round.
    #[error("{0}")]
    Gesture(&'static str),
}

impl Command {
    /// The name of its undo step: a key that the user interface translates.
    pub fn name(&self) -> &'static str {
        match self {
            Self::AddStrokes(_) => "draw",
            Self::Duplicate(..) => "duplicate",
            Self::RemoveStrokes(_) => "erase",
            Self::MoveStrokes(..) => "move",
            Self::SetClass(..) => "class",
            Self::SetMode(..) => "mode",
            Self::SetColor(..) => "color",
            Self::Clear => "clear",
            Self::Rename(_) => "rename",
            Self::SetSeed(_) => "seed",
            Self::SetSketch(_) => "sketch",
            Self::SetSkin(_) => "skin",
            Self::SetPhoto(_) => "photo",
            Self::Open(_) => "open",
        }
    }

    /// Checks the command against a document and says what would happen.
    pub(crate) fn decide(self, document: &Document) -> Result<Event, CommandError> {
        match self {
            Self::AddStrokes(strokes) => add(strokes, document),
            Self::Duplicate(ids, by) => duplicate(&ids, by, document),
            Self::RemoveStrokes(ids) => remove(&rows(&ids, document)?, document),
            Self::Clear => remove(&(0..document.strokes.len()).collect::<Vec<_>>(), document),
            Self::MoveStrokes(ids, by) => edit(&ids, document, |s| {
                s.stroke = Arc::new(moved(&s.stroke, by)?);
                Ok(())
            }),
            Self::SetClass(ids, class) => edit(&ids, document, |s| {
                s.class = class;
                Ok(())
            }),
            Self::SetMode(ids, mode) => edit(&ids, document, |s| {
                s.stroke = Arc::new(Stroke { mode, ..Stroke::clone(&s.stroke) });
                Ok(())
            }),
            Self::SetColor(ids, color) => edit(&ids, document, |s| {
                s.stroke = Arc::new(Stroke { color, ..Stroke::clone(&s.stroke) });
                Ok(())
            }),
            Self::Rename(name) => set(document, |s| {
                s.name = crate::state::shortened(name.trim());
                debug_assert!(s.name.chars().count() <= NAME_LENGTH, "shortened");
            }),
            Self::SetSeed(seed) => set(document, |s| s.seed = seed),
            Self::SetSketch(sketch) => set(document, |s| s.sketch = *sketch),
            Self::SetSkin(skin) => set(document, |s| s.skin = SkinSpec { seed: s.skin.seed, ..skin }),
            Self::SetPhoto(photo) => set(document, |s| s.photo = photo.map(|p| *p)),
            Self::Open(other) => Ok(Event::Opened { before: Box::new(document.clone()), after: other }),
        }
    }
}

fn add(strokes: Vec<NewStroke>, document: &Document) -> Result<Event, CommandError> {
    let mut next = document.next_id;
    let mut rows = Vec::with_capacity(strokes.len());
    for new in strokes {
        let Some(stroke) = sound(new.stroke) else { continue };
        let id = StrokeId(next);
        next = next.checked_add(1).ok_or(CommandError::Full)?;
        let row = document.strokes.len() + rows.len();
        rows.push((row, DocumentStroke { id, stroke: Arc::new(stroke), class: new.class }));
    }
    if rows.is_empty() {
        return Err(CommandError::Nothing("the stroke has no point"));
    }
    Ok(Event::Added { rows, next_id: (document.next_id, next) })
}

fn moved(stroke: &Stroke, by: DVec2) -> Result<Stroke, CommandError> {
    let mut stroke = stroke.clone();
    for sample in &mut stroke.samples {
        sample.at += by;
        if !sample.at.is_finite() {
            return Err(CommandError::TooFar);
        }
    }
    Ok(stroke)
}

fn duplicate(ids: &[StrokeId], by: DVec2, document: &Document) -> Result<Event, CommandError> {
    let copies = rows(ids, document)?.into_iter().map(|row| {
        let s = &document.strokes[row];
        Ok(NewStroke { stroke: moved(&s.stroke, by)?, class: s.class })
    });
    add(copies.collect::<Result<_, CommandError>>()?, document)
}

fn rows(ids: &[StrokeId], document: &Document) -> Result<Vec<usize>, CommandError> {
    let wanted: BTreeSet<StrokeId> = ids.iter().copied().collect();
    let found = document.strokes.iter().enumerate().filter(|(_, s)| wanted.contains(&s.id));
    let found: Vec<usize> = found.map(|(row, _)| row).collect();
    if found.len() < wanted.len() {
        let missing = wanted.into_iter().find(|&id| document.row(id).is_none());
        return Err(missing.map_or(CommandError::Nothing("no stroke"), CommandError::NoSuchStroke));
    }
    Ok(found)
}

fn remove(rows: &[usize], document: &Document) -> Result<Event, CommandError> {
    if rows.is_empty() {
        return Err(CommandError::Nothing("there is no stroke to erase"));
    }
    let rows = rows.iter().filter_map(|&row| Some((row, document.strokes.get(row)?.clone()))).collect();
    Ok(Event::Removed { rows })
}

fn edit(
    ids: &[StrokeId],
    document: &Document,
    mut change: impl FnMut(&mut DocumentStroke) -> Result<(), CommandError>,
) -> Result<Event, CommandError> {
    let mut changed = Vec::new();
    for row in rows(ids, document)? {
        let before = document.strokes[row].clone();
        let mut after = before.clone();
        change(&mut after)?;
        if after != before {
            changed.push((row, before, after));
        }
    }
    if changed.is_empty() {
        return Err(CommandError::Nothing("the strokes are like that already"));
    }
    Ok(Event::Edited { rows: changed })
}

fn set(document: &Document, change: impl FnOnce(&mut Settings)) -> Result<Event, CommandError> {
    let before = document.settings.clone();
    let mut after = before.clone();
    change(&mut after);
    if after == before {
        return Err(CommandError::Nothing("the setting is like that already"));
    }
    match range_fault(&after) {
        Some(fault) => Err(CommandError::OutOfRange(fault)),
        None => Ok(Event::Set { before: Box::new(before), after: Box::new(after) }),
    }
}
