//! Settings of each maker: sketch, tree, measured leaf, flower.

use std::sync::Arc;

use bloom::{FlowerSpec, GrowthLaw};
use growth::{Obstacle, TreeSpec};
use ink::Layer;
use leaf::LeafSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sketch::SketchSpec;
use skin::SkinSpec;

use crate::fault::{MAX_LAYERS, MAX_OBSTACLES};
use crate::names::shortened;
use crate::{Photo, PlantId, SettingFault};

/// The maker of a plant with its settings. Strokes of a sketch are stored separately, in
/// [`crate::DocumentPlant::strokes`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Maker {
    /// Drawn with a pen.
    Sketch(Box<SketchSettings>),
    /// Grown.
    Tree(Box<TreeSettings>),
    /// Measured.
    Leaf(Box<LeafMaker>),
    /// A flower that opens.
    Flower(Box<FlowerMaker>),
}

impl Default for Maker {
    fn default() -> Self {
        Self::Sketch(Box::default())
    }
}

impl Maker {
    /// Returns the word of the maker in files and reports: `sketch`, `tree`, `leaf` or `flower`.
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Sketch(_) => "sketch",
            Self::Tree(_) => "tree",
            Self::Leaf(_) => "leaf",
            Self::Flower(_) => "flower",
        }
    }

    /// Returns the plant of the scene whose leaf this one bears.
    pub fn leaf(&self) -> Option<PlantId> {
        match self {
            Self::Sketch(s) => s.leaf,
            Self::Tree(t) => t.leaf,
            _ => None,
        }
    }

    /// Whether it makes plants with stems and branches, which take hand edits: all except a single leaf.
    pub const fn branches(&self) -> bool {
        !matches!(self, Self::Leaf(_))
    }

    pub(crate) fn set_leaf(&mut self, leaf: Option<PlantId>) {
        match self {
            Self::Sketch(s) => s.leaf = leaf,
            Self::Tree(t) => t.leaf = leaf,
            _ => {}
        }
    }

    /// Returns the first setting that is out of its range.
    pub(crate) fn fault(&self) -> Option<SettingFault> {
        match self {
            Self::Sketch(s) => s.fault(),
            Self::Tree(t) => t.fault(),
            Self::Leaf(l) => fault(&l.settings),
            Self::Flower(f) => f.fault(),
        }
    }
}

/// A drawn plant: how the drawing is interpreted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SketchSettings {
    /// Settings for interpreting the drawing and giving it depth.
    pub sketch: SketchSpec,
    /// Settings for meshing and colouring the plant. Its `seed` is not saved: it always follows the plant's.
    pub skin: SkinSpec,
    /// Its layers from below upwards, at most 100; strokes name theirs.
    pub layers: Vec<Layer>,
    /// The photograph under the drawing.
    pub photo: Option<Photo>,
    /// Day on which its flowers are shown, 0 (bud) to 100; `None` shows them as they are drawn.
    pub day: Option<f64>,
    /// The plant of the scene whose leaf this one bears instead of its own.
    pub leaf: Option<PlantId>,
}

impl SketchSettings {
    fn fault(&self) -> Option<SettingFault> {
        let photo = self.photo.as_ref().and_then(Photo::fault);
        let day = || day_fault(self.day.unwrap_or(0.0));
        let layers = || layers_fault(&self.layers);
        fault(&self.sketch).or_else(layers).or(photo).or_else(|| fault(&self.skin)).or_else(day)
    }
}

fn layers_fault(layers: &[Layer]) -> Option<SettingFault> {
    if layers.len() > MAX_LAYERS {
        return Some(SettingFault::Layers);
    }
    let names = base::set_of(layers.iter().map(|l| &l.name));
    let sound = |l: &Layer| !l.name.trim().is_empty() && *shortened(&l.name) == *l.name;
    let named = names.len() == layers.len() && layers.iter().all(sound);
    (!named).then_some(SettingFault::LayerName)
}

/// A grown tree. Its spec is checked when it is grown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TreeSettings {
    /// The species that the spec came from.
    pub preset: Option<String>,
    /// The spec, without obstacles.
    pub spec: Arc<TreeSpec>,
    /// The obstacles that it grows around, in the tree's own coordinates; at most 64.
    pub obstacles: Vec<NamedObstacle>,
    /// The height to which its wood is scaled, metres, above 0; without obstacles only.
    pub height_m: Option<f64>,
    /// Settings for meshing the tree. Its `seed` is not saved.
    pub skin: SkinSpec,
    /// The plant of the scene whose leaf this tree bears instead of its own.
    pub leaf: Option<PlantId>,
}

impl TreeSettings {
    fn fault(&self) -> Option<SettingFault> {
        if self.obstacles.len() > MAX_OBSTACLES {
            return Some(SettingFault::Obstacles);
        }
        if self.obstacles.iter().any(|o| !o.shape.is_finite()) {
            return Some(SettingFault::Obstacle);
        }
        self.height_m.and_then(height_fault).or_else(|| fault(&self.skin))
    }

    /// Replaces the spec. The height to which the tree is scaled is that of an age: with another age it grows as it does.
    pub(crate) fn set_spec(&mut self, spec: Arc<TreeSpec>) {
        if spec.age != self.spec.age {
            self.height_m = None;
        }
        self.spec = spec;
    }
}

/// Heights in metres to which trees are scaled.
const HEIGHTS_M: [f64; 2] = [0.001, 1000.0];

fn height_fault(height: f64) -> Option<SettingFault> {
    let [least, most] = HEIGHTS_M;
    let fault = || {
        let (path, least, most) = ("height_m".into(), Some(least), Some(most));
        SettingFault::Range(spec::RangeFault { path, value: height, least, most, above: None, unit: "m" })
    };
    (!(least..=most).contains(&height)).then(fault)
}

/// An obstacle with a name for its user.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NamedObstacle {
    /// Name in lists; at most 200 characters.
    pub name: String,
    /// The solid.
    pub shape: Arc<Obstacle>,
}

/// A measured leaf.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafMaker {
    /// The measurements, as a file.
    pub data: LeafData,
    /// Settings for making the leaf from them.
    pub settings: LeafSpec,
}

/// The file of a measured leaf: marks as CSV, or a vein graph as JSON.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LeafData {
    /// Name of the file.
    pub name: String,
    /// Its text.
    pub text: Arc<str>,
}

impl Default for LeafData {
    fn default() -> Self {
        Self { name: String::new(), text: "".into() }
    }
}

/// A flower that opens.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowerMaker {
    /// The species that the spec came from.
    pub preset: Option<String>,
    /// The spec. Default: that of a lily.
    pub spec: Arc<FlowerSpec>,
    /// Days since the bud: 0 is the bud, `opening_days` full bloom, then it wilts. 0 to 100, default 4.
    pub day: f64,
    /// Fitted law that sets the pace; `None` keeps the species' own.
    pub law: Option<Arc<GrowthLaw>>,
}

impl Default for FlowerMaker {
    fn default() -> Self {
        let spec = Arc::new(bloom::preset(DEFAULT_FLOWER).unwrap_or_default());
        Self { preset: Some(DEFAULT_FLOWER.into()), spec, day: DEFAULT_DAY, law: None }
    }
}

impl FlowerMaker {
    /// Returns a flower that comes with the program, on the day of `default`; `None` for an unknown species.
    pub fn from_preset(name: &str) -> Option<Self> {
        let spec = Arc::new(bloom::preset(name)?);
        Some(Self { preset: Some(name.into()), spec, ..Self::default() })
    }

    fn fault(&self) -> Option<SettingFault> {
        let law = || self.law.as_ref().and_then(|l| l.validate().next());
        let law = || law().map(|f| SettingFault::Law(f.to_string()));
        fault(&*self.spec).or_else(law).or_else(|| day_fault(self.day))
    }
}

/// Species of a new flower.
pub(crate) const DEFAULT_FLOWER: &str = "lily";
/// Day of a new flower, on which most species are half open.
pub(crate) const DEFAULT_DAY: f64 = 4.0;
/// Last day on which flowers are shown: the longest opening and wilting together.
const LAST_DAY: f64 = 100.0;

fn day_fault(day: f64) -> Option<SettingFault> {
    let fault = || {
        let (path, least, most) = ("day".into(), Some(0.0), Some(LAST_DAY));
        SettingFault::Range(spec::RangeFault { path, value: day, least, most, above: None, unit: "d" })
    };
    (!(0.0..=LAST_DAY).contains(&day)).then(fault)
}

/// Returns the first setting that is out of its range.
fn fault<T: spec::Spec>(settings: &T) -> Option<SettingFault> {
    spec::check(settings).err().map(SettingFault::Range)
}
