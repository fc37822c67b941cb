//! Settings of self-organising growth.

use glam::DVec3;
use plant::Phyllotaxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::within;
use crate::{Arrangement, Envelope, GrowthError, Tropism};

/// Model of the light that buds receive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Light {
    /// Shadow propagation: Q = max(C - s + a, 0), direction down the shadow's gradient.
    Shadow {
        /// Side of a voxel, metres; default two internodes.
        #[serde(default)]
        #[schemars(extend("x-unit" = "m"))]
        voxel_m: Option<f64>,
        /// Contribution of a joint to its own voxel, above 0 and at most 100.
        #[schemars(range(min = 1e-6, max = 100.0))]
        a: f64,
        /// Factor by which the shadow decreases from layer to layer, above 1 and at most 100.
        #[schemars(range(min = 1.0, max = 100.0))]
        b: f64,
        /// Layers below that are shaded, 1 to 32.
        #[schemars(range(min = 1, max = 32))]
        layers: u32,
        /// Full light C, above 0.
        #[schemars(range(min = 1e-6, max = 1e6))]
        full: f64,
    },
    /// Light from the sky: each internode bears a square leaf that lies level. Q is the light of an overcast sky on it,
    /// over that in the open, times `full`; direction to where most of it comes from.
    Sky {
        /// Edge of the leaf, metres; default an internode. Buds are not shaded by their own leaf.
        #[serde(default)]
        #[schemars(extend("x-unit" = "m"))]
        leaf_m: Option<f64>,
        /// Lines of light in each of 46 directions, 1,000 to 262,144, default 32,768: more are more exact and slower.
        #[serde(default = "usual_lines")]
        #[schemars(range(min = 1000, max = 262_144))]
        lines: u32,
        /// Q in the open, above 0, default 1.
        #[serde(default = "usual_full")]
        #[schemars(range(min = 1e-6, max = 1e6))]
        full: f64,
    },
    /// Space colonisation: Q = 1 for a bud that is nearest to a free marker in its cone, otherwise 0.
    Space {
        /// Space of the markers, relative to the root.
        envelope: Envelope,
        /// Markers for each tree, 1 to 10 million.
        #[schemars(range(min = 1, max = 10_000_000))]
        markers: u32,
        /// Radius in which a joint removes markers, internodes; 2 in the paper.
        #[schemars(range(min = 0.01, max = 100.0), extend("x-unit" = "internodes"))]
        occupancy: f64,
        /// Radius in which a bud perceives markers, internodes; 4 to 6 in the paper.
        #[schemars(range(min = 0.01, max = 100.0), extend("x-unit" = "internodes"))]
        perception: f64,
        /// Half opening angle of the cone of sight, degrees; 45.
        #[schemars(range(min = 0.1, max = 180.0), extend("x-unit" = "deg"))]
        half_angle_deg: f64,
    },
}

const fn usual_lines() -> u32 {
    32_768
}

const fn usual_full() -> f64 {
    1.0
}

impl Default for Light {
    fn default() -> Self {
        Self::Shadow { voxel_m: None, a: 0.03, b: 1.8, layers: 6, full: 1.0 }
    }
}

/// Distribution of the gathered resource.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Resource {
    /// The extended Borchert-Honda model.
    BorchertHonda {
        /// Bias for the main axis, 0 to 1; 0.46 makes a bush, 0.54 a leader.
        #[schemars(range(min = 0.0, max = 1.0))]
        lambda: f64,
        /// The bias after `lambda_years`; default the same.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1.0))]
        lambda_late: Option<f64>,
    },
    /// The priority model: weights by rank along each axis.
    Priority {
        /// Weight of the tip, above 0.
        #[schemars(range(min = 1e-6, max = 1e6))]
        w_max: f64,
        /// Weight from rank `kappa` on, 0 or more.
        #[schemars(range(min = 0.0, max = 1e6))]
        w_min: f64,
        /// Rank, 1 or more.
        #[schemars(range(min = 1, max = 1000000))]
        kappa: u32,
    },
}

impl Default for Resource {
    fn default() -> Self {
        Self::BorchertHonda { lambda: 0.52, lambda_late: None }
    }
}

/// Self-organising growth. Metres, years, degrees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SelfOrganizingSpec {
    /// Years of growth, 0 to 1000, default 25.
    #[schemars(range(min = 0, max = 1000), extend("x-unit" = "a"))]
    pub years: u32,
    /// Length of an internode at vigour 1, above 0, default 0.25.
    #[schemars(range(min = 0.0001, max = 1000.0), extend("x-unit" = "m"))]
    pub internode_m: f64,
    /// Model of the light of buds.
    pub light: Light,
    /// Distribution of the resource.
    pub resource: Resource,
    /// Years until `lambda_late` holds, default 10.
    #[schemars(extend("x-unit" = "a"))]
    pub lambda_years: u32,
    /// Vigour per unit of light, above 0 and at most 100, default 2.
    #[schemars(range(min = 1e-6, max = 100.0))]
    pub alpha: f64,
    /// Weight xi of the best-lit direction, 0 to 10, default 0.25.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub light_weight: f64,
    /// Weight eta and direction of other influences, default 0.05 upwards.
    pub tropisms: Vec<Tropism>,
    /// Arrangement of the axillary buds, default a golden spiral.
    pub arrangement: Arrangement,
    /// Angle between a shoot and its lateral buds, 0 to 180 degrees, default 60.
    #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "deg"))]
    pub branch_angle_deg: f64,
    /// Standard deviation of that angle and of the azimuths, 0 to 60 degrees, default 4.
    #[schemars(range(min = 0.0, max = 60.0), extend("x-unit" = "deg"))]
    pub jitter_deg: f64,
    /// Light per internode below which a branch is shed, 0 or more, default 0.15.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub shed_below: f64,
    /// Years for which a branch is spared, default 3.
    #[schemars(extend("x-unit" = "a"))]
    pub shed_after_years: u32,
    /// Most internodes of one shoot a year, 1 to 100, default 6.
    #[schemars(range(min = 1, max = 100))]
    pub most_per_shoot: u32,
    /// Exponent n of the pipe model, 1 to 4, default 2.4.
    #[schemars(range(min = 1.0, max = 4.0))]
    pub pipe_exponent: f64,
    /// Radius of a fresh shoot, above 0, default 0.004.
    #[schemars(range(min = 1e-6, max = 10.0), extend("x-unit" = "m"))]
    pub tip_radius_m: f64,
    /// Whether a bud is shaded by its own leaf (Yang et al. 2019 have no correction), default false.
    pub self_shadow: bool,
    /// Most joints of all trees together; growth stops, with a warning, before the year that would exceed it. Default
    /// 200,000: some six million triangles.
    #[schemars(range(min = 1, max = 2_147_483_648_u64))]
    pub max_joints: u32,
}

spec::schemas!(SelfOrganizingSpec => crate::TreeSpec, "/$defs/Method/oneOf/3");

impl Default for SelfOrganizingSpec {
    fn default() -> Self {
        Self {
            years: 25,
            internode_m: 0.25,
            light: Light::default(),
            resource: Resource::default(),
            lambda_years: 10,
            alpha: 2.0,
            light_weight: 0.25,
            tropisms: vec![Tropism { strength: 0.05, ..Tropism::UPWARDS }],
            arrangement: Arrangement::default(),
            branch_angle_deg: 60.0,
            jitter_deg: 4.0,
            shed_below: 0.15,
            shed_after_years: 3,
            most_per_shoot: 6,
            pipe_exponent: 2.4,
            tip_radius_m: 0.004,
            self_shadow: false,
            max_joints: 200_000,
        }
    }
}

/// Values derived from checked numbers.
pub(super) struct Numbers {
    pub(super) phyllotaxis: Phyllotaxis,
    pub(super) pull: DVec3,
}

impl SelfOrganizingSpec {
    pub(super) fn check(&self) -> Result<Numbers, GrowthError> {
        spec::check(self)?;
        if let Light::Shadow { voxel_m: Some(v), .. } = self.light {
            within("light.voxel_m", v, 0.1 * self.internode_m, 1e3, "a tenth of an internode to 1000 m")?;
        }
        if let Light::Sky { leaf_m: Some(v), .. } = self.light {
            let most = "a hundredth of an internode to 10 internodes";
            within("light.leaf_m", v, 0.01 * self.internode_m, 10.0 * self.internode_m, most)?;
        }
        Ok(Numbers { phyllotaxis: self.arrangement.phyllotaxis()?, pull: Tropism::sum(&self.tropisms)? })
    }
}
