//! Homogeneous discrete canopies of the radiation transfer model intercomparison (RAMI, phases 1 to 3): discs of 5 cm
//! radius, leaf area index 3, in a layer of 2 m (Pinty et al. 2001; Widlowski et al. 2007).
//!
//! The published results are reflectances in directions of view, which are not computed here. Compared are first order
//! with its closed form, and absorption, soil and reflection with paths drawn by chance through the same discs.

use base::{Draw, Run, Seed, Stream, ops};
use glam::{DVec2, DVec3};
use light::{Beams, EnergyBalance, LightSpec, LitScene, Optics, SunPosition, absorb};

/// Edge of the cell that repeats itself, and the height of the canopy, metres.
const CELL_M: f64 = 4.0;
const HEIGHT_M: f64 = 2.0;
const RADIUS_M: f64 = 0.05;
const LEAF_AREA_INDEX: f64 = 3.0;
/// Suns of a case, at even azimuths: each sees another pattern of gaps.
const SUNS: u32 = 6;

/// A spectral band of the cases.
#[derive(Clone, Copy, Debug)]
struct Band {
    leaf: Optics,
    soil: f64,
}

const RED: Band = Band { leaf: Optics { reflectance: 0.0546, transmittance: 0.0149 }, soil: 0.127 };
const NEAR_INFRARED: Band = Band { leaf: Optics { reflectance: 0.4957, transmittance: 0.4409 }, soil: 0.159 };

/// Distributions of leaf normals (Bunnik 1978), as densities of the angle to the vertical.
#[derive(Clone, Copy, Debug)]
enum Leaves {
    Planophile,
    Erectophile,
    Uniform,
}

impl Leaves {
    fn density(self, angle: f64) -> f64 {
        let wave = ops::cos(2.0 * angle);
        match self {
            Self::Planophile => 2.0 / ops::PI * (1.0 + wave),
            Self::Erectophile => 2.0 / ops::PI * (1.0 - wave),
            Self::Uniform => ops::sin(angle),
        }
    }

    fn normal(self, chance: &mut Stream) -> DVec3 {
        let angle = loop {
            let angle = chance.range(0.0, ops::FRAC_PI_2);
            if chance.range(0.0, 4.0 / ops::PI) < self.density(angle) {
                break angle;
            }
        };
        let (sin, cos) = ops::sin_cos(angle);
        let (east, north) = ops::sin_cos(chance.range(0.0, ops::TAU));
        DVec3::new(sin * east, cos, sin * north)
    }

    /// Returns Ross's G: the area of the leaves across a direction, over their own.
    fn shown(self, to: DVec3) -> f64 {
        const STEPS: u32 = 300;
        let middle = |k: u32, whole: f64| whole * (f64::from(k) + 0.5) / f64::from(STEPS);
        let mut sum = 0.0;
        for row in 0..STEPS {
            let angle = middle(row, ops::FRAC_PI_2);
            let (sin, cos) = ops::sin_cos(angle);
            let mut ring = 0.0;
            for turn in 0..STEPS {
                let (east, north) = ops::sin_cos(middle(turn, ops::TAU));
                ring += DVec3::new(sin * east, cos, sin * north).dot(to).abs();
            }
            sum += self.density(angle) * ring;
        }
        sum * ops::FRAC_PI_2 / f64::from(STEPS * STEPS)
    }
}

struct Disc {
    middle: DVec3,
    normal: DVec3,
}

fn discs(leaves: Leaves) -> Vec<Disc> {
    let mut chance = Seed::new(17).stream(Draw::Test);
    let count = (LEAF_AREA_INDEX * CELL_M * CELL_M / (ops::PI * RADIUS_M * RADIUS_M)).round();
    (0..ops::whole(count))
        .map(|_| {
            let height = chance.range(RADIUS_M, HEIGHT_M - RADIUS_M);
            let middle = DVec3::new(chance.range(0.0, CELL_M), height, chance.range(0.0, CELL_M));
            Disc { middle, normal: leaves.normal(&mut chance) }
        })
        .collect()
}

/// Makes polygons of eight corners with the areas of the discs.
fn scene(discs: &[Disc], leaf: Optics) -> LitScene {
    const CORNERS: u32 = 8;
    let step = ops::TAU / f64::from(CORNERS);
    let radius = RADIUS_M * (step / ops::sin(step)).sqrt();
    let mut scene = LitScene { receivers: vec![leaf; discs.len()], ..LitScene::default() };
    for (owner, disc) in (0..).zip(discs) {
        let (a, b) = disc.normal.any_orthonormal_pair();
        let first = owner * CORNERS;
        for corner in 0..CORNERS {
            let (sin, cos) = ops::sin_cos(step * f64::from(corner));
            scene.points.push(disc.middle + radius * (a * cos + b * sin));
        }
        for corner in 2..CORNERS {
            scene.triangles.push([first, first + corner - 1, first + corner]);
            scene.owners.push(owner);
        }
    }
    scene
}

fn suns(elevation_deg: f64) -> Beams {
    let mut beams = Beams::default();
    for turn in 0..SUNS {
        let azimuth_deg = 23.0 + 360.0 / f64::from(SUNS) * f64::from(turn);
        beams.add_sun(SunPosition { azimuth_deg, elevation_deg }, 10.0).expect("a sun");
    }
    beams
}

/// Boxes along an edge of the cell, for finding discs.
const BOXES: u32 = 16;
const BOX_M: f64 = CELL_M / BOXES as f64;

/// Paths of light through the discs, whose weight is what is not absorbed.
struct Paths<'a> {
    discs: &'a [Disc],
    /// Rows of the discs that reach into each box; whole columns of boxes.
    boxes: Vec<Vec<usize>>,
    band: Band,
    chance: Stream,
}

fn box_of(x: f64) -> usize {
    ops::whole((x.rem_euclid(CELL_M) / BOX_M).floor().min(f64::from(BOXES - 1))) as usize
}

impl<'a> Paths<'a> {
    fn new(discs: &'a [Disc], band: Band) -> Self {
        let mut boxes = vec![Vec::new(); (BOXES * BOXES) as usize];
        for (row, disc) in discs.iter().enumerate() {
            let sides = |x: f64| [box_of(x - RADIUS_M), box_of(x + RADIUS_M)];
            let (across, along) = (sides(disc.middle.x), sides(disc.middle.z));
            for z in along {
                for x in across {
                    let rows: &mut Vec<usize> = &mut boxes[z * BOXES as usize + x];
                    if rows.last() != Some(&row) {
                        rows.push(row);
                    }
                }
            }
        }
        Self { discs, boxes, band, chance: Seed::new(5).stream(Draw::Test) }
    }

    /// Returns the distance along a ray at which it meets a disc, or its copy in a cell nearby.
    fn distance(disc: &Disc, from: DVec3, way: DVec3) -> Option<f64> {
        let mut away = disc.middle - from;
        away.x -= CELL_M * (away.x / CELL_M).round();
        away.z -= CELL_M * (away.z / CELL_M).round();
        let far = away.dot(disc.normal) / way.dot(disc.normal);
        (far > 1e-9 && (way * far - away).length_squared() < RADIUS_M * RADIUS_M).then_some(far)
    }

    /// Returns what a ray meets before it leaves the canopy at the distance `end`.
    fn meet(&self, mut from: DVec3, way: DVec3, end: f64) -> Option<(usize, f64)> {
        let mut gone = 0.0;
        while gone < end {
            // To the next side of a box, and a little beyond it.
            let side = |x: f64, d: f64| {
                let within = x.rem_euclid(BOX_M);
                if d > 0.0 { (BOX_M - within) / d } else { within / -d }
            };
            let step = side(from.x, way.x).min(side(from.z, way.z)).min(end - gone) + 1e-7;
            let rows = &self.boxes[box_of(from.z) * BOXES as usize + box_of(from.x)];
            let met =
                rows.iter().filter_map(|row| Some((*row, Self::distance(&self.discs[*row], from, way)?)));
            let nearest = met.filter(|(_, far)| *far <= step).min_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((row, far)) = nearest {
                return Some((row, gone + far));
            }
            (from, gone) = (from + way * step, gone + step);
        }
        None
    }

    fn diffuse(&mut self, normal: DVec3) -> DVec3 {
        let (a, b) = normal.any_orthonormal_pair();
        let r = self.chance.uniform();
        let (sin, cos) = ops::sin_cos(self.chance.range(0.0, ops::TAU));
        a * (r.sqrt() * cos) + b * (r.sqrt() * sin) + normal * (1.0 - r).sqrt()
    }

    /// Follows a path from the sky and adds its shares: absorbed by leaves, by the soil, returned to the sky.
    fn follow(&mut self, to: DVec3, ends: &mut [f64; 3]) {
        let place = DVec2::new(self.chance.uniform(), self.chance.uniform()) * CELL_M;
        let mut from = DVec3::new(place.x, HEIGHT_M, place.y);
        let (mut way, mut weight) = (-to, 1.0);
        while weight > 1e-4 {
            let end = if way.y < 0.0 { -from.y / way.y } else { (HEIGHT_M - from.y) / way.y };
            if let Some((row, far)) = self.meet(from, way, end) {
                from += way * far;
                let normal = self.discs[row].normal;
                let lit = if normal.dot(way) < 0.0 { normal } else { -normal };
                let leaf = self.band.leaf;
                ends[0] += weight * (1.0 - leaf.scattered());
                weight *= leaf.scattered();
                let is_reflected = self.chance.uniform() * leaf.scattered() < leaf.reflectance;
                way = self.diffuse(if is_reflected { lit } else { -lit });
            } else if way.y > 0.0 {
                ends[2] += weight;
                return;
            } else {
                from += way * end;
                from.y = 0.0;
                ends[1] += weight * (1.0 - self.band.soil);
                weight *= self.band.soil;
                way = self.diffuse(DVec3::Y);
            }
        }
    }
}

fn shares(balance: &EnergyBalance) -> [f64; 3] {
    [balance.absorbed_w, balance.soil_w, balance.reflected_w].map(|w| w / balance.incoming_w)
}

fn spec(soil: f64, bounces: u32) -> LightSpec {
    let repeat_m = Some([CELL_M, CELL_M]);
    LightSpec { lines: 1 << 14, bounces, soil_reflectance: soil, repeat_m, ..LightSpec::default() }
}

#[test]
fn light_that_meets_no_disc_is_that_of_the_closed_form() {
    for leaves in [Leaves::Planophile, Leaves::Erectophile, Leaves::Uniform] {
        let scene = scene(&discs(leaves), Optics::BLACK);
        for zenith_deg in [20.0_f64, 50.0] {
            let beams = suns(90.0 - zenith_deg);
            let found = absorb(&scene, &beams, &spec(0.0, 0), Seed::new(2), &Run::plain()).expect("a result");
            let cos = ops::cos(zenith_deg.to_radians());
            let to = DVec3::new((1.0 - cos * cos).sqrt(), cos, 0.0);
            let wanted = 1.0 - ops::exp(-leaves.shown(to) * LEAF_AREA_INDEX / cos);
            let share = found.intercepted_w / (found.horizontal * CELL_M * CELL_M);
            assert!((share / wanted - 1.0).abs() < 0.01, "{leaves:?}, {zenith_deg}: {share}, not {wanted}");
        }
    }
}

#[test]
fn scattered_light_ends_where_paths_through_the_same_discs_end() {
    const PATHS: u32 = 50_000;
    for (leaves, zenith_deg, band) in [
        (Leaves::Erectophile, 20.0, NEAR_INFRARED),
        (Leaves::Erectophile, 50.0, RED),
        (Leaves::Planophile, 50.0, NEAR_INFRARED),
        (Leaves::Planophile, 20.0, RED),
    ] {
        let (discs, beams) = (discs(leaves), suns(90.0 - zenith_deg));
        let lit =
            absorb(&scene(&discs, band.leaf), &beams, &spec(band.soil, 10), Seed::new(2), &Run::plain());
        let found = lit.expect("a result").balance.expect("a balance");
        let mut paths = Paths::new(&discs, band);
        let mut ends = [0.0; 3];
        for path in 0..PATHS {
            let azimuth_deg = 23.0 + 360.0 / f64::from(SUNS) * f64::from(path % SUNS);
            let sun = SunPosition { azimuth_deg, elevation_deg: 90.0 - zenith_deg };
            paths.follow(sun.direction(), &mut ends);
        }
        for (found, drawn) in shares(&found).iter().zip(ends.map(|end| end / f64::from(PATHS))) {
            assert!(
                (found / drawn - 1.0).abs() < 0.03,
                "{leaves:?}, {zenith_deg}, {band:?}: {found}, not {drawn}"
            );
        }
    }
}

#[test]
fn the_purist_corner_returns_all_light() {
    // Leaves and soil that absorb nothing (HOM11 to HOM15).
    let white = Optics { reflectance: 0.5, transmittance: 0.5 };
    let scene = scene(&discs(Leaves::Planophile), white);
    let lit = absorb(&scene, &suns(60.0), &spec(1.0, 50), Seed::new(2), &Run::plain()).expect("a result");
    let [leaves, soil, sky] = shares(&lit.balance.expect("a balance"));
    assert!(leaves.abs() < 1e-9 && soil.abs() < 1e-9 && (sky - 1.0).abs() < 1e-3, "{leaves}, {soil}, {sky}");
}
