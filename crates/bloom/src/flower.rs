//! A whole flower of a species on any day: bud, bloom, wilting.
//!
//! Petals lie on surfaces of revolution about the flower's axis. Their profile (angle to the axis at base, middle and
//! tip) goes from bud to bloom by the growth law of the region, and on to wilting. Whorls are nested: no petal bends
//! farther out than those outside it. Within a whorl each petal has one edge inside its neighbour and the other
//! outside, or a place of its own in a spiral, so petals may overlap but never intersect.

use base::{Seed, ops};
use glam::DVec3;
use plant::{Flower, FlowerId, OrganKind, Plant, PlantPaint};

use crate::foliage::Ground;
use crate::organs::{Bed, Seat};
use crate::petal::{Falls, Nest, Rows, Times};
use crate::wanted::FlowerSpec;
use crate::whorl::{PetalForm, Whorl};
use crate::{GrowthLaw, Quantity};

impl FlowerSpec {
    /// Makes the flower at `day`: 0 is the bud, `opening_days` full bloom, `wilting_days` later it has wilted.
    ///
    /// Guaranteed: the same axes, organs and grids on every day; `validate()` finds nothing. `law` sets the pace by its
    /// size and region laws, whatever species it was fitted to (Huai, Yang and Cai 2019, figure 13).
    pub fn make_on_day(&self, day: f64, law: &GrowthLaw, seed: Seed) -> Plant {
        let paint = PlantPaint { stem: Some(self.stalk_color), ..PlantPaint::default() };
        let mut plant = Plant { name: self.name.clone(), paint, ..Plant::default() };
        self.add_to(&mut plant, &Seat::default(), day, law, seed);
        plant
    }

    /// As [`make_on_day`](Self::make_on_day), on an existing plant.
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
            let at = seat.transform(place.centre);
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
                let line: Vec<DVec3> = line.into_iter().map(|p| seat.transform(p)).collect();
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

    /// Returns the length of the longest of petals, stamens and pistil, metres.
    fn reach(&self) -> f64 {
        self.whorls.iter().map(|w| w.length_m).fold(self.stamens.length_m.max(self.pistil_m), f64::max)
    }

    /// Returns the approximate size of the open flower with its stalk, metres.
    pub fn size_m(&self) -> f64 {
        let longest = self.whorls.iter().map(|w| w.length_m).fold(self.disc_m, f64::max);
        let pedicel = if self.umbel > 1 { self.pedicel() + self.cluster.axis_m } else { 0.0 };
        self.stalk_m + pedicel + 2.0 * longest
    }

    /// Gives the petals of all whorls except sepals this form; `aspect` is width over length.
    #[must_use]
    pub fn with_petals(mut self, form: PetalForm, aspect: f64) -> Self {
        for whorl in self.whorls.iter_mut().filter(|w| !w.sepal) {
            whorl.form = Some(form);
            whorl.width_m = whorl.length_m * aspect;
        }
        self
    }

    /// Returns the degree to which the flower as a whole has opened, 0 to 1.
    pub(crate) fn opened(&self, law: &GrowthLaw, day: f64) -> f64 {
        let share = (day / self.opening_days.max(1e-6)).clamp(0.0, 1.0);
        law.progress("petal", Quantity::Size, 0.3, 0.0, law.span_days, share * law.span_days).clamp(0.0, 1.0)
    }
}
