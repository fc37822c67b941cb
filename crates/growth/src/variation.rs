//! Variation between trees of one kind in a wood.
//!
//! `VariationSpec + seed of a root -> Habit -> positions, girth, forks, limbs`

use base::{Draw, Seed, ops};
use glam::{DVec2, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Variation of trees of this kind from seed to seed: in a wood, not on a drawing board. All default to 0: every seed
/// has the same size and stands upright.
///
/// Lengths that scale are those of wood and crown; leaves keep the size of their species. Each root draws for itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct VariationSpec {
    /// Coefficient of variation of the height, 0 to 0.4, default 0; the crown grows with it.
    #[schemars(range(min = 0.0, max = 0.4))]
    pub height: f64,
    /// Coefficient of variation of the crown's width in addition to that of the height, 0 to 0.4, default 0.
    #[schemars(range(min = 0.0, max = 0.4))]
    pub width: f64,
    /// Coefficient of variation of the thickness of wood in addition to that of the crown, 0 to 0.4, default 0.
    #[schemars(range(min = 0.0, max = 0.4))]
    pub girth: f64,
    /// Spread of the lean, degrees, 0 to 30, default 0: half of the trees lean more than 1.2 times this.
    #[schemars(range(min = 0.0, max = 30.0), extend("x-unit" = "deg"))]
    pub lean_deg: f64,
    /// Spread of the share by which a crown reaches farther to one side, 0 to 0.4, default 0.
    #[schemars(range(min = 0.0, max = 0.4))]
    pub asymmetry: f64,
    /// Probability that the trunk forks, 0 to 1, default 0. Used for the envelope `limbs`; rules draw their own forks.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub fork: f64,
    /// Coefficient of variation of the number of limbs, 0 to 0.5, default 0. Used for the envelope `limbs`.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub limbs: f64,
    /// Share of the limbs that storms or shade have removed completely, 0 to 0.5, default 0.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub lost: f64,
    /// Share of the limbs that are dead: without leaves and fine twigs, 0 to 0.9, default 0.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub dead: f64,
}

spec::schemas!(VariationSpec => crate::TreeSpec, "/$defs/VariationSpec");

/// Key under which a seed draws habits, so that its other draws do not change.
const HABIT: u64 = 0x0068_6162_6974;

impl VariationSpec {
    /// Whether every seed has the same size.
    pub(crate) fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Draws the habit of one tree.
    pub(crate) fn habit(&self, seed: Seed, root: u64) -> Habit {
        let own = seed.child(HABIT).child(root);
        // Each number has a stream of its own: a preset that sets one more number keeps the others.
        let drawn = |k: u64| own.child(k).stream(Draw::Habit);
        let factor = |k: u64, cv: f64| 1.0 + cv * drawn(k).normal().clamp(-2.3, 2.3);
        let vector = |k: u64, spread: f64, most: f64| {
            let mut stream = drawn(k);
            DVec2::new(stream.normal(), stream.normal()).clamp_length_max(2.5) * spread.min(most)
        };
        let high = factor(1, self.height);
        Habit {
            high,
            wide: high * factor(2, self.width),
            girth: factor(3, self.girth).max(0.3),
            lean: vector(4, ops::tan(self.lean_deg.to_radians()), 1.0),
            side: vector(5, self.asymmetry, 1.0).clamp_length_max(0.5),
            forks: drawn(6).chance(self.fork),
            limbs: factor(7, self.limbs).max(0.3),
            seed: own,
        }
    }
}

/// Habit drawn for one tree. Positions are relative to its root.
#[derive(Clone, Debug)]
pub(crate) struct Habit {
    /// Factors on height and width.
    pub(crate) high: f64,
    pub(crate) wide: f64,
    /// Factor on radii, in addition to that of the crown.
    pub(crate) girth: f64,
    /// Metres aside for each metre up.
    lean: DVec2,
    /// Side to which the crown reaches farther; its length is the share.
    side: DVec2,
    /// Whether the trunk forks.
    pub(crate) forks: bool,
    /// Factor on the number of limbs.
    pub(crate) limbs: f64,
    /// Seed of the tree's other draws.
    pub(crate) seed: Seed,
}

impl Habit {
    /// Returns the factor on the room of the crown.
    pub(crate) fn volume(&self) -> f64 {
        self.high * self.wide * self.wide
    }

    fn reach(&self, aside: DVec2) -> f64 {
        self.wide * (1.0 + self.side.dot(aside.normalize_or_zero()))
    }

    /// Maps a point of the undeformed tree to this one.
    pub(crate) fn place(&self, p: DVec3) -> DVec3 {
        let (y, flat) = (p.y * self.high, DVec2::new(p.x, p.z));
        let q = flat * self.reach(flat) + self.lean * y;
        DVec3::new(q.x, y, q.y)
    }

    /// Inverts [`place`](Self::place).
    pub(crate) fn back(&self, p: DVec3) -> DVec3 {
        let flat = DVec2::new(p.x, p.z) - self.lean * p.y;
        let q = flat / self.reach(flat);
        DVec3::new(q.x, p.y / self.high, q.y)
    }

    /// Returns a box that contains the images of all points in a box.
    pub(crate) fn around(&self, lo: DVec3, hi: DVec3) -> (DVec3, DVec3) {
        let aside = self.side.length();
        let (least, most) = (self.wide * (1.0 - aside), self.wide * (1.0 + aside));
        let ys = [lo.y * self.high, hi.y * self.high];
        let span = |lo: f64, hi: f64, lean: f64| {
            let (a, b) = ((lo * least).min(lo * most), (hi * least).max(hi * most));
            let shift = ys.map(|y| y * lean);
            (a + shift[0].min(shift[1]), b + shift[0].max(shift[1]))
        };
        let (x, z) = (span(lo.x, hi.x, self.lean.x), span(lo.z, hi.z, self.lean.y));
        (DVec3::new(x.0, ys[0], z.0), DVec3::new(x.1, ys[1], z.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lively() -> VariationSpec {
        VariationSpec {
            height: 0.2,
            width: 0.2,
            girth: 0.1,
            lean_deg: 6.0,
            asymmetry: 0.2,
            fork: 0.5,
            limbs: 0.2,
            ..VariationSpec::default()
        }
    }

    #[test]
    fn places_come_back_and_stay_in_the_box_around_them() {
        for seed in 0..60 {
            let habit = lively().habit(Seed::new(seed), 0);
            let (lo, hi) = (DVec3::new(-2.0, 1.0, 0.5), DVec3::new(3.0, 9.0, 4.0));
            let (below, above) = habit.around(lo, hi);
            for i in 0..27 {
                let at = DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9)) * 0.5;
                let p = lo + (hi - lo) * at;
                let q = habit.place(p);
                assert!(habit.back(q).distance(p) < 1e-9, "{p}");
                assert!(
                    q.cmpge(below - 1e-9).all() && q.cmple(above + 1e-9).all(),
                    "{p} {q} {below} {above}"
                );
            }
        }
    }

    #[test]
    fn a_spec_that_names_nothing_leaves_every_seed_alone() {
        for seed in 0..20 {
            let habit = VariationSpec::default().habit(Seed::new(seed), 3);
            let p = DVec3::new(1.5, 2.5, -0.5);
            assert!(habit.place(p) == p && habit.girth == 1.0 && habit.limbs == 1.0 && !habit.forks);
        }
    }

    #[test]
    fn draws_have_the_spread_that_was_asked_for_and_keep_to_themselves() {
        let highs: Vec<f64> = (0..400).map(|s| lively().habit(Seed::new(s), 0).high).collect();
        let mean = highs.iter().sum::<f64>() / 400.0;
        let cv = (highs.iter().map(|h| (h - mean) * (h - mean)).sum::<f64>() / 400.0).sqrt() / mean;
        assert!((0.17..0.22).contains(&cv) && (mean - 1.0).abs() < 0.03, "{cv} {mean}");
        let fewer = VariationSpec { girth: 0.0, fork: 0.0, ..lively() };
        let (a, b) = (lively().habit(Seed::new(7), 0), fewer.habit(Seed::new(7), 0));
        assert!(a.high == b.high && a.wide == b.wide && a.lean == b.lean && a.girth != b.girth);
    }
}
