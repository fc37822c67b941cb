//! Commands of sketches: strokes and their interpretation.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec2;
use ink::{InkSample, Layer, Stroke, StrokeClass, StrokeMode, StrokePull, StrokeTurn};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sketch::SketchSpec;
use skin::{OrganMaterial, SkinSpec};

use super::{Command, CommandError, may_bear, set};
use crate::event::Event;
use crate::makers::{Maker, SketchSettings};
use crate::names::shortened;
use crate::picture::material_fault;
use crate::state::{is_width, sound};
use crate::{Document, DocumentPlant, DocumentStroke, Photo, PhotoPlace, PlantId, StrokeId};

/// A stroke to be added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NewStroke {
    /// The line as drawn.
    pub stroke: Stroke,
    /// The class, if the user set it.
    pub class: Option<StrokeClass>,
    /// The class that the user was shown; only of strokes that are copied with all others.
    pub shown: Option<StrokeClass>,
    /// The material, if the user chose one.
    pub material: Option<Arc<OrganMaterial>>,
}

impl NewStroke {
    /// Makes a bare line in `parts` mode.
    pub fn line(points: &[DVec2]) -> Self {
        let samples = points.iter().map(|&p| InkSample::from(p)).collect();
        Self::from(Stroke { samples, ..Stroke::default() })
    }

    /// Makes a copy of a stroke for another plant, with its class and material.
    pub fn from_stroke(stroke: &DocumentStroke) -> Self {
        let DocumentStroke { stroke, class, shown, material, .. } = stroke;
        Self { stroke: Stroke::clone(stroke), class: *class, shown: *shown, material: material.clone() }
    }
}

impl From<Stroke> for NewStroke {
    /// A stroke of which nothing was said.
    fn from(stroke: Stroke) -> Self {
        Self { stroke, ..Self::default() }
    }
}

/// Commands that change a sketch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SketchCommand {
    /// Adds strokes after the others. Points that are not finite are left out.
    #[serde(skip)]
    AddStrokes(Vec<NewStroke>),
    /// Adds a drawn stroke, and records the classes in which strokes were shown when it was drawn: a class, or none for
    /// those whose class was not clear. Others keep theirs.
    #[serde(skip)]
    Draw(NewStroke, Vec<(StrokeId, Option<StrokeClass>)>),
    /// Adds moved copies of strokes after the others, with what was said of them.
    Duplicate(Vec<StrokeId>, #[schemars(with = "[f64; 2]")] DVec2),
    /// Erases strokes.
    RemoveStrokes(Vec<StrokeId>),
    /// Moves strokes, in the drawing's unit, y up.
    MoveStrokes(Vec<StrokeId>, #[schemars(with = "[f64; 2]")] DVec2),
    /// Turns and scales strokes about a point.
    TurnStrokes(Vec<StrokeId>, StrokeTurn),
    /// Bends strokes by pulling at them.
    PullStrokes(Vec<StrokeId>, StrokePull),
    /// Gives a stroke other points: what a hand drew was meant as a line or an arc.
    #[serde(skip)]
    Straighten(StrokeId, Vec<InkSample>),
    /// Smooths strokes once more.
    SmoothStrokes(Vec<StrokeId>),
    /// Cuts strokes in two at their point nearest to this one.
    CutStrokes(Vec<StrokeId>, #[schemars(with = "[f64; 2]")] DVec2),
    /// Joins several strokes into one, in the place of the first.
    JoinStrokes(Vec<StrokeId>),
    /// Erases the parts of all strokes that lie within a radius of a path.
    RubOut(#[schemars(with = "Vec<[f64; 2]>")] Vec<DVec2>, f64),
    /// Sets the class of strokes, or leaves it to the classifier again.
    SetClass(Vec<StrokeId>, Option<StrokeClass>),
    /// Sets the mode of strokes.
    SetMode(Vec<StrokeId>, StrokeMode),
    /// Gives strokes a colour, or takes it away.
    SetColor(Vec<StrokeId>, Option<[u8; 3]>),
    /// Sets the width of the pen of strokes, in the drawing's unit, or takes it away.
    SetWidth(Vec<StrokeId>, Option<f64>),
    /// Gives the organs of strokes a material, or takes it away. A picture that the material names is one of the
    /// plant's.
    SetMaterial(Vec<StrokeId>, Option<OrganMaterial>),
    /// Adds a layer of this name above the others.
    AddLayer(String),
    /// Renames, hides or locks the layer of a row, from below. Its strokes stay on it.
    SetLayer(usize, Layer),
    /// Moves the layer of a row to another row.
    MoveLayer(usize, usize),
    /// Removes the layer of a row; its strokes move to the sheet itself.
    RemoveLayer(usize),
    /// Puts strokes on a layer, by its name, or on the sheet itself.
    PutOn(Vec<StrokeId>, Option<String>),
    /// Erases every stroke, except those on layers that are hidden or locked.
    Clear,
    /// Sets how the drawing is interpreted.
    SetSketch(Box<SketchSpec>),
    /// Sets how the plant is meshed and coloured.
    SetSkin(SkinSpec),
    /// Puts a photograph under the drawing.
    #[serde(skip)]
    SetPhoto(Box<Photo>),
    /// Changes how the photograph lies under the drawing.
    PlacePhoto(PhotoPlace),
    /// Removes the photograph.
    RemovePhoto,
    /// Shows its flowers on a day, or as they are drawn.
    SetDay(Option<f64>),
    /// Takes the leaf of another plant, or its own again.
    SetLeaf(Option<PlantId>),
}

impl SketchCommand {
    /// Returns the command for a plant.
    pub fn for_plant(self, plant: PlantId) -> Command {
        Command::Sketch(plant, self)
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::AddStrokes(_) | Self::Draw(..) => "draw",
            Self::Duplicate(..) => "duplicate",
            Self::RemoveStrokes(_) => "erase",
            Self::MoveStrokes(..) => "move",
            Self::TurnStrokes(..) => "turn",
            Self::PullStrokes(..) => "pull",
            Self::Straighten(..) => "straighten",
            Self::SmoothStrokes(_) => "smooth",
            Self::CutStrokes(..) => "cut",
            Self::JoinStrokes(_) => "join",
            Self::RubOut(..) => "rub",
            Self::SetClass(..) => "class",
            Self::SetMode(..) => "mode",
            Self::SetColor(..) => "color",
            Self::SetWidth(..) => "width",
            Self::SetMaterial(..) => "material",
            Self::AddLayer(_) | Self::SetLayer(..) | Self::MoveLayer(..) | Self::RemoveLayer(_) => "layer",
            Self::PutOn(..) => "put-on",
            Self::Clear => "clear",
            Self::SetSketch(_) => "sketch",
            Self::SetSkin(_) => "skin",
            Self::SetPhoto(_) | Self::PlacePhoto(_) | Self::RemovePhoto => "photo",
            Self::SetDay(_) => "day",
            Self::SetLeaf(_) => "leaf-of",
        }
    }

    pub(super) fn decide(
        self,
        plant: &DocumentPlant,
        document: &Document,
    ) -> Result<Vec<Event>, CommandError> {
        if plant.settings.sketch().is_none() {
            let found = plant.settings.maker.word();
            return Err(CommandError::OtherMaker { wanted: "sketch", found });
        }
        let event = match self {
            Self::CutStrokes(ids, at) => {
                let cut = |s: &Stroke| ink::cut(s, at).map(Vec::from);
                return replace(&rows(&ids, plant)?, plant, document, cut);
            }
            Self::JoinStrokes(ids) => return join(&rows(&ids, plant)?, plant, document),
            Self::RubOut(path, radius) => {
                return replace(&within_reach(plant), plant, document, |s| ink::rubbed(s, &path, radius));
            }
            Self::Draw(stroke, shown) => {
                let added = add(vec![stroke], plant, document)?;
                let shown = base::map_of(shown);
                let ids: Vec<StrokeId> =
                    shown.keys().copied().filter(|id| plant.row(*id).is_some()).collect();
                let kept = edit(&ids, plant, |s| {
                    s.shown = shown.get(&s.id).copied().flatten();
                    Ok(())
                });
                return Ok(kept.into_iter().chain([added]).collect());
            }
            Self::AddStrokes(strokes) => add(strokes, plant, document),
            Self::Duplicate(ids, by) => duplicate(&ids, by, plant, document),
            Self::RemoveStrokes(ids) => remove(&rows(&ids, plant)?, plant),
            Self::Clear => remove(&within_reach(plant), plant),
            Self::MoveStrokes(ids, by) => redraw(&ids, plant, |s| moved(s, by)),
            Self::TurnStrokes(ids, turn) => redraw(&ids, plant, |s| turn.apply(s)),
            Self::PullStrokes(ids, pull) => redraw(&ids, plant, |s| pull.apply(s)),
            Self::Straighten(_, samples) if samples.is_empty() => {
                return Err(CommandError::Nothing("the stroke has no point"));
            }
            Self::Straighten(id, samples) => {
                redraw(&[id], plant, |s| Stroke { samples: samples.clone(), ..s.clone() })
            }
            Self::SmoothStrokes(ids) => redraw(&ids, plant, ink::smoothed),
            Self::SetClass(ids, class) => edit(&ids, plant, |s| {
                (s.class, s.shown) = (class, None);
                Ok(())
            }),
            Self::SetMode(ids, mode) => redraw(&ids, plant, |s| Stroke { mode, ..s.clone() }),
            Self::SetColor(ids, color) => redraw(&ids, plant, |s| Stroke { color, ..s.clone() }),
            Self::SetWidth(_, Some(width)) if !is_width(width) => return Err(CommandError::TooFar),
            Self::SetWidth(ids, width) => redraw(&ids, plant, |s| Stroke { width, ..s.clone() }),
            Self::SetMaterial(ids, material) => return wear(&ids, material, plant),
            Self::AddLayer(name) => {
                let layer = Layer { name: shortened(name.trim()).into(), ..Layer::default() };
                settings(plant, |s| s.layers.push(layer))
            }
            Self::SetLayer(row, layer) => return set_layer(row, layer, plant),
            Self::MoveLayer(from, to) => {
                let rows = plant.layers().len();
                if from >= rows || to >= rows {
                    return Err(NO_LAYER);
                }
                settings(plant, |s| {
                    let layer = s.layers.remove(from);
                    s.layers.insert(to, layer);
                })
            }
            Self::RemoveLayer(row) => return remove_layer(row, plant),
            Self::PutOn(ids, name) => {
                let name = name.map(Arc::from);
                let to = name.as_ref().map(|n| plant.layers().iter().find(|l| l.name == *n).ok_or(NO_LAYER));
                if let Some(layer) = to.transpose()? {
                    open_to_hand(Some(layer))?;
                }
                redraw(&ids, plant, |s| Stroke { layer: name.clone(), ..s.clone() })
            }
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
        };
        event.map(|event| vec![event])
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
    for NewStroke { stroke, class, shown, material } in strokes {
        let Some(mut stroke) = sound(stroke) else { continue };
        // A layer of another drawing does not exist in this one.
        let layer = stroke.layer.take();
        let layer = layer.and_then(|name| plant.layers().iter().find(|l| l.name == name));
        open_to_hand(layer)?;
        stroke.layer = layer.map(|l| Arc::clone(&l.name));
        let id = StrokeId(next);
        next = next.checked_add(1).ok_or(CommandError::Full("strokes"))?;
        let row = plant.strokes.len() + rows.len();
        rows.push((row, DocumentStroke { id, stroke: Arc::new(stroke), class, shown, material }));
    }
    if rows.is_empty() {
        return Err(CommandError::Nothing("the stroke has no point"));
    }
    Ok(Event::Added { plant: plant.id, rows, next_stroke: (document.next_stroke, next) })
}

fn moved(stroke: &Stroke, by: DVec2) -> Stroke {
    let mut stroke = stroke.clone();
    stroke.samples.iter_mut().for_each(|s| s.at += by);
    stroke
}

fn near(stroke: Stroke) -> Result<Stroke, CommandError> {
    if stroke.samples.iter().all(|s| s.at.is_finite()) { Ok(stroke) } else { Err(CommandError::TooFar) }
}

/// Changes the points of strokes that keep their class.
fn redraw(
    ids: &[StrokeId],
    plant: &DocumentPlant,
    change: impl Fn(&Stroke) -> Stroke,
) -> Result<Event, CommandError> {
    edit(ids, plant, |s| {
        s.stroke = Arc::new(near(change(&s.stroke))?);
        Ok(())
    })
}

/// Replaces strokes by others: the first of them keeps number and class, the others take the class. `change` returns
/// `None` for a stroke that stays as it is.
fn replace(
    rows: &[usize],
    plant: &DocumentPlant,
    document: &Document,
    change: impl Fn(&Stroke) -> Option<Vec<Stroke>>,
) -> Result<Vec<Event>, CommandError> {
    let mut next = document.next_stroke;
    let (mut gone, mut come) = (Vec::new(), Vec::new());
    // Difference in the number of strokes before the current row, new minus old.
    let mut more = 0;
    for &row in rows {
        let old = &plant.strokes[row];
        let Some(pieces) = change(&old.stroke) else { continue };
        let base = row + more - gone.len();
        for (k, piece) in pieces.into_iter().enumerate() {
            let id = if k == 0 { old.id } else { StrokeId(next) };
            if k > 0 {
                next = next.checked_add(1).ok_or(CommandError::Full("strokes"))?;
            }
            let stroke = Arc::new(near(piece)?);
            come.push((base + k, DocumentStroke { id, stroke, shown: None, ..old.clone() }));
            more += 1;
        }
        gone.push((row, old.clone()));
    }
    if gone.is_empty() {
        return Err(CommandError::Nothing("no stroke is there"));
    }
    let mut events = vec![Event::Removed { plant: plant.id, rows: gone }];
    if !come.is_empty() {
        let next_stroke = (document.next_stroke, next);
        events.push(Event::Added { plant: plant.id, rows: come, next_stroke });
    }
    Ok(events)
}

fn join(rows: &[usize], plant: &DocumentPlant, document: &Document) -> Result<Vec<Event>, CommandError> {
    let strokes: Vec<&Stroke> = rows.iter().map(|&row| plant.strokes[row].stroke.as_ref()).collect();
    let (Some(whole), [first, _, ..]) = (ink::joined(&strokes), rows) else {
        return Err(CommandError::Nothing("choose two strokes or more to join"));
    };
    let old = &plant.strokes[*first];
    let come = vec![(*first, DocumentStroke { stroke: Arc::new(near(whole)?), shown: None, ..old.clone() })];
    let gone = rows.iter().map(|&row| (row, plant.strokes[row].clone())).collect();
    let next_stroke = (document.next_stroke, document.next_stroke);
    Ok(vec![
        Event::Removed { plant: plant.id, rows: gone },
        Event::Added { plant: plant.id, rows: come, next_stroke },
    ])
}

fn duplicate(
    ids: &[StrokeId],
    by: DVec2,
    plant: &DocumentPlant,
    document: &Document,
) -> Result<Event, CommandError> {
    let copies = rows(ids, plant)?.into_iter().map(|row| {
        let s = &plant.strokes[row];
        Ok(NewStroke { stroke: near(moved(&s.stroke, by))?, shown: None, ..NewStroke::from_stroke(s) })
    });
    add(copies.collect::<Result<_, CommandError>>()?, plant, document)
}

fn rows(ids: &[StrokeId], plant: &DocumentPlant) -> Result<Vec<usize>, CommandError> {
    let mut wanted = BTreeSet::new();
    wanted.extend(ids.iter().copied());
    let found = plant.strokes.iter().enumerate().filter(|(_, s)| wanted.contains(&s.id));
    let found: Vec<usize> = found.map(|(row, _)| row).collect();
    if found.len() < wanted.len() {
        let missing = wanted.into_iter().find(|&id| plant.row(id).is_none());
        return Err(missing.map_or(CommandError::Nothing("no stroke"), CommandError::NoSuchStroke));
    }
    found.iter().try_for_each(|&row| open_to_hand(plant.layer_of(&plant.strokes[row])))?;
    Ok(found)
}

/// Returns the rows of strokes that are neither hidden nor locked.
fn within_reach(plant: &DocumentPlant) -> Vec<usize> {
    let open = |&row: &usize| open_to_hand(plant.layer_of(&plant.strokes[row])).is_ok();
    (0..plant.strokes.len()).filter(open).collect()
}

/// Checks that strokes on a layer may be changed.
fn open_to_hand(layer: Option<&Layer>) -> Result<(), CommandError> {
    match layer.filter(|l| l.hidden || l.locked) {
        Some(layer) => Err(CommandError::Locked(layer.name.to_string())),
        None => Ok(()),
    }
}

const NO_LAYER: CommandError = CommandError::Nothing("the layer is not there any more");

/// Moves the strokes of a layer to another.
fn relayered(from: &Arc<str>, to: Option<&Arc<str>>, plant: &DocumentPlant) -> Option<Event> {
    let on = plant.strokes.iter().enumerate().filter(|(_, s)| s.stroke.layer.as_ref() == Some(from));
    let rows: Vec<_> = on
        .map(|(row, before)| {
            let stroke = Stroke { layer: to.cloned(), ..Stroke::clone(&before.stroke) };
            (row, before.clone(), DocumentStroke { stroke: Arc::new(stroke), ..before.clone() })
        })
        .collect();
    (!rows.is_empty()).then_some(Event::Edited { plant: plant.id, rows })
}

fn set_layer(row: usize, layer: Layer, plant: &DocumentPlant) -> Result<Vec<Event>, CommandError> {
    let before = plant.layers().get(row).ok_or(NO_LAYER)?;
    let after = Layer { name: shortened(layer.name.trim()).into(), ..layer };
    let moved = (before.name != after.name).then(|| relayered(&before.name, Some(&after.name), plant));
    let set = settings(plant, |s| s.layers[row] = after)?;
    Ok(core::iter::once(set).chain(moved.flatten()).collect())
}

fn remove_layer(row: usize, plant: &DocumentPlant) -> Result<Vec<Event>, CommandError> {
    let gone = plant.layers().get(row).ok_or(NO_LAYER)?;
    let moved = relayered(&gone.name, None, plant);
    let set = settings(plant, |s| {
        s.layers.remove(row);
    })?;
    Ok(moved.into_iter().chain([set]).collect())
}

/// Sets the material of strokes, and drops pictures of the plant that nothing uses any more.
fn wear(
    ids: &[StrokeId],
    material: Option<OrganMaterial>,
    plant: &DocumentPlant,
) -> Result<Vec<Event>, CommandError> {
    if let Some(fault) = material.as_ref().and_then(|m| material_fault(m, &plant.settings.pictures)) {
        return Err(CommandError::OutOfRange(fault));
    }
    let material = material.map(Arc::new);
    let edited = edit(ids, plant, |s| {
        s.material.clone_from(&material);
        Ok(())
    })?;
    let others = plant.strokes.iter().filter(|s| !ids.contains(&s.id)).filter_map(|s| s.material.as_deref());
    let mut after = plant.settings.clone();
    after.keep_pictures(others.chain(material.as_deref()));
    let mut events = vec![edited];
    if after != plant.settings {
        let (before, after) = (Box::new(plant.settings.clone()), Box::new(after));
        events.push(Event::Set { plant: plant.id, before, after });
    }
    Ok(events)
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
