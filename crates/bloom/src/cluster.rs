//! Positions of flowers: the nodding stalk, and the flowers of an umbel, a raceme or a spike.

use base::{Seed, ops, turn};
use glam::{DQuat, DVec3};
use plant::{AxisKind, NodeId, Plant};

use crate::organs::Seat;
use crate::parts::ClusterForm;
use crate::wanted::{FlowerSpec, rad};

/// Position and rotation of a flower.
pub(crate) struct Place {
    pub centre: DVec3,
    pub turn: DQuat,
    /// Point at which its own stalk leaves the axis.
    foot: DVec3,
}

/// The line of the stalk on a day, and of the axis that continues it.
pub(crate) struct Stalk {
    /// From the ground upwards.
    pub line: Vec<DVec3>,
    /// The angle at its end, radians.
    nod: f64,
    axis: Vec<DVec3>,
    pub radius: f64,
}

/// Makes a line that begins along +y from `foot` at an angle and bends to another, towards +z.
fn bent(foot: DVec3, long: f64, [from, to]: [f64; 2], steps: u32) -> Vec<DVec3> {
    let fine = 4 * steps;
    let mut line = vec![foot];
    let mut at = foot;
    for k in 0..fine {
        let t = (f64::from(k) + 0.5) / f64::from(fine);
        // It is straight at first.
        let (s, c) = ops::sin_cos(ops::lerp(from, to, ops::smoothstep(0.4, 1.0, t)));
        at += DVec3::new(0.0, c, s) * (long / f64::from(fine));
        if (k + 1).is_multiple_of(4) {
            line.push(at);
        }
    }
    line
}

fn along(line: &[DVec3], t: f64) -> DVec3 {
    let last = line.len() - 1;
    let at = t.clamp(0.0, 1.0) * last as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a row of the line")]
    let low = (at.floor() as usize).min(last.saturating_sub(1));
    line[low].lerp(line[(low + 1).min(last)], at - low as f64)
}

impl Stalk {
    /// Returns the point at a share of its length.
    pub(crate) fn point_at(&self, t: f64) -> DVec3 {
        along(&self.line, t)
    }
}

/// Pieces of the part of a stalk that is straight on every day.
const STILL: usize = 8;

impl FlowerSpec {
    /// Returns the rank of flower `f` in the order in which the flowers of a cluster open, 0 to 1.
    fn turn_of(&self, f: u32) -> f64 {
        let n = self.umbel.max(1);
        let rank = f64::from(f) / f64::from(n.max(2) - 1);
        if self.cluster.form == ClusterForm::Umbel { 1.0 - rank } else { rank }
    }

    /// Returns the own day of flower `f`: flowers of a cluster open one after another.
    pub(crate) fn own_day(&self, f: u32, day: f64) -> f64 {
        if self.umbel <= 1 {
            return day;
        }
        let (spread, whole) = (self.cluster.spread_days, (self.opening_days + self.wilting_days).max(1e-6));
        day * (1.0 + spread / whole) - spread * self.turn_of(f)
    }

    /// Returns the size of a flower as a share: a bud younger than the first day is smaller.
    pub(crate) fn bud_size(&self, own_day: f64) -> f64 {
        (1.0 + 0.9 * own_day / self.opening_days.max(1e-6)).clamp(0.3, 1.0)
    }

    /// Returns the radius of the stalk.
    pub(crate) fn stalk_radius(&self) -> f64 {
        if self.stalk_radius_m > 0.0 {
            return self.stalk_radius_m;
        }
        let petals = self.whorls.first().map_or(0.002, |w| 0.03 * w.length_m + 0.001);
        petals.max(0.28 * self.disc_m).min(0.006)
    }

    /// Returns the stalk on a day, bent to the nodding flower.
    pub(crate) fn stalk_at(&self, day: f64) -> Stalk {
        let [opening, wilting] = [self.opening_days, self.wilting_days].map(|d| d.max(1e-6));
        let open = ops::smoothstep(0.0, 1.0, (day / opening).clamp(0.0, 1.0));
        let wilt = ops::smoothstep(0.0, 1.0, ((day - opening) / wilting).clamp(0.0, 1.0));
        let share = ops::lerp(ops::lerp(self.nods.bud, 1.0, open), self.nods.wilted, wilt);
        let single = self.umbel <= 1;
        let nod = if single { rad((self.nod_deg * share).min(170.0)) } else { 0.0 };
        let line = bent(DVec3::ZERO, self.stalk_m, [0.0, nod], 24);
        let end = line.last().copied().unwrap_or_default();
        let axis = bent(end, self.cluster.axis_m, [0.0, rad(self.cluster.arch_deg)], 16);
        Stalk { line, nod, axis, radius: self.stalk_radius() }
    }

    /// Returns the position and rotation of flower `f`.
    pub(crate) fn place(&self, f: u32, day: f64, stalk: &Stalk) -> Place {
        let n = self.umbel.max(1);
        let end = stalk.line.last().copied().unwrap_or_default();
        if n == 1 {
            return Place { centre: end, turn: turn::about(DVec3::X, stalk.nod), foot: end };
        }
        let t = (f64::from(f) + 0.5) / f64::from(n);
        let spread = rad(self.cluster.spread_deg);
        let golden = f64::from(f) * rad(137.507_8);
        let (foot, tilt, azimuth) = match self.cluster.form {
            // Evenly over a cap (Vogel's spiral), each on its own pedicel.
            ClusterForm::Umbel => (end, ops::acos_clamped(1.0 - t * (1.0 - ops::cos(spread))), golden),
            ClusterForm::Raceme | ClusterForm::Spike => {
                let at = along(&stalk.axis, 0.08 + 0.92 * f64::from(f) / f64::from(n - 1));
                (at, spread * (1.0 - 0.35 * t), golden)
            }
        };
        // The front is towards +z, a quarter of a turn; two ranks remain.
        let ranks = ops::FRAC_PI_2 + rad(34.0) * if f.is_multiple_of(2) { 1.0 } else { -1.0 };
        let azimuth = ops::lerp(azimuth % ops::TAU, ranks, self.cluster.sided);
        let (s, c) = ops::sin_cos(azimuth);
        let direction = DVec3::new(ops::sin(tilt) * c, ops::cos(tilt), ops::sin(tilt) * s);
        let own = self.own_day(f, day);
        let long = self.pedicel() * self.bud_size(own);
        // First about the vertical, so that every flower has its back to the axis.
        let turn = turn::about(DVec3::Y, ops::FRAC_PI_2 - azimuth) * turn::about(DVec3::X, tilt);
        Place { centre: foot + direction * long, turn, foot }
    }

    /// Returns the length of the stalk of one flower of a cluster.
    pub(crate) fn pedicel(&self) -> f64 {
        match (self.cluster.form, self.cluster.pedicel_m > 0.0) {
            (_, true) => self.cluster.pedicel_m,
            (ClusterForm::Spike, false) => self.stalk_radius() + 0.002,
            _ => self.whorls.first().map_or(0.05, |w| 1.1 * w.length_m),
        }
    }

    /// Adds the static parts: the foot of the stalk, or all of it if nothing nods, and the axis of a cluster. Returns
    /// the bearer of each flower.
    pub(crate) fn stems(
        &self,
        plant: &mut Plant,
        seat: &Seat,
        stalk: &Stalk,
        seed: Seed,
    ) -> Vec<Option<NodeId>> {
        let slim = stalk.radius;
        let mut stem = |bearer, line: &[DVec3], radii: [f64; 2], key: Seed| {
            let line: Vec<DVec3> = line.iter().map(|&p| seat.transform(p)).collect();
            let id = plant.add_axis(AxisKind::Stem, bearer, key.number(), &line, None);
            let first = plant.axis(id).nodes.start as usize;
            let last = (line.len() - 1).max(1) as f64;
            for (k, r) in plant.nodes.radius_m[first..].iter_mut().enumerate() {
                *r = ops::lerp(radii[0], radii[1], k as f64 / last);
            }
            plant.axis(id).node_ids().collect::<Vec<_>>()
        };
        let mut nodes = Vec::new();
        if self.stalk_m > 0.0 {
            let still = if self.moves() { &stalk.line[..=STILL] } else { &stalk.line[..] };
            nodes = stem(seat.bearer, still, [slim, slim], seed);
        }
        let bearer = nodes.last().copied().or(seat.bearer);
        if self.umbel <= 1 {
            return vec![bearer];
        }
        let mut rachis = Vec::new();
        if self.cluster.form != ClusterForm::Umbel && self.cluster.axis_m > 0.0 {
            rachis = stem(bearer, &stalk.axis, [slim, 0.5 * slim], seed.child(1 << 20));
        }
        let below = |f: u32| {
            let foot = self.place(f, 0.0, stalk).foot;
            // The nearest node below.
            rachis.iter().zip(&stalk.axis).rev().find(|(_, p)| p.y <= foot.y + 1e-9).map(|(node, _)| *node)
        };
        (0..self.umbel).map(|f| below(f).or(bearer)).collect()
    }

    /// Whether the head of a single stalk nods from day to day.
    fn moves(&self) -> bool {
        self.umbel <= 1 && self.nod_deg > 0.0
    }

    /// Returns the moving part of the stalk of flower `f`, and its radius: the bending part of a single stalk, or its
    /// own stalk in a cluster.
    pub(crate) fn own_stalk(&self, f: u32, day: f64, stalk: &Stalk) -> Option<(Vec<DVec3>, f64)> {
        if self.umbel > 1 {
            let Place { centre, foot, .. } = self.place(f, day, stalk);
            // Rising from the axis, then straight to the flower.
            let middle = foot.lerp(centre, 0.5) + DVec3::Y * (0.06 * foot.distance(centre));
            let bow = |t: f64| foot.lerp(middle, t).lerp(middle.lerp(centre, t), t);
            let line = (0..=6).map(|k| bow(f64::from(k) / 6.0)).collect();
            return Some((line, 0.5 * stalk.radius));
        }
        let moving = self.moves() && self.stalk_m > 0.0;
        moving.then(|| (stalk.line[STILL..].to_vec(), stalk.radius))
    }
}
