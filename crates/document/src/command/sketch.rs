//! Commands of sketches: strokes and how they are understood.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec2;
use ink::{InkSample, Stroke, StrokeClass, StrokeMode};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sketch::SketchSpec;
use skin::SkinSpec;

use super::{Command, CommandError, may_bear, set};
use crate::event::Event;
use crate::makers::{Maker, SketchSettings};
use crate::state::sound;
use crate::{Document, DocumentPlant, DocumentStroke, Photo, PhotoPlace, PlantId, StrokeId};

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

/// What can be asked of a sketch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SketchCommand {
    /// Adds strokes after the others. Points that are not finite are left out.
    #[serde(skip)]
    AddStrokes(Vec<NewStroke>),
    /// Adds moved copies of strokes after the others, with what was said of them.
    Duplicate(Vec<StrokeId>, #[schemars(with = "[f64; 2]")] DVec2),
    /// Erases strokes.
    RemoveStrokes(Vec<StrokeId>),
    /// Moves strokes, in the drawing's unit, y up.
    MoveStrokes(Vec<StrokeId>, #[schemars(with = "[f64; 2]")] DVec2),
    /// Sets the class of strokes, or leaves it to the classifier again.
    SetClass(Vec<StrokeId>, Option<StrokeClass>),
    /// Sets the mode of strokes.
    SetMode(Vec<StrokeId>, StrokeMode),
    /// Gives strokes a colour, or takes it away.
    SetColor(Vec<StrokeId>, Option<[u8; 3]>),
    /// Erases every stroke.
    Clear,
    /// Sets how the drawing is understood.
    SetSketch(Box<SketchSpec>),
    /// Sets how the plant is meshed and coloured.
    SetSkin(SkinSpec),
    /// Puts a photograph under the drawing.
    #[serde(skip)]
    SetPhoto(Box<Photo>),
    /// Changes how the photograph lies under the drawing.
    PlacePhoto(PhotoPlace),
    /// Takes the photograph away.
    RemovePhoto,
    /// Shows its flowers at a day, or as they are drawn.
    SetDay(Option<f64>),
    /// Bears the leaf of another plant, or its own again.
    SetLeaf(Option<PlantId>),
}

impl SketchCommand {
    /// The command for a plant.
    pub fn of(self, plant: PlantId) -> Command {
        Command::Sketch(plant, self)
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::AddStrokes(_) => "draw",
            Self::Duplicate(..) => "duplicate",
            Self::RemoveStrokes(_) => "erase",
            Self::MoveStrokes(..) => "move",
            Self::SetClass(..) => "class",
            Self::SetMode(..) => "mode",
            Self::SetColor(..) => "color",
            Self::Clear => "clear",
            Self::SetSketch(_) => "sketch",
            Self::SetSkin(_) => "skin",
            Self::SetPhoto(_) | Self::PlacePhoto(_) | Self::RemovePhoto => "photo",
            Self::SetDay(_) => "day",
            Self::SetLeaf(_) => "leaf-of",
        }
    }

    pub(super) fn decide(self, plant: &DocumentPlant, document: &Document) -> Result<Event, CommandError> {
        if plant.settings.sketch().is_none() {
            let found = plant.settings.maker.word();
            return Err(CommandError::OtherMaker { wanted: "sketch", found });
        }
        match self {
            Self::AddStrokes(strokes) => add(strokes, plant, document),
            Self::Duplicate(ids, by) => duplicate(&ids, by, plant, document),
            Self::RemoveStrokes(ids) => remove(&rows(&ids, plant)?, plant),
            Self::Clear => remove(&(0..plant.strokes.len()).collect::<Vec<_>>(), plant),
            Self::MoveStrokes(ids, by) => edit(&ids, plant, |s| {
                s.stroke = Arc::new(moved(&s.stroke, by)?);
                Ok(())
            }),
            Self::SetClass(ids, class) => edit(&ids, plant, |s| {
                s.class = class;
                Ok(())
            }),
            Self::SetMode(ids, mode) => edit(&ids, plant, |s| {
                s.stroke = Arc::new(Stroke { mode, ..Stroke::clone(&s.stroke) });
                Ok(())
            }),
            Self::SetColor(ids, color) => edit(&ids, plant, |s| {
                s.stroke = Arc::new(Stroke { color, ..Stroke::clone(&s.stroke) });
                Ok(())
            }),
            Self::SetSketch(sketch) => settings(plant, |s| s.sketch = *sketch),
            Self::SetSkin(skin) => settings(plant, |s| s.skin = SkinSpec { seed: s.skin.seed, ..skin }),
            Self::SetPhoto(photo) => settings(plant, |s| s.photo = Some(*photo)),
            Self::PlacePhoto(place) => {
                if plant.settings.photo().is_none() {
                    return Err(CommandError::NoPhoto);
                }
                settings(plant, |s| s.photo.iter_mut().for_each(|p| p.place = place))
            }
            Self::RemovePhoto => settings(plant, |s| s.photo = None),
            Self::SetDay(day) => settings(plant, |s| s.day = day),
            Self::SetLeaf(leaf) => {
                may_bear(plant, leaf, document)?;
                settings(plant, |s| s.leaf = leaf)
            }
        }
    }
}

fn settings(plant: &DocumentPlant, change: impl FnOnce(&mut SketchSettings)) -> Result<Event, CommandError> {
    set(plant, |s| {
        if let Maker::Sketch(s) = &mut s.maker {
            change(s);
        }
        Ok(())
    })
}

fn add(strokes: Vec<NewStroke>, plant: &DocumentPlant, document: &Document) -> Result<Event, CommandError> {
    let mut next = document.next_stroke;
    let mut rows = Vec::with_capacity(strokes.len());
    for new in strokes {
        let Some(stroke) = sound(new.stroke) else { continue };
        let id = StrokeId(next);
        next = next.checked_add(1).ok_or(CommandError::Full("strokes"))?;
        let row = plant.strokes.len() + rows.len();
        rows.push((row, DocumentStroke { id, stroke: Arc::new(stroke), class: new.class }));
    }
    if rows.is_empty() {
        return Err(CommandError::Nothing("the stroke has no point"));
    }
    Ok(Event::Added { plant: plant.id, rows, next_stroke: (document.next_stroke, next) })
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

fn duplicate(
    ids: &[StrokeId],
    by: DVec2,
    plant: &DocumentPlant,
    document: &Document,
) -> Result<Event, CommandError> {
    let copies = rows(ids, plant)?.into_iter().map(|row| {
        let s = &plant.strokes[row];
        Ok(NewStroke { stroke: moved(&s.stroke, by)?, class: s.class })
    });
    add(copies.collect::<Result<_, CommandError>>()?, plant, document)
}

fn rows(ids: &[StrokeId], plant: &DocumentPlant) -> Result<Vec<usize>, CommandError> {
    let wanted: BTreeSet<StrokeId> = ids.iter().copied().collect();
    let found = plant.strokes.iter().enumerate().filter(|(_, s)| wanted.contains(&s.id));
    let found: Vec<usize> = found.map(|(row, _)| row).collect();
    if found.len() < wanted.len() {
        let missing = wanted.into_iter().find(|&id| plant.row(id).is_none());
        return Err(missing.map_or(CommandError::Nothing("no stroke"), CommandError::NoSuchStroke));
    }
    Ok(found)
}

fn remove(rows: &[usize], plant: &DocumentPlant) -> Result<Event, CommandError> {
    if rows.is_empty() {
        return Err(CommandError::Nothing("there is no stroke to erase"));
    }
    let rows = rows.iter().filter_map(|&row| Some((row, plant.strokes.get(row)?.clone()))).collect();
    Ok(Event::Removed { plant: plant.id, rows })
}

fn edit(
    ids: &[StrokeId],
    plant: &DocumentPlant,
    mut change: impl FnMut(&mut DocumentStroke) -> Result<(), CommandError>,
) -> Result<Event, CommandError> {
    let mut changed = Vec::new();
    for row in rows(ids, plant)? {
        let before = plant.strokes[row].clone();
        let mut after = before.clone();
        change(&mut after)?;
        if after != before {
            changed.push((row, before, after));
        }
    }
    if changed.is_empty() {
        return Err(CommandError::Nothing("the strokes are like that already"));
    }
    Ok(Event::Edited { plant: plant.id, rows: changed })
}
