//! Crowns of limbs and masses of foliage, drawn anew for each seed.
//!
//! `LimbsSpec + Habit -> courses of trunk and limbs, centres of masses`

use base::ops::{self, PI};
use base::{Draw, Stream, turn};
use glam::{DVec2, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::variation::Habit;

/// A crown of limbs that bear masses of foliage, with sky between them. The spec sets the number of limbs, the seed
/// their positions. Metres, +Y up, relative to the root.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LimbsSpec {
    /// Height above the root at which the profile starts, 0 to 1e6.
    #[schemars(range(min = 0.0, max = 1e6), extend("x-unit" = "m"))]
    pub base_m: f64,
    /// Profile that the crown fills: `(radius, height)`, at least 2 points, heights rising, radii 0 or more.
    #[schemars(with = "Vec<[f64; 2]>", extend("x-unit" = "m"))]
    pub profile: Vec<DVec2>,
    /// Limbs of a tree, 1 to 400; [`variation.limbs`](crate::VariationSpec::limbs) sets how much trees differ.
    #[schemars(range(min = 1, max = 400))]
    pub limbs: u32,
    /// Angle of limbs at the trunk at the foot of the crown and at its top, degrees above the horizontal, -60 to 85,
    /// default 20 and 60.
    #[serde(default = "rise")]
    #[schemars(with = "[f64; 2]", inner(range(min = -60.0, max = 85.0)), extend("x-unit" = "deg"))]
    pub rise_deg: [f64; 2],
    /// Bend of the limbs, -1 (their ends hang) to 1 (they turn up), default 0.
    #[serde(default)]
    #[schemars(range(min = -1.0, max = 1.0))]
    pub bend: f64,
    /// Crookedness of trunk and limbs, 0 (straight) to 1, default 0.2.
    #[serde(default = "crook")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub crook: f64,
    /// Share of the crown's height up to which the trunk does not fork, 0 to 1, default 1: a spruce has 1, an oak a
    /// half.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub leader: f64,
    /// Radius of a mass of foliage, above 0.
    #[schemars(range(min = 1e-3, max = 1e6), extend("x-unit" = "m"))]
    pub mass_m: f64,
    /// Height of a mass over its width, 0.05 to 3, default 0.7: small values make layers.
    #[serde(default = "flat")]
    #[schemars(range(min = 0.05, max = 3.0))]
    pub flat: f64,
    /// Share of each limb, from the trunk on, that bears no mass, 0 to 0.95, default 0.4: the shaded inside.
    #[serde(default = "bare")]
    #[schemars(range(min = 0.0, max = 0.95))]
    pub bare: f64,
    /// Distance from mass to mass along a limb, in radii of a mass, 0.3 to 6, default 1.3.
    #[serde(default = "apart")]
    #[schemars(range(min = 0.3, max = 6.0))]
    pub apart: f64,
    /// Vertical distance between whorls of limbs, metres; default none: limbs stand in a spiral.
    #[serde(default)]
    #[schemars(range(min = 1e-3, max = 1e6), extend("x-unit" = "m"))]
    pub whorl_m: Option<f64>,
}

const fn rise() -> [f64; 2] {
    [20.0, 60.0]
}
const fn crook() -> f64 {
    0.2
}
const fn one() -> f64 {
    1.0
}
const fn flat() -> f64 {
    0.7
}
const fn bare() -> f64 {
    0.4
}
const fn apart() -> f64 {
    1.3
}

/// Result of drawing a [`LimbsSpec`] with a seed, in the coordinates of its tree.
#[derive(Clone, Debug, Default)]
pub(crate) struct Drawn {
    /// Centres of masses of foliage.
    pub(crate) masses: Vec<DVec3>,
    /// Points along trunk and limbs, at most the requested distance apart.
    pub(crate) lines: Vec<DVec3>,
}

/// A stem, from the ground or a fork to its end.
struct Stem {
    /// Height of its start and of its end, and its horizontal displacement there.
    from: f64,
    to: f64,
    origin: DVec2,
    aside: DVec2,
    /// Phases and direction of its waves.
    wave: [f64; 4],
    waves: f64,
}

impl Stem {
    fn point_at_height(&self, y: f64) -> DVec3 {
        let up = ((y - self.from) / (self.to - self.from).max(1e-9)).clamp(0.0, 1.0);
        // It leaves at an angle and soon rises.
        let aside = self.origin + self.aside * (1.0 - (1.0 - up) * (1.0 - up));
        let t = y / self.to.max(1e-9);
        let swing = |a: f64, b: f64| {
            ops::sin(5.0 * t + a) - ops::sin(a) + 0.5 * (ops::sin(11.0 * t + b) - ops::sin(b))
        };
        let [a, b, c, d] = self.wave;
        DVec3::new(aside.x + self.waves * swing(a, b), y, aside.y + self.waves * swing(c, d))
    }
}

impl LimbsSpec {
    /// Draws trunk, limbs and masses; points of lines are at most `step` apart.
    pub(crate) fn draw(&self, habit: &Habit, step: f64) -> Drawn {
        let step = (step / habit.high.max(habit.wide * 1.3).max(1.0)).max(1e-3 * self.height());
        let mut stream = habit.seed.child(100).stream(Draw::Habit);
        let stems = self.stems(habit, &mut stream);
        let mut drawn = Drawn::default();
        for stem in &stems {
            let steps = ((stem.to - stem.from) / step).ceil().max(1.0);
            let at = |i: f64| stem.point_at_height(stem.from + (stem.to - stem.from) * (i / steps));
            drawn.lines.extend(counted(steps).map(|i| at(i + 1.0)));
            // A leader is in leaf from the middle of the crown up.
            if self.leader > 0.95 {
                let mut y = stem.to - 0.6 * self.mass_m * self.flat;
                while y > (self.base_m + 0.5 * self.height()).max(stem.from) {
                    drawn.masses.push(stem.point_at_height(y));
                    y -= self.apart * self.mass_m;
                }
            }
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 1000")]
        let limbs = (f64::from(self.limbs) * habit.limbs).round().clamp(1.0, 1000.0) as u32;
        let turned = stream.range(0.0, ops::TAU);
        for i in 0..limbs {
            let mut own = habit.seed.child(101).child(u64::from(i)).stream(Draw::Habit);
            // 2.4 rad: the golden angle, from which limbs deviate at random as those that received more light.
            let azimuth = turned + 2.399_963_23 * f64::from(i) + 0.35 * own.normal();
            let share = (f64::from(i) + own.range(0.1, 0.9)) / f64::from(limbs);
            self.limb(share, azimuth, &stems, step, &mut own, &mut drawn);
        }
        for p in drawn.masses.iter_mut().chain(&mut drawn.lines) {
            *p = habit.place(*p);
        }
        drawn
    }

    fn height(&self) -> f64 {
        self.profile.last().map_or(1.0, |p| p.y).max(1e-6)
    }

    fn radius(&self, y: f64) -> f64 {
        let above = self.profile.partition_point(|c| c.y <= y).clamp(1, self.profile.len() - 1);
        let (a, b) = (self.profile[above - 1], self.profile[above]);
        ops::lerp(a.x, b.x, ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0))
    }

    /// Returns the height within the crown below which a share of its surface lies.
    fn height_of(&self, share: f64) -> f64 {
        let rows = 48_u32;
        let (high, widest) = (self.height(), self.profile.iter().map(|p| p.x).fold(0.0, f64::max));
        let weight = |i: u32| self.radius(high * (f64::from(i) + 0.5) / f64::from(rows)) + 0.15 * widest;
        let mut left = share * (0..rows).map(weight).sum::<f64>();
        for i in 0..rows {
            let own = weight(i);
            if left <= own {
                return high * (f64::from(i) + left / own) / f64::from(rows);
            }
            left -= own;
        }
        high
    }

    /// Returns the trunk, and its forks.
    fn stems(&self, habit: &Habit, stream: &mut Stream) -> Vec<Stem> {
        let (high, widest) = (self.height(), self.profile.iter().map(|p| p.x).fold(0.0, f64::max));
        let top = self.base_m + high * self.leader.max(0.02)
            - if self.leader > 0.95 { 0.3 * self.mass_m } else { 0.0 };
        let mut phase = || stream.range(0.0, ops::TAU);
        let wave = [phase(), phase(), phase(), phase()];
        let waves = 0.035 * self.crook * (self.base_m + high);
        let none = DVec2::ZERO;
        let trunk = |to: f64| Stem {
            from: 0.0,
            to,
            origin: none,
            aside: none,
            wave,
            waves: waves * to / top.max(1e-9),
        };
        if !habit.forks {
            return vec![trunk(top)];
        }
        let fork = stream.range(0.55 * self.base_m, self.base_m + 0.2 * high).min(0.8 * top).max(0.05 * top);
        let azimuth = stream.range(0.0, ops::TAU);
        let mut stems = vec![trunk(fork)];
        let foot = stems[0].point_at_height(fork);
        for (side, tall) in [(0.0, 1.0), (PI, stream.range(0.78, 0.98))] {
            let to = fork + (top - fork) * tall;
            let aside = turn::direction(azimuth + side) * (0.16 * widest + 0.06 * (top - fork));
            stems.push(Stem { from: fork, to, origin: DVec2::new(foot.x, foot.z), aside, wave, waves: 0.0 });
        }
        stems
    }

    /// Draws one limb with its masses.
    fn limb(&self, share: f64, azimuth: f64, stems: &[Stem], step: f64, own: &mut Stream, drawn: &mut Drawn) {
        let out = turn::direction(azimuth);
        let y = self.height_of(share);
        // A ragged edge: few limbs reach the whole profile, some extend beyond it.
        let ragged = 0.93 + 0.11 * own.normal().clamp(-2.5, 1.2);
        let reach = (self.radius(y) * ragged - 0.75 * self.mass_m).max(0.25 * self.mass_m);
        let rise = ops::lerp(self.rise_deg[0], self.rise_deg[1], y / self.height()) + 5.0 * own.normal();
        let steep = ops::tan(rise.clamp(-70.0, 86.0).to_radians());
        // The stem on its side.
        let trunk = &stems[0];
        let stem = stems.iter().skip(1).max_by(|a, b| a.aside.dot(out).total_cmp(&b.aside.dot(out)));
        let end_y = self.base_m + y;
        let mut start_y = end_y - reach * steep;
        if let Some(whorl) = self.whorl_m {
            start_y = (start_y / whorl).round() * whorl + 0.06 * whorl * own.normal();
        }
        let top = stem.map_or(trunk.to, |s| s.to);
        let start_y = start_y.clamp((0.8 * self.base_m).min(top), top);
        let stem = stem.filter(|s| s.from <= start_y).unwrap_or(trunk);
        let start = stem.point_at_height(start_y.min(stem.to));
        let end = DVec3::new(out.x * reach, end_y.max(start.y - 4.0 * reach), out.y * reach);
        let along = end - start;
        let length = along.length();
        if length < 0.3 * step {
            return;
        }
        let side = DVec3::new(-out.y, 0.0, out.x);
        let (a, b) = (own.range(0.0, ops::TAU), own.range(0.0, ops::TAU));
        let waves = 0.06 * self.crook * length;
        let at = |t: f64| {
            // An arch, and waves that end where the limb does.
            let arch = -self.bend * 0.9 * t * (1.0 - t) * length;
            let held = ops::sin(PI * t);
            let (sway, lift) = (ops::sin(9.0 * t + a) * held, ops::sin(7.0 * t + b) * held);
            start + along * t + DVec3::Y * (arch + 0.6 * waves * lift) + side * (waves * sway)
        };
        let steps = (1.1 * length / step).ceil();
        drawn.lines.extend(counted(steps).map(|i| at((i + 1.0) / steps)));
        self.masses(&at, length, side, own, &mut drawn.masses);
    }

    /// Draws masses from the end of a limb inwards, to its left and right in turn.
    fn masses(
        &self,
        at: &dyn Fn(f64) -> DVec3,
        length: f64,
        side: DVec3,
        own: &mut Stream,
        masses: &mut Vec<DVec3>,
    ) {
        masses.push(at(1.0));
        let mut left = if own.chance(0.5) { 1.0 } else { -1.0 };
        let mut t = 1.0;
        loop {
            // Along a steep limb masses are as close as they are flat, so that none is a ball on a rod.
            let steep = (at(t).y - at((t - 0.1).max(0.0)).y).abs() / (0.1 * length);
            let extent = self.mass_m * ops::lerp(1.0, self.flat.min(1.0), steep.min(1.0));
            t -= self.apart * extent * own.range(0.8, 1.2) / length;
            if t < self.bare {
                break;
            }
            left = -left;
            // A branch of a limb is longer the farther its foot is from the end.
            let aside = (left * self.mass_m * own.range(0.4, 1.0) * (1.0 + 0.8 * (1.0 - t)))
                .clamp(-0.5 * length, 0.5 * length);
            masses.push(at(t) + side * aside + DVec3::Y * (self.mass_m * self.flat * own.range(-0.1, 0.5)));
        }
    }
}

/// Iterates from 0 to `count` - 1, at most 10,000.
fn counted(count: f64) -> impl Iterator<Item = f64> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is bounded")]
    let count = count.clamp(0.0, 1e4) as u32;
    (0..count).map(f64::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::VariationSpec;
    use base::Seed;

    fn spec() -> LimbsSpec {
        LimbsSpec {
            base_m: 2.0,
            profile: vec![DVec2::new(1.0, 0.0), DVec2::new(3.0, 3.0), DVec2::new(0.5, 7.0)],
            limbs: 20,
            rise_deg: rise(),
            bend: 0.1,
            crook: 0.3,
            leader: 0.6,
            mass_m: 0.6,
            flat: 0.7,
            bare: 0.4,
            apart: 1.3,
            whorl_m: None,
        }
    }

    #[test]
    fn lines_have_no_gaps_and_masses_stay_about_the_profile() {
        let lively = VariationSpec { fork: 0.5, height: 0.1, lean_deg: 3.0, ..VariationSpec::default() };
        for seed in 0..40 {
            let habit = lively.habit(Seed::new(seed), 0);
            let drawn = spec().draw(&habit, 0.3);
            assert!(drawn.masses.len() > 30 && drawn.lines.len() > 60, "{}", drawn.masses.len());
            for (i, p) in drawn.lines.iter().enumerate() {
                let near = drawn.lines[..i].iter().chain([&DVec3::ZERO]).map(|q| q.distance(*p));
                let near = near.fold(f64::INFINITY, f64::min);
                assert!(near < 0.66, "{seed}: {p} is {near} from what comes before");
            }
            for m in &drawn.masses {
                let p = habit.back(*m);
                let r = spec().radius(p.y - 2.0) + 0.6;
                assert!(
                    DVec2::new(p.x, p.z).length() < 1.25 * r + 0.3 && p.y > 0.5 && p.y < 9.8,
                    "{seed}: {p}"
                );
            }
        }
    }

    #[test]
    fn another_seed_has_other_limbs() {
        let ends = |seed| spec().draw(&VariationSpec::default().habit(Seed::new(seed), 0), 0.3).masses;
        let (a, b) = (ends(1), ends(2));
        let alike = a.iter().filter(|p| b.iter().any(|q| q.distance(**p) < 0.1)).count();
        assert!(alike < a.len() / 5, "{alike} of {}", a.len());
    }
}
