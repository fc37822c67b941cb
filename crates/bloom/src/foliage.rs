//! Leaves on the stalk or at its foot, and the ground on which fallen petals lie.

use base::{Draw, Seed, ops, turn};
use glam::{DQuat, DVec3};
use plant::{FlowerId, Frame, NodeId, Organ, OrganKind, Paint, Plant, Shape, Sheet, Venation};
use std::sync::Arc;

use crate::cluster::Stalk;
use crate::organs::{Grid, Seat};
use crate::parts::Foliage;
use crate::wanted::{FlowerSpec, rad};

/// Columns on each half of a leaf.
const HALF: u32 = 4;
/// Rows of a leaf.
const ROWS: u32 = 20;

/// Course of one leaf: its start on the stalk, its azimuth and its angles, radians.
#[derive(Clone, Copy)]
struct Way {
    root: DVec3,
    azimuth: f64,
    angles: [f64; 3],
    size: f64,
}

impl Way {
    /// Returns the points along the midrib at even steps, with their angles to the vertical.
    fn line(&self, long: f64, steps: u32, [from, to]: [f64; 2]) -> Vec<(DVec3, f64)> {
        let [a, b, c] = self.angles;
        let bent =
            |v: f64| a * (1.0 - v) * (1.0 - 2.0 * v) + 4.0 * b * v * (1.0 - v) + c * v * (2.0 * v - 1.0);
        let (sin_z, cos_z) = ops::sin_cos(self.azimuth);
        let mut at = self.root;
        let step = long / f64::from(steps);
        (0..=steps)
            .map(|k| {
                let v = ops::lerp(from, to, f64::from(k) / f64::from(steps));
                let row = (at, bent(v));
                let (s, c) = ops::sin_cos(bent(v + 0.5 * (to - from) / f64::from(steps)));
                at += DVec3::new(s * cos_z, c, s * sin_z) * step;
                row
            })
            .collect()
    }
}

impl Foliage {
    fn outline(&self, v: f64) -> f64 {
        let w = self.widest.clamp(0.1, 0.9);
        let smooth = if v < w {
            let t = v / w;
            ops::lerp(self.base, 1.0, (t * (2.0 - t)).max(0.0))
        } else {
            let t = (v - w) / (1.0 - w);
            let round = (1.0 - t * t).max(0.0).sqrt();
            ops::lerp(round, 1.0 - t * t * (1.0 - 0.3 * (1.0 - t)), self.point).max(0.0) * 0.985 + 0.015
        };
        if self.lobes == 0 {
            return smooth;
        }
        let wave = 0.5 - 0.5 * ops::cos(ops::TAU * (f64::from(self.lobes) * v));
        smooth * (1.0 - self.lobe_depth * (1.0 - wave) * ops::smoothstep(0.0, 0.15, 1.0 - v))
    }

    /// Makes the blade along a midrib.
    fn blade(&self, line: &[(DVec3, f64)], azimuth: f64, size: f64) -> Grid {
        let (s, c) = ops::sin_cos(azimuth);
        let (out, across) = (DVec3::new(c, 0.0, s), DVec3::new(-s, 0.0, c));
        let last = (line.len() - 1).max(1) as f64;
        let even = |n: u32| (0..=n).map(|k| f64::from(k) / f64::from(n)).collect::<Vec<_>>();
        let mut grid = Grid { points: vec![], across: even(2 * HALF), along: even(ROWS), colors: vec![] };
        let (fold_s, fold_c) = ops::sin_cos(rad(self.fold_deg));
        for (i, &(at, angle)) in line.iter().enumerate() {
            let v = i as f64 / last;
            let (sin, cos) = ops::sin_cos(angle);
            // The upper side faces the stalk.
            let (along, up) = (out * sin + DVec3::Y * cos, DVec3::Y * sin - out * cos);
            let half = 0.5 * self.width_m * size * self.outline(v);
            for &t in &grid.across {
                let u = 1.0 - 2.0 * t;
                let back = self.heart * self.length_m * size * u.abs() * (1.0 - v) * (1.0 - v);
                let side = across * (-u * half * fold_c) + up * (u.abs() * half * fold_s);
                grid.points.push(at + side - along * back);
                #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
                let light = (1.0 + 0.35 * (1.0 - u.abs() * 6.0).max(0.0) - 0.12 * u * u) as f32;
                grid.colors.push(self.color.map(|x| x * light));
            }
        }
        grid
    }
}

/// Bearer of leaves, with their flower.
struct Bough<'a> {
    plant: &'a mut Plant,
    seat: Seat,
    bearer: Option<NodeId>,
    seed: Seed,
    reach: f64,
}

impl Bough<'_> {
    fn push(&mut self, shape: Shape, frame: Frame, rgb: [f32; 3]) {
        let shape = self.plant.add_shape(shape);
        let key = self.seed.child(self.plant.organs.len() as u64).number();
        let (kind, flower, paint) = (OrganKind::Leaf, None::<FlowerId>, Paint::Tinted(rgb));
        let bearer = self.bearer;
        self.plant.organs.push(Organ {
            kind,
            bearer,
            flower,
            shape,
            frame,
            scale: 1.0,
            paint,
            key,
            source: None,
        });
    }

    fn sheet(&mut self, grid: Grid) {
        for p in &grid.points {
            self.reach = self.reach.max((p.x * p.x + p.z * p.z).sqrt());
        }
        let points = grid.points.iter().map(|&p| self.seat.transform(p)).collect();
        let Grid { across, along, colors, .. } = grid;
        let sheet = Sheet { points, across, along, colors, veins: Venation::default(), form: None };
        if let Some((sheet, frame)) = sheet.framed() {
            self.push(Shape::Sheet(Arc::new(sheet)), frame, [1.0; 3]);
        }
    }

    fn stalk(&mut self, line: &[(DVec3, f64)], radius: f64, rgb: [f32; 3]) {
        let line: Vec<DVec3> = line.iter().map(|&(p, _)| self.seat.transform(p)).collect();
        let (Some(&root), Some(&end)) = (line.first(), line.last()) else { return };
        let frame = Frame::looking(root, end - root, DVec3::Z);
        let path: Vec<DVec3> = line.iter().map(|&p| frame.localise(p)).collect();
        let radius_m = vec![radius; path.len()];
        self.push(Shape::Strand { path, radius_m, knob_m: 0.0 }, frame, rgb);
    }

    fn leaf(&mut self, kind: &Foliage, way: Way) {
        let long = kind.length_m * way.size;
        let petiole = kind.petiole_m * way.size;
        if petiole <= 0.0 {
            self.sheet(kind.blade(&way.line(long, ROWS, [0.0, 1.0]), way.azimuth, way.size));
            return;
        }
        let whole = petiole + long;
        let share = petiole / whole;
        let stalk = way.line(petiole, 8, [0.0, share]);
        let radius = (0.016 * long).clamp(0.0004, 0.003);
        self.stalk(&stalk, radius, kind.color);
        let (end, angle) = stalk[stalk.len() - 1];
        // Slightly beyond the end, so that the blade grows out of it.
        let tip = Way { root: end + (end - stalk[stalk.len() - 2].0) * 0.02, ..way };
        self.sheet(kind.blade(&tip.line(long, ROWS, [share, 1.0]), way.azimuth, way.size));
        let pairs = (kind.leaflets - 1) / 2;
        for k in 0..pairs {
            let t = 0.4 + 0.42 * f64::from(k) / f64::from(pairs.max(2) - 1);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 8")]
            let at = stalk[(t * 8.0) as usize].0;
            for side in [-1.0, 1.0] {
                // Sideways and slightly forwards, in the slope of the leaf.
                let azimuth = way.azimuth + side * 1.15;
                let (s, c) = ops::sin_cos(azimuth);
                // On a stalk of its own, as wide as the foot of the leaf.
                let clear = (1.3 * radius).max(0.6 * kind.base * kind.width_m * way.size);
                let root = at + DVec3::new(c, 0.0, s) * clear;
                let flat = ops::lerp(ops::FRAC_PI_2, angle, 0.4);
                let own =
                    Way { root, azimuth, angles: [flat, flat + 0.1, flat + 0.35], size: way.size * 0.92 };
                self.sheet(kind.blade(&own.line(long * 0.92, ROWS, [0.0, 1.0]), azimuth, own.size));
            }
        }
    }
}

impl FlowerSpec {
    /// Adds the leaves, and returns how far they reach from the axis of the stalk.
    pub(crate) fn foliage(
        &self,
        plant: &mut Plant,
        seat: &Seat,
        bearer: Option<NodeId>,
        stalk: &Stalk,
        seed: Seed,
    ) -> f64 {
        let mut bough = Bough { plant, seat: *seat, bearer, seed: seed.child(0x1eaf), reach: 0.0 };
        for kind in &self.leaves {
            let nodes = kind.count.div_ceil(kind.at_node.max(1));
            for k in 0..kind.count {
                let (node, mate) = (k / kind.at_node.max(1), k % kind.at_node.max(1));
                let t = f64::from(node) / f64::from(nodes.max(2) - 1);
                let late = f64::from(k) / f64::from(kind.count.max(2) - 1);
                let azimuth = rad(kind.phase_deg + kind.divergence_deg * f64::from(node))
                    + ops::TAU * f64::from(mate) / f64::from(kind.at_node.max(1));
                let (s, c) = ops::sin_cos(azimuth);
                let inner = f64::from(kind.count - 1 - k);
                let out = stalk.radius * 1.02 + 0.0003 + kind.gap_m * inner;
                let lift = if kind.from < kind.to { 0.0 } else { 0.4 * kind.gap_m * f64::from(k) };
                let root =
                    stalk.point_at(ops::lerp(kind.from, kind.to, t)) + DVec3::new(c * out, lift, s * out);
                let steep = 1.0 - kind.steeper * late;
                let way = Way {
                    root,
                    azimuth,
                    angles: kind.angle_deg.map(|a| rad(a * steep)),
                    size: 1.0 - kind.smaller * late,
                };
                bough.leaf(kind, way);
            }
        }
        bough.reach
    }
}

/// The ground at the foot of the stalk: fallen petals lie on it, each in a place of its own.
pub(crate) struct Ground {
    seat: Seat,
    /// Radius around the stalk that is already occupied.
    taken: f64,
    /// Radius at which petals will lie.
    radius: f64,
    /// Size of the petals at that radius.
    size: f64,
    count: u32,
    rings: u32,
    used: u32,
}

impl Ground {
    pub(crate) fn new(seat: &Seat, leaves: f64) -> Self {
        Self { seat: *seat, taken: leaves.max(0.02), radius: 0.0, size: 0.0, count: 0, rings: 0, used: 0 }
    }

    /// Reserves room for `n` petals of a size: next to those already there, or around them.
    pub(crate) fn next_ring(&mut self, n: u32, size: f64) {
        if n == self.count && self.used < self.rings && size <= self.size {
            self.used += 1;
            return;
        }
        let round = f64::from(n) * size / ops::TAU;
        self.radius = round.max(self.taken + 0.5 * size);
        self.taken = self.radius + 0.5 * size;
        (self.count, self.size, self.used) = (n, size, 1);
        self.rings = (1..20).take_while(|&m| f64::from(m) * round <= self.radius).last().unwrap_or(1);
    }

    /// Returns the azimuth at which petal `k` of the ring will lie.
    pub(crate) fn azimuth(&self, k: u32) -> f64 {
        let slot = f64::from(k * self.rings + self.used - 1);
        ops::TAU * slot / f64::from(self.count * self.rings).max(1.0)
    }

    /// Moves a petal on its way down; 1 is on the ground, with its upper side up. `from` and `azimuth`: the foot of the
    /// flower, and the azimuth of its place on the ground.
    pub(crate) fn drop(&self, grid: &mut Grid, (from, azimuth): (DVec3, f64), share: f64, seed: Seed) {
        let columns = grid.across.len();
        let rows = grid.along.len();
        let (root, tip) = (grid.points[columns / 2], grid.points[(rows - 1) * columns + columns / 2]);
        let half = (rows / 2) * columns;
        let wide = grid.points[half] - grid.points[half + columns - 1];
        let frame = Frame::looking(root, tip - root, wide.cross(tip - root));
        let centre = grid.points.iter().sum::<DVec3>() / grid.points.len() as f64;
        let mut stream = seed.stream(Draw::Curl);
        let (s, c) = ops::sin_cos(azimuth);
        let place = self.seat.centre + DVec3::new(c, 0.0, s) * self.radius;
        let (ts, tc) = ops::sin_cos(azimuth + stream.range(-1.2, 1.2));
        let lying = Frame::looking(place, DVec3::new(tc, 0.0, ts), DVec3::Y);
        let to = |f: &Frame| DQuat::from_mat3(&glam::DMat3::from_cols(f.right, f.along, f.normal));
        let fall = to(&lying) * to(&frame).inverse();
        let lowest = grid.points.iter().map(|&p| (fall * (p - centre)).y).fold(f64::INFINITY, f64::min);
        let end = DVec3::new(place.x, self.seat.centre.y + 0.0006 - lowest, place.z);
        // First out of the flower, then down.
        let away = DVec3::new(centre.x - from.x, 0.0, centre.z - from.z).normalize_or(DVec3::X);
        let aside = centre + away * (1.3 * self.size);
        let at = centre.lerp(aside, share).lerp(aside.lerp(end, share), share);
        let turned = turn::part(fall, ops::smoothstep(0.15, 0.9, share));
        for p in &mut grid.points {
            *p = at + turned * (*p - centre);
        }
    }
}
