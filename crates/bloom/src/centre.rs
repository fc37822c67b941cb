//! Stamens, pistil, disc and stalk of a flower at one day.

use base::{Draw, Seed, ops};
use glam::DVec3;
use plant::{AxisKind, NodeId, OrganKind, Plant};

use crate::flower::{FlowerSpec, Stamens, rad};
use crate::organs::{Bed, Grid, Seat};

impl FlowerSpec {
    /// Stamens, pistil and disc: `g` is how far the flower has opened, `wilt` how far it has wilted, 0 to 1.
    pub(crate) fn centre(&self, bed: &mut Bed<'_>, g: f64, wilt: f64) {
        let heights = || self.whorls.iter().map(|w| w.insertion.height_m);
        let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(0.0, f64::max));
        let base = if low.is_finite() { low } else { 0.0 };
        for k in 0..self.stamens.count {
            self.stamen(bed, k, [g, wilt, base]);
        }
        if self.pistil_m > 0.0 {
            pistil(bed, self.pistil_m * ops::lerp(0.5, 1.0, g), self.pistil_m, base, wilt);
        }
        if self.disc_m > 0.0 {
            florets(bed, self.disc_m * ops::lerp(0.75, 1.0, g), high, [g, wilt]);
        }
    }

    /// A filament that bends outwards, and an anther across its end.
    fn stamen(&self, bed: &mut Bed<'_>, k: u32, [g, wilt, base]: [f64; 3]) {
        let seed = bed.seed.child(u64::from(k));
        let Stamens { count, length_m: length, spread_deg: spread } = self.stamens;
        let ring = f64::from(k) / f64::from(count.max(1));
        let tilt = rad(spread * ops::lerp(0.25, 1.0, g) * ops::lerp(0.6, 1.0, ring) + 18.0 * wilt);
        let long =
            length * ops::lerp(0.45, 1.0, g) * seed.stream(Draw::Size).range(0.9, 1.0) * (1.0 - 0.2 * wilt);
        // A few stamens stand in a ring, many in Vogel's spiral.
        let turn = if count <= 12 { ops::TAU * ring } else { f64::from(k) * rad(137.507_8) };
        let (s, c) = ops::sin_cos(turn);
        let out = DVec3::new(c, 0.0, s);
        let foot = DVec3::new(0.0015 * c, base, 0.0015 * s);
        let at = |t: f64| {
            // Steeper at its foot, leaning out towards its end.
            let (sin, cos) = ops::sin_cos(tilt * (0.5 + 0.7 * t));
            foot + (out * sin + DVec3::Y * cos) * (long * t)
        };
        let thick = (0.010 * length).clamp(0.0002, 0.0010);
        let line: Vec<DVec3> = (0..=6).map(|i| at(f64::from(i) / 6.0)).collect();
        let radii: Vec<f64> = (0..=6).map(|i| thick * (1.0 - 0.5 * f64::from(i) / 6.0)).collect();
        bed.strand(OrganKind::Stamen, &line, &radii, [0.72, 0.78, 0.48]);
        let half = (0.085 * length).clamp(0.0009, 0.006) * ops::lerp(0.7, 1.0, g);
        let across = (DVec3::Y.cross(out) + out * 0.25 + DVec3::Y * 0.2).try_normalize().unwrap_or(DVec3::X);
        let tip = at(1.0);
        let line: Vec<DVec3> = (0..=4).map(|i| tip + across * (half * (f64::from(i) / 2.0 - 1.0))).collect();
        let fat = 0.24 * half + 0.8 * thick;
        // Open anthers are dusted with pollen; later they shrink and darken.
        let [fresh, old] = [[0.74_f32, 0.32, 0.04], [0.22, 0.10, 0.03]];
        #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
        let w = wilt as f32;
        let color = [0, 1, 2].map(|q| fresh[q] + (old[q] - fresh[q]) * w);
        let radii = [0.25, 0.85, 1.0, 0.85, 0.25].map(|r| r * fat * (1.0 - 0.35 * wilt));
        bed.strand(OrganKind::Anther, &line, &radii, color);
    }

    /// The stalk, bent towards where the head nods, and stalks of an umbel: what bears each flower.
    pub(crate) fn stalks(&self, plant: &mut Plant, seat: &Seat, day: f64, seed: Seed) -> Vec<Option<NodeId>> {
        let thick = self.whorls.first().map_or(0.002, |w| 0.03 * w.length_m + 0.001).max(0.28 * self.disc_m);
        let slim = thick.min(0.006);
        let mut stem = |bearer, line: &[DVec3], radius: f64, key: Seed| {
            let line: Vec<DVec3> = line.iter().map(|&p| seat.at(p)).collect();
            let id = plant.add_axis(AxisKind::Stem, bearer, key.number(), &line, None);
            let first = plant.axis(id).nodes.start as usize;
            plant.nodes.radius_m[first..].fill(radius);
            plant.axis(id).node_ids().last()
        };
        let mut bearer = seat.bearer;
        if self.stalk_m > 0.0 {
            let end = if self.umbel > 1 { DVec3::Y * self.stalk_m } else { self.place(0, day).0 };
            // Straight up at the foot; at the end half as steep as the head nods.
            let (s, c) = ops::sin_cos(rad(if self.umbel > 1 { 0.0 } else { 0.8 * self.nod_deg }));
            let foot = DVec3::Y * (0.55 * self.stalk_m);
            let back = end - DVec3::new(0.0, c, s) * (0.22 * self.stalk_m);
            let at = |t: f64| {
                let (a, b, d) = (DVec3::ZERO.lerp(foot, t), foot.lerp(back, t), back.lerp(end, t));
                a.lerp(b, t).lerp(b.lerp(d, t), t)
            };
            let line: Vec<DVec3> = (0..=12).map(|i| at(f64::from(i) / 12.0)).collect();
            bearer = stem(bearer, &line, slim, seed);
        }
        if self.umbel <= 1 {
            return vec![bearer];
        }
        let pedicel = |f: u32| {
            let foot = DVec3::Y * self.stalk_m;
            let place = self.place(f, day).0;
            let middle = foot.lerp(place, 0.5) + DVec3::Y * 0.004;
            stem(bearer, &[foot, middle, place], 0.5 * slim, seed.child(u64::from(f)))
        };
        (0..self.umbel).map(pedicel).collect()
    }

    /// What joins stalk and petals: from the stalk up along the feet of sepals and petals, and to the axis.
    pub(crate) fn receptacle(&self, bed: &mut Bed<'_>) {
        let wide = self.whorls.iter().map(|w| w.insertion.radius_m).fold(0.0, f64::max).max(self.disc_m);
        let low = -0.6 * wide - 0.002;
        let mut rings = vec![[0.08 * wide, low], [0.6 * wide, 0.45 * low]];
        rings.extend(self.whorls.iter().map(|w| [1.01 * w.insertion.radius_m, w.insertion.height_m]));
        let top = rings.last().map_or(0.0, |r| r[1]);
        rings.push([0.02 * wide, top + 0.0004]);
        bed.turned(OrganKind::Pedicel, &rings);
    }
}

fn pistil(bed: &mut Bed<'_>, long: f64, full: f64, base: f64, wilt: f64) {
    let thick = (0.016 * full).clamp(0.0005, 0.0022);
    // Ovary, style, stigma.
    let parts =
        [(0.0, 1.6), (0.1, 2.0), (0.22, 1.1), (0.6, 0.8), (0.93, 0.9), (0.96, 2.0), (0.99, 2.2), (1.0, 1.2)];
    let line = parts.map(|p| DVec3::new(0.0, base + p.0 * long, 0.0));
    let radii = parts.map(|p| p.1 * thick);
    #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
    let w = 0.5 * wilt as f32;
    bed.strand(OrganKind::Pistil, &line, &radii, [0.50, 0.64, 0.22].map(|x: f32| x * (1.0 - w)));
}

/// A dome of florets in Vogel's spiral (phyllotaxis of 137.5 degrees): they open, with pollen, from the rim inwards.
fn florets(bed: &mut Bed<'_>, radius: f64, base: f64, [g, wilt]: [f64; 2]) {
    let height = |share: f64| base + 0.30 * radius * (1.0 - share) - 0.001;
    let mut floor = Grid {
        points: Vec::new(),
        across: (0..=24).map(|k| f64::from(k) / 24.0).collect(),
        along: (0..=6).map(|i| f64::from(i) / 6.0).collect(),
        colors: vec![[0.05, 0.035, 0.012]; 7 * 25],
    };
    for i in 0..=6 {
        let r = f64::from(i) / 6.0;
        let y = if i == 6 { base - 0.25 * radius } else { height(r * r) };
        let r = radius * if i == 6 { 0.9 } else { r };
        // Round the other way: a sheet's upper side has its columns from right to left.
        for k in (0..=24).rev() {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 24.0);
            floor.points.push(DVec3::new(r * c, y, r * s));
        }
    }
    bed.around(OrganKind::Disc, DVec3::Y * base, floor);
    let count = 280;
    for k in 0..count {
        let share = (f64::from(k) + 0.5) / f64::from(count);
        let r = radius * share.sqrt();
        let (s, c) = ops::sin_cos(f64::from(k) * rad(137.507_8));
        let foot = DVec3::new(r * c, height(share) - 0.001, r * s);
        // Blooming: the ring between the rim and where the opening has come.
        let front = 1.0 - 0.75 * g * g;
        let bloom = ops::smoothstep(front, front + 0.15, share) * (1.0 - wilt);
        let long = radius * (0.05 + 0.05 * bloom) + 0.0015;
        let up = DVec3::new(0.5 * c * share, 1.0, 0.5 * s * share).normalize_or(DVec3::Y);
        let [bud, pollen, dry] = [[0.115, 0.105, 0.022], [0.50, 0.235, 0.018], [0.055, 0.030, 0.012]];
        let color = [0, 1, 2].map(|q| {
            let young = ops::lerp(bud[q], [0.10, 0.045, 0.012][q], share);
            #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
            let x = ops::lerp(ops::lerp(young, pollen[q], 0.85 * bloom), dry[q], wilt) as f32;
            x
        });
        let line = [0.0, 0.6, 1.0].map(|t| foot + up * (t * long));
        let fat = 0.047 * radius;
        bed.strand(OrganKind::Floret, &line, &[fat, fat, 0.45 * fat], color);
    }
}
