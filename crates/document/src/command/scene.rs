//! Commands of the scene, and those common to all plants.

use base::{Seed, ops};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use skin::{OrganMaterial, Wearer};

use super::{Command, CommandError, NewStroke, plant, set};
use crate::event::Event;
use crate::names::{NAME_LENGTH, shortened};
use crate::state::{MAX_PLANTS, Placement, Settings, range_fault, sound};
use crate::{Document, DocumentPlant, DocumentStroke, PlantId, StrokeId, WornPicture};

/// A plant to be added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NewPlant {
    /// All its data except the strokes.
    pub settings: Settings,
    /// Strokes of a sketch; ignored for other makers.
    pub strokes: Vec<NewStroke>,
}

/// Commands of the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SceneCommand {
    /// Renames the scene.
    Rename(String),
    /// Adds a plant after the others.
    #[serde(skip)]
    Add(Box<NewPlant>),
    /// Adds a copy of a plant after the others, moved by an offset in metres.
    Duplicate(PlantId, #[schemars(with = "[f64; 3]")] DVec3),
    /// Adds copies of plants after the others, moved by an offset in metres. They form a new group, named after that of
    /// the first plant; copies of plants without a group have none.
    DuplicateAll(Vec<PlantId>, #[schemars(with = "[f64; 3]")] DVec3),
    /// Moves, turns and scales plants as one unit.
    Carry(Vec<PlantId>, Carry),
    /// Deletes plants; a plant that bore the leaf of one bears its own again.
    Remove(Vec<PlantId>),
    /// Replaces this document by another.
    #[serde(skip)]
    Open(Box<Document>),
}

impl SceneCommand {
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Rename(_) => "rename-scene",
            Self::Add(_) => "add-plant",
            Self::Duplicate(..) | Self::DuplicateAll(..) => "duplicate-plant",
            Self::Carry(..) => "place",
            Self::Remove(_) => "remove-plant",
            Self::Open(_) => "open",
        }
    }

    pub(super) fn decide(self, document: &Document) -> Result<Vec<Event>, CommandError> {
        match self {
            Self::Rename(name) => {
                let (before, after) = (document.name.clone(), shortened(name.trim()));
                if before == after {
                    return Err(CommandError::Nothing("the scene has that name already"));
                }
                Ok(vec![Event::Renamed { before, after }])
            }
            Self::Add(new) => add(*new, document).map(|e| vec![e]),
            Self::Duplicate(id, by) => add(copy(id, by, document)?, document).map(|e| vec![e]),
            Self::DuplicateAll(ids, by) => duplicate_all(&ids, by, document),
            Self::Carry(ids, how) => carry(&ids, how, document),
            Self::Remove(ids) => remove(&ids, document),
            Self::Open(other) => Ok(vec![Event::Opened { before: Box::new(document.clone()), after: other }]),
        }
    }
}

impl From<SceneCommand> for Command {
    fn from(command: SceneCommand) -> Self {
        Self::Scene(command)
    }
}

/// A common movement of plants: scaled and turned about a point, then moved. Every plant keeps its place among the
/// others.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Carry {
    /// Fixed point of the scaling and turning, metres.
    #[schemars(with = "[f64; 3]")]
    pub about: DVec3,
    /// Offset, metres.
    #[schemars(with = "[f64; 3]")]
    pub by: DVec3,
    /// Turn about +Y, degrees, counter-clockwise seen from above.
    pub turn_deg: f64,
    /// Factor on their size, above 0.
    pub scale: f64,
}

impl Carry {
    /// Returns the new placement of a plant that stood at `from`, rounded to the millimetre, the tenth of a degree and
    /// the thousandth, as people place plants.
    fn place(&self, from: Placement) -> Placement {
        let (sin, cos) = ops::sin_cos(self.turn_deg.to_radians());
        let arm = (from.position - self.about) * self.scale;
        let turned = DVec3::new(cos * arm.x + sin * arm.z, arm.y, cos * arm.z - sin * arm.x);
        let to = |x: f64, parts: f64| (x * parts).round() / parts;
        let position = self.about + turned + self.by;
        Placement {
            position: DVec3::new(to(position.x, 1e3), to(position.y, 1e3), to(position.z, 1e3)),
            yaw_deg: to(from.yaw_deg + self.turn_deg, 10.0),
            scale: to(from.scale * self.scale, 1e3),
        }
    }
}

fn carry(ids: &[PlantId], how: Carry, document: &Document) -> Result<Vec<Event>, CommandError> {
    let mut events = Vec::new();
    for (row, &id) in ids.iter().enumerate() {
        let plant = plant(id, document)?;
        if ids[..row].contains(&id) {
            continue;
        }
        let to = how.place(plant.settings.placement);
        match PlantCommand::Place(to).decide(plant) {
            Ok(event) => events.push(event),
            Err(CommandError::Nothing(_)) => {}
            Err(e) => return Err(e),
        }
    }
    if events.is_empty() { Err(CommandError::Nothing("they stand like that already")) } else { Ok(events) }
}

/// Makes a moved copy of a plant, with its place unlocked.
fn copy(id: PlantId, by: DVec3, document: &Document) -> Result<NewPlant, CommandError> {
    let DocumentPlant { settings, strokes, .. } = plant(id, document)?.clone();
    let mut new = NewPlant { settings, strokes: strokes.iter().map(NewStroke::from_stroke).collect() };
    new.settings.placement.position += by;
    new.settings.fixed = false;
    Ok(new)
}

fn duplicate_all(ids: &[PlantId], by: DVec3, document: &Document) -> Result<Vec<Event>, CommandError> {
    let Some(&first) = ids.first() else {
        return Err(CommandError::Nothing("there is no plant to copy"));
    };
    let group = document.free_group(&plant(first, document)?.settings.group);
    // Each copy is numbered after the one before.
    let mut grown = document.clone();
    let mut events = Vec::new();
    for &id in ids {
        let mut new = copy(id, by, document)?;
        new.settings.group.clone_from(&group);
        let event = add(new, &grown)?;
        event.apply(&mut grown);
        events.push(event);
    }
    Ok(events)
}

fn add(mut new: NewPlant, document: &Document) -> Result<Event, CommandError> {
    if document.plants.len() >= MAX_PLANTS {
        return Err(CommandError::Full("plants"));
    }
    let after = document.next_plant.checked_add(1).ok_or(CommandError::Full("plants"))?;
    new.settings.name = shortened(new.settings.name.trim());
    new.settings.group = shortened(new.settings.group.trim());
    if let Some(fault) = range_fault(&new.settings) {
        return Err(CommandError::OutOfRange(fault));
    }
    if new.settings.maker.leaf().is_some_and(|l| !document.lends_leaf(l)) {
        return Err(CommandError::NoLeaf);
    }
    let mut next = document.next_stroke;
    let mut strokes = Vec::new();
    if new.settings.sketch().is_some() {
        for s in new.strokes {
            let Some(stroke) = sound(s.stroke.clone()) else { continue };
            let NewStroke { class, shown, material, .. } = s;
            strokes.push(DocumentStroke {
                id: StrokeId(next),
                stroke: stroke.into(),
                class,
                shown,
                material,
            });
            next = next.checked_add(1).ok_or(CommandError::Full("strokes"))?;
        }
    }
    let plant = DocumentPlant { id: PlantId(document.next_plant), settings: new.settings, strokes };
    Ok(Event::PlantAdded {
        row: document.plants.len(),
        plant: Box::new(plant),
        next_plant: (document.next_plant, after),
        next_stroke: (document.next_stroke, next),
    })
}

fn remove(ids: &[PlantId], document: &Document) -> Result<Vec<Event>, CommandError> {
    for &id in ids {
        plant(id, document)?;
    }
    let (gone, kept): (Vec<_>, Vec<_>) =
        document.plants.iter().enumerate().partition(|(_, p)| ids.contains(&p.id));
    if gone.is_empty() {
        return Err(CommandError::Nothing("there is no plant to delete"));
    }
    let mut events = Vec::new();
    for (_, p) in kept {
        if p.settings.maker.leaf().is_some_and(|l| ids.contains(&l)) {
            let mut after = p.settings.clone();
            after.maker.set_leaf(None);
            events.push(Event::Set {
                plant: p.id,
                before: Box::new(p.settings.clone()),
                after: Box::new(after),
            });
        }
    }
    // From the last to the first: each row refers to the scene before its own event.
    events.extend(
        gone.into_iter().rev().map(|(row, p)| Event::PlantRemoved { row, plant: Box::new(p.clone()) }),
    );
    Ok(events)
}

/// Commands of any plant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum PlantCommand {
    /// Renames it.
    Rename(String),
    /// Sets its seed; text as JSON, because JavaScript's numbers hold 53 bits.
    SetSeed(
        #[serde(with = "as_text")]
        #[schemars(with = "String")]
        Seed,
    ),
    /// Locks or unlocks its seed for dice.
    Lock(bool),
    /// Hides it from the view, or shows it again.
    Hide(bool),
    /// Puts it into the group of a name; an empty name takes it out of its group.
    Group(String),
    /// Sets its placement.
    Place(Placement),
    /// Locks or unlocks its place. A copy is always unlocked.
    Fix(bool),
    /// Gives the organs of a kind a material, or takes it away. A picture that the material names is one of the
    /// plant's.
    Wear(Wearer, Option<OrganMaterial>),
    /// Adds a picture that materials may name.
    #[serde(skip)]
    AddPicture(WornPicture),
}

impl PlantCommand {
    /// Returns the command for a plant.
    pub fn for_plant(self, plant: PlantId) -> Command {
        Command::Plant(plant, self)
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Rename(_) => "rename",
            Self::SetSeed(_) => "seed",
            Self::Lock(_) => "lock",
            Self::Hide(_) => "hide",
            Self::Group(_) => "group",
            Self::Place(_) => "place",
            Self::Fix(_) => "fix",
            Self::Wear(..) | Self::AddPicture(_) => "material",
        }
    }

    pub(super) fn decide(self, plant: &DocumentPlant) -> Result<Event, CommandError> {
        set(plant, |s| {
            match self {
                Self::Wear(wearer, material) => {
                    s.wear.set(wearer, material);
                    let worn = plant.strokes.iter().filter_map(|s| s.material.as_deref());
                    s.keep_pictures(worn);
                }
                Self::AddPicture(picture) => {
                    s.pictures.insert(picture.name(), picture);
                }
                Self::Rename(name) => {
                    s.name = shortened(name.trim());
                    debug_assert!(s.name.chars().count() <= NAME_LENGTH, "shortened");
                }
                Self::SetSeed(seed) => s.seed = seed,
                Self::Lock(on) => s.locked = on,
                Self::Hide(on) => s.hidden = on,
                Self::Group(name) => s.group = shortened(name.trim()),
                Self::Place(_) if s.fixed => return Err(CommandError::Fixed),
                Self::Place(placement) => s.placement = placement,
                Self::Fix(on) => s.fixed = on,
            }
            Ok(())
        })
    }
}

/// A seed as text.
mod as_text {
    use base::Seed;
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::Serializer;

    pub(super) fn serialize<S: Serializer>(seed: &Seed, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(&seed.number())
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Seed, D::Error> {
        let text = String::deserialize(from)?;
        text.parse()
            .map(Seed::new)
            .map_err(|_digits| Error::custom("the seed is a whole number from 0 to 2^64 - 1"))
    }
}
