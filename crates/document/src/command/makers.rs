//! Commands of trees, leaves and flowers.

use std::sync::Arc;

use bloom::{FlowerSpec, GrowthLaw};
use glam::DVec3;
use growth::{SetDown, TreeSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use skin::SkinSpec;

use super::{Command, CommandError, may_bear, set};
use crate::event::Event;
use crate::makers::{FlowerMaker, LeafData, LeafMaker, Maker, NamedObstacle, TreeSettings};
use crate::names::shortened;
use crate::{Document, DocumentPlant, PlantId, SettingFault};

/// Commands of a tree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum TreeCommand {
    /// Replaces the spec, for example by that of a preset. Obstacles stay.
    SetSpec(
        Option<String>,
        #[serde(with = "spec::through_json")]
        #[schemars(with = "Value")]
        Arc<TreeSpec>,
    ),
    /// Sets one field of the spec, named by a JSON pointer such as `/method/points`.
    SetField(String, Value),
    /// Adds an obstacle after the others.
    AddObstacle(NamedObstacle),
    /// Replaces the obstacle of a row.
    SetObstacle(usize, NamedObstacle),
    /// Moves the obstacle of a row by an offset in metres, in the coordinates of the tree.
    MoveObstacle(usize, #[schemars(with = "[f64; 3]")] DVec3),
    /// Moves, turns and scales the obstacle of a row, in the coordinates of the tree.
    SetDownObstacle(usize, SetDown),
    /// Renames the obstacle of a row.
    RenameObstacle(usize, String),
    /// Removes the obstacle of a row.
    RemoveObstacle(usize),
    /// Scales the wood to a height in metres, or leaves it as it grows. The height is that of an age: another age ends it.
    SetHeight(Option<f64>),
    /// Sets how the tree is meshed.
    SetSkin(SkinSpec),
    /// Takes the leaf of another plant, or its own again.
    SetLeaf(Option<PlantId>),
}

impl TreeCommand {
    /// Returns the command for a plant.
    pub fn for_plant(self, plant: PlantId) -> Command {
        Command::Tree(plant, self)
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::SetSpec(..) => "species",
            Self::SetField(..) => "tree",
            Self::AddObstacle(_) | Self::SetObstacle(..) | Self::RemoveObstacle(_) => "obstacle",
            Self::MoveObstacle(..) | Self::SetDownObstacle(..) => "move-obstacle",
            Self::RenameObstacle(..) => "rename",
            Self::SetHeight(_) => "height",
            Self::SetSkin(_) => "skin",
            Self::SetLeaf(_) => "leaf-of",
        }
    }

    pub(super) fn decide(self, plant: &DocumentPlant, document: &Document) -> Result<Event, CommandError> {
        if let Self::SetLeaf(leaf) = &self {
            may_bear(plant, *leaf, document)?;
        }
        set(plant, |s| {
            let found = s.maker.word();
            let Maker::Tree(tree) = &mut s.maker else {
                return Err(CommandError::OtherMaker { wanted: "tree", found });
            };
            self.change(tree)
        })
    }

    fn change(self, tree: &mut TreeSettings) -> Result<(), CommandError> {
        let gone = CommandError::Nothing("the obstacle is not there any more");
        match self {
            Self::SetSpec(preset, spec) => {
                spec::check(&*spec).map_err(spec::SpecFault::from)?;
                tree.preset = preset.map(|p| shortened(&p));
                tree.set_spec(spec);
            }
            Self::SetField(path, value) => {
                tree.set_spec(Arc::new(spec::set(&*tree.spec, &path, value)?));
            }
            Self::AddObstacle(new) => tree.obstacles.push(named(new)),
            Self::SetObstacle(row, new) => *tree.obstacles.get_mut(row).ok_or(gone)? = named(new),
            Self::MoveObstacle(row, by) => {
                let obstacle = tree.obstacles.get_mut(row).ok_or(gone)?;
                if !by.is_finite() || by.abs().max_element() > 1e5 {
                    return Err(CommandError::OutOfRange(SettingFault::Place));
                }
                obstacle.shape = Arc::new(obstacle.shape.moved(by));
            }
            Self::SetDownObstacle(row, how) => {
                let obstacle = tree.obstacles.get_mut(row).ok_or(gone)?;
                let strange = || CommandError::OutOfRange(SettingFault::Place);
                let shape = obstacle.shape.placed(&how.sound().ok_or_else(strange)?);
                // Scaled repeatedly, it would leave the range of a spec.
                growth::Obstacles::new(core::slice::from_ref(&shape), 0.0).ok().ok_or_else(strange)?;
                obstacle.shape = Arc::new(shape);
            }
            Self::RenameObstacle(row, name) => {
                tree.obstacles.get_mut(row).ok_or(gone)?.name = shortened(&name)
            }
            Self::RemoveObstacle(row) => {
                if row >= tree.obstacles.len() {
                    return Err(gone);
                }
                tree.obstacles.remove(row);
            }
            Self::SetHeight(height_m) => tree.height_m = height_m,
            Self::SetSkin(skin) => tree.skin = SkinSpec { seed: tree.skin.seed, ..skin },
            Self::SetLeaf(leaf) => tree.leaf = leaf,
        }
        Ok(())
    }
}

fn named(new: NamedObstacle) -> NamedObstacle {
    NamedObstacle { name: shortened(&new.name), ..new }
}

/// Commands of a measured leaf.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum LeafCommand {
    /// Replaces the measurements by others, with no control ball moved. The sender has checked that they make a leaf.
    SetData(LeafData),
    /// Sets how the leaf is made.
    Set(Box<leaf::LeafSpec>),
}

impl LeafCommand {
    /// Returns the command for a plant.
    pub fn for_plant(self, plant: PlantId) -> Command {
        Command::Leaf(plant, self)
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::SetData(_) => "marks",
            Self::Set(_) => "leaf",
        }
    }

    pub(super) fn decide(self, plant: &DocumentPlant) -> Result<Event, CommandError> {
        set(plant, |s| {
            let found = s.maker.word();
            let Maker::Leaf(leaf) = &mut s.maker else {
                return Err(CommandError::OtherMaker { wanted: "leaf", found });
            };
            let LeafMaker { data, settings } = &mut **leaf;
            match self {
                Self::SetData(new) => {
                    *data = LeafData { name: shortened(&new.name), ..new };
                    settings.balls.clear();
                }
                Self::Set(new) => *settings = *new,
            }
            Ok(())
        })
    }
}

/// Commands of a flower.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FlowerCommand {
    /// Replaces the spec, for example by that of a species.
    SetSpec(
        Option<String>,
        #[serde(with = "spec::through_json")]
        #[schemars(with = "Value")]
        Arc<FlowerSpec>,
    ),
    /// Sets one field of the spec, named by a JSON pointer such as `/whorls/0/count`.
    SetField(String, Value),
    /// Sets the day on which it is shown.
    SetDay(f64),
    /// Sets a fitted law, or the species' own pace again.
    SetLaw(#[schemars(with = "Option<Value>")] Option<Arc<GrowthLaw>>),
}

impl FlowerCommand {
    /// Returns the command for a plant.
    pub fn for_plant(self, plant: PlantId) -> Command {
        Command::Flower(plant, self)
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::SetSpec(..) => "species",
            Self::SetField(..) => "flower",
            Self::SetDay(_) => "day",
            Self::SetLaw(_) => "law",
        }
    }

    pub(super) fn decide(self, plant: &DocumentPlant) -> Result<Event, CommandError> {
        set(plant, |s| {
            let found = s.maker.word();
            let Maker::Flower(flower) = &mut s.maker else {
                return Err(CommandError::OtherMaker { wanted: "flower", found });
            };
            let FlowerMaker { preset, spec, day, law } = &mut **flower;
            match self {
                Self::SetSpec(name, new) => {
                    spec::check(&*new).map_err(spec::SpecFault::from)?;
                    (*preset, *spec) = (name.map(|n| shortened(&n)), new);
                }
                Self::SetField(path, value) => *spec = Arc::new(spec::set(&**spec, &path, value)?),
                Self::SetDay(new) => *day = new,
                Self::SetLaw(new) => *law = new,
            }
            Ok(())
        })
    }
}
