//! Settings of exports for the programs that plants go to.

use burgeon::formats::{ModelFormat, Packing};
use burgeon::{Engine, EngineSetting, ExportChoice, Unit, UpAxis};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::WorkspaceError;
use crate::export::{ExportFormat, ExportRequest, MOST_LEVELS};

/// Choices of a person for an export to a program; null is open.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EngineAsk {
    /// The program.
    pub engine: Engine,
    /// The format.
    pub format: ModelFormat,
    /// Levels of detail, 1 to 4.
    pub levels: Option<u32>,
    /// The vertical axis of the file.
    pub up: Option<UpAxis>,
    /// The unit of the file.
    pub unit: Option<Unit>,
    /// Whether drawings and trees get wind columns.
    pub wind: Option<bool>,
    /// Whether to write joints and an animation that sways.
    pub sway: Option<bool>,
    /// Whether columns are compressed.
    pub packed: Option<bool>,
    /// Whether all levels go into one file.
    pub one_file: Option<bool>,
    /// Whether to add views from all sides.
    pub impostor: Option<bool>,
    /// Whether leaves of one form are written once.
    pub instances: Option<bool>,
    /// Whether the whole scene is exported.
    pub whole: bool,
}

/// A setting that a program wants and the person left open.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct EngineSet {
    /// The option (up, unit, lods, pack, wind), or what no option sets: levels, collider, pivots, skeleton, names, ...
    pub name: &'static str,
    /// Its value, empty for a switch; for what no option sets a few English words.
    pub value: String,
}

impl From<&EngineSetting> for EngineSet {
    fn from(set: &EngineSetting) -> Self {
        Self { name: set.name(), value: set.value().to_owned() }
    }
}

/// An export as a program wants it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct EngineAnswer {
    /// The export.
    pub request: ExportRequest,
    /// What was set for the program.
    pub set: Vec<EngineSet>,
}

impl EngineAsk {
    /// Asks for an export of the whole scene in which a person left everything open.
    pub const fn new(engine: Engine, format: ModelFormat) -> Self {
        Self {
            engine,
            format,
            levels: None,
            up: None,
            unit: None,
            wind: None,
            sway: None,
            packed: None,
            one_file: None,
            impostor: None,
            instances: None,
            whole: true,
        }
    }

    /// Sets what the program wants and the person left open, as the command does for `for`.
    ///
    /// # Errors
    /// [`WorkspaceError::EngineFile`] for a format that the program is not given.
    pub fn settle(&self) -> Result<EngineAnswer, WorkspaceError> {
        let is = |choice: Option<bool>| choice == Some(true);
        // A person who wants no wind gets none, in whatever way the program takes it.
        let calm = !is(self.wind) && !is(self.sway) && [self.wind, self.sway].contains(&Some(false));
        let still = is(self.instances) || is(self.impostor);
        let mut choice = ExportChoice {
            up: self.up,
            unit: self.unit,
            lods: self.levels.map(|levels| levels.saturating_sub(1)),
            packing: is(self.packed).then_some(Packing::Compressed),
            has_wind: is(self.wind),
            sways: is(self.sway),
            is_one_file: is(self.one_file),
            is_still: still,
            has_names: false,
        };
        let mut set = self.engine.settle(self.format.extension(), &mut choice)?;
        if calm {
            (choice.has_wind, choice.sways) = (false, false);
        }
        let unpacked = self.packed == Some(false);
        // One plant is a skeleton with leaves on its joints, or has nodes; levels of a scene are files of their own.
        let is_given = |name: &str| match name {
            "pack" => !unpacked,
            "wind" | "sway" | "wind-sets" | "pivots" if calm => false,
            "levels" | "collider" | "wind-sets" | "pivots" | "skeleton" | "leaves" | "wind-file" => {
                !self.whole
            }
            "physics" => false,
            _ => true,
        };
        set.retain(|s| is_given(s.name()));
        let request = ExportRequest {
            format: ExportFormat::Model(self.format),
            levels: choice.lods.map_or(1, |lods| lods + 1).clamp(1, MOST_LEVELS),
            up: choice.up.unwrap_or_default(),
            unit: choice.unit.unwrap_or_default(),
            whole: self.whole && self.engine != Engine::Print,
            wind: choice.has_wind,
            one_file: is(self.one_file),
            sway: choice.sways,
            impostor: is(self.impostor),
            packed: choice.packing.is_some() && !unpacked,
            instances: is(self.instances),
            foliage: None,
            texture_size: None,
            triangles: None,
            megabytes: None,
            named: choice.has_names,
            engine: Some(self.engine),
        };
        Ok(EngineAnswer { request, set: set.iter().map(EngineSet::from).collect() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(answer: &EngineAnswer) -> Vec<&'static str> {
        answer.set.iter().map(|s| s.name).collect()
    }

    #[test]
    fn a_program_gets_what_it_wants_and_a_person_too() {
        let unity = EngineAsk::new(Engine::Unity, ModelFormat::Glb).settle().unwrap();
        assert_eq!(words(&unity), ["lods", "wind", "names"]);
        assert_eq!((unity.request.levels, unity.request.wind, unity.request.named), (4, true, true));
        let one =
            EngineAsk { whole: false, ..EngineAsk::new(Engine::Unity, ModelFormat::Glb) }.settle().unwrap();
        assert_eq!(words(&one), ["lods", "levels", "collider", "wind", "wind-sets", "names"]);
        assert_eq!(one.request.nodes(), Some(Engine::Unity));
        let unreal =
            EngineAsk { whole: false, ..EngineAsk::new(Engine::Unreal, ModelFormat::Usda) }.settle().unwrap();
        assert_eq!(words(&unreal), ["up", "unit", "skeleton", "leaves", "wind-file", "names"]);
        assert!(unreal.request.is_assembly() && unreal.request.levels == 1 && !unreal.request.wind);
        let scene = EngineAsk::new(Engine::Unreal, ModelFormat::Usda).settle().unwrap();
        assert!(!scene.request.is_assembly() && words(&scene) == ["up", "unit", "names"]);
        let calm = EngineAsk {
            wind: Some(false),
            levels: Some(2),
            ..EngineAsk::new(Engine::Unity, ModelFormat::Glb)
        };
        let calm = calm.settle().unwrap();
        assert_eq!((words(&calm), calm.request.levels, calm.request.wind), (vec!["names"], 2, false));
        let three = EngineAsk::new(Engine::Three, ModelFormat::Glb).settle().unwrap();
        assert_eq!((three.request.packed, three.request.wind), (true, true));
        let plain = EngineAsk { packed: Some(false), ..EngineAsk::new(Engine::Three, ModelFormat::Glb) };
        let plain = plain.settle().unwrap();
        assert!(!plain.request.packed && !words(&plain).contains(&"pack"));
        let print = EngineAsk::new(Engine::Print, ModelFormat::Stl).settle().unwrap();
        assert_eq!((print.request.unit, print.request.whole), (Unit::Millimetre, false));
        let wrong = EngineAsk::new(Engine::Isaac, ModelFormat::Glb).settle();
        assert!(matches!(wrong, Err(WorkspaceError::EngineFile(_))));
    }
}
