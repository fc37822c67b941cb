//! Plants of a wanted size: what to change so that they have it.
//!
//! `plants + a height, width or diameter -> commands, which the shell runs as one step`

use burgeon::document::{
    Command, DocumentPlant, Maker, PlantCommand, PlantId, Settings, SketchCommand, TreeCommand,
};
use burgeon::{Run, TreeGoal, aim_at, scene_model, standing, tree_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::export::made;
use crate::{Workspace, WorkspaceError};

/// Size that plants shall have in the scene, metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SizeGoal {
    /// A height.
    Height(f64),
    /// The larger of the two extents along the ground.
    Width(f64),
    /// A diameter at breast height (1.3 m), of trees.
    Dbh(f64),
}

impl SizeGoal {
    /// Returns the value, if it is one that a plant may have.
    fn checked(self) -> Result<f64, WorkspaceError> {
        let (field, value, (least, most)) = match self {
            Self::Height(value) => ("height", value, TreeGoal::HEIGHTS_M),
            Self::Width(value) => ("width", value, TreeGoal::HEIGHTS_M),
            Self::Dbh(value) => ("dbh", value, TreeGoal::DIAMETERS_M),
        };
        if (least..=most).contains(&value) {
            return Ok(value);
        }
        Err(WorkspaceError::Range { field, value, range: format!("{least} to {most}") })
    }
}

impl Workspace {
    /// Returns the commands after which plants have a size: a tree grows to a height or diameter, at the age at which it comes
    /// nearest; a drawing is made as high; all else is sized as a whole, in its place.
    ///
    /// # Cost
    /// At most ten growths of each tree, without meshes.
    ///
    /// # Errors
    /// [`WorkspaceError::Height`] for a size that the species does not reach.
    pub fn size(
        &mut self,
        plants: &[PlantId],
        goal: SizeGoal,
        run: &Run<'_>,
    ) -> Result<Vec<Command>, WorkspaceError> {
        let value = goal.checked()?;
        let mut commands = Vec::new();
        for &id in plants {
            let plant = self.editor.document().plant(id).ok_or(WorkspaceError::PlantGone)?;
            let Settings { maker, placement, seed, .. } = plant.settings();
            let own = value / placement.scale;
            match (maker, goal) {
                (Maker::Tree(tree), SizeGoal::Height(_) | SizeGoal::Dbh(_)) => {
                    let aim = if matches!(goal, SizeGoal::Dbh(_)) { TreeGoal::Dbh } else { TreeGoal::Height };
                    let mut spec = tree_spec(tree);
                    let height = aim_at(&mut spec, *seed, aim(own), run).map_err(WorkspaceError::Height)?;
                    commands.push(TreeCommand::SetField("/age".into(), json!(spec.age)).for_plant(id));
                    commands.push(TreeCommand::SetHeight(Some(height)).for_plant(id));
                }
                (Maker::Sketch(s), SizeGoal::Height(_)) => {
                    let mut sketch = s.sketch.clone();
                    sketch.height_m = Some(own);
                    commands.push(SketchCommand::SetSketch(Box::new(sketch)).for_plant(id));
                }
                (_, SizeGoal::Dbh(_)) => return Err(WorkspaceError::NoGirth),
                (_, SizeGoal::Height(_) | SizeGoal::Width(_)) => {
                    let [high, wide] = self.extent(id, run)?;
                    let now = if matches!(goal, SizeGoal::Width(_)) { wide } else { high };
                    let plant = self.editor.document().plant(id).ok_or(WorkspaceError::PlantGone)?;
                    let mut placement = plant.settings().placement;
                    placement.scale *= value / now;
                    commands.push(PlantCommand::Place(placement).for_plant(id));
                }
            }
        }
        Ok(commands)
    }

    /// Returns how high and wide a plant is in its place, metres.
    fn extent(&mut self, id: PlantId, run: &Run<'_>) -> Result<[f64; 2], WorkspaceError> {
        let document = self.editor.document();
        let plants: Vec<&DocumentPlant> = made(&mut self.scene, document, Some(id), run)?;
        let shown = plants.first().and_then(|plant| Some((*plant, self.scene.get(plant.id())?.model)));
        let (plant, model) = shown.ok_or(WorkspaceError::NothingMade)?;
        let size = scene_model("", &[standing(plant, model)]).bounds().size();
        let [high, wide] = [size.y, size.x.max(size.z)];
        if high > 0.0 && wide > 0.0 { Ok([high, wide]) } else { Err(WorkspaceError::NothingMade) }
    }
}

#[cfg(test)]
mod tests {
    use burgeon::Coded;
    use burgeon::document::SceneCommand;

    use super::*;
    use crate::{Action, NewMaker};

    fn workspace_with(maker: NewMaker) -> (Workspace, PlantId) {
        let mut s = Workspace::default();
        s.act(&Action::Add { name: "it".into(), maker }).unwrap();
        let id = s.current().unwrap();
        (s, id)
    }

    fn sized(s: &mut Workspace, id: PlantId, goal: SizeGoal) -> [f64; 2] {
        for command in s.size(&[id], goal, &Run::plain()).unwrap() {
            s.run(command).unwrap();
        }
        s.extent(id, &Run::plain()).unwrap()
    }

    #[test]
    fn a_tree_grows_to_a_height_and_to_a_diameter() {
        let (mut s, id) = workspace_with(NewMaker::Tree("hazel".into()));
        sized(&mut s, id, SizeGoal::Height(2.0));
        let Maker::Tree(tree) = &s.document().plant(id).unwrap().settings().maker else { panic!("a tree") };
        assert!(tree.height_m == Some(2.0) && tree.spec.age.is_some(), "{:?}", tree.spec.age);
        let [high, wide] = s.extent(id, &Run::plain()).unwrap();
        // Leaves reach beyond the wood, which has the height.
        assert!((1.9..2.4).contains(&high), "{high}");
        // As wide as asked, in its place.
        let [high_now, wide_now] = sized(&mut s, id, SizeGoal::Width(2.0 * wide));
        assert!((wide_now / wide - 2.0).abs() < 1e-6 && (high_now / high - 2.0).abs() < 1e-6);
        // In a place that doubles it, a tree of half the height is as high.
        sized(&mut s, id, SizeGoal::Height(3.0));
        let Maker::Tree(tree) = &s.document().plant(id).unwrap().settings().maker else { panic!("a tree") };
        assert!((tree.height_m.unwrap() - 1.5).abs() < 1e-9);
        let far = s.size(&[id], SizeGoal::Height(900.0), &Run::plain()).unwrap_err();
        assert_eq!(far.details().code, "height-reach");
        let none = s.size(&[id], SizeGoal::Height(-1.0), &Run::plain()).unwrap_err();
        assert_eq!(none.details().code, "field-range");
    }

    #[test]
    fn flowers_are_sized_in_their_place_and_have_no_girth() {
        let (mut s, id) = workspace_with(NewMaker::Flower("tulip".into()));
        let [high, _] = sized(&mut s, id, SizeGoal::Height(0.75));
        assert!((high - 0.75).abs() < 1e-6, "{high}");
        let girth = s.size(&[id], SizeGoal::Dbh(0.1), &Run::plain()).unwrap_err();
        assert_eq!(girth.details().code, "no-girth");
        s.run(SceneCommand::Remove(vec![id])).unwrap();
        assert!(matches!(
            s.size(&[id], SizeGoal::Height(1.0), &Run::plain()),
            Err(WorkspaceError::PlantGone)
        ));
    }
}
