//! Light: directions, depth maps, and the share of the sky that reaches vertices and the ground.
//!
//! The sky is a ball of distant lamps and the sun a small disc of them. Each lamp sees the scene through its own
//! depth map, so that occlusion is soft, has no noise, and does not depend on the view.
#![expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "map arithmetic, clamped")]

use base::{Cancelled, Draw, Run, map_until_cancelled, ops};
use glam::{DVec2, DVec3};

use crate::scene::{Scene, Triangle};
use crate::spec::PictureSpec;

/// Lamps of the whole sky and of the ground's glow. 48: more do not change a picture visibly.
const SKY_LAMPS: usize = 48;
/// Lamps of the sun's disc.
const SUN_LAMPS: usize = 14;
/// Angular radius of the sun, radians. Larger than the real one (0.005): a hazy day, as in a studio.
const SUN_RADIUS: f64 = 0.035;
/// Cells along an edge of the ground's light grid.
const GROUND_CELLS: usize = 96;
/// Light of the sun on a surface that faces it, as reflected by pure white: horizontal ground in sun and sky is nearly
/// white.
pub(crate) const SUN: DVec3 = DVec3::new(0.83, 0.77, 0.68);
/// Light of the sky at the zenith: a white plane that sees the whole sky and no sun is as bright as the backdrop
/// (`shade::backdrop`), by a test.
const ZENITH: DVec3 = DVec3::new(0.61, 0.70, 0.83);
/// Light of the sky at the horizon.
const HORIZON: DVec3 = DVec3::new(0.71, 0.71, 0.70);
/// Light of the ground, which is pale and in the sun.
const BOUNCE: DVec3 = DVec3::new(0.42, 0.41, 0.37);

/// Returns the light from a direction of the sky (or of the pale ground below the horizon).
fn radiance(d: DVec3, skylight: f64) -> DVec3 {
    let up = HORIZON.lerp(ZENITH, ops::smoothstep(0.0, 0.8, d.y));
    up.lerp(BOUNCE, ops::smoothstep(0.05, -0.05, d.y).clamp(0.0, 1.0)) * skylight
}

/// Depths from one distant lamp.
pub(crate) struct DepthMap {
    pub(crate) toward: DVec3,
    u: DVec3,
    v: DVec3,
    origin: DVec3,
    low: DVec2,
    texel: DVec2,
    size: usize,
    depth: Vec<f32>,
}

impl DepthMap {
    fn new(scene: &Scene, toward: DVec3, size: usize) -> Self {
        let u = toward.any_orthonormal_vector();
        let v = toward.cross(u);
        let origin = scene.bounds.centre();
        let mut map =
            Self { toward, u, v, origin, low: DVec2::ZERO, texel: DVec2::ONE, size, depth: Vec::new() };
        let seen: Vec<DVec3> = scene.vertices.iter().map(|x| map.local(x.at)).collect();
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for i in scene.triangles.iter().flat_map(|t| t.corners) {
            low = low.min(seen[i as usize].truncate());
            high = high.max(seen[i as usize].truncate());
        }
        // One free texel all around, so that the border is always lit.
        let extent = (high - low).max(DVec2::splat(scene.radius() * 1e-6 + f64::MIN_POSITIVE));
        map.texel = extent / (size as f64 - 3.0);
        map.low = low - map.texel * 1.5;
        map.depth = vec![f32::NEG_INFINITY; size * size];
        let on_map: Vec<[f32; 3]> = seen
            .iter()
            .map(|&q| {
                let s = (q.truncate() - map.low) / map.texel - 0.5;
                [s.x as f32, s.y as f32, q.z as f32]
            })
            .collect();
        for t in &scene.triangles {
            map.draw(scene, t, t.corners.map(|i| on_map[i as usize]));
        }
        map
    }

    fn local(&self, p: DVec3) -> DVec3 {
        let q = p - self.origin;
        DVec3::new(q.dot(self.u), q.dot(self.v), q.dot(self.toward))
    }

    // Row by row: the edges give the first and the last texel whose centre is inside.
    fn draw(&mut self, scene: &Scene, t: &Triangle, [a, b, c]: [[f32; 3]; 3]) {
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let last = self.size - 1;
        let low = a[1].min(b[1]).min(c[1]);
        let high = a[1].max(b[1]).max(c[1]);
        let (first_row, last_row) = (up(low), (high as usize).min(last));
        let left = a[0].min(b[0]).min(c[0]).max(0.0);
        let right = a[0].max(b[0]).max(c[0]);
        // Most triangles of a large plant lie between the texels' centres.
        if first_row > last_row || up(left) > right as usize {
            return;
        }
        let sign = 1.0 / area;
        // Barycentric weight of the corner across from each edge: w(x, y) = w[0] + w[1] x + w[2] y.
        let weight = |p: [f32; 3], q: [f32; 3]| {
            [(p[0] * q[1] - p[1] * q[0]) * sign, (p[1] - q[1]) * sign, (q[0] - p[0]) * sign]
        };
        let weights = [weight(b, c), weight(c, a), weight(a, b)];
        let blend = |za: f32, zb: f32, zc: f32| {
            [0, 1, 2].map(|k| za * weights[0][k] + zb * weights[1][k] + zc * weights[2][k])
        };
        let plane = blend(a[2], b[2], c[2]);
        let surface = &scene.surfaces[t.surface as usize];
        let mask = surface.texture.as_ref().filter(|_| surface.mask);
        let uv = scene.corners(t).map(|v| v.uv.as_vec2());
        let us = blend(uv[0].x, uv[1].x, uv[2].x);
        let vs = blend(uv[0].y, uv[1].y, uv[2].y);
        for row in first_row..=last_row {
            let y = row as f32;
            let (mut from, mut to) = (left, right);
            for w in &weights {
                let start = w[0] + w[2] * y;
                if w[1] > 0.0 {
                    from = from.max(-start / w[1]);
                } else if w[1] < 0.0 {
                    to = to.min(-start / w[1]);
                } else if start < 0.0 {
                    to = -1.0;
                }
            }
            if to < from || to < 0.0 {
                continue;
            }
            let (from, to) = (up(from), (to as usize).min(last));
            if from > to {
                continue;
            }
            let z = plane[0] + plane[2] * y;
            let texels = &mut self.depth[row * self.size + from..=row * self.size + to];
            if let Some(mask) = mask {
                let (u, v) = (us[0] + us[2] * y, vs[0] + vs[2] * y);
                for (x, texel) in (from..).zip(texels) {
                    let x = x as f32;
                    let z = z + plane[1] * x;
                    if z > *texel && !mask.hole(u + us[1] * x, v + vs[1] * x) {
                        *texel = z;
                    }
                }
            } else {
                for (x, texel) in (from..).zip(texels) {
                    let z = z + plane[1] * x as f32;
                    *texel = if z > *texel { z } else { *texel };
                }
            }
        }
    }

    /// Returns the share of the lamp that reaches `p`, 0 to 1, from the four texels around. `slope` is the tangent of
    /// the angle between the surface and the plane normal to the lamp's rays: steep surfaces span more depth in a
    /// texel.
    pub(crate) fn lit(&self, p: DVec3, slope: f64) -> f64 {
        let q = self.local(p);
        let s = (q.truncate() - self.low) / self.texel - 0.5;
        let top = (self.size - 2) as f64;
        if !(s.x >= 0.0 && s.y >= 0.0 && s.x < top && s.y < top) {
            return 1.0;
        }
        let bias = self.texel.max_element() * (0.6 + slope.min(4.0));
        let z = (q.z + bias) as f32;
        let (x, y) = (s.x as usize, s.y as usize);
        let (tx, ty) = (s.x - x as f64, s.y - y as f64);
        let at = y * self.size + x;
        let seen = |i: usize| f64::from(u8::from(self.depth[i] <= z));
        let near = ops::lerp(seen(at), seen(at + 1), tx);
        let far = ops::lerp(seen(at + self.size), seen(at + self.size + 1), tx);
        ops::lerp(near, far, ty)
    }

    /// As [`lit`](Self::lit), for a surface with unit normal `n`, of either side.
    fn lit_surface(&self, p: DVec3, n: DVec3) -> f64 {
        self.lit(p, slope(n.dot(self.toward)))
    }
}

// Returns the first whole number from x on; x is not negative.
fn up(x: f32) -> usize {
    let down = x.max(0.0) as usize;
    if (down as f32) < x { down + 1 } else { down }
}

// Returns the tangent of the angle whose cosine is given, of either sign.
fn slope(cos: f64) -> f64 {
    let c = cos.abs().max(0.05);
    (1.0 - c * c).max(0.0).sqrt() / c
}

/// Returns the share of the sun's disc that reaches a surface at `p` with unit normal `n`.
pub(crate) fn sunlit(sun: &[DepthMap], p: DVec3, n: DVec3) -> f64 {
    // The disc is small: one slope serves all its lamps.
    let slope = sun.first().map_or(0.0, |m| slope(n.dot(m.toward)));
    sun.iter().map(|m| m.lit(p, slope)).sum::<f64>() / sun.len().max(1) as f64
}

/// Light of the sky on both sides of every vertex and on the ground; does not depend on the view.
pub(crate) struct Sky {
    /// Light on the side of the normal, and on the other side, as reflected by pure white.
    pub(crate) vertices: Vec<[DVec3; 2]>,
    ground_low: DVec2,
    ground_cell: DVec2,
    ground: Vec<DVec3>,
    /// Light of the free sky on horizontal ground.
    pub(crate) open: DVec3,
    /// Factor on the usual brightness.
    skylight: f64,
    turn: f64,
    map_size: usize,
}

/// A lamp of the sky: what lies open to it, and its light.
struct Lamp {
    map: DepthMap,
    light: DVec3,
}

impl Sky {
    pub(crate) fn new(scene: &Scene, spec: &PictureSpec, run: &Run<'_>) -> Result<Self, Cancelled> {
        let turn = spec.seed.stream(Draw::Sampling).range(0.0, ops::TAU);
        let pixels = spec.width.max(spec.height) as usize;
        let map_size = pixels.clamp(192, 1024);
        let directions: Vec<DVec3> = (0..SKY_LAMPS).map(|k| sphere_point(k, SKY_LAMPS, turn)).collect();
        // A lamp stands for 4 pi / n of the sphere; white reflects 1 / pi of it.
        let share = 4.0 / SKY_LAMPS as f64;
        let open =
            directions.iter().filter(|d| d.y > 0.0).map(|&d| radiance(d, spec.skylight) * d.y * share).sum();
        let mut sky = Self {
            vertices: Vec::new(),
            ground_low: DVec2::ZERO,
            ground_cell: DVec2::ONE,
            ground: Vec::new(),
            open,
            skylight: spec.skylight,
            turn,
            map_size,
        };
        if scene.triangles.is_empty() {
            return Ok(sky);
        }
        let size = (map_size / 3).clamp(96, 256);
        let lamps = map_until_cancelled(run, SKY_LAMPS, |k| Lamp {
            map: DepthMap::new(scene, directions[k], size),
            light: radiance(directions[k], spec.skylight),
        })?;
        const CHUNK: usize = 1024;
        let chunks = map_until_cancelled(run, scene.vertices.len().div_ceil(CHUNK), |k| {
            let end = ((k + 1) * CHUNK).min(scene.vertices.len());
            scene.vertices[k * CHUNK..end]
                .iter()
                .map(|v| {
                    let mut both = [DVec3::ZERO; 2];
                    for Lamp { map, light } in &lamps {
                        let c = v.normal.dot(map.toward);
                        let lit = map.lit_surface(v.at, v.normal);
                        both[usize::from(c < 0.0)] += *light * (c.abs() * lit * share);
                    }
                    both
                })
                .collect::<Vec<_>>()
        })?;
        sky.vertices = chunks.into_iter().flatten().collect();
        sky.light_ground(scene, &lamps, share, run)?;
        Ok(sky)
    }

    fn light_ground(
        &mut self,
        scene: &Scene,
        lamps: &[Lamp],
        share: f64,
        run: &Run<'_>,
    ) -> Result<(), Cancelled> {
        let centre = scene.bounds.centre();
        // Twice the model's own extent: beyond, its shade under an open sky is below one step of grey.
        let half = DVec2::splat(scene.radius() * 2.0);
        self.ground_low = DVec2::new(centre.x, centre.z) - half;
        self.ground_cell = half * 2.0 / (GROUND_CELLS - 1) as f64;
        let rows = map_until_cancelled(run, GROUND_CELLS, |row| {
            (0..GROUND_CELLS)
                .map(|column| {
                    let at = self.ground_low + self.ground_cell * DVec2::new(column as f64, row as f64);
                    let p = DVec3::new(at.x, scene.ground, at.y);
                    let above = lamps.iter().filter(|lamp| lamp.map.toward.y > 0.0);
                    above
                        .map(|Lamp { map, light }| {
                            *light * (map.toward.y * share * map.lit_surface(p, DVec3::Y))
                        })
                        .sum::<DVec3>()
                })
                .collect::<Vec<DVec3>>()
        })?;
        let raw: Vec<DVec3> = rows.into_iter().flatten().collect();
        self.ground = blurred(&blurred(&raw));
        Ok(())
    }

    /// Returns the light of sky and ground on an unobstructed surface of unit normal `n`, as reflected by pure white.
    /// Exact for a uniform sky above uniform ground.
    pub(crate) fn free(&self, n: DVec3) -> DVec3 {
        (BOUNCE * self.skylight).lerp(self.open, 0.5 + 0.5 * n.y)
    }

    /// Returns the sky's light on the ground below `p`.
    pub(crate) fn on_ground(&self, p: DVec3) -> DVec3 {
        let s = (DVec2::new(p.x, p.z) - self.ground_low) / self.ground_cell;
        let top = (GROUND_CELLS - 1) as f64;
        if self.ground.is_empty() || !(s.x >= 0.0 && s.y >= 0.0 && s.x < top && s.y < top) {
            return self.open;
        }
        let (x, y) = (s.x as usize, s.y as usize);
        let (tx, ty) = (s.x - x as f64, s.y - y as f64);
        let at = y * GROUND_CELLS + x;
        let near = self.ground[at].lerp(self.ground[at + 1], tx);
        let far = self.ground[at + GROUND_CELLS].lerp(self.ground[at + GROUND_CELLS + 1], tx);
        // The light fades to that of the open ground towards the edge of the grid.
        let edge = (s.min(DVec2::splat(top) - s)).min_element() / top;
        self.open.lerp(near.lerp(far, ty), ops::smoothstep(0.0, 0.15, edge))
    }

    /// Returns the sun's lamps for a viewer whose horizontal directions to the right and towards the eye are given:
    /// from the upper left, a little in front of the model; or those of the sun that was `placed`.
    pub(crate) fn sun(
        &self,
        scene: &Scene,
        (right, toward): (DVec3, DVec3),
        placed: Option<DVec3>,
        run: &Run<'_>,
    ) -> Result<Vec<DepthMap>, Cancelled> {
        if scene.triangles.is_empty() {
            return Ok(Vec::new());
        }
        let beside = (right * -0.62 + toward * 0.42 + DVec3::Y * 0.95).normalize();
        let centre = placed.unwrap_or(beside);
        let u = centre.any_orthonormal_vector();
        let v = centre.cross(u);
        map_until_cancelled(run, SUN_LAMPS, |k| {
            let r = SUN_RADIUS * ((k as f64 + 0.5) / SUN_LAMPS as f64).sqrt();
            let (s, c) = ops::sin_cos(self.turn + GOLDEN_ANGLE * k as f64);
            DepthMap::new(scene, (centre + (u * c + v * s) * r).normalize(), self.map_size)
        })
    }
}

const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

// Spherical Fibonacci points (Gonzalez 2010): even over the sphere for any count.
fn sphere_point(k: usize, n: usize, turn: f64) -> DVec3 {
    let y = 1.0 - (2.0 * k as f64 + 1.0) / n as f64;
    let r = (1.0 - y * y).max(0.0).sqrt();
    let (s, c) = ops::sin_cos(turn + GOLDEN_ANGLE * k as f64);
    DVec3::new(r * c, y, r * s)
}

// A 3 x 3 box over the ground's grid.
fn blurred(raw: &[DVec3]) -> Vec<DVec3> {
    let n = GROUND_CELLS;
    let clamp = |i: usize, d: usize| (i + d).saturating_sub(1).min(n - 1);
    (0..n * n)
        .map(|i| {
            let (x, y) = (i % n, i / n);
            let sum: DVec3 = (0..9).map(|k| raw[clamp(y, k / 3) * n + clamp(x, k % 3)]).sum();
            sum / 9.0
        })
        .collect()
}
