//! Commands on a document. A command is checked and becomes events, or an error and no change.

mod makers;
mod scene;
mod shape;
mod sketch;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::event::Event;
use crate::state::{Settings, range_fault};
use crate::{Document, DocumentPlant, PlantId, SettingFault, StrokeId};

pub use self::shape::ShapeCommand;
pub use makers::{FlowerCommand, LeafCommand, TreeCommand};
pub use scene::{Carry, NewPlant, PlantCommand, SceneCommand};
pub use sketch::{NewStroke, SketchCommand};

/// A command on a document: on the scene, on any plant, or on a plant of one maker.
///
/// As JSON, nested by maker: `{"sketch": [0, {"move-strokes": [[3, 4], [0.5, 0]]}]}`. Commands that carry strokes,
/// pictures or whole documents have no JSON form: they travel as bytes.
///
/// ```
/// use document::{Command, PlantCommand, PlantId};
/// let command: Command = serde_json::from_str(r#"{"plant":[0,{"set-seed":"18446744073709551615"}]}"#)?;
/// assert_eq!(command, PlantCommand::SetSeed(base::Seed::new(u64::MAX)).for_plant(PlantId(0)));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Command {
    /// Adds, removes and moves plants.
    Scene(SceneCommand),
    /// Name, seed and place of a plant.
    Plant(PlantId, PlantCommand),
    /// Hand edits of a plant with branches.
    Shape(PlantId, ShapeCommand),
    /// Strokes and settings of a sketch.
    Sketch(PlantId, SketchCommand),
    /// Spec and obstacles of a tree.
    Tree(PlantId, TreeCommand),
    /// Marks and surface of a leaf.
    Leaf(PlantId, LeafCommand),
    /// Species and day of a flower.
    Flower(PlantId, FlowerCommand),
}

/// Reason why a command was refused; the document is unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CommandError {
    /// There is no stroke of this number.
    #[error("there is no stroke {}; it may have been erased", .0.0)]
    NoSuchStroke(StrokeId),
    /// There is no plant of this number.
    #[error("there is no plant {}; it may have been deleted", .0.0)]
    NoSuchPlant(PlantId),
    /// The plant has another maker.
    #[error("the plant is a {found}, not a {wanted}")]
    OtherMaker {
        /// The maker that the command needs.
        wanted: &'static str,
        /// The maker of the plant.
        found: &'static str,
    },
    /// The chosen plant has no leaf to lend.
    #[error("that plant has no leaf of its own to lend; choose a measured leaf or a sketch")]
    NoLeaf,
    /// There is no photograph to move.
    #[error("there is no photograph under the drawing")]
    NoPhoto,
    /// The place of the plant is locked.
    #[error("the place of the plant is locked; unlock it to move, turn or size it")]
    Fixed,
    /// The stroke lies on a layer that is hidden or locked.
    #[error("the layer {0:?} is hidden or locked; show and unlock it first")]
    Locked(String),
    /// Nothing would change.
    #[error("nothing to do: {0}")]
    Nothing(&'static str),
    /// A setting is out of its range.
    #[error(transparent)]
    OutOfRange(SettingFault),
    /// A field of a spec cannot be set to this value.
    #[error(transparent)]
    Spec(#[from] spec::SpecFault),
    /// A coordinate would leave the range of numbers.
    #[error("a stroke cannot be moved that far")]
    TooFar,
    /// Strokes and plants are numbered with 32 bits; a scene holds 200 plants.
    #[error("the document holds as many {0} as it can; start a new one")]
    Full(&'static str),
    /// A gesture is open and this command needs it closed, or the reverse.
    #[error("{0}")]
    Gesture(&'static str),
}

impl Command {
    /// Returns the name of its undo step: a key that the user interface translates.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Scene(c) => c.name(),
            Self::Plant(_, c) => c.name(),
            Self::Shape(_, c) => c.name(),
            Self::Sketch(_, c) => c.name(),
            Self::Tree(_, c) => c.name(),
            Self::Leaf(_, c) => c.name(),
            Self::Flower(_, c) => c.name(),
        }
    }

    /// Checks the command against a document and returns its events.
    pub(crate) fn decide(self, document: &Document) -> Result<Vec<Event>, CommandError> {
        let one = |event| vec![event];
        match self {
            Self::Scene(c) => c.decide(document),
            Self::Plant(id, c) => c.decide(plant(id, document)?).map(one),
            Self::Shape(id, c) => c.decide(plant(id, document)?).map(one),
            Self::Sketch(id, c) => c.decide(plant(id, document)?, document),
            Self::Tree(id, c) => c.decide(plant(id, document)?, document).map(one),
            Self::Leaf(id, c) => c.decide(plant(id, document)?).map(one),
            Self::Flower(id, c) => c.decide(plant(id, document)?).map(one),
        }
    }
}

fn plant(id: PlantId, document: &Document) -> Result<&DocumentPlant, CommandError> {
    document.plant(id).ok_or(CommandError::NoSuchPlant(id))
}

/// Returns the event of changed settings.
fn set(
    plant: &DocumentPlant,
    change: impl FnOnce(&mut Settings) -> Result<(), CommandError>,
) -> Result<Event, CommandError> {
    let before = plant.settings.clone();
    let mut after = before.clone();
    change(&mut after)?;
    if after == before {
        return Err(CommandError::Nothing("the setting is like that already"));
    }
    match range_fault(&after) {
        Some(fault) => Err(CommandError::OutOfRange(fault)),
        None => Ok(Event::Set { plant: plant.id, before: Box::new(before), after: Box::new(after) }),
    }
}

/// Whether a plant may bear the leaf of another.
fn may_bear(plant: &DocumentPlant, leaf: Option<PlantId>, document: &Document) -> Result<(), CommandError> {
    let Some(lender) = leaf else { return Ok(()) };
    // A plant that lends its leaf bears its own, so dependencies cannot form a cycle.
    let lent = document.plants.iter().any(|p| p.settings.maker.leaf() == Some(plant.id));
    if lender == plant.id || lent || !document.lends_leaf(lender) {
        return Err(CommandError::NoLeaf);
    }
    Ok(())
}

base::coded!(CommandError {
    Self::NoSuchStroke(id) => "no-such-stroke" { stroke = id.0 },
    Self::NoSuchPlant(id) => "no-such-plant" { plant = id.0 },
    Self::OtherMaker { wanted, found } => "other-maker" { wanted, found },
    Self::NoLeaf => "no-leaf-to-lend" {},
    Self::NoPhoto => "no-photo" {},
    Self::Fixed => "place-locked" {},
    Self::Locked(layer) => "layer-closed" { layer },
    Self::Nothing(_) => "nothing-to-do" {},
    Self::TooFar => "too-far" {},
    Self::Full(what) => "full" { what },
    Self::Gesture(_) => "gesture" {},
} wraps {
    Self::Spec(e) => e, spec::SpecFault;
    Self::OutOfRange(e) => e, SettingFault;
});
