//! Colour of fragments and of the background, tile by tile.

use base::{Cancelled, Run, light_of_byte, map_until_cancelled, ops};
use glam::{DVec2, DVec3};

use crate::camera::Camera;
use crate::light::{DepthMap, SUN, Sky, sunlit};
use crate::picture::Picture;
use crate::raster::{Bins, Flat, NONE, TILE, Visible, pattern};
use crate::scene::{Scene, Triangle, Vertex};
use crate::spec::{Background, PictureSpec};
use crate::texture::{Pyramid, srgb};

/// Strength of the ground shadow, as a share of the computed one: full strength looks hard on a pale ground.
const SHADOW_STRENGTH: f64 = 0.72;

struct Frame<'a> {
    scene: &'a Scene,
    sky: &'a Sky,
    spec: &'a PictureSpec,
    camera: Camera,
    sun: Vec<DepthMap>,
    bins: Bins,
    pattern: Vec<DVec2>,
}

/// Renders one picture of the scene; `spec` is clamped.
pub(crate) fn frame(
    scene: &Scene,
    sky: &Sky,
    spec: &PictureSpec,
    camera: Camera,
    run: &Run<'_>,
) -> Result<Picture, Cancelled> {
    let frame = Frame {
        scene,
        sky,
        spec,
        camera,
        sun: sky.sun(scene, camera.level_frame(), spec.sun, run)?,
        bins: Bins::new(scene, &camera, spec.width, spec.height),
        pattern: pattern(spec.supersample),
    };
    let count = frame.bins.columns * frame.bins.rows;
    let tiles = map_until_cancelled(run, count, |k| frame.tile(k))?;
    let mut picture = Picture::filled(spec.width, spec.height, [0; 4]);
    for (tile, (x, y)) in tiles.iter().zip((0..count).map(|k| frame.corner(k))) {
        picture.paste(tile, x, y);
    }
    Ok(picture)
}

impl Frame<'_> {
    #[expect(clippy::cast_possible_truncation, reason = "inside the picture, at most 8192")]
    fn corner(&self, tile: usize) -> (u32, u32) {
        ((tile % self.bins.columns * TILE) as u32, (tile / self.bins.columns * TILE) as u32)
    }

    #[expect(clippy::cast_possible_truncation, reason = "tiles are small")]
    fn tile(&self, tile: usize) -> Picture {
        let (x0, y0) = self.corner(tile);
        let mut out = Picture::filled(TILE as u32, TILE as u32, [0; 4]);
        let perspective = self.camera.is_perspective();
        let empty = self.bins.faces_in(tile).is_empty();
        let visible =
            (!empty).then(|| Visible::draw(self.scene, &self.bins, tile, &self.pattern, perspective));
        let pixels = out.pixels.chunks_exact_mut(4).enumerate();
        for (i, rgba) in pixels {
            let (x, y) = (i % TILE, i / TILE);
            let at = DVec2::new(f64::from(x0) + x as f64, f64::from(y0) + y as f64);
            if at.x >= f64::from(self.spec.width) || at.y >= f64::from(self.spec.height) {
                continue;
            }
            let ids = visible.as_ref().map_or(&[][..], |v| v.pixel(x, y));
            rgba.copy_from_slice(&self.pixel(at, ids));
        }
        out
    }

    // Averages the fragments of a pixel: each triangle is shaded once, in the centre of its samples.
    fn pixel(&self, at: DVec2, ids: &[u32]) -> [u8; 4] {
        let (mut color, mut alpha) = (DVec3::ZERO, 0.0);
        let share = 1.0 / self.pattern.len() as f64;
        let mut free = self.pattern.len() - ids.len();
        for (k, &id) in ids.iter().enumerate() {
            if id == NONE {
                free += 1;
                continue;
            }
            if ids[..k].contains(&id) {
                continue;
            }
            let mine = ids.iter().zip(&self.pattern).skip(k).filter(|&(&other, _)| other == id);
            let (sum, count) = mine.fold((DVec2::ZERO, 0.0), |(sum, n), (_, &s)| (sum + s, n + 1.0));
            color += self.fragment(id, at + sum / count) * (count * share);
            alpha += count * share;
        }
        if free > 0 {
            let share = free as f64 * share;
            let (behind, a) = self.behind(at + 0.5);
            color += behind * (a * share);
            alpha += a * share;
        }
        if alpha <= 0.0 {
            return [0; 4];
        }
        let c = color / alpha;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let a = (alpha.min(1.0) * 255.0 + 0.5) as u8;
        if a == 0 { [0; 4] } else { [srgb(c.x), srgb(c.y), srgb(c.z), a] }
    }

    /// Returns the display-linear colour of a triangle at a pixel position.
    fn fragment(&self, id: u32, at: DVec2) -> DVec3 {
        let triangle = &self.scene.triangles[id as usize];
        let Some(flat) = &self.bins.flats[id as usize] else { return DVec3::ZERO };
        let surface = &self.scene.surfaces[triangle.surface as usize];
        let place = Place::new(self.scene, &self.camera, flat, triangle, at);
        let Place { w, p, view, face, normal, turned, color, .. } = place;
        let [sa, sb, sc] = triangle.corners.map(|i| self.sky.vertices[i as usize]);
        let side = |k: usize| sa[k] * w.x + sb[k] * w.y + sc[k] * w.z;
        let (mut front, mut rear) = (side(0), side(1));
        if turned {
            core::mem::swap(&mut front, &mut rear);
        }
        let (mut open, mut roughness) = (1.0, surface.roughness);
        if let Some(orm) = &surface.orm {
            let (orm, _) = place.sample(orm);
            (open, roughness) = (orm.x, (roughness * orm.y).max(0.08));
        }
        front *= open;
        front *= passed_on(front, self.sky.free(normal), color);
        let through = (color * surface.through).min(DVec3::splat(0.95));
        let t = surface.translucency * surface.thin.as_ref().map_or(1.0, |thin| place.sample(thin).1);
        let mut light = color * front * (1.0 - t) + through * rear * t;
        let power = 2.0 / (roughness * roughness * roughness * roughness);
        let power = power.clamp(1.0, 600.0);
        let (mut on, mut behind, mut gloss) = (0.0, 0.0, 0.0);
        let mean = self.sun.first().map_or(DVec3::Y, |m| m.toward);
        let cos = normal.dot(mean);
        if cos.abs() > 1e-3 && (cos > 0.0 || t > 0.0) {
            let lit = sunlit(&self.sun, p, face) * self.spec.sunshine;
            if cos > 0.0 {
                on = cos * lit;
                let half = (mean + view).normalize_or(normal);
                gloss = lit * cos * 0.04 * (power + 8.0) / 8.0 * ops::powf(normal.dot(half).max(0.0), power);
            } else {
                behind = -cos * lit;
            }
        }
        light += color * SUN * (on * (1.0 - t)) + through * SUN * (behind * t) + SUN * gloss;
        tone(light * self.spec.exposure)
    }

    /// Returns the display-linear colour and alpha of the background.
    fn behind(&self, at: DVec2) -> (DVec3, f64) {
        let shade = if self.spec.ground_shadow { self.ground_shade(at) } else { DVec3::ONE };
        match self.spec.background {
            Background::Transparent => {
                let alpha = 1.0 - (shade.x + shade.y + shade.z) / 3.0;
                (DVec3::ZERO, if alpha < 0.004 { 0.0 } else { alpha })
            }
            Background::Plain([r, g, b]) => (DVec3::from_array([r, g, b].map(light_of_byte)) * shade, 1.0),
            Background::Sky => {
                // From above there is only ground.
                let level = 1.0 - self.camera.ray(at).1.y.abs();
                let t = (1.0 - at.y / f64::from(self.spec.height)) * ops::smoothstep(0.0, 0.5, level);
                (backdrop(t) * shade, 1.0)
            }
        }
    }

    // Returns the light on the ground at a pixel as a share of its light without the model.
    fn ground_shade(&self, at: DVec2) -> DVec3 {
        let (origin, direction) = self.camera.ray(at);
        if direction.y > -1e-6 || self.sun.is_empty() {
            return DVec3::ONE;
        }
        let mut p = origin + direction * ((self.scene.ground - origin.y) / direction.y);
        p.y = self.scene.ground;
        let level = self.sun[0].toward.y;
        let lit = sunlit(&self.sun, p, DVec3::Y);
        let level = level * self.spec.sunshine;
        let full = (SUN * level + self.sky.open).max(DVec3::splat(f64::MIN_POSITIVE));
        let here = SUN * (level * lit) + self.sky.on_ground(p);
        DVec3::ONE.lerp((here / full).min(DVec3::ONE), SHADOW_STRENGTH)
    }
}

/// A visible point of a triangle.
pub(crate) struct Place {
    /// Barycentric coordinates.
    w: DVec3,
    pub(crate) p: DVec3,
    view: DVec3,
    face: DVec3,
    /// Normal of the visible side, with its relief.
    pub(crate) normal: DVec3,
    /// The rear side is visible.
    turned: bool,
    /// Reflectance, linear.
    pub(crate) color: DVec3,
    uv: DVec2,
    /// Area of the texture plane that a pixel covers.
    uv_area: f64,
}

impl Place {
    pub(crate) fn new(scene: &Scene, camera: &Camera, flat: &Flat, triangle: &Triangle, at: DVec2) -> Self {
        let surface = &scene.surfaces[triangle.surface as usize];
        let w = flat.surface_weights(at, camera.is_perspective());
        let corners = scene.corners(triangle);
        let [a, b, c] = corners;
        let p = a.at * w.x + b.at * w.y + c.at * w.z;
        let view = camera.toward_viewer(p);
        let face = (b.at - a.at).cross(c.at - a.at).normalize_or(view);
        let mut normal = (a.normal * w.x + b.normal * w.y + c.normal * w.z).normalize_or(face);
        // The visible side decides, whatever winding the file has.
        let facing = if face.dot(view) < 0.0 { -face } else { face };
        let turned = normal.dot(facing) < 0.0;
        if turned {
            normal = -normal;
        }
        let color = surface.color * (a.color * w.x + b.color * w.y + c.color * w.z);
        let uv = a.uv * w.x + b.uv * w.y + c.uv * w.z;
        let uv_area = (b.uv - a.uv).perp_dot(c.uv - a.uv).abs() * 0.5 / flat.pixel_area().max(1e-3);
        let mut place = Self { w, p, view, face, normal, turned, color, uv, uv_area };
        if let Some(texture) = &surface.texture {
            place.color *= place.sample(texture).0;
        }
        place.color = place.color.min(DVec3::splat(0.95));
        if let Some(normals) = &surface.normals {
            // A groove on one side is a ridge on the other.
            let side = if turned { -1.0 } else { 1.0 };
            let seen = place.sample(normals).0 * 2.0 - DVec3::ONE;
            place.normal = relief(corners, normal, seen * DVec3::new(side, side, 1.0));
        }
        place
    }

    /// Returns the share of the sky's light that reaches the point, 1 for all.
    pub(crate) fn sky(&self, triangle: &Triangle, sky: &Sky) -> f64 {
        let [a, b, c] = triangle.corners.map(|i| sky.vertices[i as usize][usize::from(self.turned)]);
        (a.dot(DVec3::ONE) * self.w.x + b.dot(DVec3::ONE) * self.w.y + c.dot(DVec3::ONE) * self.w.z)
            / sky.open.dot(DVec3::ONE).max(1e-9)
    }

    fn sample(&self, texture: &Pyramid) -> (DVec3, f64) {
        let texels = self.uv_area * texture.texel_count();
        let lod = if texels > 1.0 { 0.5 * ops::ln(texels) / core::f64::consts::LN_2 } else { 0.0 };
        texture.sample(self.uv, lod)
    }
}

/// Returns a normal of the relief: `local` is that of its map, and `normal` that of the visible side.
fn relief([a, b, c]: [&Vertex; 3], normal: DVec3, local: DVec3) -> DVec3 {
    let (ab, ac) = (b.at - a.at, c.at - a.at);
    let (s, t) = (b.uv - a.uv, c.uv - a.uv);
    let area = s.perp_dot(t);
    // Directions of u and of the picture's up on the triangle, in the plane of the normal.
    let along_u = (ab * t.y - ac * s.y) * area.signum();
    let along_v = (ac * s.x - ab * t.x) * area.signum();
    let flat = |d: DVec3| (d - normal * normal.dot(d)).try_normalize();
    let (Some(right), Some(down)) = (flat(along_u), flat(along_v)) else { return normal };
    (right * local.x - down * local.y + normal * local.z.max(0.05)).normalize_or(normal)
}

/// Returns the display-linear colour of ground and sky, from the foot of a picture, 0, to its top, 1: brightest where
/// they meet.
fn backdrop(t: f64) -> DVec3 {
    const LOW: DVec3 = DVec3::new(0.75, 0.74, 0.705);
    const MIDDLE: DVec3 = DVec3::new(0.78, 0.815, 0.84);
    const HIGH: DVec3 = DVec3::new(0.48, 0.645, 0.83);
    let sky = LOW.lerp(MIDDLE, ops::smoothstep(0.0, 0.45, t));
    sky.lerp(HIGH, ops::smoothstep(0.35, 1.0, t))
}

/// Least share of the free light for which interreflection is computed.
const DARKEST: f64 = 0.01;

/// Returns the factor by which interreflection brightens a point with this light, where an unobstructed one would have
/// `free`, as the surfaces that hide the sky from it are of its own colour and pass light on: much in white blossom,
/// hardly any among dark leaves. A fit to traced light (Jimenez, Wu, Pesce and Jarabo, Practical Realtime Strategies
/// for Accurate Indirect Occlusion, 2016).
fn passed_on(lit: DVec3, free: DVec3, color: DVec3) -> DVec3 {
    let of = |lit: f64, free: f64, color: f64| {
        let share = (lit / free.max(f64::MIN_POSITIVE)).clamp(DARKEST, 1.0);
        let (a, b, c) = (2.0404 * color - 0.3324, -4.7951 * color + 0.6417, 2.7552 * color + 0.6903);
        (((share * a + b) * share + c) * share).max(share).min(1.0) / share
    };
    DVec3::new(of(lit.x, free.x, color.x), of(lit.y, free.y, color.y), of(lit.z, free.z, color.z))
}

// Linear up to 0.6, then a soft shoulder that reaches 1 at infinity: highlights keep their hue.
fn tone(x: DVec3) -> DVec3 {
    let shoulder = |x: f64| {
        const KNEE: f64 = 0.6;
        let over = (x - KNEE).max(0.0) / (1.0 - KNEE);
        x.min(KNEE) + (1.0 - KNEE) * over / (1.0 + over)
    };
    DVec3::new(shoulder(x.x), shoulder(x.y), shoulder(x.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Run;

    fn luminance(c: DVec3) -> f64 {
        c.dot(DVec3::new(0.2126, 0.7152, 0.0722))
    }

    fn open_sky() -> Sky {
        Sky::new(&Scene::new(&mesh::Model::default()), &PictureSpec::default(), &Run::plain())
            .expect("not cancelled")
    }

    #[test]
    fn a_white_plane_in_the_shade_is_as_bright_as_the_sky_that_is_shown() {
        let sky = open_sky();
        // Weighted by the cosine with the zenith. Above a third of its height a picture shows sky.
        let shown: f64 = (0..1000)
            .map(|k| (f64::from(k) + 0.5) / 1000.0)
            .map(|up| 2.0 * up * luminance(backdrop(1.0 / 3.0 + 2.0 / 3.0 * up)) / 1000.0)
            .sum();
        let ratio = luminance(tone(sky.open)) / shown;
        assert!((0.93..1.07).contains(&ratio), "{ratio}");
        // In the sun, at 50 degrees, it is brighter than the backdrop, and not overexposed.
        let sunlit = luminance(tone(SUN * 0.78 + sky.open));
        assert!(sunlit > luminance(backdrop(0.4)) && sunlit < 0.9, "{sunlit}");
    }

    #[test]
    fn a_white_ball_under_the_open_sky_has_the_light_that_is_summed_over_it() {
        let sky = open_sky();
        assert_eq!(sky.free(DVec3::Y), sky.open);
        let side = luminance(sky.free(DVec3::X));
        assert!(luminance(sky.free(DVec3::NEG_Y)) < side && side < luminance(sky.open), "{side}");
    }

    #[test]
    fn white_passes_light_on_and_black_does_not() {
        let free = DVec3::splat(0.7);
        for share in [0.1, 0.3, 0.6, 0.9] {
            let more = |color: f64| passed_on(free * share, free, DVec3::splat(color)).x;
            assert!(more(0.9) > 1.1 * more(0.5) || share > 0.5, "{share}");
            assert!((1.0..1.06).contains(&more(0.04)), "{share}: {}", more(0.04));
            assert!(more(0.9) >= more(0.5) && more(0.95) * share <= 1.0, "{share}");
        }
        assert_eq!(passed_on(free, free, DVec3::splat(0.9)), DVec3::ONE);
        assert!(passed_on(DVec3::ZERO, DVec3::ZERO, DVec3::ZERO).is_finite());
    }
}
