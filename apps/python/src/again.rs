//! A plant with other settings; its other edits stay.

use std::sync::Arc;

use burgeon::document::{
    FlowerCommand, LeafCommand, Maker, PlantCommand, SketchCommand, TreeCommand, TreeSettings,
};
use burgeon::skin::SkinSpec;
use pyo3::prelude::*;

use crate::asked::Asked;
use crate::fault::{unusable, wrong};
use crate::held::Held;

impl Held {
    /// Returns the plant with other settings, and with its edits by hand, materials, classes of strokes, obstacles
    /// and place. `seeded`: the request gives the seed.
    pub(crate) fn again(
        &self,
        py: Python<'_>,
        asked: &Asked<'_>,
        seeded: bool,
        day: Option<f64>,
    ) -> PyResult<Arc<Self>> {
        self.must_have_document(py)?;
        let id = self.id;
        let mut commands = Vec::new();
        if seeded {
            commands.push(PlantCommand::SetSeed(asked.seed()).for_plant(id));
        }
        let surface = |base: &SkinSpec| asked.skin_on(py, base);
        let wind = match self.maker() {
            Some(Maker::Tree(tree)) => {
                dayless(day, "tree")?;
                let spec = asked.spec(py, &burgeon::tree_spec(tree))?;
                let (skin, wind) = surface(&tree.skin)?;
                let made = burgeon::tree_settings(&spec, tree.preset.as_deref());
                commands
                    .push(TreeCommand::SetSpec(made.preset.clone(), Arc::clone(&made.spec)).for_plant(id));
                commands.extend(obstacles(tree, &made).into_iter().map(|c| c.for_plant(id)));
                commands.push(TreeCommand::SetSkin(skin).for_plant(id));
                wind
            }
            Some(Maker::Sketch(sketch)) => {
                let spec = asked.spec(py, &sketch.sketch)?;
                let (skin, wind) = surface(&sketch.skin)?;
                commands.push(SketchCommand::SetSketch(Box::new(spec)).for_plant(id));
                commands.push(SketchCommand::SetSkin(skin).for_plant(id));
                commands.extend(day.map(|day| SketchCommand::SetDay(Some(day)).for_plant(id)));
                wind
            }
            Some(Maker::Flower(flower)) => {
                let spec = asked.spec(py, &*flower.spec)?;
                let wind = plain(asked, py)?;
                commands.push(FlowerCommand::SetSpec(flower.preset.clone(), Arc::new(spec)).for_plant(id));
                commands.extend(day.map(|day| FlowerCommand::SetDay(day).for_plant(id)));
                wind
            }
            Some(Maker::Leaf(leaf)) => {
                dayless(day, "leaf")?;
                let spec = asked.spec(py, &leaf.settings)?;
                let wind = plain(asked, py)?;
                commands.push(LeafCommand::Set(Box::new(spec)).for_plant(id));
                wind
            }
            _ => return Err(unusable(py, &"this plant has no settings")),
        };
        self.after_with(py, wind, commands)
    }
}

fn dayless(day: Option<f64>, maker: &str) -> PyResult<()> {
    let line = format!("a {maker} has no days: flowers have, and drawings of flowers");
    day.map_or(Ok(()), |day| Err(wrong(&line, "day", &day.to_string(), "left out")))
}

/// Returns the wind option of a plant that has no other options of meshing.
fn plain(asked: &Asked<'_>, py: Python<'_>) -> PyResult<Option<bool>> {
    let (skin, wind) = asked.skin_on(py, &SkinSpec::default())?;
    if skin == SkinSpec::default() {
        return Ok(wind);
    }
    Err(unusable(py, &"detail, sides, textures and foliage are of trees and drawings"))
}

/// Returns the commands that replace the obstacles of a tree by those of another.
fn obstacles(from: &TreeSettings, to: &TreeSettings) -> Vec<TreeCommand> {
    let same = from.obstacles.iter().map(|o| &o.shape).eq(to.obstacles.iter().map(|o| &o.shape));
    if same {
        return Vec::new();
    }
    let gone = (0..from.obstacles.len()).rev().map(TreeCommand::RemoveObstacle);
    gone.chain(to.obstacles.iter().cloned().map(TreeCommand::AddObstacle)).collect()
}
