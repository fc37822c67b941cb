//! sRGB tables and textures with halved copies.
#![expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pixel arithmetic, clamped")]

use std::sync::OnceLock;

use glam::{DVec2, DVec3, DVec4};

const STEPS: usize = 1 << 14;

/// Returns the sRGB byte of a linear value; 0 for NaN.
pub(crate) fn srgb(x: f64) -> u8 {
    static TABLE: OnceLock<Vec<u8>> = OnceLock::new();
    let table =
        TABLE.get_or_init(|| (0..=STEPS).map(|i| base::byte_of_light(i as f64 / STEPS as f64)).collect());
    table[((x.clamp(0.0, 1.0) * STEPS as f64 + 0.5) as usize).min(STEPS)]
}

/// One size of a texture: linear RGB multiplied by alpha, and alpha.
struct Level {
    width: usize,
    height: usize,
    texels: Vec<DVec4>,
}

/// A texture and its halved copies down to one texel.
pub(crate) struct Pyramid {
    levels: Vec<Level>,
    // Alpha below one half, stored apart from the colours: shadows need only this, and often.
    holes: Vec<bool>,
}

impl Pyramid {
    /// Makes the pyramid of an sRGB picture. `None` for a texture without pixels or with too few bytes.
    pub(crate) fn new(texture: &mesh::Texture) -> Option<Self> {
        Self::from_texture(texture, base::light_of_byte)
    }

    /// Makes the pyramid of plain numbers: normals, roughness.
    pub(crate) fn from_numbers(texture: &mesh::Texture) -> Option<Self> {
        Self::from_texture(texture, |byte| f64::from(byte) / 255.0)
    }

    fn from_texture(texture: &mesh::Texture, linear: fn(u8) -> f64) -> Option<Self> {
        let (width, height) = (texture.width as usize, texture.height as usize);
        let bytes = width.checked_mul(height)?.checked_mul(4)?;
        if bytes == 0 || texture.pixels.len() < bytes {
            return None;
        }
        let texels = texture.pixels[..bytes]
            .chunks_exact(4)
            .map(|p| {
                let alpha = f64::from(p[3]) / 255.0;
                (DVec3::new(linear(p[0]), linear(p[1]), linear(p[2])) * alpha).extend(alpha)
            })
            .collect();
        let mut levels = vec![Level { width, height, texels }];
        while let Some(last) = levels.last().filter(|l| l.width > 1 || l.height > 1) {
            levels.push(last.halved());
        }
        let holes = texture.pixels[..bytes].chunks_exact(4).map(|p| p[3] < 128).collect();
        Some(Self { levels, holes })
    }

    /// Returns the number of texels of the full size.
    pub(crate) fn texel_count(&self) -> f64 {
        (self.levels[0].width * self.levels[0].height) as f64
    }

    /// Returns linear RGB and alpha at `uv` (v down, repeating), between two sizes. `lod` 0 is the full size.
    pub(crate) fn sample(&self, uv: DVec2, lod: f64) -> (DVec3, f64) {
        let lod = lod.clamp(0.0, (self.levels.len() - 1) as f64);
        let k = lod as usize;
        let mut c = self.levels[k].sample(uv);
        let t = lod - k as f64;
        if t > 0.0 && k + 1 < self.levels.len() {
            c = c.lerp(self.levels[k + 1].sample(uv), t);
        }
        if c.w > 1e-6 { (c.truncate() / c.w, c.w) } else { (DVec3::ZERO, 0.0) }
    }

    /// Whether the nearest full-size texel is a hole: cut at every sample, so that averaging comes later.
    pub(crate) fn hole(&self, u: f32, v: f32) -> bool {
        let (width, height) = (self.levels[0].width, self.levels[0].height);
        let place = |x: f32, n: usize| {
            let turn = x as i32 as f32;
            let x = x - if turn > x { turn - 1.0 } else { turn };
            ((x * n as f32) as usize).min(n - 1)
        };
        self.holes[place(v, height) * width + place(u, width)]
    }
}

// Maps any number into [0, n); NaN to 0.
fn wrap(x: f64, n: usize) -> f64 {
    let n = n as f64;
    // By a cast: a call of floor for every sample is slow, and beyond 2^63 the place does not matter.
    let turns = (x / n) as i64 as f64;
    let r = x - if turns * n > x { turns - 1.0 } else { turns } * n;
    if r >= 0.0 && r < n { r } else { 0.0 }
}

impl Level {
    fn halved(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let mut texels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let at = |dx: usize, dy: usize| {
                    let x = (2 * x + dx).min(self.width - 1);
                    let y = (2 * y + dy).min(self.height - 1);
                    self.texels[y * self.width + x]
                };
                texels.push((at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) * 0.25);
            }
        }
        Self { width, height, texels }
    }

    fn sample(&self, uv: DVec2) -> DVec4 {
        let x = wrap(uv.x * self.width as f64 - 0.5, self.width);
        let y = wrap(uv.y * self.height as f64 - 0.5, self.height);
        let (x0, y0) = (x as usize, y as usize);
        let (x1, y1) = ((x0 + 1) % self.width, (y0 + 1) % self.height);
        let (tx, ty) = (x - x0 as f64, y - y0 as f64);
        let row = |y: usize| self.texels[y * self.width + x0].lerp(self.texels[y * self.width + x1], tx);
        row(y0).lerp(row(y1), ty)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_srgb_byte_survives_the_round_trip() {
        assert!((0..=255).all(|b| srgb(base::light_of_byte(b)) == b));
        assert_eq!((srgb(f64::NAN), srgb(-1.0), srgb(9.0)), (0, 0, 255));
    }

    #[test]
    fn texture_wraps_and_halves() {
        let texture = mesh::Texture { width: 2, height: 1, pixels: vec![255, 255, 255, 255, 0, 0, 0, 255] };
        let pyramid = Pyramid::new(&texture).unwrap();
        assert!((pyramid.sample(DVec2::new(0.25, 0.5), 0.0).0.x - 1.0).abs() < 1e-12);
        assert!((pyramid.sample(DVec2::new(-0.25, 9.5), 0.0).0.x).abs() < 1e-12);
        assert!((pyramid.sample(DVec2::new(0.1, 0.5), 5.0).0.x - 0.5).abs() < 1e-12);
        assert!(pyramid.sample(DVec2::NAN, f64::NAN).0.is_finite());
        assert!(Pyramid::new(&mesh::Texture { width: 2, height: 2, pixels: vec![0; 3] }).is_none());
    }
}
