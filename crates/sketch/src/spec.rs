//! The settings of the sketch maker.

use reading::Kind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the depth of branches is found (He and Cheng 2021, section 5.2).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BranchDepth {
    /// Eq 4 as printed: the sum of the angles between siblings.
    Paper,
    /// Riesz energy of the angles: siblings spread evenly (the sum cannot tell even from two clumps).
    #[default]
    Riesz,
}

/// How the depth of leaves is found (He and Cheng 2021, section 5.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LeafDepth {
    /// The light prior as printed: every leaf turns to the same side.
    Paper,
    /// The light prior with left and right kept.
    Signed,
    /// The front view of the model is the drawing; the blade leaves the plane by tilt and bend only.
    #[default]
    Drawn,
}

/// The coefficients of Eq 2 by the names of Fig 2 (He and Cheng 2021): the more the contour pulls, the wider twigs
/// stand off from their bearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PullSet {
    /// Fig 2a: 0.45, 0.45, 0.1.
    Fig2a,
    /// Fig 2b: 0.55, 0.35, 0.1.
    Fig2b,
    /// Fig 2c with the sum that a and b have: 0.65, 0.25, 0.1.
    Fig2c,
    /// Fig 2c as printed, very likely by mistake: 0.65, 0.35, 0.1.
    Fig2cPrinted,
}

impl PullSet {
    /// Every set.
    pub const ALL: [Self; 4] = [Self::Fig2a, Self::Fig2b, Self::Fig2c, Self::Fig2cPrinted];

    /// Returns `contour_pull`, `bearer_pull` and `memory`.
    pub const fn coefficients(self) -> [f64; 3] {
        match self {
            Self::Fig2a => [0.45, 0.45, 0.1],
            Self::Fig2b => [0.55, 0.35, 0.1],
            Self::Fig2c => [0.65, 0.25, 0.1],
            Self::Fig2cPrinted => [0.65, 0.35, 0.1],
        }
    }
}

/// Eq 2: growth of twigs and midribs inside a contour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FillSpec {
    /// Named coefficients. Where they are given, `contour_pull`, `bearer_pull` and `memory` do not count.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set: Option<PullSet>,
    /// Attraction by the contour, `k_p`. 0 to 1, default 0.55 (Fig 2b of the paper).
    #[schemars(range(min = 0.0, max = 1.0))]
    pub contour_pull: f64,
    /// Attraction along the bearer, `k_b`. 0 to 1, default 0.35.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub bearer_pull: f64,
    /// Memory of the last direction, `k_m`. 0 to 1, default 0.1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub memory: f64,
    /// How many twigs and leaves relative to the default, 0.1 to 10, default 1.
    #[schemars(range(min = 0.1, max = 10.0))]
    pub density: f64,
    /// Pull against gravity on grown twigs, -1 (weeping) to 1 (upright), default 0.1.
    #[schemars(range(min = -1.0, max = 1.0))]
    pub tropism: f64,
}

impl Default for FillSpec {
    fn default() -> Self {
        let [contour_pull, bearer_pull, memory] = PullSet::Fig2b.coefficients();
        Self { set: None, contour_pull, bearer_pull, memory, density: 1.0, tropism: 0.1 }
    }
}

/// Eq 7: how an axis thins from base to tip: r(x) = (s^(-alpha x) + m) / (1 + m).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TaperSpec {
    // Beyond the bounds of these three an axis is a thread or a post.
    /// s, above 1, default 100.
    #[schemars(range(min = 1.001, max = 1e6))]
    pub s: f64,
    /// alpha, above 0, default 0.5.
    #[schemars(range(min = 0.001, max = 10.0))]
    pub alpha: f64,
    /// m, 0 or more, default 0: the tip is 0.1 of the base.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub m: f64,
}

impl Default for TaperSpec {
    fn default() -> Self {
        Self { s: 100.0, alpha: 0.5, m: 0.0 }
    }
}

/// Eq 5 and section 6.2: how blades bend and hollow, as shares of their length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ReliefSpec {
    /// A of Eq 5 for petals, -0.2 to 0.2, default 0.08.
    #[schemars(range(min = -0.2, max = 0.2))]
    pub petal_bend_a: f64,
    /// B of Eq 5 for petals, -0.3 to 0.5, default 0.06.
    #[schemars(range(min = -0.3, max = 0.5))]
    pub petal_bend_b: f64,
    /// Hollow of petals, 0 to 0.3, default 0.08.
    #[schemars(range(min = 0.0, max = 0.3))]
    pub petal_hollow: f64,
    /// A of Eq 5 for leaves, default 0.05.
    #[schemars(range(min = -0.2, max = 0.2))]
    pub leaf_bend_a: f64,
    /// B of Eq 5 for leaves, default 0.18.
    #[schemars(range(min = -0.3, max = 0.5))]
    pub leaf_bend_b: f64,
    /// Fold of leaves along the midrib, slope of the halves, 0 to 1, default 0.25.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub leaf_fold: f64,
}

impl Default for ReliefSpec {
    fn default() -> Self {
        Self {
            petal_bend_a: 0.08,
            petal_bend_b: 0.06,
            petal_hollow: 0.08,
            leaf_bend_a: 0.05,
            leaf_bend_b: 0.18,
            leaf_fold: 0.25,
        }
    }
}

/// All settings of the sketch maker; saved with the document. The maker itself accepts any numbers: it clamps those
/// that would break it.
///
/// ```
/// use sketch::SketchSpec;
/// let spec = SketchSpec { gravity: 7.0, ..SketchSpec::default() };
/// assert_eq!(spec::check(&spec).unwrap_err().to_string(), "gravity must be 0 to 1, not 7");
/// assert_eq!(spec::check(&SketchSpec::default()), Ok(()));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SketchSpec {
    /// The kind that every plant is taken for, whatever it looks like. `None`: the kind that explains it best.
    pub read_as: Option<Kind>,
    /// Height of the plant in metres, above 0. `None`: 8 m for a tree, 0.5 m for a herb.
    #[schemars(range(min = 0.001, max = 1000.0), extend("x-unit" = "m"))]
    pub height_m: Option<f64>,
    /// Depth of branches.
    pub branch_depth: BranchDepth,
    /// Depth of leaves.
    pub leaf_depth: LeafDepth,
    /// Flowers (by index in the reading) that face away from the viewer: orthography cannot tell.
    pub flipped_flowers: Vec<u32>,
    /// Pipe model exponent t of Eq 6, 1.8 to 3. `None`: 2 for a tree, 2.5 for a herb.
    #[schemars(range(min = 1.8, max = 3.0))]
    pub pipe_exponent: Option<f64>,
    /// Thinning along an axis.
    pub taper: TaperSpec,
    /// Growth inside contours.
    pub fill: FillSpec,
    /// Bending of blades.
    pub relief: ReliefSpec,
    /// Pull of light (upwards) on recovered branches, -1 to 1, default 0.
    #[schemars(range(min = -1.0, max = 1.0))]
    pub phototropism: f64,
    /// Sag of recovered branches under gravity, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub gravity: f64,
}

spec::schemas!(SketchSpec = include_str!("../schemas/sketch.json"));
