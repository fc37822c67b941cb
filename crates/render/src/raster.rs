//! Finds the visible triangle of each sample of a tile.
//!
//! Corners are rounded to 1/256 pixel, so that edge functions are exact in f64 and neighbours leave no gap. The samples
//! of a pixel form a sheared grid: nearly vertical and nearly horizontal edges cross as many steps as slanted ones.
#![expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pixel arithmetic, clamped")]

use glam::{DVec2, DVec3};

use crate::camera::Camera;
use crate::scene::Scene;

/// Pixels along a tile's edge.
pub(crate) const TILE: usize = 32;
/// No triangle.
pub(crate) const NONE: u32 = u32::MAX;
const SUBPIXEL: f64 = 256.0;
const MAX_SAMPLES: usize = 36;

/// A triangle on the picture.
pub(crate) struct Flat {
    /// Corners in pixels, z the camera's depth key.
    pub(crate) corners: [DVec3; 3],
    /// Twice the signed area.
    area: f64,
}

impl Flat {
    fn new(scene_corners: [DVec3; 3], camera: &Camera) -> Option<Self> {
        let mut corners = scene_corners.map(|p| camera.project(p));
        for c in &mut corners {
            c.x = (c.x * SUBPIXEL).round() / SUBPIXEL;
            c.y = (c.y * SUBPIXEL).round() / SUBPIXEL;
        }
        let [a, b, c] = corners;
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        (area != 0.0 && area.is_finite()).then_some(Self { corners, area })
    }

    /// Returns the barycentric coordinates on the picture.
    pub(crate) fn weights(&self, p: DVec2) -> DVec3 {
        let [a, b, c] = self.corners.map(DVec3::truncate);
        let wa = (b - p).perp_dot(c - p) / self.area;
        let wb = (c - p).perp_dot(a - p) / self.area;
        DVec3::new(wa, wb, 1.0 - wa - wb)
    }

    /// Returns the barycentric coordinates on the triangle itself: the nearer corner weighs more in perspective.
    pub(crate) fn surface_weights(&self, p: DVec2, perspective: bool) -> DVec3 {
        let w = self.weights(p).clamp(DVec3::ZERO, DVec3::ONE);
        let w = if perspective { w * DVec3::from(self.corners.map(|c| c.z)) } else { w };
        let sum = w.x + w.y + w.z;
        if sum > 0.0 { w / sum } else { DVec3::splat(1.0 / 3.0) }
    }

    /// Returns the number of pixels that the triangle covers.
    pub(crate) fn pixel_area(&self) -> f64 {
        self.area.abs() * 0.5
    }
}

/// The triangles of a scene on the picture, sorted into tiles.
pub(crate) struct Bins {
    pub(crate) flats: Vec<Option<Flat>>,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    tiles: Vec<Vec<u32>>,
}

impl Bins {
    pub(crate) fn new(scene: &Scene, camera: &Camera, width: u32, height: u32) -> Self {
        let columns = (width as usize).div_ceil(TILE);
        let rows = (height as usize).div_ceil(TILE);
        let mut tiles = vec![Vec::new(); columns * rows];
        let flats: Vec<Option<Flat>> =
            scene.triangles.iter().map(|t| Flat::new(scene.corners(t).map(|v| v.at), camera)).collect();
        for (i, flat) in (0_u32..).zip(&flats) {
            let Some(flat) = flat else { continue };
            let [a, b, c] = flat.corners;
            let low = a.min(b).min(c) / TILE as f64;
            let high = a.max(b).max(c) / TILE as f64;
            if high.x < 0.0 || high.y < 0.0 {
                continue;
            }
            // Saturating casts: positions outside the picture land in its border tiles or in none.
            for row in low.y as usize..=(high.y as usize).min(rows - 1) {
                for column in low.x as usize..=(high.x as usize).min(columns - 1) {
                    tiles[row * columns + column].push(i);
                }
            }
        }
        Self { flats, columns, rows, tiles }
    }

    pub(crate) fn faces_in(&self, tile: usize) -> &[u32] {
        &self.tiles[tile]
    }
}

/// Returns the positions of the samples within a pixel, 0 to 1.
pub(crate) fn pattern(per_edge: u32) -> Vec<DVec2> {
    let n = f64::from(per_edge);
    let round = |x: f64| (x * SUBPIXEL).floor() / SUBPIXEL;
    (0..per_edge * per_edge)
        .map(|k| {
            let (i, j) = (f64::from(k % per_edge), f64::from(k / per_edge));
            DVec2::new(round((i + (j + 0.5) / n) / n), round((j + (n - 0.5 - i) / n) / n))
        })
        .collect()
}

/// The visible triangle of every sample of a tile.
pub(crate) struct Visible {
    pub(crate) ids: Vec<u32>,
    keys: Vec<f32>,
    samples: usize,
}

impl Visible {
    /// Returns the ids of the samples of a pixel of the tile.
    pub(crate) fn pixel(&self, x: usize, y: usize) -> &[u32] {
        let at = (y * TILE + x) * self.samples;
        &self.ids[at..at + self.samples]
    }

    /// Draws the triangles of the tile whose upper left pixel is `origin`.
    pub(crate) fn draw(
        scene: &Scene,
        bins: &Bins,
        tile: usize,
        pattern: &[DVec2],
        perspective: bool,
    ) -> Self {
        let samples = pattern.len().min(MAX_SAMPLES);
        let count = TILE * TILE * samples;
        let mut seen = Self { ids: vec![NONE; count], keys: vec![f32::NEG_INFINITY; count], samples };
        let origin = DVec2::new((tile % bins.columns * TILE) as f64, (tile / bins.columns * TILE) as f64);
        for &id in bins.faces_in(tile) {
            if let Some(flat) = &bins.flats[id as usize] {
                seen.add(scene, flat, id, origin, &pattern[..samples], perspective);
            }
        }
        seen
    }

    fn add(
        &mut self,
        scene: &Scene,
        flat: &Flat,
        id: u32,
        origin: DVec2,
        pattern: &[DVec2],
        perspective: bool,
    ) {
        let triangle = &scene.triangles[id as usize];
        let surface = &scene.surfaces[triangle.surface as usize];
        let mask = surface.texture.as_ref().filter(|_| surface.mask);
        // In a front view the ground is a line, and parts below it are shown.
        let sunk = perspective && scene.corners(triangle).iter().any(|v| v.at.y < scene.ground);
        let [a, b, c] = flat.corners.map(|p| DVec3::new(p.x - origin.x, p.y - origin.y, p.z));
        let sign = flat.area.signum();
        // Edge functions e(p) = dot(n, p) + k, positive inside.
        let edge = |p: DVec3, q: DVec3| {
            let n = DVec2::new(p.y - q.y, q.x - p.x) * sign;
            (n, (p.x * q.y - p.y * q.x) * sign)
        };
        let edges = [edge(b, c), edge(c, a), edge(a, b)];
        let inverse = 1.0 / flat.area.abs();
        let mut steps = [[0.0_f64; 3]; MAX_SAMPLES];
        for (step, &s) in steps.iter_mut().zip(pattern) {
            *step = [edges[0].0.dot(s), edges[1].0.dot(s), edges[2].0.dot(s)];
        }
        let most =
            [0, 1, 2].map(|i| steps[..pattern.len()].iter().map(|s| s[i]).fold(f64::NEG_INFINITY, f64::max));
        let low = a.min(b).min(c).max(DVec3::ZERO);
        let high = a.max(b).max(c).min(DVec3::splat((TILE - 1) as f64));
        if high.x < 0.0 || high.y < 0.0 {
            return;
        }
        for y in low.y as usize..=high.y as usize {
            for x in low.x as usize..=high.x as usize {
                let p = DVec2::new(x as f64, y as f64);
                let start = [0, 1, 2].map(|i| edges[i].0.dot(p) + edges[i].1);
                if start[0] + most[0] < 0.0 || start[1] + most[1] < 0.0 || start[2] + most[2] < 0.0 {
                    continue;
                }
                let at = (y * TILE + x) * pattern.len();
                for (k, step) in steps[..pattern.len()].iter().enumerate() {
                    let e = [start[0] + step[0], start[1] + step[1], start[2] + step[2]];
                    if e[0] < 0.0 || e[1] < 0.0 || e[2] < 0.0 {
                        continue;
                    }
                    let key = ((a.z * e[0] + b.z * e[1] + c.z * e[2]) * inverse) as f32;
                    if key <= self.keys[at + k] {
                        continue;
                    }
                    if sunk || mask.is_some() {
                        let w = flat.surface_weights(origin + p + pattern[k], perspective);
                        let [va, vb, vc] = scene.corners(triangle);
                        let up = va.at.y * w.x + vb.at.y * w.y + vc.at.y * w.z;
                        if sunk && up < scene.ground {
                            continue;
                        }
                        let uv = (va.uv * w.x + vb.uv * w.y + vc.uv * w.z).as_vec2();
                        if mask.is_some_and(|texture| texture.hole(uv.x, uv.y)) {
                            continue;
                        }
                    }
                    self.keys[at + k] = key;
                    self.ids[at + k] = id;
                }
            }
        }
    }
}
