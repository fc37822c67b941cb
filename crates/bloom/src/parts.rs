//! Settings of the parts of a flower other than its petals: stamens, disc, fruit, clusters, leaves.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The stamens of a flower.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Stamens {
    /// Number of stamens, 0 to 500.
    #[schemars(range(min = 0, max = 500))]
    pub count: u32,
    /// Length of one in an open flower, metres.
    #[schemars(range(min = 0.0, max = 5.0), extend("x-unit" = "m"))]
    pub length_m: f64,
    /// Angle by which they spread from the axis, degrees, 0 to 180.
    #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "deg"))]
    pub spread_deg: f64,
    /// Distance of their feet from the axis, metres, 0 to 0.2; 0, the default, for close round the pistil.
    #[schemars(range(min = 0.0, max = 0.2), extend("x-unit" = "m"))]
    pub foot_m: f64,
    /// Linear colour of the filaments.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub filament_color: [f32; 3],
    /// Linear colour of the anthers with their pollen.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub anther_color: [f32; 3],
    /// Length of an anther as a share of the stamen, 0.02 to 0.9, default 0.17.
    #[schemars(range(min = 0.02, max = 0.9))]
    pub anther: f64,
    /// Share of the wilting at which they fall, from 0, not at all, to 1, before the petals; default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub shed: f64,
}

impl Default for Stamens {
    /// Returns settings for no stamens.
    fn default() -> Self {
        Self {
            count: 0,
            length_m: 0.0,
            spread_deg: 0.0,
            foot_m: 0.0,
            filament_color: [0.72, 0.78, 0.48],
            anther_color: [0.74, 0.32, 0.04],
            anther: 0.17,
            shed: 0.0,
        }
    }
}

/// The disc of florets in the middle of a flower head.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Disc {
    /// Florets, 10 to 1000, default 280.
    #[schemars(range(min = 10, max = 1000))]
    pub florets: u32,
    /// Height of the dome as a share of its radius, 0 to 1.5, default 0.3.
    #[schemars(range(min = 0.0, max = 1.5))]
    pub dome: f64,
    /// Linear colour of florets that are still closed.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub young_color: [f32; 3],
    /// Linear colour of open florets with their pollen.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub open_color: [f32; 3],
    /// Linear colour of the dome under the florets and of withered florets.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub dry_color: [f32; 3],
}

impl Default for Disc {
    /// Returns the disc of a sunflower.
    fn default() -> Self {
        Self {
            florets: 280,
            dome: 0.3,
            young_color: [0.115, 0.105, 0.022],
            open_color: [0.50, 0.235, 0.018],
            dry_color: [0.055, 0.030, 0.012],
        }
    }
}

/// The ovary and the fruit that grows from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Fruit {
    /// Length of the ripe fruit, metres; 0, the default, for none.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "m"))]
    pub length_m: f64,
    /// Its greatest width, metres, default 0.01.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "m"))]
    pub width_m: f64,
    /// Size of the ovary in full bloom as a share of the ripe fruit, 0.05 to 1, default 0.4.
    #[schemars(range(min = 0.05, max = 1.0))]
    pub ovary: f64,
    /// Place of the greatest width, 0.2 to 0.8, default 0.5.
    #[schemars(range(min = 0.2, max = 0.8))]
    pub widest: f64,
    /// Radius of a cap of stigmas on it, as a share of its own, 0 to 1.2, default 0.
    #[schemars(range(min = 0.0, max = 1.2))]
    pub cap: f64,
    /// Number of ribs around it, 0 to 20, default 0.
    #[schemars(range(min = 0, max = 20))]
    pub ribs: u32,
    /// It grows below petals and sepals (an inferior ovary, a hip). Default false.
    pub below: bool,
    /// Linear colour of the ovary.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub color: [f32; 3],
    /// Linear colour of the ripe fruit.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub ripe_color: [f32; 3],
}

impl Default for Fruit {
    /// Returns settings for no fruit.
    fn default() -> Self {
        Self {
            length_m: 0.0,
            width_m: 0.01,
            ovary: 0.4,
            widest: 0.5,
            cap: 0.0,
            ribs: 0,
            below: false,
            color: [0.16, 0.3, 0.07],
            ripe_color: [0.16, 0.3, 0.07],
        }
    }
}

/// Fruits with a parachute each, all around the head: a dandelion's clock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Achenes {
    /// Number of fruits, 0 to 400, default none.
    #[schemars(range(min = 0, max = 400))]
    pub count: u32,
    /// From the head to the parachute, metres, default 0.016.
    #[schemars(range(min = 0.0, max = 0.5), extend("x-unit" = "m"))]
    pub length_m: f64,
    /// Radius of the head that bears them, metres, default 0.004.
    #[schemars(range(min = 0.0, max = 0.5), extend("x-unit" = "m"))]
    pub head_m: f64,
    /// Linear colour of the fruits.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub color: [f32; 3],
}

impl Default for Achenes {
    /// Returns settings for no achenes.
    fn default() -> Self {
        Self { count: 0, length_m: 0.016, head_m: 0.004, color: [0.16, 0.1, 0.04] }
    }
}

/// Arrangement of the flowers of a cluster.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Cluster {
    /// Its kind.
    pub form: ClusterForm,
    /// Length of the axis that bears a raceme or a spike, metres, default 0.
    #[schemars(range(min = 0.0, max = 5.0), extend("x-unit" = "m"))]
    pub axis_m: f64,
    /// Length of the stalk of one flower, metres; 0, the default, for one that fits the flower.
    #[schemars(range(min = 0.0, max = 2.0), extend("x-unit" = "m"))]
    pub pedicel_m: f64,
    /// Widest angle of the stalks of flowers to the axis, degrees, 0 to 150, default 75.
    #[schemars(range(min = 0.0, max = 150.0), extend("x-unit" = "deg"))]
    pub spread_deg: f64,
    /// Days from the first flower that opens to the last, 0 to 60, default 0. The days of opening and wilting are those
    /// of the cluster.
    #[schemars(range(min = 0.0, max = 60.0), extend("x-unit" = "d"))]
    pub spread_days: f64,
    /// Share to which all flowers turn to the front, from 0, evenly around, to 1; default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub sided: f64,
    /// Angle by which the axis arches over, degrees, 0 to 120, default 0.
    #[schemars(range(min = 0.0, max = 120.0), extend("x-unit" = "deg"))]
    pub arch_deg: f64,
}

/// Kinds of clusters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ClusterForm {
    /// All stalks from one point; outer flowers open first.
    #[default]
    Umbel,
    /// Flowers along an axis, each on a stalk; lower ones open first.
    Raceme,
    /// Flowers along an axis, without stalks.
    Spike,
}

impl Default for Cluster {
    /// Returns an umbel whose flowers open together.
    fn default() -> Self {
        Self {
            form: ClusterForm::Umbel,
            axis_m: 0.0,
            pedicel_m: 0.0,
            spread_deg: 75.0,
            spread_days: 0.0,
            sided: 0.0,
            arch_deg: 0.0,
        }
    }
}

/// Nodding of bud and wilted flower, as shares of the angle of the open one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Nods {
    /// Share of the bud, 0 to 40, default 0.35.
    #[schemars(range(min = 0.0, max = 40.0))]
    pub bud: f64,
    /// Share of the wilted flower, 0 to 40, default 1.6.
    #[schemars(range(min = 0.0, max = 40.0))]
    pub wilted: f64,
}

impl Default for Nods {
    /// Buds stand, wilted heads hang.
    fn default() -> Self {
        Self { bud: 0.35, wilted: 1.6 }
    }
}

/// Leaves of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Foliage {
    /// Number of leaves, 1 to 200, default 3.
    #[schemars(range(min = 1, max = 200))]
    pub count: u32,
    /// Leaves at one node, 1 to 12, default 1.
    #[schemars(range(min = 1, max = 12))]
    pub at_node: u32,
    /// Angle from one node to the next about the stalk, degrees, default 137.5.
    #[schemars(range(min = -360.0, max = 360.0), extend("x-unit" = "deg"))]
    pub divergence_deg: f64,
    /// Turn of the first about the stalk, degrees, default 0.
    #[schemars(range(min = -360.0, max = 360.0), extend("x-unit" = "deg"))]
    pub phase_deg: f64,
    /// Place of the lowest on the stalk as a share of its length, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub from: f64,
    /// Place of the highest, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub to: f64,
    /// Length of the blade, or of a leaflet, metres, default 0.08.
    #[schemars(range(min = 1e-3, max = 5.0), extend("x-unit" = "m"))]
    pub length_m: f64,
    /// Greatest width, metres, default 0.03.
    #[schemars(range(min = 1e-4, max = 5.0), extend("x-unit" = "m"))]
    pub width_m: f64,
    /// Length of the stalk of the leaf, metres, default 0. For a compound leaf it includes the part that bears
    /// leaflets.
    #[schemars(range(min = 0.0, max = 2.0), extend("x-unit" = "m"))]
    pub petiole_m: f64,
    /// Leaflets of a pinnate leaf, 1 to 21, default 1: a simple leaf.
    #[schemars(range(min = 1, max = 21))]
    pub leaflets: u32,
    /// Place of the greatest width along the blade, 0.1 to 0.9, default 0.4.
    #[schemars(range(min = 0.1, max = 0.9))]
    pub widest: f64,
    /// Width at the base as a share of the greatest, 0 to 1, default 0.1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub base: f64,
    /// Pointedness of the tip, 0 round to 1, default 0.9.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub point: f64,
    /// Length of the basal lobes on both sides of the stalk, as a share of the blade's length, 0 to 0.6, default 0.
    #[schemars(range(min = 0.0, max = 0.6))]
    pub heart: f64,
    /// Lobes or teeth per side, 0 to 20, default 0.
    #[schemars(range(min = 0, max = 20))]
    pub lobes: u32,
    /// Their depth as a share of half the width, 0 to 0.9, default 0.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub lobe_depth: f64,
    /// Angle to the stalk at base, middle and tip, degrees.
    #[schemars(inner(range(min = -90.0, max = 270.0)), extend("x-unit" = "deg"))]
    pub angle_deg: [f64; 3],
    /// Reduction of the angle of the last ones, which stand steeper, as a share, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub steeper: f64,
    /// Reduction of the size of the last ones, as a share, 0 to 0.9, default 0.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub smaller: f64,
    /// Distance between neighbours, one within the other, if several stand at one place, metres, default 0.
    #[schemars(range(min = 0.0, max = 0.5), extend("x-unit" = "m"))]
    pub gap_m: f64,
    /// Angle by which both halves are raised, degrees, -60 to 80, default 12.
    #[schemars(range(min = -60.0, max = 80.0), extend("x-unit" = "deg"))]
    pub fold_deg: f64,
    /// Linear colour.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub color: [f32; 3],
}

impl Default for Foliage {
    /// Returns three lance-shaped leaves at the foot.
    fn default() -> Self {
        Self {
            count: 3,
            at_node: 1,
            divergence_deg: 137.5,
            phase_deg: 0.0,
            from: 0.0,
            to: 0.0,
            length_m: 0.08,
            width_m: 0.03,
            petiole_m: 0.0,
            leaflets: 1,
            widest: 0.4,
            base: 0.1,
            point: 0.9,
            heart: 0.0,
            lobes: 0,
            lobe_depth: 0.0,
            angle_deg: [35.0, 55.0, 80.0],
            steeper: 0.0,
            smaller: 0.0,
            gap_m: 0.0,
            fold_deg: 12.0,
            color: [0.055, 0.15, 0.03],
        }
    }
}
