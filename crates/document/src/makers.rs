//! What each maker is asked for: sketch, tree, measured leaf, flower.

use std::sync::Arc;

use bloom::{FlowerSettings, FlowerSpec, GrowthLaw};
use growth::{Obstacle, TreeSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sketch::SketchSpec;
use skin::SkinSpec;

use crate::{Photo, PlantId};

/// Most obstacles of a tree.
pub(crate) const MAX_OBSTACLES: usize = 64;

/// Who makes a plant, and of what. Strokes of a sketch lie beside it, in [`crate::DocumentPlant::strokes`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Maker {
    /// Drawn with a pen.
    Sketch(Box<SketchSettings>),
    /// Grown.
    Tree(Box<TreeSettings>),
    /// Measured.
    Leaf(Box<LeafMaker>),
    /// A species that opens.
    Flower(Box<FlowerMaker>),
}

impl Default for Maker {
    fn default() -> Self {
        Self::Sketch(Box::default())
    }
}

impl Maker {
    /// The word of the maker in files and reports: `sketch`, `tree`, `leaf` or `flower`.
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Sketch(_) => "sketch",
            Self::Tree(_) => "tree",
            Self::Leaf(_) => "leaf",
            Self::Flower(_) => "flower",
        }
    }

    /// The plant of the scene whose leaf this one bears.
    pub fn leaf(&self) -> Option<PlantId> {
        match self {
            Self::Sketch(s) => s.leaf,
            Self::Tree(t) => t.leaf,
            _ => None,
        }
    }

    /// Whether it makes plants with branches, which take edits by hand: a sketch or a tree.
    pub const fn branches(&self) -> bool {
        matches!(self, Self::Sketch(_) | Self::Tree(_))
    }

    pub(crate) fn set_leaf(&mut self, leaf: Option<PlantId>) {
        match self {
            Self::Sketch(s) => s.leaf = leaf,
            Self::Tree(t) => t.leaf = leaf,
            _ => {}
        }
    }

    /// What is out of its range, as a sentence with what to do.
    pub(crate) fn fault(&self) -> Option<String> {
        match self {
            Self::Sketch(s) => s.fault(),
            Self::Tree(t) => t.fault(),
            Self::Leaf(l) => fault(&l.settings),
            Self::Flower(f) => f.fault(),
        }
    }
}

/// A plant that is drawn: how the drawing is understood.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SketchSettings {
    /// How the drawing is understood and given depth.
    pub sketch: SketchSpec,
    /// How the plant is meshed and coloured. Its `seed` is not saved: it always follows the plant's.
    pub skin: SkinSpec,
    /// What lies under the drawing.
    pub photo: Option<Photo>,
    /// The day at which its flowers are shown, 0 (bud) to 100; none shows them as they are drawn.
    pub day: Option<f64>,
    /// The plant of the scene whose leaf this one bears in the place of its own.
    pub leaf: Option<PlantId>,
}

impl SketchSettings {
    fn fault(&self) -> Option<String> {
        let photo = self.photo.as_ref().and_then(Photo::fault);
        let day = || FlowerSettings { day: self.day.unwrap_or(0.0), ..FlowerSettings::default() };
        fault(&self.sketch).or(photo).or_else(|| fault(&self.skin)).or_else(|| fault(&day()))
    }
}

/// A tree that is grown. Whoever grows it says what is wrong with its spec.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TreeSettings {
    /// The species that the spec came from.
    pub preset: Option<String>,
    /// The spec, without obstacles.
    pub spec: Arc<TreeSpec>,
    /// What it grows around, in the tree's own coordinates; at most 64.
    pub obstacles: Vec<NamedObstacle>,
    /// How the tree is meshed. Its `seed` is not saved.
    pub skin: SkinSpec,
    /// The plant of the scene whose leaf this tree bears in the place of its own.
    pub leaf: Option<PlantId>,
}

impl TreeSettings {
    fn fault(&self) -> Option<String> {
        if self.obstacles.len() > MAX_OBSTACLES {
            return Some(format!(
                "a tree has at most {MAX_OBSTACLES} obstacles; join some of them into one mesh"
            ));
        }
        if self.obstacles.iter().any(|o| !o.shape.is_finite()) {
            return Some("every number of an obstacle must be finite".into());
        }
        fault(&self.skin)
    }
}

/// An obstacle with the name under which a person knows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NamedObstacle {
    /// For lists; at most 200 characters.
    pub name: String,
    /// The solid.
    pub shape: Arc<Obstacle>,
}

/// A leaf that was measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafMaker {
    /// What was measured, as a file.
    pub data: LeafData,
    /// How the leaf is made of it.
    pub settings: LeafSettings,
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

/// The surface of a measured blade.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LeafSurface {
    /// Through all marks, with the folds of the blade.
    #[default]
    Interpolate,
    /// A B-spline near the marks.
    Approximate,
    /// One smooth polynomial.
    Bezier,
    /// As approximate, drawn towards thick veins.
    Nurbs,
}

/// The rings of veins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LeafRings {
    /// Circles across the vein, as published.
    #[default]
    Plain,
    /// Where each ball touches the surface of all.
    Envelope,
}

/// What a measured thickness is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LeafThickness {
    /// As callipers measure.
    Diameter,
    /// As the formulas take it.
    Radius,
}

/// What colours a measured blade.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LeafPaint {
    /// Painted by the distance from the veins.
    #[default]
    Veins,
    /// One green.
    Plain,
}

/// How a leaf is made of its marks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LeafSettings {
    /// Surface of the blade.
    pub surface: LeafSurface,
    /// Roll about the midrib: -1 (margins meet below) to 1 (above), 0 as measured, default 0.
    #[schemars(range(min = -1.0, max = 1.0))]
    pub curl: f64,
    /// Loss of stiffness: 0 as measured to 1 hanging limp, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub wilt: f64,
    /// Colour of the blade.
    pub texture: LeafPaint,
    /// What a measured thickness is; default what the file says, else the diameter.
    pub thickness: Option<LeafThickness>,
    /// Pull of the thickest vein on a NURBS blade, 1 (none) to 100, default 4.
    #[schemars(range(min = 1.0, max = 100.0))]
    pub vein_weight: f64,
    /// Rings of the veins.
    pub rings: LeafRings,
    /// Parts of each span between marks, 1 to 64, default 5.
    #[schemars(range(min = 1, max = 64))]
    pub subdivisions: u32,
    /// Points around a vein, 3 to 64, default 10.
    #[schemars(range(min = 3, max = 64))]
    pub sides: u32,
    /// Round ends on the veins; default false.
    pub caps: bool,
    /// A vein along the margin too; default false.
    pub margin_vein: bool,
    /// Length of the midrib for a vein graph in pixels, metres, 0.002 to 10, default 0.1.
    #[schemars(range(min = 0.002, max = 10.0), extend("x-unit" = "m"))]
    pub length_m: f64,
}

spec::schemas!(LeafSettings);

impl Default for LeafSettings {
    fn default() -> Self {
        Self {
            surface: LeafSurface::default(),
            curl: 0.0,
            wilt: 0.0,
            texture: LeafPaint::default(),
            thickness: None,
            vein_weight: 4.0,
            rings: LeafRings::default(),
            subdivisions: 5,
            sides: 10,
            caps: false,
            margin_vein: false,
            length_m: 0.1,
        }
    }
}

/// A flower that opens.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlowerMaker {
    /// Species, day and form.
    pub settings: FlowerSettings,
    /// A fitted law that sets the pace; none takes the species' own.
    pub law: Option<Arc<GrowthLaw>>,
}

impl FlowerMaker {
    fn fault(&self) -> Option<String> {
        let law = self.law.as_ref().and_then(|l| l.validate().next()).map(|f| f.to_string());
        law.or_else(|| flower_fault(&self.settings))
    }
}

fn flower_fault(settings: &FlowerSettings) -> Option<String> {
    if !FlowerSpec::PRESETS.contains(&settings.species.as_str()) {
        let short = base::quoted(&settings.species);
        return Some(format!(
            "the flower {short:?} is unknown; use one of {}",
            FlowerSpec::PRESETS.join(", ")
        ));
    }
    fault(settings)
}

/// What is out of its range, in words.
fn fault<T: spec::Spec>(settings: &T) -> Option<String> {
    spec::check(settings).err().map(|fault| fault.to_string())
}
