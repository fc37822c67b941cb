//! Stamens, pistil, disc, fruit and their bearers on one day.

use base::{Draw, ops};
use glam::DVec3;
use plant::OrganKind;

use crate::organs::{Bed, Grid};
use crate::parts::{Achenes, Stamens};
use crate::petal::{Nest, Times};
use crate::wanted::{FlowerSpec, rad};
use crate::whorl::Whorl;

#[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
fn mix(a: [f32; 3], b: [f32; 3], t: f64) -> [f32; 3] {
    [0, 1, 2].map(|q| a[q] + (b[q] - a[q]) * t as f32)
}

/// Fibres of a parachute: points of its rim, every second one drawn in.
const PAPPUS: u32 = 40;

impl FlowerSpec {
    /// Adds stamens, pistil, disc and fruit, within the nest.
    pub(crate) fn centre(&self, bed: &mut Bed<'_>, times: &Times<'_>, nest: &Nest, rings: &[Whorl]) {
        // On top of the receptacle.
        let base = rings.iter().map(|w| w.insertion.height_m).fold(0.0, f64::max);
        let (g, wilt) = (times.open, ops::smoothstep(0.0, 1.0, times.wilt));
        for k in 0..self.stamens.count {
            self.stamen(bed, k, (times, base), nest);
        }
        let ovary = if self.fruit.below { 0.0 } else { self.fruit_size(times) };
        let top = base + self.fruit.length_m * ovary;
        if self.fruit.length_m > 0.0 && !self.fruit.below {
            self.superior(bed, base, times);
        }
        if self.pistil_m > 0.0 {
            let from = if ovary > 0.0 { top - 0.0004 } else { base };
            let bare = self.fruit.length_m > 0.0;
            let left = 1.0 - self.pistil_shed * ops::smoothstep(0.5, 0.9, times.life);
            self.pistil(bed, self.pistil_m * ops::lerp(0.5, 1.0, g) * left, from, (bare, wilt));
        }
        if self.disc_m > 0.0 {
            let fat = 0.8 / f64::from(self.disc.florets.max(10)).sqrt();
            let radius = self.disc_m.min((1.0 - fat) * inner_radius(rings)) * ops::lerp(0.75, 1.0, g);
            self.florets(bed, radius, base + 0.06 * radius, [g, wilt]);
        }
        for k in 0..self.achenes.count {
            self.achene(bed, k, base, times);
        }
    }

    /// Returns the distance of the feet of stamens from the axis: clear of the pistil, within the petals.
    fn stamen_foot(&self) -> f64 {
        let ovary = if self.fruit.below { 0.0 } else { 0.5 * self.fruit.width_m * self.fruit.ovary };
        let pistil = if self.pistil_m > 0.0 { 2.0 * self.pistil_radius() } else { 0.0 };
        let clear = 1.05 * ovary.max(pistil) + self.filament() * 1.6;
        self.stamens.foot_m.max(clear).min(0.7 * self.petal_room())
    }

    fn filament(&self) -> f64 {
        let crowd = (12.0 / f64::from(self.stamens.count.max(1))).clamp(0.25, 1.0);
        (0.010 * self.stamens.length_m).clamp(0.0002, 0.0010).min(0.11 * self.petal_room()) * crowd
    }

    fn pistil_radius(&self) -> f64 {
        let own = (0.016 * self.pistil_m).clamp(0.0005, 0.0022).min(0.2 * self.petal_room());
        if self.pistil_radius_m > 0.0 { self.pistil_radius_m } else { own }
    }

    /// Returns the radius of the free space within the feet of the petals.
    fn petal_room(&self) -> f64 {
        let inner = self.whorls.iter().map(|w| w.ring(w.rings.max(1) - 1).insertion.radius_m);
        inner.fold(f64::INFINITY, f64::min).min(0.1)
    }

    /// Adds a filament that bends outwards, and an anther at its end.
    fn stamen(&self, bed: &mut Bed<'_>, k: u32, (times, base): (&Times<'_>, f64), nest: &Nest) {
        let seed = bed.seed.child(u64::from(k));
        let Stamens { count, length_m: length, spread_deg: spread, .. } = self.stamens;
        let (g, wilt) = (times.open, ops::smoothstep(0.0, 1.0, times.wilt));
        let many = count > 12;
        let ring = (f64::from(k) + 0.5) / f64::from(count.max(1));
        // They fall one after another.
        let gone = self.stamens.shed * (2.0 * times.life - 0.5 * seed.stream(Draw::Tint).uniform());
        let left = (1.0 - 2.5 * gone.clamp(0.0, 0.4)).max(1e-3);
        let lean = if many { ops::lerp(0.15, 1.0, ring.sqrt()) } else { 1.0 };
        let tilt = rad(spread * ops::lerp(0.25, 1.0, g) * lean + 10.0 * wilt);
        let long = length * ops::lerp(0.45, 1.0, g) * seed.stream(Draw::Size).range(0.93, 1.0) * left;
        // A few stamens stand in a ring, many in Vogel's spiral.
        let turn =
            if many { f64::from(k) * rad(137.507_8) } else { ops::TAU * (ring - 0.5 / f64::from(count)) };
        let (s, c) = ops::sin_cos(turn);
        let out = DVec3::new(c, 0.0, s);
        let foot = self.stamen_foot();
        let foot = if many { foot + (0.7 * self.petal_room() - foot).max(0.0) * ring.sqrt() } else { foot };
        let thick = self.filament();
        let mut at = DVec3::new(foot * c, base, foot * s);
        let mut line = vec![at];
        let mut direction = DVec3::Y;
        for i in 0..6 {
            let t = (f64::from(i) + 0.5) / 6.0;
            // Steeper at its foot, leaning out towards its end; always within the nest.
            let held = (nest.limit(long * t) - rad(ops::lerp(0.0, 5.0, t))).max(rad(-8.0));
            let (sin, cos) = ops::sin_cos((tilt * (0.4 + 0.9 * t)).min(held));
            direction = out * sin + DVec3::Y * cos;
            at += direction * (long / 6.0);
            line.push(at);
        }
        let radii: Vec<f64> = (0..=6).map(|i| thick * left * (1.0 - 0.5 * f64::from(i) / 6.0)).collect();
        bed.strand(OrganKind::Stamen, &line, &radii, self.stamens.filament_color);
        // No larger than the room next to its neighbour.
        let head = (at.x * at.x + at.z * at.z).sqrt().max(foot);
        let room = if many {
            0.5 * head.max(0.5 * length * ops::sin(rad(spread) * ops::lerp(0.25, 1.0, g)))
                * (ops::PI / f64::from(count)).sqrt()
        } else {
            0.5 * ops::TAU * head / f64::from(count.max(1))
        };
        // Across its filament it needs more room than along it.
        let broad = if many { f64::INFINITY } else { 0.7 * room };
        let half = (0.5 * self.stamens.anther * length).clamp(0.0004, 0.012).min(broad);
        let half = half * ops::lerp(if many { 0.4 } else { 0.7 }, 1.0, g) * left;
        let sideways = DVec3::Y.cross(out);
        // In the bud along the filament; versatile in the open flower.
        let swing = if many { 0.0 } else { g * g };
        let across = (direction * (1.0 - swing) + sideways * swing).try_normalize().unwrap_or(DVec3::Y);
        let middle = at + direction * (half * (1.0 - swing));
        let line: Vec<DVec3> =
            (0..=4).map(|i| middle + across * (half * (f64::from(i) / 2.0 - 1.0))).collect();
        let fat = (0.36 * half + 0.5 * thick * left).min(if many { 0.42 } else { 0.35 } * room);
        // Open anthers are dusted with pollen; later they shrink and darken.
        let color = mix(self.stamens.anther_color, [0.18, 0.09, 0.03], wilt);
        let radii = [0.25, 0.85, 1.0, 0.85, 0.25].map(|r| r * fat * (1.0 - 0.35 * wilt));
        bed.strand(OrganKind::Anther, &line, &radii, color);
    }

    /// Returns the size of the fruit, as a share of the ripe one.
    fn fruit_size(&self, times: &Times<'_>) -> f64 {
        let young = self.fruit.ovary * ops::lerp(0.6, 1.0, times.open);
        ops::lerp(young, 1.0, ops::smoothstep(0.3, 1.0, times.life.max(0.0)))
    }

    fn fruit_color(&self, times: &Times<'_>) -> [f32; 3] {
        mix(self.fruit.color, self.fruit.ripe_color, ops::smoothstep(0.45, 1.0, times.life.max(0.0)))
    }

    /// Returns the radius of the fruit at a share of its length.
    fn fruit_radius(&self, t: f64) -> f64 {
        let w = self.fruit.widest.clamp(0.2, 0.8);
        let x = if t < w { 1.0 - t / w } else { (t - w) / (1.0 - w) };
        0.5 * self.fruit.width_m * (1.0 - 0.93 * x * x).max(0.0).sqrt()
    }

    /// Adds a fruit inside of the petals, on the axis.
    fn superior(&self, bed: &mut Bed<'_>, base: f64, times: &Times<'_>) {
        let size = self.fruit_size(times);
        let color = self.fruit_color(times);
        let long = self.fruit.length_m * size;
        let mut rings: Vec<[f64; 2]> = (0..=8)
            .map(|i| {
                let t = f64::from(i) / 8.0;
                [size * self.fruit_radius(t), base + long * t]
            })
            .collect();
        if self.fruit.cap > 0.0 {
            // A cap of stigmas on top, as in a poppy.
            let wide = 0.5 * self.fruit.width_m * size * self.fruit.cap;
            let top = base + long;
            let last = rings.len() - 1;
            rings[last][0] = 0.7 * wide;
            rings.extend([
                [wide, top + 0.02 * long],
                [wide, top + 0.06 * long],
                [0.3 * wide, top + 0.16 * long],
            ]);
        }
        rings.push([1e-5, rings.last().map_or(base, |r| r[1]) + 0.01 * long]);
        let columns = 24_u32;
        let last = (rings.len() - 1) as f64;
        let mut grid = Grid {
            points: Vec::new(),
            across: (0..=columns).map(|k| f64::from(k) / f64::from(columns)).collect(),
            along: (0..rings.len()).map(|i| i as f64 / last).collect(),
            colors: Vec::new(),
        };
        for (i, [r, y]) in rings.iter().enumerate() {
            for k in (0..=columns).rev() {
                let turn = ops::TAU * f64::from(k) / f64::from(columns);
                let (s, c) = ops::sin_cos(turn);
                let rib = if self.fruit.ribs > 0 { ops::cos(turn * f64::from(self.fruit.ribs)) } else { 0.0 };
                let r = r * (1.0 + 0.05 * rib);
                grid.points.push(DVec3::new(r * c, *y, r * s));
                let cap = i > 9 && self.fruit.cap > 0.0;
                grid.colors.push(if cap { mix(color, [0.1, 0.07, 0.03], 0.6) } else { color });
            }
        }
        bed.around(OrganKind::Fruit, DVec3::Y * base, grid);
    }

    /// Returns how far the receptacle of a flower reaches below its foot; `wide`: the radius of its widest ring,
    /// metres.
    pub fn receptacle_depth_m(wide: f64) -> f64 {
        0.6 * wide + 0.002
    }

    /// Adds the receptacle that joins stalk and petals: from the stalk up along the feet of sepals and petals, and to
    /// the axis.
    pub(crate) fn receptacle(&self, bed: &mut Bed<'_>, times: &Times<'_>, whorls: &[Whorl]) {
        let wide = whorls.iter().map(|w| w.insertion.radius_m).fold(0.0, f64::max).max(self.disc_m);
        let below = self.fruit.below && self.fruit.length_m > 0.0;
        let mut low = -Self::receptacle_depth_m(wide);
        let mut rings = vec![[0.08 * wide, low], [0.6 * wide, 0.45 * low]];
        if below {
            let size = self.fruit_size(times);
            low = -self.fruit.length_m * size;
            // A hip or an inferior ovary hangs below the petals and sepals.
            let neck = whorls.iter().map(|w| w.insertion.height_m).fold(0.0, f64::min);
            rings = (0..7)
                .map(|i| {
                    let t = f64::from(i) / 7.0;
                    [size * self.fruit_radius(t), ops::lerp(low, neck - 0.0002, t)]
                })
                .collect();
        }
        let body = rings.len();
        rings.extend(whorls.iter().map(|w| [1.01 * w.insertion.radius_m, w.insertion.height_m]));
        let top = rings.last().map_or(0.0, |r| r[1]);
        rings.push([0.02 * wide, top]);
        let last = (rings.len() - 1) as f64;
        let columns = if below { 20 } else { 12 };
        let mut bowl = Grid {
            points: Vec::new(),
            across: (0..=columns).map(|k| f64::from(k) / f64::from(columns)).collect(),
            along: (0..rings.len()).map(|i| i as f64 / last).collect(),
            colors: Vec::new(),
        };
        let color = self.fruit_color(times);
        for (i, [r, y]) in rings.into_iter().enumerate() {
            for k in 0..=columns {
                let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / f64::from(columns));
                bowl.points.push(DVec3::new(r * c, y, r * s));
                if below {
                    bowl.colors.push(if i < body { color } else { self.stalk_color });
                }
            }
        }
        bed.around(OrganKind::Pedicel, DVec3::Y * low, bowl);
    }

    /// Adds ovary, style and stigma; `bare`: without the ovary, which is the fruit.
    fn pistil(&self, bed: &mut Bed<'_>, long: f64, base: f64, (bare, wilt): (bool, f64)) {
        let thick = self.pistil_radius();
        let [foot, ovary] = if bare { [0.8, 0.8] } else { [1.6, 2.0] };
        let parts = [
            (0.0, foot),
            (0.1, ovary),
            (0.22, 0.5 * (ovary + 0.2)),
            (0.6, 0.8),
            (0.93, 0.9),
            (0.96, 2.0),
            (0.99, 2.2),
            (1.0, 1.2),
        ];
        let line = parts.map(|p| DVec3::new(0.0, base + p.0 * long, 0.0));
        let shorter = (long / self.pistil_m * 2.0).min(1.0);
        let radii = parts.map(|p| p.1 * thick * shorter);
        let color = mix(self.pistil_color, [0.0; 3], 0.5 * wilt);
        bed.strand(OrganKind::Pistil, &line, &radii, color);
    }

    /// Adds a dome of florets in Vogel's spiral (phyllotaxis of 137.5 degrees): they open, with pollen, from the rim
    /// inwards.
    fn florets(&self, bed: &mut Bed<'_>, radius: f64, base: f64, [g, wilt]: [f64; 2]) {
        let look = &self.disc;
        let height = |share: f64| base + look.dome * radius * (1.0 - share);
        let mut floor = Grid {
            points: Vec::new(),
            across: (0..=24).map(|k| f64::from(k) / 24.0).collect(),
            along: (0..=6).map(|i| f64::from(i) / 6.0).collect(),
            colors: vec![look.dry_color.map(|x| 0.95 * x); 7 * 25],
        };
        for i in 0..=6 {
            let r = f64::from(i) / 6.0;
            let y = if i == 6 { base - 0.002 * radius } else { height(r * r) };
            let r = radius * if i == 6 { 0.9 } else { r };
            // In reverse: a sheet's upper side has its columns from right to left.
            for k in (0..=24).rev() {
                let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 24.0);
                floor.points.push(DVec3::new(r * c, y, r * s));
            }
        }
        bed.around(OrganKind::Disc, DVec3::Y * base, floor);
        let count = look.florets.max(10);
        let fat = 0.8 * radius * (1.0 / f64::from(count)).sqrt();
        for k in 0..count {
            let share = (f64::from(k) + 0.5) / f64::from(count);
            let r = 0.97 * radius * share.sqrt();
            let (s, c) = ops::sin_cos(f64::from(k) * rad(137.507_8));
            let foot = DVec3::new(r * c, height(share), r * s);
            // In bloom: the ring between the rim and the front of the opening.
            let front = 1.0 - 0.75 * g * g;
            let bloom = ops::smoothstep(front, front + 0.15, share) * (1.0 - wilt);
            let long = radius * (0.08 + 0.05 * bloom);
            let lean = 0.5 * share * g;
            let up = DVec3::new(lean * c, 1.0, lean * s).normalize_or(DVec3::Y);
            let young = mix(look.young_color, [0.10, 0.045, 0.012], 0.6 * share);
            let color = mix(mix(young, look.open_color, 0.85 * bloom), look.dry_color, wilt);
            let line = [0.0, 0.6, 1.0].map(|t| foot + up * (t * long));
            bed.strand(OrganKind::Floret, &line, &[fat, fat, 0.45 * fat], color);
        }
    }

    /// Adds one fruit and its parachute, which is closed until the fruit ripens.
    fn achene(&self, bed: &mut Bed<'_>, k: u32, base: f64, times: &Times<'_>) {
        let Achenes { count, length_m, head_m, color } = self.achenes;
        let n = f64::from(count.max(1));
        let grow = ops::smoothstep(0.5, 0.97, times.ripe).max(1e-3);
        // Evenly over the sphere except for its foot, where the stalk is.
        let y = 1.0 - 1.55 * (f64::from(k) + 0.5) / n;
        let wide = (1.0 - y * y).max(0.0).sqrt();
        let (s, c) = ops::sin_cos(f64::from(k) * rad(137.507_8));
        let out = DVec3::new(wide * c, y, wide * s);
        // The head swells into a ball as bracts fold back.
        let middle = DVec3::Y * (base + 1.3 * head_m * (0.3 + 3.0 * grow).min(1.0));
        let head = head_m * ops::lerp(0.01, 1.0, grow);
        let reach = length_m * grow;
        let thin = 0.00012 * grow;
        let line = [0.0, 0.06, 0.24, 0.3, 0.6, 1.0].map(|t| middle + out * (head + reach * t));
        let radii = [1.0, 4.0, 4.0, 1.0, 0.8, 0.7].map(|r| r * thin);
        bed.strand(OrganKind::Fruit, &line, &radii, color);
        let sphere = head + reach;
        // As wide as the room next to its neighbour.
        let rim = 0.49 * sphere * (ops::TAU * 1.55 / n).sqrt() * grow;
        let (right, up) = out.any_orthonormal_pair();
        let mut grid = Grid {
            points: Vec::new(),
            across: (0..=PAPPUS).map(|k| f64::from(k) / f64::from(PAPPUS)).collect(),
            along: vec![0.0, 1.0],
            colors: vec![[0.92, 0.92, 0.9]; 2 * (PAPPUS as usize + 1)],
        };
        for row in [0.04, 1.0] {
            for j in (0..=PAPPUS).rev() {
                let r = rim
                    * if row < 0.5 {
                        0.04
                    } else if j.is_multiple_of(2) {
                        1.0
                    } else {
                        0.4
                    };
                let (s, c) = ops::sin_cos(ops::TAU * f64::from(j) / f64::from(PAPPUS));
                let rise = if row < 0.5 { 0.02 } else { 0.3 * r / rim.max(1e-9) };
                grid.points.push(middle + out * (sphere + rim * rise) + right * (r * c) + up * (r * s));
            }
        }
        bed.petal(OrganKind::Floret, grid);
    }
}

/// Returns the radius of the innermost ring.
fn inner_radius(rings: &[Whorl]) -> f64 {
    rings.iter().map(|w| w.insertion.radius_m).fold(f64::INFINITY, f64::min)
}
