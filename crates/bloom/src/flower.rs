//! A species -> a whole flower at any day: bud, bloom, wilting.
//!
//! Petals lie on surfaces of revolution about the flower's axis. Their profile (angle to the axis at base, middle
//! and tip) goes from bud to bloom by the growth law of the region, and on to wilting. Within a whorl each petal
//! leans: one edge lies inside its neighbour, the other outside, so petals may overlap but never meet; whorls are
//! nested.

use base::{Draw, Seed, ops};
use glam::{DQuat, DVec3};
use mesh::{Material, MaterialId, MaterialKind, Model, Part, TriMesh};

use crate::{GrowthLaw, Quantity};

/// One ring of petals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whorl {
    /// Petals.
    pub count: u32,
    /// Length of an open petal, metres.
    pub length: f64,
    /// Greatest width, metres.
    pub width: f64,
    /// Place of the greatest width along the petal, 0.2 to 0.9.
    pub widest: f64,
    /// Width at the base as a share of the greatest.
    pub claw: f64,
    /// How pointed the tip is: 1 is a point, 0 is round.
    pub point: f64,
    /// Radius and height of the insertion, metres.
    pub insertion: [f64; 2],
    /// Angle to the axis at base, middle and tip in the bud, degrees.
    pub bud: [f64; 3],
    /// The same in full bloom.
    pub open: [f64; 3],
    /// The same when wilted.
    pub wilted: [f64; 3],
    /// Days that the whorl opens later than the first, as a share of the opening.
    pub delay: f64,
    /// Turn of the whorl about the axis, degrees.
    pub phase: f64,
    /// Lean within the whorl: distance of one edge to the other across the petal, metres.
    pub lean: f64,
    /// Linear colour at the base and at the tip.
    pub colors: [[f32; 3]; 2],
}

/// A flower that opens.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowerSpec {
    /// Name of the species.
    pub name: String,
    /// Outermost first.
    pub whorls: Vec<Whorl>,
    /// Stamens: number, open length in metres, spread in degrees.
    pub stamens: (u32, f64, f64),
    /// Length of the pistil, metres; 0 for none.
    pub pistil: f64,
    /// Radius of a disc of florets, metres; 0 for none.
    pub disc: f64,
    /// Length of the stalk, metres.
    pub stalk: f64,
    /// Flowers of an umbel; 1 for a single flower.
    pub umbel: u32,
    /// Days from bud to full bloom, and from there to wilted.
    pub days: [f64; 2],
    /// Rate of the default law, per day.
    pub rate: f64,
    /// Rows and columns of a petal's mesh, each at least 2.
    pub mesh: [u32; 2],
}

/// A flower at one day, and which petal each triangle of its petals belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowerFrame {
    /// Meshes in metres; the same vertices and triangles at every day.
    pub model: Model,
    /// For each part the petal of each triangle; `u32::MAX` for what is no petal.
    pub petals: Vec<Vec<u32>>,
}

impl FlowerFrame {
    /// Share of petal triangles that cross another petal, over all parts.
    pub fn overlap(&self) -> f64 {
        let mut whole = TriMesh::default();
        let mut groups = Vec::new();
        for (part, petals) in self.model.parts.iter().zip(&self.petals) {
            if petals.iter().all(|&p| p == u32::MAX) {
                continue;
            }
            let bare = TriMesh {
                positions: part.mesh.positions.clone(),
                triangles: part.mesh.triangles.clone(),
                ..TriMesh::default()
            };
            whole.append(&bare);
            groups.extend_from_slice(petals);
        }
        crate::overlap_share(&whole, &groups)
    }
}

/// State of one whorl at one day.
struct Profile {
    angle: [f64; 3],
    length: f64,
    width: f64,
}

/// Degrees to radians.
fn rad(d: f64) -> f64 {
    d * (ops::PI / 180.0)
}

fn blend3(a: [f64; 3], b: [f64; 3], g: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| ops::lerp(a[k], b[k], g[k]))
}

impl Whorl {
    fn profile(&self, spec: &FlowerSpec, law: &GrowthLaw, day: f64) -> Profile {
        let [opening, wilting] = spec.days.map(|d| d.max(1e-6));
        // The law's own time is stretched to the opening; a whorl with a delay starts later and ends with the others.
        let share = ((day / opening - self.delay) / (1.0 - self.delay.clamp(0.0, 0.9))).clamp(0.0, 1.0);
        let at = |along: f64, axis| {
            law.progress("petal", axis, along, 0.0, law.span_days, share * law.span_days).clamp(0.0, 1.0)
        };
        let g = [0.15, 0.5, 0.85].map(|along| at(along, Quantity::Size).max(0.0));
        let size = at(0.5, Quantity::Size);
        let wilt = ops::smoothstep(0.0, 1.0, ((day - opening) / wilting).clamp(0.0, 1.0));
        let open = blend3(self.bud, self.open, g);
        Profile {
            angle: blend3(open, self.wilted, [wilt; 3]).map(rad),
            length: self.length * ops::lerp(0.62, 1.0, size) * (1.0 - 0.12 * wilt),
            width: self.width * ops::lerp(0.7, 1.0, size) * (1.0 - 0.3 * wilt),
        }
    }

    /// Half width at `v` as a share of the greatest.
    fn outline(&self, v: f64) -> f64 {
        let w = self.widest.clamp(0.2, 0.9);
        if v < w {
            let t = v / w;
            ops::lerp(self.claw, 1.0, t * t * (3.0 - 2.0 * t))
        } else {
            let t = (v - w) / (1.0 - w);
            let round = (1.0 - t * t).max(0.0).sqrt();
            ops::lerp(round, 1.0 - t * t * (1.0 - 0.3 * (1.0 - t)), self.point).max(0.0) * (1.0 - 0.02) + 0.02
        }
    }
}

impl FlowerSpec {
    /// The names of the presets.
    pub const PRESETS: [&'static str; 5] = ["rose", "lily", "tulip", "sunflower", "clivia"];

    /// The flower at `day`: 0 is the bud, `days[0]` full bloom, `days[0] + days[1]` wilted.
    ///
    /// Guaranteed: the same vertices and triangles at every day; `model.validate()` finds nothing. `law` sets the
    /// pace by its size and region laws, whatever species it was fitted to (paper 003, figure 13).
    pub fn at(&self, day: f64, law: &GrowthLaw, seed: Seed) -> FlowerFrame {
        let mut frame = FlowerFrame {
            model: Model { name: self.name.clone(), parts: vec![], materials: materials() },
            petals: vec![],
        };
        let flowers = self.umbel.max(1);
        let mut next = 0;
        for (w, whorl) in self.whorls.iter().enumerate() {
            let mut mesh = TriMesh::default();
            let mut petals = Vec::new();
            let profile = whorl.profile(self, law, day);
            for f in 0..flowers {
                let place = self.place(f);
                for k in 0..whorl.count {
                    self.petal(whorl, &profile, k, place, &mut mesh);
                    let triangles = mesh.triangles.len() - petals.len();
                    petals.extend(core::iter::repeat_n(next, triangles));
                    next += 1;
                }
            }
            finish(&mut frame, format!("petals-{}", w + 1), 0, mesh, petals);
        }
        let [opening, wilting] = self.days.map(|d| d.max(1e-6));
        let share = (day / opening).clamp(0.0, 1.0);
        let g = law
            .progress("petal", Quantity::Size, 0.3, 0.0, law.span_days, share * law.span_days)
            .clamp(0.0, 1.0);
        let wilt = ((day - opening) / wilting).clamp(0.0, 1.0);
        self.centre(&mut frame, g, wilt, seed);
        self.stalks(&mut frame);
        frame
    }

    /// Where flower `f` of the umbel sits, and how it is turned.
    fn place(&self, f: u32) -> (DVec3, DQuat) {
        let n = self.umbel.max(1);
        if n == 1 {
            return (DVec3::Y * self.stalk, DQuat::IDENTITY);
        }
        // Evenly over a cap of 75 degrees (Vogel's spiral), each on its own pedicel.
        let t = (f64::from(f) + 0.5) / f64::from(n);
        let tilt = ops::acos_clamped(1.0 - t * (1.0 - ops::cos(rad(75.0))));
        let azimuth = f64::from(f) * rad(137.507_8);
        let (s, c) = ops::sin_cos(azimuth);
        let direction = DVec3::new(ops::sin(tilt) * c, ops::cos(tilt), ops::sin(tilt) * s);
        (DVec3::Y * self.stalk + direction * self.pedicel(), DQuat::from_rotation_arc(DVec3::Y, direction))
    }

    fn pedicel(&self) -> f64 {
        self.whorls.first().map_or(0.05, |w| 1.1 * w.length)
    }

    fn petal(&self, whorl: &Whorl, profile: &Profile, k: u32, place: (DVec3, DQuat), mesh: &mut TriMesh) {
        let (rows, columns) = (self.mesh[0].max(2), self.mesh[1].max(2));
        let apart = ops::TAU / f64::from(whorl.count.max(1));
        let azimuth = rad(whorl.phase) + apart * f64::from(k);
        let start = u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX);
        // The profile by small steps; angles between the three places by a parabola through them.
        let fine = 8 * rows;
        let [a, b, c] = profile.angle;
        let angle =
            |v: f64| a * (1.0 - v) * (1.0 - 2.0 * v) + 4.0 * b * v * (1.0 - v) + c * v * (2.0 * v - 1.0);
        let (mut radius, mut height) = (whorl.insertion[0], whorl.insertion[1]);
        let step = profile.length / f64::from(fine);
        for i in 0..=fine {
            let v = f64::from(i) / f64::from(fine);
            let (s, c) = ops::sin_cos(angle(v));
            if i.is_multiple_of(8) {
                let half = 0.5 * profile.width * whorl.outline(v);
                // A petal wraps the axis, but neither itself nor more than its next neighbours.
                let spread = (half / radius.max(1e-4)).min(0.9 * ops::PI).min(0.85 * apart);
                for j in 0..=columns {
                    let u = 2.0 * f64::from(j) / f64::from(columns) - 1.0;
                    let lean = whorl.lean * u;
                    let (r, y) = (radius + lean * c, height - lean * s);
                    let (sin, cos) = ops::sin_cos(azimuth + u * spread);
                    let p = place.0 + place.1 * DVec3::new(r.max(1e-5) * cos, y, r.max(1e-5) * sin);
                    mesh.push(p);
                    let color = [0, 1, 2].map(|q| {
                        #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
                        let share = ops::smoothstep(0.0, 0.6, v) as f32;
                        whorl.colors[0][q] + (whorl.colors[1][q] - whorl.colors[0][q]) * share
                    });
                    mesh.colors.push(color);
                    #[expect(clippy::cast_possible_truncation, reason = "texture coordinates are f32")]
                    mesh.uvs.push([(0.5 + 0.5 * u) as f32, 1.0 - v as f32]);
                }
            }
            // A profile that comes to the axis runs up along it.
            radius = (radius + s * step).max(whorl.insertion[0].min(0.0012));
            height += c * step;
        }
        quads(mesh, start, rows, columns);
    }

    fn centre(&self, frame: &mut FlowerFrame, g: f64, wilt: f64, seed: Seed) {
        let mut stamens = TriMesh::default();
        let mut disc = TriMesh::default();
        for f in 0..self.umbel.max(1) {
            let place = self.place(f);
            let lowest = self.whorls.iter().map(|w| w.insertion[1]).fold(f64::INFINITY, f64::min);
            let base = if lowest.is_finite() { lowest } else { 0.0 };
            let (count, length, spread) = self.stamens;
            for k in 0..count {
                let mut stream = seed.child(u64::from(f)).child(u64::from(k)).stream(Draw::Size);
                let azimuth = f64::from(k) * rad(137.507_8);
                let tilt = rad(spread
                    * ops::lerp(0.25, 1.0, g)
                    * ops::lerp(0.6, 1.0, f64::from(k) / f64::from(count.max(1)))
                    + 18.0 * wilt);
                let long = length * ops::lerp(0.45, 1.0, g) * stream.range(0.9, 1.0) * (1.0 - 0.15 * wilt);
                let (s, c) = ops::sin_cos(azimuth);
                let out = DVec3::new(ops::sin(tilt) * c, ops::cos(tilt), ops::sin(tilt) * s);
                let foot = DVec3::new(0.0015 * c, base, 0.0015 * s);
                let tip = foot + out * long + DVec3::Y * (0.1 * long);
                let thick = (0.012 * length).clamp(0.0003, 0.0012);
                tube(
                    &mut stamens,
                    &[foot, foot.lerp(tip, 0.5) + out * (0.03 * long), tip].map(|p| place.0 + place.1 * p),
                    thick,
                    [0.75, 0.8, 0.5],
                );
                let anther = (0.09 * length).clamp(0.001, 0.006);
                let along = DVec3::Y.cross(out).try_normalize().unwrap_or(DVec3::X);
                tube(
                    &mut stamens,
                    &[tip - along * anther, tip, tip + along * anther].map(|p| place.0 + place.1 * p),
                    thick * 2.2,
                    [0.75, 0.35, 0.05],
                );
            }
            if self.pistil > 0.0 {
                let long = self.pistil * ops::lerp(0.5, 1.0, g);
                let at = |y: f64| place.0 + place.1 * DVec3::new(0.0, base + y, 0.0);
                let thick = (0.03 * self.pistil).clamp(0.0008, 0.004);
                tube(&mut stamens, &[at(0.0), at(0.6 * long), at(long)], thick, [0.55, 0.7, 0.25]);
                tube(
                    &mut stamens,
                    &[at(long), at(long + 1.5 * thick), at(long + 2.5 * thick)],
                    1.8 * thick,
                    [0.6, 0.75, 0.3],
                );
            }
            if self.disc > 0.0 {
                florets(&mut disc, self.disc * ops::lerp(0.75, 1.0, g), base, place, g);
            }
        }
        if !stamens.positions.is_empty() {
            let none = vec![u32::MAX; stamens.triangles.len()];
            finish(frame, "stamens".into(), 1, stamens, none);
        }
        if !disc.positions.is_empty() {
            let none = vec![u32::MAX; disc.triangles.len()];
            finish(frame, "disc".into(), 2, disc, none);
        }
    }

    fn stalks(&self, frame: &mut FlowerFrame) {
        let mut mesh = TriMesh::default();
        let green = [0.16, 0.32, 0.07];
        let thick = self.whorls.first().map_or(0.002, |w| 0.03 * w.length + 0.001).max(0.28 * self.disc);
        let slim = thick.min(0.006);
        tube(
            &mut mesh,
            &[DVec3::ZERO, DVec3::new(0.01 * self.stalk, 0.5 * self.stalk, 0.0), DVec3::Y * self.stalk],
            slim,
            green,
        );
        for f in 0..self.umbel.max(1) {
            let (place, turn) = self.place(f);
            if self.umbel > 1 {
                let foot = DVec3::Y * self.stalk;
                tube(&mut mesh, &[foot, foot.lerp(place, 0.5) + DVec3::Y * 0.004, place], 0.5 * slim, green);
            }
            // The receptacle joins stalk and petals.
            let wide = self.whorls.iter().map(|w| w.insertion[0]).fold(0.0, f64::max).max(self.disc);
            let low = -0.6 * wide - 0.002;
            bowl(&mut mesh, place, turn, wide, low, green);
        }
        let none = vec![u32::MAX; mesh.triangles.len()];
        finish(frame, "stalk".into(), 3, mesh, none);
    }
}

fn materials() -> Vec<Material> {
    let white = [1.0; 3];
    let mut petal = Material::plain("petal", MaterialKind::Petal, white);
    petal.double_sided = true;
    petal.translucency = 0.3;
    petal.roughness = 0.6;
    vec![
        petal,
        Material::plain("stamen", MaterialKind::Stamen, white),
        Material::plain("disc", MaterialKind::Disc, white),
        Material::plain("stem", MaterialKind::Stem, white),
    ]
}

fn finish(frame: &mut FlowerFrame, name: String, material: usize, mut mesh: TriMesh, petals: Vec<u32>) {
    mesh.compute_normals();
    frame.model.parts.push(Part { name, material: MaterialId::new(material), mesh });
    frame.petals.push(petals);
}

/// Triangles of a grid of `rows` by `columns` quads from vertex `start` on.
fn quads(mesh: &mut TriMesh, start: u32, rows: u32, columns: u32) {
    let across = columns + 1;
    for i in 0..rows {
        for j in 0..columns {
            let a = start + i * across + j;
            mesh.triangles.push([a, a + across, a + 1]);
            mesh.triangles.push([a + 1, a + across, a + across + 1]);
        }
    }
}

/// A six-sided tube through three points.
fn tube(mesh: &mut TriMesh, line: &[DVec3; 3], radius: f64, color: [f32; 3]) {
    let start = u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX);
    let frames = geom::rotation_minimising_frames(line, None);
    for f in &frames {
        for k in 0..=6 {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 6.0);
            mesh.push(f.origin + (f.normal * c + f.binormal * s) * radius);
            mesh.colors.push(color);
            mesh.uvs.push([0.0, 0.0]);
        }
    }
    quads(mesh, start, 2, 6);
    mesh.triangles.iter_mut().rev().take(24).for_each(|t| t.swap(1, 2));
}

fn bowl(mesh: &mut TriMesh, place: DVec3, turn: DQuat, wide: f64, low: f64, color: [f32; 3]) {
    let start = u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX);
    let rings = [(0.08, low), (0.6, 0.45 * low), (1.0, -0.0005), (0.5, 0.0)];
    for (r, y) in rings {
        for k in 0..=12 {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 12.0);
            mesh.push(place + turn * DVec3::new(wide * r * c, y, wide * r * s));
            mesh.colors.push(color);
            mesh.uvs.push([0.0, 0.0]);
        }
    }
    quads(mesh, start, 3, 12);
}

/// A domed disc of florets in Vogel's spiral (phyllotaxis of 137.5 degrees), outer ones open.
fn florets(mesh: &mut TriMesh, radius: f64, base: f64, place: (DVec3, DQuat), g: f64) {
    let count = 260;
    for k in 0..count {
        let share = (f64::from(k) + 0.5) / f64::from(count);
        let r = radius * share.sqrt();
        let (s, c) = ops::sin_cos(f64::from(k) * rad(137.507_8));
        let dome = 0.22 * radius * (1.0 - share);
        let foot = DVec3::new(r * c, base + dome - 0.002, r * s);
        let long = 0.07 * radius * ops::lerp(0.6, 1.0 + share, g) + 0.002;
        let up = DVec3::new(0.25 * c * share, 1.0, 0.25 * s * share).normalize_or(DVec3::Y);
        #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
        let t = share as f32;
        let color = [0.12 + 0.25 * t, 0.06 + 0.1 * t, 0.015];
        let line = [foot, foot + up * (0.6 * long), foot + up * long].map(|p| place.0 + place.1 * p);
        tube(mesh, &line, 0.042 * radius, color);
    }
}
