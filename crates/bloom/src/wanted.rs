//! Settings of a flower.

use base::{Budget, Counted, OverBudget, ops};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::law::GrowthLaw;
use crate::parts::{Achenes, Cluster, Disc, Foliage, Fruit, Nods, Stamens};
use crate::whorl::Whorl;

/// A flower that opens. Saved as TOML; the species that come with the program are such files
/// ([`preset`](crate::preset)).
///
/// ```
/// let text = "name = \"star\"\nstalk_m = 0.1\n[[whorls]]\ncount = 5\nlength_m = 0.03";
/// let star: bloom::FlowerSpec = spec::from_toml(text)?;
/// assert_eq!((star.whorls[0].count, star.umbel, star.opening_days), (5, 1, 6.0));
/// # Ok::<(), spec::SpecFault>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FlowerSpec {
    /// Name of the species.
    pub name: String,
    /// Rings of petals, outermost first.
    pub whorls: Vec<Whorl>,
    /// Stamens; default none.
    pub stamens: Stamens,
    /// Length of the pistil, metres; 0, the default, for none.
    #[schemars(range(min = 0.0, max = 5.0), extend("x-unit" = "m"))]
    pub pistil_m: f64,
    /// Radius of its style, metres, 0 to 0.05; 0, the default, for one that fits its length.
    #[schemars(range(min = 0.0, max = 0.05), extend("x-unit" = "m"))]
    pub pistil_radius_m: f64,
    /// Share of the style that falls as the fruit grows, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub pistil_shed: f64,
    /// Linear colour of the pistil.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub pistil_color: [f32; 3],
    /// Radius of a disc of florets, metres; 0, the default, for none.
    #[schemars(range(min = 0.0, max = 5.0), extend("x-unit" = "m"))]
    pub disc_m: f64,
    /// Appearance of the disc.
    pub disc: Disc,
    /// The ovary and the fruit that grows from it; default none.
    pub fruit: Fruit,
    /// Fruits with a parachute each, as dandelions have; default none.
    pub achenes: Achenes,
    /// Share of the wilting in which the fruit ripens, 0 to 0.9, default 0: the flower ends with withered petals.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub ripening: f64,
    /// Length of the stalk, metres, 0 to 5, default 0.25; 0 for a flower without one, such as one that is put on a
    /// plant.
    #[schemars(range(min = 0.0, max = 5.0), extend("x-unit" = "m"))]
    pub stalk_m: f64,
    /// Radius of the stalk, metres, 0 to 0.1; 0, the default, for one that fits the flower.
    #[schemars(range(min = 0.0, max = 0.1), extend("x-unit" = "m"))]
    pub stalk_radius_m: f64,
    /// Linear colour of the stalk.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub stalk_color: [f32; 3],
    /// Angle by which the open flower nods, degrees, 0 to 120, default 0.
    #[schemars(range(min = 0.0, max = 120.0), extend("x-unit" = "deg"))]
    pub nod_deg: f64,
    /// Nodding of bud and wilted flower relative to the open one.
    pub nods: Nods,
    /// Flowers of an umbel or another cluster, 1 to 200; 1, the default, for a single flower.
    #[schemars(range(min = 1, max = 200))]
    pub umbel: u32,
    /// Arrangement of the flowers of a cluster.
    pub cluster: Cluster,
    /// Its leaves, one kind after the other.
    pub leaves: Vec<Foliage>,
    /// Days from bud to full bloom, 0.1 to 60, default 6.
    #[schemars(range(min = 0.1, max = 60.0), extend("x-unit" = "d"))]
    pub opening_days: f64,
    /// Days from full bloom to wilted, 0.1 to 40, default 4.
    #[schemars(range(min = 0.1, max = 40.0), extend("x-unit" = "d"))]
    pub wilting_days: f64,
    /// Rate of the flower's own growth law, per day, 0.01 to 100, default 0.95.
    #[schemars(range(min = 0.01, max = 100.0))]
    pub rate_per_day: f64,
    /// Resolution of the mesh of a petal.
    pub mesh: PetalMesh,
}

spec::schemas!(FlowerSpec = include_str!("../schemas/flower.json"));

/// Resolution of the mesh of a petal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PetalMesh {
    /// Rows from base to tip, 2 to 100.
    #[schemars(range(min = 2, max = 100))]
    pub rows: u32,
    /// Columns across, 2 to 100.
    #[schemars(range(min = 2, max = 100))]
    pub columns: u32,
}

impl Default for FlowerSpec {
    /// Returns a stalk without petals.
    fn default() -> Self {
        Self {
            name: "flower".into(),
            whorls: Vec::new(),
            stamens: Stamens::default(),
            pistil_m: 0.0,
            pistil_radius_m: 0.0,
            pistil_shed: 0.0,
            pistil_color: [0.50, 0.64, 0.22],
            disc_m: 0.0,
            disc: Disc::default(),
            fruit: Fruit::default(),
            achenes: Achenes::default(),
            ripening: 0.0,
            stalk_m: 0.25,
            stalk_radius_m: 0.0,
            stalk_color: STALK,
            nod_deg: 0.0,
            nods: Nods::default(),
            umbel: 1,
            cluster: Cluster::default(),
            leaves: Vec::new(),
            opening_days: 6.0,
            wilting_days: 4.0,
            rate_per_day: 0.95,
            mesh: PetalMesh { rows: 18, columns: 14 },
        }
    }
}

/// Colour of stalks, linear.
const STALK: [f32; 3] = [0.16, 0.32, 0.07];

/// Converts degrees to radians.
pub(crate) fn rad(d: f64) -> f64 {
    d * (ops::PI / 180.0)
}

impl FlowerSpec {
    /// Returns the days from bud to full bloom, and from there to wilted.
    pub const fn days(&self) -> [f64; 2] {
        [self.opening_days, self.wilting_days]
    }

    /// Fails if its petals have more triangles than the budget allows.
    ///
    /// # Errors
    /// [`OverBudget`].
    pub fn check(&self, budget: &Budget) -> Result<(), OverBudget> {
        let petals: u64 = self.whorls.iter().map(|w| u64::from(w.count) * u64::from(w.rings)).sum();
        let each = 2 * u64::from(self.mesh.rows) * u64::from(self.mesh.columns);
        let flower = petals.saturating_mul(each) + u64::from(self.achenes.count) * 100;
        let all = flower.saturating_mul(u64::from(self.umbel));
        budget.check(Counted::Triangles, all, "lower count, rings, umbel or mesh")
    }

    /// Returns the growth law of the species itself.
    pub fn own_law(&self) -> GrowthLaw {
        GrowthLaw::logistic(&self.name, self.opening_days, self.rate_per_day)
    }
}
