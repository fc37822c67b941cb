//! A species -> a whole flower at any day: bud, bloom, wilting.
//!
//! Petals lie on surfaces of revolution about the flower's axis. Their profile (angle to the axis at base, middle
//! and tip) goes from bud to bloom by the growth law of the region, and on to wilting. Whorls are nested: no petal
//! bends farther out than those outside it. Within a whorl each petal has one edge inside its neighbour and the other
//! outside, or a place of its own in a spiral, so petals may overlap but never meet.

use base::{Budget, Counted, OverBudget, Seed, ops};
use glam::DVec3;
use plant::{Flower, FlowerId, OrganKind, Plant, PlantPaint};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::centre::{Achenes, Disc, Fruit, Stamens};
use crate::cluster::{Cluster, Nods};
use crate::foliage::{Foliage, Ground};
use crate::organs::{Bed, Seat};
use crate::petal::{Falls, Nest, Rows, Times};
use crate::whorl::{PetalForm, Whorl};
use crate::{GrowthLaw, Quantity};

/// A flower that opens. Saved as TOML; the species that come with the program are such files ([`preset`](crate::preset)).
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
    /// How much of the style falls as the fruit grows, 0 to 1, default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub pistil_shed: f64,
    /// Linear colour of the pistil.
    #[schemars(inner(range(min = 0.0, max = 1.0)), extend("x-unit" = "linear-colour"))]
    pub pistil_color: [f32; 3],
    /// Radius of a disc of florets, metres; 0, the default, for none.
    #[schemars(range(min = 0.0, max = 5.0), extend("x-unit" = "m"))]
    pub disc_m: f64,
    /// How the disc looks.
    pub disc: Disc,
    /// The ovary and what grows of it; default none.
    pub fruit: Fruit,
    /// Fruits with a parachute each, as dandelions have; default none.
    pub achenes: Achenes,
    /// Share of the wilting in which the fruit ripens, 0 to 0.9, default 0: it ends with petals withered.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub ripening: f64,
    /// Length of the stalk, metres, 0 to 5, default 0.25; 0 for a flower without one, such as one that is put on a plant.
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
    /// How far bud and wilted flower nod beside the open one.
    pub nods: Nods,
    /// Flowers of an umbel or another cluster, 1 to 200; 1, the default, for a single flower.
    #[schemars(range(min = 1, max = 200))]
    pub umbel: u32,
    /// How the flowers of a cluster stand.
    pub cluster: Cluster,
    /// Its leaves, a kind after the other.
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
    /// How fine a petal is meshed.
    pub mesh: PetalMesh,
}

spec::schemas!(FlowerSpec = include_str!("../schemas/flower.json"));

/// How fine a petal is meshed.
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
    /// A stalk without petals.
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

/// Of stalks, linear.
const STALK: [f32; 3] = [0.16, 0.32, 0.07];

/// Degrees to radians.
pub(crate) fn rad(d: f64) -> f64 {
    d * (ops::PI / 180.0)
}

impl FlowerSpec {
    /// Days from bud to full bloom, and from there to wilted.
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

    /// The growth law of the species itself.
    pub fn own_law(&self) -> GrowthLaw {
        GrowthLaw::logistic(&self.name, self.opening_days, self.rate_per_day)
    }

    /// The flower at `day`: 0 is the bud, `opening_days` full bloom, `wilting_days` later it has wilted.
    ///
    /// Guaranteed: the same axes, organs and grids at every day; `validate()` finds nothing. `law` sets the pace by its
    /// size and region laws, whatever species it was fitted to (Huai, Yang and Cai 2019, figure 13).
    pub fn at(&self, day: f64, law: &GrowthLaw, seed: Seed) -> Plant {
        let paint = PlantPaint { stem: Some(self.stalk_color), ..PlantPaint::default() };
        let mut plant = Plant { name: self.name.clone(), paint, ..Plant::default() };
        self.add_to(&mut plant, &Seat::default(), day, law, seed);
        plant
    }

    /// As [`at`](Self::at), on a plant that there is already.
    pub fn add_to(&self, plant: &mut Plant, seat: &Seat, day: f64, law: &GrowthLaw, seed: Seed) {
        let stalk = self.stalk_at(self.own_day(0, day));
        let bearers = self.stems(plant, seat, &stalk, seed);
        let reach = self.foliage(plant, seat, bearers.first().copied().flatten(), &stalk, seed);
        let mut ground = Ground::new(seat, reach);
        let rings: Vec<Whorl> =
            self.whorls.iter().flat_map(|w| (0..w.rings.max(1)).map(|r| w.ring(r))).collect();
        let rows = Rows::new(self.mesh);
        let falls = Falls::new(&rings);
        for (f, bearer) in (0..).zip(bearers) {
            let own = self.own_day(f, day);
            let times = Times::new(self, law, own);
            let place = self.place(f, day, &stalk);
            let turn = seat.turn * place.turn;
            let at = seat.at(place.centre);
            let (flower, axis) = (FlowerId::new(plant.flowers.len()), turn * DVec3::Y);
            let petals = || rings.iter().filter(|w| !w.sepal);
            let half_angle =
                petals().next().map_or(0.0, |w| w.state(&times, 0.0).angle[1].clamp(0.0, ops::FRAC_PI_2));
            let whorls = u32::try_from(petals().count()).unwrap_or(u32::MAX);
            let axis = axis.normalize_or(DVec3::Y);
            plant.flowers.push(Flower { bearer, centre: at, axis, half_angle, whorls });
            let seed = seed.child(u64::from(f));
            let size = self.bud_size(own);
            let mut bed = Bed { plant: &mut *plant, flower, bearer, place: (at, turn), size, seed };
            if let Some((line, radius)) = self.own_stalk(f, day, &stalk) {
                let line: Vec<DVec3> = line.into_iter().map(|p| seat.at(p)).collect();
                bed.stalk(&line, radius);
            }
            self.receptacle(&mut bed, &times, &rings);
            let mut nest = Nest::new(self.reach());
            for (row, ring) in rings.iter().enumerate() {
                let kind = if ring.sepal { OrganKind::Sepal } else { OrganKind::Petal };
                self.ring(&mut bed, kind, ring, (&times, &rows, (&falls, row)), (&mut nest, &mut ground));
            }
            self.centre(&mut bed, &times, &nest, &rings);
        }
    }

    /// The longest of petals, stamens and pistil, metres.
    fn reach(&self) -> f64 {
        self.whorls.iter().map(|w| w.length_m).fold(self.stamens.length_m.max(self.pistil_m), f64::max)
    }

    /// About how large the open flower is with its stalk, metres.
    pub fn size_m(&self) -> f64 {
        let longest = self.whorls.iter().map(|w| w.length_m).fold(self.disc_m, f64::max);
        let pedicel = if self.umbel > 1 { self.pedicel() + self.cluster.axis_m } else { 0.0 };
        self.stalk_m + pedicel + 2.0 * longest
    }

    /// Petals of this form in all whorls but those of sepals; `aspect` is width over length.
    #[must_use]
    pub fn with_petals(mut self, form: PetalForm, aspect: f64) -> Self {
        for whorl in self.whorls.iter_mut().filter(|w| !w.sepal) {
            whorl.form = Some(form);
            whorl.width_m = whorl.length_m * aspect;
        }
        self
    }

    /// How far the flower as a whole has opened, 0 to 1.
    pub(crate) fn opened(&self, law: &GrowthLaw, day: f64) -> f64 {
        let share = (day / self.opening_days.max(1e-6)).clamp(0.0, 1.0);
        law.progress("petal", Quantity::Size, 0.3, 0.0, law.span_days, share * law.span_days).clamp(0.0, 1.0)
    }
}
