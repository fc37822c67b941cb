//! Canopies of many small leaves: the turbid medium, several threads, and paths drawn by chance.

use base::{Draw, Executor, Run, Seed, Stream, ops};
use glam::DVec3;
use light::{Absorption, Beams, LightSpec, LitScene, Optics, SkyKind, SunPosition, absorb};

use crate::scenes::canopy;

fn spec() -> LightSpec {
    LightSpec { soil_reflectance: 0.0, bounces: 0, repeat_m: Some([1.0, 1.0]), ..LightSpec::default() }
}

fn lit(scene: &LitScene, beams: &Beams, spec: &LightSpec) -> Absorption {
    absorb(scene, beams, spec, Seed::new(7), &Run::plain()).expect("a result")
}

#[test]
fn small_leaves_let_light_through_as_a_turbid_medium_does() {
    for (index, lai) in (0..).zip([1.0_f64, 2.0, 4.0]) {
        let scene = canopy(lai, 0.008, Optics::BLACK, index);
        let mut beams = Beams::default();
        let angles = [20.0, 40.0, 60.0, 75.0, 90.0];
        // Several azimuths of each angle: one alone sees one pattern of gaps.
        for elevation_deg in angles {
            for turn in 0..6 {
                let azimuth_deg = 17.0 + 60.0 * f64::from(turn);
                beams.add_sun(SunPosition { azimuth_deg, elevation_deg }, 10.0).expect("a sun");
            }
        }
        let found = lit(&scene, &beams, &LightSpec { lines: 60_000, ..spec() });
        for (elevation, directions) in angles.iter().zip(found.directions.chunks(6)) {
            let through = directions.iter().filter_map(|d| d.transmitted).sum::<f64>() / 6.0;
            // Leaves in all directions evenly show half of their area on average: G = 0.5.
            let wanted = ops::exp(-0.5 * lai / ops::sin(elevation.to_radians()));
            assert!(
                (through - wanted).abs() < 0.01,
                "LAI {lai}, {elevation} degrees: {through}, not {wanted}"
            );
        }
    }
}

#[test]
fn sunlit_leaf_area_is_that_of_the_turbid_medium() {
    let (lai, elevation) = (3.0, 50.0_f64);
    let scene = canopy(lai, 0.012, Optics::BLACK, 5);
    let mut beams = Beams::default();
    beams.add_sun(SunPosition { azimuth_deg: 30.0, elevation_deg: elevation }, 10.0).expect("a sun");
    let found = lit(&scene, &beams, &LightSpec { lines: 200_000, ..spec() });
    // Leaves seen from their edges show none of their area.
    let seen = || found.receivers.iter().filter_map(|r| Some((r.area_m2, r.sunlit?)));
    let [lit, all] = seen().fold([0.0; 2], |[lit, all], (area, share)| [lit + area * share, all + area]);
    let sunlit = lai * lit / all;
    let k = 0.5 / ops::sin(elevation.to_radians());
    let wanted = (1.0 - ops::exp(-k * lai)) / k;
    assert!((sunlit / wanted - 1.0).abs() < 0.02, "{sunlit} m2, not {wanted}");
}

/// Jobs from both ends at once.
struct Threads;

impl Executor for Threads {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        std::thread::scope(|scope| {
            for k in 0..4 {
                scope.spawn(move || (0..n).rev().filter(|i| i % 4 == k).for_each(job));
            }
        });
    }
}

#[test]
fn one_and_four_threads_give_the_same_bits() {
    let scene = canopy(2.0, 0.05, Optics::LEAF, 9);
    let mut beams = Beams::sky(SkyKind::Overcast, 100.0).expect("a sky");
    beams.add_sun(SunPosition { azimuth_deg: 200.0, elevation_deg: 35.0 }, 200.0).expect("a sun");
    let spec = LightSpec { lines: 5_000, bounces: 3, soil_reflectance: 0.2, ..spec() };
    let on = |executor: &dyn Executor| {
        absorb(&scene, &beams, &spec, Seed::new(7), &Run { executor, ..Run::plain() }).expect("a result")
    };
    assert_eq!(on(&base::Serial), on(&Threads));
}

/// A path of light through a repeated scene, from the sky to where it stays; by brute force.
struct Paths<'a> {
    scene: &'a LitScene,
    soil: f64,
    chance: Stream,
}

impl Paths<'_> {
    /// Returns the row of the triangle that a ray meets first, and its distance.
    fn meet(&self, from: DVec3, way: DVec3) -> Option<(usize, f64)> {
        let mut nearest: Option<(usize, f64)> = None;
        for (row, corners) in self.scene.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|i| self.scene.points[i as usize]);
            let (u, v) = (b - a, c - a);
            let across = way.cross(v);
            let det = u.dot(across);
            if det.abs() < 1e-14 {
                continue;
            }
            let away = from - a;
            let s = away.dot(across) / det;
            let q = away.cross(u);
            let t = way.dot(q) / det;
            let far = v.dot(q) / det;
            let is_met = s >= 0.0 && t >= 0.0 && s + t <= 1.0 && far > 1e-7;
            if is_met && nearest.is_none_or(|(_, best)| far < best) {
                nearest = Some((row, far));
            }
        }
        nearest
    }

    /// Draws a direction by Lambert's law around a normal.
    fn diffuse(&mut self, normal: DVec3) -> DVec3 {
        let (a, b) = normal.any_orthonormal_pair();
        let r = self.chance.uniform();
        let (sin, cos) = ops::sin_cos(self.chance.range(0.0, ops::TAU));
        a * (r.sqrt() * cos) + b * (r.sqrt() * sin) + normal * (1.0 - r).sqrt()
    }

    /// Follows the path to its end: 0 is a leaf, 1 the soil, 2 the sky.
    fn follow(&mut self, to: DVec3) -> usize {
        let top = 1.3;
        let mut at = DVec3::new(self.chance.uniform(), top, self.chance.uniform());
        let mut way = -to;
        for _ in 0..10_000 {
            // Through the cell to one of its sides, which is 1 or 0 away.
            let side = |x: f64, d: f64| {
                let to_side = if d > 0.0 { (1.0 - x) / d } else { -x / d };
                if d == 0.0 { f64::INFINITY } else { to_side.max(0.0) }
            };
            let (out_x, out_z) = (side(at.x, way.x), side(at.z, way.z));
            let out_y = if way.y < 0.0 { -at.y / way.y } else { (top - at.y) / way.y };
            let out = out_x.min(out_z).min(out_y);
            if let Some((row, far)) = self.meet(at, way).filter(|(_, far)| *far <= out) {
                at += way * far;
                let [a, b, c] = self.scene.triangles[row].map(|i| self.scene.points[i as usize]);
                let normal = (b - a).cross(c - a).normalize();
                let towards = if normal.dot(way) < 0.0 { normal } else { -normal };
                let optics = self.scene.receivers[self.scene.owners[row] as usize];
                let draw = self.chance.uniform();
                way = match draw {
                    x if x < optics.reflectance => self.diffuse(towards),
                    x if x < optics.scattered() => self.diffuse(-towards),
                    _ => return 0,
                };
                continue;
            }
            at += way * out;
            if out_x <= out {
                at.x = if way.x > 0.0 { 0.0 } else { 1.0 };
            } else if out_z <= out {
                at.z = if way.z > 0.0 { 0.0 } else { 1.0 };
            } else if way.y > 0.0 {
                return 2;
            } else if self.chance.uniform() >= self.soil {
                return 1;
            } else {
                at.y = 0.0;
                way = self.diffuse(DVec3::Y);
            }
        }
        2
    }
}

#[test]
fn scattered_light_goes_where_paths_drawn_by_chance_go() {
    let leaf = Optics { reflectance: 0.45, transmittance: 0.40 };
    let mut scene = canopy(2.0, 0.1, leaf, 21);
    // Within the cell, so that paths need not look at its neighbours.
    for p in &mut scene.points {
        (p.x, p.z) = (0.06 + 0.88 * p.x, 0.06 + 0.88 * p.z);
    }
    let (soil, place) = (0.3, SunPosition { azimuth_deg: 40.0, elevation_deg: 55.0 });
    let mut beams = Beams::default();
    beams.add_sun(place, 100.0).expect("a sun");
    let spec = LightSpec { lines: 10_000, bounces: 30, soil_reflectance: soil, ..spec() };
    let balance = lit(&scene, &beams, &spec).balance.expect("a balance");
    let kept = balance.absorbed_w + balance.soil_w + balance.reflected_w + balance.lost_w;
    assert!((kept / balance.incoming_w - 1.0).abs() < 1e-3, "{balance:?}");
    let mut paths = Paths { scene: &scene, soil, chance: Seed::new(4).stream(Draw::Test) };
    let count = 10_000;
    let mut ends = [0.0; 3];
    for _ in 0..count {
        ends[paths.follow(place.direction())] += 100.0 / f64::from(count);
    }
    let found = [balance.absorbed_w, balance.soil_w, balance.reflected_w];
    for (found, drawn) in found.iter().zip(ends) {
        // The standard error of the paths is at most 0.5.
        assert!((found - drawn).abs() < 1.5, "{found}, not {drawn}: {balance:?}, {ends:?}");
    }
}

/// Returns the share of the light of a sun, at an elevation whose sine is `sine`, that a turbid medium of leaves in all
/// directions evenly returns to the sky after one scattering: the integral over the upper half of the sphere of Gamma /
/// (pi sine) (1 - exp(-(k0 + k) LAI)) / (k0 + k), with the phase function of leaves that scatter by Lambert's law (Ross
/// 1981; Myneni, Ross and Asrar 1989).
fn thrown_back_once(sine: f64, lai: f64, optics: Optics) -> f64 {
    const RINGS: u32 = 200;
    let cosine = (1.0 - sine * sine).sqrt();
    let k0 = 0.5 / sine;
    let mut sum = 0.0;
    for ring in 0..RINGS {
        let up = (f64::from(ring) + 0.5) / f64::from(RINGS);
        for turn in 0..RINGS {
            let around = ops::TAU * (f64::from(turn) + 0.5) / f64::from(RINGS);
            // The sun's light goes downwards.
            let cos = (cosine * (1.0 - up * up).sqrt() * ops::cos(around) - sine * up).clamp(-1.0, 1.0);
            let angle = ops::acos(cos);
            let turned = (ops::sin(angle) - angle * cos) / (3.0 * ops::PI);
            let gamma = optics.scattered() * turned + optics.transmittance * cos / 3.0;
            let both = k0 + 0.5 / up;
            sum += gamma / (ops::PI * sine) * (1.0 - ops::exp(-both * lai)) / both;
        }
    }
    sum * ops::TAU / f64::from(RINGS * RINGS)
}

#[test]
fn light_that_is_scattered_once_leaves_as_the_integral_of_the_turbid_medium_says() {
    let lai = 2.0;
    for (reflected, passed) in [(1.0, 1.0), (1.0, 0.0), (0.0, 1.0)] {
        // Returned light for each unit of scattering, at two albedos so small that the rest is a line through them.
        let share = |scale: f64| {
            let optics = Optics { reflectance: scale * reflected, transmittance: scale * passed };
            let scene = canopy(lai, 0.01, optics, 31);
            let mut beams = Beams::default();
            for turn in 0..6 {
                let azimuth_deg = 11.0 + 60.0 * f64::from(turn);
                beams.add_sun(SunPosition { azimuth_deg, elevation_deg: 50.0 }, 10.0).expect("a sun");
            }
            let spec = LightSpec { lines: 60_000, bounces: 2, ..spec() };
            let balance = lit(&scene, &beams, &spec).balance.expect("a balance");
            balance.reflected_w / (balance.incoming_w * optics.scattered())
        };
        let found = 2.0 * share(0.01) - share(0.02);
        let all = Optics { reflectance: 0.01 * reflected, transmittance: 0.01 * passed };
        let wanted = thrown_back_once(ops::sin(50.0_f64.to_radians()), lai, all) / all.scattered();
        assert!((found / wanted - 1.0).abs() < 0.01, "{reflected}, {passed}: {found}, not {wanted}");
    }
}
