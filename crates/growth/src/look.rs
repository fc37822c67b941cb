//! Appearance of a tree: the form of its leaves, its flowers, its colours and bark.
//!
//! Only settings: meshing and painting read them, growth does not.

use plant::BladeForm;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use spec::Colour;

/// A leaf's form.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BladeSpec {
    /// The form, default ovate. A `file` takes precedence.
    pub form: BladeForm,
    /// A leaf of your own instead of the form: marks (.csv), a vein graph (.json) or a model of one leaf (.glb, .obj,
    /// .ply, .stl), relative to the spec. Default none.
    pub file: Option<String>,
    /// Width relative to the form's usual, 0.1 to 4; default 1.
    #[schemars(range(min = 0.1, max = 4.0))]
    pub width: Option<f64>,
    /// Downward bend of the tip, as a share of the length, -1 to 1; default the form's.
    #[schemars(range(min = -1.0, max = 1.0))]
    pub bend: Option<f64>,
    /// Slope of the halves along the midrib, -1 to 2; default the form's.
    #[schemars(range(min = -1.0, max = 2.0))]
    pub fold: Option<f64>,
    /// Teeth of the margin on each side, 0 to 60; default none. Few triangles leave them out.
    #[schemars(range(min = 0, max = 60))]
    pub teeth: Option<u32>,
    /// For a spray: length of a needle or scale relative to that of the spray, 0.01 to 0.6; default 0.1.
    #[schemars(range(min = 0.01, max = 0.6))]
    pub needle: Option<f64>,
    /// For a spray: side shoots on each side, 0 to 12; default 3.
    #[schemars(range(min = 0, max = 12))]
    pub shoots: Option<u32>,
}

/// Flowers of a tree, in the place of leaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BlossomSpec {
    /// Share of the leaves' places that bear a flower instead, 0 to 1, default 0: no flowers except those that rules
    /// set.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub share: f64,
    /// Petals of a flower's whorl, 3 to 12, default 5.
    #[schemars(range(min = 3, max = 12))]
    pub petals: u32,
    /// Whorls of petals, one within the other, 1 to 6, default 1; 3 and more make a double flower such as a rose's.
    #[schemars(range(min = 1, max = 6))]
    pub whorls: u32,
    /// Angle by which the outermost petals open from the flower's axis, degrees, 5 to 90, default 76; about 30 for a
    /// goblet.
    #[schemars(range(min = 5.0, max = 90.0), extend("x-unit" = "deg"))]
    pub open_deg: f64,
    /// Diameter of an open flower, metres, default 0.035.
    #[schemars(range(min = 0.001, max = 1.0), extend("x-unit" = "m"))]
    pub diameter_m: f64,
    /// Mean length of a flower's stalk relative to its diameter, 0.02 to 3, default 0.7.
    #[schemars(range(min = 0.02, max = 3.0))]
    pub stalk: f64,
    /// Width of a petal relative to that which closes the whorl, 0.1 to 1.5, default 1; less for spikelets and plumes.
    #[schemars(range(min = 0.1, max = 1.5))]
    pub petal_width: f64,
    /// Width of the tuft of stamens relative to that of the flower, 0 to 1, default 0.3; 0: none is visible.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub tuft: f64,
    /// Colour of petals, default a white.
    pub color: Colour,
    /// Colour towards which single flowers vary; default none.
    pub color_to: Option<Colour>,
}

impl Default for BlossomSpec {
    fn default() -> Self {
        let color = Colour([0xf8, 0xf2, 0xf0]);
        Self {
            share: 0.0,
            petals: 5,
            whorls: 1,
            open_deg: 76.0,
            diameter_m: 0.035,
            stalk: 0.7,
            petal_width: 1.0,
            tuft: 0.3,
            color,
            color_to: None,
        }
    }
}

/// Kind of bark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Bark {
    /// Ridges and furrows along the trunk: oak, poplar, willow.
    #[default]
    Furrowed,
    /// Without plates: beech, young trees, shrubs.
    Smooth,
    /// Large flakes with dark cracks: pine, plane.
    Plated,
    /// White paper with dark stripes across: birch.
    Birch,
    /// Glossy bands with raised pores across, which peel: cherry.
    Cherry,
    /// Rings that fallen leaves have left: palm.
    Ringed,
    /// Smooth and jointed: bamboo.
    Cane,
    /// Green ribs with rows of spines on them: columnar cacti. See [`Look::ribs`].
    Ribbed,
}

/// Colours and bark. All colours are sRGB.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Look {
    /// Kind of bark.
    pub bark: Bark,
    /// Ribs along thick stems, 0 to 32, default 0: round stems. A saguaro has 12 to 30.
    #[schemars(range(min = 0, max = 32))]
    pub ribs: u32,
    /// Depth of the furrows between ribs relative to the radius of the stem, 0 to 0.5, default 0.15.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub rib_depth: f64,
    /// Mean colour of the bark of trunk and branches.
    pub bark_color: Colour,
    /// Colour of the bark at the foot of the trunk, old and rough, not lighter than `bark_color`; default the same.
    pub foot_color: Option<Colour>,
    /// Share of the tree's height up to which the foot's colour reaches, 0.01 to 1, default 0.2.
    #[schemars(range(min = 0.01, max = 1.0))]
    pub foot_height: f64,
    /// Mean colour of the bark of twigs.
    pub twig_color: Colour,
    /// Colour of leaves.
    pub leaf_color: Colour,
    /// Colour towards which single leaves vary (young growth); default the leaf colour.
    pub leaf_color_to: Option<Colour>,
    /// Degree of that variation, 0 to 1, default 0.5.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub leaf_variation: f64,
    /// The season, -1 to 1, default 0: leaves as in summer; -1: bare before spring, after which leaves unfold; 0.5: all
    /// in the colours of autumn; 1: all fallen. Evergreens do not change.
    #[schemars(range(min = -1.0, max = 1.0))]
    pub season: f64,
    /// Colour of leaves in autumn; default none: an evergreen.
    pub autumn_color: Option<Colour>,
    /// Colour towards which single leaves vary in autumn; default `autumn_color`.
    pub autumn_color_to: Option<Colour>,
    /// Whether leaves turn and fall first on the outside of the crown, as in beech and maple, and not inside, as in
    /// birch; in spring they unfold nearly together, not one after another. Default false.
    pub autumn_outside: bool,
}

impl Look {
    /// Returns the season of its leaves, -1 to 1: always summer for an evergreen.
    pub fn leaf_season(&self) -> f64 {
        self.autumn_color.map_or(0.0, |_| self.season)
    }
}

impl Default for Look {
    fn default() -> Self {
        Self {
            bark: Bark::default(),
            ribs: 0,
            rib_depth: 0.15,
            bark_color: Colour([0x6e, 0x62, 0x54]),
            foot_color: None,
            foot_height: 0.2,
            twig_color: Colour([0x6a, 0x58, 0x44]),
            leaf_color: Colour([0x56, 0x7d, 0x2f]),
            leaf_color_to: None,
            leaf_variation: 0.5,
            season: 0.0,
            autumn_color: None,
            autumn_color_to: None,
            autumn_outside: false,
        }
    }
}
