//! Procedural textures: painted once, the same everywhere, shared by every model.

mod atlas;
mod bark;
mod blades;
mod bodies;
mod cloud;
mod filled;
mod foliage;
mod noise;
mod patterns;
mod relief;
mod tubes;
mod veins;

use std::sync::{Arc, OnceLock};

use base::{Executor, map_indexed};
use mesh::Texture;

pub use cloud::CloudColours;
pub use patterns::swatch;
pub use veins::{LeafColours, vein_texture};

pub(crate) use atlas::{Leafage, atlas};
pub(crate) use bark::bark;
pub(crate) use blades::{GREEN, LeafInks, PALE_GREEN, PALE_PETAL, inks as petal_inks};
pub(crate) use bodies::{DISC_RADIUS, RECEPTACLE_AT};
pub(crate) use foliage::{LEAF_ROUGHNESS, any_blade, leaf, petals};
pub(crate) use patterns::{paint as paint_material, painted as painted_material};
pub(crate) use relief::Surface;

/// Returns the height of the florets over the dome of a disc at a point of its unit circle, about -1 to 1.
pub(crate) fn unevenness(x: f64, y: f64) -> f64 {
    noise::gradient(5.0 * x + 8.0, 5.0 * y + 8.0, (64, 64), 31)
}

/// An sRGB colour, each channel 0 to 1. Textures are mixed in sRGB, as paint is chosen by eye.
pub(crate) type Paint = [f64; 3];

/// A texture of a small part that this crate can paint: a colour without relief.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Motif {
    Stem,
    Root,
    Disc,
    PaleDisc,
    Fruit,
    PaleFruit,
    /// A fruit with eyes, such as a pineapple.
    Eyes,
    /// A green, ribbed body, such as a cactus's.
    Body,
    /// Pots and soil, without a hue.
    Clay,
    Stamen,
    Thorn,
}

const MOTIFS: usize = 11;

impl Motif {
    /// Returns the texture, painted on first use (up to about 10 ms on one thread) and kept for the life of the
    /// process.
    pub(crate) fn texture(self, executor: &dyn Executor) -> Arc<Texture> {
        static PAINTED: [OnceLock<Arc<Texture>>; MOTIFS] = [const { OnceLock::new() }; MOTIFS];
        PAINTED[self as usize].get_or_init(|| Arc::new(self.paint(executor))).clone()
    }

    fn paint(self, executor: &dyn Executor) -> Texture {
        let canvas = |width, height, f: &Paints<'_>| canvas(executor, width, height, f);
        match self {
            Self::Stem => canvas(128, 128, &tubes::stem),
            Self::Root => canvas(128, 128, &tubes::root),
            Self::Disc => bodies::disc(executor, 256, &bodies::YELLOW_DISC),
            Self::PaleDisc => bodies::disc(executor, 256, &bodies::PALE_DISC),
            Self::Fruit => canvas(128, 128, &|u, v| bodies::fruit(&bodies::RED_FRUIT, u, v)),
            Self::PaleFruit => canvas(128, 128, &|u, v| bodies::fruit(&bodies::PALE_FRUIT, u, v)),
            Self::Eyes => canvas(256, 256, &bodies::eyes),
            Self::Body => canvas(256, 128, &bodies::ribbed),
            Self::Clay => canvas(128, 128, &bodies::clay),
            Self::Stamen => canvas(64, 64, &bodies::stamen),
            Self::Thorn => canvas(32, 64, &bodies::thorn),
        }
    }
}

/// Returns the paint at u and v.
type Paints<'a> = dyn Fn(f64, f64) -> Paint + Sync + 'a;

/// Paints `f(u, v)` at the centre of each pixel; v runs down.
fn canvas(executor: &dyn Executor, width: u32, height: u32, f: &Paints<'_>) -> Texture {
    // Rows that one job paints: some tenths of a millisecond.
    const ROWS: u32 = 16;
    let bands = map_indexed(executor, height.div_ceil(ROWS) as usize, |band| {
        let first = ROWS * u32::try_from(band).unwrap_or(u32::MAX);
        let mut pixels = Vec::with_capacity(4 * (width * ROWS) as usize);
        for j in first..height.min(first.saturating_add(ROWS)) {
            let v = (f64::from(j) + 0.5) / f64::from(height);
            for i in 0..width {
                let u = (f64::from(i) + 0.5) / f64::from(width);
                let [r, g, b] = f(u, v).map(byte);
                pixels.extend_from_slice(&[r, g, b, 255]);
            }
        }
        pixels
    });
    Texture { width, height, pixels: bands.concat() }
}

/// Returns the whole part of a coordinate that is not negative.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "among the pixels of a picture")]
fn whole(at: f64) -> usize {
    at as usize
}

fn byte(x: f64) -> u8 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte's range")]
    let b = (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    b
}

fn mix(a: Paint, b: Paint, t: f64) -> Paint {
    let t = t.clamp(0.0, 1.0);
    [0, 1, 2].map(|i| base::ops::lerp(a[i], b[i], t))
}

fn shade(a: Paint, factor: f64) -> Paint {
    a.map(|x| x * factor)
}

/// Returns 1 at 0, 0 from `width` on, smooth.
fn line(distance: f64, width: f64) -> f64 {
    1.0 - base::ops::smoothstep(0.0, width, distance.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn every() -> [Motif; MOTIFS] {
        use Motif as M;
        [
            M::Stem,
            M::Root,
            M::Disc,
            M::PaleDisc,
            M::Fruit,
            M::PaleFruit,
            M::Eyes,
            M::Body,
            M::Clay,
            M::Stamen,
            M::Thorn,
        ]
    }

    #[test]
    fn every_motif_has_its_own_slot_and_is_whole() {
        let mut slots: Vec<usize> = every().into_iter().map(|m| m as usize).collect();
        slots.sort_unstable();
        assert_eq!(slots, (0..MOTIFS).collect::<Vec<_>>());
        for motif in every() {
            let t = motif.texture(&base::Serial);
            assert_eq!(t.pixels.len(), 4 * (t.width * t.height) as usize, "{motif:?}");
            assert!(t.pixels.chunks(4).all(|p| p[3] == 255), "{motif:?} is opaque");
            let (low, high) = t.pixels.chunks(4).fold((255, 0), |(a, b), p| (p[1].min(a), p[1].max(b)));
            assert!(high - low > 10, "{motif:?} is not flat: {low}..{high}");
        }
    }
}
